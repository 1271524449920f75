"""Every lab, solved, on four paddles: it earns everything, and what its text says holds or the lab prints why it does not.

A notebook names the paddle in use once, ``my_paddle = hl.devices.profile("hapkit")``, and here that name is exchanged.
``claims.py`` beside the answers lists the statements that a change of the paddle could break::

    CLAIMS = [("words of the notebook's text", holds, "words that are printed where it does not hold")]

``holds`` takes the names that the solved notebook has at its end, as attributes, and ``printed``, all that it printed. The
last words are empty where a statement must hold on every paddle. On the nominal paddle all statements hold.
"""

import json
import re
import runpy
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from reading_time import text_of

from hapticlab.course.instructor import mark_notebook, solved_notebook
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

ROOT = Path(__file__).parents[2]
ANSWERS = ROOT / "tests" / "instructor"
FOLDERS = {folder.name: folder for folder in find_labs(ROOT / "labs")}
NOMINAL, OTHERS = "hapkit", ("hapkit_rough", "hapkit_coarse", "hapkit_slow")
IN_USE = f'my_paddle = hl.devices.profile("{NOMINAL}")'
#: paddles for which a lab may promise nothing, but whose cells all run: without an encoder and a force limit, with counts of
#: 0.74 mm, with a weak motor, and without damping
UNUSUAL = {"eth": "eth", "longhorn": "longhorn", "motor_shield": "motor_shield", "undamped": f'{NOMINAL}").at(b="0 N*s/m'}
#: fewer statements about the paddle than this are not a lab
FEWEST = 5


def on_paddles():
    """Yield each lab on each paddle: on the nominal one and on one other for every change, on all of them at times."""
    for number, name in enumerate(FOLDERS):
        for paddle in (NOMINAL, *OTHERS):
            often = paddle in (NOMINAL, OTHERS[number % len(OTHERS)])
            yield pytest.param(name, paddle, id=f"{name}-{paddle}", marks=[] if often else [pytest.mark.slow])


@pytest.mark.always("01_motion_to_force-hapkit", "02_virtual_wall-hapkit_slow")
@pytest.mark.parametrize(("name", "paddle"), list(on_paddles()))
def test_solved_lab_earns_everything_and_says_what_is_true(name, paddle, record_property):
    folder, began = FOLDERS[name], time.process_time()
    found = mark_notebook(folder, _with_paddle(solved_notebook(folder, ANSWERS / name), paddle), ANSWERS / name)
    record_property("seconds", time.process_time() - began)
    assert found.problems == []
    assert [m for m in found.marks if m.earned != m.points] == []
    assert found.earned == folder.lab().points
    lab = SimpleNamespace(**{**found.names, "printed": found.printed})
    for words, holds, unless in claims(name):
        if not holds(lab):
            assert unless and paddle != NOMINAL, f"on {paddle} this is not true: {words}"
            assert unless in found.printed, f"on {paddle} this is not true, and the lab does not say why: {words}"


def test_an_untouched_lab_earns_nothing():
    """In this process; in a kernel of its own each lab does so in test_labs.py."""
    folder = FOLDERS["01_motion_to_force"]
    found = mark_notebook(folder, read(folder.notebook), ANSWERS / folder.name)
    assert found.problems == [] and found.earned == 0
    assert found.printed.count("not answered yet") >= len(found.marks) > 3


def on_unusual_paddles():
    """Yield each lab on each of them at times, and one lab on one of them always."""
    for name in FOLDERS:
        for paddle in UNUSUAL if name[:2] not in ("04", "14") else list(UNUSUAL)[:-1]:  # they are about damping
            often = (name[:2], paddle) == ("01", "eth")
            yield pytest.param(name, paddle, id=f"{name}-{paddle}", marks=[] if often else [pytest.mark.slow])


@pytest.mark.parametrize(("name", "paddle"), list(on_unusual_paddles()))
def test_cells_run_on_unusual_paddles(name, paddle):
    folder = FOLDERS[name]
    found = mark_notebook(folder, _with_paddle(solved_notebook(folder, ANSWERS / name), UNUSUAL[paddle]), ANSWERS / name)
    assert found.problems == []
    assert found.earned == folder.lab().points
    assert not re.search(r"\b(nan|inf) (N|mm|%)", found.printed)


@pytest.mark.parametrize("name", FOLDERS)
def test_claims_stand_in_the_text(name):
    notebook = read(FOLDERS[name].notebook)
    text = " ".join(text_of(notebook).split())
    assert [words for words, _, _ in claims(name) if words not in text] == []
    assert len(claims(name)) >= FEWEST
    named = [cell for cell in code_of(notebook) if re.search(r"""["'](?:sim://)?hapkit""", cell)]
    assert len(named) == 1 and named[0].count(IN_USE) == 1, "the paddle in use is named once"


def claims(name):
    """Return the statements of a lab about the paddle in use."""
    return runpy.run_path(str(ANSWERS / name / "claims.py"))["CLAIMS"]


def _with_paddle(notebook, paddle):
    """Return the notebook with another paddle in use."""
    if paddle == NOMINAL:
        return notebook
    text = json.dumps(notebook)
    named = json.dumps(IN_USE)[1:-1]
    assert text.count(named) == 1
    return json.loads(text.replace(named, json.dumps(IN_USE.replace(NOMINAL, paddle))[1:-1]))
