"""Three shared files in a headless Chromium: their size, frames a second, pointer to paint, and what a tick costs.

``python tests/benchmarks/shared_file.py [--seconds 10] [--write]``; ``--write`` puts the tables into docs/how_to/sharing.md. A
hand drags the handle, then jumps and rests, as in ``live_view.py``; a picture is shown when its pixels differ from those before.
A tick is that of the module alone in node, which has the engine of Chromium: the best of several rounds. The second table
compares what a page could run: the linked program, or the firmware's core, which runs the scene's bytes and needs a paddle
around it.
"""

import argparse
import gzip
import math
import os
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), *(str(HERE.parent / name) for name in ("browser", "compiler", "firmware"))]

import numpy as np  # noqa: E402
from core_in_node import WEB, run_of  # noqa: E402
from core_in_node import in_node as core_in_node  # noqa: E402
from in_node import case, in_node  # noqa: E402
from lab import browsing  # noqa: E402
from live_view import HAND, JUMPS, MOVES, gaps_of, paint_times, quantile  # noqa: E402
from owner_pages import write_block  # noqa: E402

import hapticlab as hl  # noqa: E402
from hapticlab.compiler.engines.bytecode import encode  # noqa: E402
from hapticlab.compiler.engines.wasm_emit import emit  # noqa: E402
from hapticlab.device.simulated.closed_loop import link  # noqa: E402
from hapticlab.device.simulated.stepping import with_grip  # noqa: E402

PAGE = HERE.parents[1] / "docs" / "how_to" / "sharing.md"
PADDLE = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
TICKS, ROUNDS = 20_000, 9
SCENES = {
    "wall": (hl.wall()(k=300, x_o=0.01), {}),
    "four-bar linkage": (hl.library.four_bar(), {}),
    "ball on the paddle, taylor": (hl.library.ball_on_the_paddle(), {"method": "taylor"}),
}
HEADS = (
    "| shared file | bytes | gzipped | frames/s | gap, 95th | work per frame | pointer to paint, median | 95th | requests |",
    "| scene | linked program: bytes, held and let go | tick | firmware's core: bytes with the scene's | tick, no paddle |",
)


#: notes when the pointer moved, and when a picture was shown that differs, with the place of what has the hand's colour in it
SEEN = """(hand) => {
  const canvas = document.querySelector("canvas.hl-stage"), context = canvas.getContext("2d")
  const found = (window.found = { shown: [], moves: [] })
  let before = 0
  canvas.addEventListener("pointermove", (e) => found.moves.push([e.timeStamp, 0]), true)
  canvas.parentElement.addEventListener("painted", () => {
    const [w, h] = [canvas.width, canvas.height]
    const pixels = context.getImageData(0, 0, w, h).data
    let [sum, place, count] = [0, 0, 0]
    for (let y = 0; y < h; y += 2) {
      for (let x = 0, i = 4 * w * y; x < w; x++, i += 4) {
        sum = (31 * sum + pixels[i] + 7 * pixels[i + 1]) | 0
        if (Math.abs(pixels[i] - hand[0]) + Math.abs(pixels[i + 1] - hand[1]) + Math.abs(pixels[i + 2] - hand[2]) > 60) continue
        place += x - y
        count += 1
      }
    }
    if (sum !== before) found.shown.push([performance.now(), place / count])
    before = sum
  })
}"""

COUNTED = """() => {
  window.painted = 0
  document.querySelector(".hl-live").addEventListener("painted", () => (window.painted += 1))
}"""


class Hand:
    """A pointer on the handle, which moves along its way."""

    def __init__(self, page):
        box = page.locator("canvas.hl-stage").bounding_box()
        upright = page.locator("canvas.hl-stage").get_attribute("aria-orientation") == "vertical"
        self.page, self.way = page, (0, -1) if upright else (1, 0)
        self.x, self.y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.move(0)
        page.mouse.down()

    def move(self, pixels):
        self.page.mouse.move(self.x + pixels * self.way[0], self.y + pixels * self.way[1])

    def drag(self, seconds):
        """Go to and fro, and back."""
        begun = time.perf_counter()
        for k in range(int(seconds * MOVES)):
            time.sleep(max(0.0, begun + k / MOVES - time.perf_counter()))
            self.move(50 * math.sin(2 * math.pi * 0.6 * (time.perf_counter() - begun)))
        self.move(0)
        self.page.wait_for_timeout(700)

    def jump(self, count):
        """Jump and rest, out of step with the frames."""
        self.page.evaluate("window.found.shown.length = window.found.moves.length = 0")
        for k in range(count):
            self.move(20 * ((k + 1) % 2))
            self.page.wait_for_timeout(300 + 7 * (k % 11))


