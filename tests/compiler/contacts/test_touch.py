"""Bodies that meet, events located on the closed motion: bounce, juggling, cradle, stack against their closed forms."""

from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

import hapticlab as hl
from hapticlab.compiler.algebra.complementarity import impossible
from hapticlab.compiler.contacts.impacts import impacts_of
from hapticlab.compiler.contacts.impulses import with_friction
from hapticlab.compiler.contacts.touch import Law, micro_impulses, release, strike
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.events.flow import motion_of
from hapticlab.compiler.events.guards import contact
from hapticlab.compiler.events.located_step import Stepper
from hapticlab.compiler.events.taylor_series import Series
from hapticlab.compiler.ir.program import Channel, Program
from hapticlab.compiler.ir.trace import Builder, cos, select, sin

G, T = 9.81, 1e-3


def run(masses, forces, rows, laws, start, ticks, *, spring=0.0, plate=None, order="sequential", events=3):
    """Run bodies with forces f - spring q and the gaps rows q; return q, w and held tick by tick.

    plate is (amplitude, omega, phase): the first gap is measured from a plate at a sin(omega t + phase).
    """
    b, n, k, reactions = Builder("f64"), len(masses), len(rows), []

    def plate_at(time):
        return plate[0] * sin(plate[1] * time + plate[2]) if plate else b.const(0.0)

    def dot(row, values):
        total = b.const(0.0)
        for c, value in zip(row, values, strict=True):
            total = total + c * value
        return total

    clock = b.leaf("state", 2 * n + k, "f64")

    def touches(tau, q, w, s, new):
        gaps = [dot(row, q) for row in rows]
        gaps[0] = gaps[0] - plate_at(clock + tau)
        reactions[:] = [contact(gap, new()) for gap in gaps]
        return reactions

    def rates(tau, q, w, s):
        pushed = [dot([row[i] for row in rows], [r.leaf for r in reactions]) for i in range(n)]
        total = [force - spring * z + push for force, z, push in zip(forces, q, pushed, strict=True)]
        return [force * (1 / mass) for force, mass in zip(total, masses, strict=True)], []

    motion = motion_of(b, rates, n, events=touches)
    impacts = impacts_of(motion, laws, list(range(k)), T, order)
    stepper = Stepper(motion, T, 12 if plate or spring else 4, events, impact=impacts)
    q, w = ([b.leaf("state", half * n + i, "f64") for i in range(n)] for half in (0, 1))
    held = [0.5 < b.leaf("state", 2 * n + i, "f64") for i in range(k)]
    (q, w, _), held, unlocated = stepper.step(b.const(0.0), (q, w, []), held)
    after = [*q, *w, *(select(h, 1.0, 0.0) for h in held)]
    total = {role: sum(impacts.sums[role, i] for i in range(k)) for role in ("impact_loss", "impact_work")}
    books = [b.leaf("state", 2 * n + k + 1 + i, "f64") + amount for i, amount in enumerate(total.values())]
    block = b.block([*after, *books, select(unlocated, 1.0, 0.0)], [*after, clock + T, *books])
    names = [f"s{i}" for i in range(2 * n + k)]
    states = tuple(Channel(name, "1", "f64") for name in [*names, "t", *total])
    outputs = tuple(Channel(name, "1", "f64") for name in [*names, *total, "unlocated"])
    init = Builder("f64")
    first = init.block((), [init.const(float(value)) for value in (*start, *[0.0] * k, 0.0, 0.0, 0.0)])
    program = Program("bodies", (), (), states, outputs, first, block, T).verify()
    table = load(program).run(ticks, np.zeros((ticks, 0))).outputs[:, :, 0]
    assert not table[:, -1].any(), "an event was left out"
    lost, work = table[:, -3], table[:, -2]
    return SimpleNamespace(q=table[:, :n], w=table[:, n : 2 * n], held=table[:, 2 * n : -3] > 0.5, lost=lost, work=work)


def bouncing(t, height, e):
    """Position and velocity of a ball dropped from a height, until it rests."""
    v = np.sqrt(2 * G * height)
    if t < v / G:
        return height - G * t * t / 2, -G * t
    t, v = t - v / G, e * v
    while v > G * T / 2:
        if t < 2 * v / G:
            return v * t - G * t * t / 2, v - G * t
        t, v = t - 2 * v / G, e * v
    return 0.0, 0.0


