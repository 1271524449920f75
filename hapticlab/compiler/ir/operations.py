"""Every operation of a program: one record says all that is true of it, whoever asks.

The engines compute by it, the builder folds and simplifies by it, derivatives and series are written with it, a board's
bytes and headers are made of it. To add an operation, write its record here, its case in ``firmware/core/vm.c``, measure
what it costs (``tests/firmware/measure_costs.py``), and write the generated headers and golden programs anew.
"""

import operator
from collections.abc import Callable
from dataclasses import dataclass

from . import elementary, recurrences, simplify, values
from .recurrences import product, turned
from .structural_zeros import ZERO, is_zero, minus, plus
from .values import cos, select, sin


@dataclass(frozen=True)
class Operation:
    """One operation.

    Attributes
    ----------
    name : str
    operands, result : str
        Kinds, a letter each. R: real (f32 or f64, all alike), B: bool, I: i32.
    opcode : int or None
        Its number in the bytes of a program, a contract with boards already flashed: take the next free one, never change
        one. None where no board has it.
    compute : callable
        Its value from those of its operands: numbers and arrays by NumPy, in their own precision; traced values recorded.
    llvm : str
        Its lines, the last of them the result; none for an elementary function. {0}, {1}, {2} are the operands; the other
        names are those of :meth:`hapticlab.compiler.engines.llvm_emit.Writer.words`.
    wasm : str
        Its words in WebAssembly's text format, which take the operands from the stack (a select its condition last); none for
        an elementary function. The names are those of :func:`hapticlab.compiler.engines.wasm_lanes.Lanes.words_of`.
    c : str
        Its C expression, where the C of an elementary function uses it.
    derivative : tuple of callables (d, r, *operands) -> value
        By each operand: the rate d of that operand times the partial derivative; r is the result. None for a condition,
        empty for a step function.
    series : callable (rows, k, w, *operands) -> value, or None
        Coefficient k > 0 of its Taylor series, see :mod:`~hapticlab.compiler.ir.recurrences`; None for a step function.
    simpler : callable or None
        Its identities, see :mod:`~hapticlab.compiler.ir.simplify`.
    definition : callable or None
        An elementary function in terms of the other operations; the machine of a board has it as one instruction.
    family : str
        Elementary functions of one family share the reduction of their argument.
    commutes, converts : bool
        Its operands may change places; its result is its operand in another type, which the instruction names.
    work : int
        About how long it takes on a computer, in additions; costs.json has what it takes on boards, as measured.
    """

    name: str
    operands: str
    result: str
    opcode: int | None
    compute: Callable
    llvm: str = ""
    wasm: str = ""
    c: str = ""
    derivative: tuple = ()
    series: Callable | None = None
    simpler: Callable | None = None
    definition: Callable | None = None
    family: str = ""
    commutes: bool = False
    converts: bool = False
    work: int = 1


#: by way of the exponent field; the clamp comes first, so that the conversion to an integer is defined
_EXP2I = """\
{r}.a = fcmp ord {t} {0}, {zero}
{r}.b = select {bool} {r}.a, {t} {0}, {t} {zero}
{r}.c = fcmp olt {t} {r}.b, {low}
{r}.d = select {bool} {r}.c, {t} {low}, {t} {r}.b
{r}.e = fcmp olt {t} {high}, {r}.d
{r}.f = select {bool} {r}.e, {t} {high}, {t} {r}.d
{r}.g = fptosi {t} {r}.f to {i32}
{r}.h = add {i32} {r}.g, {bias}
{r}.i = {widen} {i32} {r}.h to {bits}
{r}.j = shl {bits} {r}.i, {mantissa}
bitcast {bits} {r}.j to {t}"""
#: the exponent field less its bias, whatever the sign
_EXPONENT = """\
{r}.a = bitcast {t} {0} to {bits}
{r}.b = lshr {bits} {r}.a, {mantissa}
{r}.c = and {bits} {r}.b, {field}
{r}.d = {narrow} {bits} {r}.c to {i32}
{r}.e = sub {i32} {r}.d, {bias}
sitofp {i32} {r}.e to {t}"""
#: the same two; min and max pass nan on, which the conversion makes 0
_EXP2I_WASM = """\
{t}.const {low} {t}.max {t}.const {high} {t}.min i32.trunc_sat_{t}_s i32.const {bias} i32.add
{widen} {bits}.const {mantissa} {bits}.shl {t}.reinterpret_{bits}"""
_EXPONENT_WASM = """\
{bits}.reinterpret_{t} {bits}.const {mantissa} {bits}.shr_u {narrow}
i32.const {field} i32.and i32.const {bias} i32.sub {t}.convert_i32_s"""

