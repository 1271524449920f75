"""Whether a device pays for what sampling adds, in every mode of a scene: the compiled tick, linearised, at its port."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ...base.shows_itself import Tabular
from ...device.device import known
from ...errors import AnalysisError
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .condition_switches import switched
from .limit_plots import plot_port
from .linearization import forces_and_ticks_at
from .operating_points import WORTH
from .passive_hands import UNSTABLE, radii, single
from .port_limits import WORST, Looked

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    from ...device.device import AnyDevice
    from .port_limits import PortLimit

#: what enough damping guarantees of a scene of each kind
PASSIVE = {"linear": "passive", "piecewise linear": "passive in each mode", "small-signal": "passive in small motions"}
#: and what may draw energy all the same
BEYOND = {
    "piecewise linear": "motions from one mode to another",
    "small-signal": "large motions and motions from one mode to another",
}


@dataclass(frozen=True, eq=False)
class PortPassivity(Tabular):
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
    travel : float or None
        The handle was looked at as far to either side [m]; None where places were given.
    """

    scene: str
    T: float
    delay: float
    modes: tuple[PortLimit, ...]
    kind: Literal["linear", "piecewise linear", "small-signal"]
    b_device: float | None = None
    m: float | None = None
    travel: float | None = None

    @property
    def worst(self) -> PortLimit:
        """The mode that asks for the most; one that falls before all others."""
        return max(self.modes, key=lambda m: (np.isnan(m.b_req), m.b_req))

    @property
    def b_req(self) -> float:
        """Least damping of a device [N s/m] for every passive hand, in every mode that was looked at."""
        return self.worst.b_req

    @property
    def floor(self) -> float:
        """What the force asks for that follows the handle alone [N s/m]."""
        return self.worst.floor

    @property
    def frequency(self) -> float:
        """Where b_req is asked for [Hz]."""
        return self.worst.frequency

    @property
    def passive(self) -> bool | None:
        """Whether the paddle's own damping is enough in each mode; None without a paddle, and where the scene falls by itself.

        Of a scene that switches this is no proof: a motion from mode to mode may draw energy that no mode alone gives
        (:func:`~hapticlab.analysis.stability.worst_motion.worst_motion`).
        """
        return None if self.b_device is None or np.isnan(self.b_req) else bool(self.b_device >= self.b_req)

    @property
    def small_signal(self) -> bool:
        """Whether this is about small motions about the operating points alone."""
        return self.kind == "small-signal"

    @cached_property
    def b_stable(self) -> float | None:
        """Least damping [N s/m] with which the handle of this mass is stable in every mass and spring that was tried."""
        if self.m is None:
            return None
        # from where a nonlinear scene moves on it is not a question of damping
        asking = [m for m in self.modes if np.isnan(m.b_req) or not m.stiffness < 0]
        if any(np.isinf(m.floor) for m in asking):  # the force jumps
            return np.inf
        return max((stable_damping(m.tick, self.m, self.T, self.delay, m.b_req) for m in asking), default=np.nan)

    def __float__(self) -> float:
        return float(self.b_req)

    def __str__(self) -> str:
        passive = PASSIVE[self.kind]
        enough = {True: passive, False: "not passive", None: "no damping makes it passive"}[self.passive]
        has = "" if self.b_device is None else f"; the device has {self.b_device:.4g}: {enough}"
        head = f"{self.scene}, T = {1e3 * self.T:g} ms: needs b = {self.b_req:.4g} N s/m{has} ({WORTH[self.kind]}"
        head += ")" if self.travel is None else f"; handle within +-{1e3 * self.travel:g} mm)"
        lines = [head, f"  {'b [N s/m]':>10} {'floor':>8} {'at [Hz]':>8}  mode; where"]
        for m in self.modes:
            reason = "" if m.reason == WORST else f" ({m.reason})"
            lines.append(f"  {m.b_req:10.4g} {m.floor:8.4g} {m.frequency:8.4g}  {m.mode}; {m.point}{reason}")
        if self.passive and self.kind != "linear":
            lines.append(f"  not covered: {BEYOND[self.kind]}. hl.passivity.worst_motion(paddle, scene) searches these motions.")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw the damping that each frequency asks of a device, in every mode."""
        return plot_port(self)


def port_passivity(
    device: AnyDevice,
    scene: Scene,
    *,
    at: Mapping[str, float] | Sequence[Mapping[str, float]] | None = None,
    **options: Any,
) -> PortPassivity:
    """Least damping b_req [N s/m] of a device for a scene to be passive in every passive hand, in every mode of its contacts.

    Colgate and Schenkel's criterion on the tick of the compiled program, linearised at operating points; its cases are
    held in their modes. The velocity is the backward difference; without encoder, friction of the device and saturation.

    Parameters
    ----------
    device : Device or paddle
        Its T and delay are read; and b and m where they are known.
    scene : Scene
        Every parameter bound.
    at : dict name -> float, or sequence of them, optional
        Operating points, as in :func:`~hapticlab.analysis.stability.step_limit.step_limit`.
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
    >>> port = hl.passivity.port(paddle, wall)
    >>> round(port.b_req, 9), port.worst.mode, port.passive
    (0.1, 'x(n) >= x_o', True)
    """
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "needs hl.passivity.port(paddle, hl.Scene(force=...))"))
    T, delay, b, m = known(device, "T", "delay", or_none="b m")
    modes_of = switched(scene)
    looked = Looked(modes_of, at, T)
    forces, ticks, handle = forces_and_ticks_at(modes_of, looked.all, T, **options)
    modes, kind = looked.limits(forces, ticks, handle, T, delay)
    return PortPassivity(scene.name, T, delay, modes, kind, b, m, looked.travel)


def stable_damping(tick, m, T, delay=0.0, b_req=np.inf):
    """Return the least damping [N s/m] above which a handle of mass m is stable held by any mass and spring of a scan."""
    added, turns = np.meshgrid([0.0, 0.1, 1.0, 10.0, 100.0], np.r_[0.0, np.geomspace(1e-2, 3.0, 14)])
    masses = m * (1 + added.ravel())
    hands = single(masses, masses * (turns.ravel() / T) ** 2)
    most = 1e3 * (abs(tick[3]) * T + m / T)

    def unstable(b):
        return bool((radii(tick, hands, b, T, delay) > 1 + UNSTABLE).any())

    # with b_req it is stable, were it not for what a linearisation falls by
    top = b_req if 0 < b_req < np.inf and not unstable(b_req) else most
    levels = top * np.r_[np.geomspace(1.0, 1e-7 if top == most else 1e-3, 25), 0.0]
    last = next((k for k, b in enumerate(levels) if unstable(b)), None)
    if last is None:
        return 0.0
    if last == 0:
        return np.inf
    high, low = levels[last - 1], levels[last]
    for _ in range(10):
        middle = (high + low) / 2
        high, low = (high, middle) if unstable(middle) else (middle, low)
    return float(high)
