"""The page of a real paddle in a Chromium: a fake port with the firmware's core behind it, and a person's presses.

The board ticks in the page around the paddle's, by the clock; how long a motor was on is counted in the board's own ticks.
"""

import base64
import json
import os
from pathlib import Path

import pytest
from axe import findings
from core_in_node import WEB
from faults import FAULTS
from page_bench import SILENT, request

from hapticlab.device.link.messages import HOST_SILENCE_MS
from hapticlab.widgets.board_page.page import paddle_page
from hapticlab.widgets.browser_view import BROWSER

HERE = "https://paddle.test"
FAKE = BROWSER.parents[2] / "tests" / "widgets" / "board" / "fake_serial.js"
#: what plugs the board in: its store, its ticks by the clock, and the frame in which the paddle's page is
AROUND = """async ([wasm, store, known]) => {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))
  const cores = await Promise.all(Array.from({ length: 24 }, () => Board.open(bytes(wasm), bytes(store))))
  let begun = performance.now()
  window.frame = document.querySelector("iframe")
  window.board = new FakeBoard(cores, known)
  window.serial = new FakeSerial(null, () => frame.contentWindow.navigator.userActivation.isActive)
  // Make the ticks that are due. A computer that stalled makes up for few [ms]: in a burst nobody could say that he is there.
  window.ticks = (most = 30) => {
    begun = Math.max(begun, performance.now() - 1000 * board.time - most)
    board.run((performance.now() - begun) / 1000)
  }
  // Plug a board in whose handle is at 0, as another host said.
  window.plugIn = () => {
    Object.assign(board, { sensor: (counts) => counts, beyond: false, hand: 0, x: 0, v: 0 })
    board.reset()
    window.port = serial.port = new FakePort(board)
    board.tick()
    for (const [name, values] of [["HELLO", [9]], ["HOME", [0]]]) board.core.receive(encodeFrame(name, 1, values, { session: 9 }))
    board.core.transmit()
  }
  window.fail = (name) => board.core.core.hl_host_fault(board.core.board, TABLES.faults[name][0])
  plugIn()
  setInterval(() => ticks(), 1)
  frame.src = "/paddle.html#start=1;k=900"
}"""
DOCUMENT, WINDOW = "frame.contentDocument", "frame.contentWindow"
#: keeps what is written into pictures from here on
TEXTS = """() => {
  const write = CanvasRenderingContext2D.prototype.fillText
  window.texts = []
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
    texts.push(text)
    write.call(this, text, ...at)
  }
}"""
#: a press just after the motor went off starts nothing; the fake's tick is 1 ms
RESTED = "board.duties.slice(-1100).every((duty) => duty === 0)"
#: what a test made of the page's document and scene is as before
SEEN = f"""delete {DOCUMENT}.hidden
  {DOCUMENT}.dispatchEvent(new Event('visibilitychange'))
  {DOCUMENT}.querySelector('#hl-scene').selectedIndex = 0"""
#: in the paddle's page before its own scripts: the fake, and the board's tick of a press
IN_FRAME = """if (parent !== window) {
  Object.defineProperty(navigator, "serial", { get: () => parent.serial })
  for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, () => (parent.tick = parent.board.ticks), true)
}"""


@pytest.fixture(scope="module")
def asked():
    return request()


@pytest.fixture(scope="module")
def html(asked):
    return paddle_page(asked["data"])


