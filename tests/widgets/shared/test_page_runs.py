"""A shared page computes what Python does: the same samples bit for bit, the same ticks, rows, words and refusals."""

import math
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from page_in_node import NODE, array, in_node, text

import hapticlab as hl
from hapticlab.compiler.tick.live_limits import limits_apart
from hapticlab.device.live_parameters import checked
from hapticlab.device.simulated.stepping import Stepping
from hapticlab.errors import ParameterError
from hapticlab.widgets import motion, pace, stage, status_words, traces, view_recorder
from hapticlab.widgets.browser_view import BROWSER
from hapticlab.widgets.frame import COLUMNS, THINNED
from hapticlab.widgets.shared.page_data import page_data

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
HAPKIT = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
PLAIN = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
WALL = hl.wall()(k=300, x_o=0.01)
FAR, STRONG = hl.parameters("c A", units="m N", values=(0.003, 1.0))
#: what runs in a page beside Python: scene, paddle, options
LOOPS = {
    "a wall": (WALL, PLAIN, {}),
    "a wall in float64": (WALL, PLAIN, {"dtype": "float64"}),
    "a damped wall, encoder, friction": (hl.wall()(k=300, B=0.3, x_o=0.01), HAPKIT, {}),
    "a delayed force, a late sensor": (WALL, replace(PLAIN, delay=1.4e-3, sensor_delay=0.6e-3), {}),
    "a motor with a dead band": (WALL, replace(PLAIN, duty_dead=0.05, force_max=5.0, compensated=False), {}),
    "two masses": (hl.library.two_masses(), PLAIN, {}),
    "a ball by its Taylor series": (hl.library.ball_on_the_paddle(), PLAIN, {"method": "taylor"}),
    "a ball on a penalty contact": (hl.library.ball_on_the_paddle(contact_law=hl.contact.penalty(k="500 N/m")), PLAIN, {}),
    "stick and slip": (hl.library.stick_slip(), HAPKIT, {"method": "taylor"}),
    "a scene that fails": (hl.Scene(force=STRONG * sp.sqrt(1 - hl.x(hl.n) / FAR)), PLAIN, {}),
}


def told(scene, paddle, **options):
    """The data of a page, as a page reads them."""
    return page_data(stage.Stage(paddle, scene, clock=lambda: 0.0, **options))


def plan_of(names):
    """What a hand does with a scene, in portions of a frame and longer: it leads, lets go, moves a slider, starts again."""
    rng = np.random.default_rng(7)
    path = np.concatenate(([0.0], np.cumsum(rng.uniform(-1, 1.4, 12)) * 4e-3))
    portions = [np.linspace(a, b, ticks + 1) for a, b, ticks in zip(path, path[1:], [1, 16, 17, 50] * 3, strict=False)]
    changes = [{"set": {names[0]: 1.07}}] if names else []
    return [
        *portions[:5],
        *changes,
        *portions[5:7],
        {"hold": False},
        *portions[7:8],
        {"hold": True},
        *portions[8:],
        "start",
        portions[0],
    ]


def done_in_python(scene, paddle, options, plan):
    stepping, found = Stepping(paddle, scene, **options), []
    for step in plan:
        if isinstance(step, np.ndarray):
            found.append(stepping.advance(step))
        elif step == "start":
            fault = stepping.fault
            stepping.start()
        elif "set" in step:
            stepping._take(step["set"])
        else:
            stepping.hold(step["hold"])
    return found, fault, stepping.place


def as_told(step):
    return {"intent": text(step)} if isinstance(step, np.ndarray) else {"start": True} if step == "start" else step


@pytest.fixture(scope="module")
def ran():
    """Every loop in a page and in Python."""
    cases, expected = [], []
    for scene, paddle, options in LOOPS.values():
        first = list(scene.values)[:1]
        plan = plan_of(first)
        for step in plan:
            if isinstance(step, dict) and "set" in step:
                step["set"] = {name: factor * scene.values[name] for name, factor in step["set"].items()}
        expected.append(done_in_python(scene, paddle, options, plan))
        cases.append(("steps", {"told": told(scene, paddle, **options), "plan": [as_told(step) for step in plan]}))
    return dict(zip(LOOPS, zip(in_node(cases), expected, strict=True), strict=True))


@pytest.mark.parametrize("name", LOOPS)
def test_samples_are_those_of_python_bit_for_bit(ran, name):
    answer, (expected, _, place) = ran[name]
    assert answer["place"] == place
    assert len(answer["found"]) == len(expected)
    for found, known in zip(answer["found"], expected, strict=True):
        assert found.keys() == known.keys()
        for column, values in known.items():
            assert array(found[column]).tobytes() == np.asarray(values, float).tobytes(), column


