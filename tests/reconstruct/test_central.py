"""reconstruct.central: all twenty questions against 50 digits, two answers, no answer, batches and
what comes back.

The reference solves the three equations that the knowns give by Newton's method in 50 digits, from
the forward equations (5), (6) and (8) alone; its Jacobian also says how well-posed each question
is. The bound is that of numerics section 5 for central impacts, 4 eps of every datum, carried
through that Jacobian. Data are, as there, the masses, the restitution, the energy and the
*differences* of the velocities: where those hardly tell the answer, no arithmetic can do better,
and the bound says so by itself.
"""

import itertools
import json
import math
import pickle
import random
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import collisions as col
from collisions import reconstruct
from strategies import other_registry

# These ask at the extremes on purpose; that a user is warned there has a test of its own.
extremes = pytest.mark.filterwarnings("ignore:.*the condition of .* is")

EPS = 2.0**-52
INF = math.inf
VELOCITIES = ("va", "vb", "va_after", "vb_after")
NAMES = (*VELOCITIES, "restitution", "energy_loss")
TWENTY = list(itertools.combinations(NAMES, 3))
# The velocity of one body before, of the other after, and the energy: a hyperbola cut by a line.
TWO_ROOTS = (("va", "vb_after", "energy_loss"), ("vb", "va_after", "energy_loss"))
twenty = pytest.mark.parametrize("names", TWENTY, ids="-".join)
some_of_twenty = pytest.mark.parametrize(
    "names",
    [
        names if number % 3 == 0 else pytest.param(names, marks=pytest.mark.slow)
        for number, names in enumerate(TWENTY)
    ],
    ids="-".join,
)
mp = mpmath.mp.clone()
mp.dps = 50


def refusal(call):
    with pytest.raises(col.CollisionsError) as caught:
        call()
    return caught.value


def outputs(impact):
    """The six numbers of an impact."""
    return {
        "va": impact.a.before.vx,
        "vb": impact.b.before.vx,
        "va_after": impact.a.after.vx,
        "vb_after": impact.b.after.vx,
        "restitution": impact.restitution,
        "energy_loss": impact.energy_loss,
    }


# Against 50 digits


@dataclass(frozen=True)
class Exact:
    """The six numbers in 50 digits, how far each may be off, and the condition; nothing if the
    question has no one answer.
    """

    values: dict[str, Any]
    within: dict[str, float]
    condition: float


def inverse_of(rows):
    """Inverse of a 3x3 matrix by columns, None if it has none."""
    (a, b, c), (d, e, f), (g, h, i) = rows
    cross = [
        (e * i - f * h, f * g - d * i, d * h - e * g),
        (h * c - i * b, i * a - g * c, g * b - h * a),
        (b * f - c * e, c * d - a * f, a * e - b * d),
    ]
    det = a * cross[0][0] + b * cross[0][1] + c * cross[0][2]
    return None if det == 0 else [tuple(part / det for part in column) for column in cross]


@cache
def solved_exactly(mass_a, mass_b, known, start):
    """Newton's method for va, vb and e from the forward equations, beginning at the impact that the
    knowns came from.
    """
    yields = [mp.mpf(0) if math.isinf(m) else 1 / mp.mpf(m) for m in (mass_a, mass_b)]
    share_a, share_b = (y / (yields[0] + yields[1]) for y in yields)
    mass = 1 / (yields[0] + yields[1])
    known = {name: mp.mpf(value) for name, value in known}
    va, vb, e = (mp.mpf(value) for value in start)
    for _ in range(8):
        g = va - vb
        loss = mass * (1 - e * e) * g * g / 2
        # Each number of the impact, and its derivatives by va, vb and e.
        to_a, to_b, by_g = share_a * (1 + e), share_b * (1 + e), mass * (1 - e * e) * g
        forward = {
            "va": (va, (mp.one, mp.zero, mp.zero)),
            "vb": (vb, (mp.zero, mp.one, mp.zero)),
            "va_after": (va - to_a * g, (1 - to_a, to_a, -share_a * g)),
            "vb_after": (vb + to_b * g, (to_b, 1 - to_b, share_b * g)),
            "restitution": (e, (mp.zero, mp.zero, mp.one)),
            "energy_loss": (loss, (by_g, -by_g, -mass * e * g * g)),
        }
        inverse = inverse_of([forward[name][1] for name in known])
        if inverse is None:
            return None
        misses = [value - forward[name][0] for name, value in known.items()]
        step = [
            sum(column[k] * miss for column, miss in zip(inverse, misses, strict=True))
            for k in range(3)
        ]
        va, vb, e = va + step[0], vb + step[1], e + step[2]
        if max(abs(step[0]), abs(step[1]), abs(step[2]) * g) < mp.mpf(10) ** -30 * g:
            break
    g, r = va - vb, e * (va - vb)

    # What (va, vb, e) make of each datum, by its relative change. Of the masses the shares change
    # by their product.
    def answer_to(column, size):
        return tuple(part * size for part in column)

    by_mass = []
    for sign, part in ((-1, share_a), (1, share_b)):
        moved = -sign * share_a * share_b * (1 + e) * g
        moves = [
            {"va_after": moved, "vb_after": moved, "energy_loss": part * loss}.get(name, mp.zero)
            for name in known
        ]
        by_mass.append(
            tuple(
                -sum(column[k] * move for column, move in zip(inverse, moves, strict=True))
                for k in range(3)
            )
        )
    raw = [answer_to(column, value) for column, value in zip(inverse, known.values(), strict=True)]
    condition = sum(abs(column[0]) + abs(column[1]) for column in (*raw, *by_mass)) / g
    # The size of a velocity as a datum is the largest difference it takes part in.
    velocities = [value for name, value in known.items() if name in VELOCITIES]
    sizes = [
        max(abs(value - v) for v in velocities) if name in VELOCITIES else value
        for name, value in known.items()
    ]
    data = [
        *(answer_to(column, size) for column, size in zip(inverse, sizes, strict=True)),
        *by_mass,
    ]
    off_a, off_b = (
        4 * EPS * (abs(v) + sum(abs(column[k]) for column in data)) for k, v in ((0, va), (1, vb))
    )
    off_g = 4 * EPS * (g + sum(abs(column[0] - column[1]) for column in data))
    off_r = 4 * EPS * (r + sum(abs(e * (column[0] - column[1]) + g * column[2]) for column in data))
    off_e = (off_r + e * off_g) / g
    # The velocities are rounded on their way out, but the forward solver works from the closing
    # speed: its own promises.
    change = (1 + e) * g
    within = {
        "va": off_a,
        "vb": off_b,
        "va_after": off_a + share_a * (off_g + off_r) + 5 * EPS * (abs(va) + share_a * change),
        "vb_after": off_b + share_b * (off_g + off_r) + 5 * EPS * (abs(vb) + share_b * change),
        "restitution": off_e,
        "energy_loss": 6 * EPS * loss + mass * (off_g * g * (1 - e * e) + g * g * e * off_e),
    }
    values = {name: forward[name][0] for name in NAMES}
    return Exact(values, {name: float(value) for name, value in within.items()}, float(condition))


