"""A shared file as its reader has it: opened from the disk by a double click, or in a frame of another page."""

import re
from pathlib import Path

import numpy as np
import pytest
from axe import findings
from lab import picture

import hapticlab as hl
from hapticlab.device.simulated.stepping import Stepping

PADDLE = hl.SimulatedPaddle.from_profile("eth", hand=hl.Hand("pinch"))
SCENES = {"wall": hl.wall()(k=300, x_o=0.01), "fixtures": hl.library.virtual_fixture(), "linkage": hl.library.four_bar()}
TIME = "() => Number(document.querySelector('.hl-time').textContent.match(/[0-9.]+/)?.[0])"
CODE = "document.getElementById('hl-code').textContent"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shared")
    return {name: hl.share(scene, PADDLE, folder / f"{name}.html").path.as_uri() for name, scene in SCENES.items()}


@pytest.fixture
def opened(browser, files):
    """Open a file with an address; any error of its scripts fails the test, and so does a request beyond it."""
    contexts, wrong = [], []

    def open_file(name="wall", address="", **options):
        context = browser.new_context(**{"accept_downloads": True, **options})
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: request.url.startswith(("file:", "data:", "blob:")) or wrong.append(request.url))
        page.goto(files[name] + address)
        page.wait_for_selector(".hl-live:not(.hl-silent)")
        return page

    yield open_file
    for context in contexts:
        context.close()
    assert not wrong


def expect(what):
    """What Playwright waits for; it is not there wherever these tests are collected."""
    from playwright.sync_api import expect

    return expect(what)


def field(page, name):
    """The field of a parameter."""
    return page.get_by_role("spinbutton", name=re.compile(rf"^{name}\b"))


def type_in(page, name, value):
    field(page, name).fill(value)
    field(page, name).press("Enter")


def comes_to(page, address):
    expect(page).to_have_url(re.compile(rf"\.html{re.escape(address)}$"))


