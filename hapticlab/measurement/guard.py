"""A scene that cuts its own force: at the tick at which it moves too fast, or has given too much energy, the motor is off."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from ..scene.notation.symbols import n, parameters, signal, v, when, x

if TYPE_CHECKING:
    from ..scene.scene import Scene


def guarded(scene: Scene, *, energy_max: float, speed_max: float, periods: int = 0, keeps: float = 1.0) -> Scene:
    """The scene with a guard around its force: past a limit the force is zero, and stays so.

    The guard is part of the scene, so it acts at the sample that passes a limit, on a board as in simulation, and waits
    for no computer. Beside the board's own faults, which it comes before.

    Parameters
    ----------
    scene : Scene
    energy_max : float
        The most energy that the environment may have given the handle [J], more than it took.
    speed_max : float
        Of the handle, as the scene sees it [m/s].
    periods : int
        Whole periods of delay until a force acts, so that the energy pairs a force with the motion it acts on.
    keeps : float
        The part of the energy that counts one period later, 0 to 1. Below 1 the guard forgets: a wall near its limit gives
        a little energy for as long as an oscillation decays, and that alone must not cut it.

    Returns
    -------
    Scene
        It watches ``drawn`` [J], the energy given so far and not forgotten, and ``tripped``, 1 from the cut on.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, hand=hl.Hand(push=1.0))     # undamped: every wall chatters
    >>> wall = guarded(hl.wall()(k=500), energy_max=1e-3, speed_max=1.0)
    >>> log = paddle.run(wall, duration=0.5)
    >>> bool(log.tripped[0]), bool(log.tripped[-1]), float(log.F[log.tripped > 0].max())
    (False, True, 0.0)
    """
    most, fastest = parameters("energy_max speed_max", units="J m/s", values=(energy_max, speed_max))
    drawn, tripped, given = signal("drawn", unit="J"), signal("tripped", unit="1"), signal("given", unit="N")
    before = drawn(n - 1) if keeps == 1 else parameters("keeps", units="1", values=keeps) * drawn(n - 1)
    was_cut = tripped(n - 1) > sp.Rational(1, 2)
    too_much = sp.Or(was_cut, drawn(n) > most, sp.Abs(v(n)) > fastest)
    force = when(tripped(n) > sp.Rational(1, 2), 0, scene.force)
    eom = (
        *scene.eom,
        sp.Eq(given(n), force),
        sp.Eq(drawn(n), before - given(n - 1 - periods) * (x(n) - x(n - 1))),
        sp.Eq(tripped(n), when(too_much, 1, 0)),
    )
    watch = {**scene.watch, "drawn": drawn(n), "tripped": tripped(n)}
    return replace(scene, force=force, eom=eom, watch=watch, name=f"guarded {scene.name}")
