"""Equations of motion that ``sympy.physics.mechanics`` holds, as an entry of a scene: Lagrange's, Kane's, a System's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy as sp

from ...errors import MassError, SceneError
from ..notation.derivative import Partial
from ..notation.symbols import t
from .kane import check_version, of_kane
from .lagrange import lagrange, of_energies
from .sympy_symbols import Vocabulary, gathered

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.annotations import Number
    from .lagrange import Mechanics


def from_mechanics(
    system: Any,
    *,
    units: Mapping[Any, str] | None = None,
    values: Mapping[Any, Number] | None = None,
    initial: Mapping[Any, Any] | None = None,
    replace: Mapping[Any, Any] | None = None,
    enforce: str = "auto",
) -> Mechanics:
    """Use a model of ``sympy.physics.mechanics`` unchanged: a LagrangesMethod, KanesMethod or System.

    Of a LagrangesMethod only the Lagrangian, the loads and the constraints are taken, so ``form_lagranges_equations()``
    need not be called, and is not; a derivative is taken by the compiler. Kane's equations are taken as
    ``kanes_equations()`` leaves them, neither simplified nor solved: in q alone where the speeds are u = q', or where
    there are constraints; else in q and u. Constraints of the configuration are enforced as ``enforce`` says, so they
    do not drift; SymPy's own right-hand side keeps their second rate alone.

    Parameters
    ----------
    system : LagrangesMethod, KanesMethod or System
        A System whose equations have not been formed is asked to ``form_eoms()``.
    units : dict symbol or name -> str
        SI units of coordinates, speeds and constants; ``"1"`` for those that are not there. Terms are checked where
        every symbol has one.
    values : dict symbol or name -> number or text
        Of constants, which become parameters.
    initial : dict symbol, rate or name -> number, text or expression
        Where coordinates and speeds start; zero for those that are not there.
    replace : dict symbol or name -> expression
        What an input is: a force, a torque or a driven motion that is a function of time. Also what stands for a
        constant or a coordinate, such as ``hl.coordinate("q", unit="rad", range=(-1, 1))``. A coordinate that is
        replaced by ``x(t)`` moves with the handle and loses its equation.
    enforce : {"auto", "embed", "kkt", "baumgarte", "numeric"}
        How constraints are kept; see :func:`~hapticlab.scene.mechanics.lagrange.lagrange`.

    Returns
    -------
    Mechanics
        For ``Scene(eom=[...])``; indexed by a symbol of the model, it gives what the symbol became. A name that a scene
        uses itself (x, v, F, T, n, ...), and one that is no word, is changed, and a note of the program says so.

    Raises
    ------
    SceneError, MassError, UnitsError, ParameterError

    Examples
    --------
    >>> import hapticlab as hl
    >>> import sympy as sp
    >>> from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols
    >>> theta, (m, l, g) = dynamicsymbols("theta"), sp.symbols("m l g")
    >>> L = m * l**2 * theta.diff() ** 2 / 2 + m * g * l * sp.cos(theta)
    >>> mech = hl.mechanics.from_mechanics(
    ...     LagrangesMethod(L, [theta]), units={theta: "rad", m: "kg", l: "m", g: "m/s^2"},
    ...     values={m: 0.1, l: 0.2, g: 9.81}, initial={theta: "30 deg"},
    ... )
    >>> pendulum = hl.Scene(force=0, eom=[mech], watch=["theta"])
    >>> pendulum.values
    {'g': 9.81, 'l': 0.2, 'm': 0.1}
    >>> hl.compile(pendulum, T=1e-3).outputs[1].name
    'theta'
    """
    from sympy.physics.mechanics import KanesMethod, LagrangesMethod
    from sympy.physics.mechanics.system import System

    given = {"units": units, "values": values, "initial": initial, "replace": replace}
    if isinstance(system, System):
        if system.eom_method is None:
            system.form_eoms()
        system = system.eom_method
    if isinstance(system, LagrangesMethod):
        return _of_lagrange(system, given, enforce)
    if isinstance(system, KanesMethod):
        return of_kane(system, given, enforce)
    raise SceneError(
        f"{type(system).__name__}: needs a LagrangesMethod, KanesMethod or System of sympy.physics.mechanics; "
        "for energies alone write hl.mechanics.lagrange(L)"
    )


def _of_lagrange(method, given, enforce):
    check_version(method, ("_L", "_hol_coneqs"))
    (L,) = method._L
    q = list(method.q)
    holonomic = list(method._hol_coneqs)
    constraints = [*map(gathered, holonomic), *list(method.coneqs)[len(holonomic) :]]
    loads = _loads(method)
    parts = [L, *constraints, *(e for pair in loads for e in pair)]
    words = Vocabulary(q, parts, {}, **given)
    for p in q:
        if not any(sp.sympify(e).has(p) for e in parts):
            raise MassError(f"no energy, load or constraint contains {p}, so nothing determines it; leave it out")
    coordinates = tuple(words.table[p] for p in q if p in words.table)
    L, zeros, loads = words(L), tuple(map(words, constraints)), [tuple(map(words, pair)) for pair in loads]
    forces = {p: sp.Add(*(force * Partial(rate, p.diff(t)) for rate, force in loads)) for p in coordinates}
    forces = {p: Q for p, Q in forces.items() if Q != 0}
    if words.declared:
        lagrange(L, forces=forces)  # checks units
    facts = {"enforce": enforce, "notes": words.notes, "names": words.names}
    return of_energies(L, sp.S.Zero, forces, coordinates, zeros, **facts)


def _loads(method):
    """Pairs (component of a velocity, component of the force or torque along it)."""
    if not method.forcelist:
        return []
    if method.inertial is None:
        raise SceneError("LagrangesMethod has loads but no frame in which velocities are measured; give it frame=N")
    pairs = []
    for where, load in method.forcelist:
        moving = where.vel(method.inertial) if hasattr(where, "vel") else where.ang_vel_in(method.inertial)
        for components, frame in load.args:
            for axis, component in zip(frame, components, strict=True):
                if component != 0:
                    pairs.append((moving.dot(axis), component))
    return pairs
