"""A real paddle from a page: its host in node, in virtual time, against the firmware's core, with each fault put in."""

import base64
import io
import json
import re
import subprocess
from pathlib import Path

import core_in_node
import numpy as np
import pytest
from host_driver import SETTINGS
from page_bench import STATED, request

import hapticlab as hl
from hapticlab.device.link.messages import RESET_CAUSES, UNCHECKED_FORCE_N
from hapticlab.device.link.serial_ports import BAUDRATE, KNOWN

IN_NODE = Path(__file__).with_name("in_node.mjs")


@pytest.fixture(scope="module")
def found():
    """What became of every scenario."""
    if core_in_node.missing():
        pytest.skip(core_in_node.missing())
    done = subprocess.run(["node", IN_NODE], input=json.dumps(request()), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_wall_is_felt_and_its_sliders_move_it(found, tmp_path):
    felt = found["a wall is felt"]
    t, x, F = np.array(felt["forces"]).T
    assert len(t) > 350 and np.ptp(x) > 0.01 and np.allclose(np.diff(t), 1e-3)
    stiff, soft = (np.maximum(k * (x - 0.01), 0) for k in (300, 150))  # Eq. (23.1)
    since = np.flatnonzero(np.abs(F - stiff) > 1e-5)[0]  # the slider was moved
    assert 350 < since < len(t) - 250 and F.max() > 1
    assert F == pytest.approx(np.where(np.arange(len(t)) < since, stiff, soft), abs=1e-5)
    for k, then in (300, felt["before"]), (150, felt["after"]):
        assert -then["duty"] * SETTINGS["force_full"] == pytest.approx(k * (then["x"] - 0.01), abs=0.05)  # it moves on
    path = tmp_path / "felt.npz"
    path.write_bytes(base64.b64decode(felt["record"]))
    log = hl.records.Telemetry.load(path)
    assert (
        len(log) > 250
        and log.changes
        and not log.gap.any()
        and log.delay == 0
        and log.F == pytest.approx(np.maximum(150 * (log.x - 0.01), 0), abs=2e-3 * 150 * 10)
    )
    assert felt["off"]["off"] <= 0.002 and felt["status"].startswith("Motor off: hold the handle, then press Start.")


def test_the_port_is_asked_for_and_opened_as_python_does(found):
    felt = found["a wall is felt"]
    (asked,) = felt["asked"]
    assert {(usb["usbVendorId"], usb["usbProductId"]) for usb in asked["filters"]} == set(KNOWN)
    assert felt["options"]["baudRate"] == BAUDRATE and felt["signals"] == [{"dataTerminalReady": True, "requestToSend": True}]
    assert felt["gotten"] == 0  # no port is opened that was granted before
    assert ["board", "host BEEF, firmware 2.0"] in felt["facts"] and ["largest force", "4 N"] in felt["facts"]
    assert not set(felt["said"]) & {"HOME", "ARM"}  # never from a page


def test_nothing_starts_but_by_a_fresh_press(found):
    seen = found["nothing starts without a press"]
    assert seen["duty"] == 0 and "START" not in seen["said"] and "BEGIN" not in seen["said"]
    assert seen["unknown"] == seen["refused"] and seen["refused"].startswith("Move the handle slowly to one stop")
    assert seen["homed"] == "Motor off: hold the handle, then press Start."
    assert "Start came late" in seen["late"]


@pytest.mark.parametrize("name", ["stop while it starts", "stop while it starts again"])
def test_stop_holds_at_any_moment_of_a_start(found, name):
    for off, running, last in found[name]["found"]:
        assert (off, running) == (0, False) and last == "STATUS"


def test_a_press_just_after_the_motor_went_off_starts_nothing(found):
    seen = found["pressed just after Stop"]
    assert [starts for starts, _ in seen["refused"]] == [1, 1, 1, 1] and seen["early"] == 1  # the first one's
    assert all("The motor went off just now and stays off" in said or "The motor is off" in said for _, said in seen["refused"])
    assert seen["then"] == 3 and seen["duty"] < 0


def test_a_slider_that_is_moved_in_a_start_shows_what_the_board_has(found):
    felt = found["a slider moved in a start"]
    assert felt["force"] == pytest.approx(felt["k"] * (felt["x"] - 0.01), abs=0.05) and felt["force"] > 0.5
    assert "Move the slider again" in felt["status"]


def test_what_goes_wrong_in_a_start_ends_with_the_motor_off(found):
    lost = found["stop whose STOP is lost"]
    assert lost["lost"] > 1 and lost["off"] < 0.05  # it is said again
    broken = found["error as it begins"]
    assert broken["duty"] == 0 and broken["said"][broken["said"].index("START") :].count("STOP") == 1
    assert "a mistake" in broken["status"]


def test_a_start_that_takes_long_does_not_begin_when_nobody_expects_it(found):
    slow = found["a start that takes long"]
    assert slow["duty"] == 0 and "COMMIT" in slow["said"] and "START" not in slow["said"]
    assert "The start took too long. Press Start again." in slow["status"]


def test_a_damaged_byte_ends_nothing_and_a_sample_that_comes_twice_is_one(found):
    became = found["a damaged byte, then everything twice"]
    assert became["duty"] < 0 and became["status"].startswith("Motor on")
    assert len(became["times"]) > 200 and np.allclose(np.diff(became["times"]), 1e-3)


def test_questions_to_a_board_that_is_silent_do_not_pile_up(found):
    assert found["a board that is silent for a while"]["asked"] <= 3


def test_what_a_board_went_through_is_told(found):
    assert "It met more travel than was calibrated" in found["further than its travel"]["status"]
    reset = found["reset by a supply that fell"]
    assert reset["notices"] == [f"The board was reset by {RESET_CAUSES['BROWN_OUT'][1]}."]
    assert reset["forgotten"]  # no other page of the site opens the port without asking


@pytest.mark.parametrize("name", STATED)
def test_the_motor_is_off_in_the_stated_time(found, name, record_property):
    within, says = STATED[name]
    taken, became = found[name]["off"], found[name]
    record_property("motor_off_after_s", taken)
    print(f"{name}: motor off {1e3 * taken:.0f} ms after it, stated {1e3 * within:.0f} ms")
    assert taken is not None and 0 <= taken <= within + 1e-9
    if says:
        assert says in became["status"] + " ".join(became["lost"])
        assert became["motor"] is False


def test_a_fault_is_told_in_the_packages_words_and_start_begins_again(found):
    became = found["a fault, and Start again"]
    said = (
        "OVER_SPEED: the handle moved faster than the limit; the motor is off from then on. Hold the handle; lower the stiffness"
    )
    assert said in became["status"] and re.search(r"tick \d+ \(t = [\d.]+ s\)", became["status"])
    assert became["soon"] == 1 and became["again"] < 0 and became["said"].startswith("Motor on")
    stood = found["a fault that stood"]
    assert stood["words"] == "" and stood["state"] == 0 and "A fault was pending: tick" in stood["notices"][0]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("another version", "a different version of the messages"), ("another version", "run `hapticlab flash --board pico`."),
        ("noise answers", "No paddle answered within 3 s"), ("port taken", "Another tab or program may use it"),
        ("no port chosen", "No port was chosen"), ("no API", "Use Chrome or Edge"),
        ("nothing answers", "No paddle answered within 3 s"),
        ("an encoder that is too fast", "the encoder gives 2e+05 edges per second"),
        ("a sensor that is too slow", "the sensor takes 0.002 s from its last count back to its first"),
        ("a period that the board does not have", "This scene has T = 0.5 s; the board needs"),
        ("not calibrated", "run `hapticlab calibrate`"), ("not wired", "run `hapticlab calibrate`"),
    ],
)  # fmt: skip
def test_what_keeps_a_paddle_from_starting_is_told(found, name, words):
    became = found[name]
    assert words in became["words"] and not set(became.get("said", ())) & {"START", "BEGIN", "SET", "HOME"}


def test_a_version_that_differs_is_asked_nothing_more(found):
    assert found["another version"]["said"] == ["HELLO"] and found["another version"]["closed"]
    assert 3 <= found["nothing answers"]["seconds"] < 3.2 and found["nothing answers"]["closed"]
    assert found["resets as it opens"]["words"] == ""  # it waits for the bootloader, as Python does


def test_an_unchecked_sign_gives_half_a_newton(found):
    unchecked = found["sign not checked"]
    assert unchecked["duty"] == pytest.approx(UNCHECKED_FORCE_N, abs=1e-3)
    assert ["largest force", "0.5 N, because the sign of the motor was not checked"] in unchecked["facts"]


def test_no_sentence_is_for_a_notebook(found):
    said = json.dumps(found)
    assert not re.search(r"paddle\.\w+\(|notebook was|keep the notebook|hapticlab calibrate --", said)


def test_a_view_gets_frames_as_a_notebook_gives_them(found):
    assert found["a wall is felt"]["frames"] > 40
    assert io.BytesIO(base64.b64decode(found["a wall is felt"]["record"])).read(2) == b"PK"
