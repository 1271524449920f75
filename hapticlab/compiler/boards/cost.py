"""What a program costs on a board, before it is sent: cycles, memory, and its share of the period.

A verified program is its list of instructions, so its time is a sum. Every operation has two figures, in costs.json,
which ``python tests/firmware/measure_costs.py`` measures and writes: what it takes with operands as scenes have them, and the
most that was found with any operands at all, denormals and nan included. A sine has a third, typical of angles beyond
an eighth of a turn. The rest of a step was measured in the same way; what the link takes is in link_traffic.py.
"""

import functools
import json
import math
from dataclasses import dataclass, field
from pathlib import Path

from ...base.grid import Grid
from ...base.shows_itself import ShowsItself
from ...errors import ProgramError
from ..engines.bytecode import encode, instructions_of, layout, words_of
from ..engines.skipped_arms import Arm, Demand
from ..ir.program import Program
from .board_records import BOARDS, Board
from .cost_plot import plot_cost
from .large_angles import far_angles
from .link_traffic import Traffic

COSTS = Path(__file__).with_name("costs.json")
#: the typical figure is right to this part; a scene that leaves less than it free does not fit
TYPICAL_ERROR = 0.1
#: the promised bound is this part above the worst found, for what a search may not find
SEARCH_MARGIN = 0.02
#: x and v, which a sample holds beside the program's outputs
OWN_CHANNELS = 2
#: channels of the sample in the longest step that was measured
STEP_CHANNELS = 8


@dataclass(frozen=True)
class Cost(ShowsItself):
    """What a program takes of a board; printing it says so in words.

    Attributes
    ----------
    name, board
        Of the program, and the board's :class:`Board`.
    T : float
        Period of the program [s].
    instructions, registers, bytes, outputs : int
        ``bytes`` as sent over the link.
    typical, bound : int
        Cycles of one tick of the program: with operands as scenes have them (numbers from 0.01 to 100, angles as in a
        second of :func:`~hapticlab.compiler.boards.large_angles.reference_motion`), and the most with any operands.
    first : int
        Cycles at most that the first tick takes besides, to make the first states.
    step : (int, int, int)
        Cycles of the rest of a control step: sensor, position, safety, motor, record. Typical; the most that was measured
        in motion or while a force fades, and 4 us to set the next tick; the bound: that, what awkward operands were found
        to add, and 2 %.
    traffic : Traffic
        What the link takes.
    late : int
        Cycles by which a step may begin late, while the loop holds it off to copy numbers of one tick.
    edges : float
        Cycles a second of an encoder's interrupts; 0 unless ``edges_per_second`` was given.
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
    step: tuple = (0, 0, 0)
    traffic: Traffic = field(default_factory=Traffic)
    late: int = 0
    edges: float = 0.0
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
    def frame(self):
        """Typical cycles of one tick's telemetry: a share 1/every of a frame."""
        return math.ceil(self.traffic.telemetry / self.traffic.every)

    @property
    def share(self):
        """Typical part of the period that everything takes: scene, rest of the step, telemetry, edges."""
        return (self.typical + self.step[0] + self.frame) / self.period + self.edges / self.board.hz if self.period else 0.0

    @property
    def fits(self):
        """Whether, with operands as scenes have them, no step is late and no sample lost while parameters are set."""
        return self.memory_problem is None and self._holds(self.T)

    @property
    def promised(self):
        """Whether it fits, and no step is late whatever the operands are."""
        return self.memory_problem is None and self._holds(self.T, promise=True)

    @property
    def of_cases(self):
        """Typical cycles of what only some cases need, such as the forces of contacts: a board takes them in every tick."""
        if not self.period:
            return 0
        tick, of = self.program.tick, tables()[self.board.name]["operations"]
        arms = [item for item in Demand(tick).arranged(range(len(tick.instructions))) if isinstance(item, Arm)]
        ops = [tick.instructions[k].op for arm in arms for k in arm.positions()]
        return round(sum(of[op][0] for op in ops if op in of))

    @property
    def memory_problem(self):
        """What does not fit in memory, in words, or None."""
        if self.arena > self.board.arena:
            return f"needs {self.arena} bytes of memory; {self.board.name} has {self.board.arena}"
        if self.outputs + OWN_CHANNELS > self.board.channels:
            over = self.outputs + OWN_CHANNELS - self.board.channels
            return f"a sample of {self.board.name} has room for {self.board.channels - 3} watched channels; watch {over} fewer"
        return None

    def longest(self, promise=False, T=None):
        """Return the most cycles of one step at this period, or another, all that interrupts it included.

        Typically the scene takes its typical time, the rest its most in motion, while a sample is sent and the largest SET
        comes or is obeyed; or the scene takes :data:`TYPICAL_ERROR` more, in a step where no SET comes. With ``promise``
        all is at its bound, in the first tick too, and both lines of the link are full.
        """
        T = self.T if T is None else T
        if promise:
            step = self.bound + self.step[2] + self.traffic.interrupts(T, self.first, self.late)
        else:
            step = self.typical + self.step[1] + self.traffic.usual_interrupts(T, self.late)
            step = max(step, self.typical * (1 + TYPICAL_ERROR) + self.step[0] + self.frame)
        return math.ceil(step + self.edges * T)

    def _holds(self, T, promise=False):
        """Whether a period [s] is long enough for each step, and for telemetry and answers between steps."""
        if not self.board.hz:
            return True
        free = (self.board.hz - self.edges) * T - self.typical - self.step[0]
        enough = all(self.longest(p, T) <= self.board.hz * T for p in {False, promise})
        return enough and self.traffic.leaves_room(free, T)

    def T_needed(self, promise=False):
        """Return the shortest period [s] that fits, and with ``promise`` holds every step at its most."""
        low, high = 0.0, 1e-3
        while not self._holds(high, promise) and high < 1e3:
            high *= 2
        while high - low > 1e-9:  # by halves: a period is enough or not, and the answer must be enough
            middle = (low + high) / 2
            low, high = (low, middle) if self._holds(middle, promise) else (middle, high)
        return high

    def in_words(self, promise=False):
        """The part of the period taken by a program that does not fit, in words."""
        cycles = self.bound if promise else self.typical
        rest, needed = self.longest(promise) - cycles, self.T_needed(promise)
        return (
            f"{cycles / self.board.hz * 1e3:.2g} ms of a {self.T * 1e3:g} ms period on {self.board.name} "
            f"({cycles / self.period:.0%}, {'guaranteed bound' if promise else 'typical'}), in addition to up to "
            f"{rest / self.board.hz * 1e3:.2g} ms for the rest of the step and for interruptions by the link; with "
            f"telemetry it needs T >= {needed * 1e3:.3g} ms"
        )

    def plot(self):
        """Return a figure: what a step takes of its period, typically and at most."""
        return plot_cost(self)

    _hidden = ("board", "step", "traffic")

    def __str__(self):
        lines = [
            f"{self.name} on {self.board.name}: {self.instructions} instructions, {self.bytes} bytes and "
            f"{self.registers} registers in {self.arena} of {self.board.arena} bytes"
        ]
        if self.period:
            most = math.ceil(self.traffic.interrupts(self.T))
            encoder = f"{self.edges:.0f} cycles per second" if self.edges else "none counted"
            lines += [
                f"  scene      {self.typical} cycles, at most {self.bound}; the first tick up to {self.first} more",
                *(
                    [f"cases      {self.of_cases} of these for cases that may not hold but are computed in any case"]
                    if self.of_cases
                    else []
                ),
                f"  step       {self.step[0]} cycles, {self.step[1]} in motion, at most {self.step[2]}: sensor, motor, record",
                f"  link       {self.frame} cycles of telemetry; up to {most} interrupt one step",
                f"  encoder    {encoder} for edges of a quadrature encoder",
                f"  together   {self.share:.0%} of {self.T * 1e3:g} ms; a step up to {self.longest() / self.period:.0%}, at "
                f"most {self.longest(True) / self.period:.0%}",
                f"  {self.verdict}; {self.source}",
            ]
        return "\n".join(lines)

    @property
    def verdict(self):
        """One of three answers, in words."""
        if self.promised:
            return "fits, guaranteed for any operands"
        if self.fits:
            return "fits; a step could be late if all its operands are denormal or cancel, and the board counts late steps"
        return "does not fit"


