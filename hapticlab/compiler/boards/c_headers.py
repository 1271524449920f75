"""Write firmware/generated: the tables that Python owns and the elementary functions, as C99.

Run ``python -m hapticlab.compiler.boards.c_headers FOLDER`` after changing a table; a test proves the committed files fresh.
"""

import math
import struct
import sys
from pathlib import Path

from ..engines.bytecode import COUNTS, END, HEADER, KIND_CODES, MAGIC, RESULTS, TYPE_CODES, VERSION, table_hash
from ..ir.operations import ELEMENTARY, OPERATIONS
from ..ir.program import LEAVES
from ..ir.trace import Builder

NOTICE = "/* Written by hapticlab/compiler/boards/c_headers.py: change the Python tables, not this file. */\n"
_C_TYPE = {"f32": "float", "bool": "int"}
#: functions that an AVR's compiler can make 1 300 bytes smaller in all, for 1 % more cycles at the most
MADE_SMALL = ("exp", "log", "tanh")


def generate():
    """Return the generated files, name to text."""
    return {"opcodes.h": _opcodes(), "elementary.h": _elementary_header(), "elementary.c": _elementary_source()}


def _opcodes():
    lines = [NOTICE, "#ifndef HL_OPCODES_H", "#define HL_OPCODES_H", ""]
    lines += [f"#define HL_TABLE_HASH 0x{table_hash():08x}UL", f"#define HL_FORMAT_VERSION {VERSION}"]
    lines += [f"#define HL_MAGIC_{k} 0x{byte:02x}" for k, byte in enumerate(MAGIC)]
    lines += [f"#define HL_HEADER_BYTES {HEADER.size}", f"#define HL_OP_END {END}", ""]
    lines += ["/* order of the counts in the header, 16 bits each */", "enum {"]
    lines += [f"    HL_COUNT_{name.upper()}," for name in COUNTS] + ["    HL_COUNTS", "};", ""]
    lines += ["enum {"] + [f"    HL_TYPE_{name.upper()} = {code}," for name, code in TYPE_CODES.items()] + ["};", ""]
    lines += ["/* what hl_verify, hl_init and hl_tick return */", "typedef enum {"]
    lines += [f"    HL_{name} = {number}, /* {meaning} */" for name, (number, meaning) in RESULTS.items()]
    lines += ["} hl_result;", ""]
    lines += ["/* X(name, number, operands, type of the result, types of the operands or 0) */"]
    lines += ["#define HL_OPERATIONS(X) \\"]
    lines += [f"    X({', '.join(map(str, row))}) \\" for row in _rows()]
    return "\n".join(lines)[:-2] + "\n\n#endif\n"


def _rows():
    for o in OPERATIONS.values():
        if o.opcode:
            operands = [KIND_CODES[k] for k in o.operands] + [0] * (3 - len(o.operands))
            yield [o.name.upper(), o.opcode, len(o.operands), KIND_CODES[o.result], *operands]


def _elementary_header():
    lines = [NOTICE, "#ifndef HL_ELEMENTARY_H", "#define HL_ELEMENTARY_H", ""]
    lines += [f"{_head(name)};" for name in ELEMENTARY]
    return "\n".join(lines) + "\n\n#endif\n"


def _elementary_source():
    functions = "\n".join(map(_function, ELEMENTARY))
    return f'{NOTICE}\n#include "elementary.h"\n#include "mathf.h"\n\nHL_NO_CONTRACTION\n\n{functions}'


def _head(name):
    return f"float hl_{name}f({', '.join(f'float {x}' for x, _ in zip('xyz', OPERATIONS[name].operands, strict=False))})"


def _function(name):
    """The trace of a function as C: the same operations on the same operands, so the same bits.

    What only one arm of a select needs is computed inside that arm, and an arm that is not taken costs nothing.
    """
    builder = Builder("f32")
    operands = [builder.leaf("input", k, "f32") for k in range(len(OPERATIONS[name].operands))]
    block = builder.block([ELEMENTARY[name](*operands)])
    code, result = block.instructions, block.outputs[0]
    places = _places(code, result)
    names, bodies = {}, {}
    for k, i in enumerate(code):
        if i.op == "input":
            names[k] = "xyz"[i.index]
        elif i.op == "const":
            names[k] = _literal(i.value)
        elif places[k] is not None:
            names[k] = f"t{k}"
            bodies.setdefault(places[k], []).append(k)
    lines = _statements((), code, names, bodies)
    small = ["HL_MADE_SMALL"] if name in MADE_SMALL else []
    return "\n".join([*small, _head(name), "{", *lines, f"    return {names[result]};", "}", ""])


