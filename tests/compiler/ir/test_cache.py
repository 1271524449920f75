"""A scene is compiled once, and nothing that differs in a bit is ever taken for it."""

import os
import pickle
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
import sympy as sp
from random_programs import assert_same_bits, random_program

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engines.engine import KERNELS, load
from hapticlab.compiler.events.taylor_method import Taylor
from hapticlab.compiler.ir import cache
from hapticlab.compiler.ir.cache import Shared, content, instructions
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
from hapticlab.compiler.ir.trace import Builder
from hapticlab.compiler.tick import compile_scene
from hapticlab.compiler.tick.compile_scene import PROGRAMS
from hapticlab.course.felt import felt
from hapticlab.device.simulated.closed_loop import LINKED
from hapticlab.scene.notation.symbols import Parameter

T = 1e-3


@pytest.fixture(autouse=True)
def empty():
    cache.clear()


@pytest.fixture
def lowered(monkeypatch):
    """Return a list that gets the name of every scene that is lowered."""
    found, lowering = [], compile_scene.lowered
    monkeypatch.setattr(compile_scene, "lowered", lambda scene, *options: found.append(scene.name) or lowering(scene, *options))
    return found


@pytest.fixture
def made(monkeypatch):
    """Return a list that gets the text of everything that is compiled to machine code."""
    llvm = pytest.importorskip("hapticlab.compiler.engines.llvm")
    pytest.importorskip("llvmlite")
    found, compiling = [], llvm._compile
    monkeypatch.setattr(llvm, "_compile", lambda text: found.append(text) or compiling(text))
    return found


def coupler(name="coupler", *, c=0.25, range=(-np.inf, np.inf), low=0.0, value=None, **start):
    """Return a mass on a coupler, with a constant c in its equation of motion."""
    m = hl.parameters("m", units="kg", values=0.1)
    K = hl.parameters("K", units="N/m", ranges=(low, 1e4), values=value)
    b = hl.parameters("b", units="N*s/m", values=1.0)
    z = hl.coordinate("z", unit="m", range=range, **start)
    F = K * (x(t) - z) + b * (v(t) - z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - c * b * z.diff(t))], name=name, values={"K": 400.0})


def test_a_scene_is_lowered_once_however_it_is_asked_for(lowered):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, counts_per_metre=1e5)
    first = hl.compile(coupler(), T=T)
    assert hl.compile(coupler(), T=T) is first and paddle.program(coupler()) is first
    for _ in range(3):
        paddle.run(coupler(), duration=0.01, progress=False)
    assert lowered == ["coupler"]
    hl.sweep(coupler(), paddle, metric="energy", duration=0.05, delay=[0, 1e-3, 1.5e-3], progress=False)
    assert lowered == ["coupler"]
    copied = hl.compile(pickle.loads(pickle.dumps(coupler())), T=T)  # lowered anew or not, the same program
    assert copied == first and str(copied) == str(first)


def test_runs_sweeps_and_checks_compile_machine_code_once(made):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    sweep = {"duration": 0.05, "v": 0.1, "k": np.linspace(100, 400, 40), "progress": False}
    wall = hl.wall()(x_o=0.0)
    calls = {
        "run": lambda: paddle.run(wall(k=300), duration=0.01, progress=False).F,
        "sweep": lambda: hl.sweep(wall, paddle, metric="energy", **sweep).values,
        "check": lambda: felt(wall, x=np.linspace(-0.01, 0.01, 2000), values={"k": 300.0}),
    }
    for number, (name, call) in enumerate(calls.items(), 1):
        first = call()
        assert len(made) == number, name
        assert_same_bits(call(), first)
        assert len(made) == number, name
    paddle.run(wall(k=150), duration=0.01, progress=False)  # another value is another input of the same code
    assert len(made) == len(calls)


def test_a_few_samples_are_interpreted_and_give_the_bits_of_machine_code(made):
    wall, given = hl.wall(), np.linspace(-0.01, 0.01, 400)
    few = felt(wall, x=given[:300], values={"k": 300.0, "x_o": 0.0})
    assert not made
    many = felt(wall, x=np.tile(given[:300], 20), values={"k": 300.0, "x_o": 0.0})
    assert len(made) == 1
    assert_same_bits(many[:300], few)


