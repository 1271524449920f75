"""WebAssembly gives the interpreter's bits: in wasmtime and in node, fresh and resumed, lane by lane."""

import functools
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from in_node import case, in_node
from random_programs import PRIMITIVE, assert_same_bits, random_program, random_rows
from test_golden import GOLDEN, array, program_of

import hapticlab as hl
from hapticlab.compiler.engines import skipped_arms
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.wasm import Wasm, _Instance, is_in_browser
from hapticlab.compiler.engines.wasm_emit import at_once, emit
from hapticlab.compiler.engines.wasm_lanes import ONE, TWO
from hapticlab.compiler.engines.wasm_words import OPCODES, assemble, signed, unsigned
from hapticlab.compiler.ir.operations import ELEMENTARY, OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, select
from hapticlab.device.simulated.closed_loop import link
from hapticlab.errors import ProgramError

if not is_in_browser():
    pytest.importorskip("wasmtime", reason="needs wasmtime, or llvmlite is missing on purpose and wasmtime with it")
pytestmark = pytest.mark.machine_code
TICKS, CUT = 12, 7
REALS = {"f32": ("f32",), "f64": ("f64",), "mixed": ("f32", "f64")}


def drive(program, seed, ticks, lanes):
    """Return seeded inputs (ticks, inputs) and parameters (parameters, lanes)."""
    rng = np.random.default_rng(seed)
    return random_rows(rng, program.inputs, ticks).T.copy(), random_rows(rng, program.parameters, lanes)


def of_seed(seed, reals):
    """Return a random program, its inputs, and parameters of 1 to 4 lanes; every third has elementary functions."""
    operations = {0: tuple(OPERATIONS), 1: (*PRIMITIVE, *["select"] * 6), 2: (*PRIMITIVE, *ELEMENTARY)}[seed % 3]
    program = random_program(seed, REALS[reals], operations=operations, size=(40, 90, 250)[seed % 3])
    return program, *drive(program, seed, TICKS, 1 + seed % 4)


def assert_whole_and_resumed(run, program, inputs, parameters):
    """A run, the same cut in two, and every fifth result are the interpreter's."""
    reference = load(program, "interpreter").run(TICKS, inputs, parameters)
    outputs, states = run(TICKS, inputs, parameters, None, 1)
    assert_same_bits(outputs, reference.outputs)
    assert_same_bits(states, reference.states)
    head, middle = run(CUT, inputs[:CUT], parameters, None, 1)
    assert_same_bits(head, reference.outputs[:CUT])
    rest, states = run(TICKS - CUT, inputs[CUT:], parameters, middle, 1)
    assert_same_bits(rest, reference.outputs[CUT:])
    assert_same_bits(states, reference.states)
    assert_same_bits(run(TICKS, inputs, parameters, None, 5)[0], reference.outputs[4::5])


@pytest.mark.parametrize("reals", REALS)
@pytest.mark.parametrize("seed", range(30))
@pytest.mark.always("[0-3]-mixed", "1[0-3]-f32", "2[0-3]-f64")
def test_a_random_program_gives_the_interpreters_bits(monkeypatch, seed, reals):
    monkeypatch.setattr(skipped_arms, "WORTH", 1 + seed % 5)
    program, inputs, parameters = of_seed(seed, reals)
    engine = load(program, "wasm")
    assert_whole_and_resumed(engine.run, program, inputs, parameters)


@functools.cache
def scenes():
    """Return linked programs of scenes, with the values of their parameters: walls, a mechanism, taylor, an exact method."""
    k, x_o = hl.parameters("k x_o", units="N/m m", values=(150, 0.01))
    wall = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)))
    plain = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
    noisy = hl.SimulatedPaddle.from_profile("hapkit", coulomb=0.03, noise=1e-6, hand=hl.Hand("pinch", push=1.0))
    made, library, exact = [], hl.library, {"method": "exact", "live": ()}
    for paddle, scene, options in (
        (plain, wall, {}), (noisy, wall, {}), (plain, library.four_bar(), {}), (plain, library.two_masses(), exact),
        (plain, library.ball_on_the_paddle(), {"method": "taylor", "dtype": "float64"}),
    ):  # fmt: skip
        program = paddle.program(scene, **options)
        made.append((link(program, paddle), paddle, (*program.values, *paddle.plant_values(0.0, 0.1))))
    return made


