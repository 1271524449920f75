"""What a program costs, from the table; what is refused, and that what a refusal names really fits."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from five_scenes import SCENES, double_pendulum, pendulum
from random_programs import random_program

import hapticlab as hl
from hapticlab.compiler.boards.board_fit import PERIODS, fit, table
from hapticlab.compiler.boards.cost import BOARDS, SEARCH_MARGIN, Cost, cost, tables
from hapticlab.compiler.engines.bytecode import OPCODES, encode, layout
from hapticlab.compiler.ir.program import LEAVES, Block, Channel, Instruction, Program
from hapticlab.device.link.messages import LARGEST_PAYLOAD
from hapticlab.errors import ProgramError, ProgramLimitError

FIRMWARE = Path(__file__).resolve().parents[3] / "firmware"


def wall_program(T=1e-3):
    return hl.compile(hl.wall()(k=150, x_o=0.01), T=T)


def test_a_sum_done_by_hand():
    program = wall_program()
    names = [i.op for i in program.tick.instructions if i.op not in LEAVES]
    uno = tables()["uno"]
    of, around = uno["operations"], uno["overheads"]
    moves = layout(encode(program, word_bits=8)).size["tick_moves"]
    outside = around["tick"] + around["output f32"] + around["state f32"] * len(program.states) + around["move"] * moves
    said = cost(program)
    assert said.typical == outside + sum(of[name][0] for name in names)
    assert said.bound == int(np.ceil((outside + sum(of[name][1] for name in names)) * (1 + SEARCH_MARGIN)))
    assert said.share == pytest.approx((said.typical + said.step[0] + said.frame) / 16_000)
    assert said.instructions == len(program) == len(names)
    assert 0 < said.typical < said.bound


def test_the_longest_step_is_a_sum_done_by_hand():
    """The wall's SET has 11 + 3*5 bytes, its sample 11 + 3*4; a millisecond of the line has 50."""
    said, uno = cost(wall_program()), tables()["uno"]
    typical, *most = uno["step"]
    seen, bound = (cycles - 5 * uno["channel"] for cycles in most)  # of 8 channels it has 3
    usual = said.typical + seen + 26 * uno["received_byte"] + 23 * uno["sent_byte"]
    frame = uno["frame"][0] + 23 * (uno["frame"][1] + uno["sent_byte"])
    assert said.longest() == max(usual, np.ceil(1.1 * said.typical + typical + np.ceil(frame)))
    received = 26 + 6  # a heartbeat too, after an answer of 12
    # while the tick is held off, a request is not answered yet, and no other comes
    at_most = said.bound + bound + max(uno["late"], received * uno["received_byte"]) + 50 * uno["sent_byte"]
    assert said.longest(promise=True) == at_most
    turning = cost(wall_program(), edges_per_second=20_000)
    assert turning.longest(promise=True) == at_most + 20 * uno["edge"]
    assert f"{20_000 * uno['edge']} cycles per second for edges" in str(turning) and "none counted for edges" in str(said)
    with pytest.raises(ProgramError, match="edges_per_second = -1; needs"):
        cost(wall_program(), edges_per_second=-1)


def test_a_first_tick_that_takes_long_counts():
    said = cost(wall_program())
    more = replace(said, first=said.first + 10_000).longest(promise=True) - said.longest(promise=True)
    sent = tables()["uno"]["sent_byte"]
    assert more == said.first + 10_000 - (50 - 12) * sent  # no sample is on its way then, only an answer


def test_the_shortest_period_fits_and_a_microsecond_less_does_not():
    for promise in (False, True):
        said = cost(wall_program())
        T = said.T_needed(promise)
        assert replace(said, T=T).promised if promise else replace(said, T=T).fits
        assert not (replace(said, T=T - 1e-6).promised if promise else replace(said, T=T - 1e-6).fits)
        assert replace(said, T=T).longest(promise) <= 16e6 * T + 1


def test_samples_need_their_time_too():
    """One that can be answered and sent in three ticks, one that cannot."""
    traffic = cost(wall_program()).traffic
    enough = next(free for free in range(20_000) if traffic.leaves_room(free, 1e-3))
    assert enough == max(
        np.ceil(traffic.telemetry + traffic.request / 10 + traffic.heat / 16),
        np.ceil((traffic.request + traffic.frame + traffic.heat) / 3 + 23 * traffic.sent_byte),
    )
    seldom = replace(traffic, every=10)
    assert next(free for free in range(20_000) if seldom.leaves_room(free, 1e-3)) < enough


@pytest.mark.parametrize("seed", range(5))
def test_memory_is_the_bytes_as_sent_and_four_a_register(seed):
    program = random_program(seed, ("f32",), 40, tuple(OPCODES))
    data = encode(program, word_bits=8)
    said = cost(program)
    first_register = (len(data) + 3) // 4  # firmware/core/place.c
    assert said.arena == 4 * (first_register + layout(data).size["registers"])
    assert said.bytes == len(data)


