"""Passivity observer and controller around any scene, in the time domain (Hannaford and Ryu 2002), as scenes themselves.

A force sent at sample n is held while the handle moves from x(n) to x(n+1). At sample n the work done on the
environment is therefore known exactly, F(n-1) (x(n) - x(n-1)) for each period; F(n) (x(n) - x(n-1)) would be the work
of a force that nobody felt, and calls a wall that generates energy a damper. The exact pairing is that of Ryu, Kim and
Hannaford (2004).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice
from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.symbols import T, delay, n, parameters, signal, v, when, x
from ..notation.written import expression
from ..scene import check_scene

if TYPE_CHECKING:
    from ...base.annotations import Number, Term
    from ..scene import Scene


FORMS = ("series", "parallel")
_IDLE = signal("F_zero_for", unit="s")
#: unit of what a caller may bound; each becomes a parameter of that name
_UNITS = {"alpha_max": "N*s/m", "beta_max": "m/(N*s)", "force_max": "N", "forget": "s", "credit_max": "J", "reset": "s"}


def wall_energy() -> sp.Expr:
    """Energy stored in the spring of :func:`hapticlab.wall`, k max(x(n) - x_o, 0)^2/2: its storage function, Eq. (23.9).

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.wall_energy()
    k*Max(0, -x_o + x(n))**2/2
    """
    k, x_o = parameters("k x_o", units="N/m m", values=(None, 0))
    return k * sp.Max(x(n) - x_o, 0) ** 2 / 2


def passivity_observer(scene: Scene, *, lag: int = 0) -> Scene:
    """The scene with a passivity observer: the watched W [J] is the work done on the environment so far.

    W(n) = W(n-1) + F(n-1-lag) (x(n) - x(n-1)), exact where the force is held over whole periods: below zero the
    environment has given more than it took. The force is the scene's own. It sees what the scene sends at the place the
    sensor reads: a motor that saturates, or an encoder's counts, are between that and the work at the handle. It starts
    from zero: a spring that is loaded at the first sample gives back what nobody was seen to pay.

    Parameters
    ----------
    scene : Scene
    lag : int
        Whole samples from the computation of a force until it is felt.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> watched = hl.laws.passivity_observer(hl.wall()(k=500))
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> log = paddle.run(watched, duration=0.05, x=-0.002, v=0.2, progress=False)
    >>> bool(abs(log.W[-1] + hl.energy(log).generated) < 1e-9)
    True
    """
    check_scene(scene)
    lag = _whole(lag)
    W, sent = signal("W", unit="J"), signal("F_sent", unit="N")
    work = sp.Eq(W(n), W(n - 1) + sent(n - 1 - lag) * _moved(), evaluate=False)
    eom = (*scene.eom, work, sp.Eq(sent(n), scene.force, evaluate=False))
    watch = {**scene.watch, **_fresh(scene, {"W": W(n)})}
    return replace(scene, force=sent(n), eom=eom, watch=watch, name=f"{scene.name} with observer")


@dataclass(frozen=True, kw_only=True)
class Credit(ShowsItself):
    """How a passivity controller computes the energy credit of an environment, and how it limits the credit.

    Parameters
    ----------
    stored : expression [J]
        What the environment stores, such as :func:`wall_energy`, also at the first sample; zero lets every credit
        count. With it the controller follows a reference energy (Ryu, Preusche, Hannaford and Hirzinger 2005): it acts
        as soon as energy is generated, not only once everything stored was given back.
    forget : float or text [s], optional
        Time constant with which credit is forgotten: spent at the power at which it was earned, it lasts forget*ln 2 at
        most.
    credit_max : float or text [J], optional
        Credit above this value is removed.
    reset : float or text [s], optional
        All credit is removed when the scene's own force has been zero for this time, between two contacts.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.Credit(stored=hl.laws.wall_energy(), forget="1 s").forget
    '1 s'
    """

    stored: Term = 0
    forget: Number | None = None
    credit_max: Number | None = None
    reset: Number | None = None

    def __post_init__(self) -> None:
        expression(self.stored, "stored")


CREDIT = Credit()


def passivity_controller(
    scene: Scene,
    form: str = "series",
    *,
    alpha_max: Number | None = None,
    beta_max: Number | None = None,
    force_max: Number | None = None,
    credit: Credit = CREDIT,
    predict: bool = False,
    lag: int = 0,
) -> Scene:
    """The scene with a passivity controller, which dissipates the energy that the environment generated.

    The watched credit is what the port has taken since the start, less what the environment stores and less what was
    struck off by ``forget``, ``credit_max`` and ``reset``. It is kept from staying below zero

    * by a damper, ``form="series"``: F = f + alpha (x(n) - x(n-1))/T, with alpha = -credit T/(x(n) - x(n-1))^2. Both
      share the motion and their forces add. It takes back whatever is owed, from any scene, as long as the handle
      moves; it cannot act on a handle at rest, and is felt as drag, after a contact too.
    * by a dashpot in line, ``form="parallel"``: the scene sees x - slip, and slip grows by T beta F a sample, with
      beta = -credit/(T F^2). Both share the force and their motions add; velocity estimates in ``eom`` see the handle
      itself. It lets go of what is stored before that is given back, at rest too; it takes nothing back outside, and a
      wall lies deeper by slip until the handle has left it: under a steady push one that generates energy sinks. Needs
      ``stored``. The credit of a spring K stays within one period's leak, K/2 times the square of how far the spring
      moved, and the slip with the handle.

    An Uno has time for the series form at 1 kHz, also with one of ``stored``, ``predict``, ``force_max``,
    ``credit_max``; with ``forget`` at 900 Hz, with several of them, and for the parallel form, at 800 Hz.

    A human who is active for long fills the credit of an environment that dissipates, which may then be active for as
    long without being stopped. The cures are ``forget``, ``credit_max`` and ``reset`` of :class:`Credit`: they strike
    off credit, never debt, and so leave the environment passive. With ``stored`` given, what the environment stores is
    not forgotten.

    Parameters
    ----------
    scene : Scene
    form : {"series", "parallel"}
    alpha_max : float [N s/m]
        For "series": the largest damper, to be bound here or later; what it cannot take back at once waits. A
        hundredth to a tenth of :func:`hapticlab.stability.damper_limit` is enough; one count of an encoder is felt as
        alpha_max count/T, and beyond that limit the controller chatters by itself.
    beta_max : float [m/(N s)]
        For "parallel": the fastest slip, in m/s for each newton; to be bound here or later. A spring K that slips by
        1/(K T) has let go of everything within a sample.
    force_max : float [N], optional
        Limit of the whole force, which the observer then knows of; the motor's.
    credit : Credit
        What the environment stores, and what is struck off: ``hl.laws.Credit(stored=, forget=, credit_max=, reset=)``.
    predict : bool
        For "series": count what the coming period will generate if the handle moves on as it did. With the energy of a
        spring K as ``stored`` this adds the half-sample lead of Eq. (23.5), K/2 (x(n) - x(n-1)), when nothing is owed.
    lag : int
        Whole samples from the computation of a force until it is felt.

    Returns
    -------
    Scene
        It watches credit [J], and alpha [N s/m] or slip [m].

    Raises
    ------
    SceneError

    Examples
    --------
    >>> import hapticlab as hl
    >>> wall = hl.laws.passivity_controller(hl.wall(), alpha_max=5.0)(k=500)
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> bare, kept = (paddle.run(s, duration=0.2, x=-0.002, v=0.2, progress=False) for s in (hl.wall()(k=500), wall))
    >>> [bool(hl.energy(log).W[-1] < -1e-4) for log in (bare, kept)]
    [True, False]
    """
    check_scene(scene)
    stored = expression(credit.stored, "stored")
    lag = _whole(lag)
    _check(form, scene, stored, predict, lag)
    given = {"alpha_max": alpha_max, "beta_max": beta_max, "force_max": force_max, "forget": credit.forget}
    given |= {"credit_max": credit.credit_max, "reset": credit.reset}
    p = {name: parameters(name, units=unit, values=given) for name, unit, given in _asked(form, given)}
    make = _series if form == "series" else _parallel
    force, equations, watch = make(scene, p, stored, predict, lag)
    watch = {**scene.watch, **_fresh(scene, watch)}
    return replace(scene, force=force, eom=(*scene.eom, *equations), watch=watch, name=f"{scene.name}, {form} controller")


def _series(scene, p, stored, predict, lag):
    credit, sent, alpha = signal("credit", unit="J"), signal("F_sent", unit="N"), signal("alpha", unit="N*s/m")
    raw = signal("F_raw", unit="N")
    moved = _moved()
    owed = credit(n)
    if predict:
        owed += raw(n) * moved - (stored.xreplace({x(n): 2 * x(n) - x(n - 1)}) - stored)
    damper = when((moved**2 > 0) & (owed < 0), sp.Min(p["alpha_max"], -owed * T / moved**2))
    equations = (
        *_idle(raw, p),
        _is(credit(n), _kept(credit(n - 1), p) + sent(n - 1 - lag) * moved - (stored - delay(stored))),
        _is(raw(n), scene.force),
        _is(alpha(n), damper),
        _is(sent(n), _limited(raw(n) + alpha(n) * moved / T, p)),
    )
    return sent(n), equations, {"credit": credit(n), "alpha": alpha(n)}


def _parallel(scene, p, stored, predict, lag):
    credit, sent, beta = signal("credit", unit="J"), signal("F_sent", unit="N"), signal("beta", unit="m/(N*s)")
    slip, whole = signal("slip", unit="m"), signal("F_whole", unit="N")
    F = sent(n)
    left = stored.xreplace({x(n): x(n) - slip(n)})
    equations = (
        *_idle(whole, p),
        _is(whole(n), scene.force),  # without slip: zero once the handle is out of the wall
        _is(slip(n), when(sp.Eq(whole(n), 0), 0, slip(n - 1) + T * beta(n - 1) * sent(n - 1))),
        _is(credit(n), _kept(credit(n - 1), p) + sent(n - 1 - lag) * _moved() - (left - delay(left))),
        _is(F, _limited(_slipped(scene, slip), p)),
        _is(beta(n), when((F**2 > 0) & (credit(n) < 0), sp.Min(p["beta_max"], -credit(n) / (T * F**2)))),
    )
    return F, equations, {"credit": credit(n), "slip": slip(n)}


def _slipped(scene, slip):
    """The scene's force at the handle's position less the slip."""
    F = scene.force
    put = {a: a - slip(*a.args) for a in F.atoms(x)}
    put |= {a: a - (slip(*a.args) - slip(a.args[0] - 1)) / T for a in F.atoms(v)}
    return F.xreplace(put)


def _idle(raw, p):
    """The equation of the time since the scene's own force was last other than zero, where a limit on it is given."""
    return [_is(_IDLE(n), when(sp.Eq(raw(n), 0), _IDLE(n - 1) + T, 0))] if "reset" in p else []


