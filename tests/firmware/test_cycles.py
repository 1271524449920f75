"""Cycles counted in emulation against what hapticlab.compiler.boards.cost says: typical close, bound never passed."""

import bare
import cortex
import numpy as np
import pico_emulator
import pytest
from bare import Avr, Bench, avr_image, avr_tool, symbols
from cortex import Cortex
from five_scenes import SCENES, compiled, handle
from measure_costs import EFFORT, as_values, awkward, awkward_bits, measure, overheads, program_of
from pico_bench import Rp2040
from pico_step import measure_pico_step
from random_programs import random_program, random_rows
from whole_step import measure_step

import hapticlab as hl
from hapticlab.compiler.boards.board_fit import table
from hapticlab.compiler.boards.cost import TYPICAL_ERROR, cost, tables
from hapticlab.compiler.engines.bytecode import OPCODES

#: name -> why it is not here, and what makes it
BOARDS = {
    "uno": (bare.missing, Avr),
    "pico": (pico_emulator.missing, Rp2040),
    "cortex-m4f": (cortex.missing, lambda: Cortex("cortex-m4f")),
}
needs_uno = pytest.mark.skipif(bool(bare.missing()), reason=str(bare.missing()))
TICKS = {"uno": 600}  # else 40: unicorn is slower


@pytest.fixture(scope="module", params=BOARDS)
def processor(request):
    missing, make = BOARDS[request.param]
    reason = missing()
    if reason:
        pytest.skip(reason)
    made = make()
    made.board = request.param
    return made


def awkward_rows(program, count, seed=1):
    """Return bits for every parameter, input and state; a bool is 0 or 1 as whoever writes it makes sure."""
    rng = np.random.default_rng(seed)
    columns = []
    for c in (*program.parameters, *program.inputs, *program.states):
        bits = awkward_bits(rng, count)
        columns.append(bits & 1 if c.type == "bool" else bits)
    rows = np.stack(columns, axis=1)
    same = rng.random(rows.shape) < 0.3  # operands that cancel
    floats = [k for k, c in enumerate((*program.parameters, *program.inputs, *program.states)) if c.type == "f32"]
    near = rows[:, [floats[0]]] ^ (1 << rng.integers(0, 3, rows.shape)).astype(np.uint32)
    rows[:, floats] = np.where(same, near, rows)[:, floats]
    return rows


@pytest.mark.parametrize("hold", ["soh", "zoh"])
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
@pytest.mark.always("*-wall-soh", "*-wall-zoh")
def test_five_scenes_take_the_typical_cycles_and_never_more_than_the_bound(make, hold, processor):
    program = compiled(make, hold=hold)
    said = cost(program, processor.board)
    bench = Bench(program, processor)
    ticks = TICKS.get(processor.board, 40)
    measured = bench.run(handle(ticks))[2]
    median = float(np.median(measured))
    assert abs(said.typical / median - 1) <= TYPICAL_ERROR, f"typical {said.typical}, measured median {median:g}"
    worst = max(int(measured.max()), int(bench.cycles_of(awkward_rows(program, ticks)).max()))
    print(f"\n{said.board.name} {program.name} ({hold}): median {median:g} typical {said.typical}, "
          f"most found {worst} bound {said.bound} slack {said.bound / worst - 1:.0%}")  # fmt: skip
    assert worst <= said.bound
    assert bench.init_cycles <= said.first


@needs_uno
@pytest.mark.parametrize("start", [1.2, 2.9])
@pytest.mark.parametrize("make", SCENES[2:], ids=lambda make: make.__name__)
@pytest.mark.always("cart_pole-2.9")
def test_typical_cycles_hold_for_wide_angles_too(make, start):
    """A pendulum let go near the top: its sines leave the first eighth of a turn, and take longer."""
    scene, options = make(start)
    program = hl.compile(scene, T=1e-3, **options)
    median = float(np.median(Bench(program, Avr()).run(handle(1000))[2]))
    assert abs(cost(program).typical / median - 1) <= TYPICAL_ERROR


