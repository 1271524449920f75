"""The modes that declared ranges exclude: a condition that always or never holds over them is not compared at run time."""

import math
from dataclasses import dataclass, replace

import sympy as sp

from ...errors import ParameterError
from ...scene.notation.cases import Piecewise
from ..algebra.ranges import Ranges
from ..ir.trace import select
from .constraint_lengths import check_live, held


@dataclass(frozen=True)
class Decision:
    """A condition or a choice that the declared ranges decide.

    Attributes
    ----------
    what : sympy expression
        The relation, ``Max``, ``Min`` or ``Abs`` as written.
    becomes : sympy expression
        True, False, or what is left of it.
    why : str
        The ranges it follows from.
    """

    what: sp.Basic
    becomes: sp.Basic
    why: str


def decide(expr, ranges, found=None, keep=()):
    """An expression without the modes that the ranges exclude.

    Parameters
    ----------
    expr : sympy expression
    ranges : Ranges
    found : dict, optional
        Takes what was decided: written expression -> :class:`Decision`.
    keep : collection of sympy expressions
        Of these, nothing is decided.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.compiler.algebra.ranges import Ranges
    >>> k, d = hl.parameters("k d", units="N/m m", ranges=((0, 200), (0.01, 0.02)))
    >>> decide(hl.when(d > 0.03, k * d, k), Ranges())
    k
    """
    found = {} if found is None else found
    changed = {}
    for node in _choices([expr]):
        if node not in keep:
            decided = _without_excluded(node, ranges, found, keep)
            if decided != node:
                changed[node] = decided
    return _put(expr, changed)


def _choices(exprs):
    """The choices in expressions that ranges may decide; a part that many share, such as a Lagrangian, is looked at once."""
    seen, stack, found = set(), list(exprs), []
    while stack:
        e = stack.pop()
        if e not in seen:
            seen.add(e)
            stack += e.args
            if isinstance(e, (sp.Piecewise, sp.Max, sp.Min, sp.Abs)):
                found.append(e)
    return found


def _put(expr, changed):
    before = None
    while changed and expr != before:  # what is left of a choice may hold another
        before, expr = expr, expr.xreplace(changed)
    return expr


def _without_excluded(node, ranges, found, keep):
    if isinstance(node, sp.Piecewise):
        return _cases_left(node, ranges, found, keep)
    if isinstance(node, sp.Abs):
        low, high = ranges(node.args[0])
        if low < 0 < high:
            return node
        left = node.args[0] if low >= 0 else -node.args[0]
        return _noted(node, left, [node.args[0]], ranges, found)
    bounds = {a: ranges(a) for a in node.args}
    top = isinstance(node, sp.Max)
    best = max(low for low, _ in bounds.values()) if top else min(high for _, high in bounds.values())
    left = [a for a, (low, high) in bounds.items() if (high >= best if top else low <= best)]
    if len(left) == len(node.args):
        return node
    return _noted(node, type(node)(*left), node.args, ranges, found)


def _cases_left(node, ranges, found, keep):
    left = []
    for value, condition in node.args:
        holds = None if condition in keep else ranges.decided(condition)
        if holds is not None and condition != sp.true:
            _noted(condition, sp.true if holds else sp.false, _sides(condition), ranges, found)
        if holds is not False:
            left.append((value, sp.true if holds else condition))
        if holds:
            break
    if left == [tuple(case.args) for case in node.args]:
        return node
    return left[0][0] if left[0][1] == sp.true else Piecewise(*left)


def _sides(condition):
    return [side for r in condition.atoms(sp.core.relational.Relational) for side in r.args]


def _noted(what, becomes, sides, ranges, found):
    shown = (f"{s} in [{ranges(s)[0]:g}, {ranges(s)[1]:g}]" for s in sides if not s.is_number)
    found[what] = Decision(what, becomes, ", ".join(shown))
    return becomes


def without_excluded(form, fixed, T, keep=()):
    """(form, decisions): an explicit form without the modes that the ranges exclude, and what was decided.

    Parameters
    ----------
    form : ExplicitForm
    fixed : dict name -> float
        The parameters that are constants; the others go anywhere in their ranges.
    T : float
        Sampling period [s].
    keep : collection of sympy expressions
        Conditions of which nothing is decided.

    Returns
    -------
    form : ExplicitForm
    decisions : dict written expression -> Decision
    """
    found, changed = {}, {}
    exprs = [form.force, *form.f, *(m for row in form.M for m in row), *form.updates.values(), *form.watch.values()]
    choices = _choices(exprs)
    ranges = Ranges(fixed, T) if choices else None
    for node in choices:
        decided = node if node in keep else _without_excluded(node, ranges, found, keep)
        if decided != node:
            changed[node] = decided
    if not changed:
        return form, {}
    made = replace(
        form,
        M=tuple(tuple(_put(m, changed) for m in row) for row in form.M),
        f=tuple(_put(f, changed) for f in form.f),
        updates={y: _put(expr, changed) for y, expr in form.updates.items()},
        force=_put(form.force, changed),
        watch={name: _put(expr, changed) for name, expr in form.watch.items()},
    )
    return made, found


def open_conditions(form, rows):
    """The conditions that stay open in the force, the channels and these equations of motion, as written."""
    exprs = [form.force, *form.watch.values(), *form.updates.values(), *(form.f[k] for k in rows)]
    cases = [node for node in _choices(exprs) if isinstance(node, sp.Piecewise)]
    conditions = {condition for node in cases for _, condition in node.args if condition not in (sp.true, sp.false)}
    return sorted(conditions, key=str)


def excluded(scene, T, live, undecided=()):
    """(form, decisions) of :func:`without_excluded` for a scene whose ``live`` parameters alone may change."""
    return without_excluded(scene.explicit(), folded(scene, live), T, undecided)


def rests_on(form, decisions):
    """coordinate -> (low, high): the ranges without which what was decided, and pairs left out, may be wrong."""
    found = {}
    for decision in decisions.values():
        moving = (e for e in decision.what.atoms(sp.Function) if getattr(type(e), "role", None) == "coordinate")
        found |= {q: (type(q).low, type(q).high) for q in moving}
    for model in form.models:
        found |= getattr(model.contacts, "ranges", {})
    return {q: ends for q, ends in sorted(found.items(), key=str) if any(map(math.isfinite, ends))}


def within(value, ranges, translate):
    """A value that is no number where a coordinate is outside of these ranges: a fault, and the motor off."""
    inside = None
    for q, (low, high) in ranges.items():
        place = translate(q)
        parts = [low <= place] * math.isfinite(low) + [place <= high] * math.isfinite(high)
        for part in parts:
            inside = part if inside is None else inside & part
    return value if inside is None else select(inside, value, math.nan)


def folded(scene, live):
    """name -> value of the parameters that become constants: where ``live`` is None, what constraints hold."""
    if live is None:
        return {name: scene.values[name] for name in held(scene) if name in scene.values} if scene.models else {}
    strangers = set(live) - set(scene.parameters)
    if strangers:
        raise ParameterError(f"live: {', '.join(sorted(strangers))} is not a parameter; {', '.join(scene.parameters)} are")
    check_live(scene, live)
    fixed = set(scene.parameters) - set(live)
    unbound = sorted(fixed - set(scene.values))
    if unbound:
        raise ParameterError(f"{', '.join(unbound)} is not live, so it needs a value: scene({unbound[0]}=...)")
    return {name: scene.values[name] for name in fixed}
