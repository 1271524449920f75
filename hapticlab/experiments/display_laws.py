"""An impedance and an admittance display around one handle and hand, stepped; simulated, for a paddle measures no force."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..base.roots import root
from ..device.simulated.moved_handle import Handle
from ..errors import PaddleError


@dataclass(frozen=True, kw_only=True)
class Impedance:
    """Impedance display: position is measured, force is given; F = k max(x, 0) + b_v v, held over the period.

    What the hand feels beside the wall is the device itself: its mass, damping and friction.
    """

    k: float
    b: float = 0.0
    name = "impedance"

    def begin(self):
        """The display's memory."""
        return ()

    def force(self, memory, x, v, f_h, T):
        """The force on the environment [N] and the memory."""
        return (self.k * x if x > 0 else 0.0) + self.b * v, memory


@dataclass(frozen=True, kw_only=True)
class Admittance:
    """Admittance display: the hand's force is measured, a body of mass m_v is moved by it against the wall, the handle follows.

    m_v a = f_h - k max(x_v, 0) - b v_v, by semi-implicit Euler, and F = k_p (x - x_v) + k_d (v - v_v) + ahead f_h: the
    motor holds the handle to the body, so that the device's own mass, damping and friction are felt only as far as that
    position controller gives way. Unless it takes off the hand's force as well, a wall is felt in series with k_p.

    Parameters
    ----------
    k, b : float
        Of the wall, of the medium [N/m, N s/m].
    m_v : float
        Virtual mass [kg], > 0: a display of this kind needs one.
    k_p, k_d : float
        Of the position controller [N/m, N s/m].
    ahead : float
        Part of the measured force that the motor takes off beforehand: exact at rest with 1, less stable in motion.
    """

    k: float
    b: float = 0.0
    m_v: float
    k_p: float
    k_d: float
    ahead: float = 1.0
    name = "admittance"

    def begin(self):
        """Place and velocity of the virtual body."""
        return (0.0, 0.0)

    def force(self, memory, x, v, f_h, T):
        """The force on the environment [N] and the memory."""
        place, velocity = memory
        F = self.k_p * (x - place) + self.k_d * (v - velocity) + self.ahead * f_h
        velocity += T / self.m_v * (f_h - (self.k * place if place > 0 else 0.0) - self.b * velocity)
        return F, (place + T * velocity, velocity)


def display_motion(paddle, display, *, duration, sensor_delay=0):
    """Let the hand of a simulated paddle move a display, and return (t, x, v, f_h), each an array.

    The plant is exact between samples. f_h is what a force sensor between hand and handle reads, which averages over the
    period that ends at the sample: the hand's spring and damper (by the trapezoidal rule), less m_h (v[n] - v[n-1])/T.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand.
    display : Impedance or Admittance
    duration : float
        [s]
    sensor_delay : int
        Samples by which the force sensor is late.
    """
    hand, T, ticks = paddle.hand, paddle.T, paddle.ticks(duration)
    if hand is None or not hand.moves or hand.push_noise:
        raise PaddleError("the hand of this comparison moves by an intent and has no noise; give hl.Hand(k=..., intent=...)")
    handle, memory = Handle(paddle), display.begin()
    intent = np.asarray(hand.samples(ticks, T))
    rows, measured, before = np.zeros((ticks, 4)), [0.0] * (sensor_delay + 1), (handle.x, handle.v)
    for tick in range(ticks):
        now, last = (handle.x, handle.v), max(tick - 1, 0)
        f_h = hand.push + sensed(hand, now, before, (intent[tick], intent[last]), T)
        before = now
        measured = [f_h, *measured[:-1]]
        F, memory = display.force(memory, handle.x, handle.v, measured[-1], T)
        rows[tick] = tick * T, handle.x, handle.v, f_h
        if not abs(F) < 1e6:
            return rows[: tick + 1].T
        handle.step(F if paddle.force_max is None else min(max(F, -paddle.force_max), paddle.force_max))
    return rows.T


def sensed(hand, now, before, intent, T):
    """The mean force [N] of a hand on the handle over a period, from (x, v) and the intents at its end and begin."""
    (x, v), (x_0, v_0) = now, before
    pull = hand.k * (sum(intent) - x - x_0) / 2 + hand.b * ((intent[0] - intent[1]) / T - (v + v_0) / 2)
    return pull - hand.m * (v - v_0) / T


def growth(paddle, display):
    """Largest eigenvalue, in magnitude, of one period of display, handle and hand in contact with the wall.

    From 1 on the contact is unstable. Friction, which only helps, and the force limit are left out. One period is linear in
    place and velocity of handle and body, and those of the handle before, so the steps along each of these are its columns.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand.
    display : Impedance or Admittance

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(b=1e-12, k=1e-12))
    >>> growth(paddle, Impedance(k=198)) < 1 < growth(paddle, Impedance(k=203))
    True
    """
    return float(np.abs(np.linalg.eigvals(_one_period(*_resting(paddle), display))).max())


def _resting(paddle):
    """A handle without friction and noise, its hand at rest at x = 0, and that hand."""
    if paddle.hand is None:
        raise PaddleError("a display needs a hand that feels it. Give hl.SimulatedPaddle(..., hand=hl.Hand('grip'))")
    hand = replace(paddle.hand, intent=None, push=0.0, push_noise=0.0)
    return Handle(replace(paddle, hand=hand, coulomb=0.0, noise=0.0, counts_per_metre=None, delay=0.0, sensor_delay=0.0)), hand


def _one_period(handle, hand, display):
    """The matrix that takes handle, handle before and memory from sample to sample, inside the wall."""
    T = handle.paddle.T
    inside = 1.0  # [m], so deep that no step leaves the wall; the motion is linear, and this is taken off again

    def step(state):
        x, v, x_0, v_0, *memory = state
        f_h = sensed(hand, (x, v), (x_0, v_0), (0.0, 0.0), T)
        F, memory = display.force(tuple(memory), x, v, f_h, T)
        handle.x, handle.v = x, v
        handle.step(F)
        return np.array([handle.x, handle.v, x, v, *memory])

    rest = np.array([inside, 0.0, inside, 0.0, *(inside, 0.0)[: len(display.begin())]])
    start = step(rest)
    return np.array([step(rest + change) - start for change in np.eye(len(rest)) / 2]).T * 2


def largest_stiffness(paddle, make, *, low=1.0, high=1e7):
    """The largest k [N/m] up to which ``make(k)`` is stable, looked for upwards by steps of 16 %, then between two.

    0 where it is unstable at ``low``, infinity where it is stable up to ``high``.
    """
    handle, hand = _resting(paddle)

    def growing(k):
        return np.abs(np.linalg.eigvals(_one_period(handle, hand, make(k)))).max() - 1

    stable = None
    for k in np.geomspace(low, high, 111):
        if growing(k) >= 0:
            break
        stable = k
    else:
        return math.inf
    if stable is None:
        return 0.0
    return root(growing, stable, k)
