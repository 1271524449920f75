"""What a passivity controller changes, where it fails, and what it costs: writes docs/explanation/passivity_control.md.

    python tests/benchmarks/passivity_control.py [--write]

Simulated, in virtual time: the same numbers on every computer. Some 20 s.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, x
from hapticlab.compiler.boards.cost import cost

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "passivity_control.md"
M, B, T = 0.05, 0.1, 1e-3
STORED = hl.laws.Credit(stored=hl.laws.wall_energy())


def controlled(wall=None, *args, **options):
    return hl.laws.passivity_controller(wall or hl.wall(), *args, **({"alpha_max": 20.0} | options))


def variants():
    return {
        "plain, Eq. (23.1)": hl.wall(),
        "backward difference, Eq. (23.5)": hl.wall("backward_difference"),
        "series": controlled(),
        "series, predict": controlled(predict=True),
        "series, stored": controlled(credit=STORED),
        "series, stored, predict": controlled(credit=STORED, predict=True),
        "parallel, stored": hl.laws.passivity_controller(hl.wall(), "parallel", beta_max=20.0, credit=STORED),
    }


def table(head, rows):
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def bounces():
    """One bounce at 0.2 m/s off 500 N/m, without a hand."""
    paddle = hl.SimulatedPaddle(m=M, b=B, T=T)
    rows = []
    for name, scene in variants().items():
        log = paddle.run(scene(k=500), duration=0.2, x=-0.002, v=0.2, progress=False)
        W, outside = hl.energy(log).W, log.x < 0
        rows.append([
            name, f"{round(-1e3 * W[-1], 3) + 0.0:.3f}", f"{abs(1e3 * min(W.min(), 0)):.3f}", f"{abs(log.v[60]) / 0.2:.3f}",
            f"{log.F.max():.2f}", f"{abs(min(log.F[outside].min(), 0)):.2f}",
        ])  # fmt: skip
    return table(["law", "generated [mJ]", "most energy drawn [mJ]", "rebound after 60 ms", "peak [N]", "pull outside [N]"], rows)


def leaning():
    """A hand of 20 g that leans with 1 N on the wall for 4 s; amplitude over the last half second."""
    rows = []
    for name, scene in variants().items():
        cells = []
        for counts in (None, 25_000.0, 1 / 0.742e-3):
            paddle = hl.SimulatedPaddle(m=M, b=B, T=T, counts_per_metre=counts, hand=hl.Hand(m=0.02, push=1.0))
            for K in (300, 1000, 3000):
                log = paddle.run(scene(k=K, x_o=0.002), duration=4.0, progress=False)
                end = log.channels.get("x_true", log.x)[-500:]
                cells.append(f"{1e3 * np.ptp(end) / 2:.2f}")
        rows.append([name, *cells])
    head = ["law, amplitude [mm]"] + [f"{e}, {K} N/m" for e in ("exact x", "40 um", "742 um") for K in (300, 1000, 3000)]
    return table(head, rows)


def stiffest():
    """From which stiffness on a wall chatters by 0.1 mm or more in a hand with some damping; looked for in steps of 5 %."""
    rows, stiffness = [], 100 * 1.05 ** np.arange(120)
    for name, scene in (variants() | {"series, alpha_max = 1.4": controlled(alpha_max=1.4)}).items():
        cells = []
        for counts in (None, 25_000.0):
            hand = hl.Hand(m=0.02, b=0.5, k=100, push=1.0)
            paddle = hl.SimulatedPaddle(m=M, b=B, T=T, counts_per_metre=counts, hand=hand)
            amplitude = hl.sweep(scene(x_o=0.002), paddle, duration=3.0, k=stiffness).values
            loud = ~(amplitude < 1e-4)
            cells.append(f"{stiffness[np.argmax(loud)]:.0f}" if loud.any() else f"over {stiffness[-1]:.0f}")
        rows.append([name, *cells])
    return table(["law", "exact x [N/m]", "40 um [N/m]"], rows)


def dampers():
    """The same hand, 1000 N/m: how strong a damper the series form may use."""
    limit = hl.stability.damper_limit(hl.Device(m=M + 0.02, b=B, T=T))
    rows = []
    for part in (B / limit, 0.01, 0.1, 0.5, 0.9, 1.1, 2.0):
        cells = []
        for counts in (None, 25_000.0):
            paddle = hl.SimulatedPaddle(m=M, b=B, T=T, counts_per_metre=counts, hand=hl.Hand(m=0.02, push=1.0))
            log = paddle.run(controlled(alpha_max=part * limit)(k=1000, x_o=0.002), duration=4.0, progress=False)
            end = log.channels.get("x_true", log.x)[-500:]
            cells += [f"{1e3 * np.ptp(end) / 2:.3f}", f"{abs(np.diff(log.F)).max():.1f}"]
        rows.append([f"{part * limit:.3g}", f"{part:.3g}", *cells])
    head = ["amplitude after 4 s [mm]", "largest jump of F [N]"]
    head = [*(f"{name}, exact x" for name in head), *(f"{name}, 40 um" for name in head)]
    return table(["alpha_max [N s/m]", "of damper_limit", *head], rows)


def honey(stirring, reference=False, **struck_off):
    """Return how long the wall chatters by more than 2 mm after a hand that stirred honey leans on it [s], and W then [J]."""
    k, b_h, x_h = hl.parameters("k B_honey x_h", units="N/m N*s/m m", values=(1000, 1, -0.005))
    inside = sp.Max(x(n), 0)
    scene = hl.Scene(k * inside + hl.when(x(n) < x_h, b_h * (x(n) - x(n - 1)) / hl.T), name="honey before a wall")
    credit = hl.laws.Credit(stored=k * inside**2 / 2 if reference else 0, **struck_off)

    def intent(s):
        return np.where(s < stirring, -0.02 + 0.01 * np.sin(4 * np.pi * s), 0.006)

    paddle = hl.SimulatedPaddle(m=M, b=B, T=T, hand=hl.Hand(m=0.02, b=0.2, k=200, intent=intent))
    log = paddle.run(controlled(scene, credit=credit), duration=stirring + 4.0, x=-0.02, progress=False)
    late = log.t > stirring + 0.1
    away = abs(log.x[late] - np.median(log.x[-200:])) > 2e-3
    return log.t[late][away][-1] - stirring if away.any() else 0.0, hl.energy(log).W[round(stirring / T)]


def stirred():
    """The failure that the chapter names, and what cures it."""
    cures = {
        "series": {}, "series, stored": {"reference": True}, "series, forget = 50 ms": {"forget": 0.05},
        "series, stored, forget = 50 ms": {"reference": True, "forget": 0.05}, "series, credit_max = 1 mJ": {"credit_max": 1e-3},
    }  # fmt: skip
    times = (1.0, 2.0, 4.0, 8.0)
    paid = ["taken while stirring [mJ]", *(f"{1e3 * honey(stirring)[1]:.1f}" for stirring in times)]
    rows = [[f"{name}: chatter [s]", *(f"{honey(s, **options)[0]:.2f}" for s in times)] for name, options in cures.items()]
    return table(["", *(f"stirred {s:g} s" for s in times)], [paid, *rows])


def costs():
    """What an Uno has time for."""
    scenes = {
        "wall": hl.wall(), "observer": hl.laws.passivity_observer(hl.wall()), "series": controlled(),
        "series, force_max": controlled(force_max=2), "series, predict": controlled(predict=True),
        "series, credit_max": controlled(credit=hl.laws.Credit(credit_max=1e-3)),
        "series, forget": controlled(credit=hl.laws.Credit(forget=0.1)),
        "series, stored": controlled(credit=STORED),
        "series, stored, force_max, forget": controlled(credit=replace(STORED, forget=0.1), force_max=2),
        "series, stored, predict": controlled(credit=STORED, predict=True),
        "parallel, stored, force_max": hl.laws.passivity_controller(
            hl.wall(), "parallel", beta_max=20.0, credit=STORED, force_max=2
        ),
    }  # fmt: skip
    rows = []
    for name, scene in scenes.items():
        bound = scene(k=400, x_o=0.001)
        found = {period: cost(hl.compile(bound, T=period), board="uno") for period in (1e-3, 1.1e-3, 1.25e-3, 1.5e-3)}
        shortest = next(period for period, one in found.items() if one.fits)
        one = found[shortest]
        rows.append([name, str(one.instructions), str(one.typical), f"{1e3 * shortest:g}", f"{one.share:.0%}"])
    return table(["scene", "instructions", "cycles", "shortest T that fits [ms]", "used"], rows)


TEXT = """# The passivity controller: what it changes, where it fails, what it costs

