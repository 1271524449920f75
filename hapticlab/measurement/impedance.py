"""Measure the impedance that a paddle renders: the hand or the motor shakes the handle in whole periods."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..analysis.impedance.impedance import impedance as impedance_of
from ..base.arguments import number
from ..compiler.tick.compile_scene import compile
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError, PaddleError
from .impedance_plan import AVERAGING, EXCITATION, SAFETY, Averaging, Excitation, Safety
from .impedance_signal import Signal
from .measured import MeasuredImpedance
from .shaking import bearable, most_force, shake_board
from .signals import lines_of
from .small_signal import force_at_rest, law_at
from .spectrum import held_transfer, lines_in, ramp_transfer, response

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from ..device.board.serial_paddle import SerialPaddle
    from ..scene.scene import Scene

#: options of a run that are the compiler's
COMPILED = ("method", "substeps", "hold", "force_at", "dtype")
#: default amplitudes: of a hand's intent [m], and of the motor's force [N]
AMPLITUDE = {"hand": 1e-3, "motor": 0.1}
#: frequencies by default, and the highest as a part of the sampling rate
FREQUENCIES, LOWEST, HIGHEST = 24, 2.0, 0.2
#: where the handle is measured by default, beyond a wall's boundary [m]
DEPTH = 0.005
#: images of the handle's motion between samples that are taken off
IMAGES = 200


def measured_impedance(
    paddle: SimulatedPaddle | SerialPaddle,
    scene: Scene,
    *,
    excitation: Excitation = EXCITATION,
    averaging: Averaging = AVERAGING,
    safety: Safety = SAFETY,
    place: float | None = None,
    ideal: Scene | Callable[[NDArray[np.complex128]], ArrayLike] | None = None,
    **options: Any,
) -> MeasuredImpedance:
    """Measure the impedance that a scene renders at the handle, by a periodic excitation in whole periods.

    ``drive="hand"``: a simulated hand moves its intent and the handle follows through its spring and damper; what it feels
    is known, as if a force sensor were between. ``drive="motor"``: the motor adds the excitation to the scene's force, in
    simulation and on a board alike. A board has no force sensor: from it the scene's force over the sensed motion is
    observable, and the mechanics that the motor moves, device and hand together; that the motor gives the force that was
    computed, and what the hand feels, is not.

    On a board the motor first leads the handle to the place, softly. Then its force rises over half a second, keeps below
    a limit, and is off for good where the handle goes too far or too fast; the record is refused then.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    scene : Scene
        Every parameter bound. Linear about the place, or nearly so.
    excitation : Excitation
        What shakes the handle: ``hl.measure.Excitation(how=, drive=, frequency=, amplitude=, seed=)``.
    averaging : Averaging
        How much is recorded: ``hl.measure.Averaging(period=, blocks=, realizations=, settle=)``.
    safety : Safety
        What the handle of a board may do: ``hl.measure.Safety(force_max=, reach=, speed_max=)``.
    place : float, optional
        Mean position of the handle [m] that a driving hand holds: inside a wall, deeper than it moves. By default where
        the scene's x_o is, and 5 mm beyond it, or less: half of what the motor stands for long holds it there.
    ideal : Scene or callable, optional
        Of what the scene stands for: Z(s), s = 2 pi j f. By default its own equations in continuous time, or k/s + B of
        a wall.
    **options
        Of the paddle's run: dtype, method, and on a board every.

    Returns
    -------
    MeasuredImpedance

    Raises
    ------
    AnalysisError, PaddleError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, b=1.0, k=200.0))
    >>> two = hl.measure.Excitation(frequency=[5, 50])
    >>> found = hl.measure.impedance(paddle, hl.wall()(k=150), excitation=two, dtype="float64")
    >>> bool((abs(found.rendered / found.law - 1) < 1e-3).all()), round(float(found.damping[0]), 4)     # -K T/2
    (True, -0.075)
    """
    place = None if place is None else number("place", place, "m", "hl.measure.impedance")
    simulated, how, frequency = isinstance(paddle, SimulatedPaddle), excitation.how, excitation.frequency
    period, blocks, settle = averaging.period, averaging.blocks, averaging.settle
    drive = _drive(paddle, excitation.drive, simulated)
    amplitude = AMPLITUDE[drive] if excitation.amplitude is None else excitation.amplitude
    top = HIGHEST / paddle.T
    wanted = np.geomspace(max(LOWEST, 2 / period), top, FREQUENCIES) if frequency is None else frequency
    samples, lines = lines_of(wanted, paddle.T, period)
    lines = np.arange(lines.min(), lines.max() + 1) if how == "swept_sine" else lines
    run, exact, place = _runs(paddle, scene, drive, place, settle, None if simulated else safety, options)
    skip, kept = round(settle / paddle.T), []
    for k in range(averaging.realizations if how == "multisine" else 1):
        signal = Signal(how, lines, samples, paddle.T, amplitude, excitation.seed + k)
        log = run(signal, (skip + blocks * samples) * paddle.T)
        kept.append((_blocks(log, samples, blocks, skip), signal, log.delay))
    if how == "swept_sine" and frequency is not None:
        lines = lines_of(frequency, paddle.T, period)[1]
    return _evaluated(kept, lines, drive, paddle, exact, place, scene, ideal, simulated)


def _drive(paddle, drive, simulated):
    hand = paddle.hand if simulated else None
    able = hand is not None and (hand.k > 0 or hand.b > 0)
    drive = ("hand" if able else "motor") if drive is None else drive
    if drive == "hand" and not able:
        raise PaddleError("drive='hand' needs a simulated hand with k or b to act through, Hand(k=200, b=1); or drive='motor'")
    return drive


def _runs(paddle, scene, drive, place, settle, safety, options):
    """Return run(excitation, duration) -> Telemetry, the scene's own program in float64 for its law, and the place [m].

    ``safety`` of a board's handle; None for a simulated paddle, whose handle nobody holds.
    """
    compiled = {name: a for name, a in options.items() if name in COMPILED}
    others = {name: a for name, a in options.items() if name not in COMPILED}
    exact = compile(scene, T=paddle.T, velocity=paddle.velocity, **{**compiled, "dtype": "float64"})
    origin = scene.values.get("x_o", 0.0)
    if place is None:
        depth = DEPTH if "x_o" in scene.values else 0.0
        place = bearable(exact, paddle, origin, depth) if drive == "motor" else origin + depth
    place, hand = float(place), None if safety else paddle.hand
    pull = force_at_rest(exact, place) - (hand.push if hand else 0.0)  # what holds the handle at the place
    if drive == "motor" and safety:

        def run(excitation, duration):
            size = excitation.amplitude
            most = {**vars(safety), "force_max": most_force(paddle, pull, size, safety.force_max)}
            at = {"place": place, "origin": origin, "amplitude": size, "settle": settle}
            return shake_board(paddle, excitation.beside(scene, pull), duration, **at, **most, options=options)

    elif drive == "motor":
        pull += hand.k * (place - (hand.intent or 0.0)) if hand else 0.0

        def run(excitation, duration):
            return paddle.run(excitation.beside(scene, pull), duration=duration, progress=False, x=place, **options)

    else:
        program = paddle.program(scene, **compiled)

        def run(excitation, duration):
            driven = replace(paddle, hand=excitation.hand(hand, place, pull))
            return driven.run(program, duration=duration, x=place, progress=False, **others)

    return run, exact, place


def _blocks(log, samples, blocks, skip):
    """x, F and the scene's own part of F as blocks of one period, shape (B, N)."""
    if log.fault or log.gap.any() or log.every > 1 or len(log) < skip + blocks * samples:
        raise PaddleError(
            f"hl.measure.impedance: the record is incomplete: {log.fault or 'samples were lost or left out'}. Use a smaller "
            "excitation, hold the handle, or measure with a longer T"
        )
    if "own" in log.channels and log.saturated is not None and log.saturated.any():
        raise PaddleError(
            "hl.measure.impedance: the motor reached its limit, so the record is not linear. Use a smaller excitation, or "
            "give a place= nearer to the boundary"
        )
    columns = [log.channels.get("x_true", log.x), log.F, log.channels.get("own", log.F)]
    return [c[skip : skip + blocks * samples].reshape(blocks, samples) for c in columns]


