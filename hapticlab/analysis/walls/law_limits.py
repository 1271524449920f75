"""How stiff a wall each law can hold against a push, by trials from soft to stiff on a simulated paddle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.arguments import number
from ...base.drawing import COLD, house_style, new_figure, scale_axis
from ...base.shows_itself import ShowsItself, Tabular
from ...device.hand.hand import Hand
from ...errors import AnalysisError, HapticlabError
from ...rendering.wall_laws import LAWS, RENDERING, Rendering, wall_law
from ..records.chatter import SHORTEST, chatter

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from ...device.simulated.simulated_paddle import SimulatedPaddle

#: largest ratio between what stood and what did not, of the last trials
GROWTH, FINEST = 1.5, 1.03
#: where not even the first wall stands: tenths, down to this part of it, each trial longer as it swings slower
SOFTER, SOFTEST = 0.1, 1e-3
#: longest trial, in durations
LONGEST = 32.0


@dataclass(frozen=True)
class LawLimit(ShowsItself):
    """The stiffest wall that stood, and what happened beyond.

    Attributes
    ----------
    law : str
    K : float
        [N/m]; 0 where not even the softest stood, nan where no trial told.
    beyond : float
        The softest that did not stand [N/m]; inf where all did.
    why : str
        What the wall beyond did.
    rest : float
        Stiffness felt at rest under the push over K, at the stiffest that stood; nan where it had not come to rest.
    """

    law: str
    K: float
    beyond: float
    why: str
    rest: float


@dataclass(frozen=True)
class LawLimits(Tabular):
    """The stiffest wall of every law.

    Attributes
    ----------
    limits : tuple of LawLimit
    push : float
        [N]
    duration : float
        Of a trial [s].
    paddle : str
    """

    limits: tuple[LawLimit, ...]
    push: float
    duration: float
    paddle: str

    def __getitem__(self, law: str) -> LawLimit:
        """Return the limit of a law by name."""
        found = {limit.law: limit for limit in self.limits}
        if law not in found:
            raise AnalysisError(f"there is no limit of {law!r}; there are {', '.join(found)}")
        return found[law]

    def __str__(self) -> str:
        head = f"stable walls under a push of {self.push:g} N, simulated from one start: {self.duration:g} s from the boundary"
        rows = [
            f"{m.law:<20} {m.why}" if math.isnan(m.K) else f"{m.law:<20} {m.K:>9.4g} N/m   beyond: {m.why}" for m in self.limits
        ]
        return "\n".join([head, *rows])

    def plot(self) -> Figure:
        """Draw the stiffest wall of each law on one scale."""
        names, places = [m.law.replace("_", " ") for m in self.limits], np.arange(len(self.limits))
        with house_style():
            figure = new_figure(height=0.6 + 0.42 * len(names))
            axes = figure.subplots()
            axes.barh(places, np.nan_to_num([m.K for m in self.limits]), color=COLD, height=0.6)
            stood = [m.K for m in self.limits if m.K > 0]
            axes.set_xlim((0.5 * min(stood), 1.1 * max(stood)) if stood else (10, 1e5))
            scale_axis(axes, "x", np.geomspace(10, 1e5, 5))
            axes.set(xlabel="stiffest wall that does not chatter [N/m]", yticks=places, yticklabels=names)
            axes.invert_yaxis()
        return figure


def law_limits(
    paddle: SimulatedPaddle,
    *,
    push: float = 1.0,
    laws: str | Iterable[str] = tuple(LAWS),
    first: float = 50.0,
    most: float = 1e5,
    duration: float = 1.0,
    rendering: Rendering = RENDERING,
) -> LawLimits:
    """Search, law by law, the stiffest wall against which a pushed handle does not chatter.

    From soft to stiff: the handle starts at rest on the boundary, pushed by a constant force that no law knows of. A wall
    stands where :func:`chatter` finds no oscillation that lasts or grows, dither below one encoder count apart. The
    stiffness grows by half until a wall does not stand, then the ratio is halved down to 3 %. Where not even the first
    stands, softer ones are tried, each for longer.

    Parameters
    ----------
    paddle : SimulatedPaddle
    push : float
        [N], > 0, and less than the paddle's force_max: no wall answers more.
    laws : str or sequence of str
        Of :func:`hapticlab.laws.wall_law`, by name.
    first, most : float
        The softest wall tried, and the stiffest [N/m].
    duration : float
        Of a trial [s].
    rendering : Rendering
        ``hl.design.Rendering(model=, unilateral=, clamp=, velocity=)``, the same for every law.

    Returns
    -------
    LawLimits

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> found = hl.design.law_limits(paddle, laws=["zoh"])["zoh"]
    >>> found.K <= hl.stability_limit(paddle).K * 1.03 and found.beyond >= hl.stability_limit(paddle).K * 0.97
    True
    """
    laws = (laws,) if isinstance(laws, str) else tuple(laws)
    push = number("push", push, "N", "law_limits", above=0)
    duration = number("duration", duration, "s", "law_limits", above=0)
    first, most = number("first", first, "N/m"), number("most", most, "N/m")
    _check(paddle, laws, push, first, most, duration)
    hand = paddle.hand or Hand()
    pushed = replace(paddle, hand=replace(hand, push=hand.push + push))
    options = rendering.options() | {"model": rendering.model or paddle}  # a model knows nothing of the push
    limits = tuple(_limit(name, pushed, first, most, push, duration, options) for name in laws)
    return LawLimits(limits, push, duration, str(paddle))


def _check(paddle, laws, push, first, most, duration):
    unknown = [law for law in laws if law not in LAWS]
    if unknown or not laws:
        raise AnalysisError(f"law_limits: laws = {unknown or laws}; needs one or more of {', '.join(LAWS)}")
    if paddle.force_max is not None and push >= paddle.force_max:
        raise AnalysisError(
            f"law_limits: push = {push:g} N, but the motor gives at most force_max = {paddle.force_max:g} N, so no wall can "
            "resist the push. Give a smaller push"
        )
    if duration / paddle.T < SHORTEST:
        raise AnalysisError(
            f"law_limits: duration = {duration:g} s is {duration / paddle.T:.3g} samples; needs at least {SHORTEST}"
        )
    if not 0 < first <= most < math.inf:
        raise AnalysisError(f"law_limits: first = {first} N/m, most = {most} N/m; needs 0 < first <= most, both finite")


def _limit(name, paddle, first, most, push, duration, options):
    stood, beyond, why, rest = 0.0, math.inf, "no stiffer wall was tried", np.nan
    K, longer = first, 1.0
    while K <= most and (beyond == math.inf or beyond / max(stood, 1e-9) > FINEST):
        trial = _trial(name, paddle, K, push, duration * longer, options)
        if trial.undecided and (stood == 0 or trial.clipped) and longer < LONGEST:
            longer = min(2 * longer, LONGEST)
            continue
        if trial.undecided and stood == 0:
            return LawLimit(
                name, math.nan, math.nan, f"{K:g} N/m {trial.fault}: the oscillation neither dies out nor grows", np.nan
            )
        if trial.fault is None:
            stood, rest = K, trial.felt
        else:
            beyond, why = K, trial.fault
            if stood == 0 and K * SOFTER < SOFTEST * first:
                break
            longer = max(longer, min(math.sqrt(first / (K * SOFTER)), LONGEST)) if stood == 0 else longer
        K = K * SOFTER if stood == 0 else stood * (GROWTH if beyond == math.inf else math.sqrt(beyond / stood))
    return LawLimit(name, stood, beyond, why, rest)


class _Trial(NamedTuple):
    """What is wrong with a wall, or None; the stiffness felt at rest over K; whether the motor clipped; if it is undecided."""

    fault: str | None
    felt: float = math.nan
    clipped: bool = False
    undecided: bool = False


def _trial(name, paddle, K, push, duration, options):
    """The outcome of one wall under the push.

    A decay in which the motor clips, or that slows down, may end in a cycle: it is undecided.
    """
    try:
        law = wall_law(name, paddle, K=K, **options)
        log = law.paddle.run(law.scene, duration=duration, progress=False)
    except HapticlabError as refusal:
        return _Trial(f"refused: {refusal}")
    if log.fault:
        return _Trial("its force was not finite")
    found = chatter(log)
    clipped = log.saturated is not None and bool(log.saturated[len(log) // 2 :].any())
    state = "undecided" if found.state == "decaying" and clipped else found.state
    seen = found.amplitude > (0.0 if paddle.counts_per_metre is None else 1 / paddle.counts_per_metre)
    if (seen and state in ("chatter", "growing", "undecided")) or abs(found.rest) > 20 * push / K:
        tone = "" if found.frequency is None else f" at {found.frequency:.4g} Hz"
        words = f"{state}, {1e3 * found.amplitude:.3g} mm{tone}"
        return _Trial(words, clipped=clipped, undecided=state == "undecided")
    settled = found.travel < 0.05 * abs(found.rest)
    return _Trial(None, push / (K * found.rest) if settled else math.nan, clipped)
