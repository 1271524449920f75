"""Do the 95 % intervals of hl.identify.paddle and hl.identify.hand hold the truth of random paddles and hands?

``python random_paddles.py [PADDLES [WHAT [FIRST [STEP]]]]`` identifies paddles, one seed each, and prints, for each sensor
and constant, the part of the intervals that hold the true value, and how many were refused: an error, or a fit that says it
did not converge or does not explain its record. WHAT is "hand" or kinds of record joined by "+".
"""

import sys
from dataclasses import replace

import numpy as np

import hapticlab as hl

T = 1e-3
SENSORS = ("dithered counts", "counts, no dither", "noise, no counts")
CONSTANTS = {"paddle": ("m", "b", "coulomb", "delay"), "hand": ("m", "b", "k")}
#: what is recommended, and what hl.identify.paddle does by itself
RECOMMENDED = "kick+steps+chirp"


def logarithmic(draws, low, high):
    return float(np.exp(draws.uniform(np.log(low), np.log(high))))


def random_paddle(number):
    """Return the name of a sensor and a paddle: 5 g to 0.5 kg, 0.01 to 2 N s/m, 0 to 0.3 N, one in ten without friction."""
    draws, sensor = np.random.default_rng([20, number]), number % 3
    count = logarithmic(draws, 5e-6, 50e-6)
    noise = count * (draws.uniform(0.3, 1), draws.uniform(0, 0.1), 0.4)[sensor]
    coulomb = float(draws.uniform(0, 0.3)) * (draws.uniform() > 0.1)
    body = {"m": logarithmic(draws, 5e-3, 0.5), "b": logarithmic(draws, 0.01, 2), "delay": float(draws.uniform(0, 3 * T))}
    counts = None if sensor == 2 else 1 / count
    paddle = hl.SimulatedPaddle(
        **body, T=T, coulomb=coulomb, noise=noise, counts_per_metre=counts, force_max=3.0, seed=10 * number
    )
    return SENSORS[sensor], paddle


def random_hand(number):
    """Return a hand of 20 to 300 g, damping ratio 0.2 to 1.5, and 100 to 1500 N/m."""
    draws = np.random.default_rng([21, number])
    m, k = logarithmic(draws, 0.02, 0.3), logarithmic(draws, 100, 1500)
    return hl.Hand(m=m, b=2 * float(draws.uniform(0.2, 1.5)) * (k * m) ** 0.5, k=k)


def identified(number, what=RECOMMENDED):
    """Return (sensor, why it was refused or "", {constant: (true, value, low, high)})."""
    sensor, paddle = random_paddle(number)
    hand = random_hand(number) if what == "hand" else None
    try:
        if hand:
            found = hl.identify.hand(replace(paddle, hand=hand))
        else:
            found = hl.identify.paddle(paddle, kinds=tuple(what.split("+")))
    except hl.errors.HapticlabError as error:
        return sensor, str(error), {}
    refused = "" if found.converged and found.explained else "not converged" if found.explained else "not explained"
    names = CONSTANTS["hand" if hand else "paddle"]
    return sensor, refused, {n: (getattr(hand or paddle, n), found[n].value, found[n].low, found[n].high) for n in names}


def coverage(outcomes):
    """Return {sensor or "all": (number, refused, {constant: part of intervals that hold the truth})}."""
    rows = {}
    for sensor in (*SENSORS, "all"):
        of = [one for one in outcomes if sensor in (one[0], "all")]
        kept = [found for _, refused, found in of if not refused]
        holds = {n: np.mean([one[n][2] <= one[n][0] <= one[n][3] for one in kept]) for n in (kept[0] if kept else ())}
        rows[sensor] = len(of), len(of) - len(kept), holds
    return rows


def main(number=300, what=RECOMMENDED, first=0, step=1):
    outcomes = [identified(k, what) for k in range(int(first), int(number), int(step))]
    print("| record | sensor | paddles | refused | truth held |")
    print("|---|---|---|---|---|")
    for sensor, (count, refused, holds) in coverage(outcomes).items():
        told = ", ".join(f"{name} {100 * part:.1f} %" for name, part in holds.items())
        print(f"| {what} | {sensor} | {count} | {refused} | {told} |")
    for why in sorted({why[:160] for _, why, _ in outcomes if why}):
        print(f"refused: {why}")


if __name__ == "__main__":
    main(*((int(sys.argv[1]), *sys.argv[2:]) if sys.argv[1:] else ()))
