"""pyserial's port for ``pico://name``: that of ``uno://``, but opening it resets nothing, and no rate is another's."""

import pico_loop
import serial

from ports import protocol_uno

CONNECTS_WITHIN = 0.2  # [s] of virtual time


class Serial(protocol_uno.Serial):
    """An emulated Pico's serial port over USB."""

    def open(self):
        """Open the port once the board has one: rate, DTR and RTS are told."""
        name = self.port.removeprefix("pico://")
        if name not in pico_loop.BOARDS:
            raise serial.SerialException(f"no board is offered as {name!r}; there are {sorted(pico_loop.BOARDS)}")
        self.loop = pico_loop.BOARDS[name]
        self.loop.run_until(lambda: self.loop.board.configured, CONNECTS_WITHIN)
        if not self.loop.board.configured:
            raise serial.SerialException(f"{name}: no USB device came")
        self.loop.board.open_port(self.baudrate)
        self.loop.board.read()
        self.is_open = True

    def read(self, size=1):
        """Return ``size`` bytes, or those that came before the timeout. A board without power has no port."""
        self._check()
        board, wait = self.loop.board, protocol_uno.LONGEST_WAIT if self.timeout is None else self.timeout
        self.loop.run_until(lambda: board.waiting >= size or board.halted, wait)
        if board.halted and not board.waiting:
            raise serial.SerialException(f"the device disconnected: {board.halted}")
        return board.read(size)

    def close(self):
        """Leave the board running."""
        if self.is_open:
            self.loop.board.close_port()
        self.is_open = False

    def _reconfigure_port(self):
        """USB has one rate, whatever is said."""
