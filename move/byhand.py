# Run by move.py within its own names: changes of mechanism and of hand-written text, each of which says when it finds no place.


def edit(path, old, new, optional=False, regex=False):
    if path not in contents:
        problem(f"by hand: no file {path}")
        return
    text = contents[path]
    if (re.search(old, text, re.MULTILINE | re.DOTALL) if regex else old in text) in (None, False):
        if not optional:
            problem(f"by hand: {path} has no {old[:70]!r}")
        return
    contents[path] = re.sub(old, new, text, count=1, flags=re.MULTILINE | re.DOTALL) if regex else text.replace(old, new)


# The compiled loop of a contact in time is handed in: kernels import nothing of the engine.
KERNEL = "src/collisions/kernels/time_resolved.py"
edit(
    KERNEL,
    r"^def _loop\(settings: tuple\[Any, \.\.\.\]\) -> [^\n]*:\n    from [\w.]+ import compile_loop\n\n",
    'def _loop(compiled: Callable[..., Any], settings: tuple[Any, ...]) -> Any:\n',
    regex=True,
)
edit(KERNEL, "    return compile_loop(advance, _FIXED, _MOVING, settings)", "    return compiled(advance, _FIXED, _MOVING, settings)")

def hand_in(name, said):
    """The parameter ``compiled`` of a way to run, in its signature and its docstring."""
    edit(
        KERNEL,
        rf'def {name}\(settings: Settings\) -> Run:\n    """([^"]*?)\.?"""',
        rf'def {name}(settings: Settings, compiled: Callable[..., Any]) -> Run:\n    """\1; ``compiled`` {said}."""',
        regex=True,
    )


LOOP = "makes a loop of floats from a step"
RUNS = ["float_run"]
# A block that ends case by case needs the loop too.
if "float_run(settings)" in contents[KERNEL]:
    edit(KERNEL, "float_run(settings)", "float_run(settings, compiled)")
    RUNS.append("block_run")
for run in RUNS:
    hand_in(run, LOOP)
edit(KERNEL, "_loop((", "_loop(compiled, (")
TIMED = "src/collisions/contact_time.py"
for run in RUNS:
    edit(TIMED, f"run=kernel.{run}", f"run=partial(kernel.{run}, compiled=compile_loop)")
edit(
    TIMED,
    "    # A twentieth of the import of the package, and impulses need none of it.\n",
    "    # A twentieth of the import of the package, and impulses need none of it.\n    from ..engine.floats import compile_loop\n",
)
if len(RUNS) > 1:
    edit(
        TIMED,
        r"(^def solve_cases_in_time\(.*?)(    from \.\.kernels import time_resolved as kernel\n)",
        r"\1    from ..engine.floats import compile_loop\n\2",
        regex=True,
    )
LADDER = "benchmarks/ladder.py"
edit(LADDER, "run=float_run", "run=partial(float_run, compiled=compile_loop)")
edit(LADDER, "from pathlib import Path\n", "from functools import partial\nfrom pathlib import Path\n")
edit(LADDER, "from collisions.kernels.contact_step", "from collisions.engine.floats import compile_loop\nfrom collisions.kernels.contact_step")
for path, text in contents.items():
    # Whoever else steps through a case has to hand the loop in.
    if path not in (KERNEL, TIMED, LADDER) and re.search(r"run=\S*(float|block)_run", text):
        problem(f"by hand: {path} steps through cases: hand compile_loop in")
edit(TIMED, "from __future__ import annotations\n", "from __future__ import annotations\n\nfrom functools import partial\n")

# Strict JSON knows numbers, and records what an impact is made of.
RECORDS = "src/collisions/records.py"
edit(
    RECORDS,
    """    if isinstance(value, ModelChoice):
        return {name: strict(getattr(value, name)) for name in _CHOICE}
    if isinstance(value, (Reconstruction, Pulse)):
        return {f.name: strict(getattr(value, f.name)) for f in fields(value)}
""",
    "",
)
edit(
    RECORDS,
    "def strict(value: Any) -> Any:\n",
    '''def _result(value: Any) -> Any:
    """A result as strict JSON: a choice, a reconstruction and a pulse by their parts."""
    if isinstance(value, ModelChoice):
        return {name: strict(getattr(value, name)) for name in _CHOICE}
    if isinstance(value, (Reconstruction, Pulse)):
        return {f.name: strict(getattr(value, f.name)) for f in fields(value)}
    return strict(value)


def strict(value: Any) -> Any:
''',
)
edit(RECORDS, "results = {name: strict(value) for name, value in _results(impact)}", "results = {name: _result(value) for name, value in _results(impact)}")
edit(RECORDS, "**{name: strict(value) for name, value in _results(side)}", "**{name: _result(value) for name, value in _results(side)}")

