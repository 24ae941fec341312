"""What planar says where the last digits decide, and why a state after an impact has no one state before."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np

from ..errors import AmbiguousSolutionError, CollisionsError, IllConditionedWarning, OutOfRangeWarning, Status
from ..impact import Impact
from ..kernels.contact_laws import BRACH, CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, KUDLICH_SLIBAR
from ..solving import error_of
from ..warning import callers_level
from .common import Cases
from .origins import End, Origin

_FREE = "give a finite friction=, or impulse_ratio="


def warn(cases: Cases, end: End, pressed: Any, nearly: Any) -> None:
    """Says where the last digits of what was measured decide."""
    count = "" if cases.shape is None else f"in {{}} of {int(np.prod(cases.shape))} cases "
    if np.any(pressed):
        most = float(np.max(np.where(pressed, end.approach, 0.0)))
        warnings.warn(
            OutOfRangeWarning(
                f"{count.format(np.count_nonzero(pressed))}the contact points still approach after the impact, by up to "
                f"{most:.3g} m/s: taken as 0, a plastic impact, and the motions after changed by as much",
                code="nearly_plastic",
                approach=most,
            ),
            stacklevel=callers_level(),
        )
    if np.any(nearly):
        low, high = end.range()
        alone = cases.shape is None
        where = _between(end) if alone else "in a wide range"
        which = "is that end of the range" if alone and np.isinf(high - low) else "follows the sign of that slip"
        least = float(np.min(np.where(nearly, abs(end.slip), np.inf)))
        warnings.warn(
            IllConditionedWarning(
                f"{count.format(np.count_nonzero(nearly))}the slip after the impact, {least:.3g} m/s, is so small that it may "
                f"be none: then the contact stuck, and the slip before was anything {where}. "
                f"The answer {which}; carry all digits, or decide with impulse_ratio= of either sign",
                code="nearly_sticking",
                slip_after=least,
            ),
            stacklevel=callers_level(),
        )


def refusal(status: int, end: End, regime: str | None, fitting: list[Origin], solutions: tuple[Impact, ...]) -> CollisionsError:
    """The error of a single case, with what fits; what it advises does not end in the same refusal."""
    separation, slip = float(end.separation), float(end.slip)
    fields = {"separation_speed": separation, "slip_after": slip, "solutions": solutions}
    if status == Status.AMBIGUOUS_INVERSE:
        regimes = [one.regime for one in fitting]
        told = " or ".join(
            f"{how} with impulse ratio {impact.impulse_ratio:.4g} from a closing speed of {impact.closing_speed:.6g} m/s"
            for how, impact in zip(regimes, solutions, strict=True)
        )
        deciding = " or ".join(f"regime={how!r}" for how in regimes if regimes.count(how) == 1)
        return AmbiguousSolutionError(
            f"{len(solutions)} states before end so: {told}; all are in .solutions; what decides is "
            f"{deciding}{', or ' if deciding else ''}impulse_ratio= of one of them",
            code="ambiguous_inverse",
            solutions=solutions,
        )
    if status == Status.STICK_INVERSE:
        text = _stuck(end, slip, solutions)
    elif status == Status.NOT_SEPARATING:
        text = _not_parting(end, separation)
    elif status == Status.CONTRADICTORY:
        text = _contradiction(end, separation, slip, regime)
    else:
        text = {
            Status.INVERSE_E0: f"restitution = 0: after a plastic impact nothing is left of the closing speed; give "
            f"{_plastic(end)} instead",
            Status.IMMOVABLE: "nothing can yield along the normal: both bodies are fixed there; correct normal or point, or "
            "give a finite mass",
            Status.SINGULAR_CONTACT: "the contact can move in one direction only (a pinned body against a fixed one, or "
            "parallel arms), so what would stop the slip is not defined; write friction=0, or give impulse_ratio=",
        }[Status(status)]
    return error_of(status, text, **fields)


def plain_refusal(status: int) -> CollisionsError:
    """The error of a case of which only its status is known."""
    return error_of(status, Status(status).sentence)


def _plastic(end: End) -> str:
    """What may be known in place of the restitution."""
    shares = end.rule == CRITICAL_FRACTION and 0.0 < end.bound < 1.0
    return "closing_speed=" if shares else "closing_speed= or energy_loss="


def _between(end: End) -> str:
    """The range of slips before that stuck, to one side open where friction jams."""
    low, high = (float(slip) for slip in end.range())
    if math.isinf(low) or math.isinf(high):
        return f"below {high:.4g} m/s" if math.isinf(low) else f"above {low:.4g} m/s"
    return f"in {low:.4g} to {high:.4g} m/s"


def _limit(end: End) -> float:
    """The impulse ratio at which the bodies jam; infinite where none does."""
    return float(-end.k_nn / end.k_nt) if end.k_nt else math.inf


def _stuck(end: End, slip: float, solutions: tuple[Impact, ...]) -> str:
    ends = ""
    if len(solutions) == 1:
        ends = (
            f".solutions holds the one end of the range, where friction is just used up; to the other side it is open, for "
            f"impulse ratios towards {_limit(end):.4g}, where the bodies jam. "
        )
    elif solutions:
        ends = f".solutions holds the {len(solutions)} ends of the range, where friction is just used up. "
    # At rest it tells no more under the other law.
    other = end.law == BRACH and abs(end.separation) > end.noise
    law = f", or law={KUDLICH_SLIBAR!r} if that is the model" if other else ""
    return (
        f"the contact ended without slip (slip after {slip:.3g} m/s, no more than rounding leaves), and under {end.law!r} any "
        f"slip before may end so: the motion across the normal is lost. {ends}What decides is impulse_ratio=, the tangential "
        f"over the normal impulse{_allowed(end)}{law}"
    )


def _allowed(end: End) -> str:
    """Between which ratios a contact with this friction may stick."""
    if end.rule != FRICTION or math.isinf(end.bound):
        low, high = -math.inf, math.inf
    else:
        low, high = -float(end.bound), float(end.bound)
    limit = _limit(end)
    if math.isfinite(limit):
        low, high = (max(low, limit), high) if limit < 0.0 else (low, min(high, limit))
    if math.isinf(low) and math.isinf(high):
        return ""
    if math.isinf(low) or math.isinf(high):
        return f" ({'below' if math.isinf(low) else 'above'} {high if math.isinf(low) else low:.4g})"
    return f" (between {low:.4g} and {high:.4g})"


def _not_parting(end: End, separation: float) -> str:
    if end.kind != "restitution":
        return (
            f"the contact points do not part after the impact: separation speed {separation:.6g} m/s along the normal, which "
            f"must point from A into B, and more than a hundredth of the closing speed of {float(end.closing):.6g} m/s; check "
            f"the motions after"
        )
    if abs(separation) <= end.rounding:
        return (
            f"whether the contact points part after the impact cannot be told from rounding: separation speed "
            f"{separation:.3g} m/s, of which rounding may be {float(end.rounding):.3g} m/s. The restitution says nothing of "
            f"the closing speed then; give {_plastic(end)} instead"
        )
    return (
        f"the contact points do not part after the impact: separation speed {separation:.6g} m/s along the normal, which must "
        f"point from A into B; for a plastic impact give {_plastic(end)}"
    )


def _contradiction(end: End, separation: float, slip: float, regime: str | None) -> str:
    """Why nothing fits, and what would."""
    here = f"separation speed {separation:.6g} m/s, slip after {slip:.6g} m/s"
    origins, fits = end.origin(None)
    if regime is not None and (any(fits) or not any(one.regime == regime for one in origins if not np.isnan(one.normal))):
        found = " or ".join(sorted({one.regime for one, fit in zip(origins, fits, strict=True) if fit}))
        return (
            f"no motion before ends so in the regime {regime!r} under {end.law!r} with this {end.rule} and {end.kind}: {here}; "
            f"leave out regime={f', the contact ended {found}' if found else ''}"
        )
    if end.always_sticks():
        return (
            f"with this {end.rule} a contact under {end.law!r} ends without slip, but the slip after is {slip:.6g} m/s; if "
            f"that is an error of measurement, the contact stuck and its motion across the normal is lost; {_FREE}"
        )
    given = f"{end.rule}={float(end.bound):g}"
    if end.kind == "closing_speed" and separation > end.known:
        return (
            f"the contact points part faster than they met: {here}, closing_speed={float(end.known):.6g} m/s; give at least "
            f"the separation speed, or restitution= instead"
        )
    if end.always_sticks(KUDLICH_SLIBAR):
        return f"with {given} the contact sticks, and under {end.law!r} none that sticks ends so: {here}; {_FREE}"
    ratios = {FRICTION: (float(end.bound), -float(end.bound)), IMPULSE_RATIO: (float(end.bound),)}.get(end.rule, ())
    if any(end.resistance(ratio) <= 0.0 for ratio in ratios):
        limit = _limit(end)
        allowed = abs(limit) if end.rule == FRICTION else limit
        return (
            f"{given} jams the bodies in a contact that ends so ({here}); give {end.rule}= "
            f"{'below' if allowed > 0.0 else 'above'} {allowed:.4g}, or check the yaw rates and the normal"
        )
    if end.kind == "energy_loss":
        # Friction acts against the slip; under "kudlich-slibar" against that of compression, and the one after may be either.
        free = end.rule == IMPULSE_RATIO or end.law != BRACH
        least = min((end.elastic_loss(ratio) for ratio in ratios if free or ratio * slip <= 0.0), default=0.0)
        if least > end.known:
            return (
                f"energy_loss={float(end.known):.6g} J is less than an impact with {given} loses that ends so ({here}); give "
                f"at least {least:.7g} J, or restitution= or closing_speed= instead"
            )
    return (
        f"no motion before ends so under {end.law!r} with {given} and {end.kind}={float(end.known):g}: {here}; check the "
        f"normal and the motions after{', or give friction= or impulse_ratio=' if end.rule == CRITICAL_FRACTION else ''}"
    )
