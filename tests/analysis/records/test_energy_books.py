"""Energy books: every contact model closes, the leak is the method's own, and the port's leak stands beside it."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.records.energy_books import CHANNELS, balance, energy_books
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import AnalysisError, SceneError
from hapticlab.scene.mechanics.lagrange import lagrange

T, M, G, H = 1e-3, 0.5, 9.81, 0.1
m, g, h0 = hl.parameters("m g h0", units="kg m/s^2 m", values=(M, G, H))
q = hl.coordinate("q", unit="m", initial=h0)
FALL = m * q.diff(t) ** 2 / 2 - m * g * q
k, b, k_h, c, F_c, e = hl.parameters(
    "k b k_h c F_c e", units="N/m N*s/m N/m^2 s/m N 1", values=(2000, 1, 2e5, 0.3, 0.4, 0.8), ranges={"e": (0, 1)}
)
LAWS = {
    "penalty": hl.contact.penalty(k=k, b=b),
    "hunt_crossley": hl.contact.hunt_crossley(k=k_h, c=c, exponent=2),
    "impulse": hl.contact.impulse(e=e),
    "simultaneous": hl.contact.impulse(e=e, impacts="simultaneous"),
    "rigid": hl.contact.rigid(),
    "micro_impulse": hl.contact.micro_impulse(e=e),
}


def run(scene, ticks, handle=None, **options):
    """Return the channels of a run as a dict; handle is (x, v), measured."""
    program = hl.compile(scene, T=T, dtype="float64", **options)
    inputs = np.zeros((ticks, len(program.inputs)))
    for column, given in enumerate(handle or ()):
        inputs[:, column] = given
    outputs = load(program).run(ticks, inputs).outputs[:, :, 0].T
    return dict(zip([channel.name for channel in program.outputs], outputs, strict=True))


def dropped(law):
    return energy_books(hl.Scene(force=0, eom=[lagrange(FALL, contacts=[hl.contact.Contact(q, law, name="floor")])], watch=[q]))


# the largest leak of a drop of 0.49 J within 1.2 s, measured with room to spare: (model, method, substeps) -> [J]
LEAKS = {
    ("impulse", "taylor", 1): 1e-13,
    ("simultaneous", "taylor", 1): 1e-13,
    ("rigid", "taylor", 1): 1e-13,
    ("penalty", "taylor", 1): 1e-13,
    ("micro_impulse", "taylor", 1): 1e-13,
    ("micro_impulse", "rk4", 1): 1e-13,
    ("penalty", "rk4", 1): 4e-4,
    ("penalty", "rk4", 8): 1e-5,
    ("penalty", "verlet", 1): 2e-3,
    ("penalty", "semi_implicit_euler", 1): 0.03,
    ("hunt_crossley", "rk4", 1): 5e-6,
    ("hunt_crossley", "rk4", 8): 1e-8,
    ("hunt_crossley", "verlet", 1): 1.5e-3,
}


@pytest.mark.parametrize("model, method, substeps", [
    *LEAKS, pytest.param("hunt_crossley", "taylor", 2, marks=pytest.mark.slow),
])  # fmt: skip
@pytest.mark.always(
    "impulse-taylor-1",
    "simultaneous-taylor-1",
    "rigid-taylor-1",
    "micro_impulse-*-1",
    "penalty-rk4-1",
    "penalty-semi_implicit_euler-1",
    "hunt_crossley-rk4-1",
)
def test_the_books_of_every_contact_model_close(model, method, substeps):
    """supplied = stored + dissipated + leak at every sample, and the leak is no more than the method's own."""
    log = run(dropped(LAWS[model]), 1200, method=method, substeps=substeps)
    supplied, stored, dissipated, leak = (log[name] for name in CHANNELS)
    assert supplied == pytest.approx(stored + dissipated + leak, abs=1e-15)
    assert supplied == pytest.approx(M * G * H)
    # stored is the ball's own energy, known independently; while it flies, nothing else holds any
    assert dissipated[-1] > 0.3 * M * G * H and (np.diff(dissipated) > -1e-12).all()
    assert np.abs(leak).max() < LEAKS.get((model, method, substeps), 1e-13)


def test_the_leak_is_what_the_method_makes():
    """Forward Euler feeds a free oscillator (1 + (omega h)^2) of its energy each step; the books show all of it."""
    k_s = hl.parameters("k_s", units="N/m", values=300)
    z = hl.coordinate("z", unit="m", initial=h0)
    scene = energy_books(hl.Scene(force=0, eom=[lagrange(m * z.diff(t) ** 2 / 2 - k_s * z**2 / 2)]))
    log = run(scene, 1000, method="euler")
    made = 0.5 * 300 * H**2 * ((1 + 300 / M * T**2) ** np.arange(1000) - 1)
    assert -log["leak"] == pytest.approx(made, rel=1e-9, abs=1e-15)


