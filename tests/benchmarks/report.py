"""The pages of docs/benchmarks: ``python tests/benchmarks/report.py [--only running] [--full] [--load 1.5]``.

Runs the benchmarks that have peers, one after the other, and writes a page of each: first where a peer is ahead, then what
was measured, on which machine, when and by which command. ``--full`` takes all rounds and sizes. A page of a busy machine
says its load; ``--load`` refuses to measure above one.
"""

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

HERE = Path(__file__).resolve().parent
DOCS = HERE.parents[1] / "docs" / "benchmarks"
PACKAGES = (
    "hapticlab", "numpy", "scipy", "sympy", "llvmlite", "numba", "pydy", "cython", "casadi", "mujoco", "jax", "heyoka", "symjit",
    "ziglang",
)  # fmt: skip
PEERS = ("C by hand", "numba", "PyDy", "JAX", "jax", "symjit")
OURS = "hapticlab"
BUSY = """The machine had other work while this was measured, so that the times are larger than those of an idle one. They are
times of the processor, and everything compared took turns; still, ratios may differ by half on another run."""


@dataclass(frozen=True)
class Page:
    """A page: its title, the question that it answers, its script with options for a short and a full run, and its readers."""

    title: str
    about: str
    script: str
    short: tuple[str, ...]
    full: tuple[str, ...]
    ahead: Callable  # of the numbers, the sentences that say where a peer is ahead
    tables: Callable  # of the numbers and what the script printed, the tables as Markdown
    concludes: str


def running_ahead(results):
    """Yield where a peer takes less than every line of hapticlab for the same thing, of the numbers of run.py."""
    for title, rows in results["sections"].items():
        groups = {}
        for row in rows:
            if row["value"] is not None:
                thing = row["what"].rpartition(":")[0] if ":" in row["what"] else ""
                groups.setdefault((thing.partition(":")[0], row["unit"]), []).append((row["value"], row["what"], row["note"]))
        for (_, unit), group in groups.items():
            peers = [one for one in group if any(peer in one[1] for peer in PEERS)]
            ours = min((one for one in group if one not in peers), default=None)
            for value, what, note in sorted(peers) if ours else ():
                if value < ours[0]:
                    more, best = f" ({note})" if note else "", ours[1].rpartition(": ")[2].removeprefix(f"{OURS}, ")
                    needed, of = "memory" if unit == "MB" else "time", f" ({best})" if best != OURS else ""
                    yield f"{title.partition(';')[0]}: {what}{more} needs {value / ours[0]:.2g} of hapticlab's {needed}{of}"


def running_tables(results, printed):
    """Return the sections of run.py as tables."""
    lines = []
    for title, rows in results["sections"].items():
        lines += [
            f"## {title[0].upper()}{title[1:]}",
            "",
            "| what | measured | ratio | target and note |",
            "| --- | ---: | ---: | --- |",
        ]
        for row in rows:
            words = {True: "met", False: "missed", None: "not measured"}
            judged = [f"{bound}: {words[met]}" for bound, met in zip(row["target"], row["met"], strict=True)]
            ratio = "" if row["ratio"] is None else f"{row['ratio']:.2f}"
            notes = "; ".join([*judged, *([row["note"]] if row["note"] else [])])
            lines.append(f"| {row['what']} | {_amount(row)} | {ratio} | {notes} |")
        lines.append("")
    return "\n".join(lines)


def _amount(row):
    from timing import SCALE

    return "-" if row["value"] is None else f"{row['value'] * SCALE[row['unit']]:.4g} {row['unit']}"


def modelling_ahead(results):
    """Yield where a peer's number is below hapticlab's, of the numbers of modelling.py, the sizes of one row together."""
    from modelling import TABLES

    headings, found = {where: heading for heading, where in TABLES.items()}, {}
    for title, by_size in results.items():
        for size, cells in by_size.items():
            for name, value in cells.items():
                where, _, who = name.partition(": ")
                ours = cells.get(f"{where}: {OURS}")
                if who != OURS and isinstance(value, (int, float)) and ours and value < ours:
                    key = (title, where, who)
                    found.setdefault(key, []).append(f"{value / ours:.2f} at {size}")
    for (title, where, who), sizes in found.items():
        kind, _, counted = title.partition("; ")
        yield f"{kind}, {headings[where]}: {who} needs less, by the ratios {', '.join(sizes)} {counted}"


def accuracy_ahead(results):
    """Yield where a solver needs less time than hapticlab for an error, of the numbers of work_precision.py."""
    from work_precision import least_work

    for problem, rows in results.items():
        least = least_work([(a, b, float("nan") if c is None else c, d, e) for a, b, c, d, e in rows])
        for solver, best in least.items():
            cells = [
                f"{best[bound][0] / least[OURS][bound][0]:.2f} of the time for an error of {bound:.0e}"
                if bound in least[OURS]
                else f"reaches an error of {bound:.0e}, which hapticlab does not"
                for bound in best
                if solver != OURS and not best[bound][0] >= least[OURS].get(bound, (float("inf"),))[0]
            ]
            if cells:
                yield f"{problem}: {solver}, {'; '.join(cells)}"


def least_work_tables(results, printed):
    """Return the table of least work of each problem, of what work_precision.py printed."""
    kept = [line for line in printed.splitlines() if line.startswith("## ")]
    for section in printed.split("\n## ")[1:]:
        name, lines = section.partition("\n")[0], section.splitlines()
        start = next(k for k, line in enumerate(lines) if line.startswith("| least CPU us"))
        kept[kept.index(f"## {name}")] = "\n".join([f"## {name}", "", *lines[start:]]).rstrip() + "\n"
    return "\n".join(kept)


