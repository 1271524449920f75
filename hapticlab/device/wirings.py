"""Paddles as people build them: the wiring of each, its parts, and where this is published."""

from ..errors import PaddleError
from .build import Build
from .wiring import DRIVE_WORDS, SENSOR_WORDS, Wiring

#: the Arduino side of the published Hapkit sketches, and of those of the Longhorn Hapkit
_SKETCHES = "published Hapkit sketches (hapkit.stanford.edu): PWM on D5, direction on D8, sensor on A2"
_LONGHORN = "sketches of the Longhorn Hapkit (A. Majewicz Fey, UT Austin, 2021): encoder on D2 and D3, bridge inputs D4 and D5"
_SHIELD = "Adafruit AFMotor library and motor shield version 1: 74HC595 with latch D12, clock D4, data D8, output enable D7"
_ENCODER_LEVELS = "A Pico takes at most 3.3 V on its pins: use an encoder that works with 3.3 V, or a level shifter."
#: what a person who wires a sensor pin by pin must know of its voltage
_LEVELS = {
    ("pico", "QUADRATURE"): (_ENCODER_LEVELS,),
    ("pico", "MAGNETORESISTIVE"): (
        "A Pico takes at most 3.3 V on its pins. A KMA210 needs 5 V from VBUS in place of 3V3. Connect its OUT over 10 kOhm to "
        "the pin, and the pin over 20 kOhm to GND.",
    ),
}
_L298 = "Pull the module's jumper from ENA. Leave its own 5V terminal empty; its jumper 5V-EN stays in, for 7 to 12 V."
_MEASURE = (
    "Measure from D5 to GND without any supply. If it is more than 11 kOhm, add 10 kOhm, so that the motor is off while the "
    "board starts."
)
_LOW_CARRIER = "The carrier is audible, because the driver is too slow for a higher one."

