"""Pendulums against the elliptic period and the eigenvalues of the upright pole."""

import numpy as np
from scipy.linalg import solve_continuous_are
from scipy.special import ellipk

import hapticlab as hl
from hapticlab.compiler.engines import engine


def crossings(t, y):
    """Return the times at which y passes zero, by a cubic through the four samples around each."""
    found = []
    for k in np.flatnonzero(y[1:-2] * y[2:-1] < 0) + 1:
        roots = np.roots(np.polyfit(np.arange(-1, 3), y[k - 1 : k + 3], 3))
        inside = [r.real for r in roots if abs(r.imag) < 1e-9 and 0 <= r.real <= 1]
        found.append(t[k] + inside[0] * (t[1] - t[0]))
    return np.array(found)


def test_a_pendulum_on_a_held_carriage_has_the_elliptic_period(led):
    p = {"l": 0.2, "g": 9.81, "m": 0.05}
    scene = hl.library.pendulum_on_the_handle()(**p, M=1e9, c=0, K=0, b_c=0)  # so heavy a carriage does not move
    log = led(scene, np.zeros(20_000), T=2e-4, start={"theta": 2.0})
    period = 4 * np.sqrt(p["l"] / p["g"]) * ellipk(np.sin(1.0) ** 2)
    at = crossings(log.t, log.theta)
    assert len(at) >= 6
    assert np.abs(np.diff(at) - period / 2).max() < 1e-7


def test_a_pendulum_on_a_free_carriage_swings_about_their_centre(led):
    p = {"l": 0.2, "g": 9.81, "m": 0.08, "M": 0.05}
    scene = hl.library.pendulum_on_the_handle()(**p, c=0, K=0, b_c=0)
    log = led(scene, np.zeros(8000), T=2e-4, start={"theta": 1e-4})
    w = np.sqrt(p["g"] * (p["M"] + p["m"]) / (p["M"] * p["l"]))
    assert np.abs(log.theta - 1e-4 * np.cos(w * log.t)).max() < 1e-10  # theta^3 and (w T)^4
    centre = p["M"] * log.z + p["m"] * (log.z + p["l"] * np.sin(log.theta))
    assert np.ptp(centre) < 1e-15


def test_the_pole_falls_with_its_unstable_eigenvalue_and_energy_is_kept(led):
    p = {"l": 0.25, "g": 9.81, "m": 0.06, "M": 0.09}
    scene = hl.library.cart_pole()(**p, c=0, K=0, b_c=0)
    log = led(scene, np.zeros(3000), T=2e-4, start={"theta": 1e-6})
    w = np.sqrt(p["g"] * (p["M"] + p["m"]) / (p["M"] * p["l"]))
    small = log.theta < 1e-3
    exact = 1e-6 * np.cosh(w * log.t)
    assert small.sum() > 2000
    assert np.abs(log.theta[small] / exact[small] - 1).max() < 1e-6


def regulator(p):
    """Return the gains on (z, theta, x) and their rates of a hand that accelerates x, least squares on linear equations."""
    mass = np.array([[p["M"] + p["m"], p["m"] * p["l"], 0], [p["m"] * p["l"], p["m"] * p["l"] ** 2, 0], [0, 0, 1]])
    spring = np.array([[-p["K"], 0, p["K"]], [0, p["m"] * p["g"] * p["l"], 0], [0, 0, 0]])
    damper = np.array([[-p["b_c"], 0, p["b_c"]], [0, -p["c"], 0], [0, 0, 0]])
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [np.linalg.solve(mass, spring), np.linalg.solve(mass, damper)]])
    B = np.eye(6)[:, 5:]
    return (B.T @ solve_continuous_are(A, B, np.diag([1, 1, 1, 0, 0, 0]), [[1e-2]])).ravel() / 1e-2


def test_held_still_the_pole_falls_and_a_regulator_for_a_hand_balances_it():
    scene, T = hl.library.cart_pole(), 1e-3
    program = hl.compile(scene, T=T, dtype="float64")
    names, loaded, gains = [c.name for c in program.outputs], engine.load(program), regulator(scene.values)
    for hand in (0.0, 1.0):
        x = v = 0.0
        states, q, leans = None, np.array([0.0, 0.01]), []
        for _ in range(4000):
            run = loaded.run(1, [[x]], program.values, states)
            states, before, q = run.states, q, run.outputs[0, [names.index("z"), names.index("theta")], 0]
            leans.append(q[1])
            v -= hand * T * gains @ [*q, x, *(q - before) / T, v]
            x += T * v
            assert abs(x) < 0.05
        if hand:
            assert max(np.abs(leans)) < 0.1
            assert abs(leans[-1]) < 1e-4
        else:
            assert max(np.abs(leans)) > 1.5
