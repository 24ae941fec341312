"""``propagate``: the distribution of a model's outputs from distributions and intervals of its
inputs.
"""

from __future__ import annotations

import math
import secrets
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any, Literal, TypeAlias

import numpy as np

from ..messages.errors import CollisionsWarning, InputError, NoSolutionError, OutOfRangeWarning
from ..messages.hints import hinted
from ..messages.marked import type_of
from ..messages.progress import reporter
from ..messages.shares import in_percent
from ..messages.warning import BOUND, NO_ANSWER, Note, leave_to_outer, notes_of_samples, warn_of
from ..quantities.reading import ArgumentReader, is_whole
from ..quantities.refusals import must_be
from ..quantities.settings import units_required
from ..quantities.units import has_unit, rendered, shown
from .correction import Corrected, CorrectedOutput, corrected
from .derivatives import PROBES, Local, differences, local_output, slopes
from .designs import DESIGNS, MOST_DIMENSIONS, REPLICATES, Design
from .distribution import GivenUnit, Statement, WithoutUnit, notes_of_inputs
from .distributions import Distribution, Interval
from .finer import FinerModel
from .halved import Halved, widths_if_halved
from .intervals import COMMON_CASES, Bounds, extremes
from .model import (
    AnyModel,
    Model,
    check_names,
    check_units,
    count_failed,
    function_of,
    pair_hints,
    read_input,
    units_taken,
)
from .one_sided import Answers, OneSided
from .one_sided_output import OneSidedOutput, one_sided_notes
from .output import Output, Shares
from .output_notes import tail_notes, wrap_notes, wraps_of
from .result import Propagation
from .sampled import Sampled
from .sampling import Correlation, Joint, Sample, sampled_shares

Method: TypeAlias = Literal[
    "first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo", "interval"
]
Report: TypeAlias = Callable[[int, int], None]

LOCAL = ("first_order", "second_order")
METHODS = (*LOCAL, *DESIGNS, "interval")
MOST_SAMPLES = 2**24
_LEAST_SAMPLES = 4 * REPLICATES
_SAMPLES = 8192
_SHARE_SAMPLES = 8192
_FINER_SAMPLES = 512


@dataclass
class Run:
    """The outputs of one run, its counts, and the warnings it needs."""

    outputs: Mapping[str, Any]
    samples: int
    failed: int
    drawn: int = 0  # cases drawn from the inputs, of which those that failed are counted
    interrupted: bool = False
    unreached: bool = False
    wrapped: Mapping[str, str] = field(default_factory=dict)
    differing: Mapping[str, float] = field(default_factory=dict)
    corrected: Corrected | None = None


