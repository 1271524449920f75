"""The firmware's core as WebAssembly in node, beside the native library: ``python tests/benchmarks/web_core.py``.

The same wall in the same run: `vm` is the program alone (``hl_host_run``), `tick` the whole of a sample by ``core.js`` or, on
this computer, by C that calls ``hl_host_tick`` as often. Rounds of both take turns; of each the fastest counts.
"""

import ctypes
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), *(str(HERE.parent / name) for name in ("firmware", "compiler"))]

import numpy as np  # noqa: E402
from core_in_node import FIRMWARE, WEB, in_node, missing, recorded_host, run_of  # noqa: E402
from five_scenes import wall  # noqa: E402
from host_driver import settings  # noqa: E402

import hapticlab as hl  # noqa: E402
from hapticlab.compiler.engines import toolchain  # noqa: E402
from hapticlab.compiler.engines.bytecode import encode  # noqa: E402
from hapticlab.compiler.engines.vm import Vm  # noqa: E402

TICKS, ROUNDS = 5_000, 200
#: the loop of in_node.mjs, in C
LOOP = """
#include <stdio.h>
#include <time.h>
#include "host.h"
double hl_bench(hl_host *host, const uint8_t *status, uint32_t size, uint32_t period, int ticks, double from)
{
    static uint8_t room[65536];
    struct timespec a, b;
    uint32_t now = (uint32_t)(from * 1e6);
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < ticks; k++, now += period) {
        hl_host_tick(host, 1000 + k % 7, (uint16_t)now, 0);
        if (k % 64 == 0) {
            hl_host_receive(host, status, size);
            hl_host_transmit(host, room, sizeof room);
        }
    }
    clock_gettime(CLOCK_MONOTONIC, &b);
    return (1e9 * (double)(b.tv_sec - a.tv_sec) + (double)(b.tv_nsec - a.tv_nsec)) / ticks;
}
"""


def native_tick(host, status, period):
    """Return [ns] of a tick of another board like the host's, by C."""
    compiler = toolchain.compilers(toolchain.running_target())[0]
    with tempfile.TemporaryDirectory() as folder:
        loop, made = Path(folder, "loop.c"), Path(folder, "loop.so")
        loop.write_text(LOOP)
        files = (*toolchain.sources(FIRMWARE), loop)
        flags = "-shared", "-fPIC", "-D_POSIX_C_SOURCE=199309L"
        command = toolchain.build_command(compiler, FIRMWARE, 16, made, *flags, files=files)
        subprocess.run(command, check=True)
        library = ctypes.CDLL(str(made))
    pointer = ctypes.c_void_p
    library.hl_host_new.restype, library.hl_host_new.argtypes = pointer, [ctypes.c_char_p, ctypes.c_uint8]
    library.hl_host_receive.argtypes = [pointer, ctypes.c_char_p, ctypes.c_uint32]
    library.hl_host_transmit.argtypes = [pointer, pointer, ctypes.c_uint32]
    library.hl_host_tick.argtypes = [pointer, ctypes.c_int32, ctypes.c_uint16, ctypes.c_uint16]
    library.hl_bench.argtypes = [pointer, ctypes.c_char_p, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_int, ctypes.c_double]
    library.hl_bench.restype = ctypes.c_double
    board = library.hl_host_new(settings().to_bytes().ljust(4096, b"\xff"), 0)
    room = ctypes.create_string_buffer(65536)
    for call, *given in host.board.script:
        if call == "receive":
            data = bytes.fromhex(given[0])
            library.hl_host_receive(board, data, len(data))
        elif call == "transmit":
            library.hl_host_transmit(board, room, len(room))
        else:
            counts, now, step = given
            library.hl_host_tick(board, counts, round(now * 1e6) & 0xFFFF, round(step * 1e6))
    each = [library.hl_bench(board, status, len(status), period, TICKS, 1.0 + k * TICKS * period / 1e6) for k in range(ROUNDS)]
    library.hl_host_duty.argtypes = [pointer]
    assert library.hl_host_duty(board), "it runs: the wall pushes"
    return min(each)


def main():
    if missing():
        raise SystemExit(missing())
    scene, options = wall()
    program = hl.compile(scene, T=1e-3, dtype="float32", live=(), **options)
    data = encode(program, word_bits=16)
    rng = np.random.default_rng(1)
    inputs, values = 0.01 * rng.standard_normal((TICKS, 1)), np.array(program.values)
    asked = run_of(data, inputs, values, len(program.outputs), len(program.states))

    host = recorded_host().ready(program)
    assert host.start() == "OK"
    host.tick(1000, times=10)
    status = host.frame("STATUS", host.session)
    store = settings().to_bytes().ljust(4096, b"\xff").hex()
    found = in_node(
        WEB, runs=[asked | {"rounds": ROUNDS}], script=host.board.script, store=store, status=status.hex(), ticks=TICKS
    )
    vm, seconds = Vm(program), []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        vm.run(TICKS, inputs, values[:, None])
        seconds.append(time.perf_counter() - began)
    native = {"vm": 1e9 * min(seconds) / TICKS, "tick": native_tick(host, status, round(1e6 * found["period"]))}
    for name, ns in ("vm", found["runs"][0]["ns"]), ("tick", found["ns"]):
        print(f"{name:5} {ns:7.0f} ns in node, {native[name]:7.0f} ns here, {ns / native[name]:.2f} times")
    print(f"web.wasm: {WEB.stat().st_size} bytes")


if __name__ == "__main__":
    main()
