"""What labs 09 and 10 do with a real paddle: no cell moves its motor unasked, and a throw by hand is cut to its flight."""

import builtins
import contextlib
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

LABS = {folder.number: folder for folder in find_labs(Path(__file__).parents[2] / "labs")}


def cells(number):
    return code_of(read(LABS[number].notebook))


@pytest.mark.parametrize(("number", "asks"), [("09", 4), ("10", 2)])
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
        exec(f"{head}\npaddle = board\n{simulated}{tail}", names)
        names["found"] = SimpleNamespace(profile=lambda: None)  # the cell that makes it is refused
        for cell in rest:
            if re.search(r"paddle\.run\(|\((paddle|held)[,)]|= task\.|_choice\(", cell) and "hl.live(" not in cell:
                with contextlib.suppress(Exception):  # EOFError, and the names that a cell refused does not make
                    exec(cell, names)
    assert started == []
    assert len(asked) == asks, asked


@pytest.mark.parametrize("finger", [600, 3000])
def test_a_throw_by_hand_gives_the_mass(finger):
    """A finger [N/m] that can only push throws, lets go and catches; m, b and friction are known, no code is shared."""
    m, b, coulomb, A, h, count = 0.03, 0.15, 0.05, 0.15, 1e-4, 12.8e-6
    x, v, seen = 0.0, 0.0, []
    for i in range(20000):
        s = min(max((i * h - 0.5) / 0.08, 0.0), 1.0)
        place = 0.016 * (10 * s**3 - 15 * s**4 + 6 * s**5)
        caught = max(0.0, finger / 3 * (0.004 - x) - 3 * v) if x < 0.004 else 0.0
        push = caught if s == 1 else max(0.0, finger * (place - x))
        if s > 0:
            v += h * (push - A - b * v - coulomb * np.sign(v)) / m
            x += h * v
        if i % 10 == 0:
            seen.append(np.floor(x / count) * count)
    x = np.array(seen)
    log = hl.records.Telemetry(t=np.arange(len(x)) * 1e-3, x=x, v=0 * x, F=0 * x + A, T=1e-3)
    names = {"np": np, "hl": hl, "T": 1e-3, "beta": b / m}
    throw, lines = (next(c for c in cells("09") if f"def {name}" in c) for name in ("flight", "least_squares"))
    exec(lines.partition("\n\n\n")[0], names)
    exec(throw[throw.index("def flight") : throw.index("rise, fall = ")], names)
    rising, falling = (names["parabola"](log.t[p] - log.t[p][0], log.x[p])[0] for p in names["flight"](log))
    assert 2 * A / (rising + falling) == pytest.approx(m, rel=0.01)  # counts leave 0.3 % over flights of 37 to 105 ms
    assert (rising - falling) * m / 2 == pytest.approx(coulomb, rel=0.03)
