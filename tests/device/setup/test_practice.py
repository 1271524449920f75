"""The board to practise on: calibration finds what is true of it, for any tosses."""

from datetime import date

import pytest

import hapticlab as hl
from hapticlab.device.setup import sign_check


def test_a_question_that_the_simulated_person_does_not_know_is_told():
    _, person = hl.devices.practice_board()
    with pytest.raises(hl.errors.PaddleError, match="no answer to: Move the handle slowly to the left stop and press Enter"):
        person.ask("Move the handle slowly to the left stop and press Enter")


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
