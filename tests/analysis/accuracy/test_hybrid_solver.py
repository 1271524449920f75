"""The second solver of a reference: events against closed forms, and what it does not do said in words."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, x
from hapticlab.analysis.accuracy import hybrid_solver
from hapticlab.analysis.accuracy.accelerations_at import instant
from hapticlab.analysis.accuracy.continuous_handle import DEGREE, coefficients
from hapticlab.analysis.accuracy.handle_motions import HandleMotion
from hapticlab.analysis.accuracy.reference import reference
from hapticlab.compiler.engines.engine import load

STEP = 1e-4
STILL = HandleMotion("still", sp.Float(0.0), 0.3)


def second(scene, motion, times):
    """Return F by the second solver alone."""
    middle = STEP * (np.arange(round(motion.duration / STEP) + 1) + 0.5)
    made = instant(scene, T=STEP)
    rows = coefficients(motion.derivatives(middle, DEGREE), STEP)
    field = hybrid_solver.Field(made, rows, STEP, load(made.program).once())
    x_0, v_0, _ = (float(part[0]) for part in motion.at([0.0]))
    return hybrid_solver.Hybrid(field).run(made.start(x_0, v_0), times, motion.breaks)


def seen(q, k=100.0):
    return hl.parameters("k_seen", units="N/m", values=k) * q


def body(law, **start):
    """Return (coordinate, model) of a body of 30 g that falls on the handle."""
    y = hl.coordinate("y", unit="m", **start)
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.03, 9.81))
    return y, hl.mechanics.lagrange(
        m * y.diff(t) ** 2 / 2 - m * g * y, contacts=[hl.contact.Contact(y - x(t), law, name="touch")]
    )


def test_a_body_on_the_handle_leaves_where_the_handle_falls_faster_than_it():
    w, A, g = 20.0, 0.04, 9.81
    motion = HandleMotion("shake", A * (1 - sp.cos(sp.Float(w) * t)), 0.3)
    y, falls = body(hl.contact.rigid())
    times = np.linspace(0, 0.3, 601)
    handle = A * (1 - np.cos(w * times))
    t_0 = np.arccos(-g / (A * w**2)) / w  # where x'' = -g
    since = times - t_0
    flight = A * (1 - np.cos(w * t_0)) + A * w * np.sin(w * t_0) * since - g * since**2 / 2
    assert (flight > handle)[since > 1e-3].all()  # it has not landed yet
    expected = np.where(since < 0, handle, flight)
    found = second(hl.Scene(force=seen(y), eom=[falls]), motion, times)
    assert (since > 0).sum() > 200
    assert np.abs(found - 100 * expected).max() < 1e-8  # rtol = 1e-10, atol = 1e-13 a step


def test_a_bounce_is_newtons():
    y, falls = body(hl.contact.impulse(e=hl.parameters("e", units="1", values=0.6, ranges=(0, 1))), initial=0.02)
    times = np.linspace(0, 0.15, 301)
    hit = np.sqrt(2 * 0.02 / 9.81)
    since = times - hit
    up = 0.6 * 9.81 * hit
    expected = np.where(since < 0, 0.02 - 9.81 * times**2 / 2, up * since - 9.81 * since**2 / 2)
    known = since < 2 * up / 9.81
    found = second(hl.Scene(force=seen(y), eom=[falls]), STILL, times)
    assert np.abs(found - 100 * expected)[known].max() < 1e-9 and known.sum() > 250


def test_stick_and_slip_have_the_period_of_the_closed_form():
    # drawn at constant speed u through K: it slips 2 (F_s - F_c)/K when u is small, and the force falls by twice that
    u, K, m, F_s, F_c = 2e-3, 400.0, 0.05, 1.0, 0.6
    z = hl.coordinate("z", unit="m")
    p = hl.parameters("m K F_s F_c", units="kg N/m N N", values=(m, K, F_s, F_c))
    F = p[1] * (x(t) - z)
    drawn = hl.mechanics.lagrange(
        p[0] * z.diff(t) ** 2 / 2, forces={z: F}, contacts=[hl.contact.friction(slip=z.diff(t), coulomb=p[3], breakaway=p[2])]
    )
    scene, motion = hl.Scene(force=F, eom=[drawn]), HandleMotion("draw", sp.Float(u) * t, 1.5)
    times = np.linspace(0, 1.5, 15001)
    found = second(scene, motion, times)
    w = np.sqrt(K / m)
    # slipping from rest at F_s: q = stretch - F_c/K obeys q'' = -w^2 q, q(0) = (F_s - F_c)/K, q'(0) = u
    t_b = F_s / (K * u)
    first = times[times < t_b]
    assert np.abs(found[: len(first)] - K * u * first).max() < 1e-10
    since = times - t_b
    # it sticks again where the block stands still: q' = u, after 2 pi - 2 atan(w q0/u) less than a turn
    back = (2 * np.pi - 2 * np.arctan2(u, w * (F_s - F_c) / K) - np.pi) / w
    slips = (since > 0) & (since < back)
    q = (F_s - F_c) / K * np.cos(w * since) + u / w * np.sin(w * since)
    assert slips.sum() > 200
    assert np.abs(found - (F_c + K * q))[slips].max() < 1e-8


@pytest.mark.wide
def test_two_contacts_at_once_have_one_solver():
    y, _ = body(hl.contact.rigid())
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.03, 9.81))
    z = hl.coordinate("z", unit="m", initial=0.01)
    law = hl.contact.impulse(e=0)
    contacts = [hl.contact.Contact(y - x(t), law, name="low"), hl.contact.Contact(z - y, law, name="high")]
    stack = hl.mechanics.lagrange(m * (y.diff(t) ** 2 + z.diff(t) ** 2) / 2 - m * g * (y + z), contacts=contacts)
    found = reference(hl.Scene(force=seen(z), eom=[stack]), STILL)
    assert not found.certified and "two contacts touch at once" in found.how


def test_a_motion_too_stiff_for_both_is_left(monkeypatch):
    monkeypatch.setattr(hybrid_solver, "MOST_STEPS", 20)
    found = reference(hl.library.mass_spring_damper(), HandleMotion("sine", 0.01 * sp.sin(9 * t), 0.3))
    assert not found.certified and "too stiff" in found.how


def test_friction_that_is_stiff_goes_to_a_solver_for_it():
    # F_c tanh(v/v_s): it answers within m v_s/F_c = 50 us, where an explicit solver's step must stay below
    motion = HandleMotion("sine", 0.02 * sp.sin(9 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.08)
    found = reference(hl.library.stick_slip(stick_speed=5e-4), motion)
    assert "LSODA" in found.how
    assert found.agreement < 1e-7 * found.peak  # rtol = 1e-10 over some thousand steps


@pytest.mark.parametrize("stiffness", [2e3, 2e5])
@pytest.mark.always("200000.0")
def test_penalty_contacts_shorter_than_a_sample_are_certified(stiffness):
    k_b = hl.parameters("k_b", units="N/m", values=1e3)
    scene = hl.library.ball_on_the_paddle(hl.contact.penalty(k=k_b))(k_b=stiffness)  # 2e5 N/m: in contact for 1.1 ms
    motion = HandleMotion("sine", 0.004 * sp.sin(2 * sp.pi * 5.3 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.6)
    found = reference(scene, motion)
    assert found.agreement < 1e-6 * found.peak, str(found)
