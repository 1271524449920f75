"""Couplers against closed forms, Colgate's condition with random passive environments, and whole closed loops."""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

import hapticlab as hl
from hapticlab import t
from hapticlab.analysis.stability.passive_hands import network, radii
from hapticlab.errors import AnalysisError
from hapticlab.limits.coupler import coupler_design, impedance_display
from hapticlab.limits.passivity import required_damping

T, b = 1e-3, 0.2


def paddle(delay=0.0, b=b):
    return hl.SimulatedPaddle(m=0.05, b=b, T=T, delay=delay * T)


@pytest.mark.parametrize("b_c", [0.0, 0.03, 0.11, 0.2])
@pytest.mark.always("0.0", "0.11")
def test_without_delay_it_is_eq_23_10(b_c):
    """Adams and Hannaford's couple alone: k_c < 2 (b - b_c)/T; nothing that hangs on it asks for more."""
    assert coupler_design(paddle(), b_c=b_c).k_c == pytest.approx(2 * (b - b_c) / T, rel=1e-9, abs=1e-9)
    assert coupler_design(paddle()).k_c == pytest.approx(2 * b / T, rel=1e-9)
    assert coupler_design(paddle()).frequency is None and "by all frequencies alike" in str(coupler_design(paddle()))


def stiffest(b_c, periods):
    """The same border by brute force: whole delays, every frequency, bisection in k_c on Llewellyn's own expression."""
    theta = np.linspace(1e-3, np.pi, 6001)
    need = (1 - np.cos((periods + 1) * theta)) / (2 * b)
    low, high = 0.0, 2 * b / T
    for _ in range(36):
        k = (low + high) / 2
        stands = np.all((1 / (b_c + k * T / (1 - np.exp(-1j * theta)))).real >= need)
        low, high = (k, high) if stands else (low, k)
    return low


@pytest.mark.parametrize("periods", [1, 2])
def test_whole_delays_against_brute_force(periods):
    for b_c in (0.02, 0.09):
        assert coupler_design(paddle(periods), b_c=b_c).k_c == pytest.approx(stiffest(b_c, periods), rel=1e-6)
    best = minimize_scalar(lambda b_c: -stiffest(b_c, periods), bounds=(0.0, b), method="bounded", options={"xatol": 1e-5})
    design = coupler_design(paddle(periods))
    assert design.k_c == pytest.approx(-best.fun, rel=1e-6) and design.b_c == pytest.approx(best.x, rel=2e-2)


def test_one_period_of_delay_in_closed_form():
    """k_c = 4/(3 sqrt 3) b/T, stopped at a sixth of the sampling rate."""
    design = coupler_design(paddle(1))
    assert design.k_c * T / b == pytest.approx(4 / 27**0.5, rel=1e-9)
    assert design.frequency == pytest.approx(1000 / 6, rel=1e-4)


@pytest.mark.parametrize(("whole", "f"), [(0, 0.0), (0, 0.25), (1, 0.0), (2, 0.5)])
def test_a_spring_alone_is_stopped_by_slow_motion(whole, f):
    design = coupler_design(paddle(whole + f), b_c=0.0)
    assert design.k_c * T / b == pytest.approx(2 / ((1 - f) * (whole + 1) ** 2 + f * (whole + 2) ** 2), rel=1e-9)
    assert design.frequency == (0.0 if whole + f else None)


def environment(generator, theta):
    """A random network of bodies, springs and dampers stepped by backward Euler, which keeps it passive: F/w at theta."""
    rate = (1 - np.exp(-1j * theta)) / T
    Z = np.zeros(len(theta), dtype=complex)
    for _ in range(generator.integers(1, 6)):
        mass, damper, spring = 10 ** generator.uniform(-4, 1), 10 ** generator.uniform(-3, 1), 10 ** generator.uniform(-1, 5)
        branch = generator.choice(3)
        added = (mass * rate, damper, spring / rate)[branch]
        Z = Z + added if generator.random() < 0.5 else 1 / (1 / (Z + 1e-9) + 1 / added)
    return Z


@pytest.mark.parametrize("delay", [0.0, 0.35, 1.0, 2.6])
@pytest.mark.always("0.0", "1.0")
def test_no_passive_environment_asks_for_more_than_the_device_has(delay):
    """The coupler and what hangs on it as one law H(z), by Colgate and Schenkel's condition: another way to the claim."""
    generator, theta = np.random.default_rng(2), np.linspace(0.01, np.pi, 200)
    z, most = np.exp(1j * theta), 0.0
    for b_c in (None, 0.05):
        design = coupler_design(paddle(delay), b_c=b_c)
        Z_c = design.b_c + design.k_c * T / (1 - 1 / z)
        reactances = 1j * 10 ** generator.uniform(-4, 4, (300, 1)) * generator.choice([-1, 1], (300, 1))
        for Z_e in [environment(generator, theta) for _ in range(300)] + list(reactances * np.ones(200)):
            H = (1 - 1 / z) / T / (1 / Z_c + 1 / Z_e)
            most = max(most, asked_of(H, theta, delay).max())
    assert 0.9 * b < most <= b * (1 + 1e-9)


