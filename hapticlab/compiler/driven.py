"""A scene whose handle moves as a given function of time, without hold: what a program's samples stand for."""

import numpy as np

from ..errors import ProgramError
from ..scene.symbols import acceleration, n, t, v, x
from .advance import Taylor
from .handle import Handle
from .ir import Channel
from .lowering import Lowering
from .modes import excluded, rests_on

#: of the polynomial that the handle follows over a period
DEGREE = 6


class Followed(Handle):
    """A handle whose x(t) over a period is a polynomial of (tau - T/2)/T, its coefficients inputs after x, v and a."""

    def __init__(self, tracing):
        super().__init__(tracing, "measured", "soh")
        tracing.inputs += [Channel("a", "m/s^2", tracing.real)]
        tracing.inputs += [Channel(f"c_{k}", "m", tracing.real) for k in range(DEGREE + 1)]

    def sample(self, signal, lag=0):
        if lag:
            raise _past(f"{signal.__name__}(n-{lag})")
        return super().sample(signal)

    def acceleration(self):
        return self.tracing.tick.leaf("input", 2, self.tracing.real)

    def leaves(self, tau):
        tick, T = self.tracing.tick, self.T
        row = [tick.leaf("input", 3 + k, self.tracing.real) for k in range(DEGREE + 1)]
        rate = [(k / T) * c for k, c in enumerate(row)][1:]
        second = [(k / T) * c for k, c in enumerate(rate)][1:]
        theta = (tau - T / 2) * (1 / T)
        now = [_polynomial(c, theta) for c in (row, rate, second)]
        return dict(zip((x(t), v(t), acceleration(t), x(n), v(n)), (*now, *now[:2]), strict=True))


def _past(what):
    return ProgramError(f"{what}: a past sample has no meaning between the samples")


def _polynomial(c, theta):
    total = c[-1]
    for lower in c[-2::-1]:
        total = total * theta + lower
    return total


def coefficients(derivatives, T):
    """Return the coefficients of x(t) in (tau - T/2)/T from its derivatives in the middle of the periods.

    Parameters
    ----------
    derivatives : array (DEGREE + 1, ticks)
    T : float
        [s]

    Returns
    -------
    array (ticks, DEGREE + 1)
    """
    scaled, factor = [], 1.0
    for k, row in enumerate(derivatives):
        factor *= T / k if k else 1.0
        scaled.append(factor * row)
    return np.column_stack(scaled)


def driven(scene, *, T, substeps=1, order=None):
    """Compile a scene to the program of its motion under a :class:`Followed` handle, in float64, its values constants.

    Parameters
    ----------
    scene : Scene
        Every parameter bound.
    T : float
        Between two outputs [s].
    substeps, order
        Of the Taylor series: see :class:`~hapticlab.compiler.advance.Taylor`.

    Returns
    -------
    Program
        Inputs x, v, a at the sample, and :func:`coefficients` of the period after it.

    Raises
    ------
    ProgramError
        The scene has a part that lives at the samples alone: a signal, a delay, a past sample.
    """
    lowering, ranges = lowering_of(scene, T, substeps, order, Followed)
    return lowering.program(ranges)


def lowering_of(scene, T, substeps, order, handle):
    """Return (lowering, ranges) of a scene under a handle of a class, all its values constants."""
    form, decisions = excluded(scene, T, ())
    if form.updates:
        raise _past(str(next(iter(form.updates))))
    lowering = Lowering(
        scene, form, exact=False, method=Taylor(order=order), T=T, substeps=substeps, hold="soh", dtype="float64",
        velocity="measured", live=(), force_at="before",
    )  # fmt: skip
    lowering.handle = handle(lowering.tracing)
    return lowering, rests_on(form, decisions)