Written by `tests/benchmarks/passivity_control.py`; simulated, so it is the same on every computer. A paddle of 50 g and 0.1
N s/m at 1 kHz, whose plain wall chatters in some hand above 200 N/m, Eq. (23.10). `hl.laws.passivity_controller` is
Hannaford and Ryu's (2002), with the work of the held force; `credit=hl.laws.Credit(stored=hl.laws.wall_energy())` makes it
act as soon as energy is generated, and not only after all the stored energy has been returned (Ryu, Preusche, Hannaford,
Hirzinger 2005). alpha_max = 20 N s/m, beta_max = 20 m/(N s).

## One bounce

A handle that is not held moves at 0.2 m/s, from 2 mm in front of the wall, into a wall of 500 N/m.

{bounces}

The plain series form dissipates the generated energy after the handle has left, so it pulls outside the wall. With `stored`
it brakes on the way out; with `predict` as well it is Eq. (23.5), and almost no generated energy remains. The parallel form
does not pull; its spring slips, and the energy that the last period inside generated remains.

## Leaning on the wall

A hand of 20 g, without damping or stiffness, pushes with 1 N for 4 s; the amplitude is that of the last half second.

{leaning}

The series forms end the chatter of all of these walls. With an encoder an oscillation of at most half a count remains. The
amplitude that remains after 4 s with exact x, and at 300 N/m, dies out with the device's own damping. The parallel form
makes the chatter worse: it returns no more energy than it took, so it ends no oscillation, and under a steady push the wall
sinks by the energy that it generates, which is work of the push and feeds the oscillation. Use the parallel form for
impacts, and for environments against which nobody pushes steadily.

