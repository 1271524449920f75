"""A student's session: their cells run here, their answers are evaluated, and plain values go out. It is one process.

Nothing is enforced here, as the student's code could undo it: the grader does, from outside.
"""

import base64
import builtins
import json
import os
import random
import re
import sys
from pathlib import Path

import numpy as np

from ...course import check as checks
from ...course.evaluate import evaluate
from .cells import fresh_names, run_cell
from .protocol import MOST_NUMBERS, reply, requests
from .slices import needed, run_pieces

ADDRESS = re.compile("0x[0-9a-fA-F]{6,}")


class Session:
    """Answers requests over a file descriptor.

    Parameters
    ----------
    channel : int
        A socket, or with ``output`` the reading end of a pipe.
    limits : dict
        ``answer`` [bytes] and ``printed`` [characters].
    output : int, optional
        The writing end.
    """

    def __init__(self, channel, limits, output=None):
        self.channel, self.output, self.limits = channel, channel if output is None else output, limits
        self.cells, self.pieces = [], []
        self.names = quiet_names()
        self.scratch = os.getcwd()

    def serve(self):
        """Answer until the grader closes."""
        for request in requests(self.channel):
            reply(self.output, request["number"], getattr(self, "do_" + request["do"])(request))

    def do_ready(self, request):
        """Say that all is loaded."""
        return {}

    def do_load(self, request):
        """Keep the cells; write the files beside them."""
        for name, content in request["files"].items():
            Path(name).write_bytes(base64.b64decode(content))
        self.cells = request["cells"]
        return {"cells": len(self.cells)}

    def do_run(self, request):
        """Run a whole cell."""
        cell = request["cell"]
        return {"problem": self.masked(run_cell(self.cells[cell], self.names, cell + 1))}

    def do_plan(self, request):
        """Say whether it is known which statements the answers need, and keep them."""
        self.pieces = needed(self.cells, request["names"])
        return {"known": self.pieces is not None}

    def do_run_pieces(self, request):
        """Run them."""
        return {"problem": self.masked(run_pieces(self.cells, self.pieces, self.names))}

    def do_evaluate(self, request):
        """Evaluate an answer for each given, and return the outcomes as plain values."""
        answer = self.names.get(request["name"])
        outcomes = [self.outcome(request["kind"], answer, given) for given in request["givens"]]
        text = json.dumps(outcomes)
        if len(text) > self.limits["answer"] or text.count(",") > MOST_NUMBERS:
            outcomes = [{"value": None, "problem": "its values are too large to transfer", "printed": ""}] * len(outcomes)
        return {"outcomes": outcomes}

    def outcome(self, kind, answer, given):
        """Return one outcome as plain values."""
        found = evaluate(kind, answer, given)
        value = self.masked(found.value) if isinstance(found.value, str) else found.value
        printed = self.masked(found.printed[: self.limits["printed"]])
        return {"value": value, "problem": self.masked(found.problem), "printed": printed}

    def masked(self, text):
        """Return a text without what differs from run to run: addresses, and the scratch folder."""
        return ADDRESS.sub("0x...", text.replace(self.scratch, "."))


def quiet_names():
    """Return the names a notebook starts with; nothing that runs is judged, shown or asked."""
    passed = checks.CheckResult("", True, True, (), checks.Card("", "saved", ""))
    sys.modules["hapticlab"].check = checks.check = lambda *_, **__: passed
    random.seed(0)
    np.random.seed(0)  # noqa: NPY002 what students call without a generator of their own
    builtins.input = no_input
    return fresh_names()


def no_input(prompt=""):
    """Raise, as nobody sits there."""
    raise EOFError("input() gets no answer while a notebook is graded")
