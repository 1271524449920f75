"""A JupyterLab of its own, with a scripted student in a headless Chromium before it."""

import importlib.util
import json
import os
import shutil
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from urllib.request import Request, urlopen

REPOSITORY = Path(__file__).parents[2]
FLAGS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
)  # fmt: skip
IDLE = "() => /\\| Idle/.test(document.querySelector('#jp-main-statusbar')?.textContent)"  # also: connected
SECONDS = 60  # how long anything may take before a test gives up
NO_NEWS = {"fetchNews": "false", "checkForUpdates": False}


def chromium():
    """Return where Chromium is, or None."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    return os.environ.get("HAPTICLAB_CHROMIUM") or next(filter(None, map(shutil.which, names)), None)


def missing():
    """Return what is missing here for a test in a browser; empty where nothing is."""
    lacks = [name for name in ("playwright", "jupyterlab", "anywidget") if importlib.util.find_spec(name) is None]
    lacks += [] if chromium() else ["Chromium"]
    return f"a browser test needs {', '.join(lacks)}" if lacks else ""


@contextmanager
def browsing():
    """Start a headless Chromium; until the end an event loop of Playwright's runs in this thread, where no other may run."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=FLAGS)
        yield browser
        browser.close()


class Lab:
    """A server, a browser for it, and the folder ``notebooks`` of both.

    ``prompt`` is whether hapticlab's extension is on, ``package`` the checkout whose hapticlab runs. The browser may be
    given later and replaced.
    """

    def __init__(self, folder, browser=None, *, prompt=True, package=REPOSITORY):
        self.folder, self.browser, self.prompt, self.package = Path(folder), browser, prompt, Path(package)
        self.notebooks = self.folder / "notebooks"
        self.notebooks.mkdir(parents=True)

    def __enter__(self):
        self._server = self._serve()
        return self

    def __exit__(self, *_):
        self._server.terminate()
        self._server.wait(30)
        self._reader.join()
        self._server.stderr.close()

    def _serve(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.address = f"http://127.0.0.1:{port}"
        home = self.folder / "home"
        settings = home / "config" / "lab" / "user-settings" / "@jupyterlab" / "apputils-extension"
        settings.mkdir(parents=True)
        (settings / "notification.jupyterlab-settings").write_text(json.dumps(NO_NEWS))
        own_folders = {
            "JUPYTER_CONFIG_DIR": "config", "JUPYTER_DATA_DIR": "data", "JUPYTER_RUNTIME_DIR": "runtime", "IPYTHONDIR": "ipython",
        }  # fmt: skip
        environment = os.environ | {name: str(home / folder) for name, folder in own_folders.items()}
        environment["PYTHONPATH"] = os.pathsep.join([str(self.package), os.environ.get("PYTHONPATH", "")])
        own = {"ServerApp": {"jpserver_extensions": {"hapticlab._jupyter": self.prompt}}}
        (home / "config" / "jupyter_server_config.json").write_text(json.dumps(own))
        command = [
            sys.executable, "-m", "jupyterlab", "--allow-root", "--no-browser", "--ip=127.0.0.1", f"--port={port}",
            "--LabApp.expose_app_in_browser=True",
            "--IdentityProvider.token=", "--ServerApp.disable_check_xsrf=True", f"--ServerApp.root_dir={self.notebooks}",
        ]  # fmt: skip
        server = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True, cwd=self.notebooks)
        self.said = []
        for line in server.stderr:
            self.said.append(line)
            if "is running at" in line:
                break
        else:
            raise RuntimeError(f"JupyterLab did not start:\n{''.join(self.said)}")
        self._reader = threading.Thread(target=lambda: self.said.extend(server.stderr), daemon=True)
        self._reader.start()
        return server

    def end_kernels(self):
        """End what the notebooks run: a simulation goes on after its page is closed."""
        address = f"{self.address}/api/kernels"
        with urlopen(address) as said:
            running = json.load(said)
        for kernel in running:
            urlopen(Request(f"{address}/{kernel['id']}", method="DELETE")).close()

    def write(self, name, *cells):
        """Write a notebook of code cells, their code folded away so that what they show is on the screen."""
        folded = {"jupyter": {"source_hidden": True}}
        code = [
            {"cell_type": "code", "id": f"cell{k}", "source": cell, "metadata": folded, "outputs": [], "execution_count": None}
            for k, cell in enumerate(cells)
        ]
        kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
        metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
        notebook = {"cells": code, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}
        (self.notebooks / f"{name}.ipynb").write_text(json.dumps(notebook), encoding="utf-8")

    def open(self, name, *cells, width=1000, height=1100):
        """Open a notebook in a page of its own, written from cells if there are any, and run all of it; return the page."""
        if cells:
            self.write(name, *cells)
        page = self.browser.new_context(viewport={"width": width, "height": height}).new_page()
        page.set_default_timeout(1000 * SECONDS)
        page.goto(f"{self.address}/doc/tree/{name}.ipynb?reset")
        page.wait_for_selector(".jp-Notebook .jp-Cell")
        page.wait_for_function(IDLE)
        run_all(page)
        return page


