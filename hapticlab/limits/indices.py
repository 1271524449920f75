"""How far a sampled, held law is from passive, as a port: input-strict and output-strict indices.

The port's input is the handle's mean velocity over a period, D(n+1)/T, its output the force F(n) that was held
meanwhile, so that a linear law H(z) of position is the impedance ``Z(theta) = T H/(z - 1)``, z = e^(j theta).

* input-strict: ``sum F D >= nu sum D^2/T``, nu = inf Re Z [N s/m]. Where negative, a damper -nu beside the law pays.
* output-strict: ``sum F D >= eps T sum F^2``, eps = inf Re Z/|Z|^2 [m/(N s)]. Where negative, a dashpot in line with the
  law that yields by -eps for each newton pays.

Parts that share the velocity, as the device and what is rendered on it, add their nu: passive with b + nu >= 0, which is
Eq. (23.10). Parts that share the force, a law and a dashpot in line with it, add their eps. They are the two forms of a
passivity controller (:func:`hapticlab.passivity_controller`), series and parallel.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import AnalysisError
from .colgate import passivity_margin
from .linear_law import LinearLaw

#: frequencies looked at before the least is refined
GRID = 20_000


@dataclass(frozen=True)
class PassivityIndices:
    """Indices of a held law as a port, and where each is reached.

    Attributes
    ----------
    name : str
    nu : float
        Input-strict index [N s/m]; negative where the law is short of passivity.
    nu_frequency : float
        [Hz]
    eps : float
        Output-strict index [m/(N s)].
    eps_frequency : float
        [Hz]
    """

    name: str
    nu: float
    nu_frequency: float
    eps: float
    eps_frequency: float

    def __str__(self):
        return "\n".join([
            self.name,
            f"  input-strict   nu = {self.nu:+.6g} N s/m, at {self.nu_frequency:.4g} Hz: " + (
                f"short, a damper of {-self.nu:.6g} N s/m beside it pays" if self.nu < 0 else "in excess"),
            f"  output-strict eps = {self.eps:+.6g} m/(N s), at {self.eps_frequency:.4g} Hz: " + (
                f"short, a dashpot in line that yields {-self.eps:.6g} m/s a newton pays" if self.eps < 0 else "in excess"),
        ])  # fmt: skip


def passivity_indices(law):
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
        As of :func:`hapticlab.passivity_margin`.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(passivity_indices(hl.LinearLaw.of("backward_difference", K=200.0, T=1e-3)))
    backward_difference, K = 200 N/m
      input-strict   nu = -0.2 N s/m, at 500 Hz: short, a damper of 0.2 N s/m beside it pays
      output-strict eps = -5 m/(N s), at 500 Hz: short, a dashpot in line that yields 5 m/s a newton pays
    """
    if not isinstance(law, LinearLaw):
        raise AnalysisError(f"law = {law!r}; needs a LinearLaw, as hl.LinearLaw.of('zoh', K=200, T=1e-3)")
    margin = passivity_margin(law, b=0.0)

    def output_strict(theta):
        H = law.at(theta)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.real(H * (np.exp(-1j * theta) - 1)) / (law.T * np.abs(H) ** 2)

    theta = math.pi * np.arange(1, GRID + 1) / GRID
    at = int(np.nanargmin(output_strict(theta)))
    low, high = theta[max(at - 1, 0)], theta[min(at + 1, GRID - 1)]
    for _ in range(4):  # a finer grid around the least, a hundred times a round
        near = np.linspace(low, high, 201)
        least = int(np.nanargmin(output_strict(near)))
        low, high = near[max(least - 1, 0)], near[min(least + 1, 200)]
    eps = float(output_strict(near[least : least + 1])[0])
    hertz = 1 / (2 * math.pi * law.T)
    return PassivityIndices(law.name, 0.0 - margin.required, margin.frequency, eps, float(near[least] * hertz))
