"""A law put into the table of laws from here is solved, written down, explained and drawn; nothing
else has to know its name.
"""

import inspect
import math
import re
from typing import get_args

import numpy as np
import pytest

import collisions as col
from collisions import plot
from collisions.derivation import explain
from collisions.diagnostics import diagnose
from collisions.impact import inputs
from collisions.kernels import central, contact_laws, eccentric
from collisions.kernels.elementwise import select
from collisions.reporting import report
from scenes import TURNING

A, B = TURNING
CONTACT = {"normal": 0.3, "point": (0.1, 0.2), "friction": 2.0, "law": "half back"}


@pytest.fixture(autouse=True)
def fourth_law(monkeypatch):
    """Of the slip before e / 2 comes back."""
    law = contact_laws.Law(
        "half back",
        lambda restitution: -0.5 * restitution,
        no_slip="half of e comes back",
        derivation="half of e comes back of the slip",
        assumption="half of e comes back of the slip, says the test",
    )
    monkeypatch.setitem(contact_laws.LAWS, law.name, law)


def test_type_checkers_and_docstrings_know_the_laws(monkeypatch):
    monkeypatch.delitem(contact_laws.LAWS, "half back")
    assert get_args(inputs.Law) == tuple(contact_laws.LAWS)
    listed = ", ".join(f'"{name}"' for name in contact_laws.LAWS)
    for solver in (col.oblique_central, col.eccentric, col.scene.Contact):
        assert f"law : {{{listed}}}" in solver.__doc__


@pytest.mark.parametrize("e", [0.0, 0.3, 1.0])
def test_the_impulse_is_that_of_two_linear_equations(e):
    impact = col.eccentric(A, B, e, **CONTACT)
    n = np.array([math.cos(0.3), math.sin(0.3)])
    t = np.array([-n[1], n[0]])
    mobility = np.zeros((2, 2))
    relative = np.zeros(2)
    for sign, body in ((-1.0, A), (1.0, B)):
        lever = np.array([0.1 - body.x, 0.2 - body.y])
        q = np.array([-lever[1], lever[0]])
        mobility += np.eye(2) / body.mass + np.outer(q, q) / body.yaw_inertia
        relative += sign * (np.array([body.vx, body.vy]) + body.yaw_rate * q)
    closing, slip = -n @ relative, t @ relative
    axes = np.array([n, t])
    change = np.array([(1.0 + e) * closing, -(1.0 + 0.5 * e) * slip])
    expected = np.linalg.solve(axes @ mobility @ axes.T, change)
    assert impact.regime == "sticking"
    # Two equations of a condition below 10, solved in two ways.
    assert (impact.normal_impulse, impact.tangential_impulse) == pytest.approx(
        tuple(expected), rel=1e-13
    )
    assert impact.slip_after == pytest.approx(-0.5 * e * slip, rel=1e-13)
    lost = sum(
        before.kinetic_energy - after.kinetic_energy
        for before, after in ((s.before, s.after) for s in (impact.a, impact.b))
    )
    # Differences of energies of 250 kJ.
    assert impact.energy_loss == pytest.approx(lost, abs=1e-9)


def test_without_levers_the_oblique_central_model_agrees():
    inert = {"yaw_inertia": math.inf, "yaw_rate": 0.0}
    a, b = A.replace(**inert), B.replace(**inert)
    central = col.oblique_central(
        a, b, 0.3, **{name: value for name, value in CONTACT.items() if name != "point"}
    )
    full = col.eccentric(a, b, 0.3, **CONTACT)
    assert central.slip_after == pytest.approx(-0.15 * central.slip_before, rel=1e-13)
    assert central.b.delta_v == pytest.approx(full.b.delta_v, rel=1e-13)


def test_a_batch_is_its_cases():
    many = col.eccentric(A, B, np.array([0.0, 0.3, 1.0]), **CONTACT)
    for at, e in enumerate((0.0, 0.3, 1.0)):
        one = col.eccentric(A, B, e, **CONTACT)
        assert many.tangential_impulse[at] == pytest.approx(one.tangential_impulse, rel=1e-13)
        assert many.case(at) == one


def test_a_record_reads_back():
    impact = col.eccentric(A, B, 0.3, **CONTACT)
    assert col.Impact.from_dict(impact.to_dict()) == impact
    assert "half back" in col.impact_schema()["properties"]["inputs"]["properties"]["law"]["enum"]


@pytest.mark.slow
def test_explained_reported_and_diagnosed():
    impact = col.eccentric(A, B, 0.3, **CONTACT)
    page = explain(impact)
    assert "half of e comes back of the slip" in page
    # A formula that did not give its number would say so.
    assert "the numbers cancel" not in page
    assert "says the test" in report(impact)
    assert diagnose(impact) is not None


