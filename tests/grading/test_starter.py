"""A session answers with plain values; whatever it does, the grader knows how it ended, and goes on."""

import pytest

from hapticlab.grading.limits import MIB, Limits
from hapticlab.grading.starter import SessionEnded, start

LIMITS = Limits(seconds=1.0, memory=300 * MIB, processes=16, scratch=4 * MIB, answer=MIB)
IMPORTS = "import os, signal, socket, stat, subprocess, sys, time"
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


def ended(starter, body, seconds=10.0):
    """Return why a session ended whose answer has this body."""
    with loaded(starter, f"{IMPORTS}\ndef f(x):\n    {body}") as session, pytest.raises(SessionEnded) as caught:
        session.ask({"do": "evaluate", "name": "f", "kind": "function", "givens": [{"x": 1.0}]}, seconds)
    return caught.value.reason


def test_a_function_answers_each_given(starter):
    with loaded(starter, "def f(x):\n    print(open('data.txt').read())\n    return [x, 2*x]") as session:
        reply = session.ask({"do": "evaluate", "name": "f", "kind": "function", "givens": [{"x": 1.5}, {"y": 1}]}, 10)
    first, second = reply["outcomes"]
    assert first == {"value": [1.5, 3.0], "problem": "", "printed": "hallo\n"}
    assert second["value"] is None and "keep the names" in second["problem"]


@pytest.mark.parametrize(
    "body, reason",
    [
        ("os._exit(0)", "exit"),
        ("os.abort()", "signal 6"),
        ("os.kill(os.getpid(), signal.SIGKILL)", "signal 9"),
        ("[os.write(k, b'{[\\n') for k in range(64) if stat.S_ISSOCK(os.fstat(k).st_mode)]", "garbage"),
    ],
)
def test_how_it_ended(starter, body, reason):
    assert ended(starter, body) == reason


def test_a_hang_ends_at_its_deadline(starter):
    assert ended(starter, "time.sleep(1e9)", seconds=0.3) == "time"
