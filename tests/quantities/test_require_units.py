"""``options(require_units=True)``: bare numbers are refused, by name, and only there and then."""

import asyncio
import copy
import pickle
import threading

import numpy as np
import pint
import pytest

import collisions as col
from collisions import plot, reconstruct, reference, scene, travel, uncertainty
from collisions.reporting import options, replay

WITH_UNITS = {
    "mass": "3400 lb",
    "yaw_inertia": "2100 lbf*ft*s**2",
    "heading": "10 deg",
    "vx": "45 mph",
    "x": "-7 ft",
    "y": "0.5 ft",
}


def crash():
    a = col.Vehicle(**WITH_UNITS)
    b = col.Vehicle(**{**WITH_UNITS, "vx": "0 mph", "vy": "20 mph", "x": "2.5 ft", "y": "-3 ft"})
    return col.eccentric(a, b, 0.1, normal="0 deg", point=("0 ft", 0), friction=0.5)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("mass", 1500),
        ("vx", 20),
        ("vx", np.array([20.0, 0.0])),
        ("yaw_rate", 0.1),
        ("heading", 5),
        ("x", -2.0),
        ("vy", np.float32(1)),
    ],
)
def test_a_bare_number_is_refused_by_name(name, value):
    with col.options(require_units=True):
        with pytest.raises(
            col.UnitsError, match=f"^{name} = .* has no unit, and options"
        ) as refused:
            col.Vehicle(**{**WITH_UNITS, name: value})
        assert refused.value.fields["argument"] == name
    col.Vehicle(**{**WITH_UNITS, name: value})


def test_all_bare_numbers_are_named_at_once_and_0_and_infinity_need_no_unit():
    with col.options(require_units=True):
        with pytest.raises(
            col.UnitsError,
            match=r"(?s)3 arguments cannot be used.*mass = 1500.*vx = 20.*heading = 1",
        ):
            col.Vehicle(mass=1500.0, vx=20.0, heading=1.0, x=0.0)
        assert col.Vehicle(mass=np.inf, vx=0, x=0.0, heading=np.zeros(2)).mass == np.inf
        assert col.Vehicle.barrier().vx == 0.0
        with pytest.raises(col.UnitsError, match="mass = 1500"):
            col.Vehicle.from_speed(mass=1500, speed="20 m/s", course="30 deg")
        with pytest.raises(col.UnitsError, match="speed = 20"):
            col.Vehicle.from_speed(mass="1500 kg", speed=20, course="30 deg")
        assert col.Vehicle.from_speed(mass="1500 kg", speed="20 m/s", course="90 deg").vy == 20.0
        with pytest.raises(col.UnitsError, match="heading = 1"):
            col.Vehicle(**WITH_UNITS).replace(heading=1)
        assert col.Vehicle(**WITH_UNITS).replace(heading="1 deg").mass == pytest.approx(
            3400 * 0.45359237
        )


def test_solvers_and_travel_refuse_too():
    with col.options(require_units=True):
        one = crash()
        a, b = one.a.before, one.b.before
        contact = {"normal": "0 deg", "point": ("1 ft", 0.0), "friction": 0.5}
        for name, value in (("normal", 1.0), ("point", (1.0, 0.0))):
            with pytest.raises(col.UnitsError, match=name):
                col.eccentric(a, b, 0.1, **{**contact, name: value})
        assert col.eccentric(
            a, b, 0.1, **{**contact, "normal": (1, 0)}
        ).ok  # a direction has no unit
        for ask in (col.solve, col.required_model):
            with pytest.raises(col.UnitsError, match=r"tolerance = 0\.5 has no unit, and"):
                ask(a, b, 0.1, **contact, tolerance=0.5)
            ask(a, b, 0.1, **contact, tolerance="0.5 m/s")
            ask(a, b, 0.1, **contact)  # 0 needs none
        with pytest.raises(col.UnitsError, match="distance"):
            travel.speed(20, drag=0.7)
        assert travel.speed("20 m", drag=0.7) == pytest.approx(
            (2 * 0.7 * 9.80665 * 20) ** 0.5, rel=1e-12
        )
        with pytest.raises(col.UnitsError, match="mass_a"):
            reconstruct.inline_closing_speed(1500, "1500 kg", 0.1, delta_v_b="10 mph")


