"""Linear stability of a handle, a hand and a spring law that always acts: exact poles, exact limit.

Between changes of the force the plant moves by its matrix exponential. The characteristic equation is affine in the
stiffness, p0(z) + K p1(z) = 0, so a pole can leave the unit circle only at an angle where p0/p1 is real. These angles are
the roots of a polynomial in cos(theta); each gives one K, and the poles between two of them say which one counts.

Time is counted in periods. The polynomials of the plant are kept in w = z - 1, where a slow pole keeps its digits.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from ..errors import AnalysisError
from ..scene.taps import LEAD, TAPS
from .limit import MOST_PERIODS, Limit, check_law, check_number, whole_and_fraction
from .matrix import held

KIND = "exact linear stability of this plant"
NOTES = (
    "handle, hand, delay and law alone, the spring always acting",
    "ignores encoder, noise, Coulomb friction, force limit and the hand's push; a unilateral wall can chatter earlier",
)
ESTIMATED = "the paddle estimates v by backward difference, so half_sample is the law backward_difference, Eq. (23.5)"


def stability_limit(paddle, *, law="zoh", B=0.0):
    """Largest stiffness at which this paddle in this hand is stable: the eigenvalues of the sampled loop.

    Linear, with the spring always acting: it ignores encoder, noise, Coulomb friction, force saturation and the hand's
    push. A hand of another kind may be unstable sooner (:func:`~hapticlab.limits.passivity.passivity_limit`), and a
    unilateral wall under a law with memory chatters sooner.

    Parameters
    ----------
    paddle : SimulatedPaddle or any object with m [kg], b [N s/m], T [s], delay [s] and hand
        ``hand`` is None or has m [kg], b [N s/m] and k [N/m]. The delay may hold whole and fractional periods.
    law : {"zoh", "half_sample", "backward_difference", "ellis"}
        Eqs. (23.1), (23.3), (23.5), (23.7); half_sample uses the exact velocity at the sample where the paddle measures
        it. Where it is estimated (``paddle.velocity``: an encoder, a board) Eq. (23.3) is Eq. (23.5), and so is its limit.
    B : float
        Virtual damper of either sign [N s/m]: its force is ``B*(x[n] - x[n-1])/T``, beside the law, not through it.

    Returns
    -------
    Limit
        ``frequency`` is where stability is lost. K = 0 with the reason where the smallest stiffness is unstable.

    Raises
    ------
    AnalysisError
        For a plant value that is not finite or out of range, and for an unknown law.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> paddle = SimpleNamespace(m=0.05, b=0.1, T=1e-3, delay=0.0, hand=None)
    >>> round(stability_limit(paddle).K, 6)
    200.066689
    """
    loop = _Loop.of(paddle, law, B)
    notes = NOTES + (ESTIMATED,) * (LEAD[law] != loop.lead)
    candidates = _crossings(loop)
    tests = [k for k, _ in candidates]
    # the least K to look at when nothing crosses: well inside any band that a sampled plant of this mass can hold
    between = [K / 2 for K in tests[:1]] + [math.sqrt(a * b) for a, b in zip(tests, tests[1:], strict=False)]
    between.append(2 * tests[-1] if tests else 0.1 * loop.scale)
    if _unstable(loop, between[0]):
        return Limit(0.0, None, KIND, _why_never(loop, paddle, law), notes)
    for (K, theta), above in zip(candidates, between[1:], strict=True):
        if _unstable(loop, above):
            return Limit(K, theta / (2 * math.pi * loop.T), KIND, "a pole leaves the unit circle", notes)
    return Limit(math.inf, None, KIND, "no stiffness moves a pole out of the unit circle", notes)


def closed_loop_matrix(paddle, *, K, law="zoh", B=0.0):
    """One period of handle, hand and spring as a matrix on [x, v, past forces, past samples]; SI units.

    Parameters
    ----------
    K : float
        Stiffness [N/m]. The other arguments are those of :func:`stability_limit`.

    Returns
    -------
    array of shape (n, n)
        n = 2, plus one past force [N] for every begun period of delay, plus the past samples [m] the law looks at.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> paddle = SimpleNamespace(m=1.0, b=0.0, T=0.1, delay=0.0, hand=None)
    >>> closed_loop_matrix(paddle, K=100.0).round(9).tolist()
    [[0.5, 0.1], [-10.0, 1.0]]
    """
    loop = _Loop.of(paddle, law, B)
    return _matrix(loop, check_number("K", K, "N/m", "needs a finite stiffness", lambda v: True))


def closed_loop_poles(paddle, *, K, law="zoh", B=0.0):
    """Eigenvalues of :func:`closed_loop_matrix`, largest magnitude first: complex array of shape (n,)."""
    poles = np.linalg.eigvals(closed_loop_matrix(paddle, K=K, law=law, B=B)).astype(complex)
    return poles[np.argsort(-abs(poles), kind="stable")]


@dataclass(frozen=True)
class _Loop:
    """The sampled loop with time in periods: x[n+1] = Phi x[n] - late F[n-whole] - early F[n-whole-1]."""

    T: float
    A: np.ndarray
    early: np.ndarray  # effect [m/N], [m per period per N] of the older force, over the first fraction of the period
    late: np.ndarray
    Psi: np.ndarray
    whole: int
    fraction: float
    taps: tuple
    lead: float
    damper: float  # B/T [N/m]
    scale: float  # M/T^2 + b/T + k [N/m]

    @classmethod
    def of(cls, paddle, law, B):
        check_law(law)
        lacking = [name for name in ("m", "b", "T", "delay", "hand") if not hasattr(paddle, name)]
        if lacking:
            raise AnalysisError(f"a {type(paddle).__name__} has no {lacking[0]}; needs a paddle, as hl.SimulatedPaddle(...)")
        B = check_number("B", B, "N s/m", "a virtual damper needs a finite B", lambda v: True)
        T = check_number("T", paddle.T, "s", "a sampling period needs T > 0", lambda v: v > 0)
        hand = paddle.hand
        sums = {}
        for name, unit in (("m", "kg"), ("b", "N s/m")):
            own, added = getattr(paddle, name), 0.0 if hand is None else getattr(hand, name)
            sums[name] = check_number(name, own + added, unit, f"handle and hand need {name} >= 0", lambda v: v >= 0)
        M = check_number("m", sums["m"], "kg", "the handle needs a mass m > 0", lambda v: v > 0)
        k = 0.0 if hand is None else check_number("hand k", hand.k, "N/m", "needs k >= 0", lambda v: v >= 0)
        delay = check_number("delay", paddle.delay, "s", "needs delay >= 0", lambda v: v >= 0)
        whole, f = whole_and_fraction(delay, T, most=MOST_PERIODS)
        A = np.array([[0.0, 1.0], [-k * T**2 / M, -sums["b"] * T / M]])
        force = np.array([0.0, T**2 / M])
        Phi_rest, Psi_rest = held(A, 1 - f)
        late, early = Psi_rest @ force, Phi_rest @ held(A, f)[1] @ force
        scale = M / T**2 + sums["b"] / T + k
        taps, lead = TAPS[law], LEAD[law]
        if lead and getattr(paddle, "velocity", "measured") == "backward_difference":
            taps, lead = (taps[0] + lead, -lead), 0.0
        return cls(T, A, early, late, held(A, 1.0)[1], whole, f, taps, lead, B / T, scale)


def _matrix(loop, K):
    """Return the loop on [x, v, F[n-1], ..., x[n-1], ...], in SI units."""
    forces = loop.whole + (loop.fraction > 0)
    samples = max(len(loop.taps) - 1, int(loop.damper != 0))
    n = 2 + forces + samples
    law = np.zeros(n)  # F[n] as a row on the state
    past = [0, *range(2 + forces, n)]
    law[past[: len(loop.taps)]] = K * np.array(loop.taps)
    law[1] = K * loop.lead
    if loop.damper:
        law[past[:2]] += (loop.damper, -loop.damper)
    rows = [law, *np.eye(n)[2 : 2 + forces]]  # F[n], F[n-1], ...
    step = np.zeros((n, n))
    step[:2, :2] = np.eye(2) + loop.A @ loop.Psi
    step[:2] -= np.outer(loop.late, rows[loop.whole])
    if loop.fraction:
        step[:2] -= np.outer(loop.early, rows[loop.whole + 1])
    for age in range(forces):
        step[2 + age] = rows[age]
    for age in range(samples):
        step[2 + forces + age, past[age]] = 1.0
    step[1] /= loop.T  # from metres per period to m/s
    step[:, 1] *= loop.T
    return step


def _unstable(loop, K):
    return abs(np.linalg.eigvals(_matrix(loop, K))).max() > 1 + 1e-12


def _why_never(loop, paddle, law):
    undamped = paddle.b == 0 and (paddle.hand is None or paddle.hand.b == 0)
    if undamped and not loop.damper:
        return f"without damping (b = 0) law {law} feeds energy in at any stiffness"
    return f"B = {loop.damper * loop.T:g} N s/m with b = {paddle.b:g} N s/m is unstable at any stiffness"


def _plant(loop):
    """Return polynomials in w = z - 1, lowest power first: the denominator, and for x and v their (late, early) parts."""
    E = loop.A @ loop.Psi  # Phi - I without the subtraction
    determinant = np.linalg.det(loop.A) * np.linalg.det(loop.Psi)
    denominator = (determinant, -np.trace(E), 1.0)
    x = [(E[0, 1] * g[1] - E[1, 1] * g[0], g[0]) for g in (loop.late, loop.early)]
    v = [(E[1, 0] * g[0] - E[0, 0] * g[1], g[1]) for g in (loop.late, loop.early)]
    return denominator, x, v


def _characteristic(loop, theta):
    """Return p0 and p1 at z = e^(j theta), up to one common power of z."""
    z = np.exp(1j * theta)
    w = -2 * np.sin(theta / 2) ** 2 + 1j * np.sin(theta)
    denominator, x, v = _plant(loop)
    at = lambda c: sum(a * w**i for i, a in enumerate(c))  # noqa: E731
    position, velocity = (at(late) + at(early) / z for late, early in (x, v))
    law = sum(c * z**-i for i, c in enumerate(loop.taps))
    p0 = at(denominator) * z**loop.whole + loop.damper * (w / z) * position
    return p0, law * position + loop.lead * velocity


def _polynomials(loop):
    """Return p0 and p1 as coefficients of one common set of powers of z, for a first guess of the angles."""
    denominator, x, v = _plant(loop)
    position, velocity = (np.r_[0, _in_z(late)] + np.r_[_in_z(early), 0] for late, early in (x, v))  # times z
    p0 = np.r_[np.zeros(loop.whole + 3), _in_z(denominator)]
    damper = loop.damper * np.convolve([0, -1, 1], position)
    p0[: len(damper)] += damper
    law = np.r_[loop.taps, 0, 0][2::-1]
    p1 = np.convolve(law, position) + loop.lead * np.r_[0, 0, velocity]
    return p0, np.r_[p1, np.zeros(len(p0) - len(p1))]


def _in_z(p):
    """Turn a polynomial in w = z - 1 of degree one or two into one in z."""
    shift = np.array([[1, -1, 1], [0, 1, -2], [0, 0, 1]])
    return shift[: len(p), : len(p)] @ p


def _crossings(loop):
    """Return every (K, theta) with K > 0 and a pole on the unit circle, by rising K."""
    p0, p1 = _polynomials(loop)
    n = len(p0)
    products = np.correlate(p0, p1, "full")  # Im(p0 conj p1) is a sum of (products[+j] - products[-j]) sin(j theta)
    sines = products[n:] - products[: n - 1][::-1]
    # sin(j theta)/sin(theta) is the derivative of T_j(u)/j
    curve = chebyshev.chebder(np.r_[0.0, sines / np.arange(1, n)])
    while len(curve) > 1 and abs(curve[-1]) < 1e-15 * abs(curve).max():
        curve = curve[:-1]
    u = chebyshev.chebroots(curve) if len(curve) > 1 else np.array([])
    u = u.real[(abs(u.imag) < 1e-6) & (abs(u.real) < 1)]
    angles = [*(_polish(loop, theta) for theta in np.arccos(u)), math.pi]
    found = []
    for theta in angles:
        p0, p1 = _characteristic(loop, theta)
        K = -(p0 * np.conj(p1)).real / abs(p1) ** 2 if p1 else 0.0
        if K > 1e-12 * loop.scale:
            found.append((float(K), float(theta)))
    return sorted(found)


def _polish(loop, theta):
    """Move an angle onto the root of Im(p0 conj p1)/sin(theta) by secant steps, in arithmetic that keeps small angles."""

    def curve(angle):
        p0, p1 = _characteristic(loop, angle)
        return (p0 * np.conj(p1)).imag / math.sin(angle)

    before, at = theta * (1 - 1e-7), theta
    f_before, f_at = curve(before), curve(at)
    for _ in range(8):
        if f_at in (0.0, f_before):
            break
        step = -f_at * (at - before) / (f_at - f_before)
        if not abs(step) < 1e-3 * theta:
            return theta  # a double root: the guess is as good as it gets
        before, f_before, at = at, f_at, at + step
        f_at = curve(at)
        if abs(step) < 1e-16 * at:
            break
    return at
