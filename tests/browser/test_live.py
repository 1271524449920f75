"""A scripted student at the live view: JupyterLab and Chromium as they are, the kernel's answer is what counts."""

import pytest
from axe import findings
from lab import ask, command, eventually, grab, picture, run_cell, see, until

pytestmark = pytest.mark.wide  # the scripts and the silent view beside it always run

BEGIN = """
import hapticlab as hl
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
view = hl.live(paddle, hl.wall()(k=300, x_o=0.01))
"""
TALL = 'from IPython.display import HTML; HTML(\'<div style="height: 3000px" id="below">the cell below</div>\')'
# Which controls are grey, and which of those the keyboard does not reach.
GREY = """() => {
  const controls = [...document.querySelectorAll(".hl-buttons button:not(.hl-zoom, .hl-sound), .hl-slider input")]
  const grey = controls.filter((each) => each.ariaDisabled === "true")
  return [grey.length === controls.length, grey.filter((each) => (each.focus(), document.activeElement !== each)).length]
}"""
STAGE, STATUS = "canvas.hl-stage", ".hl-status"
# Where the handle is, F, and E as the view says them in words.
NUMBERS = "() => (document.querySelector('.hl-readout').textContent.match(/-?[0-9.]+/g) ?? []).map(Number)"
# Contrast of two colours after WCAG 2.
CONTRAST = """() => {
  const light = ([r, g, b]) => {
    const part = (c) => ((c /= 255) <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b)
  }
  const rgb = (colour) => colour.match(/[0-9.]+/g).map(Number)
  const paper = light(rgb(getComputedStyle(document.querySelector(".hl-live")).backgroundColor))
  const found = {}
  for (const name of ["hl-status", "hl-readout", "hl-number", "hl-hint", "hl-energy", "hl-help", "hl-limits", "hl-unit"]) {
    const ink = light(rgb(getComputedStyle(document.querySelector("." + name)).color))
    found[name] = (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05)
  }
  return found
}"""


@pytest.fixture(scope="module")
def page(lab):
    page = lab.open("student", BEGIN, "view", TALL)
    page.wait_for_selector(STAGE)
    until(page, STATUS, "Running")
    yield page
    page.close()


def test_a_drag_goes_into_the_wall_even_where_it_leaves_the_picture(page):
    assert page.evaluate("getComputedStyle(document.querySelector('canvas.hl-stage')).touchAction") == "pan-y"  # or scrolls
    x, y = grab(page, STAGE)
    for k in range(1, 13):
        page.mouse.move(x + 10 * k, y + 30 * k)  # the last ones are far below the canvas
    until(page, STATUS, "in contact")
    page.wait_for_function(f"() => ({NUMBERS})()[1] > 0.5")
    picture(page, "live-1-in-the-wall")
    page.mouse.up()
    x, force, *_ = page.evaluate(NUMBERS)
    assert force == pytest.approx(300 * (1e-3 * x - 0.01), abs=0.02)  # Eq. (23.1), x shown to 0.1 mm
    x, force = map(float, ask(page, "m = view._session.motion.values(); print(m['x'], m['F'])").split())
    assert force == pytest.approx(300 * (x - 0.01), abs=0.02) and force > 0.5  # the wall sees the encoder's counts


def test_a_slider_moves_its_parameter_and_follows_the_program(page):
    slider = page.get_by_label("k [N/m]")
    assert slider.get_attribute("type") == "range"
    slider.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    page.wait_for_function("() => document.querySelectorAll('.hl-slider .hl-entry')[1].value > 300")
    expected = float(slider.input_value())
    assert expected == pytest.approx(300 + 5 * 5)  # 840 N/m in 168 steps
    eventually(page, "print(view.values['k'])", f"{expected}")
    ask(page, "view.set(k=450)")
    page.wait_for_function("() => document.querySelectorAll('.hl-slider input[type=range]')[1].value == 450")
    assert "450" in slider.get_attribute("aria-valuetext")


def test_a_value_that_is_refused_goes_back_and_says_why(page):
    entry = page.get_by_role("spinbutton", name="k in N/m")
    entry.select_text()
    entry.press_sequentially("-50\n")
    assert "k" in until(page, STATUS, "needs")
    entry.blur()
    page.wait_for_function("() => document.querySelectorAll('.hl-slider .hl-entry')[1].value > 0")
    assert float(ask(page, "print(view.values['k'])")) == 450


