"""What each board can do with its pins: a wiring that asks for more is rejected before it is sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, eq=False)
class Pins:
    """The pins of a board, by the numbers that its firmware gives them.

    Attributes
    ----------
    names : dict of int to str
        What is printed beside each pin that a wiring may use.
    busy : dict of int to str
        Pins that no driver and no sensor may be on by themselves, with their use.
    pwm : dict of int to str
        Pins that can carry PWM, with the timer that makes it.
    carriers : tuple of int
        Frequencies of the PWM to choose from [Hz]; the first is the greatest, the last the least that the board takes. It takes
        those between them, too, and rounds them down to what its timers can do.
    analog : tuple of int
    quadrature : tuple of (int, int)
        Pairs of pins that can count the lines A and B of an encoder.
    spi : dict of str to int
        Pins of the bus that an SPI sensor uses in addition to its chip select.
    shield : dict of int to str
        PWM pins of an Adafruit-type motor shield, with the motor that each switches; empty where no shield fits.
    register : dict of str to int
        Pins to which the shield's shift register is soldered, by what they do.
    supply : str
        The pin that supplies a sensor.
    """

    names: Mapping[int, str]
    busy: Mapping[int, str]
    pwm: Mapping[int, str]
    carriers: tuple[int, ...]
    analog: tuple[int, ...]
    quadrature: tuple[tuple[int, int], ...]
    spi: Mapping[str, int]
    shield: Mapping[int, str] = field(default_factory=dict)
    register: Mapping[str, int] = field(default_factory=dict)
    supply: str = "5V"

    def name(self, pin: int) -> str:
        """Return what is printed beside a pin, or its number where the board has no such pin."""
        return self.names.get(pin, f"pin {pin}")


_LINK = "the serial link to the computer"
#: ATmega328P data sheet (Microchip DS40002061B): timer 1 is the firmware's clock, so D9 and D10 have no PWM. INT0 and INT1 are
#: D2 and D3. Timers 0 and 2 count to 256 or, phase-correct, up and down to 255 (510 clocks), and divide 16 MHz by 1, 8 or 64
UNO_PINS = Pins(
    names={**{k: f"D{k}" for k in range(14)}, **{14 + k: f"A{k}" for k in range(6)}},
    busy={0: _LINK, 1: _LINK, 13: "the light that its bootloader blinks"},
    pwm={5: "timer 0", 6: "timer 0", 3: "timer 2", 11: "timer 2"},
    carriers=(62_500, 31_372, 7_812, 3_921, 976, 490),
    analog=(14, 15, 16, 17, 18, 19),
    quadrature=((2, 3),),
    spi={"MOSI": 11, "MISO": 12, "SCK": 13},
    shield={11: "M1", 3: "M2", 6: "M3", 5: "M4"},
    register={"LATCH": 12, "CLK": 4, "DATA": 8, "the shield's enable": 7},
)
_GP = (*range(23), 26, 27, 28)
#: RP2040 data sheet: any GP pin counts, and has PWM of a slice; GP26 to GP28 are analog. GP23 to GP25 are not on the header of
#: a Pico (its data sheet, section 2.1). The SPI pins are those that it marks as default; PIO reads lines on pins in a row
PICO_PINS = Pins(
    names={k: f"GP{k}" for k in _GP},
    busy={},
    pwm={k: f"slice {k // 2 % 8}" for k in _GP},
    carriers=(100_000, 62_500, 31_250, 20_000, 2_000),
    analog=(26, 27, 28),
    quadrature=tuple((k, k + 1) for k in _GP if k + 1 in _GP),
    spi={"MOSI": 19, "MISO": 16, "SCK": 18},
    supply="3V3",
)
PINS = {"uno": UNO_PINS, "pico": PICO_PINS}
