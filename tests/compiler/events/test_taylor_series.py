"""Taylor series of traced arithmetic against mpmath's derivatives, matrix exponentials and DOP853."""

import math

import mpmath as mp
import numpy as np
import pytest
from motions import program, rows
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from hapticlab.compiler.algebra.linear_solve import solve
from hapticlab.compiler.events.taylor_series import Series
from hapticlab.compiler.ir import trace
from hapticlab.compiler.ir.trace import Builder

#: the argument: a polynomial with no special coefficients
ARGUMENT = (0.3, 2.0, -0.5, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0)
OPERATIONS = {
    "sum": (lambda u: u + u * 3.0 - 2.0, lambda u: 4 * u - 2),
    "square": (lambda u: u * u, lambda u: u**2),
    "product": (lambda u: (u + 1.0) * trace.sin(u), lambda u: (u + 1) * mp.sin(u)),
    "quotient": (lambda u: (1.0 - u) / (2.0 + u * u), lambda u: (1 - u) / (2 + u**2)),
    "reciprocal": (lambda u: 1.0 / (2.0 + u), lambda u: 1 / (2 + u)),
    "sqrt": (lambda u: trace.sqrt(1.5 + u), lambda u: mp.sqrt(mp.mpf(3) / 2 + u)),
    "sin of cos": (lambda u: trace.sin(trace.cos(u)), lambda u: mp.sin(mp.cos(u))),
    "exp": (lambda u: trace.exp(-u), lambda u: mp.exp(-u)),
    "log": (lambda u: trace.log(1.0 + u), lambda u: mp.log(1 + u)),
    "atan": (lambda u: trace.atan(2.0 * u), lambda u: mp.atan(2 * u)),
    "tanh": (lambda u: trace.tanh(3.0 * u), lambda u: mp.tanh(3 * u)),
    "power": (lambda u: trace.exp(1.7 * trace.log(u)), lambda u: u ** (mp.mpf(17) / 10)),
}


@pytest.mark.parametrize("name", OPERATIONS)
def test_coefficients_are_the_derivatives(name):
    traced, exact = OPERATIONS[name]
    builder = Builder("f64")
    u = builder.leaf("input", 0, "f64")
    found = Series(builder.instructions, {u.id: list(ARGUMENT)}).of(traced(u), 8)
    with mp.workdps(40):
        argument = [mp.mpf(str(c)) for c in ARGUMENT]
        expected = [float(c) for c in mp.taylor(lambda t: exact(mp.polyval(argument[::-1], t)), 0, 8)]
    np.testing.assert_allclose([float(c) for c in found], expected, rtol=1e-12, atol=1e-13 * max(map(abs, expected)))


def test_arrays_give_a_jacobian():
    builder = Builder("f64")
    u, v = (builder.leaf("input", k, "f64") for k in range(2))
    y = trace.sin(u) * v + trace.exp(u * v)
    unit = np.eye(2)
    gradient = Series(builder.instructions, {u.id: [0.4, unit[0]], v.id: [1.3, unit[1]]}).of(y, 1)[1]
    e = math.exp(0.4 * 1.3)
    np.testing.assert_allclose(gradient, [math.cos(0.4) * 1.3 + 1.3 * e, math.sin(0.4) + 0.4 * e], rtol=1e-15)


def test_a_case_is_frozen_and_a_coefficient_not_known_is_said():
    builder = Builder("f64")
    u = builder.leaf("input", 0, "f64")
    y = trace.select(u < 1.0, u * 2.0, u * u)
    assert Series(builder.instructions, {u.id: [0.5, 3.0, 1.0]}).of(y, 2) == [1.0, 6.0, 2.0]
    with pytest.raises(IndexError, match="coefficient 3"):
        Series(builder.instructions, {u.id: [0.5, 3.0, 1.0]}).of(y, 3)


