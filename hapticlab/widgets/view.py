"""A wall map that follows its sliders."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

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
    """Wall map in a notebook that is redrawn while a slider moves.

    While a map is computed only the newest place of the sliders waits: none pile up.

    Parameters
    ----------
    paddle : SimulatedPaddle
    sliders : dict of str to (low, high), optional
        In SI, of T, delay, m, b, coulomb, counts_per_metre, force_max, hand_m, hand_b, hand_k, hand_push: all that the
        paddle has and the map is not over. By default m, b, delay, and what the paddle has of coulomb and of a hand.
    law, over, **given
        As for :func:`hapticlab.stability.wall_map`; the axes stay as they are at first. Unless K is given, it goes from
        below the passivity limit to beyond exact stability, so that both borders are in view.

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
    maps = WallMaps(paddle, law=law, over=over, **given)
    if "K" not in given and (K := _around_borders(maps, paddle)) is not None:
        maps = WallMaps(paddle, law=law, over=over, K=K, **given)
    return MapView(paddle, maps, sliders)


def _around_borders(maps, paddle):
    """Stiffnesses from below the passivity limit of this paddle to beyond its exact stability; None where no theory is known."""
    found = maps.of(paddle)
    known = {name: _at_own(found, name, paddle, maps) for name in ("passivity", "stability") if name in found.limits}
    ends = [K for K in known.values() if 0 < K < math.inf]
    return np.geomspace(min(ends) / 2, 2.5 * max(ends), len(found.axes["K"])) if ends else None


def _at_own(found, name, paddle, maps):
    """Return a limit [N/m] where the other axis has what the paddle has; a map over B has the wall's own, 0 unless given."""
    other = maps.over[1]
    own = maps.B if other == "B" else value_of(paddle, other)
    return float(np.interp(own, found.rows, found.limit(name)))


class MapView(FollowedPicture):
    """Sliders above a picture of a wall map. Attributes: ``paddle`` and ``map``, what is on view; ``box``, the widget."""

    def __init__(self, paddle, maps, sliders=None):
        self.maps, self.first, self.paddle, self.map = maps, paddle, paddle, None
        self._picture = None
        self._first = {}
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
        words = self._limits_in_words(found, paddle)
        return self._picture.figure, words, f"{str(found).splitlines()[0]}. {words}"

    def _limits_in_words(self, found, paddle):
        """What became of the limits, beside those of the paddle as it was given."""
        other = self.maps.over[1]
        own = self.maps.B if other == "B" else value_of(paddle, other)
        said = []
        for name, does in (("stability", "exact linear stability"), ("passivity", "passivity in any hand")):
            if name in found.limits:
                K = _at_own(found, name, paddle, self.maps)
                before = self._first.setdefault(name, K)
                said.append(
                    f"{does} up to {K:.5g} N/m" + (f", at first {before:.5g} N/m" if f"{K:.5g}" != f"{before:.5g}" else "")
                )
        moves = found.share("chatters") + found.share("unusable")
        said.append(f"{100 * moves:.0f} % of the simulated contacts on the map keep oscillating")
        words = f"At {other} = {own:g} {found.units[other]}: {'; '.join(said)}."
        return f"{words} {found.beyond_words[:1].upper()}{found.beyond_words[1:]}".strip() + ("." if found.beyond_words else "")


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
            spans[name] = (value / 4, 3 * value)
    return {name: spans[name] for name in names if name in spans}


def _span(paddle, over, name, span):
    """(low, high, value, unit) of a slider that moves something which the paddle has and the map is not over."""
    units = {name: unit for name, unit in (OTHERS | MORE).items() if name != "B"}
    if name not in units:
        raise AnalysisError(f"{name} is not a quantity that a slider can move. Give one of {', '.join(units)}")
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
