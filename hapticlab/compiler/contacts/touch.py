"""What happens in the instant in which contacts touch or let go: impulses, which contacts rest, what energy was lost.

Rows: the k gaps first, then the slips of contacts with friction. W = J M^-1 J^T and P = M^-1 J^T over all rows come from
:func:`~hapticlab.compiler.algebra.complementarity.response`; the rates of the coordinates after are w + sum p_i P_i, and the
handle feels the impulse -sum p_i d(row i)/dx.
"""

import math
from dataclasses import dataclass

from ..algebra.complementarity import complementarity, impossible, reactions
from ..ir.structural_zeros import dot
from ..ir.trace import maximum, select
from .impulses import closed, dissipated, micro_rebound, sequential, simultaneous


@dataclass(frozen=True)
class Law:
    """The constants of one contact with an event law, as values.

    Attributes
    ----------
    name : str
    e : Value or float
        0 of a rigid contact.
    rest_speed : Value, float or None
        ``inf`` of a rigid contact: it never rebounds.
    slip : int or None
        Row of its tangential velocity, with friction ``mu``.
    mu : Value or float
    """

    name: str
    e: object
    rest_speed: object = None
    slip: object = None
    mu: object = 0.0


@dataclass(frozen=True)
class Struck:
    """What an instant of touch leaves behind.

    Attributes
    ----------
    p : list, one per row
        Impulses [N s].
    u : list, one per row
        Rates of the rows after.
    resting : list, shape (k,)
        Contacts that stay closed, held by their reactions from now on.
    lost : list, one per row
        Energy dissipated [J].
    """

    p: list
    u: list
    resting: list
    lost: list


def strike(W, u, b, touching, laws, period, order="sequential"):
    """:class:`Struck`: impacts by the laws, then rest for what would be back within the period.

    A contact rests if it is pressed closed and its rebound is slower than its rest speed, or than a T/2: a flight of
    2 u/a would end within the period T. What rests loses its rebound at once, so that no gap opens under it.

    Parameters
    ----------
    W : list of lists
    u : list, one per row
        Rates before.
    b : list, one per row
        Second derivatives of the rows without reactions.
    touching : list of bool or Value, shape (k,)
        Gap closed.
    laws : list of Law, shape (k,)
    period : float
    order : {"sequential", "simultaneous"}

    Examples
    --------
    A ball of 0.5 kg at 3 m/s, then one that only creeps:

    >>> from hapticlab.compiler.contacts.touch import Law, strike
    >>> fast = strike([[2.0]], [-3.0], [-9.81], [True], [Law("floor", 0.5)], 1e-3)
    >>> fast.u, fast.resting, fast.lost
    ([1.5], [False], [1.6875])
    >>> slow = strike([[2.0]], [-3e-3], [-9.81], [True], [Law("floor", 0.5)], 1e-3)
    >>> slow.u, slow.resting
    ([0.0], [True])
    """
    k = len(laws)
    names, e = [law.name for law in laws], [law.e for law in laws]
    gaps = [row[:k] for row in W[:k]]
    if order == "sequential":
        rubs = {i: (law.slip, law.mu) for i, law in enumerate(laws) if law.slip is not None}
        p, after = sequential(W, u, e, touching, rubs=rubs)
        if k > 1 or rubs:
            head, _ = closed(gaps, p[:k], after[:k], touching, names)
            p = [*head, *p[k:]]
    else:
        p, _ = simultaneous(gaps, u[:k], e, touching, names)
        p = [*p, *[0.0] * (len(u) - k)]
    after = _rates(W, u, p)
    pressed = complementarity(gaps, b[:k], touching, names)
    slow = [
        here & _slow(after[i], gaps[i][i] * push, law.rest_speed, period)
        for i, (here, push, law) in enumerate(zip(touching, pressed, laws, strict=True))
    ]
    resting = release(gaps, b[:k], slow, names)
    closing = reactions(gaps, after[:k], resting)
    p = [a + extra for a, extra in zip(p, [*closing, *[0.0] * (len(u) - k)], strict=True)]
    p = _possible(gaps, p, u, _rates(W, u, p), touching)
    after = [select(resting[i], 0.0, rate) if i < k else rate for i, rate in enumerate(_rates(W, u, p))]
    return Struck(p, after, resting, dissipated(u, after, p))


def release(W, b, resting, names=None):
    """Those of some resting contacts that go on resting: their reactions push.

    To be asked where one of the reactions has come down to zero; the others may need another set than before.
    """
    N = complementarity(W, b, resting, names)
    return [here & (0.0 < push) for here, push in zip(resting, N, strict=True)]


def micro_impulses(W, u, b, gaps, laws, envelopes, step):
    """(p, u_after) of the micro-impulses at the end of a step; Mirtich and Canny (1995).

    All at once: each contact within its envelope is to leave at least as
    :func:`~hapticlab.compiler.contacts.impulses.micro_rebound` says, with the acceleration that its reaction would cancel.
    """
    names = [law.name for law in laws]
    near = [gap < envelope for gap, envelope in zip(gaps, envelopes, strict=True)]
    pressed = complementarity(W, b, near, names)
    aims = [
        maximum(micro_rebound(gap, rate, law.e, envelope, -(W[i][i] * push), step), 0.0)
        for i, (gap, rate, law, envelope, push) in enumerate(zip(gaps, u, laws, envelopes, pressed, strict=True))
    ]
    q = [rate - select(rate < 0.0, aim, 0.0) for rate, aim in zip(u, aims, strict=True)]
    p = complementarity(W, q, near, names)
    p = _possible(W, p, u, _rates(W, u, p), near)
    return p, _rates(W, u, p)


def _possible(gaps, p, before, after, touching):
    """The impulses, nan where they do not keep the contacts apart: there the motor goes off."""
    size = 0.0
    for rate in before[: len(touching)]:
        size = maximum(size, abs(rate))
    never = impossible(gaps, after, touching, size)
    return p if never is False else [select(never, math.nan, value) for value in p]


def _slow(rate, acceleration, rest_speed, period):
    """Whether a rebound is below the rest speed, or back within the period."""
    if isinstance(rest_speed, float) and math.isinf(rest_speed):
        return True
    bound = acceleration * (0.5 * period)
    return rate <= (bound if rest_speed is None else maximum(bound, rest_speed))


def _rates(W, u, p):
    return [rate + dot(row, p) for rate, row in zip(u, W, strict=True)]
