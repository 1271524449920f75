"""Contact between bodies: where it is (a gap), and its law (penalty, impulse, rigid), with friction beside it."""

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
