"""Impulses against closed forms of the chain, the stack and the rod; their energy; repeated micro-impulses."""

import numpy as np
import pytest

from hapticlab.compiler.algebra.complementarity import response
from hapticlab.compiler.contacts.impulses import (
    check_rest_speed,
    dissipated,
    micro_rebound,
    sequential,
    simultaneous,
    with_friction,
)
from hapticlab.compiler.engines.interpreter import evaluate
from hapticlab.compiler.ir.trace import Builder
from hapticlab.errors import SceneError


def chain(masses):
    """Return M and the gaps' J of balls in a row, contact i between ball i and i + 1."""
    n = len(masses)
    J = [[(-1.0 if j == i else 1.0 if j == i + 1 else 0.0) for j in range(n)] for i in range(n - 1)]
    return np.diag(masses).tolist(), J


def struck(law, masses, velocities, e, **more):
    """Return the velocities after, and the energy lost by velocities and by impulses."""
    M, J = chain(masses)
    W, P = response(M, J)
    u = [float(np.dot(row, velocities)) for row in J]
    p, after = law(W, u, [e] * len(u), **more)
    new = np.array(velocities) + np.array(P).T @ p
    assert np.array(J) @ new == pytest.approx(after, abs=1e-12)
    lost = 0.5 * np.dot(masses, np.square(velocities)) - 0.5 * np.dot(masses, new**2)
    return new, lost, sum(dissipated(u, after, p))


@pytest.mark.parametrize("balls, incoming", [(3, 1), (3, 2), (4, 1), (4, 3), (5, 1), (5, 2), (5, 3)])
@pytest.mark.parametrize("side", [1, -1])
def test_newtons_cradle_sends_off_as_many_as_came(balls, incoming, side):
    """Equal balls without loss exchange velocities, from either side, also when most of the balls come."""
    velocities = [1.3] * incoming + [0.0] * (balls - incoming)
    after, lost, _ = struck(sequential, [0.05] * balls, [side * w for w in velocities[::side]], 1.0)
    assert after == pytest.approx([side * w for w in velocities[::-1][::side]], abs=1e-14)
    assert lost == pytest.approx(0.0, abs=1e-15)


def test_two_groups_meet_in_a_cradle():
    """2 m/s from the left and 1 m/s from the right: the three balls reverse their order of velocities."""
    after, _, _ = struck(sequential, [0.1] * 3, [2.0, 0.0, -1.0], 1.0)
    assert after == pytest.approx([-1.0, 0.0, 2.0], abs=1e-14)


@pytest.mark.parametrize("e", [0.3, 0.8, 1.0])
def test_a_blow_passes_along_unequal_balls_by_their_mass_ratios(e):
    """v' = (1 + e) m_i/(m_i + m_i+1) v from ball to ball; falling masses, so that no ball strikes twice in the first sweep."""
    masses = [0.4, 0.3, 0.1, 0.02]
    after, lost, booked = struck(sequential, masses, [1.7, 0.0, 0.0, 0.0], e, sweeps=1)
    passed = 1.7
    for a, b in zip(masses, masses[1:], strict=False):
        passed *= (1 + e) * a / (a + b)
    assert after[-1] == pytest.approx(passed, rel=1e-14)
    assert np.dot(masses, after) == pytest.approx(0.4 * 1.7, rel=1e-14)
    # the sum of p (u- + u+)/2 over the whole is exact also where contacts follow each other
    assert booked == pytest.approx(lost, rel=1e-12, abs=1e-15)


def on_the_floor(law, masses, velocities, e):
    """A stack on a floor: the first gap is that of the lowest body."""
    J = [[1.0, 0.0], [-1.0, 1.0]]
    W, P = response(np.diag(masses).tolist(), J)
    p, _ = law(W, [float(np.dot(row, velocities)) for row in J], [e, e])
    return np.array(velocities) + np.array(P).T @ p, p


def test_a_dropped_stack_depends_on_the_order_that_is_named():
    """Ball m on ball M at speed -v. In sequence: the superball throw, v_m = e v + ...; at once: both leave with e v."""
    m, M, v, e = 0.02, 0.5, 2.0, 0.9
    after, _ = on_the_floor(sequential, [M, m], [-v, -v], e)
    rebound = e * v
    expected_m = (m * -v + M * rebound + M * e * (rebound + v)) / (m + M)
    assert after[1] == pytest.approx(expected_m, rel=1e-14)
    assert after[1] > 1.5 * e * v
    after, p = on_the_floor(simultaneous, [M, m], [-v, -v], e)
    assert after == pytest.approx([e * v, e * v], rel=1e-14)
    assert p == pytest.approx([(m + M) * (1 + e) * v, m * (1 + e) * v], rel=1e-13)


