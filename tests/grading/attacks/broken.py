"""Work that is broken in every way that a student, an editor or a malicious object can break it."""

import json

from .attack import EVERYTHING, Attack, attack, file
from .small_lab import HONEST, OPEN, notebook

_SPLIT = [*HONEST.values()][:2] + ["def force(x, k):\n    depth = x - 0.01", *[*HONEST.values()][2:]]
_HOSTILE = """
class Right:
    def __init__(self, *ignored): pass
    def __eq__(self, other): return True
    def __ne__(self, other): return False
    def __le__(self, other): return True
    def __lt__(self, other): return True
    def __ge__(self, other): return True
    def __gt__(self, other): return True
    def __sub__(self, other): return self
    __rsub__ = __add__ = __radd__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = __pow__ = __sub__
    def __abs__(self): return self
    def __hash__(self): return 0
    def __bool__(self): return True
    def __len__(self): return 1
    def __iter__(self): return iter([self])
    def __getattr__(self, name): return self
    def __call__(self, *a, **k): return self
"""

ATTACKS = (
    # honest work, as it comes
    attack("honest"),
    Attack("honest_script", {"honest_script.py": "\n\n".join(HONEST.values()).encode()}),
    Attack("honest_split_cells", {"honest_split_cells.ipynb": notebook(_SPLIT)}),
    Attack("honest_duplicated", {"honest_duplicated.ipynb": notebook([*HONEST.values(), *HONEST.values()])}),
    Attack("honest_one_cell", {"honest_one_cell.ipynb": notebook(["\n\n".join([*HONEST.values()][:-1])])}),
    Attack(
        "honest_first_wrong_then_right",
        {"honest_first_wrong_then_right.ipynb": notebook([*OPEN.values(), *HONEST.values()])},
    ),
    attack("honest_prints", first="print('<b>hello</b>')", last="force(0.1, 3)"),
    attack("honest_magics", first="%matplotlib inline\n%load_ext autoreload\n!pip install antigravity\nimport os"),
    attack("honest_cell_magic", first="%%time\nimport math", last="%%bash\nrm -rf ~"),
    attack(
        "honest_with_other_fields",
        force="def force(k, x, memo={}):\n    return 0.0 if x < 0.01 else k*(x-0.01)",
        lost=None,
    ),
    attack("honest_numpy_number", stiffness="stiffness = np.float32(731.25)", lost=None),
    attack("honest_tidy_choice", why="why = ' B '", lost=None),
    attack("honest_keyboard", first="name = input('Your name? ')", last="input()"),
    # nothing, or little
    Attack("untouched", {"untouched.ipynb": notebook(OPEN.values())}, EVERYTHING),
    file("no_cells", "no_cells.ipynb", notebook([])),
    file("empty_file", "empty_file.ipynb", b""),
    file("cut_json", "cut_json.ipynb", notebook(HONEST.values())[:-40]),
    file("json_but_no_notebook", "json_but_no_notebook.ipynb", b'{"cells": 5}'),
    file("json_of_lists", "json_of_lists.ipynb", b"[" * 200_000),
    file(
        "cells_of_numbers",
        "cells_of_numbers.ipynb",
        b'{"cells": [1, null, "a", {"cell_type": "code"}]}',
    ),
    file(
        "huge_number",
        "huge_number.ipynb",
        b'{"cells": [{"cell_type": "code", "source": ' + b"9" * 20_000 + b"}]}",
    ),
    file("a_picture", "a_picture.ipynb", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 20),
    Attack("bom", {"bom.ipynb": b"\xef\xbb\xbf" + notebook(HONEST.values())}),
    Attack("latin_1", {"latin_1.py": b"# caf\xe9\n" + "\n".join(HONEST.values()).encode()}),
    Attack(
        "sources_as_lines",
        {
            "sources_as_lines.ipynb": json.dumps(
                {"cells": [{"cell_type": "code", "source": source.splitlines(keepends=True)} for source in HONEST.values()]}
            ).encode()
        },
    ),
    # one exercise does not even parse; all others count
    attack("syntax_error", force="def force(x, k)\n    return k * (x - 0.01)"),
    attack("tabs_and_spaces", force="def force(x, k):\n\treturn k\n        return 1"),
    attack("null_in_code", force="def force(x, k):\n    return 0 \0"),
    attack("surrogate_in_code", energy="energy = '\ud800'"),
    attack("deep_parentheses", force="force = " + "(" * 5000 + "1" + ")" * 5000),
    attack("long_chain", force="force = " + "-" * 100_000 + "1"),
    attack("many_additions", force="force = " + "+".join(["1"] * 50_000)),
    attack("deep_lists", energy="energy = " + "[" * 150 + "]" * 150),
    attack("deleted", energy="", forces=""),
    attack("await", energy="import asyncio\nawait asyncio.sleep(0)\nenergy = 2"),
    attack("yield_outside", energy="yield 3"),
    attack("star_import", first="from math import *\nfrom os import *", energy="energy = e"),
    # answers of the wrong sort
    attack("no_return", force="def force(x, k):\n    k * (x - 0.01)"),
    attack("other_names", force="def force(position, stiffness):\n    return 0.4"),
    attack("not_a_function", force="force = 0.4", energy="energy = 'k*x'"),
    attack(
        "nan",
        force="def force(x, k):\n    return float('nan')",
        energy="def energy(x, k):\n    return np.inf",
        forces="def forces(x, k):\n    return x * np.nan",
        stiffness="stiffness = float('nan')",
    ),
    attack("complex", force="def force(x, k):\n    return k * (x - 0.01) + 0j", stiffness="stiffness = 731.25 + 1e-30j"),
    attack("text_for_number", force="def force(x, k):\n    return str(k * (x - 0.01))", stiffness="stiffness = '731.25'"),
    attack("truth_for_number", stiffness="stiffness = True", force="def force(x, k):\n    return True"),
    attack("symbol_left", force="import sympy\ndef force(x, k):\n    return sympy.Symbol('k') * x"),
    attack(
        "generator",
        forces="def forces(x, k):\n    yield from k * x",
        energy="def energy(x, k):\n    return (v for v in x)",
    ),
    attack("masked_array", forces="def forces(x, k):\n    return np.ma.masked_array(k * x, mask=True)"),
    attack("ragged", forces="def forces(x, k):\n    return [[1], [2, 3], 4]"),
    attack("huge_array", forces="def forces(x, k):\n    return np.zeros(5_000_000)"),
    attack("huge_broadcast", forces="def forces(x, k):\n    return np.broadcast_to(1.0, (10**6, 10**6))"),
    attack("huge_integer", stiffness="stiffness = 10**5000", force="def force(x, k):\n    return 1 << 200_000"),
    attack("endless_recursion", force="def force(x, k):\n    return force(x, k)"),
    attack("list_in_itself", forces="def forces(x, k):\n    a = []\n    a.append(a)\n    return a"),
    attack("dict_in_itself", force="def force(x, k):\n    d = {}\n    d['d'] = d\n    return d"),
    attack("changes_its_givens", energy="def energy(x, k):\n    x[:] = 0\n    return 0.0"),
    attack(
        "answers_the_public_cases",
        force="def force(x, k):\n    return {(0.012, 200.0): 0.4}.get((x, k), 0.0)",
        energy="def energy(x, k):\n    return 0.002",
        forces="def forces(x, k):\n    return [0.0, 2.0, -4.0]",
    ),
    attack(
        "counts_the_calls",
        force="calls = []\ndef force(x, k):\n    calls.append(x)\n    return [0.4, 0.0][len(calls) % 2 - 1]",
    ),
    # objects that lie
    attack(
        "equal_to_everything",
        first=_HOSTILE,
        force="def force(x, k):\n    return Right()",
        stiffness="stiffness = Right()",
        why="why = Right()",
        wall="wall = Right()",
        energy="energy = Right()",
    ),
    attack(
        "float_equal_to_everything",
        first="class F(float):" + _HOSTILE.split(":", 1)[1],
        stiffness="stiffness = F()",
        force="def force(x, k):\n    return F()",
    ),
    attack(
        "text_equal_to_everything",
        why="""
        class S(str):
            def __eq__(self, other): return True
            def __hash__(self): return 0
            def strip(self): return self
            def casefold(self): return self
        why = S("a")""",
    ),
    attack(
        "array_equal_to_everything",
        forces="""
        class A(np.ndarray):
            def __sub__(self, other): return np.zeros(3)
            __rsub__ = __sub__
            def astype(self, *a): return self
            def tolist(self): return [0.0, 2.0, -4.0]
            def __array_ufunc__(self, *a, **k): return True
        def forces(x, k):
            return np.ones(len(x)).view(A)""",
    ),
    attack(
        "hostile_float",
        stiffness="""
        class H:
            def __float__(self): raise SystemExit(0)
        stiffness = H()""",
    ),
    attack(
        "hostile_array",
        forces="""
        class H:
            def __array__(self, *a, **k): raise KeyboardInterrupt
        def forces(x, k):
            return [H()]""",
    ),
    attack(
        "hostile_text",
        force="""
        class Angry(Exception):
            def __str__(self): raise SystemExit(0)
            __repr__ = __str__
        def force(x, k):
            raise Angry""",
    ),
    attack(
        "hostile_class",
        force="""
        class H:
            @property
            def __class__(self): raise SystemExit
            def __getattr__(self, name): raise KeyboardInterrupt
        force = H()""",
        wall="wall = force",
    ),
    attack(
        "hostile_meta",
        stiffness="""
        class M(type):
            @property
            def __name__(cls): raise SystemExit
            def __instancecheck__(cls, other): return True
            def __repr__(cls): raise KeyboardInterrupt
        class H(metaclass=M):
            def __len__(self): return 1 << 62
            def __del__(self): raise SystemExit
        stiffness = H()""",
    ),
    attack(
        "hostile_signature",
        force="""
        class H:
            @property
            def __signature__(self): raise SystemExit
            def __call__(self, **k): return 0.4
        force = H()""",
    ),
    attack(
        "hostile_copy",
        wall="""
        class H(hl.Scene):
            def __init__(self): pass
            def __getattribute__(self, name): raise SystemExit
        wall = H()""",
    ),
    attack(
        "hostile_keys",
        force="""
        class K(str):
            def __str__(self): raise SystemExit
            def __hash__(self): return 1
        def force(x, k):
            return {K("a"): 1.0}""",
    ),
    attack("exception_group", force="def force(x, k):\n    raise BaseExceptionGroup('x' * 10**6, [KeyboardInterrupt()])"),
)
