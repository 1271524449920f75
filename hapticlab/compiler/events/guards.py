"""Make the comparisons of a motion constant over a piece of it: each becomes a mode, and a guard that says when it ends.

What depends on the state by a case (``when``, Max, Min, Abs, sign, floor) is smooth between the crossings of its
surfaces. :func:`freeze` replaces every comparison by a leaf that the stepper sets. Where the case jumps and its surface
is a velocity (Coulomb friction, F sign(v)), neither case may hold: the motion slides along the surface, with the mixture
of both that keeps it there (Filippov, *Differential Equations with Discontinuous Righthand Sides*, 1988).
"""

from dataclasses import dataclass, field, replace

from ..ir.trace import Value, reachable, select


class Leaves:
    """Makes leaves that stand for what a stepper knows only inside a step; none of them enters a program."""

    def __init__(self, builder):
        self.builder, self.made = builder, 1 << 20

    def __call__(self, type=None):
        """A leaf that no other is equal to."""
        # past every real input, and past the leaves that an earlier motion made in the same builder
        self.made += 1
        return self.builder.leaf("input", self.made + (len(self.builder.instructions) << 24), type or self.builder.real)


@dataclass(frozen=True, eq=False)
class Guard:
    """A surface of the motion. ``kind`` says which mode its leaf holds.

    ``"side"``: a bool, first < second. ``"floor"``: the whole number below ``first``. In modes listed in ``idle``, as
    (leaf, value), the motion does not depend on it.
    """

    kind: str
    first: Value
    second: Value
    leaf: Value
    strict: bool = True
    idle: tuple = ()

    @property
    def measure(self):
        """What is zero on the surface: first - second, or the distance from the middle of two whole numbers."""
        return self.first - self.leaf - 0.5 if self.kind == "floor" else self.first - self.second


@dataclass(frozen=True, eq=False)
class Reaction:
    """An unknown of the motion: free, it is what ``free`` says; held, it is what keeps ``measure`` where it is.

    Attributes
    ----------
    leaf : Value
        Stands for the unknown in the accelerations, which depend on it linearly.
    measure : Value
        Gap of a contact (level 2) or slip of a friction (level 1); its derivative of that order vanishes while held.
    level : int
    free : Value
    inside : Value
        Not negative while it may be held: the reaction itself, or what is left of the friction cone.
    lean : Value, optional
        Positive where a slip that is let go becomes positive.
    side : Value, optional
        Bool leaf: the slip is positive.
    """

    leaf: Value
    measure: Value
    level: int
    free: Value
    inside: Value
    lean: Value | None = None
    side: Value | None = None


def coulomb(new, slip, F_c, F_s, leaf):
    """The Reaction of a Coulomb friction that is F_c against the slip, or up to F_s while it sticks."""
    side = new("bool")
    # what is left of the cone as a product: its zeros are a polynomial's, while F_s - |leaf| would be one more case
    return Reaction(leaf, slip, 1, select(side, F_c, -F_c), (F_s - leaf) * (F_s + leaf), leaf, side)


def contact(gap, leaf):
    """The Reaction of a contact: zero apart, what keeps the gap closed at rest."""
    return Reaction(leaf, gap, 2, leaf.builder.const(0.0, leaf.type), leaf)


@dataclass
class _Surface:
    """What the walk over the graph finds out about one surface before it is replaced."""

    op: str
    args: tuple
    cases: list = field(default_factory=list)
    in_logic: bool = False


def freeze(builder, targets, moving, rates, new, where=None):
    """(targets, guards, reactions) with every comparison of what moves replaced by a leaf.

    Parameters
    ----------
    builder : Builder
    targets : list of Value
        Accelerations and whatever else is followed over the step.
    moving : iterable of Value
        Leaves that change over the step.
    rates : iterable of Value
        Those whose derivatives the targets are: a surface of them can be slid along.
    new : Leaves
    where : list of Value, optional
        Those of the targets whose comparisons are replaced, wherever they come again; any other stays a comparison.
    """
    frozen = _Freezing(builder, targets, {m.id for m in moving}, {r.id for r in rates}, new, where or targets)
    if not frozen.surfaces:
        return list(targets), [], []
    for p in frozen.order:
        frozen.rewritten(p, frozenset())
    done = [frozen.rewritten(target.id, frozenset()) for target in targets]
    return done, frozen.guards, frozen.reactions


