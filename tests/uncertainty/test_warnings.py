"""No warning of a model is lost in a study: each is counted, stated with the result, and raised
once where it matters.
"""

import json
import math
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from functools import partial
from threading import Event, Thread

import matplotlib.pyplot as plt
import numpy as np
import pytest

import collisions as col
from collisions import plot, reconstruct, reference
from collisions.messages.warning import warn, warn_of_cases
from collisions.travel import Tyres
from collisions.uncertainty import Interval, Normal, Uniform, propagate

A = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=12.0, x=-2.0, y=0.6, heading=0.0)
MPH = 0.44704
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
            warn_of_cases(col.CollisionsWarning(text, code="seldom"), {text: seldom})
        return {"x": x}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=8192, seed=2))
    assert not caught
    count = int(np.count_nonzero(found["x"].values > 3.2905))
    assert 0 < count < 0.005 * 8192
    assert found.statements == (
        f"{count} of 8192 cases ({100 * count / 8192:.3g} %): a warning of the model",
    )


def test_few_cases_without_an_answer_are_raised_all_the_same():
    def model(x):
        return {"x": np.where(x > 3.2905, np.nan, x)}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=8192, seed=2))
    assert 0 < found.failed < 0.005 * 8192
    assert [str(one.message).startswith(f"{found.failed} of 8192 cases") for one in caught] == [
        True
    ]


def pushed_by(va, solver, **options):
    """A goes at va into B, which goes at 8 m/s ahead of it."""
    a, b = (one.replace(vx=speed, vy=0.0) for one, speed in ((A, va), (B, 8.0)))
    return solver(a, b, 0.1, **options, on_failure="nan").b.delta_v


PLACE = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.4}
PARTING = {"separating": lambda va: va < 8.0}


@pytest.mark.parametrize(
    ("model", "causes"),
    [
        (lambda va: pushed_by(va, col.linear_central), PARTING),
        (lambda va: pushed_by(va, col.oblique_central, normal=0.0, friction=0.4), PARTING),
        (lambda va: pushed_by(va, col.eccentric, **PLACE), PARTING),
        (lambda va: pushed_by(va, col.solve, **PLACE, tolerance=0.5), PARTING),
        (lambda va: pushed_by(va, col.time_resolved, **PLACE, duration=0.1), PARTING),
        # B leaves at 8 m/s, so A at va - 6.4 m/s, and e is (14.4 - va) / va.
        (
            lambda va: (
                reconstruct.central(
                    1500.0, 1200.0, va=va, vb=0.0, vb_after=8.0, on_failure="nan"
                ).restitution
            ),
            {"not_separating": lambda va: va > 14.4, "contradictory": lambda va: va < 7.2},
        ),
        (
            lambda va: (
                reconstruct.planar(
                    A.replace(vx=8.0),
                    B.replace(vx=va, vy=0.0),
                    normal=0.0,
                    point=(0.0, 0.6),
                    friction=0.0,
                    restitution=0.5,
                    on_failure="nan",
                ).a.before.vx
            ),
            {"not_separating": lambda va: va < 8.0},
        ),
        (
            lambda va: (
                reconstruct.momentum(
                    va - 8.0,
                    1200.0,
                    course_a=0.0,
                    course_b=1.5,
                    course_a_after=0.5,
                    course_b_after=0.4,
                    speed_a_after=5.0,
                    speed_b_after=6.0,
                    on_failure="nan",
                ).speed_b
            ),
            {"not_positive": lambda va: va < 8.0},
        ),
    ],
)
def test_why_cases_have_no_answer_is_stated_with_on_failure_nan_too(model, causes):
    """Each cause is of as many cases as it follows for by hand; a single call does not warn."""
    found, caught = quiet(
        lambda: propagate(
            lambda va: {"answer": model(va), "va": va + 0.0},
            {"va": Uniform(4.0, 20.0)},
            samples=256,
            seed=1,
        )
    )
    va = found["va"].values
    refused = {code: int(np.count_nonzero(where(va))) for code, where in causes.items()}
    assert found.failed == sum(refused.values())
    for code, count in refused.items():
        said = f"{count} of 256 cases ({100 * count / 256:.3g} %): refused by a solver, as {code}"
        assert said in found.statements
    assert sum("refused by a solver" in one for one in found.statements) == len(causes)
    assert [one.message.code for one in caught].count("failed_cases") == 1
    assert "refused_cases" not in [one.message.code for one in caught]
    _, caught = quiet(lambda: model(np.array([5.0, 10.0, 15.0])))
    assert "refused_cases" not in [one.message.code for one in caught]


def test_refused_cases_that_a_model_answers_itself_are_stated_and_not_raised():
    """Cars that part have no delta-V, as the model says; and one that is called case by case."""

    def model(va):
        found = pushed_by(va, col.linear_central)
        return {"delta_v": np.where(va < 8.0, 0.0, found)}

    def looped(va):
        return {"delta_v": np.array([pushed_by(float(one), col.linear_central) for one in va])}

    inputs = {"va": Uniform(4.0, 20.0)}
    found, caught = quiet(lambda: propagate(model, inputs, samples=256, seed=1))
    assert not caught
    count = int(np.count_nonzero(found["delta_v"].values == 0.0))
    said = f"{count} of 256 cases ({100 * count / 256:.3g} %): refused by a solver, as separating"
    assert said in found.statements
    found, _ = quiet(lambda: propagate(looped, inputs, samples=256, seed=1))
    assert found.failed == count
    (said,) = (one for one in found.statements if "refused by a solver, as separating" in one)
    assert said.startswith(f"{count} warnings that do not say of which of 256 cases")


