"""Probabilities and shares of cases in words: none is rounded to a certainty."""

from __future__ import annotations

_MOST_DIGITS = 10
_LEAST = 1e-300  # where floats lose their digits, and from where on 0 may be no more than that


def chance(probability: float, figures: int = 2) -> str:
    """A probability in so many figures; neither 0 nor 1, which evidence with errors never tells."""
    if probability < _LEAST:
        return f"less than {_LEAST:g}"
    text = f"{probability:.{figures}g}"
    return f"more than {_nines(figures)}" if float(text) >= 1.0 else text


def in_percent(part: float, whole: float) -> str:
    """So much of a whole, as of all cases, in percent with three figures: 100 is all of it."""
    text = f"{100.0 * part / whole:.3g}"
    rounded_up = part < whole and float(text) >= 100.0
    return f"more than {_nines(3, 100)} %" if rounded_up else f"{text} %"


def percent_beyond(share: float, limit: float) -> str:
    """A share that is beyond a limit, in percent with the digits that show it."""
    texts = (
        [f"{100.0 * one:.{digits}f}" for one in (share, limit)] for digits in range(_MOST_DIGITS)
    )
    return next((text for text, of_limit in texts if text != of_limit), f"{100.0 * share:.17g}")


def _nines(figures: int, of: int = 1) -> str:
    """The largest number below one, or a hundred, with so many figures."""
    decimals = figures if of == 1 else figures - 2
    return f"{of - 10.0**-decimals:.{decimals}f}"
