"""The page of a real paddle as text: where it may be, what it may do, and that every scene it offers fits its board."""

import base64
import re
import subprocess

import core_in_node
import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.board_records import BOARDS
from hapticlab.compiler.engines.bytecode import layout
from hapticlab.compiler.engines.engine import load
from hapticlab.device.link.messages import FAULTS, LARGEST_PAYLOAD, RESULTS
from hapticlab.widgets.board_page.page import BOARD_SCRIPTS, paddle_page
from hapticlab.widgets.board_page.programs import choices, labs, page_data
from hapticlab.widgets.browser_view import BROWSER, SCRIPTS
from hapticlab.widgets.shared.document import VIEW_SCRIPTS
from hapticlab.widgets.shared.page import PAGE_SCRIPTS
from hapticlab.widgets.stage import QUIET, TIMELY


def script(names):
    return "\n".join((BROWSER / name).read_text("utf-8") for name in names)


@pytest.fixture(scope="module")
def wall():
    return page_data(("uno", "pico"), labs()[:1])


def test_only_the_page_of_a_board_can_reach_a_port():
    for names in (SCRIPTS, VIEW_SCRIPTS, PAGE_SCRIPTS):
        assert "navigator.serial" not in script(names) and not any(name.startswith("board/") for name in names)
    with_ports = [
        path.relative_to(BROWSER).as_posix() for path in BROWSER.rglob("*.js") if "navigator.serial" in path.read_text("utf-8")
    ]
    assert with_ports == ["board/page.js", "board/port.js"]


def test_nothing_but_a_press_opens_a_port_or_starts_a_motor():
    own = script(BOARD_SCRIPTS)
    ways_in = (
        "getPorts", "location", "postMessage", '"message"', "localStorage", "sessionStorage", "document.cookie", "fetch(",
        "XMLHttpRequest", "WebSocket", "eval(",
    )  # fmt: skip
    for word in ways_in:
        assert word not in own, word
    assert own.count("requestPort") == 1


def test_no_word_of_a_board_asks_a_page_for_a_call_of_python():
    instead = re.search(r"const INSTEAD = {(.*?)\n}", script(["board/link.js"]), re.DOTALL)[1]
    spoken = {name for name, (_, words) in RESULTS.items() if "paddle." in words}
    assert spoken and spoken <= set(re.findall(r"^  ([A-Z_]+):", instead, re.MULTILINE))
    assert not any("paddle." in words for _, *sentences in FAULTS.values() for words in sentences)
    assert [name for name, row in FAULTS.items() if "notebook" in str(row)] == ["HOST_SILENT"]  # the page has words of its own


def test_a_press_counts_as_long_as_in_a_notebook():
    for name, value in ("TIMELY", TIMELY), ("QUIET", QUIET):
        assert float(re.search(rf"const {name} = ([\d.]+)", script(["board/source.js"]))[1]) == value


def test_the_page_asks_for_nothing_and_runs_its_own_script_alone(wall):
    text = paddle_page(wall)
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', text)[1]
    assert policy.startswith("default-src 'none'") and "unsafe" not in policy and "connect-src" not in policy
    assert len(re.findall("<script", text)) == 2 and "src=" not in text.split("</head>")[0]
    assert "untried on" in text and len(text) < 250_000


@pytest.mark.skipif(core_in_node.missing() is not None, reason=str(core_in_node.missing()))
def test_no_script_of_the_page_takes_the_name_of_another(tmp_path):
    """In a module a name that is declared twice is an error; in a page the later one would win."""
    path = tmp_path / "page.mjs"
    path.write_text(script((*VIEW_SCRIPTS, *BOARD_SCRIPTS)), "utf-8")
    done = subprocess.run(["node", "--check", path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def fits(scene):
    """Compare what a scene of the page needs of each board with the board's record."""
    for name, told in scene["boards"].items():
        data, board = base64.b64decode(told["code"]), BOARDS[name]
        assert -(-len(data) // 4) * 4 + 4 * layout(data).size["registers"] <= board.arena
        assert 5 + 4 * len(told["types"]) <= LARGEST_PAYLOAD and len(told["types"]) <= board.channels
        assert told["about"]["kind"] == "board" and told["about"]["T"] == pytest.approx(told["T"] * told["every"])
        assert {p["name"] for p in told["about"]["parameters"]} <= {p["name"] for p in told["parameters"]}
        assert "Space and Esc stop it" in told["about"]["help"]


def test_the_wall_that_compensates_for_the_hold_gives_the_force_of_half_a_period_later():
    (choice,) = [choice for choice in labs() if "compensates for the hold" in choice.title]
    samples = 0.012 + 1e-4 * np.arange(6)  # inside, at one speed
    program = hl.compile(choice.scene, T=1e-3, dtype="float64")
    force = load(program).run(len(samples), samples[:, None]).outputs[1:, 0, 0]
    np.testing.assert_allclose(force, choice.scene.values["k"] * (samples[1:] + 0.5e-4 - choice.scene.values["x_o"]))


def test_a_scene_of_the_page_fits_its_boards(wall):
    assert list(wall["scenes"][0]["boards"]) == ["uno", "pico"]
    fits(wall["scenes"][0])


@pytest.mark.wide
def test_every_scene_that_is_offered_fits_and_few_are_left_out():
    scenes = page_data()["scenes"]
    for scene in scenes:
        fits(scene)
    offered = {scene["name"] for scene in scenes}
    assert {choice.name for choice in choices()} - offered == {"ball_on_the_paddle", "stick_slip"}  # too long for a period
    on_uno = {scene["name"] for scene in scenes if "uno" in scene["boards"]}
    assert offered - on_uno == {"four_bar"}
