"""A shared page says what Python does: the same ticks that are due, rows, energy, words and refusals for the same numbers."""

import math
import pickle
import re

import numpy as np
import pytest
from page_in_node import NODE, array, evaluated, in_node, text

import hapticlab as hl
from hapticlab.analysis.records import chatter, chatter_signs
from hapticlab.base.telemetry import Telemetry
from hapticlab.compiler.ir.notes import ParameterNote
from hapticlab.compiler.tick.live_limits import limits_apart
from hapticlab.device.live_parameters import checked
from hapticlab.errors import ParameterError
from hapticlab.widgets import motion, pace, stage, status_words, traces, view_recorder
from hapticlab.widgets.browser_view import BROWSER
from hapticlab.widgets.frame import COLUMNS, THINNED
from hapticlab.widgets.shared.page_data import parameters_told

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
PLAIN = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))


# --- each returns what is asked of a page, and what Python says


def pace_case():
    """A clock that stops and leaps, ticks that take their time, and two changes of speed."""
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
    assert any(late for _, late in expected)
    return [("pace", {"T": 1e-3, "speed": 1.0, "moments": moments, "costs": costs, "speeds": speeds})], [expected]


def rows_case():
    """Of a delayed, distorted force and a sensor that differs from the handle: every column there can be."""
    asked, expected = [], []
    for T in (1e-3, 2e-4):
        rng = np.random.default_rng(5)
        names = ("t", "x", "F", "x_true", "F_applied", "x_switch", "intent", "z", "E")
        some = [
            ({name: rng.normal(0, 0.01, size) for name in names}, rng.integers(0, 2, size) * 1.0) for size in (1, 7, 16, 3000)
        ]
        some[2][0]["x"][3] = 1e300  # past what a row can hold
        own = traces.Traces(T, ["z", "E"])
        rows = [text(own.add(samples, contact)) for samples, contact in some]
        expected.append({"found": rows, "recent": [text(part) for part in own.recent()]})
        parts = [[{name: text(column) for name, column in samples.items()}, text(contact)] for samples, contact in some]
        columns = {"columns": [*COLUMNS, "z", "watched E"], "watched": ["z", "E"]}
        asked.append(("rows", {"T": T, "parts": parts, **columns}))
    return asked, expected


def refusals_case():
    """By a program without its steps, which is what a page has: too stiff alone, too stiff together, out of its range."""
    program = pickle.loads(pickle.dumps(PLAIN.program(hl.library.two_masses())))
    told = parameters_told(program)
    values = {each["name"]: each["value"] for each in told}
    ends = {each["name"]: each["limits"][1] for each in told if each["limits"] and each["limits"][1]}
    tried = [{}, {"K": 1e7}, {"m_1": -1.0}, {"m_1": 0.0}, {"k": -2.0}, {"b_c": 1e39}, {"K": 350.0, "m_2": 0.06}]
    for part in (0.4, 0.6, 0.9):  # of the way to two limits at once
        tried.append({name: values[name] * (ends[name] / values[name]) ** part for name in ("K", "k")})
    expected = [refused(program, given) for given in tried]
    assert sum(map(bool, expected)) >= 6 and "" in expected and any("fractions" in words for words in expected)
    asked = [("words", {"name": "refusal", "given": [told, values, given]}) for given in tried]
    felt = hl.contact.penalty(k=hl.parameters("k_c", units="N/m", values=500.0))
    program = PLAIN.program(hl.library.ball_on_the_paddle(contact_law=felt))
    told, given = parameters_told(program), {"k_c": 1e7}
    assert ParameterNote in map(type, program.notes) and "lasts 10 steps" in refused(program, given)
    asked.append(("words", {"name": "refusal", "given": [told, {each["name"]: each["value"] for each in told}, given]}))
    return asked, [*expected, refused(program, given)]


def names_case():
    """A parameter may have the name of what every object of JavaScript has."""
    scene = hl.Scene(force=hl.parameters("constructor", units="N/m", values=3.0) * hl.x(hl.n))
    program = PLAIN.program(scene)
    tried = [{}, {"constructor": -1.0}, {"constructor": 5.0}]
    given = [[parameters_told(program), {"constructor": 3.0}, one] for one in tried]
    return [("words", {"name": "refusal", "given": one}) for one in given], [refused(program, one) for one in tried]


