"""A kernel of named parts runs on a row of numbers, and what is not given has no number there."""

from collisions.engine.flattening import flattened, form_of, numbers_of
from collisions.kernels.problem import Body, Contact, Problem

CONTACT = Contact(0.1, (0.8, 0.6), point=(2.0, 3.0))
FREE, PINNED = Body(4.0, 5.0, 6.0, 7.0, 8.0), Body(9.0, None, 10.0, 11.0, 12.0, pivot=(13.0, 14.0))
PROBLEM = Problem(CONTACT, FREE, PINNED, contact_velocity=(15.0, None))


def test_the_row_is_in_the_order_of_the_fields():
    expected = [0.1, 0.8, 0.6, *map(float, range(2, 16)), 16.0]
    assert numbers_of((PROBLEM, 16.0)) == expected


def test_a_kernel_gets_its_parts_again():
    """Of their types, None where nothing was given, and its settings behind them."""

    def kernel(*given):
        return given

    arguments = (PROBLEM, 16.0)
    found = flattened(kernel, form_of(arguments))(*numbers_of(arguments), "friction", None)
    assert found == (*arguments, "friction", None)
    assert type(found[0]) is Problem
    assert type(found[0].b) is Body
    assert type(found[0].contact.normal) is tuple


def test_a_form_does_not_know_the_numbers():
    """So a kernel is recorded once for all problems of one form, and again for another."""
    other = PROBLEM._replace(a=FREE._replace(mass=1.0))
    assert form_of((PROBLEM,)) == form_of((other,))
    assert flattened(len, form_of((PROBLEM,))) is flattened(len, form_of((other,)))
    assert form_of((PROBLEM,)) != form_of((PROBLEM._replace(a=PINNED),))
    assert form_of((CONTACT.normal,)) != form_of((CONTACT._replace(point=None),))
