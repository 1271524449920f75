"""Which wires go where: asked, stored unconfirmed, checked with the motor off, and confirmed by the person.

The rule of every board is kept here and nowhere else on the computer: another wiring is stored with wired = 0 and checked = 0,
with the motor off, and a second commit confirms it. Until then the board drives no pin of the motor.
"""

from dataclasses import dataclass

from ...errors import LinkError, PaddleError
from ..board.settings import changed, nominal
from ..profiles import PROFILES
from ..wiring import Wiring
from ..wirings import BUILDS, built_as
from .built import ask_built, board_with_pins, show
from .sensor_readings import JUMP, LEAST_SWEEP, REST, most_at_rest, readings
from .stored_settings import offer, store

#: until the stops are measured: counts after which a reading repeats, and metres per count of a Hapkit's pulley and sector.
#: KMA210: half a turn, 5 % to 95 % of 5 V, is 920 of an Uno's 10 bits, 12.8 um each, and 3724 of a Pico's 12 bits of 3.3 V
#: behind a divider to 2/3; AS5048A: 16384 in a whole turn; encoder: illustrative
KMA210 = {"uno": 920, "pico": 3724}
HALF_TURN, ENCODER = 920 * 12.8e-6, 10e-6
#: of an encoder, which does not repeat: a board takes a sensor of more counts for one with noise
NO_WRAP = 1024
#: s of watching a handle that is moved from stop to stop; how often a person may correct a wire
MOVED, TRIES = 5.0, 3


@dataclass(frozen=True)
class SensorCheck:
    """What the sensor showed with the motor off: lines of what was found, and what is wrong or ""."""

    found: tuple
    problem: str
    to_the_right: int = 0

    def __str__(self):
        return "\n".join([*self.found, *([f"problem    {self.problem}"] if self.problem else [])])


def check_wiring(paddle, person, ident=0):
    """Ask what is built, store it unconfirmed, check the sensor with the motor off, and confirm it if the person does.

    Returns
    -------
    bool
        Whether the wiring is confirmed.
    """
    person.ask("Switch the supply of the motor OFF, leave it off, and press Enter. The sensor is checked first, without a force.")
    build = ask_built(person, board_with_pins(paddle.board["board"]))
    show(person, build)
    if not _unconfirmed(paddle, person, build, ident):
        return False
    for _ in range(TRIES):
        found = check_sensor(paddle, person)
        person.say(f"\n{found}")
        if not found.problem:
            return _right_direction(paddle, person, found) and _confirmed(paddle, person)
        if person.choose("Correct it, with the supply off. Look again?", {"yes": "it is corrected", "no": "stop here"}) == "no":
            break
    return _left_off(paddle, person)


def rewired(settings, wiring, board="uno"):
    """Return the settings with another wiring of a board, unconfirmed; constants of another sensor are nominal again.

    Examples
    --------
    >>> from hapticlab.device.board.settings import nominal
    >>> from hapticlab.device.setup.wiring_check import rewired
    >>> from hapticlab.device.wirings import build
    >>> new = rewired(nominal("hapkit", wired=1, checked=1), build("longhorn_d11").wiring)
    >>> new.wired, new.checked, new.date
    (0, 0, 0)
    """
    fields = wiring.settings() | {"wired": 0, "checked": 0}
    if all(getattr(settings, name) == fields[name] for name in ("sensor", "sensor_pins")):
        return changed(settings, **fields)
    if wiring.sensor == "QUADRATURE":
        return changed(settings, **fields, date=0, metres_per_count=ENCODER, wrap=NO_WRAP)
    turns, wrap = (1, 16_384) if wiring.sensor == "AS5048A" else (0.5, KMA210[board])
    return changed(settings, **fields, date=0, metres_per_count=2 * turns * HALF_TURN / wrap, wrap=wrap)


def check_sensor(paddle, person):
    """Watch the handle at rest, then moved from the left stop to the right one, with the motor off; return the SensorCheck."""
    wiring = Wiring.of(paddle.settings)
    at = {role: _pin_name(paddle, pin) for role, pin in wiring.pins().items()}
    person.ask("Move the handle to the LEFT stop, let it rest there, and press Enter. The motor is off.")
    rest = readings(paddle, REST)
    problem = _fault(rest, wiring, at)
    most = most_at_rest(paddle.settings)
    if not problem and rest.sweep > most:
        problem = (
            f"at rest the reading wanders by {rest.sweep:.0f} counts; this sensor has {most} at most. {_lines(wiring, at)} may "
            "have no contact, or lies beside the wires of the motor"
        )
    if problem:
        return SensorCheck((), problem)
    person.ask(f"Press Enter, then move the handle slowly to the RIGHT stop, within {MOVED:g} s, and hold it there.")
    moved = readings(paddle, MOVED)
    found = (
        f"measured   at rest {rest.sweep:.0f} counts wide",
        f"measured   {moved.sweep:.0f} counts from stop to stop, largest jump {moved.jump if len(moved.counts) > 2 else 0:.0f}",
    )
    return SensorCheck(found, _fault(moved, wiring, at) or _of_motion(moved, wiring, at), 1 if moved.travelled > 0 else -1)


