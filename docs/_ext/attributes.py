"""Names, units and meanings read from the package itself: for the API pages and for the tables of
the executed pages.
"""

import inspect
import re

from collisions.quantities.attributes import attributes, unit_of
from collisions.quantities.printed_tables import Part, in_markdown


def pretty(unit):
    """A unit as it is printed; a label or an object has none."""
    if unit is None:
        return "none"
    return re.sub(r"\*\*2", "²", unit).replace("*", "·") or "1"


def sentence(member):
    """The first sentence of a docstring, without the unit that has a column of its own."""
    text = " ".join((inspect.getdoc(member) or "").split("\n\n")[0].split())
    text = re.sub(r" \[[^\]]*\]", "", text)
    return re.split(r"(?<=[.;]) ", text.strip())[0].rstrip(".;")


def escaped(text):
    return text.replace("|", r"\|").replace("*", r"\*")


def rows(header, lines):
    """A Markdown table."""
    return in_markdown(Part(list(lines), columns=tuple(header)))


def attribute_table(kind, prefix=""):
    """Every worked-out attribute of a class: name, unit, meaning."""
    path = (
        f"{kind.__module__}.{kind.__name__}"
        if kind.__name__ == "VehicleResult"
        else f"collisions.{kind.__name__}"
    )
    return rows(
        ("attribute", "unit", "meaning"),
        (
            (
                f"{{py:attr}}`{prefix}{name} <{path}.{name}>`",
                pretty(unit_of(kind, name)),
                escaped(sentence(vars(kind)[name])),
            )
            for name in attributes(kind)
        ),
    )


def names_table(module):
    """Every public name of a module, with the first sentence of what it says of itself; constants
    share a line below.
    """
    constants = [name for name in module.__all__ if name.isupper()]
    listed = [
        (f"`{name}`", escaped(sentence(getattr(module, name))))
        for name in module.__all__
        if name not in constants
    ]
    below = (
        "\n\nConstants: " + ", ".join(f"`{name}`" for name in constants) + "." if constants else ""
    )
    return (
        f"**`from {module.__name__} import ...`**\n\n"
        + rows(("name", "what it is"), listed)
        + below
    )


def add_unit(app, what, name, obj, options, lines):
    """Say the unit of a worked-out attribute, which it carries."""
    if isinstance(unit := getattr(obj, "unit", None), str):
        while lines and not lines[-1].strip():
            lines.pop()
        lines += ["", f"Unit: {pretty(unit)}", ""]


def hide_sentinel(app, what, name, obj, options, signature, returns):
    """An argument that may be left out, and whose default is an object that says so, is shown with
    three dots.
    """
    return (signature.replace("<object object>", "..."), returns) if signature else None


def setup(app):
    app.connect("autodoc-process-signature", hide_sentinel)
    app.connect("autodoc-process-docstring", add_unit, priority=900)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