def asked_of(H, theta, delay):
    """Colgate and Schenkel's expression for a response given by its values, with a fraction of delay."""
    whole, f = int(delay), delay - int(delay)
    late = H * np.exp(-1j * theta * whole)
    averaged = late * ((1 - f) + f * np.exp(-1j * theta))
    R = T / 2 * ((1 - np.exp(-1j * theta)) * averaged).real / (1 - np.cos(theta))
    return (R + np.sqrt(R**2 + T**2 * f * (1 - f) * abs(H) ** 2)) / 2


@pytest.mark.parametrize("delay", [0.0, 0.35, 2.6])
def test_the_border_is_where_a_passive_pair_first_asks_for_more(delay):
    """At the frequency that stops it, some reactance asks for all of b; with 1 % more spring, for more."""
    for b_c in (0.01, 0.05):
        design = coupler_design(paddle(delay), b_c=b_c)
        theta = max(2 * np.pi * design.frequency * T, 1e-4)  # 0 for slow motion
        Z_e = 1j * np.outer([1, -1], np.geomspace(1e-6, 1e6, 20000)).ravel()
        for factor, expected in ((1.0, b), (1.01, None)):
            Z_c = b_c + factor * design.k_c * T / (1 - np.exp(-1j * theta))
            needed = asked_of((1 - np.exp(-1j * theta)) / T / (1 / Z_c + 1 / Z_e), theta, delay).max()
            assert needed == pytest.approx(expected, rel=1e-6) if expected else needed > b * 1.005
    assert not impedance_display(k_c=1.001 * design.k_c, b_c=b_c, b=b, T=T, delay=delay * T).absolutely_stable


def test_a_fixed_proxy_is_the_wall_and_never_asks_for_more():
    for delay in (0.0, 0.4, 1.0, 3.2):
        border = coupler_design(paddle(delay)).border(points=4)
        for b_c, k_c in border.T:
            assert required_damping(K=max(k_c, 0), T=T, B=b_c, delay=delay * T) <= b * (1 + 1e-8)


def test_whole_loops_with_random_hands_and_a_body_on_the_coupler():
    """Eigenvalues of hand, handle, coupler and a body stepped by backward Euler; a coupler too stiff finds its hand."""
    hands = network(np.random.default_rng(6), 400, 2, 0.05, T)

    def loop(k_c, b_c, mass):
        # proxy: mass (w - w')/T = k_c e + b_c (e - e')/T with e = x - z and z = z' + T w; states z', w', e'
        a, c = mass / T, k_c * T + b_c  # (a + c) w = a w' + k_c (x - z') + b_c (x - z' - e')/T
        row = np.array([-(k_c + b_c / T), a, -b_c / T]) / (a + c)  # w from z', w', e'
        by_x = (k_c + b_c / T) / (a + c)
        A = np.array([[1, 0, 0] + T * row, row, -np.array([1, 0, 0]) - T * row])
        B = np.array([T * by_x, by_x, 1 - T * by_x])
        return A, B, a * (row - [0, 1, 0]), a * by_x

    design = coupler_design(paddle(), b_c=0.05)
    for mass in (1e-4, 2e-3, 0.1):
        assert radii(loop(design.k_c, design.b_c, mass), hands, b, T).max() < 1 + 1e-6
    assert radii(loop(2.5 * design.k_c, design.b_c, 0.1), hands, b, T).max() > 1 + 1e-3


def test_words_picture_and_refusals():
    design = coupler_design(paddle(0.5), b_c=0.05)
    assert "every passive hand and every environment that is passive at the sample rate" in str(design)
    assert design.two_port.absolutely_stable and design.two_port.stable
    assert not impedance_display(k_c=-100, b_c=0.05, b=b, T=T).absolutely_stable  # falls by itself
    left, right = design.plot().axes
    assert "N s/m" in left.get_xlabel() and right.lines[0].get_ydata().min() > -1e-9
    with pytest.raises(AnalysisError, match="be at most 0.2 N s/m,"):
        coupler_design(paddle(), b_c=0.3)
    with pytest.raises(AnalysisError, match="b = 0"):
        coupler_design(paddle(b=0.0))
    with pytest.raises(AnalysisError, match="has no b"):
        coupler_design("paddle")