FAMILIES = ("traffic", "mass ratio", "near speeds", "barrier a", "barrier b")
COUNT = 12


@cache
def starts(family):
    """Impacts of the forward solver: masses and its six numbers."""
    generator = random.Random(FAMILIES.index(family))
    found = []
    for _ in range(COUNT):
        mass_a, mass_b = generator.uniform(700, 2500), generator.uniform(700, 2500)
        va = generator.uniform(-40, 40)
        vb = va - generator.uniform(0.5, 50)
        if family == "mass ratio":
            mass_b = mass_a * 10 ** generator.uniform(-12, 12)
        elif family == "near speeds":
            va, vb = 60 + 1e-9 * generator.random(), 60 - 1e-9 * generator.random()
        elif family == "barrier a":
            mass_a = INF
        elif family == "barrier b":
            mass_b = INF
        impact = col.linear_central(
            col.Vehicle(mass=mass_a, vx=va),
            col.Vehicle(mass=mass_b, vx=vb),
            generator.uniform(0.02, 0.98),
        )
        found.append((mass_a, mass_b, outputs(impact)))
    return found


@cache
def cases(names, family):
    """The starts of a family, of each the knowns of one question, and its exact answer."""
    found = []
    for mass_a, mass_b, start in starts(family):
        known = {name: start[name] for name in names}
        begin = start["va"], start["vb"], start["restitution"]
        found.append(
            (
                mass_a,
                mass_b,
                start,
                known,
                solved_exactly(mass_a, mass_b, tuple(known.items()), begin),
            )
        )
    return found


def alone(names, family):
    """The six numbers found for each case, or the code of its refusal; of two answers the one that
    the knowns came from.
    """
    for mass_a, mass_b, start, known, _ in cases(names, family):
        try:
            yield outputs(reconstruct.central(mass_a, mass_b, **known))
        except col.AmbiguousSolutionError as error:
            yield min(
                map(outputs, error.solutions),
                key=lambda one: abs(one["va"] - start["va"]) + abs(one["vb"] - start["vb"]),
            )
        except col.NoSolutionError as error:
            yield error.code


def together(names, family):
    """The same in a batch; None for two answers, which a batch does not hold."""
    known = {name: np.array([case[3][name] for case in cases(names, family)]) for name in names}
    masses = (np.array([case[i] for case in cases(names, family)]) for i in (0, 1))
    found = reconstruct.central(*masses, **known, on_failure="nan")
    columns = {
        name: value.tolist()
        for name, value in outputs(found).items()
        if isinstance(value, np.ndarray)
    }
    assert columns.keys() == set(NAMES)
    for i, code in enumerate(found.status.tolist()):
        answer = {name: column[i] for name, column in columns.items()}
        yield (
            answer
            if code == 0
            else None
            if code == col.Status.AMBIGUOUS
            else col.Status(code).label
        )
        assert (code == 0) == bool(np.isfinite(list(answer.values())).all())
        assert (code == 0) == math.isfinite(found.reconstruction.condition[i])


@extremes
@pytest.mark.parametrize("way", [alone, together])
@pytest.mark.parametrize("family", FAMILIES)
@some_of_twenty
def test_the_impact_that_the_knowns_came_from_is_found(names, family, way):
    """Every case of every family; where the equations leave it open (a barrier keeps its velocity),
    it is refused.
    """
    for answer, (mass_a, mass_b, _, known, exact) in zip(
        way(names, family), cases(names, family), strict=True
    ):
        if exact is None:
            assert answer == "infinite_mass", (mass_a, mass_b, known)
        elif answer is None:
            assert math.isfinite(mass_a + mass_b)
            assert names in TWO_ROOTS
        else:
            assert isinstance(answer, dict), (answer, mass_a, mass_b, known)
            for name, value in answer.items():
                off = abs(float(value - exact.values[name]))
                assert off <= exact.within[name], (
                    name,
                    off / exact.within[name],
                    exact.condition,
                    mass_a,
                    mass_b,
                    known,
                )


@twenty
def test_the_condition_is_that_of_the_exact_equations(names):
    """To 1e-3 where it is below 1000: it is worked out from steps of 1e-6, of which a curved answer
    makes 1e-6 x 1000.
    """
    compared = 0
    for mass_a, mass_b, _, known, exact in cases(names, "traffic"):
        try:
            found = reconstruct.central(mass_a, mass_b, **known)
        except col.AmbiguousSolutionError:
            continue
        if exact.condition < 1e3:
            assert found.reconstruction.condition == pytest.approx(exact.condition, rel=1e-3)
            compared += 1
    assert compared >= COUNT // 4


@pytest.mark.slow
@extremes
def test_a_badly_posed_question_says_so():
    """Speeds of 60 m/s that differ by 1e-9: a relative error of a velocity is 1e10 times larger in
    the closing speed.
    """
    for names in TWENTY:
        for mass_a, mass_b, _, known, exact in cases(names, "near speeds"):
            try:
                found = reconstruct.central(mass_a, mass_b, **known)
            except col.AmbiguousSolutionError:
                continue
            if exact.condition > 1e9:
                assert found.reconstruction.condition > 1e7, (names, exact.condition)


# The ends of the range of restitution


def lost(names, mass_a, mass_b, e):
    """The code with which a plastic or an elastic impact cannot be told from these knowns, by what
    the equations leave open.
    """
    known = set(names)
    kept_by = ((mass_a, {"va", "va_after"}), (mass_b, {"vb", "vb_after"}))
    if any(math.isinf(mass) and kept <= known for mass, kept in kept_by):
        return (
            "infinite_mass"
            if len(known & set(VELOCITIES)) == 3 or not {"va", "vb"} <= known
            else None
        )
    if e == 1.0 and {"restitution", "energy_loss"} <= known:
        return "undetermined"
    if e == 0.0 and known == {"va_after", "vb_after", "restitution"}:
        return "inverse_e0"
    # A body that a plastic impact leaves with the velocity of a barrier, however fast it came.
    for barrier, kept, taken in ((mass_a, "va", "vb_after"), (mass_b, "vb", "va_after")):
        if e == 0.0 and math.isinf(barrier) and known == {kept, taken, "restitution"}:
            return "undetermined"
    return None


