"""Velocity estimators, pulses on entry and damping compensation in numbers: writes docs/explanation/velocities.md.

    python tests/benchmarks/velocities.py [--write]

The same numbers on every computer, to the digits shown. Some 10 s.
"""

import sys
from pathlib import Path

import numpy as np

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "velocities.md"
T, COUNT, B = 1e-3, 20e-6, 0.1
SPREAD = COUNT / np.sqrt(12)
PINCH = {"m": 0.02, "b": 1.0, "k": 200}
#: a hobby paddle at the handle, with and without what a linear limit leaves out
ROUGH = hl.SimulatedPaddle(m=0.03, b=B, T=T, counts_per_metre=1 / COUNT, coulomb=0.02, hand=hl.Hand(**PINCH, push=2.0))
SMOOTH = hl.SimulatedPaddle(m=0.03, b=B, T=T, hand=hl.Hand(**PINCH))
STIFFNESS = np.geomspace(300, 60e3, 97)


def estimates():
    return {
        "backward difference": hl.velocity.backward(),
        "filtered, tau = 1 ms": hl.velocity.filtered(tau=1e-3),
        "filtered, tau = 4 ms": hl.velocity.filtered(tau=4e-3),
        "window of 2": hl.velocity.window(deviation=COUNT, longest=2),
        "window of 4": hl.velocity.window(deviation=COUNT, longest=4),
        "window of 8": hl.velocity.window(deviation=COUNT, longest=8),
        "window of 4, best fit": hl.velocity.window(deviation=COUNT, longest=4, fit="best"),
        "Kalman, 50 m/s^2": hl.velocity.kalman(acceleration=50, noise=SPREAD),
        "Kalman, 5 m/s^2": hl.velocity.kalman(acceleration=5, noise=SPREAD),
        "Kalman from the start, 5 m/s^2": hl.velocity.kalman(acceleration=5, noise=SPREAD, steady=False),
    }


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def errors():
    hand = hl.Hand(k=400, b=3, intent=lambda t: 0.006 * np.sin(3 * np.pi * t) ** 2 + 0.001 * np.sin(6 * np.pi * t) ** 2)
    log = hl.SimulatedPaddle(m=0.03, b=B, T=T, counts_per_metre=1 / COUNT, hand=hand).run(hl.wall()(k=0), duration=2.0)
    found = hl.velocity.compare(log, list(estimates().values())[1:])
    rows = [
        [name, f"{1e3 * row.lag:.1f}", f"{1e3 * row.noise:.1f}", row.cycles, "yes" if row.fits else "no"]
        for name, row in zip(estimates(), found.rows, strict=True)
    ]
    return table(["velocity", "lag [ms]", "noise [mm/s]", "cycles on the Uno", "damper fits at 1 kHz"], rows)


def largest_quiet(wall):
    """Return the largest stiffness up to which no wall chatters by more than a count [N/m]."""
    loud = hl.sweep(wall(x_o=0.005), ROUGH, duration=1.0, metric="chatter", k=STIFFNESS).values > COUNT
    return STIFFNESS[np.argmax(loud) - 1] if loud.any() else np.inf


def walls():
    rows = []
    for name, estimate in {"none, (23.1)": None, **estimates()}.items():
        law = "half_sample" if estimate else "zoh"
        exact = "no fixed poles"
        if not estimate or estimate.is_linear:
            exact = f"{hl.stability_limit(SMOOTH, law=hl.wall(law, unilateral=None, velocity=estimate)).K:.0f}"
        rows.append([name, exact, f"{largest_quiet(hl.wall(law, velocity=estimate)):.2g}"])
    return table(["velocity in (23.3)", "linear limit K [N/m]", "quiet up to K [N/m], simulated"], rows)


