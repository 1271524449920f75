"""Programs on the engine wasm in node, by the JavaScript beside this file."""

import base64
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np

from hapticlab.compiler.engines.wasm_emit import at_once, emit
from hapticlab.compiler.engines.wasm_lanes import ONE

NODE = shutil.which("node")


def case(program, ticks, inputs, parameters, states=None, every=1, rounds=0):
    """Return a case: a run as the contract of an engine has it, timed so many times after the first."""
    lanes = parameters.shape[1]
    width = at_once(program) if lanes % 2 == 0 else ONE
    carried = np.zeros((len(program.states), lanes)) if states is None else states
    arrays = {"inputs": inputs, "parameters": parameters, "states": carried}
    return {
        "code": _text(emit(program, width)), "ticks": ticks, "every": every, "lanes": lanes, "resumed": states is not None,
        "size": ticks // every * len(program.outputs) * lanes, "rounds": rounds, **{k: _text(a) for k, a in arrays.items()},
        "shapes": [(ticks // every, len(program.outputs), lanes), carried.shape],
    }  # fmt: skip


def in_node(cases):
    """Run all cases in one process of node, and return of each outputs, states, and what node says of it."""
    done = subprocess.run([NODE, Path(__file__).with_suffix(".mjs")], input=json.dumps(cases), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return [
        (*(_array(said.pop(name), shape) for name, shape in zip(("outputs", "states"), given["shapes"], strict=True)), said)
        for given, said in zip(cases, json.loads(done.stdout), strict=True)
    ]


def _text(data):
    data = data if isinstance(data, bytes) else np.ascontiguousarray(data, "<f8").tobytes()
    return base64.b64encode(data).decode()


def _array(text, shape):
    return np.frombuffer(base64.b64decode(text), "<f8").reshape(shape)