def differences(constants, board):
    """What a board's record says otherwise than its firmware's constants, and what no firmware can have."""
    constant = dict(re.findall(r"#define HL_(\w+) \"?([\w+-]+)", constants))
    own = {"BOARD_NAME": board.name, "ARENA_BYTES": board.arena, "CHANNELS": board.channels}
    own |= {"PERIOD_MAX_US": round(board.T_max * 1e6)}
    own |= {"WORD_BITS": board.word_bits} if "WORD_BITS" in constant else {}  # the host's is of its build
    return [name for name, value in own.items() if constant[name] != str(value)] + ["payload"] * (not has_room(board))


def has_room(board):
    """Whether a frame carries a sample of so many numbers: tick, flags and 4 bytes a number; core.h refuses what is larger."""
    return 5 + 4 * board.channels <= LARGEST_PAYLOAD


@pytest.mark.parametrize("constants", sorted(FIRMWARE.glob("boards/*/board_constants.h")), ids=lambda path: path.parent.name)
def test_a_record_is_as_the_firmware_of_its_board(constants):
    text, board = constants.read_text(), BOARDS[constants.parent.name]
    assert differences(text, board) == []
    for name, wrong in (("arena", 1 << 20), ("channels", 7), ("T_max", 0.02), ("name", "nano"), ("word_bits", 4)):
        noticed = name != "word_bits" or "#define HL_WORD_BITS" in text
        assert bool(differences(text, replace(board, **{name: wrong}))) == noticed, name


def test_no_board_promises_more_channels_than_a_frame_carries():
    assert [name for name, board in BOARDS.items() if not has_room(board)] == []
    assert not has_room(replace(BOARDS["uno"], channels=11))


def test_what_can_be_flashed_has_firmware():
    assert all((FIRMWARE / "boards" / name).is_dir() for name, board in BOARDS.items() if board.flashing)


def test_every_operation_has_its_figures_on_every_board():
    for name, board in BOARDS.items():
        if board.hz:
            of = tables()[name]["operations"]
            assert set(of) == set(OPCODES)
            assert all(0 < typical <= worst for typical, worst, *_ in of.values())
            assert all(0.99 * of[op][0] < of[op][2] <= of[op][1] for op in ("sin", "cos"))  # far angles: about as much, or more
            assert ("modelled, not measured" in tables()[name]["source"]) == (board.flashing is None)


def test_telemetry_costs_less_when_fewer_ticks_are_sent():
    program = wall_program()
    each, tenth = cost(program), cost(program, every=10)
    assert each.typical == tenth.typical
    assert tenth.frame == pytest.approx(each.frame / 10, abs=1)
    with pytest.raises(ProgramError, match="every = 0; needs a whole number"):
        cost(program, every=0)


def test_this_computer_has_time_and_16_bit_words():
    said = cost(hl.compile(double_pendulum()[0], T=1e-3), "host")
    assert said.fits and said.promised and said.share == 0
    assert said.bytes == len(encode(said.program, word_bits=16))
    assert "cycles" not in str(said)


def test_an_unknown_board_is_named_with_those_there_are():
    with pytest.raises(ProgramError, match=f"board = 'due'; needs one of {re.escape(', '.join(BOARDS))}"):
        cost(wall_program(), "due")


def test_a_cost_prints_its_figures_and_its_answer():
    text = str(cost(wall_program(2e-3)))
    said = cost(wall_program(2e-3))
    for number in (said.typical, said.bound, *said.step, said.frame, said.arena, "registers"):
        assert str(number) in text
    assert "fits, guaranteed for any operands" in text
    assert "modelled, not measured" in str(cost(wall_program(), "cortex-m4f"))


def test_between_the_two_figures_it_fits_but_is_not_promised():
    said = cost(wall_program(), every=10)  # with a sample in every tick these take longer than the longest step
    needs, promise = said.T_needed(), said.T_needed(promise=True)
    tight = replace(said, bound=16_000)
    assert promise > needs and said.promised == (said.T >= promise)
    assert tight.fits and not tight.promised and "could be late" in tight.verdict
    assert not replace(said, typical=16_000).fits


# ---------------------------------------------------------------- refusals


def offers(message):
    """Return the options that a refusal names, as keyword arguments."""
    given = []
    for words in message.split("; fits ")[1].split(", or "):
        numbers = re.findall(r"(substeps|every)=(\d+)", words) + re.findall(r"(T) = ([\d.e-]+) s", words)
        made = {name: float(n) if name == "T" else int(n) for name, n in numbers}
        given.append({**dict(re.findall(r"(\w+)='(\w*)'", words)), **made})
    return given


