"""What depends on what in a scene: coordinates, signals, the force and the channels that are watched."""

from dataclasses import replace

from ...scene.notation.symbols import delay
from ..algebra.graph import Graph

FORCE = "F"


class Dependence:
    """The graph of a form's names: each coordinate and signal, :data:`FORCE`, and each watched channel.

    An acceleration depends on those that its row of the mass matrix holds, and on all that a constraint or an instantaneous
    contact couples to it. Rows from which no entry leads to others are solved alone: with the rest they make the matrix
    triangular in blocks.

    Parameters
    ----------
    form : ExplicitForm
    graph : Graph, optional
        Of its expressions.

    Attributes
    ----------
    on : dict name -> set of names
        What each depends on directly.
    channels : dict of str to str
        ``"watch y"``, as a channel is called among these names, which may have a y too, to the ``"y"`` of the scene.
    """

    def __init__(self, form, graph=None):
        self.form, self.graph = form, graph or Graph()
        self.channels = {f"watch {name}": name for name in form.watch}
        self.coordinates = {type(q).__name__: q for q in form.coordinates}
        self.signals = {type(y).__name__: y for y in form.updates}
        self.on = {FORCE: self._moving([form.force])}
        for channel, expr in zip(self.channels, form.watch.values(), strict=True):
            self.on[channel] = self._moving([expr])
        names = [*self.coordinates]
        for k, name in enumerate(names):
            tied = {j for j, entry in enumerate(form.M[k]) if self.graph(entry).constant != 0}
            parts = [*form.M[k], form.f[k]]
            for model in coupled(form):
                if form.coordinates[k] in model.coordinates:
                    tied |= {form.coordinates.index(q) for q in model.coordinates if q in form.coordinates}
                    parts += _held(model)
            self.on[name] = self._moving(parts).union(names[j] for j in tied) - {name}
        for y, expr in form.updates.items():
            name = type(y).__name__
            self.on[name] = self._moving([expr]) - {name}

    def _moving(self, exprs):
        """The names of coordinates and signals that expressions depend on, also through delays and reactions."""
        found, stack = set(), self.graph.variables_of(exprs)
        while stack:
            leaf = stack.pop()
            role = getattr(type(leaf), "role", None)
            if isinstance(leaf, delay):
                stack += self.graph.variables_of(leaf.args)
            elif leaf.is_Derivative:
                stack.append(leaf.expr)
            elif role in ("coordinate", "signal"):
                found.add(type(leaf).__name__)
            elif role not in (None, "handle", "driven"):  # a reaction, or what impacts add up to
                found |= {type(q).__name__ for model in coupled(self.form) for q in model.coordinates}
        return found

    def paths(self, *roots):
        """name -> the way to it from the nearest of the roots, for all they depend on.

        Examples
        --------
        >>> import hapticlab as hl, sympy as sp
        >>> y, z = hl.coordinate("y", unit="m"), hl.coordinate("z", unit="m")
        >>> r = hl.parameters("r", units="1/s"); k = hl.parameters("k", units="N/m")
        >>> eom = [sp.Eq(z.diff(hl.t), r * (y - z)), sp.Eq(y.diff(hl.t), -r * y)]
        >>> Dependence(hl.Scene(force=k * z, eom=eom).explicit()).paths("F")["y"]
        ('F', 'z', 'y')
        """
        found = {root: (root,) for root in roots}
        queue = list(roots)
        for name in queue:
            for other in sorted(self.on.get(name, ())):
                if other not in found:
                    found[other] = (*found[name], other)
                    queue.append(other)
        return found

    @property
    def needed(self):
        """The rows of the equations of motion that the force and the channels depend on."""
        seen = self.paths(FORCE, *self.channels)
        return [k for k, q in enumerate(self.form.coordinates) if type(q).__name__ in seen]

    def groups(self, names):
        """Names as lists of those that depend on each other, directly or not, in either direction."""
        left, groups = list(names), []
        while left:
            group = [left.pop(0)]
            for name in group:
                near = [o for o in left if o in self.on[name] or name in self.on[o]]
                group += near
                left = [o for o in left if o not in near]
            groups.append(group)
        return groups


def coupled(form):
    """The models whose coordinates are held together by more than M and f: constraints, contacts of an instant."""
    return [model for model in form.models if model.constraints or not all(c.is_force for c in model.contacts)]


def _held(model):
    """The constraints, gaps and slips that tie the coordinates of a model to each other."""
    gaps = [getattr(c, part) for c in model.contacts for part in ("gap", "slip") if hasattr(c, part)]
    return [*model.constraints, *gaps]


def blocks(form, graph):
    """The groups of equations that are solved together, as lists of rows."""
    N = len(form.coordinates)
    group = list(range(N))
    tied = [(i, j) for i in range(N) for j in range(N) if i != j and graph(form.M[i][j]).constant != 0]
    for model in coupled(form):
        rows = [form.coordinates.index(q) for q in model.coordinates if q in form.coordinates]
        tied += [(rows[0], j) for j in rows[1:]]
    for i, j in tied:
        old, new = group[j], group[i]
        group = [new if g == old else g for g in group]
    return [[k for k in range(N) if group[k] == g] for g in sorted(set(group))]


def part_of(form, rows):
    """A form with these equations of motion alone; they must depend on no other's acceleration."""
    return replace(
        form,
        coordinates=tuple(form.coordinates[k] for k in rows),
        orders=tuple(form.orders[k] for k in rows),
        M=tuple(tuple(form.M[i][j] for j in rows) for i in rows),
        f=tuple(form.f[k] for k in rows),
    )
