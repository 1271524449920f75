"""Every lab: well formed; untouched it runs and earns nothing; wrong answers earn nothing and are taught.

Beside labs/NN_name stand the answers in tests/instructor/NN_name, where wrong.py holds wrong ones that students write.
"""

import ast
import json
import re
import runpy
import shutil
from pathlib import Path

import pytest
import sympy as sp

from hapticlab.course.check import checked
from hapticlab.course.exercise import JUDGED, Exercise
from hapticlab.course.judge import judge
from hapticlab.course.labs import find_labs
from hapticlab.course.marks import SOLUTION, WRONG, hidden_cases, instructor_names, marks
from hapticlab.course.notebook import code_of, read

ROOT = Path(__file__).parents[2]
LABS, INSTRUCTOR = find_labs(ROOT / "labs"), ROOT / "tests" / "instructor"
LAST = """
import json as _json
from hapticlab.course.labs import load_lab as _load_lab
from hapticlab.course.marks import marks as _marks
print(_json.dumps([[m.exercise, m.earned, m.right] for m in _marks(_load_lab("checks.py"), globals())]))
"""

pytestmark = pytest.mark.parametrize("folder", LABS, ids=[folder.name for folder in LABS])


def test_lab_is_well_formed(folder):
    nbformat = pytest.importorskip("nbformat")
    lab, notebook = folder.lab(), read(folder.notebook)
    nbformat.validate(nbformat.from_dict(notebook))
    assert lab.number == folder.number
    assert notebook["metadata"]["kernelspec"]["name"] == "python3"
    assert [c for c in notebook["cells"] if c.get("outputs") or c.get("execution_count")] == []
    assert [c["metadata"] for c in notebook["cells"] if c["metadata"]] == []
    text = "\n".join("".join(c["source"]) for c in notebook["cells"] if c["cell_type"] == "markdown")
    plain = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    assert re.findall(r"^# (?:Lab )?\d+", plain, re.M) and len(re.findall(r"^# ", plain, re.M)) == 1
    assert f"{lab.minutes} min" in plain
    code = "\n".join(code_of(notebook))
    assert not re.search(r"^\s*[%!]", code, re.M), "magics and shell lines run in Jupyter alone"
    unchecked = [e.name for e in lab.exercises if f'check("{lab.number}.{e.name}"' not in code]
    assert not unchecked
    checks = ast.parse((folder.path / "checks.py").read_text("utf-8"))
    assert [node.module for node in ast.walk(checks) if isinstance(node, ast.Import | ast.ImportFrom)] == [Exercise.__module__]
    assert not [node for node in ast.walk(checks) if isinstance(node, ast.FunctionDef | ast.Lambda)], "numbers, no formulas"
    judged = [e for e in lab.exercises if e.judged]
    assert lab.points == 10
    assert 4 <= len(judged) <= 8
    assert all(e.points > 0 and e.asks for e in judged)
    assert all(e.matters.endswith(".") and len(e.matters) <= 130 for e in judged), "one sentence or two on why it matters"
    assert {e.kind for e in lab.exercises} > {"prediction", "text"}, "predict first; a text is handed in"


@pytest.mark.wide
@pytest.mark.long
def test_untouched_lab_runs_and_earns_nothing(folder, tmp_path, monkeypatch, record_property):
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    shutil.copytree(folder.path, tmp_path / folder.name)
    notebook = nbformat.read(folder.notebook, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(LAST))
    notebook.cells.append(nbformat.v4.new_code_cell("import time as _time; print(_time.process_time())"))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    place = {"metadata": {"path": str(tmp_path / folder.name)}}
    nbclient.NotebookClient(notebook, timeout=120, startup_timeout=120, resources=place).execute()
    earned = json.loads(printed(notebook.cells[-2]))
    assert earned == [[e.name, 0, 0] for e in folder.lab().exercises if e.judged]
    said = "".join(printed(cell) for cell in notebook.cells)
    assert said.count("not answered yet") >= len(earned)
    outputs = [o.get("data", {}) for c in notebook.cells if c.cell_type == "code" for o in c.outputs]
    for output in (o.get("text/html", "") for o in outputs if "image/png" in o):
        pictures = re.findall("<(?:img|svg)[ >][^>]*", output)
        assert pictures and all(re.match('<img .*alt="[^"]|<svg role="img" aria-label="[^"]', one) for one in pictures), output[
            :300
        ]
    seconds = float(printed(notebook.cells[-1]))
    record_property("seconds", seconds)


