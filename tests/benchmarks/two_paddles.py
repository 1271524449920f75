"""How late the link of two coupled paddles is: ``python tests/benchmarks/two_paddles.py`` prints a table.

Simulated boards by the clock of this computer have a link without a line: what is left is the time of the runner. Two
emulated Unos have the line at its baud rate and the time that a board takes to read a message, and no USB, whose adapters
add 1 to 16 ms. Nothing of this was tried with two real boards.
"""

import sys
from contextlib import ExitStack
from pathlib import Path

import numpy as np

import hapticlab as hl

FIRMWARE = Path(__file__).parents[1] / "firmware"
SECONDS = 2.0
HAND = hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(6 * t))


def scene(architecture, **options):
    values = {"b": 0.5} if architecture == "wave" else {"k": 60, "b": 0.2}
    return hl.laws.bilateral_coupling(architecture, **options)(**values, **({"alpha_max": 1.0} if options else {}))


def main():
    sys.path[:0] = [str(FIRMWARE), str(FIRMWARE / "ports")]
    from emulated import emulated_uno

    plain = scene("position-position")
    boards = {
        "one simulated, one simulated board by the clock": (
            lambda: hl.SimulatedPaddle.from_profile("hapkit", hand=HAND), lambda: hl.connect("sim://hapkit?pace=real"), plain,
        ),
        "two simulated boards by the clock": (*[lambda: hl.connect("sim://hapkit?pace=real")] * 2, plain),
        "two emulated Unos, T = 1 ms": (*[lambda: emulated_uno(HAND)] * 2, plain),
        "two emulated Unos, T = 2 ms": (*[lambda: emulated_uno(HAND, T=2e-3)] * 2, plain),
        "two emulated Unos, T = 2 ms, waves": (*[lambda: emulated_uno(HAND, T=2e-3)] * 2, scene("wave")),
        "two emulated Unos, T = 2 ms, controller": (
            *[lambda: emulated_uno(HAND, T=2e-3)] * 2, scene("position-position", controller=True),
        ),
    }  # fmt: skip
    print("| link | late, median | worst | messages/s | samples unused |\n| --- | --- | --- | --- | --- |")
    for name, (left, right, its) in boards.items():
        with ExitStack() as opened:
            made = [paddle() for paddle in (left, right)]
            pair = [opened.enter_context(one) if hasattr(one, "__enter__") else one for one in made]
            run = hl.devices.TwoPaddles(*pair, its).run(SECONDS)
        for way, times in (("to the right", run.to_right), ("to the left", run.to_left)):
            print(
                f"| {name}, {way} | {1e3 * times.median:.1f} ms | {1e3 * times.worst:.1f} ms | {times.rate:.0f} "
                f"| {100 * times.lost:.0f} % |"
            )


if __name__ == "__main__":
    main()
