"""How often stated 95 percent ranges hold the speeds before, in crashes not made by the package.

Each crash of lasting_population.py is read as an analyst would have it, with the errors below, by
each route of ``ROUTES``.

    python benchmarks/coverage_in_crashes.py [--crashes 150] [--world lasting|instant|both]
        [--route NAME] [--axes turning|fixed] [--samples 256] [--keep DIR] [--json PATH]

The recorders lie at known places off the centres of mass, and their components are of axes that
turn with the car; with ``--axes fixed`` they lie at the centres of mass and their axes do not turn.

A whole table takes hours. With ``--keep`` it can be stopped and taken up again, route by route, and
with ``--json docs/_generated/lasting_crashes.json`` each is put into the table of the page.

In the ``instant`` world the same crashes have contacts of 2 ms and no tyres, so that the models of
the routes are right but for the law of restitution. How wide a route's ranges are there is the
measure of how wide they are in the ``lasting`` world.

A route takes a ``Reading`` and returns the range that it states of each speed. An error of the
package is a refusal; so are more lost samples than ``LOST``. What the solvers are told of the
length of the contact and of the tyres stands in ``lasting`` alone.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from lasting_population import FRICTION, RESISTING, RESTITUTION, SEED, Population, population

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src"))

import collisions as col
from collisions import reconstruct
from collisions.travel import Tyres
from collisions.uncertainty import Distribution, Normal, OneSided, Uniform, propagate

# Standard deviations of what is read, fixed before any route was tried.
MASS_ERROR, INERTIA_ERROR = 0.02, 0.10  # shares
COURSE_ERROR, NORMAL_ERROR = math.radians(2.0), math.radians(4.0)
PLACE_ERROR = 0.1  # m, of each coordinate of the contact point
SPEED_AFTER_ERROR = 0.05  # share
YAW_RATE_ERROR = (0.1, 0.05)  # rad/s, and a share
RECORDER_ERROR = 0.04  # of the delta-V of that car, each component
RECORDED_SPEED = 1.0 / 3.6  # m/s to either side: half the range of a uniform error
DURATION_ERROR, GROUND_ERROR, LOCK_ERROR = (
    0.2,
    0.05,
    0.1,
)  # share; of friction; of the locks of a car's braked wheels together
FASTEST = 40.0  # m/s; before the evidence any speed up to this is as likely
OF_TYRES = ("wheelbase", "track", "cornering", "height")
ENDED = "10 s"  # after first contact, when none lasts any more
PARTS = 20  # of a contact that is taken as an instant, in which its recorders turn
STEPS = 20  # of a contact in time: within 0.1 % of those of 100
LOST = 0.02  # of the samples: above, the range is of the others, and the route counts as refused
# What posterior warns of: errors of a mean in standard deviations, of the logarithm of the evidence
MEAN_ERROR, EVIDENCE_ERROR = 0.1, 0.5
COVERAGE = 0.998  # of the binomial interval of a share held

Speeds = dict[str, tuple[float, float]]
Model = Callable[..., dict[str, Any]]


@dataclass(frozen=True, kw_only=True)
class Reading:
    """One crash as an analyst has it, and its truth beside."""

    truth: dict[str, float]  # speeds before
    stuck: bool
    rolling: bool
    seed: int
    samples: int
    # x, y and heading of each car at maximum engagement.
    place: dict[str, tuple[float, float, float]]
    known: dict[str, Distribution]  # masses, inertias, courses before, normal and point
    motion: dict[str, tuple[float, float]]  # speed, course and yaw rate after, each with its error
    recorded: dict[str, tuple[float, float]]  # components of delta-V, each with its error
    recorder: dict[str, tuple[float, ...]]  # forward and left of the centre of mass
    recorded_speed: dict[str, float]
    # Duration, friction of the ground and how far the locks below are off; of a contact of 2 ms
    # without tyres, nothing.
    contact: dict[str, Distribution]
    locks: dict[str, Any]
    braked: dict[str, Any]  # 1 of a wheel that is braked or locked, 0 of one that rolls
    # What the tyres need besides: wheelbase, track, cornering, height.
    cars: dict[str, dict[str, float]]


def readings(drawn: Population, seed: int, *, samples: int, axes: str) -> Iterator[Reading]:
    """Every crash with the errors of its reading, the same for every route."""
    k, c = drawn.crashes, drawn.contacts
    speed = np.hypot(k.vx, k.vy)
    of_tyres = np.stack([getattr(k, name) for name in OF_TYRES])
    braked = np.where(k.lock > RESISTING[1], 1.0, 0.0)
    recorder = drawn.recorder if axes == "turning" else np.zeros_like(drawn.recorder)
    if axes == "turning":
        forward, left = (curve[-1] for curve in c.turning(recorder[:, 0], recorder[:, 1]))
    else:
        forward, left = c.fixed(k)
    delta_v = np.hypot(*c.fixed(k))
    for i in range(k.normal.size):
        generator = np.random.default_rng([seed, i])

        def read(truth: float, error: float, generator: Any = generator) -> Normal:
            return Normal(truth + error * generator.normal(), error)

        def share(truth: float, error: float, generator: Any = generator) -> tuple[float, float]:
            value = truth * (1.0 + error * generator.normal())
            return value, error * value

        known: dict[str, Distribution] = {
            "normal": read(c.normal[i], NORMAL_ERROR),
            "x": read(c.point[0, i], PLACE_ERROR),
            "y": read(c.point[1, i], PLACE_ERROR),
        }
        motion, recorded, recorded_speed = {}, {}, {}
        for j, label in enumerate("ab"):
            known[f"mass_{label}"] = Normal(*share(k.mass[j, i], MASS_ERROR))
            known[f"inertia_{label}"] = Normal(*share(k.inertia[j, i], INERTIA_ERROR))
            known[f"course_{label}"] = read(math.atan2(k.vy[j, i], k.vx[j, i]), COURSE_ERROR)
            vx, vy, yaw_rate = c.after[j, 3:6, i]
            motion[f"speed_{label}_after"] = share(math.hypot(vx, vy), SPEED_AFTER_ERROR)
            motion[f"course_{label}_after"] = (
                math.atan2(vy, vx) + COURSE_ERROR * generator.normal(),
                COURSE_ERROR,
            )
            error = math.hypot(YAW_RATE_ERROR[0], YAW_RATE_ERROR[1] * yaw_rate)
            motion[f"yaw_rate_{label}_after"] = yaw_rate + error * generator.normal(), error
            error = RECORDER_ERROR * delta_v[j, i]
            for name, value in (("forward", forward), ("left", left)):
                recorded[f"delta_v_{name}_{label}"] = (
                    value[j, i] + error * generator.normal(),
                    error,
                )
            recorded_speed[label] = speed[j, i] + generator.uniform(-RECORDED_SPEED, RECORDED_SPEED)
        off = LOCK_ERROR * generator.normal(size=2)
        contact: dict[str, Distribution] = (
            {}
            if k.ground[i] == 0.0
            else {
                "duration": Normal(*share(c.duration[i], DURATION_ERROR), truncate=(0.0, None)),
                "ground": Normal(
                    k.ground[i] + GROUND_ERROR * generator.normal(),
                    GROUND_ERROR,
                    truncate=(0.05, 1.2),
                ),
                **{f"lock_{label}": Normal(0.0, LOCK_ERROR) for label in "ab"},
            }
        )
        yield Reading(
            truth={label: float(speed[j, i]) for j, label in enumerate("ab")},
            stuck=bool(c.stuck[i]),
            rolling=bool(drawn.rolling[i]),
            seed=i + 1,
            samples=samples,
            place={label: (c.x[j, i], c.y[j, i], c.heading[j, i]) for j, label in enumerate("ab")},
            known=known,
            motion=motion,
            recorded=recorded,
            recorder={label: tuple(recorder[j, :, i]) for j, label in enumerate("ab")},
            recorded_speed=recorded_speed,
            contact=contact,
            locks={
                label: k.lock[j, :, i] + off[j] * braked[j, :, i] for j, label in enumerate("ab")
            },
            braked={label: braked[j, :, i] for j, label in enumerate("ab")},
            cars={
                "a": dict(zip(OF_TYRES, of_tyres[:, 0, i], strict=True)),
                "b": dict(zip(OF_TYRES, of_tyres[:, 1, i], strict=True)),
            },
        )


def lasting(reading: Reading, values: dict[str, Any] | None = None) -> dict[str, Any]:
    """What the solvers are told of the contact in time and of the tyres.

    Without values: the inputs that this needs, by name, as they stand in ``reading.contact``. With
    their values: the arguments made of them, of ``reading.locks`` and of ``reading.cars``. Of an
    impulse without tyres there is nothing to tell.
    """
    if values is None or not reading.contact:
        return dict(reading.contact)
    found = {"duration": values["duration"]}
    for label, of_car in reading.cars.items():
        braked = reading.braked[label]
        locks = [
            np.clip(lock + held * values[f"lock_{label}"], 0.0, 1.0)
            for lock, held in zip(reading.locks[label], braked, strict=True)
        ]
        found[f"tyres_{label}"] = Tyres(values["ground"], locks, **of_car)
    return found


def cars(reading: Reading, values: dict[str, Any], speeds: dict[str, Any]) -> list[col.Vehicle]:
    """Both cars before, at maximum engagement."""
    return [
        col.Vehicle.from_speed(
            mass=values[f"mass_{label}"],
            yaw_inertia=values[f"inertia_{label}"],
            x=x,
            y=y,
            heading=heading,
            speed=speeds[label],
            course=values[f"course_{label}"],
        )
        for label, (x, y, heading) in reading.place.items()
    ]


def ranges(model: Model, inputs: dict[str, Any], reading: Reading, sought: str = "ab") -> Speeds:
    """By ``propagate``; refused where too many samples have no answer."""
    inputs = inputs | lasting(reading)
    settings: dict[str, Any] = {"samples": reading.samples, "seed": reading.seed}
    found = propagate(model, inputs, method="quasi_random", **settings)
    speeds = {label: found[label].interval(0.95) for label in sought}
    if found.failed > LOST * reading.samples:
        raise LostError(speeds)
    return speeds


class LostError(Exception):
    """Too many samples have no answer; it carries the range of the others."""


def by_momentum(reading: Reading) -> Speeds:
    """Courses before, and courses and speeds after."""
    known = {name: reading.known[name] for name in ("mass_a", "mass_b", "course_a", "course_b")}
    # Yaw rates and headings count for the tyres alone.
    with_tyres = bool(reading.contact)
    after = {
        name: Normal(*read)
        for name, read in reading.motion.items()
        if with_tyres or "yaw" not in name
    }
    headings = {f"heading_{label}": place[2] for label, place in reading.place.items()}

    def model(**values: Any) -> dict[str, Any]:
        taken = {name: value for name, value in values.items() if name in known or name in after}
        taken |= lasting(reading, values) | (headings if with_tyres else {})
        found = reconstruct.momentum(**taken, on_failure="nan")
        return {"a": found.speed_a, "b": found.speed_b}

    return ranges(model, known | after, reading)


def by_components(
    reading: Reading,
    recorders: str,
    speed: str = "",
    *,
    regime: str | None = None,
    ratio_shown: bool = False,
) -> Speeds:
    """Components of these recorders, and the speed that one of them tells.

    Whether the contact stuck or slid is left to the friction, and answered by a bound where that
    does not tell, unless the ``regime`` is stated, or a speed is known beside a friction. With
    ``ratio_shown`` no friction is stated.
    """
    inputs = reading.known | {"restitution": Uniform(*RESTITUTION)}
    parts = reading.recorded.items()
    given: dict[str, Any] = {name: Normal(*read) for name, read in parts if name[-1] in recorders}
    fixed: dict[str, Any] = {}
    if speed:
        told = reading.recorded_speed[speed]
        given[f"speed_{speed}"] = Uniform(told - RECORDED_SPEED, told + RECORDED_SPEED)
    if regime or ratio_shown:
        # Of a contact that slid, the components show the friction.
        fixed = {"friction": math.inf} | ({"regime": regime} if regime else {"slid": "bound"})
    else:
        inputs |= {"friction": Uniform(*FRICTION)}
        fixed = {} if speed else {"slid": "bound"}
    if any(any(place) for place in reading.recorder.values()):
        fixed |= {f"recorder_{label}": reading.recorder[label] for label in recorders}
        # Without a duration nothing turns while the contact lasts.
        fixed["duration"] = 0.0
    contact = ("normal", "restitution", "friction", "course_a", "course_b")

    def model(**values: Any) -> dict[str, Any]:
        taken = {name: value for name, value in values.items() if name in given or name in contact}
        arguments = {**taken, **fixed, **lasting(reading, values)}
        found = reconstruct.speeds(
            *cars(reading, values, {"a": 0.0, "b": 0.0}),
            point=(values["x"], values["y"]),
            **arguments,
        )[0]
        sides = found.reconstruction.one_sided or {}
        before = {label: getattr(found, label).before.speed for label in "ab"}
        return {
            label: OneSided(value, sides.get(f"speed_{label}", 0))
            for label, value in before.items()
        }

    return ranges(model, inputs | given, reading, "ab".replace(speed, "") if speed else "ab")


def by_both_recorders(reading: Reading) -> Speeds:
    """Components of both recorders, with the friction of the contact known as its distribution."""
    return by_components(reading, "ab")


def by_both_recorders_stuck(reading: Reading) -> Speeds:
    """Components of both recorders, with the contact stated to have stuck."""
    return by_components(reading, "ab", regime="sticking")


def by_one_recorder(reading: Reading) -> Speeds:
    """Components of A's recorder and the speed that it tells, friction as its distribution."""
    return by_components(reading, "a", "a")


