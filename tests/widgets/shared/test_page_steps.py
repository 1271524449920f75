"""A shared page takes the same steps as Python: its samples are those of Stepping, bit for bit."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from page_in_node import NODE, array, in_node, text

import hapticlab as hl
from hapticlab.device.simulated.stepping import Stepping
from hapticlab.widgets.shared.page_data import page_data
from hapticlab.widgets.stage import Stage

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
HAPKIT = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
PLAIN = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
WALL, DAMPED = hl.wall()(k=300, x_o=0.01), hl.wall()(k=300, B=0.3, x_o=0.01)
FAR, STRONG = hl.parameters("c A", units="m N", values=(0.003, 1.0))
FAILS = "a scene that fails"
#: what runs in a page beside Python: scene, paddle, options
FEW = {
    "a wall in float64": (WALL, PLAIN, {"dtype": "float64"}),
    "a damped wall, encoder, friction": (DAMPED, HAPKIT, {}),
    "a delayed force, a late sensor": (WALL, replace(PLAIN, delay=1.4e-3, sensor_delay=0.6e-3), {}),
    FAILS: (hl.Scene(force=STRONG * sp.sqrt(1 - hl.x(hl.n) / FAR)), PLAIN, {}),
}
MORE = {
    "a wall": (WALL, PLAIN, {}),
    "a motor with a dead band": (WALL, replace(PLAIN, duty_dead=0.05, force_max=5.0, compensated=False), {}),
    "two masses": (hl.library.two_masses(), PLAIN, {}),
    "a linkage": (hl.library.four_bar(), HAPKIT, {}),
    "a ball by its Taylor series": (hl.library.ball_on_the_paddle(), PLAIN, {"method": "taylor"}),
    "a ball on a penalty contact": (hl.library.ball_on_the_paddle(contact_law=hl.contact.penalty(k="500 N/m")), PLAIN, {}),
    "stick and slip": (hl.library.stick_slip(), HAPKIT, {"method": "taylor"}),
}


def plan_of(scene):
    """What a hand does with a scene, in portions of a frame and longer: it leads, lets go, moves a slider, starts again."""
    rng = np.random.default_rng(7)
    path = np.concatenate(([0.0], np.cumsum(rng.uniform(-1, 1.4, 12)) * 4e-3))
    portions = [np.linspace(a, b, ticks + 1) for a, b, ticks in zip(path, path[1:], [1, 16, 17, 50] * 3, strict=False)]
    name, value = next(iter(scene.values.items()))
    led = [{"intent": portion} for portion in portions]
    free = [{"hold": False}, led[7], {"hold": True}]
    return [*led[:5], {"set": {name: 1.07 * value}}, *led[5:7], *free, *led[8:], {"start": True}, led[0]]


def done_in_python(scene, paddle, options, plan):
    """Return what was sampled, the fault before the handle started again, and where the handle is."""
    stepping, found, fault = Stepping(paddle, scene, **options), [], None
    for step in plan:
        if "intent" in step:
            found.append(stepping.advance(step["intent"]))
        elif "set" in step:
            stepping.set(**step["set"])
        elif "hold" in step:
            stepping.hold(step["hold"])
        else:
            fault = stepping.fault
            stepping.start()
    return found, fault, stepping.place


def compare(loops):
    """Compare loops in one process of node with Python; return the faults that both told."""
    cases, expected = [], []
    for scene, paddle, options in loops.values():
        plan = plan_of(scene)
        expected.append(done_in_python(scene, paddle, options, plan))
        told = page_data(Stage(paddle, scene, clock=lambda: 0.0, **options))
        steps = [{"intent": text(step["intent"])} if "intent" in step else step for step in plan]
        cases.append(("steps", {"told": told, "plan": steps}))
    for name, answer, (parts, fault, place) in zip(loops, in_node(cases), expected, strict=True):
        assert answer["place"] == place and answer["fault"] == fault, name
        assert len(answer["found"]) == len(parts) > 10
        for found, known in zip(answer["found"], parts, strict=True):
            assert found.keys() == known.keys()
            for column, values in known.items():
                assert array(found[column]).tobytes() == np.asarray(values, float).tobytes(), f"{name}: {column}"
    return dict(zip(loops, (fault for _, fault, _ in expected), strict=True))


def test_samples_and_faults_are_those_of_python():
    faults = compare(FEW)
    assert "the force F of scene was not finite" in faults.pop(FAILS) and set(faults.values()) == {None}


@pytest.mark.wide
def test_samples_of_mechanisms_and_contacts_are_those_of_python():
    assert set(compare(MORE).values()) == {None}


def test_a_hand_that_aims_as_in_a_run_feels_the_same():
    """The claim of docs/how_to/sharing.md, without Stepping between: the forces of ``paddle.run``."""
    aiming = replace(HAPKIT, hand=hl.Hand("pinch", intent=hl.people.MinimumJerk(end=0.02, duration=0.3)))
    log = aiming.run(DAMPED, duration=0.4, progress=False)
    told = page_data(Stage(HAPKIT, DAMPED, clock=lambda: 0.0))
    intent = aiming.hand.samples(len(log), aiming.T)
    (answer,) = in_node([("steps", {"told": told, "plan": [{"intent": text(intent)}]})])
    (found,) = answer["found"]
    assert log.F.max() > 0.5
    for name in log.columns:
        assert array(found[name]).tobytes() == np.asarray(getattr(log, name), float).tobytes(), name


def test_a_noisy_sensor_and_hand_have_the_noise_that_the_paddle_says():
    """Another generator's than Python's: with the noise of both, the same size, and none is drawn of a hand that is gone."""
    paddle = replace(PLAIN, noise=2e-5, hand=hl.Hand("pinch", push_noise=0.3), seed=np.int64(4))
    told = page_data(Stage(paddle, WALL, clock=lambda: 0.0))
    rest = {"intent": text(np.zeros(4001))}
    (answer,) = in_node([("steps", {"told": told, "plan": [rest, {"hold": False}, rest]})])
    (held, known), free = (answer["found"][0], Stepping(paddle, WALL).advance(np.zeros(4001))), answer["found"][1]
    for part in (held, free):
        error = array(part["x"]) - array(part["x_true"])
        assert error.std() == pytest.approx(2e-5, rel=4 / np.sqrt(8000)) and abs(error.mean()) < 2e-6
    assert array(held["x_true"]).std() == pytest.approx(known["x_true"].std(), rel=0.4)  # the hand shakes it as much
    assert np.all(np.isnan(array(free["intent"])))
