"""Every lab is set by one template, so that who knows one finds the way in all."""

import ast
import re

import pytest
from reading_time import FORMULA, LABS, reading_time, text_of, written

from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

SECTIONS = ("Predict", "Derive", "Compile", "Feel", "Measure", "Compare", "Hand in")
FOLDERS = find_labs(LABS)

pytestmark = pytest.mark.parametrize("folder", FOLDERS, ids=[folder.name for folder in FOLDERS])


def test_sections_come_in_the_order_of_the_template(folder):
    lab, notebook = folder.lab(), read(folder.notebook)
    first = "".join(notebook["cells"][0]["source"])
    assert first.startswith(f"# Lab {lab.number}: {lab.title}\n\n")
    parts = ["**After this lab you can**", "**Before it:**", f"**Time:** {lab.minutes} minutes", "**Needs:**"]
    assert [at for part in parts if (at := first.find(part)) < 0] == []
    assert sorted(parts, key=first.find) == parts
    headings = re.findall(r"^## (.*)$", text_of(notebook), re.M)
    found = [re.fullmatch(r"(\d+) ([A-Z][a-z ]+)(?:: .+)?", heading) for heading in headings]
    assert [heading for heading, match in zip(headings, found, strict=True) if match is None] == []
    assert [int(match[1]) for match in found] == list(range(1, len(found) + 1))
    begun = [SECTIONS.index(name) for name in dict.fromkeys(match[2] for match in found)]  # a step may come again
    assert begun == sorted(begun) and found[0][2] == "Predict"
    assert found[-1][2] == "Hand in"


def test_text_is_typeset(folder):
    text = text_of(read(folder.notebook))
    assert not re.search(r"^\s*[-*] \[[ x]\]", text, re.M), "a disabled box without a name, for a screen reader"
    plain = re.sub(r"```.*?```|`[^`]*`", "code", FORMULA.sub("formula", text), flags=re.S)
    assert re.findall(r"\bu[mJ]\b|\^|[<>]=|\bsqrt|\b[a-z]''|\bomega\b", plain) == [], "µm, and LaTeX for a formula"
    assert re.findall(r"!\[\]\(|<img(?![^>]* alt=\"[^\"])[^>]*>", text) == [], "alternative text"
    assert text.count("$") % 2 == 0


def test_code_is_short_and_about_the_subject(folder):
    notebook = read(folder.notebook)
    wide = [line for code in code_of(notebook) for line in code.splitlines() if len(line) > 88]
    assert wide == []
    for code in code_of(notebook):
        for node in ast.walk(ast.parse(code)):
            if isinstance(node, ast.ImportFrom | ast.Import):
                named = [node.module] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
                assert not [name for name in named if name.startswith("hapticlab.")], "hapticlab's public names alone"
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "hl.show":
                words = next((one.value for one in node.keywords if one.arg == "alt"), None)
                assert words or ast.unparse(node.args[0]).startswith("hl.") or ".plot(" in ast.unparse(node.args[0])
    assert "widgets" not in notebook["metadata"]


def test_title_and_reading_time_stand_in_the_list(folder):
    readme = (LABS / "README.md").read_text("utf-8")
    assert f"\n| {folder.number} {folder.lab().title} |" in readme
    assert readme == written(readme, {folder.number: reading_time(folder)[-1]}), "python tests/labs/reading_time.py --write"
