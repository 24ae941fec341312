"""Batches: shapes, precision, threads and progress; every case as if it were alone."""

import math

import mpmath
import numpy as np
import pint
import pytest

import collisions as col
from collisions.engine.batch import SCALAR_LIMIT
from collisions.engine.blocks import BLOCK
from collisions.impact.impact import answer_of
from collisions.kernels.status import Answer
from collisions.quantities.directions import from_radians
from impact.test_refused_cases import outputs

B = col.Vehicle(mass=950.0, vy=5.0, yaw_rate=0.2, yaw_inertia=1500.0, x=3.0, y=0.4)
PLACE = {"normal": 0.1, "point": (1.7, 0.3)}
READ = (
    "closing_speed",
    "slip_before",
    "slip_after",
    "normal_impulse",
    "tangential_impulse",
    "energy_loss",
    "effective_mass",
)


def striking(vx):
    """A car with one field as given."""
    return col.Vehicle(mass=1100.0, vx=vx, yaw_inertia=1800.0, x=0.0, y=0.0)


def solve(vx, e=0.2, **options):
    """One scene, with the field that varies."""
    return col.eccentric(
        striking(vx), B, e, friction=options.pop("friction", 0.3), **PLACE, **options
    )


@pytest.mark.parametrize("shape", [(3,), (1,), (0,), (2, 3), (4, 1, 2)])
def test_results_have_the_broadcast_shape(shape):
    """Any shape, empty ones included."""
    impact = solve(np.full(shape, 20.0))
    for name in READ:
        assert getattr(impact, name).shape == shape
    assert impact.b.after.vx.shape == impact.ok.shape == impact.status.shape == shape
    assert impact.regime.shape == shape


def test_arguments_broadcast_together():
    """A column of speeds against a row of restitutions, each pair as if alone."""
    speeds, es = np.array([[10.0], [20.0], [30.0]]), np.array([0.0, 0.5])
    impact = solve(speeds, es)
    assert impact.energy_loss.shape == (3, 2)
    for i in range(3):
        for j in range(2):
            alone = solve(float(speeds[i, 0]), float(es[j]))
            for name in READ:
                assert getattr(impact, name)[i, j] == pytest.approx(
                    getattr(alone, name), rel=1e-13, abs=1e-12
                ), name


def test_an_array_without_dimensions_is_a_single_case():
    """A 0-d array is a number, and the answer a Python float."""
    assert type(solve(np.array(20.0)).energy_loss) is float


@pytest.mark.parametrize(
    "layout",
    [
        lambda v: v[::-1][::-1],
        lambda v: np.repeat(v, 2)[::2],
        lambda v: np.asfortranarray(np.stack([v, v]))[0],
        lambda v: v.astype(">f8"),
        lambda v: list(v),
        lambda v: tuple(v),
    ],
)
def test_layout_does_not_matter(layout):
    """Strided, reversed, Fortran-ordered, big-endian, lists: the same numbers."""
    v = np.array([10.0, 20.0, 30.0])
    assert solve(layout(v)).energy_loss.tolist() == solve(v).energy_loss.tolist()
    square = np.asfortranarray(np.arange(1.0, 7.0).reshape(2, 3))
    assert solve(square).energy_loss.tolist() == solve(square.copy()).energy_loss.tolist()


def test_integers_become_floats():
    """Integer arrays are read as float64."""
    assert (
        solve(np.array([10, 20])).energy_loss.tolist()
        == solve(np.array([10.0, 20.0])).energy_loss.tolist()
    )


def test_single_precision_stays_single_only_if_every_array_is():
    """float32 in, float32 out, right to about 1e-5 here; one float64 array makes all of
    it float64.
    """
    v = np.array([10.0, 20.0], dtype=np.float32)
    single, double = solve(v), solve(v.astype(np.float64))
    assert single.energy_loss.dtype == single.a.after.vx.dtype == np.float32
    # float32 eps is 1.2e-7; ordinary traffic keeps P within 3 eps and the loss within 10 eps of its
    # parts (numerics 5).
    np.testing.assert_allclose(single.normal_impulse, double.normal_impulse, rtol=8 * 1.2e-7)
    np.testing.assert_allclose(single.energy_loss, double.energy_loss, rtol=10 * 1.2e-7)
    mixed = solve(v, np.array([0.2, 0.2]))
    assert mixed.energy_loss.dtype == np.float64
    np.testing.assert_allclose(mixed.energy_loss, double.energy_loss, rtol=1e-15)


