"""How sure an answer is: what is known of every input, and what follows for every output."""

from .distributions import Distribution, Interval, LogNormal, Normal, Samples, Triangular, Uniform
from .propagation import propagate
from .result import Histogram, Output, Propagation, Shares

__all__ = [
    "Distribution",
    "Histogram",
    "Interval",
    "LogNormal",
    "Normal",
    "Output",
    "Propagation",
    "Samples",
    "Shares",
    "Triangular",
    "Uniform",
    "propagate",
]
