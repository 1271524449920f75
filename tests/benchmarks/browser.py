"""Seconds of every lab, and of the pages' sweep, map and trade-off, in Pyodide and on this computer, for docs/how_to/browser.md.

    python tests/benchmarks/browser.py            # print the table
    python tests/benchmarks/browser.py --write    # and write it into docs/how_to/browser.md

One Pyodide and one Python of this computer do all rows, one after the other. The seconds are those of a processor, which other
programs on the computer change less than time by the clock: of node's main thread, where Python runs while V8 compiles in other
threads, and of the thread that asks here, with the processes that it starts. Linux alone counts them by thread.
"""

import json
import os
import resource
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    os.environ |= {"OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "agg"}
    sys.path[:0] = [str(ROOT / "tests" / "pyodide")]

from both_ways import IN_PYODIDE, WORK  # noqa: E402
from in_pyodide import Pyodide, wheel  # noqa: E402
from pyodide_archive import CORE, LOCK, archive  # noqa: E402

PAGE = ROOT / "docs" / "how_to" / "browser.md"
BEGIN, END = "<!-- written by tests/benchmarks/browser.py -->\n", "<!-- end -->\n"
STUDIES = {
    "readme_example": "README's example: a run, its chatter, two limits, a live view",
    "sweep": "the sweep of [scenes.md](scenes.md), 600 walls",
    "wall_map": "the wall map of [measuring.md](measuring.md), 40 x 40 walls",
    "tradeoff": "speed against accuracy of [methods.md](../explanation/methods.md), 594 rows",
}


class InBrowser:
    """A Pyodide, and the seconds that it took to load."""

    def __init__(self):
        self._pyodide = Pyodide()
        self.loading = self._used()

    def seconds(self, name, *given):
        before = self._used()
        said = self._pyodide.ask({"code": IN_PYODIDE, "folder": str(ROOT), "values": {"name": name, "given": given}}, 900)
        assert not said["error"] and not said["left"], said
        return self._used() - before

    def _used(self):
        """Return the seconds of processor of node's main thread, by proc_pid_stat(5)."""
        pid = self._pyodide.pid
        fields = Path(f"/proc/{pid}/task/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def here(name, *given):
    """Return the seconds in this Python."""
    before = _used_here()
    WORK[name](*given)
    return _used_here() - before


def _used_here():
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.thread_time() + children.ru_utime + children.ru_stime


def table():
    """Yield the lines of the table, and of what is loaded before."""
    browser = InBrowser()
    yield "| what | Pyodide [s] | desktop [s] |"
    yield "| --- | --- | --- |"
    yield f"| loading Python and installing the packages | {browser.loading:.1f} | |"
    rows = [("importing the packages", "imports")]
    for number, _, name in (path.name.partition("_") for path in sorted((ROOT / "labs").glob("[0-9][0-9]_*"))):
        rows += [
            (f"lab {number}, {name.replace('_', ' ')}, {state}", f"{state}_lab", number) for state in ("untouched", "solved")
        ]
    for words, *call in [*rows, *((words, name) for name, words in STUDIES.items())]:
        yield f"| {words} | {browser.seconds(*call):.1f} | {here(*call):.1f} |"
    packages = json.loads((archive() / LOCK).read_text("utf-8"))["packages"].values()
    core, more = (_megabytes(archive() / n for n in names) for names in (CORE, [p["file_name"] for p in packages]))
    yield ""
    yield f"Pyodide's core has {core:.0f} MB, its packages have {more:.0f} MB, hapticlab's wheel {_megabytes([wheel()]):.1f} MB."


def _megabytes(paths):
    return sum(path.stat().st_size for path in paths) / 1e6


def main():
    lines = []
    for line in table():
        print(line, flush=True)
        lines.append(line)
    if "--write" in sys.argv:
        before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
        PAGE.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n\n" + END + rest.partition(END)[2], "utf-8")


if __name__ == "__main__":
    main()
