"""What labs 09 and 10 ask of a hand can be done with a mouse: throw the handle, compare blindly."""

import pytest
from lab import ask, eventually, grab, picture, until

pytestmark = pytest.mark.wide

BEGIN = """
import numpy as np
import hapticlab as hl
thrown = hl.SimulatedPaddle.from_profile(
    "hapkit", hand=hl.Hand("pinch"), m=0.0286, b=0.15, coulomb=0.048, noise=8e-6, seed=1
)
view = hl.live(thrown, hl.laws.virtual_damper()(B=0), sliders={}, let_go=True, time_scale=0.25)
task = hl.people.stiffness_task()
blind = hl.people.compare_blind(hl.SimulatedPaddle.from_profile("hapkit"), task, duration=8, pause=0.5, seed=3)
"""
IDENTIFY = """
view.stop_recording()
coast = hl.identify.coasting(view.log)
found = hl.identify.spin_down(coast, counts_per_metre=1 / 12.8e-6, confidence=0.999)
print(0.15 / 0.0286 in found["b/m"], 0.048 / 0.0286 in found["coulomb/m"], found.explained)
"""
OVER = """
log, held = view.log, view._session.motion.held
free = np.isnan(log.intent)
caught = bool(free.any() and held)
print(bool(caught or (free[-300:].all() and np.ptp(log.x[-200:]) < 6e-5)))
"""


def shown(lab, name):
    page = lab.open(name, BEGIN, name, height=800)
    page.wait_for_selector("canvas.hl-stage", state="attached")
    return page


def flick(page, wait):
    """Lead the handle to the left, move it fast to the right, and release it on its way, so long after the last move [ms].

    Return whether it came to rest by itself: one that is thrown to the end of its way is caught there.
    """
    x, y = grab(page, "canvas.hl-stage")
    for k in range(20):
        page.mouse.move(x - 8 * k, y)
    eventually(page, "print(view._session.motion.place < -0.01)", "True")
    ask(page, "view.record()")
    for k in range(1, 13):
        page.mouse.move(x - 152 + 22 * k, y)
        page.wait_for_timeout(wait)
    page.mouse.up()
    eventually(page, OVER, "True")
    return ask(page, "print(caught)") == "False"


def test_a_flick_with_the_mouse_tells_damping_and_friction(lab):
    page = shown(lab, "view")
    until(page, ".hl-status", "Running")
    for wait in (30, 10, 1, 20):  # a busy computer moves the pointer late: what is too slow is told, and done again
        rested = flick(page, wait)
        said = ask(page, IDENTIFY)
        if rested and not said.startswith("hl.identify.coasting: the handle coasts"):
            break
        page.locator(".hl-stage").press("a")
    picture(page, "by-mouse-flick")
    assert said == "True True True"
    page.close()


def test_a_blind_trial_takes_two_presses_and_shows_neither_number_nor_pointer(lab):
    page = shown(lab, "blind")
    head, box = page.locator(".hl-blind-head"), page.locator("canvas.hl-stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    head.get_by_role("button", name="Feel the first").click()
    felt = []
    for which in (0, 1):
        page.wait_for_function("() => document.querySelector('.hl-blind:not(.hl-covered)')")
        began = float(ask(page, "print(blind._session.motion.place)"))
        page.mouse.move(x, y)
        page.mouse.down()
        for k in range(30):
            page.mouse.move(x + 2 * k, y)
        eventually(page, f"print(blind._session.motion.place > 0.003 and blind._felt == set(range({which + 1})))", "True")
        begun = ask(page, "print(blind._session.motion.time)")
        eventually(page, f"print(blind._session.motion.time > {begun} + 0.3)", "True")  # until it stands
        felt.append(float(ask(page, "print(blind._session.motion.place)")))
        if which == 0:
            picture(page, "by-mouse-blind")
            words = page.locator(".hl-live").inner_text()
            assert not any(letter.isdigit() for letter in words), words
            assert page.locator("canvas.hl-stage").evaluate("(e) => getComputedStyle(e).cursor") == "none"
            page.mouse.up()
            page.wait_for_function("() => document.querySelector('.hl-covered')")
        assert abs(began) < 1e-3  # no jump tells which one changed
    page.keyboard.press("1" if felt[0] < felt[1] else "2")  # the stiffer one gives less
    page.mouse.up()
    assert 'Saved: you answered "the ' in until(page, ".hl-blind-head p", "Saved")
    assert head.locator("strong").inner_text() == "Trial 2"
    assert ask(page, "print(blind.result.trials[0].right)") == "True"
    page.close()
