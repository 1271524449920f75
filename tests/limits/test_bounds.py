"""The bounds by name: against their formulas' numbers, the exact limits, energies of whole cycles, and simulated walls."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.limits.bounds import abbott_okamura_limit, bounds, diolaiti, diolaiti_limit, gil_limit
from hapticlab.limits.limit import Limit

b, T, M = 0.1, 1e-3, 0.05
SPRING = hl.wall(unilateral=None)


def paddle(**values):
    return hl.SimulatedPaddle(**{"m": M, "b": b, "T": T, **values})


@pytest.mark.parametrize(("coulomb", "resolution"), [(0.02, 0.3e-3), (0.05, 0.1e-3), (0.004, 0.5e-3)])
def test_abbott_and_okamura_is_where_no_alternation_across_counts_draws_energy(coulomb, resolution):
    """Back and forth by D across j thresholds of the encoder: -K j Delta D + 2 b D^2/T + 2 f_c D, D >= (j-1) Delta.

    Two samples a cycle, the quickest motion there is; the least over j and D of what it costs is zero at the bound.
    """
    K = abbott_okamura_limit(hl.Device(b=b, T=T, coulomb=coulomb, counts_per_metre=1 / resolution)).K

    def cheapest(K):
        j = np.arange(1, 2000)[:, None]
        D = (j - 1 + np.geomspace(1e-6, 5, 400)) * resolution
        return (-K * j * resolution + 2 * b * D / T + 2 * coulomb).min()  # over D

    assert cheapest(K * (1 - 1e-9)) > -1e-9
    assert cheapest(K * 1.005) < 0


def test_a_bound_without_an_encoder_is_the_holds():
    assert abbott_okamura_limit(hl.Device(b=b, T=T)).K == 200 == hl.passivity_limit(hl.Device(b=b, T=T)).K
    assert abbott_okamura_limit(hl.Device(b=b, T=T, counts_per_metre=1 / 1e-4)).K == 0  # no friction: an encoder alone buzzes
    assert (
        "that the encoder generates" in abbott_okamura_limit(hl.Device(b=b, T=T, coulomb=0.001, counts_per_metre=1 / 1e-4)).reason
    )


@pytest.mark.parametrize("periods", [0, 1, 3])
def test_diolaiti_is_exact_for_whole_delays(periods):
    exact = hl.passivity_limit(hl.Device(b=b, T=T, delay=periods * T)).K
    assert diolaiti_limit(hl.Device(b=b, T=T, delay=periods * T)).K == pytest.approx(exact, rel=1e-12)


def test_diolaiti_is_up_to_eight_percent_too_high_between():
    """1 against (1 + sqrt(1 + f (1-f)/(1/2+f)^2))/2: moving faster before the force changes pays; most at a quarter."""
    delays = T * np.arange(0.05, 1, 0.05)
    ratio = [
        diolaiti_limit(hl.Device(b=b, T=T, delay=late)).K / hl.passivity_limit(hl.Device(b=b, T=T, delay=late)).K
        for late in delays
    ]
    assert min(ratio) > 1.005 and ratio[9] == pytest.approx((1 + 1.25**0.5) / 2, rel=1e-9)
    assert max(ratio) == ratio[4] == pytest.approx((1 + (4 / 3) ** 0.5) / 2, rel=1e-9)


def test_gil_is_near_the_exact_limit_where_it_does_not_refuse():
    generator, kept, errors = np.random.default_rng(0), 0, []
    for _ in range(40):
        damper = 10 ** generator.uniform(-2, 0.5)
        hand = hl.Hand(m=0.05, b=10 ** generator.uniform(-2, 0.5), k=10 ** generator.uniform(0, 3))
        plant = paddle(
            m=10 ** generator.uniform(-2, -0.5), b=damper, T=10 ** generator.uniform(-4, -2.5),
            delay=10 ** generator.uniform(-5, -3), hand=hand if generator.random() < 0.5 else None,
        )  # fmt: skip
        B = damper * generator.uniform(-0.5, 3)
        try:
            limit = gil_limit(plant, B=B)
        except AnalysisError:  # damping is not low here
            continue
        kept += 1
        errors.append(abs(limit.K / hl.stability_limit(plant, B=B).K - 1))
        assert errors[-1] < float(limit.assumptions[0].split("up to ")[1].split(" %")[0]) / 100 + 1e-9  # as it says
    assert kept > 15 and max(errors) < 0.18
    assert gil_limit(paddle(m=5.0)).K == pytest.approx(hl.stability_limit(paddle(m=5.0)).K, rel=1e-5)  # slow: exact
    exact = hl.stability_limit(paddle(m=5.0), B=0.05)
    assert gil_limit(paddle(m=5.0), B=0.05).frequency == pytest.approx(exact.frequency, rel=1e-3)


def test_gil_refuses_where_it_would_promise_too_much():
    """Heavily damped or virtually damped: the formula is above the exact limit, and not by little."""
    light = paddle(m=0.005, b=2.0)
    assert (2.0 + 5.0) / (T / 2) > 1.2 * hl.stability_limit(light, B=5.0).K
    with pytest.raises(AnalysisError, match="needs at most 0.1"):
        gil_limit(light, B=5.0)


@pytest.mark.parametrize("law", ["half_sample", "backward_difference", "ellis"])
def test_a_law_that_is_none_of_theirs(law):
    words = "not a position law" if law == "half_sample" else "predicts from past samples"
    for ask in (
        lambda: abbott_okamura_limit(hl.Device(b=b, T=T), law=law), lambda: diolaiti_limit(hl.Device(b=b, T=T), law=law),
        lambda: gil_limit(paddle(), law=law),
    ):  # fmt: skip
        with pytest.raises(AnalysisError, match=words):
            ask()


def test_assumptions_that_fail():
    with pytest.raises(AnalysisError, match="without B"):
        abbott_okamura_limit(hl.Device(b=b, T=T), B=0.1)
    with pytest.raises(AnalysisError, match="without delay"):
        abbott_okamura_limit(hl.Device(b=b, T=T, delay=1e-3))
    with pytest.raises(AnalysisError, match="without virtual damping"):
        diolaiti_limit(hl.Device(b=b, T=T), B=-0.1)
    with pytest.raises(PaddleError, match="coulomb = -1"):
        abbott_okamura_limit(hl.Device(b=b, T=T, coulomb=-1))
    for ask in (bounds, gil_limit):
        with pytest.raises(AnalysisError, match="a str has no m; needs a paddle"):
            ask("paddle")


def test_all_of_them_on_one_paddle():
    found = bounds(paddle(coulomb=0.01, counts_per_metre=1e4, delay=0.5e-3))
    assert [name for name, limit in found.found.items() if isinstance(limit, str)] == ["Abbott, Okamura"]
    assert found["Diolaiti"].K == 100 == found["Gil"].K
    assert found["exact stability"].kind.startswith("exact linear stability") and found["Colgate, Schenkel"].K < 100
    kinds = [limit.kind.split()[0].strip(":") for limit in found.found.values() if isinstance(limit, Limit)]
    assert kinds == ["passivity", "for", "stability", "exact"]  # Diolaiti: half a period late
    assert "does not apply: delay = 0.0005 s" in str(found)
    assert "not passivity" in found["Diolaiti"].kind and "8 %" in found["Diolaiti"].assumptions[-1]
    assert diolaiti_limit(hl.Device(b=b, T=T, delay=T)).kind.startswith("passivity")
    half = bounds(paddle(), law="half_sample")
    assert half["Colgate, Schenkel"].K == 0 and half["exact stability"].K > 0
    axes = found.plot().axes[0]
    assert len(axes.patches) == 4 and "N/m" in axes.get_xlabel()


def test_gil_refuses_where_a_negative_damper_takes_nearly_all_of_b():
    """What the formula leaves out is an amount, and stays while b + B goes to zero: 62 % off at B = -0.99 b."""
    plant = paddle(b=0.5, hand=hl.Hand(m=0.02, b=1e-4, k=2000))
    for B in (-0.495, -0.4995, -0.6):
        with pytest.raises(AnalysisError, match=r"\(b \+ \|B\|\)/\(b \+ B\) = "):
            gil_limit(plant, B=B)
    assert gil_limit(plant, B=-0.1).K == pytest.approx(hl.stability_limit(plant, B=-0.1).K, rel=0.027)


def test_an_estimated_velocity_is_one_in_every_row():
    """Eq. (23.3) on an encoder is Eq. (23.5): passivity from its taps by hand, b/(K T) = 1 at Nyquist."""
    estimated = bounds(paddle(counts_per_metre=5e4, coulomb=0.02), law="half_sample")
    assert estimated["Colgate, Schenkel"].K == pytest.approx(b / T, rel=1e-9) and estimated.law == "backward_difference"
    exact = hl.stability_limit(paddle(), law="backward_difference").K
    assert estimated["exact stability"].K == pytest.approx(exact, rel=1e-9)


def amplitudes(K, b, coulomb, start, counts=None, delay=0.0):
    """Peak |x| in the first and in the last tenth of two seconds in the spring."""
    pytest.importorskip("llvmlite")  # two seconds each on the interpreter
    paddle = hl.SimulatedPaddle(m=M, b=b, T=T, coulomb=coulomb, counts_per_metre=counts, delay=delay)
    log = paddle.run(SPRING(k=K, x_o=0), duration=2.0, x=start, progress=False)
    x = np.abs(log.channels.get("x_true", log.x))
    return x[: len(x) // 10].max(), x[-len(x) // 10 :].max()


@pytest.mark.parametrize(("K", "delay"), [(230.0, 0.0), (300.0, 0.0), (130.0, 0.5e-3)])
def test_a_locally_stable_wall_grows_above_its_amplitude_alone(K, delay):
    """The describing function is exact for slow cycles: w T is below 0.08 here."""
    point = diolaiti(hl.Device(m=M, b=0.1, T=T, delay=delay, coulomb=0.01), K=K)
    assert point.region.startswith("locally stable") and point.sigma == np.inf
    for factor, grows in ((0.9, False), (1.1, True)):
        first, last = amplitudes(K, 0.1, 0.01, factor * point.amplitude, delay=delay)
        assert last > 1.02 * first if grows else last < 0.98 * first


def test_diolaitis_regions_of_a_quantised_wall():
    """A fine and a coarse friction, beside a soft and a stiff spring; a count of 0.2 mm, motion from 20 counts."""
    resolution, start = 0.2e-3, 4e-3
    kinds = {}
    for K, coulomb in ((150, 0.02), (150, 0.002), (400, 0.002)):
        point = diolaiti(hl.Device(m=M, b=0.1, T=T, coulomb=coulomb, counts_per_metre=1 / resolution), K=K)
        kinds[point.region.split(":")[0]] = amplitudes(K, 0.1, coulomb, start, counts=1 / resolution)
    assert list(kinds) == ["passive", "limit cycles", "unstable"]
    assert kinds["passive"][1] < 1.1 * resolution + 0.02 / 150
    assert kinds["limit cycles"][1] < 0.5 * start
    assert kinds["unstable"][1] > 2 * start


def test_diolaitis_plane_in_numbers_words_and_a_picture():
    point = diolaiti(hl.Device(m=M, b=0.1, T=T, delay=T / 4, coulomb=0.05, counts_per_metre=1 / 0.2e-3), K=300)
    assert (point.beta, point.sigma, point.tau) == pytest.approx((1 / 3, 5 / 6, 0.25))
    assert point.amplitude == pytest.approx(4 * 0.05 / (np.pi * (300 / M) ** 0.5 * (300 * 0.75e-3 - 0.1)), rel=1e-12)
    axes = point.plot().axes[0]
    assert {text.get_text() for text in axes.texts} == {"passive", "limit cycles", "locally stable", "unstable"}
    assert (
        np.isnan(diolaiti(hl.Device(b=0.1, T=T), K=300).amplitude) and diolaiti(hl.Device(b=0.1, T=T), K=100).amplitude == np.inf
    )
    for mass in (-1, 0):
        with pytest.raises(PaddleError, match="m = .* a device needs m > 0"):
            diolaiti(hl.Device(m=mass, b=0.1, T=T), K=300)
    with pytest.raises(AnalysisError, match="needs K > 0"):
        diolaiti(hl.Device(b=0.1, T=T), K=0)


def test_diolaitis_region_is_called_passive_only_where_every_motion_is_paid_for():
    """Half a period late: passive to 94.43 N/m, slow sinusoids to 100 N/m; energy of an alternating cycle by hand."""
    words = {K: diolaiti(hl.Device(m=M, b=0.1, T=T, delay=T / 2), K=K).region for K in (94, 98)}
    assert words[94].startswith("passive") and "not passive" in words[98]
    assert diolaiti(hl.Device(b=0.1, T=T, delay=T), K=66).region.startswith("passive")
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


@pytest.mark.parametrize(("K", "coulomb", "delay"), [(333.0, 0.02, 0.0), (300.0, 0.01, 0.0), (130.0, 0.005, 0.5e-3)])
def test_friction_that_is_too_weak_for_a_count_still_stops_motions_of_many(K, coulomb, delay):
    """The describing function again, over 4 counts at least. In two seconds a smaller swing has lost a quarter or more."""
    count = coulomb / (0.3 * K)
    point = diolaiti(hl.Device(m=M, b=0.1, T=T, delay=delay, coulomb=coulomb, counts_per_metre=1 / count), K=K)
    assert point.sigma == pytest.approx(0.3) and point.amplitude > 4 * count
    assert "die away to rest or to a buzz" in str(point) and f"above {1e3 * point.amplitude:.4g} mm grow" in str(point)
    for factor, grows in ((0.7, False), (1.25, True)):
        start = factor * point.amplitude
        _, last = amplitudes(K, 0.1, coulomb, start, counts=1 / count, delay=delay)
        assert last > 1.1 * start if grows else last < 0.75 * start


def test_a_swing_of_3_mm_dies_to_less_than_a_count_where_both_conditions_fail():
    """beta = sigma = 0.3: 4.69 mm is the threshold, a count 0.2 mm."""
    paddle = hl.SimulatedPaddle(m=M, b=0.1, T=T, coulomb=0.02, counts_per_metre=5000)
    assert 4.6e-3 < diolaiti(paddle, K=333).amplitude < 4.8e-3
    log = paddle.run(SPRING(k=333, x_o=0), duration=3.0, x=3e-3, progress=False)
    assert np.abs(log.x_true[-300:]).max() < 0.2e-3


def test_where_an_amplitude_is_less_than_a_few_counts_all_motions_grow():
    point = diolaiti(hl.Device(m=M, b=0.1, T=T, coulomb=0.001, counts_per_metre=1 / 0.2e-3), K=300)
    assert point.amplitude < 4 * 0.2e-3 and point.region == "unstable: small and large motions grow"
    assert diolaiti(hl.Device(m=M, b=0.1, T=T, counts_per_metre=1e4), K=300).amplitude == 0
    assert diolaiti(hl.Device(b=0.1, T=T, coulomb=0.01, counts_per_metre=1e4), K=300).region.startswith("unstable for large")
