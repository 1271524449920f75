"""How contacts and frictions start: no bodies in each other, and friction that takes at least as much to break away."""

import numpy as np
import sympy as sp

from ...errors import SceneError
from ...scene.contact.contact import Contact, friction
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import x
from ..algebra.first_sample import numbers
from .broad_phase import TOUCHING

#: how deep [m] or [rad] a law that is a force over a time may start pressed in, and how many times what presses it
PRESSED, TIMES = 1e-3, 10


def check_starts(form, values):
    """Refuse contacts and frictions that cannot start so; one whose parameters have no value yet is left open.

    A law of an instant starts apart or in touch. A force law may start pressed in by 1 mm, and deeper where its force
    is at most ten times what presses the bodies together, as a body does that lies on a soft floor; deeper still, it
    would throw them apart. A wall for the handle alone may start anywhere, for so may the handle.

    Parameters
    ----------
    form : ExplicitForm
    values : dict name -> number

    Raises
    ------
    SceneError
    """
    for model in form.models:
        for c in model.contacts:
            if isinstance(c, friction):
                _check_friction(c, values)
            elif isinstance(c, Contact):
                _check_apart(c, form, values)


def _check_apart(contact, form, values):
    depth = -(numbers([contact.gap], values) or [0.0])[0]
    if depth <= TOUCHING or (contact.is_force and (depth <= PRESSED or _is_carried(contact, form, values))):
        return
    unit = "m" if contact.unit == "N" else "rad"
    where = ", with the handle at 0" if contact.gap.has(x) else ""
    raise SceneError(
        f"{contact.name}: gap = {contact.gap} is {-depth:.4g} {unit} at the start{where}: the bodies overlap. A gap is > 0 "
        "where the bodies are apart: change its sign, or start elsewhere (initial=)"
    )


def _is_carried(contact, form, values):
    """Whether a force is at most some times the one that presses its bodies together; True where that is not known."""
    if any(model.constraints for model in form.models):
        return True  # forces of constraints may press, which are found later
    free = {leaf: sp.S.Zero for f in form.f for leaf in f.atoms(sp.Function) if hasattr(type(leaf), "contact")}
    J = numbers([Partial(contact.gap, q) for q in form.coordinates], values)
    f = numbers([*(f.xreplace(free) for f in form.f), Rate(Rate(contact.gap)), contact.force], values)
    M = numbers([m for row in form.M for m in row], values)
    if J is None or f is None or M is None or not any(J):
        return True
    *f, bias, N = f
    column = np.linalg.solve(np.reshape(M, (len(J), -1)), J)
    pushed = N * float(column @ J)
    return pushed <= TIMES * max(0.0, pushed - bias - float(column @ f))


def _check_friction(rub, values):
    leaves = {leaf: sp.S.One for c in rub.constants for leaf in c.atoms(sp.Function) if hasattr(type(leaf), "contact")}
    found = numbers([part.xreplace(leaves) for part in (rub.coulomb, rub.breakaway)], values)
    if found is None:
        return
    sliding, breaking = found
    if sliding < 0:
        start = f"{sliding:.4g} {rub.unit} at the start"
        raise SceneError(f"{rub.name}: coulomb = {rub.coulomb} is {start}; friction opposes the slip: needs coulomb >= 0")
    if breaking < sliding:
        raise SceneError(
            f"{rub.name}: breakaway = {rub.breakaway} is below coulomb = {rub.coulomb} at the start, {breaking:.4g} < "
            f"{sliding:.4g}; a breakaway force is at least as large as the sliding force"
        )
