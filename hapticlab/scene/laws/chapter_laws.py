"""The chapter's laws as scenes: virtual walls, the force filter, the virtual damper, the virtual coupler."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice, instance
from ...errors import SceneError
from ..notation.symbols import T, delay, n, parameters, t, v, when, x
from ..scene import Scene, check_scene
from .estimators import AN_ESTIMATE, VelocityEstimate
from .taps import LEAD, TAPS, LawName

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.annotations import Number, Term


UNILATERAL = ("gate", "clip", None)


def wall(
    law: LawName = "zoh",
    *,
    k: Number | None = None,
    B: Number | None = None,
    x_o: Number | None = None,
    unilateral: str | None = "gate",
    clamp: bool = False,
    velocity: VelocityEstimate | None = None,
) -> Scene:
    """Virtual wall: a spring K that pushes back beyond x_o, with a virtual damper B in parallel.

    =======================  =======  ====================================================
    law                      Eq.      spring force, with p = x - x_o
    =======================  =======  ====================================================
    ``zoh``                  (23.1)   k p(n)
    ``half_sample``          (23.3)   k (p(n) + T/2 v(n))
    ``backward_difference``  (23.5)   k (1.5 p(n) - 0.5 p(n-1))
    ``ellis``                (23.7)   k (2 p(n) - 1.5 p(n-1) + 0.5 p(n-2))
    =======================  =======  ====================================================

    v(n) is the paddle's velocity, which is exact only in a simulated paddle without an encoder. With an encoder, or on a
    board, v(n) is estimated from positions, and ``half_sample`` is ``backward_difference`` unless ``velocity`` names
    another estimate. Eq. (23.2) with x(n+1) = x(n) + T v(n) is Eq. (23.3) with the same v.

    The law predicts for the spring alone. The damper is B (p(n) - p(n-1))/T, the backward difference of the sensed
    position, whatever the law, unless ``velocity`` names another estimate.

    Parameters
    ----------
    law : {"zoh", "half_sample", "backward_difference", "ellis"}
    k, B, x_o : float or text, optional
        Stiffness [N/m] >= 0, damping [N s/m] of either sign, and boundary [m], to bind them at once.
    unilateral : {"gate", "clip", None}
        ``"gate"``: spring and damper act on the raw past and are zero where x(n) < x_o, as Eq. (23.1) reads.
        ``"clip"``: they act on max(p, 0), present and past, and so may act for two samples after the handle leaves; a
        ``half_sample`` wall uses zero velocity outside. ``None``: they always act; the linear law of the bounds.
    clamp : bool
        Never pull: F is replaced by max(F, 0).
    velocity : VelocityEstimate, optional
        The estimate of v(n) for the damper and ``half_sample``:
        :func:`~hapticlab.scene.laws.estimators.filtered_velocity` or a similar one. With ``"clip"`` it is used inside
        only.

    Returns
    -------
    Scene
        With parameters k [N/m] >= 0, B [N s/m] of either sign (0 unless bound) and x_o [m] (0 unless bound).

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.wall("ellis", k=150, x_o="10 mm").values
    {'B': 0.0, 'x_o': 0.01, 'k': 150.0}
    >>> hl.wall("half_sample", velocity=hl.velocity.filtered(tau="4 ms")).name
    'half_sample wall, filtered difference'
    """
    need = f"one of {', '.join(TAPS)}. A stiffness is given by name: hl.wall(k=300)"
    choice("law", law, TAPS, need=need if isinstance(law, (int, float)) else None, error=SceneError)
    choice("unilateral", unilateral, UNILATERAL, need="'gate', 'clip' or None (the spring always acts)", error=SceneError)
    stiffness, boundary = parameters("k x_o", units="N/m m", values=(None, 0))
    damping = parameters("B", units="N*s/m", values=0, ranges=(-math.inf, math.inf))

    def p(lag):
        depth = x(n - lag) - boundary
        return sp.Max(depth, 0) if unilateral == "clip" else depth

    def inside(rate):
        return when(x(n) >= boundary, rate) if unilateral == "clip" else rate

    estimate = _checked(velocity)
    spring = stiffness * sp.Add(*(sp.Rational(c) * p(lag) for lag, c in enumerate(TAPS[law])))
    if LEAD[law]:
        spring = stiffness * (p(0) + sp.Rational(LEAD[law]) * T * inside(estimate.velocity if estimate else v(n)))
    force = spring + damping * (inside(estimate.velocity) if estimate else (p(0) - p(1)) / T)
    if unilateral == "gate":
        force = when(x(n) >= boundary, force)
    if clamp:
        force = sp.Max(force, 0)
    given = {name: value for name, value in (("k", k), ("B", B), ("x_o", x_o)) if value is not None}
    return _scene(force, f"{law} wall", estimate)(**given)


def _checked(velocity):
    return instance("velocity", velocity, VelocityEstimate | None, f"{AN_ESTIMATE}, or None", error=SceneError)


def _scene(force, name, estimate):
    """A scene of a force and of the difference equations of its velocity estimate."""
    return Scene(force, estimate.eom, name=f"{name}, {estimate.name}") if estimate else Scene(force, name=name)


def force_filter(scene: Scene, clamp: bool = False) -> Scene:
    """Predictor-corrector filter around the whole force of any scene, Eq. (23.8): 2 F(n) - 1.5 F(n-1) + 0.5 F(n-2).

    On a plain wall without a switch it equals :func:`wall` with ``law="ellis"``, Eq. (23.7). Around a spring and damper
    it filters both, which asks for more device damping than filtering the spring alone. It filters what is felt, and
    knows nothing of boundaries: a force that jumps to F is felt as 2 F, F/2, F, and after leaving a wall as -1.5 F(n-1)
    + 0.5 F(n-2), a pull, and then as half the last force. ``clamp`` keeps a wall from pulling.

    Parameters
    ----------
    scene : Scene
    clamp : bool
        Never pull: the filtered force is replaced by max(F, 0).

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.force_filter(hl.wall(unilateral=None)).name
    'filtered zoh wall'
    """
    check_scene(scene)
    F = scene.force
    # 2*F is kept whole: SymPy would multiply it out, and F would be computed twice
    filtered = sp.Mul(2, F, evaluate=False) - sp.Rational(3, 2) * delay(F) + delay(delay(F)) / 2
    filtered = sp.Max(filtered, 0) if clamp else filtered
    return Scene(filtered, scene.eom, scene.watch, scene.values, f"filtered {scene.name}")


def virtual_damper(velocity: VelocityEstimate | None = None) -> Scene:
    """Virtual damper: F = B v(n), B [N s/m] of either sign; a negative one compensates the device's own damping.

    v(n) is the paddle's velocity: the backward difference of its position on a board, exact in a simulated paddle
    without an encoder.

    Parameters
    ----------
    velocity : VelocityEstimate, optional
        What to take for v(n) instead, such as :func:`~hapticlab.scene.laws.estimators.filtered_velocity`.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.virtual_damper()(B=-0.02).values
    {'B': -0.02}
    """
    B = parameters("B", units="N*s/m", ranges=(-math.inf, math.inf))
    estimate = _checked(velocity)
    return _scene(B * (estimate.velocity if estimate else v(n)), "virtual damper", estimate)


def virtual_coupler(z: sp.Expr, *, K: Term, b: Term) -> sp.Expr:
    """Virtual coupler of Fig. 23.4: the force K (x - z) + b (x' - z') of a spring and damper from handle to proxy.

    It is at once the force on the environment and the force on the proxy z; it covers K and b, and sees the handle
    between samples as ``hold`` says. As the force that is felt it takes v(t) = v(n), the plain backward difference on a
    board, so the two sides differ by b a T/2, with a the acceleration of the handle: 0.036 % of K times 10 mm at
    K = 500 N/m, b = 1 N s/m, T = 1 ms and 10 mm at 3 Hz. Looking ahead in the force as well would close that gap to
    0.007 % and ask for b more damping from the device (:class:`~hapticlab.methods.Hold`).

    Parameters
    ----------
    z : coordinate [m]
    K : Parameter or expression [N/m]
    b : Parameter or expression [N s/m]

    Returns
    -------
    sympy expression [N]

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m"); K, b = hl.parameters("K b", units="N/m N*s/m")
    >>> hl.laws.virtual_coupler(z, K=K, b=b)
    K*(-z(t) + x(t)) + b*(v(t) - Derivative(z(t), t))
    """
    return K * (x(t) - z) + b * (v(t) - z.diff(t))


def predicted_sample(signal: Callable[[sp.Expr], sp.Expr] = x) -> sp.Expr:
    """The next sample predicted from the last two, 2 x(n) - x(n-1), Eq. (23.4).

    Parameters
    ----------
    signal : callable
        The signal that is predicted, as a function of n: the handle's position ``x``, or a :func:`hapticlab.signal`.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.predicted_sample()
    2*x(n) - x(n - 1)
    """
    return 2 * signal(n) - signal(n - 1)
