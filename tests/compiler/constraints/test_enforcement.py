"""Constrained scenes from their Lagrangian to running programs, against equations reduced by hand and closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from linkages import FourBar, SliderCrank, swing

import hapticlab as hl
from hapticlab import t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import PaddleError, SceneError

TIMES = np.linspace(0, 1, 11)
WAYS = ("auto", "kkt", "numeric", "baumgarte")


def parameters(linkage, units):
    """Return the linkage's numbers as parameters, and its start as two more."""
    names, values = " ".join(units), [getattr(linkage, name) for name in units]
    return hl.parameters(names, units=" ".join(units.values()), values=values)


def slider_crank(**how):
    """Return (scene, its two constraints as functions of the channels)."""
    own = SliderCrank()
    r, L, J, m, M, g = parameters(own, {"r": "m", "L": "m", "J": "kg*m^2", "m": "kg", "M": "kg", "g": "m/s^2"})
    a, w = hl.parameters("a w", units="rad rad/s", values=(0.7, 2.0))
    tilt = sp.asin(r / L * sp.sin(a))
    tilting = r / L * sp.cos(a) / sp.cos(tilt) * w
    theta = hl.coordinate("theta", unit="rad", initial=a, rate=w)
    phi = hl.coordinate("phi", unit="rad", initial=tilt, rate=tilting)
    start, speed = r * sp.cos(a) + L * sp.cos(tilt), -r * sp.sin(a) * w - L * sp.sin(tilt) * tilting
    s = hl.coordinate("s", unit="m", initial=start, rate=speed)
    loop = (r * sp.cos(theta) + L * sp.cos(phi) - s, r * sp.sin(theta) - L * sp.sin(phi))
    X, Y = r * sp.cos(theta) + L / 2 * sp.cos(phi), r * sp.sin(theta) - L / 2 * sp.sin(phi)
    turning = J * theta.diff(t) ** 2 / 2 + m * L**2 / 24 * phi.diff(t) ** 2
    kinetic = turning + m * (X.diff(t) ** 2 + Y.diff(t) ** 2) / 2 + M * s.diff(t) ** 2 / 2
    k = hl.parameters("k", units="N/m", values=0)
    model = hl.mechanics.lagrange(kinetic - m * g * Y, constraints=loop, **how)
    return hl.Scene(force=k * x(t), eom=[model], watch=[theta, phi, s]), own


def four_bar(**how):
    own = FourBar()
    units = {"a": "m", "b": "m", "c": "m", "d": "m", "J": "kg*m^2", "m": "kg", "J_c": "kg*m^2", "g": "m/s^2"}
    a, b, c, d, J, m, J_c, g = parameters(own, units)
    coupler, rocker = own.angles(0.7)
    starts = hl.parameters("a0 b0 c0", units="rad rad rad", values=(0.7, float(coupler), float(rocker)))
    q2, q3, q4 = (hl.coordinate(f"q{k}", unit="rad", initial=p) for k, p in enumerate(starts, 2))
    loop = (
        a * sp.cos(q2) + b * sp.cos(q3) - c * sp.cos(q4) - d,
        a * sp.sin(q2) + b * sp.sin(q3) - c * sp.sin(q4),
    )
    X, Y = a * sp.cos(q2) + b / 2 * sp.cos(q3), a * sp.sin(q2) + b / 2 * sp.sin(q3)
    kinetic = J * q2.diff(t) ** 2 + m * (X.diff(t) ** 2 + Y.diff(t) ** 2) + m * b**2 / 12 * q3.diff(t) ** 2
    k = hl.parameters("k", units="N/m", values=0)
    model = hl.mechanics.lagrange((kinetic + J_c * q4.diff(t) ** 2) / 2 - m * g * Y, constraints=loop, **how)
    return hl.Scene(force=k * x(t), eom=[model], watch=[q2, q3, q4]), own


def run(scene, T=1e-3, seconds=1.0, method="rk4", dtype="float64"):
    """Return the program, and the watched channels at every sample."""
    program = hl.compile(scene, method, T=T, dtype=dtype, live="")
    ticks = round(seconds / T) + 1
    outputs = load(program).run(ticks, np.zeros((ticks, 1)), program.values).outputs[:, 1:, 0]
    return program, outputs


