"""Step-by-step derivations of a result with its numbers, for readers who have to check it."""

from .explain import explain

__all__ = ["explain"]
