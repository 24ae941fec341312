"""Mean, deviation and quantiles of the uncertain scenes from 10^7 cases each, drawn by numpy alone.

    PYTHONPATH=src:tests python tests/data/uncertainty_reference.py

writes ``uncertainty_reference.json`` beside it, in under a minute. The standard errors come from a
hundred independent parts.
"""

import json
import math
from pathlib import Path

import numpy as np

from uncertain_scenes import SCENES

CASES = 10**7
PARTS = 100
QUANTILES = (0.025, 0.5, 0.975)


def figures(values: np.ndarray) -> np.ndarray:
    return np.array([np.mean(values), np.std(values, ddof=1), *np.quantile(values, QUANTILES)])


if __name__ == "__main__":
    found: dict[str, dict[str, dict[str, list[float]]]] = {}
    for number, (name, (model, _, draws)) in enumerate(SCENES.items()):
        generator = np.random.default_rng([2024, number])
        parts: dict[str, list[np.ndarray]] = {}
        for _ in range(PARTS):
            inputs = {key: draw(generator, CASES // PARTS) for key, draw in draws.items()}
            for output, values in model(**inputs).items():
                parts.setdefault(output, []).append(values)
        found[name] = {
            output: {
                "figures": figures(np.concatenate(arrays)).tolist(),
                "standard_errors": (
                    np.std([figures(part) for part in arrays], axis=0, ddof=1) / math.sqrt(PARTS)
                ).tolist(),
            }
            for output, arrays in parts.items()
        }
    Path(__file__).with_suffix(".json").write_text(json.dumps(found, indent=1) + "\n")