def test_one_output_by_itself_says_how_many_cases_it_leaves_out():
    """Half of a normal distribution has a mean of its own, sqrt(2 / pi), and no word said why."""

    def model(x):
        return {"x": np.where(x < 0.0, np.nan, x), "whole": x}

    found, _ = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=1024, seed=2))
    half = found["x"]
    assert half.mean == pytest.approx(np.sqrt(2.0 / np.pi), abs=0.01)
    given = "the stated inputs, and an answer: 50 % have none"
    assert str(half).startswith(f"Given {given}\n")
    assert repr(half).endswith(f"given {given}>")
    axes = plot.distribution(half)
    assert axes.get_title() == f"given {given}"
    assert axes.get_ylabel() == "share of the cases with an answer [%]"
    assert str(found["whole"]).startswith("Given the stated inputs\n")
    assert plot.distribution(found["whole"]).get_ylabel() == "share of the cases [%]"
    plt.close("all")


@pytest.mark.slow
def test_the_caption_of_its_figure_in_a_report_says_so_too():
    def model(v):
        a, b = col.Vehicle(mass=1500.0, vx=v), col.Vehicle(mass=1200.0, vx=5.0)
        return {"b.delta_v": col.linear_central(a, b, 0.2, on_failure="nan").b.delta_v}

    found, _ = quiet(lambda: propagate(model, {"v": Normal(5.0, 1.0)}, samples=1024, seed=2))
    a, b = col.Vehicle(mass=1500.0, vx=6.0), col.Vehicle(mass=1200.0, vx=5.0)
    page = col.report(col.linear_central(a, b, 0.2), uncertainty=found, derivation=False)
    assert "in the cases drawn, given the stated inputs, and an answer: 50 % have none." in page


def test_a_warning_of_the_model_itself_passes_and_is_in_no_statement():
    def model(x):
        warnings.warn("the marks were measured in the rain", UserWarning, stacklevel=2)
        return {"x": x}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=1024, seed=2))
    assert {one.category for one in caught} == {UserWarning}
    assert found.statements == ()


def test_a_warning_that_is_not_of_cases_is_raised_once_and_gets_no_share():
    """A call of plain numbers may stand for all cases or for one."""

    def model(x):
        warn(col.SuspectUnitsWarning("this is in degrees", code="bare_angle"))
        return {"x": x}

    found, caught = quiet(lambda: propagate(model, {"x": Normal(0.0, 1.0)}, samples=1024, seed=2))
    (note,) = found.notes
    assert note.fields == {"cases": None, "share": None, "times": 1}
    assert [str(one.message) for one in caught] == [
        "1 warning that does not say of which of 1024 cases, which may be all: this is in degrees"
    ]


def left_at(course, speed):
    """Speeds before from those after, SI; below 0 in many cases."""
    return reconstruct.momentum(
        1200.0,
        1800.0,
        course_a=course,
        course_b=0.0,
        course_a_after=-0.5,
        course_b_after=-0.7,
        speed_a_after=speed,
        speed_b_after=14.0,
    ).speed_a


LEFT = {"course": Normal("176 deg", "10 deg"), "speed": Normal("30 km/h", "2 km/h")}


def one_by_one(course, speed):
    pairs = np.stack(np.broadcast_arrays(course, speed), axis=-1)
    return np.array([left_at(*pair) for pair in pairs.tolist()])


def of_code(found, code):
    """The only note of a code about A."""
    (note,) = [one for one in found.notes if one.code == code and "speed_b" not in one.sentence]
    return note


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 3])
def test_a_loop_over_single_cases_is_given_no_share(threads):
    """How many calls warned is counted; of how many cases, nobody knows."""
    below = []

    def model(course, speed):
        values = one_by_one(course, speed)
        if values.size > 4:  # not those that are asked again as a check
            below.append(int(np.count_nonzero(values < 0.0)))
        return {"speed_a": values}

    found, caught = quiet(lambda: propagate(model, LEFT, samples=256, seed=1, threads=threads))
    assert 0 < sum(below) < 256
    note = of_code(found, "negative_speed")
    assert note.fields == {"cases": None, "share": None, "times": sum(below)}
    assert note.statement.startswith(f"{sum(below)} warnings that do not say of which")
    assert not any("256 of 256" in text for text in found.statements)
    assert "negative_speed" in {one.message.code for one in caught}


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 3])
def test_the_same_cases_as_arrays_are_counted_once_however_often_they_are_asked(threads):
    """Two calls for the same cases: those where either warns, not the sum of both."""
    below = []

    def model(course, speed):
        one, other = left_at(course, speed), left_at(course, speed + 3.0)
        pair = left_at(course[:, np.newaxis], speed[:, np.newaxis] + [0.0, 3.0])
        np.testing.assert_allclose(pair, np.stack([one, other], axis=-1), rtol=1e-12)
        if one.size > 4:
            below.append(int(np.count_nonzero((one < 0.0) | (other < 0.0))))
        return {"one": one, "other": other}

    found, _ = quiet(lambda: propagate(model, LEFT, samples=40000, seed=1, threads=threads))
    note = of_code(found, "negative_speed")
    share = sum(below) / 40000
    assert note.fields == {"cases": sum(below), "share": share}
    assert note.statement.startswith(f"{sum(below)} of 40000 cases ({100.0 * share:.3g} %): ")


