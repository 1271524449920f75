"""What the laws of Section 23.4.1 share when they are written as scenes: named lines, and the handle when a force changes.

A force computed at sample n acts from n T + delay on. The motion from one such instant to the next is that of a paddle
without delay, so a law looks at the handle there: predicted exactly, from the sample and the forces still under way.
"""

import math

import numpy as np
import sympy as sp

from ..errors import SceneError
from ..scene.laws.estimators import VelocityEstimate
from ..scene.notation.amount import Amount
from ..scene.notation.symbols import T, n, parameters, signal, v, when, x
from ..scene.scene import Scene


class Lines:
    """The lines of a law, in the order they are computed; each is a signal that later lines name."""

    def __init__(self, model):
        self.model, self.eom = model, []
        self.k = parameters("k", units="N/m", values=model.K, ranges=(model.K, model.K))
        self.x_o = parameters("x_o", units="m", values=0.0)
        self.push = parameters("push", units="N", values=model.push, ranges=(-math.inf, math.inf))
        self.held = signal("held", unit="m")
        #: the hand's constant force where p = 0, in metres of the wall's spring
        self.outer = self.let("outer", self._outer()) if model.push or model.k else sp.S.Zero

    def _outer(self):
        return self.push / self.k - number(self.model.k / self.model.K) * self.x_o

    def let(self, name, value, unit="m"):
        """Name a line, or define a signal, and return it at sample n."""
        named = signal(name, unit=unit) if isinstance(name, str) else name
        self.eom.append(sp.Eq(named(n), value, evaluate=False))  # SymPy would look for seconds whether they are equal
        return named(n)

    def moved(self, p, w, steps):
        """Return (p, w) after steps, each (flow of its length, force in metres), multiplied out in numbers."""
        Phi, pushed, forces = np.eye(2), np.zeros(2), []
        for (step, gamma), force in steps:
            Phi, pushed = step @ Phi, step @ pushed + gamma
            forces = [(step @ effect, before) for effect, before in forces] + [(gamma, force)]
        return tuple(
            sp.Add(
                number(Phi[i, 0]) * p, number(Phi[i, 1]) * w, number(pushed[i]) * self.outer,
                *(-number(effect[i]) * force for effect, force in forces),
            )
            for i in (0, 1)
        )  # fmt: skip

    def at_switch(self, velocity=None):
        """Name and return p and w = T v where the force of this sample begins to act."""
        p = self.let("p", x(n) - self.x_o)
        w = self.let("w", T * self._velocity(velocity))
        whole, part = self.model.lag
        steps = [(self.model.flow(part), self.held(n - whole - 1))] if part else []
        steps += [(self.model.flow(1.0), self.held(n - age)) for age in range(whole, 0, -1)]
        if not steps:
            return p, w
        p, w = self.moved(p, w, steps)
        return self.let("p_switch", p), self.let("w_switch", w)

    def _velocity(self, given):
        if isinstance(given, VelocityEstimate):
            self.eom += given.eom
            return given.velocity
        if given not in (None, "model"):
            raise SceneError(
                f"velocity = {given!r}; needs None (v(n) of the paddle), 'model' (from two positions and the forces "
                "between them) or an estimate, as in velocity=hl.velocity.filtered(tau='4 ms')"
            )
        return self._from_positions() if given else v(n)

    def _from_positions(self):
        """Return the velocity from x(n), x(n-1) and the forces that acted between: exact where the model is."""
        whole, part = self.model.lag
        early = [(self.model.flow(part), self.held(n - whole - 2))] if part else []
        steps = [*early, (self.model.flow(1 - part), self.held(n - whole - 1))]
        before = x(n - 1) - self.x_o
        rest = self.moved(before, sp.S.Zero, steps)
        Phi = self.model.flow(1.0)[0]
        started = (x(n) - self.x_o - rest[0]) / number(Phi[0, 1])
        return (rest[1] + number(Phi[1, 1]) * started) / T

    def scene(self, force, name, watch=None, force_max=None, clamp=False):
        """Return the scene of a force in metres of the spring, never beyond the motor's: the model must know what acts."""
        if clamp:
            force = sp.Max(force, 0)
        if force_max is not None:
            most = parameters("force_max", units="N", values=force_max) / self.k
            asked = self.let("asked", force)
            force = sp.Max(sp.Min(asked, most), -most)
            watch = {**(watch or {}), "limited": when(sp.Or(asked > most, asked < -most), 1, 0)}
        # 1 or 0, known when a scene is compiled: the law of another period is a division by zero, and not a wrong wall
        own = Amount(self.model.T, "s")
        of_this_period = self.let("of_this_period", when(sp.Abs(T - own) < 1e-3 * own, 1, 0), "1")
        self.let(self.held, force / of_this_period)
        # in the name, for a fault prints it: another period is its likeliest cause
        name = f"{name} (made for T = {1e3 * self.model.T:g} ms)"
        return Scene(force=self.k * self.held(n), eom=self.eom, watch=watch or {}, name=name)


def number(value):
    """Return a coefficient of the model as SymPy writes it; the nearest whole number where it is one."""
    value = float(value)
    return sp.Integer(int(value)) if value == math.floor(value) and abs(value) < 10 else sp.Float(value)
