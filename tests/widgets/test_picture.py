"""The moving picture: the same drawing as hl.mechanics.picture, the hand's intent and the motor's force where they are."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.base.drawing import new_figure
from hapticlab.library.entries import CATALOGUE
from hapticlab.library.sketch import HANDLE
from hapticlab.widgets.picture import COLD, moving_picture
from hapticlab.widgets.picture_items import RecordingAxes, plain

STATE = {"x": 0.012, "F": 1.5, "intent": 0.02}


def of_kind(items, kind):
    return [item for item in items if item[0] == kind]


def area(items, fill):
    """Return the outline of the first area of a colour, and its centre."""
    outline = np.array(next(item[1] for item in items if item[0] == "area" and item[2] == fill))
    return outline, (outline.min(axis=0) + outline.max(axis=0)) / 2


#: between them they use every part of a sketch
EVERY_PART = ("tuned_absorber", "gears", "rolling", "ball_on_the_paddle", "detents", "slider_crank")


@pytest.mark.parametrize("name", EVERY_PART)
def test_what_is_recorded_is_what_matplotlib_draws(name):
    entry = CATALOGUE[name]
    axes, recorded = new_figure(height=2).subplots(), RecordingAxes()
    for one in (axes, recorded):
        entry.draw(one, x=0.007)
    items = recorded.items
    assert sorted(item[1] for item in of_kind(items, "line")) == sorted(line.get_xydata().tolist() for line in axes.lines)
    drawn = [text for text in axes.texts if text.get_text()]
    arrows = [text for text in axes.texts if not text.get_text()]
    assert sorted(item[2] for item in of_kind(items, "text")) == sorted(plain(text.get_text()) for text in drawn)
    tips = sorted(tuple(float(c) for c in text.xy) for text in arrows)
    assert sorted(item[2] for item in of_kind(items, "arrow")) == tips
    assert recorded.get_xlim() == axes.get_xlim() and recorded.get_ylim() == axes.get_ylim()


def test_what_comes_later_covers_what_came_before():
    axes = RecordingAxes()
    axes.fill([0, 1, 1], [0, 0, 1], facecolor="#ffffff", edgecolor="none", zorder=6)
    axes.plot([0, 1], [0, 1], color="#000000", linewidth=1.0, linestyle="--")
    axes.plot([0, np.nan], [0, 1], color="#000000", linewidth=1.0)  # lies nowhere
    assert [item[0] for item in axes.items] == ["line", "area"]
    assert axes.items[0] == ("line", [[0.0, 0.0], [1.0, 1.0]], 1.0, "#000000", (6, 4))
    assert axes.items[1][3] == ""


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_a_picture_holds_still_and_the_handle_stays_in_it(name):
    picture = moving_picture(CATALOGUE[name].scene())
    left, right, bottom, top = picture.box
    for x in (-0.05, 0.0, 0.05):
        start = dict.fromkeys(picture.channels, x) if "theta" not in picture.channels else {"z": x}
        items = picture.draw({"x": x, "F": 0.0, **{key: value for key, value in start.items() if key in picture.channels}})
        _, (at, up) = area(items, HANDLE)
        assert left < at < right and bottom < up < top
        assert picture.box == (left, right, bottom, top)
    assert picture.along == pytest.approx((0, 1) if name == "ball_on_the_paddle" else (1, 0), abs=1e-12)


def test_a_plate_that_is_tilted_tilts_the_way_of_the_handle():
    tilted = moving_picture(hl.library.rolling()(alpha=0.3)).along
    assert tilted == pytest.approx((np.cos(0.3), np.sin(0.3)), abs=1e-9)  # a difference over 2 mm


@pytest.mark.parametrize("scene", [hl.wall()(k=300, x_o=0.01), hl.library.ball_on_the_paddle(), hl.library.rolling()(alpha=0.3)])
def test_the_hand_and_the_motor_act_along_the_handles_way(scene):
    picture = moving_picture(scene)
    along = np.array(picture.along)
    for intent, F in ((0.02, 1.5), (-0.005, -0.7)):
        items = picture.draw({"x": 0.012, "F": F, "intent": intent})
        handle = area(items, HANDLE)[1]
        line = np.array(next(item[1] for item in of_kind(items, "line") if item[3] == COLD))
        np.testing.assert_allclose(line[1] - line[0], (intent - 0.012) * along, atol=1e-12)
        np.testing.assert_allclose((line[0] - handle) @ along, 0.0, atol=1e-12)
        tail, tip = map(np.array, of_kind(items, "arrow")[-1][1:3])
        length = (tip - tail) @ along
        assert np.sign(length) == -np.sign(F)  # the motor applies F_m = -F, Fig. 23.5
        full = 0.2 * (picture.box[1] - picture.box[0])
        assert abs(length) == pytest.approx(full * abs(F) / 5.0, rel=1e-12)
        assert of_kind(items, "text")[-1][2] == f"motor {abs(F):.1f} N"


def test_the_force_arrow_is_scaled_by_what_the_motor_can_and_ends():
    weak = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=2.0)
    picture = moving_picture(hl.wall()(k=300), weak)
    lengths = [np.ptp([c[0] for c in of_kind(picture.draw({"x": 0.0, "F": F}), "arrow")[-1][1:3]]) for F in (2.0, 50.0)]
    width = picture.box[1] - picture.box[0]
    assert lengths == [pytest.approx(0.2 * width, rel=1e-12), pytest.approx(0.3 * width, rel=1e-12)]
    assert of_kind(picture.draw({"x": 0.0, "F": 0.0}), "text")[-1][2] == "motor 0.0 N"
    arrows = [len(of_kind(picture.draw({"x": 0.0, "F": F}), "arrow")) for F in (0.0, np.nan, 1.0)]
    assert arrows == [arrows[0], arrows[0], arrows[0] + 1]


def test_a_wall_follows_its_slider():
    picture = moving_picture(hl.wall()(k=300, x_o=0.01))
    assert picture.channels == {}

    def wall(**values):
        upright = [item[1] for item in of_kind(picture.draw({**STATE, **values}), "line") if item[1][0][0] == item[1][-1][0]]
        return max(upright, key=lambda points: abs(points[0][1] - points[-1][1]))[0][0]

    assert wall(x_o=0.018) - wall() == pytest.approx(0.008, abs=1e-12)
    assert wall(k=500.0) == wall()


def test_what_must_be_watched_is_what_the_picture_shows():
    assert set(moving_picture(hl.library.gears()).channels) == {"phi"}
    assert set(moving_picture(hl.library.pendulum_on_the_handle()).channels) == {"z", "theta"}
    z = hl.coordinate("z", unit="m")
    channels = moving_picture(hl.Scene(force=200 * hl.parameters("u", units="N/m", values=1) * z, eom=[still(z)])).channels
    assert channels == {"z": z}


def still(z):
    import sympy as sp

    m = hl.parameters("m", units="kg", values=0.1)
    return sp.Eq(m * z.diff(hl.t, 2), 0)


def test_a_picture_of_ones_own():
    scene = hl.wall()(k=300, x_o=0.01)

    def draw(axes, *, x, x_o, **_):
        axes.plot([x, x_o], [0.0, 0.0], color="#000000", linewidth=2.0)

    items = moving_picture(scene, picture=draw).draw(STATE)
    assert of_kind(items, "line")[0][1] == [[0.012, 0.0], [0.01, 0.0]]
    assert moving_picture(scene, picture="detents").draw({**STATE, "A": 0.6, "p": 0.01}) is not None
    ball = hl.shapes.Circle("5 mm").at(x=hl.x(hl.t), y="20 mm", name="ball")
    outline = np.array(next(item[1] for item in moving_picture(scene, picture=[ball]).draw(STATE) if len(item[1]) == 33))
    np.testing.assert_allclose(np.hypot(*(outline - (0.012, 0.02)).T), 5e-3, rtol=1e-12)
    with pytest.raises(hl.errors.AnalysisError, match="picture = 3; needs a name of hl.library, shapes in their places"):
        moving_picture(scene, picture=3)
    with pytest.raises(hl.errors.SceneError, match="did you mean detents"):
        moving_picture(scene, picture="detent")


def test_a_linkage_that_cannot_be_put_together_leaves_out_what_lies_nowhere():
    picture = moving_picture(hl.library.four_bar())
    whole, apart = (len(picture.draw({**STATE, "theta": 1.5, "b": b})) for b in (0.05, 0.005))
    assert 0 < apart < whole


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        ("handle", "handle"), ("$K,\\ b_c$", "K, b_c"), (r"$\varphi_2$", "φ_2"), ("$P\\,P_{cr}$", "P P_cr"),
        (r"$\theta$", "θ"), (r"$F_0\,\sin\,\Omega t$", "F_0 sin Ω t"), ("$x_{o}$", "x_o"), (r"$\rho,\ J_2$", "ρ, J_2"),
    ],
)  # fmt: skip
def test_mathematics_in_plain_letters(words, shown):
    assert plain(words) == shown