def test_what_a_visitor_changes_stands_in_the_address_and_in_the_code(opened):
    page = opened(address="#k=150N/m;slow-motion", color_scheme="dark", viewport={"width": 390, "height": 900})
    assert findings(page) == []
    page.set_viewport_size({"width": 320, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= 320  # WCAG 2.2, 1.4.10
    assert field(page, "k").input_value() == "150"
    slow = page.get_by_role("button", name="Slow")
    expect(slow).to_have_attribute("aria-pressed", "true")
    expect(page.locator("#hl-code")).to_contain_text("scene = scene(k=150)")
    type_in(page, "x_o", "12")
    page.get_by_role("button", name="E drawn").click()
    comes_to(page, "#k=150N/m;x_o=12mm;slow-motion;traces=x,F")
    names = {}
    exec(page.evaluate(CODE).replace("hl.share(scene, paddle)", ""), names)
    assert names["scene"] == hl.wall()(k=150, x_o=0.012) and names["paddle"].T == PADDLE.T
    page.locator(".hl-stage").press("x")
    comes_to(page, "")
    expect(field(page, "x_o")).to_have_value("10")
    expect(page.locator("#hl-code")).not_to_contain_text("150")
    expect(slow).to_have_attribute("aria-pressed", "false")
    page.evaluate("location.hash = '#k=0.4N/mm'")
    expect(field(page, "k")).to_have_value("400")


@pytest.mark.wide
def test_what_an_address_cannot_set_is_told_in_the_words_of_python(opened):
    page = opened(address="#k=-5;x_o=12mm;q=3;__proto__=1;B=1e999;<img src=x onerror=alert(1)>=2")
    told = page.locator("#hl-told span").all_inner_texts()
    assert len(told) == 4 and told[-1] == "2 more parts of the address cannot be used."
    assert page.locator("#hl-told img").count() == 0
    assert field(page, "x_o").input_value() == "12" and field(page, "k").input_value() == "300"
    page = opened(address="#k=-5&real-time")
    with pytest.raises(hl.errors.ParameterError) as refused:
        SCENES["wall"](k=-5)
    assert page.locator("#hl-told").inner_text() == str(refused.value)


@pytest.mark.wide
def test_a_tick_at_a_time_while_paused_and_not_while_a_number_is_typed(opened):
    page = opened()
    stage, status = page.locator(".hl-stage"), page.locator(".hl-status")
    stage.press("a")
    stage.press("p")
    stage.press("n")
    expect(status).to_have_text(re.compile(r"Tick \d+:"))
    before = int(re.search(r"Tick (\d+)", status.inner_text())[1])
    stage.press("n")
    expect(status).to_contain_text(f"Tick {before + 1}:")
    expect(page.locator(".hl-spoken")).to_contain_text(f"Tick {before + 1}:")
    type_in(page, "k", "310")
    field(page, "k").press("x")
    comes_to(page, "#k=310N/m")
    page.get_by_text("Help", exact=True).click()
    assert "N next tick, C save as CSV, X reset all" in page.locator(".hl-help").inner_text()


@pytest.mark.wide
def test_a_recording_is_a_file_that_python_reads(opened, tmp_path):
    page = opened()
    stage = page.locator(".hl-stage")
    for key in ("r", *["ArrowRight"] * 6):
        stage.press(key)
    page.wait_for_function(f"() => ({TIME})() >= 0")  # before the first frame no time is shown
    begun = page.evaluate(TIME)
    page.wait_for_function(f"() => ({TIME})() > {begun} + 0.3")
    stage.press("r")
    page.wait_for_selector(".hl-save[aria-disabled=false]")
    with page.expect_download() as kept:
        stage.press("s")
    path = tmp_path / kept.value.suggested_filename
    kept.value.save_as(path)
    log = hl.records.Telemetry.load(path)
    assert path.name == "zoh_wall-1.npz" and len(log) > 50 and log.T == PADDLE.T and log.parameters == dict(SCENES["wall"].values)
    again = Stepping(PADDLE, SCENES["wall"]).advance(np.append(log.intent, log.intent[-1]))
    assert np.array_equal(again["x"], log.x) and np.array_equal(again["F"], log.F)
    with page.expect_download() as kept:
        stage.press("c")
    stage.press("y")
    expect(page.locator(".hl-status")).to_contain_text("Replaying a record")
    table = kept.value.path().read_text()
    expected = log.to_csv(tmp_path / "own.csv").read_text()
    assert table.split("\n")[0] == expected.split("\n")[0]
    rows = [np.array([line.split(",") for line in text.split("\n")[1:-1]], float) for text in (table, expected)]
    assert np.array_equal(*rows, equal_nan=True)


@pytest.mark.wide
def test_code_is_copied_or_selected_where_that_is_not_allowed(opened):
    page = opened()
    page.evaluate("Object.defineProperty(navigator, 'clipboard', { value: undefined })")
    page.get_by_role("button", name="Copy").click()
    assert page.evaluate("getSelection().toString()").strip() == page.evaluate(CODE).strip()
    assert page.locator("#hl-copied").inner_text().startswith("Selected")


@pytest.mark.wide
def test_a_page_runs_in_a_low_frame_without_its_own_origin(browser, files):
    page = browser.new_page(viewport={"width": 390, "height": 700})
    page.set_content("<iframe sandbox='allow-scripts' width='380' height='320'></iframe>")
    text = Path(files["wall"].removeprefix("file://")).read_text("utf-8")
    page.evaluate("(text) => (document.querySelector('iframe').srcdoc = text)", text)
    frame = page.frame_locator("iframe")
    frame.locator(".hl-live:not(.hl-silent)").wait_for()
    frame.locator(".hl-entry").nth(1).fill("350")
    frame.locator(".hl-entry").nth(1).press("Enter")
    frame.locator("#hl-code", has_text="k=350").wait_for()
    for key in ("r", "ArrowRight", "s"):
        frame.locator(".hl-stage").press(key)
    expect(frame.locator(".hl-status")).to_contain_text("if the page around this frame allows downloads")
    for theme, paper in (("dark", "rgb(22, 22, 22)"), ("none", "rgb(22, 22, 22)"), ("light", "rgb(255, 255, 255)")):
        page.evaluate("(theme) => document.querySelector('iframe').contentWindow.postMessage({ theme }, '*')", theme)
        expect(frame.locator("body")).to_have_css("background-color", paper)
    page.close()


LOOKS = [(name, scheme, width) for name in SCENES for scheme in ("light", "dark") for width in (390, 1280)]
WIDE = ("fixtures", "light", 1280), ("linkage", "dark", 390)


@pytest.mark.parametrize(
    ("name", "scheme", "width"),
    [pytest.param(*look, marks=pytest.mark.wide if look in WIDE else pytest.mark.slow) for look in LOOKS],
)
def test_everybody_can_use_it(opened, name, scheme, width):
    page = opened(name, color_scheme=scheme, viewport={"width": width, "height": 900})
    assert findings(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    picture(page, f"shared_{name}_{scheme}_{width}")
    assert page.title() and page.evaluate("document.documentElement.lang") == "en"


@pytest.mark.wide
def test_without_scripts_the_page_shows_its_picture_its_equations_and_what_to_do(browser, files):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(files["linkage"])
    assert page.get_by_role("img", name="first picture").bounding_box()["height"] > 100
    assert "needs JavaScript" in page.locator("#hl-view").inner_text()
    assert page.locator("math").count() == len(SCENES["linkage"]._equations())
    context.close()


@pytest.mark.wide
def test_a_browser_without_webassembly_says_what_to_do(browser, files):
    page = browser.new_page()
    page.add_init_script("delete window.WebAssembly")
    page.goto(files["wall"])
    assert "does not run WebAssembly" in page.get_by_role("alert").inner_text()
    page.close()
