"""What Python cannot read, where it is an equation, a product, a unit or a sign from a book: what to write."""

from __future__ import annotations

import re
from typing import Any

from .own_line import ours

EQUATION = "Python's = names a value, and == compares at once. Write an equation as sp.Eq(left side, right side)."
PRODUCT = "Python needs the sign of each multiplication: write 2*k for 2k, and k*x(n) for k x(n)."
QUANTITY = "A quantity with its unit is a text: write '10 mm', with quotes, or the number alone in SI units."
SIGNS = {
    "≤": "<=",
    "≥": ">=",
    "≠": "sp.Ne(a, b)",
    "²": "**2",
    "³": "**3",
    "·": "*",
    "×": "*",
    "−": "-",
    "½": "1/2",
    "°": "'30 deg'",
}
#: a number and a unit, and a number or a closed bracket and a name, without a sign between
WITH_UNIT = r"(?<![\w'\"])\d[\d.]*\s*(?:mm|cm|m|um|N|kg|g|ms|us|s|Hz|deg|rad)\b"
SIDE_BY_SIDE = r"(?<![\w'\"])(?:\d[\d.]*\s*[A-Za-z(]|[A-Za-z_]\w*\s+[A-Za-z_]\w*\s*\()"


def unreadable(problem: SyntaxError, source: str, known: dict[str, Any]) -> str:
    """The sentence about a cell that Python could not read; empty where none fits, or nothing of hapticlab's is in it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> try:
    ...     compile("2k", "cell", "eval")
    ... except SyntaxError as problem:
    ...     print(unreadable(problem, "2k", {"k": hl.parameters("k", units="N/m")}))
    Python needs the sign of each multiplication: write 2*k for 2k, and k*x(n) for k x(n).
    """
    if not any(ours(known.get(name)) for name in re.findall(r"(?<![^\W\d])[^\W\d]\w*", source)):
        return ""
    said, line = str(problem.msg), problem.text or ""
    if "'=='" in said or '"=="' in said:
        return EQUATION
    if sign := re.search("invalid character '(.)'", said):
        return f"Python does not know the sign {sign[1]}. Write {SIGNS[sign[1]]}." if sign[1] in SIGNS else ""
    if "invalid" in said and re.search(WITH_UNIT, line):
        return QUANTITY
    return PRODUCT if "invalid" in said and re.search(SIDE_BY_SIDE, line) else ""