def hidden(guards, reactions, targets):
    """The guards, each with the (leaf, value) of others that hide it: a wall that only pushes, while it is not touched."""
    parts = [part for g in guards for part in (g.first, g.second)]
    parts += [part for r in reactions for part in (r.measure, r.free, r.inside)]
    idle = {g: [] for g in guards}
    for g in guards:
        for value in (False, True) if g.kind == "side" else ():
            reached = _reached_in(g.leaf.builder.instructions, [v.id for v in (*targets, *parts)], g.leaf, value)
            for other in guards:  # none is among the parts of its own surface
                if other is not g and other.leaf.id not in reached:
                    idle[other].append((g.leaf, value))
    return [replace(g, idle=tuple(cases)) for g, cases in idle.items()]


def _reached_in(instructions, positions, leaf, value):
    """The positions that others depend on where a bool leaf has a value."""
    reached, stack = set(), list(positions)
    while stack:
        p = stack.pop()
        if p in reached:
            continue
        reached.add(p)
        i = instructions[p]
        condition, holds = (i.args[0], value) if i.op == "select" else (None, value)
        if condition is not None and instructions[condition].op == "not":
            condition, holds = instructions[condition].args[0], not value
        stack.extend([i.args[1 if holds else 2]] if condition == leaf.id else i.args)
    return reached


