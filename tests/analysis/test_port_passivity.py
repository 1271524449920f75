"""The damping that a scene asks of a device: closed forms, numbers measured elsewhere, and random passive hands."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.passive_hands import network, radii
from hapticlab.analysis.passivity import required_damping
from hapticlab.analysis.port import port_damping
from hapticlab.errors import AnalysisError

T = 1e-3
z, theta = hl.coordinate("z", unit="m"), hl.coordinate("theta", unit="rad", initial=0.2)
K, B, m = hl.parameters("K B m", units="N/m N*s/m kg", values=(500, 0.05, 0.05))


def coupler(**values):
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="a mass on a coupler")(**values)


def paddle(**given):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.2, "T": T, **given})


@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3, 2.7e-3])
def test_a_wall_in_contact_with_delay(delay):
    """The general form of Eq. (23.10), from Dirichlet's kernel, whole and fractional delays alike."""
    port = hl.port_passivity(hl.wall()(k=300, x_o=0.01, B=0.07), paddle(delay=delay))
    apart, touching = port.modes
    assert apart.b_req == 0 and touching.mode == "x(n) >= x_o"
    assert touching.b_req == pytest.approx(required_damping(K=300, T=T, B=0.07, delay=delay), rel=1e-7)
    assert port.worst is touching and port.kind == "piecewise linear"
    assert port.passive == (port.b_req <= 0.2)


@pytest.mark.parametrize("damper", [0.5, 1.0])
def test_semi_implicit_euler_has_a_closed_form(damper):
    """b_0/(1 - m_0/m), b_0 = K T/2 + B, m_0 = b_0 T/2; after the step b_0 (1 - 2 m_0/m)/(1 - m_0/m).

    Where the worst frequency is Nyquist's: with a damper that is not small."""
    b_0 = 500 * T / 2 + damper
    part = b_0 * T / 2 / 0.05
    for force_at, expected in (("before", b_0 / (1 - part)), ("after", b_0 * (1 - 2 * part) / (1 - part))):
        options = {"method": "semi_implicit_euler", "hold": "zoh", "force_at": force_at}
        port = hl.port_passivity(coupler(B=damper), T=T, **options)
        assert port.b_req == pytest.approx(expected, rel=1e-6), force_at
        if force_at == "before":
            assert port.floor == pytest.approx(b_0, rel=1e-9)
        assert port.frequency == pytest.approx(500, rel=1e-6)  # Nyquist


@pytest.mark.parametrize(
    ("method", "hold", "force_at", "expected"),
    [
        ("rk4", "zoh", "before", 1.0), ("semi_implicit_euler", "zoh", "before", 0.314), ("rk4", "zoh", "after", 0.300),
        ("rk4", "zoh", "mean", 0.313), ("rk4", "foh", "before", 0.32), ("rk4", "soh", "before", 0.32),
        ("semi_implicit_euler", "zoh", "after", 0.813),
    ],
)  # fmt: skip
def test_numbers_measured_on_prototypes(method, hold, force_at, expected):
    """A lightly damped coupler, B = 0.05 N s/m: hold and timing of the force change b_req more than the order does."""
    port = hl.port_passivity(coupler(), T=T, method=method, hold=hold, force_at=force_at)
    assert port.b_req == pytest.approx(expected, rel=0.04)
    # the same program measured from unit states, without a slope
    assert port.b_req == pytest.approx(port_damping(coupler(), T=T, method=method, hold=hold, force_at=force_at), rel=1e-9)


#: "euler" gains energy on the lightly damped coupler, and "nystrom4" knows no damper
METHODS = (
    "semi_implicit_euler", "semi_implicit_euler_damped", "verlet", "midpoint", "heun", "ssprk3", "adams_bashforth2",
    "adams_bashforth3", "rk4", "exact", "taylor",
)  # fmt: skip
PAIRS = [(method, hold) for method in METHODS for hold in ("zoh", "foh", "soh")]


@pytest.mark.parametrize(("method", "hold"), PAIRS)
def test_no_passive_hand_is_unstable_at_the_damping_asked_for(method, hold):
    """In a thousand random networks of masses, springs and dampers, handles of 1 to 200 g, by eigenvalues."""
    port = hl.port_passivity(coupler(), T=T, method=method, hold=hold)
    generator = np.random.default_rng(PAIRS.index((method, hold)))
    largest = 0.0
    for bodies in range(4):
        for mass in (0.001, 0.01, 0.05, 0.2):
            hands = network(generator, 63, bodies, mass, T)
            largest = max(largest, radii(port.worst.tick, hands, port.b_req * (1 + 1e-9), T).max())
    # rounding of a free network's double eigenvalue 1
    assert largest < 1 + 1e-6


