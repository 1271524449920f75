"""The exceptions of hapticlab. Every message says what was given, what is needed, and what to do.

A notebook shows your own line and the message; ``%tb`` in the next cell shows the whole traceback. A script does so
too, and ``python -X dev FILE`` shows the whole.

>>> import hapticlab as hl
>>> try:
...     hl.wall()(k="300 kg")
... except hl.HapticlabError as error:
...     print(type(error).__name__)
UnitsError

::

    HapticlabError
    +-- SceneError            what the student wrote cannot be felt
    |   +-- UnitsError        two terms of an equation have different units
    |   +-- SignalError       a sample that does not exist yet, or never will
    |   +-- ParameterError    a value is missing, unknown, not finite or out of its range
    |   +-- MassError         the equations do not determine every acceleration
    +-- ProgramError          a program is damaged, or asks for what no engine has
    |   +-- LiveConstantError a method makes constants of what may be set while the program runs
    |   +-- LongStepError     a step is too long for a method
    |   +-- ProgramLimitError a program is past a limit of the engine or board
    +-- PaddleError           a device, simulated or real, was asked for what it cannot do
    |   +-- PortError         a serial port is missing, taken, forbidden, or left during use
    |   +-- LinkError         a board does not answer, refuses, or speaks another version
    +-- AnalysisError         a record or a model does not allow the question asked of it
    +-- CourseError           a lab, an exercise or a folder of labs is not as it is meant to be
    +-- EngineMissingError    an engine cannot run on this machine
"""

from __future__ import annotations

from collections.abc import Iterable

from .vocabulary import page

__all__ = [
    "AnalysisError",
    "CourseError",
    "EngineMissingError",
    "HapticlabError",
    "LinkError",
    "LiveConstantError",
    "LongStepError",
    "MassError",
    "MissedEventWarning",
    "PaddleError",
    "ParameterError",
    "PortError",
    "ProgramError",
    "ProgramLimitError",
    "SceneError",
    "SignalError",
    "UnitsError",
    "UnusualValueWarning",
]


class HapticlabError(Exception):
    """Base class of all errors that hapticlab raises on purpose."""


class UnusualValueWarning(UserWarning):
    """A value is far from that of any paddle, so its unit may be wrong."""


class MissedEventWarning(UserWarning):
    """A run left events unlocated, or bodies overlapped, so its motion may be wrong after that."""


class SceneError(HapticlabError, ValueError):
    """A scene is not valid as it is written."""


class UnitsError(SceneError):
    """Two terms of an equation have different units."""


class SignalError(SceneError):
    """A sample that does not exist yet (x(n+1)) or never will (x(n-1/2))."""


class ParameterError(SceneError):
    """A parameter's value is missing, unknown, not finite or out of its range."""


class MassError(SceneError):
    """The equations of motion do not determine every acceleration."""


class ProgramError(HapticlabError, ValueError):
    """A program is damaged, or needs an operation that no engine has."""


class LiveConstantError(ProgramError):
    """A method needs constants where parameters are live; ``live`` has their names.

    Parameters
    ----------
    message : str
        What happened, and what to do.
    live : iterable of str
        Names of the parameters that would have to be constants.
    """

    def __init__(self, message: str, live: Iterable[str] = ()) -> None:
        super().__init__(message)
        self.live = tuple(live)


class LongStepError(ProgramError):
    """A step is too long for a method; ``substeps`` is a sufficient number, or None if no number is enough.

    Parameters
    ----------
    message : str
        What happened, and what to do.
    substeps : int, optional
        A sufficient number of substeps.
    """

    def __init__(self, message, substeps=None):
        super().__init__(message)
        self.substeps = substeps


class ProgramLimitError(ProgramError):
    """A program is larger than an engine or a board can hold."""


class PaddleError(HapticlabError, ValueError):
    """A paddle, simulated or real, cannot do what was requested."""


class PortError(PaddleError):
    """A serial port is missing, in use, forbidden, or disconnected during use.

    ``cause`` is one word for it: "missing", "busy", "permission", "url", "refused", "settings", "left", "slept", "silent"
    or "failed".

    Parameters
    ----------
    message : str
        What happened, and what to do.
    cause : str
        One word, as above.
    """

    def __init__(self, message: str, cause: str = "failed") -> None:
        super().__init__(message)
        self.cause = cause


class LinkError(PaddleError):
    """A board does not answer, rejects a request, or uses a different protocol version.

    ``result`` is the board's own word for a refusal, a name in hapticlab.device.link.messages.RESULTS, else None.

    Parameters
    ----------
    message : str
        What happened, and what to do.
    result : str, optional
        The board's own word for a refusal.
    """

    def __init__(self, message: str, result: str | None = None) -> None:
        super().__init__(message)
        self.result = result


class AnalysisError(HapticlabError, ValueError):
    """A record or a model does not allow the requested analysis."""


class CourseError(HapticlabError, ValueError):
    """A lab, an exercise or a folder of labs is not valid."""


class EngineMissingError(HapticlabError, ImportError):
    """An engine cannot run on this machine."""


page(__name__)
