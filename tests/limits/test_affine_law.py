"""Limits of laws of any memory, against roots of characteristic polynomials written out by hand, in 25 digits."""

import math
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.affine_law import affine_law
from hapticlab.limits.linear_law import LinearLaw
from hapticlab.limits.loop import Loop
from hapticlab.limits.stability import closed_loop_matrix, closed_loop_poles, stability_limit

T = 0.8e-3


def paddle(m=0.045, b=0.12, delay=0.0, hand=None, **more):
    return hl.Device(**{"m": m, "b": b, "T": T, "delay": delay, "hand": hand, "velocity": "measured", **more})


def product(*polynomials):
    """Multiply polynomials, highest power first."""
    total = [mp.mpf(1)]
    for p in polynomials:
        new = [mp.mpf(0)] * (len(total) + len(p) - 1)
        for i, a in enumerate(total):
            for j, b in enumerate(p):
                new[i + j] += a * b
        total = new
    return total


def added(one, other):
    n = max(len(one), len(other))
    one, other = ([mp.mpf(0)] * (n - len(p)) + list(p) for p in (one, other))
    return [a + b for a, b in zip(one, other, strict=True)]


def edge(law, m=0.045, b=0.12, start=1.0):
    """Bisect the stiffness at which a root of the free handle's loop crosses the unit circle; law(K) -> (numerator, own)."""
    with mp.workdps(25):
        h, tau = mp.mpf(T), mp.mpf(m) / mp.mpf(b)
        a = mp.e ** (-h / tau)
        g1, g0 = (h - tau * (1 - a)) / b, (tau * (1 - a) - a * h) / b

        def outside(K):
            numerator, own = law(K)
            p = added(product([1, -(1 + a), a], own), product([g1, g0], numerator))
            return max(abs(z) for z in mp.polyroots(p, maxsteps=100, extraprec=40)) > 1

        low, high = mp.mpf(start), mp.mpf(start)
        while not outside(high):
            low, high = high, high * mp.mpf("1.5")
        for _ in range(31):  # to 1e-10
            middle = (low + high) / 2
            low, high = (low, middle) if outside(middle) else (middle, high)
        return float(low)


def difference(K, B, tau):
    """K + B (1 - 1/z)/T with a first-order filter of the velocity, v[n] = (tau v[n-1] + x[n] - x[n-1])/(tau + T)."""
    own = [mp.mpf(T) + tau, -mp.mpf(tau)]
    return added([K * c for c in own], [mp.mpf(B), -mp.mpf(B)]), own


@pytest.mark.parametrize(("B", "tau"), [(0.4, 0.0), (0.4, 3e-3), (1.5, 2e-3), (-0.05, 1e-3)])
@pytest.mark.always("0.4-0.003", "-0.05-0.001")
def test_a_filtered_velocity(B, tau):
    expected = edge(lambda K: difference(K, B, tau) if tau else ([K + B / mp.mpf(T), -B / mp.mpf(T)], [1, 0]))
    found = stability_limit(paddle(), law=lambda K: LinearLaw.of("zoh", K=K, B=B, T=T, velocity_filter=tau))
    assert found.K == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("B", [0.0, 0.1])
@pytest.mark.always("0.1")
def test_the_filter_around_spring_and_damper(B):
    """Eq. (23.8) around K and B together; a scene, compiled, is read off its tick."""

    def law(K):
        filtered = [mp.mpf(2), mp.mpf("-1.5"), mp.mpf("0.5")]
        return product(filtered, [K + B / mp.mpf(T), -B / mp.mpf(T)]), [1, 0, 0, 0]

    scene = hl.laws.force_filter(hl.wall(unilateral=None))(B=B)
    found = stability_limit(paddle(), law=scene)
    assert found.K == pytest.approx(edge(law), rel=1e-8)  # a scene's tick is measured to 1e-9 or better
    assert stability_limit(paddle(), law=lambda K: LinearLaw.of(K=K, B=B, T=T, filtered=True)).K == pytest.approx(
        found.K, rel=1e-8
    )


