"""Each kind of paddle as it may be on a bench: rough, with a coarse encoder, or slow.

The kinds in ``profiles.py`` are ideal where nothing was published: no friction, no delay. A limit or a threshold that
holds on them may not hold on the paddle in somebody's hand, so whatever is said of one paddle is tried on all four.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from ..base.profile.estimate import Estimate
from ..base.profile.paddle_profile import PaddleProfile

_MADE_UP = "illustrative: published for no paddle"
_ON_AN_EMULATED_UNO = "docs/paddle/boards.md, measured on an emulated Uno"
_OF_THE_KMA199 = "filter of the KMA199's data sheet (NXP, Rev. 2, table 11, note 5); the interval is illustrative"
#: time constant of that filter, 0.7 kHz [s], taken as a pure delay
_LAG = 1 / (2 * math.pi * 700)
#: from sample to force of this firmware: the median at 1 ms, and the most at 0.4 ms
_UNO = Estimate("delay", 190e-6, 190e-6, 277e-6, "s", _ON_AN_EMULATED_UNO)
_RUBS = Estimate("coulomb", 0.05, 0.02, 0.08, "N", _MADE_UP)
_RUBS_MORE = Estimate("coulomb", 0.08, 0.03, 0.15, "N", _MADE_UP)
#: what is typical of each kind beside what its profile says
TYPICAL = {
    "hapkit": (_RUBS, _UNO, Estimate("sensor_delay", _LAG, 0.0, 2 * _LAG, "s", _OF_THE_KMA199)),
    "hapkit_as5048a": (_RUBS, _UNO),
    "longhorn": (_RUBS_MORE, _UNO),
    "motor_shield": (_RUBS_MORE, _UNO),
    "eth": (_RUBS, Estimate("delay", 0.2e-3, 0.1e-3, 0.5e-3, "s", _MADE_UP)),
}
#: counts per metre of a coarse encoder, and the factor by which one that is as coarse already is made coarser
COARSE, COARSER = 1e4, 2.0
#: sampling period and delay of a slow paddle [s]
SLOW_T, SLOW_DELAY = 2e-3, 1e-3


def rough(kind: PaddleProfile) -> PaddleProfile:
    """A paddle with the friction and the delays that are typical of its kind, each with an interval."""
    typical = TYPICAL[kind.name]
    values: dict[str, Any] = {one.name: one.value for one in typical}
    return replace(kind, **values, estimates=typical, **_about(kind, "rough", "typical friction and delays"))


def coarse(kind: PaddleProfile) -> PaddleProfile:
    """A paddle with an encoder of 100 um per count, or half the counts of its kind where these are as wide already."""
    counts = COARSE if kind.counts_per_metre is None else min(COARSE, kind.counts_per_metre / COARSER)
    turn = None if kind.drive is None else replace(kind.drive, counts_per_turn=2 * math.pi * kind.drive.jacobian * counts)
    return replace(kind, counts_per_metre=counts, drive=turn, **_about(kind, "coarse", "an illustrative encoder"))


def slow(kind: PaddleProfile) -> PaddleProfile:
    """A paddle that samples every 2 ms and gives each force 1 ms after its sample."""
    return replace(kind, T=SLOW_T, delay=SLOW_DELAY, **_about(kind, "slow", "an illustrative period and delay"))


def _about(kind, word, changed):
    return {"name": f"{kind.name}_{word}", "source": f"{kind.name} with {changed}; {kind.source}"}


VARIANTS = {"rough": rough, "coarse": coarse, "slow": slow}
