"""The firmware's core in a browser: bits of the golden programs, and every answer as on this computer."""

import core_in_node
import numpy as np
import pytest
from build_image import build_image
from core_in_node import WEB, golden_runs, in_node, recorded_host, unpacked
from test_golden import GOLDEN, array

from hapticlab.compiler.engines import toolchain
from hapticlab.device.link.messages import FAULTS

needs_node = pytest.mark.skipif(core_in_node.missing() is not None, reason=str(core_in_node.missing()))
PYODIDE = "emscripten-wasm32-32"
#: what Pyodide's main module has for every library
GIVEN = {"memory", "__stack_pointer", "__memory_base", "__table_base", "__indirect_function_table", "calloc", "free", "memcmp"}


def has_the_committed_bits(runs):
    assert len(runs) == len(GOLDEN)
    for g, found in zip(GOLDEN, runs, strict=True):
        assert (found["result"], found["fault"]) == (0, 0), g["name"]
        for kind, expected in ("outputs", "out"), ("states", "end"):
            assert unpacked(found[kind]).tobytes() == array(g[expected], -1).tobytes(), f"{g['name']}: {kind}"


@needs_node
def test_golden_programs_give_the_committed_bits_in_a_module_that_imports_nothing():
    answer = in_node(WEB, runs=golden_runs(16))
    assert answer["imports"] == []
    has_the_committed_bits(answer["runs"])


@needs_node
def test_every_frame_and_duty_is_that_of_this_computer():
    host = recorded_host().running()
    for k in range(400):
        host.tick(int(1500 * np.sin(0.05 * k)) + 700, step=2e-5, beat=k % 30 == 0)
        if k == 200:
            assert host.set(_0=250.0) == "OK"
    host.tick(6000, times=3)  # beyond the travel
    assert host.faults[-1].fields["fault"] == FAULTS["OVER_TRAVEL"][0]
    assert host.ask("CLEAR") == "OK" and host.ask("PING", 7) == {"token": 7}
    host.hear()
    board = host.board
    store = core_in_node.settings().to_bytes().ljust(4096, b"\xff")
    answer = in_node(WEB, script=board.script, store=store.hex())
    assert answer["answers"] == board.answers
    assert np.ptp([a for a in board.answers if isinstance(a, float)]) > 0.5
    assert (answer["duty"], answer["period"], answer["store"]) == (board.duty, board.period, board.store.hex())
    sent = [(f.fields["tick"], f.fields["flags"], np.frombuffer(f.payload[5:], "<f4").tolist()) for f in host.samples]
    assert [(s["tick"], s["flags"], s["values"]) for s in answer["samples"]] == sent and len(sent) > 390


@pytest.mark.wide  # the Uno's and the Pico's images always
def test_the_committed_module_is_what_the_sources_give(tmp_path):
    try:
        built = build_image.build_web(tmp_path)
    except SystemExit as problem:
        pytest.skip(str(problem))
    assert built.read_bytes() == WEB.read_bytes(), "build it again: python firmware/build.py web"


@needs_node
@pytest.mark.wide
@pytest.mark.parametrize("word_bits", toolchain.WORD_BITS)
def test_golden_programs_give_the_committed_bits_in_a_library_for_pyodide(word_bits, tmp_path):
    made = toolchain.build_library(core_in_node.FIRMWARE, tmp_path, PYODIDE, word_bits)
    answer = in_node(made, side=True, runs=golden_runs(word_bits))
    assert set(answer["imports"]) <= GIVEN
    has_the_committed_bits(answer["runs"])
    assert toolchain.stamp(core_in_node.FIRMWARE, word_bits) in made.read_bytes()