def test_a_ball_bounces_as_in_the_book_until_it_rests():
    ran = run([0.5], [-0.5 * G], [[1.0]], [Law("floor", 0.8)], [0.1, 0.0], 1500)
    expected = np.array([bouncing((k + 1) * T, 0.1, 0.8) for k in range(1500)])
    assert np.abs(ran.q[:, 0] - expected[:, 0]).max() < 1e-12
    # the velocity jumps at a bounce: a tick within a rounding of it may be on either side
    assert np.sort(np.abs(ran.w[:, 0] - expected[:, 1]))[:-2].max() < 1e-10
    assert ran.held[-1, 0] and not ran.held[700, 0]


@pytest.mark.parametrize("rest_speed", [None, 0.02])
def test_a_bounce_ends_where_its_law_says(rest_speed):
    """At most two impacts a period (a third would be refused by the budget of two events), then rest for good."""
    ran = run([0.5], [-0.5 * G], [[1.0]], [Law("floor", 0.8, rest_speed)], [0.1, 0.0], 1400, events=2)
    v, bound = np.sqrt(2 * G * 0.1), max(G * T / 2, rest_speed or 0)
    ends = v / G
    while (v := 0.8 * v) > bound:
        ends += 2 * v / G
    assert np.flatnonzero(ran.held[:, 0])[0] == pytest.approx(ends / T, abs=1)
    assert ran.held[round(ends / T) + 1 :].all() and np.abs(ran.q[round(ends / T) + 1 :]).max() < 1e-12


def juggling(e, omega, share):
    """Return (a, phase, speed of the ball after) of the plate and the orbit of one bounce a period (Schaal and Sternad 1993).

    At impact the plate moves with g tau (1 - e)/(2 (1 + e)) and decelerates; ``share`` of the stable range.
    """
    tau = 2 * np.pi / omega
    speed = G * tau * (1 - e) / (2 * (1 + e))
    slowing = share * 2 * G * (1 + e**2) / (1 + e) ** 2
    phase = np.arctan2(slowing / omega**2, speed / omega)
    return speed / (omega * np.cos(phase)), phase, G * tau / 2


def flights(q, w, plate, e, until):
    """Return the impacts (t, w after) of a ball over the plate: flight in closed form, touch by bracketing."""
    a, omega, phase = plate
    t, found = 0.0, []

    def gap(s):
        return q + w * s - G * s * s / 2 - a * np.sin(omega * (t + s) + phase)

    while True:
        s = 1e-6
        while gap(s) > 0:
            s += 1e-3
        s = brentq(gap, s - 1e-3, s, xtol=1e-16, rtol=1e-15)
        if t + s > until:
            return found
        q, w = q + w * s - G * s * s / 2, w - G * s
        t += s
        w = (1 + e) * a * omega * np.cos(omega * t + phase) - e * w
        found.append((t, q, w))


def test_juggling_settles_on_its_orbit_with_the_multiplier_e():
    """2.37 Hz is no whole number of ticks. Disturbed by 3 %; every flight is that of an independent event search."""
    e, omega = 0.7, 2 * np.pi * 2.37
    a, phase, rebound = juggling(e, omega, 0.5)
    start = [a * np.sin(phase) + 1e-9, 1.03 * rebound]
    ran = run([0.03], [-0.03 * G], [[1.0]], [Law("plate", e)], start, 3000, plate=(a, omega, phase))
    assert not ran.held.any()
    hits = flights(*start, (a, omega, phase), e, 3.0)
    t = T * np.arange(1, 3001)
    for (t0, q0, w0), (t1, _, _) in zip(hits, hits[1:], strict=False):
        flying = (t0 + 1e-6 < t) & (t < t1 - 1e-6)
        s = t[flying] - t0
        assert np.abs(ran.q[flying, 0] - (q0 + w0 * s - G * s * s / 2)).max() < 1e-11
        assert np.abs(ran.w[flying, 0] - (w0 - G * s)).max() < 1e-10
    # two impacts multiply a disturbance of the orbit by determinant e^2 each: it dies as e^k
    misses = np.abs([w0 - rebound for _, _, w0 in hits])
    assert misses[-1] < 3 * 0.03 * rebound * e ** (len(hits) - 1)


