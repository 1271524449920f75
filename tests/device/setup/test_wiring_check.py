"""The wiring is asked, checked with the motor off, and confirmed: scripted persons at paddles that are wired right and wrong."""

import re

import pytest
import workbench as bench
from workbench import STOP, WIRED

import hapticlab as hl
from hapticlab.device.board.settings import Settings, changed, nominal, pin_word
from hapticlab.device.link.messages import SETTINGS_STRUCT
from hapticlab.device.setup import doctor_checks, stored_settings, wiring_check
from hapticlab.device.setup.built import ask_built
from hapticlab.device.setup.calibrate import calibrate
from hapticlab.device.setup.person import Person
from hapticlab.device.setup.sensor_readings import most_at_rest
from hapticlab.device.wiring import Wiring
from hapticlab.device.wirings import BUILDS, build, built_as
from hapticlab.errors import LinkError, PaddleError

YES = {"Store these settings": "yes"}
HAPKIT = nominal("hapkit", metres_per_count=2 * STOP / 7000, travel_min=-STOP, travel_max=STOP, ident=7, wired=1, checked=1)
LONGHORN = changed(
    wiring_check.rewired(HAPKIT, build("longhorn_d6").wiring), metres_per_count=2 * STOP / 7000, wired=1, checked=1
)
BUILT = {"Which paddle is built": "longhorn_d6"}
STOPPED = {"Look again": "no"}


def kept(paddle):
    return Settings.from_bytes(paddle.exchange.port.board.store[: SETTINGS_STRUCT.size])


def walk(store, answers, sensor=None):
    """Calibrate the wiring of a paddle with a person who gives these answers; return paddle and person."""
    paddle = bench.paddle(store=store.to_bytes(), sensor=store.sensor)
    if sensor is not None:
        paddle.exchange.port.sensor = sensor
    person = bench.Scripted(paddle, answers)
    calibrate(paddle, person, date=20261121, only="wiring")
    return paddle, person


def test_another_wiring_is_stored_unconfirmed_and_then_confirmed(monkeypatch):
    commits, upload = [], stored_settings.upload
    monkeypatch.setattr(stored_settings, "upload", lambda link, to, data: commits.append(data) or upload(link, to, data))
    paddle, person = walk(HAPKIT, YES | WIRED | BUILT)
    commits = [Settings.from_bytes(data) for data in commits]
    assert [(one.wired, one.checked) for one in commits] == [(0, 0), (1, 0)]
    now = kept(paddle)
    assert (Wiring.of(now), now.ident) == (build("longhorn_d6").wiring, 7)
    longhorn = nominal("longhorn")
    assert (now.date, now.metres_per_count, now.force_full) == (
        0, pytest.approx(longhorn.metres_per_count), pytest.approx(longhorn.force_full),
    ), "constants of the other paddle are not this one's"  # fmt: skip
    for words in (
        "board D6       driver EN",
        "board D2       sensor A",
        "supply of the motor OFF",
        "counts increase to the right",
    ):
        assert words in person.words
    assert person.words.index("supply of the motor OFF") < person.words.index("LEFT stop, let it rest")


def test_the_same_wiring_keeps_its_calibration():
    calibrated = changed(HAPKIT, date=20261101)
    paddle, person = walk(calibrated, YES | WIRED | {"By the stored calibration x increases to the right": "yes"})
    assert kept(paddle) == calibrated.to_float32()
    assert "it is checked again" in person.words


@pytest.mark.parametrize("answer", ["Is every wire where", "Look again"])
@pytest.mark.always("Is every*")
def test_what_the_person_does_not_confirm_leaves_the_motor_off(answer):
    """A wiring that was confirmed before counts no more either."""
    broken = (lambda counts: 0) if answer == "Look again" else None
    paddle, person = walk(HAPKIT, YES | WIRED | {answer: "no"}, broken)
    assert (kept(paddle).wired, kept(paddle).checked) == (0, 0)
    assert "so the motor stays off" in person.words
    paddle.home(at=0.0)
    with pytest.raises(LinkError, match="nobody has confirmed the wiring"):
        paddle.run(hl.wall(k=100, x_o=0.01), 0.01)
    for step in ("sign", "force"):
        with pytest.raises(PaddleError, match="nobody has confirmed the wiring of this paddle"):
            calibrate(paddle, person, date=20261121, only=step)


