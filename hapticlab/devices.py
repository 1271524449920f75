"""Paddles: simulated, on a board, and the profiles that hold their constants."""

from .base.telemetry import PaddleProfile
from .device.board.serial_paddle import SerialPaddle
from .device.paddle import Paddle
from .device.profiles import profile
from .device.simulated.simulated_paddle import SimulatedPaddle
from .vocabulary import page

__all__ = [
    "Paddle",
    "PaddleProfile",
    "SerialPaddle",
    "SimulatedPaddle",
    "profile",
]

page(__name__)
