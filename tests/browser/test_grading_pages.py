"""Pages of a graded class as a browser shows them: styled, closed to the world, readable, and on paper."""

import pytest
from class_reports import class_of
from lab import picture

from hapticlab.course.cards.page_text import file_name
from hapticlab.grading.pages.pages import write_pages

#: of an A4 page within its margins [px]
PAPER = 674
#: the least contrast of any text with what is behind it, by WCAG 2.2, and that text
CONTRAST = """() => {
    const parts = (colour) => colour.match(/[\\d.]+/g).map(Number)
    const light = (colour) => {
        const [r, g, b] = parts(colour).map((c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b
    }
    const behind = (node) => {
        const colour = node ? getComputedStyle(node).backgroundColor : "rgb(255, 255, 255)"
        return parts(colour)[3] === 0 ? behind(node.parentElement) : colour
    }
    let least = [99, ""]
    for (const node of document.body.querySelectorAll("*")) {
        if (![...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim())) continue
        const style = getComputedStyle(node)
        const [a, b] = [light(node.closest("svg") ? style.fill : style.color), light(behind(node))]
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)
        if (ratio < least[0]) least = [ratio, node.textContent]
    }
    return least
}"""
WIDER = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"
#: what sticks out of the page
OUTSIDE = """() => [...document.body.querySelectorAll("*")]
    .filter((node) => !node.closest("svg") && node.getBoundingClientRect().right > innerWidth + 1)
    .map((node) => node.outerHTML.slice(0, 90))"""
#: heads of tables that are narrower than their longest word, which is then broken
BROKEN = """() => [...document.querySelectorAll("thead th")].filter((head) => {
    const asked = head.cloneNode(true)
    asked.style = "position: absolute; width: min-content; min-width: 0; overflow-wrap: normal; font-size: .875rem"
    document.body.append(asked)
    const least = asked.getBoundingClientRect().width
    asked.remove()
    return head.textContent.trim() && !head.querySelector(".upright") && head.getBoundingClientRect().width < least - 1
}).map((head) => head.textContent)"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Pages of a class; one student's name and text attack them."""
    reports, lab = class_of("01", 24)
    target = tmp_path_factory.mktemp("pages")
    write_pages(reports, target, lab=lab)
    return target


def whole_picture(page, name, width):
    """Keep a picture of all of a page."""
    page.set_viewport_size({"width": width, "height": 900})
    page.set_viewport_size({"width": width, "height": page.evaluate("() => document.documentElement.scrollHeight")})
    picture(page, name)


@pytest.mark.parametrize(("name", "shot"), [("class.html", "class"), (f"students/{file_name('sophie.germain')}.html", "student")])
@pytest.mark.always("students*")
def test_a_page_is_styled_readable_and_loads_nothing(browser, folder, name, shot):
    page = browser.new_context(viewport={"width": 1100, "height": 900}).new_page()
    said, asked = [], []
    page.on("console", lambda message: said.append(message.text))
    page.on("request", lambda request: asked.append(request.url))
    page.goto((folder / name).as_uri())
    assert page.evaluate("() => getComputedStyle(document.body).maxWidth") == "896px", "the policy lets the style in"
    assert page.evaluate("() => document.scripts.length") == 0
    assert page.evaluate(CONTRAST)[0] >= 4.5, page.evaluate(CONTRAST)
    whole_picture(page, f"grading-{shot}", 1100)
    for width in (1100, 400):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(WIDER) == 0, f"at {width} px"
        assert page.evaluate(BROKEN) == [], f"at {width} px"
    page.emulate_media(media="print")
    whole_picture(page, f"grading-{shot}-on-paper", PAPER)
    assert page.evaluate(OUTSIDE) == []
    assert page.pdf(format="A4").startswith(b"%PDF")
    assert said == [] and asked == [(folder / name).as_uri()]
    page.context.close()
