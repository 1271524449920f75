"""A map of hl.chatter's verdicts against exact limit cycles: plants, laws, stiffnesses, starts and lengths of the record.

    python tests/benchmarks/chatter_map.py
    python tests/benchmarks/chatter_map.py --random
    python tests/benchmarks/chatter_map.py --random 3

PLANTS and most of RATIOS are those on which the constants of the verdict were chosen. ``--random`` takes nine other plants
and eight other ratios; ``--random 3`` draws them from another seed. docs/how_to/measuring.md has the numbers.

The reference knows nothing of hapticlab. Handle, hand and law are one affine map for each side of the wall's edge, from the
matrix exponential. It is followed from the start until the motion has ended, which says whether there is a cycle; a cycle
that repeats itself is then solved for as the fixed point of its own sequence of maps, and its eigenvalues say that it
attracts. Where none repeats itself, as on stiff walls with the backward difference, the motion is irregular and only its fate
counts. The border is the stiffness at which an eigenvalue of the map inside leaves the unit circle. The records are runs
of hl.SimulatedPaddle.

A verdict is wrong where it says "decaying" or "none" of a motion that ends in a cycle, or "chatter" or "growing" of one that
ends at rest. The starts are a drop from 9, 3 and 1.3 times the cycle's height or, where there is no
cycle, of the depth at rest; half of it; and a twentieth.
"""

from __future__ import annotations

import sys
from collections import Counter
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.base.telemetry import Telemetry

#: taps on x(n), x(n-1), x(n-2) for each N/m; a damper as a part of the handle's own; whole samples of delay
LAWS = {
    "plain": ((1.0, 0.0, 0.0), 0.0, 0),
    "with a damper": ((1.0, 0.0, 0.0), 0.5, 0),
    "backward difference": ((1.5, -0.5, 0.0), 0.0, 0),
    "a sample late": ((1.0, 0.0, 0.0), 0.0, 1),
}
RATIOS = (0.5, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0)
STARTS = {"9 times": 9.0, "3 times": 3.0, "1.3 times": 1.3, "half": 0.5, "a twentieth": 0.05}
DURATIONS = (1.0, 2.0, 4.0, 8.0)
#: followed for so long [s] a motion this near its border has ended, or shows that it never will
LONG = 60.0
SEED = 20261124
NEAR = 0.1


class Plant(NamedTuple):
    """Handle and hand: mass [kg], damping [N s/m], period [s], push [N], stiffness of the hand [N/m]."""

    m: float
    b: float
    T: float
    push: float
    k: float = 0.0


PLANTS = (
    Plant(0.05, 0.3, 1e-3, 1.0), Plant(0.05, 0.1, 1e-3, 0.5), Plant(0.09, 0.5, 1e-3, 2.0), Plant(0.03, 0.2, 5e-4, 1.0),
    Plant(0.05, 0.5, 1e-3, 1.0, 50.0), Plant(0.1, 1.0, 2e-3, 3.0, 20.0), Plant(0.02, 0.4, 1e-3, 0.3),
)  # fmt: skip


def random_plants(number=9, seed=SEED):
    """Plants on which nothing was chosen: 15 to 200 g, 0.08 to 1.5 N s/m."""
    rng, log = np.random.default_rng(seed), np.log
    for _ in range(number):
        m, b = rng.uniform(0.015, 0.2), np.exp(rng.uniform(log(0.08), log(1.5)))
        T, push = rng.choice([5e-4, 1e-3, 2e-3]), rng.uniform(0.3, 3)
        yield Plant(float(m), float(b), float(T), float(push), float(rng.choice([0, 0, 40, 150])))


class Orbit(NamedTuple):
    """An exact cycle: its amplitude [m], how often the force begins to act [1/s], and the contacts in one cycle."""

    amplitude: float
    rate: float
    contacts: int


class Case(NamedTuple):
    """One motion: the plant, the law, the stiffness [N/m] and its ratio to the border, the start [m] and its name."""

    plant: Plant
    law: str
    K: float
    ratio: float
    x: float
    start: str = ""


