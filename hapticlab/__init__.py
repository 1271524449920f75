"""hapticlab: from a student's equations of motion to a felt wall, on a simulated or a real 1-DOF haptic paddle."""

from .compiler.lower import compile
from .errors import HapticlabError
from .scene.laws import force_filter, predicted_sample, virtual_coupler, virtual_damper, wall
from .scene.scene import Scene
from .scene.symbols import T, coordinate, delay, n, parameters, signal, t, v, when, x

__version__ = "0.1.0"

__all__ = [
    "HapticlabError", "Scene", "T", "compile", "coordinate", "delay", "force_filter", "n", "parameters",
    "predicted_sample", "signal", "t", "v", "virtual_coupler", "virtual_damper", "wall", "when", "x",
]  # fmt: skip
