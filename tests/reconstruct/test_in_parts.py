"""Large batches of the reverse solvers are worked out block by block: with the same bits as whole
arrays, and in the memory of one block.
"""

import tracemalloc
import warnings

import numpy as np
import pytest

import collisions as col
from collisions.kernels.status import Answer
from collisions.reconstruct import planar, speeds

PARTS = "collisions.engine.blocks.OF_ARRAYS"
RULES = ("friction", "impulse_ratio", "critical_fraction")
KNOWN = ("restitution", "closing_speed", "energy_loss")


def scene(rng, shape, some=0.02):
    """Two cars and their contact; in some cases a mass or a motion that cannot be used, or none."""

    def drawn(low, high, *odd):
        value = rng.uniform(low, high, shape)
        for number in odd:
            value[rng.uniform(size=shape) < some] = number
        return value

    a = col.Vehicle(
        mass=drawn(900.0, 2000.0, np.inf, -1.0),
        yaw_inertia=drawn(1500.0, 3000.0),
        vx=drawn(5.0, 30.0, np.nan, 0.0),
        vy=drawn(-5.0, 5.0, 0.0, -0.0),
        yaw_rate=drawn(-2.0, 2.0, 0.0),
        x=0.0,
        y=0.0,
        heading=0.0,
    )
    b = col.Vehicle(
        mass=1200.0,
        yaw_inertia=drawn(1500.0, 3000.0),
        vx=drawn(-5.0, 8.0),
        vy=drawn(-5.0, 16.0, 0.0),
        x=drawn(2.3, 2.6),
        y=drawn(-0.5, 0.5),
        heading=1.5,
    )
    # One of them broadcasts.
    contact = {"normal": rng.uniform(-0.4, 0.4, shape[-1:]), "point": (1.5, drawn(-0.4, 0.4))}
    return a, b, contact, drawn


def told(solver, *args, **given):
    """What a solver answers, and the texts of its warnings."""
    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always")
        answer = solver(*args, **given)
    return answer, [str(one.message) for one in raised]


def numbers(impact):
    """Every number behind an impact by name: what was found, with what was answered forwards."""
    found = {name: getattr(impact._answer, name) for name in Answer._fields} | {
        f"{label}.{moment}.{name}": getattr(getattr(getattr(impact, label), moment), name)
        for label in "ab"
        for moment in ("before", "after")
        for name in ("vx", "vy", "yaw_rate")
    }
    origin = impact.reconstruction
    found |= {"restitution": impact.restitution, "condition": origin.condition}
    found |= {"friction": impact.inputs.rule_value, "answers": origin.answers}
    for kind, pair in (("velocity", origin.contact_velocity), ("side", origin.one_sided)):
        parts = pair.values() if isinstance(pair, dict) else pair or ()
        found |= {f"{kind}[{i}]": part for i, part in enumerate(parts)}
    return {name: np.asarray(value) for name, value in found.items()}


def assert_same_bits(one, other):
    """Down to the sign of a zero; NaN where the other is NaN."""
    assert numbers(one).keys() == numbers(other).keys()
    for name, value in numbers(one).items():
        beside = numbers(other)[name]
        assert value.dtype == beside.dtype, name
        np.testing.assert_array_equal(value, beside, err_msg=name)
        signed = np.isfinite(value)
        np.testing.assert_array_equal(
            np.signbit(value[signed]), np.signbit(beside[signed]), err_msg=name
        ) if value.dtype.kind == "f" else None


def peak(function, size):
    """Bytes a case that a call takes at most, what it answers included; the last call of two."""
    function()
    tracemalloc.start()
    try:
        answer = function()
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    return most / size, answer


@pytest.mark.slow
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar"])
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("kind", KNOWN)
def test_planar_in_parts_has_the_bits_of_the_whole(monkeypatch, law, rule, kind):
    """Both with what was taken forwards, which has an answer, and with any end, which has often
    none; warnings and refusals included.
    """
    rng = np.random.default_rng(RULES.index(rule) + 3 * KNOWN.index(kind))
    shape = (30, 50)
    a, b, contact, drawn = scene(rng, shape)
    value = {
        "friction": lambda: drawn(0.0, 0.9, 0.0, np.inf, -0.1),
        "impulse_ratio": lambda: drawn(-0.6, 0.9, 0.0),
        "critical_fraction": lambda: (
            rng.integers(0, 2, shape) * 1.0
            if kind == "energy_loss"
            else drawn(0.0, 1.0, 0.0, 1.0, 1.2)
        ),
    }[rule]()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        end = col.eccentric(a, b, drawn(0.0, 1.0, 0.0), law=law, **{rule: value}, **contact)
        known = getattr(end, kind)
    any_end = a.replace(vx=drawn(-10.0, 10.0)), b
    for after in (any_end, (end.a.after, end.b.after)):
        given = {"law": law, **{kind: known, rule: value}, **contact}
        whole, said = told(planar, *after, **given)
        with monkeypatch.context() as patched:
            patched.setattr(PARTS, 64)
            parts, said_of_parts = told(planar, *after, **given)
        assert_same_bits(parts, whole)
        assert said_of_parts == said
        assert 0 < np.count_nonzero(whole.refused) < whole.status.size
    assert np.count_nonzero(whole.ok) > 100


