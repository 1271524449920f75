"""How the live view feels without anywidget: frames a second shown, from the slider to the paint, the kernel's share.

``python tests/benchmarks/plain_view.py`` (``--seconds 10``), with what ``live_view.py`` beside it needs. The slider of the
hand is dragged to and fro; a sampler in the page looks at the picture's SVG at every animation frame. The paint that
answers a move is the first in which the hand has left its place.
"""

import argparse
import math
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "browser"))
from lab import Lab, browsing

SCENE = """
import os, sys
sys.modules["anywidget"] = None
import hapticlab as hl
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
print("kernel", os.getpid())
"""
SAMPLER = """() => {
  const found = (window.found = { shown: [], moves: [] })
  document.addEventListener("pointermove", () => found.moves.push(performance.now()), true)
  let before = null
  const look = () => {
    const svg = document.querySelector(".jp-OutputArea svg[role=img]")
    if (svg !== before) {
      const hand = svg.querySelector("path[fill='#ffffff']")
      found.shown.push([performance.now(), hand ? hand.getBBox().x : 0])
    }
    before = svg
    requestAnimationFrame(look)
  }
  look()
}"""
#: what the issue of a live view asks for without its server extension
ASKED = 25


def measure(lab, seconds):
    """Return frames a second, slider to paint [ms] and the kernel's share of a core."""
    import psutil

    page = lab.open("plain", SCENE, "view", height=1300)
    page.locator("button:has-text('Run')").click()
    kernel = psutil.Process(int(page.locator(".jp-OutputArea-output:has-text('kernel')").first.inner_text().split()[1]))
    box = page.locator(".jp-OutputArea .noUi-handle").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.wait_for_timeout(2000)
    page.evaluate(SAMPLER)
    begun, spent = time.perf_counter(), sum(kernel.cpu_times()[:2])
    while (t := time.perf_counter() - begun) < seconds:
        page.mouse.move(x + 80 * math.sin(2 * math.pi * 0.6 * t), y)
        page.wait_for_timeout(16)
    share = (sum(kernel.cpu_times()[:2]) - spent) / (time.perf_counter() - begun)
    shown = page.evaluate("window.found.shown")
    page.wait_for_timeout(1000)
    page.evaluate("window.found.shown.length = window.found.moves.length = 0")
    for k in range(20):
        page.mouse.move(x + 40 * (k % 2), y)
        page.wait_for_timeout(400 + 7 * (k % 11))
    found = page.evaluate("window.found")
    paints = []
    for when, until in zip(found["moves"], [*found["moves"][1:], math.inf], strict=True):
        rest = [place for seen, place in found["shown"] if seen <= when]
        left = [seen for seen, place in found["shown"] if when < seen < until and rest and abs(place - rest[-1]) > 2]
        paints += [left[0] - when] if left else []
    paints.sort()
    frames = (len(shown) - 1) / (shown[-1][0] - shown[0][0]) * 1000
    page.close()
    return frames, paints[len(paints) // 2], paints[int(0.95 * len(paints))], share


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging, each")
    given = parser.parse_args()
    print(f"plain widgets; asked are {ASKED} frames a second without the server extension")
    print(f"{'extension':<10} {'frames/s':>9} {'paint p50 [ms]':>15} {'paint p95 [ms]':>15} {'kernel':>8}")
    for prompt in (True, False):
        with tempfile.TemporaryDirectory() as folder, browsing() as browser, Lab(folder, browser, prompt=prompt) as lab:
            frames, median, late, share = measure(lab, given.seconds)
        print(f"{'with' if prompt else 'without':<10} {frames:>9.1f} {median:>15.0f} {late:>15.0f} {share:>8.0%}")


if __name__ == "__main__":
    main()
