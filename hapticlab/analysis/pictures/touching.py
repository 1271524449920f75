"""Whether the environment of a scene is touched: at a wall, inside a case that acts, in a contact; never by a spring alone."""

from functools import reduce
from operator import and_, or_

import numpy as np

from ...scene.shapes.closest_points import ClosestPoints
from .plain_formulas import HANDLE, formula
from .recording import recorded
from .wall_boundaries import regions

#: a body that rests on another is found so far above it, by rounding and by the steps of a method [m]
CLOSE = 1e-6


def touching(scene, watched=()):
    """Return a function that says at which samples something is touched, or None where the scene has nothing to touch.

    Touched is what has a boundary: the handle or a body is beyond it, or between the boundaries of a patch, and the force
    acts. A pendulum, a mass or a damper that hangs on the handle has no boundary. Polygons whose closest points a program
    finds are left out.

    Parameters
    ----------
    scene : Scene
    watched : collection of str
        Coordinates whose samples are known.

    Returns
    -------
    callable of (samples, parameters) -> array of float, 1 or 0, nan where a name is unknown; or None
        A parameter that changed is an array in the samples.

    Examples
    --------
    >>> import hapticlab as hl
    >>> wall, spring = hl.wall()(k=300, x_o=0.01), hl.Scene(force=hl.parameters("k", units="N/m") * hl.x(hl.n))
    >>> samples = {"x": np.array([0.0, 0.012, 0.012]), "F": np.array([0.0, 0.6, 0.0])}
    >>> touching(wall)(samples, {"k": 300.0, "x_o": 0.01}).tolist(), touching(spring)
    ([0.0, 1.0, 0.0], None)
    """
    movers = {HANDLE.name, *(name for q in scene.coordinates if (name := type(q).__name__) in watched)}
    known = movers | set(scene.parameters) | {"t"}

    def is_told(depth):
        names = {symbol.name for symbol in depth.free_symbols}
        return bool(names & movers) and names <= known and not depth.has(ClosestPoints)  # that has no formula in symbols

    found = [told for region in regions(scene) if (told := tuple(filter(is_told, region)))]
    if not found:
        return None
    depths = [formula(*region) for region in found]
    names = frozenset().union(*(names for _, names in depths))

    def touched(samples, parameters):
        known = {**parameters, **samples}
        if not known.keys() >= names:  # a record of another scene
            return np.full(len(samples["x"]), np.nan)
        with np.errstate(all="ignore"):
            inside = [reduce(and_, (depth >= -CLOSE for depth in values(known))) for values, _ in depths]
        return (reduce(or_, inside) & (samples["F"] != 0)).astype(float)

    return touched


def recorded_touching(scene, watched=()):
    """Return :func:`touching` of one sample as data, or None where the scene has nothing to touch.

    Parameters
    ----------
    scene, watched
        As for :func:`touching`.

    Returns
    -------
    dict or None
        As of :func:`~hapticlab.analysis.pictures.recording.recorded`: of x, F, t, the coordinates and the parameters by name.

    Examples
    --------
    >>> import hapticlab as hl
    >>> recorded_touching(hl.wall()(k=300, x_o=0.01))["inputs"]
    [['x', 'NaN'], ['F', 'NaN'], ['x_o', 0.01]]
    """
    touched = touching(scene, watched)
    if touched is None:
        return None
    inputs = dict.fromkeys(["x", "F", "t", *watched, *scene.parameters], np.nan) | dict(scene.values)
    return recorded(lambda known: touched(known, {}), inputs, scene.name)