def by_one_recorder_alone(reading: Reading) -> Speeds:
    """The same without a friction: the components show that of a contact that slid."""
    return by_components(reading, "a", "a", ratio_shown=True)


def shown(reading: Reading, side: Any, label: str, duration: Any) -> tuple[Any, Any]:
    """Components of delta-V that a recorder shows at its place, of a contact that was not followed
    in time: along the axes of its car as it is in the middle of the contact.

    The place adds the change of yaw rate and, ahead and aside, the square of the yaw rate over time
    (Marine and Werner, SAE 980219), which grows linearly here.
    """
    forward, left = reading.recorder[label]
    before, after = side.before.yaw_rate, side.after.yaw_rate
    square = duration * (before * before + before * after + after * after) / 3.0
    return (
        side.delta_v_forward - (after - before) * left - square * forward,
        side.delta_v_left + (after - before) * forward - square * left,
    )


def summed(reading: Reading, side: Any, label: str, duration: Any, e: Any) -> tuple[Any, Any]:
    """The same along axes that turn with the car, forward where it is engaged the most.

    The force is that of a linear spring that unloads along a stiffer one: the impulse up to a time
    is a quarter of a cosine until 1 / (1 + e) of the duration, and then a quarter of a sine.
    """
    centre = np.array((side.delta_v_forward, side.delta_v_left))
    place = np.array(shown(reading, side, label, duration)) - centre
    times = np.linspace(0.0, 1.0, PARTS + 1).reshape(-1, *[1] * np.ndim(e)) * (1.0 + e)
    back = np.where(e > 0.0, np.clip(times - 1.0, 0.0, None) / np.where(e > 0.0, e, 1.0), 0.0)
    pressed = 1.0 - np.cos(0.5 * math.pi * np.clip(times, 0.0, 1.0))
    share = (pressed + e * np.sin(0.5 * math.pi * np.clip(back, 0.0, 1.0))) / (1.0 + e)
    spin = side.before.yaw_rate + share * side.delta_yaw_rate
    steps = 0.5 * (spin[1:] + spin[:-1]) * (duration / PARTS)
    turned = np.concatenate((0.0 * steps[:1], np.cumsum(steps, axis=0)))
    engaged = PARTS / (1.0 + e)
    whole = np.minimum(np.floor(engaged), PARTS - 1.0).astype(np.intp)
    low, high = (np.take_along_axis(turned, whole[None] + more, axis=0)[0] for more in (0, 1))
    angle = 0.5 * (turned[1:] + turned[:-1]) - (low + (engaged - whole) * (high - low))
    acted = np.diff(share, axis=0)
    cos, sin = (np.sum(acted * function(angle), axis=0) for function in (np.cos, np.sin))
    forward, left = centre
    return cos * forward + sin * left + place[0], cos * left - sin * forward + place[1]


