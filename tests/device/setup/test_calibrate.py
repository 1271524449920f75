"""Calibration: a scripted person at a simulated paddle whose truth is known, stops, signs, scales, weights and nonsense."""

import math
from dataclasses import asdict

import numpy as np
import pytest
import workbench as bench
from workbench import HOMING, STOP, STOPS, WIRED, at, flicking, holding, holding_either_side, swaying

from hapticlab.device.board.settings import Settings, nominal
from hapticlab.device.board.upload import read_settings
from hapticlab.device.link.messages import MOTOR_LAWS, SETTINGS_STRUCT
from hapticlab.device.setup import stored_settings
from hapticlab.device.setup.calibrate import calibrate, still_nominal
from hapticlab.device.setup.force_constant import GRAVITY
from hapticlab.device.setup.force_fit import fit_force
from hapticlab.device.setup.sign_check import CLEAR, LOOKS, check_sign, intervals, judge, measure_sign
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import LinkError, PaddleError

TODAY = 20261121
YES = {"Store these settings": "yes"}
KNOWN = nominal("hapkit", metres_per_count=2 * STOP / 7000, travel_min=-STOP, travel_max=STOP, wired=1)


def held_then(hand):
    """An answer: the handle rests in the middle, then this hand acts."""

    def acts(person):
        person.move(holding(0.0))
        person.handle.hand = hand

    return acts


def tugged(hand):
    return {"Hold the handle lightly": held_then(hand)}


def kept_on_board(paddle):
    return Settings.from_bytes(paddle.exchange.port.board.store[: SETTINGS_STRUCT.size])


