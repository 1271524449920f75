"""An independent reading of encoded programs: what a verifier must accept, written from the format's description."""

import struct
import zlib

from hapticlab.compiler.engines.bytecode import OPCODES, TYPE_CODES, layout, words_of
from hapticlab.compiler.ir.operations import OPERATIONS

KIND = {"R": TYPE_CODES["f32"], "B": TYPE_CODES["bool"], "I": TYPE_CODES["i32"]}
NAME = {number: name for name, number in OPCODES.items()}


def sealed(body):
    """Return a changed program, given without its CRC, with the CRC that belongs to it."""
    return bytes(body) + struct.pack("<I", zlib.crc32(bytes(body)))


def word_positions(data, part):
    """Return the byte positions of the words of "init", "tick", "moves" or "outputs"."""
    at = layout(data)
    ends = {"init": at.tick, "tick": at.moves, "moves": at.outputs, "outputs": at.types}
    return range(getattr(at, part), ends[part], at.word)


def with_word(data, position, value):
    """Return the program with one word changed and its CRC mended."""
    word = layout(data).word
    body = bytearray(data[:-4])
    body[position : position + word] = value.to_bytes(word, "little")
    return sealed(body)


def operand_positions(data, block):
    """Return (byte position, operation, which operand) of every operand of a block."""
    at = layout(data)
    positions = word_positions(data, block)
    words = words_of(data, positions.start, positions.stop, at.word)
    k, found = 0, []
    while words[k]:
        count = len(OPERATIONS[NAME[words[k]]].operands)
        found += [(positions[k + 2 + n], NAME[words[k]], n) for n in range(count)]
        k += 2 + count
    return found


def is_sound(data):
    """Tell whether every word of a program, whose header and CRC are right, is what it may be."""
    at = layout(data)
    n = at.size
    first_state = n["constants"] + n["parameters"] + n["inputs"]
    fixed = first_state + n["states"]
    declared = list(data[at.types : at.types + fixed])
    moves = words_of(data, at.moves, at.outputs, at.word)
    pairs = list(zip(moves[::2], moves[1::2], strict=True))
    init = dict(enumerate(declared[:first_state]))
    if not (_code(words_of(data, at.init, at.tick, at.word), init, fixed, n["registers"])):
        return False
    if not _moves(pairs[: n["init_moves"]], init, declared, first_state, n["registers"]):
        return False
    if any(k not in init for k in range(first_state, fixed)):
        return False
    tick = dict(enumerate(declared))
    if not _code(words_of(data, at.tick, at.moves, at.word), tick, fixed, n["registers"]):
        return False
    outputs = words_of(data, at.outputs, at.types, at.word)
    if any(tick.get(r) != data[at.types + fixed + k] for k, r in enumerate(outputs)):
        return False
    return _moves(pairs[n["init_moves"] :], tick, declared, first_state, n["registers"])


def _code(words, types, fixed, registers):
    words = list(words)
    while len(words) > 1:
        op = NAME.get(words[0])
        if op is None:
            return False
        kinds, result = OPERATIONS[op].operands, OPERATIONS[op].result
        if len(words) < 3 + len(kinds):
            return False
        to, operands = words[1], words[2 : 2 + len(kinds)]
        if [types.get(r) for r in operands] != [KIND[k] for k in kinds] or not fixed <= to < registers:
            return False
        types[to] = KIND[result]
        del words[: 2 + len(kinds)]
    return words == [0]


def _moves(pairs, types, declared, first_state, registers):
    for to, source in pairs:
        if source not in types or not first_state <= to < registers:
            return False
        if to < len(declared) and declared[to] != types[source]:
            return False
        types[to] = types[source]
    return True
