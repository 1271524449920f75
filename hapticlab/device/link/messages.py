"""What a board and this package say to each other: messages, results, faults, settings. Python owns these tables.

A frame is COBS (Cheshire and Baker, 1999) ended by a zero byte, around ::

    version and message   1 byte: PROTOCOL in the high 3 bits, the message's number in the low 5
    sequence              1 byte: a request's own, its reply repeats it. Guarded requests count by themselves, from 1 in
                          every session, and so do samples and fault reports
    payload               see MESSAGES
    guard                 4 bytes, on guarded requests only: CRC-32 of all before it, begun from the session's number plus
                          how often the sequence has turned over
    CRC-16                2 bytes: CCITT, initial value 0xffff, of all before it

Numbers are little endian. Guarded are the requests that can move the motor: a frame left over from another session or from
long ago, or damaged where CRC-16 does not see it, moves nothing. STOP is guarded so that no START sent before it is
obeyed after it; it stops the motor whatever its guard says. COMMIT names the CRC-32 that the upload ends with. HELLO with a
new number begins a session: nothing runs, nothing is loaded.

Only a session's own frames keep its scene driven: guarded requests with the right guard, HELLO, and STATUS, which names the
session. PING, READ, BEGIN and DATA are answered whoever sends them, and keep nothing alive.

A change of what a message means needs another name of a field at least, so that the table hash changes with it.
"""

import struct
import zlib
from dataclasses import dataclass
from functools import cached_property

from ...compiler.engines.bytecode import RESULTS as MACHINE_RESULTS
from ...compiler.engines.bytecode import table_hash as machine_hash

PROTOCOL = 1
#: major and minor: a release with other tables than the last has another one, so that a person can tell the two apart
FIRMWARE = (2, 0)
#: of COBS and CRC together, more than any message needs
LARGEST_PAYLOAD = 48


@dataclass(frozen=True)
class Message:
    """One row of MESSAGES: number, fields, whether CRC-32 guards it, whether more bytes may follow the fields."""

    number: int
    fields: tuple = ()
    guarded: bool = False
    open: bool = False

    @cached_property
    def struct(self):
        return struct.Struct("<" + "".join(type for type, _ in self.fields))

    @cached_property
    def names(self):
        return tuple(name for _, name in self.fields)

    def unpack(self, payload):
        """Return the fields by name; bytes after them are under "rest"."""
        known = self.struct
        if len(payload) < known.size or (len(payload) > known.size and not self.open):
            raise ValueError(f"{len(payload)} bytes for fields of {known.size}")
        values = dict(zip(self.names, known.unpack_from(payload), strict=True))
        return values | ({"rest": payload[known.size :]} if self.open else {})


def fields(text):
    """Return ((struct type, name), ...) of a text such as "I session, B state"."""
    return tuple(tuple(pair.split()) for pair in text.split(",")) if text else ()


#: add at the end, never renumber: 1 to 15 ask a board, 16 to 31 are what it says
MESSAGES = {
    "HELLO": Message(1, fields("I session")),
    "PING": Message(2, fields("I token")),
    "STATUS": Message(3, fields("I session")),
    "READ": Message(4, fields("H offset, B count")),
    "BEGIN": Message(5, fields("B target, H size")),
    "DATA": Message(6, fields("H offset"), open=True),
    "COMMIT": Message(7, fields("B target, H size, I last_crc"), guarded=True),
    "START": Message(8, fields("I crc, H every, B options, f force_max"), guarded=True),
    "STOP": Message(9, guarded=True),
    "SET": Message(10, fields("B count"), guarded=True, open=True),
    "HOME": Message(11, fields("f position"), guarded=True),
    "CLEAR": Message(12, guarded=True),
    "ARM": Message(13, fields("B armed"), guarded=True),
    "ACK": Message(16, fields("B request, B result, i tick")),
    "WELCOME": Message(
        17,
        fields(
            "I table, 8s board, H ident, B major, B minor, B word_bytes, H arena, B slots, B channels, I clock_hz, "
            "H duty_full, H period_min, H period_max, B reset_cause"
        ),
    ),
    "PONG": Message(18, fields("I token")),
    "STATE": Message(
        19,
        fields(
            "I session, B state, B fault, B flags, I tick, i counts, f x, f force, f heat, H period_min, H period_max, "
            "H step_last, H step_worst, H step_mean, H overruns, H lost, H damaged"
        ),
    ),
    "BYTES": Message(20, fields("H offset"), open=True),
    "SAMPLE": Message(21, fields("I tick, B flags"), open=True),
    "FAULTED": Message(22, fields("B fault, I tick, f value")),
}

