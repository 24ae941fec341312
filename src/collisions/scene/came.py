"""Which contacts came in each case of a scene, in order, and when."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..impact.impact import Impact

MOST_CONTACTS = 20


class Hit(NamedTuple):
    """One contact of some cases: which rule, when, the impact, whether it was at its deepest, and
    which impact of each case it is.
    """

    rule: int
    which: Any
    time: Any
    impact: Impact
    deepest: Any
    number: Any


class Came:
    """The contacts that came, case by case."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.hits: list[Hit] = []
        # The contacts of each case in order, and when they came; -1 and NaN after the last.
        self.rules: Any = np.full((MOST_CONTACTS, count), -1)
        self.times: Any = np.full((MOST_CONTACTS, count), np.nan)
        self.many: Any = np.zeros(count, dtype=int)

    def add(self, rule: int, which: Any, time: Any, impact: Impact, deepest: Any) -> None:
        """Keep a contact of some cases."""
        number = self.many[which]
        self.hits.append(Hit(rule, which, time, impact, deepest, number))
        self.rules[number, which], self.times[number, which] = rule, time
        self.many[which] += 1

    @property
    def at_deepest(self) -> Any:
        """Whether an impulse of each case acts at the deepest, before what was asked for."""
        found = np.zeros(self.count, dtype=bool)
        for hit in self.hits:
            found[hit.which] |= hit.deepest
        return found

    @property
    def most(self) -> int:
        """The number of contacts of the case that has most of them."""
        return int(self.many.max(initial=0))

    @property
    def longest(self) -> list[int]:
        """The contacts of a case that has most of them, in order."""
        found: list[int] = self.rules[: self.most, int(self.many.argmax())].tolist()
        return found

    @property
    def same_order(self) -> bool:
        """Whether the contacts of all cases come in one order, as far as they go."""
        longest = np.array(self.longest)[:, None]
        rules = self.rules[: self.most]
        return bool(np.all((rules == longest) | (rules < 0)))
