"""Identification of paddles and hands from records, with intervals of confidence."""

from .identification.hand import identify_hand as hand
from .identification.handle_records import HandleRecord, chirp_response, spin_down, step_response
from .identification.handle_records import identify as handle
from .identification.paddle import identify_paddle as paddle
from .identification.pushes import push_hand as pushes
from .vocabulary import page

__all__ = [
    "HandleRecord",
    "chirp_response",
    "hand",
    "handle",
    "paddle",
    "pushes",
    "spin_down",
    "step_response",
]

page(__name__)
