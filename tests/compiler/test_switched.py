"""``method="exact"`` of what is linear between switches, against forty digits, the exponential, and the located series."""

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from sampled import motion
from scipy.linalg import expm

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engine import load
from hapticlab.compiler.llvm_emit import emit
from hapticlab.compiler.strays import strays
from hapticlab.errors import ProgramError, ProgramLimitError

T = 1e-3
z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
K, b, m, k, x_o, B = hl.parameters("K b m k x_o B", units="N/m N*s/m kg N/m m N*s/m", values=(500, 1, 0.05, 2e3, 0.01, 1))
FREE = K * (x(t) - z) + b * (v(t) - z.diff(t))
FELT = K * (x(n) - z) + b * (v(n) - z.diff(t))
WALL = hl.when(z >= x_o, k * (z - x_o) + B * z.diff(t), 0)
SWING = 0.015 * np.sin(2 * np.pi * 3.1 * np.arange(300) * T)


def slow(*case):
    return pytest.param(*case, marks=pytest.mark.slow)


def wall(**values):
    """Return a mass on a coupler that meets a wall with a damper."""
    return hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), FREE - WALL)], watch=[z])(**values)


def compiled(scene, method="exact", **options):
    return hl.compile(scene, method, **{"T": T, "dtype": "float64", "live": ()} | options)


def run(program, handle):
    """Return the outputs at the samples, every switch located."""
    outputs = load(program).run(len(handle), np.reshape(handle, (len(handle), -1))).outputs[:, :, 0]
    assert not outputs[:, -1].any()
    return outputs[:, :-1]


def velocities(handle):
    return np.array([0, *map(mp.mpf, np.diff(handle))]) / mp.mpf(T)


@pytest.mark.parametrize(("stiffness", "switches"), [(2e3, 6), slow(1e5, 10), slow(1e6, 10), (1e7, 10)])
def test_force_of_a_wall_is_exact_at_any_stiffness(stiffness, switches):
    """A part in 1e12 of the largest force: rounding of the crossing times the rates of the stiffest wall."""
    free = [500 / 0.05, 1 / 0.05, 500 / 0.05, 1 / 0.05, 0.0]
    touching = [(500 + stiffness) / 0.05, 2 / 0.05, 500 / 0.05, 1 / 0.05, stiffness * 0.01 / 0.05]
    states, found = motion(SWING, T, {False: free, True: touching}, (1, 0, -0.01), (0, 0))
    force = 500 * (SWING - states[:, 0]) + (velocities(SWING) - states[:, 1])
    force = force.astype(float)
    seen = run(compiled(wall(k=stiffness)), SWING)
    np.testing.assert_allclose(seen[:, 0], force, rtol=0, atol=1e-12 * abs(force).max())
    assert found == switches


@pytest.mark.parametrize(("stiffness", "switches"), [(1e4, 6), slow(1e7, 6)])
def test_a_bouncing_ball_is_exact_where_a_contact_is_shorter_than_a_period(stiffness, switches):
    start = hl.coordinate("z", unit="m", initial=hl.parameters("h", units="m", values=0.02))
    g = hl.parameters("g", units="m/s^2", values=9.81)

    def push(x, v):
        return hl.when(start <= x, k * (x - start) + B * (v - start.diff(t)), 0)

    ball = hl.Scene(push(x(n), v(n)), [sp.Eq(m * start.diff(t, 2), push(x(t), v(t)) - m * g)], watch=[start])
    handle = 0.002 * np.sin(2 * np.pi * 1.3 * np.arange(400) * T)
    touching = [stiffness / 0.05, 1 / 0.05, stiffness / 0.05, 1 / 0.05, -9.81]
    states, found = motion(handle, T, {False: [0, 0, 0, 0, -9.81], True: touching}, (-1, 1, 0), (0.02, 0))
    depth, rate = handle - states[:, 0], velocities(handle) - states[:, 1]
    force = np.where(depth >= 0, stiffness * depth + rate, 0).astype(float)
    seen = run(compiled(ball(k=stiffness)), handle)
    # a sample inside a contact of 0.2 ms: force is stiffness times depth, and both positions are rounded at 20 mm
    np.testing.assert_allclose(seen[:, 0], force, rtol=0, atol=1e-12 * abs(force).max() + 1e-15 * stiffness)
    assert found == switches


def test_bound_holds_between_all_places_and_is_nearly_reached():
    """Of a chain that swings, one that is stiff and damped, and one that grows: the exponential of scipy at 600 places."""
    seeded = np.random.default_rng(5)
    for stiffness, damping in ((1e3, 1.0), (1e7, 300.0), (-1e4, 5.0)):
        A = np.zeros((5, 5))
        coupled = seeded.uniform(-0.3, 0.3, (2, 4)) * [stiffness, stiffness, damping, damping]
        A[:2, 2:4], A[2:4, :4], A[4] = np.eye(2), coupled, 3.0
        A[2:4] -= np.hstack([stiffness * np.eye(2), damping * np.eye(2), np.zeros((2, 1))])
        c, omega = np.array([1.0, -0.4, 1e-3, 0.0, 0.2]), max(1e3, np.sqrt(abs(stiffness)))
        bound = strays(A, c, T, 1, np.array([1, 1, omega, omega, 1.0]))
        H = np.zeros((15, 15))
        H[:5], H[5:10, 10:] = np.hstack([A, np.eye(5), np.zeros((5, 5))]), np.eye(5)
        rows = np.array([c @ expm(H * tau)[:5] for tau in np.linspace(0, T, 600)])
        apart = abs(rows - rows[0] - np.linspace(0, 1, 600)[:, None] * (rows[-1] - rows[0])).max(axis=0)[5:].reshape(2, 5)
        assert (apart <= bound).all()
        np.testing.assert_allclose(apart, bound, rtol=0.02)


