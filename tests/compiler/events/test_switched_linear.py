"""``method="exact"`` of what is linear between switches, against forty digits and the exponential."""

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from sampled import followed, motion
from scipy.linalg import expm

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.llvm_emit import emit
from hapticlab.compiler.events.chord_bound import strays
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


def run(program, handle, engine="auto"):
    """Return the outputs at the samples, every switch located."""
    outputs = load(program, engine).run(len(handle), np.reshape(handle, (len(handle), -1))).outputs[:, :, 0]
    assert not outputs[:, -1].any()
    return outputs[:, :-1]


def velocities(handle):
    return np.array([0, *map(mp.mpf, np.diff(handle))]) / mp.mpf(T)


@pytest.mark.wide
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
    """Of a chain that swings, one that is stiff and damped, and one that grows: the exponential of scipy at 200 places."""
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
        rows = np.array([c @ expm(H * tau)[:5] for tau in np.linspace(0, T, 200)])
        apart = abs(rows - rows[0] - np.linspace(0, 1, 200)[:, None] * (rows[-1] - rows[0])).max(axis=0)[5:].reshape(2, 5)
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


@pytest.mark.wide
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


def row(size, **entries):
    """Return a row of Y = [y, x, x', x'', 1], by place: y0, y1, ..., x, v, one."""
    places = {"x": size, "v": size + 1, "one": size + 3} | {f"y{k}": k for k in range(size)}
    found = np.zeros(size + 4)
    for name, value in entries.items():
        found[places[name]] = value
    return found


def of_springs():
    """Return what :func:`~sampled.followed` needs of ``springs``: y = [y, z, y', z'], a mode the walls that are touched."""
    surfaces = np.array([row(4, y0=1, one=-0.012), row(4, y1=1, one=-0.01), row(4, y1=-1, one=-0.006)])
    alone = row(4, x=500, y0=-3500, y1=3e3, v=1, y2=-1), row(4, y0=3e3, y1=-3e3)
    pushes = (row(4, y0=-2e4, one=240), 0), (0, row(4, y1=-2e3, one=20, y3=-1)), (0, row(4, y1=-3e3, one=-18))

    def rates(touched):
        forces = [alone[k] + sum(push[k] for push, on in zip(pushes, touched, strict=True) if on) for k in (0, 1)]
        return np.array([row(4, y2=1), row(4, y3=1), *(force / 0.05 for force in forces)])

    def rows(touched):
        return surfaces * np.where(touched, 1, -1)[:, None]

    def after(touched, Y, k):
        return tuple(on ^ (j == k) for j, on in enumerate(touched)), Y[:4]

    return np.zeros(4), rates, rows, lambda Y, _: tuple(surfaces @ Y >= 0), after


def rubbed():
    """Return a block that sticks and slides (Coulomb), drawn by the handle through a spring."""
    F_c = hl.parameters("F_c", units="N", values=0.5)
    return hl.Scene(K * (x(n) - z), [sp.Eq(m * z.diff(t, 2), K * (x(t) - z) - F_c * sp.sign(z.diff(t)) - b * z.diff(t))])


def of_rubbed():
    """Return what :func:`~sampled.followed` needs of ``rubbed``: y = [z, z'], a mode the sign of the slip, 0 sticks."""
    drawn = row(2, x=500, y0=-500)

    def rates(slip):
        return np.array([row(2, y1=1), (drawn + row(2, y1=-1, one=-0.5 * slip)) / 0.05]) if slip else np.zeros((2, 6))

    def rows(slip):
        return np.array([row(2, y1=slip)] if slip else [row(2, one=0.5) - drawn, row(2, one=0.5) + drawn])

    def still(Y):
        return 0 if abs(drawn @ Y) <= 0.5 else int(np.sign(drawn @ Y))

    def after(slip, Y, k):
        return (still(Y) if slip else 1 - 2 * k), np.array([Y[0], 0.0])

    return np.zeros(2), rates, rows, lambda Y, slip: slip or still(Y), after


def struck():
    """Return a ball that bounces to rest on a floor that does not give."""
    u, g = hl.coordinate("u", unit="m", initial=x(n)), hl.parameters("g", units="m/s^2", values=9.81)
    floor = hl.contact.Contact(u + 0.5 * x_o, hl.contact.impulse(e=0.6, rest_speed=0.02), name="floor")
    model = hl.mechanics.lagrange(m * u.diff(t) ** 2 / 2 - m * g * u, forces={u: K * (x(t) - u)}, contacts=[floor])
    return hl.Scene(K * (x(n) - u), [model])


def of_struck():
    """Return what :func:`~sampled.followed` needs of ``struck``: y = [u, u'], a mode whether it rests."""
    lifted = row(2, x=500, y0=-500, one=-0.05 * 9.81)

    def rates(rests):
        return np.zeros((2, 6)) if rests else np.array([row(2, y1=1), lifted / 0.05])

    def rows(rests):
        return np.array([-lifted if rests else row(2, y0=1, one=0.005)])

    def after(rests, Y, _):
        # at rest after it: as slow as was asked for, or back within the period
        flies = rests or -0.6 * Y[1] > max(0.02, -(lifted @ Y) / 0.05 * T / 2)
        return not flies, np.array([Y[0], -0.6 * Y[1] if flies else 0.0])

    return np.zeros(2), rates, rows, lambda Y, rests: bool(rests and lifted @ Y <= 0), after


