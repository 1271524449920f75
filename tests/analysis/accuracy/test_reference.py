"""References against closed forms and against scipy on equations written by hand."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.accuracy.handle_motions import HandleMotion, handle_motions
from hapticlab.analysis.accuracy.reference import Reference, reference, references
from hapticlab.errors import AnalysisError

OMEGA, A = 13.7, 0.012
SINE = HandleMotion("sine", A * sp.sin(OMEGA * t), 0.7)
STILL = HandleMotion("still", sp.Float(0.0), 1.0)


def mass_on_a_coupler():
    """Return the scene m z'' = K (x - z) + b (x' - z'), F the coupler's force."""
    z = hl.coordinate("z", unit="m")
    m, K, b = hl.parameters("m K b", units="kg N/m N*s/m", values=(0.08, 310, 0.6))
    F = hl.laws.virtual_coupler(z, K=K, b=b)
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="mass on a coupler")


def test_a_mass_on_a_coupler_under_a_sine_is_the_steady_response_and_a_transient():
    found = reference(mass_on_a_coupler(), SINE)
    m, K, b = 0.08, 310.0, 0.6
    Z = A * (K + 1j * b * OMEGA) / (K - m * OMEGA**2 + 1j * b * OMEGA)  # z = Im(Z e^(j w t)) + transient
    p = (-b + np.sqrt(complex(b**2 - 4 * m * K))) / (2 * m)
    z0, w0 = -Z.imag, -(1j * OMEGA * Z).imag  # the transient starts from z = z' = 0
    # c e^(p t) + conjugate: 2 Re c = z0, 2 Re(p c) = w0
    c = z0 / 2 + 1j * (p.real * z0 / 2 - w0 / 2) / p.imag
    T = found.t
    z = (Z * np.exp(1j * OMEGA * T)).imag + 2 * (c * np.exp(p * T)).real
    w = (1j * OMEGA * Z * np.exp(1j * OMEGA * T)).imag + 2 * (c * p * np.exp(p * T)).real
    F = K * (A * np.sin(OMEGA * T) - z) + b * (A * OMEGA * np.cos(OMEGA * T) - w)
    assert np.abs(found.F - F).max() < 1e-12 * found.peak  # a linear series is the exponential to rounding
    assert found.certified and found.agreement < 1e-8 * found.peak  # rtol = 1e-10 of the second solver


def test_a_wall_is_its_own_reference():
    k, x_o = hl.parameters("k x_o", units="N/m m", values=(420, 0.004))
    found = reference(hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o))), SINE)
    expected = 420 * np.maximum(A * np.sin(OMEGA * found.t) - 0.004, 0)
    assert np.abs(found.F - expected).max() < 1e-14
    assert found.certified and "handle alone" in found.how


@pytest.mark.parametrize("law", ["zoh", "half_sample", "backward_difference", "ellis"])
def test_the_walls_of_the_chapter_have_one_limit(law):
    found = reference(hl.wall(law)(k=420, B=1.3, x_o=0.004), SINE)
    position, velocity = A * np.sin(OMEGA * found.t), A * OMEGA * np.cos(OMEGA * found.t)
    expected = np.where(position >= 0.004, 420 * (position - 0.004) + 1.3 * velocity, 0.0)
    assert np.abs(found.F - expected).max() < 1e-13


def test_a_clipped_wall_has_the_same_limit_to_what_a_difference_keeps():
    found = reference(hl.wall(unilateral="clip")(k=420, B=1.3, x_o=0.004), SINE)
    position, velocity = A * np.sin(OMEGA * found.t), A * OMEGA * np.cos(OMEGA * found.t)
    expected = np.where(position >= 0.004, 420 * (position - 0.004) + 1.3 * velocity, 0.0)
    # at the edge the difference sees a part of a step, elsewhere 1e-17 m / 1e-8 s times B
    assert np.abs(found.F - expected).max() < 1e-8


def test_a_filter_of_the_force_has_the_force_as_its_limit():
    plain = hl.wall(unilateral=None)(k=200)
    assert np.array_equal(reference(hl.laws.force_filter(plain), SINE).F, 200 * SINE.at(reference(plain, SINE).t)[0])


