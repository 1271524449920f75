"""What only a closed contact needs is left out where an engine can, and no bit tells."""

import numpy as np
import pytest
from random_programs import assert_same_bits

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.skipped_arms import Arm, Demand
from hapticlab.scene.notation.derivative import Partial

VALUES = {"m": 0.05, "g": 9.81, "J": 2e-5}
SHAPES = {
    "discs": [hl.shapes.Circle("10 mm")] * 4,
    "many discs": [hl.shapes.Circle("10 mm")] * 8,
    "boxes": [hl.shapes.Box("20 mm", "16 mm")] * 2,
    "mixed": [hl.shapes.Circle("10 mm"), hl.shapes.Box("20 mm", "16 mm"), hl.shapes.Capsule("20 mm", "6 mm")],
}


def heap(kind, method="sample", by_hand=False):
    """A scene of bodies that fall upon each other and on the ground, the first of them turning.

    ``by_hand``: contacts as forces on the coordinates, each the whole normal force times the slope of the gap.
    """
    m, g, J = hl.parameters("m g J", units="kg m/s^2 kg*m^2", values=tuple(VALUES.values()))
    bodies, L, coordinates = [hl.shapes.ground()], 0, []
    for k, shape in enumerate(SHAPES[kind]):
        X = hl.coordinate(f"X{k}", unit="m", initial=0.033 * (k % 3) + 0.002 * k, rate=-0.4 * (k % 3))
        Y = hl.coordinate(f"Y{k}", unit="m", initial=0.011 + 0.024 * (k // 3), rate=-0.2 - 0.1 * k)
        turn = hl.coordinate(f"A{k}", unit="rad", initial=0.2) if k == 0 else 0
        L += m * (X.diff(hl.t) ** 2 + Y.diff(hl.t) ** 2) / 2 - m * g * Y + (J * turn.diff(hl.t) ** 2 / 2 if turn else 0)
        bodies.append(shape.at(x=X, y=Y, angle=turn, name=f"body{k}"))
        coordinates += [X, Y] + [turn] * bool(turn)
    law = hl.contact.penalty(k="500 N/m", b="0.2 N*s/m")
    contacts = hl.contact.between(bodies, contact_law=law, method=method)
    if by_hand:
        forces = {q: sum(c.force * Partial(c.gap, q) for c in contacts) for q in coordinates}
        motion = hl.mechanics.lagrange(L, forces=forces)
    else:
        motion = hl.mechanics.lagrange(L, contacts=contacts)
    watch = {q.func.__name__: q for q in coordinates} | {f"N_{c.name}": c.force for c in contacts[-2:]}
    return hl.Scene(force=0, eom=[motion], watch=watch, name=kind)


def run(program, engine, ticks):
    parameters = np.array([[VALUES[c.name]] for c in program.parameters])
    return load(program, engine).run(ticks, np.zeros((ticks, len(program.inputs))), parameters).outputs


@pytest.mark.parametrize("kind", ["discs", "boxes", "mixed"])
@pytest.mark.parametrize("method", ["semi_implicit_euler", "rk4"])
@pytest.mark.always("semi_implicit_euler-*")
def test_engines_that_skip_and_that_do_not_give_the_same_bits(kind, method):
    program = hl.compile(heap(kind, "faces"), method, T=5e-4)
    ticks = 120
    found = {engine: run(program, engine, ticks) for engine in ("interpreter", "llvm", "vm")}
    pressed = found["llvm"][:, [c.name.startswith("N_body") for c in program.outputs]]
    assert 0 < np.count_nonzero(pressed) < pressed.size / 2  # bodies touch, and are apart most of the time
    for engine in ("llvm", "vm"):
        assert_same_bits(found[engine], found["interpreter"])


@pytest.mark.parametrize("kind", ["discs", "boxes", "mixed"])
@pytest.mark.always("mixed")
def test_the_motion_is_that_of_whole_forces(kind):
    """A force that is zero times a slope is the zero that an open contact leaves."""
    one, other = (run(hl.compile(heap(kind, by_hand=h), "rk4", T=5e-4, dtype="float64"), "auto", 150) for h in (False, True))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())


def test_pairs_that_are_apart_cost_little():
    """Of 8 discs and the ground, 36 pairs, half of the instructions are needed while nothing touches."""
    pytest.importorskip("llvmlite")
    tick = hl.compile(heap("many discs"), "semi_implicit_euler", T=5e-4).tick
    items = Demand(tick).arranged(range(len(tick.instructions)))
    assert sum(isinstance(item, Arm) for item in items) >= 28  # each pair of discs
    assert sum(not isinstance(item, Arm) for item in items) < 0.55 * len(tick.instructions)


def test_a_board_says_what_it_pays_for_open_contacts():
    one = hl.compile(heap("mixed"), "semi_implicit_euler", T=5e-4)
    paid = cost(one, "cortex-m4f")
    assert 0 < paid.of_cases < paid.typical
    assert f"cases      {paid.of_cases} of these" in str(paid)
    assert cost(one, "host").of_cases == 0  # its time is not limited
    wall = hl.compile(hl.wall()(k=150, x_o=0.01), T=2e-3)
    assert "cases" not in str(cost(wall))  # a case that small is computed everywhere
