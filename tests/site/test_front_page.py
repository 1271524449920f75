"""The first page: its links, and what it says."""

import re
from html.parser import HTMLParser
from importlib import import_module

import pytest

from hapticlab.course.labs import find_labs
from hapticlab.site.front_page import front_page
from hapticlab.site.pages import PAGES, Page

SCENE = Page("wall.html", "A wall & more", "Push it.", "site.none", scene=True)
PADDLE = Page("paddle.html", "A real paddle", "By a cable.", "site.none")


class Read(HTMLParser):
    """Links, ids and text of a page; every element that opens also closes."""

    def __init__(self, page):
        super().__init__()
        self.open, self.links, self.ids, self.said = [], {}, set(), ""
        self.feed(page)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids |= {given["id"]} if "id" in given else set()
        if tag not in ("meta", "link", "img", "br"):
            self.open.append((tag, given.get("href")))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, text):
        links = [href for tag, href in self.open if tag == "a"]
        if links:
            self.links[links[0]] = self.links.get(links[0], "") + text
        if not {tag for tag, _ in self.open} & {"style", "script"}:
            self.said += text


def page(**given):
    return Read(front_page(find_labs(), **({"local": 50e6, "wheels": 3e6, "pages": ()} | given)))


def test_each_lab_is_one_link_with_its_title_and_minutes_in_order():
    links = {href: words for href, words in page().links.items() if "path=" in href}
    folders = find_labs()
    assert [href.partition("path=")[2] for href in links] == [f"{one.name}/{one.notebook.name}" for one in folders]
    for folder, words in zip(folders, links.values(), strict=True):
        assert words == f"{folder.number}{folder.lab().title}{folder.lab().minutes} min"


def test_nothing_on_the_page_is_asked_of_another_address():
    assert not re.findall(
        r"(?:src|href)\s*=\s*[\"']?(?:https?:)?//", front_page(find_labs(), local=None, wheels=3e6, pages=(SCENE,))
    )


@pytest.mark.parametrize(
    ("local", "words"), [(50e6, "53 MB at the first visit, come from this site alone"), (None, "cdn.jsdelivr.net")]
)
def test_it_says_what_is_loaded_and_from_where(local, words):
    assert words in " ".join(page(local=local).said.split())


def test_it_says_what_is_missing_and_where_work_is_kept():
    said = " ".join(page().said.split())
    for words in (
        "hapticlab grade runs only",
        "one process",
        "stands still while a cell computes",
        "finds no port",
        "private window",
    ):
        assert words in said
    assert "kept in the storage of this browser" in said and "choose Save and then Download in the menu File" in said


def test_pages_that_are_added_are_linked_scenes_first_and_a_paddle_from_what_is_missing():
    assert "scenes" not in page().ids and "paddle.html" not in page().links
    found = page(pages=(PADDLE, SCENE))
    assert found.links["wall.html"] == "A wall & morePush it." and {"scenes", "pages"} <= found.ids
    assert found.said.index("Try a scene at once") < found.said.index("Meet the paddle") < found.said.index("Also here")
    assert "connects to one without Python" in found.said
    assert front_page(find_labs(), local=1, wheels=1, pages=(PADDLE,)).count('href="paddle.html"') == 2


def test_jupyterlite_finds_its_settings_in_the_page():
    """Without this element none of its pages starts: they read the settings of every folder above them."""
    text = front_page(find_labs(), local=1, wheels=1)
    assert '<script id="jupyter-config-data" type="application/json" data-jupyter-lite-root=".">{}</script>' in text


def test_every_page_is_written_by_a_function_that_is_there_and_scenes_are_whole(tmp_path):
    assert len({one.file for one in PAGES}) == len(PAGES) and any(one.file == "paddle.html" for one in PAGES)
    for one in PAGES:
        module, _, name = one.written_by.rpartition(".")
        assert callable(getattr(import_module(f"hapticlab.{module}"), name))
    wall = next(one for one in PAGES if one.scene).html()
    assert wall.startswith("<!DOCTYPE html>") and len(wall) < 500_000 and not re.search(r"(?:src|href)\s*=\s*\"https?:", wall)