def test_a_fault_is_told_in_the_words_of_python():
    scene, paddle, options = LOOPS["a scene that fails"]
    plan = [np.linspace(0.0, 0.05, 301)]
    (_, _, _), stepping = done_in_python(scene, paddle, options, [*plan, "start"]), Stepping(paddle, scene)
    stepping.advance(plan[0])
    (answer,) = in_node([("steps", {"told": told(scene, paddle), "plan": [as_told(plan[0])]})])
    assert stepping.fault is None or "was not finite" in stepping.fault
    assert answer["fault"] == stepping.fault


def test_ticks_that_are_due_are_those_of_python():
    rng = np.random.default_rng(3)
    moments = np.cumsum(rng.choice([0.0, 0.004, 1 / 60, 0.03, 0.2, 1.4], 60)).tolist()
    costs = rng.choice([0.0, 1e-5, 3e-3], 60).tolist()
    speeds = [0.1 if k == 20 else 1.5 if k == 40 else 0 for k in range(60)]
    own, expected = pace.Pace(1e-3, 1.0), []
    own.start(moments[0])
    for now, cost, speed in zip(moments, costs, speeds, strict=True):
        if speed:
            own.pass_at(speed)
        due = own.due(now)
        own.spent(due, cost * due)
        expected.append([due, own.behind(now)])
    (answer,) = in_node([("pace", {"T": 1e-3, "speed": 1.0, "moments": moments, "costs": costs, "speeds": speeds})])
    assert answer == expected
    assert any(late for _, late in expected)


@pytest.mark.parametrize("T", [1e-3, 2e-4])
def test_rows_and_energy_are_those_of_python(T):
    """Of a delayed, distorted force and a sensor that differs from the handle: every column there can be."""
    rng = np.random.default_rng(5)
    names = ("t", "x", "F", "x_true", "F_applied", "x_switch", "intent", "z", "E")
    some = [
        ({name: rng.normal(0, 0.01, size) for name in names}, rng.integers(0, 2, size) * 1.0) for size in (1, 7, 16, 40, 3000)
    ]
    some[3][0]["x"][3] = 1e300  # past what a row can hold
    watched = ["z", "E"]
    own = traces.Traces(T, watched)
    expected = [own.add(samples, contact) for samples, contact in some]
    parts = [[{name: text(column) for name, column in samples.items()}, text(contact)] for samples, contact in some]
    columns = [*COLUMNS, "z", "watched E"]
    (answer,) = in_node([("rows", {"T": T, "columns": columns, "watched": watched, "parts": parts})])
    for found, known in zip(answer["found"], expected, strict=True):
        assert array(found).astype("<f4").tobytes() == known.ravel().tobytes()
    for found, known in zip(answer["recent"], own.recent(), strict=True):
        assert array(found).tobytes() == known.tobytes()


def test_values_are_refused_in_the_words_of_python():
    """By a program without its steps, which is what a page has: too stiff alone, too stiff together, out of its range."""
    program = pickle.loads(pickle.dumps(PLAIN.program(hl.library.two_masses())))
    data = told(hl.library.two_masses(), PLAIN)
    values = {each["name"]: each["value"] for each in data["parameters"]}
    ends = {each["name"]: each["limits"][1] for each in data["parameters"] if each["limits"] and each["limits"][1]}
    tried = [{}, {"K": 1e7}, {"m_1": -1.0}, {"m_1": 0.0}, {"k": -2.0}, {"b_c": 1e39}, {"K": 350.0, "m_2": 0.06}]
    for part in (0.4, 0.6, 0.9):  # of the way to two limits at once
        tried.append({name: values[name] * (ends[name] / values[name]) ** part for name in ("K", "k")})
    expected = [_refused(program, given) for given in tried]
    asked = [("words", {"name": "refusal", "given": [data["parameters"], values, given]}) for given in tried]
    assert in_node(asked) == expected
    assert sum(map(bool, expected)) >= 6 and "" in expected and any("fractions" in words for words in expected)


def _refused(program, values):
    try:
        checked(program, values)
    except ParameterError as problem:
        return str(problem)
    return ""


def test_a_parameter_may_have_the_name_of_what_every_object_has():
    data = told(hl.Scene(force=hl.parameters("constructor", units="N/m", values=3.0) * hl.x(hl.n)), PLAIN)
    values = {"constructor": 3.0}
    asked = [
        ("words", {"name": "refusal", "given": [data["parameters"], values, given]}) for given in ({}, {"constructor": -1.0})
    ]
    nothing, refused = in_node(asked)
    assert nothing == "" and refused.startswith("constructor = -1 N/m; a stiffness needs")


def test_the_limits_of_a_taylor_method_keep_its_steps_small():
    """In Python its steps are asked where a value is set; a page has limits instead, and each keeps what those allow."""
    scene = hl.library.ball_on_the_paddle(contact_law=hl.contact.penalty(k=hl.parameters("k_b", units="N/m", values=500)))
    program = PLAIN.program(scene, method="taylor")
    limits = limits_apart(program)
    assert not program.limits and limits
    for name, (low, value, high) in limits.items():
        for end in (low, high):
            if math.isfinite(end) and 1e-3 < abs(end / value) < 1e3:
                assert _refused(program, {name: value + 0.99 * (end - value)}) == ""


