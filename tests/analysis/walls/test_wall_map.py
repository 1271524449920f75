"""Wall maps against single runs with stored traces, closed forms of the limits, and regions chosen by hand."""

import io
import math
from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.walls.wall_map import WallMaps, wall_map
from hapticlab.analysis.walls.wall_map_plot import COLOURS
from hapticlab.analysis.walls.wall_regions import WallMap, regions_of, under
from hapticlab.errors import AnalysisError
from hapticlab.limits.limit import Limit

HAND = hl.Hand(m=0.02, b=0.3, k=100.0, push=1.0)
BARE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, push=1.0))
FULL = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=2e4, coulomb=0.03, hand=HAND)


def test_regions_of_a_bare_handle_are_the_closed_forms():
    """b > K T/2 + |B| is passive; stable up to (2/T)(b + B), but for a few per cent of b T/m; the rest bounces over 1 mm."""
    K, B = np.linspace(40, 790, 16), np.linspace(-0.14, 0.2, 7)
    found = wall_map(BARE, K=K, B=B)
    passive = 0.1 > K[:, None] * 1e-3 / 2 + abs(B)
    edge = 2e3 * (0.1 + B)
    stable, unstable = K[:, None] < 0.97 * edge, K[:, None] > 1.03 * edge
    assert (found.regions[passive] == 0).all()
    assert (found.regions[stable & ~passive] == 1).all()
    assert (found.regions[unstable] == 3).all()
    assert passive.sum() > 4 and (stable & ~passive).sum() > 8 and unstable.sum() > 50
    assert found.share("passive") == pytest.approx((found.regions == 0).mean())
    assert not found.surprises.any() and not found.undecided.any()


def test_every_point_is_what_a_single_run_shows():
    pytest.importorskip("llvmlite")  # friction, over many lanes
    K, B = np.array([200.0, 900.0, 2500.0]), np.array([0.0, 0.1])
    found = wall_map(FULL, K=K, B=B, duration=0.5)
    for i, k in enumerate(K):
        for j, b in enumerate(B):
            log = FULL.run(hl.wall()(k=k, B=b, x_o=0.0), duration=0.5, v=0.1)
            seen = hl.chatter(log)
            amplitude = found.amplitude[i, j]
            assert (found.regions[i, j] >= 2) == (seen.state in ("chatter", "growing"))
            assert (amplitude > 1e-3) == (found.regions[i, j] == 3)
    assert set(np.unique(found.regions)) == {0, 1, 3}


def test_limits_at_every_row_are_those_of_the_bounds():
    found = wall_map(FULL, over=("K", "delay"), K=[100.0, 200.0], delay=[0.0, 0.7e-3, 2e-3], duration=0.1, bounds=("diolaiti",))
    for delay, passive, stable, by_name in zip(found.rows, *(found.limits[n] for n in found.limits), strict=True):
        assert passive.K == hl.passivity_limit(hl.Device(b=0.1, T=1e-3, delay=delay)).K
        assert stable.K == hl.stability_limit(replace(FULL, delay=float(delay))).K
        assert by_name.K == pytest.approx(min(0.1 / (0.5e-3 + delay), 2 * 0.03 * 2e4), rel=1e-12)
    exact = [200.0, found.limits["passivity"][1].K, 0.1 / 2.5e-3]
    np.testing.assert_allclose(found.limit("passivity"), exact, rtol=1e-9)


def test_the_corner_at_no_virtual_damper_is_on_the_line():
    found = wall_map(BARE, K=np.linspace(100, 300, 3), B=np.linspace(-0.05, 0.051, 60), duration=0.1)
    assert 0.0 in found.rows and len(found.rows) < 60
    B = found.axes["B"]
    expected = 2e3 * (0.1 - abs(B))
    np.testing.assert_allclose(np.interp(B, found.rows, found.limit("passivity")), expected, rtol=1e-9)


def test_a_map_over_T_is_the_maps_of_every_T():
    pytest.importorskip("llvmlite")  # friction, over many lanes
    K, T = np.array([150.0, 600.0, 1500.0]), np.array([0.5e-3, 1e-3, 2e-3])
    found = wall_map(replace(FULL, delay=0.3e-3), over=("K", "T"), K=K, T=T, B=0.02, duration=0.3, workers=1)
    for j, period in enumerate(T):
        one = wall_map(replace(FULL, delay=0.3e-3, T=period), over=("K", "b"), K=K, b=[0.1, 0.2], B=0.02, duration=0.3)
        assert found.limits["stability"][j].K == one.limits["stability"][0].K
    assert (np.diff(found.limit("stability")) < 0).all() and (np.diff(found.limit("passivity")) < 0).all()
    assert found.regions[0, 0] <= 1 and found.regions[-1, -1] == 3


