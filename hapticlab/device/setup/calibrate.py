"""Calibrate a paddle: stops, motor sign, force constant, one after the other, each agreed to before it is stored."""

from __future__ import annotations

import secrets
from datetime import date as calendar
from typing import TYPE_CHECKING

from ...errors import PaddleError
from ..board.settings import changed, nominal
from ..link.messages import SENSORS
from .force_constant import measure_force
from .person import Person
from .sign_check import check_sign
from .stops import measure_stops
from .stored_settings import lead_home, offer

if TYPE_CHECKING:
    from ..board.serial_paddle import SerialPaddle
    from ..board.settings import Settings

STEPS = ("stops", "sign", "force")


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
    only : {"stops", "sign", "force"}, optional
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
    Stops: two sweeps in which the person moves the handle from stop to stop, and the travel measured with a ruler.
    Sign: see hapticlab.device.setup.sign_check. Force: a kitchen scale or a hanging weight, least squares. Mass,
    damping, friction, heating and speed limits stay nominal: a lab identifies them.
    """
    if only is not None and only not in STEPS:
        raise PaddleError(f"only = {only!r}; needs one of the steps {', '.join(STEPS)}, or None for all.")
    date = int(calendar.today().strftime("%Y%m%d")) if date is None else date
    if not 20200101 <= date <= 99991231:
        raise PaddleError(f"date = {date}; needs today's date as a number, such as 20261120.")
    person = person or Person()
    if paddle.settings is None and not _begin(paddle, person):
        return None
    for step in STEPS if only is None else (only,):
        person.say(f"\n== {step}")
        if not _STEP[step](paddle, person, date):
            break
    person.say("\n".join(["", f"{paddle}", *still_nominal(paddle.settings)]))
    return paddle.settings


def still_nominal(settings):
    """Return a line on the constants that are as shipped: measured on no paddle."""
    shipped = nominal("hapkit").to_float32()
    names = [name for name in ("metres_per_count", "force_full", "force_continuous", "heating_time", "speed_max", "m", "b")
             if getattr(settings, name) == getattr(shipped, name)]  # fmt: skip
    return [f"nominal    {', '.join(names)}: as shipped, not measured on this paddle"] if names else []


def _begin(paddle, person):
    """Store nominal constants on a new board: the sensor's kind decides how it counts. Returns whether it was agreed to."""
    kind = person.choose(
        "This board has no settings yet. Which sensor does the paddle have?",
        {"hapkit": "magnetoresistive sensor on A2, as on a Hapkit", "encoder": "quadrature encoder on D2 and D3"},
    )
    sensor = SENSORS["MAGNETORESISTIVE" if kind == "hapkit" else "QUADRATURE"]
    begun = nominal("hapkit", sensor=sensor, ident=_named(0))
    stored = offer(paddle, person, begun, ["to store   nominal constants of a Hapkit, motor at 0.5 N at most, to begin with"])
    return stored and offer(
        paddle,
        person,
        changed(begun, wired=1),
        ["to store   wiring confirmed: driver's PWM on D5, direction on D8; sensor on A2, or encoder on D2 and D3"],
    )


def _named(ident):
    """Return the 16 bits that name a paddle, drawn where it has none."""
    return ident or 1 + secrets.randbelow(0xFFFF)


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


def _sign(paddle, person, date):
    lead_home(paddle, person)
    found = check_sign(paddle, person)
    person.say(str(found))
    return found.verdict == "right"


def _force(paddle, person, date):
    settings, words = measure_force(paddle, person)
    settings = changed(settings, date=date, ident=_named(settings.ident))
    return offer(paddle, person, settings, [*words, f"before     force_full = {paddle.settings.force_full:g} N"])


_STEP = {"stops": _stops, "sign": _sign, "force": _force}
