"""Parts of Markdown reports, and records and reports that were changed, for the tests that read
them.
"""

import json

GONE = object()  # stands for a part of a record that is taken out


def section(page, name):
    """The part of a Markdown page below a heading."""
    return page.split(f"\n## {name}\n")[1].split("\n## ")[0]


def tampered(page, change):
    """The page with its record changed by a function."""
    head, _, rest = page.partition("```json\n")
    record = json.loads(rest.partition("```")[0])
    change(record)
    return f"{head}```json\n{json.dumps(record)}\n```\n"


def put(record, path, value):
    """The record, in which one part is another value, or is not there: ``GONE``."""
    *above, last = path
    inside = record
    for key in above:
        inside = inside[key]
    if value is GONE:
        del inside[last]
    else:
        inside[last] = value
    return record
