"""The project's face: citation, changelog, container, supported versions, release checklist, and the pages of benchmarks."""

import datetime
import importlib.util
import json
import re
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

import hapticlab as hl

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
CHANGELOG = (ROOT / "CHANGELOG.md").read_text("utf-8")
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
VERSIONS = (ROOT / "docs/project/versions.md").read_text("utf-8")
RELEASING = (ROOT / "docs/project/releasing.md").read_text("utf-8")
RELEASES = dict(re.findall(r"^## \[([\w.]+)\](?: - (.+))?$", CHANGELOG, re.M))
CLASSIFIERS = [text.rpartition(" ")[2] for text in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", text)]


def module(path):
    """Return a script of the repository as a module."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    made = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = made  # dataclasses look there
    spec.loader.exec_module(made)
    return made


# ------------------------------------------------------------------------------------------------ citation and changelog


def test_the_citation_names_this_version_and_no_invented_person():
    assert CITATION["cff-version"] == "1.2.0" and CITATION["type"] == "software"
    assert CITATION.keys() >= {"message", "title", "authors"}  # what the format requires
    assert CITATION["version"] == hl.__version__ and CITATION["license"] == PROJECT["license"]
    assert [one["name"].lower() for one in CITATION["authors"]] == [one["name"].lower() for one in PROJECT["authors"]]
    # a chapter has no type of its own in version 1.2.0
    assert {one["type"] for one in CITATION["references"]} == {"generic"}


def test_citation_and_changelog_have_the_same_day_and_none_before_a_release():
    stated = RELEASES[hl.__version__]
    assert str(CITATION.get("date-released", "not released")) == stated
    if stated != "not released":
        datetime.date.fromisoformat(stated)


def test_the_changelog_has_the_form_of_keep_a_changelog():
    assert CHANGELOG.startswith("# Changelog\n")
    headings = re.findall(r"^## (.+)$", CHANGELOG, re.M)
    assert headings[0] == "[Unreleased]"
    assert [
        text for text in headings if not re.fullmatch(r"\[(Unreleased|\d+\.\d+\.\d+)\]( - (\d{4}-\d\d-\d\d|not released))?", text)
    ] == []
    versions = [tuple(map(int, name.split("."))) for name in RELEASES if name != "Unreleased"]
    assert versions == sorted(versions, reverse=True)  # the latest first
    for section in re.split(r"^## ", CHANGELOG, flags=re.M)[1:]:
        kinds = re.findall(r"^### (.+)$", section, re.M)
        order = [kind for kind in ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security") if kind in kinds]
        assert kinds == order, section.partition("\n")[0]  # each once, and nothing else


def test_the_wheel_has_the_licences_of_what_is_compiled_into_it():
    assert PROJECT["license-files"] == ["LICENSE", "firmware/prebuilt/LICENCES.txt"]
    text = (ROOT / "firmware/prebuilt/LICENCES.txt").read_text("utf-8")
    assert "\navr-libc\n" in text and "\nMinGW-w64 runtime\n" in text
    assert len(re.findall(r"Redistributions in binary form must reproduce the", text)) == 2  # the duty of each
    compiled = {path.name for path in (ROOT / "firmware/prebuilt").iterdir()} - {"LICENCES.txt"}
    assert [name for name in compiled if name not in text] == []  # each image is spoken of


# ------------------------------------------------------------------------------------------------ container


def test_the_container_installs_by_the_line_of_readme():
    text = (ROOT / ".devcontainer/devcontainer.json").read_text("utf-8")
    given = json.loads(re.sub(r"^//.*$", "", text, flags=re.M))
    line = next(
        line for line in (ROOT / "README.md").read_text("utf-8").splitlines() if line.endswith(".venv/bin/hapticlab labs")
    )
    assert given["postCreateCommand"] == f"{line} --no-open"
    assert re.fullmatch(r"mcr\.microsoft\.com/devcontainers/python:(3\.\d+)-bookworm", given["image"])[1] in CLASSIFIERS
    assert "was not started" in text


# ------------------------------------------------------------------------------------------------ versions and releasing


def test_supported_pythons_are_those_that_are_tried():
    stated = re.findall(r"^\| (3\.\d+) \| [\d-]+ \| [\d-]+ \| supported \|$", VERSIONS, re.M)
    assert stated == CLASSIFIERS == list(module(".ci/bounds.py").PYTHONS)
    assert PROJECT["requires-python"] == f">={stated[0]}"


def test_the_review_of_lower_bounds_has_every_package_as_it_is_bound():
    found = {str(name): str(bound) for name, bound in module(".ci/spec0.py").bounds(PROJECT).items()}
    assert {"numpy", "scipy", "matplotlib", "jupyterlab", "pandas"} <= found.keys()
    assert dict(re.findall(r"^\| ([\w-]+) \| (\d[\w.]*) \| \d{4}-", VERSIONS, re.M)) == found


def test_a_bound_may_rise_to_the_first_release_of_24_months():
    spec0, day = module(".ci/spec0.py"), datetime.date
    known = {"1.8": day(2023, 5, 1), "1.9": day(2024, 5, 1), "1.9.1": day(2025, 1, 1), "2.0": day(2025, 6, 1)}
    known = {spec0.Version(name): date for name, date in known.items()}
    assert str(spec0.may_rise_to(known, day(2026, 4, 30))) == "1.9"
    assert str(spec0.may_rise_to(known, day(2026, 6, 1))) == "2.0"  # a release of corrections, as 1.9.1, is no new bound
    assert str(spec0.may_rise_to(known, day(2030, 1, 1))) == "2.0"


def test_the_release_checklist_names_files_that_are_there():
    named = re.findall(r"`([\w./-]*/[\w./-]+\.\w+|\.ci/\w+|[A-Z]\w+\.(?:md|cff)|LICENSE|pyproject\.toml)", RELEASING)
    assert len(named) > 15
    made = {"dist/hapticlab-VERSION-py3-none-any.whl", "dist/hapticlab-VERSION.tar.gz"}
    assert [name for name in named if name not in made and not (ROOT / name).exists()] == []
    rows = [int(step) for step in re.findall(r"^\| (\d+)\. ", RELEASING, re.M)]
    assert rows == list(range(1, len(rows) + 1))
    assert "not released" not in RELEASES[hl.__version__] or RELEASING.count("| none |") >= 5


# ------------------------------------------------------------------------------------------------ benchmarks


@pytest.fixture(scope="module")
def report():
    return module("tests/benchmarks/report.py")


def test_every_page_of_benchmarks_says_first_where_a_peer_is_ahead_then_machine_date_and_command(report):
    for name, page in report.PAGES.items():
        text = (report.DOCS / f"{name}.md").read_text("utf-8")
        headings = re.findall(r"^## (.+)$", text, re.M)
        assert headings[0] == "Where a peer is ahead"
        assert headings[1:3] == ["What you can conclude, and what not", "Where this was measured"]
        rows = dict(re.findall(r"^\| ([\w ,]+) \| (.+) \|$", text, re.M))
        assert rows["processor"] and rows["cores"].isdecimal() and rows["load, before and after"]
        datetime.date.fromisoformat(rows["date"])
        assert rows["command"].startswith(f"`python tests/benchmarks/{page.script}") and "hapticlab" in rows["packages"]
        assert f"(benchmarks/{name}.md)" in (ROOT / "docs/README.md").read_text("utf-8")


def row(what, value, unit="s"):
    return {"what": what, "value": value, "unit": unit, "note": "", "ratio": None, "target": [], "met": []}


def test_a_peer_is_ahead_where_it_beats_all_of_ours_for_the_same_thing(report):
    steps = [
        row("wall: C by hand", 2.0),
        row("wall: hapticlab llvm", 3.0),
        row("wall: hapticlab vm", 1.0),
        row("wall: numba", 0.5),
    ]
    other = [row("mass: hapticlab llvm", 9.0), row("mass: numba", None), row("mass: PyDy", 9.5), row("mass: numba", 1.0, "MB")]
    (said,) = report.running_ahead({"sections": {"steps; a note": [*steps, *other]}})
    assert said == "steps: wall: numba needs 0.5 of hapticlab's time (hapticlab vm)"


def test_ratios_of_models_are_collected_by_size(report, monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tests/benchmarks")
    sizes = {
        1: {"run: hapticlab": 4.0, "run: A": 1.0, "run: B": 8.0},
        2: {"run: hapticlab": 4.0, "run: A": 2.0, "run: B": "> 60 s"},
    }
    (said,) = report.modelling_ahead({"Pendulum; links": sizes})
    assert said == "Pendulum, One RK4 step [ns]: A needs less, by the ratios 0.25 at 1, 0.50 at 2 links"


def test_a_page_is_written_with_its_machine(report):
    page = report.PAGES["running"]
    facts = {"date": "2026-01-31", "load, before and after": "0.1, 0.2"}
    quiet = report.written(page, "python x.py", facts, {"sections": {}}, "")
    busy = report.written(page, "python x.py", facts | {"load, before and after": "0.1, 7.0"}, {"sections": {}}, "")
    assert "Nowhere in what was measured." in quiet and "| command | `python x.py` |" in quiet
    assert "had other work" in busy and "had other work" not in quiet
    found = report.machine()
    assert found["cores"].isdecimal() and "numpy" in found["packages"] and found["Python"].startswith("CPython")
