"""What the symbols of a model of ``sympy.physics.mechanics`` are in a scene: coordinates, parameters and inputs."""

import re
from keyword import iskeyword

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.simplify.fu import TR8

from ...errors import SceneError
from ..notation.amount import amount
from ..notation.derivative import Rate
from ..notation.parameters import Parameter, parameters
from ..notation.symbols import coordinate, n, t, v, x
from ..notation.written import RESERVED, expression

#: operations of a constraint past which expanding it may take seconds
MOST_GATHERED = 200


class Vocabulary:
    """Symbol of SymPy -> expression of hapticlab; applied to an expression, it translates it.

    Parameters
    ----------
    moving : sequence of dynamicsymbols
        What becomes coordinates, in order.
    expressions : sequence of expressions
        Everything that will be translated.
    speeds : dict dynamicsymbol -> dynamicsymbol
        Speeds that are the rate of a coordinate, u = q'.
    units, values, initial, replace : dict
        See :func:`~hapticlab.scene.mechanics.sympy_models.from_mechanics`.

    Attributes
    ----------
    table : dict symbol -> expression
    notes : tuple of str
        Which names had to change.
    declared : bool
        Every symbol was given a unit.
    """

    def __init__(self, moving, expressions, speeds, units=None, values=None, initial=None, replace=None):
        self.moving, self.speeds = tuple(moving), dict(speeds)
        constants, functions = _symbols(expressions)
        self.symbols = [*self.moving, *self.speeds, *constants]
        self.symbols += [f for f in functions if f not in self.symbols]
        self.table, self.inputs, self.notes, self.taken = {}, {}, (), set(RESERVED)
        replace = self._keyed(replace, "replace")
        units, values = self._keyed(units, "units"), self._keyed(values, "values")
        self._check_given(replace, units, values, constants, functions)
        replace |= {q: q for q in self.moving if _is_coordinate(q)}
        for given in (*replace.values(), *map(sp.sympify, expressions)):
            self.taken |= {s.name for s in given.atoms(Parameter)}
            self.taken |= {type(f).__name__ for f in given.atoms(AppliedUndef) if _is_coordinate(f)}
        self.declared = all(s in units for s in self.symbols if s not in replace and s not in self.speeds)
        for c in constants:
            self.table[c] = replace[c] if c in replace else self._parameter(c, units.get(c, "1"), values.get(c))
        initial = self._keyed(initial, "initial", rates=True)
        wrong = next((s for s in initial if s in constants), None)
        if wrong is not None:
            raise SceneError(f"initial has {wrong}, which does not move. Give its value in values={{{wrong}: ...}}")
        self._coordinates(replace, units, initial)
        for symbol, given in replace.items():
            if symbol not in self.table:
                self.inputs[symbol] = self(given)
        for u, q in self.speeds.items():
            if q in self.inputs:
                self.inputs[u] = Rate(self.inputs[q])
            else:
                self.table[u] = self.table[q].diff(t)

    def __call__(self, expr):
        """An expression in the symbols of a scene."""
        expr = sp.sympify(expr)
        put = {**self.table, **self.inputs}
        for d in expr.atoms(sp.Derivative):
            if d.expr in self.inputs:
                put[d] = self._rate(d)
        return expr.xreplace(put)

    @property
    def names(self):
        """Pairs (symbol, what it became)."""
        return tuple({**self.table, **self.inputs}.items())

    def _rate(self, d):
        """The rate of an input; refuse one that would hold an acceleration."""
        given, order = self.inputs[d.expr], d.derivative_count
        most = {"coordinate": 1, x: 2, v: 1}
        for part in given.atoms(sp.Function, sp.Derivative):
            allowed = most.get(getattr(type(part), "role", None), most.get(type(part), 9))
            if order > allowed or (isinstance(part, sp.Derivative) and order > 0):
                raise SceneError(
                    f"the equations contain {d}, and {d.expr} = {given} was given. That needs an acceleration of {part}, "
                    f"for which the equations are solved. Let {d.expr} be a function of t or x(t), or write the rate as an input"
                )
        for _ in range(order):
            given = Rate(given)
        return given

    def _keyed(self, given, what, rates=False):
        """A dict symbol -> value from one whose keys are symbols or their names."""
        names = [_name(s) for s in self.symbols]
        known = dict(zip(names, self.symbols, strict=True)) | {s: s for s in self.symbols}
        if rates:
            known |= {q.diff(t): q.diff(t) for q in self.moving}
        found = {}
        for key, value in dict(given or {}).items():
            if key not in known:
                there = ", ".join(map(_name, self.symbols))
                raise SceneError(f"{what} has {key}, which is not in these equations. They contain {there}")
            if names.count(key) > 1:
                raise SceneError(f"{what} has {key!r}, the name of two symbols of the model. Give the symbol itself")
            found[known[key]] = expression(value, f"replace[{key}]") if what == "replace" else value
        return found

    def _check_given(self, replace, units, values, constants, functions):
        missing = [f for f in functions if f not in (*self.moving, *self.speeds, *replace)]
        if missing:
            shown = ", ".join(map(str, missing))
            raise SceneError(
                f"{shown}: neither a coordinate nor a speed, so an input of the model (a force, or a driven motion). Define "
                f"it, replace={{{missing[0]}: ...}}, with an expression of x(t), v(t), t, coordinates and "
                "parameters, or 0"
            )
        wrong = next((s for s in (*units, *values) if s in replace), None)
        if wrong is not None:
            raise SceneError(
                f"{wrong} is replaced by {replace[wrong]}, which has a unit and a value of its own. Leave out {wrong}"
            )
        wrong = next((s for s in constants if replace.get(s, sp.S.Zero).has(t, sp.Function)), None)
        if wrong is not None:
            raise SceneError(
                f"{wrong} is a constant where the equations were formed, and {replace[wrong]} changes; replace it by numbers "
                "and parameters, or make it one of dynamicsymbols in the model"
            )
        wrong = next((s for s in values if s not in constants), None)
        if wrong is not None:
            raise SceneError(f"values has {wrong}, which moves. Give its start in initial={{{wrong}: ...}}")
        wrong = next((s for s in replace if s in self.speeds), None)
        if wrong is not None:
            raise SceneError(f"replace has {wrong}, the rate of {self.speeds[wrong]}. Replace {self.speeds[wrong]} instead")

    def _parameter(self, symbol, unit, value):
        return parameters(self._word(symbol), units=unit, values=value)

    def _coordinates(self, replace, units, initial):
        rate_of = {q: u for u, q in self.speeds.items()}
        for q in self.moving:
            starts = [s for s in (q, q.diff(t), rate_of.get(q)) if s is not None and s in initial]
            if q in replace:
                if starts:
                    raise SceneError(f"{q} is replaced by {replace[q]}; declare its start there")
                if _is_coordinate(replace[q]):
                    self.table[q] = replace[q]
                continue
            if len(starts) > 1 and starts[-1] != q.diff(t) and q.diff(t) in starts:
                raise SceneError(f"initial has both {q.diff(t)} and {rate_of[q]}, which are one; keep one")
            unit, rates = units.get(q, "1"), [s for s in starts if s != q]
            start = amount(self._plain(initial.get(q, 0)), unit, f"initial of {q}")
            rate_unit = f"({unit})/s" if unit != "1" else "1/s"
            rate = amount(self._plain(initial[rates[0]]), rate_unit, f"initial of {rates[0]}") if rates else 0
            self.table[q] = coordinate(self._word(q), unit=unit, initial=start, rate=rate)

    def _plain(self, given):
        """An initial value whose constants, if any, are parameters."""
        return given.xreplace(self.table) if isinstance(given, sp.Basic) else given

    def _word(self, symbol):
        """A name that is still free; a note says so where it differs from the symbol's own."""
        own = _name(symbol)
        plain = own if own.isidentifier() else re.sub(r"[\W_]+", "_", own).strip("_") or "q"
        plain = f"q{plain}" if plain[0].isdigit() else plain
        made, k = plain, 1
        while made in self.taken or iskeyword(made):
            made, k = f"{plain}_{k}", k + 1
        self.taken.add(made)
        if made != own:
            self.notes += (f"{symbol} of the model is called {made} here",)
        return made


