"""A force of the handle's position alone, drawn as its potential: a track with the handle's roller on it."""

import numpy as np
import sympy as sp

from ...library.sketch import Sketch
from ...scene.notation.symbols import n, v, x
from .plain_formulas import HANDLE, formula, plain_symbols
from .wall_boundaries import walls_in

#: what is shown [m], and the height of the potential for the scene's own values
BOX, HIGH = (-0.058, 0.058, -0.0125, 0.0175), 0.011
POINTS = 401


class ForceField:
    """Draws a scene in a state, as :class:`~hapticlab.analysis.pictures.schematic.Schematic` does.

    Attributes
    ----------
    names : set of str
        Parameters that the picture depends on.
    """

    def __init__(self, scene):
        self._force, names = formula(scene.force)
        self.names, self.start, self._values = set(names) - {"x"}, {"x": 0.0}, dict(scene.values)
        swing = np.ptp(self._potential(self._values))
        self._scale = HIGH / swing if swing > 0 else 0.0

    def __call__(self, axes, *, x, **state):
        s, values = Sketch(axes, *BOX), {**self._values, **state}
        heights = self._scale * self._potential(values) - BOX[2] - 0.006

        def track(at):
            return BOX[2] + np.interp(at, np.linspace(*BOX[:2], POINTS), heights)

        s.track(track, x, "$U(x)$", POINTS)

    def _potential(self, values):
        """The integral of the force over x, from its smallest value [J]; the force is 0 where its formula has no value."""
        at = np.linspace(*BOX[:2], POINTS)
        with np.errstate(all="ignore"):
            F = self._force({**values, "x": at})[0] + np.zeros(POINTS)
        F = np.where(np.isfinite(F), F, 0.0)
        U = np.concatenate([[0.0], np.cumsum((F[1:] + F[:-1]) / 2)]) * (BOX[1] - BOX[0]) / (POINTS - 1)
        return U - np.min(U)


def is_field(scene):
    """Tell whether a force depends on the handle's position alone, and is neither springs, straight lines in cases, nor walls.

    Examples
    --------
    >>> import hapticlab as hl
    >>> is_field(hl.library.buckling_beam()), is_field(hl.wall())
    (True, False)
    """
    if scene.coordinates or scene.eom or scene.force.atoms(v):
        return False
    if any(sample.args[0] != n for sample in scene.force.atoms(x)):
        return False
    force = plain_symbols(scene.force)
    if {s.name for s in force.free_symbols} - set(scene.values) - {"x"}:
        return False
    force = force.xreplace(dict.fromkeys(walls_in(force), sp.S.Zero))
    parts = [force.xreplace(dict.fromkeys(force.atoms(sp.Piecewise), sp.S.Zero))]
    parts += [value for cases in force.atoms(sp.Piecewise) for value, _ in cases.args]
    return any(not sp.expand(part.diff(HANDLE, 2)).is_zero for part in parts)
