"""Contacts of whole scenes, from the Lagrangian to the program: bounce, rest, friction and blows against closed forms."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ProgramError, SceneError
from hapticlab.scene.mechanics.lagrange import lagrange

T, M, G, H = 1e-3, 0.5, 9.81, 0.1
m, g, h0 = hl.parameters("m g h0", units="kg m/s^2 m", values=(M, G, H))
q = hl.coordinate("q", unit="m", initial=h0)
HANDLE = x(t)
FALL = m * q.diff(t) ** 2 / 2 - m * g * q


def run(scene, ticks, method="taylor", x=None, **options):
    """Return the channels of a run as a dict, time first; the handle goes through x."""
    program = hl.compile(scene, method=method, T=T, dtype="float64", **options)
    handle = np.zeros((ticks, len(program.inputs)))
    if x is not None:
        handle[:, 0] = x
    outputs = load(program).run(ticks, handle).outputs[:, :, 0].T
    channels = dict(zip([c.name for c in program.outputs], outputs, strict=True))
    assert not channels.get("unlocated", np.zeros(1)).any()
    return {"t": T * np.arange(ticks), **channels}


def dropped(law, **watch):
    floor = hl.contact.Contact(q, law, name="floor")
    watch = {"q": q, "w": q.diff(t), **{name: getattr(floor, part) for name, part in watch.items()}}
    return hl.Scene(force=0, eom=[lagrange(FALL, contacts=[floor])], watch=watch)


def test_a_dropped_ball_bounces_and_comes_to_rest_on_its_weight():
    log = run(dropped(hl.contact.impulse(e=0.8), N="force", p="impulse"), 1400)
    v, s, rebound = np.sqrt(2 * G * H), np.sqrt(2 * H / G), 0.8
    flight = (s < log["t"]) & (log["t"] < s + 2 * 0.8 * v / G)
    tau = log["t"][flight] - s
    assert np.abs(log["q"][flight] - (0.8 * v * tau - G * tau**2 / 2)).max() < 1e-13
    hits = np.flatnonzero(log["p"] > 0.05)
    assert log["p"][hits[:3]] == pytest.approx([M * (1 + rebound) * v * rebound**k for k in range(3)], rel=1e-12)
    # known at the sample after the impact
    assert hits[0] == np.ceil(s / T)
    assert log["N"][-1] == pytest.approx(M * G, rel=1e-14) and log["q"][-1] == pytest.approx(0, abs=1e-14)


def test_a_rigid_contact_stays_where_it_lands():
    log = run(dropped(hl.contact.rigid(), N="force"), 400)
    landed = np.sqrt(2 * H / G)
    resting = log["t"] > landed
    assert np.abs(log["q"][resting]).max() < 1e-14
    assert log["N"][log["t"] > landed + T] == pytest.approx(M * G)


def penetration(law_force, until):
    """Integrate the first contact of the drop; return (t out, speed out)."""
    v = np.sqrt(2 * G * H)

    def out(_, y):
        return y[0]

    out.terminal, out.direction = True, 1
    end = solve_ivp(lambda _, y: [y[1], law_force(-y[0], -y[1]) / M - G], (0, until), [-1e-15, -v], method="DOP853",
                    events=out, rtol=1e-13, atol=1e-15)  # fmt: skip
    return end.t_events[0][0], end.y_events[0][0][1]


@pytest.mark.parametrize("method, tolerance", [("taylor", 1e-9), ("rk4", 2e-3)])
@pytest.mark.always("rk4-*")
def test_a_penalty_floor_gives_back_what_its_integration_does(method, tolerance):
    """Spring and damper, the damper's jump at touch and the end of the push located; rk4 keeps to its order."""
    k, b = hl.parameters("k b", units="N/m N*s/m", values=(3000, 4))
    log = run(dropped(hl.contact.penalty(k=k, b=b)), 260, method=method)
    lasts, out = penetration(lambda d, w: max(0.0, 3000 * d + 4 * w), 0.2)
    leaves = np.sqrt(2 * H / G) + lasts
    flying = (log["t"] > leaves + T) & (log["t"] < leaves + 0.1)
    assert flying.sum() > 50
    tau = log["t"][flying] - leaves
    assert np.abs(log["w"][flying] - (out - G * tau)).max() < tolerance


