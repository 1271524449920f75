"""A card: what a check found, as plain text and as HTML without scripts; every meaning is in words, and never in colour alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ...base.drawing import DARK, PICTURE
from .page_text import clean

State = Literal["right", "partly", "wrong", "open", "saved"]
#: state -> the sign that stands before its words, which is not read aloud
SIGNS: dict[State, str] = {"right": "\u2713", "partly": "\u25d0", "wrong": "\u2717", "open": "\u25cb", "saved": "\u270e"}
#: white signs on these have a contrast of 5 to 1 and more, and their line is seen on white and on black
COLOURS: dict[State, str] = {"right": "#2b7a3f", "partly": "#946200", "wrong": "#b8400f", "open": "#6b6b6b", "saved": "#2f6db3"}
#: the line beside a card is another in grey print too
LINES: dict[State, str] = {"right": "solid", "partly": "dashed", "wrong": "double", "open": "dotted", "saved": "solid"}
#: part of a card -> how it looks where styles are kept; text has the colour of what is around it, so that it is read in the dark
STYLES = {
    "card": "max-width: 44rem; margin: .3rem 0; padding: .2rem .9rem; font-size: 1em; line-height: 1.5; "
    "white-space: normal; word-break: normal; overflow-wrap: break-word;",
    "head": "margin: .2rem 0; font-size: 1.05em;",
    "sign": "display: inline-block; min-width: 1.4em; text-align: center; border-radius: .25em; color: #fff; font-weight: 700;",
    "aside": "opacity: .8; white-space: nowrap;",
    "row": "margin: .35rem 0;",
    # a picture has a light ground of its own, which a dark page turns dark with it
    "figure": "margin: .5rem 0; padding: .4rem; background: #fff; color: #1b1b1b; font: 13px sans-serif; ",
    "picture": "display: block; max-width: 100%; height: auto;",
    **{f"line-{state}": f"border-left: .4rem {line} {COLOURS[state]};" for state, line in LINES.items()},
    **{f"sign-{state}": f"background: {colour};" for state, colour in COLOURS.items()},
}


def inline(*parts: str) -> str:
    """Return the attributes of an element with these parts, for a page that takes no style sheet, such as a notebook."""
    turned = f' class="{PICTURE}"' if "figure" in parts else ""
    return f'{turned} style="{" ".join(STYLES[part] for part in parts)}"'


@dataclass(frozen=True)
class Card:
    """What a check found.

    Attributes
    ----------
    name : str
        Lab and exercise, "01.wall_force"; empty where it stands above the card.
    state : {"right", "partly", "wrong", "open", "saved"}
        "open" where there is no answer, or no such check; "saved" for what is not marked.
    head : str
        What was judged, in words: they say what the state says.
    aside : str
        Beside the head.
    rows : sequence of (str, str)
        Label and words.
    figures : sequence of (str, str)
        An SVG, and its sentence; in HTML alone, after the first row.

    Examples
    --------
    >>> card = Card("01.force", "wrong", "not right yet", rows=(("hint", "Is x < 0?"),))
    >>> print(card.text())
    01.force: not right yet
      hint: Is x < 0?
    >>> print(card.html(lambda *parts: ""))
    <div><p><span aria-hidden="true">✗</span> <strong>not right yet</strong> <code>01.force</code></p>
    <p><strong>hint:</strong> Is x &lt; 0?</p></div>
    """

    name: str
    state: State
    head: str
    aside: str = ""
    rows: tuple[tuple[str, str], ...] = ()
    figures: tuple[tuple[str, str], ...] = ()

    def text(self) -> str:
        """Return the card in lines, the form that is printed, logged and graded."""
        head = f"{self.name}: {self.head}{f' ({self.aside})' if self.aside else ''}"
        return "\n".join([head, *(f"  {label}: {words}" for label, words in self.rows)])

    def html(self, look: Callable[..., str] = inline) -> str:
        """Return the card in HTML: no script, no id, and readable with every style removed.

        Parameters
        ----------
        look : callable
            Parts of STYLES to an attribute of an element, with a space before it.
        """
        sign = f'<span aria-hidden="true"{look("sign", f"sign-{self.state}")}>{SIGNS[self.state]}</span>'
        aside = f" <span{look('aside')}>({clean(self.aside)})</span>" if self.aside else ""
        name = f" <code>{clean(self.name)}</code>" if self.name else ""
        said, colon, more = clean(self.head).partition(": ")
        head = f"{sign} <strong>{said}</strong>{colon}{more}{name}{aside}"
        rows = [f"<p{look('row')}><strong>{clean(label)}:</strong> {_unbroken(words)}</p>" for label, words in self.rows]
        svgs = [(svg.replace("<svg", f"<svg{look('picture')}", 1), clean(words)) for svg, words in self.figures]
        drawn = [f"<figure{look('figure')}>{svg}<figcaption>{words}</figcaption></figure>" for svg, words in svgs]
        first = f"<div{look('card', f'line-{self.state}')}><p{look('head')}>{head}</p>"
        return "\n".join([*[DARK] * bool(drawn and look is inline), first, *rows[:1], *drawn, *rows[1:]]) + "</div>"


def _unbroken(words):
    """Return words for a page, where no line ends within "x = 2"."""
    return clean(words).replace(" = ", "\u00a0=\u00a0")
