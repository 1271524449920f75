"""How long contacts last, against an integration, and the refusal of those that are too short for a step."""

import math

import pytest
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab.compiler.contact_steps import check_contact_steps
from hapticlab.errors import SceneError
from hapticlab.scene.contact import Contact
from hapticlab.scene.force_laws import hunt_crossley, penalty

Q = hl.coordinate("q", unit="m")
K, KH, C = hl.parameters("k k_h c", units="N/m N/m^1.5 s/m")


@pytest.mark.parametrize("exponent, unit", [(1.5, "N/m^1.5"), (2, "N/m^2"), (1, "N/m")])
def test_a_contact_lasts_as_long_as_its_integration(exponent, unit):
    law = hunt_crossley(k=hl.parameters("k", units=unit), c=C, exponent=exponent)
    mass, k, speed = 0.07, 3e4, 0.6

    def left(_, y):
        return y[0]

    left.terminal, left.direction = True, -1
    end = solve_ivp(
        lambda _, y: [y[1], -k / mass * max(y[0], 0) ** exponent], (0, 1), [1e-13, speed], events=left,
        method="DOP853", rtol=1e-12, atol=1e-15,
    )  # fmt: skip
    assert law.duration(k, mass, speed) == pytest.approx(end.t_events[0][0], rel=1e-8)
    if exponent == 1:
        assert law.duration(k, mass, speed) == pytest.approx(penalty(k=K).duration(k, mass), rel=1e-14)


def test_a_contact_too_short_is_refused_with_the_substeps_it_needs():
    stiff = Contact(Q, penalty(k=K), name="wall")
    lasts = math.pi * math.sqrt(0.05 / 50000)
    message = rf"wall: the contact lasts 3.14 ms .* 3.1 steps of 1 ms; rk4 needs 10. Take substeps={math.ceil(1e-2 / lasts)}"
    with pytest.raises(SceneError, match=message):
        check_contact_steps(stiff, 50000.0, 20.0, 1e-3, 1e-3)
    check_contact_steps(stiff, 50000.0, 20.0, 1e-3 / math.ceil(1e-2 / lasts), 1e-3)
    check_contact_steps(stiff, 0.0, 20.0, 1e-3, 1e-3)


def test_a_faster_contact_is_shorter():
    hertz = Contact(Q, hunt_crossley(k=KH, c=C), name="ball")
    check_contact_steps(hertz, 1e5, 20.0, 5e-4, 1e-3, speed=0.1)
    with pytest.raises(SceneError, match=r"ball: the contact at 30 m/s lasts"):
        check_contact_steps(hertz, 1e5, 20.0, 5e-4, 1e-3, speed=30.0)