class TestStops:
    def test_counts_become_metres(self):
        paddle = bench.paddle(metres_per_count=11.5e-6, store=nominal("hapkit", ident=7).to_bytes())
        person = bench.Scripted(paddle, STOPS | YES)
        found = calibrate(paddle, person, date=TODAY, only="stops")
        # the person's ruler says 90 mm, which is what lies between the stops
        assert found.metres_per_count == pytest.approx(11.5e-6, rel=2.0 / (2 * STOP / 11.5e-6))
        assert (found.travel_min, found.travel_max) == (np.float32(-0.045), np.float32(0.045))
        assert (found.date, found.ident, found.checked) == (TODAY, 7, 0)
        assert found.force_full == 8.0
        assert "kept       force_full = 8 N" in person.words
        assert kept_on_board(paddle) == found == paddle.settings

    @pytest.mark.parametrize(("side", "sign"), [("right", 1), ("left", -1)])
    def test_x_grows_into_the_wall(self, side, sign):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        person = bench.Scripted(paddle, STOPS | YES | HOMING | {"On which side": side})
        found = calibrate(paddle, person, date=TODAY, only="stops")
        assert math.copysign(1, found.metres_per_count) == sign
        stored_settings.lead_home(paddle, person)
        person.move(holding(0.02), 1.0)
        assert paddle.state()["x"] == pytest.approx(sign * paddle.exchange.port.handle.x, abs=1e-4)

    def test_radius_and_angle(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        by_angle = {"How was the travel": "angle", "Distance from the axis": "80", "Angle between": "64.4"}
        found = calibrate(paddle, bench.Scripted(paddle, STOPS | YES | by_angle), date=TODAY, only="stops")
        assert found.travel_max - found.travel_min == pytest.approx(0.080 * 64.4 * math.pi / 180, rel=1e-6)

    def test_a_slipping_drive_is_told(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())

        def slipped(person):
            person.move(holding(STOP + 0.005))
            person.handle.x -= 0.003  # what the sensor sees from now on lies elsewhere
            person.handle.hand = holding(person.handle.x)

        person = bench.Scripted(paddle, {"to the RIGHT stop again": slipped} | STOPS | YES)
        with pytest.raises(PaddleError, match="first sweep.*second.*Tighten the cable,"):
            calibrate(paddle, person, date=TODAY, only="stops")
        assert kept_on_board(paddle) == KNOWN.to_float32()

    def test_a_sensor_that_does_not_move_is_told(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        still = {"to the LEFT stop": at(0.0), "to the RIGHT stop": at(0.0)}
        with pytest.raises(PaddleError, match=r"a sweep needs at least 50\. .*magnet"):
            calibrate(paddle, bench.Scripted(paddle, still), date=TODAY, only="stops")

    def test_a_handle_that_does_not_rest_is_asked_again(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        hands = iter([swaying(), holding(-STOP - 0.005), holding(-STOP - 0.005)])
        person = bench.Scripted(paddle, STOPS | YES | {"to the LEFT stop": lambda p: p.move(next(hands))})
        assert calibrate(paddle, person, date=TODAY, only="stops").date == TODAY
        assert "The sensor moved by" in person.words


class TestStored:
    def test_nothing_is_written_without_a_yes(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        before = paddle.exchange.port.board.store
        calibrate(paddle, bench.Scripted(paddle, STOPS | {"Store these settings": "no"}), date=TODAY, only="stops")
        assert paddle.exchange.port.board.store == before
        assert paddle.settings == KNOWN.to_float32()

    def test_a_new_board_begins_with_its_wiring_if_agreed(self):
        paddle = bench.paddle()
        assert paddle.settings is None
        refusing = bench.Scripted(paddle, WIRED | {"Store these settings": "no"})
        assert calibrate(paddle, refusing, date=TODAY) is None
        assert set(paddle.exchange.port.board.store[: SETTINGS_STRUCT.size]) == {0xFF}
        found = calibrate(paddle, bench.Scripted(paddle, WIRED | STOPS | YES), date=TODAY, only="stops")
        assert 0 < found.ident < 65536 and (found.wired, found.checked, found.date) == (1, 0, TODAY)
        assert f"host {found.ident:04X}" in str(paddle)

    def test_a_board_that_keeps_something_else_is_refused(self, monkeypatch):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        monkeypatch.setattr(stored_settings, "read_settings", lambda exchange: nominal("hapkit", ident=1))
        with pytest.raises(LinkError, match="the board stored settings that differ"):
            stored_settings.store(paddle, nominal("hapkit", ident=2))
        assert read_settings(paddle.exchange).ident == 2

    def test_a_wrong_date_or_step_is_refused(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        with pytest.raises(PaddleError, match="date = 21"):
            calibrate(paddle, date=21)
        with pytest.raises(PaddleError, match="wiring, stops, sensor, sign, force"):
            calibrate(paddle, date=TODAY, only="mass")


HANDS = {"flicks": flicking(), "sways": swaying(), "holds": holding_either_side()}


class TestSign:
    @pytest.mark.parametrize("hand", HANDS)
    @pytest.mark.parametrize(("m", "coulomb"), [(0.03, 0.0), (0.2, 0.2)])
    @pytest.mark.parametrize(("wiring", "verdict"), [(1, "right"), (-1, "wrong")])
    @pytest.mark.always("-1-wrong-0.03-0.0-flicks")  # the right one is in each calibration
    def test_positive_work_tells_the_sign(self, hand, m, coulomb, wiring, verdict):
        mechanics = SimulatedPaddle(m=m, b=0.1, T=1e-3, coulomb=coulomb)
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=wiring, mechanics=mechanics)
        person = bench.Scripted(paddle, HOMING | tugged(HANDS[hand]))
        assert measure_sign(paddle, person, seed=3).verdict == verdict

    @pytest.mark.wide
    @pytest.mark.parametrize("hand", HANDS)
    def test_a_motor_without_supply_is_never_right(self, hand):
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=0)
        found = check_sign(paddle, bench.Scripted(paddle, HOMING | tugged(HANDS[hand])), seed=5)
        assert found.verdict == "nothing"
        assert "check its supply" in str(found)
        assert paddle.settings.checked == 0

    @pytest.mark.wide
    def test_a_handle_left_alone_is_told(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        found = measure_sign(paddle, bench.Scripted(paddle, HOMING | tugged(holding(0.0))), seed=5)
        assert found.verdict == "unmoved"
        assert "move it 10 to 20 mm" in str(found)

    @pytest.mark.wide
    def test_the_limit_holds_for_a_motor_that_does_nothing(self):
        """Z of thousands of other tosses over the same motion is as wide as the bound says: unit variance, thin tails."""
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=0)
        logs = []
        stop, paddle.stop = paddle.stop, lambda: logs.append(stop()) or logs[-1]
        measure_sign(paddle, bench.Scripted(paddle, HOMING | tugged(flicking())), seed=1)
        terms, _, sides = intervals(logs[0])
        random = np.random.default_rng(8)
        Z = np.array([judge(terms, random.choice([-1.0, 1.0], len(terms)), sides, logs[0].x).Z for _ in range(4000)])
        assert len(terms) > 90 and np.count_nonzero(terms) > 50
        assert Z.std() == pytest.approx(1, abs=0.04)  # 4000 draws: the error of a deviation is 0.011
        for c in (1.5, 2.5, 3.5):
            assert np.mean(Z >= c) <= math.exp(-(c**2) / 2)
        assert 2 * LOOKS * math.exp(-(CLEAR**2) / 2) < 4e-6

    def test_the_work_it_counts_is_the_motors(self):
        """Two hands' work cancels over fair tosses; what is left has the sign of the motor's force times its motion."""
        terms, signs, sides, moved = np.full(80, 2e-3), np.ones(80), np.tile([1.0, -1.0], 40), [0, 0.02]
        assert judge(terms, signs, sides, moved).Z == pytest.approx(math.sqrt(80))
        assert judge(terms, -signs, sides, moved).verdict == "wrong"
        assert judge(terms, np.repeat([1.0, -1.0], 40), sides, moved).verdict == "nothing"
        assert judge(terms, np.append(np.ones(55), -np.ones(25)), sides, moved).verdict == "unclear"  # 30/sqrt(80) = 3.4
        assert judge(np.append(terms, 1e3), np.append(signs, -1.0), np.append(sides, 1), moved).verdict == "right"
        assert judge(terms, signs, np.ones(80), moved).verdict == "unclear"  # nothing of the other side is known
        assert judge(terms, sides, sides, moved).verdict == "one way"
        assert judge(*np.zeros((4, 0))).verdict == "unmoved"

    @pytest.mark.wide
    def test_a_missing_direction_wire_is_never_right(self):
        """It looks right on one side of the middle, and wrong on the other."""
        for hand in (holding(-0.012, k=200, b=1), holding_either_side()):
            paddle = bench.paddle(store=KNOWN.to_bytes())
            paddle.exchange.port.settings = bench.OneWay(**asdict(paddle.exchange.port.settings))
            found = measure_sign(paddle, bench.Scripted(paddle, HOMING | tugged(hand)), seed=2)
            assert found.verdict in ("one way", "unclear")
        assert "D8" in str(found)

    def test_only_a_clear_result_lifts_the_limit(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        found = check_sign(paddle, bench.Scripted(paddle, HOMING | YES | tugged(swaying())), seed=3)
        assert (found.verdict, kept_on_board(paddle).checked) == ("right", 1)

    @pytest.mark.wide
    def test_swapped_wires_are_turned_and_checked_again(self):
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=-1)
        person = bench.Scripted(paddle, HOMING | YES | tugged(swaying()))
        assert check_sign(paddle, person, seed=3).verdict == "right"
        kept = kept_on_board(paddle)
        assert (kept.motor_sign, kept.checked) == (-1, 1)
        assert "wires are swapped" in person.words

    def test_swapped_wires_stay_if_the_person_says_no(self):
        paddle = bench.paddle(store=KNOWN.to_bytes(), wiring=-1)
        person = bench.Scripted(paddle, HOMING | {"Store these settings": "no"} | tugged(swaying()))
        assert check_sign(paddle, person, seed=3).verdict == "wrong"
        assert kept_on_board(paddle) == KNOWN.to_float32()
        assert "push in the wrong direction" in person.words

    def test_no_more_than_half_a_newton_is_asked(self):
        paddle = bench.paddle(store=KNOWN.to_bytes())
        logs = []
        stop, paddle.stop = paddle.stop, lambda: logs.append(stop()) or logs[-1]
        measure_sign(paddle, bench.Scripted(paddle, HOMING | tugged(swaying(amplitude=0.03))), seed=3)
        assert np.abs(logs[0].F).max() == 0.5
        assert np.mean(logs[0].F == 0) > 0.3

    def test_a_board_without_settings_is_refused(self):
        with pytest.raises(PaddleError, match="Calibrate the stops first"):
            check_sign(bench.paddle(), bench.Scripted(None, {}))


def scale(direction=1, resolution=1.0, offset=0.0):
    """An answer: what a kitchen scale shows [g] of the force that the motor gives now."""

    def reads(person):
        person.move(holding(0.0, k=5000), 0.2)
        port = person.paddle.exchange.port
        newtons = direction * port.wiring * port.settings.force_of_duty(port.board.duty)
        return str(resolution * round((newtons / GRAVITY * 1e3 + offset) / resolution))

    return reads


def on_a_scale(**settings):
    return {
        "How do you want to measure the force": "scale",
        "In which direction does the handle press": "wall",
        "what does the scale show": scale(**settings),
    }


CHECKED = nominal("hapkit", metres_per_count=2 * STOP / 7000, travel_min=-STOP, travel_max=STOP, wired=1, checked=1)


class TestForce:
    @pytest.mark.parametrize(("law", "dead"), [("LINEAR", 0.08), ("SQRT", 0.12)])
    def test_a_scale_tells_the_dead_band_too(self, law, dead):
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=7.0, motor_law=MOTOR_LAWS[law], duty_dead=dead)
        person = bench.Scripted(paddle, HOMING | YES | on_a_scale())
        found = calibrate(paddle, person, date=TODAY, only="force")
        assert found.motor_law == MOTOR_LAWS[law]
        assert found.duty_dead == pytest.approx(dead, abs=0.005)  # the fit tries steps of 0.0025; the scale has steps of 1 g
        assert found.force_full == pytest.approx(7.0, rel=0.02)
        assert "the dead band; 0.0 % before" in person.words

    @pytest.mark.parametrize("truth", [5.0, 8.0, 12.5])
    @pytest.mark.parametrize("law", ["LINEAR", "SQRT"])
    @pytest.mark.always("LINEAR-5.0", "SQRT-12.5")
    def test_a_scale_tells_constant_and_law(self, truth, law):
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=truth, motor_law=MOTOR_LAWS[law])
        person = bench.Scripted(paddle, HOMING | YES | on_a_scale())
        found = calibrate(paddle, person, date=TODAY, only="force")
        assert found.motor_law == MOTOR_LAWS[law]
        # 1 g steps of the scale are 3 mN rms; the largest force is 1.8 N as the board first reckons
        assert found.force_full == pytest.approx(truth, rel=0.01)
        assert found.checked == 1
        assert ("not SQRT; the stored law changes" in person.words) == (law == "LINEAR")

    def test_the_scale_may_be_on_the_other_side(self):
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=6.0)
        person = bench.Scripted(
            paddle, HOMING | YES | on_a_scale(direction=-1) | {"In which direction does the handle press": "away"}
        )
        assert calibrate(paddle, person, date=TODAY, only="force").force_full == pytest.approx(6.0, rel=0.01)
        with pytest.raises(PaddleError, match="presses in the other direction"):
            calibrate(paddle, bench.Scripted(paddle, HOMING | YES | on_a_scale(direction=-1)), date=TODAY, only="force")

    def test_after_it_the_motor_gives_what_is_asked(self):
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=5.3, motor_law=MOTOR_LAWS["LINEAR"])
        calibrate(paddle, bench.Scripted(paddle, HOMING | YES | on_a_scale()), date=TODAY, only="force")
        person = bench.Scripted(paddle, HOMING | on_a_scale(resolution=1e-3))
        stored_settings.lead_home(paddle, person)
        from_scale = bench.force_shown(paddle, person, 1.0, scale(resolution=1e-3))
        assert from_scale == pytest.approx(1.0, rel=0.01)

    def test_an_unchecked_board_is_measured_below_half_a_newton(self):
        paddle = bench.paddle(store=KNOWN.to_bytes(), force_full=6.0)
        person = bench.Scripted(paddle, HOMING | YES | on_a_scale())
        assert calibrate(paddle, person, date=TODAY, only="force").force_full == pytest.approx(6.0, rel=0.03)
        assert "stay below 0.5 N" in person.words

    @pytest.mark.parametrize(
        ("readings", "words"),
        [
            (["0", "20", "40", "60", "30", "90", "20"], "no motor law fits.*tap the table"),
            (["200", "190", "170", "150", "100", "50", "0"], "presses in the other direction"),
            (["3"] * 7, "no supply"),
            (["0", "800", "2400", "4800", "8000", "12000", "16000"], "Did you enter grams"),
        ],
    )
    def test_nonsense_is_refused(self, readings, words):
        paddle = bench.paddle(store=CHECKED.to_bytes())
        typed = on_a_scale() | {"what does the scale show": lambda person: readings.pop(0)}
        with pytest.raises(PaddleError, match=words):
            calibrate(paddle, bench.Scripted(paddle, HOMING | YES | typed), date=TODAY, only="force")
        assert kept_on_board(paddle) == CHECKED.to_float32()
        assert paddle.state()["state"] == 0

    def test_ctrl_c_while_a_scale_is_read_leaves_the_motor_off(self):
        paddle = bench.paddle(store=CHECKED.to_bytes())
        duties = []

        def leaves(person):
            person.move(holding(0.0, k=5000), 0.2)
            duties.append(paddle.exchange.port.board.duty)
            if len(duties) == 3:
                raise KeyboardInterrupt
            return "0"

        person = bench.Scripted(paddle, HOMING | on_a_scale() | {"what does the scale show": leaves})
        with pytest.raises(KeyboardInterrupt):
            calibrate(paddle, person, date=TODAY, only="force")
        assert duties[-1] != 0
        assert paddle.exchange.port.board.duty == 0

    def test_what_is_no_number_is_asked_again(self):
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=6.0)
        typed, asked = iter(["abc", "1e9", "nan"]), scale()
        once = on_a_scale() | {"what does the scale show": lambda person: next(typed, None) or asked(person)}
        person = bench.Scripted(paddle, HOMING | YES | once)
        assert calibrate(paddle, person, date=TODAY, only="force").force_full == pytest.approx(6.0, rel=0.02)
        assert "'abc' is not a number" in person.words
        assert "1e+09: needs a number from" in person.words

    @pytest.mark.wide
    @pytest.mark.parametrize("coulomb", [0.0, 0.1])
    @pytest.mark.parametrize("side", [1, -1])
    def test_hanging_weights(self, coulomb, side):
        mechanics = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=coulomb)
        paddle = bench.paddle(store=CHECKED.to_bytes(), force_full=6.0, mechanics=mechanics)
        grams = iter([40, 70, 100])
        hung = {
            "How do you want to measure the force": "weight",
            "Hang a weight": lambda person: bench.hang(person, next(grams), side),
            "another weight": ["yes", "yes", "no"],
        }
        person = bench.Scripted(paddle, HOMING | YES | hung)
        found = calibrate(paddle, person, date=TODAY, only="force")
        assert found.force_full == pytest.approx(6.0, rel=0.03)
        assert found.motor_law == MOTOR_LAWS["SQRT"]

    def test_a_weight_too_heavy_is_told(self):
        paddle = bench.paddle(store=CHECKED.to_bytes())
        hung = {"How do you want to measure the force": "weight", "Hang a weight": lambda person: bench.hang(person, 900, 1)}
        with pytest.raises(PaddleError, match="does not lift the weight.*Hang a lighter weight"):
            calibrate(paddle, bench.Scripted(paddle, HOMING | YES | hung), date=TODAY, only="force")
        assert paddle.state()["state"] == 0

    def test_the_fit_is_numpys(self):
        duties, random = np.linspace(0.1, 0.9, 7), np.random.default_rng(2)
        forces = 0.2 + 5.0 * duties**2 + 0.01 * random.standard_normal(7)
        found = fit_force(duties, forces, nominal("hapkit"))
        (slope, _), covariance = np.polyfit(duties**2, forces, 1, cov=True)
        assert found.force_full == pytest.approx(slope, rel=1e-12)
        assert found.error == pytest.approx(math.sqrt(covariance[0, 0]), rel=1e-9)

    def test_a_motor_of_no_law_keeps_its_measured_curve(self):
        """A driver that saturates: the curve is drawn here by hand, and its duties are read from it."""
        duties = np.array([0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0])
        forces = np.interp(duties, [0, 0.12, 0.3, 0.5, 1.0], [0, 0, 2.0, 3.2, 4.0])
        kept = nominal("hapkit", force_continuous=4.0)
        found = fit_force(duties, 0.01 + forces, kept)
        assert (found.law, found.force_full) == ("MEASURED", pytest.approx(4.0, rel=1e-6))
        assert found.duties == pytest.approx((0.12, 0.21, 0.3, 0.475), abs=0.02)  # 0 N, 1 N, 2 N and, a chord above, 3 N
        stored = found.into(kept)
        for duty, force in zip(duties[2:], forces[2:], strict=True):
            assert stored.force_of_duty(duty) == pytest.approx(force, abs=0.15)  # four straight lines instead of seven
        again = fit_force(duties, 0.5 * forces, stored)
        assert (again.law, again.force_full) == ("MEASURED", pytest.approx(2.0, rel=0.03))

    def test_one_weight_tells_no_law(self):
        found = fit_force([0.2], [0.3], nominal("hapkit", motor_law=MOTOR_LAWS["LINEAR"]), intercept=False)
        assert found.force_full == pytest.approx(1.5, rel=1e-12)
        assert "so few points do not show the law" in "\n".join(found.words("LINEAR"))

    @pytest.mark.parametrize("law", MOTOR_LAWS)
    def test_duties_are_the_boards(self, law):
        paddle = bench.paddle(store=nominal("hapkit", wired=1, checked=1, motor_law=MOTOR_LAWS[law]).to_bytes())
        person = bench.Scripted(paddle, HOMING)
        paddle.home(at=0.0)
        for force in (0.1, 0.73, 1.9):
            bench.force_shown(paddle, person, force, lambda person: "0")
            assert paddle.exchange.port.seen_duty == pytest.approx(abs(paddle.settings.duty(force)), abs=1 / 32767)


@pytest.mark.wide
def test_all_of_it_in_one_go():
    paddle = bench.paddle(wiring=-1, force_full=6.5, metres_per_count=-11.9e-6)
    answers = WIRED | STOPS | YES | HOMING | {"Let the handle rest": at(0.0)} | tugged(swaying()) | on_a_scale()
    person = bench.Scripted(paddle, answers)
    found = calibrate(paddle, person, date=TODAY)
    assert (found.checked, found.date) == (1, TODAY)
    assert abs(found.metres_per_count) == pytest.approx(11.9e-6, rel=1e-3)
    assert found.force_full == pytest.approx(6.5, rel=0.02)
    assert "nominal    force_continuous, heating_time, speed_max, m, b: as shipped" in person.words
    assert kept_on_board(paddle) == found
    assert "calibrated 2026-11-21" in str(paddle)


def test_constants_as_shipped_are_told_for_every_kind_of_paddle():
    longhorn = nominal("longhorn", date=TODAY, metres_per_count=700e-6, force_full=2.5).to_float32()
    assert still_nominal(longhorn)[0].startswith("nominal    force_continuous, heating_time, speed_max, m, b: as shipped")
