"""A linear scene as masses, springs and dampers behind the handle: read off its equations, and written as a scene."""

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ...errors import AnalysisError
from ...scene.notation.parameters import Parameter
from ...scene.notation.symbols import coordinate, n, t, v, x
from ...scene.scene import Scene

#: parts of an equation that differ by less are the same; smaller ones are rounding
ROUNDING = 1e-9


@dataclass(frozen=True)
class Network:
    """Symmetric matrices of the handle, entry 0, and the masses behind it.

    Attributes
    ----------
    mass : array of shape (N, N)
        Positive definite [kg]; the handle itself has none.
    damping, stiffness : array of shape (1 + N, 1 + N)
        Positive semidefinite.
    start : array of shape (2, 2, N)
        Positions and rates at the first sample: constant part, and part of the handle's position.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    start: np.ndarray

    def impedance(self, frequency):
        """Return F/v at frequencies [Hz], complex, shape (P,)."""
        s = (2j * np.pi * frequency)[:, None, None]
        forces = s * self.damping + self.stiffness
        motion = -np.linalg.solve(s * s * self.mass + forces[:, 1:, 1:], forces[:, 1:, :1])
        return ((forces[:, :1, :1] + forces[:, :1, 1:] @ motion) / s)[:, 0, 0]

    @property
    def of_unit_masses(self):
        """The same with unit masses, and Q with z = Q y."""
        Q = np.linalg.inv(np.linalg.cholesky(self.mass)).T
        T = _beside_handle(Q)
        start = np.einsum("ij,abj->abi", np.linalg.inv(Q), self.start)
        return Network(np.eye(len(Q)), T.T @ self.damping @ T, T.T @ self.stiffness @ T, start)


def _beside_handle(V):
    """Return V with the handle kept as it is."""
    T = np.zeros((len(V) + 1, V.shape[1] + 1))
    T[0, 0], T[1:, 1:] = 1.0, V
    return T


def network_of(scene, port):
    """Return the network of a scene's ``Port``; refuse what is none, with the reason."""
    N = len(port.coordinates)
    masses = ~np.isclose(np.abs(port.M).max(axis=0, initial=0.0), 0.0)
    if not masses.all() or not N:
        first = [type(q).__name__ for q, has in zip(port.coordinates, masses, strict=True) if not has]
        what = f"{', '.join(first)} has no mass" if first else "it has none"
        raise AnalysisError(f"{scene.name}: a reduction needs masses behind the handle, and {what}")
    scale = _row_scale(scene, port)
    mass = scale[:, None] * port.M
    matrices = [
        np.block([[np.array([[own]]), row[None, :]], [(scale * column)[:, None], scale[:, None] * inside]])
        for own, row, column, inside in ((port.c, port.CF, port.Cx, port.C), (port.k, port.KF, port.Kx, port.K))
    ]
    damping, stiffness = ((a + a.T) / 2 for a in matrices)
    mass = (mass + mass.T) / 2
    for what, matrix in (("mass", mass), ("damping", damping), ("stiffness", stiffness)):
        values = np.linalg.eigvalsh(matrix)
        if values[0] < -ROUNDING * abs(values).max() or (what == "mass" and values[0] <= 0):
            raise AnalysisError(
                f"{scene.name}: its {what} is negative in some direction ({values[0]:.3g}), so the scene is not passive and "
                "has no passivity to preserve; needs masses > 0, springs and dampers >= 0"
            )
    return Network(mass, damping, stiffness, _starts(scene, port))


def _row_scale(scene, port):
    """Factors of the equations that make the matrices symmetric: how an equation was written is free."""
    N, rows, right = len(port.coordinates), [], []
    for inside, by_handle, on_handle in ((port.M, None, None), (port.C, port.Cx, port.CF), (port.K, port.Kx, port.KF)):
        for i in range(N):
            for j in range(i):
                size = max(abs(inside[i, j]), abs(inside[j, i]))
                if size > 0:
                    rows.append(np.eye(N)[i] * inside[i, j] / size - np.eye(N)[j] * inside[j, i] / size)
                    right.append(0.0)
            size = 0.0 if by_handle is None else max(abs(by_handle[i]), abs(on_handle[i]))
            if size > 0:
                rows.append(np.eye(N)[i] * by_handle[i] / size)
                right.append(on_handle[i] / size)
    scale = np.linalg.lstsq(np.array(rows).reshape(-1, N), np.array(right), rcond=None)[0]
    off = np.abs(np.array(rows).reshape(-1, N) @ scale - right).max(initial=0.0)
    if off > ROUNDING * 100 * max(1.0, np.abs(scale).max(initial=0.0)) or not np.all(np.abs(scale) > ROUNDING):
        raise AnalysisError(
            f"{scene.name}: the springs and dampers that move the masses do not act on the handle in the same way, so there "
            "is no network of masses to reduce. Use the force that moves the first mass as the force of the scene"
        )
    return scale