def _kept(credit, p):
    """The credit a sample later; a debt stays whole."""
    if "reset" in p:
        credit = when(_IDLE(n - 1) >= p["reset"], sp.Min(credit, 0), credit)
    if "credit_max" in p:
        credit = sp.Min(credit, p["credit_max"])
    if "forget" in p:
        credit = when(credit > 0, credit * p["forget"] / (p["forget"] + T), credit)  # implicit Euler: no T makes it a debt
    return credit


def _limited(force, p):
    if "force_max" not in p:
        return force
    return sp.Max(sp.Min(force, p["force_max"]), -p["force_max"])


def _moved():
    return x(n) - x(n - 1)


def _is(left, right):
    return sp.Eq(left, right, evaluate=False)


def _asked(form, given):
    """Yield (name, unit, value) of the bounds that become parameters; the form's own is always one."""
    own, other = ("alpha_max", "beta_max") if form == "series" else ("beta_max", "alpha_max")
    if given[other] is not None:
        raise SceneError(f"{other} = {given[other]} is no part of the {form} form; give {own} in {_UNITS[own]}")
    for name, unit in _UNITS.items():
        if name == own or given[name] is not None:
            yield name, unit, given[name]


def _whole(lag):
    if not isinstance(lag, int) or lag < 0:
        raise SceneError(f"lag = {lag!r}; needs whole samples, 0 or more: the observer knows the handle at samples only")
    return lag


