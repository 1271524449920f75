"""The live view without anywidget: a picture in SVG, sliders and buttons of ipywidgets."""

import base64
import html
import math

import numpy as np

from ...library.parts import primitives
from ..frame import Frame
from ..sliders import open_ipywidgets
from .plain_letters import plain

#: an SVG is drawn so often a second at most: of frames that come at 50 to 60 a second, every other one
RATE = 40.0
#: in pixels
WIDTH, HEIGHT, GRAPH = 640, 220, 130
#: time on view in the traces [s]
SECONDS = 4.0
#: pixels that one smallest and largest value of a trace stand for
FINE = 2
#: the page counts every so many milliseconds; a board's motor is on for so long after the last touch [s]
BEAT, UNTOUCHED = 500, 60.0
#: a slider that was moved so shortly ago is not put elsewhere [s]
MOVING = 0.4
STEPS = 200
#: what leads the hand in a canvas, and here
DRAG, SLIDE = "Drag the handle, or use the arrow keys: they move", "The slider of the hand moves"
#: JupyterLab takes keys for its own where a plain widget has the focus
KEYS = " While a slider or a button here has the focus, JupyterLab takes letters for its own: d d deletes the cell."
DASHES = ("", "7 3", "2 3")


def front(session):
    """Return the widget that shows a session.

    Raises
    ------
    EngineMissingError
        Without ipywidgets.
    """
    cure = (
        "hl.live draws with widgets, which do not import here; do: pip install 'hapticlab[notebook]', in the environment "
        "of the notebook"
    )
    return PlainFront(open_ipywidgets(cure), session).box


class PlainFront:
    """Widgets on a session. ``box`` is what a notebook shows.

    Plain widgets cannot say that a view opened, so the first touch begins: a button, a slider. From then on a counter in
    the page says that the page is there; it cannot say that an output was cleared, so a board's motor goes off where
    nothing was touched for a minute.
    """

    def __init__(self, widgets, session):
        self.session, self.about = session, session.description()
        self._rows, self._drawn = np.zeros((0, len(self.about["columns"]))), -1.0
        self._moved, self._showing = {}, False
        self._beaten = self._touched = -math.inf
        self.image, self.status = widgets.HTML(), widgets.HTML("Press a button or move a slider to begin.")
        self.heart = widgets.Play(min=0, max=2**30, interval=BEAT, layout={"display": "none"})
        self.heart.observe(self._beat, names="value")
        self.sliders = [self._slider(widgets, number, given) for number, given in enumerate(self.about["parameters"])]
        self.buttons = {name: widgets.Button(description=words) for name, words in self._presses().items()}
        for name, button in self.buttons.items():
            button.on_click(lambda _, name=name: self._say(session.press, name))
        low, high = (1e3 * end for end in self.about["x_range"])
        self.hand = widgets.FloatSlider(
            value=0.0, min=low, max=high, step=0.1, description="hand [mm]", layout={"width": f"{WIDTH}px"}
        )
        self.hand.observe(lambda change: self._say(session.intend, 1e-3 * change["new"]), names="value")
        hand = [self.hand] if self.about["kind"] == "simulated" else []
        help_ = widgets.HTML(html.escape(self.about["help"].replace(DRAG, SLIDE) + KEYS))
        self.box = widgets.VBox(
            [widgets.HBox(list(self.buttons.values())), self.image, self.status, *hand, *self.sliders, help_, self.heart]
        )
        self.show(Frame(0.0, np.zeros((0, len(self.about["columns"]))), session.picture.draw(session.motion.values(0.0))))
        session.connect(self.show)

    def _say(self, what, *given):
        """Do what was touched, and have the page count where it does not."""
        now = self._touched = self.session.clock()
        self.session.ready("page")
        what(*given)
        if now - self._beaten > 3e-3 * BEAT:
            self.heart.playing = False
            self.heart.playing = True

    def _beat(self, change):
        now = self._beaten = self.session.clock()
        self.session.alive("page")
        if self.about["kind"] == "board" and now - self._touched > UNTOUCHED and self.session.motion.running:
            self.session.press("pause")

    def show(self, frame):
        """Draw a frame, if the one before is long enough ago."""
        if len(frame.rows):
            anew = len(self._rows) and frame.rows[0, 0] < self._rows[-1, 0]
            self._rows = np.asarray(frame.rows) if anew else np.concatenate([self._rows, frame.rows])
        self._rows = self._rows[self._rows[:, 0] > frame.time - SECONDS]
        if frame.status:
            self.status.value = f'<span role="status">{html.escape(frame.status)}</span>'
        now = self.session.clock()
        if frame.flags.get("running") and now < self._drawn + 1 / RATE - 2e-3:
            return
        self._drawn = now
        self.image.value = svg(frame, self._rows, self.about)
        self._switch(frame.flags)
        self._follow(frame.flags.get("values", {}))

    def _switch(self, flags):
        """Switch off the buttons that would do nothing now; never what stops a motor."""
        running, recording, recorded = (flags.get(name, False) for name in ("running", "recording", "recorded"))
        off = {"resume": running, "start": running, "pause": False, "record": recording, "stop": not recording, "restart": False}
        for name, button in self.buttons.items():
            button.disabled = bool({**off, "save": not recorded, "replay": not recorded}[name]) and self.session.on_view

    def _follow(self, values):
        """Put the sliders where the parameters are, except one that is being moved."""
        self._showing, now = True, self.session.clock()
        try:
            for number, (slider, given) in enumerate(zip(self.sliders, self.about["parameters"], strict=True)):
                value = given["scale"] * values[given["name"]] if given["name"] in values else slider.value
                if now - self._moved.get(number, -MOVING) < MOVING:
                    continue
                if abs(value - slider.value) > 1e-6 * (slider.max - slider.min):
                    slider.value = value
        finally:
            self._showing = False

    def _presses(self):
        board = self.about["kind"] == "board"
        run = {"start": "Start motor", "pause": "Stop motor"} if board else {"resume": "Run", "pause": "Pause"}
        return {**run, "restart": "Start again", "record": "Record", "stop": "Stop recording", "save": "Save", "replay": "Replay"}

    def _slider(self, widgets, number, given):
        scale = given["scale"]
        low, high, step = on_a_grid(*(scale * given[name] for name in ("value", "low", "high")))
        slider = widgets.FloatSlider(
            value=scale * given["value"], min=low, max=high, step=step,
            description=f"{given['name']} [{given['unit_shown'] or '1'}]", tooltip=given["limit_words"],
            readout_format=".4g", style={"description_width": "9em"}, layout={"width": f"{WIDTH}px"},
        )  # fmt: skip

        def moved(change):
            if not self._showing:
                self._moved[number] = self.session.clock()
                self._say(self.session.move, number, change["new"] / scale)

        slider.observe(moved, names="value")
        return slider


