"""Figures in a notebook with a text for who cannot see them."""

from __future__ import annotations

from typing import Any

from ..analysis.records.plot import plot
from ..base.arguments import what_is
from ..base.drawing import bundle, forget
from ..base.figure_words import describe
from ..base.in_notebook import display, in_a_notebook
from ..base.telemetry import Telemetry
from ..errors import AnalysisError


def show(figure: Any, alt: str | None = None) -> None:
    """Show a figure in a notebook, with an alternative text.

    The text is read aloud by a screen reader, stands for the figure where it cannot be shown, and travels with the
    notebook into HTML. Without a notebook it is printed. A figure of this package that a cell returns carries one as
    well.

    Parameters
    ----------
    figure : matplotlib figure, or a result or record of this package
        A result is plotted as its ``.plot()`` does, a record as ``hl.plot`` does.
    alt : str, optional
        What there is to see, in a sentence or two: what is drawn over what, and what follows from it. By default the
        result's own words, and what the axes and lines say. Write your own where the figure makes a point.

    Raises
    ------
    AnalysisError
        For what is no figure and draws none.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0))
    >>> hl.show(hl.plot(paddle.run(hl.wall()(k=500), duration=0.1)), alt="The handle rests 2 mm inside the wall.")
    The handle rests 2 mm inside the wall.
    """
    drawn, words = _drawn(figure)
    if alt is None:
        alt = getattr(drawn, "alt", None) or _told(words, describe(drawn))
    elif not isinstance(alt, str) or not alt.strip():
        raise AnalysisError(f"alt = {alt!r}; needs what there is to see in a sentence or two, or leave it out")
    forget(drawn)
    if in_a_notebook():
        display(*bundle(drawn, alt))
    else:
        print(alt)


def _told(words, described):
    """Return a result's words before what its figure shows, unless the title says them."""
    start = " ".join(words.split())[:40].lower()
    return described if start in described.lower() else f"{words}\n{described}"


def _drawn(given):
    """Return the figure of what was given, and the words of a result."""
    if hasattr(given, "savefig") and hasattr(given, "axes"):
        return given, ""
    if hasattr(given, "figure") and hasattr(given.figure, "savefig"):  # Axes
        return given.figure, ""
    if isinstance(given, Telemetry):
        return plot(given), str(given)
    if not callable(getattr(type(given), "plot", None)):
        if type(given).__module__.startswith("hapticlab."):
            raise AnalysisError(f"hl.show of {what_is(given)}; that is words and numbers, without a picture: print it")
        raise AnalysisError(
            f"hl.show of {what_is(given)}; needs a figure, as hl.plot(log) makes one, or a result that has .plot()"
        )
    return given.plot(), str(given)
