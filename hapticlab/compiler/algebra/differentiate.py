"""Derivatives of traced values by the chain rule: reverse for the gradient of one value, forward for many.

Griewank and Walther, *Evaluating Derivatives*, ch. 3. New instructions go into the same builder, so that a derivative
shares the parts of what it is the derivative of. Comparisons have no derivative: a select is differentiated arm by arm.
"""

from ..ir.operations import OPERATIONS
from ..ir.program import LEAVES
from ..ir.trace import Value


class Tangent:
    """Forward mode: ``tangent(value)`` is the derivative of a value along a direction.

    Parameters
    ----------
    builder : Builder
    seed : callable number of a leaf -> Value or float
        How fast each leaf changes.
    """

    def __init__(self, builder, seed):
        self.builder, self.seed = builder, seed
        self.known = {}

    def __call__(self, value):
        stack = [value.id]
        while stack:
            k = stack[-1]
            waiting = [a for a in self._moving(k) if a not in self.known] if k not in self.known else []
            if waiting:
                stack.extend(waiting)
            else:
                stack.pop()
                if k not in self.known:
                    self.known[k] = self._of(k)
        return self._value(self.known[value.id])

    def _moving(self, k):
        i = self.builder.instructions[k]
        return [a for a in i.args if OPERATIONS[i.op].result == "R" and self.builder.instructions[a].type != "bool"]

    def _value(self, number):
        return number if isinstance(number, Value) else self.builder.const(number)

    def _of(self, k):
        i = self.builder.instructions[k]
        if i.op in LEAVES:
            return self.seed(k) if i.op != "const" else 0.0
        total = 0.0
        for a, part in partials(self.builder, k):
            rate = self.known[a]
            if isinstance(rate, Value) or rate:
                total = total + part(self._value(rate))
        if isinstance(total, Value) and total.constant == 0:
            return 0.0
        return total


class Gradient:
    """Reverse mode: ``gradient(k)`` is the derivative of one value by leaf number k.

    Parameters
    ----------
    value : Value

    Attributes
    ----------
    leaves : list of int
        Numbers of the inputs that the value depends on.
    """

    def __init__(self, value):
        builder = value.builder
        self.adjoint = {value.id: builder.const(1.0)}
        order, stack = set(), [value.id]
        while stack:
            k = stack.pop()
            if k not in order:
                order.add(k)
                stack.extend(builder.instructions[k].args)
        for k in sorted(order, reverse=True):
            mine = self.adjoint.get(k)
            if mine is None or mine.constant == 0 or builder.instructions[k].op in LEAVES:
                continue
            for a, part in partials(builder, k):
                grown = part(mine)
                self.adjoint[a] = self.adjoint[a] + grown if a in self.adjoint else grown
        self.zero = builder.const(0.0)
        self.leaves = [k for k in sorted(order) if builder.instructions[k].op == "input"]

    def __call__(self, k):
        return self.adjoint.get(k, self.zero)


def partials(builder, k):
    """(operand, function) for each operand of instruction k; the function multiplies by the partial derivative."""
    i = builder.instructions[k]
    r, operands = builder.result(k), [builder.result(a) for a in i.args]
    if i.op == "mul" and i.args[0] == i.args[1]:
        return [(i.args[0], lambda d: _twice(d) * operands[0])]
    rules = zip(i.args, OPERATIONS[i.op].derivative, strict=False)  # a step function has none
    return [(a, lambda d, rule=rule: rule(d, r, *operands)) for a, rule in rules if rule]


def _twice(d):
    """Return 2 d, with a factor 2 or 1/2 that is there already taken together: exact."""
    i = d.builder.instructions[d.id]
    if i.op == "mul":
        for a, b in (i.args, i.args[::-1]):
            if d.builder.instructions[a].op == "const":
                return d.builder.const(2.0 * d.builder.instructions[a].value) * d.builder.result(b)
    return 2.0 * d
