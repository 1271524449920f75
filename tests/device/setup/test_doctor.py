"""The doctor's walk: what it says of ports, firmware, sensors, stops and motors that are as they should be, and that are not."""

import os
import threading

import pytest
import workbench as bench
from workbench import HOMING, STOP, holding, swaying

import hapticlab as hl
from hapticlab.device.board import greeting
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.serial_ports import Port
from hapticlab.device.setup import doctor as walk
from hapticlab.device.setup import doctor_checks as checks
from hapticlab.device.setup.doctor import doctor
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import EngineMissingError, LinkError, PortError

KNOWN = nominal("hapkit", metres_per_count=2 * STOP / 7000, travel_min=-STOP, travel_max=STOP, wired=1, date=20261120)
UNO = Port("/dev/ttyACM0", "", 0x2341, 0x0043, "A1", "Arduino Uno R3")
STRANGER = Port("/dev/ttyUSB7", "a mill")


def states(report):
    """The walk's own steps: what is said of this computer before is tested in test_computer_checks.py."""
    return {check.name: check.state for check in report.checks if check.name not in ("notebook", "rights")}


def on(paddle, person=None):
    """Walk on from a paddle that is connected."""
    return walk.Report(tuple(walk._on_board(paddle, person)))


class TestPorts:
    @pytest.fixture
    def plugged(self, monkeypatch):
        def plug(*ports):
            monkeypatch.setattr(walk, "available_ports", lambda: list(ports))

        return plug

    def test_no_port_at_all(self, plugged):
        plugged()
        report = doctor()
        assert (report.checks[-1].name, report.exit_code) == ("computer", 1)
        for word in ("no serial port", "another cable", "driver", "--port"):
            assert word in str(report)

    def test_who_owns_no_board_reads_short_lines_and_what_works_without(self, plugged, monkeypatch):
        plugged()
        monkeypatch.setenv("COLUMNS", "72")
        report = doctor()
        assert report.checks[-1].state == "no board" and str(report).endswith("no board")
        lines = str(report).splitlines()
        assert any("everything else works without a board; try: hapticlab labs" in line for line in lines)
        assert all(len(line) <= 72 for line in lines if not line.lstrip().startswith(("sudo ", "/")))
        assert sum(line.lstrip().startswith("sudo ") and line.endswith(("trigger", "$USER")) for line in lines) in (0, 2)

    def test_a_stranger_is_never_opened(self, plugged, monkeypatch):
        plugged(STRANGER)
        monkeypatch.setattr(walk, "open_port", lambda url: pytest.fail("opened"))
        assert "no known board: /dev/ttyUSB7 (a mill)" in str(doctor())

    def test_two_boards_are_to_be_named(self, plugged, monkeypatch):
        plugged(UNO, Port("/dev/ttyACM1", known="Arduino Uno R3"))
        monkeypatch.setattr(walk, "open_port", lambda url: pytest.fail("opened"))
        assert "name one of /dev/ttyACM0, /dev/ttyACM1" in str(doctor())

    @pytest.mark.parametrize("cause", ["busy", "permission", "missing"])
    def test_a_port_that_does_not_open_says_why(self, plugged, monkeypatch, cause):
        plugged(UNO, STRANGER)

        def refuses(url):
            raise PortError(f"{url}: so it is; do this", cause)

        monkeypatch.setattr(walk, "open_port", refuses)
        report = doctor()
        assert states(report) == {"computer": "ok", "port": "fault"}
        assert f"/dev/ttyACM0 does not open ({cause})" in str(report)
        assert "do this" in report["port"].cure

    def test_a_simulated_paddle_that_is_none(self):
        report = doctor("sim://xx")
        assert states(report) == {"computer": "ok", "port": "fault"}
        assert report["port"].found == "sim://xx does not open"
        assert "sim://hapkit" in report["port"].cure

    def test_a_simulated_paddle_without_its_library(self, monkeypatch):
        def missing(url):
            raise EngineMissingError("found no cc; install one")

        monkeypatch.setattr(walk, "open_port", missing)
        assert doctor("sim://hapkit")["port"].cure == "found no cc; install one"

    def test_a_real_port_that_is_missing(self):
        report = doctor("/dev/no-such-port")
        assert report.exit_code == 1
        assert "no such port" in report["port"].cure


