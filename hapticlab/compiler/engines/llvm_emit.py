"""A program as the text of one LLVM function that runs it for many ticks, one lane or a vector of lanes at a time.

States travel in phi nodes. What depends on parameters alone is computed before the loop over ticks; what only the
outputs need is computed where they are stored; what only one arm of a select needs, where that arm is chosen, if it is
much. No instruction carries a fast-math flag, so LLVM may neither contract a*b + c nor reorder a sum: the bits are those
of the interpreter.
"""

import struct

from ..ir.operations import ELEMENTARY, OPERATIONS
from ..ir.program import LEAVES
from ..ir.trace import reachable
from .llvm_branches import Branches
from .side_by_side import functions, in_order
from .skipped_arms import Demand, in_lazy_order, needs_parameters_alone

SCALAR = {"f32": "float", "f64": "double", "bool": "i1", "i32": "i32"}
#: of a real type: bits of the whole, bits of the mantissa, exponent bias
LAYOUT = {"f32": (32, 23, 127), "f64": (64, 52, 1023)}

FUNCTION = """
define void @run(i64 %ticks, i64 %every, i64 %first, i64 %last, i64 %stride, i64 %resumed,
    ptr noalias %inputs, ptr noalias %parameters, ptr noalias %states, ptr noalias %outputs) {{
entry:
  %fresh = icmp eq i64 %resumed, 0
  br label %lanes
lanes:
  %lane = phi i64 [ %first, %entry ], [ %lane.next, %end ]
  {parameters}
  {hoisted}
  br i1 %fresh, label %init, label %resume
init:
  {sample_of_init}
  {init}
  br label %start
resume:
  {resume}
  br label %start
start:
  {start}
  br label %tick
tick:
  %n = phi i64 [ 0, %start ], [ %n.next, %next ]
  %left = phi i64 [ %every, %start ], [ %left.next, %next ]
  %row = phi ptr [ %inputs, %start ], [ %row.next, %next ]
  %out = phi ptr [ %outputs, %start ], [ %out.next, %next ]
  {states}
  {sample}
  {tick}
  br label %stepped
stepped:
  %left.less = sub i64 %left, 1
  %due = icmp eq i64 %left.less, 0
  br i1 %due, label %store, label %next
store:
  {kept}
  br label %stored
stored:
  {outputs}
  %out.size = mul i64 %stride, {output_count}
  %out.after = getelementptr double, ptr %out, i64 %out.size
  br label %next
next:
  %left.next = phi i64 [ %left.less, %stepped ], [ %every, %stored ]
  %out.next = phi ptr [ %out, %stepped ], [ %out.after, %stored ]
  %row.next = getelementptr double, ptr %row, i64 {input_count}
  %n.next = add i64 %n, 1
  %more = icmp slt i64 %n.next, %ticks
  br i1 %more, label %tick, label %end
end:
  {save}
  %lane.next = add i64 %lane, {lanes}
  %again = icmp slt i64 %lane.next, %last
  br i1 %again, label %lanes, label %done
done:
  ret void
}}
"""


