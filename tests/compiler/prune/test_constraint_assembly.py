"""Constraints looked at before they run: mechanisms whose singular configurations are known."""

import math

import numpy as np
import pytest

from hapticlab.compiler.prune.constraint_assembly import Assembly

ANYWHERE = np.full(3, np.inf)


def four_bar(crank, coupler, rocker, ground):
    def look(q):
        a, b, c = q
        g = np.array([crank * np.cos(a) + coupler * np.cos(b) - rocker * np.cos(c) - ground,
                      crank * np.sin(a) + coupler * np.sin(b) - rocker * np.sin(c)])  # fmt: skip
        J = np.array([[-crank * np.sin(a), -coupler * np.sin(b), rocker * np.sin(c)],
                      [crank * np.cos(a), coupler * np.cos(b), -rocker * np.cos(c)]])  # fmt: skip
        return g, J

    return look


def assembled(look, guess, angles=True, low=-ANYWHERE, high=ANYWHERE):
    angles = np.full(len(guess), angles)
    rough = Assembly(look, np.array(guess), low, high, angles)
    start = rough.closest(rough.start[:, None])[:, 0]
    assert np.max(np.abs(look(start[:, None])[0])) < 1e-15
    return Assembly(look, start, low, high, angles)


def test_a_change_point_is_found_where_the_links_lie_in_line():
    value, where = assembled(four_bar(0.06, 0.1, 0.06, 0.1), [0.4, 0.3, 2.0]).weakest()
    assert value < 1e-10
    np.testing.assert_allclose(np.sin(where), 0, atol=1e-6)


def test_a_grashof_linkage_has_none():
    mechanism = assembled(four_bar(0.03, 0.1, 0.08, 0.09), [0.4, 0.3, 2.0])
    value, _ = mechanism.weakest()
    # the smallest singular value over the turn, from the textbook's transmission of the four positions
    turn = np.linspace(-math.pi, math.pi, 2000)
    d = 0.09 - 0.03 * np.exp(1j * turn)
    along = (0.1**2 - 0.08**2 + np.abs(d) ** 2) / (2 * np.abs(d))
    arm = d / np.abs(d) * (along + 1j * np.sqrt(0.1**2 - along**2))
    weakness = mechanism.weakness(np.array([turn, np.angle(arm), np.angle(arm - d)]))
    assert value == pytest.approx(weakness.min(), rel=1e-5)
    assert value > 0.1


def test_a_declared_range_keeps_the_change_point_out():
    high = np.array([2.5, np.inf, np.inf])
    value, where = assembled(four_bar(0.06, 0.1, 0.06, 0.1), [0.4, 0.0, 0.4], low=np.array([0.3, -9, -9]), high=high).weakest()
    # the parallelogram's two constraints: the sine of the crank says how far from in line it is
    assert 0.3 <= where[0] <= 2.5
    assert value > 0.1


def test_the_apex_of_a_cone_is_found_from_its_side():
    def cone(q):
        return np.array([q[0] ** 2 + q[1] ** 2 - q[2] ** 2]), np.array([[2 * q[0], 2 * q[1], -2 * q[2]]])

    value, where = assembled(cone, [0.6, 0.8, 1.0], angles=False).weakest()
    assert value < 1e-8
    np.testing.assert_allclose(where, 0, atol=1e-7)


def test_repeated_constraints_are_named_by_their_weights():
    def twice(q):
        g = np.array([q[0] - q[1], q[1] - q[2], 2 * q[0] - 2 * q[2]])
        J = np.array([[1, -1, 0], [0, 1, -1], [2, 0, -2]], float)
        return g, np.repeat(J[:, :, None], q.shape[1], axis=2)

    mechanism = assembled(twice, [0.3, 0.1, 0.2], angles=False)
    weights = mechanism.dependent(mechanism.start)
    # rows have been scaled to one size
    np.testing.assert_allclose(weights / weights[0], [1, 1, -1], rtol=1e-9)
    assert assembled(four_bar(0.03, 0.1, 0.08, 0.09), [0.4, 0.3, 2.0]).dependent(np.array([0.4, 0.3, 2.0])) is None