@pytest.mark.slow
@pytest.mark.parametrize("balls, incoming", [(3, 1), (4, 2), (5, 1)])
def test_newtons_cradle_swings(balls, incoming):
    """Equal pendulums a hair apart in touch: what is let go on the left swings out on the right, without loss."""
    m, spring, lift = 0.05, 0.05 * 40.0, 0.03
    omega = np.sqrt(spring / m)
    rows = [[(-1.0 if j == i else 1.0 if j == i + 1 else 0.0) for j in range(balls)] for i in range(balls - 1)]
    start = [-lift] * incoming + [0.0] * (balls - incoming) + [0.0] * balls
    laws = [Law(f"c{i}", 1.0) for i in range(balls - 1)]
    ticks = round(2.6 * np.pi / omega / T)
    ran = run([m] * balls, [0.0] * balls, rows, laws, start, ticks, spring=spring, events=4)
    t = T * np.arange(1, ticks + 1)
    angle = omega * t
    left, right = -lift * np.maximum(np.cos(angle), 0), -lift * np.minimum(np.cos(angle), 0)
    for i in range(balls):
        expected = (left if i < incoming else 0) + (right if i >= balls - incoming else 0)
        assert np.abs(ran.q[:, i] - expected).max() < 1e-11
    energy = 0.5 * m * (ran.w**2).sum(1) + 0.5 * spring * (ran.q**2).sum(1)
    assert np.abs(energy - incoming * 0.5 * spring * lift**2).max() < 1e-14


STACK = {"masses": [0.5, 0.02], "rows": [[1.0, 0.0], [-1.0, 1.0]]}


def test_a_stack_bounces_as_one_body_if_all_is_at_once():
    """Dropped together, the simultaneous law gives both e v: the stack is one ball, until it rests."""
    laws = [Law("floor", 0.6), Law("between", 0.6)]
    ran = run(
        forces=[-0.5 * G, -0.02 * G], laws=laws, start=[0.05, 0.05, 0, 0], ticks=900, order="simultaneous", events=4, **STACK
    )
    expected = np.array([bouncing((k + 1) * T, 0.05, 0.6)[0] for k in range(900)])
    assert np.abs(ran.q - expected[:, None]).max() < 1e-11
    assert ran.held[-1].all()


def test_a_stack_throws_its_upper_ball_in_sequence():
    """The superball: after the floor, M goes up with e v and meets m that comes down with v."""
    M, m, e, height = 0.5, 0.02, 0.9, 0.05
    ran = run(
        forces=[-M * G, -m * G], laws=[Law("floor", e), Law("between", e)], start=[height, height, 0, 0], ticks=150, **STACK
    )
    v = np.sqrt(2 * G * height)
    thrown = (-m * v + M * e * v + M * e * (e * v + v)) / (m + M)
    stayed = (-m * v + M * e * v - m * e * (e * v + v)) / (m + M)
    s = 150 * T - v / G
    assert ran.q[-1] == pytest.approx([stayed * s - G * s * s / 2, thrown * s - G * s * s / 2], abs=1e-12)
    assert ran.w[-1] == pytest.approx([stayed - G * s, thrown - G * s], abs=1e-12)


@pytest.mark.wide
def test_a_box_lands_on_two_corners_whatever_their_order():
    """Flat, it rebounds flat with e; tilted, the first corner turns it; the listing of the corners changes nothing."""
    half, inertia = 0.2, 0.02
    corners = [[1.0, half], [1.0, -half]]
    for tilt in (0.0, 0.03):
        runs = []
        for order in permutations((0, 1)):
            rows, laws = [corners[i] for i in order], [Law(f"corner{i}", 0.4) for i in order]
            runs.append(run([1.0, inertia], [-G, 0.0], rows, laws, [0.05, tilt, 0, 0], 800, order="simultaneous", events=4))
        ran, again = runs
        assert np.abs(ran.q - again.q).max() < 1e-12
        if tilt == 0:
            expected = np.array([bouncing((k + 1) * T, 0.05, 0.4)[0] for k in range(800)])
            assert np.abs(ran.q[:, 0] - expected).max() < 1e-12 and np.abs(ran.q[:, 1]).max() < 1e-12
        # at rest on both corners in the end
        assert ran.held[-1].all() and np.abs(ran.q[-1]).max() < 1e-12


