"""JupyterLab and a headless Chromium, once for all tests in this folder."""

import pytest
from lab import Lab, missing


@pytest.fixture(scope="session")
def lab(tmp_path_factory):
    reason = missing()
    if reason:
        pytest.skip(reason)
    with Lab(tmp_path_factory.mktemp("jupyter")) as running:
        yield running
