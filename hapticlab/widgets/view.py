"""A wall map that follows its sliders."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..analysis.walls.wall_map import OTHERS, WallMaps, changed
from ..analysis.walls.wall_map_plot import WallMapPicture
from ..errors import AnalysisError
from .sliders import FollowedPicture

if TYPE_CHECKING:
    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: what a slider may move beside what a map may be over, and its unit
MORE = {"hand_k": "N/m", "hand_push": "N", "force_max": "N"}
_CURE = (
    "hl.stability.explore draws sliders with ipywidgets, which does not import here; do: pip install ipywidgets, in the "
    "environment of the notebook. hl.stability.wall_map(...).plot() draws one map without it"
)


def explore(
    paddle: SimulatedPaddle,
    *,
    sliders: Mapping[str, tuple[float, float]] | None = None,
    law: Any = "zoh",
    over: tuple[str, str] = ("K", "B"),
    **given: Any,
) -> MapView:
    """Wall map in a notebook that is drawn anew while a slider moves.

    While a map is computed only the newest place of the sliders waits: none pile up.

    Parameters
    ----------
    paddle : SimulatedPaddle
    sliders : dict of str to (low, high), optional
        In SI, of T, delay, m, b, coulomb, counts_per_metre, force_max, hand_m, hand_b, hand_k, hand_push: all that the
        paddle has and the map is not over. By default m, b, delay, and what the paddle has of coulomb and of a hand.
    law, over, **given
        As for :func:`hapticlab.stability.wall_map`; the axes stay as they are at first.

    Returns
    -------
    MapView
        A notebook shows it where it is the last line of a cell; ``.map`` is the WallMap on view.

    Raises
    ------
    EngineMissingError
        Without ipywidgets.
    AnalysisError
        For a slider of something that the paddle has not.

    Examples
    --------
    >>> import hapticlab as hl, pytest; _ = pytest.importorskip("ipywidgets")
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, push=1.0))
    >>> view = explore(paddle, sliders={"b": (0.05, 0.5)}, points=10, duration=0.2)
    >>> view.set(b=0.4)
    >>> view.wait(60), view.map.regions.shape, round(view.paddle.b, 2)
    (True, (10, 10), 0.4)
    """
    return MapView(paddle, WallMaps(paddle, law=law, over=over, **given), sliders)


class MapView(FollowedPicture):
    """Sliders above a picture of a wall map. Attributes: ``paddle`` and ``map``, what is on view; ``box``, the widget."""

    def __init__(self, paddle, maps, sliders=None):
        self.maps, self.first, self.paddle, self.map = maps, paddle, paddle, None
        self._picture = None
        spans = _default_sliders(paddle, maps.over) if sliders is None else sliders
        if not isinstance(spans, Mapping):
            raise AnalysisError(f'sliders = {sliders!r}; needs a dict of name to (low, high), as sliders={{"b": (0.05, 0.5)}}')
        super().__init__({name: _span(paddle, maps.over, name, span) for name, span in spans.items()}, _CURE)

    def drawn(self, values):
        """The map of a paddle with these values, its computing time, and its own words."""
        paddle = self.first
        for name, value in values.items():
            paddle = changed(paddle, name, value)
        found = self.maps.of(paddle)
        if self._picture is None:
            self._picture = WallMapPicture(found, every=True)
            self._picture.figure.canvas.draw()  # lays it out, once
        self._picture.show(found)
        self.paddle, self.map = paddle, found
        return self._picture.figure, f"{found.regions.size} contacts in {found.seconds:.2f} s", str(found).splitlines()[0]


def value_of(paddle, name):
    """A quantity of a paddle or of its hand; None where it has none."""
    if name.startswith("hand_"):
        return None if paddle.hand is None else getattr(paddle.hand, name.removeprefix("hand_"))
    return getattr(paddle, name)


def _default_sliders(paddle, over):
    names = [name for name in ("m", "b", "delay", "coulomb", "hand_m", "hand_b", "hand_k") if name not in over]
    spans = {"delay": (0.0, 3 * paddle.T)}
    for name in names:
        value = value_of(paddle, name)
        if value and name != "delay":
            spans[name] = (value / 5, 3 * value)
    return {name: spans[name] for name in names if name in spans}


def _span(paddle, over, name, span):
    """(low, high, value, unit) of a slider that moves something which the paddle has and the map is not over."""
    units = {name: unit for name, unit in (OTHERS | MORE).items() if name != "B"}
    if name not in units:
        raise AnalysisError(f"{name}: nothing has that name; a slider moves one of {', '.join(units)}")
    if name in over:
        raise AnalysisError(f"{name} is an axis of the map; a slider moves something else")
    value = value_of(paddle, name)
    if value is None:
        raise AnalysisError(f"the paddle has no {name}; give it one for its slider to move")
    try:
        low, high = (float(end) for end in span)
    except (TypeError, ValueError):
        raise AnalysisError(f"{name} = {span!r}; a slider needs (low, high), two numbers in {units[name]}") from None
    if not low < high < math.inf:
        raise AnalysisError(f"{name} = {span}; a slider needs (low, high) with low < high")
    return low, high, value, units[name]
