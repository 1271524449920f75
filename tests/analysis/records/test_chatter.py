"""Chatter against oscillations whose amplitude, frequency and growth are known beforehand."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.records.chatter import chatter
from hapticlab.analysis.records.chatter_end import linear_trend
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError

T = 1e-3


def record(x, F=None, **channels):
    F = np.maximum(150 * x, 0) if F is None else F
    return Telemetry(t=np.arange(len(x)) * T, x=x, v=0 * x, F=F, T=T, channels=channels)


def oscillation(f=37.3, seconds=4.0, amplitude=0.8e-3, growth=0.0, at=0.0, phase=0.4):
    t = np.arange(round(seconds / T)) * T
    return at + amplitude * np.exp(growth * t) * np.sin(2 * np.pi * f * t + phase)


@pytest.mark.parametrize("f", [3.7, 37.3, 121.0, 333.3])
def test_a_sustained_sinusoid(f):
    found = chatter(record(oscillation(f=f)))
    assert found.state == "chatter" and found.locked and not found.dither
    assert found.frequency == pytest.approx(f, rel=T / 2.0)  # the error stated: one period T in half the record
    # between samples the peak is missed by at most 1 - cos(pi f T), when one cycle has few samples
    assert 0.8e-3 * math.cos(math.pi * f * T) <= found.amplitude <= 0.8e-3 * 1.001
    assert found.contacts_per_second == pytest.approx(f, rel=1e-3)  # of whole cycles
    assert abs(found.growth) < 1e-2


@pytest.mark.parametrize("growth, state", [(0.9, "growing"), (-0.9, "decaying"), (0.02, "growing"), (-0.02, "decaying")])
def test_growth_is_measured(growth, state):
    found = chatter(record(oscillation(growth=growth)))
    assert found.state == state and not found.locked
    assert found.growth == pytest.approx(growth, rel=2e-3)
    assert "not locked" in str(found) and ("run longer" if growth > 0 else "it dies out") in str(found)


def test_a_saturating_oscillation_has_locked_only_in_a_long_record():
    t = np.arange(8000) * T
    x = 1e-3 * np.tanh(1e-2 * np.exp(1.5 * t)) * np.sin(2 * np.pi * 25 * t)
    assert chatter(record(x[:3000])).state == "growing"
    settled = chatter(record(x))
    assert settled.state == "chatter"
    assert settled.amplitude == pytest.approx(1e-3, rel=2e-3)


def test_rest_and_drift_are_not_chatter():
    t = np.arange(4000) * T
    rest = chatter(record(0.012 * (1 - np.exp(-30 * t))))
    assert rest.state == "none" and rest.amplitude == 0 and rest.frequency is None
    assert str(rest).startswith("none: the handle rests at 12 mm")
    assert chatter(record(0.5 * t)).state == "none"  # it flew away
    slow = chatter(record(oscillation(f=0.5, seconds=4.0)))  # one cycle in the last half turns round, but tells no more
    assert slow.state == "undecided"
    assert not slow.locked
    assert chatter(record(oscillation(growth=-12.0))).state == "none"  # decayed to less than a nanometre


def test_drift_does_not_spoil_the_oscillation():
    t = np.arange(4000) * T
    found = chatter(record(oscillation() + 0.01 * t))
    assert found.state == "chatter"
    assert found.amplitude == pytest.approx(0.8e-3, rel=1e-2)
    assert found.frequency == pytest.approx(37.3, rel=5e-4)


def test_encoder_dither_is_named():
    count = 50e-6
    true = oscillation(f=20.0, amplitude=0.1e-6, at=0.01)
    sensed = np.floor(true / count) * count
    assert len(np.unique(sensed)) == 2
    found = chatter(record(sensed, x_true=true))
    assert found.dither and "dither of the encoder" in str(found)
    assert found.amplitude == pytest.approx(0.1e-6, rel=2e-3)  # the handle's own motion, not the count
    coarse = oscillation(amplitude=20 * count)
    assert not chatter(record(np.floor(coarse / count) * count, x_true=coarse)).dither


def test_an_irregular_limit_cycle_is_told_from_growth():
    """Ups and downs of 10 % without a trend are chatter; the same ups and downs on a real growth are growth."""
    t = np.arange(8000) * T
    uneven = 1 + 0.1 * np.sin(2 * np.pi * 0.7 * t + 1.0)
    carrier = 1e-3 * np.sin(2 * np.pi * 40 * t)
    steady = chatter(record(uneven * carrier))
    assert steady.state == "chatter" and steady.locked
    assert chatter(record(uneven * np.exp(0.3 * t) * carrier)).state == "growing"


def test_a_decay_onto_a_cycle_of_a_few_counts_is_not_sustained():
    """Between two and four counts a decay onto a smaller cycle is not sustained; that cycle itself is."""
    count, t = 13e-6, np.arange(2000) * T
    carrier = np.sin(2 * np.pi * 36 * t)

    def found(size):
        return chatter(record(np.round(size * carrier / count) * count, x_true=size * carrier))

    falls = np.interp(t, [1.0, 1.12, 1.25, 1.5, 1.75, 2.0], [20e-6, 16e-6, 8e-6, 8e-6, 9e-6, 8.5e-6])
    early = found(falls)
    assert (early.state, early.locked, early.levels_off) == ("decaying", False, True)
    assert "it may end in a cycle" in str(early)
    assert found(8e-6).state == "chatter"
    assert found(100 * falls).state in ("chatter", "undecided")  # of many counts, no exponential: it may fall again


def test_contacts_are_counted_from_the_force():
    x = oscillation(f=10.0)
    F = np.where(np.arange(len(x)) % 50 < 20, 1.0, 0.0)
    assert chatter(record(x, F=F)).contacts_per_second == pytest.approx(20.0, rel=1e-12)
    assert chatter(record(x, F=np.ones(len(x)))).contacts_per_second == 0


def test_short_and_broken_records_are_refused():
    with pytest.raises(AnalysisError, match="10 samples; chatter needs at least 32"):
        chatter(record(np.zeros(10)))
    x = oscillation()
    x[100] = np.nan
    with pytest.raises(AnalysisError, match="not finite"):
        chatter(record(x))


def test_a_few_large_bounces_are_growing_and_not_rest():
    """Thrown far off a wall much too stiff, the handle comes back only a few times in the last half."""
    found = chatter(record(oscillation(f=1.1, growth=0.8, amplitude=1e-2)))
    assert found.state == "growing"
    assert found.growth == pytest.approx(0.8, rel=0.2)  # with so few cycles the peaks fall anywhere in a quarter
    assert found.amplitude > 0.1


def test_a_handle_that_moves_on_is_not_said_to_rest():
    t = np.arange(4000) * T
    assert "drifts by 9.99 mm," in str(chatter(record(1e-2 * t)))
    assert "rests at 5 mm" in str(chatter(record(5e-3 + 0 * t)))


@pytest.mark.parametrize(("growth", "state"), [(0.78, "growing"), (-0.11, "decaying"), (0.0, "undecided")])
def test_less_than_three_cycles_a_quarter_are_judged_by_their_swings(growth, state):
    """A quarter with less than one cycle: its peak-to-peak would depend on phase alone."""
    for phase in np.linspace(0, 2 * np.pi, 9):
        found = chatter(record(oscillation(f=3.3, seconds=1.0, amplitude=0.04, growth=growth, phase=phase)))
        assert found.state in (state, "undecided")
        assert not found.locked
    x = oscillation(f=6.1, seconds=1.0, amplitude=0.04, growth=growth)
    assert chatter(record(x, F=150 * x + 10)).state == state  # never off the wall, where no cycle is
    assert chatter(record(x)).state == ("undecided" if growth <= 0 else state)


def test_growth_comes_with_its_error():
    """Four windows of a pure exponential agree; those of one that beats do not, and its growth is within their error."""
    pure = chatter(record(oscillation(growth=-0.02, seconds=8.0)))
    assert pure.growth_error < 2e-4 and pure.growth == pytest.approx(-0.02, abs=5 * pure.growth_error + 1e-4)
    t = np.arange(8000) * T
    uneven = chatter(record((1 + 0.1 * np.sin(2 * np.pi * 0.7 * t + 1.0)) * 1e-3 * np.sin(2 * np.pi * 40 * t)))
    assert abs(uneven.growth) < 3 * uneven.growth_error < 1.0
    assert math.isnan(chatter(record(oscillation(f=3.3, seconds=1.0))).growth_error)  # too few cycles for windows


@pytest.mark.parametrize(("f", "samples"), [(50.0, 20), (40.0, 25), (1000 / 7, 7), (37.3, None), (37.37, None)])
def test_a_cycle_locked_to_the_sampling_is_counted(f, samples):
    """37.3 Hz repeats itself only after 10 s, 373 cycles; sampled at 1 kHz that is no cycle a record of 4 s can show."""
    found = chatter(record(oscillation(f=f)))
    assert found.period == samples
    assert ("repeats itself" in str(found)) == (samples is not None)


def test_a_runaway_is_seen_beside_what_drives_it():
    t = np.arange(4000) * T
    drive = 2e-3 * np.sin(2 * np.pi * 5 * t)
    assert chatter(record(drive + 1e-5 * np.exp(3 * t)), driven=drive).state == "runaway"
    assert chatter(record(0.5 * drive), driven=drive).state == "driven"
    swelling = drive * (1 + 3 * (t > 3))  # farther to both sides, as its drive goes
    assert chatter(record(swelling), driven=swelling).state == "driven"
    hand = hl.Hand(m=0.1, b=0.5, k=20, intent=lambda t: 0.005 * np.sin(2 * np.pi * 3 * t))
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand).run(hl.wall(unilateral=None)(k=60, B=-8), duration=1)
    assert chatter(log, driven=hand).state == "runaway"


@pytest.mark.parametrize("count", [0.0, 4e-6])
def test_noise_of_a_sensor_at_rest_is_no_chatter(count):
    noise = 1e-5 * np.random.default_rng(0).standard_normal(4000)
    sensed = 5e-3 + noise
    sensed = np.round(sensed / count) * count if count else sensed
    found = chatter(record(sensed))
    assert found.state == "none" and found.amplitude == 0 and found.scatter == pytest.approx(1e-5, rel=0.06)
    assert "is not motion" in str(found)
    for f in (20.0, 197.0, 250.0):  # twice the noise, even of four samples a cycle, is an oscillation
        both = chatter(record(sensed + oscillation(f=f, amplitude=2e-5)))
        assert both.state != "none" and both.scatter == 0 and both.amplitude > 2e-5


@pytest.mark.parametrize("phase", range(6))
def test_half_a_slow_swing_is_undecided(phase):
    found = chatter(record(oscillation(f=0.4, amplitude=1e-3, phase=phase)))
    assert found.state == "undecided" and found.amplitude > 0.5e-3
    assert "run longer" in str(found)


@pytest.mark.parametrize("f", [2.3, 37.3])
def test_a_decay_onto_a_cycle_is_told_from_one_to_rest(f):
    t = np.arange(4000) * T
    plain, onto = 1e-3 * np.exp(-1.5 * t), 1e-3 * (0.5 + np.exp(-1.5 * t))
    dies, ends = (chatter(record(size * np.sin(2 * np.pi * f * t))) for size in (plain, onto))
    assert dies.state == "decaying" and not dies.levels_off and "it dies out" in str(dies)
    assert ends.state == "chatter" and "it shrinks towards a cycle of" in str(ends)
    assert ends.ends_at == pytest.approx((0.5e-3, 0.5e-3), rel=0.02)


@pytest.mark.parametrize("stops", [1.5, 2.2, 2.9])
def test_what_friction_stops_in_the_record_has_died_out(stops):
    """Friction takes as much from every swing, so the last quarters differ by far more than an irregular cycle's."""
    t = np.arange(3000) * T
    x = 2e-3 + 1e-3 * np.maximum(0, 1 - t / stops) * np.sin(2 * np.pi * 25 * t)
    found = chatter(record(x))
    assert found.state == ("decaying" if stops > 2.25 else "none" if stops < 2 else found.state) != "chatter"
    if found.state == "decaying":
        assert found.amplitude_at_end < 0.05 * found.amplitude and "mm at the end, of up to" in str(found)


