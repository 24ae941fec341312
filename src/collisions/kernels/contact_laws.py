"""How restitution and friction act at a contact: the laws, what may be said of the tangent, and the
energy that is lost.

A new law or a new tangential rule is an entry of the tables below; every solver, page and message
reads it there.
"""

from collections.abc import Callable
from functools import cache
from math import inf
from typing import Any, NamedTuple

from .elementwise import NOT_NEGATIVE, RATIO, UNIT_INTERVAL, Domain, larger, safe_divisor, select


class Passage(NamedTuple):
    """How a contact passed that was followed: its impulse on B, the speeds after, the losses, and
    whether it stuck.
    """

    normal: Any
    tangential: Any
    separation: Any
    slip_after: Any
    loss_n: Any
    loss_t: Any
    sticks: Any


class Law(NamedTuple):
    """How restitution acts, and what no slip means.

    Parameters
    ----------
    name : str
        As given to ``law=``.
    sticking_slip : callable
        Slip after over slip before of a contact that sticks, from the restitution, by + - * /
        alone: ``explain`` writes it in symbols.
    no_slip : str
        What no slip means, in a few words for messages.
    derivation, assumption : str
        The same as ``explain`` and a report say it.
    passage : callable, optional
        Of a law that follows the contact as the impulse builds up: its ``Passage``, from what
        ``energetic_contact`` takes. Such a law takes friction only, and has its own separation
        speed. Without one a rule of ``RULES`` decides.
    """

    name: str
    sticking_slip: Callable[[Any], Any]
    no_slip: str
    derivation: str
    assumption: str
    passage: Callable[..., Passage] | None = None

    @property
    def followed(self) -> bool:
        """Whether the law follows the contact, instead of a rule that decides once."""
        return self.passage is not None

    @property
    def compression_limit(self) -> bool:
        """Whether a sticking contact ends with -e of its slip: at rest in between, its impulse
        until then multiplied by 1 + e.

        Then the energy lost with friction is a sum of terms that are >= 0.
        """
        return _ends_compression_at_rest(self.sticking_slip)


@cache
def _ends_compression_at_rest(sticking_slip: Callable[[Any], Any]) -> bool:
    return all(sticking_slip(e) == -e for e in (0.0, 0.1, 0.3, 0.7, 1.0))


class Tangent(NamedTuple):
    """What a rule decides: whether the contact sticks, and its impulse ratio if it does not.

    ``needs_no_slip`` says whether the no-slip impulse matters, ``pulls`` whether that would need
    the bodies to pull.
    """

    sticks: Any
    ratio: Any
    needs_no_slip: Any
    pulls: Any


class Rule(NamedTuple):
    """One way to say what happens along the tangent.

    Parameters
    ----------
    name : str
        The argument that gives its value.
    domain : Domain
        The values it may have.
    meaning : str
        What the value is, for tables.
    decide : callable
        The ``Tangent`` from the value and the no-slip impulse (n, t).
    step : float
        How far either way a diagnosis moves the value, to say what it decides.
    least, most : float
        The ends of the values it may have.
    """

    name: str
    domain: Domain
    meaning: str
    decide: Callable[[Any, Any, Any], Tangent]
    step: float
    least: float = 0.0
    most: float = inf


