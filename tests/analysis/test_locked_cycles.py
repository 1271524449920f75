"""Locked chatter cycles against two independent derivations: a fixed point of closed forms, and scipy with located events."""

import math

import numpy as np
import pytest

import hapticlab as hl

pytest.importorskip("llvmlite")  # some ten thousand ticks
M, B, T, PUSH = 0.05, 0.3, 1e-3, 1.0


def locked(k, coulomb=0.0, seconds=20.0):
    paddle = hl.SimulatedPaddle(m=M, b=B, T=T, coulomb=coulomb, hand=hl.Hand(push=PUSH))
    log = paddle.run(hl.wall()(k=k), duration=seconds, dtype="float64", progress=False)
    return log, hl.chatter(log)


@pytest.mark.parametrize(("k", "samples"), [(2000, 84), (3000, 100)])
def test_a_locked_cycle_is_a_fixed_point_of_the_held_motion(k, samples):
    """M v' = push - F - b v in closed form over each period; one cycle is an affine map, and its fixed point the cycle."""
    log, found = locked(k)
    assert found.locked and found.period == samples
    x = log.x[-samples - 1 :]
    a = math.exp(-B * T / M)
    step = np.array([[1.0, (1 - a) * M / B], [0.0, a]])
    force = np.array([(T - (1 - a) * M / B) / B, (1 - a) / B])
    A, c = np.eye(2), np.zeros(2)
    maps = []
    for inside in x[:-1] >= 0:
        one = step - np.outer(force, [k, 0.0]) if inside else step
        A, c = one @ A, one @ c + PUSH * force
        maps.append((A, c))
    start = np.linalg.solve(np.eye(2) - A, c)
    cycle = np.array([start[0], *((A @ start + c)[0] for A, c in maps)])
    assert (cycle[:-1] >= 0).tolist() == (x[:-1] >= 0).tolist()  # the contacts that were assumed
    assert abs(np.linalg.eigvals(A)).max() < 1  # it attracts
    assert cycle == pytest.approx(x, abs=5e-9 * np.ptp(x))  # what is left of the way to it after 20 s
    assert found.amplitude == pytest.approx(np.ptp(cycle) / 2, rel=2e-4)  # about the record's straight line
    assert found.frequency == pytest.approx(1 / (samples * T), rel=1e-4)  # interpolated crossings


def test_a_cycle_with_coulomb_friction_closes_in_located_events():
    """scipy from the cycle's own start: every turn of the handle is an event, and one cycle later it is back."""
    from scipy.integrate import solve_ivp

    k, coulomb = 3000, 0.02
    log, found = locked(k, coulomb, seconds=10.0)
    assert found.locked and found.period
    first = len(log) - found.period - 2
    state, travel = np.array([log.x[first], log.v[first]]), []
    for _ in range(found.period):
        F, left = k * max(state[0], 0.0), T
        while left > 1e-15:
            way = np.sign(state[1]) or np.sign(PUSH - F)  # |push - F| > friction wherever it turns here
            turn = lambda t, y: y[1]  # noqa: E731
            turn.terminal, turn.direction = True, -way
            rate = lambda t, y, F=F, way=way: (y[1], (PUSH - F - B * y[1] - way * coulomb) / M)  # noqa: E731
            made = solve_ivp(rate, (0.0, left), state, method="DOP853", rtol=1e-12, atol=1e-14, events=turn)
            state, left = made.y[:, -1].copy(), left - made.t[-1]
            if left > 1e-15:
                state[1] = 0.0
        travel.append(state[0])
    size = np.ptp(travel)
    assert travel == pytest.approx(log.x[first + 1 : first + 1 + found.period], abs=1e-7 * size)
    assert state[0] == pytest.approx(log.x[first], abs=2e-4 * size)  # the cycle repeats itself to what `period` promises
