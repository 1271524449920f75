"""The C machine against the interpreter, bit for bit; and everything a damaged program may be, refused."""

import ctypes
import os
import struct
import subprocess
import sys

import numpy as np
import pytest
from encoded import is_sound, operand_positions, sealed, with_word, word_positions
from random_programs import assert_same_bits, kept_finite, random_program, random_rows

from hapticlab.compiler.engines import firmware_library, toolchain, vm
from hapticlab.compiler.engines.bytecode import HEADER, OPCODES, RESULTS, encode, layout
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.interpreter import Interpreter
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
from hapticlab.compiler.ir.trace import Builder
from hapticlab.errors import ProgramError

pytestmark = pytest.mark.machine_code

EVERY = tuple(OPCODES)
WORDS = (8, 16)


def number(result):
    return RESULTS[result][0]


def verify(data, word_bits, capacity=256):
    """Return what hl_verify says, in memory of exactly the given sizes."""
    memory = (ctypes.c_int32 * max(1, capacity))()
    return vm.machine(word_bits).hl_host_verify(bytes(data), len(data), memory, capacity)


def small_program(seed=7):
    return kept_finite(random_program(seed, ("f32",), 40, EVERY))


def drive(program, seed, ticks, lanes):
    rng = np.random.default_rng(seed)
    return random_rows(rng, program.inputs, ticks).T.copy(), random_rows(rng, program.parameters, lanes)


def reciprocal():
    """F = 1/x with a state that counts samples; x = 0 is a fault."""
    b = Builder("f32")
    init = b.block(states=[b.const(0.0, "f32")])
    b = Builder("f32")
    s = b.leaf("state", 0, "f32")
    tick = b.block([1.0 / b.leaf("input", 0, "f32"), s], [s + 1.0])
    return Program("reciprocal", (Channel("x"),), (), (Channel("s"),), (Channel("F"), Channel("s")), init, tick, 1e-3)


@pytest.mark.parametrize("word_bits", WORDS)
@pytest.mark.parametrize("seed", range(40))
@pytest.mark.always("0-*", "3-*", "15-*", "27-*")
def test_a_random_program_gives_the_interpreters_bits(seed, word_bits):
    program = kept_finite(random_program(seed, ("f32",), 80, EVERY))
    inputs, parameters = drive(program, seed, 6, 3)
    outputs, states = vm.Vm(program, word_bits).run(6, inputs, parameters)
    reference, end = Interpreter(program).run(6, inputs, parameters)
    assert_same_bits(outputs, reference)
    assert_same_bits(states, end)


@pytest.mark.wide
@pytest.mark.parametrize("seed", range(10))
def test_switch_and_computed_goto_do_the_same(seed, monkeypatch):
    program = small_program(seed)
    inputs, parameters = drive(program, seed, 6, 2)
    machine = vm.Vm(program)
    outputs, states = machine.run(6, inputs, parameters)
    monkeypatch.setattr(machine, "_library", vm.machine(16, "-DHL_NO_COMPUTED_GOTO"))
    again, end = machine.run(6, inputs, parameters)
    assert_same_bits(outputs, again)
    assert_same_bits(states, end)


@pytest.mark.parametrize("word_bits", WORDS)
@pytest.mark.always("16")
def test_every_float32_operation_on_awkward_operands(word_bits):
    """Bits of each result, seen through programs of one instruction each, nan and infinities among the operands."""
    hard = [0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.5, 1e-45, -1e-45, 1.17549435e-38, 3e38, -3e38, 8388607.5, 8388609.0]
    hard += [-127.3, 128.0, 100.0, -150.0, 4097.5, 9000.0, np.inf, -np.inf, np.nan]
    grid = np.array(np.meshgrid(hard, hard)).reshape(2, -1).T.copy()
    for op in ("neg abs add sub mul div sqrt floor lt le eq sin cos exp log atan tanh exp2i exponent").split():
        two = op in ("add", "sub", "mul", "div", "lt", "le", "eq")
        type = "bool" if op in ("lt", "le", "eq") else "f32"
        code = [Instruction("input", (), "f32", index=k) for k in range(2)]
        code.append(Instruction(op, (0, 1) if two else (0,), type))
        names = Channel("a"), Channel("b")
        p = Program(op, names, (), (), (Channel("y", "1", type),), Block(), Block(tuple(code), (2,)), 1e-3)
        p = kept_finite(p)
        reference = Interpreter(p).run(len(grid), grid, np.empty((0, 1)))[0]
        assert_same_bits(vm.Vm(p, word_bits).run(len(grid), grid, np.empty((0, 1)))[0], reference)


