"""What labs 09, 10 and 14 do with a real paddle: no cell moves its motor unasked."""

import builtins
import contextlib
import re
from pathlib import Path
from types import SimpleNamespace

import pytest

import hapticlab as hl
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

LABS = {folder.number: folder for folder in find_labs(Path(__file__).parents[2] / "labs")}


def cells(number):
    return code_of(read(LABS[number].notebook))


@pytest.mark.parametrize(("number", "asks"), [("09", 4), ("10", 1), ("14", 2)])
def test_no_cell_starts_a_motor_where_nobody_presses_enter(number, asks, monkeypatch):
    asked, started = [], []

    def nobody(question=""):
        asked.append(question)
        raise EOFError

    monkeypatch.setattr(builtins, "input", nobody)
    monkeypatch.setattr(hl.devices.SerialPaddle, "start", lambda *_, **__: started.append("motor"))
    first, *rest = cells(number)
    with hl.connect("sim://hapkit") as board:
        names = {"board": board}
        head, simulated, tail = first.partition("simulated = ")
        exec(f"{head}\npaddle = held = board\n{simulated}{tail}", names)
        # the cells that make them are refused
        names |= {"found": SimpleNamespace(profile=lambda: None), "twin": hl.devices.profile("hapkit_rough"), "T": 1e-3}
        for cell in rest:
            if re.search(r"paddle\.run\(|\(\s*(paddle|held)[,)]|= task\.|_choice\(", cell) and "hl.live(" not in cell:
                with contextlib.suppress(Exception):  # EOFError, and the names that a cell refused does not make
                    exec(cell, names)
    assert started == []
    assert len(asked) == asks, asked