def test_a_blow_on_a_stack_at_rest_goes_through_it():
    """Body 2 strikes body 1 that lies on the floor: 1 stays, the floor takes all of it, 2 comes back with e."""
    m1, m2, v, e = 0.3, 0.2, 1.5, 0.6
    after, p = on_the_floor(simultaneous, [m1, m2], [0.0, -v], e)
    assert after == pytest.approx([0.0, e * v], abs=1e-14)
    assert p == pytest.approx([m2 * (1 + e) * v] * 2, rel=1e-13)


@pytest.mark.parametrize("law", [sequential, simultaneous])
@pytest.mark.parametrize("seed", range(8))
def test_impacts_lose_the_energy_that_is_booked_and_never_gain(law, seed):
    generator = np.random.default_rng(seed)
    masses, velocities = 10 ** generator.uniform(-2, 0, 4), generator.normal(size=4)
    _, lost, booked = struck(law, masses.tolist(), velocities.tolist(), generator.uniform(0, 1))
    assert booked == pytest.approx(lost, rel=1e-10, abs=1e-14)
    assert booked >= -1e-14


def test_one_contact_loses_its_share_of_the_effective_mass():
    W, u, e = 2.5, -3.0, 0.7
    p, after = sequential([[W]], [u], [e])
    assert dissipated([u], after, p)[0] == pytest.approx(0.5 * (1 - e**2) * u**2 / W, rel=1e-14)
    assert p[0] == pytest.approx((1 + e) * 3.0 / W, rel=1e-15)


def test_a_leaving_contact_that_is_struck_closed_is_met_again():
    """Body 1 leaves the floor slowly; body 2 falls on it: after the first round it would enter the floor."""
    after, _ = on_the_floor(simultaneous, [0.1, 1.0], [0.01, -3.0], 0.5)
    assert after[0] >= -1e-14 and after[1] - after[0] >= -1e-14


@pytest.mark.parametrize("several", [False, True])
def test_simultaneous_impacts_of_any_bodies_gain_nothing_and_enter_nothing(several):
    """Dense W of three contacts, some leaving; one restitution for all, or one each."""
    generator = np.random.default_rng(5)
    for _ in range(300):
        A, u = generator.normal(size=(3, 4)), generator.normal(size=3).tolist()
        e = generator.uniform(0, 1, 3).tolist() if several else [generator.uniform(0, 1)] * 3
        W = (A @ A.T).tolist()
        p, after = simultaneous(W, u, e)
        assert min(p) >= -1e-12 and min(after) > -1e-9
        assert sum(dissipated(u, after, p)) > -1e-9


@pytest.mark.parametrize("mu, expected", [(0.1, "slides"), (0.6, "sticks")])
def test_a_ball_thrown_at_a_wall_slides_or_grips(mu, expected):
    """A solid sphere: sliding loses mu (1 + e) v of its slip 7/2 times; gripping stops the slip with p_t = 2/7 m slip."""
    m, v, e, slip = 0.2, 2.0, 0.8, 3.0
    p, s = with_friction(1 / m, 0.0, 3.5 / m, -v, slip, e, mu)
    assert p == pytest.approx(m * (1 + e) * v, rel=1e-15)
    grip = -2 / 7 * m * slip
    assert s == pytest.approx({"slides": -mu * p, "sticks": grip}[expected], rel=1e-14)
    after = slip + 3.5 / m * s
    assert after == pytest.approx(0.0, abs=1e-14) if expected == "sticks" else after > 0


def rod(angle, mass=0.5, half=0.4):
    """Return W, c, N of a rod that strikes a plane with its end, at an angle from the plane."""
    inertia = mass * half**2 / 3
    arm_n, arm_t = -half * np.cos(angle), half * np.sin(angle)
    return 1 / mass + arm_n**2 / inertia, arm_n * arm_t / inertia, 1 / mass + arm_t**2 / inertia


