"""Write firmware/generated: the tables that Python owns and the elementary functions, as C99.

Run ``python -m hapticlab.compiler.cheaders FOLDER`` after changing a table; a test proves the committed files fresh.
"""

import math
import sys
from pathlib import Path

from .bytecode import COUNTS, END, HEADER, KIND_CODES, MAGIC, OPCODES, RESULTS, TYPE_CODES, VERSION, table_hash
from .elementary import DEFINITIONS
from .ir import OPERATIONS
from .trace import Builder

NOTICE = "/* Written by hapticlab/compiler/cheaders.py: change the Python tables, not this file. */\n"
_C_TYPE = {"f32": "float", "bool": "int32_t"}
_C_FORM = {
    "neg": "-{0}", "abs": "hl_absf({0})", "floor": "hl_floorf({0})",
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}",
    "lt": "{0} < {1}", "le": "{0} <= {1}", "eq": "{0} == {1}",
    "and": "{0} & {1}", "or": "{0} | {1}", "not": "!{0}", "select": "{0} ? {1} : {2}",
    "exp2i": "hl_exp2if({0})", "exponent": "hl_exponentf({0})",
}  # fmt: skip


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
    for name, number in OPCODES.items():
        kinds, result = OPERATIONS[name]
        operands = [KIND_CODES[k] for k in kinds] + [0] * (3 - len(kinds))
        yield [name.upper(), number, len(kinds), KIND_CODES[result], *operands]


def _elementary_header():
    lines = [NOTICE, "#ifndef HL_ELEMENTARY_H", "#define HL_ELEMENTARY_H", ""]
    lines += [f"float hl_{name}f(float x);" for name in DEFINITIONS]
    return "\n".join(lines) + "\n\n#endif\n"


def _elementary_source():
    functions = "\n".join(_function(name, define) for name, define in DEFINITIONS.items())
    return f'{NOTICE}\n#include "elementary.h"\n#include "mathf.h"\n\nHL_NO_CONTRACTION\n\n{functions}'


def _function(name, define):
    builder = Builder("f32")
    block = builder.block([define(builder.leaf("input", 0, "f32"))])
    names, lines = [], []
    for k, i in enumerate(block.instructions):
        if i.op == "input":
            names.append("x")
        elif i.op == "const":
            names.append(_literal(i.value))
        else:
            names.append(f"t{k}")
            lines.append(f"    const {_C_TYPE[i.type]} t{k} = {_C_FORM[i.op].format(*(names[a] for a in i.args))};")
    return "\n".join([f"float hl_{name}f(float x)", "{", *lines, f"    return {names[block.outputs[0]]};", "}", ""])


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