@pytest.mark.parametrize("clock", [hl.t, hl.n * hl.T])
def test_a_force_that_time_drives_is_the_sine_it_is(clock):
    A, w, k = hl.parameters("A w k", units="N rad/s N/m", values=(1.0, 50.0, 200.0))
    motion = handle_motions()[1]
    found = reference(hl.Scene(force=k * x(n) + A * sp.sin(w * clock)), motion)
    true = 200 * motion.at(found.t)[0] + np.sin(50 * found.t)
    assert found.certified and np.abs(found.F - true).max() < 1e-12


def test_a_signal_has_no_reference():
    y, k = hl.signal("y", unit="m"), hl.parameters("k", units="N/m", values=200)
    scene = hl.Scene(force=k * y(n), eom=[sp.Eq(y(n), (y(n - 1) + x(n)) / 2)])
    with pytest.raises(AnalysisError, match="sequence of samples"):
        reference(scene, SINE)


def seen(q, k=100.0):
    """Return the force k q of a spring that only looks, so that a motion can be read off the force."""
    return hl.parameters("k_seen", units="N/m", values=k) * q


def test_a_ball_bounces_as_the_closed_form_says():
    e, g, h = 0.7, 9.81, 0.05
    y = hl.coordinate("y", unit="m", initial=h)
    m, e_, g_ = hl.parameters("m e g", units="kg 1 m/s^2", values=(0.03, e, g), ranges=[None, (0, 1), None])
    bounces = hl.mechanics.lagrange(
        m * y.diff(t) ** 2 / 2 - m * g_ * y, contacts=[hl.contact.Contact(y, hl.contact.impulse(e=e_))]
    )
    found = reference(hl.Scene(force=seen(y), eom=[bounces]), STILL)
    t_hit, speed, expected = np.sqrt(2 * h / g), np.sqrt(2 * g * h), h - g * found.t**2 / 2
    for _ in range(12):
        speed *= e
        since = found.t - t_hit
        expected = np.where(since >= 0, speed * since - g * since**2 / 2, expected)
        t_hit += 2 * speed / g
    known = found.t < t_hit - 1e-9
    assert known.sum() > 4000
    assert np.abs(found.F - 100 * expected)[known].max() < 1e-12 * found.peak
    assert np.abs(found.F[found.t > 0.7]).max() < 1e-9  # at rest after h (1 + e)/(1 - e): the rests below g T/2
    assert found.certified and found.agreement < 1e-7 * found.peak


def test_a_block_on_a_rough_floor_stops_where_coulomb_says():
    v_0, F_c = 0.4, 1.5
    z = hl.coordinate("z", unit="m", rate=v_0)
    m, F_f = hl.parameters("m F_f", units="kg N", values=(0.2, F_c))
    slides = hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2, contacts=[hl.contact.friction(slip=z.diff(t), coulomb=F_f)])
    found = reference(hl.Scene(force=seen(z), eom=[slides]), STILL)
    a = F_c / 0.2
    stop = np.minimum(found.t, v_0 / a)
    assert np.abs(found.F - 100 * (v_0 * stop - a * stop**2 / 2)).max() < 1e-13
    assert found.certified


def test_a_stiff_bounce_between_two_samples_is_half_a_sine():
    k, speed = 3e4, 0.5  # in contact for pi sqrt(m/k) = 1.8 ms
    y = hl.coordinate("y", unit="m", initial=0.01, rate=-speed)
    m, k_w = hl.parameters("m k_w", units="kg N/m", values=(0.01, k))
    scene = hl.Scene(force=seen(y), eom=[sp.Eq(m * y.diff(t, 2), hl.when(y < 0, -k_w * y, 0))])
    found = reference(scene, HandleMotion("still", sp.Float(0.0), 0.1))
    omega, touch = np.sqrt(k / 0.01), 0.01 / speed
    leave, since = touch + np.pi / omega, found.t - touch
    inside = -speed / omega * np.sin(omega * since)
    expected = np.where(since < 0, -speed * since, np.where(found.t < leave, inside, speed * (found.t - leave)))
    assert np.abs(found.F - 100 * expected).max() < 1e-12 * found.peak
    assert found.certified


