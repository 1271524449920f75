"""A program as the bytes of one WebAssembly module that runs it for many ticks, one lane or two at a time.

States travel in locals. What depends on parameters alone is computed before the loop over ticks; what only the outputs need
is computed where they are stored; what only one arm of a select needs, where that arm is chosen, if it is much. The
arithmetic of WebAssembly is IEEE 754, rounded after every instruction: the bits are those of the interpreter.
"""

import re
from string import Template

from ..ir.trace import reachable
from .skipped_arms import Arm, Demand, needs_parameters_alone, work
from .wasm_code import BlockCode, Functions, Locals, get, put
from .wasm_lanes import ONE, TWO
from .wasm_module import module
from .wasm_words import assemble

ARGUMENTS = ("ticks", "every", "stride", "resumed", "inputs", "parameters", "states", "outputs")
#: $lane, $place, $row and $out are addresses, or begin as one; locals begin as 0
FUNCTION = """
loop
  [parameters] [hoisted]
  local.get $resumed
  if
    [resume]
  else
    local.get $inputs local.set $row [sample] [init]
  end
  i32.const 0 local.set $n
  local.get $every local.set $left
  local.get $inputs local.set $row
  local.get $outputs local.get $lane i32.add local.set $out
  loop
    [sample] [tick]
    local.get $left i32.const 1 i32.sub local.tee $left
    i32.eqz
    if
      [kept] [outputs]
      local.get $every local.set $left
    end
    [advance]
    local.get $row i32.const $row_size i32.add local.set $row
    local.get $n i32.const 1 i32.add local.tee $n
    local.get $ticks i32.lt_s br_if 0
  end
  [save]
  local.get $lane i32.const $lanes_size i32.add local.tee $lane
  local.get $stride i32.lt_s br_if 0
end
end
"""


def emit(program, lanes=ONE):
    """Return the bytes of a module that exports ``run(ticks, every, stride, resumed, inputs, parameters, states, outputs)``.

    All are i32, and the last four are addresses in its memory: arrays as :meth:`hapticlab.compiler.engines.engine.Engine.run`
    has them, where from one row to the next it is ``stride`` bytes, 8 a lane: so many lanes as fit without a rest. ``states``
    are read if ``resumed``, and always written. Lanes are computed one at a time, or as many as :func:`at_once` says.

    Examples
    --------
    >>> from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
    >>> x, y = Instruction("input", (), "f32"), Instruction("neg", (0,), "f32")
    >>> p = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), Block((x, y), outputs=(1,)), T=1e-3)
    >>> emit(p)[:4]
    b'\\x00asm'
    """
    locals = Locals(len(ARGUMENTS), lanes)
    names = {name: k for k, name in enumerate(ARGUMENTS)}
    names |= {name: locals.take_value("i32") for name in ("lane", "place", "row", "out", "n", "left")}
    leaves = {
        leaf: [locals.take(c.type) for c in channels]
        for leaf, channels in (("param", program.parameters), ("input", program.inputs), ("state", program.states))
    }
    channels, pushed = (program.parameters, program.inputs, program.states), [get(k) for k in leaves["state"]]
    parts = _computed(program, locals, leaves) | {
        "parameters": _load_lanes(names, lanes, "parameters", channels[0], leaves["param"]),
        "resume": _load_lanes(names, lanes, "states", channels[2], leaves["state"]),
        "sample": b"".join(
            assemble(f"local.get {names['row']} {lanes.load_shared} {8 * k} {lanes.loaded[c.type]} local.set {local}")
            for k, (c, local) in enumerate(zip(channels[1], leaves["input"], strict=True))
        ),
        "save": _start(names, "states") + _store_lanes(names, lanes, "place", channels[2], pushed),
    }
    outputs = parts.pop("pushed")
    parts["outputs"] = _store_lanes(names, lanes, "out", program.outputs, outputs)
    text = Template(FUNCTION).substitute(names, row_size=8 * len(program.inputs), lanes_size=8 * lanes.count)
    pieces = re.split(r"\[(\w+)\]", text)  # words, a part, words, ...
    code = b"".join(parts[piece] if k % 2 else assemble(piece) for k, piece in enumerate(pieces))
    return module(len(ARGUMENTS), locals.types, code)


def _computed(program, locals, leaves):
    """Return the code of what a program computes by the name of the part, and of ``pushed``, the outputs."""
    tick, functions = program.tick, Functions(locals)
    fixed = needs_parameters_alone(tick)
    stepped = [k for k in reachable(tick.instructions, tick.states) if k not in fixed]
    needed = reachable(tick.instructions, (*tick.states, *tick.outputs))
    kept = sorted({*needed} - {*stepped} - fixed)
    hoisted = [k for k in needed if k in fixed]
    demand, code = Demand(tick), BlockCode(tick, locals, leaves, functions)
    every = [demand.arranged(part) for part in (stepped, kept)]
    code.plan(hoisted)
    for items in every:
        code.plan(items, demand.before)
    code.keep(fixed.intersection(a for k in (*stepped, *kept) for a in demand.before(k)))
    parts = {"hoisted": code.write(hoisted), "init": _init(program.init, locals, leaves, functions)}  # in the order in which
    parts |= {"tick": code.write(every[0]), "kept": code.write(every[1])}  # they run: a later one may take a local that is free
    parts["advance"] = _advance(leaves["state"], [code.pushed[k] for k in tick.states])
    return parts | {"pushed": [code.pushed[k] for k in tick.outputs]}


def _init(block, locals, leaves, functions):
    code = BlockCode(block, locals, leaves, functions)
    text = code.write(code.plan(reachable(block.instructions, block.states)))
    for k in {*block.states}.intersection(code.local):
        locals.give_back(code.local[k])
    return text + _advance(leaves["state"], [code.pushed[k] for k in block.states])


def at_once(program):
    """Return how many lanes of a program are computed at once where there are several: two, or one where most may be skipped.

    Two compute what either of them needs. tests/benchmarks/wasm_engine.py measures both.
    """
    instructions = program.tick.instructions
    items = Demand(program.tick).arranged(range(len(instructions)))
    skipped = sum(work(instructions[k]) for arm in items if isinstance(arm, Arm) for k in arm.positions())
    return ONE if 2 * skipped > sum(map(work, instructions)) else TWO


def _advance(states, pushed):
    """Return the code that gives the states their next values, all at once: one may need another's old value."""
    changed = [(local, push) for local, push in zip(states, pushed, strict=True) if push != get(local)]
    return b"".join(push for _, push in changed) + b"".join(put(local) for local, _ in reversed(changed))


def _start(names, array):
    return assemble(f"local.get {names[array]} local.get {names['lane']} i32.add local.set {names['place']}")


def _next(names, place):
    return assemble(f"local.get {names[place]} local.get {names['stride']} i32.add local.set {names[place]}")


def _load_lanes(names, lanes, array, channels, locals):
    """Return the code that reads this lane of each row of an array."""
    code = _start(names, array)
    for c, local in zip(channels, locals, strict=True):
        code += get(names["place"]) + assemble(f"{lanes.load} 0 {lanes.loaded[c.type]}") + put(local) + _next(names, "place")
    return code


def _store_lanes(names, lanes, place, channels, pushed):
    """Return the code that writes this lane of a row a channel, from an address on."""
    code = b""
    for c, push in zip(channels, pushed, strict=True):
        code += get(names[place]) + push + assemble(f"{lanes.stored[c.type]} {lanes.store} 0") + _next(names, place)
    return code
