"""What goes on, in words that change only when it does."""

import numpy as np

from ..analysis.records.chatter import SHORTEST, chatter
from ..base.telemetry import Telemetry
from ..errors import AnalysisError
from .pace import TOLD

#: a hand moves slower than this, chatter is faster [Hz]; and larger than this [m]
SLOWEST, SMALLEST = 8.0, 2e-5
#: of a moving mean that takes a hand's own motion away [s]
MEAN = 0.1
#: what is sustained is at least so strong in every quarter of the last half as in the strongest: a bounce is not
SUSTAINED = 0.5
#: a handle that is led further than so many amplitudes meanwhile may feel a grating of the scene
LED = 4.0
#: what was dropped of a second of the clock is told from here on, and from here on with what to do [s]
LATE, MUCH = 0.02, 0.3
#: a contact that begins or ends so often within the recent quarter of a second comes and goes
CHANGES = 3


def chatter_words(x, F, T):
    """Say how a handle vibrates in its recent second, or nothing.

    It is called chatter where the environment gives energy to a handle that is not led on; what a hand moves across a
    texture vibrates too, and so does a mass that hangs on it.

    Parameters
    ----------
    x, F : array
        Position [m] and force [N], a sample every T [s].

    Examples
    --------
    >>> t = np.arange(1000) * 1e-3
    >>> x = 0.02 + 5e-4 * np.sin(2 * np.pi * 30 * t)
    >>> F = 100 * np.r_[x[0], x[:-1]]                # a spring, a sample late
    >>> chatter_words(x, F, 1e-3)
    'Chatter: 0.5 mm at 30 Hz'
    >>> chatter_words(x + 0.02 * t, F, 1e-3)
    'The handle vibrates: 0.5 mm at 30 Hz'
    >>> chatter_words(0.01 * np.sin(6 * t), F, 1e-3)
    ''
    """
    width = max(1, round(MEAN / T))
    if len(x) < max(SHORTEST, 4 * width) or not np.ptp(x) > SMALLEST or not np.any(F):
        return ""
    total = np.cumsum(np.r_[0.0, x])
    fast = x[width // 2 : width // 2 + len(x) - width + 1] - (total[width:] - total[:-width]) / width
    kept = F[width // 2 : width // 2 + len(fast)]
    strengths = [np.std(part) for part in np.array_split(fast[len(fast) // 2 :], 4)]
    if not min(strengths) >= SUSTAINED * max(strengths):
        return ""
    try:
        found = chatter(Telemetry(t=np.arange(len(fast)) * T, x=fast, v=0 * fast, F=kept, T=T))
    except AnalysisError:  # not finite: the fault says more
        return ""
    if found.frequency is None or found.frequency < SLOWEST or found.amplitude < SMALLEST:
        return ""
    slow = (total[width:] - total[:-width])[len(fast) // 2 :] / width
    drawn = -np.dot(F[:-1] - F.mean(), np.diff(x))
    chatters = drawn > 0 and np.ptp(slow) < LED * found.amplitude
    name = "Chatter" if chatters else "The handle vibrates"
    return f"{name}: {float(f'{1e3 * found.amplitude:.1g}'):g} mm at {found.frequency:.0f} Hz"


def late_words(behind):
    """Say that the computer did not keep up, from so many seconds that were dropped; or nothing."""
    if behind < LATE:
        return ""
    said = f"The computer fell behind by {round(1e3 * min(behind, TOLD), -1):.0f} ms in the last second"
    return said if behind < MUCH else f"{said}: too slow for this scene; give time_scale=0.1 or a cheaper method"


def vibration_words(motion, source):
    """Say how the handle vibrates where the scene runs, or nothing."""
    x, F, _ = motion.traces.recent()
    return chatter_words(x, F, source.period) if motion.running and not motion.replaying else ""


def words_of(motion, source, now, *, vibration="", lost=""):
    """Return what goes on, a list of sentences, of which some are empty.

    Parameters
    ----------
    motion : Motion
    source : Stepping or Streaming
    now : float
        The clock [s].
    vibration : str
        What :func:`vibration_words` says.
    lost : str
        Why a simulation ended.
    """
    board = source.kind == "board"
    if motion.replaying:
        said = ["Replaying a record"]
    elif motion.running:
        *_, contact = motion.traces.recent()
        runs = "Motor on" if board else "Running" if motion.speed == 1 else f"Running at {motion.speed:g} times real time"
        said = [source.waits or f"{runs}{contact_words(contact[-len(contact) // 4 :])}"]
        said += [vibration, *(NOTICED[name] for name in motion.noticed())]
        said += ["" if board else late_words(motion.pace.behind(now)), "" if motion.held else "The handle is let go"]
    else:
        said = ["Motor off: press Start, and hold the handle" if board else "Paused"]
        said += [f"Stopped: {source.fault}" if source.fault else "", lost]
    said += [MISSED if motion.missed else ""]
    records = "Recording" if motion.running and not (motion.replaying or source.waits) else "Recording waits"
    return [*said, records if motion.recording else ""]


#: flags of a Telemetry, in words
NOTICED = {
    "saturated": "The motor is at its limit", "gap": "Samples were lost on the link",
    "overrun": "A step took longer than its period on the board",
}  # fmt: skip

#: from the first event on that was left unlocated
MISSED = "An event was left unlocated: bodies may be inside each other, and a shorter T helps"


def contact_words(contact):
    """Say whether something is touched, from recent samples of 1 or 0; nothing in a scene where nothing can be.

    Examples
    --------
    >>> contact_words(np.ones(9)), contact_words(np.array([1.0, 0, 0, 1, 1, 0])), contact_words(np.full(9, np.nan))
    (', in contact', ', in and out of contact', '')
    """
    if not len(contact) or np.isnan(contact[-1]):
        return ""
    if np.count_nonzero(np.diff(contact)) >= CHANGES:
        return ", in and out of contact"
    return ", in contact" if contact[-1] else ", not in contact"
