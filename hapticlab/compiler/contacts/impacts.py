"""The impacts of a motion: what they need is differentiated once on its graph, what they do is asked at the located instant."""

from dataclasses import dataclass, field, replace

from ..events.taylor_series import Series
from ..ir.structural_zeros import dot
from ..ir.trace import Value, select
from .touch import strike


@dataclass(frozen=True)
class Impacts:
    """What a :class:`~hapticlab.compiler.events.located_step.Stepper` takes as ``impact``; made by :func:`impacts_of`.

    Attributes
    ----------
    laws : list of Law, shape (k,)
    order : {"sequential", "simultaneous"}
    place : list of int, shape (k,)
        Where each contact stands among the motion's reactions.
    gaps : list of Value, shape (k,)
    w, free : list of Value, shape (N,)
        Rates of the coordinates, and their accelerations without reactions.
    rows, columns : lists of lists of Value, shape (rows, N)
        J and M^-1 J^T: of the k gaps, then of the slips of contacts with friction.
    rates, biases : list of Value, one per row
        Gap rates and slips, with what handle and time add; second derivatives but for J a, of the gaps alone.
    period : float
    near : float
        A gap below this [m] takes part in the impact of another.
    sums : dict (role, contact) -> Value
        What the impacts of the steps traced so far add up to: role ``impulse`` [N s], ``impact_loss`` [J], and
        ``impact_work`` [J], the work of what drives a surface. Cleared by who starts a period.
    """

    laws: list
    order: str
    place: list
    gaps: list
    w: list
    free: list
    rows: list
    columns: list
    rates: list
    biases: list
    period: float
    near: float = 1e-9
    sums: dict = field(default_factory=dict)

    def __call__(self, at, fired, held):
        """(w, held) after the contacts fired, beside those that rest or touch already; add to ``sums``.

        ``at(value)`` gives any value of the motion at that instant; ``fired`` and ``held`` go by reactions.
        """
        touching = [fired[i] | held[i] | (at(gap) <= self.near) for i, gap in zip(self.place, self.gaps, strict=True)]
        rows, columns = ([[at(value) for value in row] for row in table] for table in (self.rows, self.columns))
        W = _symmetric(rows, columns)
        free = [at(a) for a in self.free]
        b = [dot(row, free) + at(bias) for row, bias in zip(rows, self.biases, strict=False)]
        laws = [replace(law, **{part: at(value) for part, value in vars(law).items() if isinstance(value, Value)})
                for law in self.laws]  # fmt: skip
        u, w = [at(rate) for rate in self.rates], [at(rate) for rate in self.w]
        found = strike(W, u, b, touching, laws, self.period, self.order)
        self._add(found, [rate - dot(row, w) for rate, row in zip(u, rows, strict=True)], fired)
        modes = list(held)
        for i, place in enumerate(self.place):
            modes[place] = found.resting[i]
        return [rate + dot(found.p, [column[i] for column in columns]) for i, rate in enumerate(w)], modes

    def _add(self, found, driven, fired):
        """Add an impact to the sums; ``driven`` is the part of each rate that the coordinates do not make."""
        any_fired = False
        for here in fired:
            any_fired = here | any_fired
        for i, law in enumerate(self.laws):
            rows = [i] if law.slip is None else [i, law.slip]
            work = sum(-(found.p[row] * driven[row]) for row in rows)
            amounts = {"impulse": found.p[i], "impact_loss": sum(found.lost[row] for row in rows), "impact_work": work}
            for role, amount in amounts.items():
                self.sums[role, i] = self.sums.get((role, i), 0.0) + select(any_fired, amount, 0.0)


def impacts_of(motion, laws, place, period, order="sequential", slips=(), rubs=()):
    """The :class:`Impacts` of a motion.

    J, M^-1 J^T and the second derivative of each gap are traced from the motion itself: along a coordinate, along a
    reaction, along the motion.

    Parameters
    ----------
    motion : Motion
        Its accelerations hold the leaves of its reactions.
    laws : list of Law, shape (k,)
    place : list of int, shape (k,)
        Of each contact among the motion's reactions.
    period : float
        Sample period [s].
    order : {"sequential", "simultaneous"}
    slips : list of Value
        Tangential velocities, in the order of their rows k, k + 1, ...
    rubs : list of Value
        Leaves in the accelerations for the friction forces along them. The motion is left without them.
    """
    along = _Along(motion)
    gaps = [motion.reactions[i].measure for i in place]
    pushes = [*(motion.reactions[i].leaf for i in place), *rubs]
    path = dict(zip(motion.q, motion.w, strict=True)) | {motion.tau: 1.0}
    resting = {r.leaf: None for r in motion.reactions} | dict.fromkeys(rubs)
    columns = [[along(a, {push: 1.0}) for a in motion.a] for push in pushes]
    motion.a[:] = [along(a, {}, 0, zero=rubs) for a in motion.a] if rubs else motion.a  # no impact, no rubbing
    return Impacts(
        laws, order, place, gaps, motion.w,
        free=[along(a, {}, 0, zero=resting) for a in motion.a],
        rows=[[along(gap, {q: 1.0}) for q in motion.q] for gap in gaps]
        + [[along(slip, {w: 1.0}) for w in motion.w] for slip in slips],
        columns=columns,
        rates=[along(gap, path) for gap in gaps] + list(slips),
        biases=[2.0 * along(gap, path, 2) for gap in gaps],
        period=period, near=1e-9 if motion.builder.real == "f64" else 1e-7,
    )  # fmt: skip


class _Along:
    """Derivatives of a motion's values along directions of its leaves, as values of its builder."""

    def __init__(self, motion):
        self.builder = motion.builder

    def __call__(self, value, direction, order=1, zero=()):
        """Coefficient ``order`` of a value while its leaves go along a direction; those in ``zero`` are 0."""
        rows = {leaf.id: [leaf, speed, *[0.0] * order] for leaf, speed in direction.items()}
        rows |= {leaf.id: [0.0] for leaf in zero}
        found = Series(self.builder.instructions, rows, self.builder.result).of(value, order)[order]
        return found if isinstance(found, Value) else self.builder.const(found)


def _symmetric(rows, columns):
    """J (M^-1 J^T), symmetric to the last digit."""
    W = [[None] * len(rows) for _ in rows]
    for i, row in enumerate(rows):
        for j in range(i + 1):
            W[i][j] = W[j][i] = dot(row, columns[j])
    return W
