"""The public names and where they live; __init__.py loads each on first use (SPEC 1)."""

from . import library
from .analysis.accuracy.handle_motions import HandleMotion, handle_motions
from .analysis.accuracy.port_error import force_error, sensor_floor
from .analysis.accuracy.reference import reference
from .analysis.accuracy.tradeoff import tradeoff
from .analysis.impedance.impedance import impedance
from .analysis.impedance.reduction import reduction
from .analysis.pictures.pictures import picture
from .analysis.programs.error_order import order_of
from .analysis.programs.method_comparison import methods
from .analysis.programs.replay import replay
from .analysis.programs.requires import requires
from .analysis.records.chatter import chatter
from .analysis.records.energy import energy
from .analysis.records.energy_books import balance, energy_books
from .analysis.records.passivity_trace import passivity_trace
from .analysis.records.plots import plot
from .analysis.records.staircase import staircase
from .analysis.records.storage import storage
from .analysis.stability.port_passivity import port_passivity
from .analysis.stability.step_limit import step_limit
from .analysis.sweeps.sweep import sweep
from .analysis.walls.compare_laws import compare_laws
from .analysis.walls.law_limits import law_limits
from .analysis.walls.wall_map import wall_map
from .compiler.contacts.broad_phase import contacts_between
from .compiler.events.taylor_method import Taylor
from .compiler.tick.compile_scene import compile
from .course.check import check
from .device.board.serial_paddle import SerialPaddle
from .device.hand.hand import Hand
from .device.hand.hand_presets import hand, hand_presets
from .device.hand.intents import MinimumJerk, Tremor
from .device.hand.reacting_hand import Reacting
from .device.paddle import Paddle
from .device.profiles import profile
from .device.setup.calibrate import calibrate
from .device.setup.connect import connect
from .device.setup.doctor import doctor
from .device.simulated.simulated_paddle import SimulatedPaddle
from .errors import (
    AnalysisError,
    CourseError,
    EngineMissingError,
    HapticlabError,
    LinkError,
    MassError,
    PaddleError,
    ParameterError,
    PortError,
    ProgramError,
    ProgramLimitError,
    SceneError,
    SignalError,
    UnitsError,
)
from .experiments.displays import compare_displays
from .experiments.fitts import fitts
from .experiments.forced_choice import forced_choice
from .experiments.juggling import juggle
from .experiments.observers import PersonObserver, SimulatedObserver
from .experiments.psi import ConstantLevels, Psi
from .experiments.psychometric import psychometric
from .experiments.reaching import Load, follow, reach
from .experiments.response_curves import Psychometric
from .experiments.shared_control import assistance
from .experiments.tasks import Task, damping_task, stiffness_task, texture_task
from .experiments.up_down import UpDown
from .identification.hand import identify_hand
from .identification.handle_records import HandleRecord, chirp_response, identify, spin_down, step_response
from .identification.paddle import identify_paddle
from .identification.pushes import push_hand
from .limits.admittance import admittance_design
from .limits.bounds import abbott_okamura_limit, bounds, diolaiti, diolaiti_limit, gil_limit
from .limits.colgate import equivalent_damper, passivity_margin, wall_damping
from .limits.coupler import coupler_design
from .limits.excess import passivity_ledger
from .limits.indices import passivity_indices
from .limits.linear_law import LinearLaw
from .limits.local_stiffness import local_stiffness
from .limits.nyquist_disk import nyquist_disk
from .limits.passivity import passivity_limit
from .limits.port import port_damping
from .limits.root_locus import root_locus
from .limits.stability import closed_loop_matrix, closed_loop_poles, damper_limit, stability_limit
from .limits.two_port import TwoPort
from .measurement.impedance import measured_impedance
from .measurement.largest_stiffness import largest_stiffness
from .measurement.signals import multisine
from .measurement.z_width import z_width
from .records import PaddleProfile, Telemetry
from .rendering.compensation_limit import CompensationLimit, compensation_limit
from .rendering.deadbeat import deadbeat_gains, deadbeat_wall
from .rendering.digital import digital_gains, digital_wall
from .rendering.for_board import wall_for_board
from .rendering.hybrid import hybrid_wall
from .rendering.over_compensation import over_compensation
from .rendering.predictive import predictive_wall
from .rendering.velocity_errors import velocity_errors
from .rendering.wall_laws import wall_law
from .scene.contact.contact import Contact, friction
from .scene.contact.felt_impulses import felt_impulse, pulse_time
from .scene.contact.instant_laws import impulse, micro_impulse, rigid
from .scene.contact.penalty_laws import hunt_crossley, penalty
from .scene.laws.adaptive_window import window_velocity
from .scene.laws.chapter_laws import force_filter, predicted_sample, virtual_coupler, virtual_damper, wall
from .scene.laws.compensation import damping_compensation
from .scene.laws.entry_pulse import braking_pulse, friction_pulse
from .scene.laws.estimators import VelocityEstimate, backward_velocity, filtered_velocity
from .scene.laws.fixtures import guidance, tremor_filter
from .scene.laws.kalman import kalman_velocity
from .scene.laws.passivity_control import passivity_controller, passivity_observer, wall_energy
from .scene.laws.proxy import proxy_curve, proxy_wall
from .scene.mechanics.device_image import device_image
from .scene.mechanics.lagrange import Mechanics, lagrange
from .scene.mechanics.sympy_models import from_mechanics
from .scene.notation.amount import Amount
from .scene.notation.symbols import T, coordinate, delay, n, parameters, signal, t, v, when, x
from .scene.scene import Scene
from .scene.shapes.curves import Curve, track
from .scene.shapes.gaps import closest, gap
from .scene.shapes.shapes import Box, Capsule, Circle, HalfPlane, Polygon, Segment, ground, replacement
from .widgets.live import live
from .widgets.show import show
from .widgets.view import explore

