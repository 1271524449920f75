"""What is felt of a record against what was rendered, and against closed forms of synthetic records."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hapticlab.base.telemetry import Telemetry
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError
from hapticlab.experiments.tasks import damping_task, felt_damping, felt_roughness, felt_stiffness, stiffness_task, texture_task

PADDLE = SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
COUNTED = replace(PADDLE, counts_per_metre=50_000)


def record(x, F, **channels):
    return Telemetry(t=np.arange(len(x)) * 1e-3, x=x, v=0 * x, F=F, T=1e-3, channels=channels)


@pytest.mark.parametrize("value", [120.0, 200.0, 310.0])
def test_stiffness_is_felt_as_rendered(value):
    task = stiffness_task()
    assert task.felt(task.present(task.on(PADDLE), value)) == pytest.approx(value, rel=1e-6)  # the scene is float32
    assert task.felt(task.present(task.on(COUNTED), value)) == pytest.approx(value, rel=1e-3)


@pytest.mark.parametrize("paddle", [PADDLE, COUNTED, replace(PADDLE, noise=1e-5, seed=3)], ids=["exact", "counted", "noisy"])
def test_what_is_compiled_once_presents_the_same(paddle):
    task = replace(texture_task(), duration=0.2)
    on = task.on(paddle)
    show = task.presenter(on)
    for value in (0.1, 0.25):
        one, other = show(value), task.present(on, value)
        np.testing.assert_array_equal(one.F, other.F)
        np.testing.assert_array_equal(one.x, other.x)
        assert one.parameters == other.parameters and one.scene == other.scene


def test_damping_and_texture_are_felt_in_proportion():
    damping, texture = damping_task(), texture_task()
    assert damping.felt(damping.present(damping.on(COUNTED), 6.0)) == pytest.approx(6.0, rel=2e-3)
    rough = [texture.felt(texture.present(texture.on(COUNTED), A)) for A in (0.1, 0.2)]
    assert rough[1] / rough[0] == pytest.approx(2.0, rel=0.02)  # the stroke gives way a little more to the rougher one


def test_felt_damping_of_a_viscous_record():
    t = np.arange(2000) * 1e-3
    x = 0.01 * np.sin(2 * math.pi * 2 * t)
    v = 0.01 * 2 * math.pi * 2 * np.cos(2 * math.pi * 2 * t)
    assert felt_damping(record(x, 5 * v + 40 * x)) == pytest.approx(5.0, rel=5e-3)  # the spring does not count


def test_felt_roughness_is_the_rms_of_what_is_quick():
    t = np.arange(4000) * 1e-3
    F = 0.3 * np.sin(2 * math.pi * 40 * t) + 2.0 + 0.5 * t
    assert felt_roughness(record(0 * t, F)) == pytest.approx(0.3 / math.sqrt(2), rel=5e-3)


def test_the_handle_itself_is_felt_where_an_encoder_hid_it():
    x = np.linspace(0, 0.01, 50)
    assert felt_stiffness(record(np.round(x, 3), 100 * x, x_true=x)) == pytest.approx(100.0)


def test_a_hand_of_ones_own_is_kept():
    mine = replace(PADDLE, hand=Hand(push=1.0))
    assert stiffness_task().on(mine) is mine
    assert stiffness_task().on(PADDLE).hand.k == 500.0


def test_what_was_never_touched_is_not_felt():
    x = np.linspace(-0.02, -0.01, 50)
    with pytest.raises(AnalysisError, match="never touched"):
        felt_stiffness(record(x, 0 * x))
    with pytest.raises(AnalysisError, match="standard > 0"):
        damping_task(standard=-1.0)