def off_slider_crank(own, channels):
    theta, phi, s = channels.T
    return np.hypot(own.r * np.cos(theta) + own.L * np.cos(phi) - s, own.r * np.sin(theta) - own.L * np.sin(phi)).max()


@pytest.mark.parametrize("enforce", WAYS)
@pytest.mark.always("auto")
def test_slider_crank(enforce):
    scene, own = slider_crank(enforce=enforce, alpha=100.0 if enforce == "baumgarte" else None)
    wanted = swing(own, 0.7, 2.0, TIMES)[0]
    program, channels = run(scene)
    # of fourth order, with 30 steps or more in the fastest of its swings; feedback forces it off a little
    error = np.abs(channels[::100, 0] - wanted).max()
    assert error < (1e-6 if enforce == "baumgarte" else 5e-9)
    drift = off_slider_crank(own, channels)
    assert drift < (2e-9 if enforce == "baumgarte" else 1e-16)
    finer = run(scene, T=5e-4)[1]
    assert np.abs(finer[::200, 0] - wanted).max() < error / 10
    assert any(word in " ".join(program.notes) for word in ("closed form", "multipliers", "Newton"))


@pytest.mark.parametrize("enforce", ["auto", "kkt"])
@pytest.mark.always("kkt")
def test_four_bar(enforce):
    scene, own = four_bar(enforce=enforce)
    program, channels = run(scene)
    np.testing.assert_allclose(channels[::100, 0], swing(own, 0.7, 0.0, TIMES)[0], atol=2e-9)
    np.testing.assert_allclose(channels[:, 1:].T, own.angles(channels[:, 0]), atol=1e-14)
    assert ("driven by q2: no drift" in " ".join(program.notes)) == (enforce == "auto")


def test_closed_form_costs_least():
    scenes = {enforce: slider_crank(enforce=enforce)[0] for enforce in WAYS}
    lengths = {enforce: len(hl.compile(scene, "semi_implicit_euler", T=1e-3, live="")) for enforce, scene in scenes.items()}
    assert lengths["auto"] < min(lengths[other] for other in WAYS[1:])
    assert lengths["auto"] < 150
    # the projection is what multipliers cost beside the feedback
    assert lengths["baumgarte"] < lengths["kkt"]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.always("float32")
def test_a_projection_holds_what_would_drift(dtype):
    drift = {}
    for enforce in ("kkt", "baumgarte"):
        scene, own = slider_crank(enforce=enforce, **({"alpha": 1e-6} if enforce == "baumgarte" else {}))
        _, channels = run(scene, method="semi_implicit_euler", dtype=dtype)
        drift[enforce] = off_slider_crank(own, channels)
    assert drift["baumgarte"] > 1e-3
    # one Newton step leaves the square of a step's drift, and the rounding of the positions
    assert drift["kkt"] < (1e-9 if dtype == "float64" else 1e-7)


