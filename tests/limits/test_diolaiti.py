"""Diolaiti's plane against simulations of the four kinds of wall."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.diolaiti import diolaiti

T, m = 1e-3, 0.05
SPRING = hl.wall(unilateral=None)


def amplitudes(K, b, coulomb, start, counts=None, delay=0.0):
    """Peak |x| in the first and in the last tenth of two seconds in the spring."""
    pytest.importorskip("llvmlite")  # two seconds each on the interpreter
    paddle = hl.SimulatedPaddle(m=m, b=b, T=T, coulomb=coulomb, counts_per_metre=counts, delay=delay)
    log = paddle.run(SPRING(k=K, x_o=0), duration=2.0, x=start, progress=False)
    x = np.abs(log.channels.get("x_true", log.x))
    return x[: len(x) // 10].max(), x[-len(x) // 10 :].max()


@pytest.mark.parametrize(("K", "delay"), [(230.0, 0.0), (300.0, 0.0), (130.0, 0.5e-3)])
def test_a_locally_stable_wall_grows_above_its_amplitude_alone(K, delay):
    """The describing function is exact for slow cycles: w T is below 0.08 here."""
    point = diolaiti(K=K, b=0.1, T=T, coulomb=0.01, delay=delay, m=m)
    assert point.region.startswith("locally stable") and point.sigma == np.inf
    for factor, grows in ((0.9, False), (1.1, True)):
        first, last = amplitudes(K, 0.1, 0.01, factor * point.amplitude, delay=delay)
        assert last > 1.02 * first if grows else last < 0.98 * first


def test_the_regions_of_a_quantised_wall():
    """A fine and a coarse friction, beside a soft and a stiff spring; a count of 0.2 mm, motion from 20 counts."""
    resolution, start = 0.2e-3, 4e-3
    kinds = {}
    for K, coulomb in ((150, 0.02), (150, 0.002), (400, 0.002)):
        point = diolaiti(K=K, b=0.1, T=T, coulomb=coulomb, resolution=resolution, m=m)
        kinds[point.region.split(":")[0]] = amplitudes(K, 0.1, coulomb, start, counts=1 / resolution)
    assert list(kinds) == ["passive", "limit cycles", "unstable"]
    assert kinds["passive"][1] < 1.1 * resolution + 0.02 / 150
    assert kinds["limit cycles"][1] < 0.5 * start
    assert kinds["unstable"][1] > 2 * start


def test_numbers_words_and_picture():
    point = diolaiti(K=300, b=0.1, T=T, coulomb=0.05, resolution=0.2e-3, delay=T / 4, m=m)
    assert (point.beta, point.sigma, point.tau) == pytest.approx((1 / 3, 5 / 6, 0.25))
    assert point.amplitude == pytest.approx(4 * 0.05 / (np.pi * (300 / m) ** 0.5 * (300 * 0.75e-3 - 0.1)), rel=1e-12)
    axes = point.plot().axes[0]
    assert {text.get_text() for text in axes.texts} == {"passive", "limit cycles", "locally stable", "unstable"}
    assert np.isnan(diolaiti(K=300, b=0.1, T=T).amplitude) and diolaiti(K=100, b=0.1, T=T).amplitude == np.inf
    for mass in (-1, 0):
        with pytest.raises(AnalysisError, match="m = .* needs? a mass m > 0|need a mass m > 0"):
            diolaiti(K=300, b=0.1, T=T, m=mass)
    with pytest.raises(AnalysisError, match="needs K > 0"):
        diolaiti(K=0, b=0.1, T=T)


def test_it_is_called_passive_only_where_every_motion_is_paid_for():
    """Half a period late: passive to 94.43 N/m, slow sinusoids to 100 N/m; energy of an alternating cycle by hand."""
    words = {K: diolaiti(K=K, b=0.1, T=T, delay=T / 2, m=m).region for K in (94, 98)}
    assert words[94].startswith("passive") and "not passive" in words[98]
    assert diolaiti(K=66, b=0.1, T=T, delay=T).region.startswith("passive")
    # closed cycles of 150 samples, D1 before the force changes and D2 after, F the spring's: least work + b(D1^2 + D2^2)/(T/2)
    n = 150
    moved = np.kron(np.eye(n), [1.0, 1.0])  # displacement of each period
    x = np.tril(np.ones((n, n)), -1) @ moved
    late, now = np.kron(np.eye(n), [1.0, 0.0]), np.kron(np.eye(n), [0.0, 1.0])
    basis = np.linalg.svd(np.ones((1, 2 * n)))[2][1:].T  # it comes back
    for K, sign in ((94, 1), (98, -1)):
        work = K * (np.roll(x, 1, axis=0).T @ late + x.T @ now)
        form = basis.T @ (work + work.T + 4 * 0.1 / T * np.eye(2 * n)) @ basis
        assert np.linalg.eigvalsh(form)[0] * sign > -1e-9


def test_where_small_motions_grow_no_amplitude_is_told():
    point = diolaiti(K=300, b=0.1, T=T, coulomb=0.01, resolution=0.2e-3, m=m)
    assert point.amplitude == 0 and str(point).endswith("small and large motions grow")