@pytest.mark.parametrize("seed", range(40))
def test_a_rod_that_strikes_with_friction_obeys_the_cone_and_gains_nothing(seed):
    generator = np.random.default_rng(seed)
    W, c, N = rod(generator.uniform(0.1, 1.5))
    u, slip = -generator.uniform(0.1, 3), generator.normal()
    e, mu = generator.uniform(0, 1), generator.uniform(0, 1.2)
    p, s = with_friction(W, c, N, u, slip, e, mu)
    after_u, after_slip = u + W * p + c * s, slip + c * p + N * s
    assert p > 0 and abs(s) <= mu * p * (1 + 1e-12)
    assert -1e-12 <= after_u <= e * -u + 1e-12
    # either it grips, or it uses the whole cone
    assert abs(after_slip) < 1e-12 or abs(s) == pytest.approx(mu * p, rel=1e-12)
    assert p * u + s * slip + 0.5 * (W * p**2 + 2 * c * p * s + N * s**2) <= 1e-12


def test_elastic_impacts_stay_elastic_beside_others():
    """No rounding makes of a loss of zero a gain: e = 1 is kept where a contact of e = 0.5 takes no part, or mu = 0."""
    W = [[3.0, 0.7], [0.7, 2.1]]
    for u in (-0.1, -0.37, -1.9):
        assert simultaneous(W, [u, 5.0], [1.0, 0.5])[1][0] == pytest.approx(-u, rel=1e-14)
        assert with_friction(3.0, 0.7, 2.1, u, 0.4, 1.0, 0.0) == pytest.approx((-2 * u / 3.0, 0.0), rel=1e-14)


def test_the_traced_lines_do_what_the_numbers_do():
    masses, e = [0.4, 0.1, 0.3], 0.7
    M, J = chain(masses)
    W, _ = response(M, J)
    for law in (sequential, simultaneous):
        builder = Builder("f64")
        u = [builder.leaf("input", i, "f64") for i in range(2)]
        touching = [0.5 < builder.leaf("input", 2 + i, "f64") for i in range(2)]
        entries = [[builder.const(w) for w in row] for row in W]
        p, after = law(entries, u, [e, e], touching)
        block = builder.block([*p, *after])
        for rates in ([-1.0, 0.3], [0.2, -0.4], [-1.0, -2.0], [1.0, 1.0]):
            for here in ([True, True], [True, False]):
                outputs, _ = evaluate(block, param=(), input=[np.float64(a) for a in [*rates, *here]], state=())
                numbers = law(W, rates, [e, e], here)
                # constant divisors become factors, one rounding apart
                assert [float(o) for o in outputs] == pytest.approx([*numbers[0], *numbers[1]], rel=1e-14, abs=1e-15)


def test_nothing_happens_to_what_does_not_touch_or_leaves():
    W = [[2.0, -1.0], [-1.0, 2.0]]
    for law in (sequential, simultaneous):
        assert law(W, [-1.0, 0.5], [0.5, 0.5], [False, True])[0] == [0.0, 0.0]
    assert with_friction(1.0, 0.2, 2.0, 0.5, 1.0, 0.5, 0.3) == (0.0, 0.0)


def test_a_rest_speed_that_leaves_too_many_impacts_is_refused():
    with pytest.raises(SceneError, match=r"table: rest_speed = 0.001 m/s; needs at least a T/2 = 0.004905 m/s"):
        check_rest_speed(1e-3, 9.81, 1e-3, "table")
    check_rest_speed(5e-3, 9.81, 1e-3, "table")


def micro(q, w, e, ticks, g=9.81, T=1e-3, envelope=1e-4):
    """Fall freely and collide at the end of each step; return gaps and impulses per unit of mass."""
    gaps, impulses = [], []
    for _ in range(ticks):
        q, w = q + w * T - g * T * T / 2, w - g * T
        after = micro_rebound(q, w, e, envelope, -g, T)
        impulses.append(after - w)
        w = after
        gaps.append(q)
    return np.array(gaps), np.array(impulses)


def test_micro_impulses_hold_a_body_at_rest():
    """A train of tiny collisions carries the weight, and the body stays within the envelope of the surface."""
    gaps, impulses = micro(5e-5, 0.0, 0.5, 4000)
    assert impulses[2000:].mean() == pytest.approx(9.81 * 1e-3, rel=1e-3)
    assert -1e-5 < gaps[2000:].min() and gaps[2000:].max() < 1.01e-4


def test_micro_impulses_bounce_with_restitution():
    """The first rebound of a drop, right to the order of the step: a speed of g T in 1.4 m/s."""
    gaps, impulses = micro(0.1, 0.0, 0.8, 600)
    first = np.flatnonzero(impulses)[0]
    assert impulses[first] == pytest.approx(1.8 * np.sqrt(2 * 9.81 * 0.1), rel=2 * 9.81e-3 / 1.4)
    assert gaps[first:].max() == pytest.approx(0.064, rel=0.02)
    assert gaps.min() > -1.5e-3
