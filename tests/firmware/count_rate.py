"""How many edges a second of an encoder the emulated Uno follows: ``python tests/firmware/count_rate.py``.

Edges come at one distance, up and down again, while a scene runs with telemetry every tick. Each takes an interrupt, so that
the step comes to its end later, and two of them closer than the longest interrupt are a lost edge, which is a fault.
"""

from closed_loop import STEP
from emulated import emulated_uno
from emulator import CYCLES_PER_SECOND
from five_scenes import compiled, mass_and_wall, wall
from wired import PADDLES

from hapticlab.device.board.settings import changed

SWEEP = 3000  # counts up, then down
SETTINGS = changed(PADDLES["longhorn"], metres_per_count=1e-6, speed_max=1.0)


class Edges:
    """A handle that stands for the loop, and an encoder whose edges come at a rate."""

    def __init__(self, rate):
        self.rate, self.count, self.next = rate, 0, None

    def step(self, force, seconds):
        return 0.0

    def show(self, board, x):
        """Give the edges of the next 50 us."""
        end = board.cycle + STEP * CYCLES_PER_SECOND
        self.next = self.next or board.cycle
        while self.next < end:
            board.run_to(round(self.next))
            place = self.count % (2 * SWEEP)
            phase = min(place, 2 * SWEEP - place) % 4
            board.pin(2, phase in (1, 2))
            board.pin(3, phase in (2, 3))
            self.count, self.next = self.count + 1, self.next + CYCLES_PER_SECOND / self.rate


def follows(rate, make, T, seconds=0.15):
    """Return the fault of a run with edges at a rate, how many steps were late, and the longest step [s]."""
    with emulated_uno(settings=SETTINGS, T=T) as paddle:
        loop = paddle.loop
        edges = loop.handle = loop.sensor = Edges(1000)
        paddle.start(compiled(make, T=T), check_fit=False)
        edges.rate = rate
        paddle.wait(seconds)
        log = paddle.stop()
        return log.fault, paddle.timing.overruns, paddle.timing.worst


def fastest(make, T):
    """Return the largest rates [1/s], in steps of 2 000, without a late step and without a lost edge."""
    rates = dict.fromkeys(("late", "lost"))
    for rate in range(10_000, 200_001, 2_000):
        fault, overruns, _ = follows(rate, make, T)
        found = {"late": overruns > 0, "lost": "SENSOR" in (fault or "")}
        for name, happened in found.items():
            if happened and rates[name] is None:
                rates[name] = rate - 2_000
        if fault:
            return rates
    return rates


if __name__ == "__main__":
    for make, T in ((wall, 1e-3), (mass_and_wall, 1.25e-3)):
        print(make.__name__, f"T = {T * 1e3:g} ms:", fastest(make, T))