@pytest.mark.parametrize("mass", [1e39, 1e-39])
def test_a_plain_number_that_float32_cannot_hold_is_not_lost(mass):
    """Beside float32 arrays it makes the batch float64: the answer is that of the single case to
    float64 rounding.
    """
    b = col.Vehicle(mass=mass)
    many = col.linear_central(
        col.Vehicle(mass=1.0, vx=np.array([2.0, 3.0], dtype=np.float32)), b, 0.5
    )
    one = col.linear_central(col.Vehicle(mass=1.0, vx=2.0), b, 0.5)
    assert many.normal_impulse.dtype == np.float64
    # Impulses are promised to 4 eps (numerics 5), in each.
    assert many.normal_impulse[0] == pytest.approx(one.normal_impulse, rel=8 * 2.2e-16)


@pytest.mark.slow
def test_single_precision_angles_in_degrees():
    """Degrees keep the precision of their array, and the normal of the result can be given again to
    the same bits.
    """
    degrees = pint.Quantity(np.linspace(-60.0, 60.0, 241, dtype=np.float32), "deg")
    impact = col.oblique_central(
        col.Vehicle(mass=1.0, vx=3.0), col.Vehicle(mass=1.0), 0.1, normal=degrees, friction=0.0
    )
    assert impact.normal[0].dtype == impact.energy_loss.dtype == np.float32
    assert col.Impact.from_dict(impact.to_dict()) == impact


@pytest.mark.slow
@pytest.mark.parametrize(
    "law",
    [
        "brach",
        *(pytest.param(law, marks=pytest.mark.slow) for law in ("kudlich-slibar", "stronge")),
    ],
)
@pytest.mark.parametrize("refusing", [False, True])
def test_few_cases_and_many_have_the_same_bits(law, refusing):
    """A few are answered one by one, many by recorded calls of numpy, a few with a refused one
    among them by the kernel itself.

    So many cases because a power of one half and a square root differ in one of a thousand.
    """
    rng = np.random.default_rng(20)
    count = 200 * SCALAR_LIMIT
    vx, e = rng.uniform(-5.0 if refusing else 8.0, 25.0, count), rng.uniform(0.0, 1.0, count)
    friction = np.where(rng.random(count) < 0.2, 0.0, rng.uniform(0.0, 1.5, count))

    def bits(part):
        found = solve(vx[part], e[part], friction=friction[part], law=law, on_failure="nan")
        choice = col.required_model(
            striking(vx[part]), B, e[part], **PLACE, friction=friction[part], law=law, tolerance=0.1
        )
        answers = {name: getattr(answer_of(found), name) for name in Answer._fields} | dict(
            choice.errors
        )
        return {name: np.ascontiguousarray(values).tobytes() for name, values in answers.items()}

    whole = bits(slice(None))
    for size, within in ((1, 50), (5, 100), (SCALAR_LIMIT, count)):
        parts = [bits(slice(start, start + size)) for start in range(0, within, size)]
        for name, values in whole.items():
            joined = b"".join(part[name] for part in parts)
            assert joined == values[: len(joined)], (name, size)


@pytest.mark.slow
def test_blocks_and_threads_change_no_bit():
    """More cases than a block holds, on one thread and on three, refused cases among them."""
    v = np.linspace(5.0, 60.0, 3 * BLOCK + 17)
    v[100] = -50.0
    v[BLOCK + 5] = np.nan
    with pytest.warns(col.CollisionsWarning, match="2 of 24593 cases were refused"):
        one = solve(v)
    with pytest.warns(col.CollisionsWarning):
        three = solve(v, threads=3)
    assert one == three
    assert np.flatnonzero(one.status > 1).tolist() == [100, BLOCK + 5]
    assert np.isfinite(one.energy_loss).sum() == v.size - 2
    small = solve(v[:50])
    assert np.array_equal(one.energy_loss[:50], small.energy_loss)


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_counts_up_and_can_interrupt(threads):
    """Called after each block with cases done and total; what it raises ends the run."""
    seen = []
    v = np.full(2 * BLOCK + 1, 20.0)
    solve(v, threads=threads, progress=lambda done, total: seen.append((done, total)))
    # Threads are given longer blocks.
    assert [done for done, _ in seen] == (
        [BLOCK, 2 * BLOCK, v.size] if threads == 1 else [seen[0][0], v.size]
    )
    assert BLOCK <= seen[0][0] < v.size
    assert {total for _, total in seen} == {v.size}

    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve(v, threads=threads, progress=stop)


