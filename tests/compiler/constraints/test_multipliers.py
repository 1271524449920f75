"""Constrained equations of motion: the linear algebra against NumPy, the feedback limits against their closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab.compiler.algebra import expressions
from hapticlab.compiler.constraints.multipliers import check_feedback, embedded, largest_feedback, multipliers, stiffened
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.events.taylor_method import Taylor
from hapticlab.compiler.ir.trace import Builder
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import ProgramLimitError, SceneError


def system(N, m, seed=1):
    generator = np.random.default_rng(seed)
    A, J = generator.normal(size=(N, N)), generator.normal(size=(m, N))
    J[0, 1] = 0.0
    return A @ A.T + np.eye(N), J, generator.normal(size=N), generator.normal(size=m)


def reference(M, J, f, c):
    m = len(c)
    solution = np.linalg.solve(np.block([[M, -J.T], [J, np.zeros((m, m))]]), np.concatenate([f, c]))
    return solution[: len(f)], solution[len(f) :]


@pytest.mark.parametrize(("N", "m"), [(2, 1), (3, 2), (6, 3)])
def test_multipliers(N, m):
    M, J, f, c = system(N, m)
    a, forces = multipliers(*(part.tolist() for part in (M, J, f, c)))
    wanted, reactions = reference(M, J, f, c)
    np.testing.assert_allclose(a, wanted, rtol=1e-12)
    np.testing.assert_allclose(forces, reactions, rtol=1e-12)


def test_a_coordinate_without_mass_is_carried_by_the_constraints():
    M, J, f, c = system(4, 2)
    M[3] = M[:, 3] = 0.0
    wanted, reactions = reference(M, J, f, c)
    stiff = stiffened(*(part.tolist() for part in (M, J, f, c)), 0.7)
    a, forces = multipliers(stiff[0], J.tolist(), stiff[1], c.tolist())
    np.testing.assert_allclose(a, wanted, rtol=1e-11)
    np.testing.assert_allclose(forces, reactions, rtol=1e-11)


def test_embedding_is_the_projection_on_what_is_free():
    M, J, f, c = system(5, 3)
    # B spans the null space of J, b is any solution of J b = c
    B = np.linalg.svd(J)[2][3:].T
    b = np.linalg.lstsq(J, c, rcond=None)[0]
    w = embedded(M.tolist(), f.tolist(), B.tolist(), b.tolist())
    np.testing.assert_allclose(B @ w + b, reference(M, J, f, c)[0], rtol=1e-12)


@pytest.mark.parametrize(("real", "apart"), [("f64", 1e-9), ("f32", 1e-4)])
def test_a_rank_that_is_lost_while_running_is_not_finite(real, apart):
    def traced(angle):
        builder = Builder(real)
        M = [[builder.const(float(i == j)) for j in range(3)] for i in range(3)]
        J = [[1.0, 0.0, 0.0], [math.cos(angle), math.sin(angle), 0.0]]
        J = [[builder.const(entry) for entry in row] for row in J]
        lost = {"f64": 4e-15, "f32": 2e-6}[real]
        a, _ = multipliers(M, J, [builder.const(0.3)] * 3, [builder.const(0.0), builder.const(0.1)], lost)
        return [value.constant for value in a]

    assert np.isfinite(traced(100 * apart)).all()
    assert not np.isfinite(traced(apart)).all()


def test_feedback_limits():
    limits = {name: largest_feedback(method) for name, method in METHODS.items() if name in CLOSED}
    assert limits == pytest.approx(CLOSED, abs=1e-7)


#: on the double pole -alpha: the real axis of the stability region, and for semi-implicit Euler the zeta = 1 entry
CLOSED = {
    "euler": 2, "semi_implicit_euler": 2 * (math.sqrt(2) - 1), "semi_implicit_euler_damped": 2 * (math.sqrt(2) - 1),
    "verlet": 1, "midpoint": 2, "heun": 2, "ssprk3": 2.5127453266183286, "rk4": 2.785293563405282, "adams_bashforth2": 1,
    "adams_bashforth3": 6 / 11,
}  # fmt: skip


def swinging(enforce):
    """A pendulum in X and Y, from the horizontal."""
    m, g, l = hl.parameters("m g l", units="kg m/s^2 m", values=(0.1, 9.81, 0.1))
    X, Y = hl.coordinate("X", unit="m", initial=0.1), hl.coordinate("Y", unit="m")
    L = m * (X.diff(hl.t) ** 2 + Y.diff(hl.t) ** 2) / 2 - m * g * Y
    return hl.Scene(0, [hl.mechanics.lagrange(L, constraints=[X**2 + Y**2 - l**2], enforce=enforce)], watch={"X": X, "Y": Y})


def test_multipliers_past_the_limit_say_what_takes_less(monkeypatch):
    monkeypatch.setattr(expressions, "MOST_INSTRUCTIONS", 2500)
    with pytest.raises(ProgramLimitError, match="enforce='embed'.*'rk4'"):
        hl.compile(swinging("kkt"), T=1e-3, method="taylor", dtype="float64")


def test_a_taylor_series_takes_a_radian_of_feedback():
    assert largest_feedback(Taylor()) == 1
    scene = swinging("baumgarte")
    program = hl.compile(scene, T=1e-3, method="taylor", dtype="float64", live=())
    assert any("alpha = 500 1/s" in note for note in program.notes)
    out = load(program).run(1000, np.zeros((1000, len(program.inputs)))).outputs[:, :, 0]
    turn = solve_ivp(
        lambda s, u: [u[1], -98.1 * math.sin(u[0])], (0, 1), [math.pi / 2, 0], "DOP853", 1e-3 * np.arange(1000),
        rtol=1e-12, atol=1e-13,
    ).y[0]  # fmt: skip
    np.testing.assert_allclose(out[:, 1], 0.1 * np.sin(turn), rtol=0, atol=1e-11)


def test_too_much_feedback_is_refused():
    check_feedback(500.0, METHODS["semi_implicit_euler"], 1e-3)
    with pytest.raises(SceneError, match=r"alpha = 900 1/s.*alpha < 828\.4 1/s"):
        check_feedback(900.0, METHODS["semi_implicit_euler"], 1e-3)
    with pytest.raises(SceneError, match=r"alpha = 0 1/s"):
        check_feedback(0.0, METHODS["rk4"], 1e-3)
