"""Who should read the number in "80 km/h": pint, or float()?

    python design/numbers_in_texts.py

pint reads a text as an expression. So a slip of the pen is not an error but another number.

What it showed (pint 0.25.3): "80 km/h 5" is 400 km/h, "1 500 kg" is 500 kg, "1500 kg 2" is 3000 kg,
each without a word. A tower of powers runs until the machine gives up (not run here). Decided: one
plain number that float() reads, then one unit, which alone goes to pint; at most 60 characters; no
digit in the unit but a one-digit exponent.
"""

import pint
from measuring import col

TEXTS = (
    ("80 km/h", "vx"),
    ("80 km/h 5", "vx"),
    ("80 km/h +- 5", "vx"),
    ("50 - 60 km/h", "vx"),
    ("1 500 kg", "mass"),
    ("1500 kg 2", "mass"),
)


def result(call):
    """What a call gives, or the first line of its refusal."""
    try:
        return str(call())
    except Exception as error:
        return f"{type(error).__name__}: {str(error).splitlines()[0][:70]}"


if __name__ == "__main__":
    ureg = pint.get_application_registry()
    for text, field in TEXTS:
        print(f"{text!r}")
        print(f"  pint:    {result(lambda text=text: ureg.Quantity(text))}")

        def read(text=text, field=field):
            return getattr(col.Vehicle(**{"mass": 1500.0, field: text}), field)

        print(f"  Vehicle: {result(read)}")
