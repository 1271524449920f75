"""Maximum likelihood of right answers at several levels, for many sets of answers at once."""

import math

import numpy as np

from .response_curves import Psychometric, rise

#: lapses looked for, at most: the bound of Wichmann and Hill, who show that a fit without lapses is biased
MOST_LAPSES = 0.06
#: slopes looked for
SLOPES = (0.2, 20.0)
#: probabilities nearer to 0 and 1 than this are rounding, not certainty
CERTAIN = 1e-9
STEPS = 200
#: an interval's end is looked for on so many grids of so many values, each between two of the one before
FINER, GRID = 4, 17


class Likelihood:
    """Likelihood of counts at these levels, over place, log slope and, where it is fitted, lapse.

    Parameters
    ----------
    levels, trials : array, shape (N,)
    shape : {"d_prime", "weibull", "normal"}
    guess, lapse, slope : float or None
        None: a guess as large as the lapse; a lapse and a slope that are fitted.
    """

    def __init__(self, levels, trials, shape, guess, lapse, slope=None):
        self.levels, self.trials, self.shape, self.guess, self.lapse = levels, trials, shape, guess, lapse
        if shape == "normal":
            width = np.ptp(levels)
            places, slopes = (levels.min() - width, levels.max() + width), (0.2 / width, 50 / width)
        else:
            felt = levels[levels > 0]
            places, slopes = (math.log(felt.min() / 5), math.log(felt.max() * 5)), SLOPES
        slopes = slopes if slope is None else (slope, slope)
        bounds = [places, tuple(math.log(s) for s in slopes)] + ([(0.0, MOST_LAPSES)] if lapse is None else [])
        self.low, self.high = np.array(bounds).T

    def chance(self, q):
        """P and its derivatives at parameters q, shapes (..., N) and (..., N, parameters)."""
        F, *slopes = rise(self.shape, self.levels, q[..., :1], q[..., 1:2])
        lapse = q[..., 2:3] if self.lapse is None else self.lapse
        guess = lapse if self.guess is None else self.guess
        steps = [(1 - guess - lapse) * s for s in slopes]
        if self.lapse is None:
            steps.append(1 - 2 * F if self.guess is None else -F)
        return np.clip(guess + (1 - guess - lapse) * F, CERTAIN, 1 - CERTAIN), np.stack(steps, -1)

    def loss(self, q, right):
        """Minus the log likelihood, its gradient and Fisher's information, each with one row a set of answers."""
        P, dP = self.chance(q)
        wrong = self.trials - right
        pull = right / P - wrong / (1 - P)
        information = np.einsum("...n,...ni,...nj->...ij", self.trials / (P * (1 - P)), dP, dP)
        loss = -(right * np.log(P) + wrong * np.log1p(-P)).sum(-1)
        return loss, -np.einsum("...n,...ni->...i", pull, dP), information

    def saturated(self, right):
        """Minus the log likelihood of a free proportion at each level."""
        part = right / self.trials
        with np.errstate(divide="ignore", invalid="ignore"):
            terms = right * np.log(part), (self.trials - right) * np.log1p(-part)
        return -sum(np.nan_to_num(a, nan=0.0).sum(-1) for a in terms)

    def most_likely(self, right, start, low=None, high=None):
        """Climb by Fisher's scoring, damped as Levenberg and Marquardt do, inside the bounds.

        Parameters
        ----------
        right : array, shape (sets, N)
        start : array, shape (sets, parameters)
        low, high : array, shape (sets, parameters), optional
            Bounds of each set; a parameter between equal ones stays.

        Returns
        -------
        array, shape (sets, parameters), and the losses
        """
        low, high = self.low if low is None else low, self.high if high is None else high
        q = np.clip(start, low, high)
        damping = np.full(len(q), 1e-3)
        loss, gradient, information = self.loss(q, right)
        for _ in range(STEPS):
            held = ((q <= low) & (gradient > 0)) | ((q >= high) & (gradient < 0))
            moved = np.clip(q + _step(gradient, information, damping, held), low, high)
            its_loss, its_gradient, its_information = self.loss(moved, right)
            better = its_loss < loss
            small = np.abs((gradient * (moved - q)).sum(-1)) < 1e-12  # what it could gain
            q[better], loss[better], gradient[better] = moved[better], its_loss[better], its_gradient[better]
            information[better] = its_information[better]
            damping = np.where(better, damping / 5, damping * 5)
            if (small | (damping > 1e9)).all():
                break
        return q, loss

    def ratios(self, right, q, losses):
        """2 log of the likelihood ratio between the best and the best with place, or log slope, as in q.

        Parameters
        ----------
        right : array, shape (sets, N)
        q : array, shape (parameters,)
        losses : array, shape (sets,)
            The least ones.

        Returns
        -------
        array, shape (sets, 2)
        """
        found = []
        for held in (0, 1):
            low, high = np.tile(self.low, (len(right), 1)), np.tile(self.high, (len(right), 1))
            low[:, held] = high[:, held] = q[held]
            found.append(2 * (self.most_likely(right, np.tile(q, (len(right), 1)), low, high)[1] - losses))
        return np.column_stack(found)

    def intervals(self, right, best, most):
        """The least and the largest place and log slope with 2 log(L(best)/L) of at most ``most``.

        Each end is the outermost value of a grid that is likely enough, looked for again just beyond it, on ever finer grids.

        Parameters
        ----------
        right : array, shape (N,)
        best : array, shape (parameters,)
            The most likely ones.
        most : array, shape (2,)
            For each.

        Returns
        -------
        array, shape (2, 2)
            One row a parameter.
        """
        least = self.loss(best[None], right[None])[0][0]
        held, ends = np.array([0, 0, 1, 1]), np.arange(4)
        inside, outside = best[held], np.column_stack([self.low, self.high])[:2].ravel()
        for _ in range(FINER):
            values = np.linspace(inside, outside, GRID)
            likely = 2 * (self._profile(right, best, held, values) - least) <= np.repeat(most, 2)
            likely[0] = True
            last = GRID - 1 - np.argmax(likely[::-1], axis=0)
            inside, outside = values[last, ends], values[np.minimum(last + 1, GRID - 1), ends]
        return inside.reshape(2, 2)

    def _profile(self, right, best, held, values):
        """The least loss with parameter ``held[j]`` at ``values[i, j]``, shape (GRID, 4)."""
        middle = np.where(np.arange(len(best)) < 2, (self.low + self.high) / 2, best)
        starts = np.stack([np.broadcast_to(q, (*values.shape, len(best))) for q in (best, middle)])
        low, high = np.broadcast_to(self.low, starts.shape).copy(), np.broadcast_to(self.high, starts.shape).copy()
        for j, which in enumerate(held):
            low[:, :, j, which] = high[:, :, j, which] = values[:, j]
        flat = [a.reshape(-1, len(best)) for a in (starts, low, high)]
        losses = self.most_likely(np.tile(right, (len(flat[0]), 1)), *flat)[1]
        return losses.reshape(2, *values.shape).min(0)

    def starts(self):
        """Parameters all over the bounds, one row each."""
        inside = [np.linspace(low, high, 7)[1:-1:2] for low, high in zip(self.low[:2], self.high[:2], strict=True)]
        inside += [[0.01]] if self.lapse is None else []
        return np.array(np.meshgrid(*inside)).reshape(len(inside), -1).T

    def curve(self, q):
        """The psychometric function of parameters q."""
        lapse = float(q[2]) if self.lapse is None else self.lapse
        threshold = float(q[0]) if self.shape == "normal" else math.exp(q[0])
        return Psychometric(threshold, math.exp(q[1]), lapse if self.guess is None else self.guess, lapse, self.shape)


def _step(gradient, information, damping, held):
    """The damped step of each set; a parameter held by its bound stays."""
    diagonal = np.einsum("...ii->...i", information)
    matrix = information + (damping[:, None] * diagonal + 1e-12 * diagonal.max(-1, keepdims=True) + 1e-300)[:, :, None] * np.eye(
        gradient.shape[-1]
    )
    free = ~held
    matrix = np.where(free[:, :, None] & free[:, None, :], matrix, np.eye(gradient.shape[-1]))
    return np.linalg.solve(matrix, np.where(free, -gradient, 0.0)[..., None])[..., 0]
