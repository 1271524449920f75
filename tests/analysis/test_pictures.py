"""Pictures of the library's mechanisms: every symbol is there, inside the frame, and no text covers another."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.drawing import new_figure
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


#: states that reach far, beside the default one of every scene
FAR = [
    ("cart_pole", {"theta": 2.5}), ("cart_pole", {"theta": -2.8, "x": 0.05, "z": 0.06}),
    ("pendulum_on_the_handle", {"theta": -2.8}), ("virtual_fixture", {"k": 600}), ("virtual_fixture", {"x": 0.045}),
    ("four_bar", {"theta": 4}), ("gears", {"N_1": 20, "N_2": 60}), ("rolling", {"alpha": 0.2}), ("rolling", {"alpha": -0.3}),
    ("rolling", {"z": -0.04}), ("slider_crank", {"theta": 3, "x": -0.03}), ("mass_spring_damper", {"x": 0.04, "z": 0}),
    ("tuned_absorber", {"x": 0.04, "z_1": 0}), ("two_masses", {"x": 0.04, "z_1": 0}), ("stick_slip", {"x": 0.05, "z": 0.04}),
]  # fmt: skip


@pytest.mark.parametrize(("name", "state"), [*((name, {}) for name in CATALOGUE), *FAR])
def test_a_picture_shows_handle_and_symbols_apart_from_each_other(name, state):
    figure = hl.picture(name, **state)
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
    title = figure.axes[0].title.get_window_extent()
    drawn = [box for _, box in shown] + [body.get_window_extent() for body in figure.axes[0].patches]
    assert title.y0 > max(box.y1 for box in drawn)
    assert min(box.x0 for box in drawn) >= frame.x0 and max(box.x1 for box in drawn) <= frame.x1
    assert min(box.y0 for box in drawn) >= frame.y0


def bodies(figure):
    """Return the corners (left, bottom, right, top) of what is filled."""
    outlines = [np.asarray(patch.get_xy()) for patch in figure.axes[0].patches]
    return [(*outline.min(axis=0), *outline.max(axis=0)) for outline in outlines]


@pytest.mark.parametrize(
    ("name", "state"), [("mass_spring_damper", {"z": 0}), ("two_masses", {"z_1": 0}), ("tuned_absorber", {"z_1": 0})]
)
def test_the_handle_stays_out_of_the_mass(name, state):
    handle, mass = bodies(hl.picture(name, x=0.04, **state))[:2]
    assert handle[0] < 0.04 < handle[2] < mass[0] - 0.01


def test_wheels_stay_on_the_ground_and_the_plate_is_tilted():
    axes = hl.picture("rolling", z=-0.04, x=-0.03).axes[0]
    wheels = [box for box in bodies(axes.figure) if 0.006 < box[2] - box[0] < 0.008 and box[1] < -0.012]
    ground = next(line for line in axes.lines if line.get_linewidth() == 1.6)
    assert len(wheels) == 3
    assert ground.get_xdata()[0] < min(box[0] for box in wheels)
    assert ground.get_xdata()[1] > max(box[2] for box in wheels)
    (start, end) = next(
        line.get_xydata() for line in hl.picture("rolling", alpha=0.2).axes[0].lines if line.get_linewidth() == 1.6
    )
    assert np.arctan2(*(end - start)[::-1]) == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("k", [20, 150, 600])
def test_the_wall_of_a_fixture_rises_to_the_edge_and_its_well_stays_above_the_letters(k):
    axes = hl.picture("virtual_fixture", k=k).axes[0]
    at, U = next(line for line in axes.lines if len(line.get_xdata()) == 801).get_data()
    wall = U[at > 0.0351]
    assert np.all(np.diff(wall, 2) > 0)  # a parabola, no plateau
    assert U.min() >= -0.0091


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
    with pytest.raises(hl.AnalysisError, match="a Scene has no picture; hl.picture draws the library's scenes by name"):
        hl.picture(hl.library.detents())
    assert hl.picture(hl.library.detents).axes[0].get_title() == "detents"
    with pytest.raises(hl.UnitsError, match="x = '3 N'"):
        hl.picture("gears", x="3 N")