def test_friction_turns_work_into_heat():
    """A block drawn by a spring at V: the spring's end puts the work in; stuck, slipping and stuck again."""
    V, K, F_s = hl.parameters("V K F_s", units="m/s N/m N", values=(0.05, 200, 2))
    F_d = hl.parameters("F_d", units="N", values=1)
    z = hl.coordinate("z", unit="m")
    rub = hl.contact.friction(slip=z.diff(t), coulomb=F_d, breakaway=F_s)
    motion = lagrange(m * z.diff(t) ** 2 / 2 - K * (V * t - z) ** 2 / 2, contacts=[rub])
    log = run(energy_books(hl.Scene(force=0, eom=[motion], watch={"z": z})), 900, method="taylor")
    assert np.abs(log["leak"]).max() < 1e-14
    assert log["dissipated"] == pytest.approx(1.0 * log["z"], abs=1e-13)
    assert log["supplied"][-1] > 0.04


@pytest.mark.slow
def test_a_belt_does_the_work_of_its_friction():
    """A block on a belt at V, held by a spring too stiff to ride along: F V t goes in, F (V t - z) is lost."""
    V, K = hl.parameters("V K", units="m/s N/m", values=(0.3, 50))
    z = hl.coordinate("z", unit="m")
    rub = hl.contact.friction(slip=z.diff(t) - V, coulomb=F_c)
    motion = lagrange(m * z.diff(t) ** 2 / 2 - K * z**2 / 2, contacts=[rub])
    log = run(energy_books(hl.Scene(force=0, eom=[motion], watch={"z": z})), 1500, method="taylor")
    assert np.abs(log["leak"]).max() < 1e-13
    put_in = 0.4 * 0.3 * T * np.arange(1500)
    assert log["supplied"] == pytest.approx(put_in, abs=1e-13)
    assert log["dissipated"] == pytest.approx(put_in - 0.4 * log["z"], abs=1e-13)


def coupled(**more):
    """A mass on a virtual coupler, moved by the handle; with its Lagrangian."""
    K, B = hl.parameters("K B", units="N/m N*s/m", values=(400, 1.5))
    z = hl.coordinate("z", unit="m", initial=x(n))
    L = m * z.diff(t) ** 2 / 2 - K * (x(t) - z) ** 2 / 2
    motion = lagrange(L, dissipation=B * (v(t) - z.diff(t)) ** 2 / 2, **more)
    return hl.Scene(hl.laws.virtual_coupler(z, K=K, b=B), [motion], watch=[z]), (K, B, z)


def moved(ticks):
    """A handle of constant acceleration, which the hold "soh" extrapolates exactly once it knows it."""
    s = T * np.arange(ticks)
    return 0.02 * s + 0.15 * s**2, 0.02 + 0.3 * s


def test_the_work_of_the_handle_is_booked():
    """Supplied is the integral of F_e v, by a quadrature that knows nothing of the books."""
    scene, _ = coupled()
    log = run(energy_books(scene), 500, moved(500), method="taylor", velocity="measured")
    _, speed = moved(500)
    power = log["F"] * speed
    # Simpson's rule over pairs of periods; the first sample's acceleration is not known yet, which the leak shows
    simpson = T / 3 * (power[0:-2:2] + 4 * power[1:-1:2] + power[2::2]).sum()
    assert log["supplied"][498] - log["supplied"][0] == pytest.approx(simpson, rel=1e-4)
    assert np.abs(np.diff(log["leak"])[2:]).max() < 1e-15
    assert np.abs(log["leak"]).max() < 1e-6


def test_written_out_equations_have_the_same_books():
    scene, (K, B, z) = coupled()
    F = hl.laws.virtual_coupler(z, K=K, b=B)
    plain = hl.Scene(F, [sp.Eq(m * z.diff(t, 2), F)], watch=[z])
    stored = m * z.diff(t) ** 2 / 2 + K * (x(t) - z) ** 2 / 2
    logs = [
        run(books, 300, moved(300), method="rk4", velocity="measured")
        for books in (energy_books(scene), energy_books(plain, stored=stored, dissipated=B * (v(t) - z.diff(t)) ** 2))
    ]
    for name in CHANNELS:
        assert logs[0][name] == pytest.approx(logs[1][name], rel=1e-9, abs=1e-12)


@pytest.mark.slow
def test_a_moving_floor_does_its_work_through_force_laws():
    """The handle lifts a ball on a stiff floor: what the spring carries is booked as its work."""
    ball = hl.coordinate("ball", unit="m", initial=x(n) - m * g / k)
    L = m * ball.diff(t) ** 2 / 2 - m * g * ball
    floor = hl.contact.Contact(ball - x(t), hl.contact.penalty(k=k, b=b), name="floor")
    scene = hl.Scene(-floor.generalized_force(x(t)), [lagrange(L, contacts=[floor])], watch={"ball": ball})
    log = run(energy_books(scene), 400, moved(400), method="taylor", velocity="measured")
    assert np.abs(np.diff(log["leak"])[2:]).max() < 1e-14
    lifted = M * G * (log["ball"][-1] - log["ball"][0])
    assert log["supplied"][-1] - log["supplied"][0] > lifted > 0.1


