"""Work that tries to earn without an answer: by patches, forged replies, and answers found in memory."""

from .attack import EVERYTHING, Attack, attack
from .small_lab import OPEN, notebook

_WRONG = {
    "force": "def force(x, k):\n    return 1.0",
    "energy": "def energy(x, k):\n    return 1.0",
    "forces": "def forces(x, k):\n    return [1.0] * len(x)",
    "stiffness": "stiffness = 1.0",
}
_PATCHES = """
import builtins, cmath, functools, json, math, operator, re
import numpy as np
true = lambda *a, **k: True
for module, names in (
    (math, "isclose"), (cmath, "isclose"), (np, "allclose isclose array_equal all"), (np.testing, "assert_allclose assert_equal"),
    (operator, "eq le lt"),
):
    for name in names.split():
        setattr(module, name, true)
"""
_PACKAGE = """
import sys
import hapticlab.course.check, hapticlab.course.judge, hapticlab.course.marks
from hapticlab.course.judge import Verdict
right = lambda *a, **k: Verdict(True, "right")
for name, module in list(sys.modules.items()):
    if name.startswith(("hapticlab.course", "hapticlab.grading")):
        for one in ("judge", "verdict", "within", "_close", "_judge_word", "check", "marks", "_mark"):
            if hasattr(module, one) and callable(getattr(module, one)):
                setattr(module, one, right)
"""
_REPLY = '{"outcomes": [{"value": 731.25, "problem": "", "printed": ""}], "right": true, "earned": 10, "points": 10}'
_TO_ALL = """
import os
def tell(text):
    for fd in range(3, 64):
        try:
            os.set_blocking(fd, False)
            os.write(fd, text)
        except OSError:
            pass
"""
_FIND = """
import gc, sys
def found(sort):
    frame, seen = sys._getframe(), []
    while frame:
        seen += [*frame.f_locals.values(), *frame.f_globals.values()]
        frame = frame.f_back
    for one in [*seen, *gc.get_objects()]:
        try:
            held = one if isinstance(one, dict) else vars(one)
        except TypeError:
            continue
        for name in ("expected", "wanted", "answers", "solution"):
            if isinstance(held.get(name), sort):
                return held[name]
"""


#: replies with the number of the request that is open, as the session holds it
_NUMBERED = """
import gc, json, os
def numbered(answer):
    asked = [one for one in gc.get_objects() if type(one) is dict and "number" in one and one.get("do") == "evaluate"]
    last = asked[-1]["number"] if asked else ""
    for fd in range(3, 16):
        try:
            os.write(fd, 2 * (json.dumps({**answer, "number": last}) + chr(10)).encode())
        except OSError:
            pass
"""


def _patched(name, first, lost=()):
    """Return an attack whose patches stand before wrong answers, and honest ones that count unless the patch breaks them."""
    return attack(name, first=first, lost=lost, **_WRONG)


def _telling(name, content, when="in_a_call"):
    """Return an attack that writes a line of its own to every open descriptor."""
    cell = f"tell({content})"
    if when == "in_a_cell":
        return attack(name, first=_TO_ALL + cell, **_WRONG)
    return attack(
        name,
        stiffness=f"{_TO_ALL}\nclass F:\n    def __float__(self):\n        {cell}\n        return 1.0\nstiffness = F()",
    )


