"""The motion over a step as a Taylor series, by the recurrences of automatic differentiation on the traced accelerations.

Griewank and Walther, *Evaluating Derivatives*, ch. 13; Jorba and Zou, Experimental Mathematics 14 (2005) 99. Where the
motion is linear the series is the matrix exponential to rounding; where it ends (free flight) the rest costs nothing,
since a structural zero is never computed. Coefficients are of theta = tau/h, so that none leaves float32.
"""

from ..ir import trace
from ..ir.structural_zeros import ZERO, dot, is_zero, minus, plus, times
from ..ir.trace import select

#: operation -> its value from the values of its operands
AT_ONCE = {
    "neg": lambda a: -a, "abs": abs, "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b, "lt": lambda a, b: a < b, "le": lambda a, b: a <= b, "eq": trace.equal,
    "and": lambda a, b: a & b, "or": lambda a, b: a | b, "not": lambda a: ~a,
    "select": select, "sqrt": trace.sqrt, "floor": trace.floor, "sin": trace.sin, "cos": trace.cos, "exp": trace.exp,
    "log": trace.log, "atan": trace.atan, "tanh": trace.tanh,
}  # fmt: skip


def product(a, b, k):
    """Return coefficient k of a product of two series; of a square at half the work."""
    if a is not b:
        return dot(a[: k + 1], b[k::-1])
    half = (k + 1) // 2
    twice = times(2.0, dot(a[:half], a[k : k - half : -1] if half else []))
    return twice if k % 2 else plus(twice, times(a[k // 2], a[k // 2]))


def slope(a, k):
    """Return the coefficients k a_k, ..., 1 a_1 of the derivative, highest first."""
    return [times(float(j), a[j]) for j in range(k, 0, -1)]


class Series:
    """Taylor coefficients of the results of a straight-line list, grown order by order.

    Parameters
    ----------
    instructions : list of Instruction
        Without loops by construction; bools in it are constant over the step.
    rows : dict position -> list of coefficients
        The leaves that move. Whoever owns them appends to their lists before asking for the next order.
    number : callable position -> value, optional
        What the results are that no moving leaf reaches: traced values, floats or arrays. Constants, unless given.

    Examples
    --------
    >>> from hapticlab.compiler.ir.trace import Builder, sin
    >>> b = Builder()
    >>> angle = b.leaf("input", 0, "f64")
    >>> y = sin(angle)
    >>> [float(c) for c in Series(b.instructions, {angle.id: [0.0, 1.0, 0.0, 0.0]}).of(y, 3)]
    [0.0, 1.0, 0.0, -0.16666666666666666]
    """

    def __init__(self, instructions, rows, number=None):
        self.instructions, self.number = instructions, number or (lambda p: instructions[p].value)
        self.known = rows
        self.leaves = self.moving = frozenset(rows)
        self._orders = {}

    def of(self, value, k):
        """Return coefficients 0 to k of a traced value."""
        self.upto([value.id], k)
        return self.known[value.id][: k + 1]

    def upto(self, positions, k):
        """Make coefficients 0 to k of the results at some positions known."""
        for p in self._order(tuple(positions)):
            row = self.known.setdefault(p, [])
            while len(row) <= k:
                row.append(self._coefficient(p, len(row), row))

    def lengths(self):
        """Return how far everything is known, for :meth:`cut`."""
        return {p: len(row) for p, row in self.known.items()}

    def cut(self, lengths):
        """Forget what became known since."""
        for p in list(self.known):
            if p in lengths:
                del self.known[p][lengths[p] :]
            else:
                del self.known[p]

    def _order(self, positions):
        """Return the positions asked for and what they need, operands first; of what does not move only the results."""
        if positions not in self._orders:
            moving, needed = set(self.leaves), set(positions)
            reached = trace.reachable(self.instructions, positions)
            for p in reached:
                if not moving.isdisjoint(self.instructions[p].args):
                    moving.add(p)
                    needed.update(self.instructions[p].args)
            self.moving |= moving
            self._orders[positions] = [p for p in reached if p in needed]
        return self._orders[positions]

    def _coefficient(self, p, k, row):
        if p in self.leaves:
            raise IndexError(f"coefficient {k} of leaf {p} is not known yet")
        if p not in self.moving:
            return self.number(p) if k == 0 else ZERO
        i = self.instructions[p]
        operands = [self.known[a] for a in i.args]
        if k == 0:
            return AT_ONCE[i.op](*(o[0] for o in operands))
        return getattr(self, f"_{i.op}", _none)(k, row, *operands)

    # coefficient k > 0 of each operation: w is its own row so far, u and v are those of its operands

    def _neg(self, k, w, u):
        return ZERO if is_zero(u[k]) else -u[k]

    def _add(self, k, w, u, v):
        return plus(u[k], v[k])

    def _sub(self, k, w, u, v):
        return minus(u[k], v[k])

    def _mul(self, k, w, u, v):
        return product(u, v, k)

    def _div(self, k, w, u, v):
        return times(minus(u[k], dot(v[1 : k + 1], w[k - 1 :: -1])), 1.0 / v[0])

    def _select(self, k, w, condition, u, v):
        return ZERO if is_zero(u[k]) and is_zero(v[k]) else select(condition[0], u[k], v[k])

    def _sqrt(self, k, w, u):
        return times(minus(u[k], dot(w[1:k], w[k - 1 : 0 : -1])), 0.5 / w[0])

    def _exp(self, k, w, u):
        return times(dot(slope(u, k), w[:k]), 1.0 / k)

    def _log(self, k, w, u):
        return times(minus(u[k], times(dot(slope(w, k - 1), u[1:k]), 1.0 / k)), 1.0 / u[0])

    def _sin(self, k, w, u):
        return self._turned(k, u)[0]

    def _cos(self, k, w, u):
        return self._turned(k, u)[1]

    def _turned(self, k, u):
        """Return coefficient k of the sine and the cosine of u, which need each other."""
        sines = self.known.setdefault(("sin", id(u)), [trace.sin(u[0])])
        cosines = self.known.setdefault(("cos", id(u)), [trace.cos(u[0])])
        for j in range(len(sines), k + 1):
            rate = slope(u, j)
            sines.append(times(dot(rate, cosines[:j]), 1.0 / j))
            cosines.append(times(dot(rate, sines[:j]), -1.0 / j))
        return sines[k], cosines[k]

    def _atan(self, k, w, u):
        above = self.known.setdefault(("1 + u^2", id(u)), [1.0 + u[0] * u[0]])
        for j in range(len(above), k):
            above.append(product(u, u, j))
        return times(minus(u[k], times(dot(slope(w, k - 1), above[1:k]), 1.0 / k)), 1.0 / above[0])

    def _tanh(self, k, w, u):
        below = self.known.setdefault(("1 - w^2", id(w)), [1.0 - w[0] * w[0]])
        for j in range(len(below), k):
            below.append(times(-1.0, product(w, w, j)))
        return times(dot(slope(u, k), below[:k]), 1.0 / k)


def _none(k, w, *operands):
    """The later coefficients of a condition, and of what is a step function (abs and floor are frozen as modes)."""
    return ZERO
