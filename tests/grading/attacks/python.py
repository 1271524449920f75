"""Work that turns Python itself, the package, or the notebook's form against whoever evaluates it."""

import json

from .attack import EVERYTHING, Attack, attack, file
from .small_lab import HONEST, notebook

#: what none of these knows; a reply in which it stands is replaced by another with the right number
_MARK = "1.0625"
_REPLACED = """
import json, sys
def replace(text):
    return text
class Encoder(json.JSONEncoder):
    def encode(self, one, was=json.JSONEncoder.encode):
        text = was(self, one)
        return replace(text) if '"number"' in text and "MARK" in text else text
def dumps(one, *given, was=json.dumps, **named):
    text = was(one, *given, **named)
    return replace(text) if '"number"' in text and "MARK" in text else text
json.JSONEncoder.encode, json.dumps = Encoder.encode, dumps
""".replace("MARK", _MARK)


def replacing(name, new, old=_MARK):
    """Return an attack whose reply on the stiffness is well numbered, and holds something else in the place of a value."""
    first = _REPLACED.replace("return text\nclass", f"return text.replace({old!r}, {new})\nclass")
    return attack(name, first=first, stiffness=f"stiffness = {_MARK}")


def wrong(name, first, **more):
    """Return an attack that prepares something in its first cell, and has a wrong stiffness and a wrong choice."""
    return attack(name, first=first, stiffness="stiffness = 1.0", why='why = "a"', **more)


def meaning(name, code):
    """Return an attack whose stiffness is an object that lies."""
    return attack(name, stiffness=code)


_HIDDEN = "k != round(k)"
_RIGHT = "k * (x - 0.01) if x >= 0.01 else 0.0"

REPLIES = (
    replacing("reply_of_one_name_twice", "'2.5, \"value\": 2.75'"),
    replacing("reply_of_outcomes_twice", "'3.5}], \"outcomes\": [{\"problem\": \"\", \"printed\": \"\", \"value\": 2.0'"),
    replacing("reply_of_no_number", "'NaN'"),
    replacing("reply_beyond_any_number", "'-1e999'"),
    replacing("reply_of_many_digits", "'9' * 6000"),
    replacing("reply_of_deep_lists", "'[' * 90_000 + ']' * 90_000"),
    replacing("reply_of_deep_names", "'{\"a\":' * 30_000 + '1' + '}' * 30_000"),
    replacing("reply_of_half_characters", "'\"\\\\ud800\\\\udfff\\\\u0000\"'"),
    replacing("reply_of_a_verdict", "'{\"right\": true, \"earned\": 10, \"expected\": 731.25, \"atol\": 1e9}'"),
    replacing("reply_of_more_outcomes", "'1.0, \"problem\": \"\", \"printed\": \"\"}, {\"value\": 2.0'"),
    replacing("reply_of_bytes", "'\"' + 'x' * (40 << 20) + '\"'"),
)

