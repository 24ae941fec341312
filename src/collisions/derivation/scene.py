"""The derivation of a whole scene: each impact in order, and where the kinetic energy went."""

from __future__ import annotations

import math
from collections.abc import Callable

from ..impact.impact import Impact
from ..messages.errors import CollisionsError
from ..quantities.tables import as_sentence
from ..scene.run import Run, as_letters
from .page import Page


def scene_steps(page: Page, run: Run, steps: Callable[[Page, Impact], None]) -> None:
    """Write every impact by its own steps, one level below its heading, then the places of rest and
    the ledger of energy.
    """
    movers = run.scene.movers
    names = [page.name(name) for name in movers]
    lasting = any(one.duration is not None and not one.in_time for one in run.scene.contacts)
    unslowed = ", and unslowed while the duration of an impulse has not passed" if lasting else ""
    page.say(
        f"A scene of {', '.join(names)} with {len(run.impacts)} impact"
        f"{'s' * (len(run.impacts) != 1)}. Between impacts each vehicle moves over the ground by "
        f"its tyres or its drag{unslowed}; what is given for a later impact is the state that it "
        "comes with."
    )
    found = run._findings_in(page.system.name)
    if found:
        page.say("What the scene does not describe, or limits its answer:")
        page.listed([as_sentence(page.name(one.sentence)) for one in found])
    for number, (time, pair, impact) in enumerate(
        zip(run.times, run.pairs, run.impacts, strict=True)
    ):
        of = as_letters((page.name(pair[0]), page.name(pair[1])))
        page.heading(f"Impact {number + 1}: {of}, at {time:.2f} s")
        with page.one_level_down():
            steps(page, impact)
    page.heading("Places of rest")
    page.table(rests(page, run))
    page.heading("Where the kinetic energy went")
    page.table(ledger(page, run))
    page.say(
        "What the ground took is the integral of the power of tyres, drag and slope along the "
        "way, and not the rest of the account: the last line says how far the account closes."
    )


def rests(page: Page, run: Run) -> list[tuple[str, str, str]]:
    """The rows of the places and headings of rest."""
    rows = []
    for name in run.scene.movers:
        of = page.name(name)
        try:
            rest = run.rest[name]
        except CollisionsError:
            rows.append((of, "rest", f"none: {run._why_no_rest(name)}"))
            continue
        for words, value, kind in (
            ("position x", rest.x, "length"),
            ("position y", rest.y, "length"),
            ("heading", rest.heading, "angle"),
        ):
            if value is not None and math.isfinite(value):
                # A heading goes on over whole turns on the way, of which a place of rest has none.
                one = math.remainder(value, math.tau) if kind == "angle" else float(value)
                rows.append((of, f"{words} at rest", page.number(one, kind)))
    return rows


def ledger(page: Page, run: Run) -> list[tuple[str, str, str]]:
    """The rows of the energy ledger, and how far it closes."""
    energy = run.energy
    rows = [("scene", "kinetic energy at the start", page.number(energy["before"], "energy"))]
    for number, (pair, taken) in enumerate(zip(run.pairs, energy["contacts"], strict=True)):
        of = " and ".join(page.name(name) for name in pair)
        rows.append((of, f"taken by impact {number + 1}", page.number(taken, "energy")))
    open_ = energy["before"] - math.fsum((*energy["contacts"], energy["ground"], energy["left"]))
    share = abs(open_) / energy["before"] if energy["before"] > 0.0 else 0.0
    closes = (
        "not known" if math.isnan(share) else f"{100.0 * share:.2g} percent of that at the start"
    )
    return [
        *rows,
        ("ground", "taken by tyres, drag and slope", page.number(energy["ground"], "energy")),
        ("scene", "kinetic energy at the end", page.number(energy["left"], "energy")),
        ("scene", "not accounted for", closes),
    ]
