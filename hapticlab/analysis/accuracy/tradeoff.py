"""Speed against accuracy: every way to compute a scene on every target, measured, and the cheapest that is good enough."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING, Any

from ...base.arguments import instance
from ...base.shows_itself import Tabular
from ...compiler.boards.cost import BOARDS
from ...compiler.ir.options import choice, steps
from ...compiler.methods.method_table import METHODS
from ...device.progress import progress_bar
from ...errors import AnalysisError
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from ..sweeps.forked_workers import shared_out
from .handle_motions import HandleMotion, handle_motions
from .reference import references
from .tradeoff_asked import CONDITIONS, TRIED, Conditions, Tried, several
from .tradeoff_choice import MARGIN, Asked, chosen
from .tradeoff_rows import LEGEND, OK, Row, Table, rows_of
from .tradeoff_search import all_tried
from .tradeoff_sentences import explained
from .tradeoff_setup import Bench
from .tradeoff_trials import Setting, sensor_floor
from .work_precision import front, plot_work_precision

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from ...base.profile.paddle_profile import PaddleProfile
    from ...device.simulated.simulated_paddle import SimulatedPaddle
    from .tradeoff_choice import Configuration, NotFeasible

#: the target that is no board: this computer
PC = "pc"
#: methods that "auto" leaves out: one that fails, and one of the order and the cost of another
LEFT_OUT = ("euler", "midpoint")
#: the held force is compared at so many places of the shortest period, at least
PLACES = 4
#: shortest step between two values of the reference [s]
SHORTEST = 1e-5


def tradeoff(
    scene: Scene,
    paddle: SimulatedPaddle | PaddleProfile,
    *,
    tried: Tried = TRIED,
    targets: str | Iterable[str] = (PC, "uno", "pico", "cortex-m4f"),
    conditions: Conditions = CONDITIONS,
    tolerance: float = 1e-2,
    workers: int | Callable[..., Iterable[Any]] | None = None,
    progress: bool = True,
) -> Tradeoff:
    """Measure speed against accuracy of a scene: error of the force, cost, stability and passivity of every setting.

    The handle is led along motions; the force of each compiled setting is compared with a reference that two
    independent solvers agree on, and with what the paddle's encoder alone makes of it. On boards cost is predicted, as
    ``paddle.cost(scene)`` of a paddle on a board does; here it is timed, where a setting can be the least, and estimated
    elsewhere.

    A setting is left out where a cheaper method or fewer substeps already have the error of the hold itself, and float64
    where rounding is no part of the error: ``status`` says "not tried", and ``why``.

    Parameters
    ----------
    scene : Scene
        Every parameter bound. It must have a meaning between the samples.
    paddle : SimulatedPaddle or PaddleProfile
        Its damping b [N s/m] and its encoder.
    tried : Tried
        The settings: ``hl.methods.Tried(methods=, T=, substeps=, holds=, force_at=, precision=)``.
    targets : one or a sequence of {"pc", "uno", "pico", "cortex-m4f"}
    conditions : Conditions
        The same for every setting: ``hl.methods.Conditions(motions=, velocity=, live=, every=)``.
    tolerance : float
        Part of the greatest force, for the printed choice and the plot.
    workers : int or callable, optional
        Processes, 2 where they can be copied; or what maps, as ``map`` does.
    progress : bool
        Show a bar when it lasts longer than two seconds.

    Returns
    -------
    Tradeoff

    Raises
    ------
    AnalysisError, SceneError, ProgramError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3)
    >>> found = hl.methods.tradeoff(hl.library.detents(), paddle, tried=hl.methods.Tried(T=[1e-3]), targets=["uno"], workers=1)
    >>> print(found.table[0].status, found.choose().row.T)
    ok 0.001
    """
    _check(scene, paddle)
    Asked(tolerance, load=1.0, passive=True)  # refuses a tolerance that is none
    T, here = several(tried.T), several(targets)
    for name in here:
        choice("target", name, (PC, *(board for board in BOARDS if BOARDS[board].hz)))
    boards = tuple(name for name in here if name != PC)
    settings = _settings(scene, tried)
    led = _motions(conditions.motions, scene, paddle, T)
    with shared_out((scene, _step(T)), workers) as share:
        halves = list(share(_references, [led[::2], led[1::2]]))
    bench = Bench(scene, paddle, tuple(itertools.chain(*halves)), boards, conditions.every, conditions.velocity, conditions.live)
    with progress_bar(len(settings), progress, "setting") as shown, shared_out(bench, workers) as share:
        trials = all_tried(settings, share, shown.update, paddle.b)
        keys = list(dict.fromkeys((s.T, s.hold) for s in settings))
        floors = dict(zip(keys, share(sensor_floor, keys), strict=True))
    return Tradeoff(scene.name, Table(rows_of(bench, trials, floors, here)), here, tolerance, bench)


def _check(scene, paddle):
    """Refuse what is no scene with all its values, or no paddle."""
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "write hl.methods.tradeoff(hl.Scene(force=...), paddle)"))
    unbound = [str(name) for name in scene.parameters if name not in scene.values]
    if unbound:
        given, command = ", ".join(f"{name}=..." for name in unbound), " ".join(f"--set {name}=..." for name in unbound)
        raise AnalysisError(
            f"{scene.name}: no value for {', '.join(unbound)}; bind them: scene({given}), on the command line {command}"
        )
    if not isinstance(getattr(paddle, "b", None), Real):
        raise AnalysisError(
            f"paddle = {paddle!r}; needs a SimulatedPaddle or a PaddleProfile, such as hl.library.nominal or "
            "hl.devices.profile('bench7.json')"
        )


def _motions(given, scene, paddle, T):
    """Return the motions, or refuse what are none, and those that end before the first period."""
    motions = several(handle_motions(scene, paddle) if given is None else given)
    wrong = [one for one in motions if not isinstance(one, HandleMotion)]
    if wrong or not motions:
        raise AnalysisError(f"motions = {given!r}; needs one HandleMotion(name, x, duration) or several")
    short = next((one for one in motions if one.duration < 2 * max(T)), None)
    if short:
        raise AnalysisError(f"{short.name} lasts {short.duration:g} s; needs at least two periods, {2 * max(T):g} s")
    return motions


def _references(common, motions):
    scene, step = common
    return references(scene, motions, step=step) if motions else []


def _settings(scene, tried):
    """Return every setting; of a scene without motion, one for each T."""
    methods, holds, substeps = tried.methods, tried.holds, sorted(map(steps, tried.substeps))
    if methods == "auto":
        methods = (*(name for name in METHODS if name not in LEFT_OUT), "exact", "taylor")
    if not scene.coordinates:  # a force of the samples alone: there is nothing to integrate or to hold
        methods, substeps, holds = ["rk4"], [1], ["soh"]
    return [Setting(*one) for one in itertools.product(methods, tried.T, substeps, holds, tried.force_at, tried.precision)]


def _step(T):
    """Return the step of the reference [s]: every period is a whole number of it, the shortest of PLACES at least."""
    ns = [round(one * 1e9) for one in T]
    common = math.gcd(*ns)
    common //= next((k for k in range(1, common + 1) if common % k == 0 and common // k <= min(ns) / PLACES), 1)
    if common < SHORTEST * 1e9:
        raise AnalysisError(
            f"T = {', '.join(f'{one:g}' for one in T)} s have no common divisor of {SHORTEST:g} s or more; use multiples of "
            "one such step"
        )
    return common * 1e-9


@dataclass(frozen=True, eq=False)
class Tradeoff(Tabular):
    """What :func:`tradeoff` found; printing it shows for each target what none beats, and the choice.

    Attributes
    ----------
    name : str
        Of the scene.
    table : Table of Row
        Every setting on every target, failed ones with their reason; ``print(found.table)`` shows them.
    targets : tuple of str
    tolerance : float
    bench : Bench
        The motions with their references, ``bench.runs``, and the greatest force, ``bench.peak`` [N].
    """

    name: str
    table: Table
    targets: tuple[str, ...]
    tolerance: float
    bench: Bench

    def front(self, target: str) -> Table:
        """Return the rows of a target that none beats in both load and error, cheapest first."""
        choice("target", target, self.targets)
        return Table(front(row for row in self.table if row.target == target and row.status == OK))

    def choose(
        self,
        *,
        tolerance: float | None = None,
        load: float = 0.5,
        passive: bool = True,
        target: str | None = None,
        margin: float = MARGIN,
        held: float | None = None,
    ) -> Configuration | NotFeasible:
        """Return the Configuration of least load that is good enough, or NotFeasible, which says what to relax.

        Parameters
        ----------
        tolerance : float, optional
            Part of the greatest force. Never less than half of what the encoder alone makes.
        load : float
            Part of the period that may be taken.
        passive : bool
            The paddle's damping is enough for every passive hand.
        target : str, optional
            The first unless given.
        margin : float
            Longest stable step over the step used.
        held : float, optional
            Most error of the force held over each period, part of the greatest force; any unless given.
        """
        target = choice("target", self.targets[0] if target is None else target, self.targets)
        return chosen(self.table, target, self._asked(tolerance, load, passive, margin, held), self.bench.options)

    def measured(self, row: Row, cycles: float) -> Tradeoff:
        """Return the trade-off with what a tick of one row's program took on its board [cycles], beside what was predicted."""
        if row.cycles is None or not any(one is row for one in self.table):
            raise AnalysisError(
                f"{row.name} on {row.target} is not a row of this trade-off that a board runs; give one of .table"
            )
        hz = BOARDS[row.target].hz
        assert hz is not None  # a row with cycles is of a board with a clock
        load = row.load + (cycles - (row.measured or row.cycles)) / (hz * row.T)
        new = replace(row, measured=float(cycles), seconds=cycles / hz, load=load)
        return replace(self, table=Table(new if one is row else one for one in self.table))

    def explain(self, row: Row) -> str:
        """The row in sentences."""
        instance("row", row, Row, "a row, such as found.explain(found.table[0]) or found.front('pc')[0]")
        return explained(row, self.table, self.bench.every)

    def plot(self, *targets: str, tolerance: float | None = None, load: float = 0.5, passive: bool = True) -> Figure:
        """Draw error against load, a line for each method; see ``plot_work_precision``."""
        for target in targets:
            choice("target", target, self.targets)
        return plot_work_precision(self, targets or self.targets, self._asked(tolerance, load, passive, MARGIN))

    def _asked(self, tolerance, load, passive, margin, held=None):
        return Asked(self.tolerance if tolerance is None else tolerance, load, passive, margin, held)

    def summary(self, **asked: Any) -> str:
        """Return for each target what none beats, and the choice, as text."""
        counts = Counter(row.status.name for row in self.table)
        lines = [
            f"{self.name}: {len(self.table)} rows ({', '.join(f'{count} {status}' for status, count in counts.items())})",
            f"greatest force {self.bench.peak:.3g} N; {self.bench.certainty}",
            *(f"  {known}" for known in self.bench.runs),
            *(f"  {note}" for note in self.bench.notes),
            *LEGEND,
        ]
        for target in self.targets:
            lines += [
                "",
                f"{target}: rows that no other row beats",
                self.front(target).brief(),
                str(self.choose(target=target, **asked)),
            ]
        return "\n".join(lines)

    _hidden = ("bench",)

    def _tables(self):
        yield from self.table._tables()

    def __str__(self) -> str:
        return self.summary()
