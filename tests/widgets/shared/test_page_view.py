"""A shared page's view gives what a notebook's gives: the same rows, flags and words for the same clock, hand and presses."""

import functools

import numpy as np
import pytest
import sympy as sp
from page_in_node import NODE, array, evaluated, in_node

import hapticlab as hl
from hapticlab.widgets import view_recorder
from hapticlab.widgets.shared.page_data import page_data
from hapticlab.widgets.stage import Stage

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=4.0, hand=hl.Hand("pinch"))
FAR, STRONG = hl.parameters("c A", units="m N", values=(0.003, 1.0))
#: frame of the screen -> what is said before it, at a wall
AT_A_WALL = {
    0: [("show", True)],
    5: [("press", "save")],  # nothing is recorded
    10: [("tell", "intend", 0.02)],
    14: [("press", "record"), ("press", "restart")],  # nothing was recorded yet: the recording waits for the run
    20: [("tell", "hold", 0)],
    26: [("press", "restart")],  # the hand holds the handle again
    28: [("tell", "intend", 0.02)],
    40: [("press", "record"), ("tell", "move", 1, 600.0)],  # k
    60: [("tell", "intend", 0.03)],
    90: [("tell", "move", 1, -5.0)],  # refused
    100: [("tell", "hold", 0)],
    130: [("tell", "hold", 1), ("tell", "intend", 0.015)],
    150: [("press", "slow")],
    170: [("press", "stop"), ("press", "slow")],
    180: [("press", "pause")],
    200: [("press", "save"), ("press", "replay")],
    206: [("show", False)],
    222: [("show", True)],
    230: [("press", "slow")],
    240: [("press", "replay"), ("press", "resume"), ("press", "slow")],
    260: [("show", False)],
    290: [("show", True)],
    310: [("press", "restart")],
    320: [("press", "replay")],
}
#: where the force is not a number beyond 3 mm; the pointer stays there, and the next run begins where the handle does
AT_A_FAULT = {
    0: [("show", True)],
    10: [("press", "record"), ("tell", "intend", 0.01)],
    100: [("press", "resume")],
    150: [("press", "save"), ("press", "replay")],
}
#: an unstable wall throws the handle out of the picture, and a second time
AT_A_LOSS = {
    0: [("show", True)],
    10: [("tell", "intend", 0.02)],
    200: [("press", "resume")],
}
STIFF = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, hand=hl.Hand("pinch", b=0.0))
SCRIPTS = {
    "a wall": (PADDLE, hl.wall()(k=300, x_o=0.01), AT_A_WALL),
    "a fault": (PADDLE, hl.Scene(force=STRONG * sp.sqrt(1 - hl.x(hl.n) / FAR)), AT_A_FAULT),
    "a loss": (STIFF, hl.Scene(force=hl.parameters("K", units="N/m", values=9e4, ranges=(-1e6, 1e6)) * hl.x(hl.n)), AT_A_LOSS),
}
LATE = 250  # this frame comes so much later [s], and all that follow
DELAY = 0.25
FRAMES = 520


def moments():
    return [k / 60 + DELAY * (k >= LATE) for k in range(FRAMES)]


def in_python(paddle, scene, script):
    """The frames of a Stage, led as a Session leads it, and its record."""
    clock, frames, wanted, seen = [0.0], [], 0.0, False
    stage = Stage(paddle, scene, clock=lambda: clock[0])
    for k, now in enumerate(moments()):
        clock[0], queue = now, []
        for what, *given in script.get(k, ()):
            if what == "show":
                seen = given[0]
                stage.look()
                (stage.wake if seen else stage.rest)()
            elif given == ["save"] and stage.motion.has_record:  # it would write a file
                stage.tell("Saved")
            elif what == "press":
                queue.append(("press", (given[0], now)))
            elif what == "tell" and given[0] == "intend":
                wanted = given[1]
            elif what == "tell" and given[0] == "hold":
                queue.append(("hold", bool(given[1])))
            elif what == "tell":
                queue.append(("move", (stage.spans[given[1]].name, given[2])))
        if not seen:
            continue
        stage.obey(queue)
        wanted, stage.hand_at = (wanted if stage.hand_at is None else stage.hand_at), None
        rows = stage.advance(wanted)
        wanted, stage.hand_at = (wanted if stage.hand_at is None else stage.hand_at), None
        frame = stage.frame(rows, wanted)
        if frame is not None:
            frames.append(frame)
    return frames, stage.motion.log


@functools.cache
def shown(name):
    """What a page and Python show in a script."""
    paddle, scene, script = SCRIPTS[name]
    told = page_data(Stage(paddle, scene, clock=lambda: 0.0))
    moves = [[now, script.get(k, [])] for k, now in enumerate(moments())]
    (answer,) = in_node([("view", {"told": told, "script": moves})])
    return answer, *in_python(paddle, scene, script)


def each(*names):
    """Tests of scripts: the wall always, the others in the wide tier."""
    return pytest.mark.parametrize("name", [pytest.param(one, marks=[pytest.mark.wide] * (one != "a wall")) for one in names])


