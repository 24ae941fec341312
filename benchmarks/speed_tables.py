"""The tables and figures of the page "Speed against accuracy", made from the numbers that
benchmarks/speed.py wrote.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from stability_tables import GREY, INK, OURS, TEXTBOOK, number, table

from collisions.engine.batch import SCALAR_LIMIT

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated"
NOT_MEASURED = "not measured"


class Choice(NamedTuple):
    """A mark of the chart: its rows among the costs (one case, a batch), its row among the errors,
    its kind.
    """

    name: str
    single: str | None
    batch: str | None
    error: str
    kind: str = "ours"


CHOICES = (
    Choice("linear_central", "linear_central", "linear_central", "linear_central"),
    Choice("oblique_central", "oblique_central", "oblique_central", "oblique_central"),
    Choice("solve, tolerance 0.5 m/s", "solve_eccentric", "solve", "solve"),
    Choice("eccentric", "eccentric", "eccentric", "float64"),
    Choice("eccentric, two threads", None, "eccentric_threads", "float64"),
    Choice("eccentric, float32", None, "eccentric_float32", "float32"),
    Choice("eccentric, the other law where it sticks", "kudlich_slibar", "kudlich_slibar", "law"),
    Choice("textbook formula: bare floats, numpy", "formula", "numpy", "textbook", "other"),
    Choice("numba, textbook formula", None, "numba", "textbook", "other"),
    Choice("pymunk, one step", "pymunk", None, "pymunk", "other"),
    Choice(
        "eccentric, against a contact that takes time", "eccentric", "eccentric", "impulse", "time"
    ),
    Choice("left_out: its estimates of that", "left_out", "left_out", "left_out", "time"),
    Choice("time_resolved, 200 steps", "time_resolved", None, "time_resolved", "time"),
)
COLOURS = {"ours": OURS, "other": TEXTBOOK, "time": GREY}


class Call(NamedTuple):
    """A row of the first table: for whom, what to call, its rung, and its cost in a batch if it is
    one.
    """

    cases: str
    call: str
    rung: str
    batch: str | None = None


_IMPULSE = "eccentric, geometry of maximum engagement"
CALLS = (
    Call("one, or a few", "`eccentric`", _IMPULSE),
    Call("one, or a few", "`time_resolved(..., steps=10)`", "time_resolved, 10 steps"),
    Call("one, or a few", "`time_resolved(..., steps=100)`", "time_resolved, 100 steps"),
    Call("hundreds to millions", "`eccentric` with arrays", _IMPULSE, "eccentric"),
    Call("millions, little memory", "the same in float32", _IMPULSE, "eccentric_float32"),
)
FORMULA = 2e-6  # s: about what the unit takes, for the column of cases in a second alone


def load() -> dict[str, Any]:
    """The numbers."""
    return json.loads((DATA / "speed.json").read_text(encoding="utf-8"))


def load_contacts() -> dict[str, Any]:
    """The contacts followed in time."""
    return json.loads((DATA / "time_resolved.json").read_text(encoding="utf-8"))


def load_ladder() -> dict[str, Any]:
    """The rungs from the linear impact to a contact in time."""
    return json.loads((DATA / "ladder.json").read_text(encoding="utf-8"))


def rows(found: dict[str, Any], group: str) -> dict[str, Any]:
    """The costs of a group by key."""
    return {row["key"]: row for row in found[group]}


def percent(share: float) -> str:
    """A share in percent, with powers of ten where it is tiny."""
    return f"{number(100.0 * share)} %"


def spread(row: dict[str, Any]) -> str:
    """Quartiles of the rounds."""
    return f"{number(row['low'])} to {number(row['high'])}"


def machine(found: dict[str, Any]) -> str:
    """On what it was measured."""
    said, effort = found["machine"], found["effort"]
    return (
        f"Measured on {said['cores']} cores ({said['processor']}, {said['system']}), Python "
        f"{said['python']}, numpy {said['numpy']}; batches of {effort['cases']:,} cases, "
        f"{effort['rounds']} rounds of single cases and {effort['batch_rounds']} of batches."
    ).replace(",000", " 000")


def costs(found: dict[str, Any], group: str, keys: tuple[str, ...] | None = None) -> str:
    """What each choice costs a case, in textbook formulas."""
    known = rows(found, group)
    listed = [key for key in keys or known if key in known]
    return table(
        [
            {"single": "one case at a time", "batch": "in a batch, cost per case"}[group],
            "cost",
            "half of the rounds",
        ],
        [[known[key]["name"], number(known[key]["median"]), spread(known[key])] for key in listed],
    )


PROCESSOR = (
    "A thread waits for Python's interpreter lock before each of some two hundred numpy calls a "
    "block"
)


def threads(found: dict[str, Any]) -> str:
    """Whether a second thread was worth it in this run."""
    known = rows(found, "batch")
    share = known["eccentric_threads"]["median"] / known["eccentric"]["median"]
    two = rows(found, "budgets").get("processes")
    processes = (
        ""
        if two is None
        else f" Two processes with half of the cases each took {two['median']:.2f} of one's time."
    )
    took = f"a batch of `eccentric` on two threads took {share:.2f} of the time on one"
    worth = (
        f"In this run {took}."
        if share < 0.9
        else f"In this run a second thread was **not** worth it: {took}."
    )
    return f"{worth} {PROCESSOR}; processes do not.{processes}"


def sizes(found: dict[str, Any]) -> str:
    """Batches of every size against plain numpy."""
    lines = [
        [f"{row['cases']:,}".replace(",", " "), number(row["ratio"])] for row in found["sizes"]
    ]
    return table(["cases, nine outputs read", "cost against plain numpy"], lines)


def solving(found: dict[str, Any]) -> str:
    """What ``solve`` costs in a batch, and why."""
    known = {key: row["median"] for key, row in rows(found, "batch").items()}
    thirds = (
        sum(
            known[f"solve_all_{model}"]
            for model in ("linear_central", "oblique_central", "eccentric")
        )
        / 3.0
    )
    return (
        f"In a batch `solve` costs {number(known['solve'] / known['eccentric'])} times "
        "`eccentric`. Each case is worked out by its own model. Where a block of cases takes "
        "one model it costs just that; where models are mixed the cases of each are gathered "
        "and put back in their places: a third for each model, shuffled and without the "
        f"prediction, cost {number(known['solve_known'] / thirds)} times the mean of the three, "
        "each for all of the same cases. The prediction costs every case the same, because an "
        "error to 10 percent for any lever needs the impulse by all three models; the rest of "
        "their answers it leaves out."
    )


def memory(found: dict[str, Any]) -> str:
    """What batches take beside what goes in and comes out."""
    taken, cases = found["memory"], f"{found['effort']['cases']:,}".replace(",", " ")
    return (
        f"Beyond inputs, answers and the scratch that is kept for the next batch, {cases} cases "
        f"take {number(taken['eccentric'])} MiB in `eccentric`, {number(taken['solve'])} MiB in "
        f"`solve` and {number(taken['left_out'])} MiB in `left_out`, and no more with more "
        "cases. Each thread has scratch of its own: with two threads `eccentric` takes "
        f"{number(taken['eccentric_threads'])} and `solve` {number(taken['solve_threads'])} MiB."
    )


def quantities(found: dict[str, Any]) -> str:
    """What units cost in a batch."""
    known = rows(found, "batch")
    times = known["vehicle_quantities"]["median"] / known["vehicle"]["median"]
    share = (known["vehicle_quantities"]["median"] - known["vehicle"]["median"]) / known[
        "eccentric"
    ]["median"]
    return (
        "Make each `Vehicle` once. Units are converted there and cost nothing afterwards. In a "
        f"batch, a `Vehicle` made from Quantities costs {number(times)} times one made from "
        f"plain arrays; the difference is {100.0 * share:.0f} % of a batch of `eccentric`."
    )


def laws(found: dict[str, Any]) -> str:
    """To how many cases the row of the other law applies."""
    share = 100.0 * found["errors"]["choices"]["law"]["sticking"]
    return (
        f"The row of the other law is over the {share:.0f} % of cases that stick under one of "
        "the laws; elsewhere both agree."
    )


def drawn(found: dict[str, Any]) -> str:
    """How good the estimates of ``left_out`` are over random impacts."""
    sentences = []
    for drawn_as, frictions in found["frictions"].items():
        spread, ranges = found[drawn_as], []
        for key, name in (
            ("tyres", "tyres"),
            ("moving", "the geometry, from that of first contact"),
            ("engaged", "the geometry, from that of maximum engagement"),
        ):
            row = spread[key]
            least, low, *_, high, most = row["quantiles"]
            ranges.append(
                f"For {name} ({row['vehicles']} vehicles) it was {low:.2f} to {high:.2f} times "
                f"that change in 9 of 10, {least:.2f} to {most:.2f} times in all, and off by "
                f"more than a factor of 1.5 in {100.0 * row['outside_1.5']:.1f} %."
            )
        sentences.append(
            f"Over {spread['impacts']} random impacts of two cars without spin before, with a "
            f"friction of {frictions[0]:g} to {frictions[-1]:g} and a restitution of 0 to 0.4, "
            "the estimate was compared with the change followed in time wherever that is more "
            f"than {100.0 * spread['matters']:.0f} % of delta-V. {' '.join(ranges)}"
        )
    return "\n\n".join(sentences)


def budgets(found: dict[str, Any]) -> str:
    """Held, or missed by how much."""
    lines = []
    for row in found["budgets"]:
        if row["held"]:
            aim = row["aim"]
            outcome = "held" + (
                "" if aim is None else ", and the aim" if row["median"] <= aim else ", not the aim"
            )
        else:
            outcome = f"**missed by {100.0 * (row['median'] / row['budget'] - 1.0):.0f} %**"
        aim = "–" if row["aim"] is None else f"{row['aim']:g}"
        measured = f"{row['median']:.2g}" if row["median"] < 0.1 else f"{row['median']:.3g}"
        if row["low"] != row["high"]:
            measured += f" ({row['low']:.3g} to {row['high']:.3g})"
        lines.append([row["name"], f"{row['budget']:g}", aim, measured, outcome])
    text = table(["what", "budget", "aim", "median of five runs (their range)", ""], lines)
    return text.replace("| --- | ---: | ---: | ---: | ---: |", "| --- | ---: | ---: | ---: | --- |")


def budgets_held(found: dict[str, Any]) -> str:
    """How many budgets hold."""
    held = sum(row["held"] for row in found["budgets"])
    return f"{held} of {len(found['budgets'])} hold in this run."


def choices(found: dict[str, Any]) -> str:
    """Every choice of the chart: what it costs and what it errs by."""
    errors, lines = found["errors"]["choices"], []
    known = {group: rows(found, group) for group in ("single", "batch")}
    for at, choice in enumerate(CHOICES, 1):
        error = errors[choice.error]
        cells = []
        for group, key in (("single", choice.single), ("batch", choice.batch)):
            at_all = None if key is None else cost(known[group], choice, key)
            cells.append("–" if key is None else NOT_MEASURED if at_all is None else number(at_all))
        shown = (
            [NOT_MEASURED] * 2 if error is None else [percent(error["mean"]), percent(error["p95"])]
        )
        lines.append([f"{at}. {choice.name}", *cells, *shown])
    return table(
        ["choice", "cost of one case", "cost in a batch", "mean error", "19 of 20 err by less"],
        lines,
    )


def cost(known: dict[str, Any], choice: Choice, key: str) -> float | None:
    """Of a mark; what left_out costs comes on top of the impact."""
    if key not in known:
        return None
    return known[key]["median"] + (
        known["eccentric"]["median"] if choice.error == "left_out" else 0.0
    )


def calls(found: dict[str, Any], rungs: dict[str, Any]) -> str:
    """For this many cases, this accuracy and this much time, call this."""
    single, batch, lines = rows(found, "single"), rows(found, "batch"), []
    for one in CALLS:
        error = rungs["rungs"][one.rung]
        each = (
            single["eccentric"]["median"] * cost_of(rungs, one.rung)
            if one.batch is None
            else batch[one.batch]["median"]
        )
        half, most = (f"{100.0 * error[name]:.2g}\u00a0%" for name in ("median", "most_of_10"))
        within = f"{half}; 9 of 10 within {most}"
        second = f"{float(f'{1.0 / (each * FORMULA):.1g}'):,.0f}".replace(",", "\u202f")
        lines.append([one.cases, within, second, one.call])
    asked = single["eccentric"]["median"] * rungs["costs"]["required_model, 0.1 s"]
    second = f"{float(f'{1.0 / (asked * FORMULA):.1g}'):,.0f}".replace(",", "\u202f")
    lines.append(
        ["one, and you do not know", "what you accept", second,
         "`required_model(..., tolerance=, duration=)`"]
    )  # fmt: skip
    lines.append(
        ["a study that calls a dear model thousands of times", "that of the dear model", "–",
         "`posterior`, `propagate` or `fit` with [`finer=`](#the-dearer-model-where-it-matters)"]
    )  # fmt: skip
    text = table(["cases", "off by, of delta-V", "cases in a second", "call"], lines)
    return text.replace("| --- | ---: | ---: | ---: |", "| --- | --- | ---: | --- |")


def chosen(found: dict[str, Any]) -> str:
    """What ``solve`` took in mixed traffic."""
    solve = found["errors"]["choices"]["solve"]
    taken = ", ".join(
        f"`{model}` for {100.0 * share:.0f} %" for model, share in solve["chosen"].items()
    )
    return (
        f"In the mixed traffic of the chart, with a tolerance of {solve['tolerance']:g} m/s, "
        f"`solve` takes {taken} of the cases. The worst error is {number(solve['most'])} m/s."
    )


def at(found: dict[str, Any], group: str, key: str, x: float) -> dict[str, float]:
    """The point of a curve nearest to x."""
    curve = next(curve for curve in found["errors"][group] if curve["key"] == key)
    nearest = min(range(len(curve["x"])), key=lambda i: abs(curve["x"][i] - x))
    return {
        name: curve[name][nearest]
        for name in ("x", "error", "share", "delta_v_share", "predicted")
        if curve[name] is not None
    }


def curves(found: dict[str, Any], group: str) -> str:
    """Some points of the curves: the share of delta-V with rotation, and m/s."""
    head, wanted = {
        "levers": ("lever / radius of gyration", (0.1, 0.25, 0.5, 1.0, 1.5)),
        "angles": ("approach angle, degrees", (6, 10, 20, 30, 40, 60)),
    }[group]
    lines = []
    for x in wanted:
        points = [at(found, group, curve["key"], x) for curve in found["errors"][group]]
        lines.append(
            [
                number(points[0]["x"]),
                *(f"{percent(point['share'])}, {number(point['error'])} m/s" for point in points),
            ]
        )
    return table([head, *(curve["name"] for curve in found["errors"][group])], lines)


def prediction(found: dict[str, Any]) -> str:
    """How far ``required_model`` is off from the errors made, over all the curves."""
    pairs = [
        pair
        for group in ("levers", "angles")
        for curve in found["errors"][group]
        if curve["predicted"] is not None
        for pair in zip(curve["predicted"], curve["error"], strict=True)
    ]
    worst = max(abs(said - made) for said, made in pairs)
    apart = f"differ by {number(worst)} m/s at most" if worst else "agree"
    return (
        f"Over the {len(pairs)} points of the curves, prediction and error made {apart}, in the "
        "three digits that are kept."
    )


def contacts(found: dict[str, Any]) -> str:
    """The impulse against the contact that takes time, and what ``left_out`` said of it."""
    lines = []
    for row in found["rows"]:
        estimate = row["left_out"]
        lines.append(
            [
                f"{row['name']}, {row['side'].upper()}",
                number(row["delta_v"]),
                number(row["tyres"]["delta_v"]),
                number(estimate["tyre_delta_v"]),
                number(row["moving"]["delta_v"]),
                number(estimate["geometry_delta_v"]),
                number(row["engaged"]["delta_v"]),
                number(estimate["engaged_delta_v"]),
                percent(row["all"]["share"]),
            ]
        )
    return table(
        [
            "impact",
            "delta-V",
            "tyres: in time",
            "`left_out`",
            "geometry of first contact: in time",
            "`left_out`",
            "of maximum engagement: in time",
            "`left_out`",
            "tyres and first contact, of delta-V",
        ],
        lines,
    )


def cost_of(found: dict[str, Any], rung: str) -> float:
    """The cost of a rung: that of its model, however its places were found."""
    name = rung if rung in found["costs"] else rung.partition(", geometry")[0]
    if name.endswith(", from maximum engagement"):
        name = f"time_resolved, from maximum engagement, {name.split(', ')[1]}"
    cost: float = found["costs"][name]
    return cost


def ladder(found: dict[str, Any]) -> str:
    """Error and cost of every rung."""
    return table(
        ["rung", "median error", "9 of 10 err by less", "cost, in calls of `eccentric`"],
        [
            [name, percent(row["median"]), percent(row["most_of_10"]), number(cost_of(found, name))]
            for name, row in found["rungs"].items()
        ],
    )


def ladder_tyres(found: dict[str, Any]) -> str:
    """What the impulse errs by where tyres are all that it leaves out, without and with theirs from
    outside.
    """
    wheels, centre = (
        found["tyres_alone"][place] for place in ("four wheels", "the centre of mass")
    )
    return (
        "Where tyres are all that it leaves out (places that stay), the median error of "
        f"`eccentric` falls from {percent(wheels[0])} to {percent(wheels[1])} by the impulses "
        f"from outside; to {percent(centre[1])} of {percent(centre[0])} with all of the weight "
        "at the centre of mass: the estimate has no moment of the tyres."
    )


def ladder_by_speed(found: dict[str, Any]) -> str:
    """The error of the impulse by closing speed."""
    lines = [
        [f"{row['from']:g} to {row['to']:g}", percent(row["median"]), f"{row['impacts']}"]
        for row in found["by_closing_speed"]
    ]
    return table(["closing speed [m/s]", "median error of `eccentric`", "impacts"], lines)


def ladder_choices(found: dict[str, Any]) -> str:
    """What ``required_model`` took, and how often too little."""
    models = ("linear_central", "oblique_central", "eccentric", "time_resolved")
    lines = [
        [
            f"{row['tolerance']:g}",
            *(f"{row['models'].get(name, 0)}" for name in models),
            f"{row['wrong']} of {row['impacts']} ({percent(row['wrong_share'])})",
        ]
        for row in found["choices"]
    ]
    return table(
        ["tolerance [m/s]", *(f"`{name}`" for name in models), "beyond the tolerance"], lines
    )


def rivals(found: dict[str, Any]) -> str:
    """What else a user could take, beside ours."""
    known = {group: rows(found, group) for group in ("single", "batch")}
    errors, lines = found["errors"]["choices"], []
    for name, group, key, ours, error in (
        ("numba", "batch", "numba", "eccentric", "textbook"),
        ("numba", "batch", "numba_threads", "eccentric_threads", "textbook"),
        ("pymunk", "single", "pymunk", "eccentric_nine", "pymunk"),
    ):
        version, row = found["rivals"][name], known[group].get(key)
        if row is None:
            lines.append(
                [f"{name}, two threads" if key.endswith("threads") else name, *[NOT_MEASURED] * 4]
            )
            continue
        mine = known[group][ours]
        against = number(row["median"] / mine["median"])
        cells = [
            number(row["median"]),
            number(mine["median"]),
            against,
            percent(errors[error]["p95"]),
        ]
        lines.append([f"{row['name']} ({name} {version})", *cells])
    return table(["what", "its cost", "ours", "its cost / ours", "19 of 20 err by less"], lines)


def imports(found: dict[str, Any]) -> str:
    """Import times against numpy."""
    lines = []
    for name, row in found["imports"]["rows"].items():
        cells = [NOT_MEASURED] * 2 if row is None else [number(row["best"]), spread(row)]
        lines.append([f"`import {name}`", *cells])
    return table(["", "against numpy, best", "half of the rounds"], lines)


def break_even(found: dict[str, Any]) -> str:
    """From how many cases on arrays are worth it."""
    known = rows(found, "single")
    one, few = (
        known[key]["median"] / known["eccentric_nine"]["median"]
        for key in ("array_of_one", "array_of_few")
    )
    further = (few - one) / (SCALAR_LIMIT - 1)
    return (
        f"An array of one case costs as much as {number(one)} single cases. Up to {SCALAR_LIMIT} "
        f"cases are answered one by one, and each further one costs {number(further)} of a single "
        "case; beyond that each costs hardly anything. From about "
        f"{min(SCALAR_LIMIT + 1, math.ceil((one - further) / (1.0 - further)))} cases on, a batch "
        "is the faster way."
    )


def first_call(found: dict[str, Any]) -> str:
    """What numba takes to compile."""
    imports = found["rivals"]["numba_first_call"]
    if imports is None:
        return "numba: not measured."
    return (
        f"The first call of the loop in numba, which compiles it, takes as long as {imports:.0f} "
        "imports of numpy."
    )


def summary(found: dict[str, Any]) -> str:
    """The budgets, for people at a terminal."""
    lines = [machine(found)]
    for row in found["budgets"]:
        name = re.sub("`", "", row["name"])
        lines.append(
            f"  {name:80s}{row['median']:8.3g} of "
            f"{row['budget']:g}{'' if row['held'] else '   missed'}"
        )
    return "\n".join([*lines, budgets_held(found)])


# --- Figures --------------------------------------------------------------------------------------


@contextmanager
def drawing() -> Iterator[Any]:
    """Pyplot in the style of the pages."""
    import matplotlib as mpl

    mpl.use("agg")
    style = {
        "font.size": 11, "font.family": "DejaVu Sans", "figure.facecolor": "white",
        "savefig.facecolor": "white",
        "svg.fonttype": "path", "svg.hashsalt": "collisions",
    }  # fmt: skip
    with mpl.rc_context(style):
        import matplotlib.pyplot as plt

        yield plt


def draw_all(
    found: dict[str, Any], contacts: dict[str, Any], folder: Path, kind: str = "svg"
) -> None:
    """Every figure of the page."""
    figures = {
        "speed_choices": lambda plt: choices_figure(plt, found),
        "speed_errors": lambda plt: errors_figure(plt, found),
        "speed_contacts": lambda plt: contacts_figure(plt, contacts),
        "speed_ladder": lambda plt: ladder_figure(plt, load_ladder()),
    }
    blank = {
        "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
        "png": {"Software": None},
    }[kind]
    for name, draw in figures.items():
        path = folder / f"{name}.{kind}"
        with drawing() as plt:
            figure = draw(plt)
            figure.savefig(path, metadata=blank, dpi=110)
            plt.close(figure)
        if kind == "svg":  # browsers need no document type, and nothing should point elsewhere
            path.write_text(
                re.sub(r"<!DOCTYPE[^>]*>\s*", "", path.read_text(encoding="utf-8")),
                encoding="utf-8",
            )


def ladder_figure(plt: Any, found: dict[str, Any]) -> Any:
    """Error against cost of every rung: the median, with a line up to what 9 of 10 stay below."""
    figure, axis = plt.subplots(figsize=(11.5, 5.6))
    for name, row in found["rungs"].items():
        cost, timed = cost_of(found, name), name.startswith("time_resolved")
        colour = TEXTBOOK if "maximum" in name and timed else OURS if timed else GREY
        axis.plot(
            [cost, cost], [100.0 * row["median"], 100.0 * row["most_of_10"]], color=colour, lw=1.5
        )
        axis.plot(cost, 100.0 * row["median"], "s" if timed else "o", color=colour, ms=7)
        text = (
            name.replace("time_resolved, ", "")
            .replace("_central", " central")
            .replace(", from", ", places\nfrom")
        )
        text = text.replace("eccentric, geometry of", "eccentric, places of")
        text = text.replace(" maximum engagement, tyres", "\nmaximum engagement, tyres")
        lower = name.endswith("maximum engagement") and not timed
        left = name == "linear_central" or (timed and "maximum" not in name)
        place = (-9 if left else 9, -14 if lower else -3)
        side = "right" if left else "left"
        axis.annotate(
            text,
            (cost, 100.0 * row["median"]),
            place,
            textcoords="offset points",
            ha=side,
            fontsize=9.5,
        )
    axis.set(
        xscale="log",
        yscale="log",
        xlabel="cost, in calls of eccentric",
        ylabel="error [% of delta-V]",
    )
    low, high = axis.get_xlim()
    axis.set_xlim(0.35 * low, 6.0 * high)
    axis.grid(color="#e2e2e2", lw=0.6)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    return figure


def choices_figure(plt: Any, found: dict[str, Any]) -> Any:
    """A row for every choice: what it errs by, the worst first, and what it costs; circles are one
    case at a time, squares a batch.
    """
    errors = found["errors"]["choices"]
    known = {group: rows(found, group) for group in ("single", "batch")}
    shown = [
        (errors[choice.error], at, choice)
        for at, choice in enumerate(CHOICES, 1)
        if errors[choice.error] is not None
    ]
    shown.sort(key=lambda row: -row[0]["mean"])
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 5.6), sharey=True)
    for row, (error, _, choice) in enumerate(shown):
        colour = COLOURS[choice.kind]
        left.plot([error["mean"], error["p95"]], [row, row], color=colour, lw=1.6, alpha=0.6)
        left.plot(error["mean"], row, "D", ms=7, color=colour)
        for group, key, mark in (("single", choice.single, "o"), ("batch", choice.batch, "s")):
            x = None if key is None else cost(known[group], choice, key)
            if x is not None:
                right.plot(x, row, mark, ms=8, mfc="white", mec=colour, mew=2.0)
    left.set_yticks(range(len(shown)), [f"{choice.name}  {at}" for _, at, choice in shown])
    for label, (_, _, choice) in zip(left.get_yticklabels(), shown, strict=True):
        label.set_color(COLOURS[choice.kind])
    left.invert_yaxis()
    for axis, ticks in ((left, range(-16, 1, 4)), (right, range(-2, 4))):
        axis.set_xscale("log")
        axis.minorticks_off()
        axis.grid(color="#e3e3e3", lw=0.8)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
        axis.set_xticks([10.0**k for k in ticks], [_power(k, axis is left) for k in ticks])
    left.set_xlabel("mean error, of delta-V; line: 19 in 20 err by less")
    right.set_xlabel("cost of a case; 1 is the formula in bare floats")
    marks = [
        plt.Line2D([], [], ls="", marker=mark, mfc="white", mec=INK, ms=9, label=label)
        for mark, label in (("o", "one case at a time"), ("s", "in a batch"))
    ]
    right.legend(handles=marks, loc="lower right", frameon=True, fontsize=10)
    figure.tight_layout()
    return figure


def _power(k: int, share: bool) -> str:
    """A tick: a share from a ten thousandth on is in percent, other small numbers are powers."""
    if share and k >= -4:
        return f"{100.0 * 10.0**k:g} %"
    return f"{10.0**k:g}" if -3 < k < 4 else f"10{_raised(k)}"


def _raised(power: int) -> str:
    return str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


STYLES = ("-", (0, (6, 2)), (0, (1, 1.5)), (0, (7, 2, 1, 2)), (0, (3, 1.5)))
SHADES = (OURS, TEXTBOOK, "#a01040", "#2b7a3d", GREY)


def errors_figure(plt: Any, found: dict[str, Any]) -> Any:
    """The error of the central models over lever and angle; crosses are what ``required_model``
    predicts.
    """
    figure, axes = plt.subplots(1, 2, figsize=(11.5, 5.4))
    closing = 15.0
    for axis, group, label in (
        (axes[0], "levers", "lever / radius of gyration"),
        (axes[1], "angles", "angle between relative velocity and normal, degrees"),
    ):
        for curve, style, colour in zip(found["errors"][group], STYLES, SHADES, strict=False):
            axis.plot(
                curve["x"],
                [100.0 * share for share in curve["share"]],
                ls=style,
                color=colour,
                lw=2,
                label=curve["name"],
            )
            if curve["predicted"] is not None:
                scale = [
                    share / error if error else 0.0
                    for share, error in zip(curve["share"], curve["error"], strict=True)
                ]
                said = [100.0 * s * p for s, p in zip(scale, curve["predicted"], strict=True)]
                axis.plot(curve["x"][::3], said[::3], "x", color=colour, ms=6, mew=1.5)
        axis.set_xlabel(label)
        axis.set_ylim(0.0, 150.0 if group == "levers" else 100.0)
        axis.set_xlim(0.0, curve["x"][-1])
        axis.grid(color="#e3e3e3", lw=0.8)
        axis.spines[["top", "right"]].set_visible(False)
        axis.legend(loc="upper left", frameon=True, framealpha=0.95, edgecolor="none", fontsize=9.5)
    axes[0].plot([], [], "x", color=INK, ms=6, mew=1.5, label="predicted by required_model")
    axes[0].legend(loc="upper left", frameon=True, framealpha=0.95, edgecolor="none", fontsize=9.5)
    axes[0].set_ylabel("error with rotation, % of delta-V")
    axes[0].set_title("oblique central: the lever left out", fontsize=11)
    axes[1].set_title(f"an approach at an angle, {closing:g} m/s along the normal", fontsize=11)
    figure.tight_layout()
    return figure


def contacts_figure(plt: Any, found: dict[str, Any]) -> Any:
    """What tyres and moving geometry do to delta-V: followed in time, and as
    ``left_out`` has it.
    """
    listed = [row for row in found["rows"] if row["side"] == "b" or row["scene"] == "wall"]
    figure, axes = plt.subplots(1, 3, figsize=(11.5, 4.6), sharey=True)
    for axis, reference, estimate, title in (
        (axes[0], "tyres", "tyre_delta_v", "tyres that slide"),
        (axes[1], "moving", "geometry_delta_v", "geometry given at first contact"),
        (axes[2], "engaged", "engaged_delta_v", "geometry given at maximum engagement"),
    ):
        for at, row in enumerate(listed):
            size = row["delta_v"]
            true, said = (
                100.0 * row[reference]["delta_v"] / size,
                100.0 * row["left_out"][estimate] / size,
            )
            axis.plot([true, said], [at, at], color="#c9c9c9", lw=2, zorder=1)
            axis.plot(true, at, "s", color=TEXTBOOK, ms=9, zorder=2)
            axis.plot(said, at, "o", mfc="white", mec=OURS, mew=1.8, ms=8, zorder=3)
        axis.set_title(title, fontsize=11)
        axis.set_xlim(-1.0, None)
        axis.grid(axis="x", color="#e3e3e3", lw=0.8)
        axis.set_axisbelow(True)
        axis.tick_params(axis="y", length=0)
        axis.spines[["top", "right", "left"]].set_visible(False)
        axis.set_xlabel("change of delta-V, % of it")
    axes[0].set_yticks(range(len(listed)), [row["name"] for row in listed])
    axes[0].set_ylim(len(listed) - 0.4, -0.6)
    marks = [
        plt.Line2D([], [], ls="", marker="s", color=TEXTBOOK, ms=9, label="time_resolved"),
        plt.Line2D(
            [],
            [],
            ls="",
            marker="o",
            mfc="white",
            mec=OURS,
            mew=1.8,
            ms=8,
            label="estimate of left_out",
        ),
    ]
    figure.legend(handles=marks, loc="upper center", ncols=2, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.93))
    return figure