def test_chaplygin_sleigh():
    m, I, d = hl.parameters("m I d", units="kg kg*m^2 m", values=(0.7, 0.02, 0.13))
    a0, u0, w0 = hl.parameters("a0 u0 w0", units="rad m/s rad/s")
    X = hl.coordinate("X", unit="m", rate=u0 * sp.cos(a0))
    Y = hl.coordinate("Y", unit="m", rate=u0 * sp.sin(a0))
    angle = hl.coordinate("angle", unit="rad", initial=a0, rate=w0)
    x_c, y_c = X + d * sp.cos(angle), Y + d * sp.sin(angle)
    energy = m * (x_c.diff(t) ** 2 + y_c.diff(t) ** 2) / 2 + I * angle.diff(t) ** 2 / 2
    blade = X.diff(t) * sp.sin(angle) - Y.diff(t) * sp.cos(angle)
    k = hl.parameters("k", units="N/m", values=0)
    forward = X.diff(t) * sp.cos(angle) + Y.diff(t) * sp.sin(angle)
    scene = hl.Scene(
        force=k * x(t), eom=[hl.mechanics.lagrange(energy, constraints=[blade])],
        watch={"angle": angle, "forward": forward, "aside": blade},
    )  # fmt: skip
    # Bloch, Nonholonomic Mechanics and Control, section 1.7: u' = d w^2, w' = -(d/K) u w with K = d^2 + I/m
    K, c, late = 0.13**2 + 0.02 / 0.7, 1.3, -0.4
    phase = 0.13 * c / K * (np.linspace(0, 1, 1001) + late)
    speed, turning = c * np.tanh(phase), c / math.sqrt(K) / np.cosh(phase)
    turned = 0.3 + math.sqrt(K) / 0.13 * 2 * (np.arctan(np.tanh(phase / 2)) - np.arctan(np.tanh(phase[0] / 2)))
    program, channels = run(scene(a0=0.3, u0=float(speed[0]), w0=float(turning[0])))
    np.testing.assert_allclose(channels[:, 0], turned, atol=3e-11)
    np.testing.assert_allclose(channels[:, 1], speed, atol=3e-11)
    assert np.abs(channels[:, 2]).max() < 1e-15
    assert "a constraint on rates has none" in " ".join(program.notes)


def test_rolling_disc_goes_in_a_circle():
    m, r = hl.parameters("m r", units="kg m", values=(0.3, 0.05))
    w, p = hl.parameters("w p", units="rad/s rad/s", values=(4.0, 1.5))
    X, Y = hl.coordinate("X", unit="m", rate=r * w), hl.coordinate("Y", unit="m")
    roll, turn = hl.coordinate("roll", unit="rad", rate=w), hl.coordinate("turn", unit="rad", rate=p)
    energy = m * (X.diff(t) ** 2 + Y.diff(t) ** 2) / 2 + m * r**2 / 4 * roll.diff(t) ** 2 + m * r**2 / 8 * turn.diff(t) ** 2
    rolling = (X.diff(t) - r * roll.diff(t) * sp.cos(turn), Y.diff(t) - r * roll.diff(t) * sp.sin(turn))
    k = hl.parameters("k", units="N/m", values=0)
    scene = hl.Scene(force=k * x(t), eom=[hl.mechanics.lagrange(energy, constraints=rolling)], watch=[X, Y])
    _, channels = run(scene)
    at = np.linspace(0, 1, 1001)
    radius = 0.05 * 4.0 / 1.5
    circle = np.stack([radius * np.sin(1.5 * at), radius * (1 - np.cos(1.5 * at))], axis=1)
    np.testing.assert_allclose(channels, circle, atol=2e-14)


def driven_mass(enforce="auto"):
    q, z = hl.coordinate("q", unit="m"), hl.coordinate("z", unit="m")
    m, M, k = hl.parameters("m M k", units="kg kg N/m", values=(0.02, 0.1, 300))
    image = hl.mechanics.device_image(q - x(t))
    L = m * q.diff(t) ** 2 / 2 + M * z.diff(t) ** 2 / 2 - k * (q - z) ** 2 / 2
    model = hl.mechanics.lagrange(L, constraints=[image.constraint], enforce=enforce)
    return hl.Scene(force=image.force, eom=[model], watch=[z])


@pytest.mark.parametrize("velocity", ["measured", "backward_difference"])
def test_a_device_image_is_felt_as_its_mass_and_its_spring(velocity):
    counts = None if velocity == "measured" else 1e12
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=1.0), counts_per_metre=counts)
    log = paddle.run(driven_mass(), duration=0.3, progress=False, dtype="float64")
    a = np.diff(log.v, prepend=0.0) / 1e-3
    np.testing.assert_allclose(log.F[2:], (0.02 * a + 300 * (log.x - log.z))[2:], atol=1e-11)
    program = hl.compile(driven_mass(), T=1e-3, velocity=velocity)
    assert program.facts["port_mass"] == pytest.approx(0.02, rel=1e-12)


