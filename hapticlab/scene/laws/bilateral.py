"""One handle's side of a coupling between two: the law that runs on its board and hears where the other handle is.

A message has the other handle's position and velocity, what that side heard itself (an echo), and a beat that changes with
every message; never a force. Both sides compute and limit their forces themselves, and a side that hears nothing fades.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice
from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.cases import when
from ..notation.symbols import T, n, parameters, signal, v, x
from ..scene import Scene

if TYPE_CHECKING:
    from ...base.annotations import Number

ARCHITECTURES = ("position-position", "position-force", "wave")
ROLES = ("leader", "follower")
#: what a message sets here -> the column of the other side's samples that it comes from; beside these the beat
HEARD = {
    "other_x": "x",
    "other_v": "v",
    "echo_x": "heard_x",
    "echo_v": "heard_v",
    "other_gain": "gain",
    "other_energy": "energy_in",
}
BEAT = "beat"
#: of the filter of waves [Hz]
CUTOFF = 50.0
#: a handle is nowhere faster than this [m/s]
FASTEST = amount(10.0, "m/s", "fastest")
#: what an Engagement has
UNITS = {"hold": "s", "fade": "s", "ramp": "s", "travel": "m", "jump": "m"}

_BEAT_HEARD = signal("heard", unit="1")


@dataclass(frozen=True, kw_only=True)
class Engagement(ShowsItself):
    """When a coupling takes hold of the other handle, and when it lets go of it.

    Parameters
    ----------
    hold, fade : float or text [s]
        A silence of ``hold`` changes nothing; after it the force falls to 0 within ``fade``. Their sum is the time after
        the last message at which the force is 0.
    ramp : float or text [s]
        The force rises within this time once the other is heard, at first and again.
    travel : float or text [m]
        A position beyond it counts as silence, as do a velocity beyond 10 m/s and a value that is not a number.
    jump : float or text [m]
        A step of the other's position from one message to the next by more puts the force to 0, from where it rises again.

    Examples
    --------
    >>> import hapticlab as hl
    >>> side = hl.laws.bilateral_coupling(engagement=hl.laws.Engagement(hold="20 ms", fade="30 ms"))
    """

    hold: Number = 0.05
    fade: Number = 0.05
    ramp: Number = 0.5
    travel: Number = 0.1
    jump: Number = 0.02

    def __post_init__(self) -> None:
        for name in UNITS:
            self.amount_of(name)

    def amount_of(self, name: str) -> sp.Expr:
        """One of these as a quantity of a scene.

        Parameters
        ----------
        name : str
            Name of one of the attributes of this record.
        """
        return amount(getattr(self, name), UNITS[name], name, "a coupling", above=0)


ENGAGEMENT = Engagement()


def bilateral_coupling(
    architecture: str = "position-position",
    *,
    role: str = "follower",
    controller: bool = False,
    cutoff: Number = CUTOFF,
    engagement: Engagement = ENGAGEMENT,
) -> Scene:
    """One side of a bilateral coupling: a force from this handle and from what is heard of the other one.

    * ``"position-position"``: on both sides a spring and a damper to the place where the other handle was heard,
      F = k (x - x_other) + b (v - v_other).
    * ``"position-force"``: the follower as above. The leader gets the follower's force with the other sign, computed
      here from the positions that the follower had: F = k (x_echo - x_other) + b (v_echo - v_other), where the echo is
      where the follower heard the leader. The follower's gain comes with it, so that both forces fade together.
    * ``"wave"``: a line of wave impedance b (Anderson and Spong 1989; Niemeyer and Slotine 1991), F = b (v - r). The
      wave r [m/s] that arrives is 2 v_other - r_other, where the echo r_other is the wave that the other side used: no
      more than velocities are needed. While the gain is below 1 the wave that is sent has the gain too. A handle
      reflects waves, and fast ones with a gain slightly above 1, because its force is held while it moves on: a low-
      pass filter of the wave that arrives takes that away. At rest a delay d and the filter make a spring b/(d + 1/(2
      pi cutoff)) of the line. k (0 unless bound) adds a spring against drift, which is not passive under delay.

    The force has a gain from 0 to 1, which is 0 until the other is heard and falls to 0 where the other is silent: see
    :class:`Engagement`.

    Parameters
    ----------
    architecture : {"position-position", "position-force", "wave"}
    role : {"follower", "leader"}
        Of this side, for position-force.
    controller : bool
        A passivity controller on this side: what the link gives to this handle stays within what the other handle gave
        to the link, as heard (Ryu, Artigas and Preusche 2010). The message then also has that energy. A damper of at
        most ``alpha_max`` [N s/m] takes back what was too much, as in :func:`passivity_controller`. What one hand
        stores in the coupling and gets back counts as too much: that is the price.
    cutoff : float or text [1/s]
        Of the filter of waves, in Hz.
    engagement : Engagement
        When the coupling takes hold of what it hears, and when it lets go.

    Returns
    -------
    Scene
        With parameters k [N/m], b [N s/m] (0 unless bound, except for waves) and those that messages set. It watches
        the gain, and what the other side and the measurement of the link's latency need.

    Raises
    ------
    SceneError

    Examples
    --------
    >>> import hapticlab as hl
    >>> side = hl.laws.bilateral_coupling()(k=100, b=0.5)
    >>> sorted(side.watch)
    ['gain', 'heard']
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> pair = hl.devices.TwoPaddles(paddle, paddle, side, delay="10 ms")
    """
    choice("architecture", architecture, ARCHITECTURES, error=SceneError)
    choice("role", role, ROLES, error=SceneError)
    wave, leads = architecture == "wave", architecture == "position-force" and role == "leader"
    names = ["other_x", "other_v", *["echo_x", "other_gain"] * leads, *["echo_v"] * (leads or wave)]
    far, heard_equations, (fresh, jumped) = _heard(names, engagement)
    gain, gain_equations = _gain(fresh, jumped, engagement)
    k, b = parameters("k b", units="N/m N*s/m", values=(0, None) if wave else (None, 0))
    filtering = []
    if wave:
        came, filtering = _filtered(2 * far["other_v"] - far["echo_v"], cutoff)
        force = gain * (b * (v(n) - came) + k * (x(n) - far["other_x"]))
        # the wave that is sent, 2 v - heard_v, fades with the force: without work of the handle it would be energy from nowhere
        watch = {"heard_v": 2 * v(n) - gain * (2 * v(n) - came)}
    elif leads:
        stretch, rate = far["echo_x"] - far["other_x"], far["echo_v"] - far["other_v"]
        force, watch = gain * far["other_gain"] * (k * stretch + b * rate), {}
    else:
        force = gain * (k * (x(n) - far["other_x"]) + b * (v(n) - far["other_v"]))
        follows = architecture == "position-force"
        watch = {"heard_x": far["other_x"], "heard_v": far["other_v"]} if follows else {}
    equations, watch = [*heard_equations, *gain_equations, *filtering], {**watch, "gain": gain, "heard": _BEAT_HEARD(n)}
    if controller:
        force, more, seen = _controlled(force, gain)
        equations, watch = [*equations, *more], watch | seen
    name = f"{architecture} coupling" + (f", {role}" if architecture == "position-force" else "")
    return Scene(force, equations, watch=watch, name=name)


def _heard(names, engagement):
    """What was heard last that can be: {parameter: signal}, equations, and whether there is news, and a jump in it."""
    travel, jump = engagement.amount_of("travel"), engagement.amount_of("jump")
    beat = parameters(BEAT, units="1", values=0)
    units = {name: {"x": "m", "v": "m/s", "n": "1"}[name[-1]] for name in names}
    most = {"m": travel, "m/s": FASTEST, "1": 1}
    given = {name: parameters(name, units=unit, values=0) for name, unit in units.items()}
    last = {name: signal(f"last_{name}", unit=unit) for name, unit in units.items()}
    # false where a value is not a number
    sane = [abs(p) <= most[units[name]] for name, p in given.items()]
    fresh = sp.And(sp.Ne(beat, _BEAT_HEARD(n - 1)), *sane)
    jumped = sp.And(fresh, abs(given["other_x"] - last["other_x"](n - 1)) > jump)
    equations = [_is(_BEAT_HEARD(n), when(fresh, beat, _BEAT_HEARD(n - 1)))]
    equations += [_is(last[name](n), when(fresh, p, last[name](n - 1))) for name, p in given.items()]
    return {name: y(n) for name, y in last.items()}, equations, (fresh, jumped)


def _gain(fresh, jumped, engagement):
    hold, fade, ramp = (engagement.amount_of(name) for name in ("hold", "fade", "ramp"))
    silent, gain = signal("silent", unit="s", initial=hold + fade), signal("gain", unit="1")
    allowed = sp.Min(1, (hold + fade - silent(n)) / fade)
    equations = [
        _is(silent(n), when(fresh, 0, sp.Min(silent(n - 1) + T, hold + fade))),
        _is(gain(n), when(jumped, 0, sp.Min(allowed, gain(n - 1) + T / ramp))),
    ]
    return gain(n), equations


def _filtered(wave, cutoff):
    """A wave after a first-order low-pass filter, by implicit Euler, which passes no frequency with a gain above 1."""
    rate, r = 2 * sp.pi * amount(cutoff, "1/s", "cutoff", "a coupling", above=0), signal("r", unit="m/s")
    return r(n), [_is(r(n), (r(n - 1) + T * rate * wave) / (1 + T * rate))]


def _controlled(force, gain):
    """The force with a damper that keeps what the link gave here within what the other handle gave to it."""
    alpha_max, other = parameters("alpha_max other_energy", units="N*s/m J", values=(None, 0))
    sent, added, alpha = signal("F_link", unit="N"), signal("F_alpha", unit="N"), signal("alpha", unit="N*s/m")
    taken, given, spent = (signal(name, unit="J") for name in ("energy_in", "energy_out", "energy_alpha"))
    moved = x(n) - x(n - 1)
    work = sent(n - 1) * moved
    owed = given(n) - spent(n) - other
    equations = [
        _is(taken(n), taken(n - 1) + sp.Max(work, 0)),
        _is(given(n), given(n - 1) + sp.Max(-work, 0)),
        _is(spent(n), spent(n - 1) + added(n - 1) * moved),
        _is(sent(n), force),
        _is(alpha(n), when((moved**2 > 0) & (owed > 0), gain * sp.Min(alpha_max, owed * T / moved**2))),
        _is(added(n), alpha(n) * moved / T),
    ]
    return sent(n) + added(n), equations, {"energy_in": taken(n), "alpha": alpha(n)}


def _is(left, right):
    return sp.Eq(left, right, evaluate=False)
