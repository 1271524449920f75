"""What the steps of a bench share: the paddle, the person who holds it, and a light pull that cannot be left on."""

from contextlib import contextmanager

from ...scene.notation.symbols import parameters
from ...scene.scene import Scene
from ..setup.connect import connect
from .steps import PULL

#: s of pulling before anything is tried
SETTLES = 0.2


class Bench:
    """What the steps share: the paddle, the person, and how to pull the handle."""

    def __init__(self, paddle, person):
        self.paddle, self.person = paddle, person
        self.lowered = None  # what a board had stored whose limits are lowered for a test
        self.ended = self.log = None  # the run that ended last, and its Telemetry

    @property
    def metres_per_count(self):
        """Of the settings [m]; 1 where there are none."""
        return abs(self.paddle.settings.metres_per_count) if self.paddle.settings else 1.0

    def hold(self, more="Press Enter."):
        """Ask for the handle to be held against a pull."""
        self.person.ask(f"Hold the handle lightly in the middle. {more}")

    @contextmanager
    def pulled(self, scene=None):
        """Start a scene, by default a light pull; what raises inside leaves no motor on."""
        f = parameters("f", units="N")
        with self.paddle.attended():
            self.paddle.start(scene or Scene(force=f, name="light pull")(f=PULL), force_max=PULL)
            self.paddle.wait(SETTLES)
            yield self.paddle

    def fault(self, seconds):
        """Wait for a fault and end the run; return the fault's fields, or None."""
        self.ended = run = self.paddle.under_way
        self.paddle.exchange.wait(lambda: run.fault is not None, seconds)
        self.log = self.paddle.stop()
        return run.fault

    def plug_in(self):
        """Find the board again."""
        again = getattr(self.person, "plug_in", None)
        url, T = self.paddle.url, self.paddle.T
        self.paddle.close()
        self.paddle = again() if again else connect(url, T=T)
