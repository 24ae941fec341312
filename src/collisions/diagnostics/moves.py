"""``moves``: what would move an answer, each input that is drawn or estimated by as much as it may
be wrong, largest first.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ..impact.impact import Impact, solve_changed
from ..impact.inputs import PLACED
from ..impact.left_out import tyres_held, tyres_lacking
from ..kernels.contact_laws import RULES
from ..quantities.attributes import Quantities, same_fields
from ..quantities.directions import from_degrees
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary
from ..reference import INTER_VEHICLE_FRICTION
from .numbers import percent, share

if TYPE_CHECKING:
    from .case import ImpactCase

# How far each is moved either way. The first is about what contacts that were drawn before the
# measurements were read were off by, one standard deviation (reference.CONTACT_POINT_DRAWN).
ASIDE = 0.25
TURN = 5.0
OF_RESTITUTION = 0.1
_HEADS = ("delta-V A", "B", "yaw rate A", "B", "share")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Move:
    """What one input would do to an answer if it were wrong by so much: the larger of both ways.

    Attributes
    ----------
    name : str
        The input: "point", "normal", "restitution", the name of the rule such as "friction", or,
        for what an impulse leaves out, "geometry" and "tyres".
    what : str
        What was changed, and by how much.
    delta_v_a, delta_v_b : float [m/s]
        Length by which the vector of delta-V of a vehicle moves; NaN where there is no answer then.
    yaw_rate_a, yaw_rate_b : float or None [rad/s]
        Change of the yaw rate after; None where no estimate has one.
    share : float [-]
        The larger of both changes of delta-V, as a share of that vehicle's; infinite where there is
        no answer then.
    """

    name: str
    what: str
    delta_v_a: float = field(metadata={"unit": "m/s"})
    delta_v_b: float = field(metadata={"unit": "m/s"})
    yaw_rate_a: float | None = field(metadata={"unit": "rad/s"})
    yaw_rate_b: float | None = field(metadata={"unit": "rad/s"})
    share: float = field(metadata={"unit": ""})

    @property
    def q(self) -> Any:
        """The same attributes, with numbers as pint Quantities."""
        return Quantities(self)

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other) if isinstance(other, Move) else NotImplemented

    def to_dict(self) -> dict[str, Any]:
        """The fields as strict JSON, in SI.

        Returns
        -------
        dict
        """
        return {name: strict(getattr(self, name)) for name in self.__dataclass_fields__}


class Moves(tuple[Move, ...], Summarized):
    """What would move an answer, largest share of delta-V first, shown as a table."""

    _system: str

    def __new__(cls, found: Iterable[Move] = (), units: str = "metric") -> Moves:
        made = super().__new__(cls, found)
        made._system = units
        return made

    def summary(self, units: str | None = None) -> Summary:
        """The table; numbers in ``units``, by default those of the diagnosis."""
        return super().summary(self._system if units is None else units)

    def _summary(self, numbers: Cells) -> Summary:
        part = table(self, numbers)
        return Summary(part.heading, [part._replace(heading="")])

    def __repr__(self) -> str:
        return str(self.summary())


def table(found: Moves, numbers: Cells) -> Part:
    """The moves as a part of a summary."""
    rows = [(move.what, *_texts(move, numbers)) for move in found]
    return Part(rows, "What would move this answer", _HEADS)


def _texts(move: Move, numbers: Cells) -> Iterator[str]:
    """The numbers of a row."""
    for value, unit in (
        (move.delta_v_a, "m/s"),
        (move.delta_v_b, "m/s"),
        (move.yaw_rate_a, "rad/s"),
        (move.yaw_rate_b, "rad/s"),
    ):
        yield "" if value is None else numbers.text(value, unit)
    yield percent(move.share)


def moves(case: ImpactCase) -> Moves:
    """The moves of an impact."""
    found = [*_of_inputs(case), *_of_idealisation(case)]
    return Moves(sorted(found, key=lambda move: -move.share), case.units)


def _of_inputs(case: ImpactCase) -> Iterator[Move]:
    """Solved again with an input moved either way."""
    impact = case.answer
    (nx, ny), e = impact.normal, impact.inputs.restitution
    if impact.model in PLACED and impact.point is not None:
        x, y = impact.point
        places = [(x - by * ny, y + by * nx) for by in (-ASIDE, ASIDE)]
        what = f"contact point {case.text(ASIDE, 'length')} aside"
        yield _solved(impact, "point", what, [{"point": place} for place in places])
    if impact.model != "linear_central":
        turned = []
        for angle in (-TURN, TURN):
            c, s = from_degrees(angle)
            turned.append({"normal": (c * nx - s * ny, s * nx + c * ny)})
        what = f"normal turned by {case.text(math.radians(TURN), 'angle')}"
        yield _solved(impact, "normal", what, turned)
    # Only an impulse can be incomplete.
    lowest = -1.0 + 1e-9 if impact.inputs.incomplete and impact.pulse is None else 0.0
    least = max(e - OF_RESTITUTION, lowest)
    ends = [{"restitution": end} for end in (least, min(e + OF_RESTITUTION, 1.0))]
    what = f"restitution {OF_RESTITUTION:g} more or less"
    yield _solved(impact, "restitution", what, ends)
    rule, value = impact.inputs.rule, impact.inputs.rule_value
    if impact.model == "linear_central":
        return
    if math.isinf(value):
        typical = INTER_VEHICLE_FRICTION.typical
        what = f"{_named(rule)} {typical:g} in place of an infinite one"
        yield _solved(impact, rule, what, [{"rule_value": typical}])
        return
    entry = RULES[rule]
    by = entry.step
    ends = [
        {"rule_value": end} for end in (max(value - by, entry.least), min(value + by, entry.most))
    ]
    yield _solved(impact, rule, f"{_named(rule)} {by:g} more or less", ends)


def _named(rule: str) -> str:
    """A tangential rule in words short enough for a table."""
    return rule.replace("_", " ")


def _solved(impact: Impact, name: str, what: str, changes: list[dict[str, Any]]) -> Move:
    """The larger change of several, by each number."""
    worst = {"delta_v": [0.0, 0.0], "yaw_rate": [0.0, 0.0]}
    shares = [0.0]
    for changed in changes:
        again = solve_changed(impact, **changed)
        for i, (old, new) in enumerate(((impact.a, again.a), (impact.b, again.b))):
            if again.refused:
                worst["delta_v"][i] = worst["yaw_rate"][i] = math.nan
                shares.append(math.inf)
                continue
            by = math.hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy)
            turn = abs(new.delta_yaw_rate - old.delta_yaw_rate)
            for kind, change in (("delta_v", by), ("yaw_rate", turn)):
                # A NaN of another change stays.
                was = worst[kind][i]
                worst[kind][i] = change if change > was else was
            shares.append(share(by, old.delta_v) if old.delta_v > 0.0 else 0.0)
    return Move(
        name=name,
        what=what,
        delta_v_a=worst["delta_v"][0],
        delta_v_b=worst["delta_v"][1],
        yaw_rate_a=worst["yaw_rate"][0],
        yaw_rate_b=worst["yaw_rate"][1],
        share=max(shares),
    )


def _of_idealisation(case: ImpactCase) -> Iterator[Move]:
    """What an impulse leaves out, as ``left_out`` estimates it."""
    left = case.left_out
    if left is None:
        return
    lacking, time = tyres_lacking(case.answer), f"{left.duration:.3g} s"
    given = {*case.tyres, *case.answer.inputs.tyres}
    unknown = [label for label in lacking if label not in given]
    tyres = f"tyres as given, {time}"
    if unknown:
        of = f" of {unknown[0].upper()}" if given or tyres_held(case.answer) else ""
        tyres = f"tyres{of} sliding {time}, drag {left.drag:.2g}"
        tyres += ", others as given" if given.intersection(lacking) else ""
    for name, what, of in (
        ("geometry", f"motion during contact, {time}", "geometry"),
        ("tyres", tyres, "tyre"),
    ):
        changes = [getattr(side, f"{of}_delta_v") for side in (left.a, left.b)]
        if None in changes or (name == "tyres" and not lacking):
            continue
        sizes = (side.delta_v for _, _, side in case.sides)
        shares = [
            share(change, size) if size > 0.0 else 0.0
            for change, size in zip(changes, sizes, strict=True)
        ]
        yield Move(
            name=name,
            what=what,
            delta_v_a=float(changes[0]),
            delta_v_b=float(changes[1]),
            yaw_rate_a=None,
            yaw_rate_b=None,
            share=max(shares),
        )