def test_less_than_the_damping_asked_for_is_unstable_where_a_resonance_asks():
    """Tight: with a held sample the resonance of the coupler, at one frequency, is what a hand can drive."""
    port = hl.port_passivity(coupler(), paddle(), method="rk4", hold="zoh")
    assert 50 > port.frequency > 10
    assert 0.9 < port.b_stable / port.b_req <= 1.0
    hands = network(np.random.default_rng(5), 4000, 1, 0.05, T)
    assert radii(port.worst.tick, hands, 0.3 * port.b_req, T).max() > 1 + 1e-4
    assert not port.passive and "not passive" in str(port)


def test_delay_in_the_closed_loop():
    """A wall k held k periods late asks for k T (lag + 1/2), and there a hand without a mass of its own is at the limit."""
    port = hl.port_passivity(hl.wall()(k=300, x_o=0.01), paddle(delay=2e-3))
    assert port.b_req == pytest.approx(300 * T * 2.5, rel=1e-9)
    hands = network(np.random.default_rng(11), 500, 2, 0.01, T)
    assert radii(port.worst.tick, hands, port.b_req * (1 + 1e-9), T, delay=2e-3).max() < 1 + 1e-6
    assert radii(port.worst.tick, hands, 0.5 * port.b_req, T, delay=2e-3).max() > 1 + 1e-3


def test_a_scene_that_is_not_linear_is_looked_at_where_it_is_said():
    """Stiffness of a hardening spring k_1 x + k_3 x^3 is k_1 + 3 k_3 x^2: it asks for half of that times T."""
    k_1, k_3 = hl.parameters("k_1 k_3", units="N/m N/m^3", values=(100, 4e6))
    scene = hl.Scene(force=k_1 * x(n) + k_3 * x(n) ** 3)
    port = hl.port_passivity(scene, T=T, at=[{"x": 0.0}, {"x": 5e-3}, {"x": 0.01}])
    assert [mode.b_req for mode in port.modes] == pytest.approx([0.05, 0.2, 0.65], rel=1e-9)
    assert port.small_signal and "small motions" in str(port) and port.worst.point == "x = 0.01"


def test_detents_are_not_taken_for_linear():
    """Eq. of a sine: A sin(2 pi x/p), stiffest where it passes zero, A 2 pi/p."""
    scene = hl.library.detents()
    port = hl.port_passivity(scene, T=T)
    A, p = scene.values["A"], scene.values["p"]
    assert port.b_req == pytest.approx(A * 2 * np.pi / p * T / 2, rel=1e-6) and port.small_signal


def test_what_falls_by_itself_and_what_is_unstable():
    """A pole on a cart starts upright: no motion near it is passive, and nothing is said of the device."""
    port = hl.port_passivity(hl.library.cart_pole(), paddle())
    assert np.isnan(port.b_req) and port.passive is None and "falls by itself" in str(port)
    unstable = hl.port_passivity(coupler(K=5e5), T=T, method="semi_implicit_euler")
    assert unstable.b_req == np.inf and "unstable with the handle held" in unstable.worst.reason


def test_the_picture_peaks_at_what_is_asked_for():
    port = hl.port_passivity(coupler(), paddle(delay=0.3e-3), hold="zoh")
    line, device = port.plot().axes[0].lines
    frequency, b = line.get_data()
    assert b.max() == pytest.approx(port.b_req, rel=0.02) and device.get_ydata()[0] == 0.2
    assert frequency[b.argmax()] == pytest.approx(port.frequency, rel=0.02)


def test_refusals():
    with pytest.raises(AnalysisError, match=r"hl\.port_passivity"):
        hl.port_passivity("scene", T=T)
    with pytest.raises(AnalysisError, match="T is missing"):
        hl.port_passivity(coupler())
    with pytest.raises(AnalysisError, match="no finite slope"):
        hl.port_passivity(hl.Scene(force=K * sp.sqrt(x(n) * hl.parameters("a", units="m", values=1))), T=T)
