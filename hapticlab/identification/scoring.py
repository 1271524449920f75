"""Maximum likelihood of a simulated motion in a noisy, counted position, many records side by side.

A sample is y = x + e, e Gaussian and independent, or the count in which that lies. The step is Fisher's scoring: for a
Gaussian sensor it is Gauss and Newton's. Intervals come from the information at the estimate.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.statistics import student
from .rounding import rounding_covariance
from .sensor import DITHERED, information, log_likelihood, noise_alone, run_weights, spread

if TYPE_CHECKING:
    from ..base.annotations import Array, Flags

#: of a parameter's scale: the step of central differences
STEP = 1e-5
#: scoring steps, and the part of a standard error that is no step any more
STEPS, ENOUGH = 30, 1e-2
#: of a fit that is said to have converged: what another step would gain, in squared standard errors
SETTLED = 0.02
#: smallest eigenvalue of the information, its diagonal scaled to one, of a direction that the record tells nothing about
BLIND = 1e-11
#: damping of a step at first, its factor after one that was good and one that was not
DAMPING, EASED, BRACED = 1e-3, 0.2, 6.0
#: rounds in which sigma and the parameters are found in turn, first as numbers, then as counts
ROUNDS = 6, 3
#: part of sigma by which it may change between rounds that end
SAME = 1e-3
#: part of a record's travel that a guess moves, at least, or its squared residuals count so many times
MOVES, STILL = 0.3, 1e6
#: guesses that are tried side by side
LANES = 2048
#: of sigma before a round of steps: what stays of it where the steps have ended
AGREES = 0.9
#: m of noise, so that no noise divides by nothing
LEAST = 1e-15


@dataclass(frozen=True, eq=False)
class Fitted:
    """What a fit found, for L records of N samples.

    Attributes
    ----------
    values : array, shape (P, L)
    covariance : array, shape (L, P, P)
    sigma : array, shape (L,)
        Standard deviation of the sensor's noise; without dither that of its counting as well.
    residuals : array, shape (N, L)
        Measured, the middle of a count, less fitted.
    freedom : array, shape (L,)
        Samples that tell something of their own, less parameters.
    counted : array of bool, shape (L,)
        Fitted as counts in dither; else as numbers.
    converged : array of bool, shape (L,)
    blind : array, shape (L, P)
        The direction, over the parameters' scales, in which nothing changes; zeros where there is none.
    beyond : array, shape (P, L)
        Standard errors by which a parameter that a bound holds would pass it; zeros for the others.
    """

    values: Array
    covariance: Array
    sigma: Array
    residuals: Array
    freedom: Array
    counted: Flags
    converged: Flags
    blind: Array
    beyond: Array

    @property
    def error(self) -> Array:
        """Standard errors, shape (P, L)."""
        return np.sqrt(np.maximum(np.diagonal(self.covariance, axis1=1, axis2=2), 0.0)).T

    def half_width(self, confidence: float = 0.95) -> Array:
        """Half the width of the confidence intervals, shape (P, L)."""
        return self.error * student(confidence, self.freedom)


def fit(motion, y, starts, scales, *, quantum=0.0, low=None):
    """The most likely parameters of y = motion(parameters) + noise, with their covariance.

    Parameters
    ----------
    motion : callable
        Takes parameters of shape (P, K, L), returns positions of shape (N, K, L).
    y : array, shape (N, L)
        Of a counted position, the middles of the counts.
    starts : iterable of arrays, shape (P, C, L)
        Where to begin: of C guesses for each record the one is taken whose motion is nearest. A likelihood has more than
        one top, so the next array is tried until what is left of every record looks like its sensor's noise.
    scales : callable
        Returns, for parameters of shape (P, L), how much is a considerable change; differences take STEP of it.
    quantum : float
        What one count is; 0 where the sensor does not count.
    low : array, shape (P,), optional
        The least that each parameter may be.

    Returns
    -------
    Fitted

    Examples
    --------
    >>> times = np.arange(50.0)[:, None, None]
    >>> y = 1 + 0.5 * times[:, 0] + np.random.default_rng(1).standard_normal((50, 1))
    >>> line = fit(lambda p: p[0] + p[1] * times, y, [np.zeros((2, 1, 1))], np.ones_like)
    >>> bool(abs(line.values[1, 0] - 0.5) < line.half_width()[1, 0])
    True
    """
    weights, found, rest = run_weights(y, quantum), None, None
    for start in starts:
        low = np.full(len(start), -np.inf) if low is None else low
        at, left = _climbed(motion, y, _nearest(motion, y, start), scales, low)
        better = True if found is None else np.sum(left**2, axis=0) < np.sum(rest**2, axis=0)
        found, rest = (at, left) if found is None else (np.where(better, at, found), np.where(better, left, rest))
        if np.all(noise_alone(rest, quantum)):
            break
    scales, freedom = scales(found), np.sum(weights, axis=0) - len(found)
    if quantum:
        return _counted(motion, y, found, rest, scales, quantum, weights, freedom, low)
    sigma, even, no = np.sqrt(np.sum(rest**2, axis=0) / freedom) + LEAST, np.ones_like(y), np.zeros(y.shape[1], bool)
    return _finished(motion, y, found, scales, sigma, 0.0, even, freedom, no, low)


def _climbed(motion, y, start, scales, low):
    """The top above a start, with positions as numbers, and the residuals there."""
    found, even, no = start, np.ones_like(y), np.zeros(y.shape[1], bool)
    scales, sigma = scales(start), _rms(y - motion(start[:, None])[:, 0])
    # what is a small step is said by sigma, and sigma by what is left after the steps
    for _ in range(ROUNDS[0]):
        found, rest = _scored(motion, y, found, scales, sigma, 0.0, even, no, low)
        sigma, before = _rms(rest), sigma
        if np.all(sigma > AGREES * before):
            break
    return found, rest


def _rms(rest):
    return np.sqrt(np.mean(rest**2, axis=0)) + LEAST


def _nearest(motion, y, start):
    """The guess with the least residuals, for each record."""
    lane, some = np.arange(y.shape[1]), max(1, LANES // y.shape[1])
    best, least = start[:, 0], np.inf
    for first in range(0, start.shape[1], some):
        guesses = start[:, first : first + some]
        with np.errstate(all="ignore"):
            moved = motion(guesses)
            size = np.sum((y[:, None] - moved) ** 2, axis=0)
            # one that hardly moves is not far from anything, and tells no way to go
            size = size * np.where(np.ptp(moved, axis=0) < MOVES * np.ptp(y, axis=0), STILL, 1.0)
        size = np.where(np.isfinite(size), size, np.inf)
        chosen = np.argmin(size, axis=0)
        best = np.where(size[chosen, lane] < least, guesses[:, chosen, lane], best)
        least = np.minimum(least, size[chosen, lane])
    return best


def noise_of(y):
    """The noise of each record as its second differences tell it, shape (L,): what motion adds to them is small.

    Examples
    --------
    >>> y = np.linspace(0, 1, 5000)**2 + 0.01 * np.random.default_rng(1).standard_normal(5000)
    >>> print(noise_of(y[:, None]).round(3))
    [0.01]
    """
    return np.sqrt(np.median(np.diff(y, 2, axis=0) ** 2, axis=0) / (6 * 0.4549)) + LEAST


def _counted(motion, y, found, rest, scales, quantum, weights, freedom, low):
    """The fit of counts: by their own likelihood in dither, else as numbers, a run of one count being one."""
    dithered = spread(rest, quantum) >= DITHERED * quantum
    weights, sigma = np.where(dithered, 1.0, weights), np.inf
    for _ in range(ROUNDS[1]):
        before = sigma
        plain = np.sqrt(np.sum(weights * rest**2, axis=0) / np.maximum(freedom, 1))
        sigma = np.where(dithered, spread(rest, quantum), np.maximum(plain, quantum / 12**0.5))
        if np.all(np.abs(sigma - before) < SAME * sigma):
            break
        found, rest = _scored(motion, y, found, scales, sigma, quantum, weights, dithered, low)
    whole = np.where(dithered, len(y) - len(found), freedom)
    sigma = np.where(dithered, sigma * np.sqrt(len(y) / np.maximum(whole, 1)), sigma)
    return _finished(motion, y, found, scales, sigma, quantum, weights, whole, dithered, low)


def _scored(motion, y, start, scales, sigma, quantum, weights, counted, low):
    """Climb to the likelihood's top with sigma given; return parameters and residuals."""
    near = low[:, None] + STEP * scales  # at its bound: differences reach beyond it
    at, damping = np.maximum(start, low[:, None]), np.full(y.shape[1], DAMPING)
    rest, slopes = linearised(motion, y, at, scales)
    best = _likelihood(rest, sigma, quantum, weights, counted)
    for _ in range(STEPS):
        score, info = information(rest, sigma, quantum, counted)
        gradient = np.einsum("npl,nl->lp", slopes, weights * score)
        free = ((at > near) | (gradient.T > 0)).T  # a bound holds what would pass it
        gradient = gradient * free
        fisher = np.einsum("npl,nl,nql->lpq", slopes, weights * info, slopes) * free[:, None] * free[:, :, None]
        diagonal = np.einsum("lpp->lp", fisher)
        braced = fisher + damping[:, None, None] * np.eye(len(at)) * diagonal[:, None]
        step = _solved(braced, gradient[..., None])[..., 0]
        nxt = np.maximum(at + (step * scales.T).T, low[:, None])
        rest_next, slopes_next = linearised(motion, y, nxt, scales)
        now = _likelihood(rest_next, sigma, quantum, weights, counted)
        better = (now >= best) & np.all(np.isfinite(slopes_next), axis=(0, 1))
        done = np.einsum("lp,lp->l", step, gradient) < ENOUGH**2
        at, best = np.where(better, nxt, at), np.where(better, now, best)
        rest, slopes = np.where(better, rest_next, rest), np.where(better, slopes_next, slopes)
        damping = np.clip(damping * np.where(better, EASED, BRACED), 1e-12, 1e12)
        if np.all(done | (damping > 1e5)):
            break
    return at, rest


