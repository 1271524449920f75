"""What WebAssembly computes with: numbers of one lane, or of two at once in vectors of 128 bits.

Two numbers of float32, or two int32, fill a vector as a a b b, and a condition is two words of 64 ones or zeros. So what compares
float32 finds the same words as what compares float64, and every operation of one kind is one instruction.
"""

import functools
import struct
from dataclasses import dataclass, field

from ..ir.operations import OPERATIONS
from .wasm_words import LAYOUT, OPCODES, assemble, signed

#: a a b b of a b . ., and back; a shuffle chooses from two vectors, here none from the second
_DOUBLED = "f64.const 0 f64x2.splat i8x16.shuffle 0 1 2 3 0 1 2 3 4 5 6 7 4 5 6 7"
_SINGLE = "f64.const 0 f64x2.splat i8x16.shuffle 0 1 2 3 8 9 10 11 0 1 2 3 8 9 10 11"


@dataclass(frozen=True, eq=False)
class Lanes:
    """How so many lanes are computed at once.

    Attributes
    ----------
    types : dict
        Type in a program -> value type.
    reals : dict
        Real type -> what its instructions are named after.
    words : dict
        Operation, or (operation, type of its result) -> words in place of those of its record.
    load, load_shared, store : str
        One float64 a lane; the same one for all lanes.
    loaded, stored : dict
        float64 -> type of a channel, and back.
    needed : dict
        Of a condition: whether any lane chooses this.
    """

    count: int
    types: dict
    reals: dict
    load: str
    load_shared: str
    store: str
    loaded: dict
    stored: dict
    needed: dict
    words: dict = field(default_factory=dict)

    def words_of(self, op, type, operand):
        """Return the words of an operation of a program, by the types of its result and of its first operand.

        The names in its record: ``t`` and ``a`` are these types, ``convert`` goes from one real type to the other. Of a real
        operand, ``bits`` is the integer type of its width, reached from i32 by ``widen`` and left by ``narrow``; ``field`` are
        the ones of an exponent, ``low`` and ``high`` the least and the greatest of a normal number.

        Examples
        --------
        >>> ONE.words_of("lt", "bool", "f32"), TWO.words_of("lt", "bool", "f32")
        ('f32.lt', 'f32x4.lt')
        """
        names = {"t": self.reals.get(type), "a": self.reals.get(operand), "convert": _CONVERT[type == "f64"]}
        if operand in LAYOUT:
            bits, mantissa, bias = LAYOUT[operand]
            names |= {"bits": bits, "mantissa": mantissa, "bias": bias, "field": 2 * bias + 1, "low": 1 - bias, "high": bias}
            names |= {"widen": "i64.extend_i32_u" * (bits == "i64"), "narrow": "i32.wrap_i64" * (bits == "i64")}
        found = self.words.get(op) or self.words.get((op, type)) or OPERATIONS[op].wasm
        return found.format(**names)

    @functools.cache  # noqa: B019  there are two of these, for ever
    def operation(self, op, type, operand):
        """Return the bytes of an operation; see :meth:`words_of`."""
        return assemble(self.words_of(op, type, operand))

    @functools.cache  # noqa: B019
    def branch(self, chosen):
        """Return the bytes that begin an arm, after its condition."""
        return assemble(f"{self.needed[chosen]} if")

    def constant(self, value, type):
        """Return the bytes that push a constant."""
        if self.count == 1 and type not in LAYOUT:
            return OPCODES["i32.const"] + signed(int(value))
        bits = struct.pack({"f32": "<f", "f64": "<d"}.get(type, "<i"), -int(value) if type == "bool" else value)
        return OPCODES[f"{self.types[type]}.const"] + (bits if self.count == 1 else bits * (16 // len(bits)))


_CONVERT = "f32.demote_f64", "f64.promote_f32"
ONE = Lanes(
    1, types={"f32": "f32", "f64": "f64", "bool": "i32", "i32": "i32"}, reals={"f32": "f32", "f64": "f64"},
    load="f64.load", load_shared="f64.load", store="f64.store",
    loaded={"f64": "", "f32": "f32.demote_f64", "bool": "f64.const 0 f64.ne", "i32": "i32.trunc_sat_f64_s"},
    stored={"f64": "", "f32": "f64.promote_f32", "bool": "f64.convert_i32_u", "i32": "f64.convert_i32_s"},
    needed={True: "", False: "i32.eqz"},
)  # fmt: skip
_CLAMPED = "{real}.const {{low}} {{t}}.splat {{t}}.max {real}.const {{high}} {{t}}.splat {{t}}.min "
TWO = Lanes(
    2, types=dict.fromkeys(ONE.types, "v128"), reals={"f32": "f32x4", "f64": "f64x2"},
    load="v128.load", load_shared="v128.load64_splat", store="v128.store",
    loaded={
        "f64": "", "f32": f"f32x4.demote_f64x2_zero {_DOUBLED}", "bool": "f64.const 0 f64x2.splat f64x2.ne",
        "i32": f"i32x4.trunc_sat_f64x2_s_zero {_DOUBLED}",
    },
    stored={
        "f64": "", "f32": f"{_SINGLE} f64x2.promote_low_f32x4", "bool": "f64.const 1 f64x2.splat v128.and",
        "i32": f"{_SINGLE} f64x2.convert_low_i32x4_s",
    },
    needed={True: "v128.any_true", False: "i64x2.all_true i32.eqz"},
    words={
        "select": "v128.bitselect", "and": "v128.and", "or": "v128.or", "not": "v128.not", "iadd": "i32x4.add",
        ("itof", "f32"): "f32x4.convert_i32x4_s", ("itof", "f64"): f"{_SINGLE} f64x2.convert_low_i32x4_s",
        ("cast", "f64"): f"{_SINGLE} f64x2.promote_low_f32x4", ("cast", "f32"): f"f32x4.demote_f64x2_zero {_DOUBLED}",
        ("exp2i", "f32"): _CLAMPED.format(real="f32") + "i32x4.trunc_sat_f32x4_s "
        "i32.const {bias} i32x4.splat i32x4.add i32.const {mantissa} i32x4.shl",
        ("exp2i", "f64"): _CLAMPED.format(real="f64") + "i32x4.trunc_sat_f64x2_s_zero i64x2.extend_low_i32x4_s "
        "i64.const {bias} i64x2.splat i64x2.add i32.const {mantissa} i64x2.shl",
        ("exponent", "f32"): "i32.const {mantissa} i32x4.shr_u i32.const {field} i32x4.splat v128.and "
        "i32.const {bias} i32x4.splat i32x4.sub f32x4.convert_i32x4_s",
        ("exponent", "f64"): "i32.const {mantissa} i64x2.shr_u i64.const {field} i64x2.splat v128.and "
        "i64.const {bias} i64x2.splat i64x2.sub " + f"{_SINGLE} f64x2.convert_low_i32x4_s",
    },
)  # fmt: skip
