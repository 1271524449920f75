"""A lab of ten points whose cases run in no time: what attackers and honest students hand in."""

import json

#: exercise to points, in the order of the lab
POINTS = {"force": 2, "energy": 2, "forces": 2, "wall": 2, "stiffness": 1, "why": 1}

CHECKS = '''"""Public checks of lab 42."""

from hapticlab.course.exercise import Case, Exercise, Lab

LAB = Lab(
    number="42",
    title="A small wall",
    minutes=10,
    exercises=(
        Exercise("guess", kind="prediction", asks="how stiff a wall can be [N/m]"),
        Exercise(
            "force",
            points=2,
            asks="the force [N] of a wall at x_o = 0.01 m",
            cases=(
                Case({"x": 0.012, "k": 200.0}, 0.4, unit="N", slips={2.4: "You forgot x_o."}),
                Case({"x": 0.008, "k": 200.0}, 0.0, unit="N"),
            ),
            hint="Outside there is no force.",
        ),
        Exercise(
            "energy",
            points=2,
            asks="the work [J] of the handle on a spring k over positions x",
            cases=(Case({"x": [0.0, 0.001, 0.003], "k": 1000.0}, 0.002, unit="J"),),
        ),
        Exercise(
            "forces",
            points=2,
            asks="the force [N] of a spring at each position",
            cases=(Case({"x": [0.0, 0.25, -0.5], "k": 8.0}, [0.0, 2.0, -4.0], unit="N"),),
        ),
        Exercise(
            "wall",
            kind="scene",
            points=2,
            asks="a wall at x_o",
            cases=(Case({"x": [0.0, 0.012, 0.02], "values": {"k": 100.0, "x_o": 0.01}}, [0.0, 0.2, 1.0], unit="N"),),
        ),
        Exercise("stiffness", kind="value", points=1, asks="the stiffness [N/m]", cases=(Case({}, 731.25, unit="N/m"),)),
        Exercise(
            "why",
            kind="choice",
            points=1,
            asks="why it chatters",
            options={"a": "the motor", "b": "the held force", "c": "the sensor"},
            cases=(Case({}, "b"),),
        ),
        Exercise("discussion", kind="text", asks="what you saw", least_words=3),
    ),
)
'''

HIDDEN = '''"""Hidden givens of lab 42."""


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    some = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    track = lambda: list(random.uniform(-0.02, 0.02, 5))  # noqa: E731
    return {
        "force": lambda: [{"x": some(0.011, 0.03), "k": some(50, 900)}, {"x": some(-0.01, 0.009), "k": some(50, 900)}],
        "energy": lambda: [{"x": track(), "k": some(50, 900)} for _ in range(2)],
        "forces": lambda: [{"x": track(), "k": some(50, 900)} for _ in range(2)],
        "wall": lambda: [{"x": track(), "values": {"k": some(50, 900), "x_o": some(0.001, 0.01)}}],
    }
'''

#: the answers, cell by cell; what an exercise needs stands in its own cell, as in the labs
HONEST = {
    "imports": "import math\nimport numpy as np\nimport hapticlab as hl\nfrom hapticlab import n, x",
    "guess": 'guess = "1000 N/m"',
    "force": "def force(x, k):\n    return k * (x - 0.01) if x >= 0.01 else 0.0",
    "energy": "def energy(x, k):\n    return np.sum(k * x[:-1] * np.diff(x))",
    "forces": "def forces(x, k):\n    return k * x",
    "wall": 'k, x_o = hl.parameters("k x_o", units="N/m m")\nwall = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))',
    "stiffness": "stiffness = 731.25",
    "why": 'why = "b"',
    "discussion": 'discussion = "The held force pushes too long."',
    "check": 'hl.check("42.force", force)\nhl.check("42.wall", wall).require()',
}
#: the lab as it is handed out
OPEN = {
    **HONEST,
    "guess": 'guess = ""',
    "force": 'def force(x, k):\n    raise NotImplementedError("write me")',
    "energy": 'def energy(x, k):\n    raise NotImplementedError("write me")',
    "forces": 'def forces(x, k):\n    raise NotImplementedError("write me")',
    "wall": 'k, x_o = hl.parameters("k x_o", units="N/m m")\nwall = None',
    "stiffness": "stiffness = None",
    "why": 'why = ""',
    "discussion": 'discussion = ""',
}
SOLUTION = "\n\n\n".join(HONEST[name] for name in ("imports", *POINTS)) + "\n"


def notebook(cells):
    """Return the bytes of a notebook of code cells."""
    made = [
        {"cell_type": "code", "execution_count": None, "id": f"c{i}", "metadata": {}, "outputs": [], "source": source}
        for i, source in enumerate(cells)
    ]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return json.dumps({"cells": made, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}).encode()


def write_lab(place):
    """Write the lab and its instructor's folder; return both."""
    lab, answers = place / "labs" / "42_small_wall", place / "instructor" / "42_small_wall"
    for folder in (lab, answers):
        folder.mkdir(parents=True)
    (lab / "checks.py").write_text(CHECKS, "utf-8")
    (lab / "42_small_wall.ipynb").write_bytes(notebook(OPEN.values()))
    (answers / "solution.py").write_text(SOLUTION, "utf-8")
    (answers / "hidden.py").write_text(HIDDEN, "utf-8")
    return lab, answers
