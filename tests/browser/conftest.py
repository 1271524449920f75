"""JupyterLab once for all tests in this folder, and a headless Chromium for each module."""

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


@pytest.fixture(scope="module")
def browser(complete):
    """A Chromium that ends with its module, and Playwright's event loop with it: other tests run loops of their own."""
    with browsing() as started:
        yield started


@pytest.fixture(scope="module")
def lab(server, browser):
    server.browser = browser
    yield server
    server.end_kernels()
