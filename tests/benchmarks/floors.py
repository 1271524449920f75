"""The C by hand, compiled with -O3 for this machine: ``floors()`` is its library, arrays go in as they are."""

import ctypes
import functools
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from hapticlab.compiler.engines.toolchain import compilers, running_target

SOURCE = Path(__file__).with_name("floors.c")


@functools.cache
def floors():
    """Return the compiled library; its folder lives as long as the process."""
    folder = tempfile.mkdtemp(prefix="hapticlab-floors-")
    target = Path(folder) / "floors.so"
    flags = ["-O3", "-march=native", "-std=gnu11", "-shared", "-fPIC"]
    command = [*compilers(running_target())[0], *flags, str(SOURCE), "-o", str(target), "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return ctypes.CDLL(str(target))


def stepper(name, inputs, parameters, T):
    """Return a call that steps ``coupler`` or ``pendulum`` over the inputs, and the array of forces it fills."""
    force = np.empty(len(inputs))
    inputs, parameters = np.ascontiguousarray(inputs), np.array(list(parameters), float)
    function = getattr(floors(), name)
    function.restype = None
    arguments = ctypes.c_long(len(inputs)), ctypes.c_double(T), *map(_pointer, (inputs, parameters, force))
    return lambda keep=(inputs, parameters): function(*arguments), force


def lanes(ticks, k, phi, v0, push=0.0, counts=0.0):
    """Return a call that sweeps the wall over k, a multiple of 16 points, and the peaks it fills."""
    k, phi, peak = np.ascontiguousarray(k), np.array(phi, float), np.empty(len(k))
    front = ctypes.c_long(ticks), ctypes.c_long(len(k)), _pointer(k), _pointer(phi)
    hand = (ctypes.c_double(push), ctypes.c_double(counts)) if counts else ()
    function = floors().hand_lanes if counts else floors().wall_lanes
    function.restype = None
    return lambda keep=(k, phi): function(*front, *hand, ctypes.c_double(v0), _pointer(peak)), peak


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)
