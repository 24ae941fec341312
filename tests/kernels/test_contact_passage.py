"""Law "stronge": a contact whose slip may stop or turn around, against an integration, worked cases
and the other laws.
"""

import cmath
import itertools
import math
import random
import warnings
from dataclasses import replace

import numpy as np
import pytest

import collisions as col
from collisions.derivation import explain
from reference import EPS, evaluate
from scenes import FAMILIES, TURNING, cases, draw, solved, solved_together

A, B = TURNING
PLACE = {"normal": 0.3, "point": (0.1, 0.2)}
# A light bar struck beside its centre: slip stops early, and the levers push it back faster than
# friction can hold.
BAR = col.Vehicle(mass=1.0, yaw_inertia=0.09, vx=2.0, vy=-0.2, x=0.0, y=0.0)
WALL = col.Vehicle.barrier()
AT_ITS_END = {"normal": 0.0, "point": (0.5, -0.8)}


def runge_kutta(scene, steps):
    """Velocities and work by steps of the impulse, each of fourth order, with the friction of the
    slip there is: no corner known.

    The slip is followed with a force that turns within a thousandth of the speeds, so that nothing
    is asked where it stops.
    """
    answer = evaluate(replace(scene, value=0.0))
    k = np.array([[answer.k_nn, answer.k_nt], [answer.k_nt, answer.k_tt]], dtype=float)
    # State: closing speed, slip, work along the normal; by the normal impulse.
    start = np.array([float(answer.closing), float(answer.slip), 0.0])
    step = 3.0 * start[0] / k[0, 0] / steps

    def rate(state):
        ratio = -scene.value * math.tanh(state[1] / (1e-3 * abs(start[:2]).sum()))
        by_n, by_t = k @ (1.0, ratio)
        return np.array([-by_n, by_t, state[0]])

    states, state, most = [start], start, 0.0
    while True:
        one = rate(state)
        two = rate(state + 0.5 * step * one)
        three = rate(state + 0.5 * step * two)
        state = state + step / 6.0 * (one + 2.0 * two + 2.0 * three + rate(state + step * three))
        states.append(state)
        most = max(most, state[2])
        goal = most * (1.0 - scene.restitution**2)
        if state[0] < 0.0 and state[2] <= goal:
            before = states[-2]
            part = (before[2] - goal) / (before[2] - state[2])
            return (len(states) - 2 + part) * step, *(before + part * (state - before))[:2], most


@pytest.mark.slow
def test_an_integration_that_knows_no_corner_comes_to_the_same():
    """To what the smoothed friction and the last step leave: 1e-3 each."""
    rng = random.Random(7)
    seen = set()
    for _ in range(16):
        scene = draw("traffic", "stronge", "friction", rng)
        scene = replace(scene, value=rng.uniform(0.05, 0.9), restitution=rng.uniform(0.05, 0.9))
        impact = solved("eccentric", scene)
        normal, closing, slip, work = runge_kutta(scene, 3000)
        speeds = impact.closing_speed + abs(impact.slip_before)
        assert impact.normal_impulse == pytest.approx(normal, rel=4e-3), scene
        assert impact.separation_speed == pytest.approx(-closing, abs=4e-3 * speeds), scene
        assert impact.slip_after == pytest.approx(slip, abs=4e-3 * speeds), scene
        assert impact.energy_absorbed == pytest.approx(work, rel=4e-3), scene
        seen.add(impact.regime)
    assert {"sliding", "sticking"} <= seen


@pytest.mark.slow
@pytest.mark.parametrize("family", ["traffic", "barrier", "A pinned", "inertia x 1e-12..1e12"])
def test_it_is_brach_where_the_slip_goes_on_to_the_end(family):
    """With the same way to slide, by 16 eps of the spread; and without friction."""
    slid = 0
    for scene, answer in cases(family, "stronge", "friction", 100):
        ours = solved("eccentric", scene)
        if ours.regime == "frictionless" or (
            ours.regime == "sliding" and answer.separation == scene.restitution * answer.closing
        ):
            brach = solved("eccentric", replace(scene, law="brach"))
            off = math.hypot(
                ours.normal_impulse - brach.normal_impulse,
                ours.tangential_impulse - brach.tangential_impulse,
            )
            assert off <= 16 * EPS * float(answer.spread), scene
            slid += 1
    assert slid > 10


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_it_never_gains_energy(family):
    """Both losses are sums of terms that are not negative, and together the difference of the
    kinetic energies.
    """
    for scene, _ in cases(family, "stronge", "friction", 100):
        impact = solved("eccentric", scene)
        assert impact.ok
        assert impact.energy_loss_normal >= 0.0
        assert impact.energy_loss_tangential >= 0.0
        assert impact.energy_loss == impact.energy_loss_normal + impact.energy_loss_tangential
        restored = (1.0 - scene.restitution) * (1.0 + scene.restitution) * impact.energy_absorbed
        # The energy absorbed is that of the plastic impact, worked out by itself: two evaluations.
        assert impact.energy_loss_normal == pytest.approx(restored, rel=64 * EPS, abs=0.0)


