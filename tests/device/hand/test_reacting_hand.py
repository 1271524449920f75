"""A hand that reacts knows what happened up to its reaction time ago, and no more."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import PaddleError

T = 1e-3
FREE = hl.wall()(k=100, x_o=1.0)


def paddle(plan, m=0.05, b=2.0, k=300.0, b_hand=4.0, **given):
    mind = {name: given.pop(name) for name in ("reaction", "interval", "start") if name in given}
    return hl.SimulatedPaddle(m=m, b=b, T=T, hand=hl.Hand(b=b_hand, k=k, intent=hl.people.Reacting(plan=plan, **mind)), **given)


def test_a_plan_of_time_alone_is_the_same_as_a_path():
    path = hl.people.MinimumJerk(end=0.02, duration=0.3, begin=0.05)
    log = paddle(lambda t, seen, intent: float(path(t)), interval=0.001).run(FREE, duration=0.5)
    known = hl.SimulatedPaddle(m=0.05, b=2.0, T=T, hand=hl.Hand(b=4.0, k=300.0, intent=path)).run(FREE, duration=0.5)
    assert np.allclose(log.x, known.x, atol=1e-15, rtol=0)
    assert log.x.max() > 0.019


def test_what_is_seen_ends_a_reaction_time_ago():
    asked = []

    def plan(t, seen, intent):
        asked.append((t, len(seen), seen.t[-1] if len(seen) else None))
        return 0.001

    log = paddle(plan, reaction=0.18, interval=0.02, counts_per_metre=1e4).run(FREE, duration=0.3)
    # asked at 0, 20, ... ms for 20 ms later; the sample of 0 ms is known at 180 ms
    assert [n for _, n, _ in asked] == [0] * 9 + [1, 21, 41, 61, 81, 101]
    assert asked[-1][0] == pytest.approx(0.3) and asked[-1][2] == pytest.approx(0.1)
    assert len(log) == 300


def test_what_is_seen_is_the_handle_and_what_the_scene_watches():
    scene = hl.Scene(force=0 * hl.x(hl.n) * hl.parameters("k", units="N/m", values=1), watch=[hl.x(hl.n - 1)])
    known = {}

    def plan(t, seen, intent):
        known.update({name: values.copy() for name, values in seen.columns.items()})
        return 0.01

    log = paddle(plan, reaction=0.0, counts_per_metre=500.0, start=0.0).run(scene, duration=0.1)
    rows = len(known["t"])
    assert rows == 90 and np.array_equal(known["x"], log.x_true[:rows]) and not np.array_equal(known["x"], log.x[:rows])


@pytest.mark.parametrize("part", [0.97, 1.03])
def test_feedback_through_a_reaction_time_is_stable_up_to_the_limit_of_a_delayed_integrator(part):
    # a hand so stiff that the handle is where it means to be: i[k+1] = i[k] + a (target - i[k-d]), stable for
    # 0 < a < 2 sin(pi/(2 (2 d + 1))) (Levin and May 1976)
    every, reaction = 0.02, 0.18
    d = round(reaction / every)
    a = part * 2 * math.sin(math.pi / (2 * (2 * d + 1)))
    reach = paddle(
        lambda t, seen, intent: intent + a * (0.01 - (seen.x[-1] if len(seen) else 0.0)),
        m=1e-4, b=0.0, k=1e5, b_hand=6.0, reaction=reaction, interval=every,
    )  # fmt: skip
    log = reach.run(FREE, duration=30.0)
    error = abs(log.x - 0.01)
    early, late = error[5000:10000].max(), error[25000:].max()
    assert (late < 0.5 * early) if part < 1 else (late > 1.5 * early)


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        (lambda t, seen, intent: math.nan, "plan gave nan at t = 0.01 s; needs one position"),
        (lambda t, seen, intent: None, "plan gave None"),
        (lambda t, seen, intent: seen.z[-1], "'z' is not available; there are t, x, v, F. Watch it:"),
    ],
)
def test_bad_plans_are_told(plan, said):
    with pytest.raises((PaddleError, AttributeError), match=said):
        paddle(plan).run(FREE, duration=0.05)


def test_a_hand_that_reacts_runs_nowhere_else():
    with pytest.raises(PaddleError, match="plan = 3; needs a function"):
        hl.people.Reacting(plan=3)
    with pytest.raises(PaddleError, match="runs on SimulatedPaddle.run only."):
        hl.sweep(hl.wall(), paddle(lambda t, seen, intent: 0.0), k=[10.0, 20.0], progress=False)


def test_tremor_beside_a_plan_is_added_to_what_it_intends():
    tremor, plan = hl.people.Tremor(rms=1e-3), (lambda t, seen, intent: 0.01 * t)
    mind = hl.people.Reacting(plan=plan)
    both = (mind + tremor, tremor + mind, (lambda t: 0 * t) + (mind + tremor))
    runs = [
        hl.SimulatedPaddle(m=0.05, b=2.0, T=T, hand=hl.Hand(b=4.0, k=300.0, intent=intent)).run(FREE, duration=0.3)
        for intent in (*both, lambda t: 0.01 * t + tremor(t))
    ]
    assert all(np.allclose(log.x, runs[-1].x, atol=1e-15, rtol=0) for log in runs[:-1]) and np.ptp(runs[-1].x) > 1e-3
    with pytest.raises(PaddleError, match=r"two plans; give one Reacting\(plan=...\) that does the work"):
        hl.people.Reacting(plan=plan) + hl.people.Reacting(plan=plan)
    with pytest.raises(TypeError):
        tremor + 3
