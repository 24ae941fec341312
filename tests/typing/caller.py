"""What a typed caller writes, with every public function and every kind of input; read by type
checkers, never run.
"""

# pyright: strict

from typing import Any, assert_type

import numpy as np
import numpy.typing as npt

import collisions as col
from collisions import (
    diagnostics,
    plot,
    reconstruct,
    reference,
    reporting,
    scene,
    travel,
    uncertainty,
)
from collisions.uncertainty import (
    Censored,
    Interval,
    LogNormal,
    Normal,
    Samples,
    Triangular,
    Uniform,
)

speed: Any = col.Vehicle(mass=1.0, vx="80 km/h").q.vx
angles: npt.NDArray[np.float64] = np.array([0.0, 0.1])

# A vehicle from a text, a Quantity, a whole number, a numpy number, a float, an array and a list.
a = col.Vehicle(
    mass="1100 kg", vx=speed, x=0, y=np.float64(0.0), yaw_inertia=1800, heading=0.0, name="A"
)
b = col.Vehicle(
    mass=950.0,
    vx=np.array([1.0, 2.0]),
    vy=[0.0, 0.1],
    x="2 m",
    y=0.4,
    yaw_inertia=np.float32(1500.0),
)
wall = col.Vehicle.barrier(heading="90 deg")
pinned = col.Vehicle(mass=900, yaw_inertia=1200, x=0, y=1, pivot=("1 m", 0.0))
turned = col.Vehicle.from_speed(mass=900, speed=speed, course="90 deg").replace(
    yaw_rate="10 deg/s", x=0.0, y=0.0, heading=angles
)
corner = turned.point(forward="2 m", left=-0.5)
aside = turned.point(distance=2, angle=speed)


def of_a_vehicle(vehicle: col.Vehicle) -> dict[str, float]:
    """Attributes need no cast."""
    vx, vy = vehicle.velocity_at((1.0, "2 m"))
    px, py = vehicle.momentum
    return {
        "speed": vehicle.speed,
        "course": vehicle.course,
        "energy": vehicle.kinetic_energy,
        "vx": vx - vy,
        "p": px + py,
    }


def of_an_impact(impact: col.Impact) -> float:
    """Numbers as floats, whatever stands for many as it is asked for."""
    nx, ny = impact.normal
    own, other = impact.ees(0.5)
    label: str = impact.model
    status: int = impact.status
    record: dict[str, Any] = impact.to_dict()
    columns: dict[str, list[Any]] = impact.to_columns()
    again = col.Impact.from_dict(record)
    assert_type(again, col.Impact)
    assert_type(impact.a.after, col.Vehicle)
    forward = impact.a.delta_v_forward
    quantity: Any = impact.q.energy_loss
    total: float = impact.energy_loss.mean() + impact.a.delta_v[0]
    lost = impact.energy_loss + 2.0 * impact.energy_loss_normal - impact.b.delta_v / 3.6
    rest = -impact.closing_speed * nx * ny * (own + other)
    if forward is None or status != col.Status.OK or not impact.ok:
        raise col.InputError(label, code="mine", columns=columns, quantity=quantity)
    return total + lost + rest + forward


def forward_solvers() -> tuple[col.Impact, ...]:
    """Every way to say the normal, the point and the tangent."""
    in_line = col.linear_central(a, wall, "20 %", normal=0, on_failure="nan")
    central = col.oblique_central(a, b, 0.1, normal=(1, 0), impulse_ratio=-0.2, progress=True)
    full = col.eccentric(
        a, b, 0.1, normal=angles, point=("1 m", 0.0), friction=0.5, law="kudlich-slibar", threads=2
    )
    passed = col.linear_central(a, b, -0.1, incomplete=True)
    pushed = col.eccentric(
        a,
        b,
        0.1,
        normal=0,
        point=corner,
        friction=1,
        law="stronge",
        outside_a=(1.0, "2 N*s"),
        outside_b=(1, 2, angles),
    )
    complete: bool = passed.complete
    least = col.solve(
        a, b, angles, normal="10 deg", point=corner, critical_fraction=1, tolerance="1 km/h"
    )
    choice = col.required_model(
        a, b, 0.2, normal=(0.6, 0.8), point=[0.0, 1.0], friction=np.inf, tolerance=0.1
    )
    assert_type(choice, col.ModelChoice)
    error: float = choice.errors["linear_central"]
    crush = ("60 kN/m", 700e3, "1.5 m")
    passed_in_time = col.time_resolved(
        a, b, 0.1, normal=angles, point=corner, friction=0.5, crush_a=crush, drag=0.7, steps=50
    )
    force: Any = None if passed_in_time.pulse is None else passed_in_time.pulse.force
    print(force)
    more = (pushed, passed) if complete else ()
    full = col.eccentric(full.a.after, wall, error, normal=full.normal, point=aside, friction=0)
    return *more, in_line, central, full, least