def test_the_slip_that_comes_back_is_drawn():
    impact = col.eccentric(A, B, 0.3, **CONTACT)
    lines = {line.get_gid(): line for line in plot.impulse_plane(impact).lines}
    (x0, x1), (y0, y1) = lines["no slip at separation"].get_data()
    factor = lines["answer"].get_xdata()[0] / impact.normal_impulse
    at = np.array([impact.normal_impulse, impact.tangential_impulse]) * factor
    # A contact that sticks ends on the line.
    off = (x1 - x0) * (at[1] - y0) - (y1 - y0) * (at[0] - x0)
    assert abs(off) < 1e-9 * math.hypot(x1 - x0, y1 - y0) * math.hypot(*at)


def test_speeds_go_back_and_planar_says_that_it_does_not():
    impact = col.eccentric(A, B, 0.3, **CONTACT)
    found = col.reconstruct.speeds(
        A,
        B,
        course_a=A.course,
        course_b=B.course,
        restitution=0.3,
        speed_b=B.speed,
        delta_v_b=impact.b.delta_v,
        **CONTACT,
    )
    assert any(one.a.before.speed == pytest.approx(A.speed, rel=1e-9) for one in found)
    with pytest.raises(
        col.InputError, match="planar cannot go back under law 'half back'"
    ) as refused:
        col.reconstruct.planar(impact.a.after, impact.b.after, restitution=0.3, **CONTACT)
    assert refused.value.code == "law_not_reversible"


def slides_on(restitution, closing, slip, friction, respond, stuck):
    """A contact that slides as it began, to its end."""
    way = select(slip < 0.0, 1.0, -1.0)
    yields, slows = respond(1.0, way * friction)
    normal = (1.0 + restitution) * closing / yields
    after = slip + slows * normal
    return contact_laws.Passage(
        normal=normal,
        tangential=way * friction * normal,
        separation=restitution * closing,
        slip_after=after,
        loss_n=0.5 * (1.0 - restitution) * (closing * normal),
        loss_t=-0.5 * way * friction * normal * (slip + after),
        sticks=False,
    )


@pytest.fixture
def fifth_law(monkeypatch):
    """One with a passage of its own."""
    law = contact_laws.Law(
        "slides on",
        lambda restitution: 0.0,
        no_slip="none",
        derivation="it slides to the end",
        assumption="the contact slides to the end, says the test",
        passage=slides_on,
    )
    monkeypatch.setitem(contact_laws.LAWS, law.name, law)
    return law.name


@pytest.mark.parametrize("solver", [col.oblique_central, col.eccentric])
@pytest.mark.parametrize("e", [0.0, 0.3])
def test_a_passage_of_its_own_is_followed(fifth_law, solver, e):
    """Against the impulse ratio that it has: one case, many, pages and records."""
    a, b = (A, B) if solver is col.eccentric else (A.replace(yaw_rate=0.0), B)
    place = {"normal": 0.3, "point": (0.1, 0.2)} if solver is col.eccentric else {"normal": 0.3}
    impact = solver(a, b, e, friction=0.1, law=fifth_law, **place)
    ratio = -math.copysign(0.1, impact.slip_before)
    known = solver(a, b, e, impulse_ratio=ratio, **place)
    names = ("normal_impulse", "tangential_impulse", "energy_loss", "slip_after")
    for name in names:
        assert getattr(impact, name) == pytest.approx(getattr(known, name), rel=1e-12)
    assert impact.b.after.vx == pytest.approx(known.b.after.vx, rel=1e-12)
    assert impact.separation_speed == pytest.approx(e * impact.closing_speed, rel=1e-12)
    many = solver(a, b, np.full(40, e), friction=0.1, law=fifth_law, **place)
    assert many.case(7) == solver(a, b, e, friction=0.1, law=fifth_law, **place)
    assert col.Impact.from_dict(impact.to_dict()) == impact
    with pytest.raises(col.InputError, match="works with friction= alone"):
        solver(a, b, e, impulse_ratio=0.1, law=fifth_law, **place)


@pytest.mark.slow
def test_a_passage_of_its_own_is_explained_and_reported(fifth_law):
    impact = col.eccentric(A, B, 0.3, **CONTACT | {"law": fifth_law, "friction": 0.1})
    page = explain(impact, form="text")
    assert "it slides to the end" in page
    assert "numbers cancel" not in page
    assert "says the test" in report(impact)
    assert diagnose(impact) is not None
    assert plot.impulse_plane(impact) is not None


@pytest.mark.parametrize("kernel", [central, eccentric])
def test_what_a_kernel_refuses_has_a_message(kernel):
    """A single case raises it; without one the error would be empty."""
    raised = set(re.findall(r"Status\.([A-Z_]+)\)", inspect.getsource(kernel))) - {
        "OK",
        "ENERGY_GAIN",
    }
    assert {"SEPARATING", "OUT_OF_RANGE"} < raised
    assert not [name for name in raised if not col.Status[name].message]
