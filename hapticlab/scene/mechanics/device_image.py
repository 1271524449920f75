"""The device image driven by a constraint (section 23.5.3, last paragraph): a body that moves with the handle, no coupler."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from ...base.units import si_name
from ...errors import SceneError
from ..notation.checks import agree_with
from ..notation.derivative import Partial
from ..notation.symbols import t, x
from ..notation.units import dimension_of
from ..notation.written import check_name, zero_of


@dataclass(frozen=True)
class DeviceImage:
    """A constraint that holds the handle, and the force with which it is felt.

    Attributes
    ----------
    constraint : expression
        Zero; for ``constraints=`` of :func:`~hapticlab.scene.mechanics.lagrange.lagrange`.
    force : expression [N]
        On the environment, positive into it, as :class:`~hapticlab.scene.scene.Scene` takes it: the reaction of the
        constraint on the handle, -lambda d(constraint)/dx.
    """

    constraint: sp.Expr
    force: sp.Expr


def device_image(constraint: Any, *, name: str = "image") -> Any:
    """Impose the motion of the handle on the model, instead of coupling the two by a spring and damper.

    What is felt is the reaction, exact in position: no spring gives way. It needs the handle's acceleration, which is
    estimated, (v(n) - v(n-1))/T. The mass felt at the port therefore is limited: below the mass of the handle where v
    is measured, below twice that where v is the backward difference. Delay moves the limit: that of the difference goes
    down, to the mass of the handle; that of a measured v is twice as high with half a period of it, and back with a whole
    one. Past it the paddle refuses the scene; then a coupler is required. A program's ``facts["port_mass"]`` says how much
    it is, at the start.

    Parameters
    ----------
    constraint : sp.Eq or expression that is zero
        Of coordinates and x(t), such as ``q - x(t)`` or ``sp.Eq(q, x(t))``.
    name : str

    Returns
    -------
    DeviceImage

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab import t, x
    >>> q = hl.coordinate("q", unit="m")
    >>> hl.mechanics.device_image(q - x(t)).force
    image(t)
    """
    check_name(name, "device image")
    constraint = zero_of(constraint, name)
    along = Partial(constraint, x(t)).doit()
    if along == 0:
        raise SceneError(f"{name}: {constraint} = 0 does not contain x(t), so it does not act on the handle. Write q - x(t)")
    unit = si_name(tuple((k, -p) for k, p in (dimension_of(constraint, name) or ())) or ())
    reaction = sp.Function(name, real=True, unit=_per(unit), role="reaction", constraint=constraint)(t)
    force = -reaction * along
    agree_with(force, "N", f"force of {name}")
    return DeviceImage(constraint, force)


def _per(unit):
    """Unit of a multiplier: of a force times metres, per unit of the constraint."""
    return "N*m" if unit == "1" else f"N*m*({unit})"
