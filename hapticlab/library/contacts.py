"""Contacts behind the handle: a ball to juggle, a block that sticks and slips."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..scene.contact.contact import Contact, friction
from ..scene.contact.instant_laws import impulse
from ..scene.mechanics.lagrange import lagrange
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene
from .bodies import coupler
from .sketch import SOFT, Sketch, clearance

if TYPE_CHECKING:
    from typing import Any

    from ..base.annotations import Number


def ball_on_the_paddle(contact_law: Any = None) -> Scene:
    """Ball on a paddle, to juggle: it flies freely, y'' = -g, and rebounds from a plate z with restitution e.

    The handle moves up and down, x up; a virtual coupler ties the plate of mass M to it, and lets one feel an impulse
    (1 + e) m M/(m + M) (y' - z') that no motor could give at once. Struck with one stroke a flight, the ball is juggled
    where the plate decelerates at impact: that is stable without looking.

    Teaches impact, restitution, hybrid dynamics and open-loop stability; S. Schaal and C. G. Atkeson, *Open loop stable
    control strategies for robot juggling*, ICRA 1993. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms, and
    ``method="taylor"``, which locates each impact: that does not fit an Uno. A penalty contact of
    500 N/m does, at 500 Hz by semi-implicit Euler.

    Parameters
    ----------
    contact_law : contact law, optional
        ``impulse(e=e)`` unless given; ``hl.contact.penalty(k=k_b)``, with a parameter k_b, runs with any method.

    Returns
    -------
    Scene
        With m, M [kg], g, e, h [m], from where the ball falls on the plate, and K, b_c of the coupler.

    Examples
    --------
    >>> import hapticlab as hl
    >>> list(hl.library.ball_on_the_paddle().watch)
    ['y', 'z']
    """
    m, M, g, h = parameters("m M g h", units="kg kg m/s^2 m", values=(0.03, 0.1, 9.81, 0.08))
    z, y = coordinate("z", unit="m", initial=x(n)), coordinate("y", unit="m", initial=x(n) + h)
    e, F_c = parameters("e", units="1", values=0.8, ranges=(0, 1)), coupler(z)
    touch = Contact(y - z, contact_law or impulse(e=e), name="touch")
    kinetic = m * y.diff(t) ** 2 / 2 + M * z.diff(t) ** 2 / 2
    motion = lagrange(kinetic - m * g * y, forces={z: F_c}, contacts=[touch])
    return Scene(force=F_c, eom=[motion], watch=[y, z], name="ball on the paddle")


def draw_ball_on_the_paddle(axes, *, x=-0.01, z=-0.004, y=0.055, **_):
    """Draw the handle below, moving up and down, the plate on its coupler, the ball above."""
    s = Sketch(axes, -0.09, 0.09, -0.075, 0.125)
    u, plate = s.u, z + 0.04
    s.area([(-6 * u, x - 2 * u), (6 * u, x - 2 * u), (6 * u, x + 2 * u), (-6 * u, x + 2 * u)], "#c1440e", zorder=6)
    s.text((0, x), "handle", up=-6, color="#c1440e")
    s.spring((-2.5 * u, x + 2 * u), (-2.5 * u, plate - 2 * u), "$K$", up=0, right=-4, coils=5, height=1.2)
    s.damper((2.5 * u, x + 2 * u), (2.5 * u, plate - 2 * u), "$b_c$", up=0, right=4.5, height=1.2)
    s.block((0, plate), 26, 4, "$M$")
    s.disc((0, y + 0.04 + 6 * u), 4 * u)
    s.text((0, y + 0.04 + 6 * u), "$m$")
    for name, value, place, origin in (("$x$", x, -20, 0.0), ("$z$", z, 20, 0.04), ("$y$", y, 27, 0.04)):
        at, end = place * u, origin + value
        s.line((at - 1.5 * u, origin), (at + 1.5 * u, origin), width=1.0)
        if abs(value) > u:
            s.arrow((at, origin), (at, end))
        s.text((at, end), name, up=2.6 if value >= 0 else -2.6)
    s.arrow((-30 * u, 0.1), (-30 * u, 0.08), "$g$")


def stick_slip(stick_speed: Number | None = None) -> Scene:
    """Stick-slip: a block on a rough floor, pulled by the handle through the coupler's spring.

    m z'' = K (x - z) + b_c (x' - z') - F_f. It sticks until the pull reaches F_s, then slides against F_c < F_s, for half
    a period pi sqrt(m/K) when pulled slowly, and by 2 (F_s - F_c)/K; then it sticks again. One feels a sawtooth.

    Teaches Coulomb friction, why it is neither a function of speed nor a spring, chatter of brakes and violins; B.
    Armstrong-Helouvry et al., *Automatica* 30 (1994) 1083. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms, and
    ``method="taylor"``, which locates where it sticks and breaks away: that does not fit an Uno. A ``stick_speed`` does,
    at 500 Hz by semi-implicit Euler.

    Parameters
    ----------
    stick_speed : number [m/s], optional
        Friction F_c slip/stick_speed up to that speed instead of sticking: for any method. It creeps, and F_s has no part.

    Returns
    -------
    Scene
        With m [kg], F_s, F_c [N], and K, b_c of the coupler.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.stick_slip().values
    >>> print(f"slips by {2e3 * (p['F_s'] - p['F_c']) / p['K']:.0f} mm")
    slips by 10 mm
    """
    z = coordinate("z", unit="m", initial=x(n))
    m, F_s, F_c = parameters("m F_s F_c", units="kg N N", values=(0.1, 2.0, 1.0), ranges=[None, (0, 20), (0, 20)])
    F = coupler(z)
    if stick_speed is None:
        rough = friction(slip=z.diff(t), coulomb=F_c, breakaway=F_s)
    else:
        v_s = parameters("v_s", units="m/s", values=stick_speed, ranges=(1e-4, 1))
        rough = friction(slip=z.diff(t), coulomb=F_c, stick_speed=v_s)
    motion = lagrange(m * z.diff(t) ** 2 / 2, forces={z: F}, contacts=[rough])
    return Scene(force=F, eom=[motion], watch=[z], name="stick-slip")


def draw_stick_slip(axes, *, x=0.022, z=0.012, **_):
    """Draw the block on its rough floor beside the handle."""
    s, origin = Sketch(axes, -0.075, 0.135, -0.034, 0.03), 0.07 + clearance(x, z)
    u, place, floor = s.u, z + origin, -5 * s.u
    end = max(0.13, place + 14 * u)
    s.pair((x, 0), (place - 8 * u, 0))
    s.handle(x, below=11)
    s.block((place, 0), 16, 10, "$m$")
    rough = np.arange(0.03, end, 0.6 * u)
    s.line(*np.column_stack([rough, floor - 0.25 * u * (1 + (-1.0) ** np.arange(len(rough)))]), width=1.0, color=SOFT)
    s.ground((0.03, floor - 0.5 * u), (end, floor - 0.5 * u))
    s.arrow((place + 12 * u, floor + 1.5 * u), (place + 3 * u, floor + 1.5 * u))
    s.text((place + 12 * u, floor + 1.5 * u), "$F_f$", right=2.6, up=0.6)
    s.coordinate("$z$", z, -11 * u, origin=origin)
