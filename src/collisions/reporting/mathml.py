"""``mathml``: the formulas of a derivation, written in LaTeX, as MathML, which browsers show and
print by themselves.

It reads what ``derivation`` writes and no other LaTeX.
"""

from __future__ import annotations

import re
from html import escape

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|[A-Za-z]+|\S| +", re.DOTALL)
_GREEK = {
    "alpha": "α",
    "chi": "χ",
    "Delta": "Δ",
    "kappa": "κ",
    "mu": "μ",
    "omega": "ω",
    "pi": "π",
    "psi": "ψ",
    "sigma": "σ",
    "theta": "θ",
    "varphi": "φ",
}
_SIGNS = {"cdot": "·", "lvert": "|", "rvert": "|", "int": "∫"}
_SPACES = {",": "0.17em", " ": "0.35em"}
_ALIGNED = re.compile(r"^\s*\\begin\{aligned\}(.*)\\end\{aligned\}\s*$", re.DOTALL)


def mathml(latex: str) -> str:
    """One formula as MathML; lines below each other as a table, aligned at their first sign.

    What cannot be read stays as it was written, in typewriter letters.
    """
    aligned = _ALIGNED.match(latex)
    try:
        if aligned is None:
            return f'<math displaystyle="true">{_Reader(latex).whole()}</math>'
        lines = (line.split("&", 1) for line in aligned[1].split("\\\\\n"))
        rows = ("".join(f"<mtd>{_Reader(part).whole()}</mtd>" for part in line) for line in lines)
        table = "\n".join(f"<mtr>{row}</mtr>" for row in rows)
        return f'<math displaystyle="true"><mtable displaystyle="true">{table}</mtable></math>'
    except (KeyError, IndexError):
        return f"<code>{escape(latex.strip())}</code>"


class _Reader:
    """Reads the tokens of one formula."""

    def __init__(self, latex: str) -> None:
        self._tokens: list[str] = [
            token for token in _TOKEN.findall(latex.strip()) if token.strip()
        ]
        self._at = 0

    def whole(self) -> str:
        """The formula to its end."""
        return self._until("")

    def _next(self) -> str:
        return self._tokens[self._at] if self._at < len(self._tokens) else ""

    def _take(self) -> str:
        token = self._tokens[self._at]
        self._at += 1
        return token

    def _until(self, end: str, roman: bool = False) -> str:
        parts = []
        while self._next() != end:
            parts.append(self._with_scripts(roman))
        if end:
            self._take()
        return "".join(parts)

    def _with_scripts(self, roman: bool) -> str:
        """One part with its index, its prime and its power."""
        base, below, above = self._part(roman), "", ""
        while self._next() in ("_", "^", "'"):
            sign = self._take()
            if sign == "'":
                above += "<mo>′</mo>"
            elif sign == "_":
                below += self._part(roman)
            else:
                above += self._part(roman)
        below, above = (f"<mrow>{part}</mrow>" if part else "" for part in (below, above))
        if below and above:
            return f"<msubsup>{base}{below}{above}</msubsup>"
        if below:
            return f"<msub>{base}{below}</msub>"
        return f"<msup>{base}{above}</msup>" if above else base

    def _part(self, roman: bool) -> str:
        token = self._take()
        if token[0] == "\\":
            return self._command(token[1:], roman)
        if token == "{":
            return f"<mrow>{self._until('}', roman)}</mrow>"
        if token[0].isdigit():
            return f"<mn>{token}</mn>"
        if token[0].isalpha():
            if roman:
                return f'<mi mathvariant="normal">{token}</mi>'
            self._give_back(token[1:])
            return f"<mi>{token[0]}</mi>"
        kind = "mtext" if roman else "mo"
        return f"<{kind}>{escape(token.replace('-', '−'))}</{kind}>"

    def _give_back(self, letters: str) -> None:
        """Letters behind the first one of a token, each of which is a symbol of its own."""
        if letters:
            self._at -= 1
            self._tokens[self._at] = letters

    def _group(self, roman: bool = False) -> str:
        if self._take() != "{":
            raise KeyError("a group")
        return f"<mrow>{self._until('}', roman)}</mrow>"

    def _command(self, name: str, roman: bool) -> str:
        if name in _SPACES:
            return f'<mspace width="{_SPACES[name]}"></mspace>'
        if name in _GREEK:
            return f"<mi>{_GREEK[name]}</mi>"
        if name in _SIGNS:
            return f"<mo>{_SIGNS[name]}</mo>"
        if name in ("cos", "sin"):
            return f"<mi>{name}</mi><mo>&#x2061;</mo>"
        if name == "circ":
            return "<mo>°</mo>"
        if name == "left":
            opening = escape(self._take())
            inside = self._until("\\right")
            return f"<mrow><mo>{opening}</mo>{inside}<mo>{escape(self._take())}</mo></mrow>"
        if name == "frac":
            return f"<mfrac>{self._group(roman)}{self._group(roman)}</mfrac>"
        if name == "sqrt":
            return f"<msqrt>{self._group(roman)}</msqrt>"
        if name == "bar":
            return f'<mover accent="true">{self._group(roman)}<mo stretchy="false">¯</mo></mover>'
        if name in ("mathrm", "operatorname"):
            return self._group(roman=True)
        raise KeyError(name)
