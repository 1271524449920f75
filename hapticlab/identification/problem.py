"""Records of one paddle and what of it is sought, made into a fit; many records of a kind run side by side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.shows_itself import ShowsItself
from .held_force_motion import positions
from .scoring import fit, noise_of
from .start import begin

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..base.annotations import Array
    from .scoring import Fitted

#: constants of a paddle; scale is newtons at the handle for each commanded
CONSTANTS = ("m", "b", "coulomb", "delay", "scale")
#: what is taken for known where it is not sought
USUAL = {"delay": 0.0, "scale": 1.0}

#: parts of the first m, b and coulomb that a fit may begin with, and delays in samples beside the one found
PARTS = tuple((m, b, c) for m in (1.0, 0.8) for b in (1.0, 0.1) for c in (1.0, 0.3, 0.1))
LATE = (0.0, 1.0, 2.0)
NEAR = tuple((m, b, c) for m in (1.0, 0.9, 1.1) for b in (1.0, 0.3) for c in (1.0, 0.9))
#: what a constant is at least: nothing has less mass, feeds energy or pushes by friction
LEAST = {"m": 1e-6, "b": 0.0, "coulomb": 0.0}
#: samples of delay at most
LATEST = 20
#: what first values are found without
WITHOUT = ((), ("b",), ("b", "coulomb"))
#: parts of the largest force that friction is taken for, each one a beginning of its own; and those of m and b there
RUNGS = (0.5, 0.6, 0.7, 0.8, 0.9)
LIGHTER = tuple((m, b, 1.0) for m in (1.0, 0.5, 0.25) for b in (1.0, 0.1))


@dataclass(frozen=True, eq=False)
class Trace(ShowsItself):
    """Positions y [m] of a handle under forces F [N], every T [s], shape (N, L) and (N,) or (N, L): L of a kind.

    ``added`` is a known mass that was fixed to the handle [kg], ``push`` a known constant force beside the motor's [N].
    ``rests`` says that the handle is at rest at the first sample.
    """

    y: Array
    F: Array
    T: float
    added: float = 0.0
    push: float = 0.0
    rests: bool = False

    def __str__(self) -> str:
        return f"{len(self.y)} samples of a handle under known forces, every {1e3 * self.T:g} ms"

    def start(self, lane, known, **how):
        """First values of the paddle's constants, and of position and velocity, from one of the records."""
        F = self.F if self.F.ndim == 1 else self.F[:, lane]
        mass = known["m"] + self.added if "m" in known else None
        found, begun = begin(self.y[:, lane], F, self.T, push=self.push, m=mass, **how)
        return found | {"m": max(found["m"] - self.added, 0.1 * found["m"])}, begun