@pytest.mark.slow
@extremes
@pytest.mark.parametrize("e", [0.0, 1.0])
@pytest.mark.parametrize("family", ["traffic", "barrier a", "barrier b"])
@twenty
def test_plastic_and_elastic_impacts(names, family, e):
    """Found again with e of 0 or 1, which rounding must not turn into -1e-16 or NaN; or refused for
    what is lost.

    16 roundings of the data, times the condition; e is the square root of its rounding where the
    loss is all there was.
    """
    for mass_a, mass_b, start in starts(family):
        a, b = col.Vehicle(mass=mass_a, vx=start["va"]), col.Vehicle(mass=mass_b, vx=start["vb"])
        forward = outputs(col.linear_central(a, b, e))
        if e == 0.0 and not math.isfinite(mass_a + mass_b):
            # Exactly, which the forward solver meets to its rounding.
            forward["va_after"] = forward["vb_after"] = forward[
                "va" if math.isinf(mass_a) else "vb"
            ]
        known = {name: forward[name] for name in names}
        expected = lost(names, mass_a, mass_b, e)
        if expected:
            error = refusal(
                lambda mass_a=mass_a, mass_b=mass_b, known=known: reconstruct.central(
                    mass_a, mass_b, **known
                )
            )
            assert error.code == expected, (mass_a, mass_b, known)
            continue
        try:
            found = [reconstruct.central(mass_a, mass_b, **known)]
        except col.AmbiguousSolutionError as error:
            assert e == 0.0
            found = error.solutions
        near = min(
            found,
            key=lambda one: abs(one.a.before.vx - start["va"]) + abs(one.b.before.vx - start["vb"]),
        )
        condition = near.reconstruction.condition
        within = 16 * EPS * (1 + condition)
        assert abs(near.a.before.vx - start["va"]) <= within * near.closing_speed, (
            mass_a,
            mass_b,
            known,
        )
        assert abs(near.b.before.vx - start["vb"]) <= within * near.closing_speed, (
            mass_a,
            mass_b,
            known,
        )
        rooted = e == 0.0 and names == ("va", "vb", "energy_loss")
        assert abs(near.restitution - e) <= (4 * math.sqrt(EPS) if rooted else 8 * within), (
            mass_a,
            mass_b,
            known,
        )


# Two answers


def roots_by_search(mass_a, mass_b, names, known):
    """How often the loss, as the restitution goes from 0 to 1 in steps, passes the one given: each
    a root.
    """
    share_a, share_b = mass_b / (mass_a + mass_b), mass_a / (mass_a + mass_b)
    e = np.linspace(0.0, 1.0, 20001)
    p, q = (share_a, share_b) if names == TWO_ROOTS[0] else (share_b, share_a)
    difference = (
        known["va"] - known["vb_after"]
        if names == TWO_ROOTS[0]
        else known["va_after"] - known["vb"]
    )
    with np.errstate(divide="ignore"):
        closing = difference / (p - q * e)
        mismatch = mass_a * share_a / 2 * (1 - e**2) * closing**2 - known["energy_loss"]
    fine = (closing[:-1] > 0) & (closing[1:] > 0)
    return int(np.count_nonzero(fine & (np.sign(mismatch[:-1]) != np.sign(mismatch[1:]))))


@pytest.mark.slow
@pytest.mark.parametrize("names", TWO_ROOTS, ids="-".join)
def test_every_root_is_found_and_no_more(names):
    """As many as a search over the restitution shows; both run forward to what was known, and one
    is what it came from.
    """
    generator = random.Random(7)
    counted = {1: 0, 2: 0}
    for _ in range(300):
        mass_a, mass_b = generator.uniform(700, 2500), generator.uniform(700, 2500)
        va = generator.uniform(-20, 40)
        vb = va - generator.uniform(1, 40)
        e = generator.uniform(0.0, 1.0)
        start = outputs(
            col.linear_central(col.Vehicle(mass=mass_a, vx=va), col.Vehicle(mass=mass_b, vx=vb), e)
        )
        known = {name: start[name] for name in names}
        try:
            found = (reconstruct.central(mass_a, mass_b, **known),)
        except col.AmbiguousSolutionError as error:
            found, text, code = error.solutions, str(error), error.code
        if len(found) > 1:
            assert isinstance(found, tuple)
            assert code == "ambiguous"
            for solution in found:
                sought = "vb" if "va" in names else "va"
                speed = getattr(solution, sought[1]).before.vx
                assert f"{sought} = {speed:.6g} m/s with e = {solution.restitution:.4g}" in text
        assert len(found) == roots_by_search(mass_a, mass_b, names, known), (mass_a, mass_b, known)
        counted[len(found)] += 1
        for solution in found:
            again = outputs(
                col.linear_central(solution.a.before, solution.b.before, solution.restitution)
            )
            for name, value in known.items():
                # 64 roundings of the largest term: near a double root the two speeds move much,
                # what they lead to does not.
                scale = (
                    value if name == "energy_loss" else abs(va) + abs(vb) + solution.closing_speed
                )
                assert (
                    abs(again[name] - value)
                    <= 64 * EPS * scale * (1 + solution.closing_speed / (va - vb)) ** 2
                )
    assert min(counted.values()) > 20


def test_a_third_velocity_decides_between_two_answers():
    """Each solution is what its own velocities give, and pickles with the error."""
    with pytest.raises(
        col.AmbiguousSolutionError, match="two impacts fit va, vb_after, energy_loss"
    ) as caught:
        reconstruct.central(1500.0, 2500.0, va=25.0, vb_after=15.0, energy_loss=150e3)
    # With shares 5/8 and 3/8 the loss rises to its most at e = 3/5 and falls from there: a root on
    # either side.
    low, high = sorted(caught.value.solutions, key=lambda one: one.restitution)
    assert low.restitution < 0.6 < high.restitution
    for one in (low, high):
        begin = one.a.before.vx, one.b.before.vx, one.restitution
        exact = solved_exactly(
            1500.0, 2500.0, (("va", 25.0), ("vb_after", 15.0), ("energy_loss", 150e3)), begin
        )
        assert one.reconstruction.condition == pytest.approx(exact.condition, rel=1e-4)
    for one in (low, high):
        decided = reconstruct.central(1500.0, 2500.0, va=25.0, vb=one.b.before.vx, vb_after=15.0)
        assert decided.restitution == pytest.approx(one.restitution, rel=1e-12)
    again = pickle.loads(pickle.dumps(caught.value))
    assert isinstance(again, col.AmbiguousSolutionError)
    assert again.solutions == caught.value.solutions


