"""A simulated paddle advanced a few ticks at a time, while its hand and the scene's parameters change between them."""

from dataclasses import replace

import numpy as np

from ...base.telemetry import Telemetry
from ...errors import PaddleError
from ..hand.hand import Hand
from ..live_parameters import MOST_AT_ONCE, checked, in_portions, named_values
from .closed_loop import link, load_linked
from .not_finite import not_finite

#: the grip of a paddle whose own hand has no spring to lead the handle by
GRIP = "pinch"


class Stepping:
    """A scene on a simulated paddle whose hand is told where to go; bit for bit what ``paddle.run`` gives for that intent.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its hand's mass, damping, spring and noise hold the handle; its intent and push are replaced by what
        :meth:`advance` is told. Without a spring the hand is ``hl.Hand("pinch")``.
    scene : Scene or Program
    x, v : float
        Position [m] and velocity [m/s] at the first sample.
    engine : {"auto", "llvm", "wasm", "interpreter"}
    own_hand : bool
        True leaves the hand as it is, with its push, also where it has no spring; only a moving intent is then told.
    **options
        Of hapticlab.compile.

    Attributes
    ----------
    program : Program
        The scene's, with the values it has now.
    paddle : SimulatedPaddle
        With the hand that holds the handle.
    period : float
        From one sample to the next [s].
    held : bool
        Whether the hand holds the handle.
    begun : bool
        Whether it can go on from where it is.
    place : float
        Position of the handle at the next sample [m].
    fault : str or None
        What stopped the motor.

    Examples
    --------
    >>> import hapticlab as hl, numpy as np
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    >>> stepping = Stepping(paddle, hl.wall()(k=300, x_o=0.01))
    >>> some = stepping.advance(np.linspace(0.0, 0.02, 201))
    >>> stepping.set(k=600.0)                       # from this time on [s]
    0.2
    >>> more = stepping.advance(np.full(301, 0.02))
    >>> round(float(more["F"][-1] / (more["x"][-1] - 0.01)))
    600
    """

    kind, begun, motor, waits = "simulated", True, False, ""

    def __init__(self, paddle, scene, *, x=0.0, v=0.0, engine="auto", own_hand=False, **options):
        self.program = paddle.program(scene, **options)
        self.paddle = paddle if own_hand else with_grip(paddle)
        self._engine, self._begin = engine, paddle.plant_values(x, v)[-2:]
        self.held, self._loops, self.period = True, {}, self.paddle.T
        self.start()

    def start(self):
        """Begin anew: the handle where it was at first, the scene's states at their starts, the values as they are now."""
        self._states, self.ticks, self.fault, self.place, self._heard = None, 0, None, self._begin[0], {}
        shaken = self.paddle.hand.push_noise if self.paddle.hand else 0.0
        self._noise = [
            (deviation, np.random.default_rng([self.paddle.seed, stream]))
            for stream, deviation in enumerate((self.paddle.noise, shaken))
        ]

    def advance(self, intent):
        """Advance by one tick less than there are places, and return what was sampled.

        Parameters
        ----------
        intent : array of shape (ticks + 1,)
            Where the hand means to be at the ticks from now on [m], linear in between. Let go, nobody looks at it.

        Returns
        -------
        dict of str to array
            t, x, v, F and the watched channels, as a Telemetry has them; and intent, nan where the handle is let go.
        """
        intent = np.asarray(intent, float)
        ticks, loop = len(intent) - 1, self._loop()
        outputs, self._states = loop.loaded.run(ticks, self._inputs(intent), self._parameters(loop), self._states)
        found = {c.name: outputs[:, k, 0] for k, c in enumerate(loop.linked.outputs)}
        code = found.pop("fault")
        if self.fault is None and code.any():
            first = int(np.argmax(code > 0))
            self.fault = not_finite(self.program, code[first], self.ticks + first, self.paddle.T)
        found["intent"] = intent[:-1] if self.held else np.full(ticks, np.nan)
        t = np.arange(self.ticks, self.ticks + ticks) * self.paddle.T
        self.ticks += ticks
        self.place = float(self._states[loop.names.index("plant.x"), 0])
        return {"t": t, **found}

    def check(self, **values):
        """Return values in SI, or say why a parameter cannot have one; see :func:`hapticlab.device.live_parameters.checked`."""
        if len(values) <= MOST_AT_ONCE:
            return checked(self.program, values)
        before, numbers = self.program, {}
        try:
            for some in in_portions(values):
                numbers |= checked(self.program, some)
                self._take(numbers)
        finally:
            self.program = before
        return numbers

    def set(self, **values):
        """Set parameters of the scene, all from the same tick on; return the time of that tick [s].

        Raises
        ------
        ParameterError
            As a board does: for an unknown name, a value past its range or past what keeps the steps stable.
        """
        self._take(self.check(**values))
        return self.ticks * self.paddle.T

    def hear(self, **numbers):
        """Set what another paddle sends, in SI, unchecked and unrecorded, until the next start; return True."""
        self._heard |= numbers
        return True

    def hold(self, held):
        """Take the handle, or let go of it; position and velocity stay as they are at that tick."""
        if held != self.held and self._states is not None:
            known = dict(zip(self._loop().names, self._states[:, 0], strict=True))
            self.held = held
            self._states = np.array([[known.get(name, 0.0)] for name in self._loop().names])
        self.held = held

    def stop(self):
        """Stand still: a simulation moves only when it is advanced."""

    def warm(self):
        """Compile what taking and letting go need, so that no tick waits for it."""
        for held in (True, False):
            loop = self._loop(held)
            loop.loaded.run(1, np.zeros((1, len(loop.linked.inputs))), self._parameters(loop))

    def telemetry(self, rows, *, values, changes=()):
        """Return rows that :meth:`advance` gave, put together, as Telemetry that begins at 0 s.

        Parameters
        ----------
        rows : dict of str to array
        values : dict of str to float
            Of the scene's parameters at the first row.
        changes : sequence of (float, dict)
            Time [s], as in the rows, and what was set from then on.
        """
        paddle = self.paddle
        begin = rows["t"][0] if len(rows["t"]) else 0.0
        channels = {name: column for name, column in rows.items() if name not in ("t", "x", "v", "F")}
        limited = np.abs(rows["F"]) >= paddle.force_max if paddle.force_max is not None else None
        return Telemetry(
            t=rows["t"] - begin, x=rows["x"], v=rows["v"], F=rows["F"], T=paddle.T, delay=paddle.delay, channels=channels,
            sensor_delay=paddle.sensor_delay,
            units={**self.program.units, "intent": "m"}, paddle=str(paddle), scene=self.program.name, parameters=dict(values),
            fault=self.fault, saturated=limited, changes=tuple((t - begin, numbers) for t, numbers in changes),
        )  # fmt: skip

    def _take(self, numbers):
        self.program = replace(self.program, values=tuple((named_values(self.program) | numbers).values()))

    def _loop(self, held=None):
        held = self.held if held is None else held
        if held not in self._loops:
            paddle = self.paddle if held else replace(self.paddle, hand=None)
            self._loops[held] = _Loop(self.program, paddle, self._engine, self._begin)
        return self._loops[held]

    def _parameters(self, loop):
        known = self.program.values
        if self._heard:
            known = [self._heard.get(c.name, value) for c, value in zip(self.program.parameters, known, strict=True)]
        return *known, *loop.plant_values

    def _inputs(self, intent):
        """Return the linked program's inputs, in the order of SimulatedPaddle.inputs."""
        ticks, columns = len(intent) - 1, []
        plant = self._loop().plant
        if plant.ramp:
            columns += [intent[:-1]] if plant.spring else []
            columns.append((intent[1:] - intent[:-1]) / self.paddle.T)
        for (deviation, draw), there in zip(self._noise, (True, self.held), strict=True):
            if deviation and there:
                columns.append(deviation * draw.standard_normal(ticks))
        return np.array(columns).T if columns else np.zeros((ticks, 0))


class _Loop:
    """A scene's program linked to a paddle, ready to run."""

    def __init__(self, program, paddle, engine, begin):
        self.plant, self.linked, self.plant_values = paddle.plant, link(program, paddle), paddle.plant_values(*begin)
        self.loaded = load_linked(self.linked, engine)
        self.names = [c.name for c in self.linked.states]


def told(t):
    """Stand for an intent that is told as it goes."""
    raise PaddleError("the intent of this hand is set while it moves. For a separate run, give hl.Hand(..., intent=...) a path.")


def with_grip(paddle, intent=told):
    """Return a simulated paddle whose hand holds the handle by a spring, with an intent and without a push."""
    hand = paddle.hand
    if hand is None or hand.k == 0:
        hand = Hand(GRIP)
    return replace(paddle, hand=replace(hand, intent=intent, push=0.0))
