"""What would move an answer: each change is that of a second call with the input moved, the table
has the largest first, and it stands in the diagnosis, its dict and the report.
"""

import json
import math

import pytest

import collisions as col
from collisions import reconstruct
from collisions.diagnostics import Move, diagnose
from collisions.travel import Tyres

A = col.Vehicle(mass=1437.0, yaw_inertia=2311.0, vx=14.0, vy=3.0, x=-2.0, y=0.4, heading=0.1)
B = col.Vehicle(mass=1213.0, yaw_inertia=1877.0, vy=6.0, x=1.0, y=-0.3, heading=1.3)
CONTACT = {"normal": 0.2, "point": (0.1, 0.05), "friction": 0.3}


def impact(restitution=0.15, a=A, b=B, **changes):
    return col.eccentric(a, b, restitution, **(CONTACT | changes))


def by_name(answer, **options):
    return {move.name: move for move in diagnose(answer, **options).moves}


def larger(answer, others):
    """The larger change of each number, and the larger share, from whole answers."""
    found = {}
    for label in "ab":
        old = getattr(answer, label)
        news = [getattr(other, label) for other in others]
        found[f"delta_v_{label}"] = max(
            math.hypot(new.after.vx - old.after.vx, new.after.vy - old.after.vy) for new in news
        )
        found[f"yaw_rate_{label}"] = max(
            abs(new.after.yaw_rate - old.after.yaw_rate) for new in news
        )
    found["share"] = max(
        found["delta_v_a"] / answer.a.delta_v, found["delta_v_b"] / answer.b.delta_v
    )
    return found


@pytest.mark.parametrize(
    ("name", "ways"),
    [
        (
            "point",
            [
                {"point": (0.1 + by * math.sin(0.2), 0.05 - by * math.cos(0.2))}
                for by in (0.25, -0.25)
            ],
        ),
        ("normal", [{"normal": 0.2 + math.radians(by)} for by in (5.0, -5.0)]),
        ("restitution", [{"restitution": 0.25}, {"restitution": 0.05}]),
        ("friction", [{"friction": 0.5}, {"friction": 0.1}]),
    ],
)
def test_a_move_is_the_difference_of_two_calls(name, ways):
    answer = impact()
    move = by_name(answer)[name]
    expected = larger(answer, [impact(**way) for way in ways])
    for number, value in expected.items():
        assert getattr(move, number) == pytest.approx(value, rel=1e-9), number


def test_what_an_impulse_leaves_out_is_what_left_out_says():
    answer = impact()
    moves = by_name(answer, duration=0.08, drag=0.5)
    left = col.left_out(answer, duration=0.08, drag=0.5)
    for name, inner in (("geometry", "geometry"), ("tyres", "tyre")):
        assert moves[name].delta_v_a == getattr(left.a, f"{inner}_delta_v")
        assert moves[name].share == max(
            getattr(left.a, f"{inner}_share"), getattr(left.b, f"{inner}_share")
        )
        assert moves[name].yaw_rate_a is None
    assert "0.08 s, drag 0.5" in moves["tyres"].what