@pytest.mark.parametrize("exponent, unit", [(2, "N/m^2"), (1.5, "N/m^1.5")])
@pytest.mark.always("1.5-*")
def test_hunt_crossley_rebounds_with_its_restitution(exponent, unit):
    """Thrown at a wall without weight at c v = 0.42: e is the closed form's, to the fourth order of the method."""
    k, c, u = hl.parameters("k_h c u", units=f"{unit} s/m m/s", values=(1e5, 0.3, 1.4))
    z = hl.coordinate("z", unit="m", initial=h0 / 10, rate=-u)
    wall = hl.contact.Contact(z, hl.contact.hunt_crossley(k=k, c=c, exponent=exponent), name="wall")
    motion = lagrange(m * z.diff(t) ** 2 / 2, contacts=[wall])
    log = run(hl.Scene(force=0, eom=[motion], watch={"w": z.diff(t)}), 100, method="rk4", substeps=20)
    assert log["w"][-1] / 1.4 == pytest.approx(hl.contact.hunt_crossley.restitution(0.42), rel=1e-7)


@pytest.mark.wide
def test_newtons_cradle_of_three_swings_without_loss():
    """Equal pendulums in touch: the first swings in from the left, the last swings out on the right, the middle hangs still."""
    k_p, lift = hl.parameters("k_p lift", units="N/m m", values=(20, -0.03))
    balls = [hl.coordinate(f"q_{i}", unit="m", initial=lift if i == 1 else 0) for i in (1, 2, 3)]
    L = sum(m * q.diff(t) ** 2 / 2 - k_p * q**2 / 2 for q in balls)
    touching = [
        hl.contact.Contact(b - a, hl.contact.impulse(e=1), name=f"c_{i}")
        for i, (a, b) in enumerate(zip(balls, balls[1:], strict=False))
    ]
    log = run(hl.Scene(force=0, eom=[lagrange(L, contacts=touching)], watch=balls), 1500)
    angle = np.sqrt(20 / M) * log["t"]
    assert np.abs(log["q_1"] + 0.03 * np.maximum(np.cos(angle), 0)).max() < 1e-13
    assert np.abs(log["q_3"] - 0.03 * np.maximum(-np.cos(angle), 0)).max() < 1e-13
    assert np.abs(log["q_2"]).max() < 1e-13


def test_a_block_slides_to_a_stop_and_stays():
    F_c, w0 = hl.parameters("F_c w0", units="N m/s", values=(1.2, 0.8))
    z = hl.coordinate("z", unit="m", rate=w0)
    rub = hl.contact.friction(slip=z.diff(t), coulomb=F_c)
    scene = hl.Scene(
        force=0, eom=[lagrange(m * z.diff(t) ** 2 / 2, contacts=[rub])], watch={"z": z, "w": z.diff(t), "F_f": rub.force}
    )
    log = run(scene, 600)
    a = 1.2 / M
    s = np.minimum(log["t"], 0.8 / a)
    assert np.abs(log["z"] - (0.8 * s - a * s**2 / 2)).max() < 1e-14
    stopped = log["t"] > 0.8 / a
    assert (log["w"][stopped] == 0).all() and np.abs(log["F_f"][log["t"] > 0.8 / a + T]).max() < 1e-12


def test_dry_friction_carries_its_share_of_a_reaction():
    """A block that slides on a floor it rests on, F_c = mu N with N found while it runs: it stops after w^2/(2 mu g)."""
    mu, w0 = hl.parameters("mu w0", units="1 m/s", values=(0.3, 0.8))
    y, s = hl.coordinate("y", unit="m"), hl.coordinate("s", unit="m", rate=w0)
    floor = hl.contact.Contact(y, hl.contact.impulse(e=0.5), name="floor")
    rub = hl.contact.friction(slip=s.diff(t), coulomb=mu * floor.force, name="rub")
    L = m * (y.diff(t) ** 2 + s.diff(t) ** 2) / 2 - m * g * y
    scene = hl.Scene(force=0, eom=[lagrange(L, contacts=[floor, rub])], watch={"s": s, "N": floor.force, "F_f": rub.force})
    log = run(scene, 500)
    a = 0.3 * G
    tau = np.minimum(log["t"], 0.8 / a)
    assert np.abs(log["s"] - (0.8 * tau - a * tau**2 / 2)).max() < 1e-14
    assert log["N"][1:] == pytest.approx(M * G, rel=1e-14)
    assert log["F_f"][1 : int(0.8 / a / T)] == pytest.approx(0.3 * M * G, rel=1e-14) and abs(log["F_f"][-1]) < 1e-14


