"""A right answer written another way than the solution earns the same."""

import numpy as np
import pytest

from hapticlab.course.check import checked
from hapticlab.course.labs import find_lab


@pytest.mark.parametrize("closed", [np.less, np.less_equal])
def test_a_gap_of_exactly_zero_may_count_as_open_or_closed(closed):
    def penalty_force(gap, rate, k, b):
        return np.maximum(0, np.where(closed(gap, 0), -k * gap - b * rate, 0))

    assert checked("08.penalty_force", find_lab("08").exercise("penalty_force"), penalty_force).passed
