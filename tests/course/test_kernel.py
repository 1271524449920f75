"""hl.check in a real kernel, as a notebook shows it: one card and nothing else, whatever the answer does."""

import json

import pytest

CELLS = [
    "import hapticlab as hl, sys",
    "def handle_position(counts, left, right, travel):\n    print('seen')\n\n    return counts - nothing",
    "hl.check('00.handle_position', handle_position)",
    "def handle_position(counts, left, right, travel):\n    sys.exit('over')",
    "found = hl.check('00.handle_position', handle_position)\nfound",
    "hl.check('00.which_way', 'a'); print(found.passed)",
    "hl.check('00.which_way', 'c').require()",
    "found.require()",
]


@pytest.mark.wide
def test_a_check_shows_a_card_alone_and_a_kernel_lives_on(tmp_path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    root = __file__.rsplit("tests", 1)[0]
    monkeypatch.setenv("PYTHONPATH", root)
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in CELLS])
    place = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=120, startup_timeout=120, allow_errors=True, resources=place).execute()
    kinds = [{output.output_type for output in cell.outputs} for cell in notebook.cells]
    card = "display_data"
    assert kinds == [set(), set(), {card}, set(), {card}, {card, "stream"}, {card}, {"error"}]
    text = ["".join(o.data["text/plain"] for o in cell.outputs if o.output_type == card) for cell in notebook.cells]
    assert "  printed: seen" in text[2]
    assert "it raises NameError in line 4 of its cell: name 'nothing' is not defined" in text[2]
    assert "it raises SystemExit in line 2 of its cell: over" in text[4]
    assert notebook.cells[5].outputs[-1].text == "False\n"
    assert text[6].startswith("00.which_way: right in the public cases (worth 1 point)\n  right: c\n")
    assert text[6].endswith("this lab: 1 of 7 exercises right in the public cases (counts for no mark)\n  next: sign_evidence")
    assert json.loads((tmp_path / ".hapticlab-progress.json").read_text("utf-8")) == {"00": ["which_way"]}
    for cell in notebook.cells[:-1]:
        assert not [o for o in cell.outputs if o.output_type == card and "<script" in o.data["text/html"]]
    (error,) = notebook.cells[-1].outputs
    assert error.ename == "AssertionError" and error.evalue.startswith("00.handle_position: not right yet (worth 2 points)")