def test_maps_serve_other_paddles_too():
    maps = WallMaps(FULL, K=[300.0, 3000.0], B=[0.0, 0.1], duration=0.2)
    other = replace(FULL, b=1.0, T=0.5e-3, hand=replace(HAND, b=2.0))
    mine, fresh = maps.of(other), wall_map(other, K=[300.0, 3000.0], B=[0.0, 0.1], duration=0.2)
    np.testing.assert_array_equal(mine.regions, fresh.regions)
    np.testing.assert_array_equal(mine.limit("stability"), fresh.limit("stability"))
    assert (maps.of(FULL).regions != mine.regions).any()


def regions(amplitude, passive=150.0, stable=250.0, fault=False):
    """Return the regions of K = 100, 200, 300 N/m with one amplitude."""
    limits = {n: (Limit(K, None, "", ""),) * 2 for n, K in (("passivity", passive), ("stability", stable))}
    a = np.full((3, 2), float(amplitude))
    found = WallMap(
        {"K": np.array([100.0, 200, 300]), "B": np.array([0.0, 1])}, a, a, np.isnan(a), np.array([0.0, 1]), limits, 1e-3, 1.0
    )
    return regions_of(found, np.full(a.shape, fault))[:, 0].tolist()


def test_regions_chosen_by_hand():
    assert regions(0.0) == [0, 1, 1]  # rest beyond the stability limit, as friction allows, is called stable
    assert regions(0.5e-3) == [2, 2, 2]
    assert regions(2e-3) == [3, 3, 3]
    assert regions(math.nan) == [0, 1, 3]  # thrown off: theory decides
    assert regions(math.nan, fault=True) == [3, 3, 3]
    assert regions(0.0, passive=0.0, stable=math.inf) == [1, 1, 1]


