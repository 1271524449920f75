"""A scene of fewer masses that feels the same at the handle: offered, measured, never taken without a word."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...compiler.tick.compile_scene import compile
from ...device.device import Device, known
from ...errors import AnalysisError
from ...limits.port import port_damping
from ...scene.scene import Scene
from .impedance import port_of
from .impedance_peaks import BESIDE, around, frequencies, held, infinite, outside, refined
from .mass_chain import modal, network_of, scene_of
from .moment_matching import candidates
from .reduction_plot import plot_reduction

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ...base.annotations import Array
    from ...device.device import AnyDevice

#: below what a hand tells from another force, 7 to 10 %
TOLERANCE = 0.05


@dataclass(frozen=True)
class Reduction(ShowsItself):
    """A reduced scene and how far it is from the full one; printing it shows both.

    Attributes
    ----------
    scene, full : Scene
        ``scene`` is the reduced one and runs like any other; what the full one watched is not in it.
    before, masses : int
        Masses that are felt in the full scene, and masses of the reduced one.
    band : (float, float)
        [Hz]
    tolerance : float
    frequency : array, shape (P,)
        [Hz], over the band and finest at resonances; nothing within BESIDE, half a percent, of those of ``poles``.
    impedance, full_impedance : complex array, shape (P,)
        At the handle, F/v [N s/m].
    error : array, shape (P,)
        ``|Z_reduced - Z| / |Z + Z_hand + Z_paddle|``: the part by which the motion of handle and hand changes.
    within : bool
        Whether the largest error is below the tolerance, and every pole within BESIDE of where it was.
    poles : tuple of (float, float)
        Frequencies without damping [Hz], at which the full impedance is infinite, each with the one nearest to it of the
        reduced scene; no error is defined between the two.
    tried : tuple of (int, float)
        Masses and largest error of all that were looked at.
    """

    scene: Scene
    full: Scene
    before: int
    masses: int
    band: tuple[float, float]
    tolerance: float
    frequency: Array = field(repr=False)
    impedance: NDArray[np.complex128] = field(repr=False)
    full_impedance: NDArray[np.complex128] = field(repr=False)
    error: Array = field(repr=False)
    tried: tuple[tuple[int, float], ...] = ()
    poles: tuple[tuple[float, float], ...] = ()

    @property
    def largest(self) -> float:
        """The largest error over the band."""
        return float(self.error.max())

    @property
    def within(self) -> bool:
        """Whether the largest error is within the tolerance, and every pole near its place."""
        return self.largest <= self.tolerance and self.shift <= BESIDE

    @property
    def shift(self) -> float:
        """How far a pole has moved, the largest part of its frequency."""
        return max((abs(now / before - 1) for before, now in self.poles), default=0.0)

    def below(self, frequency: float) -> float:
        """Return the largest error up to a frequency [Hz]."""
        return float(self.error[self.frequency <= frequency * (1 + 1e-12)].max())

    def instructions(self, T: float = 1e-3) -> tuple[int, int]:
        """Return the instructions a tick of (the full, the reduced) scene, each compiled with its parameters fixed."""
        full, reduced = (len(compile(scene, T=T, live=())) for scene in (self.full, self.scene))
        return full, reduced

    def device_damping(self, T: float = 1e-3) -> tuple[float, float]:
        """Return the damping b [N s/m] that a device needs for (the full, the reduced) scene, each compiled.

        See :func:`~hapticlab.limits.port.port_damping`; ``inf`` without damping of the scene's own.
        """
        full, reduced = (port_damping(Device(T=T), scene, method="exact") for scene in (self.full, self.scene))
        return full, reduced

    def plot(self) -> Figure:
        """Draw both impedances and the error over the band; return a figure."""
        return plot_reduction(self)

    def __str__(self) -> str:
        before, after = self.instructions()
        needed = "{:.4g} N s/m, of the reduced one {:.4g}".format(*self.device_damping())
        high = self.band[1]
        lines = [
            f"{self.full.name}: {self.before} masses replaced by {self.masses}, {before} instructions by {after}",
            *(f"  {p.name:<6} {self.scene.values[p.name]:.6g} {p.unit}" for p in self.scene.parameters.values()),
            "  up to [Hz]  |Z_r - Z|/|Z + hand + paddle|",
            *(f"  {f:>10.4g}  {self.below(f):.2g}" for f in (high / 8, high / 4, high / 2, high) if f > self.band[0]),
            *map(_shifted, self.poles),
            f"  device damping needed for the full scene {needed} (T = 1 ms)",
            f"  {'within' if self.within else 'outside'} the tolerance of {self.tolerance:.3g} over {self.band[0]:g} to "
            f"{high:g} Hz",
        ]
        return "\n".join(lines)


def reduction(
    scene: Scene,
    paddle: AnyDevice,
    *,
    band: tuple[float, float] = (0.1, 20.0),
    masses: int | None = None,
    tolerance: float = TOLERANCE,
    accept: bool = False,
) -> Reduction:
    """Offer a scene of fewer masses whose impedance at the handle is the same within a tolerance over a band.

    Second-order and structure-preserving: the reduced scene has masses, springs and dampers whose energies are those of
    the full one seen through fewer motions, so it is passive where that is
    (moment matching, in ``hapticlab/analysis/impedance/moment_matching.py``).

    Parameters
    ----------
    scene : Scene
        Linear, passive, of masses, springs and dampers that the handle moves; every parameter bound.
    paddle : SimulatedPaddle or Device
        Its m, b and hand are read. In parallel with the scene; what part of the impedance is the scene's they decide.
    band : (float, float)
        Lowest and highest frequency [Hz], 0 < low < high.
    masses : int, optional
        Of the reduced scene; by default the fewest that are within the tolerance.
    tolerance : float
        Largest ``|Z_reduced - Z| / |Z + Z_hand + Z_paddle|``.
    accept : bool
        Take ``masses`` though they are past the tolerance.

    Returns
    -------
    Reduction

    Raises
    ------
    AnalysisError
        The scene is not linear, not passive or has no masses to spare; nothing is within the tolerance.

    Examples
    --------
    >>> import hapticlab as hl
    >>> import sympy as sp
    >>> y, z = hl.coordinate("y", unit="m"), hl.coordinate("z", unit="m")
    >>> k, m = hl.parameters("k m", units="N/m kg", values=(2000, 0.02))
    >>> F, between = k * (hl.x(hl.t) - y), k * (y - z)
    >>> eom = [sp.Eq(m * y.diff(hl.t, 2), F - between), sp.Eq(m * z.diff(hl.t, 2), between)]
    >>> paddle = hl.Device(m=0.05, b=0.1)
    >>> offer = reduction(hl.Scene(force=F, eom=eom), paddle, band=(0.1, 10), tolerance=0.01)
    >>> offer.masses, {name: round(value, 6) for name, value in offer.scene.values.items()}
    (1, {'k_1': 1600.0, 'm_1': 0.04})
    """
    m, b, hand = known(paddle, "m", "b", "hand")
    paddle = Device(m=m, b=b, hand=hand)
    low, high = _band(band)
    tolerance = number("tolerance", tolerance, above=0, what="a part", why="take 0.05")
    network = network_of(scene, port_of(scene, linear=True))
    N = len(network.mass)
    wanted = _wanted(scene, masses, N)
    offers = []
    for count in wanted:
        offers.append(_best(scene, network, paddle, (low, high), tolerance, count))
        if offers[-1].within:
            break
    tried = tuple((offer.masses, offer.largest) for offer in offers)
    best = offers[-1]
    if best.within or (accept and masses is not None):
        return Reduction(**{**vars(best), "tried": tried})
    shown = ", ".join(f"{error:.2g} with {count} mass{'es' * (count > 1)}" for count, error in tried)
    which = "takes it" if masses is not None else f"with masses={best.masses} uses that"
    cure = f"accept=True {which} in any case"
    moved = [_shifted(pair).strip() + ". " for pair in best.poles if best.shift > BESIDE]
    raise AnalysisError(
        f"{''.join(moved)}{scene.name}: outside the tolerance of {tolerance:g} over {low:g} to {high:g} Hz: {shown}. Give a "
        f"narrower band, or {cure}"
    )


def _best(scene, network, paddle, band, tolerance, count):
    """Return the offer of ``count`` masses that is nearest over the band."""
    unit = network.of_unit_masses
    poles = infinite(network, lambda f: _of_paddle(paddle, f), band)
    common = frequencies(network, paddle, band, poles)
    rate = 2 * np.pi * np.sqrt(band[0] * band[1])  # time in which the band is of order one
    best = None
    for stiffness, damping, V in candidates(unit.stiffness / rate**2, unit.damping / rate, count):
        reduced = modal(stiffness * rate**2, damping * rate, np.einsum("ji,abj->abi", V, unit.start))
        own = around(held(reduced)[0], band)
        found = _Compared(network, reduced, paddle, np.union1d(common, own[outside(own, poles)]))
        if best is None or found.error.max() < best.error.max():
            best = found
    if best is None:
        raise AnalysisError(f"{scene.name}: the motion of the handle shows fewer than {count} separate masses; give fewer")
    best = best.at(refined(best.frequency, lambda f: best.at(f).error, poles))
    resonances = held(best.reduced)[0].imag / (2 * np.pi)
    pairs = tuple((float(f), float(min(resonances, key=lambda r: abs(r - f), default=np.inf))) for f in poles)
    name = f"{scene.name} with {count} mass{'es' * (count > 1)}"
    return Reduction(
        scene_of(best.reduced, name), scene, len(network.mass), count, band, tolerance, best.frequency, best.Z_reduced,
        best.Z, best.error, poles=pairs,
    )  # fmt: skip


class _Compared:
    """Two networks and their impedances at frequencies [Hz]."""

    def __init__(self, network, reduced, paddle, frequency):
        self.network, self.reduced, self.paddle, self.frequency = network, reduced, paddle, frequency
        self.Z, self.Z_reduced = network.impedance(frequency), reduced.impedance(frequency)
        self.error = np.abs(self.Z_reduced - self.Z) / np.abs(self.Z + _of_paddle(paddle, frequency))

    def at(self, frequency):
        return _Compared(self.network, self.reduced, self.paddle, frequency)


def _shifted(pair):
    """Say where an impedance is infinite, and where that of the reduced scene is."""
    before, now = pair
    return (
        f"  undamped: its impedance is infinite at {before:.5g} Hz, that of the reduced scene at {now:.5g} Hz "
        f"({abs(now / before - 1):.2g} of it away); nothing within {BESIDE:g} of it is compared"
    )


def _of_paddle(paddle, frequency):
    """Return the impedance of handle and hand [N s/m]."""
    hand, s = getattr(paddle, "hand", None), 2j * np.pi * frequency
    Z = paddle.m * s + paddle.b
    return Z if hand is None else Z + hand.m * s + hand.b + hand.k / s


def _band(band):
    try:
        low, high = map(float, band)
    except (TypeError, ValueError):
        raise AnalysisError(f"band = {band!r}; needs (low, high) in Hz, such as (0.1, 20)") from None
    if not 0 < low < high < np.inf:
        raise AnalysisError(f"band = {band!r} Hz; needs 0 < low < high")
    return low, high


def _wanted(scene, masses, N):
    if masses is None:
        if N < 2:
            raise AnalysisError(f"{scene.name} has {N} mass, so no mass can be left out")
        return range(1, N)
    if isinstance(masses, bool) or not (isinstance(masses, int) and 0 < masses < N):
        raise AnalysisError(f"masses = {masses!r}; {scene.name} has {N} masses; a reduction needs at least 1 and fewer than {N}")
    return [masses]