def _places(code, result):
    """The place of each value: the path of (select, arm) that all its uses share; None without a use."""
    uses = {result: [()]}
    places = [None] * len(code)
    for k in reversed(range(len(code))):
        if k not in uses or code[k].op in LEAVES:
            continue
        places[k] = _shared(uses[k])
        if _remainder_of_4(code, k) is not None:
            uses.setdefault(_remainder_of_4(code, k), []).append(places[k])
            continue
        for n, a in enumerate(code[k].args):
            arm = ((k, n),) if code[k].op == "select" and n else ()
            uses.setdefault(a, []).append(places[k] + arm)
    return places


def _shared(paths):
    """The longest beginning that all paths share."""
    first = paths[0]
    same = (n for n in range(len(first)) if any(path[: n + 1] != first[: n + 1] for path in paths))
    return first[: next(same, len(first))]


def _statements(place, code, names, bodies):
    """Return the lines of one arm, or of the whole function."""
    indent, lines = "    " * (len(place) + 1), []
    for k in bodies.get(place, ()):
        i, (then, other) = code[k], ((*place, (k, 1)), (*place, (k, 2)))
        if then not in bodies and other not in bodies:
            lines.append(f"{indent}const {_C_TYPE[i.type]} t{k} = {_expression(k, code, names)};")
            continue
        test, *values = (names[a] for a in i.args)
        lines += [f"{indent}float t{k} = {values[1]};"] if other not in bodies else [f"{indent}float t{k};"]
        lines += [f"{indent}if ({test}) {{", *_statements(then, code, names, bodies), f"{indent}    t{k} = {values[0]};"]
        if other in bodies:
            lines += [f"{indent}}} else {{", *_statements(other, code, names, bodies), f"{indent}    t{k} = {values[1]};"]
        lines.append(f"{indent}}}")
    return lines


def _expression(k, code, names):
    whole = _remainder_of_4(code, k)
    if whole is not None:
        return f"hl_mod4f({names[whole]})"
    i = code[k]
    within = _bits_within(i, code)
    if within and within[1] > within[2]:
        return f"hl_is_zero({names[within[0]]})"
    if within:
        return "hl_bits_within({}, 0x{:08x}UL, 0x{:08x}UL)".format(names[within[0]], *within[1:])
    return OPERATIONS[i.op].c.format(*(names[a] for a in i.args))


def _remainder_of_4(code, k):
    """Return the whole number a, where value k is a - floor(a/4) 4; integers do that in fewer cycles."""
    if code[k].op != "sub":
        return None
    a, product = code[k].args
    quarter = [code[b] for b in code[product].args] if code[product].op == "mul" else []
    down = [i for i in quarter if i.op == "floor"]
    if not (code[a].op == "floor" and len(down) == 1 and any(i.op == "const" and i.value == 4 for i in quarter)):
        return None
    scaled = code[down[0].args[0]]
    by = [code[b].value for b in scaled.args if code[b].op == "const"]
    return a if scaled.op == "mul" and a in scaled.args and by == [0.25] else None


def _bits_within(i, code):
    """Return (operand, lowest bits, highest bits) where a comparison with a constant is one range of bits, or None.

    Zero has two patterns and no range: (operand, 1, 0).
    """
    if i.op not in ("lt", "le", "eq"):
        return None
    (constant,) = [n for n, a in enumerate(i.args) if code[a].op == "const"] or [None]
    if constant is None:
        return None
    value, other = code[i.args[constant]].value, i.args[1 - constant]
    (bits,) = struct.unpack("<I", struct.pack("<f", value))
    if i.op == "eq":
        return other, *((bits, bits) if value else (1, 0))
    if i.op == "lt" and constant == 0 and value >= 0:  # c < a, and a may be infinite
        return other, (bits & 0x7FFF_FFFF) + 1, 0x7F80_0000
    if i.op == "lt" and constant == 1 and value <= 0:  # a < c
        return other, (bits | 0x8000_0000) + 1, 0xFF80_0000
    if i.op == "le" and constant == 1 and value > 0 and code[other].op == "abs":
        return other, 0, bits
    return None


def _literal(value):
    """Return a float constant whose bits no C compiler can round."""
    if math.isfinite(value):
        text = f"{value.hex()}f"
    else:
        text = "HL_NAN" if math.isnan(value) else "HL_INFINITY" if value > 0 else "-HL_INFINITY"
    return f"({text})" if text.startswith("-") else text


if __name__ == "__main__":
    for name, text in generate().items():
        Path(sys.argv[1], name).write_text(text)
