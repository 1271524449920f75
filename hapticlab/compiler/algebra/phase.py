"""Time in whole ticks, and angles that time drives, sin(2 pi f t), in whole turns taken off before they cost digits.

A float32 counts no further than 2**24, and an int32 turns negative after 2**31: so ticks are counted in two digits, and
a scene has the time of day after weeks at any rate. As it is written the angle grows without end: after five seconds at
250 Hz a float32 holds it to half a thousandth of a radian, and past 8192 rad not at all. Time is a whole number of
ticks, so the turns are a whole number times the turns of one tick, and of that product only the fraction is needed. It
is found without rounding by multiplying short pieces, as half_pi is taken off in :mod:`hapticlab.compiler.ir.elementary`.

Accuracy in float32: 1e-6 rad, and the rounding of the frequency and of its turns a tick to float32, each at most 2**-24
of the whole angle: a frequency wrong by 1e-7 of itself, and no noise. A frequency that is not live is rounded once. It
holds for 2**33 ticks, three months at 1 kHz; in float64 for 2**48. Where t stands outside of a sine it is one number: past
2**24 ticks, 4.6 hours at 1 kHz, float32 tells it to 6e-8 of itself.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from ...scene.notation.symbols import Parameter, T, n, t
from ..ir.program import Channel
from ..ir.trace import Value, floor, select

#: bits of a digit of a tick count, and bits after the point of the longer piece of a tick's turns
SPLIT = {"f32": (11, 12), "f64": (16, 36)}
#: states that count ticks, the lower digit first
TICKS = ("tick", "tick_high")


def counted(tracing):
    """Return (high, low), whole numbers: ``high`` times the size of a digit and ``low`` are the ticks so far."""
    size, zero = digit(tracing.real), tracing.init.const(0.0)
    low, high = (tracing.state(name, Channel(name, "1", tracing.real), zero) for name in TICKS)
    full = low >= size - 1.0
    for name, value in zip(TICKS, (select(full, 0.0, low + 1.0), select(full, high + 1.0, high)), strict=True):
        tracing.set_next(name, value)
    return high, low


def digit(type):
    """The ticks that fill the lower digit of the tick count."""
    return 2.0 ** SPLIT[type][0]


def is_timed(program):
    """True of a program that counts ticks: its tick is another map at another time."""
    return any(c.name in TICKS for c in program.states)


@dataclass(frozen=True)
class Clock:
    """Time as a program has it: ``count()`` whole ticks of ``T`` [s], as two digits, and ``after`` [s] since the last."""

    count: Callable[[], tuple[Value, Value]]
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
        rates = [rate for rate in (term / t, term / (n * T)) if all(isinstance(s, Parameter) for s in rate.free_symbols)]
        driven += rates[:1]
        rest += [] if rates else [term]
    return sp.Add(*driven) / (2 * sp.pi), sp.Add(*rest)


def reduced_angle(f, clock, type):
    """Return 2 pi f t less its whole turns [rad]; ``f`` is a traced value, or a float where it is a constant."""
    per_second = round(1 / clock.T)
    # a whole rate is exact where a decimal T is not
    turns = f / per_second if math.isclose(per_second * clock.T, 1.0, rel_tol=1e-12) else f * clock.T
    size = digit(type)
    rest, low = clock.count()
    high = floor(rest / size)
    exact = rounded = 0.0
    for count, place in ((low, 1.0), (rest - high * size, size), (high, size**2)):
        long, short = _pieces(turns * place, type)
        exact, rounded = exact + count * long, rounded + count * short
    total = _centred(exact) + rounded
    if isinstance(clock.after, Value):  # followed as a series over the step: no turns are taken off what moves
        return _centred(total) * (2 * math.pi) + f * clock.after * (2 * math.pi)
    if clock.after:
        total = total + f * clock.after
    return _centred(total) * (2 * math.pi)


def _pieces(turns, type):
    """Return a longer piece of so few bits that three products with digits add up exactly, and the rest of ``turns``."""
    _, bits = SPLIT[type]
    turns = _centred(turns)
    long = floor(turns * 2.0**bits + 0.5) * 2.0**-bits
    return long, turns - long


def _centred(turns):
    """Return turns less the nearest whole number; exact."""
    return turns - floor(turns + 0.5)


def angle_of(translator, expr):
    """Return the value of an angle, whatever time adds to it reduced to less than a turn."""
    clock = translator.clock
    f, rest = frequency(expr) if clock and _has_time(expr) else (sp.S.Zero, expr)
    if f == 0:
        return translator(expr)
    angle = clock.angle(translator, f)
    return angle if rest == 0 else angle + translator(rest)


def _has_time(expr):
    """True where t or n stands in sums and products: inside of x(n) and other functions they are no angle of time."""
    return expr in (t, n) or (isinstance(expr, (sp.Add, sp.Mul)) and any(map(_has_time, expr.args)))