def test_slip_that_turns_around():
    """A bar on a wall: by hand, the contact slides, stops, and is pushed back over friction that
    cannot hold it.
    """
    impact = col.eccentric(BAR, WALL, 0.5, friction=0.2, law="stronge", **AT_ITS_END)
    k_nn, k_nt, k_tt = 1.0 + 0.64 / 0.09, 0.4 / 0.09, 1.0 + 0.25 / 0.09
    closing, slip = 2.0, 0.2

    back = col.eccentric(BAR.replace(vy=0.2), WALL, 0.5, friction=0.2, law="stronge", **AT_ITS_END)
    stop = slip / (k_nt + 0.2 * k_tt)
    w = closing - (k_nn + 0.2 * k_nt) * stop
    softer = k_nn - 0.2 * k_nt
    worked = stop * (closing + w) / 2.0 + w * w / (2.0 * softer)
    parting = 0.5 * math.sqrt(2.0 * softer * worked)
    after = (w + parting) / softer
    assert impact.regime == "sliding"
    assert back.regime == "reversing"
    assert back.normal_impulse == pytest.approx(stop + after, rel=1e-13)
    assert back.tangential_impulse == pytest.approx(0.2 * stop - 0.2 * after, rel=1e-12)
    assert back.separation_speed == pytest.approx(parting, rel=1e-13)
    assert back.slip_after == pytest.approx((k_nt - 0.2 * k_tt) * after, rel=1e-12)
    assert back.energy_absorbed == pytest.approx(worked, rel=1e-13)
    assert back.slip_before < 0.0 < back.slip_after
    assert "slides on" in explain(back)
    assert "the numbers cancel" not in explain(back)


