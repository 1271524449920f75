"""The same in a real kernel, as a notebook keeps it."""

import re

import pytest
from mistakes import BEFORE

CELLS = [
    BEFORE,
    "hl.Scene(\n    force=k*x(n) + x(n))",
    "%tb",
    "if x(n) >= x_o:\n    pass",
    "hl.wall()(k=300, x_o=10);",
    "{}['a']",
]


@pytest.mark.wide
def test_a_notebook_keeps_the_own_line_and_the_sentence(tmp_path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    monkeypatch.setenv("PYTHONPATH", __file__.rsplit("tests", 1)[0])
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in CELLS])
    place = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=120, startup_timeout=120, allow_errors=True, resources=place).execute()
    kept = [
        [re.sub(r"\x1b\[[0-9;]*m", "", "\n".join(o.get("traceback", [o.get("text", "")]))) for o in c.outputs]
        for c in notebook.cells
    ]
    assert kept[0] == []
    (ours,), (whole,), (foreign,), (warned,), (other,) = kept[1:]
    assert ours == (
        "UnitsError in Cell In[2], line 1\n    hl.Scene(\n        force=k*x(n) + x(n))\n\n"
        "force: k*x(n) is in N but x(n) is in m. Correct one of them, or the declared unit of a parameter in it.\n\n"
        "%tb shows the whole traceback."
    )
    assert "Traceback (most recent call last)" in whole and "in agree(" in whole
    assert foreign.startswith("TypeError in Cell In[4], line 1\n    if x(n) >= x_o:\n\n`if` has to know at once")
    assert warned.startswith("Cell In[5]:1: UnusualValueWarning: x_o = 10 m: a paddle reaches about 0.1 m. If you mean 10 mm")
    assert other.startswith("-----") and "KeyError: 'a'" in other
