"""The closed motion along which a scene gives a hand the most energy: switches and memory included; searched, not proved."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from ...base.arguments import choice, count, instance, number
from ...base.facts import in_words
from ...base.shows_itself import ShowsItself
from ...compiler.tick.compile_scene import compile
from ...device.device import known
from ...device.hand.hand import Hand
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError, UnusualValueWarning
from ...scene.notation.symbols import n, parameters, signal, when
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .closed_motions import ClosedMotions
from .condition_switches import switched
from .limit_plots import plot_worst_motion
from .motion_search import LENGTHS, MOST, MotionSearch
from .operating_points import TRAVEL, borders, operating_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from ...base.annotations import Array, Number
    from ...base.telemetry import Telemetry
    from ...compiler.ir.program import Program
    from ...device.device import AnyDevice

#: the smallest motion by which needed damping is judged, as a part of the reach
SMALLEST = 1e-2
#: places about which motions are searched, at most, unless they are given
PLACES = 4
#: a longer motion has to be better by this part, and a steeper place than those where the force switches
BETTER, STEEPER = 1e-3, 0.1
#: of hl.compile, what a search takes
OPTIONS = ("method", "substeps", "hold", "force_at")
#: instructions of one call of a search, and of all; some 20 s
CALL, WORK = 5e8, 2e10
#: samples that are printed
SHOWN = 16
#: a hand that moves the handle as it is told answers within this part of a period
STIFF = 0.01


@dataclass(frozen=True, eq=False)
class WorstMotion(ShowsItself):
    """A closed motion of the handle, the energy that it draws from a scene, and what was searched to find it.

    Attributes
    ----------
    scene : str
    positions : array of shape (P,)
        Of the handle [m], at one sample after another; with a delay of a fraction of a period, each followed by the position at
        which the force changes. The last leads back to the first. Between them the velocity is constant.
    held : array of shape (P,)
        Force on the environment [N] from each position to the next.
    durations : array of shape (P,)
        From each position to the next [s].
    drawn : float
        Work of the scene on the handle in a cycle [J].
    viscous : float
        Energy that a damper of 1 N s/m dissipates in a cycle [J].
    friction : float
        Energy that the device's Coulomb friction dissipates in a cycle [J].
    b_req : float
        Damping [N s/m] below which some motion that was tried draws energy from the device.
    b_device : float or None
        Of the device [N s/m].
    searched : str
        Which motions were tried.
    program : Program
        What was moved.
    """

    scene: str
    positions: Array
    held: Array
    durations: Array
    drawn: float
    viscous: float
    friction: float
    b_req: float
    b_device: float | None
    searched: str
    program: Program = field(repr=False)

    @property
    def period(self) -> float:
        """Duration of a cycle [s]."""
        return float(self.durations.sum())

    @property
    def x(self) -> Array:
        """Positions at the samples [m]."""
        return self.positions[:: round(len(self.positions) * self.program.T / self.period)]

    @property
    def dissipated(self) -> float | None:
        """Energy that the device dissipates in a cycle at the least [J]; None where its damping is not known."""
        return None if self.b_device is None else self.b_device * self.viscous + self.friction

    @property
    def energy(self) -> float | None:
        """Energy that the hand gains in a cycle [J]: drawn - dissipated; not positive where no such motion was found."""
        return None if self.dissipated is None else self.drawn - self.dissipated

    @property
    def found(self) -> bool | None:
        """Whether a motion was found that draws more than the device dissipates; None where its damping is not known.

        True proves that the device is not passive with this scene; False proves nothing.
        """
        return None if self.energy is None else self.energy > 0

    def path(self, t: Array | float) -> Array:
        """Return the positions [m] at times [s], cycle after cycle: an intent for a hand."""
        corners = np.r_[0.0, np.cumsum(self.durations)]
        return np.interp(np.asarray(t, float) % self.period, corners, np.r_[self.positions, self.positions[0]])

    def run(self, paddle: SimulatedPaddle, cycles: int = 20) -> Telemetry:
        """Run the motion on a simulated paddle, held by a hand that moves the handle along it, however the motor pulls.

        Parameters
        ----------
        paddle : SimulatedPaddle
            Its T is that of the search; its hand is replaced.
        cycles : int

        Raises
        ------
        AnalysisError
            The force changes between samples, where a hand's path has no corner.
        """
        instance("paddle", paddle, SimulatedPaddle, "an hl.SimulatedPaddle(...)", error=AnalysisError)
        if len(self.x) < len(self.positions):
            raise AnalysisError(
                "the delay has a fraction of a period, so the worst motion reverses between samples, where the force "
                "changes, but a simulated hand reverses at samples. Search with a delay of whole periods."
            )
        k = paddle.m / (STIFF * paddle.T) ** 2
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnusualValueWarning)  # no person is as stiff
            hand = Hand(k=k, b=2 * np.sqrt(k * paddle.m), intent=self.path)
            ticks = count("cycles", cycles, "a run") * len(self.x) + 1
            return replace(paddle, hand=hand).run(self.program, ticks * paddle.T, x=self.x[0])

    def vibration(self) -> Scene:
        """Return a scene that repeats the forces of the motion wherever the handle is, to feel them on a board.

        Its parameter F_peak [N] is the largest of them, to be lowered for a gentle start.

        Examples
        --------
        >>> import hapticlab as hl
        >>> found = hl.passivity.worst_motion(hl.Device(b=0.2, T="1 ms"), hl.wall()(k=500), samples=2)
        >>> log = hl.SimulatedPaddle(m=0.05, b=0.2, T="1 ms").run(found.vibration()(F_peak=0.2), duration=0.004)
        >>> log.F.round(3).tolist()
        [0.0, 0.2, 0.0, 0.2]
        """
        held = self.held[round(len(self.held) / len(self.x)) - 1 :: round(len(self.held) / len(self.x))]
        peak = float(np.abs(held).max())
        F_peak = parameters("F_peak", units="N", values=peak, ranges=(0.0, np.inf))
        step, last = signal("step", unit="1", initial=len(held) - 1), len(held) - 1
        force = float(held[-1]) / peak
        for k in range(last - 1, -1, -1):
            force = when(step(n) < k + 0.5, float(held[k]) / peak, force)
        counted = sp.Eq(step(n), when(step(n - 1) < last - 0.5, step(n - 1) + 1, 0))
        return Scene(force=F_peak * force, eom=[counted], name=f"forces of the worst motion of {self.scene}")

    _hidden = ("program",)

    def __str__(self) -> str:
        each = f"{' '.join(in_words(self.drawn, 'J'))} per cycle of {1e3 * self.period:g} ms"
        head = f"{self.scene}, T = {1e3 * self.program.T:g} ms: "
        lost = "" if self.dissipated is None else f", and the device dissipates {' '.join(in_words(self.dissipated, 'J'))}"
        head += {
            None: "the worst motion found",
            True: "not passive. The worst motion found",
            False: "no motion was found that draws energy from the device. The nearest",
        }[self.found]
        has = "" if self.b_device is None else f"; the device has {self.b_device:.4g} N s/m"
        return "\n".join([
            f"{head} draws {each}{lost}",
            "  x at the samples [mm]: " + ", ".join(f"{1e3 * x:.4g}" for x in self.x[:SHOWN]) + ", ..." * (len(self.x) > SHOWN),
            f"  motions were found that draw energy from a device of less than b = {self.b_req:.4g} N s/m{has}",
            f"  searched: {self.searched}. A search cannot prove passivity.",
        ])  # fmt: skip

    def plot(self) -> Figure:
        """Draw the motion and the energy that it draws, over two cycles."""
        return plot_worst_motion(self)


def worst_motion(
    device: AnyDevice,
    scene: Scene,
    *,
    reach: Number = 1e-3,
    samples: int = 32,
    about: Number | Sequence[Number] | None = None,
    seed: int = 0,
    **options: Any,
) -> WorstMotion:
    """Search the closed motion of the handle that draws the most energy from a scene, per period of sampling.

    The hand may move the handle in any way, so a motion is its positions at N samples, again and again. In the period
    after sample n the scene gives the hand -F (x(n+1) - x(n)), and the device dissipates b (x(n+1) - x(n))^2/T + f_c
    ``|x(n+1) - x(n)|`` at the least, with a constant velocity; its mass stores and returns. Colgate and Schenkel's
    criterion is that no such motion draws energy, which is the same here for scenes that switch or are not linear. The
    compiled program runs over each motion until its force repeats itself; bodies begin in the states to which the
    motion leads them back. Positions are exact, velocities their backward differences, and the motor does not saturate.

    All coarse motions of few samples are tried, longer ones are made from the best, and stretches of the best are shifted until
    nothing is gained. The search ends early, with shorter motions, where a scene takes many instructions.

    Parameters
    ----------
    device : Device or paddle
        Its T, delay and coulomb are read, and its b where it is known.
    scene : Scene
        Every parameter bound.
    reach : float or text
        Farthest distance from the place about which a motion is [m], > 0.
    samples : int
        Longest cycle, 2 to 64 samples.
    about : float, text or sequence of them, optional
        Places [m] about which motions are searched. By default where the force switches, and where it is steepest within
        50 mm; at most four.
    seed : int
        Of the coarse motions that are drawn.
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold, force_at.

    Returns
    -------
    WorstMotion
        Of most power where one draws energy; else the one that needs the most damping.

    Raises
    ------
    AnalysisError
        No motion has a force that repeats itself.

    Examples
    --------
    >>> import hapticlab as hl
    >>> found = worst_motion(hl.Device(b=0.2, T="1 ms"), hl.wall()(k=500), samples=2)
    >>> found.found, round(found.b_req, 9)               # k T/2, Eq. (23.10)
    (True, 0.25)
    >>> (1e6 * np.array([found.drawn, found.dissipated])).round(1).tolist()
    [499.9, 399.9]
    """
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "needs hl.passivity.worst_motion(paddle, hl.Scene(force=...))"))
    T, delay, coulomb, b = known(device, "T", "delay", "coulomb", or_none="b")
    reach = number("reach", reach, "m", "a motion", above=0)
    samples = count("samples", samples, "a motion", least=2, most=LENGTHS[-1])
    seed = count("seed", seed, "a search", least=0)
    for name in options:
        choice("option", name, OPTIONS)
    program = compile(scene, T=T, dtype="float64", live=(), **options)
    gains = _Gains(ClosedMotions(program, delay), coulomb, b, SMALLEST * reach)
    surfaces = _surfaces(scene, T)
    places = _places(gains, surfaces, reach) if about is None else [number("about", x, "m", "a motion") for x in np.ravel(about)]
    if not places:
        raise AnalysisError(
            f"about = {about!r}; a search needs at least one position, such as about=0. Leave out about= to "
            "use the rest positions that are found"
        )
    most, share = int(np.clip(CALL / gains.motions.work, 100, MOST)), WORK / (2 * len(places))
    needing, powerful, tried = [], [], 0
    for place in places:
        near = [s for s in surfaces if abs(s - place) < reach]
        search = MotionSearch(gains.damping, place, reach, near, len(gains.motions.durations), seed, most)
        some = gains.within(share, search.best_of(samples))
        needing += [gains.enlarged(x, place, reach) for x in some]
        if b is not None:
            search.score = gains.power
            powerful += gains.within(share, search.best_of(samples, some))
        tried += search.tried
    x, b_req = _shortest(needing, gains.damping)
    if not np.isfinite(b_req):
        raise AnalysisError(
            f"{scene.name}: of {tried} closed motions none had a force that repeats from cycle to cycle. Search about a "
            "position where the scene is at rest, about=..., or within a smaller reach."
        )
    if b is not None and b_req > b:
        x, _ = _shortest(powerful, gains.power)
    books = gains.motions.books(x[:, None])
    at = ", ".join(f"{1e3 * place:.4g}" for place in places)
    longest = max(len(x) for x in needing) // len(gains.motions.durations)
    searched = f"{tried} closed motions of 2 to {longest} samples within {1e3 * reach:g} mm of x = {at} mm, seed {seed}"
    if gains.motions.adrift:
        searched += f"; {gains.motions.adrift} motions are left out because their force does not repeat from cycle to cycle"
    return WorstMotion(
        scene.name, x, books.held[:, 0], np.resize(gains.motions.durations, len(x)), float(books.drawn[0]),
        float(books.viscous[0]), coulomb * float(books.path[0]), b_req, b, searched, program,
    )  # fmt: skip


@dataclass(frozen=True)
class _Gains:
    """What is sought of closed motions on a device."""

    motions: ClosedMotions
    coulomb: float
    b: float | None
    smallest: float

    def damping(self, x):
        """Return the damping [N s/m] below which each motion draws energy."""
        books = self.motions.books(x)
        with np.errstate(all="ignore"):
            needed = (books.drawn - self.coulomb * books.path) / books.viscous
        return np.where(books.repeats & (np.ptp(x, axis=0) >= self.smallest), needed, -np.inf)

    def power(self, x):
        """Return the energy that the hand gains per position [J], of motions of as many parts of a period."""
        books = self.motions.books(x)
        gained = books.drawn - self.coulomb * books.path - self.b * books.viscous
        return np.where(books.repeats, gained / len(x), -np.inf)

    def within(self, share, search):
        """Return the motions of a search, which ends after so many instructions, however long its motions are by then."""
        end, found = self.motions.spent + share, []
        for x in search:
            found.append(x)
            if self.motions.spent > end:
                break
        return found

    def enlarged(self, x, about, reach):
        """Return a motion that fills the reach, where that needs no less damping."""
        larger = about + (x - about) * reach / np.abs(x - about).max()
        before, after = self.damping(np.stack([x, larger], axis=1))
        return larger if after >= before * (1 - 1e-6) else x


def _shortest(found, score):
    """Return (motion, score): the shortest of those that are as good as the best."""
    found = sorted(found, key=len)
    scores = [float(score(x[:, None])[0]) for x in found]
    most = max(scores)
    return next((x, most) for x, one in zip(found, scores, strict=True) if not one < most - BETTER * abs(most))


def _surfaces(scene, T):
    """Return the positions of the handle [m] at which the scene switches."""
    cases = switched(scene)
    points = operating_points(cases, None, T, TRAVEL)
    return sorted({pair[0].values["x"] for pair, _ in borders(cases, points, T)})


def _places(gains, surfaces, reach):
    """Return where to search: at surfaces, each within reach of one place alone, and where the force is much steeper."""
    places = []
    for surface in sorted(surfaces, key=abs) or [0.0]:
        if all(abs(surface - place) >= reach for place in places):
            places.append(surface)
    along = np.linspace(-TRAVEL, TRAVEL, 401)
    steep = gains.damping(np.stack([along - reach / 2, along + reach / 2]))
    near = np.abs(along[:, None] - places).min(axis=1) <= max(reach, along[1] - along[0])
    if steep.max() > (1 + STEEPER) * max(0.0, steep[near].max()):
        places.insert(0, along[steep.argmax()])
    return places[:PLACES]
