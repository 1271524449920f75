"""method="exact": against closed forms and an integrator, at any stiffness; what it costs; what it refuses."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.boards.board_fit import fit
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.prune.constant_coefficients import Coefficients, linear_rows
from hapticlab.errors import ProgramError, ProgramLimitError

T = 1e-3
w, y, z = (hl.coordinate(name, unit="m") for name in "wyz")
th = hl.coordinate("th", unit="rad")
k, m, b = hl.parameters("k m b", units="N/m kg N*s/m", values=(500, 0.05, 0.8))


def chain(count, *, b=0.0, k=2000.0, start=0.0, watch=()):
    masses = [hl.coordinate(f"z{i}", unit="m", initial=hl.parameters("z_0", units="m", values=start)) for i in range(count)]
    K, M, B = hl.parameters("k m b", units="N/m kg N*s/m", values=(k, 0.02, b))
    places, rates, eom = [x(t), *masses], [v(t), *(q.diff(t) for q in masses)], []

    def pull(i):
        return K * (places[i] - places[i + 1]) + (B * (rates[i] - rates[i + 1]) if b else 0)

    for i, q in enumerate(masses):
        eom.append(sp.Eq(M * q.diff(t, 2), pull(i) - (pull(i + 1) if i < count - 1 else 0)))
    watched = [*masses, *(q.diff(t) for q in masses)] if watch else []
    return hl.Scene(force=pull(0), eom=eom, watch=watched, name=f"chain of {count}")


def run(scene, X, V=None, **options):
    """Return outputs (ticks, channels) in float64 under a handle that moves as given."""
    program = hl.compile(scene, T=T, dtype="float64", velocity="measured", **{"method": "exact", "live": (), **options})
    columns = np.column_stack([X, np.gradient(X, T) if V is None else V])[:, : len(program.inputs)]
    return load(program).run(len(X), columns).outputs[:, :, 0]


def between(hold, X, V, i):
    """Return x and v of the handle after sample i as a hold sees them."""
    a = (V[i] - V[max(i - 1, 0)]) / T
    return {
        "zoh": lambda s: (X[i], V[i]),
        "foh": lambda s: (X[i] + V[i] * s, V[i]),
        "soh": lambda s: (X[i] + V[i] * s + a * s * s / 2, V[i] + a * s),
    }[hold]


def integrated(rates, states, X, V, hold, ticks):
    """Return the states at the samples, by an integrator of tolerance 1e-12."""
    found = [np.array(states, float)]
    for i in range(ticks - 1):
        handle = between(hold, X, V, i)
        answer = solve_ivp(lambda s, q, h=handle: rates(q, *h(s)), (0, T), found[-1], method="DOP853", rtol=1e-12, atol=1e-15)
        found.append(answer.y[:, -1])
    return np.array(found)


TIME = np.arange(60) * T
SWING = 0.01 * np.sin(2 * np.pi * 5 * TIME), 0.01 * 2 * np.pi * 5 * np.cos(2 * np.pi * 5 * TIME)


@pytest.mark.parametrize("hold", ["zoh", "foh", "soh"])
@pytest.mark.always("foh")
def test_chain_against_an_integrator(hold):
    X, V = SWING
    outputs = run(chain(3, b=0.3, k=2e4), X, V, hold=hold)
    K = np.diag([2.0, 2, 1]) - np.diag([1.0, 1], 1) - np.diag([1.0, 1], -1)

    def rates(q, place, speed):
        pull = -2e4 * K @ q[:3] - 0.3 * K @ q[3:]
        pull[0] += 2e4 * place + 0.3 * speed
        return np.r_[q[3:], pull / 0.02]

    states = integrated(rates, np.zeros(6), X, V, hold, len(X))
    F = 2e4 * (X - states[:, 0]) + 0.3 * (V - states[:, 3])
    assert abs(outputs[:, 0] - F).max() < 1e-10 * abs(F).max()


@pytest.mark.parametrize("stiffness", [2e3, 2e6, 2e9])
@pytest.mark.always("2000000000.0")
def test_no_step_error_at_any_stiffness(stiffness):
    """A lossless chain let go from rest, the handle held: energy and place after 4000 ticks, omega T up to 600."""
    outputs = run(chain(3, k=stiffness, start=0.004, watch=True), np.zeros(4000))
    q, rate = outputs[:, 1:4], outputs[:, 4:7]
    stretch = np.diff(np.c_[np.zeros(len(q)), q], axis=1)
    energy = 0.01 * (rate**2).sum(axis=1) + stiffness / 2 * (stretch**2).sum(axis=1)
    K = np.diag([2.0, 2, 1]) - np.diag([1.0, 1], 1) - np.diag([1.0, 1], -1)
    square, U = np.linalg.eigh(stiffness / 0.02 * K)
    at = U @ (np.cos(np.sqrt(square) * 3999 * T) * (U.T @ np.full(3, 0.004)))
    of_each_tick = 2e-16 * (1 + np.sqrt(square.max()) * T)  # the rounding of a frequency may feed or take energy
    assert abs(energy / energy[0] - 1).max() < 4000 * of_each_tick
    turned = np.sqrt(square.max()) * 3999 * T  # the angle itself is known to a rounding of its frequency
    assert abs(q[-1] - at).max() < 0.004 * max(1e-10, 1e-14 * turned)


def test_float32_keeps_its_energy_for_a_minute():
    program = hl.compile(chain(2, start=0.004, watch=True), T=T, method="exact", live=())
    outputs = load(program).run(60_000, np.zeros((60_000, 1)), every=1000).outputs[:, :, 0]
    stretch = np.diff(np.c_[np.zeros(60), outputs[:, 1:3]], axis=1)
    energy = 0.01 * (outputs[:, 3:5] ** 2).sum(axis=1) + 1000 * (stretch**2).sum(axis=1)
    assert abs(energy / energy[0] - 1).max() < 5e-3  # rk4 loses half of it in the first second


def test_modes_that_cannot_be_told_apart_stay_states():
    """A mass pulled by a damper alone has two zero poles, one of them never seen; and a critically damped one."""
    X = 0.01 * TIME / TIME[-1]
    free = hl.Scene(force=b * (v(t) - z.diff(t)), eom=[sp.Eq(m * z.diff(t, 2), b * (v(t) - z.diff(t)))], watch=[z])
    V = np.full(len(X), X[1] / T)
    out = run(free, X, V)
    rate = 0.8 / 0.05
    assert out[:, 1] == pytest.approx(V[0] * (TIME - (1 - np.exp(-rate * TIME)) / rate), rel=1e-11, abs=1e-16)
    critical = 2 * np.sqrt(500 * 0.05)
    eom = sp.Eq(m * z.diff(t, 2), -k * z - b * z.diff(t))
    start = hl.coordinate("z", unit="m", initial=hl.parameters("z_0", units="m", values=0.01))
    settled = hl.Scene(force=k * z, eom=[eom], watch=[z])
    settled = hl.Scene(force=settled.force.xreplace({z: start}), eom=[eom.xreplace({z: start})], watch=[start])
    pole = np.sqrt(500 / 0.05)
    out = run(settled(b=critical), np.zeros(60))
    assert out[:, 1] == pytest.approx(0.01 * (1 + pole * TIME) * np.exp(-pole * TIME), rel=1e-9)


def test_states_of_first_order_and_what_stays_the_same():
    """A filter of first order that moves a mass, beside weight and a wall law of the sample: held over the period."""
    s = hl.coordinate("s", unit="N")
    r, g, k_w = hl.parameters("r g k_w", units="1/s m/s^2 N/m", values=(40, 9.81, 300))
    wall = hl.when(x(n) > 0, k_w * x(n) ** 2 / hl.parameters("L", units="m", values=1))
    eom = [sp.Eq(s.diff(t), r * (k * x(t) - s)), sp.Eq(m * z.diff(t, 2), s + wall - m * g - k * z)]
    scene = hl.Scene(force=s, eom=eom, watch=[z])
    X, V = SWING
    program = hl.compile(scene, T=T, method="exact", live="g k_w", dtype="float64", velocity="measured")
    assert [c.name for c in program.parameters] == ["g", "k_w"]
    out = load(program).run(60, np.column_stack(SWING), [5.0, 700.0]).outputs[:, :, 0]
    held = [700 * a * a * (a > 0) for a in X]
    A = np.array([[0, 1, 0], [-500 / 0.05, 0, 1 / 0.05], [0, 0, -40]])
    q, found = np.zeros(3), []
    for i in range(60):
        found.append([q[2], q[0]])
        a = (V[i] - V[max(i - 1, 0)]) / T
        big = np.zeros((7, 7))  # the state, a constant, and x, v, a of the handle
        big[:3, :3], big[1, 3], big[2, 4], big[4, 5], big[5, 6] = A, held[i] / 0.05 - 5, 40 * 500, 1, 1
        q = (expm(big * T) @ np.r_[q, 1, X[i], V[i], a])[:3]
    assert abs(out - found).max() < 1e-13


@pytest.mark.parametrize("stiffness, off", [(500, 5e-5), (5e7, 1e-3)])
def test_what_time_drives_is_a_parabola_over_the_period(stiffness, off):
    """A mass shaken at 30 Hz from rest, 0.2 s long, against its closed form; the stiff one is far past what rk4 holds."""
    A, f = hl.parameters("A f", units="N Hz", values=(2, 30))
    scene = hl.Scene(force=k * z, eom=[sp.Eq(m * z.diff(t, 2), A * sp.sin(2 * sp.pi * f * t) - k * z)], watch=[z])
    program = hl.compile(scene(k=stiffness), T=T, method="exact", live="A f", dtype="float64")
    found = load(program).run(200, np.zeros((200, 1))).outputs[:, 1, 0]
    time, drive, own = np.arange(200) * T, 2 * np.pi * 30, np.sqrt(stiffness / 0.05)
    exact = 2 / 0.05 / (own**2 - drive**2) * (np.sin(drive * time) - drive / own * np.sin(own * time))
    # a parabola through three values of sin(w t) is off by (w T)^3/125 = 5e-5 at most; its slope, which steps at the
    # samples and shakes what is stiff, by (w T)^3/24 = 3e-4 of w
    assert abs(found - exact).max() < off * abs(exact).max()


@pytest.mark.parametrize("count", [1, 2, 4, 8])
@pytest.mark.parametrize("b", [0.0, 0.5])
@pytest.mark.always("*-1", "*-4")
def test_it_costs_less_than_rk4(count, b):
    exact, rk4 = (len(hl.compile(chain(count, b=b), T=T, live=(), method=method)) for method in ("exact", "rk4"))
    assert exact < 0.65 * rk4


def pendulum(drive):
    """A pendulum on a moving pivot, behind a linear mass."""
    g, length = hl.parameters("g l", units="m/s^2 m", values=(9.81, 0.1))
    c = hl.parameters("c", units="1/m/s^2", values=20000)
    return sp.Eq(th.diff(t, 2), -g / length * sp.sin(th) - (c * drive))


def test_the_linear_part_exactly_and_the_rest_by_rk4():
    X, V = SWING
    F = k * (x(t) - z) + b * (v(t) - z.diff(t))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F), pendulum(z)], watch=[th])
    out = run(scene, X, V, method="exact+rk4")

    def rates(q, place, speed):
        pull = (500 * (place - q[0]) + 0.8 * (speed - q[2])) / 0.05
        return [q[2], q[3], pull, -98.1 * np.sin(q[1]) - 20000 * q[0]]

    states = integrated(rates, np.zeros(4), X, V, "soh", len(X))
    F = 500 * (X - states[:, 0]) + 0.8 * (V - states[:, 2])
    assert abs(out[:, 0] - F).max() < 1e-11  # no error of a step, though rk4 has 1e-7
    assert abs(run(scene, X, V, method="rk4")[:, 0] - F).max() > 1e-8
    assert abs(states[:, 1]).max() > 0.1
    assert abs(out[:, 1] - states[:, 1]).max() < 1e-8  # rk4's own
    assert hl.compile(scene, T=T, method="exact+rk4", live="c g l").facts["method"] == "exact+rk4"


def test_equations_that_nothing_needs_do_not_count():
    F = k * (x(t) - z)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F), pendulum(z)])
    program = hl.compile(scene, T=T, method="exact", live="c g l")
    assert "th" in program.notes[0] and not program.parameters


F = k * (x(t) - z)
STOP = hl.when(z > w, k * (z - w))


@pytest.mark.parametrize(
    ("eom", "options", "said"),
    [
        ([sp.Eq(m * z.diff(t, 2), F)], {"live": "k"}, r"motion of z, but k in it is live\. .* method='exact', live=''"),
        ([sp.Eq(m * z.diff(t, 2), F)], {"live": None}, "k, m in it is live"),
        ([sp.Eq(m * z.diff(t, 2), F - k * sp.sin(z / w) * w), sp.Eq(m * w.diff(t, 2), -k * w)], {}, r"sin\(.*\).* is not linear"),
        ([sp.Eq(m * z.diff(t, 2), F - STOP), sp.Eq(m * w.diff(t, 2), -k * w)], {"live": "k"},
         r"Piecewise.* in the equation of z .* w\(t\).* the constants of each mode in advance, but k is live\."),
        ([sp.Eq(m * z.diff(t, 2) * (1 + z / w) ** 2, F), sp.Eq(m * w.diff(t, 2), F)], {}, r"the inertia m\*.* of z changes"),
        ([sp.Eq(m * z.diff(t, 2), F + k * z * x(n) / w), sp.Eq(b * w.diff(t), F)], {}, r"slope changes with"),
        ([sp.Eq(b * z.diff(t), F * hl.parameters("f", units="1/s", values=3) * t)], {}, "slope changes with time"),
        ([sp.Eq(m * z.diff(t, 2), F + k * z * sp.cos(hl.parameters("om", units="1/s", values=300) * t))], {},
         "slope changes with time;"),
        ([sp.Eq(m * z.diff(t, 2), F + k * w), sp.Eq(k * w, b * w.diff(t) + k * sp.Abs(w))], {"method": "exact+rk4"},
         r"Abs\(w\(t\)\) in"),
    ],
)  # fmt: skip
def test_what_it_refuses(eom, options, said):
    start = {q: hl.coordinate(str(type(q)), unit="m", initial=hl.parameters("w_0", units="m", values=0.01)) for q in (w,)}
    scene = hl.Scene(force=F, eom=[e.xreplace(start) for e in eom], watch=[])
    with pytest.raises(ProgramError, match=said):
        hl.compile(scene, T=T, **{"method": "exact", "live": (), **options})


def test_a_switch_of_time_is_noted():
    """The parabola of a period takes a jump up to T/3 early or late, in what it adds to the rate; nothing else is."""
    A, t0, om = hl.parameters("A t0 om", units="N s 1/s", values=(0.5, 0.0104, 70))
    push = hl.when(t > t0, A) + A * sp.sin(om * t)
    free = hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t, 2), push - b * z.diff(t))], watch=[z.diff(t)])
    program = hl.compile(free, T=T, method="exact", live=())
    (note,) = (note for note in program.notes if "T/3" in note)
    assert note.startswith("t0 < t in the equation of z is evaluated at the start, middle and end") and "'taylor' locates" in note
    fast, exact = (run(free, np.zeros(13), method=method)[-1, 1] for method in ("exact", "taylor"))
    late = -(fast - exact) * 0.05 / 0.5 * np.exp(0.8 / 0.05 * 1.6e-3)  # of a step of A/m that decays with b/m
    assert late == pytest.approx((1 / 6 - 0.4) * T, rel=0.01)
    square = hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t, 2), A * sp.sign(sp.sin(om * t)) - b * z.diff(t))], watch=[z])
    assert any("sign(sin(om*t)) in the equation" in note for note in hl.compile(square, T=T, method="exact", live=()).notes)
    smooth = hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t, 2), A * sp.sin(om * t) - b * z.diff(t))], watch=[z])
    assert not any("T/3" in note for note in hl.compile(smooth, T=T, method="exact", live=()).notes)


def test_it_names_what_could_be_had():
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F), pendulum(z)], watch=[th])
    with pytest.raises(ProgramError, match=r"sin\(th\(t\)\).* method='exact\+rk4' solves z exactly and the rest by rk4"):
        hl.compile(scene, T=T, method="exact", live=())
    for method in ("exact+euler2", "exact+taylor", "rk4+exact", "exakt", 4):
        with pytest.raises(ProgramError, match="needs one of"):
            hl.compile(scene, T=T, method=method, live=())


def test_scenes_without_motion_to_take():
    wall = hl.wall()(k=100, x_o=0)
    assert hl.compile(wall, T=T, method="exact").tick == hl.compile(wall, T=T).tick
    unseen = hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t, 2), F)])
    assert len(hl.compile(unseen, T=T, method="exact").states) == 0
    with pytest.raises(ProgramError, match=r"solves the whole period in one step\."):
        hl.compile(unseen, T=T, method="exact", substeps=2)


def test_one_way_only():
    """What a linear mass does not feel may be anything; what drives it must be linear as well."""
    feels = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F + k * y), sp.Eq(m * y.diff(t, 2), -k * y**3 / w**2),
                                   sp.Eq(m * w.diff(t, 2), -k * (w - x(t)))])  # fmt: skip
    rows, reasons = linear_rows(Coefficients(feels.explicit(), feels.values, T))
    names = [type(q).__name__ for q in feels.explicit().coordinates]
    assert [names[k] for k in rows] == ["w"]
    assert reasons[names.index("z")] == "y, which is not linear, drives z between two samples"


@pytest.mark.parametrize("hold", ["zoh", "foh", "soh"])
@pytest.mark.parametrize("velocity", ["measured", "backward_difference"])
@pytest.mark.always("measured-zoh")
def test_it_sees_the_handle_as_the_other_methods_do(hold, velocity):
    """What rk4 tends to as its error falls with the fourth power of its step."""
    X, V = SWING
    found = []
    for options in ({"method": "exact"}, {"method": "rk4", "substeps": 16}, {"method": "rk4", "substeps": 8}):
        seen = {"hold": hold, "velocity": velocity, "dtype": "float64"}
        program = hl.compile(chain(2, b=0.3), T=T, live=(), **seen, **options)
        found.append(load(program).run(60, np.column_stack([X, V])[:, : len(program.inputs)]).outputs)
    exact, fine, coarse = found
    assert abs(exact - fine).max() < 2e-8 * abs(exact).max()
    assert 12 < abs(exact - coarse).max() / abs(exact - fine).max() < 20


def test_it_is_offered_where_a_board_is_too_slow():
    with pytest.raises(ProgramLimitError, match=r"fits with method='exact', live=''"):
        fit(chain(1, b=0.5), "uno", T=1e-3)


def test_a_jump_of_the_state_is_not_linear_though_its_slope_is_zero_on_both_sides():
    F = hl.parameters("F_c", units="N", values=0.3)
    u = hl.parameters("u", units="N*s/m", values=1.0)
    rubbed = hl.Scene(u * y.diff(t), [sp.Eq(m * y.diff(t, 2), k * (x(t) - y) - F * sp.sign(y.diff(t)))])
    with pytest.raises(ProgramError, match="jumps with sign"):
        hl.compile(rubbed, T=T, method="exact+rk4", live=())
