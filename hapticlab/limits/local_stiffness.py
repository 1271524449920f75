"""The range of a scene's local stiffness dF/dx, for the bounds of nonlinear environments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import sympy as sp

from ..base.arguments import number
from ..errors import AnalysisError
from ..scene.notation.symbols import n, x

if TYPE_CHECKING:
    from ..base.annotations import Number
    from ..scene.scene import Scene

#: places looked at; secants between them are the slopes to some 1e-8 of their curvature
PLACES = 40_000
#: how often the space between two places is halved in search of a jump
HALVINGS = 20
#: a slope that departs from its neighbours by so many times their spread will not settle
UNSETTLED = 4.0


def local_stiffness(scene: Scene, x_low: Number, x_high: Number) -> tuple[float, float]:
    """Return the least and the largest local stiffness dF/dx [N/m] of a force law F(x(n)) between two positions.

    Parameters
    ----------
    scene : Scene
        Bound; its force must be a function of x(n) alone, as of :func:`hapticlab.wall` without damper or memory.
    x_low, x_high : float or text
        Positions [m].

    Returns
    -------
    (float, float)

    Raises
    ------
    AnalysisError
        The force has a memory, moves by itself, has no finite value somewhere, or jumps: then no stiffness bounds it, and
        no damping pays for it. Every space between two of the 40 000 places is searched down to a millionth of its width.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k_min, k_max = local_stiffness(hl.wall()(k=300), -0.01, 0.01)
    >>> round(k_min, 6), round(k_max, 6)
    (0.0, 300.0)
    """
    low, high = (number(name, a, "m", what="x_low < x_high") for name, a in (("x_low", x_low), ("x_high", x_high)))
    if not low < high:
        raise AnalysisError(f"x_low = {low}, x_high = {high} m; needs x_low < x_high")
    F = scene.force.xreplace({p: sp.Float(scene.values[name]) for name, p in scene.parameters.items() if name in scene.values})
    unbound = [name for name in scene.parameters if name not in scene.values]
    if unbound:
        raise AnalysisError(f"{scene.name}: {', '.join(unbound)} has no value; bind it, as in scene({unbound[0]}=...)")
    place = sp.Symbol("place", real=True)
    F = F.xreplace({x(n): place})
    others = {a for a in F.atoms(sp.Function) if hasattr(type(a), "role")} | (F.free_symbols - {place})
    if others:
        named = ", ".join(sorted(map(str, others)))
        raise AnalysisError(f"{scene.name}: its force contains {named}; a local stiffness needs a function of x(n) alone")
    written = sp.lambdify(place, F, "numpy")

    def force(at):
        with np.errstate(all="ignore"):
            return np.broadcast_to(np.asarray(written(at), float), at.shape)

    at = np.linspace(low, high, PLACES + 1)
    values = force(at)
    if not np.isfinite(values).all():
        where = at[np.argmin(np.isfinite(values))]
        raise AnalysisError(f"{scene.name}: its force has no finite value at x = {where:.4g} m; needs one from low to high")
    where = _jump(force, at, values)
    if where is not None:
        raise AnalysisError(
            f"{scene.name}: its force jumps near x = {where:.4g} m, or is so steep there that it cannot be distinguished "
            "from a jump, so its local stiffness has no bound. A handle that moves back and forth there draws the same "
            "energy however small its steps, and no damping dissipates that much. Replace the jump by a ramp"
        )
    slopes = np.diff(values) / np.diff(at)
    return float(slopes.min()), float(slopes.max())


def _jump(force, at, values):
    """Return where the slope between two places does not settle as the space is halved, or None.

    Each time the half is kept whose change departs most from the slopes beside. The departure of a smooth force shrinks
    with the space, and that of a kink stays within the slopes on both sides; a jump remains.
    """
    step = at[1] - at[0]
    beyond = np.array([at[0] - step, at[-1] + step])
    outside = force(beyond)  # the ends need neighbours, too
    slopes = np.diff(np.r_[outside[0], values, outside[1]]) / np.diff(np.r_[beyond[0], at, beyond[1]])
    own = slopes[1:-1]
    before, after = (np.where(np.isfinite(beside), beside, own) for beside in (slopes[:-2], slopes[2:]))
    usual = np.median([before, own, after], axis=0)
    left, right, below, above = at[:-1], at[1:], values[:-1], values[1:]
    for _ in range(HALVINGS):
        middle = (left + right) / 2
        here = force(middle)
        first = abs(here - below - usual * (middle - left)) > abs(above - here - usual * (right - middle))
        left, below = np.where(first, left, middle), np.where(first, below, here)
        right, above = np.where(first, middle, right), np.where(first, here, above)
    departs = abs(above - below - usual * (right - left))
    rounding = 1e-12 * abs(values).max() + 8 * np.finfo(float).eps * abs(at).max() * abs(own).max()
    spread = abs(before - after) + abs(own - usual)
    unsettled = (departs > UNSETTLED * spread * (right - left)) & (departs > rounding) | ~np.isfinite(departs)
    return left[np.argmax(unsettled)] if unsettled.any() else None