@pytest.mark.slow
def test_a_constrained_body_strikes_as_the_same_body_in_one_coordinate():
    """A pendulum in x and y on a constraint, against its angle: the impact goes through the multiplier."""
    d, r = hl.parameters("d r", units="m m", values=(0.05, 0.3))
    X, Y = hl.coordinate("X", unit="m", initial=r), hl.coordinate("Y", unit="m")
    angle = hl.coordinate("angle", unit="rad", initial=np.pi / 2)
    law, logs = hl.contact.impulse(e=0.7), []
    flat = lagrange(
        m * (X.diff(t) ** 2 + Y.diff(t) ** 2) / 2 - m * g * Y, constraints=[X**2 + Y**2 - r**2],
        contacts=[hl.contact.Contact(X + d, law, name="stop")],
    )  # fmt: skip
    turned = lagrange(
        m * r**2 * angle.diff(t) ** 2 / 2 + m * g * r * sp.cos(angle), contacts=[hl.contact.Contact(r * sp.sin(angle) + d, law)]
    )
    for motion, place in ((flat, X), (turned, r * sp.sin(angle))):
        logs.append(run(hl.Scene(force=0, eom=[motion], watch={"place": place}), 1200))
    assert np.abs(logs[0]["place"] - logs[1]["place"]).max() < 1e-12
    assert logs[0]["place"].min() == pytest.approx(-0.05, abs=1e-3)


def test_stick_slip_breaks_away_slides_and_sticks_as_in_closed_form():
    """A spring drawn at V: sticks until K V t = F_s, then y = V t - z obeys m y'' + K y = F_c until z' = 0."""
    mass, K, F_s, F_c, V = 0.1, 200.0, 2.0, 1.0, 0.05
    names = hl.parameters("m_b K F_s F_c V", units="kg N/m N N m/s", values=(mass, K, F_s, F_c, V))
    z = hl.coordinate("z", unit="m")
    pull = names[1] * (names[4] * t - z)
    rub = hl.contact.friction(slip=z.diff(t), coulomb=names[3], breakaway=names[2])
    motion = lagrange(names[0] * z.diff(t) ** 2 / 2, forces={z: pull}, contacts=[rub])
    log = run(hl.Scene(force=0, eom=[motion], watch={"z": z, "w": z.diff(t), "F_f": rub.force}), 500)
    away, omega = F_s / (K * V), np.sqrt(K / mass)

    def slid(tau):
        y = F_c / K + (F_s - F_c) / K * np.cos(omega * tau) + V / omega * np.sin(omega * tau)
        return V * (away + tau) - y

    def speed(tau):
        return V + (F_s - F_c) / K * omega * np.sin(omega * tau) - V * np.cos(omega * tau)

    stops = brentq(speed, 0.5 * np.pi / omega, 1.5 * np.pi / omega, xtol=1e-15)
    tau = log["t"] - away
    expected = np.where(tau <= 0, 0, slid(np.minimum(np.maximum(tau, 0), stops)))
    first = log["t"] < away + stops + 0.1
    assert np.abs(log["z"] - expected)[first].max() < 1e-12
    sticking = (tau > stops + T) & first
    assert (log["w"][sticking] == 0).all()
    assert log["F_f"][sticking] == pytest.approx(K * (V * log["t"][sticking] - slid(stops)), abs=1e-11)


