"""The damping that a scene asks of a device: closed forms, numbers measured elsewhere, and random passive hands."""

from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.stability.passive_hands import network, radii
from hapticlab.analysis.stability.port_passivity import stable_damping
from hapticlab.analysis.stability.trial_limits import Limits
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import AnalysisError
from hapticlab.limits.passivity import required_damping
from hapticlab.limits.port import port_damping

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
    port = hl.passivity.port(paddle(delay=delay), hl.wall()(k=300, x_o=0.01, B=0.07))
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
        port = hl.passivity.port(hl.Device(T=T), coupler(B=damper), **options)
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
@pytest.mark.always("rk4-zoh-before-*", "semi_implicit_euler-zoh-after-*")
def test_numbers_measured_on_prototypes(method, hold, force_at, expected):
    """A lightly damped coupler, B = 0.05 N s/m: hold and timing of the force change b_req more than the order does."""
    port = hl.passivity.port(hl.Device(T=T), coupler(), method=method, hold=hold, force_at=force_at)
    assert port.b_req == pytest.approx(expected, rel=0.04)
    # the same program measured from unit states, without a slope
    assert port.b_req == pytest.approx(
        port_damping(hl.Device(T=T), coupler(), method=method, hold=hold, force_at=force_at), rel=1e-9
    )


#: "euler" gains energy on the lightly damped coupler, and "nystrom4" knows no damper
PASSIVE = [*sorted(set(METHODS) - {"euler", "nystrom4"}), "exact", "taylor"]
PAIRS = [(method, hold) for method in PASSIVE for hold in ("zoh", "foh", "soh")]


def spring(**values):
    F = K * (x(t) - z)
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="a mass on a spring")(**values)


def largest_radius(port, seed, each):
    """Return it of 16 lots of handles of 1 to 200 g in random hands, on devices of 1, 1.5 and 4 times the damping asked for."""
    generator, largest = np.random.default_rng(seed), 0.0
    for bodies in range(4):
        for mass in (0.001, 0.01, 0.05, 0.2):
            hands = network(generator, each, bodies, mass, T)
            b = port.b_req * np.resize([1 + 1e-9, 1.5, 4.0], each)
            largest = max(largest, radii(port.worst.tick, hands, b, T).max())
    return largest


#: random hands in a lot, of which there are 16 for each instant of the force
LOTS = [21, pytest.param(126, marks=pytest.mark.slow)]


@pytest.mark.parametrize("each", LOTS)
@pytest.mark.parametrize(("method", "hold"), PAIRS)
@pytest.mark.always("verlet-soh-*", "adams_bashforth3-foh-*")
def test_no_passive_hand_is_unstable_at_the_damping_asked_for(method, hold, each):
    """In a thousand random networks of masses, springs and dampers, by eigenvalues; six thousand where it may take longer."""
    for k, force_at in enumerate(("before", "after", "mean")):
        port = hl.passivity.port(hl.Device(T=T), coupler(), method=method, hold=hold, force_at=force_at)
        assert np.isfinite(port.b_req) and port.b_req > 0.1
        # rounding of a free network's double eigenvalue 1
        assert largest_radius(port, 3 * PAIRS.index((method, hold)) + k, each) < 1 + 1e-6, force_at


@pytest.mark.parametrize("each", LOTS)
@pytest.mark.parametrize("hold", ["zoh", "foh", "soh"])
@pytest.mark.parametrize(("method", "scene"), [("euler", coupler(B=1.0)), ("nystrom4", spring(m=0.002))])
@pytest.mark.always("euler-*-zoh-*", "nystrom4-*-soh-*")
def test_no_passive_hand_is_unstable_with_methods_for_a_damper_or_for_none(method, scene, hold, each):
    """Euler needs a damper of 1 N s/m to be stable; Nystrom's loses energy at w h = 0.5, which makes b_req finite."""
    for k, force_at in enumerate(("before", "after", "mean")):
        port = hl.passivity.port(hl.Device(T=T), scene, method=method, hold=hold, force_at=force_at)
        assert np.isfinite(port.b_req)
        assert largest_radius(port, k, each) < 1 + 1e-6, force_at


def test_less_than_the_damping_asked_for_is_unstable_where_a_resonance_asks():
    """Tight: with a held sample the resonance of the coupler, at one frequency, is what a hand can drive."""
    port = hl.passivity.port(paddle(), coupler(), method="rk4", hold="zoh")
    assert 50 > port.frequency > 10
    assert 0.9 < port.b_stable / port.b_req <= 1.0
    hands = network(np.random.default_rng(5), 4000, 1, 0.05, T)
    assert radii(port.worst.tick, hands, 0.3 * port.b_req, T).max() > 1 + 1e-4
    assert not port.passive and "not passive" in str(port)


