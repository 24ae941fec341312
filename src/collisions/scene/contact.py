"""``Contact``: what happens when two vehicles of a scene meet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Literal, TypeAlias

from ..impact.inputs import Law, one_rule
from ..kernels.contact_laws import BRACH, FRICTION, LAWS, RULES
from ..kernels.elementwise import FINITE, Domain, restitution_domain
from ..messages.errors import InputError, MissingInputError
from ..messages.hints import hinted
from ..quantities.attributes import Shown, read_only, texts_given
from ..quantities.directions import direction
from ..quantities.reading import ArgumentReader, at_least_zero
from ..quantities.refusals import must_be, one_of, yes_or_no
from ..quantities.settings import Default, in_si
from ..quantities.units import Input, Pair, Texts, Value, shown, texts_of
from ..vehicle.drag import one_value, read_duration
from ..vehicle.tyres import Tyres, not_tyres

TOUCH = "touch"
USUAL_DELAY = Default(0.03)
"""After first touch [s], where neither a depth nor a delay is given."""
Plane: TypeAlias = Literal["face", "crossings"]
ContactModel: TypeAlias = Literal[
    "linear_central", "oblique_central", "eccentric", "time_resolved", "solve"
]
PLANES, MODELS = (
    ("face", "crossings"),
    ("linear_central", "oblique_central", "eccentric", "time_resolved", "solve"),
)
IN_TIME = "time_resolved"
NO_POINT = ("linear_central", "oblique_central")


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Contact(Shown):
    """What happens when two vehicles of a scene meet: a rule, applied at a time or at every touch.

    The normal and the point are given, or come from the outlines. With the plane "face" the normal
    is that of the face struck at first touch (of the two edges at a corner the one whose overlap
    stays least), and turns with its vehicle; the point is the centroid of the overlap at a
    ``depth`` along that normal, or ``delay`` after first touch. A pair that parts before is taken
    at its deepest. With "crossings" the plane goes through the two points where the outlines cross.
    Meanwhile both vehicles move on as if nothing held them.

    A pair is one contact until its outlines were 0.05 m apart. When it then touches again at 1 m/s
    or more, a rule at "touch" is applied again; so it is where another impact drives one of them
    into the other at once. How fast they close is how fast the gap between the outlines does
    where they touch; of a face against a face, the greatest over the stretch in which they overlap.

    Parameters
    ----------
    a, b : str
        The names of the two vehicles.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution along the normal, 0 to 1.
    normal : angle [rad] or tuple (nx, ny), optional
        Direction from A into B in the scene. From the outlines if not given; of a contact at a time
        too by the face struck at first touch, to which both came straight on where they overlap
        from the start.
    point : pair [m], optional
        Scene point at which the impulse acts, with ``normal``. From the outlines if not given: of a
        contact at a time from their overlap then, at bare first touch the corner that touches. It
        lies in an outline, or no more than 0.5 m outside of the nearer one. The central models have
        none.
    at : float, str, Quantity or array [s], or "touch"
        When: a time, 0 where the states are given, at which outlines have to touch, or be within
        0.5 m of each other where normal and point are given; or whenever the outlines meet and
        close by 0.02 m/s or more.
    depth : float, str, Quantity or array [m], optional
        Overlap at which the impulse acts, however long after first touch: along the normal of the
        face struck at first touch, with the plane "crossings" too, whose own normal is another; or
        along ``normal`` where that is given. Where the two part before, or stop, it acts at their
        deepest; where neither comes within 1,000 s it is refused.
    delay : float, str, Quantity or array [s], optional
        Time from first touch to the impulse, 0.03 s if no depth is given.
    plane : {"face", "crossings"}, optional
        How normal and point come from the outlines.
    model : {"linear_central", "oblique_central", "eccentric", "time_resolved", "solve"}, optional
        The solver. If not given it is ``time_resolved`` with a ``duration``, else ``eccentric``.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts. ``time_resolved`` follows it from first touch, or, at time 0,
        about the maximum engagement at which the states are; the vehicles go on from where it
        leaves them, and one that touches another meanwhile strikes it when the contact has ended.
        With the model "eccentric" it is for the impulse of the tyres; the vehicles then move on by
        the velocities after it until it has passed, and from there on their tyres: that is the
        duration, and at time 0 half of it, as the states there are those of maximum engagement,
        with half of the contact before them. Tyres of a vehicle whose earlier contact has not
        passed act for the rest only, which is a finding. "solve" takes the least model that is near
        enough. Where a contact in time is among the models, it decides at first touch whether that
        is required, and if so the contact begins there; else it decides among all of them where the
        impulse acts. A central model has nothing of the tyres, which act all the while. Tyres have
        the friction of the surface that the vehicle stands on, or the mean of several, which is a
        finding. A drag of a vehicle, in place of tyres, does not act meanwhile, which is a finding
        too.
    tolerance : float, str, Quantity or array [m/s], optional
        With the model "solve", the largest error that is accepted.
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [-], optional
        Exactly one of these, as for ``eccentric``; none with "linear_central", and ``friction``
        with "time_resolved".
    law : {"brach", "kudlich-slibar", "stronge"}, optional
        As for ``eccentric``; "time_resolved" has a law of its own, and "linear_central" none.
    incomplete : bool, optional
        As for ``eccentric``.
    tyres_after : dict of travel.Tyres, optional
        By name, the wheels of a vehicle after this contact, as where damage locks them. Marks are
        theirs from the beginning of the contact on, its impulse is of the wheels before.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.

    Examples
    --------
    >>> from collisions.scene import Contact
    >>> Contact("Camry", "Civic", restitution=0.1, friction=0.5, at="touch").at
    'touch'
    """

    _title = "Contact"

    a: str
    b: str
    restitution: Value = field(metadata={"unit": ""})
    normal: tuple[Value, Value] | None = field(metadata={"unit": ""})
    point: tuple[Value, Value] | None = field(metadata={"unit": "m"})
    at: Value | str = field(metadata={"unit": "s"})
    depth: Value | None = field(metadata={"unit": "m"})
    delay: Value | None = field(metadata={"unit": "s"})
    plane: str
    model: str
    duration: Value | None = field(metadata={"unit": "s"})
    tolerance: Value | None = field(metadata={"unit": "m/s"})
    friction: Value | None = field(metadata={"unit": ""})
    impulse_ratio: Value | None = field(metadata={"unit": ""})
    critical_fraction: Value | None = field(metadata={"unit": ""})
    law: str
    incomplete: bool
    tyres_after: Mapping[str, Tyres]

    @hinted
    def __init__(
        self,
        a: str,
        b: str,
        *,
        restitution: Input,
        normal: Input | Pair | None = None,
        point: Pair | None = None,
        at: Input = 0.0,
        depth: Input | None = None,
        delay: Input | None = None,
        plane: Plane = "face",
        model: ContactModel | None = None,
        duration: Input | None = None,
        tolerance: Input | None = None,
        friction: Input | None = None,
        impulse_ratio: Input | None = None,
        critical_fraction: Input | None = None,
        law: Law = "brach",
        incomplete: bool = False,
        tyres_after: Mapping[str, Tyres] | None = None,
    ) -> None:
        reader = ArgumentReader()
        for label, name in (("a", a), ("b", b)):
            if not isinstance(name, str) or not name:
                text = f"{label} must be the name of a vehicle of the scene, got {shown(name)}"
                reader.refuse(InputError(text, code="not_a_text", argument=label))
        if isinstance(a, str) and isinstance(b, str) and a == b:
            text = f"a and b are both {a!r}; a contact is between two vehicles"
            reader.refuse(InputError(text, code="bad_combination", argument="b"))
        found: dict[str, Any] = {"a": a, "b": b, "plane": plane, "law": law}
        found["incomplete"] = incomplete
        for name, choices in (("plane", PLANES), ("model", MODELS), ("law", tuple(LAWS))):
            option = {"plane": plane, "model": model, "law": law}[name]
            if not (option is None and name == "model") and not (
                isinstance(option, str) and option in choices
            ):
                listed = f"one of {', '.join(choices)}"
                reader.refuse(must_be(name, listed, option, code="bad_option"))
        if not isinstance(incomplete, bool):
            reader.refuse(yes_or_no("incomplete", incomplete, code="bad_option"))
        instant = "eccentric" if duration is None else IN_TIME
        found["model"] = instant if model is None else model
        found["restitution"] = one_value(
            reader, restitution, "", "restitution", restitution_domain(incomplete is True)
        )
        found["normal"] = None if normal is None else direction(reader, normal, "normal")
        found["point"] = None if point is None else reader.pair(point, "m", "point")
        found["at"] = at if isinstance(at, str) and at == TOUCH else _time(reader, at)
        found["depth"] = _length(reader, depth)
        found["delay"] = _delay(reader, delay)
        found["duration"] = None if duration is None else read_duration(reader, duration)
        found["tolerance"] = tolerance
        if tolerance is not None:
            value = one_value(reader, tolerance, "m/s", "tolerance")
            found["tolerance"] = at_least_zero(
                reader, value, tolerance, "tolerance", "negative_speed", "it bounds an error"
            )
        rules = dict(zip(RULES, (friction, impulse_ratio, critical_fraction), strict=True))
        for name, value in rules.items():
            domain: Domain = RULES[name].domain
            found[name] = None if value is None else one_value(reader, value, "", name, domain)
        found["tyres_after"] = _tyres_after(reader, tyres_after, (a, b))
        _check(reader, found, rules)
        reader.close()
        texts = Texts(
            {key: text for key, text in reader.texts.items() if not key.startswith("normal[")}
        )
        texts.units = reader.texts.units
        for name in NAMES:
            object.__setattr__(self, name, read_only(found[name]))
        object.__setattr__(self, "_inputs_as_texts", texts)

    def replace(self, **changes: Any) -> Contact:
        """The contact with some of the arguments changed.

        Parameters
        ----------
        **changes : see ``Contact``
            Arguments of ``Contact`` by name.

        Returns
        -------
        Contact
        """
        kept = {name: self.as_given(name) for name in NAMES}
        with in_si(but=changes):
            return Contact(**{**kept, **changes})

    def _by_model(self, model: str) -> Contact:
        """The contact of "solve" as one of the models that it takes has it: in time, or an impulse,
        which without that of tyres has no duration.
        """
        found = object.__new__(Contact)
        for name in (*NAMES, "_inputs_as_texts"):
            object.__setattr__(found, name, getattr(self, name))
        if model == IN_TIME:
            object.__setattr__(found, "model", model)
        elif model in NO_POINT:
            object.__setattr__(found, "duration", None)
        return found

    def as_given(self, name: str) -> Any:
        """The text that an argument was given as, or its value in SI.

        Parameters
        ----------
        name : str
            An argument of ``Contact``.

        Returns
        -------
        object
            Of a pair a tuple of both.

        Raises
        ------
        InputError
            A name that is none of these.
        """
        if not isinstance(name, str) or name not in NAMES:
            raise one_of("name", NAMES, name, code="unknown_name")
        value, texts = getattr(self, name), self.given
        if isinstance(value, tuple) and name not in texts:
            return tuple(texts.get(f"{name}[{i}]", part) for i, part in enumerate(value))
        return texts.get(name, value)

    @property
    def given(self) -> Texts:
        """The texts that the arguments were given as."""
        return texts_given(self)

    @property
    def touches(self) -> bool:
        """Whether the contact is a rule for every touch."""
        return isinstance(self.at, str)

    @property
    def in_time(self) -> bool:
        """Whether the contact is followed in time from first touch."""
        return self.model == IN_TIME

    @property
    def _takes_least(self) -> bool:
        """Whether the contact takes the least model that is near enough, which may take time."""
        return self.model == "solve" and self.duration is not None

    @property
    def _may_be_in_time(self) -> bool:
        """Whether the contact has what one followed in time takes."""
        return self.rule == FRICTION and self.law == BRACH and not self.incomplete

    @property
    def rule(self) -> str | None:
        """Which of friction, impulse ratio and critical fraction was given."""
        return next((name for name in RULES if getattr(self, name) is not None), None)

    @property
    def from_outlines(self) -> bool:
        """Whether the normal, or a point that the model needs, comes from the outlines."""
        return self.normal is None or (self.point is None and self.model not in NO_POINT)

    def _texts(self) -> Iterable[Any]:
        after = (text for tyres in self.tyres_after.values() for text in texts_of(tyres.given))
        return (*texts_of(self.given), *after)

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        for f in fields(self):
            value = getattr(self, f.name)
            if f.metadata and value is not None and not isinstance(value, str):
                yield prefix + f.name, value, f.metadata["unit"]

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        yield f"{prefix}a", repr(self.a)
        yield f"{prefix}b", repr(self.b)
        if self.touches:
            yield f"{prefix}at", repr(self.at)
        yield f"{prefix}model", repr(self.model)
        yield from Shown._rows(self, prefix)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, ({name: self.as_given(name) for name in NAMES},)


NAMES = tuple(f.name for f in fields(Contact))
UNITS: dict[str, str] = {f.name: f.metadata["unit"] for f in fields(Contact) if f.metadata}


def _restored(given: dict[str, Any]) -> Contact:
    with in_si():
        return Contact(**given)


def _time(reader: ArgumentReader, at: Any) -> Any:
    if isinstance(at, str) and not any(letter.isdigit() for letter in at):
        text = f"at must be a time, such as '0.8 s', or 'touch', got {shown(at)}"
        return reader.refuse(InputError(text, code="bad_option", argument="at"))
    read = one_value(reader, at, "s", "at", FINITE)
    return at_least_zero(
        reader, read, at, "at", "negative_time", "a scene starts at 0, where the states are given"
    )


def _length(reader: ArgumentReader, depth: Any) -> Any:
    if depth is None:
        return None
    read = one_value(reader, depth, "m", "depth")
    return at_least_zero(
        reader, read, depth, "depth", "negative_length", "it is the overlap along the normal"
    )


def _delay(reader: ArgumentReader, delay: Any) -> Any:
    if delay is None:
        return None
    read = one_value(reader, delay, "s", "delay")
    return at_least_zero(
        reader, read, delay, "delay", "negative_duration", "it is counted from first touch"
    )


def _tyres_after(reader: ArgumentReader, given: Any, pair: tuple[Any, Any]) -> Mapping[str, Tyres]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        text = (
            "tyres_after must be a dict from names to Tyres, such as "
            f"{{{shown(pair[0])}: Tyres(...)}}, got {shown(given)}"
        )
        reader.refuse(InputError(text, code="bad_shape", argument="tyres_after"))
        return {}
    # What is no text is refused already, and may not be comparable, as an array is.
    names = [name for name in pair if isinstance(name, str)]
    for name, tyres in given.items():
        if name not in names:
            text = (
                f"tyres_after names {shown(name)}, and this contact is between {shown(pair[0])} "
                f"and {shown(pair[1])}"
            )
            reader.refuse(InputError(text, code="unknown_name", argument="tyres_after"))
        if not isinstance(tyres, Tyres):
            reader.refuse(not_tyres(f"tyres_after[{shown(name)}]", tyres))
    return dict(given)


def _check(reader: ArgumentReader, found: Mapping[str, Any], rules: Mapping[str, Any]) -> None:
    """Refuse arguments that do not go together."""

    def refuse(text: str, argument: str, kind: type[InputError] = InputError) -> None:
        reader.refuse(kind(text, code="bad_combination", argument=argument))

    model = found["model"] if isinstance(found["model"], str) else ""
    given = [name for name, value in rules.items() if value is not None]
    if model == "linear_central":
        for name in given:
            refuse(f"model 'linear_central' has no {name}; leave it out, or use another", name)
        if found["law"] != BRACH:
            refuse("model 'linear_central' has no law; leave law out, or use another", "law")
    elif len(given) != 1:
        text = one_rule(rules, given)
        reader.refuse(InputError(text, code="one_tangential", argument=FRICTION))
    if found["point"] is not None and model in NO_POINT:
        refuse(f"model {model!r} has no point; leave point out, or use eccentric", "point")
    elif found["point"] is not None and found["normal"] is None:
        text = (
            "point is given without normal; give both, or neither where they come from the outlines"
        )
        reader.refuse(MissingInputError(text, code="missing_normal", argument="normal"))
    if found["depth"] is not None and found["delay"] is not None:
        refuse("give `depth=` or `delay=`, not both: each says when the impulse acts", "depth")
    whole = found["normal"] is not None and (found["point"] is not None or model in NO_POINT)
    for name in ("depth", "delay"):
        if found[name] is None:
            continue
        if not isinstance(found["at"], str):
            refuse(f"{name} is counted from first touch; write `at='touch'` with it", name)
        elif whole:
            known = "normal and point are given"
            if model in NO_POINT:
                known = "normal is given, and the model has no point"
            refuse(f"{known}, so the impulse acts at first touch; leave {name} out", name)
    if (
        isinstance(found["plane"], str)
        and found["plane"] == "crossings"
        and found["normal"] is not None
    ):
        refuse("plane says how the normal comes from the outlines; leave it or normal out", "plane")
    if found["tolerance"] is not None and model != "solve":
        refuse(
            "tolerance is for `model='solve'`, which takes the least model within it", "tolerance"
        )
    if model == IN_TIME:
        if found["duration"] is None:
            text = (
                "model 'time_resolved' needs `duration=`, such as '100 ms'; for a contact of "
                "an instant write `model='eccentric'`"
            )
            reader.refuse(MissingInputError(text, code="one_stiffness", argument="duration"))
        for name in given:
            if name != FRICTION:
                refuse(f"model 'time_resolved' works with `friction=` alone, got `{name}=`", name)
        if found["law"] != BRACH:
            refuse("model 'time_resolved' has a law of its own; leave law out", "law")
        if found["incomplete"] is True:
            refuse(
                "model 'time_resolved' follows a contact to its end; leave incomplete out",
                "incomplete",
            )
    if found["duration"] is not None and model in NO_POINT:
        refuse(f"model {model!r} takes no time; leave duration out, or use eccentric", "duration")
    law = found["law"]
    if (
        isinstance(law, str)
        and law in LAWS
        and LAWS[law].followed
        and given not in ([], [FRICTION])
    ):
        other = next(name for name in given if name != FRICTION)
        refuse(f"law {law!r} works with `friction=` alone, got `{other}=`", other)
