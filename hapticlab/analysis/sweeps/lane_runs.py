"""One scene on many paddles at once, a lane each; machine code is kept, and a second map takes the runs alone."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from ...compiler.ir.trace import equal, maximum, minimum, select
from ...device.simulated.closed_loop import link, load_linked
from ...device.simulated.lanes import device_values, together
from ...device.simulated.plant import decided
from ...errors import AnalysisError
from ..records.chatter import SHORTEST
from .sweep_measures import WithFault, f64, lasting, moves
from .workers import number_of, spread

#: lanes of one call of an engine: few enough for every worker to get some
LANES = 1024
#: of a paddle, what lanes may differ in
COLUMNS = ("m", "b", "T", "delay", "counts_per_metre", "coulomb", "force_max", "sensor_delay", "hand.m", "hand.b")
#: what the measure forgets between the parts of a run
AFRESH = {"measure.largest": 0.0, "measure.least": 1e300}


class LaneRuns:
    """A scene, and the machine code of it on every structure of paddle that was met; see :meth:`chatter`.

    Parameters
    ----------
    scene : Scene
        What the lanes do not give is bound.
    duration : float
        Of a run [s].
    workers : int
    engine : {"auto", "llvm", "wasm", "interpreter"}
    """

    def __init__(self, scene, duration, workers=-1, engine="auto"):
        self.scene, self.duration, self.workers, self.engine = scene, duration, number_of(workers), engine
        self._loaded, self._made = {}, {}

    def chatter(self, paddle, columns, start=(0.0, 0.1)):
        """Return the lasting amplitude and the last swings' [m], and where the program faulted.

        Parameters
        ----------
        paddle : SimulatedPaddle
            What no column says.
        columns : dict of str to array of shape (L,)
            Of the paddle, COLUMNS; and of the scene, its parameters; in SI.
        start : (float, float)
            Position [m] and velocity [m/s] at the first sample.

        Returns
        -------
        amplitude : array of shape (L,)
            Sustained or growing; 0 also where it shrinks, however slowly; nan where the run cannot tell.
        last : array of shape (L,)
            Half the largest swing of the last quarter, lasting or not; 0 within one encoder count and within rounding.
        fault : array of shape (L,)
        """
        columns = {name: np.asarray(a, float) for name, a in columns.items()}
        lanes = len(next(iter(columns.values())))
        columns |= {"start.x": np.full(lanes, float(start[0])), "start.v": np.full(lanes, float(start[1]))}
        ticks = np.floor(self.duration / columns.get("T", np.full(lanes, paddle.T)) + 0.5).astype(int)
        if ticks.min() < SHORTEST:
            longest = self.duration / ticks.min() if ticks.min() else math.inf
            raise AnalysisError(
                f"duration = {self.duration:g} s is {ticks.min()} samples of T = {longest:g} s; needs at least {SHORTEST}"
            )
        columns = _in_one_period(paddle, columns) | {"ticks": ticks}
        amplitude, last, fault = np.full(lanes, np.nan), np.zeros(lanes), np.zeros(lanes, bool)
        pieces = [piece for group in _groups(paddle, columns, lanes) for piece in self._pieces(paddle, columns, group)]
        for where, found, swing, failed in spread(self._run, pieces, self.workers):
            amplitude[where], last[where], fault[where] = found, swing, failed
        return amplitude, last, fault

    def _pieces(self, paddle, columns, group):
        """Yield what a worker needs for some lanes of one structure."""
        group = group[np.argsort(columns["ticks"][group], kind="stable")]  # lanes of one call take as many
        here = {name: a[group] for name, a in columns.items()}
        one = _paddle(paddle, here)
        ready = self._ready(one)
        program = ready[0]
        rows = np.repeat(np.array(program.values, float)[:, None], len(group), axis=1)
        plant = device_values(_together(one, here, one.plant))
        rows[len(rows) - 2 - len(plant) :] = [np.broadcast_to(a, len(group)) for a in (*plant, here["start.x"], here["start.v"])]
        for row, channel in enumerate(program.parameters):
            if channel.name in here:
                rows[row] = here[channel.name]
        count = np.broadcast_to(1 / np.asarray(here.get("counts_per_metre", one.counts_per_metre or np.inf)), len(group))
        for at in range(0, len(group), LANES):
            part = slice(at, at + LANES)
            ticks = int(here["ticks"][part].max())
            yield group[part], ready, rows[:, part], count[part], ticks, self._inputs(one, ticks)

    def _run(self, piece):
        """Run some lanes in three parts, so that the measure starts afresh at the third and the last quarter."""
        where, (linked, loaded), rows, count, ticks, inputs = piece
        quarter = ticks // 4
        fresh = [k for k, c in enumerate(linked.states) if c.name in AFRESH]
        at, states, found = 0, None, []
        for part in (ticks - 2 * quarter + 1, quarter, quarter - 1):  # a turn is seen at the sample after it
            outputs, states = loaded.run(part, inputs[at : at + part], rows, states, every=part)
            states[fresh] = [[AFRESH[linked.states[k].name]] for k in fresh]
            found.append(outputs[-1])
            at += part
        before, (largest, _, turns, heading, v, fault) = found[1], found[2]
        numbers = before[0], before[1], largest, turns, heading, v
        value = lasting(numbers, count=count, quarter=quarter * linked.T)
        return where, value, np.where(moves(largest, count), largest / 2, 0.0), fault > 0

    def _ready(self, paddle):
        """Return the linked program of a structure of paddle, and the engine that runs it."""
        key = paddle.T, paddle.structure
        if key not in self._loaded:
            linked = link(paddle.program(self.scene), paddle, WithFault(Swings(paddle.T)))
            self._loaded[key] = linked, load_linked(linked, self.engine)
        return self._loaded[key]

    def _inputs(self, paddle, ticks):
        """Return the hand's path and the noise, or what no program looks at; made once."""
        key = ticks, (paddle.hand, paddle.seed, paddle.noise, paddle.T) if _has_inputs(paddle) else None
        if key not in self._made:
            self._made = {key: paddle.inputs(ticks)}
        return self._made[key]


