"""Write shared files to link from course pages: ``python tests/benchmarks/shared_pages.py FOLDER``."""

import sys
from pathlib import Path

import hapticlab as hl

PADDLE = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
SCENES = {"wall": hl.wall()(k=300, x_o=0.01), "detents": hl.library.detents(), "four_bar": hl.library.four_bar()}


def write(folder):
    """Write all files and return their paths."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    return [hl.share(scene, PADDLE, Path(folder) / f"{name}.html").path for name, scene in SCENES.items()]


if __name__ == "__main__":
    print(*write(sys.argv[1]), sep="\n")
