"""The reference engine: one NumPy operation per instruction, scalar or over lanes, in the order of the list.

It is the definition the other engines are tested against, and what runs where llvmlite has no wheel.
"""

import numpy as np

from ..ir.operations import OPERATIONS
from ..ir.program import NUMPY_TYPE
from ..ir.trace import expand


class Interpreter:
    """Run a program instruction by instruction. See :func:`hapticlab.compiler.engines.engine.load` for the contract."""

    name = "interpreter"

    def __init__(self, program):
        self.program = expand(program.verify())

    def run(self, ticks, inputs, parameters, states=None, every=1):
        program = self.program
        with np.errstate(all="ignore"):
            parameters = _typed(parameters, program.parameters)
            outputs = np.empty((ticks // every, len(program.outputs), parameters.lanes))
            for tick in range(ticks):
                sample = _typed(inputs[tick][:, None], program.inputs)
                if states is None:
                    _, states = evaluate(program.init, param=parameters, input=sample, state=())
                elif tick == 0:
                    states = _typed(states, program.states)
                results, states = evaluate(program.tick, param=parameters, input=sample, state=states)
                if (tick + 1) % every == 0:
                    outputs[tick // every] = [np.broadcast_to(r, parameters.lanes) for r in results]
        wide = [np.broadcast_to(s, parameters.lanes).astype(float) for s in states]
        return outputs, np.array(wide).reshape(len(states), parameters.lanes)


def evaluate(block, **leaves):
    """Return the outputs and next states of a block, as two lists of arrays."""
    done = []
    for i in block.instructions:
        if i.args:
            operation = OPERATIONS[i.op]
            result = operation.compute(*map(done.__getitem__, i.args))
            done.append(result.astype(NUMPY_TYPE[i.type]) if operation.converts else result)
        elif i.op == "const":
            done.append(NUMPY_TYPE[i.type](i.value))
        else:
            done.append(leaves[i.op][i.index])
    return [done[k] for k in block.outputs], [done[k] for k in block.states]


class _Lanes(tuple):
    lanes = 1


def _typed(rows, channels):
    """Give each row of a (channels, lanes) array the type of its channel."""
    rows = np.atleast_2d(np.asarray(rows, float)) if len(channels) else np.empty((0, np.shape(rows)[-1] if np.ndim(rows) else 1))
    typed = _Lanes(row.astype(NUMPY_TYPE[c.type]) for row, c in zip(rows, channels, strict=True))
    typed.lanes = rows.shape[1]
    return typed
