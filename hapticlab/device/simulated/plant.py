"""The handle with the hand on it, between samples: exact for a force that is held.

M x'' = push - F - b x' - coulomb sign(x') - k_h (x - intent) - b_h (x' - intent'),   M = m + m_h

Without Coulomb friction this is linear, and advances by the matrix exponential. One Euler step a period would put the
chatter boundary at half its true stiffness or beyond any. The coefficients are parameters of the program, so that one
program serves every mass, damping and period, and lanes may sweep them.
"""

from dataclasses import dataclass
from functools import cache
from itertools import accumulate

import numpy as np

from ...compiler.ir.program import Channel
from . import friction
from .transition import PHI, transition

#: a remainder of delay/T this close to a whole sample is rounding
WHOLE = 1e-9
#: where in a period the sensor's reading lies: nowhere, before the force changes, at that instant, after it
NOWHERE, BEFORE, AT, AFTER = range(4)
#: the parts of a period in which the force changes and a reading lies, in their order
PARTS = {BEFORE: ("_unseen", "_before", "_after"), AFTER: ("_before", "_unseen", "_after")}


@dataclass(frozen=True)
class Plant:
    """Which terms the plant has. Paddles of equal Plant share a linked program and differ in parameter values only.

    Attributes
    ----------
    whole : int
        Whole samples of delay.
    split : bool
        A fraction of a sample of delay is left: the force changes inside the period.
    push, shake, spring, drag, ramp : bool
        The hand pushes or leans on a resting intent, has noise, has k, has b with a moving intent, has a moving intent.
    coulomb : bool
    pieces, terms : int
        With Coulomb friction: pieces a period part is cut into, terms of the Taylor polynomial in each.
    lag : int
        Whole samples by which the sensor lags.
    seen : int
        Where in a period the sensor's reading lies, as a fraction of a sample of lag is left: BEFORE the force changes, AT
        that instant or AFTER it; NOWHERE without such a fraction.
    """

    whole: int = 0
    split: bool = False
    push: bool = False
    shake: bool = False
    spring: bool = False
    drag: bool = False
    ramp: bool = False
    coulomb: bool = False
    pieces: int = 1
    terms: int = 0
    lag: int = 0
    seen: int = NOWHERE

    @property
    def parts(self):
        """Name the parts of a period, before and after the force changes; "_unseen" ends with the sensor's reading."""
        if not self.split:
            return ("_unseen", "") if self.seen else ("",)
        return PARTS.get(self.seen, ("_before", "_after"))

    @property
    def older(self):
        """How many of the parts the older force acts in."""
        return self.split + (self.seen == BEFORE)

    @property
    def readings(self):
        """How many readings of the sensor are under way."""
        return self.lag + (self.seen != NOWHERE)

    def channels(self):
        """Return the plant's parameters, in the order of :func:`values`."""
        leans = self.spring and self.ramp
        common = (
            ("push", "N", self.push),
            ("k", "N/m", leans or (self.spring and self.coulomb)),
            ("b_hand", "N s/m", self.drag),
            *((f"offset{part}", "s", leans) for part in self.parts[1:]),
            ("coulomb", "N", self.coulomb),
        )
        named = [(name, unit) for name, unit, there in common if there]
        for part in self.parts:
            named += [(f"{name}{part}", unit) for name, unit in self._entries()]
        return tuple(Channel(f"plant.{name}", unit, "f64") for name, unit in named)

    def _entries(self):
        if self.coulomb:
            return [("h", "s"), ("gain", "s/kg"), ("beta", "1")] + [("kappa", "1")] * self.spring
        drop = (() if self.spring else ("xx", "vx", "xd", "vd")) + (() if self.ramp else ("xd", "vd"))
        return [(f"phi_{e}", unit) for e, unit in PHI.items() if e not in drop]

    def step(self, p, x, v, F_before, F_after, intent=0.0, rate=0.0, shake=0.0):
        """Advance one period; the force changes from F_before to F_after where the plant is split.

        Parameters
        ----------
        p : dict of str to float, array or Value
            The plant's parameters by name.
        x, v, F_before, F_after, intent, rate, shake : float, array or Value
            Position [m], velocity [m/s], forces on the environment [N], intent [m] and its rate [m/s] at the sample, and
            the hand's noise over the period [N].

        Returns
        -------
        x_seen, x_switch, x, v
            Position at the sensor's reading and where the force changes, then position and velocity at the next sample.
        """
        x_seen = x_switch = x
        for position, part in enumerate(self.parts):
            if position == self.older:
                x_switch = x
            F = F_before if position < self.older else F_after
            u = p["plant.push"] - F if self.push else -F
            u = u + shake if self.shake else u
            d = None
            if self.drag:
                u = u + p["plant.b_hand"] * rate
            if self.spring and self.ramp:
                ahead = intent + p[f"plant.offset{part}"] * rate if position else intent
                u, d = u + p["plant.k"] * ahead, p["plant.k"] * rate
            x, v = (self._slide if self.coulomb else self._glide)(p, part, x, v, u, d)
            x_seen = x if part == "_unseen" else x_seen
        return (x_switch if self.seen == AT else x_seen), x_switch, x, v

    def _glide(self, p, part, x, v, u, d):
        phi = dict(zip(PHI, map(p.get, _names_of_phi(part)), strict=True))
        moved = x * phi["xx"] if self.spring else x
        x_next = moved + (phi["xv"] * v + phi["xu"] * u)
        v_next = phi["vv"] * v + phi["vu"] * u
        if self.spring:
            v_next = v_next + phi["vx"] * x
        if d is not None:
            x_next, v_next = x_next + phi["xd"] * d, v_next + phi["vd"] * d
        return x_next, v_next

    def _slide(self, p, part, x, v, u, d):
        of_part = (p.get(f"plant.{name}{part}") for name in ("h", "gain", "beta", "kappa"))
        piece = friction.Piece(*of_part, p["plant.k"] if self.spring else None, p["plant.coulomb"], self.terms)
        for _ in range(self.pieces):
            x, v = friction.slide(piece, x, v, u, d)
            u = u if d is None else u + d * piece.h
        return x, v


