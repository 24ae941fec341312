"""Impact: the answer of every forward solver."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import fields, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

import numpy as np

from ..kernels.contact_laws import BRACH, FRICTION, LAWS, RULES
from ..kernels.elementwise import UNIT_INTERVAL, select
from ..kernels.status import Passed
from ..messages.errors import InputError, NoSolutionError, Status
from ..messages.warning import quietly
from ..quantities.attribute_stubs import ImpactQuantities
from ..quantities.attributes import (
    Frozen,
    Quantities,
    attributes,
    derived,
    equal,
    format_value,
    hypot,
    in_units_of,
    math_or_numpy,
    read_only,
    returns,
    unit_of,
)
from ..quantities.directions import angle_of
from ..quantities.reading import ArgumentReader, broadcast, widened
from ..quantities.settings import in_si
from ..quantities.tables import (
    Cells,
    Part,
    Summarized,
    Summary,
    all_numbers,
    as_sentence,
    label_of,
    outcomes,
)
from ..quantities.units import Input, Value
from ..vehicle.vehicle import Vehicle
from .inputs import (
    ARGUMENTS,
    STIFFNESSES,
    Inputs,
    Law,
    ModelName,
    OnFailure,
    index_of,
    part_of_inputs,
)
from .models import model_of, read_again
from .run import solve_inputs
from .time_resolved_inputs import residual_crushes
from .vehicle_result import SIGNS, VehicleResult, beside, title_of

# Labels as type checkers see them, so that they refuse a comparison with one that is misspelt; a
# refused case has none.
Kind: TypeAlias = Literal["elastic", "elastoplastic", "plastic", "incomplete", ""]
Regime: TypeAlias = Literal["frictionless", "sliding", "sticking", "reversing", "given", ""]

if TYPE_CHECKING:  # loaded by those who make them: a tenth of the import
    from .choice import ModelChoice
    from .pulse import Parted, Pulse
    from .reconstruction import Reconstruction

_new = object.__new__


class _SpeedsBefore:
    """What every answer of a reverse solver has, whatever else it has. A record has these numbers
    under other names.
    """

    __slots__ = ()

    @derived("m/s")
    def speed_a(self: Any) -> Value:
        """Speed of A before the impact [m/s], of its centre of mass; as ``a.before.speed``."""
        speed: Value = self.a.before.speed
        return speed

    @derived("m/s")
    def speed_b(self: Any) -> Value:
        """Speed of B before the impact [m/s], of its centre of mass; as ``b.before.speed``."""
        speed: Value = self.b.before.speed
        return speed

    @derived()
    def found(self: Any) -> tuple[str, ...]:
        """Names of what a reverse solver found, as opposed to what it was given: "speed_a",
        "restitution" and so on; empty for a forward solver. A mass that is infinite has no motion
        to be found.
        """
        origin = self.reconstruction
        if origin is None:
            return ()
        masses = (("_a", self.inputs.a.mass), ("_b", self.inputs.b.mass))
        still = [ending for ending, mass in masses if np.all(np.isinf(mass))]
        return tuple(name for name in origin.found if name[-2:] not in still)


class Impact(_SpeedsBefore, Frozen, Summarized):
    """The answer of a forward solver: two vehicles before and after, the impulse between them, and
    where the energy went.

    It is made by the solvers, never by hand, and is frozen. Its attributes are floats, or arrays in
    a batch, all in SI; the same attributes of ``.q`` are Quantities. The impulse P acts on B and -P
    on A; n points from A into B, and t is n turned by +90 degrees.

    In a refused case every answer is NaN, every label is empty, and ``status`` says why. Only the
    inputs stay as they were given: ``restitution``, ``friction``, ``normal``, ``normal_angle`` and
    ``point``; for the vehicles mass, yaw inertia, position, heading and pivot, and for a forward
    solver all of ``before``. With ``solve`` the tolerance stays too, and the model is the one that
    would have answered. Whatever a reverse solver was to find, such as the velocities before the
    impact or a restitution that was not given, counts as an answer.
    """

    inputs: Inputs
    """The inputs: the vehicles, restitution, normal, point, tangential rule and its value, and how
    each was given.
    """

    _answer: Any
    _elsewhere = MappingProxyType(
        {
            VehicleResult: "impact.a.{0} or impact.b.{0}",
            Vehicle: "impact.a.after.{0} (or .before, or impact.b)",
        }
    )

    def __init__(self) -> None:
        raise TypeError(
            "an Impact is made by linear_central, oblique_central, eccentric, or Impact.from_dict"
        )

    @property
    def q(self) -> ImpactQuantities:
        """The same attributes as pint Quantities."""
        return cast(ImpactQuantities, Quantities(self))

    @derived()
    def a(self) -> VehicleResult:
        """Vehicle A and what changed for it."""
        return VehicleResult(self.inputs, self._answer, 0, vars(self).get("choice"))

    @derived()
    def b(self) -> VehicleResult:
        """Vehicle B and what changed for it."""
        return VehicleResult(self.inputs, self._answer, 1, vars(self).get("choice"))

    @derived()
    def model(self) -> ModelName:
        """Name of the solver used: with ``solve`` the one it chose, in a batch an array
        of names.
        """
        return cast(ModelName, self.inputs.model if self.choice is None else self.choice.model)

    @derived()
    def law(self) -> Law | None:
        """Name of the law of restitution and slip; None for a model without one, with ``solve`` as
        given.
        """
        return cast("Law | None", self.inputs.law)

    @derived("")
    def restitution(self) -> Value:
        """Coefficient of restitution e."""
        return self.inputs.restitution

    @derived("")
    def friction(self) -> Value | None:
        """Coulomb friction bound as used, with ``solve`` as given; None if a ratio or a critical
        fraction was given.
        """
        return self.inputs.rule_value if self.inputs.rule == FRICTION else None

    @derived("m")
    def point(self) -> tuple[Value, Value] | None:
        """Contact point (x, y) [m]; None for the central models, with ``solve`` as given."""
        return self.inputs.point

    @derived()
    def choice(self) -> ModelChoice | None:
        """How ``solve`` chose the model; None if the solver was called by name."""
        return None

    @derived()
    def reconstruction(self) -> Reconstruction | None:
        """Which reverse solver found this impact, from what, and how well-posed the problem was;
        None for a forward solver.
        """
        return None

    @derived("")
    def normal(self) -> tuple[Value, Value]:
        """Unit vector (nx, ny) from A into B; it can be passed on as ``normal=``."""
        return self.inputs.normal

    @derived("rad")
    def normal_angle(self) -> Value:
        """Scene angle of the normal [rad], in (-pi, pi]."""
        return angle_of(*self.normal)

    @derived("m/s")
    def closing_speed(self) -> Value:
        """Speed at which the contact points approach along the normal [m/s]."""
        return self._output("closing_speed")

    @derived("m/s")
    def relative_speed(self) -> Value:
        """Magnitude of the relative velocity of the centres of mass before contact [m/s], not the
        closing speed.
        """
        a, b = self.a.before, self.b.before
        vx_a, vy_a, vx_b, vy_b = widened((a.vx, a.vy, b.vx, b.vy), (self.closing_speed,))
        return self._answered(hypot(vx_a - vx_b, vy_a - vy_b))

    @derived("m/s")
    def separation_speed(self) -> Value:
        """Speed at which the contact points part along the normal [m/s]: e times the closing speed
        (eq 11).

        Under the law "stronge" it follows from the energy that is given back, and is e times the
        closing speed where the slip continues to the end. It is below 0 after an incomplete impact,
        whose contact points still approach. For a time-resolved impact it is the speed that came
        about.
        """
        by_ratio = self.restitution * self.closing_speed
        if not self._parts_by_law:
            return by_ratio
        found: Value = select(
            self.model == "linear_central", by_ratio, self._output("separation_speed")
        )
        return found

    @derived("m/s")
    def slip_before(self) -> Value:
        """Tangential velocity of B relative to A at the contact before the impact [m/s]."""
        return self._output("slip_before")

    @derived("m/s")
    def slip_after(self) -> Value:
        """Tangential velocity of B relative to A at the contact after the impact [m/s]."""
        return self._output("slip_after")

    @derived("N*s")
    def normal_impulse(self) -> Value:
        """Component of the impulse on B along the normal [N*s], >= 0."""
        return self._output("normal_impulse")

    @derived("N*s")
    def tangential_impulse(self) -> Value:
        """Component of the impulse on B along the tangent [N*s]."""
        return self._output("tangential_impulse")

    @derived("N*s")
    def compression_impulse(self) -> Value:
        """Normal impulse of the compression period [N*s], the integral of P in eq 10; all of it in
        an incomplete impact.
        """
        if self._passed is None and (self._parts_by_law or self.inputs.incomplete):
            found = self._until_compressed("normal_impulse")
            value: Value = found
            return value
        return self._output("compression_impulse")

    @derived("N*s")
    def restitution_impulse(self) -> Value:
        """Normal impulse of the restitution period [N*s], the integral of R in eq 10; 0 in an
        incomplete impact.
        """
        if self._passed is not None or self._parts_by_law or self.inputs.incomplete:
            return self.normal_impulse - self.compression_impulse
        return self.restitution * self.compression_impulse

    @derived("")
    def impulse_ratio(self) -> Value:
        """Ratio of tangential to normal impulse, signed."""
        return _divided(self.tangential_impulse, self.normal_impulse)

    @derived("")
    def critical_impulse_ratio(self) -> Value:
        """Signed impulse ratio that just stops the slip under the law used; infinite where stopping
        it would need a pull.

        It is not defined (NaN) for a contact with one degree of freedom, such as two parallel arms,
        or a gate against a wall; nor for one that was followed in time.
        """
        normal, tangential = self._answer.no_slip_normal, self._answer.no_slip_tangential
        # 0 times the normal impulse keeps the NaN of a refused case.
        with np.errstate(invalid="ignore"):
            without_end = math_or_numpy(tangential).copysign(math.inf, tangential) + 0.0 * normal
        ratio: Value = select(normal > 0.0, _divided(tangential, normal), without_end)
        return ratio

    @derived("m/s")
    def common_velocity(self) -> Value:
        """Velocity along the normal that both contact points share at the end of compression [m/s]
        (v_c of eq 3).

        For a central model it is that of the centres of mass, as for ``closing_speed``. NaN for an
        incomplete impact.
        """
        if self.inputs.model == "time_resolved":
            return self._output("common_velocity")
        nx, ny = self.normal
        found = []
        for side in (self.a, self.b):
            ux, uy, dux, duy = side._at_contact(side._until_compressed())
            found.append((nx * ux + ny * uy, nx * dux + ny * duy))
        # From the body whose velocity changes less, which is exact for a barrier.
        (base_a, change_a), (base_b, change_b) = found
        common: Value = select(abs(change_a) < abs(change_b), base_a + change_a, base_b + change_b)
        if self._passed is not None:
            common = select(self._followed, self._passed.common_velocity, common)
        return (
            select(self.restitution < 0.0, math.nan, common) if self.inputs.incomplete else common
        )

    @derived("kg")
    def effective_mass(self) -> Value:
        """Mass that the contact feels along the normal [kg], 1/K_nn; the reduced mass of a central
        impact.
        """
        return self._output("effective_mass")

    @derived("J")
    def energy_loss(self) -> Value:
        """Energy dissipated [J] (eq 7, evaluated at the contact). It is negative for a gain, which
        is warned of.
        """
        return self._output("energy_loss")

    @derived("J")
    def energy_loss_normal(self) -> Value:
        """Energy dissipated along the normal [J] (eq 8)."""
        return self._output("energy_loss_normal")

    @derived("J")
    def energy_loss_tangential(self) -> Value:
        """Energy dissipated by the tangential impulse [J]."""
        return self._output("energy_loss_tangential")

    @derived("J")
    def energy_absorbed(self) -> Value:
        """Energy absorbed along the normal by the end of compression [J], part of which restitution
        gives back.

        In an incomplete impact it is the energy absorbed until the contact ends, which is the
        energy lost along the normal.
        """
        if self._passed is not None:
            found = self._output("energy_absorbed")
        elif self._parts_by_law:
            found = self._until_compressed("energy_loss_normal")
        else:
            found = 0.5 * (self.closing_speed * self.compression_impulse)
        absorbed: Value = found
        return (
            select(self.restitution < 0.0, self.energy_loss_normal, absorbed)
            if self.inputs.incomplete
            else absorbed
        )

    @returns("m/s")
    def ees(self, share_a: Input) -> tuple[Value, Value]:
        """Energy equivalent speeds (A, B) [m/s] by ISO 12353, if A dissipated this share of
        ``energy_loss`` and B the rest.

        The EES is the speed at which the vehicle alone would dissipate as much energy against a
        fixed rigid object. It counts the energy that remains dissipated after restitution, so that
        the sum of m EES^2 / 2 is ``energy_loss``. There is no default share, because momentum does
        not tell how the energy was divided. For an infinite mass the EES is 0; where energy was
        gained, it is NaN. Its counterpart ``max_crush_speeds`` is for the energy at maximum crush,
        which is more.

        Parameters
        ----------
        share_a : float, str, Quantity or array [-]
            A's share of the energy, from 0 to 1; B has the rest.

        Returns
        -------
        tuple of two floats or arrays [m/s]
            Of A and of B.

        Examples
        --------
        >>> import collisions as col
        >>> impact = col.linear_central(
        ...     col.Vehicle(mass=1000.0, vx=20.0), col.Vehicle(mass=1000.0), 0.6
        ... )
        >>> impact.ees(0.5), impact.max_crush_speeds(0.5)
        ((8.0, 8.0), (10.0, 10.0))
        """
        # A loss of 0 may be off by rounding.
        return self._shared(
            share_a,
            select(self.ok, select(self.energy_loss > 0.0, self.energy_loss, 0.0), math.nan),
        )

    @returns("m/s")
    def max_crush_speeds(self, share_a: Input) -> tuple[Value, Value]:
        """Speeds (A, B) [m/s] of maximum crush, if A absorbed this share of ``energy_absorbed`` and
        B the rest.

        Each is the speed at which the vehicle alone would absorb as much energy at maximum crush
        against a rigid wall, before restitution gives part of it back. Some authors call this speed
        EES; by ISO 12353 the EES is ``ees``. It is NaN where ``energy_absorbed`` is below 0, which
        impulses from outside far above that of the contact can bring about.

        Parameters
        ----------
        share_a : float, str, Quantity or array [-]
            A's share of the energy, from 0 to 1; B has the rest.

        Returns
        -------
        tuple of two floats or arrays [m/s]
            Of A and of B.
        """
        return self._shared(
            share_a, select(self.energy_absorbed >= 0.0, self.energy_absorbed, math.nan)
        )

    def _shared(self, share_a: Input, energy: Value) -> tuple[Value, Value]:
        """The speeds of both vehicles at which each has its share of an energy."""
        reader = ArgumentReader()
        share = reader.number(share_a, "", "share_a", UNIT_INTERVAL)
        if isinstance(share, np.ndarray) and UNIT_INTERVAL.faults[0][0](share).any():
            reader.refuse(
                InputError(
                    "share_a must be from 0 to 1 in every case",
                    code="bad_fraction",
                    argument="share_a",
                )
            )
        reader.close()
        broadcast({"share_a": share, "energy": energy})
        xp = math_or_numpy(energy, share)
        with np.errstate(all="ignore"):
            return (
                xp.sqrt(2.0 * share * (energy / self.a.before.mass)),
                xp.sqrt(2.0 * (1.0 - share) * (energy / self.b.before.mass)),
            )

    @derived("N*s")
    def momentum_residual(self) -> Value:
        """Residual of the momentum balance of the free bodies of finite mass [N*s], which is
        rounding.

        The balance is between their delta-Vs and the impulses on them from the contact, from
        outside and, in a time-resolved impact, from the tyres.
        """
        left_x: Any = 0.0
        left_y: Any = 0.0
        for side in (self.a, self.b):
            mass = side.before.mass
            if side.before.pivot is None:
                free = math_or_numpy(mass).isfinite(mass)
                weight = select(free, mass, 0.0)
                others_x, others_y = (
                    side.tyre_impulse_x + side.outside_x,
                    side.tyre_impulse_y + side.outside_y,
                )
                left_x = (
                    left_x + weight * side.delta_vx - select(free, side.impulse_x + others_x, 0.0)
                )
                left_y = (
                    left_y + weight * side.delta_vy - select(free, side.impulse_y + others_y, 0.0)
                )
        return self._answered(hypot(left_x, left_y))

    @derived()
    def kind(self) -> Kind:
        """One of "elastic" (e = 1), "elastoplastic", "plastic" (e = 0), "incomplete" (e < 0); an
        array of them in a batch.
        """
        e = np.asarray(self._answered(self.restitution))
        kinds = {
            "elastic": e == 1.0,
            "plastic": e == 0.0,
            "incomplete": e < 0.0,
            "elastoplastic": e > 0.0,
        }
        return cast(Kind, _labels(np.select(list(kinds.values()), list(kinds), "")))

    @property
    def statements(self) -> tuple[str, ...]:
        """What has to be said beside the numbers: of an impact that was found backwards as an
        instant, how much of delta-V that leaves out, as ``left_out`` estimates it, or without the
        tyres of one vehicle, how much these would change; of one that was found with tyres or from
        readings of recorders, that there may be others, and how much the motion during the contact
        is; of speeds, that one is backwards, that the courses are near one line, that the contact
        was taken to stick and may have slid, and of those forwards alone, that others were left
        out; of one that was found from motions after in which the contact points still approach a
        little, that these were changed.
        """
        from .doubts import doubts
        from .instant import found_backwards, neglected
        from .tyres_stop import estimates

        with in_si():
            found = neglected(self)
            said = () if found is None else (found.sentence,)
            return *said, *doubts(self), *found_backwards(self), *estimates(self)

    @derived()
    def complete(self) -> Any:
        """Whether the contact points reached a common velocity, as they do in every answered impact
        with e >= 0.
        """
        return self._answered(self.restitution) >= 0.0

    @derived()
    def regime(self) -> Regime:
        """How the tangential impulse came about: "frictionless", "sliding", "sticking",
        "reversing", or "given" by a ratio.

        "reversing" arises under the law "stronge" and in a time-resolved contact: the slip stopped,
        and ended the other way; "sticking" then means that it stayed stopped. The linear model has
        no regime of its own: even where ``solve`` chose it, the answer is "frictionless".
        """
        found = np.asarray("given", "U12")
        if self.inputs.rule == FRICTION:
            sliding = np.where(self._reverses(), "reversing", "sliding")
            found = np.where(self._answer.sticks, "sticking", sliding)
            found = np.where(np.equal(self.inputs.rule_value, 0.0), "frictionless", found)
        if self.choice is not None:
            found = np.where(np.equal(self.model, "linear_central"), "frictionless", found)
        return cast(Regime, _labels(np.where(self.refused, "", found)))

    @derived()
    def pulse(self) -> Pulse | None:
        """The contact over time as ``time_resolved`` followed it; None for an impulse, which takes
        no time.
        """
        passed = self._passed
        if passed is None:
            return None
        from .pulse import CURVES, Pulse

        found = {f.name: getattr(passed, f.name) for f in fields(Pulse) if f.name in Passed._fields}
        left = {
            f"residual_crush_{label}": part
            for label, part in residual_crushes(self.inputs, passed.peak_force).items()
        }
        if left:
            found |= left | {"residual_crush": sum(left.values())}
        curves = () if passed.history is None else passed.history
        return in_units_of(
            Pulse(**read_only(found), **dict(zip(CURVES, curves, strict=False))), self._texts()
        )

    @derived()
    def status(self) -> Status:
        """Outcome: a Status, whose ``sentence`` explains it; in a batch an array of its codes."""
        code: Any = self._answer.status
        return cast(Status, code) if isinstance(code, np.ndarray) else Status(code)

    @derived()
    def ok(self) -> Any:
        """Whether the case was answered without an energy gain."""
        return self._answer.status == Status.OK

    @derived()
    def refused(self) -> Any:
        """Whether the case was refused, so that its numbers are NaN."""
        return self._answer.status > Status.ENERGY_GAIN

    @property
    def _passed(self) -> Any:
        """The kernel's answer where the contact took time, else None."""
        return self._answer if isinstance(self._answer, Passed) else None

    @property
    def _followed(self) -> Any:
        """Which cases were followed in time: in a batch of ``solve`` not all need be."""
        return self._answer.duration == self._answer.duration

    @property
    def _parts_by_law(self) -> bool:
        """Whether the separation speed is an answer of its own, not e times the closing speed."""
        return self._passed is not None or LAWS[self.inputs.law or BRACH].followed

    def _until_compressed(self, name: str) -> Any:
        from .choice import until_compressed

        return until_compressed(self.inputs, self._answer, self.choice, [name])[0]

    def _reverses(self) -> Any:
        if not self._parts_by_law:
            return False
        before, after = self.slip_before, self.slip_after
        turned = ((before < 0.0) & (after > 0.0)) | ((before > 0.0) & (after < 0.0))
        return turned if LAWS[self.inputs.law or BRACH].followed else turned & self._followed

    def _output(self, name: str) -> Value:
        value: Value = getattr(self._answer, name)
        return value

    def _answered(self, value: Any) -> Value:
        """A value that depends on inputs alone; NaN where the case was refused."""
        answered: Value = select(self.refused, math.nan, value)
        return answered

    def again(self, **changes: Any) -> Impact:
        """Solve the impact again by the same solver, with some of its arguments changed.

        Parameters
        ----------
        **changes
            Arguments of the solver that answered, written as for that solver: ``a``, ``b``,
            ``restitution``, ``normal``, ``incomplete`` and, where it has them, ``point``, ``law``,
            ``outside_a``, ``outside_b``, ``tolerance``, and one of ``friction``, ``impulse_ratio``
            and ``critical_fraction`` in place of the one used.

        Returns
        -------
        Impact
            Solved forward; where a reverse solver found this impact, from the motions that it
            found.

        Raises
        ------
        TypeError
            An argument that the solver does not have.
        CollisionsError
            As the solver raises them.

        Examples
        --------
        >>> import collisions as col
        >>> impact = col.linear_central(
        ...     col.Vehicle(mass=1100, vx="80 km/h"), col.Vehicle(mass=950), 0.4
        ... )
        >>> for e in (0.2, 0.4):
        ...     print(round(impact.again(restitution=e).b.delta_v, 2))
        14.31
        16.69
        """
        inputs, rules = self.inputs, [name for name in RULES if name in changes]
        takes = {"a", "b", "restitution", "normal", *ARGUMENTS[inputs.model]}
        unknown = changes.keys() - takes
        if unknown:
            raise TypeError(
                f"again() takes the arguments of {inputs.model}: {', '.join(sorted(takes))}; got "
                f"{min(unknown)!r}"
            )
        if len(rules) > 1:
            raise InputError(
                f"give one of {' and '.join(rules)}, not both",
                code="one_tangential",
                argument=rules[0],
            )
        changed = {name: value for name, value in changes.items() if name not in RULES}
        changed |= {"rule": rules[0], "rule_value": changes[rules[0]]} if rules else {}
        same_as_before = takes - changes.keys() - (RULES.keys() if rules else set())
        given = {
            name: text
            for name, text in (inputs.given or {}).items()
            if name.partition("[")[0] in same_as_before
        }
        if inputs.model == "time_resolved" and changes.keys() & set(STIFFNESSES):
            changed = dict.fromkeys(STIFFNESSES) | changed
        changed |= {"given": given, "contact_velocity": None}
        return solved(read_again(replace(inputs, **changed), changed=changes.keys()))

    def case(self, index: int | tuple[int, ...]) -> Impact:
        """One case of a batch as a single impact, to look at, plot, explain or report.

        The case is solved again by itself, so it agrees with the batch to within the accuracy
        promised, and a case that was refused raises the error that says why.

        Parameters
        ----------
        index : int or tuple of int
            Which case, as an index into the arrays of the batch.

        Returns
        -------
        Impact
            A single impact.

        Raises
        ------
        CollisionsError
            There is no such case, or it has no answer.

        Examples
        --------
        >>> import collisions as col
        >>> import numpy as np
        >>> speeds = np.array([20.0, 15.0, -1.0])
        >>> many = col.linear_central(
        ...     col.Vehicle(mass=1500.0, vx=speeds), col.Vehicle(mass=1200.0), 0.1, on_failure="nan"
        ... )
        >>> many.case(1).b.after
        Vehicle(mass=1200 kg, vx=9.16667 m/s)
        """
        codes: Any = self.status
        place = index_of(index, codes.shape if isinstance(codes, np.ndarray) else None)
        if self.reconstruction is not None and self.refused[place]:
            status = Status(codes[place])
            raise NoSolutionError(
                f"case {index} has no answer: {status.sentence}; ask "
                f"reconstruct.{self.reconstruction.method} for it alone to see what would decide",
                code=status.label,
            )
        return part_of_impact(self, lambda value: np.broadcast_to(value, codes.shape)[place].item())

    def to_dict(self) -> dict[str, Any]:
        """Inputs and results as nested plain values that strict JSON can hold; ``from_dict`` solves
        the impact again.

        Returns
        -------
        dict
            The record; its schema is ``impact_schema()``.
        """
        from .records import to_record

        return to_record(self)

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Impact:
        """The impact of a ``to_dict`` record, solved again from its inputs: equal to the original.

        Of a reverse answer, ``reconstruction`` is taken from the record as it stands, such as how
        well-posed it was and how many impacts fit; and so is the status of a case without an
        answer. ``diagnose``, ``explain``, ``report`` and ``reporting.replay`` work the
        reconstruction out again, of single cases, and refuse a record that says otherwise.

        Parameters
        ----------
        record : dict
            What ``to_dict`` gave, also through JSON.

        Returns
        -------
        Impact
            Equal to the one that was written down.
        """
        from .records import from_record

        with in_si():
            inputs, on_failure, origin, status = from_record(record)
        impact = solved(inputs, on_failure=on_failure)
        return impact if origin is None else found_by(origin, inputs, impact._answer, status)

    def to_columns(
        self, *, units: str | None = None, columns: Collection[str] | None = None
    ) -> dict[str, list[Any]]:
        """Every input and result as a flat column with one value per case, ready for
        ``pandas.DataFrame(...)``.

        Parameters
        ----------
        units : {"si", "metric", "us"}, optional
            Units of the numbers, which then appear in the names: "a.delta_v [mph]". By default SI,
            with plain names.
        columns : list of str, optional
            Only these columns, in this order, named without a unit, such as "a.delta_v"; nothing
            else is worked out.

        Returns
        -------
        dict of list
            A list by the name of its column, with one value for each case.

        Raises
        ------
        InputError
            No such system of units, or no such column.

        Examples
        --------
        >>> import collisions as col
        >>> impact = col.linear_central(
        ...     col.Vehicle(mass="3400 lb", vx="30 mph"), col.Vehicle(mass="3400 lb"), 0.0
        ... )
        >>> impact.to_columns(units="us", columns=["b.delta_v"])
        {'b.delta_v [mph]': [15.0]}
        """
        from .records import to_columns

        return to_columns(self, units, columns)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Impact):
            return NotImplemented
        return self.inputs == other.inputs and all(map(equal, self._answer, other._answer))

    def __getstate__(self) -> dict[str, Any]:
        return {
            name: getattr(self, name) for name in ("inputs", "_answer", "reconstruction", "choice")
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Arrays come out of a pickle unlocked; those of inputs and choice lock themselves."""
        vars(self).update(read_only(state))
        origin = self.reconstruction
        if origin is not None:
            read_only(tuple(getattr(origin, each.name) for each in fields(origin)))

    def __repr__(self) -> str:
        shown = ", ".join(
            f"{name}={format_value(getattr(self, name), unit)}"
            for name, unit in (
                ("closing_speed", "m/s"),
                ("restitution", None),
                ("normal_impulse", "N*s"),
                ("energy_loss", "J"),
            )
        )
        return (
            f"<Impact {self.model}: {shown}, delta_v a={format_value(self.a.delta_v)} "
            f"b={format_value(self.b.delta_v, 'm/s')}>"
        )

    def _summary(self, numbers: Cells) -> Summary:
        a, b = self.a, self.b
        numbers.answered = np.logical_not(self.refused)
        names = [
            name
            for name in _CONTACT
            if self.inputs.model != "linear_central" or name not in _TANGENTIAL
        ]
        label = {"energy_loss": "energy lost"}
        rows = [
            (
                label.get(name, label_of(name)),
                numbers.text(getattr(self, name), unit_of(Impact, name)),
            )
            for name in names
        ]
        notes = SIGNS if a.before.heading is not None or b.before.heading is not None else SIGNS[:1]
        said = map(as_sentence, self._said())
        notes = (*self._bounds(numbers), *outcomes(self.status), *said, *notes)
        title = f"Impact of {title_of(a)} and {title_of(b)}"
        everything = all_numbers(self._rows())
        return Summary(title, [*beside((a, b), numbers), Part(rows, "Contact"), everything], notes)

    def _said(self) -> Iterator[str]:
        """Of an impact that was found backwards: how many others fit, and its statements."""
        from .reconstruction import how_many

        answers = 1 if self.reconstruction is None else self.reconstruction.answers
        if np.ndim(answers) == 0 and answers > 1:
            yield f"Not the only answer: {how_many(answers)} fit what was known"
        yield from self.statements

    def _bounds(self, numbers: Cells) -> tuple[str, ...]:
        """That speeds of a contact that may have slid are known from one side only."""
        origin = self.reconstruction
        if origin is None or not any(map(np.any, (origin.one_sided or {}).values())):
            return ()
        if not isinstance(self.status, Status):
            sides = np.any([*map(np.asarray, (origin.one_sided or {}).values())], axis=0)
            return (
                f"In {np.count_nonzero(sides)} of {np.size(sides)} cases speeds before are known "
                "from one side only, as the contact slid, or may have: see "
                "reconstruction.one_sided.",
            )
        from .reconstruction import bounds_of

        speeds = {
            f"speed_{label}": numbers.answer(side.before.speed, "speed")
            for label, side in (("a", self.a), ("b", self.b))
        }
        bounds = " and ".join(bounds_of(origin.one_sided or {}, speeds))
        return (
            f"The contact slid, or may have: {bounds}. All other numbers are those of the least "
            "slip.",
        )

    def _texts(self) -> Iterable[Any]:
        return self.inputs.texts

    def _rows(self) -> Iterator[tuple[str, str]]:
        for name in attributes(Impact):
            value = getattr(self, name)
            if name in ("a", "b", "pulse") and value is not None:
                yield from ((f"{name}.{inner}", text) for inner, text in value._rows())
            elif value is not None:
                yield name, format_value(value, unit_of(Impact, name))


# The rows of a summary on the contact; a linear impact has no tangential ones.
_TANGENTIAL = ("tangential_impulse", "impulse_ratio", "regime")
_CONTACT = ("model", "closing_speed", "restitution", "normal_impulse", *_TANGENTIAL, "energy_loss")


def build(inputs: Inputs, raw: Any) -> Impact:
    """An Impact from its inputs and the kernel's answer."""
    impact: Impact = _new(Impact)
    found = impact.__dict__
    found["inputs"] = inputs
    found["_answer"] = raw
    return impact


def answer_of(impact: Impact) -> Any:
    """What the kernel answered: a status and numbers by name."""
    return impact._answer


def solved(
    inputs: Inputs,
    on_failure: Any = None,
    threads: Any = 1,
    progress: Any = None,
    choice: ModelChoice | None = None,
) -> Impact:
    """Solve the inputs; ``choice`` if the model was chosen before."""
    if inputs.model != "solve":
        return build(inputs, solve_inputs(model_of(inputs), inputs, on_failure, threads, progress))
    from .choice import solve_with_simplest, where_answered

    answer, choice = solve_with_simplest(inputs, on_failure, threads, progress, choice)
    impact = build(inputs, answer)
    choice = where_answered(choice, answer.status > Status.ENERGY_GAIN)
    given = inputs.a.given or inputs.b.given or inputs.given
    vars(impact)["choice"] = choice if given is None else in_units_of(choice, inputs.texts)
    return impact


def solve_changed(impact: Impact, **changes: Any) -> Impact:
    """Solve again with some inputs changed, by the same model and without validation; NaN where
    refused.

    No warnings: the impact itself has given those of refused cases and energy gains.
    """
    with quietly():
        return solved(
            replace(impact.inputs, **changes, given=None), on_failure="nan", choice=impact.choice
        )


def with_vehicles(impact: Impact, a: Vehicle, b: Vehicle) -> Impact:
    """The same impact with vehicles that differ in name or in how their numbers were given."""
    other = build(replace(impact.inputs, a=a, b=b), impact._answer)
    vars(other).update({name: getattr(impact, name) for name in ("reconstruction", "choice")})
    return other


def way_to_separation(impact: Impact) -> Parted | None:
    """How far a contact that was followed in time moves both vehicles; None for an impulse."""
    from .pulse import parted

    return None if impact._passed is None else parted(impact._passed)


def part_of_impact(
    impact: Impact, take: Callable[[Any], Any], on_failure: OnFailure | None = None
) -> Impact:
    """Some cases of a batch, solved again; ``take`` selects them from every array."""
    origin = impact.reconstruction
    inputs = read_again(part_of_inputs(impact.inputs, take), found=origin is not None)
    choice = None
    if impact.choice is not None:
        from .choice import part_of_choice

        choice = part_of_choice(impact.choice, take)
    part = solved(inputs, on_failure=on_failure, choice=choice)
    if origin is None:
        return part
    from .reconstruction import part_of_origin

    own = part_of_origin(origin, take, impact.inputs.rule_value)
    return found_by(own, inputs, part._answer, take(impact.status))


def found_by(origin: Reconstruction, inputs: Inputs, raw: Any, status: Any) -> Impact:
    """An Impact that a reverse solver found; where that gave no answer, its status says why."""
    from .reconstruction import origin_where_answered

    code = raw.status
    if isinstance(code, np.ndarray):
        code = np.where(
            (code > Status.ENERGY_GAIN) & np.not_equal(status, Status.OK), status, code
        ).astype(code.dtype)
    elif code > Status.ENERGY_GAIN and status != Status.OK:
        code = Status(status)
    impact = build(inputs, raw._replace(status=read_only(code)))
    vars(impact)["reconstruction"] = origin_where_answered(origin, code)
    return impact


def _labels(found: Any) -> Any:
    """The array of labels of a batch; of a single case its label."""
    return found if found.ndim else str(found)


def _divided(numerator: Value, denominator: Value) -> Value:
    """The quotient without warnings; NaN where the denominator is 0."""
    with np.errstate(all="ignore"):
        quotient: Value = numerator / select(denominator == 0.0, math.nan, denominator)
        return quotient
