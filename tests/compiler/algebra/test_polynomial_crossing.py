"""First crossings of polynomials against numpy.roots and dense sampling."""

import math

import numpy as np
import pytest

from hapticlab.compiler.algebra.polynomial_crossing import FEWER_STEPS, first_crossing
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, select

ORDER = 16


def series_of(A, B, modes):
    """Coefficients of A + B theta + sum of Re(C exp(lambda theta)), |lambda| <= 1."""
    p = np.zeros(ORDER + 1)
    p[0], p[1] = A, B
    for C, rate in modes:
        p += [(C * rate**k / math.factorial(k)).real for k in range(ORDER + 1)]
    return p


def first_of_roots(p):
    """The first root in (0, 1] that p passes downwards, by the eigenvalues of the companion matrix; None for none."""
    if p[0] == 0.0:
        return 0.0 if p[1] < 0 else first_of_roots(p[1:])
    roots = np.roots(p[::-1])
    real = np.sort(roots[np.abs(roots.imag) < 1e-7].real)
    slope = np.polyder(p[::-1])
    return next((r for r in real if 0 < r <= 1 and np.polyval(slope, r) < 0), None)


def guards(seed, count):
    """Smooth guards of one oscillation over at most a radian, many of them almost touching zero."""
    rng = np.random.default_rng(seed)
    for trial in range(count):
        omega, zeta = rng.uniform(0.05, 1), rng.uniform(0, 0.3)
        C = rng.uniform(0.2, 1) * np.exp(1j * rng.uniform(0, 2 * np.pi))
        p = series_of(0.0, rng.normal() * 0.3 * omega, [(C, complex(-zeta * omega, omega * math.sqrt(1 - zeta**2)))])
        p[0] = 0.0
        values = np.polyval(p[::-1], np.linspace(0, 1, 101))
        near = 10 ** rng.uniform(-12, -1) * np.ptp(values)
        p[0] = (-values.min() - near, -values.min() + near, 0.0, abs(rng.normal()) * omega)[trial % 4]
        if p[0] >= 0:
            yield p


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_first_crossing_of_smooth_guards_is_that_of_numpy_roots(seed):
    found_some = missed_none = 0
    with np.errstate(all="ignore"):
        for p in guards(seed, 700):
            place, found = first_crossing([np.float64(c) for c in p])
            expected = first_of_roots(p)
            if expected is None:
                # where the minimum touches zero within rounding, either answer is right
                lowest = np.polyval(p[::-1], np.linspace(0, 1, 2001)).min()
                assert not found or lowest < 1e-13
                missed_none += not found
            elif not found:
                assert np.polyval(p[::-1], np.linspace(0, 1, 2001)).min() > -1e-13
            else:
                # a root is as accurate as the polynomial is flat there: compare the depth
                slope = abs(np.polyval(np.polyder(p[::-1]), expected))
                assert abs(place - expected) * slope < 1e-13
                assert abs(place - expected) < 1e-12 or slope < 1e-3
                found_some += 1
    assert found_some > 200 and missed_none > 100


def test_two_frequencies_whose_second_derivative_changes_sign_once():
    rng = np.random.default_rng(5)
    tried = 0
    with np.errstate(all="ignore"):
        for _ in range(200):
            modes = [(rng.normal() + 1j * rng.normal(), 1j * rng.uniform(0.2, 1)) for _ in range(2)]
            p = series_of(rng.uniform(0, 0.2), rng.normal() * 0.2, modes)
            p[0] = abs(p[0]) * rng.uniform(0, 0.5)
            bend = np.polyval(np.polyder(p[::-1], 2), np.linspace(0, 1, 200))
            if np.count_nonzero(np.diff(np.sign(bend))) > 1:
                continue
            place, found = first_crossing([np.float64(c) for c in p])
            expected = first_of_roots(p)
            assert found == (expected is not None)
            assert expected is None or abs(place - expected) < 1e-12
            tried += 1
    assert tried > 150