@pytest.mark.slow
def test_a_model_of_both_kinds_says_what_is_sure():
    """Arrays for all cases, and single calls for some: at least those, and the calls."""
    below, alone = [], []

    def model(course, speed):
        values = left_at(course, speed)
        again = np.flatnonzero(speed > 8.5)
        single = one_by_one(course[again], speed[again] + 3.0)
        if values.size > 4:
            below.append(int(np.count_nonzero(values < 0.0)))
            alone.append(int(np.count_nonzero(single < 0.0)))
        return {"speed_a": values}

    found, _ = quiet(lambda: propagate(model, LEFT, samples=512, seed=1))
    note = of_code(found, "negative_speed")
    assert note.fields == {"cases": None, "share": None, "times": sum(alone)}
    assert note.statement.startswith(
        f"at least {sum(below)} of 512 cases, and {sum(alone)} warnings that do not say of "
        "which, so the share is not known: speed_a is below 0"
    )


def sticking(speed):
    """A contact that sticks by an infinite friction, and is refused where A is slow."""
    striking = col.Vehicle(mass=1500, vx=speed, yaw_inertia=2500, x=-2.0, y=0.0)
    struck = col.Vehicle(mass=1250, vy=12.0, yaw_inertia=1900, x=0.9, y=-0.4)
    return col.eccentric(
        striking, struck, 0.1, normal=0.0, point=(0.0, 0.2), friction=math.inf, on_failure="nan"
    ).a.delta_v


STICKING = {"speed": Normal(6.0, 3.0)}


@pytest.mark.parametrize("copied", [False, True])
def test_threads_that_a_model_starts_are_counted_in_a_copy_of_its_context_alone(copied):
    """Elsewhere what they warn of is given there, as of any other thread."""

    def solved(speed):
        if not copied:
            warn_of_cases(col.CollisionsWarning("in a thread", code="there"), {"there": None})
        return sticking(speed)

    def model(speed):
        with ThreadPoolExecutor(2) as own:
            tasks = [
                own.submit(copy_context().run, solved, part) if copied else own.submit(solved, part)
                for part in np.array_split(speed, 2)
            ]
            return {"delta_v": np.concatenate([task.result() for task in tasks])}

    study = partial(propagate, inputs=STICKING, samples=256, seed=1)
    found, caught = quiet(lambda: study(model))
    plain, _ = quiet(lambda: study(lambda speed: {"delta_v": sticking(speed)}))
    raised = {one.message.code for one in caught}
    if not copied:
        assert raised == {"there", "failed_cases"}
        assert [one.code for one in found.notes] == ["failed_cases"]
        return
    assert {one.code for one in plain.notes} == {one.code for one in found.notes}
    assert {"may_slide", "refused_cases"} <= {one.code for one in found.notes}
    note = of_code(found, "may_slide")
    assert note.fields == {"cases": None, "share": None, "times": 2}
    assert note.statement.startswith("2 warnings that do not say of which of 256 cases")
    assert "may_slide" in raised
    assert any("it slid" in text for text in found.statements)


@pytest.mark.slow
@pytest.mark.parametrize("before", [False, True])
@pytest.mark.parametrize("study", ["propagate", "fit", "posterior"])
def test_other_threads_say_nothing_of_a_study_and_hear_nothing_of_it(study, before):
    """Threads that were there before the model was called, and such as anybody starts meanwhile, as
    a service does for each request.
    """
    asked, answered = Event(), Event()
    other = {}

    def beside():
        assert asked.wait(60.0)
        warn_of_cases(col.CollisionsWarning("of another thread", code="other"), {"other": None})
        other["study"] = propagate(
            lambda speed: {"delta_v": sticking(speed)}, STICKING, samples=256, seed=1
        )
        answered.set()

    def held(x):
        asked.set()
        assert answered.wait(60.0)
        return {"y": 2.0 * x}

    def run(model):
        if study == "propagate":
            return propagate(model, {"x": Normal(0.0, 1.0)}, samples=64, seed=1)
        options = {"samples": 512, "seed": 1} if study == "posterior" else {}
        return getattr(reconstruct, study)(
            model, {"x": Uniform(0.0, 3.0)}, {"y": (2.0, 0.1)}, **options
        )

    first = Thread(target=lambda: other.update(found=run(held)))
    second = Thread(target=beside)

    def both():
        if before:
            second.start()
        first.start()
        assert asked.wait(60.0)
        if not before:
            second.start()
        for thread in (first, second):
            thread.join()

    _, caught = quiet(both)
    alone, own = quiet(lambda: run(lambda x: {"y": 2.0 * x}))
    assert other["found"].statements == alone.statements
    beside_alone, heard = quiet(
        lambda: propagate(lambda speed: {"delta_v": sticking(speed)}, STICKING, samples=256, seed=1)
    )
    assert other["study"].statements == beside_alone.statements
    expected = ["other", *(one.message.code for one in (*own, *heard))]
    assert sorted(one.message.code for one in caught) == sorted(expected)