def _evaluated(kept, lines, drive, paddle, exact, place, scene, ideal, simulated):
    """The impedances at the lines, from blocks of whole periods and the excitations that made them."""
    _, first, delay = kept[0]
    s = 2j * np.pi * lines / (first.samples * paddle.T)
    x, F, own = (np.concatenate(parts) for parts in zip(*(blocks for blocks, _, _ in kept), strict=True))
    r = np.concatenate([np.repeat(lines_in(e.period[None], lines), len(blocks[0]), axis=0) for blocks, e, _ in kept])
    X, hold = lines_in(x, lines), held_transfer(s, paddle.T, delay)
    found = response(lines_in(own, lines) * hold, s * X, r)
    if drive == "hand":
        hand, true = paddle.hand, X - _images(paddle, lines_in(F, lines), r, lines, first.samples)
        by_hand = (hand.k + s * hand.b) * (ramp_transfer(s, paddle.T) * r - true) - hand.m * s**2 * true
        other = response(by_hand, s * true, r)
    else:
        other = response(-lines_in(F, lines) * hold, s * X, r)
    Hx, Hv = law_at(exact, place, s.imag * paddle.T)
    seen = np.exp(-s * paddle.sensor_delay) if simulated else 1.0  # a board's record has the position as its sensor reads it
    left = int(np.count_nonzero(own == 0.0))
    return MeasuredImpedance(
        s.imag / (2 * np.pi), found, hold * seen * (Hx + s * Hv) / s, _ideal(scene, ideal, s), other, drive,
        (paddle.m * s + paddle.b) if simulated else None, left, _distortion(own, first), _about(drive, simulated, first, len(x)),
    )  # fmt: skip