## The stiffest wall

The lowest stiffness that chatters by 0.1 mm, in a hand of 20 g, 0.5 N s/m and 100 N/m that pushes with 1 N:

{stiffest}

The parallel form remains stable because its wall yields: within 3 s the wall has sunk from 2 mm to 10 mm, where the hand no
longer pushes, and the hand feels no force.

## How strong a damper

{dampers}

Up to the device's own b a sampled damper is passive in any hand, but it is too weak here. 1 % of
`hl.stability.damper_limit` of handle and hand is enough for this wall, and a tenth for the stiffest. A larger limit changes
little with exact x, because the controller uses no more damping than is needed to dissipate the generated energy. With an
encoder, one count is felt as alpha_max count/T: half of the limit makes force jumps of several newtons, the whole limit of
tens of newtons, and beyond the limit the controller chatters by itself.

## A human who is active for long

The hand stirs honey (1 N s/m, 2 Hz, 10 mm) next to a wall of 1000 N/m and then pushes against the wall. "If the human
operator is active for a long period of time, then the system driving the interface can be active for a long period of
time": the work of stirring is credit, and the controller waits until the chatter has used the credit.

{stirred}

Forgetting or bounding the credit reduces energy that was taken in and never energy that was generated, so the environment
stays passive, and the chatter no longer depends on the past. With `stored` alone the credit from the honey still counts.

## What an Uno has time for

{costs}
"""


def page():
    parts = (bounces, leaning, stiffest, dampers, stirred, costs)
    return TEXT.format(**{part.__name__: part() for part in parts})


if __name__ == "__main__":
    text = page()
    if "--write" in sys.argv:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text, "utf-8")
    print(text)