def test_a_blow_with_friction_takes_from_the_slip():
    """A disc that skims a wall: mu (1 + e) u off its slip, 7/2 of it in the slip of a solid sphere's edge."""
    u0, w0, e, mu = 1.5, 2.0, 0.6, 0.2
    y = hl.coordinate("y", unit="m", initial=h0, rate=hl.parameters("u0", units="m/s", values=-u0))
    s = hl.coordinate("s", unit="m", rate=hl.parameters("w0", units="m/s", values=w0))
    r = hl.parameters("r", units="m", values=0.03)
    spin = hl.coordinate("phi", unit="rad")
    L = m * (y.diff(t) ** 2 + s.diff(t) ** 2) / 2 + m * r**2 * spin.diff(t) ** 2 / 5
    wall = hl.contact.Contact(y, hl.contact.impulse(e=e, mu=mu), name="wall", slip=s.diff(t) - r * spin.diff(t))
    scene = hl.Scene(force=0, eom=[lagrange(L, contacts=[wall])], watch={"y": y.diff(t), "s": s.diff(t), "phi": spin.diff(t)})
    log = run(scene, 120)
    taken = mu * (1 + e) * u0
    assert log["y"][-1] == pytest.approx(e * u0, rel=1e-14)
    assert log["s"][-1] == pytest.approx(w0 - taken, rel=1e-13)
    assert log["phi"][-1] == pytest.approx(2.5 * taken / 0.03, rel=1e-13)


@pytest.mark.parametrize("method", ["rk4", "verlet", "taylor"])
def test_micro_impulses_run_with_every_method(method):
    log = run(dropped(hl.contact.micro_impulse(e=0.3), p="impulse", N="force"), 1500, method=method)
    assert log["p"][1000:].mean() == pytest.approx(M * G * T, rel=2e-3)
    assert log["N"][1000:].mean() == pytest.approx(M * G, rel=2e-3)
    assert np.abs(log["q"][1000:]).max() < 2e-4


def test_the_hand_feels_the_momentum_that_the_ball_takes():
    """A ball falls on a handle held at x = 0: the felt force integrates to the momentum it gave, and then to its weight."""
    ball = hl.coordinate("ball", unit="m", initial=x(n) + h0)
    law = hl.contact.Contact(ball - x(t), hl.contact.impulse(e=0.5), name="hit")
    felt = hl.contact.felt_impulse(law, tau="20 ms")
    motion = lagrange(m * ball.diff(t) ** 2 / 2 - m * g * ball, contacts=[law])
    scene = hl.Scene(felt.force, [motion, *felt.equations], watch={"w": ball.diff(t), "q": ball, "p": law.impulse})
    log = run(scene, 1200, x=np.zeros(1200))
    assert log["F"].max() < 25 < log["p"].max() / T
    given = M * log["w"][-1] + M * G * log["t"][-1]
    # sums of samples: the felt force lags by a period, and the period in which rest begins is its own
    assert log["F"].sum() * T == pytest.approx(given, abs=2 * M * G * T)
    assert log["F"][-1] == pytest.approx(M * G, rel=1e-9)


def test_contacts_too_short_and_rests_too_slow_for_the_period_are_refused():
    k = hl.parameters("k", units="N/m", values=1e5)
    scene = dropped(hl.contact.penalty(k=k))
    with pytest.raises(SceneError, match=r"floor: the contact lasts 7.02 ms .* 7.0 steps of 1 ms; rk4 needs 10. Use substeps=2,"):
        hl.compile(scene, T=T)
    hl.compile(scene, T=T, substeps=2)
    hl.compile(scene(k=4e4), T=T)
    with pytest.raises(SceneError, match=r"floor: rest_speed = 0.004 m/s; needs at least a T/2 = 0.004905 m/s"):
        hl.compile(dropped(hl.contact.impulse(e=0.8, rest_speed=0.004)), method="taylor", T=T)
    hl.compile(dropped(hl.contact.impulse(e=0.8, rest_speed="6 mm/s")), method="taylor", T=T)