@pytest.mark.parametrize("law", ["zoh", "half_sample", "backward_difference", "ellis"])
@pytest.mark.parametrize("velocity", ["measured", "backward_difference"])
@pytest.mark.always("measured-ellis", "backward_difference-zoh")
def test_a_wall_without_a_boundary_is_its_law(law, velocity):
    p = paddle(delay=0.3 * T, hand=SimpleNamespace(m=0.02, b=1.1, k=210.0), velocity=velocity)
    named = stability_limit(p, law=law, B=0.05)
    scene = stability_limit(p, law=hl.wall(law, unilateral=None)(B=0.05))
    assert scene.K == pytest.approx(named.K, rel=1e-8)
    assert scene.frequency == pytest.approx(named.frequency, rel=1e-6)
    ours = closed_loop_poles(p, K=300.0, law=hl.wall(law, unilateral=None)(B=0.05))
    theirs = closed_loop_poles(p, K=300.0, law=law, B=0.05)
    np.testing.assert_allclose(np.abs(ours)[:3], np.abs(theirs)[:3], rtol=1e-9)


@pytest.mark.parametrize("m", [1e2, 1e6, 1e10])
@pytest.mark.parametrize("law", ["zoh", "backward_difference"])
def test_a_handle_heavier_than_rounding(m, law):
    """b T/m down to 1e-14: its poles differ from 1 by less than cos(theta) shows, and still decide."""
    with mp.workdps(60):
        h, b = mp.mpf(T), mp.mpf("0.12")
        tau = m / b
        a = mp.e ** (-h / tau)
        g1, g0 = (h - tau * (1 - a)) / b, (tau * (1 - a) - a * h) / b
        q2, q1, q0 = g0**2 / 4 + 3 * g0 * g1 / 4, 3 * g0 / 2 - g1 / 2 - g0 * (1 + a) / 2, -(1 - a)
        expected = (1 - a) / g0 if law == "zoh" else (-q1 + mp.sqrt(q1**2 - 4 * q2 * q0)) / (2 * q2)
    limit = stability_limit(paddle(m=m), law=law)
    assert limit.K == pytest.approx(float(expected), rel=1e-6)  # at 1e10 kg damping is 1e-9 of what turns a predicted pole
    assert limit.frequency == pytest.approx(math.sqrt(limit.K / m) / (2 * math.pi), rel=1e-2)


def test_a_heavy_handle_with_a_damper_in_a_hand():
    """Far below the bandwidth (b + b_h + B)/(T/2 + delay) - ... is left: Gil's limit, with the hand's damping beside."""
    p = paddle(m=1e8, delay=1.3 * T, hand=SimpleNamespace(m=0.1, b=1.0, k=0.0))
    expected = (0.12 + 1.0 - 0.5) / (1.8 * T)
    assert stability_limit(p, B=-0.5).K == pytest.approx(expected, rel=1e-6)


def test_an_integrator_in_the_law():
    """F = K (x + (T/tau) sum x) has a pole at z = 1 of its own."""
    tau = 0.5
    scene_law = lambda K: LinearLaw(np.eye(1), np.array([K * T / tau]), np.ones(1), K * (1 + T / tau), T, "PI")  # noqa: E731
    expected = edge(lambda K: ([K * (1 + mp.mpf(T) / tau), -K], [1, -1]), start=20.0)
    assert expected > 30
    p = paddle()
    poles = [np.abs(closed_loop_poles(p, K=expected * s, law=scene_law)).max() for s in (1 - 1e-6, 1 + 1e-6)]
    assert poles[0] < 1 < poles[1]


