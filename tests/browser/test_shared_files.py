"""A shared file in Chromium as a double click opens it: it moves, asks for nothing, and runs nobody else's script."""

import pytest

import hapticlab as hl
from hapticlab.library.sketch import Sketch

PADDLE = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
STAGE, STATUS = "canvas.hl-stage", ".hl-status"
# None before the first readout.
NUMBERS = "() => (document.querySelector('.hl-readout').textContent.match(/-?[0-9.]+/g) ?? []).map(Number)"
# Whether position and force are as they were when this was asked before.
STANDS = f"() => {{ const now = ({NUMBERS})().slice(0, 2).join(), was = window.was; window.was = now; return now === was }}"
TIME = "() => Number(document.querySelector('.hl-time').textContent.match(/[0-9.]+/)?.[0])"
INJECTED = "() => document.head.append(Object.assign(document.createElement('script'), { textContent: 'window.stolen = 3' }))"
HOSTILE = "</script><img src=x onerror='window.stolen = 1'><script>window.stolen = 2</script>"


def labelled(axes, *, x):
    """A handle, and a label that is hostile."""
    sketch = Sketch(axes, -0.05, 0.05, -0.013, 0.013)
    sketch.handle(x)
    sketch.text((x, 0.0), HOSTILE)


def open_file(browser, path):
    """Open a file in a page of its own; return the page, and what it asks for and complains of."""
    page, heard = browser.new_page(viewport={"width": 1000, "height": 800}), []
    page.on("request", lambda request: heard.append(request.url))
    page.on("console", lambda message: heard.append(message.text))
    page.on("pageerror", lambda error: heard.append(str(error)))
    page.goto(path.as_uri())
    page.wait_for_function("() => document.querySelector('.hl-status')?.textContent.startsWith('Running')")
    return page, heard


@pytest.fixture(scope="module")
def opened(browser, tmp_path_factory):
    """A wall whose name is hostile, and a label in its picture."""
    wall = hl.wall()(k=300, x_o=0.01)
    path = tmp_path_factory.mktemp("shared") / "wall.html"
    hl.share(hl.Scene(force=wall.force, name=HOSTILE)(**wall.values), PADDLE, path, picture=labelled)
    page, heard = open_file(browser, path)
    yield page, heard, path
    page.close()


def test_a_hand_feels_the_wall_and_nothing_is_asked_for(opened):
    page, heard, path = opened
    box = page.locator(STAGE).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 200, y, steps=8)
    page.wait_for_function(f"() => ({NUMBERS})()[1] > 0.5")
    page.wait_for_function(STANDS, polling=600)
    page.mouse.up()
    x, force, *_ = page.evaluate(NUMBERS)
    assert force == pytest.approx(300 * (1e-3 * x - 0.01), abs=0.02)  # Eq. (23.1), x shown to 0.1 mm
    assert heard == [path.as_uri()]


def test_a_hostile_name_is_a_title_and_no_script(opened):
    page, *_ = opened
    assert page.evaluate("window.stolen") is None
    assert page.locator("h1").inner_text() == HOSTILE == page.title()
    assert page.locator("img[src=x]").count() == 0
    page.evaluate(INJECTED)
    assert page.evaluate("window.stolen") is None


@pytest.mark.wide
def test_a_value_that_is_refused_goes_back_and_says_why(opened):
    page, *_ = opened
    entry = page.locator(".hl-slider:has-text('k') .hl-entry").first
    entry.fill("450")
    entry.press("Enter")
    page.wait_for_function(
        "() => [...document.querySelectorAll('.hl-slider input[type=range]')].some((one) => one.value === '450')"
    )
    entry.fill("-5")
    entry.press("Enter")
    page.wait_for_function("() => document.querySelector('.hl-status').textContent.includes('a stiffness needs k >= 0')")
    page.wait_for_function(
        "() => [...document.querySelectorAll('.hl-slider input[type=range]')].some((one) => one.value === '450')"
    )


@pytest.mark.wide
def test_a_hidden_page_stands_still(opened):
    page, *_ = opened
    page.evaluate("() => { document.querySelector('main').style.display = 'none' }")
    page.wait_for_function(
        f"() => {{ const now = ({TIME})(), was = window.before; window.before = now; return now === was }}", polling=600
    )
    before = page.evaluate(TIME)
    page.evaluate("() => { document.querySelector('main').style.display = '' }")
    after = page.wait_for_function(f"() => ({TIME})() > {before} && ({TIME})()").json_value()
    assert after < before + 0.5  # what passed meanwhile is not made up for