@pytest.mark.slow
def test_planar_refuses_the_first_case_wherever_it_is(monkeypatch):
    """``on_failure="raise"`` names the case of the batch, not of its part."""
    monkeypatch.setattr(PARTS, 64)
    ratio = np.full(200, 0.3)
    ratio[150] = np.nan
    a = col.Vehicle(mass=1100, vx=20.0, yaw_inertia=1800, x=0.0, y=0.0)
    b = col.Vehicle(mass=950, vy=16.0, yaw_inertia=1500, x=2.5, y=0.4)
    contact = {"normal": 0.0, "point": (1.6, 0.3)}
    end = col.eccentric(a, b, 0.2, impulse_ratio=0.3, **contact)
    after = end.a.after, end.b.after
    with pytest.raises(col.InputError, match="case 150"):
        planar(*after, restitution=0.2, impulse_ratio=ratio, on_failure="raise", **contact)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["restitution", "energy_loss"])
def test_planar_with_tyres_in_parts_has_the_bits_of_the_whole(monkeypatch, kind):
    """Also beside a friction of 0 or without end, of which some origins leave a singular matrix."""
    rng = np.random.default_rng(7)
    shape = (4, 20)
    a, b, contact, drawn = scene(rng, shape, some=0.02)
    wheels = col.travel.Tyres(
        friction=drawn(0.4, 0.9), lock=drawn(0.0, 1.0), wheelbase=2.6, track=1.5
    )
    lasting = {"tyres_a": wheels, "duration": drawn(0.06, 0.15)}
    given = {"friction": drawn(0.1, 0.8, 0.0, np.inf), **contact, **lasting}
    end = col.eccentric(a, b, drawn(0.05, 0.6), on_failure="nan", **given)
    known = {kind: getattr(end, kind)}
    whole, said = told(planar, end.a.after, end.b.after, **known, **given)
    with monkeypatch.context() as patched:
        patched.setattr(PARTS, 27)
        parts, said_of_parts = told(planar, end.a.after, end.b.after, **known, **given)
    assert_same_bits(parts, whole)
    assert said_of_parts == said
    assert np.count_nonzero(whole.ok) > 10


@pytest.mark.slow
def test_planar_takes_the_memory_of_its_answers():
    """About 230 B a case are answers; as whole arrays the way there would take 1,000."""
    size = 200_000
    rng = np.random.default_rng(0)
    a, b, contact, drawn = scene(rng, (size,), some=0.0)
    given = {"restitution": drawn(0.05, 0.6), "friction": drawn(0.1, 0.8), **contact}
    end = col.eccentric(a, b, on_failure="nan", **given)
    after = end.a.after, end.b.after
    most, (start, _) = peak(lambda: told(planar, *after, on_failure="nan", **given), size)
    assert np.count_nonzero(start.ok) > size // 4
    assert most < 450


PAIRS = (
    ("speed_b", "energy_loss"),
    ("delta_v_a", "energy_loss"),
    ("delta_v_b", "max_crush_speed_a", "max_crush_speed_b"),
)
# Components of delta-V, with what else is known and how the contact ended.
COMPONENTS = (
    (("delta_v_forward_a", "delta_v_left_a"), {}),
    (("delta_v_forward_a", "delta_v_left_a"), {"slid": "bound"}),
    (("delta_v_forward_a", "delta_v_left_a", "speed_b"), {}),
    (("delta_v_left_a", "delta_v_forward_b", "speed_a"), {"regime": "sliding"}),
    (("delta_v_forward_b", "delta_v_left_b", "energy_loss"), {}),
)


def seen(hit, names, rng):
    """What is known of an impact by these names; in a fifth of the cases something else, which may
    have no answer, and in some what cannot be used.
    """
    shared = dict(zip(("ees_a", "ees_b"), hit.ees(0.4), strict=True))
    shared |= zip(
        ("max_crush_speed_a", "max_crush_speed_b"), hit.max_crush_speeds(0.4), strict=True
    )
    known = {}
    for name in names:
        side = getattr(hit, name[-1], hit)
        if name in shared:
            value = shared[name]
        elif name.startswith("speed"):
            value = side.before.speed
        else:
            value = getattr(side, name.removesuffix("_a").removesuffix("_b"))
        value = np.array(value)
        other = rng.uniform(size=value.shape)
        value[other < 0.2] *= 1.4 * other[other < 0.2] + 0.8
        value[other > 0.99] = np.nan
        value[(other > 0.98) & (other < 0.985)] = 0.0
        known[name] = value
    return known


