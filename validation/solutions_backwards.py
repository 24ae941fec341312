"""The published cases worked backwards: from what the source printed of the end to what it began
with.

What the end is known to in print limits what the beginning can be, so every figure that goes in is
moved by half a unit in its last digit (``published_cases.Printed``). Cases whose print is wrong are
refuted: their printed end does not lead back.
"""

from __future__ import annotations

import math
import warnings
from typing import Any

from published_cases import FIXED, backwards, given, number, output
from solutions import (
    COURSE,
    COURSES,
    MPH,
    barrier_impact,
    barrier_rows,
    carpenter_impact,
    carpenter_normal,
    hinged,
    oblique_impact,
    oblique_rows,
)

import collisions as col
from collisions import reconstruct

BOTH = ("published_outputs", "recomputed_outputs")
LBF_S = 4.4482216152605
Found = dict[str, float]

# In line


@backwards("L05", "L07", figures=("v1", "v2"), kinds=BOTH, most={"u1": 0.2, "u2": 0.2})
def elastic_pair(case: str, v1: float, v2: float) -> Found:
    """From both velocities after to both before."""
    known = {"va_after": v1, "vb_after": v2, "restitution": given(case, "e")}
    found = reconstruct.central(given(case, "m1"), given(case, "m2"), **known)
    return {"u1": found.a.before.vx, "u2": found.b.before.vx}


@backwards("L08", figures=("m2", "KE_change"), most={"u1": 2e-5, "u2": 2e-5})
def train_cars(case: str, m2: float, change: float) -> Found:
    """From the energy that a plastic impact took and the common velocity."""
    known = {"va_after": given(case, "v_common"), "restitution": 0.0, "energy_loss": -change}
    found = reconstruct.central(given(case, "m1"), m2, **known)
    return {"u1": found.a.before.vx, "u2": found.b.before.vx}


@backwards("L11", figures=("dV1_from_e",), most={"u1": 2e-4})
def closing_speed(case: str, dv: float) -> Found:
    """From one delta-V and the restitution."""
    masses = given(case, "m1"), given(case, "m2")
    return {"u1": reconstruct.inline_closing_speed(*masses, 0.2, delta_v_a=f"{dv} mph") / MPH}


# Vehicles that leave as one: from where they went, both speeds before


def before_sticking(case: str, speed: float, direction: float) -> reconstruct.MomentumSolution:
    """The motion before of two vehicles that left as one."""
    courses = {"course_a": COURSES[case][0].replace("-90", "270"), "course_b": COURSES[case][1]}
    after = {
        "together": True,
        "speed_a_after": speed,
        "course_a_after": f"{COURSE[case](direction)!r} deg",
    }
    return reconstruct.momentum(given(case, "m1"), given(case, "m2"), **courses, **after)


def both_speeds(case: str, speed: float, direction: float) -> Found:
    """M01 icy intersection, M03, M05, M07: both speeds before from the common velocity."""
    found = before_sticking(case, speed, direction)
    return {"v1": found.speed_a, "v2": found.speed_b}


END = ("speed", "direction")
backwards(*COURSES, figures=END, most={"v1": 2e-3, "v2": 2e-3})(both_speeds)
backwards("M01", "M05", figures=END, kinds=BOTH[:1], most={"v1": 0.2, "v2": 0.2})(both_speeds)
# M03's printed angle and M07's printed speed and angle do not lead back to the speeds of their own
# text.
backwards("M03", "M07", figures=END, kinds=BOTH[:1], most={"v1": 0.05, "v2": 0.05}, wrong=True)(
    both_speeds
)


@backwards(
    "M01", figures=END, most={"KE_lost": 2.0}, expected={"KE_lost": float(output("M01", "KE_lost"))}
)
def energy_of_sticking(case: str, speed: float, direction: float) -> Found:
    """The energy that the icy intersection took, from where they went."""
    return {"KE_lost": before_sticking(case, speed, direction).translational_energy_loss}


# At an angle


BALLS = ("vA_normal_after", "vA_tangential", "vB_after")