def test_tyres_given_to_a_diagnosis_are_those_of_left_out():
    """In the moves, and in the finding of what tyres can give, of a slow impact."""
    tyres = {"tyres_a": Tyres(0.6, 0.0, 2.7, 1.5), "tyres_b": Tyres(0.5, 1.0, 2.6, 1.5)}
    slow = impact(a=A.replace(vx=1.5, vy=0.2), b=B.replace(vy=0.3))
    found = diagnose(slow, duration=0.08, **tyres)
    left = col.left_out(slow, duration=0.08, **tyres)
    (move,) = (move for move in found.moves if move.name == "tyres")
    assert move.what == "tyres as given, 0.08 s"
    assert (move.delta_v_a, move.delta_v_b) == (left.a.tyre_delta_v, left.b.tyre_delta_v)
    sentences = {one.vehicle: one for one in found if one.code == "tyre_impulse"}
    assert sentences["a"].measured == left.a.tyre_share_bound
    assert "with a friction of 0.6 give up to" in sentences["a"].sentence
    assert left.a.tyre_delta_v_bound == pytest.approx(0.6 * 9.80665 * 0.08, rel=1e-12)
    assert left.b.tyre_impulse_bound == pytest.approx(1213.0 * 0.5 * 9.80665 * 0.08, rel=1e-12)
    # Wheels that roll take less than those that slide.
    assert move.share < by_name(slow, duration=0.08)["tyres"].share
    alone = diagnose(slow, tyres_b=tyres["tyres_b"])
    (of_a,) = (one for one in alone if (one.code, one.vehicle) == ("tyre_impulse", "a"))
    assert "with a drag of 0.7" in of_a.sentence
    (move,) = (move for move in alone.moves if move.name == "tyres")
    assert move.what == "tyres of A sliding 0.1 s, drag 0.7, others as given"
    bound = col.left_out(slow, tyres_b=tyres["tyres_b"]).a.tyre_delta_v_bound
    assert bound == pytest.approx(0.7 * 9.80665 * 0.1, rel=1e-12)
    (instant,) = (
        one
        for one in diagnose(
            col.reconstruct.planar(slow.a.after, slow.b.after, restitution=0.15, **CONTACT),
            tyres_b=tyres["tyres_b"],
        )
        if one.code == "instant"
    )
    words = "the tyres of B as given and those of A that slide with a drag of 0.7"
    assert words in instant.sentence


def test_a_reconstruction_says_what_the_tyres_given_do_to_it():
    """In the finding on what an instant leaves out, with the share of ``left_out``."""
    end = impact()
    found = col.reconstruct.planar(end.a.after, end.b.after, restitution=0.15, **CONTACT)
    tyres = {"tyres_a": Tyres(0.7, 1.0, 2.7, 1.5), "tyres_b": Tyres(0.7, 1.0, 2.6, 1.5)}
    limits = {"instant": 0.0}
    (plain,) = (one for one in diagnose(found, limits=limits) if one.code == "instant")
    (given,) = (one for one in diagnose(found, limits=limits, **tyres) if one.code == "instant")
    assert "for tyres that slide with a drag of 0.7" in plain.sentence
    assert "for the tyres as given" in given.sentence
    left = col.left_out(found, **tyres)
    sides = (left.a, left.b)
    assert given.measured == max(
        *(side.tyre_share for side in sides), *(side.geometry_share for side in sides)
    )


def test_tyres_of_no_use_to_a_diagnosis_are_refused():
    """Of an answer that has them, was followed in time, or is of momentum."""
    tyres = Tyres(0.7, 0.1, 2.7, 1.5)
    after = {"speed_a_after": 7.0, "speed_b_after": 7.0, "course_a_after": 0.7}
    momentum = col.reconstruct.momentum(
        1500.0, 1200.0, course_a=0.0, course_b=1.5, course_b_after=0.7, **after
    )
    for answer, said in (
        (impact(duration=0.1, tyres_a=tyres), "impact has its tyres"),
        (col.time_resolved(A, B, 0.15, **CONTACT, duration=0.1), "followed in time"),
        (momentum, "to reconstruct.momentum"),
    ):
        with pytest.raises(col.InputError, match=said) as caught:
            diagnose(answer, tyres_a=tyres)
        assert caught.value.code == "bad_combination"


def test_the_largest_is_first():
    shares = [move.share for move in diagnose(impact()).moves]
    assert len(shares) == 6
    assert shares == sorted(shares, reverse=True)


