"""What identifications found of a paddle, joined into one profile: its digital twin."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import date as calendar
from typing import TYPE_CHECKING, Any

from ..base.arguments import what_is
from ..base.profile.constants import CONSTANTS, in_range, unit_of
from ..base.profile.estimate import Estimate
from ..base.profile.paddle_profile import PaddleProfile
from ..device.profiles import profile as named_profile
from ..device.profiles import profile_of
from ..errors import AnalysisError

if TYPE_CHECKING:
    from ..base.annotations import File
    from ..device.board.serial_paddle import SerialPaddle
    from ..device.simulated.simulated_paddle import SimulatedPaddle
    from .motor_curve import MotorCurve
    from .paddle_fit import PaddleFit

NO_MASS = "the mass was not found, because a spin-down determines only b/m and coulomb/m. Add a step or a chirp, or give m="


def identify_twin(
    name: str,
    *found: PaddleFit | MotorCurve,
    base: PaddleProfile | SimulatedPaddle | SerialPaddle | File | None = None,
    date: str | None = None,
    **constants: Any,
) -> PaddleProfile:
    """The digital twin of a paddle: a profile of everything that was identified, each constant with its interval and source.

    Every simulated paddle and every limit takes it; ``twin.predict`` gives the interval of a prediction, and ``twin.save``
    writes a file to share. A delay whose records say how long the computation took is split: the rest is the lag of the
    sensor. Without this it is the whole delay. Where noise dithers the counts and the fit explains the record, the noise
    of the sensor is a constant too. A force constant that was found (``scale``) multiplies force_full of ``base``.

    Parameters
    ----------
    name : str
    *found : PaddleFit or MotorCurve
        What hl.identify.paddle, handle, step_response, chirp_response, spin_down and motor return, in any order. Each
        constant may be found once.
    base : PaddleProfile, paddle, or a name or file of hl.devices.profile, optional
        Where all other constants come from; an earlier twin is improved in this way.
    date : str, optional
        Day of the measurement, such as "2026-11-20"; today by default.
    **constants
        Of the profile, known exactly: T, force_max ...; or rounding, wiring.

    Returns
    -------
    PaddleProfile

    Raises
    ------
    AnalysisError
        If nothing was found and nothing is given, or a constant was found twice, the mass not at all, or with an encoder
        other than that of ``base``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> unknown = hl.SimulatedPaddle.from_profile("hapkit", m=0.034, b=0.12, coulomb=0.05, noise=8e-6)
    >>> found = hl.identify.paddle(unknown, kinds=("steps",))
    >>> twin = hl.identify.twin("bench 7", found, base="hapkit")
    >>> 0.034 in twin["m"], 0.05 in twin["coulomb"], twin.force_max
    (True, True, 3.3)
    >>> 240.0 in twin.predict(hl.passivity_limit)  # 2 b/T of the true paddle [N/m]
    True
    """
    if not found and not constants:
        raise AnalysisError(
            "hl.identify.twin was given nothing that was found, so its profile would only call its base measured. Give what "
            "hl.identify.paddle, handle or motor found, or constants that you know exactly, such as m='34 g'"
        )
    rest, day = _base(base), date or calendar.today().isoformat()
    estimates: dict[str, Estimate] = {}
    for one in found:
        if not hasattr(one, "as_constants"):
            raise AnalysisError(
                f"hl.identify.twin was given {what_is(one)}; needs what hl.identify.paddle, handle or motor found of a paddle"
            )
        for constant in one.as_constants(rest):
            if constant.name in estimates:
                raise AnalysisError(
                    f"hl.identify.twin: {constant.name} was found twice. Identify all records together, "
                    "hl.identify.handle(*records), or leave one fit out"
                )
            estimates[constant.name] = replace(constant, source=f"{constant.source}, {day}")
    texts = {text: constants.pop(text) for text in ("rounding", "wiring") if text in constants}
    estimates |= {known: exact(known, value, f"given, {day}") for known, value in constants.items()}
    return _profile(name, rest, estimates, texts)


def _profile(name, base, estimates, texts):
    """The profile of a base and what is known better."""
    values = {known: one.value for known, one in estimates.items()}
    if base is None:
        if "m" not in values:
            raise AnalysisError(NO_MASS)
        base = PaddleProfile(name, m=values["m"], b=values.get("b", 0.0), source="taken as ideal")
    rest = tuple(one for one in base.estimates if one.name not in estimates)
    standing = base.source if base.estimates or base.name == name else f"{base.name}, {_standing(base)}: {base.source}"
    changed = {**values, **texts, "estimates": (*rest, *estimates.values())}
    return replace(base, name=name, nominal=False, source=standing, **changed)


def exact(name: str, value: Any, source: str) -> Estimate:
    """A constant that is known exactly."""
    if name not in CONSTANTS:
        raise AnalysisError(f"{name} is not a constant of a paddle; the constants are {', '.join(CONSTANTS)}")
    value = in_range(name, value, "a paddle")
    return Estimate(name, value, value, value, unit_of(name), source)


def bounded(name: str, found: Estimate, source: str) -> Estimate:
    """An estimate as a constant of a paddle, no part of its interval outside the constant's range."""
    limits = CONSTANTS[name][1]
    least, most = limits.get("least", limits.get("above", 0.0)), limits.get("most", math.inf)
    value, low, high = (min(max(end, least), most) for end in (found.value, found.low, found.high))
    return Estimate(name, value, low, high, unit_of(name), source)


def _standing(profile):
    return "nominal" if profile.nominal else "measured"


def _base(given):
    if given is None:
        return None
    if not hasattr(given, "run"):
        return named_profile(given)
    profile = profile_of(given)
    if profile is None:
        raise AnalysisError(
            "hl.identify.twin: the paddle given as base= has no profile, or its board no calibration. Give a profile, such as "
            "base='hapkit', or calibrate the board"
        )
    return profile
