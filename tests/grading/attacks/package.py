"""Work that turns the package, the notebook's form or an answer's own type against whoever evaluates it."""

import json

from .attack import EVERYTHING, Attack, attack, file
from .python import wrong
from .small_lab import HONEST, notebook

_HIDDEN = "k != round(k)"
_RIGHT = "k * (x - 0.01) if x >= 0.01 else 0.0"


def meaning(name, code):
    """Return an attack whose stiffness is an object that lies."""
    return attack(name, stiffness=code)


PACKAGE = (
    wrong(
        "laws_of_its_own",
        """
        import hapticlab as hl
        import hapticlab.course.felt as felts, hapticlab.course.evaluate as evaluates
        def felt(scene, **given):
            return [0.0, 0.2, 1.0]
        felts.felt = evaluates.felt = felt""",
        lost=("wall",),
    ),
    wrong(
        "units_of_its_own",
        """
        import sys
        for name, module in list(sys.modules.items()):
            if name.startswith("hapticlab") and "unit" in name:
                for word, one in list(vars(module).items()):
                    if isinstance(one, dict) and not word.startswith("__"):
                        one["N"] = one.get("J", one.get("N"))
        import pint
        pint.Quantity.__eq__ = pint.Unit.__eq__ = lambda self, other: True""",
    ),
    attack(
        "scenes_that_remember",
        first="import hapticlab as hl",
        wall="""
        import hapticlab as hl, sys
        from hapticlab import n, x
        k, x_o = hl.parameters("k x_o", units="N/m m")
        wall = hl.Scene(force=hl.when(x(n) >= x_o, 2 * k * (x(n) - x_o)))
        for name, module in list(sys.modules.items()):
            if name.startswith("hapticlab.compiler"):
                for one in vars(module).values():
                    for word in ("cache_clear", "clear"):
                        if callable(getattr(one, word, None)) and not isinstance(one, type) and "cache" in repr(one).lower():
                            getattr(one, word)()""",
    ),
    wrong(
        "algebra_of_its_own",
        """
        import sympy
        from sympy.core.cache import clear_cache
        sympy.lambdify = lambda *given, **named: lambda *values: 731.25
        sympy.printing.sstr = sympy.printing.srepr = lambda *given, **named: "731.25"
        sympy.core.numbers.Float._new = classmethod(lambda cls, *given, **named: 1 / 0)
        clear_cache()""",
    ),
    attack(
        "knows_what_is_shown",
        first="""
        known = {"force": {(0.012, 200.0): 0.4, (0.008, 200.0): 0.0}, "energy": 0.002}
        import os
        for folder in (".", "..", "@LAB@"):
            for name in os.listdir(folder) if os.path.isdir(folder) else ():
                if name == "checks.py":
                    scope = {}
                    exec(open(os.path.join(folder, name)).read(), scope)
                    known["stiffness"] = scope["LAB"].exercise("stiffness").cases[0].expected
                    known["why"] = scope["LAB"].exercise("why").cases[0].expected""",
        force="def force(x, k):\n    return known['force'].get((x, k), 0.0)",
        energy="def energy(x, k):\n    return known['energy']",
        stiffness="stiffness = known.get('stiffness', 1.0)",
        why="why = known.get('why', 'a')",
    ),
    attack(
        "two_guesses",
        why="""
        import traceback
        stack = str(traceback.extract_stack())
        why = "b" if "run_pieces" in stack or "do_plan" in stack else "a\"""",
        stiffness="""
        import sys
        frame, names = sys._getframe(), set()
        while frame:
            names |= {frame.f_code.co_name, *frame.f_locals}
            frame = frame.f_back
        stiffness = 731.25 if "pieces" in names or "run_pieces" in names else 1.0""",
    ),
    attack(
        "hangs_when_it_is_hidden",
        force=f"def force(x, k):\n    while {_HIDDEN}:\n        pass\n    return {_RIGHT}",
        ended={"force": "time"},
        patience=True,
    ),
    attack("ends_when_it_is_hidden", force=f"import os\ndef force(x, k):\n    {_HIDDEN} and os._exit(0)\n    return {_RIGHT}"),
    attack("floods_when_it_is_hidden", force=f"def force(x, k):\n    return [x] * 10**7 if {_HIDDEN} else {_RIGHT}"),
    attack(
        "raises_when_it_is_hidden",
        force=f"def force(x, k):\n    if {_HIDDEN}:\n        raise GeneratorExit\n    return {_RIGHT}",
    ),
)