def on_a_grid(value, low, high):
    """Return ends and a step of a slider, so that its value is on a step: the browser would move it there.

    Examples
    --------
    >>> on_a_grid(300.0, 60.0, 900.0)
    (60.0, 900.0, 5.0)
    """
    rough = (high - low) / STEPS
    tens = 10.0 ** math.floor(math.log10(rough))
    step = next(tens * part for part in (1.0, 2.0, 5.0, 10.0) if tens * part >= rough * (1 - 1e-9))
    below, above = math.floor((value - low) / step + 1e-9), math.floor((high - value) / step + 1e-9)
    return value - below * step, value + above * step, step


def still_picture(session, words):
    """Return HTML of the scene as it is now, as an image, with a sentence: for a page without widgets."""
    about = session.description()
    image = svg(Frame(0.0, picture=session.stage.drawn(None)), np.zeros((0, 1)), about)
    image = image.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ')
    data = base64.b64encode(image.encode()).decode()
    alt = html.escape(f"{about['title']}: picture of the scene at rest")
    return f'<img alt="{alt}" width="{WIDTH}" src="data:image/svg+xml;base64,{data}"><p>{html.escape(words)}</p>'


def svg(frame, rows, about):
    """Return a frame as SVG: the picture, and the traces of the last seconds under it."""
    left, right, bottom, top = about["box"]
    scale = min(WIDTH / (right - left), HEIGHT / (top - bottom))

    def place(point):
        x = (point[0] - (left + right) / 2) * scale + WIDTH / 2
        return f"{x:.1f},{(HEIGHT / 2 - (point[1] - (bottom + top) / 2) * scale):.1f}"

    force = float(rows[-1, 2]) if len(rows) else math.nan
    picture = "".join(_item(item, place) for item in primitives(frame.picture, force))
    opened = [trace for trace in about["traces"] if trace["open"]] if len(rows) else []
    shown = [rows[:, about["columns"].index(trace["name"])] * trace["scale"] for trace in opened]
    traces = "".join(
        _trace(k, trace, rows[:, 0], values, frame.time) for k, (trace, values) in enumerate(zip(opened, shown, strict=True))
    )
    now = [f"{trace['label']} = {values[-1]:.3g} {trace['unit_shown']}" for trace, values in zip(opened, shown, strict=True)]
    title = html.escape(", ".join([f"{about['title']} at {frame.time:.1f} s", *now]))
    return (
        f'<svg role="img" aria-label="{title}" viewBox="0 0 {WIDTH} {HEIGHT + len(opened) * GRAPH}" width="{WIDTH}" '
        f'style="background:#fff;font:12px sans-serif">{picture}{traces}</svg>'
    )