class Bench:
    """A board, and a person before the page that drives it."""

    def __init__(self, browser, html, asked):
        self.errors, self.requests = [], []
        self.context = browser.new_context(viewport={"width": 900, "height": 900})
        self.context.add_init_script(IN_FRAME)
        self.context.on("request", lambda request: self.requests.append(request.url))
        answers = {f"{HERE}/": "<!DOCTYPE html><iframe style='width: 860px; height: 860px'></iframe>", f"{HERE}/gone": ""}

        def answer(route):
            url = route.request.url.partition("#")[0]
            route.fulfill(body=answers.get(url, html), content_type="text/html")

        self.context.route("**/*", answer)
        self.page = self.context.new_page()
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.goto(f"{HERE}/")
        scripts = [BROWSER / name for name in ("page/npz.js", "board/messages.js", "board/link.js", "board/core.js")]
        source = "\n".join(path.read_text("utf-8") for path in (*scripts, FAKE))
        self.page.add_script_tag(content=source)
        store = base64.b64encode(bytes.fromhex(asked["stores"]["usual"]).ljust(4096, b"\xff")).decode()
        self.page.evaluate(AROUND, [base64.b64encode(WEB.read_bytes()).decode(), store, asked["known"]])
        self.frame = self.page.frame_locator("iframe")
        self.frame.locator("#hl-connect").wait_for()

    @property
    def inside(self):
        return self.page.frames[1]

    def words(self):
        return self.frame.locator("#hl-words").inner_text()

    def status(self):
        status = self.frame.locator(".hl-status")
        return status.inner_text() if status.count() else ""

    def button(self, name):
        return self.frame.locator(f".hl-{name}")

    def connect(self):
        self.press(self.frame.locator("#hl-connect"), "said().includes('Motor off')")

    def press(self, button, done):
        """Press a button until something is so: a press that waited for a busy computer opens and starts nothing."""
        from playwright.sync_api import TimeoutError

        for _ in range(10):
            button.click()
            try:
                return self.until(done, timeout=3000)
            except TimeoutError:
                if "a script made it" not in self.words() and "Start came late" not in self.status():
                    break
        raise AssertionError(self.status())

    def until(self, condition, timeout=30_000):
        """Wait in the page around until a condition holds; ``said()`` is what the view says, ``heard()`` all that is said."""
        text = "(name) => frame.contentDocument?.querySelector(name)?.textContent ?? ''"
        words = f"const text = {text}, said = () => text('.hl-status'), heard = () => said() + text('#hl-words')"
        self.page.wait_for_function(f"() => {{ {words}; return {condition} }}", timeout=timeout)

    def start(self, hand=0.02):
        """Take the handle into the wall, and press Start."""
        self.page.evaluate("(hand) => { board.hand = hand }", hand)
        self.until(f"Math.abs(board.v) < 0.01 && board.x > 0.015 && {RESTED}")
        self.press(self.button("run"), "board.core.duty !== 0 && said().startsWith('Motor on')")

    def off_after(self, work, rest=250):
        """Do something, a text for the page around or a call; return the board's time until its motor was off [s].

        It counts from just before; for a call, from when an event in the page sets ``window.tick``.
        """
        if callable(work):
            self.page.evaluate("() => { window.tick = Infinity }")
            work(self)
        else:
            self.page.evaluate(f"async () => {{ window.tick = board.ticks; {work} }}")
        self.until(f"board.ticks > tick + {rest}")
        off = self.page.evaluate("board.offAfter(tick)")
        assert off is not None, self.status()
        return off

    def restore(self):
        """What a person does before the next Start: plug in a board, and connect again."""
        self.page.evaluate(f"() => {{ {SEEN} }}")
        if self.frame.locator("#hl-connect").inner_text() == "Disconnect":
            self.frame.locator("#hl-connect").click()
            self.until("heard().includes('Disconnected.')")
        self.page.evaluate("plugIn()")
        self.connect()

    def close(self):
        self.context.close()


@pytest.fixture
def bench(browser, html, asked):
    bench = Bench(browser, html, asked)
    yield bench
    bench.close()


def started(bench):
    """The names of all requests that reached the board."""
    return bench.page.evaluate("port.sent.flatMap((bytes) => new Decoder().feed(bytes)).map((frame) => frame.message)")


@pytest.mark.wide
def test_a_wall_is_felt_and_every_way_to_stop_stops_it(bench, tmp_path):
    page, frame = bench.page, bench.frame
    page.evaluate("frame.contentWindow.postMessage({ start: true, connect: true }, '*')")
    page.evaluate("frame.contentDocument.querySelector('#hl-connect').click()")  # a script's press is not a person's
    bench.until("frame.contentDocument.querySelector('#hl-words').textContent.includes('a script made it')")
    assert page.evaluate("[serial.asked.length, serial.gotten, port.sent.length]") == [0, 0, 0]
    bench.connect()
    facts = frame.locator("#hl-facts").inner_text()
    assert "host BEEF, firmware 2.0" in facts and "4 N" in facts and "2 m/s" in facts
    page.evaluate("board.hand = 0.02")
    page.evaluate("frame.contentDocument.querySelector('.hl-run').click()")
    bench.until("said().includes('Start came late')")
    assert "START" not in started(bench)

    bench.start()
    bench.until(
        "board.core.duty < -0.1 && Math.abs(8 * board.core.duty + 300 * (board.x - 0.01)) < 0.03"
    )  # Eq. (23.1); 8 N in full
    assert frame.locator(".hl-entry").first.input_value() == "300"
    entry = frame.locator(".hl-entry").first
    entry.fill("150")
    entry.press("Enter")
    bench.until("Math.abs(8 * board.core.duty + 150 * (board.x - 0.01)) < 0.03")
    page.screenshot(path=Path(os.environ.get("HAPTICLAB_ARTIFACTS", tmp_path), "paddle_page.png"))
    assert findings(bench.inside) == []
    heard = page.evaluate("port.sent.length")
    bench.until(f"port.sent.length > {heard} + 8")  # heartbeats go on by themselves

    stops = {
        "button": lambda _: frame.locator("#hl-stop").click(), "Space": lambda _: page.keyboard.press(" "),
        "Esc": lambda _: page.keyboard.press("Escape"), "P": lambda _: page.keyboard.press("p"),
    }  # fmt: skip
    for name, stop in stops.items():
        bench.button("run").focus() if name == "P" else entry.focus()
        off = bench.off_after(stop)
        print(f"{name}: motor off {1e3 * off:.0f} ms after it was pressed")
        assert off < 0.1  # a click ends when the finger is lifted
        bench.until("said().startsWith('Motor off')")
        bench.start()
    assert bench.errors == [] and {url.partition("#")[0] for url in bench.requests} == {f"{HERE}/", f"{HERE}/paddle.html"}
    assert "HOME" not in started(bench) and page.evaluate("serial.gotten") == 0


