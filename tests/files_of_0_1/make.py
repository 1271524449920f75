"""Write the files beside this one, with the code of version 0.1 (commit 071f95f): `PYTHONPATH=checkout python make.py`."""

import json
from dataclasses import asdict
from pathlib import Path

import sympy as sp

import hapticlab as hl
from hapticlab.device.board import SerialPaddle
from hapticlab.device.profiles import profile
from hapticlab.device.serial import open_port
from hapticlab.device.settings import nominal
from hapticlab.grading.journal import Journal
from hapticlab.grading.report import ExerciseReport, Failing, Report

HERE = Path(__file__).parent


def main():
    """Write a record, a profile, a sweep, an experiment, a journal of grading and a board's memory."""
    assert hl.__version__ == "0.1.0"
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
    z = hl.coordinate("z", unit="m")
    F = hl.parameters("K", units="N/m", values=300.0) * (hl.x(hl.t) - z)
    m = hl.parameters("m", units="kg", values=0.05)
    log = paddle.run(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)], watch=[z], name="coupled"), duration=0.05)
    log.save(HERE / "log.npz")
    log.to_csv(HERE / "log.csv")
    (HERE / "profile.json").write_text(json.dumps(asdict(profile("hapkit")), indent=1) + "\n", encoding="utf-8")
    hl.sweep(hl.wall(), paddle, k=[100.0, 200.0, 400.0], duration=0.3, resume=HERE / "walls.sweep")
    asked = hl.ConstantLevels([0.1, 0.5], repeats=2)
    hl.forced_choice(paddle, hl.stiffness_task(), hl.SimulatedObserver(weber=0.05), asked).save(HERE / "choices.json")
    wrong = Failing(given={"k": 150.0}, value=-1.5, expected=1.5, unit="N", public=True)
    exercises = (ExerciseReport("02.wall", "function", points=2.0, answered=True, right=1, cases=3, words="sign", failing=wrong),)
    with Journal(HERE / "marks.journal", fresh=True) as journal:
        journal.write("0" * 64, Report("ada", "02", "Walls", "wall.ipynb", exercises=exercises))
    port = open_port("sim://hapkit")
    port.put_on(None, settings=nominal("hapkit", ident=0x3F2A, date=20260301, checked=1, force_max=2.5, m=0.031))
    with SerialPaddle("sim://hapkit", port=port) as board:
        spring = hl.Scene(force=hl.parameters("k", units="N/m", values=40.0) * hl.x(hl.n), name="spring")
        board.keep(spring)
        (HERE / "board.store").write_bytes(port.board.store.rstrip(b"\xff"))


if __name__ == "__main__":
    main()
