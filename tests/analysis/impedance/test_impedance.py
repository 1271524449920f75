"""Impedance at the handle, against closed forms and scipy's transfer functions."""

import numpy as np
import pytest
import sympy as sp
from scipy import signal

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.impedance.impedance import impedance
from hapticlab.errors import AnalysisError, ParameterError

FREQUENCY = np.geomspace(0.05, 80, 60)
S = 2j * np.pi * FREQUENCY

y, z, s = hl.coordinate("y", unit="m"), hl.coordinate("z", unit="m"), hl.coordinate("s", unit="N")
k, b, m, r = hl.parameters("k b m r", units="N/m N*s/m kg 1/s", values=(700, 1.3, 0.04, 25))


def test_mass_on_a_coupler():
    F = k * (x(t) - z) + b * (v(t) - z.diff(t))
    Z = impedance(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), FREQUENCY)
    coupler, mass = 1.3 + 700 / S, 0.04 * S
    assert Z == pytest.approx(coupler * mass / (coupler + mass), rel=1e-12)  # one behind the other: admittances add


def test_two_masses_agree_with_a_transfer_function():
    between, F = k / 3 * (z - y) + b * (z.diff(t) - y.diff(t)), k * (x(t) - z)
    eom = [sp.Eq(z.diff(t, 2), (F - between) / m), sp.Eq(2 * m * y.diff(t, 2) - between, -b / 2 * y.diff(t))]
    K, C = np.array([[700 * 4 / 3, -700 / 3], [-700 / 3, 700 / 3]]), np.array([[1.3, -1.3], [-1.3, 1.95]])
    M = np.diag([0.04, 0.08])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    B = np.r_[0, 0, 700 / 0.04, 0][:, None]
    _, of_position = signal.freqresp(signal.StateSpace(A, B, [[-700, 0, 0, 0]], [[700]]), 2 * np.pi * FREQUENCY)
    assert impedance(hl.Scene(force=F, eom=eom), FREQUENCY) == pytest.approx(of_position / S, rel=1e-9)


def test_first_order_state_and_samples():
    F = s + b * v(n)
    scene = hl.Scene(force=F, eom=[sp.Eq(s.diff(t), r * (k * x(t) - s))])  # a spring behind a low-pass filter
    assert impedance(scene, FREQUENCY) == pytest.approx(1.3 + 700 / S / (1 + S / 25), rel=1e-12)


def test_nonlinear_scene_is_linearised_about_its_start():
    th = hl.coordinate("th", unit="rad", initial=0.4)
    g, length, K = hl.parameters("g l K", units="m/s^2 m N/m", values=(9.81, 0.2, 300))
    F = K * (x(t) - length * sp.sin(th))
    eom = sp.Eq(m * length**2 * th.diff(t, 2), F * length * sp.cos(th) - m * g * length * sp.sin(th))
    c, sine, place = np.cos(0.4), np.sin(0.4), -0.2 * np.sin(0.4)
    turning = 300 * 0.04 * c**2 + 300 * place * 0.2 * sine + 0.04 * 9.81 * 0.2 * c  # -d(torque)/d(th)
    swing = 300 * 0.2 * c / (0.04 * 0.04 * S**2 + turning)
    Z = impedance(hl.Scene(force=F, eom=[eom]), FREQUENCY)
    assert Z == pytest.approx(300 * (1 - 0.2 * c * swing) / S, rel=1e-10)


def test_refusals():
    with pytest.raises(AnalysisError, match=r"x\(n - 1\) uses past samples,"):
        impedance(hl.Scene(force=k * (x(n) - x(n - 1))), 1.0)
    with pytest.raises(ParameterError, match="k has no value"):
        impedance(hl.wall(), 1.0)
    with pytest.raises(AnalysisError, match="frequencies > 0"):
        impedance(hl.Scene(force=k * x(n)), [0.0, 1.0])
    with pytest.raises(AnalysisError, match="not a scene"):
        impedance(k, 1.0)
    with pytest.raises(AnalysisError, match="frequency is a SimulatedPaddle; needs numbers in Hz"):
        impedance(hl.Scene(force=k * x(n)), hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
