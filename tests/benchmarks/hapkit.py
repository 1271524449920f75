"""hapticlab's firmware beside the published Hapkit control loop: ``python tests/benchmarks/hapkit.py [--json FILE]``.

Both images run in the same emulated Uno, cycle by cycle, around the same simulated handle, and render the same wall. All
times are the board's own, in virtual time: the same on every machine. hapkit.c says what of the loop is described and
what is assumed. The firmware is built from the sources as they are, the sketch with the same compiler at -Os, as the
Arduino IDE does.
"""

import argparse
import json
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1]), str(HERE.parent / "firmware")]

import numpy as np  # noqa: E402
from emulator import CYCLES_PER_SECOND, missing  # noqa: E402
from hapkit_boards import FULL, METRES, K, Led, firmware, sketch, staircase, wall_force  # noqa: E402

import hapticlab as hl  # noqa: E402

HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.006 * np.sin(9 * t) + 0.002 * np.sin(31 * t))
SPEEDS = {"free": -0.0973, "wall": 0.0973}  # of a led handle [m/s], away from the wall and into it; no even counts a tick
SKETCH_LINE, FIRMWARE_LINE = 16e6 / 8 / 17 / 10, 50_000  # bytes/s that the lines carry
#: name, loops from one line of telemetry to the next, whether the Arduino core's clock runs
SKETCHES = (
    ("sketch, silent", 0, 1), ("sketch, line/10", 10, 1), ("sketch, line/1", 1, 1), ("silent, no millis", 0, 0),
)  # fmt: skip


def intervals(cycles):
    """Return what there is to say of the intervals between these cycles [s]."""
    taken = np.diff(cycles) / CYCLES_PER_SECOND
    return {
        "min": taken.min(), "median": np.median(taken), "max": taken.max(), "std": taken.std(), "range": np.ptp(taken)
    }  # fmt: skip


def loop_times(board, seconds):
    """Return rate, intervals and delays of the last ``seconds``, or None where the motor was not driven all the time."""
    begin = board.cycle - round(seconds * CYCLES_PER_SECOND)
    samples, updates = board.samples(), board.updates()
    if not updates[0] <= begin or board.cycle - updates[-1] > 0.01 * CYCLES_PER_SECOND:
        return None
    updates = updates[updates >= begin]
    delay = (updates - samples[np.searchsorted(samples, updates) - 1]) / CYCLES_PER_SECOND
    sample, update = intervals(samples[samples >= begin]), intervals(updates)
    rate = (len(updates) - 1) * CYCLES_PER_SECOND / (updates[-1] - updates[0])
    return {"rate": rate, "sample": sample, "update": update, "delay": np.median(delay), "delay_max": delay.max()}


def counted(board):
    """Let an emulated Uno count the bytes that were read from it, in ``board.arrived``."""
    read, board.arrived = board.read, 0

    def reading(size=65536):
        data = read(size)
        board.arrived += len(data)
        return data

    board.read = reading
    return board


def off_count(x):
    """Return how far positions are from whole counts of the sensor, at most [m]."""
    return np.abs(x - METRES * np.rint(x / METRES)).max() if len(x) else None


