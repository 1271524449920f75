"""A scene kept on a board runs without a computer, after the deliberate act and not before."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.board.settings import nominal
from hapticlab.errors import LinkError, PaddleError, ProgramLimitError

SPRING = hl.Scene(force=hl.parameters("k", units="N/m") * hl.x(hl.n), name="spring")
T = 1e-3


def counts_of_the_act(per_metre):
    """Both stops, led there and back in 4 s, then 2 s at rest in the middle, in counts of a board that woke at 12 mm."""
    quarter = np.linspace(0, 1, 1000)
    path = np.r_[0.012 + (0.05 - 0.012) * quarter, 0.05 - 0.1 * quarter, -0.05 + 0.05 * quarter, np.zeros(2000)]
    return np.round((path - 0.012) * per_metre).astype(int)


def test_it_starts_with_the_act_and_not_before():
    with hl.connect("sim://hapkit") as paddle:
        assert "both stops" in paddle.keep(SPRING(k=40))
        store, settings = paddle.exchange.port.board.store, paddle.settings
    board, path = HostBoard(store), counts_of_the_act(1 / settings.metres_per_count)
    duties = np.array([board.tick(int(c), n * T) for n, c in enumerate(path)])
    rest = 3000 - 11  # the last half millimetre before the middle counts as rest already: 1 s from there on
    assert (duties[: rest + 1000] == 0).all()
    pushed = round(0.01 / settings.metres_per_count)  # 10 mm beyond the middle, which is 12 mm below where it woke
    late = [board.tick(int(path[-1]) + min(pushed, 20 * k), (len(path) + k) * T) for k in range(200)]
    F = settings.force_of_duty(late[-1])
    assert F == pytest.approx(-40 * 0.01, rel=2e-3)  # the motor gives -F; the sweep finds the middle to a count


def test_a_forgotten_scene_never_starts():
    with hl.connect("sim://hapkit") as paddle:
        paddle.keep(SPRING(k=40))
        paddle.forget()
        store, settings = paddle.exchange.port.board.store, paddle.settings
    board = HostBoard(store)
    assert not any(board.tick(int(c) + 300, n * T) for n, c in enumerate(counts_of_the_act(1 / settings.metres_per_count)))


def test_it_is_refused_where_it_would_not_be_safe():
    with hl.connect("sim://hapkit") as paddle:
        paddle.start(SPRING(k=40))
        with pytest.raises(PaddleError, match="a scene is running; end it first:"):
            paddle.keep(SPRING(k=40))
        paddle.stop()
        unchecked = nominal("hapkit", checked=0)
        paddle.settings = unchecked
        with pytest.raises(PaddleError, match="the sign of the motor was not checked"):
            paddle.keep(SPRING(k=40))


def test_an_unstable_scene_is_not_kept():
    z, K, m = hl.coordinate("z", unit="m"), *hl.parameters("K m", units="N/m kg", values=(5e5, 0.05))
    F = K * (hl.x(hl.t) - z)
    coupler = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)])
    with hl.connect("sim://hapkit") as paddle, pytest.raises(PaddleError, match="unstable as bound"):
        paddle.keep(coupler, method="semi_implicit_euler")


def test_a_scene_that_could_be_late_is_not_kept():
    """Nobody stands by to see an overrun; of a board whose speed is not known nothing is said."""
    slow = sum(hl.parameters("A", units="N") * sp.sin(j * hl.x(hl.n) / hl.parameters("x_o", units="m")) for j in range(1, 9))
    scene = hl.Scene(force=slow, name="eight sines")(A=0.1, x_o=0.05)
    with hl.connect("sim://hapkit") as paddle:
        paddle.board["board"] = "uno"
        with pytest.raises(
            ProgramLimitError, match=r"eight sines: .* of a 1 ms period on uno .*guaranteed bound.*; fits at T = "
        ):
            paddle.keep(scene)
        assert "both stops" in paddle.keep(hl.Scene(force=0.1 * hl.parameters("k", units="N/m") * hl.x(hl.n), name="s")(k=1))
        paddle.board["board"] = "due"
        assert "both stops" in paddle.keep(scene)


@pytest.mark.wide
def test_too_large_for_the_store_is_the_boards_word():
    past = sum(hl.x(hl.n - j) / (j + 1) for j in range(700))  # 700 states: 5 kB of moves alone
    with hl.connect("sim://hapkit") as paddle, pytest.raises(LinkError, match="TOO_LARGE"):
        paddle.keep(hl.Scene(force=hl.parameters("k", units="N/m") * past, name="long memory")(k=1))
