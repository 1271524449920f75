"""Two paddles in virtual time against the equations written out, and on boards of the firmware's own core."""

import numpy as np
import pytest

import hapticlab as hl

T = 1e-3
AT_ONCE = hl.laws.Engagement(ramp=T, jump=1.0)


def paddle(**changes):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.1, "T": T, **changes})


def sides(architecture, **values):
    roles = ("leader", "follower")
    return [hl.laws.bilateral_coupling(architecture, role=role, engagement=AT_ONCE)(**values) for role in roles]


def written_out(force, delay, ticks, start, speeds):
    """Positions of two free handles under a force of both histories; between samples they move by Taylor's series."""
    m, b = 0.05, 0.1
    x, v = np.zeros((2, ticks + 1)), np.zeros((2, ticks + 1))
    x[:, 0], v[:, 0] = start, speeds
    F = np.zeros((2, ticks))
    for n in range(ticks):
        for i in range(2):
            F[i, n] = force(x, v, F, i, n, delay)
            a, xn, vn = (-F[i, n] - b * v[i, n]) / m, x[i, n], v[i, n]
            for k in range(1, 12):  # x^(k+1) = a (-b/m)^(k-1)
                vn += a * (-b / m) ** (k - 1) * T**k / np.prod(np.arange(1, k + 1.0))
                xn += a * (-b / m) ** (k - 1) * T ** (k + 1) / np.prod(np.arange(1, k + 2.0))
            x[i, n + 1], v[i, n + 1] = xn + v[i, n] * T, vn
    return x[:, :-1], F


def position_position(x, v, F, i, n, d):
    if n < d:
        return 0.0
    return 60 * (x[i, n] - x[1 - i, n - d]) + 0.4 * (v[i, n] - v[1 - i, n - d])


def position_force(x, v, F, i, n, d):
    if i == 1:
        return position_position(x, v, F, 1, n, d)
    return -position_position(x, v, F, 1, n - d, d)  # what the follower gave, which begins when it heard the leader


def wave(x, v, F, i, n, d):
    """The other's outgoing wave v + F/b arrives, once it has heard; a filter of 50 Hz keeps a part of what arrived before."""
    if n < d:
        return 0.0
    b, gain, kept = 1.5, 2 * np.pi * 50 * T, v[i, n - 1] - F[i, n - 1] / 1.5 if n > d else 0.0
    came = v[1 - i, n - d] + F[1 - i, n - d] / b if n >= 2 * d else 0.0
    return b * (v[i, n] - (kept + gain * came) / (1 + gain))


@pytest.mark.parametrize(
    "architecture, force, values",
    [
        ("position-position", position_position, {"k": 60, "b": 0.4}),
        ("position-force", position_force, {"k": 60, "b": 0.4}),
        ("wave", wave, {"b": 1.5}),
    ],
)
def test_it_is_the_law_written_out_with_the_delay_that_was_asked_for(architecture, force, values):
    run = hl.devices.TwoPaddles(paddle(), paddle(), *sides(architecture, **values), delay=7 * T).run(
        0.3, x=(0.002, -0.001), v=(0.1, -0.05)
    )
    x, F = written_out(force, 7, 300, (0.002, -0.001), (0.1, -0.05))
    found = np.array([run.left.x, run.right.x])
    assert abs(found - x).max() < 2e-5 * abs(x).max()  # float32 on the board
    assert abs(np.array([run.left.F, run.right.F]) - F).max() < 1e-3 * abs(F).max()
    assert (run.to_right.median, run.to_right.worst) == pytest.approx((7 * T, 7 * T))


@pytest.mark.parametrize(("ramp", "delay", "v"), [(0.02, "50 ms", (0.2, 0.0)), (0.1, "5 ms", (0.2, 0.2)), (0.5, T, (0.2, 0.2))])
def test_waves_give_handles_nothing_that_move_before_the_first_message(ramp, delay, v):
    """Against the work of both motors as the recordings have it; the handles have 1 mJ each."""
    side = hl.laws.bilateral_coupling("wave", engagement=hl.laws.Engagement(ramp=ramp, jump=1.0))(b=1.5)
    run = hl.devices.TwoPaddles(paddle(), paddle(), side, delay=delay).run(0.5, v=v)
    given = -sum(np.cumsum(log.F[:-1] * np.diff(log.x)) for log in (run.left, run.right))
    assert given.max() < 1e-6 and given[-1] < -1e-4


@pytest.mark.wide
def test_a_line_of_waves_between_handles_at_rest_is_a_spring_that_its_delay_and_its_filter_make():
    held = [
        paddle(hand=hl.Hand(m=0.5, b=50, k=5000, intent=lambda t, at=at: at * np.clip(t / 0.3 - 0.2, 0, 1))) for at in (0.01, 0)
    ]
    run = hl.devices.TwoPaddles(*held, *sides("wave", b=2.0), delay=20 * T).run(1.0)
    around = slice(-80, None)  # two turns of the line
    spring = run.left.F[around].mean() / (run.left.x - run.right.x)[around].mean()
    assert spring == pytest.approx(2.0 / (20 * T + 1 / (2 * np.pi * 50)), rel=5e-3)