@hinted
def propagate(
    model: AnyModel,
    inputs: Mapping[str, Any],
    *,
    finer: AnyModel | None = None,
    finer_samples: int | None = None,
    method: Method | None = None,
    samples: int | None = None,
    tolerance: Any = None,
    seed: int | None = None,
    correlation: Correlation | None = None,
    outputs: Sequence[str] | None = None,
    threads: int = 1,
    progress: Callable[[int, int], None] | bool | None = None,
) -> Propagation:
    """Propagate uncertain inputs through a model: mean, spread and range of every output, given the
    stated inputs.

    The model is any function of named inputs: a solver, a reconstruction, or a chain of them. It is
    called with arrays of cases and answers each case on its own. ``"quasi_random"`` is right for
    any model; use it if in doubt. ``"latin_hypercube"`` and ``"monte_carlo"`` need more cases for
    the same standard error. ``"first_order"`` and ``"second_order"`` take derivatives at the mean
    of the inputs: right where the model is nearly linear, or nearly quadratic, over their spread.
    They check themselves against cases drawn from the inputs, and warn where they differ.
    ``"interval"`` finds the least and the greatest value between bounds, and says nothing about
    likelihood. What the inputs leave out, the answer leaves out too.

    Parameters
    ----------
    model : function
        ``model(**inputs)`` returns a dict of named outputs: arrays of one number per case, or
        Quantities. Each case is computed on its own: a few are computed again without the others,
        and a model that then answers differently is refused. A case without an answer is NaN;
        solvers return it with ``on_failure="nan"``. An output of which some cases say "at least" or
        "at most" is a ``OneSided``. Booleans count as 0 and 1, so their mean is a probability.
        Angles returned with a unit that all lie in [-pi, pi] (-180 to 180 degrees, not 0 to 360)
        are directions, counted round the circle about their mean (see ``Output``); return a
        rotation as a plain number. Warnings of this library are counted by case where solvers are
        called with arrays of all cases; of calls with plain numbers, as in a loop, their number is
        stated, and those in threads and processes that the model starts are given there and are not
        known (a thread counts as the model does if it runs in a copy of its context, as by
        ``submit(copy_context().run, ...)`` with ``contextvars.copy_context``). Other warnings that
        the model gives go where warnings go, and are counted nowhere.
        A ``scene.Scene`` is a model too: its inputs and ``outputs`` are named by their paths.
    inputs : dict
        For each name a ``Normal``, ``Uniform``, ``Triangular``, ``LogNormal``, ``Samples``,
        ``Interval`` or fixed value. Numbers reach the model in SI, without their unit.
    finer : function, optional
        A model that takes the same inputs and returns the same outputs, and costs more. It is asked
        about a few hundred of the samples; all samples are corrected by how the difference follows
        from the inputs and the outputs of ``model`` there (a regression), and what it leaves is
        added as scatter. The statements say how much that is, in cross-validation. Samples far
        beyond those asked, such as a few in which a contact slid, are asked too. Where what is left
        depends on the inputs, as beside a bend of the finer model, ends of ranges are off; their
        standard errors, and those of probabilities, are then what the cases asked tell of the
        difference. What it leaves is due to no input in ``contributions``, and what only the finer
        model does, and in fewer than three of the cases asked, may be missed. Only for methods that
        draw, without ``tolerance``.
    finer_samples : int, optional
        How many samples the finer model is asked about, at least 64; 512 if not given, or all if
        there are fewer.
    method : str, optional
        "first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo" or
        "interval". By default "quasi_random", or "interval" if all uncertain inputs are intervals.
    samples : int, optional
        Cases to draw, at least 64; 8192 if neither this nor ``tolerance`` is given. Powers of two
        suit "quasi_random" best.
    tolerance : float, str, Quantity or dict of these by output, optional
        Draw cases until the standard errors of the mean, of the standard deviation and of both ends
        of the 95 percent interval are below this, in the unit of the output; at most 2**24.
    seed : int, optional
        Makes the run reproducible to the bit, for any number of threads; without one,
        ``result.seed`` says which was used.
    correlation : dict, optional
        Correlation, -1 to 1, for pairs of input names, such as ``{("mass_a", "mass_b"): 1.0}`` for
        masses weighed on one scale: between the values of normal inputs, or the normal scores of
        others. Pairs that are not listed are independent.
    outputs : list of str, optional
        Of a scene, the paths of the results that are asked for, as ``Scene.results`` lists them;
        only what they need is worked out.
    threads : int, optional
        Number of blocks of cases computed at once. If more than 1, the model must be safe to call
        from several threads.
    progress : function or bool, optional
        For methods that draw: called with the numbers of cases done and in all (with ``tolerance``,
        as far as known); True shows a bar, by tqdm if it is installed (extra ``progress``). An
        interrupt returns the blocks of cases that are done, of which the first has 1,024 cases with
        progress and 8,192 without; during the first one it is a KeyboardInterrupt.

    Returns
    -------
    Propagation
        Outputs by name, with mean, standard deviation, quantiles, standard errors and
        contributions; cases without an answer are counted in ``failed``.

    Raises
    ------
    InputError
        An argument that cannot be used, or a model that does not answer case by case (code
        "bad_model"), or a finer model with other outputs (code "different_outputs").
    NoSolutionError
        The model has no answer where one is needed; or the finer model differs from it by what
        cannot be foreseen, more than a third of the spread of an output (code "too_different").

    Warns
    -----
    OutOfRangeWarning
        Cases had no answer, or a local method differs from the model; or an output looks like an
        angle that jumps, or has directions to all sides, so that its mean means nothing, or little.
    CollisionsWarning
        What this library warned of while the model worked, or of a fit or a posterior whose
        ``inputs`` these are, once for each code. A warning of fewer
        than 0.5 percent of the cases (95 percent where it is that readings differ) is not raised
        and stands in ``statements`` alone; that cases have no answer is raised of any.

    Examples
    --------
    A rear-end impact whose closing speed and restitution are uncertain:

    >>> import collisions as col
    >>> from collisions.uncertainty import Normal, Uniform, propagate
    >>> def rear_end(speed, restitution):
    ...     a, b = col.Vehicle(mass=1500.0, vx=speed), col.Vehicle(mass=1200.0)
    ...     return {"delta_v": col.linear_central(a, b, restitution, on_failure="nan").b.delta_v}
    >>> inputs = {"speed": Normal("20 km/h", "1 km/h"), "restitution": Uniform(0.1, 0.3)}
    >>> found = propagate(rear_end, inputs, method="quasi_random", seed=1)["delta_v"]
    >>> round(found.mean, 3), round(found.std, 3), [round(end, 2) for end in found.interval(0.95)]
    (3.704, 0.257, [3.23, 4.21])
    >>> [f"{name} {share:.0%}" for name, share in found.contributions.items()]
    ['speed 52%', 'restitution 48%']

    Locked wheels of the struck car take some of its delta-V during 0.1 s of contact. A model with
    them is asked about 512 of 8,192 samples.

    >>> def braked(speed, restitution):
    ...     delta_v = rear_end(speed, restitution)["delta_v"]
    ...     return {"delta_v": delta_v - 0.7 * 9.81 * 0.1 * (1 - 0.02 * speed)}
    >>> near = propagate(rear_end, inputs, finer=braked, seed=1)
    >>> exact = propagate(braked, inputs, seed=1)
    >>> near.calls, abs(near["delta_v"].mean - exact["delta_v"].mean) < 0.001
    ({'model': 8192, 'finer': 512}, True)
    """
    check_options(
        "quasi_random" if method is None else method, samples, tolerance, seed, threads, progress
    )
    stated = _read_inputs(inputs)
    wanted = _read_finer(finer, finer_samples, stated, method, tolerance)
    model = function_of(model, stated, outputs, "outputs")
    if units_taken(model):
        check_units(model, _units_stated(inputs, stated), "inputs")
    finer = None if finer is None else function_of(finer, stated, outputs, "finer")
    if method is None:
        kinds = {type(value) for value in stated.values() if isinstance(value, Statement)}
        method = (
            "interval" if kinds == {Interval} and samples is tolerance is None else "quasi_random"
        )
    if seed is None and method in DESIGNS:
        seed = secrets.randbits(64)

    def run(
        stated: dict[str, Any], samples: int | None, tolerance: Any, progress: Any
    ) -> Propagation:
        return _propagated(
            model,
            stated,
            method,
            samples,
            tolerance,
            seed,
            correlation,
            threads,
            progress,
            (finer, wanted),
        )

    found = run(stated, samples, tolerance, progress)
    warn_of(found.notes)
    found._run_halved = partial(_if_halved, run, found)
    return found


