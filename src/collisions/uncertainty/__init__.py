"""Uncertainty of results: distributions and intervals of the inputs, and their propagation to every
output.
"""

from .distributions import (
    Censored,
    Distribution,
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
)
from .halved import Halved
from .one_sided import OneSided
from .output import Histogram, Output, Shares
from .propagation import propagate
from .result import Propagation

__all__ = [
    "Censored",
    "Distribution",
    "Halved",
    "Histogram",
    "Interval",
    "LogNormal",
    "Normal",
    "OneSided",
    "Output",
    "Propagation",
    "Samples",
    "Shares",
    "Triangular",
    "Uniform",
    "propagate",
]
