"""hl.check in a real kernel, as a notebook shows it: text and nothing else, whatever the answer does."""

import pytest

CELLS = [
    "import hapticlab as hl, sys",
    "def handle_position(counts, left, right, travel):\n    print('seen')\n\n    return counts - nothing",
    "hl.check('00.handle_position', handle_position)",
    "def handle_position(counts, left, right, travel):\n    sys.exit('over')",
    "found = hl.check('00.handle_position', handle_position)\nfound",
    "hl.check('00.which_way', 'a'); print(found.passed)",
    "hl.check('00.which_way', 'b').require()",
    "found.require()",
]


def test_a_check_shows_text_alone_and_a_kernel_lives_on(tmp_path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    root = __file__.rsplit("tests", 1)[0]
    monkeypatch.setenv("PYTHONPATH", root)
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in CELLS])
    client = nbclient.NotebookClient(notebook, timeout=60, allow_errors=True, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    kinds = [[output.output_type for output in cell.outputs] for cell in notebook.cells]
    assert kinds == [[], [], ["stream"], [], ["stream"], ["stream"], ["stream"], ["error"]]
    text = [cell.outputs[0].get("text", "") for cell in notebook.cells if cell.outputs]
    assert "  printed: seen\n" in text[0]
    assert "it raises NameError in line 4 of its cell: name 'nothing' is not defined" in text[0]
    assert "it raises SystemExit in line 2 of its cell: over" in text[1]
    assert text[2].endswith("False\n")
    assert text[3] == "00.which_way: right (1 point)\n  right: b\n"
    error = notebook.cells[-1].outputs[0]
    assert error.ename == "AssertionError" and error.evalue.startswith("00.handle_position: not right yet (2 points)")