BUILDS = {
    one.name: one
    for one in (
        Build(
            name="hapkit",
            title="Hapkit 3.0 with its own board",
            board="uno",
            wiring=Wiring("MAGNETORESISTIVE", "PWM_DIRECTION", (5, 8), (16,)),
            driver="on the Hapkit board",
            sensor="KMA210 on the Hapkit board",
            source=_SKETCHES,
            notes=("Only the two wires of the motor and the plug of the supply are connected by hand.", _MEASURE),
            plugged=("driver", "sensor"),
        ),
        Build(
            name="hapkit_as5048a",
            title="Hapkit with an AS5048A angle sensor, as in ME327",
            board="uno",
            wiring=Wiring("AS5048A", "PWM_DIRECTION", (5, 8), (10,)),
            driver="on the Hapkit board",
            sensor="AS5048A module",
            source="ME327 (Stanford): chip select on D10, SPI; driver as in the " + _SKETCHES,
            notes=("CLK, MISO and MOSI of the sensor go to the SPI pins of the board, which no other wire may use.", _MEASURE),
            plugged=("driver",),
            marked={"SCK": "CLK"},
        ),
        Build(
            name="longhorn_d11",
            title="Longhorn Hapkit with the enable on D11",
            board="uno",
            wiring=Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (4, 5, 11), (2, 3), 31_372),
            driver="H-bridge with an enable",
            sensor="encoder on the motor",
            source=f"{_LONGHORN}, enable D11",
        ),
        Build(
            name="longhorn_d6",
            title="Longhorn Hapkit with the enable on D6",
            board="uno",
            wiring=Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (4, 5, 6), (2, 3), 31_372),
            driver="H-bridge with an enable",
            sensor="encoder on the motor",
            source=f"{_LONGHORN}, enable D6",
        ),
        Build(
            name="motor_shield",
            title="Uno with a motor shield, Adafruit version 1 or a copy",
            board="uno",
            wiring=Wiring("QUADRATURE", "SHIFT_REGISTER", (11, 12, 4, 8), (2, 3), 7_812),
            driver="L293D on the motor shield",
            sensor="encoder on the motor",
            source=f"{_SHIELD}; encoder illustrative",
            notes=(
                "The motor is connected to M1. Leave M2 empty, because D3 is also its PWM pin.",
                "Pull the shield's jumper PWR: the motor has a supply of its own. The shield uses D7, too.",
                _LOW_CARRIER,
            ),
            plugged=("driver",),
            marked={"OUT1": "M1", "OUT2": "M1", "V+": "EXT_PWR +", "GND": "GND"},
        ),
        Build(
            name="l298",
            title="Uno or Nano with an L298 module",
            board="uno",
            wiring=Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (7, 8, 6), (2, 3), 7_812),
            driver="L298 module, half A",
            sensor="encoder on the motor",
            source="ST L298 data sheet: 25 kHz typical, 40 kHz at most; driver's pins as in a published Nano sketch of a Hapkit; "
            "encoder illustrative",
            notes=(_L298, _LOW_CARRIER, "A Nano's pins have the same names, in other positions."),
            marked={"EN": "ENA", "V+": "12V"},
        ),
        Build(
            name="pico_encoder",
            title="Pico with an encoder and a driver with two inputs",
            board="pico",
            wiring=Wiring("QUADRATURE", "TWO_INPUTS", (14, 15), (2, 3), 20_000),
            driver="DRV8871 or similar",
            sensor="encoder on the motor",
            source="illustrative",
            notes=(_ENCODER_LEVELS,),
        ),
        Build(
            name="pico_l298",
            title="Pico with an encoder and an L298 module",
            board="pico",
            wiring=Wiring("QUADRATURE", "TWO_INPUTS_ENABLE", (14, 15, 13), (2, 3), 20_000),
            driver="L298 module, half A",
            sensor="encoder on the motor",
            source="ST L298 data sheet: 25 kHz typical, 40 kHz at most, inputs high from 2.3 V; pins illustrative",
            notes=(_L298, _ENCODER_LEVELS),
            marked={"EN": "ENA", "V+": "12V"},
        ),
        Build(
            name="pico_as5048a",
            title="Pico with an AS5048A and a driver with PWM and direction",
            board="pico",
            wiring=Wiring("AS5048A", "PWM_DIRECTION", (14, 15), (17,), 20_000),
            driver="any with PWM and DIR for 3.3 V",
            sensor="AS5048A module for 3.3 V",
            source="AS5048A data sheet (3.3 V operation); pins illustrative",
            marked={"SCK": "CLK"},
        ),
    )
}


def build(name: str) -> Build:
    """Return a paddle as it is built, by its name; its wiring is ``build(name).wiring``.

    Parameters
    ----------
    name : {"hapkit", "hapkit_as5048a", "longhorn_d11", "longhorn_d6", "motor_shield", "l298", "pico_encoder", ...}

    Raises
    ------
    PaddleError
        If there is none of that name.

    Examples
    --------
    >>> from hapticlab.device.wirings import build
    >>> print(build("longhorn_d6").wiring)
    sensor QUADRATURE (A 2, B 3), drive TWO_INPUTS_ENABLE (IN1 4, IN2 5, EN 6), PWM of 31372 Hz
    """
    if name not in BUILDS:
        raise PaddleError(f"no wiring {name!r}; there are {', '.join(BUILDS)}.")
    return BUILDS[name]


def built_as(board: str, wiring: Wiring) -> Build:
    """Return the known paddle that has this wiring on this board, or one without a name where there is none."""
    for one in BUILDS.values():
        if (one.board, one.wiring) == (board, wiring):
            return one
    words = DRIVE_WORDS[wiring.drive], SENSOR_WORDS[wiring.sensor]
    return Build(name="own", title="a wiring of your own", board=board, wiring=wiring, driver=words[0], sensor=words[1],
                 source="chosen pin by pin", notes=_LEVELS.get((board, wiring.sensor), ()))  # fmt: skip
