"""The sentence of every refusal that the solvers make: what was given, what is allowed, what to write instead."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .errors import CollisionsError, InputError, NoImpactError, NoSolutionError, Status
from .impact import Asked
from .kernels import codes
from .vehicle import DOMAINS


def refusal(asked: Asked, raw: tuple[Any, ...]) -> CollisionsError:
    """The error of a single case whose status is not an answer."""
    status = Status(raw[0])
    label = status.label
    for side, body in (("a", asked.a), ("b", asked.b)):
        for name in DOMAINS:
            if getattr(body, name) != getattr(body, name):
                return InputError(
                    f"{side}.{name} is NaN: the state of a case that was refused", code="not_finite", argument=name
                )
    closing = raw[codes.AT["closing_speed"]]
    if status in (Status.SEPARATING, Status.GRAZING):
        nx, ny = asked.normal
        facing = f"the normal must point from A into B, given ({nx:.4g}, {ny:.4g})"
        if status is Status.SEPARATING:
            what = f"move apart along the normal, closing speed {closing:.6g} m/s; {facing}"
            hint = f"if A and B were meant the other way round, exchange them or write normal=({0.0 - nx:.4g}, {0.0 - ny:.4g})"
        else:
            what = f"neither approach nor part along the normal, closing speed 0 m/s; {facing}"
            hint = "give the speeds just before contact, or the normal of the surfaces that met"
        return NoImpactError(f"no impact: the bodies {what}; {hint}", code=label, closing_speed=closing)
    if status is Status.IMMOVABLE:
        return NoSolutionError(
            "nothing can yield along the normal: both bodies are fixed there (infinite masses, or a line of impact through the "
            "pivot of a body against a wall); give at least one a finite mass, or correct normal or point",
            code=label,
        )
    if status is Status.SINGULAR_CONTACT:
        return NoSolutionError(
            "the contact can move in one direction only (a pinned body against a fixed one, or parallel arms), so what would "
            "stop the slip is not defined; write friction=0, or give impulse_ratio=",
            code=label,
        )
    if status is Status.NO_SLIP_PULLS:
        return NoSolutionError(
            f"{asked.rule} = {asked.bound:g} asks for a contact without slip, which here needs the bodies to pull at each "
            f"other (no-slip impulse along the normal {raw[codes.AT['no_slip_normal']]:.6g} N s); give a finite friction=, or "
            f"impulse_ratio=",
            code=label,
        )
    if status is Status.RATIO_JAMS:
        coupling = raw[codes.AT["coupling"]]
        limit = -1.0 / (raw[codes.AT["effective_mass"]] * coupling) if coupling else math.copysign(math.inf, asked.bound)
        side = "less" if limit > 0.0 else "greater"
        return NoSolutionError(
            f"impulse_ratio = {asked.bound:g} jams the bodies: at {limit:.6g} the normal impulse grows without end; "
            f"give a ratio {side} than that",
            code=label,
            limit=limit,
        )
    if status is Status.SPINNING:
        turning = _named(asked, "yaw_rate")
        return InputError(
            f"{asked.model} takes bodies that do not turn, and {turning}; use eccentric, which needs yaw_inertia, x, y and "
            f"point",
            code=label,
            argument="yaw_rate",
        )
    if status is Status.TRANSVERSE:
        nx, ny = asked.normal
        across = ", ".join(
            f"{side} moves at {nx * body.vy - ny * body.vx:.6g} m/s across it"
            for side, body in (("a", asked.a), ("b", asked.b))
            if nx * body.vy - ny * body.vx != 0.0
        )
        return InputError(
            f"linear_central takes motion along the normal ({nx:.4g}, {ny:.4g}) only, and {across}; use oblique_central, or "
            f"give the normal along the motion",
            code=label,
            argument="normal",
        )
    return InputError(
        "the answer is not a finite number: the arguments are too large or too small for floats, or too far apart; "
        "give masses, lengths and speeds whose products stay between 1e-150 and 1e150",
        code=label,
    )


def _named(asked: Asked, field: str) -> str:
    return " and ".join(
        f"{side}{f' ({body.name})' if body.name else ''} has {field} = {getattr(body, field):.6g} rad/s"
        for side, body in (("a", asked.a), ("b", asked.b))
        if np.any(np.not_equal(getattr(body, field), 0.0))
    )
