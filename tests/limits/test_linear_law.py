"""A law as matrices: against its z-transform written out, its scene, and a recursion run by hand."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import n, x
from hapticlab.errors import AnalysisError
from hapticlab.limits.linear_law import LinearLaw

T = 1e-3
THETA = np.linspace(0.01, np.pi, 60)
W = np.exp(-1j * THETA)  # 1/z


@pytest.mark.parametrize("tau", [None, 2.5e-3])
@pytest.mark.parametrize("filtered", [False, True])
@pytest.mark.parametrize(("law", "spring"), [("zoh", 1 + 0 * W), ("ellis", 2 - 1.5 * W + 0.5 * W**2)])
def test_the_response_of_a_law_of_the_chapter(law, spring, filtered, tau):
    found = LinearLaw.of(law, K=120.0, T=T, B=-0.3, velocity_filter=tau, filtered=filtered)
    H = 120 * spring - 0.3 * (1 - W) / (T + (tau or 0) * (1 - W))
    H = H * (2 - 1.5 * W + 0.5 * W**2 if filtered else 1)
    assert found.at(THETA) == pytest.approx(H, rel=1e-13)
    assert found.finite == (tau is None) and found.stiffness == pytest.approx(120, rel=1e-9)
    assert found.radius == pytest.approx(0.0 if tau is None else 2.5 / 3.5, abs=1e-12)


def test_a_scene_and_its_law_are_one():
    scene = hl.Scene(force=hl.laws.force_filter(hl.wall("backward_difference", unilateral=None)(k=80, B=0.1)).force)
    found = LinearLaw.of_scene(scene(k=80, B=0.1, x_o=0), T=T)
    other = LinearLaw.of("backward_difference", K=80, B=0.1, T=T, filtered=True)
    assert found.taps() == pytest.approx(other.taps(), rel=1e-9)
    assert found.taps() == pytest.approx(np.convolve([220, -140], [2, -1.5, 0.5]), rel=1e-9)


def test_a_recursion_by_hand():
    """F[n] = 0.9 F[n-1] + 50 (x[n] - x[n-3])."""
    law = LinearLaw(np.diag([0.9]), np.array([1.0]), np.array([45.0]), 50.0, T, "lag").then([1, 0, 0, -1])
    xs, forces = np.random.default_rng(3).normal(size=30), []
    lag = [0.0]
    for k, now in enumerate(xs):
        lag.append(0.9 * lag[-1] + 50 * now)
        forces.append(lag[-1] - (lag[-4] if k >= 3 else 0.0))
    assert np.convolve(xs, law.impulse(30))[:30] == pytest.approx(np.array(forces), abs=1e-10)


def test_two_laws_side_by_side():
    both = LinearLaw.of("zoh", K=3, T=T) + 2.0 * LinearLaw.of("ellis", K=1, T=T).then([0, 1])
    assert both.taps() == pytest.approx([3, 4, -3, 1]) and not np.isnan(both.stiffness)
    assert str(LinearLaw.of("zoh", K=5, B=-0.001, T=T)).endswith("F[n] = 4 x[n] + 1 x[n-1], T = 1 ms")
    assert LinearLaw(np.eye(1), np.ones(1), np.ones(1), 0.0, T, "sum").at(0.0) == np.inf
    with pytest.raises(AnalysisError, match="the laws have T = 0.001 s and 0.002 s; both need the same sampling period"):
        LinearLaw.of("zoh", K=1, T=T) + LinearLaw.of("zoh", K=1, T=2 * T)


def test_refusals():
    with pytest.raises(AnalysisError, match="not a position law"):
        LinearLaw.of("half_sample", K=100, T=T)
    with pytest.raises(AnalysisError, match="impulse response does not end"):
        LinearLaw.of("zoh", K=100, T=T, B=1.0, velocity_filter=1e-3).taps()
    with pytest.raises(AnalysisError, match="not linear"):
        LinearLaw.of_scene(hl.wall()(k=100, x_o=0), T=T)
    with pytest.raises(AnalysisError, match="velocity_filter = -1"):
        LinearLaw.of("zoh", K=100, T=T, velocity_filter=-1)
    with pytest.raises(AnalysisError, match="needs a second LinearLaw"):
        LinearLaw.of("zoh", K=1, T=T) + 3
    with pytest.raises(AnalysisError, match="law = 'verlet'"):
        LinearLaw.of("verlet", K=100, T=T)


@pytest.mark.parametrize(
    ("taps", "T", "words"),
    [
        ([100.0], 0, "T = 0 s"),
        ([100.0], -1e-3, "T = -0.001 s"),
        ([np.nan, 1], T, "taps = .*finite numbers, 2 of them"),
        ([1.0, np.inf], T, "taps = .*finite numbers"),
        ([], T, "taps = "),
        ([[1, 2], [3, 4]], T, "taps = "),
        ("stiff", T, "taps = stiff"),
    ],
)
def test_a_law_is_of_finite_numbers_and_of_a_period(taps, T, words):
    with pytest.raises(AnalysisError, match=words):
        LinearLaw.of_taps(taps, T=T)


def test_matrices_that_do_not_fit_are_refused():
    with pytest.raises(AnalysisError, match="needs finite numbers, 1 x 1 of them"):
        LinearLaw(np.eye(2), np.ones(1), np.ones(1), 0.0, T, "odd")
    with pytest.raises(AnalysisError, match="odd: D = nan; needs a finite number"):
        LinearLaw(np.eye(1), np.ones(1), np.ones(1), np.nan, T, "odd")


def test_a_late_force():
    stiffness = hl.parameters("a", units="N/m", values=7)
    late = hl.Scene(force=hl.laws.delay(stiffness * x(n)))
    assert LinearLaw.of_scene(late, T=T).taps() == pytest.approx([0, 7])
