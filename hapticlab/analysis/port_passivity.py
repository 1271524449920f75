"""Whether a device pays for what sampling adds, in every mode of a scene: the compiled tick, linearised, at its port."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..compiler.options import period
from ..compiler.step_matrix import rising
from ..errors import AnalysisError
from ..scene.scene import Scene
from ..scene.written import no_scene
from .limit import check_number
from .limit_plots import plot_port
from .linearization import motion_at, tick_at
from .operating import WORTH, kind_of, operating_points, probes_of
from .passive_hands import UNSTABLE, radii, single
from .port import required, unstable_pole
from .switches import switched

#: why a mode asks for what it asks, unless it is worse
WORST = "worst frequency"


@dataclass(frozen=True, eq=False)
class PortLimit:
    """One operating point in one mode.

    Attributes
    ----------
    mode, point : str
        The conditions that hold, and where that was looked at.
    b_req : float
        Least damping of a device [N s/m] with which the sampled scene is passive; inf where none is enough, nan where
        the scene falls from there by itself.
    floor : float
        What the force asks for that follows the handle alone, its bodies held: k T/2 + b of a spring and a damper.
    frequency : float
        Where b_req is asked for [Hz].
    reason : str
    """

    mode: str
    point: str
    b_req: float
    floor: float
    frequency: float
    reason: str
    tick: tuple = field(repr=False)


@dataclass(frozen=True, eq=False)
class PortPassivity:
    """The damping that a scene asks of a device, and what the device has; printing it shows every mode.

    Attributes
    ----------
    scene : str
    T, delay : float
        [s]
    modes : tuple of PortLimit
    kind : {"linear", "piecewise linear", "small-signal"}
        What it is worth: exact; exact within each mode; of small motions about the operating points.
    b_device, m : float or None
        Damping [N s/m] and mass [kg] of the paddle.
    """

    scene: str
    T: float
    delay: float
    modes: tuple
    kind: str
    b_device: float | None = None
    m: float | None = None

    @property
    def worst(self):
        """The mode that asks for the most."""
        return max(self.modes, key=lambda m: -1.0 if np.isnan(m.b_req) else m.b_req)

    @property
    def b_req(self):
        """Least damping of a device [N s/m] for every passive hand, in every mode that was looked at."""
        return self.worst.b_req

    @property
    def floor(self):
        """What the force asks for that follows the handle alone [N s/m]."""
        return self.worst.floor

    @property
    def frequency(self):
        """Where b_req is asked for [Hz]."""
        return self.worst.frequency

    @property
    def passive(self):
        """Whether the paddle's own damping is enough; None without a paddle, and where the scene falls by itself."""
        return None if self.b_device is None or np.isnan(self.b_req) else bool(self.b_device >= self.b_req)

    @property
    def small_signal(self):
        """Whether this is about small motions about the operating points alone."""
        return self.kind == "small-signal"

    @cached_property
    def b_stable(self):
        """Least damping [N s/m] with which the handle of this mass is stable in every mass and spring that was tried."""
        if self.m is None:
            return None
        asking = [m for m in self.modes if not np.isnan(m.b_req)]
        return max((stable_damping(m.tick, self.m, self.T, self.delay, m.b_req) for m in asking), default=np.nan)

    def __float__(self):
        return float(self.b_req)

    def __str__(self):
        enough = "passive" if self.passive else "not passive"
        has = "" if self.b_device is None else f"; the device has {self.b_device:.4g}: {enough}"
        head = f"{self.scene}, T = {1e3 * self.T:g} ms: needs b = {self.b_req:.4g} N s/m{has} ({WORTH[self.kind]})"
        lines = [head, f"  {'b [N s/m]':>10} {'floor':>8} {'at [Hz]':>8}  mode; where"]
        for m in self.modes:
            reason = "" if m.reason == WORST else f" ({m.reason})"
            lines.append(f"  {m.b_req:10.4g} {m.floor:8.4g} {m.frequency:8.4g}  {m.mode}; {m.point}{reason}")
        return "\n".join(lines)

    __repr__ = __str__

    def plot(self):
        """Draw the damping that each frequency asks of a device, in every mode."""
        return plot_port(self)


