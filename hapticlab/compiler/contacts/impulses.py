"""Impulses of bodies that meet: sequential or simultaneous, with restitution and friction; chapter section 23.5.2.

Given W = J M^-1 J^T and the gap rates u before, each function returns the normal impulses p; the rates after are
u + W p, the velocities w + M^-1 J^T p. The lines work on floats and on traced values, in a number of operations fixed
beforehand.
"""

from ...errors import SceneError
from ..algebra.complementarity import SINGULAR, complementarity, real_of
from ..algebra.linear_solve import same
from ..ir.structural_zeros import dot, is_zero
from ..ir.trace import maximum, minimum, select


def sequential(W, u, e, touching=None, sweeps=None, rubs=None):
    """(p, u_after): one contact after the other, in sweeps to and fro over the list, each by its own restitution.

    A contact that approaches gets u+ = -e u-, its neighbours feel it, and so on. Along a chain of k contacts k sweeps
    bring a blow from either end to the other: Newton's cradle of k + 1 balls. What still approaches then, among unequal
    masses, is left to :func:`closed`: u_after < 0 there.

    Parameters
    ----------
    W : list of lists, one row for each gap, then for each slip
    u : list, one per row
        Gap rates before, < 0 approaching; slips.
    e : list, shape (k,)
        One per gap.
    touching : list of bool or Value, shape (k,), optional
    sweeps : int, optional
        k unless given.
    rubs : dict contact -> (row of its slip, mu), optional

    Examples
    --------
    The first of three equal balls strikes the others at 1 m/s; the last leaves with all of it:

    >>> from hapticlab.compiler.contacts.impulses import sequential
    >>> sequential([[2.0, -1.0], [-1.0, 2.0]], [-1.0, 0.0], [1.0, 1.0])
    ([1.0, 1.0], [0.0, 1.0])
    """
    k, rubs = len(e), rubs or {}
    touching = touching or [True] * k
    p, u = [0.0] * len(u), list(u)
    for sweep in range(sweeps or k):
        for i in range(k) if sweep % 2 == 0 else reversed(range(k)):
            meets = touching[i] & (u[i] < 0.0)
            blows = {i: (1.0 + e[i]) * -u[i] / W[i][i]}
            if i in rubs:
                j, mu = rubs[i]
                blows = dict(zip((i, j), with_friction(W[i][i], W[i][j], W[j][j], u[i], u[j], e[i], mu), strict=True))
            # exactly -e u where nothing rubs: a rounded zero would count as an approach
            exact = {} if i in rubs else {i: select(meets, -(e[i] * u[i]), u[i])}
            for a, blow in blows.items():
                blow = select(meets, blow, 0.0)
                p[a] = p[a] + blow
                u = [exact[j] if j in exact else _plus(u[j], W[j][a], blow) for j in range(len(u))]
    return p, u


def _plus(a, w, blow):
    return a if is_zero(w) else a + w * blow


def simultaneous(W, u, e, touching=None, names=None):
    """(p, u_after): all contacts at once, 0 <= p, u+ >= -e u-, and p > 0 only where they are equal (Moreau 1988).

    Exact, and whatever the order of the contacts. With one e for all it never gains energy; with several it may, and then
    the least of them serves for all. A contact that was leaving and is struck closed again stays closed.

    Parameters
    ----------
    W, u, e, touching
        As for :func:`sequential`.
    names : list of str, optional
        For the message when more act on each other than can be enumerated.

    Examples
    --------
    The same three balls as one system: the first comes back.

    >>> from hapticlab.compiler.contacts.impulses import simultaneous
    >>> p, u = simultaneous([[2.0, -1.0], [-1.0, 2.0]], [-1.0, 0.0], [1.0, 1.0])
    >>> [round(float(value), 9) for value in (*p, *u)]
    [1.333333333, 0.666666667, 1.0, 0.0]
    """
    p, after = _at_once(W, u, e, touching, names)
    if any(not same(e[0], other) for other in e[1:]):
        least = e[0]
        for other in e[1:]:
            least = minimum(least, other)
        gains = sum(dissipated(u, after, p)) < -SINGULAR[real_of(W)] * dot(p, [abs(rate) for rate in u])
        careful, _ = _at_once(W, u, [least] * len(e), touching, names)
        p = [select(gains, low, value) for low, value in zip(careful, p, strict=True)]
        after = _after(W, u, p)
    return (p, after) if len(u) == 1 else closed(W, p, after, touching, names)


def _at_once(W, u, e, touching, names):
    p = complementarity(W, [rate + ratio * rate for rate, ratio in zip(u, e, strict=True)], touching, names)
    return p, _after(W, u, p)


def closed(W, p, u, touching=None, names=None):
    """(p, u_after) with what still approaches after an impact brought to rest on each other: then u_after >= 0."""
    more = complementarity(W, u, touching, names)
    return [a + b for a, b in zip(p, more, strict=True)], _after(W, u, more)


