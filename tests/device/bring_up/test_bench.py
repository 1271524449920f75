"""The walk through a first power-up: on simulated boards, sound and faulty, and on the emulated Uno."""

import json
from types import SimpleNamespace

import pytest
from emulated import emulated_uno
from emulator import CYCLES_PER_SECOND, missing

import hapticlab as hl
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.bring_up import bench as walk
from hapticlab.device.bring_up import limits, motor_off, steps, stop_times
from hapticlab.device.bring_up.about import settings_of
from hapticlab.device.bring_up.bench import OFF, ON, bench
from hapticlab.device.bring_up.practised import PractisingOwner
from hapticlab.device.bring_up.report import Finding
from hapticlab.device.bring_up.shared import Bench
from hapticlab.device.bring_up.steps import STEPS
from hapticlab.device.link.messages import STATES
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.setup import sign_check
from hapticlab.device.setup.calibrate import calibrate
from hapticlab.device.setup.practice import GRAM

STOPS = [("host silent", 0.1), ("not finite", 0.0), ("over-speed", 0.0), ("over-travel", 0.0)]


@pytest.fixture
def paddle():
    with hl.connect("sim://hapkit") as made:
        yield made


def only(monkeypatch, *names):
    """Walk these steps alone."""
    for table in (OFF, ON):
        monkeypatch.setattr(walk, "OFF" if table is OFF else "ON", {k: v for k, v in table.items() if k in names})


def verdicts(report):
    return {(f.step, f.quantity): f.verdict for f in report.findings if f.verdict in ("differs", "skipped")}


class Acts(PractisingOwner):
    """An owner for whom some questions go otherwise: {words: act}."""

    def __init__(self, board, **acts):
        super().__init__(board)
        self.others = {words.replace("_", " "): act for words, act in acts.items()}

    def ask(self, question):
        for words, act in self.others.items():
            if words in question:
                act()
                return ""
        return super().ask(question)

    def choose(self, question, options):
        return next((act() for words, act in self.others.items() if words in question), None) or super().choose(question, options)


class TestWhole:
    def test_a_sound_board_does_all_that_was_predicted(self, paddle, tmp_path):
        kept = paddle.settings
        report = bench(paddle, PractisingOwner(paddle))
        assert report.ended == "whole" and verdicts(report) == {}, str(report)
        assert {f.step for f in report.findings} == set(STEPS) - {"supply off"}
        for step, least in STOPS:
            assert least <= report[step, "stop time"].found <= least + 0.003
        assert report["cable", "the board afterwards"].found.startswith("a fault was pending: tick ")
        assert "HOST_SILENT" in report["cable", "the board afterwards"].found
        assert report.about["settings"] == str(kept)
        page, data = report.save(tmp_path / "here")
        facts = json.loads(data.read_text("utf-8"))
        assert facts["whole"] and len(facts["findings"]) == len(report.findings) == page.read_text("utf-8").count("\n| ") - 2
        assert "rehearsal" in page.read_text("utf-8") and "is tried" not in page.read_text("utf-8")

    @pytest.mark.wide
    def test_a_calibrated_practice_board(self):
        board, person = hl.devices.practice_board()
        calibrate(board, person)
        report = bench(board, PractisingOwner(board))
        assert verdicts(report) == {}, str(report)
        assert report["force", "force for 1.8 N"].found == pytest.approx(1.8, abs=0.02)

    @pytest.mark.wide
    def test_a_new_board_is_calibrated_stopped_and_only_then_given_more_force(self, monkeypatch):
        monkeypatch.setattr(sign_check, "secrets", SimpleNamespace(randbits=lambda _: 1))  # sessions still draw their own
        port = open_port("sim://hapkit")
        port.put_on(None, store=b"")
        checked = {}
        with SerialPaddle("sim://hapkit", port=port) as new:
            owner = PractisingOwner(new)
            report = bench(new, owner, tell=lambda found: checked.setdefault(found.step, owner.board.settings.checked))
        assert verdicts(report) == {}, str(report)
        assert checked["cable"] == 0 and checked["lag"] == 1  # 0.5 N at most until every stop was tried
        assert report["calibration", "stops measured"].found != "nominal"

    @pytest.mark.wide
    @pytest.mark.skipif(missing() is not None, reason=str(missing()))
    def test_the_emulated_uno(self, monkeypatch):
        monkeypatch.setattr(motor_off, "LOOP", 0.5)
        only(monkeypatch, "link", "switch", "host silent", "STOP", "Ctrl-C", "not finite", "over-speed", "cable", "lag", "force")
        silent_from = []

        def fault(shared, seconds, wait=Bench.fault):
            silent_from.append(shared.paddle.loop.board.cycle)
            return wait(shared, seconds)

        monkeypatch.setattr(Bench, "fault", fault)
        with emulated_uno() as paddle:
            report = bench(paddle, UnoOwner(UnoPort.on(paddle)))
            cycles, duties = paddle.loop.board.duties()
        assert verdicts(report) == {}, str(report)
        off = cycles[(cycles > silent_from[0]) & (duties == 0)][0]  # at the pins, from the computer's last word
        assert (off - silent_from[0]) / CYCLES_PER_SECOND == pytest.approx(report["host silent", "stop time"].found, abs=3e-3)
        assert report["lag", "force to motion"].found == pytest.approx(report["lag", "force to motion"].low + 0.5e-3, abs=0.3e-3)
        assert 0 < report["link", "step, worst"].found <= report["link", "step, worst"].high
        assert "uno.hex, CRC-32" in report.about["image that comes with this package"]


