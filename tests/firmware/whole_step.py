"""What a control step, a telemetry frame and a request take on the Uno beside the scene: the real image, in the emulator.

The tick's interrupt is timed from its call to the end of its return, in ticks that nothing interrupts; the machine's own
cycles on the same samples, counted by :mod:`bare`, are taken off. The most is the longest of these ticks, and for the
floats of the step what awkward operands take more than its own: of the motor searched in the image, of position and
velocity from the table of operations. A frame is what hl_core_poll takes to send a sample, an answer what it takes
to answer STATUS or SET, and to follow the motor's heat; an interrupt comes with every byte.
"""

import tempfile
from dataclasses import replace

import numpy as np
from bare import Avr, Bench
from build_image import build
from closed_loop import ClosedLoop, PaddleHandle
from emulator import INT0, INT1, RAM_BEGIN, TIMER1_COMPA, USART_RX, USART_UDRE, Uno
from five_scenes import compiled, mass_and_wall, wall
from uno_port import offer

import hapticlab as hl
from hapticlab.compiler.boards.cost import SEARCH_MARGIN, tables
from hapticlab.compiler.boards.link_traffic import HEAT_TICKS
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.wire import decode, encode

TICKS = 400
OVERHEAD = 11  # bytes of a sample's frame beside its numbers
RARELY = 17  # ticks a sample, coprime with the 16 of the heat: a tick of both is among those watched
SOONEST = 8 * 8  # cycles before its end in which a step has to set the next tick, main.c
LATE_T = 0.807e-3  # [s], no multiple of the 50 us in which the host looks
#: cycles of an interrupt that the emulator's count of it lacks: 4 of the return, and 4 in which a processor answers it
ANSWERED = 8
EDGE = 95 + ANSWERED  # cycles of an encoder's interrupt at most
OTHERS = USART_UDRE, USART_RX, INT0, INT1  # interrupts that may come into a tick
REGISTER_20 = 20  # where the first four bytes after a pointer are given to a function


class Watched(PaddleHandle):
    """A handle that notes the cycles of every tick, those that nothing interrupted, and memory just after some of them."""

    def __init__(self, paddle):
        super().__init__(paddle)
        self.board, self.last, self.bytes, self.ticks, self.snapshots = None, (0, 0.0), 0, [], []

    def step(self, force, seconds):
        if self.board is not None:
            count, mean, _ = self.board.cost(TIMER1_COMPA)
            if count == self.last[0] + 1:
                before, self.bytes = self.bytes, sum(self.board.cost(v)[0] for v in OTHERS)
                self.ticks.append((round(count * mean - self.last[1]), self.bytes == before))
                if len(self.ticks) % 5 == 0:
                    self.snapshots.append(self.board.memory[RAM_BEGIN:].tobytes())
            self.last = count, count * mean
        return super().step(force, seconds)


def watched_run(image, program, every=1):
    """Run on the emulated Uno; return the handle, the samples, costs of interrupts and the last requests' frames."""
    kept = replace(nominal("hapkit"), wired=1, checked=1)
    with Uno(image, eeprom=kept.to_bytes()) as board:
        hand = hl.Hand(m=0.1, b=2, k=200, push=1.5)
        handle = Watched(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand))
        with hl.connect(offer("step", ClosedLoop.of(kept, board, handle))) as paddle:
            paddle.home(at=0.0)
            handle.board = board
            log = paddle.run(program, duration=TICKS * 1e-3, every=every, progress=False, check_fit=False)
            handle.board = None
            requests = [encode("STATUS", 0, paddle.exchange.session)] + [set_frame(paddle.exchange, n) for n in (1, 8)]
        assert log.fault is None, log.fault
        return handle, log, [board.cost(v)[2] for v in (USART_UDRE, USART_RX)], requests


HELD = 0.02  # where a handle is held whose force fades out [m]


