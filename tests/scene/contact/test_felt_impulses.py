"""Impulses rendered over a time: the impulse is kept to rounding, pulses add, and the peak is where it is promised."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError
from hapticlab.scene.contact.contact import Contact
from hapticlab.scene.contact.felt_impulses import felt_impulse, pulse_time
from hapticlab.scene.contact.instant_laws import impulse
from hapticlab.scene.contact.penalty_laws import penalty

Q = hl.coordinate("q", unit="m")
BALL = Contact(Q - x(t), impulse(e=0.8), name="ball")
T = 1e-3


def felt_force(impulses, tau, **more):
    """Return what is felt, sample by sample, of impulses {sample: N s}: a scene whose impacts are given."""
    felt = felt_impulse(BALL, tau=tau, **more)
    p = hl.parameters("p", units="N*s", values=1)
    given = 0
    for sample, size in impulses.items():
        given = hl.when((n >= sample) & (n <= sample), size * p, given)
    here = {BALL.impulse: given, BALL.force: 0}
    scene = hl.Scene(
        felt.force.doit().xreplace(here), [e.xreplace(here) for e in felt.equations],
        watch={name: w.doit().xreplace(here) for name, w in felt.watch.items()},
    )  # fmt: skip
    program = hl.compile(scene, T=T, dtype="float64")
    return load(program).run(400, np.zeros((400, len(program.inputs)))).outputs[:, :, 0].T


@pytest.mark.parametrize("tau", ["0.7 ms", "4 ms", "15 ms"])
@pytest.mark.always("4 ms")
def test_the_impulse_that_is_felt_is_that_of_the_impact(tau):
    """The held force of every period summed: 0.09 N s, whether the pulse takes less than a period or twenty."""
    (force,) = felt_force({3: 0.09}, tau)
    assert force[:3].max() == 0
    assert force.sum() * T == pytest.approx(0.09, rel=1e-9 if tau != "15 ms" else 1e-8)


def test_each_sample_is_the_mean_of_the_pulse_over_its_period():
    tau, p = 4e-3, 0.09
    (force,) = felt_force({3: p}, "4 ms")

    def given(s):
        return p * (1 - (1 + s / tau) * math.exp(-s / tau))  # the integral of p s/tau^2 exp(-s/tau)

    expected = [(given((k + 1) * T) - given(k * T)) / T for k in range(100)]
    assert force[3:103] == pytest.approx(expected, rel=1e-10)
    assert force.max() == pytest.approx(p / (math.e * tau), rel=0.01)


def test_pulses_add():
    one, other, both = (felt_force(at, "6 ms")[0] for at in ({3: 0.02}, {11: 0.05}, {3: 0.02, 11: 0.05}))
    assert both == pytest.approx(one + other, abs=1e-14)


def test_a_pulse_beyond_the_device_is_noted():
    force, saturates = felt_force({3: 0.09}, "4 ms", F_max="5 N")
    assert (saturates == (force > 5)).all() and saturates.any()
    tau = pulse_time(impulse=0.09, F_max=5.0)
    assert tau == pytest.approx(0.09 / (math.e * 5), rel=1e-15)
    force, saturates = felt_force({3: 0.09}, tau, F_max="5 N")
    assert not saturates.any() and force.max() == pytest.approx(5, rel=0.005)


@pytest.mark.parametrize("made, message", [
    (lambda: felt_impulse(Contact(Q, impulse(e=0.5), name="floor"), tau="4 ms"), r"floor: its gap = .* does not contain x\(t\),"),
    (lambda: felt_impulse(Contact(Q - x(t), penalty(k=hl.parameters("k", units="N/m"))), tau="4 ms"), r"only an impact needs"),
    (lambda: felt_impulse(BALL, tau=0), r"ball: tau = 0 s; the impulse is felt over this time,"),
    (lambda: pulse_time(impulse=0, F_max=5), r"both need to be > 0"),
])  # fmt: skip
def test_what_cannot_be_felt_is_refused(made, message):
    with pytest.raises(SceneError, match=message):
        made()