def _if_halved(run: Callable[..., Propagation], found: Propagation) -> Halved:
    """The widths of the ranges with half an error, from as many cases as there are, or fewer."""
    first = next(iter(found.outputs.values()))
    case = first.cases[0] if isinstance(first, Bounds) else first
    drawn = len(case.values) if isinstance(case, Sampled) else None
    samples = drawn and min(drawn, _SHARE_SAMPLES)

    def again(stated: Mapping[str, Any]) -> Propagation:
        other = run(dict(stated), samples, None, None)
        if other.interrupted:
            raise KeyboardInterrupt
        return other

    now = found if samples == drawn else again(found.inputs)
    return widths_if_halved(again, now, samples or found.samples)


def _propagated(
    model: AnyModel,
    stated: dict[str, Any],
    method: Method,
    samples: int | None,
    tolerance: Any,
    seed: int | None,
    correlation: Correlation | None,
    threads: int,
    progress: Any,
    refined: tuple[AnyModel | None, int],
) -> Propagation:
    """What ``propagate`` answers for inputs that are read, with the warnings it gives as notes."""
    finer, wanted = refined
    drawn = {name: value for name, value in stated.items() if isinstance(value, Distribution)}
    intervals = {
        name: (value.low, value.high)
        for name, value in stated.items()
        if isinstance(value, Interval)
    }
    fixed = {
        name: value for name, value in stated.items() if name not in drawn and name not in intervals
    }
    _refuse_bounds(fixed)
    whole = Model(
        model,
        fixed,
        one_sided=method in DESIGNS and not intervals and tolerance is None and finer is None,
    )
    check_names(model, stated, "inputs", "bad_inputs")
    dearer = None if finer is None else FinerModel(finer, whole.fixed)
    if dearer is not None:
        dearer.check_inputs(stated, "inputs", "bad_inputs")
    if method == "interval":
        return _by_interval(whole, stated, correlation)
    if not drawn:
        advice = "; write `Normal(mean, sd)` or another of collisions.uncertainty"
        if intervals:
            advice = "; of intervals alone take `method='interval'`"
        raise InputError(
            f"`method={method!r}` needs an input with a distribution, and there is "
            f"none{advice}{pair_hints(whole.fixed)}",
            code="nothing_uncertain",
            argument="inputs",
        )
    joint = Joint(drawn, correlation)
    if 2 * joint.dimensions > MOST_DIMENSIONS and method in (*LOCAL, "quasi_random"):
        raise InputError(
            f"{joint.dimensions} independent inputs are more than the "
            f"{MOST_DIMENSIONS // 2} that `method={method!r}` spreads its points over; take "
            "`method='monte_carlo'`",
            code="too_many_inputs",
            argument="inputs",
        )
    # The points by which a local method is judged are always the same: its result is not random,
    # and reports no seed.
    seed = 0 if method in LOCAL or seed is None else int(seed)
    run: Callable[[Model, Report | None], Run] = (
        partial(_local, method, joint)
        if method in LOCAL
        else partial(
            _sampled,
            method,
            joint,
            int(samples or _SAMPLES),
            tolerance,
            seed,
            int(threads),
            (dearer, wanted),
        )
    )
    places: list[dict[str, float]] = [{}]
    count, failed, cuts = 0, 0, {}
    if intervals:
        searched = extremes(whole, intervals, _evenly_drawn(joint, seed, COMMON_CASES))
        places, count, failed, cuts = (
            searched.places,
            searched.samples,
            searched.failed,
            searched.cuts,
        )
    runs = _run_at(places, whole, run, reporter(progress))
    samples_run = sum(one.samples for one in runs)
    answered: dict[str, Output] = {}
    for name, output in runs[0].outputs.items():
        cases = [
            one.outputs[name]
            for one in runs
            if not (one.failed and _without_answer(one.outputs[name]))
        ]
        if not cases:
            raise NoSolutionError(
                f"the model has no answer for {name!r} in any of {samples_run} cases; call it "
                f"with the mean of the inputs to see why{_said_of_all(whole)}",
                code="all_failed",
                output=name,
            )
        answered[name] = Bounds(name, output.unit, cases, cuts.get(name)) if intervals else output
    judged = count + sum(one.drawn for one in runs)
    count, failed = count + samples_run, failed + sum(one.failed for one in runs)
    notes = _notes(method, runs, len(places), count, failed, whole, stated) + joint.notes
    found = runs[0].corrected
    if found:
        notes = (*found.notes, *notes)
    interrupted = len(runs) < len(places) or runs[-1].interrupted
    return Propagation(
        method,
        stated,
        answered,
        count,
        failed,
        None if method in LOCAL else seed,
        interrupted,
        notes,
        {"model": count, "finer": found.calls} if found else {},
        found.scatter if found else {},
        _unanswered=failed / judged,
    )


