"""What labs 04, 09, 10, 14, 15 and 17 do with a real paddle: no cell moves its motor unasked."""

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


@pytest.mark.parametrize(("number", "asks"), [("09", 4), ("10", 1), ("14", 2), ("17", 0)])
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


def test_lab_15_couples_two_handles_only_after_enter(monkeypatch):
    asked, started = [], []

    def nobody(question):
        asked.append(question)
        raise EOFError

    monkeypatch.setattr(builtins, "input", nobody)
    monkeypatch.setattr(hl.devices.TwoPaddles, "start", lambda *_, **__: started.append("motors"))
    couples = next(cell for cell in cells("15") if "real_link" in cell)
    partner = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    with hl.connect("sim://hapkit") as board:
        exec(couples, {"hl": hl, "paddle": board, "held": partner})
        assert asked == []
        with pytest.raises(EOFError):
            exec(couples.replace("= False", "= True"), {"hl": hl, "paddle": board, "held": partner})
    assert len(asked) == 1 and started == []


@pytest.mark.wide
def test_lab_04_runs_on_a_recording_and_starts_no_motor(monkeypatch):
    """Its smaller version, which asks nobody in any lab, is above; here every cell runs, for a handle that somebody flicked."""
    started = []
    monkeypatch.setattr(hl.devices.SerialPaddle, "start", lambda *_, **__: started.append("motor"))
    flicked = hl.SimulatedPaddle.from_profile("hapkit", coulomb=0.04, noise=8e-6)
    first, *rest = cells("04")
    with hl.connect("sim://hapkit") as board:
        names = {"board": board}
        head, simulated, tail = first.partition("simulated = ")
        exec(f"{head}\npaddle = board\n{simulated}{tail}", names)
        for cell in rest:
            exec(cell, names)
            if "view = hl.live" in cell:
                names["view"] = SimpleNamespace(log=flicked.run(names["free"], duration=0.6, v=0.4))
    assert started == []
    assert names["truth"] is names["twin"] and names["twin"].coulomb == pytest.approx(0.04, rel=0.01)
    assert names["touched"] is names["leaning"] is names["paddle"]