def test_a_law_that_holds_its_stiffness_has_poles_and_no_limit():
    law = LinearLaw.of("ellis", K=300.0, T=T)
    np.testing.assert_allclose(
        np.abs(closed_loop_poles(paddle(), law=law)), np.abs(closed_loop_poles(paddle(), K=300.0, law="ellis")), rtol=1e-12
    )
    scene = hl.wall(unilateral=None)(k=100, B=0.1)
    with mp.workdps(25):  # the characteristic polynomial by hand, a third pole for the damper's past sample
        h, b, tau = mp.mpf(T), mp.mpf(0.12), mp.mpf(0.045) / mp.mpf(0.12)
        a = mp.e ** (-h / tau)
        g1, g0 = (h - tau * (1 - a)) / b, (tau * (1 - a) - a * h) / b
        expected = mp.polyroots(added([1, -(1 + a), a, 0], product([g1, g0], [100 + 0.1 / h, -0.1 / h])), maxsteps=200)
    for z in closed_loop_poles(paddle(), law=scene):
        assert min(abs(z - complex(one)) for one in expected) < 1e-9
    assert closed_loop_matrix(paddle(), law=scene).shape == (3, 3)
    with pytest.raises(AnalysisError, match="does not depend on a stiffness"):
        stability_limit(paddle(), law=law)


@pytest.mark.parametrize(
    ("law", "K", "words"),
    [
        ("zoh", None, "K = None, and the law contains no stiffness."),
        (hl.wall(unilateral=None), None, "bind it"),
        (lambda K: LinearLaw.of(K=K, T=T), None, "the law contains no stiffness."),
        (hl.wall(unilateral=None)(k=100), 300.0, "K = 300 N/m with zoh wall with k = 100. Leave out K,"),
        (LinearLaw.of(K=100, T=T), 300.0, "has its own stiffness."),
        (hl.laws.virtual_damper()(B=0.1), 300.0, "has no parameter k"),
    ],
)
def test_a_stiffness_given_twice_or_not_at_all_is_refused(law, K, words):
    with pytest.raises(AnalysisError, match=words):
        closed_loop_poles(paddle(), law=law, K=K)


@pytest.mark.parametrize("rise", [1, -1])
@pytest.mark.parametrize("grip", [None, SimpleNamespace(m=0.02, b=0.3, k=120.0)])
def test_a_constant_stiffness_beside_K(rise, grip):
    """(K - 500) x falls over below 500 N/m less the hand's spring, and (500 - K) x above 500 and that: poles by scipy's expm."""
    p, k = paddle(hand=grip), 0.0 if grip is None else grip.k
    law = lambda K: LinearLaw.of(K=rise * (K - 500), T=T)  # noqa: E731

    def stable(K):
        m, b = p.m + (grip.m if grip else 0), p.b + (grip.b if grip else 0)
        E = expm(np.array([[0, 1, 0], [-k / m, -b / m, -1 / m], [0, 0, 0]]) * T)
        return abs(np.linalg.eigvals(E[:2, :2] + np.outer(E[:2, 2], [rise * (K - 500), 0]))).max() < 1

    limit = stability_limit(p, law=law)
    if rise > 0:
        assert limit.K == 0
        low, high = (float(w) for w in limit.reason.split("from ")[1].removesuffix(" N/m").split(" to "))
        assert low == pytest.approx(500 - k, rel=1e-9)
        assert [stable(K) for K in (low - 0.01, low + 0.01, high - 0.01, high + 0.01)] == [False, True, True, False]
    else:
        assert stable(500 + k - 0.01) and not stable(500 + k + 0.01)
        if grip is None:  # 500 N/m is too stiff for the paddle alone; with K it gets stable, and falls over at 500
            assert limit.K == 0 and limit.reason.endswith("to 500 N/m")
        else:
            assert limit.K == pytest.approx(620, rel=1e-12) and limit.frequency == 0.0


def test_falling_over_is_a_limit_at_no_frequency():
    limit = stability_limit(paddle(), law=lambda K: LinearLaw.of(K=100 - K, T=T))
    assert limit.K == pytest.approx(100, rel=1e-12) and limit.frequency == 0.0