def period_map(plant, law, K, inside):
    """One period on (x, v, x(n-1), x(n-2), the force one sample late), as a matrix and a constant."""
    A = np.zeros((3, 3))
    A[0, 1], A[1] = 1.0, [-plant.k / plant.m, -plant.b / plant.m, 1 / plant.m]
    whole = expm(A * plant.T)
    taps, damper, late = LAWS[law]
    row = np.zeros(5)
    if inside:
        row[[0, 2, 3]] = K * np.array(taps) + damper * plant.b / plant.T * np.array([1.0, -1.0, 0.0])
    M = np.zeros((5, 5))
    M[:2, :2], M[2, 0], M[3, 2] = whole[:2, :2], 1.0, 1.0
    if late:
        M[:2, 4], M[4] = -whole[:2, 2], row
    else:
        M[:2] -= np.outer(whole[:2, 2], row)
    return M, np.r_[whole[:2, 2] * plant.push, 0.0, 0.0, 0.0]


def border(plant, law):
    """The stiffness at which the handle that stays in the wall becomes unstable [N/m]."""
    low, high = 1.0, 1.0
    while abs(np.linalg.eigvals(period_map(plant, law, high, True)[0])).max() < 1:
        low, high = high, 1.05 * high
    for _ in range(50):
        middle = (low + high) / 2
        stable = abs(np.linalg.eigvals(period_map(plant, law, middle, True)[0])).max() < 1
        low, high = (middle, high) if stable else (low, middle)
    return low


def followed(cases, seconds, kept):
    """The positions in the last ``kept`` samples of every case, all of one plant, and the states at their beginning."""
    inside, outside = ([period_map(c.plant, c.law, c.K, side) for c in cases] for side in (True, False))
    A, B = (np.array([M for M, _ in side]) for side in (inside, outside))
    more, push, state = A - B, inside[0][1], np.zeros((len(cases), 5))
    state[:, 0] = state[:, 2] = state[:, 3] = [c.x for c in cases]
    steps, x = round(seconds / cases[0].plant.T), np.empty((kept, len(cases)))
    for n in range(steps):
        if n >= steps - kept:
            x[n - steps + kept] = state[:, 0]
        acts = state[:, 0] >= 0
        state, was = (B @ state[:, :, None])[:, :, 0] + push, state
        state[acts] += (more[acts] @ was[acts][:, :, None])[:, :, 0]
    return x


