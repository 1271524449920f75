"""A float32 program as bytes for the firmware's virtual machine, and back to words a person reads.

::

    header      36 bytes, little endian, see HEADER
    constants   4 bytes each: the bits of a float, an int32, or 0 and 1
    init, tick  words: opcode, destination, operands; END closes each
    moves       pairs of words (to, from) that carry next states home, first init's, then the tick's
    outputs     one word, a register, each
    types       one byte for each constant, parameter, input, state and output
    CRC-32      of everything before it

A word is 1 byte on small boards (256 registers) or 2. The registers are constants, parameters, inputs, states, then
temporaries, which alone are written by instructions and are shared by linear scan (Poletto and Sarkar, 1999).
"""

import struct
import zlib
from dataclasses import dataclass

from ...errors import ProgramError, ProgramLimitError
from ..ir.operations import OPERATIONS
from ..ir.program import LEAVES

OPCODES = {name: operation.opcode for name, operation in OPERATIONS.items() if operation.opcode}
END = 0
TYPE_CODES = {"f32": 1, "bool": 2, "i32": 3}
KIND_CODES = {"R": 1, "B": 2, "I": 3}
#: what hl_verify, hl_init and hl_tick return, and what each means
RESULTS = {
    "OK": (0, "nothing is wrong"),
    "SIZE": (1, "the program is incomplete, or longer than its header says: send it again"),
    "MAGIC": (2, "these bytes are not a program: send one made by hapticlab"),
    "VERSION": (3, "another format version: flash the firmware of this hapticlab"),
    "WORD": (4, "another word size: encode the program for this board"),
    "TABLE": (5, "another table of operations: flash the firmware of this hapticlab"),
    "CRC": (6, "the program was changed during transfer: send it again"),
    "REGISTERS": (7, "more registers than the board has: use a smaller scene or fewer substeps"),
    "TYPE": (8, "a type byte or a bool constant has no meaning"),
    "OPCODE": (9, "an instruction has no meaning, or the code does not end where it should"),
    "OPERAND": (10, "an operand is not an earlier result of the right type"),
    "UNSET": (11, "a state or an output has no value of its type"),
    "OUTPUT_NOT_FINITE": (12, "an output is nan or infinite: look for a division by zero or an unstable scene"),
    "STATE_NOT_FINITE": (13, "a state is nan or infinite: look for a division by zero or an unstable scene"),
}
MAGIC, VERSION = b"HLVM", 1
#: magic, version, bytes a word, hash of the table, period [us], registers, constants, parameters, inputs, states,
#: outputs, words of init, of tick, moves of init, of tick
HEADER = struct.Struct("<4sBBHII10H")
COUNTS = (
    *("registers", "constants", "parameters", "inputs", "states", "outputs"),
    *("init_words", "tick_words", "init_moves", "tick_moves"),
)


def table_hash():
    """Return the CRC-32 of every number that a board and this package must agree on."""
    signatures = [(o.name, o.opcode, o.operands, o.result) for o in OPERATIONS.values() if o.opcode]
    results = [(name, number) for name, (number, _) in RESULTS.items()]
    return zlib.crc32(repr((VERSION, HEADER.format, signatures, TYPE_CODES, results)).encode())


