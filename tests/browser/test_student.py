"""A scripted student: a lab as it is handed out, a map under sliders, and a board whose page is loaded anew."""

import ast
import shutil

import pytest
from lab import REPOSITORY, ask, eventually, grab, picture, run_cell, see, until

LAB = "02_virtual_wall"
ANSWERS = (REPOSITORY / "tests" / "instructor" / LAB / "solution.py").read_text("utf-8")
STAGE, STATUS = "canvas.hl-stage", ".hl-status"


def answer(name):
    """Return the instructor's answer of this name, as source."""
    nodes = {getattr(node, "name", None): node for node in ast.parse(ANSWERS).body}
    return ast.get_source_segment(ANSWERS, nodes[name])


@pytest.mark.wide
def test_a_student_works_through_a_lab(lab):
    shutil.copy(REPOSITORY / "labs" / LAB / f"{LAB}.ipynb", lab.notebooks)
    page = lab.open(LAB)
    page.wait_for_function("() => document.querySelector('.jp-Cell:last-child .jp-OutputArea')?.innerText.includes('02.')")
    see(page, STAGE)
    page.locator(".hl-record").click()
    until(page, STATUS, "Recording")
    x, y = grab(page, STAGE)
    for k in range(1, 11):
        page.mouse.move(x + 9 * k, y)
    until(page, STATUS, "in contact")
    page.mouse.up()
    slider = page.get_by_label("k [N/m]")
    slider.press("PageUp")
    eventually(page, "print(view.values['k'] > 300)", "True")
    page.locator(".hl-record").click()
    until(page, ".hl-record", "● Record")
    picture(page, "lab-1-felt")
    said = run_cell(page, "log = view.log")
    assert "recorded in the view" in said
    page.wait_for_function("() => [...document.querySelectorAll('.jp-OutputArea img')].some((i) => i.alt.startsWith('Position'))")
    assert "not answered yet" in run_cell(page, 'hl.check("02.held_work"')
    run_cell(page, "def held_work", "def held_work(k, x, D):\n    return k * (x + D) * D\n")  # force of the period's end
    taught = run_cell(page, 'hl.check("02.held_work"')
    run_cell(page, "def held_work", answer("held_work"))
    passed = run_cell(page, 'hl.check("02.held_work"')
    assert "right in the public cases" in passed and "right in the public cases" not in taught.partition("this lab")[0]
    assert "1 of 7 exercises" in passed and "0 of 7" in taught
    assert "the force at the end of the period" in taught  # it says what the mistake was
    picture(page, "lab-2-checked")
    page.close()


BOARD = """
import hapticlab as hl
paddle = hl.connect("sim://hapkit?pace=real")
view = hl.live(paddle, hl.wall()(k=150, x_o=0.005))
motor = lambda: paddle.state()["state"]
"""
MAP = """
held = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, push=1.0))
explored = hl.stability.explore(held, sliders={"b": (0.05, 0.5)}, points=10, duration=0.2)
explored
"""


@pytest.fixture(scope="module")
def page(lab):
    page = lab.open("board_and_map", BOARD, "view", MAP)
    page.wait_for_selector(STAGE)
    yield page
    page.close()


@pytest.mark.wide
def test_a_map_follows_its_slider(page):
    page.wait_for_selector(".widget-image[src]")
    before = page.locator(".widget-image").get_attribute("src")
    handle = page.locator(".noUi-handle")
    assert handle.get_attribute("role") == "slider"
    handle.focus()
    for _ in range(20):
        page.keyboard.press("ArrowRight")
    page.wait_for_function("(before) => document.querySelector('.widget-image').src !== before", arg=before)
    moved = "print(round(explored.paddle.b - explored.sliders['b'].value, 9), explored.paddle.b > 0.2)"
    eventually(page, moved, "0.0 True")
    assert "exact linear stability up to" in page.locator(".widget-html").inner_text()
    page.wait_for_function("() => document.querySelector('.widget-image').alt.startsWith('wall map')")
    assert page.get_by_role("slider", name="b [N s/m]", exact=True).count() == 1
    for key in "dd":  # in JupyterLab: delete the cell
        page.keyboard.press(key)
    assert page.locator(".jp-Cell").count() == 3
    picture(page, "explore")


@pytest.mark.wide
def test_a_board_runs_by_its_button_and_not_by_a_page(page):
    until(page, STATUS, "Motor off")
    assert page.locator(STAGE).get_attribute("role") == "img"  # the real handle moves it
    rests = ask(page, "print(motor())")
    page.get_by_role("button", name="Start motor").click()
    until(page, ".hl-run", "Stop motor")
    picture(page, "board-running")
    assert ask(page, "print(motor())") != rests
    ask(page, "view._session.alive('another page that has not said goodbye')")
    page.evaluate("() => window.jupyterapp.commands.execute('docmanager:save')")
    page.reload()
    page.wait_for_selector(STAGE)
    until(page, STATUS, "Motor off")
    assert ask(page, "print(motor())") == rests
    picture(page, "board-page-loaded-anew")
