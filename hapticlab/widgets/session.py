"""A scene that runs while somebody looks at it: inputs of a front end go in, frames come out, in a thread of its own."""

import time

#: presses that a front end has, see :meth:`Session.press`
PRESSES = ("start", "pause", "resume", "record", "stop", "replay")


class Session:
    """What a front end is connected to.

    A front end calls ``connect(sink)`` once, sends ``description()`` to its views, and says ``ready(view)`` for every view
    that opened, ``alive(view)`` at least once a second from each, ``gone(view)`` when one closed; ``view`` is any text that
    tells views apart. Nothing runs before the first ready; everything ends with the last view, or after 2 s of silence.
    Then the inputs: each stores what it is given and returns at once, from whatever thread. A front end may keep the
    session; it must not keep the LiveView, whose end closes the session.
    """

    def __init__(self, paddle, scene, *, sliders=None, speed=1.0, picture=None, clock=time.monotonic, **options):
        self.paddle, self.scene = paddle, scene

    def description(self):
        """Return what a front end is told once: a dict of what JSON can carry.

        ``title``; ``kind``, "simulated" or "board"; ``parameters``, a list of {name, unit, value, low, high, limit_words};
        ``traces``, a list of {name, label, unit_shown, scale}, where shown = scale * value in SI; ``x_range``, [left, right]
        [m], and ``box``, [left, right, bottom, top] [m], of the picture; ``help``, the keys in words; ``status``, words.
        """

    def connect(self, sink):
        """Give frames to ``sink(frame)``, from the session's thread, 60 a second at most; one sink at a time."""

    def ready(self, view=""):
        """Note that a view opened: the first starts a simulation, or shows that a board's motor is off."""

    def alive(self, view=""):
        """Note that a view is still there."""

    def gone(self, view=""):
        """Note that a view closed: the last one ends the thread, and a board's motor goes off."""

    def intend(self, x):
        """Say where the hand means to be [m]."""

    def hold(self, held):
        """Take the handle, or let go of it."""

    def move(self, name, value):
        """Move a slider, in SI. What is refused is told in the status, and ``flags["values"]`` says where it stays."""

    def press(self, name):
        """Press one of PRESSES; "stop" ends a recording."""
