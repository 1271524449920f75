"""One wall, one entry, every law: what each adds to the energy, to the rebound and to the path of a single bounce."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import count, number, what_is
from ...base.drawing import COLD, WARM, house_style, new_figure, plain_log
from ...base.shows_itself import ShowsItself, Tabular
from ...base.telemetry import Telemetry
from ...device.device import total_delay
from ...device.simulated.closed_loop import link, load_linked
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError
from ...rendering.hybrid import hybrid_wall
from ...rendering.wall_laws import LAWS, RENDERING, Rendering, checked_laws, wall_law
from ..records.energy import energy

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from ...base.annotations import PlantEngine

#: samples before the entry, so that laws with a memory know the approach
APPROACH = 4


@dataclass(frozen=True)
class Bounce(ShowsItself):
    """What a law makes of one bounce, over entries at every part of a period.

    Attributes
    ----------
    law : str
    generated, worst : float
        Energy the rendered wall gave beyond what it took [J], with a damper put on for it: the mean of all entries, and the
        most.
    rebound : float
        Speed at leaving, over that of the wall itself: mean of all entries; nan where the handle never left.
    spread : float
        Standard deviation of the rebound over the entries: what the hand feels as a wall that is not the same twice.
    path : float
        Largest distance from the wall's own motion at the samples, root mean square over the entries, over the depth.
    pull : float
        Largest force that pulls [N].
    """

    law: str
    generated: float
    worst: float
    rebound: float
    spread: float
    path: float
    pull: float


@dataclass(frozen=True)
class LawComparison(Tabular):
    """One bounce under every law.

    Attributes
    ----------
    bounces : tuple of Bounce
    K, speed : float
        [N/m], [m/s] at the start.
    incoming : float
        Kinetic energy at the entry into the wall itself [J].
    entries : int
        Phases of the entry within a period.
    paddle : str
    refused : dict of str to str
        Laws that cannot render this wall, and why.
    """

    bounces: tuple[Bounce, ...]
    K: float
    speed: float
    incoming: float
    entries: int
    paddle: str
    refused: dict[str, str]

    def __getitem__(self, law: str) -> Bounce:
        """Return the bounce of a law by name."""
        found = {bounce.law: bounce for bounce in self.bounces}
        if law not in found:
            raise AnalysisError(f"there is no bounce of {law!r}; there are {', '.join(found)}")
        return found[law]

    def __str__(self) -> str:
        head = (
            f"a wall of {self.K:g} N/m entered at {self.speed:g} m/s ({1e3 * self.incoming:.4g} mJ), {self.entries} phases of a "
            f"period\n{'law':<20} {'generated':>10} {'worst':>10} {'rebound':>9} {'spread':>8} {'path':>8} {'pull':>8}"
        )
        rows = [
            f"{b.law:<20} {b.generated / self.incoming:>+10.3%} {b.worst / self.incoming:>+10.3%} {b.rebound:>9.4f} "
            f"{b.spread:>8.4f} {b.path:>8.2%} {b.pull:>6.3g} N"
            for b in self.bounces
        ]
        return "\n".join([head, *rows, *(f"{law:<20} rejected: {why}" for law, why in self.refused.items())])

    def plot(self) -> Figure:
        """Draw, law by law, the energy generated and how far the path is from the wall's own."""
        names = [b.law.replace("_", " ") for b in self.bounces]
        places = np.arange(len(names))
        with house_style():
            figure = new_figure(height=0.6 + 0.42 * len(names), width=8.2)
            left, right = figure.subplots(1, 2, sharey=True)
            shares = np.array([b.generated for b in self.bounces]) / self.incoming
            worst = np.array([b.worst for b in self.bounces]) / self.incoming
            left.barh(places, 100 * shares, color=COLD, height=0.6, label="mean of the entries")
            left.plot(100 * worst, places, "k|", markersize=13, markeredgewidth=2, label="worst entry")
            left.axvline(0, color="black", linewidth=0.8)
            left.set(xlabel="energy generated [% of the incoming energy]", yticks=places, yticklabels=names)
            left.invert_yaxis()
            left.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize="small")
            strays = np.array([100 * max(b.path, 1e-6) for b in self.bounces])  # no foot: a log scale
            right.plot(strays, places, "o", color=WARM)
            plain_log(right, "x")
            right.set(xlabel="deviation from the wall's path [% of depth]", xlim=(strays.min() / 2, 2 * strays.max()))
        return figure


