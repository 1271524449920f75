"""A forced choice without a paddle: how an experiment would go, to plan it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import instance, number
from .forced_choice import ForcedChoice, Trial
from .observers import SimulatedObserver

if TYPE_CHECKING:
    from .psi import ConstantLevels, Psi
    from .up_down import UpDown


def simulate_choices(
    observer: SimulatedObserver,
    procedure: UpDown | Psi | ConstantLevels,
    *,
    standard: float = 200.0,
    standard_first: bool = False,
    seed: int = 0,
) -> ForcedChoice:
    """A two-alternative forced choice of an observer who is told both magnitudes, so that nothing has to be felt.

    It shows in a moment how many trials an experiment needs and how far its results scatter, before a person does it.

    Parameters
    ----------
    observer : SimulatedObserver
    procedure : UpDown, Psi or ConstantLevels, fresh
        Levels are ln(comparison/standard).
    standard : float
        > 0, in any unit.
    standard_first : bool
        True shows the standard first in every trial, a mistake that rewards a preference for "second".
    seed : int
        Draws the order.

    Returns
    -------
    ForcedChoice

    Examples
    --------
    >>> import hapticlab as hl
    >>> biased, same = hl.people.SimulatedObserver(weber=0.23, bias=0.2), {"levels": [0.1], "repeats": 500}
    >>> for first in (False, True):
    ...     found = simulate_choices(biased, hl.people.ConstantLevels(**same), standard_first=first)
    ...     print(sum(trial.right for trial in found.trials))
    283
    407
    """
    instance("observer", observer, SimulatedObserver, "hl.people.SimulatedObserver(weber=...)")
    standard = number("standard", standard, "", "a forced choice", above=0)
    order, trials = np.random.default_rng(seed), list[Trial]()
    while not procedure.done:
        level, turned = procedure.level, bool(order.integers(2)) and not standard_first
        pair = (standard, standard * math.exp(level))
        first, second = pair[::-1] if turned else pair
        answer = observer.decide([first, second], len(trials))
        trials.append(Trial(level, first, second, answer, answer == ("first" if turned else "second")))
        procedure.answer(trials[-1].right)
    stopped = getattr(procedure, "gave_up", None)
    estimate = None if stopped or not hasattr(procedure, "estimate") else procedure.estimate()
    return ForcedChoice("magnitude", "magnitude", "1", standard, tuple(trials), estimate, str(procedure),
                        str(observer), "without a paddle", seed, stopped)  # fmt: skip
