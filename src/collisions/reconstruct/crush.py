"""What damage says, by the CRASH programs: the energy of a crush profile, how two vehicles share
it, and delta-V from it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from ..impact.run import error_of, warn_of_refusals
from ..impact.time_resolved_inputs import WIDEST_DAMAGE, warn_if_soft
from ..kernels.elementwise import POSITIVE, UNIT_INTERVAL
from ..kernels.status import Status
from ..messages.errors import OutOfRangeWarning, ShapeError
from ..messages.hints import hinted
from ..messages.warning import warn
from ..quantities.directions import Angle
from ..quantities.reading import ArgumentReader, amount, warn_if_large
from ..quantities.refusals import must_be
from ..quantities.sourced import Sourced, as_given
from ..quantities.units import Input, Value, has_unit, is_quantity, shown
from .common import ASK_ALONE, Cases, input_faults, read_masses

_RIGHT_ANGLE = 2.0**-52  # the cosine of 90 degrees in radians is not exactly 0
# In metres: no car is crushed so deep.
_DEEPEST = 2.0
_MOST_OBLIQUE = math.radians(
    45.0
)  # where the correction reaches 2, as far as the CRASH programs take it


@hinted
def crush_energy(
    widths: Input | Sequence[Input],
    depths: Input | Sequence[Input],
    stiffness_a: Input,
    stiffness_b: Input,
    *,
    force_angle: Input = 0.0,
    name: str = "",
) -> Value:
    """Energy absorbed by the crush of one vehicle.

    The force per unit width at a depth C is taken as A + B C, A being what the structure bears
    before it yields, so each unit of width absorbs A C + B C^2 / 2 + A^2 / (2 B). Between two
    measured depths the profile is taken as straight, which integrates exactly to the trapezoid rule
    of the CRASH programs for any number of points. If the force is at an angle, the energy is
    divided by the square of the cosine, so that the work of the whole force is counted.

    A list, a tuple, a numpy array or a Quantity of one dimension is the profile of one case. For
    many cases give lists whose entries are arrays, one entry for each point or gap, with one
    element for each case; the other arguments may be arrays too.

    Parameters
    ----------
    widths : float, str, Quantity, or a profile [m]
        Width of the damage, divided evenly between the depths, or the width of each gap, one fewer
        than the depths; >= 0.
    depths : a profile [m]
        Depth of crush at two or more points from one end of the damage to the other, >= 0.
    stiffness_a : float, str, Quantity or array [N/m]
        Force per width at which crush begins, >= 0.
    stiffness_b : float, str, Quantity or array [N/m**2]
        Increase of the force per width with depth, > 0. Both coefficients are specific to the
        vehicle, the side struck and the speed of the tests they were fitted to: none are supplied
        here.
    force_angle : angle [rad], optional
        Angle between the direction of force and the perpendicular to the damaged side.
    name : str, optional
        What was damaged, such as "front of the Accord", for the page of a report.

    Returns
    -------
    float or array [J]
        Energy that the coefficients stand for. If they were fitted to the impact speeds of barrier
        tests, as is usual, it is the energy absorbed at maximum crush: that of
        ``max_crush_speed_a``. If rebound was deducted in the fit, it is the energy dissipated: that
        of ``ees_a`` by ISO 12353 and of ``energy_loss``. NaN for a refused case of a batch. A
        single number also has in ``source`` what it was worked out from, and so has the sum of two.
        Given to ``posterior`` as what was observed, its report says so.

    Raises
    ------
    InputError
        A negative depth or width, a stiffness outside its range, an angle of 90 degrees or more.

    Warns
    -----
    OutOfRangeWarning
        The angle is beyond 45 degrees, where the correction exceeds 2 and the model is not used.
    SuspectUnitsWarning
        A depth above 2 m, a total width above 10 m, an A above 0 and below 1 kN/m or a B below 10
        kN/m**2, given without a unit: no car comes near, but a US table prints 250 for 250 lbf/in.

    Examples
    --------
    Even crush of 0.3 m over 1.5 m: 1.5 (A 0.3 + B 0.3^2 / 2 + A^2 / (2 B)).

    >>> from collisions import reconstruct
    >>> energy = reconstruct.crush_energy("1.5 m", [0.3, 0.3, 0.3], "40 kN/m", "600 kN/m**2")
    >>> round(energy)
    60500
    >>> energy.source
    'by crush_energy: width 1.5 m, depths 0.3 m, 0.3 m, 0.3 m, A 40 kN/m, B 600 kN/m**2'
    """
    reader = ArgumentReader()
    if not isinstance(name, str):
        text = "a text, such as `'front of the Accord'`"
        reader.refuse(must_be("name", text, name, code="bad_type"))
    crush, whole, gaps = _profiles(reader, depths, widths)
    a = amount(reader, stiffness_a, "N/m", "stiffness_a")
    b = reader.number(stiffness_b, "N/m**2", "stiffness_b")
    if isinstance(b, float) and b <= 0.0:
        reader.refuse(must_be("stiffness_b", "> 0", stiffness_b, code="not_positive"))
    angle = Angle(*reader.angle(force_angle, "force_angle"))
    cosine = angle.direction[0]
    if isinstance(cosine, float) and cosine <= _RIGHT_ANGLE:
        reader.refuse(
            must_be(
                "force_angle",
                "less than 90 deg from the perpendicular of the damaged side",
                force_angle,
                code="bad_angle",
            )
        )
    reader.close()
    stated = {
        "widths": (widths, whole),
        "depths": (depths, crush),
        "stiffness_a": (stiffness_a, a),
        "stiffness_b": (stiffness_b, b),
        "force_angle": (force_angle, angle.value),
    }
    amounts = {f"depths[{i}]": depth for i, depth in enumerate(crush)} | {
        f"widths[{i}]": gap for i, gap in enumerate(gaps)
    }
    amounts["stiffness_a"] = a
    numbers = amounts | {"stiffness_b": b, "force_angle": angle.value}
    cases = Cases.of(numbers)
    _warn_if_large(depths, crush, _DEEPEST, "depths", np.fmax)
    width = whole if isinstance(whole, list) else [whole]
    _warn_if_large(widths, width, WIDEST_DAMAGE, "widths", np.add)
    warn_if_soft((stiffness_a, stiffness_b), (a, b), ("stiffness_a", "stiffness_b"))
    cosine = angle.beside((*amounts.values(), b)).direction[0]
    oblique = np.less(cosine, math.cos(_MOST_OBLIQUE) * (1.0 - 1e-12)) & np.greater(
        cosine, _RIGHT_ANGLE
    )
    if np.any(oblique):
        warn(
            OutOfRangeWarning(
                f"force_angle = {shown(force_angle)} is more than 45 deg, where the correction "
                "exceeds 2: outside what the crush model is used for",
                code="force_angle",
            ),
            cases.each(oblique),
            "force_angle is more than 45 deg, where the correction exceeds 2: outside what the "
            "crush model is used for",
        )
    with np.errstate(all="ignore"):
        widths, depths, (a, b) = (
            [np.asarray(x, dtype=np.float64) for x in values] for values in (gaps, crush, (a, b))
        )
        energy = sum(
            _gap_energy(*parts, a, b) for parts in zip(widths, depths, depths[1:], strict=False)
        ) / (cosine * cosine)
        faults = [
            *input_faults(numbers),
            *((np.less(value, 0.0), Status.CONTRADICTORY) for value in amounts.values()),
        ]
        faults += [
            (np.less_equal(b, 0.0), Status.NOT_POSITIVE),
            (np.less_equal(cosine, _RIGHT_ANGLE), Status.CONTRADICTORY),
        ]
    found = _answers(cases, faults, energy)[0]
    if isinstance(found, float):
        found = cast("Value", Sourced(found, _source(name, stated)))
    return found


@hinted
def crush_share(stiffness_a: Input, stiffness_b: Input) -> Value:
    """Share of the crush energy that A absorbs, from the stiffness of both: ``stiffness_b /
    (stiffness_a + stiffness_b)``.

    The same force acts on both, so of two linear springs the softer absorbs more: energy is
    inversely proportional to stiffness. The same holds for the force A + B C of ``crush_energy``,
    its energy A^2 / (2 B) included, where each side is crushed evenly; the stiffness is then B
    times the width. It is the share for ``Impact.ees`` and ``Impact.max_crush_speeds``. Where only
    the damage to A is known, with the energy E_A, that to B took E_A (1 - share) / share.

    Parameters
    ----------
    stiffness_a, stiffness_b : float, str, Quantity or array [N/m]
        Force over crush of each vehicle at the damage, > 0; ``inf`` for a rigid one.

    Returns
    -------
    float or array
        From 0 to 1; NaN for a refused case of a batch.

    Raises
    ------
    InputError
        A stiffness that is not positive.
    NoSolutionError
        Both are infinite: nothing can yield.

    Notes
    -----
    Two springs in series under one force are the model of the damage analysis in the CRASH programs
    (EDCRASH manual, chapter 4, collinear impact). Real fronts are not linear, and stiffness differs
    from car to car within a class: state a range.

    Examples
    --------
    A front of 900 kN/m against a side of 500 kN/m: the front takes 36 % of the energy.

    >>> import collisions as col
    >>> from collisions import reconstruct
    >>> share = reconstruct.crush_share("900 kN/m", "500 kN/m")
    >>> impact = col.linear_central(
    ...     col.Vehicle(mass=1500, vx="50 km/h"), col.Vehicle(mass=1200), 0.1
    ... )
    >>> round(share, 3), [round(3.6 * ees, 1) for ees in impact.ees(share)]
    (0.357, [19.8, 29.7])
    """
    reader = ArgumentReader()
    given = {"stiffness_a": stiffness_a, "stiffness_b": stiffness_b}
    numbers = {name: reader.number(value, "N/m", name, POSITIVE) for name, value in given.items()}
    reader.close()
    cases = Cases.of(numbers)
    a, b = (np.asarray(value, dtype=np.float64) for value in numbers.values())
    with np.errstate(all="ignore"):
        faults: list[tuple[Any, int]] = [
            (fault(value), status) for value in (a, b) for fault, status in POSITIVE.faults
        ]
        faults.append((np.isinf(a) & np.isinf(b), Status.IMMOVABLE))
        # Not the sum, which might overflow.
        return _answers(cases, faults, 1.0 / (1.0 + a / b))[0]


@hinted
def crush_delta_v(
    energy: Input, mass_a: Input, mass_b: Input, *, gamma_a: Input = 1.0, gamma_b: Input = 1.0
) -> tuple[Value, Value]:
    """Delta-V of both vehicles from the crush energy of both together, as in the CRASH programs.

    The impulse keeps one direction and passes each centre of mass at a moment arm. On its line a
    vehicle responds like the mass gamma m, and at maximum crush both move alike there::

        delta_v_a = sqrt(2 energy gamma_a / (mass_a (1 + gamma_a mass_a / (gamma_b mass_b))))

    Parameters
    ----------
    energy : float, str, Quantity or array [J]
        Energy of both vehicles, >= 0: the sum of their ``crush_energy``.
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0; ``inf`` for one that keeps its velocity, such as a wall.
    gamma_a, gamma_b : float, str, Quantity or array [-]
        Mass reduction factors k^2 / (k^2 + h^2), with the radius of gyration k and the moment arm h
        of the impulse, as ``gamma`` of each side of an ``Impact``. 1 where the impulse passes
        through the centre of mass.

    Returns
    -------
    tuple of float or array [m/s]
        Of A and of B, up to the common velocity; with restitution e they are 1 + e times as large.
        NaN for a refused case.

    Raises
    ------
    InputError
        An argument that cannot be used.
    NoSolutionError
        Both masses are infinite: nothing can yield.

    Notes
    -----
    CRASH3 technical manual; EDCRASH manual, chapter 4. The method leaves out the speed at which the
    vehicles slid past each other and any change in the direction of the force.
    ``reconstruct.speeds`` does not, with ``max_crush_speed_a`` and ``max_crush_speed_b``, each
    sqrt(2 energy / mass) by the energy of that vehicle at maximum crush. Its ``energy_loss`` is
    what remains of the energy of both after restitution e: (1 - e^2) energy where nothing slides.
    Where they slide, friction takes energy too: give the crush energy to ``posterior`` as a reading
    of ``energy_absorbed``, or of that and ``energy_loss_tangential`` together if the energy counts
    the work of the whole force.

    Examples
    --------
    EDCRASH manual, tutorial "Visibility Study", where 60.7 and 59.4 km/h are printed:

    >>> from collisions import reconstruct
    >>> found = reconstruct.crush_delta_v(
    ...     262905.65 + 140864.15, 1124.04, 1149.52, gamma_a=0.8045, gamma_b=0.7637
    ... )
    >>> [round(3.6 * delta_v, 1) for delta_v in found]
    [60.7, 59.4]
    """
    reader = ArgumentReader()
    numbers = {"energy": amount(reader, energy, "J", "energy")}
    numbers |= read_masses(reader, mass_a, mass_b)
    for name, value in (("gamma_a", gamma_a), ("gamma_b", gamma_b)):
        numbers[name] = reader.number(value, "", name, UNIT_INTERVAL)
    reader.close()
    cases = Cases.of(numbers)
    work, *masses, one, two = (np.asarray(value, dtype=np.float64) for value in numbers.values())
    with np.errstate(all="ignore"):
        faults = [
            *input_faults(numbers),
            (np.isinf(masses[0]) & np.isinf(masses[1]), Status.IMMOVABLE),
        ]
        faults += [
            (fault(value), status) for value in (one, two) for fault, status in UNIT_INTERVAL.faults
        ]
        ratio = one / two * (masses[0] / masses[1])
        squares = (
            work / masses[0] * (one / (1.0 + ratio)),
            work / masses[1] * (two / (1.0 + 1.0 / ratio)),
        )
        # Neither moves if the impulse passes one of them infinitely far away.
        found = [
            np.where((one == 0.0) | (two == 0.0), 0.0, np.sqrt(2.0 * square)) for square in squares
        ]
    of_a, of_b = _answers(cases, faults, *found)
    return of_a, of_b


def _source(name: str, pairs: Mapping[str, tuple[Any, Any]]) -> str:
    """What an energy was worked out from: each argument as it was given, beside its number."""

    def listed(argument: str) -> str:
        given, numbers = pairs[argument]
        if not isinstance(numbers, list):
            return as_given(given, numbers, "m")
        return ", ".join(as_given(*pair, "m") for pair in zip(given, numbers, strict=True))

    several = isinstance(pairs["widths"][1], list)
    parts = [
        f"width{'s' if several else ''} {listed('widths')}",
        f"depths {listed('depths')}",
        f"A {as_given(*pairs['stiffness_a'], 'N/m')}",
        f"B {as_given(*pairs['stiffness_b'], 'N/m**2')}",
    ]
    if pairs["force_angle"][1] != 0.0:
        parts.append(f"force at {as_given(*pairs['force_angle'], 'rad')}")
    of = f"{name.strip()}, " if name.strip() else ""
    return f"{of}by crush_energy: {', '.join(parts)}"


def _answers(cases: Cases, faults: list[tuple[Any, int]], *found: Any) -> list[Value]:
    """The answers of these cases; NaN where a batch has a fault, an error for a single case."""
    beyond = [(cases.beyond(answer), Status.OUT_OF_RANGE) for answer in found]
    status = cases.first_status((*faults, *beyond))
    if cases.shape is None and status != Status.OK:
        # The reader has checked the rest.
        text = {Status.IMMOVABLE: "both are infinite; at least one must be finite"}.get(
            status,
            "the answer is not a finite number: the arguments are too large or too small for "
            "floats",
        )
        raise error_of(status, text)
    if cases.shape is not None and np.any(status > Status.ENERGY_GAIN):
        warn_of_refusals(status, ASK_ALONE)
    return [cases.where(np.equal(status, Status.OK), answer) for answer in found]


def _warn_if_large(
    given: Any, read: Sequence[Any], limit: float, name: str, of_all: np.ufunc
) -> None:
    """One warning for a profile given without a unit, if its largest value or its sum
    is too large, of the cases in which it is.
    """
    parts = given if isinstance(given, (list, tuple)) else [given] * len(read)
    bare = [abs(number) for part, number in zip(parts, read, strict=True) if not has_unit(part)]
    if bare:
        each = np.stack(np.broadcast_arrays(*bare))
        suspected = np.where(of_all.reduce(each) > limit, np.fmax.reduce(each), 0.0)
        warn_if_large(None, suspected, 0.0, name, "metres", "cm", "in")


def _profiles(reader: ArgumentReader, depths: Any, widths: Any) -> tuple[list[Any], Any, list[Any]]:
    """The depths, the widths as they were given, and the width of each gap."""
    crush = _profile(reader, depths, "depths")
    if isinstance(depths, np.ndarray) or is_quantity(depths):
        reader.close()
    if not isinstance(crush, list) or len(crush) < 2:
        got = type(depths).__name__ + (f" of {len(crush)}" if isinstance(crush, list) else "")
        raise ShapeError(
            f"depths must be a list or an array of at least two depths, got {got}; write [0.2, "
            "0.35, 0.1]",
            code="bad_shape",
            argument="depths",
        )
    whole = gaps = _profile(reader, widths, "widths")
    if not isinstance(gaps, list):
        gaps = [whole / (len(crush) - 1)] * (len(crush) - 1)
    elif len(gaps) != len(crush) - 1:
        raise ShapeError(
            f"widths has {len(gaps)} values and depths {len(crush)}: give one width between each "
            f"two depths, {len(crush) - 1} in all, or the whole width; for many cases, a list "
            "with one array per gap",
            code="bad_shape",
            argument="widths",
        )
    return crush, whole, gaps


def _profile(reader: ArgumentReader, value: Any, name: str) -> Any:
    """A list of one number for each point or gap, each with an array if it is of many cases; or a
    single number.
    """
    if not isinstance(value, (list, tuple)):
        read = amount(reader, value, "m", name)
        if not isinstance(read, np.ndarray):
            return read
        if read.ndim > 1:
            raise ShapeError(
                f"{name} is an array of shape {read.shape}; one profile is an array of one "
                f"dimension, and many cases are a list of arrays, such as list({name}.T) if each "
                "row is a case",
                code="bad_shape",
                argument=name,
            )
        value = read.tolist()
    return [amount(reader, part, "m", f"{name}[{i}]") for i, part in enumerate(value)]


def _gap_energy(width: Any, one: Any, two: Any, a: Any, b: Any) -> Any:
    """Energy of one gap: the integral of A C + B C^2 / 2 + A^2 / (2 B) over a depth that changes
    evenly.
    """
    return width * (
        a * (one + two) / 2.0 + b * (one * one + one * two + two * two) / 6.0 + a * a / (2.0 * b)
    )