def printed(cell):
    """Return what a cell printed, which a kernel sends in pieces, and its cards in text."""
    outputs = cell.get("outputs", ())
    cards = [o["data"].get("text/plain", "") for o in outputs if o.get("output_type") == "display_data"]
    return "".join([*(o.get("text", "") for o in outputs if o.get("name") == "stdout"), *cards])


@pytest.mark.always("00_*", "02_*", "04_*", "05_*", "07_*", "08_*", "09_*", "10_*")
def test_wrong_answers_earn_nothing_and_are_taught(folder):
    lab = folder.lab()
    hidden = hidden_cases(lab, INSTRUCTOR / folder.name)
    right = instructor_names(INSTRUCTOR / folder.name / SOLUTION)
    for exercise in lab.exercises:
        for case in exercise.cases:
            for wrong, sentence in case.slips:
                value = list(wrong) if isinstance(wrong, tuple) else wrong
                if isinstance(wrong, dict):
                    value = {**(right[exercise.name] if exercise.kind == "design" else case.expected), **wrong}
                found = judge(exercise, case, value)
                assert not found.right and found.words.endswith(sentence), (exercise.name, wrong, found.words)
    for name, kind in ((e.name, e.kind) for e in lab.exercises if e.kind in JUDGED):
        for wrong in wrong_answers(lab.exercise(name), right[name]):
            (found,) = (m for m in marks(lab, {name: wrong}, hidden) if m.exercise == name)
            assert found.earned == 0, (name, kind)


@pytest.mark.always("00_*", "02_*", "04_*", "05_*", "07_*", "08_*", "09_*", "10_*")
def test_what_students_write_is_taught(folder):
    lab, hidden = folder.lab(), hidden_cases(folder.lab(), INSTRUCTOR / folder.name)
    tried = written_wrong(folder)["WRONG"]
    for name, answer in tried:
        exercise = lab.exercise(name)
        sentences = [sentence for case in exercise.cases for _, sentence in case.slips]
        text = checked(f"{lab.number}.{name}", exercise, answer).text
        assert any(sentence in text for sentence in sentences), text
        assert {m.earned for m in marks(lab, {name: answer}, hidden)} == {0}
    assert {name for name, _ in tried} == {e.name for e in lab.exercises if e.judged}


def test_what_goes_wrong_in_any_lab_is_taught_as_well(folder):
    tried = written_wrong(folder).get("ANYWHERE", [])
    lab, hidden = folder.lab(), hidden_cases(folder.lab(), INSTRUCTOR / folder.name) if tried else {}
    for name, answer, sentence in tried:
        assert sentence in checked(f"{lab.number}.{name}", lab.exercise(name), answer).text
        assert {m.earned for m in marks(lab, {name: answer}, hidden)} == {0}


def written_wrong(folder):
    return runpy.run_path(str(INSTRUCTOR / folder.name / WRONG))


def wrong_answers(exercise, right):
    """Yield answers that any exercise refuses; of a function also one that knows the public cases by heart."""
    yield from (None, ..., "", "no", float("nan"), [], {}, object())
    if exercise.kind == "function":
        known = {repr(sorted(case.given.items())): case.expected for case in exercise.cases}
        yield lambda **given: known.get(repr(sorted((k, getattr(v, "tolist", lambda v=v: v)()) for k, v in given.items())), 0.0)
        yield lambda **given: _scaled(right(**given), -1.0)
        yield lambda **given: _scaled(right(**given), 1e3)
        yield lambda **given: _scaled(right(**given), float("nan"))
    elif exercise.kind == "scene":
        scene = right if hasattr(right, "force") else right()
        yield type(scene)(force=-scene.force, eom=scene.eom, watch=scene.watch, values=scene.values)
    elif exercise.kind == "expression":
        yield sp.Eq(right.lhs, -right.rhs) if isinstance(right, sp.Eq) else -right
    elif exercise.kind == "plot":
        yield lambda **given: _relabelled(right(**given), "x [m]")
        yield lambda **given: _relabelled(right(**given), "x")


def _relabelled(figure, label):
    for axes in figure.axes:
        axes.set(xlabel=label, ylabel=label)
    return figure


def _scaled(value, factor):
    if isinstance(value, dict):
        return {name: _scaled(part, factor) for name, part in value.items()}
    return value if isinstance(value, str) else not value if isinstance(value, bool) else value * factor
