"""Parametric curves that meet: the closest points are tracked by integrating how they move.

Chapter section 23.5.1.2, references 49 to 52: minimum distance tracking. With the closest points P_A(u) and P_B(w) and
D = P_B - P_A, the distance is stationary where

    D . dP_A/du = 0  and  D . dP_B/dw = 0.

Differentiated along the motion, the two say how u and w must move: two linear equations of first order, and so part of a
scene. What integration loses is taken back by -rate times the two residuals (Baumgarte).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.amount import number_of
from ..notation.cases import when
from ..notation.checks import agree_with
from ..notation.derivative import Partial
from ..notation.parameters import Parameter
from ..notation.symbols import T, coordinate, n, t
from ..notation.written import expression
from .plane import dot, less
from .shapes import Circle, Placed, Shape

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

#: points of each curve that are looked at for where the search starts
GRID = 128
#: part of the size of the curves by which a residual, divided by its speed, may differ from zero
ON_MINIMUM = 1e-6


class Curve(ShowsItself, Shape):
    """Smooth closed curve around a body, counter-clockwise; a shape that :func:`track` takes, and no other gap.

    Parameters
    ----------
    points : callable u -> (x, y)
        Expressions [m] of a pure number u, twice differentiable, of one period.
    closes_after : number
        u and u + closes_after are the same point.

    Examples
    --------
    An ellipse:

    >>> import hapticlab as hl
    >>> import sympy as sp
    >>> a, b = hl.parameters("a b", units="m m", values=(0.1, 0.05))
    >>> cam = hl.shapes.Curve(lambda u: (a * sp.cos(u), b * sp.sin(u))).at(name="cam")
    """

    tracked = True

    def __init__(self, points: Callable[..., Any], closes_after: Any = 2 * sp.pi) -> None:
        self.u = Parameter("(u)", "1")
        try:
            self.x, self.y = (expression(p, "a point of the curve") for p in points(self.u))
        except (TypeError, ValueError) as problem:
            raise SceneError(f"points: {problem}; needs a function of u that gives (x, y) in m") from None
        for p in (self.x, self.y):
            agree_with(p, "m", "a point of the curve")
        self.period = float(closes_after)

    def __repr__(self) -> str:
        return f"Curve({self.x}, {self.y})"

    def derivative(self, u: Any, order: int) -> Any:
        """The point (x, y) [m] at u, or its derivative of an order.

        Parameters
        ----------
        u : number or expression
            Parameter of the curve.
        order : int
            0 for the point itself, 1 for the first derivative with respect to u, and so on.
        """
        return tuple(sp.diff(p, self.u, order).xreplace({self.u: u}) for p in (self.x, self.y))


@dataclass(frozen=True)
class Tracked:
    """Closest points of two curves, as a part of a scene.

    Attributes
    ----------
    eom : tuple of sympy.Eq
        Of first order, for the coordinates of the closest points.
    coordinates : tuple
        Where the closest point is on each curve: u of the first, and w of the second if it is no point.
    gap : expression [m]
        Signed distance, negative in overlap; right while the overlap is less deep than the curves bend.
    rate : expression [m/s]
        Of the gap.
    normal, point : (x, y)
        Unit vector out of the first curve, and the closest point [m] of the second.
    slip : expression [m/s]
        Velocity of the second body past the first, along the first curve.
    """

    eom: tuple
    coordinates: tuple
    gap: sp.Expr
    rate: sp.Expr
    normal: tuple
    point: tuple
    slip: sp.Expr

    def force(self, law):
        """Normal force [N] of a law such as :class:`~hapticlab.scene.contact.penalty_laws.penalty`, an expression."""
        return when(self.gap <= 0, law.force(self.gap, self.rate))

    def generalized_force(self, law, q):
        """Generalized force along a coordinate q, for ``forces={q: ...}`` of :func:`hapticlab.mechanics.lagrange`, or along x(t).

        The closest points stay where they are on their curves: the distance is stationary there.
        """
        return self.force(law) * Partial(self.gap, q)


def track(
    a: Placed,
    b: Placed,
    *,
    names: Sequence[str] = ("u", "w"),
    correction: Any = None,
    near: Any = None,
    values: Mapping[str, float] | None = None,
) -> Any:
    """Track where two curves are closest, or a curve and a point.

    Parameters
    ----------
    a : Placed
        A :class:`Curve` in its place.
    b : Placed
        A Curve, or a :class:`~hapticlab.scene.shapes.shapes.Circle`, in its place.
    names : tuple of str
        What the coordinates of the closest points are called.
    correction : Parameter or expression [1/s], optional
        How fast an error of the closest points dies out; 1/(4 T) unless given.
    near : number or tuple of them, optional
        Where to look for the closest points at the first sample; found by looking along the whole curves unless given.
    values : dict name -> number, optional
        Parameters, for the first sample; their declared values unless given. The handle is taken to start at 0.

    Returns
    -------
    Tracked

    Raises
    ------
    SceneError
        The distance has no minimum at the start, or is stationary there without a minimum.

    Examples
    --------
    >>> import hapticlab as hl
    >>> import sympy as sp
    >>> a, b = hl.parameters("a b", units="m m", values=(0.1, 0.05))
    >>> z = hl.coordinate("z", unit="m", initial=0.2)
    >>> found = hl.shapes.track(hl.shapes.Curve(lambda u: (a * sp.cos(u), b * sp.sin(u))).at(), hl.shapes.Circle(0.01).at(y=z))
    >>> found.coordinates, float(type(found.coordinates[0]).initial)
    ((u(t),), 1.5707963267948966)
    """
    bodies = _checked(a, b)
    rate = 1 / (4 * T) if correction is None else expression(correction, "correction of tracking")
    agree_with(rate, "1/s", "correction of tracking")
    dummies = tuple(sp.Dummy(name, real=True) for name in names[: len(bodies)])
    F, J, _ = _stationary(a, b, dummies)
    found = _start(a, b, dummies, F, J, near, values or {})
    made = tuple(coordinate(name, unit="1", initial=value) for name, value in zip(names, found, strict=False))
    F, J, moving = _stationary(a, b, made)
    eom = tuple(
        sp.Eq(sp.Add(*(J[i][j] * q.diff(t) for j, q in enumerate(made))), -moving[i] - rate * F[i], evaluate=False)
        for i in range(len(made))
    )
    return Tracked(eom, made, *_facts(a, b, made))


def _checked(a, b):
    for body in (a, b):
        if not isinstance(body, Placed):
            raise SceneError(f"{body!r} is not a shape with a position; write Curve(...).at(x=..., y=...)")
    if not isinstance(a.shape, Curve) or not isinstance(b.shape, (Curve, Circle)):
        raise SceneError(
            f"{a.name} and {b.name}: track needs a Curve, and a Curve or a Circle. For other shapes use hl.shapes.gap"
        )
    return [body for body in (a, b) if isinstance(body.shape, Curve)]


def _placed(body, u, order=0):
    """A point of a body's curve at u, or its derivative to u, along the axes of the plane."""
    if not isinstance(body.shape, Curve):
        return body.x, body.y
    of_shape = body.shape.derivative(u, order)
    return body.point(*of_shape) if order == 0 else body.direction(*of_shape)


