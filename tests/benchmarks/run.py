"""The benchmark: ``python tests/benchmarks/run.py [--quick] [--json FILE]`` prints a table of times and ratios.

Everything compared is measured in the same run, in CPU time, the best of several rounds taking turns: the ratios are the
result, the times belong to the machine. A row with targets says whether they are met, in the JSON as target and met.
A peer that is not installed says so (``pip install "hapticlab[bench]"`` brings them all, where they have wheels); the C by
hand needs a C compiler or the ziglang of that extra.
"""

import argparse
import json
import platform
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import again  # noqa: E402
import footprint  # noqa: E402
import latency  # noqa: E402
import maps  # noqa: E402
import numpy as np  # noqa: E402
import steps  # noqa: E402
import sweeps  # noqa: E402
import switched  # noqa: E402
from timing import SCALE  # noqa: E402

SECTIONS = {
    "SymPy expression to running code, imports done": latency.rows,
    "a scene again: compile, run, sweep and check, each against the line that it names": again.rows,
    "one RK4 step, float64; against the C by hand": steps.rows,
    "linear between switches, a tick, float64; against the C by hand": switched.rows,
    "10 000 points, a second at 1 kHz, one core; against the C by hand": sweeps.rows,
    "a map of a million points, a second at 1 kHz; against hl.sweep on one thread": maps.rows,
    "memory, size and import": footprint.rows,
}


def main(arguments=None):
    """Measure every section, print each as it comes, and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE", help="also write the numbers to FILE")
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    options = parser.parse_args(arguments)
    machine = {"python": platform.python_version(), "numpy": np.__version__, "system": platform.platform()}
    results = {"machine": machine, "sections": {}}
    for title, rows in SECTIONS.items():
        found = results["sections"][title] = rows(2 if options.quick else 7)
        print(f"\n{title}")
        for line in found:
            ratio = "" if line["ratio"] is None else f"{line['ratio']:8.2f} x"
            print(f"  {line['what']:<66}{_number(line):>14} {ratio:<11} {_judged(line)}{line['note']}".rstrip(), flush=True)
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=1) + "\n")


def _number(line):
    value, unit = line["value"], line["unit"]
    if value is None:
        return "-"
    return f"{value * SCALE[unit]:.4g} {unit}"


def _judged(line):
    word = {True: "met", False: "MISSED", None: "not measured"}
    return "".join(f"target {bound}: {word[met]}  " for bound, met in zip(line["target"], line["met"], strict=True))


if __name__ == "__main__":
    main()
