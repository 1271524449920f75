"""A small form of the map of tests/benchmarks/chatter_map.py: verdicts against exact limit cycles, from above and below."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl

pytest.importorskip("llvmlite")  # some ten thousand ticks
_SPEC = importlib.util.spec_from_file_location("chatter_map", Path(__file__).parents[1] / "benchmarks" / "chatter_map.py")
chatter_map = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(chatter_map)


def test_verdicts_agree_with_exact_limit_cycles():
    """None is wrong; at 4 s all are decided, and what is called chatter ends at the exact cycle's amplitude."""
    plant = chatter_map.Plant(m=0.05, b=0.5, T=1e-3, push=1.0, k=50.0)
    counts, found = chatter_map.measured((plant,), laws=("plain", "a sample late"), ratios=(0.8, 1.2, 2.0), seconds=16.0)
    assert sum(counts.values()) == 120 and not any(o == "wrong" for *_, o in counts)
    assert not any(o == "undecided" and duration >= 4 for _, duration, _, o in counts)
    ends = [
        (v.ends_at, exact.amplitude) for _, d, _, exact, v in found if d >= 4 and exact and v.ends_at and v.state == "chatter"
    ]
    assert len(ends) >= 5
    for (low, high), exact in ends:
        assert 0.95 * low < exact < 1.05 * high
    settled = [(e, v) for _, d, _, e, v in found if e and v.locked]
    assert len(settled) >= 5
    for exact, verdict in settled:
        assert verdict.contacts_per_second == pytest.approx(exact.rate, rel=4e-3)


@pytest.mark.wide
def test_a_map_over_many_plants():
    """Of 960 verdicts none is wrong, and at 4 s at most 5 % are undecided."""
    plants = (chatter_map.PLANTS[2], chatter_map.PLANTS[5], *chatter_map.random_plants(number=1, seed=11))
    counts, _ = chatter_map.measured(plants, ratios=(0.7, 0.93, 1.13, 1.7), seconds=20.0)
    at_4 = {key: n for key, n in counts.items() if key[1] == 4}
    assert sum(counts.values()) >= 500 and not any(o == "wrong" for *_, o in counts)
    assert sum(n for (*_, o), n in at_4.items() if o == "undecided") <= 0.05 * sum(at_4.values())


@pytest.mark.slow
def test_the_whole_map():
    counts, _ = chatter_map.measured()
    assert sum(counts.values()) == 5600 and not any(o == "wrong" for *_, o in counts)


def test_a_decay_onto_a_cycle_is_chatter_in_two_seconds():
    """1.5, 2 and 3 times the exact limit, from three times the height: 'it dies out' would be wrong."""
    plant = chatter_map.Plant(m=0.05, b=0.3, T=1e-3, push=1.0)
    limit = chatter_map.border(plant, "plain")
    for ratio in (1.5, 2.0, 3.0):
        case = chatter_map.Case(plant, "plain", ratio * limit, ratio, -0.03)
        states = [found.state for _, found in chatter_map.verdicts(case, chatter_map.recorded(case, 4.0), (1.0, 2.0, 4.0))]
        assert states[0] in ("chatter", "undecided") and states[1:] == ["chatter", "chatter"]


@pytest.fixture
def heavy():
    """A handle of little damping: 0.17 kg, 0.11 N s/m."""
    return tuple(chatter_map.random_plants())[4]


@pytest.mark.wide
def test_verdicts_on_a_heavy_handle_of_little_damping(heavy):
    """Decays take longer than the records: none is wrong."""
    options = {"ratios": (0.87, 1.13), "seconds": 20.0}
    counts, _ = chatter_map.measured((heavy,), (1.0, 4.0), laws=("plain", "backward difference"), **options)
    assert sum(counts.values()) == 40 and not any(o == "wrong" for *_, o in counts)
    assert sum(n for (_, duration, _, o), n in counts.items() if o == "undecided" and duration == 4) <= 5


def test_a_backward_difference_has_a_cycle_beside_rest(heavy):
    K = 0.87 * chatter_map.border(heavy, "backward difference")
    beside = chatter_map.Case(heavy, "backward difference", K, 0.87, -9 * heavy.push / K)  # falls onto a cycle beside rest
    (_, cycle), *_ = chatter_map.verdicts(beside, chatter_map.recorded(beside, 4.0), (4.0,))
    assert cycle.state == "chatter" and cycle.inside_growth < 0


@pytest.mark.parametrize("law", list(chatter_map.LAWS))
@pytest.mark.parametrize("ratio", [0.95, 1.05])
@pytest.mark.always("1.05-*")
def test_growth_inside_the_wall_is_the_exact_eigenvalue(law, ratio):
    plant = chatter_map.Plant(m=0.12, b=0.4, T=1e-3, push=1.0)
    K = ratio * chatter_map.border(plant, law)
    found = hl.chatter(chatter_map.recorded(chatter_map.Case(plant, law, K, ratio, -2 * plant.push / K), 2.0))
    exact = abs(np.linalg.eigvals(chatter_map.period_map(plant, law, K, True)[0])).max()
    assert found.inside_growth == pytest.approx((exact - 1) / plant.T, rel=1e-6)


def test_an_encoder_or_friction_hides_the_growth_inside():
    plant = chatter_map.Plant(m=0.12, b=0.4, T=1e-3, push=1.0)
    for impure in ({"counts_per_metre": 1e5}, {"coulomb": 0.01}):
        paddle = hl.SimulatedPaddle(m=plant.m, b=plant.b, T=plant.T, hand=hl.Hand(push=plant.push), **impure)
        log = paddle.run(hl.wall()(k=1.3 * chatter_map.border(plant, "plain")), duration=2.0, x=-1e-3, progress=False)
        assert np.isnan(hl.chatter(log).inside_growth)