def test_noise_that_turns_the_handle_does_not_make_a_decay_grow():
    """Wiggles between the turning points are no swings: a handle that bounces lower and lower has none that lasts."""
    paddle = hl.SimulatedPaddle(m=0.07, b=0.25, T=5e-4, noise=2e-6, hand=hl.Hand(k=150.0, push=0.5))
    log = paddle.run(hl.wall()(k=600.0), duration=1.0, x=-5e-3, progress=False)
    bare = Telemetry(t=log.t, x=log.x, v=log.v, F=log.F, T=log.T)
    assert chatter(bare).state in ("undecided", "decaying")


def test_a_heavily_damped_handle_that_creeps_to_rest_dies_out():
    """One turn in the last half: half a swing says nothing, but the motion inside the wall is that of a linear law."""
    t = np.arange(1000) * T
    for rate, state in ((-3.0, "decaying"), (0.5, "growing")):
        x = 5e-3 + 4e-3 * np.exp(rate * t) * np.cos(2 * np.pi * 1.2 * t + 1.0)
        found = chatter(record(x, F=200 * x))
        assert found.state == state and found.inside_growth == pytest.approx(rate, rel=2e-3)


@pytest.mark.parametrize("samples", [0, 1, 3])
def test_no_trend_is_seen_in_the_few_samples_since_a_handle_came_back_inside(samples):
    assert linear_trend(np.linspace(0.01, 0.02, samples), np.ones(samples)) == 0.0
