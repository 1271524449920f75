"""The person at the terminal: lines typed, keys chosen, and nobody there."""

import pytest

from hapticlab.device.setup.person import Person, agrees, number
from hapticlab.errors import PaddleError


@pytest.fixture
def typing(monkeypatch):
    """Somebody who types these lines; then the terminal is closed."""

    def types(*lines):
        rest = iter(lines)

        def reads(question):
            try:
                return next(rest)
            except StopIteration:
                raise EOFError from None

        monkeypatch.setattr("builtins.input", reads)
        return Person()

    return types


def test_a_choice_is_repeated_until_it_is_one(typing, capsys):
    person = typing("up", " RIGHT ")
    assert person.choose("On which side?", {"left": "", "right": "towards the window"}) == "right"
    told = capsys.readouterr().out
    assert "On which side?" in told and "towards the window" in told
    assert "'up' is not one of left, right" in told


def test_a_number_may_have_a_comma(typing, capsys):
    assert number(typing("90,5"), "Travel [mm]?", low=5, high=1000) == 90.5
    assert number(typing("", "inf", "2000", "12"), "Travel [mm]?", low=5, high=1000) == 12.0
    told = capsys.readouterr().out.splitlines()
    assert told == ["'' is not a number", "inf: needs a number from 5 to 1000", "2000: needs a number from 5 to 1000"]


@pytest.mark.parametrize(("typed", "meant"), [("yes", True), ("Y", True), ("no", False), ("n", False)])
def test_yes_and_no_may_be_a_letter(typing, typed, meant):
    assert agrees(typing("", "ye", "1", typed), "Store this?") is meant


def test_a_letter_that_two_options_begin_with_is_asked_again(typing, capsys):
    options = {"wall": "", "weight": "", "away": ""}
    assert typing("w", "weight").choose("Which?", options) == "weight"
    assert "'w' is not one of wall, weight, away" in capsys.readouterr().out
    assert typing("a").choose("Which?", options) == "away"


def test_nobody_there_is_told(typing):
    with pytest.raises(PaddleError, match="there is no keyboard input here.*terminal"):
        typing().ask("Press Enter.")
    with pytest.raises(PaddleError, match="there is no keyboard input here"):
        agrees(typing("perhaps"), "Store this?")
