"""The steps of a first power-up: what to do, what to expect, and what to look at if it does not come so.

Sensors come first, then every way to stop, and only then the motor's lag and force: nobody should need a stop that was not tried.
"""

from dataclasses import dataclass

from ..link.messages import HOST_SILENCE_MS, UNCHECKED_FORCE_N

#: what the motor gives in every step but the last [N]: below what a board allows whose sign nobody has checked
PULL = 0.8 * UNCHECKED_FORCE_N
#: of the limits that are lowered while they are tried: speed [m/s], part of the travel
TRIED_SPEED, TRIED_TRAVEL = 0.25, 0.6


@dataclass(frozen=True)
class Step:
    """Name, what to do, what to expect, what to look at otherwise."""

    name: str
    do: str
    expect: str
    otherwise: str

    def __str__(self):
        return f"\n== {self.name}\ndo         {self.do}\nexpect     {self.expect}\nif not     {self.otherwise}"


STEPS = {
    step.name: step
    for step in (
        Step(
            "supply off",
            "Switch off the supply of the motor. Connect the board by USB only. Move the handle from stop to stop by hand.",
            "The handle moves freely, and both stops hold it.",
            "Fix the mechanics first. An obstacle or a loose stop makes every later number wrong.",
        ),
        Step(
            "calibration",
            "If the board is new, say what is built and measure the stops, with the supply off.",
            "The wires on the screen are the wires on the table, and two sweeps from stop to stop agree.",
            "Correct the wire that is named. No step that moves the motor is done before.",
        ),
        Step(
            "link",
            "Leave the paddle alone for a few seconds.",
            "The board answers within a few milliseconds, and its steps fit into the period.",
            "Run `hapticlab doctor`. It says what the cable, the adapter or the image needs.",
        ),
        Step(
            "sensor at rest",
            "Release the handle and leave it alone for a second.",
            "The reading stays within a few counts.",
            "Check the sensor's ground, and keep its wires away from those of the motor.",
        ),
        Step(
            "sensor moved",
            "Move the handle slowly from stop to stop and back, twice. The motor is off.",
            "The reading follows without a jump, over the calibrated travel, and the board finds its position.",
            "Check that the magnet is fixed, centred and close enough. Then calibrate the stops.",
        ),
        Step(
            "switch",
            f"Put a hand on the switch of the motor's supply, hold the handle, and switch on. The motor pulls with {PULL:g} N. "
            "Then switch the supply off.",
            "You feel a light pull, and it ends when you switch off.",
            "Unplug the supply. Do not continue before the switch works, because it is the only emergency stop.",
        ),
        Step(
            "host silent",
            "Hold the handle lightly against the pull. The computer stops talking to the board.",
            f"The pull ends after {HOST_SILENCE_MS} ms.",
            "Switch off. Flash the firmware that came with hapticlab.",
        ),
        Step(
            "STOP",
            "Hold the handle lightly against the pull. The computer sends STOP.",
            "The pull ends at once.",
            "Switch off, and run `hapticlab doctor`.",
        ),
        Step(
            "Ctrl-C",
            "Hold the handle lightly against the pull, and press Ctrl-C.",
            "The pull ends at once, and this walk goes on.",
            "Switch off, and report this with the name of your system.",
        ),
        Step(
            "not finite",
            "Hold the handle lightly against the pull. The scene divides by zero.",
            "The pull ends within three samples.",
            "Switch off, and report this with the report of this walk.",
        ),
        Step(
            "over-speed",
            f"The speed limit is lowered to {TRIED_SPEED:g} m/s for this step. Hold the handle against the pull, then move it "
            "quickly, as in a flick.",
            "The pull ends during the flick.",
            "Move the handle faster. If the pull remains, switch off and calibrate the stops, because the position is wrong.",
        ),
        Step(
            "over-travel",
            f"The travel is lowered to {TRIED_TRAVEL:.0%} for this step. Move the handle slowly towards a stop.",
            "The pull ends before the stop.",
            "Switch off and calibrate the stops, because the position is wrong.",
        ),
        Step(
            "cable",
            "Hold the handle lightly against the pull, and pull the USB cable out of the computer. Then plug it in again.",
            f"The pull ends within {HOST_SILENCE_MS} ms.",
            "Switch off. If the board has no power without its cable, the resistor from the PWM pin to ground is missing.",
        ),
        Step(
            "sign",
            "If the sign was never checked, hold the handle lightly and move it to one side and to the other for 6 seconds.",
            "The motor pulls in the direction that it is told, on both sides. More than 0.5 N is allowed only after that.",
            "Swap the sign as offered. If it pushes one way only, look at the wire of the direction pin.",
        ),
        Step(
            "lag",
            "Hold the handle between two fingers, loosely, near the middle. The motor tugs 40 times in two and a half seconds.",
            "The handle follows each tug after the time of the board's step and of the sensor.",
            "A longer lag lowers the stiffness of the stiffest wall. The sensor's filter or a slow driver causes it.",
        ),
        Step(
            "force",
            "If you have a kitchen scale, rest the handle on it. The motor presses with several forces.",
            "The scale shows each force, within a tenth.",
            "Run `hapticlab calibrate --only force`.",
        ),
    )
}  # fmt: skip


def table():
    """Return the steps as rows of Markdown: the owner's guide has them."""
    rows = [f"| {n} | {s.name} | {s.do} | {s.expect} | {s.otherwise} |" for n, s in enumerate(STEPS.values(), 1)]
    return "\n".join(["| | step | do | expect | if not |", "| --- | --- | --- | --- | --- |", *rows]) + "\n"
