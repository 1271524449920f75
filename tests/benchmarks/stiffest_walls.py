"""How walls just below the borders of hl.measure.largest_stiffness behave in a long run, on random paddles with an encoder.

    python tests/benchmarks/stiffest_walls.py [NUMBER OF PADDLES]

At 98 % of each border the handle is let go at the wall and 1 mm before it, for 40 s. A wall is listed as lasting if the handle
still swings by more than five counts at the end, and by 90 % of the swing at 20 s, with a force whose ripple is above 0.065 N;
and as buzzing where the wall was called quiet and the ripple alone is above that.
"""

import dataclasses
import sys

import numpy as np

import hapticlab as hl

PUSH = hl.parameters("push", units="N", values=0.2)
LASTS, FELT, COUNTS, SECONDS = 0.9, 0.065, 5, 40.0


def random_paddle(rng):
    """A paddle with an encoder, and the name and damper of a law."""
    hand = (None, hl.Hand("pinch", push=1.0), hl.Hand("pinch", push=2.0))[rng.integers(3)]
    T = float(rng.choice([5e-4, 1e-3, 2e-3]))
    paddle = hl.SimulatedPaddle(
        m=10 ** rng.uniform(-1.7, -0.5), b=10 ** rng.uniform(-1, 0.5), T=T, delay=float(rng.choice([0, 0, T])),
        counts_per_metre=float(rng.choice([1e4, 2e4, 5e4, 2e5])), coulomb=float(rng.choice([0, 0, 0.01, 0.03])), hand=hand,
    )  # fmt: skip
    law = str(rng.choice(["zoh", "zoh", "backward_difference", "ellis"]))
    return paddle, law, 0.0 if law == "ellis" else float(rng.choice([0, 0, 0, 0.5]))


def long_run(paddle, law, B, K, x):
    """The swings [counts] after 20 s and at the end, and the ripple of the force [N] at the end."""
    scene = hl.wall(law)(k=K, **({"B": B} if B else {}))
    if paddle.hand is None:
        scene = dataclasses.replace(scene, force=scene.force - PUSH)
    log = paddle.run(scene, duration=SECONDS, x=x, progress=False)
    last, middle = round(2 / paddle.T), len(log.t) // 2
    swings = [
        np.ptp(log.channels["x_true"][part]) * paddle.counts_per_metre
        for part in (slice(middle, middle + last), slice(-last, None))
    ]
    return *swings, np.sqrt(2) * np.std(log.F[-last:])


def main():
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    rng, found = np.random.default_rng(1), {"rests": 0, "quiet": 0, "buzzing": 0}
    for _ in range(number):
        paddle, law, B = random_paddle(rng)
        limit = hl.measure.largest_stiffness(paddle, law, B=B)
        for name, border in (("rests", limit.unstable.lowest), ("quiet", limit.K)):
            runs = [long_run(paddle, law, B, 0.98 * border, x) for x in (0.0, -1e-3)] if border > 0 else []
            lasting = [end for before, end, felt in runs if end > max(COUNTS, LASTS * before) and felt > FELT]
            buzzing = [felt for *_, felt in runs if felt > FELT] if name == "quiet" else []
            found[name] += bool(lasting)
            found["buzzing"] += bool(buzzing)
            if lasting or buzzing:
                values = [round(float(e), 2) for e in lasting or buzzing]
                print(f"{name} {border:.5g} N/m: {values} of {law}, B = {B:g}, {paddle!r}", flush=True)
    print(f"{number} paddles: lasting swings below the unstable border {found['rests']}, below K {found['quiet']}; "
          f"buzzes below K {found['buzzing']}")  # fmt: skip


if __name__ == "__main__":
    main()
