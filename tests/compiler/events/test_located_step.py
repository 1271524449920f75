"""Steps with events inside against closed forms: bounce, short contact, juggling, friction, and what is not located."""

import math

import numpy as np
import pytest
from motions import program, rows
from scipy.optimize import brentq

from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.events.flow import motion_of
from hapticlab.compiler.events.guards import Reaction, contact, coulomb
from hapticlab.compiler.ir.trace import Builder, cos, floor, maximum, minimum, select, sin
from hapticlab.errors import ProgramError

T = 1e-3
G = 9.81


def sign(v):
    return select(0.0 < v, 1.0, select(v < 0.0, -1.0, 0.0 * v))


def times(n):
    return T * np.arange(1, n + 1)


class Flying:
    """A ball of 50 g above a floor or a paddle at ``surface(tau)``: reaction, contact and impact of one contact."""

    def __init__(self, e, rest, surface=lambda tau: 0.0 * tau, velocity=lambda tau: 0.0 * tau):
        self.e, self.rest, self.surface, self.velocity = e, rest, surface, velocity

    def contacts(self, tau, q, w, s, new):
        self.reaction, self.speed = new(), w[0] - self.velocity(tau)
        return [contact(q[0] - self.surface(tau), self.reaction)]

    def rates(self, tau, q, w, s):
        return [20.0 * self.reaction - G], []

    def impact(self, motion):
        def strike(at, fired, held):
            u = at(self.speed)
            rests = -self.e * u < self.rest
            return [at(motion.w[0]) - u + select(rests, 0.0, -self.e * u)], [rests]

        return strike


def test_bounce_to_rest_is_the_closed_form():
    e, rest = 0.8, 6e-3
    ball = Flying(e, rest)
    motion = program(ball.rates, [0.1], [0.0], T=T, order=6, events=2, contacts=ball.contacts, impact=ball.impact)
    t = times(2200)
    start, speed = math.sqrt(0.2 / G), math.sqrt(0.2 * G)
    exact = np.where(t < start, 0.1 - G * t**2 / 2, 0.0)
    while (speed := e * speed) >= rest:
        up = np.where((start < t) & (t < start + 2 * speed / G), t - start, 0.0)
        exact += speed * up - G * up**2 / 2
        start += 2 * speed / G
    q, w = rows(motion, len(t)).T
    np.testing.assert_allclose(q, exact, rtol=0, atol=1e-14)
    assert start < 1.3 and not w[t > start + T].any()  # at rest exactly


def test_a_slow_rebound_without_rest_runs_out_of_events_and_says_so():
    ball = Flying(0.8, 0.0)
    motion = program(ball.rates, [1e-6], [0.0], T=T, order=4, events=2, contacts=ball.contacts, impact=ball.impact)
    outputs = load(motion).run(20).outputs[:, :, 0]
    assert outputs[:, -1].sum() > 5
    assert abs(outputs[:, 0]).max() < 1e-5  # it falls through by no more than g T^2/2 before the next tick throws it back


def penalty_flight(m, k, b, drop):
    """Times and states at which a ball that is dropped enters, loses and leaves a penalty wall, and the flow of each."""
    v = -math.sqrt(2 * G * drop)
    sigma, omega, rest = b / (2 * m), math.sqrt(k / m - (b / (2 * m)) ** 2), -m * G / k

    def inside(t):
        A, B = -rest, (v - sigma * rest) / omega
        decay, c, s = np.exp(-sigma * t), np.cos(omega * t), np.sin(omega * t)
        q = rest + decay * (A * c + B * s)
        w = decay * ((B * omega - sigma * A) * c - (A * omega + sigma * B) * s)
        return q, w

    def force(t):
        q, w = inside(t)
        return -k * q - b * w

    lost = brentq(force, 0.6 * math.pi / omega, 1.2 * math.pi / omega, xtol=1e-18, rtol=1e-15)
    return -v / G, lost, inside


