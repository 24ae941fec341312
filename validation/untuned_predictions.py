"""Table 2: what was measured, predicted from inputs that nobody tuned to it.

The rule for the restitution takes nothing from the readings: the fit of Cipriani and others where
its published values lie (2 to 15 mph), beyond them the 0.1 that the abstract of SAE 931842 gives
for medium and high speed.
"""

from __future__ import annotations

import re
from typing import Any

from published_records import IN_LINE, RESTITUTION, Case, Figure, rounded, rows_of

import collisions as col
from collisions import reconstruct, reference

MPH, KMH = 0.44704, 1 / 3.6
MEDIUM_AND_HIGH = 0.1
DOUBTFUL_E = "typed into a notebook as from test data, an order of magnitude below NHTSA 10146"
DOUBTFUL_MOTION = (
    "body-fixed integrals of a car that turned, no yaw-rate sensor; the two sensors averaged "
    "differ by up to 13 km/h"
)


def expected_restitution(closing: float) -> tuple[float, str]:
    """A restitution for a closing speed in m/s, and where it is from."""
    try:
        return float(
            reference.restitution(closing, outside="refuse")
        ), "Cipriani and others, SAE 2002-01-0540"
    except col.InputError as error:
        if error.code != "outside_reference":
            raise
    return MEDIUM_AND_HIGH, "abstract of SAE 931842, medium and high speed"


def cipriani_values() -> list[dict[str, Any]]:
    """The values tabulated of the fit, and the fit."""
    return [
        {
            "closing_mph": row["closing_speed"],
            "printed": row["e"],
            "computed": rounded(
                reference.restitution(f"{row['closing_speed']} mph", outside="refuse")
            ),
        }
        for row in rows_of(RESTITUTION)
        if row["data_set"].startswith("Cipriani")
    ]


def first_number(text: str) -> str:
    """The first number of a cell, as it stands there."""
    found = re.search(r"-?\d+(?:\.\d+)?", text)
    if found is None:
        raise ValueError(f"no number in {text!r}")
    return found.group()


def test_rows(test: str) -> list[dict[str, str]]:
    """The vehicles of a test."""
    return [row for row in rows_of(IN_LINE) if row["test"] == test]


def reading_of_e(data_set: str, closing: str) -> tuple[dict[str, str], str]:
    """A row of the restitutions and its record's name."""
    (row,) = (
        row
        for row in rows_of(RESTITUTION)
        if row["data_set"] == data_set and row["closing_speed"] == closing
    )
    return (
        row,
        f"{RESTITUTION}: {row['data_set']} {row['closing_speed']} {row['closing_speed_unit']}",
    )


def restitution_figure(row: dict[str, str], wrong: str = "") -> Figure:
    """The restitution expected beside the one that was read."""
    unit = {"mph": MPH, "km/h": KMH}[row["closing_speed_unit"]]
    return Figure(
        "restitution read",
        "e",
        "",
        row["e"],
        expected_restitution(float(row["closing_speed"]) * unit)[0],
        wrong=wrong,
    )


def said_of(closing: float) -> str:
    """The restitution used, in words."""
    e, source = expected_restitution(closing)
    return f"e = {e:.3f} ({source})"


def fiesta_into_polo() -> Case:
    """GBB, 5.5 mph: both delta-Vs from the closing speed, and the Polo's from the Fiesta's."""
    one, two = test_rows("GBB rear-to-front 5.5 mph")
    row, record = reading_of_e("GBB 5.5 mph", "5.5")
    a = col.Vehicle(mass=f"{one['mass_kg']} kg", vx=f"{one['impact_speed']} mph")
    b = col.Vehicle(mass=f"{two['mass_kg']} kg", vx=f"{two['impact_speed']} mph")
    e, _ = expected_restitution(a.vx)
    impact = col.linear_central(a, b, e)
    return Case(
        "GBB 5.5 mph",
        "Ford Fiesta into Volkswagen Polo, rear end",
        [f"{IN_LINE}: {each['test']} vehicle {each['vehicle_no']}" for each in (one, two)]
        + [record],
        one["source"],
        [
            Figure(
                "delta-V from the closing speed",
                "dV1",
                "mph",
                one["delta_v"],
                impact.a.q.delta_v.m_as("mph"),
            ),
            Figure(
                "delta-V from the closing speed",
                "dV2",
                "mph",
                two["delta_v"],
                impact.b.q.delta_v.m_as("mph"),
            ),
            Figure(
                "delta-V from the other car's",
                "dV2 from dV1",
                "mph",
                two["delta_v"],
                by_momentum(a, b, one["delta_v"], "mph"),
            ),
            restitution_figure(row),
        ],
        inputs=said_of(a.vx),
        notes=["The restitution read is that of the same two delta-Vs: it is no further evidence."],
    )


