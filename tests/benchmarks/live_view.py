"""How the live view feels: frames a second really shown, from the pointer to the paint, and what the kernel spends on it.

``python tests/benchmarks/live_view.py`` (``--seconds 10``, ``--json FILE``), with what ``pip install -e ".[test]"`` brings and a
Chromium. JupyterLab runs as a student has it: with hapticlab's server extension, without it, and without anywidget. A hand
drags the handle to and fro, sixty moves a second; a frame is shown when the picture differs from the one before, by its
pixels or its SVG. Then the pointer jumps and rests, sixty times: the paint is the first that shows the hand away from its
place. A time begins with the event as the browser stamps it and ends when the picture is drawn, before the screen shows it.
"""

import argparse
import json
import math
import os
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "browser"))
from lab import Lab, browsing

from hapticlab.base.drawing import COLD as HAND

JUMPS, MOVES = 60, 60  # how often a hand jumps; moves a second of one that drags
ROUTES = {  # name: whether the server extension is on, and what a notebook does first
    "canvas, with the server extension": (True, ""),
    "canvas, without": (False, ""),
    "plain ipywidgets, with": (True, "import sys; sys.modules['anywidget'] = None"),
    "plain ipywidgets, without": (False, "import sys; sys.modules['anywidget'] = None"),
}
SCENE = """
import os, hapticlab as hl
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
print("kernel", os.getpid())
"""
# Notes when the pointer moved, and when a picture was shown and where the hand is in it; times in ms of the page.
CANVAS = """(hand) => {
  const canvas = document.querySelector("canvas.hl-stage"), context = canvas.getContext("2d")
  const found = (window.found = { shown: [], moves: [] })
  const isHand = (r, g, b) => Math.abs(r - hand[0]) + Math.abs(g - hand[1]) + Math.abs(b - hand[2]) < 60
  let before = 0
  canvas.addEventListener("pointermove", (e) => found.moves.push([e.timeStamp, e.clientX]), true)
  canvas.parentElement.addEventListener("painted", () => {
    const [w, h] = [canvas.width, canvas.height]
    const pixels = context.getImageData(0, 0, w, h).data
    let right = -1, sum = 0
    for (let y = 0; y < h; y += 4) {
      for (let x = 0, i = 4 * w * y; x < w; x++, i += 4) {
        sum = (31 * sum + pixels[i] + 7 * pixels[i + 1]) | 0
        if (x > right && isHand(pixels[i], pixels[i + 1], pixels[i + 2])) right = x
      }
    }
    if (sum !== before) found.shown.push([performance.now(), right])
    before = sum
  })
}"""
# The same of an SVG, looked at in every frame of the browser, as nothing tells when it has changed.
SVG = """(hand) => {
  const found = (window.found = { shown: [], moves: [] })
  const colour = "#" + hand.map((part) => part.toString(16).padStart(2, "0")).join("")
  let before = ""
  document.addEventListener("pointermove", (e) => found.moves.push([e.timeStamp, e.clientX]), true)
  const look = () => {
    const svg = document.querySelector(".widget-html svg[role=img]")
    if (svg && svg.innerHTML !== before) {
      before = svg.innerHTML
      const place = svg.querySelector(`path[fill="#ffffff"][stroke="${colour}"]`)?.getBBox().x ?? -1
      found.shown.push([performance.now(), place])
    }
    requestAnimationFrame(look)
  }
  requestAnimationFrame(look)
}"""


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))] if values else math.nan


class Hand:
    """A pointer on the handle of the canvas, or on the slider of plain widgets."""

    def __init__(self, page, canvas):
        grip = page.locator("canvas.hl-stage" if canvas else ".noUi-handle").first
        grip.scroll_into_view_if_needed()
        box = grip.bounding_box()
        self.page, self.x, self.y = page, box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(self.x, self.y)
        page.mouse.down()

    def drag(self, seconds):
        """Go to and fro, and back."""
        begun = time.perf_counter()
        for k in range(int(seconds * MOVES)):
            time.sleep(max(0.0, begun + k / MOVES - time.perf_counter()))
            t = time.perf_counter() - begun
            self.page.mouse.move(self.x + 60 * math.sin(2 * math.pi * 0.6 * t), self.y)
        self.page.mouse.move(self.x, self.y)
        self.page.wait_for_timeout(700)

    def jump(self, count):
        """Jump by 20 pixels and rest, out of step with the frames."""
        self.page.evaluate("window.found.shown.length = window.found.moves.length = 0")
        for k in range(count):
            self.page.mouse.move(self.x + 20 * ((k + 1) % 2), self.y)
            self.page.wait_for_timeout(300 + 7 * (k % 11))


def gaps_of(found):
    """Return the times between two pictures while the pointer moved [ms]."""
    begin, end = found["moves"][0][0], found["moves"][-1][0]
    during = [when for when, _ in found["shown"] if begin < when < end]
    return [after - before for before, after in zip(during, during[1:], strict=False)]


def paint_times(moves, shown):
    """Return from each jump of the pointer to the first picture in which the hand has left its place [ms]."""
    taken = []
    for (when, _), (until, _) in zip(moves, [*moves[1:], (math.inf, 0)], strict=True):
        rest = [place for seen, place in shown if seen <= when]
        left = [seen for seen, place in shown if when < seen < until and rest and abs(place - rest[-1]) >= 2]
        taken += [left[0] - when] if left else []
    return taken


def measure(lab, first, seconds):
    """Return what a student at a wall has: frames a second, gap, pointer to paint [ms], the kernel's share of a core."""
    import psutil

    page = lab.open("live", f"{first}\n{SCENE}", "view")
    canvas = not first
    page.wait_for_selector("canvas.hl-stage" if canvas else ".noUi-handle")
    kernel = psutil.Process(int(page.locator(".jp-OutputArea-output:has-text('kernel')").first.inner_text().split()[1]))
    hand = Hand(page, canvas)
    hand.drag(2.0)
    page.evaluate(CANVAS if canvas else SVG, list(bytes.fromhex(HAND[1:])))
    begun, spent = time.perf_counter(), sum(kernel.cpu_times()[:2])
    hand.drag(seconds)
    share = (sum(kernel.cpu_times()[:2]) - spent) / (time.perf_counter() - begun)
    dragged = page.evaluate("window.found")
    hand.jump(JUMPS)
    jumped = page.evaluate("window.found")
    page.close()
    gaps = gaps_of(dragged)
    paints = paint_times(jumped["moves"], jumped["shown"])
    return {
        "frames/s": 1000 * len(gaps) / sum(gaps), "gap p95 ms": quantile(gaps, 0.95), "paint p50 ms": quantile(paints, 0.5),
        "paint p95 ms": quantile(paints, 0.95), "jumps seen": len(paints), "kernel %": 100 * share,
    }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging, each")
    parser.add_argument("--routes", type=int, default=len(ROUTES), help="how many of the routes")
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    found = {}
    for name, (prompt, first) in list(ROUTES.items())[: given.routes]:
        with tempfile.TemporaryDirectory() as folder, browsing() as browser, Lab(folder, browser, prompt=prompt) as lab:
            row = found[name] = measure(lab, first, given.seconds)
        if len(found) == 1:
            print("| route | " + " | ".join(row) + " |\n" + "| --- " * (len(row) + 1) + "|")
        print(f"| {name} | " + " | ".join(f"{value:.3g}" for value in row.values()) + " |", flush=True)
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    print(f"load of this computer at the end, of 1, 5 and 15 minutes: {load}; {os.cpu_count()} processors")
    if given.json:
        given.json.write_text(json.dumps(found, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
