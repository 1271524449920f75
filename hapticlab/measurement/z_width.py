"""Z-width: the borders of stiffness over virtual damping that a paddle renders, measured, beside what theory promises."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import number
from ..base.grid import Grid
from ..base.shows_itself import Tabular
from ..errors import AnalysisError
from ..scene.scene import Scene
from .largest_stiffness import SEARCH, LargestStiffness, largest_stiffness
from .search_plot import plot_border

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..base.annotations import Array
    from ..device.board.serial_paddle import SerialPaddle
    from ..device.simulated.simulated_paddle import SimulatedPaddle
    from ..scene.laws.taps import LawName
    from .search import Search

#: part of the last damping's border at which the search for the next one begins
BELOW = 5.0


@dataclass(frozen=True, eq=False)
class ZWidth(Tabular):
    """The K-B borders of a law on a paddle.

    Attributes
    ----------
    B : array, shape (N,)
        Virtual damping [N s/m].
    K : array, shape (N,)
        The largest stiffness that both borders allow, from every start [N/m]; 0 where all failed, nan where undecided.
    unstable, buzz : array, shape (N, 2)
        Up to which stiffness walls come to rest, and up to which no buzz is felt [N/m]: lowest and highest over the
        starts.
    passivity, stability : array, shape (N,)
        What theory promises at each B [N/m]; nan where it does not know the paddle or the law.
    searches : tuple of LargestStiffness
        With every trial.
    law : str

    Notes
    -----
    Colgate and Brown (1994) call the range of impedances that a device renders passively its Z-width. Measured here is
    what comes to rest, and quietly, from the starts of the searches.
    """

    B: Array
    K: Array
    unstable: Array
    buzz: Array
    passivity: Array
    stability: Array
    searches: tuple[LargestStiffness, ...]
    law: str

    def plot(self) -> Figure:
        """Draw both borders with passivity and exact stability."""
        return plot_border(self)

    _hidden = ("searches",)

    def _tables(self):
        columns = {"B": self.B, "K": self.K}
        for name in ("unstable", "buzz"):
            lowest, highest = getattr(self, name).T
            columns |= {f"{name}, lowest": lowest, f"{name}, highest": highest}
        columns |= {"passivity": self.passivity, "stability": self.stability}
        yield "", Grid(columns, dict.fromkeys(columns, "N/m") | {"B": "N s/m"})

    def __str__(self) -> str:
        about = next((s.about for s in self.searches if s.trials), "no trial made")
        ends = [("comes to rest", self.unstable), ("no buzz felt", self.buzz)]
        borders = [[f"{low:.5g} to {high:.5g}" for low, high in border] for _, border in ends]
        rows = [f"{b:10.4g} {k:10.5g} {rest:>20} {quiet:>20} {p:10.5g} {s:10.5g}" for b, k, rest, quiet, p, s in zip(
            self.B, self.K, *borders, self.passivity, self.stability, strict=True)]  # fmt: skip
        head = f"{'B [N s/m]':>10} {'K':>10} {ends[0][0]:>20} {ends[1][0]:>20} {'passivity':>10} {'stability':>10}  K in N/m"
        return "\n".join([f"Z-width, law {self.law}: {about}", head, *rows])

    def __repr__(self) -> str:
        least, most = np.nanmin([*self.K, np.inf]), np.nanmax([*self.K, 0.0])
        return f"ZWidth({self.law}, {len(self.B)} dampings, K = {least:.4g} to {most:.4g} N/m)"


def z_width(
    paddle: SimulatedPaddle | SerialPaddle,
    law: LawName | Scene = "zoh",
    *,
    B: ArrayLike,
    search: Search = SEARCH,
    **options: Any,
) -> ZWidth:
    """Measure the K-B borders of a wall on a paddle, by a search for the largest stiffness at each virtual damping.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    law : str or Scene
        As :func:`hapticlab.measure.largest_stiffness` takes it.
    B : number or text, or sequence of them
        Virtual damping [N s/m], of either sign.
    search : Search
        As :func:`hapticlab.measure.largest_stiffness` takes it; where it says no ``first``, the search at each next
        damping begins well below the border at the last.
    **options
        Of :func:`hapticlab.measure.largest_stiffness`: starts, place, judged.

    Returns
    -------
    ZWidth

    Raises
    ------
    AnalysisError, PaddleError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle, coarse = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), hl.measure.Search(tolerance=0.1)
    >>> found = hl.measure.z_width(paddle, B=[0.0, 1.0], search=coarse, judged=hl.measure.Judgement(longest=2))
    >>> bool(found.K[1] > 5 * found.K[0]), found.passivity.tolist()
    (True, [200.0, 0.0])
    """
    B = np.array([number("B", b, "N*s/m", "a virtual damper") for b in np.ravel(np.asarray(B, object))])
    if not B.size:
        raise AnalysisError("B = []; needs one or more dampings [N s/m], as in B=[0, 0.5, 1]")
    searches: list[LargestStiffness] = []
    for b in B.tolist():
        begin = search
        if searches and searches[-1].K > 0 and search.first is None:  # the next damping's border is near: begin well below
            begin = replace(search, first=searches[-1].K / BELOW)
        searches.append(largest_stiffness(paddle, law, B=b, search=begin, **options))

    def column(name):
        return np.array([s.theory[name].K if name in s.theory else np.nan for s in searches])

    def ends(border):
        return np.array([(border(s).lowest, border(s).highest) for s in searches])

    K, unstable, buzz = np.array([s.K for s in searches]), ends(lambda s: s.unstable), ends(lambda s: s.buzz)
    name = law.name if isinstance(law, Scene) else law
    return ZWidth(B, K, unstable, buzz, column("passivity"), column("stability"), tuple(searches), name)
