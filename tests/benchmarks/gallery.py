"""Pictures of every scene as the live view draws it, at rest and pressed, in the browser's own code: ``docs/images/gallery``.

``python tests/benchmarks/gallery.py docs/images/gallery`` writes light.png and dark.png; ``--each FOLDER`` also writes every
picture in full size. It prints how long the browser takes for one, and how many bytes a frame of it has.
"""

import argparse
import io
import json
import sys
from pathlib import Path

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.widgets.browser_view import BROWSER, SCRIPTS, take_apart
from hapticlab.widgets.picture import moving_picture

sys.path.insert(0, str(Path(__file__).parents[1] / "browser"))
from lab import browsing

#: of one picture, and of its place on the sheet [px]
WIDE, HIGH, SHEET = 840, 220, 480
THEMES = {
    "light": {"dark": False, "ink": "#000", "paper": "rgb(255,255,255)", "quiet": "#595959", "grid": "#d9d9d9"},
    "dark": {"dark": True, "ink": "#eee", "paper": "rgb(17,17,17)", "quiet": "#a6a6a6", "grid": "#3a3a3a"},
}
DRAW = """([shape, points, about, theme, state, wide, high, times]) => {
    const canvas = document.querySelector("canvas")
    document.body.style.background = theme.paper
    const picture = new parts.Picture(canvas, about)
    picture.resize(wide, high)
    picture.draw(shape, new Float32Array(points), theme, state)
    const placed = picture.labels.placed.map((one) => ({ ...one })), waiting = picture.labels.waiting.length
    const began = performance.now()
    for (let k = 0; k < times; k++) picture.draw(shape, new Float32Array(points), theme, state)
    canvas.getContext("2d").getImageData(0, 0, 1, 1)
    const took = (performance.now() - began) / Math.max(times, 1)
    return { placed, waiting, scale: picture.scale, left: picture.left, base: picture.base, took }
}"""


def own_scenes():
    """Scenes as students write them, by what they are."""
    z, y = hl.coordinate("z", unit="m", initial=x(n)), hl.coordinate("y", unit="m", initial=0.03)
    theta = hl.coordinate("theta", unit="rad", initial=0.3)
    M, m, l, g = hl.parameters("M m l g", units="kg kg m m/s^2", values=(0.05, 0.1, 0.15, 9.81))
    K, b_c, k_b = hl.parameters("K b_c k_b", units="N/m N*s/m N/m", values=(200, 0.1, 300))
    k_left, k_right = hl.parameters("k_left k_right", units="N/m N/m", values=(100, 200))
    x_o = hl.parameters("x_o", units="m", values=0.01)
    A, p, k_3 = hl.parameters("A p k_3", units="N m N/m^3", values=(0.6, 0.012, 5e4))
    F_c = K * (x(t) - z) + b_c * (v(t) - z.diff(t))
    bob = m * ((z + l * sp.sin(theta)).diff(t) ** 2 + (l * sp.cos(theta)).diff(t) ** 2) / 2
    swing = hl.mechanics.lagrange(M * z.diff(t) ** 2 / 2 + bob + m * g * l * sp.cos(theta), forces={z: F_c})
    touch = hl.contact.Contact(y - x(t), hl.contact.penalty(k=k_b), name="touch")
    flight = hl.mechanics.lagrange(m * y.diff(t) ** 2 / 2 - m * g * y, contacts=[touch])
    both = hl.when(x(n) >= x_o, k_right * (x(n) - x_o)) + hl.when(x(n) <= -x_o, k_left * (x(n) + x_o))
    return {
        "a wall": hl.wall()(k=300, x_o="10 mm"),
        "a wall on the left": hl.Scene(force=hl.when(x(n) <= -x_o, k_left * (x(n) + x_o))),
        "two walls": hl.Scene(force=both),
        "a spring and a damper": hl.Scene(force=k_left * x(n) + b_c * v(n)),
        "a mass of one's own": hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)], watch=[z]),
        "a pendulum of one's own": hl.Scene(force=F_c, eom=[swing], watch=[z, theta]),
        "detents of one's own": hl.Scene(force=A * sp.sin(2 * sp.pi * x(n) / p)),
        "a cubic spring": hl.Scene(force=k_3 * x(n) ** 3),
        "a ball on the handle": hl.Scene(force=touch.felt, eom=[flight], watch=[y]),
    }