def test_delay_in_the_closed_loop():
    """A wall k held k periods late asks for k T (lag + 1/2), and there a hand without a mass of its own is at the limit."""
    port = hl.passivity.port(paddle(delay=2e-3), hl.wall()(k=300, x_o=0.01))
    assert port.b_req == pytest.approx(300 * T * 2.5, rel=1e-9)
    hands = network(np.random.default_rng(11), 500, 2, 0.01, T)
    assert radii(port.worst.tick, hands, port.b_req * (1 + 1e-9), T, delay=2e-3).max() < 1 + 1e-6
    assert radii(port.worst.tick, hands, 0.5 * port.b_req, T, delay=2e-3).max() > 1 + 1e-3


def test_a_scene_that_is_not_linear_is_looked_at_where_it_is_said():
    """Stiffness of a hardening spring k_1 x + k_3 x^3 is k_1 + 3 k_3 x^2: it asks for half of that times T."""
    k_1, k_3 = hl.parameters("k_1 k_3", units="N/m N/m^3", values=(100, 4e6))
    scene = hl.Scene(force=k_1 * x(n) + k_3 * x(n) ** 3)
    port = hl.passivity.port(hl.Device(T=T), scene, at=[{"x": 0.0}, {"x": 5e-3}, {"x": 0.01}])
    assert [mode.b_req for mode in port.modes] == pytest.approx([0.05, 0.2, 0.65], rel=1e-9)
    assert port.small_signal and "small motions" in str(port) and port.worst.point == "x = 0.01"


def test_the_handle_is_looked_at_over_its_travel():
    """3 k_3 x^2 T/2 at 50 mm; a beam beyond its load k (1 - P) + 3 k_3 x^2, from whose middle a handle moves on."""
    k_3 = hl.parameters("k_3", units="N/m^3", values=4e4)
    port = hl.passivity.port(paddle(b=0.14), hl.Scene(force=k_3 * x(n) ** 3))
    assert port.b_req == pytest.approx(3 * 4e4 * 0.05**2 * T / 2, rel=1e-9)
    assert port.passive is False and "handle within +-50 mm" in str(port) and len(port.modes) == 2
    beam = hl.passivity.port(paddle(), hl.library.buckling_beam())
    assert beam.b_req == pytest.approx(330 * T / 2, rel=1e-9) and beam.passive
    middle = beam.modes[0]
    assert middle.stiffness == pytest.approx(-45, rel=1e-9) and "locally active, -45 N/m" in middle.reason
    # with the body carried along a linear scene stays one point
    assert len(hl.passivity.port(hl.Device(T=T), hl.library.mass_spring_damper()).modes) == 1


def test_the_travel_counts_for_scenes_with_bodies_too():
    """A coupler that hardens, K (d + d^3/s^2) with d = x - z and z held: 1 + 3 (50 mm)^2/s^2 times as stiff at the end."""
    s, d = hl.parameters("s", units="m", values=0.1), x(t) - z
    F = K * (d + d**3 / s**2) + B * (v(t) - z.diff(t))
    port = hl.passivity.port(hl.Device(T=T), hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])(B=1.0))
    assert port.floor == pytest.approx(500 * (1 + 3 * 0.25) * T / 2 + 1.0, rel=1e-3) and port.small_signal


@pytest.mark.parametrize("b", [0.3, 3.0])
def test_negative_stiffness_is_never_passive(b):
    """A free handle falls whatever the damping: alone, as a body behind a coupler, and behind a wall."""
    k = hl.parameters("k", units="N/m", values=-100, ranges=(-1e4, 1e4))
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    body = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k * z - B * z.diff(t))])(B=0.4)
    x_o = hl.parameters("x_o", units="m", values=0.01)
    for scene in (hl.Scene(force=k * x(n)), body, hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))):
        port = hl.passivity.port(paddle(b=b), scene)
        assert np.isnan(port.b_req) and not port.passive and "a free handle moves away" in str(port)
        assert port.b_stable == np.inf
        free = (np.full((1, 1, 1), 0.05), np.zeros((1, 1, 1)), np.zeros((1, 1, 1)))
        assert radii(port.worst.tick, free, b, T).max() > 1 + 1e-5


