"""The one intermediate representation: a typed straight-line program.

An :class:`Instruction` names earlier results only, so a block can neither loop nor hang, and its cost is its list.
A :class:`Block` is a list of instructions with the results it hands out. A :class:`Program` is two blocks:
``init`` turns the first sample into the first states, ``tick`` turns a sample and the states into outputs and the next
states. Programs are built by tracing (:mod:`hapticlab.compiler.ir.trace`) and are immutable.
"""

import importlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real

import numpy as np

from ...base.facts import Fact, in_words
from ...base.grid import Grid
from ...base.shows_itself import ShowsItself
from ...errors import ProgramError
from ...scene.frozen import Frozen
from .operations import OPERATIONS

LEAVES = ("const", "param", "input", "state")
REAL_TYPES = ("f32", "f64")
TYPES = (*REAL_TYPES, "bool", "i32")
#: as operations name their operands and results
KINDS = {"f32": "R", "f64": "R", "bool": "B", "i32": "I"}
NUMPY_TYPE = {"f32": np.float32, "f64": np.float64, "bool": np.bool_, "i32": np.int32}


@dataclass(frozen=True, slots=True)
class Instruction:
    """One result. ``args`` are positions of earlier instructions; a leaf has a ``value`` (const) or an ``index``."""

    op: str
    args: tuple[int, ...]
    type: str
    value: float | int | bool = 0
    index: int = 0


@dataclass(frozen=True, slots=True)
class Channel:
    """A named, typed number with a unit: a parameter, an input, a state or an output; a parameter lies in low to high."""

    name: str
    unit: str = "1"
    type: str = "f32"
    low: float = -math.inf
    high: float = math.inf


@dataclass(frozen=True, slots=True)
class Block:
    """Instructions and the positions of what leaves the block: ``outputs`` of a tick, ``states`` for the next one."""

    instructions: tuple[Instruction, ...] = ()
    outputs: tuple[int, ...] = ()
    states: tuple[int, ...] = ()

    def __len__(self):
        """Count the instructions that compute; leaves cost nothing."""
        return sum(i.op not in LEAVES for i in self.instructions)


#: lines of a listing that stand in a cell by themselves
LISTED = 60
#: what the facts of a program mean
MADE = {
    "substeps": "Steps of the method in a tick", "margin": "Longest stable step over the step taken",
    "hold": "How the equations see the handle between samples", "velocity": "Where v(n) comes from", "dtype": "Of its numbers",
}  # fmt: skip