def test_a_resting_body_leaves_a_plate_that_falls_faster_than_it():
    """On a plate a sin(omega t) a body lifts off where a omega^2 sin(omega t) = g, with the speed of the plate there."""
    a, omega = 0.004, 2 * np.pi * 9.3
    ran = run([0.1], [-0.1 * G], [[1.0]], [Law("plate", 0.0)], [0.0, a * omega], 60, plate=(a, omega, 0.0), events=4)
    off = np.arcsin(G / (a * omega**2)) / omega
    t = T * np.arange(1, 61)
    riding = t < off - 1e-9
    assert ran.held[riding, 0].all()
    assert np.abs(ran.q[riding, 0] - a * np.sin(omega * t[riding])).max() < 1e-13
    after = (t > off) & (t < off + 0.02)
    s = t[after] - off
    flown = a * np.sin(omega * off) + a * omega * np.cos(omega * off) * s - G * s * s / 2
    assert not ran.held[after, 0].any()
    assert np.abs(ran.q[after, 0] - flown).max() < 1e-12


@pytest.mark.parametrize("order", ["sequential", "simultaneous"])
@pytest.mark.always("simultaneous")
def test_the_energy_books_of_impacts_close(order):
    """Energy at the start = energy now + what impacts lost, at every tick, through bounces, blows and rest."""
    m = [0.3, 0.1]
    laws = [Law("floor", 0.7), Law("between", 0.7)]
    ran = run(m, [-g * G for g in m], STACK["rows"], laws, [0.05, 0.08, 0, 0], 500, order=order, events=5)
    energy = 0.5 * (m * ran.w**2).sum(1) + G * (m * ran.q).sum(1)
    start = G * (0.3 * 0.05 + 0.1 * 0.08)
    assert np.abs(start - energy - ran.lost).max() < 1e-13
    assert (np.diff(ran.lost) >= -1e-15).all() and ran.lost[-1] > 0.5 * start


def test_a_juggled_ball_gets_from_the_plate_what_its_impacts_lose():
    """Work of the plate in the impacts = energy gained + energy lost, and on the orbit nothing is gained."""
    e, omega = 0.7, 2 * np.pi * 2.37
    a, phase, rebound = juggling(e, omega, 0.5)
    plate = (a, omega, phase)
    ran = run([0.03], [-0.03 * G], [[1.0]], [Law("plate", e)], [a * np.sin(phase) + 1e-9, rebound], 1500, plate=plate)
    energy = 0.5 * 0.03 * ran.w[:, 0] ** 2 + 0.03 * G * ran.q[:, 0]
    assert np.abs(ran.work - (energy - energy[0]) - ran.lost).max() < 1e-12
    speed = G * 2 * np.pi / omega * (1 - e) / (2 * (1 + e))
    one = 0.03 * (2 * rebound) * speed  # impulse m 2 v by the plate's speed
    assert ran.work[-1] == pytest.approx(3 * one, rel=1e-6)


