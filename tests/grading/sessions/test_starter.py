"""A session answers with plain values; whatever it does, the grader knows how it ended, and goes on."""

import os
import signal
from dataclasses import replace

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.inside import watch
from hapticlab.grading.inside.watch import descendants
from hapticlab.grading.sessions.asking import parsed
from hapticlab.grading.sessions.limits import MIB, Limits
from hapticlab.grading.sessions.preloaded import Preloaded
from hapticlab.grading.sessions.starter import SessionEnded, Starter, start

LIMITS = Limits(seconds=1.0, memory=300 * MIB, scratch=4 * MIB, files=200, answer=MIB)
MANY = replace(LIMITS, processes=16)
IMPORTS = """
import ctypes, os, signal, stat, threading, time
def fork():
    try:
        return os.fork()
    except OSError:
        return -1
def channel():
    for k in range(64):
        try:
            if stat.S_ISSOCK(os.fstat(k).st_mode):
                return k
        except OSError:
            pass
def hold(size):
    kept = b"x" * size
    time.sleep(600)
"""
FILE = "aGFsbG8="  # hallo


@pytest.fixture(scope="module")
def preloaded():
    with Preloaded() as begun:
        yield begun


@pytest.fixture(
    scope="module", params=[*(pytest.param(level, marks=pytest.mark.wide) for level in ("none", "landlock")), "namespaces"]
)
def starter(request, preloaded):
    with start(request.param, limits=LIMITS, zygote=preloaded.zygote()) as started:
        yield started


@pytest.fixture(scope="module")
def with_processes(preloaded):
    with start("namespaces", limits=MANY, zygote=preloaded.zygote()) as started:
        yield started


def loaded(starter, *cells):
    """Return a session in which these cells ran."""
    session = starter.session(starter.limits)
    assert session.ask({"do": "load", "cells": cells, "files": {"data.txt": FILE}}, 10) == {"cells": len(cells)}
    for k in range(len(cells)):
        assert session.ask({"do": "run", "cell": k}, 10) == {"problem": ""}
    return session


def value(session, name):
    """Return what is under a name."""
    (outcome,) = session.ask({"do": "evaluate", "name": name, "kind": "value", "givens": [{}]}, 10)["outcomes"]
    return outcome["value"]


def ended(starter, body, seconds=10.0):
    """Return why a session ended whose answer has this body."""
    with loaded(starter, f"{IMPORTS}def f(x):\n    {body}") as session, pytest.raises(SessionEnded) as caught:
        session.ask({"do": "evaluate", "name": "f", "kind": "function", "givens": [{"x": 1.0}]}, seconds)
    return caught.value.reason


def test_a_function_answers_each_given(starter):
    with loaded(starter, "def f(x):\n    print(open('data.txt').read())\n    return [x, 2*x]") as session:
        reply = session.ask({"do": "evaluate", "name": "f", "kind": "function", "givens": [{"x": 1.5}, {"y": 1}]}, 10)
    first, second = reply["outcomes"]
    assert first == {"value": [1.5, 3.0], "problem": "", "printed": "hallo\n"}
    assert second["value"] is None and "keep the argument names" in second["problem"]


SOCKET = "channel()"
#: how a body ends its session
ENDS = {
    "os._exit(0)": "exit",
    "os.abort()": "signal 11",  # no signal is sent, so the C library ends it otherwise
    "ctypes.string_at(0)": "signal 11",
    f"os.write({SOCKET}, b'{{[\\n')": "garbage",
    f"os.write({SOCKET}, b'[' * 100_000 + b'\\n')": "garbage",
    f"os.write({SOCKET}, b'1' * 5000 + b'\\n')": "garbage",
    f"[os.write({SOCKET}, bytes(1 << 16)) for _ in iter(int, 1)]": "flood",
    "os.closerange(3, 64) or time.sleep(60)": "exit",
    "time.sleep(60)": "time",
    "threading.Thread(target=time.sleep, args=(60,)).start() or ctypes.CDLL(None).pthread_exit(None)": "time",
}
ENDS_MANY = {
    "[fork() for _ in iter(int, 1)]": "processes",
    "[fork() or hold(1 << 26) for _ in range(8)] and time.sleep(60)": "memory",
}


@pytest.mark.parametrize("body", ENDS)
@pytest.mark.always("namespaces-time*", "namespaces-os.close*", "namespaces-os._exit*", "namespaces-os.abort*")
def test_how_it_ended(starter, body):
    assert ended(starter, body, 1.0 if ENDS[body] == "time" else 20.0) == ENDS[body]
    with loaded(starter, "k = 2.5") as session:
        assert value(session, "k") == 2.5
    assert descendants(starter.process) == []


@pytest.mark.wide
@pytest.mark.parametrize("body", ENDS_MANY)
def test_how_it_ended_where_it_may_start_processes(with_processes, body):
    assert ended(with_processes, body, 20.0) == ENDS_MANY[body]
    assert descendants(with_processes.process) == []
    with loaded(with_processes, "import subprocess\nk = subprocess.run(['true']).returncode + 2.5") as session:
        assert value(session, "k") == 2.5


