"""hl.live: a paddle and a scene in a notebook, moving."""

from __future__ import annotations

import inspect
import weakref
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import instance, number, what_is
from ..base.telemetry import Telemetry
from ..compiler.tick.compile_scene import compile
from ..device.board.serial_paddle import SerialPaddle
from ..device.hand.rehearsal import REHEARSAL, Rehearsal
from ..device.simulated.stepping import with_grip
from ..errors import EngineMissingError, PaddleError
from ..scene.scene import check_scene
from .browser_view import front as canvas
from .plain.plain_view import front as plain_widgets
from .plain.plain_view import still_picture
from .session import Session

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..device.paddle import Paddle
    from ..scene.scene import Scene

#: scene time over the clock's time
SPEEDS = (1e-3, 10.0)
#: where widgets are not shown: beside a picture that stands still
STILL = (
    "This is a still picture of a live view. It moves where a notebook shows widgets: run its cell in JupyterLab with "
    "hapticlab[notebook] installed, or try hl.live(..., plain=True)."
)
RECORD = "press Start and then Record in the view, push, and press Stop recording"


def live(
    paddle: Paddle,
    scene: Scene,
    *,
    sliders: Mapping[str, tuple[float, float]] | None = None,
    time_scale: float = 1.0,
    picture: Any = None,
    let_go: bool = False,
    rehearsal: Rehearsal = REHEARSAL,
    plain: bool = False,
    **compile_options: Any,
) -> LiveView:
    """Show a paddle and a scene in a notebook: it moves, can be pushed, and every parameter has a slider.

    On a simulated paddle the pointer, a finger or the arrow keys say where the hand means to be; the hand is the paddle's
    own, its intent and push replaced, or ``hl.Hand("pinch")`` where that has no spring. On a board the hand is yours, and
    the motor goes on only when Start is pressed. Nothing runs before a notebook shows the view; all ends when its last view
    closes or falls silent for 2 s. Where a notebook's widgets wait for the cell that runs (no subshells: ipykernel before 7,
    and editors other than JupyterLab), a cell longer than that is such a silence: a simulation then goes on after it, a
    board waits for Start. Where a browser runs Python, a view and the cells take turns: a simulation stands still while a cell
    computes, and goes on while one awaits, for up to 60 s.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    scene : Scene
        With values for all its parameters.
    sliders : dict of str to (low, high), optional
        In SI; by default of every live parameter.
    time_scale : float
        Scene time over the clock's: 0.1 is slow motion. A board's is 1.
    picture : str, shapes or callable, optional
        Instead of the scene's own picture: see ``scene.picture``.
    let_go : bool
        True: a hand that is dragged by the pointer lets go of the handle where the drag is released, so that the handle can be
        thrown. On a board the hand is yours, and nothing changes.
    rehearsal : Rehearsal
        What the hand does for ``view.rehearsal``: ``hl.people.Rehearsal(intent=, duration=)``.
    plain : bool
        True shows the view of plain widgets (ipywidgets alone), where a front end does not load anywidget.
    **compile_options
        Of hapticlab.compile: method, substeps, hold, dtype, live.

    Returns
    -------
    LiveView
        A notebook shows it where it is the last line of a cell; ``view.log`` is what was recorded, None before.

    Raises
    ------
    PaddleError, ParameterError, SceneError, AnalysisError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    >>> view = hl.live(paddle, hl.wall()(k=300, x_o=0.01), rehearsal=hl.people.Rehearsal(duration=1.0))
    >>> view.set(k=600)
    >>> print(view)
    live view of zoh wall: not on view; B = 0 N*s/m, k = 600 N/m, x_o = 0.01 m
    >>> log = view.log or view.rehearsal
    >>> print(view.log, len(log), round(float(log.F.max()), 1))
    None 1000 1.1
    """
    check_scene(scene)
    slowest, fastest = SPEEDS
    why = "1 is real time, 0.1 slow motion"
    time_scale = number("time_scale", time_scale, "", "a live view", least=slowest, most=fastest, why=why, error=PaddleError)
    if time_scale != 1 and isinstance(paddle, SerialPaddle):
        raise PaddleError(f"time_scale = {time_scale:g}; a board runs in real time: leave it out, or take a SimulatedPaddle.")
    instance("rehearsal", rehearsal, Rehearsal, "hl.people.Rehearsal(intent=..., duration=...)", error=PaddleError)
    _check_options(compile_options)
    looks = {"sliders": sliders, "speed": time_scale, "picture": picture, "let_go": let_go}
    session = Session(paddle, scene, **looks, **compile_options)
    return LiveView(session, rehearsal, compile_options, plain)


