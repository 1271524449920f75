"""Machine code for this computer: the only module that opens llvmlite."""

import ctypes
import functools
import math
import weakref

import numpy as np

from ...errors import EngineMissingError
from ..ir.cache import Shared
from ..ir.trace import expand
from .llvm_emit import emit

#: Lanes stepped together in a program of at most so many instructions; 8 in a longer one. Several vectors a value hide
#: the latency of a short program, a long one runs out of registers. Measured with AVX-512, seconds for 1e7 lane-ticks at 8,
#: 16 and 32 lanes: 26 instructions 0.013, 0.009, 0.006; 51 instructions 0.018, 0.012, 0.013; 4000 instructions 1, 1.3, 1.6.
WIDTHS = {40: 32, 500: 16}


class Llvm:
    """Run a program as machine code. See :meth:`hapticlab.compiler.engines.engine.Engine.run` for the contract.

    Scalar and lanes code are compiled when first asked for. The call releases the GIL.
    """

    name = "llvm"

    def __init__(self, program):
        self.program = program.verify()
        self._compiled = Shared(math.inf)

    def run(self, ticks, inputs, parameters, states=None, every=1):
        lanes = parameters.shape[1]
        width = 1 if lanes == 1 else self._width()
        stride = -(-lanes // width) * width
        outputs = np.empty((ticks // every, len(self.program.outputs), stride))
        carried = np.empty((len(self.program.states), stride))
        if states is not None:
            carried[:, :lanes] = states
            carried[:, lanes:] = carried[:, lanes - 1 : lanes]
        if stride > lanes:  # the last lane again and again: no number that the program was not given
            parameters = np.pad(parameters, ((0, 0), (0, stride - lanes)), "edge")
        arrays = inputs, parameters, carried, outputs
        run = self._function(width)
        run(ticks, every, 0, stride, stride, states is not None, *(a.ctypes.data for a in arrays))
        return outputs[..., :lanes], carried[:, :lanes]

    def bound(self, inputs, parameters, states, outputs):
        """A function that runs one tick of one lane on these arrays; it keeps them."""
        arrays = inputs, parameters, states, outputs
        pointers, run = [a.ctypes.data for a in arrays], self._function(1)

        def tick(_arrays=arrays):
            run(1, 1, 0, 1, 1, True, *pointers)

        return tick

    def _width(self):
        return next((lanes for most, lanes in WIDTHS.items() if len(self._expanded) <= most), 8)

    @functools.cached_property
    def _expanded(self):
        return expand(self.program)

    def _function(self, width):
        return self._compiled.get(width, lambda: _compile(emit(self.program if width == 1 else self._expanded, width)))


def open_llvmlite():
    """Return llvmlite's binding, ready to compile; EngineMissingError says what to install."""
    try:
        from llvmlite import binding
    except (ImportError, OSError) as missing:  # OSError: installed, but its library does not load here
        raise EngineMissingError(
            'engine = "llvm" needs llvmlite, which does not import here; do: pip install llvmlite, or use engine="interpreter"'
        ) from missing
    if binding.llvm_version_info[0] < 20:  # newer ones do this by themselves
        binding.initialize()
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding


def _context(binding):
    """Return a context of our own, so that programs compile in several threads at once."""
    if binding.llvm_version_info[0] >= 20:
        return binding.create_context()
    # llvmlite 0.44 reads the pointers of our text only in a context that was told so when it was made
    return binding.context.ContextRef(binding.ffi.lib.LLVMPY_ContextCreate(True))


def _compile(text):
    """Return the function of a text as machine code, which lives as long as the function."""
    binding = open_llvmlite()
    target = binding.Target.from_default_triple()
    machine = target.create_target_machine(
        cpu=binding.get_host_cpu_name(), features=binding.get_host_cpu_features().flatten(), opt=2, jit=True
    )
    context = _context(binding)
    keeper = binding.create_mcjit_compiler(binding.parse_assembly(text, context), machine)
    keeper.finalize_object()
    prototype = ctypes.CFUNCTYPE(None, *[ctypes.c_int64] * 6, *[ctypes.c_void_p] * 4)
    run = prototype(keeper.get_function_address("run"))
    # the garbage collector would close what it finds in a cycle in any order, and the code must go before its context
    weakref.finalize(run, _close, keeper, context).atexit = False
    return run


def _close(keeper, context):
    """Free machine code, then the context that it was made in."""
    keeper.close()
    context.close()
