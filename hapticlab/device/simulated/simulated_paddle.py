"""A paddle in virtual time: handle, hand, encoder, delay, friction and motor limit around a scene's program."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number
from ...base.missed_events import warn_of_missed
from ...base.telemetry import PaddleProfile, Telemetry
from ...base.unusual import DEVICE, warn_of_unusual
from ...errors import PaddleError
from ..hand.hand import Hand
from ..hand.reacting_hand import Reacting, run_reacting
from ..paddle import Paddle
from ..profiles import profile as named_profile
from ..progress import progress_bar
from .closed_loop import link, load_linked
from .friction import ROUNDED_UP
from .lanes import device_values
from .not_finite import not_finite
from .plant import delay_parts, dynamics, plant_of
from .transition import smallest_mass

if TYPE_CHECKING:
    from ...base.annotations import Array, Number
    from ...compiler.ir.program import Program
    from ...scene.scene import Scene

__all__ = ["SimulatedPaddle", "link", "load_linked"]

#: ticks between two looks at the progress bar, by engine: some tenths of a second
CHUNK = {"interpreter": 250, "llvm": 100_000}
#: samples a run keeps, at most; a sweep keeps none
LONGEST_RUN = 10_000_000
#: in samples
LONGEST_DELAY = 1000
#: counts per metre
FINEST_ENCODER = 1e12
_POSITIVE = {"m": "kg", "T": "s"}
_NOT_NEGATIVE = {
    "b": ("N s/m", "A negative damper supplies energy to the user."),
    "delay": ("s", "A force cannot be felt before it is computed."),
    "coulomb": ("N", "Friction opposes motion."),
    "noise": ("m", "It is a standard deviation."),
}


@dataclass(frozen=True, kw_only=True)
class SimulatedPaddle(Paddle):
    """The sampled-data handle of Fig. 23.6: M x'' = push - F - b x' - coulomb sign(x') - k_h (x - intent) - ...

    The motion between samples is exact for any m, b and T. Without Coulomb friction it uses the matrix exponential, or
    closed forms where the exponential would lose digits (a light handle that is damped, or on a stiff spring). With
    Coulomb friction, stops, sticking and break-away are located inside the sample. Only the effects that are given are
    compiled in; ``print(paddle)`` lists them.

    Parameters
    ----------
    m : float or text
        Mass at the handle [kg], m > 0.
    b : float or text
        Viscous damping at the handle [N s/m], b >= 0.
    T : float or text
        Sampling period [s], T > 0.
    delay : float or text
        Computational delay [s], delay >= 0, whole or not: the force computed from sample n acts after n T + delay.
    counts_per_metre : float or text, optional
        Encoder counts per metre [1/m]. The scene then sees counts/counts_per_metre, in its own precision, and v by
        backward difference. Without encoder and noise it sees x, and v exactly.
    rounding : {"floor", "nearest"}
        How a position becomes a count: floor(x c), or floor(x c + 1/2).
    coulomb : float or text
        Coulomb friction, static and kinetic alike [N], coulomb >= 0.
    force_max : float or text, optional
        The motor saturates at this magnitude [N].
    hand : Hand, optional
    seed : int
        Of the sensor's and the hand's noise; the same seed gives the same run.
    noise : float or text
        Standard deviation of white Gaussian noise on the sensed position [m], added before the encoder.
    profile : PaddleProfile, optional
        Where the constants come from; see :meth:`from_profile`.

    Raises
    ------
    PaddleError
        For a value out of its range, and for a mass that is too small for the arithmetic; the message names the least
        mass.

    Examples
    --------
    >>> from hapticlab.device.hand.hand import Hand
    >>> from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
    >>> print(SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=1.5e-3, hand=Hand(push=2)))
    simulated paddle: m = 0.05 kg, b = 0.1 N s/m, T = 0.001 s
      delay      0.0015 s = 1 whole sample + 0.5
      hand       push = 2 N
      between samples: matrix exponential; v measured
      not modelled: encoder, noise, Coulomb friction, force limit
    """

    m: float
    b: float
    T: float
    delay: float = 0.0
    counts_per_metre: float | None = None
    rounding: str = "floor"
    coulomb: float = 0.0
    force_max: float | None = None
    hand: Hand | None = None
    seed: int = 0
    noise: float = 0.0
    profile: PaddleProfile | None = None

    if TYPE_CHECKING:  # it takes texts and keeps floats

        def __init__(
            self,
            *,
            m: Number,
            b: Number,
            T: Number,
            delay: Number = 0.0,
            counts_per_metre: Number | None = None,
            rounding: str = "floor",
            coulomb: Number = 0.0,
            force_max: Number | None = None,
            hand: Hand | None = None,
            seed: int = 0,
            noise: Number = 0.0,
            profile: PaddleProfile | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        for name, unit in _POSITIVE.items():
            self._take(name, unit, above=0)
        for name, (unit, reason) in _NOT_NEGATIVE.items():
            self._take(name, unit, reason, least=0)
        for name, unit in (("counts_per_metre", "1/m"), ("force_max", "N")):
            if getattr(self, name) is not None:
                self._take(name, unit, "None leaves it out.", above=0)
        if self.counts_per_metre is not None and self.counts_per_metre > FINEST_ENCODER:
            raise PaddleError(
                f"counts_per_metre = {self.counts_per_metre:g} 1/m; an encoder needs at most {FINEST_ENCODER:g}, one count "
                "per picometre. None leaves it out."
            )
        if self.delay > LONGEST_DELAY * self.T:
            raise PaddleError(
                f"delay = {self.delay:g} s is {self.delay / self.T:.0f} samples; a simulated paddle stores at most "
                f"{LONGEST_DELAY} delayed forces: delay <= {LONGEST_DELAY * self.T:g} s at T = {self.T:g} s."
            )
        if self.rounding not in ("floor", "nearest"):
            raise PaddleError(f"rounding = {self.rounding!r}; an encoder needs 'floor' or 'nearest'.")
        if self.hand is not None and not isinstance(self.hand, Hand):
            raise PaddleError(f"hand = {self.hand!r}; needs a Hand, as in hand=hl.Hand(push=2.0).")
        self._check_mass()
        if not isinstance(self.seed, (int, np.integer)) or self.seed < 0:
            raise PaddleError(f"seed = {self.seed!r}; needs a whole number >= 0.")

    def _take(self, name, unit, reason="", **bounds):
        value = number(name, getattr(self, name), unit, "a paddle", why=reason, error=PaddleError, **bounds)
        object.__setattr__(self, name, value)
        warn_of_unusual(name, value, unit, DEVICE.get(name))

    def _check_mass(self):
        M, b, k = dynamics(self)
        least = float(smallest_mass(b, k, self.T))
        if least > M:
            raise PaddleError(
                f"m = {self.m:g} kg; with b = {b:g} N s/m and k = {k:g} N/m of handle and hand the motion over T = "
                f"{self.T:g} s is lost in rounding. A simulated paddle needs m >= {least * ROUNDED_UP:.3g} kg here, a "
                "smaller T or a softer "
                "hand."
            )

    @classmethod
    def from_profile(cls, profile: PaddleProfile | str, **changes: Any) -> SimulatedPaddle:
        """Return a paddle with the constants of a profile, given itself or by name: ``from_profile("eth", T=5e-4)``."""
        profile = named_profile(profile) if isinstance(profile, str) else profile
        names = {f.name for f in fields(cls)} & {f.name for f in fields(PaddleProfile)}
        unknown = sorted(set(changes) - {f.name for f in fields(cls)})
        if unknown:
            known = ", ".join(f.name for f in fields(cls))
            raise PaddleError(f"{unknown[0]} is not an argument of SimulatedPaddle. The arguments are {known}.")
        return cls(**{**{name: getattr(profile, name) for name in names}, "profile": profile, **changes})

    @property
    def velocity(self) -> str:
        return "measured" if self.counts_per_metre is None and self.noise == 0 else "backward_difference"

    @property
    def plant(self) -> Any:
        """Which terms the plant has. Paddles that agree in :attr:`structure` share one linked program."""
        return plant_of(self)

    @property
    def structure(self) -> tuple[Any, ...]:
        """What decides the linked program, as against its parameter values; compare with ==."""
        encoder = self.rounding if self.counts_per_metre is not None else None
        return self.plant, encoder, self.noise > 0, self.force_max is not None

    def plant_values(self, x: Number = 0.0, v: Number = 0.0) -> tuple[float, ...]:
        """Return the values of the linked program's parameters after the scene's, for a start at x [m] with v [m/s]."""
        start = number("x", x, "m", "a start", error=PaddleError), number("v", v, "m/s", "a start", error=PaddleError)
        return tuple(float(a) for a in (*device_values(self), *start))

    def inputs(self, ticks: int) -> Array:
        """Return the linked program's inputs, shape (ticks, inputs).

        Intent [m], its rate [m/s], the sensor's noise [m], the hand's noise [N], each where the paddle has it.
        """
        columns = []
        if self.plant.ramp and self.hand is not None:
            intent = self.hand.samples(ticks, self.T)
            columns += [intent[:-1]] if self.plant.spring else []
            columns.append(np.diff(intent) / self.T)
        # a stream each, so that one noise is the same with and without the other
        for stream, deviation in enumerate((self.noise, self.hand.push_noise if self.hand else 0.0)):
            if deviation:
                columns.append(deviation * np.random.default_rng([self.seed, stream]).standard_normal(ticks))
        return np.column_stack(columns) if columns else np.zeros((ticks, 0))

    def run(
        self,
        scene: Scene | Program,
        duration: Number,
        *,
        x: Number = 0.0,
        v: Number = 0.0,
        engine: str = "auto",
        progress: bool = True,
        **options: Any,
    ) -> Telemetry:
        """Run a scene in virtual time.

        Parameters
        ----------
        scene : Scene or Program
        duration : float or text
            [s], as 2.0 or "2 s"; rounded to whole samples.
        x, v : float or text
            Position [m] and velocity [m/s] at the first sample.
        engine : {"auto", "llvm", "interpreter"}
        progress : bool
            Show a bar when the run lasts longer than two seconds.
        **options
            Of hapticlab.compile: method, substeps, hold, dtype.

        Returns
        -------
        Telemetry

        Raises
        ------
        PaddleError, ParameterError
        """
        ticks = self.ticks(duration)
        if ticks > LONGEST_RUN:
            raise PaddleError(
                f"duration = {ticks * self.T:g} s is {ticks:.3g} samples; a run keeps at most {LONGEST_RUN} "
                f"({LONGEST_RUN * self.T:g} s here). Run for a shorter time, or measure with hl.sweep, which stores no samples."
            )
        program = self.program(scene, **options)
        linked = link(program, self)
        loaded = load_linked(linked, engine)
        parameters = (*program.values, *self.plant_values(x, v))
        if self.hand is not None and isinstance(self.hand.intent, Reacting):
            outputs = run_reacting(loaded, self, parameters, ticks, [c.name for c in linked.outputs])
        else:
            outputs = _run_in_chunks(loaded, self.inputs(ticks), parameters, CHUNK[loaded.name], progress)
        return warn_of_missed(self._telemetry(program, linked, outputs))

    def _telemetry(self, program, linked, outputs):
        columns = {c.name: outputs[:, j] for j, c in enumerate(linked.outputs)}
        units = program.units | linked.units
        x, v, F, code = columns.pop("x"), columns.pop("v"), columns.pop("F"), columns.pop("fault")
        fault = None
        if code.any():
            first = int(np.argmax(code > 0))
            fault = not_finite(program, code[first], first, self.T)
        limited = np.abs(F) >= self.force_max if self.force_max is not None else None
        parameters = {c.name: a for c, a in zip(program.parameters, program.values, strict=True)}
        return Telemetry(
            t=np.arange(len(x)) * self.T, x=x, v=v, F=F, T=self.T, delay=self.delay, channels=columns,
            units={name: units[name] for name in (*columns, *parameters) if name in units}, paddle=str(self),
            scene=program.name, parameters=parameters, fault=fault, saturated=limited,
        )  # fmt: skip

    def _line(self):
        return f"SimulatedPaddle({self._sentence().removeprefix('simulated paddle: ')})"

    def __str__(self) -> str:
        whole, fraction = delay_parts(self)
        samples = f"{whole} whole sample{'s' * (whole != 1)}" + (f" + {fraction:g}" if fraction else "")
        counts = self.counts_per_metre
        plant = self.plant
        between = f"friction located, {plant.pieces} piece(s), {plant.terms} Taylor terms"
        rows = {
            "delay": self.delay and f"{self.delay:g} s = {samples}",
            "encoder": counts and f"{1e6 / counts:g} um per count, {self.rounding}",
            "noise": self.noise and f"{self.noise:g} m standard deviation, seed {self.seed}",
            "Coulomb friction": self.coulomb and f"{self.coulomb:g} N",
            "force limit": self.force_max and f"{self.force_max:g} N",
            "hand": self.hand,
        }
        lines = [f"simulated paddle: m = {self.m:g} kg, b = {self.b:g} N s/m, T = {self.T:g} s"]
        lines += [f"  {name:<10} {text}" for name, text in rows.items() if text]
        source = self.velocity.replace("_", " ")
        lines.append(f"  between samples: {between if plant.coulomb else 'matrix exponential'}; v {source}")
        absent = [name for name, text in rows.items() if not text]
        lines += [f"  not modelled: {', '.join(absent)}"] if absent else []
        if self.profile is not None:
            lines.append(f"  from {self.profile}")
        return "\n".join(lines)


def _run_in_chunks(loaded, inputs, parameters, chunk, progress):
    """Run, with a bar that appears only after two seconds; return outputs of shape (ticks, outputs)."""
    ticks, states, done = len(inputs), None, []
    with progress_bar(ticks, progress) as shown:
        for start in range(0, ticks, chunk):
            rows = inputs[start : start + chunk]
            outputs, states = loaded.run(len(rows), rows, parameters, states)
            done.append(outputs[:, :, 0])
            shown.update(len(rows))
    return np.concatenate(done)
