"""JupyterLab and a headless Chromium, once for all tests in this folder."""

import asyncio

import pytest
from lab import Lab, browsing, missing


@pytest.fixture(scope="session")
def complete():
    """Skip where something is missing that a test in a browser needs."""
    reason = missing()
    if reason:
        pytest.skip(reason)


@pytest.fixture(scope="session")
def server(complete, tmp_path_factory):
    with Lab(tmp_path_factory.mktemp("jupyter")) as running:
        yield running


@pytest.fixture(scope="package")
def chromium(complete):
    """A Chromium for this folder, which takes a second to start; Playwright's event loop runs in this thread until it ends."""
    with browsing() as started:
        yield started
    with pytest.raises(RuntimeError):
        asyncio.get_running_loop()  # other tests run loops of their own


@pytest.fixture(scope="module")
def browser(chromium):
    """The folder's Chromium; the pages of a module end with it."""
    yield chromium
    for context in chromium.contexts:
        context.close()


@pytest.fixture(scope="module", autouse=True)
def no_loop_is_left():
    """In this folder a loop outlives its module: the Chromium of the folder looks after its end."""


@pytest.fixture(scope="module")
def lab(server, browser):
    server.browser = browser
    yield server
    server.end_kernels()