def run_all(page):
    """Run every cell, by the menu."""
    page.locator("li.lm-MenuBar-item:has-text('Run')").click()
    page.locator("li.lm-Menu-item[data-command='runmenu:run-all']").click()


def ask(page, code):
    """Run code in the kernel of a page's notebook, as a cell would; return what it prints."""
    return page.evaluate(
        """async (code) => {
            const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel
            const running = kernel.requestExecute({ code })
            let said = ""
            running.onIOPub = ({ content }) => (said += content.text ?? content.evalue ?? "")
            await running.done
            return said.trim()
        }""",
        code,
    )


def eventually(page, code, answer):
    """Ask until the kernel gives an answer: what a hand does arrives a moment later."""
    end = time.monotonic() + SECONDS
    while (said := ask(page, code)) != answer:
        assert time.monotonic() < end, f"{code}: {said}; expected {answer}"


def run_cell(page, beginning, source=None):
    """Run the cell that begins so, with other source if that is given; return what it shows as text."""
    return page.evaluate(
        """async ([beginning, source]) => {
            const notebook = window.jupyterapp.shell.currentWidget.content
            const number = notebook.widgets.findIndex((cell) => cell.model.sharedModel.getSource().startsWith(beginning))
            const cell = notebook.widgets[number]
            if (source !== null) cell.model.sharedModel.setSource(source)
            notebook.activeCellIndex = number
            await window.jupyterapp.commands.execute("notebook:run-cell")
            return cell.outputArea.node.innerText.trim()
        }""",
        [beginning, source],
    )


def grab(page, selector):
    """Press the pointer on the middle of an element once that stands still; return where."""
    page.locator(selector).hover()  # waits until it does not move, while formulas above it are still being set
    box = page.locator(selector).bounding_box()
    page.mouse.down()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def see(page, selector):
    """Scroll to a live view, and again where JupyterLab scrolls back to the cell that ran last: nothing runs out of sight."""
    page.wait_for_function(
        """(selector) => {
            const stage = document.querySelector(selector)
            stage.scrollIntoView({ block: "center" })
            return stage.closest(".hl-live").querySelector(".hl-run").ariaDisabled === "false"
        }""",
        arg=selector,
        polling=200,
    )


def command(page, name, **given):
    """Do what an entry of JupyterLab's menus does."""
    page.evaluate("([name, given]) => window.jupyterapp.commands.execute(name, given)", [name, given])


def until(page, selector, words):
    """Wait until an element's text holds words; return the text."""
    page.wait_for_function("([s, w]) => document.querySelector(s)?.textContent.includes(w)", arg=[selector, words])
    return page.locator(selector).first.text_content()


def picture(page, name):
    """Keep a picture of the page where $HAPTICLAB_ARTIFACTS says, if it does; a person looks at it."""
    folder = os.environ.get("HAPTICLAB_ARTIFACTS")
    if folder:
        Path(folder).mkdir(parents=True, exist_ok=True)
        page.screenshot(path=str(Path(folder) / f"{name}.png"))
