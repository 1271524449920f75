"""A simulated board with the profile of one paddle: ``sim://bench7.json`` is that paddle, and says what is wrong with a file."""

from dataclasses import replace

import pytest

import hapticlab as hl
from hapticlab.device.link.messages import MOTOR_LAWS, SENSORS
from hapticlab.errors import HapticlabError, PaddleError, PortError

DAY = "measured, 2026-11-20"
#: constants of a Hapkit that nobody has
FOUND = {"m": 0.034, "b": 0.12, "coulomb": 0.05, "delay": 2e-4, "sensor_delay": 3e-4, "sensor_noise": 9e-6}


def twin(base="hapkit", **known):
    """Return a profile whose constants were measured on a day."""
    kind, known = hl.devices.profile(base), FOUND | known
    units = {name: hl.base.profile.constants.unit_of(name) for name in known}
    found = [hl.identify.Estimate(name, at, 0.9 * at, 1.1 * at, units[name], DAY) for name, at in known.items()]
    return replace(kind, name="bench 7", nominal=False, **known, estimates=tuple(found))


@pytest.fixture
def file(tmp_path, monkeypatch):
    """The name of a file in the current folder."""
    monkeypatch.chdir(tmp_path)
    return twin().save("Bench 7.json").name


def test_the_board_and_its_handle_are_those_of_the_file(file, tmp_path):
    for url in (f"sim://{file}", f"sim://{tmp_path / file}", f"sim://./{file}?pace=real"):
        with hl.connect(url) as board:
            kept = board.settings
            handle = board.exchange.port.handle.paddle
            assert str(board).startswith("host 0000, firmware 2.0, T = 1 ms, calibrated 2026-11-20, |F| <= 3.3 N")
        told = {name: getattr(kept, name) for name in ("m", "b", "coulomb", "sensor_delay", "sensor_noise")}
        assert told == pytest.approx({name: FOUND[name] for name in told})
        assert (handle.m, handle.delay, handle.noise) == (0.034, 2e-4, 9e-6)
        assert kept.sensor == SENSORS["MAGNETORESISTIVE"] and kept.motor_law == MOTOR_LAWS["SQRT"] and kept.wired and kept.checked


def test_a_wall_on_it_is_the_wall_on_the_simulated_paddle_of_the_file(file):
    scene = hl.wall()(k=300, x_o=0.0)
    body = hl.SimulatedPaddle.from_profile(file)
    alone = body.run(scene, duration=0.05, v=0.0, x=0.002)
    port = hl.device.link.serial_ports.open_port(f"sim://{file}")
    port.put_on(body, x=0.002)
    with hl.devices.SerialPaddle("sim://", port=port) as board:
        board.home(at=0.002)
        felt = board.run(scene, duration=0.05)
    # the board counts the handle's own readings, which have noise of their own
    assert abs(felt.x - alone.x).max() < 6e-5 and felt.delay == pytest.approx(2e-4)


@pytest.mark.wide
def test_identified_again_it_is_what_the_file_says(file):
    with hl.connect(f"sim://{file}") as board:
        found = hl.identify.paddle(board, kinds=("steps",), confidence=0.999)
        again = hl.identify.twin("again", found, base=board)
    for name in ("m", "b", "coulomb", "sensor_delay"):
        assert FOUND[name] in again[name], again[name]
    assert again.force_full == 8.0 and again.source.endswith("calibrated on 2026-11-20")


def test_a_file_of_a_slow_paddle_brings_its_period_and_a_measured_motor_its_curve(tmp_path):
    curve = {"duty_dead": 0.05, "duty_25": 0.3, "duty_50": 0.55, "duty_75": 0.8}
    with hl.connect(f"sim://{twin('longhorn', T=2e-3, **curve).save(tmp_path / 'slow')}") as board:
        assert board.T == 2e-3 and board.settings.motor_law == MOTOR_LAWS["MEASURED"]
        assert board.settings.force_of_duty(board.settings.duty(1.0)) == pytest.approx(1.0, rel=1e-6)
        assert board.settings.duty_25 == pytest.approx(0.3)
    with hl.connect("sim://hapkit_slow") as board, hl.connect("sim://hapkit_coarse") as other:
        assert board.T == 2e-3 and other.settings.metres_per_count == pytest.approx(1e-4)


@pytest.mark.parametrize("kind", ["hapkit", "hapkit_as5048a", "longhorn", "motor_shield"])
def test_the_twin_of_a_board_keeps_what_the_board_was_told(kind, tmp_path):
    with hl.connect(f"sim://{kind}") as board:
        known = hl.identify.twin("mine", base=board, coulomb="50 mN", date="2026-11-20")
        told = board.settings
    with hl.connect(f"sim://{known.save(tmp_path / 'mine')}") as board:
        assert board.settings == replace(told, date=20261120, coulomb=board.settings.coulomb)
        assert board.settings.coulomb == pytest.approx(0.05)


def test_a_wiring_that_no_kind_has_makes_a_plain_board(tmp_path):
    with hl.connect(f"sim://{replace(twin(), wiring='').save(tmp_path / 'bare')}") as board:
        assert board.settings.motor_law == MOTOR_LAWS["LINEAR"] and board.settings.m == pytest.approx(0.034)


def test_what_is_wrong_with_a_file_is_said(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.json").write_text('{"format": "hapticlab', encoding="utf-8")
    refusals = {
        "sim://none.json": r"sim://none\.json: none\.json: there is no such file\. .*Put the file there, or save a profile",
        "sim://bad.json": r"bad\.json is not a profile: it is damaged: .*Give a file that profile\.save\(\) wrote",
        "sim://bench7": r"sim://bench7: no such paddle; there are sim://hapkit, .*_rough, .*sim://bench7\.json",
        "sim://": "no such paddle; there are sim://hapkit",
    }
    for url, words in refusals.items():
        with pytest.raises(PaddleError, match=words):
            hl.connect(url)
    with pytest.raises(PortError, match=r'bench7\.json is a file and not a port\. .*open "sim://bench7\.json"'):
        hl.connect("bench7.json")
    assert str(hl.doctor("sim://none.json")).count("there is no such file") == 1


def test_a_profile_where_a_paddle_is_needed_is_refused_with_the_call_that_makes_one(tmp_path):
    known, scene = twin(), hl.wall()(k=100)
    calls = (
        lambda given: hl.connect("sim://hapkit", paddle=given),
        lambda given: hl.share(scene, given, tmp_path / "wall.html"),
        lambda given: hl.live(given, scene),
        lambda given: hl.measure.largest_stiffness(given),
        lambda given: hl.identify.paddle(given),
        lambda given: hl.stability.wall_map(given),
        lambda given: hl.design.compare_laws(given, K=100),
    )
    for call in calls:
        for given in (known, "bench7.json"):
            with pytest.raises(HapticlabError, match=r"hl\.SimulatedPaddle\.from_profile\(\.\.\.\)"):
                call(given)
    with pytest.raises(HapticlabError, match=r"hl\.devices\.profile\('bench7\.json'\)"):
        hl.passivity_limit("bench7.json")
    assert hl.devices.profile(known) is known