def vibrations_case():
    """Chatter, a passive vibration, one that is led, a decay, a hand, noise, rest, too short, a square wave, and any others."""
    t, rng = np.arange(1000) * 1e-3, np.random.default_rng(2)
    buzz = 4e-4 * np.sin(2 * np.pi * 41 * t)
    late, early = 100 * np.r_[buzz[0], buzz[:-1]], 100 * np.r_[buzz[1:], buzz[-1]]
    square = 0.01 + 3e-3 * np.sign(np.sin(2 * np.pi * 12.3 * t)) + rng.normal(0, 1e-5, 1000)
    cases = [
        (0.02 + buzz, late), (0.02 + buzz, early), (0.02 * t + buzz, late), (buzz * np.exp(-9 * t), late),
        (0.02 * np.sin(4 * np.pi * t), late), (rng.normal(0, 1e-4, 1000), late), (0 * t, late), (buzz[:3], late[:3]),
        (square, late),
    ]  # fmt: skip
    cases = [(x, F, 1e-3) for x, F in cases] + [any_vibration(rng, T) for T in [1e-3, 5e-3, 2e-2] * 15]
    slow = 4e-4 * np.sin(2 * np.pi * 16 * 0.02 * np.arange(40))
    cases += [(slow[1 : size + 1], 100 * slow[:size], 2e-2) for size in range(30, 39)]  # about the shortest
    expected = [status_words.chatter_words(*case) for case in cases]
    assert expected[0] == "Chatter: 0.4 mm at 41 Hz" and expected[2].startswith("The handle")
    assert 15 < sum(map(bool, expected)) < len(expected) - 15
    return [("words", {"name": "chatterWords", "given": [text(x), text(F), T]}) for x, F, T in cases], expected


def any_vibration(rng, T):
    """A vibration that grows, decays or stays, with a drift, a hand's motion, noise and an encoder, at a spring a sample late."""
    t = np.arange(round(1 / T)) * T
    x = (
        10 ** rng.uniform(-5, -2.3)
        * np.sin(2 * np.pi * rng.uniform(4, min(0.4 / T, 150)) * t)
        * np.exp(rng.choice([0, 0, -3]) * t)
    )
    x += rng.choice([0, 0.05]) * t + rng.choice([0, 1e-5]) * rng.normal(size=len(t)) + rng.choice([0, 0.01]) * np.sin(9 * t)
    x = np.round(x / 12.8e-6) * 12.8e-6 if rng.random() < 0.5 else x
    return x, np.maximum(300 * np.r_[x[0], x[:-1]], 0), T


def short_words_case():
    contacts = [np.ones(9), np.array([1.0, 0, 0, 1, 1, 0]), np.zeros(4), np.full(9, np.nan), np.zeros(0)]
    behind = [0.0, 0.019, 0.05, 0.234]
    numbers = [0.0, 1.0, -3.5, 1e-4, 1.23456789e-5, 123456.0, 1234567.0, 1e22, 0.1 + 0.2, 12.3456789]
    asked = [("words", {"name": "contactWords", "given": [text(each)]}) for each in contacts]
    asked += [("words", {"name": "lateWords", "given": [each]}) for each in behind]
    asked += [("words", {"name": "general", "given": [each, digits]}) for each in numbers for digits in (4, 6)]
    expected = [*map(status_words.contact_words, contacts), *map(status_words.late_words, behind)]
    return asked, expected + [f"{each:.{digits}g}" for each in numbers for digits in (4, 6)]


def advice_case():
    """A page gives advice of its own: what Python says is an argument of hl.live."""
    said = status_words.late_words(3600.0).removesuffix("give time_scale=0.1 or a cheaper method")
    assert "by 1000 ms in the last second" in said
    asked = [("words", {"name": "lateWords", "given": [3600.0, slower]}) for slower in (True, False)]
    return asked, [f"{said}press M for slow motion", f"{said}close other pages and programs"]


def places_case():
    ends = np.random.default_rng(1).normal(0, 0.02, (40, 2))
    asked = [("words", {"name": "linspace", "given": [a, b, k + 2]}) for k, (a, b) in enumerate(ends)]
    expected = [np.linspace(a, b, k + 2).tolist() for k, (a, b) in enumerate(ends)]
    return asked, [{str(k): place for k, place in enumerate(places)} for places in expected]


CASES = {
    "ticks that are due": pace_case, "rows and energy": rows_case, "refusals": refusals_case, "names": names_case,
    "vibrations": vibrations_case, "short words": short_words_case, "advice": advice_case, "places": places_case,
}  # fmt: skip


def refused(program, values):
    """Why Python refuses values, or nothing."""
    try:
        checked(program, values)
    except ParameterError as problem:
        return str(problem)
    return ""


@pytest.fixture(scope="module")
def said():
    """What a page and Python say in every case, from one process of node."""
    cases = {name: make() for name, make in CASES.items()}
    answers = iter(in_node([one for asked, _ in cases.values() for one in asked]))
    return {name: ([next(answers) for _ in asked], expected) for name, (asked, expected) in cases.items()}


