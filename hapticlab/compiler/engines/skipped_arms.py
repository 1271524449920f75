"""Which results only one arm of a select needs, and the order in which they can be skipped together.

Lazy evaluation of a straight-line list: a result that every use reaches through the arms of selects is needed only where
their conditions choose those arms. Evaluating conditions before arms is always possible, since no result needs itself;
the order found here keeps to it, and gathers what the same choices need.
"""

import functools
import heapq
from dataclasses import dataclass

from ..ir.operations import OPERATIONS
from ..ir.program import LEAVES

#: least work, in additions, of an arm that is worth a branch: what a branch foretold wrongly costs, on x86-64
WORTH = 24
#: most choices that one result waits for
DEEPEST = 40


@dataclass(frozen=True)
class Arm:
    """What is needed only where the result at position ``condition`` is ``chosen``: positions, and arms within."""

    condition: int
    chosen: bool
    items: tuple

    def positions(self):
        """Return every position in it."""
        return [k for item in self.items for k in (item.positions() if isinstance(item, Arm) else [item])]


def work(instruction):
    """Return about how long an instruction takes, in additions."""
    return 0 if instruction.op in LEAVES else OPERATIONS[instruction.op].work


def in_lazy_order(instructions, i):
    """Return the operands of an instruction: of two conditions first the one that is known earlier."""
    if i.op not in ("and", "or"):
        return i.args
    return sorted(i.args, key=lambda a: _plain(instructions, a, True)[0])


def _plain(instructions, condition, chosen):
    """Return the condition that others are the negations of, and what it is."""
    while instructions[condition].op == "not":
        condition, chosen = instructions[condition].args[0], not chosen
    return condition, chosen


class Demand:
    """What is needed under which choices: of each position a set of choices (bits), all of which must hold.

    Examples
    --------
    >>> from hapticlab.compiler.ir.trace import Builder, select, sin
    >>> b = Builder()
    >>> x = b.leaf("input", 0, "f64")
    >>> block = b.block([select(x < 0.0, x, sin(sin(x)))])
    >>> Demand(block).arranged(range(len(block.instructions)))
    [0, 1, 2, Arm(condition=2, chosen=False, items=(3, 4)), 5]
    """

    def __init__(self, block):
        self.instructions = block.instructions
        self._bits = {}  # of (condition, chosen)
        apart = {}
        while True:  # without a choice that must be made before it is known, all others are looked for again
            self.of = self._demanded(block, apart)
            self._forget_small()
            unknown = self._unknown()
            if not unknown:
                break
            apart |= {k: apart.get(k, 0) | bits for k, bits in unknown.items()}
        self._conditions = functools.cache(lambda needed: [self.choices[bit][0] for bit in _bits(needed)])

    def _unknown(self):
        """Return position -> those of its choices whose conditions are known only where more is chosen."""
        found = {}
        for k, needed in enumerate(self.of):
            for bit in _bits(needed or 0):
                if self.of[self.choices[bit][0]] & ~needed:
                    found[k] = found.get(k, 0) | 1 << bit
        return found

    def _demanded(self, block, apart):
        """Return the choices that every use of each position makes; None where there is no use."""
        of = [None] * len(block.instructions)
        for k in (*block.outputs, *block.states):
            of[k] = 0
        for k in reversed(range(len(of))):
            if of[k] is None:
                continue
            of[k] &= ~apart.get(k, 0)
            i = block.instructions[k]
            first, *rest = in_lazy_order(block.instructions, i) or [None]
            if first is not None:
                of[first] = of[k] if of[first] is None else of[first] & of[k]
            chosen = {"select": (True, False), "and": (True,), "or": (False,)}.get(i.op)
            for place, a in enumerate(rest):
                needed = of[k]
                if chosen and needed.bit_count() < DEEPEST:
                    needed |= self._choosing(first, chosen[place])
                of[a] = needed if of[a] is None else of[a] & needed
        self.choices = list(self._bits)
        return of

    def _choosing(self, condition, chosen, deep=4):
        """Return the bit of a choice, and of those that it implies: both of ``a and b`` hold where it does."""
        condition, chosen = _plain(self.instructions, condition, chosen)
        bits = 1 << self._bits.setdefault((condition, chosen), len(self._bits))
        if deep and self.instructions[condition].op == ("and" if chosen else "or"):
            for a in self.instructions[condition].args:
                bits |= self._choosing(a, chosen, deep - 1)
        return bits

    def _forget_small(self):
        """Drop the choices that would skip too little."""
        skipped, much = [0] * len(self.choices), {}
        for needed, i in zip(self.of, self.instructions, strict=True):
            much[needed] = much.get(needed, 0) + work(i)
        for needed, its in much.items():
            for bit in _bits(needed or 0):
                skipped[bit] += its
        kept = sum(1 << bit for bit, total in enumerate(skipped) if total >= WORTH)
        self.of = [needed and needed & kept for needed in self.of]

    def before(self, k):
        """The positions that must be known before k: its operands, and the conditions of its choices."""
        return (*self.instructions[k].args, *self._conditions(self.of[k]))

    def arranged(self, positions):
        """Return the positions among these that are of use, in an order to compute them: positions, and arms.

        What they need is among them or known already.
        """
        positions = [k for k in positions if self.of[k] is not None]
        if not any(self.of[k] for k in positions):
            return positions
        return _Order(self, positions).gathered(0)


