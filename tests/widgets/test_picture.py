"""The moving picture: the same drawing as hl.mechanics.picture, with the hand, and what a canvas needs to colour forces."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.analysis.pictures.pictures import drawing_of
from hapticlab.library.display_list import DisplayList
from hapticlab.library.entries import CATALOGUE
from hapticlab.library.parts import primitives
from hapticlab.widgets.picture import moving_picture
from hapticlab.widgets.plain.plain_letters import plain

STATE = {"x": 0.012, "F": 1.5, "intent": 0.02}


def of_kind(items, kind):
    """Return the points and the style of each item of a kind."""
    return [(np.array(points), style) for name, points, style in items if name == kind]


@pytest.mark.parametrize("name", list(CATALOGUE))
@pytest.mark.always("mass_spring_damper", "gears", "stick_slip", "texture", "virtual_fixture")
def test_a_picture_is_the_drawing_the_hand_and_a_frame_that_the_handle_stays_in(name):
    scene = CATALOGUE[name].scene()
    picture, still = moving_picture(scene), DisplayList()
    low, high = (0.8 * end for end in picture.reach)
    for x in (low, 0.0, high):
        moving = dict.fromkeys([q for q in picture.channels if picture.channels[q].unit == "m"], x)
        still = DisplayList()
        drawing_of(scene)(still, x=x, **{**scene.values, **moving})
        items = picture.draw({"x": x, "F": 0.0, "intent": x, **moving})
        assert [kind for kind, *_ in items] == [*(kind for kind, *_ in still.items), "hand", "frame"]
        ((left, bottom), (right, top)) = items[-1][1]
        assert (left, right, bottom, top) == pytest.approx(picture.box)
        for point in of_kind(items, "handle")[0][0]:
            assert left < point[0] < right and bottom < point[1] < top
    assert picture.along == pytest.approx((0, 1) if name == "ball_on_the_paddle" else (1, 0), abs=1e-9)


def test_a_plate_that_is_tilted_tilts_the_way_of_the_handle():
    tilted = moving_picture(hl.library.rolling()(alpha=0.3)).along
    assert tilted == pytest.approx((np.cos(0.3), np.sin(0.3)), abs=1e-9)  # a difference over 2 mm


@pytest.mark.parametrize("scene", [hl.wall()(k=300, x_o=0.01), hl.library.ball_on_the_paddle(), hl.library.rolling()(alpha=0.3)])
def test_the_hands_spring_goes_from_the_knob_to_where_the_hand_aims_and_the_motor_acts_along(scene):
    picture = moving_picture(scene)
    along = np.array(picture.along)
    for intent in (0.02, -0.005):
        items = picture.draw({"x": 0.012, "F": 1.0, "intent": intent})
        (knob, aim), _ = of_kind(items, "hand")[0]
        np.testing.assert_allclose(knob, of_kind(items, "handle")[0][0][2], atol=1e-12)
        np.testing.assert_allclose(aim - knob, (intent - 0.012) * along, atol=1e-12)
        (foot, tip), style = of_kind(items, "force")[0]
        assert abs((tip - foot) @ along) == pytest.approx(np.hypot(*(tip - foot)), rel=1e-12)
        assert style == {"full": 5.0}
    for gone in (None, math.nan):
        assert not of_kind(picture.draw({"x": 0.012, "F": 1.0, "intent": gone}), "hand")


@pytest.mark.parametrize("F", [-2.0, 0.7, 4.0])
def test_the_motors_arrow_is_against_the_force_and_as_long_as_it_is_large(F):
    weak = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=2.0)
    items = moving_picture(hl.wall()(k=300), weak).draw({"x": 0.0, "F": F})
    (foot, full), style = of_kind(items, "force")[0]
    assert style["full"] == 2.0
    arrow = [points for points, _ in of_kind(primitives(items, F), "arrow")][-1]
    length = arrow[1][0] - arrow[0][0]
    assert np.sign(length) == -np.sign(F)  # the motor applies F_m = -F, Fig. 23.5
    assert abs(length) == pytest.approx(min(abs(F) / 2.0, 1.5) * np.hypot(*(full - foot)), rel=1e-12)
    assert f"motor {abs(F):.1f} N" in [style["words"] for _, style in of_kind(primitives(items, F), "label")]


def test_a_force_that_is_hidden_is_in_no_item():
    picture = moving_picture(hl.wall()(k=300))
    assert [kind for kind, *_ in picture.draw({"x": 0.0, "F": math.nan}) if kind == "force"] == []


def test_a_wall_follows_its_slider_and_a_rod_its_length():
    picture = moving_picture(hl.wall()(k=300, x_o=0.01))
    assert picture.channels == {}

    def wall(**values):
        return of_kind(picture.draw({**STATE, **values}), "wall")[0][0][0][0]

    assert wall(x_o=0.018) - wall() == pytest.approx(0.008, abs=1e-12)
    assert wall(k=500.0) == wall()
    swing = moving_picture(hl.library.pendulum_on_the_handle())
    for l in (0.05, 0.15, 0.4):
        items = swing.draw({"x": 0.0, "z": 0.0, "theta": 0.3, "l": l})
        rod = next(points for points, style in of_kind(items, "line") if style["width"] == 2.5)
        assert np.hypot(*(rod[1] - rod[0])) == pytest.approx(l, rel=1e-12)
        (left, bottom), (right, top) = items[-1][1]
        assert left < rod[1][0] < right and bottom < rod[1][1] < top  # the frame grows with it


def test_what_must_be_watched_is_what_the_picture_shows():
    assert set(moving_picture(hl.library.gears()).channels) == {"phi"}
    assert set(moving_picture(hl.library.pendulum_on_the_handle()).channels) == {"z", "theta"}
    z = hl.coordinate("z", unit="m")
    channels = moving_picture(hl.Scene(force=200 * hl.parameters("u", units="N/m", values=1) * z, eom=[still(z)])).channels
    assert channels == {"z": z}


def still(z):
    m = hl.parameters("m", units="kg", values=0.1)
    return sp.Eq(m * z.diff(hl.t, 2), 0)


def test_a_picture_of_ones_own():
    scene = hl.wall()(k=300, x_o=0.01)

    def draw(axes, *, x, x_o, **_):
        axes.plot([x, x_o], [0.0, 0.0], color="#000000", linewidth=2.0)

    items = moving_picture(scene, picture=draw).draw(STATE)
    assert of_kind(items, "line")[0][0].tolist() == [[0.012, 0.0], [0.01, 0.0]]
    assert moving_picture(scene, picture="detents").draw({**STATE, "A": 0.6, "p": 0.01}) is not None
    ball = hl.shapes.Circle("5 mm").at(x=hl.x(hl.t), y="20 mm", name="ball")
    areas = of_kind(moving_picture(scene, picture=[ball]).draw(STATE), "area")
    outline = next(points for points, _ in areas if len(points) == 33)
    np.testing.assert_allclose(np.hypot(*(outline - (0.012, 0.02)).T), 5e-3, rtol=1e-12)
    with pytest.raises(hl.errors.AnalysisError, match="picture = 3; needs a name of hl.library, shapes in their places"):
        moving_picture(scene, picture=3)
    with pytest.raises(hl.errors.SceneError, match="did you mean detents"):
        moving_picture(scene, picture="detent")


def test_a_shape_follows_a_signal():
    h, w = hl.signal("h", unit="m", initial=hl.x(hl.n)), hl.parameters("w", units="m", values=0.002)
    load = sp.Max(hl.x(hl.n) - w, sp.Min(hl.x(hl.n) + w, h(hl.n - 1)))
    scene = hl.Scene(hl.parameters("k", units="N/m", values=100) * h(hl.n), [sp.Eq(h(hl.n), load)])
    assert scene.signals == (h(hl.n),)
    picture = moving_picture(scene, picture=[hl.shapes.Box(0.004, 0.006).at(x=h(hl.n), y="20 mm")])
    assert picture.channels == {"h": h(hl.n)}  # watched, whatever the scene watches
    areas = of_kind(picture.draw({**STATE, "h": 0.007}), "area")
    assert any(np.allclose(points.mean(axis=0), (0.007, 0.02), atol=1e-12) for points, _ in areas)
    view = hl.live(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), scene, picture=[hl.shapes.Box(0.004, 0.006).at(x=h(hl.n))])
    assert view.rehearsal.h[-1] == pytest.approx(view.rehearsal.x[-1], abs=0.0021)


def test_a_polygon_that_the_handle_meets_is_drawn_and_runs():
    """Its closest points have no formula in symbols, so its picture has no boundary, and nothing else is missing."""
    k = hl.parameters("k", units="N/m", values=200)
    tip = hl.shapes.Circle("1 mm").at(x=hl.x(hl.t), name="tip")
    plate = hl.shapes.Box("10 mm", "40 mm").at(x="15 mm", name="plate")
    (meet,) = hl.contact.between([tip, plate], contact_law=hl.contact.penalty(k=k))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
    for picture in (None, [tip, plate]):
        pressing = hl.people.Rehearsal(intent=lambda t: 0.012 + 0 * t, duration=0.5)
        view = hl.live(paddle, hl.Scene(meet.felt, name="plate"), sliders={}, picture=picture, rehearsal=pressing)
        log = view.rehearsal
        assert log.F[-1] == pytest.approx(200 * (log.x[-1] - 0.009), abs=1e-4) and log.F[-1] > 0.1


def test_a_still_picture_has_words():
    data, words = moving_picture(hl.library.mass_spring_damper()).still({"x": 0.012, "z": 0.01, "F": 1.5, "intent": 0.02})
    assert data.startswith(b"\x89PNG")
    assert words == "mass-spring-damper: a drawing of the scene with x = 12 mm, z = 10 mm. The motor applies 1.5 N."


def test_a_display_list_takes_what_is_drawn_on_axes_and_what_comes_later_covers_what_came_before():
    drawn = DisplayList()
    drawn.fill([0, 1, 1], [0, 0, 1], facecolor="#ffffff", edgecolor="none", zorder=6)
    drawn.plot([0, 1], [0, 1], color="#000000", linewidth=1.0, linestyle="--")
    drawn.plot([0, np.nan], [0, 1], color="#000000", linewidth=1.0)  # lies nowhere
    drawn.annotate("F", (1, 0), (0, 0), arrowprops={"color": "#000000"})
    assert [item[0] for item in drawn.items] == ["line", "arrow", "label", "area"]
    assert drawn.items[0] == ("line", [(0.0, 0.0), (1.0, 1.0)], {"colour": "#000000", "width": 1.0, "dash": (6, 4)})
    assert drawn.items[1][1] == [(0.0, 0.0), (1.0, 0.0)] and drawn.items[3][2]["edge"] == ""


def test_a_linkage_that_cannot_be_put_together_leaves_out_what_lies_nowhere():
    picture = moving_picture(hl.library.four_bar())
    whole, apart = (len(picture.draw({**STATE, "theta": 1.5, "b": b})) for b in (0.05, 0.005))
    assert 0 < apart < whole


@pytest.mark.parametrize(("kind", "high"), [("spring", 0.002), ("damper", 0.002)])
def test_springs_and_dampers_stretch_between_their_ends(kind, high):
    for end in ((0.02, 0.0), (0.03, 0.04)):
        parts = primitives([(kind, [(0.0, 0.0), end], {"coils": 5, "high": high})])
        points = np.concatenate([points for _, points, _ in parts])
        assert points[0].tolist() == [0.0, 0.0] and points[-1].tolist() == pytest.approx(end)
        along = np.array(end) / np.hypot(*end)
        across = points @ np.array([-along[1], along[0]])
        assert across.max() == pytest.approx(high) and across.min() == pytest.approx(-high)


def test_a_spring_is_coloured_by_its_own_force_on_the_scale_of_the_motor():
    force = ("force", [(0.0, 0.0), (0.1, 0.0)], {"full": 5.0})

    def colour(length):
        spring = ("spring", [(0.0, 0.0), (length, 0.0)], {"coils": 4, "high": 0.001, "k": 100.0, "rest": 0.02})
        return primitives([force, spring], F=0.0)[-1][2]["colour"]

    assert colour(0.02) == "#000000"
    assert colour(0.07) == "#cc5a1a"  # 5 N
    assert "#000000" < colour(0.03) < colour(0.05) < colour(0.07)


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        ("handle", "handle"), ("$K,\\ b_c$", "K, b_c"), (r"$\varphi_2$", "φ_2"), ("$P\\,P_{cr}$", "P P_cr"),
        (r"$\theta$", "θ"), (r"$F_0\,\sin\,\Omega t$", "F_0 sin Ω t"), ("$x_{o}$", "x_o"), (r"$\rho,\ J_2$", "ρ, J_2"),
    ],
)  # fmt: skip
def test_mathematics_in_plain_letters(words, shown):
    assert plain(words) == shown
