"""How much damping a device needs for a linear scene to be passive in any passive hand: the tick of its program, measured.

Colgate and Schenkel (1997): a force F = H(z) x held over each period is passive with a device of damping b where
``b > T Re{H(e^{j w T})/(1 - e^{j w T})}`` at every frequency. H is taken from the program itself, hold, method and estimator
of velocity included: it is run once from every unit state and unit input.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..compiler.algebra.phase import is_timed
from ..compiler.engines.engine import load
from ..compiler.tick.compile_scene import compile
from ..device.device import known
from ..errors import AnalysisError
from .limit import whole_and_fraction

if TYPE_CHECKING:
    from ..base.annotations import Array
    from ..compiler.ir.program import Program
    from ..device.device import AnyDevice
    from ..scene.scene import Scene

#: a pole nearer to the unit circle does not decay, and its resonance has no bound
LOSSLESS = 1e-9
#: a second place of the handle, no whole number of any period
TRIAL = -0.437219
#: and states and position of a micrometre, beside those of a metre [m]
SMALL = 1e-6
#: part of the stiffnesses that make up a static one, which is rounding
ROUNDING = 1e-7
#: frequencies looked at, beside those around every pole
POINTS = 1000
#: the lowest of them as w T, and part of the largest value below which two are alike: rounding at the lowest is 1e-10
SLOWEST, ALIKE = 1e-5, 1e-9


def port_damping(device: AnyDevice, scene: Scene, **options: Any) -> float:
    """Least damping b [N s/m] of a device with which a linear scene is passive in every passive hand.

    Necessary and sufficient for the sampled scene as compiled, without encoder. A wall k x needs k T/2, and
    every damper of the scene's coupler as much again.

    Parameters
    ----------
    device : Device or paddle
        Its T and delay are read.
    scene : Scene
        Linear, every parameter bound.
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold. Velocity is the backward difference.

    Returns
    -------
    float
        ``inf`` where a resonance has no damping at all.

    Raises
    ------
    AnalysisError
        The scene is not linear, or unstable, or of negative stiffness, with which no damping is enough.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, b = hl.parameters("k b", units="N/m N*s/m", values=(200, 0.05))
    >>> round(port_damping(hl.Device(T="1 ms"), hl.Scene(force=k * hl.x(hl.n) + b * hl.v(hl.n))), 9)
    0.15
    """
    T, delay = known(device, "T", "delay")
    A, B, C, D = tick_map(compile(scene, T=T, live=(), dtype="float64", **options))
    pole = unstable_pole(A, B, C)
    if pole is not None:
        raise AnalysisError(f"{scene.name}: unstable with the handle held (a pole at {pole:.6g}); T is too long for it")
    stiffness = static_stiffness(A, B, C, D)
    if stiffness < 0:
        raise AnalysisError(f"{scene.name}: {negative(stiffness)}, and no device damping can hold it; needs k >= 0 felt at rest")
    return required(A, B, C, D, T, delay)[0]


def static_stiffness(A, B, C, D):
    """Return the force per displacement [N/m] that a handle feels which has been moved and waited: H(1), 0.0 by rounding.

    What is not seen at the port may stay where it is, as a free mass: of all places of rest the nearest is taken. Where
    there is none, a pole at z = 1 is seen, which no damping is enough for anyway (:func:`required`): nan.
    """
    rest = np.linalg.lstsq(np.eye(len(A)) - A, B, rcond=1e-13)[0] if len(A) else B
    if len(A) and np.abs(A @ rest + B - rest).max() > ROUNDING * max(np.abs(B).max(), np.abs(rest).max()):
        return np.nan
    stiffness, size = float(C @ rest + D), np.abs(C) @ np.abs(rest) + abs(D)
    return 0.0 if abs(stiffness) <= ROUNDING * size else stiffness


def negative(stiffness):
    """Return in words what a negative static stiffness [N/m] does."""
    return f"negative stiffness, {stiffness:.4g} N/m: a free handle moves away"


def unstable_pole(A, B, C, allowed=0):
    """Return the largest |pole| outside the unit circle that x moves and F shows, None where no more than ``allowed`` are."""
    outside = np.sort(np.abs(_seen_poles(A, B, C)))[::-1]
    outside = outside[outside > 1 + LOSSLESS]
    return float(outside[0]) if len(outside) > allowed else None


def required(A, B, C, D, T, delay=0.0, points=POINTS):
    """Return (b, theta): the least damping of a device [N s/m] and w T at the frequency that asks for it, 0.0 for slow motion.

    A delay of d + f periods: ``H`` averaged over the two forces of a period, and one term more, see
    :mod:`hapticlab.limits.passivity`. A resonance without damping asks for inf. ``points`` is how many frequencies are
    looked at to begin with, twice, beside those around every pole.
    """
    seen = _seen_poles(A, B, C)
    lossless = seen[np.abs(seen) > 1 - LOSSLESS]
    if len(lossless):
        return np.inf, float(np.abs(np.angle(lossless)).max())
    poles = np.linalg.eigvals(A) if len(A) else np.zeros(0)
    around = [np.abs(np.angle(p)) + (1 - abs(p)) * s * np.geomspace(1e-2, 30, 40) for p in poles for s in (-1, 1)]
    theta = np.concatenate([np.geomspace(SLOWEST, np.pi, points), np.linspace(1e-3, np.pi, points), *around])
    theta = np.unique(theta[(theta > 0) & (theta <= np.pi)])
    slow = float(asked(A, B, C, D, T, np.array([SLOWEST]), delay)[0])
    for _ in range(4):  # look closer around the worst
        values = asked(A, B, C, D, T, theta, delay)
        worst = int(values.argmax())
        at = theta[worst]
        theta = np.linspace(theta[max(worst - 1, 0)], theta[min(worst + 1, len(theta) - 1)], 60)
    most = float(values.max())
    return max(most, 0.0), 0.0 if slow >= most - ALIKE * abs(most) else float(at)


def asked(A, B, C, D, T, theta, delay=0.0):
    """Return the damping [N s/m] that each frequency w asks of a device, theta = w T of shape (P,)."""
    whole, fraction = whole_and_fraction(delay, T)
    z = np.exp(1j * theta)
    inside = np.linalg.solve(z[:, None, None] * np.eye(len(A)) - A, B[None, :, None])[..., 0] if len(A) else np.zeros((1, 0))
    H = (inside @ C + D) * z ** -float(whole)
    averaged = H * ((1 - fraction) + fraction / z)
    linear = T / 2 * (averaged.real - averaged.imag / np.tan(theta / 2))  # 1/(1 - e^(j a)) is 1/2 + j cot(a/2)/2
    return (linear + np.sqrt(linear**2 + T**2 * fraction * (1 - fraction) * abs(H) ** 2)) / 2 if fraction else linear


def tick_map(program: Program) -> tuple[Array, Array, Array, float]:
    """Return A, B, C, D of one tick: states' = A states + B x, F = C states + D x, measured on unit states.

    Raises
    ------
    AnalysisError
        The program is not linear, or takes more than x.
    """
    if len(program.inputs) != 1 or is_timed(program):
        raise AnalysisError(f"{program.name}: needs a force that depends on x alone and not on time")
    S, generator = len(program.states), np.random.default_rng(1)
    mixed = generator.normal(size=(S, 3))
    states = np.column_stack([np.zeros((S, 1)), np.eye(S), mixed])
    loaded, values = load(program), np.repeat(np.array(program.values)[:, None], states.shape[1], axis=1)
    runs = [loaded.run(1, [[x]], values, states) for x in (0.0, 1.0, TRIAL)]
    still, pushed, pulled = (np.vstack([run.states, run.outputs[0, :1]]) for run in runs)
    rest, by_input = still - still[:, :1], pushed - still
    whole, scale = rest[:, 1 : S + 1], 1e-9 * max(np.abs(still).max(), np.abs(pushed).max())
    pairs = ((whole @ mixed, rest[:, S + 1 :]), (by_input, by_input[:, :1]), (pulled - still, TRIAL * by_input))
    run = loaded.run(1, [[SMALL]], values, SMALL * states)  # what is switched by distances has another answer here
    small = (np.vstack([run.states, run.outputs[0, :1]]) - still[:, :1]) / SMALL
    linear = np.allclose(small, rest + by_input[:, :1], rtol=0, atol=1e3 * scale)
    if not (linear and all(np.allclose(one, other, rtol=0, atol=scale) for one, other in pairs)):
        raise AnalysisError(f"{program.name} is not linear: its answer to two states is not the sum of its answers to each")
    return whole[:S], by_input[:S, 0], whole[S], by_input[S, 0]


def _seen_poles(A, B, C):
    """Return the poles that x moves and F shows."""
    if not len(A):
        return np.zeros(0)
    values, V = np.linalg.eig(A)
    back = np.linalg.pinv(V)
    size = np.abs(back @ B) * np.abs(C @ V)
    return values[size > 1e-9 * size.max(initial=0.0)]