@pytest.mark.slow
def test_each_model_has_what_it_can_be_moved_by():
    line = col.linear_central(col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=1200.0), 0.95)
    assert set(by_name(line)) == {"restitution", "tyres"}
    assert by_name(line)["restitution"].share == pytest.approx(0.1 / 1.95)
    oblique = col.oblique_central(A.replace(yaw_rate=0.0), B, 0.1, normal=0.0, impulse_ratio=0.2)
    assert set(by_name(oblique)) == {"normal", "restitution", "impulse_ratio", "tyres"}
    tyres = Tyres(0.7, 0.2, 2.7, 1.5)
    assert "tyres" not in by_name(impact(duration=0.1, tyres_a=tyres, tyres_b=tyres))
    other = by_name(impact(duration=0.1, tyres_a=tyres))["tyres"]
    assert other.what == "tyres of B sliding 0.1 s, drag 0.7"
    stuck = by_name(impact(friction=math.inf))["friction"]
    assert stuck.what == "friction 0.55 in place of an infinite one"
    timed = col.time_resolved(A, B, 0.15, **CONTACT, duration=0.1)
    assert set(by_name(timed)) == {"point", "normal", "restitution", "friction"}


@pytest.mark.slow
def test_a_contact_in_time_is_not_moved_below_a_restitution_of_0():
    """Nor where impulses may be incomplete, of which ``solve`` may take none."""
    options = {"duration": 0.1, "drag": 0.7, "tolerance": "0.01 m/s", "incomplete": True}
    answer = col.solve(A, B, 0.05, **CONTACT, **options)
    assert answer.model == "time_resolved"
    ends = [col.time_resolved(A, B, end, **CONTACT, duration=0.1, drag=0.7) for end in (0.0, 0.15)]
    assert by_name(answer)["restitution"].delta_v_a == pytest.approx(
        larger(answer, ends)["delta_v_a"], rel=1e-9
    )


def test_where_there_is_no_answer_it_says_so():
    """Turned by five degrees the bodies part."""
    answer = col.oblique_central(
        col.Vehicle(mass=1500.0, vx=1.0, vy=20.0), col.Vehicle(mass=1200.0), 0.1,
        normal=0.0, friction=0.0,
    )  # fmt: skip
    found = diagnose(answer)
    move = found.moves[0]
    assert (move.name, move.share) == ("normal", math.inf)
    assert math.isnan(move.delta_v_a)
    assert math.isnan(move.delta_v_b)
    (finding,) = [one for one in found if one.code == "moves"]
    assert finding.measured == math.inf
    assert "there is no answer then" in col.report(answer, form="markdown", figures=False)
    json.dumps(found.to_dict(), allow_nan=False)


def test_it_is_shown_and_recorded():
    answer = impact()
    found = diagnose(answer, units="si")
    texts = str(found), found._repr_html_(), str(found.moves), repr(found.moves)
    for text in (*texts, col.report(answer, form="markdown", units="si", figures=False)):
        for move in found.moves:
            assert move.what.partition(" (")[0] in text
    first = found.moves[0]
    assert isinstance(first, Move)
    assert found.to_dict()["moves"][0]["share"] == first.share
    assert found.to_dict()["measured"] == sorted(found.measured)
    assert first.q.delta_v_a.m_as("m/s") == first.delta_v_a
    assert found.moves.summary("us").parts[0].rows


def test_momentum_has_none():
    answer = col.reconstruct.momentum(
        1500, 1200, course_a=0.0, course_b=1.5, course_a_after=0.5, course_b_after=1.0,
        speed_a_after=8.0, speed_b_after=9.0,
    )  # fmt: skip
    assert diagnose(answer).moves == ()


def test_the_drags_of_an_in_line_answer_are_no_tyres_left_out():
    """Given to the reverse solver, they are in the answer."""
    known = {"va": 12.0, "vb": 0.0, "vb_after": 7.0}
    drags = {"duration": 0.1, "drag_a": 0.7, "drag_b": 0.7}
    for given, left_out in (({}, True), (drags, False)):
        found = diagnose(
            reconstruct.central(1500.0, 1300.0, **known, **given), limits={"tyre_impulse": 0.0}
        )
        assert ("tyres" in [move.name for move in found.moves]) is left_out
        assert ("tyre_impulse" in [one.code for one in found]) is left_out
