"""What many bodies cost: ``python tests/benchmarks/open_contacts.py [--quick]``.

Compile time is CPU time, in brackets as a part of what SymPy's ``kanes_equations`` of the benchmark bicycle takes in the
same run. Then the instructions of a tick, those of them that are needed while nothing touches, the time of a step with
all bodies apart and with all of them in each other, by an engine that skips cases and one that does not, and what a board
pays. Prints markdown.
"""

import argparse
import sys
import time
import warnings
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1]), str(HERE.parent / "scene" / "mechanics")]

import numpy as np  # noqa: E402
from timing import best_of  # noqa: E402

import hapticlab as hl  # noqa: E402
from hapticlab.compiler.boards.cost import cost  # noqa: E402
from hapticlab.compiler.engines.engine import load  # noqa: E402
from hapticlab.compiler.engines.skipped_arms import Demand  # noqa: E402
from hapticlab.errors import ProgramLimitError  # noqa: E402

VALUES = {"m": 0.05, "g": 0.0, "J": 2e-5}
#: so heavy that bodies stay where they are while steps are timed
STILL = {"m": 1e9, "g": 0.0, "J": 1e9}
TICKS = 5000


def scene(count, shape, method="sample", turns=False):
    """A scene of bodies of one shape in a row above the ground."""
    m, g, J = hl.parameters("m g J", units="kg m/s^2 kg*m^2", values=tuple(VALUES.values()))
    bodies, L, watch = [hl.shapes.ground()], 0, []
    for k in range(count):
        X, Y = (hl.coordinate(f"{name}{k}", unit="m", initial=at) for name, at in (("X", 0.1 * k), ("Y", 0.05)))
        turn = hl.coordinate(f"A{k}", unit="rad") if turns else 0
        L += m * (X.diff(hl.t) ** 2 + Y.diff(hl.t) ** 2) / 2 - m * g * Y + (J * turn.diff(hl.t) ** 2 / 2 if turns else 0)
        bodies.append(shape.at(x=X, y=Y, angle=turn, name=f"body{k}"))
        watch += [X, Y]
    contacts = hl.contact.between(bodies, contact_law=hl.contact.penalty(k="500 N/m", b="0.5 N*s/m"), method=method)
    named = f"{count} {type(shape).__name__}" + (f", {method}" if turns else "")
    return hl.Scene(force=0, eom=[hl.mechanics.lagrange(L, contacts=contacts)], watch=watch, name=named), len(contacts)


def cpu(make):
    """What is made, and the CPU time it took [s]."""
    begun = time.process_time()
    return make(), time.process_time() - begun


def step(program, engine, together):
    """Time [ns] of one step with all bodies apart, or together in one place."""
    parameters = np.array([[STILL[c.name]] for c in program.parameters])
    ready, ticks = load(program, engine), TICKS if engine != "interpreter" else 50
    inputs = np.zeros((ticks, len(program.inputs)))
    at = ready.run(1, inputs[:1], parameters).states
    for k, channel in enumerate(program.states):
        if together and channel.name[0] == "X" and channel.name[1:].isdigit():
            at[k] = 0.001 * int(channel.name[1:])
    found = best_of(7, run=lambda: ready.run(ticks, inputs, parameters, states=at.copy(), every=ticks))
    return found["run"] / ticks * 1e9


def board(program):
    """What a Cortex-M4F pays, in words."""
    try:
        paid = cost(program, "cortex-m4f")
    except ProgramLimitError as too_large:
        said = str(too_large).split(": ", 2)[1]
        return f"does not fit: {said.split(';')[0]}"
    return f"Cortex-M4F: {paid.typical} cycles, {paid.of_cases} of cases, at most {paid.bound}"


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--quick", action="store_true", help="the smallest scenes alone")
    quick = options.parse_args().quick
    warnings.simplefilter("ignore")
    from test_bicycle import bicycle

    (kane, q, *_), derived = cpu(bicycle)
    bike = hl.mechanics.from_mechanics(kane)
    ridden = hl.Scene(force=0, eom=[bike], watch=[bike[p] for p in q])
    _, took = cpu(lambda: hl.compile(ridden, "rk4", T=1e-3, dtype="float64"))
    print(f"The benchmark bicycle: kanes_equations {derived:.2f} s, hl.compile {took:.2f} s ({took / derived:.2f})\n")
    print("| scene, method | pairs | compile [s] | instructions | of them apart | engine | apart [ns] | in touch [ns] | board |")
    print("| --- " * 9 + "|")
    disc, box = hl.shapes.Circle("10 mm"), hl.shapes.Box("40 mm", "30 mm")
    scenes = [(2, disc), (2, box, "sample", True), (2, box, "faces", True)]
    scenes += [] if quick else [(8, disc), (4, box, "sample", True)]
    for made, pairs in (scene(*given) for given in scenes):
        for method in ("semi_implicit_euler", "rk4"):
            program, took = cpu(lambda made=made, method=method: hl.compile(made, method, T=1e-3))
            items = Demand(program.tick).arranged(range(len(program.tick.instructions)))
            needed, paid = sum(isinstance(item, int) for item in items), board(program)
            for engine in ("llvm", "vm") if quick else ("llvm", "vm", "interpreter"):
                apart, together = (step(program, engine, where) for where in (False, True))
                print(
                    f"| {made.name}, {method} | {pairs} | {took:.2f} ({took / derived:.2f}) | {len(program.tick.instructions)} "
                    f"| {needed} | {engine} | {apart:.0f} | {together:.0f} "
                    f"| {paid} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
