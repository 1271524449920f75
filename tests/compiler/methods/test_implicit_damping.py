"""Implicit damping: against (M - h D)^-1 f in numpy, closed forms, and what a diagonal D would break."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

import hapticlab as hl
from hapticlab import n, t
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.methods.implicit_damping import dissipative

METHOD = "semi_implicit_euler_damped"
T = 1e-3
matrices = st.integers(1, 4).flatmap(
    lambda N: st.lists(st.lists(st.floats(-5, 5), min_size=N, max_size=N), min_size=N, max_size=N)
)


@pytest.mark.wide
@settings(max_examples=60, derandomize=True)
@given(matrices, st.lists(st.floats(0.1, 10), min_size=4, max_size=4))
def test_what_is_kept_never_drives(slopes, sizes):
    """Whatever the slopes and weights, D is symmetric with no positive eigenvalue: M - h D is definite where M is."""
    D = np.array(dissipative(slopes, lambda i, j: sizes[i] / sizes[j]), float)
    assert (D == D.T).all()
    assert np.linalg.eigvalsh(D).max() <= 1e-12 * max(1.0, np.abs(D).max())


@pytest.mark.parametrize("seed", range(5))
def test_a_network_of_dampers_is_kept_whole(seed):
    """Dampers to the ground and between bodies: D is their matrix itself."""
    generator = np.random.default_rng(seed)
    between = np.triu(generator.uniform(0, 3, (4, 4)), 1)
    D = between + between.T - np.diag((between + between.T).sum(axis=0) + generator.uniform(0, 2, 4))
    np.testing.assert_allclose(np.array(dissipative(D.tolist(), lambda i, j: 1.0)), D, rtol=1e-14)


def test_what_drives_and_what_turns_is_left_out():
    assert dissipative([[3.0]], None) == [[0.0]]
    np.testing.assert_array_equal(dissipative([[0.0, 7.0], [-7.0, 0.0]], lambda i, j: 1.0), np.zeros((2, 2)))


def bodies(*, masses, forces, start, rates, other=""):
    """Return a scene of free bodies with initial places and rates, and what they are."""
    q = [
        hl.coordinate(f"q{k}", unit="m", initial=hl.parameters(f"q{k}_0", units="m", values=start[k]),
                      rate=hl.parameters(f"r{k}_0", units="m/s", values=rates[k]))
        for k in range(len(masses))
    ]  # fmt: skip
    m = [hl.parameters(f"m{k}", units="kg", values=masses[k]) for k in range(len(masses))]
    eom = [sp.Eq(m[k] * q[k].diff(t, 2), f) for k, f in enumerate(forces(q))]
    K = hl.parameters("K", units="N/m", values=1.0)
    return hl.Scene(force=K * hl.x(n), eom=eom, watch={f"w{k}": q[k].diff(t) for k in range(len(q))} | {"q0": q[0]})


def ran(scene, ticks, method=METHOD, **options):
    program = hl.compile(scene, method, **{"T": T, "dtype": "float64", **options})
    return load(program).run(ticks, np.zeros((ticks, 1))).outputs[:, 1:, 0]


def test_two_bodies_on_a_stiff_damper_keep_their_momentum_and_meet():
    """h b/m is 200 and 20: one step is (M - h D)^-1, which keeps m1 w1 + m2 w2 and leaves a slip of 1/(1 + h b (1/m1 + 1/m2))."""
    b = hl.parameters("b", units="N*s/m", values=2000.0)
    scene = bodies(
        masses=(0.01, 0.1), start=(0, 0), rates=(1.0, -0.5),
        forces=lambda q: [b * (q[1].diff(t) - q[0].diff(t)), b * (q[0].diff(t) - q[1].diff(t))],
    )  # fmt: skip
    out = ran(scene, 4)
    np.testing.assert_allclose(out[:, 0] * 0.01 + out[:, 1] * 0.1, 0.01 - 0.05, rtol=1e-12)
    kept = 1 / (1 + T * 2000.0 * (1 / 0.01 + 1 / 0.1))
    np.testing.assert_allclose(out[:, 0] - out[:, 1], 1.5 * kept ** np.arange(4), rtol=1e-11, atol=1e-15)


def test_a_step_is_the_linear_solve_of_a_chain():
    """Three bodies, springs and dampers of both kinds and a mass matrix that is not diagonal, against numpy."""
    k, b, g = hl.parameters("k b g", units="N/m N*s/m N*s/m", values=(300.0, 40.0, 15.0))
    q = [hl.coordinate(f"q{i}", unit="m", initial=hl.parameters(f"s{i}", units="m", values=0.01 * (i + 1))) for i in range(3)]
    m, j = hl.parameters("m j", units="kg kg", values=(0.02, 0.005))
    w = [a.diff(t) for a in q]
    T_ = m * sum(a**2 for a in w) / 2 + j * (w[0] * w[1] + w[1] * w[2])
    force = {q[0]: k * (q[1] - q[0]) + b * (w[1] - w[0]) - g * w[0],
             q[1]: k * (q[0] - 2 * q[1] + q[2]) + b * (w[0] - 2 * w[1] + w[2]),
             q[2]: k * (q[1] - q[2]) + b * (w[1] - w[2])}  # fmt: skip
    scene = hl.Scene(
        force=k * hl.x(n), eom=[hl.mechanics.lagrange(T_, forces=force)], watch={f"w{i}": a for i, a in enumerate(w)}
    )
    chain = np.array([[-1.0, 1, 0], [1, -2, 1], [0, 1, -1]])
    M = np.array([[0.02, 0.005, 0], [0.005, 0.02, 0.005], [0, 0.005, 0.02]])
    D = 40.0 * chain - np.diag([15.0, 0, 0])
    place, rate = np.array([0.01, 0.02, 0.03]), np.zeros(3)
    expected = []
    for _ in range(20):
        expected.append(rate)
        rate = rate + T * np.linalg.solve(M - T * D, 300.0 * chain @ place + D @ rate)
        place = place + T * rate
    np.testing.assert_allclose(ran(scene, 20), expected, rtol=0, atol=1e-13)


def test_a_mass_written_with_a_minus_sign_is_damped_all_the_same():
    z = hl.coordinate("z", unit="m", rate=hl.parameters("r", units="m/s", values=1.0))
    m, b = hl.parameters("m b", units="kg N*s/m", values=(0.01, 100.0))
    for eom in (sp.Eq(m * z.diff(t, 2), -b * z.diff(t)), sp.Eq(-b * z.diff(t), m * z.diff(t, 2))):
        out = ran(hl.Scene(force=b * hl.v(n), eom=[eom], watch={"w": z.diff(t)}), 4)
        np.testing.assert_allclose(out[:, 0], (1 / 11.0) ** np.arange(4), rtol=1e-12)


def test_van_der_pol_swings_though_its_damping_drives():
    """h mu (1 - q^2) is above 1 near q = 0: unclamped the step would divide by less than 0. Amplitude 2 (mu = 1, within 1 %)."""
    q = hl.coordinate("q", unit="1", initial=hl.parameters("q_0", units="1", values=0.01))
    mu, w = hl.parameters("mu w", units="1/s 1/s", values=(1.0, 1.0))
    scene = hl.Scene(
        force=hl.parameters("K", units="N/m", values=1.0) * hl.x(n), watch={"q": q},
        eom=[sp.Eq(q.diff(t, 2), mu * (1 - q**2) * q.diff(t) - w**2 * q)],
    )  # fmt: skip
    swing = ran(scene, 40_000)[20_000:, 0]
    assert np.abs(swing).max() == pytest.approx(2.0086, rel=2e-3)  # the classical amplitude at mu = 1
    fast = ran(scene(mu=2000.0, w=10.0), 4000)
    assert np.isfinite(fast).all() and np.abs(fast).max() < 3.0


def test_an_embedded_joint_is_damped_through_its_constraint():
    """Two bodies on one rod, u = q + l, each on a damper: (m1 + m2 + h (b1 + b2)) w' = (m1 + m2) w."""
    r, l = hl.parameters("r l", units="m/s m", values=(1.0, 0.1))
    q = hl.coordinate("q", unit="m", rate=r)
    u = hl.coordinate("u", unit="m", initial=l, rate=r)
    m, b = hl.parameters("m b", units="kg N*s/m", values=(0.01, 50.0))
    for enforce in ("embed", "kkt"):
        rod = hl.mechanics.lagrange(
            m * (q.diff(t) ** 2 + u.diff(t) ** 2) / 2, forces={q: -b * q.diff(t), u: -3 * b * u.diff(t)},
            constraints=[u - q - l], enforce=enforce,
        )  # fmt: skip
        out = ran(hl.Scene(force=b * hl.v(n), eom=[rod], watch={"w": u.diff(t)}), 4)
        np.testing.assert_allclose(out[:, 0], (0.02 / (0.02 + T * 200.0)) ** np.arange(4), rtol=1e-11)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_drag_with_a_tip_at_rest_has_no_slope_there(dtype):
    """-c |w| w in a plane, |w| = sqrt(w1^2 + w2^2): its slope is 0/0 at rest."""
    c = hl.parameters("c", units="N*s^2/m^2", values=50.0)

    def drag(q):
        speed = sp.sqrt(q[0].diff(t) ** 2 + q[1].diff(t) ** 2)
        return [-c * speed * q[0].diff(t), -c * speed * q[1].diff(t)]

    still = ran(bodies(masses=(0.01, 0.01), start=(0, 0), rates=(0, 0), forces=drag), 3, dtype=dtype)
    np.testing.assert_array_equal(still, np.zeros((3, 3)))
    rate, expected = 1.0, []
    for _ in range(5):  # slopes: -2 c w along the motion
        expected.append(rate)
        rate -= T * 50.0 * rate**2 / (0.01 + T * 100.0 * rate)
    moving = ran(bodies(masses=(0.01, 0.01), start=(0, 0), rates=(1.0, 0), forces=drag), 5, dtype=dtype)
    np.testing.assert_allclose(moving[:, 0], expected, rtol=1e-6 if dtype == "float32" else 1e-13)


@pytest.mark.parametrize("zeta", [0.2, 1.0])
def test_the_margin_of_a_program_knows_the_damping_is_implicit(zeta):
    """2 (sqrt(1 + zeta^2) + zeta)/(omega h), omega h = 0.5; equal and opposite as the equation may be written."""
    m, K = 0.05, 0.05 * 500.0**2
    mass, k, b = hl.parameters("m K b", units="kg N/m N*s/m", values=(m, K, 2 * zeta * np.sqrt(K * m)))
    z = hl.coordinate("z", unit="m")
    pull = k * (hl.x(t) - z)
    for eom in (sp.Eq(mass * z.diff(t, 2), pull - b * z.diff(t)), sp.Eq(pull - b * z.diff(t), mass * z.diff(t, 2))):
        program = hl.compile(hl.Scene(force=pull, eom=[eom]), METHOD, T=T)
        assert program.facts["margin"] == pytest.approx(4 * (np.sqrt(1 + zeta**2) + zeta), rel=5e-3)  # three digits