class _Freezing:
    def __init__(self, builder, targets, moving, rates, new, where):
        self.builder, self.instructions, self.new = builder, builder.instructions, new
        self.order = reachable(self.instructions, [t.id for t in targets], builder.implied)
        self.moves, self.of_rates = self._reached(moving), self._reached(rates)
        self.guards, self.reactions, self.leaves, self.known = [], [], {}, {}
        self.zero = builder.const(0.0).id
        self.surfaces = None  # while they are looked for, every comparison is one
        self.surfaces = self._surfaces(reachable(self.instructions, [t.id for t in where], builder.implied))

    def _reached(self, leaves):
        reached = set(leaves)
        for p in self.order:
            if not reached.isdisjoint(self.instructions[p].args):
                reached.add(p)
        return reached

    def _told(self, p):
        """The instruction at p, or of what it and an implied condition hold together."""
        i = self.instructions[p]
        others = [a for a in i.args if a not in self.builder.implied]
        return self._told(others[0]) if i.op == "and" and len(others) == 1 else i

    def _surface_of(self, p):
        """(key, sense) of the comparison at p: True for first < second, or (None, None)."""
        i = self._told(p)
        if i.op == "not":
            key, sense = self._surface_of(i.args[0])
            return key, None if key is None else not sense
        if i.op in ("lt", "le") and p in self.moves:
            key, sense = self._ordered(*i.args)
            return (key, sense) if self.surfaces is None or key in self.surfaces else (None, None)
        return None, None

    def _ordered(self, a, b):
        """(key, sense) of a < b: the same key for all ways to write one surface, 0 < -u and u - v < 0 too."""
        while self.zero in (a, b):
            i = self.instructions[a if b == self.zero else b]
            if i.op == "neg":
                a, b = (self.zero, i.args[0]) if b == self.zero else (i.args[0], self.zero)
            elif i.op == "sub":
                a, b = i.args if b == self.zero else i.args[::-1]
            else:
                break
        return (min(a, b), max(a, b)), a < b

    def _surfaces(self, positions):
        found, conditions = {}, {}
        for p in positions:
            i = self.instructions[p]
            if p not in self.moves:
                continue
            if i.op in ("lt", "le"):
                key, sense = self._surface_of(p)
                found.setdefault(key, _Surface(i.op, key if sense else key[::-1]))
            elif i.op == "abs":
                key, sense = self._ordered(i.args[0], self.zero)
                found.setdefault(key, _Surface("lt", key if sense else key[::-1]))
            elif i.op == "floor":
                found[p] = _Surface(i.op, i.args)
            for place, a in enumerate(i.args if self._told(p) is i else ()):
                key, _ = self._surface_of(a)
                if key is not None:
                    direct = i.op == "select" and place == 0
                    conditions.setdefault(key, []).append(p if direct else None if i.op != "not" else p)
        for key, users in conditions.items():
            cases = [self.instructions[p] for p in users if p is not None and self.instructions[p].op == "select"]
            found[key].in_logic = None in users
            # the two cases of a Max or Min are equal on its surface: nothing to slide along
            found[key].cases = [c for c in cases if self._ordered(*c.args[1:])[0] != key]
        return found

    def _slides(self, key):
        """Whether both cases may push towards the surface: it is a velocity, and the cases differ on it."""
        surface = self.surfaces[key]
        return bool(surface.cases) and not surface.in_logic and not self.of_rates.isdisjoint(key)

    def rewritten(self, p, assumed):
        """The value at p, comparisons replaced; ``assumed`` holds (surface, sense) of the cases it stands in."""
        if p not in self.moves:
            return self.builder.result(p)
        if (p, assumed) not in self.known:
            self.known[p, assumed] = self._rewrite(p, assumed)
        return self.known[p, assumed]

    def _rewrite(self, p, assumed):
        i = self.instructions[p]
        key, sense = self._surface_of(p)
        if key is not None:
            if (key, True) in assumed or (key, False) in assumed:
                return self.builder.const(((key, True) in assumed) == sense)
            leaf = self._leaf(key)
            if leaf.type != "bool":  # the mixture of a sliding surface, which is no condition
                leaf = self.builder.const(True)
            return leaf if sense else ~leaf
        if i.op == "select":
            return self._case(i, assumed)
        if i.op == "floor" and p in self.surfaces:
            return self._leaf(p)
        args = [self.rewritten(a, assumed) for a in i.args]
        if i.op == "abs" and self._ordered(i.args[0], self.zero)[0] in self.surfaces:
            return self._either(*self._ordered(i.args[0], self.zero), lambda _: -args[0], lambda _: args[0], assumed)
        return self.builder.emit(i.op, *args, type=i.type) if args else self.builder.result(p)

    def _case(self, i, assumed):
        key, sense = self._surface_of(i.args[0])
        if key is None:
            return self.builder.emit("select", *(self.rewritten(a, assumed) for a in i.args))
        return self._either(key, sense, *(lambda within, a=a: self.rewritten(a, within) for a in i.args[1:]), assumed)

    def _either(self, key, sense, true, false, assumed):
        """One of two cases, or the mixture of both where their surface may be slid along."""
        below, above = (true, false) if sense else (false, true)
        if (key, True) in assumed or (key, False) in assumed:
            return (below if (key, True) in assumed else above)(assumed)
        below, above = below(assumed | {(key, True)}), above(assumed | {(key, False)})
        leaf = self._leaf(key)
        return select(leaf, below, above) if leaf.type == "bool" else below + leaf * (above - below)

    def _leaf(self, key):
        """The leaf of a surface; the first time, describe the surface too."""
        if key not in self.leaves:
            surface = self.surfaces[key]
            self.leaves[key] = self._slide(key) if self._slides(key) else self._guard(key, surface)
        return self.leaves[key]

    def _guard(self, key, surface):
        if surface.op == "floor":
            first, second = self.rewritten(surface.args[0], frozenset()), self.builder.const(0.0)
            guard = Guard("floor", first, second, self.new())
        else:
            first, second = (self.rewritten(a, frozenset()) for a in key)
            guard = Guard("side", first, second, self.new("bool"), (surface.op == "lt") == (surface.args == key))
        self.guards.append(guard)
        return guard.leaf

    def _slide(self, key):
        first, second = (self.rewritten(a, frozenset()) for a in key)
        leaf, side = self.new(), self.new("bool")
        one = self.builder.const(1.0)
        self.reactions.append(Reaction(leaf, first - second, 1, select(side, one, 0.0), leaf * (1.0 - leaf), leaf - 0.5, side))
        return leaf
