"""What a law asks of the device: against polynomials, against the energy of whole motions, against closed forms."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.limits.colgate import equivalent_damper, largest_passive_stiffness, passivity_margin, wall_damping
from hapticlab.limits.linear_law import LinearLaw
from hapticlab.limits.passivity import required_damping
from hapticlab.limits.port import asked

T = 1e-3


@pytest.mark.parametrize("law", ["zoh", "backward_difference", "ellis"])
@pytest.mark.parametrize(("B", "delay"), [(0.0, 0.0), (0.04, 1.0), (-0.03, 0.4), (0.02, 2.7)])
def test_laws_of_finite_memory_against_the_roots_of_a_polynomial(law, B, delay):
    """Two algorithms that share no line: a search over frequencies, and stationary points by Chebyshev roots."""
    margin = passivity_margin(hl.Device(b=0.2, delay=delay * T), LinearLaw.of(law, K=90, T=T, B=B))
    assert margin.required == pytest.approx(required_damping(K=90, T=T, B=B, delay=delay * T, law=law), rel=1e-9)
    assert margin.passive == (margin.required <= 0.2) and margin.margin == 0.2 - margin.required


def asked_by_energy(law, periods):
    """Least b with which no motion of so many periods, repeated, draws energy: eigenvalues, no frequency.

    Force on displacement and damping on displacement are two quadratic forms of the positions at the samples.
    """
    shift = np.roll(np.eye(periods), 1, axis=1).T  # row n: x[n-1]
    n = len(law.A)
    # the periodic answer of the state s+ = A s + B x, all samples in one system
    state = np.linalg.solve(np.eye(n * periods) - np.kron(shift, law.A), np.kron(shift, law.B[:, None])) if n else None
    force = law.D * np.eye(periods) + (np.kron(np.eye(periods), law.C[None, :]) @ state if n else 0.0)
    step = shift.T - np.eye(periods)  # x[n+1] - x[n]
    work, cost = step.T @ force, step.T @ step
    moving = np.linalg.svd(step)[2][:-1].T  # without the rigid shift
    values = np.linalg.eigvals(np.linalg.solve(moving.T @ cost @ moving, moving.T @ (work + work.T) @ moving / 2))
    return -values.real.min() * law.T


@pytest.mark.parametrize(("B", "tau"), [(0.5, 2e-3), (0.3, 0.0), (1.2, 0.4e-3)])
def test_a_filtered_velocity_against_the_energy_of_every_motion(B, tau):
    """At Nyquist, which an even number of samples can move at, the closed form is met and not only neared."""
    law = LinearLaw.of("zoh", K=150, T=T, B=B, velocity_filter=tau)
    expected = wall_damping(hl.Device(T=T), K=150, B=B, velocity_filter=tau)
    assert expected == pytest.approx(150 * T / 2 + B / (1 + 2 * tau / T), rel=1e-15)
    assert asked_by_energy(law, 40) == pytest.approx(expected, rel=1e-10)
    assert passivity_margin(hl.Device(b=1.0), law).required == pytest.approx(expected, rel=1e-10)


def test_motions_ask_for_no_more_than_the_worst_frequency():
    law = LinearLaw.of("ellis", K=150, T=T, B=-0.4, velocity_filter=1.7e-3, filtered=True)
    theta = 2 * np.pi * np.arange(1, 17) / 32
    margin = passivity_margin(hl.Device(b=1.0), law)
    assert asked_by_energy(law, 32) == pytest.approx(margin.asked(theta).max(), rel=1e-9)
    assert asked_by_energy(law, 32) <= margin.required * (1 + 1e-9)


@pytest.mark.parametrize("tau", [0.0, 1e-3, 8e-3])
@pytest.mark.parametrize("B", [0.06, -0.06])
def test_largest_stiffness_with_a_filtered_velocity(B, tau):
    """A filter buys back part of what a positive damper asks for, and nothing of what a negative one does."""
    K, hertz = largest_passive_stiffness(lambda K: LinearLaw.of("zoh", K=K, T=T, B=B, velocity_filter=tau), b=0.1)
    expected = 2 / T * (0.1 - (B / (1 + 2 * tau / T) if B > 0 else -B))
    assert K == pytest.approx(expected, rel=1e-7)  # slow motion is looked at down to w T = 1e-5
    assert hertz == pytest.approx(500 if B > 0 else 0, abs=0.1)
    limit = hl.passivity_limit(hl.Device(b=0.1, T=T), B=B, velocity_filter=tau)
    assert limit.K == pytest.approx(expected, rel=1e-7) and ("filtered" in limit.reason) == (tau > 0)


def test_largest_stiffness_with_a_fraction_of_delay_is_its_own_inverse():
    def law(K):
        return LinearLaw.of("ellis", K=K, T=T, B=0.03, velocity_filter=2e-3)

    K, _ = largest_passive_stiffness(law, b=0.1, delay=0.6e-3)
    assert passivity_margin(hl.Device(b=0.1, delay=0.6e-3), law(K)).required == pytest.approx(0.1, rel=1e-9)
    assert largest_passive_stiffness(lambda K: LinearLaw.of("zoh", K=K, B=0.3, T=T), b=0.1)[0] == 0.0
    with pytest.raises(AnalysisError, match="does not grow with K"):
        largest_passive_stiffness(lambda K: LinearLaw.of("zoh", K=0, B=K / 1000, T=T), b=0.1)


@pytest.mark.parametrize("delay", [0.0, 0.5, 1.0])
def test_a_constant_negative_stiffness_beside_K(delay):
    """A spring of K - 500: its own limit, 500 higher, and passive only where the sum is not negative."""
    law = lambda K: LinearLaw.of(K=K - 500, T=T)  # noqa: E731
    k, c = hl.parameters("k", units="N/m"), hl.parameters("c", units="N/m", values=500)
    alone = hl.passivity_limit(hl.Device(b=0.1, T=T, delay=delay * T)).K  # 200, 94.4, 66.7: closed forms
    for given, name in ((law, "law"), (hl.Scene(force=(k - c) * hl.x(hl.n), name="detent"), "detent")):
        limit = hl.passivity_limit(hl.Device(b=0.1, T=T, delay=delay * T), law=given)
        assert limit.K == pytest.approx(500 + alone, rel=1e-9)
        assert limit.reason.endswith(
            f"{name}, passive only above K = 500 N/m, because below it the stiffness at rest is negative"
        )
    found = [passivity_margin(hl.Device(b=0.1, delay=delay * T), law(K)).passive for K in (500.0, 499.9 + alone, 500.1 + alone)]
    assert found == [True, True, False]
    with pytest.raises(AnalysisError, match="negative stiffness, -1 N/m"):
        passivity_margin(hl.Device(b=0.1), law(499.0))
    assert asked_by_energy(law(400.0), 40) < 0 < asked_by_energy(law(690.0), 40) < 0.1  # frequencies alone do not see it


def test_a_filter_of_the_velocity_is_for_named_laws():
    wall = hl.wall(unilateral=None)(B=0.05)
    with pytest.raises(AnalysisError, match="velocity_filter = 0.004 s with a law of your own;"):
        hl.passivity_limit(hl.Device(b=0.1, T=T), law=wall, velocity_filter=4e-3)
    for wrong in (-4e-3, float("nan"), "x"):
        with pytest.raises(AnalysisError, match=f"velocity_filter = {wrong!r}.*needs a time constant >= 0"):
            hl.passivity_limit(hl.Device(b=0.1, T=T), velocity_filter=wrong)
    inside = hl.wall(velocity=hl.velocity.filtered(tau=4e-3), unilateral=None)(B=0.05)  # what the refusal says to do
    expected = 2 / T * (0.1 - 0.05 / (1 + 2 * 4e-3 / T))
    assert hl.passivity_limit(hl.Device(b=0.1, T=T), law=inside).K == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("law", "delay"), [("zoh", 0.0), ("zoh", 1.0), ("zoh", 0.5), ("backward_difference", 2.3)])
def test_the_end_of_the_search_is_no_frequency(law, delay):
    """Slow motion decides, or all frequencies alike: said by the margin as by the limit, of a name as of a scene."""
    flat = delay == 0
    margin = passivity_margin(hl.Device(b=0.1, delay=delay * T), LinearLaw.of(law, K=100, T=T))
    assert margin.frequency == 0.0 and margin.flat == flat
    words = "at every frequency alike" if flat else "for slow motion"
    assert f"N s/m, {words}; the device" in str(margin)
    for given in (law, hl.wall(law, unilateral=None), lambda K: LinearLaw.of(law, K=K, T=T)):
        limit = hl.passivity_limit(hl.Device(b=0.1, T=T, delay=delay * T), law=given)
        assert limit.frequency == (None if flat else 0.0)
        assert ("all frequencies alike" if flat else "worst for slow motion") in limit.reason
    assert not passivity_margin(hl.Device(b=0.1), LinearLaw.of("ellis", K=100, T=T)).flat


@pytest.mark.parametrize("delay", [0, 2])
def test_every_law_asks_for_the_same_on_average(delay):
    """K T/2, the plain spring's own: the mean of Dirichlet's kernels. Random laws with memories and poles of all kinds."""
    generator, theta = np.random.default_rng(1), np.pi * (np.arange(4000) + 0.5) / 4000
    for _ in range(10):
        n = generator.integers(1, 6)
        A = generator.normal(size=(n, n))
        A *= generator.uniform(0.2, 0.97) / abs(np.linalg.eigvals(A)).max()
        law = LinearLaw(A, *generator.normal(size=(2, n)), generator.normal(), T, "random")
        mean = asked(law.A, law.B, law.C, law.D, T, theta, delay * T).mean()  # the midpoint rule converges geometrically
        assert mean == pytest.approx(law.stiffness * T / 2, rel=1e-9, abs=1e-12)


def test_a_scene_of_ones_own():
    """Eq. (23.8) around spring and damper, 4 B and 2 K T of it at Nyquist; a named law as a scene; an exact velocity."""
    wall = hl.Scene(force=hl.laws.force_filter(hl.wall(unilateral=None)(B=0.01, x_o=0)).force, values={"B": 0.01, "x_o": 0})
    assert hl.passivity_limit(hl.Device(b=0.1, T=T), law=wall).K == pytest.approx((0.1 - 4 * 0.01) / (2 * T), rel=1e-9)
    for law in ("zoh", "backward_difference", "ellis"):
        limit = hl.passivity_limit(hl.Device(b=0.1, T=T, delay=0.4 * T), law=hl.wall(law, unilateral=None)(x_o=0))
        assert limit.K == pytest.approx(hl.passivity_limit(hl.Device(b=0.1, T=T, delay=0.4 * T), law=law).K, rel=1e-8)
    assert hl.passivity_limit(hl.Device(b=0.1, T=T), law=lambda K: LinearLaw.of("zoh", K=K, T=T)).K == pytest.approx(
        200, rel=1e-9
    )
    assert "nothing dissipates the energy that the hold generates" in hl.passivity_limit(hl.Device(b=0.0, T=T), law=wall).reason
    unstable = lambda K: LinearLaw(np.diag([1.1]), np.ones(1), np.array([K]), K, T, "runs off")  # noqa: E731
    with pytest.raises(AnalysisError, match="unstable with the handle held"):
        hl.passivity_limit(hl.Device(b=0.1, T=T), law=unstable)


@pytest.mark.parametrize("law", [LinearLaw.of("ellis", K=150, T=T), LinearLaw.of("zoh", K=20, T=T, B=1, velocity_filter=3e-3)])
@pytest.mark.parametrize("cycles", [3, 17, 45])
def test_a_sinusoid_feels_the_equivalent_damper(law, cycles):
    """The work of the held force over 64 samples and whole cycles, past Nyquist too, against b (x')^2 summed."""
    theta, samples = 2 * np.pi * cycles / 64, np.arange(64)
    force = np.zeros(64)
    response, past = law.impulse(4000), np.arange(4000)  # the filter has forgotten by then
    for k in samples:
        force[k] = response @ np.cos(theta * (k - past) + 0.3)
    x = np.cos(theta * np.arange(65) + 0.3)
    damper = force @ np.diff(x) / (64 * T * (theta / T) ** 2 / 2)
    assert equivalent_damper(hl.Device(), law, theta) == pytest.approx(damper, rel=1e-9)


def test_equivalent_dampers_of_the_chapter():
    """Ellis and Sarkar's law dissipates below a quarter of the sampling rate and makes energy above, Eq. (23.7)."""
    theta = np.linspace(0.05, np.pi, 30)
    rise = (1 - np.cos(theta)) / theta**2
    closed = {
        "zoh": -rise, "backward_difference": -rise * (1 - np.cos(theta)),
        "ellis": 2 * rise * np.cos(theta) * (1 - np.cos(theta)),
    }  # fmt: skip
    for law, expected in closed.items():
        found = equivalent_damper(hl.Device(), LinearLaw.of(law, K=100, T=T), theta)
        assert found == pytest.approx(100 * T * expected, abs=1e-12), law


def test_refusals_and_words():
    with pytest.raises(AnalysisError, match="negative stiffness, -50 N/m"):
        passivity_margin(hl.Device(b=1.0), LinearLaw.of("zoh", K=-50, T=T))
    unstable = LinearLaw(np.diag([1.1]), np.ones(1), np.ones(1), 500.0, T, "runs off")
    with pytest.raises(AnalysisError, match=r"runs off: unstable with the handle held \(a pole at 1.1\)"):
        passivity_margin(hl.Device(b=1.0), unstable)
    with pytest.raises(AnalysisError, match="needs a LinearLaw"):
        passivity_margin(hl.Device(b=1.0), "zoh")
    with pytest.raises(PaddleError, match="b = -1"):
        passivity_margin(hl.Device(b=-1.0), LinearLaw.of("zoh", K=50, T=T))
    with pytest.raises(AnalysisError, match="at most 200 periods"):
        passivity_margin(hl.Device(b=1.0, delay=1.0), LinearLaw.of("zoh", K=50, T=T))
    short = passivity_margin(hl.Device(b=0.06), LinearLaw.of("zoh", K=100, T=T, B=0.02))
    assert str(short) == (
        "zoh, K = 100 N/m, B = 0.02 N s/m: not passive. It needs b = 0.07 N s/m, at 500 Hz; "
        "the device has 0.06 N s/m, 0.01 too little"
    )
    assert "passive in every passive hand" in str(passivity_margin(hl.Device(b=0.06), LinearLaw.of("zoh", K=100, T=T)))


def test_plot_shows_the_worst_frequency_and_the_device():
    axes = passivity_margin(hl.Device(b=0.06), LinearLaw.of("backward_difference", K=100, T=T)).plot().axes[0]
    asked, sinusoid, device, worst = axes.lines
    assert asked.get_ydata().max() == pytest.approx(0.1, rel=1e-6) == worst.get_ydata()[0]
    assert device.get_ydata()[0] == 0.06 and sinusoid.get_ydata().max() < 0.1
    assert "Hz" in axes.get_xlabel() and "N s/m" in axes.get_ylabel()


def drawn(positions, taps, late=0):
    """Return b/(K T) at which a cycle of positions through a gated law breaks even; the force comes late samples later."""
    x = np.asarray(positions, dtype=float)
    force = np.where(x >= 0, sum(c * np.roll(x, k) for k, c in enumerate(taps)), 0.0)
    steps = np.roll(x, -1) - x
    return -np.roll(force, late) @ steps / (steps @ steps)


def test_the_plain_wall_pays_at_its_boundary_too():
    """Random walks across the boundary: work and b = K T/2 never fall short of the energy K max(x, 0)^2/2 stored."""
    walks = np.cumsum(np.random.default_rng(7).standard_t(2, size=(200, 500)), axis=1)
    inside, steps = np.maximum(walks, 0), np.diff(walks, axis=1)
    paid = np.cumsum(inside[:, :-1] * steps + steps**2 / 2, axis=1)
    stored = (inside[:, 1:] ** 2 - inside[:, :1] ** 2) / 2
    assert np.all(paid - stored >= -1e-9 * np.abs(paid).max())
    assert drawn([1.0, 3.0], [1]) == pytest.approx(0.5)  # and to and fro inside draws all of it


def test_a_gated_ellis_law_with_a_delay_draws_more_than_the_condition_knows():
    """Why a limit of a law with a memory says nothing about switching: a cycle of four samples, one of them just outside."""
    cycle = [-1e-9, 0.7865, 1.0, 0.1739]
    assert drawn(cycle, [2, -1.5, 0.5], late=1) == pytest.approx(1.533097, abs=2e-6)
    assert required_damping(K=1 / T, T=T, delay=T, law="ellis") == pytest.approx(1.528153, abs=1e-6)