def _read_finer(
    finer: Any, wanted: Any, stated: Mapping[str, Any], method: Any, tolerance: Any
) -> int:
    """How many samples a finer model is asked about; refused where there are none to correct."""
    if finer is None:
        if wanted is not None:
            raise _bad_option(
                "finer_samples", ("finer_samples is for a finer model, and `finer=` is not given")
            )
        return 0
    intervals = [name for name, value in stated.items() if isinstance(value, Interval)]
    for argument, given, why in (
        ("method", method not in (None, *DESIGNS), f"`method={method!r}` draws none"),
        ("tolerance", tolerance is not None, "`tolerance=` asks for as many as it takes"),
        ("inputs", bool(intervals), f"{', '.join(intervals)} is an Interval, which is searched"),
    ):
        if given:
            cure = {
                "method": "take `method='quasi_random'`",
                "tolerance": "give `samples=`",
                "inputs": "give a distribution",
            }[argument]
            raise _bad_option(
                argument,
                f"`finer=` corrects a fixed number of samples, and {why}; {cure}, or run the "
                "finer model alone",
                "no_finer",
            )
    if wanted is not None and not (is_whole(wanted) and _LEAST_SAMPLES <= wanted <= MOST_SAMPLES):
        raise _bad_option(
            "finer_samples",
            f"finer_samples must be a whole number from {_LEAST_SAMPLES} to {MOST_SAMPLES}, got "
            f"{shown(wanted)}",
        )
    return int(wanted or _FINER_SAMPLES)


