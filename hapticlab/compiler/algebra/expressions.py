"""Translate a SymPy expression into traced values, term by term, each shared subexpression once."""

import operator

import sympy as sp

from ...errors import ProgramError, ProgramLimitError
from ...scene.notation.amount import Amount
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import delay
from ...scene.notation.units import fixed
from ...scene.shapes.closest_points import ClosestPoints, sampled
from ..ir import trace
from ..ir.trace import Value, maximum, minimum, select
from . import gjk
from .constants import check_product, entering
from .phase import angle_of

#: past this a program fits no board and a listing no eye; far above every scene of a course
MOST_INSTRUCTIONS = 50_000


class Translator:
    """Turns expressions into values of one builder.

    Parameters
    ----------
    builder : Builder
    leaf : callable expression -> Value
        What symbols, samples, coordinates, derivatives and delays stand for.
    clock : Clock, optional
        What t is, for angles that time drives.
    bound : dict name -> float, optional
        The values of live parameters, with which their products must stay numbers of the real type.
    graph : Graph, optional
        Where derivatives are taken.
    sample : Translator, optional
        What translates expressions at the sample; this one unless given.
    """

    def __init__(self, builder, leaf, clock=None, bound=None, graph=None, sample=None):
        self.builder, self.leaf, self.clock, self.bound = builder, leaf, clock, bound or {}
        self.graph, self.copied, self.sample = graph, {}, sample or self
        self.known, self.settled = {}, {}
        self.started = []  # what is being translated, outermost first, and how many instructions there were before it

    def __call__(self, expr):
        """Return the value of an expression."""
        expr = sp.sympify(expr)
        if expr not in self.known:
            self.started.append((expr, len(self.builder.instructions)))
            if len(self.builder.instructions) > MOST_INSTRUCTIONS:
                raise ProgramLimitError(self._grown())
            self.known[expr] = self._translate(expr)
            self.started.pop()
            check_product(expr, self.known[expr], self.known, self.bound, self.settled)
        return self.known[expr]

    def _grown(self):
        """Return a message that names the smallest part that took most of the instructions."""
        now = len(self.builder.instructions)
        grown = [(expr, now - before) for expr, before in self.started if now - before > MOST_INSTRUCTIONS / 2]
        reason = "they come from many parts, none of which is the largest. Use fewer coordinates, contacts or substeps; "
        reason += (
            "constraints need the fewest with enforce='embed', and a method of few stages, such as 'rk4', needs fewer "
            "than 'taylor'"
        )
        if grown:
            expr, size = grown[-1]
            reason = f"{size} of them are for {str(expr)[:60]}...; write it with fewer terms, or do not expand it in symbols"
        return f"more than {MOST_INSTRUCTIONS} instructions: {reason}"

    def _translate(self, expr):
        if expr in (sp.true, sp.false):
            return self.builder.const(bool(expr))
        if expr.is_number:
            return self._number(expr)
        if isinstance(expr, (sp.Symbol, sp.Derivative, delay)) or hasattr(type(expr), "role"):
            return self.leaf(expr)
        for kinds, rule in _RULES:
            if isinstance(expr, kinds):
                return rule(self, expr)
        if isinstance(expr, tuple(_FUNCTIONS)):
            return _FUNCTIONS[next(kind for kind in _FUNCTIONS if isinstance(expr, kind))](*map(self, expr.args))
        names = ", ".join(sorted(kind.__name__ for kind in _FUNCTIONS))
        what = f"unknown function {type(expr).__name__} in {expr}" if expr.is_Function else f"{expr} has no meaning here"
        raise ProgramError(f"{what}; the functions that run at the sample rate are {names}, when, delay and powers")

    def _number(self, expr):
        try:
            return self.builder.const(entering(expr, self.builder.real, str(sp.N(expr, 3)).lower()))
        except TypeError:
            raise ProgramError(f"{expr} is not a real number; only real numbers run at the sample rate") from None

    def _of_angle(self, expr):
        return _FUNCTIONS[type(expr)](angle_of(self, expr.args[0]))

    def _derivative(self, expr):
        value = self.graph.derivative(expr)
        return value if value.builder is self.builder else self.graph.copy(value, self, self.copied)

    def _sum(self, expr):
        total = None
        for term in expr.args:
            minus = term.could_extract_minus_sign()
            value = self(-term if minus else term)
            if total is None:
                total = -value if minus else value
            else:
                total = total - value if minus else total + value
        return total

    def _product(self, expr):
        above, below = [], []
        for factor in expr.args:
            base, exponent = factor.as_base_exp() if isinstance(factor, sp.Pow) else (factor, sp.S.One)
            exponent = fixed(exponent) if exponent.is_Float else exponent
            if exponent.is_Rational and exponent < 0:
                below.append(base**-exponent)
            else:
                above.append(factor)
        top = self._times(above) if above else self.builder.const(1.0)
        return _divided(top, self._times(below)) if below else top

    def _times(self, factors):
        result = self(factors[0])
        for factor in factors[1:]:
            result = result * self(factor)
        return result

    def _power(self, expr):
        base, exponent = expr.as_base_exp()
        exponent = fixed(exponent)
        if exponent.is_Rational and exponent < 0:
            return _divided(self.builder.const(1.0), self(base**-exponent))
        if exponent.is_Rational and exponent.q in (1, 2):
            whole = _repeated(self(base), int(exponent.p) // int(exponent.q))
            if exponent.q == 1:
                return whole
            root = trace.sqrt(self(base))
            return root if whole is None else whole * root
        if base == sp.E:
            return trace.exp(self(exponent))
        # any other exponent needs a positive base
        return trace.exp(self(exponent) * trace.log(self(base)))

    def _cases(self, expr):
        *cases, (last, condition) = expr.args
        if condition != sp.true:
            raise ProgramError(f"{expr} has no case for when {condition} fails; add (value, True), or use hl.when")
        result = self(last)
        for value, condition in reversed(cases):
            result = select(self(condition), self(value), result)
        return result

    def _relation(self, expr):
        in_graph = self.graph is None or self.graph.builder is self.builder  # which is differentiated, and does not run
        near = None if in_graph else gjk.near(self, expr)  # first, so that an engine knows it before it searches
        holds = self._compared(expr)
        return holds if near is None else near & holds

    def _compared(self, expr):
        a, b = self(expr.lhs), self(expr.rhs)
        if "bool" in (a.type, b.type):
            raise ProgramError(f"{expr} compares conditions; combine them with &, | and ~ instead")
        compared = {">": b < a, ">=": b <= a, "<": a < b, "<=": a <= b}
        if expr.rel_op in compared:
            return compared[expr.rel_op]
        return trace.equal(a, b) if expr.rel_op == "==" else ~trace.equal(a, b)

    def _logic(self, expr):
        values = [self(a) for a in expr.args]
        number = next((a for a, value in zip(expr.args, values, strict=True) if value.type != "bool"), None)
        if number is not None:
            raise ProgramError(f"{number} is a number where {expr} needs a condition; compare it, as in {number} > 0")
        return _LOGIC[type(expr)](*values)


def _divided(a, b):
    """Return a / b; a constant divisor becomes a factor, which is within one rounding and a third of the time."""
    factor = b.constant and 2.0**-100 < abs(b.constant) < 2.0**100  # past these the reciprocal leaves float32
    return a * (1.0 / b) if factor else a / b


def _repeated(value, power):
    """Return value**power by squaring, None for power 0."""
    result = None
    while power:
        if power & 1:
            result = value if result is None else result * value
        value, power = (value * value, power >> 1) if power > 1 else (value, 0)
    return result


def _sign(a):
    return select(0.0 < a, 1.0, select(a < 0.0, -1.0, 0.0 * a))


def _heaviside(a, at_zero):
    return select(0.0 < a, 1.0, select(a < 0.0, 0.0, at_zero))


def _fold(rule):
    def apply(first, *others):
        for other in others:
            first = rule(first, other)
        return first

    return apply


def _sinh(a):
    # sinh a = tanh a * cosh a keeps full relative accuracy near zero
    return trace.tanh(a) * _cosh(a)


def _cosh(a):
    e = trace.exp(abs(a))
    return 0.5 * e + 0.5 / e


def _asin(a):
    # the factored root keeps its accuracy as |a| approaches 1
    return trace.atan(a / trace.sqrt((1.0 - a) * (1.0 + a)))


def _acos(a):
    return 2.0 * trace.atan(trace.sqrt((1.0 - a) / (1.0 + a)))


def _atan2(y, x):
    pi = float(sp.pi)
    angle = trace.atan(y / x)
    left = select(y < 0.0, angle - pi, angle + pi)
    upright = select(y < 0.0, -pi / 2, select(0.0 < y, pi / 2, 0.0 * y))
    level = select(trace.equal(x, 0.0), upright, select(x < 0.0, left, angle))
    # y/x has a pole where x passes zero, and with it the Taylor series of the angle, which has none
    steep = select(y < 0.0, -pi / 2, pi / 2) - trace.atan(x / y)
    return select(x * x < y * y, steep, level)


_RULES = (
    ((Partial, Rate), Translator._derivative),
    (sp.Add, Translator._sum),
    ((sp.sin, sp.cos, sp.tan), Translator._of_angle),
    (sp.Mul, Translator._product),
    ((sp.Pow, sp.exp), Translator._power),
    (sp.Piecewise, Translator._cases),
    (sp.core.relational.Relational, Translator._relation),
    ((sp.And, sp.Or, sp.Not, sp.Xor, sp.ITE), Translator._logic),
    (Amount, lambda translator, expr: translator(expr.value)),
    (sampled, lambda translator, expr: translator.sample(expr.args[0])),
    (ClosestPoints, gjk.trace),
)
_LOGIC = {
    sp.And: _fold(operator.and_), sp.Or: _fold(operator.or_), sp.Not: operator.invert,
    sp.Xor: _fold(lambda a, b: (a | b) & ~(a & b)), sp.ITE: lambda c, a, b: (c & a) | (~c & b),
}  # fmt: skip
_FUNCTIONS = {
    sp.sin: trace.sin, sp.cos: trace.cos, sp.tan: lambda a: trace.sin(a) / trace.cos(a),
    sp.log: trace.log, sp.atan: trace.atan, sp.tanh: trace.tanh, sp.sinh: _sinh, sp.cosh: _cosh,
    sp.asin: _asin, sp.acos: _acos, sp.atan2: _atan2,
    sp.Abs: Value.__abs__, sp.sign: _sign, sp.Heaviside: _heaviside, sp.floor: trace.floor,
    sp.ceiling: lambda a: -trace.floor(-a), sp.Mod: lambda a, b: a - b * trace.floor(a / b),
    sp.Min: _fold(minimum), sp.Max: _fold(maximum),
}  # fmt: skip