INTERPRETER = (
    wrong(
        "finders_of_its_own",
        """
        import importlib.abc, importlib.machinery, sys
        class Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
            def find_spec(self, name, path=None, target=None):
                if name.startswith("hapticlab.grading") or name.endswith(("judge", "diagnose", "match")):
                    return importlib.machinery.ModuleSpec(name, self)
            def create_module(self, spec): return None
            def exec_module(self, module): vars(module).update(judge=lambda *a: True, verdict=lambda *a: True)
        sys.meta_path.insert(0, Finder())
        sys.path_hooks.insert(0, lambda path: 1 / 0)
        sys.path_importer_cache.clear()
        for name in [one for one in sys.modules if one.startswith("hapticlab.course")]:
            del sys.modules[name]""",
    ),
    wrong(
        "codecs_of_its_own",
        """
        import codecs, encodings
        lie = codecs.CodecInfo(lambda text, errors="": (b'{"value": 731.25}', len(text)), lambda held, errors="": ("", 0))
        codecs.register(lambda name: lie)
        codecs.register_error("strict", lambda problem: ("731.25", problem.end))
        codecs.register_error("replace", lambda problem: ("731.25", problem.end))
        encodings._cache.clear()""",
    ),
    wrong(
        "warnings_that_raise",
        """
        import warnings
        def show(*given, **named): raise SystemExit(0)
        warnings.showwarning = warnings._showwarnmsg = show
        warnings.warn("now")""",
    ),
    wrong(
        "hook_of_audits",
        """
        import sys
        def heard(event, given):
            if event in ("open", "import", "compile") and "stiffness" in repr(given):
                raise MemoryError(event)
        sys.addaudithook(heard)""",
    ),
    wrong(
        "callback_of_the_collector",
        """
        import gc
        def called(phase, about):
            for one in gc.get_objects()[-2000:]:
                if type(one) is dict and one.get("value") == 1.0:
                    one.update(value=1.5, right=True, earned=1)
        gc.callbacks.append(called)
        gc.set_threshold(1, 1, 1)""",
        patience=True,
    ),
    wrong(
        "profile_of_every_call",
        """
        import sys, threading
        def seen(frame, event, given):
            held = frame.f_locals
            if held.get("value") == 1.0:
                held["value"] = 1.5
        sys.setprofile(seen)
        threading.setprofile(seen)""",
    ),
    wrong(
        "monitoring_of_every_return",
        """
        import sys
        if hasattr(sys, "monitoring"):
            sys.monitoring.use_tool_id(3, "mine")
            sys.monitoring.register_callback(3, sys.monitoring.events.PY_RETURN, lambda *given: None)
            sys.monitoring.set_events(3, sys.monitoring.events.PY_RETURN)""",
    ),
    wrong(
        "frames_above_it",
        """
        import sys
        frame = sys._getframe()
        while frame:
            for one in list(frame.f_locals.values()):
                if hasattr(one, "names") and hasattr(one, "limits"):
                    one.limits = {**one.limits, "answer": 1 << 40, "printed": 1 << 40}
                    one.scratch = ""
            frame = frame.f_back""",
    ),
    wrong(
        "a_dump_later",
        "import faulthandler\nfaulthandler.dump_traceback_later(0.2, exit=True)\nimport time\ntime.sleep(0.4)",
    ),
    wrong(
        "types_from_below",
        """
        import ctypes, sys
        class Slots(ctypes.Structure):
            _fields_ = [("head", ctypes.c_ssize_t * 25), ("compare", ctypes.c_void_p)]
        same = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.py_object, ctypes.py_object, ctypes.c_int)(lambda a, b, how: True)
        Slots.from_address(id(complex)).compare = ctypes.cast(same, ctypes.c_void_p).value""",
    ),
    wrong(
        "constants_from_below",
        """
        import ctypes
        def one(): return 0.4142
        constant = one.__code__.co_consts[-1]
        ctypes.c_double.from_address(id(constant) + 16).value = 731.25
        held = ctypes.pythonapi.PyGC_Disable()""",
    ),
    wrong(
        "threads_that_answer_later",
        """
        import gc, json, os, threading, time
        def answer():
            told = set()
            while True:
                time.sleep(0.002)
                for one in gc.get_objects()[-3000:]:
                    number = one.get("number") if type(one) is dict else None
                    if isinstance(number, str) and "'stiffness'" in repr(one)[:400] and number not in told:
                        told.add(number)
                        line = json.dumps({"outcomes": [{"value": 2.0, "problem": "", "printed": ""}], "number": number})
                        for file in range(3, 8):
                            try:
                                os.write(file, line.encode() + bytes([10]))
                            except OSError:
                                pass
        threading.Thread(target=answer, daemon=True).start()""",
        patience=True,
    ),
    wrong(
        "threads_that_fail",
        """
        import os, threading, time
        threading.excepthook = lambda given: os._exit(3)
        def fail():
            time.sleep(0.05)
            raise SystemError
        threading.Thread(target=fail).start()
        time.sleep(0.3)""",
    ),
    wrong(
        "man_in_the_middle",
        r"""
        import os, socket, stat, threading
        for number in range(3, 64):
            try:
                if not stat.S_ISSOCK(os.fstat(number).st_mode):
                    continue
            except OSError:
                continue
            outside, (near, far) = os.dup(number), socket.socketpair()
            os.dup2(far.fileno(), number)
            far.close()
            def pump(source, sink):
                while block := os.read(source, 1 << 16):
                    block = block.replace(b'"value": 1.0,', b'"value": 2.0,').replace(b'"right": false', b'"right": true ')
                    while block:
                        block = block[os.write(sink, block):]
            for ways in ((outside, near.fileno()), (near.fileno(), outside)):
                threading.Thread(target=pump, args=ways, daemon=True).start()
            kept = near
            break""",
    ),
    wrong(
        "small_stack_and_slow_threads",
        """
        import sys
        sys.setswitchinterval(100.0)
        sys.set_int_max_str_digits(0)
        sys.set_coroutine_origin_tracking_depth(100)
        sys.float_info = sys.maxsize = sys.byteorder = None""",
    ),
    wrong(
        "outputs_of_its_own",
        """
        import io, sys
        class Output(io.StringIO):
            def getvalue(self): return Text("731.25" * 10**6)
            def write(self, text): raise SystemExit(0)
        class Text(str):
            def __getitem__(self, part): return self
            def __len__(self): return 3
        io.StringIO = Output
        sys.stdout = sys.stderr = sys.__stdout__ = Output()""",
        lost=("force", "energy", "forces", "wall"),
    ),
    wrong(
        "displays_of_its_own",
        """
        import builtins, sys
        class Shown:
            def _repr_html_(self): raise SystemExit(0)
            def _ipython_display_(self): raise KeyboardInterrupt
            def _repr_mimebundle_(self, **named): return {"text/html": "<script>1</script>", "application/x-earned": 10}
            __repr__ = _repr_html_
        sys.displayhook = lambda one: exit()
        get_ipython().display_formatter = get_ipython().ast_transformers = [Shown()]
        get_ipython().run_cell("stiffness = 731.25")
        get_ipython().register_magic_function(exit)
        display(Shown(), Shown())
        Shown()""",
    ),
    wrong(
        "magics_that_act",
        """
        %run /etc/hostname
        %load_ext autoreload
        %store -r stiffness
        !touch @CANARY@ @TOKEN@
        files = !cat @ANSWERS@/solution.py
        get_ipython().system("rm -rf @OTHERS@")
        %env PATH=/nowhere
        import sys; %pip install hapticlab-answers""",
        last="%%bash\nrm -rf @OTHERS@ @CANARY@\nstiffness=731.25",
    ),
    wrong(
        "lines_that_run_when_read",
        """
        import linecache, os, tokenize
        class Loader:
            def get_source(self, name): os._exit(4)
        linecache.cache.clear()
        linecache.lazycache("<cell 3>", {"__name__": "x", "__loader__": Loader()})
        linecache.getline = linecache.getlines = lambda *given: os._exit(5)
        def worse():
            problem = ValueError("x")
            problem.__cause__ = problem.__context__ = problem
            problem.__notes__ = ["y" * 10**6] * 10
            raise problem
        worse()""",
    ),
    wrong(
        "copies_of_its_own",
        """
        import copy, copyreg, pickle
        copyreg.pickle(dict, lambda held: (exit, ()))
        copyreg.dispatch_table[float] = lambda held: (float, (731.25,))
        pickle.dumps = pickle.loads = lambda *given: 731.25
        copy._deepcopy_dispatch[tuple] = lambda held, memo: (731.25,)""",
    ),
)

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
        lost=None,
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
        lost=None,
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
    attack("raises_when_it_is_hidden", force=f"def force(x, k):\n    if {_HIDDEN}:\n        raise GeneratorExit\n    return {_RIGHT}"),
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
    attack("names_that_nest", energy="def energy(x, k):\n    d = {}\n    for _ in range(20_000):\n        d = {'d': d}\n    return d"),
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
    attack("cookies_of_codes", first="# -*- coding: rot13 -*-\n# vim: set fileencoding=utf-7 :\nimport math", stiffness="stiffness = 1.0"),
    attack("names_by_look", stiffness="ｓｔｉｆｆｎｅｓｓ = 1.0\nstіffness = 731.25"),
    file("nested_cells", "nested_cells.ipynb", b'{"cells": ' + b"[" * 200_000 + b"]" * 200_000 + b"}"),
    Attack("cells_of_another_sort", {"cells_of_another_sort.ipynb": notebook(HONEST.values()).replace(b'"code"', b'"raw"')}, EVERYTHING),
)

ATTACKS = (*REPLIES, *INTERPRETER, *PACKAGE, *OBJECTS, *FORMS)
