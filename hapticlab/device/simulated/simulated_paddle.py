"""A paddle in virtual time: handle, hand, encoder, delay, friction and motor limit around a scene's program."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number
from ...base.missed_events import warn_of_missed
from ...base.profile.constants import check_duties
from ...base.profile.paddle_profile import PaddleProfile
from ...base.telemetry import Telemetry
from ...base.unusual import DEVICE, warn_of_unusual
from ...compiler.engines.table import ENGINES
from ...errors import PaddleError
from ..hand.hand import Hand
from ..hand.reacting_hand import Reacting, run_reacting
from ..paddle import Paddle
from ..profiles import profile as named_profile
from ..progress import progress_bar
from .closed_loop import link, load_linked
from .friction import ROUNDED_UP
from .lanes import device_values
from .motor import is_distorted, knots
from .not_finite import not_finite
from .plant import delay_parts, dynamics, plant_of
from .transition import smallest_mass

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.annotations import Array, File, Number, PlantEngine
    from ...base.profile.prediction import Prediction
    from ...compiler.ir.program import Program
    from ...scene.scene import Scene

__all__ = ["SimulatedPaddle", "link", "load_linked"]

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
    "sensor_delay": ("s", "A sensor cannot show a position before the handle is there."),
}
#: of the profile -> of the paddle, where their names differ
RENAMED = {"sensor_noise": "noise"}


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
    sensor_delay : float or text
        Lag of the sensor [s], sensor_delay >= 0, whole samples or not: what the scene sees at a sample is where the handle
        was so long before. Before the start the handle is taken to have moved evenly.
    duty_dead : float
        Part of full duty below which the motor gives no force, 0 ... 0.5.
    duty_25, duty_50, duty_75 : float, optional
        Parts of full duty, dead band included, at which the motor gives a quarter, half and three quarters of force_full,
        with straight lines between; all three or none.
    force_full : float or text, optional
        Force at full duty [N]; force_max where it is not given.
    compensated : bool
        Whether the board knows dead band and curve, so that the motor gives the force that is computed. Otherwise the
        board takes the force as proportional to the duty: F is what it computed, ``F_applied`` what acted.
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
      not modelled: encoder, noise, sensor lag, Coulomb friction, force limit, motor
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
    sensor_delay: float = 0.0
    duty_dead: float = 0.0
    duty_25: float | None = None
    duty_50: float | None = None
    duty_75: float | None = None
    force_full: float | None = None
    compensated: bool = True

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
            sensor_delay: Number = 0.0,
            duty_dead: float = 0.0,
            duty_25: float | None = None,
            duty_50: float | None = None,
            duty_75: float | None = None,
            force_full: Number | None = None,
            compensated: bool = True,
        ) -> None: ...

    def __post_init__(self) -> None:
        for name, unit in _POSITIVE.items():
            self._take(name, unit, above=0)
        for name, (unit, reason) in _NOT_NEGATIVE.items():
            self._take(name, unit, reason, least=0)
        for name, unit in (("counts_per_metre", "1/m"), ("force_max", "N"), ("force_full", "N")):
            if getattr(self, name) is not None:
                self._take(name, unit, "None leaves it out.", above=0)
        if self.counts_per_metre is not None and self.counts_per_metre > FINEST_ENCODER:
            raise PaddleError(
                f"counts_per_metre = {self.counts_per_metre:g} 1/m; an encoder needs at most {FINEST_ENCODER:g}, one count "
                "per picometre. None leaves it out."
            )
        for name, kept in (("delay", "forces"), ("sensor_delay", "readings")):
            late = getattr(self, name)
            if late > LONGEST_DELAY * self.T:
                raise PaddleError(
                    f"{name} = {late:g} s is {late / self.T:.0f} samples; a simulated paddle stores at most "
                    f"{LONGEST_DELAY} delayed {kept}: {name} <= {LONGEST_DELAY * self.T:g} s at T = {self.T:g} s."
                )
        check_duties(self, PaddleError)
        if is_distorted(self) and self.force_full is None and self.force_max is None:
            raise PaddleError(
                "compensated = False, and the force at full duty is not known. Give force_full, as force_full=8.0 [N]."
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
    def from_profile(cls, profile: PaddleProfile | File, **changes: Any) -> SimulatedPaddle:
        """Return a paddle with the constants of a profile, or of its name or file: ``from_profile("eth", T=5e-4)``.

        Parameters
        ----------
        profile : PaddleProfile, str or path
            A profile, the name of one, such as "hapkit", or a file that :meth:`PaddleProfile.save` wrote.
        **changes
            Arguments of this class that are to differ from the profile, such as T [s] or hand.
        """
        profile = named_profile(profile)
        own = {f.name for f in fields(cls)}
        known = {RENAMED.get(f.name, f.name): getattr(profile, f.name) for f in fields(PaddleProfile)}
        unknown = sorted(set(changes) - own)
        if unknown:
            arguments = ", ".join(f.name for f in fields(cls))
            raise PaddleError(f"{unknown[0]} is not an argument of SimulatedPaddle. The arguments are {arguments}.")
        return cls(**{**{name: a for name, a in known.items() if name in own}, "profile": profile, **changes})

    def predict(self, question: Callable[..., Any], *args: Any, **options: Any) -> Prediction:
        """Return the interval of a prediction for this paddle in its hand, over the intervals of its profile.

        A constant that differs from the profile's, such as ``from_profile(twin, b=0.2)``, is taken as exact. All else is
        as for :meth:`PaddleProfile.predict`.

        Parameters
        ----------
        question : callable
            Takes a paddle first, and returns a number, a Limit or an Estimate.
        *args, **options
            Passed on to it.

        Returns
        -------
        Prediction

        Examples
        --------
        >>> import hapticlab as hl
        >>> held = hl.SimulatedPaddle.from_profile("hapkit_rough", hand=hl.Hand("pinch"))
        >>> print(held.predict(hl.stability_limit))
        1205.06 N/m, between 898.87 and 1600.54
          lowest with   delay high, sensor_delay high
          highest with  delay low, sensor_delay low
          it does not depend on coulomb
          the other constants of the profile are taken as exact
        """
        if self.profile is None:
            raise PaddleError(
                "the paddle has no profile, so none of its constants has an interval. Make it of one: "
                "hl.SimulatedPaddle.from_profile(twin, hand=...)"
            )
        usual = self.from_profile(self.profile)
        own = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "profile"}
        changes = {name: value for name, value in own.items() if value != getattr(usual, name)}
        known = {one.name: changes.get(RENAMED.get(one.name, one.name)) for one in self.profile.estimates}
        profile = self.profile.at(**{name: value for name, value in known.items() if value is not None})
        return profile.predict(lambda one: question(self.from_profile(one, **changes), *args, **options))

    @property
    def velocity(self) -> str:
        exact = self.counts_per_metre is None and self.noise == 0 and self.sensor_delay == 0
        return "measured" if exact else "backward_difference"

    @property
    def plant(self) -> Any:
        """Which terms the plant has. Paddles that agree in :attr:`structure` share one linked program."""
        return plant_of(self)

    @property
    def structure(self) -> tuple[Any, ...]:
        """What decides the linked program, as against its parameter values; compare with ==."""
        encoder = self.rounding if self.counts_per_metre is not None else None
        exact = self.velocity == "measured"
        return self.plant, encoder, self.noise > 0, self.force_max is not None, is_distorted(self), exact

    def plant_values(self, x: Number = 0.0, v: Number = 0.0) -> tuple[float, ...]:
        """Return the values of the linked program's parameters after the scene's, for a start at x [m] with v [m/s].

        Parameters
        ----------
        x : float or text
            Position of the handle at the start [m].
        v : float or text
            Its velocity there [m/s].
        """
        start = number("x", x, "m", "a start", error=PaddleError), number("v", v, "m/s", "a start", error=PaddleError)
        return tuple(float(a) for a in (*device_values(self), *start))

    def inputs(self, ticks: int) -> Array:
        """Return the linked program's inputs, shape (ticks, inputs).

        Intent [m], its rate [m/s], the sensor's noise [m], the hand's noise [N], each where the paddle has it.

        Parameters
        ----------
        ticks : int
            Samples of the run, >= 0.
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
        engine: PlantEngine = "auto",
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
        engine : {"auto", "llvm", "wasm", "interpreter"}
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
            outputs = _run_in_chunks(loaded, self.inputs(ticks), parameters, ENGINES[loaded.name].chunk, progress)
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
            scene=program.name, parameters=parameters, fault=fault, saturated=limited, sensor_delay=self.sensor_delay,
        )  # fmt: skip

    def _line(self):
        return f"SimulatedPaddle({self._sentence().removeprefix('simulated paddle: ')})"

    def __str__(self) -> str:
        whole, fraction = delay_parts(self)
        samples = f"{whole} whole sample{'s' * (whole != 1)}" + (f" + {fraction:g}" if fraction else "")
        counts = self.counts_per_metre
        plant, duties = self.plant, ", ".join(f"{duty:g}" for duty in knots(self)[:-1])
        between = f"friction located, {plant.pieces} piece(s), {plant.terms} Taylor terms"
        rows = {
            "delay": self.delay and f"{self.delay:g} s = {samples}",
            "encoder": counts and f"{1e6 / counts:g} um per count, {self.rounding}",
            "noise": self.noise and f"{self.noise:g} m standard deviation, seed {self.seed}",
            "sensor lag": self.sensor_delay and f"{self.sensor_delay:g} s",
            "Coulomb friction": self.coulomb and f"{self.coulomb:g} N",
            "force limit": self.force_max and f"{self.force_max:g} N",
            "motor": is_distorted(self) and f"0, 25, 50, 75 % of its force at duties {duties}",
            "hand": self.hand,
        }
        lines = [f"simulated paddle: m = {self.m:g} kg, b = {self.b:g} N s/m, T = {self.T:g} s"]
        lines += [f"  {name:<10} {text}" for name, text in rows.items() if text]
        source = self.velocity.replace("_", " ")
        lines.append(f"  between samples: {between if plant.coulomb else 'matrix exponential'}; v {source}")
        absent = [name for name, text in rows.items() if not text]
        lines += [f"  not modelled: {', '.join(absent)}"] if absent else []
        if self.profile is not None:
            lines.append("  from " + str(self.profile).split("\n")[0])
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
