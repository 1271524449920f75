"""What the sliders of a live view move: name, unit, value, ends, and the limit in words."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..base.units import dimension
from ..compiler.ir.notes import why_of
from ..compiler.tick.live_limits import NEAR
from ..errors import ParameterError

#: of a parameter that is zero and has no declared range, by unit; any other from -1 to 1
FROM_ZERO = {
    "N/m": (0.0, 500.0), "N*s/m": (0.0, 2.0), "m": (-0.03, 0.03), "N": (-2.0, 2.0), "s": (0.0, 0.05), "1": (0.0, 1.0),
}  # fmt: skip
#: of any other, in parts of its value
PARTS = (1 / 5, 3.0)
#: a declared range of more than so many times the value is a fence, not a range to move in
WIDE = 10.0


@dataclass(frozen=True)
class Span:
    """A slider: from ``low`` to ``high``, now at ``value``, all in SI; ``limit_words`` says how far the parameter may go."""

    name: str
    unit: str
    value: float
    low: float
    high: float
    limit_words: str = ""


def spans(program, sliders=None):
    """Return the Span of every slider.

    Parameters
    ----------
    program : Program
        Its live parameters can be moved.
    sliders : dict of str to (low, high), optional
        In SI; by default every live parameter, over its declared range, or from a fifth to three times its value.

    Raises
    ------
    ParameterError
        For a name that cannot be moved, and ends that are none.

    Examples
    --------
    >>> import hapticlab as hl
    >>> for span in spans(hl.compile(hl.wall()(k=300, x_o=0.01), T=1e-3)):
    ...     print((span.name, span.low, span.high, span.limit_words))
    ('B', 0.0, 2.0, '')
    ('k', 60.0, 900.0, 'allowed k >= 0')
    ('x_o', 0.002, 0.03, '')
    """
    if sliders is not None and not isinstance(sliders, Mapping):
        raise ParameterError(f'sliders = {sliders!r}; needs a dict of name to (low, high), as sliders={{"k": (100, 900)}}')
    channels = {c.name: (c, value) for c, value in zip(program.parameters, program.values, strict=True)}
    chosen = dict.fromkeys(channels) if sliders is None else sliders
    for name in chosen:
        if name not in channels:
            listed, why = ", ".join(channels) or "none", why_of(program.notes, name)
            raise ParameterError(f"sliders: {name} is no live parameter of {program.name}{why}; there are {listed}")
    return tuple(_span(*channels[name], ends, program.limits.get(name)) for name, ends in chosen.items())


def _span(channel, value, ends, stable):
    low, high = _usual(channel, value) if ends is None else _given(channel, ends)
    low, high = max(low, channel.low), min(high, channel.high)
    return Span(channel.name, channel.unit, value, min(low, value), max(high, value), _words(channel, value, stable))


def _usual(channel, value):
    declared = channel.high - channel.low
    if math.isfinite(declared) and declared > 0 and (value == 0 or declared <= WIDE * abs(value)):
        return channel.low, channel.high
    if value == 0:
        known = {dimension(unit): ends for unit, ends in FROM_ZERO.items()}
        return known.get(dimension(channel.unit), (-1.0, 1.0))
    return sorted(part * value for part in PARTS)


def _given(channel, ends):
    try:
        low, high = (float(end) for end in ends)
    except (TypeError, ValueError):
        raise ParameterError(f"sliders: {channel.name}: {ends!r}; needs (low, high), two numbers in {channel.unit}") from None
    if not -math.inf < low < high < math.inf:
        raise ParameterError(f"sliders: {channel.name}: ({low:g}, {high:g}); needs (low, high) with low < high")
    for end in (low, high):
        if not channel.low <= end <= channel.high:
            declared = f"{channel.low:g} to {channel.high:g} {channel.unit}"
            raise ParameterError(f"sliders: {channel.name} = {end:g} {channel.unit} is not in its range, {declared}")
    return low, high


def _words(channel, value, stable):
    """Say what the parameter's own range is, and up to where the steps are stable."""
    unit = "" if channel.unit == "1" else " " + channel.unit.replace("*", " ")
    allowed = _interval(channel.name, channel.low, channel.high, unit)
    ends = (stable[0], stable[2]) if stable else (-math.inf, math.inf)
    near = [math.isfinite(end) and 1 / NEAR < abs(end / (value or end)) < NEAR for end in ends]
    low, high = (end if told else away for end, told, away in zip(ends, near, (-math.inf, math.inf), strict=True))
    stays = _interval(channel.name, float(f"{low:.3g}"), float(f"{high:.3g}"), unit)
    return "; ".join([f"allowed {allowed}"] * bool(allowed) + [f"steps are stable for {stays}"] * bool(stays))


def _interval(name, low, high, unit):
    """Return an interval in words; empty where it has no end."""
    if math.isfinite(low) and math.isfinite(high):
        return f"{low:g} to {high:g}{unit}"
    if math.isfinite(low):
        return f"{name} >= {low:g}{unit if low else ''}"
    return f"{name} <= {high:g}{unit if high else ''}" if math.isfinite(high) else ""
