"""Whether the equations of motion determine every acceleration: the mass matrix in numbers, at many configurations."""

import random

import numpy as np
import sympy as sp

from ...errors import MassError
from ...scene.notation.parameters import Parameter
from ...scene.notation.symbols import T

#: configurations looked at: generic ones, then the initial state, then others over a turn of every angle
GENERIC, WIDE = 3, 5


def is_definite(form, values, graph):
    """Whether the mass matrix is symmetric and of one sign wherever looked at; then it needs no pivoting.

    Parameters
    ----------
    form : ExplicitForm
    values : dict name -> float
        Of the parameters that are bound.
    graph : Graph

    Raises
    ------
    MassError
        It is singular at three generic configurations; the message names the coordinates nothing determines.
    """
    N = len(form.coordinates)
    if not N:
        return False
    flat = graph.evaluate([m for row in form.M for m in row], _configurations(form, values, graph))
    lanes = GENERIC + 1 + WIDE
    every = np.moveaxis(np.array([np.broadcast_to(m, lanes) for m in flat]).reshape(N, N, lanes), -1, 0)
    generic = [M for M in every[:GENERIC] if np.isfinite(M).all()]
    if generic and all(map(_singular, generic)):
        _, _, directions = np.linalg.svd(_balanced(generic[-1]))
        names = [type(q).__name__ for q, c in zip(form.coordinates, directions[-1], strict=True) if abs(c) > 1e-6]
        raise MassError(
            f"singular mass: the equations do not determine the accelerations of {' and '.join(names)} "
            "(a massless direction, or an equation that repeats another); give each its own mass or equation"
        )
    return len(generic) == GENERIC and all(map(_definite, every))


def _configurations(form, values, graph):
    """variable -> array over the configurations."""
    symbols = graph.variables_of([m for row in form.M for m in row])
    starts = {s: start_of(s) for s in symbols}
    symbols = sorted({*symbols, *graph.variables_of(starts.values())}, key=str)
    generator, at = random.Random(23), {}
    for s in symbols:
        low, high = getattr(type(s), "low", -np.inf), getattr(type(s), "high", np.inf)
        near = [generator.uniform(0.5, 1.5) for _ in range(GENERIC + 1)]
        wide = [generator.uniform(*((0.5, 1.5) if isinstance(s, Parameter) else (-3.0, 3.0))) for _ in range(WIDE)]
        at[s] = np.clip(near + wide, low, high)
        if isinstance(s, Parameter) and s.name in values:
            at[s][:] = values[s.name]
        elif not isinstance(s, Parameter):
            at[s][GENERIC] = 0.0
    if T in at:
        at[T][:] = 1e-3
    initial = {s: numbers[GENERIC] for s, numbers in at.items()}
    for s, number in zip(starts, graph.evaluate(starts.values(), initial), strict=True):
        at[s][GENERIC] = number
    return at


def start_of(variable):
    """The initial value of a variable, an expression; handle and time start at zero, a parameter is what it is."""
    if isinstance(variable, sp.Derivative):
        return getattr(type(variable.expr), "rate", sp.S.Zero)
    return variable if isinstance(variable, Parameter) else getattr(type(variable), "initial", sp.S.Zero)


def _singular(M):
    sizes = np.linalg.svd(_balanced(M), compute_uv=False)
    return sizes[-1] <= 1e-10 * sizes[0]


def _definite(M):
    """Whether M is symmetric and its pivots, of entries scaled to a unit diagonal, have one sign and are not small."""
    diagonal = np.diag(M)
    if not np.isfinite(M).all() or not (diagonal * M[0, 0] > 0).all():
        return False
    S = np.sign(M[0, 0]) * _over(M, abs(diagonal), abs(diagonal))
    if abs(S - S.T).max() > 1e-12:
        return False
    for j in range(len(S)):
        if S[j, j] < 1e-6:
            return False
        S[j + 1 :] -= np.outer(S[j + 1 :, j] / S[j, j], S[j])
    return True


def _balanced(M):
    """Scale rows and columns to their largest entries, so that grams beside kilograms are not taken for nothing."""
    rows, columns = (abs(M).max(axis=axis) for axis in (1, 0))
    return _over(M, np.where(rows > 0, rows, 1.0), np.where(columns > 0, columns, 1.0))


def _over(M, rows, columns):
    """M over the geometric means of rows and columns, whose products may be past all numbers."""
    return M / np.sqrt(rows)[:, None] / np.sqrt(columns)[None, :]
