"""The person at the terminal: lines typed, keys chosen, and nobody there."""

import pytest

from hapticlab.device.person import Person, agrees, number
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
    assert "'up' is none of left, right" in told


def test_a_number_may_have_a_comma(typing, capsys):
    assert number(typing("90,5"), "Travel [mm]?", low=5, high=1000) == 90.5
    assert number(typing("", "inf", "2000", "12"), "Travel [mm]?", low=5, high=1000) == 12.0
    told = capsys.readouterr().out.splitlines()
    assert told == ["'' is no number", "inf: needs a number from 5 to 1000", "2000: needs a number from 5 to 1000"]


def test_only_yes_is_yes(typing):
    assert agrees(typing("yes"), "Store this?") is True
    assert agrees(typing("y", "", "no"), "Store this?") is False


def test_nobody_there_is_told(typing):
    with pytest.raises(PaddleError, match="nobody answers here.*terminal"):
        typing().ask("Press Enter.")
    with pytest.raises(PaddleError, match="nobody answers here"):
        agrees(typing("perhaps"), "Store this?")
