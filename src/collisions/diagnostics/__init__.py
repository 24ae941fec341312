"""What is odd about an impact: findings, each with what was measured, the limit it passes, and where the limit is from."""

from .diagnosis import LIMITS, diagnose
from .finding import Finding, Limit

__all__ = ["LIMITS", "Finding", "Limit", "diagnose"]
