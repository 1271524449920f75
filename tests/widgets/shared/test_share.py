"""A shared file is one page that asks for nothing, runs no script but its own, and tells nothing of who wrote it."""

import base64
import getpass
import hashlib
import json
import math
import re
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError, ParameterError
from hapticlab.widgets.shared.document import VIEW_SCRIPTS, read
from hapticlab.widgets.shared.page import PAGE_SCRIPTS

PADDLE = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)> \" ' & <!-- <style>"


def labelled(axes, *, x):
    """A picture whose label is hostile."""
    axes.set(xlim=(-0.05, 0.05), ylim=(-0.01, 0.01))
    axes.text(x, 0.0, HOSTILE)


def unrecordable(axes, *, x):
    """A picture that a page cannot draw: it needs x as a number of Python."""
    labelled(axes, x=math.sin(x))


class Elements(HTMLParser):
    """The elements of a page with their attributes, and the text of each script."""

    def __init__(self, text):
        super().__init__()
        self.found, self.scripts, self.title, self._in = [], [], "", ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
        self._in = tag
        if tag == "script":
            self.scripts.append("")

    def handle_data(self, data):
        if self._in == "script":
            self.scripts[-1] += data
        if self._in == "title":
            self.title += data

    def handle_endtag(self, tag):
        self._in = ""


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    """A page of a scene with a hostile name and label; names of parameters and channels are words, which Python checks."""
    wall = hl.wall()(k=300, x_o=0.01)
    scene = hl.Scene(force=wall.force, name=HOSTILE)(**wall.values)
    path = tmp_path_factory.mktemp("shared") / "page.html"
    shared = hl.share(scene, PADDLE, path, picture=labelled)
    return shared, path.read_text("utf-8")


def test_no_name_ends_an_element_or_begins_one(hostile):
    _, text = hostile
    page = Elements(text)
    assert len(page.scripts) == 2 and "alert(1)" not in page.scripts[1]
    assert not [tag for tag, _ in page.found if tag == "img"]
    assert page.title == HOSTILE
    told = json.loads(page.scripts[0])
    assert told["scene"] == HOSTILE == told["picture"]["items"][0][2]["words"]


def test_a_page_runs_its_own_script_alone_and_asks_for_nothing(hostile):
    _, text = hostile
    page = Elements(text)
    policy = next(each["content"] for tag, each in page.found if each.get("http-equiv") == "Content-Security-Policy")
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    digest = base64.b64encode(hashlib.sha256(page.scripts[1].encode()).digest()).decode()
    assert rules["default-src"] == "'none'" and rules["script-src"] == f"'sha256-{digest}' 'wasm-unsafe-eval'"
    for _, attributes in page.found:
        assert not [name for name in attributes if name.startswith("on") or name in ("style", "src")]
    assert not re.search(
        r"\beval\(|new Function|innerHTML|document\.write|fetch\(|XMLHttpRequest|navigator\.serial", page.scripts[1]
    )
    assert not re.search(r"(?<!xmlns=\")https?://", page.scripts[1].replace("http://www.w3.org/", ""))


def test_a_page_says_which_hapticlab_made_it_and_not_who(hostile):
    shared, text = hostile
    assert f"hapticlab {hl.__version__}. Copyright" in text and "BSD 3-Clause" in text
    assert str(shared.path.parent) not in text and str(Path.home()) not in text
    assert len(getpass.getuser()) < 5 or getpass.getuser() not in text
    assert shared.bytes == len(text.encode()) == shared.path.stat().st_size < 500_000


def test_a_record_of_a_page_will_know_how_late_the_paddle_is(tmp_path):
    late = hl.SimulatedPaddle(m=0.05, b=0.1, T=2e-3, delay=4e-4, sensor_delay=7e-4, hand=hl.Hand("pinch"))
    path = hl.share(hl.wall()(k=300, x_o=0.01), late, tmp_path / "late.html").path
    told = json.loads(Elements(path.read_text("utf-8")).scripts[0])
    assert (told["T"], told["delay"], told["sensor_delay"]) == (2e-3, 4e-4, 7e-4)


def test_the_same_scene_is_the_same_file(tmp_path):
    texts = [hl.share(hl.wall()(k=300, x_o=0.01), PADDLE, tmp_path / name).path.read_bytes() for name in ("a.html", "b.html")]
    assert texts[0] == texts[1]


def test_a_file_without_a_path_has_the_name_of_its_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shared = hl.share(hl.wall()(k=300, x_o=0.01), PADDLE)
    assert shared.path.name == "zoh_wall.html" and "149" not in shared.scene
    assert 'href="zoh_wall.html"' in shared._repr_html_() and "kB" in str(shared)


def test_every_script_of_a_page_is_in_it_once():
    assert len({*VIEW_SCRIPTS, *PAGE_SCRIPTS}) == len(VIEW_SCRIPTS) + len(PAGE_SCRIPTS)
    assert "kernel.js" not in VIEW_SCRIPTS and not [name for name in PAGE_SCRIPTS if "board" in name]


def test_no_name_means_two_things_in_a_page():
    """All scripts share one scope, where a second function of a name would replace the first without a word."""
    names = re.findall(r"^(?:async )?(?:function\*?|class|const|let) (\w+)", read((*VIEW_SCRIPTS, *PAGE_SCRIPTS)), re.M)
    assert len(names) > 200 and [name for name, many in Counter(names).items() if many > 1] == []


def test_what_cannot_be_shared_is_refused(tmp_path):
    wall = hl.wall()(k=300, x_o=0.01)
    with pytest.raises(PaddleError, match="a shared file runs on a simulated paddle"):
        hl.share(wall, "hapkit", tmp_path / "a.html")
    with pytest.raises(PaddleError, match="time_scale"):
        hl.share(wall, PADDLE, tmp_path / "a.html", time_scale=0)
    with pytest.raises(ParameterError, match="sliders"):
        hl.share(wall, PADDLE, tmp_path / "a.html", sliders={"z": (0, 1)})
    with pytest.raises(OSError, match="nowhere"):
        hl.share(wall, PADDLE, tmp_path / "nowhere" / "a.html")
    with pytest.raises(ParameterError, match="k"):
        hl.share(hl.wall(), PADDLE, tmp_path / "a.html")
    with pytest.raises(AnalysisError, match="NumPy"):
        hl.share(wall, PADDLE, tmp_path / "a.html", picture=unrecordable)
    assert not list(tmp_path.iterdir())