class Evidence(NamedTuple):
    """What is seen of a crash as evidence of a model: ``eccentric``, and the contact in time as the
    finer one.
    """

    model: Model
    unknowns: dict[str, Any]
    observed: dict[str, Any]
    finer: Model


def priors(reading: Reading) -> dict[str, Any]:
    """What is known of a crash before."""
    unknowns: dict[str, Any] = reading.known | {
        "speed_a": Uniform(0.0, FASTEST),
        "speed_b": Uniform(0.0, FASTEST),
        "restitution": Uniform(*RESTITUTION),
        "friction": Uniform(*FRICTION),
    }
    return unknowns | lasting(reading)


def solved(reading: Reading, values: dict[str, Any], solver: Any, **settings: Any) -> Any:
    """The impact of these values."""
    return solver(
        *cars(reading, values, {label: values[f"speed_{label}"] for label in "ab"}),
        values["restitution"],
        normal=values["normal"],
        point=(values["x"], values["y"]),
        friction=values["friction"],
        **lasting(reading, values),
        **settings,
        on_failure="nan",
    )


def of_motion(reading: Reading) -> Evidence:
    """Size of both delta-V, and motion after: speeds, courses and yaw rates."""
    observed: dict[str, Any] = {}
    for name, (value, error) in reading.motion.items():
        observed[name] = Normal(0.0 if "course" in name else value, error)
    for label in "ab":
        forward, left = (reading.recorded[f"delta_v_{way}_{label}"] for way in ("forward", "left"))
        observed[f"delta_v_{label}"] = Normal(math.hypot(forward[0], left[0]), forward[1])

    def seen(impact: Any, duration: Any) -> dict[str, Any]:
        found = {}
        for label, side in (("a", impact.a), ("b", impact.b)):
            # The course as an angle from the one that was read, which has no jump near it.
            read = reading.motion[f"course_{label}_after"][0]
            found[f"course_{label}_after"] = np.angle(np.exp(1j * (side.after.course - read)))
            found[f"speed_{label}_after"] = side.after.speed
            found[f"yaw_rate_{label}_after"] = side.after.yaw_rate
            # The turn of the axes does not change the size.
            found[f"delta_v_{label}"] = np.hypot(*shown(reading, side, label, duration))
        return found

    def model(**values: Any) -> dict[str, Any]:
        return seen(solved(reading, values, col.eccentric), values.get("duration", 0.0))

    def finer(**values: Any) -> dict[str, Any]:
        impact = solved(reading, values, col.time_resolved, steps=STEPS)
        return seen(impact, values.get("duration", 0.0))

    return Evidence(model, priors(reading), observed, finer)


