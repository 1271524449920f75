"""What the states of a program are called, and their units."""

import sympy as sp

from .program import Channel


def channel_of(state, real):
    """Return the channel of a coordinate q or its rate q'.

    Examples
    --------
    >>> import hapticlab as hl
    >>> channel_of(hl.coordinate("z", unit="m").diff(hl.t), "f32").unit
    'm/s'
    """
    if isinstance(state, sp.Derivative):
        kind = type(state.expr)
        return Channel(f"d{kind.__name__}/dt", "1/s" if kind.unit == "1" else f"{kind.unit}/s", real)
    return Channel(type(state).__name__, type(state).unit, real)


def short(expr, most=24):
    """Return an expression as a name that fits a line of the listing."""
    text = str(expr)
    return text if len(text) <= most else f"{text[: most - 4]}..."