FAULTS = {
    "mass": [-1.0, 0.0, np.nan],
    "yaw_inertia": [-1.0, np.nan],
    **dict.fromkeys(("vx", "vy", "yaw_rate", "x", "y"), (np.inf, -np.inf, np.nan)),
    "restitution": [-0.1, 1.5, np.nan],
    "friction": [-0.1, np.nan],
    "normal": [np.inf, np.nan],
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_among_a_few_cases_has_the_status_it_has_among_many(name):
    """In a few cases the checks that an answer implies are passed over, as in blocks of many."""
    plain = {"mass": 1100.0, "yaw_inertia": 1800.0, "vx": 20.0, "vy": 1.0, "yaw_rate": 0.1}
    plain |= {"x": 0.0, "y": 0.1, "restitution": 0.2, "friction": 0.3, "normal": 0.1}
    for fault in FAULTS[name]:

        def answers(count, fault=fault):
            values = {key: np.full(count, value) for key, value in plain.items()}
            values[name][3] = fault
            contact = {key: values.pop(key) for key in ("restitution", "friction", "normal")}
            seen = []
            found = col.eccentric(
                col.Vehicle(**values),
                B,
                contact.pop("restitution"),
                **contact,
                point=(1.7, 0.3),
                on_failure="nan",
                progress=lambda *done: seen.append(done),
            )
            assert seen == [(count, count)]
            return answer_of(found)

        few, many = answers(10), answers(10 * SCALAR_LIMIT)
        assert few.status[3] == many.status[3] > 1
        assert np.count_nonzero(few.status) == np.count_nonzero(many.status) == 1
        for field in Answer._fields:
            one, other = getattr(few, field), getattr(many, field)
            assert np.array_equal(one, other[:10], equal_nan=True), field
            assert one.dtype == other.dtype
            assert not one.flags.writeable


def test_results_are_locked():
    """Nobody changes an answer by accident."""
    impact = solve(np.array([10.0, 20.0]))
    for array in (impact.energy_loss, impact.a.after.vx, impact.normal_impulse):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_infinities_mix_with_finite_cases():
    """Barriers and cars, friction and none, in one batch, without a warning from numpy."""
    mass = np.array([950.0, math.inf, 950.0, math.inf])
    b = B.replace(
        mass=mass, yaw_inertia=np.where(np.isinf(mass), np.inf, 1500.0), vy=0.0, yaw_rate=0.0
    )
    mu = np.array([math.inf, math.inf, 0.0, 0.3])
    impact = col.eccentric(striking(20.0), b, 0.2, friction=mu, **PLACE)
    assert impact.ok.all()
    assert impact.b.delta_v[1] == impact.b.delta_v[3] == 0.0
    for i in range(4):
        alone = col.eccentric(
            striking(20.0),
            b.replace(mass=float(mass[i]), yaw_inertia=float(b.yaw_inertia[i])),
            0.2,
            friction=float(mu[i]),
            **PLACE,
        )
        assert impact.normal_impulse[i] == pytest.approx(alone.normal_impulse, rel=1e-14)
        assert impact.regime[i] == alone.regime


@pytest.mark.parametrize("size", [3, BLOCK + 1])
def test_a_plain_zero_beside_arrays_divides_nothing(size):
    """Two fixed bodies and a normal in arrays: every case is refused as immovable, with the rest of
    the numbers plain.
    """
    wall = col.Vehicle.barrier()
    impact = col.eccentric(
        wall, wall, 0.0, normal=np.zeros(size), point=(0.0, 0.0), friction=0.0, on_failure="nan"
    )
    assert set(impact.status.tolist()) == {int(col.Status.IMMOVABLE)}


def test_a_velocity_too_small_for_float32_is_none():
    """Beside float32 arrays it is 0, so a pinned body's velocity is worked out, as it is again from
    a record.
    """
    spin = np.array([1.0, 2.0], dtype=np.float32)
    pinned = col.Vehicle(
        mass=300.0, vx=1e-200, yaw_rate=spin, yaw_inertia=200.0, x=0.0, y=1.0, pivot=(0.0, 0.0)
    )
    assert pinned.vx.tolist() == [-1.0, -2.0]
    assert pinned == pinned.replace()


@pytest.mark.parametrize("cases", [3, 20000])
def test_an_answer_beyond_float32_is_refused(cases):
    """Plain numbers beside float32 arrays may be worked on in float64; what float32 cannot hold is
    out of range all the same.
    """
    speed = np.full(cases, 10.0, dtype=np.float32)
    speed[1] = 1.51e18  # 0.5 * 300 kg * v**2 is 3.42e38, and the largest float32 is 3.40e38
    a = col.Vehicle(mass=300.0, yaw_inertia=200.0, vx=speed, x=0.0, y=0.0)
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.0, "on_failure": "nan"}
    impact = col.eccentric(a, col.Vehicle.barrier(x=0.0, y=0.0), 0.0, **contact)
    assert impact.energy_loss.dtype == np.float32
    assert [col.Status(code).label for code in impact.status[:3]] == ["ok", "out_of_range", "ok"]
    for name in (
        "energy_loss",
        "energy_loss_normal",
        "normal_impulse",
        "compression_impulse",
        "effective_mass",
        "slip_before",
    ):
        assert np.isnan(getattr(impact, name)[1]), name
        assert np.isfinite(getattr(impact, name)[[0, 2]]).all(), name