@pytest.mark.parametrize(
    "k, b, substeps, ticks",
    [(6e5, 0.0, 4, 0.95), (4e4, 2.0, 1, 3.6), pytest.param(1e6, 2.0, 5, 0.75, marks=pytest.mark.slow)],
)
@pytest.mark.always("40000*")
def test_a_contact_of_a_spring_and_damper_shorter_than_a_tick(k, b, substeps, ticks):
    m, drop = 0.05, 0.1234
    assert math.sqrt(k / m) * T / substeps <= 1 and math.pi * math.sqrt(m / k) < ticks * T

    def rates(tau, q, w, s):
        force = maximum(0.0, -k * q[0] - b * w[0]) if b else -k * q[0]
        return [select(q[0] <= 0.0, force, 0.0) * (1 / m) - G], []

    motion = program(rates, [drop], [0.0], T=T, substeps=substeps, order=14 if substeps > 1 else 18, events=2)
    touch, lost, inside = penalty_flight(m, k, b, drop)
    q_lost, w_lost = inside(lost)

    def exact(t):
        if t < touch:
            return drop - G * t**2 / 2
        if t < touch + lost:
            return inside(t - touch)[0]
        after = t - touch - lost
        return q_lost + w_lost * after - G * after**2 / 2

    again = touch + lost + 2 * w_lost / G - 1e-3
    t = times(int(again / T))
    q = rows(motion, len(t))[:, 0]
    assert min(t[-1], 0.3) > touch + 50 * T
    np.testing.assert_allclose(q, [exact(s) for s in t], rtol=0, atol=1e-12)


@pytest.mark.parametrize("depth", [1e-6, 1e-8, 1e-11])
@pytest.mark.always("1e-08")
def test_touching_and_leaving_within_one_tick(depth):
    # a parabola whose lowest point lies below the wall for 2 sqrt(2 depth/a), in the middle of a tick
    a, k, m = 40.0, 300.0, 0.02
    middle = 0.4567 * T
    w = -a * middle
    q = a * middle**2 / 2 - depth

    def rates(tau, q, w, s):
        return [a + select(q[0] < 0.0, -k * q[0], 0.0) * (1 / m)], []

    got = rows(program(rates, [q], [w], T=T, order=16, events=2), 1)[0]
    without = q + w * T + a * T**2 / 2, w + a * T
    omega, rest = math.sqrt(k / m), a * m / k
    touch = (-w - math.sqrt(w**2 - 2 * a * q)) / a
    v = w + a * touch
    # q = rest + C cos(omega t + phi) in the wall, symmetric: it leaves with -v
    contact_time = 2 * math.atan2(-v / omega, rest) / omega
    left = T - touch - contact_time
    exact = -v * left + a * left**2 / 2, -v + a * left
    np.testing.assert_allclose(got, exact, rtol=0, atol=1e-13)
    assert abs(got[0] - exact[0]) < 1e-17
    if depth > 1e-8:
        assert abs(without[1] - exact[1]) > 1e-9