@pytest.mark.parametrize(
    ("masses", "known", "said"),
    [
        ((1000.0, 1500.0), {"va": 20.0, "vb": 0.0}, "va_after = 2 m/s with e = 0.5"),
        ((INF, 600.0), {"va": 20.0, "vb": 0.0}, "vb_after = 30 m/s with e = 0.5"),
        ((1500.0, 2500.0), {"va": 25.0, "vb_after": 15.0}, "vb = "),
        ((2500.0, 1500.0), {"vb": 0.0, "va_after": 10.0}, "va = "),
    ],
)
def test_two_answers_are_told_apart_by_what_is_sought(masses, known, said):
    """With e = 1/2 of either sign, 3/4 of 600 x 20^2 / 2 is lost."""
    error = refusal(lambda: reconstruct.central(*masses, **known, energy_loss=9e4, incomplete=True))
    assert error.code == "ambiguous"
    one, other = str(error).partition(": ")[2].partition("; both")[0].split(" or ")
    assert one != other
    assert one.startswith(said)
    assert other.startswith(said.partition("=")[0])
    decides = str(error).partition("what decides is ")[2].split(" ")
    for name in ("va", "vb", "va_after", "vb_after"):
        when = "after" if name.endswith("after") else "before"
        speeds = {getattr(getattr(one, name[1]), when).vx for one in error.solutions}
        assert (name in decides) == (len(speeds) > 1 and name not in known)


def test_two_answers_near_each_other_are_written_with_figures_that_differ():
    """Near the most that these speeds can lose, at e = 3/5."""
    most = 937.5 * 10.0**2 / 2.0 / ((5 / 8) ** 2 - (3 / 8) ** 2)
    for less in (1e-6, 1e-8, 1e-10):
        known = {"va": 25.0, "vb_after": 15.0, "energy_loss": most * (1.0 - less)}
        error = refusal(lambda known=known: reconstruct.central(1500.0, 2500.0, **known))
        both = str(error).partition(": ")[2].partition("; both")[0].split(" or ")
        speeds, restitutions = zip(*(one.split(" with ") for one in both), strict=True)
        assert len(set(speeds)) == len(set(restitutions)) == 2


def test_two_answers_in_a_batch():
    """NaN with the status; asked to raise, the error of the case alone, with both answers."""
    question = {"va": 25.0, "vb_after": 15.0, "energy_loss": np.array([150e3, 1e3])}
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases .*1 ambiguous"):
        found = reconstruct.central(1500.0, 2500.0, **question)
    assert found.status.tolist() == [col.Status.AMBIGUOUS, col.Status.OK]
    assert np.isnan(found.closing_speed).tolist() == [True, False]
    with pytest.raises(col.AmbiguousSolutionError, match=r"^case 0: two impacts fit") as caught:
        reconstruct.central(1500.0, 2500.0, **question, on_failure="raise")
    assert len(caught.value.solutions) == 2


# No answer


