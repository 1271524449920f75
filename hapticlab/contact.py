"""Contact between bodies: a gap that may close, a law for the force or the impulse, and friction.

A contact goes with the energies of the bodies. A ball of 50 g falls on the handle and bounces:

>>> import hapticlab as hl
>>> h, (m, g) = hl.coordinate("h", unit="m", initial="40 mm"), hl.parameters("m g", units="kg m/s^2", values=(0.05, 9.81))
>>> touch = hl.contact.Contact(h - hl.x(hl.t), hl.contact.impulse(e=0.8), name="touch")
>>> motion = hl.mechanics.lagrange(m * h.diff(hl.t) ** 2 / 2 - m * g * h, contacts=[touch])
>>> pulse = hl.contact.felt_impulse(touch, tau="5 ms")
>>> ball = hl.Scene(force=pulse.force, eom=[motion, *pulse.equations], watch=[h])
>>> log = hl.SimulatedPaddle(m=0.05, b=2.0, T=1e-3, hand=hl.Hand("grip")).run(ball, duration=0.3, method="taylor")
>>> bool((log.h > log.x - 1e-4).all()), bool(log.F.max() > 1)
(True, True)

Next: ``hl.shapes`` for the gap between two bodies, ``hl.library.ball_on_the_paddle``.
"""

from .compiler.contacts.broad_phase import contacts_between as between
from .scene.contact.contact import Contact, friction
from .scene.contact.felt_impulses import felt_impulse, pulse_time
from .scene.contact.instant_laws import impulse, micro_impulse, rigid
from .scene.contact.penalty_laws import hunt_crossley, penalty
from .vocabulary import page

__all__ = [
    "Contact",
    "between",
    "felt_impulse",
    "friction",
    "hunt_crossley",
    "impulse",
    "micro_impulse",
    "penalty",
    "pulse_time",
    "rigid",
]

page(__name__)
