"""The last steps: the motor's sign, how late the handle follows the motor, and what a scale shows of its force."""

import math

from ...scene.notation.symbols import parameters
from ...scene.scene import Scene
from ..setup.calibrate import calibrate
from ..setup.force_constant import largest_force, on_scale
from ..setup.person import agrees
from .lag import fit_lag
from .report import Finding
from .steps import PULL

#: changes of the force, how long each lasts [s], and how often they may begin again: a busy computer is a silent host
TUGS, LASTS, TRIES = 40, 0.06, 3
#: by which a lag may miss what is predicted [s]: a sample of jitter
LAG_MISS = 0.5e-3
#: parts of a force, and newtons, by which a scale may differ
FORCE_PART, FORCE_N = 0.1, 0.05


def sign(bench):
    """Check the motor's sign where nobody has: after the stops, before more force."""
    paddle = bench.paddle
    if not paddle.settings.checked and agrees(bench.person, "Check the sign of the motor now, with 0.5 N at most?"):
        calibrate(paddle, bench.person, only="sign")
    checked = bool(paddle.settings.checked)
    yield Finding.seen("sign", "motor's sign checked", checked, "yes" if checked else "no", "positive work on a passive spring")


def lag(bench):
    """Tug the handle back and forth, and fit how late it follows."""
    bench.hold("Hold it between two fingers, as loosely as you can.")
    for _ in range(TRIES):
        log = _tugged(bench)
        if not log.fault:
            break
    else:
        yield Finding.seen("lag", "the tugs", False, log.fault, "no fault was provoked")
        return
    changes = [(t, change["f"]) for t, change in log.changes if "f" in change]
    found = fit_lag(log.t, log.x, changes)
    settings = bench.paddle.settings
    low = log.delay + settings.sensor_delay
    source = "mean step of the board, and sensor_delay of its settings"
    note = f"spread {found.spread:.2g} s"
    yield Finding.of("lag", "force to motion", found.lag, "s", low - LAG_MISS, low + LAG_MISS, source, note)
    source = "m of the settings, nominal unless identified; fingers add to it"
    yield Finding.of("lag", "mass felt", found.mass, "kg", 0.5 * (settings.m or 0.0), math.inf, source)


def _tugged(bench):
    """Pull one way and the other, and return the Telemetry."""
    f = parameters("f", units="N")
    with bench.pulled(Scene(force=f, name="tugs")(f=0.0)) as paddle:
        for k in range(TUGS):
            if paddle.under_way.fault is not None:
                break
            paddle.set(f=PULL * (-1) ** k)
            paddle.wait(LASTS / 2 if k == 0 else LASTS)
        return paddle.stop()


def force(bench):
    """Press on a scale, if there is one."""
    most = f"The motor then presses with up to {largest_force(bench.paddle.settings):.2g} N."
    if not agrees(bench.person, f"Do you have a kitchen scale here, to measure the force? {most}"):
        yield Finding.skipped("force", "no scale")
        return
    bench.person.ask("Rest the handle on the scale, with the paddle fixed to the table, and press Enter.")
    with bench.paddle.attended():
        forces, newtons = on_scale(bench.paddle, bench.person)
    rest, full = newtons[0], bench.paddle.board["duty_full"]
    for asked, shown in zip(forces, newtons, strict=True):
        size, found = abs(asked), abs(shown - rest)
        miss = FORCE_PART * size + FORCE_N
        note = f"duty {abs(bench.paddle.settings.duty(asked, full)):.3f}"
        yield Finding.of("force", f"force for {size:.3g} N", found, "N", max(0, size - miss), size + miss, "the settings", note)
