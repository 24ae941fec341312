"""No warning of a model is lost in a study: each is counted, stated with the result, and raised
once where it matters.
"""

import json
import warnings

import numpy as np
import pytest

import collisions as col
from collisions import reconstruct, reference
from collisions.messages.warning import warn, warn_of_cases
from collisions.uncertainty import Interval, Normal, Uniform, propagate

A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=12.0, x=-2.0, y=0.6, heading=0.0)
B = col.Vehicle(mass=1200.0, yaw_inertia=1800.0, vy=9.0, x=0.9, y=-1.0, heading=np.pi / 2)


def gaining(ratio):
    """The ratio of 0.9 against a coupling contact at e = 1 gains energy in some cases."""
    impact = col.eccentric(A, B, 1.0, normal=0.0, point=(0.0, 0.0), impulse_ratio=ratio)
    return {"loss": impact.energy_loss}


def quiet(study):
    """A result with all warnings recorded, not raised as errors."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = study()
    return found, caught


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("method", ["quasi_random", "monte_carlo", "first_order"])
def test_an_energy_gain_of_some_samples_is_counted_stated_and_raised_once(method, threads):
    options = {} if method == "first_order" else {"samples": 4096, "seed": 1}
    found, caught = quiet(
        lambda: propagate(
            gaining, {"ratio": Uniform(-0.6, 0.6)}, method=method, threads=threads, **options
        )
    )
    raised = [one.message for one in caught if getattr(one.message, "code", "") == "energy_gain"]
    assert len(raised) == 1
    assert isinstance(raised[0], col.EnergyGainWarning)
    (note,) = [one for one in found.notes if one.code == "energy_gain"]
    if method != "first_order":
        # Counted on the samples themselves: those that end with more energy than they began with.
        below = int(np.count_nonzero(found["loss"].values < 0.0))
        assert note.fields["cases"] == below > 0
        assert note.statement.startswith(f"{below} of 4096 cases")
    for place in (found.statements, found.to_dict()["statements"]):
        assert note.statement in place
    assert note.statement[1:] in " ".join(str(found.summary()).split())
    json.dumps(found.to_dict(), allow_nan=False)


def test_a_warning_of_few_samples_is_stated_and_not_raised():
    def model(x):
        seldom = x > 3.2905  # one in two thousand
        if np.any(seldom):
            text = "a warning of the model"
            warn_of_cases(
                col.CollisionsWarning(text, code="seldom"), {text: int(np.count_nonzero(seldom))}
            )
        return {"x": x}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=8192, seed=2))
    assert not caught
    count = int(np.count_nonzero(found["x"].values > 3.2905))
    assert 0 < count < 0.005 * 8192
    assert found.statements == (
        f"{count} of 8192 cases ({100 * count / 8192:.3g} %): a warning of the model",
    )


def test_a_warning_that_is_not_of_cases_counts_for_all_and_is_raised_once():
    def model(x):
        warn(col.SuspectUnitsWarning("this is in degrees", code="bare_angle"))
        return {"x": x}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=32768, seed=2))
    assert [str(one.message) for one in caught] == [
        "32768 of 32768 cases (100 %): this is in degrees"
    ]
    assert found.notes[0].fields == {"cases": 32768, "share": 1.0}


def test_what_a_reference_value_warns_of_reaches_the_study():
    def model(speed):
        return {"e": reference.restitution(speed, outside="warn")}

    found, caught = quiet(
        lambda: propagate(model, {"speed": Uniform(0.05, 20.0)}, samples=1024, seed=1)
    )
    codes = [one.code for one in found.notes]
    assert "outside_reference" in codes
    assert [one.message.code for one in caught].count("outside_reference") == 1


def test_bounds_alone_state_the_warnings_too():
    found, caught = quiet(lambda: propagate(gaining, {"ratio": Interval(-0.6, 0.6)}))
    assert any("gains energy" in one for one in found.statements)
    assert len([one for one in caught if one.message.code == "energy_gain"]) == 1


def test_a_fit_states_what_the_model_warns_of_at_the_answer():
    def model(speed):
        impact = col.linear_central(
            col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0), 0.2
        )
        e = reference.restitution(impact.closing_speed, outside="warn")
        return {"delta_v": impact.b.delta_v, "e": e}

    seen = {"delta_v": (20.0, 0.5)}
    found, caught = quiet(lambda: reconstruct.fit(model, {"speed": Interval(5.0, 60.0)}, seen))
    assert any("outside" in one for one in found.statements)
    assert any(one.message.code == "outside_reference" for one in caught)
    assert any("outside" in one for one in found.to_dict()["statements"])


def test_a_comparison_states_the_warnings_of_its_posteriors():
    def account(low):
        def model(speed):
            return {"marks": speed}

        return reconstruct.posterior(
            model, {"speed": Normal(low, 0.5)}, {"marks": (20.0, 0.5)}, samples=512, seed=1
        )

    (one, other), _ = quiet(lambda: (account(10.0), account(12.0)))
    found, caught = quiet(lambda: reconstruct.compare({"one": one, "other": other}))
    assert [warning.message.code for warning in caught] == ["contradictory"]
    assert any(text.startswith("one: the evidence contradicts") for text in found.statements)
    assert list(found.statements) == found.to_dict()["statements"]


def test_a_report_prints_what_the_study_was_warned_of():
    impact = col.eccentric(A, B, 0.2, normal=0.0, point=(0.0, 0.0), impulse_ratio=0.1)
    found, _ = quiet(
        lambda: propagate(gaining, {"ratio": Uniform(-0.6, 0.6)}, samples=1024, seed=1)
    )
    page = col.report(impact, uncertainty=found, form="markdown", figures=False)
    (note,) = [one for one in found.notes if one.code == "energy_gain"]
    assert note.statement[:20] in page
    assert "gains energy" in page


def test_a_censored_reading_is_no_input_and_is_not_called_an_interval():
    from collisions.uncertainty import Censored

    with pytest.raises(col.InputError, match=r"evidence for reconstruct\.posterior"):
        propagate(lambda x: {"y": x}, {"x": Censored(low=1.0)})