@pytest.mark.wide
def test_a_press_that_was_meant_for_stop_never_starts(bench):
    keys, mouse, run = bench.page.keyboard, bench.page.mouse, bench.button("run")

    def twice(_):
        for _ in range(2):
            keys.press(" ")

    def held(_):
        for _ in range(3):  # a key that is held comes again and again
            keys.down(" ")
        keys.up(" ")

    def after_a_fault(bench):
        bench.page.evaluate("tick = board.ticks; board.v = 4")
        bench.until("said().includes('OVER_SPEED')")
        keys.press("Enter")
        bench.until("said().includes('just now')")
        said = bench.frame.locator(".hl-said")
        assert said.evaluate("(said) => said.scrollHeight <= said.clientHeight"), "what to do is cut off"
        bench.inside.evaluate(TEXTS)
        bench.until(f"{WINDOW}.texts.some((text) => text.startsWith('motor'))")
        assert set(bench.inside.evaluate("texts.filter((text) => text.startsWith('motor'))")) == {"motor 0.0 N"}

    def dragged(_):
        mouse.down()
        bench.until("said().startsWith('Motor off')")
        mouse.move(5, 5)
        mouse.up()

    def double(_):
        run.dblclick()

    def listed(_):
        bench.frame.locator("#hl-scene").click()
        bench.until("said().includes('A list, a menu')")
        keys.press("Escape")

    def menu(_):
        bench.frame.locator(".hl-stage").click(button="right")
        bench.until("said().includes('A list, a menu')")

    bench.connect()
    for stop in (twice, held, after_a_fault, dragged, double, listed, menu):
        bench.start()
        starts = started(bench).count("START")
        run.focus()
        box = bench.frame.locator("#hl-stop").bounding_box()
        mouse.move(box["x"] + 9, box["y"] + 9)
        off = bench.off_after(stop)
        print(f"{stop.__name__}: motor off {1e3 * off:.0f} ms after it")
        assert off < 0.1 and started(bench).count("START") == starts, stop.__name__
    run.focus()
    keys.press(" ")
    bench.until("said().includes('Space only stops')")
    assert bench.errors == []


HIDE = f"""Object.defineProperty({DOCUMENT}, 'hidden', {{ get: () => true, configurable: true }})
  {DOCUMENT}.dispatchEvent(new Event('visibilitychange'))"""
CHOOSE = f"""const scene = {DOCUMENT}.querySelector('#hl-scene')
  scene.selectedIndex = 1
  scene.dispatchEvent(new Event('change'))"""
