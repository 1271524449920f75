"""Whether the steps of a method are short enough for a contact: ten from touch to leave, and a bounce that ends."""

from dataclasses import replace

import numpy as np
import sympy as sp

from ...errors import SceneError
from ...scene.contact.contact import Contact
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.parameters import Parameter
from ..algebra.first_sample import numbers
from ..events.taylor_method import Taylor
from ..ir.notes import ParameterNote
from ..ir.options import proposed
from .impulses import check_rest_speed

#: over the phase of entry, a symplectic step is wrong by at most 0.4 % of the energy at 10 steps, 18 % at 3, 115 % at 2
STEPS_PER_CONTACT = 10


def check_contacts(form, values, h, T, method):
    """Refuse contacts that the step is too long for, looked at in the initial configuration.

    Force laws under a method that does not locate events need ten steps a contact; a rest speed must end the bounces
    within two a period. Nothing is asked where a parameter has no value yet, or where constraints change the masses.

    Returns
    -------
    dict contact -> float
        Of each that needs ten steps, the largest stiffness that leaves them, at the masses looked at.

    Parameters
    ----------
    form : ExplicitForm
    values : dict name -> float
    h, T : float
        Step and sample period [s].
    method : Method or Taylor

    Raises
    ------
    SceneError
    """
    contacts = [c for model in form.models for c in model.contacts if isinstance(c, Contact)]
    if not contacts or any(model.constraints for model in form.models):
        return {}
    M = numbers([m for row in form.M for m in row], values)
    if M is None:
        return {}
    M, largest = np.reshape(M, (len(form.f), -1)), {}
    for c in contacts:
        J = numbers([Partial(c.gap, q) for q in form.coordinates], values)
        if J is None or not any(J):
            continue
        column = np.linalg.solve(M, J)
        if c.is_force and not isinstance(method, Taylor):
            k = numbers([c.contact_law.k], values)
            if k is not None:
                check_contact_steps(c, k[0], float(column @ J), h, T, method=method.name)
                largest[c] = max(k[0], _largest(c.contact_law, float(column @ J), h))
        elif c.is_located and c.contact_law.rest_speed not in (None, sp.oo):
            _check_rest(c, form, column, values, T)
    return largest


def _largest(law, W, h, speed=1.0):
    """The stiffness with which a contact lasts just ten steps: its duration goes as k^(-1/(n + 1)), n = 1 of a spring."""
    return (law.duration(1.0, 1 / W, speed) / (STEPS_PER_CONTACT * h)) ** (float(getattr(law, "exponent", 1)) + 1)


def limited(program, largest):
    """A program whose live parameters stop where a contact would get too short, with a note on each.

    Parameters
    ----------
    program : Program
    largest : dict contact -> float
        Of :func:`check_contacts`. A stiffness that is an expression is noted and not held: its parameters stay free.
    """
    live, notes = {c.name: c for c in program.parameters}, []
    for c, most in sorted(largest.items(), key=lambda item: item[1]):
        names = sorted(p.name for p in c.contact_law.k.atoms(Parameter) if p.name in live)
        lasts = f"for which {c.name} lasts {STEPS_PER_CONTACT} steps; substeps or method='taylor' allow more"
        if names and isinstance(c.contact_law.k, Parameter) and most < live[names[0]].high:
            live[names[0]] = replace(live[names[0]], high=most)
            notes.append(ParameterNote(names[0], f"at most {most:.4g} {live[names[0]].unit}, {lasts}"))
        elif names and not isinstance(c.contact_law.k, Parameter):
            notes.append(f"{', '.join(names)}: {c.contact_law.k} at most {most:.4g}, {lasts}")
    return replace(program, parameters=tuple(live.values()), notes=(*program.notes, *notes))


def _check_rest(contact, form, column, values, T):
    free = {leaf: sp.S.Zero for f in form.f for leaf in f.atoms(sp.Function) if hasattr(type(leaf), "contact")}
    found = numbers([contact.contact_law.rest_speed, Rate(Rate(contact.gap)), *(f.xreplace(free) for f in form.f)], values)
    if found is not None:
        speed, bias, *f = found
        check_rest_speed(speed, max(0.0, -(bias + float(np.dot(column, f)))), T, contact.name)


def check_contact_steps(contact, k, W, h, T, speed=1.0, method="rk4"):
    """Refuse a contact too short for an explicit method, naming the substeps that it needs.

    Parameters
    ----------
    contact : Contact
        With a force law.
    k : float
        Its stiffness.
    W : float
        J M^-1 J^T of its gap; 1/W is the effective mass.
    h, T : float
        Step and sample period [s].
    speed : float
        Approach [m/s] for which it is asked, where the law depends on it (Hunt and Crossley).
    method : str
        For the message.

    Raises
    ------
    SceneError
    """
    if k <= 0 or W <= 0:
        return
    lasts = contact.contact_law.duration(k, 1 / W, speed)
    if lasts >= STEPS_PER_CONTACT * h:
        return
    more = proposed(STEPS_PER_CONTACT * T / lasts, "a shorter T")
    at = f" at {speed:g} m/s" if contact.contact_law.speed_matters else ""
    raise SceneError(
        f"{contact.name}: the contact{at} lasts {1e3 * lasts:.3g} ms (k = {k:g}, effective mass {1 / W:.3g}), which is "
        f"{lasts / h:.1f} steps of {1e3 * h:g} ms; {method} needs {STEPS_PER_CONTACT}. Use {more}, method='taylor' (which "
        "locates touch and leave), or a softer contact"
    )
