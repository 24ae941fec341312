"""The tables of the page "Validation" for blind predictions and for the runs of a commercial
program.
"""

from __future__ import annotations

import math
from typing import Any

from blind.compare import KNOWN, READ_FIRST
from validation_tables import like, minus, off, table

DECIMALS = {"km/h": 1, "deg/s": 0, "kJ": 0}


def plain(value: float, unit: str, sign: str = "") -> str:
    """A figure of the blind tables, to the decimals of its unit; nought has no sign."""
    text = f"{value:{sign}.{DECIMALS[unit]}f}"
    return minus(text) if float(text) else text.lstrip("+-")


def answer_of(row: dict[str, Any], level: str) -> list[str]:
    """What a level predicts of a reading: the median with its range, the error, and whether it
    held.
    """
    answer, unit = row["levels"][level], row["unit"]
    low, high = (plain(end, unit) for end in answer["range"])
    error = (
        off(answer["percent"], "%")
        if answer["percent"] is not None
        else plain(answer["error"], unit, "+")
    )
    held = "held" if answer["held"] else f"**missed** by {plain(abs(answer['outside']), unit)}"
    return [f"{plain(answer['predicted'], unit)} ({low} to {high})", error, held]


def levels_of(found: dict[str, Any]) -> list[str]:
    """The names of the levels."""
    return list(found["blind"]["rows"][0]["levels"])


def predictions(found: dict[str, Any]) -> str:
    """Every reading of every crash."""
    levels = levels_of(found)
    rows = []
    for row in found["blind"]["rows"]:
        reading = plain(row["measured"], row["unit"])
        if row["second"] is not None:
            reading += f" or {plain(row['second'], row['unit'])}"
        rows.append(
            [
                row["test"],
                row["name"],
                row["unit"],
                reading,
                *(cell for level in levels for cell in answer_of(row, level)),
            ]
        )
    head = ["test", "reading", "unit", "measured"]
    head += [
        text for level in levels for text in (f"{level}: predicted (95 % range)", "error", "range")
    ]
    return table(head, rows, left=3)


def summary(found: dict[str, Any]) -> str:
    """Errors and ranges by group of tests, quantity and level."""
    rows = []
    for entry in found["blind"]["summaries"]:
        measure = entry["measure"]
        shown = [
            off(entry[name], "%") if measure == "%" else plain(entry[name], measure, "+")
            for name in ("mean", "worst")
        ]
        spread = [f"{entry[name]:.0f}" for name in ("sd", "half_width")]
        rows.append(
            [
                entry["group"],
                f"{entry['kind']}, {measure}",
                entry["level"],
                str(entry["readings"]),
                shown[0],
                spread[0],
                f"{shown[1]} ({entry['worst_of']})",
                spread[1],
                f"{entry['held']} of {entry['readings']}",
            ]
        )
    head = [
        "tests",
        "quantity",
        "level",
        "readings",
        "mean error",
        "standard deviation",
        "worst",
        "half of the range",
        "held",
    ]
    return table(head, rows, left=3)


def misses(found: dict[str, Any]) -> str:
    """Every reading that a range missed, and what the miss was found to be."""
    levels = levels_of(found)
    rows = [
        [
            row["test"],
            row["name"],
            *(answer_of(row, level)[2].replace("**", "") for level in levels),
            row["cause"],
            row["because"],
        ]
        for row in found["blind"]["rows"]
        if "cause" in row
    ]
    return table(
        ["test", "reading", *levels, "found to be", "because"], rows, left=2 + len(levels) + 2
    )


def self_checks(found: dict[str, Any]) -> str:
    """What the measurements of the staged crashes say of themselves."""
    rows = [
        [
            entry["test"],
            f"{100 * entry['unclosed']:.0f} %",
            minus(f"{entry['restitution']:.2f}"),
            *(
                minus(f"{math.degrees(entry[name]):.0f}")
                for name in ("direction_closing", "direction", "direction_predicted")
            ),
            *(
                minus(f"{entry[f'lever{which}_{side}']:.2f}")
                for side in ("a", "b")
                for which in ("", "_drawn")
            ),
            *(minus(f"{entry[name]:.2f}") for name in ("aside", "common")),
        ]
        for entry in found["blind"]["self_checks"]
    ]
    head = [
        "test",
        "momentum not closed",
        "restitution at the drawn point",
        "direction of closing, deg",
        "of the impulse",
        "of the predicted",
        "lever arm on A, m",
        "as drawn",
        "lever arm on B, m",
        "as drawn",
        "of a point aside, m",
        "of none, m",
    ]
    return table(head, rows)