@dataclass(frozen=True, eq=False)
class Problem:
    """Traces of one paddle, the names that are sought, and the values of the others.

    Examples
    --------
    >>> t = np.arange(0, 0.3, 1e-3)
    >>> trace = Trace((0.4 * t - t**2 / 2)[:, None], 0 * t, 1e-3)
    >>> Problem((trace,), ("b", "coulomb"), {"m": 0.05}).solve().values[1, 0].round(6).item()
    0.05
    """

    traces: tuple[Trace, ...]
    free: tuple[str, ...]
    known: Mapping[str, float]
    quantum: float = 0.0

    @property
    def lanes(self) -> int:
        return self.traces[0].y.shape[1]

    def motion(self, p):
        """The positions of all traces one after the other, for parameters of shape (P, K, L)."""
        values = {**USUAL, **self.known, **dict(zip(self.free, p, strict=False))}
        # no step is taken to where nothing moves any more, whatever the other constants are
        sane = (values["m"] > 0) & (np.abs(values["delay"]) < LATEST * self.traces[0].T)
        values["m"] = np.where(sane, values["m"], np.nan)
        begun = p[len(self.free) :]
        if not np.any(values["coulomb"] < 0):
            return self._moved(values, begun)
        # less than none turns about none, so that the motion has one slope there and intervals hold a friction of zero
        moved = self._moved(values | {"coulomb": np.abs(values["coulomb"])}, begun)
        return np.where(values["coulomb"] < 0, 2 * self._moved(values | {"coulomb": 0.0}, begun) - moved, moved)

    def _moved(self, values, begun):
        starts, side = iter(begun), begun.shape[-1] // self.lanes  # several beginnings of a record lie side by side
        return np.concatenate([
            positions(
                trace.F if trace.F.ndim == 1 else np.tile(trace.F, (1, side)), trace.T, m=values["m"] + trace.added,
                push=trace.push, x0=next(starts), v0=0.0 if trace.rests else next(starts),
                **{name: values[name] for name in ("b", "coulomb", "delay", "scale")},
            )
            for trace in self.traces
        ])  # fmt: skip

    def solve(self, begun: Mapping[str, float] | None = None) -> Fitted:
        """The Fitted of all lanes; ``begun`` are constants that may be near."""
        low = np.full(len(self.free) + sum(2 - trace.rests for trace in self.traces), -np.inf)
        low[: len(self.free)] = [LEAST.get(name, -np.inf) for name in self.free]
        y = np.concatenate([trace.y for trace in self.traces])
        return fit(self.motion, y, self._starts(y, begun), self._scales, quantum=self.quantum, low=low)

    def _starts(self, y, begun):
        """Yield guesses, shape (P, C, L): near what has begun, of all first values, and of friction taken for known."""
        if begun:
            yield np.stack(list(self._guesses(self._near(begun), NEAR)), axis=1)
        ways = [{"noise": noise, "without": without} for noise in sorted({0.0, self.quantum}) for without in WITHOUT]
        yield self._side(ways, PARTS)
        force = max(float(np.abs(trace.push - trace.F).max()) for trace in self.traces)
        if "coulomb" in self.free and force:
            noise = max(self.quantum, float(np.median(noise_of(y))))
            for part in RUNGS:
                yield self._side([{"noise": noise, "coulomb": part * force}], LIGHTER)

    def _near(self, begun):
        """A start with these constants, each record where it was first seen and at rest."""
        ends = [a for trace in self.traces for a in (trace.y[0], np.zeros(self.lanes))[: 2 - trace.rests]]
        values = USUAL | dict(begun)
        return np.array([*(np.full(self.lanes, values[name]) for name in self.free), *ends])

    def _side(self, ways, parts):
        """The guesses, shape (P, C, L), that come of first values found in these ways."""
        starts = [np.array([self._start(lane, **way) for lane in range(self.lanes)]).T for way in ways]
        return np.stack([guess for start in starts for guess in self._guesses(start, parts)], axis=1)

    def _guesses(self, start, tried):
        """Yield starts with parts of its m, b and coulomb, and with other delays."""
        row = {name: k for k, name in enumerate(self.free)}
        for parts in tried:
            part = dict(zip(("m", "b", "coulomb"), parts, strict=True))
            guess = start * np.array([part.get(name, 1.0) for name in (*row, *range(len(start) - len(row)))])[:, None]
            yield guess
            for late in LATE if "delay" in row else ():
                guess = guess.copy()
                guess[row["delay"]] = late * self.traces[0].T
                yield guess

    def _start(self, lane, **how):
        delays = range(6) if "delay" in self.free else (round(self.known.get("delay", 0.0) / self.traces[0].T),)
        found = [trace.start(lane, self.known, delays=delays, **how) for trace in self.traces]
        told = max(found, key=lambda one: one[0]["m"] < 1e3)[0] | {"scale": 1.0}
        begun = (begun[: 2 - trace.rests] for trace, (_, begun) in zip(self.traces, found, strict=True))
        return [*(told[name] for name in self.free), *(a for start in begun for a in start)]

    def _scales(self, start):
        """Considerable changes: a tenth of the mass, and of the forces that go with it."""
        values = {**USUAL, **self.known, **dict(zip(self.free, start, strict=False))}
        T, span = self.traces[0].T, max(len(trace.y) * trace.T for trace in self.traces)
        travel = max(float(np.ptp(trace.y, axis=0).max()) for trace in self.traces)
        m = np.broadcast_to(values["m"], start.shape[1:]) * 0.1
        one = np.ones_like(m)
        of = {"m": m, "b": m / span, "coulomb": m * travel / span**2, "delay": T * one, "scale": 0.1 * one}
        places = (a for trace in self.traces for a in (travel, travel / span)[: 2 - trace.rests])
        return np.array([*(of[name] for name in self.free), *(a * one for a in places)])