class _Order:
    """Positions being put in order: those that all they need comes before are ready."""

    def __init__(self, demand, positions):
        self.demand = demand
        left = set(positions)
        self.waits, self.then, self.ready = {}, {}, {}
        self.left = dict.fromkeys((demand.of[k] for k in positions), 0)  #: work by choices needed
        for k in positions:
            before = left.intersection(demand.before(k))
            self.waits[k] = len(before)
            for a in before:
                self.then.setdefault(a, []).append(k)
            self.left[demand.of[k]] += work(demand.instructions[k])
        for k in positions:
            if not self.waits[k]:
                self._queue(k)

    def _queue(self, k):
        heapq.heappush(self.ready.setdefault(self.demand.of[k], []), k)

    def gathered(self, choices):
        """Return all that can be computed next where these choices are made."""
        items = []
        while True:
            while choices in self.ready:
                items.append(self._taken(choices))
            bit = self._next_choice(choices)
            if bit is None:
                return items
            arm = Arm(*self.demand.choices[bit], tuple(self.gathered(choices | 1 << bit)))
            worth = sum(work(self.demand.instructions[k]) for k in arm.positions()) >= WORTH
            items += [arm] if worth else arm.items

    def _taken(self, choices):
        """Take the first of those that are ready and need exactly these choices."""
        k = heapq.heappop(self.ready[choices])
        if not self.ready[choices]:
            del self.ready[choices]
        for later in self.then.get(k, ()):
            self.waits[later] -= 1
            if not self.waits[later]:
                self._queue(later)
        self.left[choices] -= work(self.demand.instructions[k])
        return k

    def _next_choice(self, choices):
        """Return the choice, known under these, that skips most of what is ready under more choices; None if none is."""
        found = 0
        for needed in self.ready:
            if needed & choices == choices:
                found |= needed & ~choices
        known = [bit for bit in _bits(found) if not self.demand.of[self.demand.choices[bit][0]] & ~choices]
        return max(known, key=lambda bit: (self._skips(bit), bit), default=None)

    def _skips(self, bit):
        return sum(much for needed, much in self.left.items() if needed >> bit & 1)


def _bits(number):
    """Yield the places of the ones of a number."""
    while number:
        lowest = number & -number
        yield lowest.bit_length() - 1
        number ^= lowest


def needs_parameters_alone(block):
    """Return the positions that are the same in every tick."""
    same = set()
    for k, i in enumerate(block.instructions):
        if i.op in ("const", "param") or (i.args and same.issuperset(i.args)):
            same.add(k)
    return same
