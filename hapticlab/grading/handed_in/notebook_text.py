"""From the bytes of a notebook or a script to the sources of its code cells, as text; nothing of it is run or read as Python."""

import codecs
import json

from ...errors import CourseError
from ..inside.source_lines import statements

#: lists and dicts take more memory than they have bytes
MOST_CONTAINERS, MOST_CODE, MOST_CELLS = 500_000, 4_000_000, 2000
#: of a script, which is taken apart line by line
MOST_SCRIPT = 500_000
#: of the blank lines that keep the statements of a script on the lines they have in it
MOST_BLANK = 1_000_000
MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


def notebook_cells(raw):
    r"""Return the sources of the code cells of a notebook, of any version.

    Raises
    ------
    CourseError
        Where it is none, or larger than a notebook is.

    Examples
    --------
    >>> notebook_cells(b'{"cells": [{"cell_type": "code", "source": ["k = 2\\n", "b = 1"]}]}')
    ('k = 2\nb = 1',)
    """
    if raw.count(b"[") + raw.count(b"{") > MOST_CONTAINERS:
        raise CourseError("has far too many parts for a notebook; clear its outputs and save it again")
    try:
        # only texts are wanted: a whole number of a million digits would take minutes
        notebook = json.loads(decoded(raw), parse_int=len)
        sheets = notebook.get("worksheets")  # version 3
        cells = [cell for sheet in sheets for cell in sheet["cells"]] if sheets else notebook["cells"]
        sources = [_source(cell) for cell in cells if isinstance(cell, dict) and cell.get("cell_type") == "code"]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise CourseError("is not a notebook; it needs the JSON that Jupyter writes") from None
    return _bounded(sources)


def script_cells(raw):
    r"""Return the statements of a script, so that one that raises loses none after it; each on the lines it has there.

    Examples
    --------
    >>> script_cells(b"import math\n\n# %%\nk = (1 +\n  2)\n")
    ('import math\n', '\n\n# %%\nk = (1 +\n  2)\n')
    """
    text = decoded(raw).replace("\r\n", "\n").replace("\r", "\n")
    if len(text) > MOST_SCRIPT:
        raise CourseError(f"has more code than any lab: at most {MOST_SCRIPT} characters")
    parts, cells, line = statements(text), [], 0
    if len(parts) > MOST_CELLS or len(parts) * text.count("\n") > MOST_BLANK:
        return _bounded([text])
    for part in parts:
        cells.append("\n" * line + part)
        line += part.count("\n")
    return _bounded(cells)


def decoded(raw):
    """Return the text of bytes in the encodings that editors write; what is none of them is read as Latin-1."""
    encoding = next((name for mark, name in MARKS.items() if raw.startswith(mark)), None)
    if encoding is None and raw[:2].count(0) == 1:  # UTF-16 without its mark: the first character is ASCII
        encoding = "utf-16-be" if raw[0] == 0 else "utf-16-le"
    try:
        return raw.decode(encoding or "utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _source(cell):
    """Return the source of a cell, a text or a list of lines; of a cell without one, nothing."""
    source = cell.get("source", cell.get("input", ""))
    lines = source if isinstance(source, list) else [source]
    return "".join(line for line in lines if isinstance(line, str))


def _bounded(sources):
    if sum(map(len, sources)) > MOST_CODE + MOST_BLANK or len(sources) > MOST_CELLS:
        raise CourseError(f"has more code than any lab: at most {MOST_CELLS} cells and {MOST_CODE} characters")
    if not any(source.strip() for source in sources):
        raise CourseError("contains no code; was it saved?")
    return tuple(sources)
