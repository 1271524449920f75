"""Shake the handle of a board by its motor, gently: led to its place, risen slowly, limited in force, reach and speed."""

from dataclasses import replace

from ..errors import PaddleError
from ..scene.notation.cases import when
from ..scene.notation.symbols import n
from .leash import held_back
from .small_signal import force_at_rest
from .trials import lead_back, speed_limit

#: s over which the motor's force rises from none to all, at most
RISES = 0.5
#: of the force that a motor stands for long, what holds a place by default
PART = 0.5
#: of the excitation's amplitude, what the motor may give beside the pull
ROOM = 2.0


def motor_stands(paddle):
    """The force [N] that the motor of a board stands for long, or the limit of a simulated one, or None."""
    settings = getattr(paddle, "settings", None)
    if settings is not None:
        return min(settings.force_continuous, settings.force_max)
    return getattr(paddle, "force_max", None)


def bearable(program, paddle, origin, depth):
    """The place [m], ``depth`` beyond the origin or less: the motor holds it with half of what it stands."""
    stands = motor_stands(paddle)
    for _ in range(8):  # one step for a straight spring
        pull = abs(force_at_rest(program, origin + depth))
        if stands is None or pull <= 1.001 * PART * stands:
            break
        depth *= PART * stands / pull
    return origin + depth


def most_force(paddle, pull, amplitude, force_max):
    """Return the largest force [N] that a board's motor may give, or refuse a pull and amplitude that it does not stand."""
    stands = motor_stands(paddle)
    if stands is None:
        raise PaddleError(
            "hl.measure.impedance: the board has no calibration, so the largest force of its motor is not known. Run "
            "`hapticlab calibrate` first."
        )
    if abs(pull) + amplitude > stands:
        raise PaddleError(
            f"hl.measure.impedance: {abs(pull):.3g} N to hold the position and {amplitude:.3g} N to shake the handle are "
            f"more than the {stands:.3g} N that the motor can give continuously. Give a place= nearer to the boundary, or a "
            "smaller "
            "excitation=hl.measure.Excitation(amplitude=...)"
        )
    return min(stands, abs(pull) + ROOM * amplitude) if force_max is None else min(force_max, paddle.settings.force_max)


def shake_board(paddle, shaken, duration, *, place, origin, amplitude, force_max, reach, speed_max, settle, options):
    """Lead the handle to a place [m], run a shaken scene there, and return the record; refuse one that was cut short."""
    lead_back(paddle, place, force_max)
    depth, at = abs(place - origin), paddle.state()["x"]
    if abs(at - place) > (depth or reach):
        raise PaddleError(
            f"hl.measure.impedance: the handle was moved towards {1e3 * place:.3g} mm but is at {1e3 * at:.3g} mm. Hold it "
            "lightly there, or release it"
        )
    rises = max(1, round(min(RISES, settle) / paddle.T))
    softly = replace(shaken, force=when(n < rises, n / rises, 1) * shaken.force)
    fastest = speed_limit(paddle, speed_max)
    safe = held_back(softly, reach, speed_max=fastest, work=amplitude * fastest * duration)
    log = paddle.run(safe, duration=duration, force_max=force_max, progress=False, **options)
    if log.cut.any():
        raise PaddleError(
            f"hl.measure.impedance: the motor was switched off after {log.t[log.cut.argmax()]:.3g} s, because the handle "
            f"moved further than {1e3 * reach:.3g} mm or faster than {fastest:.3g} m/s, the limits of "
            "safety=hl.measure.Safety(reach=, speed_max=). Use a smaller excitation, hold the handle, or use a softer wall"
        )
    if log.saturated is not None and log.saturated.any():
        raise PaddleError(
            f"hl.measure.impedance: the force reached its limit of {force_max:.3g} N in {int(log.saturated.sum())} samples, "
            "so the record is not linear. If the wall chatters, hold the handle, or use a softer wall. Otherwise use a "
            "smaller excitation, or allow more force: safety=hl.measure.Safety(force_max=...)"
        )
    return log