def faded(image):
    """Return the cycles of ticks in which a force fades out, of a handle that does not move for longer than a second."""
    kept = replace(nominal("hapkit"), wired=1, checked=1)
    with Uno(image, eeprom=kept.to_bytes()) as board:
        handle = Watched(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
        handle.handle.step = lambda force: None
        with hl.connect(offer("faded", ClosedLoop.of(kept.to_float32(), board, handle))) as paddle:
            paddle.home(at=HELD)
            paddle.start(springs(5), every=RARELY, check_fit=False)
            paddle.set(k=60)
            paddle.wait(1.05)
            handle.board = board
            paddle.wait(0.4)
            handle.board = None
    return quiet(handle)


def set_frame(exchange, count):
    """Return a SET of the first parameter, ``count`` times, as the board would obey it next."""
    rest = count * (b"\0" + np.float32(123.4).tobytes())
    return encode("SET", exchange._next_sequence("SET"), count, rest=rest, session=exchange.session)


def quiet(handle):
    """Return the cycles of the ticks that nothing interrupted; the first are still idle, the last idle again."""
    return np.array([cycles for cycles, alone in handle.ticks[20:-20] if alone])


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


def answer_cycles(elf, snapshots, request):
    """Return the most cycles that hl_core_poll takes to answer a request."""
    cpu, found = Avr(elf), []
    core, ring = cpu.place("uno_core"), cpu.place("tx")
    for memory in snapshots[4:-4]:  # those of the program running
        cpu.write(RAM_BEGIN, memory)
        for byte in request:
            cpu.call("hl_core_byte", core, byte)
        head = cpu.read(cpu.place("tx_head"), 1)[0]
        cycles = cpu.call("hl_core_poll", core)[1]
        size = (cpu.read(cpu.place("tx_head"), 1)[0] - head) % 256
        frame = decode(bytes(cpu.read(ring + (head + k) % 128, 1)[0] for k in range(size - 1))) if size else None
        if frame is not None and frame.message in ("ACK", "STATE"):
            assert frame.message == "STATE" or frame.fields["result"] == 0
            found.append(cycles)
    assert found, "no poll answered"
    return max(found)


def heat_cycles(elf, snapshots):
    """Return the most cycles that hl_heat_follow takes, once in HEAT_TICKS ticks, with no force, some and all."""
    cpu, found = Avr(elf), []
    core = cpu.place("uno_core")
    for memory in snapshots[4:-4:4]:
        for part in (0, 20_000, 65_535):
            cpu.write(RAM_BEGIN, memory)
            for _ in range(HEAT_TICKS):
                cpu.call("hl_heat", core, part)
            found.append(cpu.call("hl_heat_follow", core)[1])
    return max(found)


def awkward_more(elf, snapshots):
    """Return what the motor takes at most with any force within 10 N, beyond its most with one of 1.234 N."""
    from measure_costs import awkward_bits  # which imports this module

    cpu, rng, worst = Avr(elf), np.random.default_rng(3), [0, 0]
    core = cpu.place("uno_core")
    usual = np.full((64, 1), 1.234, np.float32).view(np.uint8)
    for memory in snapshots[10:-10]:
        bits = awkward_bits(rng, 2000)
        force = bits.view(np.float32)
        awkward = bits[np.abs(np.where(np.isfinite(force), force, 99)) <= 10][:200, None].view(np.uint8)  # heat_ticks < 255
        for k, rows in enumerate((usual, awkward)):
            cpu.write(RAM_BEGIN, memory)
            worst[k] = max(worst[k], int(cpu.rows("hl_motor", (core,), REGISTER_20, rows, 24, 2)[1].max()))
    of = tables()["uno"]["operations"]  # x = counts * metres_per_count, v = (x - x_before) * rate
    return max(0, worst[1] - worst[0]) + sum(of[op][1] - of[op][0] for op in ("itof", "mul", "sub", "mul"))


def latest(image, values):
    """Return by how many cycles a tick was late at most while SETs came, one at every phase of the period."""
    kept = replace(nominal("hapkit"), wired=1, checked=1)
    program, worst = compiled(wall, T=LATE_T), 0
    with Uno(image, eeprom=kept.to_bytes()) as board:
        handle = PaddleHandle(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.1, b=2, k=200)))
        with hl.connect(offer("late", ClosedLoop.of(kept, board, handle)), T=LATE_T) as paddle:
            paddle.home(at=0.0)
            paddle.start(program, every=20, check_fit=False)
            for k in range(250):
                paddle.exchange.command("SET", values, rest=values * (b"\0" + np.float32(150).tobytes()))
                paddle.exchange.wait(lambda: False, LATE_T * (2 + k * 0.382))
            assert paddle.stop().fault is None
            timing = paddle.timing
            worst = max(timing.period_max - timing.T, timing.T - timing.period_min)
    return worst * 16e6


def springs(channels):
    """Return a spring that shows so many more of its products: its time hardly depends on its numbers."""
    k, x = hl.parameters("k", units="N/m"), hl.x(hl.n)
    shown = {f"F{j}": k * x * (j + 1) for j in range(1, channels + 1)}
    return hl.compile(hl.Scene(k * x, watch=shown, name="springs")(k=20), T=1e-3)


def measure_step():
    """Return the table's entries on the loop and the link, in cycles."""
    with tempfile.TemporaryDirectory() as folder:
        elf, image = build("uno", folder)
        typical, frames, cpu = [], [], Avr()
        for program in (compiled(wall), compiled(mass_and_wall), springs(5)):
            handle, log, _, requests = watched_run(image, program, every=RARELY)
            machine = np.median(Bench(program, cpu).run(log.x[:, None])[2])
            typical.append(np.median(quiet(handle)) - machine)
        most = max(quiet(handle)) - machine  # springs: with every channel, in a tick of heat and record
        few, log, _, _ = watched_run(image, springs(0), every=RARELY)
        channel = (most - max(quiet(few)) + np.median(Bench(springs(0), cpu).run(log.x[:, None])[2])) / 5
        fading = max(faded(image)) - np.median(Bench(springs(5), cpu).run(np.full((20, 1), HELD))[2])
        most = max(most, fading)
        late = max(latest(image, values) for values in (1, 8))
        more = awkward_more(elf, handle.snapshots)
        heat = heat_cycles(elf, handle.snapshots)
        answers = [answer_cycles(elf, handle.snapshots, request) for request in requests]
        for channels in (0, 3):
            handle, _, (udre, rx), _ = watched_run(image, springs(channels))
            frames.append(frame_cycles(elf, handle.snapshots, 3 + channels))
    status, one, eight = answers
    each = (eight - one) / 7
    per_byte = (frames[1][1] - frames[0][1]) / (frames[1][0] - frames[0][0])
    return {
        "step": [round(np.mean(typical[:2])), round(most) + SOONEST, SOONEST + round((most + more) * (1 + SEARCH_MARGIN))],
        "frame": [round(frames[0][1] - per_byte * frames[0][0]), round(per_byte, 1)],
        "answers": {"STATUS": [status], "SET": [round(one - each), round(each)]},
        "channel": int(channel), "heat": heat, "sample_bytes": OVERHEAD, "late": round(late), "edge": EDGE,
        "sent_byte": round(udre) + ANSWERED, "received_byte": round(rx) + ANSWERED,
    }  # fmt: skip


if __name__ == "__main__":
    print(measure_step())
