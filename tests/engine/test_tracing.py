"""A kernel replayed block by block gives the bits it gives when it is called; nothing leaks between
cases, blocks or threads.
"""

import itertools
import pickle
import threading
import warnings

import numpy as np
import pytest

import collisions as col
from collisions.engine.blocks import BLOCK, block_length
from collisions.engine.buffers import slice_memory
from collisions.engine.flattening import flattened, form_of
from collisions.engine.replay import input_kind, record, replay
from collisions.kernels.central import (
    linear_approximation,
    linear_central,
    oblique_approximation,
    oblique_central,
)
from collisions.kernels.contact_laws import BRACH, FRICTION, KUDLICH_SLIBAR, LAWS, RULES
from collisions.kernels.eccentric import eccentric
from collisions.kernels.problem import Body, Contact, Problem
from collisions.kernels.status import Answer

ODD = (0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, np.nan, 5e-324, 1e308)


# A law that follows the contact takes friction only.
LAW_RULES = [
    (rule, law)
    for rule, law in itertools.product(RULES, LAWS)
    if rule == FRICTION or not LAWS[law].followed
]


def free(pinned=False):
    """A body, of whatever numbers."""
    return Body(*[1.0] * 7, (1.0, 1.0) if pinned else None)


def of_numbers(kernel, *pinned):
    """A kernel as a function of numbers in a row; of point masses, and of bodies that are pinned or
    not.
    """
    contact = Contact(1.0, (1.0, 1.0), 1.0, (1.0, 1.0))
    bodies = map(free, pinned)
    if not pinned:
        contact = contact._replace(point=None)
        bodies = [free()._replace(yaw_inertia=None, x=None, y=None)] * 2
        if kernel in (linear_central, linear_approximation):
            contact = contact._replace(rule_value=None)
    return flattened(kernel, form_of((Problem(contact, *bodies),)))


FREE = of_numbers(eccentric, False, False)


def programs():
    """Every kernel with every setting that changes what it does."""
    for kernel in (linear_central, linear_approximation):
        yield pytest.param(of_numbers(kernel), (), 11, id=kernel.__name__)
    for rule, law in LAW_RULES:
        for kernel in (oblique_central, oblique_approximation):
            yield pytest.param(
                of_numbers(kernel), (rule, law), 12, id=f"{kernel.__name__} {rule} {law}"
            )
        for pinned in itertools.product((False, True), repeat=2):
            kernel, count = of_numbers(eccentric, *pinned), 20 + 2 * sum(pinned)
            yield pytest.param(kernel, (rule, law), count, id=f"eccentric {rule} {law} {pinned}")


def kinds(dtype):
    """The types of the outputs."""
    return tuple(
        np.dtype({"status": np.uint8, "sticks": np.bool_}.get(name, dtype))
        for name in Answer._fields
    )


def numbers(count, size, dtype, rng, odd):
    """Inputs in the order of a kernel's arguments, some of them values that no impact has."""
    found = rng.uniform(0.05, 2.0, (count, size)) * rng.choice([-1.0, 1.0, 1.0], (count, size))
    if odd:
        found = np.where(rng.random((count, size)) < 0.1, rng.choice(ODD, (count, size)), found)
    with np.errstate(all="ignore"):
        return list(found.astype(dtype))


def compare(kernel, settings, inputs, dtype, length):
    """All outputs of the replay in blocks of a length, against the kernel called on each block; to
    the bit.
    """
    texts = tuple(map(input_kind, inputs))
    program = record(kernel, settings, texts, dtype, kinds(dtype))
    size = next(len(value) for value in inputs if isinstance(value, np.ndarray))
    outputs = [np.full(size, 7, kind) for kind in kinds(dtype)]
    for which, value in program.outputs.items():
        outputs[which].fill(value)
    with np.errstate(all="ignore"):
        for start in range(0, size, length):
            block = slice(start, min(start + length, size))
            cut = [value if isinstance(value, float) else value[block] for value in inputs]
            replay(program, cut, [output[block] for output in outputs])
            for name, output, wanted in zip(
                Answer._fields, outputs, kernel(*cut, *settings), strict=True
            ):
                expected = np.empty(block.stop - start, output.dtype)
                expected[...] = wanted
                np.testing.assert_array_equal(output[block], expected, err_msg=name)
                # NaN aside, signs of zero included.
                real = expected == expected
                np.testing.assert_array_equal(
                    np.signbit(output[block][real] * 1.0), np.signbit(expected[real] * 1.0), name
                )