class Writer:
    """Writes blocks over ``lanes`` lanes at a time; one lane is scalar code."""

    def __init__(self, lanes):
        self.lanes = lanes
        self.types = {t: self.vector(s) for t, s in SCALAR.items()}
        self.suffix = "" if lanes == 1 else f"v{lanes}"
        self.intrinsics, self._words = set(), {}

    def vector(self, scalar):
        return scalar if self.lanes == 1 else f"<{self.lanes} x {scalar}>"

    def splat(self, scalar, text):
        return text if self.lanes == 1 else "<" + ", ".join([f"{scalar} {text}"] * self.lanes) + ">"

    def const(self, value, type):
        if type == "bool":
            text = "true" if value else "false"
        elif type == "i32":
            text = str(int(value))
        else:  # LLVM writes a float32 constant as the float64 of the same value
            text = f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"
        return self.splat(SCALAR[type], text)

    def operation(self, result, i, operands, operand_type):
        """The lines that compute one instruction."""
        words = self.words(i.type, operand_type)
        lines = OPERATIONS[i.op].llvm.format(*operands, r=result, **words).splitlines()
        for line in lines:
            if "@" in line:
                name = line[line.index("@") : line.index("(")]
                self.intrinsics.add(f"declare {words['t']} {name}({', '.join([words['a']] * len(operands))})")
        return [*lines[:-1], f"{result} = {lines[-1]}"]

    def words(self, type, operand_type):
        """The names in the lines of an operation, by the types of its result and of its first operand.

        ``t`` and ``a`` are those types, ``s`` the suffix of an intrinsic, ``convert`` goes from one real type to the other.
        Of a real operand, ``bits`` is the integer type of its width, reached from i32 by ``widen`` and left by ``narrow``;
        ``field`` are the ones of an exponent, ``low`` and ``high`` the least and the greatest of a normal number.
        """
        if (type, operand_type) not in self._words:
            words = {name: self.types[name] for name in ("bool", "i32")}
            words |= {"t": self.types[type], "a": self.types[operand_type], "s": self.suffix + type}
            words |= {"true": self.const(True, "bool"), "false": self.const(False, "bool")}
            words["convert"] = "fpext" if type == "f64" else "fptrunc"
            if operand_type in LAYOUT:
                width, mantissa, bias = LAYOUT[operand_type]
                integer, real = f"i{width}", {"zero": 0, "low": 1 - bias, "high": bias}
                words |= {name: self.const(float(number), operand_type) for name, number in real.items()}
                words |= {"bits": self.vector(integer), "bias": self.splat("i32", str(bias))}
                words |= {"mantissa": self.splat(integer, str(mantissa)), "field": self.splat(integer, str(2 * bias + 1))}
                words |= {"widen": "zext", "narrow": "trunc"} if width == 64 else {"widen": "bitcast", "narrow": "bitcast"}
            self._words[type, operand_type] = words
        return self._words[type, operand_type]

    def names(self, block, prefix, leaves):
        """Return the name of every result of a block, by position."""
        names = []
        for position, i in enumerate(block.instructions):
            if i.op == "const":
                names.append(self.const(i.value, i.type))
            else:
                names.append(leaves[i.op] + str(i.index) if i.op in LEAVES else f"%{prefix}{position}")
        return names

    def lines(self, block, names, positions):
        """Return the lines that compute these results of a block."""
        lines = []
        computed = [k for k in positions if block.instructions[k].op not in LEAVES]
        for alike in in_order(block, computed):
            i = block.instructions[alike[0]]
            if i.op in ELEMENTARY:
                lines += functions(self, block, names, alike)
            else:
                operands = [names[a] for a in in_lazy_order(block.instructions, i)]
                lines += self.operation(names[alike[0]], i, operands, block.instructions[i.args[0]].type)
        return lines

    def load(self, result, channel, address, shared=False):
        """Read a float64 a lane, or one ``shared`` by all lanes, as the type of a channel."""
        wide, t = self.types["f64"], self.types[channel.type]
        raw = result if channel.type == "f64" else f"{result}.w"
        if shared and self.lanes > 1:
            lines = [
                f"{result}.a = load double, ptr {address}, align 8",
                f"{result}.b = insertelement {wide} undef, double {result}.a, i32 0",
                f"{raw} = shufflevector {wide} {result}.b, {wide} undef, <{self.lanes} x i32> zeroinitializer",
            ]
        else:
            lines = [f"{raw} = load {wide}, ptr {address}, align 8"]
        if channel.type == "f32":
            lines.append(f"{result} = fptrunc {wide} {raw} to {t}")
        elif channel.type == "bool":
            lines.append(f"{result} = fcmp une {wide} {raw}, {self.const(0.0, 'f64')}")
        elif channel.type == "i32":
            name = f"@llvm.fptosi.sat.{self.suffix}i32.{self.suffix}f64"
            self.intrinsics.add(f"declare {t} {name}({wide})")
            lines.append(f"{result} = call {t} {name}({wide} {raw})")
        return lines

    def store(self, name, value, channel, address):
        """Write a result as float64."""
        convert = {"f32": "fpext", "bool": "uitofp", "i32": "sitofp"}.get(channel.type)
        wide, lines = self.types["f64"], []
        if convert:
            lines.append(f"{name} = {convert} {self.types[channel.type]} {value} to {wide}")
            value = name
        return [*lines, f"store {wide} {value}, ptr {address}, align 8"]

    def address(self, prefix, base, row):
        """Return the line that points at this lane of a row, which is a stride on from the row before."""
        before = f"{prefix}{row - 1}.p, i64 %stride" if row else f"{base}, i64 %lane"
        return f"{prefix}{row}.p = getelementptr double, ptr {before}"

    def load_lanes(self, prefix, channels, base):
        """Read one row of an array a channel."""
        lines = []
        for k, c in enumerate(channels):
            lines += [self.address(prefix, base, k), *self.load(f"{prefix}{k}", c, f"{prefix}{k}.p")]
        return lines

    def load_sample(self, prefix, channels, row):
        """Read one tick's inputs, the same for every lane."""
        lines = []
        for k, c in enumerate(channels):
            lines.append(f"{prefix}{k}.p = getelementptr double, ptr {row}, i64 {k}")
            lines += self.load(f"{prefix}{k}", c, f"{prefix}{k}.p", shared=True)
        return lines

    def store_lanes(self, prefix, channels, values, base):
        """Write one row of an array a channel."""
        lines = []
        for k, (c, value) in enumerate(zip(channels, values, strict=True)):
            lines += [self.address(prefix, base, k), *self.store(f"{prefix}{k}", value, c, f"{prefix}{k}.p")]
        return lines


