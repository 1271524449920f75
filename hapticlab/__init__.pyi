"""The public names and where they live; __init__.py loads each on first use (SPEC 1)."""

from . import (
    bounds,
    contact,
    design,
    devices,
    identify,
    laws,
    library,
    measure,
    mechanics,
    methods,
    passivity,
    people,
    records,
    shapes,
    stability,
    velocity,
)
from .analysis.records.chatter import chatter
from .analysis.records.energy import energy
from .analysis.records.plot import plot
from .analysis.sweeps.sweep import sweep
from .compiler.tick.compile_scene import compile
from .course.check import check
from .device.device import Device
from .device.hand.hand import Hand
from .device.setup.calibrate import calibrate
from .device.setup.connect import connect
from .device.setup.doctor import doctor
from .device.simulated.simulated_paddle import SimulatedPaddle
from .errors import HapticlabError
from .limits.passivity import passivity_limit
from .limits.stability import stability_limit
from .scene.laws.chapter_laws import wall
from .scene.notation.symbols import T, coordinate, n, parameters, signal, t, v, when, x
from .scene.scene import Scene
from .vocabulary import find
from .widgets.live import live
from .widgets.shared.share import share
from .widgets.show import show

__version__: str

__all__ = [
    "Device",
    "Hand",
    "HapticlabError",
    "Scene",
    "SimulatedPaddle",
    "T",
    "bounds",
    "calibrate",
    "chatter",
    "check",
    "compile",
    "connect",
    "contact",
    "coordinate",
    "design",
    "devices",
    "doctor",
    "energy",
    "find",
    "identify",
    "laws",
    "library",
    "live",
    "measure",
    "mechanics",
    "methods",
    "n",
    "parameters",
    "passivity",
    "passivity_limit",
    "people",
    "plot",
    "records",
    "shapes",
    "share",
    "show",
    "signal",
    "stability",
    "stability_limit",
    "sweep",
    "t",
    "v",
    "velocity",
    "wall",
    "when",
    "x",
]
