"""Every refusal of the three solvers: the error, its code, and what its message says, single and in
a batch.
"""

import math
import pickle
import warnings

import numpy as np
import pytest

import collisions as col

INF = math.inf


def car(**changes):
    """A car that lacks nothing."""
    return col.Vehicle(**{"mass": 1200.0, "yaw_inertia": 1800.0, "x": 0.0, "y": 0.0, **changes})


def pinned(**changes):
    """A body that can only turn about the origin."""
    return col.Vehicle(
        **{
            "mass": 1000.0,
            "yaw_inertia": 1333.0,
            "x": 2.0,
            "y": 0.0,
            "pivot": (0.0, 0.0),
            **changes,
        }
    )


STRUCK = car(x=3.0, y=0.4)
STRIKING = car(vx=15.0, vy=2.0)
SCENE = {"normal": 0.0, "point": (1.6, 0.3)}
# Levers through which friction beyond K_nn/|K_nt| jams: numerics, section 6.
JAMMED = car(mass=1500.0, yaw_inertia=135.0, vx=1.0)

REFUSALS = [
    ("missing_inertia", lambda: col.eccentric(STRIKING.replace(yaw_inertia=None), STRUCK, 0.1,
        friction=0.5, **SCENE), ["a has no yaw_inertia", "inf"]),
    ("missing_inertia", lambda: col.eccentric(STRIKING,
        STRUCK.replace(yaw_inertia=None, name="Golf"), 0.1, friction=0.5, **SCENE), ["b (Golf)"]),
    ("missing_position", lambda: col.eccentric(STRIKING.replace(x=None), STRUCK, 0.1,
        friction=0.5, **SCENE), ["a has no x"]),
    ("missing_position", lambda: col.eccentric(STRIKING, STRUCK.replace(y=None), 0.1,
        friction=0.5, **SCENE), ["b has no y"]),
    ("missing_position", lambda: col.eccentric(STRIKING, col.Vehicle.barrier(yaw_rate=1.0), 0.1,
        friction=0.5, **SCENE), ["b (barrier) has no x"]),
    ("missing_point", lambda: col.eccentric(STRIKING, STRUCK, 0.1, friction=0.5, normal=0.0,
        point=None), ["point is None", "scene point (x, y)"]),
    ("one_tangential", lambda: col.eccentric(STRIKING, STRUCK, 0.1, **SCENE),
        ["friction=", "impulse_ratio=", "critical_fraction=", "got none"]),
    ("one_tangential", lambda: col.oblique_central(STRIKING, STRUCK, 0.1, normal=0.0,
        friction=0.5, impulse_ratio=0.1), ["friction= and impulse_ratio="]),
    ("bad_restitution", lambda: col.linear_central(car(vx=1.0), STRUCK, 1.0 + 2**-52),
        ["restitution", "from 0 to 1", "1.0000000000000002"]),
    ("bad_restitution", lambda: col.linear_central(car(vx=1.0), STRUCK, -5e-324),
        ["restitution", "-5e-324"]),
    ("bad_restitution", lambda: col.linear_central(car(vx=1.0), STRUCK, math.nan), ["restitution"]),
    ("bad_friction", lambda: col.eccentric(STRIKING, STRUCK, 0.1, friction=-0.5, **SCENE),
        ["friction", "-0.5", "give the magnitude"]),
    ("bad_friction", lambda: col.eccentric(STRIKING, STRUCK, 0.1, friction=math.nan, **SCENE),
        ["friction"]),
    ("bad_fraction", lambda: col.eccentric(STRIKING, STRUCK, 0.1, critical_fraction=1.1, **SCENE),
        ["critical_fraction", "from 0 to 1"]),
    ("not_finite", lambda: col.eccentric(STRIKING, STRUCK, 0.1, impulse_ratio=INF, **SCENE),
        ["impulse_ratio"]),
    ("bad_law", lambda: col.eccentric(STRIKING, STRUCK, 0.1, friction=0.5, law="carpenter",
        **SCENE), ["'brach'", "'kudlich-slibar'", "'carpenter'"]),
    ("zero_normal", lambda: col.linear_central(car(vx=1.0), STRUCK, 0.1, normal=(0, 0)),
        ["normal has no length"]),
    ("bad_shape", lambda: col.linear_central(car(vx=1.0), STRUCK, 0.1, normal=[1, 0]),
        ["(nx, ny)", "np.array"]),
    ("bad_shape", lambda: col.eccentric(STRIKING, STRUCK, 0.1, friction=0.5, normal=0.0,
        point=np.zeros((4, 2))), ["point", "(4, 2)", "points[:, 0]"]),
    ("separating", lambda: col.linear_central(car(vx=-5.0), STRUCK, 0.1),
        ["closing speed -5 m/s", "from A into B", "normal=(-1, 0)"]),
    ("grazing", lambda: col.oblique_central(car(vy=5.0), STRUCK, 0.1, normal=0.0, friction=0.0),
        ["closing speed 0; ", "from A into B"]),
    ("immovable", lambda: col.linear_central(car(mass=INF, vx=5.0), col.Vehicle.barrier(), 0.1),
        ["nothing can yield"]),
    ("immovable", lambda: col.eccentric(col.Vehicle.barrier(), col.Vehicle.barrier(), 0.1,
        friction=0.0, **SCENE), ["nothing can yield"]),
    ("immovable", lambda: col.eccentric(pinned(yaw_rate=1.0), col.Vehicle.barrier(), 0.1,
        friction=0.0, normal=(0.6, 0.8), point=(3.0, 4.0)), ["pivot"]),
    ("singular_contact", lambda: col.eccentric(pinned(yaw_rate=1.0), col.Vehicle.barrier(), 0.1,
        friction=0.5, normal=(0.0, 1.0), point=(4.0, 1.0)), ["friction=0"]),
    ("out_of_range", lambda: col.eccentric(STRIKING, STRUCK, 0.1, impulse_ratio=-1e101, **SCENE),
        ["impulse_ratio", "from -1e100 to 1e100"]),
    ("out_of_range", lambda: col.eccentric(car(mass=0.0015, yaw_inertia=0.0025, x=-2.0, vx=10.0,
        vy=17.0), col.Vehicle.barrier(), 0.2, friction=1.7e308, law="kudlich-slibar", normal=0.0,
        point=(0.0, -2.4)), ["between 1e-150 and 1e150"]),
    ("ratio_jams", lambda: col.eccentric(JAMMED, col.Vehicle.barrier(), 0.1, impulse_ratio=-2.0,
        normal=0.0, point=(2.0, -1.5)), ["impulse_ratio = -2", "-"]),
    ("spinning", lambda: col.linear_central(car(vx=1.0, yaw_rate=0.1), STRUCK, 0.1),
        ["a has yaw_rate = 0.1", "eccentric"]),
    ("spinning", lambda: col.oblique_central(car(vx=1.0), STRUCK.replace(yaw_rate=-0.1), 0.1,
        normal=0.0, friction=0.0), ["b has yaw_rate", "eccentric"]),
    ("transverse", lambda: col.linear_central(STRIKING, STRUCK, 0.1), ["2 m/s", "oblique_central"]),
    ("pinned", lambda: col.linear_central(pinned(), STRUCK, 0.1), ["a has a pivot", "eccentric"]),
    ("pinned", lambda: col.oblique_central(STRIKING, pinned(), 0.1, normal=0.0, friction=0.0),
        ["b has a pivot", "eccentric"]),
    ("not_a_vehicle", lambda: col.linear_central({"mass": 1.0}, STRUCK, 0.1),
        ["a must be a Vehicle", "dict"]),
    ("bad_option", lambda: col.linear_central(car(vx=1.0), STRUCK, 0.1, on_failure="ignore"),
        ["'raise'", "'nan'"]),
    ("bad_option", lambda: col.linear_central(car(vx=1.0), STRUCK, 0.1, threads=0), ["threads"]),
    ("bad_option", lambda: col.linear_central(car(vx=1.0), STRUCK, 0.1, progress=3), ["progress"]),
    ("out_of_range", lambda: col.linear_central(car(vx=1e200), STRUCK, 0.1),
        ["not a finite number"]),
    ("out_of_range", lambda: pinned(x=1e308, pivot=(0.0, -3.4), yaw_rate=3.5),
        ["pinned", "too large"]),
    ("out_of_range", lambda: col.oblique_central(col.Vehicle(mass=1e-204, vx=1e-30, vy=-1e308),
        car(vy=2.8), 0.04, normal=0.0, friction=3.1, law="kudlich-slibar"),
            ["not a finite number"]),
    ("immovable", lambda: col.eccentric(col.Vehicle.barrier(), col.Vehicle(mass=INF, vx=-1e-200,
        vy=-0.1, yaw_inertia=4e-192, x=-1e-187, y=0.0), 1.0, normal=-2.45, critical_fraction=1.0,
        point=(0.0, 0.0)), ["nothing can yield"]),
]  # fmt: skip
KINDS = {
    "bad_shape": col.ShapeError,
    "missing": col.MissingInputError,
    "separating": col.NoImpactError,
    "grazing": col.NoImpactError,
    "immovable": col.NoSolutionError,
    "singular_contact": col.NoSolutionError,
    "ratio_jams": col.NoSolutionError,
    "no_slip_pulls": col.NoSolutionError,
}


