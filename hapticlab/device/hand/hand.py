"""The user's hand, as a mass, a damper and a spring on the handle, with a push and an intended path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...base.unusual import HAND, warn_of_unusual
from ...errors import PaddleError
from .hand_presets import PRESETS, HandPreset

if TYPE_CHECKING:
    from ...base.annotations import Array, Number

_NOTHING = HandPreset(0.0, 0.0, 0.0, "", "")
UNITS = {"m": "kg", "b": "N s/m", "k": "N/m", "push": "N", "push_noise": "N"}
_REASONS = {
    "m": "No body has a negative mass.",
    "b": "A negative damper supplies energy to the handle.",
    "k": "A negative spring pushes the handle away and is not passive.",
    "push_noise": "It is a standard deviation.",
}


@dataclass(frozen=True, kw_only=True, init=False)
class Hand(ShowsItself):
    """A hand lumped on the handle: (m + m_hand) x'' = push - b_hand (x' - intent') - k_hand (x - intent) - ...

    A linear hand that does not react, a model of the first 30 ms or so after contact, before reflexes. It is passive
    with push = 0 and a constant intent.

    Parameters
    ----------
    preset : {"pinch", "grip", "arm", "test bed finger"}, optional
        Where mass, damping and stiffness come from unless given; ``hl.people.hand_presets()`` has the sources.
    grip : float
        Firmness relative to the preset, > 0. A firmer grip increases stiffness and damping and leaves the mass
        unchanged (found for a pinched knob by Hasser and Cutkosky, 2002). Here stiffness and damping both grow in
        proportion to ``grip``, the simplest law of that kind, which was not fitted to measurements. If the values
        matter, identify your own hand.
    m : float or text
        Mass [kg], m >= 0.
    b : float or text
        Damping [N s/m], b >= 0.
    k : float or text
        Stiffness [N/m], k >= 0.
    push : float or text
        Constant force on the handle [N], positive into the wall.
    intent : None, float, text or callable, optional
        Target position of the hand [m]: a position, or a function of an array of times [s] that returns as many
        positions [m]. It is sampled at the ticks and linear in between. It acts through k or b.
    push_noise : float or text
        Standard deviation of a white Gaussian force in addition to the push [N], held over each sample; it is drawn
        with the seed of the paddle.

    Raises
    ------
    PaddleError
        For a negative or non-finite value, and for an intent without a spring or damper through which it acts.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.device.hand.hand import Hand
    >>> print(Hand(m=0.02, b=1, k=200, intent=lambda t: 0.01 * np.sin(6 * t)))
    m = 0.02 kg, b = 1 N s/m, k = 200 N/m, a moving intent
    >>> print(Hand("pinch", grip=2.0, push=1.5))
    m = 0.02 kg, b = 2 N s/m, k = 400 N/m, push = 1.5 N
    """

    m: float = 0.0
    b: float = 0.0
    k: float = 0.0
    push: float = 0.0
    intent: float | Callable[..., Any] | None = None
    push_noise: float = 0.0

    def __init__(
        self,
        preset: str | None = None,
        *,
        grip: float = 1.0,
        m: Number | None = None,
        b: Number | None = None,
        k: Number | None = None,
        push: Number = 0.0,
        intent: Number | Callable[..., Any] | None = None,
        push_noise: Number = 0.0,
    ) -> None:
        if preset is not None and preset not in PRESETS:
            raise PaddleError(
                f"no hand {preset!r}; the presets are {', '.join(PRESETS)}. For a hand of your own write "
                "hl.Hand(m=..., b=..., k=...)"
            )
        why = "It is the firmness relative to the preset."
        grip = number("grip", grip, "", "a hand", above=0, why=why, error=PaddleError)
        if preset is None and grip != 1:
            raise PaddleError(
                f"grip = {grip:g}: grip makes a preset firmer, as in hl.Hand('pinch', grip=2). Without a "
                "preset, give b and k instead"
            )
        known = PRESETS[preset] if preset is not None else _NOTHING
        numbers = {"m": known.m, "b": grip * known.b, "k": grip * known.k}
        given = {name: value for name, value in (("m", m), ("b", b), ("k", k)) if value is not None}
        for name, value in {**numbers, **given, "push": push, "intent": intent, "push_noise": push_noise}.items():
            object.__setattr__(self, name, value)
        self._check()

    def _check(self) -> None:
        for name, reason in _REASONS.items():
            value = number(name, getattr(self, name), UNITS[name], "a hand", least=0, why=reason, error=PaddleError)
            object.__setattr__(self, name, value)
            warn_of_unusual(name, value, UNITS[name], HAND.get(name))
        object.__setattr__(self, "push", number("push", self.push, "N", "a hand", error=PaddleError))
        if self.intent is None:
            return
        if not self.moves:
            object.__setattr__(self, "intent", number("intent", self.intent, "m", "a hand", error=PaddleError))
        if self.k == 0 and self.b == 0:
            raise PaddleError(
                "intent without k or b: a target position acts through the hand's spring or damper. Give Hand(k=..., "
                "intent=...) in N/m, or b in N s/m."
            )

    @property
    def moves(self) -> bool:
        """Whether the intent is a function of time."""
        return callable(self.intent)

    def samples(self, ticks: int, T: float, first: int = 0) -> Array:
        """Return the intent at the ticks first ... first + ticks (one more than the ticks) [m], shape (ticks + 1,).

        Parameters
        ----------
        ticks : int
            Ticks to come, >= 0.
        T : float
            Sampling period [s], > 0.
        first : int
            Number of the first tick, >= 0.
        """
        times = np.arange(first, first + ticks + 1) * T
        assert callable(self.intent), "needed by a hand that moves"
        places = np.asarray(self.intent(times), float)
        if places.shape not in ((), times.shape):
            raise PaddleError(
                f"intent gave shape {places.shape} for {ticks + 1} times; needs one position [m] for each. Use NumPy "
                "functions of the whole array, as in lambda t: 0.01*np.sin(t)."
            )
        bad = ~np.isfinite(places)
        if bad.any():
            when = float(np.broadcast_to(times, bad.shape)[bad][0]) if bad.ndim else 0.0
            raise PaddleError(f"intent is not finite at t = {when:g} s; needs a position [m] at every tick.")
        return np.broadcast_to(places, times.shape)

    def _sentence(self):
        return f"a hand: {self}"

    def _line(self):
        return f"Hand({self})"

    def __str__(self) -> str:
        parts = [f"{name} = {getattr(self, name):g} {unit}" for name, unit in UNITS.items() if getattr(self, name)]
        if self.moves:
            parts.append("a moving intent")
        elif self.intent is not None:
            parts.append(f"intent = {self.intent:g} m")
        return ", ".join(parts) or "nothing"
