"""Pictures of the library's mechanisms: every symbol is there, inside the frame, and no text covers another."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.plots import new_figure
from hapticlab.library.entries import CATALOGUE

#: parameters that a picture does not name: constants of nature, losses, starts
UNNAMED = {"c", "B", "theta_0", "A", "k", "k_3", "k_w", "e", "F_s", "F_c", "alpha", "g", "p", "Omega", "P", "F_0", "w"}
GREEK = {
    "theta": r"\theta", "phi": r"\varphi$", "phi_2": r"\varphi_2", "beta": r"\beta", "psi": r"\psi", "rho": r"\rho",
}  # fmt: skip


def texts(figure):
    """Return the figure's texts with their boxes in pixels."""
    figure.draw_without_rendering()
    axes = figure.axes[0]
    return [(text.get_text(), text.get_window_extent()) for text in axes.texts if text.get_text()]


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_picture_shows_handle_and_symbols_apart_from_each_other(name):
    figure = hl.picture(name)
    shown = texts(figure)
    words = " ".join(text for text, _ in shown)
    assert "handle" in words and "$x$" in words
    scene = CATALOGUE[name].scene()
    for symbol in {type(q).__name__ for q in scene.coordinates} | (set(scene.parameters) - UNNAMED):
        assert GREEK.get(symbol, symbol) in words, symbol
    frame = figure.bbox
    for k, (text, box) in enumerate(shown):
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1, text
        for other, near in shown[k + 1 :]:
            assert not box.overlaps(near), (text, other)


@pytest.mark.parametrize("entry", CATALOGUE.values(), ids="{0.name}".format)
def test_a_picture_moves_with_its_handle(entry):
    figure = new_figure(height=1)
    axes = figure.subplots(2)
    for x, one in zip((0.0, 0.03), axes, strict=True):
        entry.draw(one, x=x)
    (here, there) = ([np.asarray(patch.get_xy()) for patch in one.patches] for one in axes)
    assert any(not np.array_equal(a, b) for a, b in zip(here, there, strict=True))


def test_what_a_picture_does_not_know_is_refused():
    with pytest.raises(hl.SceneError, match="did you mean detents"):
        hl.picture("detent")
    with pytest.raises(hl.AnalysisError, match="y: detents has no such quantity; it has x, A, p"):
        hl.picture("detents", y=1)
    with pytest.raises(hl.AnalysisError, match="four_bar cannot be put together with b = 0.005; take other lengths"):
        hl.picture("four_bar", b=0.005)
    with pytest.raises(hl.UnitsError, match="x = '3 N'"):
        hl.picture("gears", x="3 N")
