"""pyserial's port for ``uno://name``. Reading lets virtual time pass until bytes are there or the timeout is over."""

import serial
import uno_port
from emulator import EXTERNAL

LONGEST_WAIT = 10.0  # [s] of virtual time, for a read without timeout


class Serial(serial.SerialBase):
    """An emulated Uno. As with the real one, opening the port resets it."""

    lockstep = True  # no time passes but in a read

    def now(self):
        """Virtual time [s]."""
        return self.loop.now

    def open(self):
        """Take the board, and reset it as DTR does."""
        name = self.port.removeprefix("uno://")
        if name not in uno_port.BOARDS:
            raise serial.SerialException(f"no board is offered as {name!r}; there are {sorted(uno_port.BOARDS)}")
        self.loop = uno_port.BOARDS[name]
        self.loop.board.reset(EXTERNAL)
        self.loop.board.read()
        self.is_open = True

    def close(self):
        """Leave the board running."""
        self.is_open = False

    def _reconfigure_port(self):
        """The board's rate is its own: a wrong one here would be a wrong one there."""
        if self.baudrate != 500000:
            raise ValueError(f"baudrate = {self.baudrate}; the board talks at 500000")

    @property
    def in_waiting(self):
        """Bytes to read at once."""
        self._check()
        return self.loop.board.waiting

    def read(self, size=1):
        """Return ``size`` bytes, or those that came before the timeout."""
        self._check()
        wait = LONGEST_WAIT if self.timeout is None else self.timeout
        self.loop.run_until(lambda: self.loop.board.waiting >= size, wait)
        return self.loop.board.read(size)

    def write(self, data):
        """Put bytes on the line; they take their time there."""
        self._check()
        self.loop.board.write(data)
        return len(data)

    def flush(self):
        """Nothing is held back."""

    def reset_input_buffer(self):
        """Forget what came."""
        self._check()
        self.loop.board.read()

    def reset_output_buffer(self):
        """Nothing is held back."""

    def _check(self):
        if not self.is_open:
            raise serial.PortNotOpenError()
