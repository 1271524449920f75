"""The damping a device needs, measured on compiled programs: against closed forms of walls and couplers."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.errors import AnalysisError
from hapticlab.limits.passivity import required_damping
from hapticlab.limits.port import port_damping, static_stiffness, tick_map

T = 1e-3
z = hl.coordinate("z", unit="m")
K, B, m = hl.parameters("K B m", units="N/m N*s/m kg", values=(500, 1, 0.05))


@pytest.mark.parametrize("law", ["zoh", "backward_difference", "ellis"])
@pytest.mark.parametrize("damper", [0.0, 0.07])
def test_springs_with_a_memory(law, damper):
    """Eqs. (23.1), (23.5), (23.7) as springs that always act, against the closed form of their worst frequency."""
    taps = {"zoh": [1], "backward_difference": [1.5, -0.5], "ellis": [2, -1.5, 0.5]}[law]
    spring = hl.Scene(force=K * sum(a * x(n - k) for k, a in enumerate(taps)) + B * v(n))
    assert port_damping(hl.Device(T=1e-3), spring(K=300, B=damper)) == pytest.approx(
        required_damping(K=300, T=T, B=damper, law=law), rel=1e-9
    )


def coupler(**values):
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])(**values)


@pytest.mark.parametrize("damper", [0.3, 0.6, 1.0])
def test_a_mass_on_a_coupler(damper):
    """Semi-implicit Euler under a held sample has a closed form: b_0/(1 - m_0/m), b_0 = K T/2 + B, m_0 = b_0 T/2."""
    b_0 = 500 * T / 2 + damper
    m_0 = b_0 * T / 2
    found = port_damping(hl.Device(T=1e-3), coupler(B=damper), method="semi_implicit_euler", hold="zoh")
    assert found == pytest.approx(b_0 / (1 - m_0 / 0.05), rel=1e-9)


def test_the_exact_map_is_its_own_closed_form():
    """Under a held sample the pole pair and the force are those of the matrix exponential."""
    A, by_x, C, D = tick_map(hl.compile(coupler(), T=T, method="exact", hold="zoh", live=(), dtype="float64"))
    decay, square = 1 / 0.1, 500 / 0.05
    expected = np.exp((-decay + np.array([1j, -1j]) * np.sqrt(square - decay**2)) * T)
    poles = np.linalg.eigvals(A)
    assert min(abs(poles - expected[0])) < 1e-12 and min(abs(poles - expected[1])) < 1e-12
    z_inf = 1e6
    assert (C @ np.linalg.solve(z_inf * np.eye(len(A)) - A, by_x) + D) == pytest.approx(500 + 1 / T, rel=1e-2)


def test_without_damping_no_device_is_enough():
    assert port_damping(hl.Device(T=1e-3), coupler(B=0), method="exact") == np.inf
    assert port_damping(hl.Device(T=1e-3), coupler(B=0.05), method="exact", hold="zoh") == pytest.approx(
        1.0, abs=0.01
    )  # its resonance


def test_static_stiffness_is_that_of_springs_in_series():
    """K and k of a body on the ground: K k/(K + k), negative with k; a free body follows, which leaves 0."""
    k = hl.parameters("k", units="N/m", values=-100, ranges=(-1e4, 1e4))
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k * z - B / 5 * z.diff(t))])
    for stiffness in (-100, 300):
        tick = tick_map(hl.compile(scene(k=stiffness), T=T, live=(), dtype="float64"))
        assert static_stiffness(*tick) == pytest.approx(500 * stiffness / (500 + stiffness), rel=1e-9)
    assert static_stiffness(*tick_map(hl.compile(coupler(), T=T, live=(), dtype="float64"))) == 0.0
    with pytest.raises(AnalysisError, match="negative stiffness, -125 N/m"):
        port_damping(hl.Device(T=1e-3), scene)
    with pytest.raises(AnalysisError, match="negative stiffness, -200 N/m: a free handle moves away,"):
        port_damping(hl.Device(T=1e-3), hl.Scene(force=k * x(n))(k=-200))


def test_refusals():
    with pytest.raises(AnalysisError, match="not linear"):
        port_damping(hl.Device(T=1e-3), hl.wall()(k=100, x_o=0))
    with pytest.raises(AnalysisError, match="not linear"):
        port_damping(hl.Device(T=1e-3), hl.Scene(force=K * z, eom=[sp.Eq(m * z.diff(t, 2), K * (x(t) - sp.Abs(z)))]))
    with pytest.raises(AnalysisError, match="unstable with the handle held"):
        port_damping(hl.Device(T=1e-3), coupler(K=5e5), method="semi_implicit_euler")
    f = hl.parameters("f", units="Hz", values=3)
    with pytest.raises(AnalysisError, match="depends on x alone and not on time"):
        port_damping(hl.Device(T=1e-3), hl.Scene(force=K * x(n) * sp.sin(2 * sp.pi * f * t)))
