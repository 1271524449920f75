"""Faults put into the emulated Uno one by one, and how long each took to switch its motor off.

``python tests/firmware/faults.py`` prints the table; test_faults.py holds it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from build_image import symbols
from emulated import emulated_uno, image
from emulator import BROWN_OUT, EXTERNAL
from five_scenes import pendulum

import hapticlab as hl
from hapticlab import n, x
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import FAULTS as NAMES
from hapticlab.device.link.messages import SENSORS

T = 1e-3
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.004 * np.sin(9 * t))
TIMSK1 = 0x6F  # the ATmega328P's mask of timer 1's interrupts
w, y = hl.parameters("w y", units="N*m m")
K, x_o = hl.parameters("K x_o", units="N/m m")
ALWAYS = hl.Scene(force=K * (x(n) - x_o), name="spring")(K=50, x_o=0.03)  # pulls wherever the handle is
QUOTIENT = hl.Scene(force=w / y, name="quotient")(w=0.01, y=0.02)


@dataclass(frozen=True)
class Fault:
    """One thing that goes wrong: ``inject(paddle)`` does it, at once.

    ``within`` is the stated time from then until the motor is off [s]. ``says`` is what the board reports, None where a
    reset leaves nobody to.
    """

    says: str | None
    within: float
    inject: Callable
    scene: hl.Scene = ALWAYS
    period: float = T
    settings: dict = field(default_factory=dict)


def fall_silent(paddle):
    paddle.exchange.beating = False


def push(paddle, x=None, v=None):
    handle = paddle.loop.handle.handle
    handle.x, handle.v = handle.x if x is None else x, handle.v if v is None else v


def break_wire(paddle):
    """The sensor's pin falls to ground and stays there."""
    paddle.loop.board.adc(0)
    paddle.loop.sensor.show = lambda board, position: board.adc(0)


def freeze_sensor(paddle):
    """The pin stays where it is, as behind a magnet that fell off its shaft."""
    paddle.loop.sensor.show = lambda board, position: None


def damage_program(paddle):
    """A bit of the program's bytes in RAM flips."""
    memory = paddle.loop.board.memory
    memory[bytes(memory).find(b"HLVM") + 40] ^= 1


def smash_stack(paddle):
    """What guards the end of the variables is overwritten."""
    paddle.loop.board.memory[symbols(image().with_suffix(".elf"))["_end"] - 0x800000] ^= 0xFF


def stop_ticks(paddle):
    """The tick's interrupt is masked, as by a wild write; no request comes whose answer would let it in again."""
    fall_silent(paddle)
    paddle.exchange.refresh()
    paddle.loop.board.memory[TIMSK1] = 0


def reset(paddle, cause):
    paddle.loop.board.reset(cause)


def nothing(paddle):
    """The scene itself is the fault."""


#: a handle thrown beyond a short travel, with an encoder: it has no speed at which it turns over unseen
SHORT = {"travel_min": -0.006, "travel_max": 0.006, "speed_max": 100.0, "metres_per_count": 1e-4,
         "sensor": SENSORS["QUADRATURE"]}  # fmt: skip
#: at 0.9 N a motor that stands 0.8 N is too hot when 0.81 - (0.81 - h) exp(-t / 1 s) passes 0.64, in N^2; h is what was
#: left of the half that a board takes for granted after a reset, at most 0.32: between 1.06 and 1.57 s
HOT = {"force_continuous": 0.8, "heating_time": 1.0, "force_max": 0.9}
FAULTS = {
    "host silent": Fault("HOST_SILENT", 0.1 + 2 * T, fall_silent),
    "division by zero": Fault("NOT_FINITE", 3 * T, lambda paddle: paddle.set(y=0.0), QUOTIENT),
    "over-speed": Fault("OVER_SPEED", 3 * T, partial(push, v=4.0)),
    "over-travel": Fault("OVER_TRAVEL", 2 * T, partial(push, x=0.007), ALWAYS(K=5), settings=SHORT),
    "sensor's wire": Fault("SENSOR", 1.2 * T, break_wire),
    "sensor frozen": Fault("FROZEN", 1.2 + 3 * T, freeze_sensor),
    "heat": Fault("OVER_HEAT", 1.57, nothing, ALWAYS, settings=HOT),
    "steps too long": Fault("OVERRUN", 20e-3, nothing, pendulum()[0], period=0.5e-3),
    "program damaged in memory": Fault("BAD_PROGRAM", 0.1, damage_program),
    "stack overflow": Fault("MEMORY", 2 * T, smash_stack),
    "tick stops": Fault(None, 0.13, stop_ticks),
    "brown-out": Fault(None, 50e-6, partial(reset, cause=BROWN_OUT)),
    "reset": Fault(None, 50e-6, partial(reset, cause=EXTERNAL)),
}


NOMINAL = partial(nominal, "hapkit")


def measure(fault, emulated=emulated_uno, kept=NOMINAL, before=0.1, rest=0.2):
    """Put a fault into a board that runs; return the time until its motor was off [s], the Telemetry and the cause.

    It runs for ``before`` [s]. From the first duty of zero on the duty stays zero for ``rest`` [s], or the time is infinite.
    """
    settings = kept(**{"wired": 1, "checked": 1, "ident": 1, "date": 20261120, **fault.settings})
    with emulated(HAND, T=fault.period, settings=settings) as paddle:
        paddle.start(fault.scene, check_fit=False)
        if fault.inject is not nothing:
            paddle.wait(before)
            assert paddle.loop.board.duty != 0, paddle.stop().fault
        begun = paddle.loop.board.cycle
        fault.inject(paddle)
        last = paddle.exchange.now() + fault.within + rest
        while paddle.exchange.now() < last:
            paddle.exchange.wait(lambda: paddle.exchange.now() >= last, 0.01)
        off = off_from(paddle.loop.board, begun)
        return (off - begun) / paddle.loop.board.hz, paddle.stop() if fault.says else None


def assert_off_in_time(name, fault, taken, log, record_property):
    """The motor was off within the time that is stated for a fault, and the record says which fault it was."""
    record_property("motor_off_after_s", taken)
    print(f"{name}: motor off {1e3 * taken:.3f} ms after it, stated {1e3 * fault.within:.1f} ms")
    assert 0 <= taken <= fault.within
    if fault.says:
        _, cause, _ = NAMES[fault.says]
        assert fault.says in log.fault and cause in log.fault and "the motor is off" in log.fault


def off_from(board, begun):
    """Return the cycle from which on the motor was off; infinite if it is not."""
    cycles, duties = board.duties()
    cycles, duties = cycles[cycles >= begun], duties[cycles >= begun]
    if board.duty != 0 or not len(cycles):
        return np.inf
    driven = np.flatnonzero(duties)
    return int(cycles[driven[-1] + 1] if len(driven) else cycles[0])


def print_table(faults, measured):
    """Print what each fault took."""
    print(f"{'fault':<28}{'motor off after [ms]':>22}{'stated [ms]':>14}   said")
    for name, fault in faults.items():
        taken, log = measured(fault)
        print(f"{name:<28}{1e3 * taken:>22.3f}{1e3 * fault.within:>14.1f}   {log.fault if log else 'a reset'}")


if __name__ == "__main__":
    print_table(FAULTS, measure)
