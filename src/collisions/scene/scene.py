"""``Scene``: vehicles, contacts and surfaces of one crash, and ``run``, which follows it from the
start to rest.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from ..kernels.elementwise import POSITIVE_FINITE
from ..messages.errors import InputError, MissingInputError, ShapeError
from ..messages.hints import hinted
from ..quantities.attributes import Shown, equal, read_only, texts_given
from ..quantities.reading import ArgumentReader, broadcast
from ..quantities.settings import Default
from ..quantities.tables import Cells, Part, Summary, all_numbers, given_texts
from ..quantities.units import Input, Pair, Texts, Value, shown, texts_of
from ..travel.corners import read_areas
from ..travel.surfaces import read_slope
from ..vehicle.vehicle import numbers_of
from .contact import Contact
from .mover import Mover

if TYPE_CHECKING:
    from ..uncertainty.distributions import Distribution
    from .required import Required
    from .run import Run

# Names that results and inputs of a scene have already.
RESERVED = ("contacts", "impacts", "times", "surfaces", "slope", "energy", "momentum", "end")
# Those with times, of which a difference is a result too.
_OF_TIMES = ("contacts", "times")
_FINEST, _COARSEST = 1e-10, 1e-2
TOLERANCE = Default(1e-5)
"""How finely motion on tyres is followed, where nothing else is asked for."""


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Scene(Shown):
    """A whole crash as one thing: vehicles, what happens when they meet, and the ground.

    ``run`` follows it from the start until all vehicles rest or go on unhindered. Contacts at
    "touch" are rules and not a list in order: whichever comes next happens, as often as it comes.
    Everything is optional until a step needs it. A driver who brakes or steers on the way, trailers
    and rollover are not described, nor what pushes without a blow: two that stay together after
    their contact may be driven through each other, which is a finding of a run and a warning of a
    batch.

    Parameters
    ----------
    movers : dict of Mover
        By name. All states are those at the start, at time 0.
    contacts : list of Contact
        Which of them meet, and how.
    surfaces : sequence of (corners, friction), optional
        Areas with a different friction, each with 3 to 1000 corners [m] in order, for movers
        with tyres. The first that a wheel is in counts. An area may have dents; sides that cross
        are refused.
    slope : pair of float, str, Quantity or array [-]
        Rise over run of the ground along x and along y, from -100 to 100, for movers with tyres or
        a drag. Places are in plan, speeds and times along the ground, as in ``travel.simulate``.
        While a contact with a duration lasts it pulls both vehicles alike, by 0.1 m/s in 0.1 s on a
        slope of 10 %, which is in their ways and not in the impact; a contact without one takes no
        time. A mover with a drag goes straight on
        also across a slope, which would bend the way of a sliding one: by 1 m of 14 m at 10 %. Give
        it tyres there. What gains speed down a slope is followed as far as its contacts need it,
        and what stops on a slope that it would roll back down is refused if that comes before its
        contact.
    order : list of pairs of names, optional
        The order of the contacts that an account claims, such as ``[("A", "B"), ("B", "C")]``. A
        case that goes otherwise is refused, with the order that it takes.
    shared : dict of tuples of str, optional
        By a new name, no path, the inputs that are one and the same, such as ``{"ground":
        ("Camry.tyres.friction", "Civic.tyres.friction")}``: the same number is stated at each, and
        a change of one is a change of all. No input is under two names.

    Raises
    ------
    InputError
        Naming every argument that cannot be used.

    Warns
    -----
    SuspectUnitsWarning
        A part of the slope without a unit beyond 0.5, which is probably in percent.

    Examples
    --------
    A van runs into a standing car and pushes it towards a truck, which it just does not reach:

    >>> import collisions as col
    >>> from collisions.scene import Contact, Mover, Scene
    >>> row = {"normal": 0, "model": "linear_central", "at": "touch", "restitution": 0.1}
    >>> def mover(mass, vx, x):
    ...     car = col.Vehicle(mass=mass, vx=vx, x=x, y=0, heading=0)
    ...     return Mover(car, outline=("4.5 m", "1.8 m"), drag=0.3)
    >>> crash = Scene(
    ...     movers={
    ...         "van": mover("2100 kg", "30 km/h", "-6 m"),
    ...         "car": mover("1300 kg", 0, "0 m"),
    ...         "truck": mover("9 t", 0, "10 m"),
    ...     },
    ...     contacts=[Contact("van", "car", **row)],
    ... )
    >>> run = crash.run()
    >>> print(f"{run.times[0]:.2f} s; the car stops {run.rest['car'].x:.1f} m on")
    0.19 s; the car stops 4.8 m on
    """

    _title = "Scene"
    # How to write the run of one where a result is wanted.
    _run_in_words: ClassVar[str] = "scene.run()"

    movers: Mapping[str, Mover]
    contacts: tuple[Contact, ...]
    surfaces: tuple[tuple[tuple[tuple[float, float], ...], Value], ...]
    slope: tuple[Value, Value] = field(metadata={"unit": ""})
    order: tuple[tuple[str, str], ...] | None
    shared: Mapping[str, tuple[str, ...]]

    @hinted
    def __init__(
        self,
        *,
        movers: Mapping[str, Mover],
        contacts: Sequence[Contact],
        surfaces: Sequence[tuple[Sequence[Pair], Input]] | None = None,
        slope: Pair = (0.0, 0.0),
        order: Sequence[tuple[str, str]] | None = None,
        shared: Mapping[str, Sequence[str]] | None = None,
    ) -> None:
        reader = ArgumentReader()
        found: dict[str, Any] = {"movers": MappingProxyType(_read_movers(reader, movers))}
        named = [*movers] if isinstance(movers, Mapping) else []
        found["contacts"] = _read_contacts(reader, contacts, found["movers"], named)
        found["surfaces"] = () if surfaces is None else tuple(read_areas(reader, surfaces))
        found["slope"] = read_slope(reader, slope)
        found["order"] = _read_order(reader, order, found["movers"], found["contacts"])
        found["shared"] = MappingProxyType(_read_shared(reader, shared, found["movers"]))
        reader.close()
        for name, value in found.items():
            object.__setattr__(self, name, read_only(value))
        object.__setattr__(self, "_inputs_as_texts", Texts(reader.texts))
        shape = broadcast(dict(self._numbers()))
        if shape is not None and (len(shape) != 1 or not shape[0]):
            raise ShapeError(
                f"the arrays of a scene have the shape {shape}, and must have one axis, over the "
                "cases, of one or more; give them as array.ravel()",
                code="bad_shape",
                argument="movers",
            )
        if found["shared"]:
            from .names import check_shared

            check_shared(self)

    @property
    def shape(self) -> tuple[int, ...] | None:
        """That of the arrays among the numbers; None for a single case."""
        return broadcast(dict(self._numbers()))

    @hinted
    def run(self, *, tolerance: float = TOLERANCE) -> Run:
        """Follow the scene from the start, contact by contact, until all rest or go on unhindered.

        Parameters
        ----------
        tolerance : float [-]
            How finely motion on tyres is followed, as for ``travel.simulate``, 1e-10 to 0.01. At
            the default the energy of the scene closes to 1e-3, at 1e-6 mostly to 1e-6 and
            always to ten times that.

        Returns
        -------
        Run

        Raises
        ------
        InputError
            Also where outlines overlap at the start and no contact says why.
        MissingInputError
            Something that a step needs is not given.
        NoImpactError
            The vehicles of a contact do not approach each other.
        NoSolutionError
            The scene contradicts itself: a contact does not come, or the order is another; or it
            does not come to its end. In a batch such cases are NaN, with a ``status``.
        """
        from .run import Run

        run = Run(self, _read_tolerance(tolerance))
        # A motion that cannot be followed is refused here, and not when it is looked at.
        run._roll_out()
        return run

    def replace(self, changes: Mapping[str, Any]) -> Scene:
        """The scene with other numbers, each by its path.

        Parameters
        ----------
        changes : dict
            By path, as listed by ``inputs``, the new number, as for the argument that it is.

        Returns
        -------
        Scene

        Raises
        ------
        InputError
            A path that is none, with the nearest ones.

        Examples
        --------
        >>> import collisions as col
        >>> from collisions.scene import Contact, Mover, Scene
        >>> cars = {
        ...     "A": Mover(col.Vehicle(mass=1500, vx="50 km/h")),
        ...     "B": Mover(col.Vehicle(mass=1200)),
        ... }
        >>> hit = Contact("A", "B", restitution=0.1, normal=0, model="linear_central")
        >>> crash = Scene(movers=cars, contacts=[hit])
        >>> faster = crash.replace({"A.vx": "60 km/h", "contacts[0].restitution": 0.2})
        >>> round(faster.run().impacts[0].b.q.delta_v.m_as("km/h"), 1)
        40.0
        """
        from .names import replaced

        return replaced(self, changes)

    def inputs(self) -> dict[str, str]:
        """The paths of all numbers of the scene, with their units.

        Returns
        -------
        dict of str
            By path, such as "Camry.vx" or "contacts[0].friction", the SI unit.
        """
        from .names import inputs_of

        return inputs_of(self)

    def results(self) -> dict[str, str]:
        """The paths of the numbers that a run of the scene answers, with their units.

        Returns
        -------
        dict of str
            By path, such as "Camry.rest.x" or "contacts[0].impact.Camry.delta_v", the SI unit.
            "contacts[i].impact" is the first impact of that contact, whenever it comes, with its
            vehicles by name and its "time". "impacts[k]" is counted in order of time, with
            the vehicles "a" and "b"; in a study it is the impact that it is in the scene as
            written, and a case in which another comes in its place has no answer to it. There are
            also paths with a number in them: "contacts[0].impact.Camry.ees(0.4)", EES with the
            share of the energy lost that went into the vehicle; "times[1] - times[0]"; the
            distance of a place from a tyre mark, as in ``mark_points``; and, of a contact that is
            followed in time, "contacts[0].impact.Camry.recorded(40 ms, 0.4 m, -0.3 m).forward" and
            ".left": the delta-V that a recorder 0.4 m ahead of the centre of mass and 0.3 m to its
            right shows 40 ms after first contact, in axes that turn with the vehicle, as
            ``impact.a.recorded`` has it. With the time alone it sits at the centre of mass.
        """
        from .results import results_of

        return results_of(self)

    def mark_points(
        self,
        name: str,
        wheel: str,
        points: Any,
        error: Input,
        *,
        begins: bool = False,
        ends: bool = False,
    ) -> dict[str, Distribution]:
        """Surveyed points of a tyre mark as evidence, for ``observed=`` of ``posterior`` and
        ``fit``.

        What is compared is the distance of each point from the mark that the wheel leaves, the
        whole of it: wherever it uses 90 % of the friction or more, from the start to rest. Beyond
        an end of the mark it is the distance from that end. Distances are positive to the left of
        the mark, in the direction in which the wheel left it. A longer mark passes the same
        points, so these tell how fast the vehicle was at least; that the mark begins or ends at
        one is said by ``begins`` and ``ends``. A case in which the wheel leaves no mark has no
        answer, so that a posterior counts it as impossible.

        Parameters
        ----------
        name : str
            The vehicle.
        wheel : {"front_left", "front_right", "rear_left", "rear_right"}
            The wheel that left the mark.
        points : list of pairs (x, y) of float, str or Quantity, or array of (points, 2) [m]
            Where the mark was surveyed, in scene axes, in the order in which the wheel left it.
        error : float, str or Quantity [m]
            Standard deviation of the distance of each point: that of the survey and of what the
            model leaves out. Errors count as independent: give points well apart, as a dense row
            of them counts one error many times.
        begins, ends : bool
            Whether the mark begins at the first point, and ends at the last; both coordinates of
            that point are then compared.

        Returns
        -------
        dict of Normal
            By path: "Camry.marks.front_left.distance(12.3 m, 4.5 m)" is 0 with that error, and
            "Camry.marks.front_left.end.x" the coordinate. These paths, "begin" among them, are
            results of the scene wherever one is asked for.

        Raises
        ------
        InputError
            No such vehicle or wheel, a vehicle without tyres, points of another shape, or an
            error that is not above 0.

        Examples
        --------
        A car that skids straight on, whose front left wheel marks a line at y = 0.75 m:

        >>> import collisions as col
        >>> from collisions.scene import Mover, Scene
        >>> from collisions.travel import Tyres
        >>> car = col.Vehicle(mass=1500, yaw_inertia=2500, vx=15, x=0, y=0, heading=0)
        >>> crash = Scene(movers={"A": Mover(car, tyres=Tyres(0.7, 1, 2.7, 1.5))}, contacts=[])
        >>> seen = crash.mark_points("A", "front_left", [(5, 0.85), ("10 m", "0.7 m")], "0.1 m")
        >>> list(seen)
        ['A.marks.front_left.distance(5.0 m, 0.85 m)', 'A.marks.front_left.distance(10 m, 0.7 m)']
        >>> found = crash.as_model([], list(seen))()
        >>> [round(distance.m_as("m"), 3) for distance in found.values()]
        [0.1, -0.05]
        """
        from .marks import evidence_of

        return dict(evidence_of(self, name, wheel, points, error, begins, ends))

    def as_model(
        self, names: Sequence[str], outputs: Sequence[str], *, tolerance: float = TOLERANCE
    ) -> Callable[..., dict[str, Any]]:
        """The scene as a function of some of its numbers, as ``propagate``, ``fit`` and
        ``posterior`` take it.

        They make it themselves of a scene that they are given in place of a function.

        Parameters
        ----------
        names : list of str
            The paths of the inputs, which are its arguments.
        outputs : list of str
            The paths of the results that it returns.
        tolerance : float [-]
            As for ``run``.

        Returns
        -------
        function
            Called with numbers or arrays, as in ``model(**{"Camry.vx": 20.0})``, it returns a dict
            of Quantities. It warns of findings of the run that limit its results.

        Raises
        ------
        InputError
            A path that is none, with the nearest ones.
        """
        from .model import as_function

        return as_function(self, names, outputs, _read_tolerance(tolerance))

    @hinted
    def required(
        self,
        tolerances: Mapping[str, Input],
        unknowns: Mapping[str, Distribution] | None = None,
        *,
        draws: int = 32,
        tolerance: float = TOLERANCE,
    ) -> Required:
        """Which level of model the accuracy that is asked for needs, and what each costs.

        The levels are contacts of an instant, with the impulse of the tyres meanwhile, or followed
        in time; and motion by a drag, straight on, or on wheels. Each is run for the same draws of
        what is not known, and compared with the finest. A drag is the share of the friction that
        the tyres take on average on the way, at the stated values.

        Parameters
        ----------
        tolerances : dict
            By result, as listed by ``results``, how far it may be off.
        unknowns : dict of Distribution, optional
            By input, as for ``propagate``. Without it the levels are compared at the stated values
            alone, where the difference misleads by a factor of 3.
        draws : int
            How many, 32 to 4096. The 95 % point of 32 is known to about a quarter and is 6 % low,
            so that it is given times 1.35.
        tolerance : float [-]
            As for ``run``.

        Returns
        -------
        Required
            Its ``level`` is the cheapest within the tolerances, and is a model itself:
            ``posterior(found.level, unknowns, observed, finer=found.finest)``.

        Raises
        ------
        InputError
            A result or an input that is none, or tolerances that are no numbers.
        NoSolutionError
            No draw has an answer.

        Warns
        -----
        OutOfRangeWarning
            The finest level is of a crash that it does not describe, such as vehicles that are
            driven through each other; ``notes`` have that of every level.

        Examples
        --------
        Two cars in line, of which one turns a little; their headings at rest need wheels:

        >>> import collisions as col
        >>> from collisions.scene import Contact, Mover, Scene
        >>> from collisions.travel import Tyres
        >>> wheels = Tyres(0.7, 1, 2.7, 1.5)
        >>> a = col.Vehicle(mass=1500, yaw_inertia=2600, vx=15, x=-2.2, y=0.3, heading=0)
        >>> b = col.Vehicle(mass=1200, yaw_inertia=2000, x=2.2, y=0, heading=0)
        >>> crash = Scene(
        ...     movers={"A": Mover(a, tyres=wheels), "B": Mover(b, tyres=wheels)},
        ...     contacts=[Contact("A", "B", restitution=0.1, friction=0.5, normal=0, point=(0, 0))],
        ... )
        >>> found = crash.required({"impacts[0].b.delta_v": "0.5 m/s"})
        >>> found.level.name
        'contacts with tyres, motion on wheels'
        """
        from .required import required

        return required(self, tolerances, unknowns, draws, _read_tolerance(tolerance))

    def case(self, index: int | tuple[int, ...]) -> Scene:
        """One case of a batch as a single scene.

        Parameters
        ----------
        index : int or tuple of int
            Which case, as an index into the arrays of the batch.

        Returns
        -------
        Scene

        Raises
        ------
        CollisionsError
            There is no such case.
        """
        from .names import case_of

        return case_of(self, index)

    def to_dict(self) -> dict[str, Any]:
        """The scene as nested plain values that strict JSON can hold.

        Returns
        -------
        dict
        """
        from .record import scene_record

        return scene_record(self)

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Scene:
        """The scene of a ``to_dict`` record.

        Parameters
        ----------
        record : dict
            What ``to_dict`` gave, also through JSON.

        Returns
        -------
        Scene
        """
        from .record import scene_of

        return scene_of(record)

    def _numbers(self) -> Iterator[tuple[str, Any]]:
        """Every number by its path."""
        for name, mover in self.movers.items():
            for part, value in numbers_of(mover.vehicle).items():
                yield f"{name}.{part}", value
            if mover.tyres is not None:
                for part, value in mover.tyres.named.items():
                    yield f"{name}.tyres.{part}", value
            if mover.drag is not None:
                yield f"{name}.drag", mover.drag
        for i, contact in enumerate(self.contacts):
            for part, given, _ in contact._values():
                path = f"contacts[{i}].{part}"
                if isinstance(given, tuple):
                    yield from ((f"{path}[{k}]", one) for k, one in enumerate(given))
                else:
                    yield path, given
            for name, tyres in contact.tyres_after.items():
                for part, value in tyres.named.items():
                    yield f"contacts[{i}].tyres_after.{name}.{part}", value
        for i, (_, friction) in enumerate(self.surfaces):
            yield f"surfaces[{i}]", friction
        for i, rise in enumerate(self.slope):
            yield f"slope[{i}]", rise

    def _texts(self) -> Iterable[Any]:
        for part in (*self.movers.values(), *self.contacts):
            yield from given_texts(part)
        yield from texts_of(texts_given(self))

    def _summary(self, numbers: Cells) -> Summary:
        rows = []
        for name, mover in self.movers.items():
            body = mover.vehicle
            slowed = (
                "tyres" if mover.tyres is not None else "drag" if mover.drag is not None else ""
            )
            cells = (
                numbers.text(body.mass, "kg"),
                numbers.text(body.speed, "m/s"),
                numbers.text(body.heading, "rad", "heading"),
                slowed or "nothing",
            )
            rows.append((name, *cells))
        contacts = []
        for contact in self.contacts:
            at = "touch" if isinstance(contact.at, str) else numbers.text(contact.at, "s")
            e = numbers.text(contact.restitution, "")
            contacts.append((f"{contact.a} and {contact.b}", at, contact.model, e))
        parts = [
            Part(rows, "Movers", ("mass", "speed", "heading", "slowed by")),
            Part(contacts, "Contacts", ("at", "model", "restitution")),
            all_numbers(self._rows()),
        ]
        return Summary(self._title, parts)

    def _rows(self, prefix: str = "") -> Iterator[tuple[str, str]]:
        yield f"{prefix}movers", ", ".join(self.movers)
        for i, contact in enumerate(self.contacts):
            yield f"{prefix}contacts[{i}]", repr(contact)
        if self.surfaces:
            yield f"{prefix}surfaces", str(len(self.surfaces))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return (
            self.movers.keys() == other.movers.keys()
            and all(mover == other.movers[name] for name, mover in self.movers.items())
            and len(self.contacts) == len(other.contacts)
            and all(one == two for one, two in zip(self.contacts, other.contacts, strict=True))
            and equal(self.surfaces, other.surfaces)
            and equal(self.slope, other.slope)
            and self.order == other.order
            and dict(self.shared) == dict(other.shared)
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (arguments_of(self),)


def arguments_of(scene: Scene) -> dict[str, Any]:
    """The arguments of a scene, by which it is made again."""
    texts = texts_given(scene)
    return {
        "movers": dict(scene.movers),
        "contacts": list(scene.contacts),
        "surfaces": [
            ([*corners], texts.get(f"surfaces[{i}]", friction))
            for i, (corners, friction) in enumerate(scene.surfaces)
        ],
        "slope": tuple(texts.get(f"slope[{i}]", part) for i, part in enumerate(scene.slope)),
        "order": scene.order,
        "shared": dict(scene.shared),
    }


def _restored(arguments: dict[str, Any]) -> Scene:
    return Scene(**arguments)


def _read_movers(reader: ArgumentReader, movers: Any) -> dict[str, Mover]:
    if not isinstance(movers, Mapping) or not movers:
        text = (
            "movers must be a dict from names to Movers, such as `{'Camry': "
            f"Mover(camry)}}`, got {shown(movers)}"
        )
        reader.refuse(InputError(text, code="bad_shape", argument="movers"))
        return {}
    found: dict[str, Mover] = {}
    for name, mover in movers.items():
        if (
            not isinstance(name, str)
            or not name.strip()
            or name in RESERVED
            or any(letter in name for letter in ".[]")
            or name.splitlines() != [name]
        ):
            text = (
                f"movers has the name {shown(name)}; names are texts of one line without dots and "
                f"brackets, and not one of {', '.join(RESERVED)}"
            )
            reader.refuse(InputError(text, code="bad_name", argument="movers"))
        elif not isinstance(mover, Mover):
            text = (
                f"movers[{name!r}] must be a Mover, got {type(mover).__name__}; write "
                "Mover(vehicle, outline=..., tyres=...)"
            )
            reader.refuse(InputError(text, code="not_a_mover", argument="movers"))
        else:
            found[name] = mover
    return found


def _read_contacts(
    reader: ArgumentReader, contacts: Any, movers: Mapping[str, Mover], named: Sequence[Any]
) -> tuple[Contact, ...]:
    """The contacts; of what they name in ``named`` and not in ``movers``, the mover was refused."""
    if not isinstance(contacts, (list, tuple)):
        text = (
            "contacts must be a list of Contacts, such as [Contact('Camry', 'Civic', ...)], got "
            f"{shown(contacts)}"
        )
        reader.refuse(ShapeError(text, code="bad_shape", argument="contacts"))
        return ()
    found, rules = [], set()
    for i, contact in enumerate(contacts):
        if not isinstance(contact, Contact):
            text = (
                f"contacts[{i}] must be a Contact, got {type(contact).__name__}; write "
                "Contact('Camry', 'Civic', restitution=..., friction=...)"
            )
            reader.refuse(InputError(text, code="not_a_contact", argument="contacts"))
            continue
        found.append(contact)
        names = (contact.a, contact.b)
        for label, name in zip("ab", names, strict=True):
            if movers and name not in movers and name not in named:
                text = f"contacts[{i}] names {name!r}, and the movers are {', '.join(movers)}"
                where = f"contacts[{i}].{label}"
                reader.refuse(InputError(text, code="unknown_name", argument=where))
        for name in contact.tyres_after:
            if name in movers and movers[name].drag is not None:
                text = (
                    f"contacts[{i}] gives {name!r} tyres, which moves by a drag before; give its "
                    "`|Mover|[[mover]]` `tyres=` too"
                )
                reader.refuse(InputError(text, code="bad_combination", argument="contacts"))
        if contact.touches:
            for name in names:
                if name in movers and movers[name].outline is None:
                    text = (
                        f"contacts[{i}] is at 'touch', and {name!r} has no outline; give "
                        "`outline=(length, width)` to its `|Mover|[[mover]]`, or a "
                        "time as `at=`"
                    )
                    reader.refuse(
                        MissingInputError(text, code="missing_outline", argument="outline")
                    )
            pair = frozenset(names)
            if pair in rules:
                text = (
                    f"contacts[{i}] is a second rule at 'touch' for {names[0]} and {names[1]}; "
                    "leave it out, as one rule holds for every touch of the two"
                )
                reader.refuse(InputError(text, code="rule_twice", argument="contacts"))
            rules.add(pair)
        if (
            contact.duration is not None
            and not contact.in_time
            and not any(name in movers and movers[name].tyres is not None for name in names)
        ):
            text = (
                f"contacts[{i}] has a duration, which is for the impulse of tyres, and neither "
                f"{names[0]} nor {names[1]} has tyres; give `tyres=` to a `|Mover|[[mover]]`, or "
                "leave "
                "duration out"
            )
            reader.refuse(InputError(text, code="missing_tyres", argument="duration"))
    return tuple(found)


def _read_order(
    reader: ArgumentReader, order: Any, movers: Mapping[str, Mover], contacts: Sequence[Contact]
) -> tuple[tuple[str, str], ...] | None:
    if order is None:
        return None
    pairs = {frozenset((contact.a, contact.b)) for contact in contacts}
    good = isinstance(order, (list, tuple)) and all(
        isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in order
    )
    if not good or not all(isinstance(name, str) for pair in order for name in pair):
        text = f"order must be a list of pairs of names, such as [('A', 'B')], got {shown(order)}"
        reader.refuse(ShapeError(text, code="bad_shape", argument="order"))
        return None
    for one, other in order:
        if frozenset((one, other)) not in pairs:
            text = f"order has {one!r} and {other!r}, and no contact is between these two"
            reader.refuse(InputError(text, code="unknown_name", argument="order"))
    return tuple((one, other) for one, other in order)


def _read_shared(
    reader: ArgumentReader, shared: Any, movers: Mapping[str, Mover]
) -> dict[str, tuple[str, ...]]:
    if shared is None:
        return {}
    good = isinstance(shared, Mapping) and all(
        isinstance(name, str)
        and name.strip()
        and isinstance(paths, (list, tuple))
        and paths
        and all(isinstance(path, str) for path in paths)
        for name, paths in shared.items()
    )
    if not good:
        text = (
            "shared must be `|a dict|a table` from new names to `|tuples|lists` of "
            "paths, such as `{'ground': ('A.tyres.friction', 'B.tyres.friction')}`, "
            f"got {shown(shared)}"
        )
        reader.refuse(ShapeError(text, code="bad_shape", argument="shared"))
        return {}
    for name in shared:
        # Also "Camry.vx" and "contacts[0].friction" are taken, as paths, and "end - times[0]".
        first = re.split(r"[.\[]", name)[0]
        ends = [re.split(r"[.\[]", part)[0].strip() for part in name.split("-")]
        of_time = len(ends) == 2 and all(one in ("end", *_OF_TIMES) for one in ends)
        if {first, first.strip()} & {*movers, *RESERVED} or of_time:
            text = (
                f"shared has the name {name!r}, which is taken; give the numbers that are one "
                "and the same a name of their own, such as 'road'"
            )
            reader.refuse(InputError(text, code="bad_name", argument="shared"))
    return {name: tuple(paths) for name, paths in shared.items()}


def _read_tolerance(tolerance: Any) -> float:
    reader = ArgumentReader()
    within = reader.number(tolerance, "", "tolerance", POSITIVE_FINITE)
    if not (isinstance(within, float) and (within != within or _FINEST <= within <= _COARSEST)):
        text = (
            f"tolerance must be one number from {_FINEST:g} to {_COARSEST:g}, got "
            f"{shown(tolerance)}"
        )
        reader.refuse(InputError(text, code="bad_option", argument="tolerance"))
    reader.close()
    return float(within)