@pytest.mark.parametrize(
    ("code", "call", "says"), REFUSALS, ids=[f"{i}-{row[0]}" for i, row in enumerate(REFUSALS)]
)
def test_refusal(code, call, says):
    """The right error with the right code, a message that helps, and a pickle that
    keeps all of it.
    """
    with pytest.raises(col.CollisionsError) as caught:
        call()
    error = caught.value
    assert error.code == code
    assert isinstance(error, KINDS.get(code, KINDS.get(code.partition("_")[0], col.InputError)))
    assert isinstance(error, ValueError)
    for part in says:
        assert part in str(error)
    twin = pickle.loads(pickle.dumps(error))
    # Errors within errors compare by identity, so fields are compared as printed.
    assert (type(twin), str(twin), twin.code, repr(twin.fields)) == (
        type(error),
        str(error),
        error.code,
        repr(error.fields),
    )


def pulling_scene():
    """Found by search: levers and slip such that no slip would need a pull."""
    generator = np.random.default_rng(3)
    for _ in range(10_000):
        ax, ay, bx, by = generator.uniform(-2.5, 2.5, 4)
        a = car(
            vx=0.2,
            vy=float(generator.uniform(-20, 20)),
            x=float(ax),
            y=float(ay),
            yaw_inertia=400.0,
        )
        b = car(x=float(bx), y=float(by), yaw_inertia=400.0)
        impact = col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.0)
        if math.isinf(impact.critical_impulse_ratio):
            return a, b
    raise AssertionError("no pulling scene found")


