"""`hapticlab guide`: the pages that an owner reads, which are in the wheel with all that they link to."""

import re
import tomllib
from pathlib import Path

import pytest

from hapticlab.cli import guide
from hapticlab.cli.main import main
from hapticlab.cli.options import PAGES

ROOT = Path(__file__).parents[2]


@pytest.fixture
def opened(monkeypatch):
    """Addresses that a browser would open."""
    pages = []
    monkeypatch.setattr(guide.webbrowser, "open", lambda page: not pages.append(page))
    return pages


def test_it_prints_a_path_and_opens_nothing_unasked(opened, capsys):
    assert main(["guide"]) == 0 and not opened
    assert Path(capsys.readouterr().out.strip()) == ROOT / "docs" / "paddle" / "owners_guide.md"
    assert main(["guide", "safety", "--open"]) == 0
    assert opened == [(ROOT / "docs" / "paddle" / "SAFETY.md").as_uri()]


def test_no_browser_and_no_page_are_told(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(guide.webbrowser, "open", lambda page: False)
    assert main(["guide", "faults", "--open"]) == 1
    assert "with an editor" in capsys.readouterr().err
    monkeypatch.setattr(guide, "PLACES", (tmp_path,))
    assert main(["guide", "card"]) == 1
    assert "install hapticlab again" in capsys.readouterr().err


def test_the_wheel_has_each_page_and_what_it_links_to():
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel["force-include"]["docs/paddle"] == "hapticlab/docs"
    for page in PAGES.values():
        text = (ROOT / "docs" / "paddle" / page).read_text("utf-8")
        missing = [link for link in re.findall(r"\]\(([^)#:]+)[^):]*\)", text) if link.startswith("../")]
        assert not missing, f"{page} links {missing}, which the wheel does not have"
