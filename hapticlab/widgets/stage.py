"""What a live view shows: a scene that moves, its picture, what is said of it, and what presses and sliders do to it."""

import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ..analysis.pictures.touching import touching
from ..device.board.serial_paddle import is_refusal
from ..device.live_parameters import named_values
from ..errors import HapticlabError, PaddleError
from .description import description
from .frame import COLUMNS, Frame
from .motion import Motion
from .picture import moving_picture
from .signals import HIDING_FORCE, signals
from .sources import source_of
from .spans import spans
from .status_words import vibration_words, words_of
from .traces import rows_apart

#: pictures a second of a scene that rests
RESTING = 4.0
#: words change no sooner than this, and a note stays so long [s]
LOOK, NOTE = 0.25, 6.0
#: a press that starts a motor counts for so long [s]
TIMELY = 0.5
#: from the end of a motor on no press starts it for so long [s]: it was meant for Stop, or is the second of two
QUIET = 1.0
JUST_OFF = "The motor went off just now and stays off. Press Start again"
#: a handle that was let go is caught so far past where a hand goes [m]
PAST = 5e-3
CAME_LATE = "Start came late, or just after the notebook was silent: press it again"
MOTOR_OFF = "The motor is off. Press Start: the scene then begins at its first state"
#: scene time over the clock's in slow motion, at most
SLOW = 0.1