#: results of requests: the machine's, and from 32 on those of the loop
RESULTS = {
    **MACHINE_RESULTS,
    "BUSY": (32, "not while a scene runs: paddle.stop() first"),
    "NO_PROGRAM": (33, "the board holds no verified program of that CRC: send the scene again"),
    "NOT_HOMED": (34, "the position is unknown since the last reset: paddle.home()"),
    "LENGTH": (35, "a message of the wrong length: flash the firmware of this hapticlab"),
    "GUARD": (36, "a damaged message, or one of a different session: connect again"),
    "STALE": (37, "a message older than one that was already executed: connect again"),
    "RANGE": (38, "a value outside what the board allows"),
    "TOO_LARGE": (39, "more bytes than the board holds: use a smaller scene, fewer substeps, or another method"),
    "NO_VALUE": (40, "a parameter has no finite value: set every parameter before the start"),
    "STORE": (
        41,
        "the memory that survives power-off did not keep the values that were written: write again; if it fails "
        "again, replace the board",
    ),
    "UNKNOWN": (42, "a message that this firmware does not know: flash the firmware of this hapticlab"),
    "FAULT": (43, "a fault is pending: read it, remove its cause, then call paddle.clear()"),
    "NOT_CALIBRATED": (44, "the board has no calibration: run `hapticlab calibrate`"),
    "CHANNELS": (45, "more watched outputs, or inputs other than x, than the board transmits: watch fewer"),
    "ALIAS": (
        47,
        "at this period the sensor's magnet could make half a turn between two samples, below the speed limit: use a "
        "shorter T, a lower speed_max (calibrate), or a quadrature encoder",
    ),
    "HOT": (46, "the motor is hot from earlier forces: let it cool for some minutes"),
    "NOT_WIRED": (48, "nobody has confirmed the wiring of this paddle: run `hapticlab calibrate`"),
}

