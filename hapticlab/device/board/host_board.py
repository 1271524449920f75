"""This computer as a board: the firmware's whole core, its time and its handle in the caller's hands."""

import ctypes

from ...compiler.engines.firmware_library import load_library
from ..link.messages import FAULTS

STORE_BYTES, DUTY_FULL, CLOCK_HZ = 4096, 32767, 1_000_000
#: words of 16 bits: this computer holds programs of any size
WORD_BITS = 16


class HostBoard:
    """One powered board. What it is told and says are bytes of the wire; its timer is :meth:`tick`.

    Parameters
    ----------
    store : bytes
        What the memory that survives power-off holds; empty for a new board.
    reset_cause : int
    slots : int
        Places for programs: 2, or 1 as on a board of little memory.

    Examples
    --------
    >>> from hapticlab.device.board.host_board import HostBoard
    >>> from hapticlab.device.link.wire import Decoder, encode
    >>> board = HostBoard()
    >>> board.receive(encode("PING", 5, 42))
    >>> Decoder().feed(board.transmit())
    [Frame(message='PONG', sequence=5, payload=b'*\\x00\\x00\\x00')]
    """

    def __init__(self, store=b"", reset_cause=0, slots=2):
        self._library = _library(*([f"-DHL_SLOTS={slots}"] if slots != 2 else []))
        self._room = ctypes.create_string_buffer(65536)
        self._board = self._library.hl_host_new(store.ljust(STORE_BYTES, b"\xff"), reset_cause)
        if not self._board:
            raise MemoryError("no memory for a simulated board")

    def __del__(self):
        if getattr(self, "_board", None):
            self._library.hl_host_free(self._board)

    def receive(self, data):
        """Take bytes from the link; every whole frame among them is answered."""
        self._library.hl_host_receive(self._board, data, len(data))

    def transmit(self):
        """Return the bytes that the board has to say."""
        count = self._library.hl_host_transmit(self._board, self._room, len(self._room))
        return self._room[:count]  # not .raw, which copies all of it

    def tick(self, counts, now, step=0.0):
        """Run one tick at ``now`` [s] with the handle at ``counts``, which takes ``step`` [s]; return the duty, -1 ... 1."""
        clock = round(now * CLOCK_HZ) & 0xFFFF
        return self._library.hl_host_tick(self._board, counts, clock, round(step * CLOCK_HZ)) / DUTY_FULL

    @property
    def duty(self):
        """What the motor gets, -1 ... 1."""
        return self._library.hl_host_duty(self._board) / DUTY_FULL

    @property
    def period(self):
        """The timer's period [s]."""
        return self._library.hl_host_period_us(self._board) / 1e6

    @property
    def store(self):
        """The bytes of the memory that survives power-off."""
        return ctypes.string_at(self._library.hl_host_store(self._board), STORE_BYTES)

    def damage_program(self, at, mask):
        """Flip bits of a byte of the active program, as a failing memory would."""
        self._library.hl_host_program(self._board)[at] ^= mask

    def race(self, where):
        """Let a tick come just "before" the next time that ticks are held off, or just "after" it, as an interrupt may."""
        self._library.hl_host_race(self._board, {"before": 1, "after": 2}[where])

    def cut_power(self, after):
        """Let the power fail after so many bytes written to the store: what comes later is not there."""
        self._library.hl_host_cut(self._board, after)

    def fail(self, fault):
        """Let the board find a fault by itself, a name in FAULTS, as its sensor or its stack would."""
        self._library.hl_host_fault(self._board, FAULTS[fault][0])


def _library(*flags):
    library = load_library(WORD_BITS, *flags)
    board = ctypes.c_void_p
    library.hl_host_new.restype = board
    library.hl_host_new.argtypes = [ctypes.c_char_p, ctypes.c_uint8]
    library.hl_host_free.argtypes = [board]
    library.hl_host_receive.argtypes = [board, ctypes.c_char_p, ctypes.c_uint32]
    library.hl_host_transmit.argtypes = [board, ctypes.c_void_p, ctypes.c_uint32]
    library.hl_host_transmit.restype = ctypes.c_uint32
    library.hl_host_tick.argtypes = [board, ctypes.c_int32, ctypes.c_uint16, ctypes.c_uint16]
    library.hl_host_cut.argtypes = [board, ctypes.c_uint32]
    library.hl_host_race.argtypes = library.hl_host_fault.argtypes = [board, ctypes.c_int]
    library.hl_host_duty.argtypes = library.hl_host_period_us.argtypes = [board]
    library.hl_host_period_us.restype = ctypes.c_uint32
    library.hl_host_store.argtypes = library.hl_host_program.argtypes = [board]
    library.hl_host_store.restype = library.hl_host_program.restype = ctypes.POINTER(ctypes.c_uint8)
    return library