def _item(item, place):
    kind, points, style = item
    if kind == "line":
        dashed = f' stroke-dasharray="{" ".join(map(str, style["dash"]))}"' if style["dash"] else ""
        return _path(points, place, f'fill="none" stroke="{style["colour"]}" stroke-width="{style["width"]:g}"{dashed}')
    if kind == "area":
        return _path(points, place, f'fill="{style["fill"] or "none"}" stroke="{style.get("edge") or "none"}"', " Z")
    if kind == "arrow":
        colour = style["colour"]
        return _path(points, place, f'stroke="{colour}" stroke-width="2.5"') + _head(*points, place, colour)
    x, y = place(points[1]).split(",")
    return f'<text x="{x}" y="{y}" text-anchor="middle" fill="{style["colour"]}">{html.escape(plain(style["words"]))}</text>'


def _path(points, place, style, end=""):
    return f'<path d="M{" L".join(map(place, points))}{end}" {style}/>' if len(points) else ""


def _head(tail, tip, place, colour):
    tip, tail = (np.array([float(c) for c in place(p).split(",")]) for p in (tip, tail))
    along = (tip - tail) / (np.hypot(*(tip - tail)) or 1.0)
    across = np.array([-along[1], along[0]])
    corners = [tip, tip - 9 * along + 4 * across, tip - 9 * along - 4 * across]
    return f'<path d="M{" L".join(f"{x:.1f},{y:.1f}" for x, y in corners)} Z" fill="{colour}"/>'


def _trace(k, trace, times, values, time):
    """Return one scrolling trace with its name, unit and range."""
    top = HEIGHT + k * GRAPH
    t, shown = envelope(times, values, SECONDS / WIDTH * FINE)
    low, high = min(float(shown.min(initial=0.0)), 0.0), max(float(shown.max(initial=0.0)), 0.0)
    scale = (GRAPH - 32) / ((high - low) or 1.0)
    x, y = WIDTH * (1 - (time - t) / SECONDS), top + GRAPH - 12 - (shown - low) * scale
    points = " L".join(f"{a:.0f},{b:.1f}" for a, b in zip(x.tolist(), y.tolist(), strict=True))
    zero = top + GRAPH - 12 + low * scale
    words = html.escape(f"{trace['label']} [{trace['unit_shown']}], {low:.3g} to {high:.3g}")
    line = f'<path d="M{points}" fill="none" stroke="#222" stroke-dasharray="{DASHES[k]}"/>' if points else ""
    return (
        f'<line x1="0" x2="{WIDTH}" y1="{zero:.1f}" y2="{zero:.1f}" stroke="#999"/>{line}'
        f'<text x="4" y="{top + 12}" fill="#222">{words}</text>'
    )


def envelope(t, values, width):
    """Return a trace as the smallest and the largest value of every so many seconds: chatter stays to be seen.

    Examples
    --------
    >>> times, ends = envelope(np.arange(6.0), np.array([0.0, 5, 1, 2, 7, 3]), 3.0)
    >>> times.tolist(), ends.tolist()
    ([0.0, 0.0, 3.0, 3.0], [0.0, 5.0, 2.0, 7.0])
    """
    if not len(t):
        return t, values
    first = np.flatnonzero(np.diff(np.floor(t / width), prepend=-np.inf))
    ends = np.column_stack([np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)])
    return np.repeat(t[first], 2), ends.ravel()