def test_fewer_steps_do_where_the_motion_hardly_turns():
    found_some = 0
    for p in guards(3, 250):
        slow = p * 0.1 ** np.arange(ORDER + 1)
        slow[0] = min(slow[0], 0.9 * abs(slow[1]))
        place, found = first_crossing([np.float64(c) for c in slow], steps=FEWER_STEPS)
        expected = first_of_roots(slow)
        # a double root is found to the square root of the rounding
        slope = abs(np.polyval(np.polyder(slow[::-1]), place)) / abs(slow[1])
        assert found == (expected is not None) or slope < 1e-6
        if found and expected is not None:
            assert abs(place - expected) * slope < 1e-13
            found_some += 1
    assert found_some > 25


@pytest.mark.parametrize(
    "p, expected",
    [
        ([1.0, -4.0], 0.25),
        ([1.0, 4.0], None),
        ([1.0, -1.0], 1.0),
        ([3e-3, 0.0, -4.905], math.sqrt(3e-3 / 4.905)),  # a body let go
        ([0.0, 0.5, -1.0], 0.5),  # a bounce: the root it leaves is divided out
        ([0.0, -0.5, 1.0], 0.0),
        ([0.0, 0.0, -1.0], 0.0),
        ([0.0, 0.0, 1.0], None),
        ([1e-300, -1.0, 1.0], 1e-300),  # the small root keeps its digits
        ([0.25, -1.0, 1.0 + 1e-9], None),  # passes without touching
        ([-1e-18, 0.5, -1.0], 0.5),  # a negative start is a rounded zero
        ([0.0, 0.5, -1.0, 1e-3, 1e-5], 0.5002515034539328),
    ],
)
def test_closed_cases(p, expected):
    with np.errstate(all="ignore"):
        place, found = first_crossing([np.float64(c) for c in p])
    assert bool(found) == (expected is not None)
    if expected is None:
        assert place == 1.0
    else:
        assert place == pytest.approx(expected, rel=1e-14, abs=0)
        if len(p) == 5:
            assert place == pytest.approx(first_of_roots(np.array(p)), rel=1e-13)


def test_a_start_known_to_be_a_root_is_divided_out():
    p = [np.float64(c) for c in (3e-17, 0.5, -1.0, 0.01)]
    with np.errstate(all="ignore"):
        assert first_crossing(p, np.bool_(True))[0] == pytest.approx(first_of_roots(np.array([0.0, *p[1:]])), rel=1e-13)
    leaving = [np.float64(c) for c in (3e-17, -0.5, 1.0, 0.01)]
    with np.errstate(all="ignore"):
        assert first_crossing(leaving, np.bool_(True)) == (0.0, True)


@pytest.mark.parametrize("order", [1, 2, 8])
@pytest.mark.always("[12]")
def test_traced_and_computed_are_the_same_bits(order):
    b = Builder("f64")
    place, found = first_crossing([b.leaf("input", k, "f64") for k in range(order + 1)])
    block = b.block([place, select(found, 1.0, 0.0)])
    names = tuple(Channel(f"p{k}", "1", "f64") for k in range(order + 1))
    program = Program("root", names, (), (), (Channel("place", "1", "f64"), Channel("found", "1", "f64")), Block(), block, 1e-3)
    rows = np.random.default_rng(3).normal(size=(200, order + 1)) / [math.factorial(k) for k in range(order + 1)]
    rows[:, 0] = abs(rows[:, 0])
    run = load(program, engine="interpreter").run(len(rows), rows).outputs[:, :, 0]
    with np.errstate(all="ignore"):
        expected = [first_crossing([np.float64(c) for c in row]) for row in rows]
    np.testing.assert_array_equal(run, [[float(a), float(f)] for a, f in expected])
    assert 0 < run[:, 1].sum() < len(rows)


def test_work_does_not_depend_on_the_polynomial():
    def instructions(order):
        b = Builder("f32")
        return len(b.block([first_crossing([b.leaf("input", k, "f32") for k in range(order + 1)])[0]]))

    assert instructions(1) < instructions(2) < 40
    # four instructions a Newton step and coefficient
    assert instructions(8) < 600 < instructions(16) < 1200