@cache
def _names_of_phi(part):
    return [f"plant.phi_{entry}{part}" for entry in PHI]


def plant_of(paddle):
    """Return the Plant of a simulated paddle: only what it has."""
    hand = paddle.hand
    whole, split, coulomb, pieces, terms, lag, seen = (a.item() for a in decided(paddle))
    leaning = hand is not None and not hand.moves and hand.intent is not None and hand.k * hand.intent != 0
    return Plant(
        whole=whole,
        split=split,
        push=hand is not None and (hand.push != 0 or leaning),
        shake=hand is not None and hand.push_noise > 0,
        spring=hand is not None and hand.k > 0,
        drag=hand is not None and hand.moves and hand.b > 0,
        ramp=hand is not None and hand.moves,
        coulomb=coulomb,
        pieces=pieces,
        terms=terms,
        lag=lag,
        seen=seen,
    )


def decided(paddle):
    """Parts of the Plant that a paddle's numbers decide: whole, split, coulomb, pieces, terms, lag and seen, as arrays."""
    whole, fraction = delay_parts(paddle)
    lag, seen = sensor_parts(paddle)
    pieces, terms, coulomb = 1, 0, np.asarray(paddle.coulomb) > 0
    if coulomb.any():
        length = np.max(np.broadcast_arrays(*_lengths(paddle)), axis=0)
        length, moved = np.where(coulomb, length, 0.0), dynamics(paddle)
        friction.check_pieces(length, *moved, m=paddle.m, T=paddle.T)
        pieces, terms = friction.resolution(length, *moved)
        pieces, terms = np.where(coulomb, pieces, 1), np.where(coulomb, terms, 0)
    return tuple(np.asarray(a) for a in (whole, np.asarray(fraction) > 0, coulomb, pieces, terms, lag, seen))


def dynamics(paddle):
    """Return mass [kg], damping [N s/m] and stiffness [N/m] of handle and hand together."""
    hand = paddle.hand
    return (paddle.m, paddle.b, 0.0) if hand is None else (paddle.m + hand.m, paddle.b + hand.b, hand.k)


def delay_parts(paddle):
    """Return the whole samples of the delay and the fraction of a sample that is left; arrays where the paddle has them."""
    return _samples(paddle.delay, paddle.T)


def sensor_parts(paddle):
    """Return the whole samples of the sensor's lag, and where in a period the reading lies; see Plant."""
    lag, late = _samples(paddle.sensor_delay, paddle.T)
    change = delay_parts(paddle)[1] - (1 - late)  # how long after the reading the force changes, in periods
    seen = np.where(abs(change) <= WHOLE, AT, np.where(change > 0, BEFORE, AFTER))
    return lag, np.where(np.asarray(late) > 0, seen, NOWHERE)


def sensor_age(paddle):
    """How old the sensor's latest reading that is kept is at a sample [s]."""
    lag, late = _samples(paddle.sensor_delay, paddle.T)
    return np.where(np.asarray(late) > 0, late, 1.0) * paddle.T if np.ndim(lag) else (late or 1.0) * paddle.T


def _samples(time, T):
    samples = np.asarray(time / T)
    whole = np.floor(samples + WHOLE).astype(int)
    fraction = np.where(samples - whole > WHOLE, samples - whole, 0.0)
    return (whole, fraction) if samples.ndim else (whole.item(), fraction.item())


def part_lengths(paddle):
    """Durations of the parts of a period [s]."""
    return _lengths(paddle, paddle.plant.parts)


def _lengths(paddle, parts=None):
    """Durations of the parts of a period [s], or of parts that are as long as any of them."""
    change, read = delay_parts(paddle)[1], 1 - _samples(paddle.sensor_delay, paddle.T)[1]
    if parts is None:
        return change * paddle.T, (1 - change) * paddle.T
    ends = {"_before": change, "_unseen": read}
    instants = [ends.get(part, 1.0) for part in parts]
    return tuple((b - a) * paddle.T for a, b in zip((0.0, *instants), instants, strict=False))


def values(paddle):
    """Return the values of ``paddle.plant.channels()``: numbers, and arrays where the paddle's are."""
    plant, hand = paddle.plant, paddle.hand
    M, b, k = dynamics(paddle)
    found = {"plant.coulomb": paddle.coulomb}
    if hand is not None:
        resting = 0.0 if hand.moves or hand.intent is None else hand.k * hand.intent
        found |= {"plant.push": hand.push + resting, "plant.k": hand.k, "plant.b_hand": hand.b}
        begins = accumulate(part_lengths(paddle)[:-1])
        found |= {f"plant.offset{part}": begin for part, begin in zip(plant.parts[1:], begins, strict=True)}
    for part, length in zip(plant.parts, part_lengths(paddle), strict=True):
        if plant.coulomb:
            h = length / plant.pieces
            entries = {"h": h, "gain": h / M, "beta": b * h / M, "kappa": k * h * h / M}
        else:
            entries = {f"phi_{e}": c for e, c in transition(M, b, k, length).items()}
        found.update({f"plant.{name}{part}": c for name, c in entries.items()})
    return tuple(found[c.name] for c in plant.channels())