def lanes_of(values, lanes):
    return np.array(values)[:, None] * (1 + 1e-3 * np.arange(lanes))


def test_scenes_linked_with_a_paddle_move_as_on_the_interpreter():
    for program, paddle, values in scenes():
        inputs = paddle.inputs(TICKS)
        assert_whole_and_resumed(load(program, "wasm").run, program, inputs, lanes_of(values, 2))


def test_an_event_left_unlocated_is_counted_alike():
    """Near this steep force a series has not converged in a step, so an event in it is not located."""
    s1, y = hl.parameters("s_1", units="s", values=1.0), hl.coordinate("y", unit="1", initial=0.35)
    law = -20 * sp.tanh(300 * y) - hl.when(y < -0.1, 1)
    scene = hl.Scene(0, [sp.Eq(s1**2 * y.diff(hl.t, 2), law)])
    program = hl.compile(scene, method="taylor", T=1e-3, dtype="float64", live=())
    assert program.outputs[-1].name == "unlocated"
    inputs, values = np.zeros((230, len(program.inputs))), np.array(program.values)[:, None]
    runs = [load(program, engine).run(230, inputs, values) for engine in ("wasm", "interpreter")]
    assert runs[0].outputs[:, -1].any()
    assert_same_bits(runs[0].outputs, runs[1].outputs)


# ---------------------------------------------------------------- in node


def check_in_node(programs, every=1):
    """Run each (program, ticks, inputs, parameters) whole, and its second half resumed, in one process of node."""
    cases, expected = [], []
    for program, ticks, inputs, parameters in programs:
        reference, cut = load(program, "interpreter"), ticks // 2
        first = reference.run(cut, inputs[:cut], parameters)
        cases.append(case(program, ticks, inputs, parameters, every=every))
        expected.append(reference.run(ticks, inputs, parameters, every=every))
        cases.append(case(program, ticks - cut, inputs[cut:], parameters, states=first.states))
        expected.append(reference.run(ticks - cut, inputs[cut:], parameters, states=first.states))
    for (outputs, states, said), reference in zip(in_node(cases), expected, strict=True):
        assert_same_bits(outputs, reference.outputs)
        assert_same_bits(states, reference.states)
        assert said["needs"] == [0, 0, 0, 0]  # a library for Emscripten's dlopen that brings neither data nor a table


def golden():
    for g in GOLDEN:
        program = program_of(g)
        ticks = len(g["given"]) // len(g["inputs"])
        yield program, ticks, array(g["given"], ticks, -1), np.array(program.values)[:, None]


def test_node_gives_the_bits_of_golden_programs_and_of_linked_scenes():
    linked = ((program, TICKS, paddle.inputs(TICKS), lanes_of(values, 4)) for program, paddle, values in scenes())
    check_in_node([*golden(), *linked])


@pytest.mark.wide
@pytest.mark.parametrize("reals", REALS)
def test_node_gives_the_bits_of_random_programs(monkeypatch, reals):
    """Even numbers of lanes two at once, whatever can be skipped."""
    monkeypatch.setattr(skipped_arms, "WORTH", 2)
    monkeypatch.setattr("in_node.at_once", lambda program: TWO)
    made = (of_seed(seed, reals) for seed in range(30))
    check_in_node([(program, TICKS, inputs, parameters) for program, inputs, parameters in made], every=3)


# ---------------------------------------------------------------- what is written


