"""What planar says where the last digits decide, and why a state after an impact has no one state before."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..errors import AmbiguousSolutionError, CollisionsError, IllConditionedWarning, NoSolutionError, OutOfRangeWarning
from ..impact import Impact
from ..kernels import codes
from ..quiet import callers_level
from .origins import End, Origin
from .outcome import Cases, plain_error


def warn(cases: Cases, end: End, pressed: Any, nearly: Any, origins: list[Origin]) -> None:
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
        slips = [np.where(nearly, origin.slip, np.nan) for origin in origins if origin.regime == "sliding"]
        if cases.shape is None and len(slips) == 2:
            low, high = sorted(float(slip) for slip in slips)
            ends = f"{low:.4g} to {high:.4g} m/s"
        else:
            ends = "a wide range"
        least = float(np.min(np.where(nearly, abs(end.slip), np.inf)))
        warnings.warn(
            IllConditionedWarning(
                f"{count.format(np.count_nonzero(nearly))}the slip after the impact, {least:.3g} m/s, is so small that it may "
                f"be none: then the contact stuck, and the slip before was anything in {ends}. The answer follows the sign of "
                f"that slip; carry all digits, or decide with impulse_ratio= of either sign",
                code="nearly_sticking",
                slip_after=least,
            ),
            stacklevel=callers_level(),
        )


def refusal(
    status: int, end: End, separation: float, slip: float, regime: str | None, solutions: tuple[Impact, ...]
) -> CollisionsError:
    """The error of a case, with what fits as far as that is known."""
    if status == codes.AMBIGUOUS_INVERSE:
        told = " or ".join(
            f"{impact.regime} with impulse ratio {impact.impulse_ratio:.4g} from a closing speed of "
            f"{impact.closing_speed:.6g} m/s"
            for impact in solutions
        )
        return AmbiguousSolutionError(
            f"{len(solutions) or 'several'} states before end so{': ' if told else ''}{told}; all are in .solutions; what "
            f"decides is regime= (how the contact ended) or impulse_ratio= of either sign",
            code="ambiguous_inverse",
            solutions=solutions,
        )
    if status == codes.STICK_INVERSE:
        other = ", or law='kudlich-slibar' if that is the model" if end.law == codes.BRACH else ""
        sliding = "regime='sliding' or " if end.rule == codes.FRICTION else ""
        ends = f".solutions holds the {len(solutions)} ends of the range, where friction is just used up; " if solutions else ""
        return NoSolutionError(
            f"the contact ended without slip (slip after {slip:.3g} m/s), and under {end.law!r} any slip before may end so: "
            f"the motion across the normal is lost. {ends}{sliding}impulse_ratio= of either sign decides{other}",
            code="stick_inverse",
            solutions=solutions,
        )
    texts = {
        codes.INVERSE_E0: "restitution = 0: after a plastic impact nothing is left of the closing speed; give closing_speed= "
        "or energy_loss= instead",
        codes.NOT_SEPARATING: f"the contact points do not part after the impact: separation speed {separation:.6g} m/s along "
        f"the normal, which must point from A into B; for a plastic impact give closing_speed= or energy_loss=",
        codes.IMMOVABLE: "nothing can yield along the normal: both bodies are fixed there; correct normal or point, or give a "
        "finite mass",
    }
    text = texts.get(status)
    if text is None and end.always_sticks():
        text = (
            f"with this {end.rule} a contact under {end.law!r} ends without slip, but the slip after is {slip:.6g} m/s; if "
            f"that is an error of measurement, the contact stuck and its motion across the normal is lost; give a finite "
            f"friction=, or impulse_ratio= of either sign"
        )
    elif text is None:
        wanted = f" in the regime {regime!r}" if regime is not None else ""
        text = (
            f"no motion before ends so{wanted} under {end.law!r} with this {end.rule} and {end.kind}: separation speed "
            f"{separation:.6g} m/s, slip after {slip:.6g} m/s; check the normal and the yaw rates, or give another of "
            f"restitution, closing_speed, energy_loss"
        )
    return plain_error(status, text, separation_speed=separation, slip_after=slip, solutions=solutions)
