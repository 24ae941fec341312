"""The reverse solvers: from evidence after an impact to the speeds before it, one function for each
kind of evidence.

``reconstruct.q`` has ``inline_closing_speed``, ``crush_energy`` and ``crush_delta_v``, which there
return Quantities.
"""

from ..estimate.compare import Comparison, compare
from ..estimate.fit import fit
from ..estimate.fit_result import Fit
from ..estimate.posterior import posterior
from ..estimate.posterior_result import Posterior
from ..impact.reconstruction import Reconstruction
from ..quantities.attributes import in_quantities
from .answer import ReverseAnswer
from .central import central
from .crush import crush_delta_v, crush_energy, crush_share
from .from_motions import friction, restitution
from .inline import inline_closing_speed
from .momentum import momentum
from .momentum_solution import MomentumSolution
from .planar import planar
from .recorder import RecordedPulse, recorded_pulse
from .speeds import speeds


class q:
    """The functions of this module that return a number with a unit, here returning a Quantity."""

    inline_closing_speed = staticmethod(in_quantities(inline_closing_speed, "m/s"))
    crush_energy = staticmethod(in_quantities(crush_energy, "J"))
    crush_delta_v = staticmethod(in_quantities(crush_delta_v, "m/s"))


__all__ = [
    "Comparison",
    "Fit",
    "MomentumSolution",
    "Posterior",
    "Reconstruction",
    "RecordedPulse",
    "ReverseAnswer",
    "central",
    "compare",
    "crush_delta_v",
    "crush_energy",
    "crush_share",
    "fit",
    "friction",
    "inline_closing_speed",
    "momentum",
    "planar",
    "posterior",
    "recorded_pulse",
    "restitution",
    "speeds",
]
