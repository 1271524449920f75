"""Cards of checks in a browser, in a light and in a dark page: readable, within the page, and whole without styles."""

import re

import pytest
from axe import findings
from lab import picture
from test_grading_pages import CONTRAST, OUTSIDE

from hapticlab.course.check import checked
from hapticlab.course.labs import find_lab

ANSWERS = {
    "02.period_leak": lambda k, D: k * D**2 / 2,
    "02.held_work": lambda k, x, D: k * x * abs(D),
    "02.energy_generated": lambda x, k: 0.0,
    "07.why_order_one": "a",
    "02.bounce_gain": None,
    "00.handle_position": lambda counts, left, right, travel: (counts - left) * travel / (right - left),
    "05.observed_energy": lambda x, k, b, T, **more: [0.0] * len(x),
}
GROUNDS = {"light": ("#ffffff", "#212121"), "dark": ("#111111", "#e0e0e0")}
#: words that are broken: an inline element of one word that takes two lines
BROKEN = """() => [...document.querySelectorAll("code")]
    .filter((one) => one.getClientRects().length > 1).map((one) => one.textContent)"""

#: pictures that are wider than their frame
WIDE = """() => [...document.querySelectorAll("figure")]
    .filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.outerHTML)"""

pytestmark = pytest.mark.wide


def cards():
    """Yield the card of each answer, as a notebook gets it."""
    for name, answer in ANSWERS.items():
        lab, exercise = name.split(".")
        yield checked(name, find_lab(lab).exercise(exercise), answer).card.html()


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("width", [1280, 390])
def test_cards_are_read_on_any_ground(browser, ground, width):
    page = browser.new_page(viewport={"width": width, "height": 900})
    behind, text = GROUNDS[ground]
    style = f"background: {behind}; color: {text}; font: 14px sans-serif"
    page.set_content(f'<html lang="en"><title>cards</title><body style="{style}"><main>{"".join(cards())}</main></body></html>')
    try:
        assert findings(page) == []
        least, words = page.evaluate(CONTRAST)
        assert least >= 4.5, words
        assert page.evaluate(OUTSIDE) == [] and page.evaluate(WIDE) == []
        assert page.evaluate(BROKEN) == []
        height = page.evaluate("() => document.documentElement.scrollHeight")
        page.set_viewport_size({"width": width, "height": height})
        picture(page, f"cards-{ground}-{width}")
    finally:
        page.close()


def test_without_styles_every_word_stays(browser):
    page = browser.new_page()
    whole = "".join(cards())
    page.set_content(whole)
    styled = page.inner_text("body").split()
    page.set_content(re.sub(r' style="[^"]*"', "", whole))
    assert page.inner_text("body").split() == styled
    page.close()
