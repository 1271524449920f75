"""A linear position law of any memory, as the one thing that every exact bound reads: s' = A s + B x, F = C s + D x."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import choice, number, period
from ..base.shows_itself import ShowsItself
from ..compiler.tick.compile_scene import compile
from ..errors import AnalysisError
from ..scene.laws.taps import LEAD, TAPS
from .plots import plot_law
from .port import static_stiffness, tick_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array
    from ..scene.laws.taps import LawName
    from ..scene.scene import Scene

#: Eq. (23.8), the force filter, on F[n], F[n-1], F[n-2]
FORCE_FILTER = (2.0, -1.5, 0.5)
#: part of the largest weight below which a weight is rounding
ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class LinearLaw(ShowsItself):
    """A force that is a linear function of the positions sampled so far, H(z), from which bounds are computed.

    A law that uses an exact velocity, Eq. (23.3), has no H(z) in position and is not a LinearLaw.

    Attributes
    ----------
    A, B, C : arrays of shape (n, n), (n,), (n,)
        One tick: ``s[n+1] = A s[n] + B x[n]``, ``F[n] = C s[n] + D x[n]``; F in N, x in m.
    D : float
        [N/m]
    T : float
        Sampling period [s].
    name : str

    Examples
    --------
    >>> law = LinearLaw.of("ellis", K=100.0, T=1e-3)
    >>> law.taps().tolist()
    [200.0, -150.0, 50.0]
    >>> print(law)
    ellis, K = 100 N/m: F[n] = 200 x[n] - 150 x[n-1] + 50 x[n-2], T = 1 ms
    """

    A: Array
    B: Array
    C: Array
    D: float
    T: float
    name: str

    def __post_init__(self) -> None:
        T = number("T", self.T, "s", "a sampled law", above=0)
        n = len(np.atleast_1d(self.B))
        for part, shape in (("A", (n, n)), ("B", (n,)), ("C", (n,)), ("D", ())):
            object.__setattr__(self, part, _numbers(self.name, part, getattr(self, part), shape))
        object.__setattr__(self, "T", T)
        object.__setattr__(self, "D", float(self.D))

    @classmethod
    def of(
        cls,
        law: LawName = "zoh",
        *,
        K: float,
        T: float,
        B: float = 0.0,
        velocity_filter: float | None = None,
        filtered: bool = False,
    ) -> LinearLaw:
        """Return a law of the chapter with a virtual damper in parallel.

        Parameters
        ----------
        law : {"zoh", "backward_difference", "ellis"}
            Eqs. (23.1), (23.5), (23.7).
        K : float
            Stiffness [N/m], any finite value.
        T : float
            Sampling period [s], > 0.
        B : float
            Virtual damper of either sign [N s/m], on the backward difference ``(x[n] - x[n-1])/T``.
        velocity_filter : float, optional
            Time constant tau [s] >= 0 of a first-order filter of that difference, by backward mapping:
            ``v[n] = (tau v[n-1] + x[n] - x[n-1]) / (tau + T)``.
        filtered : bool
            The whole force, spring and damper, goes through Eq. (23.8).

        Raises
        ------
        AnalysisError
            For "half_sample", which is not a position law, an unknown law and values out of range.
        """
        choice("law", law, TAPS)
        if LEAD[law]:
            raise AnalysisError(
                f"law {law}, Eq. (23.3), uses the exact velocity, so it is not a position law and has no H(z). With a "
                "velocity estimated by backward difference it is the law backward_difference"
            )
        K = number("K", K, "N/m", what="stiffness")
        T = period(T)
        B = number("B", B, "N s/m", "a virtual damper")
        tau = number("velocity_filter", velocity_filter or 0.0, "s", least=0, what="a time constant")
        name = f"{law}, K = {K:g} N/m" + (f", B = {B:g} N s/m" if B else "")
        found = cls.of_taps(K * np.array(TAPS[law]), T=T) + filtered_damper(B, T, tau)
        if tau and B:
            name += f" of a velocity filtered over {1e3 * tau:g} ms"
        if filtered:
            found, name = found.then(FORCE_FILTER), f"force filter (23.8) of {name}"
        return found.named(name)

    @classmethod
    def of_taps(cls, taps: ArrayLike, *, T: float, name: str = "taps") -> LinearLaw:
        """Return the law F[n] = taps[0] x[n] + taps[1] x[n-1] + ..., one or more finite weights in N/m.

        Parameters
        ----------
        taps : array_like
            Weights [N/m] on x[n], x[n-1], ..., finite, one or more.
        T : float
            Sampling period [s], > 0.
        name : str
            What prints and plots are to call it.
        """
        weights = _numbers(name, "taps", taps, (max(np.size(taps), 1),))
        n = len(weights) - 1
        return cls(np.eye(n, k=-1), np.eye(n, 1)[:, 0], weights[1:].copy(), float(weights[0]), float(T), name)

    @classmethod
    def of_scene(cls, scene: Scene, *, T: float = 1e-3, **options: Any) -> LinearLaw:
        """Return the law that a linear scene compiles to: hold, method and estimator of velocity included.

        Parameters
        ----------
        scene : Scene
            Linear, every parameter bound.
        T : float
            Sampling period [s].
        **options
            Of :func:`hapticlab.compile`: method, substeps, hold.

        Raises
        ------
        AnalysisError
            The scene is not linear, as a wall with a boundary: ``hl.wall(unilateral=None)`` is the law inside it.

        Examples
        --------
        >>> import hapticlab as hl
        >>> wall = hl.wall("backward_difference", unilateral=None)(k=100)
        >>> LinearLaw.of_scene(wall, T=1e-3).taps().round(9).tolist()
        [150.0, -50.0]
        """
        return cls(*tick_map(compile(scene, T=T, live=(), dtype="float64", **options)), float(T), scene.name)

    def plot(self) -> Figure:
        """Return a figure of the equivalent spring and damper of the law for slow and fast sinusoids, the hold included."""
        return plot_law(self)

    def require_period(self, T: float | None) -> None:
        """Refuse a device of another sampling period [s]; None is not known.

        Parameters
        ----------
        T : float or None
            Sampling period of the device [s].
        """
        if T is not None and not abs(self.T - T) <= 1e-9 * T:
            raise AnalysisError(
                f"{self.name} is a law with T = {self.T:g} s, but the paddle samples every {T:g} s. Make the law for that period"
            )

    def named(self, name: str) -> LinearLaw:
        """Return the same law under another name.

        Parameters
        ----------
        name : str
            What prints and plots are to call it.
        """
        return LinearLaw(self.A, self.B, self.C, self.D, self.T, name)

    def __add__(self, other: LinearLaw) -> LinearLaw:
        """Return both forces side by side."""
        if not isinstance(other, LinearLaw):
            raise AnalysisError(f"{self.name} + {other!r}; needs a second LinearLaw, as LinearLaw.of_taps([1.0], T=1e-3)")
        if self.T != other.T:
            raise AnalysisError(f"the laws have T = {self.T:g} s and {other.T:g} s; both need the same sampling period")
        A = np.block([[self.A, np.zeros((len(self.A), len(other.A)))], [np.zeros((len(other.A), len(self.A))), other.A]])
        both = (np.r_[self.B, other.B], np.r_[self.C, other.C], self.D + other.D)
        return LinearLaw(A, *both, self.T, f"{self.name} + {other.name}")

    def __rmul__(self, gain: float) -> LinearLaw:
        """Return the force times a number."""
        return LinearLaw(self.A, self.B, gain * self.C, gain * self.D, self.T, f"{gain:g} x {self.name}")

    def then(self, taps: ArrayLike) -> LinearLaw:
        """Return the law whose force is taps[0] F[n] + taps[1] F[n-1] + ..., as a delay or the filter of Eq. (23.8).

        Parameters
        ----------
        taps : array_like
            Weights without unit on F[n], F[n-1], ...
        """
        after = LinearLaw.of_taps(taps, T=self.T)
        A = np.block([[self.A, np.zeros((len(self.A), len(after.A)))], [np.outer(after.B, self.C), after.A]])
        ends = (np.r_[self.B, after.B * self.D], np.r_[after.D * self.C, after.C], after.D * self.D)
        return LinearLaw(A, *ends, self.T, f"{self.name}, filtered")

    def at(self, theta: ArrayLike) -> NDArray[np.complex128]:
        """Return H(e^(j theta)) [N/m], theta = w T of any shape; complex array of that shape.

        At a pole on the unit circle, as an integrator's at theta = 0, there is no value: inf.

        Parameters
        ----------
        theta : array_like
            Frequency times period, w T [rad], of any shape.
        """
        theta = np.asarray(theta, dtype=float)
        if not len(self.A):
            return np.full(theta.shape, self.D, dtype=complex)
        z = np.exp(1j * theta)[..., None, None]
        gap = z * np.eye(len(self.A)) - self.A
        on_pole = np.abs(np.linalg.det(gap)) == 0
        gap = np.where(on_pole[..., None, None], np.eye(len(self.A)), gap)
        inside = np.linalg.solve(gap, np.broadcast_to(self.B[:, None], (*theta.shape, len(self.B), 1)))[..., 0]
        return np.where(on_pole, np.inf, inside @ self.C + self.D)

    def impulse(self, count: int) -> Array:
        """Return the first ``count`` forces [N/m] of a handle that was at one metre at the first sample alone.

        Parameters
        ----------
        count : int
            Number of samples, >= 1.
        """
        forces, state = [self.D], self.B
        for _ in range(count - 1):
            forces.append(float(self.C @ state))
            state = self.A @ state
        return np.array(forces[:count])

    @property
    def finite(self) -> bool:
        """Whether the force depends on finitely many past positions."""
        n = len(self.A)
        response = np.abs(self.impulse(2 * n + 1))  # n + 1 terms of zero in a row: all that follow are (Cayley, Hamilton)
        return bool(response[n + 1 :].max(initial=0.0) <= ROUNDING * response.max())

    def taps(self) -> Array:
        """Return the weights [N/m] on x[n], x[n-1], ... of a law with a finite memory, array of shape (m,), m >= 1.

        Raises
        ------
        AnalysisError
            The impulse response does not end, as with a filtered velocity; use :meth:`impulse` or :meth:`at`.
        """
        if not self.finite:
            raise AnalysisError(f"{self.name}: its impulse response does not end, so it has no finite taps. Use .impulse(count)")
        response = self.impulse(len(self.A) + 1)
        kept = np.flatnonzero(np.abs(response) > ROUNDING * np.abs(response).max())
        return response[: kept[-1] + 1] if len(kept) else response[:1]

    @property
    def stiffness(self) -> float:
        """Force per displacement at rest [N/m], H(1); nan if a handle at rest has no single force."""
        return static_stiffness(self.A, self.B, self.C, self.D)

    @property
    def radius(self) -> float:
        """Largest magnitude of a pole with the handle held; 0 for a law of finite memory."""
        return float(np.abs(np.linalg.eigvals(self.A)).max()) if len(self.A) and not self.finite else 0.0

    def __str__(self) -> str:
        if self.finite and len(taps := self.taps()) <= 6:
            terms = [f"{abs(a):.6g} x[n{'' if k == 0 else f'-{k}'}]" for k, a in enumerate(taps)]
            signs = [" - " if a < 0 else " + " for a in taps]
            force = ("-" if taps[0] < 0 else "") + terms[0] + "".join(s + f for s, f in zip(signs[1:], terms[1:], strict=True))
            return f"{self.name}: F[n] = {force}, T = {1e3 * self.T:g} ms"
        stiffness = "none" if math.isnan(self.stiffness) else f"{self.stiffness:.6g} N/m"
        return f"{self.name}: {len(self.A)} states, stiffness at rest {stiffness}, T = {1e3 * self.T:g} ms"


def _numbers(name, part, given, shape):
    """Return an array of this shape, or say what was given."""
    try:
        array = np.array(given, dtype=float)
    except (TypeError, ValueError):
        array = np.array(math.nan)
    if array.ndim == 0 and shape == (1,):
        array = array.reshape(1)
    if array.shape != shape or not np.isfinite(array).all():
        need = "a finite number" if not shape else f"finite numbers, {' x '.join(map(str, shape))} of them"
        raise AnalysisError(f"{name}: {part} = {given}; needs {need}")
    return array


def filtered_damper(B: float, T: float, tau: float = 0.0) -> LinearLaw:
    """Return the virtual damper B [N s/m] on the backward difference, filtered over tau [s] by backward mapping."""
    if not B:
        return LinearLaw.of_taps([0.0], T=T)
    if not tau:
        return LinearLaw.of_taps([B / T, -B / T], T=T, name="damper")
    decay, gain = tau / (tau + T), B / (tau + T)  # F[n] = decay F[n-1] + gain (x[n] - x[n-1])
    return LinearLaw(np.array([[decay]]), np.array([gain * (decay - 1)]), np.array([1.0]), gain, T, "filtered damper")