@pytest.mark.slow
def test_the_end_of_compression_is_that_of_the_plastic_impact():
    for law_scene, _ in cases("traffic", "stronge", "friction", 60):
        impact = solved("eccentric", law_scene)
        plastic = solved("eccentric", replace(law_scene, restitution=0.0))
        assert impact.compression_impulse == pytest.approx(plastic.normal_impulse, rel=1e-12)
        assert impact.a.at_compression.yaw_rate == pytest.approx(
            plastic.a.after.yaw_rate, rel=1e-12, abs=1e-12
        )
        nx, ny = impact.normal
        speeds = [
            nx * u + ny * v
            for u, v in (s.at_compression.velocity_at(impact.point) for s in (impact.a, impact.b))
        ]
        # Velocities of up to 50 m/s that are added up.
        assert speeds[0] == pytest.approx(speeds[1], abs=1e-11)
        assert impact.common_velocity == pytest.approx(speeds[0], abs=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize(
    "pushed",
    [{}, {"outside_a": (400.0, -200.0, 100.0), "outside_b": (-300.0, 100.0)}],
    ids=["alone", "pushed"],
)
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar", "stronge"])
def test_every_answer_is_continuous_in_the_restitution(law, pushed):
    """Through 0 into an incomplete impact, and where such a one ends before the slip has stopped:
    on a grid of a quarter of the step the largest step of the answer is a quarter, or a half beside
    a root, where a jump would stay as it is."""
    rng = random.Random(f"continuous {law}")
    for _ in range(25):
        friction = rng.uniform(0.05, 1.5)
        a = A.replace(
            vx=rng.uniform(5.0, 20.0), vy=rng.uniform(-6.0, 6.0), y=rng.uniform(-1.0, 1.0)
        )
        b = B.replace(vy=rng.uniform(-6.0, 6.0), yaw_inertia=rng.choice((300.0, 1700.0)))
        contact = {
            "friction": friction,
            "law": law,
            "incomplete": True,
            "on_failure": "nan",
            **PLACE,
            **pushed,
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.EnergyGainWarning)
            coarse, fine = (
                col.eccentric(a, b, np.linspace(-0.9, 0.9, count), **contact)
                for count in (451, 1801)
            )
        for name in (
            "normal_impulse",
            "tangential_impulse",
            "energy_loss",
            "separation_speed",
            "slip_after",
        ):
            of_coarse, of_fine = (
                np.nanmax(abs(np.diff(getattr(impact, name)))) for impact in (coarse, fine)
            )
            # Rounding of impulses of 20 kN s and energies of 100 kJ.
            assert of_fine <= 0.6 * of_coarse + 1e-8, (name, friction, a, b)


@pytest.mark.slow
def test_a_batch_is_its_cases():
    scenes = [scene for scene, _ in cases("traffic", "stronge", "friction", 60)]
    many = solved_together("eccentric", scenes)
    for at, scene in enumerate(scenes):
        one = solved("eccentric", scene)
        assert many.normal_impulse[at] == pytest.approx(one.normal_impulse, rel=1e-12)
        assert many.separation_speed[at] == pytest.approx(one.separation_speed, rel=1e-12)
        assert many.energy_absorbed[at] == pytest.approx(one.energy_absorbed, rel=1e-12)
        assert many.regime[at] == one.regime


def test_a_large_batch_runs_the_traced_kernel_to_the_same_numbers():
    """From 8,193 cases on blocks replay the recorded steps: the same operations, so the
    same bits.
    """
    rng = np.random.default_rng(1)
    a = A.replace(vx=rng.uniform(1.0, 20.0, 9000), vy=rng.uniform(-9.0, 9.0, 9000))
    mu = rng.uniform(0.0, 1.5, 9000)
    large = col.eccentric(a, B, 0.2, friction=mu, law="stronge", on_failure="nan", **PLACE)
    small = col.eccentric(
        a.replace(vx=a.vx[:500], vy=a.vy[:500]),
        B,
        0.2,
        friction=mu[:500],
        law="stronge",
        on_failure="nan",
        **PLACE,
    )
    for name in (
        "normal_impulse",
        "tangential_impulse",
        "energy_loss",
        "separation_speed",
        "slip_after",
    ):
        assert np.array_equal(getattr(large, name)[:500], getattr(small, name), equal_nan=True), (
            name
        )
    assert np.array_equal(large.status[:500], small.status)


def test_point_masses_part_as_under_brach():
    a, b = A.replace(yaw_rate=0.0), B
    for friction in (0.0, 0.3, 1.2, math.inf):
        ours, brach = (
            col.oblique_central(a, b, 0.3, normal=0.3, friction=friction, law=law)
            for law in ("stronge", "brach")
        )
        assert ours.normal_impulse == pytest.approx(brach.normal_impulse, rel=1e-14)
        assert ours.tangential_impulse == pytest.approx(brach.tangential_impulse, rel=1e-13)
        assert ours.separation_speed == pytest.approx(0.3 * ours.closing_speed, rel=1e-13)


@pytest.mark.parametrize("rule", ["impulse_ratio", "critical_fraction"])
def test_it_takes_friction_only(rule):
    for call in (
        lambda: col.eccentric(A, B, 0.1, law="stronge", **PLACE, **{rule: 0.2}),
        lambda: col.oblique_central(
            A.replace(yaw_rate=0.0), B, 0.1, normal=0.0, law="stronge", **{rule: 0.2}
        ),
        lambda: col.solve(A, B, 0.1, law="stronge", **PLACE, **{rule: 0.2}),
    ):
        with pytest.raises(
            col.InputError, match=f"law 'stronge' works with friction= alone, got {rule}="
        ) as refused:
            call()
        assert refused.value.code == "bad_combination"


def test_reverse_solvers_refuse_it():
    impact = col.eccentric(A, B, 0.3, friction=0.5, law="stronge", **PLACE)
    contact = {"friction": 0.5, "law": "stronge", **PLACE}
    with pytest.raises(
        col.InputError, match="planar cannot go back under law 'stronge'"
    ) as refused:
        col.reconstruct.planar(impact.a.after, impact.b.after, restitution=0.3, **contact)
    assert refused.value.code == "law_not_reversible"
    with pytest.raises(
        col.InputError, match="speeds cannot go back under law 'stronge'"
    ) as refused:
        col.reconstruct.speeds(
            A, B, course_a=0.1, course_b=1.5, restitution=0.3, speed_b=9.0, delta_v_b=3.0, **contact
        )
    assert refused.value.code == "law_not_reversible"


def test_a_contact_that_friction_parts_before_it_is_pressed_is_refused():
    """Without bound friction stops the slip at once, and the lever of that impulse parts the
    contact along the normal.
    """
    bar = BAR.replace(vy=3.0, vx=0.5)
    with pytest.raises(col.NoSolutionError, match="needs the bodies to pull") as refused:
        col.eccentric(bar, WALL, 0.5, friction=math.inf, law="stronge", **AT_ITS_END)
    assert refused.value.code == "no_slip_pulls"
    many = col.eccentric(
        bar,
        WALL,
        0.5,
        friction=np.array([0.3, math.inf]),
        law="stronge",
        on_failure="nan",
        **AT_ITS_END,
    )
    assert many.status.tolist() == [col.Status.OK, col.Status.NO_SLIP_PULLS]
    assert math.isnan(many.normal_impulse[1])


def test_a_contact_of_one_degree_of_freedom_is_refused_as_under_the_other_laws():
    gate = col.Vehicle(
        mass=1000.0, yaw_inertia=1300.0, yaw_rate=-1.0, x=0.0, y=2.0, pivot=(0.0, 0.0)
    )
    for law in ("brach", "stronge"):
        with pytest.raises(col.NoSolutionError) as refused:
            col.eccentric(gate, WALL, 0.3, normal=0.0, point=(0.3, 4.0), friction=0.4, law=law)
        assert refused.value.code == "singular_contact"
    one, other = (
        col.eccentric(gate, WALL, 0.3, normal=0.0, point=(0.3, 4.0), friction=0.0, law=law)
        for law in ("brach", "stronge")
    )
    assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=1e-15)