@pytest.mark.parametrize("number", [0, 1, 63, 64, 127, 128, 300, 2**31 - 1])
def test_numbers_are_written_as_leb128(number):
    """Read back by the definition: the sum of seven bits a byte, and its sign."""

    def read(code, is_signed):
        total = sum((byte & 127) << 7 * k for k, byte in enumerate(code))
        assert all(byte & 128 for byte in code[:-1]) and not code[-1] & 128
        return total - (1 << 7 * len(code)) if is_signed and code[-1] & 64 else total

    assert read(unsigned(number), False) == number
    assert read(signed(number), True) == number and read(signed(-number - 1), True) == -number - 1


@pytest.mark.parametrize("lanes", [ONE, TWO])
def test_words_are_the_bytes_that_wasmtimes_own_assembler_makes_of_them(lanes):
    import wasmtime

    def same(words, taken, given):
        inside = f"{' '.join(f'local.get {k}' for k in range(len(taken)))} {words}"
        module = bytes(wasmtime.wat2wasm(f"(module (func (param {' '.join(taken)}) (result {given}) {inside}))"))
        assert assemble(words) + OPCODES["end"] in module, words

    kinds = {"R": ("f32", "f64"), "B": ("bool",), "I": ("i32",)}
    for op, record in OPERATIONS.items():
        first, result = record.operands[0], record.result
        for operand, type in ((o, t) for o in kinds[first] for t in kinds[result] if op not in ELEMENTARY):
            if first == result == "R" and (operand == type) == (op == "cast"):
                continue  # there is no such operation
            rest = [lanes.types[type if op == "select" else operand]] * (len(record.operands) - 1)
            taken = [*rest, lanes.types["bool"]] if op == "select" else [lanes.types[operand], *rest]
            same(lanes.words_of(op, type, operand), taken, lanes.types[type])
    for type in lanes.types:
        wide = lanes.types["f64"]
        same(lanes.loaded[type], [wide], lanes.types[type])
        same(lanes.stored[type], [lanes.types[type]], wide)


def test_locals_are_used_again_and_arms_are_branches():
    def body(x):
        slow = x
        for _ in range(300):
            slow = slow * 1.5 + 1.0
        return select(x < 0.0, x, slow)

    b = Builder("f64")
    tick = b.block([body(b.leaf("input", 0, "f64"))])
    program = Program("one", (Channel("x", "1", "f64"),), (), (), (Channel("y", "1", "f64"),), Block(), tick, 1e-3)
    code = emit(program)
    assert len(code) < 600 * 20  # an instruction, two operands and a constant
    assert OPCODES["if"] in code
    inputs = np.array([[-1.0], [2.0], [np.nan], [-0.0]])
    assert_same_bits(load(program, "wasm").run(4, inputs).outputs, load(program, "interpreter").run(4, inputs).outputs)


@pytest.mark.wide
def test_a_program_of_many_results_stays_within_the_locals_that_hosts_allow():
    """Browsers and wasmtime take at most 50 000 locals a function."""
    b = Builder("f64")
    x = b.leaf("input", 0, "f64")
    total = x
    for _ in range(60_000):
        total = total * 1.0000001 + x
    real = Channel("x", "1", "f64")
    program = Program("long", (real,), (), (), (replace(real, name="y"),), Block(), b.block([total]), 1e-3)
    inputs = np.array([[0.5]])
    assert_same_bits(load(program, "wasm").run(1, inputs).outputs, load(program, "interpreter").run(1, inputs).outputs)


# ---------------------------------------------------------------- in wasmtime


def test_a_long_run_goes_through_its_memory_in_pieces(monkeypatch):
    monkeypatch.setattr("hapticlab.compiler.engines.wasm.ROOM", 100)
    program = random_program(3)
    inputs, parameters = drive(program, 3, 90, 3)
    reference = load(program, "interpreter").run(90, inputs, parameters)
    for every in (1, 7, 90, 100):
        run = load(program, "wasm").run(90, inputs, parameters, every=every)
        assert_same_bits(run.outputs, reference.outputs[every - 1 :: every])
        assert_same_bits(run.states, reference.states)


