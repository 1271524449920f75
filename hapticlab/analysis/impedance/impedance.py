"""What a scene is at its port: the impedance Z = F/v of its equations of motion, linearised, in continuous time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np
import sympy as sp

from ...base.arguments import what_is
from ...compiler.algebra.graph import shown
from ...compiler.prune.constant_coefficients import Coefficients
from ...compiler.prune.dependence import FORCE, Dependence, part_of
from ...errors import AnalysisError, ParameterError
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import Parameter, delay, lag_of, n, t, v, x
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .impedance_curve import LOOKED_AT, Impedance

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...base.annotations import Array

#: the handle as a force sees it at the sample, and as an equation of motion sees it
SEEN = ((x(t), x(n)), (v(t), v(n)))


@dataclass(frozen=True)
class Port:
    """(M s^2 + C s + K) z = -(K_x + s C_x) x and F = (k + s c) x + (K_F + s C_F) z, in numbers.

    Attributes
    ----------
    coordinates : tuple of sympy expressions, shape (N,)
    M, C, K : array of shape (N, N)
    Kx, Cx, KF, CF : array of shape (N,)
    k, c : float
        Force of the handle's own position and velocity [N/m], [N s/m].
    """

    coordinates: tuple[sp.Expr, ...]
    M: Array
    C: Array
    K: Array
    Kx: Array
    Cx: Array
    KF: Array
    CF: Array
    k: float
    c: float

    def impedance(self, frequency: ArrayLike) -> NDArray[np.complex128]:
        """Return Z = F/v [N s/m] at frequencies > 0 [Hz], complex, shape as given."""
        s = 2j * np.pi * np.asarray(frequency, float)
        S = np.reshape(s, (-1, 1, 1))
        z = -np.linalg.solve(S * S * self.M + S * self.C + self.K, (self.Kx + S[:, 0] * self.Cx)[..., None])[..., 0]
        F = self.k + S[:, 0, 0] * self.c + ((self.KF + S[:, 0] * self.CF) * z).sum(axis=1)
        return (F / S[:, 0, 0]).reshape(np.shape(s))


@overload
def impedance(scene: Scene, frequency: None = None) -> Impedance: ...
@overload
def impedance(scene: Scene, frequency: ArrayLike) -> NDArray[np.complex128]: ...
def impedance(scene: Scene, frequency: ArrayLike | None = None) -> Impedance | NDArray[np.complex128]:
    """Impedance Z = F/v at the handle [N s/m], of the scene linearised about its start with the handle at x = 0.

    A mass at the handle would have Z = m s, a spring k/s, a damper b, at s = 2 pi j frequency. Continuous: without the
    sampling that a program adds.

    Parameters
    ----------
    scene : Scene
        Every parameter bound; of the present sample and its equations of motion, without memory of past samples.
    frequency : float or array, optional
        [Hz], > 0. Without it 0.1 to 200 Hz, as a curve that plots itself.

    Returns
    -------
    complex array of the shape of ``frequency``, or Impedance

    Raises
    ------
    AnalysisError, ParameterError

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, b = hl.parameters("k b", units="N/m N*s/m", values=(200, 3))
    >>> complex(impedance(hl.Scene(force=k * hl.x(hl.n) + b * hl.v(hl.n)), 1 / (2 * np.pi)).round(9))
    (3-200j)
    """
    if frequency is None:
        return Impedance(scene.name, LOOKED_AT, port_of(scene).impedance(LOOKED_AT))
    try:
        frequency = np.asarray(frequency, float)
    except (TypeError, ValueError):
        what = what_is(frequency)
        raise AnalysisError(
            f"frequency is {what}; needs numbers in Hz, such as hl.passivity.impedance(scene, [1, 10, 100])"
        ) from None
    if not (np.isfinite(frequency).all() and (frequency > 0).all()):
        raise AnalysisError(f"frequency = {frequency} Hz; an impedance needs finite frequencies > 0")
    return port_of(scene).impedance(frequency)


def port_of(scene, linear=False):
    """Return the :class:`Port` of a scene, linearised about its start; ``linear`` refuses one that is not."""
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "needs hl.Scene(force=...)"))
    unbound = sorted(set(scene.parameters) - set(scene.values))
    if unbound:
        raise ParameterError(f"{', '.join(unbound)} has no value; bind it: scene({unbound[0]}=...)")
    form = scene.explicit()
    felt = Dependence(form).paths(FORCE)
    form = part_of(form, [k for k, q in enumerate(form.coordinates) if type(q).__name__ in felt])
    _check_memory(scene, form)
    found = Coefficients(form, scene.values, 1e-3)
    if linear:
        _check_linear(scene, found)
    N, of_second = len(form.coordinates), np.array([order == 2 for order in form.orders], bool)

    def at_start(exprs, *shape):
        return np.reshape(found.numbers(exprs, scene.values), shape)

    def slopes(exprs, variables):
        return at_start([Partial(e, variable) for e in exprs for variable in variables], len(exprs), len(variables))

    rates = [q.diff(t) for q in form.coordinates]
    inertia = at_start([m for row in form.M for m in row], N, N)
    C, K = slopes(form.f, rates), slopes(form.f, form.coordinates)
    by_handle = slopes(form.f, (x(t), v(t), x(n), v(n)))
    own = [slopes([form.force], seen).sum() for seen in SEEN]
    return Port(
        form.coordinates,
        inertia * of_second,
        inertia * ~of_second - C * of_second,
        -K,
        -by_handle[:, 0] - by_handle[:, 2],
        -by_handle[:, 1] - by_handle[:, 3],
        slopes([form.force], form.coordinates)[0],
        slopes([form.force], rates)[0] * of_second,
        *own,
    )


def _check_linear(scene, found):
    """Refuse what springs, dampers and masses between handle and ground are not: curved, driven, pulled by a constant."""
    form, rows = found.form, range(len(found.form.coordinates))
    why = found.slope_moves(form.force, "in the force") or next(filter(None, map(found.why_not, rows)), None)
    moving = {*found.states, *SEEN[0], *SEEN[1]}
    parts = {
        "the force": form.force,
        **{f"the equation of {type(q).__name__}": f for q, f in zip(form.coordinates, form.f, strict=True)},
    }
    for where, expr in parts.items():
        at = dict.fromkeys(found.graph.variables_of([expr]), 0.0)
        driver = next((a for a in at if a not in moving and not isinstance(a, Parameter)), None)
        if driver is not None:
            why = why or f"{shown(driver)} drives {where}"
            continue
        at |= {p: scene.values.get(p.name, 1e-3) for p in at if isinstance(p, Parameter)}
        pull = float(found.graph.evaluate([expr], at)[0])
        if abs(pull) > 1e-12:
            why = why or f"{where} contains {pull:.3g} at rest; measure its coordinates from the rest position"
    if why:
        raise AnalysisError(f"{scene.name}: {why}; a reduction needs masses, springs and dampers that are linear")


def _check_memory(scene, form):
    """Refuse what belongs to the samples of a program, and has no impedance in continuous time."""
    for expr in (form.force, *form.f):
        for f in expr.atoms(sp.Function):
            role = getattr(type(f), "role", None)
            if isinstance(f, delay) or role == "signal" or (role == "handle" and lag_of(f)):
                raise AnalysisError(
                    f"{scene.name}: {f} uses past samples, so the scene has no impedance in continuous time; needs a force "
                    "of x(n), v(n) and coordinates"
                )
