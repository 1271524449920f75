"""Close the loop: a scene's program inside a simulated paddle becomes one program.

Per tick: sense, run the scene, limit the force, apply it with its delay, advance the plant. The scene keeps its own
precision; everything around it is f64.
"""

import math
from dataclasses import replace

from ...compiler.engines.engine import load
from ...compiler.engines.table import ENGINES
from ...compiler.ir.cache import Shared, content, instructions
from ...compiler.ir.program import Channel, Program
from ...compiler.ir.trace import Builder, cast, equal, floor, select
from ...errors import PaddleError
from .motor import Motor, is_distorted
from .plant import NOWHERE
from .unused_states import drop_unused_states

#: closed loops that are kept, weighed as :data:`hapticlab.compiler.tick.compile_scene.PROGRAMS` are
LINKED = Shared(60_000, lambda program: 200 + program.size)
#: largest finite numbers: |a| <= LARGEST is false for nan and for both infinities
LARGEST = {"f32": 3.4028234663852886e38, "f64": 1.7976931348623157e308}


def link(program, paddle, measure=None):
    """Return the closed loop of a scene's program and a simulated paddle.

    Parameters
    ----------
    program : Program
        A scene's, f32 or f64; inputs x [m] and, where the paddle measures it, v [m/s]; first output F [N].
    paddle : SimulatedPaddle
    measure : object, optional
        ``outputs`` and ``states`` (tuples of Channel), ``init(sample) -> states`` and ``update(sample, states) ->
        (outputs, next_states)`` over traced values. Its outputs replace the traces, so that a sweep stores none.
        ``sample`` is a dict: ``x``, ``v`` as sensed, in the scene's real type; ``x_true``, ``v_true`` [f64] at the
        sample; ``tick`` (i32, 0 at the first sample); and in ``update``, not in ``init``, also ``F`` [N, f64] after
        saturation, ``F_applied`` [N, f64] the force felt from the switching instant in this period to that in the next,
        ``x_switch`` [m, f64] the handle at that instant, ``x_next``, ``v_next`` [f64] the handle at the next sample,
        ``fault`` (bool) and the watched channels by name.

    Returns
    -------
    Program
        Parameters: the scene's, then those of ``paddle.plant_values()``. Inputs: those of ``paddle.inputs(ticks)``.
        Outputs without measure: x, v, F (zero from a fault on), the watched channels, then x_true and v_true under an
        encoder, noise or a sensor that lags, F_applied under a whole sample of delay or a motor that gives another force,
        x_switch under a fraction of a sample, and fault: 0, or 1 where F is not finite, or 2 + the position of the state
        that is not. Until the first force arrives the motor gives none.

    Raises
    ------
    PaddleError
        If the program was compiled for another T or wants what the paddle does not sense.

    Examples
    --------
    >>> from hapticlab.compiler.tick.compile_scene import compile
    >>> from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle, link
    >>> from hapticlab.scene.scene import Scene
    >>> from hapticlab.scene.notation.symbols import n, parameters, x
    >>> k = parameters("k", units="N/m")
    >>> linked = link(compile(Scene(force=k * x(n)), T=1e-3), SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
    >>> [c.name for c in linked.outputs], [c.name for c in linked.parameters][:2]
    (['x', 'v', 'F', 'fault'], ['k', 'plant.phi_xv'])
    """
    paddle.accept(program)
    channels = program.inputs, program.parameters, program.states, program.outputs
    of_measure = content(measure)
    key = of_measure and (instructions(program), content(channels, program.T, paddle.structure), of_measure)
    return replace(
        LINKED.get(key, lambda: _linked(program, paddle, measure)),
        name=f"{program.name} on a simulated paddle",
        values=(*program.values, *paddle.plant_values()),
        facts={**program.facts, "paddle": "simulated"},
        notes=program.notes,
    )


def _linked(program, paddle, measure):
    """Return the closed loop of all paddles of one structure."""
    loop = _Loop(program, paddle, measure)
    init = loop.trace_init()
    tick = loop.trace_tick()
    linked = Program(
        name=program.name,
        inputs=loop.inputs,
        parameters=loop.parameters,
        states=tuple(loop.states.values()),
        outputs=loop.outputs,
        init=init,
        tick=tick,
        T=program.T,
        values=(math.nan,) * len(loop.parameters),
    )
    return drop_unused_states(linked).verify()


def load_linked(linked, engine):
    """Return a linked program ready to run; its plant is float64, which the firmware's machine does not take."""
    taken = ("auto", *(record.name for record in ENGINES.values() if record.float64))
    if engine not in taken:
        names = f"{', '.join(taken[:-1])} or {taken[-1]}"
        raise PaddleError(f"engine = {engine!r}; a simulated paddle, float64 inside, runs on {names}.")
    return load(linked, engine)


