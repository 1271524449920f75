"""The engines, one record each: whoever asks what an engine is, what it takes or how it runs, reads it here."""

from collections.abc import Callable
from dataclasses import dataclass

from ...errors import EngineMissingError, ProgramError
from .interpreter import Interpreter
from .llvm import Llvm, open_llvmlite
from .vm import Vm, open_vm
from .wasm import Wasm, open_wasm


@dataclass(frozen=True)
class EngineRecord:
    """One engine.

    Attributes
    ----------
    kernel : class
        Made of a program; its ``run`` keeps the contract of :meth:`hapticlab.compiler.engines.engine.Engine.run`, shapes and
        types already checked. Its ``bound``, if it has one, is a tick on given arrays.
    open : callable
        Raises EngineMissingError, which says what to install, where the engine cannot be had.
    chunk : int
        Ticks between two looks at a progress bar: some tenths of a second.
    automatic : bool
        Whether "auto" may choose it: the first one here that can be had.
    float64 : bool
        Whether it takes float64, and so a scene linked with a simulated paddle.
    side_by_side : bool
        Whether it runs outside Python, so that threads run side by side.
    shared : bool
        Whether programs of the same instructions share a kernel.
    extra : str
        The extra that brings it; empty where hapticlab's own dependencies do.
    """

    name: str
    kernel: Callable
    open: Callable = lambda: None
    chunk: int = 100_000
    automatic: bool = True
    float64: bool = True
    side_by_side: bool = True
    shared: bool = True
    extra: str = ""

    def is_here(self):
        """Whether it can be had on this machine."""
        try:
            self.open()
        except EngineMissingError:
            return False
        return True


_RECORDS = (
    EngineRecord("llvm", Llvm, open_llvmlite),
    EngineRecord("wasm", Wasm, open_wasm, extra="wasm"),
    EngineRecord("interpreter", Interpreter, chunk=250, side_by_side=False),
    EngineRecord("vm", Vm, open_vm, automatic=False, float64=False, shared=False),  # it remembers the faults of its last run
)
#: name -> record, the fastest first
ENGINES = {record.name: record for record in _RECORDS}


def chosen(engine):
    """Return the record of an engine, of the first one that can be had here for "auto".

    Raises
    ------
    ProgramError
        If no engine is called so.
    EngineMissingError
        If it cannot be had here.
    """
    if engine not in ("auto", *ENGINES):
        raise ProgramError(f"engine = {engine!r}; needs one of auto, {', '.join(ENGINES)}")
    if engine == "auto":
        return next(record for record in _RECORDS if record.automatic and record.is_here())
    record = ENGINES[engine]
    record.open()
    return record
