"""explain compares what it writes: a result that is not what its formulas give is refused, and a
rough one shows both numbers.
"""

import dataclasses
import math
import pickle
import random
import re
import warnings

import pytest

import collisions as col
import scenes
from collisions import reconstruct
from collisions.derivation import contact, explain, models, page, symbols
from collisions.derivation.expressions import System
from collisions.diagnostics import diagnose
from collisions.impact.impact import build
from collisions.travel import Tyres
from derivation.test_derivation import (
    FITS,
    MOMENTA,
    crossroads,
    example_1,
    example_2,
    example_3,
    fallen,
)
from variants import one_in

# 1 % is no rounding, 1e-5 none of an ordinary impact.
WRONG, ROUGH = 1.01, 1.0 + 1e-5


def in_time():
    """A contact followed in time, with tyres."""
    return crossroads(col.time_resolved, duration=0.1, drag=0.4, friction=0.8)


IMPACTS = {
    "linear": example_1,
    "reverse": example_2,
    "pinned": example_3,
    "oblique": lambda: crossroads(col.oblique_central, friction=0.1),
    "sliding": lambda: crossroads(friction=0.05),
    "sticking": lambda: crossroads(friction=0.8),
    "kudlich-slibar": lambda: crossroads(friction=0.8, law="kudlich-slibar"),
    "ratio": lambda: crossroads(impulse_ratio=-0.2),
    "fraction": lambda: crossroads(critical_fraction=0.6),
    "stronge": lambda: crossroads(friction=0.05, law="stronge"),
    "barrier": lambda: col.eccentric(
        *fallen("barrier"), 0.15, normal=0.1, point=(-0.2, 0.1), friction=0.2
    ),
    "time": in_time,
}
# Of every result, what is read out of it first; of some models more.
EVERY = ("closing_speed", "impulse_x", "delta_vx_a", "energy_loss")
MUTATED = [
    (name, field)
    for name in IMPACTS
    for field in EVERY
    if not (name == "time" and field == "closing_speed")
]
MUTATED += [
    (name, field)
    for name in ("sliding", "sticking", "kudlich-slibar", "fraction", "stronge")
    for field in ("normal_impulse", "tangential_impulse", "impulse_y", "delta_vy_b",
    "delta_yaw_rate_b", "slip_before",
                  "slip_after", "energy_loss_normal", "energy_loss_tangential", "effective_mass",
                  "coupling")
]  # fmt: skip
MUTATED += [
    (name, field)
    for name in ("sticking", "fraction")
    for field in ("no_slip_normal", "no_slip_tangential")
]
MUTATED += [("stronge", "separation_speed")]
# No slip is left to be altered; and 1 % of the friction's small share is less than 1e-3 of the
# whole loss.
MUTATED = [
    row
    for row in MUTATED
    if row not in (("sticking", "slip_after"), ("stronge", "energy_loss_tangential"))
]


def altered(impact, field, factor):
    """The impact with one number of its answer multiplied."""
    raw = impact._answer
    found = build(impact.inputs, raw._replace(**{field: getattr(raw, field) * factor}))
    vars(found).update(
        {name: vars(impact)[name] for name in ("reconstruction", "choice") if name in vars(impact)}
    )
    return found


@pytest.mark.parametrize("form", ["text", "markdown"])
@pytest.mark.parametrize(("name", "field"), one_in(5, MUTATED))
def test_a_wrong_answer_is_not_explained(name, field, form):
    """1 % in any number of the answer is an error that names the equation and whose
    defect it is.
    """
    impact = IMPACTS[name]()
    explain(impact, form=form)
    with pytest.raises(col.InternalError, match="defect of this library") as caught:
        explain(altered(impact, field, WRONG), form=form)
    error = caught.value
    assert error.code == "contradicts_derivation"
    assert error.fields["equation"] in str(error)
    assert error.fields["share"] > 1e-3
    assert "Use neither" in str(error)
    assert not isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.fields) == (str(error), error.fields)


@pytest.mark.slow
@pytest.mark.parametrize("field", ["tyre_impulse_x_a", "tyre_moment_b"])
def test_an_answer_of_what_is_not_known_is_not_explained(field):
    """Nor does a diagnosis take it for rounding."""
    tyres = Tyres(0.7, 0.5, 2.7, 1.5)
    impact = crossroads(friction=0.8, duration=0.1, tyres_a=tyres, tyres_b=tyres)
    explain(impact)
    lost = altered(impact, field, math.nan)
    with pytest.raises(col.InternalError, match="defect of this library"):
        explain(lost)
    if "impulse" in field:
        (found,) = [one for one in diagnose(lost) if one.code == "rounding"]
        assert "cannot be compared" in found.sentence
        assert "do not rely on this result" in found.sentence