class TestFirmware:
    def test_a_fault_that_stood_is_told(self):
        with bench.paddle(store=KNOWN.to_bytes()) as paddle:
            paddle.home(at=0.0)
            paddle.start(hl.Scene(force=0 * hl.x(hl.n), name="nothing"), force_max=0.1)
            paddle.exchange.beating = False
            paddle.exchange.wait(lambda: False, 0.2)
            found, _ = checks.firmware(paddle.exchange.port, "sim://hapkit", SerialPaddle)
        assert [check.name for check in found] == ["firmware", "reset", "fault"]
        assert "HOST_SILENT" in found[-1].found and found[-1].state == "attention"

    def test_a_device_that_says_nothing(self, monkeypatch):
        monkeypatch.setattr(walk, "SerialPaddle", lambda url, port: _brief(url, port))
        report = doctor("loop://")
        assert states(report)["firmware"] == "fault"
        assert "no paddle answers" in str(report)

    def test_a_bootloader_alone(self, monkeypatch):
        monkeypatch.setattr(checks, "_bootloader_answers", lambda url: True)
        found = checks._other_firmware("/dev/ttyACM0", LinkError("no paddle answers"))
        assert "hapticlab flash --port /dev/ttyACM0" in found.cure

    @pytest.mark.wide
    @pytest.mark.skipif(not hasattr(os, "openpty"), reason="this system has no pseudo-terminals")
    @pytest.mark.parametrize("answer", [b"\x14\x10", b""])
    def test_a_bootloader_is_found_on_a_terminal(self, monkeypatch, answer):
        monkeypatch.setattr("hapticlab.device.setup.flash.SYNC_WAITS", (0.2,))
        monkeypatch.setattr("hapticlab.device.setup.flash.RESETS", 1)
        ours, theirs = os.openpty()
        name = os.ttyname(theirs)
        over = threading.Event()

        def answers():
            while b"0 " not in os.read(ours, 99):
                pass
            os.write(ours, answer)
            over.set()

        thread = threading.Thread(target=answers)
        thread.start()
        assert checks._bootloader_answers(name) == bool(answer)
        thread.join(5)
        assert over.is_set()
        os.close(ours)
        os.close(theirs)

    def test_another_version(self, monkeypatch):
        monkeypatch.setattr(greeting, "table_hash", lambda: 1)
        report = doctor("sim://hapkit")
        assert states(report)["firmware"] == "fault"
        assert "hapticlab firmware of another version" in str(report)
        other = LinkError("a board's own words, which hold another version", "BUSY")
        assert "neither a paddle nor a bootloader answers" in checks._other_firmware("loop://", other).found
        assert "hapticlab flash" in str(report)

    @pytest.mark.parametrize(
        ("cause", "state", "word"), [(2, "ok", "reset pin"), (3, "attention", "power supply"), (4, "attention", "hung")]
    )
    def test_the_last_reset_is_told(self, cause, state, word):
        found = checks._reset_cause(cause)
        assert found.state == state
        assert word in found.found + found.cure


def _brief(url, port):
    return SerialPaddle(url, port=port, hello=0.2)


