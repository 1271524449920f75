"""What the view shows while the kernel says nothing, by a clock that the test turns."""

import pytest
from scripts import add_scripts

from hapticlab.widgets.frame import COLUMNS
from hapticlab.widgets.session import PRESSES

ABOUT = {
    "title": "a wall", "kind": "board", "box": [-0.03, 0.03, -0.01, 0.01], "x_range": [-0.03, 0.03], "along": [1, 0],
    "help": "", "overview": "", "speed": 1, "seconds": 4, "presses": list(PRESSES), "columns": list(COLUMNS), "T": 1e-3,
    "apart": 1e-3, "touches": True, "loop": True,
    "parameters": [
        {"name": name, "value": 0.03, "low": 0, "high": 0.09, "limit_words": f"{name} >= 0", "at_start": late}
        | {"scale": 1e3, "unit_shown": "mm"}
        for name, late in (("l", False), ("h", True))
    ],
    "traces": [{"name": "x", "label": "x", "unit_shown": "mm", "scale": 1000, "open": True}],
}  # fmt: skip
# A view whose model notes what is said [kind, value, clock], and a kernel that sends a frame without rows.
OPEN = """(about) => {
  window.said = []
  let receive
  const model = {
    get: () => about, on: (event, act) => (receive = act), off: () => {},
    send: (content, callbacks, [data]) => said.push([...new Float64Array(data).slice(1)]),
  }
  window.view = new parts.View(new parts.Kernel(model), document.body)
  window.frame = (content) => receive(content, [new DataView(new Float64Array([performance.now() / 1000, 0, 0]).buffer)])
  const off = (element) => element.ariaDisabled === "true"
  const { run, record } = view.controls.buttons
  window.shown = () => [view.status.textContent, run.textContent.trim(), off(run), off(record), off(view.sliders[0].range)]
}"""


@pytest.fixture
def page(browser):
    page = browser.new_page()
    page.clock.install(time=0)
    add_scripts(page)
    page.evaluate(OPEN, ABOUT)
    page.wait_for_function("() => view.source.seen", polling=20)
    page.clock.pause_at(1000)
    yield page
    page.close()


def presses(page):
    return [PRESSES[int(value)] for kind, value, *_ in page.evaluate("said") if kind == 6]


@pytest.mark.wide
def test_without_a_kernel_nothing_can_be_pressed(page):
    words, button, *off = page.evaluate("shown()")
    assert words == "Waiting for the kernel: this moves in a running notebook only."
    assert "Start motor" in button and off == [True, True, True]
    page.evaluate("view.controls.press('run')")
    assert presses(page) == []


def test_a_silent_kernel_is_told_and_only_stop_can_be_pressed(page):
    on = {"flags": {"running": True, "motor": True}, "status": "Motor on, not in contact.", "values": {}}
    page.evaluate("(on) => frame(on)", on)
    assert page.evaluate("shown()")[0] == "Motor on, not in contact."
    assert page.evaluate("shown()")[2:] == [False, False, False]
    page.clock.run_for(1300)
    assert page.evaluate("shown()")[0] == "Motor on, not in contact."
    page.clock.run_for(2000)
    words, button, *off = page.evaluate("shown()")
    assert words == "The kernel has not answered for 3 s. It may be busy with a cell, or gone. The motor switches off by itself."
    assert "Stop motor" in button and off == [False, True, True]
    page.evaluate("view.controls.press('record'); view.controls.press('run')")
    assert presses(page) == ["pause"]
    page.evaluate("frame({ flags: { running: false }, values: {} })")
    words, button, *off = page.evaluate("shown()")
    assert words == "Motor on, not in contact." and off == [False, False, False]  # what the kernel said last
    page.evaluate("view.controls.press('run')")
    kind, value, clock = page.evaluate("said.at(-1)")
    assert (kind, PRESSES[value]) == (6, "start")
    assert clock == page.evaluate("Date.now() / 1000")  # so that one that waits is known by its age


def test_a_hidden_tab_stops_a_motor_and_keeps_few_frames(page):
    page.evaluate("Object.defineProperty(document, 'hidden', { get: () => true })")
    page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    page.clock.run_for(2900)
    assert presses(page) == []
    page.clock.run_for(200)
    assert presses(page) == ["pause"]
    waiting = page.evaluate(
        """() => {
            const playback = new parts.Playback()
            for (let k = 0; k < 6000; k++) playback.push({ sent: k / 60 }, k / 60)
            return playback.queue.map((frame) => frame.sent)
        }"""
    )
    assert waiting[-1] == pytest.approx(5999 / 60) and waiting[0] == pytest.approx(waiting[-1] - 5)


# Settles once the view was scrolled out of sight, or back into it: a younger observer is told after the view's own.
SIGHT = """(on) => new Promise((done) => {
  const observer = new IntersectionObserver((entries) => {
    if (entries.at(-1).isIntersecting !== on) return
    observer.disconnect()
    done(on)
  })
  observer.observe(view.root)
})"""
OFF = {"flags": {"running": False, "motor": False}, "status": "Motor off.", "values": {}}
ON = {"flags": {"running": True, "motor": True}, "status": "Motor on.", "values": {}}