def around(impact: col.Impact) -> str:
    """What can be said of an impact."""
    sliders = col.what_if(
        impact,
        {"speed_a": ("40 km/h", 20), "restitution": (0.0, 0.4)},
        outline_a=("4.2 m", 1.8),
        units="us",
    )
    sliders.save("page.html")
    assert_type(
        reporting.replay(str(col.report(impact))),
        col.Impact
        | reconstruct.MomentumSolution
        | scene.Run
        | list[col.Impact | reconstruct.MomentumSolution],
    )
    known: dict[str, Any] = reporting.options(str(col.report(impact)))
    one: col.Impact = impact.case(0).again(restitution=0.2, friction="0.4")
    vx, vy = one.a.delta_v_at((1, "2 m"))
    print(one.a.recorded(["30 ms", 0.06], forward="50 cm", left=0.1, axes="fixed"))
    own, other = one.max_crush_speeds("50 %")
    print(
        known,
        vx + vy + own + other,
        impact.summary("us"),
        impact.a.summary(),
        impact.a.after.summary(units="metric"),
    )
    schema: dict[str, Any] = col.impact_schema()
    beside = col.left_out(impact, duration="100 ms", drag=0.7)
    share: float = beside.b.tyre_share
    sentences = [finding.sentence for finding in col.diagnose(impact, duration=0.1, drag=0.7)]
    moves: list[diagnostics.Move] = list(col.diagnose(impact).moves)
    sentences += [move.what for move in moves if move.share > 0.1]
    page: str = str(
        col.report(
            impact,
            title="Two cars",
            form="markdown",
            units="metric",
            duration="100 ms",
            share_a=0.5,
            author="J. Doe",
            exhibit="12",
            case="2026-11",
            date="25 November 2026",
        )
    )
    page += str(col.report([impact, impact], figures=False))
    derivation: str = page + str(col.explain(impact, units="us", form="text"))
    return derivation + str(share) + str(schema) + "".join(sentences)


def labels(impact: col.Impact, choice: col.ModelChoice) -> str:
    """Those of a single case are Literals; a batch has arrays of them, which are asked
    for as such.
    """
    if (
        impact.kind == "plastic"
        or impact.regime == "sticking"
        or impact.law == "stronge"
        or impact.model == "eccentric"
    ):
        return impact.regime
    if impact.status == col.Status.OK and impact.status.sentence:
        return impact.status.label
    many = np.count_nonzero(np.asarray(impact.regime) == "sliding") + np.count_nonzero(
        np.asarray(impact.status) == 0
    )
    answered: int = impact.ok.sum() + impact.refused.sum()
    with col.options(require_units=True):
        return choice.model if choice.model == "linear_central" else f"{many} {answered}"


