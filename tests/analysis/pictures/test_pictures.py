"""Pictures of the library's mechanisms: every symbol is there, inside the frame, and no text covers another."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n
from hapticlab.analysis.pictures.force_field import ForceField
from hapticlab.analysis.pictures.pictures import drawing_of
from hapticlab.analysis.pictures.schematic import Schematic
from hapticlab.analysis.pictures.shape_outlines import Outline
from hapticlab.library.display_list import DisplayList
from hapticlab.library.entries import CATALOGUE
from hapticlab.library.sketch import Sketch

MEDIUM = (233 / 255, 235 / 255, 238 / 255, 1.0)
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
@pytest.mark.always("four_bar-state7", "gears-state21")
def test_a_picture_shows_handle_and_symbols_apart_from_each_other(name, state):
    figure = hl.mechanics.picture(name, **state)
    shown = texts(figure)
    words = " ".join(text for text, _ in shown)
    assert "handle" in words and "$x$" in words
    scene = CATALOGUE[name].scene()
    for symbol in {type(q).__name__ for q in scene.coordinates} | (set(scene.parameters) - UNNAMED):
        assert GREEK.get(symbol, symbol) in words.replace("{", "").replace("}", ""), symbol
    frame = figure.bbox
    for k, (text, box) in enumerate(shown):
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1, text
        for other, near in shown[k + 1 :]:
            assert not box.overlaps(near), (text, other)
    title = figure.axes[0].title.get_window_extent()
    ended = [body for body in figure.axes[0].patches if body.get_facecolor() != MEDIUM]
    drawn = [box for _, box in shown] + [body.get_window_extent() for body in ended]
    assert title.y0 > max(box.y1 for box in drawn)
    assert min(box.x0 for box in drawn) >= frame.x0 and max(box.x1 for box in drawn) <= frame.x1
    assert min(box.y0 for box in drawn) >= frame.y0


def drawn(scene, **state):
    """Return what is drawn of a scene in a state: a dict of kind to a list of (points, style)."""
    scene = CATALOGUE[scene].scene() if isinstance(scene, str) else scene
    kept, found = DisplayList(), {}
    drawing_of(scene)(kept, **{"x": 0.0, **scene.values, **state})
    for kind, points, style in kept.items:
        found.setdefault(kind, []).append((np.array(points), style))
    return found


def body(found, name=""):
    """Return the ends (left, bottom), (right, top) of the first body, or of the one of a name."""
    points = next(points for points, style in found["area"] if style.get("name") and name in ("", style["name"]))
    return points.min(axis=0), points.max(axis=0)


@pytest.mark.parametrize(
    ("name", "state"), [("mass_spring_damper", {"z": 0}), ("two_masses", {"z_1": 0}), ("tuned_absorber", {"z_1": 0})]
)
@pytest.mark.always("mass_spring_damper-*")
def test_the_handle_stays_out_of_the_mass(name, state):
    found = drawn(name, x=0.04, **state)
    (left, _), _ = body(found)
    face = found["handle"][0][0][0]
    assert face[0] == 0.04 < left - 0.01


def test_wheels_stay_on_the_ground_and_the_plate_is_tilted():
    found = drawn("rolling", z=-0.04, x=-0.03)
    (start, end), _ = found["ground"][0]
    wheels = [centre for (centre, rim), _ in found["disc"] if 0.002 < np.hypot(*(rim - centre)) < 0.006 and centre[1] < 0]
    assert len(wheels) == 3
    assert all(start[0] < x - 0.004 and x + 0.004 < end[0] for x, _ in wheels)
    start, end = drawn("rolling", alpha=0.2)["ground"][0][0]
    assert np.arctan2(*(end - start)[::-1]) == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("k", [20, 150, 600])
def test_the_wall_of_a_fixture_rises_to_the_edge_and_its_well_stays_above_the_letters(k):
    ((left, level), (right, _)), style = drawn("virtual_fixture", k=k)["track"][0]
    U = level + np.array(style["heights"])
    wall = U[np.linspace(left, right, len(U)) > 0.0355][::8]
    assert np.all(np.diff(wall, 2) > 0)  # a parabola, no plateau
    assert U.min() >= -0.0056


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.always("mass_spring_damper", "four_bar", "stick_slip")
def test_a_picture_moves_with_its_handle_whose_face_is_at_x(name):
    here, there = (drawn(name, x=x) for x in (0.0, 0.02))
    way = there["handle"][0][0][0] - here["handle"][0][0][0]
    upright = name == "ball_on_the_paddle"
    assert way[int(upright)] == pytest.approx(0.02, abs=1e-12)
    if not upright:
        assert there["handle"][0][0][0][0] == 0.02


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


def faces(found):
    """Return the places [m] where walls begin."""
    return sorted(points[0][0] for points, _ in found["wall"])


@pytest.mark.parametrize("law", ["zoh", "ellis", "half_sample"])
@pytest.mark.parametrize("unilateral", ["gate", "clip"])
def test_the_handles_face_meets_the_wall_where_the_force_begins(law, unilateral):
    for place in (0.01, -0.012):
        found = drawn(hl.wall(law, unilateral=unilateral)(k=300, x_o=place), x=place)
        face, back, _ = found["handle"][0][0]
        assert faces(found) == [place] and face[0] == place > back[0]
        pressed = drawn(hl.wall(law, unilateral=unilateral)(k=300, x_o=place), x=place + 0.003)
        (boundary, meets, far), _ = pressed["wall"][0]
        assert meets[0] - boundary[0] == pytest.approx(0.003, abs=1e-12) and far[0] > meets[0]


def test_walls_to_both_sides_and_a_handle_without_thickness_between_them():
    force = hl.when(hl.x(n) >= x_o, k * (hl.x(n) - x_o)) + hl.when(hl.x(n) <= x_1, k * (hl.x(n) - x_1))
    found = drawn(hl.Scene(force=force), x=0.004)
    assert faces(found) == [-0.02, 0.01]
    face, back, _ = found["handle"][0][0]
    assert face[0] == back[0] == 0.004
    assert {"$x_{o}$", "$x_{1}$"} <= letters(found)
    assert Schematic(hl.laws.virtual_damper()).walls == ()
    left = hl.Scene(force=hl.when(hl.x(n) <= x_1, k * (hl.x(n) - x_1)))
    face, back, _ = drawn(left, x=-0.021)["handle"][0][0]
    assert face[0] == -0.021 < back[0]


def letters(found):
    return {style["words"] for _, style in found["label"]}


def mass_on_a_coupler():
    z = hl.coordinate("z", unit="m", initial=hl.x(n))
    m, K, b_c = hl.parameters("m K b_c", units="kg N/m N*s/m", values=(0.05, 200, 0.2))
    F = hl.laws.virtual_coupler(z, K=K, b=b_c)
    return z, m, F


def test_a_mass_meets_its_wall_with_its_own_face():
    z, m, F = mass_on_a_coupler()
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F - hl.when(z >= x_o, k * (z - x_o)))])
    met = drawn(scene, x=0.011, z=0.01)
    assert faces(met) == [pytest.approx(body(met)[1][0], abs=1e-12)]
    apart = drawn(scene, x=0.011, z=0.004)
    assert faces(apart)[0] - body(apart)[1][0] == pytest.approx(0.006, abs=1e-12)


@pytest.mark.parametrize("divided", [False, True])
def test_a_mass_of_ones_own_has_spring_damper_and_letters_between_its_bodies(divided):
    z, m, F = mass_on_a_coupler()
    equation = sp.Eq(z.diff(hl.t, 2), F / m) if divided else sp.Eq(m * z.diff(hl.t, 2), F)
    found = drawn(hl.Scene(force=F, eom=[equation], name="my mass"), x=0.012, z=0.02)
    for kind in ("spring", "damper"):
        (start, end), style = found[kind][0]
        assert start[0] == 0.012 and end[0] == pytest.approx(body(found)[0][0], abs=1e-12)
        assert style["carries"] == "F"
    assert {"$m$", "$K$", "$b_{c}$", "$z$", "handle"} <= letters(found)


def test_a_scene_whose_parameters_have_no_values_yet_is_drawn_too():
    z, m, K, A = hl.coordinate("z", unit="m"), *hl.parameters("m K A", units="kg N/m N")
    F = K * (hl.x(hl.t) - z)
    found = drawn(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)]))
    assert {"$m$", "$K$"} <= letters(found) and found["spring"]
    assert drawn(hl.Scene(force=A * sp.sin(hl.x(n) / x_o)))["handle"]


def test_a_scene_of_ones_own_is_drawn_as_that_of_the_library():
    z = hl.coordinate("z", unit="m", initial=hl.x(n))
    m, K, b_c, b, k = hl.parameters("m K b_c b k", units="kg N/m N*s/m N*s/m N/m", values=(0.1, 200, 0.1, 0.1, 100))
    F = K * (hl.x(hl.t) - z) + b_c * (hl.v(hl.t) - z.diff(hl.t))
    mine = hl.Scene(force=F, eom=[sp.Eq(z.diff(hl.t, 2), (F - k * z - b * z.diff(hl.t)) / m)], name="what I made")
    same, theirs = (drawn(scene, x=0.01, z=0.005) for scene in (mine, "mass_spring_damper"))
    assert {kind: len(listed) for kind, listed in same.items()} == {kind: len(listed) for kind, listed in theirs.items()}
    assert letters(same) == letters(theirs)
    for kind, listed in same.items():
        for (points, _), (others, _) in zip(listed, theirs[kind], strict=True):
            np.testing.assert_allclose(points, others, atol=1e-12)


@pytest.mark.parametrize("l", [0.1, 0.35])
@pytest.mark.always("0.35")
def test_a_pendulum_hangs_from_its_cart_and_a_pole_stands_on_it_in_true_length(l):
    z, m, F = mass_on_a_coupler()
    theta = hl.coordinate("theta", unit="rad")
    length, g = hl.parameters("l g", units="m m/s^2", values=(0.1, 9.81))
    bob = m * ((z + length * sp.sin(theta)).diff(hl.t) ** 2 + (length * sp.cos(theta)).diff(hl.t) ** 2) / 2
    for sign, below in ((1, True), (-1, False)):
        energy = m * z.diff(hl.t) ** 2 / 2 + bob + sign * m * g * length * sp.cos(theta)
        scene = hl.Scene(force=F, eom=[hl.mechanics.lagrange(energy, forces={z: F})])
        found = drawn(scene, theta=0.5, l=l)
        rod = next(points for points, style in found["line"] if style["width"] == 2.5)
        reach = rod[-1] - rod[0]
        assert np.hypot(*reach) == pytest.approx(l, rel=1e-12)
        assert bool(reach[1] < 0) is below
        assert np.arctan2(reach[0], abs(reach[1])) == pytest.approx(0.5, abs=1e-12)
        assert "$l$" in letters(found) and "$g$" in letters(found)


def test_a_scene_of_the_library_is_drawn_as_the_library_does_also_when_bound_anew():
    for entry in CATALOGUE.values():
        scene = entry.scene()
        drawing = drawing_of(scene(**dict(scene.values)))
        assert drawing is entry.draw if entry.draw else isinstance(drawing, Schematic)
    assert isinstance(drawing_of(hl.Scene(force=k * hl.x(n), name="detents of my own")), Schematic)


def test_a_force_field_of_ones_own_is_drawn_as_its_potential():
    A, p = hl.parameters("A p", units="N m", values=(0.6, 0.012))
    mine = hl.Scene(force=A * sp.sin(2 * sp.pi * hl.x(n) / p))
    for values in ({}, {"A": 1.2}):
        ((left, _), (right, _)), style = drawn(mine, x=0.003, **values)["track"][0]
        U = np.array(style["heights"])
        at = np.linspace(left, right, len(U))
        expected = 0.5 * 0.011 * values.get("A", 0.6) / 0.6 * (1 - np.cos(2 * np.pi * at / 0.012))  # -A p/(2 pi) cos, by hand
        np.testing.assert_allclose(U - U.min(), expected - expected.min(), atol=2e-4)
    torn = hl.Scene(force=hl.parameters("c", units="N/m^0.5", values=1) * sp.sqrt(x_o - hl.x(n)))
    ((left, _), (right, _)), style = drawn(torn)["track"][0]
    U = np.array(style["heights"])
    assert np.ptp(U[np.linspace(left, right, len(U)) > 0.0105]) < 1e-7  # no force is known there
    walls = [hl.wall(law)() for law in ("zoh", "ellis")] + [hl.laws.virtual_damper()(), hl.Scene(force=k * hl.x(n))]
    assert not any(isinstance(drawing_of(wall), ForceField) for wall in walls)


def test_a_wall_that_is_no_spring_is_drawn_as_a_wall_and_a_bump_as_a_track():
    w, X = hl.parameters("w", units="m", values=0.01), hl.x(n)
    hard, bump = k * (X - x_o) ** 2 / w, k * w * sp.sin(sp.pi * X / w)
    for force in (
        sp.Piecewise((hard, x_o <= X), (0, True)),
        sp.Piecewise((0, x_o > X), (hard, True)),
        k * sp.Max(0, X - x_o) ** 2 / w,
        sp.Piecewise((hard, x_o <= X), (-k * (X + x_o) ** 2 / w, -x_o >= X), (0, True)),
    ):
        found = drawn(hl.Scene(force=force))
        assert "track" not in found
    assert {one.side for one in drawing_of(hl.Scene(force=force)).walls} == {1, -1}
    for condition in (w > sp.Abs(X), (w > X) & (-w < X), True):
        assert "track" in drawn(hl.Scene(force=sp.Piecewise((bump, condition), (0, True))))


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
    drawn = DisplayList()
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
    assert set(Schematic(scene).held_by) == ties


def test_a_ball_that_the_handle_strikes_is_tied_to_nothing_and_lies_on_it():
    y = hl.coordinate("y", unit="m", initial=0.03)
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.03, 9.81))
    touch = hl.contact.Contact(y - hl.x(hl.t), hl.contact.penalty(k=k), name="touch")
    scene = hl.Scene(force=touch.felt, eom=[hl.mechanics.lagrange(m * y.diff(hl.t) ** 2 / 2 - m * g * y, contacts=[touch])])
    schematic = Schematic(scene)
    assert (schematic.ties, schematic.held_by, schematic.walls, schematic.start) == ([], {}, (), {"x": 0.0, "y": 0.03})
    for gap in (0.0, 0.004):
        found = drawn(scene, x=0.01, y=0.01 + gap)
        (centre, rim), _ = found["disc"][0]
        face, back, _ = found["handle"][0][0]
        assert face[1] == pytest.approx(0.01, abs=1e-12) and back[1] < face[1]  # upright: its face looks up
        assert centre[1] - np.hypot(*(rim - centre)) - face[1] == pytest.approx(gap, abs=1e-12)
    assert any(tip[1] < tail[1] - 0.001 for (tail, tip), _ in found["arrow"])  # gravity points down
    assert {"$m$", "$g$"} <= letters(found)


def test_a_double_pendulum_hangs_on_itself_and_each_bob_has_its_own_mass():
    z, M, F = mass_on_a_coupler()
    first, second = (hl.coordinate(f"theta_{k}", unit="rad") for k in (1, 2))
    m_1, m_2, l_1, l_2, g = hl.parameters("m_1 m_2 l_1 l_2 g", units="kg kg m m m/s^2", values=(0.1, 0.02, 0.1, 0.06, 9.81))
    X, Y = z + l_1 * sp.sin(first), -l_1 * sp.cos(first)
    x, y = X + l_2 * sp.sin(second), Y - l_2 * sp.cos(second)
    kinetic = (M * z.diff(hl.t) ** 2 + m_1 * (X.diff(hl.t) ** 2 + Y.diff(hl.t) ** 2)) / 2
    kinetic += m_2 * (x.diff(hl.t) ** 2 + y.diff(hl.t) ** 2) / 2
    scene = hl.Scene(force=F, eom=[hl.mechanics.lagrange(kinetic - g * (m_1 * Y + m_2 * y), forces={z: F})])
    found = drawn(scene, theta_1=0.5, theta_2=-0.2)
    upper, lower = (points for points, style in found["line"] if style["width"] == 2.5)
    np.testing.assert_allclose(upper[1], lower[0], atol=1e-12)
    np.testing.assert_allclose(upper[1] - upper[0], 0.1 * np.array([np.sin(0.5), -np.cos(0.5)]), atol=1e-12)
    np.testing.assert_allclose(lower[1] - lower[0], 0.06 * np.array([np.sin(-0.2), -np.cos(-0.2)]), atol=1e-12)
    assert {"$m_{1}$", "$m_{2}$", "$l_{1}$", "$l_{2}$", "$m$"} <= letters(found)


@pytest.mark.parametrize("count", [1, 3, 9])
def test_a_row_of_any_length_stands_apart_in_its_frame(count):
    zs = [hl.coordinate(f"z_{k}", unit="m", initial=hl.x(n)) for k in range(count)]
    m, K = hl.parameters("m K", units="kg N/m", values=(0.05, 200))
    pulls = [K * (a - b) for a, b in zip([hl.x(hl.t), *zs], zs, strict=False)] + [0]
    scene = hl.Scene(force=pulls[0], eom=[sp.Eq(m * z.diff(hl.t, 2), pulls[k] - pulls[k + 1]) for k, z in enumerate(zs)])
    kept = DisplayList()
    Schematic(scene)(kept, x=0.0)
    ends = [(min(x for x, _ in points), max(x for x, _ in points)) for kind, points, style in kept.items if style.get("name")]
    edges = [0.0, *np.ravel(sorted(ends)), kept.get_xlim()[1]]
    assert len(ends) == count and np.all(np.diff(edges) > 0) and kept.get_xlim()[0] < -0.05


def test_what_hangs_under_its_weight_stands_upright_above_the_handle():
    z, m, F = mass_on_a_coupler()
    g = hl.parameters("g", units="m/s^2", values=9.81)
    found = drawn(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F - m * g)]), x=0.003, z=0.001)
    (start, end), _ = found["spring"][0]
    assert start[1] == pytest.approx(0.003, abs=1e-12) and end[1] == pytest.approx(body(found)[0][1], abs=1e-12)
    assert end[1] > start[1] and "$g$" in letters(found)
