"""The range of a scene's local stiffness dF/dx, for the bounds of nonlinear environments."""

import numpy as np
import sympy as sp

from ..errors import AnalysisError
from ..scene.symbols import n, x
from .limit import check_number

#: places looked at; secants between them are the slopes to some 1e-8 of their curvature
PLACES = 40_000


def local_stiffness(scene, low, high):
    """Return the least and the largest local stiffness dF/dx [N/m] of a force law F(x(n)) between two positions.

    Parameters
    ----------
    scene : Scene
        Bound; its force must be a function of x(n) alone, as of :func:`hapticlab.wall` without damper or memory.
    low, high : float
        Positions [m].

    Returns
    -------
    (float, float)

    Raises
    ------
    AnalysisError
        The force has a memory, moves by itself, or jumps: then no stiffness bounds it, and no damping pays for it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k_min, k_max = local_stiffness(hl.wall()(k=300), -0.01, 0.01)
    >>> round(k_min, 6), round(k_max, 6)
    (0.0, 300.0)
    """
    low, high = (check_number("a position", a, "m", "needs low < high, in metres", lambda _: True) for a in (low, high))
    if not low < high:
        raise AnalysisError(f"low = {low}, high = {high} m; needs low < high")
    F = scene.force.xreplace({p: sp.Float(scene.values[name]) for name, p in scene.parameters.items() if name in scene.values})
    unbound = [name for name in scene.parameters if name not in scene.values]
    if unbound:
        raise AnalysisError(f"{scene.name}: {', '.join(unbound)} has no value; bind it, as in scene({unbound[0]}=...)")
    place = sp.Symbol("place", real=True)
    F = F.xreplace({x(n): place})
    others = {a for a in F.atoms(sp.Function) if hasattr(type(a), "role")} | (F.free_symbols - {place})
    if others:
        named = ", ".join(sorted(map(str, others)))
        raise AnalysisError(f"{scene.name}: its force holds {named}; a local stiffness needs a function of x(n) alone")
    force = sp.lambdify(place, F, "numpy")
    at = np.linspace(low, high, PLACES + 1)
    values = np.broadcast_to(np.asarray(force(at), float), at.shape)
    fine, coarse = np.diff(values) / np.diff(at), np.diff(values[::4]) / np.diff(at[::4])
    size = abs(coarse).max()
    if abs(fine).max() > 2 * size + 1e-9 * abs(values).max() / (high - low):
        where = at[np.argmax(abs(fine))]
        raise AnalysisError(
            f"{scene.name}: its force jumps near x = {where:.4g} m, and no stiffness bounds it: a handle that goes back and "
            "forth there draws the same energy however small its steps, which no damping pays for"
        )
    return float(fine.min()), float(fine.max())
