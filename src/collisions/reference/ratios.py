"""Impulse ratios found in tests."""

from __future__ import annotations

from .published import Published

OBLIQUE_TESTS = (
    "Rose, Fenton and Beauchamp, SAE 2006-01-0908, NHTSA tests 4363, 4364, 4438 and 4474, as in "
    "https://github.com/joe-cormier/pycrash (test_inputs_rose.py)"
)
SMALL_OVERLAP_TESTS = (
    "ten small-overlap barrier tests in https://github.com/joe-cormier/pycrash "
    "(projects/validation impact momentum/docs/Brach Matrix.xlsx)"
)
_OBLIQUE = "oblique frontal impact of car and car or sport utility vehicle, 35 mph each"
_SMALL_OVERLAP = "cars of 2008 to 2012 into a barrier, 40 mph, 20 or 25 percent of the width"

IMPULSE_RATIO_OBLIQUE = Published(
    name="impulse ratio, magnitude, oblique frontal tests",
    low=0.40,
    high=0.51,
    unit="",
    source=OBLIQUE_TESTS,
    domain=_OBLIQUE,
    quality="Four tests; the critical ratio of each, which follows from geometry and speeds: no measurement of its own.",
)
IMPULSE_RATIO_SMALL_OVERLAP = Published(
    name="impulse ratio, magnitude, small overlap with a barrier",
    low=1.57,
    high=2.05,
    unit="",
    source=SMALL_OVERLAP_TESTS,
    domain=_SMALL_OVERLAP,
    quality="Fitted to measured motion; above 1, because parts snag: no Coulomb friction.",
)
SHARE_OF_CRITICAL_OBLIQUE = Published(
    name="share of the critical impulse ratio, oblique frontal tests",
    low=1.0,
    high=1.0,
    unit="",
    source=OBLIQUE_TESTS,
    domain=_OBLIQUE,
    quality="Used by the authors for four tests; the delta-Vs that follow from it are their solution, not a measurement.",
)
SHARE_OF_CRITICAL_SMALL_OVERLAP = Published(
    name="share of the critical impulse ratio, small overlap with a barrier",
    low=0.823,
    high=1.0,
    unit="",
    source=SMALL_OVERLAP_TESTS,
    domain=_SMALL_OVERLAP,
    quality="Fitted to measured motion in ten tests.",
)