OBJECTS = (
    meaning(
        "whole_number_that_lies",
        """
        class I(int):
            def __repr__(self): return "731.25"
            __str__ = __format__ = __repr__
            def __index__(self): return 731
            def __float__(self): return 730.0
            def __round__(self, *given): return 731
        stiffness = I(3)""",
    ),
    meaning(
        "text_that_lies",
        """
        class S(str):
            def __len__(self): return 1
            def __iter__(self): return iter("731.25")
            def __str__(self): return 731.25
            def encode(self, *given): return b"731.25, "
            def replace(self, *given): return {"value": 731.25}
        stiffness = S("1.0")""",
    ),
    attack(
        "array_that_lies",
        forces="""
        class A(np.ndarray):
            def __array_finalize__(self, other): self.flags.writeable and self.fill(1.0)
            def __array_function__(self, do, types, given, named): return [0.0, 2.0, -4.0]
            def __len__(self): return 3
            @property
            def dtype(self): return np.dtype(float)
            @property
            def __array_interface__(self): return {"shape": (1 << 40,), "typestr": "<f8", "data": (8, True), "version": 3}
        def forces(x, k):
            return (np.ones(3)).view(A)""",
    ),
    attack(
        "memory_as_an_array",
        energy="""
        class View:
            __array_interface__ = {"shape": (4,), "typestr": "<f8", "data": (16, True), "version": 3}
        def energy(x, k):
            return np.asarray(View())""",
    ),
    meaning("number_of_no_size", "from decimal import Decimal\nstiffness = Decimal('sNaN')"),
    meaning("number_of_any_size", "from decimal import Decimal\nstiffness = Decimal('1e1000000000')"),
    meaning("time_for_a_number", "import numpy as np\nstiffness = np.datetime64('NaT')"),
    meaning("record_for_a_number", "import numpy as np\nstiffness = np.zeros((), [('value', float), ('right', bool)])"),
    attack("digits_without_end", energy="import sympy\ndef energy(x, k):\n    return sympy.Float(1, 10**7)"),
    attack(
        "names_that_nest",
        energy="def energy(x, k):\n    d = {}\n    for _ in range(20_000):\n        d = {'d': d}\n    return d",
    ),
    meaning(
        "dictionary_that_changes",
        """
        class D(dict):
            def items(self): return iter(int, 1)
            def __iter__(self):
                while True:
                    yield "a"
            keys = values = __iter__
            def __len__(self): return 1
        stiffness = D(a=1.0)""",
    ),
    meaning(
        "dies_while_it_is_read",
        """
        import weakref
        class Dying:
            def __float__(self):
                global stiffness
                stiffness = 731.0
                weakref.finalize(self, exit)
                del self
                return 1.0
        stiffness = Dying()""",
    ),
)

_CODE = {"cell_type": "code", "metadata": {}, "outputs": []}


def _written(name, **changed):
    """Return an attack that is an honest notebook with other fields."""
    made = json.loads(notebook(HONEST.values())) | changed
    return Attack(name, {f"{name}.ipynb": json.dumps(made).encode()})


_HONEST_CELLS = json.loads(notebook(HONEST.values()))["cells"]
FORMS = (
    Attack(
        "cells_twice",
        {"cells_twice.ipynb": notebook(["stiffness = 1.0"])[:-1] + b', "cells": ' + json.dumps(_HONEST_CELLS).encode() + b"}"},
    ),
    _written("metadata_of_machines", metadata={"kernelspec": {"name": "bash", "argv": ["rm"]}, "widgets": [[[]]] * 1000}),
    _written("format_of_tomorrow", nbformat=99, nbformat_minor=-1),
    _written(
        "cells_that_are_protected",
        cells=[{**cell, "metadata": {"tags": ["raises-exception", "skip-execution"], "trusted": True}} for cell in _HONEST_CELLS],
    ),
    _written(
        "outputs_that_answer",
        cells=[
            {**cell, "outputs": [{"output_type": "execute_result", "data": {"text/plain": "731.25"}}], "execution_count": 10**400}
            for cell in _HONEST_CELLS
        ],
    ),
    attack(
        "cookies_of_codes",
        first="# -*- coding: rot13 -*-\n# vim: set fileencoding=utf-7 :\nimport math",
        stiffness="stiffness = 1.0",
    ),
    attack("names_by_look", stiffness="ｓｔｉｆｆｎｅｓｓ = 1.0\nstіffness = 731.25"),
    file("nested_cells", "nested_cells.ipynb", b'{"cells": ' + b"[" * 200_000 + b"]" * 200_000 + b"}"),
    Attack(
        "cells_of_another_sort",
        {"cells_of_another_sort.ipynb": notebook(HONEST.values()).replace(b'"code"', b'"raw"')},
        EVERYTHING,
    ),
)

ATTACKS = (*PACKAGE, *OBJECTS, *FORMS)
