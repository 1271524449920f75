"""What only a closed contact needs is left out where an engine can, and no bit tells."""

import numpy as np
import pytest
from random_programs import assert_same_bits

import hapticlab as hl
from hapticlab.compiler.algebra import gjk
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.skipped_arms import Arm, Demand
from hapticlab.scene.notation.derivative import Partial

VALUES = {"m": 0.05, "g": 9.81, "J": 2e-5}
SHAPES = {
    "discs": [hl.shapes.Circle("10 mm")] * 4,
    "more discs": [hl.shapes.Circle("10 mm")] * 5,
    "boxes": [hl.shapes.Box("20 mm", "16 mm")] * 2,
    "two": [hl.shapes.Circle("10 mm"), hl.shapes.Box("20 mm", "16 mm")],
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


@pytest.fixture(scope="module")
def discs():
    return hl.compile(heap("more discs"), "semi_implicit_euler", T=5e-4)


def run(program, engine, ticks):
    parameters = np.array([[VALUES[c.name]] for c in program.parameters])
    return load(program, engine).run(ticks, np.zeros((ticks, len(program.inputs))), parameters).outputs


@pytest.mark.parametrize("kind", ["two", "discs", "boxes", "mixed"])
@pytest.mark.parametrize("method", ["semi_implicit_euler", "rk4"])
@pytest.mark.always("semi_implicit_euler-two")
def test_engines_that_skip_and_that_do_not_give_the_same_bits(kind, method):
    program = hl.compile(heap(kind, "faces"), method, T=5e-4)
    ticks = 120
    found = {engine: run(program, engine, ticks) for engine in ("interpreter", "llvm", "vm")}
    pressed = found["llvm"][:, [c.name.startswith("N_body") for c in program.outputs]]
    assert 0 < np.count_nonzero(pressed) < pressed.size / 2  # bodies touch, and are apart most of the time
    for engine in ("llvm", "vm"):
        assert_same_bits(found[engine], found["interpreter"])


@pytest.mark.parametrize(
    ("method", "kind"), [("semi_implicit_euler", "two"), ("rk4", "discs"), ("rk4", "boxes"), ("rk4", "mixed")]
)
@pytest.mark.always("semi_implicit_euler-*")
def test_the_motion_is_that_of_whole_forces(method, kind):
    """A force that is zero times a slope is the zero that an open contact leaves."""
    one, other = (run(hl.compile(heap(kind, by_hand=h), method, T=5e-4, dtype="float64"), "auto", 150) for h in (False, True))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())


def test_pairs_that_are_apart_cost_little(discs):
    """Of discs and the ground half of the instructions are needed while nothing touches."""
    pytest.importorskip("llvmlite")
    tick = discs.tick
    items = Demand(tick).arranged(range(len(tick.instructions)))
    assert sum(isinstance(item, Arm) for item in items) >= 10  # each pair of discs
    assert sum(not isinstance(item, Arm) for item in items) < 0.6 * len(tick.instructions)


PAIRS = {
    "boxes": (hl.shapes.Box("40 mm", "30 mm"), hl.shapes.Box("10 mm", "30 mm")),
    "bars": (hl.shapes.Capsule("40 mm", "5 mm"), hl.shapes.Capsule("10 mm", "8 mm")),
    "corner": (hl.shapes.Polygon([(0, 0), (0.04, 0), (0.04, 0.01), (0.01, 0.01), (0.01, 0.04), (0, 0.04)]),
               hl.shapes.Capsule("20 mm", "4 mm")),
}  # fmt: skip


