"""Which paddle is built? A short numbered choice of known ones, or pin by pin; and the wires of the answer, shown."""

from ...compiler.boards.board_pins import PINS
from ...errors import PaddleError
from ..wiring import DRIVE_ROLES, DRIVE_WORDS, SENSOR_ROLES, SENSOR_WORDS, Wiring, pin_problem
from ..wirings import BUILDS, built_as

#: what a person types -> what the tables call it
SENSOR_KEYS = {"analog": "MAGNETORESISTIVE", "encoder": "QUADRATURE", "as5048a": "AS5048A"}
DRIVE_KEYS = {"direction": "PWM_DIRECTION", "inputs": "TWO_INPUTS", "enable": "TWO_INPUTS_ENABLE", "shield": "SHIFT_REGISTER"}
OTHER = "other"
#: Hz; above this nobody hears a carrier
HEARD = 18_000


def board_with_pins(name):
    """Return the name of the board whose pins a wiring is for; a simulated one takes the pins of an Uno."""
    return name if name in PINS else "uno"


def ask_built(person, board):
    """Ask which paddle is built on a board, and return its Build.

    Parameters
    ----------
    person : Person
    board : str
        Of hapticlab.compiler.boards.board_pins.PINS.
    """
    known = {name: one.title for name, one in BUILDS.items() if one.board == board}
    options = known | {OTHER: "something else: the pins one by one"}
    answer = person.choose("Which paddle is built?", options)
    return BUILDS[answer] if answer != OTHER else built_as(board, _pin_by_pin(person, PINS[board]))


def show(person, build):
    """Show every wire of a paddle, in a table and where it is drawn."""
    person.say("\n".join(["", *build.table(), *(f"note    {note}" for note in build.remarks())]))
    where = person.picture(build)
    if where:
        person.say(f"drawing {where}")


def _pin_by_pin(person, pins):
    """Ask for sensor, driver, pins and carrier until the board can do it."""
    while True:
        sensor = SENSOR_KEYS[person.choose("Which sensor is built in?", _keyed(SENSOR_KEYS, SENSOR_WORDS))]
        sensor_pins = tuple(_pin(person, pins, "sensor", role) for role in SENSOR_ROLES[sensor])
        drive = DRIVE_KEYS[person.choose("Which driver has the motor?", _keyed(DRIVE_KEYS, DRIVE_WORDS))]
        motor_pins = tuple(_pin(person, pins, "driver", role) for role in DRIVE_ROLES[drive])
        carriers = {str(hz): "above hearing" if hz > HEARD else "audible, for a slow driver" for hz in pins.carriers}
        carrier = person.choose("Which PWM frequency [Hz]? An L298 follows 25000 Hz, and 40000 Hz at most.", carriers)
        wiring = Wiring(sensor, drive, motor_pins, sensor_pins, int(carrier))
        problem = pin_problem(wiring, pins)
        if problem is None:
            return wiring
        person.say(f"{problem[0]}: the board {problem[1]}. {problem[2]}.")


def _keyed(keys, words):
    return {key: words[name] for key, name in keys.items()}


def _pin(person, pins, part, role):
    """Ask for the pin of a terminal until it is one of the board's."""
    free = {name: pin for pin, name in pins.names.items() if pin not in pins.busy}
    printed = {name.removeprefix("D"): pin for name, pin in free.items()}  # as 4 or ~5 on an Uno; a Pico's 4 is its GP2
    while True:
        typed = person.ask(f"Which pin of the board goes to {role} of the {part}?")
        found = (free | printed).get(typed.strip().upper().lstrip("~"))
        if found is not None:
            return found
        person.say(f"{typed!r} is not a free pin of this board. Free pins are {', '.join(free)}.")


def require_wiring(paddle):
    """Reject a step that drives the motor before a person has confirmed the wiring."""
    if paddle.settings is None or not paddle.settings.wired:
        raise PaddleError("nobody has confirmed the wiring of this paddle, so its motor stays off. Run `hapticlab calibrate`.")
