"""What a control step and a telemetry frame take on the Uno beside the scene: the real image, in the emulator.

The tick's interrupt is timed from its call to the end of its return, what interrupts it included; the machine's own cycles on
the same samples, counted by :mod:`bare`, are taken off. A frame is what hl_core_poll takes to send a sample, and an
interrupt for every byte.
"""

import tempfile
from dataclasses import replace

import numpy as np
from bare import Avr, Bench
from build_image import build
from closed_loop import ClosedLoop, PaddleHandle
from emulator import RAM_BEGIN, TIMER1_COMPA, USART_RX, USART_UDRE, Uno
from five_scenes import compiled, mass_and_wall, wall
from uno_port import offer

import hapticlab as hl
from hapticlab.device.settings import nominal

TICKS = 400
OVERHEAD = 11  # bytes of a sample's frame beside its numbers


class Watched(PaddleHandle):
    """A handle that notes the cycles of every tick, and memory as it is just after some of them."""

    def __init__(self, paddle):
        super().__init__(paddle)
        self.board, self.last, self.ticks, self.snapshots = None, (0, 0.0), [], []

    def step(self, force, seconds):
        if self.board is not None:
            count, mean, _ = self.board.cost(TIMER1_COMPA)
            if count == self.last[0] + 1:
                self.ticks.append(round(count * mean - self.last[1]))
                if len(self.ticks) % 5 == 0:
                    self.snapshots.append(self.board.memory[RAM_BEGIN:].tobytes())
            self.last = count, count * mean
        return super().step(force, seconds)


def watched_run(image, program, every=1):
    """Run on the emulated Uno; return the cycles of the last ticks, the samples, memory after ticks, costs of interrupts."""
    kept = replace(nominal("hapkit"), checked=1)
    with Uno(image, eeprom=kept.to_bytes()) as board:
        hand = hl.Hand(m=0.1, b=2, k=200, push=1.5)
        handle = Watched(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand))
        with hl.connect(offer("step", ClosedLoop.of(kept, board, handle))) as paddle:
            paddle.home(at=0.0)
            handle.board = board
            log = paddle.run(program, duration=TICKS * 1e-3, every=every, progress=False, check_fit=False)
            handle.board = None
        assert log.fault is None, log.fault
        return handle.ticks, log, handle.snapshots, [board.cost(v)[2] for v in (USART_UDRE, USART_RX)]


def frame_cycles(elf, snapshots, channels):
    """Return the bytes of a sample's frame, and the cycles of the hl_core_poll that sends it, from states of memory."""
    cpu, found, size = Avr(elf), [], OVERHEAD + 4 * channels
    for memory in snapshots:
        cpu.write(RAM_BEGIN, memory)
        before = cpu.read(cpu.place("tx_head"), 1)[0]
        cycles = cpu.call("hl_core_poll", cpu.place("uno_core"))[1]
        if (cpu.read(cpu.place("tx_head"), 1)[0] - before) % 256 == size:
            found.append(cycles)
    assert found, f"no poll sent {size} bytes"
    return size, float(np.median(found))


def measure_step():
    """Return ``step`` (typical, most) and ``frame`` ((fixed, per byte) typical and most) in cycles."""
    with tempfile.TemporaryDirectory() as folder:
        elf, image = build("uno", folder)
        steps, frames, cpu = [], [], Avr()
        for make in (wall, mass_and_wall):
            program = compiled(make)
            ticks, log, snapshots, (udre, rx) = watched_run(image, program)
            machine = np.median(Bench(program, cpu).run(log.x[:, None])[2])
            quiet = watched_run(image, program, every=20)[0]  # most ticks without a byte on its way
            # the first ticks are still idle, the last idle again
            steps.append((np.median(quiet[-TICKS + 20 : -20]) - machine, max(ticks[-TICKS + 20 : -20]) - machine))
            frames.append(frame_cycles(elf, snapshots, channels=3))
        scene, options = mass_and_wall()
        z = next(iter(scene.explicit().coordinates))
        watching = hl.Scene(scene.force, scene.eom, {"z": z, "z2": 2 * z, "z3": 3 * z}, scene.values, "watching")
        _, _, snapshots, _ = watched_run(image, hl.compile(watching, T=1e-3, **options))
        longer = frame_cycles(elf, snapshots, channels=6)
    shorter = frames[0]
    per_byte = (longer[1] - shorter[1]) / (longer[0] - shorter[0])
    fixed = max(cycles - per_byte * size for size, cycles in frames) + udre  # one interrupt more finds nothing to send
    frame = round(fixed), round(per_byte + udre, 1)
    return {
        "step": [round(np.mean([s[0] for s in steps])), round(max(s[1] for s in steps))],
        "frame": [list(frame), list(frame)], "sample_bytes": OVERHEAD, "received_byte": round(rx),
    }  # fmt: skip


if __name__ == "__main__":
    print(measure_step())