@pytest.mark.parametrize("enforce", ["kkt", "numeric"])
def test_the_image_is_the_same_however_it_is_enforced(enforce):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=1.0))
    logs = [paddle.run(driven_mass(how), duration=0.3, progress=False, dtype="float64") for how in ("auto", enforce)]
    # the position of the image is taken from the sample, or from the prediction for it
    np.testing.assert_allclose(logs[1].z, logs[0].z, atol=2e-5 * np.abs(logs[0].z).max())


@pytest.mark.parametrize(("velocity", "limit"), [("measured", 0.05), ("backward_difference", 0.1)])
def test_more_mass_than_the_handle_holds_is_refused(velocity, limit):
    counts = None if velocity == "measured" else 1e12
    paddle = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3, hand=hl.Hand(push=1.0), counts_per_metre=counts)
    light = paddle.run(driven_mass()(m=0.98 * limit, k=3), duration=0.5, progress=False)
    assert np.abs(light.F).max() < 1.5
    with pytest.raises(PaddleError, match=r"kg felt, and the mass of the handle itself is 0\.05 kg\. .*Put a coupler"):
        paddle.run(driven_mass()(m=1.02 * limit, k=3), duration=0.5, progress=False)


def test_a_mechanism_on_the_handle_is_felt_as_its_heaviest():
    # a scotch yoke: the handle turns a flywheel J through r sin(theta) = x, felt as J/(r cos(theta))^2
    J, r, a = hl.parameters("J r a", units="kg*m^2 m rad", values=(2e-5, 0.05, 0.0))
    theta = hl.coordinate("theta", unit="rad", initial=a)
    image = hl.mechanics.device_image(r * sp.sin(theta) - x(t))
    scene = hl.Scene(force=image.force, eom=[hl.mechanics.lagrange(J * theta.diff(t) ** 2 / 2, constraints=[image.constraint])])
    program = hl.compile(scene, T=1e-3, velocity="measured")
    assert program.facts["port_mass"] == pytest.approx(2e-5 / 0.05**2)
    paddle = hl.SimulatedPaddle(m=0.1, b=0, T=1e-3, hand=hl.Hand(push=0.1))
    log = paddle.run(scene, duration=0.1, progress=False, dtype="float64")
    sin = log.x / 0.05
    a = np.diff(log.v, prepend=0.0) / 1e-3
    # theta'' = (x'' + r sin(theta) theta'^2)/(r cos(theta))
    turning = log.v / (0.05 * np.sqrt(1 - sin**2))
    torque = 2e-5 * (a + 0.05 * sin * turning**2) / (0.05 * np.sqrt(1 - sin**2))
    np.testing.assert_allclose(log.F[2:], (torque / (0.05 * np.sqrt(1 - sin**2)))[2:], rtol=1e-10)


def test_a_loop_that_opens_while_it_runs_turns_the_motor_off():
    r, J = hl.parameters("r J", units="m kg*m^2", values=(0.02, 1e-6))
    theta = hl.coordinate("theta", unit="rad")
    image = hl.mechanics.device_image(r * sp.sin(theta) - x(t))
    scene = hl.Scene(force=image.force, eom=[hl.mechanics.lagrange(J * theta.diff(t) ** 2 / 2, constraints=[image.constraint])])
    log = hl.SimulatedPaddle(m=0.1, b=0, T=1e-3, hand=hl.Hand(push=1.0)).run(scene, duration=0.3, progress=False)
    assert "was not finite; the motor is off" in log.fault
    first = int(np.argmax(np.abs(log.x) > 0.02))
    assert not log.F[first + 2 :].any()


def test_a_reaction_whose_constraint_is_missing():
    q = hl.coordinate("q", unit="m")
    m = hl.parameters("m", units="kg", values=0.1)
    image = hl.mechanics.device_image(q - x(t))
    scene = hl.Scene(force=image.force, eom=[hl.mechanics.lagrange(m * q.diff(t) ** 2 / 2)])
    with pytest.raises(SceneError, match="add this constraint to those of hl.mechanics.lagrange"):
        hl.compile(scene, T=1e-3)