def encode(program, *, word_bits=16):
    """Return the program as bytes for the virtual machine.

    Parameters
    ----------
    program : Program
        Of float32, bool and int32 values alone.
    word_bits : {8, 16}
        8 for a small board, at most 256 registers; 16 for this computer.

    Raises
    ------
    ProgramError
        If it holds float64 values, or T is not within a thousandth of whole microseconds.
    ProgramLimitError
        If the program has more registers or instructions than its words can number.

    Examples
    --------
    >>> from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
    >>> x, y = Instruction("input", (), "f32"), Instruction("neg", (0,), "f32")
    >>> p = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), Block((x, y), outputs=(1,)), T=1e-3)
    >>> len(encode(p, word_bits=8))
    48
    """
    if word_bits not in (8, 16):
        raise ProgramError(f"word_bits = {word_bits}; needs 8 or 16")
    _require_float32(program.verify())
    fixed = (program.parameters, program.inputs, program.states)
    constants = _constants(program)
    file = _Registers(constants, *(len(channels) for channels in fixed))
    blocks = [_allocate(program.init, file), _allocate(program.tick, file)]
    types = [type for type, _ in constants] + [c.type for channels in fixed for c in channels]
    types += [c.type for c in program.outputs]
    code = [words for words, _, _ in blocks]
    moves = [move for _, move, _ in blocks]
    counts = (file.first_temporary + file.temporaries, len(constants), *map(len, fixed), len(program.outputs))
    counts += (*map(len, code), *map(len, moves))
    _check_limits(program, counts, word_bits)
    words = [*code[0], *code[1], *(w for pairs in moves for pair in pairs for w in pair), *blocks[1][2]]
    period = _microseconds(program)
    body = HEADER.pack(MAGIC, VERSION, word_bits // 8, 0, table_hash(), period, *counts)
    body += b"".join(bits for _, bits in constants)
    body += struct.pack(f"<{len(words)}{'B' if word_bits == 8 else 'H'}", *words)
    body += bytes(TYPE_CODES[t] for t in types)
    return body + struct.pack("<I", zlib.crc32(body))


def _microseconds(program):
    """Return the period as the whole number a board's timer counts."""
    exact = program.T * 1e6
    nearest = min(max(1, round(exact)), 2**32 - 1)
    if abs(exact - nearest) > 1e-3:
        raise ProgramError(
            f"{program.name}: T = {program.T:g} s; a board's timer counts whole microseconds, at least 1: "
            f"the nearest is T={nearest}e-6"
        )
    return nearest


def _require_float32(program):
    channels = (*program.inputs, *program.parameters, *program.states, *program.outputs)
    values = [i for block in (program.init, program.tick) for i in block.instructions]
    if any(v.type == "f64" for v in (*values, *channels)):
        raise ProgramError(f'{program.name}: has float64 values; the virtual machine takes dtype="float32" alone')


def _bits(instruction):
    return struct.pack("<f" if instruction.type == "f32" else "<i", instruction.value)


def _constants(program):
    """Return the distinct (type, bits) of both blocks, in order of appearance."""
    everything = (*program.init.instructions, *program.tick.instructions)
    return list(dict.fromkeys((i.type, _bits(i)) for i in everything if i.op == "const"))


class _Registers:
    """Where every leaf lives, and how many temporaries the blocks have needed so far."""

    def __init__(self, constants, parameters, inputs, states):
        self.constants = {c: k for k, c in enumerate(constants)}
        self.first = {"param": len(constants), "input": len(constants) + parameters}
        self.first["state"] = self.first["input"] + inputs
        self.first_temporary = self.first["state"] + states
        self.temporaries = 0

    def of_leaf(self, i):
        return self.constants[i.type, _bits(i)] if i.op == "const" else self.first[i.op] + i.index


def _allocate(block, file):
    """Give a block its registers; return its words, its state moves and its output registers."""
    last_use = {a: k for k, i in enumerate(block.instructions) for a in i.args}
    last_use.update(dict.fromkeys((*block.outputs, *block.states), len(block.instructions)))
    where, free, words, used = [], [], [], 0
    for k, i in enumerate(block.instructions):
        if i.op in LEAVES:
            where.append(file.of_leaf(i))
            continue
        # an operand used here for the last time gives its register to the result: bodies read before they write
        free += [where[a] for a in dict.fromkeys(i.args) if last_use[a] == k and where[a] >= file.first_temporary]
        if not free:
            free.append(file.first_temporary + used)
            used += 1
        where.append(free.pop())
        words += [OPCODES[i.op], where[k], *(where[a] for a in i.args)]
        if k not in last_use:
            free.append(where[k])
    moves = {file.first["state"] + n: where[k] for n, k in enumerate(block.states)}
    spare = file.first_temporary + used
    moves = _in_sequence(moves, spare)
    used += any(to == spare for to, _ in moves)
    file.temporaries = max(file.temporaries, used)
    return [*words, END], moves, [where[k] for k in block.outputs]


def _in_sequence(moves, spare):
    """Order moves that mean to happen at once, so that no source is overwritten; a cycle goes through the spare."""
    waiting = {to: source for to, source in moves.items() if to != source}
    done = []
    while waiting:
        to = next((t for t in waiting if t not in waiting.values()), None)
        if to is not None:
            done.append((to, waiting.pop(to)))
            continue
        to = next(iter(waiting))  # only cycles are left: save one value, whoever needs it takes it from the spare
        done.append((spare, to))
        waiting = {t: spare if source == to else source for t, source in waiting.items()}
    return done


def _check_limits(program, counts, word_bits):
    size = dict(zip(COUNTS, counts, strict=True))
    most = 1 << word_bits
    if size["registers"] > min(most, 65535):
        over = size["registers"] - min(most, 65535)
        raise ProgramLimitError(
            f"{program.name}: {size['registers']} registers; {'an 8' if word_bits == 8 else 'a 16'}-bit word numbers "
            f"{min(most, 65535)}, {over} too many: use fewer parameters, states or substeps"
        )
    for name, count in size.items():
        if count > 65535:
            raise ProgramLimitError(
                f"{program.name}: {count} {name}; a program holds 65535, {count - 65535} too many: use fewer substeps"
            )


@dataclass(frozen=True)
class Layout:
    """Where the parts of an encoded program begin [bytes]; ``size`` counts by name what the header counts."""

    word: int
    period_us: int
    size: dict
    constants: int
    init: int
    tick: int
    moves: int
    outputs: int
    types: int
    end: int


def layout(data):
    """Read the header of an encoded program."""
    magic, version, word, _, table, period, *counts = HEADER.unpack_from(data)
    if (magic, version, table) != (MAGIC, VERSION, table_hash()):
        raise ProgramError("not a program of this format and table of operations")
    size = dict(zip(COUNTS, counts, strict=True))
    init = HEADER.size + 4 * size["constants"]
    tick = init + word * size["init_words"]
    moves = tick + word * size["tick_words"]
    outputs = moves + 2 * word * (size["init_moves"] + size["tick_moves"])
    types = outputs + word * size["outputs"]
    end = types + sum(counts[1:6])
    return Layout(word, period, size, HEADER.size, init, tick, moves, outputs, types, end)


def words_of(data, begin, end, word):
    """Return the words between two byte positions."""
    return struct.unpack_from(f"<{(end - begin) // word}{'B' if word == 1 else 'H'}", data, begin)


def instructions_of(words):
    """Yield (position, name, registers) of a block's words; the first register is the destination."""
    names = {number: name for name, number in OPCODES.items()}
    k = 0
    while words[k] != END:
        name = names[words[k]]
        length = 2 + len(OPERATIONS[name].operands)
        yield k, name, words[k + 1 : k + length]
        k += length


def disassemble(data):
    """Return an encoded program as text, one line an instruction.

    Examples
    --------
    >>> from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
    >>> x, y = Instruction("input", (), "f32"), Instruction("neg", (0,), "f32")
    >>> p = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), Block((x, y), outputs=(1,)), T=1e-3)
    >>> print(disassemble(encode(p)))
    54 bytes, words of 16 bits, T = 1000 us
      2 registers, 1 inputs, 1 outputs, 1 init_words, 4 tick_words
    init:
    tick:
      r1    neg      r0
      output   r1
    """
    at = layout(data)
    lines = [f"{len(data)} bytes, words of {8 * at.word} bits, T = {at.period_us} us"]
    lines.append("  " + ", ".join(f"{count} {name}" for name, count in at.size.items() if count))
    codes = {code: name for name, code in TYPE_CODES.items()}
    for k in range(at.size["constants"]):
        type = codes[data[at.types + k]]
        (value,) = struct.unpack_from("<f" if type == "f32" else "<i", data, at.constants + 4 * k)
        lines.append(f"  r{k:<4} {type:<5} const    {value:.9g}")
    moves = words_of(data, at.moves, at.outputs, at.word)
    split = 2 * at.size["init_moves"]
    blocks = ("init", at.init, at.tick, moves[:split]), ("tick", at.tick, at.moves, moves[split:])
    for name, begin, end, pairs in blocks:
        lines.append(f"{name}:")
        for _, op, registers in instructions_of(words_of(data, begin, end, at.word)):
            lines.append(f"  r{registers[0]:<4} {op:<8} " + "  ".join(f"r{r}" for r in registers[1:]))
        if name == "tick":
            lines += [f"  output   r{r}" for r in words_of(data, at.outputs, at.types, at.word)]
        lines += [f"  r{to:<4} next     r{source}" for to, source in zip(pairs[::2], pairs[1::2], strict=True)]
    return "\n".join(lines)
