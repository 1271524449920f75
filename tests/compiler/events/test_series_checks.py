"""Steps that are short enough at the values bound, and at the ends of the ranges that live parameters may be set to."""

import math

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.events.series_checks import extremes
from hapticlab.errors import ProgramError


def mass_on_a_spring(ranges, pendulum=False):
    K, m = hl.parameters("K m", units="N/m kg", values=(50, 0.1), ranges={"K": ranges})
    z = hl.coordinate("z", unit="m")
    d = z - x(t)
    one = hl.parameters("one", units="m", values=1)
    soft = one * sp.sin(d / one) if pendulum else d
    return hl.Scene(force=K * (x(n) - z), eom=[sp.Eq(m * z.diff(t, 2), -K * soft)], watch=[z], name="spring")


def test_a_step_is_short_enough_at_the_ends_of_declared_ranges():
    # omega = sqrt(K/m): 22.4 rad/s as bound, 1 rad a step of 1 ms at 1e5 N/m, and three times that at 9e5 N/m
    assert hl.compile(mass_on_a_spring((0, 0.99e5)), "taylor", T=1e-3).facts["omega"] == pytest.approx(math.sqrt(500), rel=1e-3)
    with pytest.raises(
        ProgramError, match=r"spring: at K = 900000, a value that is allowed while it runs,.*substeps=3, declare"
    ) as found:
        hl.compile(mass_on_a_spring((0, 9e5)), "taylor", T=1e-3)
    assert found.value.substeps == 3
    assert hl.compile(mass_on_a_spring((0, 8.9e5)), "taylor", T=1e-3, substeps=3)
    with pytest.raises(ProgramError, match=r"omega = 3000 rad/s, .* or leave K out of live="):
        hl.compile(mass_on_a_spring((0, 9e5)), "taylor", T=1e-3, live="K")
    assert hl.compile(mass_on_a_spring((0, 9e5)), "taylor", T=1e-3, live="m")
    assert hl.compile(mass_on_a_spring((0, math.inf)), "taylor", T=1e-3)  # no end to look at


def test_so_is_one_of_a_motion_that_is_not_linear():
    with pytest.raises(ProgramError, match=r"spring: at K = 900000.*substeps=3"):
        hl.compile(mass_on_a_spring((0, 9e5), pendulum=True), "taylor", T=1e-3)
    assert hl.compile(mass_on_a_spring((0, 0.9e5), pendulum=True), "taylor", T=1e-3)


def test_of_many_ranges_each_end_is_looked_at():
    many = hl.parameters("a b c d f", units="1 1 1 1 1", ranges=[(k, k + 10) for k in range(5)])
    found = list(extremes(many))
    assert len(found) == 2 + 2 * 5
    assert found[0] == {"a": 0, "b": 1, "c": 2, "d": 3, "f": 4} and {"d": 13} in found
    assert len(list(extremes(many[:3]))) == 8


def test_a_place_where_something_is_divided_by_nothing_is_looked_at():
    """A mode is looked at in which the denominator is the constant 0; where that has no slope, it tells nothing."""
    z, (K, m, d) = hl.coordinate("z", unit="m"), hl.parameters("K m d", units="N/m kg m", values=(500, 0.05, 0.01))
    pushed = hl.when(d**2 / sp.Max(z, 0) > d, K * d, 0) + K * z**3 / d**2
    program = hl.compile(hl.Scene(K * (x(n) - z), [sp.Eq(m * z.diff(t, 2), K * (x(t) - z) - pushed)]), T=1e-3)
    # rk4 is stable on a spring up to omega h = 2.83, and at rest in the middle omega = 100 rad/s
    assert program.facts["margin"] == pytest.approx(2 * math.sqrt(2) / (100 * 1e-3), rel=2e-3)