def check_options(
    method: Any,
    samples: Any,
    tolerance: Any,
    seed: Any,
    threads: Any,
    progress: Any,
    least: int = _LEAST_SAMPLES,
) -> None:
    """Raise for an unknown option, or one that this method does not have."""
    if not isinstance(method, str) or method not in METHODS:
        raise _bad_option(
            "method", f"method must be one of {', '.join(METHODS)}, got {shown(method)}"
        )
    if samples is not None and tolerance is not None:
        raise _bad_option("tolerance", "give `samples=` or `tolerance=`, not both")
    for name, value in (("samples", samples), ("tolerance", tolerance)):
        if value is not None and method not in DESIGNS:
            raise _bad_option(
                name, (f"{name} is for methods that draw; `method={method!r}` does not")
            )
    samples_fine = samples is None or (is_whole(samples) and least <= samples <= MOST_SAMPLES)
    progress_fine = progress is None or isinstance(progress, bool) or callable(progress)
    for name, value, fine, allowed in (
        ("samples", samples, samples_fine, f"a whole number from {least} to {MOST_SAMPLES}"),
        (
            "seed",
            seed,
            seed is None or (is_whole(seed) and seed >= 0),
            "a whole number from 0`|, or None|`",
        ),
        ("threads", threads, is_whole(threads) and threads >= 1, "a whole number from 1"),
        ("progress", progress, progress_fine, "a function of (done, total), or `True` for a bar"),
    ):
        if not fine:
            raise _bad_option(name, f"{name} must be {allowed}, got {shown(value)}")


def _bad_option(argument: str, text: str, code: str = "bad_option") -> InputError:
    return InputError(text, code=code, argument=argument)


def _read_inputs(inputs: Any) -> dict[str, Any]:
    """The inputs by name: distributions and intervals as they are, numbers in SI."""
    if not isinstance(inputs, Mapping) or not all(isinstance(name, str) for name in inputs):
        raise must_be(
            "inputs",
            "a dict of what is known by name, such as `{'speed': Normal(15.0, 0.5)}`",
            inputs,
            code="bad_inputs",
            got=type_of(inputs),
        )
    return {name: read_input(name, value) for name, value in inputs.items()}


def _units_stated(inputs: Mapping[str, Any], stated: Mapping[str, Any]) -> dict[str, str | None]:
    """The unit that each input was stated in; None of what is no quantity."""
    units: dict[str, str | None] = {}
    for name, value in stated.items():
        given = inputs[name]
        if isinstance(value, Statement):
            units[name] = value.unit
        elif has_unit(given):
            units[name] = GivenUnit.of(given, name)
        else:
            bare = WithoutUnit.of(given) if isinstance(given, str) else ""
            units[name] = bare if isinstance(value, float) else None
    return units


