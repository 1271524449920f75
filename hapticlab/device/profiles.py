"""Published constants of paddles, marked as what they are.

Lags are taken as pure delays: for slow motion a filter of first order is one, of its time constant, and for fast motion a
delay asks more of a wall than the filter does, so that a limit errs to the safe side.
"""

from __future__ import annotations

import math
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.arguments import what_is
from ..base.profile.drive_train import DriveTrain
from ..base.profile.estimate import Estimate
from ..base.profile.paddle_profile import PaddleProfile
from ..base.profile.profile_file import SUFFIX, read_profile
from ..errors import PaddleError
from .variants import VARIANTS

if TYPE_CHECKING:
    from ..base.annotations import File
    from .board.serial_paddle import SerialPaddle
    from .simulated.simulated_paddle import SimulatedPaddle


#: what no source of a Hapkit or of a paddle like it gives: the supply, the winding and the rotor are round numbers, and the
#: torque constant is the published torque at full duty over the current of a motor at rest
_MADE_UP = "supply, resistance and rotor illustrative, the torque constant from them and the torque at full duty"
_ROTOR = 2e-7
_HAPKIT_DRIVE = DriveTrain(
    drum=0.004191, sector=0.073152, handle=0.065659, counts_per_turn=1840, torque_constant=0.02, resistance=8.0, supply=12.0,
    rotor_inertia=_ROTOR,
    source=(
        "published Hapkit sketches for the radii, 0.165, 2.88 and 2.585 inch, and for 0.03 N m at full duty; 920 counts in half "
        "a turn (KMA210, 5 to 95 % of an Uno's 10 bits). They give 12.85 um per count and 7.98 N, 0.4 and 0.3 % off the "
        f"rounded 12.8 um and 8 N of the profile; {_MADE_UP}"
    ),
)  # fmt: skip
_AS5048A_DRIVE = DriveTrain(
    drum=0.005, sector=0.075, handle=0.08, counts_per_turn=16_384, torque_constant=0.0183, resistance=12.0, supply=12.0,
    rotor_inertia=_ROTOR, source=f"the profile's sources; {_MADE_UP}",
)  # fmt: skip
_LONGHORN_DRIVE = DriveTrain(
    drum=0.005, sector=0.075, handle=0.085, counts_per_turn=48, torque_constant=0.0167, resistance=12.0, supply=12.0,
    rotor_inertia=_ROTOR, source=f"the profile's sources; {_MADE_UP}",
)  # fmt: skip
_SHIELD_DRIVE = DriveTrain(
    drum=0.0042, sector=0.075, handle=0.07, counts_per_turn=2000, torque_constant=0.0147, resistance=15.0, supply=12.0,
    rotor_inertia=_ROTOR, source=f"the profile's source for the radii; the torque too is illustrative; {_MADE_UP}",
)  # fmt: skip
_ETH_DRIVE = DriveTrain(
    drum=0.0043, sector=0.075, handle=0.065, torque_constant=0.0538, resistance=10.6, rotor_inertia=1.58e-6,
    source=(
        "ETH Zurich teaching paddle (github.com/WilliamLinxw/Physical-Human-Robot-Interaction-Lab, Lin_Rohner_lab3/"
        "Matlab_Simulink_Template/Parameters.m): radii and rotor by its drawings, the rest by the motor's data sheet; encoder "
        "and supply not included"
    ),
)  # fmt: skip


