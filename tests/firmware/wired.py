"""Paddles by their wiring on the emulated Uno: settings, a scene that pulls both ways, and what the pins gave for each force."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x
from hapticlab.compiler.boards.board_pins import UNO_PINS
from hapticlab.device.board.settings import changed, nominal
from hapticlab.device.link.messages import MOTOR_LAWS
from hapticlab.device.wiring import Wiring

HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.008 * np.sin(11 * t) + 0.002 * np.sin(31 * t))
CALIBRATED = {"wired": 1, "checked": 1, "ident": 7, "date": 20261120}
#: counts until an angle sensor repeats, and handle travel of a count [m]: a full turn of an AS5048A is two of a KMA210
STEPS = {"MAGNETORESISTIVE": (920, 12.8e-6), "AS5048A": (16384, 2 * 920 * 12.8e-6 / 16384), "QUADRATURE": (1024, 2e-5)}


def of(*wiring):
    """Return the settings of a calibrated paddle with a wiring: a linear motor of 8 N with a dead band."""
    wiring = Wiring(*wiring)
    wrap, step = STEPS[wiring.sensor]
    values = {"wrap": wrap, "metres_per_count": step, "duty_dead": 0.08, "motor_law": MOTOR_LAWS["LINEAR"], "speed_max": 0.6}
    return changed(nominal("hapkit"), **{**wiring.settings(), **values, **CALIBRATED})


#: the paddles that people have, and drives, motors and pins that none of them has
PADDLES = {name: nominal(name, **CALIBRATED) for name in ("hapkit", "hapkit_as5048a", "longhorn", "motor_shield")} | {
    "l298": of("QUADRATURE", "TWO_INPUTS_ENABLE", (7, 8, 6), (2, 3), 7_812),
    "two inputs": of("QUADRATURE", "TWO_INPUTS", (5, 6), (2, 3), 62_500),
    "two inputs, timer 2": of("MAGNETORESISTIVE", "TWO_INPUTS", (11, 3), (19,), 31_372),
    "shield, M3": of("MAGNETORESISTIVE", "SHIFT_REGISTER", (6, 12, 4, 8), (14,), 976),
    "analog pins as inputs": of("AS5048A", "TWO_INPUTS_ENABLE", (17, 18, 3), (9,), 3_921),
}
K = hl.parameters("K", units="N/m")
SPRING = hl.Scene(force=K * x(n), name="spring")(K=60)


def expected_duty(F, settings):
    """Return the signed duty in 256ths for a force on the environment, the motor's opposite, by the law in floats."""
    part = np.minimum(np.abs(F) / settings.force_full, 1)
    part = np.sqrt(part) if settings.motor_law == MOTOR_LAWS["SQRT"] else part
    duty = np.where(part > 0, settings.duty_dead + (1 - settings.duty_dead) * part, 0)
    return -256 * np.sign(F) * duty


def duties_of_ticks(board, count):
    """Return the duties that the first ``count`` ticks of a run gave the pins; its first force is not 0."""
    duties = board.update_duties()
    first = np.flatnonzero(duties)[0]
    return duties[first : first + count]


def high_pins(board):
    """Return the pins that are high, but for the link's and the LED's."""
    return [pin for pin in UNO_PINS.names if pin not in (0, 1, 13) and board.high(pin) > 0]
