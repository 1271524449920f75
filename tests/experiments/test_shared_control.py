"""A tremor filter takes the tremor and leaves the reach; a fixture keeps out; both as the linear loop says."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import PaddleError
from hapticlab.experiments.shared_control import assistance

HAND = hl.Hand("pinch")
PADDLE = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=HAND)
REACH = hl.people.MinimumJerk(end=0.02, duration=1.0, begin=1.0)


class Rest:
    def at(self, t):
        return (0.0 * np.asarray(t),) * 3


def test_tremor_shrinks_as_the_loop_in_the_frequency_domain_says():
    # one sinusoid, 10 cycles in the record's second half; handle and hand in the s-domain, the band-pass in z, the hold as
    # half a period of delay: (M s^2 + (b+b_h) s + k) x = (b_h s + k) i - F
    B, f = 10.0, 8.0
    wave = hl.Scene(force=0 * hl.x(hl.n) * hl.parameters("k", units="N/m", values=1), name="free")
    found = assistance(
        PADDLE, [hl.laws.tremor_filter(centre=8, bandwidth=5)(B=B), wave], Rest(), record=5.0,
        tremor=lambda t: 3e-4 * np.sin(2 * np.pi * f * t),
    )  # fmt: skip
    s, z = 2j * np.pi * f, np.exp(2j * np.pi * f * 1e-3)
    M, b, k = 0.03 + HAND.m, 0.1 + HAND.b, HAND.k
    hold = (1 - 1 / z) / (s * 1e-3)
    filtered = (HAND.b * s + k) / (M * s**2 + b * s + k + B * s * hold)  # at its centre the filter passes all, in phase
    alone = (HAND.b * s + k) / (M * s**2 + b * s + k)
    settled = [np.ptp(row.log.x[4000:]) / 2 for row in found.rows]
    # the plant integrates the aliases away: 1e-3 is far above what is left of them, and of peaks between samples
    assert settled[0] == pytest.approx(3e-4 * abs(alone), rel=1e-3)
    assert settled[1] == pytest.approx(3e-4 * abs(filtered), rel=1e-3)
    assert abs(filtered) < 0.75 * abs(alone) and settled[2] == pytest.approx(settled[0], rel=1e-12)


def test_the_filter_leaves_a_slow_reach_alone_and_prints():
    alone, filtered = (found := assistance(PADDLE, [hl.laws.tremor_filter()(B=20)], REACH)).rows
    assert filtered.tremor < 0.35 * alone.tremor and filtered.error < 0.02 * 0.02
    assert filtered.work > 0 and alone.work == 0
    assert str(found).splitlines()[1].startswith("hand alone") and found.plot().axes[0].get_ylabel() == "handle position x [mm]"


def test_a_fixture_keeps_the_handle_out_and_guidance_leads_it():
    import sympy as sp

    region = hl.library.virtual_fixture()(k=0, k_w=1000, x_o=0.01)
    A, w = hl.parameters("A w", units="m 1/s", values=(0.01, 2.0))
    guided = hl.laws.guidance(A * sp.sin(w * hl.t))(k=300, b=2, F_max=0.8)
    found = assistance(PADDLE, [region, guided], REACH, tremor=lambda t: 0.0 * t)
    kept, led = found.rows[1].log, found.rows[2].log
    # at rest the hand's spring and the wall's share the way: k_h (0.02 - x) = k (x - 0.01)
    assert kept.x[-1] == pytest.approx((HAND.k * 0.02 + 1000 * 0.01) / (HAND.k + 1000), rel=1e-4)
    # the controller leads the resting hand, and where the hand goes its own way it gives no more than it has
    assert np.ptp(led.x[:1000]) > 0.003 and abs(led.F).max() == pytest.approx(0.8, rel=1e-6)
    assert led.x[-1] == pytest.approx(0.02 - 0.8 / HAND.k, rel=1e-5)


def test_a_band_pass_has_its_gain_and_its_edges():
    # the filter's own answer to a sinusoid of velocity: 1 at the centre, half the power at edges bandwidth apart
    program = hl.compile(hl.laws.tremor_filter(centre=9, bandwidth=4)(B=1), T=1e-3, dtype="float64", velocity="measured")
    from hapticlab.compiler.engines.engine import load

    def gain(f):
        t = np.arange(4000) * 1e-3
        F = load(program).run(4000, np.column_stack([0 * t, np.sin(2 * np.pi * f * t)]), [[1.0]])[0][-1000:, 0, 0]
        t = t[-1000:]
        fit = np.linalg.lstsq(np.column_stack([np.sin(2 * np.pi * f * t), np.cos(2 * np.pi * f * t)]), F, rcond=None)[0]
        return np.hypot(*fit)

    w = 2 * np.pi * 1e-3
    widening = np.tan(w * 4 / 2)
    # half the power where cos u - cos(w 9) = +-widening sin u
    middle, reach = np.cos(w * 9) / np.hypot(1, widening), np.arctan(widening)
    edges = [(np.arccos(middle) + s * reach) / w for s in (-1, 1)]
    assert edges[1] - edges[0] == pytest.approx(4.0, rel=1e-6)
    assert [gain(9.0), gain(edges[0]) ** 2, gain(edges[1]) ** 2] == pytest.approx([1.0, 0.5, 0.5], rel=1e-5)


def test_a_hand_is_needed():
    with pytest.raises(PaddleError, match="assistance needs a hand that holds"):
        assistance(hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3), [], REACH)


@pytest.mark.parametrize(("given", "T"), [({}, 0.1), ({"bandwidth": 600}, 1e-3), ({"centre": 990}, 1e-3)])
def test_a_filter_above_half_the_sampling_rate_leaves_the_motor_off(given, T):
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=T).run(hl.laws.tremor_filter(**given)(B=1), duration=20 * T, v=0.01)
    assert "was not finite; the motor is off" in log.fault and not log.F.any()
