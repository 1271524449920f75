"""Measure a motor's force constant: the handle presses on a kitchen scale, or lifts a hanging weight."""

from ...errors import PaddleError
from ...scene.notation.symbols import parameters
from ...scene.scene import Scene
from ..link.messages import UNCHECKED_FORCE_N
from .force_fit import fit_force, law_of
from .person import number
from .stored_settings import lead_home

#: [m/s^2], standard
GRAVITY = 9.80665
#: on a scale: parts of the largest force that the motor stands for ever
LEVELS, PART = (0.0, 0.05, 0.15, 0.3, 0.5, 0.75, 1.0), 0.9
#: with a weight: steps of the ramp, how long each lasts [s], and the motion that is a lift [m]
STEPS, LASTS, LIFT = 120, 0.04, 2e-3
#: s for a lifted handle to come to rest at the other stop
SETTLES = 1.5


def largest_force(settings):
    """Return the force [N, as the board reckons it now] that may be asked for as long as it takes to read a scale."""
    checked = settings.force_max if settings.checked else UNCHECKED_FORCE_N
    return PART * min(checked, settings.force_continuous, settings.force_max, settings.force_full)


def measure_force(paddle, person):
    """Lead a person through a measurement, and return the new settings and what was found, in lines."""
    lead_home(paddle, person)
    settings = paddle.settings
    if not settings.checked:
        person.say(
            f"The sign of the motor is not checked yet, so forces stay below {UNCHECKED_FORCE_N} N and the readings "
            "are less precise."
        )
    how = person.choose(
        "How do you want to measure the force?",
        {"scale": "the handle presses on a kitchen scale", "weight": "the handle lifts a hanging weight of known mass"},
    )
    with paddle.attended():
        forces, newtons = on_scale(paddle, person) if how == "scale" else with_weights(paddle, person)
    duties = [abs(settings.duty(force, paddle.board["duty_full"])) for force in forces]
    found = fit_force(duties, newtons, settings, intercept=how == "scale")
    return found.into(settings), found.words(law_of(settings), settings.duty_dead)


def on_scale(paddle, person):
    """Return the forces asked for and those read from a scale [N]."""
    way = person.choose(
        "Fix the paddle so that the handle rests on a kitchen scale, and set the scale to zero. In which direction does the "
        "handle press?",
        {"wall": "towards the walls", "away": "away from the walls"},
    )
    forces, newtons = [], []
    for level in LEVELS:
        force = level * largest_force(paddle.settings)
        _start(paddle, force if way == "away" else -force)
        grams = number(
            person,
            f"The motor presses with about {force / GRAVITY * 1e3:.0f} g. Tap the table; what does the scale show [g]?",
            low=-20000,
            high=20000,
        )
        _stop(paddle)
        forces.append(force)
        newtons.append(grams * 1e-3 * GRAVITY)
    return forces, newtons


def with_weights(paddle, person):
    """Return the forces asked for that hold weights, and the weights [N].

    The least force that lifts is above the weight by friction, the one that lets it fall below it as much; as the ramps
    are alike, so are their lags. The mean has neither.
    """
    forces, newtons = [], []
    while True:
        at_most = largest_force(paddle.settings)
        grams = number(
            person,
            f"Hang a weight on the handle that pulls it to a stop, about {at_most / 2 / GRAVITY * 1e3:.0f} g by the present "
            "settings. Do not touch the handle. What is the mass of the weight [g]?",
            low=1,
            high=20000,
        )
        up, down = _lift(paddle, at_most)
        person.say(
            f"The weight rises at {up:.3g} N and falls at {down:.3g} N, by the present settings: friction "
            f"{abs(up - down) / 2:.2g} N."
        )
        forces.append((up + down) / 2)
        newtons.append(grams * 1e-3 * GRAVITY)
        if (
            person.choose("Do you want to measure another weight? Three weights also show the motor law.", {"yes": "", "no": ""})
            == "no"
        ):
            return forces, newtons


def _lift(paddle, at_most):
    """Return the forces at which the handle leaves the weight's stop, and comes back to it [N]."""
    settings, rest = paddle.settings, paddle.state()["x"]
    middle = (settings.travel_min + settings.travel_max) / 2
    away = 1 if rest < middle else -1  # from the stop
    _start(paddle, 0.0)
    up = None
    for k in range(1, STEPS + 1):
        _step(paddle, -away * at_most * k / STEPS)
        if away * (paddle.state()["x"] - rest) > LIFT:
            up = at_most * k / STEPS
            break
    if up is None:
        _stop(paddle)
        raise PaddleError(
            f"force: {at_most:.3g} N, by the present settings, does not lift the weight off its stop. Hang a lighter "
            "weight, check the motor's "
            "supply, and see that the thread pulls along the handle's path."
        )
    paddle.wait(SETTLES)
    far = paddle.state()["x"]
    for k in range(1, 2 * STEPS + 1):
        down = up - at_most * k / STEPS
        _step(paddle, -away * down)
        if away * (far - paddle.state()["x"]) > LIFT:
            _stop(paddle)
            return up, down
    _stop(paddle)
    raise PaddleError(
        "force: the weight does not pull the handle back, because friction is larger than its weight. Hang a heavier weight."
    )


def _start(paddle, F):
    f = parameters("f", units="N")
    paddle.start(Scene(force=f, name="constant force")(f=F), every=20)


def _step(paddle, F):
    paddle.set(f=F)
    paddle.wait(LASTS)


def _stop(paddle):
    log = paddle.stop()
    if log.fault:
        raise PaddleError(f"force: the measurement ended early: {log.fault}")