#: nothing here was measured by this package on anyone's device: a lab identifies m, b and friction. The KMA210's lag and
#: noise are left out, as the labs' numbers are those of a sensor without: calibration measures the noise, and for the lag
#: the data sheet of its sister KMA199 (NXP, Rev. 2, table 11, note 5) names a filter of 0.7 kHz, 0.23 ms
hapkit = PaddleProfile(
    name="hapkit",
    m=0.03,
    b=0.10,
    counts_per_metre=1 / 12.8e-6,
    force_max=3.3,
    force_full=8.0,
    carrier=62_500,
    wiring="hapkit",
    drive=_HAPKIT_DRIVE,
    nominal=True,
    source=(
        "published Hapkit sketches and dimensions for 12.8 um per count and 3.3 N (the lower of the published peaks, "
        "3.3 to 8 N); m and b are published nowhere: round, illustrative values"
    ),
)
hapkit_as5048a = PaddleProfile(
    name="hapkit_as5048a",
    m=0.03,
    b=0.10,
    counts_per_metre=16_384 / (2 * math.pi * _AS5048A_DRIVE.jacobian),
    force_max=3.3,
    force_full=0.0183 / _AS5048A_DRIVE.jacobian,
    sensor_delay=100e-6,
    sensor_noise=math.radians(0.06) * _AS5048A_DRIVE.jacobian,
    carrier=62_500,
    wiring="hapkit_as5048a",
    drive=_AS5048A_DRIVE,
    nominal=True,
    source=(
        "sketch of Stanford's ME327 (github.com/13strings/me327, helpers.h) for 16384 counts a turn, chip select D10, PWM D5, "
        "direction D8 and full duty at 0.0183 N m; radii of that team's paddle, 5, 75 and 80 mm; the sensor's 0.1 ms and 0.06 "
        "degrees rms are its data sheet's from memory, to be confirmed; m, b and force limit illustrative"
    ),
)
longhorn = PaddleProfile(
    name="longhorn",
    m=0.04,
    b=0.15,
    counts_per_metre=48 / (2 * math.pi * _LONGHORN_DRIVE.jacobian),
    rounding="floor",
    force_max=2.4,
    force_full=0.0167 / _LONGHORN_DRIVE.jacobian,
    carrier=31_372,
    wiring="longhorn_d11",
    drive=_LONGHORN_DRIVE,
    nominal=True,
    source=(
        "Longhorn Hapkit of UT Austin (github.com/connormmckelvey/Longhorn-Hapkit, firmware/1DOF/1_basic.cpp) for 48 counts a "
        "turn and radii of 5, 75 and 85 mm; sketch of A. Majewicz Fey of 27 August 2021 for 0.0167 N m at full duty, D4, D5 "
        "and D11, encoder D2 and D3; m, b and force limit illustrative"
    ),
)
motor_shield = PaddleProfile(
    name="motor_shield",
    m=0.04,
    b=0.15,
    counts_per_metre=2000 / (2 * math.pi * _SHIELD_DRIVE.jacobian),
    force_max=2.0,
    force_full=3.0,
    carrier=7_812,
    wiring="motor_shield",
    drive=_SHIELD_DRIVE,
    nominal=True,
    source=(
        "radii of a Hapkit 3.0 on an Uno with a motor shield, 4.2, 75 and 70 mm (github.com/bgromov/Hapkit3.0, hapkit3.h); "
        "an encoder of 500 lines, m, b and forces illustrative"
    ),
)
eth = PaddleProfile(
    name="eth",
    m=0.166,
    b=0.057,
    drive=_ETH_DRIVE,
    nominal=True,
    source=(
        "ETH Zurich teaching paddle, published inertias, motor damping and pulley ratio (github.com/WilliamLinxw/"
        "Physical-Human-Robot-Interaction-Lab) reflected to the handle at 65 mm; encoder, friction and force limit "
        "not included"
    ),
)
PROFILES = {p.name: p for p in (hapkit, hapkit_as5048a, longhorn, motor_shield, eth)}
_KNOWN = (
    f"there are {', '.join(PROFILES)}, each also with {', '.join(f'_{word}' for word in VARIANTS)}. Give a file that "
    "profile.save() wrote, such as 'bench7.json'; or for a profile of your own write hl.devices.PaddleProfile(...)"
)


def profile(name: File | PaddleProfile) -> PaddleProfile:
    """Return the profile of a kind of paddle by its name, or of one paddle from the file that its profile was saved to.

    Each kind also exists ``_rough``, with typical friction and delays, ``_coarse``, with an encoder of 100 um per count,
    and ``_slow``, with 2 ms per sample and 1 ms of delay, to try whether a result holds on more than one paddle.

    Parameters
    ----------
    name : {"hapkit", "hapkit_as5048a", "longhorn", "motor_shield", "eth"} or path
        A kind, such as "hapkit" or "hapkit_rough", or a file that ends in ".json". A profile is returned as it is.

    Raises
    ------
    PaddleError
        For a name that no profile has, and a file that is damaged, of another version, or holds what no paddle has.

    Examples
    --------
    >>> from hapticlab.device.profiles import profile
    >>> profile("eth").m
    0.166
    >>> print(profile("hapkit_rough")["coulomb"])
    coulomb = 0.05 N, between 0.02 and 0.08
    """
    if isinstance(name, PaddleProfile):
        return name
    if not isinstance(name, str | PathLike):
        raise PaddleError(f"a profile is given by its name or its file, not as {what_is(name)}; {_KNOWN}")
    if not isinstance(name, str) or name.endswith(SUFFIX):
        return _from_file(name)
    found = kind_named(name)
    if found is None:
        raise PaddleError(f"no profile {name!r}; {_KNOWN}")
    return found


def kind_named(name: str) -> PaddleProfile | None:
    """Return the profile of a kind of paddle or of its variant, or None for any other name; no file is read.

    Examples
    --------
    >>> kind_named("hapkit_slow").T, kind_named("bench 7")
    (0.002, None)
    """
    kind, _, variant = name.rpartition("_")
    if kind in PROFILES and variant in VARIANTS:
        return VARIANTS[variant](PROFILES[kind])
    return PROFILES.get(name)


def profile_of(paddle: SimulatedPaddle | SerialPaddle) -> PaddleProfile | None:
    """Return the profile of a board's calibration, or that which a simulated paddle was made of; None where it has none."""
    settings = getattr(paddle, "settings", None)
    return settings.profile(paddle.T) if settings is not None else getattr(paddle, "profile", None)


def _from_file(path):
    told = read_profile(path)
    named = Path(path).name
    try:
        estimates = tuple(Estimate(**one) for one in told.pop("estimates"))
        return PaddleProfile(**told, estimates=estimates)
    except PaddleError as refusal:
        raise PaddleError(f"{named}: {refusal}") from None
