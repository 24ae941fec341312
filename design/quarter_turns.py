"""Should degrees become radians first, or be reduced first?

    python design/quarter_turns.py

Radians cannot hold a quarter turn. A car that goes "90 deg" would have a velocity along x of 6e-17
of its speed, and a zero in a report would read so.

What it showed (5000 angles of each kind): within 1e-6 degrees of a quarter turn the cosine is off
by up to 2e10 eps if radians come first, at a heading that was added up to some million degrees by
4e7 eps; reduced first, by less than 1 eps everywhere, and exactly 0 at the quarter turns. Decided:
whole turns and the nearest quarter turn are taken off in degrees, which rounds nothing; only the
rest is converted (``directions.from_degrees``).
"""

import math
import random

import measuring
import mpmath

from collisions.quantities.directions import from_degrees


def off(found, degrees):
    """How far a cosine is off, in eps of the exact one, and of 1 where that is 0."""
    with mpmath.workdps(60):
        exact = mpmath.cospi(mpmath.mpf(degrees) / 180)
        return float(abs(found - exact) / (abs(exact) or 1) * 2**52)


if __name__ == "__main__":
    rng = random.Random(5)
    count = 200 if measuring.QUICK else 5000
    families = {
        "quarter turns": [90.0 * rng.randint(-8, 8) for _ in range(count)],
        "within 1e-6 degrees of a quarter turn": [
            90.0 + rng.uniform(-1e-6, 1e-6) for _ in range(count)
        ],
        "anywhere in a turn": [rng.uniform(-180.0, 180.0) for _ in range(count)],
        "a heading that was added up": [rng.uniform(3e6, 4e6) for _ in range(count)],
    }
    print("worst error of the cosine in eps:   radians first, reduced first")
    for name, angles in families.items():
        plain = max(off(math.cos(math.radians(x)), x) for x in angles)
        reduced = max(off(from_degrees(x)[0], x) for x in angles)
        print(f"  {name:40s} {plain:12.3g} {reduced:12.3g}")
