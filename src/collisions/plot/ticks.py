"""Tick labels as plain text; imported when something is drawn, as it needs matplotlib."""

from __future__ import annotations

from matplotlib.ticker import ScalarFormatter

_RAISED = str.maketrans("-\u22120123456789", "⁻⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class PlainTicks(ScalarFormatter):
    """Numbers in full, or beyond these powers of ten with one at the end of the axis.

    Math text would stand there as its source wherever formulas are switched off, as in a report,
    whose names are no formulas.
    """

    def __init__(self, in_full: tuple[int, int]) -> None:
        super().__init__(useOffset=False, useMathText=False)
        self.set_powerlimits(in_full)

    def get_offset(self) -> str:
        power = super().get_offset().partition("e")[2]
        return f"×10{power.translate(_RAISED)}" if power else ""