def test_a_cart_and_pole_is_what_scipy_finds_of_equations_written_by_hand():
    scene = hl.library.cart_pole()
    p = scene.values

    def rates(time, y):
        z, theta, w, u = y
        position, velocity = A * np.sin(OMEGA * time), A * OMEGA * np.cos(OMEGA * time)
        F_c = p["K"] * (position - z) + p["b_c"] * (velocity - w)
        M, m, l = p["M"], p["m"], p["l"]
        mass = [[M + m, m * l * np.cos(theta)], [m * l * np.cos(theta), m * l**2]]
        force = [F_c + m * l * u**2 * np.sin(theta), m * p["g"] * l * np.sin(theta) - p["c"] * u]
        return [w, u, *np.linalg.solve(mass, force)]

    found = reference(scene, SINE)
    times = found.t[::400]
    y = solve_ivp(rates, (0, times[-1]), [0, 0.01, 0, 0], "DOP853", t_eval=times, rtol=1e-9, atol=1e-12).y
    position, velocity, _ = SINE.at(times)
    F = p["K"] * (position - y[0]) + p["b_c"] * (velocity - y[2])
    assert np.abs(found.F[::400] - F).max() < 1e-7 * found.peak  # rtol of the third solver


@pytest.mark.parametrize(
    "name",
    [
        "stick_slip", "detents",
        *(pytest.param(name, marks=pytest.mark.slow) for name in hl.library.catalogue if name not in ("stick_slip", "detents")),
    ],
)  # fmt: skip
@pytest.mark.always("detents")
def test_every_scene_of_the_library_is_certified(name):
    for found in references(getattr(hl.library, name)(), handle_motions()):
        assert found.certified and not found.chaotic, str(found)
        assert found.horizon == found.t[-1]


@pytest.mark.wide
def test_chaos_cuts_the_horizon():
    # a double pendulum let go from high up: rounding grows by e every 0.2 s or so
    a, b = hl.coordinate("a", unit="rad", initial=2.6), hl.coordinate("b", unit="rad", initial=2.9)
    m, l, g = hl.parameters("m l g", units="kg m m/s^2", values=(0.05, 0.05, 9.81))
    da, db = a.diff(t), b.diff(t)
    kinetic = m * l**2 * (2 * da**2 + db**2 + 2 * da * db * sp.cos(a - b)) / 2
    motion = hl.mechanics.lagrange(kinetic + m * g * l * (2 * sp.cos(a) + sp.cos(b)))
    torque = hl.parameters("k_t", units="N", values=1.0) * sp.sin(a)
    found = reference(hl.Scene(force=torque, eom=[motion]), HandleMotion("still", sp.Float(0.0), 8.0))
    assert found.chaotic and 0.8 < found.horizon < 8.0
    assert found.agreement <= 1e-6 * found.peak and found.certified
    assert np.isnan(found.at([7.999])[0]) and np.isfinite(found.at([0.5])[0])
    assert "chaotic after" in str(found)


def test_what_has_one_solver_is_not_certified():
    y = hl.coordinate("y", unit="m", initial=0.05)
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.03, 9.81))
    law = hl.contact.micro_impulse(e=0.5, envelope="0.1 mm")
    falls = hl.mechanics.lagrange(m * y.diff(t) ** 2 / 2 - m * g * y, contacts=[hl.contact.Contact(y, law)])
    found = reference(hl.Scene(force=seen(y), eom=[falls]), STILL)
    assert not found.certified and not found.certifies(1.0)
    assert "one solver" in found.how and "micro-impulses" in found.how
    assert "uncertified, one solver, whose force" in str(found) and "inf" not in str(found)


def test_a_reference_is_asked_at_whole_numbers_of_its_step():
    found = reference(mass_on_a_coupler(), SINE, step=2.5e-4)
    assert np.array_equal(found.at([0.0, 1e-3]), found.F[[0, 4]])
    with pytest.raises(AnalysisError, match="every 0.00025 s"):
        found.at([1e-4])


def test_two_solvers_certify_an_error_ten_times_their_difference():
    made = Reference(SINE, np.zeros(2), np.ones(2), 1e-6, "", 1.0)
    assert made.certifies(1e-5) and not made.certifies(0.9e-5)


def test_the_damper_of_a_coupler_that_looks_at_samples_takes_them_where_they_are():
    # x(n) in an equation of motion is held by a program; the reference has no samples to hold
    z = hl.coordinate("z", unit="m")
    m, K = hl.parameters("m K", units="kg N/m", values=(0.08, 310))
    b = hl.parameters("b", units="N*s/m", values=0.6)
    sampled = K * (x(n) - z) + b * (v(n) - z.diff(t))
    scene = hl.Scene(force=sampled, eom=[sp.Eq(m * z.diff(t, 2), sampled)])
    assert np.array_equal(reference(scene, SINE).F, reference(mass_on_a_coupler(), SINE).F)
