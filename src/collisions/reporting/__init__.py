"""A report of one impact: a page for people, with the record at its end from which it can be made again."""

from .making import report
from .record import options, replay

__all__ = ["options", "replay", "report"]