def firmware_ahead(results):
    """Yield where the published loop does better than the firmware, of the numbers of hapkit.py."""
    from hapkit import worse

    yield from (line.strip() for line in worse(results))


def as_printed(results, printed):
    """Return what a script printed as Markdown."""
    first = printed.find("\n## ")
    return printed[first + 1 :].strip() + "\n" if first >= 0 else f"```text\n{printed.rstrip()}\n```\n"


def firmware_table(results, printed):
    """Return the table of hapkit.py, without what stands first on the page."""
    return as_printed(results, printed.partition("Where hapticlab's firmware does worse")[0])


PAGES = {
    "running": Page(
        "Compiling and running", "How long does a scene take to compile and to run, beside C by hand, numba, PyDy and JAX?",
        "run.py", ("--quick",), (), running_ahead, running_tables,
        "The ratios compare the same work in the same minutes. C by hand and numba were written by the authors of hapticlab: a "
        "better programmer may write faster code. Times do not carry over to another processor.",
    ),
    "modelling": Page(
        "From a Lagrangian to machine code",
        "How long do models of 1 to 8 links and columns of contacts take to derive, compile and step, beside PyDy, CasADi, numba "
        "and MuJoCo?",
        "modelling.py", ("--quick", "--kinds", "relative", "cart"), (), modelling_ahead, as_printed,
        "Every peer solves the same equations, compared to 1e-9 before anything is timed. MuJoCo does more than these models "
        "need, and PyDy and CasADi do things that hapticlab does not, such as optimisation.",
    ),
    "accuracy": Page(
        "Speed against accuracy", "Which solver needs the least time for an error, beside SciPy, heyoka and MuJoCo?",
        "work_precision.py", ("--quick",), (), accuracy_ahead, least_work_tables,
        "The errors are those at the end of each problem. A solver with variable steps may choose its steps, and hapticlab gives "
        "a force at every sample; the rows in ticks show what that costs. The times are those of the solver "
        "alone; a call such as `hl.records.evaluate` takes more. The command prints every setting of every solver.",
    ),
    "firmware": Page(
        "The firmware beside the published Hapkit loop", "What do the loops of both do on one Arduino Uno?",
        "hapkit.py", (), (), firmware_ahead, firmware_table,
        "Both images run in one emulator, in the board's own time, so that the numbers are the same on every computer. The loop "
        "is rebuilt from its description and was not run on a real board; neither was hapticlab's firmware.",
    ),
}  # fmt: skip


def machine():
    """Return the rows of a table that says where something was measured."""
    info = Path("/proc/cpuinfo")
    names = (
        [line.partition(": ")[2] for line in info.read_text().splitlines() if line.startswith("model name")]
        if info.exists()
        else []
    )
    system = platform.freedesktop_os_release()["PRETTY_NAME"] if sys.platform == "linux" else platform.platform()
    return {
        "processor": names[0] if names else platform.processor() or platform.machine(), "cores": str(os.cpu_count()),
        "system": system,
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        "packages": ", ".join(f"{name} {found}" for name in PACKAGES if (found := _version(name))),
        "not installed": ", ".join(name for name in PACKAGES if not _version(name)) or "none of those",
    }  # fmt: skip


def _load():
    """Return the mean number of processes that wanted a processor in the last minute; empty where no system tells it."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""


def _version(name):
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def written(page, command, facts, results, printed):
    """Return a page as Markdown."""
    ahead = [f"* {line}." for line in page.ahead(results)]
    where = [f"| {name} | {value} |" for name, value in facts.items()]
    # the times of an emulated board are its own
    busy = page.script != "hapkit.py" and any(float(load) > 1.5 for load in facts["load, before and after"].split(", ") if load)
    lines = [
        f"# {page.title}", "", page.about, "", "## Where a peer is ahead", "", *(ahead or ["Nowhere in what was measured."]), "",
        "## What you can conclude, and what not", "", page.concludes, *(["", BUSY] if busy else []), "",
        "## Where this was measured", "", "| | |", "| --- | --- |", *where, f"| command | `{command}` |", "",
        page.tables(results, printed),
    ]  # fmt: skip
    return "\n".join(lines).rstrip() + "\n"


def measured(name, options, folder):
    """Run a page's script; return its command, its numbers and what it printed."""
    page, numbers = PAGES[name], Path(folder, f"{name}.json")
    chosen = page.full if options.full else page.short
    command = [sys.executable, str(HERE / page.script), *chosen, "--json", str(numbers)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return " ".join(["python", f"tests/benchmarks/{page.script}", *chosen]), json.loads(numbers.read_text()), done.stdout


def main(arguments=None):
    """Measure, and write the pages."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=PAGES, default=list(PAGES), help="these pages alone")
    parser.add_argument("--full", action="store_true", help="all rounds and sizes, which takes an hour")
    parser.add_argument("--load", type=float, metavar="N", help="measure nothing where the load of the machine is above N")
    options = parser.parse_args(arguments)
    sys.path[:0] = [str(HERE), str(HERE.parents[1]), str(HERE.parent / "firmware")]
    DOCS.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.only:
            facts = {"date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d")} | machine()
            if options.load is not None and os.getloadavg()[0] > options.load:
                raise SystemExit(f"the load is {os.getloadavg()[0]:.1f}, above {options.load:g}; wait, or leave --load out")
            before = _load()
            command, results, printed = measured(name, options, folder)
            facts["load, before and after"] = f"{before}, {_load()}"
            (DOCS / f"{name}.md").write_text(written(PAGES[name], command, facts, results, printed), "utf-8")
            print(f"written: {DOCS / name}.md", flush=True)


if __name__ == "__main__":
    main()
