"""Work whose names, texts and archives attack who reads a report: pages, spreadsheets, terminals, folders."""

import io
import zipfile

from .attack import Attack, attack, file
from .small_lab import HONEST, notebook

_SCRIPT = "<script>alert(1)</script><img src=x onerror=alert(2)>"
_FORMULA = '=HYPERLINK("http://example.invalid";"click")'


def _zipped(*entries):
    """Return the bytes of a zip of (name, bytes)."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries:
            archive.writestr(name, content)
    return made.getvalue()


def _link(name, target):
    entry = zipfile.ZipInfo(name)
    entry.create_system, entry.external_attr = 3, 0o120777 << 16
    return entry, target


_NOTEBOOK = notebook(HONEST.values())
_BOMB = b"#" + b" " * (40 << 20)
ATTACKS = (
    attack("html_in_a_problem", force=f"def force(x, k):\n    raise ValueError({_SCRIPT!r})"),
    attack("html_in_print", force=f"def force(x, k):\n    print({_SCRIPT!r})\n    return 1.0"),
    attack(
        "html_in_values",
        force=f"def force(x, k):\n    return {_SCRIPT!r}",
        why=f"why = {_SCRIPT!r}",
        stiffness=f"stiffness = {_SCRIPT!r}",
    ),
    attack("html_in_keys", force=f"def force(x, k):\n    return {{{_SCRIPT!r}: 1.0}}"),
    attack("html_in_a_class", force=f"force = type({_SCRIPT!r}, (), {{}})()"),
    attack("html_in_arguments", force="def force(**k):\n    return 1.0\nforce.__signature__ = '</pre>' "),
    attack("html_in_notes", guess=f"guess = {_SCRIPT!r}", discussion=f"discussion = {_SCRIPT * 3!r}", force="force = 1"),
    attack("html_in_a_cell", first=f"raise ValueError({_SCRIPT!r})", force="force = 0"),
    attack("svg_in_values", forces="def forces(x, k):\n    return [1e308, -1e308, 5e-324][:len(x)] + [0.0] * (len(x) - 3)"),
    attack("formula_in_a_problem", force=f"def force(x, k):\n    raise ValueError({_FORMULA!r})"),
    attack("formula_in_values", why=f"why = {_FORMULA!r}", guess=f"guess = {_FORMULA!r}"),
    attack("formula_first_of_all", discussion="discussion = '@SUM(1+1)*cmd|A0 and three words'", force="force = '+1+1'"),
    attack(
        "escape_sequences",
        force="def force(x, k):\n    print('\\x1b[2J\\x1b]0;owned\\x07\\x9b31m\\r\\x08')\n    raise ValueError('\\x1b[31m red')",
    ),
    attack(
        "bidirectional",
        force="def force(x, k):\n    print('\\u202e\\u2066\\u200b')\n    raise ValueError('\\u202eevil')",
        why="why = '\\u202ea'",
    ),
    attack(
        "nul_and_surrogates",
        force="def force(x, k):\n    print('\\0\\ud800\\udfff')\n    raise ValueError('\\0\\udc80')",
        why="why = 'a\\0\\ud800'",
    ),
    attack(
        "lines_in_texts",
        force="def force(x, k):\n    raise ValueError('a\\r\\nstudent,100\\r\\n\\u2028b')",
        guess="guess = 'a\\n1,2\\n'",
    ),
    attack(
        "markdown",
        force="def force(x, k):\n    raise ValueError('[a](javascript:alert(1)) ![](http://example.invalid)')",
    ),
    attack("addresses", force="def force(x, k):\n    print(object(), id(x))\n    raise ValueError(repr(object()))"),
    attack(
        "paths_in_texts",
        first="import os\nraise ValueError(os.getcwd())",
        force="import os\ndef force(x, k):\n    raise ValueError(os.getcwd())",
    ),
    attack(
        "random_texts",
        force="import random\ndef force(x, k):\n    return random.random()",
        stiffness="import random\nstiffness = random.random()",
    ),
    attack(
        "many_printed_lines",
        force="def force(x, k):\n    for i in range(10_000):\n        print(i, '<b>')\n    return 0",
    ),
    attack("long_words", force="def force(x, k):\n    raise type('E' * 100_000, (Exception,), {})('w' * 100_000)"),
    # names of students and files
    attack("=1+1;name"),
    attack("@name"),
    attack("-2+3"),
    attack("+cmd|' "),
    attack("<script>alert(1)<"),
    attack('a\nb,"c"'),
    attack("\x1b[31mred"),
    attack("\u202etxt.exe"),
    attack("a'b\"c&d"),
    attack(" spaces "),
    attack("-o"),
    attack("%s{0}$(touch x)`touch y`"),
    attack("N" * 200),
    attack("é\u0301日本語"),
    # archives
    Attack("zipped", {"zipped.zip": _zipped(("42_small_wall.ipynb", _NOTEBOOK))}),
    Attack("zipped_in_a_folder", {"zipped_in_a_folder.zip": _zipped(("a/b/42_small_wall.ipynb", _NOTEBOOK))}),
    Attack(
        "zip_slip",
        {"zip_slip.zip": _zipped(("../../slipped.py", b"1"), ("/slipped.py", b"1"), ("42_small_wall.ipynb", _NOTEBOOK))},
    ),
    file("zip_slip_alone", "zip_slip_alone.zip", _zipped(("../../42_small_wall.ipynb", b"{}"))),
    file("zip_of_a_bomb", "zip_of_a_bomb.zip", _zipped(("42_small_wall.py", _BOMB))),
    file("zip_of_a_link", "zip_of_a_link.zip", _zipped(_link("42_small_wall.py", b"@ANSWERS@/solution.py"))),
    file("zip_cut", "zip_cut.zip", _zipped(("42_small_wall.ipynb", _NOTEBOOK))[:-30]),
    file("zip_of_nothing", "zip_of_nothing.zip", _zipped()),
    file("no_zip", "no_zip.zip", b"PK\x03\x04" + b"\0" * 100),
    Attack("cell_ids", {"cell_ids.ipynb": _NOTEBOOK.replace(b'"id": "c', b'"id": "<script>../../')}),
)
