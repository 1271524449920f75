"""The motion over a step as a Taylor series, by the recurrences of automatic differentiation on the traced accelerations.

Griewank and Walther, *Evaluating Derivatives*, ch. 13; Jorba and Zou, Experimental Mathematics 14 (2005) 99. Where the
motion is linear the series is the matrix exponential to rounding; where it ends (free flight) the rest costs nothing,
since a structural zero is never computed. Coefficients are of theta = tau/h, so that none leaves float32.
"""

from ..ir.operations import OPERATIONS
from ..ir.structural_zeros import ZERO
from ..ir.trace import reachable


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
        """The number of coefficients known of each result, for :meth:`cut`."""
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
            reached = reachable(self.instructions, positions)
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
        operation, operands = OPERATIONS[i.op], [self.known[a] for a in i.args]
        if k == 0:
            return operation.compute(*(o[0] for o in operands))
        # a condition is constant over the step, and so is a step function: abs and floor are frozen as modes
        return operation.series(self.known, k, row, *operands) if operation.series else ZERO
