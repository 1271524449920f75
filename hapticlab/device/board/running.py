"""A scene on a board from START until enough is recorded; what is refused leaves everything as it was."""

import zlib
from contextlib import contextmanager

from ...compiler.engines.bytecode import encode
from ...errors import HapticlabError, LinkError, PaddleError, PortError
from ..link.messages import TARGETS
from ..live import in_portions, named_values, send
from .greeting import explain_silence
from .recording import Recording, decimation
from .upload import upload

#: seconds a board may be silent in a run, beyond the time to the next look, before the host gives up
PATIENCE = 1.0
#: ticks from one look at a run to the next
LOOK = 500
#: the smallest size that BEGIN takes: one byte beside the CRC-32 at the end
SMALLEST = 5


def begin(paddle, program, every, options, force_max):
    """Load a program, or take the one that is there for None, and start it; refused, what ran before is meant again."""
    if program is not None and paddle._recording is not None and paddle.board["slots"] == 1:
        paddle.stop()
    ran, loaded, recording = paddle.exchange.beating, (paddle._program, paddle._crc), paddle._recording
    try:
        if program is not None:
            load(paddle, program)
        new = Recording(paddle._program, decimation(paddle._program, paddle.exchange.port, every))
        paddle._record(new)
        paddle.exchange.beating = True
        paddle.exchange.command("START", paddle._crc, new.every, options, force_max, then=new.begin)
    except HapticlabError as problem:
        if is_refusal(problem):
            paddle._record(recording)
            paddle.exchange.beating = ran
            if ran and paddle._program is not loaded[0]:
                paddle._program, paddle._crc = loaded
                # a BEGIN that nothing follows empties the place that was loaded: SET means the one that runs again
                paddle.exchange.command("BEGIN", TARGETS["PROGRAM"], SMALLEST)
        raise


def load(paddle, program):
    """Put a program and its parameters on the board; nothing runs until it is verified."""
    data = encode(program, word_bits=8 * paddle.board["word_bytes"])
    upload(paddle.exchange, "PROGRAM", data)
    paddle._program, paddle._crc = program, zlib.crc32(data[:-4])
    for some in in_portions(named_values(program)):
        send(paddle.exchange, program, some)


def collect(paddle, ticks, bar):
    """Read until so many ticks are recorded, or a fault."""
    recording, seen = paddle._running(), 0
    wanted, look = (ticks - 1) // recording.every * recording.every, max(LOOK, recording.every)
    while recording.last_tick < wanted and recording.fault is None:
        before, next_look = recording.last_tick, min(wanted, recording.last_tick + look)
        came = paddle.exchange.wait(
            lambda enough=next_look: recording.last_tick >= enough or recording.fault or paddle._recording is not recording,
            PATIENCE + look * paddle.T,
        )
        if paddle._recording is not recording:
            raise PaddleError("another thread ended this run, or began another; what was recorded went to that thread.")
        if not came and recording.last_tick == before:
            recording.fault = recording.fault or explain_silence(paddle.exchange, paddle.url)
        if bar is not None:
            bar.update(max(0, min(recording.last_tick + 1, ticks) - seen))
            seen = max(seen, recording.last_tick + 1)


@contextmanager
def guarded(give_up):
    """Give up where anything but a refusal ends what is done inside: an interrupt by the keyboard, a port that fails."""
    try:
        yield
    except BaseException as problem:
        if not is_refusal(problem):
            give_up()
        raise


def is_refusal(problem):
    """Return whether the host or the board said no, so that nothing was begun; anything else may leave a motor on."""
    if isinstance(problem, LinkError):
        return problem.result is not None
    return isinstance(problem, HapticlabError) and not isinstance(problem, PortError)