@pytest.mark.parametrize("cases", [3, 20000])
def test_a_case_that_one_answer_refuses_has_no_other(cases):
    """Both losses are 0.5 * 1 kg * v**2 = 2.42e38 J, which float32 holds; of their sum it holds no
    more than 3.40e38.
    """
    a = col.Vehicle(mass=1.0, vx=2.2e19, vy=2.2e19, heading=np.zeros(cases, dtype=np.float32))
    impact = col.oblique_central(
        a, col.Vehicle.barrier(), 0.0, normal=0.0, friction=math.inf, on_failure="nan"
    )
    assert impact.energy_loss_normal.dtype == np.float32
    assert (impact.status == col.Status.OUT_OF_RANGE).all()
    for name in ("energy_loss", "energy_loss_normal", "compression_impulse", "slip_before"):
        assert np.isnan(getattr(impact, name)).all(), name
        assert not getattr(impact, name).flags.writeable
    assert not impact._answer.sticks.any()


def test_a_batch_without_a_case_asks_for_what_one_with_cases_does():
    """A spinning body of 300 kg has no velocity at the contact without its position, whatever is
    beside it.
    """
    b = col.Vehicle(mass=300.0, yaw_rate=1.0, yaw_inertia=np.array([]))
    with pytest.raises(col.MissingInputError, match="b has no x"):
        col.eccentric(col.Vehicle.barrier(), b, 0.0, normal=0.0, point=(0.0, 0.0), friction=0.0)


@pytest.mark.slow
def test_dimensions_beyond_what_numpy_holds_everywhere():
    """24 are solved, by every function; more are refused where they are given, before numpy stops
    at 32 in its midst.
    """
    calls = {
        "vx": lambda x: (solve(x), col.linear_central(striking(x), col.Vehicle(mass=900.0), 0.1)),
        "va": lambda x: col.reconstruct.central(1500.0, 1200.0, va=x, vb=0.0, restitution=0.1),
        "delta_v_a": lambda x: col.reconstruct.speeds(
            striking(0.0),
            B,
            course_a=0.0,
            course_b=1.0,
            speed_b=3.0,
            delta_v_a=x / 5.0,
            restitution=0.2,
            friction=0.3,
            **PLACE,
        ),
        "distance": lambda x: (col.travel.speed(x, drag=0.7), col.travel.time(x, drag=0.7)),
        "stiffness_a": lambda x: col.reconstruct.crush_energy(1.0, [0.1, 0.2], 2e3 * x, 1e6),
        "duration": lambda x: col.left_out(solve(20.0), duration=x / 200.0),
        "closing_speed": lambda x: col.reference.restitution(x / 10.0),
    }
    for name, call in calls.items():
        call(np.full((1,) * 24, 20.0))
        for dimensions in (25, 33, 64 if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else 32):
            with pytest.raises(
                col.ShapeError, match=f"{name} is an array of {dimensions} dimensions"
            ):
                call(np.full((1,) * dimensions, 20.0))