class TestBoard:
    def test_a_simulated_board_runs_at_the_period_of_its_paddle(self, tmp_path):
        file = hl.devices.profile("hapkit_slow").at(T=5e-3).save(tmp_path / "mine")
        assert "T = 2 ms" in doctor("sim://hapkit_slow")["firmware"].found
        assert "T = 5 ms" in doctor(f"sim://{file}")["firmware"].found

    def test_a_good_paddle_without_a_person(self):
        told = []
        report = doctor("sim://hapkit", tell=told.append)
        assert report.exit_code == 0
        assert tuple(told) == report.checks
        assert states(report) == {
            "computer": "ok", "port": "ok", "firmware": "ok", "reset": "ok", "settings": "ok", "wiring": "ok", "latency": "ok",
            "loop": "ok", "link": "ok", "noise": "ok", "sensor": "skipped", "home": "skipped", "motor": "skipped",
        }  # fmt: skip
        assert str(report).count("needs a person") == 1 and "a person must move the handle" in " ".join(str(report).split())
        assert [r["name"] for r in report.records()][:2] == ["notebook", "computer"]
        assert repr(report) == f"Report({str(report).splitlines()[-1]})"
        assert "the same as in this package; host 0000, firmware 2." in " ".join(str(report).split())

    def test_nominal_settings_are_to_be_measured_but_for_a_simulated_board(self):
        paddle = bench.paddle(store=nominal("hapkit").to_bytes())
        assert (checks.settings(paddle).state, checks.settings(paddle).cure) == ("ok", "")
        paddle.url = "COM3"
        assert "hapticlab calibrate" in checks.settings(paddle).cure

    def test_a_new_board_is_watched_all_the_same(self):
        report = on(bench.paddle())
        assert report.exit_code == 0
        assert states(report)["settings"] == "attention"
        assert "2000 samples of 2000" in str(report)

    def person(self, paddle, hand, **answers):
        led = {"move the handle slowly from stop to stop": lambda p: setattr(p.handle, "hand", hand)}
        return bench.Scripted(paddle, led | HOMING | {"Which paddle is built": "hapkit", "motor's sign is": "no"} | answers)

    def test_with_a_person(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        report = on(paddle, self.person(paddle, swaying(amplitude=0.05, period=4.0)))
        assert states(report)["sensor"] == states(report)["home"] == "ok"
        # between its stops the handle makes 7000 counts, 7.6 turns of 920
        assert "7000 counts from end to end, 7.6 turns of 920" in str(report)
        assert "calibrated 2026-11-20" in report.checks[0].found
        assert "not checked, so at most 0.5 N" in str(report)

    def test_a_sensor_that_does_not_follow(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        report = on(paddle, self.person(paddle, holding(0.0)))
        assert report.exit_code == 1
        assert "magnet" in next(c for c in report.checks if c.name == "sensor").cure

    def test_a_sensor_that_jumps(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        person = self.person(paddle, swaying(amplitude=0.03, period=4.0))
        port, whole = paddle.exchange.port, paddle.exchange.port.handle
        counts = type(whole).counts
        # a sensor that wraps every 970 counts where the board takes 920: 50 are gained at every turn
        type(whole).counts = lambda handle: (c := round(handle.x * port._per_metre)) + 50 * (c // 970)
        try:
            report = on(paddle, person)
        finally:
            type(whole).counts = counts
        assert states(report)["sensor"] == "attention"
        found = next(c for c in report.checks if c.name == "sensor").found
        assert int(found.split()[-1]) >= 50

    def test_a_noisy_sensor(self):
        paddle = bench.paddle(store=KNOWN.to_bytes(), mechanics=SimulatedPaddle(m=0.03, b=0.1, T=1e-3, noise=4e-5))
        report = on(paddle)
        noise = next(c for c in report.checks if c.name == "noise")
        assert noise.state == "attention"
        # 40 um over 12.86 um per count are 3.1 counts rms, and a rounded one a little more
        assert float(noise.found.split()[-2]) == pytest.approx((3.11**2 + 1 / 12) ** 0.5, rel=0.1)

    @pytest.mark.parametrize(("wiring", "state"), [(1, "ok"), (-1, "fault"), (0, "attention")])
    @pytest.mark.always("-1-fault")
    def test_the_motors_sign(self, wiring, state):
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=wiring)

        def led(person):
            person.move(holding(0.0))
            person.handle.hand = swaying()

        answers = {"motor's sign is": "yes", "Hold the handle lightly": led, "Store these settings": "no"}
        person = bench.Scripted(paddle, HOMING | answers)
        assert checks.home(paddle, person).state == "ok"
        assert checks.sign(paddle, person).state == state

    def test_stops_that_are_not_found(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        person = bench.Scripted(paddle, {"one stop, then to the other": bench.at(0.01)})
        found = checks.home(paddle, person)
        assert found.state == "fault"
        assert "calibrate the stops again" in found.cure

    @pytest.mark.parametrize(("delay", "word"), [(5e-3, "hub"), (16e-3, "FTDI")])
    def test_a_slow_link_is_told(self, monkeypatch, delay, word):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        clock = [0.0]
        monkeypatch.setattr(paddle.exchange, "now", lambda: clock[0])
        monkeypatch.setattr(paddle.exchange, "ask", lambda *_: clock.__setitem__(0, clock[0] + delay))
        found = checks.latency(paddle)
        assert found.state == "attention"
        assert word in found.cure
        assert f"{delay * 1e3:.2f} ms median" in found.found

    def test_lost_samples_are_told(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        read = paddle.exchange.port.read
        turn = iter(range(10**6))
        paddle.exchange.port.read = lambda size=1: _cut(read(size), next(turn))
        loop, link = checks.loop_and_link(paddle)
        assert link.state == "attention"
        assert "a different, short cable" in link.cure
        assert loop.state == "ok"


def _cut(data, turn):
    """Flip bits of one byte in a hundred pieces."""
    return bytes([data[0] ^ 0x55]) + data[1:] if data and turn % 100 == 99 else data
