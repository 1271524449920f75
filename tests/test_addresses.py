"""Every public name, argument, command, option, step of the doctor and fault is documented, and has an address on the site.

The pages are the generators' texts; that their anchors are in the HTML is checked where a site is built.
"""

import inspect
import re
from pathlib import Path

import pytest
from builder import arguments
from builder.anchors import expected
from builder.pages import chapter, commands, doctor, papers, public_names, reference, uses
from docutils.nodes import make_id

import hapticlab as hl
from hapticlab.device.link.messages import FAULTS
from hapticlab.device.setup.doctor import doctor as examine
from hapticlab.vocabulary import public

ROOT = Path(__file__).parents[1]
NAMES = list(public_names.own_names())


def undocumented(value):
    return sorted(set(arguments.in_signature(value)) - set(arguments.in_docstring(value)))


def test_every_public_name_has_a_page():
    assert {name.typed for name in NAMES} == set(public())
    assert len({name.document.lower() for name in NAMES}) == len(NAMES), "two pages that some disks would take for one"
    by_path = {name.path: name for name in NAMES}
    lists = {namespace: reference.namespace_page(namespace, by_path) for namespace in public_names.NAMESPACES}
    for name in NAMES:
        assert f":: {name.path}\n" in reference.described(name) + "\n"
        assert f"`{name.short} <{name.path}>`" in lists[name.namespace]
        assert f"\n{name.document.removeprefix('reference/')}\n" in lists[name.namespace]


@pytest.mark.wide
def test_every_page_says_where_its_name_is_used():
    pages = dict(reference.pages())
    assert len(pages) == len(NAMES) + len(public_names.NAMESPACES) + 1
    used = [name.typed for name in NAMES if "## Where it is used" in pages[name.document]]
    assert len(used) > 250
    assert "[Lab 06, virtual coupler](../../labs/06_virtual_coupler.md)" in pages["reference/design/coupler"]
    assert "tests/limits/test_passivity.py" in pages["reference/hl/passivity_limit"]


def test_every_public_name_says_what_it_is():
    """One line of its own, not that of the class that an object is of, nor that of another package."""
    silent = [name.typed for name in NAMES if not name.first_line]
    borrowed = [name.typed for name in NAMES if name.is_object and name.doc == inspect.getdoc(type(name.value))]
    assert silent == borrowed == []
    assert [f"{name.typed}.{short}" for name in NAMES for short, one in name.members.items() if not inspect.getdoc(one)] == []


def test_every_argument_is_documented():
    missing = {path: found for name in NAMES for path, value in public_names.callables(name) if (found := undocumented(value))}
    assert missing == {}


def test_a_documented_argument_is_one():
    """What a section Parameters describes can be given; what passes through ``**options`` can be, too."""
    wrong = {}
    for name in NAMES:
        for path, value in public_names.callables(name):
            taken = arguments.in_signature(value)
            found = set(arguments.in_docstring(value, ("Parameters",))) - set(taken)
            if found and not any(one.kind is one.VAR_KEYWORD for one in inspect.signature(value).parameters.values()):
                wrong[path] = sorted(found)
    assert wrong == {}


def test_an_argument_that_is_not_documented_is_found():
    def measure(scene, *, duration, limit=1.0):
        """Measure.

        Parameters
        ----------
        scene, limit : float
        """

    assert undocumented(measure) == ["duration"]
    assert arguments.in_signature(hl.plot)[:2] == ["names", "over"], "of a call with several signatures"
    assert set(arguments.in_docstring(hl.SimulatedPaddle)) >= {"duty_25", "duty_50", "duty_75"}, "described together"


def test_every_command_and_option_has_an_address():
    page = commands.page()
    made = commands.commands()
    assert {"demo", "run", "grade", "doctor", "site"} <= set(made)
    addresses = [commands.anchor(name) for name in made]
    addresses += [commands.anchor(name, action) for name, one in made.items() for action in commands.options(one)]
    assert len(addresses) == len(set(addresses)) > 100
    assert [one for one in addresses if f"({one})=" not in page and f".. _{one}:" not in page] == []
    assert [one for one in addresses if make_id(one) != one] == [], "an anchor of HTML"
    assert commands.anchor("grade", next(one for one in commands.options(made["grade"]) if one.dest == "output")) == (
        "hapticlab-grade-output"
    )
    assert not re.search(r"\.\. option:: .*\n\n   *\n", page), "an option without words"


