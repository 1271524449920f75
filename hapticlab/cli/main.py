"""The command line: demo, labs, assign, grade, concepts, run, tradeoff and share FILE.py, and of a paddle ports, flash, ...

Each command is a function that `cli.options` names.
"""

import os
import sys
from importlib import import_module

from ..errors import HapticlabError
from .begin import unknown
from .exits import BROKEN_PIPE, INTERRUPTED, USAGE, complain
from .options import parser


def main(arguments=None):
    """Run the command line and return its exit code: 0, 1 for a run that failed, 2 for a wrong command.

    130 for one interrupted by Ctrl-C, 141 where the reader of its output went away.
    """
    if hasattr(sys.stdout, "reconfigure"):  # a console that cannot write a name writes its number, and the command goes on
        sys.stdout.reconfigure(errors="backslashreplace")
    commands = parser()
    given = sys.argv[1:] if arguments is None else [*arguments]
    if given and not given[0].startswith("-") and given[0] not in commands.commands:
        complain(f"{unknown(given[0])} `hapticlab -h` lists the commands")
        return USAGE
    options = commands.parse_args(given)
    if options.command is None:
        commands.print_help()
        return USAGE
    try:
        code = _command(options.command)(options.parser, options)
        sys.stdout.flush()  # here, where a closed pipe can still be met
        return code
    except HapticlabError as problem:
        return complain(problem)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush when Python ends
        return BROKEN_PIPE
    except OSError as problem:
        return complain(": ".join(str(a) for a in (problem.filename, problem.strerror or problem) if a))
    except KeyboardInterrupt:
        complain("interrupted")
        return INTERRUPTED


def _command(name):
    """Return the function of a command, "module.function"; only this command's module is imported."""
    module, _, function = name.rpartition(".")
    return getattr(import_module(f"hapticlab.{module}"), function)
