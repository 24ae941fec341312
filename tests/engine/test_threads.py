"""What is made at its first use is made once: eight threads of a fresh process find the same at
once, and no error.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import collisions as col
from collisions.quantities.attributes import Derived

HEAD = """
import json, sys, threading
import collisions as col
from collisions.uncertainty import Normal, propagate

THREADS = 8
texts = {"mass": "1500 kg", "vx": "40 mph", "yaw_inertia": "2500 kg*m**2", "x": "-2 m", "y": "0 \
m", "heading": "0 deg"}
others = {"mass": "2900 lb", "vy": "30 km/h", "yaw_inertia": "1500 slug*ft**2", "x": "2 m", "y": \
"1 ft", "heading": "90 deg"}
contact = {"restitution": 0.1, "normal": "0 deg", "point": ("0 m", "0 m"), "friction": 0.5}
start, found = threading.Barrier(THREADS), [None] * THREADS
sys.setswitchinterval(1e-5)


def at_once(work):
    def run(at):
        start.wait()
        try:
            found[at] = work(at)
        except BaseException as error:
            found[at] = f"{type(error).__name__}: {error}"

    threads = [threading.Thread(target=run, args=(at,)) for at in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def solved():
    return col.eccentric(col.Vehicle(**texts), col.Vehicle(**others), **contact)
"""
# By name, what every thread does first of all in a process.
FIRST = {
    "units": "at_once(lambda at: repr(col.Vehicle(**texts)))",
    "quantities": "at_once(lambda at: str(col.Vehicle(mass=1500.0, vx=20.0).q.vx.to('mph')))",
    "public names": """
names = col.__all__
at_once(lambda at: sorted(repr(getattr(col, name)) for name in names[at:] + names[:at]))
""",
    "compiled kernels": """
def work(at):
    a, b = col.Vehicle(**texts), col.Vehicle(**others)
    return solved().to_dict(), str(col.required_model(a, b, 0.1, normal=0.0, point=(0.0, 0.0), \
friction=0.5))
at_once(work)
""",
    "a step in time": """
def work(at):
    return col.time_resolved(col.Vehicle(**texts), col.Vehicle(**others), **contact, \
duration="0.1 s").to_dict()
at_once(work)
""",
    "recorded programs": """
import numpy as np
masses = np.linspace(1000.0, 2000.0, 5000)
def work(at):
    found = col.eccentric(col.Vehicle(**{**texts, "mass": masses}), col.Vehicle(**others), \
**contact)
    return [float(one).hex() for one in found.a.delta_v[::500]]
at_once(work)
""",
    "one answer": """
one = solved()
at_once(lambda at: (one.a.delta_v, one.energy_loss, str(one.summary()), str(col.explain(one)), \
str(col.diagnose(one))))
""",
    "a study in threads": """
def model(speed):
    return {"found": col.linear_central(col.Vehicle(mass="1500 kg", vx=speed), \
col.Vehicle(mass="2900 lb"), 0.1).a.q.delta_v}
known = {"speed": Normal(20.0, 1.0)}
at_once(lambda at: propagate(model, known, method="quasi_random", samples=4096, seed=1, \
threads=8)["found"].mean)
""",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FIRST)
def test_threads_of_a_fresh_process(name):
    """All threads find the same, that of one thread alone, and none an error of a registry that is
    half loaded.
    """
    source = f"{HEAD}\n{FIRST[name]}\nprint(json.dumps([str(one) for one in found]))"
    paths = os.pathsep.join(
        [str(Path(col.__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])]
    )
    done = subprocess.run(
        [sys.executable, "-c", source],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
        env={**os.environ, "PYTHONPATH": paths},
    )
    found = json.loads(done.stdout)
    assert len(set(found)) == 1, found[:2]
    assert "Error: " not in found[0], found[0]
    assert found[0] not in ("", "None", "nan")


def test_an_attribute_worked_out_twice_is_one_object():
    """Where a second thread has kept its own in the meantime, that one is given."""

    class Owner:
        times = 0

    def work_out(owner):
        owner.times += 1
        if owner.times == 1:
            owner.seen = parts.__get__(
                owner
            )  # as another thread does it, between the start and the end
        return [owner.times]

    work_out.__name__ = "parts"
    parts, owner = Derived(None, work_out), Owner()
    assert parts.__get__(owner) is owner.seen is vars(owner)["parts"]