@pytest.mark.slow
@pytest.mark.parametrize("form", ["text", "markdown"])
@pytest.mark.parametrize(("name", "field"), MUTATED)
def test_a_rough_answer_has_the_formulas_number_beside_it(name, field, form):
    """1e-5 is printed with both numbers, in the units of the page."""
    impact = IMPACTS[name]()
    assert "The two sides differ" not in explain(impact, form=form)
    text = explain(altered(impact, field, ROUGH), form=form, units="us")
    both = (
        r"the number of the result is (-?[\d.]+\d)(.*?), and the formula, worked out with all "
        r"digits, gives (-?[\d.]+\d)"
    )
    found = re.findall(both, text)
    assert found
    for result, unit, own in found:
        assert "m/s" not in unit
        assert result != own
        assert float(result) == pytest.approx(float(own), rel=0.02, abs=1e-3)


@pytest.mark.parametrize("which", range(len(MOMENTA)))
@pytest.mark.parametrize(
    "name",
    ["speed_a", "speed_b", "delta_v_a", "delta_v_b", "translational_energy_loss", "condition"],
)
def test_planar_momentum(which, name):
    whole = MOMENTA[which]
    value = getattr(whole, name)
    if value == 0.0:
        value = 1.0
    with pytest.raises(col.InternalError, match="contradict each other"):
        explain(dataclasses.replace(whole, **{name: value * WRONG}))
    if getattr(whole, name):
        assert "The two sides differ" in explain(
            dataclasses.replace(whole, **{name: value * ROUGH})
        )


def test_a_fit():
    """Its sum of squares is that of its residuals."""
    fit = FITS[0]
    with pytest.raises(col.InternalError, match="Chi-squared"):
        explain(dataclasses.replace(fit, chi_squared=fit.chi_squared * WRONG))
    assert "The two sides differ" in explain(
        dataclasses.replace(fit, chi_squared=fit.chi_squared * ROUGH), form="text"
    )


@pytest.mark.parametrize("solver", [col.oblique_central, col.eccentric])
@pytest.mark.parametrize("friction", [0.05, 0.8])
def test_a_regime_that_is_not_so_is_not_written(solver, friction):
    """A contact said to stick beyond its friction, and one said to slide within it."""
    impact = crossroads(solver, friction=friction)
    raw = impact._answer
    with pytest.raises(col.InternalError):
        explain(build(impact.inputs, raw._replace(sticks=not raw.sticks)))


def wrong_moment(monkeypatch):
    right = models.Lever.torque
    monkeypatch.setattr(models.Lever, "torque", lambda self, s: right(self, s) * 1.01)


def wrong_loss(monkeypatch):
    monkeypatch.setattr(contact, "HALF", symbols.Symbol("h", 0.495, "number"))


def wrong_sign(monkeypatch):
    right = symbols.Symbols.scene
    monkeypatch.setattr(symbols.Symbols, "scene", lambda self, axis, n, t: right(self, axis, n, -t))


def wrong_pdof(monkeypatch):
    right = contact.Direction
    monkeypatch.setattr(contact, "Direction", lambda x, y: right(y, x))


@pytest.mark.parametrize("mistake", [wrong_moment, wrong_loss, wrong_sign, wrong_pdof])
def test_a_wrong_derivation_is_refused(mistake, monkeypatch):
    """The result is right, and what the page would say of it is not."""
    impact = IMPACTS["sliding"]()
    mistake(monkeypatch)
    with pytest.raises(col.InternalError, match="formula gives"):
        explain(impact, form="text")


def test_a_report_with_a_derivation_refuses_too():
    impact = altered(IMPACTS["sticking"](), "energy_loss", WRONG)
    with pytest.raises(col.InternalError):
        col.report(impact, derivation=True, figures=False)


def noted(monkeypatch):
    """The shares by which the sides of what is written differ, also where both are printed as 0."""
    shares = []
    right = page._share_apart

    def instead(left, formula, kind):
        found = right(left, formula, kind)
        off = left.value - formula.value
        off = math.remainder(off, math.tau) if kind == "angle" and math.isfinite(off) else off
        size = max(left.size, formula.size)
        shares.append(abs(off) / size if math.isfinite(off) and 1e-9 < size < math.inf else found)
        return found

    monkeypatch.setattr(page, "_share_apart", instead)
    return shares


ORDINARY = ("traffic", "barrier", "map grid", "A pinned", "B pinned", "grazing")
CONTACTS = [
    (law, rule) for law in scenes.LAWS for rule in (*scenes.RULES, scenes.INCOMPLETE, scenes.PUSHED)
]
CONTACTS += [("stronge", rule) for rule in ("friction", scenes.INCOMPLETE, scenes.PUSHED)]