def _read_tolerances(tolerance: Any, units: Mapping[str, str | None]) -> dict[str, float]:
    """The tolerance of every output it was given for, in the unit of the output."""
    given = tolerance if isinstance(tolerance, Mapping) else dict.fromkeys(units, tolerance)
    unknown = [f"{shown(name)}, which is no output" for name in given if name not in units]
    if unknown or not given:
        text = (
            f"tolerance names {(*unknown, 'no output')[0]}; the model returned {', '.join(units)}"
        )
        raise _bad_option("tolerance", text, "bad_tolerance")
    names = {name: f"tolerance[{rendered(name)}]" for name in given}
    reader = ArgumentReader(trusted=() if units_required.get() else tuple(names.values()))
    found = {
        name: reader.number(value, units[name] or "", names[name]) for name, value in given.items()
    }
    reader.close()
    for name, value in found.items():
        if not isinstance(value, float) or not value > 0.0:
            text = f"tolerance must be a number > 0, got {shown(value)} for {name}"
            raise _bad_option("tolerance", text, "bad_tolerance")
    return found


def _run_at(
    places: Sequence[Mapping[str, float]],
    whole: Model,
    run: Callable[[Model, Report | None], Run],
    report: Report | None,
) -> list[Run]:
    """One run at each point between the bounds of intervals; an interrupt returns the finished
    ones.
    """
    runs: list[Run] = []

    def overall(done: int, total: int) -> None:
        """The progress of one of several runs, as progress of all of them."""
        before = sum(one.samples for one in runs)
        if report is not None:
            report(before + done, before + (len(places) - len(runs)) * total)

    try:
        for place in places:
            runs.append(run(whole.at(place), overall if report else None))
            if runs[-1].interrupted:
                break
    except KeyboardInterrupt:
        if not runs:
            raise
    return runs


def _local(method: str, joint: Joint, model: Model, report: Report | None) -> Run:
    """A run by derivatives at the mean: too few cases for a progress report."""
    second = method == "second_order"
    with np.errstate(all="ignore"):
        found, count = slopes(model, joint, second)
        outputs = {
            name: local_output(name, model.units[name], joint, slope, second)
            for name, slope in found.items()
        }
        differing, failed = differences(model, _evenly_drawn(joint, 0, PROBES), outputs)
    return Run(outputs, count + PROBES, failed, PROBES, differing=differing)


