"""Calibrate a paddle: wiring, stops, sensor, motor sign and force, one after the other, each agreed to before it is stored."""

from __future__ import annotations

import secrets
from datetime import date as calendar
from typing import TYPE_CHECKING

from ...errors import PaddleError
from ..board.settings import NOMINAL, changed, nominal
from .built import require_wiring
from .force_constant import measure_force
from .person import Person
from .sensor_readings import measure_noise
from .sign_check import check_sign
from .stops import measure_stops
from .stored_settings import lead_home, let_cool, offer
from .wiring_check import check_wiring

if TYPE_CHECKING:
    from ..board.serial_paddle import SerialPaddle
    from ..board.settings import Settings

STEPS = ("wiring", "stops", "sensor", "sign", "force")


def calibrate(
    paddle: SerialPaddle, person: Person | None = None, *, date: int | None = None, only: str | None = None
) -> Settings | None:
    """Measure the constants of a paddle and store them on its board, if the person agrees.

    Parameters
    ----------
    paddle : SerialPaddle
    person : Person, optional
        The person who holds the handle and answers; by default the person at this terminal.
    date : int, optional
        Date that is stored with the calibration, such as 20261120; today by default.
    only : {"wiring", "stops", "sensor", "sign", "force"}, optional
        This step alone.

    Returns
    -------
    Settings or None
        The settings that the board stores now, or None if the person stopped before there were any.

    Raises
    ------
    PaddleError
        If the numbers of a step are implausible; the settings stored before stay.

    Notes
    -----
    Wiring: which paddle is built, its sensor checked with the motor and its supply off, and confirmed by the person; no
    step gives a force before. Stops: two sweeps in which the person moves the handle from stop to stop, and the travel
    measured with a ruler. Sensor: its noise at rest. Sign: see hapticlab.device.setup.sign_check. Force: a kitchen scale
    or a hanging weight, least squares, with the dead band of the driver. Mass, damping, friction, heating and speed limits
    stay nominal: a lab identifies them.
    """
    if only is not None and only not in STEPS:
        raise PaddleError(f"only = {only!r}; needs one of the steps {', '.join(STEPS)}, or None for all.")
    date = int(calendar.today().strftime("%Y%m%d")) if date is None else date
    if not 20200101 <= date <= 99991231:
        raise PaddleError(f"date = {date}; needs today's date as a number, such as 20261120.")
    person = person or Person()
    steps = STEPS if only is None else (only,)
    if paddle.settings is None and "wiring" not in steps:
        steps = ("wiring", *steps)  # a new board: what is built comes first
    for step in steps:
        person.say(f"\n== {step}")
        if not _STEP[step](paddle, person, date):
            break
    if paddle.settings is not None:
        person.say("\n".join(["", f"{paddle}", *still_nominal(paddle.settings)]))
    return paddle.settings


def still_nominal(settings):
    """Return a line on the constants that are as shipped: measured on no paddle."""
    shipped = [nominal(kind).to_float32() for kind in NOMINAL]
    names = [name for name in ("metres_per_count", "force_full", "force_continuous", "heating_time", "speed_max", "m", "b")
             if getattr(settings, name) in {getattr(one, name) for one in shipped}]  # fmt: skip
    return [f"nominal    {', '.join(names)}: as shipped, not measured on this paddle"] if names else []


def _named(ident):
    """Return the 16 bits that name a paddle, drawn where it has none."""
    return ident or 1 + secrets.randbelow(0xFFFF)


def _wiring(paddle, person, date):
    return check_wiring(paddle, person, ident=_named(0))


def _stops(paddle, person, date):
    found = measure_stops(paddle, person)
    was = paddle.settings.metres_per_count
    settings = changed(found.into(paddle.settings), date=date, ident=_named(paddle.settings.ident))
    words = [
        *found.words(),
        f"before     {abs(was) * 1e6:.4g} um per count",
        f"kept       force_full = {settings.force_full:g} N",
    ]
    return offer(paddle, person, settings, words)


def _sensor(paddle, person, date):
    noise, words = measure_noise(paddle, person)
    return offer(paddle, person, changed(paddle.settings, sensor_noise=noise, date=date), words)


def _sign(paddle, person, date):
    require_wiring(paddle)
    let_cool(paddle, person)
    person.say("The motor gives a force now, at first 0.5 N at most. Switch its supply on, and keep a hand at the switch.")
    lead_home(paddle, person)
    found = check_sign(paddle, person)
    person.say(str(found))
    return found.verdict == "right"


def _force(paddle, person, date):
    require_wiring(paddle)
    let_cool(paddle, person)
    settings, words = measure_force(paddle, person)
    settings = changed(settings, date=date, ident=_named(settings.ident))
    return offer(paddle, person, settings, [*words, f"before     force_full = {paddle.settings.force_full:g} N"])


_STEP = {"wiring": _wiring, "stops": _stops, "sensor": _sensor, "sign": _sign, "force": _force}