def test_what_an_impact_needs_is_traced_from_the_motion():
    """A rod that falls on its end with friction: J, M^-1 J^T, rates and second derivatives, against those by hand."""
    b, mass, half, angle, spin = Builder("f64"), 0.5, 0.4, 0.6, 1.3
    inertia, leaves = mass * half**2 / 3, {}

    def touches(tau, q, w, s, new):
        leaves.update(push=new(), rub=new())
        return [contact(q[1] - half * sin(q[2]), leaves["push"])]

    def slip(q, w):
        return w[0] + half * sin(q[2]) * w[2]

    def rates(tau, q, w, s):
        push, rub = leaves["push"], leaves["rub"]
        turn = (half * sin(q[2]) * rub - half * cos(q[2]) * push) * (1 / inertia)
        return [rub * (1 / mass), push * (1 / mass) - G, turn], []

    motion = motion_of(b, rates, 3, events=touches)
    law = Law("floor", 0.5, slip=1, mu=0.3)
    impacts = impacts_of(motion, [law], [0], T, slips=[slip(motion.q, motion.w)], rubs=[leaves["rub"]])
    state = [0.0, half * np.sin(angle), angle], [0.4, -2.0, spin]
    values = {leaf.id: np.float64(value) for part, group in zip(state, (motion.q, motion.w), strict=True)
              for leaf, value in zip(group, part, strict=True)}  # fmt: skip

    def at(value):
        series = Series(b.instructions, {k: [v] for k, v in values.items()}, lambda p: b.instructions[p].value)
        return float(series.of(value, 0)[0])

    c, s = half * np.cos(angle), half * np.sin(angle)
    assert [[at(v) for v in row] for row in impacts.rows] == [[0, 1, pytest.approx(-c)], [1, 0, pytest.approx(s)]]
    assert at(impacts.rates[0]) == pytest.approx(-2.0 - c * spin) and at(impacts.biases[0]) == pytest.approx(s * spin**2)
    (w, (resting,)), before = impacts(at, [True], [False]), state[1]
    W, cross, N = 1 / mass + c**2 / inertia, -c * s / inertia, 1 / mass + s**2 / inertia
    p, rub = with_friction(W, cross, N, -2.0 - c * spin, 0.4 + s * spin, 0.5, 0.3)
    assert w == pytest.approx([0.4 + rub / mass, -2.0 + p / mass, spin + (s * rub - c * p) / inertia], rel=1e-12)
    lost = 0.5 * (mass * before[0] ** 2 + mass * 4 + inertia * spin**2 - mass * (w[0] ** 2 + w[1] ** 2) - inertia * w[2] ** 2)
    assert impacts.sums["impact_loss", 0] == pytest.approx(lost, rel=1e-12) and not resting


def test_an_instant_leaves_no_gap_under_what_rests():
    struck = strike([[2.0, -1.0], [-1.0, 2.0]], [-1e-3, 5e-4], [-9.81, 0.0], [True, True], [Law("a", 0.5), Law("b", 0.5)], T)
    assert struck.resting == [True, True] and struck.u == [0.0, 0.0]
    # pulled apart, the second lets go
    assert release([[2.0, -1.0], [-1.0, 2.0]], [-9.81, 20.0], [True, True]) == [True, False]


def test_friction_of_an_impact_acts_on_the_slip_row():
    """A puck that slides along a wall it strikes: |p_t| = mu p_n, through the row of its slip."""
    m = 0.2
    struck = strike([[1 / m, 0.0], [0.0, 1 / m]], [-2.0, 3.0], [0.0, 0.0], [True], [Law("wall", 0.5, slip=1, mu=0.25)], T)
    assert struck.p == pytest.approx([m * 3.0, -0.25 * m * 3.0], rel=1e-14)
    assert struck.u == pytest.approx([1.0, 3.0 - 0.75], rel=1e-14)
    before, after = 0.5 * m * (4 + 9), 0.5 * m * (1.0 + 2.25**2)
    assert sum(struck.lost) == pytest.approx(before - after, rel=1e-13)


def test_micro_impulses_hold_a_stack():
    """Two bodies hover within their envelopes for two seconds; the mean impulses are their weights."""
    m, laws, W = [0.3, 0.1], [Law("floor", 0.5), Law("between", 0.5)], [[1 / 0.3, -1 / 0.3], [-1 / 0.3, 1 / 0.3 + 1 / 0.1]]
    q, w, total, lowest = np.array([5e-5, 1e-4]), np.zeros(2), np.zeros(2), 0.0
    for tick in range(2000):
        q, w = q + w * T - G * T * T / 2, w - G * T
        p, _ = micro_impulses(W, [w[0], w[1] - w[0]], [-G, 0.0], [q[0], q[1] - q[0]], laws, [1e-4, 1e-4], T)
        w = w + [(p[0] - p[1]) / m[0], p[1] / m[1]]
        total += p if tick >= 1000 else np.zeros(2)
        lowest = min(lowest, q[0], q[1] - q[0])
    assert total / 1000 == pytest.approx([0.4 * G * T, 0.1 * G * T], rel=2e-3)
    assert lowest > -3e-5 and q[1] < 3e-4