def test_every_command_has_an_example_that_parses():
    made = commands.commands()
    assert [name for name in made if not commands.examples(name)] == []
    assert {0, 1, 2, 130, 141} == set(commands.EXITS)


def test_every_step_of_the_doctor_has_an_address():
    page, found = doctor.page(), doctor.checks()
    assert set(found) == set(doctor.STEPS)
    assert [step for step in doctor.STEPS if f"({doctor.anchor(step)})=" not in page] == []
    walked = [check.name for check in examine("sim://hapkit").checks]
    assert walked == [step for step in doctor.STEPS if step in walked], "in the order of the walk"
    assert ("ok", "… opens", "") in found["port"]
    states = {state for rows in found.values() for states, *_ in rows for state in states.split(" or ")}
    assert states == {"ok", "attention", "fault", "no board", "skipped"}


def test_every_fault_has_an_address():
    page = (ROOT / "docs/paddle/faults.md").read_text("utf-8")
    sections = re.findall(r"^## (\w+)$", page, re.M)
    assert set(FAULTS) <= set(sections) and len(sections) == len(set(sections))
    assert {make_id(code) for code in FAULTS} <= {make_id(section) for section in sections}


def test_every_equation_and_figure_of_the_chapter_has_an_address():
    page = (ROOT / "docs/reference/chapter.md").read_text("utf-8")
    assert re.findall(r"^\(eq-23-(\d+)\)=\n### Eq\. \(23\.\1\): ", page, re.M) == [str(one) for one in range(1, 11)]
    assert re.findall(r"^\(fig-23-(\d+)\)=\n### Fig\. 23\.\1: ", page, re.M) == [str(one) for one in range(1, 8)]


@pytest.mark.wide
def test_the_index_of_the_chapter_names_what_holds_each_equation():
    page = chapter.page()
    assert page.count("\n- Tests: ") >= 10
    held = {number: uses.citing(number, "equation") for number in range(1, 11)}
    assert all("tests/test_equations.py" in {text.address for text in kinds["tests"]} for kinds in held.values())
    assert {text.title for text in held[10]["names"]} >= {"hl.passivity_limit", "hl.passivity.worst_motion"}


@pytest.mark.parametrize(
    ("number", "weights"),
    [(5, hl.laws.BackwardDifferenceSpring.taps), (7, hl.laws.EllisSpring.taps), (8, hl.laws.EllisSpring.taps)],
)
def test_the_weights_that_are_typeset_are_those_that_run(number, weights):
    text = (ROOT / "docs/reference/chapter.md").read_text("utf-8")
    formula = text.split(f"(eq-23-{number})=")[1].split("$$")[1].partition("=")[2]
    typeset = [float(sign + one) for sign, one in re.findall(r"([-+]?)(\d[\d.]*)\\,[xF]", formula.replace(" ", ""))]
    assert tuple(typeset) == tuple(weights[: len(typeset)]) and not any(weights[len(typeset) :])


@pytest.mark.wide
def test_every_paper_is_indexed():
    page = papers.page()
    own = sorted(path.stem for path in (ROOT / "docs/papers").glob("*.md") if path.stem != "README")
    assert [stem for stem in own if f"({stem.replace('_', '-')})=" not in page] == []
    assert "hl.bounds.abbott_okamura" in page.split("(abbott-okamura-2005)=")[1].split("## ")[1]
    assert ("Mirtich and Canny", "1995") in papers.citations()


def test_what_the_site_must_have_counts_all():
    """As the check of a whole site asks for it."""
    asked = expected()
    assert len(asked) > 283 + 500 + 100
    assert ("reference/design/coupler.html", "hapticlab.design.coupler.b_c") in asked
    assert ("reference/hl/SimulatedPaddle.html", "hapticlab.SimulatedPaddle.run.duration") in asked
    assert ("reference/commands.html", "hapticlab-grade-lab") in asked
    assert ("paddle/faults.html", make_id("HOST_SILENT")) in asked
