"""Readings in flight between the ends of an angle sensor, and readings that do not move: what the firmware makes of them."""

import math
import struct

import numpy as np
import pytest
from host_driver import Host, fault_name, fixed, settings, spring, state_name

import hapticlab as hl
from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.link.messages import SENSORS

COUNT, WRAP = 12.8e-6, 920
MAGNET = dict(sensor=SENSORS["MAGNETORESISTIVE"], wrap=WRAP, metres_per_count=COUNT)
#: where the sensor's ends are, in counts of the position
OFFSET = 300
FULL_SPEED = 1.98  # [m/s]; 2 is the limit


def to_and_fro(speed, turning=160.0, half=0.045):
    """A path at a speed [m/s] both ways, which turns at what a Hapkit's motor can do, 8 N on 0.05 kg."""
    run, turn = (2 * half - speed**2 / turning) / speed, 2 * speed / turning

    def path(t):
        s, way = t % (2 * (run + turn)), 1
        if s >= run + turn:
            s, way = s - run - turn, -1
        late = max(0.0, s - run)
        return way * (-run * speed / 2 + speed * s - turning * late**2 / 2)

    return path


class Flying:
    """A sensor's reading at a position and a speed: right after an end it lies between both, evenly or drawn."""

    def __init__(self, flight, seed=None):
        self.flight, self.random = flight, None if seed is None else np.random.default_rng(seed)

    def read(self, counts, speed):
        place = math.floor(counts + OFFSET) % WRAP
        gone = place if speed > 0 else WRAP - 1 - place
        if gone < abs(speed) * self.flight:
            part = gone / (abs(speed) * self.flight) if self.random is None else self.random.random()
            place = round((WRAP - 1) * (1 - part if speed > 0 else part))
        return place


def follow(path, flight, T=1e-3, seconds=2.0, seed=None, run=True, scene=None):
    """Move a magnet along a path; return the host, the errors of its positions [m] and how many readings were in flight."""
    host, sensor = Host(speed_max=2.0, **MAGNET), Flying(flight, seed)
    blips, errors = 0, []

    def tick(n):
        nonlocal blips
        x, v = path(n * T), (path(n * T + 1e-7) - path(n * T - 1e-7)) / 2e-7
        reading = sensor.read(x / COUNT, v / COUNT)
        blips += reading != math.floor(x / COUNT + OFFSET) % WRAP
        host.board.tick(reading, n * T)
        host.hear()

    tick(0)
    host.hello()
    assert host.ask("HOME", path(0)) == "OK"
    if run:
        host.load(scene or spring(T=T))
        host.set(_0=1.0)
        assert host.start() == "OK"
    for n in range(1, round(seconds / T)):
        tick(n)
        state = host.state()
        errors.append(state["x"] - path(n * T))
        if run and state_name(state["state"]) != "RUN":
            break
    return host, np.array(errors), blips


@pytest.mark.parametrize("flight", [0.0, 50e-6, 100e-6, 200e-6])
@pytest.mark.parametrize("T", [0.25e-3, 1e-3])
@pytest.mark.always("0.001-0.0002")
def test_a_reading_in_flight_neither_stops_the_motor_nor_loses_the_position(T, flight):
    """It did: of these runs at 50 to 200 us every one ended in OVER_SPEED. Readings lie anywhere between the ends."""
    for seed in (None, 1, 2):
        host, errors, blips = follow(to_and_fro(FULL_SPEED), flight, T, seed=seed, seconds=2.0 if T == 1e-3 else 0.5)
        assert state_name(host.state()["state"]) == "RUN" and host.has("HOMED"), fault_name(host.state()["fault"])
        assert (blips > 10) == (flight > 0)
        wrong = np.abs(errors) > 5 * COUNT
        # two ticks of a quarter of the limit and the noise's 8 counts, at the most
        assert np.abs(errors).max() < 3 * (FULL_SPEED * T / 4 + 8 * COUNT) and wrong.sum() <= 2 * blips
        assert np.abs(errors[-3:]).max() < 2 * COUNT or wrong[-3:].any()


