"""The drawing of docs/explanation/life_of_a_sample.md: ``python docs/builder/pages/sample_picture.py`` writes it."""

import math
from pathlib import Path

PICTURE = Path(__file__).parents[2] / "explanation" / "life_of_a_sample.svg"
INK, SOFT, PAPER, BODY, WARM, COLD = "#1b1f24", "#57606a", "#ffffff", "#eef3f8", "#b3470f", "#1a66cc"
WIDTH, HEIGHT, BOX, HIGH = 640, 530, 176, 54
#: of the boxes, in the order of the loop: place in the grid, name, what it hands on
STAGES = (
    (0, 0, "handle", "x(t) [m]"),
    (1, 0, "sensor", "late by sensor_delay"),
    (2, 0, "counts", "a whole number"),
    (2, 1, "position", "x(n) [m]"),
    (1, 1, "velocity", "v(n) [m/s]"),
    (0, 1, "program", "F(n) [N]"),
    (0, 2, "limits", "force_max, faults"),
    (1, 2, "duty", "-1 to 1, PWM"),
    (2, 2, "motor", "-F(n), held for T"),
)


def picture():
    """Return the drawing as SVG, on a white ground that is readable on a light and on a dark page."""
    parts = [_rect(0, 0, WIDTH, HEIGHT, PAPER, PAPER), *map(_box, STAGES)]
    parts += [_line(*_between(a, b)) for a, b in zip(STAGES, STAGES[1:], strict=False)]
    right, top = 622, _centre(STAGES[-1])[1]  # from the motor back to the handle, outside the boxes
    parts.append(f'<path d="M604 {top} H{right} V12 H108 V20" fill="none" stroke="{INK}" marker-end="url(#tip)"/>')
    body = "\n".join([*parts, *_time_line()])
    tip = '<marker id="tip" markerWidth="8" markerHeight="8" refX="7" refY="4" orient="auto"><path d="M0 0L8 4L0 8z"/>'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="15">'
    return f"{head}\n<defs>{tip}</marker></defs>\n{body}\n</svg>\n"


def _centre(stage):
    column, row, *_ = stage
    return 20 + column * 204 + BOX / 2, 22 + row * 84 + HIGH / 2


def _box(stage):
    x, y = _centre(stage)
    frame = _rect(x - BOX / 2, y - HIGH / 2, BOX, HIGH, BODY, INK)
    return frame + _text(x, y - 5, stage[2], weight="bold") + _text(x, y + 17, stage[3], SOFT)


def _between(one, other):
    """The ends of an arrow from the side of one box to the facing side of another."""
    (x1, y1), (x2, y2) = _centre(one), _centre(other)
    right, down = (x2 > x1) - (x2 < x1), (y2 > y1) - (y2 < y1)
    return x1 + right * BOX / 2, y1 + down * HIGH / 2, x2 - right * BOX / 2, y2 - down * HIGH / 2


def _time_line():
    """What happens when: a smooth position, its samples, and a force that is late and held."""
    base, period, delay, first = 490, 150, 40, 70

    def high(x):
        return 200 - 170 * math.exp(-x / 260)

    at = [first + k * period for k in range(4)]
    curve = " ".join(f"{x},{base - high(x):.1f}" for x in range(30, 601, 10))
    held = "".join(f" V{base - high(x) / 2:.1f} H{min(x + delay + period, 600)}" for x in at)
    yield _line(30, base, 612, base)
    yield f'<polyline points="{curve}" fill="none" stroke="{COLD}" stroke-width="2"/>'
    yield f'<path d="M30 {base} H{first + delay}{held}" fill="none" stroke="{WARM}" stroke-width="2.5"/>'
    for x, words in zip(at, ("n T", "(n+1) T", "(n+2) T", "(n+3) T"), strict=True):
        yield f'<line x1="{x}" y1="{base - high(x):.1f}" x2="{x}" y2="{base}" stroke="{SOFT}" stroke-dasharray="3 4"/>'
        yield f'<circle cx="{x}" cy="{base - high(x):.1f}" r="4" fill="{COLD}"/>'
        yield _text(x, base + 22, words)
    yield _line(first, base - 12, first + delay, base - 12)
    yield _text(first + delay + 8, base - 7, "delay", anchor="start")
    yield _line(at[1] + delay, base - 34, at[2] + delay, base - 34)
    yield _text(at[1] + delay + 8, base - 14, "held for T", anchor="start")
    yield _text(30, base - 160, "x is read at n T, (n+1) T ...", COLD, anchor="start")
    yield _text(604, base - 50, "F, as it acts", WARM, anchor="end")
    yield _text(620, base + 22, "time", SOFT)


def _line(x1, y1, x2, y2):
    return f'<line x1="{x1:g}" y1="{y1:g}" x2="{x2:g}" y2="{y2:g}" stroke="{INK}" marker-end="url(#tip)"/>'


def _rect(x, y, width, height, fill, stroke):
    return f'<rect x="{x:g}" y="{y:g}" width="{width}" height="{height}" rx="6" fill="{fill}" stroke="{stroke}"/>'


def _text(x, y, words, colour=INK, anchor="middle", weight="normal"):
    return f'<text x="{x:g}" y="{y:g}" fill="{colour}" text-anchor="{anchor}" font-weight="{weight}">{words}</text>'


if __name__ == "__main__":
    PICTURE.write_text(picture(), "utf-8")
