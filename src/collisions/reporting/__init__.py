"""Reports of one impact: a page for people, ending with the record from which it can be
made again.
"""

from .making import report
from .record import options, replay

__all__ = ["options", "replay", "report"]