def test_an_encoder_chatters_within_the_passivity_limit():
    """Without Coulomb friction Abbott and Okamura's limit is 0: 2 mm a count sustain what Eq. (23.10) knows nothing of."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, counts_per_metre=500, hand=hl.Hand(push=1.0))
    found = wall_map(paddle, over=("K", "coulomb"), K=np.linspace(200, 980, 8), coulomb=[0.0, 0.5, 1.2])
    assert found.surprises[:, 0].sum() > 3 and not found.surprises[:, 1:].any()
    assert hl.bounds.abbott_okamura(hl.Device(b=0.5, T=1e-3, coulomb=1.2, counts_per_metre=1 / 2e-3)).K > 980
    assert "within the passivity limit chatter" in str(found)


def test_a_handle_that_nothing_brings_back_is_decided_by_theory():
    lone = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    found = wall_map(lone, K=[100.0, 150.0, 1000.0], B=[0.0, 0.02])
    assert found.undecided.any() and found.regions[:, 0].tolist() == [0, 0, 3]
    assert "decided by the linear theory" in str(found)


@pytest.mark.wide
def test_ranges_that_are_not_given_show_the_limits():
    for over in (("K", "B"), ("K", "T"), ("K", "delay"), ("K", "hand_b"), ("K", "coulomb"), ("K", "counts_per_metre")):
        maps = WallMaps(FULL, over=over, points=12)
        K, other = maps.axes.values()
        assert K.shape == other.shape == (12,) and K[0] > 0
        limits = maps._limits(FULL, other)["stability"]
        assert any(K[0] < one.K < K[-1] for one in limits)


def test_an_exact_velocity_is_never_passive_and_an_estimate_is():
    exact = wall_map(BARE, law="half_sample", K=[50.0, 90.0], B=[0.0, 0.01], duration=0.2)
    assert exact.limit("passivity").tolist() == [0, 0] and exact.share("passive") == 0
    estimated = wall_map(FULL, law="half_sample", K=[50.0, 90.0], B=[0.0, 0.01], duration=0.2)
    assert estimated.limit("passivity")[0] == pytest.approx(100.0, rel=1e-9)  # b/T, as of Eq. (23.5)


def test_a_scene_without_theory_says_so_and_shows_its_own_border():
    found = wall_map(BARE, law=hl.wall(), points=12, duration=0.5)
    assert 'passive: not known for a scene (laws by name, such as law="zoh"' in str(found) and "passive 0.0 %" not in str(found)
    assert "K ends at twice the softest" in str(found) and "a decaying oscillation is regarded as coming to rest" in str(found)
    exact = hl.stability_limit(BARE, B=float(np.median(found.axes["B"]))).K
    assert 1.5 * exact < found.axes["K"][-1] < 3 * exact
    assert 0.2 < found.share("stable") < 0.8


@pytest.mark.parametrize(("over", "law"), [(("K", "delay"), "zoh"), (("K", "B"), "half_sample")])
@pytest.mark.always("over0-*")
def test_the_legend_lies_within_the_picture(over, law):
    pytest.importorskip("matplotlib")
    figure = wall_map(replace(FULL, coulomb=0.0), over=over, law=law, points=3, duration=0.04).plot()
    figure.savefig(io.BytesIO())
    (legend,) = figure.legends
    inner, outer = legend.get_window_extent(), figure.bbox
    assert outer.x0 <= inner.x0 and inner.x1 <= outer.x1 and outer.y0 <= inner.y0 and inner.y1 <= outer.y1


def test_a_line_left_of_the_picture_is_not_in_its_legend():
    pytest.importorskip("matplotlib")
    found = wall_map(replace(FULL, coulomb=0.0), K=[300.0, 2000.0], B=[0.0, 0.02], duration=0.05)
    assert found.limit("passivity").max() < 300 < found.limit("stability").min() < 2000
    labels = [text.get_text() for text in found.plot().legends[0].get_texts()]
    assert "passivity, any passive hand" not in labels and "Gil, this hand" in labels


def test_a_scene_of_its_own():
    """Eq. (23.8) around a wall with its boundary is felt; around the wall without one it is law ellis, Eq. (23.7)."""
    filtered, linear = hl.laws.force_filter(hl.wall()), hl.laws.force_filter(hl.wall(unilateral=None))
    axes = {"K": [100.0, 2000.0, 60000.0], "B": [0.0, 0.1], "duration": 0.2}
    found = wall_map(BARE, law=filtered, linear=linear, **axes)
    assert found.limit("stability")[0] == pytest.approx(hl.stability_limit(BARE, law="ellis").K, rel=1e-7)
    assert list(found.limits) == ["stability"] and found.share("passive") == 0
    swept = hl.sweep(filtered, BARE, duration=0.2, progress=False, v=0.1, k=axes["K"], B=axes["B"])
    slow = np.isnan(swept.values) & (found.amplitude == 0)  # bounces that shrink slowly: a map goes by theory there
    assert (slow | (found.amplitude == swept.values) | (np.isnan(swept.values) & np.isnan(found.amplitude)))[:2].all()
    blind = wall_map(BARE, law=filtered, over=("K", "delay"), K=[100.0, 5e4], delay=[0.0, 1e-3])
    assert blind.limits == {} and blind.regions[0, 0] == 1 and blind.regions[1, 1] == 3
    assert blind.plot().axes[0].get_title().startswith("filtered zoh wall")


def test_what_no_scene_can_be_mapped_over_is_refused():
    with pytest.raises(AnalysisError, match="a map over T needs a law by name,"):
        wall_map(BARE, law=hl.wall(), over=("K", "T"))
    with pytest.raises(AnalysisError, match="no parameter stiff"):
        wall_map(BARE, law=hl.wall(), parameter="stiff")
    k, m = hl.parameters("k m", units="N/m 1")
    with pytest.raises(AnalysisError, match="m is a parameter of .* and of the paddle"):
        wall_map(BARE, law=hl.Scene(force=k * m * hl.x(hl.n)), over=("K", "m"))
    maps = WallMaps(BARE, law=hl.wall(), K=[1.0, 2.0], B=[0.0, 0.1], duration=0.1)
    with pytest.raises(AnalysisError, match="made for 0.001 s"):
        maps.of(replace(BARE, T=2e-3))


def test_passivity_of_a_law_with_a_memory_says_where_it_ends():
    found = wall_map(FULL, law="ellis", K=[20.0, 40.0], B=[0.0, 0.01], duration=0.1)
    assert found.inside_only and "does not account for switching at the boundary" in str(found)
    assert not wall_map(FULL, K=[20.0, 40.0], B=[0.0, 0.01], duration=0.1).inside_only


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"over": ("B", "K")}, 'needs \\("K", other\\)'),
        ({"over": ("K", "push")}, "one of B, T, delay"),
        ({"K": [3.0, 2.0]}, "two or more finite numbers in rising order"),
        ({"K": [-3.0, 2.0]}, "a wall needs K >= 0"),
        ({"b": [0.1, 0.2]}, "the map is over K and B"),
        ({"unusable": 0.0}, "needs an amplitude > 0"),
        ({"bounds": ("minsky",)}, "minsky is not one of abbott_okamura,"),
        ({"duration": 0.01, "K": [1.0, 2.0]}, "needs at least 32"),
        ({"law": "foh"}, "law = 'foh'"),
        ({"duraton": 3}, "one of the axes K, B nor one of the options law,.*; did you mean duration"),
        ({"k": [1.0, 2.0]}, "did you mean K"),
        ({"points": 1}, "points = 1; an axis of a map needs a whole number of points,"),
        ({"B": 0.1}, "B = 0.1 N s/m; B is an axis: needs an array"),
        ({"points": "4"}, "a whole number"),
        ({"B": "0.1 N/m"}, "needs a quantity in N s/m"),
        ({"K": [1, 2, "a"]}, "two or more finite numbers in rising order"),
        ({"duration": "1 m"}, "needs a quantity in s"),
        ({"v": "fast"}, "a contact begins at a finite one"),
        ({"law": hl.wall()(k=100)}, "has k = 100, but the map is over k. Leave it unbound"),
    ],
)
def test_what_makes_no_map_is_refused(given, words):
    with pytest.raises((AnalysisError, hl.errors.SceneError), match=words):
        wall_map(FULL, **given)


def test_a_paddle_without_what_is_mapped_is_refused():
    lone = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    with pytest.raises(AnalysisError, match="no hand"):
        wall_map(lone, over=("K", "hand_b"))
    with pytest.raises(AnalysisError, match="no encoder"):
        wall_map(lone, over=("K", "counts_per_metre"))
    with pytest.raises(AnalysisError, match="needs a SimulatedPaddle"):
        wall_map("hapkit")
    with pytest.raises(AnalysisError, match="no limit gil"):
        wall_map(BARE, K=[1.0, 2.0], B=[0.0, 0.1], duration=0.1, bounds=()).limit("gil")


def test_picture():
    pytest.importorskip("matplotlib")
    figure = wall_map(FULL, K=np.linspace(20, 4000, 8), B=np.linspace(-0.1, 0.3, 6), duration=0.2).plot()
    axes = figure.axes[0]
    assert axes.get_xlabel() == "stiffness K [N/m]" and axes.get_ylabel() == "virtual damping B [N s/m]"
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"passive", "stable, not passive", "chatters", "exact linear stability, this hand", "Gil, this hand"} <= set(labels)
    grey = [sum(w * int(c[i : i + 2], 16) for w, i in zip((0.299, 0.587, 0.114), (1, 3, 5), strict=True)) for c in COLOURS]
    assert (-np.diff(grey) > 35).all()  # the order of the regions survives grey print


def test_straight_lines_between_rows():
    found = wall_map(BARE, K=[100.0, 190.0, 200.5], B=[0.0, 0.1], duration=0.1)
    assert under(found, "passivity")[:, 0].tolist() == [True, True, False]


def test_a_large_swing_of_an_unstable_loop_that_happens_to_shrink_is_no_rest():
    pytest.importorskip("llvmlite")
    # 16 Hz, 10 mm from peak to peak for ever; the fourth second quarter's swings are 0.3 % smaller than the third's
    hand = hl.Hand("pinch", push=1.0)
    delay = 0.002482758620689655
    paddle = hl.SimulatedPaddle.from_profile("hapkit", coulomb=0.03, delay=delay, hand=hand)
    K = 1104.416772563491
    x = paddle.run(hl.wall()(k=K), duration=5.0, v=0.1, progress=False).x_true
    assert abs(np.ptp(x[4000:]) / np.ptp(x[2000:3000]) - 1) < 0.01 and np.ptp(x[4000:]) > 0.01
    found = hl.stability.wall_map(paddle, over=("K", "delay"), K=[K, K + 1], delay=[delay, 1.001 * delay])
    assert found.regions[0, 0] == 3 and found.amplitude[0, 0] > 5e-3