@backwards("O01", figures=BALLS, most={"vA": 0.3, "vB": 0.3})
def balls_by_momentum(case: str, vx: float, vy: float, vb: float) -> Found:
    """Both speeds before the collision of two balls."""
    with warnings.catch_warnings():
        # An elastic impact: the rounding of the print decides whether it loses or gains a little
        # energy.
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        found = reconstruct.momentum(
            1.0,
            1.0,
            course_a="30 deg",
            course_b="180 deg",
            course_a_after=math.atan2(vy, vx),
            course_b_after=0.0,
            speed_a_after=math.hypot(vx, vy),
            speed_b_after=vb,
        )
    return {"vA": found.speed_a, "vB": found.speed_b}


@backwards("O01", figures=BALLS, most={"vA": 0.3, "vB": 0.3})
def balls_by_the_impact_reversed(case: str, vx: float, vy: float, vb: float) -> Found:
    """The same by the contact."""
    a = col.Vehicle(mass=1.0, yaw_inertia=math.inf, vx=vx, vy=vy, x=-1.0, y=0.0)
    b = col.Vehicle(mass=1.0, yaw_inertia=math.inf, vx=vb, x=1.0, y=0.0)
    found = reconstruct.planar(
        a, b, normal=0.0, point=(0.0, 0.0), restitution=given(case, "e"), friction=0.0
    )
    return {"vA": found.a.before.speed, "vB": found.b.before.speed}


def bounce(ratio: float, angle: float) -> col.Vehicle:
    """A ball after the smooth surface, at unit speed before, from its speed ratio and its angle
    from the normal in degrees.
    """
    angle = math.radians(angle)
    return col.Vehicle(
        mass=0.06,
        yaw_inertia=math.inf,
        vx=ratio * math.sin(angle),
        vy=ratio * math.cos(angle),
        x=0.0,
        y=0.03,
    )


def ball_before(case: str, ratio: float, angle: float) -> Found:
    """Unit speed, the angle of incidence, and the restitution that the end shows of a ball that
    came so.
    """
    end, known = bounce(ratio, angle), {"restitution": given(case, "e"), "friction": 0.0}
    before = reconstruct.planar(end, FIXED, normal="-90 deg", point=(0.0, 0.0), **known).a.before
    came = col.Vehicle(mass=0.06, vx=math.sin(math.pi / 4), vy=-math.cos(math.pi / 4))
    return {
        "speed": before.speed,
        "incidence": math.degrees(math.atan2(before.vx, -before.vy)),
        "e": reconstruct.restitution(came, FIXED, end, FIXED, normal="-90 deg"),
    }


BOUNCE = {"figures": ("speed_ratio", "rebound_angle_from_normal"), "expected": {"speed": 1.0}}
backwards("O02", most={"speed": 2e-4, "incidence": 2e-4, "e": 2e-4}, **BOUNCE)(ball_before)
backwards("O02", kinds=BOTH[:1], most={"speed": 0.1, "e": 0.1}, wrong=True, **BOUNCE)(ball_before)


# About a pivot


def unhinged(case: str, turn: float, v: float, **known: Any) -> Found:
    """The motions before of a striker and a hinged body, from those after."""
    impact = hinged(case, 0.5)
    ends = (
        impact.a.before.replace(vx=v, vy=0.0),
        impact.b.before.replace(yaw_rate=turn, vx=0.0, vy=0.0),
    )
    found = reconstruct.planar(*ends, normal=0.0, point=impact.point, friction=0.0, **known)
    return {"striker": found.a.before.vx, "turn": found.b.before.yaw_rate}


def hinged_before(case: str, turn: float, v: float) -> Found:
    """The same with the restitution of the case."""
    return unhinged(case, turn, v, restitution=given(case, "e"))


