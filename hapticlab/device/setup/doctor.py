"""What is wrong with this paddle? A walk from the cable to the motor; every step says what it found and what to do."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from ...base.in_notebook import is_in_browser
from ...base.shows_itself import ShowsItself
from ...errors import HapticlabError
from ..board.serial_paddle import SerialPaddle
from ..link.port_faults import permission_cure
from ..link.serial_ports import IN_A_BROWSER, available_ports, open_port
from . import computer_checks
from . import doctor_checks as checks

if TYPE_CHECKING:
    from collections.abc import Callable

    from .person import Person

STATES = ("ok", "attention", "fault", "no board", "skipped")


@dataclass(frozen=True)
class Report(ShowsItself):
    """Every step's Check, in order; prints as lines."""

    checks: tuple

    @property
    def exit_code(self):
        """0, or 1 where anything is a fault or no board is there."""
        return int(any(check.state in ("fault", "no board") for check in self.checks))

    def __getitem__(self, name):
        """Return the last check of that name; KeyError where the walk did not come so far."""
        return {check.name: check for check in self.checks}[name]

    def records(self):
        """Return the checks as dictionaries."""
        return [asdict(check) for check in self.checks]

    def _sentence(self):
        found = {state: sum(check.state == state for check in self.checks) for state in STATES}
        return ", ".join(state if state == "no board" else f"{count} {state}" for state, count in found.items() if count)

    def __str__(self):
        return "\n".join([*map(str, self.checks), self._sentence()])


def doctor(url: str | None = None, person: Person | None = None, *, tell: Callable[[Any], Any] = lambda check: None) -> Report:
    """Check notebook, rights, cable, port, firmware, settings, wiring, latency, loop, link, sensor, home and motor sign in turn.

    Parameters
    ----------
    url : str, optional
        A port; without it the one whose USB numbers are of a known board.
    person : Person, optional
        The person who moves the handle when asked; None skips the checks that need a person, and says so. The motor
        gives a force, at most 0.5 N, only in the check of its sign, and only if the person agrees.
    tell : callable
        Called with every Check as it is made.

    Returns
    -------
    Report

    Examples
    --------
    >>> from hapticlab.device.setup.doctor import doctor
    >>> report = doctor("sim://hapkit")
    >>> report.exit_code
    0
    >>> print(report["port"])
    ok         port       sim://hapkit opens
    """
    made = []
    for check in _walk(url, person):
        made.append(check)
        tell(check)
    return Report(tuple(made))


def _walk(url, person):
    """Yield one Check after another, until one leaves nothing to go on with."""
    yield computer_checks.notebook()
    if url is None or "://" not in url:
        yield computer_checks.rights(url)
    found, url = _ports(url)
    yield found
    if url is None:
        return
    try:
        port = open_port(url)
    except HapticlabError as problem:  # sim:// has reasons of its own: no such paddle, no library
        cause = getattr(problem, "cause", None)
        yield checks.Check("port", "fault", f"{url} does not open" + (f" ({cause})" if cause else ""), str(problem))
        return
    yield checks.Check("port", "ok", f"{url} opens")
    paddle = None
    try:
        simulated = getattr(port, "paddle", None)  # it knows its period; a board is asked to run at the usual one
        connected = partial(SerialPaddle, T=simulated.T) if simulated else SerialPaddle
        found, paddle = checks.firmware(port, url, connected)
        yield from found
        if paddle is not None:
            yield from _on_board(paddle, person)
    except HapticlabError as problem:
        yield checks.Check("link", "fault", "the checks ended here", str(problem))
    finally:
        if paddle is not None:
            paddle.close()
        elif port.is_open:
            port.close()


def _on_board(paddle, person):
    yield checks.settings(paddle)
    yield checks.wiring(paddle, person)
    yield checks.latency(paddle)
    yield from checks.loop_and_link(paddle)
    yield checks.sensor_at_rest(paddle)
    yield checks.sensor_moved(paddle, person)
    yield checks.home(paddle, person)
    yield checks.sign(paddle, person)


def _ports(url):
    """Return the Check of this computer's ports, and the port to look at, or None."""
    if url is None and is_in_browser():
        return checks.Check("computer", "no board", "no serial port", IN_A_BROWSER), None
    there = available_ports()
    known = [port for port in there if port.known]
    listed = "; ".join(map(str, there)) or "no serial port"
    if url is not None:
        return checks.Check("computer", "ok", f"{listed}; {url} was named"), url
    if len(known) == 1:
        return checks.Check("computer", "ok", listed), known[0].device
    if known:
        names = ", ".join(port.device for port in known)
        return checks.Check("computer", "fault", f"{len(known)} known boards: {listed}", f"name one of {names} with --port"), None
    cure = (
        "everything else works without a board; try: hapticlab labs\n"
        "if you have a board: plug it in. Try another cable, because some carry power only, and a USB socket without a hub\n"
        "copies with a CH340 need its driver on Windows and older macOS\n"
        "if its port is listed here, name it with --port\n"
        f"if this system does not let you open it, {permission_cure()}"
    )
    return checks.Check("computer", "no board", f"no known board: {listed}", cure), None
