"""The findings of a whole scene: those of each of its impacts, and what the scene leaves open."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ..messages.errors import InputError
from ..scene.one_run import need_one_run
from ..scene.run import Run, as_letters
from .finding import NOTE, Finding, Findings
from .moves import Move, Moves

# What is said of a single impact, with what to write in its place.
_OF_ONE = (
    "outline_a",
    "outline_b",
    "tyres_a",
    "tyres_b",
    "crush_energy",
    "damage_pdof_a",
    "damage_pdof_b",
    "damage_delta_v_a",
    "damage_delta_v_b",
)
_PLACED = ("x", "y", "heading")


def diagnose_run(
    run: Run, options: Mapping[str, Any], units: str, diagnose: Callable[..., Findings]
) -> Findings:
    """The findings of every impact in order, each with its number and time, and then those of the
    scene; and what would move each impact.
    """
    need_one_run(run, "diagnose", "impact")
    for name in _OF_ONE:
        if options[name] is not None:
            instead = (
                "the vehicles of a run have the outlines of their movers"
                if name.startswith("outline")
                else f"write diagnose(run.impacts[0], {name}=...) for the impact that it is of"
            )
            raise InputError(
                f"{name} is for one impact, and this is a run: {instead}",
                code="bad_option",
                argument=name,
            )
    found: list[Finding] = []
    measured: set[str] = set()
    moves: list[Move] = []
    for number, (pair, impact) in enumerate(zip(run.pairs, run.impacts, strict=True)):
        movers = zip("ab", run.pairs[number], strict=True)
        starts = {label: run.scene.movers[name].vehicle for label, name in movers}
        own = diagnose(impact=impact, units=units, starts=starts, **_outlines(run, number))
        measured |= own.measured
        found += [of_impact(one, run, number) for one in own]
        of = f"impact {number + 1}, {as_letters(pair)}"
        moves += [replace(move, what=f"{of}: {move.what}") for move in own.moves]
    found += [
        Finding(
            code=notice.code,
            sentence=notice.sentence,
            measured=1.0,
            limit=0.0,
            unit="",
            time=notice.time,
            source=NOTE,
        )
        for notice in run._findings_in(units)
        # The impact itself has that finding.
        if notice.code != "energy_gain"
    ]
    return Findings(found, measured, units, Moves(moves, units))


def of_impact(finding: Finding, run: Run, number: int) -> Finding:
    """A finding of one of the impacts of a run with its number, its vehicles and its time."""
    time = run.times[number]
    where = f"impact {number + 1}, {' and '.join(run.pairs[number])} at {time:.2f} s"
    return replace(finding, sentence=f"{where}: {finding.sentence}", impact=number, time=time)


def _outlines(run: Run, number: int) -> dict[str, Any]:
    """The outlines of both vehicles of an impact, where its point was given: one from the outlines
    lies in both of them by itself.
    """
    if run.scene.contacts[run.rules[number]].from_outlines:
        return {}
    impact = run.impacts[number]
    found = {}
    for label, name in zip("ab", run.pairs[number], strict=True):
        outline = run.scene.movers[name].outline
        before = getattr(impact, label).before
        if outline is not None and all(getattr(before, part) is not None for part in _PLACED):
            found[f"outline_{label}"] = [tuple(corner) for corner in outline.tolist()]
    return found
