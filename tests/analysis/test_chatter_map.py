"""A small form of the map of tests/benchmarks/chatter_map.py: verdicts against exact limit cycles, from above and below."""

import importlib.util
from pathlib import Path

import pytest

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
    ends = [(v.ends_at, exact) for _, d, _, exact, v in found if d >= 4 and exact and v.ends_at and v.state == "chatter"]
    assert len(ends) >= 5
    for (low, high), exact in ends:
        assert 0.95 * low < exact < 1.05 * high


def test_a_decay_onto_a_cycle_is_chatter_in_two_seconds():
    """1.5, 2 and 3 times the exact limit, from three times the height: 'it dies out' would be wrong."""
    plant = chatter_map.Plant(m=0.05, b=0.3, T=1e-3, push=1.0)
    limit = chatter_map.border(plant, "plain")
    for ratio in (1.5, 2.0, 3.0):
        case = chatter_map.Case(plant, "plain", ratio * limit, ratio, -0.03)
        states = [found.state for _, found in chatter_map.verdicts(case, chatter_map.recorded(case, 4.0), (1.0, 2.0, 4.0))]
        assert states[0] in ("chatter", "undecided") and states[1:] == ["chatter", "chatter"]
