"""Compares a program with the test vectors: ``python read.py mine.py``.

mine.py has ``solve(impact)``, which gets one impact as it stands in impacts.json and
gives its answers by the same names, nested alike, as one number or a list of them; or
None for an impact that it does not take.
"""

import json
import math
import runpy
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def misses(found, answer, place=""):
    """Each answer that is missing or off, with its error and what is allowed."""
    for name, wanted in answer.items():
        got = found.get(name)
        if isinstance(wanted, str) or got is None:
            if got != wanted:
                yield f"{place}{name} is {got}, not {wanted}"
        elif isinstance(wanted, dict):
            yield from misses(got, wanted, f"{place}{name}.")
        else:
            *numbers, allowed = wanted
            got = got if isinstance(got, list) else [got]
            error = math.dist(got, numbers)
            if name == "pdof":  # a direction: the short way round
                error = abs(math.remainder(error, math.tau))
            if not error <= allowed:
                yield f"{place}{name} is off by {error:.2g}, of {allowed:.2g} allowed"


if __name__ == "__main__":
    solve = runpy.run_path(sys.argv[1])["solve"]
    text = (HERE / "impacts.json").read_text(encoding="utf-8")
    compared = wrong = 0
    for impact in json.loads(text)["impacts"]:
        found = solve({name: impact[name] for name in impact if name != "answer"})
        if found is not None:
            compared += 1
            for miss in misses(found, impact["answer"]):
                wrong += 1
                print(f"impact {impact['id']}: {miss}")
    print(f"{compared} impacts compared, {wrong} answers off")
    sys.exit(1 if wrong or not compared else 0)
