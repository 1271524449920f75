"""Expressions of a scene as one value-numbered graph over their variables: differentiated, evaluated, copied.

A Lagrangian differentiated in symbols repeats its parts with every derivative. Here it is translated once, each of its
parts a numbered value, and differentiated in numbered values: the gradient by the reverse sweep, everything after that by
forward sweeps (Griewank and Walther, *Evaluating Derivatives*, ch. 3). Parts that are equal are one value, so what
derivatives share is computed once.
"""

import numpy as np
import sympy as sp

from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import Parameter, acceleration, t, v, x
from ...scene.shapes.closest_points import sampled
from ..ir.trace import computed, reachable
from .constants import entering
from .derivative_builder import Algebra
from .differentiate import Gradient, Tangent
from .expressions import Translator


class driven(sp.Function):
    """The angle 2 pi f t that time drives, less whole turns; a variable of a graph."""

    nargs = 1
    is_real = True
    role = "driven"


def shown(variable):
    """The name of a variable in a message; an angle that time drives is time."""
    return "time" if variable == t or isinstance(variable, driven) else str(variable)


class Graph:
    """The graph of a scene's expressions, in float64, its variables the inputs of one block.

    Variables are parameters, T, t, x(t), v(t), coordinates and their rates, samples and delays: whatever a translator
    asks for. Each is one input, so that a derivative by it is what it says.

    Parameters
    ----------
    fixed : dict name -> float
        Parameters that are constants.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.compiler.algebra.graph import Graph
    >>> from hapticlab.scene.notation.derivative import Partial
    >>> z = hl.coordinate("z", unit="m")
    >>> float(Graph().evaluate([Partial(z**3, z)], {z: 2.0})[0])
    12.0
    """

    def __init__(self, fixed=None):
        self.fixed = dict(fixed or {})
        self.builder = Algebra("f64")
        self.variables = {}  # expression -> number of its input
        self.translator = Translator(self.builder, self._leaf, clock=self, graph=self, sample=self._held)
        self._gradients, self._tangents, self._derivatives = {}, {}, {}

    def __call__(self, expr):
        """Return the value of an expression in the graph."""
        return self.translator(expr)

    def variable(self, expr):
        """Return the input that stands for a variable."""
        return self.builder.leaf("input", self.variables.setdefault(expr, len(self.variables)), "f64")

    def angle(self, translator, f):
        """Return the input that stands for the angle 2 pi f t."""
        return self.variable(driven(f))

    def derivative(self, expr):
        """Return the value of a :class:`Partial` or a :class:`Rate`."""
        if expr not in self._derivatives:  # every stage of a method asks again
            self._derivatives[expr] = self._derivative(expr)
        return self._derivatives[expr]

    def _derivative(self, expr):
        inner = self(expr.args[0])
        if isinstance(expr, Rate):
            return self._tangent("rate", self._rate_of)(inner)
        by = expr.variable
        at, turning = self.variable(by).id, by == t or isinstance(by, Parameter)

        def seed(number):
            angle = self._input(number)
            if turning and isinstance(angle, driven):
                return self(sp.diff(2 * sp.pi * angle.args[0] * t, by))
            return 1.0 if number == at else 0.0

        if isinstance(expr.args[0], (Partial, Rate)):
            return self._tangent(at, seed)(inner)
        if inner.id not in self._gradients:
            self._gradients[inner.id] = Gradient(inner)
        gradient = self._gradients[inner.id]
        angles = [k for k in gradient.leaves if turning and isinstance(self._input(k), driven)]
        return sum((gradient(k) * seed(k) for k in angles), gradient(at))

    def _input(self, number):
        """Return the variable that instruction ``number`` is."""
        return list(self.variables)[self.builder.instructions[number].index]

    def _held(self, expr):
        # what a sample holds does not vary with the motion: a variable of its own
        return self.variable(sampled(expr))

    def _tangent(self, key, seed):
        return self._tangents.setdefault(key, Tangent(self.builder, seed))

    def _rate_of(self, number):
        """The rate along the motion of the input that is instruction ``number``."""
        expr = self._input(number)
        if isinstance(expr, driven):
            return self(2 * sp.pi * expr.args[0])
        if expr == t:
            return 1.0
        if isinstance(expr, (x, v)) and expr.args == (t,):
            return self.variable({x: v, v: acceleration}[type(expr)](t))
        return self(expr.diff(t)) if getattr(type(expr), "role", None) == "coordinate" else 0.0

    def _leaf(self, expr):
        if isinstance(expr, Parameter) and expr.name in self.fixed:
            return self.builder.const(self.fixed[expr.name])
        return self.variable(expr)

    def evaluate(self, exprs, at):
        """Return the numbers of expressions, one array each, of the shape that the variables' arrays have together.

        Parameters
        ----------
        exprs : sequence of expressions
        at : dict variable -> float or array
            A variable that is missing is an error.
        """
        wanted = [self(expr).id for expr in exprs]
        variables = list(self.variables)
        done = computed(self.builder.instructions, wanted, lambda i: self._number(variables[i.index], at))
        return [np.asarray(done[k], float) for k in wanted]

    def _number(self, variable, at):
        return self.evaluate(variable.args, at)[0] if isinstance(variable, sampled) else at[variable]

    def variables_of(self, exprs):
        """Return the variables that expressions depend on."""
        reached = reachable(self.builder.instructions, [self(expr).id for expr in exprs])
        numbers = {i.index for i in (self.builder.instructions[k] for k in reached) if i.op == "input"}
        found = [expr for expr, number in self.variables.items() if number in numbers]
        held = [expr.args[0] for expr in found if isinstance(expr, sampled)]
        more = self.variables_of(held) if held else []
        return list(dict.fromkeys([*(expr for expr in found if not isinstance(expr, sampled)), *more]))

    def copy(self, value, translator, known):
        """Return a value of the graph in a translator's builder, its variables what they are to the translator.

        ``known`` (dict) remembers what has been copied for this translator.
        """
        builder, variables = translator.builder, list(self.variables)
        for k in reachable(self.builder.instructions, [value.id], known):
            i = self.builder.instructions[k]
            if i.op == "const":
                real = i.type == "f64"
                known[k] = builder.const(entering(i.value, builder.real, f"{i.value:g}")) if real else builder.const(i.value)
            elif i.op == "input":
                expr = variables[i.index]
                angle = isinstance(expr, driven)
                known[k] = translator.clock.angle(translator, expr.args[0]) if angle else translator(expr)
            else:
                known[k] = builder.emit(i.op, *(known[a] for a in i.args))
        return known[value.id]
