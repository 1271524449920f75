"""The motion of a scene by scipy's solvers, mode by mode: a second opinion on what ``method="taylor"`` locates.

In each mode the equations are smooth; a surface that is crossed is bracketed on the dense output and found by bisection
of its sign (Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, ch. II.6 and II.10).
"""

from dataclasses import dataclass

import numpy as np

from ...errors import AnalysisError
from .accelerations_at import ROWS

#: places within a step at which surfaces are looked at
PLACES = np.linspace(0, 1, 5)[1:]
#: most changes of mode within a millisecond: more is a motion along a surface that no mode describes
MOST_EVENTS = 40
#: most steps of DOP853 a second of motion: more is a motion too stiff for it, which LSODA takes over
STIFF = 1500
#: most steps of both a second of motion
MOST_STEPS = 20_000


class Field:
    """Evaluates an :class:`~hapticlab.analysis.accuracy.accelerations_at.Instant` at any time, in any mode.

    Parameters
    ----------
    instant : Instant
    rows : array (periods, coefficients)
        Of the handle's motion.
    T : float
        Length of those periods [s].
    once : tuple
        Of :meth:`~hapticlab.compiler.engines.engine.Engine.once`.
    """

    def __init__(self, instant, rows, T, once):
        self.instant, self.rows, self.T = instant, rows, T
        self.inputs, self.states, self.outputs, self.tick = once
        self.guards, self.reactions = len(instant.kinds), len(instant.levels)
        self.sizes = n, m = instant.second, instant.first
        ends = np.cumsum([2, 2 * n + m, self.guards, self.reactions, sum(level == 1 for level in instant.levels)])
        self.y_at, self.flags_at, self.extra_at, self.sides_at = (slice(*pair) for pair in zip(ends, ends[1:], strict=False))
        self.held_at, self.units = slice(ends[-1], None), np.eye(self.reactions)
        self.gaps = np.array(instant.levels, int) == 2

    def __call__(self, t, y, mode, extra=0.0):
        """Return the outputs at t: reactions that are held keep their measures, others are free, ``extra`` beside them."""
        k, states = min(max(int(t / self.T), 0), len(self.rows) - 1), self.states
        self.inputs[:-1], self.inputs[-1] = self.rows[k], t - k * self.T
        states[:2], states[self.y_at] = divmod(k, self.instant.digit)[::-1], y
        if self.guards:
            states[self.flags_at] = mode.flags
        if self.reactions:
            states[self.extra_at], states[self.sides_at] = extra, mode.sides[~self.gaps]
            states[self.held_at] = mode.held
        self.tick()
        return self.outputs.copy()

    def rates(self, t, y, mode):
        """Return the rates of y at t."""
        n, m = self.sizes
        return np.concatenate([y[n : 2 * n], self(t, y, mode)[1 : 1 + n + m]])

    def part(self, out, name):
        """Return one row of every reaction from the outputs."""
        return out[1 + sum(self.sizes) + self.guards + ROWS.index(name) :: len(ROWS)]

    def measures(self, out):
        """Return the measures of the guards."""
        start = 1 + sum(self.sizes)
        return out[start : start + self.guards]

    def surfaces(self, t, y, mode):
        """Numbers that are positive while the mode lasts: one per guard, one per reaction."""
        out = self(t, y, mode)
        kinds = np.array([kind == "floor" for kind in self.instant.kinds], bool)
        u = self.measures(out)
        guards = np.where(kinds, 0.25 - u**2, np.where(mode.flags > 0, -u, u))
        m = self.part(out, "measure")
        free = np.where(self.gaps | (mode.sides > 0), m, -m)
        return np.concatenate([guards, np.where(mode.held, self.part(out, "inside"), free)])


@dataclass
class Mode:
    """Which case holds of every guard, which reactions are held, and which way the others slip."""

    flags: np.ndarray
    held: np.ndarray
    sides: np.ndarray