def test_free_flight_is_its_parabola_and_costs_no_more():
    flight = program(lambda tau, q, w, s: ([-9.81], []), [0.3], [2.0], T=1e-2, order=16)
    # q + h w + a h^2/2, w + a h, and the count of ticks that the test programs keep
    assert len(flight) == 5
    q, w = rows(flight, 40).T
    t = 1e-2 * np.arange(1, 41)
    np.testing.assert_allclose(q, 0.3 + 2.0 * t - 4.905 * t**2, rtol=0, atol=2e-15)
    np.testing.assert_allclose(w, 2.0 - 9.81 * t, rtol=0, atol=1e-14)


@pytest.mark.parametrize("omega_h, order", [(1.0, 18), (0.1, 9)])
def test_linear_motion_is_the_matrix_exponential(omega_h, order):
    T = 1e-3
    k, b = (omega_h / T) ** 2, 0.3 * omega_h / T
    A = np.array([[0, 0, 1, 0], [0, 0, 0, 1], [-k, 0.3 * k, -b, 0], [0.3 * k, -0.6 * k, 0, 0]])
    linear = program(
        lambda tau, q, w, s: ([-k * q[0] + 0.3 * k * q[1] - b * w[0], 0.3 * k * q[0] - 0.6 * k * q[1]], []),
        [0.01, -0.02], [0.5, 0.2], T=T, order=order,
    )  # fmt: skip
    y = np.array([0.01, -0.02, 0.5, 0.2])
    scale = np.array([1, 1, omega_h / T, omega_h / T])
    step = expm(A * T)
    for found in rows(linear, 50):
        y = step @ y
        np.testing.assert_allclose(found / scale, y / scale, rtol=0, atol=3e-15)


def test_smooth_nonlinear_motion_agrees_with_dop853():
    def rates(tau, q, w, s):
        c = trace.cos(q[0] - q[1])
        coupling = trace.sin(q[0] - q[1])
        M = [[2.0, c], [c, 1.0]]
        f = [-coupling * w[1] * w[1] - 19.62 * trace.sin(q[0]), coupling * w[0] * w[0] - 9.81 * trace.sin(q[1])]
        return solve(M, f, definite=True), [trace.tanh(q[0]) - 0.5 * s[0]]

    def plain(t, y):
        a, ds = rates(0.0, y[:2], y[2:4], y[4:])
        return [*y[2:4], *a, *ds]

    double = program(rates, [1.1, -0.4], [0.0, 0.3], first=[0.2], T=5e-3, order=16)
    t = 5e-3 * np.arange(1, 201)
    exact = solve_ivp(plain, (0, 1), [1.1, -0.4, 0.0, 0.3, 0.2], "DOP853", t, rtol=2.3e-14, atol=1e-15).y.T
    np.testing.assert_allclose(rows(double, 200), exact, rtol=0, atol=1e-12)


@pytest.mark.parametrize("order", [2, 4, 6])
@pytest.mark.always("4", "6")
def test_the_error_falls_with_the_order(order):
    def pendulum(tau, q, w, s):
        return [-9.81 * trace.sin(q[0]) - 0.2 * w[0] * w[0] * w[0]], []

    exact = rows(program(pendulum, [1.0], [0.0], T=1 / 64, order=18), 64)
    errors = [
        abs(rows(program(pendulum, [1.0], [0.0], T=1 / n, order=order), n) - exact[64 // n - 1 :: 64 // n]).max()
        for n in (16, 32)
    ]
    assert order - 0.4 < math.log2(errors[0] / errors[1]) < order + 1


def test_time_within_the_step_drives_as_a_series():
    driven = program(lambda tau, q, w, s: ([trace.sin(3.0 + 400.0 * tau)], []), [0.0], [0.0], T=2e-3, order=16)
    (q, w) = rows(driven, 1)[0]
    assert w == pytest.approx((math.cos(3.0) - math.cos(3.8)) / 400, rel=1e-14)
    assert q == pytest.approx(2e-3 * math.cos(3.0) / 400 - (math.sin(3.8) - math.sin(3.0)) / 160000, rel=1e-12)
