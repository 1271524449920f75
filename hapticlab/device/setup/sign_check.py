"""Does the motor pull where it is told to pull? Positive work against a passive spring, before more force is enabled.

A weak spring around the middle, 0.5 N at most, is switched on and off by coin tosses (60 ms each) while a person moves
the handle and lets it go. For interval j, f_j is the force the spring asks of the motor at its begin, and delta_j how
much further the handle came than it would have coasted, and than it came on the average of all intervals, on and off,
at such a place and velocity. With e_j = +1 where the spring was on and -1 where it was off,

    W = sum of e_j f_j delta_j

grows by the work the motor does on the handle, whatever a hand does at the same time: the tosses are fair and unknown
before, so where the motor does nothing each term is as likely as its negative. Then Hoeffding's inequality bounds how
often Z = W / sqrt(sum of (f_j delta_j)^2) passes a limit c by chance, P(Z >= c) <= exp(-c^2/2), for any motion, any
hand, any mass and friction. At c = 5.5, looked at six times on both sides, that is three in a million. The bound holds
for terms cut at three times their median, too, as the cut does not know the tosses: a stop hit hard counts no more
than others. A motor whose direction wire is off pushes one way only, right on one side of the middle and wrong on the
other: so both sides have to agree, each with |Z| >= 2.5.
"""

import random
import secrets
from dataclasses import dataclass, replace

import numpy as np

from ...errors import PaddleError
from ...scene.notation.symbols import n, parameters, x
from ...scene.scene import Scene
from ..board.settings import changed
from ..link.messages import UNCHECKED_FORCE_N
from ..wiring import Wiring
from ..wirings import built_as
from .built import board_with_pins
from .stored_settings import lead_home, offer

#: the spring [N/m]: 0.5 N at 10 mm, below the passivity limit 2 b/T of any paddle with b >= 0.025 N s/m at 1 kHz
STIFFNESS = 50.0
#: tosses in a row, how long each lasts [s], and before each the stretch over which the velocity is taken [s]
TOSSES, LASTS, BEFORE = 100, 0.06, 0.01
#: c of the bound, and how often the result is looked at
CLEAR, LOOKS = 5.5, 6
#: |Z| from which the motor does something, though which way is not clear: by chance at most once in 45 looks at all of them
SOME = 3.0
#: |Z| on either side of the middle
SIDE = 2.5
#: terms are cut at so many times their median
CUT = 3.0
#: m; a handle that ranges over less was not moved
LEAST_MOTION = 2e-3


@dataclass(frozen=True)
class SignCheck:
    """What the motor was seen to do; Z, work [J] an interval, motion [m].

    ``wires`` are those that tell the driver its direction. ``verdict`` is "right", "wrong", "one way", "unclear",
    "nothing" or, for a handle that nobody moved, "unmoved".
    """

    verdict: str
    Z: float
    work: float
    motion: float
    intervals: int
    wires: str = "the wires of its driver"

    def __str__(self):
        seen = f"Z = {self.Z:+.1f} of {self.intervals} intervals (clear above {CLEAR}), {self.work * 1e6:+.0f} uJ each"
        words = {
            "right": "the motor pulls the handle in the right direction",
            "wrong": "the motor pushes the handle in the wrong direction: its two wires are swapped",
            "one way": f"the motor pushes in one direction only: check {self.wires}",
            "unclear": "the motor works, but its sign is not clear; continue slowly, without releasing the handle, on both sides",
            "unmoved": f"the handle moved by {self.motion * 1e3:.1f} mm only; move it 10 to 20 mm from the middle and release it",
            "nothing": "no effect of the motor was found: check its supply, its plug and its wires; a handle that moves "
            "stiffly or is held firmly can also hide the effect",
        }
        return f"{words[self.verdict]} ({seen})"


def measure_sign(paddle, person, *, seed=None):
    """Return the SignCheck of a homed paddle; no more than 0.5 N is asked of its motor."""
    tosses = random.Random(secrets.randbits(64) if seed is None else seed)
    terms, signs, sides, seen = (np.zeros(0) for _ in range(4))
    for _ in range(LOOKS):
        lead_home(paddle, person)
        person.ask(
            "Hold the handle lightly in the middle and press Enter. Then, for 6 seconds, move it slowly 10 to 20 mm to one "
            "side, release it, move it to the other side, release it, and so on. The motor pulls with at most 0.5 N."
        )
        log = _tugged(paddle, [tosses.random() < 0.5 for _ in range(TOSSES)])
        more, on, side = intervals(log)
        terms, signs, sides = np.append(terms, more), np.append(signs, 2.0 * on - 1), np.append(sides, side)
        seen = np.append(seen, log.x)
        found = replace(judge(terms, signs, sides, seen), wires=_direction_wires(paddle))
        if found.verdict in ("right", "wrong", "one way"):
            return found
        person.say(f"Not clear yet: {log.fault or found}")
    return found