@pytest.mark.parametrize("blank", [False, 0j, "", None])
def test_dimensions_of_arrays_of_what_is_no_number(blank):
    """Flat iterators of numpy stop at 32 dimensions, and arrays of numpy 2 only at 64."""
    most = 33 if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else 32
    with pytest.raises(col.ShapeError, match=f"mass is an array of {most} dimensions"):
        col.Vehicle(mass=np.full((1,) * most, blank))
    with pytest.raises(col.InputError, match=r"mass is an array of (bool|complex128|<U1|object); "):
        col.Vehicle(mass=np.full((1,) * 24, blank))


WIDE = np.array([1500.0, 1400.0, 1300.0])
# Of which sums and products below are exact in float32 too.
TURN = np.array([9.0, 14.0, -26.0], dtype=np.float32) / 128.0
END = {"mass": WIDE, "vx": -4.0, "vy": 1.0, "yaw_inertia": 1800.0, "x": 0.0, "y": 0.0}
FLOAT32 = {
    "eccentric, normal": lambda angle: col.eccentric(striking(20.0).replace(mass=WIDE), B, 0.2,
    normal=angle, point=(1.7, 0.3), friction=0.3),
    "eccentric, in degrees": lambda angle: solve_along(pint.Quantity(angle, "deg"), WIDE),
    "eccentric, vector": lambda angle: solve_along((1.0 + angle, angle), WIDE),
    "eccentric, float64 point": lambda angle: col.eccentric(striking(20.0), B, 0.2, normal=angle,
    point=(1.7, WIDE / 4e3), friction=0.3),
    "eccentric, all of a vehicle": lambda angle: solve_along(0.1, WIDE, yaw_rate=angle,
    heading=angle, x=angle),
    "oblique_central": lambda angle: col.oblique_central(
        col.Vehicle(mass=WIDE, vx=20.0), col.Vehicle(mass=950.0, vy=5.0), 0.2, normal=angle,
            friction=0.3
    ),
    "solve": lambda angle: col.solve(
        striking(20.0).replace(mass=WIDE), B, 0.2, normal=angle, point=(1.7, 0.3), friction=0.3,
            tolerance=0.5
    ),
    "from_speed, course": lambda angle: col.Vehicle.from_speed(mass=WIDE, speed=20.0, course=angle),
    "from_speed, both": lambda angle: col.Vehicle.from_speed(mass=WIDE, speed=20.0 + angle,
    course=(1.0, angle)),
    "point": lambda angle: {
        "found": col.Vehicle(mass=1.0, x=WIDE, y=0.0, heading=angle).point(forward=1.0, left=angle),
        "polar": col.Vehicle(mass=1.0, x=1.0, y=0.0, heading=angle).point(distance=WIDE,
        angle=angle),
    },
    "momentum": lambda angle: col.reconstruct.momentum(
        WIDE, 1300.0, course_a=angle, course_b=1.0 + angle, course_a_after=0.9,
        course_b_after=0.5, speed_a_after=9.0,
        speed_b_after=8.0, heading_a=angle, normal=angle,
    ),
    "planar": lambda angle: col.reconstruct.planar(
        col.Vehicle(**END), B.replace(vx=5.0), restitution=0.2, normal=angle, point=(1.7, 0.3),
            friction=0.05
    ),
    "speeds": lambda angle: col.reconstruct.speeds(
        striking(0.0), B, course_a=angle, course_b=1.9, speed_b=4.0, delta_v_a=WIDE / 250.0,
            restitution=0.1, normal=angle,
        point=(1.7, 0.3), friction=0.3,
    ),
    "restitution": lambda angle: {"e": observed(col.reconstruct.restitution, angle)},
    "friction": lambda angle: {"mu": observed(col.reconstruct.friction, angle)},
    "crush_energy": lambda angle: {"J": col.reconstruct.crush_energy([0.5], [0.1, WIDE / 1e4],
    4e4, 6e5, force_angle=angle)},
    "path": lambda angle: col.travel.path(
        [(0.0, 0.0), (WIDE / 100.0, angle)], [pint.Quantity(angle, "deg"), angle], friction=0.7,
            lock=0.4
    ),
    "speed": lambda angle: {"m/s": col.travel.speed(9.0 + angle, drag=1.0 + angle, grade=angle,
    end_speed=WIDE / 1e3)},
    "left_out": lambda angle: col.left_out(solve_along(0.1, WIDE), duration=0.25 + angle,
    drag=1.0 + angle),
}  # fmt: skip


