"""Leave out what nobody looks at: states that no output of a program depends on."""

from dataclasses import replace

from ...compiler.ir.program import Block, Instruction


def drop_unused_states(program):
    """Return the program without the states that no output depends on, however indirectly."""
    block = program.tick
    reach = [0] * len(block.instructions)  # bit s of reach[k]: instruction k depends on state s
    for k, i in enumerate(block.instructions):
        reach[k] = 1 << i.index if i.op == "state" else 0
        for a in i.args:
            reach[k] |= reach[a]
    live = 0
    for k in block.outputs:
        live |= reach[k]
    while True:
        grown = live
        for s, k in enumerate(block.states):
            if live >> s & 1:
                grown |= reach[k]
        if grown == live:
            break
        live = grown
    keep = [s for s in range(len(program.states)) if live >> s & 1]
    states = tuple(program.states[s] for s in keep)
    return replace(program, states=states, init=_keep(program.init, keep), tick=_keep(block, keep))


def _keep(block, keep):
    """Return the block handing out some of its states, without the instructions only the others needed."""
    new_index = {s: k for k, s in enumerate(keep)}
    wanted = set(block.outputs) | {block.states[s] for s in keep}
    for k in range(len(block.instructions) - 1, -1, -1):
        if k in wanted:
            wanted.update(block.instructions[k].args)
    order = {old: new for new, old in enumerate(sorted(wanted))}
    kept = []
    for old in sorted(wanted):
        i = block.instructions[old]
        index = new_index[i.index] if i.op == "state" else i.index
        kept.append(Instruction(i.op, tuple(order[a] for a in i.args), i.type, i.value, index))
    return Block(tuple(kept), tuple(order[k] for k in block.outputs), tuple(order[block.states[s]] for s in keep))