OSCILLATING = {
    "penalty": hl.contact.penalty(k=k, b=b), "impulse": hl.contact.impulse(e=e), "rigid": hl.contact.rigid(), "spring": None,
}  # fmt: skip


@pytest.mark.parametrize("law", OSCILLATING)
@pytest.mark.always("spring")
def test_what_oscillates_in_time_puts_work_in(law):
    """A ball on a shaking plate, and one on a spring whose stiffness swings: nothing leaks though t drives both."""
    A, om = hl.parameters("A om", units="m 1/s", values=(0.01, 30))
    z = hl.coordinate("z", unit="m", initial=h0 / 5)
    if law == "spring":
        motion = lagrange(m * z.diff(t) ** 2 / 2 - k * (1 + sp.cos(om * t) / 4) * z**2 / 2)
    else:
        plate = hl.contact.Contact(z - A * sp.sin(om * t), OSCILLATING[law], name="plate")
        motion = lagrange(m * z.diff(t) ** 2 / 2 - m * g * z, contacts=[plate])
    log = run(energy_books(hl.Scene(force=0, eom=[motion])), 400, method="taylor")
    put_in = log["supplied"] - log["supplied"][0]
    assert np.abs(put_in).max() > 0.02  # more than a tenth of what there is at first
    assert np.abs(log["leak"]).max() < 1e-12


def test_impacts_of_the_handle_put_work_in():
    """A ball that the moving handle strikes: the work of the blow is booked, and the books close through it."""
    ball = hl.coordinate("ball", unit="m", initial=x(n) + h0 / 5)
    L = m * ball.diff(t) ** 2 / 2 - m * g * ball
    hit = hl.contact.Contact(ball - x(t), hl.contact.impulse(e=e), name="hit")
    scene = hl.Scene(force=0, eom=[lagrange(L, contacts=[hit])], watch={"p": hit.impulse, "work": hit.impact_work})
    log = run(energy_books(scene), 400, moved(400), method="taylor", velocity="measured")
    assert np.abs(np.diff(log["leak"])[2:]).max() < 1e-13
    blows = np.flatnonzero(log["p"] > 1e-9)
    assert len(blows) > 3
    # the handle's speed at the blow lies between those of the samples around it
    speed = np.diff(log["work"])[blows - 1] / log["p"][blows]
    assert (speed > moved(400)[1][blows - 1] - 1e-12).all() and (speed < moved(400)[1][blows] + 1e-12).all()


def test_the_port_leaks_by_sampling_beside_the_method():
    """Pushed by a hand, through a force that is held: the port takes half a period's change of force less, each period."""
    scene, _ = coupled()
    paddle = hl.SimulatedPaddle(m=0.05, b=2.0, T=T, hand=hl.Hand(m=0.1, push=1.0))
    log = paddle.run(energy_books(scene), duration=0.4, method="taylor", dtype="float64", progress=False)
    books = balance(log)
    assert books.supplied == pytest.approx(books.stored + books.dissipated + books.leak, abs=1e-15)
    assert books.port - (books.supplied - books.supplied[0]) == pytest.approx(books.sampling)
    assert books.port[-1] == pytest.approx(books.supplied[-1] - books.supplied[0], rel=0.05)
    # held against trapezoidal: the leak of Fig. 23.6, to the order of the period
    leak = np.r_[0, np.cumsum(-0.5 * np.diff(log.F) * np.diff(log.x))]
    assert np.abs(books.sampling - leak).max() < 0.1 * np.abs(leak).max()
    assert "supplied" in str(books) and "differs by" in str(books)


def test_what_has_no_books_is_refused():
    with pytest.raises(AnalysisError, match=r"zoh wall has no equations of motion"):
        energy_books(hl.wall())
    z = hl.coordinate("z", unit="m")
    free = hl.Scene(force=0, eom=[sp.Eq(m * z.diff(t, 2), 0)])
    with pytest.raises(AnalysisError, match=r"the equation of z gives no energy; give stored=,"):
        energy_books(free)
    sampled = hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t, 2), k * x(n))])
    with pytest.raises(AnalysisError, match=r"its force contains samples, .* Give supplied="):
        energy_books(sampled, stored=m * z.diff(t) ** 2 / 2)
    with pytest.raises(SceneError, match=r"already watches stored"):
        energy_books(hl.Scene(force=0, eom=[sp.Eq(m * z.diff(t, 2), 0)], watch={"stored": z}), stored=m * z.diff(t) ** 2 / 2)
    held = lagrange(m * z.diff(t) ** 2 / 2 + FALL, constraints=[z - q - x(t)])
    with pytest.raises(AnalysisError, match=r"the constraint .* = 0 moves with the handle or with time"):
        energy_books(hl.Scene(force=0, eom=[held]))
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=T).run(hl.wall()(k=100), duration=0.01, progress=False)
    with pytest.raises(AnalysisError, match=r"balance: the record has no supplied, .* leak. Run hl.records.energy_books"):
        balance(log)