def test_the_same_call_gives_the_same_run_and_another_seed_another_one():
    def run(seed):
        pair = hl.devices.TwoPaddles(paddle(), paddle(), *sides("position-position", k=50), jitter="5 ms", loss=0.1, seed=seed)
        return pair.run(0.2, x=(0.01, 0.0))

    first, again, other = run(3), run(3), run(4)
    assert np.array_equal(first.left.F, again.left.F) and not np.array_equal(first.left.F, other.left.F)
    assert first.to_left.worst > first.to_left.median >= T and first.to_right.lost > 0.05


def test_what_is_sent_to_either_side_is_never_a_force(monkeypatch):
    heard = []
    from hapticlab.device.pair.sides import Side

    hear = Side.hear
    monkeypatch.setattr(Side, "hear", lambda side, message: (heard.append(set(message or ())), hear(side, message))[1])
    for architecture in ("position-position", "position-force", "wave"):
        pair = hl.devices.TwoPaddles(paddle(), paddle(), *sides(architecture, **{"k": 50, "b": 1.0}))
        pair.run(0.01)
    assert set().union(*heard) == {"other_x", "other_v", "other_gain", "echo_x", "echo_v", "beat"}


def test_two_boards_in_virtual_time_follow_each_other():
    side = hl.laws.bilateral_coupling()(k=50, b=0.2)
    with hl.connect("sim://hapkit") as left, hl.connect("sim://hapkit") as right:
        right.exchange.port.lead(0.0)
        pair = hl.devices.TwoPaddles(left, right, side, delay="3 ms")
        run = pair.run(0.2)
    assert run.fault is None and run.left.gain[-1] > 0.3
    assert 3e-3 <= run.to_right.median <= 5e-3 and run.to_left.lost < 0.05


def test_a_board_is_not_given_twice_and_a_scene_must_hear():
    side = hl.laws.bilateral_coupling()(k=50)
    with hl.connect("sim://hapkit") as board, pytest.raises(hl.errors.PaddleError, match="both sides"):
        hl.devices.TwoPaddles(board, board, side)
    with (
        hl.connect("sim://hapkit") as one,
        hl.connect("sim://hapkit?pace=real") as other,
        pytest.raises(hl.errors.PaddleError, match="one board runs by the clock"),
    ):
        hl.devices.TwoPaddles(one, other, side)
    with pytest.raises(hl.errors.PaddleError, match="does not hear another paddle"):
        hl.devices.TwoPaddles(paddle(), paddle(), hl.wall()(k=100))
    with pytest.raises(hl.errors.PaddleError, match="the other paddle, whose"):
        hl.devices.TwoPaddles(paddle(), paddle(), hl.laws.bilateral_coupling("position-force", role="leader")(k=5), side)
    with pytest.raises(hl.errors.PaddleError, match="same T"):
        hl.devices.TwoPaddles(paddle(), paddle(T=5e-4), side)
    with pytest.raises(hl.errors.PaddleError, match="loss = 1; a link needs loss >= 0 and < 1: no message would come"):
        hl.devices.TwoPaddles(paddle(), paddle(), side, loss=1)


@pytest.mark.parametrize("pace", ["", "?pace=real"])
def test_a_simulated_paddle_and_a_board_follow_each_other(pace):
    """In virtual time, and by the clock: then the simulated one keeps up with it."""
    side = hl.laws.bilateral_coupling()(k=50, b=0.2)
    with hl.connect(f"sim://hapkit{pace}") as board:
        board.exchange.port.lead(0.0)
        run = hl.devices.TwoPaddles(paddle(hand=hl.Hand("pinch", intent=lambda t: 0.01 + 0 * t)), board, side).run(0.3)
    assert run.fault is None and run.right.x[-1] > 1e-3 and run.right.F[-1] < 0 < run.left.F[-1]


def test_it_is_set_while_it_runs_and_drawn():
    pair = hl.devices.TwoPaddles(paddle(), paddle(), *sides("position-position", k=50))
    with pytest.raises(hl.errors.PaddleError, match=r"pair.start\(\)"):
        pair.wait(0.1)
    pair.start(x=(0.002, 0.0))
    pair.wait(0.02)
    pair.set(k=100)
    pair.wait(0.02)
    run = pair.stop()
    apart = run.left.x[2:] - run.right.x[1:-1]
    assert run.left.F[2:][[5, -5]] == pytest.approx((np.array([50, 100]) * apart[[5, -5]]), rel=1e-5)
    assert [values for _, values in run.left.changes] == [{"k": 100.0}]
    assert "the left handle moves between" in run.plot().alt


def test_a_relay_that_fails_leaves_no_motor_on(monkeypatch):
    side = hl.laws.bilateral_coupling()(k=50)
    with hl.connect("sim://hapkit?pace=real") as board:
        pair = hl.devices.TwoPaddles(paddle(), board, side)
        pair.start()
        pair.wait(0.05)
        monkeypatch.setattr(pair._left, "message", lambda *_: 1 / 0)
        pair.wait(0.1)
        assert board.under_way is None
        assert "the relay ended: ZeroDivisionError" in pair.stop().fault
