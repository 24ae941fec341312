"""Posteriors, measured: how often their intervals hold the truth, whether comparisons mean what
they say, error against cost.

``python benchmarks/posterior.py`` runs all of it in ten minutes on two processors and writes
docs/_generated/posterior.json and the figure of the page. ``--quick`` measures less, to see that
everything runs; ``--json PATH`` writes there, without figure.

Simulation-based calibration (S. Talts, M. Betancourt, D. Simpson, A. Vehtari and A. Gelman,
"Validating Bayesian inference algorithms with simulation-based calibration", 2018): the truth is
drawn from the priors, the evidence is simulated from the truth with the stated errors, and the rank
of the truth among the samples of the posterior must be uniform. Priors and errors are drawn by
numpy's own generator.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from itertools import pairwise
from pathlib import Path
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from evenness import uniformity

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT / "src") not in sys.path:
    sys.path.insert(0, str(ROOT / "src"))

import collisions as col
from collisions.estimate import posterior as bayes
from collisions.reconstruct import Posterior, compare, posterior
from collisions.travel import GRAVITY
from collisions.uncertainty import Censored, Interval, LogNormal, Normal, Triangular, Uniform

# All islands in each call of the model, which changes a rounding at most, and saves most of the
# time of so small samples.
bayes._SIDE_BY_SIDE = bayes.ISLANDS

DATA = ROOT / "docs" / "_generated" / "posterior.json"
SEED = 20260301
COVERAGES = (0.5, 0.8, 0.95)
BINS = 20  # of ranks
Numbers = dict[str, Any]


class Effort(NamedTuple):
    """How much is measured."""

    replicates: int
    crashes: int
    samples: int
    compared: int
    sizes: tuple[int, ...]
    runs: int


FULL = Effort(1000, 1000, 2048, 512, (512, 2048, 8192), 10)
QUICK = Effort(2, 2, 512, 512, (512, 1024), 2)


class Scene(NamedTuple):
    """A model, priors of its unknowns with their correlations, and how its outputs are read."""

    key: str
    name: str
    model: Callable[..., Mapping[str, Any]]
    priors: dict[str, Any]
    correlation: dict[tuple[str, str], float]
    readings: dict[str, Callable[[float, np.random.Generator], Any]]
    samples: int


def read(error: float) -> Callable[[float, np.random.Generator], Any]:
    """A reading with a normal error."""
    return lambda true, random: Normal(true + error * random.standard_normal(), error)


def in_steps(step: float) -> Callable[[float, np.random.Generator], Any]:
    """A reading in steps: the truth lies within one."""
    return lambda true, random: Interval(
        step * math.floor(true / step), step * (math.floor(true / step) + 1.0)
    )


def ended_at(most: float, error: float) -> Callable[[float, np.random.Generator], Any]:
    """A reading that ends at a value: of more it says at least that."""

    def reading(true: float, random: np.random.Generator) -> Any:
        value = true + error * random.standard_normal()
        return Censored(low=most, error=error) if value > most else Normal(value, error)

    return reading


def crossing(
    speed_a: Any,
    speed_b: Any,
    restitution: Any,
    friction: Any,
    contact: Any,
    mass_b: Any,
    turned: float = 0.0,
) -> col.Impact:
    """A drives into the side of B; the normal may be turned."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2600.0, vx=speed_a, x=-2.2, y=0.0)
    b = col.Vehicle(mass=mass_b, yaw_inertia=1.6 * mass_b, vy=speed_b, x=0.9, y=-0.5)
    return col.eccentric(
        a, b, restitution, normal=turned, point=(0.0, contact), friction=friction, on_failure="nan"
    )


def marks(**unknowns: Any) -> Numbers:
    """Recorder of A, courses, a yaw rate and a speed after the impact: it may slide or stick."""
    impact = crossing(**unknowns)
    return {
        "delta_v_a": impact.a.delta_v,
        "course_a": impact.a.after.course,
        "course_b": impact.b.after.course,
        "yaw_b": impact.b.after.yaw_rate,
        "speed_b_after": impact.b.after.speed,
    }


