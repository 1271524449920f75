"""Energy books of a scene: supplied = stored + dissipated + leak, while it runs; the leak is what the numbers add or lose.

The books are first-order coordinates like any other, so that every method keeps them with its own error, and what does
not balance is the method's: a spring wall of Fig. 23.6 that generates energy shows it here sample by sample.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import sympy as sp

from ...base.shows_itself import ShowsItself
from ...base.telemetry import check_record
from ...errors import AnalysisError, SceneError
from ...scene.contact.contact import friction
from ...scene.mechanics.lagrange import Mechanics
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import acceleration, coordinate, lag_of, t, v, x
from .energy import energy
from .finding_plots import plot_balance

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from ...base.annotations import Array
    from ...base.telemetry import Telemetry
    from ...scene.contact.contact import Contact
    from ...scene.scene import Scene

#: what a scene's books record [J]
CHANNELS = ("supplied", "stored", "dissipated", "leak")


def energy_books(
    scene: Scene,
    *,
    stored: sp.Expr | float | None = None,
    supplied: sp.Expr | float | None = None,
    dissipated: sp.Expr | float = 0,
    contacts: Iterable[Contact | friction] = (),
) -> Scene:
    """Return the scene with its energy books: the watched channels supplied, stored, dissipated and leak, all in J.

    ``supplied`` is the energy at the first sample and all work done on the environment since, by the handle and by other
    forces; ``leak = supplied - stored - dissipated`` is zero for the equations of motion themselves, positive where the
    method (or the hold of the handle between samples) has lost energy, negative where it has made some. Sampling leaks at
    the port beside that: :func:`balance`. The books cost three first-order coordinates.

    What ``hl.mechanics.lagrange`` made brings its own energies: stored is sum q' dL/dq' - L and what the springs of its contacts
    hold. For equations of motion written out, give them.

    Parameters
    ----------
    scene : Scene
    stored : expression [J], optional
        Energy of the bodies and springs, of coordinates, rates, x(t) and v(t).
    supplied : expression [W], optional
        Power put in; ``force * v(t)`` unless given, which needs a force without samples.
    dissipated : expression [W]
        Power lost in dampers.
    contacts : sequence of Contact or friction
        Of equations written out: their springs, losses and work are added to the three above, whatever their law.

    Returns
    -------
    Scene

    Raises
    ------
    AnalysisError
        The scene has no equations of motion, or does not say what it stores.

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> from hapticlab import t, v, x
    >>> m, K, b = hl.parameters("m K b", units="kg N/m N*s/m")
    >>> z = hl.coordinate("z", unit="m")
    >>> F = hl.laws.virtual_coupler(z, K=K, b=b)
    >>> scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])
    >>> energy = m * z.diff(t) ** 2 / 2 + K * (x(t) - z) ** 2 / 2
    >>> list(hl.records.energy_books(scene, stored=energy, dissipated=b * (v(t) - z.diff(t)) ** 2).watch)
    ['supplied', 'stored', 'dissipated', 'leak']
    """
    if not scene.coordinates:
        raise AnalysisError(
            f"{scene.name} has no equations of motion, so nothing in it can store or leak energy between samples. For the "
            "energy exchanged at the port use hl.energy(log)"
        )
    account = _of_mechanics(scene) if stored is None else _written_out(scene, stored, supplied, dissipated)
    for element in contacts:
        account = account.with_contact(element, scene.coordinates)
    return account.kept_in(scene)


@dataclass(frozen=True)
class _Account:
    """Energy stored [J]; powers supplied and dissipated [W]; what impacts supply and dissipate at once [J]."""

    stored: sp.Expr
    supplied: sp.Expr
    dissipated: sp.Expr
    struck: sp.Expr = sp.S.Zero
    lost: sp.Expr = sp.S.Zero

    def with_contact(self, element, coordinates):
        """Return the account with a contact or a friction in it."""
        if isinstance(element, friction):
            # what moves the surfaces besides the coordinates (handle, belt) does its work through the same force
            driven = element.slip - sp.Add(*(Partial(element.slip, q.diff(t)) * q.diff(t) for q in coordinates))
            return replace(
                self,
                supplied=self.supplied + element.force * driven,
                dissipated=self.dissipated + element.force * element.slip,
            )
        rate = Rate(element.gap)
        driven = Partial(element.gap, x(t)) * v(t) + Partial(element.gap, t)
        account = replace(self, supplied=self.supplied - element.force * driven)
        if element.is_force:
            spring = element.contact_law.stored(element.gap)
            return replace(
                account,
                stored=account.stored + spring,
                dissipated=account.dissipated - element.force * rate - Rate(spring),
            )
        return replace(account, struck=account.struck + element.impact_work, lost=account.lost + element.impact_loss)

    def kept_in(self, scene):
        """Return the scene with the account as coordinates and channels."""
        put_in = coordinate("supplied_to_date", unit="J", initial=self.stored)
        taken = coordinate("dissipated_to_date", unit="J")
        supplied, dissipated = put_in + self.struck, taken + self.lost
        books = dict(zip(CHANNELS, (supplied, self.stored, dissipated, supplied - self.stored - dissipated), strict=True))
        twice = sorted(set(books) & set(scene.watch))
        if twice:
            raise SceneError(f"{scene.name} already watches {', '.join(twice)}, a name that the energy books need; rename yours")
        eom = [*scene.eom, sp.Eq(put_in.diff(t), self.supplied), sp.Eq(taken.diff(t), self.dissipated)]
        return replace(scene, eom=tuple(eom), watch={**scene.watch, **books}, name=f"{scene.name} with energy books")


def _of_mechanics(scene):
    """Return the account of what hl.mechanics.lagrange made."""
    models = [e for e in scene.eom if isinstance(e, Mechanics)]
    covered = {q for model in models for q in model.coordinates}
    bare = [type(q).__name__ for q in scene.coordinates if q not in covered]
    if bare or any(model.lagrangian is None for model in models):
        named = f"the equation of {', '.join(bare)} gives" if bare else "equations that came without a Lagrangian give"
        raise AnalysisError(f"{scene.name}: {named} no energy; give stored=, supplied= and dissipated=")
    account = _Account(sp.S.Zero, sp.S.Zero, sp.S.Zero)
    for model in models:
        account = _with_model(account, model, scene)
        for element in model.contacts:
            account = account.with_contact(element, model.coordinates)
    return account


def _with_model(account, model, scene):
    L, R = model.lagrangian, model.dissipation
    driving = next((g for g in model.constraints if g.has(x(t), v(t)) or Partial(g, t).doit() != 0), None)
    if driving is not None:
        raise AnalysisError(
            f"{scene.name}: the constraint {driving} = 0 moves with the handle or with time, and its force does work that "
            "the books do not contain. Give stored=, supplied= and dissipated="
        )
    rates = [q.diff(t) for q in model.coordinates]
    driven = Partial(L, x(t)) * v(t) + Partial(L, t)
    if L.has(v(t)):
        driven += Partial(L, v(t)) * acceleration(t)
    pushed = sp.Add(*(Q * q.diff(t) for q, Q in dict(model.forces).items()))
    return replace(
        account,
        stored=account.stored + model.energy,
        supplied=account.supplied + pushed - driven + Partial(R, v(t)) * v(t),
        dissipated=account.dissipated + sp.Add(*(Partial(R, w) * w for w in (*rates, v(t)))),
    )


def _written_out(scene, stored, supplied, dissipated):
    if supplied is None:
        samples = [f for f in scene.force.atoms(sp.Function) if getattr(type(f), "role", None) in ("handle", "signal")]
        if any(lag_of(f) is not None for f in samples):
            raise AnalysisError(
                f"{scene.name}: its force contains samples, so the power that it supplies to the equations of motion is not "
                "known between them. Give supplied=, a power in x(t) and v(t)"
            )
        supplied = scene.force * v(t)
    return _Account(sp.sympify(stored), sp.sympify(supplied), sp.sympify(dissipated))


@dataclass(frozen=True, eq=False)
class Balance(ShowsItself):
    """The energy books of a run, and what the port says beside them.

    Attributes
    ----------
    t : array, shape (N,)
        [s]
    supplied, stored, dissipated, leak : array, shape (N,)
        As recorded [J]; supplied = stored + dissipated + leak.
    port : array, shape (N,)
        Work of the handle at the port, force and displacement as they acted [J], from 0.
    sampling : array, shape (N,)
        What the port gave beyond what the equations of motion were supplied with [J]: energy lost, where positive, by holding
        the force over a period, by what the hold makes of the handle between samples, and by impulses that are felt
        later than they acted. Work of other forces than the handle's is part of it.
    """

    t: Array
    supplied: Array
    stored: Array
    dissipated: Array
    leak: Array
    port: Array
    sampling: Array

    def plot(self) -> Figure:
        """Return a figure: where the supplied energy is, and what the books cannot account for."""
        return plot_balance(self)

    def __str__(self) -> str:
        put_in, kept, lost = (a[-1] - a[0] for a in (self.supplied, self.stored, self.dissipated))
        worst = self.leak[np.argmax(np.abs(self.leak))]
        return (
            f"supplied {1e3 * put_in:.4g} mJ = stored {1e3 * kept:.4g} + dissipated {1e3 * lost:.4g} "
            f"+ leak {1e3 * self.leak[-1]:.2g} mJ ({1e3 * worst:.2g} mJ at worst); "
            f"the port gave {1e3 * self.port[-1]:.4g} mJ, which differs by {1e3 * self.sampling[-1]:.2g} mJ, the effect of "
            "the hold, of felt impulses and of other forces"
        )


def balance(log: Telemetry) -> Balance:
    """Return the energy books of a run of a scene made by :func:`energy_books`.

    Parameters
    ----------
    log : Telemetry

    Returns
    -------
    Balance

    Raises
    ------
    AnalysisError
        The run did not record the books.

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> m, K = hl.parameters("m K", units="kg N/m", values=(0.05, 200))
    >>> z = hl.coordinate("z", unit="m")
    >>> pull = K * (hl.x(hl.t) - z)
    >>> L = m * z.diff(hl.t) ** 2 / 2 - K * (hl.x(hl.t) - z) ** 2 / 2
    >>> books = hl.records.energy_books(hl.Scene(force=pull, eom=[hl.mechanics.lagrange(L)]))
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=1.0, T=1e-3, hand=hl.Hand(push=1.0))
    >>> result = hl.records.balance(paddle.run(books, duration=0.05, progress=False))
    >>> bool(abs(result.leak[-1]) < 1e-3 * result.supplied[-1])
    True
    """
    check_record(log, "balance")
    missing = [name for name in CHANNELS if name not in log.channels]
    if missing:
        raise AnalysisError(
            f"balance: the record has no {', '.join(missing)}. Run hl.records.energy_books(scene), which watches them, "
            "instead of the scene alone"
        )
    kept = {name: np.asarray(log.channels[name], float) for name in CHANNELS}
    port = energy(log).W
    return Balance(np.asarray(log.t), **kept, port=port, sampling=port - (kept["supplied"] - kept["supplied"][0]))