def test_the_contract_of_engines():
    program = small_program()
    inputs, parameters = drive(program, 1, 11, 2)
    machine = load(program, "vm")
    assert machine.name == "vm"
    whole = machine.run(11, inputs, parameters)
    assert whole.outputs.shape == (11, len(program.outputs), 2)
    assert_same_bits(machine.run(11, inputs, parameters, every=4).outputs, whole.outputs[3::4])
    first = machine.run(4, inputs[:4], parameters)
    rest = machine.run(7, inputs[4:], parameters, states=first.states)
    assert_same_bits(rest.outputs, whole.outputs[4:])
    assert_same_bits(rest.states, whole.states)
    alone = machine.run(11, inputs, parameters[:, 1])
    assert_same_bits(alone.outputs[..., 0], whole.outputs[..., 1])


@pytest.mark.parametrize("word_bits", WORDS)
def test_from_a_fault_on_everything_is_nan_and_the_fault_has_a_name(word_bits):
    machine = vm.Vm(reciprocal(), word_bits)
    outputs, states = machine.run(4, np.array([[2.0], [4.0], [0.0], [1.0]]), np.empty((0, 1)))
    assert outputs[:2, :, 0].tolist() == [[0.5, 0.0], [0.25, 1.0]]
    assert np.isnan(outputs[2:]).all()
    assert np.isnan(states).all()
    assert machine.faults[0].startswith("OUTPUT_NOT_FINITE: an output is nan or infinite")


def test_a_state_that_is_not_finite_is_a_fault_even_if_no_output_shows_it():
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    program = Program(
        "p", (Channel("x"),), (), (Channel("s"),), (Channel("F"),), b.block(states=[x]), b.block([x], [1.0 / x]), 1e-3
    )
    machine = vm.Vm(program)
    outputs, _ = machine.run(2, np.array([[1.0], [0.0]]), np.empty((0, 1)))
    assert outputs[0] == 1.0
    assert np.isnan(outputs[1])
    assert machine.faults[0].startswith("STATE_NOT_FINITE")
    machine.run(1, np.array([[np.inf]]), np.empty((0, 1)))  # already in init
    assert machine.faults[0].startswith("STATE_NOT_FINITE")


def test_one_lane_that_fails_leaves_the_others_alone():
    b = Builder("f32")
    k = b.leaf("param", 0, "f32")
    program = Program("p", (), (Channel("k"),), (), (Channel("F"),), Block(), b.block([1.0 / k]), 1e-3, (1.0,))
    machine = vm.Vm(program)
    outputs, _ = machine.run(1, np.zeros((1, 0)), np.array([[4.0, 0.0, 5.0]]))
    assert_same_bits(outputs[0, 0], [0.25, np.nan, float(np.float32(0.2))])
    assert [f is None for f in machine.faults] == [True, False, True]


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.always("0")
def test_the_ir_refuses_every_operand_that_is_not_an_earlier_result_of_its_type(seed):
    program = small_program(seed)
    refused = excluded = 0
    for name in ("init", "tick"):
        block = getattr(program, name)
        for position, i in enumerate(block.instructions):
            for n in range(len(i.args)):
                for other in [*range(len(block)), -1, position, len(block.instructions), 10**6, None, 0.5]:
                    earlier = isinstance(other, int) and 0 <= other < position
                    if earlier and block.instructions[other].type == block.instructions[i.args[n]].type:
                        excluded += 1  # still an earlier result of the right type: another program, not a damaged one
                        continue
                    args = (*i.args[:n], other, *i.args[n + 1 :])
                    code = list(block.instructions)
                    code[position] = Instruction(i.op, args, i.type)
                    changed = {name: Block(tuple(code), block.outputs, block.states)}
                    made = {f: getattr(program, f) for f in Program.__dataclass_fields__} | changed
                    with pytest.raises(ProgramError):
                        Program(**made).verify()
                    refused += 1
    assert refused > 500
    assert excluded > 100


