"""The largest stiffness that comes to rest and does not buzz: the same search in simulation and on a board."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

from ..base.arguments import having, instance, number
from ..base.shows_itself import ShowsItself
from ..device.device import total_delay
from ..device.live_parameters import named_values
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError, PaddleError
from ..limits.limit import Limit, whole_and_fraction
from ..limits.passivity import passivity_limit
from ..limits.stability import stability_limit
from ..scene.laws.taps import TAPS
from ..scene.notation.symbols import parameters
from ..scene.scene import Scene
from .borders import NOWHERE, Border, borders
from .guard import guarded
from .search import Judgement, Search, Starts
from .search_plot import plot_search
from .search_start import durations_of, first_of, hopeless, starts_of
from .trials import Trial, speed_limit, try_wall, wall_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..device.board.serial_paddle import SerialPaddle
    from ..scene.laws.taps import LawName

#: what a guard keeps of the energy that a wall has given: it forgets in so many seconds
FORGETS = 0.25
SEARCH, STARTS, JUDGEMENT = Search(), Starts(), Judgement()


@dataclass(frozen=True, eq=False)
class LargestStiffness(ShowsItself):
    """Outcome of a search, with every trial it made; ``float(found)`` is the stiffness [N/m] that both borders allow.

    Attributes
    ----------
    unstable : Border
        Up to which stiffness the swing of the entry dies out, for every start.
    buzz : Border
        Up to which the hand feels no buzz either.
    trials : tuple of Trial
        In the order they were made.
    law : str
    B : float
        Virtual damper of the trials [N s/m].
    theory : dict of str to Limit
        "passivity" and "stability", where the paddle's constants and the law are known.
    about : str
        What was done at every trial.
    """

    unstable: Border
    buzz: Border
    trials: tuple[Trial, ...]
    law: str
    B: float = 0.0
    theory: dict[str, Limit] = field(default_factory=dict)
    about: str = ""

    @property
    def K(self) -> float:
        """The largest stiffness that comes to rest quietly from every start [N/m]; 0 where none does, nan where undecided."""
        return min(self.unstable.lowest, self.buzz.lowest, key=lambda K: (not math.isnan(K), K))

    @property
    def fails_at(self) -> float:
        """The smallest that did not, from one start [N/m]; inf where all did."""
        return min(*self.unstable.fails_at, *self.buzz.fails_at)

    def __float__(self) -> float:
        return self.K

    def plot(self) -> Figure:
        """Draw every trial in the order it was made, with both borders and the limits of theory."""
        return plot_search(self)

    def __str__(self) -> str:
        if not self.trials:
            return f"{self.law}: no trial was made, because no stiffness is stable: {self.theory['stability'].reason}"
        if math.isnan(self.K):
            head = "undecided, because some trials were undecided"
        elif self.K == 0:
            head = f"no stiffness comes to rest quietly, down to {self.fails_at:.3g} N/m"
        else:
            head = f"{self.K:.5g} N/m comes to rest quietly from every start"
        borders = [f"  comes to rest up to {self.unstable}", f"  no buzz felt up to  {self.buzz}"]
        rows = [f"  {name:<10} {limit.K:.5g} N/m: {limit.kind}" for name, limit in self.theory.items()]
        undecided = sum(t.outcome == "undecided" for t in self.trials)
        made = f"  simulated outcome, {self.about}; {len(self.trials)} trials, {undecided} undecided, which .plot() draws"
        return "\n".join([f"{self.law}: {head}", *borders, made, *rows])

    def __repr__(self) -> str:
        borders = f"unstable={self.unstable!r}, buzz={self.buzz!r}"
        return f"LargestStiffness(K={self.K:.6g} N/m, {borders}, {len(self.trials)} trials)"


def largest_stiffness(
    paddle: SimulatedPaddle | SerialPaddle,
    law: LawName | Scene = "zoh",
    *,
    B: float = 0.0,
    parameter: str = "k",
    place: float = 0.0,
    starts: Starts = STARTS,
    search: Search = SEARCH,
    judged: Judgement = JUDGEMENT,
) -> LargestStiffness:
    """Search for two stiffness limits by trials on the paddle: where a wall no longer comes to rest, and where it buzzes.

    A trial lets the handle go before the wall, at its boundary or in it, under a constant push, and asks two questions.
    Does the swing of the entry die out (:func:`hapticlab.chatter`), down to what the encoder's own counts make of it?
    And does the hand feel a buzz then: is the amplitude of the motor's force, without its mean, its drift and the
    swing, above ``buzz_max``? Both borders are searched from each of several
    :class:`~hapticlab.measurement.search.Starts`, and each is an interval over those.

    From each start the stiffness grows by a ratio until a wall fails; then the ratio is halved, from the last that
    passed, until it is within ``tolerance``. No trial goes further than one ratio beyond what came to rest; the next
    start begins one ratio below that. Where not even the first passes, softer walls are tried, down to a hundredth; the
    motor's push falls with them. A guard in the scene cuts the motor at the sample at which the wall has given too much
    energy in a quarter of a second or the handle is too fast, and between trials it is off.

    A trial lasts ten periods of handle and hand on the wall's spring at least, of 50 g where a board does not say its
    mass, and is repeated, twice as long, while its record does not tell: up to 16 times as long. What follows a
    simulated hand's moving intent is no chatter, and is taken off the ripple, as well as a record of that length tells
    it. A trial that cannot tell is undecided, and bounds the answer as a failure does; where none passed the answer is
    then nan, not 0.

    Within six standard deviations of the sensor's noise a handle is at rest: a smaller chatter is not seen. A board
    shows that noise from sample to sample in the softer walls.

    What is found is an outcome: this handle, these hands, these starts. A passive hand that grips otherwise may chatter
    sooner (:func:`hapticlab.passivity_limit`).

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
        On a board the handle is led back to the boundary before each trial, softly, by the motor.
    law : str or Scene
        A law of :func:`hapticlab.wall` ("gate", no clamp), or a scene with the parameter.
    B : float
        Virtual damper [N s/m] of either sign; of a scene that has a parameter B.
    parameter : str
        What is searched in a scene of one's own.
    place : float
        Of the wall's boundary [m].
    starts : Starts
        Where the handle is let go: ``hl.measure.Starts(run_ups=, pushes=, within_count=, hands=)``.
    search : Search
        Which walls are tried: ``hl.measure.Search(first=, most=, growth=, tolerance=)``.
    judged : Judgement
        How long a trial lasts and what trips it:
        ``hl.measure.Judgement(energy_max=, speed_max=, buzz_max=, duration=, longest=)``.

    Returns
    -------
    LargestStiffness

    Raises
    ------
    PaddleError, AnalysisError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> found = largest_stiffness(paddle)
    >>> abs(float(found) / hl.stability_limit(paddle).K - 1) < 0.01
    True
    """
    B, place = number("B", B, "N s/m"), number("place", place, "m")
    having(paddle, "a paddle, as hl.SimulatedPaddle.from_profile(...) or hl.connect()", "program", error=PaddleError)
    instance("starts", starts, Starts, "hl.measure.Starts(run_ups=...)")
    instance("search", search, Search, "hl.measure.Search(first=...)")
    instance("judged", judged, Judgement, "hl.measure.Judgement(longest=...)")
    scene = wall_of(law, parameter)
    name = law if isinstance(law, str) else scene.name
    durations = durations_of(paddle, judged.duration, judged.longest)
    every = starts_of(paddle, starts, place, durations(search.most)[2])
    pressing = max(start.push + start.leaning for start in every)
    first = first_of(paddle, pressing, judged.longest) if search.first is None else search.first
    if first >= search.most:
        raise AnalysisError(f"first = {first:g} N/m, most = {search.most:g} N/m; needs 0 < first < most")
    known = {name: value for name, value in {"B": B, "x_o": place}.items() if name in scene.parameters and (B or name != "B")}
    if B and "B" not in scene.parameters:
        raise PaddleError(f"{scene.name} has no parameter B; leave B out, or give the scene one")
    theory = theory_of(paddle, law, B)
    if B and hopeless(paddle, theory):  # on a board every trial would only throw the handle
        return LargestStiffness(NOWHERE, NOWHERE, (), name, B, theory, "no trial made")
    program = _program(paddle, scene(**known, **{parameter: first}), judged)
    made: list[Trial] = []

    @cache
    def trial(start, K, seconds):
        begun = start.at(K, first)
        values = named_values(program) | {parameter: K, "pressed": begun.push}
        noise = getattr(paddle, "noise", None) or min((t.scatter for t in made), default=0.0)  # a board shows it in soft walls
        options = {"duration": seconds, "longest": durations(K)[2], "buzz_max": judged.buzz_max, "noise": noise}
        tried = try_wall(start.paddle, replace(program, values=tuple(values.values())), begun, K=K, place=place, **options)
        made.append(tried)
        return tried

    unstable, buzz = borders(trial, every, first, search, durations)
    about = f"{len(every)} starts, pressed with {pressing:.3g} N"
    about += "" if isinstance(paddle, SimulatedPaddle) else "; theory below is without a hand"
    return LargestStiffness(unstable, buzz, tuple(made), name, B, theory, about)


def _program(paddle, scene, judged):
    """The wall with the motor's push beside it, guarded; compiled once, as only parameters' values change."""
    force = parameters("pressed", units="N", values=0.0, ranges=(-math.inf, math.inf))
    periods = whole_and_fraction(total_delay(paddle), paddle.T)[0]
    limits = {"energy_max": judged.energy_max, "speed_max": speed_limit(paddle, judged.speed_max), "periods": periods}
    return paddle.program(guarded(replace(scene, force=scene.force - force), **limits, keeps=math.exp(-paddle.T / FORGETS)))


def theory_of(paddle, law, B):
    """The limits of theory, where they are known: a law with a name, a handle with constants."""
    device = getattr(paddle, "device", paddle)
    if isinstance(law, Scene) or law not in TAPS or device.m is None:
        return {}
    exact = paddle.velocity == "measured"
    named = law if law != "half_sample" or exact else "backward_difference"  # the estimate makes it Eq. (23.5)
    passive = passivity_limit(device, B=B, law=named)
    return {"passivity": passive, "stability": stability_limit(device, law=law, B=B)}
