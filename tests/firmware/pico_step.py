"""What a step and the link take on the emulated Pico beside the scene: for ``measure_costs.py``, as whole_step.py on the Uno.

The step is the one interrupt of this firmware; USB is served between steps. A frame and an answer are what a turn of the
main loop takes longer that makes one.
"""

import numpy as np
from bare import Bench
from five_scenes import compiled, mass_and_wall, wall
from pico_bench import Rp2040
from pico_loop import emulated_pico, hapkit, image
from whole_step import OVERHEAD, springs

import hapticlab as hl
from hapticlab.compiler.boards.cost import SEARCH_MARGIN, tables

TICKS = 160
HAND = hl.Hand(m=0.1, b=2, k=200, push=1.5)
SETS = 30
HZ, CLOCK = 125e6, 1e-6  # of the processor; what the board's own clock counts in [s]


def watched_run(program, poll, sets=0):
    """Run; return the cycles of steps and of turns of the main loop, and the samples."""
    with emulated_pico(HAND, settings=hapkit()) as paddle:
        board = paddle.loop.board
        board.watch(poll)
        paddle.start(program, check_fit=False)
        board.costs()
        for k in range(sets):
            paddle.exchange.command("SET", sets_of(k), rest=sets_of(k) * (b"\0" + np.float32(20).tobytes()))
        paddle.wait(TICKS * 1e-3)
        steps, turns = board.costs()
        log = paddle.stop()
        assert log.fault is None, log.fault
        timing = paddle.timing
        late = max(timing.period_max - timing.T, timing.T - timing.period_min)
    return steps[10:-10], turns[10:-10], log, late


def sets_of(k):
    return 8 if k % 2 else 1


def beyond_idle(turns, count):
    """Return the median of the ``count`` longest turns beyond the usual one."""
    return float(np.median(np.sort(turns)[-count:]) - np.median(turns))


def awkward_more():
    """Return what the floats of the step take at most beyond their typical cost, by the table of operations."""
    of = tables()["pico"]["operations"]  # position, velocity, limits, duty by a square root, heat
    floats = ("itof", "mul", "sub", "mul", "lt", "lt", "div", "sqrt", "mul", "add", "mul", "mul", "add", "lt")
    return sum(of[op][1] - of[op][0] for op in floats)


def measure_pico_step():
    """Return the table's entries on the loop and the link, in cycles."""
    from build_image import build_image

    poll = build_image.elf_symbols(image().with_suffix(".elf"))["hl_core_poll"]
    cpu, typical = Rp2040(), []
    for program in (compiled(wall), compiled(mass_and_wall)):
        steps, _, log, _ = watched_run(program, poll)
        typical.append(np.median(steps) - np.median(Bench(program, cpu).run(log.x[:, None])[2]))
    most, frames = 0, []
    for channels in (0, 5):
        program = springs(channels)
        steps, turns, log, _ = watched_run(program, poll)
        most = max(most, steps.max() - np.median(Bench(program, cpu).run(log.x[:, None])[2]))
        frames.append((OVERHEAD + 4 * (3 + channels), beyond_idle(turns, TICKS // 2)))
    _, turns, _, late = watched_run(springs(0), poll, sets=SETS)
    answers = np.sort(turns)[-SETS:] - np.median(turns)
    one, eight = np.median(answers[: SETS // 2]), answers.max()
    each = max(0.0, (eight - one) / 7)
    per_byte = max(cycles / size for size, cycles in frames)  # nothing of it is left for a frame without bytes
    return {
        "step": [round(np.mean(typical)), round(most), round((most + awkward_more()) * (1 + SEARCH_MARGIN))],
        "frame": [0, round(per_byte, 1)],
        "answers": {"STATUS": [round(eight)], "SET": [round(one - each), round(each)]},
        "sample_bytes": OVERHEAD, "sent_byte": 0, "received_byte": 0, "late": round((late + CLOCK) * HZ), "edge": 0,
    }  # fmt: skip


if __name__ == "__main__":
    print(measure_pico_step())
