"""The search on the paddle, against the exact stability limit of the same handle, hand and delay."""

import itertools
import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.measurement.borders import Border, searched
from hapticlab.measurement.largest_stiffness import LargestStiffness, largest_stiffness
from hapticlab.measurement.trials import Trial

pytest.importorskip("llvmlite")  # some hundred thousand ticks
T = 1e-3


def lengths(K):
    return 1.0, 4.0, 16.0


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
def test_both_borders_enclose_the_exact_limit(law, changes):
    """Without encoder and friction a handle that stays in the wall is the linear system, and a wall that rests is quiet."""
    tried = paddle(**changes)
    found = largest_stiffness(tried, law=law, search=hl.measure.Search(first=100.0))
    exact = hl.stability_limit(tried, law=law).K
    assert 0.985 * exact < found.K <= found.unstable.highest < exact < 1.015 * found.fails_at
    assert found.K == min(found.unstable.lowest, found.buzz.lowest) == float(found)
    assert found.theory["stability"].K == exact


def heavy(b, **changes):
    """A handle and a hand of 0.35 kg, 300 N/m and 2 N s/m beside b, pressed on a wall with 5 N."""
    return hl.SimulatedPaddle(m=0.3, b=b, T=T, hand=hl.Hand(m=0.05, b=2.0, k=300.0, push=5.0), **changes)


@pytest.mark.parametrize(("b", "exact"), [(0.5, 5006.0), (2.0, 8016.0), (8.0, 20097.0)])
@pytest.mark.always("0.5-*")
def test_the_unstable_border_is_the_exact_limit_within_one_percent(b, exact):
    found = largest_stiffness(heavy(b))
    assert hl.stability_limit(heavy(b)).K == pytest.approx(exact, abs=1.0)
    assert found.unstable.lowest == pytest.approx(exact, rel=0.01) and found.unstable.highest == pytest.approx(exact, rel=0.01)
    assert float(found) == pytest.approx(exact, rel=0.01)


ONE = hl.measure.Starts(run_ups="1 mm", within_count=2)
COARSE = hl.measure.Search(first=300.0, tolerance=0.1)


@pytest.mark.wide
def test_more_damping_does_not_look_worse_behind_an_encoder():
    """100 um per count, no dry friction: one count buzzes at any damping, and the unstable border is the exact limit's."""
    little, much = (largest_stiffness(heavy(b, counts_per_metre=1e4), starts=ONE, search=COARSE) for b in (0.5, 8.0))
    assert 0.8 * 5006 < little.unstable.lowest < 5006 and 0.8 * 20097 < much.unstable.lowest < 20097
    for found in (little, much):  # steps of K count; a square wave of them has the power of a sinusoid of K count / sqrt(2)
        assert 0.7 < found.buzz.lowest / (0.05 * math.sqrt(2) / 1e-4) < 1.5
        assert any(t.outcome == "buzzes" and t.K == 1012.5 for t in found.trials)  # dithers for ever by 0.1 N


def held(**changes):
    return hl.SimulatedPaddle(
        **{"m": 0.05, "b": 0.5, "T": T, "counts_per_metre": 5e4, "hand": hl.Hand("pinch", push=2.0), **changes}
    )


WIDENS = {
    "damping": ("unstable", [{"b": 0.2}, {"b": 2.0}, {"b": 5.0}]),
    "damping, buzz": ("buzz", [{"b": 0.2}, {"b": 2.0}]),
    "encoder": ("buzz", [{"counts_per_metre": 1e4}, {"counts_per_metre": 2e4}, {"counts_per_metre": 5e4}]),
    "rate": ("unstable", [{"T": 2e-3}, {"T": 1e-3}, {"T": 5e-4}]),
    "rate, buzz": ("buzz", [{"T": 2e-3}, {"T": 5e-4}]),
    "friction": ("buzz", [{"counts_per_metre": 1e4}, {"counts_per_metre": 1e4, "coulomb": 0.05}]),
}


@pytest.mark.parametrize("name", WIDENS)
@pytest.mark.always("damping, buzz")
def test_what_widens_the_z_width(name):
    """As Colgate and Brown (1994) measured: damping of the device, a finer encoder, a faster rate."""
    border, changes = WIDENS[name]
    found = [getattr(largest_stiffness(held(**each), starts=ONE, search=COARSE), border).lowest for each in changes]
    assert all(b > 1.15 * a for a, b in itertools.pairwise(found)), found


