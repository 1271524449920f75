"""Shared control: forces of an automatic controller on the handle that a hand holds too; guidance and tremor filter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import instance, number
from ...base.units import in_si
from ...errors import SceneError
from ..notation.amount import Amount
from ..notation.parameters import T
from ..notation.symbols import n, parameters, signal, t, v, when, x
from ..scene import Scene

if TYPE_CHECKING:
    from ...base.annotations import Term


def guidance(path: sp.Expr) -> Scene:
    """Guidance fixture: a controller's spring and damper guide the handle along a path, and yield beyond F_max.

    Hand and controller pull on one handle (shared control, Section 23.1.3): the hand feels where the controller means
    to go, follows, or overrides it. F = clip(k (x - path) + b (v - path'), -F_max, F_max).

    Parameters
    ----------
    path : expression [m]
        Where the controller means to be, of ``hl.t`` and parameters with units, or one coordinate of an equation of
        motion.

    Returns
    -------
    Scene
        With parameters k [N/m] >= 0, b [N s/m] >= 0 and F_max [N] >= 0, which is the controller's whole authority.

    Examples
    --------
    >>> import numpy as np
    >>> import sympy as sp
    >>> import hapticlab as hl
    >>> A, w = hl.parameters("A w", units="m 1/s", values=(0.01, 2))
    >>> guided = hl.laws.guidance(A * sp.sin(w * hl.t))(k=200, b=1, F_max=1.5)
    >>> log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(guided, duration=3.0)   # nobody holds the handle
    >>> bool(abs(log.x[2000:] - 0.01 * np.sin(2 * log.t[2000:])).max() < 1e-4)
    True
    """
    need = "an expression of hl.t and parameters, such as A*sympy.sin(w*hl.t)"
    instance("path", path, (sp.Expr, int, float), need, error=SceneError)
    k, b, most = parameters("k b F_max", units="N/m N*s/m N")
    force = k * (x(n) - path) + b * (v(n) - sp.diff(path, t))
    return Scene(force=sp.Max(sp.Min(force, most), -most), name="guidance")


def tremor_filter(centre: Term = "10 Hz", bandwidth: Term = "6 Hz") -> Scene:
    """Tremor filter: a damper B that acts within a band of frequencies and leaves slow motion alone.

    The velocity passes a digital band-pass of second order: gain 1 and no phase at the centre, half the power at the
    two edges, exactly, nothing at rest and at Nyquist (the bilinear transform, both frequencies prewarped). F is B
    times what passes, so that the hand's own tremor shrinks, not only its record.

    Parameters
    ----------
    centre, bandwidth : number [Hz] or text with a unit
        Physiological tremor has its peak between 6 and 12 Hz. The bandwidth is that between the edges. Both need a
        sampling rate of more than twice as much; at a lower one the force is no number, and the motor stays off.

    Returns
    -------
    Scene
        With the parameter B [N s/m] >= 0, and the velocity that passed watched as ``passed``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> scene = hl.laws.tremor_filter()(B=20)
    >>> round(hl.passivity.port_damping(hl.Device(T="1 ms"), scene), 3)       # what it asks of the device, in N s/m
    0.631
    """
    centre, bandwidth = (_frequency(name, given) for name, given in (("centre", centre), ("bandwidth", bandwidth)))
    B = parameters("B", units="N*s/m")
    band = signal("v_band", unit="m/s")
    widening = sp.tan(Amount(math.pi * bandwidth, "1/s") * T)
    turning = 2 * sp.cos(Amount(2 * math.pi * centre, "1/s") * T)
    passed = (widening * (v(n) - v(n - 2)) + turning * band(n - 1) - (1 - widening) * band(n - 2)) / (1 + widening)
    # known when a scene is compiled: above Nyquist a division by zero, and so a motor that is off, instead of an alias
    below = signal("below_nyquist", unit="1")
    eom = [
        sp.Eq(below(n), when(Amount(2 * max(centre, bandwidth), "1/s") * T < 1, 1, 0)),
        sp.Eq(band(n), passed / below(n)),
    ]
    return Scene(force=B * band(n), eom=eom, watch={"passed": band(n)}, name="tremor filter")


def _frequency(name, given):
    value = in_si(given, "Hz", name) if isinstance(given, str) else given
    return number(name, value, "Hz", "a band", above=0, what="a frequency", error=SceneError)