ASKED_OF_RESULTS = [
    ("outline_a", (4.5, 2.0)),
    ("outline_b", np.array([(2.0, 1.0), (-2.0, 1.0), (-2.0, -1.0), (2.0, -1.0)])),
    ("duration", 0.1),
    ("limits", {"suspect_angle": 1.0}),
    ("limits", {"near_collinear": 0.5}),
    ("crush_energy", 1e4),
    ("damage_pdof_a", 0.2),
    ("damage_delta_v_a", 10),
    ("damage_delta_v_b", (10.0, "2 m/s")),
]


@pytest.mark.parametrize(("name", "value"), ASKED_OF_RESULTS)
def test_what_is_asked_of_a_result_needs_a_unit(name, value):
    with col.options(require_units=True):
        impact = crash()
        for ask in (col.diagnose, lambda one, **given: col.report(one, figures=False, **given)):
            with pytest.raises(col.UnitsError, match=f"(?s){name}.* has no unit, and options"):
                ask(impact, **{name: value})
            ask(impact)  # the package's own duration has none, and is none of the caller's
    col.diagnose(impact, **{name: value})


@pytest.mark.slow
def test_what_stands_beside_the_samples_of_a_posterior_needs_a_unit():
    with col.options(require_units=True):
        found = reconstruct.posterior(
            lambda speed: {"video": speed},
            {"speed": uncertainty.Uniform("0 m/s", "40 m/s")},
            {"video": ("10 m/s", "0.1 m/s")},
            samples=512,
            seed=1,
        )
        skid = {"drag": 0.7, "end_speed": found["speed"]}
        for function, unit in ((travel.speed, "m/s"), (travel.q.speed, None)):
            with pytest.raises(col.UnitsError, match=r"distance = 9 .*has no unit, and"):
                found.with_result("skid", function, unit, distance=9, **skid)
            more = found.with_result("skid", function, unit, distance="9 m", **skid)
            exact = (10.0**2 + 2 * 0.7 * 9.80665 * 9) ** 0.5
            assert more["skid"].mean == pytest.approx(exact, abs=0.05)
    bare = found.with_result("skid", travel.q.speed, distance=9, **skid)
    assert bare["skid"].mean == more["skid"].mean


def test_functions_of_a_result_and_published_values_refuse_too():
    with col.options(require_units=True):
        impact = crash()
        for name, ask in {
            "duration": lambda: col.left_out(impact, duration=0.1),
            "a.delta_v": lambda: col.explain(impact, uncertainty={"a.delta_v": 0.5}),
            "speed_a": lambda: col.what_if(impact, {"speed_a": (10, 30)}),
            "outline_a": lambda: col.what_if(
                impact, {"restitution": (0.0, 0.5)}, outline_a=(4.5, 2.0)
            ),
            "closing_speed": lambda: reference.restitution_range(4.0),
            "speed": lambda: reference.drag_factor("travelled dry asphalt", speed=20),
            "value": lambda: 0.1 in reference.CONTACT_DURATION,
        }.items():
            with pytest.raises(col.UnitsError, match=f"{name}.* has no unit, and options"):
                ask()
        assert col.left_out(impact) == col.left_out(impact, duration="0.1 s")
        col.explain(impact, uncertainty={"a.delta_v": "1 mph"})
        # In SI again within, and as asked after an error.
        with pytest.raises(col.UnitsError):
            col.Vehicle(mass=1500.0)


@pytest.mark.slow
def test_a_report_can_be_made_again_where_units_are_required():
    with col.options(require_units=True):
        given = {
            "outline_a": ("4.5 m", "2 m"),
            "limits": {"near_collinear": "20 deg"},
            "damage_delta_v_b": ("10 m/s", "2 m/s"),
        }
        page = col.report(crash(), figures=False, duration="90 ms", crush_energy="10 kJ", **given)
        assert col.report(replay(page), **options(page)) == page
    assert col.report(replay(page), **options(page)) == page