@pytest.mark.parametrize("B", [5.0, pytest.param(20.0, marks=pytest.mark.wide)])
def test_a_filtered_velocity_widens_where_the_damper_buzzes_and_narrows_where_it_destabilises(B):
    """Brown (1995): a count of 20 um is B count/T in the force, 0.1 N at 5 N s/m. What the filter's lag takes is stability."""
    laws = ["zoh", hl.wall(velocity=hl.velocity.filtered(tau=8e-3))]
    plain, filtered = (largest_stiffness(held(), law, B=B, starts=ONE, search=COARSE) for law in laws)
    assert filtered.K > 3 * plain.K and filtered.unstable.lowest < 0.6 * plain.unstable.lowest


@pytest.mark.wide
def test_where_there_is_no_damper_there_is_nothing_to_filter():
    laws = ["zoh", hl.wall(velocity=hl.velocity.filtered(tau=8e-3))]
    plain, filtered = (largest_stiffness(held(), law, starts=ONE, search=COARSE).K for law in laws)
    assert plain == filtered


def test_hands_and_pushes_make_an_interval():
    hands = [hl.Hand("pinch", grip=grip, push=2.0) for grip in (0.5, 2.0)]
    limits = [hl.stability_limit(held(counts_per_metre=None, hand=hand)).K for hand in hands]
    found = largest_stiffness(held(counts_per_metre=None), starts=hl.measure.Starts(hands=hands))
    assert found.unstable.K == pytest.approx(np.repeat(limits, 2), rel=0.015)  # for each hand two run-ups
    assert (found.unstable.lowest, found.unstable.highest) == pytest.approx(limits, rel=0.015)
    pushed = largest_stiffness(paddle(), starts=hl.measure.Starts(run_ups=0, pushes=[0.1, "0.3 N"]), search=COARSE)
    assert {t.start for t in pushed.trials if t.K >= 100} >= {"0.1 N, from 0 mm before it", "0.3 N, from 0 mm before it"}
    with hl.connect("sim://hapkit") as board, pytest.raises(hl.errors.AnalysisError, match="hold the handle in another way"):
        largest_stiffness(board, starts=hl.measure.Starts(hands=hands))
    with pytest.raises(hl.errors.AnalysisError, match=r"one run-up, and hands such as hl.Hand\('pinch'\)"):
        hl.measure.Starts(run_ups=[])


def test_no_trial_goes_further_than_one_ratio_beyond_what_stood():
    found = largest_stiffness(paddle(), judged=hl.measure.Judgement(longest=1.0), search=hl.measure.Search(tolerance=0.1))
    stood = found.trials[0].K
    for trial in found.trials:
        assert trial.K <= 1.5 * stood * (1 + 1e-9)
        stood = max(stood, trial.K) if trial.rests else stood


def test_without_damping_no_stiffness_stands():
    """Each period a held spring adds energy; in softer walls it takes longer to see, and three swings at least."""
    found = largest_stiffness(paddle(b=0.0))
    assert found.K == 0 and "no stiffness comes to rest quietly" in str(found)
    assert found.fails_at == pytest.approx(0.2)
    short = largest_stiffness(paddle(b=0.0), judged=hl.measure.Judgement(longest=1.0))
    assert math.isnan(short.K) and "undecided" in str(short)
    assert any("needs Judgement(longest=3" in t.verdict for t in short.trials)
    assert "undecided" in short.plot().axes[0].get_legend_handles_labels()[1]


@pytest.mark.parametrize("m", [pytest.param(1.0, marks=pytest.mark.slow), 2.0])
def test_a_heavy_handle_is_given_the_time_that_it_swings(m):
    """On 200 N/m a handle of 2 kg takes 0.63 s a period, on the first wall, of 20 N/m, 2 s."""
    heavy = paddle(m=m)
    found = largest_stiffness(heavy, starts=hl.measure.Starts(run_ups=0), search=hl.measure.Search(tolerance=0.1))
    assert found.K < hl.stability_limit(heavy).K <= found.fails_at < 1.1 * found.K
    assert found.trials[0].duration >= 10 * 2 * math.pi * math.sqrt(m / 20.0)


