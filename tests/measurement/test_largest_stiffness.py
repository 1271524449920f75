"""The search on the paddle, against the exact stability limit of the same handle, hand and delay."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.measurement.largest_stiffness import LargestStiffness, largest_stiffness, searched
from hapticlab.measurement.trials import Trial

pytest.importorskip("llvmlite")  # some hundred thousand ticks
T = 1e-3


def lengths(K):
    return 1.0, 4.0


def paddle(**changes):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.1, "T": T, **changes})


@pytest.mark.parametrize(
    ("law", "changes"),
    [
        ("zoh", {}),
        pytest.param("zoh", {"delay": 1e-3}, marks=pytest.mark.slow),
        pytest.param("backward_difference", {"delay": 0.4e-3}, marks=pytest.mark.slow),
        pytest.param("ellis", {}, marks=pytest.mark.slow),
        pytest.param("zoh", {"hand": hl.Hand(m=0.02, b=1.0, k=200.0, intent=5e-3)}, marks=pytest.mark.slow),
    ],
)
def test_what_stands_and_what_chatters_enclose_the_exact_limit(law, changes):
    """A handle pressed on a wall moves inside it, where the wall is the linear law. A limit cycle and the slowest
    decays are not told apart: the pair may lie 2 % low."""
    tried = paddle(**changes)
    found = largest_stiffness(tried, law=law, search=hl.measure.Search(first=100.0))
    exact = hl.stability_limit(tried, law=law).K
    assert 0.97 * exact < found.K < exact < 1.03 * found.chatters_at
    assert found.chatters_at / found.K <= 1.02
    assert found.theory["stability"].K == exact and float(found) == found.K


def test_no_trial_goes_further_than_one_ratio_beyond_what_stood():
    found = largest_stiffness(paddle(), judged=hl.measure.Judgement(longest=1.0), search=hl.measure.Search(tolerance=0.1))
    stood = found.trials[0].K
    for trial in found.trials:
        assert trial.K <= 1.5 * stood * (1 + 1e-9)
        stood = max(stood, trial.K) if trial.stands else stood


def test_without_damping_no_stiffness_stands():
    """Each period a held spring adds energy; in softer walls it takes longer to see, and three swings at least."""
    found = largest_stiffness(paddle(b=0.0))
    assert found.K == 0 and "no stiffness stood" in str(found)
    assert found.chatters_at == pytest.approx(0.2)
    short = largest_stiffness(paddle(b=0.0), judged=hl.measure.Judgement(longest=1.0))
    assert math.isnan(short.K) and "undecided" in str(short) and "needs Judgement(longest=3" in str(short)
    assert "undecided" in short.plot().axes[0].get_legend_handles_labels()[1]


@pytest.mark.parametrize("m", [pytest.param(1.0, marks=pytest.mark.slow), 2.0])
def test_a_heavy_handle_is_given_the_time_that_it_swings(m):
    """On 200 N/m a handle of 2 kg takes 0.63 s a period, on the first wall, of 20 N/m, 2 s."""
    heavy = paddle(m=m)
    found = largest_stiffness(heavy, search=hl.measure.Search(tolerance=0.1))
    assert found.K < hl.stability_limit(heavy).K <= found.chatters_at < 1.1 * found.K
    assert found.trials[0].duration >= 10 * 2 * math.pi * math.sqrt(m / 20.0)


def test_a_motor_of_little_force_does_not_hide_the_limit():
    """Force at its limit turns growth into a cycle, onto which a larger entry decays."""
    weak = paddle(force_max=0.1)
    for push in (None, 0.09):
        found = largest_stiffness(weak, push=push, search=hl.measure.Search(first=100.0, tolerance=0.1))
        assert 0.9 * hl.stability_limit(weak).K < found.K < hl.stability_limit(weak).K
    with pytest.raises(hl.errors.AnalysisError, match="push of 0.2 N .* 0.1 N at most: .* as push=0.025"):
        largest_stiffness(weak, push=0.2)


def test_a_tremor_is_no_chatter():
    tremor = hl.Hand(m=0.1, b=5, k=500, intent=lambda t: 0.01 + 0.0005 * np.sin(2 * np.pi * 9 * t))
    held = paddle(hand=tremor)
    found = largest_stiffness(
        held,
        search=hl.measure.Search(first=9000.0, growth=1.2, tolerance=0.2),
        judged=hl.measure.Judgement(duration=1.0, longest=1.0),
    )
    assert found.K < hl.stability_limit(held).K < found.chatters_at <= 1.2 * found.K
    assert "pressed with 5 N" in found.about  # 500 N/m times 10 mm, and none of the motor
    with pytest.raises(hl.errors.AnalysisError, match="noise of 0.1 N"):
        largest_stiffness(paddle(hand=hl.Hand(push=1.0, push_noise=0.1)))


def test_noise_of_the_sensor_gives_the_same_answer_on_a_board():
    """A simulated handle tells its noise; a board shows it where the handle rests in a softer wall."""
    noisy = paddle(b=1.0, noise=1e-5, counts_per_metre=78125)
    coarse = hl.measure.Search(first=200.0, growth=2.5, tolerance=1.5)
    options = {"search": coarse, "judged": hl.measure.Judgement(longest=1.0)}
    with hl.connect("sim://hapkit", paddle=noisy) as board:
        both = [largest_stiffness(made, **options) for made in (noisy, board)]
    exact = hl.stability_limit(noisy).K
    assert all(0.6 * exact < found.K < exact for found in both)
    assert both[1].trials[0].scatter == pytest.approx(1e-5, rel=0.2)


def test_a_push_that_friction_holds_tells_nothing():
    found = largest_stiffness(paddle(coulomb=0.3))
    assert math.isnan(found.K) and "push harder" in str(found)


def test_a_damper_that_is_unstable_alone_is_not_tried():
    found = largest_stiffness(paddle(), B=-0.2)
    assert found.K == 0 and not found.trials and "no stiffness helps: B = -0.2 N s/m" in str(found)
    assert found.plot().axes[0].get_title() == "zoh: none stands"


def test_a_length_without_samples_is_refused_by_name():
    with pytest.raises(hl.errors.AnalysisError, match="duration = 0.001 s; a trial needs 128 samples, duration=0.128"):
        largest_stiffness(paddle(), judged=hl.measure.Judgement(duration=0.001))


@pytest.mark.slow  # what a buzz is called is in test_trials
def test_coulomb_friction_stands_what_the_linear_limit_forbids():
    """A push whose oscillation dies below 2 f_c: stuck, as the quantiser's condition K <= 2 f_c/count reads too."""
    sticky = paddle(coulomb=0.05)
    assert (
        largest_stiffness(sticky, search=hl.measure.Search(most=500.0, first=100.0), judged=hl.measure.Judgement(longest=1.0)).K
        > 1.5 * hl.stability_limit(sticky).K
    )