def _evenly_drawn(joint: Joint, seed: int, count: int) -> dict[str, Any]:
    """Evenly spread cases of the inputs, as many as ``count``, a multiple of ``REPLICATES``."""
    points = DESIGNS["quasi_random"](joint.dimensions, seed, 0)(0, count // REPLICATES)
    with np.errstate(all="ignore"):
        return joint.values(points.reshape(joint.dimensions, -1))


def _sampled(
    method: str,
    joint: Joint,
    count: int,
    tolerance: Any,
    seed: int,
    threads: int,
    finer: tuple[FinerModel | None, int],
    model: Model,
    report: Report | None,
) -> Run:
    """A run by drawn cases: this many, and with a tolerance as many more as it takes; corrected by
    a finer model on so many of them.
    """

    def design(dimensions: int) -> Design:
        return DESIGNS[method](dimensions, seed, -(-count // REPLICATES))

    sample = Sample(model, joint, design(joint.dimensions), threads)
    sample.extend(count, report)
    unreached = False
    if tolerance is not None and not any(
        np.isnan(values).all() for values in sample.outputs.values()
    ):
        wanted = _read_tolerances(tolerance, model.units)
        try:
            while not sample.interrupted and not enough(sample, model.units, wanted):
                if unreached := sample.done >= MOST_SAMPLES:
                    break
                sample.extend(min(2 * sample.done, MOST_SAMPLES), report)
        except KeyboardInterrupt:
            sample.interrupted = True
    better: Corrected | None = None
    dearer, wanted_finer = finer
    if dearer is not None:
        inputs = sample.inputs(0, sample.done)
        with np.errstate(all="ignore"):
            better = corrected(model, dearer, inputs, sample.outputs, wanted_finer, seed)
        sample.outputs, model = Answers(better.values, {}), better.model
    foreseen = partial(sampled_shares, model, joint, design, min(count, _SHARE_SAMPLES))
    shares = cache(foreseen if better is None else partial(better.shares, foreseen))
    sides = sample.outputs.sides
    outputs: dict[str, Any] = {
        name: OneSidedOutput(name, model.units[name], values, sides[name], shares)
        if name in sides
        else Sampled(name, model.units[name], values, shares)
        if better is None
        else CorrectedOutput(
            name, model.units[name], values, shares, better.changes[name], better.asked[name]
        )
        for name, values in sample.outputs.items()
    }
    return Run(
        outputs,
        sample.done,
        count_failed(sample.outputs),
        sample.done,
        sample.interrupted,
        unreached,
        wraps_of(outputs),
        corrected=better,
    )


def enough(
    sample: Sample, units: Mapping[str, str | None], tolerances: Mapping[str, float]
) -> bool:
    """Whether the standard errors of mean, standard deviation and both 95 percent ends are all
    below the tolerance.
    """
    for name, tolerance in tolerances.items():
        output = Sampled(name, units[name], sample.outputs[name], dict)
        errors = [
            output.mean_standard_error,
            output.std_standard_error,
            *output.quantile_standard_error([0.025, 0.975]),
        ]
        if not max(errors) <= tolerance:
            return False
    return True


def _refuse_bounds(fixed: Mapping[str, Any]) -> None:
    """Refuse inputs that are neither a number nor a distribution, but known from one side only."""
    for name, value in fixed.items():
        if isinstance(value, Statement | OneSided):
            what = (
                "a reading with a bound, which is evidence for `reconstruct.posterior`"
                if isinstance(value, Statement)
                else "an output that is known from one side only"
            )
            raise InputError(
                f"{name} is {what}: give a distribution of what is known, or `Interval(low, high)`",
                code="bad_inputs",
                argument="inputs",
            )


def _by_interval(model: Model, stated: dict[str, Any], correlation: Any) -> Propagation:
    """The least and the greatest value of every output between the bounds of the inputs."""
    if correlation is not None and (not isinstance(correlation, Mapping) or correlation):
        raise InputError(
            ("`method='interval'` knows no likelihood, so no correlation either; leave it out"),
            code="bad_correlation",
            argument="correlation",
        )
    uncertain = {name: value for name, value in stated.items() if name not in model.fixed}
    bounds = {
        name: (one.low, one.high) if isinstance(one, Interval) else one.support
        for name, one in uncertain.items()
    }
    for name, ends in bounds.items():
        if not all(map(math.isfinite, ends)):
            raise InputError(
                f"{name} = {shown(stated[name])} has no bounds for `method='interval'`; write "
                "`Interval(low, high)`, or `truncate=(low, high)`",
                code="unbounded",
                argument=name,
            )
    if not bounds:
        raise InputError(
            "`method='interval'` needs an input with bounds, such as `Interval(low, "
            f"high)`{pair_hints(model.fixed)}",
            code="nothing_uncertain",
            argument="inputs",
        )
    found = extremes(model, bounds, {})
    outputs: dict[str, Output] = {}
    for name, values in found.values.items():
        unit = model.units[name]
        # Each end is an output with nothing uncertain about it.
        outputs[name] = Bounds(
            name,
            unit,
            [Local(name, unit, value, 0.0, 0.0, Shares({}, {}, {}, {})) for value in values],
        )
    run = Run(outputs, found.samples, found.failed, wrapped=found.wrapped)
    notes = _notes("interval", [run], 1, found.samples, found.failed, model, stated)
    return Propagation(
        "interval",
        stated,
        outputs,
        found.samples,
        found.failed,
        notes=notes,
        _unanswered=found.failed / found.samples,
    )


def _notes(
    method: str,
    runs: Sequence[Run],
    places: int,
    count: int,
    failed: int,
    model: Model,
    stated: Mapping[str, Any],
) -> tuple[Note, ...]:
    """What belongs with the figures: warnings of the model, cases left out, what a tolerance or a
    local method missed, and what was stated of the inputs.
    """
    if not any(run.corrected for run in runs):
        leave_to_outer(model.noted)
    # An output that says so has its own note of each side.
    sided = any(isinstance(one, OneSidedOutput) for run in runs for one in run.outputs.values())
    notes = [
        *(note for note in notes_of_samples(model.noted) if not (sided and note.code == BOUND)),
        *(note for run in runs for note in one_sided_notes(run.outputs)),
        *(tail_notes(runs[0].outputs) if len(runs) == 1 else ()),
    ]
    if method in LOCAL:
        notes += _not_local(method, runs, failed)
    elif failed:
        # That cases have no answer is raised once; which solver refused them, and why, is stated
        # beside it.
        notes = [
            note._replace(warning=None) if note.code == "refused_cases" else note for note in notes
        ]
        notes.append(
            Note(
                OutOfRangeWarning,
                f"{failed} of {count} cases ({in_percent(failed, count)}) had no answer and "
                "are left out: the figures hold only where there is one",
                ""
                if any(note.code in ("stuck_or_slid", "friction_differs") for note in notes)
                else (
                    ". Bound inputs that can be impossible, as by `Normal(mean, sd, truncate=(low, "
                    "high))`"
                ),
                "failed_cases",
                {"failed": failed},
            )
        )
    if any(run.unreached for run in runs):
        cases = max(run.samples for run in runs)
        sentence = (
            f"{cases} cases do not bring the standard errors below the tolerance; this is what "
            "they give"
        )
        notes.append(Note(CollisionsWarning, sentence, code="tolerance_not_reached"))
    done = sum(not run.interrupted for run in runs)
    if done < places:
        rest = (
            f" at {done} of {places} places between the bounds: they say nothing of the rest"
            if places > 1
            else ""
        )
        sentence = f"interrupted after {count} cases; the figures are theirs{rest}"
        notes.append(Note(CollisionsWarning, sentence, code="interrupted", fields={"done": count}))
    wrapped = {name: where for run in reversed(runs) for name, where in run.wrapped.items()}
    notes += wrap_notes(wrapped)
    notes += notes_of_inputs(stated.items())
    return tuple(notes)


def _without_answer(output: Output) -> bool:
    """Whether no case has an answer; the mean is NaN also where some are known from one side."""
    if isinstance(output, OneSidedOutput):
        return bool(np.isnan(output.values).all())
    return math.isnan(output.mean)


def _said_of_all(model: Model) -> str:
    """Why cases have no answer, as far as the model said so, to follow the message that none has
    one; what most are of comes first.
    """
    causes = [
        (count, [one for one in noted if one.code in NO_ANSWER]) for count, noted in model.noted
    ]
    said = [note.sentence for note in notes_of_samples(causes)]
    return f". It said: {'; '.join(said)}" if said else ""


def _not_local(method: str, runs: Sequence[Run], failed: int) -> Iterator[Note]:
    """That a local method does not describe the model, as cases drawn from the inputs show."""
    worst: dict[str, float] = {}
    for run in runs:
        for name, by in run.differing.items():
            worst[name] = max(worst.get(name, 0.0), by)
    reasons = []
    if worst:
        listed = ", ".join(
            f"{name} by {by:.2g} of its standard deviation"
            if math.isfinite(by)
            else f"{name} everywhere"
            for name, by in worst.items()
        )
        reasons.append(f"differs from cases drawn from the inputs: {listed}")
    if failed:
        reasons.append(
            f"knows nothing of the {failed} cases without an answer among those drawn from the "
            "inputs"
        )
    if reasons:
        yield Note(
            OutOfRangeWarning,
            f"`method={method!r}` {' and '.join(reasons)}. A friction limit, a truncation "
            "or a bend lies within the spread of the inputs, or an input is far from normal",
            "; take `method='quasi_random'`",
            "not_local",
            {"differences": worst, "failed": failed},
        )
