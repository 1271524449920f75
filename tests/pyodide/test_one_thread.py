"""The browser's own Python has one thread: views, pictures, links and bars take turns with the cells there."""

import pytest
from in_pyodide import pytest_in_pyodide, run_in_pyodide

pytestmark = pytest.mark.wide

VIEW = """
import asyncio, time
import hapticlab as hl
from hapticlab.widgets.session import Session

paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
session = Session(paddle, hl.wall()(k=300, x_o=0.01))
frames = []

async def until(count, *talk):
    while len(frames) < count:
        for say in talk:
            say()
        await asyncio.sleep(0.01)

session.connect(frames.append)
session.ready("page")
await until(20, lambda: session.alive("page"), lambda: session.intend(0.02))
print("pushed", max(float(frame.rows[-1, 2]) for frame in frames if len(frame.rows)) > 0.5)
until_then = time.monotonic() + 1.5
while time.monotonic() < until_then:  # a cell computes
    pass
await until(len(frames) + 3, lambda: session.alive("page"))
print(session.status)
session.stage.tell("")
before, heard = len(frames), time.monotonic()
while time.monotonic() < heard + 1.5:  # a cell awaits, and the page's words wait
    await asyncio.sleep(0.01)
print(session.status.split(". ")[-1], len(frames) > before + 10)
session.close()
while not frames[-1].status.startswith("This view has ended"):
    await asyncio.sleep(0.01)
print(session._turns)
"""


def test_a_view_takes_turns_with_cells():
    pushed, computed, awaits, ended = run_in_pyodide(VIEW).splitlines()
    assert pushed == "pushed True"
    assert "A cell computed for 1." in computed and computed.endswith("s: time stood still.")
    assert awaits == "A cell is running, so the pointer, keys and buttons take effect only after the cell. True"
    assert ended == "None"


PICTURE = """
import asyncio
from hapticlab.widgets.sliders import FollowedPicture

class Figure:
    def __init__(self, values):
        self.values = values
    def _repr_png_(self):
        return repr(self.values).encode()

class View(FollowedPicture):
    drawn_for = []
    def drawn(self, values):
        self.drawn_for.append(values["b"])
        return Figure(values), "", ""

view = View({"b": (0.0, 1.0, 0.5, "N s/m")}, "")
while not view.image.value:
    await asyncio.sleep(0)
for b in (0.2, 0.3, 0.4):
    view.set(b=b)
while b"0.4" not in bytes(view.image.value):
    await asyncio.sleep(0)
print(view.drawn_for)
view.set(b=0.6)
print(view.wait(60), bytes(view.image.value).decode())
"""


def test_a_picture_follows_its_sliders():
    assert run_in_pyodide(PICTURE).splitlines() == ["[0.5, 0.4]", "True {'b': 0.6}"]


BOARD = """
import asyncio, sys
import hapticlab as hl
from hapticlab.device.link.messages import HOST_SILENCE_MS
wall = hl.wall()(k=150, x_o=0.01)
with hl.connect("sim://hapkit") as board:
    log = board.run(wall, duration=0.3)
    print(len(log.t), log.fault)
with hl.connect("sim://hapkit?pace=real") as board:
    board.start(wall)
    run = board.under_way
    while run.last_tick < 3 * HOST_SILENCE_MS and run.fault is None:
        await asyncio.sleep(0.01)
    print(run.fault)
    print(len(board.run(wall, duration=0.1).t))
"""


def test_a_simulated_board_runs_in_virtual_time_and_by_the_clock():
    assert run_in_pyodide(BOARD).splitlines() == ["300 None", "None", "100"]


@pytest.mark.slow
def test_the_tests_of_views_pictures_and_links_pass_there():
    """All but those of threads, of the silence that ends a view elsewhere, and of the interpreter, which is not the fastest."""
    names = "without_threads both turns threads nobody_keeps nobody_asks a_record_comes is_no_cell says_beforehand"
    chosen = " and ".join(f"not {name}" for name in [*names.split(), "silence", "interpreter"])
    widgets = "test_live", "test_live_board", "test_picture", "test_browser_view", "test_show", "blind/test_comparison"
    files = [*(f"tests/widgets/{name}.py" for name in widgets), "tests/device/link/test_exchange.py"]
    last = pytest_in_pyodide(*files, "-k", chosen, seconds=900)
    assert int(last.split()[0]) > 200


WORDS = """
import hapticlab as hl
from hapticlab.cli.main import main
for port in (None, "COM3"):
    try:
        hl.connect(port)
    except hl.errors.PortError as problem:
        print(problem.cause, 'hl.connect("sim://hapkit")' in str(problem))
print(hl.doctor().checks[-1].state)
print(main(["grade", "x.ipynb"]))
from hapticlab.analysis.sweeps.workers import number_of
print(number_of(-1), number_of(4))
"""


def test_what_a_browser_cannot_do_is_said():
    *said, last = run_in_pyodide(WORDS).splitlines()
    assert said[:3] == ["missing True", "missing True", "no board"] and last == "1 1"
    assert said[3].startswith("hapticlab: Grading runs other processes") and said[4] == "1"
