"""What the page of a real paddle can send to a board: scenes, compiled for each board whose period and memory they fit."""

import base64
import time
from dataclasses import dataclass, field

from ...analysis.pictures.touching import recorded_touching
from ...compiler.boards.board_records import BOARDS
from ...compiler.boards.cost import cost
from ...compiler.engines.bytecode import encode
from ...device.board.run import decimation
from ...device.live_parameters import check_margin
from ...device.setup.connect import connect
from ...errors import HapticlabError
from ...library.entries import CATALOGUE
from ...scene.laws.chapter_laws import wall
from ...scene.notation.symbols import n, parameters, when, x
from ...scene.scene import Scene
from ..browser_view import about
from ..picture import moving_picture
from ..shared.page_data import parameters_told
from ..stage import MOTOR_OFF, Stage
from ..status_words import NOTICED
from ..traces import rows_apart

HELP = " It also goes off at once when the page is hidden. Space and Esc stop it."
PRESS = "Motor off: hold the handle, then press Start"
#: of a wall, in the order in which they are tried: period [s]
PERIODS = {"uno": (1e-3, 2e-3), "pico": (1e-3,), "host": (1e-3,)}
#: of an encoder, per second, that are asked of a board; the first one is none
EDGES = (1.0, 5e3, 1e4, 2e4, 4.2e4, 8.2e4, 1e6)


@dataclass(frozen=True)
class Choice:
    """A scene to choose: with values, its sliders, options of hapticlab.compile to try, by board, and a sentence."""

    name: str
    title: str
    scene: Scene
    sliders: dict | None = None
    options: dict = field(default_factory=lambda: {board: [{"T": T} for T in periods] for board, periods in PERIODS.items()})
    about: str = ""


def choices():
    """Return the scenes to choose from, the labs' first."""
    return [*labs(), *library()]


def labs():
    """Walls and springs as the labs have them, with what a paddle is left to hold."""
    k, left, right, x_o = parameters("k k_left k_right x_o", units="N/m N/m N/m m")
    spring, predicts = Scene(force=k * x(n), name="spring"), wall("backward_difference")
    two = Scene(force=when(x(n) > x_o, right * (x(n) - x_o), when(x(n) < -x_o, left * (x(n) + x_o), 0)), name="two walls")
    return [
        Choice("wall", "A wall (labs 00 to 03)", wall()(k=300, x_o=0.01), {"k": (50, 1500), "x_o": (0, 0.03), "B": (0, 2)}),
        Choice("spring", "A spring (lab 00)", spring(k=100), {"k": (10, 400)}),
        Choice("half_sample", "A wall that compensates for the hold (lab 11)", predicts(k=300, x_o=0.01), {"k": (50, 3000)}),
        Choice("ellis", "A wall by the law of Ellis (lab 11)", wall("ellis")(k=300, x_o=0.01), {"k": (50, 3000)}),
        Choice(
            "two_walls",
            "Two walls to compare (lab 10)",
            two(k_left=150, k_right=300, x_o=0.01),
            {"k_left": (20, 600), "k_right": (20, 600)},
        ),
    ]


def library():
    """The scenes of the library; which of them a board carries is asked of its costs."""
    return [
        Choice(
            name,
            name.replace("_", " ").capitalize(),
            entry.scene(),
            None,
            _library_options(entry),
            f"{entry.title.rstrip('.')}. ",
        )
        for name, entry in CATALOGUE.items()
    ]


def _library_options(entry):
    small = [entry.uno] if entry.uno else []
    return {board: small if board == "uno" else [entry.options, *small] for board in PERIODS}


def page_data(boards=("uno", "pico"), chosen=None):
    """Return the data of the page: its scenes and words.

    Parameters
    ----------
    boards : sequence of str
        For which programs are compiled.
    chosen : sequence of Choice, optional
    """
    scenes = [scene for choice in (choices() if chosen is None else chosen) if (scene := scene_data(choice, boards))]
    return {"scenes": scenes, "words": {"motor_off": MOTOR_OFF, "press_start": PRESS, "noticed": NOTICED}}


def scene_data(choice, boards):
    """Return a scene with its program for each board that carries it, or None where none does."""
    found = {board: told for board in boards for told in [_on_board(choice, board)] if told}
    if not found:
        return None
    where = " and ".join(BOARDS[board].flashing.called if BOARDS[board].flashing else board for board in found)
    picture = moving_picture(choice.scene)
    return {
        **{"name": choice.name, "title": choice.title, "about": f"{choice.about}It fits {where}.", "boards": found},
        "picture": picture.recording(),
        "touching": recorded_touching(choice.scene, {**choice.scene.watch, **picture.channels}),
    }


def _on_board(choice, board):
    """Return what the page must know of a scene on a board, or None where no options make it fit."""
    for options in choice.options[board]:
        try:
            return _told(choice, board, **options)
        except HapticlabError:  # unstable there, or more than a sample carries
            continue
    return None


def _told(choice, board, *, T, **options):
    """The scene's program as a board takes it; a simulated board tells what the view is to show."""
    with connect("sim://hapkit", T=T) as paddle:
        stage = Stage(paddle, choice.scene, clock=time.monotonic, sliders=choice.sliders, **options)
        program = stage.source.program
        every = decimation(program, paddle.exchange.port, board=board)
        check_margin(program)
        edges = edges_beside(program, board, every)
        if edges == 0 or program.facts.get("port_mass"):  # of which the mass of the real handle decides
            return None
    apart = {"T": T * every, "apart": rows_apart(T * every)}
    shown = about(stage)
    return {
        "T": T,
        "every": every,
        "edges": edges,
        "code": base64.b64encode(encode(program, word_bits=BOARDS[board].word_bits)).decode(),
        "types": ["f32", "f32", *(c.type for c in program.outputs)],
        "watched": [c.name for c in program.outputs[1:]],
        "parameters": parameters_told(program),
        "about": {**shown, **apart, "help": shown["help"] + HELP},
        "record": {"units": program.units, "scene": program.name},
    }


def edges_beside(program, board, every):
    """Return how many edges of an encoder per second a board counts beside a program, of EDGES.

    It is 0 where the program does not fit, and None on a board whose time is not limited.
    """
    if BOARDS[board].hz is None:
        return None
    return max((edges for edges in EDGES if cost(program, board, every=every, edges_per_second=edges).fits), default=0)
