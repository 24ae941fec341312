"""The ranks of whole scenes on the page "Scenes": what was written, and what it has to be."""

import json

import pytest

from scripts import FOLDER, benchmarks

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the sdist has no benchmarks")


@pytest.fixture(scope="module")
def scripts():
    return benchmarks("scene_ranks", "scene_ranks_tables")


@pytest.mark.slow
def test_the_table_is_made_of_the_rows(scripts):
    script, tables = scripts
    found = tables.load()
    assert found["summary"] == script.summed(found["rows"])
    assert found["settings"]["samples"] == 1024
    numbers = [row["scene"] for row in found["rows"]]
    assert numbers == sorted(set(numbers))
    lines = tables.table(found).splitlines()
    assert len(lines) == 2 + len(script.PRIORS)
    assert str(len(numbers)) in tables.setting(found)


@pytest.mark.slow
def test_the_truths_are_drawn_with_the_seed_of_the_scene(scripts):
    script, tables = scripts
    for row in tables.load()["rows"][:20]:
        rng = script.np.random.default_rng([script.SEED, row["scene"]])
        model = script.crash().as_model(list(script.PRIORS), list(script.RESTS))
        truth, _ = script.drawn(rng, model)
        assert truth == pytest.approx(row["truth"], rel=1e-12)


@pytest.mark.slow
def test_ranks_are_even_and_ranges_hold(scripts):
    """No range holds too seldom, and no ranks are more uneven than one in ten thousand."""
    _, tables = scripts
    found = tables.load()
    count = found["summary"]["scenes"]
    for name, tenths in found["summary"]["tenths"].items():
        assert sum(tenths) == count
        assert tables.uniformity(tenths) > 1e-4, name
        assert tables.binomial(found["summary"]["held"][name], count)[1] >= 0.95, name


def test_the_cost_of_a_posterior_is_that_written(scripts):
    _, tables = scripts
    found = tables.load(tables.COST)
    assert found["samples"] == 4096
    text = tables.cost(found)
    for row in found["rows"].values():
        assert f"| {row['million_formulas']:.0f} |" in text
    assert found["apart"] < 0.2


def test_parts_are_joined(scripts, tmp_path, monkeypatch, capsys):
    script, tables = scripts
    found = tables.load()
    whole, parts = [], []
    for name, rows in (("one.json", found["rows"][::2]), ("two.json", found["rows"][1::2])):
        (tmp_path / name).write_text(json.dumps({**found, "rows": rows}))
        parts.append(str(tmp_path / name))
        whole += rows
    route = found["settings"]["route"]
    arguments = ["scene_ranks.py", parts[0], "--join", parts[1], "--route", route]
    monkeypatch.setattr("sys.argv", arguments)
    script.main()
    joined = json.loads((tmp_path / "one.json").read_text())
    assert joined == found
