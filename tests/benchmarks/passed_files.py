"""How much of hapticlab a first `hl.compile` passes: its files, calls of its functions, and changes of file.

    python tests/benchmarks/passed_files.py

prints one line for each scene, each compiled in a process of its own, after imports. With `--files` it prints the way
too: each file in the order in which it is entered first, and how often it is entered from another.
"""

import argparse
import subprocess
import sys
from pathlib import Path


def mass_on_coupler(hl):
    """The coupler of README.md, Fig. 23.4."""
    import sympy as sp

    z = hl.coordinate("z", unit="m")
    m, b, K = hl.parameters("m b K", units="kg N*s/m N/m")
    F_c = K * (hl.x(hl.t) - z) + b * (hl.v(hl.t) - z.diff(hl.t))
    return hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(hl.t, 2), F_c)])


def spring(hl):
    """F = k (x - x_o), without a case."""
    k, x_o = hl.parameters("k x_o", units="N/m m")
    return hl.Scene(force=k * (hl.x(hl.n) - x_o))


def wall(hl):
    """The plain wall, Eq. (23.1)."""
    k, x_o = hl.parameters("k x_o", units="N/m m")
    return hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)))


SCENES = {"spring": spring, "wall": wall, "mass on a coupler": mass_on_coupler}


def passed(scene):
    """({file: times entered}, calls, changes of file) of one compile."""
    import hapticlab as hl

    package = str(Path(hl.__file__).parent)
    made, compile = SCENES[scene](hl), hl.compile
    entered, calls, changes, here = {}, 0, 0, None

    def look(frame, event, _):
        nonlocal calls, changes, here
        name = frame.f_code.co_filename
        if event not in ("call", "return") or not name.startswith(package):
            return
        calls += event == "call"
        if name != here:
            changes += here is not None
            if event == "call":
                entered[name] = entered.get(name, 0) + 1
        here = name

    sys.setprofile(look)
    compile(made, T=1e-3)
    sys.setprofile(None)
    return {Path(name).relative_to(package).as_posix(): times for name, times in entered.items()}, calls, changes


def main():
    """Print what each scene passes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", action="store_true", help="print the files, in the order they are entered")
    parser.add_argument("--scene", choices=SCENES, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if not given.scene:
        more = ["--files"] if given.files else []
        for scene in SCENES:
            subprocess.run([sys.executable, __file__, "--scene", scene, *more], check=True)
        return
    files, calls, changes = passed(given.scene)
    print(f"{given.scene}: {len(files)} files, {calls} calls, {changes} changes of file")
    for name, times in files.items() if given.files else ():
        print(f"  {times:5d}  {name}")


if __name__ == "__main__":
    main()
