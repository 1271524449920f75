"""Ranges of expressions and truth of conditions, from the declared ranges of parameters and coordinates.

Interval arithmetic (Moore, *Interval Analysis*, 1966): every operation encloses what its operands can give. Operands that
depend on each other make the enclosure wider, never narrower, so a condition is left alone where nothing is proved.
"""

import math

import sympy as sp

from ...scene.notation.amount import Amount
from ...scene.notation.symbols import Parameter, T, delay, n, t
from ...scene.notation.units import fixed

EVERYTHING = (-math.inf, math.inf)


class Ranges:
    """The ranges of expressions, from those declared of parameters and coordinates.

    Parameters
    ----------
    constants : dict name -> float
        Parameters whose value cannot change while it runs.
    T : float, optional
        Sampling period [s].

    Examples
    --------
    >>> import hapticlab as hl
    >>> k = hl.parameters("k", units="N/m", ranges=(100, 200))
    >>> low, high = Ranges()(2 * k + 1)
    >>> round(low, 9), round(high, 9)
    (201.0, 401.0)
    """

    def __init__(self, constants=None, T=None):
        self.constants, self.T = dict(constants or {}), T
        self._known = {}

    def __call__(self, expr):
        """Return (low, high) of an expression, each possibly infinite."""
        expr = sp.sympify(expr)
        if expr not in self._known:
            low, high = self._of(expr)
            self._known[expr] = (float(low), float(high)) if low <= high else EVERYTHING  # a nan is no bound
        return self._known[expr]

    def decided(self, condition):
        """Return True, False, or None where the ranges leave a condition open."""
        if condition in (sp.true, sp.false):
            return bool(condition)
        if isinstance(condition, sp.Not):
            inner = self.decided(condition.args[0])
            return None if inner is None else not inner
        if isinstance(condition, (sp.And, sp.Or)):
            parts, absorbing = [self.decided(a) for a in condition.args], isinstance(condition, sp.Or)
            if absorbing in parts:
                return absorbing
            return None if None in parts else not absorbing
        if isinstance(condition, sp.core.relational.Relational):
            return self._compared(condition)
        return None

    def _compared(self, relation):
        (a, b), (c, d) = self(relation.lhs), self(relation.rhs)
        always = {">=": a >= d, ">": a > d, "<=": b <= c, "<": b < c, "==": a == b == c == d, "!=": b < c or d < a}
        never = {">=": b < c, ">": b <= c, "<=": a > d, "<": a >= d, "==": b < c or d < a, "!=": a == b == c == d}
        return True if always[relation.rel_op] else False if never[relation.rel_op] else None

    def _of(self, expr):
        if isinstance(expr, Parameter):
            if expr == T and self.T is not None:
                return self.T, self.T
            value = self.constants.get(expr.name)
            return (expr.low, expr.high) if value is None else (value, value)
        if expr.is_number:
            return (float(expr),) * 2 if expr.is_finite and expr.is_real else EVERYTHING
        if isinstance(expr, Amount):
            return (float(expr.value),) * 2
        if expr in (n, t):
            return 0.0, math.inf
        if getattr(type(expr), "role", None) == "coordinate":
            return getattr(type(expr), "low", -math.inf), getattr(type(expr), "high", math.inf)
        rule = next((rule for kinds, rule in _RULES if isinstance(expr, kinds)), None)
        return rule(self, expr) if rule else EVERYTHING

    def _sum(self, expr):
        parts = [self(a) for a in expr.args]
        return _outward(sum(low for low, _ in parts), sum(high for _, high in parts))

    def _product(self, expr):
        low, high = self(expr.args[0])
        for factor in expr.args[1:]:
            low, high = _times((low, high), self(factor))
        return low, high

    def _power(self, expr):
        base, exponent = expr.as_base_exp()
        low, high = self(base)
        exponent = fixed(exponent)
        if not exponent.is_Rational:
            if low <= 0:
                return (0.0, math.inf) if low == 0 else EVERYTHING
            return tuple(map(_exp, _times(self(exponent), (_log(low), _log(high)))))
        power = int(exponent) if exponent.q == 1 else float(exponent)
        if exponent.q > 1 and low < 0:
            return EVERYTHING
        if low <= 0 <= high and exponent < 0:
            return (0.0, math.inf) if low == 0 or exponent.p % 2 == 0 else EVERYTHING
        ends = sorted((_raised(low, power), _raised(high, power)))
        if exponent.p % 2 == 0 and low <= 0 <= high:
            ends[0] = 0.0
        low, high = _outward(*ends)
        return (max(0.0, low), high) if ends[0] >= 0 else (low, high)

    def _circular(self, expr):
        low, high = self(expr.args[0])
        shift = 0.0 if isinstance(expr, sp.cos) else math.pi / 2  # sin a = cos(a - pi/2)
        low, high = low - shift, high - shift
        if not high - low < 2 * math.pi:
            return -1.0, 1.0
        ends = math.cos(low), math.cos(high)
        turn, half = math.ceil(low / (2 * math.pi)), math.ceil((low - math.pi) / (2 * math.pi))
        top = 1.0 if turn * 2 * math.pi <= high else max(ends)
        bottom = -1.0 if math.pi + half * 2 * math.pi <= high else min(ends)
        return max(-1.0, bottom - 1e-15), min(1.0, top + 1e-15)

    def _rising(self, expr):
        function = _RISING[type(expr)]
        return _outward(*(function(a) for a in self(expr.args[0])))

    def _absolute(self, expr):
        low, high = self(expr.args[0])
        return (0.0 if low <= 0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))

    def _extreme(self, expr):
        pick, parts = (max if isinstance(expr, sp.Max) else min), [self(a) for a in expr.args]
        return pick(low for low, _ in parts), pick(high for _, high in parts)

    def _cases(self, expr):
        parts = []
        for value, condition in expr.args:
            decided = self.decided(condition)
            if decided is not False:
                parts.append(self(value))
            if decided:
                break
        return (min(low for low, _ in parts), max(high for _, high in parts)) if parts else EVERYTHING

    def _within_one(self, expr):
        return (0.0 if isinstance(expr, sp.Heaviside) else -1.0), 1.0

    def _delayed(self, expr):
        return self(expr.args[0])


def _exp(a):
    return math.exp(a) if a < 709 else math.inf


def _log(a):
    return math.log(a) if 0 < a < math.inf else (math.inf if a > 0 else -math.inf)


_RISING = {sp.exp: _exp, sp.log: _log, sp.tanh: math.tanh, sp.atan: math.atan}
_RULES = (
    (sp.Add, Ranges._sum),
    (sp.Mul, Ranges._product),
    (tuple(_RISING), Ranges._rising),
    (sp.Pow, Ranges._power),
    ((sp.sin, sp.cos), Ranges._circular),
    (sp.Abs, Ranges._absolute),
    ((sp.Min, sp.Max), Ranges._extreme),
    (sp.Piecewise, Ranges._cases),
    ((sp.sign, sp.Heaviside), Ranges._within_one),
    (delay, Ranges._delayed),
)


def _outward(low, high):
    """Widen by one rounding, so that a rounded sum or product is inside."""
    return math.nextafter(low, -math.inf), math.nextafter(high, math.inf)


def _times(a, b):
    ends = [0.0 if 0 in (p, q) else p * q for p in a for q in b]
    return (min(ends), max(ends)) if all(map(float.is_integer, map(float, ends))) else _outward(min(ends), max(ends))


def _raised(a, power):
    try:
        return a**power
    except (OverflowError, ZeroDivisionError):
        return math.inf