@pytest.mark.slow
@pytest.mark.parametrize("turning", [100.0, 160.0])
@pytest.mark.parametrize("speed", [0.3, 1.0, FULL_SPEED])
@pytest.mark.parametrize("T", [0.25e-3, 0.5e-3, 1e-3])
def test_readings_in_flight_over_many_paths(T, speed, turning):
    """No fault in 2 s of any of them."""
    for flight in (50e-6, 100e-6, 200e-6):
        for seed in range(8):
            host, _, _ = follow(to_and_fro(speed, turning), flight, T, seed=seed)
            assert state_name(host.state()["state"]) == "RUN" and host.has("HOMED"), (flight, seed)


def test_a_sweep_over_the_ends_finds_the_position_in_idle():
    """A reading in flight taken for a stop would move the middle."""
    path = lambda t: 0.05 * math.sin(2 * math.pi * 1.2 * t) if t < 2.5 else 0.0  # 0.38 m/s  # noqa: E731
    host, sensor = Host(**MAGNET), Flying(200e-6, 3)
    host.hello()
    for n in range(3000):
        x, v = path(n * 1e-3), (path(n * 1e-3 + 1e-7) - path(n * 1e-3 - 1e-7)) / 2e-7
        host.board.tick(sensor.read(x / COUNT, v / COUNT), n * 1e-3)
    assert host.has("HOMED") and not host.has("TRAVEL_MISMATCH")
    assert host.state()["x"] == pytest.approx(0.0, abs=5e-5)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("speed, within", [(1.98, None), (2.05, 4), (2.25, 4), (2.5, 3), (4.0, 3)])
def test_over_speed_is_found_in_three_ticks_or_four(speed, within, way):
    """2 m/s is the limit; an eighth more may also be a reading in flight before, so that it takes two pairs of readings."""
    pull = 500.0  # [m/s^2], of 25 N on 50 g
    reached = speed / pull

    def path(t):
        late = max(0.0, t - reached)
        return way * (pull * min(t, reached) ** 2 / 2 + speed * late)

    host, errors, _ = follow(path, 0.0, seconds=0.02)
    if within is None:
        assert state_name(host.state()["state"]) == "RUN"
    else:
        assert fault_name(host.state()["fault"]) == "OVER_SPEED"
        too_fast = math.ceil(2.0 / pull / 1e-3)  # the last tick at the limit
        assert too_fast < len(errors) <= too_fast + within


def test_a_jump_that_stays_is_over_speed():
    """A magnet that turns by a quarter on its shaft is no motion, nor a reading in flight."""
    host = Host(speed_max=2.0, **MAGNET).running(_0=1.0)
    host.tick(10, beat=True)
    host.tick(10 + 450, beat=True)
    assert state_name(host.state()["state"]) == "RUN"
    host.tick(10 + 450, beat=True)
    assert fault_name(host.state()["fault"]) == "OVER_SPEED" and not host.has("HOMED")


@pytest.mark.parametrize("T", [1e-3, 2e-3])
@pytest.mark.always("0.001")
def test_a_contact_that_fails_in_a_tenth_of_the_readings_ends_the_run_and_loses_the_position(T):
    """The run ended, but the board took the position for known after it, a turn away: in 30 of 150 runs at 2 ms."""
    lasted = []
    for seed in range(20):
        host, random = Host(speed_max=2.0, **MAGNET).running(spring(T=T), _0=1.0), np.random.default_rng(seed)
        begun = host.t
        while state_name(host.state()["state"]) == "RUN" and host.t - begun < 3:
            host.tick(int(random.integers(0, WRAP)) if random.random() < 0.1 else 0)
        lasted.append(host.t - begun)
        assert fault_name(host.state()["fault"]) == "OVER_SPEED" and not host.has("HOMED")
    assert T > 1e-3 or (np.median(lasted) < 0.25 and np.quantile(lasted, 0.9) < 0.5)


# ---------------------------------------------------------------- frozen


def frozen(host, count=lambda k: 0, ticks=1500):
    """Turn the clock with what the sensor shows; return the duties until the fault."""
    duties = []
    for k in range(ticks):
        duties.append(abs(host.tick(count(k), beat=True)))
        if state_name(host.state()["state"]) != "RUN":
            break
    return np.array(duties)


