"""Pictures of the library's mechanisms, each in a state."""

from difflib import get_close_matches

from ..errors import AnalysisError
from ..library.entries import CATALOGUE
from .plots import house_style, new_figure


def picture(name, **state):
    """Draw a scene of the library as a schematic, with the handle and what moves in a given state.

    Parameters
    ----------
    name : str
        Of a scene in ``hl.library``.
    **state : float
        The handle x [m], coordinates and parameters by name, in SI; the others as the library has them.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    SceneError, AnalysisError
        For a name that the library or the scene does not have.

    Examples
    --------
    >>> import hapticlab as hl
    >>> figure = hl.picture("detents", x=0.02)
    >>> figure.axes[0].get_title()
    'detents'
    """
    entry = CATALOGUE[name]
    scene = entry.scene()
    coordinates = [type(q).__name__ for q in scene.coordinates]
    known = ["x", *coordinates, *scene.parameters]
    for given in state:
        if given not in known:
            near = get_close_matches(given, known, 1)
            raise AnalysisError(f"{given}: {name} has no such quantity; it has {', '.join(near or known)}")
    moved = {key: float(value) for key, value in state.items() if key not in scene.parameters}
    bound = scene(**{key: value for key, value in state.items() if key in scene.parameters})
    with house_style():
        figure = new_figure(height=3.0)
        axes = figure.subplots()
        entry.draw(axes, **bound.values, **moved)
        axes.set_title(scene.name, fontsize="small")
        (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        figure.set_size_inches(7.2, 7.2 * (top - bottom) / (right - left) + 0.35)
    return figure
