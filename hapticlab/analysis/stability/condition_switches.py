"""The cases of a scene as switches: each comparison of what moves becomes a parameter, on or off, with a place where it is so.

A mode is one setting of all switches. In a mode a tick is smooth, whatever stage of a method asks, so that it can be
linearised; the places say where a handle, positions and rates have to be for it.
"""

from dataclasses import dataclass, field, replace

import sympy as sp

from ...compiler.ir.channels import short
from ...scene.explicit import ExplicitForm
from ...scene.notation.cases import Piecewise
from ...scene.notation.parameters import Parameter
from ...scene.notation.symbols import delay, t
from ...scene.scene import Scene

#: how far beyond its surface a mode is looked at, in the unit of what is compared
BEYOND_SURFACE = 1e-3
#: modes of one scene looked at
MOST_MODES = 64


@dataclass(frozen=True)
class Switched(Scene):
    """A scene with its comparisons as parameters.

    Attributes
    ----------
    form : ExplicitForm
    switches : dict Parameter -> condition
    """

    form: ExplicitForm | None = None
    switches: dict = field(default_factory=dict)

    def explicit(self):
        """Return the equations with switches in place of comparisons."""
        return self.form

    @property
    def parameters(self):
        """The parameters in use and the switches, name -> Parameter."""
        return {**super().parameters, **{s.name: s for s in self.switches}}

    @property
    def instants(self):
        """The names of contacts that strike in an instant and of frictions that stick: they are looked at free of both."""
        return [c.name for model in self.form.models for c in model.contacts if not c.is_force]

    def set(self, mode):
        """Return the scene with its switches as a mode has them."""
        return replace(self, values={**self.values, **self.values_of(mode)})

    def values_of(self, mode):
        """Return name -> 1 or 0 of the switches in a mode."""
        return {s.name: float(on) for s, on in zip(self.switches, mode, strict=True)}

    def named(self, mode):
        """Return a mode in words: the conditions that hold in it, and what moves freely."""
        conditions = [c.doit() for c in self.switches.values()]
        holding = [short(c, 60) for c, on in zip(conditions, mode, strict=True) if on]
        words = " and ".join(holding) or "none of " + ", ".join(short(c, 40) for c in conditions) if conditions else "everywhere"
        return f"{words}, {' and '.join(self.instants)} free" if self.instants else words


def switched(scene):
    """Return the :class:`Switched` of a scene, its watched channels left out."""
    form = replace(scene.explicit(), watch={})
    exprs = [form.force, *form.f, *(m for row in form.M for m in row), *form.updates.values()]
    found = {}

    def switch(condition):
        if condition not in found:
            found[condition] = Parameter(f"case_{len(found) + 1}", "1", 0.0, 1.0)
        return found[condition] > 0.5

    known = {}
    put = [_put(e, switch, known) for e in exprs]
    N = len(form.f)
    force, f, M, updates = put[0], put[1 : N + 1], put[N + 1 : N + 1 + N * N], put[N + 1 + N * N :]
    form = replace(
        form, force=force, f=tuple(f), M=tuple(tuple(M[k * N : k * N + N]) for k in range(N)),
        updates=dict(zip(form.updates, updates, strict=True)),
    )  # fmt: skip
    switches = {parameter: condition for condition, parameter in found.items()}
    plain = {f.name: getattr(scene, f.name) for f in Scene.__dataclass_fields__.values()}
    return Switched(**{**plain, "watch": {}}, form=form, switches=switches)


def _put(expr, switch, known):
    """Return an expression with every comparison of what moves replaced."""
    if expr in known or not expr.args:
        return known.get(expr, expr)
    args = [_put(a, switch, known) for a in expr.args]
    if isinstance(expr, (sp.StrictLessThan, sp.LessThan, sp.StrictGreaterThan, sp.GreaterThan)) and moves(expr):
        made = switch(expr)
    elif isinstance(expr, (sp.Max, sp.Min)) and moves(expr):
        made = args[0]
        for a, written in zip(args[1:], expr.args[1:], strict=True):
            first = expr.func(*expr.args[: expr.args.index(written)])
            larger = switch(sp.Gt(written, first, evaluate=False))
            made = Piecewise((a, larger), (made, True)) if isinstance(expr, sp.Max) else Piecewise((made, larger), (a, True))
    elif isinstance(expr, (sp.Abs, sp.sign)) and moves(expr):
        above = switch(sp.Gt(expr.args[0], 0, evaluate=False))
        up, down = (args[0], -args[0]) if isinstance(expr, sp.Abs) else (sp.S.One, -sp.S.One)
        made = Piecewise((up, above), (down, True))
    else:
        made = expr if tuple(args) == expr.args else _rebuilt(expr, args)
    known[expr] = made
    return made


def _rebuilt(expr, args):
    return expr.func(*args, evaluate=False) if isinstance(expr, sp.core.relational.Relational) else expr.func(*args)


def moves(expr):
    """Tell whether what an expression compares changes while it runs."""
    return any(hasattr(type(leaf), "role") or isinstance(leaf, delay) or leaf == t for leaf in expr.atoms(sp.Function, sp.Symbol))