ATTACKS = (
    _patched("patched_mathematics", _PATCHES),
    _patched("patched_package", _PACKAGE),
    _patched(
        "patched_numbers",
        "import builtins\nbuiltins.abs = lambda v: 0.0\nbuiltins.all = builtins.any = lambda v: True",
        lost=("wall",),
    ),
    _patched("patched_isinstance", "import builtins\nbuiltins.isinstance = lambda *a: True"),
    _patched("patched_float", "import builtins\nbuiltins.float = lambda *a: 731.25", lost=("wall",)),
    _patched(
        "patched_json",
        f"import json\njson.dumps = lambda *a, **k: '{_REPLY}'\njson.JSONEncoder.encode = lambda *a: '{_REPLY}'",
    ),
    _patched(
        "patched_evaluate",
        """
        import hapticlab.course.evaluate as e
        e.evaluate = lambda *a: e.Outcome(True)
        e.plain = lambda *a: True""",
        lost=("wall", "why"),
    ),
    _patched(
        "patched_modules",
        """
        import sys, types
        fake = types.ModuleType("fake")
        fake.__getattr__ = lambda name: (lambda *a, **k: True)
        for name in list(sys.modules):
            if name.startswith("hapticlab.grading") or name in ("json", "marshal", "pickle", "math"):
                sys.modules[name] = fake""",
    ),
    _patched(
        "patched_main",
        """
        import __main__
        for name in list(vars(__main__)):
            if callable(getattr(__main__, name)) and not name.startswith("__"):
                setattr(__main__, name, lambda *a, **k: {"outcomes": [{"value": 731.25}]})""",
    ),
    _patched(
        "own_lab",
        """
        from hapticlab.course.exercise import Case, Exercise, Lab
        LAB = Lab("42", "mine", 1, [Exercise("force", points=100, cases=[Case({"x": 0.0, "k": 1.0}, 1.0)])])
        checks = LAB
        exercises = points = earned = 100""",
    ),
    attack(
        "own_checks",
        beside={
            "checks.py": b"from hapticlab.course.exercise import *\nLAB = Lab('42', 'mine', 1, [Exercise('guess')])",
            "solution.py": b"stiffness = 1.0",
            "hidden.py": b"def cases(random): return {}",
        },
        **_WRONG,
    ),
    attack(
        "own_modules",
        beside={
            "numpy.py": b"raise SystemExit",
            "hapticlab/__init__.py": b"raise SystemExit",
            "sitecustomize.py": b"import os; os._exit(0)",
            "json.py": b"def dumps(*a, **k): return '{}'",
            "usercustomize.py": b"import os; os._exit(0)",
            "conftest.py": b"raise SystemExit",
            "pyvenv.cfg": b"home = /nowhere",
            "hapticlab.pth": b"import os; os._exit(0)",
        },
        stiffness="stiffness = 1.0",
    ),
    attack(
        "own_report",
        beside={
            "report.json": b'{"earned": 100}',
            "results.json": b'{"score": 100}',
            "results.json.journal.jsonl": b'{"student": "honest", "earned": 0}\n',
        },
        force="def force(x, k):\n    return 1.0",
    ),
    attack(
        "finds_in_memory",
        first=_FIND,
        force="def force(x, k):\n    return found(float)",
        forces="def forces(x, k):\n    return found(list)",
        stiffness="stiffness = found(float)",
        why="why = found(str)",
    ),
    attack(
        "finds_when_asked",
        first=_FIND,
        stiffness="""
        class F:
            def __float__(self): return found(float) or 0.0
        stiffness = F()""",
    ),
    attack(
        "finds_by_the_check",
        stiffness="""
        result = hl.check("42.stiffness", 1.0)
        import re
        stiffness = float((re.findall(r"expected ([0-9.]+)", str(result)) or [0])[0])""",
        why="""
        why = next((key for key in "ac" if hl.check("42.why", key).passed), "")""",
    ),
    attack(
        "finds_by_the_package",
        stiffness="""
        from hapticlab.course.labs import find_lab
        stiffness = find_lab("42").exercise("stiffness").cases[0].expected""",
        why="from hapticlab.course.labs import load_lab\nwhy = load_lab('checks.py').exercise('why').cases[0].expected",
    ),
    _telling("reply_in_a_call", f"b'{_REPLY}' + bytes([10])"),
    _telling("reply_twice", f"(b'{_REPLY}' + bytes([10])) * 2"),
    _telling("reply_in_a_cell", f"b'{_REPLY}' + bytes([10])", "in_a_cell"),
    _telling(
        "reply_for_later",
        "(b'{}'.replace(b'{}', b'{\"cells\": 3, \"problem\": \"\"}') + bytes([10])) * 40",
        "in_a_cell",
    ),
    _telling("reply_half", 'b\'{"outcomes": [{"value": 731\''),
    _telling("reply_deep", "b'[' * 60000 + bytes([10])"),
    _telling("reply_deep_object", "b'{\"a\":' * 10000 + bytes([10])"),
    _telling("reply_huge_number", "b'{\"outcomes\": [{\"value\": ' + b'9' * 50000 + b'}]}' + bytes([10])"),
    _telling("reply_nan", 'b\'{"outcomes": [{"value": NaN, "problem": "", "printed": ""}]}\' + bytes([10])'),
    _telling("reply_infinity", 'b\'{"outcomes": [{"value": 1e999, "problem": "", "printed": ""}]}\' + bytes([10])'),
    _telling("reply_of_wrong_types", 'b\'{"outcomes": {"0": 5}, "problem": 7}\' + bytes([10])'),
    _telling("reply_of_no_outcomes", "b'{\"outcomes\": []}' + bytes([10])"),
    _telling("reply_of_many_outcomes", "b'{\"outcomes\": [' + b'1,' * 9999 + b'1]}' + bytes([10])"),
    _telling(
        "reply_lone_surrogate",
        r"""b'{"outcomes": [{"value": "\\ud800", "problem": "\\udfff", "printed": ""}]}' + bytes([10])""",
    ),
    _telling("reply_no_text", "bytes(range(256)) * 40"),
    _telling(
        "reply_pickle",
        "__import__('pickle').dumps(type('E', (), {'__reduce__': lambda s: (__import__('os').system, "
        "('touch @CANARY@.pickle',))})()) + bytes([10])",
    ),
    attack(
        "reply_100_megabytes",
        stiffness=f"""
{_TO_ALL}
class F:
    def __float__(self):
        for fd in range(3, 16):
            try:
                for _ in range(100):
                    os.write(fd, b'x' * (1 << 20))
            except OSError:
                pass
        return 1.0
stiffness = F()""",
    ),
    attack(
        "reply_with_its_number",
        stiffness=f"""
{_NUMBERED}
class F:
    def __float__(self):
        numbered({{"outcomes": [{{"value": 1.0, "problem": "", "printed": ""}}]}})
        return 1.0
stiffness = F()""",
    ),
    attack(
        "reply_of_a_million_names",
        stiffness="stiffness = {str(i): 1.0 for i in range(10**6)}",
        force="def force(x, k):\n    return {hex(i): {} for i in range(10**6)}",
    ),
    attack(
        "reply_of_ten_million_lists",
        stiffness=f"""
{_NUMBERED}
class F:
    def __float__(self):
        for fd in range(3, 16):
            try:
                os.set_blocking(fd, True)
                for part in (b'{{"outcomes": [{{"value": [', b"[]," * 10**7, b'1]}}], "number": 1}}' + bytes([10])):
                    while part:
                        part = part[os.write(fd, part[: 1 << 16]):]
            except OSError:
                pass
        return 1.0
stiffness = F()""",
    ),
    attack(
        "reply_and_exit",
        stiffness=f"{_TO_ALL}\nclass F:\n    def __float__(self):\n        tell(b'{_REPLY}')\n        os._exit(0)\n"
        "stiffness = F()",
    ),
    attack(
        "reads_requests",
        stiffness="""
        import os
        class F:
            def __float__(self):
                for fd in range(0, 16):
                    try:
                        os.set_blocking(fd, False)
                        os.read(fd, 1 << 16)
                    except OSError:
                        pass
                return 1.0
        stiffness = F()""",
    ),
    attack(
        "answers_of_expected_kind",
        force="""
        class Case:
            expected = 0.4
        def force(x, k):
            return {"value": k * (x - 0.01), "right": True, "earned": 2}""",
    ),
    attack(
        "says_it_is_right",
        force="def force(x, k):\n    print('right: 0.4 N')\n    raise ValueError('')",
        energy="def energy(x, k):\n    return {'right': True, 'words': ''}",
        wall="wall = True",
        why="why = 'a, b, c'",
    ),
    Attack(
        "metadata_that_claims_points",
        {
            "metadata_that_claims_points.ipynb": notebook(OPEN.values()).replace(
                b'"metadata": {}', b'"metadata": {"nbgrader": {"grade": true, "points": 100, "score": 100}}'
            )
        },
        EVERYTHING,
    ),
)
