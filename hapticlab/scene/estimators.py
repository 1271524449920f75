"""Velocity from sampled positions: differences, a first-order filter, windows that adapt, Kalman filters.

A board measures positions. Each estimator is a few difference equations, so that it runs wherever a scene does:

======================  ==========================  =====================================================
estimator               lag at low frequency        noise of a count D at constant speed, at most
======================  ==========================  =====================================================
:func:`backward_velocity`  T/2                      D/T
:func:`filtered_velocity`  T/2 + tau                D/(T + tau)
:func:`window_velocity`    i T/2, i chosen          D/(i T)
:func:`kalman_velocity`    T (alpha/beta - 1/2)     beta D/T
======================  ==========================  =====================================================
"""

import math
from dataclasses import dataclass, field

import sympy as sp

from ..errors import SceneError
from .amount import Amount, amount, number_of
from .parameters import T
from .symbols import n, signal, when, x

#: samples back that a window may reach: each takes a dozen instructions of every tick
LONGEST_WINDOW = 32
#: no displacement is less [m]
_CLOSED = Amount(-1e30, "m")


@dataclass(frozen=True)
class VelocityEstimate:
    """An estimate of the handle's velocity, for :func:`~hapticlab.scene.laws.wall` or any scene.

    Attributes
    ----------
    velocity : sympy expression [m/s]
    eom : tuple of sympy.Eq
        Its difference equations; a scene that uses ``velocity`` takes them along: ``Scene(force, eom=estimate.eom)``.
    name : str
    cheaper : tuple of VelocityEstimate
        Estimates of less work, dearest first, for a board that has no time for this one.

    Examples
    --------
    >>> import hapticlab as hl
    >>> estimate = hl.filtered_velocity(tau="4 ms")
    >>> B = hl.parameters("B", units="N*s/m")
    >>> damper = hl.Scene(force=B * estimate.velocity, eom=estimate.eom)
    """

    velocity: sp.Expr
    eom: tuple = ()
    name: str = "velocity"
    cheaper: tuple = ()
    _transfer: tuple = field(default=(), repr=False)

    @property
    def is_linear(self):
        """Whether it has a transfer function."""
        return bool(self._transfer)

    def transfer(self, period):
        """Return (numerator, denominator) in powers of 1/z, from positions [m] to the estimate [m/s], at T = period [s].

        Raises
        ------
        SceneError
            For an estimate that is not linear, or changes with time.

        Examples
        --------
        >>> import hapticlab as hl
        >>> hl.backward_velocity().transfer(1e-3)
        ([1000.0, -1000.0], [1.0])
        """
        if not self._transfer:
            raise SceneError(
                f"{self.name} has no transfer function: it is not linear, or its gains change; use backward_velocity, "
                "filtered_velocity or kalman_velocity(steady=True), or simulate it"
            )
        over, under = ([number_of(sp.sympify(c)).subs(T, period) for c in part] for part in self._transfer)
        free = sorted({str(s) for c in (*over, *under) for s in c.free_symbols})
        if free:
            raise SceneError(
                f"{self.name}: {', '.join(free)} has no number; make the estimate with one, as in tau='4 ms'"
            )
        return [float(c) for c in over], [float(c) for c in under]

    def __str__(self):
        lines = [f"{self.name}: v = {self.velocity}"]
        return "\n".join([*lines, *(f"  {e.lhs} = {e.rhs}" for e in self.eom)])


def backward_velocity():
    """Backward difference (x(n) - x(n-1))/T, the estimate of Eq. (23.4), whatever the paddle measures.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.backward_velocity())
    backward difference: v = (x(n) - x(n - 1))/T
    """
    return VelocityEstimate(_difference(), (), "backward difference", (), ((1 / T, -1 / T), (1,)))


def _difference():
    return (x(n) - x(n - 1)) / T


def filtered_velocity(*, tau, name="v_filtered"):
    """Backward difference through a first-order filter, tau v' + v = x', mapped by s = (1 - 1/z)/T.

    v(n) = (tau v(n-1) + x(n) - x(n-1))/(tau + T). For a virtual damper B behind it Eq. (23.10) becomes
    b > K T/2 + B/(1 + 2 tau/T) for B >= 0, and stays b > K T/2 + \\|B\\| for B < 0 (after Brown 1995).

    Parameters
    ----------
    tau : float, text or Parameter
        Time constant [s], >= 0; its corner is at 1/(2 pi tau) Hz. A number is compiled in, a Parameter may be live.
    name : str
        Of its signal; a scene with two such estimates needs two names.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.filtered_velocity(tau="4 ms"))
    filtered difference: v = v_filtered(n)
      v_filtered(n) = (v_filtered(n - 1)*(0.004 s) + x(n) - x(n - 1))/(T + (0.004 s))
    """
    tau = _at_least_zero(tau, "s", "tau", "a filter")
    cheaper = (backward_velocity(),)
    v = signal(name, unit="m/s", instead=cheaper)
    step = sp.Eq(v(n), (tau * v(n - 1) + x(n) - x(n - 1)) / (tau + T))
    transfer = (1 / (tau + T), -1 / (tau + T)), (1, -tau / (tau + T))
    return VelocityEstimate(v(n), (step,), "filtered difference", cheaper, transfer)