def rests(drag: Any, share: Any, **unknowns: Any) -> Numbers:
    """Ways to rest over one drag, a recorder in steps, one that may have ended early, and the
    energy of the damage.
    """
    impact = crossing(**unknowns)
    return {
        "way_a": impact.a.after.speed**2 / (2.0 * GRAVITY * drag),
        "way_b": impact.b.after.speed**2 / (2.0 * GRAVITY * drag * share),
        "course_b": impact.b.after.course,
        "delta_v_a": impact.a.delta_v,
        "delta_v_b": impact.b.delta_v,
        "energy": impact.energy_loss / 1000.0,
    }


POSITIVE = (0.0, None)
SCENES = (
    Scene(
        "marks",
        "courses, yaw rate and recorder; sliding or sticking",
        marks,
        {
            "speed_a": Uniform(6.0, 28.0),
            "speed_b": Uniform(2.0, 20.0),
            "restitution": Normal(0.12, 0.08, truncate=(0.0, 1.0)),
            "friction": Uniform(0.2, 1.0),
            "contact": Normal(0.2, 0.2),
            "mass_b": Normal(1300.0, 60.0),
        },
        {},
        {
            "delta_v_a": read(0.4),
            "course_a": read(0.05),
            "course_b": read(0.05),
            "yaw_b": read(0.25),
            "speed_b_after": read(0.8),
        },
        2048,
    ),
    Scene(
        "rests",
        "rests, recorders in steps and ended early, damage; eight unknowns",
        rests,
        {
            "speed_a": Triangular(5.0, 15.0, 30.0),
            "speed_b": Uniform(2.0, 20.0),
            "restitution": Normal(0.12, 0.08, truncate=(0.0, 1.0)),
            "friction": LogNormal(0.5, 0.15),
            "contact": Normal(0.2, 0.2),
            "mass_b": Normal(1300.0, 60.0),
            "drag": LogNormal(0.7, 0.08),
            "share": Normal(0.8, 0.15, truncate=POSITIVE),
        },
        {("friction", "drag"): 0.5, ("speed_a", "speed_b"): -0.3},
        {
            "way_a": read(0.7),
            "way_b": read(0.7),
            "course_b": read(0.06),
            "delta_v_a": in_steps(0.5),
            "delta_v_b": ended_at(7.0, 0.4),
            "energy": read(12.0),
        },
        1024,
    ),
)
BY_KEY = {scene.key: scene for scene in SCENES}


def simulated(
    scene: Scene, random: np.random.Generator, model: Any = None
) -> tuple[Numbers, Numbers]:
    """The truth, from the priors wherever there is an impact, and the evidence of it."""
    names = list(scene.priors)
    matrix = np.eye(len(names))
    for (one, other), rho in scene.correlation.items():
        i, j = names.index(one), names.index(other)
        matrix[i, j] = matrix[j, i] = rho
    factor = np.linalg.cholesky(matrix)
    while True:
        shares = [NormalDist().cdf(z) for z in factor @ random.standard_normal(len(names))]
        truth = {
            name: float(scene.priors[name].quantile(share))
            for name, share in zip(names, shares, strict=True)
        }
        outputs = {
            name: float(np.asarray(value)[0])
            for name, value in (model or scene.model)(
                **{name: np.array([value]) for name, value in truth.items()}
            ).items()
        }
        if not any(map(math.isnan, outputs.values())):
            return truth, {
                name: reading(outputs[name], random) for name, reading in scene.readings.items()
            }


def sampled(
    scene: Scene, observed: Numbers, samples: int, seed: int, model: Any = None
) -> tuple[Posterior, list[str]]:
    """The posterior, and the codes of what it warned of."""
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        found = posterior(
            model or scene.model,
            scene.priors,
            observed,
            samples=samples,
            seed=seed,
            correlation=scene.correlation,
        )
    return found, [one.message.code for one in given]


