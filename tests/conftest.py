"""What holds for every test: which always run, a limit, no event loop left behind, in CI no skip; where the seconds went.

And a Python without threads, as in a browser, for what has to work in both.
"""

import asyncio
import faulthandler
import gc
import json
import os
import sys
import threading
import time
from collections import Counter
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

import pytest

from hapticlab.device import turns

# before NumPy is loaded: on small matrices a second thread costs four times the time of one, and processes share the cores
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# before jsonschema is loaded, by nbformat: the 38 grammars of this one cost 1.6 s, and no notebook has an address that they check
sys.modules.setdefault("rfc3987_syntax", None)

IN_CI = os.environ.get("CI", "").lower() in ("1", "true", "yes")
ALLOWED = os.environ.get("HAPTICLAB_ALLOWED_SKIP", "")
#: for a test marked slow that says no other [s]; the limit of the others is in pyproject.toml
LONGEST = 3600
STDERR = pytest.StashKey()
#: the limit that is watched now, and until when the next test of the same limit need not begin anew [s]
WATCHED = pytest.StashKey()


def pytest_addoption(parser):
    parser.addoption("--port", help="run the contract of a paddle on a real board at this port, with a person beside it")
    parser.addoption("--areas", type=Path, metavar="FILE", help="add the seconds of every folder to FILE, and print them")


def pytest_configure(config):
    config.stash[STDERR] = os.dup(sys.__stderr__.fileno())  # what a test says goes elsewhere while it runs


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Let Python look for garbage seldom, and never among what is collected: that stays, and to walk it took a tenth of all."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(100_000)
        gc.enable()


@pytest.hookimpl(tryfirst=True)  # before -m chooses
def pytest_collection_modifyitems(config, items):
    asked, met = set(), set()
    if hasattr(config, "workerinput"):  # one process of several: a long file that begins last is waited for by all others
        items.sort(key=lambda item: item.get_closest_marker("long") is None)
    for item in items:
        always = item.get_closest_marker("always")
        cases = {(item.function, case) for case in always.args} if always else set()
        fits = {(function, case) for function, case in cases if fnmatchcase(_case(item), case)}
        asked, met = asked | cases, met | fits
        if always and not fits:
            item.add_marker("wide")
        if item.get_closest_marker("slow") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(LONGEST))
    # elsewhere who asks for one case may collect only that, and where an engine may be missing so may its cases
    if IN_CI and not ALLOWED and asked != met:
        raise pytest.UsageError(f"always names no case of: {sorted((f.__name__, case) for f, case in asked - met)}")


def _case(item):
    return item.callspec.id if hasattr(item, "callspec") else ""


@pytest.hookimpl(wrapper=True, trylast=True)
def pytest_runtest_protocol(item, nextitem):
    """End the whole run after twice a test's limit: a clean-up that waits or a call into C outlives the limit itself."""
    own = item.get_closest_marker("timeout")
    seconds = own.args[0] if own else float(item.config.getoption("timeout") or item.config.getini("timeout") or 0)
    watched, until = item.config.stash.get(WATCHED, (0, 0))
    if seconds != watched or time.monotonic() > until:  # to begin anew for each of many short tests takes as long as they do
        _watch(item.config, seconds)
    try:
        return (yield)
    finally:
        if nextitem is None:
            _watch(item.config, 0)


def _watch(config, seconds):
    config.stash[WATCHED] = seconds, time.monotonic() + seconds / 100
    if seconds:
        faulthandler.dump_traceback_later(2 * seconds, exit=True, file=config.stash[STDERR])
    else:
        faulthandler.cancel_dump_traceback_later()


def pytest_enter_pdb(config):
    _watch(config, 0)  # who debugs may take longer


@pytest.fixture(scope="module", autouse=True)
def no_loop_is_left():
    """Fail after a module whose event loop still runs in this thread: whoever comes next can start none."""
    yield
    try:
        left = asyncio.get_running_loop()
    except RuntimeError:
        return
    pytest.fail(f"{left} still runs after this module; end what started it, as Playwright, in a fixture of the module")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    return _refuse_skip(report)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    report = yield
    return _refuse_skip(report)


def _refuse_skip(report):
    """In CI a skipped test is a failure, unless its reason holds the word in HAPTICLAB_ALLOWED_SKIP."""
    if not IN_CI or not report.skipped or hasattr(report, "wasxfail"):
        return report
    reason = str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr).removeprefix("Skipped: ")
    if not (ALLOWED and ALLOWED in reason):
        report.outcome = "failed"
        report.longrepr = f"skipped in CI, where every test must run: {reason}"
    return report


def pytest_terminal_summary(terminalreporter, config):
    file = config.getoption("--areas")
    if not file:
        return
    seconds = Counter(json.loads(file.read_text("utf-8")) if file.exists() else {})
    for report in (one for same in terminalreporter.stats.values() for one in same if hasattr(one, "duration")):
        seconds["/".join(PurePosixPath(report.nodeid.partition("::")[0]).parts[:2])] += report.duration
    file.write_text(json.dumps(seconds), encoding="utf-8")
    terminalreporter.section(f"seconds by folder, in all of {file.name}")
    for folder, spent in [*seconds.most_common(), ("all", seconds.total())]:
        terminalreporter.write_line(f"{spent:8.1f}  {folder}")


class Threads:
    """Work that takes turns does so in threads of its own."""

    def event(self):
        return threading.Event()


class OneThread:
    """It does so on the event loop, which runs while a test waits; as in a browser, code that waits for nothing finds it too."""

    def __init__(self):
        self._loop = asyncio.new_event_loop()
        asyncio._set_running_loop(self._loop)

    def event(self):
        return LoopEvent(self)

    def run(self, work):
        """Return what a coroutine returns; the turns of everything else come meanwhile."""
        asyncio._set_running_loop(None)
        try:
            return self._loop.run_until_complete(work)
        finally:
            asyncio._set_running_loop(self._loop)

    def close(self):
        asyncio._set_running_loop(None)
        left = asyncio.all_tasks(self._loop)
        for task in left:
            task.cancel()
        if left:
            self._loop.run_until_complete(asyncio.wait(left))
        self._loop.close()


class LoopEvent(asyncio.Event):
    """As an event of threads, for a test in which all is one thread."""

    def __init__(self, form):
        super().__init__()
        self._form = form

    def wait(self, timeout):
        async def waited():
            with suppress(TimeoutError):
                await asyncio.wait_for(asyncio.Event.wait(self), timeout)
            return self.is_set()

        return self._form.run(waited())


@pytest.fixture
def one_thread(monkeypatch):
    """A Python without threads, as in a browser."""
    monkeypatch.setattr(turns, "is_in_browser", lambda: True)
    form = OneThread()
    yield form
    form.close()


@pytest.fixture(params=["threads", "one thread"])
def both(request):
    """Each form of work that takes turns; what waits is an ``event()`` of it."""
    return Threads() if request.param == "threads" else request.getfixturevalue("one_thread")
