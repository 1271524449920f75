"""Work that turns Python itself against whoever evaluates it: its imports, its hooks, its threads, its memory."""

from .attack import attack


def wrong(name, first, **more):
    """Return an attack that prepares something in its first cell, and has a wrong stiffness and a wrong choice."""
    return attack(name, first=first, stiffness="stiffness = 1.0", why='why = "a"', **more)


ATTACKS = (
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
            if type(held.get("value")) is float and held["value"] == 1.0:
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
                if type(getattr(one, "limits", None)) is dict:
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
            def getvalue(self): return Text("731.25" * 10**4)
            def write(self, text): raise SystemExit(0)
        class Text(str):
            def __getitem__(self, part): return self
            def __len__(self): return 3
        io.StringIO = Output
        sys.stdout = sys.stderr = sys.__stdout__ = Output()""",
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