def replicate(key: str, turn: int, samples: int) -> Numbers:
    """Of one simulated scene: where each true value lies in its posterior, and what was
    warned of.
    """
    scene = BY_KEY[key]
    truth, observed = simulated(scene, np.random.default_rng([SEED, list(BY_KEY).index(key), turn]))
    found, codes = sampled(scene, observed, samples, turn)
    places = {name: float(np.mean(found[name].values < true)) for name, true in truth.items()}
    inside = {
        name: [
            low <= true <= high
            for low, high in (found[name].interval(share) for share in COVERAGES)
        ]
        for name, true in truth.items()
    }
    return {
        "places": places,
        "inside": inside,
        "codes": codes,
        "p_value": found.p_value,
        "error": found.log_evidence_error,
        "shrinkage": found.shrinkage,
    }


def calibration(scene: Scene, effort: Effort, pool: Any) -> Numbers:
    """Coverage of intervals and histograms of ranks, by unknown."""
    turns, samples = range(effort.replicates), min(scene.samples, effort.samples)
    rows = list(
        pool.map(replicate, [scene.key] * len(turns), turns, [samples] * len(turns), chunksize=4)
    )
    unknowns = {}
    for name in scene.priors:
        counts, _ = np.histogram([row["places"][name] for row in rows], BINS, (0.0, 1.0))
        unknowns[name] = {
            "held": np.sum([row["inside"][name] for row in rows], axis=0).tolist(),
            "ranks": counts.tolist(),
            "shrinkage": round(float(np.median([row["shrinkage"][name] for row in rows])), 3),
        }
    codes = [code for row in rows for code in set(row["codes"])]
    return {
        "key": scene.key,
        "name": scene.name,
        "replicates": len(rows),
        "samples": samples,
        "coverages": COVERAGES,
        "unknowns": unknowns,
        "warned": {code: codes.count(code) for code in sorted(set(codes))},
        "contradictory": sum(row["p_value"] < 0.01 for row in rows),
        "log_evidence_error": round(float(np.median([row["error"] for row in rows])), 4),
    }


TURNED = math.radians(15.0)
ACCOUNTS = {"square": 0.0, "turned": TURNED}


def account(turned: float) -> Callable[..., Numbers]:
    """What the marks would be if the line of impact were turned by this."""
    return lambda **unknowns: marks(**unknowns, turned=turned)


