"""Contacts, friction and damping at their extremes: shorter than a tick, at the same instant, without end, or stiff."""

import math
from itertools import permutations

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.device.live_parameters import checked
from hapticlab.errors import HapticlabError, ProgramError, SceneError

G = 9.81
m, g = hl.parameters("m g", units="kg m/s^2", values=(0.05, G))
k_c, K = hl.parameters("k_c K", units="N/m N/m", values=(1000.0, 100.0))
h = hl.coordinate("h", unit="m", initial="40 mm")
q = hl.coordinate("q", unit="m", initial="10 mm")


def flight(law, **options):
    """Return what falls 40 mm onto the handle, as a scene and its contact."""
    top = hl.contact.Contact(h - x(t), law, name="top")
    return hl.mechanics.lagrange(m * h.diff(t) ** 2 / 2 - m * g * h, contacts=[top]), top


def watched(scene, ticks, handle=0.0, T=1e-3, method="taylor", dtype="float64", **options):
    program = hl.compile(scene, method, T=T, dtype=dtype, **options)
    out = load(program).run(ticks, np.full((ticks, 1), handle)).outputs[:, :, 0]
    return {c.name: out[:, j] for j, c in enumerate(program.outputs)}


def falls(law, **options):
    eom, top = flight(law)
    return watched(
        hl.Scene(force=top.felt if top.is_force else 0 * K * h, eom=[eom], watch={"h": h, "speed": h.diff(t)}),
        **options,
    )


# survive


@pytest.mark.parametrize("e", [0.0, 0.3, 0.8, 0.95])
@pytest.mark.always("0.0", "0.8")
def test_infinitely_many_bounces_end_at_their_instant_and_rest_on_the_handle(e):
    """They end at sqrt(2 h/g) (1 + e)/(1 - e), Zeno's limit; rest from the rest speed on cuts off less than 2 v/g of it."""
    end = math.sqrt(2 * 0.04 / G) * (1 + e) / (1 - e)
    found = falls(hl.contact.impulse(e=e), ticks=int(1000 * end) + 60)
    resting = found["h"] == 0
    assert not found["unlocated"].any() and resting[-50:].all()
    first = int(np.argmax(resting & (np.roll(resting, -1))))
    assert end - 0.02 - 1e-3 <= first * 1e-3 <= end + 2e-3 and found["h"].min() >= -1e-15


def test_an_elastic_ball_bounces_for_ever():
    """A whole number of periods later it is where it was: the closed form 2 sqrt(2 h/g), to rounding."""
    found = falls(hl.contact.impulse(e=1.0), ticks=4000)
    period = 2 * math.sqrt(2 * 0.04 / G)
    tau = (np.arange(4000) * 1e-3 + period / 2) % period - period / 2
    np.testing.assert_allclose(found["h"], 0.04 - G * tau**2 / 2, rtol=0, atol=1e-11)


@pytest.mark.wide
@pytest.mark.parametrize("stiffness", [1e4, 1e6, pytest.param(1e7, marks=pytest.mark.slow)])
def test_a_contact_shorter_than_a_tick_gives_back_the_height(stiffness):
    """It lasts 7, 0.7 and 0.2 ms of 1 ms. Between contacts the energy is m g 40 mm, whenever they were."""
    found = falls(hl.contact.penalty(k=f"{stiffness} N/m"), ticks=1000, method="exact", live=())
    away = found["h"] > 0
    energy = G * found["h"] + found["speed"] ** 2 / 2
    assert away.mean() > 0.9 and not found.get("unlocated", np.zeros(1)).any()
    np.testing.assert_allclose(energy[away], G * 0.04, rtol=1e-9)


@pytest.mark.parametrize(
    "law, many",
    [(hl.contact.impulse(e=0.5), 3), (hl.contact.penalty(k="1000 N/m"), 2)],
    ids=["three, impulse", "two, penalty"],
)
@pytest.mark.always("two, *")
def test_contacts_at_the_same_instant_do_not_depend_on_their_order(law, many):
    """Balls from one height, of masses 1 to 100, meet the handle in one instant, written in several orders."""
    names = ("h1", "h2", "h3")[:many]
    balls = [hl.coordinate(name, unit="m", initial="20 mm") for name in names]
    masses = hl.parameters(" ".join(f"m{i}" for i in range(many)), units=" ".join(["kg"] * many), values=[0.01, 0.1, 1.0][:many])
    tops = [hl.contact.Contact(ball - x(t), law, name=f"top{i}") for i, ball in enumerate(balls)]
    L = sum(a * ball.diff(t) ** 2 / 2 - a * g * ball for a, ball in zip(masses, balls, strict=True))
    runs = []
    for order in list(permutations(range(many)))[:: 4 - 3 * (many == 2)]:
        eom = hl.mechanics.lagrange(L, contacts=[tops[i] for i in order])
        found = watched(
            hl.Scene(force=0 * K * balls[0], eom=[eom], watch=balls), ticks=150, method=hl.methods.Taylor(events=many)
        )
        assert not found["unlocated"].any()
        runs.append(np.array([found[name] for name in names]))
    np.testing.assert_allclose(runs[1:], [runs[0]] * (len(runs) - 1), rtol=0, atol=1e-13)
    if isinstance(law, hl.contact.impulse):  # and what bounces without force has no mass
        np.testing.assert_allclose(runs[0][1:], [runs[0][0]] * (many - 1), rtol=0, atol=1e-13)