def scenes():
    """All scenes of the gallery by name."""
    return {**own_scenes(), **{name: entry.scene() for name, entry in hl.library.catalogue.items()}}


def moments(scene, seconds=0.32):
    """Return the picture of a scene, and what is known of it at rest and when a hand has pressed for a while."""
    picture = moving_picture(scene)
    to = 0.6 * picture.reach[1]
    far = -to if "wall on the left" in scene.name or (scene.force.atoms(sp.Le) and not scene.force.atoms(sp.Ge)) else to
    hand = hl.Hand(m=0.02, b=1, k=150, intent=lambda time: far * np.clip(time / 0.2, 0, 1))
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hand)
    watched = hl.Scene(
        **{**{f: getattr(scene, f) for f in ("force", "eom", "name")}, "watch": {**scene.watch, **picture.channels}}
    )
    log = paddle.run(watched(**dict(scene.values)), duration=seconds, progress=False)
    for k in (0, len(log.x) - 1):
        known = {name: float(getattr(log, name)[k]) for name in picture.channels}
        yield picture, {**dict(scene.values), **known, "x": float(log.x[k]), "F": float(log.F[k]), "intent": far if k else 0.0}


def browser_page(browser):
    """A page with one canvas and the parts of the live view that draw."""
    source = "\n".join((BROWSER / script).read_text("utf-8") for script in SCRIPTS).replace("export default { render }", "")
    page = browser.new_page(viewport={"width": WIDE, "height": HIGH})
    page.set_content(f'<body style="margin:0"><canvas style="display:block;width:{WIDE}px"></canvas></body>')
    page.add_script_tag(content=f"(() => {{ {source}\n window.parts = {{ Picture }} }})()")
    return page


def draw(page, picture, values, theme="light", wide=WIDE, high=HIGH, times=0):
    """Draw one moment; return what the browser tells of it."""
    shape, points = take_apart(picture.draw(values))
    about = {"box": list(picture.box), "along": list(picture.along)}
    state = {"F": values["F"], "x": values["x"], "intent": values["intent"], "contact": True, "running": True}
    told = page.evaluate(DRAW, [shape, points.ravel().tolist(), about, THEMES[theme], state, wide, high, times])
    return {**told, "bytes": points.nbytes, "shape": len(json.dumps(shape))}


def main():
    from PIL import Image, ImageDraw

    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folder", type=Path)
    options.add_argument("--each", type=Path)
    options.add_argument("--only", default="")
    given = options.parse_args()
    shown = {name: list(moments(scene)) for name, scene in scenes().items() if given.only in name}
    small = SHEET, round(SHEET * HIGH / WIDE)
    with browsing() as browser:
        page = browser_page(browser)
        for theme in THEMES:
            sheet = Image.new("RGB", (2 * SHEET, len(shown) * (small[1] + 16)), THEMES[theme]["paper"].replace(" ", ""))
            for row, (name, pair) in enumerate(shown.items()):
                for column, (picture, values) in enumerate(pair):
                    told = draw(page, picture, values, theme, times=200 if theme == "light" else 0)
                    one = Image.open(io.BytesIO(page.screenshot()))
                    if given.each:
                        given.each.mkdir(parents=True, exist_ok=True)
                        one.save(given.each / f"{name.replace(' ', '_')}-{column}-{theme}.png")
                    place = column * SHEET, row * (small[1] + 16)
                    sheet.paste(one.resize(small, Image.LANCZOS), (place[0], place[1] + 16))
                    grey = "#a6a6a6" if theme == "dark" else "#595959"
                    ImageDraw.Draw(sheet).text(
                        (place[0] + 8, place[1] + 2), name.replace("_", " ") + (", pressed" if column else ""), grey
                    )
                if theme == "light":
                    hidden = told["waiting"] - len(told["placed"])
                    print(f"{name:26s} {told['took']:6.3f} ms  {told['bytes']:6d} bytes of points  {told['shape']:6d} of style"
                          + (f"  {hidden} labels found no place" if hidden else ""))  # fmt: skip
            given.folder.mkdir(parents=True, exist_ok=True)
            sheet.quantize(64).save(given.folder / f"{theme}.png", optimize=True)


if __name__ == "__main__":
    main()