def test_a_program_may_have_no_inputs_parameters_or_states():
    b = Builder("f64")
    program = Program("bare", (), (), (), (Channel("y", "1", "f64"),), Block(), b.block([b.const(2.5)]), 1e-3)
    assert load(program, "wasm").run(3).outputs.tolist() == [[[2.5]]] * 3
    assert load(program, "wasm").run(2, parameters=np.empty((0, 20))).outputs.shape == (2, 1, 20)


def test_threads_share_nothing():
    program = random_program(11)
    inputs, parameters = drive(program, 11, 50, 4)
    engine, reference = load(program, "wasm"), load(program, "interpreter").run(50, inputs, parameters)
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda _: engine.run(50, inputs, parameters), range(16)))
    for result in results:
        assert_same_bits(result.outputs, reference.outputs)
        assert_same_bits(result.states, reference.states)


def test_a_process_of_little_memory_runs_it_and_ends_in_silence():
    """As in a sandbox of graded work; 1 GiB of addresses more than the package needs by itself, where they can be limited."""
    code = (
        "import sys, hapticlab as hl, wasmtime; from hapticlab.compiler.engines.engine import load\n"
        "p = hl.compile(hl.wall()(k=1, x_o=0), T=1e-3)\n"
        "if sys.platform == 'linux':\n"
        "    import resource; used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "    resource.setrlimit(resource.RLIMIT_AS, (used + 2**30,) * 2)\n"
        "print(load(p, 'wasm').run(2, [0.0, 1.0]).outputs[-1, 0, 0])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "1.0" and not done.stderr


def test_what_its_memory_does_not_hold_is_said():
    with pytest.raises(ProgramError, match=r"a run needs 8 GiB; .*at most 4 GiB, .*run fewer lanes, .*interpreter"):
        _Instance(load(random_program(3), "wasm")._kernel._host(ONE)._module)._arrays((2**30, 0, 0, 0))


def test_a_library_is_called_with_the_arrays_where_they_are(monkeypatch):
    """In place of Emscripten's dlopen: the file must be the module, and machine code runs on the addresses it is given."""
    pytest.importorskip("llvmlite")
    program = random_program(5)
    inputs, parameters = drive(program, 5, TICKS, 3)
    machine, opened = load(program, "llvm")._kernel._function(1), []

    class Opened:
        def __init__(self, path):
            opened.append(Path(path).read_bytes())
            self.run = lambda ticks, every, stride, *rest: machine(ticks, every, 0, stride // 8, stride // 8, *rest)

    monkeypatch.setattr("hapticlab.compiler.engines.wasm.is_in_browser", lambda: True)
    monkeypatch.setattr("ctypes.CDLL", Opened)
    library = Wasm(program)
    assert_whole_and_resumed(lambda *given: library.run(*given), program, inputs, parameters)
    assert opened == [emit(program), emit(program, at_once(program))][: len(opened)]
    row, states = inputs[0].copy(), library.run(1, inputs[:1], parameters[:, :1])[1]
    expected = load(program, "interpreter").run(1, row[None], parameters[:, 0], states)
    given = row, parameters[:, 0].copy(), states[:, 0].copy(), np.empty(len(program.outputs))
    library.bound(*given)()
    assert_same_bits(given[3], expected.outputs[0, :, 0])
    assert_same_bits(given[2], expected.states[:, 0])


def test_a_module_that_its_host_refuses_is_said(monkeypatch):
    monkeypatch.setattr("hapticlab.compiler.engines.wasm.emit", lambda *given: b"no module")
    with pytest.raises(ProgramError, match='(?s)random4: wasmtime refuses it: .*use engine="interpreter"'):
        Wasm(random_program(4)).run(1, *drive(random_program(4), 4, 1, 1))
