"""From an answer to plain values: whatever a student wrote is called, converted, and never believed.

What comes out holds numbers, texts, lists and dicts of Python itself, so it can cross a pipe as JSON. What is expected is
not known here.
"""

from __future__ import annotations

import copy
import inspect
import io
import sys
from contextlib import contextmanager, redirect_stdout
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import HapticlabError
from ..scene.scene import Scene
from ..slips.foreign import in_our_words
from ..slips.own_line import of_error
from .expression import unit_remark, values
from .felt import felt
from .outcome import Outcome
from .plain_values import NotPlain, a, plain
from .plotted_curves import curves

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .exercise import Kind


def evaluate(kind: Kind, answer: object, given: Mapping[str, Any]) -> Outcome:
    """The outcome of an answer for one case; it never raises, except where a person interrupts.

    Parameters
    ----------
    kind : str
        Of the exercise, see :class:`hapticlab.course.exercise.Exercise`.
    answer : object
        Whatever the notebook holds under the exercise's name.
    given : dict
        Of the case.

    Returns
    -------
    Outcome

    Examples
    --------
    >>> evaluate("function", lambda x, k: k * x, {"x": 0.012, "k": 200.0})
    Outcome(value=2.4, problem='', printed='')
    >>> evaluate("function", lambda position: 200 * position, {"x": 0.012}).problem
    'it takes (position), but is called with x=; keep the argument names of the notebook'
    >>> evaluate("value", None, {}).answered
    False
    """
    output = io.StringIO()
    with redirect_stdout(output):
        outcome = _guarded(kind, answer, given)
    return outcome if output.closed else replace(outcome, printed=output.getvalue())


def _guarded(kind, answer, given):
    try:
        return _evaluated(kind, answer, copy.deepcopy(dict(given)))
    except KeyboardInterrupt:
        raise
    except NotImplementedError:
        return Outcome()
    except HapticlabError as problem:
        return Outcome(problem=_bounded(problem))
    except BaseException as problem:  # sys.exit() and whatever else a student's code may raise
        return Outcome(problem=_raised(problem))


def _evaluated(kind, answer, given):
    if _empty(answer):
        return Outcome()
    if kind == "scene":
        scene = answer if isinstance(answer, Scene) or not callable(answer) else answer()
        if _empty(scene):
            return Outcome()
        return Outcome(plain(felt(scene, **given)))
    if kind == "expression":
        remark = unit_remark(answer, given.pop("unit", ""))
        return Outcome(values(answer, **given), remark)
    if kind == "plot":
        with _own_figure():
            return _returned(answer, given, curves) if callable(answer) else Outcome(curves(answer))
    return _returned(answer, given, plain) if kind == "function" else Outcome(plain(answer))


def _returned(function, given, convert):
    """Return the outcome of what a function returns."""
    returned = _called(function, given)
    if returned is None:
        return Outcome(problem="it returns None; is its `return` missing?")
    return Outcome(convert(returned))


@contextmanager
def _own_figure():
    """Let ``plt.plot`` draw into a figure of its own and not over that of the case before; figures open before stay open."""
    before = _pyplot_figures()
    if before:
        sys.modules["matplotlib.pyplot"].figure()
    try:
        yield
    finally:
        for number in set(_pyplot_figures()).difference(before):
            sys.modules["matplotlib.pyplot"].close(number)


def _pyplot_figures():
    pyplot = sys.modules.get("matplotlib.pyplot")
    return pyplot.get_fignums() if pyplot else []


def _called(function, given):
    """The value of a function, called by the names of the notebook."""
    if not callable(function):
        raise NotPlain(f"it is {a(function)}, needs a function of ({', '.join(given)})")
    mismatch = _mismatch(function, given)
    if mismatch:
        raise NotPlain(mismatch)
    return function(**{name: _argument(value) for name, value in given.items()})


def _argument(value):
    """Return an array of float for a list of numbers: in one of integers, what a student writes into it is cut off."""
    if not isinstance(value, list | tuple):
        return value
    array = np.array(value)
    return array.astype(float) if array.dtype.kind == "i" else array


def _empty(answer):
    """Whether nothing was written yet: None, an ellipsis, an empty text."""
    return answer is None or answer is ... or (isinstance(answer, str) and not str.strip(answer))


def _mismatch(function, given):
    """Return why a function cannot be called with these names, or an empty text."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # what is written in C may have none
        return ""
    try:
        signature.bind(**given)
        return ""
    except TypeError:
        called = ", ".join(f"{name}=" for name in given) or "no argument"
        return (
            f"it takes ({', '.join(signature.parameters)}), but is called with {called}; keep the argument names of the notebook"
        )


def _raised(problem):
    """Return an error of the student's in one line, with the line of their code where it arose."""
    lines, trace = [], problem.__traceback__
    while trace:
        if trace.tb_frame.f_globals.get("__name__") == "__main__":
            lines.append(trace.tb_lineno)
        trace = trace.tb_next
    where = f" in line {lines[-1]} of its cell" if lines else ""
    return f"it raises {type(problem).__name__}{where}: {_in_our_words(problem) or _bounded(problem)}"


def _in_our_words(problem):
    """Return the sentence about another library's error, or an empty text."""
    try:
        own = of_error(problem.__traceback__)
        return in_our_words(problem, own) if own else ""
    except Exception:  # their own __str__ may raise anything
        return ""


def _bounded(problem):
    try:
        return " ".join(str.__str__(str(problem)).split())[:300] or "no message"
    except Exception:  # their own __str__ may raise anything
        return "no readable message"