M = (1000.0, 1500.0)  # shares 3/5 and 2/5, reduced mass 600 kg
HEAVY = (2500.0, 1000.0)  # shares 2/7 and 5/7
REFUSED = [
    # More energy than there is: 600 x 20^2 / 2, and from a change of velocity of 15 = 3/5 (1+e) g,
    # 600 x 25^2 / 2.
    ("contradictory", M, {"va": 20, "vb": 0, "energy_loss": 2e5},
        ["no impact fits", "at least 0 J and at most 120000 J"]),
    ("not_separating", M, {"va": 20, "va_after": 5, "energy_loss": 2e5},
        ["still approach", "at most 187500 J"]),
    ("not_separating", M, {"vb": 0, "vb_after": 10, "energy_loss": 2e6},
        ["still approach", "at most 187500 J"]),
    # The bounce at e = q/p = 2/3 loses most: 600 x 10^2 / 2 / (3/5 - 2/5).
    ("contradictory", M, {"va": 20, "vb_after": 10, "energy_loss": 2e5},
        ["at least 0 J and at most 150000 J"]),
    # Less than momentum demands: even a plastic impact with 10 = 2/7 g loses 5000/7 x 35^2 / 2.
    ("not_separating", HEAVY, {"va": 20, "vb_after": 10, "energy_loss": 1e5},
        ["at least 437500 J", "restitution"]),
    ("not_separating", (1000, 2500), {"vb": -20, "va_after": -10, "energy_loss": 1e5},
        ["at least 437500 J"]),
    ("contradictory", (1000, 1000), {"va": 10, "vb_after": 10, "energy_loss": 1e4},
        ["at least 0 J and at most 0 J"]),
    ("contradictory", M, {"va": 10, "va_after": 10, "energy_loss": 10}, ["at most 0 J"]),
    ("contradictory", M, {"va": 20, "restitution": 1, "energy_loss": 10},
        ["loses no energy", "two velocities"]),
    # Gain: 19 = 2/5 (1+e) 20.
    ("contradictory", M, {"va": 20, "vb": 0, "vb_after": 19},
        ["restitution of 1.375", "gain energy"]),
    ("contradictory", (1000, 1000), {"va": 10, "vb_after": 8, "restitution": 1},
        ["va and vb_after are equal", "differ by 2 m/s"]),
    ("contradictory", (INF, 1000), {"va": 0, "vb_after": 3, "restitution": 0},
        ["va and vb_after are equal", "differ by -3 m/s"]),
    # Parted bodies still approaching: 1 = 2/5 (1+e) 20.
    ("not_separating", M, {"va": 20, "vb": 0, "vb_after": 1},
        ["still approach", "restitution -0.875", "pass through"]),
    ("not_separating", M, {"va_after": 12, "vb_after": 10, "energy_loss": 10},
        ["va_after = 12", "still approach"]),
    # No approach.
    ("separating", M, {"va": 10, "vb": 20, "restitution": 0.1},
        ["closing speed of -10 m/s", "from A to B", "exchange A and B"]),
    ("separating", M, {"va": 10, "vb": 20, "energy_loss": 10}, ["closing speed of -10 m/s"]),
    ("separating", M, {"va": 10, "va_after": 12, "restitution": 0.1}, ["moved apart"]),
    ("separating", M, {"va": 10, "va_after": 12, "energy_loss": 10}, ["bodies moved apart"]),
    ("separating", M, {"va": 10, "vb_after": 20, "energy_loss": 1e9}, ["no approach"]),
    ("separating", M, {"va": 10, "vb_after": 20, "energy_loss": 100}, ["bodies moved apart"]),
    ("separating", M, {"va_after": 12, "vb_after": 10, "restitution": 0.1},
        ["closing speed of -20 m/s"]),
    ("no_closing", M, {"va": 10, "vb": 10, "restitution": 0.1},
        ["closing speed of 0", "no impact"]),
    ("no_closing", M, {"va": 10, "va_after": 10, "restitution": 0.1}, ["closing speed of 0"]),
    ("no_closing", M, {"va": 10, "va_after": 10, "energy_loss": 0}, ["closing speed of 0"]),
    ("no_closing", M, {"va_after": 12, "vb_after": 12, "restitution": 0.1}, ["closing speed of 0"]),
    ("no_closing", M, {"va": 20, "restitution": 0.5, "energy_loss": 0}, ["closing speed of 0"]),
    # What leaves no trace.
    ("inverse_e0", M, {"va_after": 12, "vb_after": 12, "restitution": 0},
        [("va_after = 12 m/s, vb_after = 12 m/s, restitution = 0: after a plastic impact "
          "(restitution = 0) both have one velocity, and nothing is left of the closing speed"),
          "energy_loss, va or vb"]),
    ("inverse_e0", M, {"va_after": 9, "vb_after": 10, "restitution": 0},
        ["va_after = 9 m/s, vb_after = 10 m/s",
            "both have one velocity (here vb_after - va_after is 1 m/s, which contradicts that)",
            "instead of restitution"]),
    ("undetermined", M, {"vb": 20, "restitution": 1, "energy_loss": 0},
        ["any closing speed", "another velocity"]),
    ("undetermined", (1000, 1000), {"va": 10, "vb_after": 10, "restitution": 1},
        ["any closing speed"]),
    ("undetermined", (1000, 1000), {"vb": 10, "va_after": 10, "energy_loss": 0},
        ["any closing speed"]),
    ("undetermined", (INF, 1000), {"va": 3, "vb_after": 3, "restitution": 0},
        ["any closing speed"]),
    ("infinite_mass", (INF, 1000), {"va": 20, "va_after": 20, "restitution": 0.5},
        ["infinite mass keeps its velocity", "the other body"]),
    ("infinite_mass", (1000, INF), {"vb": 0, "vb_after": 0, "energy_loss": 5e4},
        ["infinite mass keeps its velocity"]),
    ("infinite_mass", (INF, 1000), {"va": 20, "va_after": 20, "vb": 0},
        ["infinite mass keeps its velocity"]),
    ("immovable", (INF, INF), {"va": 20, "vb": 0, "restitution": 0.5},
        ["both masses are infinite", "finite mass"]),
    # Arguments.
    ("not_positive", (0, 1000), {"va": 20, "vb": 0, "restitution": 0.5}, ["mass_a must be > 0"]),
    ("not_positive", (1000, -INF), {"va": 20, "vb": 0, "restitution": 0.5}, ["mass_b must be > 0"]),
    ("bad_restitution", M, {"va": 20, "vb": 0, "restitution": 1 + EPS},
        ["restitution must be from 0 to 1"]),
    ("bad_restitution", M, {"va": 20, "vb": 0, "restitution": -5e-324},
        ["restitution must be from 0 to 1"]),
    ("negative_energy", M, {"va": 20, "vb": 0, "energy_loss": "-1 kJ"},
        ["energy_loss must be >= 0, got '-1 kJ'"]),
    ("not_finite", M, {"va": math.nan, "vb": 0, "restitution": 0.5}, ["va is NaN"]),
    ("not_finite", M, {"va": INF, "vb": 0, "restitution": 0.5}, ["va must be finite"]),
    ("not_finite", M, {"va": 20, "vb": 0, "energy_loss": INF}, ["energy_loss must be finite"]),
    ("bad_units", M, {"va": "20 kg", "vb": 0, "restitution": 0.5}, ["va: '20 kg'", "m/s"]),
    ("not_a_number", M, {"va": True, "vb": 0, "restitution": 0.5}, ["va must be a number"]),
    ("out_of_range", M, {"va": 1e200, "vb": 0, "restitution": 0.5}, ["not a finite number"]),
    ("bad_shape", M, {"va": np.ones(2), "vb": np.ones(3), "restitution": 0.5},
        ["va (2,), vb (3,)"]),
    # How many.
    ("too_few_knowns", M, {"va": 20, "vb": 0},
        ["exactly 3 of va, vb, va_after, vb_after, restitution, energy_loss", "got 2 (va, vb)",
            "give 1 of va_after, vb_after, restitution, energy_loss"]),
    ("too_few_knowns", M, {}, ["got 0 (none)", "give 3 of va, vb"]),
    ("too_many_knowns", M, {"va": 20, "vb": 0, "vb_after": 5, "restitution": 0.5},
        ["got 4 (va, vb, vb_after, restitution)", "leave out 1"]),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "masses", "known", "said"),
    REFUSED,
    ids=[f"{i}-{row[0]}" for i, row in enumerate(REFUSED)],
)
def test_refusals_say_why(code, masses, known, said):
    """The error of its family, with the numbers in its message; it survives pickling."""
    error = refusal(lambda: reconstruct.central(*masses, **known))
    assert error.code == code
    kind = {
        "separating": col.NoImpactError,
        "no_closing": col.NoImpactError,
        "bad_shape": col.ShapeError,
        "bad_units": col.UnitsError,
    }
    for name in (
        "contradictory",
        "not_separating",
        "inverse_e0",
        "undetermined",
        "infinite_mass",
        "immovable",
    ):
        kind[name] = col.NoSolutionError
    assert type(error) is kind.get(code, col.InputError)
    assert error.solutions == ()
    for part in said:
        assert part in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.code) == (type(error), str(error), code)


def test_the_closing_speed_comes_with_the_refusal():
    """NoImpactError carries it, as from the forward solvers."""
    assert (
        refusal(lambda: reconstruct.central(*M, va=10.0, vb=20.0, restitution=0.1)).closing_speed
        == -10.0
    )


def test_all_wrong_arguments_are_named_at_once():
    """One error for every argument that cannot be used."""
    error = refusal(
        lambda: reconstruct.central(-1.0, "2 m", va=math.nan, restitution=3.0, energy_loss=-1.0)
    )
    assert isinstance(error, col.UnitsError)
    for name in ("mass_a", "mass_b", "va", "restitution", "energy_loss"):
        assert f"- {name}" in str(error)


@pytest.mark.parametrize(
    ("masses", "names", "largest"), [(M, ("va", "vb"), 120e3), (M, ("va", "vb_after"), 150e3)]
)
def test_the_limit_that_the_message_names_is_the_limit(masses, names, largest):
    """A millionth below it is solved, a millionth above is refused."""
    known = dict(zip(names, (20.0, 0.0 if names[1] == "vb" else 10.0), strict=True))
    below = reconstruct.central(
        *masses, **known, energy_loss=np.full(1, largest * (1 - 1e-6)), on_failure="nan"
    )
    assert below.status.tolist() == [col.Status.OK if names[1] == "vb" else col.Status.AMBIGUOUS]
    assert (
        refusal(
            lambda: reconstruct.central(*masses, **known, energy_loss=largest * (1 + 1e-6))
        ).code
        == "contradictory"
    )