def test_a_number_is_taken_as_it_was_typed(page):
    entry, words = page.get_by_role("spinbutton", name="k in N/m"), page.locator(".hl-limits").nth(1)
    for typed, value in (("12,5", 12.5), ("1234.5678", 1234.5678), ("12x", 1234.5678), ("1,000", 1234.5678)):
        entry.fill(typed)
        entry.press("Enter")
        eventually(page, "print(view.values['k'])", f"{value}")
    assert words.text_content() == "“1,000” could be 1 or 1000: type one of these; k stays at 1234.57 N/m"
    for absurd in ("abc", "1e9", "-1e9"):
        entry.fill(absurd)
        entry.press("Enter")
        assert "k stays at 1234.57 N/m" in words.text_content() and entry.get_attribute("aria-invalid") == "true"
    assert words.text_content().startswith("-1000000000 N/m is more than 100 times the end of the slider")
    entry.fill("1234,5678")
    entry.press("Enter")
    assert entry.get_attribute("aria-invalid") == "false" and "stays" not in words.text_content()
    entry.blur()
    entry.focus()
    entry.press("Enter")  # nothing was typed: what is shown rounded is not written back
    entry.press("ArrowUp")
    eventually(page, "print(view.values['k'])", "1240.0")  # 5 N/m more, on the grid of the slider's steps
    assert "beyond the slider 60 to 900 N/m; allowed k >= 0" in words.text_content()
    ask(page, "view.set(k=450)")
    entry.blur()


def test_a_hand_begins_where_another_view_left_it(page):
    stage = page.get_by_role("slider", name="hand on the handle")
    ask(page, "view._session.intend(-0.0075)")
    page.wait_for_function("() => document.querySelector('canvas.hl-stage').ariaValueNow === '-7.5'")
    stage.press("ArrowRight")
    eventually(page, "print(round(view._session._wanted, 6))", "-0.007")


def test_who_listens_hears_of_another_state_and_not_of_each_number(page):
    said = """() => {
        const view = document.querySelector('.hl-live'), spoken = view.querySelector('.hl-spoken'), heard = []
        new MutationObserver(() => heard.push(spoken.textContent)).observe(spoken, { childList: true })
        window.heard = heard
    }"""
    page.evaluate(said)
    assert page.locator(".hl-status").get_attribute("aria-live") is None
    page.locator(STAGE).press("P")  # Shift or Caps Lock
    page.wait_for_function("() => heard.at(-1)?.startsWith('Paused.')")
    page.locator(STAGE).press("p")
    page.wait_for_function("() => heard.at(-1).startsWith('Running')")


def test_what_cannot_be_pressed_says_so(page):
    for name in ("Save", "Replay"):
        assert page.get_by_role("button", name=name, exact=True).is_disabled()  # nothing is recorded yet


def test_keys_move_the_hand_and_leave_the_notebook_alone(page):
    stage = page.get_by_role("slider", name="hand on the handle")
    stage.focus()
    before = float(stage.get_attribute("aria-valuenow"))
    for _ in range(4):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("Shift+ArrowLeft")
    assert float(stage.get_attribute("aria-valuenow")) == pytest.approx(before - 4 * 0.5 - 5.0, abs=0.051)
    wanted = round(1e-3 * float(stage.get_attribute("aria-valuenow")), 4)  # the page says the last of five 20 ms later
    eventually(page, "print(round(view._session._wanted, 4))", f"{wanted}")
    for key in ("d", "d", "x", "a", "0", "0"):
        page.keyboard.press(key)  # in JupyterLab: delete, cut, insert a cell, restart the kernel
    assert page.locator(".jp-Cell").count() == 3
    page.keyboard.press("l")
    until(page, ".hl-hold", "Take hold")
    page.keyboard.press("ArrowRight")
    until(page, ".hl-hold", "Let go")


