"""What moves the handle while its impedance is measured: the simulated hand, or the motor itself."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
import sympy as sp

from ..device.hand.hand import Hand
from ..scene.notation.cases import when
from ..scene.notation.symbols import n, parameters, signal
from .signals import chirp, multisine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..base.annotations import Array
    from ..scene.scene import Scene

How = Literal["multisine", "swept_sine"]


@dataclass(frozen=True, eq=False)
class Signal:
    """One periodic signal of peak ``amplitude``.

    Attributes
    ----------
    how : {"multisine", "swept_sine"}
    lines : array of int
        Cycles in a period.
    samples : int
        Of a period.
    T : float
        [s]
    amplitude : float
        Of a hand's intent [m], or of the motor's force [N].
    seed : int
        Of a multisine's phases.
    """

    how: How
    lines: NDArray[np.int_]
    samples: int
    T: float
    amplitude: float
    seed: int

    @cached_property
    def period(self) -> Array:
        """One period, peak ``amplitude``."""
        if self.how == "swept_sine":
            return self.amplitude * chirp(self.samples, self.lines)
        return self.amplitude * multisine(self.samples, self.lines, phases="low_crest", seed=self.seed)

    def hand(self, hand: Hand, place: float, pull: float) -> Hand:
        """The hand with an intent that moves as the signal does, and holds the handle at a place [m] against a pull.

        A hand without a spring holds it by a push.
        """
        period, held_by = self.period, pull / hand.k if hand.k else 0.0

        def intent(times):
            return place + held_by + period[np.round(np.asarray(times) / self.T).astype(int) % self.samples]

        push = hand.push if hand.k else hand.push + pull
        return Hand(m=hand.m, b=hand.b, k=hand.k, push=push, push_noise=hand.push_noise, intent=intent)

    def beside(self, scene: Scene, pull: float = 0.0) -> Scene:
        """The scene with the signal as a second force of the motor; its own force is watched as ``own`` [N].

        ``pull`` [N] is a constant force into the wall, which holds the handle where the scene gives as much.
        """
        shaken, rule = self._swept() if self.how == "swept_sine" else self._sines()
        force = scene.force + shaken
        if pull:
            force = force - parameters("pull", units="N", values=pull, ranges=(-math.inf, math.inf))
        watch = {**scene.watch, "own": scene.force}
        return replace(scene, force=force, eom=(*scene.eom, *rule), watch=watch, name=f"shaken {scene.name}")

    def _count(self):
        """The tick within the period, and the rule that counts it."""
        count = signal("shake_tick", unit="1", initial=-1)
        again = count(n - 1) >= self.samples - sp.Rational(3, 2)
        return count(n), sp.Eq(count(n), when(again, 0, count(n - 1) + 1))

    def _sines(self):
        """The sum of cosines, each a pointer that turns by its angle a tick and begins anew with every period.

        Six operations a line, where a sine takes ten times as many; single precision drifts by 1e-4 within a period, and
        by nothing from one to the next.
        """
        count, rule = self._count()
        pointers = np.fft.rfft(self.period)[self.lines] * 2 / self.samples / self.amplitude
        size = parameters("shake_size", units="N", values=self.amplitude)
        total, rules = [], [rule]
        for line, start in zip(self.lines.tolist(), pointers.tolist(), strict=True):
            re, im = (signal(f"shake_{part}{line}", unit="1") for part in ("re", "im"))
            turn = np.exp(2j * np.pi * line / self.samples)
            turned = re(n - 1) * turn.real - im(n - 1) * turn.imag, re(n - 1) * turn.imag + im(n - 1) * turn.real
            for pointer, begin, on in zip((re, im), (start.real, start.imag), turned, strict=True):
                rules.append(sp.Eq(pointer(n), when(count < sp.Rational(1, 2), begin, on)))
            total.append(re(n))
        return size * sp.Add(*total), tuple(rules)

    def _swept(self):
        count, rule = self._count()
        size = parameters("shake_size", units="N", values=self.amplitude)
        part, first, last = count / self.samples, int(self.lines.min()), int(self.lines.max())
        turns = first * part + sp.Rational(last - first, 2) * part**2
        return size * sp.sin(2 * sp.pi * (turns - sp.floor(turns))), (rule,)
