"""Pages of a class as a browser shows them: narrow and wide, light and dark, readable by everybody."""

import pytest
from axe import findings

from hapticlab.course.concepts.inventory import questions
from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.grading.concepts.class_summary import summary
from hapticlab.grading.concepts.pages import write_concept_pages
from hapticlab.grading.concepts.paper import Paper
from hapticlab.grading.pages.pages import write_pages
from hapticlab.grading.report import ExerciseReport, Failing, Report

LAB = Lab("02", "Walls", 90, (
    Exercise("the_work_of_a_held_force", points=2, asks="F [N] at k [N/m]", cases=(Case({}, 1.0),)),
    Exercise("discussion", "text", asks="why the wall chatters"),
))  # fmt: skip
FAILING = Failing({"x": [0.0, 0.001, 0.002, 0.003], "k": 200.0}, [0.0, 2.0, 4.0, 6.0], [0.0, 1.0, 2.0, 3.0], "N", public=True)
WRONG = ExerciseReport(
    "the_work_of_a_held_force", "function", "F [N] at k [N/m]", 2.0, answered=True, cases=3, words="4 of 4 numbers differ",
    slip="The spring is twice as stiff as it should be.", hint="Which spring acts?", failing=FAILING,
)  # fmt: skip
SAID = ExerciseReport("discussion", "text", "why the wall chatters", answered=True, text="The held force is late. " * 12)
NAMES = ("ben_partly", "Anna-Maria Gutenberg-Lindqvist", "kovalevskaya")


@pytest.mark.wide
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_cut_or_broken_and_axe_finds_nothing_serious(browser, tmp_path, scheme):
    cells = ((3, "NameError in line 2: name 'math' is not defined"),)
    reports = [Report(name, "02", "Walls", "w.ipynb", cells=cells, exercises=(WRONG, SAID)) for name in NAMES]
    paths = write_pages(reports, tmp_path, lab=LAB)
    page = browser.new_page(color_scheme=scheme)
    for width in (390, 1280):
        page.set_viewport_size({"width": width, "height": 800})
        for path in paths[:2]:
            page.goto(path.as_uri())
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            lines = "[...document.querySelectorAll('bdi, code')].map((one) => [one.textContent, one.getClientRects().length])"
            assert not [text for text, count in page.evaluate(lines) if count > 1 and " " not in text]
            assert findings(page) == []
    page.close()


@pytest.mark.wide
def test_pages_of_concepts_fit_and_axe_finds_nothing_serious(browser, tmp_path):
    wrong = {name: next(iter(question.wrong)) for name, (_, question) in questions().items()}
    papers = [[Paper(name, {**wrong, **dict.fromkeys(list(wrong)[:right], "")}) for name in NAMES] for right in (3, 20)]
    papers[1].append(Paper("dan", problem="it is not a notebook"))
    paths = write_concept_pages(summary(*papers), papers[1], tmp_path)
    for scheme, width in (("light", 1280), ("dark", 390)):
        page = browser.new_page(color_scheme=scheme, viewport={"width": width, "height": 800})
        for path in (paths[0], paths[-1]):
            page.goto(path.as_uri())
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            assert findings(page) == []
        if width == 1280:  # what is folded on a screen is open on paper
            page.goto(paths[0].as_uri())
            folded = page.locator("details table tbody tr").last
            assert not folded.is_visible()
            page.emulate_media(media="print")
            assert folded.is_visible()
        page.close()
