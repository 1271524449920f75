"""Roots and minima against closed forms."""

import math

import pytest

from hapticlab.base.roots import minimum, root


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e12])
def test_a_root_has_all_its_digits_at_any_size(size):
    assert root(lambda x: (x / size) ** 3 - 2, 0.0, 5 * size) == pytest.approx(size * 2 ** (1 / 3), rel=4e-15)


def test_a_root_at_an_end_is_that_end():
    assert root(lambda x: x, 0.0, 1.0) == 0.0 and root(lambda x: x - 1, 0.0, 1.0) == 1.0


def test_a_minimum_and_one_at_an_end():
    assert minimum(math.cos, 2.0, 4.0) == pytest.approx(math.pi, rel=1e-7)
    assert minimum(abs, -0.3, 1.0) == pytest.approx(0.0, abs=1e-9)
    assert minimum(lambda x: x, 2.0, 4.0) == pytest.approx(2.0, abs=1e-7)
