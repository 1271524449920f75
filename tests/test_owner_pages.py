"""The pages for owners say what the code does: every fault has its section, every promise its code, its test and its time."""

import ast
import importlib.util
import re
from pathlib import Path

import pytest
from faults import FAULTS as FAULTS_PUT_IN
from pico_faults import PICO_FAULTS

from hapticlab.device.board.streaming import LEASH
from hapticlab.device.bring_up.steps import table
from hapticlab.device.link.messages import FAULTS, RESULTS
from hapticlab.device.wirings import BUILDS, build

ROOT = Path(__file__).parents[1]
FAULTS_PAGE, GUIDE, SAFETY, BOARDS = (
    (ROOT / "docs" / "paddle" / name).read_text("utf-8") for name in ("faults.md", "owners_guide.md", "SAFETY.md", "boards.md")
)


@pytest.fixture(scope="module")
def pages():
    """The script that writes what the pages take from code."""
    spec = importlib.util.spec_from_file_location("owner_pages", ROOT / "tests" / "benchmarks" / "owner_pages.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


@pytest.fixture(scope="module")
def stated(pages):
    """The times that tests/firmware/faults.py states, {fault: "2 ms"}."""
    return {name: pages.stated(fault) for name, fault in FAULTS_PUT_IN.items()}


def sections(page):
    """{heading: text} of a page's sections."""
    parts = re.split(r"^## (.+)$", page, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def rows(text):
    """The cells of every row of a table below its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines if not line.startswith("| ---")][1:]


class TestFaults:
    @pytest.mark.parametrize("name", FAULTS)
    def test_it_has_the_words_a_reason_three_causes_and_a_command(self, pages, name):
        text = sections(FAULTS_PAGE)[name]
        assert pages.fault_quotes()[name] in text, "python tests/benchmarks/owner_pages.py writes it"
        assert "**Why:**" in text and re.findall(r"^(\d)\. ", text, re.M) == ["1", "2", "3"]
        assert "`" in text.split("\nCommand: ")[1]

    def test_no_other_section_is_a_fault(self):
        assert [name for name in sections(FAULTS_PAGE) if name.isupper() and name not in FAULTS] == []

    def test_the_words_of_a_rejected_start_are_the_boards(self):
        named = {word for row in rows(sections(FAULTS_PAGE)["When a board rejects a start"]) for word in row[0].split(", ")}
        assert named <= set(RESULTS) and {"NOT_WIRED", "NOT_HOMED", "NOT_CALIBRATED", "HOT", "ALIAS"} <= named


class TestSafety:
    def test_every_code_and_every_test_that_is_named_exists(self):
        paths = re.findall(r"`((?:firmware|hapticlab|tests)/[\w/.]+)(?:::(\w+))?`", SAFETY + GUIDE)
        assert len(paths) > 40
        for path, test in paths:
            assert (ROOT / path).exists(), path
            assert not test or f"def {test}(" in (ROOT / path).read_text("utf-8"), f"{path}::{test}"

    def test_every_time_of_a_promise_is_the_one_that_is_stated(self, pages, stated):
        quoted = [row[2] for row in rows(sections(SAFETY)["Promises"]) if len(row) == 6]
        named = set()
        for time in quoted:
            match = re.fullmatch(r"([\d.]+ ms) \(`([^`]+)`(, after `LEASH`)?(, Pico)?\)", time)
            if match is None:
                assert time in ("same sample", "always", "as above")
                continue
            more = 1e3 * LEASH if match[3] else 0
            of_pico = match[4] is not None
            said = pages.stated(PICO_FAULTS[match[2]]) if of_pico else stated[match[2]]
            assert float(match[1].split()[0]) == float(said.split()[0]) + more, time
            named |= set() if of_pico else {match[2]}
        assert named == set(stated)

    @pytest.mark.parametrize("board, table", [("Uno", FAULTS_PUT_IN), ("Pico", PICO_FAULTS)], ids=["Uno", "Pico"])
    def test_measured_times_are_of_every_fault_and_below_what_is_stated(self, pages, board, table):
        found = {name: times for name, *times in rows(pages.block(pages.SAFETY, f"stop times of the {board}"))}
        assert list(found) == list(table), "python tests/benchmarks/owner_pages.py --measure writes them"
        for name, (said, time) in found.items():
            assert said == pages.stated(table[name])
            assert 0 <= float(time.split()[0]) <= float(said.split()[0])

    def test_forces_speeds_and_energies_are_those_of_the_settings(self, pages):
        assert pages.block(pages.SAFETY, "profiles") == pages.profile_rows()

    def test_it_says_first_what_cannot_be_promised(self):
        assert "Software is no emergency stop. The switch in the supply of the motor is." in SAFETY[:200]
        assert "must read this page" in SAFETY and "sign" in SAFETY


class TestEveryPage:
    DOCS = ROOT / "docs"
    PAGES = (*sorted((DOCS / "paddle").glob("*.md")), DOCS / "tutorial/paddle_on_the_desk.md", DOCS / "how_to/troubleshooting.md")

    @pytest.mark.parametrize("page", [page for page in PAGES if page.name != "index.md"], ids=lambda page: page.stem)
    def test_it_says_at_the_top_that_nothing_was_on_a_bench(self, page):
        top = page.read_text("utf-8")[:1200]  # written out, because a reader of the wheel sees no included file
        assert re.search(r"Nothing here was tried on a bench|\*\*Nothing [a-z ]+ was on a bench", top)

    @pytest.mark.parametrize("name", BUILDS)
    def test_the_pins_of_a_wiring_are_those_of_the_firmware(self, name):
        line = next(line for line in BOARDS.splitlines() if line.startswith("| ") and f"`{name}`" in line)
        pins = [int(pin) for pin in re.findall(r"\b(?:D|GP)(\d+)", line)]
        wiring = build(name).wiring
        if wiring.drive != "SHIFT_REGISTER":  # the shield fixes its pins
            assert set(wiring.motor_pins) <= set(pins)
            assert ("enable" in line) == (wiring.drive == "TWO_INPUTS_ENABLE")


class TestGuide:
    def test_the_steps_are_those_of_the_bench(self, pages):
        assert pages.block(pages.GUIDE, "steps of the bench") == table()

    def test_texts_that_a_user_may_read_are_those_of_the_package(self):
        said = "\n".join(
            "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in getattr(node, "values", [node]))
            for path in (ROOT / "hapticlab" / "device").rglob("*.py")
            for node in ast.walk(ast.parse(path.read_text("utf-8")))
            if isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))
        )
        texts = [row[0].strip("`") for row in rows(sections(GUIDE)["Symptoms"].split("### Texts")[1])]
        assert len(texts) > 10 and [text for text in texts if text not in said] == []

    def test_at_most_five_projects_are_drawn_on(self):
        peers = {name.split("/")[0] for name in re.findall(r"([\w-]+/[\w-]+)#\d+", GUIDE)}
        assert peers == {"Klipper3d", "mjbots", "odriverobotics", "scottbez1", "simplefoc"}
