"""Three tasks of a course: a damped wall, a mass behind a coupler, and a mass that strikes a bumper."""

from __future__ import annotations

import functools
import inspect
import math
from numbers import Real
from typing import Literal

import sympy as sp

from ...base.profile.paddle_profile import PaddleProfile
from ...errors import AnalysisError
from ...scene.contact.contact import Contact
from ...scene.contact.penalty_laws import penalty
from ...scene.laws.adaptive_window import window_velocity
from ...scene.laws.chapter_laws import wall
from ...scene.laws.estimators import backward_velocity, filtered_velocity
from ...scene.laws.kalman import kalman_velocity
from ...scene.mechanics.lagrange import lagrange
from ...scene.notation.symbols import coordinate, n, parameters, t, v, x
from ...scene.scene import Scene
from ..accuracy.handle_motions import HandleMotion, handle_motions
from .task import OF_LAW, TEXTBOOK, Task

#: of a hand, for the Kalman filter [m/s^2]
ACCELERATION = 10.0
#: longest adaptive window [periods]
LONGEST = 4
#: how a hand strikes a bumper: back and forth at a tenth more than 3 Hz
STRIKES = HandleMotion("strikes", 0.012 * sp.sin(2 * sp.pi * 3.3 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.75)


def task(
    name: Literal["wall", "mass", "bumper"],
    *,
    paddle: PaddleProfile = TEXTBOOK,
    board: Literal["uno", "pico", "cortex-m4f"] = "uno",
    **constants: float,
) -> Task:
    """One of three tasks: a wall with a damper, a mass behind a virtual coupler, or a mass that strikes a bumper.

    Parameters
    ----------
    name : {"wall", "mass", "bumper"}
    paddle : PaddleProfile
        The textbook paddle unless given: b = 1 N s/m, 20 um a count, 8 N.
    board : {"uno", "pico", "cortex-m4f"}
    **constants : float
        Of the wall K [N/m] and B [N s/m]; of the mass m [kg], K and b of its coupler; of the bumper m [kg], the stiffness
        k_b of its contact and K of its coupler [N/m].

    Returns
    -------
    Task

    Raises
    ------
    AnalysisError
        For another name, and for a constant that the task does not have or that is not a finite number > 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.design.task("wall", K=500).takes
    ('T', 'law', 'velocity', 'tau')
    """
    if not isinstance(name, str) or name not in TASKS:
        raise AnalysisError(f"task {name!r} does not exist; there are {', '.join(TASKS)}")
    if not isinstance(paddle, PaddleProfile):
        raise AnalysisError(f"paddle = {paddle!r}; a task needs a profile, such as hl.devices.profile('hapkit')")
    made = TASKS[name]
    known = [one for one in inspect.signature(made).parameters if one not in ("paddle", "board")]
    for constant, value in constants.items():
        if constant not in known:
            raise AnalysisError(f"the task {name} has no constant {constant}; it has {', '.join(known)}")
        if isinstance(value, bool) or not isinstance(value, Real) or not (math.isfinite(value) and value > 0):
            raise AnalysisError(f"{constant} = {value!r}; the task {name} needs a finite number > 0")
    return made(paddle=paddle, board=board, **{one: float(value) for one, value in constants.items()})


@functools.lru_cache(maxsize=64)
def _wall(*, paddle, board, K=500.0, B=2.0):
    """A wall at the middle of the travel, crossed by a mixture of frequencies."""
    ideal = wall(k=K, B=B)

    def rendered(design, on):
        return wall(design.law, k=K, B=B, velocity=estimate(design, on))

    return Task("wall", ideal, handle_motions()[4].scaled(0.3), rendered, OF_LAW, paddle, board)


@functools.lru_cache(maxsize=64)
def _mass(*, paddle, board, m=0.05, K=800.0, b=0.1):
    """A mass behind a virtual coupler, Fig. 23.4, as in lab 07."""
    z = coordinate("z", unit="m")
    mass, damping, stiffness = parameters("m b K", units="kg N*s/m N/m", values=(m, b, K))
    force = stiffness * (x(t) - z) + damping * (v(t) - z.diff(t))
    ideal = Scene(force=force, eom=[sp.Eq(mass * z.diff(t, 2), force)], watch=[z], name="mass on a coupler")
    return Task("mass", ideal, paddle=paddle, board=board)


@functools.lru_cache(maxsize=64)
def _bumper(*, paddle, board, m=0.03, k_b=1500.0, K=400.0):
    """A mass behind a coupler that strikes a bumper, a damped penalty contact, at the middle of the travel."""
    z = coordinate("z", unit="m", initial=x(n))
    values = (m, k_b, K, 0.1, 0.5)
    mass, stiffness, coupler, damping, loss = parameters("m k_b K b b_b", units="kg N/m N/m N*s/m N*s/m", values=values)
    force = coupler * (x(t) - z) + damping * (v(t) - z.diff(t))
    strikes = Contact(-z, penalty(k=stiffness, b=loss), name="bumper")
    motion = lagrange(mass * z.diff(t) ** 2 / 2, forces={z: force}, contacts=[strikes])
    ideal = Scene(force=force, eom=[motion], watch=[z], name="mass against a bumper")
    return Task("bumper", ideal, STRIKES, paddle=paddle, board=board)


TASKS = {"wall": _wall, "mass": _mass, "bumper": _bumper}


def estimate(design, paddle):
    """Return the velocity estimate that a design names; the resolution is that of the paddle's encoder."""
    count = 1 / (paddle.counts_per_metre or 1e6)
    if design.velocity == "filtered":
        return filtered_velocity(tau=design.tau)
    if design.velocity == "kalman":
        return kalman_velocity(acceleration=ACCELERATION, noise=count / math.sqrt(12))
    if design.velocity == "window":
        return window_velocity(deviation=count, longest=LONGEST)
    return backward_velocity()