def orbit(case, x, longest=1500):
    """The exact cycle that x has locked onto, or None where x has not; wrong only if x is."""
    size = np.ptp(x)
    for p in range(2, min(longest, len(x) // 3)):
        if abs(x[-1] - x[-1 - p]) < 1e-5 * size and abs(x[p:] - x[:-p])[-2 * p :].max() < 1e-5 * size:
            break
    else:
        return None
    M, c = np.eye(5), np.zeros(5)
    sides = {side: period_map(case.plant, case.law, case.K, side) for side in (True, False)}
    inside = x[-p - 1 : -1] >= 0
    for side in inside:
        one, push = sides[bool(side)]
        M, c = one @ M, one @ c + push
    if abs(np.linalg.eigvals(M)).max() >= 1:
        return None
    state, cycle = np.linalg.solve(np.eye(5) - M, c), []
    for side in inside:
        cycle.append(state[0])
        one, push = sides[bool(side)]
        state = one @ state + push
    if not np.array_equal(np.array(cycle) >= 0, inside):
        return None
    contacts = int(np.count_nonzero(inside & ~np.roll(inside, 1)))
    return Orbit(float(np.ptp(cycle) / 2), contacts / (p * case.plant.T), contacts)


def cases_of(plant, laws=tuple(LAWS), ratios=RATIOS, seconds=LONG):
    """The cases of one plant, and for each whether it ends in a cycle, and its Orbit or None."""
    drops = []
    for law in laws:
        limit = border(plant, law)
        drops += [Case(plant, law, r * limit, r, -0.4 * plant.m * plant.push) for r in ratios]
    lowest = followed(drops, seconds, round(2 / plant.T)).min(axis=0)
    cases = []
    for drop, low in zip(drops, lowest, strict=True):
        depth = plant.push / (drop.K + plant.k)
        for name, part in STARTS.items():
            size = -low * part if low < 0 else depth * (part if part > 1 else part - 1)
            cases.append(drop._replace(x=-size, start=name))
    x = followed(cases, seconds, round(3 / plant.T))
    return [(c, bool(x[:, i].min() < 0), orbit(c, x[:, i]) if x[:, i].min() < 0 else None) for i, c in enumerate(cases)]


def recorded(case, duration):
    """The record of hapticlab's own simulated paddle."""
    plant, (_, damper, late) = case.plant, LAWS[case.law]
    hand = hl.Hand(k=plant.k, push=plant.push)
    paddle = hl.SimulatedPaddle(m=plant.m, b=plant.b, T=plant.T, delay=late * plant.T, hand=hand)
    scene = hl.wall("backward_difference" if case.law == "backward difference" else "zoh")
    bound = scene(k=case.K, B=damper * plant.b)
    return paddle.run(bound, duration=duration, x=case.x, dtype="float64", progress=False)


def verdicts(case, log, durations=DURATIONS):
    """What hl.chatter finds in the first part of a record, for each duration [s]."""
    for duration in durations:
        n = round(duration / case.plant.T)
        yield duration, hl.chatter(Telemetry(t=log.t[:n], x=log.x[:n], v=log.v[:n], F=log.F[:n], T=log.T))


def outcome(found, lasts):
    """Whether a verdict is right, wrong or undecided."""
    if found.state == "undecided":
        return "undecided"
    return "right" if (found.state in ("chatter", "growing")) == lasts else "wrong"


def measured(plants=PLANTS, durations=DURATIONS, **options):
    """Count (law, duration, near the border, outcome); and list what else is found of each verdict on a cycle."""
    counts, cycles = Counter(), []
    for plant in plants:
        for case, lasts, exact in cases_of(plant, **options):
            log = recorded(case, max(durations))
            for duration, found in verdicts(case, log, durations):
                near = abs(case.ratio - 1) <= NEAR + 1e-9
                counts[case.law, duration, near, outcome(found, lasts)] += 1
                cycles.append((case, duration, lasts, exact, found))
    return counts, cycles


def table(counts):
    """The map as a table in Markdown: right, wrong and undecided by duration and distance from the border."""
    lines = ["| record | from the border | right | wrong | undecided |", "|---|---|---|---|---|"]
    for duration in sorted({key[1] for key in counts}):
        for near in (True, False):
            right, wrong, open_ = (
                sum(n for (_, d, b, o), n in counts.items() if (d, b, o) == (duration, near, name))
                for name in ("right", "wrong", "undecided")
            )
            where = "within 10 %" if near else "farther"
            share = 100 * open_ / max(1, right + wrong + open_)
            lines.append(f"| {duration:g} s | {where} | {right} | {wrong} | {open_} ({share:.1f} %) |")
    return "\n".join(lines)


def random_options():
    """The plants and ratios of ``--random``, by the seed behind it."""
    after = sys.argv[sys.argv.index("--random") + 1 :]
    plants = tuple(random_plants(seed=int(after[0]) if after else SEED))
    return {"plants": plants, "ratios": (0.7, 0.87, 0.93, 1.07, 1.13, 1.35, 1.7, 2.5), "seconds": 40.0}


def main():
    """Print the map, what is wrong, what is undecided at 4 s, and how well amplitudes and contacts are told."""
    counts, found = measured(**(random_options() if "--random" in sys.argv else {}))
    print(f"{sum(counts.values())} combinations\n\n{table(counts)}\n")
    for case, duration, lasts, _, verdict in found:
        kind = outcome(verdict, lasts)
        if kind == "wrong" or (kind == "undecided" and duration == 4):
            print(f"{duration:g} s, {case.law}, {case.ratio} times, {case.start}, {case.plant}, lasts: {lasts}: {verdict}")
    for duration in DURATIONS:
        solved = [(e, v) for _, d, _, e, v in found if d == duration and e and v.state == "chatter"]
        ends = [(v.ends_at, e.amplitude) for e, v in solved if v.ends_at]
        inside = np.mean([low * 0.98 <= e <= high * 1.02 for (low, high), e in ends])
        locked = [(e, v) for e, v in solved if v.locked]
        rates = [abs(v.contacts_per_second / e.rate - 1) for e, v in locked]
        tones = [abs(v.frequency / e.rate - 1) for e, v in locked if e.contacts == 1]
        print(f"{duration:g} s: {len(solved)} exact orbits called chatter; amplitude within the interval (2 %): {inside:.1%}; "
              f"settled: {len(locked)}, contacts/s off by {np.median(rates):.2%}, at most {max(rates):.2%}, frequency by "
              f"{np.median(tones):.2%}, at most {max(tones):.2%}")  # fmt: skip
    return 1 if any(o == "wrong" for *_, o in counts) else 0


if __name__ == "__main__":
    sys.exit(main())
