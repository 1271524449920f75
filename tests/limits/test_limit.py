"""A limit converts to its number and prints with its units and its kind."""

from typing import get_args

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.limit import MOST_PERIODS, Limit, whole_and_fraction
from hapticlab.limits.passivity import passivity_limit
from hapticlab.scene.laws.taps import TAPS, LawName, SpringLaw


def test_the_type_of_a_law_has_the_names_of_the_laws():
    names, record = get_args(LawName)
    assert set(get_args(names)) == set(TAPS) and record is SpringLaw


def test_number_words_and_units():
    limit = Limit(K=123.4, frequency=55.5, kind="exact linear stability", reason="a pole", assumptions=("no encoder",))
    assert float(limit) == 123.4
    assert str(limit) == "123.4 N/m at 55.5 Hz: exact linear stability; a pole\n  no encoder"
    assert repr(limit) == "Limit(K=123.4 N/m, frequency=55.5 Hz, kind='exact linear stability', reason='a pole')"
    with pytest.raises(AttributeError):
        limit.K = 5


@pytest.mark.parametrize("T", [1e-3, 1 / 3e3, 0.7e-3])
def test_delays_split_without_rounding_noise(T):
    assert whole_and_fraction(0.0, T) == (0, 0.0)
    assert whole_and_fraction(3 * T, T) == (3, 0.0)
    assert whole_and_fraction(sum([T] * 10), T) == (10, 0.0)
    whole, fraction = whole_and_fraction(2.25 * T, T)
    assert whole == 2 and fraction == pytest.approx(0.25, abs=1e-12)
    with pytest.raises(AnalysisError, match="at most 200 periods"):
        whole_and_fraction(201 * T, T, most=MOST_PERIODS)
    assert whole_and_fraction(301 * T, T)[0] == 301  # a record may be older than a polynomial can be long


def test_a_limit_knows_whether_it_holds_in_any_hand():
    assert passivity_limit(hl.Device(b=0.1, T=1e-3)).any_hand
    assert not Limit(K=200.0, frequency=None, kind="exact linear stability of this plant", reason="a pole").any_hand