def gathered(constraint):
    """A constraint with cos a cos b - sin a sin b as cos(a + b), the form in which loops are solved in closed form.

    Joints write each frame in the one before, so that a loop of SymPy holds products of cosines instead.
    """
    constraint = sp.sympify(constraint)
    if sp.count_ops(constraint) > MOST_GATHERED:
        return constraint
    sums = sp.expand(TR8(sp.expand(constraint)))
    return sums if sp.count_ops(sums) < sp.count_ops(constraint) else constraint


def _is_coordinate(expr):
    return getattr(type(expr), "role", None) == "coordinate"


def _name(symbol):
    return symbol.name if isinstance(symbol, sp.Symbol) else type(symbol).__name__


def _symbols(expressions):
    """(Constants, functions of time) that expressions hold, each in the order of names."""
    constants, functions = set(), set()
    for expr in map(sp.sympify, expressions):
        constants |= {s for s in expr.free_symbols if isinstance(s, sp.Symbol) and not isinstance(s, Parameter)} - {t, n}
        functions |= {f for f in expr.atoms(AppliedUndef) if not hasattr(type(f), "role")}
    clock = next((s for s in constants if s.name == "t"), None)
    if clock is not None:
        raise SceneError(f"{clock} is not the time of SymPy's dynamicsymbols. Write sympy.Symbol('t')")
    strange = next((f for f in functions if f.args != (t,)), None)
    if strange is not None:
        raise SceneError(f"{strange} is not a function of time alone; write it as an expression of coordinates and constants")
    return sorted(constants, key=_order), sorted(functions, key=_order)


def _order(symbol):
    return _name(symbol), len(symbol.assumptions0), str(sorted(symbol.assumptions0.items()))
