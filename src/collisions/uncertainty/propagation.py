"""``propagate``: what a model's outputs are, given how well its inputs are known."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any, Literal, TypeAlias

import numpy as np

from ..errors import InputError, NoSolutionError
from ..progress import reporter
from .bounds import Bounds, Known
from .derivatives import differences, local_output, slopes
from .designs import DESIGNS, MOST_DIMENSIONS, REPLICATES, Design
from .distributions import Distribution, pair_hints
from .draw import Correlation, Joint
from .intervals import extremes
from .model import Function, Model, check_names
from .question import LOCAL, check_options, read_inputs, read_tolerances
from .result import Propagation
from .sampled import Sampled
from .sampling import MOST_SAMPLES, Sample, enough
from .shares import sampled_shares
from .telling import Run, tell

Method: TypeAlias = Literal["first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo", "interval"]
Report: TypeAlias = Callable[[int, int], None]

_SAMPLES = 8192
_SHARE_SAMPLES = 8192


def propagate(
    model: Function,
    inputs: Mapping[str, Any],
    *,
    method: Method,
    samples: int | None = None,
    tolerance: Any = None,
    seed: int | None = None,
    correlation: Correlation | None = None,
    threads: int = 1,
    progress: Callable[[int, int], None] | bool | None = None,
) -> Propagation:
    """What follows from inputs that are not known exactly: mean, spread and range of every output, given the stated inputs.

    The model is any function of named inputs: a solver, a reconstruction, or a chain of them. It is called with arrays of cases
    and answers case by case. ``"quasi_random"`` is right for any model and the one to take if in doubt; ``"latin_hypercube"``
    and ``"monte_carlo"`` need more cases for the same standard error. ``"first_order"`` and ``"second_order"`` take derivatives
    at the mean of the inputs: right where the model is nearly straight, or nearly a parabola, over their spread. They compare
    themselves with cases drawn from the inputs, and warn where they differ. ``"interval"`` finds the least and the greatest
    value between bounds, and knows nothing of likelihood. What the inputs leave out, the answer does.

    Parameters
    ----------
    model : function
        ``model(**inputs)`` returns a dict of named outputs: arrays of one number a case, or Quantities. Each case is worked out
        by itself: a few are asked again alone, and a model that then answers otherwise is refused. Refused cases are NaN,
        which solvers give with ``on_failure="nan"``. Booleans count as 0 and 1, so that a mean is a probability. Angles with
        their unit that all lie from -pi to pi are directions, counted round the circle about their mean, see ``Output``;
        return a rotation as a plain number.
    inputs : dict
        By name ``Normal``, ``Uniform``, ``Triangular``, ``LogNormal``, ``Samples``, ``Interval``, or a fixed value. Numbers
        reach the model in SI, without their unit.
    method : str
        "first_order", "second_order", "latin_hypercube", "quasi_random", "monte_carlo" or "interval".
    samples : int, optional
        Cases to draw, at least 64; 8192 if neither this nor ``tolerance`` is given. Powers of two serve "quasi_random" best.
    tolerance : float, str, Quantity or dict of these by output, optional
        Go on until the standard errors of the mean, of the standard deviation and of both ends of the 95 percent interval are
        below this, in the unit of the output; at most 2**24 cases.
    seed : int, optional
        Makes the run reproducible to the bit, for any number of threads; without it, ``result.seed`` tells what was used.
    correlation : dict, optional
        Correlation, -1 to 1, by pair of input names, such as ``{("mass_a", "mass_b"): 1.0}`` for a shared scale: between the
        values of normal inputs, of others between their normal scores. Pairs left out are independent.
    threads : int, optional
        Blocks of cases worked on at once. The model must then be safe to call from several threads.
    progress : function or bool, optional
        Of methods that draw: called with cases done and cases in all (as far as is known with ``tolerance``); True shows a
        bar, with tqdm where that is installed (extra ``progress``). An interrupt returns what was done until then.

    Returns
    -------
    Propagation
        Outputs by name, with mean, standard deviation, quantiles, standard errors and contributions; cases without an answer
        are counted in ``failed``.

    Raises
    ------
    InputError
        An argument that cannot be used, or a model that does not answer case by case (code "bad_model").
    NoSolutionError
        The model has no answer where it was asked.

    Warns
    -----
    OutOfRangeWarning
        Cases had no answer, or a local method differs from the model.

    Examples
    --------
    A rear-end impact whose restitution and closing speed are known within ranges:

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
    """
    check_options(method, samples, tolerance, seed, threads, progress)
    stated, drawn, intervals, fixed = read_inputs(inputs)
    whole = Model(model, fixed)
    check_names(model, stated, "inputs", "bad_inputs")
    if method == "interval":
        return _by_interval(whole, stated, drawn, intervals, correlation)
    if not drawn:
        raise InputError(
            f"method={method!r} needs an input with a distribution, and there is none; of intervals alone take "
            f"method='interval'{pair_hints(fixed)}",
            code="nothing_uncertain",
            argument="inputs",
        )
    joint = Joint(drawn, correlation)
    if 2 * joint.dimensions > MOST_DIMENSIONS and method in (*LOCAL, "quasi_random"):
        raise InputError(
            f"{joint.dimensions} independent inputs are more than the {MOST_DIMENSIONS // 2} that "
            f"method={method!r} spreads its points over; take method='monte_carlo'",
            code="too_many_inputs",
            argument="inputs",
        )
    seed = secrets.randbits(64) if seed is None else int(seed)
    report = reporter(progress)
    run: Callable[[Model, Report | None], Run] = (
        partial(_local, method, joint)
        if method in LOCAL
        else partial(_sampled, method, joint, int(samples or _SAMPLES), tolerance, seed, int(threads))
    )
    asked = failed = 0
    if not intervals:
        runs = [run(whole, report)]
        number, outputs = 1, dict(runs[0].outputs)
        _check_answered(runs)
    else:
        searched = extremes(whole, intervals, joint, DESIGNS["quasi_random"](joint.dimensions, seed, 0))
        spots, asked, failed = searched.places, searched.asked, searched.failed
        runs, number = [], len(spots)
        try:
            for spot in spots:
                further = None if report is None else _further(report, sum(run.asked for run in runs), number - len(runs))
                runs.append(run(whole.at(spot), further))
                if runs[-1].interrupted:
                    break
        except KeyboardInterrupt:
            if not runs:
                raise
        _check_answered(runs)
        outputs = {
            name: Bounds(
                name, one.unit, [run.outputs[name] for run in runs if name not in run.unanswered], searched.cuts.get(name)
            )
            for name, one in runs[0].outputs.items()
        }
    asked, failed = asked + sum(run.asked for run in runs), failed + sum(run.failed for run in runs)
    tell(method, runs, number, method in LOCAL, asked, failed)
    interrupted = len(runs) < number or runs[-1].interrupted
    return Propagation(method, stated, outputs, asked, failed, None if method in LOCAL else seed, interrupted)


def _further(report: Report, before: int, left: int) -> Report:
    """Progress of one of several runs, as that of all of them."""
    return lambda done, total: report(before + done, before + left * total)


def _local(method: str, joint: Joint, model: Model, report: Report | None) -> Run:
    """A run by derivatives at the mean: of so few cases that there is no progress to report."""
    second = method == "second_order"
    with np.errstate(all="ignore"):
        found, asked = slopes(model, joint, second)
        outputs = {name: local_output(name, model.units[name], joint, slope, second) for name, slope in found.items()}
        # Always the same points: a local result is not random.
        differing, probes, failed = differences(model, joint, DESIGNS["quasi_random"](joint.dimensions, 0, 0), outputs)
    return Run(outputs, asked + probes, failed, differing=differing)


def _sampled(
    method: str,
    joint: Joint,
    count: int,
    tolerance: Any,
    seed: int,
    threads: int,
    model: Model,
    report: Report | None,
) -> Run:
    """A run by cases drawn from the inputs: this many, and with a tolerance more."""

    def design(dimensions: int) -> Design:
        return DESIGNS[method](dimensions, seed, -(-count // REPLICATES))

    sample = Sample(model, joint, design(joint.dimensions), threads)
    sample.extend(count, report)
    unreached = False
    if tolerance is not None and not any(np.isnan(values).all() for values in sample.outputs().values()):
        wanted = read_tolerances(tolerance, model.units)
        try:
            while not sample.interrupted and not unreached and not enough(sample, model.units, wanted):
                unreached = sample.done >= MOST_SAMPLES
                if not unreached:
                    sample.extend(min(2 * sample.done, MOST_SAMPLES), report)
        except KeyboardInterrupt:
            sample.interrupted = True
    shares = cache(partial(sampled_shares, model, joint, design, min(count, _SHARE_SAMPLES)))
    outputs = {name: Sampled(name, model.units[name], values, shares) for name, values in sample.outputs().items()}
    wrapped = tuple(name for name, output in outputs.items() if output.may_wrap())
    unanswered = frozenset(name for name, output in outputs.items() if output.failed == sample.done)
    return Run(outputs, sample.done, sample.failed(), sample.interrupted, unreached, wrapped, unanswered=unanswered)


def _check_answered(runs: Sequence[Run]) -> None:
    """Refuses an output that has no answer at all."""
    for name in runs[0].outputs:
        if all(name in run.unanswered for run in runs):
            raise NoSolutionError(
                f"the model has no answer for {name!r} in any of {sum(run.asked for run in runs)} cases; call it with the mean "
                f"of the inputs to see why",
                code="all_failed",
                output=name,
            )


def _by_interval(
    model: Model,
    stated: Mapping[str, Any],
    drawn: Mapping[str, Distribution],
    intervals: Mapping[str, tuple[float, float]],
    correlation: Any,
) -> Propagation:
    if correlation is not None and (not isinstance(correlation, Mapping) or correlation):
        raise InputError(
            "method='interval' knows no likelihood, so no correlation either; leave it out",
            code="bad_correlation",
            argument="correlation",
        )
    bounds = dict(intervals)
    for name, distribution in drawn.items():
        low, high = distribution.support
        if not (abs(low) < float("inf") and abs(high) < float("inf")):
            raise InputError(
                f"{name} = {distribution!r} has no bounds for method='interval'; write Interval(low, high), or "
                f"truncate=(low, high)",
                code="unbounded",
                argument=name,
            )
        bounds[name] = low, high
    if not bounds:
        raise InputError(
            f"method='interval' needs an input with bounds, such as Interval(low, high){pair_hints(model.fixed)}",
            code="nothing_uncertain",
            argument="inputs",
        )
    found = extremes(model, {name: bounds[name] for name in stated if name in bounds})
    outputs = {
        name: Bounds(name, model.units[name], [Known(name, model.units[name], end) for end in ends])
        for name, ends in found.values.items()
    }
    run = Run(outputs, found.asked, found.failed, wrapped=found.wrapped)
    tell("interval", [run], 1, local=False, asked=found.asked, failed=found.failed)
    return Propagation("interval", stated, outputs, found.asked, found.failed)