def solve_along(normal, mass, **fields):
    """The scene with this normal, struck by cars of these masses."""
    return col.eccentric(
        striking(20.0).replace(mass=mass, **fields),
        B,
        0.2,
        normal=normal,
        point=(1.7, 0.3),
        friction=0.3,
    )


def observed(function, angle):
    """What the motions of two cars show along this normal."""
    start = col.Vehicle(**{**END, "vx": 20.0, "vy": 2.0})
    return function(
        start, B, col.Vehicle(**END), B.replace(vx=19.0), normal=angle, point=(1.7, 0.3)
    )


@pytest.mark.parametrize("name", FLOAT32)
@pytest.mark.filterwarnings("ignore::collisions.CollisionsWarning")
def test_float32_beside_float64_is_read_exactly(name):
    """Every float32 is a float64: beside float64 it gives the answer of that float64, to the bit,
    and in float64.
    """
    given = {"normal", "normal_angle", "before", "after", "at_compression"}
    narrow, wide = (
        dict(outputs(FLOAT32[name](angle))) for angle in (TURN, TURN.astype(np.float64))
    )
    for output, value in wide.items():
        if isinstance(value, np.ndarray) and value.dtype.kind == "f":
            assert np.array_equal(narrow[output], value, equal_nan=True), output
            # What a vehicle was given stays as it was.
            if not given & set(output.split(".")):
                assert narrow[output].dtype == np.float64, output


def test_a_velocity_made_beside_float64_is_float64():
    """From a float32 speed too, and of a pinned body from its float32 yaw rate: 1.1 m and the
    cosine of 0.3 are no float32.
    """
    speed = np.float32([0.3, 0.7, 1.3])
    moving = [
        col.Vehicle.from_speed(mass=WIDE, speed=given, course=0.3)
        for given in (speed, speed.astype(float))
    ]
    pinned = {"mass": WIDE, "yaw_inertia": 2.0, "x": 15.0, "y": 1.4, "pivot": (0.0, 0.3)}
    turning = [col.Vehicle(**pinned, yaw_rate=given) for given in (speed, speed.astype(float))]
    for narrow, wide in (moving, turning):
        assert narrow.vx.dtype == narrow.vy.dtype == np.float64
        assert np.array_equal(narrow.vx, wide.vx)
        assert np.array_equal(narrow.vy, wide.vy)


@pytest.mark.parametrize("position", [0.5, np.float32(0.5), np.full(3, 0.5)])
def test_a_pinned_vehicle_in_float32_is_one_in_float64_too(position):
    """Its velocity about the pivot was worked out in float32, 6e-8 off; that is no velocity of
    another motion.
    """
    spin = np.float32([0.1, 0.3, 0.7])
    gate = {"mass": 400.0, "yaw_inertia": 300.0, "x": position, "y": 1.4, "pivot": (0.5, 0.3)}
    car = col.Vehicle(
        mass=np.array([900.0, 1000.0, 1100.0]), vx=20.0, x=-2.0, y=2.1, yaw_inertia=1500.0
    )
    contact = {"normal": 0.0, "point": (0.0, 2.1)}
    narrow, wide = (
        col.eccentric(car, col.Vehicle(**gate, yaw_rate=given), 0.1, **contact, friction=0.1)
        for given in (spin, spin.astype(float))
    )
    assert np.array_equal(narrow.normal_impulse, wide.normal_impulse)
    seen = [
        col.reconstruct.restitution(car, impact.b.before, impact.a.after, impact.b.after, **contact)
        for impact in (narrow, wide)
    ]
    assert np.array_equal(*seen)
    np.testing.assert_allclose(
        seen[0], 0.1, rtol=1e-13
    )  # 4 eps (1 + e) S / closing of numerics 5: 4e-15 here


