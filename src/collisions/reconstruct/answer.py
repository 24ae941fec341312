"""``ReverseAnswer``: what the answer of every reverse solver has, whatever else it has."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from ..quantities.units import Value


@runtime_checkable
class ReverseAnswer(Protocol):
    """The answer of a reverse solver: both speeds before the impact, and what was found.

    Each ``Impact`` of ``speeds``, ``planar`` and ``central`` is one, a ``MomentumSolution``, a
    ``Fit`` and a ``Posterior``, so that a table asks all of them alike. ``inline_closing_speed``
    gives one number, from which neither speed follows.

    Attributes
    ----------
    speed_a, speed_b : float or array [m/s]
        Speed of each vehicle before the impact, given or found; of a ``Posterior`` the mean. A
        ``MomentumSolution`` counts it along the course, below 0 backwards; the speed of an
        ``Impact`` is that of its motion, >= 0. None where a ``Fit`` or a ``Posterior`` has no such
        name.
    found : tuple of str
        Names of what was found, as opposed to what was given or observed: "speed_a",
        "restitution" and so on.

        .. versionadded:: 0.2.0

    Examples
    --------
    Example 2 of the paper, and a Golf and a Pinto (published answers 63.2 and 55.6 km/h):

    >>> from collisions import reconstruct
    >>> impact = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h")
    >>> courses = dict(course_a="270 deg", course_b=0.0)
    >>> after = dict(course_a_after="-30 deg", course_b_after="-40 deg")
    >>> solution = reconstruct.momentum(
    ...     1200, 1800, **courses, **after, speed_a_after="30 km/h", speed_b_after="50 km/h"
    ... )
    >>> answers: list[reconstruct.ReverseAnswer] = [impact, solution]
    >>> for answer in answers:
    ...     print(round(3.6 * answer.speed_a, 1), round(3.6 * answer.speed_b, 1), answer.found)
    80.0 0.0 ('restitution',)
    63.2 55.6 ('speed_a', 'speed_b')
    """

    @property
    def speed_a(self) -> Value | None: ...

    @property
    def speed_b(self) -> Value | None: ...

    @property
    def found(self) -> tuple[str, ...]: ...
