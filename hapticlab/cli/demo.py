"""The demonstration: where a virtual wall begins to chatter, and a student's own equation of motion, on one paddle."""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..analysis.sweeps.sweep import Sweep, sweep
from ..base.drawing import HATCHED, STYLES, house_style, new_figure
from ..compiler.engines.engine import load
from ..device.hand.hand import Hand
from ..device.profiles import profile
from ..device.progress import progress_bar
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..limits.limit import Limit
from ..limits.passivity import passivity_limit
from ..limits.stability import stability_limit
from ..scene.laws.chapter_laws import wall
from .scene_file import SceneFile, describe, load_scene, report_of, run_scene

EXAMPLE = Path(__file__).parents[1] / "examples" / "mass_on_coupler.py"
PUSH = 2.0
#: about what a one-axis paddle can move to one side [m]
TRAVEL = 0.05
STOPS = f"above {1e3 * TRAVEL:g} mm a real handle would hit its stops; the simulation has none"
#: illustrative hands, measured on nobody: one that only pushes, one that also holds (mass, damping, stiffness of a pinch)
HANDS = {
    "push alone": Hand(push=PUSH),
    "holding fingers": Hand(m=0.02, b=1.0, k=200.0, push=PUSH),
}


@dataclass(frozen=True)
class Felt:
    """One hand at the wall: its exact limit, and what simulation shows over the grid of stiffnesses."""

    hand: str
    paddle: SimulatedPaddle
    limit: Limit
    grid: Sweep

    @property
    def bracket(self):
        """The last quiet and the first chattering stiffness [N/m]; None where the grid does not hold the beginning."""
        k, amplitude = self.grid.axes["k"], self.grid.values
        first = int(np.argmax(amplitude > 0))
        quiet = np.flatnonzero(amplitude[:first] == 0)  # nan is neither: that run could not tell
        return (float(k[quiet[-1]]), float(k[first])) if len(quiet) else None

    def lies_within(self, steps):
        """Tell whether the exact limit lies in the bracket, or at most so many steps of the geometric grid outside it."""
        k, found = self.grid.axes["k"], self.bracket
        margin = (k[1] / k[0]) ** steps
        return found is not None and bool(found[0] / margin <= self.limit.K <= found[1] * margin)


@dataclass(frozen=True)
class Study:
    """Everything the demonstration computed."""

    passive: Limit
    felt: tuple[Felt, ...]
    walls: dict[float, tuple]
    own: SceneFile
    own_run: tuple
    seconds: float


def study(*, quick=False, progress=True):
    """Run the demonstration; quick takes fewer stiffnesses and shorter runs. One progress bar covers all of it."""
    start = time.perf_counter()
    points, duration = (60, 8.0) if quick else (160, 40.0)
    constants = profile("eth")
    passive = passivity_limit(constants)
    paddles = {name: SimulatedPaddle.from_profile(constants, hand=hand) for name, hand in HANDS.items()}
    limits = {name: stability_limit(paddle) for name, paddle in paddles.items()}
    stiffnesses = np.geomspace(passive.K / 2, 2 * max(limit.K for limit in limits.values()), points)
    pushed = paddles["push alone"]
    files = {k: SceneFile(wall()(k=k), pushed, min(duration, 20.0)) for k in (passive.K / 2, 2 * passive.K)}
    own = load_scene(EXAMPLE)
    runs = [*files.values(), own]
    # all points of a sweep advance together, so that ticks alone tell how much is done
    ticks = sum(paddle.ticks(duration) for paddle in paddles.values()) + sum(f.paddle.ticks(f.duration) for f in runs)
    with progress_bar(ticks, progress) as shown:

        def swept(paddle):
            grid = sweep(wall(), paddle, duration=duration, k=stiffnesses, progress=False)
            shown.update(paddle.ticks(duration))
            return grid

        def ran(file):
            run = run_scene(file, progress=False)
            shown.update(file.paddle.ticks(file.duration))
            return run

        felt = tuple(Felt(name, paddle, limits[name], swept(paddle)) for name, paddle in paddles.items())
        walls = {k: ran(file) for k, file in files.items()}
        own_run = ran(own)
    return Study(passive, felt, walls, own, own_run, time.perf_counter() - start)


