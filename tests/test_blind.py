"""Blind predictions: inputs as they were fixed, axes turned rightly, and the table that the page shows."""

import csv
import importlib
import json
import math
import shutil
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import collisions as col
from collisions.__main__ import main
from collisions.uncertainty import Uniform

ROOT = next(folder for folder in Path(__file__).resolve().parents if (folder / "pyproject.toml").is_file())
BLIND = ROOT / "validation" / "blind"
RICSAC = ("1", "3", "4", "5", "6", "10", "12")

pytestmark = pytest.mark.skipif(not BLIND.is_dir(), reason="this copy has no validation pack")


@pytest.fixture(scope="module")
def blind():
    """The modules of the pack by name."""
    sys.path.insert(0, str(ROOT / "validation"))
    try:
        names = ("axes", "inputs", "levels", "predict")
        yield {name: importlib.import_module(f"blind.{name}") for name in names}
    finally:
        sys.path.remove(str(ROOT / "validation"))


def source_row(test):
    with open(BLIND / "sources" / "staged_inputs.csv", newline="", encoding="utf-8") as file:
        (row,) = (row for row in csv.DictReader(file) if row["test"] == test)
    return {name: float(value) for name, value in row.items() if name not in ("test", "vehicle1", "vehicle2", "type")}


def first(text):
    """The number at the beginning of a text of a case file; of a range its middle."""
    low, _, high = text.partition(" .. ")
    return (float(low.split()[0]) + float(high.split()[0])) / 2 if high else float(low.split()[0])


