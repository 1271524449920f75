"""Linear stability of a handle, a hand and a law that always acts: exact poles, exact limit.

Between changes of the force the plant moves by its matrix exponential. The characteristic equation is affine in the
stiffness, p0(z) + K p1(z) = 0, so a pole can cross the unit circle only at an angle where p0/p1 is real. These angles
are the roots of a polynomial in cos(theta), and of slow ones, which rounding hides there, where the imaginary part
changes its sign along a logarithmic scale; each gives one K, and the poles between two of them say which one counts.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from ..base.arguments import number
from ..base.roots import root
from ..device.device import known
from ..errors import AnalysisError
from ..scene.laws.taps import LEAD
from ..scene.scene import Scene
from .limit import Limit
from .linear_law import LinearLaw
from .loop import Loop
from .port import static_stiffness

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..base.annotations import Array
    from ..device.device import AnyDevice
    from .affine_law import StiffnessLaw

KIND = "exact linear stability of this plant"
NOTES = (
    "handle, hand, delay and law alone, the spring always acting",
    "does not account for encoder, noise, Coulomb friction, force limit and the hand's push; a unilateral wall can chatter "
    "at a lower stiffness",
)
ESTIMATED = "the paddle estimates v by backward difference, so half_sample is the law backward_difference, Eq. (23.5)"
#: how far from 1 the largest |pole| at a limit may be; a law of hundreds of samples has a polynomial of no digits
ON_CIRCLE = 1e-6
#: angles [rad] at which slow poles are looked for: from a handle of 1e14 kg to where cos(theta) has digits enough
SLOW_ANGLES = np.geomspace(1e-11, 0.05, 400)


def stability_limit(device: AnyDevice, *, law: StiffnessLaw = "zoh", B: float = 0.0, parameter: str = "k") -> Limit:
    """Largest stiffness at which this paddle in this hand is stable: the eigenvalues of the sampled loop.

    The limit is linear, with the spring always acting. It does not account for encoder, noise, Coulomb friction, force
    saturation and the hand's push. A different hand may be unstable at a lower stiffness
    (:func:`~hapticlab.limits.passivity.passivity_limit`), and a unilateral wall whose law uses past samples chatters at
    a lower stiffness.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay, hand and velocity are used. The delay can have whole and fractional periods.
    law : str, Scene or callable
        Eqs. (23.1), (23.3), (23.5), (23.7) by name: "zoh", "half_sample", "backward_difference", "ellis"; half_sample
        uses the exact velocity at the sample where the paddle measures it. Where it is estimated (``device.velocity``:
        an encoder, a board) Eq. (23.3) is Eq. (23.5), and so is its limit. Or a linear scene with its stiffness
        unbound: filters, estimated velocities, ``hl.laws.force_filter`` (23.8); a stiffness that it holds is not used.
        Or a function of K [N/m] that returns a LinearLaw.
    B : float
        Virtual damper of either sign [N s/m]: its force is ``B*(x[n] - x[n-1])/T``, in addition to a named law, not
        through it.
    parameter : str
        The scene's parameter that is K; its force must be affine in it.

    Returns
    -------
    Limit
        ``frequency`` is that at which stability is lost. K = 0 with the reason if the smallest stiffness is unstable.

    Raises
    ------
    AnalysisError
        For a plant value that is not finite or out of range, and a law that is unknown, not linear or not affine in K.

    Examples
    --------
    >>> import hapticlab as hl
    >>> device = hl.Device(m=0.05, b=0.1, T="1 ms")
    >>> round(stability_limit(device).K, 6)
    200.066689
    >>> filtered = hl.laws.force_filter(hl.wall(unilateral=None))        # Eq. (23.8) around (23.1) is Eq. (23.7)
    >>> round(stability_limit(device, law=filtered).K / stability_limit(device, law="ellis").K, 9)
    1.0
    """
    loop = Loop.of(device, law, B, parameter)
    estimated = isinstance(law, str) and LEAD[law] and known(device, "velocity") == ("backward_difference",)
    notes = NOTES + (ESTIMATED,) * bool(estimated)
    if not any(part.any() for part in (loop.law.B1, loop.law.C1, loop.law.D1)):
        raise AnalysisError(
            f"{loop.law.name} does not depend on a stiffness. Give a scene with {parameter} unbound, or use hl.stability.poles"
        )
    edges, stable = _intervals(loop)
    if stable[0] and all(stable):
        return Limit(math.inf, None, KIND, "no stiffness moves a pole out of the unit circle", notes)
    first = stable.index(False)
    K, theta = edges[first - 1] if first else (0.0, None)
    if first and abs(abs(1 + loop.poles(K)).max() - 1) > ON_CIRCLE:
        raise AnalysisError(
            f"{loop.law.name}: {len(loop.law.A)} states, too many for an accurate characteristic polynomial. Use "
            "hl.stability.poles(K=...) for each K"
        )
    reason = "a pole crosses the unit circle" if first else _why_none(device, law, B, any(stable))
    again = next((i for i in range(first, len(stable)) if stable[i]), None)
    if again is not None:  # such a wall has to be made stiff before it is touched
        top = f" to {edges[again][0]:.6g}" if again < len(edges) else " on"
        reason += f"; stable again from {edges[again - 1][0]:.6g}{top} N/m"
    return Limit(K, None if theta is None else theta / (2 * math.pi * loop.T), KIND, reason, notes)


def _intervals(loop):
    """Return every crossing as (K, theta), and whether the loop is stable below the first, between two, and above the last."""
    edges = crossings(loop)
    K = [k for k, _ in edges]
    # the least K to look at when nothing crosses: well inside any band that a sampled plant of this mass can hold
    between = [k / 2 for k in K[:1]] + [math.sqrt(a * b) for a, b in zip(K, K[1:], strict=False)]
    between.append(max([0.1 * loop.scale, *(2 * k for k in K[-1:])]))
    return edges, [not loop.unstable(k) for k in between]


def damper_limit(device: AnyDevice) -> float:
    """Largest B [N s/m] at which a handle with the damper F = B (x[n] - x[n-1])/T alone is stable; exact, linear.

    Without device damping and delay it is 2 m/T. A hand adds mass, which raises it, and may add stiffness, which lowers
    it. Up to B = b the damper is moreover passive in any hand, Eq. (23.10).

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay and hand are read, the delay in whole and fractional periods alike.

    Returns
    -------
    float

    Examples
    --------
    >>> import hapticlab as hl
    >>> round(damper_limit(hl.Device(m=0.05, b=0, T="1 ms")), 9)
    100.0
    """
    (T,) = known(device, "T")
    return stability_limit(device, law=lambda B: LinearLaw.of("zoh", K=0.0, T=T, B=B)).K  # B takes the place of K


def closed_loop_matrix(
    device: AnyDevice, *, K: float | None = None, law: StiffnessLaw | LinearLaw = "zoh", B: float = 0.0, parameter: str = "k"
) -> Array:
    """One period of handle, hand and law as a matrix on [x, v, past forces, states of the law]; SI units.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay and hand are read.
    law : str, Scene, LinearLaw or callable
        As for :func:`stability_limit`.
    B : float
        Virtual damper of either sign [N s/m], in parallel with the law.
    parameter : str
        The scene's parameter that is K.
    K : float
        Stiffness [N/m]; None for a LinearLaw or a scene that holds its own, and for these alone. The others are those
        of :func:`stability_limit`.

    Returns
    -------
    array of shape (n, n)
        n = 2, plus one past force [N] for every begun period of delay, plus the states of the law: of a named one the
        past samples [m] it looks at.

    Examples
    --------
    >>> import hapticlab as hl
    >>> device = hl.Device(m=1, b=0, T=0.1)
    >>> hl.stability.matrix(device, K=100.0).round(9).tolist()
    [[0.5, 0.1], [-10.0, 1.0]]
    """
    loop, K = _loop_at(device, K, law, B, parameter)
    return loop.matrix(K)


def closed_loop_poles(
    device: AnyDevice, *, K: float | None = None, law: StiffnessLaw | LinearLaw = "zoh", B: float = 0.0, parameter: str = "k"
) -> NDArray[np.complex128]:
    """Eigenvalues of :func:`closed_loop_matrix`, largest magnitude first: complex array of shape (n,).

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay and hand are read.
    K : float, optional
        Stiffness [N/m]; None for a LinearLaw or a scene that holds its own.
    law : str, Scene, LinearLaw or callable
        As for :func:`stability_limit`.
    B : float
        Virtual damper of either sign [N s/m], in parallel with the law.
    parameter : str
        The scene's parameter that is K.
    """
    loop, K = _loop_at(device, K, law, B, parameter)
    poles = 1 + loop.poles(K)
    return poles[np.argsort(-abs(poles), kind="stable")]


def _loop_at(device, K, law, B, parameter):
    """Return the loop and the stiffness to take it at; refuse a stiffness given twice, or not at all."""
    if K is None and isinstance(law, (LinearLaw, Scene)):
        return Loop.of(device, law, B, None), 0.0  # what holds its own is the same at every K
    if K is None:
        raise AnalysisError("K = None, and the law contains no stiffness. Give one in N/m: hl.stability.poles(..., K=100)")
    K = number("K", K, "N/m", what="stiffness")
    if isinstance(law, LinearLaw):
        raise AnalysisError(f"K = {K:g} N/m with {law.name}, which has its own stiffness. Leave out K")
    if isinstance(law, Scene) and parameter in law.values:
        raise AnalysisError(
            f"K = {K:g} N/m with {law.name} with {parameter} = {law.values[parameter]:g}. Leave out K, or bind it in the "
            f"scene: scene({parameter}={K:g})"
        )
    if isinstance(law, Scene) and parameter not in law.parameters and set(law.parameters) <= set(law.values):
        raise AnalysisError(
            f"K = {K:g} N/m, but {law.name} has no parameter {parameter}. Leave out K, or name the stiffness with parameter="
        )
    return Loop.of(device, law, B, parameter), K


def _why_none(device, law, B, somewhere):
    """Say why the smallest stiffness is unstable, and whether all are."""
    name = law if isinstance(law, str) else getattr(law, "name", "of its own")
    b, hand = known(device, "b", "hand")
    undamped = b == 0 and (hand is None or hand.b == 0)
    which = "at the smallest stiffness" if somewhere else "at any stiffness"
    if undamped and not B:
        return f"without damping (b = 0) law {name} generates energy {which}"
    damper = f"B = {B:g} N s/m with " if B else ""
    return f"{damper}b = {b:g} N s/m under law {name} is unstable {which}"


def crossings(loop):
    """Return every (K, theta) with K > 0 and a pole on the unit circle at e^(j theta), by rising K."""
    angles = [*_at_rest(loop), *_fast_angles(loop), *_slow_angles(loop), math.pi]
    p0, p1 = _on_circle(loop, np.array(angles))
    found = []
    for theta, a, b in zip(angles, p0, p1, strict=True):
        K = -(a * np.conj(b)).real / abs(b) ** 2 if b else 0.0
        if K > 1e-12 * abs(a) / (abs(b) or 1.0):
            found.append((float(K), float(theta)))
    found.sort()
    return [one for i, one in enumerate(found) if i == 0 or not _same(one, found[i - 1])]


def _at_rest(loop):
    """Return the angle zero where a constant stiffness and K can cancel, as in (K - 500) x: a pole at z = 1 passes there."""
    law = loop.law
    own = static_stiffness(law.A, law.B0[:, 0], law.C0, law.D0[0])
    by_K = static_stiffness(law.A, law.B0[:, 0], law.C1, law.D1[0]) + static_stiffness(law.A, law.B1[:, 0], law.C0, 0.0)
    known = not math.isnan(own + by_K)  # an integrator has no stiffness at rest
    return [0.0] if known and by_K and (own or loop.determinant) else []


def _same(one, other):
    return all(abs(a - b) <= 1e-9 * abs(b) for a, b in zip(one, other, strict=True))


def _on_circle(loop, theta):
    """Return p0 and p1 at z = e^(j theta)."""
    return loop.characteristic(-2 * np.sin(theta / 2) ** 2 + 1j * np.sin(theta))


def _fast_angles(loop):
    """Return the roots in cos(theta) of Im(p0 conj p1)/sin(theta)."""
    p0, p1 = loop.polynomials()
    n = len(p0)
    products = np.correlate(p0, p1, "full")  # Im(p0 conj p1) is a sum of (products[+j] - products[-j]) sin(j theta)
    sines = products[n:] - products[: n - 1][::-1]
    # sin(j theta)/sin(theta) is the derivative of T_j(u)/j
    curve = chebyshev.chebder(np.r_[0.0, sines / np.arange(1, n)])
    while len(curve) > 1 and abs(curve[-1]) < 1e-15 * abs(curve).max():
        curve = curve[:-1]
    u = chebyshev.chebroots(curve) if len(curve) > 1 else np.array([])
    u = u.real[(abs(u.imag) < 1e-6) & (abs(u.real) < math.cos(SLOW_ANGLES[-2]))]
    return [_polish(loop, theta) for theta in np.arccos(u).tolist()]


def _slow_angles(loop):
    """Return where Im(p0 conj p1) changes its sign at angles whose cosine is 1 to rounding, or nearly."""
    p0, p1 = _on_circle(loop, SLOW_ANGLES)
    with np.errstate(invalid="ignore"):
        phase = (p0 * np.conj(p1)).imag / (abs(p0) * abs(p1))
    sign = np.where(abs(phase) > 1e-14, np.sign(phase), 0.0)
    imaginary = partial(_imaginary, loop)
    return [root(imaginary, *SLOW_ANGLES[i : i + 2]) for i in np.flatnonzero(sign[1:] * sign[:-1] < 0)]


def _imaginary(loop, theta):
    p0, p1 = loop.characteristic(complex(-2 * math.sin(theta / 2) ** 2, math.sin(theta)))
    return (p0 * p1.conjugate()).imag / math.sin(theta)


def _polish(loop, theta):
    """Move an angle onto the root by secant steps, in arithmetic that keeps small angles."""
    before, at = theta * (1 - 1e-7), theta
    f_before, f_at = _imaginary(loop, before), _imaginary(loop, at)
    for _ in range(8):
        if f_at in (0.0, f_before):
            break
        step = -f_at * (at - before) / (f_at - f_before)
        if not abs(step) < 1e-3 * theta:
            return theta  # a double root: the guess is as good as it gets
        before, f_before, at = at, f_at, at + step
        f_at = _imaginary(loop, at)
        if abs(step) < 1e-16 * at:
            break
    return at
