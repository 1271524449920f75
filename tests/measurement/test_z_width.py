"""The K-B border measured on a paddle, against exact stability."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.measurement.z_width import z_width

pytest.importorskip("llvmlite")
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)


@pytest.mark.parametrize("B", [[0.0, 0.5], pytest.param([-0.05, 0.0, 1.0, 5.0, 20.0, 45.0], marks=pytest.mark.slow)])
def test_the_border_follows_exact_stability(B):
    found = z_width(PADDLE, B=B)
    exact = [hl.stability_limit(PADDLE, B=b).K for b in B]
    assert found.stability == pytest.approx(exact)
    assert found.K == pytest.approx(exact, rel=0.02) and (found.K == np.minimum(found.unstable, found.buzz)[:, 0]).all()
    assert found.passivity == pytest.approx([max(0.0, 2 * (0.1 - abs(b)) / 1e-3) for b in B])
    assert "comes to rest" in str(found) and f"{len(B)} dampings" in repr(found)
    axes = found.plot().axes[0]
    passive = next(line for line in axes.lines if line.get_label().startswith("passivity"))
    np.testing.assert_array_equal(passive.get_ydata(), found.passivity)  # where it promises nothing, too
    assert "virtual damping B" in axes.get_xlabel() and axes.get_ylim()[1] > found.K.max()


def test_beyond_the_stable_dampers_nothing_stands():
    """B < -b, and B past 2 m/T, where the damper alone is unstable at any stiffness."""
    found = z_width(PADDLE, B=[-0.2, 110.0], judged=hl.measure.Judgement(longest=1.0), search=hl.measure.Search(first=1000.0))
    assert (found.K == 0).all() and (found.stability == 0).all()


def test_what_is_no_damping_is_refused():
    with pytest.raises(hl.errors.AnalysisError, match="finite B"):
        z_width(PADDLE, B=[np.nan])


def test_dampings_are_numbers_or_texts_with_units():
    quick = {"judged": hl.measure.Judgement(longest=2.0), "search": hl.measure.Search(tolerance=0.3)}
    assert z_width(PADDLE, B=["0.5 N*s/m"], **quick).B.tolist() == [0.5]
    with pytest.raises(hl.errors.AnalysisError, match="B = 'wide'; "):
        z_width(PADDLE, B="wide")
    with pytest.raises(hl.errors.AnalysisError, match=r"B = \[\]; needs one or more dampings"):
        z_width(PADDLE, B=[])
