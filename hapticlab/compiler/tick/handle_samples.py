"""How a program sees the handle: the samples it remembers, its velocity, and its motion between two samples."""

from dataclasses import dataclass

from ...base.facts import card
from ...base.shows_itself import ShowsItself
from ...scene.notation.symbols import t, v, x
from ..ir.options import choice
from ..ir.program import Channel


@dataclass(frozen=True, repr=False)
class Hold(ShowsItself):
    """The model of the handle between two samples in an equation of motion; ``print`` describes it.

    Attributes
    ----------
    name : str
        The text that stands for it, ``hold="soh"``.
    says : str
        What it does, in one sentence.
    order_of_x, order_of_v : int
        Order in T of the error within a period, of x(t) or v(t).
    cost : str
    source : str
    confused_with : str
        A law with which it is confused, and the difference.
    """

    name: str
    says: str
    order_of_x: int
    order_of_v: int
    cost: str
    source: str
    confused_with: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "__doc__", self.says)  # what help and hl.find read

    def __str__(self) -> str:
        facts = {"order": f"{self.order_of_x} of x(t), {self.order_of_v} of v(t)", "cost": self.cost, "source": self.source}
        return card(f"{self.name}: {self.says}", {**facts, "not to be confused with": self.confused_with})


HOLDS = {
    hold.name: hold
    for hold in (
        Hold(
            "zoh", "Zero-order hold: x(n) and v(n) stay as they are until the next sample.", 1, 1,
            "nothing", "Franklin, Powell and Workman, Digital Control of Dynamic Systems: hold equivalents",
            "the wall law 'zoh', a spring on the sample; the motor's hold of the force, which is always of order zero",
        ),
        Hold(
            "foh", "First-order hold: the line through the sample with the velocity v(n).", 2, 1,
            "a product and a sum per evaluation",
            "Franklin, Powell and Workman, Digital Control of Dynamic Systems: hold equivalents",
            "the triangle hold, which needs the next sample and is called foh in some programs",
        ),
        Hold(
            "soh", "Second-order hold: the parabola through three samples, or with two measured velocities.", 3, 2,
            "one sample more to store, two products and sums per evaluation",
            "the same extrapolation, one order higher",
            "a filter of the position: the parabola passes through the samples, so it extrapolates their quantisation too",
        ),
    )
}  # fmt: skip
VELOCITIES = ("backward_difference", "measured")


def hold_named(given: str | Hold) -> str:
    """The name of a hold, from a record or its name; refuse what is neither."""
    return choice("hold", given.name if isinstance(given, Hold) else given, HOLDS)


def is_past_sample(name):
    """Whether a state of a program is a sample of the handle before the present one.

    Examples
    --------
    >>> is_past_sample("x(n-1)"), is_past_sample("z")
    (True, False)
    """
    return name.startswith((_past(x), _past(v)))


def _past(signal):
    return f"{signal.__name__}(n-"


class Handle:
    """The handle's samples x(n-k) and v(n-k), and x(t), v(t) between them.

    Past samples become states when asked for. ``velocity`` says where v(n) comes from:

    ``"backward_difference"``
        (x(n) - x(n-1))/T, zero at the first sample. What a board can know.
    ``"measured"``
        An input of its own: the exact velocity of a simulated paddle without an encoder.

    ``hold`` says how an equation of motion sees the handle at ``tau`` after sample n:

    ``"zoh"``
        x(n), v(n): the sample held.
    ``"foh"``
        x(n) + v(n) tau, v(n): the line through the sample with that velocity.
    ``"soh"``
        The parabola: with measured velocities the acceleration is (v(n) - v(n-1))/T; with backward differences it runs
        through x(n), x(n-1) and x(n-2), so that its slope at n is v(n) + a T/2.

    A force and a watched expression take the plain sample, v(t) = v(n), whatever the hold. For "soh" with backward
    differences the coupler's damper b then pushes the body with b a T/2 more than it pushes the handle: 1.8 mN for
    b = 1 N s/m and 10 mm at 3 Hz, which is 0.036 % of the 5 N that K = 500 N/m gives at 10 mm, or 1 % of the 0.18 N
    that a body of 50 g then takes. With the slope of the parabola in the force the two would be equal (0.007 %), but
    the device would need 2.29 N s/m instead of 1.29 N s/m for passivity (the same K, b and body, T = 1 ms): one b
    more, since at the highest frequency the slope of the parabola is twice the backward difference.
    """

    def __init__(self, tracing, velocity, hold):
        self.tracing, self.velocity, self.hold = tracing, velocity, hold
        self.T = tracing.T

    def sample(self, signal, lag=0):
        """x(n - lag) or v(n - lag)."""
        tracing = self.tracing
        if lag:
            # history starts at the first measured sample, and with it an estimated velocity at rest
            channel = Channel(f"{_past(signal)}{lag})", signal.unit, tracing.real)
            return tracing.state((signal, lag), channel, self.first(signal), lambda: self.sample(signal, lag - 1))
        if signal is x or self.velocity == "measured":
            return tracing.input(tracing.tick, signal)
        return (self.sample(x) - self.sample(x, 1)) * (1 / self.T)

    def acceleration(self):
        """The acceleration of the handle at the sample, as estimated: (v(n) - v(n-1))/T."""
        return (self.sample(v) - self.sample(v, 1)) * (1 / self.T)

    def first(self, signal):
        """Position x or velocity v at the first sample, in the init block."""
        if signal is x or self.velocity == "measured":
            return self.tracing.input(self.tracing.init, signal)
        return self.tracing.init.const(0.0)

    def motion(self, tau):
        """(x, v) of the handle at tau [s] after the sample, as ``hold`` sees them."""
        position, velocity = self.sample(x), self.sample(v)
        if self.hold == "zoh":
            return position, velocity
        if self.hold == "foh":
            return position + velocity * tau, velocity
        acceleration = (velocity - self.sample(v, 1)) * (1 / self.T)
        if self.velocity == "backward_difference":
            velocity = velocity + acceleration * (self.T / 2)
        return position + (velocity + acceleration * (tau / 2)) * tau, velocity + acceleration * tau

    def leaves(self, tau):
        """The handle as an equation of motion sees it at tau [s] after the sample: expression -> value."""
        return dict(zip((x(t), v(t)), self.motion(tau), strict=True))

    def polynomial(self):
        """x(t) and v(t) after the sample as ``hold`` sees them, each as value, rate, ... at the sample: two lists."""
        position, velocity = self.sample(x), self.sample(v)
        if self.hold == "zoh":
            return [position], [velocity]
        if self.hold == "foh":
            return [position, velocity], [velocity]
        acceleration = (velocity - self.sample(v, 1)) * (1 / self.T)
        if self.velocity == "backward_difference":
            velocity = velocity + acceleration * (self.T / 2)
        return [position, velocity, acceleration], [velocity, acceleration]
