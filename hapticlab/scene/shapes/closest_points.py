"""Where two bodies are closest, as one word that the compiler turns into arithmetic."""

import sympy as sp

#: what a ClosestPoints gives, and its unit
PARTS = {"distance": "m", "normal_x": "1", "normal_y": "1", "point_x": "m", "point_y": "m"}


class ClosestPoints(sp.Expr):
    """One of the facts about where two bodies' cores are closest: their distance, the normal or the point.

    The arguments are the two bodies, each ``Tuple(cores, x, y, angle, radius)``, the method, what it prints as, and the
    part. A half-plane, which comes first, has no cores.
    """

    is_commutative = True
    is_real = True
    is_number = False

    @property
    def part(self):
        """A key of PARTS."""
        return self.args[4].name

    @property
    def unit(self):
        """Unit of the part."""
        return PARTS[self.part]

    def _eval_derivative(self, symbol):
        # taken on the compiler's graph, hapticlab.scene.notation.derivative.Partial; in symbols it stays as it is
        return sp.Derivative(self, symbol, evaluate=False) if symbol in self.free_symbols else sp.S.Zero

    def _sympystr(self, printer):
        return f"{self.part}({self.args[3].name})"

    def _latex(self, printer):
        return rf"\mathrm{{{self.part}}}\left(\text{{{self.args[3].name}}}\right)".replace("_", r"\_")


class sampled(sp.Expr):
    """The value of an expression at the sample, held until the next one, whatever it is inside a step."""

    is_commutative = True
    is_real = True
    is_number = False
    keeps_unit = True
