"""Uncertainty, measured: error against cost of every method, where the local ones fail, and how
often intervals hold the truth.

``python benchmarks/uncertainty.py`` runs all of it in a few minutes and writes
docs/_generated/uncertainty.json and the figures in docs/_static. ``--quick`` measures less, to see
that everything runs; ``--json PATH`` writes there, without figures. ``--keep-reference`` takes the
reference from the file that is there, if it is of the same inputs.

The reference is ten million cases a scene, drawn by numpy's own generator: none of the package's
points or distributions is in it. Its standard errors are those between its blocks. The error of a
method is the root of the mean square over many seeds, in standard deviations of the output: the
scatter between the seeds, and their offset from the reference as far as that exceeds what the
reference and so many seeds leave open. Costs are ratios to the textbook formula as a bare function
of floats, timed in turn with each run.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import uncertainty_coverage as coverage
from speed import FIGURES as FOLDER
from speed import UNIT, machine, say, single_works
from uncertainty_coverage import rounded
from uncertainty_scenes import (
    BY_KEY,
    ENDS,
    LOCAL,
    SAMPLED,
    SCENES,
    Scene,
    drawn,
    errors,
    figures,
    listening,
    run,
)

from collisions import NoSolutionError
from collisions.estimate.fit import fit
from collisions.uncertainty import Normal

DATA = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "uncertainty.json"
BLOCK = 25_000
SEED = 20250311
# Of Student's distribution with 15 degrees of freedom, which an error between 16 sequences of
# points has.
STUDENT = 2.131
CHANCE = 3.0
NOTICED = 0.1  # standard deviations: the difference that a local method says it warns of


class Effort(NamedTuple):
    """How much is measured."""

    blocks: int
    rounds: int
    sizes: tuple[tuple[int, int], ...]
    scenes: int
    fits: int
    positions: int
    position_samples: int


FULL = Effort(
    400, 15, ((7, 64), (9, 64), (11, 64), (13, 32), (15, 16), (17, 16)), 600, 500, 31, 2**15
)
QUICK = Effort(2, 2, ((7, 4), (11, 4)), 2, 1, 3, 2**10)

# --- Reference ------------------------------------------------------------------------------------


def reference(scene: Scene, blocks: int) -> dict[str, Any]:
    """Mean, standard deviation, ends of the 95 percent interval and a histogram, from so many
    blocks of plain cases.
    """
    generator = np.random.default_rng([SEED, list(BY_KEY).index(scene.key)])
    parts, each = [], []
    with listening():
        for _ in range(blocks):
            (values,) = scene.model(**drawn(scene.inputs, generator, BLOCK)).values()
            values = np.asarray(values)
            values = values[~np.isnan(values)]
            parts.append(values)
            each.append(figures_of(values))
    whole = np.concatenate(parts)
    low, high = np.quantile(whole, (0.0005, 0.9995))
    shares, edges = np.histogram(whole, 80, (float(low), float(high)))
    return {
        "inputs": {name: repr(known) for name, known in scene.inputs.items()},
        "cases": blocks * BLOCK,
        "failed": blocks * BLOCK - whole.size,
        "figures": [rounded(value, 8) for value in figures_of(whole)],
        "standard_errors": [
            rounded(value) for value in np.std(each, axis=0, ddof=1) / math.sqrt(blocks)
        ],
        "edges": [rounded(edge, 6) for edge in edges.tolist()],
        "shares": [rounded(share / whole.size) for share in shares.tolist()],
    }


def figures_of(values: Any) -> list[float]:
    """Mean, standard deviation, and both ends of the 95 percent interval."""
    return [
        float(np.mean(values)),
        float(np.std(values, ddof=1)),
        *np.quantile(values, ENDS).tolist(),
    ]


def references(effort: Effort, old: Mapping[str, Any] | None) -> dict[str, Any]:
    """Those of all scenes, anew or from a file."""
    found = {}
    for scene in SCENES:
        say(f"reference: {scene.name}")
        before = (old or {}).get(scene.key)
        stated = {name: repr(known) for name, known in scene.inputs.items()}
        same = (
            before is not None
            and before["inputs"] == stated
            and before["cases"] == effort.blocks * BLOCK
        )
        found[scene.key] = before if same else reference(scene, effort.blocks)
    return found


# --- Error against cost ---------------------------------------------------------------------------


class Stopwatch:
    """Seconds spent in a model, and in all."""

    def __init__(self, model: Callable[..., Any]) -> None:
        self.model = model
        self.inside = 0.0

    def __call__(self, **inputs: Any) -> Any:
        start = time.perf_counter()
        try:
            return self.model(**inputs)
        finally:
            self.inside += time.perf_counter() - start


def formula_seconds(calls: int = 400) -> float:
    """Of one textbook formula, now."""
    call = WORKS[UNIT].call
    start = time.perf_counter()
    for _ in range(calls):
        call()
    return (time.perf_counter() - start) / calls


WORKS = single_works()


def watched(
    scene: Scene, method: str, **how: Any
) -> tuple[list[float], list[float], list[str], int, list[float]]:
    """A run: its figures, their stated errors, warnings, cases; and its cost in formulas: drawing,
    physics, statistics.
    """
    unit = formula_seconds()
    watch = Stopwatch(scene.model)
    start = time.perf_counter()
    found, codes = run(scene._replace(model=watch), method, **how)
    middle = time.perf_counter()
    said = figures(found), errors(found)
    end = time.perf_counter()
    parts = [middle - start - watch.inside, watch.inside, end - middle]
    return *said, codes, found.samples, [part / unit for part in parts]


def local_row(scene: Scene, method: str, against: Mapping[str, Any], rounds: int) -> dict[str, Any]:
    """Of a method that differentiates: what it errs by, and whether it warned."""
    runs = [watched(scene, method) for _ in range(rounds)]
    said, _, codes, cases, _ = runs[0]
    true, sd = against["figures"], against["figures"][1]
    return {
        "scene": scene.key,
        "method": method,
        "samples": cases,
        "figures": [rounded(value, 6) for value in said],
        "error": [rounded((one - other) / sd) for one, other in zip(said, true, strict=True)],
        "warned": "not_local" in codes,
        "cost": rounded(statistics.median(sum(parts) for *_, parts in runs)),
    }


def sampled_row(
    scene: Scene, method: str, power: int, seeds: int, against: Mapping[str, Any]
) -> dict[str, Any]:
    """Of a method that draws: root mean square errors over the seeds, and how good the errors are
    that it states itself.
    """
    runs = [watched(scene, method, samples=2**power, seed=seed) for seed in range(seeds)]
    values, stated = (np.array([one[i] for one in runs]) for i in (0, 1))
    true, own = np.array(against["figures"]), np.array(against["standard_errors"])
    spread = np.std(values, axis=0, ddof=1)
    offset = np.mean(values, axis=0) - true
    open_ = np.sqrt(spread**2 / seeds + own**2)
    # The reference is off by chance as well: at large sizes it is the least accurate of all.
    error = np.sqrt(spread**2 + np.where(np.abs(offset) > CHANCE * open_, offset**2, 0.0))
    others = (np.sum(values, axis=0) - values) / (seeds - 1), spread / math.sqrt(seeds - 1)
    sharper = others[1] < own
    middle, about = np.where(sharper, others[0], true), np.where(sharper, others[1], own)
    within = np.mean(np.abs(values - middle) <= STUDENT * np.sqrt(stated**2 + about**2), axis=0)
    parts = np.median([one[4] for one in runs], axis=0)
    # How many plain cases would err as little, by the standard errors of the reference.
    worth = against["cases"] * (own / error) ** 2 / 2**power
    return {
        "scene": scene.key,
        "method": method,
        "samples": 2**power,
        "seeds": seeds,
        "error": [rounded(value) for value in (error / true[1]).tolist()],
        "offset": [rounded(value) for value in (offset / open_).tolist()],
        "stated": [
            rounded(value) for value in (np.sqrt(np.mean(stated**2, axis=0)) / spread).tolist()
        ],
        "within": [rounded(value) for value in within.tolist()],
        "worth": [rounded(value) for value in worth.tolist()],
        "cost": rounded(float(np.sum(parts))),
        "parts": [rounded(value) for value in (parts / np.sum(parts)).tolist()],
    }


def trade(
    effort: Effort, against: Mapping[str, Any]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """A row for every scene, method and size: those of the local methods, and those of sampling."""
    local, sampled = [], []
    for scene in SCENES:
        say(f"error against cost: {scene.name}")
        run(scene, LOCAL[0])
        local += [local_row(scene, method, against[scene.key], effort.rounds) for method in LOCAL]
        for power, seeds in effort.sizes:
            sampled += [
                sampled_row(scene, method, power, seeds, against[scene.key]) for method in SAMPLED
            ]
    return local, sampled


# --- Where local methods fail ---------------------------------------------------------------------


def _restitution(x: float) -> dict[str, Normal]:
    return {"restitution": Normal(x, 0.1, truncate=(0.0, 1.0))}


def _friction(x: float) -> dict[str, Normal]:
    return {"friction": Normal(x, 0.1, truncate=(0.0, None))}


def _course(x: float) -> dict[str, Normal]:
    return {
        "course_b": Normal(f"{x} deg", "3 deg"),
        "course_after": Normal(f"{0.4 * x} deg", "1.5 deg"),
    }


SWEEPS = (
    ("truncated", "restitution before truncation at 0 (deviation 0.1)", _restitution, 0.0, 0.45),
    ("stick_slip", "friction (deviation 0.1)", _friction, 0.1, 0.7),
    ("collinear", "angle between the courses, degrees (deviation of each 3)", _course, 10.0, 70.0),
)


def sweeps(effort: Effort) -> list[dict[str, Any]]:
    """The largest error of the local methods, and whether they warned, as one input moves past the
    trouble.
    """
    found = []
    for key, label, inputs, first, last in SWEEPS:
        say(f"local methods: {label}")
        scene, places = BY_KEY[key], np.linspace(first, last, effort.positions).tolist()
        rows: dict[str, Any] = {
            method: {"error": [], "std": [], "interval": [], "warned": []} for method in LOCAL
        }
        for place in places:
            stated = scene.inputs | inputs(place)
            true = figures(
                run(scene, "quasi_random", stated, samples=effort.position_samples, seed=1)[0]
            )
            for method, row in rows.items():
                try:
                    said, codes = run(scene, method, stated)
                except NoSolutionError:
                    # A kink or a jump at the mean: the local method refuses.
                    for part in row.values():
                        part.append(None)
                    continue
                off = [
                    abs(one - other) / true[1]
                    for one, other in zip(figures(said), true, strict=True)
                ]
                row["error"].append(rounded(max(off)))
                row["std"].append(rounded(off[1]))
                row["interval"].append(rounded(max(off[2:])))
                row["warned"].append("not_local" in codes)
        found.append(
            {
                "scene": key,
                "label": label,
                "x": [rounded(place) for place in places],
                "methods": rows,
            }
        )
    return found


# --- All of it ------------------------------------------------------------------------------------

# Scenes with known truth, and how many times as large the errors are as the analyst believes.
SIMULATED = (("near_linear", 1.0), ("truncated", 1.0), ("stick_slip", 1.0), ("near_linear", 2.0))


def measure(effort: Effort = FULL, old: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """All of it."""
    against = references(effort, old)
    local, sampled = trade(effort, against)
    swept = sweeps(effort)
    covered = []
    for key, off in SIMULATED:
        say(f"coverage: {BY_KEY[key].name}")
        covered.append(coverage.counted(key, effort.scenes, off))
    say("coverage: fit to evidence")
    return {
        "machine": machine(),
        "effort": effort._asdict(),
        "unit": WORKS[UNIT].name,
        "noticed": NOTICED,
        "scenes": [
            {"key": scene.key, "name": scene.name, "output": scene.output} for scene in SCENES
        ],
        "references": against,
        "local": local,
        "sampled": sampled,
        "sweeps": swept,
        "coverage": covered,
        "fit": [coverage.fitted(fit, case, effort.fits) for case in coverage.CASES],
    }


def main() -> None:
    """Measure, write, and draw."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--quick", action="store_true", help="measure less, to see that everything runs"
    )
    parser.add_argument(
        "--json", type=Path, help="where to write the numbers; no figures are written then"
    )
    parser.add_argument(
        "--keep-reference", action="store_true", help="take the reference that the file holds"
    )
    options = parser.parse_args()
    data = options.json or DATA
    old = (
        json.loads(data.read_text(encoding="utf-8"))["references"]
        if options.keep_reference and data.exists()
        else None
    )
    found = measure(QUICK if options.quick else FULL, old)
    data.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    import uncertainty_figures
    import uncertainty_tables

    print(uncertainty_tables.summary(found))
    if options.json is None:
        uncertainty_figures.draw_all(found, FOLDER)


if __name__ == "__main__":
    main()