def speeds_seen(start, velocities):
    """Return the mean velocity that a loop sees over the true one, free and in the wall, and the deviation, free."""
    found = {}
    for name, speed in SPEEDS.items():
        with start() as board:
            board.loop.handle = Led(lambda t, speed=speed: speed * t)
            v = velocities(board)
            v = v[len(v) // 2 :]
            found[name] = v.mean() / speed
            found.setdefault("ripple", v.std() / abs(v.mean()))
    return found


def led_firmware(board):
    """Go on for a while, and return the velocity in the telemetry [m/s]."""
    board.wait(0.2)
    return board.stop().v


def force_error(start):
    """Return how far the force is off the wall's law on the staircase, at most [N]."""
    with start() as board:
        return np.abs(FULL * (staircase(board) / 256) ** 2 - wall_force()).max()


def measure_sketch(every, millis, seconds):
    """Return the figures of the published loop with a line of telemetry every so many loops, none for 0."""
    with sketch(every, millis, HAND) as board:
        uno = board.loop.board
        board.wait(0.2)
        uno.read()
        before = int(board.variable("lines", "uint32"))
        board.wait(seconds)
        times, text = loop_times(uno, seconds), uno.read()
        written = int(board.variable("lines", "uint32")) - before
    lines = text.split(b"\r\n")[1:-1]  # the first and the last may be cut
    waiting = 64 // 8 + 2  # lines that the buffer may hold, and those cut
    return times | {
        "samples": len(lines) / seconds, "reached": len(lines) / seconds / times["rate"],
        "content": "1 text, 10 um" if every else "none", "x_error": off_count(np.array([float(line) for line in lines])),
        "lost": max(0, written - len(lines) - waiting) if every else None, "link": len(text) / seconds / SKETCH_LINE,
        "velocity": speeds_seen(lambda: sketch(every, millis), lambda board: board.velocities(0.2)),
        "velocity_delay": 38.5 / times["rate"],
        "force": force_error(lambda: sketch(every, millis)), "overruns": None,
    }  # fmt: skip


def measure_firmware(T, seconds):
    """Return the figures of hapticlab's firmware at a period, or None where a step or a sample did not fit into it."""
    with firmware(T, HAND) as board:
        uno = counted(board.loop.board)
        board.wait(0.2)
        uno.arrived = 0
        board.wait(seconds)
        arrived, times = uno.arrived, loop_times(uno, seconds)
        log, timing = board.stop(), board.timing
    if times is None or log.fault or timing.overruns or timing.lost or log.gap.any():
        return None
    samples = np.count_nonzero(log.t > log.t[-1] - seconds) / seconds
    return times | {
        "samples": samples, "reached": samples / times["rate"], "content": "3 float32 + tick", "x_error": off_count(log.x),
        "lost": timing.lost, "link": arrived / seconds / FIRMWARE_LINE,
        "velocity": speeds_seen(lambda: firmware(T), led_firmware), "velocity_delay": 0.5 * T,
        "force": force_error(lambda: firmware(T)), "overruns": timing.overruns,
        "T": T, "step": timing.mean, "step_worst": timing.worst,
    }  # fmt: skip


def fastest(seconds, worst):
    """Return the figures at the least T, in steps of 10 us, at which, as at all longer ones, everything fits."""
    found = None
    for us in range(math.ceil(worst * 1e5) * 10 + 300, 249, -10):
        shorter = measure_firmware(us * 1e-6, seconds)
        if not shorter:
            break
        found = shorter
    return found


def measure(seconds=2.0):
    """Return the figures of every column of the table."""
    ours = measure_firmware(1e-3, seconds)
    fast = fastest(seconds, ours["step_worst"])
    columns = {"hapticlab 1 ms": ours, f"hapticlab {fast['T'] * 1e6:.0f} us": fast}
    for name, every, millis in SKETCHES:
        columns[name] = measure_sketch(every, millis, seconds)
    return columns


#: what, of the figures, factor, format, which way is better
ROWS = (
    ("loop rate [Hz]", "rate", 1, ".0f", 1),
    ("sensor sample to sample: median [us]", "sample.median", 1e6, ".1f", 0),
    ("  least [us]", "sample.min", 1e6, ".1f", 0),
    ("  most [us]", "sample.max", 1e6, ".1f", 0),
    ("  jitter, standard deviation [us]", "sample.std", 1e6, ".2f", -1),
    ("  jitter, peak to peak [us]", "sample.range", 1e6, ".1f", -1),
    ("motor update to update: median [us]", "update.median", 1e6, ".1f", 0),
    ("  least [us]", "update.min", 1e6, ".1f", 0),
    ("  most [us]", "update.max", 1e6, ".1f", 0),
    ("  jitter, standard deviation [us]", "update.std", 1e6, ".2f", -1),
    ("  jitter, peak to peak [us]", "update.range", 1e6, ".1f", -1),
    ("sensor sample to motor update: median [us]", "delay", 1e6, ".1f", -1),
    ("  most [us]", "delay_max", 1e6, ".1f", -1),
    ("samples that reach the PC [1/s]", "samples", 1, ".1f", 1),
    ("  what is in one", "content", 1, "", 0),
    ("  x off the sensor's count, most [um]", "x_error", 1e6, ".3f", -1),
    ("  of the loop's samples [%]", "reached", 100, ".1f", 1),
    ("  lost", "lost", 1, "d", -1),
    ("  share of the line [%]", "link", 100, ".1f", 0),
    ("velocity that the loop sees / true, free", "velocity.free", 1, ".3f", 0),
    ("  in the wall", "velocity.wall", 1, ".3f", 0),
    ("  its deviation at 0.097 m/s [%]", "velocity.ripple", 100, ".1f", -1),
    ("  its delay, computed [ms]", "velocity_delay", 1e3, ".2f", -1),
    ("wall's force off k (x - x_o), most [mN]", "force", 1e3, ".1f", -1),
    ("steps that missed their period", "overruns", 1, "d", 0),
)


def number(figures, path):
    """Return one of the figures: "sample.std" is the std of sample."""
    for name in path.split("."):
        figures = figures[name]
    return figures


def shown(value, first, factor, form):
    """Return a cell: the number, and its ratio to the first column's."""
    if value is None:
        return f"-{'':>10}"
    text = format(value * factor, form) if form else value
    ratio = f"{value / first:.3g} x" if form not in ("", "d") and first and value < 1000 * first else ""
    return f"{text}{ratio:>10}"


def worse(columns):
    """Return a line for everything in which one of hapticlab's columns is worse than one of the sketch's."""
    names, lines, group = list(columns), [], ""
    for what, path, factor, form, better in ROWS:
        group = group if what.startswith(" ") else what.split(":")[0].split(",")[0]
        row = f"{group}: {what.strip()}" if what.startswith(" ") else what
        values = {name: number(figures, path) for name, figures in columns.items()}
        for ours in names[:2] if better else ():
            gains = {n: better * (values[n] - values[ours]) for n in names[2:] if values[n] is not None}
            beaten = " and ".join(name for name, gain in gains.items() if gain > 0)
            lines += [f"  {ours}: {row}, {values[ours] * factor:{form}}, is worse than in {beaten}"] if beaten else []
    return lines


PAGE = Path(__file__).resolve().parents[2] / "docs" / "paddle" / "boards.md"
BEGIN, END = "<!-- written by tests/benchmarks/hapkit.py --page -->\n", "<!-- end -->\n"


def write_page(columns):
    """Write the table into docs/paddle/boards.md."""
    lines = ["| | " + " | ".join(columns) + " |", "|" + (len(columns) + 1) * "---|"]
    for what, path, factor, form, _ in ROWS:
        cells = [shown(number(figures, path), None, factor, form).strip() for figures in columns.values()]
        lines.append(f"| {what.strip()} | {' | '.join(cells)} |")
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    PAGE.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n\n" + END + rest.partition(END)[2], "utf-8")


def main(arguments=None):
    """Measure, print the table, and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE", help="also write the numbers to FILE")
    parser.add_argument("--page", action="store_true", help="also write the table into docs/paddle/boards.md")
    options = parser.parse_args(arguments)
    if missing():
        raise SystemExit(missing())
    columns = measure()
    print(f"One wall, {K:g} N/m, one emulated Uno, virtual time. Ratios are to the first column.\n")
    print(" " * 43 + "".join(f"{name:>19}" for name in columns))
    for what, path, factor, form, _ in ROWS:
        values = [number(figures, path) for figures in columns.values()]
        print(f"{what:<43}" + "".join(f"{shown(value, values[0], factor, form):>19}" for value in values))
    print(f"\n{SKETCHES[-1][0]}: the interrupt of the Arduino core's clock taken out of the sketch; none is published like that.")
    print("Where hapticlab's firmware does worse:\n" + "\n".join(worse(columns) or ["nowhere"]))
    if options.page:
        write_page(columns)
    if options.json:
        Path(options.json).write_text(json.dumps(columns, indent=1, default=float) + "\n")


if __name__ == "__main__":
    main()
