"""Work against precision: ``python tests/benchmarks/work_precision.py [--quick] [--json FILE]``.

Four motions without a hand, by hapticlab, SciPy, heyoka and MuJoCo in one run: a double pendulum (smooth), a ball on an
elastic floor, and a mass on a spring that strikes a wall, damped or stiff. The error is that of the positions at the end,
relative to the largest; work is CPU time, the best of several rounds, without compiling, which stands in brackets. Below
each table: the least work by each solver for an error, and its ratio to hapticlab's. hapticlab's step is a tick of its
loop; heyoka and SciPy run freely, and heyoka once more as a loop at 1 kHz would have it.

``pip install "hapticlab[bench]" heyoka mujoco`` brings the peers; one that is not installed is left out. SciPy is given
right-hand sides compiled by numba where that is installed, and is restarted at each contact; heyoka stops at its events.
The truth is DOP853 at its tightest with events, restarted; how far hapticlab's series at small steps is from it is printed.
"""

import argparse
import json
import math
import os
import sys
import time
from pathlib import Path

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):  # the matrices are small, and CPU time is counted
    os.environ.setdefault(threads, "1")
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import numpy as np  # noqa: E402
import work_precision_peers as peers  # noqa: E402
from timing import best_of  # noqa: E402
from work_precision_problems import PROBLEMS  # noqa: E402

OURS = "hapticlab"
ERRORS = (1e-3, 1e-6, 1e-9, 1e-12)


def measure(problem, rounds):
    """Return rows (solver, setting, error, CPU s, CPU s to make it or why there is none) of a problem."""
    truth = peers.truth(problem)
    rows = []
    for solver, setting, make in peers.settings(problem):
        begin = time.process_time()
        try:
            run = make()
            if run is None:
                continue
            found = np.asarray(run(), float)
        except peers.REFUSALS as why:
            rows.append((solver, setting, math.nan, math.nan, str(why).split(";")[0][:60]))
            continue
        makes = time.process_time() - begin
        error = np.abs(found - truth).max() / problem.scale
        if not error < 1:
            rows.append((solver, setting, math.nan, math.nan, "unstable or lost"))
            continue
        begin = time.process_time()
        run()
        seconds = time.process_time() - begin
        many = max(1, min(200, int(2e-3 / max(seconds, 1e-9))))
        if seconds < 0.3:
            seconds = best_of(rounds, run=lambda run=run, many=many: [run() for _ in range(many)])["run"] / many
        rows.append((solver, setting, error, seconds, makes))
    return rows


def least_work(rows):
    """Return {solver: {error: (seconds, setting)}}, the cheapest setting that reaches each error."""
    found = {}
    for solver, setting, error, seconds, _ in rows:
        for bound in ERRORS:
            best = found.setdefault(solver, {})
            if error <= bound and seconds < best.get(bound, (math.inf,))[0]:
                best[bound] = seconds, setting
    return found


def shown(problem, rows):
    """Return the tables of a problem as markdown."""
    head = "| solver | setting | error | CPU us | (made in ms) |"
    lines = [f"\n## {problem.name}, {problem.duration:g} s\n", head, "|---|---|---:|---:|---:|"]
    for solver, setting, error, seconds, makes in rows:
        if math.isnan(error):
            lines.append(f"| {solver} | {setting} | - | - | {makes} |")
        else:
            lines.append(f"| {solver} | {setting} | {error:.1e} | {seconds * 1e6:.4g} | ({makes * 1e3:.3g}) |")
    least = least_work(rows)
    head = "| least CPU us for an error of | " + " | ".join(f"{e:.0e}" for e in ERRORS) + " |"
    lines += ["", head, "|---" * (1 + len(ERRORS)) + "|"]
    ours = least.get(OURS, {})
    for solver, best in least.items():
        cells = []
        for bound in ERRORS:
            if bound not in best:
                cells.append("-")
                continue
            seconds, setting = best[bound]
            ratio = f", {seconds / ours[bound][0]:.3g} x" if solver != OURS and bound in ours else ""
            cells.append(f"{seconds * 1e6:.4g} ({setting}){ratio}")
        lines.append(f"| {solver} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main(arguments=None):
    """Measure every problem, print its tables as they come, and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE", help="also write the numbers to FILE")
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    parser.add_argument("--only", metavar="NAME", help="problems whose name holds NAME")
    options = parser.parse_args(arguments)
    results = {}
    for problem in PROBLEMS:
        if options.only and options.only not in problem.name:
            continue
        rows = results[problem.name] = measure(problem, 2 if options.quick else 7)
        print(shown(problem, rows), flush=True)
        print(f"\nhapticlab's series in small steps and the truth differ by {peers.agreement(problem):.1e}")
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
