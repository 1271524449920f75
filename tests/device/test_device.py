"""The numbers that a limit reads: of a paddle, of its profile, of a board, or given alone."""

from functools import partial

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.limits.linear_law import LinearLaw

T = 1e-3
LAW = LinearLaw.of("zoh", K=150.0, T=T)
WALL = hl.wall(unilateral=None)(k=150)
LIMITS = {
    "b": [
        hl.passivity_limit, hl.stability_limit, hl.stability.damper_limit, hl.stability.root_locus, hl.bounds.gil,
        hl.bounds.table, hl.bounds.abbott_okamura, hl.bounds.diolaiti, partial(hl.bounds.diolaiti_plane, K=150),
        partial(hl.passivity.ledger, K=150), hl.design.coupler, partial(hl.design.admittance, servo=0.01),
        lambda device: hl.passivity.margin(device, LAW),
        lambda device: hl.passivity.nyquist_disk(device, LAW), hl.design.compensation,
        lambda device: hl.design.digital_gains(device, K=150),
    ],
    "T": [
        hl.passivity_limit, hl.stability_limit, hl.stability.damper_limit, hl.design.coupler, partial(hl.passivity.ledger, K=150),
        partial(hl.passivity.wall_damping, K=150), lambda device: hl.passivity.port(device, WALL),
        lambda device: hl.passivity.port_damping(device, WALL),
    ],
    "m": [hl.stability_limit, hl.stability.damper_limit, hl.bounds.gil, hl.bounds.table],
}  # fmt: skip


@pytest.mark.parametrize(("name", "limit"), [(name, limit) for name, limits in LIMITS.items() for limit in limits])
def test_a_number_that_is_not_known_is_asked_for(name, limit):
    numbers = {"m": 0.05, "b": 0.1, "T": T}
    del numbers[name]
    with pytest.raises(AnalysisError, match=rf"^the device has no {name}; needs hl\.Device\({name}=\.\.\., \.\.\.\)$"):
        limit(hl.Device(**numbers))


def test_the_delay_of_a_paddle_is_never_left_out():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=1e-3)
    numbers = hl.Device(m=0.05, b=0.1, T=T, delay=1e-3)
    assert hl.passivity_limit(paddle).K == hl.passivity_limit(numbers).K == pytest.approx(200 / 3)
    assert hl.passivity.wall_damping(paddle, K=200 / 3) == pytest.approx(0.1)
    assert hl.passivity.port_damping(paddle, hl.wall(unilateral=None)(k=200 / 3)) == pytest.approx(0.1)
    assert hl.passivity.margin(paddle, LAW).required == pytest.approx(1.5 * 150 * T)
    assert hl.stability_limit(paddle).K == hl.stability_limit(hl.Device(m=0.05, b=0.1, T=T, delay=1e-3)).K < 100


def test_a_profile_and_a_board_have_their_numbers():
    """A board has mass and damping once they were identified."""
    eth = hl.devices.profile("eth")
    assert hl.passivity_limit(eth).K == 2 * eth.b / eth.T
    with hl.connect("sim://hapkit") as paddle:
        kept = paddle.settings
        assert (kept.m > 0) == (paddle.device.m is not None) and paddle.device.T == paddle.T
        if kept.m:
            assert hl.passivity_limit(paddle).K == pytest.approx(2 * kept.b / paddle.T)


def test_a_law_of_another_period_is_refused():
    with pytest.raises(AnalysisError, match="is a law with T = 0.001 s, but the paddle samples every 0.002 s"):
        hl.passivity.margin(hl.Device(b=0.1, T=2e-3), LAW)


@pytest.mark.parametrize("given", [{"b": -0.1}, {"m": 0}, {"velocity": "guessed"}, {"delay": None}])
def test_what_is_no_device(given):
    with pytest.raises(PaddleError, match=next(iter(given))):
        hl.Device(**given)
