"""A scene that a board keeps over power-off and runs without a computer."""

from ...compiler.boards.board_fit import fit
from ...compiler.engines.bytecode import encode
from ...compiler.ir.program import Program
from ...errors import PaddleError
from ..live import check_margin
from .upload import STORE_PATIENCE, upload

#: what starts it, for whoever stands beside it
GESTURE = "lead the handle to both stops, then hold it in the middle for 1 s: the force comes on"


def keep(paddle, scene, **options):
    """Write a scene into the board's memory that survives power-off, arm it, and return what starts it, in words.

    After power-on without a computer the board waits for a deliberate act that also tells it where the handle is. A
    computer that says hello takes the board back. Parameters are fixed at their values: nobody is there to set them.

    Parameters
    ----------
    paddle : SerialPaddle
    scene : Scene
        With every parameter bound.
    **options
        Of hapticlab.compile.

    Raises
    ------
    PaddleError
        If a scene runs, the motor's sign was never checked, or its steps are unstable.
    ProgramLimitError
        If a step could be late, with whatever operands: nobody is there to see that it was.
    LinkError
        If it does not fit the board's store.

    Examples
    --------
    >>> import hapticlab as hl
    >>> with hl.connect("sim://hapkit") as paddle:
    ...     print(paddle.keep(hl.wall()(k=150, x_o=0.01)))
    lead the handle to both stops, then hold it in the middle for 1 s: the force comes on
    """
    if paddle.settings is None or not paddle.settings.checked:
        raise PaddleError(
            "the motor's sign was not checked on this board; a board without a computer must not push the wrong way: "
            "run `hapticlab calibrate` first."
        )
    program = paddle.program(scene, live=(), **options)
    check_margin(program)
    known = {} if isinstance(scene, Program) else {"T": paddle.T, "velocity": paddle.velocity, "live": (), **options}
    fit(scene, promise=True, **paddle._board(), **known)
    upload(paddle.exchange, "STANDALONE", encode(program, word_bits=8 * paddle.board["word_bytes"]))
    paddle.exchange.command("ARM", 1, patience=STORE_PATIENCE, tries=2)
    return GESTURE


def forget(paddle):
    """Disarm the board: after power-on it waits for a computer again."""
    paddle.exchange.command("ARM", 0, patience=STORE_PATIENCE, tries=2)
