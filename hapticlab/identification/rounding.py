"""How far rounding to counts that no noise dithers may have led a fit: counted anew, many times."""

import numpy as np

from .sensor import run_weights

#: times that the fitted motion is counted anew
DRAWS = 400


def rounding_covariance(y, rest, slopes, covariance, quantum, noise):
    """The covariance of parameters, over their scales, that a fit of rounded positions finds, shape (L, P, P).

    The rounding of neighbours is alike where the handle is slow, so residuals do not tell how much of it averages out.
    The fitted motion, with constants drawn within ``covariance``, is shifted by a random part of a count, counted, and
    fitted by one linear step.

    Parameters
    ----------
    y, rest : array, shape (N, L)
        Measured positions [m], and those less the fitted ones.
    slopes : array, shape (N, P, L)
    covariance : array, shape (L, P, P)
        About what it will be.
    quantum : float
    noise : array, shape (L,)
        Of the sensor before it counts [m].
    """
    draws, found = np.random.default_rng(0), []
    for lane in range(y.shape[1]):
        size = np.linalg.norm(slopes[:, :, lane], axis=0) + 1e-300
        J = slopes[:, :, lane] / size
        spread = covariance[lane] * np.outer(size, size)
        about = draws.multivariate_normal(np.zeros(len(size)), spread, DRAWS, check_valid="ignore", method="eigh")
        true = (y - rest)[:, lane, None] + J @ about.T + quantum * draws.uniform(-0.5, 0.5, DRAWS)
        seen = quantum * np.round((true + noise[lane] * draws.standard_normal(true.shape)) / quantum)
        weights = run_weights(seen, quantum)
        fisher = (weights.T @ (J[:, :, None] * J[:, None]).reshape(len(J), -1)).reshape(DRAWS, len(size), len(size))
        pull = (weights * (seen - true)).T @ J
        off = (np.linalg.pinv(fisher, rcond=1e-13, hermitian=True) @ pull[..., None])[..., 0] / size
        found.append(off.T @ off / DRAWS)
    return np.array(found)