def test_float32_alone_stays_float32():
    """Where no array is of another kind."""
    narrow = {"vx": 20.0 + TURN, "heading": TURN}
    impact = col.eccentric(
        striking(20.0).replace(**narrow), B, 0.2, normal=TURN, point=(1.7, 0.3), friction=0.3
    )
    for value in (
        impact.energy_loss,
        impact.normal[0],
        impact.a.delta_v_forward,
        impact.relative_speed,
        impact.common_velocity,
    ):
        assert value.dtype == np.float32
    assert col.Vehicle.from_speed(mass=900.0, speed=20.0, course=TURN).vx.dtype == np.float32
    assert (
        col.travel.path(
            [(0.0, 0.0), (9.0 + TURN, 1.0)], [TURN, TURN], friction=0.7, lock=0.4
        ).speed.dtype
        == np.float32
    )


def test_a_share_of_no_cases_gives_no_speeds():
    """An empty batch is answered by an empty one."""
    none = np.array([])
    impact = col.linear_central(col.Vehicle(mass=1500.0, vx=none), col.Vehicle(mass=1200.0), 0.1)
    assert [ees.shape for ees in impact.ees(none)] == [(0,), (0,)]


def test_a_float32_tolerance_beside_float64():
    """Is taken as it is: the largest float64 is no limit that float32 could hold."""
    a = col.Vehicle(mass=WIDE, vx=20.0, x=-2.0, y=0.3, yaw_inertia=2400.0)
    b = col.Vehicle(mass=1200.0, x=2.0, y=0.0, yaw_inertia=1800.0)
    contact = {"normal": 0.0, "point": (0.0, 0.3), "friction": 0.3}
    wanted = col.required_model(a, b, 0.2, **contact, tolerance=np.array([0.0, 0.25, 50.0]))
    found = col.required_model(
        a, b, 0.2, **contact, tolerance=np.array([0.0, 0.25, 50.0], dtype=np.float32)
    )
    assert list(found.model) == list(wanted.model)


def test_a_pinned_vehicle_has_one_precision():
    """Worked out from float32 beside plain numbers, the velocity is float32 in both parts, and its
    record is the same vehicle.
    """
    x = np.array([2.8, 3.3, 1.9], dtype=np.float32)
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, yaw_rate=-3.0, x=x, y=-3.06, pivot=(1.4, -4.9))
    assert a.vx.dtype == a.vy.dtype == np.float32
    b = col.Vehicle(mass=WIDE, vx=-17.0, vy=-4.0, yaw_inertia=1800.0, x=6.0, y=-4.0)
    impact = col.eccentric(a, b, 0.3, normal=-0.4, point=(4.0, -1.5), friction=0.1)
    assert not impact.refused.any()
    assert col.Impact.from_dict(impact.to_dict()) == impact


@pytest.mark.parametrize("solver", ["linear_central", "oblique_central", "eccentric", "solve"])
@pytest.mark.parametrize("threads", [1, 2])
def test_a_batch_without_a_case_is_answered_with_any_number_of_threads(solver, threads):
    """By arrays without a value."""
    a = col.Vehicle(mass=1500.0, vx=np.array([]), yaw_inertia=2400.0, x=-2.0, y=0.4)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=2.0, y=0.0)
    contact = {"linear_central": {}, "oblique_central": {"friction": 0.5}}.get(
        solver, {"friction": 0.5, "point": (0.0, 0.0)}
    )
    impact = getattr(col, solver)(a, b, 0.2, normal=0.0, threads=threads, **contact)
    assert impact.status.shape == impact.b.delta_v.shape == (0,)


def test_a_case_out_of_range_is_refused_in_a_batch_of_solve():
    """As it is alone: 1/inertia overflows, and the prediction must not take the error of the other
    body for that of both.
    """
    bodies = (
        {
            "mass": 1e6,
            "yaw_inertia": 3e6,
            "vx": 17.0,
            "vy": 0.0,
            "yaw_rate": -1.0,
            "x": -0.5,
            "y": 0.0,
        },
        {
            "mass": 4500.0,
            "yaw_inertia": 1e-309,
            "vx": -16.0,
            "vy": -1.0,
            "yaw_rate": 0.4,
            "x": 0.8,
            "y": 0.7,
        },
    )
    contact = {"normal": 0.0, "point": (-0.8, 0.25), "friction": 0.1, "tolerance": 3.0}
    with pytest.raises(col.InputError) as refused:
        col.solve(*(col.Vehicle(**body) for body in bodies), 0.8, **contact)
    assert refused.value.code == "out_of_range"
    many = (
        col.Vehicle(**{name: np.full(3, value) for name, value in body.items()}) for body in bodies
    )
    assert (
        col.solve(*many, np.full(3, 0.8), **contact, on_failure="nan").status
        == col.Status.OUT_OF_RANGE
    ).all()