def test_at_rest_along_the_tangent_it_slides_as_under_brach():
    for friction in (0.05, 0.2):
        ours, brach = (
            col.eccentric(BAR.replace(vy=0.0), WALL, 0.4, friction=friction, law=law, **AT_ITS_END)
            for law in ("stronge", "brach")
        )
        assert ours.regime == brach.regime == "sliding"
        assert ours.normal_impulse == pytest.approx(brach.normal_impulse, rel=1e-13)
        assert ours.tangential_impulse == pytest.approx(brach.tangential_impulse, rel=1e-13)


@pytest.mark.slow
def test_explained_where_the_slip_goes_on_stops_and_turns():
    rng = random.Random(4)
    seen = set()
    while len(seen) < 4:
        scene = draw("traffic", "stronge", "friction", rng)
        impact = solved("eccentric", replace(scene, normal=0.3), on_failure="nan")
        if impact.refused or impact.regime in seen:
            continue
        seen.add(impact.regime)
        for e in (impact.restitution, -0.3):
            page = explain(impact.again(restitution=e, incomplete=True), form="text")
            assert "In this form the numbers cancel" not in page
    assert seen == {"frictionless", "sliding", "sticking", "reversing"}


# The worked regimes of Jia, Gardner and Mu, "Batting an in-flight object to the target",
# International Journal of Robotics Research 38 (2019) 451, figure 3, b to f: an ellipse strikes a
# polygon. The inputs are those of the program that the authors published with it
# (xqmu/2D-Frictional-Impact on GitHub). By letter: friction, velocity of the polygon, regime,
# whether the slip stops before the end of compression, and what the equations in that program give,
# to 12 digits: normal impulse at the end of compression and in the end, tangential impulse, work
# absorbed, velocity and yaw rate of the polygon after, yaw rate of the ellipse after.
POLYGON = ((0.0, 0.0), (0.01, 0.03), (0.07, 0.05), (0.07, 0.0), (0.05, -0.02))
BATTED = {
    "b": (
        0.5,
        (-1.52, -2.75),
        "sliding",
        False,
        (
            0.244415066986,
            0.476609380622,
            0.238304690311,
            0.308223367382,
            1.37525783205,
            -2.13255687753,
            -1.55653538955,
            -8.35260549009,
        ),
    ),
    "c": (
        0.95,
        (-1.52, -2.75),
        "sticking",
        True,
        (
            0.41847050889,
            0.712709392799,
            0.474050820068,
            0.5777981005,
            2.97350192927,
            -1.19372707089,
            -28.8579536291,
            -34.754179646,
        ),
    ),
    "d": (
        0.3,
        (0.0, 7.5),
        "reversing",
        True,
        (
            0.214373797737,
            0.440637665981,
            0.0462474320239,
            0.354751245081,
            2.43417443587,
            7.13469403658,
            57.5144505981,
            19.2840573898,
        ),
    ),
    "e": (
        0.8,
        (-1.52, -2.75),
        "sticking",
        False,
        (
            0.358442551386,
            0.668808601444,
            0.459030156817,
            0.452019474756,
            2.71647438711,
            -1.21333236226,
            -33.9149595221,
            -34.2028437699,
        ),
    ),
    "f": (
        0.01,
        (0.0, 7.5),
        "reversing",
        False,
        (
            0.227785649283,
            0.445256748734,
            0.000771422537266,
            0.412486159331,
            2.39349552335,
            6.87539215244,
            75.1380081239,
            26.5760903806,
        ),
    ),
}