def test_a_slow_pole_keeps_its_digits():
    loop = Loop.of(paddle(m=1e10), "zoh")
    w = loop.poles(100.0)
    assert w.imag.max() == pytest.approx(math.sqrt(100.0 / 1e10) * T, rel=1e-7)
    with mp.workdps(60):
        h, b = mp.mpf(T), mp.mpf(0.12)
        a = mp.e ** (-b * h / mp.mpf(1e10))
        beyond = a + 100 * ((mp.mpf(1e10) / b) * (1 - a) - a * h) / b - 1  # the product of the poles, less one
    assert float(2 * w[0].real + abs(w[0]) ** 2) == pytest.approx(float(beyond), rel=1e-5)


@pytest.mark.parametrize(
    ("law", "B", "words"),
    [
        (lambda K: LinearLaw.of("zoh", K=K * K, T=T), 0.0, r"an affine function F0 \+ K F1 of"),
        (lambda K: LinearLaw.of("zoh", K=K, T=2 * T), 0.0, "samples every"),
        (lambda K: 3 * K, 0.0, "gave a float"),
        (hl.wall(), 0.0, "unilateral=None"),
        (hl.wall(unilateral=None), 0.3, "Put the damper into the law"),
        (7, 0.0, "needs one of zoh"),
        (hl.laws.virtual_damper(), 0.0, 'parameter="B"'),
    ],
)
def test_what_is_no_affine_law_is_refused(law, B, words):
    with pytest.raises(AnalysisError, match=words):
        stability_limit(paddle(), law=law, B=B)


def test_another_name_for_the_stiffness():
    K = hl.parameters("stiff", units="N/m")
    scene = hl.Scene(force=K * (2 * hl.x(hl.n) - hl.x(hl.n - 1)))
    law = affine_law(scene, T=T, parameter="stiff")
    assert law.D1[0] == pytest.approx(2.0, rel=1e-12) and law.D0[0] == 0
    expected = edge(lambda k: ([2 * k, -k], [1, 0]))
    assert stability_limit(paddle(), law=scene, parameter="stiff").K == pytest.approx(expected, rel=1e-8)


def test_a_stiffness_below_which_there_is_no_stability():
    """2 x[n] - x[n-1] looks a whole period ahead: K T of damping less the hold's K T/2, against B = -(b + 0.01)."""
    B = -0.12 - 0.01
    law = lambda K: LinearLaw.of_taps([2 * K + B / T, -K - B / T], T=T)  # noqa: E731
    limit = stability_limit(paddle(), law=law)
    assert limit.K == 0 and "unstable at the smallest stiffness; stable again from" in limit.reason
    low, high = (float(word) for word in limit.reason.split("from ")[1].removesuffix(" N/m").split(" to "))
    assert low == pytest.approx(0.01 * 2 / T, rel=0.01)  # K T/2 pays for what B lacks, but for terms of b T/m

    def stable(K):
        return abs(closed_loop_poles(paddle(), law=law(K))).max() < 1

    assert [stable(K) for K in (low * 0.999, low * 1.001, high * 0.999, high * 1.001)] == [False, True, True, False]


@pytest.mark.parametrize("B", [-0.1201, -1.0, 2 * 0.045 / T * 1.01])
@pytest.mark.parametrize("law", ["zoh", "backward_difference", "ellis"])
def test_dampers_that_no_stiffness_saves(law, B):
    """Less than -b feeds a slow handle, more than 2 m/T flips it from sample to sample: at K = 0+, and at every other K."""
    limit = stability_limit(paddle(), law=law, B=B)
    assert limit.K == 0
    for K in np.geomspace(1e-3, 1e5, 30):
        inside = abs(closed_loop_poles(paddle(), K=K, law=law, B=B)[0]) < 1
        assert not inside or "stable again" in limit.reason


