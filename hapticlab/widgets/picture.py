"""The moving picture of a live view: the scene's mechanism, the handle, the hand's intent and the motor's force."""

import inspect
import math

import numpy as np

from ..analysis.pictures.pictures import drawing_of, named_by
from ..analysis.pictures.schematic import Schematic
from ..base.drawing import COLD
from ..errors import AnalysisError
from ..library.entries import CATALOGUE
from ..library.sketch import HANDLE, INK, ring
from .picture_items import RecordingAxes

#: how far the handle goes to either side [m]
REACH = 0.05
#: the force that is drawn as long as FULL of the picture's width, where the paddle has no limit [N]
FORCE, FULL = 5.0, 0.2
HAND = COLD


def moving_picture(scene, paddle=None, picture=None):
    """A function that draws a scene in motion, in items for a canvas.

    Parameters
    ----------
    scene : Scene
        A scene of the library is drawn as ``hl.mechanics.picture`` does; any other as a schematic: the handle, walls where its
        force and equations switch, a block for each coordinate in m, a pendulum or a dial for each in rad.
    paddle : Paddle, optional
        Its largest force scales the force arrow.
    picture : str, sequence of Placed, or callable, optional
        Instead: a name in ``hl.library``; shapes in their places, as ``hl.shapes.Circle("5 mm").at(y=z)``, drawn beside the
        handle; or a function ``draw(axes, *, x, ...)`` of its own, which takes what it names of coordinates and
        parameters, and draws with :class:`~hapticlab.library.sketch.Sketch`.

    Returns
    -------
    MovingPicture

    Raises
    ------
    AnalysisError
        For a picture that is none of these, and one that names what the scene does not have.

    Examples
    --------
    >>> import hapticlab as hl
    >>> picture = moving_picture(hl.wall()(k=300, x_o=0.01))
    >>> [item[0] for item in picture.draw({"x": 0.012, "F": 0.6, "intent": 0.02})][-2:]
    ['arrow', 'text']
    """
    return MovingPicture(scene, _drawing(scene, picture), getattr(paddle, "force_max", None) or FORCE)


class MovingPicture:
    """A picture in motion.

    Attributes
    ----------
    channels : dict of str to expression
        What must be known of the scene's state, to be watched beside what the scene watches.
    box : (left, right, bottom, top)
        What it shows [m], whatever moves.
    along : (x, y)
        Unit vector along which the handle moves, and a pointer has to.
    reach : (low, high)
        How far a hand goes [m]: about the travel of a Hapkit's handle.
    """

    def __init__(self, scene, drawing, full_force):
        self.scene, self._drawing, self._full = scene, drawing, full_force
        names = named_by(drawing)
        self.channels = {type(q).__name__: q for q in scene.coordinates if type(q).__name__ in names}
        self._names = names & ({*self.channels, "t", "T"} | set(scene.parameters))
        self.box, self.along = self._fit()
        self._unit = (self.box[1] - self.box[0]) / 100
        ends = self.box[:2] if abs(self.along[0]) > 0.5 else self.box[2:]
        self.reach = max(ends[0], -REACH), min(ends[1], REACH)

    def draw(self, values):
        """Return the items of one moment.

        Parameters
        ----------
        values : dict of str to float
            x [m], and of F [N], intent [m], the channels and the parameters what there is, in SI; parameters are as in
            the scene unless given.

        Returns
        -------
        tuple of items, as :mod:`hapticlab.widgets.picture_items` lists them; coordinates in metres
        """
        items = self._mechanism(values).items
        return items + self._marks(values, items)

    def _mechanism(self, values):
        axes = RecordingAxes()
        known = {**self.scene.values, **values}
        with np.errstate(all="ignore"):  # what cannot be put together is left out
            self._drawing(axes, x=values["x"], **{name: known[name] for name in self._names if name in known})
        return axes

    def _marks(self, values, items):
        """Marks of the hand's intent and of the motor's force, at the handle."""
        handle = _handle(items)
        if handle is None:
            return ()
        (x, y), (ax, ay), u, found = handle, self.along, self._unit, ()
        intent, F = values.get("intent"), values.get("F", 0.0)

        def beside(along, across):
            return x + along * ax - across * ay, y + along * ay + across * ax

        if intent is not None and math.isfinite(intent):
            across = 2.8 * u if _is_named_beside(items, handle, u) else 0.0
            hand = beside(intent - values["x"], across)
            found += (("line", [beside(0.0, across), hand], 2.0, HAND, (4, 3)),)
            found += (("area", ring(hand, 1.4 * u, 16), "#ffffff", HAND),)
        if math.isfinite(F):
            side, length = 1.0 if F < 0 else -1.0, FULL * 100 * u * min(abs(F) / self._full, 1.5)
            if length > 0.5 * u:
                tail, tip = (beside(side * away, -3.0 * u) for away in (1.5 * u, 1.5 * u + length))
                found += (("arrow", tail, tip, INK, ""),)
            beyond = 10 * u + (length if side < 0 else 3 * u)
            words = beside(-beyond, -3.0 * u) if abs(ax) > 0.5 else beside(0.0, -17 * u)
            found += (("text", words, f"motor {abs(F):.1f} N", INK),)
        return found

    def _fit(self):
        """Return the box that shows the mechanism wherever it is likely to go, and the way the handle moves."""
        defaults = _defaults(self._drawing)
        start = {name: defaults.get(name, 0.0) for name in self.channels}
        at = defaults.get("x", 0.0)

        def drawn(x):
            follow = {name: value + x - at for name, value in start.items() if _is_length(self.channels[name])}
            return self._mechanism({"x": x, **start, **follow})

        left, right, bottom, top = np.transpose([(*axes.xlim, *axes.ylim) for axes in map(drawn, (at, -REACH, REACH))])
        places = [_handle(drawn(x).items) for x in (-1e-3, 1e-3)]
        moved = np.subtract(places[1], places[0]) if all(places) else np.array([1.0, 0.0])
        box = left.min(), right.max(), bottom.min(), top.max()
        return tuple(map(float, box)), tuple(map(float, moved / np.hypot(*moved)))


def _drawing(scene, picture):
    """Return the function that draws the mechanism on axes."""
    if callable(picture):
        return picture
    if isinstance(picture, str):
        return CATALOGUE[picture].draw
    if picture is None:
        return drawing_of(scene)
    shapes = tuple(picture) if isinstance(picture, (list, tuple)) else (picture,)
    if not all(hasattr(shape, "shape") for shape in shapes):
        raise AnalysisError(
            f"picture = {picture!r}; needs a name of hl.library, shapes in their places, [hl.shapes.Circle('5 mm').at(y=z)], or "
            "a function draw(axes, *, x, ...)"
        )
    return Schematic(scene, shapes)


def _defaults(drawing):
    if isinstance(drawing, Schematic):
        return drawing.start
    given = inspect.signature(drawing).parameters.values()
    return {p.name: p.default for p in given if isinstance(p.default, (int, float))}


def _is_length(coordinate):
    return type(coordinate).unit == "m"


def _handle(items):
    """Return where the handle is drawn, its centre (x, y) [m]."""
    for item in items:
        if item[0] == "area" and item[2] == HANDLE:
            xs, ys = zip(*item[1], strict=True)
            return (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    return None


def _is_named_beside(items, place, u):
    """Tell whether the word for the handle stands beside it, where the hand would cover it."""
    return any(item[:1] + item[2:3] == ("text", "handle") and abs(item[1][1] - place[1]) < 3 * u for item in items)
