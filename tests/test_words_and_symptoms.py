"""The glossary, the pages on extending, on symptoms and on a sample: what they say exists, and their examples run."""

import io
import re
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest
import sympy as sp
from builder.pages import cross_links, glossary_pictures, sample_picture
from builder.running.examples import run

from hapticlab import n, x
from hapticlab.vocabulary import public

pytestmark = pytest.mark.interpreter

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
GLOSSARY = (DOCS / "reference" / "glossary.md").read_text("utf-8")
TERM = re.compile(r"\{term\}`(?:[^`<]*<)?([^`>]+)>?`")
NEW = [f"docs/extending/{path.name}" for path in sorted((DOCS / "extending").glob("*.md")) if path.name != "index.md"] + [
    f"docs/{name}.md"
    for name in (
        "explanation/life_of_a_sample", "explanation/nominal",
        "how_to/troubleshooting", "how_to/spring_with_a_dead_zone", "how_to/record_and_plot", "how_to/units",
    )
]  # fmt: skip


def entries(text):
    """Term -> its definition, in the order of the page."""
    (words,) = re.findall(r"^:::\{glossary\}\n(.*?)^:::$", text, re.M | re.S)
    found = re.findall(r"^(\S.*)\n((?:(?:  .*)?\n)+)", words, re.M)
    assert len({term for term, _ in found}) == len(found)
    return dict(found)


def lacking(text):
    """The terms whose definition has neither an equation nor a picture."""
    return [term for term, says in entries(text).items() if not re.search(r"\$[^$]+\$|!\[[^\]]{20,}\]\(", says)]


def test_each_word_has_an_equation_or_a_picture():
    assert len(entries(GLOSSARY)) >= 80
    assert lacking(GLOSSARY) == []
    assert lacking(GLOSSARY.replace("$k = dF/dx$", "a slope")) == ["stiffness"]  # the test can fail


def test_the_words_are_sorted():
    words = [term.casefold() for term in entries(GLOSSARY)]
    assert words == sorted(words)


def test_each_term_that_a_page_uses_is_defined():
    used = {" ".join(term.split()) for path in DOCS.rglob("*.md") for term in TERM.findall(path.read_text("utf-8"))}
    assert len(used) > 15
    assert used - set(entries(GLOSSARY)) == set()


def test_what_the_glossary_names_exists():
    assert set(re.findall(r"`(hl\.[\w.]+)`", GLOSSARY)) - {*public()} == set()
    labs = {path.name[:2] for path in (ROOT / "labs").iterdir() if path.is_dir()}
    assert set(re.findall(r"\blab (\d\d)", GLOSSARY)) - labs == set()
    assert set(re.findall(r"\(glossary/(\w+)\.svg\)", GLOSSARY)) == set(glossary_pictures.PICTURES)


@pytest.mark.parametrize("name", glossary_pictures.PICTURES)
@pytest.mark.always("chatter", "paddle")
def test_a_picture_is_drawn_and_is_the_same_each_time(name):
    first, again = io.BytesIO(), io.BytesIO()
    for made in (first, again):
        glossary_pictures.figure(name).savefig(made, format="raw", dpi=40)
    assert first.getvalue() == again.getvalue()
    assert len(set(first.getvalue())) > 10  # something is drawn


def test_names_labs_and_equations_become_links_where_their_pages_are():
    text = "See `hl.wall`, Eq. (23.1), Fig. 23.4, lab 02, lab 77."
    assert cross_links.linked(text, "how_to/a.md", names=set(), labs={}, targets=set()) == text
    given = {"names": {"hl.wall"}, "labs": {"02": "labs/02_virtual_wall.md"}, "targets": {"eq-23-1", "fig-23-4"}}
    linked = cross_links.linked(text, "how_to/a.md", **given)
    assert "{py:obj}`hl.wall <hapticlab.wall>`" in linked and "[lab 02](../labs/02_virtual_wall.md), lab 77." in linked
    assert "[Eq. (23.1)](../reference/chapter.md#eq-23-1), [Fig. 23.4](../reference/chapter.md#fig-23-4)" in linked
    kept = "# `hl.wall`\n[the wall `hl.wall`, lab 02](x.md) `lab 02`\n```python\n# lab 02\n```\n[of two\nlines, lab 02](y.md)"
    assert cross_links.linked(kept, "how_to/a.md", **given) == kept


def test_the_drawing_of_a_sample_is_what_its_code_draws():
    assert sample_picture.PICTURE.read_text("utf-8") == sample_picture.picture()


@cache
def texts():
    """The modules of the package, with texts that go on in the next line as one text."""
    code = "\n".join(path.read_text("utf-8") for path in (ROOT / "hapticlab").rglob("*.py"))
    return re.sub(r"\"\s*\n\s*f?\"", "", code)


def of_python():
    """Texts of SymPy and of Python, which no module of the package has."""
    with pytest.raises(TypeError) as relational:
        bool(x(n) > sp.Symbol("x_o"))
    with pytest.raises(ModuleNotFoundError) as module:
        __import__("no_such_module")
    with pytest.raises(AttributeError) as attribute:
        ModuleType("no_such_module").SimulatedPaddle  # noqa: B018 what an empty folder of that name gives
    return f"{relational.value}\n{module.value}\n{attribute.value}".replace("no_such_module", "hapticlab")


def quoted(page):
    """The texts in the first column of the tables of texts."""
    tables = re.findall(r"^\| text \| cause \| cure \|\n\|[-| ]+\|\n((?:\|.*\n)+)", page, re.M)
    return [text for table in tables for row in table.splitlines() for text in re.findall(r"`([^`]+)`", row.split(" | ")[0])]


def test_the_quoted_texts_are_those_of_the_code():
    page = (DOCS / "how_to" / "troubleshooting.md").read_text("utf-8")
    found = quoted(page)
    assert len(found) >= 25
    assert [text for text in found if text not in texts() + of_python()] == []
    assert "the wall sings" not in texts()


def test_each_symptom_opens_with_what_splits_its_causes():
    page = (DOCS / "how_to" / "troubleshooting.md").read_text("utf-8")
    sections = re.split(r"^## .*\n", page, flags=re.M)[1:]
    assert len(sections) >= 8
    assert [section for section in sections if not section.strip().startswith("**Split the causes:**")] == []


@pytest.mark.parametrize("path", NEW)
@pytest.mark.always("docs/explanation/life_of_a_sample.md")
def test_the_examples_run(path, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = run((ROOT / path).read_text("utf-8"), path)
    assert page.printed


@pytest.mark.parametrize("path", [*NEW, "docs/reference/glossary.md", "docs/extending/index.md"])
def test_links_lead_somewhere_and_lines_fit(path):
    text = (ROOT / path).read_text("utf-8")
    links = [link for link in re.findall(r"\]\(([^)#\s]+)(?:#[\w-]*)?\)", text) if not link.startswith("glossary/")]
    assert [link for link in links if "://" not in link and not (ROOT / path).parent.joinpath(link).exists()] == []
    assert [line for line in text.splitlines() if len(line) > 132 and line[:1] not in ("|", ">") and "$" not in line] == []
    files = set(re.findall(r"`((?:tests|firmware|hapticlab|docs)/[\w/.]+)`", text))
    assert [file for file in sorted(files) if "NAME" not in file and not (ROOT / file).exists()] == []
