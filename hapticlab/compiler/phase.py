"""Angles that time drives, sin(2 pi f t), in whole turns taken off before they cost digits.

As it is written the angle grows without end: after five seconds at 250 Hz a float32 holds it to half a thousandth of a
radian, and past 8192 rad not at all. Time is a whole number of ticks, so the turns are a whole number times the turns of
one tick, and of that product only the fraction is needed. It is found without rounding by multiplying short pieces, as
half_pi is taken off in :mod:`hapticlab.compiler.elementary`.

Accuracy in float32: 1e-6 rad, and the rounding of the frequency and of its turns a tick to float32, each at most 2**-24
of the whole angle: a frequency wrong by 1e-7 of itself, and no noise. A frequency that is not live is rounded once. It
holds for 2**24 ticks, 4.6 hours at 1 kHz; after that float32 counts ticks by twos. In float64 it holds for 2**31 ticks.
"""

import math
from dataclasses import dataclass

import sympy as sp

from ..scene.symbols import Parameter, T, n, t
from .trace import Value, floor

#: bits of the lower part of a tick count, and bits after the point of the longer piece of a tick's turns
SPLIT = {"f32": (12, 12), "f64": (16, 36)}


@dataclass(frozen=True)
class Clock:
    """Time as a program has it: ``count()`` whole ticks of ``T`` [s], and ``after`` [s] since the last one."""

    count: callable
    T: float
    after: float | Value = 0.0

    def angle(self, translator, f):
        """Return 2 pi f t less its whole turns [rad], f an expression of parameters and numbers."""
        value = float(f) if f.is_number else translator(f)
        if isinstance(value, Value) and value.constant is not None:
            value = value.constant
        return reduced_angle(value, self, translator.builder.real)


def frequency(angle):
    """Return (f, rest) with angle = 2 pi f t + rest, f [1/s] of parameters and numbers alone; f is 0 without time.

    Examples
    --------
    >>> import hapticlab as hl
    >>> f = hl.parameters("f", units="Hz")
    >>> frequency(2 * sp.pi * f * hl.t + hl.x(hl.n))
    (f, x(n))
    """
    driven, rest = [], []
    for term in sp.Add.make_args(sp.expand_mul(angle)):
        rates = [
            rate for rate in (term / t, term / (n * T)) if all(isinstance(s, Parameter) for s in rate.free_symbols)
        ]
        driven += rates[:1]
        rest += [] if rates else [term]
    return sp.Add(*driven) / (2 * sp.pi), sp.Add(*rest)


def reduced_angle(f, clock, type):
    """Return 2 pi f t less its whole turns [rad]; ``f`` is a traced value, or a float where it is a constant."""
    per_second = round(1 / clock.T)
    # a whole rate is exact where a decimal T is not
    turns = f / per_second if math.isclose(per_second * clock.T, 1.0, rel_tol=1e-12) else f * clock.T
    low_bits, _ = SPLIT[type]
    size = 2.0**low_bits
    count = clock.count()
    high = floor(count / size)
    total = _fraction(high, turns * size, type) + _fraction(count - high * size, turns, type)
    if isinstance(clock.after, Value):  # followed as a series over the step: no turns are taken off what moves
        return _centred(total) * (2 * math.pi) + f * clock.after * (2 * math.pi)
    if clock.after:
        total = total + f * clock.after
    return _centred(total) * (2 * math.pi)


def _fraction(count, turns, type):
    """Return count * turns less whole turns, count a whole number of few bits."""
    _, bits = SPLIT[type]
    turns = _centred(turns)
    long = floor(turns * 2.0**bits + 0.5) * 2.0**-bits
    short = turns - long
    return _centred(count * long) + count * short


def _centred(turns):
    """Return turns less the nearest whole number; exact."""
    return turns - floor(turns + 0.5)


def angle_of(translator, expr):
    """Return the value of an angle, whatever time adds to it reduced to less than a turn."""
    clock = translator.clock
    f, rest = frequency(expr) if clock else (sp.S.Zero, expr)
    if f == 0:
        return translator(expr)
    angle = clock.angle(translator, f)
    return angle if rest == 0 else angle + translator(rest)
