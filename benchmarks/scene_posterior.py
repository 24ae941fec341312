"""What a posterior of a whole scene costs: two cars on wheels, both places of rest and one
recorder, 4,096 samples, by itself and as ``finer=`` of the same scene followed coarsely.

    python benchmarks/scene_posterior.py RESULT.json [--samples 4096]

It takes some minutes. Costs are in millions of bare formulas of an impact, of processor time.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src"))

from scene_ranks import PRIORS, RECORDED, RESTS, SEED, crash, drawn, formula_seconds

from collisions import reconstruct
from collisions.uncertainty import Normal

# How finely the cheaper model follows the motion: places of rest are off by 1 cm in the median.
COARSE = 1e-3
BUDGETS = {"plain": 200.0, "finer": 60.0}


def observed() -> dict[str, Normal]:
    """What was read of the first scene of ``scene_ranks.py``."""
    errors = RESTS | RECORDED
    rng = np.random.default_rng([SEED, 0])
    _, read = drawn(rng, crash().as_model(list(PRIORS), list(errors)))
    return {
        name: Normal(float(read[name].magnitude) + error * rng.normal(), error)
        for name, error in errors.items()
    }


def sampled(model: Any, samples: int, **options: Any) -> tuple[Any, float]:
    """A posterior and its processor time in millions of formulas."""
    start = time.process_time()
    found = reconstruct.posterior(model, PRIORS, observed(), samples=samples, seed=1, **options)
    return found, (time.process_time() - start) / formula_seconds() / 1e6


def measured(samples: int) -> dict[str, Any]:
    """Both ways: cost, calls a sample, and how far their means lie apart."""
    found, rows = {}, {}
    coarse = crash().as_model(list(PRIORS), list(RESTS | RECORDED), tolerance=COARSE)
    for name, model, options in (
        ("plain", crash(), {}),
        ("finer", coarse, {"finer": crash()}),
    ):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found[name], cost = sampled(model, samples, **options)
        rows[name] = {
            "million_formulas": round(cost, 1),
            "calls_a_sample": {
                which: round(count / samples, 1) for which, count in found[name].calls.items()
            },
            "warned": sorted({getattr(one.message, "code", "") for one in caught}),
        }
    plain, finer = (found[name] for name in rows)
    apart = [abs(plain[name].mean - finer[name].mean) / plain[name].std for name in PRIORS]
    return {"samples": samples, "budgets": BUDGETS, "apart": round(max(apart), 3), "rows": rows}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path)
    parser.add_argument("--samples", type=int, default=4096)
    given = parser.parse_args()
    found = measured(given.samples)
    given.result.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
