"""The search of ``speeds``: from the scenes of the algebra to the roots that fit, in order, with a
friction that recorders show, readings at a recorder's place, and tyres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial, reduce
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from ..engine.blocks import Part, in_parts, is_one_part
from ..impact.inputs import Inputs
from ..kernels.contact_laws import BRACH, FRICTION
from .common import Cases, counted
from .lasting import SETTLED
from .recorder_place import Recorders, RecorderScene
from .restitution_roots import RestitutionOf, crossings
from .speeds_algebra import FREE, LAW, NO_ROOT, REDUNDANT, ROOT_TOL, Root, Scene
from .speeds_components import (
    COMPONENTS,
    CONTRADICTION,
    ComponentScene,
    Shown,
    friction_shown,
    together,
)
from .speeds_tyres import (
    Attempt,
    in_balance,
    other_starts,
    speeds_beside_an_energy,
    speeds_with_tyres,
    starts_on_line,
)

# Of the closing speed: roots of several searches that differ by more are not one, however badly
# conditioned.
_ONE_ROOT = 1e-3
# Where speeds may differ by more and still meet what is known, that repeats itself.
_FREE = 0.1
# The row of a root, as an array, by which roots are sorted and left out.
_CLOSING = Root._fields.index("closing")


class _Looked(NamedTuple):
    """A scene, its roots and where each is, the friction that it showed, if any, and by the way of
    a root, where it is of several scenes.
    """

    scene: Scene
    found: list[tuple[Root, Any]]
    friction: Any
    frictions: Sequence[Any] = ()


class Search:
    """What is sought, and from what: the numbers of all cases by name, what is known, and how.

    Parameters
    ----------
    numbers : dict of float or array
        What the scenes of the algebra take, courses as directions.
    cases : Cases
        The cases of a batch, or one.
    inputs : Inputs
        The impact without its speeds; an infinite friction is one that the components show.
    known : dict of float or array
        The known quantities, as they were given.
    function : RestitutionOf, optional
        What gives the restitution for a closing speed.
    recorders : Recorders, optional
        Where components were read, and in which axes.
    regime, slid, forward_only
        As for ``speeds``.
    texts : dict of str
        What was given as text, by the names that results have.
    """

    def __init__(
        self,
        numbers: dict[str, Any],
        cases: Cases,
        inputs: Inputs,
        known: dict[str, Any],
        *,
        function: RestitutionOf | None,
        recorders: Recorders | None,
        regime: str | None,
        slid: str | None,
        forward_only: bool,
        texts: dict[str, Any],
    ) -> None:
        self.numbers, self.cases, self.inputs, self.known = numbers, cases, inputs, known
        self.function, self.recorders, self.texts = function, recorders, texts
        self.regime, self.slid, self.forward_only = regime, slid, forward_only
        self.components = any(name in COMPONENTS for name in known)
        self.names, self.law = counted(known), inputs.law or BRACH
        self._of_components: Callable[..., ComponentScene] = (
            ComponentScene if recorders is None else partial(RecorderScene, recorders)
        )
        # A function is called with all cases; the turn of cars is looked for until all have it.
        self._together = (
            is_one_part(cases.shape or ()) or function is not None or recorders is not None
        )
        # The impulse of the tyres is then in the balance from which components tell that of the
        # contact.
        self._balanced = bool(inputs.tyres) and self.components

    def solved(self, changes: Mapping[str, Any] = {}, only: Mapping[str, Any] = {}) -> Attempt:
        """The scene and its roots, with some numbers changed, in balance with the tyres; ``only``
        says in which direction a contact that slid did.
        """

        def changed(held: dict[str, Any], most: float = CONTRADICTION) -> Attempt:
            return self._attempt({**held, **changes}, most, only)

        if self._balanced:
            states = self.regime == "sticking" and self.inputs.rule == FRICTION
            free = states and bool(np.any(np.isfinite(self.inputs.rule_value)))
            found = in_balance(changed, self.numbers, self.cases, free)
            roots = [
                root._replace(closing=np.where(there, root.closing, np.nan))
                for root, there in found.found
            ]
            found = found._replace(found=in_order(found.scene, roots))
        else:
            found = changed({})
        if not self.texts:
            return found
        own = {**self.texts, **(found.inputs.given or {})}
        return found._replace(inputs=replace(found.inputs, given=own))

    def turned(self, where: Any = True) -> str:
        """What a single case, or these of a batch, may have wrong: the lateral components with
        whose signs turned both vehicles go forwards, in most of them; "" for none.
        """
        lateral = [name for name in self.known if name.startswith("delta_v_left")]
        best, said_of = math.inf, ""
        for names in (names for n in (1, 2) for names in combinations(lateral, n)):
            scene, found, *_ = self.solved({name: -self.known[name] for name in names})
            assert isinstance(scene, ComponentScene)
            # Of a single case the first answer is the one that is meant.
            roots = found if scene.shape else found[:1]
            ahead: Any = False
            with np.errstate(all="ignore"):
                for both, there in [(root[:2], there) for root, there in roots] or [
                    (scene.answer, scene.ambiguous)
                ]:
                    ahead = ahead | (there & (np.minimum(*both) >= 0.0))
            ahead, misfit, asked = np.broadcast_arrays(ahead, scene.misfit, where)
            fits, missed = ahead[asked], misfit[asked & ahead]
            if np.mean(fits) > 0.5 and np.median(missed) < best:
                best, said_of = float(np.median(missed)), " and ".join(names)
        return said_of

    def _attempt(self, held: dict[str, Any], most: float, only: Mapping[str, Any]) -> Attempt:
        """The scene and its roots where these impulses of tyres act, and where known values may
        differ by so much.
        """
        own, asked = {**self.numbers, **held}, self.inputs
        if not self._together:
            now = self._in_parts(own, most, only)
        else:
            try:
                single = self.cases.shape is None and self.function is None
                now = self._looked(own, self.cases, most, single, only=only)
            except ArithmeticError:  # of plain floats, which arrays answer with inf or NaN
                now = self._looked(own, self.cases, most, only=only)
        of_inputs = asked if now.friction is None else _with_friction(asked, now.friction)
        return Attempt(now.scene, now.found, of_inputs, now.frictions, now.friction is not None)

    def _looked(
        self,
        own: dict[str, Any],
        some: Cases,
        most: float,
        plain: bool = False,
        shares: bool = False,
        only: Mapping[str, Any] = {},
    ) -> _Looked:
        """The scene of these numbers and its roots, with the friction that the components show in
        place of an infinite one. ``shares`` says that another case has a share of the critical
        ratio.
        """
        if self.recorders is None or not np.any(own["duration"] > 0.0):
            return self._looked_from(only, own, some, most, plain, shares)
        starts = self._scene(own, some.shape or (), most).impulses()
        looks = [
            self._looked_from({"start": start, **only}, own, some, most, plain, shares)
            for start in starts
        ]
        return _together(looks, own[self.inputs.rule], self._balanced)

    def _looked_from(
        self,
        start: Mapping[str, Any],
        own: dict[str, Any],
        some: Cases,
        most: float,
        plain: bool,
        shares: bool,
    ) -> _Looked:
        """The same of the impulse at which readings that may mean several begin."""
        asked, shape = self.inputs, some.shape or ()
        # Of these cases, which may be a part of all.
        without = np.isinf(own.get(FRICTION, 0.0))
        if FREE in own:
            own = {**own, FRICTION: np.where(own[FREE] > 0.0, math.inf, own[FRICTION])}
        friction, shown = None, Shown()
        if self.components and asked.rule == FRICTION and np.any(np.isinf(asked.rule_value)):
            of_components = partial(self._of_components, most=most, **start)
            shown = friction_shown(of_components, own, self.law, self.names, shape, self.regime)
            if shown.friction is not None:
                friction = some.values(shown.friction)
                own = {**own, FRICTION: friction}
        scene = self._scene(own, shape, most, plain, start)
        scene.shares = scene.shares or shares
        if isinstance(scene, ComponentScene):
            scene.leaves_slip = scene.leaves_slip | shown.fits_both
            scene.toward, scene.reach, scene.no_side = shown.toward, shown.reach, shown.no_side
            scene.slides_better = shown.better
            scene.shows_friction = without & (friction is not None)
        roots = scene.roots() if self.function is None else _with_function(scene, self.function)
        if isinstance(scene, ComponentScene) and np.any(np.isfinite(scene.slid_at)):
            slid_at = np.where(np.isfinite(scene.slid_at), scene.slid_at, own[FRICTION])
            friction = some.values(slid_at)
        if most == math.inf:
            # Whether it stuck or slid is asked when the tyres are known.
            scene.ambiguous = np.zeros((), dtype=bool)
        return _Looked(scene, in_order(scene, roots), friction)

    def _scene(
        self,
        own: dict[str, Any],
        shape: tuple[int, ...],
        most: float,
        plain: bool = False,
        start: Mapping[str, Any] = {},
    ) -> Any:
        """The scene of these numbers."""
        kind: Callable[..., Scene] = Scene
        if self.components:
            kind = partial(
                self._of_components,
                regime=self.regime,
                slid=self.slid,
                most=most,
                forward_only=self.forward_only,
                **start,
            )
        return kind(own, self.inputs.rule, self.law, self.names, shape=shape, plain=plain)

    def _in_parts(self, own: dict[str, Any], most: float, only: Mapping[str, Any]) -> _Looked:
        """The same as ``_looked`` of all cases, block by block."""
        shape = self.cases.shape or ()
        whole = self._scene(own, shape, most)

        def work(part: Part) -> dict[str, Any]:
            there = {name: part.of(value) for name, value in own.items()}
            some = Cases(part.shape, self.cases.dtype)
            scene, found, friction, _ = self._looked(
                there, some, most, shares=whole.shares, only=only
            )
            parts = scene.findings()
            for i, (root, where) in enumerate(found):
                parts |= {f"{i}.{name}": value for name, value in root._asdict().items()}
                parts[f"{i}.there"] = where
            return parts if friction is None else {**parts, FRICTION: friction}

        merged = in_parts(work, shape)
        friction = merged.get(FRICTION)
        if friction is not None:
            # A part that shows none has what was given.
            friction = self.cases.values(np.where(np.isnan(friction), own[FRICTION], friction))
            whole = self._scene({**own, FRICTION: friction}, shape, most)
        whole.take(merged)
        found: list[tuple[Root, Any]] = []
        while f"{len(found)}.there" in merged:
            root = Root(*(merged[f"{len(found)}.{name}"] for name in Root._fields))
            found.append((root, merged[f"{len(found)}.there"]))
        return _Looked(whole, found, friction)

    def while_tyres_act(self, attempt: Attempt) -> Attempt:
        """With the roots of a contact in which the tyres act, in order, and where each is: those to
        which the roots of the instant and other speeds lead; beside a known speed and one other
        known value those that a scan of the unknown speed shows.

        Roots that are in balance have the impulse of the tyres already: of a contact that stuck, or
        beside a known speed or an energy and more components than it needs. Of a case, all are
        tried with the friction of its first.
        """
        knows_speed = any(name.startswith("speed") for name in self.known)
        knows_energy = bool({"energy_loss", "ees_a"} & self.known.keys())
        knows_more = len(self.known) == 2 or knows_speed or knows_energy
        # A place of a recorder and its axes are in the balance alone.
        if self._balanced and not (self.recorders is None and knows_more):
            return attempt
        scene, found = attempt.scene, attempt.found
        directions = {
            label: (scene.numbers[f"course_{label}[0]"], scene.numbers[f"course_{label}[1]"])
            for label in "ab"
        }
        shape, unit = self.cases.shape or (), scene.speed_unit
        starts: list[tuple[Any, Any]] = [
            (
                np.where(there, root.speed_a * unit, np.nan),
                np.where(there, root.speed_b * unit, np.nan),
            )
            for root, there in found
        ]
        if knows_speed and len(self.names) == 2:
            # Those that other starts lead to are on the line too.
            of_line = attempt.ways_of_starts(len(found) + 1)[-1]
            along = attempt.inputs_of_way(of_line)
            starts += starts_on_line(along, directions, starts, self.known, shape)
        else:
            starts += other_starts(attempt.inputs, self.known, shape)
        if not starts:
            return attempt._replace(found=[])
        of_starts = attempt.ways_of_starts(len(starts))
        inputs = attempt.inputs_of_way(of_starts)
        ended: Any = np.zeros((), dtype=bool)
        if self.slid and isinstance(scene, ComponentScene):
            # Ends of families stay as they are, in the balance alone.
            ends = (scene.of_way(root.way).ended & there for root, there in found)
            ended = reduce(np.logical_or, ends, scene.of_way(of_starts[0]).ended)
        begins = np.stack([np.stack(np.broadcast_arrays(*start)) for start in starts], axis=1)
        more = self._balanced and len(self.known) > 2
        beside_energy = more and knows_energy and not knows_speed and self.regime != "sliding"
        arguments = inputs, directions, (begins[0], begins[1]), self.known, (len(starts), *shape)
        kept = found if more else []
        if beside_energy and isinstance(scene, ComponentScene):
            misfits = [scene.of_way(root.way).misfit for root, _ in kept]
            answer, either = speeds_beside_an_energy(*arguments, misfits, self.forward_only)
            if self.regime is None:
                scene.ambiguous = scene.ambiguous | either
        else:
            answer = speeds_with_tyres(*arguments, len(kept))
        fits = answer.settled
        rooted = reduce(np.logical_or, (there for _, there in found), False)
        if self._balanced and not (more or knows_speed):
            # Of the contacts that stick, where it is known that this one did.
            fits = fits & answer.sticks
            if self.regime is None:
                fits = fits & rooted
        elif self.regime is not None:
            # Other starts may lead to a contact that ended otherwise than was stated.
            so = np.broadcast_to(answer.sticks == (self.regime == "sticking"), fits.shape).copy()
            so[: len(found)] = True
            fits = fits & so
        if answer.misfit is not None:
            fits = _best_of(answer.misfit, fits & (answer.worst <= CONTRADICTION))
            least = np.min(np.where(fits, answer.worst, np.inf), axis=0)
            for i in range(len(found)):
                # What other starts lead back to is that root, with its condition.
                apart = sum(
                    abs(speed[len(found) :] - speed[i])
                    for speed in (answer.speed_a, answer.speed_b)
                )
                fits[len(found) :] &= ~(fits[i] & (apart <= ROOT_TOL * answer.closing[i]))
            if isinstance(scene, ComponentScene):
                for one in [scene, *scene.ways]:
                    one.misfit = np.where(np.isfinite(least), least, one.misfit)
                    if self.regime is None:
                        # What is stated is in doubt whichever start led to it.
                        one.may_slide = one.may_slide & np.any(fits[: len(found)], axis=0)
        elif isinstance(scene, ComponentScene):
            # Where no more is known than is sought, what settles fits; an instant may have none.
            settled = np.any(fits, axis=0)
            for one in [scene, *scene.ways]:
                one.misfit = np.where(settled & np.isinf(one.misfit), 0.0, one.misfit)
        roots = []
        for i in range(len(starts)):
            condition = answer.condition[i]
            if more and i < len(found) and attempt.shows:
                # That of a root has what the ratio adds that the components show.
                condition = np.fmax(condition, found[i][0].condition)
            roots.append(
                Root(
                    answer.speed_a[i] / unit,
                    answer.speed_b[i] / unit,
                    np.where(np.isfinite(answer.speed_a[i]), inputs.restitution, np.nan),
                    condition,
                    np.where(fits[i] & ~ended, answer.closing[i] / unit, np.nan),
                    one_of_many=condition * SETTLED > _FREE,
                    way=of_starts[i],
                )
            )
        roots += [
            root._replace(closing=np.where(there & ended, root.closing, np.nan))
            for root, there in found
            if np.any(ended)
        ]
        if not knows_speed:
            # Without friction knowns tell of the closing speed, and of the speeds with it only by
            # what tyres add, which may be the same over a range of them.
            scene.undetermined = scene.undetermined | np.equal(attempt.inputs.rule_value, 0.0)
        return attempt._replace(found=in_order(scene, roots, SETTLED))


def _with_friction(inputs: Inputs, friction: Any) -> Inputs:
    """The inputs with the friction that was found in place of an infinite one."""
    texts = {name: text for name, text in (inputs.given or {}).items() if name != FRICTION}
    return replace(inputs, rule_value=friction, given=texts or None)


def _together(looks: Sequence[_Looked], given: Any, balanced: bool) -> _Looked:
    """The roots that fit best of scenes with the same readings and each an impulse of its own.

    All roots where tyres are in the balance, as only with its own tyres each fits as it does.
    """
    if len(looks) == 1:
        return looks[0]
    scenes = [look.scene for look in looks if isinstance(look.scene, ComponentScene)]
    answered = [
        reduce(np.logical_or, (at for _, at in look.found), np.zeros(look.scene.shape, dtype=bool))
        for look in looks
    ]
    whole = together(scenes, answered)
    roots = [
        root._replace(
            closing=np.where(
                there & (balanced | (scene.misfit <= np.maximum(ROOT_TOL, whole.misfit))),
                root.closing,
                np.nan,
            ),
            way=np.full(whole.shape, float(i)),
        )
        for i, (look, scene) in enumerate(zip(looks, scenes, strict=True))
        for root, there in look.found
    ]
    shown = [look.friction for look in looks]
    frictions = [given if one is None else one for one in shown]
    one = next((one for one in shown if one is not None), None)
    return _Looked(whole, in_order(whole, roots), one, () if one is None else frictions)


def _with_function(scene: Scene, function: RestitutionOf) -> list[Root]:
    """Candidates where the restitution is a function of the closing speed: found on a grid of e,
    then refined.
    """
    count = math.prod(scene.shape)

    def difference(part: Scene, closing: Any, e: Any) -> Any:
        return function(np.ravel(part.speed_unit * closing + 0.0 * e)) - e

    def mismatch(e: Any, case: Any) -> list[Any]:
        part = scene.of(case, e)
        return [
            difference(part, part.observe(LAW, *pair).closing, e) for _, *pair in part.candidates()
        ]

    def slips(e: Any, case: Any) -> list[Any]:
        part = scene.of(case, e)
        return [part.any_slip_at(regime)[0] + 0.0 * e for regime in part.regimes()]

    found: list[Root] = []
    of_cases = crossings(mismatch, count, function.least)
    if of_cases:
        case, candidate, restitution = map(np.array, zip(*of_cases, strict=True))
        roots = np.stack(scene.of(case, restitution).roots(function))
        chosen = roots[candidate, :, np.arange(case.size)]
        # Of each case the first root, then the second and so on.
        rank = np.arange(case.size) - np.searchsorted(case, case)
        whole = np.full((rank.max() + 1, count, len(Root._fields)), np.nan)
        whole[rank, case] = chosen
        found = [Root._make(one.T.reshape(-1, *scene.shape)) for one in whole]
    undetermined = np.zeros(count, dtype=bool)
    if not scene.kinds[0].startswith("speed"):
        for at, row, e in crossings(slips, count, function.least):
            # Any slip goes with this restitution; it is an answer if the function gives it there.
            part = scene.of(np.array([at]), np.full(1, e))
            undetermined[at] |= (
                abs(difference(part, part.any_slip_at(part.regimes()[row])[1], e)[0]) <= REDUNDANT
            )
    scene.undetermined = undetermined.reshape(scene.shape)
    return found


def in_order(scene: Scene, roots: list[Root], met: float = 0.0) -> list[tuple[Root, Any]]:
    """The distinct roots that fit, by rising closing speed, and their cases in the batch.

    ``met`` is the share to which roots meet what is known; those of several searches for one root
    may differ by its condition times as much.
    """
    fitting = [root for root in roots if root is not NO_ROOT and np.any(root.closing > 0.0)]
    for root in fitting:
        scene.undetermined = scene.undetermined | ((root.closing > 0.0) & (root.one_of_many > 0.0))
    if not fitting or np.all(scene.undetermined | scene.ambiguous):
        return []
    if len(fitting) == 1 and scene.plain:
        return [(fitting[0], np.True_)]
    whole = _as_rows(fitting, scene.shape)
    open_cases = np.broadcast_to(scene.undetermined | scene.ambiguous, whole[:, _CLOSING].shape)
    whole[:, _CLOSING][open_cases] = np.nan
    whole, _ = _sorted(whole)
    speeds_a, speeds_b, _, condition, closing, *_ = np.moveaxis(whole, 1, 0)
    for i in range(1, len(closing)):
        # Others of the same closing speed may stand between two that are one.
        apart = abs(speeds_a[i] - speeds_a[:i]) + abs(speeds_b[i] - speeds_b[:i])
        # A condition may be infinite or not known, of roots that are right to rounding too.
        blur = np.full(apart.shape, ROOT_TOL)
        if met:
            blur = np.fmax(blur, np.fmin(met * condition[:i], _ONE_ROOT))
        again = (closing[:i] > 0.0) & (apart <= blur * closing[i])
        closing[i] = np.where(np.any(again, axis=0), np.nan, closing[i])
    return _as_found(_sorted(whole)[0])


def forwards(
    scene: Scene, found: list[tuple[Root, Any]]
) -> tuple[list[tuple[Root, Any]], list[Any]]:
    """Of roots in order those in which no vehicle goes backwards, and of each which of all roots
    of its case it is, counted from 0.
    """
    if not found:
        return [], []
    whole = _as_rows([root for root, _ in found], scene.shape)
    speeds_a, speeds_b, _, _, closing, *_ = np.moveaxis(whole, 1, 0)
    closing[np.minimum(speeds_a, speeds_b) < -ROOT_TOL * closing] = np.nan
    whole, order = _sorted(whole)
    ahead = _as_found(whole)
    return ahead, list(order[: len(ahead)])


def _as_rows(roots: Sequence[Root], shape: tuple[int, ...]) -> Any:
    """Roots as one array: of each its numbers, of each of these every case."""
    return np.array([[np.broadcast_to(part, shape) for part in root] for root in roots])


def _sorted(whole: Any) -> tuple[Any, Any]:
    """The roots by rising closing speed in every case, those left out last; and the order."""
    order = np.argsort(whole[:, _CLOSING], axis=0, kind="stable")
    return np.take_along_axis(whole, order[:, np.newaxis], axis=0), order


def _as_found(whole: Any) -> list[tuple[Root, Any]]:
    """Each root that some case has, and in which cases."""
    return [
        (Root(*root), there)
        for root, there in zip(whole, whole[:, _CLOSING] > 0.0, strict=True)
        if np.any(there)
    ]


def _best_of(misfit: Any, fits: Any) -> Any:
    """Of what was found from several starts, all that fit exactly, or else the one that fits
    best.
    """
    misfit = np.where(fits, misfit, np.inf)
    least = np.min(misfit, axis=0)
    best = np.arange(len(misfit)).reshape(-1, *[1] * np.ndim(least)) == np.argmin(misfit, axis=0)
    return fits & np.where(least <= ROOT_TOL, misfit <= ROOT_TOL, best)
