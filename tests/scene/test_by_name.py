"""What a run has of each vehicle: with units by ``.q``, and by a name that there is."""

import math

import pint
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Scene
from crashes import three_cars


def test_all_of_a_run_has_units_by_q() -> None:
    run = three_cars()
    for impact, found in zip(run.impacts, run.q.impacts, strict=True):
        for one, other in ((impact.a, found.a), (impact.b, found.b)):
            assert other.delta_v.to("km/h").magnitude == pytest.approx(3.6 * one.delta_v, rel=1e-12)
            assert other.after.vx.to("mm/s").magnitude == pytest.approx(
                1e3 * one.after.vx, rel=1e-12
            )
    for name, track in run.paths.items():
        rest = run.q.rest[name]
        assert rest.x.to("mm").magnitude == pytest.approx(1e3 * run.rest[name].x, rel=1e-12)
        assert math.degrees(run.rest[name].heading) == pytest.approx(
            rest.heading.to("deg").magnitude, rel=1e-12
        )
        assert run.q.paths[name].vx.to("mm/s").magnitude == pytest.approx(1e3 * track.vx)
        assert run[name].q.rest.x == rest.x
        assert run[name].q.impacts[0].a.delta_v.units == pint.Unit("m/s")
    assert run.q.pairs == run.pairs


def test_q_works_out_no_place_of_rest_that_is_not_asked_for() -> None:
    """One of both moves on, so that its place of rest is an error."""
    a = col.Vehicle(mass=1500, x=-2, y=0, heading=0, vx=10)
    b = col.Vehicle(mass=1000, x=2, y=0, heading=0)
    contact = Contact("A", "B", restitution=0.0, normal=0, model="linear_central")
    run = Scene(movers={"A": Mover(a, drag=0.5), "B": Mover(b)}, contacts=[contact]).run()
    assert run.q.rest["A"].x.units == pint.Unit("m")
    with pytest.raises(col.MissingInputError):
        run.q.rest["B"]


def test_a_name_that_is_none_is_refused_with_those_that_there_are() -> None:
    run = three_cars()
    for of in (run, run.rest, run.q.rest, run.paths, run.at("1 s")):
        with pytest.raises(KeyError, match=r"'Van' is no mover; .* are Camry, Civic, Truck"):
            of["Van"]