@pytest.mark.always("p")
@pytest.mark.parametrize("key", ["p", "Enter", "a"])
def test_a_view_out_of_sight_starts_no_motor_and_stops_one(page, key):
    page.evaluate("frame", ON if key == "a" else OFF)
    page.evaluate("view.controls.buttons.run.focus()")
    page.evaluate("document.body.appendChild(document.createElement('div')).style.height = '5000px'")
    page.evaluate("scrollTo(0, 5000)")
    page.evaluate(SIGHT, False)
    page.keyboard.press(key)  # the focus is still in the view
    assert presses(page) == []
    page.evaluate(SIGHT, True)  # but the view comes back, so that the next press is seen
    page.keyboard.press(key)
    assert presses(page) == [{"a": "restart"}.get(key, "start")]
    page.evaluate("frame", ON)
    page.evaluate("scrollTo(0, 5000)")
    page.evaluate(SIGHT, False)
    page.keyboard.press("p")
    assert presses(page)[1:] == ["pause"]
    page.clock.run_for(3100)
    assert presses(page)[1:] == ["pause", "pause"]


@pytest.mark.always("p")
@pytest.mark.parametrize("key", ["p", "a", "Enter"])
def test_a_key_that_is_held_is_one_press(page, key):
    page.evaluate("frame", ON)
    page.evaluate("view.controls.buttons.run.focus()")
    for _ in range(4):  # from the second on as a keyboard repeats it
        page.keyboard.down(key)
        page.evaluate("frame", ON if key == "a" else OFF)
    page.keyboard.up(key)
    assert presses(page) == ["restart" if key == "a" else "pause"]


SIMULATED = {**ABOUT, "kind": "simulated", "let_go": False, "slow": 0.02}


def other(page, about):
    """Show another view instead, once it is seen."""
    page.evaluate("view.close(), view.root.remove()")
    page.evaluate(OPEN, about)
    page.evaluate(SIGHT, True)


def test_while_nobody_hears_it_a_hand_moves_nothing(page):
    other(page, SIMULATED)
    moved = "said.filter(([kind]) => kind === 3 || kind === 4).length"
    assert page.evaluate("view.stage.ariaDisabled") == "true"
    box = page.locator("canvas.hl-stage").bounding_box()
    for heard in (False, True):
        page.mouse.move(box["x"] + 100, box["y"] + 50)
        page.mouse.down()
        page.mouse.move(box["x"] + 200, box["y"] + 50)
        page.mouse.up()
        page.evaluate("view.stage.focus()")
        page.keyboard.press("ArrowRight")
        assert bool(page.evaluate(moved)) is heard
        page.evaluate("frame", {"flags": {"running": True, "held": True}, "values": {}})
    assert page.evaluate("view.stage.ariaDisabled") == "false"


@pytest.mark.wide
def test_slow_is_pressed_at_its_own_speed_and_keys_can_be_off(page):
    other(page, {**SIMULATED, "keys": False})
    for speed, pressed in ((0.1, "false"), (0.02, "true")):
        page.evaluate("frame", {"flags": {"running": True, "speed": speed, "T": 2e-3, "apart": 2e-3}, "values": {}})
        assert page.evaluate("view.controls.buttons.slow.ariaPressed") == pressed
    assert page.evaluate("[view.samples.T, view.samples.apart]") == [2e-3, 2e-3]  # those of a record that is replayed
    page.evaluate("view.stage.focus()")
    for key in "pamryl":
        page.keyboard.press(key)
    assert presses(page) == [] and page.evaluate("said.filter(([kind]) => kind === 4)") == []


@pytest.mark.wide
def test_a_number_with_two_meanings_is_told_with_both(page):
    page.evaluate("frame", OFF)
    entry = page.locator("input.hl-entry").first
    entry.fill("1,000")
    entry.press("Enter")
    assert page.locator(".hl-limits").first.text_content() == "“1,000” could be 1 or 1000: type one of these; l stays at 30 mm"


@pytest.mark.wide
def test_a_parameter_of_the_first_state_says_when_it_acts_and_more_than_three_fold(page):
    labels = page.evaluate("() => view.sliders.map((slider) => slider.row.querySelector('label').textContent)")
    assert labels == ["l [mm]", "h [mm]acts at the next start"]
    folded = page.evaluate(
        """(about) => {
            const parameters = ["a", "b", "c", "d", "e"].map((name) => ({ ...about.parameters[0], name }))
            const source = { about: { ...about, parameters }, open() {}, show() {}, tell() {}, press() {}, close() {} }
            const other = new parts.View(source, document.body) // no kernel: any source of plain data
            const more = other.root.querySelector("details.hl-more")
            const found = [more.open, ...[more, other.root].map((each) => each.querySelectorAll(".hl-slider").length)]
            more.querySelector("summary").focus()
            const words = document.activeElement.textContent
            other.close()
            return [...found, words]
        }""",
        ABOUT,
    )
    assert folded == [False, 2, 5, "2 more parameters: d, e"]


@pytest.mark.wide
def test_what_moves_by_itself_moves_seldom_where_motion_is_reduced(page):
    due = "() => [1, 1.1, 1.6].map((now) => view.due('tried', now, 25))"
    assert page.evaluate(due) == [True, True, True]
    page.evaluate("() => (view.tried = undefined)")
    page.emulate_media(reduced_motion="reduce")
    assert page.evaluate(due) == [True, False, True]


@pytest.mark.wide
def test_a_wall_that_is_reached_is_spoken_of_at_once_and_a_chatter_is_not(page):
    spoken = page.evaluate(
        """() => {
            const said = []
            const rows = (contact) => Float32Array.of(said.length, 0.0102, 1, 0, NaN, contact, 0.0102, 1)
            for (const contact of [0, 1, 0, 1]) {
                view.spoken.element.textContent = ""
                view.samples.add(rows(contact))
                view.spoken.follow(view.samples)
                said.push(view.spoken.element.textContent)
            }
            return said
        }"""
    )
    assert spoken == ["", "Contact reached at x = 10.2 mm.", "", ""]
