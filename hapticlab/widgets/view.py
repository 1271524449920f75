"""A wall map that follows its sliders; the only module that opens ipywidgets."""

import math
from collections.abc import Mapping

from ..analysis.walls.wall_map import OTHERS, WallMaps, changed
from ..analysis.walls.wall_map_plot import WallMapPicture
from ..errors import AnalysisError, EngineMissingError
from .front import around
from .latest import Latest

#: what a slider may move beside what a map may be over, and its unit
MORE = {"hand_k": "N/m", "hand_push": "N", "force_max": "N"}
STEPS = 60


def explore(paddle, *, sliders=None, law="zoh", over=("K", "B"), **given):
    """Wall map in a notebook that is drawn anew while a slider moves.

    While a map is computed only the newest place of the sliders waits: none pile up.

    Parameters
    ----------
    paddle : SimulatedPaddle
    sliders : dict of str to (low, high), optional
        In SI, of T, delay, m, b, coulomb, counts_per_metre, force_max, hand_m, hand_b, hand_k, hand_push: all that the
        paddle has and the map is not over. By default m, b, delay, and what the paddle has of coulomb and of a hand.
    law, over, **given
        As for :func:`hapticlab.wall_map`; the axes stay as they are at first.

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


def _open_ipywidgets():
    try:
        import ipywidgets
    except ImportError as missing:
        raise EngineMissingError(
            "hl.explore draws sliders with ipywidgets, which does not import here; do: pip install ipywidgets, in the "
            "environment of the notebook. hl.wall_map(...).plot() draws one map without it"
        ) from missing
    return ipywidgets


class MapView:
    """Sliders above a picture of a wall map. Attributes: ``paddle`` and ``map``, what is on view; ``box``, the widget."""

    def __init__(self, paddle, maps, sliders=None):
        widgets = _open_ipywidgets()
        self.maps, self.first, self.paddle, self.map = maps, paddle, paddle, None
        self._picture = None
        spans = _default_sliders(paddle, maps.over) if sliders is None else sliders
        if not isinstance(spans, Mapping):
            raise AnalysisError(f'sliders = {sliders!r}; needs a dict of name to (low, high), as sliders={{"b": (0.05, 0.5)}}')
        self.sliders = {name: _slider(widgets, paddle, maps.over, name, span) for name, span in spans.items()}
        self.image, self.text = widgets.Image(format="png"), widgets.HTML()
        self._around = _around()
        self.box = widgets.VBox([*self.sliders.values(), self.image, self.text, *self._around])
        self._latest = Latest(self._draw, self._show_error)
        for slider in self.sliders.values():
            slider.observe(self._moved, names="value")
        self._moved()

    def set(self, **values):
        """Move sliders, as a mouse does."""
        for name, value in values.items():
            if name not in self.sliders:
                raise AnalysisError(f"{name} is no slider here; there are {', '.join(self.sliders)}")
            self.sliders[name].value = value

    def wait(self, timeout=None):
        """Wait until the map shows where the sliders are; return whether it does in time [s]."""
        return self._latest.wait(timeout)

    def _moved(self, change=None):
        self._latest.ask({name: slider.value for name, slider in self.sliders.items()})

    def _draw(self, values):
        paddle = self.first
        for name, value in values.items():
            paddle = changed(paddle, name, value)
        found = self.maps.of(paddle)
        if self._picture is None:
            self._picture = WallMapPicture(found, every=True)
            self._picture.figure.canvas.draw()  # lays it out, once
        self._picture.show(found)
        self.image.value = self._picture.figure._repr_png_()
        self.paddle, self.map = paddle, found
        self.text.value = f"{found.regions.size} contacts in {found.seconds:.2f} s"
        for beside in self._around:
            beside.words = str(found).splitlines()[0]

    def _show_error(self, error):
        self.text.value = f"<b>{type(error).__name__}</b>: {error}"

    def _repr_mimebundle_(self, **options):
        return self.box._repr_mimebundle_(**options)


def _around():
    """Return what gives the picture words and keeps a notebook's keys from the sliders; nothing without anywidget."""
    try:
        return (around(),)
    except EngineMissingError:
        return ()


def value_of(paddle, name):
    """Return a quantity of a paddle or of its hand; None where it has none."""
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


def _slider(widgets, paddle, over, name, span):
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
    return widgets.FloatSlider(
        value=min(max(value, low), high), min=low, max=high, step=(high - low) / STEPS, description=f"{name} [{units[name]}]",
        continuous_update=True, readout_format=".3g", style={"description_width": "9em"}, layout={"width": "32em"},
    )  # fmt: skip
