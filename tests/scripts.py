"""The scripts of ``benchmarks/``, which are no package, as modules."""

import importlib
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

FOLDER = Path(__file__).resolve().parent.parent / "benchmarks"


def benchmarks(*names: str) -> Any:
    """One script by its name, or several in their order."""
    sys.path.insert(0, str(FOLDER))
    try:
        found: list[ModuleType] = [importlib.import_module(name) for name in names]
    finally:
        sys.path.remove(str(FOLDER))
    return found[0] if len(found) == 1 else tuple(found)