def stated(test):
    return tomllib.loads((BLIND / "cases" / f"ricsac_{int(test):02d}.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("test", RICSAC)
def test_axes_of_the_cases_are_those_of_the_library(blind, test):
    """The point lies in both cars where the source has it and the velocities are its velocities."""
    row, case, axes = source_row(test), stated(test), blind["axes"]
    point = np.array([first(part) for part in case["eccentric"]["point"]])
    assert point == pytest.approx(axes.vector(row["contact_fwd1_cm"] / 100, row["contact_right1_cm"] / 100), abs=1e-9)
    centre, heading = np.array([first(case["b"][name]) for name in "xy"]), math.radians(first(case["b"]["heading"]))
    forward, left = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    in_b = np.array([(point - centre) @ forward, (point - centre) @ -left]) * 100  # forward, right, as drawn
    assert in_b == pytest.approx([row["contact_fwd2_cm"], row["contact_right2_cm"]], abs=0.5)
    speed, course = first(case["b"]["speed"]), math.radians(first(case["b"]["course"]))
    velocity = speed * math.cos(course), speed * math.sin(course)
    assert velocity == pytest.approx(axes.vector(row["v2_fwd1_mps"], row["v2_right1_mps"]), abs=2e-3)
    assert first(case["a"]["speed"]) == row["v1_fwd1_mps"]
    assert row["v1_right1_mps"] == first(case["a"]["course"]) == first(case["a"]["heading"]) == 0


@pytest.mark.parametrize("test", RICSAC)
def test_masses_and_inertias_are_those_of_the_source(test):
    row, case = source_row(test), stated(test)
    for number, side in (("1", "a"), ("2", "b")):
        assert first(case[side]["mass"]) == row[f"m{number}_kg"]
        inertia = case[side]["yaw_inertia"]
        if " .. " in inertia:  # the Rabbit, whose class is too large for it
            assert float(inertia.split(" .. ")[1].split()[0]) == row[f"I{number}_kgm2"]
        else:
            assert first(inertia) == row[f"I{number}_kgm2"]


def test_turning_the_axes_turns_the_impact(blind):
    """An impact in axes to the right and clockwise, with its equations written here, is the library's after turning.

    Perfectly plastic, no slip: 2D momentum, momentum about the point, and a common velocity at the point. In either handedness
    the equations look alike, so that solving them in the data's own axes checks the conversion and not only itself.
    """
    row, axes = source_row("6"), blind["axes"]
    cm = 0.01
    p1 = np.array([row["contact_fwd1_cm"], row["contact_right1_cm"]]) * cm
    p2 = p1 - np.array([row["cg2_fwd1_cm"], row["cg2_right1_cm"]]) * cm
    v = np.array([row["v1_fwd1_mps"], row["v1_right1_mps"], row["v2_fwd1_mps"], row["v2_right1_mps"]])
    m1, m2, i1, i2 = row["m1_kg"], row["m2_kg"], row["I1_kgm2"], row["I2_kgm2"]
    # Unknown: impulse (forward, right) on vehicle 2. Yaw is positive from forward to right, as x to y.
    slip = (v[2:] - v[:2]) @ np.eye(2)
    mobility = (1 / m1 + 1 / m2) * np.eye(2)
    for arm, inertia in ((p1, i1), (p2, i2)):
        across = np.array([-arm[1], arm[0]])
        mobility += np.outer(across, across) / inertia
    impulse = np.linalg.solve(mobility, -slip)
    yaw_2 = (p2[0] * impulse[1] - p2[1] * impulse[0]) / i2
    x, y = axes.vector(*(np.array([row["cg2_fwd1_cm"], row["cg2_right1_cm"]]) * cm))
    vx, vy = axes.vector(row["v2_fwd1_mps"], row["v2_right1_mps"])
    a = col.Vehicle(mass=m1, vx=row["v1_fwd1_mps"], yaw_inertia=i1, x=0.0, y=0.0)
    b = col.Vehicle(mass=m2, vx=vx, vy=vy, yaw_inertia=i2, x=x, y=y)
    found = col.eccentric(a, b, 0.0, normal=axes.angle(math.radians(15.0)), point=axes.vector(*p1), friction=math.inf)
    after = found.b.after
    assert (after.vx - vx, after.vy - vy) == pytest.approx(axes.vector(*(impulse / m2)), rel=1e-9)
    assert after.yaw_rate == pytest.approx(axes.angle(yaw_2), rel=1e-9)


def test_inputs_are_those_that_were_fixed(blind):
    blind["inputs"].check()


@pytest.mark.parametrize("name", ["cases/ricsac_10.toml", "contact_in_time.toml", "sources/staged_inputs.csv"])
def test_a_changed_input_is_noticed(blind, tmp_path, name):
    """A digit, and a case more or less."""
    inputs, copy = blind["inputs"], tmp_path / "blind"
    shutil.copytree(BLIND, copy)
    inputs.check(copy)
    path = copy / name
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("1", "2", 1), encoding="utf-8")
    with pytest.raises(inputs.ChangedInputError, match=name):
        inputs.check(copy)
    path.write_text(text, encoding="utf-8")
    (copy / "cases" / "one_more.toml").write_text(text, encoding="utf-8")
    with pytest.raises(inputs.ChangedInputError, match="one_more"):
        inputs.check(copy)


def test_every_case_names_its_source_and_marks_its_guesses():
    for path in (BLIND / "cases").glob("*.toml"):
        text = path.read_text(encoding="utf-8")
        assert "Jones and Baum (DOT HS-805 040, 1978)" in text or "https://github.com/joe-cormier/pycrash" in text, path.name
        assert text.lower().count("guess") >= 4, path.name


def test_a_range_that_is_not_understood_is_no_number(blind):
    number = blind["inputs"].number
    assert number("5 m") == "5 m"
    assert number("5 m +/- 1.959963984540054 m (95 %)").sd == pytest.approx(1.0)
    assert number("2 deg .. 4 deg") == Uniform("2 deg", "4 deg")
    for text in ("5 m +/- 1 m", "5 m +/- 1 m (90 %)", "5 .. 7 m .. 9", "0.4 .. 0.7 (90 %)"):
        with pytest.raises(ValueError, match="neither"):
            number(text)


def test_predictions_are_those_of_the_command(blind, capsys):
    """The case file answered by ``python -m collisions`` gives the ranges of the predictor, which reads it by itself."""
    assert main([str(BLIND / "cases" / "ricsac_03.toml"), "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)["uncertainty"]["outputs"]
    title, numbers = blind["inputs"].case(BLIND / "cases" / "ricsac_03.toml")
    assert title == "RICSAC 3"
    ours = blind["predict"].predict("impact", numbers)["outputs"]
    names = {"a.delta_v": "delta_v_a", "b.delta_v": "delta_v_b", "b.after.yaw_rate": "yaw_rate_b", "energy_loss": "energy_lost"}
    for theirs, mine in names.items():
        entry = shown[theirs]
        span = entry["std"]
        low, high = ours[mine]["range"]
        assert [low, high] == pytest.approx(entry["interval_95"], abs=0.1 * span), mine