@pytest.mark.parametrize("mass", [2e-3, 0.05])
def test_a_compiled_scene_asks_for_a_little_more_as_explicit_steps_are_not_passive(mass):
    """b/(1 - m_0/m), m_0 = b T/2, by semi-implicit Euler under a held sample; less by the exact map with extrapolation."""
    design = coupler_design(paddle(), b_c=0.05)
    z = hl.coordinate("z", unit="m")
    K, B, m = hl.parameters("K B m", units="N/m N*s/m kg", values=(design.k_c, design.b_c, mass))
    F = hl.laws.virtual_coupler(z, K=K, b=B)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])
    held = hl.passivity.port(paddle(), scene, method="semi_implicit_euler", hold="zoh").b_req
    assert held == pytest.approx(b / (1 - b * T / 2 / mass), rel=1e-9)
    assert b < hl.passivity.port(paddle(), scene, method="exact", hold="soh").b_req < b + 0.3 * (held - b)


def carried(mass, K, b_c):
    """(Phi, G_x, G_v): a body on a coupler over one period, solved exactly while the handle moves along a line."""
    rates = np.array([[0, 1, 0, 0], [-K / mass, -b_c / mass, K / mass, b_c / mass], [0, 0, 0, 1], [0, 0, 0, 0]])
    step = expm(rates * T)[:2]
    return step[:, :2], step[:, 2], step[:, 3]


def slowed(mass, K, b_c, theta):
    """What Colgate and Schenkel ask of a device for that body at each frequency, its force sampled and held."""
    (Phi, G_x, G_v), z = carried(mass, K, b_c), np.exp(1j * theta)
    v = (1 - 1 / z) / T
    s = np.linalg.solve(np.eye(2) - Phi / z[:, None, None], (np.outer(1 / z, G_x) + np.outer(v, G_v))[..., None])[..., 0]
    return (T * (K + b_c * v - s @ [K, b_c]) / (1 - z)).real


@pytest.mark.parametrize(("b_c", "least"), [(0.05, 0.2), (0.02, 0.405), (0.01, 0.9025)])
@pytest.mark.always("0.02-0.405")
def test_a_body_solved_without_error_asks_for_more_than_the_design_where_the_coupler_hardly_damps(b_c, least):
    """The larger of k_c T/2 + b_c and (k_c T/2)^2/(4 b_c), by an own exact map; the compiled scene asks for the same."""
    K = coupler_design(paddle(), b_c=b_c).k_c
    own = slowed(0.5, K, b_c, np.geomspace(1e-3, np.pi, 20000)).max()
    assert own == pytest.approx(least, rel=2e-3) and least == pytest.approx(max(b, (K * T / 2) ** 2 / (4 * b_c)))
    z = hl.coordinate("z", unit="m")
    k_c, B, m = hl.parameters("k_c B m", units="N/m N*s/m kg", values=(K, b_c, 0.5))
    F = hl.laws.virtual_coupler(z, K=k_c, b=B)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])
    for method in ("exact", "rk4"):
        assert hl.passivity.port(paddle(), scene, method=method, hold="soh").b_req == pytest.approx(own, rel=2e-3)


def test_some_hand_finds_the_body_that_the_design_does_not_cover():
    """Eigenvalues of handle, a mass of the hand and the exact body: they grow on the device of the design, and not with b_req."""
    b_c, mass = 0.02, 0.05
    K = coupler_design(paddle(), b_c=b_c).k_c
    Phi, G_x, G_v = carried(mass, K, b_c)

    def radius(damping, held):
        # states s, x, v, x'; the handle of mass ``held`` is solved exactly under the held force
        F, one = np.array([-K, -b_c, K + b_c / T, 0, -b_c / T]), np.eye(5)
        step = expm(T * np.array([[0, 1, 0], [0, -damping / held, -1 / held], [0, 0, 0]]))
        x, v = (one[2] * row[0] + one[3] * row[1] + F * row[2] for row in step[:2])
        body = Phi @ one[:2] + np.outer(G_x, one[2]) + np.outer(G_v, (x - one[2]) / T)
        return abs(np.linalg.eigvals(np.vstack([body, x, v, one[2]]))).max()

    hands, needed = np.geomspace(0.02, 1.0, 60), slowed(mass, K, b_c, np.geomspace(1e-3, np.pi, 20000)).max()
    assert max(radius(b, held) for held in hands) > 1 + 1e-4
    assert max(radius(1.01 * needed, held) for held in hands) < 1 + 1e-9
