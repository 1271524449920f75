"""What a program costs on a board, before it is sent: cycles, memory, and its share of the period.

A verified program is its list of instructions, so its time is a sum. Every operation has two figures, in costs.json,
which ``python tests/firmware/measure_costs.py`` measures and writes: what it takes with operands as scenes have them, and the
most that was found with any operands at all, denormals and nan included. A sine has a third, typical of angles beyond
an eighth of a turn.
"""

import functools
import json
import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..errors import EngineMissingError, ProgramError
from .bytecode import encode, instructions_of, layout, words_of
from .engine import load
from .ir import Channel, Program

COSTS = Path(__file__).with_name("costs.json")
#: the typical figure is right to this part; a scene that leaves less than it free does not fit
TYPICAL_ERROR = 0.1
#: the promised bound is this part above the worst found, for what a search may not find
SEARCH_MARGIN = 0.02
#: x and v, which a sample holds beside the program's outputs
OWN_CHANNELS = 2


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


@dataclass(frozen=True)
class Cost:
    """What a program takes of a board; printing it says so in words.

    Attributes
    ----------
    name, board, T
        Of the program, and the board's :class:`Board`.
    instructions, registers, bytes, outputs : int
        ``bytes`` as sent over the link.
    typical, bound : int
        Cycles of one tick of the program: with operands as scenes have them (numbers from 0.01 to 100, angles as in a
        second of :func:`reference_motion`), and the most with any operands.
    first : int
        Cycles at most that the first tick takes besides, to make the first states.
    step : (int, int)
        Cycles of the rest of a control step: sensor, position, safety, motor, record; typical and most.
    frame : (int, int)
        Cycles to send one tick's telemetry, a share ``1/every`` of a frame; typical and most.
    source : str
        How the figures were found.
    """

    name: str
    board: Board
    T: float
    instructions: int
    registers: int
    bytes: int
    outputs: int
    typical: int
    bound: int
    first: int = 0
    step: tuple = (0, 0)
    frame: tuple = (0, 0)
    source: str = "time is not limited"
    program: Program | None = field(default=None, repr=False, compare=False)

    @property
    def arena(self):
        """Memory on the board [bytes]: the program as sent, rounded to words of 4, then 4 a register."""
        return -(-self.bytes // 4) * 4 + 4 * self.registers

    @property
    def period(self):
        """Cycles of one period; None on a board whose time is not limited."""
        return self.board.hz and self.board.hz * self.T

    @property
    def share(self):
        """Typical part of the period that everything takes: scene, rest of the step, telemetry."""
        return self._sum(self.typical, 0) / self.period if self.period else 0.0

    @property
    def fits(self):
        """Whether the typical time fits with its error, and the memory too."""
        return self.memory_problem is None and (self.period is None or self.T >= self.T_needed())

    @property
    def promised(self):
        """Whether no step is late, whatever the operands are."""
        return self.memory_problem is None and (self.period is None or self.T >= self.T_needed(promise=True))

    @property
    def memory_problem(self):
        """What does not fit in memory, in words, or None."""
        if self.arena > self.board.arena:
            return f"needs {self.arena} bytes of memory; {self.board.name} has {self.board.arena}"
        if self.outputs + OWN_CHANNELS > self.board.channels:
            over = self.outputs + OWN_CHANNELS - self.board.channels
            return f"a sample of {self.board.name} has room for {self.board.channels - 3} watched channels; watch {over} fewer"
        return None

    def T_needed(self, promise=False):
        """Return the shortest period [s] that holds everything typically, and with ``promise`` every step at its most.

        Telemetry is sent between steps: it can wait for one that is long, but not for all.
        """
        typical = self._sum(self.typical * (1 + TYPICAL_ERROR), 0)
        longest = self.bound + self.step[1] if promise else 0
        return max(typical, longest) / self.board.hz

    def _sum(self, scene, which):
        return scene + self.step[which] + self.frame[which]

    def in_words(self, promise=False):
        """Return what part of the period a program that does not fit would take."""
        cycles = self.bound if promise else self.typical
        rest = self.step[promise] + (0 if promise else self.frame[0])
        return (
            f"{cycles / self.board.hz * 1e3:.2g} ms of a {self.T * 1e3:g} ms period on {self.board.name} "
            f"({cycles / self.period:.0%}, {'promised bound' if promise else 'typical'}), beside "
            f"{rest / self.board.hz * 1e3:.2g} ms for the rest of the step{'' if promise else ' and telemetry'}"
        )

    def __str__(self):
        lines = [
            f"{self.name} on {self.board.name}: {self.instructions} instructions, {self.bytes} bytes and "
            f"{self.registers} registers in {self.arena} of {self.board.arena} bytes"
        ]
        if self.period:
            longest = (self.bound + self.step[1]) / self.period
            lines += [
                f"  scene      {self.typical} cycles, at most {self.bound}; the first tick up to {self.first} more",
                f"  step       {self.step[0]} cycles, at most {self.step[1]}: sensor, safety, motor, record",
                f"  telemetry  {self.frame[0]} cycles, at most {self.frame[1]}",
                f"  together   {self.share:.0%} of {self.T * 1e3:g} ms; a step at most {longest:.0%}",
                f"  {self.verdict}; {self.source}",
            ]
        return "\n".join(lines)

    @property
    def verdict(self):
        """One of three answers, in words."""
        if self.promised:
            return "fits, promised for any operands"
        if self.fits:
            return "fits; with denormal or cancelling operands throughout a step could be late, which the board counts"
        return "does not fit"


def cost(program, board="uno", *, every=1):
    """Return what a program takes of a board.

    Parameters
    ----------
    program : Program
        Of float32 values.
    board : {"uno", "cortex-m0+", "cortex-m4f", "host"}
        The Uno was measured in emulation, the Cortexes are modelled.
    every : int
        Ticks per telemetry sample, >= 1.

    Returns
    -------
    Cost

    Raises
    ------
    ProgramError, ProgramLimitError

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.compiler.cost import cost
    >>> taken = cost(hl.compile(hl.wall()(k=150, x_o=0.01), T=1e-3))
    >>> taken.fits, taken.promised, taken.arena
    (True, True, 136)
    """
    given = board_named(board)
    if not (isinstance(every, int) and every >= 1):
        raise ProgramError(f"every = {every!r}; needs a whole number of ticks per sample, at least 1")
    data = encode(program, word_bits=given.word_bits)
    at = layout(data)
    size = at.size
    shape = size["registers"], len(data), size["outputs"]
    tick = [op for _, op, _ in instructions_of(words_of(data, at.tick, at.moves, at.word))]
    if not given.hz:
        return Cost(program.name, given, at.period_us * 1e-6, len(tick), *shape, 0, 0, program=program)
    init = [op for _, op, _ in instructions_of(words_of(data, at.init, at.tick, at.word))]
    table = tables()[given.name]
    of, around = table["operations"], table["overheads"]
    states = sum(around[f"state {c.type}"] for c in program.states)
    outside = around["tick"] + states + size["tick_moves"] * around["move"]
    outside += sum(around[f"output {c.type}"] for c in program.outputs)
    first = around["init"] + states + size["init_moves"] * around["move"] + sum(of[op][1] for op in init)
    typical = round(outside + sum(of[op][0] for op in tick) + _far_angles(program, of))
    worst = outside + sum(of[op][1] for op in tick)
    sample = table["sample_bytes"] + 4 * (size["outputs"] + OWN_CHANNELS)
    frame = tuple(math.ceil((fixed + each * sample) / every) for fixed, each in table["frame"])
    return Cost(
        program.name, given, at.period_us * 1e-6, len(tick), *shape, typical, _promised(worst), _promised(first),
        tuple(table["step"]), frame, table["source"], program,
    )  # fmt: skip


def reference_motion(ticks, T):
    """Return a smooth motion of the handle, five sines of 4 mm each [m]; what a program's angles are looked at with."""
    at = np.arange(ticks) * T
    return 4e-3 * sum(np.sin(w * at + phase) for w, phase in ((3, 3.1), (7, 5.7), (11, 0.9), (17, 5.7), (29, 1.9)))


def _far_angles(program, of):
    """Return the cycles that sines and cosines take more, since some angles are beyond an eighth of a turn.

    The machine of this computer runs the program for a second. Where it cannot, or a parameter has no value, none are.
    """
    turned = [i for i in program.tick.instructions if i.op in ("sin", "cos")]
    if not turned or len(program.inputs) != 1 or any(v != v for v in program.values):
        return 0
    outputs = tuple(Channel(f"angle{k}") for k in range(len(turned)))
    tick = replace(program.tick, outputs=tuple(i.args[0] for i in turned))
    try:
        machine = load(replace(program, tick=tick, outputs=outputs), "vm")
    except EngineMissingError:
        return 0
    ticks = max(10, round(1 / program.T))
    angles = machine.run(ticks, reference_motion(ticks, program.T)[:, None]).outputs[..., 0]
    far = (np.abs(angles) > math.pi / 4).mean(axis=0)
    return sum((of[i.op][2] - of[i.op][0]) * part for i, part in zip(turned, far, strict=True))


def _promised(cycles):
    return math.ceil(cycles * (1 + SEARCH_MARGIN))


def board_named(name):
    """Return a board's table entry, or raise ProgramError that lists them."""
    if isinstance(name, Board):
        return name
    if name not in BOARDS:
        raise ProgramError(f"board = {name!r}; needs one of {', '.join(BOARDS)}")
    return BOARDS[name]


@functools.cache
def tables():
    """Return costs.json."""
    return json.loads(COSTS.read_text(encoding="utf-8"))