def port_passivity(scene, paddle=None, *, T=None, at=None, **options):
    """Least damping b_req [N s/m] of a device for a scene to be passive in every passive hand, in every mode of its contacts.

    Colgate and Schenkel's criterion on the tick of the compiled program, linearised at operating points; its cases are
    held in their modes. The velocity is the backward difference; without encoder, friction of the device and saturation.

    Parameters
    ----------
    scene : Scene
        Every parameter bound.
    paddle : optional
        With b [N s/m], m [kg], and delay [s] and T [s] where it has them.
    T : float, optional
        Sampling period [s], > 0; the paddle's unless given.
    at : dict name -> float, or sequence of them, optional
        Operating points, as in :func:`~hapticlab.analysis.step_limit.step_limit`.
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold, force_at.

    Returns
    -------
    PortPassivity

    Examples
    --------
    >>> import hapticlab as hl
    >>> wall = hl.wall()(k=200, x_o="10 mm")
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.15, T=1e-3)
    >>> port = hl.port_passivity(wall, paddle)
    >>> round(port.b_req, 9), port.worst.mode, port.passive
    (0.1, 'x(n) >= x_o', True)
    """
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "needs hl.port_passivity(hl.Scene(force=...), T=1e-3)"))
    if T is None and not hasattr(paddle, "T"):
        raise AnalysisError("T is missing; needs a sampling period, T=1e-3, or a paddle that has one")
    T = period(paddle.T if T is None else T)
    delay = check_number("delay", getattr(paddle, "delay", 0.0), "s", "needs delay >= 0", lambda d: d >= 0)
    known = switched(scene)
    points = operating_points(known, at, T)
    probes = probes_of(points)
    J, _ = motion_at(known, points, T)
    ticks, handle = tick_at(known, [*points, *probes], T, **options)
    flat = [np.concatenate([part.ravel() for part in map(np.asarray, tick)]) for tick in ticks]
    modes = tuple(
        _limit(known.named(p.mode), p.words, tick, slopes, T, delay, handle)
        for p, tick, slopes in zip(points, ticks, J, strict=False)
    )
    own = [None if paddle is None else float(getattr(paddle, name)) for name in ("b", "m")]
    return PortPassivity(scene.name, T, delay, modes, kind_of(known, points, probes, flat), *own)


def _limit(mode, point, tick, J, T, delay, handle):
    """Return the :class:`PortLimit` of one tick map; ``handle`` are the states that remember the handle alone."""
    A, B, C, D = tick
    if not all(np.isfinite(part).all() for part in (*tick, J)):
        raise AnalysisError(f"the force has no finite slope at {point}, {mode}; name places where it has, at={{...}}")
    held = np.ix_(handle, handle)
    floor = required(A[held], B[handle], C[handle], D, T, delay)[0]
    falls = int(rising(J)) if len(J) else 0
    pole = unstable_pole(A, B, C, falls)
    if pole is not None:
        return PortLimit(mode, point, np.inf, floor, 0.0, f"unstable with the handle held, a pole at {pole:.6g}", tick)
    if falls and unstable_pole(A, B, C) is not None:
        return PortLimit(mode, point, np.nan, floor, 0.0, "falls by itself: no motion near it is passive", tick)
    b_req, theta = required(A, B, C, D, T, delay)
    reason = "a resonance without damping" if np.isinf(b_req) else WORST
    return PortLimit(mode, point, b_req, floor, theta / (2 * np.pi * T), reason, tick)


def stable_damping(tick, m, T, delay=0.0, b_req=np.inf):
    """Return the least damping [N s/m] above which a handle of mass m is stable held by any mass and spring of a scan."""
    added, turns = np.meshgrid([0.0, 0.1, 1.0, 10.0, 100.0], np.r_[0.0, np.geomspace(1e-2, 3.0, 14)])
    masses = m * (1 + added.ravel())
    hands = single(masses, masses * (turns.ravel() / T) ** 2)
    top = b_req if np.isfinite(b_req) else 1e3 * (abs(tick[3]) * T + m / T)

    def unstable(b):
        return bool((radii(tick, hands, b, T, delay) > 1 + UNSTABLE).any())

    levels = top * np.r_[np.geomspace(1.0, 1e-3, 13), 0.0]
    last = next((k for k, b in enumerate(levels) if unstable(b)), None)
    if last is None:
        return 0.0
    if last == 0:
        return float(top) if np.isfinite(b_req) else np.inf
    high, low = levels[last - 1], levels[last]
    for _ in range(10):
        middle = (high + low) / 2
        high, low = (high, middle) if unstable(middle) else (middle, low)
    return float(high)
