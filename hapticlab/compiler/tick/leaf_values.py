"""What the leaves of an expression stand for: at the first sample, in the init block, and at sample n, in the tick."""

from dataclasses import dataclass, field

import sympy as sp

from ...errors import ParameterError, SceneError
from ...scene.notation.symbols import Parameter, T, acceleration, delay, lag_of, n, t, v, x
from ...scene.notation.units import unit_of
from ..algebra.constants import entering
from ..algebra.expressions import Translator
from ..algebra.graph import Graph
from ..algebra.phase import Clock, counted, digit
from ..ir.channels import short
from ..ir.program import Channel
from ..ir.trace import cast
from .handle_samples import Handle
from .program_builder import Tracing

REAL_OF = {"float32": "f32", "float64": "f64"}
#: signals from which on they are resolved in the order written, and not each where it is first named
LONG_CHAIN = 50


@dataclass(frozen=True)
class Signals:
    """The difference equations of a scene, y(n) -> expression, and which of them were needed."""

    updates: dict
    resolved: set = field(default_factory=set)
    resolving: list = field(default_factory=list)

    def resolve(self, sample, translate):
        """y(n) by its difference equation; one that needs itself is refused."""
        if sample not in self.updates:
            raise SceneError(f"{sample} has no equation; add sp.Eq({sample}, ...) to eom")
        if sample in self.resolving:
            loop = " -> ".join(map(str, [*self.resolving, sample]))
            raise SceneError(f"{loop}: a sample cannot depend on itself; use {type(sample).__name__}(n-1) on one side")
        self.resolving.append(sample)
        self.resolved.add(sample)
        value = translate(self.updates[sample])
        self.resolving.pop()
        return value

    @property
    def unused(self):
        """The names of the samples that nothing asked for."""
        return [str(sample) for sample in self.updates if sample not in self.resolved]


@dataclass(frozen=True)
class Tick:
    """What the parts of one tick share while it is traced.

    Attributes
    ----------
    tracing : Tracing
    handle : Handle
    graph : Graph
        Of the scene's expressions.
    values : dict name -> float
        Of the parameters that are bound.
    fixed : dict name -> float
        The parameters that are constants of the program.
    signals : Signals
    """

    tracing: Tracing
    handle: Handle
    graph: Graph
    values: dict
    fixed: dict
    signals: Signals

    def known(self, builder, symbol):
        """A parameter or the period T, as a value of a builder; None for any other leaf."""
        if symbol == T:
            return builder.const(self.tracing.T)
        if isinstance(symbol, Parameter):
            if symbol.name in self.fixed:
                return builder.const(self.entering(symbol.name, self.fixed[symbol.name]))
            return self.tracing.parameter(builder, self.tracing.parameters.index(symbol))
        return None

    def translator(self, leaf, after=0.0, sample=None):
        """What translates expressions of the tick, ``after`` [s] after the sample; ``sample`` does so at the sample."""
        clock = Clock(lambda: counted(self.tracing), self.tracing.T, after)
        return Translator(self.tracing.tick, leaf, clock, self.values, self.graph, sample)

    def entering(self, name, value):
        """The value of a parameter, refused where the program's real type has no such number."""
        return entering(value, self.tracing.real, f"{name} = {value:g}", ParameterError)

    def check_values(self, program):
        """Refuse a bound value of a live parameter that the program's real type does not have."""
        for channel, value in zip(program.parameters, program.values, strict=True):
            if value == value:
                self.entering(channel.name, value)


def tick_of(source, handle=None):
    """The :class:`Tick` of a :class:`Source`, nothing traced yet; ``handle(tracing)`` may make another :class:`Handle`."""
    scene, options = source.scene, source.options
    real, T = REAL_OF[options.dtype], options.T
    for value, text in ((T, "T"), (1 / T, "1/T with T"), (T / options.substeps, "T/substeps with T")):
        entering(value, real, f"{text} = {T:g} s", ParameterError)
    tracing = Tracing(real, T, tuple(scene.parameters.values()))
    handle = handle(tracing) if handle else Handle(tracing, options.velocity, options.hold)
    return Tick(tracing, handle, source.graph, scene.values, source.fixed, Signals(source.form.updates))


