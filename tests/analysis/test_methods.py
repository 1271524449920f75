"""The table and the picture of the methods."""

import matplotlib.contour
import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.methods import METHODS
from hapticlab.errors import ProgramError


def test_the_table_has_every_method_with_its_numbers():
    known, lines = hl.methods(), {line.split()[0]: line.split() for line in str(hl.methods()).splitlines()}
    assert list(known) == list(METHODS) and set(METHODS) <= set(lines)
    assert lines["rk4"][1:5] == ["4", "4", "2.785", "2.828"]
    assert lines["nystrom4"][1:5] == ["4", "3", "-", "2.587"]
    assert lines["semi_implicit_euler_damped"][3] == "any" and lines["euler"][4] == "0"
    with pytest.raises(ProgramError, match="method = 'rk5'; needs one of euler"):
        known["rk5"]


def test_the_picture_shows_the_region_and_the_longest_step():
    """RK4's boundary crosses the real axis at -2.785; the line of semi-implicit Euler is 2 (sqrt(1 + s^2) - s)."""
    left, right = hl.methods().plot("rk4", "semi_implicit_euler").axes
    contours = [c for c in left.collections if isinstance(c, matplotlib.contour.ContourSet)]
    boundary = contours[0].get_paths()[0].vertices
    assert boundary[:, 0].min() == pytest.approx(-2.785, abs=0.01)
    zeta, longest = right.lines[1].get_data()
    np.testing.assert_allclose(longest, 2 * (np.sqrt(1 + zeta**2) - zeta), rtol=1e-5)