def vibrations():
    """x, F of a second: chatter, a hand, a decay, noise, one that is led."""
    t, rng = np.arange(1000) * 1e-3, np.random.default_rng(2)
    buzz = 4e-4 * np.sin(2 * np.pi * 41 * t)
    late = 100 * np.r_[buzz[0], buzz[:-1]]
    yield 0.02 + buzz, late
    yield 0.02 + buzz, 100 * np.r_[buzz[1:], buzz[-1]]
    yield 0.02 * t + buzz, late
    yield buzz * np.exp(-9 * t), late
    yield 0.02 * np.sin(4 * np.pi * t), late
    yield rng.normal(0, 1e-4, 1000), late
    yield np.zeros(1000), late
    yield buzz[:3], late[:3]
    yield 0.01 + 3e-3 * np.sign(np.sin(2 * np.pi * 12.3 * t)) + rng.normal(0, 1e-5, 1000), late


def test_a_vibration_is_told_in_the_words_of_python():
    cases = [*vibrations()]
    asked = [("words", {"name": "chatterWords", "given": [text(x), text(F), 1e-3]}) for x, F in cases]
    expected = [status_words.chatter_words(x, F, 1e-3) for x, F in cases]
    assert in_node(asked) == expected
    assert expected[0] == "Chatter: 0.4 mm at 41 Hz" and expected[2].startswith("The handle") and "" in expected


def test_short_words_are_those_of_python():
    contacts = [np.ones(9), np.array([1.0, 0, 0, 1, 1, 0]), np.zeros(4), np.full(9, np.nan), np.zeros(0)]
    asked = [("words", {"name": "contactWords", "given": [text(each)]}) for each in contacts]
    assert in_node(asked) == [status_words.contact_words(each) for each in contacts]
    behind = [0.0, 0.019, 0.05, 0.234]
    asked = [("words", {"name": "lateWords", "given": [each]}) for each in behind]
    assert in_node(asked) == [status_words.late_words(each) for each in behind]
    numbers = [0.0, 1.0, -3.5, 1e-4, 1.23456789e-5, 123456.0, 1234567.0, 1e22, 0.1 + 0.2, 12.3456789]
    asked = [("words", {"name": "general", "given": [each, digits]}) for each in numbers for digits in (4, 6)]
    assert in_node(asked) == [f"{each:.{digits}g}" for each in numbers for digits in (4, 6)]


def test_places_are_those_of_numpy():
    ends = np.random.default_rng(1).normal(0, 0.02, (40, 2))
    answers = in_node([("words", {"name": "linspace", "given": [a, b, k + 2]}) for k, (a, b) in enumerate(ends)])
    for k, (found, (a, b)) in enumerate(zip(answers, ends, strict=True)):
        assert list(found.values()) == np.linspace(a, b, k + 2).tolist()


def test_noise_is_white_and_normal_and_the_same_for_the_same_seed():
    first, again, other = (array(found) for found in in_node([("noise", {"seed": seed, "count": 20_000}) for seed in (0, 0, 1)]))
    assert first.tobytes() == again.tobytes() and first.tobytes() != other.tobytes()
    for drawn in (first, other):
        assert abs(drawn.mean()) < 4 / math.sqrt(20_000) and abs(drawn.std() - 1) < 4 / math.sqrt(40_000)
        assert abs(np.corrcoef(drawn[1:], drawn[:-1])[0, 1]) < 4 / math.sqrt(20_000)
        assert abs(np.mean(drawn**4) - 3) < 0.25
    assert abs(np.corrcoef(first, other)[0, 1]) < 4 / math.sqrt(20_000)


#: constants of a page -> what they are in Python
CONSTANTS = {
    "pace.js": {"LONGEST_MADE_UP": pace.LONGEST, "WORK": pace.WORK, "TOLD": pace.TOLD},
    "rows.js": {"RECENT": traces.RECENT, "THINNED": THINNED},
    "records.js": {"LONGEST_RECORD": view_recorder.LONGEST},
    "motion.js": {"FASTEST": motion.FASTEST, "FOLLOWS": motion.FOLLOWS},
    "source.js": {"LOOK": stage.LOOK, "NOTE": stage.NOTE, "PAST": stage.PAST, "RESTING": 1 / stage.RESTING},
    "status.js": {
        name: getattr(status_words, name) for name in ("SLOWEST", "SMALLEST", "MEAN", "SUSTAINED", "LATE", "MUCH", "CHANGES")
    },
}


@pytest.mark.parametrize("script", CONSTANTS)
def test_constants_are_those_of_python(script):
    source = (BROWSER / "page" / script).read_text("utf-8")
    found = {name: float(value.replace("_", "")) for name, value in re.findall(r"^const (\w+) = ([-\d._e]+) //", source, re.M)}
    for name, value in CONSTANTS[script].items():
        assert found[name] == value, name
