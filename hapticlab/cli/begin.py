"""The first screen of the command line: where to begin, and what there is; what was meant by an unknown command."""

import argparse
import shutil
import sys
import textwrap

from .exits import USAGE, fitted

#: group -> its commands, in the order in which people meet them
GROUPS = {
    "Look and learn": ("demo", "labs"),
    "Run a scene of your own": ("run", "tradeoff", "share"),
    "With a paddle": ("guide", "ports", "doctor", "flash", "calibrate", "bench"),
    "With a class": ("assign", "grade", "concepts", "site", "wheels"),
}
BEGIN = """hapticlab: from an equation of motion to a felt virtual wall.

Begin here; no board is needed:
  hapticlab demo        a simulated wall that chatters, with a figure (half a minute)
  hapticlab labs        all labs, opened in JupyterLab
  hapticlab labs 02     one lab: the virtual wall"""
END = """Options of a command: hapticlab COMMAND -h. Version: hapticlab --version."""
#: columns of a command's name
NAMED = 12


class Parser(argparse.ArgumentParser):
    """The parser of all commands; its help is the first screen. ``commands`` holds each command's own parser by its name."""

    commands: dict[str, argparse.ArgumentParser]

    def format_help(self):
        """The first screen, as wide as the terminal."""
        return "\n".join([BEGIN, *_groups(self.commands), "", END]) + "\n"

    def error(self, message):
        """Refuse a wrong command in one line."""
        self.exit(USAGE, fitted(f"hapticlab: {message}. `hapticlab -h` lists the commands") + "\n")


class Command(argparse.ArgumentParser):
    """The parser of one command."""

    def error(self, message):
        """Refuse wrong options in lines that fit the terminal."""
        self.print_usage(sys.stderr)
        self.exit(USAGE, fitted(f"{self.prog}: error: {message}") + "\n")


def _groups(commands):
    """Yield the lines of every group."""
    width = min(shutil.get_terminal_size().columns, 100)
    for group, names in GROUPS.items():
        yield f"\n{group}:"
        for name in names:
            text, indent = str(commands[name].description), " " * (NAMED + 2)
            yield textwrap.fill(text, width, initial_indent=f"  {name:<{NAMED}}", subsequent_indent=indent)


def unknown(name):
    """What to say of a command that does not exist.

    Examples
    --------
    >>> unknown("lbas")
    "'lbas' is not a command; did you mean labs?"
    """
    from difflib import get_close_matches  # opened by a mistake alone

    near = get_close_matches(name, [one for names in GROUPS.values() for one in names], 1, 0.5)
    return f"{name!r} is not a command" + (f"; did you mean {near[0]}?" if near else ".")


def lab_number(text):
    """The two digits of a lab, as "6" or "06" name it; the folder of a lab of your own stays what it is.

    Examples
    --------
    >>> lab_number("6"), lab_number("06"), lab_number("labs/my_lab")
    ('06', '06', 'labs/my_lab')
    """
    return text.zfill(2) if text.isdecimal() and len(text) <= 2 else text
