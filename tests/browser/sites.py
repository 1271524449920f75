"""A site of the labs, served to a browser, and what leaves its address."""

import json
import threading
from contextlib import contextmanager
from functools import partial
from http.server import BaseHTTPRequestHandler, SimpleHTTPRequestHandler, ThreadingHTTPServer

from lab import SECONDS

from hapticlab.site.lite import KERNEL


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Open(Quiet):
    """Files that pages of other addresses may read, as at the address of Pyodide."""

    def end_headers(self):
        self.send_header("Access-Control-Allow-Origin", "*")
        super().end_headers()


@contextmanager
def serving(handler):
    """Run a server on a free port of this computer."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@contextmanager
def served(folder, pyodide=None):
    """Serve a site, and give its address; scripts of a test find JupyterLite's application in its pages.

    ``pyodide`` is an address that takes the place of Pyodide's own.
    """
    path = folder / "jupyter-lite.json"
    settings = json.loads(path.read_text("utf-8"))
    settings["jupyter-config-data"]["exposeAppInBrowser"] = True
    if pyodide:
        settings["jupyter-config-data"]["litePluginSettings"][KERNEL]["pyodideUrl"] = f"{pyodide}/pyodide.mjs"
    path.write_text(json.dumps(settings), "utf-8")
    with serving(partial(Quiet, directory=folder)) as server:
        yield f"http://127.0.0.1:{server.server_port}"


#: where Chromium itself asks how to fill in forms; no page can
OF_THE_BROWSER = {"content-autofill.googleapis.com:443"}


class Refusing(BaseHTTPRequestHandler):
    """A proxy that refuses everything, and notes what was asked."""

    def refuse(self):
        if self.path not in OF_THE_BROWSER:
            self.server.asked.append(self.path)
        self.send_error(403)

    do_CONNECT = do_GET = do_POST = do_HEAD = refuse

    def log_message(self, *_):
        pass


@contextmanager
def watched(browser, *, width=1280, height=900, **options):
    """Give a page of a new visitor, and the list of what it asks beyond this computer, all of which is refused.

    A proxy notes these, since it also sees what workers ask, and the service worker of a site.
    """
    with serving(Refusing) as proxy:
        proxy.asked = []
        way = {"server": f"http://127.0.0.1:{proxy.server_port}", "bypass": "127.0.0.1"}
        context = browser.new_context(viewport={"width": width, "height": height}, proxy=way, **options)
        page = context.new_page()
        page.set_default_timeout(1000 * SECONDS)
        yield page, proxy.asked
        context.close()


@contextmanager
def visited(browser, **options):
    """Give a page of a new visitor; a request that would leave this computer is refused, and fails at the end."""
    with watched(browser, **options) as (page, asked):
        yield page
    assert not asked, f"requests beyond the site: {asked}"


def open_lab(page, address, number):
    """Follow the link of a lab on the first page, and wait for its notebook."""
    page.goto(f"{address}/index.html")
    page.locator(f"a[href*='path={number}_']").click()
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function("() => window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel")