def _images(paddle, F, intent, lines, samples):
    """Motion of the handle at the images of the lines, which sampling folds onto them; from the equation of motion.

    Between samples the held force and the straight piece of intent have all the images of a line, k + m N; the handle's
    inertia lets through little of them, as 1/m^3. Coulomb friction is left out.
    """
    order = np.concatenate([np.arange(-IMAGES, 0), np.arange(1, IMAGES + 1)])
    hand, T = paddle.hand, paddle.T
    s = 2j * np.pi * (lines + order[:, None] * samples) / (samples * T)
    plant = (paddle.m + hand.m) * s**2 + (paddle.b + hand.b) * s + hand.k
    by_force = -(held_transfer(s, T, paddle.delay) / plant).sum(0)
    by_intent = ((hand.k + s * hand.b) * ramp_transfer(s, T) / plant).sum(0)
    return by_force * F + by_intent * intent


def _distortion(F, excitation):
    """The force's rms at lines that nothing excites, over that at those that are excited; nan for a chirp."""
    if excitation.how != "multisine":
        return float("nan")
    power = abs(lines_in(F, np.arange(excitation.samples // 2 + 1))) ** 2
    excited = np.isin(np.arange(power.shape[1]), excitation.lines)
    return float(np.sqrt(power[:, 1:][:, ~excited[1:]].sum() / power[:, excited].sum()))


def _ideal(scene, ideal, s):
    if callable(ideal):
        return np.asarray(ideal(s), complex) * np.ones(len(s))
    if ideal is not None:
        return impedance_of(ideal, s.imag / (2 * np.pi))
    if "k" in scene.values and set(scene.parameters) <= {"k", "B", "x_o"}:
        return scene.values["k"] / s + scene.values.get("B", 0.0)
    try:
        return impedance_of(scene, s.imag / (2 * np.pi))
    except AnalysisError:  # memory of past samples: nothing in continuous time that it stands for
        return None


def _about(drive, simulated, excitation, blocks):
    name = {"multisine": "multisine", "swept_sine": "periodic chirp"}[excitation.how]
    if drive == "hand":
        return f"{name} of the hand's intent, {1e3 * excitation.amplitude:.3g} mm peak, {blocks} blocks"
    limits = "" if simulated else "; no force sensor: the hand's force, and the motor's own error, are not observable"
    return f"{name} of the motor's force, {excitation.amplitude:.3g} N peak, {blocks} blocks{limits}"