@pytest.mark.slow
def test_what_follows_from_inputs_with_units_works(tmp_path):
    """Records, pages, findings, pictures, models of a propagation: their numbers are the package's
    own.
    """
    pytest.importorskip("matplotlib").use("agg")
    with col.options(require_units=True):
        impact = crash()
        again = col.Impact.from_dict(impact.to_dict())
        assert again == impact
        assert impact.again(restitution=0.2).restitution == 0.2
        page = col.report(impact, units="us", duration="90 ms")
        assert col.report(replay(page), **options(page)) == page
        col.report(impact, form="markdown", derivation=True)
        col.diagnose(impact)
        col.explain(impact)
        col.left_out(impact)
        plot.scene(impact)
        plot.impulse_plane(impact)
        assert "mph" in str(impact.summary())
        contact = {"normal": "0 deg", "point": ("0 ft", 0), "friction": 0.5}
        col.solve(impact.a.before, impact.b.before, 0.1, **contact)
        slides = impact.again(friction=0.1)
        planar = reconstruct.planar(
            slides.a.after, slides.b.after, restitution=0.1, **{**contact, "friction": 0.1}
        )
        assert planar.a.before.vx == pytest.approx(impact.a.before.vx, rel=1e-9)

        def model(speed):
            a = impact.a.before.replace(vx=speed)
            return {
                "delta_v": col.eccentric(
                    a, impact.b.before, 0.1, on_failure="nan", **contact
                ).b.q.delta_v
            }

        found = uncertainty.propagate(
            model, {"speed": uncertainty.Normal("45 mph", "2 mph")}, samples=64, seed=1
        )
        assert found["delta_v"].mean == pytest.approx(impact.b.delta_v, rel=0.02)
        fitted = reconstruct.fit(
            model,
            {"speed": uncertainty.Interval("1 mph", "90 mph")},
            {"delta_v": ("10 m/s", "1 m/s")},
        )
        assert fitted["speed"].determined


def test_as_a_setting_it_holds_until_it_is_taken_back():
    try:
        col.options(require_units=True)
        with pytest.raises(col.UnitsError):
            col.Vehicle(mass=1500.0)
        with col.options(require_units=False):
            col.Vehicle(mass=1500.0)
        with pytest.raises(col.UnitsError):
            col.Vehicle(mass=1500.0)
    finally:
        col.options(require_units=False)
    col.Vehicle(mass=1500.0)
    for value in (1, None, "yes"):
        with pytest.raises(col.InputError, match="require_units must be True or False"):
            col.options(require_units=value)


def test_it_holds_in_its_own_thread_and_task_only():
    seen = []
    with col.options(require_units=True):
        thread = threading.Thread(target=lambda: seen.append(col.Vehicle(mass=1500.0).mass))
        thread.start()
        thread.join()
    assert seen == [1500.0]

    async def strict(started, checked):
        with col.options(require_units=True):
            started.set()
            await checked.wait()
            with pytest.raises(col.UnitsError):
                col.Vehicle(mass=1500.0)

    async def both():
        started, checked = asyncio.Event(), asyncio.Event()
        task = asyncio.create_task(strict(started, checked))
        await started.wait()
        assert col.Vehicle(mass=1500.0).mass == 1500.0
        checked.set()
        await task

    asyncio.run(both())


def test_an_array_with_a_unit_has_one():
    quantity = pint.get_application_registry().Quantity
    with col.options(require_units=True):
        cars = col.Vehicle(
            mass="1500 kg",
            vx=quantity(np.array([30.0, 35.0]), "mph"),
            heading=quantity([700.0, 710.0], "deg"),
        )
        assert cars.vx[0] == pytest.approx(13.4112, rel=1e-15)
        with pytest.raises(col.UnitsError, match=r"vx = .* has no unit"):
            col.Vehicle(mass="1500 kg", vx=np.array([30.0, 35.0]))


@pytest.mark.parametrize(
    ("name", "value", "argument"),
    [
        ("normal", 5, "normal"),
        ("point", (0.1, 0), r"point\[0\]"),
        ("outside_a", (100, 0), r"outside_a\[0\]"),
    ],
)
def test_what_is_changed_of_an_impact_needs_a_unit_and_the_rest_does_not(name, value, argument):
    bare = col.eccentric(
        col.Vehicle(mass=1500.0, yaw_inertia=2500.0, vx=15.0, x=-2.0, y=0.0, heading=0.0),
        col.Vehicle(mass=1200.0, yaw_inertia=2000.0, x=2.0, y=0.5, heading=1.0),
        0.1,
        normal=0.1,
        point=(0.0, 0.2),
        friction=0.5,
    )
    with col.options(require_units=True):
        for hit in (crash(), bare):
            with pytest.raises(col.UnitsError, match=f"{argument} = .* has no unit"):
                hit.again(**{name: value})
            assert hit.again().closing_speed == hit.closing_speed
            assert hit.again(friction=0.4).closing_speed == hit.closing_speed
            assert hit.again(normal="5 deg").ok
    assert crash().again(**{name: value}).closing_speed