class Hybrid:
    """Integrates a :class:`Field` from event to event."""

    def __init__(self, field, *, rtol=1e-10, atol=1e-13):
        self.field, self.rtol, self.atol = field, rtol, atol

    def run(self, start, times, breaks=()):
        """Return F at ascending times, from the state ``start`` at time 0; ``breaks`` are where the handle's motion changes."""
        field = self.field
        self.t, self.y, self.times, self.F = 0.0, start.copy(), times, np.full(len(times), np.nan)
        self.done = self.steps = 0
        self.mode = self._first_mode()
        self.just, self.recent = np.zeros(field.guards + field.reactions, bool), []
        for stop in [*(b for b in breaks if 0 < b < times[-1]), times[-1]]:
            while self.t < stop:
                self._smooth(stop)
        if self.done < len(times):
            self._record(lambda _: self.y, times[-1])
        return self.F

    def _first_mode(self):
        field = self.field
        mode = Mode(np.zeros(field.guards), np.zeros(field.reactions, bool), np.zeros(field.reactions))
        for k, kind in enumerate(field.instant.kinds):  # in order: a surface may lie in a case of another
            u = field.measures(field(0.0, self.y, mode))[k]
            mode.flags[k] = np.floor(u + 0.5) if kind == "floor" else u < 0
        self.mode = mode
        self._sides()
        for i in np.flatnonzero(np.abs(field.part(field(0.0, self.y, mode), "measure")) < 1e-14):
            self._try(i)
        return mode

    def _smooth(self, stop):
        """Go on to the next event, or to ``stop``."""
        from scipy.integrate import DOP853, LSODA

        field, mode, stiff = self.field, self.mode, self.stiff
        solver = (LSODA if stiff else DOP853)(
            lambda t, y: field.rates(t, y, mode), self.t, self.y, stop, rtol=self.rtol, atol=self.atol,
            max_step=5e-3 if len(self.just) else np.inf,
        )  # fmt: skip
        while solver.status == "running":
            before = solver.t
            solver.step()
            self.steps += 1
            if self.steps > MOST_STEPS * (1 + self.times[-1]):
                raise AnalysisError(f"at t = {before:.6g} s scipy has taken {self.steps} steps: the motion is too stiff")
            if solver.status == "failed":
                raise AnalysisError(f"at t = {before:.6g} s the step became too small")
            dense = solver.dense_output()
            event = self._event(before, solver.t, dense) if len(self.just) else None
            self._record(dense, solver.t if event is None else event[0])
            if event is not None:
                self.t, fired = event
                self.y = dense(self.t)
                self._change(fired)
                return
            self.just[:] = False
            self.t, self.y = solver.t, solver.y
            if self.stiff and not stiff:
                return

    @property
    def stiff(self):
        """Whether DOP853 takes too many steps."""
        return self.steps > STIFF * (0.1 + self.times[-1])

    def _record(self, dense, end):
        field = self.field
        while self.done < len(self.times) and self.times[self.done] <= end:
            at = self.times[self.done]
            self.F[self.done] = field(at, dense(at), self.mode)[0]
            self.done += 1

    def _event(self, begin, end, dense):
        """Return (time, surfaces fired) of the first surface left between two times, or None."""
        from scipy.optimize import brentq

        h, places = end - begin, np.concatenate([[1e-7, 1e-5, 1e-3, 3e-2], PLACES] if self.just.any() else [PLACES])

        def value(theta, i):
            return self.field.surfaces(begin + theta * h, dense(begin + theta * h), self.mode)[i]

        known = np.array([self.field.surfaces(begin + p * h, dense(begin + p * h), self.mode) for p in (0.0, *places)])
        at, first = np.concatenate([[0.0], places]), {}
        for i in np.flatnonzero((known < 0).any(0)):
            inside = np.flatnonzero(known[:, i] >= 0 if not self.just[i] else known[:, i] > 0)
            if not len(inside):  # left at once
                first[i] = 0.0 if not self.just[i] else at[1]
                continue
            after = np.flatnonzero((known[:, i] < 0) & (np.arange(len(at)) > inside[0]))
            if inside[0] > 0 and not self.just[i]:
                first[i] = 0.0
            elif len(after):
                first[i] = brentq(value, at[after[0] - 1], at[after[0]], args=(i,), xtol=1e-15, rtol=1e-15)
        if not first:
            return None
        earliest = min(first.values())
        return begin + earliest * h, [i for i, theta in first.items() if (theta - earliest) * h < 1e-12]

    def _change(self, fired):
        """Change the mode where surfaces were left."""
        self.recent = [t for t in self.recent if t > self.t - 1e-3] + [self.t]
        if len(self.recent) > MOST_EVENTS:
            raise AnalysisError(f"at t = {self.t:.6g} s the mode keeps changing")
        field, mode, guards = self.field, self.mode, self.field.guards
        self.just[:] = False
        self.just[fired] = True
        out = field(self.t, self.y, mode)
        for i in (i for i in fired if i < guards):
            if field.instant.kinds[i] == "floor":
                mode.flags[i] += np.sign(field.measures(out)[i])
            else:
                mode.flags[i] = 1.0 - mode.flags[i]
        for i in (i - guards for i in fired if i >= guards):
            if mode.held[i]:
                mode.held[i] = False
                mode.sides[i] = field.part(out, "lean")[i] > 0
            elif field.gaps[i]:
                self._impact(i)
            else:
                self._try(i)

    def _try(self, i):
        """Hold a slip or gap that came to zero, if its reaction can; else let it go where it leans."""
        self.mode.held[i] = True
        out = self.field(self.t, self.y, self.mode)
        if self.field.part(out, "inside")[i] < 0 or (self.field.gaps[i] and self.field.part(out, "d1")[i] > 1e-14):
            self.mode.held[i] = False
            self.mode.sides[i] = self.field.part(out, "lean")[i] > 0

    def _sides(self):
        out = self.field(self.t, self.y, self.mode)
        self.mode.sides[:] = self.field.part(out, "measure") > 0

    def _impact(self, i):
        """Newton's law of impact for one contact: its gap rate u becomes -e u, or rests where that is too slow to fly."""
        field, mode, n = self.field, self.mode, self.field.sizes[0]
        if mode.held[field.gaps].any():
            raise AnalysisError(f"at t = {self.t:.6g} s two contacts touch at once")
        out = field(self.t, self.y, mode)
        change = field(self.t, self.y, mode, field.units[i]) - out
        W, column = field.part(change, "d2")[i], change[1 : 1 + n]
        u, b, law = field.part(out, "d1")[i], field.part(out, "d2")[i], field.instant.bounces[i]
        rests = b < 0 and -law.e * u <= max(law.rest_speed, -b * field.T / 2)
        self.y[n : 2 * n] += column * (-(1 if rests else 1 + law.e) * u / W)
        mode.held[i] = rests
        after = field.measures(field(self.t, self.y, mode))
        for k, kind in enumerate(field.instant.kinds):  # cases of rates
            if kind == "side" and abs(after[k]) > 1e-12:
                mode.flags[k] = after[k] < 0
        free = ~mode.held
        sides = field.part(field(self.t, self.y, mode), "measure") > 0
        mode.sides[free] = sides[free]
