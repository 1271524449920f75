"""A scene whose handle moves as a given function of time, without hold: what a program's samples stand for."""

from dataclasses import replace

import numpy as np
import sympy as sp

from ...compiler.algebra.graph import Graph
from ...compiler.events.taylor_method import Taylor
from ...compiler.ir.program import Channel
from ...compiler.methods.chosen_method import chosen_method
from ...compiler.prune.excluded_modes import excluded, folded, rests_on
from ...compiler.tick.handle_samples import Handle
from ...compiler.tick.motion_program import motion_program
from ...compiler.tick.source import Options, Source
from ...errors import ProgramError
from ...scene.notation.symbols import T, acceleration, delay, lag_of, n, t, v, x

#: of the polynomial that the handle follows over a period
DEGREE = 6
#: stands for a period that goes to zero [s], where a difference over it does not cancel: the roundings balance here
SHORT = 1e-8
RATES = {x: v, v: acceleration}


class Followed(Handle):
    """A handle whose x(t) over a period is a polynomial of (tau - T/2)/T, its coefficients inputs after x, v and a."""

    def __init__(self, tracing):
        super().__init__(tracing, "measured", "soh")
        tracing.inputs += [Channel("a", "m/s^2", tracing.real)]
        tracing.inputs += [Channel(f"c_{k}", "m", tracing.real) for k in range(DEGREE + 1)]

    def sample(self, signal, lag=0):
        if lag:
            raise ProgramError(f"{signal.__name__}(n-{lag}): a past sample is not defined between samples")
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


def _polynomial(c, theta):
    total = c[-1]
    for lower in c[-2::-1]:
        total = total * theta + lower
    return total


def coefficients(derivatives, T):
    """The coefficients of x(t) in (tau - T/2)/T from its derivatives in the middle of the periods.

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
        Of the Taylor series: see :class:`~hapticlab.compiler.events.taylor_method.Taylor`.

    Returns
    -------
    Program
        Inputs x, v, a at the sample, and :func:`coefficients` of the period after it.

    Raises
    ------
    ProgramError
        The scene has a part that lives at the samples alone: a signal, or the rate of a delay.
    """
    source, decisions = between_samples(scene, T, substeps, order)
    return motion_program(source, rests_on(source.form, decisions), Followed)


def between_samples(scene, T, substeps=1, order=None):
    """(the :class:`Source` of a scene without samples, by "taylor", all its values constants; what ranges decided)."""
    form, decisions = excluded(replace(scene, watch={}), T, ())
    if form.updates:
        signal = next(iter(form.updates))
        raise ProgramError(f"{signal} is a sequence of samples, which is not defined between them")
    form = replace(
        form, force=without_samples(form.force), f=tuple(map(without_samples, form.f)),
        M=tuple(tuple(map(without_samples, row)) for row in form.M),
    )  # fmt: skip
    options = Options(chosen_method(Taylor(order=order)), T, substeps, dtype="float64", velocity="measured", live=())
    fixed = folded(scene, ())
    return Source(scene, form, options, fixed, Graph(fixed)), decisions


def without_samples(expr):
    """The limit of an expression of present and past samples as the sampling period goes to zero.

    A past sample is x(n) - k T v(n), so that a backward difference is the velocity and a predictor the position; n T is t.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab import n, x
    >>> without_samples(2 * x(n) - x(n - 1)), without_samples((x(n) - x(n - 1)) / hl.T)
    (x(n), v(n))
    """
    before = {s: s.func(n) - lag_of(s) * T * RATES[type(s)](n) for s in expr.atoms(x, v) if lag_of(s)}
    clocks = {e: e / (n * T) * t for e in expr.atoms(sp.Mul) if n in e.args and T in e.args}
    expr = expr.xreplace(before | clocks)
    if expr.has(delay) and _over_T(expr):
        raise ProgramError(f"{expr} contains the difference of a delay, whose rate is not known between samples")
    while expr.has(delay):
        expr = expr.xreplace({d: d.args[0] for d in expr.atoms(delay) if not d.args[0].has(delay)})
    return expr.xreplace({T: sp.Float(SHORT) if _over_T(expr) else sp.S.Zero}) if expr.has(T) else expr


def _over_T(expr):
    return any(p.base == T and p.exp.could_extract_minus_sign() for p in expr.atoms(sp.Pow))