def test_juggling_with_an_incommensurate_period():
    # Schaal and Sternad: at the paddle A sin(2 pi f t) an orbit of the ball meets it once a period, at a phase where the
    # paddle rises with g/(2 f) (1 - e)/(1 + e); the start is 3 mm off that orbit
    e, A, f = 0.7, 0.08, 1.7 * math.sqrt(1.01)
    turn = 2 * math.pi * f
    meets = math.acos(G / (2 * f) * (1 - e) / (1 + e) / (A * turn)) / turn
    q0 = A * math.sin(turn * meets) + G / (2 * f) * meets - G * meets**2 / 2 + 3e-3
    w0 = -G / (2 * f) + G * meets

    def surface(tau):
        return A * sin(turn * tau)

    def velocity(tau):
        return A * turn * cos(turn * tau)

    ball = Flying(e, 0.0, surface, velocity)
    motion = program(ball.rates, [q0], [w0], T=T, order=16, events=2, contacts=ball.contacts, impact=ball.impact)
    t = times(2500)
    t0, exact, hits = 0.0, np.empty_like(t), 0
    while t0 < t[-1]:
        after = t - t0
        late = t >= t0
        exact[late] = (q0 + w0 * after - G * after**2 / 2)[late]
        ahead = np.linspace(1e-3, 2, 40001)

        def gap(u):
            return q0 + w0 * u - G * u**2 / 2 - A * np.sin(turn * (t0 + u))  # noqa: B023

        first = np.flatnonzero(gap(ahead) < 0)[0]
        u = brentq(gap, ahead[first - 1], ahead[first], xtol=1e-16, rtol=1e-15)
        speed = A * turn * math.cos(turn * (t0 + u))
        w0, q0, t0 = speed - e * (w0 - G * u - speed), A * math.sin(turn * (t0 + u)), t0 + u
        hits += 1
    assert 4 < hits < 7 and abs((t0 % (1 / f)) - meets) < 0.02
    np.testing.assert_allclose(rows(motion, len(t))[:, 0], exact, rtol=0, atol=1e-11)


def test_a_block_slides_to_rest_and_stays():
    F, m, v = 0.6, 0.25, 0.371

    def rates(tau, q, w, s):
        return [-F / m * sign(w[0])], []

    motion = program(rates, [0.0], [v], T=T, order=6, events=2)
    t, stop = times(400), v * m / F
    q, w = rows(motion, len(t)).T
    s = np.minimum(t, stop)
    np.testing.assert_allclose(q, v * s - F / m * s**2 / 2, rtol=0, atol=1e-15)
    assert not w[t > stop].any()


@pytest.mark.parametrize("push, moves", [(0.59, False), (0.61, True), (-0.7, True)])
def test_a_block_at_rest_breaks_away_above_the_friction_only(push, moves):
    F, m = 0.6, 0.25

    def rates(tau, q, w, s):
        return [(push - F * sign(w[0])) / m], []

    q = rows(program(rates, [0.0], [0.0], T=T, order=6, events=2), 100)[:, 0]
    t = times(100)
    a = (push - math.copysign(F, push)) / m if moves else 0.0
    np.testing.assert_allclose(q, a * t**2 / 2, rtol=0, atol=1e-15)


def stick_slip(k, m, v, F_s, F_c, c, end):
    """q of a block on a belt of speed v, held by a spring: it sticks up to F_s, then slips with F_c - c |slip|."""
    t = times(int(end / T))
    q, start, q0 = np.empty_like(t), 0.0, 0.0
    sigma = c / (2 * m)
    omega, rest = math.sqrt(k / m - sigma**2), (F_c - c * v) / k
    while start < t[-1]:
        t_break = start + (F_s / k - q0) / v
        A = F_s / k - rest
        B = (v - sigma * A) / omega

        def rate(u, A=A, B=B):
            return np.exp(sigma * u) * ((sigma * A + omega * B) * np.cos(omega * u) + (sigma * B - omega * A) * np.sin(omega * u))

        grid = np.linspace(0.05, 2 * math.pi, 4001) / omega
        first = np.flatnonzero(rate(grid) >= v)[0]
        u = brentq(lambda s: rate(s) - v, grid[first - 1], grid[first], xtol=1e-16, rtol=1e-15)
        stuck, slips = (start <= t) & (t < t_break), t_break <= t
        q[stuck] = q0 + v * (t[stuck] - start)
        s = t[slips] - t_break
        with np.errstate(over="ignore", invalid="ignore"):
            q[slips] = rest + np.exp(sigma * s) * (A * np.cos(omega * s) + B * np.sin(omega * s))
        start = t_break + u
        q0 = rest + math.exp(sigma * u) * (A * math.cos(omega * u) + B * math.sin(omega * u))
    return q