class _Loop:
    """The names and types around a scene's program, and the two blocks traced over them."""

    def __init__(self, program, paddle, measure):
        self.program, self.paddle, self.measure = program, paddle, measure
        self.plant = paddle.plant
        self.real = program.outputs[0].type
        self.encoder = paddle.counts_per_metre is not None
        self.noisy = paddle.noise > 0
        self.measured = paddle.velocity == "measured"
        self.distorted = is_distorted(paddle)
        ramp = (("intent", "m"),) * self.plant.spring + (("intent.rate", "m/s"),) if self.plant.ramp else ()
        names = ramp + (("noise", "m"),) * self.noisy + (("hand.push_noise", "N"),) * self.plant.shake
        self.inputs = tuple(Channel(name, unit, "f64") for name, unit in names)
        self.parameters = (*program.parameters, *self.plant.channels(), *self._device_parameters())
        self.states = {c.name: c for c in self._states()}
        self.outputs = ()

    def _device_parameters(self):
        if not self.measured:
            yield Channel("plant.rate", "1/s", self.real)
        if self.encoder:
            yield Channel("plant.counts_per_metre", "1/m", "f64")
            yield Channel("plant.metres_per_count", "m", self.real)
        if self.paddle.force_max is not None:
            yield Channel("plant.force_max", "N", "f64")
        if self.plant.readings:
            yield Channel("sensor.age", "s", "f64")
            yield Channel("sensor.T", "s", "f64")
        if self.distorted:
            yield Channel("motor.force_full", "N", "f64")
            yield from (Channel(f"motor.duty_{k}", "1", "f64") for k in (0, 25, 50, 75))
        yield Channel("start.x", "m", "f64")
        yield Channel("start.v", "m/s", "f64")

    def _states(self):
        yield from (replace(c, name=f"scene.{c.name}") for c in self.program.states)
        yield Channel("plant.x", "m", "f64")
        yield Channel("plant.v", "m/s", "f64")
        for k in range(self.plant.whole + self.plant.split):
            yield Channel(f"plant.F_{k + 1}", "N", "f64")
        yield from (Channel(f"sensor.x_{k + 1}", "m", "f64") for k in range(self.plant.readings))
        if not self.measured:
            yield Channel("sensed.x", "m", self.real)
        yield Channel("fault", "1", "f64")
        yield Channel("tick", "1", "i32")
        yield from (replace(c, name=f"measure.{c.name}") for c in (self.measure.states if self.measure else ()))

    def _leaves(self, builder, states):
        """Return parameters, inputs and states by name."""
        groups = {"param": self.parameters, "input": self.inputs, "state": self.states.values() if states else ()}
        return {op: {c.name: builder.leaf(op, k, c.type) for k, c in enumerate(group)} for op, group in groups.items()}

    def _sense(self, p, inputs, x, v, read, before):
        """The handle as the scene senses it: what the sensor read last, and the position sensed before, None at first."""
        if self.measured:
            return {"x": cast(x, self.real), "v": cast(v, self.real), "x_true": x, "v_true": v}
        seen = read + inputs["noise"] if self.noisy else read
        if self.encoder:
            counts = seen * p["plant.counts_per_metre"]
            counts = floor(counts if self.paddle.rounding == "floor" else counts + 0.5)
            seen = cast(counts, self.real) * p["plant.metres_per_count"]
        seen = cast(seen, self.real)
        moved = seen - (seen if before is None else before)
        return {"x": seen, "v": moved * p["plant.rate"], "x_true": x, "v_true": v}

    def _scene(self, builder, block, p, sample, states):
        return builder.inline(
            block,
            param=[p[c.name] for c in self.program.parameters],
            input=[sample[c.name] for c in self.program.inputs],
            state=states,
        )

    def trace_init(self):
        builder = Builder("f64")
        leaves = self._leaves(builder, states=False)
        p = leaves["param"]
        x, v = p["start.x"], p["start.v"]
        readings = [x - v * (p["sensor.age"] + k * p["sensor.T"]) for k in range(self.plant.readings)]
        sample = self._sense(p, leaves["input"], x, v, readings[-1] if readings else x, None)
        _, scene = self._scene(builder, self.program.init, p, sample, ())
        new = dict.fromkeys(self.states, builder.const(0.0, "f64"))
        new.update({f"scene.{c.name}": s for c, s in zip(self.program.states, scene, strict=True)})
        new.update({"plant.x": x, "plant.v": v, "tick": builder.const(0, "i32")})
        new.update({f"sensor.x_{k + 1}": reading for k, reading in enumerate(readings)})
        new["fault"] = _fault(new["fault"], scene, 1.0 + len(self.program.outputs))
        if "sensed.x" in new:
            new["sensed.x"] = sample["x"]
        if self.measure:
            first = self.measure.init({**sample, "tick": new["tick"]})
            new.update({f"measure.{c.name}": s for c, s in zip(self.measure.states, first, strict=True)})
        return builder.block(states=[new[name] for name in self.states])

    def trace_tick(self):
        builder = Builder("f64")
        leaves = self._leaves(builder, states=True)
        p, inputs, old = leaves["param"], leaves["input"], leaves["state"]
        read = [old[f"sensor.x_{k + 1}"] for k in range(self.plant.readings)]
        sample = self._sense(p, inputs, old["plant.x"], old["plant.v"], [old["plant.x"], *read][-1], old.get("sensed.x"))
        scene = [old[f"scene.{c.name}"] for c in self.program.states]
        outputs, scene = self._scene(builder, self.program.tick, p, sample, scene)
        watched = {c.name: o for c, o in zip(self.program.outputs[1:], outputs[1:], strict=True)}
        fault = _fault(old["fault"], [*outputs, *scene])
        F = self._limit(p, cast(outputs[0], "f64"))
        # Forces computed earlier and not yet felt, the newest first; a fault silences them all.
        past = [old[f"plant.F_{k + 1}"] for k in range(self.plant.whole + self.plant.split)]
        given = self._motor(p).force(F) if self.distorted else F
        forces = [select(equal(fault, 0.0), force, 0.0) for force in (given, *past)]
        applied, before = forces[self.plant.whole], past[-1] if self.plant.split else None
        hand = [inputs.get(name, 0.0) for name in ("intent", "intent.rate", "hand.push_noise")]
        x_seen, x_switch, x, v = self.plant.step(p, old["plant.x"], old["plant.v"], before, applied, *hand)
        new = {f"scene.{c.name}": s for c, s in zip(self.program.states, scene, strict=True)}
        new.update({f"plant.F_{k + 1}": forces[k] for k in range(len(past))})
        read.insert(0, old["plant.x"] if self.plant.seen == NOWHERE else x_seen)
        new.update({f"sensor.x_{k + 1}": read[k] for k in range(self.plant.readings)})
        new.update({"plant.x": x, "plant.v": v, "fault": fault, "sensed.x": sample["x"]})
        new["tick"] = builder.emit("iadd", old["tick"], builder.const(1, "i32"))
        sample.update(watched | {"F": F, "F_applied": applied, "x_switch": x_switch, "x_next": x, "v_next": v})
        sample.update(tick=old["tick"], fault=fault > 0.0)
        if self.measure:
            results, following = self.measure.update(sample, [old[f"measure.{c.name}"] for c in self.measure.states])
            new.update({f"measure.{c.name}": s for c, s in zip(self.measure.states, following, strict=True)})
            self.outputs = tuple(self.measure.outputs)
        else:
            self.outputs = tuple(self._output_channels())
            asked = select(equal(fault, 0.0), F, 0.0) if self.distorted else forces[0]
            shown = sample | {"F": asked, "fault": fault}  # none after a fault
            results = [shown[c.name] for c in self.outputs]
        return builder.block(results, [new[name] for name in self.states])

    def _motor(self, p):
        return Motor(p["motor.force_full"], [p[f"motor.duty_{k}"] for k in (0, 25, 50, 75)] + [1.0])

    def _limit(self, p, F):
        if self.paddle.force_max is None:
            return F
        limit = p["plant.force_max"]
        return select(F > limit, limit, select(F < -limit, -limit, F))  # in this order a nan stays a nan

    def _output_channels(self):
        yield Channel("x", "m", self.real)
        yield Channel("v", "m/s", self.real)
        yield Channel("F", "N", "f64")
        yield from (c for c in self.program.outputs[1:] if c.name not in ("x", "v", "F"))
        if not self.measured:
            yield Channel("x_true", "m", "f64")
            yield Channel("v_true", "m/s", "f64")
        if self.plant.whole or self.distorted:
            yield Channel("F_applied", "N", "f64")
        if self.plant.split:
            yield Channel("x_switch", "m", "f64")
        yield Channel("fault", "1", "f64")


def _fault(before, values, first=1.0):
    """Return the latched fault: 0, or the number of the first value that is not finite, counted from ``first`` on."""
    found = 0.0
    for position, value in reversed(list(enumerate(values))):
        if value.type in LARGEST:
            found = select(abs(value) <= LARGEST[value.type], found, first + position)
    if not hasattr(found, "type"):
        return before
    return select(before > 0.0, before, found)
