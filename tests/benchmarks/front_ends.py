"""Where the live view runs: `pip install notebook marimo`, then `python tests/benchmarks/front_ends.py`.

A cell with a live view runs in each front end, in Chromium; a hand drags the handle, and the row says what the view says
then. docs/how_to/live.md has the results. ``--look FOLDER`` keeps a picture of each.
"""

import argparse
import importlib.util
import json
import os
import socket
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from lab import browsing, grab  # noqa: E402

VIEW = """import hapticlab as hl
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
view"""
CELL = {"cell_type": "code", "id": "view", "source": VIEW, "metadata": {}, "outputs": [], "execution_count": None}
KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}
NOTEBOOK = {"cells": [CELL], "metadata": {"kernelspec": KERNEL}, "nbformat": 4, "nbformat_minor": 5}
MARIMO = """import marimo
app = marimo.App()


@app.cell
def _():
    {}
    return


if __name__ == "__main__":
    app.run()
"""
STAGE, STATUS = "canvas.hl-stage", ".hl-status"


def jupyter(*command):
    return [sys.executable, "-m", *command, "--allow-root", "--no-browser", "--ip=127.0.0.1", "--IdentityProvider.token="]


#: name: the package, its command, the page, and what begins the cell there
FRONT_ENDS = {
    "JupyterLab": ("jupyterlab", [*jupyter("jupyterlab"), "--port={port}"], "/lab/tree/view.ipynb?reset", True),
    "Jupyter Notebook": ("notebook", [*jupyter("notebook"), "--port={port}"], "/notebooks/view.ipynb", True),
    "marimo": (
        "marimo",
        [sys.executable, "-m", "marimo", "run", "view.py", "--headless", "--no-token", "-p", "{port}"],
        "/",
        False,
    ),
}


@contextmanager
def serving(command, folder):
    """Run a server on a free port of this computer; yield its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    homes = {name: str(folder / name) for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR")}
    environment = os.environ | homes | {"PYTHONPATH": str(ROOT)}
    words = [part.format(port=port) for part in command]
    server = subprocess.Popen(words, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield f"http://127.0.0.1:{port}"
    finally:
        server.terminate()
        server.wait(30)


def tried(browser, address, run, look):
    """Return what the view says while a hand drags the handle into the wall."""
    from playwright.sync_api import Error

    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(60_000)
    for _ in range(120):  # until the server is there
        try:
            page.goto(address)
            break
        except Error:  # nobody answers yet
            page.wait_for_timeout(500)
    if run:
        page.locator(".jp-Cell").first.click()
        page.wait_for_timeout(4000)  # the kernel begins
        page.keyboard.press("Control+Enter")
    page.wait_for_selector(STAGE)
    page.locator(STATUS).filter(has_text="Running").wait_for()  # marimo has it in a shadow tree
    x, y = grab(page, STAGE)
    for k in range(1, 16):
        page.mouse.move(x + 12 * k, y)
        page.wait_for_timeout(30)
    page.wait_for_timeout(1500)
    said = page.locator(STATUS).inner_text()
    if look:
        page.screenshot(path=str(look))
    page.close()
    return said


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--look", type=Path, help="a folder for pictures")
    given = parser.parse_args()
    if given.look:
        given.look.mkdir(parents=True, exist_ok=True)
    with browsing() as browser:
        for name, (package, command, page, run) in FRONT_ENDS.items():
            if importlib.util.find_spec(package) is None:
                print(f"{name}: not installed, not tried")
                continue
            with tempfile.TemporaryDirectory() as folder:
                (Path(folder) / "view.ipynb").write_text(json.dumps(NOTEBOOK), "utf-8")
                (Path(folder) / "view.py").write_text(MARIMO.format(VIEW.replace("\n", "\n    ")), "utf-8")
                with serving(command, Path(folder)) as address:
                    said = tried(browser, address + page, run, given.look and given.look / f"{package}.png")
            print(f"{name} {version(package)}: {said}", flush=True)


if __name__ == "__main__":
    main()
