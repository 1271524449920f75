"""The virtual coupler of an admittance display: the lightest body that it can show to every passive hand.

An admittance display measures the hand's force, lets the environment answer with a velocity and makes the device follow by
a servo, here a damper b_s and a spring k_s from the device to where it should be, late by half a period of hold and the
delay, ``C = (b_s + k_s/s) e^(-s tau)`` with ``tau = T/2 + delay``. With ``Z = m s + b`` for the device it is the two-port

    [v_1, -F_2] = [[1/(Z + C), C/(Z + C)], [-e^(-s delay), Z_a]] [F_1, v_2],

where ``Z_a = m_a (1 - 1/z)/T + b_a`` is the coupler: a body at the sample rate, beside the environment. Llewellyn's criterion
then asks for a *least* mass, as it asks an impedance display for a *largest* stiffness (Adams and Hannaford 1999).

The frequencies are those below Nyquist and the device is taken as continuous: this leaves out what a hand can do between
the samples, which for an impedance display :mod:`~hapticlab.limits.coupler` has exactly. A paddle has no force sensor: it
is simulated only.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import AnalysisError
from .limit import check_number, check_paddle
from .plots import plot_admittance
from .two_port import TwoPort, frequencies

#: w T of motion so slow that a ton of coupler is no resistance
SLOW = 1e-6


@dataclass(frozen=True)
class AdmittanceDesign:
    """The lightest body of an admittance display beside a damper, absolutely stable with one device and servo.

    Attributes
    ----------
    m_a : float
        Mass of the coupler [kg].
    b_a : float
        Damping of the coupler [N s/m].
    frequency : float
        That stops a lighter one [Hz].
    two_port : TwoPort
        The display with this coupler.
    """

    m_a: float
    b_a: float
    frequency: float
    two_port: TwoPort

    def plot(self):
        """Draw the criterion against frequency, and the least that a hand can be made to feel."""
        return plot_admittance(self)

    def __str__(self):
        return (
            f"admittance coupler m_a = {self.m_a:.6g} kg, b_a = {self.b_a:.6g} N s/m: stable with every passive hand and every "
            f"passive environment below the Nyquist frequency; stopped at {self.frequency:.4g} Hz"
        )


def admittance_design(paddle, *, servo, servo_stiffness=0.0, b_a=0.0):
    """Design the virtual coupler of an admittance display by Llewellyn's criterion (after Adams and Hannaford 1999).

    Parameters
    ----------
    paddle : SimulatedPaddle or any object with m [kg], b [N s/m], T [s], delay [s]
    servo : float
        Damper b_s of the servo that makes the device follow [N s/m], > 0.
    servo_stiffness : float
        Spring k_s of the servo [N/m], >= 0. It makes slow motion rigid, for which only b_a can pay.
    b_a : float
        Damping of the coupler [N s/m], >= 0.

    Returns
    -------
    AdmittanceDesign

    Raises
    ------
    AnalysisError
        The servo itself is active: ``b + b_s cos(w tau) < k_s sin(w tau)/w``; or b_a does not pay for slow motion.

    Examples
    --------
    >>> import hapticlab as hl
    >>> design = admittance_design(hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3), servo=2.0)
    >>> design.two_port.absolutely_stable
    True
    """
    check_paddle(paddle, "m", "b", "T", "delay")
    values = {"m": paddle.m, "b": paddle.b, "T": paddle.T, "delay": paddle.delay}
    b_s = check_number("servo", servo, "N s/m", "a device that follows needs a servo > 0", lambda v: v > 0)
    k_s = check_number("servo_stiffness", servo_stiffness, "N/m", "needs >= 0", lambda v: v >= 0)
    b_a = check_number("b_a", b_a, "N s/m", "a coupler's damper needs b_a >= 0", lambda v: v >= 0)
    theta = frequencies()
    bare = admittance_display(**values, b_s=b_s, k_s=k_s, m_a=0.0, b_a=0.0)
    h = bare.h(theta)
    if (lost := h[:, 0, 0].real < 0).any():
        hertz = theta[lost][0] / (2 * math.pi * paddle.T)
        raise AnalysisError(
            f"servo = {b_s:g} N s/m, {k_s:g} N/m: active in the hand at {hertz:.4g} Hz, before any environment; "
            f"needs a device of more damping than b = {paddle.b:g} N s/m, a softer servo or a shorter delay"
        )
    needed, body = _needed(bare, theta), (1 - np.cos(theta)) / paddle.T
    slow = float(_needed(bare, np.array([SLOW]))[0])  # no body resists motion as slow as this: a damper has to
    if slow > b_a + SLOW:
        raise AnalysisError(f"b_a = {b_a:g} N s/m: slow motion against the servo's spring needs b_a >= {slow:.4g}")
    masses = (needed - b_a) / body
    worst = int(masses.argmax())
    m_a = max(float(masses[worst]), 0.0)
    display = admittance_display(**values, b_s=b_s, k_s=k_s, m_a=m_a * (1 + 1e-9), b_a=b_a)
    return AdmittanceDesign(m_a, b_a, float(theta[worst] / (2 * math.pi * paddle.T)), display)


def _needed(display, theta):
    """Return the Re Z_a [N s/m] that the criterion asks of the coupler of a display which has none yet."""
    return -display.criterion(theta) / (2 * display.h(theta)[:, 0, 0].real)


def admittance_display(*, m, b, T, b_s, k_s=0.0, m_a=0.0, b_a=0.0, delay=0.0):
    """Return the two-port of a device under a servo that shows an environment beside a body m_a on a damper b_a."""

    def g(theta):
        s = 1j * theta / T
        servo = (b_s + k_s / s) * np.exp(-s * (T / 2 + delay))
        whole = m * s + b + servo
        coupler = m_a * (1 - np.exp(-1j * theta)) / T + b_a
        rows = [1 / whole, servo / whole], [-np.exp(-s * delay), coupler]
        return np.moveaxis(np.array(rows), 2, 0)

    return TwoPort(g, T, f"admittance display, m_a = {m_a:g} kg, b_a = {b_a:g} N s/m")
