"""A linear law whose force is affine in its stiffness, F = F0 + K F1: what a limit over K and a root locus are taken of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.arguments import choice
from ..compiler.engines.engine import load
from ..compiler.tick.compile_scene import compile
from ..errors import AnalysisError
from ..scene.laws.taps import LEAD, TAPS, LawName
from ..scene.scene import Scene
from .linear_law import LinearLaw
from .port import SMALL, tick_map

if TYPE_CHECKING:
    from ..base.annotations import Array

#: part of the largest entry below which a difference between laws is rounding; a scene's tick is measured to 1e-9
ROUNDING = 1e-8

#: a law whose stiffness is sought
StiffnessLaw = LawName | Scene | Callable[[float], LinearLaw]


@dataclass(frozen=True, eq=False)
class AffineLaw:
    """One tick of a law, ``s' = A s + (B0 + K B1) (x, v)``, ``F = (C0 + K C1) s + (D0 + K D1) (x, v)``, affine in K.

    Attributes
    ----------
    A : array of shape (n, n)
    B0, B1 : array of shape (n, 2)
        For the position [m] and the exact velocity [m/s]; the velocity is zero for all but Eq. (23.3).
    C0, C1 : array of shape (n,)
    D0, D1 : array of shape (2,)
    name : str
    """

    A: Array
    B0: Array
    B1: Array
    C0: Array
    C1: Array
    D0: Array
    D1: Array
    name: str

    def at(self, K: float) -> tuple[Array, Array, Array]:
        """Return B, C, D at a stiffness [N/m]."""
        return self.B0 + K * self.B1, self.C0 + K * self.C1, self.D0 + K * self.D1


def affine_law(
    law: StiffnessLaw | LinearLaw | AffineLaw,
    *,
    T: float,
    B: float = 0.0,
    parameter: str | None = "k",
    velocity: Literal["backward_difference", "measured"] = "backward_difference",
) -> AffineLaw:
    """The given law as an AffineLaw.

    Parameters
    ----------
    law : str, AffineLaw, LinearLaw, Scene or callable
        A name of the chapter's laws; a law that does not depend on K; a linear scene, its stiffness unbound under the
        name ``parameter``; or a function of K [N/m] that returns a LinearLaw.
    T : float
        [s]
    B : float
        Virtual damper [N s/m] beside a named law; the others hold their own.
    parameter : str or None
        None for a scene that is taken with all the values it holds, and then does not depend on K.
    velocity : {"backward_difference", "measured"}
        Where a scene's v(n) comes from, as in :func:`hapticlab.compile`.

    Raises
    ------
    AnalysisError
        The law is not linear, or its force is no affine function of K.
    """
    if isinstance(law, str):
        return _named(law, T, B, velocity)
    if B:
        raise AnalysisError(
            f"B = {B:g} N s/m with {_what(law)}; only a named law has a B of its own. Put the damper into the law"
        )
    if isinstance(law, AffineLaw):
        return law
    if isinstance(law, LinearLaw):
        law.require_period(T)
        A, B0, C0, D0 = _parts(law)
        return AffineLaw(A, B0, 0 * B0, C0, 0 * C0, D0, 0 * D0, law.name)
    if isinstance(law, Scene):
        return _fitted(_of_scene(law, T, parameter, velocity), law.name)
    if not callable(law):
        raise AnalysisError(
            f"law = {law!r}; needs one of {', '.join(TAPS)}, a linear Scene, a LinearLaw or a function of K that returns one"
        )

    def of(K):
        found = law(K)
        if not isinstance(found, LinearLaw):
            raise AnalysisError(f"the law's function gave a {type(found).__name__} at K = {K:g} N/m; needs a LinearLaw")
        found.require_period(T)
        return _parts(found)

    return _fitted(of, getattr(law, "__name__", "law").replace("<lambda>", "law"))


def _named(law, T, B, velocity):
    choice("law", law, TAPS)
    taps, lead = np.array(TAPS[law]), LEAD[law]
    if lead and velocity == "backward_difference":
        taps, lead = np.array([taps[0] + lead, -lead]), 0.0
    damper = np.array([B, -B]) / T if B else np.zeros(1)
    n = max(len(taps), len(damper))
    by_K, fixed = np.zeros(n), np.zeros(n)
    by_K[: len(taps)], fixed[: len(damper)] = taps, damper
    enters = np.zeros((n - 1, 2))
    enters[:1, 0] = 1.0
    ends = (np.array([fixed[0], 0.0]), np.array([by_K[0], lead * T]))
    return AffineLaw(np.eye(n - 1, k=-1), enters, 0 * enters, fixed[1:], by_K[1:], *ends, law)


def _of_scene(scene, T, parameter, velocity):
    """Return a function of K that gives the tick of a scene."""
    free = [name for name in scene.parameters if name not in scene.values]
    if parameter not in (None, *scene.parameters) and free:
        raise AnalysisError(f'{scene.name} has no parameter {parameter}; name its stiffness: parameter="{free[0]}"')
    unbound = [name for name in free if name != parameter]
    if unbound:
        raise AnalysisError(f"{scene.name}: no value for {', '.join(unbound)}; bind it: scene({unbound[0]}=...)")

    def of(K):
        bound = scene(**{parameter: K}) if parameter in scene.parameters else scene
        try:
            program = compile(bound, T=T, live=(), dtype="float64", velocity=velocity)
            return _map_with_velocity(program) if len(program.inputs) > 1 else _map(program)
        except AnalysisError as error:
            raise AnalysisError(f"{error}. Inside its boundary a wall is linear. Write hl.wall(..., unilateral=None)") from error

    return of


def _map(program):
    A, B, C, D = tick_map(program)
    return A, np.c_[B, 0 * B], C, np.array([D, 0.0])


def _map_with_velocity(program):
    """Return A, B, C, D of a tick that takes x and v, from its answers to unit states, x and v; refuse one not linear."""
    S, generator = len(program.states), np.random.default_rng(1)
    mixed = generator.normal(size=(3, S + 2))
    units = np.vstack([np.zeros(S + 2), np.eye(S + 2), mixed, SMALL * mixed])  # a row: states, x, v
    loaded, names = load(program, "interpreter"), [c.name for c in program.inputs]
    answers = []
    for row in units:
        given = dict(zip(("x", "v"), row[S:], strict=True))
        run = loaded.run(1, [[given[name] for name in names]], program.values, row[:S, None])
        answers.append(np.r_[run.states[:, 0], run.outputs[0, 0, 0]])
    answers = np.array(answers) - answers[0]
    whole = answers[1 : S + 3]
    wrong = abs(units[S + 3 :] @ whole - answers[S + 3 :])
    if max(wrong[:3].max(), 1e-3 * wrong[3:].max() / SMALL) > 1e-9 * abs(answers).max(initial=0):
        raise AnalysisError(f"{program.name} is not linear: its answer to two states is not the sum of its answers to each")
    return whole[:S, :S].T, whole[S:, :S].T, whole[:S, S], whole[S:, S]


def _parts(law):
    return law.A, np.c_[law.B, 0 * law.B], law.C, np.array([law.D, 0.0])


def _fitted(of, name):
    """Fit parts that are affine in K to three laws; refuse what is not affine."""
    (A, *one), (_, *two), (other, *three) = (of(K) for K in (1.0, 2.0, 3.0))
    slopes = [b - a for a, b in zip(one, two, strict=True)]
    law = AffineLaw(A, *(v for a, s in zip(one, slopes, strict=True) for v in (a - s, s)), name)
    law = replace(law, **{part: _cleaned(getattr(law, part), one, two) for part in ("B0", "B1", "C0", "C1", "D0", "D1")})
    pairs = [(A, other), *zip(law.at(3.0), three, strict=True)]
    same = all(a.shape == b.shape and np.allclose(a, b, rtol=ROUNDING, atol=ROUNDING * abs(b).max(initial=0)) for a, b in pairs)
    product, squared = law.B1[:, 0], 0.0
    for _ in range(len(A) + 1):  # the part of the impulse response with K squared
        squared, product = max(squared, abs(law.C1 @ product)), A @ product
    if not same or squared > ROUNDING * abs(law.C1).max(initial=0) * abs(law.B1).max(initial=0):
        raise AnalysisError(
            f"{name}: its force is not an affine function F0 + K F1 of the stiffness. Compute its poles for each K instead"
        )
    return law


def _cleaned(array, *near):
    """Make zero what rounding has left of a difference."""
    size = max(abs(a).max(initial=0) for part in near for a in part)
    return np.where(abs(array) > ROUNDING * 1e-3 * size, array, 0.0)


def _what(law):
    return law.name if isinstance(law, (LinearLaw, Scene)) else "a law of its own"