def crash(turn: int, samples: int) -> tuple[float, bool]:
    """Of one simulated crash: the stated probability that the contact was turned, and whether it
    was.
    """
    random = np.random.default_rng([SEED, 99, turn])
    scene, turned = BY_KEY["marks"], bool(random.random() < 0.5)
    _, observed = simulated(scene, random, account(TURNED if turned else 0.0))
    found = {
        name: sampled(scene, observed, samples, 2 * turn + k, account(angle))[0]
        for k, (name, angle) in enumerate(ACCOUNTS.items())
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        return compare(found).probability["turned"], turned


def comparisons(effort: Effort, pool: Any) -> Numbers:
    """Stated probabilities against how often they were right, in five ranges."""
    turns = range(effort.crashes)
    rows = list(pool.map(crash, turns, [effort.compared] * len(turns), chunksize=4))
    stated, true = (np.array(part, dtype=np.float64) for part in zip(*rows, strict=True))
    edges = (0.0, 0.1, 0.3, 0.7, 0.9, 1.0)
    which = np.clip(np.searchsorted(edges, stated, side="right") - 1, 0, len(edges) - 2)
    return {
        "crashes": len(rows),
        "samples": effort.compared,
        "turned_deg": round(math.degrees(TURNED)),
        "bins": [
            {
                "from": low,
                "to": high,
                "crashes": int(np.sum(which == k)),
                "stated": round(float(np.mean(stated[which == k])), 3)
                if np.any(which == k)
                else None,
                "true": int(np.sum(true[which == k])),
            }
            for k, (low, high) in enumerate(pairwise(edges))
        ],
    }


def one_run(key: str, samples: int, seed: int) -> Numbers:
    """One evidence again with another seed: its figures, their stated errors, and what
    they cost.
    """
    scene = BY_KEY[key]
    _, observed = simulated(scene, np.random.default_rng([SEED, 7]))
    cases = 0

    def counting(**unknowns: Any) -> Mapping[str, Any]:
        nonlocal cases
        cases += len(next(iter(unknowns.values())))
        return scene.model(**unknowns)

    start = time.process_time()
    found, _ = sampled(scene, observed, samples, 1000 + seed, counting)
    output = found["speed_a"]
    low, high = output.interval(0.95)
    return {
        "seconds": time.process_time() - start,
        "cases": cases,
        "mean": output.mean,
        "std": output.std,
        "low": low,
        "high": high,
        "mean_error": output.mean_standard_error,
        "evidence": found.log_evidence,
        "evidence_error": found.log_evidence_error,
    }


def cost(effort: Effort, pool: Any) -> list[Numbers]:
    """Error of sampling against the number of samples: as stated, and as the scatter over seeds
    shows.
    """
    found = []
    for key in BY_KEY:
        for samples in effort.sizes:
            rows = list(
                pool.map(one_run, [key] * effort.runs, [samples] * effort.runs, range(effort.runs))
            )
            columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
            std = float(np.mean(columns["std"]))

            def scatter(name: str, columns: Mapping[str, Any] = columns) -> float:
                return float(np.std(columns[name], ddof=1))

            def stated(name: str, columns: Mapping[str, Any] = columns) -> float:
                return float(np.sqrt(np.mean(columns[name] ** 2)))

            figures = {
                "mean": scatter("mean") / std,
                "mean_stated": stated("mean_error") / std,
                "ends": math.sqrt(0.5 * (scatter("low") ** 2 + scatter("high") ** 2)) / std,
                "evidence": scatter("evidence"),
                "evidence_stated": stated("evidence_error"),
                "cases_per_sample": float(np.mean(columns["cases"])) / samples,
                "seconds": float(np.median(columns["seconds"])),
            }
            found.append(
                {"key": key, "samples": samples, "runs": len(rows)}
                | {k: float(f"{v:.3g}") for k, v in figures.items()}
            )
    return found


def measure(effort: Effort, processes: int) -> Numbers:
    """All of it."""
    with ProcessPoolExecutor(processes) as pool:
        found: Numbers = {"effort": effort._asdict(), "scenes": []}
        for scene in SCENES:
            print(f"calibration: {scene.name}", file=sys.stderr)
            found["scenes"].append(calibration(scene, effort, pool))
        print("comparisons", file=sys.stderr)
        found["compare"] = comparisons(effort, pool)
        print("cost", file=sys.stderr)
        found["cost"] = cost(effort, pool)
    return found


# --- What the page shows --------------------------------------------------------------------------


def _share(held: int, tried: int) -> str:
    """A share that was counted, with its 95 percent range by Wilson's score."""
    z = 1.959964
    share, square = held / tried, z * z / tried
    middle, half = (
        share + 0.5 * square,
        z * math.sqrt(share * (1.0 - share) / tried + 0.25 * square / tried),
    )
    low, high = (
        max(0.0, (middle - half) / (1.0 + square)),
        min(1.0, (middle + half) / (1.0 + square)),
    )
    return f"{100.0 * share:.1f} % ({100.0 * low:.0f} to {100.0 * high:.0f})"


def _table(head: list[str], rows: list[list[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def coverage_table(found: Numbers) -> str:
    """How often the intervals held the truth, by unknown."""
    rows = []
    for scene in found["scenes"]:
        for name, row in scene["unknowns"].items():
            held = [_share(count, scene["replicates"]) for count in row["held"]]
            rows.append(
                [
                    scene["key"],
                    f"`{name}`",
                    *held,
                    f"{uniformity(row['ranks']):.2f}",
                    f"{row['shrinkage']:.2f}",
                ]
            )
    head = [
        "scene",
        "unknown",
        *(f"{100 * share:.0f} %" for share in COVERAGES),
        "chance of such ranks",
        "median shrinkage",
    ]
    return _table(head, rows)


def overall(found: Numbers) -> str:
    """The same over all unknowns, and what was warned of, as a sentence."""
    parts = []
    for scene in found["scenes"]:
        tried = scene["replicates"] * len(scene["unknowns"])
        held = [
            sum(row["held"][k] for row in scene["unknowns"].values()) for k in range(len(COVERAGES))
        ]
        shares = ", ".join(f"{100 * count / tried:.1f}" for count in held)
        warned = (
            ", ".join(f"`{code}` in {count}" for code, count in scene["warned"].items())
            or "nothing"
        )
        parts.append(
            f"Scene {scene['key']} ({scene['name']}; {scene['replicates']} crashes, "
            f"{scene['samples']} samples): the 50, 80 and 95 percent intervals of all unknowns "
            f"held {shares} percent of the truths; warned of: {warned}."
        )
    return "\n\n".join(parts)


def compare_table(found: Numbers) -> str:
    """Stated probabilities of an account and how often it was true."""
    rows = [
        [
            f"{row['from']:g} to {row['to']:g}",
            str(row["crashes"]),
            f"{row['stated']:.2f}",
            _share(row["true"], row["crashes"]),
        ]
        for row in found["compare"]["bins"]
        if row["crashes"]
    ]
    return _table(["stated probability", "crashes", "mean of these", "true in"], rows)


def cost_table(found: Numbers) -> str:
    """Error of sampling and cost against the number of samples."""
    rows = [
        [
            row["key"],
            str(row["samples"]),
            f"{row['mean']:.3f} ({row['mean_stated']:.3f})",
            f"{row['ends']:.3f}",
            f"{row['evidence']:.3f} ({row['evidence_stated']:.3f})",
            f"{row['cases_per_sample']:.0f}",
            f"{row['seconds']:.2g} s",
        ]
        for row in found["cost"]
    ]
    head = [
        "scene",
        "samples",
        "mean of `speed_a`",
        "ends of its 95 % interval",
        "log evidence",
        "cases a sample",
        "processor time",
    ]
    return _table(head, rows)


def draw(plt: Any, found: Numbers) -> Any:
    """Histograms of ranks, by unknown, with the range that 19 of 20 bins of even ranks lie in."""
    cells = [
        (scene, name, row) for scene in found["scenes"] for name, row in scene["unknowns"].items()
    ]
    figure, grid = plt.subplots(
        -(-len(cells) // 5),
        5,
        figsize=(11.5, 1.75 * -(-len(cells) // 5)),
        sharex=True,
        layout="constrained",
    )
    for axes, (scene, name, row) in zip(grid.flat, cells, strict=False):
        each = scene["replicates"] / BINS
        off = 1.96 * math.sqrt(each * (1.0 - 1.0 / BINS))
        axes.axhspan(each - off, each + off, color="#d8d8d8", lw=0, zorder=0)
        axes.axhline(each, color="#6a6a6a", lw=0.9, zorder=1)
        axes.stairs(
            row["ranks"],
            np.linspace(0.0, 1.0, BINS + 1),
            fill=True,
            fc="#9db8d6",
            ec="#1f5fa8",
            lw=0.9,
            zorder=2,
            alpha=0.8,
        )
        axes.set_title(f"{scene['key']}: {name}", fontsize=9)
        axes.set_ylim(0.0, 2.0 * each)
        axes.tick_params(labelsize=8)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in grid.flat[len(cells) :]:
        axes.set_visible(False)
    figure.supxlabel("rank of the truth among the samples, as a share", fontsize=9)
    return figure


def main() -> None:
    """Measure, write and draw."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--quick", action="store_true", help="measure less, to see that everything runs"
    )
    parser.add_argument("--json", type=Path, help="where to write the numbers")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    found = measure(QUICK if options.quick else FULL, options.processes)
    (options.json or DATA).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    if options.json is None:
        from speed import FIGURES
        from speed_tables import drawing

        blank = {"Date": None, "Creator": None, "Format": None, "Type": None}
        with drawing() as plt:
            draw(plt, found).savefig(FIGURES / "posterior_ranks.svg", metadata=blank)
    print(
        "\n\n".join(
            (overall(found), coverage_table(found), compare_table(found), cost_table(found))
        )
    )


if __name__ == "__main__":
    main()