@pytest.mark.parametrize("word_bits", WORDS)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.always("3-8")
def test_the_machine_refuses_every_operand_that_is_not_an_earlier_result_of_its_type(seed, word_bits):
    """The CRC is mended, so that it is the check of operands that must see it."""
    data = encode(small_program(seed), word_bits=word_bits)
    assert verify(data, word_bits) == number("OK")
    registers = layout(data).size["registers"]
    refused = excluded = 0
    for block in ("init", "tick"):
        for position, _, _ in operand_positions(data, block):
            for value in [*range(registers + 2), (1 << word_bits) - 1]:
                changed = with_word(data, position, value)
                if is_sound(changed):  # a register that holds a value of the right type by then
                    excluded += 1
                    assert verify(changed, word_bits) == number("OK")
                else:
                    refused += 1
                    assert verify(changed, word_bits) in (number("OPERAND"), number("UNSET"))
    assert refused > 500
    assert excluded > 100


@pytest.mark.parametrize("word_bits", WORDS)
@pytest.mark.always("8")
def test_any_word_of_code_moves_or_outputs_is_judged_as_the_description_of_the_format_does(word_bits):
    data = encode(small_program(2), word_bits=word_bits)
    registers = layout(data).size["registers"]
    verdicts = set()
    for part in ("init", "tick", "moves", "outputs"):
        for position in word_positions(data, part):
            for value in [*range(max(registers, len(OPCODES)) + 3), (1 << word_bits) - 1]:
                changed = with_word(data, position, value)
                verdict = verify(changed, word_bits)
                assert (verdict == number("OK")) == is_sound(changed), (part, position, value)
                verdicts.add(verdict)
    assert verdicts == {number(name) for name in ("OK", "OPCODE", "OPERAND", "UNSET")}


@pytest.mark.parametrize("word_bits", WORDS)
def test_every_changed_byte_is_refused(word_bits):
    data = encode(reciprocal(), word_bits=word_bits)
    assert verify(data, word_bits) == number("OK")
    for position in range(len(data)):
        for change in range(1, 256):
            damaged = bytearray(data)
            damaged[position] ^= change
            assert verify(damaged, word_bits) != number("OK"), (position, change)


@pytest.mark.parametrize("word_bits", WORDS)
def test_every_cut_and_every_excess_is_refused_even_with_a_right_crc(word_bits):
    data = encode(small_program(), word_bits=word_bits)
    for length in range(len(data)):
        assert verify(data[:length], word_bits) != number("OK")
        if length < len(data) - 4:
            assert verify(sealed(data[:length]), word_bits) == number("SIZE")
    assert verify(data + b"\0", word_bits) == number("SIZE")
    assert verify(sealed(data[:-4] + b"\0"), word_bits) == number("SIZE")


@pytest.mark.parametrize("word_bits", WORDS)
def test_every_field_of_the_header_is_checked_by_name(word_bits):
    data = encode(small_program(), word_bits=word_bits)

    def changed(position, flip=1):
        body = bytearray(data[:-4])
        body[position] ^= flip
        return verify(sealed(body), word_bits)

    assert [changed(k) for k in range(4)] == [number("MAGIC")] * 4
    assert changed(4) == number("VERSION")
    assert changed(5) == number("WORD")
    assert [changed(k) for k in range(8, 12)] == [number("TABLE")] * 4
    assert [changed(k, 255) for k in range(18, HEADER.size)] == [number("SIZE")] * 18  # every count but the registers
    registers = layout(data).size["registers"]
    assert changed(16, registers ^ 3) == number("REGISTERS")  # fewer than constants, parameters, inputs and states
    assert changed(len(data) - 5, 2) == number("UNSET")  # the last output declared i32 instead of f32
    assert verify(data, word_bits, capacity=registers - 1) == number("REGISTERS")
    bad_type = bytearray(data[:-4])
    bad_type[layout(data).types] = 7
    assert verify(sealed(bad_type), word_bits) == number("TYPE")
    other = 24 - word_bits
    assert verify(data, other) == number("WORD")


def test_a_bool_constant_is_0_or_1():
    x, true = Instruction("input", (), "f32"), Instruction("const", (), "bool", value=True)
    code = (x, true, Instruction("neg", (0,), "f32"), Instruction("select", (1, 0, 2), "f32"))
    data = encode(Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), Block(code, (3,)), 1e-3))
    body = bytearray(data[:-4])
    body[HEADER.size] = 2
    assert verify(sealed(body), 16) == number("TYPE")


