"""Choose how the constraints of a model are enforced; refuse those that repeat, contradict or lose each other.

``enforce="auto"`` takes the closed form where there is one, else multipliers with a projection after every tick.
"""

import functools
import itertools
import math

import numpy as np
import sympy as sp

from ...errors import MassError, SceneError
from ...scene.mechanics.loop_closure import name, names
from ...scene.mechanics.loop_solutions import embed, is_holonomic
from ...scene.mechanics.loop_terms import NotClosed
from ...scene.notation.symbols import t
from ..prune.constraint_assembly import SMALLEST
from ..prune.constraint_consistency import assembled, check_independent, check_rank, check_rates, check_start, shown_at
from .enforcement import Closed, Multipliers, Partitioned
from .multipliers import check_feedback, largest_feedback

#: of the declared forms: what a scene may ask for
ENFORCE = ("auto", "embed", "kkt", "baumgarte", "numeric")
#: choices of followers that are looked at
MOST_CHOICES = 200


def enforcement(
    constraints, coordinates, start, *, enforce="auto", alpha=None, M=None, definite=None, method=None, h=None, real="f64",
    used=(),
):  # fmt: skip
    """(what enforces the constraints, notes that say why).

    Parameters
    ----------
    constraints : sequence of expressions
        Each zero: of positions, or linear in rates.
    coordinates : tuple of coordinates
    start : dict
        Every coordinate, rate, parameter, x(t), v(t) and t -> its value at the start [SI].
    enforce : {"auto", "embed", "kkt", "baumgarte", "numeric"}
    alpha : float [1/s], optional
        Of Baumgarte's feedback; half of what is stable unless given.
    M : array, shape (N, N), optional
        Mass matrix at the start.
    definite : bool, optional
        Whether it is symmetric and positive definite everywhere; else it is looked at here.
    method, h : Method and its step [s]
    real : {"f64", "f32"}
    used : sequence of expressions
        Where an angle that jumps by a turn may stand in cosines and sines alone.

    Raises
    ------
    SceneError
        In the student's words: redundant or contradicting constraints, a start off them, a configuration within the
        declared ranges where they lose a rank, a loop without a closed form where one was asked for.
    """
    constraints, coordinates = tuple(constraints), tuple(coordinates)
    constraints = tuple(sorted(constraints, key=lambda g: not is_holonomic(g)))
    positions = [g for g in constraints if is_holonomic(g)]
    assembly = _assembled(constraints, coordinates, tuple(start.items()))
    definite = _definite(M) if definite is None else definite
    weight = 0.0 if definite or M is None else _weight(M, assembly, coordinates)
    reason = "a constraint on rates has none" if len(positions) < len(constraints) else ""
    if enforce in ("auto", "embed") and not reason:
        try:
            embedding, note = _closed(constraints, coordinates, tuple(start.items()))
            _check_wraps(embedding.wraps, used)
            _check_rates(constraints, coordinates, tuple(start.items()), embedding.drivers)
            return Closed(coordinates, embedding, definite), (note,)
        except NotClosed as why:
            reason = str(why)
    if enforce == "embed":
        raise SceneError(f"no closed form for the constraints: {reason}. Use enforce='auto' or 'kkt'")
    if M is not None and not np.allclose(M, np.transpose(M), rtol=1e-9, atol=1e-12 * np.abs(M).max()):
        raise MassError(
            "the mass matrix is not symmetric, so its rows are not generalized forces, and no reaction can be added to "
            "them. Use the equations of hl.mechanics.lagrange"
        )
    check_start(assembly, constraints, positions, coordinates, start)
    faults = check_rank(assembly, constraints, coordinates, real)
    if enforce == "numeric":
        followers = _followers(assembly, positions, constraints, coordinates, real)
        note = f"{names(followers)} follow by Newton's method, {len(positions)} unknowns"
        return Partitioned(coordinates, constraints, followers, definite), (note, *faults)
    if enforce == "baumgarte":
        alpha = largest_feedback(method) / h / 2 if alpha is None else alpha
        check_feedback(alpha, method, h)
        note = f"constraints enforced by multipliers with Baumgarte's feedback, alpha = {alpha:.4g} 1/s"
        return Multipliers(coordinates, constraints, alpha, weight), (note, *faults)
    note = "constraints enforced by multipliers and one projection per tick"
    return Multipliers(coordinates, constraints, None, weight), (f"{note}: {reason}" if reason else note, *faults)


