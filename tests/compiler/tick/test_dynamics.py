"""A model's equations while a program runs: driven motions late, models beside equations, notes, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from motions import at_tick

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import MassError, ParameterError, SceneError
from hapticlab.scene.notation.derivative import Rate

m, l, g, k, a = hl.parameters("m l g k a", units="kg m m/s^2 N/m m", values=(0.1, 0.1, 9.81, 20.0, 0.01))
f = hl.parameters("f", units="1/s", values=25.25)
z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
phi = hl.coordinate("phi", unit="rad", initial=hl.parameters("phi_0", units="rad", values=2.5))


def kapitza():
    """A pendulum on a support that shakes, a sin(2 pi f t): the rate of the angle is in its Lagrangian."""
    lifted = a * sp.sin(2 * sp.pi * f * t)
    vx, vy = (l * sp.sin(phi)).diff(t), lifted.diff(t) + l * sp.sin(phi) * phi.diff(t)
    return hl.mechanics.lagrange(m * (vx**2 + vy**2) / 2 - m * g * (lifted - l * sp.cos(phi)))


def kapitza_with_rate():
    """The same, the rate of the support left for the compiler to take."""
    lifted = a * sp.sin(2 * sp.pi * f * t)
    vy = Rate(lifted) + l * sp.sin(phi) * phi.diff(t)
    return hl.mechanics.lagrange(m * ((l * sp.cos(phi) * phi.diff(t)) ** 2 + vy**2) / 2 - m * g * (lifted - l * sp.cos(phi)))


def swung(mech, late, dtype="float64", ticks=40, T=1e-3):
    """Return the angle over some ticks, from a tick number on."""
    program = hl.compile(hl.Scene(force=0, eom=[mech], watch=["phi"]), T=T, dtype=dtype)
    inputs = np.zeros((ticks, len(program.inputs)))
    machine = load(program)
    start = np.array(machine.run(1, inputs[:1]).states)
    first = {"phi": 2.5, "phi'": 0.3}
    for j, s in enumerate(program.states):
        start[j] = first.get(s.name, start[j] if s.name.startswith("x") else 0.3)
    return machine.run(ticks, inputs, states=at_tick(program, late, start)).outputs[:, 1, 0]


@pytest.mark.parametrize("model", [kapitza, kapitza_with_rate])
@pytest.mark.parametrize(("dtype", "late"), [("float64", 2**48 - 2**17), ("float32", 2**33 - 2**17)])
@pytest.mark.always("float64-*-kapitza", "float32-*-kapitza_with_rate")
def test_a_shaken_pendulum_is_as_exact_late(model, dtype, late):
    T = 2.0**-10  # 25.25 turns a second are exact then, and whole after 4096 ticks
    early, after = swung(model(), 0, dtype, T=T), swung(model(), late, dtype, T=T)
    np.testing.assert_array_equal(after, early)
    assert np.abs(early - 2.5).max() > 0.01  # it does move


def test_the_shaken_pendulum_is_shaken_as_written():
    mech = kapitza()
    T, ticks = 2.5e-4, 80
    got = swung(mech, 0, ticks=ticks, T=T)
    state, w, h = np.array([2.5, 0.3]), 2 * np.pi * 25.25, T / 4
    for j in range(4 * (ticks - 1)):  # classical Runge-Kutta on the equation by hand, at a quarter of the step

        def rate(s, at):
            return np.array([s[1], -(9.81 - 0.01 * w**2 * np.sin(w * at)) / 0.1 * np.sin(s[0])])

        one = rate(state, j * h)
        two = rate(state + h / 2 * one, (j + 0.5) * h)
        three = rate(state + h / 2 * two, (j + 0.5) * h)
        state = state + h / 6 * (one + 2 * two + 2 * three + rate(state + h * three, (j + 1) * h))
    assert got[-1] == pytest.approx(state[0], abs=1e-8)


SPRING = k * (z - l * phi) ** 2 / 2
PENDULUM = m * (l * phi.diff(t)) ** 2 / 2 + m * g * l * sp.cos(phi)


def test_a_model_beside_an_equation():
    """A pendulum by its Lagrangian, a mass on a spring to it by an equation; and both by one Lagrangian."""
    model = hl.mechanics.lagrange(PENDULUM, forces={phi: k * l * (z - l * phi)})
    own = sp.Eq(m * z.diff(t, 2), k * (l * phi - z))
    outputs = []
    for eom in ([model, own], [hl.mechanics.lagrange(PENDULUM + m * z.diff(t) ** 2 / 2 - SPRING)]):
        program = hl.compile(hl.Scene(force=0, eom=eom, watch=["phi", "z"]), T=1e-3, dtype="float64")
        outputs.append(load(program).run(50, np.zeros((50, len(program.inputs)))).outputs)
    np.testing.assert_allclose(outputs[0], outputs[1], rtol=1e-12)


def test_a_coordinate_is_moved_once():
    own = sp.Eq(m * z.diff(t, 2), k * (l * phi - z))
    scene = hl.Scene(force=0, eom=[hl.mechanics.lagrange(PENDULUM - SPRING), own], watch=["phi"])
    with pytest.raises(
        MassError, match="z is moved by a Lagrangian, which moves every coordinate in it, and also by an equation of its own."
    ):
        hl.compile(scene, T=1e-3)


def test_notes_of_a_model_are_in_the_listing():
    mech = replace(hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2 - k * z**2 / 2), notes=("q of the model is called z here",))
    assert "q of the model is called z here" in hl.compile(hl.Scene(force=0, eom=[mech], watch=["z"]), T=1e-3).notes


def test_constraints_need_numbers():
    r = hl.parameters("r", units="m")
    mech = hl.mechanics.lagrange(m * (z.diff(t) ** 2 + y.diff(t) ** 2) / 2, constraints=[z - 2 * y - r])
    with pytest.raises(ParameterError, match=r"r needs a value to check the constraints: scene\(r=...\)"):
        hl.compile(hl.Scene(force=0, eom=[mech], watch=["z"]), T=1e-3)


def test_an_equation_may_not_hold_what_a_constraint_determines():
    mech = hl.mechanics.lagrange(m * (z.diff(t) ** 2 + y.diff(t) ** 2) / 2, constraints=[z - 2 * y])
    other = hl.coordinate("w", unit="m")
    scene = hl.Scene(force=0, eom=[mech, sp.Eq(m * other.diff(t, 2) + m * z.diff(t, 2), 0)], watch=[other])
    with pytest.raises(SceneError, match=r"equation of w contains the acceleration of z, which a constraint determines;"):
        hl.compile(scene, T=1e-3)


def test_a_handle_in_an_energy_pulls_by_its_motion():
    """A mass on a spring to the handle, by energy and by equation, is one program's motion."""
    q = hl.coordinate("q", unit="m", initial=x(n))
    by_energy = hl.mechanics.lagrange(m * q.diff(t) ** 2 / 2 - k * (q - x(t)) ** 2 / 2)
    by_hand = sp.Eq(m * q.diff(t, 2), k * (x(t) - q))
    lead = 0.01 * np.sin(np.arange(60) / 7.0)[:, None]
    runs = [
        load(hl.compile(hl.Scene(force=0, eom=[e], watch=[q]), T=1e-3, dtype="float64")).run(60, lead).outputs
        for e in (by_energy, by_hand)
    ]
    np.testing.assert_allclose(runs[0], runs[1], rtol=1e-12, atol=1e-16)