def test_states_of_bool_and_int32_are_carried_in_cycles():
    x = Instruction("input", (), "f32")
    zero, one, flag = (Instruction("const", (), t, value=v) for t, v in (("i32", 5), ("i32", 9), ("bool", True)))
    init = Block((x, zero, one, flag), states=(1, 2, 3))
    types = ("i32", "i32", "bool")
    s = [Instruction("state", (), t, index=k) for k, t in enumerate(types)]
    tick = Block((*s, Instruction("not", (2,), "bool")), (0, 2), (1, 0, 3))
    states = tuple(Channel(f"s{k}", "1", t) for k, t in enumerate(types))
    outputs = Channel("a", "1", "i32"), Channel("b", "1", "bool")
    p = Program("p", (Channel("x"),), (), states, outputs, init, tick, 1e-3)
    for word_bits in WORDS:
        out, end = vm.Vm(p, word_bits).run(3, np.zeros((3, 1)), np.empty((0, 1)))
        assert out[..., 0].tolist() == [[5, 1], [9, 0], [5, 1]]
        assert end[:, 0].tolist() == [9, 5, 0]


# ---------------------------------------------------------------- the C itself


def compiled(tmp_path, *flags, word_bits=16, target="check"):
    """Compile the checking program; skip where this compiler does not know the flags."""
    path = tmp_path / (target + (".exe" if os.name == "nt" else ""))
    firmware = firmware_library.firmware_folder()
    files = (*toolchain.sources(firmware), "boards/host/tools/check.c")
    compiler = toolchain.compilers(toolchain.running_target())[0]
    command = toolchain.build_command(compiler, firmware, word_bits, path, *flags, files=files)
    return path, subprocess.run(command, capture_output=True, text=True)


def framed(programs):
    return b"".join(struct.pack("<I", len(p)) + bytes(p) for p in programs)


@pytest.mark.wide
@pytest.mark.parametrize("word_bits", WORDS)
def test_sanitizers_find_nothing_in_damaged_programs(tmp_path, word_bits):
    flags = ("-g", "-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")
    path, done = compiled(tmp_path, *flags, word_bits=word_bits)
    if done.returncode:
        pytest.skip(f"no sanitizers here: {done.stderr.splitlines()[:1]}")
    rng = np.random.default_rng(5)
    programs = []
    for seed in range(3):
        data = encode(random_program(seed, ("f32",), 50, EVERY), word_bits=word_bits)
        programs += [data, data[:20], b""]
        for position in range(6, len(data) - 4):  # anything after the word size, some of it sealed again
            body = bytearray(data[:-4])
            body[position] = rng.integers(256)
            programs += [sealed(body), sealed(body[:position])]
    environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
    ran = subprocess.run([path], input=framed(programs), capture_output=True, env=environment)
    assert ran.returncode == 0, ran.stderr.decode()[:2000]
    verdicts = [int(line.split()[0]) for line in ran.stdout.splitlines()]
    assert len(verdicts) == len(programs)
    assert set(verdicts) >= {number(name) for name in ("OK", "SIZE", "TABLE", "TYPE", "OPCODE", "OPERAND", "UNSET")}


@pytest.mark.wide
@pytest.mark.parametrize("dispatch", [(), ("-DHL_NO_COMPUTED_GOTO",)])
@pytest.mark.parametrize("word_bits", WORDS)
def test_the_sources_compile_without_a_warning(tmp_path, word_bits, dispatch):
    strict = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Werror")
    _, done = compiled(tmp_path, *strict, *dispatch, word_bits=word_bits)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the names in an ELF object")
@pytest.mark.wide
def test_nothing_of_the_c_library_but_the_square_root_is_called(tmp_path):
    path = tmp_path / "vm.o"
    compiler = toolchain.compilers(toolchain.running_target())[0]
    command = [*compiler, "-c", *toolchain.FLAGS, "-Wall", "-Werror", "-fno-builtin", "-o", str(path)]
    includes = [f"-I{firmware_library.firmware_folder() / name}" for name in ("core", "generated")]
    text = ""
    for source in ("core/vm.c", "core/verify.c", "generated/elementary.c"):
        subprocess.run([*command, *includes, str(firmware_library.firmware_folder() / source)], check=True, capture_output=True)
        text += path.read_bytes().decode("latin1")
    library = {"sinf", "cosf", "expf", "exp2f", "logf", "atanf", "tanhf", "floorf", "fabsf", "malloc", "memcpy"}
    assert not {name for name in library if f"\0{name}\0" in text}  # the names a linker would look for
    assert "\0sqrtf\0" in text


def test_the_machine_says_what_it_refuses():
    machine = vm.Vm(reciprocal())
    machine.bytes = machine.bytes[:-1]
    with pytest.raises(ProgramError, match="reciprocal: the virtual machine rejects it: SIZE: the program is incomplete,"):
        machine.run(1, np.ones((1, 1)), np.empty((0, 1)))
