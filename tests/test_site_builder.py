"""The builder of the site: examples with their outcomes, and what it finds wrong in HTML. tests/browser/test_documentation.py
builds a site and opens it."""

import json
import multiprocessing
import re
import runpy
import shutil
import sys
from concurrent.futures import ProcessPoolExecutor

import pytest
from builder import check, whole
from builder.command import main
from builder.pages import from_the_root, licences
from builder.running import examples, lab_outcomes, outcomes

PAGE = """# A page

```python
import hapticlab as hl

paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch", push=2.0))
log = paddle.run(hl.wall()(k=500, x_o=0.01), duration=0.1)
print(len(log), "samples")
```

```text
99 samples
```

![The handle sinks in](old.png)

```python
hl.show(hl.plot(log, "x"), alt="Position of the handle")
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
```

After.
"""


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """The page after it ran, and the folder with what it shows."""
    source = tmp_path_factory.mktemp("docs")
    (source / "how_to").mkdir()
    (source / "how_to" / "page.md").write_text(PAGE)
    assert outcomes.write(source, "how_to/page.md") == 2
    return (source / "how_to" / "page.md").read_text(), source


def test_what_an_example_prints_takes_the_place_of_what_the_page_says(shown):
    text, _ = shown
    assert "99 samples" not in text
    assert (
        text.index('print(len(log), "samples")') < text.index(":class: printed\n\n100 samples\n```") < text.index("![The handle")
    )


def test_a_figure_and_a_view_stand_below_their_example(shown):
    text, source = shown
    (file, alt) = re.search(r"\{image\} /(\S+)\n:alt: (.+)", text).groups()
    assert alt == "Position of the handle" and "<svg" in (source / file).read_text()
    (address,) = re.findall(r'<iframe [^>]*src="\.\./(live/\S+\.html)"', text)
    assert 'id="hl-data"' in (source / address).read_text("utf-8")
    assert text.rstrip().endswith("After.")


def test_a_picture_gives_way_to_the_figure_that_the_example_draws():
    code = 'import hapticlab as hl\nfigure = hl.plot({"a": ([0, 1], [0, 1])}, xlabel="a", ylabel="b")'
    text = f"```python\n{code}\n```\n\n![Words](old.png)\n"
    ran = examples.run(text, "page.md")
    assert outcomes.PICTURE.match(text, ran.examples[0].end)["alt"] == "Words" and len(ran.examples[0].figures) == 1


@pytest.mark.parametrize(
    "code, line, words",
    [
        ("a = 1\na.b", 4, "no attribute 'b'"),
        ("def f(:", 3, "SyntaxError"),
        ("import warnings\nwarnings.warn('old')", 4, "old"),
        ("exit(3)", 3, "SystemExit: 3"),
    ],
)
def test_an_example_that_fails_is_named_with_its_line(code, line, words):
    with pytest.raises(examples.ExampleError, match=rf"(?s)page.md, line {line}: .*{words}"):
        examples.run(f"# Page\n```python\n{code}\n```\n", "page.md")


@pytest.mark.parametrize("fenced", ["  ```python\n  1\n  ```", "~~~python\n1\n~~~", "```python \n1\n```", "```python\n1"])
def test_an_example_that_would_not_run_is_named(fenced):
    with pytest.raises(examples.ExampleError, match=r"page.md, line 2: only ```python"):
        examples.run(f"# Page\n{fenced}\n", "page.md")


NOT_HERE = "loads //example.org/b.png, which is elsewhere"
GOOD = '<html><body><h1 id="top">A</h1><a href="b/two.html#deep">two</a> <a href="https://example.org">out</a></body></html>'