def test_the_least_energy_is_the_least():
    """A plastic impact at 437.5 kJ; a millionth less is refused."""
    least = reconstruct.central(*HEAVY, va=20.0, vb_after=10.0, energy_loss=437500.0 * (1 + 1e-6))
    assert least.restitution == pytest.approx(0.0, abs=1e-5)
    assert refusal(
        lambda: reconstruct.central(
            *HEAVY, va=20.0, vb_after=10.0, energy_loss=437500.0 * (1 - 1e-6)
        )
    )


# Batches


def test_a_refused_case_leaves_its_neighbours_alone():
    """Each case gets the status of its own refusal and NaN; the others are bit for bit what they
    are without it.
    """
    va = np.array([20.0, np.nan, 20.0, -5.0, 20.0, 20.0, 20.0])
    vb = np.array([0.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0])
    e = np.array([0.5, 0.5, 2.0, 0.5, 0.5, 0.5, 0.25])
    mass = np.array([1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 0.0, 1000.0])
    with pytest.warns(col.CollisionsWarning, match="5 of 7 cases") as caught:
        found = reconstruct.central(mass, 1500.0, va=va, vb=vb, restitution=e)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    labels = [
        "ok",
        "not_finite",
        "bad_restitution",
        "separating",
        "no_closing",
        "not_positive",
        "ok",
    ]
    assert [col.Status(code).label for code in found.status.tolist()] == labels
    good = np.array([label == "ok" for label in labels])
    for name in ("closing_speed", "energy_loss", "normal_impulse"):
        assert (np.isfinite(getattr(found, name)) == good).all()
    assert (np.isfinite(found.reconstruction.condition) == good).all()
    alone = reconstruct.central(mass[good], 1500.0, va=va[good], vb=vb[good], restitution=e[good])
    assert alone.a.after.vx.tolist() == found.a.after.vx[good].tolist()
    with pytest.raises(col.InputError, match=r"^case 1: ") as first:
        reconstruct.central(mass, 1500.0, va=va, vb=vb, restitution=e, on_failure="raise")
    assert first.value.code == "not_finite"
    # The sentence of a case is that of the case alone: it names the argument.
    with pytest.raises(col.InputError, match=r"^case 1: vb_after must be finite, got inf"):
        reconstruct.central(
            1000.0, 1500.0, va=12.0, vb=3.0, vb_after=np.array([9.0, math.inf]), on_failure="raise"
        )
    with pytest.raises(col.InputError, match=r"^case 0: mass_a must be > 0 .*got 0\.0"):
        reconstruct.central(
            np.array([0.0, 900.0]),
            1500.0,
            va=12.0,
            restitution=0.1,
            energy_loss=900.0,
            on_failure="raise",
        )


@pytest.mark.parametrize(("code", "masses", "known", "said"), [row for row in REFUSED if row[0] in (
    "contradictory", "not_separating", "separating", "no_closing", "inverse_e0", "undetermined",
    "infinite_mass", "immovable")])  # fmt: skip
def test_every_refusal_has_its_status_in_a_batch(code, masses, known, said):
    """The same code as alone; asked to raise, the same error with the same numbers."""
    batch = {name: np.full(2, float(value)) for name, value in known.items()}
    found = reconstruct.central(*masses, **batch, on_failure="nan")
    assert [col.Status(status).label for status in found.status.tolist()] == [code] * 2
    assert np.isnan(found.energy_loss).all()
    error = refusal(lambda: reconstruct.central(*masses, **batch, on_failure="raise"))
    assert error.code == code
    assert str(error).startswith("case 0: ")
    for part in said:
        assert part in str(error)


def test_arguments_broadcast():
    """Two by three cases, each as if alone."""
    found = reconstruct.central(
        np.array([[900.0], [1800.0]]),
        1000.0,
        va=np.array([10.0, 20.0, 30.0]),
        vb=0.0,
        vb_after=8.0,
        on_failure="nan",
    )
    assert found.restitution.shape == (2, 3)
    assert found.reconstruction.condition.shape == (2, 3)
    one = reconstruct.central(1800.0, 1000.0, va=10.0, vb=0.0, vb_after=8.0)
    assert found.restitution[1, 0] == pytest.approx(one.restitution, rel=8 * EPS)
    assert not found.restitution.flags.writeable


@pytest.mark.parametrize("e", [0.0, 0.3, 1.0])
@twenty
def test_float32_stays_float32(names, e):
    """In and out in single precision, worked out in double: as near as the knowns, rounded to 24
    bits, allow.
    """
    start = outputs(
        col.linear_central(col.Vehicle(mass=1100.0, vx=22.0), col.Vehicle(mass=950.0, vx=4.0), e)
    )
    if lost(names, 1100.0, 950.0, e):
        return
    known = {name: np.array([start[name]] * 2, dtype=np.float32) for name in names}
    found = reconstruct.central(1100.0, 950.0, **known, on_failure="nan")
    for value in (
        found.closing_speed,
        found.restitution,
        found.b.after.vx,
        found.energy_loss,
        found.reconstruction.condition,
    ):
        assert value.dtype == np.float32
    if names in TWO_ROOTS and found.status[0] == col.Status.AMBIGUOUS:
        return
    assert found.status.tolist() == [0, 0], (names, found.status)
    single = 2.0**-23
    within = 8 * single * (1 + float(found.reconstruction.condition[0]))
    assert abs(float(found.a.before.vx[0]) - 22.0) <= within * 18.0
    assert abs(float(found.b.before.vx[0]) - 4.0) <= within * 18.0
    rooted = e == 0.0 and names == ("va", "vb", "energy_loss")
    assert abs(float(found.restitution[0]) - e) <= (4 * math.sqrt(single) if rooted else 4 * within)


# Units, and what comes back


@extremes
@twenty
def test_a_record_and_a_case_of_a_batch_keep_the_digits(names):
    """What leaves as a record or as one of a batch is the closing speed found, not the difference
    of rounded velocities.
    """
    mass_a, mass_b, start, known, _ = cases(names, "near speeds")[0]
    try:
        found = reconstruct.central(mass_a, mass_b, **known)
    except col.AmbiguousSolutionError as error:
        found = min(error.solutions, key=lambda one: abs(one.restitution - start["restitution"]))
    velocity = found.reconstruction.contact_velocity
    assert (found.closing_speed, found.slip_before) == velocity
    again = col.Impact.from_dict(json.loads(json.dumps(found.to_dict())))
    assert again == found
    assert again.closing_speed == found.closing_speed
    many = reconstruct.central(
        mass_a,
        mass_b,
        **{name: np.array([value, value]) for name, value in known.items()},
        on_failure="nan",
    )
    assert many.ok.all() or names in TWO_ROOTS
    if many.ok.all():
        assert many.case(1).closing_speed == many.closing_speed[1] == velocity[0]
    # Velocities that were changed in the record are taken as they stand.
    record = found.to_dict()
    record["inputs"]["a"]["vx"] += 1.0
    assert col.Impact.from_dict(record).closing_speed == pytest.approx(
        1.0 + found.closing_speed, rel=1e-12
    )


