"""The site of the documentation in Chromium: nothing is loaded from elsewhere, pages fit a phone, and what axe-core finds.

The small form of the site; `.ci/full docs` builds the whole one, and opens more pages of it. DOCUMENTATION in the environment is
the folder of a site that is built already. Site and pictures of pages stay in the folder that HAPTICLAB_ARTIFACTS names.
"""

import os
from functools import partial
from pathlib import Path

import pytest
from axe import findings
from builder.whole import build
from sites import Quiet, serving, visited

import hapticlab as hl

pytestmark = [pytest.mark.wide, pytest.mark.timeout(900)]  # a build reads 430 pages

#: a page of each kind
PAGES = (
    "index", "how_to/live", "papers/abbott_okamura_2005", "paddle/owners_guide", "reference/design/coupler", "gallery/wall",
    "labs/02_virtual_wall",
)  # fmt: skip
#: which `.ci/full` opens too; the small form lacks some
OTHERS = (
    "how_to/scenes", "project/licences", "labs/index", "reference/commands", "reference/chapter", "reference/glossary",
    "gallery/index", "gallery/detents", "gallery/figures/passivity",
)  # fmt: skip
ARTIFACTS = Path(os.environ["HAPTICLAB_ARTIFACTS"]) if "HAPTICLAB_ARTIFACTS" in os.environ else None
#: for how long MathJax may set a page [ms]
TYPESET = 20_000
WIDTHS = {"wide": 1280, "narrow": 390}


@pytest.fixture(scope="module")
def site(complete, tmp_path_factory):
    """The address of the site."""
    folder = os.environ.get("DOCUMENTATION")
    if not folder:
        folder = (ARTIFACTS or tmp_path_factory.mktemp("documentation")) / "small_documentation"
        build(folder, quick=True, say=lambda words: None)
    with serving(partial(Quiet, directory=folder)) as server:
        yield f"http://127.0.0.1:{server.server_port}", Path(folder)


def expect(what):
    """What Playwright waits for; it is not there wherever these tests are collected."""
    from playwright.sync_api import expect

    return expect(what)


def looked_at(browser, site, name, *, width, scheme):
    """Open a page as a new visitor and return how far it is wider than the window, and what axe-core finds."""
    address, _ = site
    with visited(browser, width=WIDTHS[width], color_scheme=scheme) as page:
        failed = []
        page.on("response", lambda response: failed.append(response.url) if response.status >= 400 else None)
        page.on("pageerror", lambda error: failed.append(str(error)))
        page.goto(f"{address}/{name}.html")
        page.wait_for_function("window.MathJax?.startup?.promise?.then(() => true) ?? true", timeout=TYPESET)
        assert page.evaluate("document.documentElement.dataset.theme") == scheme
        if ARTIFACTS:
            page.screenshot(path=ARTIFACTS / f"documentation-{name.replace('/', '-')}-{width}-{scheme}.png")
        beyond = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert failed == []
        return beyond, findings(page)


def look(browser, site, names, width, scheme):
    """Hold that pages fit, are usable, and load nothing from elsewhere."""
    looked = {name: looked_at(browser, site, name, width=width, scheme=scheme) for name in names}
    assert looked == {name: (0, []) for name in names}


@pytest.mark.parametrize("width, scheme", [("wide", "dark"), ("narrow", "light")])
def test_pages_fit_are_usable_and_load_nothing_from_elsewhere(browser, site, width, scheme):
    look(browser, site, PAGES, width, scheme)


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", WIDTHS)
def test_more_pages_in_both_schemes(browser, site, width, scheme):
    others = [name for name in OTHERS if (site[1] / f"{name}.html").is_file()]
    look(browser, site, (*PAGES, *others), width, scheme)


def test_search_finds_a_page_and_a_wrong_address_leads_back(browser, site):
    with visited(browser) as page:
        page.goto(f"{site[0]}/search.html?q=chatter")
        page.wait_for_selector("#search-results li a")
        page.goto(f"{site[0]}/404.html")
        page.fill("input", "passivity")
        page.click("button")
        page.wait_for_selector("#search-results li a")


def test_a_live_view_of_a_page_moves(browser, site):
    with visited(browser) as page:
        page.goto(f"{site[0]}/how_to/live.html")
        frame = page.locator("iframe").first
        frame.scroll_into_view_if_needed()
        canvas = frame.content_frame.locator("canvas").first
        canvas.wait_for()
        shot = canvas.screenshot()
        box = canvas.bounding_box()
        page.mouse.move(box["x"] + box["width"] / 3, box["y"] + box["height"] / 2)
        page.mouse.down()
        page.mouse.move(box["x"] + box["width"] * 2 / 3, box["y"] + box["height"] / 2, steps=8)
        page.wait_for_function(
            "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
        )
        assert canvas.screenshot() != shot
        page.mouse.up()


def test_the_wall_of_the_front_page_chatters_under_the_pointer_and_a_soft_one_does_not(browser, site):
    with visited(browser, width=WIDTHS["wide"]) as page:
        page.goto(f"{site[0]}/index.html")
        frame = page.locator("iframe").content_frame
        frame.locator(".hl-live:not(.hl-silent)").wait_for()
        stage, found = frame.locator(".hl-stage"), {}
        stage.scroll_into_view_if_needed()
        for stiffness in (4000, 500):
            frame.locator(".hl-entry").first.fill(str(stiffness))
            frame.locator(".hl-entry").first.press("Enter")
            box = stage.bounding_box()
            middle, half = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            page.mouse.move(middle, half)
            page.mouse.down()
            page.mouse.move(middle + 0.11 * box["width"], half, steps=8)
            page.wait_for_timeout(500)
            page.keyboard.press("r")
            page.wait_for_timeout(1500)
            page.keyboard.press("r")
            with page.expect_download() as saved:
                page.keyboard.press("s")
            found[stiffness] = hl.chatter(hl.records.Telemetry.load(saved.value.path()))
            page.mouse.move(middle, half, steps=5)
            page.mouse.up()
    assert found[4000].amplitude > 0.5e-3 and found[4000].contacts_per_second > 20
    assert found[500].amplitude < 0.02e-3 and found[500].contacts_per_second == 0


def test_a_frame_takes_the_theme_and_the_values_that_its_page_gives(browser, site):
    with visited(browser, color_scheme="light") as page:
        page.goto(f"{site[0]}/gallery/wall.html")
        page.locator("iframe").scroll_into_view_if_needed()
        inside = page.locator("iframe").content_frame
        inside.locator(".hl-live:not(.hl-silent)").wait_for()
        page.evaluate("document.documentElement.dataset.theme = 'dark'")
        expect(inside.locator("body")).to_have_css("background-color", "rgb(22, 22, 22)")
        page.get_by_role("link", name="k=500N/m", exact=True).click()
        expect(inside.locator(".hl-entry").first).to_have_value("500")
        assert inside.locator("#hl-told").inner_text() == ""
