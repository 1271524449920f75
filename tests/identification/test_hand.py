"""A hand identified from short pushes: covered as often as said, the device's friction known, and told where it reacts."""

from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.errors import AnalysisError
from hapticlab.identification.hand import _motion, _start, _windows
from hapticlab.identification.identifying_forces import Excitation
from hapticlab.identification.known_handle import KnownHandle
from hapticlab.identification.paddle import after
from hapticlab.identification.scoring import fit

GRIP = hl.Hand(m=0.1, b=5, k=500, push=0.5)
PADDLE = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, delay=0.4e-3, noise=5e-6, hand=GRIP)
TRUE = {"m": 0.1, "b": 5.0, "k": 500.0}


def check(found, **true):
    for name, value in true.items():
        # a seeded draw: not outside of two intervals' widths
        assert abs(found[name].value - value) < 2 * found[name].half_width, name


def test_a_hand_is_told_from_a_paddle_that_pushes_it():
    paddle = replace(PADDLE, counts_per_metre=1 / 12.8e-6)
    found = hl.identify.hand(paddle, pushes=4)
    check(found, **TRUE)
    assert found["k"].half_width < 0.05 * 500 and found.explained and found.converged
    hand = found.hand(push=1.0)
    assert (hand.m, hand.push) == (found["m"].value, 1.0)
    assert "hand identified" in str(found) and "oscillates at 11" in str(found)


def test_friction_of_the_device_is_no_part_of_the_hand():
    paddle = replace(PADDLE, coulomb=0.05)
    log = hl.identify.pushes(paddle, pushes=4)
    check(hl.identify.hand(log, paddle), **TRUE)
    blind = hl.identify.hand(log, replace(paddle, coulomb=0.0))
    assert not blind.explained or 5.0 not in blind["b"]


def test_intervals_cover_the_hand():
    """Noise drawn anew over one true motion: 120 records fitted together."""
    log = hl.identify.pushes(replace(PADDLE, noise=0.0), pushes=2)
    windows, handle = _windows(log, 0.06), KnownHandle(0.03, 0.1, 0.0, 0.4e-3)
    clean = np.concatenate([log.x[a:z] for a, z in windows])[:, None]
    y = clean + 5e-6 * np.random.default_rng(0).standard_normal((len(clean), 120))
    start, scales = (np.repeat(a[:, None], 120, axis=1) for a in _start(log, windows, handle))
    found = fit(_motion(log, windows, handle, 0), y, [start[:, None]], lambda _: scales)
    true = np.array(list(TRUE.values()))[:, None]
    covered = (np.abs(found.values[:3] - true) < found.half_width()[:3]).mean(axis=1)
    # four standard errors of 120 draws with 95 %
    assert np.all(np.abs(covered - 0.95) < 4 * (0.95 * 0.05 / 120) ** 0.5), covered


def test_a_hand_that_does_not_hold_still_is_told():
    trembling = replace(PADDLE, hand=replace(GRIP, push_noise=0.3))
    found = hl.identify.hand(hl.identify.pushes(trembling, pushes=4), PADDLE)
    assert not found.explained
    assert "NOT EXPLAINED" in str(found) and "tremor" in str(found)


def test_a_hand_on_a_board_is_identified_by_the_same_call():
    pytest.importorskip("serial")
    paddle = replace(PADDLE, counts_per_metre=1 / 12.8e-6)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        found = hl.identify.hand(board, paddle, pushes=3)
    check(found, **TRUE)


def test_refusals_say_what_to_do():
    log = PADDLE.run(hl.laws.virtual_damper()(B=0), duration=0.2)
    with pytest.raises(AnalysisError, match="no push in 200 samples.*hl.identify.pushes"):
        hl.identify.hand(log, PADDLE)
    with pytest.raises(AnalysisError, match=r"the paddle is not known\. .*hl\.identify\.paddle"):
        hl.identify.hand(log)


def board_of(paddle):
    """Return a simulated board and the list of the records it makes."""
    pytest.importorskip("serial")
    board, logs = hl.connect("sim://hapkit", paddle=paddle), []
    run = board.run

    def kept(*given, **options):
        logs.append(run(*given, **options))
        return logs[-1]

    board.run = kept
    return board, logs


@pytest.mark.parametrize("coulomb", [0.0, 0.05])
def test_a_handle_that_nobody_holds_is_not_pushed_with_all_force(coulomb):
    free = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=coulomb, noise=5e-6, counts_per_metre=1 / 12.8e-6)
    board, logs = board_of(free)
    with (
        board,
        pytest.raises(
            hl.errors.PaddleError,
            match="hl.identify.hand: pushed by .* did not come back. A person must hold the handle in place;",
        ),
    ):
        hl.identify.hand(board)
    assert max(abs(log.F).max() for log in logs) <= 0.5
    assert max(np.ptp(log.x) for log in logs) < 0.03  # of 50 mm to the nearest stop