def lever_words(found: dict[str, Any]) -> str:
    """What the check says of all staged crashes together, in words."""
    checks = found["blind"]["self_checks"]
    arms = [
        (entry[f"lever_{side}"], entry[f"lever_drawn_{side}"])
        for entry in checks
        for side in ("a", "b")
    ]
    rms = math.sqrt(sum((real - drawn) ** 2 for real, drawn in arms) / len(arms))
    aside, common = (
        math.sqrt(sum(entry[name] ** 2 for entry in checks) / len(checks))
        for name in ("aside", "common")
    )
    shorter = sum(abs(real) < abs(drawn) for real, drawn in arms)
    nearer = sum(
        abs(entry["direction"] - entry["direction_closing"])
        < abs(entry["direction_predicted"] - entry["direction_closing"])
        for entry in checks
    )
    return (
        "The lever arms that the yaw rates ask for differ from those of the drawn contact by "
        f"{rms:.2f} m (root mean square of {len(arms)}), and {shorter} of the {len(arms)} are "
        "shorter: a force at the drawn point would have turned the cars more. A point elsewhere "
        "moves both arms of a crash by as much, one up and one down, and so does a couple that a "
        "wide contact passes on; no measurement tells these apart. They account for "
        f"{aside:.2f} m (root mean square of {len(checks)}). The rest, {common:.2f} m, turns both "
        "cars the same way, which nothing between them does: it is of the tyres, the yaw inertias "
        "or the measurement. The cases state "
        f"0.2 m, at 95 percent, for each coordinate of the point. In {nearer} of {len(checks)} "
        "tests the impulse lay nearer to the closing velocity of the centres of mass than was "
        "predicted, as it does between cars that lock together over the width of their damage."
    )


def afterwards(found: dict[str, Any]) -> str:
    """How often other stated ranges would have held, and how wide they are."""
    entries = found["blind"]["afterwards"]
    kinds = list(dict.fromkeys((entry["kind"], entry["measure"]) for entry in entries))
    rows = [
        [
            tried,
            *(
                text
                for entry in entries
                if entry["tried"] == tried
                for text in _held_and_half(entry)
            ),
        ]
        for tried in dict.fromkeys(entry["tried"] for entry in entries)
    ]
    head = [
        "tried afterwards",
        *(text for kind, unit in kinds for text in (f"{kind}: held", f"half of the range, {unit}")),
    ]
    return table(head, rows)


def _held_and_half(entry: dict[str, Any]) -> tuple[str, str]:
    return f"{entry['held']} of {entry['readings']}", f"{entry['half_width']:.0f}"


def at_rest(found: dict[str, Any]) -> str:
    """The places of rest, predicted from before the impact."""
    rows = []
    for row in found["blind"]["at_rest"]:
        low, high = (metres(end) for end in row["range"])
        rows.append(
            [
                row["test"],
                row["name"],
                "held" if row["held"] else f"**missed** by {row['outside']:.1f} m, {row['cause']}",
                row["because"],
                metres(row["measured"]),
                f"{metres(row['predicted'])} ({low} to {high})",
            ]
        )
    head = ["test", "place of rest", "range", "because", "measured, m", "predicted (95 % range)"]
    return table(head, rows, left=4)


def metres(value: float) -> str:
    """A place to a decimetre; nought has no sign."""
    text = f"{value:.1f}"
    return minus(text) if float(text) else text.lstrip("-")


def at_rest_words(found: dict[str, Any]) -> str:
    """How many places of rest the ranges held, in words."""
    rows = found["blind"]["at_rest"]
    return (
        f"The ranges of 95 percent held {sum(row['held'] for row in rows)} of {len(rows)} "
        f"coordinates, of {len({row['test'] for row in rows})} crashes."
    )


def backwards(found: dict[str, Any]) -> str:
    """The speeds before the impact, worked out from what was measured."""
    rows = []
    for row in found["blind"]["backwards"]["rows"]:
        low, high = (plain(end, "km/h") for end in row["range"])
        rows.append(
            [
                row["test"],
                f"{row['speed']}, by {row['route']}",
                _held_or_missed(row),
                plain(row["known"], "km/h"),
                f"{plain(row['found'], 'km/h')} ({low} to {high})",
                off(row["percent"], "%"),
            ]
        )
    head = ["test", "speed before", "range", "known, km/h", "found (95 % range)", "error"]
    return table(head, rows, left=3)


def _held_or_missed(row: dict[str, Any]) -> str:
    """With the cause of a miss, and what the answer said of itself where its range held."""
    if not row["held"]:
        return f"**missed**, {row['cause']}"
    return "held, with a warning: contradicted" if row["contradicted"] else "held"


