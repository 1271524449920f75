"""What a tick is traced from: a scene, its equations, and the options that it is compiled with."""

from __future__ import annotations

from dataclasses import dataclass

from ...scene.explicit import ExplicitForm
from ...scene.scene import Scene
from ..algebra.graph import Graph
from ..methods.chosen_method import ChosenMethod


@dataclass(frozen=True)
class Options:
    """What a scene is compiled with, each option checked; :func:`hapticlab.compile` describes them."""

    method: ChosenMethod
    T: float
    substeps: int = 1
    hold: str = "soh"
    dtype: str = "float32"
    velocity: str = "backward_difference"
    live: tuple | None = None
    force_at: str = "before"


@dataclass(frozen=True)
class Source:
    """What a tick is traced from.

    Attributes
    ----------
    scene : Scene
    form : ExplicitForm
        What declared ranges left of its equations.
    options : Options
    fixed : dict name -> float
        The parameters that are constants of the program.
    graph : Graph
        Of the form's expressions, with these constants.
    """

    scene: Scene
    form: ExplicitForm
    options: Options
    fixed: dict
    graph: Graph