def test_no_slip_that_would_need_a_pull():
    """Infinite friction and critical fractions are refused there; a finite friction slides, and the
    critical ratio is infinite.
    """
    a, b = pulling_scene()
    for rule in ({"friction": INF}, {"critical_fraction": 0.5}):
        with pytest.raises(col.NoSolutionError, match="pull") as caught:
            col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), **rule)
        assert caught.value.code == "no_slip_pulls"
    slid = col.eccentric(
        a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.3, law="kudlich-slibar"
    )
    assert slid.regime == "sliding"
    assert slid.critical_impulse_ratio == math.copysign(INF, slid.tangential_impulse)


def test_the_jamming_limit_is_named():
    """The message gives the ratio at which the denominator vanishes, K_nn + ratio K_nt = 0."""
    with pytest.raises(col.NoSolutionError) as caught:
        col.eccentric(
            JAMMED, col.Vehicle.barrier(), 0.1, impulse_ratio=-2.0, normal=0.0, point=(2.0, -1.5)
        )
    k_nn, k_nt = 1 / 1500 + 1.5**2 / 135, 2.0 * 1.5 / 135
    limit = caught.value.fields["limit"]
    assert abs(limit) == pytest.approx(k_nn / k_nt, rel=1e-14)
    with pytest.warns(col.EnergyGainWarning):
        below = col.eccentric(
            JAMMED,
            col.Vehicle.barrier(),
            0.1,
            impulse_ratio=limit * 0.99,
            normal=0.0,
            point=(2.0, -1.5),
        )
    assert below.normal_impulse > 0


def test_all_that_is_missing_is_named_at_once():
    """One error for a caller who gave masses and velocities only."""
    with pytest.raises(col.MissingInputError) as caught:
        col.eccentric(
            col.Vehicle(mass=1500.0, vx=10.0), col.Vehicle(mass=900.0), 0.1, friction=0.5, **SCENE
        )
    for side in "ab":
        for field in ("yaw_inertia", "x", "y"):
            assert f"{side} has no {field}" in str(caught.value)


