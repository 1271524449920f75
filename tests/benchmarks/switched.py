"""One tick of scenes that are linear between switches: their exact maps against four RK4 substeps of C by hand.

Every row is a scene at 1 kHz, the handle held from sample to sample. Beside the time stands the largest error of the
force in the first second, relative to its largest, against the closed form of each piece, its ends found by bracketing.
The target is judged where RK4 follows the motion: elsewhere it is fast because the ball is gone.
"""

import math

import numpy as np
import scenes
from floors import stepper
from timing import best_of, imported, row

from hapticlab.compiler.engines.engine import load

FLOOR, OURS = "C by hand, -O3, rk4 in 4 substeps", "hapticlab, exact"
STIFF = (1e3, 1e5, 1e7)  # N/m
TICKS, CHECKED = 5000, 1000


def rows(rounds):
    """Measure the wall at rising stiffness, and the ball; the ratio is to the C by hand in the same run."""
    found = []
    for k in STIFF:
        found += _rows("wall", scenes.coupler(), {**scenes.COUPLER, "k_w": k}, k, coupler_modes, rounds)
    for k in STIFF:
        found += _rows("ball", scenes.ball(), {**scenes.BALL, "K": k}, k, ball_modes, rounds)
    return found


def _rows(what, scene, values, k, modes, rounds):
    what, turns = f"{what}, {k:.0e} N/m", math.ceil(scenes.T * math.sqrt(1.1 * k / values["m"]))
    inputs = scenes.handle(TICKS) * (0.3 if scene.name == "ball" else 1.0)
    truth = reference(modes(values), inputs[:CHECKED], [0.05 if scene.name == "ball" else 0.0, 0.0])
    by_hand, force = stepper(f"{scene.name}_x4", inputs, values.values(), scenes.T)
    by_hand()
    calls, errors = {FLOOR: by_hand}, {FLOOR: _error(force, truth)}
    for name, method, options in (
        (OURS, "exact", {"live": []}), ("hapticlab, taylor", "taylor", {"substeps": turns}),
        ("hapticlab, rk4 in 4 substeps", "rk4", {"substeps": 4}),
    ):  # fmt: skip
        loaded = imported(lambda m=method, o=options: load(scenes.compiled(scene(**values), "float64", m, **o), "llvm"))
        run = calls[name] = lambda loaded=loaded: loaded.run(TICKS, inputs)
        errors[name] = _error(run().outputs[:, 0, 0], truth)
    seconds = best_of(rounds, **calls)
    return [
        row(
            f"{what}: {name}", s / TICKS, "ns", against=seconds[FLOOR] / TICKS, note=f"error {errors[name]:.1e}",
            target=["<= 0.3 x"] if name == OURS and errors[FLOOR] < 0.2 else [],
        )
        for name, s in seconds.items()
    ]  # fmt: skip


def _error(force, truth):
    if not np.isfinite(force[:CHECKED]).all():
        return np.inf
    return np.abs(force[:CHECKED] - truth).max() / np.abs(truth).max()


def coupler_modes(p):
    """Return (mode, force) of the mass on its coupler: mode(y, x, v) is y' = A y + b, and where it ends."""
    free = np.array([[0.0, 1.0], [-p["K"] / p["m"], -p["b"] / p["m"]]])
    wall = free - np.array([[0.0, 0.0], [p["k_w"] / p["m"], 0.0]])

    def mode(y, x, v):
        drive = (p["K"] * x + p["b"] * v) / p["m"]
        if _beyond(y[0] - p["x_w"], y[1]):
            return wall, np.array([0.0, drive + p["k_w"] * p["x_w"] / p["m"]]), [(np.array([1.0, 0.0]), -p["x_w"])]
        return free, np.array([0.0, drive]), [(np.array([-1.0, 0.0]), p["x_w"])]

    return mode, lambda y, x, v: p["K"] * (x - y[0]) + p["b"] * (v - y[1])


def ball_modes(p):
    """Return (mode, force) of the ball: it flies, or its contact pushes, or it is in contact that would pull."""
    k, b = p["K"] / p["m"], p["B"] / p["m"]
    flight, pushed = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0, 1.0], [-k, -b]])
    weight = np.array([0.0, -p["g"]])

    def mode(y, x, v):
        gap, lean = y[0] - x, -k * (y[0] - x) - b * (y[1] - v)
        push = np.array([-k, -b]), k * x + b * v
        apart = np.array([1.0, 0.0]), -x
        if _beyond(gap, y[1]):
            return flight, weight, [apart]
        if _beyond(lean, -k * y[1] + b * p["g"], 1e-12 * (k * abs(gap) + b * abs(y[1] - v))):
            return pushed, weight + [0.0, push[1]], [_minus(apart), push]
        return flight, weight, [_minus(apart), _minus(push)]

    def force(y, x, v):
        push = -p["K"] * (y[0] - x) - p["B"] * (y[1] - v)
        return max(0.0, push) if y[0] <= x else 0.0

    return mode, force


def _beyond(distance, rate, rounding=1e-15):
    """Tell on which side a motion goes on; within rounding of the surface its direction decides."""
    return distance > 0 if abs(distance) > rounding else rate > 0


def _minus(surface):
    return -surface[0], -surface[1]


def reference(modes, inputs, y):
    """Return the forces at the samples by the matrix exponential of each piece; ends are bracketed on 64 parts a tick."""
    (mode, force), y, found = modes, np.array(y), []
    for x, v in inputs:
        found.append(force(y, x, v))
        left = scenes.T
        while left > 0:
            A, b, surfaces = mode(y, x, v)
            y, taken = _piece(A, b, surfaces, y, left)
            left -= taken
    return np.array(found)


def _piece(A, b, surfaces, y, left):
    """Return the state where the first of c y + d >= 0 ends, and how long that took; after ``left`` where none does."""
    from scipy.linalg import expm
    from scipy.optimize import brentq

    system = np.zeros((3, 3))
    system[:2, :2], system[:2, 2] = A, b
    start = np.array([*y, 1.0])
    step = expm(system * left / 64)
    path = [start]
    for _ in range(64):
        path.append(step @ path[-1])
    path = np.array(path)
    ends = []
    for c, d in surfaces:
        row = np.array([*c, d])
        distance = path @ row
        inside = np.flatnonzero(distance[1:] < 0)
        if len(inside):
            k = inside[0]
            at = lambda t, k=k, row=row: row @ expm(system * t) @ path[k]  # noqa: E731
            edge = left / 64
            ends.append(k * edge + (brentq(at, 0.0, edge, xtol=1e-20, rtol=1e-15) if at(0.0) > 0 else 0.0))
    taken = min(ends, default=left)
    return (expm(system * taken) @ start)[:2], taken
