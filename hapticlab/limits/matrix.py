"""Exact motion of a linear plant under a held force; the only place of the limits where scipy opens."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..annotations import Array


def held(A: Array, duration: float) -> tuple[Array, Array]:
    """Return Phi = e^(A h) and Psi, the integral of e^(A s) over 0 <= s <= h, with Phi = I + A Psi.

    Parameters
    ----------
    A : array of shape (n, n)
        In units of time in which A h is of order one, so that no entry is lost beside another.
    duration : float
        h, in that unit.

    Returns
    -------
    Phi, Psi : array of shape (n, n)

    Examples
    --------
    >>> Phi, Psi = held(np.array([[0.0, 1.0], [0.0, 0.0]]), 2.0)
    >>> Psi.tolist()
    [[2.0, 2.0], [0.0, 2.0]]
    """
    from scipy.linalg import expm

    n = len(A)
    both = expm(np.block([[A * duration, np.eye(n) * duration], [np.zeros((n, 2 * n))]]))
    return both[:n, :n], both[:n, n:]