def test_no_process_and_no_program_is_started(starter):
    tried = ("fork()", "execv('/bin/true', ['true'])", "posix_spawn('/bin/true', ['true'], {})", "system('true') == 0 or 1 / 0")
    attempt = "import os\ntry:\n    os.{}\n    said = 'started'\nexcept Exception as e:\n    said = type(e).__name__"
    cells = map(attempt.format, tried)
    for cell in cells:
        with loaded(starter, cell) as session:
            assert value(session, "said") in ("PermissionError", "ZeroDivisionError", "FileNotFoundError")


def test_nothing_outlives_a_session(with_processes):
    orphan = "if fork() == 0:\n    os.setsid()\n    if fork() == 0:\n        time.sleep(600)\n    os._exit(0)\nos.wait()"
    with loaded(with_processes, IMPORTS + orphan):
        assert len(descendants(with_processes.process)) == 2  # session, orphan
    assert descendants(with_processes.process) == []


def test_a_reply_written_before_its_request_is_none(starter):
    ahead = f'[os.write({SOCKET}, b\'{{"number": %d, "outcomes": [7]}}\\n\' % k) for k in range(9)]'
    with loaded(starter, f"{IMPORTS}{ahead}\nk = 2.5") as session:
        assert value(session, "k") == 2.5


def test_a_reply_of_too_many_numbers_is_not_read():
    with pytest.raises(SessionEnded, match="garbage"):
        parsed(b'{"number": 0, "a": [' + b"0," * 3_000_000 + b"0]}", "another")


@pytest.mark.wide
def test_sleep_and_work_are_charged(starter):
    with loaded(starter, "import time\ntime.sleep(0.4)", "while time.process_time() < 0.3: pass") as session:
        assert session.charged > 0.4


WRITES = {
    "many": "for k in range(100):\n    open(str(k), 'wb').write(bytes(1 << 20))",
    "empty": "for k in range(1000):\n    open(str(k), 'wb')",
    "nested": "for k in range(1000):\n    os.mkdir('d')\n    os.chdir('d')",
    "without a name": "for k in range(100):\n    f = os.open('f', 65)\n    os.write(f, bytes(1 << 20))\n    os.unlink('f')",
}


@pytest.mark.parametrize("what", WRITES)
def test_files_are_bounded(starter, what):
    with starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [f"import os\n{WRITES[what]}\nwhile True: pass"], "files": {}}, 10)
        if starter.level == "namespaces":
            assert "No space left" in session.ask({"do": "run", "cell": 0}, 10)["problem"]
        else:
            with pytest.raises(SessionEnded, match="flood"):
                session.ask({"do": "run", "cell": 0}, 10)


@pytest.mark.wide
def test_a_zygote_that_was_killed_is_started_anew(starter):
    os.kill(starter.process, signal.SIGKILL)
    with loaded(starter, "k = 2.5") as session:
        assert value(session, "k") == 2.5


@pytest.mark.wide
def test_a_zygote_ends_all_when_its_grader_is_gone():
    with Preloaded() as preloaded:
        control, process = preloaded.zygote()
        starter = Starter("none", (), LIMITS, control, process)
        session = loaded(starter, "k = 2.5")
        # as Ctrl-C does it: an order is being carried out, and nobody waits for the answer
        control.send(b'{"do": "ready", "level": "none", "user": 0}')
        control.close()
    assert not os.path.exists(f"/proc/{process}") and not os.path.exists(f"/proc/{session.process}")
    session.close()
    starter.close()


def test_memory_is_bounded_by_a_group_where_there_is_one(starter):
    if starter.group is None:
        pytest.skip(f"no control group is to be had here: {starter.no_group}")
    with pytest.MonkeyPatch.context() as patch, loaded(starter, IMPORTS + "def f(x):\n    hold(280 << 20)") as session:
        patch.setattr(watch, "anonymous", lambda _: 0)
        (starter.group.folder / "memory.limit_in_bytes").write_text(str(100 * MIB))
        with pytest.raises(SessionEnded, match="memory"):
            session.ask({"do": "evaluate", "name": "f", "kind": "function", "givens": [{"x": 1.0}]}, 10)
        (starter.group.folder / "memory.limit_in_bytes").write_text(str(LIMITS.memory + LIMITS.scratch))


@pytest.mark.wide
@pytest.mark.parametrize("level", ["landlock", "none"])
def test_processes_are_refused_where_none_counts_them(level):
    with pytest.raises(CourseError, match="needs namespaces, or a separate user by which the system counts processes"):
        start(level, limits=MANY)


def test_a_level_that_is_none_is_named():
    with pytest.raises(CourseError, match="needs one of auto, namespaces, user, landlock, none"):
        start("docker")
