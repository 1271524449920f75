"""A builder for derivatives: constants and signs stay in front of products, and sums gather a factor they share.

The chain rule writes 1/2 m (2 v) v' for m v v', the mass a joint carries as m1 u + m2 u + m3 u, and a moment of inertia as
m l^2 sin^2 q + m l^2 cos^2 q. Here the first has one constant, 1, the second is (m1 + m2 + m3) u, whose sum depends on
parameters alone, and the third is m l^2. The rounding of a derivative may differ by that; a program's own arithmetic is
left as it is written.
"""

from collections import Counter

from ..ir.trace import Builder


class Algebra(Builder):
    """A builder that rearranges sums and products of reals as they are recorded.

    Examples
    --------
    >>> from hapticlab.compiler.algebra.derivative_builder import Algebra
    >>> b = Algebra("f64")
    >>> m, M, v = (b.leaf("input", k, "f64") for k in range(3))
    >>> momentum = 0.5 * m * (2.0 * v) + M * v
    >>> [i.op for i in b.block([momentum]).instructions]
    ['input', 'input', 'input', 'add', 'mul']
    """

    def emit(self, op, *operands, type=None):
        """Record one operation, or what is the same number at less cost."""
        if op not in ("neg", "mul", "add", "sub"):
            return super().emit(op, *operands, type=type)
        (c, a), (d, b) = self._split(operands[0]), self._split(operands[-1])
        if op == "neg":
            return self._scaled(-c, a)
        if op == "mul":
            return self._scaled(c * d, a if b is None else b if a is None else super().emit("mul", a, b))
        if a is None or b is None:
            return super().emit(op, *operands, type=type)
        return self._sum(c, a, d if op == "add" else -d, b)

    def _split(self, value):
        """Return a value as a constant factor and the rest, None where nothing is left."""
        i = self.instructions[value.id]
        if i.op == "const":
            return i.value, None
        if i.op == "neg":
            c, rest = self._split(self.result(i.args[0]))
            return -c, rest
        if i.op == "mul":
            for k, other in (i.args, i.args[::-1]):
                if self.instructions[k].op == "const":
                    return self.instructions[k].value, self.result(other)
        return 1.0, value

    def _scaled(self, c, a):
        if a is None:
            return self.const(c)
        return super().emit("neg", a) if c == -1 else super().emit("mul", self.const(c), a)

    def _sum(self, c, a, d, b):
        """Return c a + d b."""
        if a.id == b.id:
            return self._scaled(c + d, a)
        whole = self._whole(a, b) if c == d else None
        if whole is not None:
            return self._scaled(c, whole)
        shared = self._shared(a, b)
        if shared is not None:
            factor, a, b = shared
            return self.emit("mul", factor, self._sum(c, a, d, b))
        if c < 0 and d < 0:
            return self._scaled(-1.0, self._sum(-c, a, -d, b))
        if c < 0:
            c, a, d, b = d, b, c, a
        op = "sub" if d < 0 else "add"
        if c == abs(d):
            return self._scaled(c, super().emit(op, a, b))
        return super().emit(op, self._scaled(c, a), self._scaled(abs(d), b))

    def _shared(self, a, b):
        """Return a factor of both products and what is left of each, or None."""
        i, j = self.instructions[a.id], self.instructions[b.id]
        if i.op == j.op == "mul":
            for factor, rest in (i.args, i.args[::-1]):
                if factor in j.args:
                    return self.result(factor), self.result(rest), self.result(j.args[1 - j.args.index(factor)])
        return None

    def _whole(self, a, b):
        """Return r where one of the two is r sin^2 and the other r cos^2, of the same angle, or None."""
        left, right = self._factors(a), self._factors(b)
        sine, cosine = left - right, right - left
        if [*sine.values()] != [2] or [*cosine.values()] != [2]:
            return None
        i, j = (self.instructions[k] for k in (*sine, *cosine))
        if {i.op, j.op} != {"sin", "cos"} or i.args != j.args:
            return None
        rest = self.const(1.0)
        for k in (left & right).elements():
            rest = self.emit("mul", rest, self.result(k))
        return rest

    def _factors(self, value):
        """Return factor -> how often it stands in a product."""
        found, stack = Counter(), [value.id]
        while stack:
            k = stack.pop()
            if self.instructions[k].op == "mul":
                stack.extend(self.instructions[k].args)
            else:
                found[k] += 1
        return found
