"""Samples and what becomes of them: lost, repeated, late, of an earlier run."""

import random
import struct

import numpy as np
import pytest
from host_driver import spring

from hapticlab.device.board.run import Loaded, Run, decimation, fault_words
from hapticlab.device.link.messages import FAULTS
from hapticlab.device.link.wire import Decoder, Frame, encode
from hapticlab.errors import PaddleError

FIRST, OVERRUN, SATURATED = 4, 2, 1


def sample(tick, flags=0, x=0.0, F=0.0):
    return Frame("SAMPLE", tick & 255, struct.pack("<IBfff", tick, flags, x, 0.0, F))


def recorded(*frames, every=1, begin=True, ticks=None):
    recording = Run(Loaded(spring(K=2.0), 0), every)
    if begin:
        recording.begin()
    for frame in frames:
        recording.add(frame)
    return recording.telemetry(ticks=ticks, delay=1e-4, paddle="p")


def test_samples_become_arrays_with_their_units_and_flags():
    log = recorded(sample(0, FIRST, 0.1, 1.0), sample(1, SATURATED, 0.2, 2.0), sample(2, OVERRUN, 0.3, 3.0))
    assert np.allclose(log.t, [0, 1e-3, 2e-3]) and np.array_equal(log.x, np.float32([0.1, 0.2, 0.3]).astype(float))
    assert log.F.tolist() == [1, 2, 3] and log.saturated.tolist() == [False, True, False]
    assert log.overrun.tolist() == [False, False, True] and not log.gap.any()
    assert log.parameters == {"k": 2.0} and log.scene == "spring" and log.fault is None


@pytest.mark.parametrize("every, ticks, gaps", [
    (1, [0, 1, 3, 4, 7], [0, 0, 1, 0, 1]), (5, [0, 5, 10, 20, 25], [0, 0, 0, 1, 0]), (1, [2, 3], [1, 0])])  # fmt: skip
def test_lost_samples_are_gaps_also_at_the_begin(every, ticks, gaps):
    log = recorded(*map(sample, ticks), every=every)
    assert log.gap.tolist() == [bool(g) for g in gaps] and np.allclose(log.t, np.array(ticks) * 1e-3)


def test_repeated_and_late_samples_are_counted_once():
    log = recorded(*map(sample, [0, 1, 1, 0, 2, 1, 3, 3]))
    assert np.allclose(log.t, np.arange(4) * 1e-3) and not log.gap.any()


def test_samples_of_an_earlier_run_are_not_of_this_one():
    log = recorded(sample(700), sample(701), sample(0, FIRST), sample(1), begin=False)
    assert np.allclose(log.t, [0, 1e-3])
    assert len(recorded(sample(700), begin=False)) == 0


def test_a_repeat_of_the_first_sample_does_not_begin_anew():
    log = recorded(sample(0, FIRST), sample(1), sample(0, FIRST), sample(2), begin=False)
    assert len(log) == 3


def test_no_more_than_the_wanted_ticks():
    assert len(recorded(*map(sample, range(10)), ticks=7)) == 7


def test_nothing_recorded_is_an_empty_record():
    assert len(recorded()) == 0


@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_is_said_with_cause_and_cure(name):
    number, cause, cure = FAULTS[name]
    said = fault_words({"fault": number, "tick": 250, "value": 1.0}, 1e-3)
    assert said.startswith(f"tick 250 (t = 0.25 s): {name}: {cause}") and cure[1:] in said
    assert fault_words(None) is None and "UNKNOWN" in fault_words({"fault": 200, "tick": 1})


def test_decimation_is_what_the_link_carries():
    class Port:
        baudrate = 500000

    program = spring(K=1.0, T=2.5e-4)  # 3 numbers, 23 bytes a sample; 45000 bytes/s carry 1956 samples of 4000
    assert decimation(program, Port()) == 3
    assert decimation(program, Port(), 7) == 7
    for bad in (2, 0, 2.5, 65536):
        with pytest.raises(PaddleError, match=f"every = {bad}"):
            decimation(program, Port(), bad)


def test_garbage_never_raises_and_never_counts_beyond_the_odds_of_16_bits():
    """20000 samples, each damaged: what passes CRC-16 anyway is about one in 65536, so at most a few."""
    rng, decoder, recording = random.Random(8), Decoder(), Run(Loaded(spring(K=1.0), 0), 1)
    recording.begin()
    accepted = 0
    for k in range(20000):
        frame = bytearray(encode("SAMPLE", k & 255, k, 0, rest=rng.randbytes(12)))
        kind = rng.randrange(3)
        if kind == 0:
            frame[rng.randrange(len(frame) - 1)] ^= rng.randrange(1, 256)
        elif kind == 1:
            del frame[rng.randrange(1, len(frame) - 1)]
        else:
            frame = bytearray(rng.randbytes(rng.randrange(1, 60))) + b"\0"
        for got in decoder.feed(bytes(frame)):
            accepted += 1
            recording.add(got)
    print(f"{accepted} of 20000 damaged frames passed")
    assert accepted <= 4 and decoder.damaged > 19000
    recording.telemetry(ticks=None, delay=0.0, paddle="p")