def test_no_negative_zeros():
    """A frictionless contact has a tangential impulse, ratio and loss of 0, not -0, whichever way
    it slips.
    """
    for vy in (7.0, -7.0, 0.0):
        impact = col.oblique_central(
            car(vx=15.0), STRUCK.replace(vy=vy), 0.1, normal=0.0, friction=0.0
        )
        turned = col.eccentric(car(vx=15.0), STRUCK.replace(vy=vy), 0.1, friction=0.0, **SCENE)
        for found in (impact, turned):
            for value in (
                found.tangential_impulse,
                found.impulse_ratio,
                found.energy_loss_tangential,
            ):
                assert math.copysign(1.0, value) == 1.0


def test_the_closing_speed_comes_with_the_refusal():
    """NoImpactError carries it as a number."""
    with pytest.raises(col.NoImpactError) as caught:
        col.linear_central(car(vx=-5.0), STRUCK, 0.1)
    assert caught.value.closing_speed == -5.0


def test_residues_of_rounding_are_no_transverse_motion():
    """A motion along the normal to rounding is solved, and the residue carried through."""
    a = car(vx=10.0 * math.cos(0.3), vy=10.0 * math.sin(0.3))
    impact = col.linear_central(a, STRUCK, 0.1, normal=0.3)
    assert impact.a.after.speed == pytest.approx(10.0 * (1 - 0.55), rel=1e-14)


def test_linear_impacts_chain_along_any_normal():
    """What the first impact leaves across the normal is rounding, also where it cancels the motion
    along it.
    """
    generator = np.random.default_rng(11)
    for angle, e, mass in generator.uniform((-3, 0.9, 900), (3, 1.0, 1100), (300, 3)):
        first = col.Vehicle.from_speed(mass=1000.0, speed=20.0, course=float(angle))
        done = col.linear_central(
            first, col.Vehicle(mass=float(mass)), float(e), normal=float(angle)
        )
        assert col.linear_central(first, done.a.after, 0.1, normal=float(angle)).ok


def test_overflow_is_not_called_immovable():
    """Levers and mobilities beyond floats say that the answer is out of range."""
    for changes in ({"mass": 1e-308, "yaw_inertia": 1e-308}, {"x": -1e200}):
        with pytest.raises(col.InputError) as caught:
            col.eccentric(car(vx=15.0, **changes), STRUCK, 0.1, friction=0.5, **SCENE)
        assert caught.value.code == "out_of_range"


def test_wrong_and_missing_arguments_are_named_together():
    """A bad restitution, no point and no position: one error; wrong units among them make it a
    UnitsError.
    """
    with pytest.raises(col.InputError) as caught:
        col.eccentric(STRIKING.replace(x=None), STRUCK, 2.0, friction=-1.0, normal=0.0, point=None)
    for part in ("restitution", "friction", "point is None", "a has no x"):
        assert part in str(caught.value)
    with pytest.raises(col.UnitsError):
        col.Vehicle(mass="5 m", vx=math.nan)


def test_shapes_that_do_not_match_anywhere():
    """ShapeError with both shapes, wherever two arrays meet."""
    s2, s3 = np.array([1.0, 2.0]), np.array([1.0, 2.0, 3.0])
    many = col.linear_central(col.Vehicle(mass=1.0, vx=s2), col.Vehicle(mass=1.0), 0.1)
    for call in (
        lambda: col.linear_central(
            col.Vehicle(mass=1.0, vx=1.0), col.Vehicle(mass=1.0), 0.1, normal=(s2, s3)
        ),
        lambda: col.Vehicle.from_speed(mass=1.0, speed=s2, course=s3),
        lambda: col.Vehicle(mass=1.0, vx=s2, vy=s3),
        lambda: col.Vehicle(mass=1.0, yaw_inertia=1.0, x=s2, y=0.0, pivot=(s3, 0.0)),
        lambda: col.Vehicle(mass=1.0, x=s2, y=0.0, heading=0.0).point(forward=s3),
        lambda: col.Vehicle(mass=1.0, x=0.0, y=0.0).velocity_at((s2, s3)),
        lambda: many.a.delta_v_at((s3, 0.0)),
        lambda: many.ees(s3 / 3.0),
    ):
        with pytest.raises(col.ShapeError, match=r"\(2,\).*\(3,\)|\(3,\).*\(2,\)"):
            call()


