"""Constants of a paddle from what it recorded: coasting, steps, chirps, and several of them together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..base.telemetry import Telemetry, check_record
from ..errors import AnalysisError
from .fit_result import told
from .paddle_fit import PaddleFit
from .problem import CONSTANTS, Problem, Trace

if TYPE_CHECKING:
    from collections.abc import Mapping

#: standard gravity [m/s^2]
GRAVITY = 9.80665
#: samples after the force has ended that a late force may still reach, and the fewest that tell something
SETTLES, FEWEST = 5, 20
#: counts that a handle has to move by to tell anything
MOVED = 20
FORCE_CONSTANT = (
    "the force constant cannot be found from motion alone, because twice the force on twice the mass with twice the "
    "friction gives the same motion. Give a known reference: a record with HandleRecord(log, added=...) of a known mass "
    "fixed to the handle beside one "
    "without, or HandleRecord.hanging(log, mass) of a weight that pulls on it"
)


@dataclass(frozen=True, eq=False)
class HandleRecord(ShowsItself):
    """A record of a free handle, with known added masses and forces.

    Attributes
    ----------
    log : Telemetry
    added : float
        A known mass fixed to the handle [kg].
    push : float
        A known constant force on the handle beside the motor's [N], positive into the wall.
    at_rest : bool
        The handle was at rest at the first sample.

    Examples
    --------
    >>> from hapticlab.base.telemetry import Telemetry
    >>> log = Telemetry(t=[0, 1e-3], x=[0, 0], v=[0, 0], F=[0, 0], T=1e-3)
    >>> HandleRecord.hanging(log, 0.05).push           # a weight of 50 g on a thread along the handle's path
    0.4903325
    """

    log: Telemetry
    added: float = 0.0
    push: float = 0.0
    at_rest: bool = True

    @classmethod
    def hanging(cls, log: Telemetry, mass: float, *, at_rest: bool = True) -> HandleRecord:
        """The record of a handle that a weight pulls into the wall: it adds its force and its mass.

        Parameters
        ----------
        log : Telemetry
            Of the free handle, with the weight on a thread that pulls towards positive x.
        mass : float
            Of the weight [kg], > 0.
        at_rest : bool
            Whether the handle rests at the first sample.
        """
        return cls(log, mass, mass * GRAVITY, at_rest)

    def trace(self, first: int = 0) -> Trace:
        """The positions and forces of the record from sample ``first`` on.

        Parameters
        ----------
        first : int
            Number of the first sample that is used, >= 0.
        """
        check_record(self.log, "identify")
        if self.log.fault:
            raise AnalysisError(f"identify: the record ends in a fault, {self.log.fault}; needs one that ran to its end")
        if self.log.every > 1:
            raise AnalysisError(
                f"identify: one sample in {self.log.every} was sent, and the forces between them are not known. The "
                "identification needs every sample. Connect with a longer T, or watch fewer channels"
            )
        return Trace(self.log.x[first:, None], self.log.F[first:], self.log.T, self.added, self.push, self.at_rest)


def spin_down(
    log: Telemetry, *, m: float | None = None, counts_per_metre: float | None = None, confidence: float = 0.95
) -> PaddleFit:
    """Damping and Coulomb friction of a handle that coasts to rest with the motor off.

    m x'' = -b x' - coulomb sign(x'), from the last stretch without force. It tells ratios to the mass only.

    Parameters
    ----------
    log : Telemetry
    m : float, optional
        The mass [kg]; without it b/m [1/s] and coulomb/m [m/s^2] are found.
    counts_per_metre : float, optional
        Of the encoder [1/m].
    confidence : float

    Returns
    -------
    PaddleFit

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05, noise=1e-5)
    >>> found = spin_down(paddle.run(hl.laws.virtual_damper()(B=0), duration=0.3, v=0.4), m=0.03)
    >>> 0.1 in found["b"], 0.05 in found["coulomb"]
    (True, True)
    """
    check_record(log, "spin_down")
    driven = np.flatnonzero(log.F)
    first = driven[-1] + 1 + SETTLES if len(driven) else 0
    if len(log) - first < FEWEST:
        raise AnalysisError(
            f"spin_down: the last {max(len(log) - first, 0)} of {len(log)} samples are without force; needs {FEWEST}. Push "
            "the handle, then keep F = 0 until the handle rests"
        )
    m = None if m is None else number("m", m, "kg", "a handle", above=0)
    known = {"m": 1.0 if m is None else m}
    names = ("b", "coulomb") if m is not None else ("b/m", "coulomb/m")
    trace = HandleRecord(log, at_rest=False).trace(first)
    return _found(Problem((trace,), ("b", "coulomb"), known, _quantum(counts_per_metre)), names, confidence)


def step_response(
    log: Telemetry,
    *,
    counts_per_metre: float | None = None,
    known: Mapping[str, float] | None = None,
    at_rest: bool = True,
    confidence: float = 0.95,
) -> PaddleFit:
    """Mass, damping, Coulomb friction and delay from steps of force on a free handle.

    Parameters
    ----------
    log : Telemetry
        The forces are taken as the paddle reckons them: the force constant is for :func:`identify`, with a reference.
    counts_per_metre : float, optional
    known : dict of str to float, optional
        Constants that are not sought, of m, b, coulomb, delay.
    at_rest : bool
        The handle rests at the first sample.
    confidence : float

    Returns
    -------
    PaddleFit
    """
    check_record(log, "step_response")
    changes = np.count_nonzero(np.diff(log.F))
    if not 1 <= changes <= len(log) / 4:
        raise AnalysisError(
            f"step_response: the force changes {changes} times in {len(log)} samples; needs a few steps, each held for a while. "
            "For a force that always changes use chirp_response(log), and for no force spin_down(log)"
        )
    return identify(HandleRecord(log, at_rest=at_rest), counts_per_metre=counts_per_metre, known=known, confidence=confidence)


def chirp_response(
    log: Telemetry,
    *,
    counts_per_metre: float | None = None,
    known: Mapping[str, float] | None = None,
    at_rest: bool = True,
    confidence: float = 0.95,
) -> PaddleFit:
    """Mass, damping, Coulomb friction and delay from a force of rising frequency; as :func:`step_response`.

    Parameters
    ----------
    log : Telemetry
        Of a force of rising frequency.
    counts_per_metre : float, optional
        Encoder counts per metre [1/m], > 0.
    known : dict of str to float, optional
        Constants that are not sought, of m, b, coulomb, delay, in SI.
    at_rest : bool
        Whether the handle rests at the first sample.
    confidence : float
        Of the intervals, 0 ... 1.
    """
    check_record(log, "chirp_response")
    changes = np.count_nonzero(np.diff(log.F))
    if changes <= len(log) / 4:
        raise AnalysisError(
            f"chirp_response: the force changes {changes} times in {len(log)} samples; needs one that always changes. For a "
            "few steps use step_response(log)"
        )
    return identify(HandleRecord(log, at_rest=at_rest), counts_per_metre=counts_per_metre, known=known, confidence=confidence)


def identify(
    *records: HandleRecord | Telemetry,
    force_constant: bool = False,
    counts_per_metre: float | None = None,
    known: Mapping[str, float] | None = None,
    confidence: float = 0.95,
    near: PaddleFit | None = None,
) -> PaddleFit:
    """Constants of a paddle from all records of its free handle together, by maximum likelihood.

    (m + added) x'' = push - scale F - b x' - coulomb sign(x'), F[n] held over [n T + delay, (n+1) T + delay). Of 395
    random paddles (5 g to 0.5 kg, 0.01 to 2 N s/m, 0 to 0.3 N, 0 to 3 T; noise, counts in dither and without) that
    hl.identify.paddle moved none was refused, and the 95 % intervals held 94.9 % of the masses, 96.5 % of the dampings,
    95.2 % of the frictions and delays. They hold less often where a chirp spends half of its force on friction or more.

    Parameters
    ----------
    *records : HandleRecord or Telemetry
    force_constant : bool
        Seek ``scale`` as well, newtons at the handle for each that the paddle reckons. It needs a known reference.
    counts_per_metre : float, optional
        Of the encoder [1/m].
    known : dict of str to float, optional
        Constants that are not sought.
    confidence : float
    near : PaddleFit, optional
        An earlier fit of the same paddle: the search begins there, and ends there if that explains the records.

    Returns
    -------
    PaddleFit

    Raises
    ------
    AnalysisError
        If the records do not tell a constant: which, and what would.
    """
    known = dict(known or {})
    if unknown := set(known) - set(CONSTANTS):
        raise AnalysisError(f"known = {sorted(unknown)}; needs constants of {', '.join(CONSTANTS)}")
    given = [one if isinstance(one, HandleRecord) else HandleRecord(one) for one in records]
    if not given:
        raise AnalysisError("identify() was given no record; needs one or more, log = paddle.run(...)")
    if force_constant and "m" not in known and not any(one.added or one.push for one in given):
        raise AnalysisError(FORCE_CONSTANT)
    sought = tuple(name for name in CONSTANTS if name not in known and (force_constant or name != "scale"))
    problem = Problem(tuple(one.trace() for one in given), sought, known, _quantum(counts_per_metre))
    return _found(problem, sought, confidence, near and {name: found.value for name, found in near.estimates.items()})


def _quantum(counts_per_metre):
    if counts_per_metre is None:
        return 0.0
    if not 0 < abs(counts_per_metre) < np.inf:
        raise AnalysisError(f"counts_per_metre = {counts_per_metre!r}; needs a number [1/m] other than 0, or None")
    return 1 / abs(counts_per_metre)


def _found(problem, names, confidence, near=None):
    """Solve a problem of one lane and name what was found."""
    measured = np.concatenate([trace.y[:, 0] for trace in problem.traces])
    if np.ptp(measured) <= MOVED * problem.quantum:
        raise AnalysisError(
            f"identify: the handle moved by {1e3 * np.ptp(measured):.3g} mm; needs more than {MOVED} counts, "
            f"{1e3 * MOVED * problem.quantum:.3g} mm. Is the motor on, and is the force above friction?"
        )
    beside = f". Also, {FORCE_CONSTANT}" if "scale" in names else ""
    return told(
        PaddleFit, measured, problem.solve(near), names,
        quantum=problem.quantum, T=problem.traces[0].T, confidence=confidence, beside=beside,
    )  # fmt: skip
