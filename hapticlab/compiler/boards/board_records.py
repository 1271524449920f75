"""The boards: what each gives a program."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Board:
    """What a board gives a program.

    Attributes
    ----------
    name : str
    hz : float or None
        Processor clock [Hz]; None where time is not the program's to fill.
    word_bits : int
        Of a program's words: 8 numbers 256 registers.
    arena : int
        Memory of one program, its bytes and its registers [bytes].
    channels : int
        Numbers in a sample: x, v, F and what is watched.
    T_max : float
        Longest period [s].
    """

    name: str
    hz: float | None
    word_bits: int
    arena: int
    channels: int
    T_max: float = 10e-3


#: arena, channels and T_max are those of firmware/boards/*/board_constants.h; a test compares them
BOARDS = {
    b.name: b
    for b in (
        Board("uno", 16e6, 8, 848, 8),
        Board("cortex-m0+", 125e6, 8, 16_384, 16),
        Board("cortex-m4f", 168e6, 8, 16_384, 16),
        Board("host", None, 16, 1 << 20, 16),
    )
}