def test_stick_slip_with_friction_that_weakens():
    k, m, v, F, c = 50.0, 1.0, 0.1, 3.0, 0.5

    def rates(tau, q, w, s):
        slip = v - w[0]
        return [(sign(slip) * (F - c * abs(slip)) - k * q[0]) / m], []

    # one event a tick is enough: breaking away is one, whatever sign rounding gives the slip there
    q = rows(program(rates, [0.0], [v], T=T, order=8, events=1), 3000)[:, 0]
    np.testing.assert_allclose(q, stick_slip(k, m, v, F, F, c, 3.0), rtol=0, atol=1e-12)


def test_stick_slip_of_a_friction_whose_breakaway_is_higher():
    k, m, v, F_s, F_c = 50.0, 1.0, 0.1, 3.0, 2.0

    class Belt:
        def contacts(self, tau, q, w, s, new):
            self.force = new()
            self.builder = self.force.builder
            return [coulomb(new, v - w[0], self.builder.const(F_c), self.builder.const(F_s), self.force)]

        def rates(self, tau, q, w, s):
            # the force is that against the slip v - w, so it pushes the block along
            return [(self.force - k * q[0]) / m], []

    belt = Belt()
    q = rows(program(belt.rates, [0.0], [v], T=T, order=8, events=2, contacts=belt.contacts), 3000)[:, 0]
    np.testing.assert_allclose(q, stick_slip(k, m, v, F_s, F_c, 0.0, 3.0), rtol=0, atol=1e-12)


def test_two_blocks_that_stick_to_each_other_move_as_one():
    m, M, F, pull = 0.2, 0.5, 0.4, 0.5

    def rates(tau, q, w, s):
        friction = F * sign(w[0] - w[1])
        return [-friction / m, (pull + friction) / M], []

    motion = program(rates, [0.0, 0.0], [0.3, 0.0], T=T, order=6, events=2)
    t = times(400)
    q = rows(motion, len(t))[:, :2]
    together = 0.3 / (F / m + (F + pull) / M)
    s, rest = np.minimum(t, together), np.maximum(t - together, 0)
    common = pull / (m + M)
    speed = 0.3 - F / m * together
    np.testing.assert_allclose(q[:, 0], 0.3 * s - F / m * s**2 / 2 + speed * rest + common * rest**2 / 2, rtol=0, atol=1e-14)
    np.testing.assert_allclose(q[:, 1], (F + pull) / M * s**2 / 2 + speed * rest + common * rest**2 / 2, rtol=0, atol=1e-14)


def test_whole_numbers_are_surfaces_too():
    # rows of bumps of 10 mm, each a ramp: the force is -k times the place within the bump
    k, m, pitch, v = 2.0, 0.1, 0.01, 0.5

    def rates(tau, q, w, s):
        return [(-k * (q[0] / pitch - floor(q[0] / pitch)) + 0.5 * k) / m], []

    q = rows(program(rates, [0.0012], [v], T=T, order=16, events=2), 60)[-1, 0]
    omega = math.sqrt(k / (pitch * m))
    place, speed, left, bumps = 0.0012, v, 60 * T, 0
    while True:
        middle, A, B = 0.5 * pitch, place - 0.5 * pitch, speed / omega

        def at(u):
            return middle + A * math.cos(omega * u) + B * math.sin(omega * u)  # noqa: B023

        u = brentq(lambda s: at(s) - pitch, 1e-9, 1.5 * pitch / speed, xtol=1e-17)
        if u > left:
            break
        speed = omega * (B * math.cos(omega * u) - A * math.sin(omega * u))
        place, left, bumps = 0.0, left - u, bumps + 1
    assert bumps > 2
    assert q == pytest.approx(bumps * pitch + at(left), abs=1e-13)


