"""``recorded_pulse``: what the delta-V over time of an event data recorder says, with its error and
whether it ended.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

import numpy as np

from ..impact.recorded import read_place
from ..messages.errors import (
    InputError,
    MissingInputError,
    OutOfRangeWarning,
    ShapeError,
    SuspectUnitsWarning,
)
from ..messages.hints import hinted
from ..messages.warning import Note, warn
from ..quantities.attributes import Shown, derived, in_units_of, read_only
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.tables import Cells, Part, Summary, all_numbers, as_sentence
from ..quantities.units import Input, has_unit, shown, texts_of
from ..reference import RECORDER_ACCURACY, RECORDER_RANGE, RECORDER_RESOLUTION
from ..uncertainty import Censored, Normal, Uniform
from ..uncertainty.distribution import Statement, found_by
from .recorder_table import read_table

T = TypeVar("T", bound=Statement)
Polarity = Literal["49 CFR 563", "ISO 8855"]
# Sign of a positive lateral reading, counted to the left.
_LEFTWARD = {"49 CFR 563": -1.0, "ISO 8855": 1.0}
# 49 CFR 563.5: the event has ended when the resultant changes by no more than 0.8 km/h within 20
# ms.
_QUIET_CHANGE, _QUIET_TIME = 0.8 / 3.6, 0.020
# 563.7, Table I: the maximum is that up to 30 ms after the end of the event.
_BEYOND_THE_END = 0.030
# Cosine of an angle that is one direction of a vector of two readings with their errors.
_SAME_DIRECTION = math.cos(math.radians(30.0))
# A reading may be off by a step of the recorder.
_STEP = RECORDER_RESOLUTION.high * (1.0 + 1e-9)
_LONGEST = 3.0  # s; no contact of vehicles lasts longer
_NAMES = {"time": "s", "delta_v_forward": "m/s", "delta_v_left": "m/s"}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class RecordedPulse(Shown):
    """Recorded delta-V: its components at the largest resultant, when that was reached, and whether
    the pulse had ended.

    The errors are half the widths of the ranges that 49 CFR 563.8, Table III allows
    (``reference.RECORDER_ACCURACY``): a tenth of each component, and at least half the step in
    which it is reported. A record that stops before the pulse has ended is a lower bound: its
    components say how far delta-V had come. ``duration`` is the time from the last sample before
    delta-V begins to change, or from time 0 where the first sample is one step later and has some
    already, to the largest resultant. Up to time 0 a delta-V within the step of a recorder is not
    taken as change. ``time``, ``forward`` and ``left`` are the samples.
    ``place`` is where the recorder sits, ahead of the centre of mass and to its left, if that was
    given; all numbers are the readings there, which ``speeds(..., recorder_a=pulse.place)``
    carries over to the centre of mass.
    """

    _title = "Recorded pulse"

    delta_v_forward: float = field(metadata={"unit": "m/s"})
    delta_v_left: float | None = field(metadata={"unit": "m/s"})
    duration: float = field(metadata={"unit": "s"})
    ended: bool
    polarity: str
    time: Any = field(metadata={"unit": "s"})
    forward: Any = field(metadata={"unit": "m/s"})
    left: Any = field(metadata={"unit": "m/s"})
    place: tuple[float, float] | None = field(default=None, metadata={"unit": "m"})

    @derived("m/s")
    def delta_v(self) -> float:
        """The resultant [m/s]; the forward component alone if the recorder has no lateral one."""
        return math.hypot(self.delta_v_forward, self.delta_v_left or 0.0)

    @derived("rad")
    def pdof(self) -> float | None:
        """Principal direction of force [rad], 0 ahead, positive clockwise (from the right).

        It is opposite to the delta-V that was recorded, in which the tyres and the place of the
        recorder have their part. None without lateral delta-V, or without any.
        """
        if self.delta_v_left is None or self.delta_v == 0.0:
            return None
        return math.atan2(self.delta_v_left, -self.delta_v_forward)

    @derived("m/s")
    def error_forward(self) -> float:
        """Stated error of ``delta_v_forward`` [m/s], to either side."""
        return _error(self.delta_v_forward)

    @derived("m/s")
    def error_left(self) -> float | None:
        """Stated error of ``delta_v_left`` [m/s], to either side; None without lateral delta-V."""
        return None if self.delta_v_left is None else _error(self.delta_v_left)

    @derived()
    def evidence(self) -> tuple[Normal | Censored | None, Normal | Censored | None]:
        """Forward and left components as observations for ``posterior``, with errors.

        They are bounds if the pulse is cut short, and taken to go on growing from there. None
        stands for a component that was not recorded, and in a pulse cut short for one that does
        not grow: that is within its error of 0, so that it does not say to which side it went on,
        or that was greater before, or is less in a later sample.
        """
        at = _largest(self.time, self.forward, self.left)

        def of(name: str, part: Any) -> Normal | Censored | None:
            found = None if part is None else _evidence(part, at, self.ended)
            return None if found is None else self._with_notes(found, name, part)

        return of("forward", self.forward), of("left", self.left)

    @property
    def statements(self) -> tuple[str, ...]:
        """What has to be said beside the numbers: that the record stops early, that delta-V went on
        after the event had ended, and that a component goes beyond what recorders are asked to be
        exact for.
        """
        return tuple(self._statements(_in_kmh))

    def _statements(self, say: Callable[[float], str]) -> list[str]:
        said = [] if self.ended else [_cut(self.time, self.delta_v, say)]
        said += [_went_on(self.time, self.forward, self.left, say)]
        parts = {"forward": self.forward, "left": self.left}
        said += (
            _beyond(f"delta-V {name}", part, say)
            for name, part in parts.items()
            if part is not None
        )
        return [one for one in said if one]

    def _summary(self, numbers: Cells) -> Summary:
        values = {
            "delta-V": (self.delta_v, "m/s"),
            "delta-V forward": (self.delta_v_forward, "m/s"),
            "delta-V left": (self.delta_v_left, "m/s"),
            "PDOF": (self.pdof, "rad"),
            "duration": (self.duration, "s"),
            "ended": (self.ended, None),
            "recorded time": (self.time, "s"),
            "recorded forward": (self.forward, "m/s"),
            "recorded left": (self.left, "m/s"),
        }
        if self.place is not None:
            # The place is that from the centre of mass.
            values |= {
                "recorder ahead": (self.place[0], "m"),
                "recorder to the left": (self.place[1], "m"),
            }
        rows = {
            name: numbers.text(value, unit)
            for name, (value, unit) in values.items()
            if value is not None
        }
        for name, error in (
            ("delta-V forward", self.error_forward),
            ("delta-V left", self.error_left),
        ):
            if error is not None:
                rows[name] += f", within {numbers.text(error, 'm/s')}"
        parts = [Part(list(rows.items())), all_numbers(self._rows())]
        said = self._statements(lambda speed: numbers.text(speed, "m/s"))
        return Summary(self._title, parts, [*map(as_sentence, said)])

    def inputs(self, label: Literal["a", "b"]) -> dict[str, Any]:
        """The components with their errors, named as the arguments of ``reconstruct.speeds``, as
        inputs for ``propagate``.

        Parameters
        ----------
        label : {"a", "b"}
            The vehicle that had the recorder.

        Returns
        -------
        dict
            By argument, such as ``delta_v_forward_a``, a ``Uniform``; and ``recorder_a``, the place
            of the recorder, if it was given.

        Raises
        ------
        InputError
            The record stops early (code ``pulse_cut``): a lower bound has no range about it. See
            ``evidence``.
        """
        if not isinstance(label, str) or label not in ("a", "b"):
            raise must_be("label", "'a' or 'b'", label, code="bad_option")
        if not self.ended:
            cut = _cut(self.time, self.delta_v)
            raise InputError(
                f"{cut}, and no range can be stated of it; give .evidence to "
                "`reconstruct.posterior`, which takes it as a bound",
                code="pulse_cut",
            )
        parts = {
            "forward": (self.delta_v_forward, self.forward),
            "left": (self.delta_v_left, self.left),
        }
        found: dict[str, Any] = {
            f"delta_v_{part}_{label}": self._with_notes(
                Uniform(value - _error(value), value + _error(value)), part, samples
            )
            for part, (value, samples) in parts.items()
            if value is not None
        }
        return found if self.place is None else found | {f"recorder_{label}": self.place}

    def _with_notes(self, reading: T, name: str, part: Any) -> T:
        """The reading with what a study of it has to state."""
        said = {
            "went_on": _went_on(self.time, self.forward, self.left),
            "beyond_recorder": _beyond(f"delta-V {name}", part),
        }
        notes = [Note(OutOfRangeWarning, text, code=code) for code, text in said.items() if text]
        return found_by("the recorder", {name: reading}, notes)[name] if notes else reading


@hinted
def recorded_pulse(
    time: Input | os.PathLike[str],
    delta_v_forward: Input | None = None,
    delta_v_left: Input | None = None,
    *,
    polarity: Polarity,
    forward: Input | None = None,
    left: Input | None = None,
) -> RecordedPulse:
    """Total delta-V of a recorder's pulse, when it was reached, its direction, and whether the
    pulse had ended.

    The total is the largest resultant (maximum delta-V of 49 CFR 563.5). The pulse has ended if
    there are 20 ms, up to that maximum or later, in which the resultant changes by no more than 0.8
    km/h (end of event time, ibid.). In a car that turns, a recorder away from the centre of mass
    reads another delta-V than that of the centre: give its place, which is kept with the readings.

    Parameters
    ----------
    time : array [s], or path of a CSV file
        Times of the samples, increasing. Or a file whose first row has the heads of the columns,
        each with its unit in round or square brackets: ``time [ms],longitudinal [km/h],lateral
        [km/h]``, or as reports write them, ``Time (msec)``, ``"Delta-V, lateral (MPH)"``. The
        columns are found by their heads, in any order. A head is refused if it may be two of them,
        or none, names a side or a standard (SAE, ISO) that contradicts ``polarity``, or has any
        word that is not known to belong to time or cumulative delta-V. Commas, semicolons or tabs
        separate the columns; with the last two, numbers may have decimal commas, and a mark
        before three digits that may be one of thousands is refused. A cell of ``SNA`` is not
        available: in all of the lateral column, or in the last rows, which are left out.
    delta_v_forward, delta_v_left : array [m/s], optional
        Cumulative delta-V at these times; left out with a file. The lateral one may be missing.
    polarity : {"49 CFR 563", "ISO 8855"}
        Whether lateral readings are positive from left to right, as in US recorders, or to the
        left, as in this library. Forward is positive in both. There is no default: the wrong sign
        puts the other car on the other side.
    forward, left : float, str or Quantity [m], optional
        Where the recorder sits: how far ahead of the centre of mass (negative behind it), and how
        far to its left. Both or neither; without them nothing is known of its place.

    Returns
    -------
    RecordedPulse
        With the signs of this library.

    Raises
    ------
    InputError
        An argument or a file that cannot be used, or delta-V that is not 0 when the event begins:
        samples up to time 0 may be off by the step of a recorder, 1 km/h, where they do not lead on
        to more. Where the first is later and has some delta-V, more than one step after time 0.

    Warns
    -----
    OutOfRangeWarning
        The record stops early (code ``pulse_cut``); delta-V went on by more than its stated error
        later than 30 ms after the first 20 ms in which it hardly changed, as by braking or another
        impact (``went_on``); or a component exceeds the 100 km/h over which 49 CFR 563 demands
        accuracy (``reference.RECORDER_RANGE``; code ``beyond_recorder``).
    SuspectUnitsWarning
        Such a component without a unit: perhaps km/h or an acceleration.

    Examples
    --------
    >>> import numpy as np
    >>> time = np.arange(0.0, 0.26, 0.01)
    >>> shape = np.clip(time / 0.11, 0.0, 1.0)
    >>> pulse = recorded_pulse(time, -8.0 * shape, 1.5 * shape, polarity="49 CFR 563")
    >>> (
    ...     pulse.delta_v_forward,
    ...     pulse.delta_v_left,
    ...     pulse.ended,
    ...     round(pulse.duration, 3),
    ...     round(pulse.error_forward, 3),
    ... )
    (-8.0, -1.5, True, 0.11, 0.8)
    """
    reader = ArgumentReader()
    given: dict[str, Any] = {}
    if not isinstance(polarity, str) or polarity not in _LEFTWARD:
        text = (
            "polarity must be '49 CFR 563' (lateral positive to the right) or 'ISO 8855' (to "
            f"the left), got {shown(polarity)}"
        )
        reader.refuse(
            InputError(
                f"{text}; the recorder's report says which", code="bad_option", argument="polarity"
            )
        )
    if isinstance(time, (str, os.PathLike)):
        for name, beside in (("delta_v_forward", delta_v_forward), ("delta_v_left", delta_v_left)):
            if beside is not None:
                file = shown(os.fspath(time))
                text = f"{name} stands beside the file {file}, which has it; leave one of them out"
                reader.refuse(InputError(text, code="bad_option", argument=name))
        reader.close()
        read = read_table(reader, os.fspath(time), polarity)
    else:
        given = {"time": time, "delta_v_forward": delta_v_forward, "delta_v_left": delta_v_left}
        read = {
            name: reader.number(value, _NAMES[name], name)
            for name, value in given.items()
            if value is not None
        }
    place = _read_place(reader, forward, left)
    reader.close()
    shapes = {name: np.shape(value) for name, value in read.items()}
    # Lateral readings alone would else stand where those ahead do.
    missing = [name for name in ("time", "delta_v_forward") if name not in shapes]
    if (
        missing
        or len(set(shapes.values())) > 1
        or len(shapes["time"]) != 1
        or shapes["time"][0] < 2
    ):
        got = [f"no {name}" for name in missing]
        got += [f"{name} {shape}" for name, shape in shapes.items()]
        raise ShapeError(
            "a pulse is time, delta_v_forward and perhaps delta_v_left as arrays of one length, "
            f"two samples at least; got {', '.join(got)}",
            code="bad_shape",
            argument=missing[0] if missing else "time",
        )
    samples = {name: np.array(value, dtype=np.float64) + 0.0 for name, value in read.items()}
    times, ahead = samples["time"], samples["delta_v_forward"]
    aside = (
        _LEFTWARD[polarity] * samples["delta_v_left"] + 0.0 if "delta_v_left" in samples else None
    )
    size = _resultant(ahead, aside)
    if not (
        np.isfinite(size).all()
        and np.all(np.diff(times) > 0.0)
        and times[-1] - times[0] <= _LONGEST
    ):
        raise InputError(
            f"time must rise from sample to sample, by {_LONGEST:g} s in all at most (were "
            "milliseconds meant?), and every value be a finite number",
            code="bad_pulse",
            argument="time",
        )
    parts = {"delta_v_forward": ahead} | ({} if aside is None else {"delta_v_left": aside})
    if times[0] <= 0.0:
        for name, part in parts.items():
            _need_start_at_zero(name, part, times[0])
        _need_none_before(times, parts)
    for name, part in parts.items():
        _warn_if_beyond(name, part, name in given and not has_unit(given[name]))
    at, begin = _largest(times, ahead, aside), _begin(times, parts)
    ended = _ended(times, size, at)
    if not ended:
        warn(OutOfRangeWarning(_cut(times, size[at]), code="pulse_cut"))
    if went_on := _went_on(times, ahead, aside):
        warn(OutOfRangeWarning(went_on, code="went_on"))
    found = RecordedPulse(
        delta_v_forward=float(ahead[at]),
        delta_v_left=None if aside is None else float(aside[at]),
        duration=float(times[at] - begin),
        ended=ended,
        polarity=polarity,
        time=read_only(times),
        forward=read_only(ahead),
        left=read_only(aside),
        place=place,
    )
    return in_units_of(found, texts_of(reader.texts))


def _read_place(reader: ArgumentReader, forward: Any, left: Any) -> tuple[float, float] | None:
    """Where the recorder sits relative to the centre of mass; None where that was not given."""
    given = {"forward": forward, "left": left}
    if forward is left is None:
        return None
    for name, value in given.items():
        if value is None:
            text = (
                f"{name} `|is None|is not given`, and the place of a recorder needs both; "
                f"write `{name}=0` for one in line with the centre of mass"
            )
            reader.refuse(MissingInputError(text, code="missing_place", argument=name))
            return None
    place = read_place(reader, (forward, left))
    for name, part in zip(given, place, strict=True):
        if np.ndim(part):
            text = f"{name} is that of one recorder, so one number, got {shown(given[name])}"
            reader.refuse(ShapeError(text, code="bad_shape", argument=name))
    return place


def _need_start_at_zero(name: str, part: Any, time: float) -> None:
    """Refuse cumulative delta-V that is not 0 when the event begins, to a step of a recorder."""
    if abs(part[0]) <= _STEP:
        return
    at = "time 0" if time == 0.0 else f"{time:.3g} s, before time 0"
    raise InputError(
        f"{name} begins with {3.6 * part[0]:.3g} km/h at {at}, and delta-V counts from 0 when the "
        "event begins; give delta-V and not a speed or an acceleration, and where the recorder has "
        "an offset, take its first value off every sample",
        code="bad_pulse",
        argument=name,
    )


def _need_none_before(times: Any, parts: Mapping[str, Any]) -> None:
    """Refuse delta-V before time 0 of which there is none left at time 0, to a step of a
    recorder.
    """
    early = int(np.count_nonzero(times <= 0.0))
    sizes = {name: abs(part[:early]) for name, part in parts.items()}
    if any(size[-1] > _STEP for size in sizes.values()):
        return
    for name, size in sizes.items():
        if size.max() > _STEP:
            at = int(np.argmax(size))
            raise InputError(
                f"{name} is {3.6 * parts[name][at]:.3g} km/h at {times[at]:.3g} s, before time 0, "
                f"and {3.6 * parts[name][early - 1]:.3g} km/h at {times[early - 1]:.3g} s, and "
                "delta-V counts from 0 when the event begins; leave out the samples of another "
                "event, or of what the recorder counted before this one",
                code="bad_pulse",
                argument=name,
            )


def _in_kmh(speed: float) -> str:
    return f"{3.6 * speed:.4g} km/h"


def _beyond(name: str, part: Any, say: Callable[[float], str] = _in_kmh) -> str:
    """That a component goes beyond what recorders are asked to be exact for; "" if it does not."""
    worst = float(part[np.argmax(abs(part))])
    if abs(worst) <= RECORDER_RANGE.high * (1.0 + 1e-9):
        return ""
    return (
        f"{name} goes to {say(worst)}, and 49 CFR 563 asks recorders to be exact to "
        f"{say(RECORDER_RANGE.high)}: its error may be larger than what is stated of it"
    )


def _warn_if_beyond(name: str, part: Any, bare: bool) -> None:
    """Warn of a component beyond what recorders are asked to be exact for."""
    if not (beyond := _beyond(name, part)):
        return
    worst = float(part[np.argmax(abs(part))])
    text = beyond.partition(":")[0]
    if bare:
        meant = f'{name}=pint.Quantity(values, "km/h")'
        text = f"{text}: its numbers are read as m/s; if another unit was meant, write `{meant}`"
        warn(SuspectUnitsWarning(text, code="suspect_units", argument=name, value=worst))
    else:
        text = f"{text}: check its unit, and whether it is delta-V; its error may be larger"
        warn(OutOfRangeWarning(text, code="beyond_recorder", argument=name, value=worst))


def _resultant(forward: Any, left: Any) -> Any:
    return np.hypot(forward, 0.0 if left is None else left)


def _error(value: float) -> float:
    return max(RECORDER_ACCURACY.high * abs(value), 0.5 * RECORDER_RESOLUTION.high)


def _evidence(samples: Any, at: int, ended: bool) -> Normal | Censored | None:
    """The reading at the largest resultant with the standard deviation of its range; a bound where
    the record stops early while it grows.
    """
    value = float(samples[at])
    error = _error(value) / math.sqrt(3.0)
    if ended:
        return Normal(value, error)
    along = math.copysign(1.0, value) * samples
    # Any noise counts: a component that is left out is safer than a bound that does not hold.
    turned = np.any(abs(samples[:at]) > abs(value)) or np.any(along[at:] < along[at])
    if abs(value) <= _error(value) or turned:
        return None
    return Censored(low=value, error=error) if value > 0.0 else Censored(high=value, error=error)


def _cut(times: Any, size: float, say: Callable[[float], str] = _in_kmh) -> str:
    return (
        f"the record stops at {times[-1]:.3g} s while delta-V still changes: {say(size)} is a "
        "lower bound"
    )


def _went_on(times: Any, forward: Any, left: Any, say: Callable[[float], str] = _in_kmh) -> str:
    """That the largest resultant comes after the end of the event, and differs from the largest
    until then by more than its stated error; "" if it does not.
    """
    size, at = _resultant(forward, left), _largest(times, forward, left)
    since = np.interp(times - _QUIET_TIME, times, size)
    # Before it has come to more than a step of the recorder, the event has not begun.
    quiet = (since > _STEP) & (abs(size - since) <= _QUIET_CHANGE + 1e-12)
    quiet &= times - _QUIET_TIME >= times[0] - 1e-9
    if not quiet.any():
        return ""
    end = times[np.argmax(quiet)]
    until = int(np.argmax(np.where(times <= end + _BEYOND_THE_END + 1e-9, size, -1.0)))
    parts = [forward] if left is None else [forward, left]
    apart = math.hypot(*(part[at] - part[until] for part in parts))
    if times[at] <= times[until] or apart <= _error(size[at]):
        return ""
    then = int(np.argmax(quiet))
    along = sum(float(part[at]) * float(part[then]) for part in parts)
    turned = along < _SAME_DIRECTION * size[at] * size[then]
    where = ", in another direction," if turned else ""
    return (
        f"by 49 CFR 563 the event had ended at {end:.3g} s, with {say(size[then])}, and delta-V "
        f"went on to {say(size[at])}{where} at {times[at]:.3g} s: braking or another impact may be "
        "in it; if it is, leave out the samples after the end"
    )


def _largest(times: Any, forward: Any, left: Any) -> int:
    """The sample with the largest resultant, from that on before which delta-V begins to change."""
    begin = _last_still(times, [forward] if left is None else [forward, left])
    return begin + int(np.argmax(_resultant(forward, left)[begin:]))


def _last_still(times: Any, parts: Sequence[Any]) -> int:
    """The last sample before delta-V begins to change, the first where it never does.

    Up to time 0 what is within a step of a recorder is no change. Where there is more by then, the
    record counts from elsewhere, and delta-V begins where it was last none, or what it was at
    first.
    """
    early = int(np.count_nonzero(times <= 0.0))
    small = np.all([abs(part) <= _STEP for part in parts], axis=0)
    still = max(early - 1, 0)
    if not small[:early].all():
        few = small[: max(int(np.argmin(small)), 1)]
        none = [(part[: len(few)] == 0.0) | (part[: len(few)] == part[0]) for part in parts]
        still = int(np.flatnonzero(np.all(none, axis=0))[-1])
    changed = np.any([part[still:] != part[still] for part in parts], axis=0)
    return still + max(int(np.argmax(changed)) - 1, 0)


def _begin(times: Any, parts: Mapping[str, Any]) -> float:
    """When delta-V begins to change, or time 0, from which it counts, where the first sample is
    later and has some.
    """
    last = _last_still(times, [*parts.values()])
    first = max(abs(part[0]) for part in parts.values())
    # An offset of a recorder stays as it is for some samples.
    offset = last > 0 and first <= _STEP
    if times[0] <= 0.0 or first == 0.0 or offset:
        return float(times[last])
    if times[0] > (times[1] - times[0]) * (1.0 + 1e-9):
        name = next(name for name, part in parts.items() if part[0])
        raise InputError(
            f"{name} begins with {3.6 * parts[name][0]:.3g} km/h at {times[0]:.3g} s, and the "
            "samples before it are not there; delta-V counts from 0 at time 0, when the event "
            "begins: give all samples, or that of time 0",
            code="bad_pulse",
            argument=name,
        )
    return 0.0


def _ended(times: Any, size: Any, at: int) -> bool:
    """Whether within some 20 ms that end at the largest resultant, or later, it changes by no more
    than 0.8 km/h.
    """
    ends = times[at:][times[at:] - _QUIET_TIME >= times[0] - 1e-9]
    changes = abs(np.interp(ends, times, size) - np.interp(ends - _QUIET_TIME, times, size))
    return bool(np.any(changes <= _QUIET_CHANGE + 1e-12))
