"""What planar says where it refuses: the ranges it names hold the truth, and what it advises leads
on.
"""

import itertools
import math
import random
import re
import warnings

import numpy as np
import pytest

import collisions as col
from collisions.reconstruct import friction, planar, restitution
from scenes import LAWS

A = col.Vehicle(mass=1500.0, yaw_inertia=2200.0, x=-1.8, y=0.5, vx=15.0)
B = col.Vehicle(mass=1300.0, yaw_inertia=1800.0, x=1.8, y=-1.0, vx=-7.0)
JAMMING = {
    "normal": 0.0,
    "point": (0.0, 0.0),
    "friction": 1.5,
}  # K_nn < mu |K_nt|: jams at a ratio of -1.494


# The range of slips that stuck


def test_the_range_is_open_where_friction_jams():
    """One end is in the solutions; a slip far beyond what both ends would allow sticks too, at
    ratios up to the one that jams.
    """
    end = col.eccentric(A, B, 0.1, **JAMMING)
    assert end.regime == "sticking"
    with pytest.raises(col.NoSolutionError, match="holds the one end of the range") as caught:
        planar(end.a.after, end.b.after, restitution=0.1, **JAMMING)
    (low,) = caught.value.solutions
    limit = -1.0 / (end.effective_mass * _coupling(end))
    for words in (
        "it is open",
        f"towards {limit:.4g}, where the bodies jam",
        f"between {limit:.4g} and 1.5",
    ):
        assert words in str(caught.value)
    assert low.impulse_ratio == pytest.approx(1.5, rel=1e-12)
    # A contact that slides at 300 m/s sticks, and ends without slip as well.
    far = col.eccentric(A.replace(vy=0.0), B.replace(vy=300.0), 0.1, **JAMMING)
    assert far.regime == "sticking"
    assert far.slip_before > 250.0 > low.slip_before


def _coupling(impact):
    """K_nt by its definition, from the levers."""
    (px, py), total = impact.point, 0.0
    for body in (impact.a.before, impact.b.before):
        total -= (px - body.x) * (py - body.y) / body.yaw_inertia
    return total


@pytest.mark.parametrize("off", [1e-5, -1e-5])
def test_a_small_slip_names_an_open_range_that_holds_the_truth(off):
    """The true slip before is 0; the range of which only one end is an impact goes to infinity on
    the other side.
    """
    end = col.eccentric(A, B, 0.1, **JAMMING)
    a_after = end.a.after.replace(yaw_rate=end.a.after.yaw_rate + off)
    with pytest.warns(col.IllConditionedWarning, match="nothing|anything above") as caught:
        found = planar(a_after, end.b.after, restitution=0.1, **JAMMING)
    low = float(re.search(r"anything above (\S+) m/s\.", str(caught[0].message)).group(1))
    assert low == pytest.approx(found.slip_before, rel=1e-3)
    assert low < end.slip_before
    assert "The answer is that end of the range" in str(caught[0].message)
    assert found.reconstruction.condition == math.inf
    # A slip of the order of what sliding leaves is not taken for none, though the range is open.
    slid = col.eccentric(A, B.replace(vy=-80.0), 0.1, **JAMMING)
    assert slid.regime == "sliding"
    assert planar(
        slid.a.after, slid.b.after, restitution=0.1, **JAMMING
    ).slip_before == pytest.approx(slid.slip_before)


# What cannot be told from rounding


def test_a_separation_of_rounding_is_said_to_be_that():
    """With e = 1e-15 the contact points part, by less than the motions after are rounded."""
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.0}
    end = col.eccentric(A, B, 1e-15, **contact)
    with pytest.raises(col.NoSolutionError, match="cannot be told from rounding") as caught:
        planar(end.a.after, end.b.after, restitution=1e-15, **contact)
    assert caught.value.code == "not_separating"
    assert "do not part" not in str(caught.value)
    shown = re.search(
        r"separation speed (\S+) m/s, of which rounding may be (\S+) m/s", str(caught.value)
    )
    assert abs(float(shown[1])) < float(shown[2]) < 1e-11