def _direction_wires(paddle):
    """Return the wires that tell a driver its direction, such as "DIR on D8"."""
    built = built_as(board_with_pins(paddle.board["board"]), Wiring.of(paddle.settings))
    roles = [role for role in built.wiring.motor_roles if role not in ("PWM", "EN")]
    return " and ".join(f"{role} on {built.pins.name(built.wiring.pins()[role])}" for role in roles)


def judge(terms, signs, sides, positions):
    """Return the SignCheck of terms f_j delta_j [J], tosses e_j and sides of the middle (each 1 or -1), positions [m]."""
    most = CUT * float(np.median(np.abs(terms[terms != 0]))) if terms.any() else 0.0
    terms = np.clip(terms, -most, most)
    Z, left, right = (_Z(terms[k], signs[k]) for k in (slice(None), sides < 0, sides > 0))
    motion = float(np.ptp(positions)) if len(positions) else 0.0
    work = float(np.mean(signs * terms)) if len(terms) else 0.0
    if abs(Z) >= CLEAR and min(left / Z, right / Z) * abs(Z) >= SIDE:
        verdict = "right" if Z > 0 else "wrong"
    elif left * right < 0 and min(abs(left), abs(right)) >= CLEAR:
        verdict = "one way"
    elif motion < LEAST_MOTION:
        verdict = "unmoved"
    else:
        verdict = "unclear" if max(map(abs, (Z, left, right))) >= SOME else "nothing"
    return SignCheck(verdict, Z, work, motion, len(terms))


def _Z(terms, signs):
    """Return the sum of signed terms over the root of the sum of their squares."""
    size = float(np.sqrt(np.sum(terms**2)))
    return float(np.sum(signs * terms)) / size if size > 0 else 0.0


def intervals(log):
    """Return f_j delta_j [J], whether the spring was on, and the side of the middle, for every interval of a run."""
    begun = np.array([t for t, change in log.changes if "k" in change])
    on = np.array([change["k"] > 0 for _, change in log.changes if "k" in change])
    last = log.t[-1] if len(log) else -1.0
    ends = np.append(begun[1:], last)[: len(begun)]
    whole = (begun >= BEFORE) & (begun < ends) & (ends <= last)
    begun, ends, on = begun[whole], ends[whole], on[whole]
    if len(begun) == 0:
        return np.zeros(0), on, np.zeros(0)
    at, before, after = (np.interp(moment, log.t, log.x) for moment in (begun, begun - BEFORE, ends))
    coasting = (at - before) / BEFORE * (ends - begun)
    asked = -np.clip(STIFFNESS * (at - log.parameters["x_0"]), -UNCHECKED_FORCE_N, UNCHECKED_FORCE_N)
    known = np.column_stack([np.ones_like(at), asked, coasting])  # before the toss: a fit on it learns nothing of tosses
    further = after - at - coasting
    terms = asked * (further - known @ np.linalg.lstsq(known, further, rcond=None)[0])
    return terms, on, -np.sign(asked)


def check_sign(paddle, person, *, seed=None):
    """Check the motor's sign, offer to turn it where it is wrong, and note on the board when it is right.

    Returns
    -------
    SignCheck
        Of the last measurement. Only "right" lets the board give more than 0.5 N.

    Raises
    ------
    PaddleError
        If the board has no settings, or the sign is still wrong after it was turned.
    """
    if paddle.settings is None:
        raise PaddleError("the board has no settings yet, so it cannot give a force. Calibrate the stops first")
    found = measure_sign(paddle, person, seed=seed)
    if found.verdict == "wrong":
        turned = changed(paddle.settings, motor_sign=-paddle.settings.motor_sign, checked=0)
        words = [f"measured   {found}", f"to store   motor_sign = {turned.motor_sign}, not checked yet"]
        if not offer(paddle, person, turned, words):
            person.say("Every wall will push in the wrong direction. Use this paddle only after its sign is corrected.")
            return found
        found = measure_sign(paddle, person, seed=None if seed is None else seed + 1)
        if found.verdict == "wrong":
            raise PaddleError(f"with the opposite sign {found}. Neither sign is right; check {found.wires}.")
    if found.verdict == "right" and not paddle.settings.checked:
        words = [f"measured   {found}", "to store   the motor's sign is checked: full force from now on"]
        offer(paddle, person, changed(paddle.settings, checked=1), words)
    return found


def _tugged(paddle, tosses):
    """Run the spring, on and off as the tosses say, and return the Telemetry."""
    centre = paddle.state()["x"]
    k, x_0 = parameters("k x_0", units="N/m m")
    spring = Scene(force=k * (x(n) - x_0), name="a spring on and off")(k=0.0, x_0=centre)
    with paddle.attended():
        paddle.start(spring, force_max=UNCHECKED_FORCE_N)
        for on in tosses:
            paddle.wait(LASTS)
            paddle.set(k=STIFFNESS * on)
        paddle.wait(LASTS)
        return paddle.stop()