NOISE = "port.onWay = port.onWire = (bytes) => bytes.map((byte, k) => (byte * 37 + k * 11 + 5) & 255)"
FREEZE = "const counts = Math.round(board.x / board.known.metres_per_count); board.sensor = () => counts"
#: what happens to a page whose motor is on; the longest time until it is off by the board's ticks [s]; and words of the page
HAPPENS = {
    "page hidden": (HIDE, 0.005, "The page was hidden"),
    "page frozen by the browser": (f"{DOCUMENT}.dispatchEvent(new Event('freeze'))", 0.005, "The page was hidden"),
    "page about to be left": (f"{WINDOW}.dispatchEvent(new Event('pagehide'))", 0.005, "Disconnected."),
    "page blocked": (
        "for (const until = performance.now() + 300; performance.now() < until; ) {} ticks(300)",
        SILENT,
        "this page was stopped",
    ),
    "another scene chosen": (CHOOSE, 0.005, "Motor off"),
    "over-speed": ("board.v = 4", FAULTS["over-speed"].within, "OVER_SPEED"),
    "over-travel": ("board.beyond = true; board.x = board.hand = 0.056", FAULTS["over-travel"].within, "OVER_TRAVEL"),
    "sensor's wire": ("fail('SENSOR')", FAULTS["sensor's wire"].within, "SENSOR"),
    "sensor frozen": (FREEZE, FAULTS["sensor frozen"].within, "FROZEN"),
    "program damaged": ("board.core.damageProgram(40, 1)", FAULTS["program damaged in memory"].within, "BAD_PROGRAM"),
    "board reset": ("board.reset()", 0.002, "was reset"),
    "unplugged": ("port.unplug()", SILENT, "disconnected during use"),
    "device accepts no data": ("port.stuck = true", SILENT, "accepted no data"),
    "garbage": (NOISE, SILENT, "did not answer"),
}


@pytest.fixture(scope="module")
def happened(browser, html, asked):
    """(time until the motor was off, new starts) of all that happens to one page: each time Start is pressed again."""
    bench, found = Bench(browser, html, asked), {}
    bench.connect()
    for name, (work, within, words) in HAPPENS.items():
        bench.start()
        starts = started(bench).count("START")
        off = bench.off_after(work, rest=round(1000 * within) + 150)
        bench.until(f"heard().includes({json.dumps(words)})")
        found[name] = off, started(bench).count("START") - starts  # nothing starts again by itself
        bench.restore()
    bench.close()
    return found


@pytest.mark.wide
@pytest.mark.parametrize("name", HAPPENS)
def test_the_motor_goes_off_in_the_stated_time(happened, name, record_property):
    off, starts = happened[name]
    within = HAPPENS[name][1]
    record_property("motor_off_after_s", off)
    print(f"{name}: motor off {1e3 * off:.0f} ms after it, stated {1e3 * within:.0f} ms")
    assert 0 <= off <= within + 1e-9 and starts == 0


#: a board that says hello by other tables
OTHER = """() => {
  port.onWire = (bytes) => {
    const frame = decodeFrame(bytes.slice(0, bytes.indexOf(0)))
    if (frame?.message !== "WELCOME") return bytes
    const { table, ...rest } = fieldsOf(frame)
    return encodeFrame("WELCOME", frame.sequence, [table ^ 1, ...Object.values(rest)])
  }
}"""
LEAVE = f"""const gone = new Promise((done) => frame.addEventListener('load', done, {{ once: true }}))
  {WINDOW}.addEventListener('pagehide', () => {{ window.tick = board.ticks }}, true)
  frame.src = '/gone'
  await gone"""
THROW = "setTimeout(() => { parent.tick = parent.board.ticks; throw new Error('a mistake') })"


@pytest.mark.wide
@pytest.mark.parametrize("name", ["left", "error"])
def test_a_page_that_is_left_or_broken_says_stop(bench, name):
    bench.connect()
    bench.start()
    off = bench.off_after(LEAVE if name == "left" else lambda bench: bench.inside.evaluate(THROW))
    print(f"page {name}: motor off {1e3 * off:.0f} ms after it")
    assert off <= 0.005
    if name == "error":
        bench.until("heard().includes('a mistake')")
        assert bench.frame.locator("#hl-connect").is_disabled()
    assert started(bench).count("START") == 1 and HOST_SILENCE_MS == 100


@pytest.mark.wide
def test_a_board_of_another_version_is_asked_for_nothing_more(bench):
    bench.page.evaluate(OTHER)
    bench.frame.locator("#hl-connect").click()
    bench.until("heard().includes('a different version of the messages') && port.closed")
    assert set(started(bench)) == {"HELLO"}


@pytest.mark.wide
def test_a_port_that_is_taken_and_a_browser_without_ports_are_told(bench):
    bench.page.evaluate("port.taken = true")
    bench.frame.locator("#hl-connect").click()
    bench.until("frame.contentDocument.querySelector('#hl-words').textContent.includes('Another tab or program')")
    bench.page.evaluate("port.taken = false")
    bench.connect()  # and then again
    bench.frame.locator("#hl-connect").click()
    bench.until("frame.contentDocument.querySelector('#hl-words').textContent === 'Disconnected.' && port.closed")
    bench.page.evaluate("serial = undefined")
    bench.inside.evaluate("location.reload()")
    bench.until("frame.contentDocument?.querySelector('#hl-words')?.textContent.includes('Use Chrome or Edge')")
