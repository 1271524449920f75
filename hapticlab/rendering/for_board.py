"""Which wall of Section 23.4.1 a board has time and memory for, at the paddle's period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..base.shows_itself import ShowsItself
from ..compiler.boards.cost import Board, Cost, cost
from ..compiler.tick.compile_scene import compile
from ..errors import AnalysisError, ProgramLimitError
from ..scene.scene import Scene
from .deadbeat import Pairs, deadbeat_wall
from .digital import digital_wall
from .model import WallModel
from .predictive import predictive_wall

if TYPE_CHECKING:
    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: dearest first: what it is, what makes it, with what
CANDIDATES: tuple[tuple[str, Callable, dict], ...] = (
    ("dead-beat pairs, crossings to 1e-6", deadbeat_wall, {"pairs": Pairs(accuracy=1e-6)}),
    ("dead-beat pairs, crossings to 1 %", deadbeat_wall, {"pairs": Pairs(accuracy=1e-2)}),
    ("dead-beat pairs, crossings to 5 %", deadbeat_wall, {"pairs": Pairs(accuracy=5e-2)}),
    (
        "half a sample, dead-beat pairs at crossings, to 5 %",
        deadbeat_wall,
        {"pairs": Pairs(accuracy=5e-2, crossings=1, between="half_sample")},
    ),
    ("half a sample by the model", predictive_wall, {}),
    ("poles of the wall", digital_wall, {}),
)


@dataclass(frozen=True)
class BoardWall(ShowsItself):
    """The best wall that fits, and what did not.

    Attributes
    ----------
    scene : Scene
    name : str
        Which of the candidates it is.
    cost : Cost
    passed_over : dict of str to str
        Better walls, and why the board cannot run them.
    """

    scene: Scene
    name: str
    cost: Cost
    passed_over: dict[str, str]

    def __str__(self) -> str:
        over = "".join(f"\n  not {name}: {why}" for name, why in self.passed_over.items())
        return f"{self.name}: {self.cost.share:.0%} of {1e3 * self.cost.T:g} ms on {self.cost.board.name}{over}"


def wall_for_board(paddle: SimulatedPaddle, *, K: float, board: str | Board = "uno", **options: Any) -> BoardWall:
    """Return the best model-based wall that a board runs at the paddle's period, and why no better one fits.

    Parameters
    ----------
    paddle : SimulatedPaddle
        The constants of the paddle on the board, its T, and its force limit.
    K : float
        [N/m]
    board : str
        Whose cycles are counted, by name: "uno", "pico" or "cortex-m4f".
    **options
        B, hand, velocity, force_max of :func:`digital_wall`.

    Returns
    -------
    BoardWall

    Raises
    ------
    AnalysisError
        For constants that no wall can have, and a paddle without them, as one on a board is.
    ProgramLimitError
        Where not even the cheapest fits; it names the period that would do.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=2e-3, counts_per_metre=1e5)
    >>> print(hl.laws.wall_for_board(paddle, K=500).name)
    dead-beat pairs, crossings to 5 %
    """
    # what is wrong with the constants is said once, as itself
    WallModel.of(paddle, K=K, **{name: options[name] for name in ("B", "hand") if name in options})
    over = {}
    for name, make, own in CANDIDATES:
        try:
            scene = make(paddle, K=K, **own, **options)
            taken = cost(compile(scene, T=paddle.T, velocity="backward_difference"), board)
        except (AnalysisError, ProgramLimitError) as refusal:
            over[name] = str(refusal)
            continue
        if taken.fits:
            return BoardWall(scene, name, taken, over)
        over[name] = taken.memory_problem or f"needs T >= {1e3 * taken.T_needed():.3g} ms"
    raise ProgramLimitError(
        f"no model-based wall of {K:g} N/m fits {board} at T = {1e3 * paddle.T:g} ms; "
        + "; ".join(f"{name}: {why}" for name, why in over.items())
    )