def _coulomb(friction: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    # The no-slip impulse decides: the sign of the initial slip is the wrong one where the levers
    # reverse it. The limit is compared by multiplication, so that an infinite friction needs no
    # case of its own. Adding 0 turns a -0 into 0. A contact that sticks has no use for the ratio,
    # and an infinite one would make its derivatives NaN. Nor has one with nothing to hold, which
    # the first little friction makes stick.
    matters = friction > 0.0
    sticks = matters & (no_slip_n > 0.0) & (abs(no_slip_t) <= friction * no_slip_n)
    idle = sticks | ((friction == 0.0) & (no_slip_t == 0.0))
    ratio = select(idle, 0.0, select(no_slip_t < 0.0, -friction, friction) + 0.0)
    return Tangent(sticks, ratio, matters, pulls=(friction == inf) & (no_slip_n <= 0.0))


def _given_ratio(ratio: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    return Tangent(sticks=False, ratio=ratio, needs_no_slip=False, pulls=False)


def _share_of_critical(share: Any, no_slip_n: Any, no_slip_t: Any) -> Tangent:
    pushes = no_slip_n > 0.0
    matters = share > 0.0
    ratio = share * (no_slip_t / select(pushes, no_slip_n, 1.0))
    return Tangent(pushes & (share == 1.0), ratio, matters, pulls=matters & (no_slip_n <= 0.0))


def energetic_contact(
    restitution: Any,
    closing: Any,
    slip: Any,
    friction: Any,
    respond: Callable[[Any, Any], tuple[Any, Any]],
    stuck: Any,
) -> Passage:
    """A contact whose slip may stop or turn around while it lasts, with energetic restitution (law
    "stronge").

    Along the impulse the velocities at the contact change linearly until the slip stops; then,
    after a corner, linearly again: without slip if friction can hold it, else sliding on, the way
    that the coupling of normal and tangent pushes. Compression ends where the closing speed is 0,
    restitution where e squared of its work has been given back. An incomplete impact (e < 0) ends
    where e squared of that work was still to be done.

    ``respond`` gives the change of velocity along n and t by an impulse along n and t, ``stuck``
    that along n by a unit of normal impulse while the contact sticks. Losses are sums of terms that
    are >= 0.

    Stronge, Journal of Applied Mechanics 58 (1991); Wang and Mason, Journal of Applied Mechanics 59
    (1992).
    """
    unit = select(closing > 0.0, closing + abs(slip), 1.0)
    c = select(closing > 0.0, closing / unit, 1.0)
    forward = select(slip < 0.0, -1.0, 1.0)
    # Not abs(slip), whose derivative at 0 is not that of the answer; adding 0 turns a -0 into 0.
    s = (forward * slip + 0.0) / unit
    # Along n and t by a unit of the way on which friction slides: an infinite friction needs no
    # case of its own.
    moderate = friction <= 1.0
    along = select(moderate, 1.0, 1.0 / select(moderate, 1.0, friction))
    across = select(moderate, friction, 1.0)
    yields, by_friction = respond(along, -forward * across)
    slows = -forward * by_friction
    # Here and below no branch that is not taken may hold an infinite number or the root of 0, which
    # times the 0 of its share would make derivatives NaN. A slip that never stops therefore has a
    # time of 0 where its condition decides.
    ends = slows > 0.0
    never = (ends | (s == 0.0)) ^ True
    at_rest = (ends | never) ^ True
    slip_stop_impulse = select(
        ends, s / select(ends, slows, 1.0), select(never & (yields <= 0.0), inf, 0.0)
    )
    closing_at_stop = c - yields * slip_stop_impulse
    through = closing_at_stop <= -select(restitution < 0.0, 0.0, restitution) * c
    slides = (yields > 0.0) & (through | never)
    compressing = (closing_at_stop > 0.0) & (slides ^ True)
    per_c = select(yields == 0.0, 1.0, yields)

    # After the stop: what friction cannot hold of the coupling, and the change along n by a unit of
    # normal impulse, a sum.
    coupling, k_tt = respond(0.0, 1.0)
    k_tt = select(k_tt == 0.0, 1.0, k_tt)
    back = select(coupling < 0.0, 1.0, -1.0)
    # As of the slip: not abs(coupling). Without a coupling the first little friction holds.
    pushed = 0.0 - back * coupling
    bounded = select((friction == inf) | (coupling == 0.0), 0.0, friction)
    excess_coupling = pushed - bounded * k_tt
    reversing = ((excess_coupling > 0.0) | (friction == 0.0)) & (friction != inf)
    excess_coupling = select(reversing, excess_coupling, 0.0)
    ratio = select(reversing, back * bounded, -coupling / k_tt)
    softer = stuck + excess_coupling * (pushed / k_tt)
    softer = select(softer > 0.0, softer, 1.0)
    first = along * slip_stop_impulse
    work = select(compressing, 0.5 * first * (c + closing_at_stop), 0.0)
    stored = select(
        compressing | slides,
        0.0,
        along
        * ((restitution * c - closing_at_stop) * ((restitution * c + closing_at_stop) / per_c)),
    )
    squared = select(
        slides,
        1.0,
        closing_at_stop * closing_at_stop + softer * select(compressing, 2.0 * work, stored),
    )
    parting = select(compressing, restitution, 1.0) * squared**0.5
    regained = safe_divisor(True, select(compressing | slides, 1.0, parting - closing_at_stop))
    remaining_impulse = select(compressing, (closing_at_stop + parting) / softer, stored / regained)
    absorbed = select(
        compressing,
        work + closing_at_stop * (closing_at_stop / (2.0 * softer)),
        along * (c * (c / (2.0 * per_c))),
    )
    lost = (1.0 - restitution) * (1.0 + restitution) * absorbed

    # An incomplete impact may end before the slip has stopped, but not where infinite friction
    # stops it at once.
    early = compressing & (remaining_impulse <= 0.0)
    sliding = early & (along > 0.0)
    per_way = select(sliding, along, 1.0)
    squared = (
        closing_at_stop * closing_at_stop
        + yields * (remaining_impulse * (parting - closing_at_stop)) / per_way
    )
    # Where yields < 0 this is a difference, which rounding may bring below 0: then what the work
    # lost leaves, a sum.
    squared = select(squared <= 0.0, c * c - 2.0 * (yields * (lost / per_way)), squared)
    still = select(early, squared, 1.0) ** 0.5
    to_end = select(
        early,
        2.0 * lost / select(sliding, along * (c + still), 1.0),
        (1.0 + restitution) * (c / per_c),
    )
    slides = slides | early
    reversing = reversing & (slides ^ True)
    to_stop = select(slides, to_end, slip_stop_impulse)
    # A slip of 0 that nothing slows stays what it is, of which its derivative is made.
    slip_left = select(slides, s - slows * to_end, select(at_rest, s, 0.0))
    remaining_impulse = select(slides, 0.0, remaining_impulse)
    after = select(reversing, excess_coupling * remaining_impulse, 0.0)
    by_friction = 0.5 * across * to_stop * (s + slip_left) + select(
        reversing, 0.5 * bounded * (remaining_impulse * (after + 2.0 * slip_left)), 0.0
    )
    return Passage(
        normal=(along * to_stop + remaining_impulse) * unit,
        tangential=(select(slides, 0.0, ratio * remaining_impulse) - forward * across * to_stop)
        * unit,
        separation=select(early, -still, select(slides, restitution * c, parting)) * unit,
        slip_after=(forward * slip_left - back * after) * unit,
        loss_n=lost * unit * unit,
        loss_t=by_friction * unit * unit,
        sticks=(slides | reversing | (friction == 0.0)) ^ True,
    )


FRICTION, IMPULSE_RATIO, CRITICAL_FRACTION = "friction", "impulse_ratio", "critical_fraction"
BRACH, KUDLICH_SLIBAR, STRONGE = "brach", "kudlich-slibar", "stronge"

RULES = {
    rule.name: rule
    for rule in (
        Rule(FRICTION, NOT_NEGATIVE, "friction (bound on the impulse ratio)", _coulomb, 0.2),
        Rule(IMPULSE_RATIO, RATIO, "impulse ratio", _given_ratio, 0.1, least=-inf),
        Rule(
            CRITICAL_FRACTION, UNIT_INTERVAL, "critical fraction", _share_of_critical, 0.2, most=1.0
        ),
    )
}
LAWS = {
    law.name: law
    for law in (
        Law(
            BRACH,
            lambda restitution: 0.0,
            no_slip="no slip at separation",
            derivation='no slip is left at separation (law "brach")',
            assumption="restitution acts on the normal impulse; with enough friction the contact "
            "has stopped slipping when the vehicles part",
        ),
        Law(
            KUDLICH_SLIBAR,
            lambda restitution: -restitution,
            no_slip="no slip at the end of compression",
            derivation="the contact is at rest at the end of compression and the whole "
            "compression impulse is multiplied by "
            '1 + e (law "kudlich-slibar"), which turns the slip around and leaves e '
            "times as much",
            assumption="with enough friction the contact is at rest at the end of compression, "
            "and the whole impulse until then is multiplied by 1 + e, so that slip "
            "comes back with the opposite sign",
        ),
        Law(
            STRONGE,
            lambda restitution: 0.0,
            no_slip="slip that stops or turns around during the contact",
            derivation='no slip is left just as the vehicles part (law "stronge")',
            assumption="restitution gives back e squared of the work that compression took along "
            "the normal; friction acts against the slip as it changes during the "
            "contact, in which it may stop for good or turn around",
            passage=energetic_contact,
        ),
    )
}


def energy_losses(
    law: str,
    restitution: Any,
    closing: Any,
    slip_before: Any,
    slip_after: Any,
    sticks: Any,
    slip_change: Any,
    normal: Any,
    tangential: Any,
    impulse_work: Any,
    eps: float,
    separation: Any = None,
) -> tuple[Any, Any, Any, Any]:
    """Loss along the normal (eq 8), loss along the tangent, their sum, and whether the sum is a
    gain beyond its own rounding.

    Kelvin's theorem, and for friction with a compression limit the form that cannot go negative.
    Differences of kinetic energies (eq 7 of the paper) lose every digit in a moving frame; these
    forms use only what happens at the contact, hold for barriers and pivots and do not depend on
    the frame. ``impulse_work`` is P.K P, twice an energy, where the law ``dissipates`` and nothing
    else acts, else None; ``slip_change`` the difference of the slip after from that of a sticking
    contact. ``separation`` is the speed after from which the restitution was found, where it was
    not given.
    """
    slip_sum = slip_before + slip_after
    if LAWS[law].compression_limit:
        # After sticking a share of the slip is left, so that nothing cancels in the sum.
        slip_sum = select(
            sticks, (1.0 + LAWS[law].sticking_slip(restitution)) * slip_before, slip_sum
        )
    loss_n = 0.5 * (1.0 - restitution) * (closing * normal)
    loss_t = 0.0 - 0.5 * tangential * slip_sum
    if impulse_work is not None:
        # Every term is >= 0: the compression impulse's own work, and friction, against which the
        # slip goes that is left at the end of compression. Written so, it has its derivative where
        # there is no friction.
        rubbed = larger(0.0 - tangential * slip_change, 0.0)
        loss = (0.5 * (1.0 - restitution) * impulse_work + rubbed) / (1.0 + restitution)
        return loss_n, loss_t, loss, False
    loss = loss_n + loss_t
    scale = loss_n + abs(tangential) * (abs(slip_before) + abs(slip_after))
    if separation is not None:
        # A restitution that was found is rounded itself, so that the difference of it from 1 is
        # known to some eps of what was given back.
        scale = scale + abs(separation * normal)
    return loss_n, loss_t, loss, loss < -16.0 * eps * scale


def dissipates(rule: str, law: str) -> bool:
    """Whether the energy lost is a sum of terms that are >= 0, so that no case can gain."""
    return rule == FRICTION and LAWS[law].compression_limit