def backwards_summary(found: dict[str, Any]) -> str:
    """Errors and ranges of each route backwards."""
    rows = [
        [
            entry["route"],
            str(entry["speeds"]),
            off(entry["mean"], "%"),
            f"{entry['sd']:.0f} %",
            f"{off(entry['worst'], '%')} ({entry['worst_of']})",
            f"{entry['held']} of {entry['speeds']}",
        ]
        for entry in found["blind"]["backwards"]["summaries"]
    ]
    return table(["by", "speeds", "mean error", "standard deviation", "worst", "held"], rows)


def backwards_words(found: dict[str, Any]) -> str:
    """What adding readings did to the ranges from places of rest, in words."""
    alone, both = (
        next(one for one in found["blind"]["backwards"]["summaries"] if one["route"] == route)
        for route in ("places of rest alone", "places of rest and both delta-V")
    )
    missed = [
        row
        for row in found["blind"]["backwards"]["rows"]
        if "rest" in row["route"] and not row["held"]
    ]
    warned = sum(row["contradicted"] for row in missed)
    return (
        f"From places of rest alone {alone['held']} of {alone['speeds']} ranges held, and with "
        f"both delta-V besides {both['held']} of {both['speeds']}: readings that are added to a "
        "contact that is not right, or to one blow where there were two, make a range narrower "
        f"round a wrong speed. Of the {len(missed)} misses {warned} came with the warning that "
        "the evidence contradicts itself; of the others nothing warns."
    )


def without_answer(found: dict[str, Any]) -> str:
    """Where cases of a range had no answer, in words, and whether predictions are those first
    committed.
    """
    listed = [
        f"{entry['test']} {100 * entry['without_answer'] / entry['samples']:.1f} %"
        for entry in found["blind"]["without_answer"]
    ]
    level = {entry["level"] for entry in found["blind"]["without_answer"]}
    lines = []
    if listed:
        lines.append(
            f"Cases without an answer, left out of the ranges ({', '.join(sorted(level))}): "
            f"{', '.join(listed)}."
        )
    for name, count in found["blind"]["changed_since_first"].items():
        lines.append(
            "Medians and ends of ranges that differ from those first committed by more than a "
            f"hundredth of the range, {name}: {count or 'none'}."
        )
    return " ".join(lines)


def sources(found: dict[str, Any]) -> str:
    """Where the readings of every crash are from."""
    by_source: dict[str, list[str]] = {}
    for row in found["blind"]["rows"]:
        tests = by_source.setdefault(row["source"], [])
        if row["test"] not in tests:
            tests.append(row["test"])
    return "\n".join(f"- {', '.join(tests)}: {source}." for source, tests in by_source.items())


def headline(found: dict[str, Any]) -> str:
    """The blind predictions in a few sentences, made from the numbers."""
    parts = []
    for group, said in (
        (READ_FIRST, "staged crashes whose measurements were read after the inputs were fixed"),
        (KNOWN, "crashes whose measurements stood beside the inputs"),
    ):
        rows = [row for row in found["blind"]["rows"] if row["group"] == group]
        tests = len({row["test"] for row in rows})
        counts = {
            level: sum(row["levels"][level]["held"] for row in rows) for level in levels_of(found)
        }
        held = ", ".join(
            f"{count} of {len(rows)} ({100 * count / len(rows):.0f} %, {level})"
            for level, count in counts.items()
        )
        parts.append(f"{tests} {said}: the ranges of 95 percent held {held}.")
    for entry in found["blind"]["summaries"]:
        if entry["group"] == READ_FIRST and entry["measure"] == "%":
            parts.append(
                f"Of the former, {entry['kind']} ({entry['level']}): mean error "
                f"{off(entry['mean'], '%')}, standard deviation {entry['sd']:.0f} %, worst "
                f"{off(entry['worst'], '%')}."
            )
    parts.append("Ranges of 95 percent that hold less often than that are too narrow.")
    return "1. **Blind predictions of measured crashes**: " + " ".join(parts)


def commercial(found: dict[str, Any]) -> str:
    """The impacts of the commercial program, figure by figure, under both laws."""
    rows = []
    for row in found["commercial"]["impacts"]:
        cells = []
        for law in (
            found["commercial"]["law"],
            *(law for law in row["by_law"] if law != found["commercial"]["law"]),
        ):
            each = row["by_law"][law]
            difference = (
                off(each["difference"], "%")
                if row["measure"] == "%"
                else minus(f"{each['difference']:+.2f}")
            )
            cells += [like(each["computed"], row["printed"], 0), difference]
        rows.append([row["run"], row["name"], row["unit"], minus(row["printed"]), *cells])
    head = [
        "run",
        "figure",
        "unit",
        "PC-Crash",
        "kudlich-slibar",
        "difference",
        "brach",
        "difference",
    ]
    return table(head, rows, left=3)