def test_bits_are_the_same_with_tables_empty_and_full():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)

    def force():
        return paddle.run(coupler(), duration=0.05, v=0.2, progress=False).F

    first = force()
    for _ in range(20):  # others, between
        hl.compile(coupler(c=np.random.default_rng(1).uniform()), T=T)
    again = force()
    cache.clear()
    assert_same_bits(again, first)
    assert_same_bits(force(), first)


class bent(sp.Function):
    """A student's function, which another cell defines anew."""

    nargs = 1
    is_real = True


def different_scenes():
    """Return scenes that differ from each other in one thing, however small."""
    k, b = hl.parameters("k b", units="N/m N*s/m", values=(200.0, 1.0))
    x_o, longer = hl.parameters("x_o", units="m", values=0.0), hl.parameters("x_o", units="m", values=1e-17)
    factors = (
        0.1,
        np.nextafter(0.1, 1),
        sp.Rational(1, 10),
        sp.Float("0.1", 30),
        sp.Float(2),
        sp.Integer(2),
        1 + 1e-15,
        1e-17,
    )
    scenes = [coupler(c=sp.sympify(c)) for c in factors]
    scenes += [coupler(initial=a) for a in (1e-3, np.nextafter(1e-3, 1), 1e-17, -1e-17, x(n), 2 * x(n))]
    scenes += [
        coupler(rate=1e-3),
        coupler(range=(-1, 1)),
        coupler(range=(-1, 1.5)),
        coupler(low=-1.0),
        coupler(name="other"),
    ]
    scenes += [coupler(value=200.0), coupler()(K=401.0), coupler()(K=np.nextafter(400.0, 1)), coupler()(m=0.2)]
    forces = [
        k * x(n), 2 * k * x(n), 2.0 * k * x(n), k * x(n - 1), k * x(t), k * hl.laws.delay(x(n)), k * x(n) + b * v(n),
        k * x(n) + b * v(t), hl.when(x(n) > x_o, k * x(n)), hl.when(x(n) >= x_o, k * x(n)),
        hl.when(x(n) >= longer, k * x(n)), sp.Mul(k, sp.Add(x(n), x(n), evaluate=False), evaluate=False),
    ]  # fmt: skip
    return scenes + [hl.Scene(force=force) for force in forces]


def test_scenes_that_differ_in_anything_get_keys_of_their_own():
    options = ("rk4", T, 1, "soh", "float32", "backward_difference", None, "before")
    keys = [compile_scene._key(scene, options) for scene in different_scenes()]
    assert None not in keys and len(set(keys)) == len(keys)
    assert keys == [compile_scene._key(scene, options) for scene in different_scenes()]  # and scenes that are equal get the same


@pytest.mark.parametrize("name, others", [
    ("method", ("euler", "taylor", "verlet", Taylor(order=5), Taylor(order=6))),
    ("T", (2e-3, np.nextafter(T, 1))), ("substeps", (2,)), ("hold", ("zoh", "foh")), ("dtype", ("float64",)),
    ("velocity", ("measured",)), ("live", ((), ("K",), ("m",), ("K", "m"))), ("force_at", ("after", "mean")),
])  # fmt: skip
def test_every_option_is_part_of_the_key(name, others):
    programs = [hl.compile(coupler(), T=T)] + [hl.compile(coupler(), **{"T": T, name: other}) for other in others]
    assert len({id(program) for program in programs}) == len(programs)
    cache.clear()
    for program, other in zip(programs[1:], others, strict=True):
        again = hl.compile(coupler(), **{"T": T, name: other})
        assert again is not program and instructions(again) == instructions(program)


def test_watched_channels_and_their_order_are_part_of_the_key():
    z = hl.coordinate("z", unit="m")
    m, k = hl.parameters("m k", units="kg N/m", values=(0.1, 100.0))
    F = k * (x(t) - z)
    watched = ([], [z], [z, z.diff(t)], [z.diff(t), z], {"y": z})
    programs = [hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], watch=watch), T=T) for watch in watched]
    names = [[c.name for c in program.outputs[1:]] for program in programs]
    assert names == [
        [],
        [
            "z",
        ],
        ["z", "Derivative(z(t), t)"],
        ["Derivative(z(t), t)", "z"],
        ["y"],
    ]


def test_a_students_function_that_is_defined_anew_is_no_longer_the_one_before():
    assert content(bent(x(n))) is None and content(lambda: 1) is None and content(type("Mine", (hl.Scene,), {})) is None
    assert content(hl.wall()) is not None


