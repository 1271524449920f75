"""The board to practise on: calibration finds what is true of it, for any tosses."""

from datetime import date

import pytest

import hapticlab as hl
from hapticlab.device.setup import sign_check
from hapticlab.device.wiring import Wiring


def test_a_question_that_the_simulated_person_does_not_know_is_told():
    _, person = hl.devices.practice_board()
    with pytest.raises(hl.errors.PaddleError, match="no answer to: Move the handle slowly to the left stop and press Enter"):
        person.ask("Move the handle slowly to the left stop and press Enter")


@pytest.mark.always("dead band-*")
@pytest.mark.parametrize(
    ("trouble", "words"),
    [
        ("wrong wiring", "board D6       driver EN"),
        ("loose wire", "only one line of the encoder arrives"),
        ("sensor direction", "A and B of the encoder were swapped since the calibration"),
        ("dead band", "no force below 12.0 % duty, the dead band"),
    ],
)
def test_a_calibration_finds_the_trouble_and_cures_it(trouble, words, monkeypatch, capsys):
    monkeypatch.setattr(sign_check.secrets, "randbits", lambda _: 5)
    board, person = hl.devices.practice_board(trouble)
    kept = hl.calibrate(board, person)
    assert words in capsys.readouterr().out
    truth = board.exchange.port.settings
    assert Wiring.of(kept) == Wiring.of(truth)
    assert (kept.wired, kept.checked) == (1, 1)
    assert kept.force_full == pytest.approx(7.0, rel=0.01) and kept.duty_dead == pytest.approx(truth.duty_dead, abs=0.005)
    direction = -1 if trouble == "sensor direction" else 1  # the walls stay on the right
    assert kept.metres_per_count == pytest.approx(12.1e-6 * direction, rel=1e-3)


def test_a_trouble_that_is_none_lists_those_there_are():
    with pytest.raises(hl.errors.PaddleError, match="trouble = 'smoke'; a practice board has one of motor wires, wrong wiring"):
        hl.devices.practice_board("smoke")


@pytest.mark.always("1")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_calibration_finds_the_constants_and_the_swapped_wires(seed, monkeypatch, capsys):
    monkeypatch.setattr(sign_check.secrets, "randbits", lambda _: seed)
    board, person = hl.devices.practice_board()
    assert (board.settings.metres_per_count, board.settings.force_full) == pytest.approx((12.8e-6, 8.0))
    began = date.today()
    kept = hl.calibrate(board, person)
    assert (kept.motor_sign, kept.checked) == (-board.exchange.port.settings.motor_sign, 1)
    assert kept.metres_per_count == pytest.approx(12.1e-6, rel=1e-3)
    assert kept.force_full == pytest.approx(7.0, rel=0.005)
    assert f"{began:%Y%m%d}" <= str(kept.date) <= f"{date.today():%Y%m%d}"
    assert "its two wires are swapped" in capsys.readouterr().out
