"""An error of one breath: the student's own line and the sentence; the whole traceback is one call away."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable
from functools import partial
from pathlib import Path
from traceback import walk_tb
from typing import Any

from ..errors import HapticlabError
from .foreign import in_our_words
from .own_line import PACKAGE, of_error
from .swallowed import swallowed
from .syntax import unreadable


def one_breath(problem: BaseException, more: str = "") -> str:
    """The own line and the sentence; empty for an error that is neither hapticlab's nor about what it made.

    Parameters
    ----------
    problem : exception
        With its traceback.
    more : str
        How to see the rest, as a last line.
    """
    place, sentence = _told(problem)
    return f"{place}{sentence}" + (f"\n\n{more}" if more else "") if sentence else ""


def _told(problem):
    """Return the own line under its place, and the sentence; two empty texts where there is none."""
    try:
        own = of_error(problem.__traceback__)
        sentence = _sentence(problem, own) if own else ""
    except Exception:  # a student's own classes may raise anything, wherever they are looked at
        return "", ""
    line = f"{textwrap.indent(own.text, '    ')}\n\n" if sentence and own.text else ""
    return (f"{type(problem).__name__} in {own.where}\n{line}", sentence) if sentence else ("", "")


def _sentence(problem, own):
    if not (isinstance(problem, HapticlabError) or _said_by_us(problem)):
        return in_our_words(problem, own) if own.involves_us() else ""
    said = str(problem)
    lost = swallowed(own, said)
    return f"{said.rstrip('.')}. {lost}" if lost and lost not in said else said


def _said_by_us(problem):
    """Whether an error of Python's own kind was raised in words, by what hapticlab answers to a name that it does not have."""
    if not isinstance(problem, AttributeError):
        return False
    *_, (frame, _) = walk_tb(problem.__traceback__)
    return frame.f_code.co_name == "__getattr__" and Path(frame.f_code.co_filename).is_relative_to(PACKAGE)


def show_in(shell: Any) -> None:
    """Let a shell of IPython show errors in one breath, and the whole at ``%tb``.

    IPython asks an error how it is shown. Of hapticlab's own every one can tell; other libraries' are told it on their way
    out of a cell, where they are about what hapticlab made. A handler of errors that was there before keeps its own.
    """
    if not hasattr(shell, "set_custom_exc"):
        return
    others, handled = shell.custom_exceptions, shell.CustomTB if shell.custom_exceptions else None

    def render(problem):
        asked_before, problem._shown = getattr(problem, "_shown", False), True  # %tb asks once more: it wants the whole
        short = "" if asked_before else one_breath(problem, "%tb shows the whole traceback.")
        return [short] if short else shell.InteractiveTB.structured_traceback(type(problem), problem, problem.__traceback__)

    def handler(shell, kind, problem, trace, tb_offset=None):
        if handled and isinstance(problem, others):
            return handled(kind, problem, trace, tb_offset)
        if not isinstance(problem, HapticlabError) and one_breath(problem):
            problem._render_traceback_ = partial(render, problem)
        return shell.showtraceback((kind, problem, trace), tb_offset=tb_offset)

    def read(result):  # after a cell: what Python could not even read is told below its own words
        problem = result.error_before_exec
        if isinstance(problem, SyntaxError) and (cure := unreadable(problem, result.info.raw_cell, shell.user_ns)):
            print(cure, file=sys.stderr)

    shell.events.register("post_run_cell", read)
    HapticlabError._render_traceback_ = render  # type: ignore[attr-defined]
    shell.set_custom_exc((Exception,), handler)


def show_in_script(problem: BaseException, before: Callable[[], None]) -> None:
    """Show an error that ends a script; ``before`` shows it as Python does.

    Another library's error keeps its traceback, with the sentence as a note below; so does every error under ``python -X dev``.
    """
    _, sentence = _told(problem)
    if sentence and isinstance(problem, HapticlabError) and not sys.flags.dev_mode:
        print(one_breath(problem, whole(problem)), file=sys.stderr)
        return
    if sentence not in ("", str(problem)):
        problem.add_note(sentence)
    before()


def whole(problem: BaseException) -> str:
    """How to see the whole traceback of a script."""
    own = of_error(problem.__traceback__)
    return f"python -X dev {Path(own.file).name} shows the whole traceback." if own else ""
