"""hapticlab: from an equation of motion to a felt virtual wall.

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
>>> log = paddle.run(hl.wall()(k=150, x_o=0.01), duration=0.5)
>>> float(hl.passivity_limit(hl.Device(b=0.1, T="1 ms")))
200.0
"""

import builtins
import sys

import lazy_loader

# Each public name is loaded on first use, as Scientific Python's SPEC 1 describes: a command line or a notebook server
# that needs one of them does not wait for all of SymPy. The names and their modules are in __init__.pyi.
_load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name):
    if name in __all__:
        return _load(name)
    if name.startswith("_"):  # what Python and notebooks ask of every module
        raise AttributeError(f"hapticlab has no {name}")
    try:
        return _load(name)
    except AttributeError:
        from .vocabulary import unknown  # opens every page, so only here

        raise AttributeError(unknown(name)) from None


__version__ = "0.2.0"

if hasattr(builtins, "get_ipython"):  # hl.<tab> in a notebook, and errors of one breath
    from .base.completion import complete_in
    from .slips.shown import show_in

    complete_in(builtins.get_ipython())
    show_in(builtins.get_ipython())


def _show_in_script(kind, problem, trace, before=sys.excepthook):
    from .slips.shown import show_in_script  # opened by an error alone

    show_in_script(problem, lambda: before(kind, problem, trace))


sys.excepthook = _show_in_script
