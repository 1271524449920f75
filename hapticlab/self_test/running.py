"""Checks of what runs a scene: the engines to the bit, the whole protocol, sweeps by processes, and pictures."""

import hashlib
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..analysis.records.plot import plot
from ..analysis.sweeps.sweep import sweep
from ..cli.scene_file import load_scene, report_of, run_scene
from ..compiler.engines.engine import load
from ..compiler.engines.table import ENGINES
from ..compiler.ir.program import Channel, Program
from ..compiler.ir.trace import Builder, cos, exp, maximum, select, sin, tanh
from ..compiler.tick.compile_scene import compile
from ..device.hand.hand import Hand
from ..device.setup.connect import connect
from ..device.setup.doctor import doctor
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import EngineMissingError
from ..scene.laws.chapter_laws import wall
from .outcome import Attention, need

TICKS = 64
#: m: by how much a handle may move differently on a board, which computes in float32
FAR = 1e-5
EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "mass_on_coupler.py"
PNG = b"\x89PNG\r\n\x1a\n"


def rubbing_wall():
    """Return a float32 program: a wall with a filtered velocity, and a count of the samples inside it."""
    b = Builder("f32")
    init = b.block(states=[b.leaf("input", 0, "f32"), b.const(0.0, "f32"), b.const(0, "i32")])
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    last, speed, count = (b.leaf("state", k, kind) for k, kind in enumerate(("f32", "f32", "i32")))
    k, x_o, damping = (b.leaf("param", which, "f32") for which in range(3))
    speed = speed * 0.9 + (x - last) * 100.0
    force = select(x_o <= x, maximum(k * (x - x_o) + damping * speed, 0.0), 0.0)
    count = b.emit("iadd", count, b.const(1, "i32"))
    tick = b.block([force, count], [x, speed, count])
    states = Channel("last", "m"), Channel("speed", "m/s"), Channel("count", "1", "i32")
    given = Channel("k", "N/m"), Channel("x_o", "m"), Channel("damping", "N*s/m")
    outputs = Channel("F", "N"), Channel("count", "1", "i32")
    return Program("rubbing wall", (Channel("x", "m"),), given, states, outputs, init, tick, 1e-3, (150.0, 0.01, 2.0))


def turning():
    """Return a float32 program of elementary functions, whose three states change places in each tick."""
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    init = b.block(states=[x, x * 2.0, x * 3.0])
    b = Builder("f32")
    s = [b.leaf("state", which, "f32") for which in range(3)]
    tick = b.block([sin(s[0]) * cos(s[0]), exp(-abs(s[1])), tanh(s[2])], [s[1], s[2] * 1.01, s[0] * 0.99])
    states, outputs = (tuple(Channel(name) for name in names) for names in ("abc", "FGH"))
    return Program("turning", (Channel("x"),), (), states, outputs, init, tick, 1e-3)


#: SHA-256 of the outputs as little-endian float32; tests compare it with the interpreter's
GOLDEN = {
    rubbing_wall: "3894f3ec074600f1ed0023237019e86413a953560e2b8db07111c538e1fc0611",
    turning: "783c593954e13dc54fe8bf28c383227639f8101f65c2f0bd3cc98e5a70f88a81",
}


def bits(program, engine):
    """Return the SHA-256 of what an engine gives for a program, over a motion whose samples are exact in float32."""
    rows = (np.arange(TICKS) % 23 + 1.0)[:, None] / 1024
    return hashlib.sha256(load(program, engine).run(TICKS, rows).outputs.astype("<f4").tobytes()).hexdigest()


def engines(folder):
    """Run golden programs and a scene on every engine; each must give the stored bits, and all the same ones."""
    there, missing = [], []
    scene = compile(load_scene(EXAMPLE).scene, T=1e-3)
    for engine, record in ENGINES.items():
        try:
            found = {make: bits(make(), engine) for make in GOLDEN} | {"scene": bits(scene, engine)}
        except EngineMissingError as problem:
            if not record.extra:
                missing.append(f"{engine}: {problem}")
            continue
        wrong = [make.__name__ for make, golden in GOLDEN.items() if found[make] != golden]
        need(not wrong, f"{engine} gives bits that differ from the stored ones for {', '.join(wrong)}: {list(found.values())}")
        there.append((engine, found["scene"]))
    names = ", ".join(name for name, _ in there)
    need(len({found for _, found in there}) <= 1, f"the engines give different bits for a scene: {there}")
    if missing:
        raise Attention(f"the stored bits by {names or 'no engine'}. Not here: {'; '.join(missing)}")
    return f"the stored bits by {names}"


def link(folder):
    """Run a wall with the whole protocol, and on the same paddle without it; then take the doctor's walk."""
    hand = Hand(m=0.02, b=1.0, k=200.0, push=2.0)
    mechanics = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand)
    try:
        with connect("sim://hapkit", paddle=mechanics, T=mechanics.T) as board:
            log = board.run(wall()(k=150, x_o=0.002), duration=0.5, progress=False)
            lost = board.timing.lost
    except EngineMissingError as problem:
        raise Attention(str(problem)) from None
    alone = mechanics.run(wall()(k=150, x_o=0.002), duration=0.5, progress=False)
    apart = float(np.abs(log.x - alone.x).max())
    need(len(log) == 500 and not lost, f"{len(log)} of 500 samples, {lost} lost")
    need(apart < FAR, f"with the protocol the handle moves differently, by up to {apart:g} m")
    report = doctor("sim://hapkit")
    faults = [str(check) for check in report.checks if check.state == "fault" and check.name != "computer"]
    need(not faults, "; ".join(faults))
    return f"500 samples, none lost; the handle moves as without the protocol, to {apart:.1g} m"


def sweeps(folder):
    """Map a wall by two processes that start from nothing, as on Windows; the map must be that of one process."""
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(push=2.0))
    asked = {"duration": 0.3, "k": [50.0, 200.0, 800.0, 3200.0], "progress": False}
    alone = sweep(wall()(x_o=0), paddle, **asked).values
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        shared = sweep(wall()(x_o=0), paddle, **asked, workers=pool.map).values
    need(np.array_equal(alone, shared, equal_nan=True), f"two processes give {shared}, one gives {alone}")
    return f"{alone.size} points; two processes give the same bits as one"


def scene(folder):
    """Run a scene with equations of motion, compare where it rests with statics, and draw it."""
    program, log = run_scene(replace(load_scene(EXAMPLE), duration=3.0))
    # push = K (x - z) + k_h x and K (x - z) = k_w (z - z_o)
    x, z = np.linalg.solve([[500.0, -300.0], [300.0, -2300.0]], [2.0, -10.0])
    off = max(abs(log.x[-1] - x), abs(log.z[-1] - z))
    need(off < 1e-6, f"the handle and the mass come to rest {off:g} m from the static equilibrium")
    figure, samples = folder / "scene.png", report_of(program, log)["samples"]
    plot(log, "x", "z", "F").savefig(figure)
    need(figure.read_bytes().startswith(PNG), "the figure is not a PNG file")
    return f"{samples} samples; the handle rests {off:.1g} m from the static equilibrium. The figure is a PNG file"