@pytest.mark.parametrize(
    "body, wrong",
    [
        ('<a href="../one.html#top">one</a> <a href="">here</a>', []),
        ('<a href="gone.html">', ["links gone.html, which is not there"]),
        ('<a href="../one.html#gone">', ["links ../one.html#gone, which has no such anchor"]),
        ('<script src="https://cdn.example.org/a.js"></script>', ["loads https://cdn.example.org/a.js, which is elsewhere"]),
        ('<link rel="stylesheet" href="//example.org/a.css">', ["loads //example.org/a.css, which is elsewhere"]),
        ('<img srcset="a.png 1x">', ["loads a.png, which is not there"]),
        ('<img srcset="one.html 1x, //example.org/b.png 2x">', ["loads one.html, which is not there", NOT_HERE]),
        ("<script>const a = '<img src=\"https://example.org\">'</script>", []),
        ('<a href="javascript:run()">', ["links javascript:run(), which is no address of the web"]),
    ],
)  # fmt: skip
def test_what_leads_nowhere_and_what_comes_from_elsewhere_is_found(tmp_path, body, wrong):
    (tmp_path / "b").mkdir()
    (tmp_path / "one.html").write_text(GOOD)
    (tmp_path / "b" / "two.html").write_text(f'<article id="deep">two words {body}</article>')
    found = check.look_through(tmp_path)
    assert found.wrong == [f"b/two.html: {why}" for why in wrong]
    assert found.pages == 2


def test_a_style_sheet_may_load_nothing_from_elsewhere(tmp_path):
    (tmp_path / "a.css").write_text('@import "b.css"; a { background: url(https://example.org/a.woff2) }')
    assert check.look_through(tmp_path).wrong == ["a.css loads https://example.org/a.woff2, which is elsewhere"]


def test_a_folder_with_anything_else_is_kept(tmp_path, capsys):
    (tmp_path / "mine.txt").write_text("mine")
    assert main([str(tmp_path)]) == 1
    assert "no site of an earlier build" in capsys.readouterr().out and (tmp_path / "mine.txt").exists()


@pytest.mark.parametrize(
    "words, told",
    [
        ([str(whole.DOCS / "_build")], "is inside .*name another folder"),
        (["{tmp}/file/site"], "cannot be written: Not a directory"),
        (["{tmp}/site", "--pyodide", "{tmp}/none.tar.bz2"], "none.tar.bz2 is not there"),
    ],
)
def test_what_cannot_be_built_is_told_before_pages_are_written(tmp_path, monkeypatch, capsys, words, told):
    (tmp_path / "file").touch()
    monkeypatch.setattr(whole, "_write_pages", lambda *_: pytest.fail("pages are written"))
    assert main([word.format(tmp=tmp_path) for word in words]) == 1
    assert re.search(told, capsys.readouterr().out)


def test_a_site_that_is_cut_off_while_it_is_copied_is_replaced(tmp_path, monkeypatch):
    made, folder = tmp_path / "made", tmp_path / "site"
    (made / "deep").mkdir(parents=True)
    (made / "deep" / "new.html").touch()
    (folder / "old").mkdir(parents=True)
    for name in (whole.MARK, "old.html", "old/page.html"):
        (folder / name).touch()
    with monkeypatch.context() as cut_off:
        cut_off.setattr(shutil, "copytree", lambda *_, **__: (folder / "half.html").touch())
        whole._replace(folder, made)
    whole._check_folder(folder)
    whole._replace(folder, made)
    assert {path.relative_to(folder).as_posix() for path in folder.rglob("*")} == {whole.MARK, "deep", "deep/new.html"}


def test_without_its_packages_the_builder_says_how_to_install_them(monkeypatch):
    monkeypatch.setitem(sys.modules, "builder.command", None)
    with pytest.raises(SystemExit, match=r"builder.command is not installed; do: .* -m pip install -e \".\[docs\]\""):
        runpy.run_path(str(whole.DOCS / "build.py"))


@pytest.mark.wide
def test_a_cell_of_a_lab_that_fails_is_named(tmp_path):
    notebook = tmp_path / "99_lab.ipynb"
    cells = [{"cell_type": "code", "id": one, "source": one} for one in ("a = 0", "1 / a\na")]
    notebook.write_text(json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}))
    told = r"99_lab.ipynb, the cell '1 / a': ZeroDivisionError: division by zero"
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, spawn) as pool, pytest.raises(examples.ExampleError, match=told):
        pool.submit(lab_outcomes.of_notebook, notebook).result()


def test_every_part_has_the_texts_of_all_licences_that_it_names():
    assert [part.name for part in licences.PARTS if len(part.text) < 900] == []
    (icons,) = (part.text for part in licences.PARTS if part.name.startswith("Font Awesome"))
    for text in ("Permission is hereby granted", "SIL OPEN FONT LICENSE", "Section 8 -- Interpretation"):
        assert text in icons


def test_pages_beyond_docs_are_in_the_site():
    assert [file for file in from_the_root.PAGES if not (whole.DOCS.parent / file).is_file()] == []