def test_a_force_that_jumps_is_never_passive():
    """A step of 2 N at 10 mm; none where both sides meet, or where what differs is not felt there."""
    f, x_o = hl.parameters("f x_o", units="N m", values=(2, 0.01))
    port = hl.passivity.port(paddle(), hl.Scene(force=hl.when(x(n) >= x_o, f)))
    assert port.b_req == np.inf and port.passive is False and "the force jumps by 2 N" in port.worst.reason
    assert port.worst.point == "x = 0.01" and port.b_stable == np.inf
    assert hl.passivity.port(paddle(), hl.wall()(k=300, x_o=0.01, B=0.07)).b_req < 1
    assert hl.passivity.port(paddle(b=0.21), hl.library.virtual_fixture()).passive
    # out of a groove the force drops from k w to none, late, which takes energy out
    groove = hl.passivity.port(paddle(b=0.3), hl.Scene(force=hl.when(sp.Abs(x(n)) <= x_o, K * x(n))))
    assert groove.b_req == pytest.approx(500 * T / 2, rel=1e-9) and groove.passive


def test_a_trade_off_asks_for_the_same():
    """Infinite damping where stiffness is negative or the force jumps; nothing told where the scene falls; else b_req."""
    k, f, x_o = hl.parameters("k f x_o", units="N/m N m", values=(-100, 2, 0.01), ranges=[(-1e4, 1e4), None, None])
    setting = SimpleNamespace(T=T, method="rk4", substeps=1, hold="soh", force_at="before")
    expected = (
        (hl.Scene(force=k * x(n)), np.inf), (hl.Scene(force=hl.when(x(n) >= x_o, f)), np.inf), (hl.library.cart_pole(), None),
        (hl.library.buckling_beam(), 330 * T / 2), (coupler(), hl.passivity.port(hl.Device(T=T), coupler()).b_req),
    )  # fmt: skip
    for scene, b in expected:
        found, _ = Limits(scene).damping(setting, hl.compile(scene, T=T, live=(), dtype="float64"))
        assert found == (b if b is None else pytest.approx(b, rel=1e-6)), scene.name


def test_stable_damping_is_inf_where_none_is_enough():
    """A spring of -50 N/m: unstable in a free hand with any damping, whatever was asked for."""
    tick = (np.zeros((0, 0)), np.zeros(0), np.zeros(0), -50.0)
    for b_req in (0.0, 0.3, np.inf):
        assert stable_damping(tick, 0.05, T, 0.0, b_req) == np.inf
    wall = (*tick[:3], 300.0)
    # a mass at the end of a sampled spring: det of [[1 - K T^2/2m, T], [-K T/m, 1]] is 1 + K T^2/2m without damping
    found = stable_damping(wall, 0.05, T, 0.0, 300 * T / 2)
    assert 0.14 < found <= 300 * T / 2
    assert stable_damping(wall, 0.05, T, 0.0, np.inf) == pytest.approx(found, rel=2e-3)


def test_detents_are_not_taken_for_linear():
    """Eq. of a sine: A sin(2 pi x/p), stiffest where it passes zero, A 2 pi/p."""
    scene = hl.library.detents()
    port = hl.passivity.port(hl.Device(T=T), scene)
    A, p = scene.values["A"], scene.values["p"]
    assert port.b_req == pytest.approx(A * 2 * np.pi / p * T / 2, rel=1e-6) and port.small_signal


def test_what_falls_by_itself_and_what_is_unstable():
    """A pole on a cart starts upright: no motion near it is passive, and nothing is said of the device."""
    port = hl.passivity.port(paddle(), hl.library.cart_pole())
    assert np.isnan(port.b_req) and port.passive is None and "moves away by itself" in str(port)
    unstable = hl.passivity.port(hl.Device(T=T), coupler(K=5e5), method="semi_implicit_euler")
    assert unstable.b_req == np.inf and "unstable with the handle held" in unstable.worst.reason


def test_the_picture_peaks_at_what_is_asked_for():
    port = hl.passivity.port(paddle(delay=0.3e-3), coupler(), hold="zoh")
    line, device = port.plot().axes[0].lines
    frequency, b = line.get_data()
    assert b.max() == pytest.approx(port.b_req, rel=0.02) and device.get_ydata()[0] == 0.2
    assert frequency[b.argmax()] == pytest.approx(port.frequency, rel=0.02)


def test_refusals():
    with pytest.raises(AnalysisError, match=r"hl\.passivity\.port"):
        hl.passivity.port(hl.Device(T=T), "scene")
    with pytest.raises(AnalysisError, match=r"the device has no T; needs hl\.Device\(T=\.\.\., \.\.\.\)"):
        hl.passivity.port(hl.Device(b=0.1), coupler())
    with pytest.raises(AnalysisError, match="no finite slope"):
        hl.passivity.port(hl.Device(T=T), hl.Scene(force=K * sp.sqrt(x(n) * hl.parameters("a", units="m", values=1))))
