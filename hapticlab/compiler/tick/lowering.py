"""A scene on its way to a program: what its leaves stand for at the first sample and at every other, and the tick traced."""

from dataclasses import replace

import sympy as sp

from ...errors import ParameterError, SceneError
from ...scene.notation.symbols import Parameter, T, acceleration, delay, lag_of, n, t, v, x
from ...scene.notation.units import unit_of
from ..algebra.constants import entering
from ..algebra.expressions import Translator
from ..algebra.graph import Graph
from ..algebra.phase import Clock, counted, digit
from ..contacts.constant_checks import bounded, limits
from ..contacts.contact_steps import limited
from ..contacts.coordinate_bounds import guarded, notes_of
from ..ir.channels import channel_of, short
from ..ir.program import Channel
from ..ir.trace import cast
from ..methods.exact_linear import EXACT, exact_or_switched
from ..methods.force_timing import IMPULSE, at_the_end, averaged, hints
from ..prune.constraint_lengths import notes_on
from ..prune.excluded_modes import folded, within
from .dynamics import Dynamics
from .handle_samples import Handle
from .live_limits import kept_stable
from .program_builder import Tracing

REAL_OF = {"float32": "f32", "float64": "f64"}
#: signals from which on they are resolved in the order written, and not each where it is first named
LONG_CHAIN = 50


