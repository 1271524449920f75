"""Linear parts of a scene: recognised, told in numbers, and advanced exactly.

Where the equations of motion are linear in the states, with coefficients that nothing changes while the scene runs, and
the handle moves as a polynomial between two samples, the motion over a period is a matrix product. It has no step error
at any stiffness. Van Loan (1978), in :mod:`hapticlab.compiler.algebra.matrix_exponential`.
"""

from dataclasses import dataclass

import numpy as np

from ...scene.notation.symbols import t
from ..algebra.matrix_exponential import held

#: how much rounding may grow where modes are kept in place of states
WORST_MODES = 1e3


@dataclass(frozen=True)
class Linear:
    """``M a = K [q, q', s] + B [x, v] + rest``, in numbers; ``rest`` is what stays the same between two samples.

    Attributes
    ----------
    coordinates : tuple of sympy expressions, shape (N,)
        Those of second order first.
    orders : tuple of int, shape (N,)
    M : array of shape (N, N)
    K : array of shape (N, S)
        S = 2 for every coordinate of second order, 1 for every other.
    B : array of shape (N, 2)
    """

    coordinates: tuple
    orders: tuple
    M: np.ndarray
    K: np.ndarray
    B: np.ndarray

    @property
    def states(self):
        """Positions, their rates, then states of first order, shape (S,)."""
        return states_of(self.coordinates, self.orders)

    @property
    def A(self):
        """Rates of the states by the states, shape (S, S)."""
        return self._rates(self.K, np.eye(len(self.states))[self.seconds : 2 * self.seconds])

    @property
    def inputs(self):
        """Rates of the states by x and v of the handle, shape (S, 2)."""
        return self._rates(self.B, np.zeros((self.seconds, 2)))

    @property
    def rest(self):
        """Rates of the states by the rest of each equation, shape (S, N)."""
        return self._rates(np.eye(len(self.M)), np.zeros((self.seconds, len(self.M))))

    @property
    def seconds(self):
        """How many coordinates are of second order."""
        return self.orders.count(2)

    def _rates(self, forces, of_positions):
        return np.vstack([of_positions, np.linalg.solve(self.M, forces)])

    @property
    def space(self):
        """The motion of the states as they are."""
        return Space(np.eye(len(self.states)), self.A, self.inputs, self.rest, self.seconds)

    @property
    def modes(self):
        """The motion in modes, each a real state or an oscillating pair; None where modes are too near each other.

        Those of a free mass are, and of critical damping.
        """
        if not self.states:
            return None
        size = self.space.scale(np.inf)
        values, vectors = np.linalg.eig(self.A * size[None, :] / size[:, None])
        columns, L = [], np.zeros_like(self.A)
        for value, column in zip(values, vectors.T, strict=True):
            if value.imag < 0:
                continue  # the other half of a pair
            largest = column[np.abs(column[: self.seconds or None] if value.imag else column).argmax()]
            column = column * np.conj(largest) / abs(largest) if largest else column
            k, both = len(columns), [column.real, column.imag] if value.imag else [column.real]
            L[k : k + 2, k : k + 2] += [[value.real, value.imag], [-value.imag, value.real]] if value.imag else 0.0
            L[k, k] = value.real
            columns += both
        V = np.column_stack(columns)
        if V.shape != self.A.shape or np.linalg.cond(V) > WORST_MODES:
            return None
        V[np.abs(V) < 1e-12] = 0.0
        V = V * size[:, None]
        back = np.linalg.inv(V)
        return Space(V, L, back @ self.inputs, back @ self.rest, 0)


@dataclass(frozen=True)
class Space:
    """``w' = A w + inputs [x, v] + rest``, the states y = V w.

    Attributes
    ----------
    V, A : array of shape (S, S)
    inputs : array of shape (S, 2)
    rest : array of shape (S, N)
    seconds : int
        Of w, so many are positions, and as many after them their rates.
    """

    V: np.ndarray
    A: np.ndarray
    inputs: np.ndarray
    rest: np.ndarray
    seconds: int

    @property
    def is_plain(self):
        """Whether w are the states themselves."""
        return np.array_equal(self.V, np.eye(len(self.V)))

    def scale(self, h):
        """Sizes beside each other: 1 of a position, the highest frequency or 1/h of its rate."""
        two = self.seconds
        frequency = max(1 / h, np.sqrt(np.abs(self.A[two : 2 * two, :two]).max(initial=0.0))) or 1.0
        return np.r_[np.ones(two), np.full(two, frequency), np.ones(len(self.A) - 2 * two)]

    def over(self, h):
        """(Phi, [Psi_0, Psi_1, Psi_2]) of :func:`~hapticlab.compiler.algebra.matrix_exponential.held` over h seconds."""
        return held(self.A, h, self.scale(h))


def states_of(coordinates, orders):
    """Positions, their rates, then states of first order, as the stepper orders them."""
    second = [q for q, order in zip(coordinates, orders, strict=True) if order == 2]
    first = [q for q, order in zip(coordinates, orders, strict=True) if order == 1]
    return (*second, *(q.diff(t) for q in second), *first)