@pytest.mark.parametrize("solver", [restitution, friction])
def test_a_closing_speed_of_rounding_is_said_to_be_that(solver):
    """Two speeds an ulp apart show neither an approach nor none."""
    a = col.Vehicle(mass=1000.0, vx=60.0)
    b = col.Vehicle(mass=1000.0, vx=math.nextafter(60.0, 61.0))
    after = a.replace(vx=59.0), b.replace(vx=61.0)
    with pytest.raises(col.NoImpactError, match="which cannot be told from rounding") as caught:
        solver(a, b, *after, normal=0.0)
    assert caught.value.closing_speed == a.vx - b.vx
    with pytest.raises(
        col.NoImpactError, match=r"closing speed -1 m/s along the normal, which must point"
    ):
        solver(a, b.replace(vx=61.0), *after, normal=0.0)


@pytest.mark.slow
def test_a_case_of_a_batch_is_refused_as_alone():
    """Text and solutions included."""
    end = col.eccentric(A, B, 0.1, **JAMMING)
    inputs = {"a_after": end.a.after, "b_after": end.b.after, **JAMMING}
    for given in (
        {"restitution": 0.1},
        {"restitution": 0.0},
        {"closing_speed": 0.5},
        {"restitution": 0.1, "regime": "given"},
    ):
        with pytest.raises(col.NoSolutionError) as alone:
            planar(**inputs, **given)
        many = {
            name: value if isinstance(value, str) else np.array([value])
            for name, value in given.items()
        }
        with pytest.raises(col.NoSolutionError) as caught:
            planar(**inputs, **many, on_failure="raise")
        assert str(caught.value) == f"case 0: {alone.value}"
        assert caught.value.solutions == alone.value.solutions


# Advice leads out


def _ratio(text, refusal):
    """An impulse ratio that the text allows, or that of a solution."""
    number = r"(-?[\d.]+(?:e[+-]\d+)?)"
    if found := re.search(rf"between {number} and {number}\)", text):
        low, high = map(float, found.groups())
        return low + 0.6 * (high - low)
    if found := re.search(rf"(above|below) {number}(?:\)|, or check)", text):
        return float(found[2]) + (0.1 if found[1] == "above" else -0.1)
    return refusal.solutions[0].impulse_ratio if refusal.solutions else 0.05


def _tangential(given, **rule):
    return {
        name: value
        for name, value in given.items()
        if name not in ("friction", "critical_fraction", "impulse_ratio")
    } | rule


def _known(given, **kind):
    return {
        name: value
        for name, value in given.items()
        if name not in ("restitution", "closing_speed", "energy_loss")
    } | kind


# What a message may advise, and how it is followed: from what was given, the end that was, the text
# and the refusal.
ADVICE = {
    r"leave out regime=": lambda given, end, text, refusal: {**given, "regime": None},
    r"(?:decides is|or) regime='(\w+)'": lambda given, end, text, refusal: {
        **given, "regime": re.search(r"regime='(\w+)'", text.partition("decides is")[2])[1]
    },
    r"(?:decides is|, or|give) impulse_ratio=": lambda given, end, text, refusal: _tangential(
        given, impulse_ratio=_ratio(text, refusal)
    ),
    r"give a finite friction=": lambda given, end, text, refusal: _tangential(given, friction=0.3),
    r"give friction= below": lambda given, end, text, refusal: _tangential(
        given, friction=0.9 * float(re.search(r"friction= below ([\d.e+-]+)", text)[1].rstrip(","))
    ),
    r"give friction= or": lambda given, end, text, refusal: _tangential(given, friction=0.3),
    r"write friction=0": lambda given, end, text, refusal: _tangential(given, friction=0.0),
    r"law='kudlich-slibar'": lambda given, end, text, refusal: {**given, "law": "kudlich-slibar"},
    r"give closing_speed=": lambda given, end, text,
    refusal: _known(given, closing_speed=end.closing_speed),
    r"at least the separation speed": lambda given, end, text, refusal: _known(
        given, closing_speed=1.5 * refusal.fields["separation_speed"]
    ),
    r"closing_speed= or energy_loss=": lambda given, end, text,
    refusal: _known(given, energy_loss=max(end.energy_loss, 1.0)),
    r"give at least [\d.e+]+ J": lambda given, end, text, refusal: _known(
        given, energy_loss=1.01 * float(re.search(r"at least ([\d.e+]+) J", text)[1])
    ),
    r"restitution= (?:or closing_speed= )?instead": lambda given, end, text,
    refusal: _known(given, restitution=0.4),
    r"restitution= or closing_speed= instead": lambda given, end, text, refusal: _known(
        given, closing_speed=2.0 * refusal.fields["separation_speed"]
    ),
}  # fmt: skip


