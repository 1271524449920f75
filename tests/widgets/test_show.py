"""hl.show: the figure and its words reach a notebook together; without a notebook the words are printed."""

import base64
from html.parser import HTMLParser

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.base.drawing import new_figure
from hapticlab.base.figure_words import describe
from hapticlab.widgets import show as module

pytest.importorskip("matplotlib")
ALT = 'Handle rests at "2 mm" <inside> the wall.'


def record():
    t = np.arange(200) * 1e-3
    return hl.records.Telemetry(t=t, x=1e-3 * np.sin(60 * t), v=0 * t, F=3 * t, T=1e-3)


class Images(HTMLParser):
    """Collects the attributes of images."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.found.append(dict(attributes))


@pytest.fixture
def notebook(monkeypatch):
    """Stand in for a notebook; give what it was shown."""
    display = pytest.importorskip("IPython.display")
    shown = []
    monkeypatch.setattr(module, "in_a_notebook", lambda: True)
    monkeypatch.setattr(display, "display", lambda data, **more: shown.append((data, more)))
    return shown


def check(data, metadata, alt):
    """Check that picture and words are there, in every form a front end may choose."""
    (image,) = Images(data["text/html"]).found
    assert f".{image['class']} " in data["text/html"].split("</style>")[0]  # turned dark on a dark page
    assert image["alt"] == alt and metadata == {"image/png": {"alt": alt}} and data["text/plain"] == alt
    assert image["src"] == "data:image/png;base64," + data["image/png"]
    assert base64.b64decode(data["image/png"]).startswith(b"\x89PNG")


def test_a_notebook_gets_the_picture_and_the_words(notebook):
    hl.show(hl.plot(record()), alt=ALT)
    ((data, more),) = notebook
    assert more["raw"] is True
    check(data, more["metadata"], ALT)


def test_a_figure_that_a_cell_returns_carries_words_too():
    figure = hl.plot(record())
    data, metadata = figure._repr_mimebundle_()
    check(data, metadata, describe(figure))
    figure.alt = ALT
    check(*figure._repr_mimebundle_(), ALT)


def test_a_figure_of_pyplot_is_shown_once(notebook):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    figure, axes = pyplot.subplots()
    hl.show(axes, alt=ALT)
    assert not pyplot.fignum_exists(figure.number) and len(notebook) == 1


def test_without_a_notebook_the_words_are_printed(capsys):
    hl.show(hl.plot(record()), alt=ALT)
    assert capsys.readouterr().out == ALT + "\n"


def test_a_result_and_a_record_plot_and_describe_themselves(capsys):
    found = hl.energy(record())
    hl.show(found)
    printed = capsys.readouterr().out
    assert "energy [mj] over time t [s], 0 to 0.199" in printed.lower()
    assert printed.lower().count(str(found)[:40].lower()) == 1  # in the title, and not once more before it
    hl.show(record())
    printed = capsys.readouterr().out
    assert printed.startswith("Telemetry(200 samples") and "Force F [N] over time t [s]" in printed


def test_what_is_no_figure_and_no_text_is_refused():
    with pytest.raises(hl.errors.AnalysisError, match="hl.show of an int; needs a figure"):
        hl.show(3)
    with pytest.raises(hl.errors.AnalysisError, match="hl.show of a Requirements; that is words and numbers"):
        hl.show(hl.mechanics.requires(hl.wall()(k=300)))
    with pytest.raises(hl.errors.AnalysisError, match="alt = ' '; needs what there is to see"):
        hl.show(new_figure(height=1), alt=" ")