def emit(program, lanes=1):
    """Return LLVM's text of ``run`` for a program; one of several lanes must be without elementary functions.

    ``run(ticks, every, first, last, stride, resumed, inputs, parameters, states, outputs)`` steps lanes first, first +
    lanes, ... below last. The arrays are those of :meth:`hapticlab.compiler.engines.engine.Engine.run`, ``stride`` lanes long;
    ``states`` are read if ``resumed``, and always written.
    """
    w = Writer(lanes)
    init, tick = program.init, program.tick
    first = w.names(init, "i", {"param": "%p", "input": "%y"})
    names = w.names(tick, "t", {"param": "%p", "input": "%x", "state": "%s"})
    begun = [first[k] for k in init.states]
    hoisted = needs_parameters_alone(program.tick)
    stepped = set(reachable(program.tick.instructions, program.tick.states)) - hoisted
    fixed = w.lines(tick, names, hoisted)
    kept = set(reachable(tick.instructions, tick.outputs)) - stepped - hoisted
    written = Branches(w, tick, Demand(tick), names)
    advance, keep = (written.lines(sorted(part), label) for part, label in ((stepped, "tick"), (kept, "store")))
    after = [names[k] for k in tick.states]
    phi = "{0}{1} = phi {2} [ {3}, {4} ], [ {5}, {6} ]".format
    types = [w.types[c.type] for c in program.states]
    parts = {
        "parameters": w.load_lanes("%p", program.parameters, "%parameters"),
        "hoisted": fixed,
        "sample_of_init": w.load_sample("%y", program.inputs, "%inputs"),
        "init": w.lines(init, first, range(len(init.instructions))),
        "resume": w.load_lanes("%r", program.states, "%states"),
        "start": [phi("%b", k, t, begun[k], "%init", f"%r{k}", "%resume") for k, t in enumerate(types)],
        "states": [phi("%s", k, t, f"%b{k}", "%start", after[k], "%next") for k, t in enumerate(types)],
        "sample": w.load_sample("%x", program.inputs, "%row"),
        "tick": advance,
        "kept": keep,
        "outputs": w.store_lanes("%o", program.outputs, [names[k] for k in program.tick.outputs], "%out"),
        "save": w.store_lanes("%e", program.states, after, "%states"),
    }
    text = FUNCTION.format(
        lanes=lanes, input_count=len(program.inputs), output_count=len(program.outputs),
        **{part: "\n  ".join(lines) for part, lines in parts.items()},
    )  # fmt: skip
    return "\n".join(sorted(w.intrinsics)) + text