def springs():
    """Return two masses in a row between three walls, one of them with a damper: eight modes."""
    one, two, low, high = hl.parameters("one two low high", units="N/m N/m m m", values=(3e3, 2e4, -0.006, 0.012))
    link = one * (y - z)
    stops = WALL - hl.when(z <= low, one * (low - z), 0)
    rows = [sp.Eq(m * y.diff(t, 2), FREE.xreplace({z: y}) - link - hl.when(y >= high, two * (y - high), 0)),
            sp.Eq(m * z.diff(t, 2), link - stops)]  # fmt: skip
    return hl.Scene(FELT.xreplace({z: y}), rows, watch=[z])


def walls(count):
    """Return the forces of springs in a row, each met a millimetre after the other."""
    return [hl.when(z > j * x_o / 10, k * (z - j * x_o / 10), 0) for j in range(1, 1 + count)]


def test_walls_in_a_row_take_a_map_more_than_there_are_walls():
    program = compiled(hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), FREE - sum(walls(5)))], watch=[z]))
    assert program.facts["maps"] == 6
    emit(program)  # no arm waits for a choice that is known only in another


@pytest.mark.slow
def test_of_more_modes_than_maps_the_others_are_located():
    """Walls on three coordinates, three on each: 64 modes, of which 16 have a map."""
    u = hl.coordinate("u", unit="m")
    rows = [sp.Eq(m * q.diff(t, 2), (FREE - sum(walls(3))).xreplace({z: q})) for q in (z, y, u)]
    scene = hl.Scene(FELT + K * (u - y), rows, watch=[u])
    exact, series = (compiled(scene, method) for method in ("exact", "taylor"))
    assert exact.facts["maps"] == 16
    np.testing.assert_allclose(run(exact, SWING), run(series, SWING), rtol=0, atol=2e-13)


def rubbed():
    """Return a block that sticks and slides (Coulomb), drawn by the handle through a spring."""
    F_c = hl.parameters("F_c", units="N", values=0.5)
    return hl.Scene(K * (x(n) - z), [sp.Eq(m * z.diff(t, 2), K * (x(t) - z) - F_c * sp.sign(z.diff(t)) - b * z.diff(t))])


def struck():
    """Return a ball that bounces to rest on a floor that does not give."""
    u, g = hl.coordinate("u", unit="m", initial=x(n)), hl.parameters("g", units="m/s^2", values=9.81)
    floor = hl.Contact(u + 0.5 * x_o, hl.impulse(e=0.6, rest_speed=0.02), name="floor")
    model = hl.lagrange(m * u.diff(t) ** 2 / 2 - m * g * u, forces={u: K * (x(t) - u)}, contacts=[floor])
    return hl.Scene(K * (x(n) - u), [model])


@pytest.mark.parametrize(
    ("scene", "hold"), [slow(springs, "zoh"), slow(springs, "soh"), (rubbed, "soh"), slow(rubbed, "foh"), (struck, "soh")]
)
def test_it_is_the_series_with_its_events_located(scene, hold):
    handle = SWING + 0.004 * np.sin(2 * np.pi * 11.7 * np.arange(300) * T)
    exact, series = (
        run(compiled(scene(), method, hold=hold), handle) for method in ("exact", hl.Taylor(events=2))
    )
    assert abs(series[:, 0]).max() > 1.0
    np.testing.assert_allclose(exact, series, rtol=0, atol=2e-13 * abs(series).max())


def test_float32_rounds_and_no_more():
    seen, exact = (run(compiled(wall(), dtype=dtype), SWING) for dtype in ("float32", "float64"))
    np.testing.assert_allclose(seen[:, 0], exact[:, 0], rtol=0, atol=5e-6 * abs(exact[:, 0]).max())


def test_a_stiff_wall_takes_pieces_of_a_radian_and_says_so():
    program = compiled(wall(k=1e7))
    assert program.facts["pieces"] == 15 + 2 + 9 and program.facts["maps"] == 2  # of 14.1 rad, two events and two each half turn
    assert any("a constant map for each of 2 modes" in note for note in program.notes)


@pytest.mark.parametrize(
    ("eom", "live", "said"),
    [
        (FREE - WALL, ("k",), r"makes constants of each mode, and k may be set .* without k"),
        (FREE - WALL - hl.when(z > x_o, k * z**2 / x_o, 0), (), r"is not linear: it jumps with .* use 'rk4'"),
        (FREE - sum(walls(13)), (), "at most 12 surfaces .* there are 13"),
        (FREE - hl.when(z >= x_o, k * (z - x_o) * x(n) / x_o, 0), (), "is not linear"),
    ],
)
def test_it_refuses_what_is_not_linear_or_not_constant_in_a_mode(eom, live, said):
    with pytest.raises(ProgramError, match=said):
        compiled(hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), eom)]), live=live)


def test_it_refuses_what_is_too_stiff_to_follow():
    with pytest.raises(ProgramLimitError, match=r"turns with omega = 1.414e\+05 rad/s, by 141.4 rad .* take T <= 0.00023 s"):
        compiled(wall(k=1e9))


def test_a_place_may_be_live_where_a_slope_may_not():
    moved = load(compiled(wall(), live="x_o")).run(300, SWING[:, None], [0.012]).outputs[:, 0, 0]
    np.testing.assert_allclose(moved, run(compiled(wall(x_o=0.012)), SWING)[:, 0], rtol=0, atol=1e-13)
