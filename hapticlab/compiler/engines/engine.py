"""Choose an engine for a program. All keep one contract; in float32 they give the same bits while numbers are finite."""

import operator

import numpy as np

from ...errors import ProgramError
from ..ir.cache import Shared, instructions
from .table import chosen

#: programs that are kept ready to run: instructions, and 600 for the 0.8 MB that llvm takes for the smallest; 1.4 kB each
KERNELS = Shared(24_000, lambda kernel: 600 + kernel.program.size)


class Run(tuple):
    """``outputs`` of shape (ticks // every, outputs, lanes) and ``states`` of shape (states, lanes), both float64."""

    outputs = property(lambda self: self[0])
    states = property(lambda self: self[1])


class Engine:
    """A program ready to run; ``engine.run(...)`` may be called again and again, from several threads at once."""

    def __init__(self, program, kernel):
        self.program, self._kernel = program, kernel
        self.name = kernel.name
        told = {"parameters": program.parameters, "inputs": program.inputs, "states": program.states}
        self._int32 = {what: [(k, c.name) for k, c in enumerate(all_) if c.type == "i32"] for what, all_ in told.items()}

    def run(self, ticks, inputs=None, parameters=None, states=None, every=1):
        """Run for a number of ticks.

        Parameters
        ----------
        ticks : int
        inputs : array of shape (ticks, inputs), or None where the program has none
            One row per tick, the same for every lane.
        parameters : array of shape (parameters,) or (parameters, lanes), optional
            The program's own values by default.
        states : array of shape (states, lanes), optional
            Where an earlier run ended. Without it, init makes them from the first row of inputs.
        every : int
            Keep the outputs of every so many ticks (the last of each group).

        Returns
        -------
        Run
        """
        program = self.program
        ticks, every = _whole("ticks", ticks), _whole("every", every)
        if ticks < 1 or every < 1:
            raise ProgramError(f"ticks = {ticks}, every = {every}; a run needs at least one tick, kept every one or more")
        parameters = np.atleast_1d(self._real("parameters", program.values if parameters is None else parameters))
        if parameters.ndim == 1:
            parameters = parameters[:, None]
        lanes = parameters.shape[1]
        if lanes == 0:
            raise ProgramError(f"{program.name}: parameters of shape {parameters.shape}; needs at least one lane")
        parameters = self._shaped("parameters", parameters, (len(program.parameters), lanes))
        if np.isnan(parameters).any():
            unbound = [c.name for c, row in zip(program.parameters, parameters, strict=True) if np.isnan(row).any()]
            raise ProgramError(f"{program.name}: no value for {', '.join(unbound)}; bind it: scene({unbound[0]}=...)")
        inputs = np.zeros((ticks, 0)) if inputs is None else self._real("inputs", inputs)
        if inputs.ndim == 1:
            inputs = inputs[:, None]
        inputs = self._shaped("inputs", inputs, (ticks, len(program.inputs)))
        if states is not None:
            states = self._shaped("states", self._real("states", states), (len(program.states), lanes))
            self._check_int32("states", states)
        self._check_int32("parameters", parameters)
        self._check_int32("inputs", inputs.T)
        return Run(self._kernel.run(ticks, inputs, parameters, states, every))

    def once(self):
        """Return (inputs, states, outputs, tick): arrays to fill and read, and what runs one tick on them, unchecked.

        For a loop in Python that needs the tick as a function: a call costs a microsecond or two. The states are
        overwritten by the next ones; the parameters are the program's own values.

        Examples
        --------
        >>> import hapticlab as hl
        >>> k = hl.parameters("k", units="N/m", values=200)
        >>> program = hl.compile(hl.Scene(force=k * hl.x(hl.n)), T=1e-3, dtype="float64")
        >>> inputs, _, outputs, tick = load(program).once()
        >>> inputs[0] = 0.01
        >>> tick()
        >>> float(outputs[0])
        2.0
        """
        program, kernel = self.program, self._kernel
        inputs, outputs = np.zeros(len(program.inputs)), np.zeros(len(program.outputs))
        states, parameters = np.zeros(len(program.states)), np.array(program.values, float)

        def tick():
            found, following = kernel.run(1, inputs[None], parameters[:, None], states[:, None])
            outputs[:], states[:] = found[0, :, 0], following[:, 0]

        bound = getattr(kernel, "bound", lambda *_: tick)
        return inputs, states, outputs, bound(inputs, parameters, states, outputs)

    def _real(self, what, given):
        """Return an array of float64, or say what is wrong with it."""
        try:
            array = np.asarray(given)
            if array.dtype.kind not in "biuf":
                raise TypeError
            return array.astype(float)
        except (TypeError, ValueError):
            shown = repr(given) if len(repr(given)) < 60 else f"{repr(given)[:57]}..."
            raise ProgramError(f"{self.program.name}: {what} = {shown}; needs an array of real numbers") from None

    def _check_int32(self, what, rows):
        """Refuse what no int32 is: the engines would each round it in their own way."""
        for k, name in self._int32[what]:
            wrong = rows[k][~((rows[k] == np.floor(rows[k])) & (np.abs(rows[k] + 0.5) < 2.0**31))]
            if wrong.size:
                raise ProgramError(f"{self.program.name}: {what} hold {name} = {wrong[0]:g}; needs an int32")

    def _shaped(self, what, array, needed):
        array = np.ascontiguousarray(array, float)
        if array.shape != needed:
            raise ProgramError(f"{self.program.name}: {what} of shape {array.shape}; needs {needed}")
        return array


def _whole(name, given):
    try:
        return operator.index(given)
    except TypeError:
        raise ProgramError(f"{name} = {given!r}; needs a whole number") from None


def load(program, engine="auto"):
    """Return the program ready to run on an engine of this machine.

    Parameters
    ----------
    program : Program
    engine : {"auto", "llvm", "wasm", "interpreter", "vm"}
        "auto" is llvm where llvmlite is installed, else wasm in a browser or where wasmtime is installed, else the
        interpreter. "vm" is the firmware's C machine built for this computer; it takes float32 programs.

    Programs of the same instructions share the machine code, as :mod:`hapticlab.compiler.ir.cache` says.
    """
    record = chosen(engine)
    program.check_interface()
    key = (record.name, instructions(program)) if record.shared else None
    return Engine(program, KERNELS.get(key, lambda: record.kernel(program)))
