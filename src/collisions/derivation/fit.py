"""The derivation of a fit: how far each observation is from what the model computes, and what that says of the unknowns."""

from __future__ import annotations

import math

from ..reconstruct import Fit
from ..unit_systems import KIND_OF
from .expressions import total
from .page import Page
from .symbols import letter

_HEAD = ("of", "quantity", "value")
_SAME = 1e-9  # relative to a turn: an angle by the short way round differs by a whole one


def fit(page: Page, found: Fit) -> None:
    """Write it down."""
    residuals = found.residuals
    rows = [
        (
            page.name(one.name),
            "known before" if one.is_prior else "observed",
            f"{_number(page, one.observed, one.unit)} ± {_number(page, one.sigma, one.unit)}",
        )
        for one in residuals.values()
    ]
    for name, (low, high) in found.bounds.items():
        if math.isfinite(low) or math.isfinite(high):
            ends = " to ".join(_number(page, end, found.units[name]) for end in (low, high))
            rows.append((page.name(name), "bounds", ends))
    page.heading("Given")
    page.table(_HEAD, rows)
    page.say(
        "Each ± is one standard error, as it was stated. The model, a function of whoever asked, is not on this page; its "
        "computed values are those at the answer."
    )
    page.heading("Misfit")
    rows = []
    for name, one in residuals.items():
        rows.append((page.name(name), "computed at the answer", _number(page, one.computed, one.unit)))
        rows.append((page.name(name), "stated less computed, over the standard error", f"{one.over_sigma:+.2f}"))
    chance = "none to tell" if math.isnan(found.p_value) else f"{found.p_value:.2g}"
    bend = "not known" if math.isnan(found.nonlinearity) else f"{100.0 * found.nonlinearity:.0f} percent"
    rows += [
        ("all", "chi-squared", f"{found.chi_squared:.4g}"),
        ("all", "degrees of freedom (observations and priors less the unknowns they determine)", str(found.degrees_of_freedom)),
        ("all", "chance of such a chi-squared or a larger one", chance),
        ("all", "by how much the 95 percent intervals are off, as the model bends", bend),
    ]
    page.table(_HEAD, rows)
    ratios = []
    for number, (name, one) in enumerate(residuals.items(), 1):
        kind = KIND_OF.get(one.unit, "number")
        y, f, s, d = (
            letter(rf"{latex}_{{{number}}}", f"{text}_{number}", value, kind)
            for latex, text, value in (
                ("y", "y", one.observed),
                ("f", "f", one.computed),
                (r"\sigma", "sigma", one.sigma),
                ("d", "d", one.residual),
            )
        )
        ratio = letter(f"r_{{{number}}}", f"r_{number}", one.over_sigma, "number")
        ratios.append(ratio)
        caption = f"{number}, {page.name(name)}: stated less computed, over the standard error"
        if abs(y.value - f.value - d.value) > _SAME * math.tau and one.unit == "rad":
            page.say(f"From the computed {page.shown(f)} to the stated {page.shown(y)} the short way round is {page.shown(d)}.")
            page.equation(caption, ratio, d / s)
        else:
            page.equation(caption, ratio, (y - f) / s)
    chi_squared = letter(r"\chi^2", "chi2", found.chi_squared, "number")
    page.equation("Chi-squared, which the answer makes least", chi_squared, total(*(ratio.squared() for ratio in ratios)))
    searches = found.searches
    page.say(
        f"Searches that ended here: {searches['here']} of {searches['starts']}; at another minimum: "
        f"{searches['elsewhere']}; where the model refuses: {searches['refused']}; at no minimum: {searches['without_end']}."
    )
    page.listed([page.name(sentence) + "." for sentence in found.statements])
    page.heading("Answers")
    page.table(_HEAD, [row for name in found.names for row in _answer(page, found, name)])
    page.say(
        "Each ± is one standard error and each range holds 95 percent, given the stated errors and as far as the model is "
        "straight there. They are not widened by the misfit."
    )


def _answer(page: Page, found: Fit, name: str) -> list[tuple[str, str, str]]:
    """What is known of one unknown: estimate, range, what its error comes of, and its correlations."""
    one, at = found[name], found.names.index(name)
    of = page.name(name)
    if not one.determined:
        return [(of, "estimate", "not determined")]
    bound = f", at its {one.at_bound} bound" if one.at_bound else ""
    unit = f" {page.system.label(KIND_OF[one.unit]) if one.unit in KIND_OF else one.unit}".rstrip()
    ends = (_number(page, end, one.unit, one.standard_error).partition(" ± ")[0] for end in one.interval(0.95))
    low, high = (end.removesuffix(unit) for end in ends)
    rows = [
        (of, "estimate", _number(page, one.value, one.unit, one.standard_error) + bound),
        (of, "95 percent interval", f"{low} to {high}{unit}"),
    ]
    rows += [
        (of, f"share of the variance by {page.name(by)}", f"{100.0 * share:.0f} percent")
        for by, share in found.contributions[name].items()
        if math.isfinite(share)  # where the model turns round on a bound, slopes share nothing
    ]
    correlations = found.correlation_matrix[at, at + 1 :]
    others = zip(found.names[at + 1 :], correlations.tolist(), strict=True)
    return rows + [
        (of, f"correlation with {page.name(other)}", f"{correlation:.2f}")
        for other, correlation in others
        if math.isfinite(correlation)
    ]


def _number(page: Page, value: float, unit: str, deviation: float | None = None) -> str:
    """A number of the working or, with its standard error, an answer; a unit of no known kind stays."""
    kind = KIND_OF.get(unit, "number")
    text = page.number(value, kind) if deviation is None else page.system.answer(value, kind, deviation)
    return text if unit in KIND_OF else f"{text} {unit}".rstrip()