def table(head, rows):
    return "\n".join([head, "|" + " --- |" * (head.count("|") - 1), *rows]) + "\n"


def work_per_frame(page, hand):
    """Return the processor time of the page's main thread for a frame, while a hand drags and nothing looks at pixels [ms]."""
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.evaluate(COUNTED)

    def now():
        metrics = session.send("Performance.getMetrics")["metrics"]
        return next(one["value"] for one in metrics if one["name"] == "TaskDuration"), page.evaluate("window.painted")

    begun, first = now()
    hand.drag(3.0)
    ended, last = now()
    return 1000 * (ended - begun) / (last - first)


def dragged(browser, path, seconds):
    """Return frames a second; the gap between them, the work of one, pointer to paint [ms]; and requests beyond the file."""
    page, asked = browser.new_page(viewport={"width": 1000, "height": 800}), []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    page.wait_for_function("() => document.querySelector('.hl-status')?.textContent.startsWith('Running')")
    hand = Hand(page)
    hand.drag(1.0)
    work = work_per_frame(page, hand)
    page.evaluate(SEEN, list(bytes.fromhex(HAND[1:])))
    hand.drag(seconds)
    found = page.evaluate("window.found")
    hand.jump(JUMPS)
    jumped = page.evaluate("window.found")
    page.close()
    gaps = gaps_of(found)
    paints = paint_times(jumped["moves"], jumped["shown"])
    assert len(paints) > JUMPS / 2, "the hand was seen to move"
    times = quantile(gaps, 0.95), work, quantile(paints, 0.5), quantile(paints, 0.95)
    return 1000 * len(gaps) / sum(gaps), times, len(asked) - 1


def tick_of(linked, values):
    """Return what a tick of a linked program takes in node [us]."""
    inputs = np.zeros((TICKS, len(linked.inputs)))
    inputs[:, 0] = 0.015 * np.sin(np.arange(TICKS) * 6e-3)  # the intent: in and out of contact
    ((_, _, said),) = in_node([case(linked, TICKS, inputs, np.array(values)[:, None], every=TICKS, rounds=ROUNDS)])
    return 1e3 * said["best"] / TICKS


def core_of(program):
    """Return the bytes of the firmware's core and a scene's program, and what a tick of the scene alone takes [us]."""
    data = encode(program, word_bits=16)
    inputs = np.zeros((TICKS, len(program.inputs)))
    inputs[:, 0] = 0.015 * np.sin(np.arange(TICKS) * 6e-3)
    asked = run_of(data, inputs, np.array(program.values), len(program.outputs), len(program.states))
    (answer,) = core_in_node(WEB, runs=[asked | {"rounds": ROUNDS}])["runs"]
    return WEB.stat().st_size + len(data), answer["ns"] / 1e3 if answer["result"] == 0 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging, each")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/how_to/sharing.md")
    given = parser.parse_args()
    files, choices, paddle = [], [], with_grip(PADDLE)
    with tempfile.TemporaryDirectory() as folder, browsing() as browser:
        for name, (scene, options) in SCENES.items():
            shared = hl.share(scene, PADDLE, Path(folder) / "shared.html", **options)
            packed = len(gzip.compress(shared.path.read_bytes()))
            frames, times, more = dragged(browser, shared.path, given.seconds)
            program = paddle.program(scene, **options)
            linked = link(program, paddle)
            tick = tick_of(linked, (*program.values, *paddle.plant_values()))
            shown = " | ".join(f"{each:.1f} ms" for each in times)
            files.append(f"| {name} | {shared.bytes:,} | {packed:,} | {frames:.1f} | {shown} | {more} |")
            both = len(emit(linked)), len(emit(link(program, replace(paddle, hand=None))))
            size, alone = core_of(program)
            runs = f"{alone:.2f} us" if alone else "refused"
            choices.append(f"| {name} | {both[0]:,} + {both[1]:,} | {tick:.2f} us | {size:,} | {runs} |")
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    said = f"\n{time.strftime('%F')}; {os.cpu_count()} processors; load of 1, 5 and 15 minutes at the end: {load}.\n"
    texts = {"shared files": table(HEADS[0], files) + said, "what a page runs": table(HEADS[1], choices)}
    for name, text in texts.items():
        print(text)
        if given.write:
            write_block(PAGE, name, text)


if __name__ == "__main__":
    main()
