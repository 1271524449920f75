"""The virtual coupler of an admittance display: the lightest body that it can show, in a continuous approximation.

An admittance display measures the hand's force, lets the environment answer with a velocity and makes the device follow by
a servo, a damper b_s and a spring k_s from the device to where it should be. The servo works on positions, its velocities
are backward differences, and its force is held and late by the delay. Between sampled velocities it is

    C_2 = (b_s + k_s T/(1 - 1/z)) e^(-s (T/2 + delay)),    C_1 = C_2 e^(-s T/2),

C_2 for the environment's velocity and C_1 for the device's, which the backward difference tells half a period later. With
``Z = m s + b`` for the device the display is the two-port

    [v_1, -F_2] = [[1/(Z + C_1), C_2/(Z + C_1)], [-e^(-s delay), Z_a]] [F_1, v_2],

where ``Z_a = m_a (1 - 1/z)/T + b_a`` is the coupler: a body at the sample rate, beside the environment. Llewellyn's criterion
then asks for a *least* mass, as it asks an impedance display for a *largest* stiffness (Adams and Hannaford 1999).

It is an approximation: frequencies below Nyquist, the device continuous, without what a hand can do between the samples,
which for an impedance display :mod:`~hapticlab.limits.coupler` has exactly. Exact is what the servo alone is asked for:
with the environment at rest it is a wall of stiffness k_s and damper b_s, Eq. (23.10), ``b >= k_s T/2 + b_s`` without
delay. A paddle has no force sensor: it is simulated only.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..device.device import Device, known
from ..errors import AnalysisError
from .loop import Loop
from .passivity import required_damping
from .plots import plot_admittance
from .two_port import TwoPort, frequencies, stopped

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..device.device import AnyDevice

KIND = "continuous approximation below the Nyquist frequency; exact for the servo alone"
#: w T of motion so slow that a ton of coupler is no resistance
SLOW = 1e-6


@dataclass(frozen=True)
class AdmittanceDesign(ShowsItself):
    """The lightest body of an admittance display beside a damper, by the criterion for one device and servo.

    Attributes
    ----------
    m_a : float
        Mass of the coupler [kg].
    b_a : float
        Damping of the coupler [N s/m].
    frequency : float
        That stops a lighter one [Hz]; 0 for slow motion.
    kind : str
        What is claimed.
    two_port : TwoPort
        The display with this coupler.
    """

    m_a: float
    b_a: float
    frequency: float
    two_port: TwoPort
    kind: str = KIND

    def plot(self) -> Figure:
        """Draw the criterion against frequency, and the least that a hand can be made to feel."""
        return plot_admittance(self)

    def __str__(self) -> str:
        return (
            f"admittance coupler m_a = {self.m_a:.6g} kg, b_a = {self.b_a:.6g} N s/m: Llewellyn's criterion in a "
            f"{self.kind}; stopped {stopped(self.frequency)}"
        )


def admittance_design(device: AnyDevice, *, servo: float, servo_stiffness: float = 0.0, b_a: float = 0.0) -> AdmittanceDesign:
    """Design the virtual coupler of an admittance display by Llewellyn's criterion (after Adams and Hannaford 1999).

    The servo alone is held to Eq. (23.10), exactly: stable in every passive hand with the environment at rest. The coupler
    is designed in a continuous approximation, see this module: a hand that moves faster than half the sampling rate is
    left out, and on a device whose damping stops it within few samples, ``m/b`` below some 10 T, such hands do upset it.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T and delay are read.
    servo : float
        Damper b_s of the servo that makes the device follow [N s/m], > 0, by backward difference of positions.
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
        The sampled servo itself is active in some hand, or diverges in none; or b_a does not pay for slow motion.

    Examples
    --------
    >>> import hapticlab as hl
    >>> design = hl.design.admittance(hl.SimulatedPaddle(m=0.05, b=5.0, T=1e-3), servo=2.0)
    >>> design.two_port.absolutely_stable
    True
    """
    m, b, T, delay = known(device, "m", "b", "T", "delay")
    values = {"m": m, "b": b, "T": T, "delay": delay}
    b_s = number("servo", servo, "N s/m", "a device that follows", above=0)
    k_s = number("servo_stiffness", servo_stiffness, "N/m", least=0)
    b_a = number("b_a", b_a, "N s/m", "a coupler's damper", least=0)
    bare = admittance_display(**values, b_s=b_s, k_s=k_s, m_a=0.0, b_a=0.0)
    _servo_passive(bare, b_s, k_s, **values)
    theta = frequencies()
    needed, body = _needed(bare, theta), 2 * np.sin(theta / 2) ** 2 / T
    slow = float(_needed(bare, np.array([SLOW]))[0])  # no body resists motion as slow as this: a damper has to
    if slow > b_a + SLOW:
        raise AnalysisError(f"b_a = {b_a:g} N s/m; slow motion against the servo's spring needs b_a >= {slow:.4g} N s/m")
    masses = (needed - b_a) / body
    worst = int(masses.argmax())
    m_a = max(float(masses[worst]), 0.0)
    display = admittance_display(**values, b_s=b_s, k_s=k_s, m_a=m_a * (1 + 1e-9), b_a=b_a)
    at = 0.0 if theta[worst] < 1e-3 else float(theta[worst] / (2 * np.pi * T))  # the grid begins there
    return AdmittanceDesign(m_a, b_a, at, display)


def _servo_passive(bare, b_s, k_s, *, m, b, T, delay):
    """Refuse a servo that some passive hand makes unstable, the environment at rest: exactly, then as approximated."""
    asked = required_damping(K=k_s, T=T, B=b_s, delay=delay)
    if bare.stable and asked <= b * (1 + 1e-12) and (bare.h(frequencies())[:, 0, 0].real > 0).all():
        return
    alone = "" if bare.stable else "it diverges without a hand; "
    raise AnalysisError(
        f"servo = {b_s:g} N s/m, {k_s:g} N/m: {alone}active in some hand even without an environment. Sampled and held, it "
        f"needs a device damping above {asked:.4g} N s/m, and this device has b = {b:g} N s/m. Use a softer servo or a "
        "shorter delay"
    )


def _needed(display, theta):
    """Return the Re Z_a [N s/m] that the criterion asks of the coupler of a display which has none yet."""
    return -display.criterion(theta) / (2 * display.h(theta)[:, 0, 0].real)


def admittance_display(
    *, m: float, b: float, T: float, b_s: float, k_s: float = 0.0, m_a: float = 0.0, b_a: float = 0.0, delay: float = 0.0
) -> TwoPort:
    """Return the two-port of a device under a servo that shows an environment beside a body m_a on a damper b_a."""

    def g(theta):
        s = 1j * theta / T
        servo = (b_s + k_s * T / (1 - np.exp(-1j * theta))) * np.exp(-s * (T / 2 + delay))
        whole = m * s + b + servo * np.exp(-s * T / 2)
        coupler = m_a * (1 - np.exp(-1j * theta)) / T + b_a
        rows = [1 / whole, servo / whole], [-np.exp(-s * delay), coupler]
        return np.moveaxis(np.array(rows), 2, 0)

    alone = Device(m=m, b=b, T=T, delay=delay)
    stable = not Loop.of(alone, "zoh", b_s).unstable(k_s)  # the sampled servo, on the device alone
    return TwoPort(g, T, f"admittance display, m_a = {m_a:g} kg, b_a = {b_a:g} N s/m", stable)
