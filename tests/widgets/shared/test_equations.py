import re
from collections import Counter
from html import unescape
from unicodedata import normalize
from xml.etree import ElementTree

import pytest
from sympy.printing.pretty.pretty_symbology import greek_unicode

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.library.entries import CATALOGUE
from hapticlab.scene.notation.typeset import typeset
from hapticlab.widgets.shared.equations import Printer, equations

k, x_o = hl.parameters("k x_o", units="N/m m")
NO_NAMES = {"for", "otherwise", "left", "right", "frac", "begin", "end", "cases", "text", "geq", "leq", "mathrm", "operatorname"}


def read(math):
    return ElementTree.fromstring(unescape(math).replace("<mo><</mo>", "<mo>&lt;</mo>"))


def words_of(texts):
    found = (word for text in texts for word in re.findall(r"[^\W\d_]+|\d+", normalize("NFKC", text)))
    return Counter(word for word in found if word not in NO_NAMES)


def in_latex(line):
    """Names, numbers and dots of a line of LaTeX; Greek letters as such."""
    letters = {**greek_unicode, "lambda": "λ", "varphi": "φ"}
    greek = re.sub(r"\\([A-Za-z]+)", lambda command: f" {letters.get(command[1], command[1])} ", line)
    return words_of([greek.replace("ddot", "dot dot")])


def in_mathml(math):
    dots = {"\u02d9": " dot ", "\u00a8": " dot dot "}
    return words_of(dots.get(text, text) for text in read(math).itertext())


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.always("gears", "texture", "ball_on_the_paddle")
def test_a_shared_file_shows_what_a_notebook_shows(name):
    scene = CATALOGUE[name].scene()
    shown, latex = equations(scene), scene._equations()
    assert len(shown) == len(latex)
    for math, line in zip(shown, latex, strict=True):
        assert in_mathml(math) == in_latex(line.replace("F_e", "F_{e}"))


def test_samples_and_rates_are_typeset_as_a_hand_writes_them():
    z_1 = hl.coordinate("z_1", unit="m")
    lagged = read(f"<math>{Printer().doprint(k * (x(n - 1) - x(n)))}</math>")
    assert "".join(lagged.itertext()).replace("\u2062", "") == "k(−x(n)+x(n−1))"
    dotted = Printer().doprint(z_1.diff(t))
    assert dotted == "<msub><mover><mi>z</mi><mo>&#x2d9;</mo></mover><mi>1</mi></msub>"
    assert typeset(z_1.diff(t)) == r"\dot{z_{1}}"


def test_a_condition_and_a_name_cannot_break_the_page():
    law = hl.when((x(n) > x_o) & (x(n) < 2 * x_o), k * (x(n) - x_o), 0)
    assert "<mo>&lt;</mo>" in equations(hl.Scene(force=law))[0]
    assert "<script>" not in str(Printer().word("<script>").toxml())
