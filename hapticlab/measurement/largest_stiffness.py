"""The largest stiffness that does not chatter, searched on the paddle itself: the same call in simulation and on a board."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ..base.arguments import number
from ..device.live_parameters import named_values
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError, PaddleError
from ..limits.limit import Limit, whole_and_fraction
from ..limits.passivity import passivity_limit
from ..limits.stability import stability_limit
from ..scene.laws.taps import TAPS
from ..scene.notation.symbols import parameters
from ..scene.scene import Scene
from .guard import guarded
from .search import Judgement, Search
from .search_plot import plot_search
from .search_start import durations_of, first_of, hopeless, pushes_of
from .trials import Trial, speed_limit, try_wall, wall_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..device.board.serial_paddle import SerialPaddle
    from ..scene.laws.taps import LawName

#: parts of the first stiffness tried before none is said to stand
SOFTER = 1e-2
SEARCH, JUDGEMENT = Search(), Judgement()


@dataclass(frozen=True, eq=False)
class LargestStiffness:
    """Outcome of a search, with every trial it made; ``float(found)`` is the stiffness [N/m].

    Attributes
    ----------
    K : float
        The largest stiffness that stood [N/m]; 0 where all chattered, nan where the trials could not tell.
    chatters_at : float
        The smallest that chattered or could not be told [N/m]; inf where all stood.
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

    K: float
    chatters_at: float
    trials: tuple[Trial, ...]
    law: str
    B: float = 0.0
    theory: dict[str, Limit] = field(default_factory=dict)
    about: str = ""

    def __float__(self) -> float:
        return self.K

    def plot(self) -> Figure:
        """Draw every trial in the order it was made, with the limits of theory."""
        return plot_search(self)

    def __str__(self) -> str:
        end = {t.K: t.stands for t in self.trials}.get(self.chatters_at)
        if not self.trials:
            head = f"{self.law}: no trial was made, as no stiffness helps: {self.theory['stability'].reason}"
        elif math.isnan(self.K):
            head = f"{self.law}: undecided, no stiffness from {self.chatters_at:.3g} N/m on stood, and not all were told"
        elif self.K == 0:
            head = f"{self.law}: no stiffness stood, down to {self.chatters_at:.3g} N/m"
        elif math.isinf(self.chatters_at):
            head = f"{self.law}: {self.K:.5g} N/m stood, and no more was asked for"
        else:
            head = f"{self.law}: {self.K:.5g} N/m stands, {self.chatters_at:.5g} N/m "
            head += "is undecided" if end is None else "chatters"
        rows = [f"  {name:<10} {limit.K:.5g} N/m: {limit.kind}" for name, limit in self.theory.items()]
        return "\n".join([head, f"  simulated outcome of one start, {self.about}", *rows, *(f"  {t}" for t in self.trials)])

    def __repr__(self) -> str:
        return f"LargestStiffness(K={self.K:.6g} N/m, chatters_at={self.chatters_at:.6g} N/m, {len(self.trials)} trials)"


