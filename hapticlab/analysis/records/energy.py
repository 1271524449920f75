"""Energy at the port: what a rendered wall gives back beyond what was put in, Fig. 23.6."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ...base.guesses import Guessed
from ...base.shows_itself import ShowsItself
from ...base.telemetry import check_record
from ...errors import AnalysisError
from ...limits.limit import whole_and_fraction
from .finding_plots import plot_energy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.annotations import Array
    from ...base.telemetry import Telemetry


@dataclass(frozen=True, eq=False)
class Energy(ShowsItself, Guessed):
    """The work exchanged between the handle and the rendered environment.

    Attributes
    ----------
    t : array, shape (N,)
        [s]
    W : array, shape (N,)
        Work done by the handle on the environment up to each sample [J]; negative where the environment has given more.
    generated : float
        -W at the last sample without force after a contact [J]: what the completed penetrations generated. nan where
        the handle has not left the wall again.
    absorbed : float
        What they kept, -generated [J].
    extracted : float
        The most that was ever drawn, max(0, -min W) [J]; for a spring that started loaded this includes its load.
    contacts : int
        Completed penetrations.
    exact : bool
        False where the force changed inside the periods and the position there was not recorded.
    """

    MEANT: ClassVar[dict[str, str]] = {
        "dissipated": "absorbed", "lost": "absorbed", "stored": "W", "work": "W", "energy": "W", "time": "t",
        "drawn": "extracted", "peak": "extracted", "penetrations": "contacts", "total": "W",
    }  # fmt: skip

    t: Array
    W: Array
    generated: float
    extracted: float
    contacts: int
    exact: bool

    @property
    def absorbed(self) -> float:
        """What the completed penetrations kept of the handle's work [J], or all of it where none was completed.

        Negative where they generated energy.
        """
        return float(self.W[-1]) if np.isnan(self.generated) else -self.generated

    def plot(self) -> Figure:
        """Return a figure: the energy that the environment holds over time, and where it gave more than it took."""
        return plot_energy(self)

    def __str__(self) -> str:
        if np.isnan(self.generated):
            drawn = f"at most {1e3 * self.extracted:.4g} mJ was drawn from the environment"
            return f"no completed penetration; the handle's work on the environment is {1e3 * self.W[-1]:.4g} mJ, and {drawn}"
        about = "" if self.exact else ", the position at the force's changes interpolated"
        verb = "generated" if self.generated >= 0 else "dissipated"
        penetrations = f"{self.contacts} penetration{'s' * (self.contacts != 1)}"
        return f"{penetrations} {verb} {1e3 * abs(self.generated):.4g} mJ{about}"


def energy(log: Telemetry) -> Energy:
    """Return the energy through the port, with force and displacement paired as they acted, Fig. 23.6.

    The force computed from sample n acts while the handle moves from x[n] to x[n+1]; a delay of d + f periods shifts it
    by d samples and makes it change at the fraction f of a period. Pairing F[n] with x[n] - x[n-1] instead makes a wall
    that generates energy look like one that dissipates it.

    Parameters
    ----------
    log : Telemetry
        Uses x [m] and F [N]; where recorded x_true [m], F_applied [N] and x_switch [m].

    Returns
    -------
    Energy

    Raises
    ------
    AnalysisError
        For fewer than two samples or values that are not finite.

    Examples
    --------
    A spring of 100 N/m pushed in by 2 mm a sample to 6 mm and out again gives K (v T) x_max too much:

    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> x = 1e-3 * np.array([0, 2, 4, 6, 4, 2, 0, -2])
    >>> log = Telemetry(t=np.arange(8) * 1e-3, x=x, v=0 * x, F=np.maximum(100 * x, 0), T=1e-3)
    >>> round(energy(log).generated, 12)
    0.0012
    """
    check_record(log, "energy")
    if log.every > 1:
        raise AnalysisError(
            f"energy: the record contains one sample in {log.every}, and the force between these samples is not known. The "
            "energy needs every sample. Run with every=1, fewer watched channels or a longer T"
        )
    x = np.asarray(log.channels.get("x_true", log.x), float)
    if len(x) < 2:
        raise AnalysisError(f"the record has {len(x)} sample(s); energy needs at least 2")
    whole, fraction = whole_and_fraction(log.delay, log.T)
    held = log.channels.get("F_applied")
    if held is None:
        held = np.r_[np.zeros(whole), log.F][: len(x)]
    if not (np.isfinite(x).all() and np.isfinite(held).all()):
        raise AnalysisError(f"the record contains values that are not finite; fault: {log.fault or 'none recorded'}")
    exact = True
    if fraction:
        exact = "x_switch" in log.channels
        switch = log.channels["x_switch"][:-1] if exact else x[:-1] + fraction * np.diff(x)
        work = np.r_[0.0, held[:-2]] * (switch - x[:-1]) + held[:-1] * (x[1:] - switch)
    else:
        work = held[:-1] * np.diff(x)
    W = np.r_[0.0, np.cumsum(work)]
    left = np.flatnonzero((held[1:] == 0) & (held[:-1] != 0)) + 1 + (fraction > 0)  # samples with no force left to act
    left = left[left < len(W)]
    generated = -float(W[left[-1]]) if len(left) else np.nan
    return Energy(np.asarray(log.t), W, generated, max(0.0, -float(W.min())), len(left), exact)