def test_a_law_that_changes_what_it_returns_is_compiled_as_it_is_now():
    gain = {"k": 2}

    def law(scene):
        return hl.Scene(force=gain["k"] * scene.force, values=scene.values)

    wall = hl.wall()(k=300.0, x_o=0.0)
    first = felt(law(wall), x=[0.01])
    gain["k"] = 3
    assert felt(law(wall), x=[0.01]) == pytest.approx(1.5 * first)


def test_a_coordinate_that_was_changed_after_it_was_made_has_a_key_of_its_own():
    scene = coupler(initial=1e-3)
    (z,) = scene.coordinates
    before = hl.compile(scene, T=T)
    type(z).initial = sp.Float(2e-3)
    after = hl.compile(scene, T=T)
    assert after is not before and instructions(after) != instructions(before)


def test_a_scene_that_was_forced_to_change_is_compiled_anew():
    scene = hl.wall()(k=300, x_o=0.01)
    before = hl.compile(scene, T=T)
    object.__setattr__(scene, "force", -scene.force)
    after = hl.compile(scene, T=T)
    assert instructions(after) != instructions(before)
    assert hl.compile(hl.wall()(k=300, x_o=0.01), T=T) is before


def test_unevaluated_arithmetic_is_kept_apart():
    wall = hl.wall()
    usual = content(wall)
    with sp.evaluate(False):
        assert content(wall) != usual
    assert content(wall) == usual


def test_a_key_does_not_change_when_the_scene_is_used():
    K, m, g = hl.parameters("K m g", units="N/m kg m/s^2", values=(200, 0.05, 9.81))
    y = hl.coordinate("y", unit="m", initial=x(n))
    lands = hl.contact.Contact(y, hl.contact.impulse(e=0.5), name="lands")
    motion = hl.mechanics.lagrange(m * y.diff(t) ** 2 / 2 - m * g * y, forces={y: K * (x(t) - y)}, contacts=[lands])
    contact = hl.Scene(force=K * (x(t) - y), eom=[motion], watch=[y])
    for scene, method in ((coupler(), "rk4"), (hl.wall()(k=3, x_o=0), "rk4"), (contact, "taylor")):
        first = hl.compile(scene, method, T=T)
        str(scene), scene._repr_latex_(), scene.explicit(), scene.coordinates, scene.watch_units
        assert hl.compile(scene, method, T=T) is first


def test_a_program_is_read_only():
    program = hl.compile(coupler(), T=T)
    assert program.limits and program.facts
    for broken in (lambda: program.facts.update(a=1), lambda: program.facts.__setitem__("a", 1)):
        with pytest.raises((AttributeError, TypeError)):
            broken()
    with pytest.raises((AttributeError, TypeError)):
        program.limits["K"] = (0, 0, 0)
    with pytest.raises(FrozenInstanceError):
        program.T = 2.0
    with pytest.raises((FrozenInstanceError, TypeError)):
        program.tick.instructions[0].value = 3.0


def test_programs_that_differ_in_a_constant_alone_do_not_share_machine_code():
    def with_constant(c):
        b = Builder("f64")
        tick = b.block([b.leaf("input", 0, "f64") * b.leaf("input", 0, "f64") + b.leaf("input", 0, "f64")])
        tick = replace(tick, instructions=(*tick.instructions, Instruction("const", (), "f64", c)))
        tick = replace(tick, outputs=(len(tick.instructions) - 1,))
        channel = Channel("x", "m", "f64")
        return Program("p", (channel,), (), (), (replace(channel, name="F"),), Block(), tick, T)

    constants = (0.0, -0.0, 1.0, np.nextafter(1.0, 2), 5e-324, -5e-324, 1e-17)
    programs = [with_constant(c) for c in constants]
    assert len({instructions(program) for program in programs}) == len(constants)
    for c, program in zip(constants, programs, strict=True):
        assert_same_bits(load(program).run(1, np.ones((1, 1))).outputs, np.full((1, 1, 1), c))
    seeds = range(30)
    assert [instructions(random_program(seed)) for seed in seeds] == [instructions(random_program(seed)) for seed in seeds]
    assert len({instructions(random_program(seed)) for seed in seeds}) == len(seeds)


def test_what_could_not_be_made_is_not_kept_and_the_error_comes_again():
    for _ in range(2):
        with pytest.raises(hl.errors.HapticlabError, match="method"):
            hl.compile(coupler(), "no such", T=T)
    assert len(PROGRAMS) == 0