@dataclass(frozen=True)
class Program(ShowsItself):
    """What runs at the sample rate.

    Attributes
    ----------
    name : str
    inputs, parameters, states, outputs : tuple of Channel
        The first output of a scene's program is the force F [N].
    init, tick : Block
        ``init`` sees inputs and parameters; ``tick`` sees the states too.
    T : float
        Sampling period [s].
    values : tuple of float
        One value per parameter, in SI; nan where none is bound yet.
    facts : dict, read-only
        How it was made (method, substeps, hold, velocity), for the listing and for whoever runs it.
    notes : tuple of str
        What was left out, what was chosen, and why.
    limits : dict name -> (low, value, high), read-only
        Between what a live parameter keeps a step stable, the others as bound, and the value it was bound to.
    """

    name: str
    inputs: tuple[Channel, ...]
    parameters: tuple[Channel, ...]
    states: tuple[Channel, ...]
    outputs: tuple[Channel, ...]
    init: Block
    tick: Block
    T: float
    values: tuple[float, ...] = ()
    facts: Mapping = field(default_factory=Frozen, hash=False)
    notes: tuple[str, ...] = ()
    limits: Mapping = field(default_factory=Frozen, hash=False)

    def __post_init__(self):
        # whoever compiles the same scene gets this very program: what one of them could change, all would see
        for name in ("facts", "limits"):
            given = getattr(self, name)
            object.__setattr__(self, name, given if isinstance(given, Frozen) else Frozen(given))

    def __len__(self):
        """Count the instructions of one tick."""
        return len(self.tick)

    @property
    def units(self):
        """The unit of each parameter and output, by its name."""
        return {channel.name: channel.unit for channel in (*self.parameters, *self.outputs)}

    @property
    def size(self):
        """The number of all instructions, of both blocks and leaves too: what a program takes in memory."""
        return len(self.init.instructions) + len(self.tick.instructions)

    @property
    def types(self):
        """The real types in use: ('f32',) for a board's program, both where a scene is linked to a paddle."""
        used = {i.type for block in (self.init, self.tick) for i in block.instructions}
        return tuple(t for t in REAL_TYPES if t in used)

    def verify(self):
        """Return self, or raise ProgramError naming the instruction that is wrong.

        Examples
        --------
        >>> from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
        >>> x = Instruction("input", (), "f32", index=0)
        >>> bad = Block((x, Instruction("sqrt", (1,), "f32")), outputs=(1,))
        >>> Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), bad, 1e-3).verify()
        Traceback (most recent call last):
        hapticlab.errors.ProgramError: p, tick, instruction 1 (sqrt): operand 1 is not an earlier result
        """
        self.check_interface()
        for name, block in (("init", self.init), ("tick", self.tick)):
            _verify_block(self, name, block)
        return self

    def check_interface(self):
        """Raise ProgramError where the channels, their values or T do not fit together; see :meth:`verify`."""
        name = self.name
        if len(self.values) != len(self.parameters):
            raise ProgramError(f"{name}: {len(self.parameters)} parameters but {len(self.values)} values")
        for channel, value in zip(self.parameters, self.values, strict=True):
            if not isinstance(value, Real) or isinstance(value, bool):
                raise ProgramError(f"{name}: {channel.name} = {value!r}; needs a number, nan where none is bound yet")
        if not (isinstance(self.T, Real) and math.isfinite(self.T) and self.T > 0):
            raise ProgramError(f"{name}: T = {self.T!r} s; a sampling period needs a finite T > 0")
        for channel in (*self.inputs, *self.parameters, *self.states, *self.outputs):
            if channel.type not in TYPES:
                raise ProgramError(f"{name}: {channel.name} is of type {channel.type!r}; needs one of {', '.join(TYPES)}")
        names = [channel.name for channel in self.outputs]
        for twice in names:
            if names.count(twice) > 1:
                raise ProgramError(f"{name}: {names.count(twice)} outputs have the name {twice}; give each a name of its own")

    def _sentence(self):
        method = self.facts.get("method")
        return f"program {self.name}: {len(self)} instructions per tick, every {1e3 * self.T:g} ms" + (
            f", by {method}" if method else ""
        )

    def _facts(self):
        values = zip(self.parameters, self.values, strict=True)
        shown = [Fact(c.name, value, c.unit, _stable(c.unit, *self.limits.get(c.name, ()))) for c, value in values]
        listed = {name: ", ".join(c.name for c in getattr(self, name)) for name in ("inputs", "states", "outputs")}
        meanings = ("What it reads at each sample", "What it keeps from tick to tick", "What it gives: the force first")
        shown += [Fact(name, listed[name], "", words) for name, words in zip(listed, meanings, strict=True)]
        return shown + [Fact(name, value, "", MADE.get(name, "")) for name, value in self.facts.items() if name != "method"]

    def _tables(self):
        # opened where a notebook asks: a board's cost is computed of programs, above this module
        costs = importlib.import_module("hapticlab.compiler.boards.cost")
        try:
            yield "on boards", costs.on_boards(self)
        except ProgramError as problem:
            yield "on boards", Grid({"": [str(problem)]})

    def _text(self):
        """The listing, cut: a notebook file has all of it in the details already."""
        lines = str(self).split("\n")
        more = len(lines) - LISTED
        return "\n".join(lines if more <= 0 else [*lines[:LISTED], f"... and {more} more lines: print(program) shows all"])

    def _details(self):
        if self.notes:
            yield f"Notes ({len(self.notes)})", "\n".join(self.notes)
        yield "Listing", str(self)

    def __str__(self):
        from_leaf = {"param": self.parameters, "input": self.inputs, "state": self.states}
        made = ", ".join(f"{k} = {v}" for k, v in self.facts.items())
        lines = [f"program {self.name}: T = {self.T:g} s, {len(self)} instructions per tick" + (f", {made}" if made else "")]
        for title, channels in (("inputs", self.inputs), ("states", self.states), ("outputs", self.outputs)):
            lines.append(f"  {title:<10} " + (", ".join(f"{c.name} [{c.unit}] {c.type}" for c in channels) or "none"))
        values = dict(zip(self.parameters, self.values, strict=True))
        shown = (f"{c.name} = {'?' if v != v else f'{v:g}'} {c.unit}" for c, v in values.items())
        lines.append(f"  {'parameters':<10} " + (", ".join(shown) or "none"))
        for name, block in (("init", self.init), ("tick", self.tick)):
            lines += [f"{name}:", *_list_block(block, from_leaf, self)]
        return "\n".join(lines + [f"note: {note}" for note in self.notes])


