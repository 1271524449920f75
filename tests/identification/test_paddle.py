"""A paddle identified by moving it: simulated, and on the firmware's core, with forces from below and within the travel."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.board.settings import changed, simulated
from hapticlab.device.link.serial_ports import open_port
from hapticlab.errors import AnalysisError

BODY = {"m": 0.03, "b": 0.1, "T": 1e-3, "coulomb": 0.05, "noise": 8e-6}
COUNTS = 1 / 12.8e-6


def check(found, **true):
    for name, value in true.items():
        assert abs(found[name].value - value) < 2 * found[name].half_width, name


@pytest.mark.wide
def test_a_simulated_paddle_tells_its_constants_within_its_travel():
    paddle = hl.SimulatedPaddle(**BODY | {"b": 0.5}, delay=1.3e-3, counts_per_metre=COUNTS, force_max=1.0)
    found = hl.identify.paddle(paddle, travel=0.012, kinds=("kick", "steps"))
    check(found, m=0.03, b=0.5, coulomb=0.05, delay=1.3e-3)
    assert found["m"].half_width < 5e-3 * 0.03
    assert [len(record.log) > 0 for record in found.records] == [True, True]
    assert max(np.abs(record.log.x).max() for record in found.records) < 0.012
    assert [record.added for record in found.loaded(0.02)] == [0.02, 0.02]


@pytest.mark.parametrize("seed", [20, 21, 22])
@pytest.mark.always("22")
def test_steps_of_one_size_do_not_lead_to_a_heavier_handle_that_friction_drives(seed):
    """Twice m and b with a friction of -0.265 N, the steps' size, moved alike where friction below zero was allowed."""
    paddle = hl.SimulatedPaddle(m=0.0906286, b=0.34069, T=1e-3, delay=1e-3, noise=5e-6, force_max=3.0, seed=seed)
    found = hl.identify.paddle(paddle, kinds=("steps",))
    check(found, m=0.0906286, b=0.34069, coulomb=0.0, delay=1e-3)
    assert found.converged and found["coulomb"].low >= 0


def test_records_of_a_simulated_paddle_have_noise_of_their_own():
    paddle = hl.SimulatedPaddle(**BODY, force_max=1.0)
    kick, steps = (record.log.x[:20] for record in hl.identify.paddle(paddle, kinds=("kick", "steps")).records)
    assert abs(np.corrcoef(kick, steps)[0, 1]) < 0.9  # both rest for as long


def test_a_paddle_that_does_not_move_is_told():
    paddle = hl.SimulatedPaddle(**BODY | {"coulomb": 2.0}, force_max=1.0)
    coarse = hl.SimulatedPaddle(**BODY, counts_per_metre=1e3)
    with pytest.raises(AnalysisError, match=r"travel = 8 mm; this encoder needs 22 mm, .*Give a larger travel="):
        hl.identify.paddle(coarse, travel=0.008)
    with pytest.raises(AnalysisError, match="1 N moves the handle by .* mm only; needs 1 mm.*nobody holds"):
        hl.identify.paddle(paddle)


def test_known_mass_and_records_belong_together():
    with pytest.raises(AnalysisError, match="Give added="):
        hl.identify.paddle(hl.SimulatedPaddle(**BODY), beside=(1,))


@pytest.mark.wide
def test_a_board_is_identified_by_the_same_call():
    pytest.importorskip("serial")
    paddle = hl.SimulatedPaddle(**BODY, delay=0.4e-3, counts_per_metre=COUNTS)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        found = hl.identify.paddle(board, kinds=("steps",), travel=0.02)
        assert board.state()["state"] == 0
    check(found, m=0.03, b=0.1, coulomb=0.05, delay=0.4e-3)
    assert found["m"].half_width < 1e-3 * 0.03


@pytest.mark.slow
def test_a_board_whose_force_is_not_what_it_reckons_is_found_out_by_a_known_mass():
    pytest.importorskip("serial")

    def moved(m, **more):
        body = hl.SimulatedPaddle(**BODY | {"m": m}, counts_per_metre=COUNTS)
        port, kept = open_port("sim://hapkit"), simulated(body)
        port.put_on(body, settings=changed(kept, force_full=0.8 * kept.force_full), store=kept.to_bytes())
        with hl.devices.SerialPaddle("sim://hapkit", port=port) as board:
            return hl.identify.paddle(board, kinds=("steps",), travel=0.02, **more)

    alone = moved(0.03)
    assert alone["m"].value == pytest.approx(0.03 / 0.8, rel=1e-3)  # as the board reckons its newtons
    found = moved(0.05, added=0.02, beside=alone.records)
    check(found, m=0.03, b=0.1, coulomb=0.05, scale=0.8)
    assert found["scale"].half_width < 0.01


def test_the_search_moves_a_coarse_encoder_by_enough_counts():
    """20 counts are 2 mm here, of which a twentieth of the travel is 0.4 mm."""
    coarse = hl.SimulatedPaddle.from_profile("hapkit_coarse", coulomb=0.05, noise=8e-6)
    found = hl.identify.paddle(coarse, kinds=("steps",), travel=0.008)
    assert 0.03 in found["m"] and 0.1 in found["b"] and 0.05 in found["coulomb"]