def window_velocity(*, band, most=8, fit="end", name="v_window"):
    """First-order adaptive window: the slope of the longest line that the last samples allow.

    Janabi-Sharifi, Hayward and Chen, *Discrete-time adaptive windowing for velocity estimation*, IEEE Trans. Control
    Systems Technology 8 (2000) 1003-1009. The window grows sample by sample into the past while a line stays within
    ``band`` of every sample in it: long, and smooth, where the handle moves evenly; short where it turns.

    Parameters
    ----------
    band : float, text or Parameter
        How far a sample may be off the line [m], >= 0: one encoder count, or the peak of the noise.
    most : int
        Longest window [periods], 1 to 32.
    fit : {"end", "best"}
        ``"end"``: the line through the newest and the oldest sample; work grows with ``most``. ``"best"``: the line of
        least squares, which is smoother; work grows with the square of ``most``.
    name : str
        Of its signals.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.window_velocity(band="20 um", most=3).name
    'adaptive window of 3, end fit'
    """
    if not (isinstance(most, int) and 1 <= most <= LONGEST_WINDOW):
        raise SceneError(f"most = {most!r}; a window needs a whole number of periods, 1 to {LONGEST_WINDOW}")
    if fit not in ("end", "best"):
        raise SceneError(f"fit = {fit!r}; needs 'end' (the newest and the oldest sample) or 'best' (least squares)")
    band = _at_least_zero(band, "m", "band", "a window")
    half = window_velocity(band=band, most=most // 2, name=name) if most > 3 else backward_velocity()
    cheaper = (half, *half.cheaper)
    if fit == "best":
        cheaper = (window_velocity(band=band, most=most, name=name), *cheaper)
    slope, eom = (_end_fit if fit == "end" else _best_fit)(band, most, name)
    v = signal(name, unit="m/s", instead=cheaper)(n)
    return VelocityEstimate(v, (*eom, sp.Eq(v, slope / T)), f"adaptive window of {most}, {fit} fit", cheaper)


def _end_fit(band, most, name):
    """Return the displacement per period and its equations.

    With s_i = (x(n) - x(n-i))/i the line over i periods passes within band of every sample between where s_i lies within
    all s_j -+ band/j, j < i. These cones only narrow, so that the work grows with most alone; one that a line has left
    is closed for the longer lines.
    """
    eom = []

    def kept(part, value):
        named = signal(f"{name}_{part}", unit="m")(n)
        eom.append(sp.Eq(named, value))
        return named

    slope = line = x(n) - x(n - 1)
    low, high = kept("low_1", line - band), kept("high_1", line + band)
    for i in range(2, most + 1):
        line = kept(f"line_{i}", (x(n) - x(n - i)) / i)
        inside = (line >= low) & (line <= high)
        slope = kept(f"step_{i}", when(inside, line, slope))
        if i < most:
            low = kept(f"low_{i}", sp.Max(low, line - band / i))
            high = kept(f"high_{i}", when(inside, sp.Min(high, line + band / i), _CLOSED))
    return slope, tuple(eom if most > 1 else ())


def _best_fit(band, most, name):
    """Return the displacement per period and its equations; the line of least squares over each window."""
    slope, longer, eom = x(n) - x(n - 1), None, []

    def kept(part, unit, value):
        named = signal(f"{name}_{part}", unit=unit)(n)
        eom.append(sp.Eq(named, value))
        return named

    back = [sp.S.Zero, *(x(n) - x(n - j) for j in range(1, most + 1))]  # how far the handle has come since
    for i in range(2, most + 1):
        weights = [sp.Rational(6 * (2 * j - i), i * (i + 1) * (i + 2)) for j in range(i + 1)]
        line = kept(f"line_{i}", "m", sp.Add(*(w * d for w, d in zip(weights, back, strict=False))))
        # the line's own place at the newest sample, beside that sample: the mean of its distances
        ahead = kept(f"ahead_{i}", "m", sp.Add(*back[: i + 1]) / (i + 1) - line * sp.Rational(i, 2))
        off = [sp.Abs(back[j] - ahead - j * line) for j in range(i + 1)]
        inside = sp.Max(*off) <= band
        longer = kept(f"longer_{i}", "1", when(inside if longer is None else inside & (longer > 0), 1, 0))
        slope = kept(f"step_{i}", "m", when(longer > 0, line, slope))
    return slope, tuple(eom)


def kalman_velocity(*, acceleration, noise, steady=True, speed=1.0, name="kalman"):
    """Kalman filter of position and velocity under white acceleration, held over each period.

    With the tracking index L = acceleration T^2/noise the steady gains are closed forms, Kalata, *The tracking index*,
    IEEE Trans. Aerospace and Electronic Systems 20 (1984) 174-182: alpha = 1 - r^2, beta = 2 (1 - r)^2,
    1 - r = 2 L/(L + sqrt(L^2 + 8 L)). The filter predicts a period ahead by Eq. (23.4) with its own velocity, and
    corrects the place by alpha and the speed by beta/T of what it missed.

    Parameters
    ----------
    acceleration : float, text or Parameter
        Standard deviation of the handle's acceleration [m/s^2], > 0: the greater, the quicker and the noisier.
    noise : float, text or Parameter
        Standard deviation of a position [m], > 0; an encoder's count D has D/sqrt(12).
    steady : bool
        ``False`` carries the covariance along, from a start at unknown speed: right from the second sample on, for
        about twice the work.
    speed : float, text or Parameter
        Standard deviation of the speed at the start [m/s], for ``steady=False``.
    name : str
        Of its signals.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> estimate = hl.kalman_velocity(acceleration=50, noise="10 um")
    >>> [round(c, 6) for c in estimate.transfer(1e-3)[1]]
    [1.0, 0.117218, 0.05496]
    """
    sigma = _positive(acceleration, "m/s^2", "acceleration", "the handle"), _positive(noise, "m", "noise", "a sensor")
    index = sigma[0] * T**2 / sigma[1]
    cheaper = () if steady else (kalman_velocity(acceleration=acceleration, noise=noise, name=name),)
    cheaper += (backward_velocity(),)
    place, rate = signal(f"{name}_x", unit="m", initial=x(n)), signal(f"{name}_v", unit="m/s", instead=cheaper)
    if steady:
        lead = signal(f"{name}_lead", unit="1")
        eom = (sp.Eq(lead(n), _lead(index)),)
        alpha, beta = _steady_gains(lead(n))
    else:
        start = (_positive(speed, "m/s", "speed", "the handle") * T / sigma[1]) ** 2
        (alpha, beta), eom = _gains(index, start, name)
    missed, pull = signal(f"{name}_missed", unit="m"), signal(f"{name}_pull", unit="1/s")
    eom += (
        sp.Eq(missed(n), x(n) - (place(n - 1) + T * rate(n - 1))),
        sp.Eq(place(n), x(n) - (1 - alpha) * missed(n)),
        sp.Eq(pull(n), beta / T),  # a name of its own keeps it whole: one constant, or one division
        sp.Eq(rate(n), rate(n - 1) + pull(n) * missed(n)),
    )
    a, b = _steady_gains(_lead(index))
    transfer = ((b / T, -b / T), (1, a + b - 2, 1 - a)) if steady else ()
    title = "Kalman filter" + ("" if steady else " from the start")
    return VelocityEstimate(rate(n), eom, title, cheaper, transfer)


def _lead(index):
    return 2 * index / (index + sp.sqrt(index**2 + 8 * index))  # 1 - r, without the difference


def _steady_gains(lead):
    return lead * (2 - lead), 2 * lead**2


def _gains(index, start, name):
    """Return gains by the recursion of the covariance, in units of the noise and the period."""
    p = [signal(f"{name}_p{part}", unit="1", initial=first) for part, first in (("xx", 1), ("xv", 0), ("vv", start))]
    ahead = [signal(f"{name}_a{part}", unit="1") for part in ("xx", "xv", "vv")]
    gain = [signal(f"{name}_g{part}", unit="1") for part in ("x", "v")]
    xx, xv, vv = (q(n - 1) for q in p)
    predicted = xx + 2 * xv + vv + index**2 / 4, xv + vv + index**2 / 2, vv + index**2
    eom = [sp.Eq(a(n), value) for a, value in zip(ahead, predicted, strict=True)]
    eom += [sp.Eq(g(n), a(n) / (ahead[0](n) + 1)) for g, a in zip(gain, ahead, strict=False)]
    updated = gain[0](n), gain[1](n), ahead[2](n) - gain[1](n) * ahead[1](n)
    # the first sample is a measurement alone: there is no prediction to weigh it against
    eom += [sp.Eq(q(n), when(n > 0, after, type(q(n)).initial)) for q, after in zip(p, updated, strict=True)]
    return (gain[0](n), gain[1](n)), tuple(eom)


def _positive(given, unit, name, owner):
    value = amount(given, unit, name)
    number = number_of(value)
    if number.is_number and not number > 0:
        raise SceneError(f"{name} = {float(number):g} {unit}; {owner} needs {name} > 0")
    return value


def _at_least_zero(given, unit, name, owner):
    value = amount(given, unit, name)
    number = number_of(value)
    if number.is_number and not (number >= 0 and math.isfinite(number)):
        raise SceneError(f"{name} = {float(number):g} {unit}; {owner} needs {name} >= 0")
    return value