__version__: str

__all__ = [
    "Amount",
    "AnalysisError",
    "Box",
    "Capsule",
    "Circle",
    "CompensationLimit",
    "ConstantLevels",
    "Contact",
    "CourseError",
    "Curve",
    "EngineMissingError",
    "HalfPlane",
    "Hand",
    "HandleMotion",
    "HandleRecord",
    "HapticlabError",
    "LinearLaw",
    "LinkError",
    "Load",
    "MassError",
    "Mechanics",
    "MinimumJerk",
    "Paddle",
    "PaddleError",
    "PaddleProfile",
    "ParameterError",
    "PersonObserver",
    "Polygon",
    "PortError",
    "ProgramError",
    "ProgramLimitError",
    "Psi",
    "Psychometric",
    "Reacting",
    "Scene",
    "SceneError",
    "Segment",
    "SerialPaddle",
    "SignalError",
    "SimulatedObserver",
    "SimulatedPaddle",
    "T",
    "Task",
    "Taylor",
    "Telemetry",
    "Tremor",
    "TwoPort",
    "UnitsError",
    "UpDown",
    "VelocityEstimate",
    "abbott_okamura_limit",
    "admittance_design",
    "assistance",
    "backward_velocity",
    "balance",
    "bounds",
    "braking_pulse",
    "calibrate",
    "chatter",
    "check",
    "chirp_response",
    "closed_loop_matrix",
    "closed_loop_poles",
    "closest",
    "compare_displays",
    "compare_laws",
    "compensation_limit",
    "compile",
    "connect",
    "contacts_between",
    "coordinate",
    "coupler_design",
    "damper_limit",
    "damping_compensation",
    "damping_task",
    "deadbeat_gains",
    "deadbeat_wall",
    "delay",
    "device_image",
    "digital_gains",
    "digital_wall",
    "diolaiti",
    "diolaiti_limit",
    "doctor",
    "energy",
    "energy_books",
    "equivalent_damper",
    "explore",
    "felt_impulse",
    "filtered_velocity",
    "fitts",
    "follow",
    "force_error",
    "force_filter",
    "forced_choice",
    "friction",
    "friction_pulse",
    "from_mechanics",
    "gap",
    "gil_limit",
    "ground",
    "guidance",
    "hand",
    "hand_presets",
    "handle_motions",
    "hunt_crossley",
    "hybrid_wall",
    "identify",
    "identify_hand",
    "identify_paddle",
    "impedance",
    "impulse",
    "juggle",
    "kalman_velocity",
    "lagrange",
    "largest_stiffness",
    "law_limits",
    "library",
    "live",
    "local_stiffness",
    "measured_impedance",
    "methods",
    "micro_impulse",
    "multisine",
    "n",
    "nyquist_disk",
    "order_of",
    "over_compensation",
    "parameters",
    "passivity_controller",
    "passivity_indices",
    "passivity_ledger",
    "passivity_limit",
    "passivity_margin",
    "passivity_observer",
    "passivity_trace",
    "penalty",
    "picture",
    "plot",
    "port_damping",
    "port_passivity",
    "predicted_sample",
    "predictive_wall",
    "profile",
    "proxy_curve",
    "proxy_wall",
    "psychometric",
    "pulse_time",
    "push_hand",
    "reach",
    "reduction",
    "reference",
    "replacement",
    "replay",
    "requires",
    "rigid",
    "root_locus",
    "sensor_floor",
    "show",
    "signal",
    "spin_down",
    "stability_limit",
    "staircase",
    "step_limit",
    "step_response",
    "stiffness_task",
    "storage",
    "sweep",
    "t",
    "texture_task",
    "track",
    "tradeoff",
    "tremor_filter",
    "v",
    "velocity_errors",
    "virtual_coupler",
    "virtual_damper",
    "wall",
    "wall_damping",
    "wall_energy",
    "wall_for_board",
    "wall_law",
    "wall_map",
    "when",
    "window_velocity",
    "x",
    "z_width",
]
