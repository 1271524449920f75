"""People: how a hand intends and reacts, and experiments on what it feels, reaches and follows."""

from .device.hand.hand_presets import hand_presets
from .device.hand.intents import MinimumJerk, Tremor
from .device.hand.reacting_hand import Reacting
from .device.hand.rehearsal import Rehearsal
from .experiments.displays import compare_displays
from .experiments.fitts import fitts
from .experiments.forced_choice import forced_choice
from .experiments.juggling import Perception, juggle
from .experiments.observers import PersonObserver, SimulatedObserver
from .experiments.psi import ConstantLevels, Grid, Psi
from .experiments.psychometric import Intervals, psychometric
from .experiments.reaching import Control, Load, follow, reach
from .experiments.response_curves import Psychometric
from .experiments.shared_control import assistance
from .experiments.tasks import Task, damping_task, stiffness_task, texture_task
from .experiments.up_down import Levels, UpDown
from .vocabulary import page

__all__ = [
    "ConstantLevels",
    "Control",
    "Grid",
    "Intervals",
    "Levels",
    "Load",
    "MinimumJerk",
    "Perception",
    "PersonObserver",
    "Psi",
    "Psychometric",
    "Reacting",
    "Rehearsal",
    "SimulatedObserver",
    "Task",
    "Tremor",
    "UpDown",
    "assistance",
    "compare_displays",
    "damping_task",
    "fitts",
    "follow",
    "forced_choice",
    "hand_presets",
    "juggle",
    "psychometric",
    "reach",
    "stiffness_task",
    "texture_task",
]

page(__name__)
