"""How much mass can be felt through a constraint: the handle's acceleration is estimated, and arrives a sample late.

A constraint that moves a body with the handle is felt as F(n) = mp a(n), with mp the port mass and a(n) = (v(n) -
v(n-1))/T the only acceleration there is. On a handle of mass m, with the force held over the period, r = mp/m:

- v measured: v(n+1) - v(n) = -(T/m) F(n), so a(n+1) = -r a(n): stable for r < 1, whatever the period;
- v by backward difference: the second difference d = x(n) - 2x(n-1) + x(n-2) = T^2 a(n) obeys
  d(n+1) = -(r/2) (d(n) + d(n-1)), so z^2 + (r/2) z + r/2 = 0: stable for r < 2;
- k whole samples of delay: measured, z^(k+1) = -r, still r < 1; backward difference, z^(k+2) + (r/2)(z + 1) = 0, which
  crosses the unit circle at z = exp(i pi/(k + 3/2)): r < 1/cos(pi/(2k + 3)), 2 without delay, 1.236 for one sample, then to 1.

Damping of the handle or of the hand, and the hand's mass, only help: m alone is the worst case.
"""

import math

import numpy as np

from ..base.roots import root
from ..errors import PaddleError
from .device import total_delay


def largest_port_mass(*, m, T, delay=0.0, velocity="backward_difference"):
    """Return the port mass [kg] below which a constraint on the handle is stable.

    Parameters
    ----------
    m : float
        Mass of the handle [kg].
    T : float
        Sampling period [s].
    delay : float
        Computational delay [s], whole samples or not.
    velocity : {"backward_difference", "measured"}
        Where v(n) comes from.

    Examples
    --------
    >>> from hapticlab.device.port_mass_check import largest_port_mass
    >>> round(largest_port_mass(m=0.05, T=1e-3), 12)
    0.1
    >>> largest_port_mass(m=0.05, T=1e-3, velocity="measured")
    0.05
    """
    whole, part = divmod(delay / T, 1.0)
    if part > 1 - 1e-9:
        whole, part = whole + 1, 0.0
    k = int(whole)
    if part < 1e-9:
        if velocity == "measured":
            return m
        return m / math.cos(math.pi / (2 * k + 3))
    return m * root(lambda ratio: largest_root(ratio, k, part, velocity) - 1, 0.0, 4.0)


def largest_root(ratio, k, part=0.0, velocity="backward_difference"):
    """Return the growth per sample at r = mp/m, with a delay of k whole samples and a part of one.

    The force held from sample to sample then changes ``part`` of a period after the sample: over a period a measured
    velocity sees (1 - part) of the new force and part of the old one, and a second difference of positions sees them
    with the weights of a triangle two periods long.
    """
    if velocity == "measured":
        weights = 1 - part, part
    else:
        weights = (1 - part) ** 2 / 2, 0.5 + part - part**2, part**2 / 2
    return max(abs(np.roots([1.0, *[0.0] * k, *(ratio * w for w in weights)])), default=0.0)


def check_port_mass(program, paddle):
    """Refuse a program whose constraint on the handle this paddle cannot hold still.

    A board's force comes somewhere within the period of its sample: a whole sample of delay is taken for it.
    """
    felt = program.facts.get("port_mass")
    m = getattr(paddle, "m", None) or getattr(getattr(paddle, "settings", None), "m", None)
    if felt is None or not m:
        return
    delay = total_delay(paddle) if hasattr(paddle, "delay") else paddle.T
    limit = largest_port_mass(m=m, T=paddle.T, delay=delay, velocity=program.facts["velocity"])
    if not felt < limit:
        raise PaddleError(
            f"{program.name}: the constraint on the handle makes {felt:.4g} kg felt, and the mass of the handle itself is "
            f"{m:g} kg. Its acceleration is estimated from samples, which is stable below {limit:.4g} kg only. Put a "
            "coupler between "
            "the handle and the body (a spring and damper instead of the constraint), or make the body lighter"
        )
