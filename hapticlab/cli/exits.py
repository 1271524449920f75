"""How a command ends: its exit codes, and what went wrong in one line."""

import sys

#: the last two are what a shell reports of a program that ended by Ctrl-C, or by writing to a closed pipe
FAILED, USAGE, INTERRUPTED, BROKEN_PIPE = 1, 2, 130, 141


def complain(problem):
    """Print what went wrong to stderr, and return the exit code 1."""
    print(f"hapticlab: {problem}", file=sys.stderr)
    return FAILED