def test_the_same_call_on_a_board_finds_the_same():
    behind = paddle(counts_per_metre=1e6)
    with hl.connect("sim://hapkit", paddle=behind) as board:
        found = largest_stiffness(board, search=hl.measure.Search(first=100.0, tolerance=0.1))
        state = board.state()
    assert found.K == pytest.approx(hl.stability_limit(behind).K, rel=0.1)
    assert state["force"] == 0  # the motor is off
    assert found.theory["passivity"].K == pytest.approx(200.0, rel=1e-6)  # from what the board keeps of itself


def test_a_scene_of_ones_own_and_its_parameter():
    stiffness = hl.parameters("s", units="N/m")
    scene = hl.Scene(force=hl.when(hl.x(hl.n) >= 0, stiffness * hl.x(hl.n)), name="mine")
    found = largest_stiffness(
        paddle(), law=scene, parameter="s", search=hl.measure.Search(tolerance=0.1), judged=hl.measure.Judgement(longest=2.0)
    )
    assert found.K == pytest.approx(200.0, rel=0.1) and found.theory == {} and found.law == "mine"
    with pytest.raises(hl.errors.PaddleError, match="no parameter k to search; it has s"):
        largest_stiffness(paddle(), law=scene)
    with pytest.raises(hl.errors.PaddleError, match="no parameter B"):
        largest_stiffness(paddle(), law=scene, parameter="s", B=1.0)
    with pytest.raises(hl.errors.AnalysisError, match="growth > 1"):
        largest_stiffness(paddle(), search=hl.measure.Search(growth=1.0))
    with pytest.raises(hl.errors.AnalysisError, match="0 < first < most"):
        largest_stiffness(paddle(), search=hl.measure.Search(first=1e6))


def scripted(limit, hidden=math.inf):
    """A trial that stands below a limit; from ``hidden`` on only a long one sees the chatter."""

    def trial(K, duration):
        stands = limit > K and (duration < 4 or hidden > K)
        return Trial(K, stands, "", 0.0, None, 0.0, duration)

    return trial


def test_a_hand_that_pulls_away_is_refused_with_the_push_that_would_do():
    with pytest.raises(hl.errors.AnalysisError, match="off the wall with 2 N; needs a push: push=2.2"):
        largest_stiffness(paddle(hand=hl.Hand(push=-2.0)))


@pytest.mark.slow
def test_a_buzz_of_one_encoder_count_does_not_stand():
    """Abbott and Okamura: passive up to K = min(2 b/T, 2 f_c/count); beyond, a rest is met or not, as the push falls."""
    coarse = paddle(b=0.5, counts_per_metre=1 / 0.5e-3, coulomb=0.02)
    found = largest_stiffness(coarse, judged=hl.measure.Judgement(longest=1.0), search=hl.measure.Search(tolerance=0.1))
    assert 2 * 0.02 / 0.5e-3 < found.chatters_at < 1000.0  # 80 N/m; 2 b/T alone is 1000
    assert any("one encoder count" in trial.verdict for trial in found.trials)


@pytest.mark.parametrize("limit", [0.5, 21.0, 333.0, 98765.0])
def test_the_search_encloses_any_limit(limit):
    trials, good, bad = searched(scripted(limit), 20.0, hl.measure.Search(), lengths)
    assert good < limit <= bad <= good * 1.02 and any(t.K == good and t.duration == 4.0 for t in trials)


def test_a_chatter_that_only_a_long_trial_sees_lowers_the_answer():
    trials, good, bad = searched(scripted(1000.0, hidden=700.0), 20.0, hl.measure.Search(), lengths)
    assert good < 700.0 <= bad <= good * 1.02
    assert trials[-1].duration == 4.0


def test_the_ends_of_a_search():
    assert searched(scripted(0.0), 20.0, hl.measure.Search(), lengths)[1:] == (0.0, pytest.approx(0.2))
    assert searched(scripted(1e9), 20.0, hl.measure.Search(), lengths)[1:] == (1e5, math.inf)


def test_the_picture_has_trials_and_limits():
    trials, good, bad = searched(scripted(333.0), 20.0, hl.measure.Search(), lengths)
    figure = LargestStiffness(good, bad, trials, "zoh", theory={"stability": hl.stability_limit(paddle())}).plot()
    axes = figure.axes[0]
    labels = axes.get_legend_handles_labels()[1]
    assert labels[:2] == ["comes to rest", "chatters"] and any("stability" in text for text in labels)
    assert "N/m" in axes.get_ylabel() and np.isfinite(axes.get_ylim()).all()