def test_a_slider_without_mass_is_carried_by_its_rod():
    J, r, L, k, a = hl.parameters("J r L k a", units="kg*m^2 m m N/m rad", values=(2e-5, 0.03, 0.1, 30, 0.7))
    theta = hl.coordinate("theta", unit="rad", initial=a)
    phi = hl.coordinate("phi", unit="rad", initial=sp.asin(r / L * sp.sin(a)))
    s = hl.coordinate("s", unit="m", initial=r * sp.cos(a) + sp.sqrt(L**2 - (r * sp.sin(a)) ** 2))
    loop = (r * sp.cos(theta) + L * sp.cos(phi) - s, r * sp.sin(theta) - L * sp.sin(phi))
    channels = {}
    for enforce in ("embed", "kkt"):
        model = hl.mechanics.lagrange(J * theta.diff(t) ** 2 / 2 - k * (s - L) ** 2 / 2, constraints=loop, enforce=enforce)
        channels[enforce] = run(hl.Scene(force=k * (x(t) - s) * 0, eom=[model], watch=[theta, s]))[1]

    class Crank:
        """The crank against the spring alone: J theta'' = -k (s - L) ds/dtheta."""

        def reduced(self, angle):
            out = math.sqrt(0.01 - (0.03 * math.sin(angle)) ** 2)
            slope = -0.03 * math.sin(angle) - 0.03**2 * math.sin(angle) * math.cos(angle) / out
            return 2e-5, 0.0, 30 * (0.03 * math.cos(angle) + out - 0.1) * slope

    wanted = swing(Crank(), 0.7, 0.0, TIMES)[0]
    for found in channels.values():
        np.testing.assert_allclose(found[::100, 0], wanted, atol=1e-7)


def test_a_rank_lost_by_a_live_parameter_turns_the_motor_off():
    q, z = hl.coordinate("q", unit="m"), hl.coordinate("z", unit="m")
    m, c = hl.parameters("m c", units="kg 1", values=(0.02, 0.5), ranges={"c": (0.1, 1)})
    image = hl.mechanics.device_image(q - x(t))
    L = m * (q.diff(t) ** 2 + z.diff(t) ** 2) / 2
    scene = hl.Scene(force=image.force, eom=[hl.mechanics.lagrange(L, constraints=[image.constraint, q - c * z], enforce="kkt")])
    paddle = hl.SimulatedPaddle(m=0.2, b=0, T=1e-3, hand=hl.Hand(push=0.1))
    program = hl.compile(scene, T=1e-3, velocity="measured", live="c")
    assert paddle.run(program, duration=0.05, progress=False).fault is None
    # at c = 0, beyond what it declares, both constraints hold q
    values = [1e-9 if channel.name == "c" else value for channel, value in zip(program.parameters, program.values, strict=True)]
    log = paddle.run(replace(program, values=tuple(values)), duration=0.05, progress=False)
    assert "not finite" in log.fault


@pytest.mark.parametrize("enforce", ["auto", "kkt", "numeric"])
@pytest.mark.always("numeric")
def test_a_support_that_time_moves(enforce):
    A, f, m, k = hl.parameters("A f m k", units="m Hz kg N/m", values=(0.01, 2.0, 0.1, 20.0))
    q, z = hl.coordinate("q", unit="m", rate=A * 2 * sp.pi * f), hl.coordinate("z", unit="m")
    L = m * (q.diff(t) ** 2 + z.diff(t) ** 2) / 2 - k * (q - z) ** 2 / 2
    model = hl.mechanics.lagrange(L, constraints=[q - A * sp.sin(2 * sp.pi * f * t)], enforce=enforce)
    _, channels = run(hl.Scene(force=0 * k * x(t), eom=[model], watch={"q": q, "dq": q.diff(t), "z": z}))
    at, w, own = np.linspace(0, 1, 1001), 4 * math.pi, math.sqrt(200)
    np.testing.assert_allclose(channels[:, 0], 0.01 * np.sin(w * at), atol=1e-16)
    np.testing.assert_allclose(channels[:, 1], 0.01 * w * np.cos(w * at), atol=1e-14)
    forced = 0.01 * own**2 / (own**2 - w**2) * (np.sin(w * at) - w / own * np.sin(own * at))
    np.testing.assert_allclose(channels[:, 2], forced, atol=3e-10)