# Files beside a module.
edit(
    "src/collisions/__main__.py",
    '_TEMPLATE, _US_TEMPLATE = (Path(__file__).with_name(name) for name in ("case_template.toml", "case_template_us.toml"))',
    '_CASES = Path(__file__).with_name("cases")\n_TEMPLATE, _US_TEMPLATE = _CASES / "case_template.toml", _CASES / "case_template_us.toml"',
)
edit("src/collisions/what_if_page.py", '"what_if_page.html"', '"what_if.html"')

# The public names, and the module of each.
ROOT_INIT = "src/collisions/__init__.py"
for rel, now in final.items():
    if rel.endswith(".py") and "/" not in rel and rel != now:
        stem, dots = rel[:-3], now[:-3].replace("/", ".")
        contents[ROOT_INIT] = re.sub(rf'(": |\), ){chr(34)}{stem}"', rf'\1"{dots}"', contents[ROOT_INIT])

# Tests that look at files.
edit("tests/test_printers.py", 'Path(collisions.__file__).parent / "kernels"', 'Path(collisions.__file__).parent / "engine"')
edit("tests/test_what_if.py", 'Path(what_if_page.__file__).with_name("case_template.toml")', 'Path(what_if_page.__file__).parents[1] / "cases" / "case_template.toml"')
edit("tests/test_reporting.py", "import sys; sys.path.insert(0, 'tests'); import test_reporting as t", "import sys; sys.path.insert(0, 'tests'); from reporting import test_reporting as t")
edit("tests/test_architecture.py", '''    assert found["units"] == {"errors"}  # its other imports are of numpy and pint
    assert "kernels" in found["errors"]  # from .kernels.status import Status
    assert "records" in found["impact"]  # inside its methods
    assert found["kernels"] == set()
''', '''    assert found["messages"] == {"kernels"}  # from ..kernels.status import Status
    assert "diagnostics" in found["reporting"]
    assert "engine" in found["impact"]  # inside its functions
    assert found["kernels"] == set()
''')
edit("tests/test_architecture.py", '''    homes = (ROOT, ROOT / "src" / "collisions", ROOT / "tests")''', '''    homes = (ROOT, ROOT / "src" / "collisions", ROOT / "tests")''')

# pyproject: the rooms in their layers, the highest first.
CONTRACT = '''[tool.importlinter]
root_package = "collisions"
exclude_type_checking_imports = true

[[tool.importlinter.contracts]]
name = "imports run one way, kernels at the bottom"
type = "layers"
containers = ["collisions"]
exhaustive = true
layers = [
    "__main__",
    "cases",
    "reporting",
    "plot | diagnostics | derivation",
    "reconstruct",
    "estimate | impact",
    "travel | uncertainty",
    "vehicle | reference",
    "quantities",
    "messages | engine",
    "kernels",
]

[[tool.importlinter.contracts]]
name = "kernels know neither units nor vehicles"
type = "forbidden"
source_modules = ["collisions.kernels", "collisions.engine"]
forbidden_modules = ["collisions.messages", "collisions.quantities", "collisions.vehicle", "collisions.impact"]
'''
edit("pyproject.toml", r"^\[tool\.importlinter\].*\Z", CONTRACT.replace("\\", "\\\\"), regex=True)

# Errors are shown, and pickled, by the name under which callers import them.
edit(
    "src/collisions/errors.py",
    """    def __reduce__(self) -> tuple[Any, ...]:
""",
    """    def __init_subclass__(cls) -> None:
        if cls.__module__ == __name__:
            # Tracebacks show the name that callers import, and pickles hold it.
            cls.__module__ = __name__.partition(".")[0]

    def __reduce__(self) -> tuple[Any, ...]:
""",
)