def commercial_words(found: dict[str, Any]) -> str:
    """What that comparison shows, in words with its numbers."""
    theirs = found["commercial"]["law"]
    percents = [
        abs(row["by_law"][theirs]["difference"])
        for row in found["commercial"]["impacts"]
        if row["measure"] == "%"
    ]
    braking = found["commercial"]["braking"]
    pitching = found["commercial"]["below_the_centres"]
    stop = f"{braking['computed']:.2f} ft"
    return (
        f'Under `law="{theirs}"` speeds, delta-V, EES and the large yaw rate agree to '
        f"{max(percents):.1f} %. The impulse of "
        "the program is the smaller one in both runs, by the same share. Its contact lies 0.31 "
        "ft below the centres of mass, "
        "in three dimensions: between cars that can pitch the impulse is smaller by "
        f"{pitching:.2f} %, if their pitch inertia "
        "is their yaw inertia, which is not known. In line, vehicle 1 brakes at 0.3 g from "
        f"{braking['from']:g} s on and stops at {braking['printed']} ft; `travel.distance` says "
        f"{stop}."
    )


def commercial_motion(found: dict[str, Any]) -> str:
    """Where the cars of both runs are after the impact, and by how much the library's are
    elsewhere.
    """
    rows = []
    for row in found["commercial"]["motion"]:
        if "slope" in row["ground"]:
            continue  # in words only: its figures are nearly those above it
        rows.append(
            [
                f"{row['run']}, {row['ground']}",
                row["name"],
                f"{row['time']:.1f}",
                *(minus(f"{value:.2f}") for value in row["printed"].values()),
                *(minus(f"{value:+.2f}") for value in row["difference"].values()),
            ]
        )
    of = ["x, ft", "y, ft", "heading, deg", "speed, mph"]
    head = ["run", "car", "time, s", *of, *(f"off by, {unit.split(', ')[1]}" for unit in of)]
    return table(head, rows, left=2)


def commercial_motion_words(found: dict[str, Any]) -> str:
    """What of that motion differs, in words with its numbers."""
    off_by = {
        (row["ground"], row["name"], row["time"]): row["difference"]
        for row in found["commercial"]["motion"]
    }
    stop = off_by["0.3 g", "vehicle 1", 5.0]
    rolls = off_by["0.3 g", "vehicle 2", 5.0]
    turned = {
        ground: minus(f"{off_by[ground, 'vehicle 2', 2.0]['heading']:.0f}")
        for ground in ("friction 0.8", "friction 0.6", "friction 0.6, slope of the program")
    }
    course = off_by["friction 0.6", "vehicle 1", 5.0]
    short = minus(f"{stop['x']:+.2f}")
    faster = minus(f"{rolls['speed']:+.2f}")
    heads, aside = minus(f"{course['heading']:+.2f}"), minus(f"{course['y']:+.1f}")
    apart = found["commercial"]["scene_and_simulate_apart"]
    place = f"{max(apart['x'], apart['y']):g}"
    return (
        f"In line, vehicle 1 stops {short} ft from where the program has it, "
        f"and vehicle 2 rolls on {faster} mph faster: both are of the "
        "impact, whose impulse is the smaller one in the program; the braking is the same. Into "
        "the side the friction of the ground, the wheelbase and the track are not in the data; a "
        "guess of them is 9.2 ft, 5 ft and two frictions. With 0.8 vehicle 2 turned by "
        f"{turned['friction 0.8']} degrees differently until it turns no more, with 0.6 by "
        f"{turned['friction 0.6']}. The tyre model matters less than that: side force in the "
        "program is linear in the slip angle up to 10 degrees and then constant, here it bends "
        "(Fiala). With the slope of the program the difference is "
        f"{turned['friction 0.6, slope of the program']} degrees, and the same motion with the "
        "linear force, which a test integrates, ends within a degree of Fiala's. The figures are "
        "those of a `Scene`; `travel.simulate` from the same impact on is within "
        f"{place} ft and {apart['heading']:g} degrees of them. Vehicle 1 heads "
        f"{heads} degrees elsewhere, and is {aside} ft aside after 150 ft: its course follows its "
        "heading, and that is what little yaw the impact leaves it, 0.12 degrees per second in "
        "the program and −0.21 here, and what its tyres make of the 5 degrees of slip."
    )


def everything(found: dict[str, Any]) -> str:
    """All of these tables as text."""
    parts = [
        *(make(found) for make in (headline, summary, predictions, misses, self_checks)),
        *(make(found) for make in (lever_words, without_answer)),
        "To rest",
        *(make(found) for make in (at_rest_words, at_rest)),
        "Backwards",
        *(make(found) for make in (backwards_summary, backwards_words, backwards, afterwards)),
        "Two runs of a commercial program",
        *(make(found) for make in (commercial, commercial_words)),
        *(make(found) for make in (commercial_motion, commercial_motion_words)),
    ]
    return "\n\n".join(parts)
