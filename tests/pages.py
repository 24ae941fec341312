"""Parts of Markdown reports, and reports whose record was changed, for the tests that read them."""

import json


def section(page, name):
    """The part of a Markdown page below a heading."""
    return page.split(f"\n## {name}\n")[1].split("\n## ")[0]


def tampered(page, change):
    """The page with its record changed by a function."""
    head, _, rest = page.partition("```json\n")
    record = json.loads(rest.partition("```")[0])
    change(record)
    return f"{head}```json\n{json.dumps(record)}\n```\n"
