"""How high each lab's live views are on a laptop, and what axe-core finds in them: `python tests/benchmarks/lab_views.py`.

Every lab runs as it is handed out, in JupyterLab and Chromium at 1280 x 800, with what `pip install -e ".[test]"` brings.
A view is measured from its first button to its last line.
"""

import os
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from axe import IMPACTS, findings  # noqa: E402
from lab import Lab, browsing, command  # noqa: E402

#: height of a notebook's panel in a window of 1280 x 800, and the height that views aim at [px]
PANEL, AIM = 679, 620


def main():
    print(f"A notebook's panel shows {PANEL} px of a view; views aim at {AIM} px.\n")
    print("| lab | views | height [px] | width [px] | axe-core: light | dark |\n| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder, browsing() as browser, Lab(folder, browser) as lab:
        for source in sorted((ROOT / "labs").glob("*/*.ipynb")):
            shutil.copy(source, lab.notebooks)
            page = lab.open(source.stem, width=1280, height=800)
            page.wait_for_function("() => /Idle/.test(document.querySelector('#jp-main-statusbar')?.textContent)")
            page.wait_for_timeout(4000)
            boxes, light = looked_at(page)
            command(page, "apputils:change-theme", theme="JupyterLab Dark")
            page.wait_for_timeout(1000)
            _, dark = looked_at(page)
            heights = ", ".join(f"{box['height']:.0f}" for box in boxes)
            width = max((box["width"] for box in boxes), default=0)
            print(f"| {source.stem} | {len(boxes)} | {heights} | {width:.0f} | {told(light)} | {told(dark)} |", flush=True)
            command(page, "apputils:change-theme", theme="JupyterLab Light")
            page.close()
            lab.end_kernels()


def looked_at(page):
    """Return the box of each live view of a notebook, and what axe-core finds in them."""
    boxes, found = {}, {}
    cells = page.evaluate("() => window.jupyterapp.shell.currentWidget.content.widgets.length")
    for number in range(cells):  # a notebook's panel holds only what is near to be seen
        page.evaluate("(number) => window.jupyterapp.shell.currentWidget.content.scrollToItem(number, 'start')", number)
        page.wait_for_timeout(100)
        for view in page.locator(".hl-live").all():
            name = view.get_attribute("data-looked-at") or str(len(boxes))
            if name in boxes:
                continue
            view.evaluate("(node, name) => node.setAttribute('data-looked-at', name)", name)
            for _ in range(30):  # one that was never seen before is laid out in a moment
                page.wait_for_timeout(100)
                if view.evaluate("(node) => node.querySelector('canvas')?.style.height"):
                    break
            page.wait_for_timeout(300)
            boxes[name] = view.bounding_box()
            for each in findings(page, f'[data-looked-at="{name}"]', IMPACTS):
                found[each["rule"], each["element"]] = each["impact"]
    page.evaluate("() => document.querySelectorAll('.hl-live').forEach((node) => delete node.dataset.lookedAt)")
    return list(boxes.values()), found


def told(found):
    """Return findings in a few words."""
    return "; ".join(sorted({f"{impact}: {rule}" for (rule, _), impact in found.items()})) or "none"


if __name__ == "__main__":
    os.nice(5)
    main()