def test_a_block_under_dry_friction_stops_and_stays():
    """Coulomb: from 1 m/s it stops after v/(mu g), and then the rate is 0 exactly, not a chatter about it."""
    X = hl.coordinate("X", unit="m", rate=1.0)
    rub = hl.contact.friction(slip=X.diff(t), coulomb="0.5 N")
    eom = hl.mechanics.lagrange(m * X.diff(t) ** 2 / 2, contacts=[rub])
    found = watched(hl.Scene(force=0 * K * X, eom=[eom], watch={"X": X, "speed": X.diff(t)}), ticks=300)
    times, stops = np.arange(300) * 1e-3, 1.0 * 0.05 / 0.5
    np.testing.assert_allclose(found["X"], np.where(times < stops, times - 5 * times**2, 0.05), rtol=0, atol=1e-14)
    assert not found["speed"][times > stops].any() and not found["unlocated"].any()


@pytest.mark.parametrize("slip_speed", [1e-3, 1e-6, 1e-12])
@pytest.mark.parametrize("method", ["semi_implicit_euler", "rk4", "verlet", "semi_implicit_euler_damped"])
def test_regularised_friction_steeper_than_a_step_chatters_within_its_force(method, slip_speed):
    """tanh(v / 1 um/s) is a switch to any step: the block keeps within what 1 N can do to it in a few of them."""
    V, F0 = hl.parameters("V F0", units="m/s N", values=(slip_speed, 1.0))
    eom = sp.Eq(m * q.diff(t, 2), K * (x(t) - q) - F0 * sp.tanh(q.diff(t) / V))
    found = watched(hl.Scene(force=K * (x(t) - q), eom=[eom], watch={"speed": q.diff(t)})(m=0.1), 1000, method=method)
    assert np.abs(found["speed"]).max() <= 2 * (1.0 + 1.0) / 0.1 * 1e-3  # both forces, two steps
    assert np.isfinite(found["F"]).all() and np.abs(found["F"]).max() < 2.0


@pytest.mark.parametrize("damping", [1e3, 1e9, 1e30])
@pytest.mark.parametrize("method, options", [("semi_implicit_euler_damped", {}), ("exact", {"live": ()})])
def test_stiff_damping_is_survived_by_what_takes_it_implicitly(method, options, damping):
    """A spring against a damper creeps: q = q0 exp(-K t/c), to the order of K T/c and the mass."""
    c = hl.parameters("c", units="N*s/m", values=damping)
    eom = sp.Eq(m * q.diff(t, 2), -K * q - c * q.diff(t))
    found = watched(hl.Scene(force=K * q, eom=[eom])(m=0.1), 500, method=method, **options)
    np.testing.assert_allclose(found["F"], np.exp(-100.0 / damping * np.arange(500) * 1e-3), rtol=3e-5)


@pytest.mark.parametrize("method", ["rk4", "semi_implicit_euler", "verlet", "heun"])
def test_stiff_damping_under_an_explicit_step_stops_the_motor(method):
    c = hl.parameters("c", units="N*s/m", values=1e3)
    scene = hl.Scene(force=K * (x(t) - q), eom=[sp.Eq(m * q.diff(t, 2), K * (x(t) - q) - c * q.diff(t))])
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, force_max=4.0).run(scene(m=0.1), duration=0.3, method=method)
    first = int(log.fault.split()[1])
    assert "was not finite; the motor is off" in log.fault and not log.F[first:].any() and np.abs(log.F).max() <= 4.0


# refused at build


@pytest.mark.parametrize(
    "stiffness, method, words",
    [
        (1e5, "rk4", r"top: the contact lasts 2.22 ms .*rk4 needs 10. Use substeps=5, method='taylor'"),
        (1e30, "verlet", r"lasts 7.02e-13 ms .* verlet needs 10. Use a shorter T, method='taylor'"),
        (1e30, "taylor", r"needs at most 1. Use a shorter T or, for what is linear, method='exact'"),
        (-1.0, "taylor", r"k = -1; a contact needs a stiffness k >= 0"),
    ],
)
def test_a_contact_shorter_than_its_steps_is_refused_with_what_would_do(stiffness, method, words):
    with pytest.raises(HapticlabError, match=words):
        falls(hl.contact.penalty(k=k_c * stiffness / 1000 if stiffness > 0 else stiffness), ticks=1, method=method)


@pytest.mark.parametrize("e", [1.0 + 1e-9, -1e-9, math.nan, 2])
def test_a_restitution_that_feeds_energy_is_refused(e):
    with pytest.raises(SceneError, match="e = "):
        flight(hl.contact.impulse(e=e))


def test_an_impact_needs_a_method_that_locates():
    with pytest.raises(ProgramError, match="events located inside the step, which is method='taylor'"):
        falls(hl.contact.impulse(e=0.5), ticks=1, method="rk4")


def test_a_live_stiffness_is_not_set_past_what_the_steps_allow():
    eom, top = flight(hl.contact.penalty(k=k_c))
    program = hl.compile(hl.Scene(force=top.felt, eom=[eom]), T=1e-3)
    (channel,) = (c for c in program.parameters if c.name == "k_c")
    assert channel.high == pytest.approx(0.05 * (math.pi / (10 * 1e-3)) ** 2, rel=1e-9)  # half a period in ten steps
    assert checked(program, {"k_c": 0.99 * channel.high}) is not None
    with pytest.raises(HapticlabError, match="k_c = "):
        checked(program, {"k_c": 1.01 * channel.high})
