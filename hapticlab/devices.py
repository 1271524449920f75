"""Paddles: simulated, on a board, and the profiles that hold their constants.

A profile is a set of published or measured constants, and says which:

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
>>> paddle.m, hl.devices.profile("hapkit").nominal
(0.03, True)

``profile("hapkit_rough")`` has typical friction and delays with intervals, ``profile("bench7.json")`` is what
``hl.identify.twin`` found of one paddle and ``save`` wrote, and ``predict`` gives the interval of a limit on either.
``profile("hapkit").drive`` converts a force at the handle into a torque and a current, with the radii and the motor of its kind.

Next: ``hl.connect()`` opens a board, ``hl.doctor()`` checks it, ``hl.identify.paddle`` measures its constants.
"""

from .base.profile.drive_train import DriveTrain
from .base.profile.paddle_profile import PaddleProfile
from .course.drawings.drawing import drawing
from .device.board.serial_paddle import SerialPaddle
from .device.paddle import Paddle
from .device.pair.two_paddles import TwoPaddles
from .device.profiles import profile
from .device.setup.practice import practice_board
from .device.simulated.simulated_paddle import SimulatedPaddle
from .vocabulary import page

__all__ = [
    "DriveTrain",
    "Paddle",
    "PaddleProfile",
    "SerialPaddle",
    "SimulatedPaddle",
    "TwoPaddles",
    "drawing",
    "practice_board",
    "profile",
]

page(__name__)
