"""What must hold for every impact: conservation, restitution, friction, and indifference to how the
scene is described.

Two answers to the same question differ by at most two promises of section 5 of the numerics note
(``TWICE``); where the question itself is rounded on the way (a scene turned by any angle),
``NUDGED`` allows for its data having moved.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import collisions as col
from reference import EPS, Answer, Body, Scene, evaluate
from scenes import (
    ANGLES,
    CONSTRAINTS,
    LAWS,
    RULES,
    SPEEDS,
    VALUES,
    answerable,
    impacts,
    solved,
    solved_together,
)
from strategies import other_registry

# The same examples in every run; as many for a property as for one crossed with every model, law
# and constraint together.
physics = settings(deadline=None, max_examples=100, derandomize=True, database=None)
crossed = settings(physics, max_examples=20)

TWICE = 2.0
# Data moved by 1.5 eps each (two products and a sum): 1.5 from the velocities, 1.5 from n in the
# closing speed, and 2 (1.5 + 1.5) from n and the levers, which enter K squared: 9 eps of kappa S_P,
# a little more than one promise of 8.
NUDGED = TWICE + 9.0 / 8.0

MODELS = [("eccentric", constraint) for constraint in CONSTRAINTS] + [
    (model, constraint)
    for model in ("oblique_central", "linear_central")
    for constraint in ("free", "A fixed", "B fixed")
]


def marks(constraint: str) -> Any:
    """A free and a pinned body, under the law that is the default, are for every run; the rest is
    slow.
    """
    return () if constraint in ("free", "B pinned") else pytest.mark.slow


def crossing(pairs: list[tuple[str, str]]) -> Any:
    """Every pair of model and constraint as a test of its own."""
    cases = [pytest.param(*pair, marks=marks(pair[1]), id=", ".join(pair)) for pair in pairs]
    return pytest.mark.parametrize(("model", "constraint"), cases)


PLANAR = [pair for pair in MODELS if pair[0] != "linear_central"]
every_model = crossing(MODELS)
every_law = pytest.mark.parametrize(
    "law", [pytest.param(law, marks=() if law == "brach" else pytest.mark.slow) for law in LAWS]
)
every_constraint = pytest.mark.parametrize(
    "constraint", [pytest.param(name, marks=marks(name)) for name in CONSTRAINTS]
)


def point_mass(body: Body) -> Body:
    """The body as the central models see it: no spin, no lever, no pivot."""
    return replace(body, spin=0.0, x=0.0, y=0.0, pivot=None)


def flat(scene: Scene) -> Scene:
    """The scene as the central models see it."""
    return replace(scene, a=point_mass(scene.a), b=point_mass(scene.b), point=(0.0, 0.0))


@st.composite
def scenes(draw: Any, model: str, constraint: str, law: str) -> tuple[Scene, Answer]:
    """A scene that the model can answer, with the reference answer for its scales."""
    if model == "linear_central":
        scene = draw(impacts(constraint, law, "friction", 0.0, turning=False))
        a, b = (replace(point_mass(body), vy=0.0) for body in (scene.a, scene.b))
        scene = replace(
            scene, a=a, b=b, normal=(1.0, 0.0) if a.vx > b.vx else (-1.0, 0.0), point=(0.0, 0.0)
        )
    else:
        rule = draw(st.sampled_from(RULES))
        scene = draw(impacts(constraint, law, rule, turning=model == "eccentric"))
        if model == "oblique_central":
            scene = flat(scene)
    answer = evaluate(scene)
    assume(answerable(answer))
    return scene, answer


# --- Scales ---------------------------------------------------------------------------------------


def impulse_error(answer: Answer) -> float:
    """Promise of P: 8 eps kappa S_P."""
    return 8 * EPS * float(answer.spread)


def loss_error(answer: Answer) -> float:
    """Promise of the loss: 8 eps (|loss_n| + |loss_t| + kappa S_P max(S_U, |s'|))."""
    moving = max(answer.s_u, abs(answer.slip_after))
    return 8 * EPS * float(abs(answer.loss_n) + abs(answer.loss_t) + answer.spread * moving)


def velocity_error(answer: Answer, body: Body, side: str) -> float:
    """Promise of v': 8 eps (|v| + a kappa S_P), with d b |r| for a if pinned."""
    half = getattr(answer, side)
    share = half.arm * half.b * half.r if body.pivot else half.a
    return 8 * EPS * float(half.speed + share * answer.spread)


def spin_error(answer: Answer, body: Body, side: str) -> float:
    """Promise of w': 8 eps (|w| + b |r| kappa S_P)."""
    half = getattr(answer, side)
    return 8 * EPS * float(abs(body.spin) + half.b * half.r * answer.spread)


def contact_error(scene: Scene, answer: Answer) -> float:
    """Error of the contact velocities after, recomputed as v' + w' x r: the promises of v' and w'
    |r| of both bodies.

    ``velocity_at`` and the component along n add two products and three sums, each half an eps of
    the same terms: under 4 eps.
    """
    total = 0.0
    for side in "ab":
        body, half = getattr(scene, side), getattr(answer, side)
        # The lever that velocity_at uses reaches from the centre of mass, also of a pinned body.
        lever = math.hypot(scene.point[0] - body.x, scene.point[1] - body.y)
        total += velocity_error(answer, body, side) + lever * spin_error(answer, body, side)
        total += 4 * EPS * (float(abs(half.vx) + abs(half.vy)) + lever * float(abs(half.w)))
    return total


def contact_velocity(impact: col.Impact, state: str, scene: Scene) -> tuple[float, float]:
    """Velocity of B relative to A at the contact along n and t, in a state, from the vehicles of
    that state.
    """
    (ax, ay), (bx, by) = (
        getattr(getattr(impact, side), state).velocity_at(scene.point) for side in "ab"
    )
    nx, ny = impact.normal
    return nx * (bx - ax) + ny * (by - ay), nx * (by - ay) - ny * (bx - ax)


def assert_same(
    one: col.Impact,
    two: col.Impact,
    scene: Scene,
    answer: Answer,
    promises: float = TWICE,
    turned: tuple[float, float] = (1.0, 0.0),
) -> None:
    """Two answers agree to so many promises; ``turned`` are cosine and sine of the angle the second
    scene is turned by.
    """
    c, s = turned
    of_contact = promises * 4 * EPS * float(answer.s_u)
    assert one.closing_speed == pytest.approx(two.closing_speed, rel=0, abs=of_contact)
    assert one.slip_before == pytest.approx(two.slip_before, rel=0, abs=of_contact)
    of_impulse = promises * impulse_error(answer)
    assert one.normal_impulse == pytest.approx(two.normal_impulse, rel=0, abs=of_impulse)
    assert one.tangential_impulse == pytest.approx(two.tangential_impulse, rel=0, abs=of_impulse)
    assert one.energy_loss == pytest.approx(
        two.energy_loss, rel=0, abs=promises * loss_error(answer)
    )
    for side in "ab":
        body, half = getattr(scene, side), getattr(answer, side)
        mine, other = getattr(one, side), getattr(two, side)
        share = float(half.arm * half.b * half.r if body.pivot else half.a)
        error = math.hypot(
            mine.delta_vx - (c * other.delta_vx + s * other.delta_vy),
            mine.delta_vy - (c * other.delta_vy - s * other.delta_vx),
        )
        assert error <= share * of_impulse, side
        assert (
            abs(mine.delta_yaw_rate - other.delta_yaw_rate) <= float(half.b * half.r) * of_impulse
        ), side


@pytest.mark.slow
def test_an_infinite_promise_is_no_promise() -> None:
    """Where hardly anything closes, a share of the critical ratio (here 1e322) has no accuracy: no
    property is asked of such a case.
    """
    wall = Body(math.inf, math.inf)
    scene = Scene(
        Body(1000.0, 1500.0, vy=10.0, x=-2.0),
        wall,
        0.0,
        5e-324,
        (0.0, 0.0),
        "critical_fraction",
        0.5,
        "brach",
    )
    answer = evaluate(scene)
    assert answer.refused is None
    assert math.isinf(impulse_error(answer))
    assert not answerable(answer)


# --- Conservation ---------------------------------------------------------------------------------


@every_law
@pytest.mark.parametrize("model", ["eccentric", "oblique_central", "linear_central"])
@crossed
@given(data=st.data())
def test_linear_momentum_of_two_free_bodies_is_conserved(model: str, law: str, data: Any) -> None:
    """Momentum before equals momentum after (eqs 1 and 2)."""
    scene, _ = data.draw(scenes(model, "free", law))
    impact = solved(model, scene)
    for i in (0, 1):
        before = impact.a.before.momentum[i] + impact.b.before.momentum[i]
        after = impact.a.after.momentum[i] + impact.b.after.momentum[i]
        # 1 eps of sum m(|v| + |v'|) is promised; the products and the sums made here are another
        # eps of it.
        terms = sum(
            side.before.mass * (side.before.speed + side.after.speed)
            for side in (impact.a, impact.b)
        )
        assert abs(after - before) <= 2 * EPS * terms
    size = math.hypot(impact.normal_impulse, impact.tangential_impulse)
    assert impact.momentum_residual <= 4 * EPS * size
    assert impact.a.impulse_x == -impact.b.impulse_x
    assert impact.a.impulse_y == -impact.b.impulse_y


@every_law
@every_constraint
@crossed
@given(data=st.data())
def test_the_contact_impulse_has_no_moment_about_the_contact(
    constraint: str, law: str, data: Any
) -> None:
    """About the contact point the angular momentum of each body changes only by the moment of its
    pivot, if it has one.
    """
    scene, answer = data.draw(scenes("eccentric", constraint, law))
    impact = solved("eccentric", scene)
    for name in "ab":
        body, side, half = getattr(scene, name), getattr(impact, name), getattr(answer, name)
        if math.isinf(body.mass):
            assert (side.delta_vx, side.delta_vy, side.delta_yaw_rate) == (0.0, 0.0, 0.0)
            continue
        rx, ry = (
            Fraction(at) - Fraction(to)
            for at, to in zip((body.x, body.y), scene.point, strict=True)
        )
        mass, inertia = Fraction(body.mass), Fraction(body.inertia)
        orbital = mass * (rx * Fraction(side.delta_vy) - ry * Fraction(side.delta_vx))
        spun = inertia * Fraction(side.delta_yaw_rate)
        # 8 eps of the terms is promised, with |r| m |dv| for the first as in the reference tests.
        terms = math.hypot(rx, ry) * body.mass * side.delta_v + abs(float(spun))
        moment, allowed = Fraction(0), 8 * EPS * terms
        if body.pivot:
            px, py = (
                Fraction(at) - Fraction(to) for at, to in zip(body.pivot, scene.point, strict=True)
            )
            moment = px * Fraction(side.pivot_impulse_y) - py * Fraction(side.pivot_impulse_x)
            # The error of R: 8 eps (|R| + (1 + m d b |r|) kappa S_P), times its lever; dv and dw
            # with theirs.
            size = math.hypot(side.pivot_impulse_x, side.pivot_impulse_y)
            allowed += (
                8
                * EPS
                * math.hypot(px, py)
                * (size + float((1 + body.mass * half.arm * half.b * half.r) * answer.spread))
            )
            of_turn = float(half.b * half.r) * impulse_error(answer)
            allowed += (body.mass * math.hypot(rx, ry) * float(half.arm) + body.inertia) * of_turn
        assert abs(float(orbital + spun - moment)) <= allowed, name


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_energy_is_accounted_for(model: str, constraint: str, law: str, data: Any) -> None:
    """Kinetic energy before less kinetic energy after is the energy loss (eq 7)."""
    scene, answer = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    left, allowed = 0.0, loss_error(answer)
    for name in "ab":
        body, side = getattr(scene, name), getattr(impact, name)
        if math.isinf(body.mass):
            assert side.after.kinetic_energy == side.before.kinetic_energy == 0.0
            continue
        left += side.before.kinetic_energy - side.after.kinetic_energy
        # m v' dv' + I w' dw' of the promised errors, and 4 eps of each energy for working it out
        # and adding up.
        allowed += body.mass * side.after.speed * velocity_error(answer, body, name)
        allowed += body.inertia * abs(side.after.yaw_rate) * spin_error(answer, body, name)
        allowed += 4 * EPS * (side.before.kinetic_energy + side.after.kinetic_energy)
    assert abs(left - impact.energy_loss) <= allowed


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_the_work_on_the_two_bodies_sums_to_the_loss(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """kinetic_energy_change of A and B sum to minus the energy loss, and each is its body's change
    of kinetic energy.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    # Each is F.(u + du/2): F to its promise times the velocity, and the velocity to its own times
    # F.
    speeds = sum(
        float(half.speed)
        + math.hypot(scene.point[0] - body.x, scene.point[1] - body.y) * abs(body.spin)
        + float(half.mobility * answer.spread)
        for half, body in ((answer.a, scene.a), (answer.b, scene.b))
    )
    error = impulse_error(answer) * speeds + float(answer.spread) * contact_error(scene, answer)
    total = impact.a.kinetic_energy_change + impact.b.kinetic_energy_change
    assert abs(total + impact.energy_loss) <= loss_error(answer) + error
    for name in "ab":
        known = getattr(answer, name).energy_change
        assert abs(getattr(impact, name).kinetic_energy_change - float(known)) <= error


# --- The contact ----------------------------------------------------------------------------------


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_restitution_holds_between_the_contact_points(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """The contact points, found again from the vehicles after, part at e times the speed at which
    they closed (eqs 9 and 11).
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    parting, slipping = contact_velocity(impact, "after", scene)
    allowed = contact_error(scene, answer)
    # Closing and slip are promised to 4 eps S_U.
    assert abs(parting - impact.separation_speed) <= allowed + 4 * EPS * float(answer.s_u)
    assert abs(slipping - float(answer.slip_after)) <= allowed + 4 * EPS * float(answer.s_u)
    assert impact.separation_speed == scene.restitution * impact.closing_speed


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_at_the_end_of_compression_the_contact_does_not_close(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """After P/(1+e) the contact points share their normal velocity, and under "kudlich-slibar" a
    sticking contact does not slip.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    closing, slipping = contact_velocity(impact, "at_compression", scene)
    allowed = contact_error(scene, answer) + 4 * EPS * float(answer.s_u)
    assert abs(closing) <= allowed
    if law == "kudlich-slibar" and impact.regime == "sticking":
        assert abs(slipping) <= allowed
    whole = 1.0 + scene.restitution
    assert impact.compression_impulse * whole == pytest.approx(impact.normal_impulse, rel=4 * EPS)


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_the_impulse_stays_in_the_friction_cone(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """Bodies push and never pull, and friction carries no more than its bound; it opposes the slip
    that no bound would stop.
    """
    scene, _ = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    assert impact.normal_impulse >= 0.0
    if scene.rule == "friction" and math.isfinite(scene.value):
        # The components come from compared values by at most three roundings each: 3 eps between
        # them.
        assert abs(impact.tangential_impulse) <= scene.value * impact.normal_impulse * (1 + 3 * EPS)
    if impact.regime == "sliding":
        assert abs(impact.impulse_ratio) == pytest.approx(scene.value, rel=2 * EPS)
        # Sliding goes on against the impulse: the slip left is opposite to it.
        left = (
            impact.slip_after
            if law == "brach"
            else impact.slip_after + scene.restitution * impact.slip_before
        )
        assert impact.tangential_impulse * left <= 0.0


@pytest.mark.slow
@crossing(PLANAR)
@crossed
@given(data=st.data())
def test_no_energy_is_gained(model: str, constraint: str, data: Any) -> None:
    """With Coulomb friction under "kudlich-slibar", and without friction under both laws, the loss
    is never below 0.
    """
    law = data.draw(st.sampled_from(LAWS))
    value = 0.0 if law == "brach" else None
    scene = data.draw(impacts(constraint, law, "friction", value, turning=model == "eccentric"))
    if model == "oblique_central":
        scene = flat(scene)
    assume(answerable(evaluate(scene)))
    impact = solved(model, scene)
    assert impact.energy_loss >= 0.0
    assert impact.ok


# --- One scene, described in several ways ---------------------------------------------------------


@pytest.mark.slow
@every_law
@crossing([pair for pair in MODELS if "pinned" not in pair[1]])
@crossed
@given(data=st.data())
def test_a_common_velocity_changes_nothing(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """Galilean invariance: seen from another frame the impulse, the changes of velocity and the
    loss are the same.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    shift_x, shift_y = data.draw(SPEEDS), 0.0 if model == "linear_central" else data.draw(SPEEDS)
    a, b = (
        replace(body, vx=body.vx + shift_x, vy=body.vy + shift_y) for body in (scene.a, scene.b)
    )
    assert_same(solved(model, scene), solved(model, replace(scene, a=a, b=b)), scene, answer)


@pytest.mark.slow
@every_law
@every_constraint
@crossed
@given(data=st.data())
def test_a_shift_of_the_origin_changes_nothing(constraint: str, law: str, data: Any) -> None:
    """The origin of the scene is anyone's choice, a map grid's included: shifts by thousands of
    kilometres change nothing.
    """
    scene, answer = data.draw(scenes("eccentric", constraint, law))
    east, north = (data.draw(st.integers(-(2**27), 2**27)) / 32.0 for _ in "xy")

    def moved(body: Body) -> Body:
        pivot = body.pivot and (body.pivot[0] + east, body.pivot[1] + north)
        return replace(body, x=body.x + east, y=body.y + north, pivot=pivot)

    point = (scene.point[0] + east, scene.point[1] + north)
    other = replace(scene, a=moved(scene.a), b=moved(scene.b), point=point)
    assert_same(solved("eccentric", scene), solved("eccentric", other), scene, answer)


def turned(scene: Scene, c: float, s: float) -> Scene:
    """The whole scene turned about the origin."""

    def turn(x: float, y: float) -> tuple[float, float]:
        return c * x - s * y, s * x + c * y

    def body(of: Body) -> Body:
        (x, y), (vx, vy) = turn(of.x, of.y), turn(of.vx, of.vy)
        return replace(of, x=x, y=y, vx=vx, vy=vy, pivot=of.pivot and turn(*of.pivot))

    n = (
        scene.normal
        if isinstance(scene.normal, tuple)
        else (math.cos(scene.normal), math.sin(scene.normal))
    )
    return replace(
        scene, a=body(scene.a), b=body(scene.b), normal=turn(*n), point=turn(*scene.point)
    )


@pytest.mark.slow
@every_law
@crossing(PLANAR)
@crossed
@given(data=st.data())
def test_a_quarter_turn_of_the_scene_changes_nothing(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """Turned by 90, 180 or 270 degrees, which rounds nothing, the scene gives the same answer,
    turned.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    c, s = data.draw(st.sampled_from([(0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]))
    assert_same(
        solved(model, scene), solved(model, turned(scene, c, s)), scene, answer, turned=(c, s)
    )


@pytest.mark.slow
@every_law
@pytest.mark.parametrize(
    "constraint", [pytest.param(name, marks=marks(name)) for name in ("free", "A fixed", "B fixed")]
)
@pytest.mark.parametrize("model", ["eccentric", "oblique_central"])
@crossed
@given(data=st.data())
def test_any_turn_of_the_scene_changes_nothing(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """Turned by any angle about the contact, B standing before, the scene gives the same answer,
    turned.
    """
    scene, _ = data.draw(scenes(model, constraint, law))
    # From the contact, and from a frame in which B stands, so that what turning rounds is small
    # against the data themselves.
    a, b = (replace(o, x=o.x - scene.point[0], y=o.y - scene.point[1]) for o in (scene.a, scene.b))
    a, b = replace(a, vx=a.vx - b.vx, vy=a.vy - b.vy), replace(b, vx=0.0, vy=0.0)
    scene = replace(scene, a=a, b=b, point=(0.0, 0.0))
    answer = evaluate(scene)
    angle = data.draw(ANGLES)
    c, s = math.cos(angle), math.sin(angle)
    assert_same(
        solved(model, scene), solved(model, turned(scene, c, s)), scene, answer, NUDGED, (c, s)
    )


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_the_names_of_the_bodies_change_nothing(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """A called B, B called A and the normal turned round: the same impact, with the same components
    of the impulse.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    n = (
        scene.normal
        if isinstance(scene.normal, tuple)
        else (math.cos(scene.normal), math.sin(scene.normal))
    )
    scene = replace(scene, normal=n)
    one = solved(model, scene)
    two = solved(model, replace(scene, a=scene.b, b=scene.a, normal=(-n[0], -n[1])))
    assert abs(one.normal_impulse - two.normal_impulse) <= TWICE * impulse_error(answer)
    assert abs(one.tangential_impulse - two.tangential_impulse) <= TWICE * impulse_error(answer)
    assert abs(one.energy_loss - two.energy_loss) <= TWICE * loss_error(answer)
    for mine, other, name in ((one.a, two.b, "a"), (one.b, two.a, "b")):
        body = getattr(scene, name)
        error = math.hypot(mine.after.vx - other.after.vx, mine.after.vy - other.after.vy)
        assert error <= TWICE * velocity_error(answer, body, name)
        assert abs(mine.after.yaw_rate - other.after.yaw_rate) <= TWICE * spin_error(
            answer, body, name
        )


@pytest.mark.slow
@every_law
@every_model
@crossed
@given(data=st.data())
def test_one_case_equals_the_same_case_in_a_batch(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """A case solved alone and as one case of a batch of three gives the same within two promises,
    with the same status.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    impact = solved(model, scene)
    with warnings.catch_warnings():
        # The case between, of another restitution, may have no answer.
        warnings.simplefilter("ignore", col.CollisionsWarning)
        batch = solved_together(model, [scene, replace(scene, restitution=0.5), scene])
    assert batch.normal_impulse.shape == (3,)

    class Case:
        """One case of a batch, or of a side of it."""

        def __init__(self, of: Any, index: int) -> None:
            self.of, self.index = of, index

        def __getattr__(self, name: str) -> Any:
            found = getattr(self.of, name)
            return (
                float(found[self.index])
                if isinstance(found, np.ndarray)
                else Case(found, self.index)
            )

    for index in (0, 2):
        assert_same(impact, Case(batch, index), scene, answer)
        assert batch.status[index] == impact.status


# --- Units ----------------------------------------------------------------------------------------

FOREIGN = other_registry()
US = {
    "mass": ("lb", Fraction("0.45359237")),
    "yaw_inertia": ("lb*ft**2", Fraction("0.45359237") * Fraction("0.3048") ** 2),
    "vx": ("mph", Fraction("0.44704")),
    "vy": ("mph", Fraction("0.44704")),
    "x": ("ft", Fraction("0.3048")),
    "y": ("ft", Fraction("0.3048")),
}


FACTORS = dict(US.values())
# pint multiplies its factors out in floats: a pound comes out as 0.4535923700000001 kg, 0.78 eps
# too much and the worst of these four; the product with it adds half an eps.
OF_PINT = Fraction(1.5 * EPS)


def in_us_units(body: Body, form: Any) -> dict[str, Any]:
    """Fields of a Vehicle in US units, the numbers those of the body; ``form`` makes a text or a
    Quantity of number and unit.
    """
    fields = {
        "mass": body.mass,
        "yaw_inertia": body.inertia,
        "vx": body.vx,
        "vy": body.vy,
        "x": body.x,
        "y": body.y,
    }
    return {name: form(value, US[name][0]) for name, value in fields.items()}


@pytest.mark.slow
@every_law
@physics
@given(data=st.data())
def test_the_unit_system_changes_nothing(law: str, data: Any) -> None:
    """US texts and Quantities of another registry are the SI numbers found by hand, and solve to
    the last bit as those numbers.
    """
    scene, _ = data.draw(scenes("eccentric", "free", law))
    options = {"normal": scene.normal, scene.rule: scene.value, "law": law, "on_failure": "nan"}
    feet = tuple(f"{part!r} ft" for part in scene.point)
    for form, point in (
        (lambda value, unit: f"{value!r} {unit}", feet),
        (FOREIGN.Quantity, FOREIGN.Quantity(np.array(scene.point), "ft")),
    ):
        given_so = [
            col.Vehicle(**in_us_units(body, form), yaw_rate=body.spin)
            for body in (scene.a, scene.b)
        ]
        for body, found in zip((scene.a, scene.b), given_so, strict=True):
            exact = in_us_units(body, lambda value, unit: Fraction(value) * FACTORS[unit])
            for name, value in exact.items():
                assert abs(Fraction(getattr(found, name)) - value) <= OF_PINT * abs(value), name
        plain = [
            col.Vehicle(**{name: getattr(v, name) for name in (*US, "yaw_rate")}) for v in given_so
        ]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            one = col.eccentric(*given_so, scene.restitution, point=point, **options)
            two = col.eccentric(*plain, scene.restitution, point=one.point, **options)
        for at, was in zip(one.point, scene.point, strict=True):
            assert abs(Fraction(at) - Fraction(was) * FACTORS["ft"]) <= OF_PINT * abs(
                Fraction(was) * FACTORS["ft"]
            )
        assert one.status == two.status
        if one.refused:
            continue
        for path in ("normal_impulse", "energy_loss"):
            assert getattr(one, path) == getattr(two, path)
        assert one.a.after == two.a.after
        # On the way out: pint's factor and the product, and half an eps for the wanted float
        # itself.
        wanted = float(Fraction(one.a.after.vx) / FACTORS["mph"])
        assert one.a.after.q.vx.m_as("mph") == pytest.approx(wanted, rel=2 * EPS, abs=0)


# --- One model in place of another ----------------------------------------------------------------


@every_law
@pytest.mark.parametrize("because", ["the levers are zero", "the inertias are infinite"])
@crossed
@given(data=st.data())
def test_eccentric_equals_oblique_central(because: str, law: str, data: Any) -> None:
    """With zero levers, or bodies that cannot turn, the eccentric model is the oblique central one,
    whatever the friction.
    """
    rule = data.draw(st.sampled_from(RULES))
    scene = data.draw(impacts("free", law, rule, turning=False))
    a, b = scene.a, scene.b
    if because == "the levers are zero":
        a, b = (replace(body, x=scene.point[0], y=scene.point[1]) for body in (a, b))
    else:
        a, b = (replace(body, inertia=math.inf) for body in (a, b))
    scene = replace(scene, a=a, b=b)
    answer = evaluate(scene)
    assume(answerable(answer))
    assert_same(solved("eccentric", scene), solved("oblique_central", scene), scene, answer)


def along_the_normal(data: Any, law: str, value: float) -> Scene:
    """Contact on the line through both centres of mass, which is the normal: r_t = 0 exactly, with
    levers that are not 0.
    """
    scene = data.draw(impacts("free", law, "friction", value, turning=False))
    ahead, behind = (data.draw(st.integers(8, 96)) / 32.0 for _ in "ab")
    quarter = data.draw(st.sampled_from([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]))
    px, py = scene.point
    a = replace(scene.a, x=px - ahead * quarter[0], y=py - ahead * quarter[1])
    b = replace(scene.b, x=px + behind * quarter[0], y=py + behind * quarter[1])
    scene = replace(scene, a=a, b=b, normal=quarter)
    closing = quarter[0] * (a.vx - b.vx) + quarter[1] * (a.vy - b.vy)
    assume(closing != 0.0)
    if closing < 0.0:
        # The velocities exchanged close where these part.
        scene = replace(scene, a=replace(a, vx=b.vx, vy=b.vy), b=replace(b, vx=a.vx, vy=a.vy))
    return scene


@pytest.mark.slow
@every_law
@physics
@given(data=st.data())
def test_a_central_line_of_impact_without_friction_needs_no_levers(law: str, data: Any) -> None:
    """With r_t = 0 and no friction the eccentric model equals the oblique central one, and nothing
    turns.
    """
    scene = along_the_normal(data, law, 0.0)
    answer = evaluate(scene)
    one = solved("eccentric", scene)
    assert_same(one, solved("oblique_central", scene), scene, answer)
    assert one.a.delta_yaw_rate == one.b.delta_yaw_rate == 0.0


@pytest.mark.slow
@every_law
@physics
@given(data=st.data())
def test_friction_on_a_lever_along_the_normal_turns_the_bodies(law: str, data: Any) -> None:
    """With r_t = 0 and friction the models differ: the tangential impulse turns the cars, and less
    of it ends the slip.
    """
    scene = along_the_normal(data, law, math.inf)
    answer = evaluate(scene)
    assume(abs(answer.slip) > 1e-3 * answer.s_u)
    one, two = solved("eccentric", scene), solved("oblique_central", scene)
    # K is diagonal: Pt is the same change of slip over a + sum b r_n^2 here and over a there.
    share = float((answer.a.a + answer.b.a) / answer.k_tt)
    assert share < 0.99
    assert one.tangential_impulse == pytest.approx(
        share * two.tangential_impulse, rel=0, abs=TWICE * impulse_error(answer)
    )
    assert abs(one.tangential_impulse) < abs(two.tangential_impulse)
    for side in "ab":
        half, found = getattr(answer, side), getattr(one, side)
        # The torque of Pt on a lever r_n ahead of A and behind B is of one sign on both.
        assert found.delta_yaw_rate * one.tangential_impulse < 0.0
        wanted = float(half.b * half.r) * abs(one.tangential_impulse)
        assert abs(found.delta_yaw_rate) == pytest.approx(
            wanted, rel=0, abs=float(half.b * half.r) * impulse_error(answer)
        )


@pytest.mark.slow
@every_law
@pytest.mark.parametrize(
    "constraint", [pytest.param(name, marks=marks(name)) for name in ("free", "A fixed", "B fixed")]
)
@crossed
@given(data=st.data())
def test_oblique_central_equals_linear_central_in_line(
    constraint: str, law: str, data: Any
) -> None:
    """Without motion across the normal there is no slip to rub, so any friction gives the linear
    answer.
    """
    scene, answer = data.draw(scenes("linear_central", constraint, law))
    value = data.draw(VALUES["friction"])
    assert_same(
        solved("linear_central", scene),
        solved("oblique_central", replace(scene, value=value)),
        scene,
        answer,
    )


# --- The two laws ---------------------------------------------------------------------------------


@st.composite
def sticking_twice(draw: Any, constraint: str, law: str) -> tuple[Scene, Answer, Scene, Answer]:
    """A scene that closes and sticks with friction=inf under two normals."""
    first = draw(impacts(constraint, law, "friction", math.inf))
    second = replace(first, normal=first.normal + draw(st.floats(-0.8, 0.8)))
    answers = evaluate(first), evaluate(second)
    assume(all(answerable(answer) for answer in answers))
    return first, answers[0], second, answers[1]


def scene_impulse(impact: col.Impact) -> tuple[float, float]:
    """Impulse on B in scene axes."""
    return impact.b.impulse_x, impact.b.impulse_y


@pytest.mark.slow
@every_constraint
@crossed
@given(data=st.data())
def test_kudlich_slibar_sticking_does_not_know_the_normal(constraint: str, data: Any) -> None:
    """Under "kudlich-slibar" the impulse that stops all motion of the contact is the same whatever
    the normal.
    """
    first, one, second, two = data.draw(sticking_twice(constraint, "kudlich-slibar"))
    (x1, y1), (x2, y2) = (scene_impulse(solved("eccentric", scene)) for scene in (first, second))
    assert math.hypot(x1 - x2, y1 - y2) <= impulse_error(one) + impulse_error(two)


@pytest.mark.slow
@every_constraint
@crossed
@given(data=st.data())
def test_brach_sticking_knows_the_normal(constraint: str, data: Any) -> None:
    """Under "brach" it changes with the normal as restitution along it does: K (P1 - P2) = e (g1 n1
    - g2 n2).
    """
    first, one, second, two = data.draw(sticking_twice(constraint, "brach"))
    impacts_found = solved("eccentric", first), solved("eccentric", second)
    (x1, y1), (x2, y2) = map(scene_impulse, impacts_found)
    (n1, n2), e = (impact.normal for impact in impacts_found), first.restitution
    wanted = [e * (float(one.closing) * n1[i] - float(two.closing) * n2[i]) for i in (0, 1)]
    assume(math.hypot(*wanted) > 1e-3 * float(one.s_u))
    # K takes each error of P to at most tr times it; n and g, found again here, are within 8 eps
    # S_U.
    c, s = n1
    trace = float(one.k_nn + one.k_tt)
    dn, dt = c * (x1 - x2) + s * (y1 - y2), c * (y1 - y2) - s * (x1 - x2)
    found_n, found_t = (
        float(one.k_nn) * dn + float(one.k_nt) * dt,
        float(one.k_nt) * dn + float(one.k_tt) * dt,
    )
    error = impulse_error(one) + impulse_error(two)
    allowed = trace * error + 8 * EPS * float(one.s_u) + 4 * EPS * trace * math.hypot(dn, dt)
    assert (
        math.hypot(
            found_n - (c * wanted[0] + s * wanted[1]), found_t - (c * wanted[1] - s * wanted[0])
        )
        <= allowed
    )
    assert math.hypot(x1 - x2, y1 - y2) > 100 * error


@pytest.mark.slow
@crossing(PLANAR)
@crossed
@given(data=st.data())
def test_the_laws_agree_without_friction_and_without_restitution(
    model: str, constraint: str, data: Any
) -> None:
    """Frictionless, or at e = 0 with any friction, "brach" and "kudlich-slibar" are one law."""
    frictionless = data.draw(st.booleans())
    scene = data.draw(
        impacts(
            constraint,
            "brach",
            "friction",
            0.0 if frictionless else None,
            turning=model == "eccentric",
        )
    )
    if model == "oblique_central":
        scene = flat(scene)
    if not frictionless:
        scene = replace(scene, restitution=0.0)
    answer = evaluate(scene)
    assume(answerable(answer))
    assert_same(
        solved(model, scene), solved(model, replace(scene, law="kudlich-slibar")), scene, answer
    )


@pytest.mark.slow
@physics
@given(data=st.data())
def test_the_laws_differ_where_a_contact_sticks_and_restores(data: Any) -> None:
    """With slip, restitution and enough friction the slip ends at 0 under "brach" and at -e times
    itself under the other.
    """
    scene = data.draw(impacts("free", "brach", "friction", math.inf))
    other = replace(scene, law="kudlich-slibar")
    answers = evaluate(scene), evaluate(other)
    assume(all(answerable(answer) for answer in answers))
    assume(scene.restitution > 1e-3 and abs(answers[0].slip) > 1e-3 * answers[0].s_u)
    one, two = solved("eccentric", scene), solved("eccentric", other)
    assert one.slip_after == 0.0
    assert two.slip_after == -scene.restitution * two.slip_before != 0.0
    assert math.hypot(*np.subtract(scene_impulse(one), scene_impulse(two))) > 100 * impulse_error(
        answers[0]
    )


# --- Refusal --------------------------------------------------------------------------------------


@every_law
@every_model
@crossed
@given(data=st.data())
def test_separating_bodies_are_refused_with_their_speed(
    model: str, constraint: str, law: str, data: Any
) -> None:
    """With the normal turned round the bodies part: NoImpactError, code separating, with the
    negative closing speed.
    """
    scene, answer = data.draw(scenes(model, constraint, law))
    n = (
        scene.normal
        if isinstance(scene.normal, tuple)
        else (math.cos(scene.normal), math.sin(scene.normal))
    )
    with pytest.raises(col.NoImpactError, match="from A into B") as caught:
        solved(model, replace(scene, normal=(-n[0], -n[1])))
    assert caught.value.code == "separating"
    assert caught.value.closing_speed < 0.0
    # The promise of the closing speed, 4 eps S_U; the normal given here is rounded from the angle,
    # which is 1 eps of S_U.
    assert abs(caught.value.closing_speed + float(answer.closing)) <= 5 * EPS * float(answer.s_u)
    assert (
        solved(model, replace(scene, normal=(-n[0], -n[1])), on_failure="nan").status.label
        == "separating"
    )