@pytest.mark.slow
def test_example_2_of_the_paper():
    """1100 kg at 80 km/h into 950 kg at rest, which leaves at 60: 310/11 km/h and 35/88 exactly;
    7.82 m/s and 0.40 in print.
    """
    found = reconstruct.central("1100 kg", "950 kg", va="80 km/h", vb="0 km/h", vb_after="60 km/h")
    assert found.a.after.q.vx.m_as("km/h") == pytest.approx(310 / 11, rel=1e-14)
    assert found.restitution == pytest.approx(35 / 88, rel=1e-14)
    # The paper calculates with speeds rounded to two decimals.
    assert found.a.after.vx == pytest.approx(7.82, abs=1e-2)
    assert found.restitution == pytest.approx(0.40, abs=5e-3)
    columns = found.to_columns()
    forward = col.linear_central(found.a.before, found.b.before, found.restitution).to_columns()
    assert {name: columns[name] for name in forward} == forward
    # The same impact from any other three of its six numbers.
    known = outputs(found)
    for names in TWENTY:
        try:
            again = reconstruct.central(1100.0, 950.0, **{name: known[name] for name in names})
        except col.AmbiguousSolutionError as error:
            again = min(error.solutions, key=lambda one: abs(one.restitution - 35 / 88))
        assert again.restitution == pytest.approx(35 / 88, rel=1e-13)
        assert again.closing_speed == pytest.approx(80 / 3.6, rel=1e-13)


def test_published_impacts_backwards():
    """L01 railroad cars, and L03, whose print (80 m/s) lost a sign: 80/3 m/s leaves the van at the
    15 m/s that were seen.
    """
    published = Path(__file__).parents[2] / "validation" / "data" / "worked_examples.json"
    cases = {case["id"]: case for case in json.loads(published.read_text("utf-8"))}

    def number(case, kind, name):
        return cases[case][kind][name]["value"]

    masses = number("L01", "inputs", "m_A"), number("L01", "inputs", "m_B")
    cars = reconstruct.central(
        *masses,
        va=number("L01", "inputs", "v_A"),
        vb=0.0,
        vb_after=number("L01", "inputs", "v_B_after"),
    )
    assert cars.restitution == pytest.approx(number("L01", "published_outputs", "e"), rel=1e-14)
    assert cars.a.after.vx == pytest.approx(
        number("L01", "published_outputs", "v_A_after"), rel=1e-13
    )
    masses = number("L03", "inputs", "m1"), number("L03", "inputs", "m2")
    van = reconstruct.central(
        *masses,
        vb=0.0,
        vb_after=number("L03", "inputs", "v2_after"),
        restitution=number("L03", "inputs", "e"),
    )
    assert van.a.before.vx == pytest.approx(80 / 3, rel=1e-14)
    # Half a unit in the last digit of the figures worked out apart.
    assert van.a.before.vx == pytest.approx(
        number("L03", "recomputed_outputs", "v1_before"), abs=5e-5
    )
    assert van.a.after.vx == pytest.approx(
        number("L03", "recomputed_outputs", "v1_after"), abs=5e-5
    )
    assert abs(van.a.before.vx - number("L03", "published_outputs", "v1_before")) > 50
    # And the printed speeds are no impact: the car would come out of the front of the van.
    printed = {"va": 80.0, "va_after": 55.0, "vb_after": 15.0}
    assert refusal(lambda: reconstruct.central(*masses, **printed)).code == "not_separating"


def test_units_of_arguments():
    """Texts, Quantities of another registry and bare SI numbers are one question."""
    other = other_registry()
    plain = reconstruct.central(1000.0, 1500.0, va=20.0, vb=0.0, energy_loss=50e3)
    for known in (
        {"va": "72 km/h", "vb": "0 mph", "energy_loss": "50 kJ"},
        {
            "va": other.Quantity(72.0, "km/h"),
            "vb": other.Quantity(0.0, "m/s"),
            "energy_loss": other.Quantity(50.0, "kJ"),
        },
    ):
        found = reconstruct.central("1 tonne", other.Quantity(1.5e6, "g"), **known)
        assert found.restitution == pytest.approx(plain.restitution, rel=4 * EPS)
        assert found.q.energy_loss.m_as("kJ") == pytest.approx(50.0, rel=8 * EPS)
    many = reconstruct.central(
        1000.0, 1500.0, va=other.Quantity(np.array([72.0, 36.0]), "km/h"), vb=0.0, restitution=0.5
    )
    assert many.closing_speed.tolist() == pytest.approx([20.0, 10.0], rel=4 * EPS)


def answers():
    """A single case, a batch and a batch with a refused case, all from here."""
    e = np.array([0.5, 2.0, 0.1])
    return [
        reconstruct.central(1100.0, 950.0, va=22.0, vb=0.0, vb_after=16.0),
        reconstruct.central(1100.0, INF, va=np.array([22.0, 11.0]), vb=0.0, restitution=0.1),
        reconstruct.central(
            1100.0, 950.0, vb=0.0, restitution=e, energy_loss=40e3, on_failure="nan"
        ),
    ]


@pytest.mark.parametrize("which", range(3))
def test_where_an_impact_came_from(which):
    """Method, knowns and condition stay with it, through strict JSON, pickling and into the columns
    of a table.
    """
    found = answers()[which]
    known = [
        ("va", "vb", "vb_after"),
        ("va", "vb", "restitution"),
        ("vb", "restitution", "energy_loss"),
    ][which]
    assert found.reconstruction.method == "central"
    assert found.reconstruction.known == known
    again = col.Impact.from_dict(json.loads(json.dumps(found.to_dict(), allow_nan=False)))
    pickled = pickle.loads(pickle.dumps(found))
    for copy in (again, pickled):
        assert copy == found
        assert copy.reconstruction.known == known
        np.testing.assert_array_equal(copy.reconstruction.condition, found.reconstruction.condition)
        np.testing.assert_array_equal(copy.status, found.status)
    columns = found.to_columns()
    assert columns["reconstruction.condition"] == pytest.approx(
        np.atleast_1d(found.reconstruction.condition).tolist(), nan_ok=True
    )
    assert columns["a.before.vx"] == pytest.approx(
        np.atleast_1d(found.a.before.vx).tolist(), nan_ok=True
    )
    assert len({len(column) for column in columns.values()}) == 1
    with pytest.raises(AttributeError):
        found.reconstruction.condition = 0.0


