"""hapticlab: from an equation of motion to a felt virtual wall.

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
>>> log = paddle.run(hl.wall()(k=150, x_o=0.01), duration=0.5)
>>> float(hl.passivity_limit(b=0.1, T=1e-3))
200.0
"""

from .analysis.chatter import chatter
from .analysis.energy import energy
from .analysis.passivity import passivity_limit
from .analysis.plots import plot
from .analysis.stability import stability_limit
from .analysis.sweep import sweep
from .compiler.lower import compile
from .device.hand import Hand
from .device.paddle import Paddle
from .device.profiles import profile
from .device.simulated import SimulatedPaddle
from .errors import (
    AnalysisError,
    EngineMissingError,
    HapticlabError,
    MassError,
    PaddleError,
    ParameterError,
    ProgramError,
    ProgramLimitError,
    SceneError,
    SignalError,
    UnitsError,
)
from .records import PaddleProfile, Telemetry
from .scene.laws import force_filter, predicted_sample, virtual_coupler, virtual_damper, wall
from .scene.scene import Scene
from .scene.symbols import T, coordinate, delay, n, parameters, signal, t, v, when, x

__version__ = "0.1.0"

__all__ = [
    "AnalysisError",
    "EngineMissingError",
    "Hand",
    "HapticlabError",
    "MassError",
    "Paddle",
    "PaddleError",
    "PaddleProfile",
    "ParameterError",
    "ProgramError",
    "ProgramLimitError",
    "Scene",
    "SceneError",
    "SignalError",
    "SimulatedPaddle",
    "T",
    "Telemetry",
    "UnitsError",
    "chatter",
    "compile",
    "coordinate",
    "delay",
    "energy",
    "force_filter",
    "n",
    "parameters",
    "passivity_limit",
    "plot",
    "predicted_sample",
    "profile",
    "signal",
    "stability_limit",
    "sweep",
    "t",
    "v",
    "virtual_coupler",
    "virtual_damper",
    "wall",
    "when",
    "x",
]