def test_every_heading_and_point_of_a_run_out_needs_a_unit():
    """Of a list each; an array has one as a whole."""
    points = [("0 m", 0), ("5 m", "1 m"), ("9 m", "1 m")]
    wheels = {"friction": 0.7, "lock": 0.3}
    registry = pint.UnitRegistry()
    with col.options(require_units=True):
        with pytest.raises(col.UnitsError, match=r"headings\[2\] = 1"):
            travel.path(points, ["0 deg", "5 deg", 1.0], **wheels)
        with pytest.raises(col.UnitsError, match=r"(?s)headings\[1\] = 2.*headings\[2\] = 3"):
            travel.path(points, [0, 2, 3], **wheels)
        with pytest.raises(col.UnitsError, match="headings = "):
            travel.path(points, np.array([0.0, 0.2, 0.3]), **wheels)
        with pytest.raises(col.UnitsError, match=r"points\[1\]\[0\] = 5"):
            travel.path([(0, 0), (5, 1)], ["0 deg", "9 deg"], **wheels)
        of_lists = travel.path(points, ["0 deg", "20 deg", "30 deg"], **wheels)
        of_arrays = travel.path(
            registry.Quantity([[0.0, 0.0], [5.0, 1.0], [9.0, 1.0]], "m"),
            registry.Quantity([0.0, 20.0, 30.0], "deg"),
            **wheels,
        )
        # Counted on through turns: no other unit is suspected of an array that has one.
        turns = registry.Quantity([0.0, 2.2, 4.4, 7.0], "rad")
        with pytest.warns(col.OutOfRangeWarning) as said:
            travel.path([*points, ("12 m", "0 m")], turns, **wheels)
        assert {one.message.code for one in said} == {"wide_segment", "fast_yaw"}
    beyond_a_turn = registry.Quantity([400.0, 420.0, 430.0], "deg")
    assert travel.path(points, beyond_a_turn, **wheels).speed > 0.0
    assert of_arrays.speed == pytest.approx(of_lists.speed, rel=1e-12)


def row(tyres, car, **units):
    """Two cars in line, with numbers that have units or not."""
    mover = {"outline": units["outline"], "tyres": tyres}
    return scene.Scene(
        movers={
            "A": scene.Mover(car.replace(vx=units["vx"], x=0.0), **mover),
            "B": scene.Mover(car.replace(x=units["x"]), **mover),
        },
        contacts=[
            scene.Contact(
                "A", "B", at="touch", restitution=0.1, friction=0.5, duration=units["duration"]
            )
        ],
    )


CAR = {"mass": 1500.0, "yaw_inertia": 2500.0, "y": 0.0, "heading": 0.0}
SCENES = {
    "bare": row(
        travel.Tyres(0.7, 0.3, 2.6, 1.5), col.Vehicle(**CAR, x=0.0),
        vx=15.0, x=20.0, outline=(4.5, 1.8), duration=0.1,
    ),
    "with units": row(
        travel.Tyres(0.7, 0.3, "2.6 m", "1.5 m"), col.Vehicle(**CAR, x=0.0),
        vx="15 m/s", x="20 m", outline=("4.5 m", "1.8 m"), duration="100 ms",
    ),
}  # fmt: skip


