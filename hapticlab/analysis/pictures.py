"""Pictures of the library's mechanisms, each in a state."""

from difflib import get_close_matches

import numpy as np

from ..drawing import house_style, new_figure
from ..errors import AnalysisError
from ..library.entries import CATALOGUE
from ..scene.units import in_si


def picture(name, **state):
    """Draw a scene of the library as a schematic, with the handle and what moves in a given state.

    Parameters
    ----------
    name : str
        Of a scene in ``hl.library``, or that function of the library itself.
    **state : float or str
        The handle x [m], coordinates and parameters by name, in SI or as a text with a unit; the others as the library
        has them.

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
    >>> figure = hl.picture("detents", x="20 mm")
    >>> figure.axes[0].get_title()
    'detents'
    """
    name = getattr(name, "__name__", name)  # hl.library.detents itself
    if not isinstance(name, str):
        raise AnalysisError(f"a {type(name).__name__} has no picture; hl.picture draws the library's scenes by name: 'detents'")
    entry = CATALOGUE[name]
    scene = entry.scene()
    moving = {"x": "m"} | {type(q).__name__: type(q).unit for q in scene.coordinates}
    strangers = [given for given in state if given not in (*moving, *scene.parameters)]
    if strangers:
        near = get_close_matches(strangers[0], [*moving, *scene.parameters], 1) or [*moving, *scene.parameters]
        raise AnalysisError(f"{strangers[0]}: {name} has no such quantity; it has {', '.join(near)}")
    moved = {key: in_si(value, moving[key], key) for key, value in state.items() if key in moving}
    bound = scene(**{key: value for key, value in state.items() if key not in moving})
    with house_style():
        figure = new_figure(height=3.0)
        axes = figure.subplots()
        try:
            with np.errstate(invalid="raise"):
                entry.draw(axes, **bound.values, **moved)
        except FloatingPointError:
            given = ", ".join(f"{key} = {value}" for key, value in state.items())
            raise AnalysisError(f"{name} cannot be put together with {given}; take other lengths or another place") from None
        axes.set_title(scene.name, fontsize="small")
        (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        figure.set_size_inches(7.2, 7.2 * (top - bottom) / (right - left) + 0.35)
    return figure