def backwards() -> float:
    """The reverse solvers."""
    line = reconstruct.central("1500 kg", 1200, va=speed, vb=0.0, restitution=0.1)
    found = reconstruct.momentum(
        1500,
        1200.0,
        course_a="0 deg",
        course_b=angles,
        course_a_after=0.3,
        course_b_after="40 deg",
        speed_a_after=8,
        speed_b_after=speed,
    )
    before = reconstruct.planar(a, b, normal=0, point=(0, 0), restitution=0.2, friction=0.5)
    wheels = travel.Tyres(0.7, 0.0, "2.7 m", 1.5)
    before = reconstruct.planar(
        a,
        b,
        normal=0,
        point=(0, 0),
        restitution=0.2,
        friction=0.5,
        duration="100 ms",
        tyres_a=wheels,
        tyres_b=wheels,
    )
    several = reconstruct.speeds(
        a,
        b,
        course_a=0,
        course_b=None,
        speed_b=0.0,
        delta_v_b="10 km/h",
        restitution=0.1,
        normal=0,
        point=(0, 0),
        friction=0.5,
    )
    stuck_or_slid = reconstruct.speeds(
        a,
        b,
        course_a=0,
        course_b="90 deg",
        delta_v_forward_a="-11 mph",
        delta_v_left_a="5 mph",
        restitution=0.1,
        normal=0,
        point=(0, 0),
        friction=np.inf,
        regime="sliding",
        slid="bound",
    )
    origin = stuck_or_slid[0].reconstruction
    assert origin is not None
    sides: Any = (origin.one_sided or {}).get("speed_b", 0)
    bound = uncertainty.OneSided(stuck_or_slid[0].b.before.speed, sides)
    print(origin.regime, bound.values, bound.sides)
    closing: float = reconstruct.inline_closing_speed(1500, 1200, 0.1, delta_v_b=speed)
    energy: float = reconstruct.crush_energy(["1.5 m"], [[0.1, 0.2]], 35000.0, 450000.0)
    e: float = reconstruct.restitution(a, b, a, b, normal=0)
    mu: float = reconstruct.friction(a, b, a, b, normal=0, point=corner)
    fitted = reconstruct.fit(
        dict[str, Any], {"speed": Interval(5, "90 km/h")}, {"after": Normal(8, 0.5)}
    )
    assert_type(fitted, reconstruct.Fit)
    refitted = reconstruct.fit(
        dict[str, Any], {"speed": 20.0}, {"after": (8, 0.5)}, finer=dict[str, Any]
    )
    calls: dict[str, int] = refitted.calls
    seen: dict[str, Any] = {
        "after": Censored(low="8 m/s", error="0.5 m/s"),
        "before": (9.0, 0.5),
        "rest": Interval(1, 2),
    }
    sampled = reconstruct.posterior(
        dict[str, Any],
        {"speed": Uniform(5, "90 km/h")},
        seen,
        finer=dict[str, Any],
        samples=1024,
        seed=1,
    )
    calls |= sampled.calls
    assert_type(sampled, reconstruct.Posterior)
    chance, _ = sampled.probability(lambda at: at["speed"] > 13.9)
    braking = sampled.with_result(
        "speed before", travel.speed, "m/s", distance="30 ft", drag=0.7, end_speed=sampled["speed"]
    )
    assert_type(braking, reconstruct.Posterior)
    compared: reconstruct.Comparison = reconstruct.compare(
        {"one": sampled, "other": sampled}, prior={"one": 0.5, "other": 0.5}
    )
    carried = reconstruct.speeds(
        a,
        b,
        course_a=0,
        course_b="80 deg",
        restitution=0.1,
        normal=0.0,
        point=(0, 0.4),
        friction=float("inf"),
        delta_v_forward_a="-18.5 km/h",
        delta_v_left_a="4.6 km/h",
        recorder_a=("50 cm", 0),
        axes="turning",
        duration="100 ms",
    )
    print(carried[0].summary())
    recorded = reconstruct.recorded_pulse([0.0, 0.01], [0.0, -2.0], [0, 1.0], polarity="ISO 8855")
    ranges_of: dict[str, Any] = recorded.inputs("a")
    both = reconstruct.crush_delta_v("40 kJ", 1500, "1200 kg", gamma_a=0.9)
    e += both[0] + reconstruct.crush_share("60 kN/m", 7e4)
    print(
        ranges_of,
        calls,
        list(sampled.inputs()),
        recorded.summary(),
        fitted.summary(),
        compared.summary("us"),
        found.summary(),
    )
    output = sampled["speed"]
    print(
        output.record(),
        output.turned(1.0),
        output.may_wrap(),
        output.quantile_standard_error(0.5),
        output.histogram(20),
    )
    e += chance + compared.probability["one"] + sampled.log_evidence
    return (
        line.closing_speed
        + found.speed_a
        + before.closing_speed
        + several[0].a.before.speed
        + closing
        + energy
        + e
        + mu
    )


