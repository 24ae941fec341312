"""The page of posteriors: its figures are of a run of the script, and the intervals hold within
what the page promises.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from collisions.estimate import posterior
from scripts import benchmarks

ROOT = Path(__file__).resolve().parent.parent.parent
WRONG = (92, 104, 161, 172)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (ROOT / "benchmarks").is_dir(), reason="the sdist has no benchmarks"),
]


@pytest.fixture(scope="module")
def committed():
    return json.loads((ROOT / "docs" / "_generated" / "posterior.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def script():
    """The script, which samples all islands in each call: other tests have others."""
    before = posterior._SIDE_BY_SIDE
    yield benchmarks("posterior")
    posterior._SIDE_BY_SIDE = before


def test_a_quick_run_has_the_rows_of_the_committed_file(committed, script, tmp_path):
    path = tmp_path / "posterior.json"
    command = [
        sys.executable,
        str(ROOT / "benchmarks" / "posterior.py"),
        "--quick",
        "--json",
        str(path),
        "--processes",
        "1",
    ]
    subprocess.run(command, check=True, capture_output=True, timeout=1200)
    quick = json.loads(path.read_text(encoding="utf-8"))
    for found in (quick, committed):
        assert [(scene["key"], list(scene["unknowns"])) for scene in found["scenes"]] == [
            (scene.key, list(scene.priors)) for scene in script.SCENES
        ]
        for text in (
            script.overall(found),
            script.coverage_table(found),
            script.compare_table(found),
            script.cost_table(found),
        ):
            assert "nan" not in text
    assert all(
        scene["replicates"] >= 1000 and len(scene["unknowns"]) >= 6 for scene in committed["scenes"]
    )
    assert committed["compare"]["crashes"] >= 400


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("turn", WRONG)
def test_evidence_of_crashes_that_went_wrong_against_quadrature(script, turn):
    """Of 200 simulated crashes those in which the wrong account was stated the more probable, at
    0.7 or more.

    Both speeds unknown, the rest as it was: by the midpoint rule on 700 x 700 cells of 0.03 m/s, a
    tenth of what the readings leave. Within five stated errors, and both accounts so.
    """
    scene, random = script.BY_KEY["marks"], script.np.random.default_rng([script.SEED, 99, turn])
    assert not random.random() < 0.5
    truth, observed = script.simulated(scene, random, script.account(0.0))
    speeds = {name: scene.priors[name] for name in ("speed_a", "speed_b")}
    rest = {name: value for name, value in truth.items() if name not in speeds}
    share = (script.np.arange(700) + 0.5) / 700
    grid = dict(
        zip(
            speeds,
            (
                part.ravel()
                for part in script.np.meshgrid(*(one.quantile(share) for one in speeds.values()))
            ),
            strict=True,
        )
    )
    for angle in script.ACCOUNTS.values():

        def model(speed_a, speed_b, angle=angle):
            return script.account(angle)(speed_a=speed_a, speed_b=speed_b, **rest)

        found = script.posterior(model, speeds, observed, samples=4096, seed=1)
        log = 0.0
        for name, computed in model(**grid).items():
            mean, error = observed[name].given_mean, observed[name].given_sd
            log = (
                log
                - 0.5 * ((mean - computed) / error) ** 2
                - math.log(error * math.sqrt(2.0 * math.pi))
            )
        exact = math.log(script.np.mean(script.np.exp(log - script.np.max(log)))) + script.np.max(
            log
        )
        assert abs(found.log_evidence - exact) <= 5.0 * found.log_evidence_error


def test_intervals_hold_at_their_rate(committed, script):
    """Counts of each unknown within 3.5 binomial errors, of all unknowns of a scene within what
    half as many would leave open.
    """
    for scene in committed["scenes"]:
        tried = scene["replicates"]
        for k, share in enumerate(script.COVERAGES):
            error = (share * (1.0 - share) / tried) ** 0.5
            held = [row["held"][k] / tried for row in scene["unknowns"].values()]
            assert all(abs(one - share) < 3.5 * error for one in held), (scene["key"], share, held)
            # Unknowns of one crash are not independent.
            assert abs(sum(held) / len(held) - share) < 3.5 * error / 2.0**0.5
        for name, row in scene["unknowns"].items():
            assert script.uniformity(row["ranks"]) > 1e-4, (scene["key"], name)


def test_ninety_five_percent_intervals_hold_93_to_97(committed):
    assert all(
        0.93 <= row["held"][2] / scene["replicates"] <= 0.97
        for scene in committed["scenes"]
        for row in scene["unknowns"].values()
    )


def test_stated_probabilities_of_accounts_come_true(committed):
    """In each range as often as was stated, within three binomial errors."""
    rows = committed["compare"]["bins"]
    assert sum(row["crashes"] for row in rows) == committed["compare"]["crashes"]
    for row in rows:
        stated, crashes = row["stated"], row["crashes"]
        assert (
            abs(row["true"] - stated * crashes) <= 3.0 * (stated * (1.0 - stated) * crashes) ** 0.5
        ), row


def test_errors_of_sampling_are_as_stated(committed):
    """Scatter over ten seeds against the stated error, which is of seven degrees of freedom: within
    a factor of two and a half.
    """
    for row in committed["cost"]:
        for name in ("mean", "evidence"):
            assert 0.2 < row[name] / row[f"{name}_stated"] < 2.5, row
    for key in {row["key"] for row in committed["cost"]}:
        stated = [row["mean_stated"] for row in committed["cost"] if row["key"] == key]
        assert stated == sorted(stated, reverse=True)
