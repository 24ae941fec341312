"""Table 3: what others computed, computed again."""

from __future__ import annotations

from published_cases import CASES, SOLUTIONS, case_of, figure
from published_records import OBLIQUE, RESTITUTION, Case, Figure, rows_of
from solutions import TESTS, carpenter_impact, carpenter_normal

ORDER = (
    *("L01", "L03", "L05", "L07", "L08", "L10"),
    *("M01", "M03", "M05", "M07", "M09", "M10", "O01", "O02"),
    *("C01", "C03", "C04", "E01", "E03", "E06", "E07", "E12"),
)
FITTED = (
    "The published figures are those of a planar impact solution with the no-slip rule of Brach. "
    "Its authors chose restitution, normal and impact centres so that it fits the crash test; "
    "the readings of the test are not in these data."
)


def notes(case: str) -> list[str]:
    """What a reader of the page must know of a case."""
    published = CASES[case]["published_outputs"]
    if case == "M10":
        return [
            "Closing velocity and restitution are on the line of the two centres, as in the source."
        ]
    if case == "E01":
        return [
            (
                "The contact 1 ft above the centre was inferred from the two printed answers: "
                "one of the two had to agree."
            )
        ]
    if case in TESTS:
        return [FITTED]
    if case == "E07":
        return [
            (
                f'The source says "{published["status"]}", the library '
                f'"{carpenter_impact(carpenter_normal()).regime}".'
            ),
            (
                "The sheet enters the normal of the test as a tangent. Its arithmetic is right, "
                "but it is no model of the test."
            ),
        ]
    if case == "E12":
        return [
            f"Published as formulas: {published['tan_difference']} and {published['spin_change']}."
        ]
    return []


def rows_beside(case: str) -> list[str]:
    """The records of other files that are the same test."""
    if case not in TESTS:
        return []
    test = TESTS[case]
    (closing,) = (row for row in rows_of(RESTITUTION) if row["data_set"] == f"NHTSA {test}")
    return [
        *(f"{OBLIQUE}: {test} vehicle {i}" for i in "12"),
        f"{RESTITUTION}: NHTSA {test} {closing['closing_speed']} {closing['closing_speed_unit']}",
    ]


def figures(case: str) -> list[Figure]:
    """The published figures of a case, as its first solution computes them."""
    found = SOLUTIONS[case][0](case)
    if case != "E12":
        return [
            figure(case, name, ours)
            for name, ours in found.items()
            if name in CASES[case]["published_outputs"]
        ]
    # Formulas, with their values at the example of the data.
    expected = CASES[case]["recomputed_outputs"]
    return [
        Figure(
            quantity,
            name,
            unit,
            str(expected[f"expected_{name}"]["value"]),
            found[f"{name}_example"],
        )
        for quantity, name, unit in (
            ("ratio of velocities", "tan_difference", ""),
            ("yaw rate", "spin_change", "rad/s"),
        )
    ]


def cases() -> list[Case]:
    """Every such case."""
    return [case_of(case, figures(case), *rows_beside(case), notes=notes(case)) for case in ORDER]