def speed_of_course(course, speed):
    """Speeds before, of which a few in a thousand are below 0."""
    found = reconstruct.momentum(
        1500.0,
        1200.0,
        course_a=0.0,
        course_b=course,
        course_a_after=0.4,
        course_b_after=0.6,
        speed_a_after=speed,
        speed_b_after=10.0,
        on_failure="nan",
    )
    return {"speed_a": found.speed_a}


WITHIN = "in a study within the model, "


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_what_a_study_within_a_model_states_is_stated_once(threads):
    """As by that study alone, with its own numbers."""

    def inner():
        inputs = {"course": Normal(0.8, 0.1), "speed": Normal(9.0, 1.0)}
        return propagate(speed_of_course, inputs, samples=1024, seed=1)

    def model(x):
        return {"x": x * inner()["speed_a"].mean}

    alone, caught = quiet(inner)
    assert not caught
    codes = [note.code for note in alone.notes]
    assert codes == ["instant", "negative_speed"]
    below = int(np.count_nonzero(alone["speed_a"].values < 0.0))
    assert 0 < below < 5
    found, caught = quiet(
        lambda: propagate(model, {"x": Normal(1.0, 0.1)}, samples=16384, seed=1, threads=threads)
    )
    assert not caught
    assert sorted(found.statements) == sorted(WITHIN + text for text in alone.statements)
    assert any(text.startswith(f"{WITHIN}{below} of 1024 cases") for text in found.statements)
    assert all(text[1:] in " ".join(str(found.summary()).split()) for text in found.statements)

    def nested(y):
        outer = propagate(model, {"x": Normal(1.0, 0.1)}, samples=64, seed=1)
        return {"y": y * outer["x"].mean}

    (twice, _) = quiet(lambda: propagate(nested, {"y": Normal(1.0, 0.1)}, samples=64, seed=1))
    assert sorted(twice.statements) == sorted(2 * WITHIN + text for text in alone.statements)


@pytest.mark.slow
def test_many_studies_within_a_model_that_differ_in_numbers_alone_are_one_statement():
    """A study for each case, which states and raises other numbers for each."""

    def inner(course):
        inputs = {"course": Normal(course, 0.1), "speed": Normal(9.0, 1.0)}
        return propagate(speed_of_course, inputs, samples=256, seed=1)["speed_a"].mean

    def model(course):
        return {"mean": np.array([inner(one) for one in course.tolist()])}

    found, caught = quiet(
        lambda: propagate(model, {"course": Uniform(0.65, 0.77)}, samples=64, seed=1)
    )
    below = [one for one in found.notes if "speed_a is below 0" in one.sentence]
    stated = [note for note in below if note.warning is None]
    (raised,) = [note for note in below if note.warning]
    # One of 256 cases is the most that is not raised.
    assert [note.statement.partition(" (")[0] for note in stated] == [f"{WITHIN}1 of 256 cases"]
    assert "in several studies within the model, of which one says: " in raised.statement
    assert 1 < raised.fields["times"] < 64
    assert [one.message.code for one in caught].count("negative_speed") == 1
    assert sum("as an instant" in text for text in found.statements) == 1


def test_what_a_study_within_a_model_says_of_things_with_numbered_names_is_all_said():
    def twice(value):
        for name in ("contacts[0]", "contacts[1]", "speed_1", "speed_2"):
            warn(col.CollisionsWarning(f"{name} is {value:.3g}", code="named"))
        return {"twice": 2.0 * value}

    def model(x):
        inner = propagate(
            lambda z: {"z": [twice(one)["twice"] for one in z.tolist()]},
            {"z": Normal(1.0, 1e-9)}, samples=64, seed=1,
        )  # fmt: skip
        return {"x": x * inner["z"].mean}

    found, _ = quiet(lambda: propagate(model, {"x": Normal(1.0, 0.1)}, samples=64, seed=1))
    for name in ("contacts[0]", "contacts[1]", "speed_1", "speed_2"):
        (said,) = [text for text in found.statements if f"{name} is 1" in text]
        assert "several" not in said


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_a_study_that_works_back_says_is_said_wherever_it_is():
    """A fit within ``propagate``, and ``propagate`` within a fit: both work back."""
    instant = "eccentric solved every case as an instant"

    def delta_v(speed):
        return {
            "delta_v": col.eccentric(
                A.replace(vx=speed), B, 0.1, **(CONTACT | {"friction": 0.5})
            ).a.delta_v
        }

    def fitted(read):
        found = reconstruct.fit(
            delta_v, {"speed": Interval(0.0, 30.0)}, {"delta_v": (float(np.mean(read)), 0.3)}
        )
        return found["speed"].value

    def mean_of(speed):
        each = (
            propagate(delta_v, {"speed": Normal(one, 0.5)}, samples=64, seed=1)["delta_v"].mean
            for one in speed.tolist()
        )
        return {"mean": np.array(list(each))}

    forwards = propagate(
        lambda x: {"y": fitted(6.0) * x}, {"x": Normal(1.0, 0.1)}, samples=64, seed=1
    )
    assert sum(instant in text and WITHIN in text for text in forwards.statements) == 1
    assert not any("agrees with itself" in text for text in forwards.statements)
    back = reconstruct.fit(mean_of, {"speed": Interval(5.0, 20.0)}, {"mean": (6.0, 0.3)})
    assert sum(instant in text and WITHIN in text for text in back.statements) == 1
    again = propagate(mean_of, {"speed": Normal(12.0, 1.0)}, samples=64, seed=1)
    assert not any(instant in text for text in again.statements)


