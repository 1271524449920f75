"""In Pyodide: the package's own code finds and opens the firmware's library; ctypes calls it with the package's types."""

import ctypes
import json
import sys
import types

for name in ("hapticlab", "hapticlab.compiler", "hapticlab.compiler.engines"):  # without NumPy their __init__ cannot run
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__path__ = ["/folder/" + name.replace(".", "/")]

from hapticlab.compiler.engines import firmware_library, toolchain  # noqa: E402
from hapticlab.errors import EngineMissingError  # noqa: E402

assert toolchain.running_target() == "emscripten-wasm32-32", toolchain.running_target()
assert str(firmware_library.prebuilt(16)).startswith("/folder/hapticlab/prebuilt/")
library, pointer, i64 = firmware_library.load_library(16), ctypes.c_void_p, ctypes.c_int64
# as in compiler/engines/vm.py
library.hl_host_run.argtypes = [
    ctypes.c_char_p, ctypes.c_uint32, pointer, ctypes.c_uint16, pointer, i64, i64, i64, ctypes.c_int, *[pointer] * 5
]  # fmt: skip


def doubles(numbers):
    return (ctypes.c_double * max(1, len(numbers)))(*numbers)


with open("/folder/runs.json") as file:
    asked = json.load(file)
for run in asked:
    states, outputs = doubles(run["end"]), doubles(run["out"])
    expected = bytes(states), bytes(outputs)
    ctypes.memset(states, 0, len(bytes(states))), ctypes.memset(outputs, 0, len(bytes(outputs)))
    registers, scratch, fault = (ctypes.c_int32 * run["registers"])(), (ctypes.c_int32 * 64)(), ctypes.c_int32()
    code, arrays = bytes.fromhex(run["program"]), (doubles(run["inputs"]), doubles(run["values"]), states, outputs)
    addresses = [ctypes.addressof(a) for a in (*arrays, fault)]
    memory = ctypes.addressof(registers), run["registers"], ctypes.addressof(scratch)
    assert library.hl_host_run(code, len(code), *memory, run["ticks"], 1, 1, 0, *addresses) == 0
    assert fault.value == 0
    assert (bytes(states), bytes(outputs)) == expected, run["name"]

# as in device/board/host_board.py
library.hl_host_new.restype, library.hl_host_new.argtypes = pointer, [ctypes.c_char_p, ctypes.c_uint8]
library.hl_host_receive.argtypes = [pointer, ctypes.c_char_p, ctypes.c_uint32]
library.hl_host_transmit.argtypes, library.hl_host_transmit.restype = [pointer, pointer, ctypes.c_uint32], ctypes.c_uint32
library.hl_host_tick.argtypes = [pointer, ctypes.c_int32, ctypes.c_uint16, ctypes.c_uint16]
library.hl_host_free.argtypes = [pointer]
board, room = library.hl_host_new(b"\xff" * 4096, 0), ctypes.create_string_buffer(256)
with open("/folder/ping.json") as file:
    ping, pong = map(bytes.fromhex, json.load(file))
library.hl_host_receive(board, ping, len(ping))
count = library.hl_host_transmit(board, room, len(room))
assert room.raw[:count] == pong
assert library.hl_host_tick(board, 5, 100, 10) == 0
library.hl_host_free(board)

said = ""
try:
    firmware_library.load_library(16, "-DHL_SLOTS=1")  # where nothing can be built
except EngineMissingError as missing:
    said = str(missing)
assert "wheel for every target" in said, said
print(len(asked), "programs")
