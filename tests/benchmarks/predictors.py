"""Every law of a virtual wall on one bounce, against one push, over real paddles; writes docs/explanation/predictors.md.

    python tests/benchmarks/predictors.py            print the tables (a minute or two)
    python tests/benchmarks/predictors.py --write    and put them, and the figure, into docs/explanation

The page's sentences are written by hand; tables stand between marks and are replaced. A test computes some of them again.
"""

import argparse
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

import hapticlab as hl
from hapticlab.base.drawing import colour_map, house_style, new_figure
from hapticlab.compiler.boards.cost import cost
from hapticlab.rendering.wall_laws import LAWS, wall_law

DOCS = Path(__file__).parents[2] / "docs" / "explanation"
BASE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
#: Gillespie and Cutkosky (1996)
BED = hl.SimulatedPaddle(m=0.35, b=0.0, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
GRIP = hl.Hand(m=0.1, b=5.0, k=500.0)
K, SPEED = 500.0, 0.1

#: name of a column -> (paddle, options of compare_laws)
CONDITIONS = {
    "plain": (BASE, {}),
    "b = 1 N s/m": (replace(BASE, b=1.0), {}),
    "10 times K": (BASE, {"K": 5000.0}),
    "delay T/2": (replace(BASE, delay=5e-4), {}),
    "delay T": (replace(BASE, delay=1e-3), {}),
    "count 10 um": (replace(BASE, counts_per_metre=1e5), {}),
    "count 10 um, model v": (replace(BASE, counts_per_metre=1e5), {"rendering": hl.design.Rendering(velocity="model")}),
    "friction 50 mN": (replace(BASE, coulomb=0.05), {}),
    "clip": (BASE, {"rendering": hl.design.Rendering(unilateral="clip")}),
    "never pulls": (BASE, {"rendering": hl.design.Rendering(clamp=True)}),
    "grip, known": (replace(BASE, hand=GRIP), {}),
    "grip, unknown": (replace(BASE, hand=GRIP), {"rendering": hl.design.Rendering(model=BASE)}),
    "mass 20 % off": (BASE, {"rendering": hl.design.Rendering(model=replace(BASE, m=0.06))}),
}
#: name of a column -> (paddle, options of law_limits)
LIMITS = {
    "plain": (BASE, {}),
    "b = 1 N s/m": (replace(BASE, b=1.0), {}),
    "delay T": (replace(BASE, delay=1e-3), {}),
    "10 um, 20 mN, 10 N": (replace(BASE, counts_per_metre=1e5, coulomb=0.02, force_max=10.0), {}),
    "grip, unknown": (replace(BASE, hand=GRIP), {"rendering": hl.design.Rendering(model=BASE)}),
}

#: stiffnesses [N/m] at which the force that should rest is looked at
SWUNG = (1000, 4000, 10000, 16000, 50000)


def bounce(name, laws=tuple(LAWS), entries=16):
    """Return the comparison of one condition."""
    paddle, options = CONDITIONS[name]
    return hl.design.compare_laws(paddle, laws=laws, entries=entries, **{"K": K, "speed": SPEED, **options})


def limit(name, laws=tuple(LAWS)):
    """Return the limits of one condition."""
    paddle, options = LIMITS[name]
    return hl.design.law_limits(paddle, laws=laws, **options)


def swings(laws=tuple(LAWS), stiffnesses=SWUNG, pushes=9):
    """Return law -> how far the force swings [N] on each wall, of a handle that is pressed and should rest; median of pushes."""
    paddle, found = LIMITS["10 um, 20 mN, 10 N"][0], {}
    for law in laws:
        found[law] = []
        for K in stiffnesses:
            made, last = wall_law(law, paddle, K=K), []
            for push in np.linspace(0.8, 1.2, pushes):
                log = replace(made.paddle, hand=hl.Hand(push=float(push))).run(made.scene, duration=4.0)
                last.append(np.ptp(log.F[log.t > 3.5]))
            found[law].append(float(np.median(last)))
    return found


def swing_table(found, stiffnesses=SWUNG):
    rows = [[law, *(f"{swing:.3g}" for swing in row)] for law, row in found.items()]
    return table(["swing of the force [N]", *(f"{K} N/m" for K in stiffnesses)], rows)


def table(head, rows):
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def percent(share):
    return "never left" if np.isnan(share) else f"{100 * share:+.2f}"


def bounces(results):
    """Return the table of energy generated, law by condition."""
    rows = [[law, *(percent(r[law].generated / r.incoming) for r in results.values())] for law in LAWS]
    return table(["generated [%]", *results], rows)


def scatter(results):
    """Return the table of worst entries."""
    rows = [[law, *(percent(r[law].worst / r.incoming) for r in results.values())] for law in LAWS]
    return table(["worst entry [%]", *results], rows)


def details(result):
    """Return all numbers of one comparison."""
    rows = [
        [b.law, f"{percent(b.generated / result.incoming)}", f"{percent(b.worst / result.incoming)}", f"{b.rebound:.4f}",
         f"{b.spread:.4f}", f"{100 * b.path:.3f}", f"{b.pull:.3g}"]
        for b in result.bounces
    ]  # fmt: skip
    return table(["law", "generated [%]", "worst [%]", "rebound", "spread", "stray [% of depth]", "pull [N]"], rows)


def limits(results):
    rows = [[law, *(f"{r[law].K:.3g}" + ("+" if r[law].beyond == np.inf else "") for r in results.values())] for law in LAWS]
    return table(["stands up to [N/m]", *results], rows)


def costs():
    """Return what each law takes of an Uno at 1 kHz, with an encoder, and a dead-beat wall made for it."""
    paddle = replace(BASE, counts_per_metre=1e5)
    taken = {law: cost(paddle.program(wall_law(law, paddle, K=K).scene)) for law in LAWS}
    slow = replace(paddle, T=2.5e-3)
    rough = hl.laws.deadbeat_wall(slow, K=K, pairs=hl.laws.Pairs(accuracy=0.05, crossings=1, between="half_sample"))
    taken["deadbeat_crossings, accuracy 5 %, 400 Hz"] = cost(slow.program(rough))
    rows = [
        [
            law,
            f"{c.instructions}",
            f"{c.arena}",
            f"{c.typical / 16e3:.2f}",
            f"{1e3 * c.T_needed():.2f}",
            "yes" if c.fits else "no",
        ]
        for law, c in taken.items()
    ]
    return table(["law", "instructions", "bytes of 848", "ms", "needs T >= [ms]", "fits"], rows)


def figure(results):
    """Draw energy generated, law by condition: dark is little."""
    shares = np.array([[100 * abs(r[law].generated) / r.incoming for r in results.values()] for law in LAWS])
    signed = np.array([[100 * r[law].generated / r.incoming for r in results.values()] for law in LAWS])
    with house_style():
        made = new_figure(height=5.2, width=11)
        axes = made.subplots()
        image = axes.imshow(np.log10(np.maximum(shares, 1e-3)), cmap=colour_map("cividis"), aspect="auto", vmin=-3, vmax=2)
        axes.set(xticks=range(len(results)), yticks=range(len(LAWS)), yticklabels=[law.replace("_", " ") for law in LAWS])
        axes.set_xticklabels(list(results), rotation=30, ha="right")
        axes.grid(False)
        for (row, column), value in np.ndenumerate(signed):
            light = shares[row, column] > 1
            axes.text(
                column,
                row,
                f"{value:+.2f}",
                ha="center",
                va="center",
                fontsize=8.5,
                color="black" if light else "white",
            )
        bar = made.colorbar(image, ax=axes, ticks=[-3, -2, -1, 0, 1, 2])
        bar.ax.set_yticklabels(["0.001", "0.01", "0.1", "1", "10", "100"])
        bar.set_label("energy generated, magnitude [%]")
    return made


def tables():
    """Compute every table; return name -> text, and the figure."""
    results = {name: bounce(name) for name in CONDITIONS}
    found = {name: limit(name) for name in LIMITS}
    bed = hl.design.compare_laws(BED, K=5000.0, speed=0.5)
    made = {"plain": details(results["plain"]), "bed": details(bed), "conditions": bounces(results)}
    made |= {"worst": scatter(results), "limits": limits(found), "swings": swing_table(swings()), "costs": costs()}
    return made, figure(results)


def replaced(page, made):
    """Return the page with its tables replaced."""
    for name, text in made.items():
        marks = f"<!-- {name} -->", f"<!-- end {name} -->"
        page, count = re.subn(f"{marks[0]}.*?{marks[1]}", f"{marks[0]}\n{text}\n{marks[1]}", page, flags=re.S)
        assert count == 1, name
    return page


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="put tables and figure into docs/explanation")
    made, drawn = tables()
    for name, text in made.items():
        print(f"{name}\n{text}\n")
    if parser.parse_args().write:
        page = DOCS / "predictors.md"
        page.write_text(replaced(page.read_text("utf-8"), made), "utf-8")
        drawn.savefig(DOCS / "predictors.png", dpi=80)
