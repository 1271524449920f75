"""Pictures of mechanisms, each in a state: of the library, and of any other scene."""

from __future__ import annotations

import inspect
import re
from difflib import get_close_matches
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import what_is
from ...base.drawing import house_style, new_figure
from ...base.units import in_si
from ...errors import AnalysisError
from ...library.display_list import DisplayList
from ...library.entries import CATALOGUE
from ...scene.scene import Scene
from .force_field import ForceField, is_field
from .painting import paint
from .schematic import Schematic

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure


def picture(name: str | Scene | Callable[..., Scene], **state: float | str) -> Figure:
    """Draw a scene as a schematic, with the handle and the bodies in a given state.

    Parameters
    ----------
    name : str or Scene
        The name of a scene in ``hl.library``, or that function of the library itself; or a scene of your own, drawn
        from its equations: the handle, walls where its force and equations switch, a block for each coordinate in m, a
        pendulum or a dial for each in rad.
    **state : float or str
        The handle x [m], coordinates and parameters by name, in SI or as a text with a unit; the others as the library
        or the scene has them.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    SceneError, ParameterError, AnalysisError
        For a name that the library or the scene does not have, a value out of its range, and lengths that do not meet.

    Examples
    --------
    >>> import hapticlab as hl
    >>> figure = hl.mechanics.picture("detents", x="20 mm")
    >>> figure.axes[0].get_title()
    'detents'
    >>> hl.mechanics.picture(hl.wall()(k=300, x_o="10 mm"), x="12 mm").axes[0].get_title()
    'zoh wall'
    """
    name, scene, drawing = _scene_of(name)
    moving = {"x": "m"} | {type(q).__name__: type(q).unit for q in scene.coordinates}
    strangers = [given for given in state if given not in (*moving, *scene.parameters)]
    if strangers:
        near = get_close_matches(strangers[0], [*moving, *scene.parameters], 1) or [*moving, *scene.parameters]
        raise AnalysisError(f"{strangers[0]}: {name} has no such quantity; it has {', '.join(near)}")
    moved = {key: in_si(value, moving[key], key) for key, value in state.items() if key in moving}
    bound = scene(**{key: value for key, value in state.items() if key not in moving})
    with house_style():
        figure, drawn = new_figure(height=3.0), DisplayList()
        try:
            with np.errstate(invalid="raise"):
                drawing(drawn, **{**bound.values, **moved})
        except FloatingPointError:
            given = ", ".join(f"{key} = {value}" for key, value in state.items())
            raise AnalysisError(f"{name} cannot be put together with {given}; take other lengths or another place") from None
        paint(figure, drawn.items, (*drawn.xlim, *drawn.ylim), title=scene.name)
    return figure


def _scene_of(name):
    """The name of a scene, the scene, and the function that draws it."""
    if isinstance(name, Scene):
        return name.name, name, drawing_of(name)
    name = getattr(name, "__name__", name)  # hl.library.detents itself
    if not isinstance(name, str):
        raise AnalysisError(
            f"{what_is(name)} has no picture; hl.mechanics.picture draws a scene, or one of the library: 'detents'"
        )
    scene = CATALOGUE[name].scene()
    return name, scene, CATALOGUE[name].draw or Schematic(scene)


def drawing_of(scene):
    """Return the function ``draw(axes, *, x, ...)`` that draws a scene, of the library or from its equations."""
    words = re.split(r"\W+", scene.name)
    for entry in CATALOGUE.values():
        if entry.name.split("_")[0] == words[0]:  # names begin alike, so that few scenes have to be made
            made = entry.scene()
            if (made.name, made.coordinates) == (scene.name, scene.coordinates):
                return entry.draw or Schematic(scene)
    return ForceField(scene) if is_field(scene) else Schematic(scene)


def named_by(drawing):
    """Return the coordinates and parameters that a drawing depends on, a set of names."""
    return set(getattr(drawing, "names", None) or inspect.signature(drawing).parameters) - {"axes", "x", "_"}
