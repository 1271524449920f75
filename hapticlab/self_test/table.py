"""All checks in the order in which they run, as data: those that take longest come last, as time may end before them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """A check: its name, what it shows, the function that gets a folder of its own and returns what it found, its limit [s].

    The function is a dotted name, so that the process of a check imports no more than the check needs.
    """

    name: str
    shows: str
    function: str
    seconds: float = 30.0


def _own(name, shows, function, seconds=30.0):
    return Check(name, shows, f"{__package__}.{function}", seconds)


CHECKS = (
    _own("packages", "Python and the packages that hapticlab needs are installed", "computer.packages"),
    _own("clocks", "the clock is fine enough to time a link", "computer.clocks"),
    _own("ports", "the serial ports can be listed", "computer.ports"),
    _own("endings", "source files may have the line endings of Windows", "file_checks.line_endings"),
    _own("engines", "every engine gives the bits that it gives on other systems", "running.engines"),
    _own(
        "scene", "a scene with equations of motion runs, comes to rest at the static equilibrium, and is drawn", "running.scene"
    ),
    _own("link", "a simulated board runs with the whole protocol, sim://hapkit", "running.link"),
    _own("labs", "the labs are copied, and a student's changes are kept", "file_checks.labs"),
    _own("paths", "files are found in long folders, with spaces and other alphabets", "file_checks.paths"),
    _own("consoles", "commands run on consoles that cannot write every character", "computer.consoles", 60.0),
    _own("sweeps", "newly started processes share a sweep", "running.sweeps"),
    _own("jupyter", "a notebook's kernel runs hapticlab, and its server has the extension", "teaching.jupyter", 60.0),
    _own("grading", "a small class is graded at the best level of this system", "teaching.graded_as_it_comes", 60.0),
    _own("no walls", "the same class is graded at level none", "teaching.graded_without_walls", 60.0),
)
