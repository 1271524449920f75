"""A program being written: its two builders, its inputs and its states, pruned to what the outputs can see."""

from dataclasses import replace

from ...errors import ProgramLimitError
from ...scene.notation.symbols import v, x
from ..events.series_checks import numbers
from ..ir.program import Block, Channel, Program
from ..ir.trace import Builder

#: a delay of so many samples takes seconds to compile
MOST_STATES = 2000


class Tracing:
    """Collects the init and tick blocks of one program."""

    def __init__(self, real, T, parameters):
        self.real, self.T = real, T
        self.init, self.tick = Builder(real), Builder(real)
        self.parameters = parameters  # tuple of scene parameters, in order
        self.inputs = [Channel("x", "m", real), Channel("v", "m/s", real)]
        self._states = {}  # key -> [channel, first value, next value]
        self._numbers = {}  # key -> how many states came before it
        self._waiting = []  # (key, callable) of next values not traced yet

    def input(self, builder, signal):
        """The input x or v in one of the two builders."""
        return builder.leaf("input", (x, v).index(signal), self.real)

    def parameter(self, builder, index):
        """A live parameter in one of the two builders."""
        return builder.leaf("param", index, self.real)

    def state(self, key, channel, first, next=None):
        """The present value of a state, made on first use; ``next`` is a callable, or is set later."""
        if key not in self._states:
            if len(self._states) == MOST_STATES:
                raise ProgramLimitError(
                    f"more than {MOST_STATES} states, the last of them {channel.name}: a past sample is stored together "
                    "with all samples after it. Use fewer past samples, or a longer T"
                )
            self._numbers[key] = len(self._states)
            self._states[key] = [channel, first, None]
            if next is not None:
                self._waiting.append((key, next))
        return self.tick.leaf("state", self._numbers[key], self._states[key][0].type)

    @property
    def keys(self):
        """The keys of the states, in order."""
        return tuple(self._states)

    def set_next(self, key, value):
        """Give a state the value it has at the next tick."""
        self._states[key][2] = value

    def next_of(self, key):
        """The value that a state has at the next tick, once it is set."""
        return self._states[key][2]

    def at_start(self, values):
        """The values of the tick's leaves at the first sample, x = 0: dict (op, index) -> float; nan unbound."""
        given = {("param", k): values.get(p.name, float("nan")) for k, p in enumerate(self.parameters)}
        given |= {("input", k): 0.0 for k in range(len(self.inputs))}
        number = numbers(self.init.instructions, given)
        return given | {("state", k): number(first.id) for k, (_, first, _) in enumerate(self._states.values())}

    def complete(self):
        """Trace the next values still waiting, and those they ask for."""
        while self._waiting:
            key, next = self._waiting.pop()
            self._states[key][2] = next()

    def finish(self, name, outputs, values, facts, unused=()):
        """The program that computes ``outputs``: a list of (Channel, Value). All states must have a next value.

        States, inputs and parameters the outputs cannot see are dropped; the program's notes name the states, and
        beside them what was ``unused`` from the start.
        """
        states = list(self._states.values())
        alive = self._observed([value for _, value in outputs])
        dropped = [*unused, *(channel.name for k, (channel, _, _) in enumerate(states) if k not in alive)]
        alive = sorted(alive)
        tick = self.tick.block([value for _, value in outputs], [states[k][2] for k in alive])
        init = self.init.block((), [states[k][1] for k in alive])
        live = {i.index for block in (init, tick) for i in block.instructions if i.op == "param"}
        kept = [k for k in range(len(self.parameters)) if k in live]
        order = {"state": {k: new for new, k in enumerate(alive)}, "param": {k: new for new, k in enumerate(kept)}}
        last = max((i.index for block in (init, tick) for i in block.instructions if i.op == "input"), default=0)
        named = [self.parameters[k] for k in kept]
        notes = (f"left out, because no output depends on it: {', '.join(dropped)}",) if dropped else ()
        return Program(
            name=name,
            inputs=tuple(self.inputs[: last + 1]),
            parameters=tuple(Channel(p.name, p.unit, self.real, p.low, p.high) for p in named),
            states=tuple(states[k][0] for k in alive),
            outputs=tuple(channel for channel, _ in outputs),
            init=_renumbered(init, order),
            tick=_renumbered(tick, order),
            T=self.T,
            values=tuple(values.get(p.name, float("nan")) for p in named),
            facts=facts,
            notes=notes,
        ).verify()

    def observed(self, outputs):
        """The keys of the states the outputs depend on, now or at any later tick."""
        keys = list(self._states)
        return {keys[k] for k in self._observed(outputs)}

    def _observed(self, outputs):
        """The numbers of the states the outputs depend on, now or at any later tick."""
        nexts = [next for _, _, next in self._states.values()]
        alive, frontier, seen = set(), [o.id for o in outputs], set()
        while frontier:
            k = frontier.pop()
            if k in seen:
                continue
            seen.add(k)
            i = self.tick.instructions[k]
            frontier.extend(i.args)
            if i.op == "state" and i.index not in alive:
                alive.add(i.index)
                frontier.append(nexts[i.index].id)
        return alive


def _renumbered(block, order):
    def moved(i):
        return replace(i, index=order[i.op][i.index]) if i.op in order else i

    return Block(tuple(moved(i) for i in block.instructions), block.outputs, block.states)