def linearised(motion, y, at, scales):
    """Residuals, shape (N, L), and slopes of the motion by its parameters over their scales, (N, P, L)."""
    count = len(at)
    offsets = np.concatenate([np.zeros((1, count)), np.eye(count), -np.eye(count)]) * STEP
    with np.errstate(all="ignore"):  # a step may go where nothing is finite, and is not taken then
        runs = motion(at[:, None] + offsets.T[:, :, None] * scales[:, None])
        return y - runs[:, 0], (runs[:, 1 : count + 1] - runs[:, count + 1 :]) / (2 * STEP)


def _likelihood(rest, sigma, quantum, weights, counted):
    with np.errstate(all="ignore"):
        return np.sum(weights * log_likelihood(rest, sigma, quantum, counted), axis=0)


def _solved(matrix, right):
    """Solve each record's equations; a parameter that moves nothing stays where it is."""
    diagonal = np.einsum("lpp->lp", matrix)
    scale = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    even = matrix / (scale[:, :, None] * scale[:, None, :])
    return np.linalg.pinv(even, rcond=1e-15, hermitian=True) @ (right / scale[..., None]) / scale[..., None]


def _finished(motion, y, found, scales, sigma, quantum, weights, freedom, counted, low):
    rest, slopes = linearised(motion, y, found, scales)
    score, info = information(rest, sigma, quantum, counted)
    fisher = np.einsum("npl,nl,nql->lpq", slopes, weights * info, slopes)
    covariance = _solved(fisher, np.broadcast_to(np.eye(len(found)), fisher.shape))
    gradient = np.einsum("npl,nl->lp", slopes, weights * score)
    held = ((found <= low[:, None] + STEP * scales) & (gradient.T < 0)).T
    free = np.where(held, 0.0, gradient)
    left = np.einsum("lp,lpq,lq->l", free, covariance, free)
    step = np.einsum("lpq,lq->lp", covariance, gradient)
    if quantum and not np.all(counted):
        covariance = np.where(
            counted[:, None, None], covariance, rounding_covariance(y, rest, slopes, covariance, quantum, spread(rest, quantum))
        )
    error = np.sqrt(np.maximum(np.einsum("lpp->lp", covariance), 1e-300))
    beyond = np.where(held, -step / error, 0.0).T
    stretched = covariance * scales.T[:, :, None] * scales.T[:, None, :]
    return Fitted(found, stretched, sigma, rest, freedom, counted, left < SETTLED, _blind(fisher), beyond)


def _blind(fisher):
    """The direction that the information leaves out, shape (L, P); zeros where it leaves out none."""
    size = np.sqrt(np.maximum(np.einsum("lpp->lp", fisher), 1e-300))
    told, directions = np.linalg.eigh(fisher / (size[:, :, None] * size[:, None, :]))
    away = directions[:, :, 0] / size
    away = away / np.abs(away).max(axis=1, keepdims=True)
    return np.where((told[:, 0] < BLIND)[:, None], away, 0.0)
