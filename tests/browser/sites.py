"""A site of the labs, served to a browser, and what leaves its address."""

import json
import threading
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

from lab import SECONDS


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@contextmanager
def served(folder):
    """Serve a folder on a free port, and give its address; JupyterLite's application is where scripts find it."""
    path = folder / "jupyter-lite.json"
    settings = json.loads(path.read_text("utf-8"))
    settings["jupyter-config-data"]["exposeAppInBrowser"] = True
    path.write_text(json.dumps(settings), "utf-8")
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@contextmanager
def visited(browser, address, *, width=1280, height=900, **options):
    """Give a page of a new visitor; a request beyond the address is refused, and fails at the end."""
    context, beyond = browser.new_context(viewport={"width": width, "height": height}, **options), []

    def judge(route):
        if route.request.url.startswith((address, "data:", "blob:")):
            route.continue_()
        else:
            beyond.append(route.request.url)
            route.abort()

    context.route("**/*", judge)
    page = context.new_page()
    page.set_default_timeout(2000 * SECONDS)
    yield page
    context.close()
    assert not beyond, f"requests beyond the site: {beyond}"


def open_lab(page, address, number):
    """Follow the link of a lab on the first page, and wait for its notebook."""
    page.goto(f"{address}/index.html")
    page.locator(f"a[href*='path={number}_']").click()
    page.wait_for_selector(".jp-Notebook .jp-Cell")
    page.wait_for_function("() => window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel")
