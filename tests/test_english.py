"""Sentences that a user reads: none has a phrase that readers stumble over. Messages, the documentation and the labs."""

import ast
import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NOUN = "number|scene|notebook|port|text|record|function|shape|equation|option|setting|figure|file|list|sample|noise|motion"
RATE = "tick|second|sample|period|step|minute|metre|cycle|coordinate|name|level|newton"
UNIT = "instructions?|cycles?|steps?|numbers?|values?|terms?|samples?|crossings?|counts?|um|sums?|one"

#: what is not written -> what is written
PHRASES = {
    rf"\b(?:is|are|was) no (?:{NOUN})\b": "is not a ...",
    r"\bturned round\b": "reversed; in the wrong direction",
    r"\b[Tt]he sign is turned\b": "The sign is wrong",
    r"\bin no hand\b": "not held; not in every hand",
    r"\bnothing has that name\b": "there is no ... of that name",
    r"[;:] needs every (?:sample|one)\b": "the ... needs every sample",
    r"\bfrom (?!then|now)(?:\S+ ){1,3}on(?=[.,;:)]|$)": "above ...; after ...; from then on",
    rf"\b(?:{UNIT}) an? (?:{RATE})\b": "per ...",
    r"\bknows? (?:nothing of|no)\b": "does not account for",
    r"\bpay(?:s|ing)? for\b": "dissipates the energy of; compensates for",
    r"\bto and fro\b": "back and forth",
    r"\b[Ll](?:ead|ed|eading) (?:it|the handle)\b": "move the handle",
    r"\bpromises?\b": "guarantees",
    r"\banew\b": "again",
    r"\bstands (?:by|late|beside|behind|there)\b": "remains; is late; is next to",
    r"\bbegins anew\b": "starts again",
    r"\bwhoever\b": "the person who; the instructor",
    r"\bsomebody(?: else)?\b": "a person; another program",
    r"\bmay be set\b": "is live; can be changed",
    r"\bfeeds? energy\b": "supplies energy; generates energy",
}
ANY = re.compile("|".join(PHRASES))
#: lab 02 defines "pays for"
DEFINED = {r"\bpay(?:s|ing)? for\b"}


def sentences(path):
    """Yield (line, text) of the texts of a module that are no docstring, with f-strings as they are written."""
    tree = ast.parse(path.read_text("utf-8"))
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    silent = {
        id(node.body[0].value) for node in ast.walk(tree) if isinstance(node, documented) and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = [part.value if isinstance(part, ast.Constant) else "{}" for part in node.values]
            silent |= {id(part) for part in node.values}
            yield node.lineno, "".join(parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node.lineno, node.value


def prose(path):
    """Yield (line, text) of a page without its code; lines of a paragraph are one text."""
    text = re.sub(r"^```.*?^```", lambda code: "\n" * code[0].count("\n"), path.read_text("utf-8"), flags=re.S | re.M)
    for part in re.finditer(r"(?:.+\n?)+", text):
        yield text.count("\n", 0, part.start()) + 1, " ".join(re.sub(r"`[^`]*`", "...", part[0]).split())


def cells(path):
    """Yield (cell, text) of the prose of a notebook."""
    for number, cell in enumerate(json.loads(path.read_text("utf-8"))["cells"]):
        if cell["cell_type"] == "markdown":
            yield number, " ".join(re.sub(r"`[^`]*`|\$[^$]*\$", "...", "".join(cell["source"])).split())


def found(path, texts, allowed=frozenset()):
    """Return a line for each phrase: where it stands, and what to write."""
    return [
        f"{path.relative_to(ROOT)}:{where}: {match[0]!r} -> {cure}"
        for where, text in texts
        if ANY.search(text)
        for phrase, cure in PHRASES.items()
        if phrase not in allowed and (match := re.search(phrase, text))
    ]


MODULES = sorted((ROOT / "hapticlab").rglob("*.py"))
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "firmware" / "README.md"]


def test_no_message_has_a_phrase_that_readers_stumble_over():
    assert [line for path in MODULES for line in found(path, sentences(path))] == []


def test_no_page_has_one():
    assert [line for path in PAGES for line in found(path, prose(path))] == []


def test_no_lab_has_one():
    labs = sorted((ROOT / "labs").rglob("*.ipynb"))
    assert [line for path in labs for line in found(path, cells(path), DEFINED)] == []


@pytest.mark.parametrize("text", ["1e-9 is no number; give one", "from 200 N/m on, it chatters", "12 instructions a tick"])
def test_a_phrase_is_found(text):
    assert any(re.search(phrase, text) for phrase in PHRASES)