def report(found):
    """Return the study's numbers as a dictionary for JSON.

    A number's name ends in its unit, as in :func:`hapticlab.cli.scene_file.report_of`; a count has none.
    """
    constants = found.felt[0].paddle.profile
    grid = found.felt[0].grid
    below = sum(np.count_nonzero(f.grid.values[grid.axes["k"] < found.passive.K] > 0) for f in found.felt)
    return {
        "profile": {
            "name": constants.name, "m_kg": constants.m, "b_N_s_per_m": constants.b, "T_s": constants.T,
            "nominal": constants.nominal, "source": constants.source,
        },
        "passivity": {"K_N_per_m": found.passive.K, "equation": "23.10", "kind": found.passive.kind},
        "hands": [
            {
                "name": f.hand,
                "hand": {
                    "m_kg": f.paddle.hand.m, "b_N_s_per_m": f.paddle.hand.b,
                    "k_N_per_m": f.paddle.hand.k, "push_N": f.paddle.hand.push,
                },
                "words": str(f.paddle.hand),
                "stability_K_N_per_m": f.limit.K,
                "stability_frequency_Hz": f.limit.frequency,
                "kind": f.limit.kind,
                "chatter_begins_between_N_per_m": f.bracket,
                "inside_bracket": f.lies_within(0),
                "within_one_grid_step": f.lies_within(1),
            }
            for f in found.felt
        ],
        "chatters_below_passivity_limit": bool(below),
        "sweep": {
            "points": len(grid.axes["k"]), "duration_s": grid.duration,
            "largest_amplitude_m": max(float(np.nanmax(f.grid.values)) for f in found.felt),
        },
        "walls": [report_of(*run) for run in found.walls.values()],
        "own_scene": report_of(*found.own_run),
        "engine": load(found.own_run[0]).name,
        "elapsed_s": round(found.seconds, 3),
    }  # fmt: skip


def words(facts):
    """Return a report in words."""
    paddle, own = facts["profile"], facts["own_scene"]
    standing = "nominal: published constants, not measured on this device" if paddle["nominal"] else "measured"
    lines = [
        f"paddle   {paddle['name']}: m = {paddle['m_kg']:g} kg, b = {paddle['b_N_s_per_m']:g} N s/m, T = {paddle['T_s']:g} s, "
        "simulated",
        f"         {standing}",
        "",
        "1. A virtual wall, F = k x(n) where x(n) >= 0, Eq. (23.1): from which stiffness does it chatter?",
        f"  passivity, Eq. (23.10), k < 2 b/T: {facts['passivity']['K_N_per_m']:.4g} N/m, sufficient for any passive hand",
    ]
    for hand in facts["hands"]:
        lines += _hand_words(hand)
    below = "chatter was seen below" if facts["chatters_below_passivity_limit"] else "no simulated wall chattered below"
    swept = facts["sweep"]
    lines += [f"  {below} the passivity limit ({swept['points']} stiffnesses, {swept['duration_s']:g} s each, both hands)"]
    largest = swept["largest_amplitude_m"]
    lines += [f"  the largest oscillation is {1e3 * largest:.3g} mm; {STOPS}"] * (largest > TRAVEL) + [""]
    for run in facts["walls"]:
        lines += [f"  k = {run['parameters']['k']:.4g} N/m, push alone: {run['chatter']['words']}"]
        lines += [f"    {run['energy']['words']}"]
    lines += ["", "2. An equation of motion of your own (examples/mass_on_coupler.py)"]
    lines += ["  " + line for line in describe(own).splitlines()]
    return "\n".join([*lines, "", f"computed in {facts['elapsed_s']:.2f} s (engine: {facts['engine']})"])


