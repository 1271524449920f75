"""The classical problems of mechanics with known solutions, at the accuracy that each method promises."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipj, ellipk

import hapticlab as hl
from hapticlab import t
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.methods.method_table import METHODS

s, m, kg = hl.parameters("s m kg", units="s m kg", values=(1.0, 1.0, 1.0))  # equations without units get them from these
k = hl.parameters("k", units="N/m", values=1.0)
q = hl.coordinate("q", unit="m", initial="1 m")

SMOOTH = [*sorted(set(METHODS) - {"euler", "semi_implicit_euler_damped", "adams_bashforth2"}), "taylor"]
#: a period short enough for a method to be on its order, and long enough to be off rounding
PERIOD = {
    "semi_implicit_euler": 2e-3,
    "verlet": 1e-2,
    "heun": 5e-3,
    "midpoint": 5e-3,
    "ssprk3": 1e-2,
    "adams_bashforth3": 5e-3,
}


def run(equations, watch, duration, method, T, **options):
    """Return times and the watched expressions, one row each. The handle rests at 0 and feels nothing."""
    scene = hl.Scene(force=0 * k * q, eom=equations, watch={f"watched{i}": expr for i, expr in enumerate(watch)})
    ticks = round(duration / T) + 1
    program = hl.compile(scene, method, T=T, dtype="float64", **options)
    out = load(program).run(ticks, np.zeros((ticks, len(program.inputs)))).outputs[:, :, 0].T
    assert program.outputs[-1].name != "unlocated" or not out[-1].any()
    return np.arange(ticks) * T, out[1 : 1 + len(watch)]


def keeps_its_promise(equations, watch, exact, duration, method, rounding, T=2e-2, **options):
    """Measure the order between T and T/2, which is the claim to 0.1; a Taylor series is exact to ``rounding``."""

    def error(period):
        times, found = run(equations, watch, duration, method, period, **options)
        return np.abs(found - exact(times)).max()

    T = PERIOD.get(method, T)
    if method == "taylor":
        assert error(T) < rounding
        return
    coarse, fine = error(T), error(T / 2)
    assert math.log2(coarse / fine) == pytest.approx(METHODS[method].order, abs=0.1)
    assert 100 * rounding < fine < 0.05


@pytest.mark.parametrize("method", SMOOTH)
@pytest.mark.always("rk4")
def test_a_pendulum_swings_by_elliptic_functions(method):
    """From rest at 2.5 rad: sin(theta/2) = k cd(t, k) with k = sin(1.25); a quarter of its period is K(k)."""
    theta, modulus = hl.coordinate("theta", unit="rad", initial=2.5), math.sin(1.25) ** 2

    def exact(times):
        _, cn, dn, _ = ellipj(times, modulus)
        return 2 * np.arcsin(math.sin(1.25) * cn / dn)

    assert exact(ellipk(modulus)) == pytest.approx(0, abs=1e-14)
    keeps_its_promise([sp.Eq(s**2 * theta.diff(t, 2), -sp.sin(theta))], [theta], exact, 4.0, method, 1e-13)


@pytest.mark.parametrize("method", SMOOTH)
@pytest.mark.always("rk4")
def test_duffings_spring_swings_by_elliptic_functions(method):
    """q'' = -q - 3 q^3 from rest at 1 is cn(2 t) of parameter 3/8."""
    equation = sp.Eq(s**2 * q.diff(t, 2), -q - 3 * q**3 / m**2)
    keeps_its_promise([equation], [q], lambda times: ellipj(2 * times, 3 / 8)[1], 3.0, method, 1e-13)


@pytest.mark.parametrize("method", ["verlet", "ssprk3", "rk4", "nystrom4", "taylor"])
@pytest.mark.always("verlet", "taylor")
def test_a_planet_moves_as_kepler_says(method):
    """Eccentricity 0.4, from the point next to the sun: E - e sin E = t, by Newton; once around and a little on."""
    e = 0.4
    X = hl.coordinate("X", unit="m", initial=f"{1 - e} m")
    Y = hl.coordinate("Y", unit="m", rate=f"{math.sqrt((1 + e) / (1 - e))} m/s")
    r3 = (X**2 + Y**2) ** sp.Rational(3, 2) / m**3

    def exact(times):
        E = times.copy()
        for _ in range(60):
            E -= (E - e * np.sin(E) - times) / (1 - e * np.cos(E))
        return np.array([np.cos(E) - e, math.sqrt(1 - e**2) * np.sin(E)])

    equations = [sp.Eq(s**2 * X.diff(t, 2), -X / r3), sp.Eq(s**2 * Y.diff(t, 2), -Y / r3)]
    keeps_its_promise(equations, [X, Y], exact, 7.0, method, 1e-11, T=1e-2)


@pytest.mark.parametrize("method", ["heun", "ssprk3", "adams_bashforth3", "rk4", "taylor"])
@pytest.mark.always("rk4", "taylor")
def test_a_free_rigid_body_turns_by_elliptic_functions(method):
    """Euler's equations of a body 1 : 2 : 3 kg m^2; w = (cn, sn, dn) of parameter m, Landau and Lifshitz 37.10."""
    w = [hl.coordinate(f"w{i}", unit="1/s", initial=value) for i, value in ((1, 1.0), (2, 0.0), (3, 1.2))]
    I = (1.0, 2.0, 3.0)
    equations = [sp.Eq(s * w[i].diff(t), s * (I[j] - I[l]) / I[i] * w[j] * w[l]) for i, j, l in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    E2, M2 = (
        sum(a * b**2 for a, b in zip(I, (1.0, 0.0, 1.2), strict=True)),
        sum((a * b) ** 2 for a, b in zip(I, (1, 0, 1.2), strict=True)),
    )
    rate = math.sqrt((I[2] - I[1]) * (M2 - E2 * I[0]) / np.prod(I))
    parameter = (I[1] - I[0]) * (E2 * I[2] - M2) / ((I[2] - I[1]) * (M2 - E2 * I[0]))
    assert 0 < parameter < 1

    def exact(times):
        sn, cn, dn, _ = ellipj(rate * times, parameter)
        swing = math.sqrt((E2 * I[2] - M2) / (I[1] * (I[2] - I[1])))
        return np.array([1.0 * cn, swing * sn, 1.2 * dn])

    keeps_its_promise(equations, w, exact, 6.0, method, 1e-13)


def van_der_pol(times, solver="DOP853", tolerance=3e-14):
    """Return q of q'' = 3 (1 - q^2) q' - q from rest at 1, by a solver of scipy."""

    def rates(_, y):
        return [y[1], 3 * (1 - y[0] ** 2) * y[1] - y[0]]

    return solve_ivp(rates, (0, times[-1]), [1.0, 0.0], solver, t_eval=times, rtol=tolerance, atol=1e-13).y[0]


def test_two_solvers_agree_on_van_der_pols_oscillator():
    times = np.linspace(0, 4, 9)
    np.testing.assert_allclose(van_der_pol(times, "Radau", 1e-10), van_der_pol(times), rtol=0, atol=1e-8)


@pytest.mark.parametrize("method", ["semi_implicit_euler", "verlet", "heun", "ssprk3", "rk4", "taylor"])
@pytest.mark.always("verlet")
def test_van_der_pols_oscillator_follows_another_solver(method):
    """Its damping and the opposite of it take turns; a velocity-dependent force takes no order away."""
    equation = sp.Eq(s**2 * q.diff(t, 2), 3 * s * (1 - q**2 / m**2) * q.diff(t) - q)
    T = {"semi_implicit_euler": 5e-4, "verlet": 2e-3, "heun": 2e-3}.get(method, 1e-2)
    errors = []
    for period in (T,) if method == "taylor" else (T, T / 2):
        times, found = run([equation], [q], 4.0, method, period)
        errors.append(np.abs(found - van_der_pol(times)).max())
    if method == "taylor":
        assert errors[0] < 1e-11
    else:
        assert math.log2(errors[0] / errors[1]) == pytest.approx(METHODS[method].order, abs=0.1)


def impacts(e, wall, F, w, until):
    """Return the pieces (begin, c, d) of q'' = -q + F cos(w t) at a wall, from the closed form and root finding."""
    a = F / (1 - w**2)

    def at(piece, when):
        begin, c, d = piece
        tau = when - begin
        return (
            c * np.cos(tau) + d * np.sin(tau) + a * np.cos(w * when),
            -c * np.sin(tau) + d * np.cos(tau) - a * w * np.sin(w * when),
        )

    piece, pieces, when = (0.0, 0.0 - a, 0.0), [], 0.0
    while when < until:
        pieces.append(piece)
        grid = when + 1e-6 + np.arange(0, until - when + 1, 1e-3)
        beyond = at(piece, grid)[0] - wall > 0
        if not beyond.any():
            break
        first = int(np.argmax(beyond))
        when = brentq(lambda moment, p=piece: at(p, moment)[0] - wall, grid[first] - 1e-3, grid[first], xtol=1e-15, rtol=1e-15)
        speed = -e * at(piece, when)[1]
        piece = (when, wall - a * math.cos(w * when), speed + a * w * math.sin(w * when))
    return pieces, at


def test_an_impact_oscillator_bounces_where_the_closed_form_does():
    """A driven spring and mass before a wall, e = 0.7: the pieces between impacts are known, their ends roots."""
    e, wall, F, w, until, T = 0.7, 0.2, 1.0, 2.3, 20.0, 1e-2
    X = hl.coordinate("X", unit="m")
    stop = hl.contact.Contact(sp.Float(wall) * m - X, hl.contact.impulse(e=e), name="stop")
    L = kg * X.diff(t) ** 2 / 2 - k * X**2 / 2
    push = hl.parameters("push", units="N", values=F)
    body = hl.mechanics.lagrange(L, forces={X: push * sp.cos(w * t / s)}, contacts=[stop])
    times, (found,) = run([body], [X], until, "taylor", T)
    pieces, at = impacts(e, wall, F, w, until)
    assert len(pieces) > 5
    begins = np.array([begin for begin, *_ in pieces])
    exact = [at(pieces[int(np.searchsorted(begins, when, side="right")) - 1], when)[0] for when in times]
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-11)


@pytest.mark.parametrize("start, halves", [(0.95, 5), (0.35, 2)])
@pytest.mark.always("0.35-2")
def test_dry_friction_stops_a_spring_in_whole_half_swings(start, halves):
    """F_c = k * 0.1 m: every half swing ends 0.2 m nearer, and the first that ends within 0.1 m ends for ever."""
    X = hl.coordinate("X", unit="m", initial=f"{start} m")
    rub = hl.contact.friction(slip=X.diff(t), coulomb="0.1 N")
    body = hl.mechanics.lagrange(kg * X.diff(t) ** 2 / 2 - k * X**2 / 2, contacts=[rub])
    times, (found, speed) = run([body], [X, X.diff(t)], math.pi * (halves + 1), "taylor", 1e-2)
    half = np.floor(times / math.pi)
    centre, swing = 0.1 * (-1) ** half, (-1) ** half * (start - 0.2 * half - 0.1)
    rest = (-1) ** halves * (start - 0.2 * halves)
    exact = np.where(half < halves, centre + swing * np.cos(times - math.pi * half), rest)
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-12)
    assert abs(rest) <= 0.1 and not speed[half >= halves][1:].any()