def largest_stiffness(
    paddle: SimulatedPaddle | SerialPaddle,
    law: LawName | Scene = "zoh",
    *,
    B: float = 0.0,
    parameter: str = "k",
    push: float | None = None,
    place: float = 0.0,
    search: Search = SEARCH,
    judged: Judgement = JUDGEMENT,
) -> LargestStiffness:
    """Search the largest stiffness of a wall that comes to rest under a push: trials on the paddle, from soft to stiff.

    Every trial lets the handle fall from rest at the wall's boundary under a constant push, and looks whether the
    oscillation dies out (:func:`hapticlab.chatter`). The stiffness grows by a ratio until a wall chatters; then the ratio
    is halved, from the last that stood, until it is within ``tolerance``. No trial goes further than one ratio beyond what
    stood. Where not even the first stands, softer ones are tried, down to a hundredth; the motor's push falls with them.
    A guard in the scene cuts the motor at the sample at which the wall has given too much energy or the handle is too fast,
    and between trials it is off.

    A trial lasts ten periods of handle and hand on the wall's spring at least, of 50 g where a board does not say its
    mass. What follows a simulated hand's moving intent is no chatter (``driven`` of :func:`hapticlab.chatter`). A trial
    that cannot tell is undecided, and bounds the answer as a chatter does; where none stood the answer is then nan, not 0.

    Within six standard deviations of the sensor's noise a handle is at rest: a smaller chatter is not seen. A board shows
    that noise in the softer walls, where the handle rests and nothing but white scatter is left.

    What is found is an outcome: this handle, this hand, this start. A passive hand that grips otherwise may chatter
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
    push : float, optional
        Constant force of the motor into the wall [N]. By default 0.2 N, at most a quarter of what the paddle's force limit
        leaves the wall, and none where a simulated hand pushes or leans. Friction above it hides what the wall does.
    place : float
        Of the wall's boundary [m].
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
    >>> abs(float(found) / hl.stability_limit(paddle).K - 1) < 0.03
    True
    """
    B, push = number("B", B, "N s/m"), None if push is None else number("push", push, "N")
    scene = wall_of(law, parameter)
    name = law if isinstance(law, str) else scene.name
    durations = durations_of(paddle, judged.duration, judged.longest)
    push, leaning = pushes_of(paddle, push, place, durations(search.most)[1])
    first = first_of(paddle, push + leaning, judged.longest) if search.first is None else search.first
    if first >= search.most:
        raise AnalysisError(f"first = {first:g} N/m, most = {search.most:g} N/m; needs 0 < first < most")
    known = {name: value for name, value in {"B": B, "x_o": place}.items() if name in scene.parameters and (B or name != "B")}
    if B and "B" not in scene.parameters:
        raise PaddleError(f"{scene.name} has no parameter B; leave B out, or give the scene one")
    theory = theory_of(paddle, law, B)
    if B and hopeless(paddle, theory):  # on a board every trial would only throw the handle
        return LargestStiffness(0.0, 0.0, (), name, B, theory, "no trial made")
    pressed = _pressed(scene(**known, **{parameter: first}), push)
    periods = whole_and_fraction(getattr(paddle, "delay", 0.0), paddle.T)[0]
    limits = {"energy_max": judged.energy_max, "speed_max": speed_limit(paddle, judged.speed_max), "periods": periods}
    program = paddle.program(guarded(pressed, **limits))  # compiled once: only a parameter's value changes

    noise = getattr(paddle, "noise", 0.0)

    def trial(K, seconds):
        nonlocal noise
        values = named_values(program) | {parameter: K}
        if push:  # softer than the first, it would sink in ever deeper
            values["pressed"] = push * min(1.0, K / first)
        tried = replace(program, values=tuple(values.values()))
        options = {"duration": seconds, "longest": durations(K)[1], "buzz_max": judged.buzz_max, "noise": noise}
        made = try_wall(paddle, tried, K=K, place=place, **options)
        noise = max(noise, made.scatter)  # a board shows its sensor's noise where it rests
        return made

    trials, good, bad = searched(trial, first, search, durations)
    about = f"pressed with {push + leaning:.3g} N from rest at its boundary"
    about += "" if isinstance(paddle, SimulatedPaddle) else "; theory below is without a hand"
    return LargestStiffness(good, bad, trials, name, B, theory, about)


def searched(trial, first, asked, durations):
    """(trials, largest that stood, smallest that did not), from below, never further than one ratio beyond.

    A trial is as short as tells; the one that is the answer is repeated at full length. Where that finds a chatter which
    a short one did not see, the search goes on below it, at full length only. ``durations(K)`` gives both lengths [s].
    Where none stood, the answer is 0 if every trial says so, and nan if one could not tell.
    """
    K, stood, sure, bad, made, short = first, [], set(), math.inf, [], True
    while True:
        made.append(trial(K, durations(K)[0 if short else 1]))
        if made[-1].stands:
            stood.append(K)
            sure |= {K} if made[-1].duration >= 0.999 * durations(K)[1] else set()
        else:
            bad = K
        while stood and (stood[-1] >= asked.most or bad / stood[-1] <= 1 + asked.tolerance):
            if stood[-1] in sure:
                return tuple(made), stood[-1], bad
            made.append(trial(stood[-1], durations(stood[-1])[1]))
            if made[-1].stands:
                return tuple(made), stood[-1], bad
            bad, short = stood.pop(), False
        if not stood and bad <= first * SOFTER * 1.001:
            return tuple(made), math.nan if any(t.stands is None for t in made) else 0.0, bad
        if not stood:
            K = bad / 10
        else:
            K = min(stood[-1] * (math.sqrt(bad / stood[-1]) if math.isfinite(bad) else asked.growth), asked.most)


def _pressed(scene, push):
    """The scene with the motor's push beside it."""
    if not push:
        return scene
    force = parameters("pressed", units="N", values=push, ranges=(-math.inf, math.inf))
    return replace(scene, force=scene.force - force)


def theory_of(paddle, law, B):
    """The limits of theory, where they are known: a law with a name, a handle with constants."""
    device = getattr(paddle, "device", paddle)
    if isinstance(law, Scene) or law not in TAPS or device.m is None:
        return {}
    exact = paddle.velocity == "measured"
    named = law if law != "half_sample" or exact else "backward_difference"  # the estimate makes it Eq. (23.5)
    passive = passivity_limit(device, B=B, law=named)
    return {"passivity": passive, "stability": stability_limit(device, law=law, B=B)}