# what follows from the mechanism and its start alone: a trade-off or a sweep compiles the same one again and again


@functools.lru_cache(maxsize=8)
def _assembled(constraints, coordinates, start):
    """The constraints as functions of arrays, independent of each other; ``start`` as items of a dict."""
    assembly = assembled(constraints, coordinates, dict(start))
    check_independent(assembly, constraints, [g for g in constraints if is_holonomic(g)], coordinates)
    return assembly


@functools.lru_cache(maxsize=8)
def _closed(constraints, coordinates, start):
    """The closed form and the note that says so."""
    embedding = embed(constraints, coordinates, dict(start))
    return embedding, _note_of(embedding)


@functools.lru_cache(maxsize=8)
def _check_rates(constraints, coordinates, start, drivers):
    check_rates(_assembled(constraints, coordinates, start), constraints, coordinates, dict(start), drivers)


def _check_wraps(wraps, used):
    for q in sorted(wraps, key=str):
        dummy = sp.Dummy()
        of_turns = {f: dummy for e in used for f in e.atoms(sp.sin, sp.cos) if f.has(q)}
        if any(e.xreplace({**of_turns, q.diff(t): dummy}).has(q) for e in used):
            raise NotClosed(f"{name(q)} turns without end, and is used outside a cosine or sine")


def _note_of(embedding):
    solved = names(step.coordinate for step in embedding.steps)
    drivers = f"driven by {embedding.driven_by}" if embedding.driven_by else "held still"
    return f"{solved} in closed form, {drivers}: no drift"


def _followers(assembly, positions, constraints, coordinates, real):
    """The coordinates to solve for: those that the constraints determine best where they do it worst."""
    if len(positions) < len(constraints):
        raise SceneError("enforce='numeric' solves constraints on positions; a constraint on rates needs enforce='kkt'")
    choices = list(itertools.combinations(range(len(coordinates)), len(constraints)))[:MOST_CHOICES]
    best = max(choices, key=lambda columns: np.min(assembly.weakness(assembly.reached, list(columns))))
    followers = [coordinates[k] for k in best]
    value, q = assembly.weakest(list(best))
    if value < SMALLEST[real]:
        raise SceneError(
            f"no coordinates can follow the others everywhere: even {names(followers)} have a dead centre, at "
            f"{shown_at(coordinates, q)}. Use enforce='kkt'"
        )
    return followers


def _definite(M):
    if M is None:
        return True
    M = np.asarray(M, float)
    if not np.allclose(M, M.T, rtol=1e-9, atol=0):
        return False
    size = np.sqrt(np.abs(np.diag(M)))
    if not np.all(size > 0):
        return False
    return bool(np.linalg.eigvalsh(M / np.outer(size, size))[0] > 1e-9)


def _weight(M, assembly, coordinates):
    """The factor of J^T J beside M: of the size of the masses that there are."""
    J = assembly.look(assembly.start[:, None])[1][:, :, 0]
    weight = float(np.trace(np.asarray(M, float)) / max(np.sum(J**2), math.ulp(0.0))) or 1.0
    whole = np.asarray(M, float) + weight * J.T @ J
    size = np.sqrt(np.abs(np.diag(whole)))
    values, directions = np.linalg.eigh(whole / np.outer(size, size)) if np.all(size > 0) else ([0.0], (size == 0)[:, None])
    if not values[0] > 1e-9:
        loose = names(p for p, c in zip(coordinates, directions[:, 0], strict=True) if abs(c) > 1e-6)
        raise MassError(
            f"singular mass: neither masses nor constraints determine the acceleration of {loose} (a massless direction); "
            "give it a mass"
        )
    return weight