@pytest.mark.slow
def test_the_normals_of_a_batch_are_those_of_their_angles():
    """To 2 eps against 400 digits: at and beside quarter turns, far beyond a turn, and tiny; the
    promise has room for 4.
    """
    quarters = np.arange(-8, 9) * (math.pi / 2.0)
    angles = np.concatenate(
        [
            quarters,
            quarters * (1.0 + 2.0**-52),
            quarters + 1e-9,
            np.linspace(-7.0, 7.0, 300),
            [1e5, 1e22, 1e-300],
        ]
    )
    nx, ny = from_radians(angles)
    with mpmath.workdps(400):
        for angle, x, y in zip(angles.tolist(), nx.tolist(), ny.tolist(), strict=True):
            assert mpmath.hypot(mpmath.cos(angle) - x, mpmath.sin(angle) - y) <= 2.0 * 2.0**-52


@pytest.mark.slow
def test_a_batch_may_be_solved_within_a_batch():
    """A report of progress that solves another one takes no scratch from the first."""
    v = np.linspace(5.0, 60.0, 3 * BLOCK + 17)
    wanted, inner = solve(v), solve(v[::-1].copy())
    seen = []
    assert (
        solve(v, progress=lambda done, total: seen.append(solve(v[::-1].copy()) == inner)) == wanted
    )
    assert seen == [True] * 4


def test_an_odd_case_is_refused_beside_fine_ones_whatever_input_is_odd():
    """Checks are left out where the kernel finds a block fine: a number that is not finite must not
    pass for that.
    """
    names = ("mass", "vx", "vy", "yaw_rate", "yaw_inertia", "x", "y", "heading")
    usual = {**dict.fromkeys(names, 0.1), "mass": 1100.0, "yaw_inertia": 1800.0, "vx": 20.0}
    for name in names:
        for odd in (math.nan, math.inf, -math.inf):
            body = {key: np.full(300, value) for key, value in usual.items()}
            body[name][150] = odd
            status = col.eccentric(
                col.Vehicle(**body), B, 0.2, friction=0.3, **PLACE, on_failure="nan"
            ).status
            infinite_mass = name in ("mass", "yaw_inertia") and odd == math.inf
            assert (status[150] <= col.Status.ENERGY_GAIN) == infinite_mass, (name, odd)
            assert (np.delete(status, 150) == col.Status.OK).all()


@pytest.mark.parametrize("cases", [50, 20000])
def test_plain_zeros_answer_as_arrays_of_zeros_do(cases):
    """Motion along the x axis: what is known to be 0 is not worked out, and every answer is the
    same to the bit.
    """
    rng = np.random.default_rng(5)
    speeds = rng.uniform(-5.0, 30.0, cases), rng.uniform(-5.0, 10.0, cases)
    plain = [col.Vehicle(mass=1100.0, vx=vx) for vx in speeds]
    spread = [
        col.Vehicle(mass=1100.0, vx=vx, vy=np.zeros(cases), yaw_rate=np.zeros(cases))
        for vx in speeds
    ]
    one, other = (col.linear_central(*pair, 0.3, on_failure="nan") for pair in (plain, spread))
    assert {*one.status.tolist()} == {col.Status.OK, col.Status.SEPARATING}
    for name, wanted in zip(Answer._fields, other._answer, strict=True):
        assert getattr(one._answer, name).tobytes() == wanted.tobytes(), name


def test_an_answer_that_is_the_same_in_every_case_takes_no_memory_unless_some_are_refused():
    """A linear impact has no tangential impulse and changes no yaw rate."""
    speed = np.full(1000, 20.0)
    for refused in ([], [7]):
        speed[refused] = -1.0
        impact = col.linear_central(
            striking(speed), B.replace(vy=0.0, yaw_rate=0.0), 0.2, on_failure="nan"
        )
        for value in (impact.tangential_impulse, impact.a.delta_yaw_rate, impact.a.after.yaw_rate):
            assert value.shape == (1000,)
            assert not value.flags.writeable
            assert np.flatnonzero(np.isnan(value)).tolist() == refused
            assert (value[np.isfinite(value)] == 0.0).all()
            assert refused or value.strides == (0,)
