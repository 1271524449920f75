"""What the sliders of a live view move: name, unit, value, ends, the limit in words, and when a new value acts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..base.drawing import SHOWN
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
    """A slider: from ``low`` to ``high``, now at ``value``, all in SI; ``limit_words`` says how far the parameter may go.

    ``scale`` times a number in SI is in ``unit_shown``; ``at_start``: a new value acts only where the scene starts again.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    limit_words: str = ""
    scale: float = 1.0
    unit_shown: str = ""
    at_start: bool = False


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
    late = _only_at_start(program)
    return tuple(_span(*channels[name], ends, program.limits.get(name), name in late) for name, ends in chosen.items())


def shown_unit(unit):
    """Return what a number in SI is multiplied by to be shown, and its unit as a person writes it.

    Examples
    --------
    >>> shown_unit("m"), shown_unit("m*s^-2"), shown_unit("N*s/m"), shown_unit("1")
    ((1000.0, 'mm'), (1.0, 'm/s²'), (1.0, 'N s/m'), (1.0, ''))
    """
    if unit in SHOWN:
        return SHOWN[unit]
    above = [part for part in unit.split("*") if "^-" not in part]
    below = [part.replace("^-1", "").replace("^-", "^") for part in unit.split("*") if "^-" in part]
    words = " ".join(above) + "".join(f"/{part}" for part in below) if above else unit.replace("*", " ")
    return 1.0, "" if words == "1" else words.replace("^2", "²").replace("^3", "³")


def _only_at_start(program):
    """Return the names of the parameters that the first states depend on, and no tick."""
    at_start, later = ({i.index for i in block.instructions if i.op == "param"} for block in (program.init, program.tick))
    return {program.parameters[k].name for k in at_start - later}


def _span(channel, value, ends, stable, at_start):
    low, high = _usual(channel, value) if ends is None else _given(channel, ends)
    low, high = max(low, channel.low), min(high, channel.high)
    scale, shown = shown_unit(channel.unit)
    words = _words(channel, value, stable, scale, shown)
    return Span(channel.name, channel.unit, value, min(low, value), max(high, value), words, scale, shown, at_start)


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


def _words(channel, value, stable, scale, shown):
    """Say what the parameter's own range is, and up to where the steps are stable."""
    unit = f" {shown}" if shown else ""
    allowed = _interval(channel.name, scale * channel.low, scale * channel.high, unit)
    ends = (stable[0], stable[2]) if stable else (-math.inf, math.inf)
    near = [math.isfinite(end) and 1 / NEAR < abs(end / (value or end)) < NEAR for end in ends]
    low, high = (end if told else away for end, told, away in zip(ends, near, (-math.inf, math.inf), strict=True))
    stays = _interval(channel.name, float(f"{scale * low:.3g}"), float(f"{scale * high:.3g}"), unit)
    return "; ".join([f"allowed {allowed}"] * bool(allowed) + [f"steps are stable for {stays}"] * bool(stays))


def _interval(name, low, high, unit):
    """Return an interval in words; empty where it has no end."""
    if math.isfinite(low) and math.isfinite(high):
        return f"{low:g} to {high:g}{unit}"
    if math.isfinite(low):
        return f"{name} >= {low:g}{unit if low else ''}"
    return f"{name} <= {high:g}{unit if high else ''}" if math.isfinite(high) else ""
