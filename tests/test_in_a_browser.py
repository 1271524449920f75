"""Where a browser runs Python: what needs a port, a process or a thread says so in words, and the rest goes on with one thread.

The platform is the test's here; tests/pyodide has the browser's own Python.
"""

import sys
from argparse import Namespace

import pytest

import hapticlab as hl
from hapticlab.analysis.sweeps.forked_workers import shared_out
from hapticlab.analysis.sweeps.workers import number_of
from hapticlab.base.in_notebook import require_processes
from hapticlab.cli import board, grade_start, labs
from hapticlab.cli.main import main
from hapticlab.compiler.engines import vm
from hapticlab.compiler.engines.table import ENGINES, chosen
from hapticlab.device.link.serial_ports import IN_A_BROWSER, available_ports
from hapticlab.device.setup.flash import flash
from hapticlab.errors import CourseError, EngineMissingError, HapticlabError, PortError
from hapticlab.grading.run import run
from hapticlab.grading.sessions.starter import start
from hapticlab.self_test.report import self_test
from hapticlab.site.lite import check_builders


@pytest.fixture
def browser(monkeypatch):
    monkeypatch.setattr(sys, "platform", "emscripten")


@pytest.mark.parametrize(
    "asked",
    [
        hl.connect,
        lambda: hl.connect("COM3"),
        lambda: hl.connect("/dev/ttyACM0"),
        lambda: hl.connect("socket://localhost:5331"),
        lambda: flash("COM3"),
        lambda: board.flash(None, Namespace(port=None, board=None)),
    ],
)
def test_what_needs_a_port_says_what_a_browser_can_do(browser, asked):
    with pytest.raises(PortError) as problem:
        asked()
    assert problem.value.cause == "missing"
    assert str(problem.value).endswith(IN_A_BROWSER)
    for cure in ('hl.connect("sim://hapkit")', 'hl.SimulatedPaddle.from_profile("hapkit")', "pip install hapticlab"):
        assert cure in str(problem.value)


def test_the_simulated_paddles_of_the_advice_are_there(browser):
    assert hl.SimulatedPaddle.from_profile("hapkit").T == 1e-3
    assert available_ports() == []


def test_the_doctor_says_it_and_finds_no_fault(browser):
    report = hl.doctor()
    *_, ports = report.checks
    assert (ports.state, ports.cure) == ("no board", IN_A_BROWSER)
    assert not any(check.state == "fault" for check in report.checks)
    assert "Windows" not in str(report) and "jupyterlab" not in str(report)


def test_a_system_whose_ports_pyserial_cannot_list_has_no_known_board(monkeypatch):
    monkeypatch.setitem(sys.modules, "serial.tools.list_ports", None)
    monkeypatch.delattr("serial.tools.list_ports", raising=False)
    with pytest.raises(PortError, match="no known board is plugged in; found no serial port at all"):
        hl.connect()


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        (lambda: run([], None), CourseError),
        (start, CourseError),
        (lambda: grade_start.grade(None, None), CourseError),
        (lambda: self_test(None, None), HapticlabError),
        (check_builders, EngineMissingError),
    ],
)
def test_what_needs_other_processes_says_so(browser, asked, error):
    with pytest.raises(error, match=r"runs other processes, .* browser cannot start any\. Install hapticlab on a computer"):
        asked()


def test_elsewhere_there_are_processes():
    assert require_processes("Grading") is None


def test_the_labs_are_copied_and_no_program_is_started(browser, capsys, tmp_path):
    options = Namespace(wanted=[str(tmp_path)], lab=["00"], instructor=None, seed=None, no_open=False)
    assert labs.labs(None, options) == 0
    assert (tmp_path / "00_meet_the_paddle" / "00_meet_the_paddle.ipynb").is_file()
    assert "use the file browser of this page" in capsys.readouterr().out


def test_a_page_of_the_guide_is_named_and_no_program_is_started(browser, capsys):
    assert main(["guide", "safety", "--open"]) == 1
    said = capsys.readouterr()
    assert said.out.strip().endswith("SAFETY.md") and "print(open(PATH).read())" in said.err


@pytest.mark.parametrize("workers", [1, 4, -1])
def test_one_worker_does_the_work_of_all(browser, workers):
    assert number_of(workers) == 1
    with shared_out(10, workers) as share:
        assert list(share(lambda common, argument: common + argument, [1, 2])) == [11, 12]
    with pytest.raises(hl.errors.AnalysisError, match="workers = 0"):
        number_of(0)


def test_the_machine_of_the_boards_is_an_engine_only_where_its_library_is(monkeypatch):
    assert ENGINES["vm"].is_here()

    def missing(word_bits, *flags):
        raise EngineMissingError("no library")

    monkeypatch.setattr(vm, "machine", missing)
    assert not ENGINES["vm"].is_here()
    with pytest.raises(EngineMissingError, match="no library"):
        chosen("vm")
