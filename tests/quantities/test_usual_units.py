"""The table of usual units against pint: the same numbers to the bit, the same refusals, and no
registry made.
"""

import subprocess
import sys

import pint
import pytest

import collisions as col
from collisions.quantities import units
from collisions.quantities.formatting import SI_UNITS, SYSTEMS, scale_of
from collisions.quantities.reading import ArgumentReader
from collisions.quantities.usual_units import SCALES, USUAL, usual
from collisions.uncertainty import Normal

# Of the same powers as another spelling, multiplied in another order: what pint gives hangs on
# which of the two a registry reads first, so each has a registry of its own.
REORDERED = ("lbf*ft", "ft*lbf*s**2", "ft*lbf*s")
# Those with another spelling among the usual ones, whichever came first in this process.
SPELT_TWICE = [
    text
    for text in USUAL
    if any(other != text and sorted(other.split("*")) == sorted(text.split("*")) for other in USUAL)
]
KINDS = ("kg", "m/s", "kg*m**2", "J", "rad", "degree", "", "a number with a unit")
OTHER_TEXTS = (
    "80 km/h 5", "1 500 kg", "80", "", "kg", "80 KM/H", "5 Hz", "3 m/s/deg", "12 fortnight",
    "6.9 g_0", "1 ton", "nan m/s", "1e999 kg", "-inf kg", "2 kg kg", "7 g", "1,5 m", "2 mt",
    "4 %*%", "3'", "90 arcmin", "0.1 turn", "40 percent %", "1e305 km",
)  # fmt: skip


@pytest.fixture(scope="module")
def registry():
    return pint.UnitRegistry()


@pytest.mark.parametrize("written", USUAL)
def test_every_row_is_what_pint_gives(written, registry):
    registry = pint.UnitRegistry() if written in REORDERED else registry
    listed, quantity = usual(1.0, written), registry.Quantity(1.0, written)
    assert listed._units == dict(quantity._units)
    assert listed.name == f"{quantity.units}" or written in ("%", "percent")
    assert listed.factor(listed.si) == registry.Quantity(1, written).m_as(listed.si)
    assert units.si_unit(quantity) == listed.si
    by, name = units.factor(quantity, listed.si, "x", f"1.0 {written}")
    assert units.factor(listed, listed.si, "x", f"1.0 {written}") == (by, name)
    assert units.in_degrees(listed) == units.in_degrees(quantity)
    assert units.has_unit(listed) == units.has_unit(quantity)
    if listed.factor("degree") is not None:
        assert listed.factor("degree") == registry.Quantity(1, written).m_as("degree")


def outcome(call, *arguments):
    """What a call gives, or the class and words of its refusal."""
    try:
        found = call(*arguments)
    except col.InputError as error:
        return type(error), error.code, str(error)
    return repr(found)


def readings(text):
    """All that is read of a text: as a number of its own kind and of others, as an angle, for a
    report, as a part of a statement of uncertainty.
    """
    own = USUAL.get(text.partition(" ")[2], ("", "N/m**3", 1.0))[1]
    for kind in (own, *KINDS):
        reader = ArgumentReader()
        yield outcome(reader.number, text, kind, "given")
        yield outcome(reader.close), dict(reader.texts)
    reader = ArgumentReader()
    yield outcome(reader.angle, text, "given")
    yield outcome(reader.close), dict(reader.texts)
    yield outcome(units.si_unit, text), outcome(units.with_symbol, text)
    yield outcome(units.system_given, [text]), outcome(units.kinds_in_degrees, [text])
    yield outcome(Normal, text, text)


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [*(f"0.7 {written}".strip() for written in USUAL if written not in SPELT_TWICE), *OTHER_TEXTS],
)
def test_whatever_is_read_or_refused_by_the_table_is_so_by_pint(text, monkeypatch):
    monkeypatch.setattr(units, "_is_unused", lambda: False)
    by_pint = list(readings(text))
    monkeypatch.setattr(units, "_is_unused", lambda: True)
    assert list(readings(text)) == by_pint