ROD = {"striker": number("C01", "v_sphere"), "turn": 0.0}
ENDS = ("omega", "v_sphere_after")
backwards("C01", figures=ENDS, kinds=BOTH[:1], most={"striker": 0.05, "turn": 0.05}, expected=ROD)(
    hinged_before
)
backwards("C01", figures=ENDS, most={"striker": 1e-3, "turn": 1e-3}, expected=ROD)(hinged_before)
# With 5/3 for its 1.67 kg m2 the print of C03 misses the implied 10 m/s and a rod at rest.
CENTRE = {"striker": number("C03", "implied_v_ball"), "turn": 0.0}
MOST = {"striker": 1e-3, "turn": 1e-3}
backwards("C03", figures=("omega", "v_ball_after"), most=MOST, expected=CENTRE)(hinged_before)
backwards(
    "C03", figures=("omega_with_1p67", "v_ball_with_1p67"), most=MOST, expected=CENTRE, wrong=True
)(hinged_before)


@backwards(
    "C04",
    figures=("omega",),
    most={"striker": 1e-4, "turn": 1e-4},
    expected={"striker": number("C04", "v_bullet"), "turn": 0.0},
)
def bullet_before(case: str, turn: float) -> Found:
    """Plastic: the restitution leads nowhere back, the closing speed does."""
    v = turn * number(case, "strike_distance_from_hinge")
    return unhinged(case, turn, v, closing_speed=given(case, "v_bullet"))


# Eccentric


def bar_before(case: str, turn: float, v: float) -> Found:
    """From the bar's turning and rebound to 30 ft/s without spin."""
    inertia = f"{2 * number(case, 'L') ** 2 / 12!r} lb*ft**2"
    end = col.Vehicle(
        vx=f"{-v!r} ft/s", yaw_rate=-turn, mass="2 lb", yaw_inertia=inertia, x=0.0, y=0.0
    )
    contact = {
        "point": (0.0, given(case, "contact_offset_from_cg")),
        "restitution": given(case, "e"),
        "friction": 0.0,
    }
    found = reconstruct.planar(end, FIXED, normal="180 deg", **contact).a.before
    return {"v": -found.q.vx.m_as("ft/s"), "turn": found.yaw_rate}


BAR = {"figures": ("omega", "v_cg_after"), "expected": {"turn": 0.0}}
backwards("E01", kinds=BOTH[:1], most={"v": 0.02, "turn": 0.06}, **BAR)(bar_before)
backwards("E01", most={"v": 2e-3, "turn": 6e-3}, **BAR)(bar_before)


@backwards(
    "E03",
    "E06",
    figures=("impulse_on_1", "d_omega2", "d_omega1", "critical_impulse_ratio"),
    most={"v1": 0.2, "v2": 0.2},
)
def oblique_before(
    case: str, jx: float, jy: float, turn_a: float, turn_b: float, ratio: float
) -> Found:
    """From the motions after, with the printed critical ratio as impulse ratio, to the impact
    speeds; vehicle 2 is A.

    The spread is what the four digits of the ratio and the impulse to 0.1 lb s are worth, through
    (1+e)/e of 8 to 9.
    """
    impact = oblique_impact(*oblique_rows(case))
    a, b = impact.a.before, impact.b.before
    a = a.replace(
        vx=a.vx - jx * LBF_S / a.mass, vy=a.vy - jy * LBF_S / a.mass, yaw_rate=math.radians(turn_a)
    )
    b = b.replace(
        vx=b.vx + jx * LBF_S / b.mass, vy=b.vy + jy * LBF_S / b.mass, yaw_rate=math.radians(turn_b)
    )
    contact = {
        "normal": impact.normal,
        "point": (0.0, 0.0),
        "restitution": impact.restitution,
        "impulse_ratio": ratio,
    }
    found = reconstruct.planar(a, b, **contact)
    return {"v1": found.b.before.speed / MPH, "v2": found.a.before.speed / MPH}


def recorded(case: str, **known: Any) -> Any:
    """The scene of an NHTSA test put to ``speeds`` with two things known."""
    impact = oblique_impact(*oblique_rows(case))
    a, b = impact.a.before, impact.b.before
    return reconstruct.speeds(
        a.replace(vx=0.0, vy=0.0),
        b.replace(vx=0.0, vy=0.0),
        course_a=a.heading,
        course_b=b.heading,
        restitution=impact.restitution,
        normal=impact.normal,
        point=(0.0, 0.0),
        critical_fraction=1.0,
        **known,
    )


