"""Sliders above a picture that follows them; the only module that opens ipywidgets."""

import html

from ..base.drawing import DARK, PICTURE
from ..errors import AnalysisError, EngineMissingError, HapticlabError
from .browser_view import around
from .latest_value import Latest

STEPS = 60
#: sliders in view; more fold away, so that the picture stays on the screen
IN_VIEW = 2


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
        # its own size: what is stretched is blurred
        self.image, self.text = (
            widgets.Image(format="png", layout={"width": "auto", "max_width": "100%", "align_self": "flex-start"}),
            widgets.HTML(),
        )
        self.image.add_class(PICTURE)
        self._around = _around()
        self.box = widgets.VBox([*_folded(widgets, [*self.sliders.values()]), self.image, self.text, *self._around])
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
        self.text.value = f"{DARK}{html.escape(sentence)}"
        for beside in self._around:
            beside.words = words

    def _show_error(self, error):
        kind = "" if isinstance(error, HapticlabError) else f"{type(error).__name__}: "
        self.text.value = f"{DARK}<b>no map:</b> {html.escape(f'{kind}{error}')}"

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


def _folded(widgets, sliders):
    """The sliders in view, and one line that unfolds the others."""
    shown, more = sliders[:IN_VIEW], sliders[IN_VIEW:]
    if len(more) < 2:  # the line would take the place of the one
        return sliders
    names = ", ".join(slider.description for slider in more)
    return [*shown, widgets.Accordion([widgets.VBox(more)], titles=(f"more sliders: {names}",))]


def _slider(widgets, name, low, high, value, unit):
    value = min(max(value, low), high)
    steps = round((value - low) / (high - low) * STEPS)  # one of them is the value: a browser rounds to steps
    step = (value - low) / steps if steps else (high - low) / STEPS
    return widgets.FloatSlider(
        value=value, min=low, max=high, step=step, description=f"{name} [{unit}]",
        continuous_update=True, readout_format=".3g", style={"description_width": "9em"}, layout={"width": "32em"},
    )  # fmt: skip