_RECORDS = (
    Operation(
        "neg", "R", "R", 1, operator.neg, llvm="fneg {t} {0}", wasm="{t}.neg", c="-{0}", simpler=simplify.negative,
        derivative=(lambda d, r, a: -d,),
        series=lambda rows, k, w, u: ZERO if is_zero(u[k]) else -u[k],
    ),
    Operation(
        "abs", "R", "R", 2, abs, llvm="call {t} @llvm.fabs.{s}({t} {0})", wasm="{t}.abs", c="hl_absf({0})",
        derivative=(lambda d, r, a: select(a < 0.0, -d, d),),
    ),
    Operation(
        "add", "RR", "R", 3, operator.add, llvm="fadd {t} {0}, {1}", wasm="{t}.add",
        c="{0} + {1}", simpler=simplify.total, commutes=True,
        derivative=(lambda d, r, a, b: d, lambda d, r, a, b: d),
        series=lambda rows, k, w, u, v: plus(u[k], v[k]),
    ),
    Operation(
        "sub", "RR", "R", 4, operator.sub, llvm="fsub {t} {0}, {1}", wasm="{t}.sub",
        c="{0} - {1}", simpler=simplify.difference,
        derivative=(lambda d, r, a, b: d, lambda d, r, a, b: -d),
        series=lambda rows, k, w, u, v: minus(u[k], v[k]),
    ),
    Operation(
        "mul", "RR", "R", 5, operator.mul, llvm="fmul {t} {0}, {1}", wasm="{t}.mul",
        c="{0} * {1}", simpler=simplify.product, commutes=True,
        derivative=(lambda d, r, a, b: d * b, lambda d, r, a, b: a * d),
        series=lambda rows, k, w, u, v: product(u, v, k),
    ),
    Operation(
        "div", "RR", "R", 6, operator.truediv, llvm="fdiv {t} {0}, {1}", wasm="{t}.div",
        c="{0} / {1}", simpler=simplify.quotient, work=5,
        derivative=(lambda d, r, a, b: d / b, lambda d, r, a, b: -(d * r) / b),
        series=recurrences.quotient,
    ),
    Operation(
        "sqrt", "R", "R", 7, values.sqrt, llvm="call {t} @llvm.sqrt.{s}({t} {0})", wasm="{t}.sqrt",
        c="sqrtf({0})", work=6,
        derivative=(lambda d, r, a: (0.5 * d) / r,),
        series=recurrences.root,
    ),
    Operation(
        "floor", "R", "R", 8, values.floor, llvm="call {t} @llvm.floor.{s}({t} {0})", wasm="{t}.floor",
        c="hl_floorf({0})",
    ),
    Operation("lt", "RR", "B", 9, operator.lt, llvm="fcmp olt {a} {0}, {1}", wasm="{a}.lt", c="{0} < {1}"),
    Operation("le", "RR", "B", 10, operator.le, llvm="fcmp ole {a} {0}, {1}", wasm="{a}.le", c="{0} <= {1}"),
    Operation(
        "eq", "RR", "B", 11, values.equal, llvm="fcmp oeq {a} {0}, {1}", wasm="{a}.eq",
        c="{0} == {1}", commutes=True,
    ),
    Operation(
        "and", "BB", "B", 12, operator.and_, llvm="select {a} {0}, {t} {1}, {t} {false}", wasm="i32.and",
        c="{0} & {1}",
        simpler=simplify.logic(False), commutes=True,
    ),
    Operation(
        "or", "BB", "B", 13, operator.or_, llvm="select {a} {0}, {t} {true}, {t} {1}", wasm="i32.or", c="{0} | {1}",
        simpler=simplify.logic(True), commutes=True,
    ),
    Operation(
        "not", "B", "B", 14, operator.invert, llvm="xor {t} {0}, {true}", wasm="i32.eqz",
        c="!{0}", simpler=simplify.negation,
    ),
    Operation(
        "select", "BRR", "R", 15, select, llvm="select {a} {0}, {t} {1}, {t} {2}", wasm="select",
        c="{0} ? {1} : {2}", simpler=simplify.choice,
        derivative=(None, lambda d, r, c, a, b: select(c, d, 0.0), lambda d, r, c, a, b: select(c, 0.0, d)),
        series=recurrences.choice,
    ),
    Operation(
        "sin", "R", "R", 16, sin, definition=elementary.sin, family="angle", work=20,
        derivative=(lambda d, r, a: d * cos(a),),
        series=lambda rows, k, w, u: turned(rows, k, u)[0],
    ),
    Operation(
        "cos", "R", "R", 17, cos, definition=elementary.cos, family="angle", work=20,
        derivative=(lambda d, r, a: -(d * sin(a)),),
        series=lambda rows, k, w, u: turned(rows, k, u)[1],
    ),
    Operation(
        "exp", "R", "R", 18, values.exp, definition=elementary.exp, work=20,
        derivative=(lambda d, r, a: d * r,),
        series=recurrences.exponential,
    ),
    Operation(
        "log", "R", "R", 19, values.log, definition=elementary.log, work=20,
        derivative=(lambda d, r, a: d / a,),
        series=recurrences.logarithm,
    ),
    Operation(
        "atan", "R", "R", 20, values.atan, definition=elementary.atan, work=20,
        derivative=(lambda d, r, a: d / (1.0 + a * a),),
        series=recurrences.arc_tangent,
    ),
    Operation(
        "tanh", "R", "R", 21, values.tanh, definition=elementary.tanh, work=20,
        derivative=(lambda d, r, a: d * (1.0 - r * r),),
        series=recurrences.hyperbolic_tangent,
    ),
    # 2**k for an integral k, clamped to the normal exponents of the type
    Operation("exp2i", "R", "R", 22, values.exp2i, llvm=_EXP2I, wasm=_EXP2I_WASM, c="hl_exp2if({0})"),
    # the exponent field of a positive normal number, as a real: floor(log2(a))
    Operation("exponent", "R", "R", 23, values.exponent, llvm=_EXPONENT, wasm=_EXPONENT_WASM, c="hl_exponentf({0})"),
    Operation("iadd", "II", "I", 24, values.iadd, llvm="add {t} {0}, {1}", wasm="i32.add", commutes=True),
    Operation("itof", "I", "R", 25, lambda a: a, llvm="sitofp {a} {0} to {t}", wasm="{t}.convert_i32_s", converts=True),
    # f32 <-> f64, only in programs that link a scene to a simulated paddle
    Operation(
        "cast", "R", "R", None, lambda a: a, llvm="{convert} {a} {0} to {t}", wasm="{convert}", converts=True,
        derivative=(lambda d, r, a: d,),
    ),
)  # fmt: skip
OPERATIONS = {operation.name: operation for operation in _RECORDS}
#: the functions that are defined by other operations -> their definitions
ELEMENTARY = {operation.name: operation.definition for operation in _RECORDS if operation.definition}