def test_what_cannot_run_is_refused():
    with pytest.raises(ProgramError, match=r"floor needs events located .* is method='taylor'; .* impact is late .*penalty"):
        run(dropped(hl.contact.impulse(e=0.8)), 1, method="rk4")
    pull = hl.parameters("F_c", units="N", values=1)
    brake = hl.contact.friction(slip=q.diff(t), coulomb=pull, name="brake")
    rubbed = hl.Scene(force=0, eom=[lagrange(FALL, contacts=[brake])], watch=[q])
    with pytest.raises(ProgramError, match=r"brake needs events .*a friction never comes to rest. Other methods take a friction"):
        run(rubbed, 1, method="rk4")
    both = lagrange(FALL, contacts=[hl.contact.Contact(q, hl.contact.rigid(), name="floor"), brake])
    with pytest.raises(ProgramError, match=r"floor, brake need events"):
        run(hl.Scene(force=0, eom=[both]), 1, method="rk4")
    with pytest.raises(ProgramError, match=r"with brake, which may stick; use method='taylor', which locates the switch"):
        run(rubbed, 1, method="exact+rk4")
    with pytest.raises(ProgramError, match=r"method = 'exat'; needs one of .*exact, exact\+rk4"):
        run(rubbed, 1, method="exat")
    z = hl.coordinate("z", unit="m", initial=h0)
    L = FALL + m * z.diff(t) ** 2 / 2
    e = hl.contact.impulse(e=0.5)

    def scene(*contacts):
        return hl.Scene(force=0, eom=[lagrange(L, contacts=contacts)])

    pair = [
        hl.contact.Contact(q, e, name="a"),
        hl.contact.Contact(z, hl.contact.impulse(e=0.5, impacts="simultaneous"), name="b"),
    ]
    with pytest.raises(SceneError, match=r"a: sequential; b: simultaneous: the impacts of a scene are all sequential, or all"):
        run(scene(*pair), 1)
    rough = hl.contact.impulse(e=0.5, impacts="simultaneous", mu=0.1)
    pair = [hl.contact.Contact(q, rough, name="a", slip=z.diff(t)), hl.contact.Contact(z, hl.contact.rigid(), name="b")]
    with pytest.raises(SceneError, match=r"a: friction in impacts at several contacts at once has no unique outcome"):
        run(scene(*pair), 1)
    with pytest.raises(SceneError, match=r"two contacts are called a"):
        scene(hl.contact.Contact(q, e, name="a"), hl.contact.Contact(z, e, name="a"))


def test_a_contact_that_no_model_has_is_refused():
    ball = hl.coordinate("ball", unit="m", initial=x(n) + h0)
    top = hl.contact.Contact(ball - x(t), hl.contact.impulse(e=0.5), name="top")
    felt = hl.contact.felt_impulse(top, tau="20 ms")
    motion = lagrange(m * ball.diff(t) ** 2 / 2 - m * g * ball)
    rub = hl.contact.friction(slip=ball.diff(t), coulomb=0.1 * top.force, name="rub")
    for scene in (
        hl.Scene(force=-top.force, eom=[motion], watch=[ball]),
        hl.Scene(force=-top.force),
        hl.Scene(felt.force, [motion, *felt.equations]),
        hl.Scene(force=0, eom=[motion], watch={"loss": top.impact_loss}),
        hl.Scene(force=0, eom=[lagrange(m * ball.diff(t) ** 2 / 2, contacts=[rub])], watch=[ball]),
    ):
        with pytest.raises(
            SceneError, match=r"top is used but belongs to no model. Write hl.mechanics.lagrange\(..., contacts=\[top\]\)"
        ):
            hl.compile(scene, method="taylor", T=T)


def test_impulses_that_are_not_felt_are_noted():
    ball = hl.coordinate("ball", unit="m", initial=x(n) + h0)
    note = "top acts by impulses, which top.force does not contain; hl.contact.felt_impulse(top, tau='5 ms') makes them felt"

    def notes(law, force, plate=HANDLE, extra=lambda top: ()):
        top = hl.contact.Contact(ball - plate, law, name="top")
        motion = lagrange(m * ball.diff(t) ** 2 / 2 - m * g * ball, contacts=[top])
        scene = hl.Scene(force(top), [motion, *extra(top)], watch={"ball": ball, "p": top.impulse})
        return hl.compile(scene, method="taylor", T=T).notes

    def felt(top):
        return hl.contact.felt_impulse(top, tau="5 ms")

    for law in (hl.contact.impulse(e=0.5), hl.contact.rigid()):
        assert note in notes(law, lambda top: top.force)
        assert note in notes(law, lambda top: 0)
        assert note not in notes(law, lambda top: felt(top).force, extra=lambda top: felt(top).equations)
    assert note not in notes(hl.contact.impulse(e=0.5), lambda top: 0, plate=0)  # a floor that the handle has no part in
    assert note not in notes(
        hl.contact.micro_impulse(e=0.5), lambda top: top.force
    )  # its force is what its impulses give a period
