"""A scene's equations as MathML, which every browser of today typesets by itself, in the order and words of a notebook."""

from html import escape

import sympy as sp
from sympy.printing.mathml import MathMLPresentationPrinter
from sympy.printing.precedence import PRECEDENCE

from ...scene.notation.checks import is_model
from ...scene.notation.symbols import t
from ...scene.notation.typeset import dots, in_order, is_named, sample_of


def equations(scene):
    """Return a ``<math>`` element for each of a scene's equations, the force first.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    list of str

    Examples
    --------
    >>> import hapticlab as hl
    >>> equations(hl.library.detents())[0][:71]
    '<math display="block"><mrow><msub><mi>F</mi><mi>e</mi></msub><mo>=</mo>'
    """
    force = sp.Eq(sp.Symbol("F_e"), scene.force, evaluate=False)
    shown = [line for e in scene.eom for line in (e.shown if is_model(e) else (e,))]
    return [f'<math display="block">{Printer().doprint(line)}</math>' for line in (force, *shown)]


class Printer(MathMLPresentationPrinter):
    """SymPy's printer, with the project's own words, and terms of a sum as a hand writes them."""

    def node(self, tag, *children):
        """Return an element; texts among its children go in as they are."""
        made = self.dom.createElement(tag)
        for child in children:
            made.appendChild(self.dom.createTextNode(child) if isinstance(child, str) else child)
        return made

    def word(self, text):
        """Return a name that stands upright, such as that of a contact."""
        return self.node("mtext", escape(text.replace("_", " ")))

    def mathml_tag(self, e):
        tag = super().mathml_tag(e)
        return escape(tag) if tag in ("<", ">") else tag

    def named(self, name):
        """Return a name such as z_1 with its index below."""
        return self._print_Symbol(sp.Symbol(name))

    def called(self, word, *args):
        """Return a function of one word with its arguments."""
        name = self.node("mo", word)
        for space, width in (("lspace", "0.17em"), ("rspace", "0")):  # an mi of several letters touches its neighbours
            name.setAttribute(space, width)
        return self.node("mrow", name, self._paren_comma_separated(*args))

    def parenthesize(self, item, level, strict=False):
        if isinstance(item, sp.Derivative) and dots(item):
            return self._print(item)
        return super().parenthesize(item, level, strict)

    def _print_Add(self, expr, order=None):
        row = self.node("mrow")
        for k, term in enumerate(in_order(expr)):
            less = term.could_extract_minus_sign()
            if less or k:
                row.appendChild(self.node("mo", "&#x2212;" if less else "+"))
            row.appendChild(self.parenthesize(-term if less else term, PRECEDENCE["Add"]))
        return row

    def _print_Function(self, expr):
        if not is_named(expr):
            return self.called(self.mathml_tag(expr), *expr.args)
        if hasattr(type(expr), "letter"):  # a reaction, which is named after its contact
            return self.node("msub", self.node("mi", type(expr).letter), self.word(expr.func.__name__))
        name, sample = self.named(expr.func.__name__), sample_of(expr)
        if expr.args[0] == t:
            return name
        lag = [self.node("mo", "&#x2212;" if sample[1] == "-" else "+"), self.node("mn", sample[2:])] if sample[1:] else []
        at = [self.node("mi", "n"), *lag] if sample else [self._print(expr.args[0])]
        return self.node("mrow", name, self._l_paren(), *at, self._r_paren())

    def _print_Max(self, expr):
        return self.called(type(expr).__name__.lower(), *sorted(expr.args, key=sp.default_sort_key))

    _print_Min = _print_Max

    def _print_Derivative(self, expr):
        if not dots(expr):
            return super()._print_Derivative(expr)
        name, dot = self._print(expr.expr), self.node("mo", "&#x2d9;" if dots(expr) == 1 else "&#xa8;")
        if name.tagName != "msub":
            return self.node("mover", name, dot)
        letter, index = name.childNodes
        return self.node("msub", self.node("mover", letter, dot), index)

    def _print_Piecewise(self, expr):
        rows = []
        for value, condition in expr.args:
            when = [self.node("mtext", "for&nbsp;"), self._print(condition)]
            rows.append(self.node(
                "mtr", self.node("mtd", self._print(value)),
                self.node("mtd", *([self.node("mtext", "otherwise")] if condition == True else when)),  # noqa: E712
            ))  # fmt: skip
        table = self.node("mtable", *rows)
        table.setAttribute("class", "hl-cases")  # whose left border is its brace: few computers have a font that stretches one
        return table

    def _print__Unworked(self, expr):
        return self._print(expr.doit())

    def _print_Amount(self, expr):
        return self.node("mrow", self.node("mn", f"{float(expr.value):g}"), self.node("mtext", "&nbsp;"), self.word(expr.unit))

    def _print_ClosestPoints(self, expr):
        return self.node("mrow", self.word(expr.part), self._l_paren(), self.word(expr.args[3].name), self._r_paren())

    def _print_sampled(self, expr):
        return self.called("sampled", *expr.args)

    def _print_delay(self, expr):
        return self.called("delay", *expr.args)