def _stationary(a, b, at):
    """(F, J, dF/dt): residuals, zero where the distance is stationary, and their derivatives to the coordinates and time."""
    D = less(_placed(b, at[-1]), _placed(a, at[0]))
    A, A2 = _placed(a, at[0], 1), _placed(a, at[0], 2)
    dD = less(b.velocity(_placed(b, at[-1])), a.velocity(_placed(a, at[0])))
    # the residuals of D . D / 2, so that J is its Hessian: positive definite where the distance is least
    F = [-dot(D, A)]
    J = [[dot(A, A) - dot(D, A2)]]
    moving = [-dot(dD, A) - a.turning * dot(D, (-A[1], A[0]))]
    if len(at) == 2:
        B, B2 = _placed(b, at[1], 1), _placed(b, at[1], 2)
        F.append(dot(D, B))
        J = [[J[0][0], -dot(A, B)], [-dot(A, B), dot(B, B) + dot(D, B2)]]
        moving.append(dot(dD, B) + b.turning * dot(D, (-B[1], B[0])))
    return F, J, moving


def _facts(a, b, at):
    """(Gap, rate, normal, point, slip) at the closest points."""
    p, q, A = _placed(a, at[0]), _placed(b, at[-1]), _placed(a, at[0], 1)
    speed = sp.sqrt(dot(A, A))
    normal = A[1] / speed, -A[0] / speed
    r = b.shape.radius
    point = q[0] - r * normal[0], q[1] - r * normal[1]
    relative = less(b.velocity(point), a.velocity(point))
    slip = normal[0] * relative[1] - normal[1] * relative[0]
    return dot(normal, less(q, p)) - r, dot(normal, relative), normal, point, slip


