"""Every law that renders one and the same wall, by name: of the chapter, of its model-based section, and of a real damper."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import sympy as sp

from ..base.arguments import choice, what_is
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from ..scene.laws.chapter_laws import wall
from ..scene.laws.taps import SPRING_LAWS
from ..scene.notation.symbols import T, n, parameters, x
from ..scene.scene import Scene
from .deadbeat import Pairs, deadbeat_wall
from .digital import digital_wall
from .predictive import predictive_wall

if TYPE_CHECKING:
    from ..device.simulated.simulated_paddle import SimulatedPaddle


@dataclass(frozen=True)
class WallLaw(ShowsItself):
    """A wall as a law renders it, and the paddle it needs.

    Attributes
    ----------
    name : str
    scene : Scene
    paddle : SimulatedPaddle
        The paddle given, but for "damped", which puts a damper of K T/2 on it.
    """

    name: str
    scene: Scene
    paddle: SimulatedPaddle

    def __str__(self) -> str:
        return f"{self.name}: {LAWS[self.name]}\n  {self.scene.name} on {self.paddle}"


@dataclass(frozen=True, kw_only=True)
class Rendering(ShowsItself):
    """Common settings of the laws in a comparison.

    Parameters
    ----------
    model : SimulatedPaddle, optional
        What a model-based law believes; the paddle itself unless given.
    unilateral : {"gate", "clip"}
        Of the chapter's laws; the others act where the handle is, or is predicted, inside.
    clamp : bool
        Never pull; a dead-beat pair is not clamped.
    velocity : "model", optional
        Of the model-based laws.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.design.Rendering(clamp=True).unilateral
    'gate'
    """

    model: SimulatedPaddle | None = None
    unilateral: Literal["gate", "clip"] = "gate"
    clamp: bool = False
    velocity: Literal["model"] | None = None

    def options(self) -> dict[str, Any]:
        """The options of :func:`wall_law`."""
        return dict(vars(self))


def _deadbeat(begins, between):
    pairs = Pairs(begins=begins, between=between)
    return lambda model, clamp, **options: deadbeat_wall(model, pairs=pairs, **options)


#: name -> the law in the words of a table, and the scene of a wall by it
MODEL_LAWS = {
    "digital": ("poles of the wall, in the digital domain", digital_wall),
    "predictive": ("half a sample by the model", predictive_wall),
    "deadbeat": ("dead-beat pairs inside and at foreseen crossings", _deadbeat("predictive", "pairs")),
    "deadbeat_reactive": ("dead-beat pairs inside and after crossings", _deadbeat("reactive", "pairs")),
    "deadbeat_crossings": (
        "half a sample by the model, dead-beat pairs at foreseen crossings", _deadbeat("predictive", "half_sample")
    ),
}  # fmt: skip
#: name -> the law in the words of a table
LAWS = {
    **{str(name): law.says for name, law in SPRING_LAWS.items()},
    "damped": "Eq. (23.1), with a damper K T/2 on the paddle and B = -K T/2 everywhere",
    **{name: says for name, (says, _) in MODEL_LAWS.items()},
}

RENDERING = Rendering()


def _damper():
    """Return a virtual damper of either sign that acts everywhere, by backward difference."""
    return parameters("B", units="N*s/m", ranges=(-math.inf, math.inf)) * (x(n) - x(n - 1)) / T


def checked_laws(laws):
    """Return names of :data:`LAWS` as a tuple, one name alone too, or say which is none."""
    names = tuple(laws) if isinstance(laws, Iterable) and not isinstance(laws, str) else (laws,)
    for name in names:
        if not isinstance(name, str) or name not in LAWS:
            given = repr(name) if isinstance(name, str) else what_is(name)
            raise AnalysisError(f"laws contain {given}; needs names of {', '.join(LAWS)}. For a scene, use hl.stability.wall_map")
    if not names:
        raise AnalysisError(f"laws = {laws!r}; needs one or more of {', '.join(LAWS)}")
    return names


def wall_law(
    name: str,
    paddle: SimulatedPaddle,
    *,
    K: float,
    model: SimulatedPaddle | None = None,
    unilateral: Literal["gate", "clip"] = "gate",
    clamp: bool = False,
    velocity: Literal["model"] | None = None,
) -> WallLaw:
    """Return a wall of stiffness K as a law of that name renders it.

    Parameters
    ----------
    name : str
    paddle : SimulatedPaddle
    K : float
        [N/m]
    model : SimulatedPaddle, optional
        What a model-based law believes; the paddle unless given.
    unilateral : {"gate", "clip"}
        Of the chapter's laws; the others act where the handle is, or is predicted, inside.
    clamp : bool
        Never pull; a dead-beat pair is not clamped.
    velocity : "model", optional
        Of the model-based laws.

    Returns
    -------
    WallLaw

    Examples
    --------
    >>> import hapticlab as hl
    >>> law = hl.laws.wall_law("damped", hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), K=400)
    >>> round(law.paddle.b, 9)
    0.3
    """
    choice("law", name, LAWS)
    if name in SPRING_LAWS:
        return WallLaw(name, wall(SPRING_LAWS[name], unilateral=unilateral, clamp=clamp)(k=K), paddle)
    if name == "damped":
        added = K * paddle.T / 2
        plain = wall("zoh", unilateral=unilateral, clamp=clamp)
        scene = Scene(plain.force.xreplace({plain.parameters["B"]: sp.S.Zero}) + _damper(), name="damped wall")
        return WallLaw(name, scene(k=K, B=-added), replace(paddle, b=paddle.b + added))
    made = MODEL_LAWS[name][1]
    scene = made(model or paddle, K=K, clamp=clamp, velocity=velocity, force_max=paddle.force_max)
    return WallLaw(name, scene, paddle)