#: number -> what it is, cause, cure; every one of them leaves the motor off
FAULTS = {
    "HOST_SILENT": (1, "no valid frame came from the computer for 100 ms", "check the cable; keep the notebook running"),
    "NOT_FINITE": (
        2,
        "the scene computed nan or infinity",
        "look for a division by zero, an unstable scene or a sine of more than 8192 rad",
    ),
    "OVER_SPEED": (3, "the handle moved faster than the limit", "hold the handle; lower the stiffness or add damping"),
    "OVER_TRAVEL": (4, "the handle left its calibrated travel", "home again; if this happens again, run `hapticlab calibrate`"),
    "OVER_HEAT": (5, "the motor gave a large force for a long time and is hot", "let it cool for some minutes; use less force"),
    "OVERRUN": (6, "steps repeatedly took longer than the period", "raise T, or use a cheaper method or scene"),
    "BAD_PROGRAM": (
        7,
        "the program in memory changed while it ran",
        "send the scene again; if this happens again, replace the board",
    ),
    "SENSOR": (
        8,
        "the position sensor gave an impossible reading or lost counts",
        "check the sensor's wires and magnet, then home again",
    ),
    "FROZEN": (
        10,
        "the position sensor did not move while the motor pushed, not even while the force faded out",
        "check that magnet, capstan and wires are tight; if something held the handle still, let it move, then home again",
    ),
    "MEMORY": (9, "the stack reached the data", "send a smaller scene and report this with the scene"),
}
STATES = {"IDLE": 0, "RUN": 1, "FAULT": 2}
TARGETS = {"PROGRAM": 0, "SETTINGS": 1, "STANDALONE": 2}
#: bits of STATE.flags
FLAGS = {"HOMED": 1, "CALIBRATED": 2, "SIGN_CHECKED": 4, "ARMED": 8, "STANDALONE": 16, "READY": 32, "TRAVEL_MISMATCH": 64}
#: bits of SAMPLE.flags
SAMPLE_FLAGS = {"SATURATED": 1, "OVERRUN": 2, "FIRST": 4}
#: bits of START.options; PASSIVE leaves the motor off and needs no home
OPTIONS = {"PASSIVE": 1}
RESET_CAUSES = {
    "POWER_OR_RESET": (0, "power-on or reset (the bootloader hides which)"),
    "POWER": (1, "power-on"),
    "EXTERNAL": (2, "the reset pin: opening the port, or the button"),
    "BROWN_OUT": (3, "the supply fell too low: check the power supply and its plug"),
    "WATCHDOG": (4, "the firmware hung and the hardware watchdog reset it: report this with the scene"),
}
#: readings of the first and the last repeat after `wrap` counts; the second is a running count
SENSORS = {"MAGNETORESISTIVE": 0, "QUADRATURE": 1, "AS5048A": 2}
#: how a motor's driver is told: PWM and direction; two inputs, of which one has the PWM and the other is low; two inputs
#: for the direction, and the PWM on an enable; the same with inputs that a shift register holds (motor shield)
DRIVES = {"PWM_DIRECTION": 0, "TWO_INPUTS": 1, "TWO_INPUTS_ENABLE": 2, "SHIFT_REGISTER": 3}
#: duty grows with the force, with its square root, or along the measured curve duty_dead, duty_25, duty_50, duty_75, 1
MOTOR_LAWS = {"LINEAR": 0, "SQRT": 1, "MEASURED": 2}
#: what a person confirms before a motor may be driven. Pins are 4 bytes, the first one lowest, NO_PIN for none
WIRING = ("motor_pins", "sensor_pins", "carrier", "sensor", "drive")
NO_PIN = 255

