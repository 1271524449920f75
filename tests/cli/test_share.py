"""hapticlab share writes a scene file as one page, with what the command line sets."""

import io
import json
import re

import pytest

import hapticlab as hl
from hapticlab.cli import main

SCENE = "import hapticlab as hl\nscene = hl.wall()(k=200, x_o='10 mm')\n"


@pytest.fixture
def scene_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "soft.py").write_text(SCENE)
    return tmp_path


def data_of(path):
    """What the page computes with."""
    return json.loads(re.search(r'<script type="application/json" id="hl-data">(.*?)</script>', path.read_text("utf-8"))[1])


def test_share_writes_the_scene_with_what_was_set(scene_file, capsys):
    assert main.main(["share", "soft.py", "--set", "k=0.4 N/mm", "--T", "5e-4", "--let-go"]) == 0
    said = capsys.readouterr().out
    assert "k = 400" in said and "T = 0.0005 s" in said and "soft.html" in said
    told = data_of(scene_file / "soft.html")
    assert told["T"] == 5e-4 and told["about"]["let_go"]
    assert {each["name"]: each["value"] for each in told["parameters"]} == {"B": 0.0, "k": 400.0, "x_o": 0.01}


def test_share_says_as_json_what_it_wrote(scene_file, capsys):
    assert main.main(["share", "soft.py", "--json", "-o", "other.html"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["bytes"] == (scene_file / "other.html").stat().st_size
    assert said["parameters"]["k"] == 200 and said["units"]["k"] == "N/m"


def test_share_refuses_what_cannot_be_set(scene_file, capsys):
    with pytest.raises(SystemExit):
        main.main(["share", "soft.py", "--set", "K=5"])
    assert "K" in capsys.readouterr().err
    assert not list(scene_file.glob("*.html"))


def test_a_scene_file_is_not_replaced(scene_file, capsys):
    assert main.main(["share", "soft.py", "-o", "soft.py"]) == 1
    assert "path = 'soft.py'; a browser opens a file that ends in .html. Give 'soft.html'" in capsys.readouterr().err
    assert (scene_file / "soft.py").read_text() == SCENE


def test_readers_copy_the_text_of_the_file_with_what_was_set(scene_file, capsys):
    assert main.main(["share", "soft.py", "--set", "k=0.4 N/mm", "--set", "x_o=0.02", "--method", "euler"]) == 0
    code = "".join(data_of(scene_file / "soft.html")["code"])
    assert code.startswith(SCENE) and "--method euler" in code
    names = {}
    exec(code, names)
    assert names["scene"] == hl.wall()(k=400, x_o=0.02)


@pytest.mark.parametrize(
    ("text", "answer", "given", "shown"),
    [
        (SCENE, "", [], True),
        (SCENE, "n", [], False),
        (SCENE, "n", ["--code"], True),
        (SCENE, "y", ["--no-code"], False),
        (SCENE + "data = '/home/ada/lab'\n", "", [], False),
        (SCENE + "data = '/home/ada/lab'\n", "y", [], True),
    ],
)
def test_readers_copy_the_text_unless_it_is_refused_or_private(scene_file, monkeypatch, text, answer, given, shown):
    asked = io.StringIO(f"{answer}\n")
    monkeypatch.setattr(asked, "isatty", lambda: True)
    monkeypatch.setattr("sys.stdin", asked)
    (scene_file / "soft.py").write_bytes(f"# coding: latin-1\n# Körper\n{text}".encode("latin-1"))
    assert main.main(["share", "soft.py", *given]) == 0
    assert (data_of(scene_file / "soft.html")["code"] is not None) == shown
    assert ("ada" in (scene_file / "soft.html").read_text()) == (shown and "ada" in text)
