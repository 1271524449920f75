"""The staircase of Fig. 23.6 against areas in closed form, on prescribed motion to 1e-12 J."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError

K, T, X_O = 620.0, 1e-3, 0.004


def record(x, F, delay=0.0, **channels):
    return Telemetry(t=np.arange(len(x)) * T, x=x, v=np.gradient(x, T), F=F, T=T, delay=delay, channels=channels)


def swinging(amplitude=6e-3, samples=400, period=0.0713):
    return X_O - 2e-3 + amplitude * np.sin(2 * np.pi * np.arange(samples) * T / period)


def test_every_step_within_the_wall_leaks_half_k_d_squared():
    x = swinging()
    p = np.maximum(x - X_O, 0)
    found = hl.records.staircase(record(x, K * p), K=K, x_o=X_O)
    within = (p[:-1] > 0) & (p[1:] > 0)
    assert within.sum() > 100
    np.testing.assert_allclose(found.leak[within], K * np.diff(x)[within] ** 2 / 2, rtol=0, atol=1e-15)
    # entering, the spring is loaded for nothing; leaving, the last force acts on outside: K p (q + p/2)
    enters, leaves = (p[:-1] == 0) & (p[1:] > 0), (p[:-1] > 0) & (p[1:] == 0)
    np.testing.assert_allclose(found.leak[enters], K * p[1:][enters] ** 2 / 2, atol=1e-15)
    q = (X_O - x[1:])[leaves]
    np.testing.assert_allclose(found.leak[leaves], K * p[:-1][leaves] * (q + p[:-1][leaves] / 2), atol=1e-15)
    assert (found.leak[(p[:-1] == 0) & (p[1:] == 0)] == 0).all()


def test_the_bounces_sum_to_what_the_port_gave():
    x = swinging()
    log = record(x, np.maximum(K * (x - X_O), 0))
    found = hl.records.staircase(log, K=K, x_o=X_O)
    assert len(found.bounces) == 6
    for bounce in found.bounces:
        part = slice(bounce.first, bounce.last)
        assert bounce.generated == pytest.approx(found.leak[part].sum(), abs=1e-15)
        assert bounce.depth == (x - X_O)[bounce.first : bounce.last + 1].max()
        assert log.F[bounce.first] == 0 == log.F[bounce.last] and (log.F[bounce.first + 1 : bounce.last] > 0).all()
    assert sum(b.generated for b in found.bounces) == pytest.approx(hl.energy(log).generated, abs=1e-12)


@pytest.mark.parametrize("fraction", [0.0, 0.35])
@pytest.mark.parametrize("whole", [0, 1])
def test_the_corners_enclose_what_was_generated(whole, fraction):
    """The shoelace area of the drawn loop, whatever the delay, is the energy of the bounce."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=(whole + fraction) * T)
    log = paddle.run(hl.wall()(k=K, x_o=X_O), duration=0.12, v=0.3, progress=False)
    found = hl.records.staircase(log)
    (bounce,) = found.bounces
    per = (len(found.x) - 1) // len(found.moved)
    assert per == (4 if fraction else 2)
    x, F = (a[per * bounce.first : per * bounce.last + 1] for a in (found.x, found.F))
    area = -np.sum(F[:-1] * np.diff(x))
    assert F[0] == 0 and area == pytest.approx(bounce.generated, abs=1e-12)
    # lossless but for b: the bounce's gain of kinetic energy and what b took between the two samples
    v, between = log.v, slice(bounce.first, bounce.last + 1)
    gained = 0.05 * (v[bounce.last] ** 2 - v[bounce.first] ** 2) / 2
    paid = 0.1 * np.sum(np.diff(log.x[between]) ** 2) / T
    assert gained < bounce.generated - paid + 1e-12
    assert gained == pytest.approx(bounce.generated - paid, rel=5e-3)
    assert bounce.v_out / bounce.v_in == pytest.approx(abs(v[bounce.last] / v[bounce.first]))


@pytest.mark.parametrize("delay", [0.0, 1.0, 2.0, 0.4, 2.7])
@pytest.mark.parametrize("unilateral", ["gate", "clip"])
def test_a_bounce_begins_outside_whatever_the_delay(unilateral, delay):
    """Free flight until the wall is felt: the entry speed is that of the start less b x/m, and no spring is loaded yet."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=delay * T)
    scene = hl.wall(unilateral=unilateral)(k=300, x_o=X_O)
    log = paddle.run(scene, duration=0.3, x=X_O - 2e-3, v=0.2, progress=False, dtype="float64")
    found = hl.records.staircase(log)
    first = found.bounces[0]
    assert log.x[first.first] <= X_O < log.x[first.first + 1] and log.x[first.last] <= X_O
    assert first.v_in == pytest.approx(0.2 - 0.1 * (log.x[first.first] - log.x[0]) / 0.05, rel=1e-12)
    for bounce in found.bounces:
        leaked = found.leak[bounce.first : bounce.last].sum()
        assert bounce.generated == pytest.approx(leaked, abs=1e-15)
    ends = [(one.first, one.last) for one in found.bounces]
    assert all(one[1] <= later[0] for one, later in zip(ends, ends[1:], strict=False))


def test_an_unfinished_penetration_is_no_bounce():
    x = X_O + 1e-3 * np.array([-1, 1, 2, 1, -1, 1, 2])
    found = hl.records.staircase(record(x, np.maximum(K * (x - X_O), 0)), K=K, x_o=X_O)
    assert len(found.bounces) == 1
    assert "no completed" in str(hl.records.staircase(record(x[:4], K * (x - X_O)[:4].clip(0)), K=K, x_o=X_O))
    with pytest.raises(AnalysisError, match="bounce = 2"):
        found.plot(2)


def test_the_picture():
    x = X_O + 1e-3 * np.array([-1, 1, 3, 5, 4, 2, -1])
    found = hl.records.staircase(record(x, np.maximum(K * (x - X_O), 0)), K=K, x_o=X_O)
    (axes,) = found.plot().axes
    assert f"{1e3 * found.bounces[0].generated:.4g} mJ generated" in axes.get_title()
    written = [text.get_text() for text in axes.texts if text.get_text()]
    assert written == [f"{1e3 * one:.2g}" for one in found.leak if one > 0]
    stairs, law = axes.lines
    np.testing.assert_allclose(stairs.get_xdata()[:3], 1e3 * x[[0, 1, 1]])
    assert law.get_ydata()[-1] == pytest.approx(K * 5e-3)


def test_it_needs_a_spring_and_what_acted():
    x = swinging()
    with pytest.raises(AnalysisError, match="give K="):
        hl.records.staircase(record(x, np.maximum(K * (x - X_O), 0)))
    with pytest.raises(AnalysisError, match="inside the periods"):
        hl.records.staircase(record(x, np.maximum(K * (x - X_O), 0), delay=T / 3), K=K)