def _after(W, u, p):
    return [rate + dot(row, p) for rate, row in zip(u, W, strict=True)]


def with_friction(W, c, N, u, slip, e, mu):
    """(p, s): normal and tangential impulse of one contact, the tangential one within the friction cone |s| <= mu p.

    Newton's restitution and Coulomb's law of impulses (Whittaker; Brach 1991): the impulse that stops the slip if the
    cone holds it, else mu p against the slip. Where slip and approach are coupled (c != 0) the pair can gain energy
    (Kane, 1984; Stronge, 1990): an impact that would gain any goes without restitution.

    Parameters
    ----------
    W, c, N : Value or float
        J M^-1 J^T, J M^-1 S^T and S M^-1 S^T, with the rows J of the gap and S of the slip.
    u, slip : Value or float
        Gap rate and slip before.
    e, mu : Value or float

    Examples
    --------
    A ball (2/5 m r^2, so N = 3.5 / m) that slides into a wall without rebound:

    >>> from hapticlab.compiler.contacts.impulses import with_friction
    >>> with_friction(1.0, 0.0, 3.5, -1.0, 7.0, 0.0, 0.5)
    (1.0, -0.5)
    """
    p, s = _coulomb(W, c, N, u, slip, e, mu)
    if not is_zero(c):
        gained = p * u + s * slip + 0.5 * (W * p * p + 2.0 * c * p * s + N * s * s)
        gains = SINGULAR[real_of([W, u])] * p * abs(u) < gained
        plastic = _coulomb(W, c, N, u, slip, 0.0, mu)
        p, s = (select(gains, low, value) for low, value in zip(plastic, (p, s), strict=True))
    meets = u < 0.0
    return select(meets, p, 0.0), select(meets, s, 0.0)


def _coulomb(W, c, N, u, slip, e, mu):
    aim = -(1.0 + e) * u
    if is_zero(c):
        p = aim / W
        return p, maximum(minimum(-slip / N, mu * p), -(mu * p))
    # sticking: both rates as aimed; sliding: s = mu * side * p, the gap rate as aimed
    determinant = W * N - c * c
    p_stick, s_stick = (N * aim + c * slip) / determinant, -(c * aim + W * slip) / determinant
    side = select(s_stick < 0.0, -1.0, 1.0)
    resistance = W + mu * side * c
    # where friction undoes more of the gap's rate than the impulse makes, no impulse of sliding is large enough: it sticks
    jams = resistance <= 1e-6 * W
    p_slide = aim / select(jams, W, resistance)
    holds = (abs(s_stick) <= mu * p_stick) | jams
    return select(holds, p_stick, p_slide), select(holds, s_stick, mu * side * p_slide)


def dissipated(u, after, p):
    """The energy that each impulse took [J]: -p (u- + u+)/2, exact in sum for any of the laws (Thomson and Tait).

    For one contact it is 1/2 (1 - e^2) u^2 / W, with 1/W the effective mass.

    Examples
    --------
    >>> from hapticlab.compiler.contacts.impulses import dissipated
    >>> dissipated([-2.0], [1.0], [3.0])
    [1.5]
    """
    return [-0.5 * impulse * (before + now) for before, now, impulse in zip(u, after, p, strict=True)]


def check_rest_speed(rest_speed, acceleration, T, name):
    """Refuse a rest speed below a T/2, which would leave more impacts in a period than its budget.

    Parameters
    ----------
    rest_speed : float
        [m/s]
    acceleration : float
        Largest acceleration that closes the gap [m/s^2], >= 0.
    T : float
        Period [s].
    name : str
        Of the contact.
    """
    needed = acceleration * T / 2
    if rest_speed < needed:
        raise SceneError(
            f"{name}: rest_speed = {rest_speed:g} m/s; needs at least a T/2 = {needed:g} m/s, with the acceleration "
            f"a = {acceleration:g} m/s^2 that closes the gap and T = {T:g} s: slower rebounds would come back more than "
            "once per period. Raise rest_speed, shorten T, or leave out rest_speed"
        )


def micro_rebound(gap, u, e, envelope, acceleration, step):
    """The gap rate after a micro-impulse at the end of a step; Mirtich and Canny (1995).

    A contact acts within the envelope. An approach faster than the free acceleration a gives in two steps is an impact
    and rebounds with e. A slower one is lasting contact: it rebounds with enough to end the next step in the middle of the
    envelope, but no faster than that acceleration made it, so that no energy is fed: the body hovers there.

    Parameters
    ----------
    gap, u : Value or float
        At the end of the step, u < 0 approaching.
    e, envelope : Value or float
    acceleration : Value or float
        Of the gap in free flight, < 0 closing.
    step : float
    """
    slow = -u <= maximum(-2.0 * step * acceleration, 0.0)
    aimed = (0.5 * envelope - gap) / step - 0.5 * step * acceleration
    lasting = minimum(maximum(aimed, 0.0), -u)
    after = select(slow, lasting, -e * u)
    return select((gap < envelope) & (u < 0.0), after, u)
