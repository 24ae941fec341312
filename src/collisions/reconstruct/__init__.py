"""The reverse solvers: from evidence after an impact to the speeds before it, one function for each kind of evidence.

``reconstruct.q`` has ``inline_closing_speed``, ``crush_energy`` and ``crush_delta_v``, which there return Quantities.
"""

from ..provenance import Reconstruction
from ..quantities import in_quantities
from .bayes import posterior
from .central import central
from .comparison import Comparison, compare
from .crush import crush_delta_v, crush_energy, crush_share
from .fit import fit
from .fit_result import Fit
from .inline import inline_closing_speed
from .momentum import momentum
from .momentum_solution import MomentumSolution
from .observed import friction, restitution
from .planar import planar
from .posterior_result import Posterior
from .recorded import RecordedPulse, recorded_pulse
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
