"""``Propagation``: the outputs of a study, what its inputs were stated to be, and what has to be
said of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..messages.errors import InputError
from ..messages.warning import Note
from ..quantities.strict_json import strict
from ..quantities.tables import (
    Cells,
    Part,
    Summarized,
    Summary,
    all_numbers,
    as_sentence,
    given_texts,
)
from ..quantities.units import rendered, shown
from .halved import Halved
from .output import Output, bare_notes, outputs_part
from .probability import holds
from .sampled import Sampled, correlations


@dataclass(eq=False, repr=False)
class Propagation(Summarized):
    """The outputs of a model given the stated inputs; ``result["delta_v"]`` is one of them.

    Attributes
    ----------
    method : str
        The method that was used.
    inputs : dict
        What was stated: distributions, intervals, and fixed values.
    samples : int
        Number of cases the model was called with.
    failed : int
        Number of cases without an answer for at least one output, for example because there was no
        impact. The figures leave them out, and hold given that there is an answer.
    seed : int or None
        The seed that reproduces the result to the bit; None where nothing was drawn.
    interrupted : bool
        Whether the run was stopped before its end; the figures are then those of the cases done.
    notes : tuple
        What ``statements`` say, each with the warning it is, if any, its ``code``, and the number
        and share of the cases.
    calls : dict
        With a finer model, how many cases were asked of "model" and of "finer"; empty without.
    scatter : dict
        With a finer model, by output, the standard deviation of what its correction does not
        foresee, in cross-validation.
    """

    method: str
    inputs: dict[str, Any]
    outputs: dict[str, Output]
    samples: int
    failed: int
    seed: int | None = None
    interrupted: bool = False
    notes: tuple[Note, ...] = ()
    calls: dict[str, int] = field(default_factory=dict)
    scatter: dict[str, float] = field(default_factory=dict)
    # The share without an answer of the cases drawn from the inputs or searched between bounds:
    # ``samples`` counts those for derivatives too, which all have one.
    _unanswered: float = math.nan
    _run_halved: Callable[[], Halved] | None = None
    _halved: Halved | None = None

    def __post_init__(self) -> None:
        for output in self.outputs.values():
            output.texts = tuple(given_texts(self))

    def __getstate__(self) -> dict[str, Any]:
        # Without what would run the user's model again, which a pickle cannot hold.
        return {**self.__dict__, "_run_halved": None}

    def __getitem__(self, name: str) -> Output:
        if not isinstance(name, str) or name not in self.outputs:
            raise InputError(
                f"there is no output {shown(name)}; the model returned {', '.join(self.outputs)}",
                code="no_output",
                argument="name",
            )
        return self.outputs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.outputs)

    def __len__(self) -> int:
        return len(self.outputs)

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """Correlation of every pair of outputs, over the cases with an answer for both; NaN where
        one of them does not vary, or is known from one side only in some of these. Only after
        sampling.
        """
        return correlations(
            {name: output for name, output in self.outputs.items() if isinstance(output, Sampled)}
        )

    def probability(self, condition: Callable[[Mapping[str, Any]], Any]) -> tuple[float, float]:
        """The probability that a condition on several outputs holds, and its standard error; only
        after sampling.

        Parameters
        ----------
        condition : function
            Called with a dict of arrays, one number per sample: the outputs by name, each in its
            unit, SI where the model returned Quantities; directions from -pi to pi. Returns one
            boolean per sample. Samples without an answer to an output that it reads are left out.

        Returns
        -------
        probability, standard_error : float [-]
            Between 0 and 1. If the condition holds in no sample or in every one, the error is 1
            over their number.

        Raises
        ------
        InputError
            A condition that does not return a boolean for every sample (code "bad_condition"), or
            that samples known from one side only leave open (code "one_sided"); or nothing was
            sampled, or an ``Interval`` is among the inputs (code "not_sampled").
        NoSolutionError
            No sample has an answer to all outputs that the condition reads.

        Examples
        --------
        Which of two cars was the faster one, from the lengths of their skids:

        >>> from collisions import travel
        >>> from collisions.uncertainty import Normal, Uniform, propagate
        >>> def skids(drag, length_a, length_b):
        ...     speed_a, speed_b = (travel.speed(x, drag=drag) for x in (length_a, length_b))
        ...     return {"speed_a": speed_a, "speed_b": speed_b}
        >>> lengths = {"length_a": Normal("31 m", "1 m"), "length_b": Normal("30 m", "1 m")}
        >>> found = propagate(skids, {"drag": Uniform(0.6, 0.8)} | lengths, seed=1)
        >>> chance, error = found.probability(lambda at: at["speed_a"] > at["speed_b"])
        >>> round(chance, 2), error < 0.01
        (0.76, True)
        """
        samples = {name: one for name, one in self.outputs.items() if isinstance(one, Sampled)}
        for name, output in self.outputs.items():
            if name not in samples:
                return output.probability(condition)
        sides = {name: one._sides for name, one in samples.items() if one._sides is not None}
        held = holds(
            condition, {name: one._asked_of(one.values) for name, one in samples.items()}, sides
        )

        def again(values: Callable[[Any], Any]) -> Any:
            columns = {name: one._asked_of(values(one)) for name, one in samples.items()}
            return holds(condition, columns)

        return next(iter(samples.values()))._share(held, again)

    def if_halved(self) -> Halved:
        """What to measure next: how wide the range of every output would be if the error of one
        input were halved.

        The model is run once more for each uncertain input, by the same method and with the same
        draws, at most 8,192, with each value of that input moved halfway to its mean; of an
        ``Interval``, halfway to its middle. Two measurements that agree with what is stated leave
        seven tenths of an error, four leave half. Where the better measurement would itself lie
        off the mean the range moves with it, and in a model that bends may become somewhat wider
        or narrower than stated here. The answer is kept, so a second call costs nothing. What is
        warned of these runs is not raised, but stands in ``statements`` and below the table.

        Returns
        -------
        Halved
            By input, the width of each output's 95 percent range [unit of the output]; by
            ``method="interval"``, of the whole range. And the share of the cases without an answer
            in each row, which the widths leave out.

        Raises
        ------
        InputError
            The propagation comes from a pickle, which does not hold the model (code "no_model").

        Examples
        --------
        >>> from collisions import travel
        >>> from collisions.uncertainty import Normal, propagate
        >>> found = propagate(
        ...     lambda drag, skid: {"speed": travel.speed(skid, drag=drag)},
        ...     {"drag": Normal(0.7, 0.05), "skid": Normal("25 m", "0.5 m")},
        ...     method="first_order",
        ... )
        >>> widths = found.if_halved()
        >>> round(widths.now["speed"], 2)
        2.69
        >>> {name: round(widths[name]["speed"], 2) for name in widths}
        {'drag': 1.49, 'skid': 2.62}
        """
        if self._halved is None:
            if self._run_halved is None:
                raise InputError(
                    "this propagation comes from a pickle, which does not hold its model, and what "
                    "half an error leaves takes new runs of it; call if_halved() before it is "
                    "pickled, or propagate again",
                    code="no_model",
                )
            self._halved = self._run_halved()
        return self._halved

    @property
    def statements(self) -> tuple[str, ...]:
        """What belongs with the figures, as sentences: every warning that this library gave while
        the model worked, by how many cases, and what is to be said of the method. What is warned of
        in fewer than 0.5 percent of the cases (95 percent where it is that readings differ) stands
        here alone and is not raised; that cases have no answer is raised of any. What a study
        within the model states is here too. Other warnings that the model gives are not here.
        """
        return tuple(note.statement for note in self.notes)

    def to_dict(self) -> dict[str, Any]:
        """Figures of all outputs and the inputs they are given, as nested plain values that strict
        JSON can hold.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        return {
            "method": self.method,
            "inputs": {name: rendered(value, 1000) for name, value in self.inputs.items()},
            "samples": self.samples,
            "failed": self.failed,
            "seed": self.seed,
            "interrupted": self.interrupted,
            "calls": dict(self.calls),
            "scatter": strict(self.scatter),
            "statements": list(self.statements),
            "outputs": {name: output.record() for name, output in self.outputs.items()},
        }

    def __repr__(self) -> str:
        lines = "\n".join(f"  {name}: {text}" for name, text in self._rows())
        cases = f"{self.samples} cases, {self.failed} without an answer"
        return f"<Propagation by {self.method}, {cases}; given the stated inputs\n{lines}>"

    def __str__(self) -> str:
        return str(self.summary())

    def _summary(self, numbers: Cells) -> Summary:
        title = (
            f"Given the stated inputs ({self.method}, {self.samples} cases, {self.failed} "
            "without an answer)"
        )
        stated = Part(
            [(name, str(value)) for name, value in self.inputs.items()], "Inputs as stated"
        )
        parts = [outputs_part(self.outputs, numbers), stated, all_numbers(self._rows())]
        return Summary(
            title, parts, [*map(as_sentence, self.statements), *bare_notes(self.outputs.values())]
        )

    def _texts(self) -> Iterator[str]:
        return units_of(self.inputs)

    def _rows(self) -> Iterator[tuple[str, str]]:
        return (output.row() for output in self.outputs.values())


def units_of(stated: Mapping[str, Any]) -> Iterator[str]:
    """The units that inputs were given in, each as a text."""
    return (
        f"1 {value.unit.written}"
        for value in stated.values()
        if hasattr(getattr(value, "unit", ""), "written")
    )
