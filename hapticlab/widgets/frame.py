"""What a front end draws at one moment."""

from dataclasses import dataclass, field

import numpy as np

#: columns of the rows of a frame that every scene has; those of what it watches follow
COLUMNS = ("t", "x", "F", "E", "intent", "contact", "x_true", "F_applied", "x_switch")
#: rows of a frame are so far apart at least [s]
THINNED = 5e-4


def columns(watched):
    """Return the names of the columns of a scene's rows; a watched channel is told from one that every scene has.

    Examples
    --------
    >>> columns(["theta", "E"])[-2:]
    ['theta', 'watched E']
    """
    return [*COLUMNS, *(f"watched {name}" if name in COLUMNS else name for name in watched)]


@dataclass(frozen=True)
class Frame:
    """What happened since the frame before, and what to show now.

    Attributes
    ----------
    time : float
        Scene time of the last sample [s].
    rows : array of float32, shape (samples, 9 + watched)
        Since the frame before, at least 0.5 ms apart: t [s], x [m], F [N]; E [J], the energy drawn from the environment
        since the start; intent [m], the target position of the hand (nan on a board, and while the handle is released);
        contact, 1 or 0 (nan in a scene without a wall or a contact); x_true [m] and F_applied [N], the position of the
        handle and the force as they acted, which a sensor and a delay change; x_switch [m], where that force began to act;
        then each watched channel [SI].
    picture : tuple
        Display list of the moving picture, as :mod:`hapticlab.widgets.picture` describes it.
    status : str
        One or two sentences; empty where they are as in the frame before.
    flags : dict
        ``running``, ``recording``, ``replaying``, ``held`` (a hand is on the handle), ``motor`` (a board's is on): bool.
        ``vibrates``, whether the status tells of a vibration. ``speed``, scene time over the clock's; ``T`` and ``apart``,
        between two samples and between two rows [s]: a record that is replayed may have its own. And
        ``recorded``, whether there is a record to replay or save; ``values``, dict of name to SI of every slider's
        parameter: where the sliders belong; ``wanted`` [m], where a hand begins to lead.

    Examples
    --------
    >>> Frame(0.0, status="paused", flags={"running": False}).rows.shape
    (0, 9)
    """

    time: float
    rows: np.ndarray = field(default_factory=lambda: np.zeros((0, len(COLUMNS)), np.float32))
    picture: tuple = ()
    status: str = ""
    flags: dict = field(default_factory=dict)