class UnoPort:
    """The port of an emulated Uno with what a simulated owner moves: handle, supply, motor, time."""

    @classmethod
    def on(cls, paddle):
        """Give a paddle's own port these attributes, and return the paddle."""
        port, loop = paddle.exchange.port, paddle.loop
        full = loop.force_full
        port.__class__ = type("UnoPort", (type(port),), {
            "handle": property(lambda self: loop.handle.handle, lambda self, handle: setattr(loop.handle, "handle", handle)),
            "wiring": property(lambda self: int(loop.force_full > 0), lambda self, on: setattr(loop, "force_full", full * on)),
            "board": property(lambda self: loop.board),
        })  # fmt: skip
        return paddle


class UnoOwner(PractisingOwner):
    """Reads the scale of an emulated Uno: what its pins make of the motor."""

    def weigh(self):
        self.board.wait(0.02)
        return f"{abs(self.port.loop.force()) / GRAM:.0f}"


class TestPartial:
    def test_ctrl_c_anywhere_ends_with_the_motor_off_and_a_report_that_says_where(self, paddle, monkeypatch):
        only(monkeypatch, "link", "switch", "host silent")
        monkeypatch.setattr(motor_off, "LOOP", 0.1)

        def interrupt():
            assert paddle.state()["state"] == STATES["RUN"]  # while the motor pulls
            raise KeyboardInterrupt

        report = bench(paddle, Acts(paddle, Switch_the_supply_off=interrupt))
        assert report.ended == "interrupted in the step 'switch'; the motor is off"
        assert report.sentence.startswith("PARTIAL: interrupted in the step 'switch'")
        assert paddle.state()["state"] != STATES["RUN"] and paddle.exchange.port.board.duty == 0
        assert {f.step for f in report.findings} == {"link"}

    def test_a_switch_that_does_not_work_ends_the_walk(self, paddle, monkeypatch):
        only(monkeypatch, "switch", "host silent")
        report = bench(paddle, Acts(paddle, Switch_the_supply_off=lambda: None))
        assert verdicts(report) == {("switch", "pull ended by the switch"): "differs"}
        assert "no step that needs the switch was done" in report.ended and paddle.exchange.port.board.duty == 0

    def test_lowered_limits_are_put_back_after_an_interrupt(self, paddle, monkeypatch):
        only(monkeypatch, "over-speed")
        kept = paddle.settings

        def interrupt():
            assert paddle.settings.speed_max == pytest.approx(steps.TRIED_SPEED)
            raise KeyboardInterrupt

        report = bench(paddle, Acts(paddle, flick=interrupt))
        assert report.ended.startswith("interrupted in the step 'over-speed'") and "still stores" not in report.ended
        assert paddle.settings == kept

    def test_an_encoder_of_few_counts_shows_the_lowered_speed_limit(self, monkeypatch):
        """A Longhorn's count is 0.74 mm, so that two counts in 1 ms are faster than a hand."""
        only(monkeypatch, "over-speed")
        with hl.connect("sim://longhorn") as coarse:
            report = bench(coarse, PractisingOwner(coarse))
            assert coarse.T == 1e-3
        assert verdicts(report) == {} and report["over-speed", "fastest sample before it"].found > 0.1

    def test_a_wiring_that_nobody_confirms_is_asked_for_once(self, monkeypatch):
        only(monkeypatch, "calibration")
        asked = []
        port = open_port("sim://hapkit")
        port.put_on(None, store=b"")
        with SerialPaddle("sim://hapkit", port=port) as new:
            no = {"Store_these_settings": lambda: asked.append("store") or "no", "This_paddle_is_not": lambda: "yes"}
            report = bench(new, Acts(new, **no))
        assert asked == ["store"] and verdicts(report)["calibration", "wiring confirmed"] == "differs"

    def test_a_link_that_fails_while_limits_are_lowered_is_told(self, paddle, monkeypatch, tmp_path):
        only(monkeypatch, "over-speed")
        kept = paddle.settings
        owner = Acts(paddle, flick=lambda: paddle.exchange.port.close())
        report = bench(paddle, owner)
        assert "does not answer, and stops its motor 100 ms after" in report.ended
        assert "still stores the lower limits" in report.ended and "the motor is off" not in report.ended
        _, data = report.save(tmp_path / "partial")
        assert settings_of(data) == kept  # what --restore stores

    def test_a_board_without_settings_is_watched_only(self, monkeypatch):
        monkeypatch.setattr(motor_off, "LOOP", 0.1)
        monkeypatch.setattr(motor_off, "MOVED", 0.1)
        port = open_port("sim://hapkit")
        port.put_on(None, store=b"")
        with SerialPaddle("sim://hapkit", port=port) as new:
            report = bench(new, Acts(new, This_paddle_is_not_calibrated=lambda: "no"))
        assert {step for step, _ in verdicts(report)} == {*ON, "calibration"}
        assert all("calibrate" in f.note for f in report.findings if f.verdict == "skipped")

    def test_a_board_that_does_not_know_where_its_handle_is_gives_no_force(self, monkeypatch):
        only(monkeypatch, "sensor moved", "switch", "STOP")
        monkeypatch.setattr(motor_off, "MOVED", 4.5)
        port = open_port("sim://hapkit")
        with SerialPaddle("sim://hapkit", port=port) as lost:
            report = bench(lost, Acts(lost, one_stop=lambda: None))
            assert set(verdicts(report)) == {(name, "the whole step") for name in ("switch", "STOP")} | {
                ("sensor moved", "the step")
            }
            assert port.board.duty == 0