def pulses():
    m, speed = 0.05, 0.25
    wall, paddle = hl.wall()(k=500, x_o=0.0101), hl.SimulatedPaddle(m=m, b=0.3, T=T)
    scenes = {
        "the spring alone": wall,
        "braking pulse, 0.9 of the momentum in 1 period": hl.laws.braking_pulse(wall, part=0.9, mass=m),
        "the same in 3 periods": hl.laws.braking_pulse(wall, part=0.9, mass=m, periods=3),
        "the same, speed from 20 um counts, window of 3": hl.laws.braking_pulse(
            wall, part=0.9, mass=m, periods=3, entry=hl.laws.Entry(velocity=hl.velocity.window(deviation=COUNT, longest=3))
        ),
        "friction pulse, 2 N for 20 periods": hl.laws.friction_pulse(wall, friction=2.0, mass=m, periods=20),
    }
    rows = []
    for name, scene in scenes.items():
        here = paddle if "counts" not in name else hl.SimulatedPaddle(m=m, b=0.3, T=T, counts_per_metre=1 / COUNT)
        log = here.run(scene, duration=0.1, v=speed)
        x, v = (log.channels.get(f"{q}_true", getattr(log, q)) for q in "xv")
        entry = v[np.argmax(x >= 0.0101) - 1]
        cells = [f"{1e3 * (x.max() - 0.0101):.2f}", f"{-v.min() / entry:.2f}", f"{log.F.max():.1f}"]
        cells.append(cost(hl.compile(scene, T=T)).typical)
        rows.append([name, *cells])
    head = ["K = 500 N/m", "depth [mm]", "rebound/entry speed", "peak force [N]", "cycles on the Uno"]
    return table(head, rows)


def compensated():
    rows = []
    for delay in (0.0, 2e-3, 5e-3):
        for hand in (None, hl.Hand(k=200)):
            paddle = hl.SimulatedPaddle(m=0.05, b=0.4, T=T, coulomb=0.02, delay=delay, hand=hand)
            ideal, found = hl.design.compensation(paddle), hl.design.over_compensation(paddle, speed=2e-3)
            where = "held by 200 N/m" if hand else "free"
            rows.append([f"{1e3 * delay:g} ms, {where}", f"{ideal.viscous:.4f}", f"{ideal.dry:.4f}", f"{found.limit:.3f}"])
    return table(["delay, handle", "viscous part, exact", "dry part, ideal", "dry part, simulated"], rows)


TEXT = """# Velocity estimators, pulses on entry and compensated friction, in numbers

Written by `tests/benchmarks/velocities.py`. T = 1 ms, encoder counts of 20 um.

## What an estimate costs

`hl.velocity.compare` on two seconds of a smooth motion at up to 60 mm/s, where one count per period is 20 mm/s. The lag is
the component of the error along the acceleration, and the noise is the rest of the error. The cycles are those of a virtual
damper with this velocity.

{errors}

At the same lag, a window is somewhat smoother than a filter but needs four to ten times the cycles. The steady Kalman
filter is smoother than either and needs nine instructions. The acceleration that a Kalman filter assumes sets its lag: one
that expects a large acceleration predicts ahead, and makes more noise than the difference itself.

## In a wall: a smooth velocity is late

Eq. (23.3) with each velocity: 30 g, 0.1 N s/m, a pinching hand. Left column: the exact linear limit, with the spring always
acting and the velocity undisturbed by counts. Right column: the largest K up to which no wall chatters by more than a
count, with the encoder, Coulomb friction of 20 mN and a push of 2 N (one second each, K in steps of 6 %).

{walls}

The prediction of Eq. (23.3) is half a sample; a filter of 1 ms is late by one and a half samples. So a filter on the
velocity removes the advantage of the prediction. Use the filter for a damper whose noise is felt. For the prediction use
the difference, or a Kalman filter that expects accelerations as large as those of a contact.

## Pulses on entry

A handle of 50 g and 0.3 N s/m, thrown at 0.25 m/s from 10 mm before the wall, which it enters at 0.19 m/s.

{pulses}

The brake dissipates the energy that the spring would have stored and that the hold would have returned with a surplus. The
brake needs the speed at one instant. With an encoder, a difference over one period could be wrong by 20 mm/s at 190 mm/s.

## Compensated friction

50 g, 0.4 N s/m and 20 mN, `hl.design.compensation`, and `hl.design.over_compensation` at a `speed` of 2 mm/s. A free handle
drifts away if all its damping is compensated, whatever the delay. Against a spring, the delay changes the phase of the
negative damper, so more of the damping can be fed back before the oscillation grows. There, more than all of the dry
friction can be compensated, because the handle must break away at each reversal; the width of the sign's dead zone and a
delay increase this fraction further.

{compensated}
"""


def page():
    return TEXT.format(**{part.__name__: part() for part in (errors, walls, pulses, compensated)})


if __name__ == "__main__":
    text = page()
    if "--write" in sys.argv:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text, "utf-8")
    print(text)