def on_the_ground() -> float:
    """What the ground takes."""
    one: float = travel.speed("12 m", drag=0.7, grade="-2 %", end_speed=speed)
    run_out = travel.path(
        [(0.0, 0.0), (5.0, 1.0)],
        ["0 deg", 0.3],
        friction=0.7,
        lock=1,
        point_error="0.1 m",
        heading_error=0,
    )
    lasts: float = travel.time(20, drag=0.7) + travel.distance(speed, drag="6.5 m/s**2")
    tyres = travel.Tyres(0.7, [1, 0.1, 0.1, "10 %"], "2.7 m", 1.5, steer="3 deg")
    back = travel.path([(0, 0), (5, 1)], [0, 0.3], tyres=tyres, rotating_mass="3 %")
    rest = (
        back.speed
        + travel.simulate(a, tyres, slope=("2 %", 0.0), rotating_mass=0.03).at("1 s").speed
        + tyres.replace(height=0.5).wheelbase
    )
    least, greatest = travel.throw_bounds("18 m", friction=0.66, height="0.5 m")
    thrown: float = travel.throw_speed(18, friction=0.66, angle="20 deg") + least + greatest
    return one + lasts + run_out.speed + rest + thrown + travel.speed([10.0, 5.0], drag=[0.7, 0.3])


def whole_crash() -> float:
    """A scene, forward and as a model."""
    outline = ("4.5 m", 1.8)
    tyres = travel.Tyres(0.7, 1, "2.7 m", 1.5)
    contact = scene.Contact(
        "A", "B", restitution="10 %", friction=0.5, at="touch", tyres_after={"A": tyres}
    )
    crash = scene.Scene(
        movers={
            "A": scene.Mover(a, outline=outline, tyres=tyres),
            "B": scene.Mover(b, outline=outline).replace(drag="70 %"),
        },
        contacts=[contact.replace(delay="20 ms")],
        surfaces=[([(20, -5), (30, -5), ("30 m", 5)], 0.3)],
        order=[("A", "B")],
    )
    run: scene.Run = crash.replace({"A.vx": "50 km/h"}).run(tolerance=1e-5)
    required = crash.required({"A.rest.x": "1 m"}, {"A.vx": Normal("50 km/h", "2 km/h")})
    print(required.level, required.finest, required.summary("us"), *required.costs)
    again = scene.Run.from_dict(run.to_dict())
    found = uncertainty.propagate(
        crash, {"A.vx": Normal("50 km/h", 1)}, outputs=["B.rest.x"], samples=256
    )
    survey = crash.mark_points("A", "front_left", [("3 m", 0.5), (5.0, 0.7)], "0.2 m", ends=True)
    print({**survey, "A.rest.x": Normal("9 m", "1 m")})
    model = crash.as_model(["A.vx"], list(crash.results())[:1])
    print(crash.inputs(), contact.as_given("delay"), run.summary(), run.to_columns(), model)
    print(scene.Scene.from_dict(crash.to_dict()).case(0).run().case(0), crash.movers["A"].reach)
    struck: col.Impact = run.impacts[0]
    x = float(run["A"].rest.q.x.m_as("m") + run.rest["B"].speed + again.at("1 s")["B"].speed)
    played: str = col.play(run, units="us")
    col.play(run).save("crash.html")
    col.report(run, title="The crash", case="2026-11").save("report.html")
    print(col.explain(run, form="text"), [found.impact for found in col.diagnose(run)])
    print(played)
    print([*run.rest.keys()], struck.energy_loss, float(run.energy["ground"]))
    mean: float = found["B.rest.x"].mean
    return x + mean


