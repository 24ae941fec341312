"""The derivation of an answer with its numbers, step by step, for those who have to check it."""

from .explain import explain

__all__ = ["explain"]