@pytest.mark.slow
def test_fits_and_posteriors_give_a_loop_no_share():
    counted = []

    def each(speed):
        for value in speed.tolist():
            if value < 20.0:
                text = "slower than 20 m/s"
                warn_of_cases(col.CollisionsWarning(text, code="slow"), {text: None})
        return speed

    def model(speed):
        counted.append((speed.size, int(np.count_nonzero(speed < 20.0))))
        return {"speed": each(speed)}

    unknowns, seen = {"speed": Uniform(5.0, 60.0)}, {"speed": (19.0, 1.0)}
    fitted, _ = quiet(lambda: reconstruct.fit(model, unknowns, seen))
    # The answer is one case, of which it is known.
    assert "slower than 20 m/s" in fitted.statements
    found, _ = quiet(lambda: reconstruct.posterior(model, unknowns, seen, samples=512, seed=1))
    below = int(np.count_nonzero(found["speed"].values < 20.0))
    assert counted[-1] == (512, below)
    said = (
        f"{below} warnings that do not say of which of 512 cases, which may be all: slower than "
        "20 m/s"
    )
    assert said in found.statements
    more, _ = quiet(lambda: found.with_result("again", each, speed=found["speed"]))
    assert sum(said in text for text in more.statements) == 2
    compared, _ = quiet(lambda: reconstruct.compare({"one": found, "other": found}))
    assert f"one, other: {said}" in compared.statements


def test_one_warning_of_many_calls_is_one_statement_whatever_its_numbers():
    """Blocks of samples say different worst numbers; their cases are added up."""
    below = []

    def model(gain):
        after = col.Vehicle(mass=1500.0, vx=gain)
        e = reconstruct.restitution(
            col.Vehicle(mass=1500.0, vx=10.0),
            col.Vehicle(mass=1200.0),
            after,
            col.Vehicle(mass=1200.0, vx=6.0),
            normal=0.0,
        )
        if e.size > 4:
            below.append(int(np.count_nonzero(e < 0.0)))
        return {"e": e}

    found, caught = quiet(
        lambda: propagate(model, {"gain": Normal(4.0, 0.7)}, samples=40000, seed=1)
    )
    assert len(below) > 1
    (note,) = [one for one in found.notes if one.code == "observed_restitution"]
    assert note.fields["cases"] == sum(below) > 0
    assert [one.message.code for one in caught].count("observed_restitution") == (
        note.fields["share"] >= 0.005
    )


def test_what_a_reference_value_warns_of_reaches_the_study():
    def model(speed):
        return {"e": reference.restitution(speed, outside="warn")}

    found, caught = quiet(
        lambda: propagate(model, {"speed": Uniform(0.05, 20.0)}, samples=1024, seed=1)
    )
    codes = [one.code for one in found.notes]
    assert "outside_reference" in codes
    assert [one.message.code for one in caught].count("outside_reference") == 1


@pytest.mark.slow
def test_bounds_alone_state_the_warnings_too():
    found, caught = quiet(lambda: propagate(gaining, {"ratio": Interval(-0.6, 0.6)}))
    assert any("gains energy" in one for one in found.statements)
    assert len([one for one in caught if one.message.code == "energy_gain"]) == 1


@pytest.mark.slow
def test_a_warning_of_an_interval_alone_is_counted_beside_a_distribution():
    """In the runs at its ends too, where it is the same number in all cases."""
    asked = []

    def model(speed, mass):
        e = reference.restitution(speed, outside="warn")
        if np.size(mass) > 4:  # fewer are asked again as a check
            inside = (speed >= 0.89408) & (speed <= 6.7056)
            asked.append(np.count_nonzero(np.broadcast_to(~inside, np.shape(mass))))
        return {"delta_v": e * mass / 1000.0}

    given = {"speed": Interval(0.3, 7.0), "mass": Normal(1500.0, 20.0)}
    found, caught = quiet(lambda: propagate(model, given, samples=256, seed=1))
    (note,) = [one for one in found.notes if one.code == "outside_reference"]
    assert note.statement.startswith(f"{note.fields['cases']} of {found.samples} cases (")
    assert 0 < note.fields["cases"] == sum(asked)
    assert [one.message.code for one in caught].count("outside_reference") == 1


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


@pytest.mark.slow
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


def test_a_comparison_states_what_too_few_samples_are_warned_of_to_be_raised():
    def model(speed):
        reference.restitution(speed, outside="warn")
        return {"marks": speed}

    prior, seen = {"speed": Normal(4.0, 0.95)}, {"marks": (4.0, 40.0)}
    account, _ = quiet(lambda: reconstruct.posterior(model, prior, seen, samples=1024, seed=1))
    (note,) = [one for one in account.model_notes if one.code == "outside_reference"]
    assert note.warning is None
    found, caught = quiet(lambda: reconstruct.compare({"one": account, "other": account}))
    assert not caught
    assert f"one, other: {note.statement}" in found.statements


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