for path in [path for path in contents if path.startswith("tests/")]:
    contents[path] = contents[path].replace('"collisions" / "case_template', '"collisions" / "cases" / "case_template')

# The map.
edit(
    "docs/architecture.md",
    "\n- **Units are converted once, when arguments are read.**",
    """
`kernels/` has the formulas, and `engine/` what makes them quick. `messages/` and `quantities/` are what a caller is told and gives.
`vehicle/`, `impact/` and `travel/` are what happens; `reconstruct/` goes backwards in closed form, `uncertainty/` says how certain an
answer is, and `estimate/` weighs evidence. `derivation/`, `diagnostics/`, `plot/` and `reporting/` show an answer, `reference/` has
published values, and `cases/` reads case files. `tests/` has the same folders, and `docs/` and `project/` for what is of no one of them.

- **Units are converted once, when arguments are read.**""",
)

# Two circles among the benchmarks: what both files need stands in a third, and who draws asks the file that draws.
edit("benchmarks/uncertainty_tables.py", "from uncertainty_figures import draw_all\n", "")
edit("benchmarks/uncertainty_tables.py", '__all__ = ["draw_all"]\n', "", optional=True)
edit("benchmarks/uncertainty.py", "    import uncertainty_tables\n", "    import uncertainty_figures\n    import uncertainty_tables\n")
edit("benchmarks/uncertainty.py", "uncertainty_tables.draw_all(", "uncertainty_figures.draw_all(")
edit("tests/test_uncertainty_page.py", "        import uncertainty_tables\n", "        import uncertainty_figures  # noqa: F401\n        import uncertainty_tables\n")
edit("tests/test_uncertainty_page.py", "    scripts[3].draw_all(committed, tmp_path)", "    sys.modules[\"uncertainty_figures\"].draw_all(committed, tmp_path)")


def import_times():
    """benchmarks/import_times.py out of speed.py, which budgets.py needs too."""
    names = {"Times", "ratio", "MODULES", "TIMED", "imports", "_imports"}
    text = contents["benchmarks/speed.py"]
    lines = text.splitlines()
    every = spans(text)
    chosen = [(node, a, b) for node, a, b in every if defines(node) and defines(node) <= names]
    if names - {name for node, *_ in chosen for name in defines(node)}:
        return problem("by hand: benchmarks/speed.py has not all of " + ", ".join(sorted(names)))
    heads = [
        "\n".join(lines[a - 1 : b])
        for node, a, b in every
        if isinstance(node, (ast.Import, ast.ImportFrom)) and "budgets" not in ast.unparse(node) and "collisions" not in ast.unparse(node)
    ]
    root = [
        "\n".join(lines[a - 1 : b])
        for node, a, b in every
        if "ROOT" in defines(node) or (isinstance(node, ast.If) and "sys.path" in ast.unparse(node))
    ][:2]
    future = [one for one in heads if "__future__" in one]
    body = "\n\n\n".join("\n".join(lines[a - 1 : b]) for _, a, b in chosen)
    added["benchmarks/import_times.py"] = (
        '"""The time of an import, against that of numpy, each in a process of its own; and ratios of times."""\n\n'
        + "\n".join([*future, "", *(one for one in heads if one not in future and "speed_" not in one and "import " in one and not re.search(r"import (batch_speed|ladder|time_resolved)", one))])
        + "\n\n" + "\n".join(root) + "\n\nimport speed_errors\nimport speed_rivals\n\n" + body + "\n"
    )
    gone = {n for _, a, b in chosen for n in range(a, b + 1)}
    left = "\n".join(line for at, line in enumerate(lines, 1) if at not in gone) + "\n"
    contents["benchmarks/speed.py"] = left.replace("import ladder\n", "import ladder\nfrom import_times import MODULES, TIMED, Times, imports, ratio\n", 1)
    edit("benchmarks/budgets.py", "        import speed\n", "        import import_times\n")
    edit("benchmarks/budgets.py", "speed.imports(", "import_times.imports(")


import_times()
