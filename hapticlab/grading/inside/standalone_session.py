"""A session in a process of its own, on a system without the walls of Linux: it is asked over its standard input and output."""

import json
import os
import sys

from .session import Session


def main():
    """Keep input and output for the grader alone, and answer; the limits are the last argument."""
    channel, output = os.dup(0), os.dup(1)
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)
    limits = json.loads(sys.argv.pop())
    Session(channel, limits, output=output).serve()