@pytest.mark.slow
@pytest.mark.parametrize(
    "restitution",
    [
        reference.restitution,
        lambda speed: reference.restitution(float(speed)),  # takes one speed at a time
    ],
)
def test_a_function_of_restitution_warns_of_the_answer_alone(restitution):
    """The formula holds from 2 to 15 mph, and speeds beyond are tried on the way to an answer."""

    def closing(delta_v):
        return reconstruct.inline_closing_speed(1500, 1200, restitution, delta_v_b=delta_v)

    inside, caught = quiet(lambda: closing(4.05))
    assert 2.0 * MPH < inside < 15.0 * MPH
    assert not caught
    beyond, caught = quiet(lambda: closing(9.0))
    assert beyond > 15.0 * MPH
    assert [one.message.code for one in caught] == ["outside_reference"]
    found, caught = quiet(
        lambda: propagate(
            lambda delta_v: {"closing": closing(delta_v)},
            {"delta_v": Normal(3.0, 1.5, truncate=(0.05, None))},
            samples=128,
            seed=1,
        )
    )
    outside = ~((found["closing"].values >= 2.0 * MPH) & (found["closing"].values <= 15.0 * MPH))
    (note,) = (one for one in found.notes if one.code == "outside_reference")
    assert note.fields["cases"] == np.count_nonzero(outside) > 0
    assert [one.message.code for one in caught] == ["outside_reference"]
    assert not caught[0].message.fields.get("times")


