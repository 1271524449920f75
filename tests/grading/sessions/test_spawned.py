"""Sessions where no fork is: the same answers, and an end to each."""

import os
import time

import pytest

from hapticlab.grading.sessions.asking import SessionEnded
from hapticlab.grading.sessions.limits import MIB, Limits
from hapticlab.grading.sessions.spawned import SpawnedStarter

CELL = """
import os, time
seen = []
def count(x):
    seen.append(x)
    return len(seen)
def leave(x):
    os._exit(3)
def flood(x):
    while True:
        for k in range(3, 64):
            try: os.write(k, bytes(1 << 16))
            except OSError: pass
def hang(x):
    time.sleep(600)
"""


def loaded():
    session = SpawnedStarter().session(Limits(answer=MIB))
    for request in ({"do": "load", "cells": [CELL], "files": {}}, {"do": "run", "cell": 0}):
        session.ask(request, 60)
    return session


def counts(session):
    """Return what the function that counts its calls says to two."""
    reply = session.ask({"do": "evaluate", "name": "count", "kind": "function", "givens": [{"x": 1.0}] * 2}, 60)
    return [outcome["value"] for outcome in reply["outcomes"]]


def ended(session, name, seconds=60.0):
    """Return why an exercise ended the session, of which nothing is left."""
    with session, pytest.raises(SessionEnded) as caught:
        session.ask({"do": "evaluate", "name": name, "kind": "function", "givens": [{"x": 1.0}]}, seconds)
    assert not os.path.exists(session.folder.name)
    return caught.value.reason


@pytest.mark.wide
def test_one_interpreter_answers_for_all_and_its_start_is_not_charged():
    began = time.monotonic()
    with loaded() as session:
        assert [counts(session), counts(session)] == [[1.0, 2.0], [3.0, 4.0]]
        assert session.charged < 0.5 * (time.monotonic() - began)  # a cell that does nothing
    assert ended(loaded(), "leave") == "exit"


@pytest.mark.parametrize(("name", "seconds", "reason"), [("flood", 60, "flood"), ("hang", 0.5, "time")])
@pytest.mark.always("hang-*")
def test_how_it_ended(name, seconds, reason):
    assert ended(loaded(), name, seconds) == reason