def check_ordinary(count, monkeypatch):
    """So many scenes of every family, law and rule: no equation is off by 1e-9 of its largest term;
    returns how many there were.
    """
    shares = noted(monkeypatch)
    done = 0
    for family in ORDINARY:
        for law, rule in CONTACTS:
            rng = random.Random(f"{family} {law} {rule}")
            for _ in range(count):
                scene = scenes.draw(family, "brach" if law == "stronge" else law, rule, rng)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", col.CollisionsWarning)
                    impact = scenes.solved("eccentric", scene, law=law, on_failure="nan")
                if not impact.refused:
                    text = explain(impact, form="text")
                    assert "The two sides differ" not in text
                    done += 1
    assert all(share <= 1e-9 for share in shares), max(shares)
    assert not any(map(math.isnan, shares))
    return done, len(shares)


@pytest.mark.slow
def test_ordinary_impacts_agree(monkeypatch):
    done, compared = check_ordinary(1, monkeypatch)
    assert done > 50
    assert compared > 50 * done / 2


@pytest.mark.slow
def test_a_thousand_ordinary_impacts_agree(monkeypatch):
    done, compared = check_ordinary(15, monkeypatch)
    assert done > 1000
    assert compared > 50 * done


@pytest.mark.slow
def test_a_reverse_answer_agrees(monkeypatch):
    """The motions before a given end: the equations of every reverse solver too."""
    shares = noted(monkeypatch)
    rng = random.Random(5)
    done = 0
    for _ in range(30):
        ends = [rng.uniform(-20.0, 20.0) for _ in range(2)]
        impact = reconstruct.central(
            rng.uniform(600, 3000),
            rng.uniform(600, 3000),
            va=max(ends),
            vb=min(ends),
            restitution=0.2,
        )
        explain(impact)
        done += 1
    assert done == 30
    assert max(shares) <= 1e-9


def test_what_is_0_in_print_is_0():
    """A slip that rounding leaves is no contradiction of one that is 0."""
    left, right = symbols.Symbol("s", 0.0, "speed"), symbols.Symbol("q", 1e-15, "speed")
    assert page._share_apart(left, right, "speed") == 0.0
    assert page._share_apart(left, symbols.Symbol("q", 1e-3, "speed"), "speed") == 1.0
    assert page._share_apart(symbols.Symbol("s", math.nan, "speed"), right, "speed") == math.inf
    beyond = symbols.Symbol("q", 1e300, "number") * symbols.Symbol("r", 1e300, "number")
    none = symbols.Symbol("e", 0.0, "number")
    assert math.isnan(page._share_apart(none, beyond / beyond, "number"))


@pytest.mark.slow
def test_a_divisor_that_is_all_rounding_is_no_contradiction():
    """Slip of 1e57 times the closing speed: where the ratio stops it, what it leaves of the
    resistance to the normal impulse is the rounding of its terms. The page says that it cancels.
    """
    impact = col.eccentric(
        col.Vehicle(mass=39563.6, yaw_inertia=29254.7, x=1.89, y=-0.325, vx=-16.6, vy=20.3),
        col.Vehicle(mass=20295.0, yaw_inertia=17437.4, x=2.99, y=0.065, vx=-8.9, vy=-2.85e58),
        0.844,
        normal=(-1.0, 0.0),
        point=(-2.735, 3.531),
        critical_fraction=1.0,
    )
    assert impact.normal_impulse > 1e60
    assert "In this form the numbers cancel" in explain(impact)


@pytest.mark.parametrize("form", ["text", "markdown"])
def test_a_symbol_stands_for_one_thing(form):
    """A page on which one symbol has two values is refused; the impulses of a pivot and from
    outside, and the work of compression with these and without, have symbols of their own.
    """
    sheet = page.Page(System("si"), form == "markdown", {}, {})
    one, other = (symbols.Symbol("E_c", value, "energy") for value in (500.0, 501.0))
    sheet.shown(one)
    with pytest.raises(col.InternalError, match="E_c stands for 500 and for 501"):
        sheet.equation("Energy", symbols.Symbol("E", 501.0, "energy"), other)
    a = col.Vehicle(mass=1500, yaw_inertia=2500, vx=11, vy=1, x=-2, y=-0.2, heading=0.1)
    b = col.Vehicle(mass=1300, yaw_inertia=2200, x=2, y=0.8, heading=1.4)
    contact = {"normal": 0.05, "point": (0, 0), "friction": 0.4, "outside_b": (300, -700, 20)}
    pinned = col.eccentric(a, b.replace(pivot=(3, 1)), 0.3, **contact)
    assert ("R_{Bx}" if form == "markdown" else "R_Bx") in str(col.explain(pinned, form=form))
    compressed = col.eccentric(a, b, 0.3, law="stronge", **contact)
    assert "W_c" in str(col.explain(compressed, form=form))
    # A pivot at O, and an impulse from outside beside that of tyres.
    held = {"tyres_b": Tyres(0.7, 1.0, 2.6, 1.5), "duration": 0.1}
    both = str(
        col.explain(col.eccentric(a, b.replace(pivot=(3, 1)), 0.3, **contact, **held), form=form)
    )
    assert ("Q}_{Bx}" if form == "markdown" else "Q_Bx") in both
