"""Maps of a wall, 100 x 100 contacts of one second: seconds cold and again, against the sweep and against the picture.

``python tests/benchmarks/wall_maps.py`` prints the table. The clock counts here, not CPU time: a map that follows a slider has
both cores to itself. "cold" compiles; "again" is what a slider waits for, theory lines included.
"""

import sys
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

import numpy as np
from timing import row

import hapticlab as hl
from hapticlab.analysis.walls.wall_map import WallMaps
from hapticlab.analysis.walls.wall_map_plot import WallMapPicture

POINTS = 100
HAND = hl.Hand(m=0.02, b=1.0, k=200.0, push=1.0)
PLAIN = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, push=1.0))
ENCODER = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=2e4, hand=HAND)
FRICTION = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=2e4, coulomb=0.03, hand=HAND)
#: what -> paddle, how it is mapped, and the seconds that it may take again
MAPS = {
    "K and B, push": (PLAIN, {}, "< 0.2 s"),
    "K and B, hand and encoder": (ENCODER, {}, "< 0.2 s"),
    "K and B, hand and encoder, law ellis": (ENCODER, {"law": "ellis"}, "< 0.2 s"),
    "K and B, hand, encoder and Coulomb friction": (FRICTION, {}, "< 0.5 s"),
    "K and T, hand, encoder and Coulomb friction": (FRICTION, {"over": ("K", "T")}, "< 0.5 s"),
    "K and delay, hand and encoder": (ENCODER, {"over": ("K", "delay")}, "< 0.2 s"),
    "K and delay, hand, encoder and Coulomb friction": (FRICTION, {"over": ("K", "delay")}, "< 0.5 s"),
}


def clock(rounds, call):
    """Return the least seconds by the clock, and the least CPU seconds of all threads."""
    found = []
    for _ in range(rounds):
        wall, cpu = time.perf_counter(), time.process_time()
        call()
        found.append((time.perf_counter() - wall, time.process_time() - cpu))
    return tuple(min(column) for column in zip(*found, strict=True))


def rows(rounds):
    """Measure; the ratio is to the same map made for the first time, its compiling included."""
    lines = []
    for name, (paddle, given, target) in MAPS.items():
        cold, _ = clock(max(1, rounds // 3), lambda p=paddle, g=given: WallMaps(p, points=POINTS, **g).of(p))
        maps = WallMaps(paddle, points=POINTS, **given)
        found = maps.of(paddle)
        again, cpu = clock(rounds, lambda m=maps, p=paddle: m.of(p))
        lines.append(row(f"{name}: cold", cold))
        lines.append(row(f"{name}: again", again, against=cold, target=[target], note=f"{cpu:.2g} s of CPU"))
    return [*lines, *_sweep(rounds), _picture(rounds, found)]


def _sweep(rounds):
    """Measure hl.sweep over the points of two maps, for whose numbers the maps' own are the same."""
    lines = []
    for name, paddle in (("encoder", ENCODER), ("encoder and friction", FRICTION)):
        maps = WallMaps(paddle, points=POINTS)
        found, axes = maps.of(paddle), {"k": maps.axes["K"], "B": maps.axes["B"]}
        call = lambda p=paddle, a=axes: hl.sweep(hl.wall()(x_o=0.0), p, v=0.1, progress=False, workers=-1, **a)  # noqa: E731
        swept = call().values
        same = np.isclose(swept, found.amplitude, rtol=0, atol=0, equal_nan=True) | (found.amplitude > swept)
        note = f"{100 * same.mean():.4g} % of the amplitudes alike"
        lines.append(row(f"hl.sweep over K and B, hand and {name}", clock(rounds, call)[0], note=note))
    return lines


def _picture(rounds, found):
    picture = WallMapPicture(found, every=True)
    picture.figure.canvas.draw()

    def call():
        picture.show(found)
        picture.figure._repr_png_()

    return row("drawing a map into the picture, to PNG", clock(rounds, call)[0])


if __name__ == "__main__":
    for line in rows(6):
        ratio = "        " if line["ratio"] is None else f"{line['ratio']:6.2f} x"
        met = "".join(f" {t}: {'met' if m else 'MISSED'}" for t, m in zip(line["target"], line["met"], strict=True))
        print(f"{line['what']:<62}{line['value']:8.3f} s {ratio}{met} {line['note']}", flush=True)
