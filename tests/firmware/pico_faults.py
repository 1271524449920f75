"""Faults put into the emulated Pico one by one: those of faults.py, and what only this board has.

``python tests/firmware/pico_faults.py`` prints the table; test_pico_faults.py holds it.
"""

from dataclasses import replace
from functools import cache, partial

import faults
from build_image import symbols
from faults import ALWAYS, FAULTS, HOT, SHORT, Fault, T, fall_silent
from five_scenes import double_pendulum
from pico_emulator import POWER, RUN_PIN
from pico_loop import emulated_pico, hapkit, image

NVIC_DISABLE = 0xE000E180  # Cortex-M0+: the mask of interrupts
FOREVER = bytes.fromhex("fee7")  # a branch to itself


@cache
def addresses():
    return symbols(image().with_suffix(".elf"))


def damage_program(paddle):
    """A bit of the program's bytes in RAM flips."""
    board, core = paddle.loop.board, addresses()["pico_core"]
    at = core + board.peek(core, 65536).index(b"HLVM") + 40
    board.poke(at, bytes([board.peek(at, 1)[0] ^ 1]))


def smash_stack(paddle):
    """The last word of the stack is overwritten."""
    paddle.loop.board.poke(addresses()["pico_stack_guard"], bytes(4))


def stop_ticks(paddle):
    """The tick's interrupt is masked, as by a wild write; no request comes whose answer would let it in again."""
    fall_silent(paddle)
    paddle.exchange.refresh()
    paddle.loop.board.store_word(NVIC_DISABLE, 1)


def hang(paddle):
    """The main loop stays where it is; the tick goes on."""
    paddle.loop.board.poke(addresses()["hl_core_poll"] & ~1, FOREVER)


def unplug(paddle):
    """The USB cable is pulled out; the board keeps its supply."""
    paddle.loop.board.attach(False)


def spoil(paddle, how):
    """From now on the AS5048A's answers are wrong: their parity, their error bit, or a line that is always high."""
    board, sensor = paddle.loop.board, paddle.loop.sensor
    board.angle(0, how)
    sensor.show = lambda board, x: None


def reset(paddle, cause):
    paddle.loop.board.reset(cause)


ANGLE = {"sensor": "AS5048A"}
PICO_FAULTS = {
    **FAULTS,
    "over-travel": replace(FAULTS["over-travel"], settings={**SHORT, "sensor": "QUADRATURE"}),
    # 1.5 N where 0.8 N is stood for: 2.25 - (2.25 - h) exp(-t / 1 s) passes 0.64, h from 0 to 0.32: 0.18 to 0.34 s
    "heat": replace(FAULTS["heat"], within=0.34, scene=ALWAYS(K=120), settings={**HOT, "force_max": 1.5}),
    "steps too long": replace(FAULTS["steps too long"], scene=double_pendulum()[0], period=0.4e-3),
    "program damaged in memory": replace(FAULTS["program damaged in memory"], inject=damage_program),
    "stack overflow": replace(FAULTS["stack overflow"], inject=smash_stack),
    "tick stops": replace(FAULTS["tick stops"], inject=stop_ticks),
    "main loop hangs": Fault(None, 0.13, hang),
    "brown-out": Fault(None, 50e-6, partial(reset, cause=POWER)),
    "reset": Fault(None, 50e-6, partial(reset, cause=RUN_PIN)),
    "USB unplugged": Fault(None, 0.1 + 2 * T, unplug),
    "AS5048A's parity": Fault("SENSOR", 2 * T, partial(spoil, how="parity"), settings=ANGLE),
    "AS5048A's error bit": Fault("SENSOR", 2 * T, partial(spoil, how="error"), settings=ANGLE),
    "AS5048A's line": Fault("SENSOR", 2 * T, partial(spoil, how="wire"), settings=ANGLE),
}
measure = partial(faults.measure, emulated=emulated_pico, kept=hapkit, before=0.03, rest=0.05)

if __name__ == "__main__":
    faults.print_table(PICO_FAULTS, measure)
