"""Bounces, blows and slips against their closed forms."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost


def test_a_ball_on_a_held_plate_bounces_by_restitution(led):
    e, h, g, T = 0.7, 0.05, 9.81, 1e-3
    scene = hl.library.ball_on_the_paddle()(e=e, h=h, M=1e12, b_c=0)  # so heavy a plate does not move
    log = led(scene, np.zeros(500), T=T, start={"y": h}, method="taylor")
    fall = np.sqrt(2 * h / g)
    touch = fall * (1 + 2 * e * (1 - e ** np.arange(7)) / (1 - e))  # times of the first impacts
    exact = h - g * log.t**2 / 2
    for k, (start, end) in enumerate(zip(touch, touch[1:], strict=False), 1):
        flying = (log.t >= start) & (log.t < end)
        tau = log.t[flying] - start
        exact[flying] = e**k * g * fall * tau - g * tau**2 / 2
    assert touch[-2] < log.t[-1] < touch[-1]
    assert np.abs(log.y - exact).max() < 1e-12
    assert not log.unlocated.any()


def test_a_blow_shares_the_momentum_and_separates_by_restitution(led):
    p = {"m": 0.04, "M": 0.1, "e": 0.6, "g": 9.81, "h": 0.03}
    scene = hl.library.ball_on_the_paddle()(**p, K=0, b_c=0)
    log = led(scene, np.zeros(120), T=1e-3, start={"y": p["h"]}, method="taylor")
    fall = np.sqrt(2 * p["h"] / p["g"])
    down = p["g"] * fall
    after = log.t > fall
    plate = -(1 + p["e"]) * p["m"] / (p["m"] + p["M"]) * down
    ball = -down + (1 + p["e"]) * p["M"] / (p["m"] + p["M"]) * down
    tau = log.t[after] - fall
    assert after.sum() > 30
    assert np.abs(log.z[after] - plate * tau).max() < 1e-12
    assert np.abs(log.y[after] - (ball * tau - p["g"] * tau**2 / 2)).max() < 1e-12


def test_a_juggled_ball_comes_back_to_one_bounce_a_stroke(led):
    # Schaal and Atkeson: where the plate decelerates at impact, by less than 2 g (1 + e^2)/(1 + e)^2, errors die out
    e, g, T, period = 0.6, 9.81, 1e-3, 0.25
    w, flight = 2 * np.pi / period, g * period**2 / 8
    up, deceleration = g * period / 2 * (1 - e) / (1 + e), 0.4 * g
    amplitude, phase = np.hypot(up / w, deceleration / w**2), np.arctan2(deceleration / w, up)
    t = np.arange(5000) * T
    x = amplitude * np.sin(w * t + phase + np.pi)  # the ball starts 5 % above its top
    top = amplitude * np.sin(phase) + flight
    scene = hl.library.ball_on_the_paddle()(e=e, M=5e3, K=2e9, b_c=3e6, h=top + 0.05 * flight - x[0])
    log = led(scene, x, T=T, method="taylor")
    tops = np.flatnonzero((log.y[1:-1] > log.y[:-2]) & (log.y[1:-1] >= log.y[2:])) + 1
    assert log.y[0] - top > 3e-3
    assert np.abs(np.diff(tops)[-8:] * T - period).max() <= T
    assert log.y[tops[-8:]] == pytest.approx(top, abs=1e-4)


def test_a_block_sticks_then_slips_by_the_spring_it_had_stored(led):
    m, K, F_s, F_c, speed, T = 0.12, 150.0, 1.8, 0.7, 0.05, 1e-3
    scene = hl.library.stick_slip()(m=m, K=K, F_s=F_s, F_c=F_c, b_c=0)
    log = led(scene, speed * T * np.arange(500), T=T, method="taylor")
    w, stretch = np.sqrt(K / m), (F_s - F_c) / K
    leaves = F_s / K / speed
    lasts = 2 / w * (np.pi - np.arctan(stretch * w / speed))
    sliding = (log.t > leaves) & (log.t < leaves + lasts)
    tau = log.t[sliding] - leaves
    # x - z = F_c/K + stretch cos(w tau) + speed/w sin(w tau), until z' = 0
    spring = F_c / K + stretch * np.cos(w * tau) + speed / w * np.sin(w * tau)
    assert 60 < sliding.sum() < 120
    assert np.abs(log.z[log.t <= leaves]).max() < 1e-12
    assert np.abs(log.z[sliding] - (log.x[sliding] - spring)).max() < 1e-11
    rested = log.t > leaves + lasts
    assert np.abs(log.z[rested][:50] - (speed * lasts + 2 * stretch)).max() < 1e-11
    assert np.abs(log.F[log.t <= leaves] - K * log.x[log.t <= leaves]).max() < 1e-12


def penalty():
    return hl.contact.penalty(k=hl.parameters("k_b", units="N/m", values=500))


@pytest.mark.parametrize(
    "scene",
    [hl.library.ball_on_the_paddle(contact_law=penalty()), hl.library.stick_slip(stick_speed=0.005)],
    ids=["ball", "block"],
)
def test_a_contact_of_force_alone_fits_an_uno(scene):
    taken = cost(hl.compile(scene, "semi_implicit_euler", T=2e-3))
    print(taken)
    assert taken.fits, str(taken)
