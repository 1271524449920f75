"""Sessions where no fork is: the same answers, each exercise by itself, and an end to each."""

import os
import time

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


WHOLE = ({"do": "run", "cell": 0},)
SLICE = {"do": "plan", "names": ["count", "leave"]}, {"do": "run_pieces"}


def loaded(requests=WHOLE):
    session = SpawnedStarter(PACKAGE, ENVIRONMENT).session(Limits(answer=MIB))
    for request in ({"do": "load", "cells": [CELL], "files": {}}, *requests):
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


def test_each_exercise_finds_the_notebook_as_it_ran_and_pays_for_no_interpreter():
    began = time.monotonic()
    with loaded() as session:
        assert [counts(session), counts(session)] == [[1.0, 2.0], [1.0, 2.0]]
        assert session.charged < 0.5 * (time.monotonic() - began)  # of two starts, and a cell that does nothing


def test_where_only_a_slice_ran_one_interpreter_answers_for_all():
    session = loaded(SLICE)
    assert [counts(session), counts(session)] == [[1.0, 2.0], [3.0, 4.0]]
    assert ended(session, "leave") == "exit"


@pytest.mark.parametrize(("name", "seconds", "reason"), [("flood", 60, "flood"), ("hang", 0.5, "time")])
def test_how_it_ended(name, seconds, reason):
    assert ended(loaded(), name, seconds) == reason
