"""One attack of every sort and the holes there were, graded in this process: all others are in test_attacks.py."""

import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="namespaces are Linux'; elsewhere there are only limits")

if sys.platform == "linux":
    from attacks import eating, ending, forging, injecting, leaking, spying
    from attacks.arena import ALWAYS, QUICK, Arena
    from attacks.test_attacks import check

    FEW = [one for one in QUICK if one.name in ALWAYS]
    FEW += [next(one for one in QUICK if one in sort.ATTACKS and one not in FEW) for sort in (eating, ending, forging, spying)]
    FEW += [next(one for one in QUICK if one in sort.ATTACKS) for sort in (injecting, leaking)]


def test_a_few_earn_what_is_honest_of_them_and_reach_nothing(here, tmp_path):
    with Arena(tmp_path, FEW) as arena, here():
        graded = arena.graded(workers=1)
        found = arena.by_attack(graded)
        assert graded.walls.level == "namespaces" and set(found) == {one.name for one in FEW}
        for one in FEW:
            check(one, found[one.name])
        assert not arena.reached()
