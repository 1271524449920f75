"""The checks of the self-test hold where all is well, and each says so where something is not."""

import json
import struct
import sys
import types
import zipfile
from pathlib import Path

import numpy as np
import pytest

from hapticlab.compiler.engines.engine import load
from hapticlab.errors import EngineMissingError
from hapticlab.self_test import computer, file_checks, running, teaching
from hapticlab.self_test.outcome import Attention, Fault
from hapticlab.self_test.table import CHECKS


@pytest.mark.parametrize(
    "check",
    [
        computer.packages,
        computer.clocks,
        computer.ports,
        file_checks.line_endings,
        file_checks.paths,
        file_checks.labs,
        running.engines,
    ],
)
def test_a_check_holds_here(check, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert check(tmp_path)


# ---------------------------------------------------------------- engines


def test_the_stored_bits_are_those_of_single_precision_in_numpy():
    """The wall's program again, an operation at a time in NumPy's float32, which rounds as IEEE 754 says."""
    f = np.float32
    rows = [f((tick % 23 + 1) / 1024) for tick in range(running.TICKS)]
    last, speed, found = rows[0], f(0), []
    for count, x in enumerate(rows, start=1):
        speed = f(f(speed * f(0.9)) + f(f(x - last) * f(100)))
        force = max(f(f(f(150) * f(x - f(0.01))) + f(f(2) * speed)), f(0)) if x >= f(0.01) else f(0)
        found.append(struct.pack("<ff", force, count))
        last = x
    assert running.hashlib.sha256(b"".join(found)).hexdigest() == running.GOLDEN[running.rubbing_wall]


def test_an_engine_that_is_missing_is_told(tmp_path, monkeypatch):
    def without_llvm(program, engine):
        if engine == "llvm":
            raise EngineMissingError("llvmlite is not installed")
        return load(program, engine)

    monkeypatch.setattr(running, "load", without_llvm)
    with pytest.raises(Attention, match="llvm: llvmlite is not installed"):
        running.engines(tmp_path)


def test_an_engine_with_other_bits_is_a_fault(tmp_path, monkeypatch):
    class Off:
        def __init__(self, engine):
            self.engine = engine

        def run(self, *given):
            return types.SimpleNamespace(outputs=np.nextafter(self.engine.run(*given).outputs.astype("f4"), np.float32(9)))

    monkeypatch.setattr(running, "load", lambda program, name: (Off if name == "vm" else (lambda k: k))(load(program, name)))
    with pytest.raises(Fault, match="vm gives bits that differ from the stored ones"):
        running.engines(tmp_path)


# ---------------------------------------------------------------- a link, sweeps, a scene


def test_a_link_that_moves_the_handle_differently_is_a_fault(tmp_path, monkeypatch):
    simulated = running.SimulatedPaddle
    real = running.connect
    monkeypatch.setattr(running, "connect", lambda url, paddle, T: real(url, paddle=simulated(m=0.06, b=0.1, T=T), T=T))
    with pytest.raises(Fault, match="moves differently"):
        running.link(tmp_path)


def test_a_link_whose_library_is_missing_is_told(tmp_path, monkeypatch):
    def missing(*_, **__):
        raise EngineMissingError("found no cc, gcc, clang or ziglang")

    monkeypatch.setattr(running, "connect", missing)
    with pytest.raises(Attention, match="found no cc"):
        running.link(tmp_path)


def test_processes_that_give_other_numbers_are_a_fault(tmp_path, monkeypatch):
    real = running.sweep

    def sweep(*given, workers=1, **options):
        return types.SimpleNamespace(values=real(*given, **options).values + (workers != 1))

    monkeypatch.setattr(running, "sweep", sweep)
    with pytest.raises(Fault, match="two processes give"):
        running.sweeps(tmp_path)


def test_a_scene_that_rests_elsewhere_is_a_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(running, "plot", lambda *_: pytest.fail("drawn"))
    real = running.load_scene

    def heavier(path):
        file = real(path)
        return running.replace(file, scene=file.scene(K=310.0))

    monkeypatch.setattr(running, "load_scene", heavier)
    with pytest.raises(Fault, match="from the static equilibrium"):
        running.scene(tmp_path)


# ---------------------------------------------------------------- places


def test_line_endings_that_change_a_scene_are_a_fault(tmp_path, monkeypatch):
    real = file_checks.load_scene
    monkeypatch.setattr(file_checks, "load_scene", lambda path: running.replace(real(path), duration=len(path.read_bytes())))
    with pytest.raises(Fault, match="the scenes differ"):
        file_checks.line_endings(tmp_path)


def refusing(condition):
    """Return what runs no scene whose path is so, as a system that refuses such paths does."""

    def main(arguments):
        if condition(arguments[1]):
            raise OSError(36, "File name too long", arguments[1])
        folder = Path(arguments[-1])
        folder.mkdir()
        for name in ("wall.png", "wall.csv"):
            (folder / name).touch()
        return 0

    return main


def test_names_and_lengths_that_a_system_refuses_are_told(tmp_path, monkeypatch):
    monkeypatch.setattr(file_checks, "main", refusing(lambda path: not path.isascii()))
    with pytest.raises(Fault, match="spaces and other alphabets: OSError"):
        file_checks.paths(tmp_path / "a")
    monkeypatch.setattr(file_checks, "main", refusing(lambda path: len(path) > file_checks.MAX_PATH))
    with pytest.raises(Fault, match="in a path of .* File name too long"):
        file_checks.paths(tmp_path / "b")
    monkeypatch.setattr(file_checks.sys, "platform", "win32")
    with pytest.raises(Attention, match="With the settings of Windows here, a path of .* characters does not: "):
        file_checks.paths(tmp_path / "c")


def test_labs_that_lose_what_was_changed_are_a_fault(tmp_path, monkeypatch):
    real = file_checks.copy_labs

    def overwriting(folder):
        for path in folder.rglob("*.ipynb"):
            path.unlink()
        return real(folder)

    monkeypatch.setattr(file_checks, "copy_labs", overwriting)
    with pytest.raises(Fault, match="a changed notebook was not kept"):
        file_checks.labs(tmp_path)


# ---------------------------------------------------------------- the computer


def test_a_package_that_is_missing_is_a_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(computer, "requires", lambda _: ["numpy>=1", "no-such-package>=1", "no-such-extra; extra == 'test'"])
    with pytest.raises(Fault, match="hapticlab needs no-such-package, which is not installed"):
        computer.packages(tmp_path)


def test_a_coarse_clock_is_told(tmp_path, monkeypatch):
    ticks = iter(range(10**6))
    coarse = types.SimpleNamespace(perf_counter=lambda: next(ticks) // 3 * 0.015625, sleep=lambda _: None)
    monkeypatch.setattr(computer, "time", coarse)
    with pytest.raises(Attention, match="the clock steps by 1.6e\\+04 us"):
        computer.clocks(tmp_path)


def test_the_names_of_ports_stay_out(tmp_path, monkeypatch):
    """On macOS a telephone is a port, by its owner's name."""
    port = types.SimpleNamespace(device="/dev/cu.AdasPhone", known="", description="Ada's phone")
    monkeypatch.setattr(computer, "available_ports", lambda: [port])
    assert computer.ports(tmp_path) == "1 listed: no known board"


# ---------------------------------------------------------------- a class


def test_the_small_class_is_handed_in_with_names_that_differ_in_case_and_with_crlf(tmp_path):
    _, _, handed_in = teaching.written(tmp_path)
    with zipfile.ZipFile(handed_in) as archive:
        names = archive.namelist()
        assert len({name.casefold() for name in names}) == len(names) - 1
        assert sum(b"\r\n" in archive.read(name) for name in names) == 1


@pytest.fixture
def grader(monkeypatch):
    """Return what stands in for the grader: it writes these marks and pages."""

    def stands_in(marks, pages, code=0):
        def main(arguments):
            asked = dict(zip(arguments[1::2], arguments[2::2], strict=False))
            reports = [{"student": student, "earned": earned} for student, earned in marks.items()]
            Path(arguments[arguments.index("-o") + 1]).write_text(json.dumps({"reports": reports}), "utf-8")
            folder = Path(arguments[arguments.index("--pages") + 1])
            folder.mkdir()
            for page in pages:
                (folder / f"{page}.html").touch()
            return code if asked else 1

        monkeypatch.setattr(teaching, "main", main)

    return stands_in


RIGHT = {student: points for student, (_, points) in teaching.CLASS.items()}


def test_right_marks_hold_and_a_wrong_one_is_a_fault(tmp_path, grader):
    grader(RIGHT, [*"abcde", "index"])
    assert "every mark right" in teaching.graded(tmp_path / "a", "auto")
    grader(RIGHT | {"ada": 3.0}, [*"abcde", "index"])
    with pytest.raises(Fault, match="these are right"):
        teaching.graded(tmp_path / "b", "auto")
    grader(RIGHT, [*"abcde", "index"], code=1)
    with pytest.raises(Fault, match="ended with 1"):
        teaching.graded(tmp_path / "c", "auto")


def test_pages_that_are_one_file_where_case_is_ignored_are_a_fault(tmp_path, grader):
    grader(RIGHT, ["Ada", "ada", "zoe", "ended", "endless", "index"])
    with pytest.raises(Fault, match="5 pages for 5 students and the class"):
        teaching.graded(tmp_path, "auto")


def test_jupyter_that_is_missing_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(teaching, "find_spec", lambda name: None if name == "anywidget" else sys)
    with pytest.raises(Attention, match="not installed: anywidget"):
        teaching.jupyter(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("check", [running.scene, running.link, running.sweeps, computer.consoles, teaching.jupyter])
def test_a_longer_check_holds_here(check, tmp_path):
    assert check(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("level", ["auto", "none"])
def test_the_small_class_is_graded(level, tmp_path):
    assert "every mark right" in teaching.graded(tmp_path, level)


def test_every_check_is_there_once():
    names = [check.name for check in CHECKS]
    assert len(set(names)) == len(names) and len({check.function for check in CHECKS}) == len(names)