def test_pause_record_replay_and_save_by_keyboard(page):
    page.locator(STAGE).focus()
    page.keyboard.press("p")
    until(page, STATUS, "Paused")
    page.keyboard.press("p")
    until(page, STATUS, "Running")
    page.keyboard.press("r")
    until(page, STATUS, "Recording")
    picture(page, "live-2-recording")
    begun = ask(page, "print(view._session.motion.time)")
    eventually(page, f"print(view._session.motion.time > {begun} + 1)", "True")  # so that its replay is seen
    page.keyboard.press("r")
    until(page, ".hl-record", "● Record")
    assert ask(page, "print(view.log is not None)") == "True"
    page.keyboard.press("y")
    until(page, ".hl-replay", "Stop")
    until(page, ".hl-replay", "Replay")
    page.get_by_role("button", name="Save", exact=True).click()
    until(page, STATUS, "Saved")


def test_it_starts_again_and_slows_down_and_zooms_by_keyboard(page):
    page.locator(STAGE).focus()
    eventually(page, "print(view._session.motion.time > 1)", "True")
    page.keyboard.press("m")
    until(page, STATUS, "Running at 0.1 times real time")
    page.keyboard.press("a")
    eventually(page, "print(view._session.motion.time < 1)", "True")  # for 10 s
    until(page, STATUS, "Running at 0.1 times real time")
    page.keyboard.press("z")
    assert page.evaluate("() => ['slow', 'zoom', 'sound'].map((name) => document.querySelector('.hl-' + name).ariaPressed)") == [
        "true", "true", "false",
    ]  # fmt: skip
    picture(page, "live-4-zoom-in-slow-motion")
    page.keyboard.press("z")
    page.keyboard.press("m")
    page.wait_for_function("() => document.querySelector('.hl-slow').ariaPressed === 'false'")


def test_who_listens_is_told_the_details_on_a_key(page):
    page.locator(STAGE).focus()
    page.keyboard.press("d")
    said = page.locator(".hl-spoken").text_content()
    assert "x is" in said and "F is" in said and "on the environment" in said and said.startswith("Running")
    assert page.locator(".hl-live > .hl-unseen").first.text_content().startswith("Live view of zoh wall.")


def test_the_view_fits_a_laptop_and_nobody_is_left_out(page):
    assert page.locator(".hl-live").bounding_box()["height"] <= 620
    assert findings(page, ".hl-live") == []


def test_nothing_runs_for_a_view_off_the_screen(page):
    page.locator("#below").evaluate("(below) => below.scrollIntoView({ block: 'end' })")
    eventually(page, "print(view._session.on_view, view._session.motion.running)", "False False")
    page.locator(STAGE).scroll_into_view_if_needed()
    eventually(page, "print(view._session.on_view, view._session.motion.running)", "True True")
    until(page, STATUS, "Running")


def test_words_stand_out_in_both_themes(page):
    for theme in ("JupyterLab Light", "JupyterLab Dark"):
        command(page, "apputils:change-theme", theme=theme)
        dark = theme.endswith("Dark")
        page.wait_for_function("(dark) => document.querySelector('.hl-live').classList.contains('hl-dark') === dark", arg=dark)
        picture(page, f"live-3-{'dark' if dark else 'light'}")
        contrast = page.evaluate(CONTRAST)
        assert min(contrast.values()) >= 4.5, (theme, contrast)  # WCAG 2, level AA
    command(page, "apputils:change-theme", theme="JupyterLab Light")


def test_it_stops_with_its_last_view_and_when_its_page_is_left(page):
    assert ask(page, "print(view._session.on_view)") == "True"
    page.evaluate("() => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = 1 }")
    command(page, "notebook:clear-cell-output")
    page.wait_for_selector(STAGE, state="detached")
    eventually(page, "print(view._session.on_view, view._session.motion.running, view._session._turns)", "False False None")


def test_a_kernel_that_was_restarted_is_told_and_nothing_can_be_pressed(page):
    run_cell(page, "view")
    page.wait_for_selector(STAGE)
    see(page, STAGE)
    until(page, STATUS, "Running")
    page.evaluate("() => window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()")
    until(page, STATUS, "kernel")
    assert "Running" not in page.locator(STATUS).text_content()
    assert page.evaluate(GREY) == [True, 0]
    picture(page, "live-5-restarted")