def compare_laws(
    paddle: SimulatedPaddle,
    *,
    K: float,
    speed: float = 0.1,
    laws: str | Iterable[str] = tuple(LAWS),
    entries: int = 16,
    rendering: Rendering = RENDERING,
    engine: PlantEngine = "auto",
) -> LawComparison:
    """Render one wall by every law of the chapter, and compare a single bounce with the wall itself.

    The handle comes in at one speed, at phases of the sampling period spread evenly, for what a law makes of an entry
    depends on when the samples fall. Beside each sampled bounce stands the exact one (:func:`hybrid_wall`) of the same
    start: energy that a law generates, the speed it throws back with, and how far the handle strays.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With what it has of damping, delay, encoder, friction and hand.
    K : float
        [N/m]
    speed : float
        Of the start, four to five of its periods before the boundary [m/s], > 0.
    laws : str or sequence of str
        Of :func:`hapticlab.laws.wall_law`, by name.
    entries : int
        Phases of the entry.
    rendering : Rendering
        ``hl.design.Rendering(model=, unilateral=, clamp=, velocity=)``, the same for every law.
    engine : {"auto", "llvm", "wasm", "interpreter"}
        What runs the simulated paddle.

    Returns
    -------
    LawComparison
        A law that cannot render this wall on this paddle is in ``refused``.

    Raises
    ------
    AnalysisError
        For a law that is none, and a stiffness, speed or number of entries that no bounce has.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3)
    >>> result = hl.design.compare_laws(paddle, K=500, laws=["zoh", "half_sample"], entries=4)
    >>> result["zoh"].rebound > 1.05 > result["half_sample"].rebound
    True
    """
    laws = _checked(paddle, laws, entries)
    K = number("K", K, "N/m", "a wall", above=0)
    speed = number("speed", speed, "m/s", "an entry", above=0, what="a finite speed")
    M = paddle.m + (paddle.hand.m if paddle.hand else 0.0)
    starts = -(APPROACH + (np.arange(entries) + 0.5) / entries) * speed * paddle.T
    ticks = math.ceil(2 * math.pi * math.sqrt(M / K) / paddle.T) + 3 * APPROACH + 2 * math.ceil(total_delay(paddle) / paddle.T)
    exact = [hybrid_wall(paddle, K=K, duration=ticks * paddle.T, x=start, v=speed) for start in starts]
    bounces, refused = [], {}
    for name in laws:
        try:
            law = wall_law(name, paddle, K=K, **rendering.options())
        except AnalysisError as refusal:
            refused[name] = str(refusal)
            continue
        logs = lane_logs(law.scene, law.paddle, starts, speed, ticks, engine)
        added = law.paddle.b - paddle.b
        bounces.append(_bounce(name, [_entry(log, wall, added) for log, wall in zip(logs, exact, strict=True)]))
    incoming = float(np.mean([M * wall.speeds[0] ** 2 / 2 for wall in exact]))
    return LawComparison(tuple(bounces), K, speed, incoming, entries, str(paddle), refused)


def _checked(paddle, laws, entries):
    """Return the names of the laws, or say what no comparison can be made of."""
    if not isinstance(paddle, SimulatedPaddle):
        raise AnalysisError(
            f"compare_laws simulates a bounce under every law; needs a SimulatedPaddle, not {what_is(paddle)}. "
            "hl.SimulatedPaddle.from_profile(...) makes one of a profile or its file"
        )
    count("entries", entries)
    return checked_laws(laws)


def lane_logs(scene, paddle, starts, speed, ticks, engine="auto"):
    """Run a scene from several places at one speed, side by side; return a Telemetry each."""
    program = paddle.program(scene)
    linked = link(program, paddle)
    rows = np.array([(*program.values, *paddle.plant_values(start, speed)) for start in starts]).T
    outputs, _ = load_linked(linked, engine).run(ticks, paddle.inputs(ticks), rows)
    logs = []
    for lane in range(len(starts)):
        columns = {c.name: outputs[:, j, lane] for j, c in enumerate(linked.outputs)}
        own = {name: columns.pop(name) for name in ("x", "v", "F", "fault")}
        if own.pop("fault").any():
            raise AnalysisError(f"{program.name}: a force or state was not finite")
        own |= {"delay": paddle.delay, "sensor_delay": paddle.sensor_delay}
        logs.append(Telemetry(t=np.arange(ticks) * paddle.T, T=paddle.T, channels=columns, **own))
    return logs


def _entry(log, exact, added):
    """Return (generated, rebound, path, pull) of one bounce beside the exact one; ``added`` is a damper put on the paddle."""
    x, v = log.channels.get("x_true", log.x), log.channels.get("v_true", log.v)
    F, part = log.channels.get("F_applied", log.F), log.delay / log.T % 1
    before = np.r_[0.0, F[:-1]] if 1e-9 < part < 1 - 1e-9 else F  # under a fraction of a period the force before acts on
    quiet = (F == 0) & (before == 0) if not added else np.ones(len(F), bool)
    out = np.flatnonzero(quiet & (x < 0) & (v < 0) & (np.arange(len(x)) > np.argmax(x >= 0)))
    leave = np.flatnonzero(exact.speeds < 0)
    through = exact.t[:-1] <= (exact.crossings[leave[0]] if len(leave) else math.inf)
    path = np.abs(x - exact.x[:-1])[through].max() / exact.x.max()
    pull = max(0.0, float(-log.F.min()))
    if not len(out) or not len(leave):
        return math.nan, math.nan, path, pull
    at = out[0]
    eaten = added * np.sum(np.diff(x[: at + 1]) ** 2 / log.T + np.diff(v[: at + 1]) ** 2 * log.T / 12)
    meant = _leaving(exact.model, exact.x[at], exact.v[at])
    if exact.x[at] >= 0 or exact.v[at] >= 0:
        meant = -exact.speeds[leave[0]]
    return -energy(log).W[at] - eaten, _leaving(exact.model, x[at], v[at]) / meant, path, pull


def _leaving(model, x, v):
    """Return the speed at the boundary that hand and push made this of, the same air on the way left out."""
    return math.sqrt(max(v**2 + (model.k * x**2 - 2 * model.push * x) / model.M, 0.0))


def _bounce(name, entries):
    generated, rebound, path, pull = np.array(entries).T
    return Bounce(
        name, float(generated.mean()), float(generated.max()), float(rebound.mean()), float(rebound.std()),
        float(math.sqrt((path**2).mean())), float(pull.max()),
    )  # fmt: skip
