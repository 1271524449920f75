"""The firmware's core as WebAssembly, run by node: ``web/in_node.mjs`` loads it as a page or as Pyodide would."""

import base64
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
from build_image import FIRMWARE
from host_driver import Host, settings
from test_golden import GOLDEN, array

from hapticlab.compiler.engines.bytecode import layout
from hapticlab.device.board.host_board import HostBoard

WEB = FIRMWARE / "prebuilt" / "web.wasm"
HERE = Path(__file__).resolve().parent / "web"


def missing():
    """Why there can be none here, or None."""
    return None if shutil.which("node") else "the core as WebAssembly is run by node 18 or newer"


def in_node(module, **asked):
    """Return what ``web/in_node.mjs`` answers about a module."""
    asked = json.dumps({"module": str(module), **asked})
    done = subprocess.run(["node", HERE / "in_node.mjs"], input=asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def packed(numbers):
    return base64.b64encode(np.ascontiguousarray(numbers, "<f8").tobytes()).decode()


def unpacked(text):
    return np.frombuffer(base64.b64decode(text), "<f8")


def run_of(data, inputs, values, outputs, states):
    """Return what asks for a run of ``hl_host_run``; data: the program's bytes."""
    ticks = len(inputs)
    asked = {
        "program": data.hex(),
        "registers": layout(data).size["registers"],
        "ticks": ticks,
        "outputs": outputs,
        "states": states,
    }
    return asked | {"inputs": packed(inputs), "values": packed(values)}


def golden_runs(word_bits):
    runs = []
    for g in GOLDEN:
        inputs = array(g["given"], len(g["given"]) // len(g["inputs"]), -1)
        values = array(g["values"], -1)
        runs.append(run_of(bytes.fromhex(g[f"bytes_{word_bits}"]), inputs, values, len(g["outputs"]), len(g["states"])))
    return runs


class Recorded(HostBoard):
    """This computer's board, which notes what is done to it and what it answers."""

    def __init__(self, store):
        super().__init__(store)
        self.script, self.answers = [], []

    def receive(self, data):
        self.script.append(["receive", data.hex()])
        super().receive(data)

    def transmit(self):
        said = super().transmit()
        self.script.append(["transmit"])
        self.answers.append(said.hex())
        return said

    def tick(self, counts, now, step=0.0):
        duty = super().tick(counts, now, step)
        self.script.append(["tick", counts, now, step])
        self.answers.append(duty)
        return duty


def recorded_host(**kept):
    """Return somebody who talks to a board that notes it."""
    return Host(Recorded(settings(**kept).to_bytes()))
