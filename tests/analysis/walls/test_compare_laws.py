"""Every law on one bounce, against what is known of a bounce in closed form."""

import math

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.rendering.wall_laws import LAWS, wall_law

FREE = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3)
K = 500.0  # wT = 0.1
NAMES = f"needs names of {', '.join(LAWS)}."


@pytest.fixture(scope="module")
def bounce():
    return hl.design.compare_laws(FREE, K=K, speed=0.1, entries=8)


@pytest.mark.wide
def test_the_plain_wall_throws_back_faster_by_its_half_sample(bounce):
    """A delay of T/2 on a spring is a damper of -K T/2: over half a swing the amplitude grows by exp(pi wT/4)."""
    plain = bounce["zoh"]
    assert plain.rebound == pytest.approx(math.exp(math.pi * 0.1 / 4), rel=3e-3)  # the entry's phase scatters it
    assert plain.generated / bounce.incoming == pytest.approx(plain.rebound**2 - 1, rel=1e-3)  # no damping: all of it returns
    assert bounce.incoming == pytest.approx(0.05 * 0.1**2 / 2, rel=1e-9)


@pytest.mark.wide
def test_where_nothing_dissipates_energy_generated_is_speed_gained(bounce):
    for law in LAWS:
        assert bounce[law].generated / bounce.incoming == pytest.approx(
            bounce[law].rebound ** 2 - 1, abs=2e-5 + bounce[law].spread ** 2
        )


def test_each_step_of_the_chapter_leaves_less(bounce):
    made = {law: abs(bounce[law].generated) / bounce.incoming for law in LAWS}
    assert made["deadbeat"] < 1e-6 and made["deadbeat_reactive"] < 1e-6  # float32 of the scene
    assert made["predictive"] < 1e-3 and made["digital"] < 1e-3
    assert made["zoh"] > 0.1 > 100 * made["backward_difference"]
    # what a damper cancels at the frequency of a bounce it cannot give back there
    assert made["damped"] > 0.8 * made["zoh"]
    # a prediction of one period leaves the entry's phase, a dead-beat pair nothing
    assert bounce["half_sample"].spread > 1e-3 > 100 * bounce["deadbeat"].spread


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"laws": "zho"}, f"laws contain 'zho'; {NAMES}"),
        ({"laws": [hl.wall()]}, f"laws contain a Scene; {NAMES} For a scene, use hl.stability.wall_map"),
        ({"laws": ()}, rf"laws = \(\); needs one or more of {', '.join(LAWS)}$"),
        ({"laws": 3}, f"laws contain an int; {NAMES}"),
        ({"K": -1}, "a wall needs K > 0"),
        ({"K": "stiff"}, "a wall needs K > 0"),
        ({"speed": "fast"}, "finite speed > 0"),
    ],
)
def test_what_no_bounce_has_is_refused_before_any_run(given, words):
    with pytest.raises(AnalysisError, match=words):
        hl.design.compare_laws(FREE, **{"K": K, **given})


def test_one_law_needs_no_list_and_a_board_is_refused(bounce):
    assert hl.design.compare_laws(FREE, K=K, laws="zoh", entries=8)["zoh"] == bounce["zoh"]
    with pytest.raises(AnalysisError, match="needs a SimulatedPaddle, not a Scene"):
        hl.design.compare_laws(hl.wall(), K=K)


def test_a_law_prints_in_words():
    text = str(wall_law("damped", FREE, K=400))
    assert text.startswith("damped: Eq. (23.1), with a damper") and "damped wall on simulated paddle" in text


def test_half_a_period_of_delay_undoes_the_prediction_of_the_chapter_alone():
    late = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, delay=5e-4)
    result = hl.design.compare_laws(late, K=K, laws=["half_sample", "digital", "deadbeat"], entries=4)
    assert result["half_sample"].rebound == pytest.approx(math.exp(math.pi * 0.1 / 4), rel=6e-3)  # as the plain wall without
    assert abs(result["digital"].rebound - 1) < 4e-3 and abs(result["deadbeat"].rebound - 1) < 1e-5


def test_it_prints_and_draws(bounce):
    text = str(bounce)
    assert "a wall of 500 N/m entered at 0.1 m/s (0.25 mJ), 8 phases" in text and "deadbeat_reactive" in text
    left, right = bounce.plot().axes
    assert [label.get_text() for label in left.get_yticklabels()] == [law.replace("_", " ") for law in LAWS]
    assert left.get_xlabel().endswith("[% of the incoming energy]") and right.get_xscale() == "log"


def test_a_law_that_cannot_render_the_wall_is_listed_with_the_reason():
    result = hl.design.compare_laws(FREE, K=6e5, laws=["zoh", "deadbeat"], entries=1)
    assert [b.law for b in result.bounces] == ["zoh"]
    assert "reverses within T" in result.refused["deadbeat"] and "rejected: with K" in str(result)


def test_what_is_no_comparison_is_refused(bounce):
    with pytest.raises(AnalysisError, match="law = 'best'; needs one of zoh"):
        wall_law("best", FREE, K=K)
    with pytest.raises(AnalysisError, match="no bounce of 'best'"):
        bounce["best"]
    with pytest.raises(AnalysisError, match="speed = 0 m/s"):
        hl.design.compare_laws(FREE, K=K, speed=0)
    with pytest.raises(AnalysisError, match="entries = 0"):
        hl.design.compare_laws(FREE, K=K, entries=0)
