"""docs/paddle/wire_a_driver.md: its wirings, its kinds of drivers and its answers are those of `hapticlab calibrate`."""

import re
import shlex
from pathlib import Path

from hapticlab.cli.options import parser
from hapticlab.compiler.boards.board_pins import PINS
from hapticlab.device.setup.built import DRIVE_KEYS, OTHER, ask_built
from hapticlab.device.wiring import Wiring, pin_problem
from hapticlab.device.wirings import BUILDS

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "paddle" / "wire_a_driver.md").read_text("utf-8")


def test_known_drivers_are_known_builds_with_a_drawing():
    drawn = re.findall(r"\| \[(\w+)\]\(images/wiring/\1\.svg\) \|$", PAGE, re.M)
    assert len(drawn) == 6 and set(drawn) <= set(BUILDS)
    answers = re.findall(r"^\| [^|]+ \| (Uno|Uno, Nano|Pico) \| `(\w+)`", PAGE, re.M)
    answers.remove(("Uno", OTHER))
    assert [BUILDS[name].board for _, name in answers] == [board.partition(",")[0].lower() for board, _ in answers]
    assert [name for _, name in answers] == drawn


def test_the_wires_of_an_l298_are_those_of_the_calibration():
    (wires,) = re.findall(r"^<!-- wires of l298 -->\n```text\n(.*?)^```$", PAGE, re.M | re.S)
    assert wires.splitlines() == BUILDS["l298"].table()
    remarks = re.findall(r"^\* (.*)$", PAGE, re.M)
    assert len(remarks) == 2 and set(remarks) <= set(BUILDS["l298"].remarks())


def test_the_kinds_are_those_that_the_firmware_drives():
    assert f"answer `{OTHER}`" in PAGE
    kinds = dict(re.findall(r"\| ([A-Z_]{6,}) \| `(\w+)` \|", PAGE))
    assert kinds == {drive: key for key, drive in DRIVE_KEYS.items()}


class Reader:
    """A person who answers each question as the page does, and cannot answer another."""

    def __init__(self, lines):
        self.lines = list(lines)

    def ask(self, question):
        printed, answer = self.lines.pop(0).split("  ")
        assert question.startswith(printed)
        return answer

    def choose(self, question, options):
        answer = self.ask(question)
        assert answer in options
        return answer


def test_the_questions_about_another_driver_are_those_of_calibrate():
    (asked,) = re.findall(r"^```text\n(Which paddle.*?)^```$", PAGE, re.M | re.S)
    reader = Reader(asked.splitlines())
    assert ask_built(reader, "uno").wiring == Wiring("QUADRATURE", "TWO_INPUTS", (5, 6), (2, 3), 31_372)
    assert reader.lines == []


def test_pins_and_frequencies_are_those_of_the_boards():
    uno, pico = PINS["uno"], PINS["pico"]
    assert "PWM is on D3, D5, D6 and D11" in PAGE and {uno.names[pin] for pin in uno.pwm} == {"D3", "D5", "D6", "D11"}
    assert "62 500, 31 372 or 7 812 Hz on an Uno" in PAGE and uno.carriers[:3] == (62_500, 31_372, 7_812)
    assert "2 000 to 100 000 Hz on a Pico" in PAGE and (min(pico.carriers), max(pico.carriers)) == (2_000, 100_000)
    pairs = [(a, b) for a in uno.pwm for b in uno.pwm if a != b]
    fit = {pair for pair in pairs if pin_problem(Wiring("QUADRATURE", "TWO_INPUTS", pair, (2, 3)), uno) is None}
    assert {pin for pair in fit for pin in pair} == {5, 6, 11} and len(fit) == 6 and "two of D5, D6 and D11" in PAGE


def test_its_commands_are_understood():
    lines = [line for block in re.findall(r"^```sh\n(.*?)^```", PAGE, re.M | re.S) for line in block.splitlines()]
    assert len([parser().parse_args(shlex.split(line)[1:]) for line in lines]) == 5
