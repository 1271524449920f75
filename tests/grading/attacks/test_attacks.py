"""Attackers beside honest students in one run: each earns what is honest of it, and nobody feels the others."""

import json
import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="namespaces are Linux'; elsewhere there are only limits")

if sys.platform == "linux":
    from attacks.arena import ATTACKS, HONEST, QUICK, Arena
    from attacks.small_lab import POINTS

#: what moves a cursor or turns the reading direction
HARMFUL = {chr(code) for code in (*range(9), *range(11, 32), 0x7F, 0x9B, 0x202E, 0x2066)}


@pytest.fixture(scope="module")
def arena(tmp_path_factory):
    with Arena(tmp_path_factory.mktemp("arena"), QUICK) as made:
        yield made


@pytest.fixture(scope="module")
def graded(arena):
    return arena.graded()


@pytest.fixture(scope="module")
def reports(arena, graded):
    return arena.by_attack(graded)


def test_the_corpus_is_what_it_says():
    assert len({one.name for one in ATTACKS}) == len(ATTACKS) >= 200
    assert len(HONEST) > 10 and all(one.earned == 10 == sum(POINTS.values()) for one in HONEST)
    assert sum(one.earned == 0 for one in QUICK) >= 10
    assert len({one.lost for one in QUICK}) > 10


def test_there_are_walls(graded):
    assert graded.level == "namespaces"


def test_everybody_is_graded(reports):
    assert set(reports) == {one.name for one in QUICK}


@pytest.mark.parametrize("attack", QUICK, ids=lambda one: ascii(one.name)[1:-1])
def test_each_earns_what_is_honest(reports, attack):
    check(attack, reports[attack.name])


def check(attack, report):
    lost = {one.name for one in report.exercises if one.earned != one.points}
    said = {one.name: (one.words, one.ended) for one in report.exercises}
    assert lost == set(attack.lost), {name: said[name] for name in lost ^ set(attack.lost)}
    assert report.earned == attack.earned and report.points == 10
    assert {name: said[name][1] for name in attack.ended} == attack.ended
    assert bool(report.problem) == attack.unreadable, report.problem
    assert len(report.to_json()) < 300_000


def test_nothing_outside_was_reached(graded, arena):
    assert not arena.reached()


def test_honest_reports_are_the_same_without_attackers(reports, tmp_path):
    with Arena(tmp_path, HONEST) as arena:
        alone = arena.by_attack(arena.graded(workers=1))
    assert {name: report.to_json() for name, report in alone.items()} == {one.name: reports[one.name].to_json() for one in HONEST}


def test_reports_are_plain_text(graded):
    for report in graded.reports:
        held = json.loads(report.to_json())
        texts = [held["student"], held["submission"], held["problem"], *(words for _, words in held["cells"])]
        texts += [one[name] for one in held["exercises"] for name in ("words", "slip", "text", "printed", "hint")]
        for text in texts:
            text.encode()
            assert not set(text) & HARMFUL, (report.student, text)


@pytest.mark.slow
def test_all_attacks_at_once(tmp_path):
    with Arena(tmp_path, ATTACKS) as arena:
        graded = arena.graded()
        found = arena.by_attack(graded)
        assert set(found) == {one.name for one in ATTACKS}
        for one in ATTACKS:
            check(one, found[one.name])
        assert not arena.reached()