#: what the loop works with, (struct type, name, unit, meaning): large numbers first, so that no compiler pads the struct,
#: and WIRING in one piece
LOOP_SETTINGS = (
    ("f", "metres_per_count", "m", "handle travel of one count; its sign makes x grow into the wall"),
    ("f", "travel_min", "m", "position of the lower stop"),
    ("f", "travel_max", "m", "position of the upper stop"),
    ("f", "force_full", "N", "force at the handle at full duty"),
    ("f", "force_max", "N", "the largest force ever commanded"),
    ("f", "force_continuous", "N", "the largest force the motor stands for ever"),
    ("f", "heating_time", "s", "time constant of the motor's heating"),
    ("f", "speed_max", "m/s", "faster than this is a fault"),
    ("I", "motor_pins", "1", "pins of the motor's driver, one a byte"),
    ("I", "sensor_pins", "1", "pins of the sensor, one a byte"),
    ("I", "carrier", "Hz", "frequency of the PWM, rounded to what the board's timer can do"),
    ("B", "sensor", "1", "SENSORS"),
    ("B", "drive", "1", "how the motor's driver is told: DRIVES"),
    ("H", "wrap", "1", "counts after which the reading of an angle sensor repeats"),
    ("B", "wired", "1", "1 once a person has confirmed the wiring"),
    ("B", "checked", "1", "1 once the motor's sign was seen to be right"),
    ("B", "motor_law", "1", "duty from force: MOTOR_LAWS"),
    ("b", "motor_sign", "1", "1, or -1 where the motor's wires are swapped"),
)
#: what a board keeps over power-off: of the fields behind the loop's the motor's curve is read once, no others are
SETTINGS = (
    ("I", "layout", "1", "CRC-32 of this table, so that settings of another firmware are not taken for these"),
    *LOOP_SETTINGS,
    ("f", "duty_dead", "1", "part of full duty below which the motor gives no force"),
    ("f", "duty_25", "1", "part of full duty for a quarter of force_full, where the law is MEASURED"),
    ("f", "duty_50", "1", "part of full duty for half of force_full, where the law is MEASURED"),
    ("f", "duty_75", "1", "part of full duty for three quarters of force_full, where the law is MEASURED"),
    ("I", "ident", "1", "16 bits that name this very paddle"),
    ("I", "date", "1", "of calibration, as 20261120; 0: never calibrated"),
    ("f", "m", "kg", "effective mass, for the computer's models"),
    ("f", "b", "N s/m", "viscous damping, for the computer's models"),
    ("f", "coulomb", "N", "Coulomb friction, for the computer's models"),
    ("f", "sensor_delay", "s", "age of the sensor's reading, for the computer's models"),
    ("f", "sensor_noise", "m", "standard deviation of the sensor's noise, for the computer's models"),
    ("f", "sensor_flight", "s", "time in which an angle sensor goes from its last count back to its first"),
    ("I", "crc", "1", "CRC-32 of all before it"),
)
SETTINGS_STRUCT = struct.Struct("<" + "".join(type for type, *_ in SETTINGS))
#: of the settings: what the loop's numbers can hold, far beyond any paddle
SETTING_RANGES = {
    "metres_per_count": (-0.1, 0.1), "travel_min": (-1e3, 1e3), "travel_max": (-1e3, 1e3), "force_full": (1e-6, 1e6),
    "force_max": (1e-6, 1e6), "force_continuous": (1e-6, 1e6), "heating_time": (1.0, 1e6), "speed_max": (1e-6, 1e6),
    "duty_dead": (0.0, 0.5), "duty_25": (0.0, 1.0), "duty_50": (0.0, 1.0), "duty_75": (0.0, 1.0),
    "m": (0.0, 1e6), "b": (0.0, 1e6), "coulomb": (0.0, 1e6), "sensor_delay": (0.0, 1.0), "sensor_noise": (0.0, 1.0),
    "sensor_flight": (0.0, 0.01),
}  # fmt: skip
METRES_PER_COUNT_MIN, COUNTS_MAX = 1e-12, 1e8
#: counts of an angle sensor
WRAP_MIN, WRAP_MAX = 16, 16384

#: the loop's own limits
HOST_SILENCE_MS = 100
#: until the motor's sign was seen to be right no more than this is commanded [N]
UNCHECKED_FORCE_N = 0.5
#: overruns in a row, and in a second, that are a fault
OVERRUNS_IN_A_ROW, OVERRUNS_PER_SECOND = 4, 20


def row_of(table, number):
    """Return the name and the words of the row with a number, of RESULTS, FAULTS or RESET_CAUSES; None for no such row."""
    return next(((name, *words) for name, (known, *words) in table.items() if known == number), None)


def settings_hash():
    """Return the CRC-32 of the settings' table."""
    return zlib.crc32(repr(SETTINGS).encode())


def table_hash():
    """Return the CRC-32 of every table that a board and this package must agree on, the machine's included."""
    messages = [(name, m.number, m.fields, m.guarded, m.open) for name, m in MESSAGES.items()]
    numbers = [(name, row[0]) for table in (RESULTS, FAULTS, RESET_CAUSES) for name, row in table.items()]
    rest = (STATES, TARGETS, FLAGS, SAMPLE_FLAGS, OPTIONS, SENSORS, DRIVES, MOTOR_LAWS, WIRING, NO_PIN, SETTINGS)
    rest += (SETTING_RANGES, METRES_PER_COUNT_MIN, COUNTS_MAX, WRAP_MIN, WRAP_MAX)
    limits = HOST_SILENCE_MS, UNCHECKED_FORCE_N, OVERRUNS_IN_A_ROW, OVERRUNS_PER_SECOND
    return zlib.crc32(repr((PROTOCOL, LARGEST_PAYLOAD, machine_hash(), messages, numbers, rest, limits)).encode())
