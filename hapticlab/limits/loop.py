"""Handle, hand, delay and a linear law as one sampled loop: its matrix over a period, and its characteristic equation.

Time is counted in periods. Everything is written in w = z - 1, where a slow pole keeps its digits.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..base.arguments import number
from ..device.device import known
from .affine_law import AffineLaw, affine_law
from .limit import MOST_PERIODS, whole_and_fraction

#: |w| below which an eigenvalue's absolute rounding would show, so that it is moved onto the characteristic equation
SLOW = 0.1
#: a pole outside the unit circle by less, per radian and sample, is rounding
OUTSIDE = 1e-12
#: and by so much it is surely outside, or surely inside
CLEAR = 1e-6


@dataclass(frozen=True, eq=False)
class Loop:
    """The sampled loop with time in periods: x[n+1] = Phi x[n] - late F[n-whole] - early F[n-whole-1].

    Attributes
    ----------
    T : float
        [s]
    E : array of shape (2, 2)
        Phi - 1 of handle and hand, on x [m] and v [m per period], without the subtraction.
    determinant : float
        Of E.
    late, early : array of shape (2,)
        Effect [m/N], [m per period per N] of the newer force, and of the older one over the first fraction of the period.
    whole : int
        Whole periods of delay.
    fraction : float
    law : AffineLaw
    scale : float
        M/T^2 + b/T + k [N/m], a stiffness that belongs to the plant.
    """

    T: float
    E: np.ndarray
    determinant: float
    late: np.ndarray
    early: np.ndarray
    whole: int
    fraction: float
    law: AffineLaw
    scale: float

    @classmethod
    def of(cls, device, law, B=0.0, parameter="k"):
        """Return the loop of a Device, a paddle or its profile."""
        m, b, T, delay, hand, velocity = known(device, "m", "b", "T", "delay", "hand", "velocity")
        B = number("B", B, "N s/m", "a virtual damper")
        law = affine_law(law, T=T, B=B, parameter=parameter, velocity=velocity)
        sums = {}
        for name, own, unit in (("m", m, "kg"), ("b", b, "N s/m")):
            added = 0.0 if hand is None else getattr(hand, name)
            sums[name] = number(name, own + added, unit, "a handle with its hand", least=0)
        M = number("m", sums["m"], "kg", "the handle", above=0, what="a mass m")
        k = 0.0 if hand is None else number("hand k", hand.k, "N/m", least=0, what="k")
        whole, f = whole_and_fraction(delay, T, most=MOST_PERIODS)
        A = np.array([[0.0, 1.0], [-k * T**2 / M, -sums["b"] * T / M]])
        force = np.array([0.0, T**2 / M])
        (Phi_rest, Psi_rest), Psi = held(A, 1 - f), held(A, 1.0)[1]
        late, early = Psi_rest @ force, Phi_rest @ held(A, f)[1] @ force
        determinant = float(np.linalg.det(A) * np.linalg.det(Psi))
        return cls(T, A @ Psi, determinant, late, early, whole, f, law, M / T**2 + sums["b"] / T + k)

    def difference(self, K):
        """Return one period less the identity on [x, v, F[n-1], ..., states of the law], v in m per period."""
        B, C, D = self.law.at(K)
        forces, states = self.whole + (self.fraction > 0), len(C)
        n = 2 + forces + states
        into, force = np.zeros((states, n)), np.zeros(n)
        into[:, :2], into[:, 2 + forces :] = B / (1.0, self.T), self.law.A
        force[:2], force[2 + forces :] = D / (1.0, self.T), C
        rows = [force, *np.eye(n)[2 : 2 + forces]]  # F[n], F[n-1], ...
        step = np.zeros((n, n))
        step[:2, :2] = self.E
        step[:2] -= np.outer(self.late, rows[self.whole])
        if self.fraction:
            step[:2] -= np.outer(self.early, rows[self.whole + 1])
        for age in range(forces):
            step[2 + age] = rows[age]
        step[2 + forces :] = into
        step[2:] -= np.eye(n)[2:]
        return step

    def matrix(self, K):
        """Return one period as a matrix on [x, v, past forces, states of the law], in SI units."""
        step = self.difference(K) + np.eye(2 + self.whole + (self.fraction > 0) + len(self.law.A))
        step[1] /= self.T  # from metres per period to m/s
        step[:, 1] *= self.T
        return step

    def poles(self, K):
        """Return w = z - 1 of every pole; the slow ones to their own precision, not to that of 1."""
        w = np.linalg.eigvals(self.difference(K)).astype(complex)
        return np.array([self._settled(pole, K) if 1e-14 < abs(pole) < SLOW else pole for pole in w.tolist()])

    def unstable(self, K):
        """Whether a pole lies outside the unit circle."""
        for w in np.linalg.eigvals(self.difference(K)).astype(complex).tolist():
            beyond = _beyond(w)
            if abs(beyond) < CLEAR * abs(w) < CLEAR * SLOW and abs(w) > 1e-14:
                beyond = _beyond(self._settled(w, K))
            if beyond > max(2 * OUTSIDE * abs(w), 1e-13 * (abs(w) < 1e-13)):
                return True
        return False

    def _settled(self, w, K):
        """Move a pole onto the characteristic equation by secant steps; keep it where they lead elsewhere."""

        def value(at):
            p0, p1 = self.characteristic(at)
            return p0 + K * p1

        before, at = w * (1 + 1e-4), w
        f_before, f_at = value(before), value(at)
        for _ in range(6):
            if f_at == f_before or f_at == 0:
                break
            step = -f_at * (at - before) / (f_at - f_before)
            if not abs(at + step - w) < 1e-2 * abs(w):
                return w
            before, f_before, at = at, f_at, at + step
            f_at = value(at)
            if abs(step) < 1e-15 * abs(at):
                break
        return at

    @cached_property
    def plant(self):
        """Return polynomials in w, lowest power first: the denominator, and for x and v their (late, early) parts."""
        E = self.E.tolist()
        denominator = (self.determinant, -E[0][0] - E[1][1], 1.0)
        gains = self.late.tolist(), self.early.tolist()
        x = [(E[0][1] * g[1] - E[1][1] * g[0], g[0]) for g in gains]
        v = [(E[1][0] * g[0] - E[0][0] * g[1], g[1]) for g in gains]
        return denominator, x, v

    @cached_property
    def _law(self):
        """Return the law as polynomials in w; see :func:`numerators`."""
        return numerators(self.law, self.T, 1.0)

    def characteristic(self, w):
        """Return p0 and p1 of p0 + K p1 = 0 at z = 1 + w, a number or an array of them, up to one common factor."""
        denominator, x, v = self.plant
        own, *parts = self._law
        z = 1 + w
        position, velocity = (_at(late, w) + _at(early, w) / z for late, early in (x, v))
        fixed_x, by_K_x, fixed_v, by_K_v = (_at(part, w) for part in parts)
        p0 = _at(denominator, w) * z**self.whole * _at(own, w) + fixed_x * position + fixed_v * velocity
        return p0, by_K_x * position + by_K_v * velocity

    def polynomials(self):
        """Return p0 and p1 as coefficients of powers of z, lowest first, for a first guess of where poles are."""
        denominator, x, v = self.plant
        position, velocity = (np.r_[0, _in_z(late)] + np.r_[_in_z(early), 0] for late, early in (x, v))  # times z
        own, *parts = numerators(self.law, self.T, 0.0)
        p0 = np.convolve(np.r_[np.zeros(self.whole + 1), _in_z(denominator)], own)
        p1 = np.zeros(len(p0))
        for numerator, motion, p in zip(parts, (position, position, velocity, velocity), (p0, p1, p0, p1), strict=True):
            term = np.convolve(numerator, motion)
            p[: len(term)] += term
        return p0, p1


def held(A, duration):
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


def numerators(law, T, shift):
    """Return a law as polynomials in z - shift, lowest power first: det(z - A), and what it multiplies H with.

    The other four belong to x without and by K, then to v [m per period]. Faddeev and LeVerrier's recurrence: sums and
    products only, so that what cancels in a law, as a damper's two samples at rest, cancels exactly.
    """
    n = len(law.A)
    A, M = law.A - shift * np.eye(n), np.eye(n)
    own, adjoint = [1.0], []  # both from the highest power down
    for k in range(1, n + 1):
        adjoint.append(M)
        own.append(-np.trace(A @ M) / k)
        M = A @ M + own[-1] * np.eye(n)
    own = own[::-1]
    found = []
    for column, unit in ((0, 1.0), (1, T)):
        B0, B1 = law.B0[:, column], law.B1[:, column]
        fixed = [law.C0 @ part @ B0 for part in adjoint[::-1]]
        by_K = [law.C1 @ part @ B0 + law.C0 @ part @ B1 for part in adjoint[::-1]]
        for numerator, D in ((fixed, law.D0[column]), (by_K, law.D1[column])):
            full = [a + D * b for a, b in zip([*numerator, 0.0], own, strict=True)]
            found.append(tuple(float(a) / unit for a in full))
    return tuple(own), *found


def _at(c, w):
    """Evaluate by Horner's rule, lowest power first."""
    total = c[-1] + 0 * w
    for a in c[-2::-1]:
        total = total * w + a
    return total


def _beyond(w):
    """Return |z|^2 - 1 at z = 1 + w."""
    return 2 * w.real + abs(w) ** 2


def _in_z(p):
    """Turn a polynomial in w = z - 1 of degree one or two into one in z."""
    shift = np.array([[1, -1, 1], [0, 1, -2], [0, 0, 1]])
    return shift[: len(p), : len(p)] @ p
