"""People: how a hand moves and reacts, and experiments on what it feels, reaches and follows.

A hand takes a movement as its ``intent``. Here it reaches 20 mm in the way that people do:

>>> import hapticlab as hl
>>> reach = hl.people.MinimumJerk(end=0.02, duration=0.4)
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip", intent=reach))
>>> log = paddle.run(hl.wall()(k=0), duration=1)
>>> round(1000 * float(log.x[-1]))
20

``print(hl.people.hand_presets())`` lists the nominal hands, and ``hl.people.random_hands`` draws others. Next:
``hl.people.forced_choice`` asks what a person feels, and ``hl.people.compare_blind`` asks it in a notebook.
"""

from .analysis.programs.thresholds import Thresholds
from .device.hand.hand_presets import hand_presets
from .device.hand.intents import MinimumJerk, Tremor
from .device.hand.random_hands import random_hands
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
from .experiments.simulated_choices import simulate_choices
from .experiments.tasks import Task, damping_task, stiffness_task, texture_task
from .experiments.up_down import Levels, UpDown
from .vocabulary import page
from .widgets.blind.comparison import compare_blind

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
    "Thresholds",
    "Tremor",
    "UpDown",
    "assistance",
    "compare_blind",
    "compare_displays",
    "damping_task",
    "fitts",
    "follow",
    "forced_choice",
    "hand_presets",
    "juggle",
    "psychometric",
    "random_hands",
    "reach",
    "simulate_choices",
    "stiffness_task",
    "texture_task",
]

page(__name__)
