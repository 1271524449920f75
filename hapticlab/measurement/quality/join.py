"""What was measured of one paddle, joined into one record; and the same record from its file."""

from __future__ import annotations

import json
from datetime import date as calendar
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import what_is
from ...base.profile.estimate import Estimate
from ...base.profile.paddle_profile import PaddleProfile
from ...base.profile.profile_file import parsed
from ...device.profiles import profile_of
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError, PaddleError
from ...rendering.velocity_errors import VelocityErrors
from ..measured import MeasuredImpedance
from ..z_width import ZWidth
from .record import PaddleQuality, Rendered, Velocity, Width
from .record_file import LETTERS, TEXTS, is_line, loaded, refused, row_of, rows_of, text_of

if TYPE_CHECKING:
    from ...base.annotations import File
    from ...device.board.serial_paddle import SerialPaddle

BACKWARD = "backward difference"


def paddle_quality(
    name: str,
    paddle: SimulatedPaddle | SerialPaddle,
    *found: ZWidth | MeasuredImpedance | VelocityErrors,
    profile: PaddleProfile | None = None,
    date: str | None = None,
) -> PaddleQuality:
    """Join what was measured of a paddle into one record, to save, to write as a page and to compare with others.

    It moves no motor, as everything was measured before.

    Parameters
    ----------
    name : str
        By which the paddle is known in class. No other name, of a person or of a computer, is in the record.
    paddle : SimulatedPaddle or SerialPaddle
        On which all was measured.
    *found : ZWidth, MeasuredImpedance or VelocityErrors
        What ``hl.measure.z_width``, with as many velocities as you like, ``hl.measure.impedance`` and
        ``hl.velocity.compare`` return, in any order.
    profile : PaddleProfile, optional
        Its constants, such as its twin; by default those of the paddle.
    date : str, optional
        Day of the measurement, such as "2026-11-20"; today by default.

    Returns
    -------
    PaddleQuality

    Raises
    ------
    AnalysisError
        For a name or a date that is none, something else than a measurement, and two impedances.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    >>> start, coarse = hl.measure.Starts(run_ups=0, within_count=1), hl.measure.Search(growth=3, tolerance=0.5)
    >>> width = hl.measure.z_width(paddle, B=0, starts=start, search=coarse)
    >>> bench = hl.measure.quality("bench 7", paddle, width, date="2026-11-20")
    >>> print(bench.lines()[0])
    Eq. (23.10) guarantees walls up to 200 N/m in every passive hand.
    >>> import tempfile
    >>> hl.measure.read_quality(bench.save(f"{tempfile.mkdtemp()}/bench7.json")) == bench
    True
    """
    if not is_line(name):
        raise AnalysisError(f"name = {name!r}; a paddle needs a name of one line with 1 to {LETTERS} letters, such as 'bench 7'")
    try:
        day = calendar.today() if date is None else calendar.fromisoformat(date)
    except (TypeError, ValueError):
        raise AnalysisError(f"date = {date!r}; needs a day such as '2026-11-20', or nothing for today") from None
    profile = profile or _profile_of(paddle)
    if isinstance(paddle, SimulatedPaddle):
        on, held = "simulated paddle", str(paddle.hand or "nobody")
    else:
        on, held = ("simulated board", "nobody") if paddle.url.startswith("sim://") else ("board", "a person's hand")
    for one in found:
        if not isinstance(one, ZWidth | MeasuredImpedance | VelocityErrors):
            raise AnalysisError(
                f"hl.measure.quality was given {what_is(one)}; needs what hl.measure.z_width, hl.measure.impedance or "
                "hl.velocity.compare return"
            )
    impedances = [one for one in found if isinstance(one, MeasuredImpedance)]
    if len(impedances) > 1:
        raise AnalysisError(f"hl.measure.quality was given {len(impedances)} impedances; a page shows one. Leave the others out")
    return PaddleQuality(
        name,
        day.isoformat(),
        on,
        held,
        profile,
        tuple(_width(one) for one in found if isinstance(one, ZWidth)),
        _rendered(impedances[0]) if impedances else None,
        tuple(
            Velocity(row.name, row.lag, row.noise, row.cycles, row.fits)
            for one in found
            if isinstance(one, VelocityErrors)
            for row in one.rows
        ),
    )


def _profile_of(paddle):
    profile = profile_of(paddle)
    if profile is None:
        raise PaddleError(
            "hl.measure.quality: the paddle has no profile, so its constants are not known. Give its twin, or the profile that "
            "it was made of: profile=my_paddle"
        )
    return profile


def _width(found):
    worst = (tuple(getattr(found, border)[:, 0].tolist()) for border in ("unstable", "buzz"))
    velocity = found.law.partition(", ")[2] or BACKWARD
    return Width(velocity, tuple(found.B.tolist()), tuple(found.K.tolist()), *worst)


def _rendered(found):
    if found.ideal is None:
        raise AnalysisError("the ideal of the impedance is not known. Measure it of a wall, such as hl.wall()(k=200)")
    K = float(np.mean((2j * np.pi * found.frequency * found.ideal).real))
    Z = found.rendered
    parts = (found.frequency, Z.real, Z.imag, np.nan_to_num(found.radius))
    return Rendered(K, float(np.mean(found.ideal.real)), *(tuple(part.tolist()) for part in parts))


def read_quality(path: File) -> PaddleQuality:
    """Read the quality of a paddle from the file that ``quality.save`` wrote.

    Parameters
    ----------
    path : path

    Returns
    -------
    PaddleQuality

    Raises
    ------
    AnalysisError
        For a file that is damaged, of another version, or holds something else.

    Examples
    --------
    >>> import hapticlab as hl
    >>> try:
    ...     hl.measure.read_quality("nothing.json")
    ... except hl.errors.AnalysisError as problem:
    ...     print(str(problem).partition(". ")[2])
    Give a file that quality.save() wrote.
    """
    held, named = loaded(path), Path(path).name
    texts = {name: text_of(held[name], name, named) for name in TEXTS}
    try:
        calendar.fromisoformat(texts["date"])
        told = parsed(json.dumps(held["profile"]), "its profile")
        profile = PaddleProfile(**{**told, "estimates": tuple(Estimate(**one) for one in told["estimates"])})
    except PaddleError as problem:
        raise refused(named, str(problem).rstrip(".")) from None
    except ValueError:
        raise refused(named, f"{texts['date']!r} is not a day such as 2026-11-20") from None
    widths = rows_of(Width, held["widths"], "widths", named)
    rendered = None if held["rendered"] is None else row_of(Rendered, held["rendered"], "rendered", named)
    if rendered is not None and not (rendered.K >= 0 and rendered.K + abs(rendered.B) > 0):
        raise refused(named, f"a wall of {rendered.K:g} N/m and {rendered.B:g} N s/m has no impedance to compare with")
    return PaddleQuality(
        **texts,
        profile=profile,
        widths=widths,
        rendered=rendered,
        velocities=rows_of(Velocity, held["velocities"], "velocities", named),
    )
