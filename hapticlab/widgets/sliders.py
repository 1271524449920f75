"""Sliders above a picture that follows them; the only module that opens ipywidgets."""

from ..errors import AnalysisError, EngineMissingError
from .browser_view import around
from .latest_value import Latest

STEPS = 60


class FollowedPicture:
    """Sliders above a picture that is drawn anew while one moves; a view of its own defines :meth:`drawn`.

    While a picture is computed only the newest place of the sliders waits: none pile up.

    Parameters
    ----------
    spans : dict of str to (low, high, value, unit)
        In SI.
    cure : str
        What to install, and what serves without it, where ipywidgets does not import.

    Attributes
    ----------
    box : widget
        All of it; a notebook shows it where the view is the last line of a cell.
    """

    def __init__(self, spans, cure):
        widgets = open_ipywidgets(cure)
        self.sliders = {name: _slider(widgets, name, *span) for name, span in spans.items()}
        self.image, self.text = widgets.Image(format="png"), widgets.HTML()
        self._around = _around()
        self.box = widgets.VBox([*self.sliders.values(), self.image, self.text, *self._around])
        self._latest = Latest(self._draw, self._show_error)
        for slider in self.sliders.values():
            slider.observe(self._moved, names="value")
        self._moved()

    def drawn(self, values):
        """(figure, sentence below it, words for who cannot see it) at these values of the sliders: each picture draws its own."""
        raise NotImplementedError

    def set(self, **values):
        """Move sliders, as a mouse does."""
        for name, value in values.items():
            if name not in self.sliders:
                raise AnalysisError(f"{name} is no slider here; there are {', '.join(self.sliders)}")
            self.sliders[name].value = value

    def wait(self, timeout=None):
        """Wait until the picture shows where the sliders are; False where it does not in time [s]."""
        return self._latest.wait(timeout)

    def _moved(self, change=None):
        self._latest.ask({name: slider.value for name, slider in self.sliders.items()})

    def _draw(self, values):
        figure, sentence, words = self.drawn(values)
        self.image.value = figure._repr_png_()
        self.text.value = sentence
        for beside in self._around:
            beside.words = words

    def _show_error(self, error):
        self.text.value = f"<b>{type(error).__name__}</b>: {error}"

    def _repr_mimebundle_(self, **options):
        return self.box._repr_mimebundle_(**options)


def open_ipywidgets(cure):
    """The module ipywidgets; where it does not import, an error with this cure."""
    try:
        import ipywidgets
    except ImportError as missing:
        raise EngineMissingError(cure) from missing
    return ipywidgets


def _around():
    """The widget that gives the picture words and keeps a notebook's keys from the sliders; none without anywidget."""
    try:
        return (around(),)
    except EngineMissingError:
        return ()


def _slider(widgets, name, low, high, value, unit):
    return widgets.FloatSlider(
        value=min(max(value, low), high), min=low, max=high, step=(high - low) / STEPS, description=f"{name} [{unit}]",
        continuous_update=True, readout_format=".3g", style={"description_width": "9em"}, layout={"width": "32em"},
    )  # fmt: skip