@pytest.mark.wide
@pytest.mark.parametrize("table", [PROGRAMS, LINKED, KERNELS], ids=["programs", "linked", "kernels"])
def test_tables_stay_within_their_bound(table, monkeypatch):
    monkeypatch.setattr(table, "most", 3000)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    weights = []
    for c in range(1, 40):
        paddle.run(coupler(c=sp.Integer(c)), duration=0.002, progress=False, engine="interpreter")
        weights.append(table.weight)
    assert 0 < max(weights) <= 3000 and 0 < len(table) < 39


def test_the_latest_is_kept_the_oldest_goes_and_what_is_too_heavy_is_not_kept():
    table = Shared(10, weight=lambda number: number)
    made = []

    def get(number):
        return table.get(number, lambda: made.append(number) or number)

    for number in (4, 5, 4, 3, 4, 5, 11, 11, 4):
        assert get(number) == number
    assert made == [4, 5, 3, 5, 11, 11]
    assert table.weight <= 10


def test_threads_that_ask_at_once_wait_for_one():
    table, made, together = Shared(10), [], threading.Barrier(8)

    def ask(_):
        together.wait()
        return table.get("key", lambda: made.append(object()) or made[-1])

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(ask, range(8)))
    assert len(made) == 1 and all(one is made[0] for one in found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_fork_keeps_what_was_made_and_waits_for_nobody():
    # one thread is making something while the process forks: its child must not wait for that thread
    script = (
        "import os, threading\nfrom hapticlab.compiler.ir.cache import Shared\ntable, inside, go = Shared(9), threading.Event(), "
        "threading.Event()\ntable.get('done', lambda: 1)\n"
        "other = threading.Thread(target=lambda: table.get('under way', lambda: inside.set() or go.wait()))\n"
        "other.start(); inside.wait()\nchild = os.fork()\nif child == 0:\n"
        "    os._exit(table.get('done', lambda: 2) * 10 + table.get('under way', lambda: 3))\n"
        "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])); go.set(); other.join()\n"
    )
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "13", done.stderr


def test_engines_and_measures_are_kept_apart():
    pytest.importorskip("llvmlite")
    program = hl.compile(coupler(), T=T)
    names = {load(program, engine).name for engine in ("interpreter", "llvm", "interpreter", "auto")}
    assert names == {"interpreter", "llvm"}
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    given = {"duration": 0.05, "v": 0.1, "delay": [0.0, 1e-3], "progress": False}
    values = {metric: hl.sweep(coupler(), paddle, metric=metric, **given).values for metric in ("energy", "peak_force") * 2}
    cache.clear()
    assert_same_bits(hl.sweep(coupler(), paddle, metric="energy", **given).values, values["energy"])
    assert not np.array_equal(values["energy"], values["peak_force"])


def test_paddles_of_one_structure_share_a_loop_and_keep_their_numbers():
    light, heavy = (hl.SimulatedPaddle(m=m, b=0.1, T=T) for m in (0.05, 0.5))
    delayed = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=1.5e-3)
    runs = [paddle.run(coupler(), duration=0.05, v=0.2, progress=False).x for paddle in (light, heavy, delayed, light)]
    assert len(LINKED) == 2
    cache.clear()
    fresh = [paddle.run(coupler(), duration=0.05, v=0.2, progress=False).x for paddle in (heavy, delayed)]
    assert_same_bits(runs[1], fresh[0])
    assert_same_bits(runs[2], fresh[1])
    assert_same_bits(runs[3], runs[0])


def test_parameters_are_told_apart_by_all_that_they_are():
    make = [
        lambda: Parameter("k", "N/m"), lambda: Parameter("k", "N"), lambda: Parameter("k", "N/m", 0.0),
        lambda: Parameter("k", "N/m", -0.0), lambda: Parameter("k", "N/m", 0.0, 9.0), lambda: Parameter("k", "N/m", value=1.0),
        lambda: Parameter("K", "N/m"),
    ]  # fmt: skip
    keys = [cache.content(one() ** 2, (one(), "N/m")) for one in make]
    assert len(set(keys)) == len(make) and None not in keys
    assert keys == [cache.content(one() ** 2, (one(), "".join(["N", "/m"]))) for one in make]
    together = cache.content(*(Parameter("k", "N/m"), Parameter("k", "N")))
    assert together != cache.content(*(Parameter("k", "N/m"), Parameter("k", "N/m"))) and together is not None
