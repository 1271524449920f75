"""Find a paddle and connect to it."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from ...base.arguments import number
from ...base.in_notebook import is_in_browser
from ...errors import LinkError, PaddleError, PortError
from ..board.serial_paddle import SerialPaddle
from ..link.serial_ports import IN_A_BROWSER, available_ports, open_port
from ..simulated.simulated_paddle import SimulatedPaddle

if TYPE_CHECKING:
    from ...base.annotations import Number

#: sampling period of a board where none is given [s]
USUAL_T = 1e-3


def connect(
    port: str | None = None, *, T: Number | None = None, paddle: SimulatedPaddle | None = None, hello: Number = 3.0
) -> SerialPaddle:
    """Connect to a paddle and return it; a ``with`` statement leaves the motor off whatever happens.

    Parameters
    ----------
    port : str, optional
        ``COM3``, ``/dev/ttyACM0``, ``sim://hapkit``, ``socket://host:port``, any URL of pyserial. ``sim://bench7.json``
        is a simulated board with the profile in this file. Without a port, only ports with the USB numbers of a known
        board are tried, and the one that answers as a paddle is used. Python in a browser opens ``sim://`` alone.
    T : float or text, optional
        Sampling period [s], whole microseconds within the board's range; 1 ms, or that of a simulated paddle.
    paddle : SimulatedPaddle, optional
        The mechanics behind a ``sim://`` port.
    hello : float or text
        How long a board may take to answer, from reset [s].

    Returns
    -------
    SerialPaddle

    Raises
    ------
    PortError, LinkError
        No port, a port that does not open, no paddle behind it, firmware of another version: each with its cure.

    Examples
    --------
    >>> import hapticlab as hl
    >>> with hl.connect("sim://hapkit") as paddle:
    ...     print(paddle)
    host 0000, firmware 2.0, T = 1 ms, nominal constants, not calibrated, |F| <= 3.3 N
    """
    if paddle is not None and not isinstance(paddle, SimulatedPaddle):
        raise PaddleError(
            f"paddle = {paddle!r}; needs a SimulatedPaddle, the mechanics of a simulated board. "
            'hl.SimulatedPaddle.from_profile(...) makes one of a profile; connect("sim://bench7.json") takes its file.'
        )
    T = T if T is None else number("T", T, "s", "a paddle", above=0, error=PaddleError)
    if paddle is not None and T not in (None, paddle.T):
        raise PaddleError(f"T = {T} s, but the paddle has T = {paddle.T:g} s. Give only one of them.")
    if port is None:
        if paddle is not None:
            raise PaddleError('paddle= is the mechanics of a simulated board: connect("sim://hapkit", paddle=...)')
        return _first_found(USUAL_T if T is None else T, hello)
    opened = open_port(port)
    if not hasattr(opened, "put_on"):
        if paddle is not None:
            opened.close()
            raise PaddleError(f'paddle= is for a simulated board, which {port} is not. Write connect("sim://hapkit", paddle=...)')
        return SerialPaddle(port, T=USUAL_T if T is None else T, port=opened, hello=hello)
    if paddle is not None:
        opened.put_on(paddle)
    board = SerialPaddle(port, T=opened.paddle.T if T is None else T, port=opened, hello=hello)
    board.home(at=opened.handle.x)  # nobody's hand is on a simulated handle: where it starts is known
    return board


def _first_found(T, hello):
    """Ask every port that may be a board; none else is opened, for it may drive a stranger's motor."""
    if is_in_browser():
        raise PortError(IN_A_BROWSER, "missing")
    ports = available_ports()
    candidates = [port for port in ports if port.known]
    if not candidates:
        seen = ", ".join(str(port) for port in ports) or "no serial port at all"
        raise PortError(
            f"no known board is plugged in; found {seen}. Check the cable (some carry power only), or name the port: "
            'connect("COM3"), connect("/dev/ttyACM0"); connect("sim://hapkit") needs no board.',
            "missing",
        )
    refusals, found = [], []
    for port in candidates:
        try:
            found.append(SerialPaddle(port.device, T=T, hello=hello))
        except (PortError, LinkError) as problem:
            refusals.append(str(problem))
    if len(found) == 1:
        return found[0]
    for paddle in found:
        with suppress(PaddleError):
            paddle.close()
    if found:
        named = "; ".join(f"{p.url}: {p}" for p in found)
        raise PortError(f"{len(found)} paddles are plugged in: {named}. Say which: connect({found[0].url!r})", "many")
    raise PortError("; ".join(refusals))
