"""WebAssembly's instructions: words of its text format as the bytes of its binary format.

Sections named here are those of the WebAssembly Core Specification 2.0, https://www.w3.org/TR/wasm-core-2/.
"""

import struct

#: value type of the specification (5.3.1) -> its byte
VALUE_TYPES = {"i32": 0x7F, "i64": 0x7E, "f32": 0x7D, "f64": 0x7C, "v128": 0x7B}
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
#: vectors (5.4.8): number after the byte 0xFD
_VECTOR = {
    10: "v128.load64_splat v128.store v128.const i8x16.shuffle",
    17: "i32x4.splat i64x2.splat f32x4.splat f64x2.splat",
    65: "f32x4.eq f32x4.ne f32x4.lt f32x4.gt f32x4.le f32x4.ge f64x2.eq f64x2.ne f64x2.lt f64x2.gt f64x2.le f64x2.ge",
    77: "v128.not v128.and v128.andnot v128.or v128.xor v128.bitselect v128.any_true",
    94: "f32x4.demote_f64x2_zero f64x2.promote_low_f32x4",
    103: "f32x4.ceil f32x4.floor",
    116: "f64x2.ceil f64x2.floor",
    171: "i32x4.shl i32x4.shr_s i32x4.shr_u i32x4.add",
    177: "i32x4.sub",
    195: "i64x2.all_true",
    199: "i64x2.extend_low_i32x4_s",
    203: "i64x2.shl i64x2.shr_s i64x2.shr_u i64x2.add",
    209: "i64x2.sub",
    224: "f32x4.abs f32x4.neg",
    227: "f32x4.sqrt f32x4.add f32x4.sub f32x4.mul f32x4.div f32x4.min f32x4.max",
    236: "f64x2.abs f64x2.neg",
    239: "f64x2.sqrt f64x2.add f64x2.sub f64x2.mul f64x2.div f64x2.min f64x2.max",
    248: "i32x4.trunc_sat_f32x4_s",
    250: "f32x4.convert_i32x4_s",
    252: "i32x4.trunc_sat_f64x2_s_zero",
    254: "f64x2.convert_low_i32x4_s",
}


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


OPCODES |= {word: b"\xfd" + unsigned(at + k) for at, words in _VECTOR.items() for k, word in enumerate(words.split())}
OPCODES["v128.load"] = b"\xfd\0\x03"  # 3: their alignment, 8 bytes
OPCODES |= {word: OPCODES[word] + b"\x03" for word in ("v128.load64_splat", "v128.store")}
#: words that a number follows, and what it is in bytes
_FOLLOWS = {
    **dict.fromkeys(("br_if", "local.get", "local.set", "local.tee"), lambda t: unsigned(int(t))),
    **dict.fromkeys(("f64.load", "f64.store", "v128.load", "v128.load64_splat", "v128.store"), lambda t: unsigned(int(t))),
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
        elif word == "i8x16.shuffle":
            code += bytes(int(next(words)) for _ in range(16))
    return code