def test_the_state_of_a_refused_case_is_refused():
    """NaN does not turn; it is named for what it is."""
    refused = col.linear_central(car(vx=-5.0), STRUCK, 0.1, on_failure="nan")
    assert refused.kind == refused.regime == ""
    assert math.isnan(refused.a.after.kinetic_energy)
    with pytest.raises(col.InputError, match="vx is NaN"):
        col.linear_central(refused.a.after, STRUCK, 0.1)
    with pytest.warns(col.CollisionsWarning):
        many = col.linear_central(car(vx=np.array([-5.0, 5.0])), STRUCK, 0.1)
    assert np.isnan(many.b.after.kinetic_energy).tolist() == [True, False]


def test_a_barrier_needs_no_position():
    """A body of infinite mass and inertia that does not turn has no lever that matters."""
    assert (
        col.eccentric(STRIKING, col.Vehicle.barrier(), 0.1, friction=0.5, **SCENE).b.delta_v == 0.0
    )


BATCH = [
    ("NOT_POSITIVE", {"a": car(vx=15.0, mass=np.array([1200.0, 0.0]))}),
    ("NOT_POSITIVE", {"a": car(vx=15.0, yaw_inertia=np.array([1200.0, -1.0]))}),
    ("NOT_FINITE", {"a": car(vx=np.array([15.0, np.nan]))}),
    ("NOT_FINITE", {"a": car(vx=np.array([15.0, np.inf]))}),
    ("NOT_FINITE", {"a": car(vx=15.0, heading=np.array([0.0, np.nan]))}),
    ("NOT_FINITE", {"point": (np.array([1.6, np.nan]), 0.3)}),
    ("NOT_FINITE", {"normal": np.array([0.0, np.nan])}),
    ("NOT_FINITE", {"friction": None, "impulse_ratio": np.array([0.1, np.inf])}),
    ("BAD_RESTITUTION", {"restitution": np.array([0.1, 1.1])}),
    ("BAD_RESTITUTION", {"restitution": np.array([0.1, np.nan])}),
    ("BAD_FRICTION", {"friction": np.array([0.1, -0.1])}),
    ("BAD_FRICTION", {"friction": np.array([0.1, np.nan])}),
    ("BAD_FRACTION", {"friction": None, "critical_fraction": np.array([0.1, 2.0])}),
    ("ZERO_NORMAL", {"normal": (np.array([1.0, 0.0]), np.array([0.0, 0.0]))}),
    ("SEPARATING", {"a": car(vx=np.array([15.0, -15.0]))}),
    ("GRAZING", {"a": car(vx=np.array([15.0, 0.0]))}),
    ("IMMOVABLE", {"a": car(vx=15.0, mass=np.array([1200.0, INF]), yaw_inertia=INF),
        "b": col.Vehicle.barrier()}),
    ("OUT_OF_RANGE", {"a": car(vx=np.array([15.0, 1e300]))}),
    ("RATIO_JAMS", {"a": JAMMED, "b": col.Vehicle.barrier(), "point": (2.0, -1.5),
        "friction": None, "impulse_ratio": np.array([0.1, -2.0])}),
    ("PINNED_INFINITE", {"b": pinned(mass=np.array([1000.0, INF]), y=1.0), "point": (2.0, 2.0)}),
    ("PINNED_VELOCITY", {"b": pinned(vx=np.array([0.0, 3.0]), y=1.0), "point": (2.0, 2.0)}),
    ("SINGULAR_CONTACT", {"a": pinned(yaw_rate=1.0), "b": col.Vehicle.barrier(),
        "normal": (0.0, 1.0), "point": (4.0, 1.0), "friction": np.array([0.0, 0.5])}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("status", "changes"), BATCH, ids=[f"{i}-{row[0]}" for i, row in enumerate(BATCH)]
)
def test_a_refused_case_of_a_batch(status, changes):
    """NaN with a status, its neighbour untouched, one warning; where it is to raise, the same error
    as for the single case.
    """
    scene = {
        "a": car(vx=15.0),
        "b": STRUCK,
        "restitution": 0.1,
        "friction": 0.5,
        **SCENE,
        **changes,
    }
    a, b, e = (scene.pop(name) for name in ("a", "b", "restitution"))
    with pytest.warns(col.CollisionsWarning, match="1 of 2 cases") as caught:
        impact = col.eccentric(a, b, e, **scene)
    assert len(caught) == 1
    wanted = col.Status[status]
    assert impact.status.tolist() == [0, wanted]
    assert impact.ok.tolist() == [True, False]
    for name in (
        "normal_impulse",
        "energy_loss",
        "closing_speed",
        "relative_speed",
        "impulse_ratio",
        "momentum_residual",
    ):
        assert np.isnan(getattr(impact, name)).tolist() == [False, True], name
    assert np.isnan(impact.a.after.vx).tolist() == [False, True]
    assert impact.regime[1] == impact.kind[1] == ""
    with pytest.raises(col.CollisionsError, match=r"^case 1: ") as raised:
        col.eccentric(a, b, e, on_failure="raise", **scene)
    alone = raised.value.code
    assert alone == wanted.label


def test_every_status_explains_itself():
    """A sentence and a label for each code."""
    for status in col.Status:
        assert status.sentence
        assert status.label == status.name.lower()


def test_a_single_case_may_be_answered_with_nan():
    """on_failure="nan" gives the status instead of the error, and no warning: it was wanted."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        impact = col.linear_central(car(vx=-5.0), STRUCK, 0.1, on_failure="nan")
        many = col.linear_central(car(vx=np.array([5.0, -5.0])), STRUCK, 0.1, on_failure="nan")
    assert np.isnan(many.energy_loss).tolist() == [False, True]
    assert impact.status is col.Status.SEPARATING
    assert not impact.ok
    assert math.isnan(impact.a.after.vx)
    assert math.isnan(impact.energy_loss)
    assert math.isnan(impact.relative_speed)
    assert repr(impact)


def test_shapes_that_do_not_broadcast():
    """Both arguments and both shapes are named."""
    with pytest.raises(col.ShapeError, match=r"restitution \(3,\), a.vx \(2,\)"):
        col.linear_central(car(vx=np.array([1.0, 2.0])), STRUCK, np.array([0.1, 0.2, 0.3]))


def test_an_energy_gain_is_returned_and_warned_of():
    """With "brach" and e = 1 some impacts end with more energy; the value stays negative and ok is
    False.
    """
    a, b = car(vx=15.0, vy=-8.0), STRUCK
    with pytest.warns(col.EnergyGainWarning, match="J of energy"):
        impact = col.oblique_central(a, b, 1.0, normal=0.0, impulse_ratio=0.5)
    assert impact.energy_loss < 0
    assert impact.status is col.Status.ENERGY_GAIN
    assert not impact.ok
    with pytest.warns(col.EnergyGainWarning, match="1 of 2 cases"):
        many = col.oblique_central(
            a, b, np.array([1.0, 0.0]), normal=0.0, impulse_ratio=np.array([0.5, -0.1])
        )
    assert many.energy_loss[0] == pytest.approx(impact.energy_loss, rel=1e-14)
    assert many.ok.tolist() == [False, True]


class Unshowable:
    """An object that fails when a message wants to show it."""

    def __repr__(self):
        raise RuntimeError("no")


def nested(depth):
    """Lists in one another, deeper than Python shows."""
    found = []
    for _ in range(depth):
        found = [found]
    return found


@pytest.mark.parametrize(
    "given",
    [Unshowable(), nested(5000), np.array(["x", "y"])],
    ids=["unshowable", "nested", "array"],
)
@pytest.mark.parametrize(
    "call",
    [
        lambda given: col.linear_central(STRIKING, col.Vehicle.barrier(), 0.1, on_failure=given),
        lambda given: col.linear_central(STRIKING, col.Vehicle.barrier(), 0.1, threads=given),
        lambda given: col.oblique_central(
            STRIKING, col.Vehicle.barrier(), 0.1, normal=0.0, friction=0.1, law=given
        ),
        lambda given: col.Vehicle.from_speed(mass=1.0, speed=given, course=0.0),
        lambda given: col.Impact.from_dict({"format": given}),
        lambda given: col.reconstruct.momentum(1.0, 1.0, together=given),
        lambda given: col.reconstruct.planar(
            STRIKING,
            col.Vehicle.barrier(),
            normal=0.0,
            point=(0.0, 0.0),
            closing_speed=1.0,
            regime=given,
        ),
        lambda given: col.reconstruct.crush_energy([1.0], [0.1, 0.1], given, 1e6),
        lambda given: col.travel.path([given, given], [0.0, 0.0], friction=0.7, lock=1.0),
        lambda given: col.travel.speed(10.0, drag=given),
    ],
)
def test_a_message_survives_what_cannot_be_shown(call, given):
    """The refusal is the library's own, whatever the object does when it is printed or compared."""
    with pytest.raises(col.InputError):
        call(given)
