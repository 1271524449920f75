"""`python -m hapticlab.self_test FUNCTION FILE`: run one check in this process, and write what it found as JSON."""

import json
import os
import sys
import traceback
from importlib import import_module
from pathlib import Path

from .outcome import ATTENTION, FAULT, OK, Attention, Fault


def main(function, file):
    """Call a check by its dotted name, with the working folder as its own."""
    module, _, name = function.rpartition(".")
    try:
        state, found = OK, getattr(import_module(module), name)(Path.cwd())
    except Attention as problem:
        state, found = ATTENTION, str(problem)
    except Fault as problem:
        state, found = FAULT, str(problem)
    except BaseException:
        state, found = FAULT, f"the check failed unexpectedly\n{traceback.format_exc()}"
    part = Path(f"{file}.part")
    part.write_text(json.dumps({"state": state, "found": found}), "utf-8")
    os.replace(part, file)


if __name__ == "__main__":  # processes that a check starts import this module too
    main(*sys.argv[1:])