def test_numbers_are_printed_by_the_factors_of_pint(monkeypatch):
    monkeypatch.setattr(units, "_is_unused", lambda: False)
    assert {pair: units.scale(*pair) for pair in SCALES} == SCALES


def in_a_process(code):
    """What code prints in a process that has read no unit yet."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", "import sys, collisions as col\n" + code],
        capture_output=True, text=True, encoding="utf-8", check=True,
    )  # fmt: skip
    return done.stdout.split()


FIRST = """
def moving(mass="1100 kg", speed="50 mph"):
    return col.Vehicle(mass=mass, yaw_inertia="1330 slug*ft**2", vx=speed, x="0 m", y="2 ft",
                       heading="90 deg", yaw_rate="3 deg/s")
def solved():
    return col.eccentric(moving(), moving("2425 lb", "-10 km/h"), "20 %", normal="10 deg",
                         point=("1 m", "50 cm"), friction=0.5)
"""


@pytest.mark.slow
def test_the_first_impact_from_texts_makes_no_registry():
    code = FIRST + (
        "impact = solved()\n"
        "text = str(impact.summary(units='us')) + str(col.explain(impact))\n"
        "print('pint' in sys.modules, impact.a.after.vx.hex())\n"
        "print(impact.q.energy_loss.units, 'pint' in sys.modules, solved().a.after.vx.hex())\n"
    )
    before, number, joule, after, again = in_a_process(code)
    assert (before, after, joule) == ("False", "True", "joule")
    assert number == again


@pytest.mark.slow
@pytest.mark.parametrize("text", ["0.03 fortnight*m/s", "80 kg", "3 m/s/deg"])
def test_another_unit_and_a_refusal_are_of_pint(text):
    code = (
        f"try: col.Vehicle(mass='1 kg', vx={text!r})\nexcept col.UnitsError: pass\n"
        "print('pint' in sys.modules)\n"
    )
    assert in_a_process(code) == ["True"]


@pytest.mark.slow
def test_a_registry_of_the_caller_stands_above_the_table():
    code = (
        "import pint\nfeet = lambda: col.Vehicle(mass='1 kg', x='1 ft').x\nprint(feet())\n"
        "pint.set_application_registry(pint.UnitRegistry(on_redefinition='ignore'))\n"
        "pint.get_application_registry().define('foot = 2 * meter = ft')\nprint(feet())\n"
    )
    assert in_a_process(code) == ["0.30479999999999996", "2.0"]


@pytest.mark.slow
def test_threads_read_usual_and_other_units_at_once():
    code = FIRST + (
        "from concurrent.futures import ThreadPoolExecutor\n"
        "def read(at):\n"
        "    return moving(speed='36 km/h' if at % 2 else '100 hand/second').vx\n"
        "with ThreadPoolExecutor(16) as pool: found = set(pool.map(read, range(64)))\n"
        "print(*sorted(found))\n"
    )
    assert in_a_process(code) == ["10.0", "10.16"]


@pytest.mark.slow
@pytest.mark.parametrize("of", ["new", "--version"])
def test_the_command_imports_only_what_it_prints(of):
    code = (
        f"import contextlib, io\nfrom collisions.__main__ import main\nsys.argv = ['x', {of!r}]\n"
        "with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit): main()\n"
        "print(*(name for name in sys.modules if name.startswith(('collisions.', 'pint'))))\n"
    )
    loaded = in_a_process(code)
    rooms = {name.split(".")[1] for name in loaded if name.count(".") > 1}
    assert "pint" not in loaded
    assert rooms == {"kernels", "messages", "quantities", "vehicle"}


def test_every_printed_unit_has_its_factor_in_the_table(monkeypatch):
    monkeypatch.setattr(units, "to_quantity", lambda *_: pytest.fail("pint was asked"))
    monkeypatch.setattr(units, "_is_unused", lambda: True)
    scale_of.cache_clear()
    for kind in SI_UNITS:
        for system in SYSTEMS:
            scale_of(kind, system)
