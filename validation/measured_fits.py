"""Table 4: measured tests whose inputs were tuned to their own measurement. A good fit is no
prediction.
"""

from __future__ import annotations

import statistics
from dataclasses import replace
from typing import Any

import numpy as np
import solutions
from published_cases import case_of, figure, output
from published_records import (
    EXAMPLES,
    LAWS,
    OVERLAP,
    PERCENT,
    Case,
    Figure,
    difference,
    half_unit,
    rounded,
    rows_of,
    summary,
)
from solutions import barrier_figures, barrier_impact, rounding_of_the_barrier_centre

FOOT = 0.3048
TUNED = (
    "restitution_e",
    "impulse_ratio_percent_of_critical",
    "impact_center_distance_ft",
    "impact_center_angle_deg",
)
READINGS = {
    "delta-V rearward": ("measured_delta_vx_ft_s_rearward", "ft/s"),
    "delta-V to the right": ("measured_delta_vy_ft_s", "ft/s"),
    "delta-V": ("root_sum_square_of_measured_ft_s", "ft/s"),
    "yaw rate": ("measured_delta_yaw_rate_deg_s", "deg/s"),
}


def against_barrier(
    row: dict[str, str], law: str, normal: str = "contact_normal_angle_deg"
) -> dict[str, float]:
    """What the library computes for a test: by reading, in the unit of the sheet."""
    return barrier_figures(barrier_impact(row, law, normal))


def figures_of(row: dict[str, str], computed: dict[str, dict[str, float]]) -> list[Figure]:
    """The readings of a test beside what is computed under each law."""
    return [
        Figure(name, name, unit, row[column], {law: computed[law][name] for law in LAWS})
        for name, (column, unit) in READINGS.items()
    ]


def barrier_test(row: dict[str, str], tuned: dict[str, str] | None = None) -> Case:
    """A small-overlap test with its own tuned inputs, or with those given."""
    used = {**row, **(tuned or {})}
    computed = {law: against_barrier(used, law) for law in LAWS}
    name = row["test_id"]
    records = [f"{OVERLAP}: {name}", *([f"{EXAMPLES}: E09"] if name == "CF11016" else [])]
    percent = f"{float(used['impulse_ratio_percent_of_critical']):g}"
    notes = []
    if tuned is None and (float(row["restitution_e"]) == 0 or float(percent) == 100):
        notes.append(
            "The fit ended at the edge of what was allowed (e = 0 or 100 percent), so a misfit "
            "is left."
        )
    if row["inertia_basis"].startswith("proxy"):
        notes.append("Radius of gyration of the Ford Fusion, as a proxy.")
    centre = (
        f"{float(used['impact_center_distance_ft']):g} ft at "
        f"{float(used['impact_center_angle_deg']):g}°"
    )
    inputs = (
        f"e = {float(used['restitution_e']):g}, {percent} % of the critical ratio, impact centre "
        f"{centre}"
    )
    title = (
        f"{row['model_year']} {row['vehicle']}, {row['barrier'].lower()}, "
        f"{100 * float(row['overlap_fraction']):g} % overlap"
    )
    return Case(
        name, title, records, row["source"], figures_of(row, computed), inputs=inputs, notes=notes
    )


def low_speed_test() -> Case:
    """L11: the restitution is that of the two measured delta-Vs."""
    computed = solutions.low_speed_test("L11")
    measured = [replace(figure("L11", name, computed[name]), remark="") for name in ("dV1", "dV2")]
    case = case_of(
        "L11",
        measured,
        notes=[
            (
                "The measured pair misses the balance of momentum by 9 percent, which no "
                "restitution can mend."
            )
        ],
    )
    return replace(
        case,
        title="Ford Fiesta into Volkswagen Polo, rear end, 5.5 mph",
        inputs=f"e = {output('L11', 'e_from_data'):g} from the two readings",
    )


def cases() -> list[Case]:
    """Every case of table 4."""
    return [low_speed_test(), *(barrier_test(row) for row in rows_of(OVERLAP))]


