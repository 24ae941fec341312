"""A scene or a run given where a result is wanted: the error says how to write the run of it, or
the impact of that run.
"""

from collections.abc import Callable
from typing import Any

import pytest

import collisions as col
from collisions import plot
from crashes import coasting

WHOLE = {
    "report": col.report,
    "explain": col.explain,
    "diagnose": col.diagnose,
    "plot.scene": plot.scene,
}
OF_ONE: dict[str, Callable[[Any], Any]] = {
    "plot.energy": plot.energy,
    "plot.momentum": plot.momentum,
    "plot.impulse_plane": plot.impulse_plane,
    "left_out": col.left_out,
    "what_if": lambda one: col.what_if(one, {"restitution": (0.0, 0.3)}),
}


def refused(function: Callable[[Any], Any], given: Any) -> str:
    with pytest.raises(col.InputError) as error:
        function(given)
    assert error.value.code == "not_an_impact"
    return str(error.value)


@pytest.mark.slow
@pytest.mark.parametrize("name", WHOLE)
def test_what_takes_a_run_says_so(name: str) -> None:
    run = coasting()
    said = refused(WHOLE[name], run.scene)
    assert said.endswith(f"a Run, got Scene; write {name}(scene.run())")
    # What it says to write is right.
    WHOLE[name](run)


@pytest.mark.parametrize("name", OF_ONE)
def test_what_takes_an_impact_names_that_of_the_run(name: str) -> None:
    run = coasting()
    for given, written in ((run, "run"), (run.scene, "scene.run()")):
        said = refused(OF_ONE[name], given)
        assert said.endswith(f"; write {name}({written}.impacts[0]) for the first impact")
    if name == "left_out":
        OF_ONE[name](run.impacts[0])