@pytest.mark.slow
@pytest.mark.parametrize("dtype", [np.float64, pytest.param(np.float32, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("kernel", "settings", "count"), list(programs()))
def test_the_bits_are_those_of_the_kernel(kernel, settings, count, dtype):
    """Ordinary and impossible values, a last block that is short, every model, rule,
    law and pivot.
    """
    rng = np.random.default_rng(count)
    eps = float(np.finfo(dtype).eps)
    for odd in (False, True):
        compare(kernel, (*settings, eps), numbers(count, 301, dtype, rng, odd), dtype, 128)


@pytest.mark.slow
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(("kernel", "settings", "count"), list(programs()))
def test_plain_numbers_among_the_arrays(kernel, settings, count, dtype):
    """Which inputs are arrays is drawn; the others are floats, zeros and infinite masses among
    them.
    """
    rng = np.random.default_rng(count + 1)
    for _ in range(12):
        inputs = numbers(count, 40, dtype, rng, odd=False)
        arrays = set(rng.choice(count, rng.integers(1, count), replace=False).tolist())
        plain = [float(rng.choice([0.5, 1.0, 2.0, abs(value[0])])) for value in inputs]
        mixed = [
            value if i in arrays else number
            for i, (value, number) in enumerate(zip(inputs, plain, strict=True))
        ]
        compare(kernel, (*settings, float(np.finfo(dtype).eps)), mixed, dtype, 16)


@pytest.mark.parametrize("bound", [0.0, 0.3, np.inf])
@pytest.mark.parametrize("rule", RULES)
def test_plain_bounds(rule, bound):
    """The tangential bound as one number for all cases, which turns parts of a kernel into
    constants.
    """
    rng = np.random.default_rng(5)
    inputs = numbers(20, 100, np.float64, rng, odd=True)
    inputs[3] = bound
    compare(FREE, (rule, BRACH, 2.0**-52), inputs, np.float64, 33)


@pytest.mark.parametrize("size", [1, 2, 15, 16, 17, 32, 33])
def test_any_number_of_cases(size):
    """Sizes around the length of a block."""
    inputs = numbers(22, size, np.float64, np.random.default_rng(size), odd=True)
    kernel = of_numbers(eccentric, False, True)
    compare(kernel, (FRICTION, KUDLICH_SLIBAR, 2.0**-52), inputs, np.float64, 16)


def test_arrays_of_any_layout():
    """Strided and reversed parts are read as they are."""
    wide = numbers(20, 120, np.float64, np.random.default_rng(3), odd=False)
    compare(
        FREE,
        (FRICTION, BRACH, 2.0**-52),
        [v[::2][::-1] for v in wide],
        np.float64,
        32,
    )


def test_a_kernel_is_recorded_once():
    """For the same settings, plain numbers and type; the sign of a zero tells two plain numbers
    apart.
    """

    kernel = of_numbers(linear_approximation)

    def program(*numbers):
        texts = tuple(number if number is None else number.hex() for number in numbers)
        return record(kernel, (2.0**-52,), texts, np.float64, kinds(np.float64))

    scene = (None, 1.0, 0.0, 900.0, None, 0.0, 0.0, 1200.0, 0.0, 0.0, 0.0)
    assert program(*scene) is program(*scene)
    assert program(*scene) is not program(*scene[:2], -0.0, *scene[3:])


def test_nothing_is_worked_out_twice_or_for_nothing():
    """Equal calls are one, and what no output needs is left out."""

    def kernel(x, y):
        unused = x * y + 3.0
        assert unused is not None
        return (x + y) * (x + y), 1.0 * x

    program = record(kernel, (), (None, None), np.float64, (np.dtype(float),) * 2)
    assert [call.__name__ for call, _ in program.calls] == ["add", "multiply", "cast"]


def test_a_kernel_that_branches_is_refused():
    """It would be recorded for one case and replayed for all."""
    with pytest.raises(TypeError, match="select"):
        record(lambda x: (x if x > 0.0 else -x,), (), (None,), np.float64, (np.dtype(float),))


def test_what_cannot_be_replayed_is_refused():
    """Reductions and other numpy functions are no calls on one case."""
    for kernel in (lambda x: (np.add.reduce(x),), lambda x: (np.sort(x),)):
        with pytest.raises(TypeError):
            record(kernel, (), (None,), np.float64, (np.dtype(float),))


def scene(size, dtype=np.float64):
    """Cars that meet, every value an array."""
    rng = np.random.default_rng(size)

    def car(sign):
        return col.Vehicle(
            mass=rng.uniform(900.0, 2000.0, size).astype(dtype),
            yaw_inertia=rng.uniform(1500.0, 3500.0, size).astype(dtype),
            vx=(sign * rng.uniform(5.0, 20.0, size)).astype(dtype),
            vy=rng.normal(0.0, 1.0, size).astype(dtype),
            yaw_rate=rng.normal(0.0, 0.1, size).astype(dtype),
            x=(-sign * rng.uniform(1.0, 2.0, size)).astype(dtype),
            y=rng.normal(0.0, 0.5, size).astype(dtype),
        )

    return (
        car(1.0),
        car(-1.0),
        rng.uniform(0.0, 0.5, size).astype(dtype),
        rng.normal(0.0, 0.1, size).astype(dtype),
    )


@pytest.mark.slow
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(("rule", "law"), LAW_RULES)
def test_large_batches_hold_the_answers_of_small_ones(rule, law, dtype):
    """Blocks of any length have the same bits, and so have a few cases that are answered one by
    one.
    """
    a, b, e, normal = scene(2 * BLOCK + 5, dtype)
    options = {"point": (0.0, 0.1), rule: 0.2, "law": law, "on_failure": "nan"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.EnergyGainWarning)
        whole = col.eccentric(a, b, e, normal=normal, **options)
        for part in (slice(0, 100), slice(BLOCK - 50, BLOCK + 50), slice(2 * BLOCK, None)):
            cases = [
                body.replace(
                    **{
                        n: getattr(body, n)[part]
                        for n in ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y")
                    }
                )
                for body in (a, b)
            ]
            few = col.eccentric(*cases, e[part], normal=normal[part], **options)
            for mine, other in zip(whole._answer, few._answer, strict=True):
                assert mine.dtype == other.dtype
                np.testing.assert_array_equal(mine[part], other)


def test_refused_cases_touch_no_neighbour():
    """One case of each kind that is refused, in the middle of a block and at both its ends; the
    rest keeps its bits.
    """
    size = 2 * BLOCK + 9
    a, b, e, normal = scene(size)
    good = col.eccentric(a, b, e, normal=normal, point=(0.0, 0.1), friction=0.3)
    places = [0, 7, BLOCK - 1, BLOCK, size - 1]
    mass, vx, restitution = a.mass.copy(), a.vx.copy(), e.copy()
    mass[places[0]], mass[places[1]], vx[places[2]], vx[places[3]], restitution[places[4]] = (
        -1.0,
        np.nan,
        np.inf,
        -99.0,
        1.5,
    )
    bad = col.eccentric(
        a.replace(mass=mass, vx=vx),
        b,
        restitution,
        normal=normal,
        point=(0.0, 0.1),
        friction=0.3,
        on_failure="nan",
    )
    assert [bad.status[i] for i in places] == [
        col.Status.NOT_POSITIVE, col.Status.NOT_FINITE, col.Status.NOT_FINITE,
        col.Status.SEPARATING, col.Status.BAD_RESTITUTION,
    ]  # fmt: skip
    for mine, other in zip(list(bad._answer)[1:], list(good._answer)[1:], strict=True):
        np.testing.assert_array_equal(np.delete(mine, places), np.delete(other, places))
        if mine.dtype.kind == "f":
            assert np.isnan(mine[places]).all()


@pytest.mark.slow
def test_programs_are_shared_and_buffers_are_not():
    """The same program at once in several threads that the caller made."""
    a, b, e, normal = scene(3 * BLOCK)
    wanted = col.eccentric(a, b, e, normal=normal, point=(0.0, 0.1), friction=0.3)
    found = []
    threads = [
        threading.Thread(
            target=lambda: found.append(
                col.eccentric(a, b, e, normal=normal, point=(0.0, 0.1), friction=0.3, threads=2)
            )
        )
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4
    assert all(impact == wanted for impact in found)


def test_what_is_asked_for_later_is_the_same_impact():
    """The outputs worked out on request, after pickling, and those of an impact with refused cases,
    blank there too.
    """
    a, b, e, normal = scene(BLOCK + 1)
    e = np.where(np.arange(e.size) == 3, 2.0, e)
    impact = col.eccentric(a, b, e, normal=normal, point=(0.0, 0.1), friction=0.3, on_failure="nan")
    again = pickle.loads(pickle.dumps(impact))
    assert again == impact
    assert len(tuple(impact._answer)) == len(Answer._fields)
    assert impact._answer.slip_before is impact.slip_before
    assert not impact.slip_before.flags.writeable
    assert np.flatnonzero(np.isnan(impact.compression_impulse)).tolist() == [3]


@pytest.mark.parametrize("scratch", [1, 30, 114, 400])
@pytest.mark.parametrize("threads", [1, 2, 3, 8, 64])
def test_blocks_of_threads_are_even_and_their_scratch_is_bounded(threads, scratch):
    """No thread has two blocks more than another; together they take 6 MiB, or what blocks as short
    as those of one thread do.
    """
    for size in (BLOCK + 1, 3 * BLOCK + 17, 100_000, 1_000_000):
        length = block_length(size, threads, scratch)
        assert length >= BLOCK
        if threads == 1:
            assert length in (BLOCK, 2 * BLOCK)
            assert (length == 2 * BLOCK) == (2 * BLOCK * scratch <= 2**20)
        elif length > BLOCK:
            assert threads * scratch * length <= 6 * 2**20 + 64 * threads * scratch
            assert -(-size // length) % threads in (0, threads - 1)


@pytest.mark.parametrize("length", [0, 1, 1000, BLOCK])
def test_arrays_in_one_piece_of_memory(length):
    """None shares a byte with another; those of a block begin on a page, which halves the time of a
    call on them.
    """
    dtypes = [np.dtype(one) for one in (np.uint8, np.float64, np.float32, np.float64)]
    memory, arrays = slice_memory(length, dtypes)
    assert [(one.shape, one.dtype) for one in arrays] == [((length,), dtype) for dtype in dtypes]
    for at, one in enumerate(arrays):
        one.fill(at)
    assert all((one == at).all() for at, one in enumerate(arrays))
    assert all(one.ctypes.data % (4096 if length >= 1000 else 64) == 0 for one in arrays if length)
    assert slice_memory(length, dtypes[:2], memory)[0] is memory
    assert slice_memory(length + 4096, dtypes, memory)[0] is not memory


def test_spare_memory_that_another_thread_has_just_taken(monkeypatch):
    """A list that was not empty a moment ago, as it can be without a global lock, is empty when it
    is taken from.
    """

    class Emptied(list):
        def __bool__(self):
            return True

        def __len__(self):
            return 1

    monkeypatch.setattr("collisions.engine.replay._BUFFER_POOL", Emptied())
    program = record(
        lambda x, y: (x + y, x * y * x), (), (None, None), np.float64, (np.dtype(float),) * 2
    )
    inputs, outputs = (
        numbers(2, 30, np.float64, np.random.default_rng(3), odd=False),
        [np.empty(30), np.empty(30)],
    )
    replay(program, inputs, outputs)
    np.testing.assert_array_equal(
        outputs, [inputs[0] + inputs[1], inputs[0] * inputs[1] * inputs[0]]
    )


def test_outputs_are_scratch_until_they_are_written():
    """Values between stand in them: half of the buffers are saved."""
    program = record(
        FREE,
        (FRICTION, BRACH, 2.0**-52),
        (None,) * 20,
        np.float64,
        kinds(np.float64),
    )
    outputs, last = range(20, 20 + len(Answer._fields)), range(20 + len(Answer._fields) + 100)
    written = [chosen(last)[-1] for _, chosen in (*program.calls, *program.late)]
    assert sum(place in outputs for place in written) > 2 * len(Answer._fields)
    assert sum(dtype.itemsize == 8 for dtype in program.buffers) < 10


def test_a_root_is_recorded_as_numpy_takes_it():
    """A power of one half is a square root, to the bit."""

    def kernel(x, y):
        return x**0.5, (x * x) ** 0.5, y**3.0

    inputs = [
        abs(value) for value in numbers(2, 300, np.float64, np.random.default_rng(8), odd=True)
    ]
    outputs = [np.empty(300) for _ in range(3)]
    with np.errstate(all="ignore"):
        replay(
            record(kernel, (), (None, None), np.float64, (np.dtype(float),) * 3), inputs, outputs
        )
        for output, wanted in zip(outputs, kernel(*inputs), strict=True):
            np.testing.assert_array_equal(output, wanted)