@pytest.mark.parametrize("flicker", [0, 1])
def test_a_frozen_reading_drives_no_force_for_longer_than_1_2_s(flicker):
    """It did for ever: 1.32 N stayed for 3 s, until the run ended. A dead sensor's converter flickers by a count."""
    host = Host().running(fixed(1.32))
    duties = frozen(host, lambda k: flicker * (k % 2))
    assert fault_name(host.state()["fault"]) == "FROZEN" and len(duties) == 1201
    assert np.ptp(duties[:1000]) == 0 and (np.diff(duties[1000:-1]) < 0).all() and duties[-1] == 0
    assert not host.has("HOMED")
    assert host.faults[0].fields["value"] == pytest.approx(1.32)


def test_a_frozen_as5048a_is_found_in_its_own_noise():
    """Noise of 2.7 of its 16384 counts, its data sheet's, was taken for motion: the force stayed for ever."""
    for seed in range(5):
        noise = np.random.default_rng(seed).normal(0.4, 2.73, 3000).round().astype(int)
        host = Host(sensor=SENSORS["AS5048A"], wrap=16384, metres_per_count=12.8e-6 * 2 * 920 / 16384).running(fixed(1.32))
        frozen(host, lambda k, noise=noise: int(noise[k]), ticks=len(noise))
        assert fault_name(host.state()["fault"]) == "FROZEN"


def test_a_live_reading_gets_its_force_back_at_once():
    host = Host().running(fixed(1.32))
    duties = frozen(host, lambda k: 2 if k >= 1100 else 0, ticks=1150)
    assert duties[1099] == pytest.approx(duties[0] / 2, rel=0.02) and (duties[1100:] == duties[0]).all()


@pytest.mark.parametrize("F, at", [(0.5, 0.0), (1.32, 0.048), (1.32, -0.048)])
@pytest.mark.always("1.32-0.048")
def test_small_forces_and_a_handle_at_a_stop_may_stay(F, at):
    """0.5 N is what a motor of unknown sign may give for ever; at a stop nothing moves."""
    host = Host().ready(fixed(F), at=at)
    assert host.start() == "OK"
    duties = frozen(host, ticks=1500)
    assert len(duties) == 1500 and np.ptp(duties) == 0 and duties[0] > 0


@pytest.mark.parametrize("stiffness", [20.0, 500.0, pytest.param(10_000.0, marks=pytest.mark.wide)])
@pytest.mark.parametrize("counts_per_metre", [2e4, 78125])
@pytest.mark.always("78125-500.0")
def test_a_hand_that_holds_still_is_no_frozen_sensor(stiffness, counts_per_metre):
    """No tremor, no noise: the hand gives way by counts as the force fades, and has it back."""
    k, x_o = hl.parameters("k x_o", units="N/m m")
    wall = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)), name="wall")
    hand = hl.Hand(m=0.1, b=1.4 * math.sqrt(0.1 * stiffness), k=stiffness, push=3.0)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=counts_per_metre, hand=hand)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        log = board.run(wall(k=200.0, x_o=-0.02), 4.0, progress=False)
    held = log.F[2000:]
    assert log.fault is None and (held > 0.7 * np.median(held)).all()
    assert np.mean(held < 0.98 * np.median(held)) < 0.1


def test_a_capstan_that_slipped_is_seen_where_the_handle_leaves_its_travel():
    """Found with the motor off; it stayed homed at wrong positions."""
    host = Host().ready()
    host.tick(5400)
    assert host.has("HOMED")
    host.tick(5600)
    assert not host.has("HOMED") and host.has("TRAVEL_MISMATCH")


def test_a_hold_is_not_broken_off_by_samples_of_zero_force():
    """The second counts ticks of force alone, so that a force that comes and goes on a frozen sensor ends too."""
    host = Host(HostBoard(settings().to_bytes())).running(spring(), _0=0.0)
    host.tick(300, times=2)
    for _ in range(700):
        host.set(_0=800.0)  # 2.4 N
        host.tick(300, times=2)
        host.set(_0=0.0)
        host.tick(300, times=2)
    assert fault_name(host.state()["fault"]) == "FROZEN"
    assert struct.unpack_from("<f", host.samples[-1].payload, 13)[0] == 0