def test_a_motor_of_little_force_does_not_hide_the_limit():
    """Force at its limit turns growth into a cycle, onto which a larger entry decays."""
    weak = paddle(force_max=0.1)
    for starts in (hl.measure.Starts(), hl.measure.Starts(pushes=0.09)):
        found = largest_stiffness(weak, starts=starts, search=hl.measure.Search(first=100.0, tolerance=0.1))
        assert 0.9 * hl.stability_limit(weak).K < found.K < hl.stability_limit(weak).K
    with pytest.raises(hl.errors.AnalysisError, match="push of 0.2 N .* at most 0.1 N:.* as Starts.pushes=0.025"):
        largest_stiffness(weak, starts=hl.measure.Starts(pushes=0.2))


def test_a_tremor_is_no_chatter():
    tremor = hl.Hand(m=0.1, b=5, k=500, intent=lambda t: 0.01 + 0.0005 * np.sin(2 * np.pi * 9 * t))
    held = paddle(hand=tremor)
    found = largest_stiffness(
        held,
        starts=hl.measure.Starts(run_ups=0),
        search=hl.measure.Search(first=9000.0, growth=1.2, tolerance=0.2),
        judged=hl.measure.Judgement(duration=1.0, longest=1.0),
    )
    assert found.unstable.lowest < hl.stability_limit(held).K < found.unstable.fails_at[0] <= 1.2 * found.unstable.lowest
    assert "pressed with 5 N" in found.about  # 500 N/m times 10 mm, and none of the motor
    with pytest.raises(hl.errors.AnalysisError, match="noise of 0.1 N"):
        largest_stiffness(paddle(hand=hl.Hand(push=1.0, push_noise=0.1)))


@pytest.mark.wide
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
    assert math.isnan(found.K) and "push harder" in found.trials[0].verdict


def test_a_damper_that_is_unstable_alone_is_not_tried():
    found = largest_stiffness(paddle(), B=-0.2)
    assert found.K == 0 and not found.trials and "no stiffness is stable: B = -0.2 N s/m" in str(found)
    assert found.plot().axes[0].get_title() == "stiffest wall, law zoh: none comes to rest quietly"


def test_a_length_without_samples_is_refused_by_name():
    with pytest.raises(
        hl.errors.AnalysisError, match="duration = 0.001 s; a trial needs at least 128 samples, so duration needs to be 0.128 s"
    ):
        largest_stiffness(paddle(), judged=hl.measure.Judgement(duration=0.001))


@pytest.mark.slow  # what a buzz is called is in test_trials
def test_coulomb_friction_stands_what_the_linear_limit_forbids():
    """A push whose oscillation dies below 2 f_c: stuck, as the quantiser's condition K <= 2 f_c/count reads too."""
    sticky = paddle(coulomb=0.05)
    assert (
        largest_stiffness(sticky, search=hl.measure.Search(most=500.0, first=100.0), judged=hl.measure.Judgement(longest=1.0)).K
        > 1.5 * hl.stability_limit(sticky).K
    )


@pytest.mark.parametrize(
    ("starts", "longest"),
    [(hl.measure.Starts(run_ups=0, within_count=1), 4.0), (hl.measure.Starts(), 16.0)],  # from 1 mm it bounces for longer
    ids=["few", "all"],
)
@pytest.mark.always("few")
def test_the_same_call_on_a_board_finds_the_same(starts, longest):
    behind, judged = paddle(counts_per_metre=1e6), hl.measure.Judgement(longest=longest)
    with hl.connect("sim://hapkit", paddle=behind) as board:
        found = largest_stiffness(board, starts=starts, search=hl.measure.Search(first=150.0, tolerance=0.1), judged=judged)
        state = board.state()
    assert found.unstable.lowest == pytest.approx(hl.stability_limit(behind).K, rel=0.1)
    assert state["force"] == 0  # the motor is off
    assert found.theory["passivity"].K == pytest.approx(200.0, rel=1e-6)  # from what the board keeps of itself


