"""Whether constraints agree with each other, with the start, and everywhere the mechanism can go; else refused, in words."""

import itertools
import math

import numpy as np
import sympy as sp

from ...errors import SceneError
from ...scene.mechanics.loop_closure import declared_range, in_unit, is_angle, name, shown, values
from ...scene.mechanics.loop_solutions import AGREEING, is_holonomic
from ...scene.notation.symbols import t, v
from .constraint_assembly import SMALLEST, Assembly


def assembled(constraints, coordinates, start):
    """The constraints as functions of arrays."""
    q = sp.symbols(f"q:{len(coordinates)}", real=True)
    rates = [p.diff(t) for p in coordinates]
    rows, off = [], []
    for g in (g.doit() for g in constraints):
        rows.append([g.diff(p) for p in (coordinates if is_holonomic(g) else rates)])
        if is_holonomic(g):
            off.append(g)
        elif any(entry.has(*rates) for entry in rows[-1]):
            raise SceneError(
                f"{shown([g])} is not linear in the rates; a constraint contains positions only, or is linear in rates"
            )
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


def check_independent(assembly, constraints, positions, coordinates):
    """Refuse constraints that contradict or repeat each other."""
    q = assembly.closest(assembly.start[:, None])
    left, J = assembly.look(q)
    weights = assembly.dependent(q[:, 0]) if np.isfinite(J).all() else None
    sizes = np.linalg.norm(J[: len(left), :, 0] * assembly.scale, axis=1)
    if not np.all(np.abs(left[:, 0]) <= 1e-9 * np.where(sizes > 0, sizes, 1.0)):
        worst = [g for g, off, size in zip(positions, left[:, 0], sizes, strict=True) if not abs(off) <= 1e-9 * (size or 1.0)]
        raise SceneError(
            f"{shown(worst)} cannot be satisfied together near the start: the closest the mechanism comes is "
            f"{shown_at(coordinates, q[:, 0])}, off by {', '.join(f'{off:.3g}' for off in left[:, 0] if off)}. The constraints "
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
            "configuration), so their reactions are not determined. Leave out one of them"
        )
    raise SceneError(_lost(involved, coordinates, q[:, 0], "at the start"))


def check_start(assembly, constraints, positions, coordinates, start):
    """Refuse a start off the constraints, naming the closest one on them."""
    q = assembly.closest(assembly.start[:, None])[:, 0]
    moved = np.abs(q - assembly.start) > AGREEING * assembly.scale
    if moved.any():
        off, _ = assembly.look(assembly.start[:, None])
        residuals = ", ".join(f"{value:.3g}" for value in off[:, 0])
        wanted = ", ".join(in_unit(p, value) for p, value, far in zip(coordinates, q, moved, strict=True) if far)
        raise SceneError(
            f"the start {values(coordinates, start)} does not satisfy the constraints {shown(positions)}: their left sides "
            f"are {residuals}. The closest start that satisfies them is {wanted}"
        )
    check_rates(assembly, constraints, coordinates, start)


def check_rates(assembly, constraints, coordinates, start, drivers=()):
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
        wanted = ", ".join(in_unit(p, rate, "/s") for p, rate, off in zip(coordinates, rates + change, far, strict=True) if off)
        raise SceneError(
            f"the rates at the start violate the constraints {shown(constraints)}: their left sides change at "
            f"{', '.join(f'{s:.3g}' for s in slip)} per second. The closest rates that satisfy them are {wanted}"
        )


def _rate(g, coordinates):
    """The rate of a constraint of positions, or a constraint of rates as it is."""
    if not is_holonomic(g):
        return g.doit()
    held = {p: sp.Dummy() for p in coordinates}
    moving = g.doit().xreplace(held)
    total = sp.Add(moving.diff(t), *(moving.diff(dummy) * p.diff(t) for p, dummy in held.items()))
    return total.xreplace({dummy: p for p, dummy in held.items()})


def check_rank(assembly, constraints, coordinates, real):
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
    return (f"the constraints lose a rank at {shown_at(coordinates, q)}: a motion that reaches it switches the motor off",)


def _lost(constraints, coordinates, q, where):
    return (
        f"{shown(constraints)} lose a rank {where}, at {shown_at(coordinates, q)}: there the mechanism can continue in two "
        "ways (a change point), and the reactions are not determined. Change its lengths, or declare ranges that exclude "
        "this point"
    )


def shown_at(coordinates, q):
    """A configuration for a message; what is zero but for rounding is shown as zero."""
    return ", ".join(f"{name(p)} = {round(float(value), 9) + 0.0:.4g}" for p, value in zip(coordinates, q, strict=True))
