"""How a car turns while the impulse passes, as recorders see it: against quadrature of the force by
its definition.
"""

import math

import numpy as np
import pytest

from collisions.reconstruct.recorder_place import turning

_AT, _WEIGHTS = np.polynomial.legendre.leggauss(60)


def integral(function, low, high):
    """By 60 nodes, which is exact to rounding for what is integrated here."""
    half = 0.5 * (high - low)
    return half * sum(
        weight * function(low + half * (at + 1.0)) for at, weight in zip(_AT, _WEIGHTS, strict=True)
    )


def by_quadrature(e, duration, spin, change):
    """Cosine, sine, square of the rate, and turns before and after, from the force over time: a
    quarter of a sine up to maximum engagement, and another one down that takes e times as long and
    has e times the impulse.
    """
    turn = duration / (1.0 + e)
    quarter = 0.5 * math.pi

    def force(time):
        if time <= turn:
            return quarter / turn * math.sin(quarter * time / turn) / (1.0 + e)
        return quarter / turn * math.cos(quarter * (time - turn) / (turn * e)) / (1.0 + e)

    def passed(time):
        early = integral(force, 0.0, min(time, turn))
        return early + (integral(force, turn, time) if time > turn else 0.0)

    def rate(time):
        return spin + change * passed(time)

    def turned(time):
        return integral(rate, turn, time)

    def whole(function):
        return integral(function, 0.0, turn) + (integral(function, turn, duration) if e else 0.0)

    return (
        whole(lambda time: force(time) * math.cos(turned(time))),
        whole(lambda time: force(time) * math.sin(turned(time))),
        whole(lambda time: rate(time) ** 2),
        turned(0.0),
        turned(duration),
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("e", "duration", "spin", "change"),
    [(0.0, 0.12, 0.0, 6.0), (0.3, 0.15, -2.0, 5.0), (0.8, 0.1, 1.5, -7.0)],
)
def test_the_turn_of_a_car_is_that_of_the_force_over_time(e, duration, spin, change):
    found, _ = turning(e, duration, spin, change)
    assert [float(one) for one in found] == pytest.approx(
        by_quadrature(e, duration, spin, change), rel=1e-10, abs=1e-11
    )


@pytest.mark.parametrize("e", [-0.4, 0.0, 0.3])
def test_slopes_of_the_turn_are_its_changes(e):
    """Central differences of step 1e-5 err by 1e-10 of the third derivative."""
    given = (e, 0.15, -2.0)
    _, slopes = turning(*given, 5.0)
    one, other = turning(*given, 5.0 + 1e-5)[0], turning(*given, 5.0 - 1e-5)[0]
    assert [float(slope) for slope in slopes] == pytest.approx(
        [float((up - down) / 2e-5) for up, down in zip(one, other, strict=True)], abs=1e-9
    )


def test_an_incomplete_contact_is_engaged_the_most_as_it_ends():
    """Nothing turns after that; before, it turns by the rate it has by then."""
    found, _ = turning(-0.4, 0.1, 2.0, 3.0)
    assert float(found.after) == 0.0
    assert float(found.before) < -0.1 * 2.0
    # All of the impulse has passed at the end: at the rate of first contact and at that after.
    assert float(found.before) > -0.1 * 5.0


def test_a_car_that_does_not_turn_has_its_axes_where_they_are():
    found, _ = turning(0.2, 0.1, 0.0, 0.0)
    assert [float(one) for one in found] == pytest.approx([1.0, 0.0, 0.0, 0.0, 0.0], abs=1e-15)
