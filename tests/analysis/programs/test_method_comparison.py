"""The table and the picture of the methods."""

import matplotlib.contour
import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import ProgramError


def test_the_table_has_every_method_with_its_numbers():
    known, lines = hl.methods.table(), {line.split()[0]: line.split() for line in str(hl.methods.table()).splitlines()}
    assert list(known) == [*METHODS, "exact", "taylor"] and set(known) <= set(lines)
    assert lines["rk4"][1:5] == ["4", "4", "2.785", "2.828"]
    assert lines["nystrom4"][1:5] == ["4", "3", "-", "2.587"]
    assert lines["semi_implicit_euler_damped"][3] == "any" and lines["euler"][4] == "0"
    assert lines["exact"][1] == lines["taylor"][1] == "rounding"
    with pytest.raises(ProgramError, match="method = 'rk5'; needs one of euler"):
        known["rk5"]
    with pytest.raises(ProgramError, match="method to draw = 'exact'"):
        known.plot("exact")


@pytest.mark.parametrize("zeta", [0.0, 0.4, 1.7])
def test_what_takes_no_steps_has_the_limits_that_a_scene_finds(zeta):
    """The exact map none; a series a radian of the fastest eigenvalue, zeta + sqrt(zeta^2 - 1) times omega past 1."""
    w, m = 100.0, 0.05
    z, (K, B) = hl.coordinate("z", unit="m"), hl.parameters("K B", units="N/m N*s/m", values=(m * w**2, 2 * zeta * m * w))
    mass = hl.parameters("m", units="kg", values=m)
    F = K * (hl.x(hl.t) - z)
    scene = hl.Scene(force=F, eom=[sp.Eq(mass * z.diff(hl.t, 2), F - B * z.diff(hl.t))])
    for name in ("exact", "taylor"):
        assert hl.methods.table()[name].longest_step(zeta) == pytest.approx(
            w * hl.stability.step_limit(scene, name, T=1e-3).h_max, rel=1e-9
        )


def test_the_picture_shows_the_region_and_the_longest_step():
    """RK4's boundary crosses the real axis at -2.785; the line of semi-implicit Euler is 2 (sqrt(1 + s^2) - s)."""
    left, right = hl.methods.table().plot("rk4", "semi_implicit_euler").axes
    contours = [c for c in left.collections if isinstance(c, matplotlib.contour.ContourSet)]
    boundary = contours[0].get_paths()[0].vertices
    assert boundary[:, 0].min() == pytest.approx(-2.785, abs=0.01)
    zeta, longest = right.lines[1].get_data()
    np.testing.assert_allclose(longest, 2 * (np.sqrt(1 + zeta**2) - zeta), rtol=1e-5)
