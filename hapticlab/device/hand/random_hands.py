"""Passive hands drawn at random, to ask what a wall does in every hand and not in one."""

from __future__ import annotations

import numpy as np

from ...base.arguments import count, number
from ...errors import PaddleError
from .hand import UNITS, Hand

Range = tuple[float, float]


def random_hands(
    hands: int,
    *,
    m: Range = (1e-3, 1.0),
    b: Range = (1e-3, 10.0),
    k: Range = (1.0, 1e4),
    push: float = 0.0,
    seed: int = 0,
) -> tuple[Hand, ...]:
    """Draw passive hands at random: the logarithms of mass, damping and stiffness are uniform between two ends.

    Parameters
    ----------
    hands : int
        How many, >= 1.
    m : (float, float)
        Least and largest mass [kg], > 0.
    b : (float, float)
        Least and largest damping [N s/m], > 0.
    k : (float, float)
        Least and largest stiffness [N/m], > 0.
    push : float
        The constant force of each hand [N].
    seed : int
        The same seed draws the same hands.

    Returns
    -------
    tuple of Hand

    Raises
    ------
    PaddleError
        For a range whose ends are not positive or not in order.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hands = hl.people.random_hands(100, b=(0.01, 0.1), seed=3)
    >>> len(hands), all(0.01 <= hand.b <= 0.1 for hand in hands)
    (100, True)
    """
    hands = count("hands", hands, least=1, error=PaddleError)
    random = np.random.default_rng(seed)
    columns = {}
    for name, ends in (("m", m), ("b", b), ("k", k)):
        least, most = _ends(name, ends)
        columns[name] = 10 ** random.uniform(least, most, hands)
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return tuple(Hand(**dict(zip(columns, row, strict=True)), push=push) for row in rows)


def _ends(name, ends):
    """Return the logarithms of the two ends of a range."""
    if np.shape(ends) != (2,):
        raise PaddleError(f"{name} = {ends!r:.60}; a range of hands needs two numbers, (least, largest), each > 0 {UNITS[name]}")
    low, high = ends
    low = number(f"least {name}", low, UNITS[name], "a range of hands", above=0, error=PaddleError)
    high = number(f"largest {name}", high, UNITS[name], "a range of hands", least=low, error=PaddleError)
    return np.log10([low, high])
