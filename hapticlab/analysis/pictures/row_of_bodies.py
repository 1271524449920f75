"""The row of bodies behind a handle, read off a scene: their order, what keeps them apart, what holds the handle, what stands."""

import sympy as sp

from ...errors import HapticlabError
from ...scene.contact.contact import Contact, friction
from ...scene.notation.symbols import n, t, v, x
from .elements import apart
from .plain_formulas import formula, plain_symbols

#: coordinates up to which couplings are looked for; more stand in a row, each coupled to the one before
LOOKED_AT = 4


def start_of(scene):
    """Return where the handle, the coordinates and the signals are at the first sample; 0 where that is not known."""
    states = (*scene.coordinates, *scene.signals)
    start = {"x": 0.0} | {type(q).__name__: 0.0 for q in states}
    for q in states:
        try:
            value, _ = formula(type(q).initial)
            start[type(q).__name__] = float(value({**start, **scene.values})[0])
        except (KeyError, TypeError, ValueError, ZeroDivisionError, NotImplementedError):
            continue
    return start


def chain(scene, lengths):
    """Return the coordinates in the order in which they follow the handle."""
    order, waiting = [], list(lengths)
    while waiting:
        last = order[-1] if order else x(t)
        order.append(next((q for q in waiting if _coupled(scene, last, q)), waiting[0]))
        waiting.remove(order[-1])
    return order


def meetings(scene, names):
    """Return name -> (neighbour to its left, gap [m] where both are at zero), of those that a contact keeps apart."""
    contacts, found, row = (getattr(entry, "contacts", ()) for entry in scene.eom), {}, ["x", *names]
    gaps = [plain_symbols(c.gap) for listed in contacts for c in listed if isinstance(c, Contact)]
    for before, name in zip(row, names, strict=False):
        here, there = sp.Symbol(before, real=True), sp.Symbol(name, real=True)
        for gap in gaps:
            if (gap.diff(there), gap.diff(here)) == (1, -1):
                rest = gap.xreplace({here: sp.S.Zero, there: sp.S.Zero}).subs(dict(scene.values))
                found[name] = (before, float(rest) if rest.is_number else 0.0)
    return found


def _coupled(scene, first, second):
    """Tell whether two movers pull on each other when apart, not in a contact or a case alone."""
    if len(scene.coordinates) > LOOKED_AT:
        return True
    if first == x(t):
        return apart(scene.force).has(second) or any(expr.has(x, v) for expr in _acting(scene, second))
    return any(expr.has(first) for expr in _acting(scene, second)) or any(expr.has(second) for expr in _acting(scene, first))


def _acting(scene, q):
    """The force on a coordinate, without terms that act in cases alone."""
    try:
        form = scene.explicit()
    except HapticlabError:
        return ()
    if q not in form.coordinates:
        return ()
    return (apart(form.f[form.coordinates.index(q)]),)


def held_by(scene):
    """The coefficients of the elements between the handle and the ground, of "spring" and "damper".

    A force that a shift of everything changes is a spring; one that a speed of the handle changes is a damper.
    """
    force, past, speed = apart(scene.force), sp.Symbol("past"), sp.Symbol("speed")
    lengths = [q for q in scene.coordinates if type(q).unit == "m"]
    samples = {sample: sp.Symbol("x") - (n - sample.args[0]) * past for sample in force.atoms(x) if sample.args[0] != t}
    force = force.xreplace({**samples, x(t): sp.Symbol("x"), **dict.fromkeys(force.atoms(v), speed)})
    shifted = force.xreplace(dict.fromkeys([*lengths, sp.Symbol("x")], sp.Symbol("shift")))
    ties, found = [("spring", sp.Symbol("shift"), shifted), ("damper", past, force), ("damper", speed, force)], {}
    for tie, by, acts in ties:
        slope = sp.expand(acts.diff(by))
        if not slope.is_zero and not (tie == "damper" and lengths):
            period = next((s for s in slope.free_symbols if s.name == "T"), sp.S.One) if by == past else sp.S.One
            found[tie] = sp.simplify(slope * period)
    return found


def stands(scene, q):
    """Tell whether an angle of zero is up: it falls away from there at the scene's own values."""
    acting = _acting(scene, q) if len(scene.coordinates) <= LOOKED_AT else ()
    try:
        moment, names = formula(*acting)
        return moment({**dict.fromkeys(names, 0.0), **scene.values, type(q).__name__: 0.01})[0] > 0
    except (TypeError, NotImplementedError, KeyError, ZeroDivisionError, IndexError):
        return False


def rubbed(scene):
    """Return the coordinates whose rate is rubbed by a floor at rest."""
    listed = [contact for entry in scene.eom for contact in getattr(entry, "contacts", ()) if isinstance(contact, friction)]
    slips = [one.slip.doit() if hasattr(one.slip, "doit") else one.slip for one in listed]
    return {type(q).__name__ for q in scene.coordinates if q.diff(t) in slips}