def ranges() -> tuple[float, float]:
    """Every way to state an input."""
    inputs = {
        "course": Normal("25 deg", "3 deg"),
        "drag": Uniform(0.6, 0.8),
        "slide": Triangular(10, 12, "13 m"),
        "lag": LogNormal.between("0.5 s", "2 s", 0.9),
        "seen": Samples([0.68, 0.71, 0.74]),
        "mass": Interval("1400 kg", 1650),
        "fixed": 2.0,
    }

    def model(**given: Any) -> dict[str, Any]:
        return {"speed": travel.speed(given["slide"], drag=given["drag"])}

    found: uncertainty.Propagation = uncertainty.propagate(
        model,
        inputs,
        finer=model,
        finer_samples=64,
        method="quasi_random",
        samples=256,
        seed=1,
    )
    asked: int = found.calls["finer"]
    left: float = found.scatter["speed"]
    low, high = found["speed"].interval(0.95)
    chance: tuple[float, float] = found["speed"].probability(lambda v: v > 13.9)
    chance = found.probability(lambda at: at["speed"] > chance[0])
    halved: uncertainty.Halved = found.if_halved()
    print(halved["drag"]["speed"], halved.now, halved.q, halved.to_dict(), halved.summary("us"))
    mean: float = found["speed"].mean
    joint: dict[str, Samples] = Samples.joint(speed=[10.0, 12.0], mass=[1500.0, 1490.0])
    score = joint["speed"].scored(0.5) + Normal.between("20 m/s", 25, 0.9).quantile(0.5)
    output = found["speed"].to("mph")
    print(
        output.record(),
        output.row(),
        output.histogram(bins=9),
        output.quantile(0.5),
        output.quantile_standard_error(0.5),
    )
    return low + mean + score + asked + left, high


def published() -> float:
    """Values with their sources, and pictures."""
    value: float = reference.restitution(speed, outside="refuse")
    low, high = reference.restitution_range("15 mph")
    inertia: float = reference.yaw_inertia(1500, length="4.5 m", width=1.8, outside="refuse")
    low += reference.restitution_by_overlap("40 %")
    surface: reference.Published = reference.drag_factor("asphalt", speed="50 mph")
    print(surface, low + high + inertia, [known.name for known in reference.PUBLISHED])
    return value


def pictures(
    impact: col.Impact,
    known: uncertainty.Propagation,
    sampled: reconstruct.Posterior,
    path: travel.SimulatedPath,
    run: scene.Run,
) -> None:
    """Every picture."""
    plot.pulse(impact)
    plot.path(path, None, outline_a=("4.2 m", 1.8), units="us")
    plot.residuals(sampled)
    plot.corner(sampled, unknowns=["speed"], units="metric")
    axes = plot.momentum(impact, units="us")
    plot.energy(impact, axes=axes)
    plot.force_time(impact, "100 ms")
    plot.impulse_plane(impact)
    plot.scene(impact)
    plot.scene(run, units="us")
    plot.timeline(run, axes=axes, units="metric")
    plot.contributions(known, "speed")
    plot.distribution(known["speed"], bins=20)


def refused() -> float | None:
    """Errors and warnings carry what else is known."""
    try:
        of_an_impact(forward_solvers()[0])
    except col.AmbiguousSolutionError as error:
        return len(error.solutions)
    except col.NoImpactError as error:
        return error.closing_speed
    except (col.MissingInputError, col.UnitsError, col.ShapeError) as error:
        print(error.argument, error.given, error.allowed, error.instead)
    except col.InternalError as error:
        print(error.code)
    except col.NoSolutionError as error:
        print(error.solutions)
    except col.CollisionsError as error:
        assert_type(error.code, str)
    return None


def kinds_of_warning() -> tuple[type[col.CollisionsWarning], ...]:
    """To be filtered by."""
    return (
        col.EnergyGainWarning,
        col.IllConditionedWarning,
        col.OutOfRangeWarning,
        col.SuspectUnitsWarning,
    )