def _hand_words(hand):
    bracket = hand["chatter_begins_between_N_per_m"]
    seen = "chatter begins between {:.4g} and {:.4g} N/m".format(*bracket) if bracket else "chatter does not begin in the grid"
    verdict = "NOT where the exact limit is"
    if hand["within_one_grid_step"]:
        verdict = "the exact limit is at most one grid step outside this bracket"
    if hand["inside_bracket"]:
        verdict = "the exact limit is inside this bracket"
    return [
        f"  {hand['name']} ({hand['words']})",
        f"    exact linear limit of this hand and paddle: {hand['stability_K_N_per_m']:.6g} N/m at "
        f"{hand['stability_frequency_Hz']:.4g} Hz",
        f"    simulated: {seen}; {verdict}",
    ]


def draw(found):
    """Return the study's figure: chatter over stiffness with both limits, two walls in time, the student's scene."""
    with house_style():
        figure = new_figure(height=8.0, width=10.5)
        top, left, right = figure.subplot_mosaic([["onset", "onset"], ["walls", "own"]]).values()
        _draw_onset(top, found)
        _draw_walls(left, found)
        _draw_own(right, found)
    return figure


def _draw_onset(axes, found):
    grid, K = found.felt[0].grid, found.passive.K
    axes.axvline(K, color="black", linestyle=":", linewidth=4, label=f"Eq. (23.10), any passive hand: {K:.4g} N/m")
    for f, style in zip(found.felt, (STYLES[1], STYLES[2]), strict=True):
        amplitude = np.where(f.grid.values > 0, 1e3 * f.grid.values, np.nan)
        axes.axvline(f.limit.K, color=style["color"], linestyle="--", label=f"exact limit, {f.hand}: {f.limit.K:.4g} N/m")
        axes.plot(grid.axes["k"], amplitude, marker=".", color=style["color"], label=f"simulated chatter, {f.hand}")
    axes.set(xscale="log", yscale="log", xlim=(grid.axes["k"][0], grid.axes["k"][-1]))
    axes.set(xlabel="wall stiffness k [N/m]", ylabel=f"amplitude [mm] after {grid.duration:g} s")
    largest = max(np.nanmax(f.grid.values) for f in found.felt)
    if largest > TRAVEL:
        axes.axhspan(1e3 * TRAVEL, 2e3 * largest, label=STOPS, **HATCHED)
        axes.set_ylim(top=2e3 * largest)
    axes.set_title("Where the wall of Eq. (23.1) begins to chatter (no point: no chatter)")
    axes.legend(loc="lower left", bbox_to_anchor=(0.22, 0.02), fontsize="small")


def _draw_walls(axes, found):
    for (k, (_, log)), style in zip(found.walls.items(), (STYLES[0], STYLES[1]), strict=True):
        axes.plot(log.t, 1e3 * log.x, color=style["color"], linewidth=0.8, label=f"k = {k:.4g} N/m")
    axes.axhline(0, color="grey", linewidth=1.5, label="boundary; the wall is above")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.35 * (high - low))
    axes.set(xlabel="time t [s]", ylabel="handle position x [mm]", title="The wall under a push alone")
    axes.legend(loc="upper right", fontsize="small")


def _draw_own(axes, found):
    _, log = found.own_run
    for name, label, style in (("x", "handle x", STYLES[0]), ("z", "mass z", STYLES[1])):
        axes.plot(log.t, 1e3 * getattr(log, name), label=label, **style)
    stop = 1e3 * log.parameters["z_o"]
    axes.axhline(stop, color="grey", linewidth=1.5, label=f"the mass meets its wall, {stop:.3g} mm")
    axes.set(xlabel="time t [s]", ylabel="position [mm]", title="A mass on a coupler, from its equation of motion")
    axes.set_xlim(0, min(1.0, log.t[-1]))
    axes.legend(loc="lower right", fontsize="small")


def write(found, folder):
    """Write figure and telemetry; return name -> path."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    figure = folder / "demo.png"
    draw(found).savefig(figure)
    stiff = max(found.walls)
    return {
        "figure": figure,
        "wall_telemetry": found.walls[stiff][1].to_csv(folder / "wall.csv"),
        "own_scene_telemetry": found.own_run[1].to_csv(folder / "mass_on_coupler.csv"),
    }