def advised(text):
    """Which advice stands in a message."""
    return {pattern for pattern in ADVICE if re.search(pattern, text)}


def follow(given, end, before=(), depth=0):
    """Every advice of every refusal, one after the other; how many answers they led to."""
    assert depth < 6, before
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            planar(
                end.a.after,
                end.b.after,
                **{name: value for name, value in given.items() if value is not None},
            )
        return 1
    except col.NoSolutionError as refusal:
        text = str(refusal)
        assert not (set(before) & advised(text)), (before, text)
        assert advised(text) or "check" in text, text
        return sum(
            follow(ADVICE[one](given, end, text, refusal), end, (*before, one), depth + 1)
            for one in advised(text)
        )


PIN = (
    A.replace(vx=0.0, yaw_rate=2.0, pivot=(-1.0, -2.0)),
    B.replace(vx=0.0, yaw_rate=1.5, pivot=(1.5, 2.0)),
)
MOTIONS = {
    "sticks": (A, B.replace(vy=0.3)),
    "slides": (A, B.replace(vy=-80.0)),
    "slides the other way": (A, B.replace(vy=30.0, yaw_rate=-3.0)),
    "both pinned": PIN,
    "wall": (A.replace(vy=-4.0), col.Vehicle.barrier()),
}
TANGENTIAL = ({"friction": 0.3}, {"friction": 1.5}, {"friction": math.inf}, {"friction": 0.0},
{"critical_fraction": 1.0},
              {"critical_fraction": 0.5}, {"impulse_ratio": 0.2}, {"impulse_ratio": -4.0},
                  {"impulse_ratio": 4.0})  # fmt: skip
SAMPLE = 20  # of 540 questions on each of nine ends; all of them were asked once
REGIMES = (None, "sliding", "sticking", "given", "frictionless")


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("motion", MOTIONS)
def test_advice_leads_out(motion, law):
    """What a message advises does not end in one that advises the same, and some of it ends in an
    answer.

    The end of an impact is put to planar as it was, and with another friction, law, regime, closing
    speed, energy or restitution; every advice of every refusal is followed with a value that the
    message allows.
    """
    rng, refused, led = random.Random(f"{motion} {law}"), 0, 0
    for e, rule in itertools.product(
        (0.0, 1e-15, 0.2), ({"friction": 0.3}, {"friction": 1.5}, {"impulse_ratio": -0.1})
    ):
        a, b, way = *MOTIONS[motion], (-1.0, 0.0) if motion == "both pinned" else (1.0, 0.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            end = col.eccentric(a, b, e, normal=way, point=(0.0, 0.0), law=law, **rule)
        knowns = [{"restitution": value} for value in (e, 0.2)]
        knowns += [{"closing_speed": share * end.closing_speed} for share in (1.0, 0.1)]
        knowns += [{"energy_loss": share * max(end.energy_loss, 1.0)} for share in (1.0, 1e-3)]
        cases = list(itertools.product(knowns, TANGENTIAL, REGIMES, LAWS))
        for known, other, regime, another in rng.sample(cases, SAMPLE):
            given = {
                "normal": end.normal,
                "point": end.point,
                "law": another,
                "regime": regime,
                **known,
                **other,
            }
            if "energy_loss" in known and other.get("critical_fraction") == 0.5:
                continue
            answers = follow(given, end)
            refused += answers != 1
            led += answers > 1
    assert refused > 2 * SAMPLE
    assert led > 0.3 * refused