def nearest(case: str, found: Any, side: str) -> float:
    """The speed of a car among the answers that is nearest to the printed one, in mph; vehicle 2 is
    A.
    """
    speeds = [getattr(impact, side).before.speed / MPH for impact in found]
    return min(speeds, key=lambda speed: abs(speed - number(case, "v2" if side == "a" else "v1")))


@backwards("E03", "E06", figures=("dV2",), most={"v2": 5e-4})
def from_the_delta_v_of_2_and_the_speed_of_1(case: str, dv: float) -> Found:
    """As from a data recorder."""
    return {
        "v2": nearest(
            case, recorded(case, delta_v_a=f"{dv} mph", speed_b=f"{number(case, 'v1')} mph"), "a"
        )
    }


@backwards("E03", "E06", figures=("dV1",), most={"v1": 5e-4})
def from_the_delta_v_of_1_and_the_speed_of_2(case: str, dv: float) -> Found:
    """The other way round."""
    return {
        "v1": nearest(
            case, recorded(case, delta_v_b=f"{dv} mph", speed_a=f"{number(case, 'v2')} mph"), "b"
        )
    }


@backwards("E03", "E06", figures=("dV2", "energy_dissipated"), most={"v1": 0.02, "v2": 0.02})
def from_a_delta_v_and_the_energy(case: str, dv: float, loss: float) -> Found:
    """The printed speeds of both cars are among the answers."""
    with warnings.catch_warnings():
        warnings.filterwarnings(
            "ignore", "(?s).*backwards", col.OutOfRangeWarning
        )  # one of the other roots
        found = recorded(case, delta_v_a=f"{dv} mph", energy_loss=f"{loss} ft*lbf")
    return {"v1": nearest(case, found, "b"), "v2": nearest(case, found, "a")}


def carpenter() -> tuple[col.Impact, dict[str, Any]]:
    """The impact of the spreadsheet and its contact."""
    impact = carpenter_impact(carpenter_normal())
    contact = {
        "normal": impact.normal,
        "point": impact.point,
        "friction": given("E07", "cof"),
        "law": "kudlich-slibar",
    }
    return impact, contact


@backwards("E07", figures=("KE_dissipated", "Pt", "Pn"), kinds=BOTH[:1], most={"v1": 1e-5})
def carpenter_by_energy(case: str, loss: float, tangential: float, normal: float) -> Found:
    """Plastic: e says nothing of the speed before, but the energy with the printed ratio does."""
    impact, contact = carpenter()
    # From the printed motion the contact points would still approach by 1e-5 m/s, which is no end
    # of an impact.
    known = {
        **contact,
        "friction": None,
        "impulse_ratio": -tangential / normal,
        "energy_loss": f"{loss!r} ft*lbf",
    }
    return {
        "v1": reconstruct.planar(impact.a.after, impact.b.after, **known).a.before.q.vx.m_as("mph")
    }


@backwards("E07", figures=("dV1",), kinds=BOTH[:1], most={"v1": 2e-5})
def carpenter_by_delta_v(case: str, dv: float) -> Found:
    """And so does the delta-V."""
    impact, contact = carpenter()
    known = {
        "course_a": 0.0,
        "course_b": None,
        "speed_b": 0.0,
        "delta_v_a": f"{dv!r} mph",
        "restitution": 0.0,
    }
    (found,) = reconstruct.speeds(
        impact.a.before.replace(vx=0.0), impact.b.before, **known, **contact
    )
    return {"v1": found.a.before.q.vx.m_as("mph")}


@backwards("E09", figures=("dV",), most={"v": 2e-4})
def small_overlap(case: str, dv: float) -> Found:
    """CF11016 from the delta-V alone."""
    impact = barrier_impact(barrier_rows()["CF11016"])
    contact = {
        "restitution": impact.restitution,
        "normal": impact.normal,
        "point": impact.point,
        "critical_fraction": 0.989,
    }
    known = {"course_a": 0.0, "course_b": None, "speed_b": 0.0, "delta_v_a": f"{dv!r} ft/s"}
    (found,) = reconstruct.speeds(impact.a.before.replace(vx=0.0), FIXED, **known, **contact)
    return {"v": found.a.before.q.vx.m_as("ft/s")}
