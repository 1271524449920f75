"""A page and a find are tables in a notebook; hl.<tab> there opens nothing; old names are answered with the new."""

import subprocess
import sys

import pytest

import hapticlab as hl
from hapticlab.vocabulary import PAGES

SCRIPT = """
import sys, warnings
warnings.simplefilter("ignore")
from IPython.core.completer import provisionalcompleter
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shell.run_cell("import hapticlab as hl; other = hl.__class__('other')", silent=True)
def asked(cell):
    with provisionalcompleter():
        return [found.text for found in shell.Completer.completions(cell, len(cell))]
import hapticlab as hl
assert sorted(asked("hl.")) == hl.__all__
assert asked("a = 1\\nprint(hl.stab") == ["stability", "stability_limit"]
opened = {"sympy", "matplotlib", "hapticlab.laws", "hapticlab.scene"} & set(sys.modules)
assert not opened, opened
assert asked("other.wa") == []
assert "paddle=" in asked("hl.live(pad")
assert "virtual_damper" in asked("hl.laws.virtual_d")
"""


def test_the_first_completion_opens_nothing():
    """Jedi alone would ask each name what it is: 1.2 s and 867 modules before the list shows."""
    pytest.importorskip("IPython")
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_a_short_text_and_a_table(page):
    shown = getattr(hl, page)
    assert ">>> " in shown.__doc__, "an example"
    assert len(shown.__doc__.strip().splitlines()) <= 35
    html = shown._repr_html_()
    assert html.count("<tr>") == len(shown.__all__)
    assert "<pre>" in html and "&gt;&gt;&gt;" in html


def test_what_was_found_is_a_table():
    found = hl.find("kalman")._repr_html_()
    assert found.startswith("<table>") and "<code>hl.velocity.kalman</code>" in found
    assert "nothing found" in hl.find("zzzz")._repr_html_()


@pytest.mark.parametrize(
    ("old", "new"), [("velocity_errors", "velocity.compare"), ("closed_loop_poles", "stability.poles"), ("hand", "Hand")]
)
def test_a_name_that_moved_is_answered_with_where_it_is(old, new):
    with pytest.raises(AttributeError, match=rf"did you mean .*hl\.{new}\b"):
        getattr(hl, old)


def test_a_page_that_is_called_says_what_it_holds():
    with pytest.raises(TypeError, match=r"hl.bounds is a page of names, no function; it holds .*hl.bounds.table"):
        hl.bounds(hl.Device(b=0.1, T=1e-3))
