"""How a command ends: its exit codes, and what went wrong in one line."""

import shutil
import sys
import textwrap

#: the last two are what a shell reports of a program that ended by Ctrl-C, or by writing to a closed pipe
FAILED, USAGE, INTERRUPTED, BROKEN_PIPE = 1, 2, 130, 141


def complain(problem):
    """Print what went wrong to stderr, and return the exit code 1."""
    print(fitted(f"hapticlab: {problem}"), file=sys.stderr)
    return FAILED


def fitted(text):
    """Text in lines that end between words on a terminal; elsewhere, as in a log, as it is."""
    if not sys.stderr.isatty():
        return text
    width = max(40, shutil.get_terminal_size().columns)
    lines = {"break_long_words": False, "break_on_hyphens": False, "subsequent_indent": "  "}
    return "\n".join(textwrap.fill(line, width, **lines) for line in text.splitlines())