class Lowering:
    """One scene on its way to a program.

    Arguments as :func:`~hapticlab.compiler.tick.compile_scene.compile` has checked them; ``form`` is what declared
    ranges left of it.
    """

    def __init__(self, scene, form, exact, method, T, substeps, hold, dtype, velocity, live, force_at):
        self.scene, self.form, self.exact = scene, form, None
        self.method, self.substeps = method, substeps
        names = "+".join([EXACT] * exact + ([method.name] if method else []))
        self.facts = {"method": names, "substeps": substeps, "hold": hold, "velocity": velocity, "dtype": dtype}
        parameters = tuple(scene.parameters.values())
        self.tracing = Tracing(REAL_OF[dtype], T, parameters)
        for value, text in ((T, "T"), (1 / T, "1/T with T"), (T / substeps, "T/substeps with T")):
            entering(value, REAL_OF[dtype], f"{text} = {T:g} s", ParameterError)
        self.handle = Handle(self.tracing, velocity, hold)
        self.folded = folded(scene, live)
        self.limits = limits(form, scene.values, self.folded, T)
        self.graph = Graph(self.folded)
        self.force_at, self.moved = force_at, {}
        if force_at == "mean":
            self.form = form = averaged(form, self.graph)
        if not form.coordinates:
            self.facts = {"velocity": velocity, "dtype": dtype}
        elif force_at != "before":
            self.facts["force_at"] = force_at
        self.hints = tuple(hints(self, hold))
        self.at_start = Translator(self.tracing.init, self._leaf_at_start, bound=scene.values, graph=self.graph)
        self.at_sample = self.translator(self._leaf_at_sample)
        self.resolving, self.resolved = [], set()
        if exact and form.coordinates:
            self.exact, method = exact_or_switched(self, form, method)
            self.form = self.exact.others if self.exact else form
        self.dynamics = Dynamics(self, self.form, method, substeps)

    def program(self, ranges):
        """Trace the tick in the order it runs; outside of ``ranges``, of coordinates, the force is no number."""
        real = self.tracing.real
        before = self.force_at == "before"
        for sample in self.form.updates if len(self.form.updates) > LONG_CHAIN else ():
            self.at_sample(sample)  # one by one: resolved from the last, a chain of them is one deep expression
        force = self.at_sample(self.form.force) if before else None
        units, outputs = self.scene.watch_units, []
        for name, expr in self.form.watch.items():
            outputs.append((Channel(name, units[name], real), self._real(self.at_sample(expr))))
        unlocated = self._advance()
        force = force if before else at_the_end(self)(self.form.force)
        outputs.insert(0, (Channel("F", "N", real), within(self._real(force), ranges, self.at_sample)))
        if unlocated is not None:
            outputs.append((Channel("unlocated", "1", real), unlocated))
        self.tracing.complete()
        outputs, ranges = guarded(self, outputs, ranges)
        unused = [str(sample) for sample in self.form.updates if sample not in self.resolved]
        unused += self.exact.left_out if self.exact else ()
        program = self.tracing.finish(self.scene.name, outputs, self.scene.values, self.facts, unused)
        program = limited(program, self.dynamics.largest)
        program = kept_stable(bounded(program, self.limits), self)
        for channel, value in zip(program.parameters, program.values, strict=True):
            if value == value:
                self._entering(channel.name, value)
        exact = self.exact.notes if self.exact else ()
        lengths = (*self.hints, *notes_on(self.scene, self.folded))
        return replace(program, notes=(*program.notes, *exact, *self.dynamics.notes, *lengths, *notes_of(ranges)))

    def translator(self, leaf, after=0.0):
        """Return what translates expressions of the tick, ``after`` [s] after the sample."""
        clock = Clock(lambda: counted(self.tracing), self.tracing.T, after)
        at_sample = getattr(self, "at_sample", None)  # the first that is made
        return Translator(self.tracing.tick, leaf, clock, self.scene.values, self.graph, at_sample)

    def _entering(self, name, value):
        return entering(value, self.tracing.real, f"{name} = {value:g}", ParameterError)

    def _real(self, value):
        if value.type == "bool":
            raise SceneError(f"{self.scene.name}: a condition is not a number; write hl.when(condition, 1, 0)")
        return cast(value, self.tracing.real)

    # what the leaves of an expression stand for, at the first sample, at sample n, and inside a step

    def _common(self, builder, symbol):
        """Return a parameter, T, or None."""
        if symbol == T:
            return builder.const(self.tracing.T)
        if isinstance(symbol, Parameter):
            if symbol.name in self.folded:
                return builder.const(self._entering(symbol.name, self.folded[symbol.name]))
            return self.tracing.parameter(builder, self.tracing.parameters.index(symbol))
        return None

    def _leaf_at_start(self, leaf):
        common = self._common(self.tracing.init, leaf)
        if common is not None:
            return common
        kind = type(leaf)
        if leaf in (n, t):
            return self.tracing.init.const(0.0)
        if kind in (x, v):
            return self.handle.first(kind)
        if kind is acceleration or getattr(kind, "role", "signal") not in ("coordinate", "signal"):
            return self.tracing.init.const(0.0)  # reactions and what impacts add up to: nothing has happened yet
        if isinstance(leaf, delay):
            return self.at_start(leaf.args[0])
        if isinstance(leaf, sp.Derivative):
            return self.at_start(type(leaf.expr).rate)
        if kind.role == "signal" and lag_of(leaf) == 0:
            return self._resolve(leaf, self.at_start)
        # the handle's acceleration, reactions and what impacts add up to start at zero
        return self.at_start(getattr(kind, "initial", sp.S.Zero))

    def _leaf_at_sample(self, leaf):
        common = self._common(self.tracing.tick, leaf)
        if common is not None:
            return common
        tracing, kind = self.tracing, type(leaf)
        if leaf in (n, t):
            count = self._ticks()
            return count if leaf == n else count * tracing.T
        if kind in (x, v):
            return self.handle.sample(kind, lag_of(leaf) or 0)
        if kind is acceleration:
            return self.handle.acceleration()
        if isinstance(leaf, delay):
            argument = leaf.args[0]
            channel = Channel(short(leaf), unit_of(argument), tracing.real)
            return tracing.state(leaf, channel, self.at_start(argument), lambda: self.at_sample(argument))
        if isinstance(leaf, sp.Derivative) or kind.role == "coordinate":
            return self._coordinate_state(leaf)
        if kind.role != "signal":
            return self.dynamics.leaf_at_sample(leaf)
        lag = lag_of(leaf)
        if lag == 0:
            return self._resolve(leaf, self.at_sample)
        channel = Channel(str(leaf), kind.unit, tracing.real)
        return tracing.state(leaf, channel, self.at_start(kind.initial), lambda: self.at_sample(leaf.func(n - lag + 1)))

    def _resolve(self, sample, translate):
        """Return y(n) by its difference equation; refuse one that needs itself."""
        if sample not in self.form.updates:
            raise SceneError(f"{sample} has no equation; add sp.Eq({sample}, ...) to eom")
        if sample in self.resolving:
            loop = " -> ".join(map(str, [*self.resolving, sample]))
            raise SceneError(f"{loop}: a sample cannot depend on itself; use {type(sample).__name__}(n-1) on one side")
        self.resolving.append(sample)
        self.resolved.add(sample)
        value = translate(self.form.updates[sample])
        self.resolving.pop()
        return value

    def _ticks(self):
        # time is counted in whole ticks: a float32 sum of periods is seconds wrong after minutes
        high, low = counted(self.tracing)
        return high * digit(self.tracing.real) + low

    def _coordinate_state(self, leaf):
        """Return q or q' as it is at the sample."""
        if self.exact and leaf in self.exact.states:
            return self.exact.state(leaf)
        follows = self.dynamics.leaf_at_sample(leaf) if leaf not in self.dynamics.states else None
        if follows is not None:
            return follows
        q, order = (leaf.expr, leaf.derivative_count) if isinstance(leaf, sp.Derivative) else (leaf, 0)
        if order >= self.form.orders[self.form.coordinates.index(q)]:
            raise SceneError(
                f"{leaf} is what the equations of motion solve for; the force and what is watched may use "
                f"{type(q).__name__} and lower derivatives"
            )
        return self.state(leaf)

    def state(self, leaf):
        """Return a state of the equations of motion as it is at the sample."""
        if leaf == IMPULSE:
            return self.tracing.tick.const(0.0)
        return self.tracing.state(leaf, channel_of(leaf, self.tracing.real), self.first_of(leaf))

    def first_of(self, state):
        """Return q or q' at the first sample."""
        return self.at_start(type(state.expr).rate if isinstance(state, sp.Derivative) else type(state).initial)

    # one period of the equations of motion

    def _advance(self):
        if self.exact:
            self.moved |= self.exact.advance()
        values, facts, unlocated = self.dynamics.advance()
        self.facts |= facts
        moved = dict(zip(self.dynamics.states, values, strict=True))
        self.moved |= moved
        for state, value in moved.items():
            if state != IMPULSE:
                self.tracing.set_next(state, value)
        return unlocated
