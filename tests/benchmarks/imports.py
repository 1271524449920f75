"""First words: how long a fresh Python takes to import, to write a first scene and to print the command line's help.

Every line is timed in turn, round after round, so that a busy machine is as busy for each; the ratios to `import sympy`
of the same run are what to quote: `python tests/benchmarks/imports.py` (`--rounds 20`; Linux and macOS).
"""

import argparse
import resource
import statistics
import subprocess
import sys
import time

FIRST_SCENE = """
import hapticlab as hl
from hapticlab import n, x
k, x_o = hl.parameters("k x_o", units="N/m m")
wall = hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)))
"""
YARDSTICK = "import sympy"
LINES = {
    YARDSTICK: ["-c", "import sympy"],
    "python itself": ["-c", "pass"],
    "import numpy": ["-c", "import numpy"],
    "import hapticlab": ["-c", "import hapticlab"],
    "a first scene": ["-c", FIRST_SCENE],
    "a first scene, x_o in inches": ["-c", FIRST_SCENE + "wall(x_o='1 inch')"],
    "hapticlab -h": ["-m", "hapticlab", "-h"],
    "hapticlab grade -h": ["-m", "hapticlab", "grade", "-h"],
    "hapticlab run -h": ["-m", "hapticlab", "run", "-h"],
    "what `hapticlab grade` imports": ["-c", "import hapticlab.cli.grade"],
}


def seconds(arguments):
    """Return how long a new Python runs, and for how long it has a processor [s]."""
    begun, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.perf_counter() - begun, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    """Print the median of each line by the clock and of a processor, and their ratios to the yardstick's."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=10)
    rounds = parser.parse_args().rounds
    times = {name: [] for name in LINES}
    for _ in range(rounds + 1):
        for name, arguments in LINES.items():
            times[name].append(seconds(arguments))
    # the first round fills the disk's cache and __pycache__
    medians = {name: [statistics.median(column) for column in zip(*found[1:], strict=True)] for name, found in times.items()}
    print(f"{'':<32} {'clock s':>8} {'ratio':>6} {'processor s':>12} {'ratio':>6}")
    for name, (clock, processor) in medians.items():
        ratios = [own / unit for own, unit in zip((clock, processor), medians[YARDSTICK], strict=True)]
        print(f"{name:<32} {clock:8.3f} {ratios[0]:6.2f} {processor:12.3f} {ratios[1]:6.2f}")


if __name__ == "__main__":
    main()