def _start(a, b, at, F, J, start, values):
    """Coordinates of the closest points at the first sample."""
    D = less(_placed(b, at[-1]), _placed(a, at[0]))
    at_start = _first_sample([*D, _facts(a, b, at)[0], *F, *(entry for row in J for entry in row)], values)
    if at_start is None:
        raise SceneError(f"{a.name} and {b.name}: parameters without a value; give values={{name: number}} to find the start")
    of = sp.lambdify(at, at_start, "numpy")
    periods = [body.shape.period for body in (a, b) if isinstance(body.shape, Curve)]
    if start is None:
        grid = np.meshgrid(*(np.arange(GRID) * period / GRID for period in periods), indexing="ij")
        x, y = of(*grid)[:2]
        best = np.unravel_index(np.argmin(np.broadcast_to(np.hypot(x, y), grid[0].shape)), grid[0].shape)
        place = np.array([axis[best] for axis in grid])
    else:
        place = np.array(start, float).reshape(-1)
        if place.shape != (len(at),):
            raise SceneError(f"near = {start!r}; needs {len(at)} numbers, one for each curve")
    return _minimum(a, b, of, place, start is not None)


def _minimum(a, b, of, place, given):
    """The minimum of the distance next to a starting point by Newton's method; a given start must be the minimum itself."""
    N = len(place)
    for _ in range(50):
        facts = np.array([float(f) for f in of(*place)])
        F, J = facts[3 : 3 + N], facts[3 + N :].reshape(N, N)
        if given or np.linalg.eigvalsh(J)[0] <= 0:
            break
        place = place - np.linalg.solve(J, F)
    least, size, gap = np.linalg.eigvalsh(J)[0], np.hypot(*facts[:2]), facts[2]
    slope = np.abs(F) / np.sqrt(np.abs(np.diag(J)) + 1e-300)
    where = ", ".join(f"{p:.6g}" for p in place)
    if least <= 0 or not np.isfinite(least):
        raise SceneError(
            f"{a.name} and {b.name}: the distance {size:.4g} m at {where} is not a minimum (its second derivative there has "
            f"the eigenvalue {least:.4g} m^2; needs > 0). The curves bend more sharply than their distance allows, or they "
            "overlap. Start elsewhere"
        )
    if slope.max() > ON_MINIMUM * max(size, 1e-3):
        raise SceneError(
            f"{a.name} and {b.name}: {where} is not where they are closest (the distance still changes by "
            f"{slope.max():.4g} m); leave out near=, and the closest points are searched"
        )
    if gap < 0 or size <= ON_MINIMUM * np.sqrt(np.diag(J).max()):
        raise SceneError(
            f"{a.name} and {b.name} touch or overlap at the start (gap {gap:.4g} m at {where}), or {a.name} runs clockwise: "
            "start them apart, and let every curve run counter-clockwise"
        )
    return [float(p) for p in place]


def _first_sample(expressions, values):
    """Expressions of the closest points' coordinates alone, at the first sample; None where a parameter has no value."""
    known = {}
    for expr in expressions:
        for leaf in expr.atoms(Parameter, sp.Function):
            role = getattr(type(leaf), "role", None)
            if isinstance(leaf, Parameter):
                known[leaf] = sp.Float(values.get(leaf.name, leaf.value))
            elif role == "coordinate":
                known[leaf] = type(leaf).initial
            elif role == "handle":
                known[leaf] = sp.S.Zero
    if any(value == sp.nan for value in known.values()):
        return None
    known |= {t: sp.S.Zero, n: sp.S.Zero}
    # twice: the initial value of a coordinate may hold parameters
    return [number_of(expr.xreplace(known).xreplace(known)) for expr in expressions]