def batted(letter):
    """The ellipse, the polygon about its centroid, and the contact, at the origin, with a
    restitution of 0.95.
    """
    friction, (vx, vy), *_ = BATTED[letter]
    area = first_x = first_y = second = 0.0
    for (x, y), (next_x, next_y) in itertools.pairwise((*POLYGON, POLYGON[0])):
        twice = x * next_y - next_x * y
        area += twice / 2.0
        first_x, first_y = (
            first_x + (x + next_x) * twice / 6.0,
            first_y + (y + next_y) * twice / 6.0,
        )
        second += (
            (x * x + x * next_x + next_x * next_x + y * y + y * next_y + next_y * next_y)
            * twice
            / 12.0
        )
    x, y = first_x / area, first_y / area
    polygon = col.Vehicle(
        mass=0.18,
        yaw_inertia=0.18 * (second / area - x * x - y * y),
        vx=vx,
        vy=vy,
        yaw_rate="-30 rad/s",
        x=x,
        y=y,
    )
    # The ellipse is turned by -2.944, so that the place struck lies ahead of its centre along x;
    # its normal is that of the outline.
    wide, high, turn = 0.07, 0.045, -2.944
    reach = 1.0 / math.hypot(math.cos(turn) / wide, math.sin(turn) / high)
    outward = cmath.exp(1j * turn) * complex(math.cos(turn) / wide**2, -math.sin(turn) / high**2)
    ellipse = col.Vehicle(
        mass=0.252,
        yaw_inertia=0.252 * (wide**2 + high**2) / 4.0,
        vx=2.345,
        vy=4.339,
        yaw_rate="9.011 rad/s",
        x=-reach,
        y=0.0,
    )
    return (
        ellipse,
        polygon,
        0.95,
        {"normal": cmath.phase(outward), "point": (0.0, 0.0), "friction": friction},
    )


@pytest.mark.parametrize("letter", BATTED)
def test_published_worked_regimes(letter):
    """To half of the last digit given; and followed in time."""
    ellipse, polygon, e, contact = batted(letter)
    *_, regime, early, wanted = BATTED[letter]
    impact = col.eccentric(ellipse, polygon, e, **contact, law="stronge")
    assert impact.regime == regime
    # The end of compression is that of the plastic impact.
    assert impact.again(restitution=0.0).regime == (regime if early else "sliding")
    after = impact.b.after
    found = (
        impact.compression_impulse,
        impact.normal_impulse,
        abs(impact.tangential_impulse),
        impact.energy_absorbed,
    )
    found += (after.vx, after.vy, after.yaw_rate, impact.a.after.yaw_rate)
    assert found == pytest.approx(wanted, rel=5e-12)
    assert impact.energy_loss_normal == pytest.approx((1.0 - e**2) * wanted[3], rel=5e-12)
    # The design's figures for fixed geometry; the force of half a sine is summed up to (w h)^2 /
    # 24, which is 4e-5 and 1e-5 here.
    for steps, part in ((100, 6e-5), (200, 1.4e-5)):
        passed = col.time_resolved(
            ellipse, polygon, e, **contact, geometry="fixed", duration="1 ms", steps=steps
        )
        assert passed.regime == regime
        assert (
            math.hypot(passed.b.after.vx - wanted[4], passed.b.after.vy - wanted[5])
            < part * impact.b.delta_v
        )
