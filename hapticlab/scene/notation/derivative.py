"""Derivatives that are written down but not worked out: the compiler takes them on the shared graph.

A derivative of an energy, worked out in symbols, repeats its parts over and over: SymPy's LagrangesMethod needs 8 to
22 s for a pendulum of eight links (tests/benchmarks/modelling.py). :class:`Partial` and :class:`Rate` name the
derivative instead. They stand wherever an expression may stand; ``.doit()`` works them out in symbols, for a reader.
"""

import sympy as sp
from sympy.core.function import AppliedUndef

from .symbols import acceleration, t, v, x


class _Unworked(sp.Expr):
    """A derivative that is not worked out."""

    is_commutative = True
    is_real = True
    is_number = False

    def doit(self, **hints):
        """The derivative in symbols."""
        return self._worked_out(self.args[0].doit(**hints))

    def _latex(self, printer):
        return printer._print(self.doit())

    def _eval_derivative(self, symbol):
        return self.doit().diff(symbol)


class Partial(_Unworked):
    """The partial derivative of an expression, the other variables held.

    Parameters
    ----------
    expr : expression
    variable : a coordinate q(t), its rate q.diff(t), x(t), v(t), t or a parameter

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.scene.notation.derivative import Partial
    >>> m = hl.parameters("m", units="kg")
    >>> z = hl.coordinate("z", unit="m")
    >>> p = Partial(m * z.diff(hl.t) ** 2 / 2, z.diff(hl.t))
    >>> p.doit()
    m*Derivative(z(t), t)
    """

    def __new__(cls, expr, variable):
        expr = sp.sympify(expr)
        return sp.S.Zero if expr.is_number else super().__new__(cls, expr, variable)

    @property
    def variable(self):
        """What is varied; the unit is divided by its unit."""
        return self.args[1]

    per = variable

    def _worked_out(self, expr):
        held = {self.variable: sp.Dummy(real=True)}
        for d in sorted(expr.atoms(sp.Derivative), key=lambda d: -d.derivative_count):
            held.setdefault(d, sp.Dummy(real=True))
        for f in expr.atoms(AppliedUndef, x, v):
            held.setdefault(f, sp.Dummy(real=True))
        back = {dummy: variable for variable, dummy in held.items()}
        return expr.xreplace(held).diff(held[self.variable]).xreplace(back)

    def _sympystr(self, printer):
        return f"Partial({printer._print(self.args[0])}, {printer._print(self.variable)})"


class Rate(_Unworked):
    """The rate of an expression along the motion, less what accelerations add to it: q -> q', x -> v, t -> 1, q' -> 0.

    The handle's acceleration v' is kept, as a leaf of its own that a program estimates from samples.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.scene.notation.derivative import Rate
    >>> z = hl.coordinate("z", unit="m")
    >>> Rate(z * z.diff(hl.t)).doit()
    Derivative(z(t), t)**2
    """

    per = t  # the unit is divided by the second

    def __new__(cls, expr):
        expr = sp.sympify(expr)
        return sp.S.Zero if expr.is_number else super().__new__(cls, expr)

    def _worked_out(self, expr):
        total = sp.S.Zero
        for variable, rate in rates_of(expr).items():
            total += Partial(expr, variable).doit() * rate
        return total

    def _sympystr(self, printer):
        return f"Rate({printer._print(self.args[0])})"


def rates_of(expr):
    """Variable -> rate of everything in an expression that moves; a rate q' is there only where its acceleration is not."""
    moving = {}
    for f in sorted(expr.atoms(sp.Function), key=str):
        role = getattr(type(f), "role", None)
        if role == "coordinate":
            moving[f] = f.diff(t)
        elif role == "handle" and f.args == (t,):
            moving[f] = {x: v(t), v: acceleration(t)}[type(f)]
    if t in expr.free_symbols:
        moving[t] = sp.S.One
    return moving