class LiveView:
    """A paddle and a scene on view; made by :func:`live`."""

    def __init__(self, session, rehearsal, options, plain=False):
        self._session, self._options, self._plain = session, options, plain
        self._rehearsal, self._duration = rehearsal.path(), rehearsal.duration
        self._front, self._rehearsed = None, (None, None)
        # whoever else keeps the session, its thread or a widget, it ends with this view
        weakref.finalize(self, session.close)

    @property
    def values(self):
        """The scene's parameters as they are now, SI."""
        return self._session.values

    @property
    def status(self):
        """What goes on, in words."""
        return self._session.status

    @property
    def log(self):
        """The last recording; None where nobody has recorded yet. ``view.log or view.rehearsal`` needs nobody."""
        return self._session.recorded()

    @property
    def rehearsal(self):
        """What a simulated hand that nobody leads does with these parameters: the same record every time."""
        if self._session.source.kind == "board":
            raise PaddleError(f"nothing was recorded, and a board has no rehearsal: {RECORD}")
        if self._rehearsed[0] != self.values:
            self._rehearsed = dict(self.values), self._rehearse()
        return self._rehearsed[1]

    def set(self, **values):
        """Set parameters from the next tick on, as sliders do; what is out of range is refused."""
        known = self._session.scene.parameters
        numbers = {name: known[name].check(value) if name in known else value for name, value in values.items()}
        self._session.set(**numbers)

    def start(self):
        """Run from the beginning. A board's motor is started by hand, in the view."""
        self._by_hand("Start")
        self._session.pressed("start")

    def pause(self):
        """Stand still; a board's motor goes off."""
        self._session.pressed("pause")

    def resume(self):
        """Run on."""
        self._by_hand("Start")
        self._session.pressed("resume")

    def record(self):
        """Record from the next sample on, once the scene runs."""
        self._session.pressed("record")

    def stop_recording(self):
        """End the recording; :attr:`log` is what it holds."""
        self._session.pressed("stop")

    def save(self, path):
        """Write :attr:`log` to a file and return its path; ``hl.records.Telemetry.load`` reads it."""
        return self._recorded().save(path)

    def replay(self, log=None):
        """Play a log in the view, the last one recorded by default; a board's motor is off meanwhile."""
        if log is not None and not isinstance(log, Telemetry):
            raise PaddleError(f"replay of {what_is(log)}; needs a record: view.log, or hl.records.Telemetry.load(path)")
        log = self._recorded() if log is None else log
        if not len(log):
            raise PaddleError("replay of a record without samples; record a while first, or give another one")
        self._session.pressed("replay", log)

    def close(self):
        """End the view; a board's motor goes off."""
        self._session.end()

    def _recorded(self):
        if self.log is None:
            raise PaddleError(f"nothing was recorded: {RECORD}; view.rehearsal is a record of a simulated hand")
        return self.log

    def _by_hand(self, button):
        if self._session.source.kind == "board":
            raise PaddleError(f"a motor does not start because a cell ran: press {button} in the view, and hold the handle")

    def _rehearse(self):
        session = self._session
        start = float(np.asarray(self._rehearsal(np.zeros(1)), float).reshape(-1)[0])
        paddle = with_grip(session.source.paddle, self._rehearsal)
        scene = session.scene(**self.values)
        log = paddle.run(scene, duration=self._duration, x=start, progress=False, **self._options)
        intent = np.broadcast_to(np.asarray(self._rehearsal(log.t), float), log.t.shape)
        return replace(log, channels={**log.channels, "intent": intent}, units={**log.units, "intent": "m"})

    def __repr__(self):
        shown = ", ".join(f"{s.name} = {self.values[s.name]:g} {s.unit}".removesuffix(" 1") for s in self._session.spans)
        state = self.status.rstrip(".") if self._session.on_view else "not on view"
        return f"live view of {self._session.source.program.name}: {state}; {shown or 'no parameters'}"

    def _repr_mimebundle_(self, **options):
        if self._front is None:
            self._front = _front(self._session, (plain_widgets,) if self._plain else (canvas, plain_widgets))
        bundle = {} if self._front is None else self._front._repr_mimebundle_(**options)
        bundle, metadata = bundle if isinstance(bundle, tuple) else (bundle or {}, {})
        still = {"text/plain": f"{self!r}\n{STILL}", "text/html": still_picture(self._session, STILL)}
        return {**bundle, **still}, metadata


def _check_options(options):
    allowed = [name for name in inspect.signature(compile).parameters if name not in ("scene", "T", "velocity")]
    for name in options.keys() - {"engine"}:
        if name not in allowed:
            raise PaddleError(f"{name} is not an option of a live view or of hapticlab.compile. Give one of {', '.join(allowed)}")


def _front(session, kinds):
    """Return the widget that shows a session, of the first kind that imports: anywidget's, then plain ones; else None."""
    for make in kinds:
        try:
            return make(session)
        except EngineMissingError:
            continue
    return None
