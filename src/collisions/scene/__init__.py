"""A whole crash as one thing: vehicles, contacts and surfaces, from the start to the places of
rest.
"""

from .contact import Contact
from .mover import Mover
from .run import Run
from .scene import Scene

__all__ = ["Contact", "Mover", "Run", "Scene"]
