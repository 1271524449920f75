"""Lengths that constraints hold are constants of a program: set while it runs, they would throw the mechanism."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.device.live_parameters import checked
from hapticlab.errors import ParameterError, SceneError

X = hl.coordinate("X", unit="m")
K, m, g = hl.parameters("K m g", units="N/m kg m/s^2", values=(50, 0.1, 9.81))


def pendulum(**of_length):
    length = hl.parameters("l", units="m", values=0.2, **of_length)
    Z = hl.coordinate("Z", unit="m", initial=-length)
    L = m * (X.diff(t) ** 2 + Z.diff(t) ** 2) / 2 - m * g * Z - K * (x(t) - X) ** 2 / 2
    model = hl.mechanics.lagrange(L, constraints=[sp.Eq(X**2 + Z**2, length**2)])
    return hl.Scene(force=K * (x(n) - X), eom=[model], watch={"X": X, "Z": Z}, name="pendulum")


def slider_crank(ranges, **enforce):
    r = hl.parameters("r", units="m", values=0.05, ranges=ranges)
    J, rod = hl.parameters("J rod", units="kg*m^2 m", values=(1e-4, 0.12))
    theta, s = hl.coordinate("theta", unit="rad"), hl.coordinate("s", unit="m", initial=r + rod)
    L = J * theta.diff(t) ** 2 / 2 + m * s.diff(t) ** 2 / 2 - K * (x(t) + rod - s) ** 2 / 2
    loop = (s - r * sp.cos(theta)) ** 2 + r**2 * sp.sin(theta) ** 2 - rod**2
    return hl.Scene(force=K * (x(n) - s), eom=[hl.mechanics.lagrange(L, constraints=[loop], **enforce)], watch={"s": s})


def test_a_length_is_a_constant_that_the_scene_binds():
    program = hl.compile(pendulum()(l=0.3), T=1e-3, dtype="float64")
    assert [c.name for c in program.parameters] == ["K", "g", "m"]
    assert "l: in a constraint, so not live" in program.notes
    _, place, height = load(program).run(300, 0.05 * np.ones((300, 1))).outputs[:, :, 0].T
    assert np.ptp(place) > 0.01
    assert np.hypot(place, height) == pytest.approx(0.3, abs=1e-9)  # the projection of every tick
    with pytest.raises(ParameterError, match=r"l is not a live parameter of pendulum \(l: in a constraint, so not live\)."):
        checked(program, {"l": 0.4})
    assert checked(program, {"g": 3.0}) == {"g": 3.0}


def test_asked_for_by_name_it_needs_a_declared_range():
    with pytest.raises(ParameterError, match=r"l is in a constraint,.*would jump.*ranges=\(0\.1, 0\.4\)"):
        hl.compile(pendulum(), T=1e-3, live="K l")
    program = hl.compile(pendulum(ranges=(0.1, 0.4)), T=1e-3, live="l")
    assert [c.name for c in program.parameters] == ["l"]
    assert "l: live, and in a constraint: the mechanism jumps to the new length when the value changes" in program.notes
    assert not any("l:" in note for note in hl.compile(pendulum(), T=1e-3, live="K").notes if "so not live" not in note)


@pytest.mark.parametrize(
    ("enforce", "longest", "why"),
    # a crank longer than its rod makes no full turn; one as long folds with it, at a quarter turn
    [("embed", 0.2, r"cannot close at theta = [-\d.]+"), ("kkt", 0.12, r"lose a rank .* at s = 0, theta = -?")],
)
@pytest.mark.always("embed-*")
def test_over_a_declared_range_the_mechanism_must_close(enforce, longest, why):
    with pytest.raises(SceneError, match=rf"with r = {longest:g} m, which is live and can have any value .*: .*{why}"):
        hl.compile(slider_crank((0.02, longest), enforce=enforce), T=1e-3, live="r")
    assert len(hl.compile(slider_crank((0.02, longest), enforce=enforce), T=1e-3)) > 0  # as a constant of 0.05 m
    assert hl.compile(slider_crank((0.02, 0.1), enforce=enforce), T=1e-3, live="r").parameters[0].name == "r"


def test_a_sweep_of_a_length_takes_a_program_for_each():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=0.5))
    settings = {"duration": 0.1, "metric": "peak_force", "progress": False}
    together = hl.sweep(pendulum(), paddle, l=[0.15, 0.3], K=[20.0, 50.0], **settings).values
    alone = [hl.sweep(pendulum()(l=l), paddle, K=[20.0, 50.0], **settings).values for l in (0.15, 0.3)]
    assert together == pytest.approx(np.array(alone), rel=1e-12)
    assert abs(together[0] - together[1]).min() > 1e-4
