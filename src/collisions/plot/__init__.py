"""Pictures of an impact and of an uncertainty result, legible in black and white.

Needs matplotlib (``python -m pip install matplotlib``), which is imported when the first picture is
drawn. Every function draws on the ``axes`` given, or on a new figure, and returns the Axes.
``units`` is "si", "metric" (km/h, degrees, kN·s, kJ) or "us" (mph, ft, degrees, lbf·s, ft·lbf).
What was drawn can be found again by its ``get_gid()``, which is also its id in an SVG file.
"""

from .contact import force_time, pulse
from .energy import energy
from .evidence import corner, residuals
from .impulse_plane import impulse_plane
from .momentum import momentum
from .path import path
from .scene import scene
from .timeline import timeline
from .uncertainty import contributions, distribution

__all__ = [
    "contributions",
    "corner",
    "distribution",
    "energy",
    "force_time",
    "impulse_plane",
    "momentum",
    "path",
    "pulse",
    "residuals",
    "scene",
    "timeline",
]
