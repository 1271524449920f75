"""Sessions where no fork is: the same answers, each exercise by itself, and an end to each."""

import os

import pytest

from hapticlab.grading.asking import SessionEnded
from hapticlab.grading.limits import MIB, Limits
from hapticlab.grading.spawned import SpawnedStarter
from hapticlab.grading.starter import ENVIRONMENT, PACKAGE

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
    session = SpawnedStarter(PACKAGE, ENVIRONMENT).session(Limits(answer=MIB))
    assert session.ask({"do": "load", "cells": [CELL], "files": {}}, 60) == {"cells": 1}
    assert session.ask({"do": "run", "cell": 0}, 60) == {"problem": ""}
    return session


def test_each_exercise_finds_the_notebook_as_it_ran():
    with loaded() as session:
        for _ in range(2):
            reply = session.ask({"do": "evaluate", "name": "count", "kind": "function", "givens": [{"x": 1.0}] * 2}, 60)
            assert [outcome["value"] for outcome in reply["outcomes"]] == [1.0, 2.0]


@pytest.mark.parametrize(("name", "seconds", "reason"), [("leave", 60, "exit"), ("flood", 60, "flood"), ("hang", 0.5, "time")])
def test_how_it_ended(name, seconds, reason):
    with loaded() as session, pytest.raises(SessionEnded, match=reason):
        session.ask({"do": "evaluate", "name": name, "kind": "function", "givens": [{"x": 1.0}]}, seconds)
    assert not os.path.exists(session.folder.name)
