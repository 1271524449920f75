"""The moving picture of a live view: the scene's mechanism, the handle, the hand's intent and the motor's force."""

import inspect
import math

import numpy as np

from ..analysis.pictures.force_field import ForceField
from ..analysis.pictures.painting import paint
from ..analysis.pictures.pictures import drawing_of, named_by
from ..analysis.pictures.recording import recorded_picture
from ..analysis.pictures.schematic import Schematic
from ..base.drawing import house_style, new_figure, png
from ..errors import AnalysisError
from ..library.display_list import DisplayList
from ..library.entries import CATALOGUE

#: how far the handle goes to either side [m]
REACH = 0.05
#: the force that colours and arrows show in full, where the paddle has no limit [N]
FORCE = 5.0


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
        handle; or a function ``draw(axes, *, x, ...)`` of its own, which takes what it names of coordinates, signals and
        parameters, and draws with :class:`~hapticlab.library.sketch.Sketch`. A shared file needs it to use functions of
        NumPy on what moves, ``np.cos`` and not ``math.cos``, and ``np.where`` where an ``if`` would go many ways.

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
    ['hand', 'frame']
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
        states = {type(q).__name__: q for q in (*scene.coordinates, *scene.signals)}
        self.channels = {name: q for name, q in states.items() if name in names}
        self._names = names & ({*self.channels, "t", "T"} | set(scene.parameters))
        self.box, self.along = self._fit()
        ends = self.box[:2] if abs(self.along[0]) > 0.5 else self.box[2:]
        most = getattr(getattr(drawing, "layout", None), "reach", REACH)
        self.reach = max(ends[0], -most), min(ends[1], most)

    def draw(self, values):
        """Return the items of one moment.

        Parameters
        ----------
        values : dict of str to float
            x [m], and of F [N], intent [m], the channels and the parameters what there is, in SI; parameters are as in
            the scene unless given. Without F no force is drawn.

        Returns
        -------
        tuple of items, as :mod:`hapticlab.library.display_list` lists them
        """
        return self._items(DisplayList(), values)

    def recording(self):
        """Return the picture as data, which the page of a shared file draws from as :meth:`draw` does.

        Returns
        -------
        dict
            As of :func:`~hapticlab.analysis.pictures.recording.recorded_picture`.

        Raises
        ------
        AnalysisError
            For a drawing function of one's own that does more than NumPy with what moves.
        """
        known = {**_defaults(self._drawing), **self.scene.values}
        inputs = {"x": math.nan, "F": 0.0, "intent": math.nan} | {name: known.get(name, math.nan) for name in sorted(self._names)}
        name = getattr(self._drawing, "__name__", type(self._drawing).__name__)
        return recorded_picture(self._items, inputs, name)

    def _items(self, drawn, values):
        """Draw one moment on a display list, of numbers or of nodes."""
        self._mechanism(drawn, values)
        self._hand(drawn, values)
        (left, right), (bottom, top) = drawn.get_xlim(), drawn.get_ylim()
        drawn.add("frame", [(left, bottom), (right, top)], zorder=math.inf)
        shown = np.isfinite(values.get("F", 0.0))
        return tuple(self._told(item) for item in drawn.items if item[0] != "force" or shown)

    def still(self, values):
        """Return one moment as a picture where nothing moves: the bytes of a PNG, and the words for who cannot see it.

        Parameters
        ----------
        values : dict of str to float
            As for :meth:`draw`.
        """
        F = values.get("F", math.nan)
        with house_style():
            figure = new_figure(height=3.0)
            paint(figure, self.draw(values), self.box, F, title=self.scene.name)
        named = [f"x = {1e3 * values['x']:.3g} mm"]
        for name, q in self.channels.items():
            if name in values:
                length = type(q).unit == "m"
                named.append(f"{name} = {values[name] * (1e3 if length else 1):.3g} {'mm' if length else type(q).unit}")
        force = f" The motor applies {abs(F):.2g} N." if math.isfinite(F) else ""
        return png(figure), f"{self.scene.name}: a drawing of the scene with {', '.join(named)}.{force}"

    def _told(self, item):
        kind, points, style = item
        return (kind, points, {**style, "full": self._full}) if kind == "force" else item

    def _mechanism(self, drawn, values):
        known = {**self.scene.values, **values}
        with np.errstate(all="ignore"):  # what cannot be put together is left out
            self._drawing(drawn, x=values["x"], **{name: known[name] for name in self._names if name in known})
        return drawn

    def _hand(self, drawn, values):
        """Draw the hand, which pulls the handle's knob to where it aims."""
        intent, handle = values.get("intent"), _handle(drawn.items)
        if handle is None or intent is None:
            return
        (_, _, (x, y)), style = handle
        way = intent - values["x"]
        aim = x + way * self.along[0], y + way * self.along[1]
        drawn.add("hand", [(x, y), aim], zorder=math.inf, round=style["round"])

    def _fit(self):
        """Return the box that shows the mechanism, and the way the handle moves."""
        defaults = _defaults(self._drawing)
        start = {name: defaults.get(name, 0.0) for name in self.channels}
        near = [self._mechanism(DisplayList(), {"x": x, **start}) for x in (-1e-3, 1e-3)]
        handles = [_handle(drawn.items) for drawn in near]
        moved = np.subtract(handles[1][0][2], handles[0][0][2]) if all(handles) else np.array([1.0, 0.0])
        box = *near[0].get_xlim(), *near[0].get_ylim()
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
    if isinstance(drawing, (ForceField, Schematic)):
        return drawing.start
    given = inspect.signature(drawing).parameters.values()
    return {p.name: p.default for p in given if isinstance(p.default, (int, float))}


def _handle(items):
    """Return the points of the handle, its face first, and its style; None where it is not drawn."""
    return next(((points, style) for kind, points, style in items if kind == "handle"), None)