def test_a_scene_of_ones_own_and_its_parameter():
    stiffness = hl.parameters("s", units="N/m")
    scene = hl.Scene(force=hl.when(hl.x(hl.n) >= 0, stiffness * hl.x(hl.n)), name="mine")
    found = largest_stiffness(
        paddle(), law=scene, parameter="s", search=hl.measure.Search(tolerance=0.1), starts=hl.measure.Starts(run_ups=0)
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
    """A trial that rests below a limit; from ``hidden`` on only a long one sees the chatter. And all that were made."""
    made = []

    def trial(K, duration):
        made.append(Trial(K, limit > K and (duration < 4 or hidden > K), None, "", duration=duration))
        return made[-1]

    return trial, made


def test_a_hand_that_pulls_away_is_refused_with_the_push_that_would_do():
    with pytest.raises(hl.errors.AnalysisError, match="off the wall with 2 N; needs a push: Starts.pushes=2.2"):
        largest_stiffness(paddle(hand=hl.Hand(push=-2.0)))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"paddle": None}, "a NoneType has no program; needs a paddle"),
        ({"paddle": hl.Device(m=0.05, b=0.1, T=1e-3)}, "a Device has no program; needs a paddle"),
        ({"starts": 3}, "starts = 3; needs hl.measure.Starts"),
        ({"search": "fast"}, "search = 'fast'; needs hl.measure.Search"),
        ({"place": "here"}, "place = 'here'; needs .* m"),
        ({"judged": None}, "judged = None; needs hl.measure.Judgement"),
        ({"starts": hl.measure.Starts(pushes=-1)}, "the push pulls the handle off the wall with 1 N; .*pushes=0.2"),
    ],
)
def test_what_is_no_paddle_or_no_option_is_refused_in_words(given, words):
    with pytest.raises(hl.errors.HapticlabError, match=words):
        largest_stiffness(**{"paddle": paddle()} | given)


def test_a_start_takes_one_value_or_several():
    hand = hl.Hand("pinch")
    assert hl.measure.Starts(hands=hand).hands == (hand,) and hl.measure.Starts(run_ups="1 mm").run_ups == (1e-3,)
    for wrong in ({"run_ups": None}, {"hands": "pinch"}, {"hands": 3}):
        with pytest.raises(hl.errors.AnalysisError, match="a start needs"):
            hl.measure.Starts(**wrong)


def test_friction_keeps_a_count_quiet():
    """Diolaiti: what sticks does not dither up to K = 2 f_c/count, 80 N/m here; beyond, it depends on where it rests."""
    coarse = paddle(b=0.5, counts_per_metre=1 / 0.5e-3, coulomb=0.02)
    found = largest_stiffness(coarse, judged=hl.measure.Judgement(longest=1.0), search=hl.measure.Search(tolerance=0.1))
    assert 70 < found.buzz.lowest < found.fails_at < 1000.0
    assert any(trial.outcome == "buzzes" for trial in found.trials)


@pytest.mark.parametrize("limit", [0.5, 21.0, 333.0, 98765.0])
def test_the_search_encloses_any_limit(limit):
    trial, made = scripted(limit)
    good, bad = searched(trial, "rests", 20.0, hl.measure.Search(), lengths)
    assert good < limit <= bad <= good * 1.01 and any(t.K == good and t.duration == 4.0 for t in made)


def test_a_chatter_that_only_a_long_trial_sees_lowers_the_answer():
    trial, made = scripted(1000.0, hidden=700.0)
    good, bad = searched(trial, "rests", 20.0, hl.measure.Search(), lengths)
    assert good < 700.0 <= bad <= good * 1.01
    assert made[-1].duration == 4.0


def test_the_ends_of_a_search():
    assert searched(scripted(0.0)[0], "rests", 20.0, hl.measure.Search(), lengths) == (0.0, pytest.approx(0.2))
    assert searched(scripted(1e9)[0], "rests", 20.0, hl.measure.Search(), lengths) == (1e5, math.inf)


def test_the_picture_has_trials_borders_and_limits():
    trials = [
        Trial(K, rests, quiet, "") for K, rests, quiet in ((100.0, True, True), (150.0, True, False), (200.0, False, False))
    ]
    borders = Border((150.0, 160.0), (200.0, 200.0)), Border((100.0, 120.0), (150.0, 150.0))
    found = LargestStiffness(*borders, tuple(trials), "zoh", theory={"stability": hl.stability_limit(paddle())})
    axes = found.plot().axes[0]
    labels = axes.get_legend_handles_labels()[1]
    assert labels[:3] == ["comes to rest quietly", "comes to rest, buzzes", "does not come to rest"]
    assert any("stability" in text for text in labels) and "N/m" in axes.get_ylabel() and len(axes.patches) == 2
    assert "comes to rest up to 150 to 160 N/m over 2 starts" in str(found) and float(found) == 100.0
