"""Seconds per submission of three graders on one lab: `python tests/benchmarks/grading.py`.

`hapticlab grade`, `nbgrader autograde` and `otter run` grade the same answers to lab 02, handed in as their own notebooks: all
right, partly wrong, untouched. nbgrader and otter have one of each, hapticlab twenty of each. nbgrader and hapticlab take them in
one command, otter in one each, as they are meant to. Each ratio is of the faster of the two others. hapticlab also grades 1, 20,
200 and 1 000 solved notebooks, by one worker and by two; seconds are from the prompt to the report, and are also said in
`import sympy` of the same run. Then a class of 1 000 mixed submissions of the small lab, attackers among them, is graded by
two workers; it is another lab, so it has no ratio. `--quick` takes few of them.
"""

import argparse
import json
import os
import platform
import resource
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "grading")]
from attacks.arena import Arena  # noqa: E402
from attacks.mixed import SECONDS, mixed  # noqa: E402
from hand_in import INSTRUCTOR, LABS, WRONG, handed_in, start  # noqa: E402

from hapticlab.course.notebook import read, write  # noqa: E402

NUMBER = "02"
LAB = LABS[NUMBER]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="12 submissions where there are 60, and 30 mixed ones")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    few, many, mix = (3, 12, 30) if options.quick else (3, 60, 1000)
    solved = (1, 20) if options.quick else (1, 20, 200, 1000)
    print(f"{platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, Python {platform.python_version()}")
    with tempfile.TemporaryDirectory() as place:
        rows = {**_peers(Path(place), few), **_ours(Path(place), many), **_solved(Path(place), solved)}
        rows |= _mixed(Path(place), mix)
    _tell(rows, min(_measured(1, ["-c", "import sympy"], cwd=ROOT)["seconds"] for _ in range(5)))
    if options.json:
        Path(options.json).write_text(json.dumps(rows, indent=1), "utf-8")


def _tell(rows, sympy):
    """Print a line for each, with the ratio to the faster of the two others where the answers are the same."""
    peer = min((row for name, row in rows.items() if not name.startswith("hapticlab")), key=lambda row: row["seconds"])
    print(f"import sympy: {sympy:.3f} s")
    print(f"\n{'':42} {'submissions':>11} {'s in all':>9} {'sympys':>7} {'s each':>8} {'ratio':>6} {'processor s each':>17}")
    for name, row in rows.items():
        row["sympys"] = row["seconds"] * row["number"] / sympy
        if row["lab"] == NUMBER:
            row["faster"] = peer["seconds"] / row["seconds"]
        faster, total = f"{row['faster']:.1f}" if "faster" in row else "", row["seconds"] * row["number"]
        figures = f"{total:9.2f} {row['sympys']:7.1f} {row['seconds']:8.3f} {faster:>6} {row['processor']:17.3f}"
        print(f"{name:42} {row['number']:11} {figures}")


def _measured(number, *commands, cwd, codes=(0,), lab=NUMBER):
    """Run commands one after another; return wall clock and processor time for each of so many submissions [s]."""
    used, begun = _processor(), time.perf_counter()
    for command in commands:
        with start(sys.executable, *command, cwd=cwd) as process:
            said = process.communicate()
        if process.returncode not in codes:
            raise RuntimeError(f"{' '.join(command)}\n{said[0][-2000:]}\n{said[1][-2000:]}")
    wall = time.perf_counter() - begun
    return {"lab": lab, "number": number, "seconds": wall / number, "processor": (_processor() - used) / number}


def _processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _answered(notebook, number):
    """Return the notebook as the student of that number hands it in."""
    return (handed_in(notebook, LAB), handed_in(notebook, LAB, WRONG[NUMBER]), notebook)[number % 3]


def _peers(place, number):
    for system in ("nbgrader", "otter"):
        assign = ["-m", "hapticlab", "assign", str(place / system), "--for", system, "--lab", NUMBER]
        _measured(1, [*assign, "--instructor", str(INSTRUCTOR)], cwd=ROOT)
    course = place / "nbgrader"
    _measured(1, ["-m", "nbgrader", "generate_assignment", LAB.name, "--create"], cwd=course)
    released = read(course / "release" / LAB.name / LAB.notebook.name)
    for student in range(number):
        folder = course / "submitted" / f"s{student}" / LAB.name
        folder.mkdir(parents=True)
        write(folder / LAB.notebook.name, _answered(released, student))
    rows = {"nbgrader autograde": _measured(number, ["-m", "nbgrader", "autograde", LAB.name, "--create"], cwd=course)}
    made = place / "otter" / LAB.name
    (archive,) = (made / "autograder").glob("*.zip")
    commands = []
    for student in range(number):
        folder = place / "otter" / f"s{student}"
        folder.mkdir()
        write(folder / LAB.notebook.name, _answered(read(made / "student" / LAB.notebook.name), student))
        commands.append(["-m", "otter", "run", str(folder / LAB.notebook.name), "-a", str(archive), "-o", str(folder)])
    return {**rows, "otter run": _measured(number, *commands, cwd=place)}


def _ours(place, number):
    """Grade the same answers as the others do."""
    submissions = place / "the same"
    submissions.mkdir()
    for student in range(number):
        write(submissions / f"s{student}.ipynb", _answered(read(LAB.notebook), student))
    return _graded(submissions, number, "the same answers")


def _solved(place, numbers):
    """Grade solved notebooks."""
    rows, solved = {}, handed_in(read(LAB.notebook), LAB)
    for number in numbers:
        submissions = place / f"{number} solved"
        submissions.mkdir()
        for student in range(number):
            write(submissions / f"s{student}.ipynb", solved)
        rows |= _graded(submissions, number, f"{number} solved")
    return rows


def _graded(submissions, number, name):
    rows = {}
    for workers in (1, 2):
        command = ["-m", "hapticlab", "grade", str(submissions), "--lab", NUMBER, "--instructor", str(INSTRUCTOR)]
        output = ["--format", "json", "-o", f"{submissions} by {workers}.json", "--workers", str(workers)]
        command += ["--sandbox", "namespaces"]
        row = _measured(number, [*command, *output], cwd=ROOT, lab=NUMBER if name.startswith("the") else "02, solved")
        rows[f"hapticlab grade, {workers} worker{'s' * (workers > 1)}, {name}"] = row
    return rows


def _mixed(place, number):
    """Grade a class with attackers, of whom some wait for their limits."""
    with Arena(place / "arena", mixed(number)) as arena:
        command = ["-m", "hapticlab", "grade", str(arena.submissions), "--lab", str(arena.lab), "--timeout", f"{SECONDS:g}"]
        command += ["--instructor", str(arena.answers.parent), "--sandbox", "namespaces"]
        output = ["--format", "json", "-o", str(place / "mixed.json"), "--workers", "2"]
        row = _measured(number, [*command, *output], cwd=ROOT, codes=(0, 1), lab="42")
    return {f"hapticlab grade, 2 workers, {number} mixed": row}


if __name__ == "__main__":
    main()
