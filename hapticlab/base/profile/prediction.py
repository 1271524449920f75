"""The interval of a prediction, from the intervals of a paddle's constants."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from ...errors import AnalysisError, HapticlabError
from ..facts import card
from ..shows_itself import ShowsItself

if TYPE_CHECKING:
    from .paddle_profile import PaddleProfile

#: values of a constant at which a prediction is looked at, from one end of its interval to the other
POINTS = 5
#: answers that one prediction may take
MOST = 4096
#: part of the largest answer below which two answers are the same
ALIKE = 1e-7


@dataclass(frozen=True)
class Prediction(ShowsItself):
    """A prediction for a paddle whose constants have intervals.

    ``low`` and ``high`` are the least and the largest answer over all combinations of ends of the intervals. While the
    answer rises or falls throughout with each constant, no other paddle within the intervals has an answer outside.
    Whether it does is looked at for one constant after the other, at 5 values from end to end with the others at their
    own value, which is no proof. A constant with which the answer both rises and falls is in ``not_monotone``: for it
    all 5 values are combined with the others, and the true ends may lie a little further out.

    If the intervals of the constants contain the true constants, then ``low`` to ``high`` contains the true answer. For
    one constant that holds as often as its interval says. For several it holds at least as often as all their
    intervals hold together.

    Attributes
    ----------
    value : float
        With all constants at their own value.
    low : float
        Least answer.
    high : float
        Largest answer.
    unit : str
    at_low : PaddleProfile
        Profile with the least answer. Where less is worse, as for the stiffest wall, it is the cautious paddle.
    at_high : PaddleProfile
        Profile with the largest answer.
    low_ends : dict of str to str
        End of the interval, "low" or "high", at which the answer is least, by constant.
    high_ends : dict of str to str
        End at which the answer is largest, by constant.
    unmoved : tuple of str
        Constants with an interval on which the answer does not depend.
    not_monotone : tuple of str
        Constants with which the answer both rises and falls.
    """

    value: float
    low: float
    high: float
    unit: str
    at_low: PaddleProfile
    at_high: PaddleProfile
    low_ends: dict[str, str]
    high_ends: dict[str, str]
    unmoved: tuple[str, ...] = ()
    not_monotone: tuple[str, ...] = ()

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        rows = {f"{which} with": _ends(ends) for which, ends in (("lowest", self.low_ends), ("highest", self.high_ends))}
        lines = [card(f"{self.value:.6g}{unit}, between {self.low:.6g} and {self.high:.6g}", rows)]
        if self.unmoved:
            lines.append(f"  it does not depend on {', '.join(self.unmoved)}")
        if self.not_monotone:
            lines.append(
                f"  it both rises and falls with {', '.join(self.not_monotone)}, so the true ends may lie a little further out"
            )
        return "\n".join([*lines, "  the other constants of the profile are taken as exact"])


def predicted(profile, question, args, options):
    """Return the Prediction of ``question(profile, *args, **options)``."""
    spans = {one.name: one for one in profile.estimates if one.low < one.high}
    if not spans:
        raise AnalysisError(
            f"the profile {profile.name} has no interval, so its prediction has none. Identify the paddle, "
            "twin = hl.identify.twin(name, found, base=profile), or ask the question of the profile itself"
        )
    asked = _Asked(profile, question, args, options)
    value = asked()
    moving = [name for name, span in spans.items() if _moves(asked, name, span, spans)]
    levels, mixed = {}, []
    for name in moving:
        span = spans[name]
        along = [span.low + (span.high - span.low) * k / (POINTS - 1) for k in range(POINTS)]
        monotone = _is_monotone([asked(**{name: at}) for at in along])
        levels[name] = (span.low, span.high) if monotone else tuple(along)
        mixed += [] if monotone else [name]
    many = math.prod(map(len, levels.values()))
    if many > MOST:
        raise AnalysisError(
            f"the prediction depends on {', '.join(moving)} in {many} combinations; needs {MOST} at most. Fix some, "
            "as in profile.at(m='low').predict(...)"
        )
    for values in product(*levels.values()):
        asked(**dict(zip(levels, values, strict=True)))
    least, largest = (_of(end(asked.answers, key=asked.answers.get), moving) for end in (min, max))
    return Prediction(
        value, asked(**dict(least)), asked(**dict(largest)), asked.unit, asked.at(least), asked.at(largest),
        _named(least, moving, spans), _named(largest, moving, spans), tuple(name for name in spans if name not in moving),
        tuple(mixed),
    )  # fmt: skip


class _Asked:
    """A question about profiles that differ in some constants, each asked once."""

    def __init__(self, profile, question, args, options):
        self.profile, self.question, self.args, self.options = profile, question, args, options
        self.answers, self.unit = {}, ""

    def __call__(self, **values):
        key = tuple(sorted((name, value) for name, value in values.items() if value != getattr(self.profile, name)))
        if key not in self.answers:
            self.answers[key] = self._answer(key)
        return self.answers[key]

    def at(self, key):
        """The profile with these constants, each as the end of its interval where it is one."""
        ends = {
            name: next((end for end in ("low", "high") if getattr(self.profile[name], end) == value), value)
            for name, value in key
        }
        return self.profile.at(**ends)

    def _answer(self, key):
        try:
            given = self.question(self.at(key), *self.args, **self.options)
        except HapticlabError as error:
            where = ", ".join(f"{name} = {value:g}" for name, value in key) or "the profile's own values"
            raise AnalysisError(f"no prediction at {where}: {error}") from error
        try:
            answer = float(given)
        except (TypeError, ValueError):
            answer = math.nan
        if math.isnan(answer):
            raise AnalysisError(
                f"{given!r} is not a number; a prediction needs a question that returns a number, such as hl.stability_limit"
            )
        self.unit = getattr(given, "unit", "")
        return answer


def _of(key, names):
    """The constants of an answer that matter for it, with their values."""
    return tuple((name, value) for name, value in key if name in names)


def _moves(asked, name, span, spans):
    """Whether the answer depends on a constant: with all others at their own value, at their lower and at their upper ends."""
    for others in ({}, {one: s.low for one, s in spans.items()}, {one: s.high for one, s in spans.items()}):
        low, own, high = (asked(**{**others, name: at}) for at in (span.low, span.value, span.high))
        if not (_alike(low, own) and _alike(own, high)):
            return True
    return False


def _alike(one, other):
    return one == other or (math.isfinite(one - other) and abs(one - other) <= ALIKE * max(abs(one), abs(other)))


def _is_monotone(answers):
    steps = [after - before for before, after in zip(answers, answers[1:], strict=False) if not _alike(before, after)]
    return all(step > 0 for step in steps) or all(step < 0 for step in steps)


def _named(key, moving, spans):
    """Constant -> the end at which it is, or its value within."""
    values = dict(key)
    ends = {}
    for name in moving:
        span, at = spans[name], values.get(name, spans[name].value)
        ends[name] = "low" if at == span.low else "high" if at == span.high else f"{at:.4g} {span.unit}".removesuffix(" 1")
    return ends


def _ends(ends):
    return ", ".join(f"{name} {end if end in ('low', 'high') else f'= {end}'}" for name, end in ends.items()) or "any"
