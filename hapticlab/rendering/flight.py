"""The motion of handle, hand and wall over the next periods, crossings of the boundary located, as lines of a scene.

In one mode, inside the wall or outside, a whole period is a constant matrix; part of one is a power series in time,
``c[i+2] = (mu f - kappa c[i] - beta (i+1) c[i+1]) / ((i+1)(i+2))``: no exponential, no sine, and a damped, a swinging and
a free handle are one formula. It is cut where what is left is below the accuracy asked for. A crossing is where a
period's end lies beyond the boundary; Newton's steps from the chord, held inside the period, find its time.
"""

import math

import sympy as sp

from ..errors import AnalysisError
from ..scene.notation.symbols import when
from .scene_lines import number

#: how far a mode may move in a period, as the norm of its rates: half a swing, so that none returns unseen
FASTEST = math.pi
#: of Newton's steps
MOST_STEPS = 8


class Flight:
    """What happens from a state on, period by period; one crossing is seen in each.

    Parameters
    ----------
    lines : Lines
    accuracy : float
        Of position and crossing time, relative to what moves in a period.
    """

    def __init__(self, lines, accuracy):
        model = lines.model
        self.lines, self.model = lines, model
        self.rates = {wall: model.rates(wall) for wall in (True, False)}
        self.maps = {wall: model.flow(1.0, wall) for wall in (True, False)}
        speed = max(beta + math.sqrt(kappa) for beta, kappa, _ in self.rates.values())
        if speed > FASTEST:
            raise AnalysisError(
                f"with K = {model.K:g} N/m and M = {model.M:g} kg the handle reverses within T = {model.T:g} s; a dead-beat "
                f"wall allows one crossing per period. Use T <= {model.T * FASTEST / speed:.2g} s, or a softer or less "
                "damped wall"
            )
        if not 1e-15 <= accuracy <= 0.1:
            raise AnalysisError(
                f"accuracy = {accuracy!r}; needs a number from 1e-15 to 0.1, a fraction of the motion in one period"
            )
        self.degree = 2
        while speed**self.degree / math.factorial(self.degree) > accuracy:
            self.degree += 1
        # a chord misses by the curvature, some speed/4 of the period; each step squares that
        miss = min(0.5, speed / 4)
        self.steps = min(MOST_STEPS, max(1, math.ceil(math.log2(math.log(accuracy) / math.log(miss)))))

    def period(self, tag, p, w, side):
        """Name and return (p, w, side) one period on, and the condition that it was crossed; side is 1 inside, -1 outside."""
        let, inside = self.lines.let, side > 0
        end_p, end_w = self.same(tag, p, w, side)
        crossed = let(f"beyond{tag}", side * end_p) < 0
        before = self.series(f"a{tag}", p, w, inside)
        at = let(f"at0_{tag}", p / let(f"moved{tag}", p - end_p), "1")
        for step in range(1, self.steps + 1):
            # named, for at the inverse of a sum SymPy looks at length
            slope = let(f"slope{step}_{tag}", _slope(before, at))
            newton = let(f"newton{step}_{tag}", at - _value(before, at) / slope, "1")
            at = let(f"at{step}_{tag}", sp.Max(0, sp.Min(1, newton)), "1")
        rest = let(f"rest{tag}", 1 - at, "1")
        after = self.series(f"b{tag}", sp.S.Zero, let(f"w_cross{tag}", _slope(before, at)), side < 0)
        return (
            let(f"p_end{tag}", when(crossed, _value(after, rest), end_p)),
            let(f"w_end{tag}", when(crossed, _slope(after, rest), end_w)),
            let(f"side{tag}", when(crossed, -side, side), "1"),
            crossed,
        )

    def same(self, tag, p, w, side):
        """Name and return (p, w) one period on in the mode of now."""
        ends = [[self.end(wall, i, p, w) for i in (0, 1)] for wall in (True, False)]
        return [self.lines.let(f"{name}_same{tag}", when(side > 0, a, b)) for name, a, b in zip("pw", *ends, strict=True)]

    def end(self, wall, i, p, w):
        """Return row i of the state a whole period on in one mode."""
        Phi, gamma = self.maps[wall]
        return number(Phi[i, 0]) * p + number(Phi[i, 1]) * w + number(gamma[i]) * self.lines.outer

    def series(self, tag, p, w, inside):
        """Name and return the coefficients of the motion in one mode."""
        (b1, k1, mu), (b0, k0, _) = self.rates[True], self.rates[False]
        beta = when(inside, number(b1), number(b0)) if b1 != b0 else number(b0)
        kappa = self.lines.let(f"kappa_{tag}", when(inside, number(k1), number(k0)), "1")
        c = [p, w]
        for i in range(self.degree - 1):
            pull = -kappa * c[i] - (i + 1) * beta * c[i + 1] + (number(mu) * self.lines.outer if i == 0 else 0)
            c.append(self.lines.let(f"c{i + 2}_{tag}", pull / ((i + 1) * (i + 2))))
        return c


def _value(c, at):
    """Return a series at a time, by Horner's rule."""
    total = c[-1]
    for coefficient in reversed(c[:-1]):
        total = coefficient + at * total
    return total


def _slope(c, at):
    return _value([i * coefficient for i, coefficient in enumerate(c)][1:], at)