@pytest.mark.parametrize("velocity", [hl.velocity.filtered(tau="3 ms"), hl.velocity.kalman(acceleration=50, noise=1e-5)])
def test_estimated_velocities(velocity):
    """The limit of a wall with an estimator, against poles of the compiled tick beside the plant by scipy's cont2discrete."""
    from scipy.signal import cont2discrete

    p = paddle(m=0.05, b=0.1, hand=SimpleNamespace(m=0.02, b=0.3, k=50.0), velocity="backward_difference")
    scene = hl.wall("half_sample", unilateral=None, velocity=velocity)(B=0.05)
    limit = stability_limit(p, law=scene)
    plant = (np.array([[0, 1], [-50 / 0.07, -0.4 / 0.07]]), np.array([[0], [1 / 0.07]]), np.eye(2), np.zeros((2, 1)))
    Phi, Gamma, *_ = cont2discrete(plant, T)
    radius = []
    for K in limit.K * np.array([1 - 1e-6, 1 + 1e-6]):
        law = LinearLaw.of_scene(scene(k=K), T=T)
        x = np.array([1.0, 0.0])
        top = np.hstack([Phi - Gamma @ (law.D * x)[None, :], -Gamma @ law.C[None, :]])
        whole = np.vstack([top, np.hstack([np.outer(law.B, x), law.A])])
        radius.append(np.abs(np.linalg.eigvals(whole)).max())
    assert radius[0] < 1 < radius[1]


@pytest.mark.parametrize("m", [0.045, 1e5])
@pytest.mark.parametrize("late", [1, 8, 40])
def test_a_delay_in_the_law_is_a_delay_of_the_paddle(late, m):
    law = lambda K: LinearLaw.of_taps([0.0] * late + [K], T=T)  # noqa: E731
    one, other = stability_limit(paddle(m=m), law=law), stability_limit(paddle(m=m, delay=late * T))
    assert one.K == pytest.approx(other.K, rel=1e-12) and one.frequency == pytest.approx(other.frequency, rel=1e-12)


def test_a_law_of_too_many_samples_is_refused_not_guessed():
    weights = np.random.default_rng(0).uniform(size=80)
    with pytest.raises(AnalysisError, match="79 states, too many for an accurate characteristic polynomial"):
        stability_limit(paddle(), law=lambda K: LinearLaw.of_taps(K * weights / weights.sum(), T=T))


def test_random_plants():
    """b T/m from 1e-9 to 30, hands, delays, dampers of either sign: no pole is outside below the limit, one is above it."""
    rng = np.random.default_rng(5)
    finite = 0
    for _ in range(60):
        period, m = 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(-3, 3)
        b = 10 ** rng.uniform(-9, 1.5) * m / period
        grip = SimpleNamespace(m=rng.uniform(0, 2) * m, b=rng.uniform(0, 3) * b, k=10 ** rng.uniform(-8, 0) * m / period**2)
        delay = rng.choice([0.0, period, rng.uniform(0, 3) * period, int(rng.integers(0, 30)) * period])
        p = hl.Device(m=m, b=b, T=period, delay=delay, hand=rng.choice([None, grip]), velocity="measured")
        B = rng.choice([0.0, rng.uniform(-1.5, 5) * b, rng.uniform(0, 2.5) * m / period])
        law = rng.choice(["zoh", "half_sample", "backward_difference", "ellis"])
        limit = stability_limit(p, law=law, B=B)
        if 0 < limit.K < math.inf:
            radius = [abs(closed_loop_poles(p, K=limit.K * s, law=law, B=B)[0]) for s in (0.01, 0.3, 0.9, 0.999, 1.001)]
            assert max(radius[:-1]) <= 1 + 1e-13 and radius[-1] > 1 - 1e-13  # b T/m = 1e-9 moves a pole by 1e-12 here
            finite += 1
    assert finite > 35