def by_momentum(a: col.Vehicle, b: col.Vehicle, delta_v_a: str, unit: str) -> float:
    """The delta-V of B from that of A: whatever the restitution, momentum ties them."""
    closing = reconstruct.inline_closing_speed(a.mass, b.mass, 0.0, delta_v_a=f"{delta_v_a} {unit}")
    return col.linear_central(a.replace(vx=closing), b.replace(vx=0.0), 0.0).b.q.delta_v.m_as(unit)


def citroen_into_bus() -> Case:
    """GBB, 8.0 mph: the masses are not visible, so only the restitution."""
    one, two = test_rows("GBB low speed rear end impact")
    row, record = reading_of_e("GBB 8.0 mph", "8.0")
    closing = float(one["impact_speed"]) * MPH
    return Case(
        "GBB 8.0 mph",
        "Citroen ZX into a standing Volvo bus",
        [f"{IN_LINE}: {each['test']} vehicle {each['vehicle_no']}" for each in (one, two)]
        + [record],
        one["source"],
        [restitution_figure(row)],
        inputs=said_of(closing),
        notes=["The wheels of the bus stood still, so the road took part of the impulse."],
    )


def camry_into_barrier() -> Case:
    """NHTSA 10146: a full frontal barrier test."""
    (one,) = test_rows("NHTSA 10146 NCAP full frontal")
    row, record = reading_of_e("NHTSA 10146", "57.09")
    car = col.Vehicle(mass=f"{one['mass_kg']} kg", vx=f"{one['impact_speed']} km/h")
    e, _ = expected_restitution(car.vx)
    impact = col.linear_central(car, col.Vehicle.barrier(), e)
    read = first_number(one["delta_v"])
    return Case(
        "NHTSA 10146",
        "2018 Toyota Camry into a rigid barrier, full frontal",
        [f"{IN_LINE}: {one['test']} vehicle 1", record],
        one["source"],
        [
            Figure(
                "delta-V from the closing speed",
                "dV1",
                "km/h",
                read,
                impact.a.q.delta_v.m_as("km/h"),
            ),
            restitution_figure(row),
        ],
        inputs=said_of(car.vx),
        notes=[
            (
                "Mean of four accelerometers (66.1 to 67.4 km/h), integrated by whoever put the "
                "data together. The restitution read is that of the same delta-V: it is no "
                "further evidence."
            ),
        ],
    )


def malibu(closing: str) -> Case:
    """Two barrier tests of which only a doubtful restitution is known."""
    row, record = reading_of_e("pycrash demo, 2015 Malibu", closing)
    return Case(
        f"Malibu {closing} km/h",
        "2015 Chevrolet Malibu into a barrier, full frontal",
        [record],
        row["source"],
        [restitution_figure(row, wrong=DOUBTFUL_E)],
        inputs=said_of(float(closing) * KMH),
    )


def sensors(cell: str) -> list[str]:
    """The forward readings of the left and the right sensor of NHTSA 7292."""
    return [
        re.search(rf"{side}(?: sensor)? (-?[\d.]+)/", cell).group(1) for side in ("left", "right")
    ]  # type: ignore[union-attr]


def taurus_into_taurus() -> Case:
    """NHTSA 7292: the delta-V of the struck car from that of the striking one."""
    one, two = test_rows("NHTSA 7292 V2V")
    read = [f"{abs(sum(map(float, sensors(row['delta_v'])))) / 2:.2f}" for row in (one, two)]
    a, b = (col.Vehicle(mass=f"{row['mass_kg']} kg") for row in (one, two))
    return Case(
        "NHTSA 7292",
        "2007 Ford Taurus into a standing 2006 Ford Taurus, 7 degrees, no overlap of the frame "
        "rails",
        [f"{IN_LINE}: {row['test']} vehicle {row['vehicle_no']}" for row in (one, two)],
        one["source"],
        [
            Figure(
                "delta-V from the other car's",
                "dV2 from dV1",
                "km/h",
                read[1],
                by_momentum(a, b, read[0], "km/h"),
                wrong=DOUBTFUL_MOTION,
            ),
        ],
        inputs="nothing but the masses",
        notes=["Forward components, means of the left and the right sensor at 150 ms."],
    )


def taurus_in_line() -> tuple[float, float]:
    """What a central in-line estimate, which this test is not, would give for NHTSA
    7292, in km/h.
    """
    one, two = test_rows("NHTSA 7292 V2V")
    a, b = (
        col.Vehicle(mass=f"{row['mass_kg']} kg", vx=f"{row['impact_speed']} km/h")
        for row in (one, two)
    )
    impact = col.linear_central(a, b, expected_restitution(a.vx)[0])
    return rounded(impact.a.q.delta_v.m_as("km/h")), rounded(impact.b.q.delta_v.m_as("km/h"))


def cases() -> list[Case]:
    """Every case of table 2."""
    return [
        fiesta_into_polo(),
        citroen_into_bus(),
        camry_into_barrier(),
        malibu("56.51"),
        malibu("60"),
        taurus_into_taurus(),
    ]
