"""Equations of motion from energies: Lagrange's equations, kept as derivatives that the compiler takes on its graph."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...base.arguments import choice
from ...base.shows_itself import Typeset
from ...errors import MassError, SceneError
from ..contact.contact import Contact, friction
from ..notation.checks import agree_with, applied
from ..notation.derivative import Partial, Rate
from ..notation.symbols import t
from ..notation.typeset import typeset
from ..notation.units import agree, unit_of
from ..notation.written import expression, zero_of

if TYPE_CHECKING:
    from collections.abc import Sequence


#: equations of more coordinates take long to work out, and their Lagrangian is read more easily
MOST_WORKED_OUT = 3
ENFORCE = ("auto", "embed", "kkt", "baumgarte", "numeric")


@dataclass(frozen=True)
class Mechanics(Typeset):
    """Equations of motion ``M a = f`` of some coordinates, their constraints and contacts; one entry of a scene's ``eom``.

    Made by :func:`lagrange` or :func:`~hapticlab.scene.mechanics.sympy_models.from_mechanics`.

    Attributes
    ----------
    coordinates : tuple of coordinates, shape (N,)
    orders : tuple of int, shape (N,)
        2 where ``a`` holds q'', 1 where it holds q'.
    M : tuple of tuples of expressions, shape (N, N)
    f : tuple of expressions, shape (N,)
        Forces of contacts and friction included; the forces of the constraints are not.
    written : tuple of expressions
        What M and f are made of, for checks of symbols and units.
    constraints : tuple of expressions, each zero
        Holonomic, or linear in the rates.
    contacts : tuple of Contact and friction
    lagrangian : expression [J], or None
    enforce : {"auto", "embed", "kkt", "baumgarte", "numeric"}
        How constraints are kept; see :func:`lagrange`.
    alpha : float or None
        Rate of Baumgarte's stabilisation [1/s].
    dissipation : expression [W]
        Rayleigh's function.
    forces : tuple of (coordinate, expression)
    notes : tuple of str
        What a listing of the program says about where the equations came from.
    names : tuple of (symbol of SymPy, expression)
        What the symbols of a model of ``sympy.physics.mechanics`` became.
    """

    coordinates: tuple[sp.Expr, ...]
    orders: tuple[int, ...]
    M: tuple[tuple[sp.Expr, ...], ...]
    f: tuple[sp.Expr, ...]
    written: tuple[sp.Expr, ...]
    constraints: tuple[sp.Expr, ...] = ()
    contacts: tuple[Any, ...] = ()
    lagrangian: sp.Expr = None
    enforce: str = "auto"
    alpha: float | None = None
    dissipation: sp.Expr = sp.S.Zero
    forces: tuple[tuple[sp.Expr, sp.Expr], ...] = ()
    notes: tuple[str, ...] = ()
    names: tuple[tuple[Any, sp.Expr], ...] = ()

    def __post_init__(self) -> None:
        choice("enforce", self.enforce, ENFORCE, error=SceneError)
        if self.alpha is not None and self.enforce != "baumgarte":
            raise SceneError(
                f"alpha = {self.alpha} is the feedback of Baumgarte's stabilisation, which enforce = {self.enforce!r} does "
                "not use. Write enforce='baumgarte', or leave out alpha"
            )
        names = [c.name for c in self.contacts]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice:
            raise SceneError(f"two contacts are called {twice}; give each its own, hl.contact.Contact(..., name='...')")

    def __getitem__(self, name: Any) -> sp.Expr:
        """The coordinate of a name; the coordinate or parameter that a symbol of SymPy became."""
        if isinstance(name, sp.Basic) and name in dict(self.names):
            return dict(self.names)[name]
        known = {type(q).__name__: q for q in self.coordinates}
        if name not in known:
            raise SceneError(f"no coordinate {name!r}; there are {', '.join(known)}")
        return known[name]

    @property
    def energy(self) -> sp.Expr:
        """The energy [J] that a Lagrangian without explicit time conserves: the sum of q' dL/dq' minus L."""
        if self.lagrangian is None:
            raise SceneError("these equations came without a Lagrangian, so their energy is not known")
        rates = [q.diff(t) for q in self.coordinates]
        return sp.Add(*(w * Partial(self.lagrangian, w) for w in rates)) - self.lagrangian

    @property
    def equations(self) -> tuple[sp.Eq, ...]:
        """The equations in symbols, one ``sp.Eq`` per coordinate, evaluated for a reader; slow for more than three links."""
        unknowns = [q.diff(t, order) for q, order in zip(self.coordinates, self.orders, strict=True)]
        multipliers = sp.symbols(f"lambda1:{len(self.constraints) + 1}")
        made = []
        for q, row, f in zip(self.coordinates, self.M, self.f, strict=True):
            left = sp.Add(*(m.doit() * a for m, a in zip(row, unknowns, strict=True)))
            held = [_along(g, q) * y for g, y in zip(self.constraints, multipliers, strict=True)]
            made.append(sp.Eq(left, f.doit() + sp.Add(*held), evaluate=False))
        return tuple(made)

    def __str__(self) -> str:
        head = f"L = {self.lagrangian}" if self.lagrangian is not None else f"M a = f of {len(self.coordinates)} coordinates"
        contacts = [f"{c.name}: {getattr(c, 'gap', None) if isinstance(c, Contact) else c.slip}" for c in self.contacts]
        return "\n  ".join([head, *(f"0 = {g}" for g in self.constraints), *contacts])

    def _sentence(self):
        kept = f" under {len(self.constraints)} constraints" if self.constraints else ""
        return f"equations of motion of {', '.join(type(q).__name__ for q in self.coordinates)}{kept}"

    def _facts(self):
        return []

    def _equations(self):
        return [*map(typeset, self.shown)]

    @property
    def shown(self):
        """What a reader is shown, one ``sp.Eq`` a line: the equations and constraints; of many coordinates the Lagrangian."""
        if len(self.coordinates) > MOST_WORKED_OUT and self.lagrangian is not None:
            return (sp.Eq(sp.Symbol("L"), self.lagrangian, evaluate=False),)
        return (*self.equations, *(sp.Eq(0, g, evaluate=False) for g in self.constraints))


def lagrange(
    L: sp.Expr,
    *,
    dissipation: sp.Expr | float = 0,
    forces: Mapping[sp.Expr, sp.Expr] | None = None,
    constraints: Sequence[sp.Expr] | sp.Expr = (),
    contacts: Sequence[Contact | friction] = (),
    enforce: str = "auto",
    alpha: float | None = None,
) -> Mechanics:
    """Lagrange's equations of motion, d/dt(dL/dq') - dL/dq + dR/dq' = Q, of every coordinate in L.

    Nothing is differentiated in symbols: the compiler does that on the graph of L, in a few milliseconds, so L may be
    written as it comes, velocities of points included. Printing the result in a notebook shows the equations worked
    out.

    Parameters
    ----------
    L : expression [J]
        Kinetic less potential energy, of coordinates, their rates, parameters, x(t) and t.
    dissipation : expression [W]
        Rayleigh's dissipation function R, such as c q'^2/2 for a damper c.
    forces : dict coordinate -> expression, optional
        Generalized forces Q: [N] for a coordinate in metres, [N m] for one in radians.
    constraints : sequence of sp.Eq or expressions that are zero
        Of positions, or linear in the rates (nonholonomic).
    contacts : sequence of Contact and friction
    enforce : {"auto", "embed", "kkt", "baumgarte", "numeric"}
        ``"embed"``: dependent coordinates in closed form, no drift. ``"kkt"``: multipliers and one projection per tick.
        ``"baumgarte"``: multipliers and feedback ``alpha`` of the drift. ``"numeric"``: dependent coordinates by
        Newton's method at run time. ``"auto"``: the first where a closed form is found, else the second.
    alpha : float [1/s], optional
        For ``"baumgarte"``.

    Returns
    -------
    Mechanics
        For ``Scene(eom=[...])``.

    Raises
    ------
    SceneError, UnitsError, MassError

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab import t
    >>> m, k = hl.parameters("m k", units="kg N/m")
    >>> z = hl.coordinate("z", unit="m")
    >>> hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2 - k * z**2 / 2).equations
    (Eq(m*Derivative(z(t), (t, 2)), -k*z(t)),)
    """
    L, R = expression(L, "L"), expression(dissipation, "dissipation")
    constraints = _listed(constraints)
    zeros = tuple(zero_of(g, f"constraint {k}") for k, g in enumerate(constraints, 1))
    for k, (given, g) in enumerate(zip(constraints, zeros, strict=True), 1):
        agree(given.args if isinstance(given, sp.Eq) else [g], f"constraint {k}")
    contacts = _listed(contacts)
    for c in contacts:
        if not isinstance(c, (Contact, friction)):
            raise SceneError(f"contacts contains {c!r}; needs hl.contact.Contact(gap, law) or hl.contact.friction(slip=...)")
    forces = {q: expression(Q, f"force on {q}") for q, Q in _forces(forces).items()}
    # a coordinate that gaps alone hold, such as the closest point of hl.shapes.track, moves by an equation of its own
    coordinates = tuple(applied([L, R, *zeros, *forces], "coordinate"))
    _check(L, R, forces, coordinates)
    _check_units(L, R, forces)
    return of_energies(L, R, forces, coordinates, zeros, contacts, enforce=enforce, alpha=alpha)


def of_energies(L, R, forces, coordinates, constraints, contacts=(), **facts):
    """The :class:`Mechanics` of energies and forces that have been checked."""
    rates = [q.diff(t) for q in coordinates]
    momenta = [Partial(L, w) for w in rates]
    N = range(len(rates))  # entries above the diagonal are those below it, so that the compiler sees that M is symmetric
    M = tuple(tuple(Partial(momenta[max(i, j)], rates[min(i, j)]) for j in N) for i in N)
    touched = {q: [c.generalized_force(q) for c in contacts if _touches(c, q)] for q in coordinates}
    f = tuple(
        sp.Add(Partial(L, q), -Rate(p), -Partial(R, w), forces.get(q, sp.S.Zero), *touched[q])
        for q, w, p in zip(coordinates, rates, momenta, strict=True)
    )
    written = (L, R, *forces.values(), *constraints, *(part for c in contacts for part in _parts(c)))
    energies = {"lagrangian": L, "dissipation": R, "forces": tuple(forces.items())}
    return Mechanics(coordinates, (2,) * len(coordinates), M, f, written, constraints, contacts, **energies, **facts)


def _listed(given):
    if isinstance(given, (sp.Basic, Contact, friction)):
        return (given,)
    return given if isinstance(given, tuple) else tuple(given)  # contacts_between says what it left out


def _touches(contact, q):
    """Whether a contact acts on a coordinate: by its gap, or by friction along its slip."""
    return any(getattr(contact, part, sp.S.Zero).has(q) for part in ("gap", "slip"))


def _parts(contact):
    """The expressions of a contact or friction: the gap or slip first, then its force and its constants."""
    return (contact.gap if isinstance(contact, Contact) else contact.slip, contact.force, *contact.constants)


def _forces(given):
    """Forces as a dict; its keys have to be coordinates."""
    if given is not None and not isinstance(given, Mapping):
        raise SceneError(f"forces = {given}; needs a dict that says on which coordinate each acts, such as forces={{z: F}}")
    for q in given or ():
        if not isinstance(q, sp.Basic):
            raise SceneError(f"forces has the key {q!r}; its keys are coordinates themselves, such as forces={{z: F}}")
    return dict(given or {})


def _along(g, q):
    """Gradient of a constraint by a coordinate, or by its rate where the constraint holds rates."""
    return Partial(g, q.diff(t) if g.atoms(sp.Derivative) else q).doit()


def _check(L, R, forces, coordinates):
    if not coordinates:
        raise MassError(f"L = {L} contains no coordinate; declare one, z = hl.coordinate('z', unit='m')")
    second = next((d for d in (L + R).atoms(sp.Derivative) if d.derivative_count > 1), None)
    if second is not None:
        raise SceneError(f"L or the dissipation contains {second}; energies depend on positions and rates only")
    for q in forces:
        if q not in coordinates or getattr(type(q), "role", None) != "coordinate":
            raise SceneError(f"forces has {q}; its keys are coordinates: {', '.join(map(str, coordinates))}")


def _check_units(L, R, forces):
    agree_with(L, "N*m", "L")
    agree_with(R, "W", "dissipation")
    for q, Q in forces.items():
        agree_with(Q, unit_of(sp.Mul(L, 1 / q, evaluate=False)), f"force on {type(q).__name__}")
