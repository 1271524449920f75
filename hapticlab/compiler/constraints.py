"""Choose how the constraints of a model are enforced; refuse those that repeat, contradict or lose each other.

``enforce="auto"`` takes the closed form where there is one, else multipliers with a projection after every tick.
"""

import itertools
import math

import numpy as np
import sympy as sp

from ..errors import MassError, SceneError
from ..scene.closing import declared_range, in_unit, is_angle, name, names, shown, values
from ..scene.dyads import NotClosed
from ..scene.loops import AGREEING, embed, is_holonomic
from ..scene.symbols import t, v
from .assembly import SMALLEST, Assembly
from .constrained import check_feedback, largest_feedback
from .enforcing import Closed, Multipliers, Partitioned

#: of the declared forms: what a scene may ask for
ENFORCE = ("auto", "embed", "kkt", "baumgarte", "numeric")
#: choices of followers that are looked at
MOST_CHOICES = 200


def enforcement(
    constraints, coordinates, start, *, enforce="auto", alpha=None, M=None, definite=None, method=None, h=None, real="f64",
    used=(),
):  # fmt: skip
    """Return (what enforces the constraints, notes that say why).

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
    assembly = _assembly(constraints, coordinates, start)
    _check_independent(assembly, constraints, positions, coordinates)
    definite = _definite(M) if definite is None else definite
    weight = 0.0 if definite or M is None else _weight(M, assembly, coordinates)
    reason = "a constraint of rates has none" if len(positions) < len(constraints) else ""
    if enforce in ("auto", "embed") and not reason:
        try:
            embedding = embed(constraints, coordinates, start)
            _check_wraps(embedding.wraps, used)
            _check_rates(assembly, constraints, coordinates, start, embedding.drivers)
            return Closed(coordinates, embedding, definite), (_note_of(embedding),)
        except NotClosed as why:
            reason = str(why)
    if enforce == "embed":
        raise SceneError(f"no closed form for the constraints: {reason}. Use enforce='auto' or 'kkt'")
    if M is not None and not np.allclose(M, np.transpose(M), rtol=1e-9, atol=1e-12 * np.abs(M).max()):
        raise MassError(
            "the mass matrix is not symmetric, so its rows are no generalized forces, and a reaction has no place in them; "
            "take the equations from hl.lagrange"
        )
    _check_start(assembly, constraints, positions, coordinates, start)
    faults = _check_rank(assembly, constraints, coordinates, real)
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


def _check_wraps(wraps, used):
    for q in sorted(wraps, key=str):
        dummy = sp.Dummy()
        of_turns = {f: dummy for e in used for f in e.atoms(sp.sin, sp.cos) if f.has(q)}
        if any(e.xreplace({**of_turns, q.diff(t): dummy}).has(q) for e in used):
            raise NotClosed(f"{name(q)} turns on and on, and is used other than in a cosine or sine")


def _note_of(embedding):
    solved = names(step.coordinate for step in embedding.steps)
    drivers = names(embedding.drivers) or "the handle"
    return f"{solved} in closed form, driven by {drivers}: no drift"


def _assembly(constraints, coordinates, start):
    """Return the constraints as functions of arrays."""
    q = sp.symbols(f"q:{len(coordinates)}", real=True)
    rates = [p.diff(t) for p in coordinates]
    rows, off = [], []
    for g in (g.doit() for g in constraints):
        rows.append([g.diff(p) for p in (coordinates if is_holonomic(g) else rates)])
        if is_holonomic(g):
            off.append(g)
        elif any(entry.has(*rates) for entry in rows[-1]):
            raise SceneError(f"{shown([g])} is not linear in the rates; a constraint holds positions, or is linear in rates")
    rest = {s: sp.Float(value) for s, value in start.items() if s not in coordinates}
    # the coordinates first: t stands in them, too
    written = [e.xreplace(dict(zip(coordinates, q, strict=True))).xreplace(rest) for e in itertools.chain(off, *rows)]
    function = sp.lambdify(q, written, "numpy")

    def look(at):
        found = np.empty((len(written), *at.shape[1:]))
        with np.errstate(all="ignore"):
            for k, value in enumerate(function(*at)):
                found[k] = value
        return found[: len(off)], found[len(off) :].reshape(len(rows), len(q), *at.shape[1:])

    low, high = np.array([declared_range(p) for p in coordinates], float).T
    angles = np.array([is_angle(p) for p in coordinates])
    return Assembly(look, np.array([float(start[p]) for p in coordinates]), low, high, angles)


def _check_independent(assembly, constraints, positions, coordinates):
    """Refuse constraints that contradict or repeat each other."""
    q = assembly.closest(assembly.start[:, None])
    left, J = assembly.look(q)
    weights = assembly.dependent(q[:, 0]) if np.isfinite(J).all() else None
    sizes = np.linalg.norm(J[: len(left), :, 0] * assembly.scale, axis=1)
    if not np.all(np.abs(left[:, 0]) <= 1e-9 * np.where(sizes > 0, sizes, 1.0)):
        worst = [g for g, off, size in zip(positions, left[:, 0], sizes, strict=True) if not abs(off) <= 1e-9 * (size or 1.0)]
        raise SceneError(
            f"{shown(worst)} cannot hold together near the start: the closest the mechanism comes is "
            f"{_at(coordinates, q[:, 0])}, off by {', '.join(f'{off:.3g}' for off in left[:, 0] if off)}. The constraints "
            "contradict each other, or the start is far from every assembly"
        )
    if weights is None:
        return
    involved = [g for g, weight in zip(constraints, weights, strict=False) if abs(weight) > 1e-6]
    generator = np.random.default_rng(11)
    elsewhere = q + assembly.scale[:, None] * generator.uniform(-0.2, 0.2, (len(q), 3))
    if len(constraints) < len(coordinates):
        elsewhere = assembly.closest(elsewhere)
    if all(assembly.dependent(at) is not None for at in elsewhere.T):
        raise SceneError(
            f"redundant constraints: {shown(involved)} repeat each other (their gradients are dependent at every "
            "configuration), so their reactions are not determined. Leave one out"
        )
    raise SceneError(_lost(involved, coordinates, q[:, 0], "at the start"))


def _check_start(assembly, constraints, positions, coordinates, start):
    """Refuse a start off the constraints, naming the closest one on them."""
    q = assembly.closest(assembly.start[:, None])[:, 0]
    moved = np.abs(q - assembly.start) > AGREEING * assembly.scale
    if moved.any():
        off, _ = assembly.look(assembly.start[:, None])
        residuals = ", ".join(f"{value:.3g}" for value in off[:, 0])
        wanted = ", ".join(
            in_unit(p, value) for p, value, far in zip(coordinates, q, moved, strict=True) if far
        )
        raise SceneError(
            f"the start {values(coordinates, start)} is off the constraints {shown(positions)}: the left sides are "
            f"{residuals}. The closest start on them is {wanted}"
        )
    _check_rates(assembly, constraints, coordinates, start)


def _check_rates(assembly, constraints, coordinates, start, drivers=()):
    """Refuse rates at the start that break the constraints; those that follow from drivers need not be given."""
    rates = np.array([float(start.get(p.diff(t), 0.0)) for p in coordinates])
    at = {**{p.diff(t): sp.S.Zero for p in coordinates}, v(t): sp.S.Zero, **{s: sp.Float(value) for s, value in start.items()}}
    slip = np.array([float(_rate(g, coordinates).xreplace(at)) for g in constraints])
    free = np.array([p not in drivers for p in coordinates])
    J = assembly.look(assembly.start[:, None])[1][:, :, 0] * assembly.scale * free
    change = -assembly.scale * (np.linalg.pinv(J) @ slip)
    given = rates != 0 if drivers else np.full(len(rates), True)
    far = given & (np.abs(change) > AGREEING * np.maximum(assembly.scale, np.abs(rates)))
    if far.any():
        wanted = ", ".join(
            in_unit(p, rate, "/s") for p, rate, off in zip(coordinates, rates + change, far, strict=True) if off
        )
        raise SceneError(
            f"the rates at the start break the constraints {shown(constraints)}: they change at "
            f"{', '.join(f'{s:.3g}' for s in slip)} a second. The closest rates that keep them are {wanted}"
        )


def _rate(g, coordinates):
    """Return the rate of a constraint of positions, or a constraint of rates as it is."""
    if not is_holonomic(g):
        return g.doit()
    held = {p: sp.Dummy() for p in coordinates}
    moving = g.doit().xreplace(held)
    total = sp.Add(moving.diff(t), *(moving.diff(dummy) * p.diff(t) for p, dummy in held.items()))
    return total.xreplace({dummy: p for p, dummy in held.items()})


def _check_rank(assembly, constraints, coordinates, real):
    """Refuse constraints that lose a rank where the mechanism must pass or may go; return a note where it hardly does.

    One with several freedoms and no declared ranges passes such a configuration by; should it meet it, the motor goes off.
    """
    value, q = assembly.weakest()
    if value >= SMALLEST[real]:
        return ()
    held = [p for p in coordinates if any(g.has(p) for g in constraints)]
    declared = all(math.isfinite(limit) for p in held for limit in declared_range(p))
    if declared or len(held) - len(constraints) <= 1:
        raise SceneError(_lost(constraints, coordinates, q, "within the range it can reach"))
    return (f"the constraints lose a rank at {_at(coordinates, q)}: a motion that meets it turns the motor off",)


def _lost(constraints, coordinates, q, where):
    return (
        f"{shown(constraints)} lose a rank {where}, at {_at(coordinates, q)}: there the mechanism can leave by two ways "
        "(a change point), and the reactions are not determined. Change its lengths, or declare ranges that keep away from it"
    )


def _at(coordinates, q):
    # what is zero but for rounding is shown as zero
    return ", ".join(f"{name(p)} = {round(float(value), 9) + 0.0:.4g}" for p, value in zip(coordinates, q, strict=True))


def _followers(assembly, positions, constraints, coordinates, real):
    """Return the coordinates to solve for: those that the constraints determine best where they do it worst."""
    if len(positions) < len(constraints):
        raise SceneError("enforce='numeric' solves constraints of positions; one of rates needs enforce='kkt'")
    choices = list(itertools.combinations(range(len(coordinates)), len(constraints)))[:MOST_CHOICES]
    best = max(choices, key=lambda columns: np.min(assembly.weakness(assembly.reached, list(columns))))
    followers = [coordinates[k] for k in best]
    value, q = assembly.weakest(list(best))
    if value < SMALLEST[real]:
        raise SceneError(
            f"no coordinates follow the others everywhere: even {names(followers)} have a dead centre, at "
            f"{_at(coordinates, q)}. Use enforce='kkt'"
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
    """Return the factor of J^T J beside M: of the size of the masses that there are."""
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