class Stage:
    """A scene on its paddle with all that is shown of it; one caller at a time.

    Parameters
    ----------
    paddle, scene, sliders, speed, picture, show_force, let_go, **options
        As for :class:`~hapticlab.widgets.session.Session`.
    clock : callable
        Seconds.
    """

    def __init__(self, paddle, scene, *, clock, sliders=None, speed=1.0, picture=None, show_force=True, let_go=False, **options):
        self.let_go, self.hidden = bool(let_go), frozenset() if show_force else HIDING_FORCE
        self.picture = moving_picture(scene, paddle, picture)
        self.scene = replace(scene, watch={**scene.watch, **self.picture.channels})
        self.source = source_of(paddle, self.scene, **options)
        self.spans = spans(self.source.program, sliders)
        self.signals, self._speed = signals(scene, self.hidden), speed
        self.slow_speed = min(SLOW, speed)
        touched = touching(scene, self.scene.watch)
        self.motion = Motion(self.source, speed, clock, tuple(scene.watch), touched)
        self.touches, self.clock = touched is not None, clock
        self.awake, self._wants_to_run, self._goes_on = False, self.source.kind == "simulated", False
        self.stopped = "time stood still" if self._wants_to_run else "the motor went off"
        self.hand_at, self.quiet, self._motor, self._off_since = None, QUIET, False, -math.inf
        self._note, self._note_until, self._lost, self._vibration = "", -1.0, "", ""
        self._status, self._next_look, self._next_frame = "", -1.0, -1.0

    @property
    def values(self):
        """The scene's parameters as they are now, SI."""
        return named_values(self.source.program)

    def description(self):
        """Facts that a front end is told once, see :func:`~hapticlab.widgets.description.description`."""
        return description(self)

    # --- what it does

    def wake(self):
        """Begin to move because somebody looks: a simulation; a board waits for Start."""
        if not self.awake:
            self.awake = True
            self.source.warm()
            self.motion.wake()  # after it, for compiling took its time
            self._goes_on = self._wants_to_run
            self._go_on()

    def _go_on(self):
        """Run as before nobody looked, once no replay is on view."""
        if self._goes_on and not self.motion.replaying:
            self._goes_on = False
            if self._wants_to_run:
                self.resume()

    def rest(self):
        """Stand still because nobody looks; a simulation or a replay goes on when somebody does, a board only after Start."""
        if self.awake:
            self.awake = False
            self._halt(self.motion.rest)

    def end(self):
        """Stand still for good."""
        self.rest()
        self.guarded(self.motion.replay, None)

    def obey(self, said):
        """Do what was said, in its order, as (what, given); of a slider's moves in a row the last counts."""
        moves = {}
        for what, given in said:
            if what == "intend":
                self.hand_at = given
                continue
            self.look()
            if what == "move":
                moves[given[0]] = given[1]
                continue
            self._set_each(moves)
            if what == "hold":
                self.guarded(self.motion.hold, given)
            elif what == "press":
                self._pressed(*given)
        self._set_each(moves)

    def _set_each(self, moves):
        while moves:
            name = next(iter(moves))
            self.guarded(self.motion.set, **{name: moves.pop(name)})

    def _pressed(self, name, when):
        """Do what a press asks for that was made at a time; the hand of a late one has left the board's handle."""
        starts = name in ("start", "resume", "restart") and self.source.kind == "board"
        self._watch_motor()
        if starts and self.clock() - when > TIMELY:
            self.tell(CAME_LATE)
        elif starts and not self._motor and when - self._off_since < self.quiet:
            self.tell(JUST_OFF)
        else:
            self.guarded(getattr(self, name))
            self._watch_motor()

    def _watch_motor(self):
        """Note when a board's motor went off, for whatever reason."""
        on = self.motion.running and self.source.motor
        if self._motor and not on:
            self._off_since = self.clock()
        self._motor = on

    def advance(self, wanted):
        """Go on to the clock, with a hand that means to be at a place [m]; return a frame's rows, or None.

        Where a handle that was let go leaves the picture, ``hand_at`` is where the hand now holds it [m].
        """
        running, recording = self.motion.running, self.motion.recording
        rows = self.guarded(self.motion.advance, wanted)
        self.guarded(self._go_on)
        self._watch_motor()
        if running and not self.motion.running:
            self.look()
        low, high = self.picture.reach
        if not (self.motion.held or self.motion.replaying) and not low - PAST <= self.motion.place <= high + PAST:
            self.motion.hold(True)
            self.hand_at = min(max(self.motion.place, low), high)
            self.tell("The handle that was let go came to the end of its way: the hand holds it there")
        if rows is not None:
            self._look_for_it()
        if recording and not self.motion.recording:
            self.tell("The recording ended: it was long, or the motor went off")
        return rows

    def _look_for_it(self):
        """Stop a simulation whose handle is far out of the picture: no hand holds it there."""
        (low, high), x = self.picture.reach, self.motion.place
        if self.source.kind == "board" or not self.motion.running or self.motion.replaying:
            return
        if max(low - x, x - high) > high - low:
            self._halt(self.motion.pause)
            self._wants_to_run = False
            self._lost = f"The loop is unstable: the handle left the picture (x = {1e3 * x:.3g} mm). Press Start again"

    def guarded(self, work, *given, **values):
        """Do work; what it raises is told, and anything but a refusal stops what moves."""
        try:
            return work(*given, **values)
        except Exception as problem:  # a thread has nobody else to tell
            kind = "" if isinstance(problem, HapticlabError) else f"{type(problem).__name__}: "
            self.tell(f"{kind}{problem}")
            if not is_refusal(problem):
                self._halt(self.motion.pause)
        return None

    def _halt(self, stop):
        """Stand still whatever happens: what stopping raises is told, and a board that hears nothing stops by itself."""
        try:
            stop()
        except Exception as problem:
            self.tell(f"{type(problem).__name__}: {problem}")

    # --- presses

    def start(self):
        self._wants_to_run = self.source.kind == "simulated"
        self._lost = ""
        self.motion.start()
        if self._wants_to_run:  # a simulated hand begins where the handle does
            self.motion.hold(True)
            self.hand_at = self.source.place

    def restart(self):
        """Begin again at the first state of the scene; a board's motor that is off stays off."""
        if self.source.kind == "board" and not (self.motion.running and self.source.motor):
            raise PaddleError(MOTOR_OFF)
        self.start()

    def slow(self):
        """Begin or end slow motion."""
        if self.source.kind == "board":
            raise PaddleError("A board runs in real time, so slow motion needs a SimulatedPaddle")
        usual = self._speed if self._speed > SLOW else 1.0
        self.motion.pass_at(self.slow_speed if self.motion.speed != self.slow_speed else usual)

    def resume(self):
        if self._lost or (self.source.fault and self.source.kind == "simulated"):
            self.start()
            return
        self._wants_to_run = self.source.kind == "simulated"
        self.motion.resume()

    def pause(self):
        self._wants_to_run = False
        self.motion.pause()

    def record(self):
        self.motion.record()

    def stop(self):
        self.motion.stop_recording()

    def save(self):
        log = self._recorded()
        self.tell(f"Saved {log.save(_free_name(log.scene))} in the folder {Path.cwd().name}: hl.records.Telemetry.load reads it")

    def replay(self, log=None):
        """Play a log, or what was recorded last; pressed again, end it."""
        ends = log is None and self.motion.replaying
        self.motion.replay(None if ends else self._recorded() if log is None else log)

    def _recorded(self):
        log = self.motion.recorded()
        if log is None:
            raise PaddleError("nothing is recorded yet; press Record, and Stop recording")
        return log

    # --- frames

    def tell(self, note):
        """Say something for a while."""
        self._note, self._note_until, self._next_look = note, self.clock() + NOTE, -1.0

    @property
    def note(self):
        """What is said for a while, or nothing."""
        return self._note if self.clock() < self._note_until else ""

    def words(self):
        """Return one or two sentences about what goes on."""
        motion, source = self.motion, self.source
        self._vibration = "" if "F" in self.hidden else vibration_words(motion, source)  # it tells how stiff a wall is
        said = words_of(motion, source, self.clock(), vibration=self._vibration, lost=self._lost)
        return " ".join(f"{sentence.rstrip('.')}." for sentence in (*said, self.note) if sentence)

    def frame(self, rows, wanted):
        """Return the frame that is due, or None: a picture that rests is shown now and then."""
        now = self.clock()
        if rows is None and now < self._next_frame:
            return None
        self._next_frame, status = now + 1 / RESTING, ""
        if now >= self._next_look:
            self._next_look = now + LOOK
            self._status, before = self.words(), self._status
            status = self._status if self._status != before else ""
        given = {} if rows is None else {"rows": self._without_hidden(rows)}
        return Frame(self.motion.time, picture=self.drawn(wanted), status=status, flags=self._frame_flags(wanted), **given)

    def _without_hidden(self, rows):
        """Return rows that do not tell what is hidden."""
        for k, name in enumerate((*COLUMNS, *self.motion.watched)):
            if name in self.hidden:
                rows[:, k] = math.nan
        return rows

    def last_frame(self, words):
        """Return a frame for a page to which no more will come for now."""
        self.look()
        self._status = ""
        with suppress(Exception):
            return Frame(self.motion.time, picture=self.drawn(None), status=words, flags=self.flags())
        return Frame(0.0, status=words, flags=dict.fromkeys(("running", "recording", "replaying", "held", "motor"), False))

    def look(self):
        """Have the next frame show everything at once."""
        self._next_frame = self._next_look = -1.0

    def flags(self):
        """Return a frame's flags."""
        flags = {name: getattr(self.motion, name) for name in ("running", "recording", "replaying", "held")}
        values = self.values
        flags |= {"motor": self.source.motor, "recorded": self.motion.has_record, "vibrates": bool(self._vibration)}
        flags |= {"speed": self.motion.speed, "T": self.motion.traces.T, "apart": rows_apart(self.motion.traces.T)}
        return {**flags, "values": {span.name: values[span.name] for span in self.spans}}

    def _frame_flags(self, wanted):
        """Return the flags, and where a hand begins to lead: where it means to be, or where a handle is that was let go."""
        return {**self.flags(), "wanted": wanted if self.motion.held else self.motion.place}

    def drawn(self, wanted):
        """Return the picture; one that cannot be drawn is told, and the scene goes on without it."""
        try:
            hidden = dict.fromkeys(self.hidden & {"F", "intent"}, math.nan)
            return self.picture.draw({**self.motion.values(wanted), **hidden})
        except Exception as problem:
            self.tell(f"The picture cannot be drawn: {type(problem).__name__}: {problem}")
            return ()


def _free_name(scene):
    """Return a name of a file that is not there yet."""
    stem = "".join(c if c.isalnum() else "_" for c in scene).strip("_") or "live"
    return next(path for k in range(1, 10_000) if not (path := Path(f"{stem}-{k}.npz")).exists())