@pytest.mark.slow
def test_a_function_of_restitution_warns_of_the_answers_of_speeds():
    """Of three cases the first two are answered, one of them beyond 15 mph."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=0.0, heading=0.0)
    b = col.Vehicle(mass=1900.0, yaw_inertia=3400.0, x=2.0, y=0.2, heading=0.0)
    contact = {"normal": 0.0, "point": (0.0, 0.1), "friction": 0.5}

    def solved(delta_v):
        return reconstruct.speeds(
            a, b, restitution=reference.restitution, course_a=0.0, course_b=0.0, speed_b=0.0,
            delta_v_a=delta_v, **contact,
        )  # fmt: skip

    (one,), caught = quiet(lambda: solved("8 km/h"))
    assert 2.0 * MPH < one.closing_speed < 15.0 * MPH
    assert not caught
    (batch,), caught = quiet(lambda: solved(np.array([2.2, 6.0, np.nan])))
    assert np.isfinite(batch.closing_speed).tolist() == [True, True, False]
    text = next(str(one.message) for one in caught if one.message.code == "outside_reference")
    assert "of 2 cases 1 lie outside" in text


def test_profiles_that_may_be_in_other_units_are_counted_by_case():
    """Depths above 2 m of some samples of one of them."""

    def energy(depth):
        return {"energy": reconstruct.crush_energy(1.5, [depth, depth, 0.2], 4e4, 6e5)}

    found, caught = quiet(
        lambda: propagate(energy, {"depth": Normal(1.8, 0.2)}, samples=128, seed=1)
    )
    (note,) = (one for one in found.notes if one.code == "suspect_units")
    assert 0 < note.fields["cases"] < 128
    (limit,), _ = quiet(lambda: list(energy(2.0).values()))
    assert note.fields["cases"] == np.count_nonzero(found["energy"].values > limit)
    assert [one.message.code for one in caught] == ["suspect_units"]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("kept", ["output", "result"])
def test_what_only_some_samples_of_a_posterior_have_is_said(kept):
    """An output that is not observed, and a result worked out afterwards: both without an answer
    above 18.5 m/s, the middle of the samples.
    """

    def some(speed):
        return np.where(speed > 18.5, np.nan, speed)

    def model(speed):
        return {"read": speed} | ({"other": some(speed)} if kept == "output" else {})

    def study():
        found = reconstruct.posterior(
            model, {"speed": Normal(18.0, 4.0)}, {"read": (18.5, 1.5)}, samples=1024, seed=1
        )
        if kept == "result":
            return found.with_result("other", some, "m/s", speed=found["speed"])
        return found

    found, caught = quiet(study)
    missing = int(np.count_nonzero(found["speed"].values > 18.5))
    assert 400 < missing == found["other"].failed
    assert [one.message.code for one in caught] == ["failed_cases"]
    said = f"{missing} of 1024 samples ({100.0 * missing / 1024:.3g} %) have no 'other'"
    page = col.report(found, form="markdown")
    for place in (
        " ".join(found.statements),
        " ".join(str(found.summary()).split()),
        json.dumps(found.to_dict()),
        page,
    ):
        assert said in place


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_what_a_result_warns_of_is_told_from_what_the_model_warns_of():
    """The same of the same samples, and, with a distribution drawn beside them, of others."""

    def slower(speed, than=20.0):
        where = speed < than
        warn_of_cases(col.CollisionsWarning("slow", code="slow"), {"slower than asked": where})
        return speed

    found = reconstruct.posterior(
        lambda speed: {"read": slower(speed)}, {"speed": Normal(18.0, 4.0)}, {"read": (20.0, 1.0)},
        samples=512, seed=1
    )  # fmt: skip
    more = found.with_result("way", slower, speed=found["speed"])
    more = more.with_result("other", slower, speed=found["speed"], than=Normal(20.0, 5.0))
    below = int(np.count_nonzero(found["speed"].values < 20.0))
    (own,) = (one for one in found.statements if "slower" in one)
    assert own.startswith(f"{below} of 512 cases")
    told = [one for one in more.statements if "slower" in one]
    assert told[:2] == [own, f"way: {own}"]
    assert told[2].startswith("other: ")
    assert len(set(more.statements)) == len(more.statements)
    # What was stated of a distribution that was found stands once too, wherever it goes in.
    known = more.inputs()["speed"]
    again = reconstruct.posterior(
        lambda speed: {"read": speed}, {"speed": known}, {"read": (20.0, 1.0)}, samples=512, seed=1
    )
    summed = again.with_result("sum", lambda speed, v: speed + v, speed=known, v=again["speed"])
    assert any("slower" in one for one in again.statements)
    assert len(set(summed.statements)) == len(summed.statements)


TYRES = {f"tyres_{label}": Tyres(0.7, 0.0, 2.7, 1.5) for label in "ab"} | {"duration": 0.1}
CONTACT = {"normal": 0.0, "point": (0.0, 0.0), "friction": math.inf, "on_failure": "nan"}


@pytest.mark.parametrize(
    "solver",
    [
        lambda a: col.eccentric(a, B, 0.1, **CONTACT),
        lambda a: col.eccentric(a, B, 0.1, **CONTACT, **TYRES),
        lambda a: col.time_resolved(a, B, 0.1, duration=0.1, geometry="fixed", **CONTACT),
        lambda a: col.solve(a, B, 0.1, tolerance=0.0, **CONTACT),
    ],
    ids=["eccentric", "with tyres", "in time", "solve"],
)
def test_a_contact_that_sticks_by_an_infinite_friction_is_noted_of_every_model(solver):
    def model(speed):
        impact = solver(A.replace(vx=speed))
        return {"ratio": abs(impact.impulse_ratio)}

    found, caught = quiet(
        lambda: propagate(model, {"speed": Normal(12.0, 1.0)}, samples=64, seed=1)
    )
    assert np.all(found["ratio"].values > 0.3)
    assert [one.message.code for one in caught] == ["may_slide"]
    assert found.statements[0].startswith("64 of 64 cases")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("study", ["posterior", "fit"])
def test_what_works_back_through_an_instant_says_what_that_leaves_out(study):
    """Of the model that the answer is of, and not of a run forwards."""
    contact = CONTACT | {"friction": 0.5}
    unknowns = {"speed": Uniform(0.0, 30.0)}
    observed = {"delta_v": (6.0, 0.3)}

    def by(solver, **more):
        return lambda speed: {
            "delta_v": solver(A.replace(vx=speed), B, 0.1, **contact, **more).a.delta_v
        }

    def said(model, **finer):
        options = {"samples": 512, "seed": 1} if study == "posterior" else {}
        found = getattr(reconstruct, study)(model, unknowns, observed, **finer, **options)
        texts = [one for one in found.statements if "solved every case" in one]
        assert all(one[1:] in " ".join(str(found.summary()).split()) for one in texts)
        assert all(one in found.to_dict()["statements"] for one in texts)
        return texts

    instant, lasting = by(col.eccentric), by(col.eccentric, **TYRES)
    in_time = by(col.time_resolved, duration=0.1, geometry="fixed", steps=20)
    (text,) = said(instant)
    assert text.startswith("eccentric solved every case as an instant, which leaves out the tyres")
    (text,) = said(lasting)
    assert text.startswith(
        "eccentric solved every case with the tyres, which leaves out that point"
    )
    assert text.endswith("finer= with time_resolved has that too")
    wheels = {"duration": TYRES["duration"], "tyres_a": TYRES["tyres_a"]}
    (text,) = said(by(col.eccentric, **wheels))
    assert "leaves out those of vehicle B, as they were not given, and that point" in text
    (text,) = said(by(col.eccentric, outside_b=(100.0, 0.0)))
    assert "as an instant with the impulses from outside" in text
    assert not said(in_time)
    assert not said(instant, finer=in_time)
    forwards = propagate(instant, {"speed": Normal(12.0, 1.0)}, samples=64, seed=1)
    assert not forwards.statements


def test_profiles_that_do_not_go_together_are_refused_as_such():
    with pytest.raises(col.ShapeError, match=r"depths\[0\] \(3,\), depths\[1\] \(2,\)"):
        reconstruct.crush_energy(1.5, [np.full(3, 3.0), np.full(2, 0.3)], 4e4, 6e5)


@pytest.mark.slow
def test_whatever_a_function_of_restitution_warns_of_is_of_the_answer():
    """A warning of bare units in it comes once, not for each speed that is tried."""

    def restitution(speed):
        reconstruct.crush_energy(150.0, [0.3, 0.3], 4e4, 6e5)
        return 0.3 * np.exp(-np.asarray(speed) / 10.0)

    _, caught = quiet(
        lambda: reconstruct.inline_closing_speed(1500, 1200, restitution, delta_v_b=4.05)
    )
    assert [one.message.code for one in caught] == ["suspect_units"]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_fit_states_what_holds_at_an_end_of_its_range_alone():
    """The formula of restitution holds to 15 mph, which lies within the range and above the
    estimate.
    """

    def model(speed):
        e = reference.restitution(speed)
        return {"delta_v": (1.0 + e) * 1500 / 2700 * speed}

    unknowns = {"speed": Uniform(1.0, 12.0)}
    near, far = (
        reconstruct.fit(model, unknowns, {"delta_v": (value, 0.3)}) for value in (4.3, 2.2)
    )
    assert near["speed"].value < 15.0 * MPH < near["speed"].interval(0.95)[1]
    (text,) = (one for one in near.statements if "at an end of a 95 percent range" in one)
    assert "restitution against closing speed outside the range it holds for" in text
    assert not near.model_notes[-1].warning
    low, high = far["speed"].interval(0.95)
    assert 2.0 * MPH < low < high < 15.0 * MPH
    assert not any("at an end" in one for one in far.statements)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.IllConditionedWarning")
@pytest.mark.parametrize(
    ("study", "read", "suspected"),
    [
        *((study, *read) for study in ("fit", "posterior") for read in (
            ((41.0, 3.0), "41"), (("41 deg", "3 deg"), ""), ((0.7, 0.05), ""))),
        ("posterior", Interval(38, 44), "44"),
    ],
)  # fmt: skip
def test_a_bare_reading_of_an_angle_of_more_than_a_turn_is_suspected(study, read, suspected):
    """Degrees without their unit would be taken round the circle as radians."""

    def model(speed):
        impact = col.eccentric(
            A.replace(vx=speed), B, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5,
            on_failure="nan",
        )  # fmt: skip
        return {"course": impact.b.after.q.course}

    options = {"samples": 512, "seed": 1} if study == "posterior" else {}

    found, caught = quiet(
        lambda: getattr(reconstruct, study)(
            model, {"speed": Uniform(5.0, 25.0)}, {"course": read}, **options
        )
    )
    said = [str(one.message) for one in caught if one.message.code == "suspect_units"]
    if suspected:
        (text,) = said
        assert f"write '{suspected} deg'" in text
        assert any("read as radians" in one for one in found.statements)
    else:
        assert not said


@pytest.mark.slow
def test_a_bare_place_of_a_recorder_in_inches_is_suspected():
    """15 m ahead of the centre of mass is in no car; with a unit it is taken."""
    ahead = col.eccentric(A, B, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5)
    known = {f"delta_v_{way}_a": getattr(ahead.a, f"delta_v_{way}") for way in ("forward", "left")}
    known |= {"course_a": 0.0, "course_b": np.pi / 2, "restitution": 0.1, "speed_b": 9.0}
    known |= {"normal": 0.0, "point": (0.0, 0.0), "friction": math.inf, "duration": 0.1}

    def codes(place):
        def solved():
            try:
                reconstruct.speeds(A, B, recorder_a=place, **known)
            except col.CollisionsError:
                return

        _, caught = quiet(solved)
        return [one.message.code for one in caught]

    assert codes((15.0, 0.0)).count("suspect_units") == 1
    assert "suspect_units" not in codes(("15 in", 0.0))
    assert "suspect_units" not in codes((1.5, -0.3))


def test_bare_lengths_and_times_of_a_contact_are_suspected():
    """Inches of wheels as metres, milliseconds of a curve as seconds."""
    given = CONTACT | {"friction": 0.5, "duration": 0.1, "geometry": "fixed", "drag": 0.7}

    def codes(solve):
        found, caught = quiet(solve)
        return found, [one.message.code for one in caught]

    _, said = codes(lambda: col.time_resolved(A, B, 0.1, **given, wheelbase=106, track=60))
    assert said == ["suspect_units", "suspect_units"]
    impact, said = codes(
        lambda: col.time_resolved(A, B, 0.1, **given, wheelbase="106 in", track="60 in")
    )
    assert not said
    assert codes(lambda: impact.b.recorded(40))[1] == ["suspect_units"]
    assert codes(lambda: impact.b.recorded([0.01, 40]))[1] == ["suspect_units"]
    assert codes(lambda: impact.b.recorded("40 ms"))[1] == []
    assert codes(lambda: impact.b.recorded("40 s"))[1] == []
    with pytest.raises(col.InputError, match=r"got '400 m'$"):
        impact.b.recorded("40 ms", forward="400 m")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_a_fit_looks_along_what_is_known_together_too():
    """Each speed is known to 5 mph, and their difference, which the formula takes, much better."""

    def model(va, vb):
        impact = col.linear_central(
            A.replace(vx=va), A.replace(x=4.0, vx=vb), reference.restitution(va - vb)
        )
        return {"dv": impact.b.delta_v}

    unknowns = {"va": Normal("40 mph", "5 mph"), "vb": Normal("26.5 mph", "5 mph")}
    found = reconstruct.fit(model, unknowns, {"dv": (4.0, 0.4)})
    assert 0.0 < found["va"].value - found["vb"].value < 15.0 * MPH
    assert any("at an end of a 95 percent range" in one for one in found.statements)
