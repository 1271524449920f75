"""The code that OpenBLAS has for several processors, each in a process of its own: NumPy takes it when it is loaded."""

import os
import subprocess
import sys
from pathlib import Path

#: from SSE3 to AVX2, which every x86-64 of a course has; what other processors do not know they do not take
CORES = ("Prescott", "Nehalem", "Haswell")


def on_each_processor(program, *arguments, cores=CORES):
    """Run a Python program on the code of each of the cores, side by side, and return what each printed."""
    runs = []
    for core in cores:
        env = os.environ | {
            "OPENBLAS_CORETYPE": core,
            "PYTHONPATH": os.pathsep.join(map(str, [Path(__file__).parent, *sys.path])),
        }
        command = [sys.executable, "-c", program, core, *map(str, arguments)]
        runs.append(subprocess.Popen(command, env=env, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE))
    said = [run.communicate() for run in runs]
    assert [run.returncode for run in runs] == [0] * len(cores), said
    return [out for out, _ in said]