class Swings:
    """The swings of the handle since the measure began afresh, each from one turning point to the next.

    Between samples a handle under a held force turns on a parabola, as in
    :class:`hapticlab.analysis.sweeps.sweep_measures.Swing`, whose quarters of a run are instructions; here they are
    not, and one program serves every length of run.
    """

    states = f64(("x", "m"), ("v", "m/s"), ("heading", "m/s"), ("anchor", "m"), ("turns", "1"), ("largest", "m"), ("least", "m"))
    outputs = f64(("largest", "m"), ("least", "m"), ("turns", "1"), ("heading", "m/s"), ("v", "m/s"))

    def __init__(self, T):
        self.T = T

    def init(self, sample):
        x = sample["x_true"]
        zero = x.builder.const(0.0, "f64")
        return [x, zero, zero, x, zero, zero, zero + 1e300]

    def update(self, sample, states):
        x_prev, v_prev, heading, anchor, turns, largest, least = states
        x, v = sample["x_true"], sample["v_true"]
        turned = heading * v < 0.0
        extreme = x_prev + v_prev * v_prev * (self.T / 2) / select(turned, v_prev - v, 1.0)
        swing = abs(extreme - anchor)
        counts = turned & (turns > 0.0)  # the way from the start to the first turning point is no swing
        largest, least = select(counts, maximum(swing, largest), largest), select(counts, minimum(swing, least), least)
        anchor, turns = select(turned, extreme, anchor), select(turned, turns + 1.0, turns)
        heading = select(equal(v, 0.0), heading, v)
        return [largest, least, turns, heading, v], [x, v, heading, anchor, turns, largest, least]


def _has_inputs(paddle):
    return paddle.noise > 0 or (paddle.hand is not None and (paddle.hand.moves or paddle.hand.push_noise > 0))


def _in_one_period(paddle, columns):
    """Return columns in which every lane has the paddle's period, by similarity.

    With time in units of T/T0, masses are (T0/T)^2 of what they were, dampers and delays T0/T, velocities T/T0; forces,
    stiffnesses, lengths and so the samples are the same, one by one.
    """
    if "T" not in columns:
        return columns
    if np.ptp(columns["T"]) == 0 and columns["T"][0] == paddle.T:
        return {name: a for name, a in columns.items() if name != "T"}
    if _has_inputs(paddle):
        raise AnalysisError(
            "T is an axis, and the hand moves or there is noise, so its samples differ from one T to the next. Use a "
            "resting hand without noise, or hl.sweep"
        )
    ratio = paddle.T / columns["T"]
    new = {name: a for name, a in columns.items() if name != "T"}
    powers = {"m": 2, "b": 1, "delay": 1, "sensor_delay": 1, "B": 1, "start.v": -1}
    powers |= {"hand.m": 2, "hand.b": 1} if paddle.hand else {}
    for name, power in powers.items():
        owner = paddle.hand if name.startswith("hand.") else paddle
        own = getattr(owner, name.removeprefix("hand."), 0.0)
        new[name] = columns.get(name, own) * ratio**power
    return new


def _groups(paddle, columns, lanes):
    """Return the lanes of each structure of paddle."""
    parts = [np.asarray(a, float) for a in decided(_together(paddle, columns))]
    if all(np.ptp(a) == 0 for a in parts):
        return [np.arange(lanes)]
    parts = np.array([np.broadcast_to(a, lanes) for a in parts])
    _, group = np.unique(parts, axis=1, return_inverse=True)
    return [np.flatnonzero(group.ravel() == number) for number in range(group.max() + 1)]


def _together(paddle, columns, plant=None):
    """Return a paddle, and a hand, with arrays for the numbers of their columns."""
    own = {name: a for name, a in columns.items() if name in COLUMNS and "." not in name}
    hand = {name.removeprefix("hand."): a for name, a in columns.items() if name.startswith("hand.")}
    if hand:
        every = ("m", "b", "k", "push", "intent", "push_noise", "moves")
        own["hand"] = SimpleNamespace(**{name: getattr(paddle.hand, name) for name in every} | hand)
    return together(paddle, own, plant)


def _paddle(paddle, columns):
    """Return the paddle of the first lane."""
    own = {name: float(a[0]) for name, a in columns.items() if name in COLUMNS and "." not in name}
    hand = {name.removeprefix("hand."): float(a[0]) for name, a in columns.items() if name.startswith("hand.")}
    return replace(paddle, **own, **({"hand": replace(paddle.hand, **hand)} if hand else {}))
