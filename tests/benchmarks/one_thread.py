"""Frames a second of a live view in Pyodide, in node, where Python has one thread: python tests/benchmarks/one_thread.py.

The page is scripted. It drags the hand along a slow sinusoid and says every 0.4 s that it is there; it lets the hand be; then a
cell awaits for 3 s, in which no word of the page is heard; then a cell computes for 2 s.
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "pyodide"))
from in_pyodide import run_in_pyodide

VIEW = """
import asyncio, json, math, time
import numpy as np
import hapticlab as hl
from hapticlab.widgets.browser_view import Speaker
from hapticlab.widgets.session import Session

async def part(session, times, turns, seconds, leads=False, heard=True):
    first, turned, begun = len(times), len(turns), time.perf_counter()
    said = begun
    while (now := time.perf_counter()) < begun + seconds:
        if leads:
            session.intend(0.02 * math.sin(4 * now))
        if heard and now > said + 0.4:
            session.alive("page")
            said = now
        await asyncio.sleep(1 / 60)
    gaps = np.diff(times[first:])
    return [1 / np.mean(gaps), *(1e3 * np.percentile(gaps, [50, 95])), 1e3 * np.median(turns[turned:])]

async def measured(scene):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    session, times, sizes, turns = Session(paddle, scene), [], [], []
    speaker, turn = Speaker(lambda news, buffers: sizes.append(len(json.dumps(news)) + len(buffers[0]))), session.turn

    def timed():
        begun = time.perf_counter()
        looks = turn()
        turns.append(time.perf_counter() - begun)
        return looks

    def sink(frame):
        times.append(time.perf_counter())
        speaker.say(frame)

    session.turn = timed
    session.connect(sink)
    session.ready("page")
    await asyncio.sleep(2)
    parts = {
        "dragged": await part(session, times, turns, 5, leads=True),
        "let be": await part(session, times, turns, 5),
        "a cell awaits": await part(session, times, turns, 3, heard=False),
    }
    until = time.perf_counter() + 2
    while time.perf_counter() < until:
        pass
    session.alive("page")
    ended, first = time.perf_counter(), len(times)
    while len(times) == first:
        await asyncio.sleep(0)
    late, words = 1e3 * (times[-1] - ended), session.status
    session.close()
    await asyncio.sleep(0.1)
    return {"parts": parts, "bytes": float(np.mean(sizes)), "late": late, "words": words}

scenes = {
    "wall": hl.wall()(k=300, x_o=0.01), "cart-pole": hl.library.cart_pole(), "two masses": hl.library.two_masses(),
}
print(json.dumps({name: await measured(scene) for name, scene in scenes.items()}))
"""


def main():
    print("| scene | | frames/s | between frames, median and 95th percentile | a turn, median |\n| --- | --- | --- | --- | --- |")
    measured = json.loads(run_in_pyodide(VIEW))
    for scene, found in measured.items():
        for name, (rate, middle, most, turn) in found["parts"].items():
            print(f"| {scene} | {name} | {rate:.1f} | {middle:.1f} ms, {most:.1f} ms | {turn:.1f} ms |")
    for scene, found in measured.items():
        print(f"\n{scene}: {found['bytes']:.0f} bytes a frame; {found['late']:.0f} ms after a long cell: {found['words']}")


if __name__ == "__main__":
    main()