@pytest.mark.parametrize("one", SCENES.values(), ids=SCENES)
def test_numbers_that_a_scene_has_need_no_unit_again(one):
    """However it was made: run, changed, asked for its levels, or for a curve of a recorder."""
    curve = "contacts[0].impact.A.recorded(40 ms, 0.4 m, 0.1 m).forward"

    def asked():
        found = one.required({"B.rest.x": "1 m"})
        return (
            found.level.name,
            found.to_dict()["levels"][0]["differences"],
            found.level.as_model([], ["B.rest.x"])(),
            one.as_model([], [curve])(),
            one.replace({"A.vx": "16 m/s", "A.heading": "1 deg"}).run().times,
            one.replace({"A.tyres.lock": np.array([0.2, 0.3])}).run().case(0).times,
            one.movers["A"].replace(drag=0.5, tyres=None).drag,
            one.movers["A"].tyres.replace(lock=0.2).track,
            one.contacts[0].replace(restitution=0.2).duration,
            one.replace({"contacts[0].normal": (1.0, 0.0)}).contacts[0].as_given("normal"),
            copy.deepcopy(one).run().times,
            pickle.loads(pickle.dumps(one.run())).times,
        )

    free = asked()
    with col.options(require_units=True):
        assert asked() == free
        for bare in (
            lambda: one.replace({"A.vx": 16.0}),
            lambda: one.replace({"contacts[0].duration": 0.2}),
            lambda: one.replace({"A.heading": 5.0}),
            lambda: one.required({"B.rest.x": 1.0}),
            lambda: one.as_model([], [curve.replace("0.4 m", "0.4")]),
            lambda: one.movers["A"].replace(outline=(4.0, 1.7)),
            lambda: one.movers["A"].tyres.replace(track=1.2),
            lambda: one.contacts[0].replace(duration=0.2),
        ):
            with pytest.raises(col.UnitsError, match="has no unit, and options"):
                bare()


WHEELS = travel.Tyres(0.7, 0.3, "2.6 m", "1.5 m")
HIT = {"normal": "3 deg", "point": ("0 m", "0.1 m"), "friction": 0.1}
ONE = col.Vehicle(
    mass="1500 kg", vx="15 m/s", x="-2 m", y="0 m", heading="0 deg", yaw_inertia="2500 kg*m**2"
)
TWO = col.Vehicle(
    mass="1200 kg", vy="8 m/s", x="2 m", y="0.2 m", heading="80 deg", yaw_inertia="2000 kg*m**2"
)
END = col.eccentric(ONE, TWO, 0.1, **HIT)
AFTER = {
    "course_a": "0 deg", "course_b": "90 deg", "course_a_after": "20 deg",
    "course_b_after": "60 deg", "speed_a_after": "30 km/h", "speed_b_after": "35 km/h",
}  # fmt: skip
FOUND = {
    "central": lambda: reconstruct.central(
        "1100 kg", "950 kg", va="80 km/h", vb=0.0, vb_after="60 km/h"
    ).summary(),
    "central with drags, a batch": lambda: reconstruct.central(
        "1100 kg", "950 kg", va=pint.Quantity([80.0, 90.0], "km/h"), vb=0.0, vb_after="60 km/h",
        duration="100 ms", drag_b=0.7,
    ).case(0).summary(),
    "planar with the tyres of one": lambda: reconstruct.planar(
        END.a.after, END.b.after, **HIT, restitution=0.1, duration="100 ms", tyres_a=WHEELS
    ).summary(),
    "speeds": lambda: reconstruct.speeds(
        ONE, TWO, course_a="0 deg", course_b="80 deg", restitution=0.1, **HIT, speed_a="15 m/s",
        delta_v_a="5 m/s",
    )[0].summary(),
    "momentum": lambda: reconstruct.momentum("1200 kg", "1400 kg", **AFTER).summary(),
    "momentum with tyres": lambda: reconstruct.momentum(
        "1200 kg", "1400 kg", **AFTER, duration="100 ms", tyres_a=WHEELS, heading_a="0 deg",
        yaw_rate_a_after="10 deg/s",
    ).summary(),
    "a function of the closing speed": lambda: reconstruct.inline_closing_speed(
        "1500 kg", "1500 kg", lambda v: reference.restitution(v, outside="refuse"),
        delta_v_a="5 km/h",
    ),
    "left_out": lambda: col.left_out(END).summary(),
    "report of a fit with a run": lambda: col.report(
        [
            reconstruct.fit(
                SCENES["with units"], {"A.vx": "15 m/s"}, {"contacts[0].impact.B.delta_v":
                ("7 m/s", "0.5 m/s")},
            ),
            SCENES["with units"].run(),
        ],
        figures=False, form="markdown",
    ).partition("## Record")[0],
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_the_packages_own_numbers_need_no_unit(found):
    """Every number of these has its unit, and the answer is the same with the option as without."""
    free = found()
    with col.options(require_units=True):
        assert str(found()) == str(free)