def test_min_and_max_need_no_more_than_their_kink():
    k, m = 400.0, 0.1

    def rates(tau, q, w, s):
        return [-k / m * (maximum(q[0] - 0.01, 0.0) + minimum(q[0] + 0.01, 0.0))], []

    q = rows(program(rates, [0.0], [0.8], T=T, order=14, events=2), 500)[:, 0]
    omega = math.sqrt(k / m)
    contact_time, free = math.pi / omega, 0.02 / 0.8
    A, period = 0.8 / omega, 2 * (contact_time + free)
    phase = (times(500) + 0.5 * free) % period
    half, phase = phase >= 0.5 * period, phase % (0.5 * period)
    height = np.where(phase < free, 0.8 * phase - 0.01, 0.01 + A * np.sin(omega * (phase - free)))
    np.testing.assert_allclose(q, np.where(half, -height, height), rtol=0, atol=1e-12)


def test_float32_locates_as_well_as_its_rounding():
    F, m, v = 0.6, 0.25, 0.371

    def rates(tau, q, w, s):
        return [-F / m * sign(w[0])], []

    q, w = rows(program(rates, [0.0], [v], T=T, order=4, events=2, real="f32"), 400)[-1]
    assert w == 0.0
    assert q == pytest.approx(v**2 * m / (2 * F), rel=5e-5)


def test_work_is_the_same_whatever_happens_and_nothing_extra_without_guards():
    def smooth(tau, q, w, s):
        return [-4.0 * q[0]], []

    def wall(tau, q, w, s):
        return [-4.0 * maximum(q[0], 0.0)], []

    few, many = (program(wall, [0.1], [0.0], T=T, order=8, events=n) for n in (1, 3))
    assert len(program(smooth, [0.1], [0.0], T=T, order=8, events=3)) < 50
    assert 1.8 < len(many) / len(few) < 2.3


def test_what_is_frozen():
    builder = Builder("f64")

    def rates(tau, q, w, s):
        cases = select((q[0] < 0.0) & (0.0 < w[0]), 1.0, 0.0)
        return [cases + abs(w[0]) - 3.0 * sign(w[0] - 0.5) + floor(q[0])], []

    motion = motion_of(builder, rates, 1)
    # q < 0 and 0 < w in a condition of both, |w| with the second, floor; the jump at w = 0.5 can be slid along
    assert sorted(g.kind for g in motion.guards) == ["floor", "side", "side"]
    assert len(motion.reactions) == 1 and isinstance(motion.reactions[0], Reaction)
    assert not motion.smooth


def test_a_gap_of_a_coordinate_without_mass_is_refused():
    def contacts(tau, q, w, s, new):
        return [contact(q[0] - s[0], new())]

    with pytest.raises(ProgramError, match="first order"):
        motion_of(Builder("f64"), lambda tau, q, w, s: ([-G], [-s[0]]), 1, 1, contacts)


def test_friction_and_a_resting_contact_act_on_each_other():
    # a block on a table, thrown along it: mu N slows it, N is the reaction of the table, and it stops for good
    m, mu, v = 0.3, 0.4, 0.5

    class Table:
        def contacts(self, tau, q, w, s, new):
            self.N, self.R = new(), new()
            limit = mu * self.N
            return [contact(q[1], self.N), coulomb(new, w[0], limit, limit, self.R)]

        def rates(self, tau, q, w, s):
            return [-self.R / m, self.N / m - G], []

        def impact(self, motion):
            def lands(at, fired, held):
                return [at(motion.w[0]), 0.0 * at(motion.w[1])], [fired[0] | held[0], held[1]]

            return lands

    table = Table()
    motion = program(table.rates, [0.0, 1e-3], [v, 0.0], T=T, order=6, events=3, contacts=table.contacts, impact=table.impact)
    t, lands = times(400), math.sqrt(2e-3 / G)
    q, z, w, _ = rows(motion, len(t)).T
    s = np.clip(t - lands, 0, v / (mu * G))
    np.testing.assert_allclose(q, v * (np.minimum(t, lands) + s) - mu * G * s**2 / 2, rtol=0, atol=1e-13)
    assert abs(z[t > lands]).max() < 1e-15 and not w[t > lands + v / (mu * G)].any()