def _fault(seen, wiring, at):
    """Return what the board itself found wrong with the sensor, in words."""
    if seen.fault is None:
        return ""
    if "SENSOR" not in seen.fault:
        return f"the handle could not be watched: {seen.fault}"
    causes = {
        "MAGNETORESISTIVE": "the wire is off, the sensor has no supply, or its magnet is missing",
        "QUADRATURE": "both lines changed at once: they touch each other, or the supply of the encoder is missing",
        "AS5048A": "an answer was damaged or none came: check these wires, the supply of the sensor, and its magnet",
    }
    return f"the board rejects the reading of {_lines(wiring, at)}: {causes[wiring.sensor]} ({seen.fault})"


def _of_motion(seen, wiring, at):
    """Return what is wrong with a sweep from stop to stop, in words."""
    lines = _lines(wiring, at)
    if seen.is_to_and_fro and wiring.sensor == "QUADRATURE":
        return f"the count only goes up and down by {seen.sweep:.0f}: only one line of the encoder arrives. Check {lines}"
    if seen.sweep < LEAST_SWEEP:
        return (
            f"the reading changed by {seen.sweep:.0f} counts while the handle was moved; a sweep has at least {LEAST_SWEEP}. "
            f"Check {lines}, the sensor's VCC and GND, and that its magnet or its disc turns with the handle"
        )
    if seen.jump > JUMP:
        return (
            f"the reading jumps by {seen.jump:.0f} counts between two samples; {JUMP} are allowed. Move the handle slowly; if it "
            f"jumps again, {lines} has a loose contact, the magnet is loose, or the wrong kind of sensor was chosen"
        )
    return ""


def _lines(wiring, at):
    """Return the sensor's wires in words, such as "A on D2 and B on D3"."""
    return " and ".join(f"{role} on {at[role]}" for role in wiring.sensor_roles)


def _pin_name(paddle, pin):
    return built_as(board_with_pins(paddle.board["board"]), Wiring.of(paddle.settings)).pins.name(pin)


def begun(was, build, ident=0):
    """Return what a board is to keep of a paddle that is built, its wiring not confirmed.

    Parameters
    ----------
    was : Settings or None
        What it keeps now. Where the sensor is the same, its constants stay.
    build : Build
    ident : int
        The name of a paddle that has none yet.
    """
    wiring = build.wiring
    if was is not None and (Wiring.of(was).sensor, Wiring.of(was).sensor_pins) == (wiring.sensor, wiring.sensor_pins):
        return rewired(was, wiring, build.board)
    alike = {one.wiring: name for name, one in PROFILES.items() if one.wiring}
    kinds = {(BUILDS[name].wiring.sensor, BUILDS[name].wiring.drive): profile for name, profile in alike.items()}
    profile = alike.get(build.name) or kinds.get((wiring.sensor, wiring.drive), "hapkit")
    return rewired(nominal(profile, ident=was.ident if was is not None else ident), wiring, build.board)


def _unconfirmed(paddle, person, build, ident):
    """Store a wiring that nobody has confirmed yet, if the person agrees; return whether the board has it now."""
    was, new = paddle.settings, begun(paddle.settings, build, ident)
    if was is not None and new == changed(was, wired=0, checked=0):
        words = ["kept       the wiring on the board is this one; it is checked again"]
        new = was
    else:
        words = ["to store   this wiring, not confirmed: the motor stays off, and its sign is to be checked again"]
        if new.date == 0:
            words.append("to store   nominal constants of such a paddle: measure its stops and its force next")
    if new is was:
        person.say("\n".join(words))
        return True
    try:
        return offer(paddle, person, new, words)
    except LinkError as problem:
        if problem.result != "RANGE":
            raise
        raise PaddleError(
            f"wiring: {build.wiring}; the firmware on this board was built for another kind of paddle and rejects it. Run "
            "`hapticlab flash` and choose this paddle, then calibrate."
        ) from problem


def _right_direction(paddle, person, found):
    """Compare the direction of the sensor with the calibrated one; a reversed one makes the stops unknown again."""
    kept = paddle.settings
    if kept.is_nominal:
        direction = "increase" if found.to_the_right > 0 else "decrease"
        person.say(f"found      counts {direction} to the right; the step stops decides on which side the walls are")
        return True
    side = "right" if found.to_the_right * kept.metres_per_count > 0 else "left"
    question = f"By the stored calibration x increases to the {side}, into the walls. Are the walls on the {side}?"
    if person.choose(question, {"yes": "", "no": ""}) == "yes":
        return True
    reverse = "A and B of the encoder" if Wiring.of(kept).sensor == "QUADRATURE" else "the direction of the sensor"
    words = [
        f"measured   the sensor counts in the opposite direction: {reverse} were swapped since the calibration",
        "to store   the calibration is no longer valid: measure the stops next",
    ]
    return offer(paddle, person, changed(kept, date=0, wired=0, checked=0), words)


def _confirmed(paddle, person):
    """Let the person confirm the wiring, the supply still off; return whether it is confirmed."""
    answer = person.choose(
        "Compare every wire with the table once more; the supply of the motor is still off. Is every wire where the table says?",
        {"yes": "confirm the wiring", "no": "the motor stays off"},
    )
    if answer == "no":
        return _left_off(paddle, person)
    if not paddle.settings.wired:
        store(paddle, changed(paddle.settings, wired=1))
    person.say("Confirmed. The supply of the motor stays off until the step that checks its sign.")
    return True


def _left_off(paddle, person):
    """Take back what was confirmed before, so that no motor is driven over a wiring that nobody trusts; return False."""
    if paddle.settings.wired:
        store(paddle, changed(paddle.settings, wired=0, checked=0))
    person.say("The wiring is not confirmed, so the motor stays off. Run `hapticlab calibrate --only wiring` again.")
    return False