def held_out() -> list[Case]:
    """Every small-overlap test with the medians of what was tuned in the nine others: a test the
    inputs have not seen.
    """
    rows = rows_of(OVERLAP)
    found = []
    for row in rows:
        others = [other for other in rows if other is not row]
        medians = {
            name: repr(statistics.median(float(other[name]) for other in others)) for name in TUNED
        }
        found.append(barrier_test(row, medians))
    return found


def tabulated() -> dict[str, Any]:
    """The delta-V that the sheet tabulates, which is the answer of its own fit and no reading."""
    found = []
    for row in rows_of(OVERLAP):
        ours, printed = (
            rounded(against_barrier(row, "brach")["delta-V"]),
            row["tabulated_delta_v_ft_s"],
        )
        spread = half_unit(printed) + rounding_of_the_barrier_centre(row)
        said = ""
        if "equals the fitted-model value" not in row["note"]:
            said = (
                f"neither the fit's own answer ({ours:.2f}) nor the root sum square of the "
                f"readings ({row['root_sum_square_of_measured_ft_s']})"
            )
        found.append(
            {
                "key": row["test_id"],
                "printed": printed,
                "computed": ours,
                "difference": difference(ours, printed, PERCENT),
                "within_print": abs(ours - float(printed)) <= spread,
                "wrong": said,
            }
        )
    sound = summary((entry["key"], entry["difference"]) for entry in found if not entry["wrong"])
    return {
        "rows": found,
        "sound": sound,
        "all": summary((entry["key"], entry["difference"]) for entry in found),
    }


def misfit(row: dict[str, str], **tuned: Any) -> Any:
    """How far the answer is from the three readings, in ft/s: the delta-V vector, and radius of
    gyration times yaw rate.
    """
    impact = barrier_impact(row, **tuned)
    car, side = impact.a.before, barrier_figures(impact)
    gyration = (car.yaw_inertia / car.mass) ** 0.5 / FOOT
    off = [
        side[name] - float(row[READINGS[name][0]])
        for name in ("delta-V rearward", "delta-V to the right", "yaw rate")
    ]
    return np.sqrt(off[0] ** 2 + off[1] ** 2 + (gyration * np.radians(off[2])) ** 2)


def refitted() -> list[dict[str, Any]]:
    """The tests whose fit ended at e = 0, with restitution and share of the critical ratio free on
    both sides of it.

    The least misfit of a grid, of ever finer ones around it; the normal and the impact centre stay
    those of the sheet.
    """
    found = []
    for row in rows_of(OVERLAP):
        if float(row["restitution_e"]) != 0.0:
            continue
        e, share, reach = 0.0, 0.8, np.array([0.4, 0.2])
        while reach[0] > 1e-5:
            around = np.linspace(-1.0, 1.0, 41)
            es, shares = np.meshgrid(
                e + reach[0] * around, np.clip(share + reach[1] * around, 0.0, 1.0)
            )
            off = misfit(row, restitution=es, share=shares)
            best = np.unravel_index(np.argmin(off), off.shape)
            e, share, reach = float(es[best]), float(shares[best]), reach / 4.0
        before, after = float(misfit(row)), float(misfit(row, restitution=e, share=share))
        entry = {
            "key": row["test_id"],
            "restitution": round(e, 3),
            "percent": round(100.0 * share, 1),
        }
        found.append({**entry, "misfit_at_0": rounded(before), "misfit": rounded(after)})
    return found


def corrupt_angles() -> list[dict[str, Any]]:
    """The critical ratio with the normal of the corrupt input sheet, beside that with the right
    one.
    """
    return [
        {
            "key": row["test_id"],
            "right": row["contact_normal_angle_deg"],
            "corrupt": row["contact_normal_angle_deg_in_corrupt_sheet"],
            "ratio_right": rounded(against_barrier(row, "brach")["critical impulse ratio"]),
            "ratio_corrupt": rounded(
                against_barrier(row, "brach", "contact_normal_angle_deg_in_corrupt_sheet")[
                    "critical impulse ratio"
                ]
            ),
        }
        for row in rows_of(OVERLAP)
        if row["contact_normal_angle_deg_in_corrupt_sheet"]
    ]
