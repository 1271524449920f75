"""In CI a skipped test is a failure, unless its reason holds the word in HAPTICLAB_ALLOWED_SKIP."""

import os

import pytest

IN_CI = os.environ.get("CI", "").lower() in ("1", "true", "yes")
ALLOWED = os.environ.get("HAPTICLAB_ALLOWED_SKIP", "")


def pytest_addoption(parser):
    parser.addoption("--port", help="run the contract of a paddle on a real board at this port, with a person beside it")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    return _refuse_skip(report)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    report = yield
    return _refuse_skip(report)


def _refuse_skip(report):
    if not IN_CI or not report.skipped or hasattr(report, "wasxfail"):
        return report
    reason = str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr).removeprefix("Skipped: ")
    if not (ALLOWED and ALLOWED in reason):
        report.outcome = "failed"
        report.longrepr = f"skipped in CI, where every test must run: {reason}"
    return report
