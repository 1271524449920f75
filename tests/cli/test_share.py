"""hapticlab share writes a scene file as one page, with what the command line sets."""

import json
import re

import pytest

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