def placed(shapes, method, name, by="rk4"):
    """A program of two bodies, where each is being a live parameter; watched is the force between them."""
    bodies, coordinates = [], []
    m, J = hl.parameters("m J", units="kg kg*m^2", values=(0.05, 2e-5))
    for k, shape in enumerate(shapes):
        names, units = [f"{q}{k}" for q in "XYA"], ["m", "m", "rad"]
        starts = hl.parameters(" ".join(f"{q}_0" for q in names), units=" ".join(units), values=(0.5 * k, 0, 0))
        X, Y, A = (hl.coordinate(q, unit=u, initial=at) for q, u, at in zip(names, units, starts, strict=True))
        bodies.append(shape.at(x=X, y=Y, angle=A, name=f"body{k}"))
        coordinates += [X, Y, A]
    rates = [q.diff(hl.t) for q in coordinates]
    L = sum((J if k % 3 == 2 else m) * w**2 / 2 for k, w in enumerate(rates))
    contacts = hl.contact.between(bodies, contact_law=hl.contact.penalty(k="500 N/m", b="0.1 N*s/m"), method=method)
    motion = hl.mechanics.lagrange(L, contacts=contacts)
    watch = {"N": contacts[0].force} | {q.func.__name__: q for q in coordinates}
    return hl.compile(hl.Scene(force=0, eom=[motion], watch=watch, name=name), by, T=5e-4)


@pytest.mark.parametrize(
    ("method", "kind", "by"),
    [("sample", "boxes", "semi_implicit_euler")]
    + [(method, kind, "rk4") for kind in ("boxes", "corner") for method in ("sample", "faces")]
    + [("sample", "bars", "rk4"), ("gjk", "bars", "rk4")],
)
@pytest.mark.always("*-semi_implicit_euler")
def test_a_guarded_pair_has_the_force_of_an_unguarded_one(method, kind, by, monkeypatch):
    """Wherever two bodies are: apart, in touch, in each other; with and without a look at how far apart they are."""
    guarded = placed(PAIRS[kind], method, "guarded", by)
    monkeypatch.setattr(gjk, "near", lambda translator, condition: None)
    whole = placed(PAIRS[kind], method, "whole", by)
    assert len(whole) < len(guarded) < 1.1 * len(whole)
    generator = np.random.default_rng(41)
    at = {c.name: generator.uniform(-3.2, 3.2, 1000) * (1 if c.name[0] == "A" else 0.02) for c in guarded.parameters}
    at |= {"m": np.full(1000, 0.05), "J": np.full(1000, 2e-5)}
    found = []
    for program in (guarded, whole):
        parameters = np.array([at[c.name] for c in program.parameters])
        found.append(load(program).run(5, np.zeros((5, len(program.inputs))), parameters).outputs)
    assert_same_bits(*found)
    pressed = found[0][:, 1] > 0
    assert pressed.any(axis=0).mean() > 0.08 and (~pressed).all(axis=0).mean() > 0.3


def test_method_taylor_takes_no_look_for_a_surface(monkeypatch):
    """How far apart two bodies are is no surface at which their motion changes: its modes and events stay those of touch."""
    one = placed(PAIRS["bars"], "sample", "guarded", "taylor")
    monkeypatch.setattr(gjk, "near", lambda translator, condition: None)
    other = placed(PAIRS["bars"], "sample", "whole", "taylor")
    assert len(other) <= len(one) < len(other) + 10  # the force that is watched at the sample looks
    assert one.facts == other.facts


def test_polygons_that_are_apart_cost_next_to_nothing():
    """The search for the closest edges and corners is left out, and it is nearly all that boxes take."""
    tick = placed(PAIRS["boxes"], "faces", "boxes", "verlet").tick
    items = Demand(tick).arranged(range(len(tick.instructions)))
    assert sum(not isinstance(item, Arm) for item in items) < 0.06 * len(tick.instructions)


def test_a_board_says_what_it_pays_for_open_contacts(discs):
    paid = cost(discs, "cortex-m4f")
    assert 0 < paid.of_cases < paid.typical
    assert f"cases      {paid.of_cases} of these" in str(paid)
    assert cost(discs, "host").of_cases == 0  # its time is not limited
    wall = hl.compile(hl.wall()(k=150, x_o=0.01), T=2e-3)
    assert "cases" not in str(cost(wall))  # a case that small is computed everywhere
