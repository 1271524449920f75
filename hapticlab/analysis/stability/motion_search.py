"""Search of closed motions: coarse ones first, then the best of them with single positions and whole stretches shifted."""

import itertools

import numpy as np

#: positions of a motion are told apart by this part of the reach, and so are the two sides of a switch
GRAIN = 1e-4
#: motions of one length that are tried at once, at most, and coarse ones that are drawn
MOST, DRAWN = 50_000, 1000
#: the best motions of one length, from which longer ones are made
KEPT = 60
#: what stretches of a motion are shifted by, as parts of the reach
SHIFTS = np.outer([1, -1], [0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003]).ravel()
#: of how many motions of one length stretches are shifted; of longer ones than so many samples, of the best alone
SHIFTED, LONG = 4, 12
#: how many lengths of stretches, from one position to all but one
STRETCHES = 8
#: numbers of samples that are looked at
LENGTHS = (*range(2, 13), 16, 24, 32, 48, 64)
#: a coarse position beside a switch, as a part of the reach
BESIDE = 0.15
#: a motion is better by this part, and as good within this part of the best
BETTER, EQUAL = 3e-5, 1e-6


class MotionSearch:
    """Motions about one place, within a reach.

    Parameters
    ----------
    score : callable
        Of positions [m], shape (P, L): what is sought, the larger the better, finite, shape (L,).
    about, reach : float
        [m]
    surfaces : sequence of float
        Positions [m] at which the force may switch; both sides of each are tried.
    parts : int
        Positions per sample.
    seed : int
        Of the motions that are drawn.
    most : int
        Motions of one length that are tried at once.

    Attributes
    ----------
    tried : int
        Motions so far.
    """

    def __init__(self, score, about, reach, surfaces, parts, seed, most=MOST):
        self.score, self.about, self.reach, self.parts, self.most = score, about, reach, parts, most
        self.random, self.tried = np.random.default_rng(seed), 0
        sides = [(surface - about) / reach + side for surface in surfaces for side in (-BESIDE, -GRAIN / 2, GRAIN / 2, BESIDE)]
        self.letters = np.unique(np.clip([-1, -1 / 3, *sides, 1 / 3, 1], -1, 1))

    def best_of(self, samples, known=()):
        """Yield the best motion found of each number of samples, positions [m]; ``known`` are motions to begin with."""
        best = np.empty((0, 0))
        for size in (self.parts * n for n in LENGTHS if n <= samples):
            begin = [(x[:, None] - self.about) / self.reach for x in known if len(x) == size]
            starts = np.concatenate([*begin, *self._starts(size, best)], axis=1)
            best = self._best(starts)
            several = SHIFTED if size <= LONG * self.parts else 1
            best[:, :several] = np.stack([self._shifted(shape) for shape in best.T[:several]], axis=1)
            best = self._best(best)
            yield self.place(best[:, 0])

    def place(self, shape):
        """Return positions [m] of a shape within -1 and 1, never on a switch about which it is searched."""
        most = 1 / GRAIN
        return self.about + self.reach * GRAIN * (np.clip(np.floor(shape / GRAIN), -most, most - 1) + 0.5)

    def _scores(self, shapes):
        self.tried += shapes.shape[1]
        return self.score(self.place(shapes))

    def _best(self, shapes):
        """Return the shapes of the largest scores, the best first."""
        scores = self._scores(shapes)
        alike = EQUAL * np.abs(scores[np.isfinite(scores)]).max(initial=1e-300)
        _, first = np.unique(np.round(scores / alike), return_index=True)  # of equally good ones a single one
        return shapes[:, first[::-1][:KEPT]]

    def _starts(self, size, best):
        """Yield coarse motions: all of them where they are few, else what comes of the best shorter ones, and some drawn."""
        if len(self.letters) ** size <= self.most:
            coarse = np.array(list(itertools.product(self.letters, repeat=size))).T
            yield from (coarse, 0.1 * coarse)
            return
        if best.size:
            before, more = np.arange(len(best) + 1) / len(best), size - len(best)
            closed = np.concatenate([best, best[:1]])
            yield np.array([np.interp(np.arange(size) / size, before, x) for x in closed.T]).T  # as large, and slower
            for k in range(len(best)):
                yield np.insert(best, [k] * more, best[k], axis=0)  # a rest
                yield np.insert(best, [k] * more, (best[k] + best[k - 1]) / 2, axis=0)
        phase = 2 * np.pi * np.outer(np.arange(size) / size, np.arange(1, size // 2 + 1))
        yield from (np.cos(phase), 0.5 + 0.5 * np.cos(phase), -0.5 - 0.5 * np.cos(phase))
        yield self.random.choice(self.letters, (size, min(DRAWN, self.most)))

    def _shifted(self, shape):
        """Return a motion that no shift of neighbouring positions, and no letter in place of one, makes better."""
        size, most = len(shape), self._scores(shape[:, None])[0]
        lengths = np.unique(np.geomspace(1, size - 1, STRETCHES).astype(int))
        stretches = np.array([np.roll(np.arange(size) < length, at) for length in lengths for at in range(size)]).T
        shifts = (stretches[:, :, None] * SHIFTS).reshape(size, -1)
        lettered = np.tile(np.eye(size, dtype=bool), len(self.letters)), np.repeat(self.letters, size)
        for _ in range(100):
            tried = np.concatenate([shape[:, None] + shifts, np.where(*lettered, shape[:, None])], axis=1).clip(-1, 1)
            if tried.shape[1] > self.most:
                tried = self.random.choice(tried, self.most, axis=1, replace=False)
            scores = self._scores(tried)
            k = scores.argmax()
            if not (np.isfinite(scores[k]) and scores[k] > most + BETTER * abs(scores[k])):
                break
            shape, most = tried[:, k], scores[k]
        return shape
