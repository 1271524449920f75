"""WebAssembly's instructions: words of its text format as the bytes of its binary format.

Sections named here are those of the WebAssembly Core Specification 2.0, https://www.w3.org/TR/wasm-core-2/.
"""

import functools
import struct

from ..ir.operations import OPERATIONS

#: value type of the specification (5.3.1) -> its byte
VALUE_TYPES = {"i32": 0x7F, "i64": 0x7E, "f32": 0x7D, "f64": 0x7C}
#: type in a program -> value type; a condition is 0 or 1
TYPES = {"f32": "f32", "f64": "f64", "bool": "i32", "i32": "i32"}
#: of a real type: integer of its width, bits of the mantissa, exponent bias
LAYOUT = {"f32": ("i32", 23, 127), "f64": ("i64", 52, 1023)}

#: word -> its bytes before what follows it; control (5.4.1), parametric (5.4.3), variable (5.4.4), memory (5.4.6)
OPCODES = {
    "block": b"\x02\x40", "loop": b"\x03\x40", "if": b"\x04\x40", "else": b"\x05", "end": b"\x0b", "br_if": b"\x0d",
    "select": b"\x1b", "local.get": b"\x20", "local.set": b"\x21", "local.tee": b"\x22",
    "f64.load": b"\x2b\x03", "f64.store": b"\x39\x03",
    "i32.const": b"\x41", "i64.const": b"\x42", "f32.const": b"\x43", "f64.const": b"\x44",
}  # fmt: skip
#: numeric (5.4.7): words in the order of their opcodes, from the first one's
_NUMERIC = {
    0x45: "i32.eqz i32.eq i32.ne i32.lt_s",
    0x5B: "f32.eq f32.ne f32.lt f32.gt f32.le f32.ge f64.eq f64.ne f64.lt f64.gt f64.le f64.ge",
    0x6A: "i32.add i32.sub i32.mul",
    0x71: "i32.and i32.or i32.xor i32.shl i32.shr_s i32.shr_u",
    0x86: "i64.shl i64.shr_s i64.shr_u",
    0x8B: "f32.abs f32.neg f32.ceil f32.floor f32.trunc f32.nearest f32.sqrt f32.add f32.sub f32.mul f32.div f32.min f32.max",
    0x99: "f64.abs f64.neg f64.ceil f64.floor f64.trunc f64.nearest f64.sqrt f64.add f64.sub f64.mul f64.div f64.min f64.max",
    0xA7: "i32.wrap_i64",
    0xAC: "i64.extend_i32_s i64.extend_i32_u",
    0xB2: "f32.convert_i32_s",
    0xB6: "f32.demote_f64 f64.convert_i32_s f64.convert_i32_u",
    0xBB: "f64.promote_f32 i32.reinterpret_f32 i64.reinterpret_f64 f32.reinterpret_i32 f64.reinterpret_i64",
}
OPCODES |= {word: bytes([first + k]) for first, words in _NUMERIC.items() for k, word in enumerate(words.split())}
OPCODES |= {"i32.trunc_sat_f32_s": b"\xfc\x00", "i32.trunc_sat_f64_s": b"\xfc\x02"}


def unsigned(number):
    """Return an unsigned LEB128 (5.2.2): seven bits a byte, the lowest first."""
    if number < 128:
        return bytes((number,))
    return bytes((number & 127 | 128,)) + unsigned(number >> 7)


def signed(number):
    """Return a signed LEB128 (5.2.2)."""
    low, rest = number & 127, number >> 7
    if rest == (-1 if low & 64 else 0):
        return bytes((low,))
    return bytes((low | 128,)) + signed(rest)


#: what follows a word, as bytes
_FOLLOWS = {
    **dict.fromkeys(("br_if", "local.get", "local.set", "local.tee", "f64.load", "f64.store"), lambda t: unsigned(int(t))),
    **dict.fromkeys(("i32.const", "i64.const"), lambda t: signed(int(t))),
    "f32.const": lambda t: struct.pack("<f", float(t)),
    "f64.const": lambda t: struct.pack("<d", float(t)),
}


def assemble(text):
    """Return words as bytes; the number after a load or a store is its offset [bytes], their alignment is 8.

    Examples
    --------
    >>> assemble("local.get 0 i32.const -1 i32.add").hex()
    '2000417f6a'
    """
    code, words = b"", iter(text.split())
    for word in words:
        code += OPCODES[word]
        if word in _FOLLOWS:
            code += _FOLLOWS[word](next(words))
    return code


def words(op, type, operand):
    """Return the words of an operation of a program, by the types of its result and of its first operand.

    The names in its record: ``t`` and ``a`` are these types, ``convert`` goes from one real type to the other. Of a real operand,
    ``bits`` is the integer type of its width, reached from i32 by ``widen`` and left by ``narrow``; ``field`` are the ones of an
    exponent, ``low`` and ``high`` the least and the greatest of a normal number.

    Examples
    --------
    >>> words("lt", "bool", "f32")
    'f32.lt'
    """
    names = {"t": TYPES[type], "a": TYPES[operand], "convert": "f64.promote_f32" if type == "f64" else "f32.demote_f64"}
    if operand in LAYOUT:
        bits, mantissa, bias = LAYOUT[operand]
        names |= {"bits": bits, "mantissa": mantissa, "bias": bias, "field": 2 * bias + 1, "low": 1 - bias, "high": bias}
        names |= {"widen": "i64.extend_i32_u" * (bits == "i64"), "narrow": "i32.wrap_i64" * (bits == "i64")}
    return OPERATIONS[op].wasm.format(**names)


@functools.cache
def operation(op, type, operand):
    """Return the bytes of an operation; see :func:`words`."""
    return assemble(words(op, type, operand))


def constant(value, type):
    """Return the bytes that push a constant of a type of a program."""
    if type in LAYOUT:
        return OPCODES[f"{type}.const"] + struct.pack("<f" if type == "f32" else "<d", value)
    return OPCODES["i32.const"] + signed(int(value))