def cost(program, board="uno", *, every=1, edges_per_second=0.0):
    """The cycles and memory that a program takes of a board.

    Parameters
    ----------
    program : Program
        Of float32 values.
    board : {"uno", "pico", "cortex-m4f", "host"}
        The Uno was measured in emulation, the Cortexes are modelled.
    every : int
        Ticks per telemetry sample, >= 1.
    edges_per_second : float
        Of a quadrature encoder at the handle's greatest speed, >= 0: each interrupts a step.

    Returns
    -------
    Cost

    Raises
    ------
    ProgramError, ProgramLimitError

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.compiler.boards.cost import cost
    >>> taken = cost(hl.compile(hl.wall()(k=150, x_o=0.01), T=2e-3))
    >>> taken.fits, taken.promised, taken.arena
    (True, True, 136)
    """
    return costs(program, [board], every=every, edges_per_second=edges_per_second)[0]


def costs(program, boards, *, every=1, edges_per_second=0.0):
    """Return the :func:`cost` on each of several boards, of a program that is encoded once."""
    given = [*map(board_named, boards)]
    if not (isinstance(every, int) and every >= 1):
        raise ProgramError(f"every = {every!r}; needs a whole number of ticks per sample, at least 1")
    if not edges_per_second >= 0:
        raise ProgramError(f"edges_per_second = {edges_per_second!r}; needs a number of edges, at least 0")
    data = {bits: encode(program, word_bits=bits) for bits in {board.word_bits for board in given}}
    far = far_angles(program) if any(board.hz for board in given) else []
    return [_cost(program, board, data[board.word_bits], far, every, edges_per_second) for board in given]


def on_boards(program):
    """The table of what a program takes on every board whose time is limited."""
    found = costs(program, [board for board in BOARDS.values() if board.hz])
    columns = {"board": [one.board.name for one in found], "of the period": [f"{one.share:.0%}" for one in found]}
    columns["bytes"] = [f"{one.arena} of {one.board.arena}" for one in found]
    return Grid({**columns, "verdict": [one.verdict for one in found]})


def _cost(program, given, data, far, every, edges_per_second):
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
    typical = round(outside + sum(of[op][0] for op in tick) + sum((of[op][2] - of[op][0]) * part for op, part in far))
    worst = outside + sum(of[op][1] for op in tick)
    bounds = [math.ceil(cycles * (1 + SEARCH_MARGIN)) for cycles in (worst, first)]
    spared = table.get("channel", 0) * max(0, STEP_CHANNELS - size["outputs"] - OWN_CHANNELS)
    step = table["step"][0], *(most - spared for most in table["step"][1:])
    traffic = Traffic.of(table, channels=size["outputs"] + OWN_CHANNELS, parameters=len(program.parameters), every=every)
    return Cost(
        program.name, given, at.period_us * 1e-6, len(tick), *shape, typical, *bounds,
        step, traffic, table["late"], table["edge"] * edges_per_second, table["source"], program,
    )  # fmt: skip


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
