"""Attackers beside honest students in one run: each earns what is honest of it, and nobody feels the others."""

import csv
import io
import json
import re
import sys
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from hapticlab.course.labs import load_lab
from hapticlab.grading import formats
from hapticlab.grading.pages.pages import write_pages

pytestmark = [
    pytest.mark.wide,  # test_few.py has one of each sort
    pytest.mark.skipif(sys.platform != "linux", reason="namespaces are Linux'; elsewhere there are only limits"),
]

if sys.platform == "linux":
    from attacks import injecting, leaking, resubmitting
    from attacks.arena import ATTACKS, HONEST, LIMITS, PATIENT, QUICK, Arena
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
    assert len({one.name for one in ATTACKS}) == len(ATTACKS) >= 300
    assert len({one.name for one in QUICK}) == len(QUICK) >= 60
    assert len(PATIENT) == 3 and not any(one.patience for one in QUICK)
    assert len(HONEST) > 10 and all(one.earned == 10 == sum(POINTS.values()) for one in HONEST)
    assert sum(one.earned == 0 for one in QUICK) >= 2 and len({one.lost for one in QUICK}) > 10


def test_there_are_walls(graded):
    assert graded.walls.level == "namespaces"


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


def test_who_waits_for_a_limit_of_time_loses_that_alone(here, tmp_path):
    with Arena(tmp_path, PATIENT) as arena, here():
        found = arena.by_attack(arena.graded(workers=1, limits=replace(LIMITS, seconds=1.0)))
    for one in PATIENT:
        check(one, found[one.name])


def test_honest_reports_are_the_same_without_attackers(reports, here, tmp_path):
    honest = [one for one in QUICK if one in HONEST]
    with Arena(tmp_path, honest) as arena, here():
        alone = arena.by_attack(arena.graded(workers=1))
    assert len(honest) >= 3
    assert {name: report.to_json() for name, report in alone.items()} == {one.name: reports[one.name].to_json() for one in honest}


def test_reports_are_plain_text(graded):
    for report in graded.reports:
        held = json.loads(report.to_json())
        texts = [held["student"], held["submission"], held["problem"], *(words for _, words in held["cells"])]
        texts += [one[name] for one in held["exercises"] for name in ("words", "slip", "text", "printed", "hint")]
        for text in texts:
            text.encode()
            assert not set(text) & HARMFUL, (report.student, text)


@pytest.mark.parametrize("name", [one for one, form in formats.FORMATS.items() if form.kind == "table" and not form.needs_roster])
def test_no_spreadsheet_runs_what_they_wrote(graded, name):
    cells = [cell for row in csv.reader(io.StringIO(formats.write(name, graded.reports))) for cell in row]
    assert "force" in "".join(cells) or name == "nbgrader"
    assert not [cell for cell in cells if cell[:1] in ("=", "+", "-", "@", "\t", "\r")]


def test_a_terminal_shows_what_they_wrote(graded):
    text = formats.write("text", graded.reports)
    assert text.count("\n") > len(QUICK) and not set(text) & HARMFUL


@pytest.mark.parametrize("name", [one for one, form in formats.FORMATS.items() if form.kind == "result"])
def test_other_systems_get_json(graded, name):
    for report in graded.reports:
        json.loads(formats.write(name, [report]), parse_constant=pytest.fail)


@pytest.mark.parametrize("name", [one for one, form in formats.FORMATS.items() if form.kind == "result"])
def test_who_hands_in_again_learns_no_hidden_given(arena, reports, name):
    for report in (reports[one.name] for one in leaking.ATTACKS):
        cases = arena.assignment.cases(report.student)["force"]
        public, *hidden = (case.given["k"] for case, told in sorted(cases, key=lambda one: not one[1]))
        hidden = [k for k in hidden if k != public]
        text = formats.write(name, [report])
        assert len(hidden) == 2 and not [k for k in hidden if repr(k)[:7] in text], report.student
        assert not [one.slip for one in report.exercises if "givens" in one.slip]
    told = [one.printed for one in reports["hidden_givens_printed"].exercises if one.name == "force"]
    assert "'k': 200.0" in told[0], "the attack works: a public case tells its own givens"


@pytest.mark.parametrize("attack", resubmitting.ATTACKS, ids=lambda one: one.name)
def test_who_hands_in_again_is_told_only_that_a_hidden_case_is_wrong(reports, attack):
    tests = json.loads(formats.write("gradescope", [reports[attack.name]]))["tests"]
    assert [one["output"] for one in tests if one["name"] == "force"] == [
        "A case that is not shown is wrong.\nHint: Outside there is no force."
    ]


class Page(HTMLParser):
    """Collects what a page would do beside showing text."""

    def __init__(self):
        super().__init__()
        self.active = []

    def handle_starttag(self, tag, attributes):
        if tag in ("script", "iframe", "object", "embed", "form", "base", "link"):
            self.active.append(tag)
        for name, value in attributes:
            elsewhere = not name.startswith("xmlns") and re.match(r"\s*(javascript|data|https?):", value or "")
            if name.startswith("on") or elsewhere:
                self.active.append(f"{tag} {name}={value}")


def test_no_page_runs_what_they_wrote(reports, arena, tmp_path):
    shown = [report for name, report in reports.items() if name in {one.name for one in injecting.ATTACKS}]
    write_pages(shown, tmp_path / "pages", lab=load_lab(arena.lab / "checks.py"))
    written = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    assert len(written) > len(shown) and all(path.is_relative_to(tmp_path / "pages") for path in written)
    for path in written:
        page = Page()
        page.feed(path.read_text("utf-8"))
        assert not page.active, path.name


@pytest.mark.slow
def test_all_attacks_at_once(tmp_path):
    with Arena(tmp_path, ATTACKS) as arena:
        graded = arena.graded()
        found = arena.by_attack(graded)
        assert set(found) == {one.name for one in ATTACKS}
        for one in ATTACKS:
            check(one, found[one.name])
        assert not arena.reached()