def every_hold(scene, known, felt, quick):
    return [(scene, known, felt, hold) if hold == quick else slow(scene, known, felt, hold) for hold in ("zoh", "foh", "soh")]


@pytest.mark.parametrize(
    ("scene", "known", "felt", "hold"),
    [
        *every_hold(springs, of_springs, (500, 1), "zoh"),
        *every_hold(rubbed, of_rubbed, (500, 0), "foh"),
        *every_hold(struck, of_struck, (500, 0), "soh"),
    ],
)
@pytest.mark.always("struck-*")
def test_it_is_what_exponentials_and_bracketed_roots_give(scene, known, felt, hold):
    """Several walls and two masses, friction, impacts: with nothing of the package; a part in 1e12 is rounding of both."""
    handle = SWING + 0.004 * np.sin(2 * np.pi * 11.7 * np.arange(300) * T)
    start, *rest = known()
    states, switches = followed(handle, T, hold, start, *rest)
    rate = np.diff(handle, prepend=handle[0]) / T
    force = felt[0] * (handle - states[:, 0]) + felt[1] * (rate - states[:, len(start) // 2])
    seen = run(compiled(scene(), hold=hold), handle)
    assert switches >= 7 and abs(force).max() > 1.0
    np.testing.assert_allclose(seen[:, 0], force, rtol=0, atol=1e-12 * abs(force).max())


@pytest.mark.parametrize("returned", [2e4, slow(500.0)])
@pytest.mark.wide
def test_cases_inside_of_cases_are_as_linear_as_cases_in_a_row(returned):
    """A spring that is another on the way back. Softer, it sticks where it turns, which only the nested form tells."""
    stiff, back = hl.parameters("stiff back", units="N/m N/m", values=(1e4, returned))
    out = sp.Piecewise((stiff * (z - x_o), z.diff(t) >= 0), (back * (z - x_o), True))
    nested, row = sp.Piecewise((out, z >= x_o), (0, True)), sp.Piecewise(
        (stiff * (z - x_o), (z >= x_o) & (z.diff(t) >= 0)), (back * (z - x_o), z >= x_o), (0, True)
    )  # fmt: skip
    scenes = [hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), FREE - push)]) for push in (nested, row)]
    push_and_return = 0.015 * np.sin(2 * np.pi * 12 * np.arange(45) * T)
    exact = run(compiled(scenes[0]), push_and_return, "interpreter")
    other = compiled(scenes[1]) if returned > 1e4 else compiled(scenes[0], "taylor")
    np.testing.assert_allclose(exact, run(other, push_and_return, "interpreter"), rtol=0, atol=1e-13 * abs(exact).max())


def test_float32_rounds_and_no_more():
    seen, exact = (run(compiled(wall(), dtype=dtype), SWING) for dtype in ("float32", "float64"))
    np.testing.assert_allclose(seen[:, 0], exact[:, 0], rtol=0, atol=5e-6 * abs(exact[:, 0]).max())


@pytest.mark.wide
def test_a_stiff_wall_takes_pieces_of_a_radian_and_says_so():
    program = compiled(wall(k=1e7))
    assert program.facts["pieces"] == 15 + 2 + 9 and program.facts["maps"] == 2  # of 14.1 rad, two events and two each half turn
    assert any("a constant map for each of 2 modes" in note for note in program.notes)


@pytest.mark.parametrize(
    ("eom", "live", "said"),
    [
        (FREE - WALL, ("k",), r"the constants of each mode in advance, but k is live\. .* without k"),
        (FREE - WALL - hl.when(z > x_o, k * z**2 / x_o, 0), (), r"is not linear: it jumps with .* Use 'taylor',"),
        (FREE - sum(walls(13)), (), "at most 12 surfaces .* there are 13"),
        (FREE - hl.when(z >= x_o, k * (z - x_o) * x(n) / x_o, 0), (), "is not linear"),
    ],
)
def test_it_refuses_what_is_not_linear_or_not_constant_in_a_mode(eom, live, said):
    with pytest.raises(ProgramError, match=said):
        compiled(hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), eom)]), live=live)


def test_it_refuses_what_is_too_stiff_to_follow():
    with pytest.raises(ProgramLimitError, match=r"turns with omega = 1.414e\+05 rad/s, by 141.4 rad .* Use T <= 0.00023 s,"):
        compiled(wall(k=1e9))


def test_it_refuses_more_surfaces_than_it_can_follow_before_it_follows_them():
    many = hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), FREE - sum(walls(12)))], watch=[z])(k=1e6)
    said = r"method='exact' .* 12 surfaces .* in 28 pieces .* Use T <= 0.00025 s, 3 surfaces at most or a softer contact"
    with pytest.raises(ProgramLimitError, match=said):
        compiled(many)


@pytest.mark.slow
def test_what_it_proposes_instead_of_too_many_surfaces_compiles_and_says_that_it_is_large():
    many, few = (hl.Scene(FELT, [sp.Eq(m * z.diff(t, 2), FREE - sum(walls(count)))])(k=1e6) for count in (12, 3))
    program = compiled(many, T=0.00025)
    assert f"{len(program)} instructions per tick are" in program.notes[-1] and len(compiled(few)) < 2e5


@pytest.mark.wide
def test_a_place_may_be_live_where_a_slope_may_not():
    moved = load(compiled(wall(), live="x_o")).run(300, SWING[:, None], [0.012]).outputs[:, 0, 0]
    np.testing.assert_allclose(moved, run(compiled(wall(x_o=0.012)), SWING)[:, 0], rtol=0, atol=1e-13)