def test_a_push_counts_from_where_the_handle_is_and_ends_for_good():
    """30 mm from 15 mm on, where the board's zero would have left 15: the free handle goes 1 N 15 ms / 0.1 N s/m = 0.15 m."""
    free = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3)
    with pytest.raises(hl.errors.PaddleError, match="hl.identify.hand: the motor was switched off .* further than 30 mm"):
        hl.identify.pushes(free, pushes=2)
    scene = Excitation("kick", 0.5, 40, 400).scene(0.01)
    log = free.run(scene, duration=0.4, x=0.015)
    assert abs(log.x[log.cut > 0][0] - 0.015) > 0.01 >= abs(log.x[log.cut == 0] - 0.015).max()
    assert not log.F[log.cut > 0].any() and log.F[:59].any()


def test_a_fault_names_the_call_and_an_interrupt_leaves_the_motor_off(monkeypatch):
    board, _ = board_of(replace(PADDLE, counts_per_metre=1 / 12.8e-6))
    with board:
        with pytest.raises(hl.errors.PaddleError, match="hl.identify.hand: force = 99 N; the motor can give 20 N continuously."):
            hl.identify.hand(board, force=99.0)
        patch = "hapticlab.device.board.serial_paddle.SerialPaddle._collect"
        monkeypatch.setattr(patch, lambda *given: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            hl.identify.hand(board)
        assert board.state()["state"] == 0 and board.state()["force"] == 0
    log = PADDLE.run(hl.laws.virtual_damper()(B=0), duration=0.2)
    with pytest.raises(hl.errors.PaddleError, match="hl.identify.hand stopped: tick 3"):
        after(replace(log, fault="tick 3"), "hl.identify.hand")


def test_all_pushes_on_their_leash_fit_the_slowest_board(monkeypatch):
    scenes = []

    def kept(self, scene, **options):
        scenes.append(scene)
        raise KeyboardInterrupt

    monkeypatch.setattr(hl.SimulatedPaddle, "run", kept)
    with pytest.raises(KeyboardInterrupt):
        hl.identify.pushes(PADDLE)
    assert cost(hl.compile(scenes[0], T=1e-3), board="uno").fits


def measured(**constants):
    """Return a profile of PADDLE's handle with constants that were measured: value and half of the interval."""
    units = {"m": "kg", "b": "N s/m", "delay": "s", "sensor_delay": "s"}
    found = [hl.identify.Estimate(name, at, at - half, at + half, units[name]) for name, (at, half) in constants.items()]
    values = {"m": 0.03, "b": 0.1, "delay": 0.4e-3} | {one.name: one.value for one in found}
    return hl.devices.PaddleProfile("measured", **values, estimates=tuple(found))


def test_the_interval_of_a_hand_contains_that_of_the_handle():
    """The squares of the shifts of whole fits with one constant at its end add up to those of the widened interval."""
    known = {"m": (0.03, 2e-3), "b": (0.1, 0.03), "sensor_delay": (1e-4, 1e-4)}
    log, profile = hl.identify.pushes(replace(PADDLE, sensor_delay=1e-4), pushes=2), measured(**known)
    exact = profile.at(**{name: at for name, (at, _) in known.items()})
    alone, wide = hl.identify.hand(log, exact), hl.identify.hand(log, profile)
    ends = [hl.identify.hand(log, exact.at(**{name: at + half})) for name, (at, half) in known.items()]
    for name in TRUE:
        shifts = [end[name].value - alone[name].value for end in ends]
        assert wide[name].value == alone[name].value
        assert wide[name].half_width ** 2 == pytest.approx(alone[name].half_width ** 2 + np.sum(np.square(shifts)), rel=0.03)
    assert wide["m"].half_width > 1.5 * alone["m"].half_width


def test_a_mass_that_is_off_within_its_interval_is_covered():
    log = hl.identify.pushes(PADDLE, pushes=2)
    off = measured(m=(0.032, 3e-3), delay=(0.4e-3, 1e-5))
    assert 0.1 in hl.identify.hand(log, off)["m"] and 0.1 not in hl.identify.hand(log, off.at(m=0.032))["m"]


def test_the_delay_is_that_of_the_profile_and_not_that_of_the_record(tmp_path):
    """What the simulation knows of its sensor stays hidden; a computation whose time nobody identified is as recorded."""
    log = hl.identify.pushes(replace(PADDLE, sensor_delay=6e-4), pushes=2)
    twin = measured(delay=(0.4e-3, 1e-5), sensor_delay=(6e-4, 1e-5))
    found = hl.identify.hand(log, twin)
    check(found, **TRUE)
    assert hl.identify.hand(replace(log, delay=5e-3, sensor_delay=5e-3), twin)["k"] == found["k"]
    assert hl.identify.hand(log, str(twin.save(tmp_path / "bench7")))["k"] == found["k"]
    early = hl.identify.hand(log, twin.at(sensor_delay=0.0))
    assert not early.explained or 5.0 not in early["b"]
    nominal = hl.devices.PaddleProfile("nominal", m=0.03, b=0.1, delay=9e-3, sensor_delay=6e-4)
    check(hl.identify.hand(log, nominal), **TRUE)


def test_a_handle_of_unknown_mass_is_not_taken_for_a_hand():
    log = hl.identify.pushes(PADDLE, pushes=1)
    for unknown in (None, hl.Device(b=0.1, T=1e-3), log):
        with pytest.raises(AnalysisError, match=r"the paddle is not known\. Give device=, such as a twin"):
            hl.identify.hand(log, unknown)
