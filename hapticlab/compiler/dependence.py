"""What depends on what in a scene: coordinates, signals, the force and the channels that are watched."""

from dataclasses import replace

from ..scene.symbols import delay
from .coefficients import blocks, leaves

FORCE = "F"


class Dependence:
    """The graph of a form's names: each coordinate and signal, :data:`FORCE`, and each watched channel.

    Accelerations that one mass matrix block couples depend on all that enters its equations.

    Parameters
    ----------
    form : ExplicitForm

    Attributes
    ----------
    on : dict name -> set of names
        What each depends on directly. Channels are called ``"watch y"``.
    """

    def __init__(self, form):
        self.form, self.on = form, {FORCE: self._moving(form.force)}
        for name, expr in form.watch.items():
            self.on[f"watch {name}"] = self._moving(expr)
        self.channels = tuple(f"watch {name}" for name in form.watch)
        self.coordinates = {type(q).__name__: q for q in form.coordinates}
        self.signals = {type(y).__name__: y for y in form.updates}
        for rows in blocks(form):
            parts = [e for k in rows for e in (*form.M[k], form.f[k])]
            needed = set().union(*map(self._moving, parts))
            for k in rows:
                name = type(form.coordinates[k]).__name__
                mates = {type(form.coordinates[j]).__name__ for j in rows}
                self.on[name] = (needed | mates) - {name}
        for y, expr in form.updates.items():
            name = type(y).__name__
            self.on[name] = self._moving(expr) - {name}

    @staticmethod
    def _moving(expr):
        """Return the names of coordinates and signals in an expression, those inside delays and derivatives too."""
        found, stack = set(), list(leaves(expr))
        while stack:
            leaf = stack.pop()
            if isinstance(leaf, delay):
                stack += leaves(leaf.args[0])
            elif leaf.is_Derivative:
                stack.append(leaf.expr)
            elif getattr(type(leaf), "role", None) in ("coordinate", "signal"):
                found.add(type(leaf).__name__)
        return found

    def paths(self, *roots):
        """Return name -> the way to it from the nearest of the roots, for all they depend on.

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
        """Return names as lists of those that depend on each other, directly or not, in either direction."""
        left, groups = list(names), []
        while left:
            group = [left.pop(0)]
            for name in group:
                near = [o for o in left if o in self.on[name] or name in self.on[o]]
                group += near
                left = [o for o in left if o not in near]
            groups.append(group)
        return groups


def part_of(form, rows):
    """Return a form with these equations of motion alone; they must depend on no other's acceleration."""
    return replace(
        form,
        coordinates=tuple(form.coordinates[k] for k in rows),
        orders=tuple(form.orders[k] for k in rows),
        M=tuple(tuple(form.M[i][j] for j in rows) for i in rows),
        f=tuple(form.f[k] for k in rows),
    )
