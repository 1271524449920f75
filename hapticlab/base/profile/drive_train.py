"""From the force at the handle to the torque and the current of the motor, and from the turn of its shaft to the handle."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import PaddleError
from ..arguments import numbers
from ..facts import card
from ..shows_itself import ShowsItself

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..annotations import Array

#: quantity -> its unit, "1" without one; a file writes both
UNITS = {
    "drum": "m",
    "sector": "m",
    "handle": "m",
    "counts_per_turn": "1",
    "torque_constant": "N m/A",
    "resistance": "ohm",
    "supply": "V",
    "rotor_inertia": "kg m^2",
}


@dataclass(frozen=True)
class DriveTrain(ShowsItself):
    """The drive of a paddle: a drum on the shaft of the motor drives the rim of a sector, which turns with the handle.

    The drum and the rim move together, so the ratio of their turns is the ratio of their radii. Motor and handle exchange
    the same power, ``F v = torque * w``, so that one number, the Jacobian, converts motion one way and force the other way.

    Attributes
    ----------
    drum : float
        Radius of the drum [m].
    sector : float
        Radius of the sector's rim [m].
    handle : float
        Distance of the fingers from the pivot [m].
    counts_per_turn : float or None
        Counts of the sensor per turn of the motor's shaft [1].
    torque_constant : float or None
        Torque per current [N m/A].
    resistance : float or None
        Resistance of the winding [ohm].
    supply : float or None
        Voltage of the amplifier's supply [V].
    rotor_inertia : float or None
        Inertia of the motor's rotor [kg m^2].
    source : str
        Where these numbers come from.

    Examples
    --------
    >>> import hapticlab as hl
    >>> drive = hl.devices.DriveTrain(drum=0.005, sector=0.075, handle=0.075, torque_constant=0.02, resistance=8, supply=12)
    >>> round(drive.jacobian, 6), round(drive.force_per_ampere, 6), round(drive.force_full, 6)
    (0.005, 4.0, 6.0)
    >>> drive.current([1.0, -2.0, 100.0])
    array([ 0.25, -0.5 ,  1.5 ])
    """

    drum: float
    sector: float
    handle: float
    counts_per_turn: float | None = None
    torque_constant: float | None = None
    resistance: float | None = None
    supply: float | None = None
    rotor_inertia: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        rules: dict[str, Any] = {name: {"unit": unit if unit != "ohm" else "", "above": 0.0} for name, unit in UNITS.items()}
        numbers(self, "a drive train", error=PaddleError, **rules)
        if not isinstance(self.source, str):
            raise PaddleError(f"source = {self.source!r}; a drive train needs a text that says where its numbers come from.")

    @property
    def jacobian(self) -> float:
        """Metres of the handle per radian of the motor [m/rad]; also the motor's torque per force at the handle [N m/N]."""
        return self.drum * self.handle / self.sector

    @property
    def metres_per_count(self) -> float | None:
        """Travel of the handle per count of the sensor [m]."""
        return None if self.counts_per_turn is None else 2 * math.pi * self.jacobian / self.counts_per_turn

    @property
    def force_per_ampere(self) -> float | None:
        """Force at the handle per current of the motor [N/A]."""
        return None if self.torque_constant is None else self.torque_constant / self.jacobian

    @property
    def current_full(self) -> float | None:
        """Largest current that the supply drives through the winding of a motor at rest [A]."""
        return None if self.supply is None or self.resistance is None else self.supply / self.resistance

    @property
    def force_full(self) -> float | None:
        """Force at the handle at the largest current [N]."""
        return None if self.current_full is None or self.force_per_ampere is None else self.current_full * self.force_per_ampere

    @property
    def rotor_mass(self) -> float | None:
        """What the inertia of the rotor adds to the mass that is felt at the handle [kg]: it divides by the Jacobian squared."""
        return None if self.rotor_inertia is None else self.rotor_inertia / self.jacobian**2

    def torque(self, force: ArrayLike) -> Array:
        """Return the torque of the motor [N m] for a force at the handle [N], any shape.

        Parameters
        ----------
        force : array_like
            Force at the handle [N], any shape.
        """
        return np.asarray(force, float) * self.jacobian

    def current(self, force: ArrayLike) -> Array:
        """Return the current [A] for a force at the handle [N], any shape; no more than the supply drives, where it is known.

        Parameters
        ----------
        force : array_like
            Force at the handle [N], any shape.

        Raises
        ------
        PaddleError
            If the torque constant is not known.
        """
        if self.torque_constant is None:
            raise PaddleError(
                "this drive train has no torque_constant, so the current for a force is not known. Give it, as in "
                "dataclasses.replace(drive, torque_constant=0.02)."
            )
        most = self.current_full or math.inf
        return np.clip(self.torque(force) / self.torque_constant, -most, most)

    def duty(self, force: ArrayLike, *, squared: bool = False) -> Array:
        """Return the part of full duty, 0 to 1, for the size of a force at the handle [N], any shape; the motor is at rest.

        Parameters
        ----------
        force : array_like
            [N]
        squared : bool
            Whether the current grows with the square of the duty, as published Hapkit sketches take it, or with the duty.

        Raises
        ------
        PaddleError
            If the torque constant, the supply or the resistance is not known.
        """
        part = np.abs(self.current(force))
        if self.current_full is None:
            raise PaddleError("this drive train lacks its supply or its resistance, so the duty for a force is not known.")
        return np.sqrt(part / self.current_full) if squared else part / self.current_full

    def __str__(self) -> str:
        radii = ", ".join(f"{name} {1e3 * getattr(self, name):.4g} mm" for name in ("drum", "sector", "handle"))
        rows = {"radii": radii}
        if self.metres_per_count is not None:
            rows["sensor"] = f"{self.counts_per_turn:.6g} counts per turn, {1e6 * self.metres_per_count:.4g} um per count"
        if self.force_per_ampere is not None:
            rows["motor"] = f"{self.torque_constant:.4g} N m/A, {self.force_per_ampere:.4g} N/A at the handle"
        if self.force_full is not None:
            rows["supply"] = f"at most {self.current_full:.4g} A, {self.force_full:.4g} N at the handle"
        if self.rotor_mass is not None:
            rows["rotor"] = f"felt as {1e3 * self.rotor_mass:.4g} g at the handle"
        title = f"drive: the handle moves {1e3 * self.jacobian:.4g} mm per radian of the motor"
        return card(title, {**rows, "source": self.source or "not given"})

    def as_data(self) -> dict[str, Any]:
        """Return what a file holds of it: each known number under its name and unit, and the source."""
        known = {name: getattr(self, name) for name in UNITS if getattr(self, name) is not None}
        return {**{f"{name} [{UNITS[name]}]": value for name, value in known.items()}, "source": self.source}


def from_data(held: Any) -> DriveTrain:
    """Return the drive train that a file holds, or refuse it in words."""
    keys = {f"{name} [{unit}]": name for name, unit in UNITS.items()} | {"source": "source"}
    if not isinstance(held, dict) or (unknown := [key for key in held if key not in keys]):
        what = repr(unknown[0]) if isinstance(held, dict) else "what is not a list of quantities"
        raise PaddleError(f"its drive holds {what}; the quantities are {', '.join(keys)}")
    for key, value in held.items():
        if key != "source" and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise PaddleError(f"{key} of its drive is not a number")
    told = {keys[key]: value for key, value in held.items()}
    if lacking := [one.name for one in fields(DriveTrain)[:3] if one.name not in told]:
        raise PaddleError(f"its drive has no {lacking[0]}")
    return DriveTrain(**told)