WRONG = {
    "nothing arrives": (LONGHORN, lambda counts: 0, "changed by 0 counts.*Check A on D2 and B on D3, the sensor's VCC and GND"),
    "one line": (LONGHORN, lambda counts: counts // 2 % 2, "only one line of the encoder arrives. Check A on D2 and B on D3"),
    "a floating input": (
        HAPKIT,
        lambda counts: counts * 7919 % 97,
        "at rest the reading wanders by .* OUT on A2 may have no contact",
    ),
    "a loose magnet": (HAPKIT, lambda counts: counts + 60 * (counts // 900 % 2), "jumps by .* OUT on A2 has a loose contact"),
}


@pytest.mark.parametrize("case", WRONG)
@pytest.mark.always("one line", "a floating input")
def test_a_wrong_wire_is_named(case):
    store, sensor, words = WRONG[case]
    own = BUILT if store is LONGHORN else {}
    if case == "a floating input":  # the handle trembles by some counts, of which this sensor makes anything
        own = {"LEFT stop, let it rest": lambda person: person.move(bench.swaying(amplitude=2e-4, period=0.1, k=3e3))}
        own = {"Move the handle to the " + key: answer for key, answer in own.items()}
    paddle, person = walk(store, YES | STOPPED | WIRED | own, sensor)
    assert re.search(f"problem    .*{words}", person.words), person.words
    assert kept(paddle).wired == 0


def test_a_sensor_that_the_board_itself_rejects_is_named():
    paddle = bench.paddle(store=LONGHORN.to_bytes(), sensor=LONGHORN.sensor)
    person = bench.Scripted(paddle, YES | STOPPED | WIRED | BUILT)
    person.answers["slowly to the RIGHT stop, within"] = lambda person: _fails_soon(paddle.exchange.port)
    calibrate(paddle, person, date=20261121, only="wiring")
    assert "the board rejects the reading of A on D2 and B on D3: both lines changed at once" in person.words
    assert kept(paddle).wired == 0


def _fails_soon(port):
    """Let the board find a fault of its sensor 200 ticks from now, as its pins' interrupt would."""
    tick, left = port._tick, iter(range(200))
    port._tick = lambda: (next(left, None) is None and port.board.fail("SENSOR"), tick())


def test_a_sensor_that_was_reversed_since_the_calibration_is_told():
    calibrated = changed(LONGHORN, date=20261101)
    answers = YES | WIRED | BUILT | {"By the stored calibration x increases to the left": "no"}
    paddle, person = walk(calibrated, answers, lambda counts: -counts)
    assert "A and B of the encoder were swapped since the calibration" in person.words
    assert (kept(paddle).date, kept(paddle).checked, kept(paddle).wired) == (0, 0, 1)


def test_firmware_for_another_kind_of_paddle_is_told(monkeypatch):
    def refuses(*_):
        raise LinkError("a value outside what the board allows", "RANGE")

    monkeypatch.setattr(stored_settings, "upload", refuses)
    with pytest.raises(PaddleError, match="drive TWO_INPUTS_ENABLE .* rejects it. Run `hapticlab flash` and choose this paddle"):
        walk(HAPKIT, YES | WIRED | BUILT)


class Typing(Person):
    """A person who types these lines."""

    def __init__(self, *lines):
        self.lines, self.said = list(lines), []

    def say(self, text):
        self.said.append(text)

    def ask(self, question):
        self.said.append(question)
        return self.lines.pop(0)


#: as a person is asked about them
ON_UNO = [name for name, one in BUILDS.items() if one.board == "uno"]


def test_a_known_paddle_is_chosen_by_its_number():
    number = str(ON_UNO.index("longhorn_d11") + 1)
    person = Typing("0", "99", number)
    assert ask_built(person, "uno") is build("longhorn_d11")
    assert f"   {number} longhorn_d11   Longhorn Hapkit with the enable on D11" in person.said[0]
    assert person.said[1] == f"[1 to {len(ON_UNO) + 1}]?" and "'0' is not one of hapkit, hapkit_as5048a" in person.said[2]


def test_something_else_is_asked_pin_by_pin_until_the_board_can_do_it():
    wrong = ("encoder", "D2", "d3", "enable", "D7", "a0", "D10", "7812")
    person = Typing(
        str(len(ON_UNO) + 1),
        "e",
        *wrong[1:3],
        "3",
        *wrong[4:7],
        "3",
        "encoder",
        "13",
        "2",
        "~3",
        "enable",
        "7",
        "A0",
        "D11",
        "31372",
    )
    found = ask_built(person, "uno")
    assert found.wiring == Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (7, 14, 11), (2, 3), 31_372)
    assert "EN on D10: the board has PWM on D3, D5, D6, D11. Move this wire to one of them." in person.said
    assert any(said.startswith("'13' is not a free pin of this board. Free pins are D2, D3") for said in person.said)


def test_a_bare_number_is_no_pin_of_a_pico():
    """On a Pico 4 is also the place of GP2 on the board's edge."""
    person = Typing("other", "encoder", "4", "GP4", "gp5", "inputs", "GP14", "GP15", "20000")
    assert ask_built(person, "pico").wiring.sensor_pins == (4, 5)
    assert any(said.startswith("'4' is not a free pin of this board. Free pins are GP0") for said in person.said)


def test_doctor_compares_what_is_built_with_what_the_board_is_told():
    paddle = bench.paddle(store=HAPKIT.to_bytes())
    assert doctor_checks.wiring(paddle, None).state == "ok"
    assert doctor_checks.wiring(paddle, bench.Scripted(paddle, {"Which paddle is built": "hapkit"})).state == "ok"
    found = doctor_checks.wiring(paddle, bench.Scripted(paddle, BUILT))
    assert found.state == "fault"
    assert "set to hapkit (PWM D5, DIR D8, OUT A2), but longhorn_d6 (IN1 D4, IN2 D5, EN D6, A D2, B D3) is built" in found.found
    assert "switch the supply of the motor off" in found.cure and "calibrate --only wiring" in found.cure
    unconfirmed = bench.paddle(store=changed(HAPKIT, wired=0, checked=0).to_bytes())
    assert doctor_checks.wiring(unconfirmed, None).state == "attention"
    assert doctor_checks.wiring(bench.paddle(), None).state == "skipped"


@pytest.mark.parametrize(
    ("name", "profile"), [("longhorn_d6", "longhorn"), ("l298", "longhorn"), ("motor_shield", "motor_shield")]
)
def test_a_new_paddle_begins_with_the_constants_of_its_kind(name, profile):
    new = wiring_check.begun(None, build(name), 9)
    assert (Wiring.of(new), new.ident, new.wired, new.checked) == (build(name).wiring, 9, 0, 0)
    assert new.metres_per_count == nominal(profile).metres_per_count and new.force_full == nominal(profile).force_full


def test_a_pico_reads_the_same_half_turn_in_more_counts():
    """A KMA210's output flies back by 0.9 * 5 V, of which a divider to 2/3 leaves 3 V of the 3.3 V in 12 bits."""
    built = built_as("pico", Wiring("MAGNETORESISTIVE", "TWO_INPUTS", (14, 15), (26,), 20_000))
    new = wiring_check.begun(None, built)
    assert new.wrap == round(0.9 * 5 * 2 / 3 / 3.3 * 4096)
    assert new.metres_per_count * new.wrap == pytest.approx(920 * 12.8e-6)
    assert "VBUS in place of 3V3" in " ".join(built.remarks())
    assert most_at_rest(new) > most_at_rest(HAPKIT)  # the same noise is more counts


def test_another_driver_keeps_the_constants_of_the_sensor():
    own = Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (4, 5, 11), (2, 3), 31_372)
    assert wiring_check.begun(changed(LONGHORN, date=20261101), build("longhorn_d11")) == changed(
        LONGHORN, date=20261101, **own.settings(), wired=0, checked=0
    )


def test_a_weaker_motor_that_is_taken_to_be_warm_is_waited_for():
    """Half of what 2 N may heat is twice what 1 N may: with 60 s to cool by 1/e, 60 ln 2 = 42 s until it may be driven."""
    paddle = bench.paddle(store=HAPKIT.to_bytes(), sensor=LONGHORN.sensor)
    person = bench.Scripted(paddle, YES | WIRED | BUILT)
    calibrate(paddle, person, date=20261121, only="wiring")
    begun = paddle.exchange.now()
    stored_settings.let_cool(paddle, person)
    assert "the motor is warm" in person.words
    assert paddle.state()["heat"] <= 1 and 25 < paddle.exchange.now() - begun < 43


def test_a_wiring_that_the_board_cannot_do_is_never_sent(monkeypatch):
    paddle = bench.paddle(store=HAPKIT.to_bytes())
    paddle.board["board"] = "uno"
    monkeypatch.setattr(stored_settings, "upload", lambda *_: pytest.fail("sent"))
    impossible = changed(HAPKIT, motor_pins=pin_word(9, 8), wired=0, checked=0)
    with pytest.raises(PaddleError, match="PWM on D9: an Uno has PWM on D3, D5, D6, D11. Move this wire to one of them."):
        stored_settings.store(paddle, impossible)


def test_an_encoder_has_no_wrap_of_the_sensor_before():
    """From a wrap a board knows how much noise is no motion; of an encoder every count is one."""
    longhorn = wiring_check.rewired(nominal("hapkit_as5048a"), build("longhorn_d11").wiring)
    assert longhorn.wrap == nominal("longhorn").wrap == 1024
