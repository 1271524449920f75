"""How long from an empty folder to the first felt wall, by README's own line: `python tests/benchmarks/first_wall.py`.

A copy of the committed files, a new virtual environment, the line of README.md that ends in `hapticlab labs` word for word,
and a scripted student in Chromium who runs the first lab and drags the handle until the view says "in contact". The
seconds are this computer's and this network's; reading and typing come on top.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from lab import FLAGS, IDLE, chromium, run_all  # noqa: E402


def main():
    begun = time.perf_counter()

    def tell(what):
        print(f"{time.perf_counter() - begun:7.1f} s  {what}", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["git", "clone", "-q", str(ROOT), folder], check=True)
        (line,) = re.findall(r"^python3 -m venv .*hapticlab labs$", (Path(folder) / "README.md").read_text("utf-8"), re.M)
        tell(f"cloned; {line}")
        shown = Path(folder) / "shown"
        opener = Path(folder) / "browser"
        opener.write_text(f'#!/bin/sh\necho "$1" >> {shown}\n')
        opener.chmod(0o755)
        # the browser is ours, so that a script can be the student; and as root JupyterLab needs to be told that it may
        environment = {name: text for name, text in os.environ.items() if name not in ("VIRTUAL_ENV", "PYTHONPATH")}
        environment |= {"BROWSER": f"{opener} %s", "JUPYTER_CONFIG_DIR": f"{folder}/jupyter", "IPYTHONDIR": f"{folder}/ipython"}
        (Path(folder) / "jupyter").mkdir()
        (Path(folder) / "jupyter" / "jupyter_server_config.json").write_text('{"ServerApp": {"allow_root": true}}')
        with open(Path(folder) / "said", "w") as said:
            options = {"cwd": folder, "env": environment, "stdout": said, "stderr": said, "start_new_session": True}
            server = subprocess.Popen(line, shell=True, **options)
        try:
            while not shown.exists() or not shown.read_text().strip():
                if server.poll() is not None:
                    raise RuntimeError((Path(folder) / "said").read_text())
                time.sleep(0.1)
            tell("installed, labs copied, JupyterLab opens its page")
            _feel(shown.read_text().split()[0], tell)
        finally:
            os.killpg(server.pid, 15)
            server.wait(30)


def _feel(address, tell):
    """Open the page that JupyterLab shows, run the notebook on it, and drag the handle into the wall."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=FLAGS)
        page = browser.new_page(viewport={"width": 1200, "height": 1000})
        page.set_default_timeout(120_000)
        page.goto(address)
        page.wait_for_selector(".jp-Notebook .jp-Cell")
        page.wait_for_function(IDLE)
        tell(f"the first lab is open: {page.title()}")
        run_all(page)
        canvas = page.locator(".jp-OutputArea canvas").first
        canvas.wait_for(state="attached")
        canvas.scroll_into_view_if_needed()
        page.wait_for_function("() => /Running/.test(document.body.innerText)")
        tell("a live view runs")
        box = canvas.bounding_box()
        middle = box["y"] + box["height"] / 3
        page.mouse.move(box["x"] + box["width"] / 2, middle)
        page.mouse.down()
        for step in range(1, 60):
            page.mouse.move(box["x"] + box["width"] * (0.5 + 0.006 * step), middle)
            if page.evaluate("() => /in contact/.test(document.body.innerText)"):
                tell("the wall is felt")
                break
        else:
            raise RuntimeError("the handle met no wall")
        browser.close()


if __name__ == "__main__":
    main()