@pytest.mark.wide
def test_a_double_pendulum_is_refused_with_its_share_and_every_offer_fits():
    scene, options = double_pendulum()
    with pytest.raises(ProgramLimitError) as refusal:
        fit(scene, T=1e-3, **options)
    message = str(refusal.value)
    assert re.search(r"double pendulum with rk4: 4(\.\d)? ms of a 1 ms period on uno \(4\d\d%, typical\)", message)
    assert re.search(r"and it needs 12\d\d bytes of memory; uno has \d+; fits", message)
    named = offers(message)
    assert {"semi_implicit_euler"} <= {o.get("method") for o in named}
    for offer in named:
        assert fit(scene, **{"T": 1e-3, **options, **offer}).fits, offer


@pytest.mark.parametrize("promise", [False, True])
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
@pytest.mark.always("wall-*", "mass_and_wall-True")
def test_what_a_refusal_names_fits_and_nothing_else_is_refused(make, promise):
    scene, options = make()
    for T in (1e-3, 2e-3):
        said = cost(hl.compile(scene, T=T, **options))
        if said.promised if promise else said.fits:
            assert fit(scene, T=T, promise=promise, **options) == said
            continue
        with pytest.raises(ProgramLimitError) as refusal:
            fit(scene, T=T, promise=promise, **options)
        named = offers(str(refusal.value))
        assert named
        for offer in named:
            law = offer.pop("law", None)
            other = hl.wall(law)(**scene.values) if law else scene
            found = fit(other, promise=promise, **{"T": T, **options, **offer})
            assert found.promised if promise else found.fits


def test_a_program_is_offered_a_rate_the_first_that_is_long_enough():
    scene, options = pendulum()
    program = hl.compile(scene, T=1e-3, **options)
    with pytest.raises(ProgramLimitError) as refusal:
        fit(program)
    (offer,) = offers(str(refusal.value))  # without telemetry it would not fit either
    assert fit(hl.compile(scene, **options, **offer)).fits
    shorter = max(T for T in PERIODS if T < offer["T"])
    with pytest.raises(ProgramLimitError):
        fit(hl.compile(scene, T=shorter, **options))


@pytest.mark.wide
def test_a_law_of_the_book_is_offered_where_it_needs_fewer_samples():
    ellis, zoh = (hl.wall(law)(k=150, x_o=0.01) for law in ("ellis", "zoh"))
    T = next(T * 1e-6 for T in range(1, 2000) if cost(hl.compile(zoh, T=T * 1e-6), every=20).fits)
    with pytest.raises(ProgramLimitError, match="fits .*with law='zoh'"):
        fit(ellis, T=T, every=20)


def test_less_telemetry_is_offered_where_that_is_enough():
    k, x = hl.parameters("k", units="N/m"), hl.x(hl.n)
    shown = {f"F{j}": k * x * j for j in range(1, 6)}
    program = hl.compile(hl.Scene(k * x, watch=shown, name="shown")(k=20), T=1e-3, live=())
    said = cost(program)
    T = next(T * 1e-6 for T in range(300, 2000) if cost(replace(program, T=T * 1e-6), every=2).fits)
    assert T < said.T_needed() - 50e-6
    with pytest.raises(ProgramLimitError, match=r"fits with every=2 \(one sample of telemetry per 2 ticks\),"):
        fit(replace(program, T=T))
    assert fit(replace(program, T=T), every=2).fits


def test_substeps_are_offered_back_before_anything_slower():
    scene, options = pendulum()
    with pytest.raises(ProgramLimitError, match="fits with substeps=1"):
        fit(scene, T=2e-3, substeps=3, **options)


def test_too_many_channels_are_refused_by_their_number():
    x = Instruction("input", (), "f32")
    names = tuple(Channel(f"y{k}") for k in range(8))
    program = Program("many", (Channel("x"),), (), (), names, Block(), Block((x,), (0,) * 8), 1e-3)
    with pytest.raises(ProgramLimitError, match="room for 5 watched channels; watch 2 fewer"):
        fit(program)


def test_where_nothing_fits_the_refusal_says_so():
    A, x_o = hl.parameters("A x_o", units="N m")
    force = A * sum(sp.sin(k * hl.x(hl.n) / x_o) for k in range(1, 150))
    many = hl.Scene(force=force, name="150 sines")(A=0.01, x_o=0.01)
    with pytest.raises(ProgramLimitError, match=r"150 sines: .* needs \d+ bytes of memory.*simplify the scene"):
        fit(many, T=1e-3)


def test_the_table_has_a_line_a_scene_and_a_column_a_rate():
    text = table([make() for make in SCENES], periods=(1e-3, 2e-3, 4e-3))
    lines = text.splitlines()
    assert len(lines) == 1 + len(SCENES) + 1 and lines[-1] == "measured in emulation"
    assert re.findall(r"\d+ Hz", lines[0]) == ["1000 Hz", "500 Hz", "250 Hz"]
    wall, double = lines[1], lines[-2]
    assert wall.count("promised") >= 2 and "promised" not in double
    assert table([SCENES[0]()], "cortex-m4f").splitlines()[-1].startswith("modelled, not measured")
    assert isinstance(cost(hl.compile(pendulum()[0], T=1e-3)), Cost)
