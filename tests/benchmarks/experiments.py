"""What the simulated people do: thresholds by each procedure, juggling by each sense, targets and displays.

``python tests/benchmarks/experiments.py [observers]`` prints the tables. All of it is seeded.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).resolve().parents[2])]

import numpy as np

import hapticlab as hl
from hapticlab.roots import root

WEBER = 0.2
TRIALS = 60
TRUE = math.log1p(WEBER)
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
#: name -> a fresh procedure of about 60 trials, and the proportion of right answers that its own estimate stands for
PROCEDURES = {
    "2 down, 1 up (Levitt)": lambda seed: hl.people.UpDown(first=0.5, factor=1.25, reversals=18),
    "1 down, weight 3 (Kaernbach)": lambda seed: hl.people.UpDown(first=0.5, factor=1.15, down=1, weight=3, reversals=26),
    "psi, slope known": lambda seed: hl.people.Psi(
        low=0.02, high=1.5, grid=hl.people.Grid(slopes=(1.0,)), lapse=0.01, trials=TRIALS
    ),
    "psi, slope looked for": lambda seed: hl.people.Psi(low=0.02, high=1.5, lapse=0.01, most_trials=TRIALS),
    "constant stimuli": lambda seed: hl.people.ConstantLevels(np.geomspace(0.05, 0.7, 6), repeats=TRIALS // 6, seed=seed),
}


def thresholds(name, observers):
    """Return ln(estimate/truth) for each observer, by the procedure's rule, its trials, and by a fit of slope 1."""
    curve = hl.people.SimulatedObserver(weber=WEBER).curve()
    target = getattr(PROCEDURES[name](0), "target", None)
    aim = TRUE if target is None else root(lambda level: float(curve(level)) - target, 0.0, 100 * TRUE)
    own, fitted, trials = [], [], []
    for seed in range(observers):
        procedure, observer = PROCEDURES[name](seed), hl.people.SimulatedObserver(weber=WEBER, seed=seed)
        levels, right = [], []
        while not procedure.done and len(levels) < 400:
            level = procedure.level
            answer = observer.decide((1.0, math.exp(level)), len(levels)) == "second"
            procedure.answer(answer)
            levels.append(level)
            right.append(answer)
        if hasattr(procedure, "estimate"):
            own.append(math.log(procedure.estimate() / aim))
        fitted.append(
            math.log(
                hl.people.psychometric(
                    levels, right, slope=1.0, lapse=0.0, intervals=hl.people.Intervals(bootstrap=2)
                ).curve.threshold
                / TRUE
            )
        )
        trials.append(len(levels))
    return own, fitted, trials


def print_thresholds(observers):
    print(f"Weber fraction {100 * WEBER:g} %, {observers} observers: bias and spread of the threshold's logarithm [%]")
    print(f"{'procedure':<30}{'trials':>8}{'own rule':>18}{'fit, slope 1':>18}")
    for name in PROCEDURES:
        own, fitted, trials = thresholds(name, observers)
        shown = [f"{100 * np.mean(e):+.0f} +- {100 * np.std(e):.0f}" if e else "-" for e in (own, fitted)]
        print(f"{name:<30}{np.mean(trials):>8.0f}{shown[0]:>18}{shown[1]:>18}")


def print_juggling():
    print("\njuggling 10 s: rms error of the height [%], two seeds; a hand with 0.5 N of noise; above 50 % the ball is lost")
    print(f"{'stroke at impact':<18}{'height':>8}{'neither':>12}{'touch':>14}{'sight':>14}{'both':>14}")
    shaky = replace(PADDLE, force_max=20.0, hand=hl.Hand("grip", push_noise=0.5))
    for acceleration in (-5.0, -1.0, 2.0, 5.0):
        for height in (0.2, 0.35):
            row = []
            for senses in ("none", "touch", "vision", "both"):
                how = {"senses": senses, "height": height, "acceleration": acceleration}
                found = [hl.people.juggle(shaky, duration=10.0, seed=seed, **how) for seed in (0, 1)]
                row.append(" ".join(f"{100 * one.error:.1f}" for one in found))
            print(f"{acceleration:>+8g} m/s^2{'':<5}{height:>6g} m{row[0]:>12}{row[1]:>14}{row[2]:>14}{row[3]:>14}")


def print_targets():
    print()
    for name, scene in (("empty handle", None), ("a detent at each target, 1 N", lambda d, w: hl.library.detents()(p=d, A=1.0))):
        print(f"{name}\n{hl.people.fitts(PADDLE, scene, movements=30)}")


def print_displays():
    print()
    print(hl.people.compare_displays(replace(PADDLE, coulomb=0.1), [50, 300, 1000, 3000, 9000, 30_000]))
    for m_v in (0.02, 0.05, 0.1, 0.2, 0.5):
        limits = hl.people.compare_displays(PADDLE, [300], m_v=m_v).limits
        print(f"virtual mass {m_v:g} kg: admittance stable below {limits['admittance']:.4g} N/m")


if __name__ == "__main__":
    print_thresholds(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
    print_juggling()
    print_targets()
    print_displays()