class TestFaulty:
    def test_an_act_that_did_not_come_is_skipped_or_differs(self, paddle, monkeypatch):
        only(monkeypatch, "Ctrl-C", "cable", "over-speed")
        for module in (limits, stop_times):
            monkeypatch.setattr(module, "ACT", 2.0)
        nothing = {"press_Ctrl-C": lambda: None, "USB_cable_out": lambda: None, "flick": lambda: None}
        report = bench(paddle, Acts(paddle, **nothing))
        found = verdicts(report)
        assert found["Ctrl-C", "the whole step"] == found["cable", "the whole step"] == "skipped"
        assert found["over-speed", "fault"] == "differs" and not report.is_whole

    def test_a_board_that_stops_late_differs(self, paddle, monkeypatch):
        """A host that goes on talking for a while stands for firmware that waits longer."""
        only(monkeypatch, "host silent")
        refresh, said = paddle.exchange.refresh, []

        def once_more():
            state = refresh()
            if not said and paddle.exchange.beating is False and state["state"] == STATES["RUN"]:
                said.append(paddle.exchange.wait(lambda: False, 0.05) or refresh())
            return state

        monkeypatch.setattr(paddle.exchange, "refresh", once_more)
        assert verdicts(bench(paddle, PractisingOwner(paddle))) == {("host silent", "stop time"): "differs"}

    def test_a_short_range_and_a_jumping_sensor_differ(self, paddle, monkeypatch):
        only(monkeypatch, "sensor moved")
        port = paddle.exchange.port
        counts = port._counts
        monkeypatch.setattr(port, "_counts", lambda: round(0.8 * counts()) + (60 if 0.010 < port.handle.x < 0.011 else 0))
        found = verdicts(bench(paddle, PractisingOwner(paddle)))
        assert found["sensor moved", "range"] == found["sensor moved", "largest jump"] == "differs"


def test_a_number_that_is_not_finite_is_never_as_predicted():
    assert Finding.of("a", "b", float("nan"), "s", 0, 1, "").verdict == "differs"
    assert Finding.of("a", "b", float("inf"), "s", 0, float("inf"), "").verdict == "differs"
    assert Finding.of("a", "b", 1.0, "s", 0, 1, "").verdict == "as predicted"


def test_a_row_is_one_line_of_six_cells_whatever_was_said():
    row = Finding.seen("cable", "the step", False, "|F| <= 2 N\nand more", "the board").row()
    assert row == r"| cable | the step |  | \|F\| <= 2 N and more | differs | the board |"