def _starts(scene, port):
    found = np.zeros((2, 2, len(port.coordinates)))
    values = {p: sp.Float(scene.values[name]) for name, p in scene.parameters.items()}
    for j, q in enumerate(port.coordinates):
        for i, given in enumerate((type(q).initial, type(q).rate)):
            given = given.xreplace(values)
            at_zero = given.xreplace({x(n): sp.S.Zero, v(n): sp.S.Zero})
            slope = (given - at_zero).xreplace({x(n): sp.S.One})
            if not (at_zero.is_number and slope.is_number):
                raise AnalysisError(
                    f"{scene.name}: {type(q).__name__} starts at {given}; a reduction needs a number or a multiple of x(n)"
                )
            found[i, :, j] = float(at_zero), float(slope)
    return found


def modal(stiffness, damping, start):
    """Return a network of the handle and unit masses, turned and sized so that springs join masses to the handle alone.

    Parameters
    ----------
    stiffness, damping : array of shape (1 + N, 1 + N)
    start : array of shape (2, 2, N)
        As in :class:`Network`.
    """
    _, U = np.linalg.eigh(stiffness[1:, 1:])
    T = _beside_handle(U)
    stiffness, damping = T.T @ stiffness @ T, T.T @ damping @ T
    stiffness[1:, 1:] = np.diag(np.diag(stiffness)[1:])
    pull, hold = stiffness[0, 1:], np.diag(stiffness)[1:]
    springs = np.abs(pull) > ROUNDING * np.sqrt(np.abs(stiffness[0, 0] * hold))
    size = np.where(springs, -pull / np.where(springs, hold, 1.0), 1.0)  # then it rests where the handle does
    S = np.diag(np.r_[1.0, size])
    return Network(np.diag(size**2), S @ damping @ S, S @ stiffness @ S, np.einsum("ji,abj->abi", U, start) / size)


def scene_of(network, name):
    """Return a network of diagonal mass as a scene: r_1, r_2, ... behind the handle, k_0 and b_0 between it and the ground.

    Springs and dampers between i and j are k_ij and b_ij; k_i and b_i are between the handle and r_i, k_ii and b_ii
    between r_i and the ground.
    """
    N = len(network.mass)
    values, places, rates = {}, [x(t)], [v(t)]

    def parameter(name, unit, value):
        values[name] = float(value)
        return Parameter(name, unit)

    for i in range(1, N + 1):
        position, speed = (_start(parameter, i, k, *network.start[k, :, i - 1]) for k in range(2))
        r = coordinate(f"r_{i}", unit="m", initial=position, rate=speed)
        places.append(r)
        rates.append(r.diff(t))
    forces = [sp.S.Zero] * (N + 1)
    for letter, unit, matrix, motion in (
        ("k", "N/m", network.stiffness, places), ("b", "N*s/m", network.damping, rates),
    ):  # fmt: skip
        least = 1e-12 * np.abs(matrix).max(initial=0.0)
        for i in range(N + 1):
            grounded = matrix[i].sum()
            if abs(grounded) > least:
                forces[i] += parameter(_element(letter, i, i), unit, grounded) * motion[i]
            for j in range(i + 1, N + 1):
                if abs(matrix[i, j]) > least:
                    pull = parameter(_element(letter, i, j), unit, -matrix[i, j]) * (motion[i] - motion[j])
                    forces[i], forces[j] = forces[i] + pull, forces[j] - pull
    eom = [
        sp.Eq(parameter(f"m_{i}", "kg", network.mass[i - 1, i - 1]) * places[i].diff(t, 2), -forces[i]) for i in range(1, N + 1)
    ]
    return Scene(force=forces[0], eom=eom, values=values, name=name)


def _element(letter, i, j):
    if i == j:
        return f"{letter}_{i}{i}" if i else f"{letter}_0"
    return f"{letter}_{i}{j}" if i else f"{letter}_{j}"


def _start(parameter, i, order, constant, of_handle):
    """Return a start as an expression: a parameter, and a multiple of the handle's position."""
    rate = f"dr_{i}_0" if order else f"r_{i}_0"
    start = parameter(rate, "m/s" if order else "m", constant) if constant else sp.S.Zero
    if of_handle and order:
        return start + parameter(f"dr_{i}_x", "1/s", of_handle) * x(n)
    return start + sp.Float(of_handle) * x(n) if of_handle else start
