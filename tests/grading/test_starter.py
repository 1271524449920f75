"""A session answers with plain values; whatever it does, the grader knows how it ended, and goes on."""

import os

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.asking import parsed
from hapticlab.grading.limits import MIB, Limits
from hapticlab.grading.starter import SessionEnded, start
from hapticlab.grading.watch import descendants

LIMITS = Limits(seconds=1.0, memory=300 * MIB, processes=16, scratch=4 * MIB, answer=MIB)
IMPORTS = """
import ctypes, os, signal, stat, time
def fork():
    try:
        return os.fork()
    except OSError:
        return -1
def hold(size):
    kept = b"x" * size
    time.sleep(600)
"""
FILE = "aGFsbG8="  # hallo


@pytest.fixture(scope="module", params=["none", "namespaces"])
def starter(request):
    with start(request.param) as started:
        yield started


def loaded(starter, *cells):
    """Return a session in which these cells ran."""
    session = starter.session(LIMITS)
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
    assert second["value"] is None and "keep the names" in second["problem"]


SOCKET = "next(k for k in range(64) if stat.S_ISSOCK(os.fstat(k).st_mode))"
ENDS = {
    "os._exit(0)": "exit",
    "os.abort()": "signal 6",
    "os.kill(os.getpid(), signal.SIGKILL)": "signal 9",
    "ctypes.string_at(0)": "signal 11",
    f"os.write({SOCKET}, b'{{[\\n')": "garbage",
    f"os.write({SOCKET}, b'[' * 100_000 + b'\\n')": "garbage",
    f"os.write({SOCKET}, b'1' * 5000 + b'\\n')": "garbage",
    f"[os.write({SOCKET}, bytes(1 << 16)) for _ in iter(int, 1)]": "flood",
    "[fork() for _ in iter(int, 1)]": "processes",
    "[fork() or hold(1 << 26) for _ in range(8)] and time.sleep(60)": "memory",
    "os.closerange(3, 64) or time.sleep(60)": "time",
    "time.sleep(60)": "time",
}


@pytest.mark.parametrize("body", ENDS)
def test_how_it_ended(starter, body):
    assert ended(starter, body, 1.0 if ENDS[body] == "time" else 20.0) == ENDS[body]
    with loaded(starter, "k = 2.5") as session:
        assert value(session, "k") == 2.5


def test_nothing_outlives_a_session(starter):
    orphan = "if fork() == 0:\n    os.setsid()\n    if fork() == 0:\n        time.sleep(600)\n    os._exit(0)\nos.wait()"
    with loaded(starter, IMPORTS + orphan):
        assert len(descendants(starter.process.pid)) == 3  # keeper, session, orphan
    assert descendants(starter.process.pid) == []


def test_a_reply_written_before_its_request_is_none(starter):
    ahead = f"[os.write({SOCKET}, b'{{\"number\": %d, \"outcomes\": [7]}}\\n' % k) for k in range(9)]"
    with loaded(starter, f"{IMPORTS}{ahead}\nk = 2.5") as session:
        assert value(session, "k") == 2.5


def test_a_reply_of_too_many_numbers_is_not_read():
    with pytest.raises(SessionEnded, match="garbage"):
        parsed(b'{"number": 0, "a": [' + b"0," * 3_000_000 + b"0]}", "another")


def test_sleep_and_work_are_charged(starter):
    with loaded(starter, "import time\ntime.sleep(0.4)", "while time.process_time() < 0.3: pass") as session:
        assert session.charged > 0.4


def test_files_are_bounded(starter):
    write = "for k in range(100):\n    open(str(k), 'wb').write(bytes(1 << 20))\nwhile True: pass"
    with starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [write], "files": {}}, 10)
        if starter.level == "namespaces":
            assert "No space left" in session.ask({"do": "run", "cell": 0}, 10)["problem"]
        else:
            with pytest.raises(SessionEnded, match="flood"):
                session.ask({"do": "run", "cell": 0}, 10)


@pytest.mark.parametrize("starter", ["none"], indirect=True)
def test_a_zygote_that_was_killed_is_started_anew(starter):
    kill = f"if fork(): os.kill({starter.process.pid}, signal.SIGKILL)\n    time.sleep(600)"
    assert ended(starter, kill, 0.5)
    with loaded(starter, "k = 2.5") as session:
        assert value(session, "k") == 2.5


def test_a_zygote_ends_all_when_its_grader_is_gone(starter):
    session = loaded(starter, "k = 2.5")
    before = descendants(starter.process.pid)
    # as Ctrl-C does it: an order is being carried out, and nobody waits for the answer
    starter.control.send(f'{{"do": "ready", "level": "none", "user": {starter.user}}}'.encode())
    starter.control.close()
    assert starter.process.wait() == 0
    assert len(before) == 2 and not any(os.path.exists(f"/proc/{process}") for process in before)
    session.close()


def test_a_level_that_is_none_is_named():
    with pytest.raises(CourseError, match="needs one of auto, namespaces, user, none"):
        start("docker")
