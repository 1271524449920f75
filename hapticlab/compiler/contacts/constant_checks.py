"""What the constants of contacts and frictions may be: at the values bound, and at all that live parameters may be set to.

A negative friction or damping, or a restitution above 1, feeds energy to the user. Interval arithmetic over the declared
ranges shows that a live parameter cannot make one so. A parameter without a declared range may be set down to 0 alone,
where that is enough to show it.
"""

import math
from dataclasses import replace

import sympy as sp

from ...errors import SceneError
from ...scene.contact.contact import Contact
from ...scene.notation.symbols import Parameter, T
from ...scene.notation.units import unit_of
from ..algebra.first_sample import numbers
from ..algebra.graph import Graph
from ..algebra.ranges import Ranges

#: of a range, the rounding of interval arithmetic
_ROUNDING = 1e-12


def limits(form, values, folded, period):
    """(low, high) of the live parameters that may not be set to all they were declared to be, by name.

    Parameters
    ----------
    form : ExplicitForm
    values : dict name -> float
    folded : dict name -> float
        Parameters that cannot change.
    period : float
        T [s].

    Raises
    ------
    SceneError
        A constant of a contact or friction is out of its range, or could be set out of it.
    """
    elements = [c for model in form.models for c in model.contacts]
    # a normal force pushes, however large: what is written with it is looked at for 1 N
    pushing = {c.force: Parameter(f"{c.name}.force", c.unit, 0.0, value=1.0) for c in elements if isinstance(c, Contact)}
    found = {}
    for element in elements:
        law = getattr(element, "contact_law", element)
        for part, expr in vars(law).items():
            if part not in law.allowed or not isinstance(expr, sp.Expr):
                continue
            constant = _Constant(element.name, part, law.allowed[part], expr, expr.xreplace(pushing))
            constant.check({**values, T.name: period})
            for name, (low, high) in constant.narrowed(values, folded, period, {*pushing.values(), T}).items():
                ends = found.get(name, (-math.inf, math.inf))
                found[name] = max(low, ends[0]), min(high, ends[1])
    return found


def bounded(program, limits):
    """A program whose live parameters keep to limits, name -> (low, high)."""
    parameters = []
    for channel in program.parameters:
        low, high = limits.get(channel.name, (-math.inf, math.inf))
        parameters.append(replace(channel, low=max(low, channel.low), high=min(high, channel.high)))
    return replace(program, parameters=tuple(parameters))


class _Constant:
    """One constant of one contact or friction; ``meant`` is the expression as it is looked at."""

    def __init__(self, where, part, allowed, written, meant):
        self.where, self.part, self.written, self.meant = where, part, written, meant
        self.low, self.high, self.why, self.above = allowed.low, allowed.high, allowed.why, allowed.above
        self.variables = Graph().variables_of([meant])

    def check(self, values):
        """Refuse a value at the first sample that is out of the range."""
        (value,) = numbers([self.meant], values) or (math.nan,)
        if value < self.low or value > self.high or (self.above and value == self.low):
            shown = "" if self.written == value else f" = {self.written}"
            unit = f" {getattr(self.written, 'unit', None) or unit_of(self.written)}".removesuffix(" 1")
            raise SceneError(f"{self.where}: {self.part}{shown} is {value:g}{unit} at the start; {self.why}: {self._needs()}")

    def narrowed(self, values, folded, period, given):
        """name -> (low, high) of live parameters, which keep the constant in its range; refuse where none do."""
        live = [p for p in self.variables if isinstance(p, Parameter) and p.name not in folded and p not in given]
        open_ = [p for p in live if self._may_narrow(p, values)]
        if not all(isinstance(p, Parameter) for p in self.variables):
            return {p.name: (0.0, math.inf) for p in open_ if p in sp.Mul.make_args(self.meant)}
        ranges = [self._narrow(p) for p in open_]
        kept = dict(zip(open_, ranges, strict=True))
        if live and not self._inside(kept, folded, period):
            self._refuse(live, Ranges(folded, period)(self.meant))
        for p in open_:
            fewer = {other: ends for other, ends in kept.items() if other != p}
            if self._inside(fewer, folded, period):
                kept = fewer
        return {p.name: (narrow.low, narrow.high) for p, narrow in kept.items()}

    def _may_narrow(self, p, values):
        value = values.get(p.name, math.nan)
        return (math.isinf(p.low) and not value < 0) or (p == self.meant and math.isinf(p.high))

    def _narrow(self, p):
        low = 0.0 if math.isinf(p.low) else p.low
        return Parameter(p.name, p.unit, low, min(p.high, self.high) if p == self.meant and math.isinf(p.high) else p.high)

    def _inside(self, narrow, folded, period):
        low, high = Ranges(folded, period)(self.meant.xreplace(narrow))
        return low >= self.low - _ROUNDING and high <= self.high + _ROUNDING

    def _refuse(self, live, ends):
        names = ", ".join(p.name for p in live)
        first = live[0]
        shown = f"{self.part} = {self.written}" if self.written != first else self.part
        raise SceneError(
            f"{self.where}: {shown} can reach any value in {ends[0]:.4g}..{ends[1]:.4g} while {names} is live, and "
            f"{self.why}: {self._needs()} everywhere. Declare ranges that ensure this, such as hl.parameters('{first.name}', "
            f"units='{first.unit}', ranges=(0, {1 if self.part == 'e' else 5})), or leave {names} out of live="
        )

    def _needs(self):
        if self.high < math.inf:
            return f"needs {self.low:g} <= {self.part} <= {self.high:g}"
        return f"needs {self.part} {'>' if self.above else '>='} {self.low:g}"