@pytest.mark.parametrize("seed", range(12))
def test_no_random_program_passes_its_bound(seed, processor):
    program = random_program(seed, ("f32",), 50, tuple(OPCODES))
    said, bench = cost(program, processor.board), Bench(program, processor)
    found = bench.cycles_of(awkward_rows(program, 200 if processor.board == "uno" else 10, seed))
    assert found.max() <= said.bound
    assert found.max() > said.bound / 4, "a bound that far away says nothing"
    bench.run(random_rows(np.random.default_rng(seed), program.inputs, 1).T)
    assert bench.init_cycles <= said.first


@pytest.mark.parametrize("op", OPCODES)
def test_no_operation_passes_its_bound_on_new_operands(op, processor):
    """Other seeds than those the table was made with."""
    around = tables()[processor.board]["overheads"]
    bits = awkward(op, np.random.default_rng(77), 3000 if processor.board == "uno" else 100)
    cycles = Bench(program_of(op), processor).run(as_values(op, bits), init=False)[2].astype(int)
    assert (cycles - around["tick"] - around["output f32"]).max() <= 1.02 * tables()[processor.board]["operations"][op][1]


def test_the_committed_table_is_what_is_measured(processor):
    """A part of it, with a smaller search; ``python tests/firmware/measure_costs.py`` writes the whole."""
    committed = tables()[processor.board]
    found = overheads(processor)
    assert found == committed["overheads"]
    base = found["tick"] + found["output f32"]
    usual, _, keep, _ = EFFORT[processor.board]
    for op in ("neg", "add", "mul", "select", "floor", "sin"):
        typical, worst = measure(Bench(program_of(op), processor), op, base, (usual, 300, keep, 1))
        assert typical == committed["operations"][op][0], op
        assert worst <= committed["operations"][op][1], op


@pytest.mark.slow
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_bounds_hold_over_20_000_awkward_states(make, processor):
    program = compiled(make)
    count = 20_000 if processor.board == "uno" else 300
    found = Bench(program, processor).cycles_of(awkward_rows(program, count, seed=9)).max()
    assert found <= cost(program, processor.board).bound


@needs_uno
@pytest.mark.wide
def test_the_rest_of_a_step_and_a_frame_are_what_the_table_says():
    """The real image, in emulation; a change of the loop asks for a new table."""
    found, committed = measure_step(), tables()["uno"]
    assert found["step"][0] == pytest.approx(committed["step"][0], rel=0.05)
    assert all(new <= 1.05 * old for new, old in zip(found["step"][1:], committed["step"][1:], strict=True))
    for size in (23, 43):
        (fixed, each), (f, e) = found["frame"], committed["frame"]
        assert fixed + each * size == pytest.approx(f + e * size, rel=0.1)
    for name, answer in found["answers"].items():
        assert answer[0] <= 1.1 * committed["answers"][name][0]
    assert found["heat"] <= 1.1 * committed["heat"]
    assert found["sent_byte"] <= committed["sent_byte"] and found["received_byte"] <= committed["received_byte"]


@pytest.mark.skipif(bool(pico_emulator.missing()), reason=str(pico_emulator.missing()))
@pytest.mark.slow  # a part of the table always runs: test_the_committed_table_is_what_is_measured
def test_the_rest_of_a_step_on_the_pico_is_what_the_table_says():
    found, committed = measure_pico_step(), tables()["pico"]
    assert found["step"][0] == pytest.approx(committed["step"][0], rel=0.05)
    assert all(new <= 1.05 * old for new, old in zip(found["step"][1:], committed["step"][1:], strict=True))
    assert found["frame"][1] == pytest.approx(committed["frame"][1], rel=0.1) and found["late"] <= committed["late"]


@needs_uno
def test_tables_stay_in_flash():
    address = symbols(avr_tool("nm"), avr_image())
    tables_of_the_machine = [name for name in address if name.startswith(("bodies", "signatures"))]
    assert len(tables_of_the_machine) == 2
    assert all(address[name] < 0x80_0000 for name in tables_of_the_machine)
    assert "__do_copy_data" not in address, "constants of the machine are copied to RAM"


def test_print_what_fits():
    """The table of the five scenes, for whoever reads the log."""
    for board in BOARDS:
        print("\n" + table([make() for make in SCENES], board))
    assert "double pendulum" in table([SCENES[-1]()])