def _stable(unit, low=-math.inf, value=math.nan, high=math.inf):
    """Return the range of a live parameter in which the steps of a program are stable, in words."""
    first, last = (" ".join(in_words(float(end), unit)).strip() for end in (low, high))
    least = f"above {first}" if high == math.inf else f"from {first} "
    most = "" if high == math.inf else f"up to {last}"
    return "" if low == -math.inf and high == math.inf else f"Steps are stable {least if low > -math.inf else ''}{most}"


def _verify_block(program, name, block):
    leaves = {"param": program.parameters, "input": program.inputs, "state": program.states if name == "tick" else ()}
    for position, i in enumerate(block.instructions):
        problem = _problem(i, position, block.instructions, leaves)
        if problem:
            raise ProgramError(f"{program.name}, {name}, instruction {position} ({i.op}): {problem}")
    for kind, ids, channels in (
        ("state", block.states, program.states),
        ("output", block.outputs, program.outputs if name == "tick" else ()),
    ):
        if len(ids) != len(channels):
            raise ProgramError(f"{program.name}, {name}: gives {len(ids)} {kind}s, needs {len(channels)}")
        for position, (k, c) in enumerate(zip(ids, channels, strict=True)):
            if not (isinstance(k, int) and 0 <= k < len(block.instructions)) or block.instructions[k].type != c.type:
                raise ProgramError(f"{program.name}, {name}: {kind} {position} is not a result of type {c.type}")


def _problem(i, position, instructions, leaves):
    """Say in words what is wrong with an instruction, or return None."""
    if not isinstance(i.op, str):
        return "its operation is not a name"
    if i.type not in TYPES:
        return f"{i.type!r} is not a type"
    if not isinstance(i.args, tuple):
        return f"its operands are {i.args!r}; needs a tuple of positions"
    if i.op == "const":
        return _problem_of_constant(i.value, i.type)
    if i.op in leaves:
        if not (isinstance(i.index, int) and 0 <= i.index < len(leaves[i.op])):
            return f"there is no {i.op} {i.index} here"
        return None if leaves[i.op][i.index].type == i.type else f"{i.op} {i.index} is not {i.type}"
    if i.op not in OPERATIONS:
        return "no such operation"
    operation = OPERATIONS[i.op]
    kinds, result = operation.operands, operation.result
    if len(i.args) != len(kinds):
        return f"needs {len(kinds)} operands, has {len(i.args)}"
    for a in i.args:
        if not (isinstance(a, int) and 0 <= a < position):
            return f"operand {a} is not an earlier result"
    operand_types = [instructions[a].type for a in i.args]
    if "".join([KINDS[t] for t in operand_types]) != kinds:
        return f"takes {kinds}, was given {', '.join(operand_types)}"
    reals = {t for t in operand_types if t in REAL_TYPES}
    if KINDS[i.type] != result or len(reals) > 1:
        return f"gives {i.type} from {', '.join(operand_types)}"
    if i.op == "cast":
        return None if reals != {i.type} else "casts a type to itself"
    if result == "R" and reals and reals != {i.type}:
        return f"gives {i.type} from {', '.join(operand_types)}"
    return None


def _problem_of_constant(value, type):
    """Say in words why a constant is not a number of its type, or return None: every engine must read the same one."""
    if not isinstance(value, (bool, int, float)):
        return "its value is not a number"
    if type == "bool":
        return None if isinstance(value, bool) else f"{value!r} is not True or False"
    if type == "i32":
        whole = isinstance(value, int) and not isinstance(value, bool) and -(2**31) <= value < 2**31
        return None if whole else f"{value!r} is not an int32"
    try:
        with np.errstate(over="ignore"):
            rounded = (np.float32 if type == "f32" else np.float64)(value).item()
    except OverflowError:
        rounded = math.inf if value > 0 else -math.inf
    return None if rounded == value or value != value else f"{repr(value)[:40]} is not a {type}; its nearest is {rounded!r}"


def _list_block(block, leaves, program):
    names = {}
    lines = []
    for k, i in enumerate(block.instructions):
        if i.op == "const":
            names[k] = f"{i.value:.9g}" if i.type != "bool" else str(bool(i.value)).lower()
        elif i.op in leaves:
            names[k] = leaves[i.op][i.index].name
        else:
            names[k] = f"%{k}"
            lines.append(f"  %{k:<4} {i.type:<5} {i.op:<8} " + "  ".join(names[a] for a in i.args))
    for c, k in zip(program.outputs if block.outputs else (), block.outputs, strict=True):
        lines.append(f"  output {c.name} = {names[k]}")
    for c, k in zip(program.states, block.states, strict=True):
        lines.append(f"  next   {c.name} = {names[k]}")
    return lines