def assert_speeds_alike(monkeypatch, law, rule, names, **given):
    """The same answers, as many of them, with the same warnings, by parts and as a whole."""
    rng = np.random.default_rng(len(str(names)) + len(rule))
    shape = (20, 40)
    a, b, contact, drawn = scene(rng, shape, some=0.005)
    value = {
        "friction": lambda: drawn(0.05, 0.9, 0.0),
        "inf": lambda: np.inf,
        # Of the last part no case has a share.
        "critical_fraction": lambda: np.where(np.arange(20)[:, None] < 18, drawn(0.0, 1.0, 1.0), 1),
    }[rule]()
    contact |= {"law": law, "friction" if rule == "inf" else rule: value}
    e = drawn(0.0, 0.9, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        hit = col.eccentric(a, b, e, **contact)
        known = seen(hit, names, rng)
    given |= {"course_a": a.course, "course_b": b.course, "restitution": e, **contact, **known}
    whole, said = told(speeds, a, b, **given)
    with monkeypatch.context() as patched:
        patched.setattr(PARTS, 64)
        parts, said_of_parts = told(speeds, a, b, **given)
    assert len(parts) == len(whole)
    for one, other in zip(parts, whole, strict=True):
        assert_same_bits(one, other)
        assert one.reconstruction.found == other.reconstruction.found
        assert one.reconstruction.known == other.reconstruction.known
    assert said_of_parts == said
    return whole


@pytest.mark.slow
@pytest.mark.parametrize("law", ["brach", "kudlich-slibar"])
@pytest.mark.parametrize("rule", ["friction", "critical_fraction"])
@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_speeds_in_parts_have_the_bits_of_the_whole(monkeypatch, law, rule, names):
    """Refused cases, second answers and warnings included."""
    first, *_ = assert_speeds_alike(monkeypatch, law, rule, names)
    assert 200 < np.count_nonzero(first.ok) < first.status.size


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["friction", "inf"])
@pytest.mark.parametrize(("names", "branch"), COMPONENTS)
def test_speeds_from_components_in_parts_have_the_bits_of_the_whole(
    monkeypatch, rule, names, branch
):
    """With the friction that was found in place of an infinite one, and the sides of a bound."""
    (found,) = assert_speeds_alike(monkeypatch, "brach", rule, names, **branch)
    assert np.count_nonzero(found.ok) > 30


@pytest.mark.slow
def test_speeds_take_the_memory_of_their_answers():
    """About 350 B a case are two answers; as whole arrays the way there would take 2,000."""
    size = 100_000
    rng = np.random.default_rng(0)
    a, b, contact, drawn = scene(rng, (size,), some=0.0)
    given = {"restitution": drawn(0.05, 0.6), "friction": drawn(0.1, 0.8), **contact}
    hit = col.eccentric(a, b, on_failure="nan", **given)
    given |= {"delta_v_a": hit.a.delta_v, "energy_loss": hit.energy_loss}
    given |= {"course_a": a.course, "course_b": b.course}
    most, (found, _) = peak(lambda: told(speeds, a, b, **given), size)
    assert np.count_nonzero(found[0].ok) > size // 4
    assert most < 850


@pytest.mark.slow
def test_a_share_of_the_critical_ratio_leaves_its_neighbours_bits():
    """A case with the whole critical ratio has the same speeds, to the bit, among cases with a
    share of it and among its like.
    """
    rng = np.random.default_rng(2)
    count = 300
    courses = rng.uniform(-3.0, 3.0, count)
    speed = rng.uniform(1.0, 20.0, count)
    a = col.Vehicle(
        mass=1500.0, yaw_inertia=2500.0, x=-2.0, y=rng.normal(0.0, 0.4, count), vx=15.0, vy=0.0
    )
    b = col.Vehicle(
        mass=rng.uniform(900.0, 3000.0, count),
        yaw_inertia=2000.0,
        x=1.0,
        y=rng.normal(0.0, 0.5, count),
        vx=speed * np.cos(courses),
        vy=speed * np.sin(courses),
    )

    def found(fraction):
        contact = {"normal": 0.0, "point": (0.0, 0.0), "critical_fraction": fraction}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", col.CollisionsWarning)
            impact = col.eccentric(a, b, 0.1, **contact, on_failure="nan")
            return speeds(
                a,
                b,
                restitution=0.1,
                course_a=0.0,
                course_b=courses,
                delta_v_a=impact.a.delta_v,
                energy_loss=impact.energy_loss,
                **contact,
            )

    whole = np.ones(count)
    mixed = np.where(np.arange(count) % 7, 1.0, 0.5)
    for alone, among in zip(found(whole), found(mixed), strict=False):
        for one, other in ((alone.a, among.a), (alone.b, among.b)):
            np.testing.assert_array_equal(
                one.before.speed[mixed == 1.0], other.before.speed[mixed == 1.0]
            )
