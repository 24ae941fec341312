"""Checks of an impact for oddities: findings, each with the measured value, its limit, and the
source of the limit.
"""

from .diagnosis import LIMITS, diagnose
from .finding import Finding, Limit
from .moves import Move

__all__ = ["LIMITS", "Finding", "Limit", "Move", "diagnose"]
