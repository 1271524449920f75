"""Pictures of the library's mechanisms: every symbol is there, inside the frame, and no text covers another."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n
from hapticlab.analysis.pictures.pictures import drawing_of
from hapticlab.analysis.pictures.schematic import Schematic
from hapticlab.analysis.pictures.shape_outlines import Outline
from hapticlab.base.drawing import new_figure
from hapticlab.library.entries import CATALOGUE
from hapticlab.library.sketch import BODY, HANDLE, Sketch
from hapticlab.widgets.picture_items import RecordingAxes

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
@pytest.mark.always("four_bar-*", "rolling-*", "gears-*")
def test_a_picture_shows_handle_and_symbols_apart_from_each_other(name, state):
    figure = hl.mechanics.picture(name, **state)
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
    handle, mass = bodies(hl.mechanics.picture(name, x=0.04, **state))[:2]
    assert handle[0] < 0.04 < handle[2] < mass[0] - 0.01


def test_wheels_stay_on_the_ground_and_the_plate_is_tilted():
    axes = hl.mechanics.picture("rolling", z=-0.04, x=-0.03).axes[0]
    wheels = [box for box in bodies(axes.figure) if 0.006 < box[2] - box[0] < 0.008 and box[1] < -0.012]
    ground = next(line for line in axes.lines if line.get_linewidth() == 1.6)
    assert len(wheels) == 3
    assert ground.get_xdata()[0] < min(box[0] for box in wheels)
    assert ground.get_xdata()[1] > max(box[2] for box in wheels)
    (start, end) = next(
        line.get_xydata() for line in hl.mechanics.picture("rolling", alpha=0.2).axes[0].lines if line.get_linewidth() == 1.6
    )
    assert np.arctan2(*(end - start)[::-1]) == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("k", [20, 150, 600])
def test_the_wall_of_a_fixture_rises_to_the_edge_and_its_well_stays_above_the_letters(k):
    axes = hl.mechanics.picture("virtual_fixture", k=k).axes[0]
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
    with pytest.raises(hl.errors.SceneError, match="did you mean detents"):
        hl.mechanics.picture("detent")
    with pytest.raises(hl.errors.AnalysisError, match="y: detents has no such quantity; it has x, A, p"):
        hl.mechanics.picture("detents", y=1)
    with pytest.raises(hl.errors.AnalysisError, match="four_bar cannot be put together with b = 0.005; take other lengths"):
        hl.mechanics.picture("four_bar", b=0.005)
    with pytest.raises(
        hl.errors.AnalysisError, match="a Telemetry has no picture; hl.mechanics.picture draws a scene, or one of the library"
    ):
        hl.mechanics.picture(hl.records.Telemetry(t=[0], x=[0], v=[0], F=[0], T=1e-3))
    assert hl.mechanics.picture(hl.library.detents).axes[0].get_title() == "detents"
    with pytest.raises(hl.errors.UnitsError, match="x = '3 N'"):
        hl.mechanics.picture("gears", x="3 N")


# --- scenes of one's own, drawn from their equations

k, x_o, x_1 = hl.parameters("k x_o x_1", units="N/m m m", values=(300, 0.01, -0.02))


def outline_of(figure, colour):
    """Return the ends (left, right) of the one area of a colour [m]."""
    from matplotlib.colors import to_hex

    (found,) = (patch for patch in figure.axes[0].patches if to_hex(patch.get_facecolor()) == colour)
    return np.asarray(found.get_xy())[:, 0].min(), np.asarray(found.get_xy())[:, 0].max()


def hatched(figure):
    """Return the places x of the upright lines that are drawn as ground [m]."""
    lines = [line.get_xdata() for line in figure.axes[0].lines if line.get_linewidth() == 1.6]
    return sorted(xs[0] for xs in lines if xs[0] == xs[-1])


@pytest.mark.parametrize("law", ["zoh", "ellis", "half_sample"])
@pytest.mark.parametrize("unilateral", ["gate", "clip"])
def test_the_handles_face_meets_the_wall_where_the_force_begins(law, unilateral):
    for place in (0.01, -0.012):
        figure = hl.mechanics.picture(hl.wall(law, unilateral=unilateral)(k=300, x_o=place), x=place)
        assert hatched(figure) == [pytest.approx(outline_of(figure, HANDLE)[1], abs=1e-12)]


def test_walls_to_both_sides_each_hatched_on_its_own():
    force = hl.when(hl.x(n) >= x_o, k * (hl.x(n) - x_o)) + hl.when(hl.x(n) <= x_1, k * (hl.x(n) - x_1))
    figure = hl.mechanics.picture(hl.Scene(force=force))
    left, right = hatched(figure)
    half = np.diff(outline_of(figure, HANDLE))[0] / 2
    assert (left, right) == (pytest.approx(-0.02 - half, abs=1e-12), pytest.approx(0.01 + half, abs=1e-12))
    assert "$x_{o}$" in words(figure) and "$x_{1}$" in words(figure)
    assert Schematic(hl.laws.virtual_damper()).walls == ()


def words(figure):
    return {text.get_text() for text in figure.axes[0].texts}


def mass_on_a_coupler():
    z = hl.coordinate("z", unit="m", initial=hl.x(n))
    m, K, b_c = hl.parameters("m K b_c", units="kg N/m N*s/m", values=(0.05, 200, 0.2))
    F = hl.laws.virtual_coupler(z, K=K, b=b_c)
    return z, m, F


def test_a_mass_meets_its_wall_with_its_own_face():
    z, m, F = mass_on_a_coupler()
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F - hl.when(z >= x_o, k * (z - x_o)))])
    figure = hl.mechanics.picture(scene, x=0.011, z=0.01)
    assert hatched(figure) == [pytest.approx(outline_of(figure, BODY)[1], abs=1e-12)]
    apart = hl.mechanics.picture(scene, x=0.011, z=0.004)
    assert hatched(apart)[0] - outline_of(apart, BODY)[1] == pytest.approx(0.006, abs=1e-12)
    assert max(len(line.get_xdata()) for line in apart.axes[0].lines) > 12  # the coupler's spring


def test_a_pendulum_hangs_from_its_cart_and_a_pole_stands_on_it():
    z, m, F = mass_on_a_coupler()
    theta = hl.coordinate("theta", unit="rad")
    l, g = hl.parameters("l g", units="m m/s^2", values=(0.1, 9.81))
    dz, w = z.diff(hl.t), theta.diff(hl.t)
    kinetic = m * dz**2 / 2 + m * (dz**2 + 2 * l * dz * w * sp.cos(theta) + (l * w) ** 2) / 2
    for sign, below in ((1, True), (-1, False)):
        scene = hl.Scene(force=F, eom=[hl.mechanics.lagrange(kinetic + sign * m * g * l * sp.cos(theta), forces={z: F})])
        figure = hl.mechanics.picture(scene, theta=0.5)
        rod = next(line.get_xydata() for line in figure.axes[0].lines if line.get_linewidth() == 2.5)
        reach = rod[-1] - rod[0]
        assert bool(reach[1] < 0) is below
        assert np.arctan2(reach[0], abs(reach[1])) == pytest.approx(0.5, abs=1e-12)


def test_a_scene_of_the_library_is_drawn_as_the_library_does_also_when_bound_anew():
    for entry in CATALOGUE.values():
        scene = entry.scene()
        assert drawing_of(scene(**dict(scene.values))) is entry.draw
    assert isinstance(drawing_of(hl.Scene(force=k * hl.x(n), name="detents of my own")), Schematic)


@pytest.mark.parametrize(
    ("shape", "core", "radius"),
    [
        (hl.shapes.Circle("5 mm"), [(0, 0)], 5e-3),
        (hl.shapes.Capsule("20 mm", "4 mm"), [(-0.01, 0), (0.01, 0)], 4e-3),
        (hl.shapes.Polygon([(0, 0), (0.02, 0), (0.01, 0.015)], radius="2 mm"), [(0, 0), (0.02, 0), (0.01, 0.015)], 2e-3),
    ],
)
def test_an_outline_is_its_radius_away_from_its_core(shape, core, radius):
    z = hl.coordinate("z", unit="m")
    drawn = RecordingAxes()
    Outline(shape.at(x=z, y="10 mm", angle=0.4)).draw(Sketch(drawn, -0.06, 0.06, -0.03, 0.03), {"z": 0.013})
    (points,) = (np.array(item[1]) for item in drawn.items if item[0] == "area")
    turned = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    corners = np.array(core) @ turned.T + (0.013, 0.01)
    edges = list(zip(corners, np.roll(corners, -1, axis=0), strict=True))
    away = [min(distance(point, *edge) for edge in edges) for point in points]
    np.testing.assert_allclose(away, radius, rtol=1e-12)  # rounding of a few turns


def distance(point, a, b):
    """Return how far a point is from a segment."""
    along = b - a
    s = np.clip((point - a) @ along / (along @ along), 0, 1) if along.any() else 0.0
    return np.hypot(*(point - a - s * along))


@pytest.mark.parametrize(
    ("scene", "ties"),
    [
        (hl.Scene(force=k * hl.x(n)), {"spring"}),
        (hl.laws.virtual_damper()(B=1.0), {"damper"}),
        (hl.wall("ellis", unilateral=None)(k=100, B=1.0), {"spring", "damper"}),
        (hl.Scene(force=hl.parameters("B", units="N*s/m", values=1) * hl.v(n)), {"damper"}),
        (hl.wall()(k=100, B=1.0), set()),
        (hl.library.mass_spring_damper(), set()),
    ],
)
def test_what_holds_the_handle_itself_is_tied_to_the_ground(scene, ties):
    assert Schematic(scene).held_by == ties


def test_a_ball_that_the_handle_strikes_is_tied_to_nothing():
    y = hl.coordinate("y", unit="m", initial=0.03)
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.03, 9.81))
    touch = hl.contact.Contact(y - hl.x(hl.t), hl.contact.penalty(k=k), name="touch")
    scene = hl.Scene(force=touch.felt, eom=[hl.mechanics.lagrange(m * y.diff(hl.t) ** 2 / 2 - m * g * y, contacts=[touch])])
    drawn = Schematic(scene)
    assert (drawn.springs, drawn.held_by, drawn.walls, drawn.start) == ([], set(), (), {"x": 0.0, "y": 0.03})
    met, apart = (hl.mechanics.picture(scene, x=0.01, y=y) for y in (0.01, 0.014))
    assert outline_of(met, HANDLE)[1] == pytest.approx(outline_of(met, BODY)[0], abs=1e-12)
    assert outline_of(apart, BODY)[0] - outline_of(apart, HANDLE)[1] == pytest.approx(0.004, abs=1e-12)