def left_open(reading: Reading, observed: dict[str, Any]) -> dict[str, Any]:
    """The readings with what ``eccentric`` leaves out beside their errors: the motion during the
    contact, as ``left_out`` estimates it of the impact that momentum finds of what was read.

    The estimate is of a change of velocity in a direction that is not known.
    """
    if not reading.contact:
        return observed
    read = {name: value for name, (value, _) in reading.motion.items()}
    taken = {name: one.quantile(0.5) for name, one in reading.known.items()}
    held = lasting(reading, {name: one.quantile(0.5) for name, one in reading.contact.items()})
    known = {name: taken[name] for name in ("mass_a", "mass_b", "course_a", "course_b")}
    headings = {f"heading_{label}": place[2] for label, place in reading.place.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        before = reconstruct.momentum(**known, **read, **headings, **held)
        impact = col.eccentric(
            *cars(reading, taken, {"a": before.speed_a, "b": before.speed_b}),
            0.5 * sum(RESTITUTION),
            normal=taken["normal"],
            point=(taken["x"], taken["y"]),
            friction=0.5 * sum(FRICTION),
            **held,
        )
        left = col.left_out(impact)
    found = {}
    for name, one in observed.items():
        side = getattr(left, "a" if "_a" in name else "b")
        along = side.geometry_delta_v / math.sqrt(2.0)
        if "course" in name:
            along /= read[name.replace("course", "speed")]
        if "yaw_rate" in name:
            along = side.geometry_yaw_rate
        found[name] = Normal(one.given_mean, math.hypot(one.given_sd, along))
    return found


def of_recorders(reading: Reading, recorders: str, speed: str = "") -> Evidence:
    """Components of these recorders, and the speed that one of them tells."""
    parts = [
        (name, label, way)
        for label in recorders
        for way in ("forward", "left")
        for name in (f"delta_v_{way}_{label}",)
    ]
    observed = {name: Normal(*reading.recorded[name]) for name, _, _ in parts}
    unknowns = priors(reading)
    for label in speed:
        told = reading.recorded_speed[label]
        unknowns[f"speed_{label}"] = Uniform(told - RECORDED_SPEED, told + RECORDED_SPEED)

    def model(**values: Any) -> dict[str, Any]:
        impact = solved(reading, values, col.eccentric)
        duration = values.get("duration", 0.0)
        read = {
            label: dict(
                zip(
                    ("forward", "left"),
                    summed(reading, side, label, duration, values["restitution"]),
                    strict=True,
                )
            )
            for label, side in (("a", impact.a), ("b", impact.b))
        }
        return {name: read[label][way] for name, label, way in parts}

    def finer(**values: Any) -> dict[str, Any]:
        impact = solved(reading, values, col.time_resolved, steps=STEPS)
        read = {}
        for label, side in (("a", impact.a), ("b", impact.b)):
            if label in recorders:
                forward, left = reading.recorder[label]
                # What it shows in the end, so long after first contact.
                at_end = side.recorded(ENDED, forward=forward, left=left)
                read[label] = dict(zip(("forward", "left"), at_end, strict=True))
        return {name: read[label][way] for name, label, way in parts}

    return Evidence(model, unknowns, observed, finer)


def asked(
    solver: Callable[..., Any], *arguments: Any, sought: str = "ab", **settings: Any
) -> Speeds:
    """The ranges of the speeds sought; a warning that is about another unknown alone is left
    out.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", col.CollisionsWarning)
        found = solver(*arguments, **settings)
    speeds = {label: f"speed_{label}" for label in sought}
    for one in caught:
        # That restitution or friction rests on its prior, a true one, or is known less well by so
        # many samples, is nothing against a speed.
        about = concerned(getattr(one.message, "code", ""), found)
        if about is None or about.intersection(speeds.values()):
            warnings.warn(one.message, stacklevel=2)
    return {label: found[name].interval(0.95) for label, name in speeds.items()}


def concerned(code: str, found: Any) -> set[str] | None:
    """The unknowns that a warning of a posterior or a fit is about; None if about all of it."""
    if code in ("undetermined", "told_by_bounds"):  # the evidence tells nothing of an unknown
        if isinstance(found, reconstruct.Posterior):
            return set(found.prior_only)
        left = [one for one in found.undetermined if not one.held_by_prior]
        return {name for one in left for name in one.unknowns} | set(found.told_by_bounds)
    if code == "islands_disagree" and found.log_evidence_error <= EVIDENCE_ERROR:
        errors = {n: one.mean_standard_error / one.std for n, one in found.unknowns.items()}
        return {name for name, error in errors.items() if not error <= MEAN_ERROR}
    return None


def by_posterior(
    reading: Reading, of: Evidence, *, in_time: bool = False, sought: str = "ab"
) -> Speeds:
    """All of the evidence at once, by samples."""
    return asked(
        reconstruct.posterior,
        *of[:3],
        sought=sought,
        finer=of.finer if in_time and reading.contact else None,
        samples=max(512, 4 * reading.samples),
        seed=reading.seed,
    )


def by_posterior_of_motion(reading: Reading, *, in_time: bool = False) -> Speeds:
    """Size of both delta-V, and motion after."""
    return by_posterior(reading, of_motion(reading), in_time=in_time)


def by_posterior_of_one_recorder(reading: Reading, *, in_time: bool = False) -> Speeds:
    """Components of A's recorder and the speed that it tells."""
    evidence = of_recorders(reading, "a", "a")
    return by_posterior(reading, evidence, in_time=in_time, sought="b")


def by_posterior_of_both_recorders(reading: Reading, *, in_time: bool = False) -> Speeds:
    """Components of both recorders."""
    return by_posterior(reading, of_recorders(reading, "ab"), in_time=in_time)


def by_posterior_left_open(reading: Reading) -> Speeds:
    """Size of both delta-V, and motion after, with what the model leaves out beside the errors."""
    of = of_motion(reading)
    return by_posterior(reading, of._replace(observed=left_open(reading, of.observed)))


def by_fit_left_open(reading: Reading) -> Speeds:
    """The same by weighted least squares."""
    of = of_motion(reading)
    return asked(reconstruct.fit, *of[:2], left_open(reading, of.observed))


def by_fit(reading: Reading, *, in_time: bool = False) -> Speeds:
    """Size of both delta-V, and motion after, by weighted least squares."""
    of = of_motion(reading)
    settings = {"finer": of.finer} if in_time and reading.contact else {}
    return asked(reconstruct.fit, *of[:3], **settings)


ROUTES: dict[str, Callable[[Reading], Speeds]] = {
    "momentum": by_momentum,
    "both recorders, friction known": by_both_recorders,
    "both recorders, stated to have stuck": by_both_recorders_stuck,
    "one recorder and its speed": by_one_recorder,
    "one recorder and its speed, friction=inf": by_one_recorder_alone,
    "posterior of delta-V and motion after": by_posterior_of_motion,
    "posterior of delta-V and motion after, finer=": partial(by_posterior_of_motion, in_time=True),
    "posterior of delta-V and motion after, errors with what is left out": by_posterior_left_open,
    "fit of delta-V and motion after": by_fit,
    "fit of delta-V and motion after, errors with what is left out": by_fit_left_open,
    "fit of delta-V and motion after, finer=": partial(by_fit, in_time=True),
    "posterior of one recorder and its speed": by_posterior_of_one_recorder,
    "posterior of one recorder and its speed, finer=": partial(
        by_posterior_of_one_recorder, in_time=True
    ),
    "posterior of both recorders": by_posterior_of_both_recorders,
    "posterior of both recorders, finer=": partial(by_posterior_of_both_recorders, in_time=True),
}


class Told(NamedTuple):
    """What a route told of one crash."""

    stuck: bool
    rolling: bool
    refused: str  # why, or ""
    warned: tuple[str, ...]  # codes
    # Of each speed, also where samples were lost: width of the range in m/s, and whether the truth
    # lies in it (0), above (1) or below (-1).
    widths: tuple[float, ...] = ()
    sides: tuple[int, ...] = ()

    @property
    def one_sided(self) -> bool:
        """Whether a range has an end that is infinite."""
        return any(math.isinf(width) for width in self.widths)


def told(route: Callable[[Reading], Speeds], reading: Reading) -> Told:
    """Ask one route about one crash."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", col.CollisionsWarning)
        try:
            found, refused = route(reading), ""
        except LostError as lost:
            found, refused = lost.args[0], "lost samples"
        except col.CollisionsError as error:
            found, refused = {}, str(error.code)
    messages = [one.message for one in caught]
    codes = {str(one.code) for one in messages if isinstance(one, col.CollisionsWarning)}
    widths = tuple(high - low for low, high in found.values())
    speed = reading.truth
    sides = tuple(int(speed[x] > high) - int(speed[x] < low) for x, (low, high) in found.items())
    return Told(reading.stuck, reading.rolling, refused, tuple(sorted(codes)), widths, sides)


def tales(
    route: Callable[[Reading], Speeds],
    read: Callable[[], list[Reading]],
    count: int,
    kept: Path | None,
) -> list[Told]:
    """What a route tells of each of so many crashes; of those in the file ``kept`` what it told
    then.
    """
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.is_file() else []
    found = [Told(*json.loads(line)) for line in lines[:count]]
    for reading in read()[len(found) :] if len(found) < count else []:
        found.append(told(route, reading))
        if kept:
            with kept.open("a", encoding="utf-8") as file:
                file.write(json.dumps(found[-1]) + "\n")
    return found


CELLS: dict[str, Callable[[Told], bool]] = {
    "all": lambda one: True,
    "stuck, rolling": lambda one: one.stuck and one.rolling,
    "stuck, braked": lambda one: one.stuck and not one.rolling,
    "slid, rolling": lambda one: not one.stuck and one.rolling,
    "slid, braked": lambda one: not one.stuck and not one.rolling,
}


def binomial(held: int, n: int, coverage: float = COVERAGE) -> tuple[float, float]:
    """Interval of a share by Clopper and Pearson (Biometrika 26, 1934)."""

    def at_most(count: int, share: float) -> float:
        """Probability of so many or fewer."""
        logs = [
            math.lgamma(n + 1)
            - math.lgamma(j + 1)
            - math.lgamma(n - j + 1)
            + j * math.log(share)
            + (n - j) * math.log1p(-share)
            for j in range(count + 1)
        ]
        return math.fsum(math.exp(one) for one in logs)

    def where(count: int, probability: float) -> float:
        low, high = 1e-12, 1.0 - 1e-12
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if at_most(count, middle) > probability else (low, middle)
        return 0.5 * (low + high)

    tail = 0.5 * (1.0 - coverage)
    return (where(held - 1, 1.0 - tail) if held else 0.0), (where(held, tail) if held < n else 1.0)


def counted(tale: list[Told]) -> dict[str, Any]:
    """Of one cell: refusals, warnings, and how often the ranges without either held."""
    refused = [one for one in tale if one.refused]
    warned = [one for one in tale if one.warned and not one.refused]
    silent = [one for one in tale if not one.warned and not one.refused]
    sides = [side for one in silent for side in one.sides]
    widths = [width for one in silent for width in one.widths]
    every = [width for one in tale for width in one.widths]
    held = sides.count(0)
    spoken = {
        name: [side for one in tale if of(one) for side in one.sides]
        for name, of in (
            ("warned", lambda one: one.warned and not one.refused),
            ("lost", lambda one: bool(one.refused)),
            ("any", lambda one: True),
        )
    }
    reasons: dict[str, int] = {}
    for one in tale:
        for code in (one.refused,) if one.refused else one.warned:
            reasons[code] = reasons.get(code, 0) + 1
    return {
        "crashes": len(tale),
        "refused": len(refused),
        "warned": len(warned),
        "one_sided": sum(one.one_sided for one in silent),
        "ranges": len(sides),
        "held": held,
        "interval": binomial(held, len(sides)) if sides else (0.0, 1.0),
        "above": sides.count(1),
        "below": sides.count(-1),
        "width": float(np.median(widths)) if widths else math.nan,
        "any_width": float(np.median(every)) if every else math.nan,
        "spoken": {name: (of.count(0), len(of)) for name, of in spoken.items()},
        "reasons": dict(sorted(reasons.items(), key=lambda pair: -pair[1])),
    }


HEAD = (
    "                   crashes  refused   warned |  silent  held, %  99.8 % interval"
    "   too low  too high  one-sided  width, km/h |  all: ranges  held, %  width"
)


def percent(held: int, n: int) -> str:
    """A share in percent, or a dash where there is none."""
    return f"{100.0 * held / n:.1f}" if n else "-"


def printed(name: str, cells: dict[str, dict[str, Any]]) -> str:
    """One route's rows."""
    lines = ["", name, HEAD]
    for cell, row in cells.items():
        low, high = row["interval"]
        held, n = row["spoken"]["any"]
        shares = percent(row["held"], row["ranges"]), percent(held, n)
        lines.append(
            f"  {cell:15} {row['crashes']:9d}{row['refused']:9d}{row['warned']:9d} |"
            f"{row['ranges']:8d}{shares[0]:>9}{100 * low:10.1f} to {100 * high:5.1f}"
            f"{row['above']:9d}{row['below']:10d}{row['one_sided']:11d}{3.6 * row['width']:13.1f} |"
            f"{n:13d}{shares[1]:>9}{3.6 * row['any_width']:7.1f}"
        )
    parts = [
        f"{percent(*cells['all']['spoken'][which])} % of {cells['all']['spoken'][which][1]} {what}"
        for which, what in (
            ("warned", "ranges with a warning"),
            ("lost", "ranges that left samples out"),
        )
    ]
    lines.append("  held: " + ", ".join(parts))
    if reasons := cells["all"]["reasons"]:
        lines.append("  why: " + ", ".join(f"{code} {count}" for code, count in reasons.items()))
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    as_written = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=as_written)
    parser.add_argument("--crashes", type=int, default=150)
    parser.add_argument("--world", choices=("lasting", "instant", "both"), default="lasting")
    parser.add_argument("--route", action="append", choices=list(ROUTES))
    parser.add_argument("--axes", choices=("turning", "fixed"), default="turning")
    parser.add_argument(
        "--samples", type=int, default=256, help="posterior takes four times as many"
    )
    parser.add_argument("--seed", type=int, default=SEED, help="another draws other crashes")
    parser.add_argument("--keep", type=Path, help="each crash's answer; those there are not asked")
    parser.add_argument("--only-kept", action="store_true", help="the table of what is there")
    parser.add_argument("--json", type=Path, help="routes there that are not asked stay")
    options = parser.parse_args()
    found: dict[str, Any] = {}
    for world in ("lasting", "instant") if options.world == "both" else (options.world,):

        @cache
        def read(instant: bool = world == "instant") -> list[Reading]:
            if options.only_kept:
                return []
            drawn = population(options.crashes, options.seed, instant=instant)
            settings: dict[str, Any] = {"samples": options.samples, "axes": options.axes}
            return list(readings(drawn, options.seed, **settings))

        if world == "instant":
            print("\nContacts of 2 ms without tyres, and whether they stuck or slid")
        for name in options.route or ROUTES:
            kept = None
            if options.keep:
                options.keep.mkdir(exist_ok=True)
                settings = f"{options.seed} {options.samples} {options.axes}"
                kept = options.keep / f"{world} {name} {settings}.jsonl"
            tale = tales(ROUTES[name], read, options.crashes, kept)
            if not tale:
                continue
            cells = {cell: counted([one for one in tale if of(one)]) for cell, of in CELLS.items()}
            found.setdefault(world, {})[name] = cells
            print(printed(name, cells), flush=True)
    if options.world == "both" and "instant" in found:
        print("\nWidth in the lasting world over that in the instant one")
        for name, cells in found["lasting"].items():
            if name not in found["instant"]:
                continue
            print(f"  {name}: {cells['all']['width'] / found['instant'][name]['all']['width']:.2f}")
    if options.json:
        if options.json.is_file():
            before = json.loads(options.json.read_text(encoding="utf-8"))
            found = {world: before.get(world, {}) | new for world, new in found.items()}
            found = before | found
        text = json.dumps(_strict(found), indent=1, allow_nan=False)
        options.json.write_text(text + "\n", encoding="utf-8")


def _strict(found: Any) -> Any:
    """The same with None for a width that is infinite or that there is not."""
    if isinstance(found, dict):
        return {name: _strict(value) for name, value in found.items()}
    return None if isinstance(found, float) and not math.isfinite(found) else found


if __name__ == "__main__":
    main()
