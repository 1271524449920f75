"""How far a sampled, held law is from passive, as a port: input-strict and output-strict indices.

The port's input is the handle's mean velocity over a period, D(n+1)/T, its output the force F(n) that was held
meanwhile, so that a linear law H(z) of position is the impedance ``Z(theta) = T H/(z - 1)``, z = e^(j theta).

* input-strict: ``sum F D >= nu sum D^2/T``, nu = inf Re Z [N s/m]. Where negative, a damper -nu beside the law pays.
* output-strict: ``sum F D >= eps T sum F^2``, eps = inf Re Z/|Z|^2 [m/(N s)]. Where negative, a dashpot in line with the
  law that yields by -eps for each newton pays.

Parts that share the velocity, as the device and what is rendered on it, add their nu: passive with b + nu >= 0, which is
Eq. (23.10). Parts that share the force, a law and a dashpot in line with it, add their eps. They are the two forms of a
passivity controller (:func:`hapticlab.laws.passivity_controller`), series and parallel.

Where H is zero, 1/Z has a pole, and eps falls without bound on one side of it: a motion that hardly makes a force draws
energy all the same, and no dashpot, which yields to a force alone, pays. Unless what is left of the pole is imaginary, as of
K (1 + 1/z) at Nyquist; then eps is finite there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..base.arguments import instance
from ..base.shows_itself import ShowsItself
from ..device.device import Device
from ..errors import AnalysisError
from .colgate import passivity_margin
from .linear_law import LinearLaw

#: frequencies looked at before the least is refined
GRID = 20_000
#: |H| at a zero, part of its largest, and how near to the unit circle the zero is, up to rounding
ZERO, ON_CIRCLE = 1e-6, 1e-5
#: a zero so near to the circle makes a dip that the grid could miss
NEAR_CIRCLE = 1e-2
#: radians about a zero on the circle where 1/Z loses its digits, and is known from its sides
WINDOW = 1e-3


@dataclass(frozen=True)
class PassivityIndices(ShowsItself):
    """Indices of a held law as a port, and where each is reached.

    Attributes
    ----------
    name : str
    nu : float
        Input-strict index [N s/m]; negative where the law is short of passivity.
    nu_frequency : float
        [Hz]
    eps : float
        Output-strict index [m/(N s)]; -inf where no dashpot is enough.
    eps_frequency : float
        [Hz]
    """

    name: str
    nu: float
    nu_frequency: float
    eps: float
    eps_frequency: float

    def _sentence(self):
        return f"passivity indices of {self.name}: nu = {self.nu:+.4g} N s/m, eps = {self.eps:+.4g} m/(N s)"

    def __str__(self) -> str:
        nu = f"not passive; a damper of {-self.nu:.6g} N s/m in parallel makes it passive" if self.nu < 0 else "in excess"
        eps = (
            f"not passive; a dashpot in series that yields {-self.eps:.6g} m/s per newton makes it passive"
            if self.eps < 0
            else "in excess"
        )
        eps = eps if math.isfinite(self.eps) else "a motion at this frequency makes no force, so no dashpot in series is enough"
        return "\n".join([
            self.name,
            f"  input-strict   nu = {self.nu:+.6g} N s/m, at {_told(self.nu_frequency)}: {nu}",
            f"  output-strict eps = {self.eps:+.6g} m/(N s), at {_told(self.eps_frequency)}: {eps}",
        ])  # fmt: skip


def _told(frequency):
    return "every frequency" if frequency is None else f"{frequency:.4g} Hz"


def passivity_indices(law: LinearLaw) -> PassivityIndices:
    """Input-strict and output-strict passivity indices of a linear law that is sampled and held.

    Parameters
    ----------
    law : LinearLaw

    Returns
    -------
    PassivityIndices

    Raises
    ------
    AnalysisError
        As of :func:`hapticlab.passivity.margin`, and for a law that gives no force at all.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.passivity.indices(hl.laws.LinearLaw.of("backward_difference", K=200.0, T=1e-3)))
    backward_difference, K = 200 N/m
      input-strict   nu = -0.2 N s/m, at 500 Hz: not passive; a damper of 0.2 N s/m in parallel makes it passive
      output-strict eps = -5 m/(N s), at 500 Hz: not passive; a dashpot in series that yields 5 m/s per newton makes it passive
    """
    instance("law", law, LinearLaw, "a LinearLaw, as hl.laws.LinearLaw.of('zoh', K=200, T=1e-3)")
    margin = passivity_margin(Device(b=0.0), law)
    theta = math.pi * np.arange(1, GRID + 1) / GRID
    size = np.abs(law.at(theta)).max()
    if size == 0:
        raise AnalysisError(f"{law.name}: the force is zero for every motion, so there are no indices; give a law with a force")
    zeros = _zeros(law)
    on = np.array([one for one in zeros[abs(abs(zeros) - 1) < ON_CIRCLE] if abs(law.at(np.angle(one))) < ZERO * size])
    poles = np.angle(on)
    near = zeros[abs(abs(zeros) - 1) < NEAR_CIRCLE]
    dips = np.r_[np.angle(near) - abs(abs(near) - 1), np.angle(near), np.angle(near) + abs(abs(near) - 1)]
    theta = np.union1d(theta, dips[(dips > 0) & (dips < math.pi)])
    least = [(_at_a_zero(law, pole), float(pole)) for pole in poles]
    eps, at = min([*least, _least(law, theta, poles)])
    hertz = 1 / (2 * math.pi * law.T)
    return PassivityIndices(law.name, 0.0 - margin.required, margin.frequency, eps, at * hertz)


def _output_strict(law, theta):
    """Return (e^(-j theta) - 1)/(T conj H), whose real part is Re Z/|Z|^2."""
    return (np.exp(-1j * theta) - 1) / (law.T * np.conj(law.at(theta)))


def _least(law, theta, poles):
    """Return the least eps on these frequencies and between them, away from the poles, and its theta."""

    def eps(theta):
        beside = (abs(theta[:, None] - poles) > WINDOW).all(axis=1)
        values = np.full(theta.shape, np.inf)
        values[beside] = np.real(_output_strict(law, theta[beside]))
        return values

    at = int(np.argmin(eps(theta)))
    low, high = theta[max(at - 1, 0)], theta[min(at + 1, len(theta) - 1)]
    for _ in range(4):  # a finer grid around the least, a hundred times a round
        near = np.linspace(low, high, 201)
        at = int(np.argmin(eps(near)))
        low, high = near[max(at - 1, 0)], near[min(at + 1, 200)]
    return float(eps(near[at : at + 1])[0]), float(near[at])


def _zeros(law):
    """Return the zeros of H(z) on the upper half of the plane, z = 1 and its surroundings left out."""
    if law.finite:
        top = law.taps()
    else:  # C adj(z - A) B = det(z - A + B C) - det(z - A)
        top = np.poly(law.A - np.outer(law.B, law.C)) + (law.D - 1) * np.poly(law.A)
        top = np.where(abs(top) > 1e-13 * abs(top).max(), top, 0)
    zeros = np.roots(top)
    zeros = abs(zeros) * np.exp(1j * abs(np.angle(zeros)))  # a real one may have its angle at -pi
    return zeros[np.angle(zeros) > WINDOW]


def _at_a_zero(law, pole):
    """Return eps where H is zero: the limit, or -inf where it falls without bound on one side."""

    def sides(away):
        return _output_strict(law, pole + away * np.array([-1.0, 1.0]))

    near, nearer = sides(WINDOW), sides(WINDOW / 10)
    falls = (nearer.real < 0) & (abs(nearer.real) > 5 * abs(near.real)) & (abs(nearer.real) > 1e-6 * abs(nearer))
    if falls.any():
        return -math.inf
    one, two, four = (float(sides(away * WINDOW).real.mean()) for away in (1, 2, 4))
    if one > 3 * abs(two):
        return math.inf  # it rises on both sides
    once, twice = (4 * one - two) / 3, (4 * two - four) / 3
    return (16 * once - twice) / 15
