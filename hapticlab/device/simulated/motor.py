"""What a motor makes of a duty: no force in a dead band, then straight lines through a measured curve.

A board that knows its motor's dead band and curve gives the duty that makes the force it means. A board that does not
takes the force as proportional to the duty: then the force that acts is not the force that was computed.
"""

from dataclasses import dataclass

from ...compiler.ir.trace import minimum, select

#: parts of the force at full duty, at the knots of the curve
QUARTERS = (0.0, 0.25, 0.5, 0.75, 1.0)


def knots(kind):
    """Return the duties, 0 ... 1, at which the motor gives 0, a quarter, half, three quarters and all of its force.

    Parameters
    ----------
    kind : object
        With duty_dead, and duty_25, duty_50 and duty_75 or None for a straight line from the dead band to full duty.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> knots(SimpleNamespace(duty_dead=0.2, duty_25=None, duty_50=None, duty_75=None))
    (0.2, 0.4, 0.6000000000000001, 0.8, 1.0)
    """
    dead = kind.duty_dead
    if kind.duty_25 is None:
        return (dead, *(dead + part * (1 - dead) for part in QUARTERS[1:-1]), 1.0)
    return dead, kind.duty_25, kind.duty_50, kind.duty_75, 1.0


def is_distorted(paddle):
    """Whether the force that acts differs from the force that is computed."""
    return not paddle.compensated and (paddle.duty_dead > 0 or paddle.duty_25 is not None)


@dataclass(frozen=True)
class Motor:
    """The force that acts, of a board that takes it as proportional to the duty; numbers or traced values.

    Attributes
    ----------
    force_full : float
        Force at full duty [N].
    duties : sequence of float
        See :func:`knots`.
    """

    force_full: object
    duties: object

    def force(self, asked):
        """Return the force that acts [N] where so much was asked for."""
        size = abs(asked)
        total = 0.0
        for low, high in zip(self.duties, self.duties[1:], strict=False):
            begin, end = low * self.force_full, high * self.force_full
            inside = select(size < begin, 0.0, size - begin)
            total = total + minimum(inside / (end - begin), 1.0)
        force = total * (self.force_full * QUARTERS[1])
        return select(asked < 0.0, -force, force)
