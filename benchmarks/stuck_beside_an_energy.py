"""How far a contact that slid must reach from one that stuck to count as another answer beside an
energy, measured: ``speeds`` from the components of one recorder, the energy lost and the friction.

``python benchmarks/stuck_beside_an_energy.py`` prints the tables and writes
docs/_generated/stuck_beside_an_energy.json, in a few minutes. ``--crashes N`` draws so many that
stuck and so many that slid, ``--json PATH`` writes there.

The crashes are those of ``stuck_beside_a_speed.py``, with the same errors of the readings; that of
the energy is twice as large, as it goes as the square of an impulse. The friction is the true one.
An answer is right where both speeds are.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import stuck_beside_a_speed as beside_a_speed

DATA = beside_a_speed.DATA.with_name("stuck_beside_an_energy.json")


class Crash(beside_a_speed.Crash):
    """One crash of which a recorder and the energy lost are read."""

    def off(self, answer: Any) -> float:
        """How far the worse of both speeds is from the truth, in m/s."""
        return max(
            abs(getattr(answer, label).before.speed - self.side(label).before.speed)
            for label in "ab"
        )

    def read(self, error: float) -> dict[str, Any]:
        """What ``speeds`` is given."""
        of, (forward, left, lost) = self.side(self.recorder), 1.0 + error * self.errors
        return {
            **self.known,
            f"delta_v_forward_{self.recorder}": float(of.delta_v_forward * forward),
            f"delta_v_left_{self.recorder}": float(of.delta_v_left * left),
            "energy_loss": float(self.impact.energy_loss * (2.0 * lost - 1.0)),
            "friction": self.impact.friction,
        }


def crashes(count: int = beside_a_speed.CRASHES) -> list[Crash]:
    """So many that stuck and so many that slid."""
    return [Crash(*one) for one in beside_a_speed.crashes(count)]


def load() -> beside_a_speed.Numbers:
    """What was written."""
    return beside_a_speed.load(DATA)


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crashes", type=int, default=beside_a_speed.CRASHES)
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    found = beside_a_speed.written(crashes(options.crashes), options.crashes, options.json)
    sys.stdout.write(beside_a_speed.table(found) + "\n")


if __name__ == "__main__":
    main()
