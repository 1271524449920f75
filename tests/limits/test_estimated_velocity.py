"""Limits of walls whose velocity is estimated by choice: closed forms, and loops written out from transfer functions."""

import numpy as np
import pytest
from scipy.optimize import brentq

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.colgate import passivity_margin
from hapticlab.limits.linear_law import LinearLaw
from hapticlab.limits.stability import stability_limit

T, M, DAMPING = 1e-3, 0.05, 0.4
ESTIMATES = {
    "filter": hl.velocity.filtered(tau=3e-3),
    "kalman": hl.velocity.kalman(acceleration=20, noise=5e-6),
    "difference": hl.velocity.backward(),
}


def polynomial(over, under, lead):
    """Return F/x of (23.3) with an estimate: (under + lead over)/under as rows in powers of 1/z, and under."""
    size = max(len(over), len(under))
    over, under = (np.pad(c, (0, size - len(c))) for c in (over, under))
    return under + lead * np.asarray(over), np.asarray(under)


@pytest.mark.parametrize("name", ESTIMATES)
def test_the_half_sample_wall_is_lost_where_its_characteristic_polynomial_says(name):
    """Handle under a held force: x/F = -(g0 + g1 z)/((z - 1)(z - a)); closed by K (1 + T/2 V(z))."""
    a, decay = np.exp(-DAMPING * T / M), M / DAMPING
    g1 = (T - decay * (1 - a)) / DAMPING  # of the newest force on x[n+1]
    g0 = (decay * (1 - a) - a * T) / DAMPING
    over, under = polynomial(*ESTIMATES[name].transfer(T), T / 2)

    def radius(K):
        loop = np.convolve(np.convolve([1, -1], [1, -a]), under)
        loop[1:] += K * np.convolve([g1, g0], over)
        return abs(np.roots(loop)).max()

    paddle = hl.SimulatedPaddle(m=M, b=DAMPING, T=T)
    found = stability_limit(paddle, law=hl.wall("half_sample", unilateral=None, velocity=ESTIMATES[name]))
    assert radius(0.99 * found.K) < 1 < radius(1.01 * found.K)
    # poles of a quadratic pair are known to 1e-13, and the radius grows as K: 1e-9 of K and better
    assert found.K == pytest.approx(brentq(lambda K: radius(K) - 1, 0.9 * found.K, 1.1 * found.K, rtol=1e-14), rel=1e-8)


@pytest.mark.parametrize("B", [0.3, -0.3])
@pytest.mark.parametrize("tau", [0.0, 1e-3, 5e-3])
def test_a_filtered_damper_asks_for_less_only_where_it_is_positive(tau, B):
    """b > B/(1 + 2 tau/T) for B >= 0, b > |B| for B < 0: of the scene as it is compiled."""
    law = LinearLaw.of_scene(hl.laws.virtual_damper(velocity=hl.velocity.filtered(tau=tau))(B=B), T=T)
    expected = B / (1 + 2 * tau / T) if B > 0 else abs(B)
    assert passivity_margin(hl.Device(b=1.0), law).required == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("name", ESTIMATES)
def test_the_compiled_estimate_has_its_own_transfer_function(name):
    over, under = ESTIMATES[name].transfer(T)
    theta = np.geomspace(1e-3, np.pi, 50)
    z = np.exp(1j * theta)
    expected = np.polyval(over[::-1], 1 / z) / np.polyval(under[::-1], 1 / z)
    law = LinearLaw.of_scene(hl.laws.virtual_damper(velocity=ESTIMATES[name])(B=1), T=T)
    np.testing.assert_allclose(law.at(theta), expected, rtol=1e-7)  # a tick is measured to 1e-9


def test_a_window_has_no_linear_limit():
    scene = hl.wall("half_sample", unilateral=None, velocity=hl.velocity.window(deviation=1e-5, longest=4))
    with pytest.raises(AnalysisError, match="not linear"):
        stability_limit(hl.SimulatedPaddle(m=M, b=DAMPING, T=T), law=scene)


def test_compensation_spends_what_a_wall_needs():
    """(23.10) with B = -viscous b: K <= 2 b (1 - viscous)/T, of the compiled scene."""
    viscous = 0.7
    at_limit = 2 * DAMPING * (1 - viscous) / T
    for part, passive in ((0.999, True), (1.001, False)):
        wall = hl.wall(unilateral=None)(k=part * at_limit)
        scene = hl.laws.damping_compensation(wall, b=DAMPING)(viscous=viscous)
        assert passivity_margin(hl.Device(b=DAMPING), LinearLaw.of_scene(scene, T=T)).passive == passive