def test_an_impact_found_forwards_came_from_nowhere():
    """None, and no column for it."""
    forward = col.linear_central(col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0), 0.5)
    assert forward.reconstruction is None
    assert "reconstruction.condition" not in forward.to_columns()


def test_a_single_refused_case_may_be_answered_with_nan():
    """The status says why; a record of it keeps that."""
    found = reconstruct.central(*M, va_after=12.0, vb_after=12.0, restitution=0.0, on_failure="nan")
    assert found.status is col.Status.INVERSE_E0
    assert not found.ok
    assert math.isnan(found.closing_speed)
    assert math.isnan(found.reconstruction.condition)
    assert col.Impact.from_dict(found.to_dict()).status is col.Status.INVERSE_E0
    with pytest.raises(col.InputError, match="on_failure must be"):
        reconstruct.central(*M, va=20.0, vb=0.0, restitution=0.5, on_failure="ignore")


def test_a_speed_beyond_float32_is_refused():
    """It would be 3.40282357e38 m/s, and float32 ends at 3.40282347e38: refused, without a warning
    of numpy's.
    """
    after = np.array([-1e-28, 1.02084714e11], dtype=np.float32)
    found = reconstruct.central(
        mass_a=300.0,
        mass_b=9.999999269030633e29,
        va_after=after,
        restitution=0.0,
        vb=0.0,
        on_failure="nan",
    )
    assert found.refused.all()
    assert np.isnan(found.energy_loss).all()


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_the_largest_speed_of_all_beside_an_energy_is_refused_without_a_word_of_numpys():
    """Neither of the two answers that an energy may have is a number."""
    known = {"va": np.array([1.7976931348623157e308, 20.0]), "vb_after": 10.0, "energy_loss": 1e4}
    impact = reconstruct.central(1256.0, 1441.0, **known, on_failure="nan")
    assert np.isnan(impact.restitution[0])
    assert impact.status[0] > col.Status.ENERGY_GAIN


@extremes
def test_a_refused_neighbour_leaves_the_digits_of_a_tiny_closing_speed():
    """A case of a batch, another of which the forward solver refuses, is solved again from the
    closing speed that was found.
    """
    known = {"va": 30.0, "restitution": 0.5}
    alone = reconstruct.central(1000.0, 1200.0, **known, energy_loss=1e-13)
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases"):
        both = reconstruct.central(1000.0, 1200.0, **known, energy_loss=np.array([1e-13, 1e308]))
    assert both.refused.tolist() == [False, True]
    assert np.isnan(both.inputs.contact_velocity[0]).tolist() == [False, True]
    # loss = m g^2 (1 - e^2) / 2 and P = m (1 + e) g, with m = 6000 / 11: the rounded speeds leave
    # seven digits.
    reduced = 6000.0 / 11.0
    impulse = 1.5 * reduced * math.sqrt(2.0 * 1e-13 / (0.75 * reduced))
    for impact in (alone, both.case(0), col.Impact.from_dict(both.to_dict()).case(0)):
        assert impact.normal_impulse == pytest.approx(impulse, rel=1e-14)


@pytest.mark.parametrize("batch", [False, True])
def test_a_separation_of_one_unit_in_the_last_place_is_warned_of(batch):
    """What is left of the difference of the velocities after is rounding, and so is the closing
    speed found from it.
    """
    after = np.nextafter(10.0, 11.0)
    given = np.array([after, 11.0]) if batch else after
    e = np.array([1e-15, 0.2]) if batch else 1e-15
    with pytest.warns(
        col.IllConditionedWarning, match="a change of a millionth of what is known"
    ) as caught:
        found = reconstruct.central(1500.0, 1200.0, va_after=10.0, vb_after=given, restitution=e)
    assert [one.message.code for one in caught] == ["ill_conditioned"]
    assert np.max(found.reconstruction.condition) > 1e15
    assert ("1 of 2 cases" in str(caught[0].message)) is batch


def test_headings_give_what_is_seen_from_a_vehicle():
    """A head-on impact: the force comes from ahead for both, and the whole delta-V is backwards."""
    found = col.reconstruct.central(
        "1500 kg",
        "1200 kg",
        va="50 km/h",
        vb="-20 km/h",
        restitution=0.1,
        heading_a="0 deg",
        heading_b="180 deg",
    )
    for side in (found.a, found.b):
        assert side.pdof == pytest.approx(0.0, abs=1e-12)
        assert side.delta_v_forward == pytest.approx(-side.delta_v, rel=1e-12)
    assert dict(found.b.before.given)["heading"] == "180 deg"
    plain = col.reconstruct.central(
        "1500 kg", "1200 kg", va="50 km/h", vb="-20 km/h", restitution=0.1
    )
    assert (found.a.after.vx, found.b.after.vx, found.energy_loss) == (
        plain.a.after.vx,
        plain.b.after.vx,
        plain.energy_loss,
    )
    assert found.reconstruction.condition == plain.reconstruction.condition
    assert plain.a.pdof is None
    again = col.Impact.from_dict(found.to_dict())
    assert again == found
    assert again.a.before.heading == 0.0


def test_headings_of_a_batch_and_of_its_refused_case():
    headings = np.array([0.0, math.pi, 0.1])
    with pytest.warns(col.CollisionsWarning, match="1 of 3 cases were refused"):
        found = col.reconstruct.central(
            1500.0,
            1200.0,
            va=np.array([10.0, 9.0, -1.0]),
            vb=0.0,
            restitution=0.1,
            heading_a=headings,
        )
    assert found.a.pdof[:2] == pytest.approx([0.0, math.pi], abs=1e-12)
    with pytest.raises(col.NoImpactError, match=r"^case 2: "):
        col.reconstruct.central(
            1500.0,
            1200.0,
            va=np.array([10.0, 9.0, -1.0]),
            vb=0.0,
            restitution=0.1,
            heading_a=headings,
            on_failure="raise",
        )
    only = col.reconstruct.central(
        1500.0, 1200.0, va=10.0, vb=0.0, restitution=0.1, heading_b=headings
    )
    assert only.inputs.shape == (3,)


@pytest.mark.parametrize("bad", ["3 m", math.nan, "east"])
def test_a_heading_that_cannot_be_read_is_named(bad):
    with pytest.raises(col.InputError, match="heading_b"):
        col.reconstruct.central(1500.0, 1200.0, va=10.0, vb=0.0, restitution=0.1, heading_b=bad)
