"""The command line in processes of their own, forked from one that has imported it already: 0.1 s each, not 1.5 s."""

import multiprocessing
import os
import sys
import traceback
from subprocess import CompletedProcess

LONGEST = 120  # seconds; the longest command of the tests takes 4
if sys.platform == "win32":
    _context = multiprocessing.get_context("spawn")
else:
    _context = multiprocessing.get_context("forkserver")
    # what the commands import, which the command line does only when one runs
    _commands = [f"hapticlab.cli.{name}" for name in ("scenes", "board", "labs", "assign", "grade")]
    _context.set_forkserver_preload(["hapticlab.cli.main", *_commands, "matplotlib.backends.backend_agg"])


def run_command(arguments, folder):
    """Run ``hapticlab`` with these arguments in a folder; return its exit code, stdout and stderr as subprocess does."""
    said, complained = folder / "..stdout", folder / "..stderr"
    child = _context.Process(target=_child, args=([str(a) for a in arguments], str(folder), str(said), str(complained)))
    child.start()
    child.join(LONGEST)
    if child.exitcode is None:
        child.kill()
        child.join()
    done = CompletedProcess(arguments, child.exitcode, said.read_text("utf-8"), complained.read_text("utf-8"))
    said.unlink(), complained.unlink()
    return done


def _child(arguments, folder, said, complained):
    from hapticlab.cli.main import main

    os.chdir(folder)
    for path, number in ((said, 1), (complained, 2)):
        os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    sys.path[0] = ""
    code = 1
    try:
        code = main(arguments)
    except SystemExit as left:
        code = left.code or 0
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush(), sys.stderr.flush()
    os._exit(code)