@each(*SCRIPTS)
def test_frames_are_those_of_a_notebook(name):
    answer, frames, _ = shown(name)
    assert len(answer["seen"]) == len(frames) > 100
    flags, status = {}, ""
    for found, frame in zip(answer["seen"], frames, strict=True):
        flags, status = found.get("flags", flags), found.get("status", status)
        _, time, count = array(found["bytes"])
        assert time == frame.time and count == len(frame.rows)
        np.testing.assert_array_equal(array(found["rows"], "<f4"), frame.rows.ravel())
        assert found["values"] == frame.flags["values"] and found["wanted"] == pytest.approx(frame.flags["wanted"])
        assert {name: frame.flags[name] for name in flags} == flags


@each(*SCRIPTS)
def test_words_are_those_of_a_notebook(name):
    answer, frames, _ = shown(name)
    said = [one["status"] for one in answer["seen"] if "status" in one]
    found = [words for k, words in enumerate(said) if words not in said[k - 1 : k]]  # a view that comes back hears all again
    expected = [frame.status for frame in frames if frame.status]
    assert found == expected


#: words that a script brings about
WORDS = {
    "a wall": ("in contact", "at its limit", "at 0.1 times", "Recording.", "let go", "fell behind", "Replaying", "needs k >= 0",
               "nothing is recorded yet"),
    "a fault": ("Stopped: tick", "was not finite", "Replaying"),
    "a loss": ("The loop is unstable: the handle left the picture",),
}  # fmt: skip


@each(*SCRIPTS)
def test_a_script_brings_about_what_it_is_for(name):
    found = " ".join(one.get("status", "") for one in shown(name)[0]["seen"])
    assert [words for words in WORDS[name] if words not in found] == []


@each("a fault")
def test_a_run_after_a_fault_does_not_end_as_the_one_before(name):
    said = [one["status"] for one in shown(name)[0]["seen"] if "status" in one]
    assert any("Stopped" in words for words in said) and said[-1].startswith("Running")


@each("a wall", "a fault")
def test_a_record_is_that_of_a_notebook(name):
    answer, _, log = shown(name)
    (saved,) = answer["saved"]
    assert saved["T"] == log.T and saved["fault"] == log.fault
    assert saved["parameters"] == log.parameters
    assert [(t, numbers) for t, numbers in saved["changes"]] == [(t, dict(numbers)) for t, numbers in log.changes]
    assert set(saved["columns"]) == set(log.columns)
    for name, column in saved["columns"].items():
        assert array(column).tobytes() == np.asarray(getattr(log, name), float).tobytes(), name


def in_a_page(name, script):
    """What a page alone shows, of what a notebook does not have: each answer of its view, news joined with those before."""
    paddle, scene, _ = SCRIPTS[name]
    moves = [[k / 60, script.get(k, [])] for k in range(max(script) + 1)]
    (answer,) = in_node([("view", {"told": page_data(Stage(paddle, scene, clock=lambda: 0.0)), "script": moves})])
    shown = [{}]
    for one in answer["seen"]:
        shown.append({**shown[-1], **one, "time": array(one["bytes"])[1]})
    return shown[1:]


def test_reset_brings_back_the_values_the_speed_and_the_first_state():
    changed = [("tell", "move", 1, 600.0), ("press", "slow"), ("tell", "hold", 0)]
    *_, before, after = in_a_page("a wall", {0: [("show", True), ("tell", "intend", 0.02)], 5: changed, 30: [("reset",)]})
    flags = {name: before["flags"][name] for name in ("speed", "held")}
    assert before["values"]["k"] == 600.0 and flags == {"speed": 0.1, "held": False}
    flags = {name: after["flags"][name] for name in ("speed", "held", "running")}
    assert after["values"]["k"] == 300.0 and flags == {"speed": 1.0, "held": True, "running": True} and after["wanted"] == 0.0
    assert after["time"] < 0.02 < before["time"]


def test_a_tick_at_a_time_ends_with_a_fault():
    *_, last = in_a_page("a fault", {0: [("show", True), ("tell", "intend", 0.01)], 60: [("step", 1)] * 3})
    *_, before = in_a_page("a fault", {0: [("show", True), ("tell", "intend", 0.01)], 60: []})
    assert "Stopped: tick" in last["status"] and last["time"] == before["time"] and not last["flags"]["running"]


def test_a_long_recording_ends():
    lead = """(() => {
        const stepping = { T: 1e-3, fault: null, advance: ({ length }) => ({ t: new Float64Array(length - 1), F: [] }) }
        const ended = [], stopRecording = () => ended.push(motion.recorder.samples)
        const motion = Object.assign(Object.create(Motion.prototype), { stepping, recorder: new Recorder({}), stopRecording,
            at: 0, speed: 1, clock: () => 0, pace: { spent() {} }, told: { force_max: null } })
        for (let k = 0; k < 16 && !ended.length; k++) motion.lead(50000, 0)
        return ended
    })()"""
    assert evaluated(["pace.js", "rows.js", "records.js", "motion.js"], lead) == [view_recorder.LONGEST]


def test_a_record_without_a_hand_has_no_intent():
    record = """(() => {
        const recorder = new Recorder({})
        recorder.add({ t: Float64Array.of(1, 2), x: Float64Array.of(0, 0), intent: Float64Array.of(NaN, intent ?? NaN) })
        return Object.keys(recorder.log(1, null).columns)
    })()"""
    for intent, names in ((None, ["t", "x"]), (0.01, ["t", "x", "intent"])):
        assert evaluated(["rows.js", "records.js"], record, intent=intent) == names