def squeezed(law, path, gravity=9.81, hold="soh", real="float64", ticks=450):
    """A puck between a floor at -30 mm and a handle above it that goes along ``path``; returns places and log of a run."""
    m, g, o = hl.parameters("m g o", units="kg m/s^2 m", values=(0.1, gravity, 0.03))
    y = hl.coordinate("y", unit="m", initial=-0.01)
    floor, hand = hl.contact.Contact(y + o, law, name="floor"), hl.contact.Contact(hl.x(hl.t) - y, law, name="hand")
    felt = hl.contact.felt_impulse(hand, tau="5 ms")
    motion = hl.mechanics.lagrange(m * y.diff(hl.t) ** 2 / 2 - m * g * y, contacts=[floor, hand])
    scene = hl.Scene(felt.force, [motion, *felt.equations], watch={"y": y})
    program = hl.compile(scene, T=T, method="taylor", dtype=real, hold=hold, live=())
    x = path(T * np.arange(ticks))
    rows = np.column_stack([x] + [np.gradient(x, T)] * (len(program.inputs) - 1))
    return load(program).run(ticks, rows).outputs[:, 1, 0], x, program


LAWS = [hl.contact.rigid(), hl.contact.impulse(e=0.5), hl.contact.impulse(e=0.5, impacts="simultaneous")]


@pytest.mark.parametrize("law, gravity", [*((law, 9.81) for law in LAWS), (LAWS[0], 0.001)], ids=str)
def test_no_force_keeps_the_handle_from_what_lies_on_the_floor(law, gravity):
    """An imposed handle at 0.1 m/s reaches the floor at 0.3 s: nothing that is computed after that may look sound."""
    y, x, program = squeezed(law, lambda t: -0.1 * t, gravity, real="float32" if gravity > 1 else "float64")
    bad = np.flatnonzero(~np.isfinite(y))
    assert bad.size and bad[0] <= 305 and not np.isfinite(y[bad[0] :]).any()
    assert (y[: bad[0]] >= -0.03 - 1e-6).all() and (y[: bad[0]] <= x[: bad[0]] + 2e-4).all()
    (note,) = (note for note in program.notes if "no force keeps contacts apart (floor, hand)" in note)
    assert "Use penalty, or a coupler between handle and body" in note


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_handle_that_only_comes_near_is_no_fault(law):
    y, x, _ = squeezed(law, lambda t: -0.0299 * np.sin(10 * t) ** 2)
    assert np.isfinite(y).all() and y.min() > -0.03 - 1e-9 and (y - x).max() < 1e-4


def test_a_paddle_that_presses_a_puck_on_a_wall_stops_with_what_to_do():
    m, o = hl.parameters("m o", units="kg m", values=(0.1, 0.03))
    y = hl.coordinate("y", unit="m", initial=0.01)
    wall, hand = (
        hl.contact.Contact(o - y, hl.contact.rigid(), name="wall"),
        hl.contact.Contact(y - hl.x(hl.t), hl.contact.rigid(), name="hand"),
    )
    felt = hl.contact.felt_impulse(hand, tau="5 ms")
    motion = hl.mechanics.lagrange(m * y.diff(hl.t) ** 2 / 2, contacts=[wall, hand])
    scene = hl.Scene(felt.force, [motion, *felt.equations], watch={"y": y})
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=T, hand=hl.Hand(push=1.0)).run(scene, duration=0.2, method="taylor")
    assert "no force keeps contacts apart" in log.fault and "Use penalty" in log.fault
    assert np.nanmax(log.y) <= 0.03 + 1e-6


def test_impossible_is_told_from_rounding():
    W, both = [[1.0, -1.0], [-1.0, 1.0]], [True, True]
    assert impossible(W, [0.0, -0.1], both, 0.1)
    assert not impossible(W, [0.0, -1e-10], both, 0.1) and not impossible(W, [1e-17, -2e-17], both, 2e-17)
    assert not impossible(W, [0.0, -0.1], [True, False], 0.1)
    assert impossible([[1.0, 0.0], [0.0, 1.0]], [-0.1, -0.1], both, 0.1) is False  # apart, each can be pushed away
