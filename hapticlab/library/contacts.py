"""Contacts behind the handle: a ball to juggle, a block that sticks and slips."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..scene.contact.contact import Contact, friction
from ..scene.contact.instant_laws import impulse
from ..scene.mechanics.lagrange import lagrange
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene
from .bodies import coupler

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
