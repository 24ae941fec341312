"""What is in none of the three tables, and why; and what is wrong in the sources."""

from __future__ import annotations

from typing import Any

from measured_fits import corrupt_angles, tabulated
from published_cases import CASES, SOLUTIONS, number, numbers, output
from published_records import EXAMPLES, RESTITUTION, difference, record_names, rounded
from solutions import carpenter_impact
from untuned_predictions import cipriani_values, taurus_in_line

import collisions as col


def nothing_published() -> list[dict[str, Any]]:
    """Cases without a published answer: ours beside what was worked out apart when the data were
    put together.
    """
    return [
        {
            "key": name,
            "title": CASES[name]["source"]["title"],
            "records": [f"{EXAMPLES}: {name}"],
            "source": CASES[name]["source"]["url"],
            "why": why,
            "figures": [
                {
                    "name": key,
                    "unit": CASES[name]["recomputed_outputs"][key]["unit"],
                    "apart": str(output(name, key)),
                    "computed": rounded(ours),
                    "difference": difference(rounded(ours), str(output(name, key)), "%"),
                }
                for key, ours in numbers(name, SOLUTIONS[name][0]).items()
            ],
        }
        for name, why in (
            ("L14", "a problem without a printed answer"),
            (
                "X01",
                (
                    "an input set; the results of the paper are not in these data. 4 degrees "
                    "from one line, the differences are those of the course to four decimals"
                ),
            ),
        )
    ]


def inputs_only() -> list[dict[str, Any]]:
    """Records that are no cases: values of a formula and statements, used as inputs of table 2 or
    not at all.
    """
    names = [name for name in record_names() if name.startswith(RESTITUTION)]
    fit = [name for name in names if "Cipriani" in name]
    return [
        {
            "records": fit,
            "what": (
                "values of a fit to low-speed in-line tests, all met by `reference.restitution`. "
                "Input of table 2."
            ),
            "values": cipriani_values(),
        },
        {
            "records": [name for name in names if "SAE 931842" in name],
            "what": (
                "a range in an abstract, and its 0.1 for medium and high speed. The 0.1 is an "
                "input of table 2."
            ),
        },
        {
            "records": [name for name in names if "forensicspot" in name],
            "what": "a range without closing speeds. Not used.",
        },
    ]


def not_computed() -> list[dict[str, Any]]:
    """Published or measured figures that are compared in no table, each with the reason."""
    second = output("L10", "second_part_unknown_speed")
    refusal = ""
    try:
        col.linear_central(
            col.Vehicle(mass="3000 lb", vx=f"{second} mph"),
            col.Vehicle(mass="2000 lb", vx="30 mph"),
            (45 - 30) / (float(second) - 30),
        )
    except col.InputError as error:
        refusal = error.code
    along, across = (f"{value:.1f}" for value in taurus_in_line())
    car = carpenter_impact(f"{-number('E07', 'tangent_axis_angle')!r} deg").a.q
    as_normal = (
        f"{car.delta_vx.m_as('mph'):.2f} and {car.delta_vy.m_as('mph'):.2f} mph, "
        f"{car.delta_yaw_rate.m_as('deg/s'):.1f} deg/s"
    )
    ours = "library's answer"
    return [
        {
            "record": f"{EXAMPLES}: L10",
            "what": "second part (30 and 45 mph after, 30 mph before)",
            "given": "no printed answer",
            "why": (
                "momentum gives 40 mph, and the cars would part faster than they closed: e = "
                f"1.5. The {ours} is a refusal (`{refusal}`)."
            ),
        },
        {
            "record": f"{EXAMPLES}: M10",
            "what": "delta-V from damage (dV1_damage, dV2_damage)",
            "given": "60.7 and 59.4 km/h",
            "why": (
                "the crush and the stiffnesses are not in the data. They contradict its momentum "
                "fivefold."
            ),
        },
        {
            "record": f"{EXAMPLES}: M10",
            "what": "yaw rates after (54.75 and 118.91 deg/s)",
            "given": "inputs from a run-out analysis",
            "why": (
                "not an output of the impact there: the linear momentum at the printed impulse "
                "centres would give others."
            ),
        },
        {
            "record": f"{EXAMPLES}: E07",
            "what": "the measured motion of test CF11002 (in the note)",
            "given": "-26.24 and 7.29 mph, 102.75 deg/s",
            "why": (
                "the sheet is no model of the test: it enters the normal as a tangent. With "
                "74.6 degrees as the normal, on the side of the car where the sheet has the "
                f"contact, and its other inputs, whose origin is not known, the {ours} is "
                f"{as_normal}."
            ),
        },
        {
            "record": "nhtsa_oblique.csv: 4363 and 4474",
            "what": "the motions measured in the two crash tests",
            "given": "not in the data",
            "why": (
                "only the planar solutions fitted to them are published here, so the two are in "
                "table 3 and in no other."
            ),
        },
        {
            "record": "inline_and_barrier_tests.csv: GBB low speed rear end impact",
            "what": "delta-V of car and bus",
            "given": "9.7 and 0.43 mph",
            "why": (
                "the masses are not visible, and the road held the wheels of the bus: momentum "
                "alone does not hold."
            ),
        },
        {
            "record": "inline_and_barrier_tests.csv: NHTSA 7292 V2V",
            "what": "delta-V from the closing speed",
            "given": "forward 26.0 to 57.8 km/h, by sensor",
            "why": (
                "contact point, normal and yaw inertia are not published, and the readings are "
                "body-fixed integrals of cars that turned, without a yaw-rate sensor. A central "
                "in-line estimate with e = 0.1, which this offset contact is not, would give "
                f"{along} and {across} km/h."
            ),
        },
    ]


def slips() -> list[dict[str, str]]:
    """What is wrong in the sources beyond single printed figures, which the tables
    themselves mark.
    """
    found = [
        ("L07", "a stray digit in an intermediate line", "no effect on the answer"),
        ("M05", "300 for 30 degrees south of west in the text", "30 gives the printed answer"),
        (
            "M09",
            "momenta labelled kg m/s, the speeds are in km/h",
            "kg km/h; no effect on the speeds",
        ),
        (
            "M10",
            "yaw rates, linear momentum and damage contradict each other",
            "linear momentum alone is compared",
        ),
        (
            "E07",
            "the normal of the test entered as a tangent",
            "its arithmetic is compared as it stands, with the normal at 74.6 - 90 degrees",
        ),
        (
            "E07",
            "inertia of the barrier in slug ft2 is its weight times a square: lb ft2",
            "used as printed; without effect in a body so heavy",
        ),
        (
            "X01",
            "routine SR4 of the repository takes a cosine for a sine (90-degree case)",
            "not used here",
        ),
        (
            "E03",
            "energy in the data, worked out apart: 273589.5106, the last digits off by 1e-9 of it",
            "273589.51087 ft lb; not a published figure",
        ),
    ]
    entries = [{"where": where, "what": what, "instead": instead} for where, what, instead in found]
    for row in tabulated()["rows"]:
        if row["wrong"]:
            entries.append(
                {
                    "where": row["key"],
                    "what": f"tabulated delta-V {row['printed']} ft/s is {row['wrong']}",
                    "instead": "the readings",
                }
            )
    for row in corrupt_angles():
        entries.append(
            {
                "where": row["key"],
                "what": f"normal of {row['corrupt']} degrees in the input sheet, from a fill-down: "
                f"critical ratio {row['ratio_corrupt']:.2f}",
                "instead": f"{row['right']} degrees from the other sheet: {row['ratio_right']:.2f}",
            }
        )
    return entries
