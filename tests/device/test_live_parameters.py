"""Parameters set while a scene runs: past what keeps a step stable they are refused, one alone and together."""

import pickle
from dataclasses import replace

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.compiler.tick.live_limits import part_of_the_way
from hapticlab.device.live_parameters import check_margin, checked
from hapticlab.errors import PaddleError, ParameterError
from hapticlab.scene.frozen import Frozen

z = hl.coordinate("z", unit="m")
K, B, m = hl.parameters("K B m", units="N/m N*s/m kg", values=(500, 0.0, 0.05))


def scene(**values):
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="coupler")(**values)


def program(method="semi_implicit_euler", **values):
    return hl.compile(scene(**values), method, T=1e-3, live="K m")


def test_one_past_its_limit():
    """K <= 4 m/h^2 = 200 kN/m, m >= K h^2/4 = 0.125 g."""
    known = program()
    assert checked(known, {"K": 190_000}) == {"K": 190_000.0}
    with pytest.raises(ParameterError, match=r"K = 210000: a step is stable for K <= (2e\+05|1\.99\d*e\+05).*more substeps"):
        checked(known, {"K": 210_000})
    with pytest.raises(ParameterError, match=r"m = 0\.0001: a step is stable for m >= 0\.000125"):
        checked(known, {"m": 1e-4})


def test_two_that_are_stable_alone():
    """K/m may grow 400-fold: 30-fold of each would be 900, 19-fold 361."""
    known = program()
    checked(known, {"K": 15_000}), checked(known, {"m": 0.05 / 30}), checked(known, {"K": 9_500, "m": 0.05 / 19})
    with pytest.raises(ParameterError, match=r"K = 1.5e\+04, m = 0.001667: a step is unstable; .*move one back, .*substeps"):
        checked(known, {"K": 15_000, "m": 0.05 / 30})
    # what was set before counts
    values = [15_000.0 if c.name == "K" else value for c, value in zip(known.parameters, known.values, strict=True)]
    with pytest.raises(ParameterError, match=r"m = 0.001667, K = 1.5e\+04: a step is unstable"):
        checked(replace(known, values=tuple(values)), {"m": 0.05 / 30})
    # past its own limit, it is stable beside a softer spring
    assert checked(known, {"K": 50, "m": 0.05 / 3000}) == {"K": 50.0, "m": 0.05 / 3000}


def test_what_moves_away_from_its_limit_makes_no_room():
    """A damper and a heavier body are both stable alone; k_2 grows past what heun allows where its damper goes."""
    B_2 = {"B": 4.0, "m": 0.05}
    known = hl.compile(scene(**B_2), "heun", T=1e-3, live="K m B")
    assert checked(known, {"K": 2000})
    with pytest.raises(ParameterError, match="K = 2000, B = 0.001: a step is unstable"):
        checked(known, {"K": 2000, "B": 1e-3})


def test_a_pickled_program_goes_by_parts():
    known = pickle.loads(pickle.dumps(program()))
    assert type(known.limits) is Frozen and known.limits == program().limits
    with pytest.raises(ParameterError, match=r"K = 1.5e\+04 \(57 %\), m = 0.001667 \(57 %\): .* add up to 11[34] %"):
        checked(known, {"K": 15_000, "m": 0.05 / 30})
    with pytest.raises(ParameterError, match=r"K = 210000: a step is stable for K <= "):
        checked(known, {"K": 210_000})
    assert checked(known, {"K": 50, "m": 0.05 / 300}) == {"K": 50.0, "m": 0.05 / 300}


def test_taylor_goes_by_its_radian():
    """omega h = (5e7/0.05)^(1/2) 1 ms = 31.6 rad."""
    known = program("taylor")
    assert checked(known, {"K": 49_000}) == {"K": 49_000.0}
    with pytest.raises(ParameterError, match=r"K = 5e\+07: .*turns by 31.6 rad; method='taylor' needs at most 1"):
        checked(known, {"K": 5e7})


def test_what_has_no_value_yet_is_looked_at_when_it_has():
    K_1 = hl.parameters("K_1", units="N/m")
    F = K_1 * (x(t) - z)
    known = hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), "verlet", T=1e-3, live="K_1 m")
    assert any("K_1 has no value. It is checked when the value is set" in note for note in known.notes)
    assert checked(known, {"m": 1e-6}) and checked(known, {"K_1": 190_000})
    with pytest.raises(ParameterError, match=r"K_1 = 2.1e\+05: a step is unstable"):
        checked(known, {"K_1": 210_000})


def test_a_parameter_that_no_output_sees_hides_nothing():
    """The motion of u is left out of the program, and with it its stiffness."""
    u, k_u = hl.coordinate("u", unit="m"), hl.parameters("k_u", units="N/m", values=20)
    F = K * (x(t) - z)
    eom = [sp.Eq(m * z.diff(t, 2), F), sp.Eq(m * u.diff(t, 2), -k_u * u)]
    known = hl.compile(hl.Scene(force=F, eom=eom), "verlet", T=1e-3)
    assert "k_u" not in [c.name for c in known.parameters]
    with pytest.raises(ParameterError, match="K = 210000: a step is stable for K <= "):
        checked(known, {"K": 210_000})


def test_what_is_unstable_already_may_become_less_so():
    known = program(K=500_000)
    assert checked(known, {"K": 400_000}) and checked(known, {"K": 500})
    with pytest.raises(ParameterError, match="a step is unstable"):
        checked(known, {"K": 600_000})


def test_parts_of_the_way():
    assert part_of_the_way(50.0, 100.0, 400.0) == pytest.approx(-0.5)
    assert part_of_the_way(0.0, 100.0, 400.0) < 0 < part_of_the_way(1e3, 100.0, 400.0)
    # past zero the way begins at a thousandth of the limit
    assert part_of_the_way(0.05, 0.0, 5.0) == pytest.approx(1 / 3) and part_of_the_way(-2.0, 1.0, -2.0) == 1.0


def test_a_board_is_not_given_what_is_unstable_as_bound():
    check_margin(program())
    with pytest.raises(PaddleError, match=r"coupler: unstable as bound: .* its longest step is 0\.00063\d* s.*passive=True"):
        check_margin(program(K=500_000))
    with pytest.raises(PaddleError, match=r"oscillation doubles in 0.14 s."):
        check_margin(program("euler"))


def test_a_board_refuses_both(board):
    """What is unstable as bound does not start, but with the motor off; past a limit nothing is set, and what runs goes on."""
    with pytest.raises(PaddleError, match="unstable as bound"):
        board.start(scene(K=500_000), method="semi_implicit_euler", live="K")
    board.start(scene(K=500_000), method="semi_implicit_euler", live="K", passive=True)
    board.stop()
    with pytest.raises(PaddleError, match="unstable as bound"):  # what is on the board already, too
        board.start()
    board.start(scene(K=20, B=0.01), method="semi_implicit_euler", live="K")
    board.wait(0.05)
    with pytest.raises(ParameterError, match=r"K = 900000: a step is stable for K <= "):
        board.set(K=900_000)
    board.set(K=25)
    board.wait(0.05)
    log = board.stop()
    assert log.fault is None and [values for _, values in log.changes] == [{"K": 25.0}]
