"""A person at a simulated paddle: a handle with stops, a hand that moves it, and somebody who answers."""

import math
from dataclasses import replace

from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import Settings, nominal
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.setup.person import Person
from hapticlab.device.simulated.moved_handle import Handle
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.scene.notation.symbols import parameters
from hapticlab.scene.scene import Scene

STOP = 0.045


class StoppedHandle(Handle):
    """A handle between two stops, pushed by ``hand(t, x, v)`` [N]."""

    hand = staticmethod(lambda t, x, v: 0.0)

    def step(self, F):
        super().step(F - self.hand(self.t, self.x, self.v))
        if abs(self.x) > STOP:
            self.x, self.v = math.copysign(STOP, self.x), 0.0

    def with_period(self, T):
        like = Handle.with_period(self, T)
        other = StoppedHandle(like.paddle, like.x, like.v, like.steps)
        other.hand = self.hand
        return other


def holding(place, k=300.0, b=20.0):
    """A hand that holds the handle at a place [m], and leads it there at 1.4 m/s at most: slower than its magnet turns over."""
    return lambda t, x, v: k * (place - x) - b * v


def flicking(place=0.012, every=0.8, lasts=0.6, k=30.0, b=0.6):
    """A hand that leads the handle to one side and lets go, then to the other side."""

    def hand(t, x, v):
        turn, phase = divmod(t, every)
        return k * ((place if turn % 2 else -place) - x) - b * v if phase < lasts else 0.0

    return hand


def holding_either_side(place=0.012, lasts=1.7, k=120.0, b=3.0):
    """A hand that holds the handle on one side, then on the other, and never lets go."""
    return lambda t, x, v: k * ((place if t // lasts % 2 else -place) - x) - b * v


def swaying(amplitude=0.015, period=1.3, k=80.0, b=1.0):
    """A hand that leads the handle to and fro, and never lets go."""
    return lambda t, x, v: k * (amplitude * math.sin(2 * math.pi * t / period) - x) - b * v


def paddle(*, store=b"", wiring=1, hand=None, mechanics=None, **truth):
    """Return a SerialPaddle on a simulated board; truth are settings as sensor and motor really are."""
    port = open_port("sim://hapkit")
    real = nominal("hapkit", **({"metres_per_count": 2 * STOP / 7000} | truth))
    port.put_on(mechanics or SimulatedPaddle(m=0.03, b=0.1, T=1e-3), settings=real, store=store)
    port.wiring, start = wiring, port.handle
    port.handle = StoppedHandle(start.paddle, start.x, start.v, start.steps)
    port.handle.hand = hand or port.handle.hand
    return SerialPaddle("sim://hapkit", port=port)


class Scripted(Person):
    """Answers by the first key that its question holds; a callable answer is done before, given self."""

    def __init__(self, paddle, answers):
        self.paddle, self.answers, self.said = paddle, answers, []

    @property
    def handle(self):
        return self.paddle.exchange.port.handle

    def move(self, hand, seconds=0.6):
        """Let a hand act for so long, and go on."""
        self.handle.hand = hand
        self.paddle.exchange.wait(lambda: False, seconds)

    def say(self, text):
        self.said.append(text)

    def ask(self, question):
        self.said.append(question)
        assert len(self.said) < 300, "asked for ever"
        answer = next((a for key, a in self.answers.items() if key in question), None)
        assert answer is not None, f"no answer to: {question}"
        answer = answer(self) if callable(answer) else answer
        return answer.pop(0) if isinstance(answer, list) else answer or ""

    def choose(self, question, options):
        answer = self.ask(question)
        assert answer in options
        return answer

    @property
    def words(self):
        return "\n".join(self.said)


class OneWay(Settings):
    """A motor whose direction wire is off."""

    def force_of_duty(self, duty):
        return abs(super().force_of_duty(duty))


def at(place):
    """An answer: hold the handle there."""
    return lambda person: person.move(holding(place))


def led_to_both_stops(person):
    for place in (-STOP - 0.005, STOP + 0.005, 0.0):
        person.move(holding(place))


def let(hand):
    """An answer: from now on this hand acts."""

    def acts(person):
        person.handle.hand = hand

    return acts


def led_to_the_right(person):
    """An answer: move the handle slowly from stop to stop, from now on."""
    begin = person.handle.t

    def hand(t, x, v):
        return 300.0 * (min(-STOP + 0.04 * (t - begin), STOP + 0.005) - x) - 20.0 * v

    person.handle.hand = hand


#: a person whose Hapkit is wired as it should be
WIRED = {
    "supply of the motor OFF": lambda person: None,
    "Which paddle is built": "hapkit",
    "Move the handle to the LEFT stop, let it rest": at(-STOP - 0.005),
    "slowly to the RIGHT stop, within": led_to_the_right,
    "Is every wire where": "yes",
}
HOMING = {"one stop, then to the other": led_to_both_stops}
STOPS = {
    "to the LEFT stop": at(-STOP - 0.005),
    "to the RIGHT stop": at(STOP + 0.005),
    "On which side": "right",
    "How was the travel": "mm",
    "Travel from stop to stop": "90",
}


def hang(person, grams, side):
    """Hang a weight that pulls the handle to a stop; answer how heavy it is [g]."""
    mass = grams * 1e-3
    person.handle.paddle = replace(person.handle.paddle, m=0.05 + mass)
    person.handle.__init__(person.handle.paddle, person.handle.x, 0.0, person.handle.steps)
    person.move(lambda t, x, v: side * mass * 9.80665, 1.5)
    return str(grams)


def force_shown(paddle, person, force, reads):
    """Ask for a force away from the wall and return what a scale reads of it [N]."""
    f = parameters("f", units="N")
    paddle.start(Scene(force=f)(f=-force))
    grams = float(reads(person))
    port = paddle.exchange.port
    paddle.wait(0.01)
    port.seen_duty = abs(port.board.duty)
    paddle.stop()
    return grams * 9.80665e-3
