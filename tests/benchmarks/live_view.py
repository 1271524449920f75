"""How the live view feels: frames a second really shown, from the pointer to the paint, and what the kernel spends on it.

``python tests/benchmarks/live_view.py`` (``--seconds 10``, ``--json FILE``), with what ``pip install -e ".[test]"`` brings and a
Chromium. JupyterLab runs as a student has it, with hapticlab's server extension and without. A hand drags the handle to
and fro; a sampler in the page looks at the canvas' pixels at every animation frame of the browser. A frame is shown when they
differ from those before; the paint that answers a move of the pointer is the first that shows the hand where the pointer
has gone, so a time holds the wait for the next frame of the screen, 16.7 ms, as well.
"""

import argparse
import json
import math
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "browser"))
from lab import Lab

from hapticlab.widgets.picture import HAND

#: what the issue of a live view asks for: frames a second, pointer to paint [ms] at the 95th percentile, share of a core
JUMPS = 60
ASKED = {"with": (50, 50, 0.15), "without": (25, None, None)}
SCENE = """
import os, hapticlab as hl
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.hand("pinch"))
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
print("kernel", os.getpid())
"""
# Looks at the hand's colour in the picture, and counts what was shown; times in ms of the page.
SAMPLER = """(hand) => {
  const canvas = document.querySelector("canvas.hl-stage"), context = canvas.getContext("2d")
  const found = (window.found = { shown: [], moves: [] })
  canvas.addEventListener("pointermove", (e) => found.moves.push([e.timeStamp, e.clientX]), true)
  canvas.parentElement.addEventListener("painted", () => {
    const [w, h] = [canvas.width, canvas.height]
    const pixels = context.getImageData(0, 0, w, h).data
    let right = -1, sum = 0
    for (let y = 0; y < h; y += 4) {
      for (let x = 0, i = 4 * w * y; x < w; x++, i += 4) {
        sum = (31 * sum + pixels[i] + 7 * pixels[i + 1]) | 0
        if (x > right && Math.abs(pixels[i] - hand[0]) + Math.abs(pixels[i + 1] - hand[1]) + Math.abs(pixels[i + 2] - hand[2]) < 60) right = x
      }
    }
    if (sum !== before) found.shown.push([performance.now(), right])
    before = sum
  })
  let before = 0
}"""


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def drag(page, seconds):
    """Drag the handle to and fro as a hand does, and rest."""
    box = page.locator("canvas.hl-stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    begun = time.perf_counter()
    while (t := time.perf_counter() - begun) < seconds:
        page.mouse.move(x + 120 * math.sin(2 * math.pi * 0.6 * t), y)
        time.sleep(0.004)
    page.mouse.move(x, y)
    page.wait_for_timeout(700)
    page.mouse.up()


def steps(page, count):
    """Move the pointer by jumps of 4 mm and rests, out of step with the frames; the page's sampler sees the answers."""
    box = page.locator("canvas.hl-stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.wait_for_timeout(500)
    page.evaluate("window.found.shown.length = window.found.moves.length = 0")
    for k in range(count):
        page.mouse.move(x + 30 * ((k + 1) % 2), y)
        page.wait_for_timeout(300 + 7 * (k % 11))
    page.mouse.up()


def latencies(moves, shown):
    """Return from each jump of the pointer to the first picture in which the hand has left its place [ms]."""
    taken = []
    for (when, _), (until, _) in zip(moves, [*moves[1:], (math.inf, 0)]):
        rest = [place for seen, place in shown if seen <= when]
        left = [seen for seen, place in shown if when < seen < until and rest and abs(place - rest[-1]) >= 2]
        if left:
            taken.append(left[0] - when)
    return taken


def kernel_of(page):
    return int(page.locator(".jp-OutputArea-output:has-text('kernel')").first.inner_text().split()[1])


def measure(lab, seconds):
    """Return what a student at a wall has: frames a second, gap, pointer to paint [ms], the kernel's share of a core."""
    import psutil

    page = lab.open("live", SCENE, "view")
    page.wait_for_selector("canvas.hl-stage")
    kernel = psutil.Process(kernel_of(page))
    drag(page, 2.0)
    page.evaluate(SAMPLER, list(bytes.fromhex(HAND[1:])))
    begun, spent = time.perf_counter(), sum(kernel.cpu_times()[:2])
    drag(page, seconds)
    share = (sum(kernel.cpu_times()[:2]) - spent) / (time.perf_counter() - begun)
    dragged = page.evaluate("window.found")
    steps(page, JUMPS)
    jumped = page.evaluate("window.found")
    page.close()
    first, last = dragged["moves"][0][0], dragged["moves"][-1][0]
    during = [when for when, _ in dragged["shown"] if first < when < last]
    gaps = [b - a for a, b in zip(during, during[1:])]
    paints = latencies(jumped["moves"], jumped["shown"])
    return {
        "frames a second": 1000 * len(gaps) / sum(gaps), "gap p95 [ms]": quantile(gaps, 0.95),
        "paint p50 [ms]": quantile(paints, 0.5), "paint p95 [ms]": quantile(paints, 0.95),
        "seen": len(paints) / JUMPS, "kernel's share": share,
    }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging, each")
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    found = {}
    for prompt in (True, False):
        with tempfile.TemporaryDirectory() as folder, Lab(folder, prompt=prompt) as lab:
            found["with" if prompt else "without"] = measure(lab, given.seconds)
    for name, row in found.items():
        print(name, row)


if __name__ == "__main__":
    main()
