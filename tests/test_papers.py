"""The pages of docs/papers show what their code prints now: few cases always, the figures in CI, all cases by hand."""

import importlib.util
import re
from pathlib import Path

import pytest
from matplotlib.image import imread

_SPEC = importlib.util.spec_from_file_location("papers", Path(__file__).parent / "benchmarks" / "papers.py")
script = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(script)

every_page = pytest.mark.parametrize("name", script.PAGES)
PARTS = ["The claim", "In hapticlab", "How close", "Where the exact device differs", "Source"]
INDEX = (script.FOLDER / "README.md").read_text("utf-8")


@every_page
@pytest.mark.always("abbott_okamura_2005", "colgate_schenkel_1997", "diolaiti_2006")
def test_the_page_shows_what_its_code_prints(name):
    path = script.PAGES[name]
    assert script.run(path) == path.read_text("utf-8")


@every_page
@pytest.mark.wide
@pytest.mark.long
def test_the_figure_is_that_of_its_page(name, tmp_path):
    """Of this size, and the same to the eye: fonts differ by a pixel between releases of matplotlib."""
    path, drawn = script.PAGES[name], tmp_path / "drawn.png"
    assert script.run(path, figure=drawn) == path.read_text("utf-8")
    shown, drawn = imread(path.with_suffix(".png")), imread(drawn)
    assert shown.shape == drawn.shape
    assert abs(shown - drawn).mean() < 0.01


@every_page
@pytest.mark.slow
def test_the_page_holds_for_many_cases(name):
    path = script.PAGES[name]
    assert script.run(path, whole=True) == path.read_text("utf-8")


@every_page
def test_a_page_has_its_parts(name):
    path = script.PAGES[name]
    text = path.read_text("utf-8")
    assert re.findall("^## (.*)", text, re.M) == PARTS
    assert len(text.splitlines()) <= 140
    assert [line for line in text.splitlines() if len(line) > 132 and line[:1] not in "|!"] == []
    assert f"]({name}.png)" in text and path.with_suffix(".png").stat().st_size < 60_000
    assert script.LONG.search(text) and f"]({name}.md)" in INDEX


@pytest.mark.parametrize("path", [script.FOLDER / "README.md", *script.PAGES.values()])
def test_links_lead_somewhere(path):
    links = re.findall(r"\]\(([^)#]+)(?:#[\w-]*)?\)", path.read_text("utf-8"))
    assert [link for link in links if not path.parent.joinpath(link).exists()] == []