@pytest.mark.parametrize("name", CASES)
def test_a_page_says_what_python_says(said, name):
    found, expected = said[name]
    assert found == expected


def test_the_limits_of_a_taylor_method_keep_its_steps_small():
    """In Python its steps are asked where a value is set; a page has limits instead, and each keeps what those allow."""
    scene = hl.library.ball_on_the_paddle(contact_law=hl.contact.penalty(k=hl.parameters("k_b", units="N/m", values=500)))
    program = PLAIN.program(scene, method="taylor")
    limits = limits_apart(program)
    assert not program.limits and limits
    for name, (low, value, high) in limits.items():
        for end in (low, high):
            if math.isfinite(end) and 1e-3 < abs(end / value) < 1e3:
                assert refused(program, {name: value + 0.99 * (end - value)}) == ""


def test_noise_is_white_and_normal_and_the_same_for_the_same_seed():
    first, again, other = (array(found) for found in in_node([("noise", {"seed": seed, "count": 20_000}) for seed in (0, 0, 1)]))
    assert first.tobytes() == again.tobytes() and first.tobytes() != other.tobytes()
    for drawn in (first, other):
        assert abs(drawn.mean()) < 4 / math.sqrt(20_000) and abs(drawn.std() - 1) < 4 / math.sqrt(40_000)
        assert abs(np.corrcoef(drawn[1:], drawn[:-1])[0, 1]) < 4 / math.sqrt(20_000)
        assert abs(np.mean(drawn**4) - 3) < 0.25
    assert abs(np.corrcoef(first, other)[0, 1]) < 4 / math.sqrt(20_000)


def test_parameters_in_a_replay_change_at_the_samples_of_python():
    """Also those changed before the first sample and after the last, and at periods that are no exact numbers."""
    rng, expected, logs = np.random.default_rng(1), [], []
    for T in (1e-4, 3.7e-4, 0.02):
        t, begin = np.arange(500) * T, 137 * T  # as a page and Python count it from the start of a recording
        at = np.sort(rng.integers(-5, 505, 40))
        changes = [((137 + k) * T - begin, {"k": 1.0 * k, **({"B": 2.0 * k} if k % 2 else {})}) for k in at.tolist()]
        log = Telemetry(t=t, x=t, v=t, F=t, T=T, parameters={"k": 1.0, "B": 0.5}, changes=changes)
        expected.append(view_recorder.Replay(log, 1.0, 0.0).take(math.inf))
        logs.append({"columns": {"t": t.tolist()}, "parameters": log.parameters, "changes": changes, "T": T})
    taken = "logs.map((log) => new Replay({ ...log, columns: { t: Float64Array.from(log.columns.t) } }, 1, 0).take(Infinity))"
    columns = f"{taken}.map((one) => ['k', 'B'].map((name) => [...one[name]]))"
    for found, known in zip(evaluated(["rows.js", "records.js"], columns, logs=logs), expected, strict=True):
        assert found == [known["k"].tolist(), known["B"].tolist()]


#: constants of a page -> what they are in Python
CONSTANTS = {
    "pace.js": {"LONGEST_MADE_UP": pace.LONGEST, "WORK": pace.WORK, "TOLD": pace.TOLD},
    "rows.js": {"RECENT": traces.RECENT, "THINNED": THINNED},
    "records.js": {"LONGEST_RECORD": view_recorder.LONGEST},
    "motion.js": {"FASTEST": motion.FASTEST, "FOLLOWS": motion.FOLLOWS},
    "source.js": {"LOOK": stage.LOOK, "NOTE": stage.NOTE, "PAST": stage.PAST, "RESTING": 1 / stage.RESTING},
    "status.js": {
        **{name: getattr(status_words, name) for name in ("SLOWEST", "SMALLEST", "MEAN", "SUSTAINED", "LATE", "MUCH", "CHANGES")},
        **{"SWINGS_LED": status_words.LED, "SHORTEST": chatter.SHORTEST, "REVERSALS": chatter.REVERSALS},
        **{name: getattr(chatter_signs, name) for name in ("LAGS", "CORRELATED")},
    },
}


@pytest.mark.parametrize("script", CONSTANTS)
def test_constants_are_those_of_python(script):
    source = (BROWSER / "page" / script).read_text("utf-8")
    found = {name: float(value.replace("_", "")) for name, value in re.findall(r"^const (\w+) = ([-\d._e]+) //", source, re.M)}
    for name, value in CONSTANTS[script].items():
        assert found[name] == value, name
