"""The reverse solvers: from evidence after an impact to the speeds before it, one function for each kind of evidence."""

from ..provenance import Reconstruction
from .bayes import posterior
from .central import central
from .comparison import Comparison, compare
from .crush import crush_energy
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

__all__ = [
    "Comparison",
    "Fit",
    "MomentumSolution",
    "Posterior",
    "Reconstruction",
    "RecordedPulse",
    "central",
    "compare",
    "crush_energy",
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
