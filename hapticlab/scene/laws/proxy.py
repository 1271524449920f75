"""The proxy, or god-object: a point that follows the handle and never enters what is solid; the force pulls to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice, count
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.cases import when
from ..notation.symbols import T, n, parameters, signal, x
from ..notation.written import expression
from ..scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.annotations import Term


def proxy_wall(sides: str = "one") -> Scene:
    """Wall or thin plate felt through a proxy z(n), which stays on its side of the surface x_o.

    F = K (x(n) - z(n)) + B (p(n) - p(n-1))/T, p = x - z the penetration, never pulling. Zilles and Salisbury, *A
    constraint-based god-object method for haptic display*, IROS 1995, 146-151. In one degree of freedom the nearest
    point that the proxy can reach is the surface itself. What a plain wall cannot do: ``sides="both"`` is a plate
    without thickness, felt from either side. The proxy remembers where it came from, so that pushing hard does not pop
    through, while a wall of nearest surfaces lets go past its middle (chapter 23.5.2, refs 57 and 59).

    Parameters
    ----------
    sides : {"one", "both"}
        Solid beyond x_o, or a plate at x_o.

    Returns
    -------
    Scene
        With parameters K [N/m] >= 0, B [N s/m] (0 unless bound) and x_o [m] (0 unless bound), the proxy z watched. A
        handle that starts in a plate counts as before it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.proxy_wall("both")(K=500, x_o="10 mm").values
    {'B': 0.0, 'x_o': 0.01, 'K': 500.0}
    """
    choice("sides", sides, ("one", "both"), need="'one' (solid beyond x_o) or 'both' (a plate at x_o)", error=SceneError)
    K, x_o = parameters("K x_o", units="N/m m", values=(None, 0))
    B = parameters("B", units="N*s/m", values=0)
    z = signal("z", unit="m", initial=x(n))
    depth, before = x(n) - z(n), x(n - 1) - z(n - 1)
    pull = K * depth + B * (depth - before) / T
    if sides == "one":
        force = when(depth > 0, sp.Max(0, pull))
        return Scene(force, [sp.Eq(z(n), sp.Min(x(n), x_o))], watch={"z": z(n)}, name="proxy wall")
    # on the surface itself the proxy is where it was before: -1 before the plate, 1 behind it
    side = signal("side", unit="1", initial=when(x(n) > x_o, 1, -1))
    equations = [
        sp.Eq(side(n), when(z(n - 1) < x_o, -1, when(z(n - 1) > x_o, 1, side(n - 1)))),
        sp.Eq(z(n), when(side(n) < 0, sp.Min(x(n), x_o), sp.Max(x(n), x_o))),
    ]
    force = when(depth > 0, sp.Max(0, pull), when(depth < 0, sp.Min(0, pull)))
    return Scene(force, equations, watch={"z": z(n)}, name="proxy plate")


def proxy_curve(height: Callable[[sp.Expr], sp.Expr], *, load: Term, mu: Term = 0, steps: int = 2) -> Scene:
    """Texture or shape felt through a proxy on a planar curve: the handle draws it along a surface under a load.

    The finger rests with a constant ``load`` P on the curve y = h(z), pulled by a spring K along the handle: F =
    K (x(n) - z(n)). Without friction the proxy lies where the energy K (x - z)^2/2 + P h(z) is least near where it was:
    K (x - z) = P h'(z), so that slopes are felt as the height they stand for (Minsky et al., *Feeling and seeing*, 1990;
    Zilles and Salisbury 1995). With friction it stays where it is as long as the pull lies in the friction cone about
    the normal, P (h' - mu)/(1 + mu h') <= K (x - z) <= P (h' + mu)/(1 - mu h'), and moves no further than to its edge.

    Parameters
    ----------
    height : callable z [m] -> expression [m]
        The curve h, of parameters, twice differentiable.
    load : Parameter or expression [N], > 0, or text
        P; the spring must be the steeper, ``K > P max|h''|``, or the proxy jumps (as over a detent, which may be meant).
    mu : number or Parameter, >= 0
        Below ``1/max|h'|``: a steeper surface would jam.
    steps : int
        Newton steps a sample.

    Returns
    -------
    Scene
        With parameter K [N/m] and those of the curve, the proxy z and its height watched.

    Examples
    --------
    >>> import hapticlab as hl
    >>> import sympy as sp
    >>> A, w = hl.parameters("A w", units="m m")
    >>> ridges = hl.laws.proxy_curve(lambda z: A * sp.cos(2 * sp.pi * z / w), load="1 N", mu=0.1)
    >>> sorted(ridges.parameters)
    ['A', 'K', 'w']
    """
    K = parameters("K", units="N/m")
    P, friction = amount(load, "N", "load"), expression(mu, "mu")
    if P == 0 or P.is_negative:
        raise SceneError(f"load = {P}; needs the force > 0 N with which the finger rests on the curve")
    if friction.is_negative:
        raise SceneError(f"mu = {float(friction):g}; friction opposes the slip, so it needs mu >= 0")
    count("steps", steps, of="Newton steps", error=SceneError)
    z = signal("z", unit="m", initial=x(n))
    along = sp.Dummy("z", real=True)
    curve = expression(height(along), "height")
    slope, bend = curve.diff(along), curve.diff(along, 2)
    equations, last = [], z(n - 1)
    for step in range(steps):
        h1, h2 = slope.xreplace({along: last}), bend.xreplace({along: last})
        pull = K * (x(n) - last)
        low, high = (P * (h1 + side) / (1 - side * h1) for side in (-friction, friction))
        # Newton's slope of the edge that is passed, at least half the spring's where the energy is not convex
        stiffness = [sp.Max(K / 2, K + P * h2 * (1 + side**2) / (1 - side * h1) ** 2) for side in (-friction, friction)]
        too_far = when(pull < low, (pull - low) / stiffness[0])
        moved = last + when(pull > high, (pull - high) / stiffness[1], too_far)
        name = z if step == steps - 1 else signal(f"z_{step + 1}", unit="m")
        equations.append(sp.Eq(name(n), moved))
        last = name(n)
    return Scene(K * (x(n) - z(n)), equations, watch={"z": z(n), "h": curve.xreplace({along: z(n)})}, name="proxy on a curve")