def at_start(tick):
    """What translates expressions at the first sample."""
    init = tick.tracing.init

    def leaf(expr):
        known = tick.known(init, expr)
        if known is not None:
            return known
        kind = type(expr)
        if expr in (n, t):
            return init.const(0.0)
        if kind in (x, v):
            return tick.handle.first(kind)
        if kind is acceleration or getattr(kind, "role", "signal") not in ("coordinate", "signal"):
            return init.const(0.0)  # reactions and what impacts add up to: nothing has happened yet
        if isinstance(expr, delay):
            return translate(expr.args[0])
        if isinstance(expr, sp.Derivative):
            return translate(type(expr.expr).rate)
        if kind.role == "signal" and lag_of(expr) == 0:
            return tick.signals.resolve(expr, translate)
        return translate(getattr(kind, "initial", sp.S.Zero))

    translate = Translator(init, leaf, bound=tick.values, graph=tick.graph)
    return translate


def at_sample(tick, start, moving):
    """What translates expressions at sample n.

    Parameters
    ----------
    tick : Tick
    start : Translator
        That of :func:`at_start`, for what past samples were before the first.
    moving : callable (leaf, translate) -> Value
        What coordinates, their rates and reactions are at the sample.
    """
    tracing = tick.tracing

    def leaf(expr):
        known = tick.known(tracing.tick, expr)
        if known is not None:
            return known
        kind = type(expr)
        if expr in (n, t):  # whole ticks are counted: a float32 sum of periods is seconds wrong after minutes
            high, low = counted(tracing)
            count = high * digit(tracing.real) + low
            return count if expr == n else count * tracing.T
        if kind in (x, v):
            return tick.handle.sample(kind, lag_of(expr) or 0)
        if kind is acceleration:
            return tick.handle.acceleration()
        if isinstance(expr, delay):
            argument = expr.args[0]
            channel = Channel(short(expr), unit_of(argument), tracing.real)
            return tracing.state(expr, channel, start(argument), lambda: translate(argument))
        if isinstance(expr, sp.Derivative) or kind.role != "signal":
            return moving(expr, translate)
        lag = lag_of(expr)
        if lag == 0:
            return tick.signals.resolve(expr, translate)
        channel = Channel(str(expr), kind.unit, tracing.real)
        return tracing.state(expr, channel, start(kind.initial), lambda: translate(expr.func(n - lag + 1)))

    translate = tick.translator(leaf)
    return translate


def unknown_reaction(expr):
    """Refuse a reaction, or what impacts add up to, that no model of the scene has."""
    kind = type(expr)
    if hasattr(kind, "constraint"):
        raise SceneError(
            f"{expr} is the reaction of {kind.constraint} = 0; add this constraint to those of hl.mechanics.lagrange"
        )
    raise SceneError(
        f"{kind.contact} is used but belongs to no model. Write hl.mechanics.lagrange(..., contacts=[{kind.contact}])"
    )


def outputs_at_sample(scene, form, tracing, sample, force_now):
    """(F or None, the watched channels with their values) at sample n; F is None unless ``force_now``."""
    for y in form.updates if len(form.updates) > LONG_CHAIN else ():
        sample(y)  # one by one: resolved from the last, a chain of them is one deep expression
    force = real(scene, tracing, sample(form.force)) if force_now else None
    units = scene.watch_units if form.watch else {}
    watched = ((name, real(scene, tracing, sample(expr))) for name, expr in form.watch.items())
    return force, [(Channel(name, units[name], tracing.real), value) for name, value in watched]


def real(scene, tracing, value):
    """A traced number in the program's real type."""
    if value.type == "bool":
        raise SceneError(f"{scene.name}: a condition is not a number; write hl.when(condition, 1, 0)")
    return cast(value, tracing.real)