def _check(form, scene, stored, predict, lag):
    choice("form", form, FORMS, need="'series' (a damper beside the scene) or 'parallel' (a slip before it)", error=SceneError)
    alone = {a for a in stored.atoms(sp.Function) if hasattr(type(a), "role")} <= {x(n)} and not stored.has(delay)
    if form == "parallel" and (stored == 0 or not alone):
        raise SceneError(
            f"stored = {stored}; the parallel form lets go of what the environment stores and needs it as a function of "
            "x(n) alone: credit=hl.laws.Credit(stored=hl.laws.wall_energy()) for hl.wall()"
        )
    if form == "parallel" and scene.coordinates:
        moving = ", ".join(type(q).__name__ for q in scene.coordinates)
        raise SceneError(
            f"{scene.name} moves {moving} between samples, where a slip from sample to sample is not seen; the parallel form "
            "needs a force of samples, and form='series' takes any scene"
        )
    if predict and (form != "series" or lag or not alone):
        raise SceneError(
            f"predict=True with form = {form!r}, lag = {lag}, stored = {stored}; it looks one period ahead, which needs the "
            "series form, lag = 0 and an energy of x(n) alone"
        )


def _fresh(scene, watch):
    twice = sorted(set(watch) & set(scene.watch))
    if twice:
        raise SceneError(f"{scene.name} already watches {', '.join(twice)}, a name that is needed here; rename yours")
    return watch
