"""A sweep's points against the same points run alone and measured from their stored traces."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from scipy.interpolate import CubicSpline

import hapticlab as hl
from hapticlab.analysis.records.chatter import chatter
from hapticlab.analysis.records.energy import energy
from hapticlab.analysis.sweeps.sweep import sweep
from hapticlab.base.figure_words import describe
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError, PaddleError, ParameterError, ProgramError
from hapticlab.limits.stability import stability_limit
from hapticlab.scene.laws.chapter_laws import wall
from hapticlab.scene.notation.symbols import n, parameters, t, x
from hapticlab.scene.scene import Scene

PUSHED = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(push=2.0))
#: encoder, friction, noise, saturation, and a force that changes inside the periods
FULL = SimulatedPaddle(
    m=0.05, b=0.1, T=1e-3, delay=1.3e-3, counts_per_metre=2e4, coulomb=0.05, force_max=8.0, noise=1e-5, seed=4,
    hand=Hand(m=0.01, b=0.3, k=40.0, push=1.5),
)  # fmt: skip
K = np.array([60.0, 150.0, 420.0, 1300.0])


@functools.cache  # one run serves every metric
def run(paddle, k, duration=0.8):
    return paddle.run(wall()(k=k, x_o=0.002), duration=duration, progress=False)


def traces(log, metric):
    """Measure a stored trace in whole-array arithmetic, apart from the compiled measures."""
    true = log.channels.get("x_true", log.x)
    quarter = len(true) // 4
    before, after = (largest_swing(true, log.T, len(true) - end, quarter) for end in (2 * quarter, quarter))
    half = log.F[-2 * quarter :]
    return {
        "growth": lambda: math.log(after / before) / (quarter * log.T) if after and before else math.nan,
        "contacts": lambda: np.count_nonzero((half[1:] != 0) & (half[:-1] == 0)) / (2 * quarter * log.T),
        "energy": lambda: energy(log).extracted,
        "peak_force": lambda: abs(log.F).max(),
        "chatter": lambda: after / 2,
    }[metric]()


def largest_swing(x, T, start, length):
    """Return the largest way between turning points whose later one lies in a stretch, by a spline through the samples."""
    turns = CubicSpline(np.arange(len(x)), x).derivative().roots(extrapolate=False)
    at = CubicSpline(np.arange(len(x)), x)(turns)
    ends = turns[1:]
    inside = (ends > start - 1) & (ends < start + length - 1)  # a turn is known one sample later
    return abs(np.diff(at))[inside].max(initial=0.0)


@pytest.mark.parametrize("paddle", [PUSHED, FULL], ids=["plain", "full"])
@pytest.mark.parametrize("metric", ["growth", "contacts", "energy", "peak_force"])
@pytest.mark.always("*-plain")
def test_metrics_match_the_stored_traces(paddle, metric):
    swept = sweep(wall()(x_o=0.002), paddle, duration=0.8, metric=metric, progress=False, k=K)
    expected = [traces(run(paddle, k), metric) for k in K]
    # a trace without encoder holds x in single precision, and a spline bends at contact where the handle moves on parabolas
    np.testing.assert_allclose(swept.values, expected, rtol=5e-3 if metric == "growth" else 1e-5, atol=1e-7)


def test_chatter_is_the_sustained_amplitude():
    swept = sweep(wall()(x_o=0.002), PUSHED, duration=20.0, progress=False, k=K)
    logs = [run(PUSHED, k, 20.0) for k in K]
    found = [chatter(log) for log in logs]
    assert [c.state for c in found] == ["none", "none", "chatter", "chatter"] or found[1].state == "decaying"
    assert (swept.values[:2] == 0).all()  # 200 N/m is where Eq. (23.10) ends
    np.testing.assert_allclose(swept.values[2:], [c.amplitude for c in found[2:]], rtol=2e-2)
    np.testing.assert_allclose(swept.values[2:], [traces(log, "chatter") for log in logs[2:]], rtol=1e-4)


def test_motion_within_one_count_is_no_chatter():
    coarse = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=500.0, hand=Hand(push=0.05))
    swings = sweep(wall(), coarse, duration=4.0, metric="growth", progress=False, k=[20.0, 60.0]).values
    assert np.isfinite(swings).all()  # the handle does move
    amplitudes = sweep(wall(), coarse, duration=4.0, progress=False, k=[20.0, 60.0]).values
    assert ((amplitudes == 0) | (amplitudes > 0.5 / 500)).all()


@pytest.mark.parametrize("paddle", [PUSHED, FULL], ids=["plain", "full"])
@pytest.mark.always("full")
def test_every_point_is_what_it_is_alone_bit_for_bit(paddle):
    axes = {"k": K, "T": np.array([5e-4, 1e-3]), "b": np.array([0.07, 0.2, 0.9])}
    for metric in ("chatter", "energy"):
        swept = sweep(wall()(x_o=0.002), paddle, duration=0.25, metric=metric, progress=False, **axes)
        assert list(swept.axes) == ["k", "T", "b"] and swept.values.shape == (4, 2, 3)
        for i, j, h in ((0, 0, 0), (3, 1, 2), (2, 0, 1)):
            alone = {"k": K[i], "T": axes["T"][j], "b": axes["b"][h]}
            one = sweep(wall()(x_o=0.002), paddle, duration=0.25, metric=metric, progress=False, **alone)
            assert one.values.shape == ()
            np.testing.assert_array_equal(one.values, swept.values[i, j, h])


def test_axes_keep_the_order_given():
    ab = sweep(wall(), PUSHED, duration=0.2, metric="peak_force", progress=False, T=[1e-3, 2e-3], k=K)
    ba = sweep(wall(), PUSHED, duration=0.2, metric="peak_force", progress=False, k=K, T=[1e-3, 2e-3])
    assert list(ab.axes) == ["T", "k"] and ab.values.shape == (2, 4)
    np.testing.assert_array_equal(ab.values, ba.values.T)
    assert ab.units == {"T": "s", "k": "N/m"} and ab.unit == "N"


@pytest.mark.wide
def test_the_engines_agree():
    ways = [
        sweep(wall(), FULL, duration=0.1, metric=metric, engine=engine, progress=False, k=K, delay=[0.0, 4e-4]).values
        for engine in ("auto", "interpreter")
        for metric in ("energy", "peak_force")
    ]
    np.testing.assert_array_equal(ways[0], ways[2])
    np.testing.assert_array_equal(ways[1], ways[3])


def test_more_lanes_and_ticks_than_one_call_takes():
    k = np.linspace(20, 2000, 2100)
    many = sweep(wall(), PUSHED, duration=2.5, metric="peak_force", progress=False, k=k).values
    few = sweep(wall(), PUSHED, duration=2.5, metric="peak_force", progress=False, k=k[[0, 2047, 2048, 2099]]).values
    np.testing.assert_array_equal(many[[0, 2047, 2048, 2099]], few)


def test_the_start_is_an_axis_too():
    free = SimulatedPaddle(m=0.05, b=0.0, T=1e-3)
    bounce = sweep(wall(), free, duration=0.5, metric="peak_force", progress=False, x=-1e-3, v=[0.1, 0.2], k=200.0)
    # one bounce of a free mass: the force peaks at v sqrt(k m), and the held force sets it off by a few percent
    np.testing.assert_allclose(bounce.values, np.array([0.1, 0.2]) * math.sqrt(200 * 0.05), rtol=0.05)
    assert "x = -0.001" in bounce.about


def test_a_force_that_overflows_gives_nan():
    blown = sweep(
        wall(unilateral=None),
        SimulatedPaddle(m=0.05, b=0.1, T=1e-3),
        duration=1.0,
        progress=False,
        x=1e-3,
        k=[10.0, 1e7],
    )
    assert np.isfinite(blown.values[0]) and np.isnan(blown.values[1])


def test_bad_sweeps_are_refused():
    scene = wall()
    with pytest.raises(
        AnalysisError, match="kk is not a quantity that can be swept.*parameters: .*k.*paddle's: T, m, b.*start: x, v"
    ):
        sweep(scene, PUSHED, kk=[1.0])
    with pytest.raises(AnalysisError, match="metric = 'noise'; needs one of chatter, growth"):
        sweep(scene, PUSHED, metric="noise", k=[1.0])
    with pytest.raises(AnalysisError, match=r"k = \[1.0, nan\]; an axis needs one or more finite numbers \[N/m\]"):
        sweep(scene, PUSHED, k=[1.0, math.nan])
    with pytest.raises(AnalysisError, match="an axis needs one or more"):
        sweep(scene, PUSHED, k=[])
    with pytest.raises(AnalysisError, match="is not a scene"):
        sweep("wall", PUSHED, k=[1.0])
    with pytest.raises(ParameterError, match="k"):
        sweep(scene, PUSHED, k=[-50.0, 10.0])
    with pytest.raises(PaddleError, match="m = -1"):
        sweep(scene, PUSHED, k=10.0, m=[-1.0, 0.1])
    with pytest.raises(ParameterError, match="no value for k"):
        sweep(scene, PUSHED, b=[0.1])
    m = parameters("m", units="N/m")
    with pytest.raises(AnalysisError, match="m is a parameter of the scene and of the paddle; rename the scene's"):
        sweep(Scene(force=m * x(n)), PUSHED, m=[1.0])


def test_a_wall_far_too_stiff_is_never_called_quiet():
    """Few bounces a second, and growing: the amplitude, or nan where the run is too short to tell, but not zero."""
    slow = SimulatedPaddle(m=0.05, b=0.1, T=2e-3, hand=Hand(push=2.0))
    k = np.geomspace(120.0, 2000.0, 40)
    assert k[0] > stability_limit(slow).K
    swings = sweep(wall(), slow, progress=False, k=k).values
    assert not (swings == 0).any()
    assert np.isfinite(swings).mean() > 0.9


@pytest.mark.parametrize("push", [0.5, 2.0])
def test_a_short_sweep_finds_the_limit_and_nothing_on_either_side_of_it(push):
    """One second holds two or three periods of this paddle; what it cannot tell it calls nan, not chatter or rest."""
    heavy = SimulatedPaddle.from_profile("eth", hand=Hand(push=push))
    k = np.geomspace(10.0, 1000.0, 120)
    limit = stability_limit(heavy).K
    swings = sweep(wall(), heavy, progress=False, k=k).values
    assert not (swings[k < 0.96 * limit] > 0).any()
    assert not (swings[k > 1.04 * limit] == 0).any()
    assert np.isfinite(swings).mean() > 0.85


def test_what_never_moved_has_no_verdict():
    still = SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    assert np.isnan(sweep(wall(), still, progress=False, k=[100.0, 5000.0]).values).all()


def test_drift_through_a_saturated_wall_does_not_grow():
    weak = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=0.3, hand=Hand(push=0.5))
    assert np.isnan(sweep(wall(), weak, metric="growth", progress=False, k=100.0).values)
    assert sweep(wall(), weak, progress=False, k=100.0).values == 0


def test_a_run_of_a_few_samples_is_refused():
    with pytest.raises(AnalysisError, match="duration = 1 s is 3 samples of T = 0.3 s; needs at least 32"):
        sweep(wall(), PUSHED, progress=False, k=100.0, T=[0.3])


def test_a_handle_that_has_come_to_rest_is_quiet_and_not_unknown():
    held = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(m=0.02, b=1.0, k=200.0, push=2.0))
    assert (sweep(wall(), held, duration=20.0, progress=False, k=np.geomspace(50.0, 1500.0, 60)).values == 0).all()


def test_texts_with_units_are_axes_too():
    told = sweep(wall(), PUSHED, metric="peak_force", progress=False, duration=0.2, k=["100 N/m", "0.2 N/mm"], T="1 ms")
    plain = sweep(wall(), PUSHED, metric="peak_force", progress=False, duration=0.2, k=[100.0, 200.0], T=1e-3)
    np.testing.assert_array_equal(told.axes["k"], [100.0, 200.0])
    np.testing.assert_array_equal(told.values, plain.values)
    with pytest.raises(AnalysisError, match=r"k = \[None\]; an axis needs"):
        sweep(wall(), PUSHED, k=[None])


def bouncing():
    """A ball that falls on the handle, and loses 1 - e^2 of its energy each time."""
    m, g, h, e = hl.parameters("m_b g h e", units="kg m/s^2 m 1", values=(0.02, 9.81, 0.01, 0.5), ranges={"e": (0, 1)})
    q = hl.coordinate("q", unit="m", initial=x(n) + h)
    hit = hl.contact.Contact(q - x(t), hl.contact.impulse(e=e), name="hit")
    free = hl.mechanics.lagrange(m * q.diff(t) ** 2 / 2 - m * g * q, contacts=[hit])
    k = hl.parameters("k", units="N/m", values=200)
    felt = hl.contact.felt_impulse(hit, tau="4 ms")
    return Scene(force=k * x(n) + felt.force, eom=[free, *felt.equations], watch=[q])


@pytest.mark.wide
def test_impacts_are_swept_by_a_method_that_knows_them():
    scene, axes = bouncing(), {"e": [0.2, 0.9], "k": [100.0, 400.0]}
    with pytest.raises(ProgramError, match="taylor"):
        sweep(scene, PUSHED, progress=False, method="rk4", **axes)
    options = {"duration": 0.2, "progress": False}
    grid = sweep(scene, PUSHED, metric="peak_force", method="taylor", **options, **axes)
    np.testing.assert_array_equal(sweep(scene, PUSHED, metric="peak_force", **options, **axes).values, grid.values)
    alone = [[abs(PUSHED.run(scene(e=e, k=k), method="taylor", **options).F).max() for k in axes["k"]] for e in axes["e"]]
    np.testing.assert_array_equal(grid.values, alone)
    assert len(np.unique(grid.values)) == 4


def test_how_a_sweep_is_compiled():
    K, m = hl.parameters("K m_2", units="N/m kg", values=(400, 0.05))
    z = hl.coordinate("z", unit="m")
    scene = Scene(force=K * (x(n) - z), eom=[sp.Eq(m * z.diff(t, 2), K * (x(t) - z))])
    options = {"duration": 0.2, "progress": False}
    for how in ({"method": "euler", "substeps": 3}, {"method": "heun", "hold": "zoh"}, {"method": "exact"}):
        grid = sweep(scene, PUSHED, metric="peak_force", b=[0.1, 0.5], **options, **how)
        live = {"live": ()} if how["method"] == "exact" else {}
        alone = [abs(replace(PUSHED, b=b).run(scene, **options, **how, **live).F).max() for b in (0.1, 0.5)]
        np.testing.assert_array_equal(grid.values, alone)
    with pytest.raises(ProgramError, match="method = 'rk5'"):
        sweep(scene, PUSHED, b=[0.1], method="rk5")
    with pytest.raises(
        ProgramError,
        match="the motion, so K in it cannot be an axis of the sweep. Use method='taylor', or one call for each value",
    ):
        sweep(scene, PUSHED, K=[300.0, 400.0], method="exact", **options)
    hold = parameters("hold", units="N/m")
    own = sweep(Scene(force=hold * x(n)), PUSHED, metric="peak_force", hold=[100.0, 900.0], **options)
    assert list(own.axes) == ["hold"] and own.values[0] < own.values[1]


def test_the_engine_of_a_sweep_takes_doubles():
    with pytest.raises(PaddleError, match="engine = 'vm'; a simulated paddle, float64 inside, runs on auto, llvm"):
        sweep(wall(), PUSHED, engine="vm", k=100.0)


def test_an_exact_sweep_says_what_is_no_axis():
    """Of a wall that the mass is on or off, where it is may be set, and what its motion is made of not."""
    K, m, k, p = hl.parameters("K m_z k p_0", units="N/m kg N/m m", values=(500, 0.05, 2e3, 0.01))
    z = hl.coordinate("z", unit="m")
    scene = Scene(force=K * (x(n) - z), eom=[sp.Eq(m * z.diff(t, 2), K * (x(t) - z) - hl.when(z >= p, k * (z - p), 0))])
    given = {"metric": "peak_force", "duration": 0.05, "v": 0.3, "progress": False, "method": "exact"}
    assert len(set(sweep(scene, PUSHED, p_0=[1e-3, 2e-3], **given).values)) == 2
    with pytest.raises(
        ProgramError, match="constants for the motion, so k in it cannot be an axis of the sweep. Use method='taylor',"
    ):
        sweep(scene, PUSHED, k=[100.0, 200.0], p_0=[1e-3, 2e-3], **given)


def test_a_sweep_without_end_is_refused():
    with pytest.raises(AnalysisError, match=r"is 1e\+303 samples of T = 0.001 s; a sweep runs at most 1e\+12"):
        sweep(wall(), PUSHED, duration=1e300, k=[100.0])


def test_a_light_handle_is_refused_by_its_value_on_the_axes():
    with pytest.raises(PaddleError, match=r"m = 1e-09 kg, T = 0.002 s, coulomb > 0, .*Use m >= .* kg, T <="):
        sweep(wall(), PUSHED, k=100.0, coulomb=[0.0, 0.1], m=[0.05, 1e-9], T=[1e-3, 2e-3])
    sprung = replace(PUSHED, hand=Hand(k=1e13))
    with pytest.raises(PaddleError, match="m = 1e-12 kg; with b = 0 N s/m.* T = 0.001 s .*needs m >= 1.01e-11 kg"):
        sweep(wall(), sprung, k=100.0, m=[1e-12, 1.0], b=[0.0, 1e9], T=[1e-5, 1e-3])


def test_a_handle_that_friction_stops_rests():
    """It turned round once and stands still, exactly: no handle thrown off that has yet to come back."""
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.3, hand=Hand(push=1.0))
    log = paddle.run(wall()(k=100.0, x_o=0.0), duration=1.0, v=0.1)
    assert log.v[-1] == 0 and (np.diff(np.sign(log.v[log.v != 0])) != 0).any()
    assert sweep(wall(), paddle, progress=False, v=0.1, k=[100.0]).values == 0


@pytest.mark.parametrize(("m", "b", "T"), [(0.05, 0.1, 1e-3), (0.02, 0.3, 5e-4), (0.2, 0.05, 2e-3)])
@pytest.mark.parametrize("duration", [1.0, 4.0])
@pytest.mark.always("1.0-0.05-*", "4.0-0.2-*")
def test_bounces_that_shrink_slowly_are_not_called_calm(m, b, T, duration):
    """Above the exact limit a dropped handle ends in a cycle; nan says that a run is too short to show it."""
    paddle = SimulatedPaddle(m=m, b=b, T=T, hand=Hand(push=1.0))
    k = stability_limit(paddle).K * np.linspace(1.05, 3, 20)
    found = sweep(wall(), paddle, duration=duration, progress=False, x=-0.02, k=k).values
    assert not (found == 0).any()
    inside = sweep(wall(), paddle, duration=4.0, progress=False, x=0.9 / k[0], k=k[:1] / 3).values
    assert (inside == 0).all()  # a handle that stays inside a linear wall comes to rest, however slowly


def test_what_is_no_simulated_paddle_is_refused_in_words():
    with pytest.raises(AnalysisError, match=r"paddle = None; needs an hl.SimulatedPaddle"):
        sweep(wall(), None, k=[100.0, 200.0])


def test_a_sweep_that_knows_nothing_says_so_and_shows_what_was_swept():
    """0.2 s end before the handle has turned three times."""
    swept = sweep(wall(), SimulatedPaddle(m=0.05, b=0.1, T=1e-3), 0.2, progress=False, k=[50.0, 100.0, 300.0], v=0.1)
    assert np.isnan(swept.values).all()
    assert "3 of 3 not known: faulted, or too short to decide" in swept._repr_html_()
    assert {fact.name: fact for fact in swept._facts()}["values"].meaning.endswith("faulted or the run does not decide")
    figure = swept.plot()
    assert figure.axes[0].get_xlim()[0] <= 50 and figure.axes[0].get_xlim()[1] >= 300
    assert describe(figure) == "Chatter amplitude [mm] over stiffness k [N/m], 50 to 300: not known anywhere."
    partly = replace(swept, values=np.array([math.nan, 0.002, 0.003]))
    assert partly.plot().axes[0].get_xlim()[0] <= 50 and "; 1 of 3 not known" in partly._sentence()
    known = replace(swept, values=np.array([0.001, 0.002, 0.003]))
    assert "not known" not in known._sentence() and "rises from 1 to 3" in describe(known.plot())
