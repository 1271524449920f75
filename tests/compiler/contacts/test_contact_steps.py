"""How long contacts last, against an integration, and the refusal of those that are too short for a step."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import t
from hapticlab.compiler.contacts.contact_steps import check_contact_steps
from hapticlab.device.live_parameters import checked
from hapticlab.errors import ParameterError, SceneError
from hapticlab.scene.contact.contact import Contact
from hapticlab.scene.contact.penalty_laws import hunt_crossley, penalty

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
    message = rf"wall: the contact lasts 3.14 ms .* 3.1 steps of 1 ms; rk4 needs 10. Use substeps={math.ceil(1e-2 / lasts)}"
    with pytest.raises(SceneError, match=message):
        check_contact_steps(stiff, 50000.0, 20.0, 1e-3, 1e-3)
    check_contact_steps(stiff, 50000.0, 20.0, 1e-3 / math.ceil(1e-2 / lasts), 1e-3)
    check_contact_steps(stiff, 0.0, 20.0, 1e-3, 1e-3)


def test_a_faster_contact_is_shorter():
    hertz = Contact(Q, hunt_crossley(k=KH, c=C), name="ball")
    check_contact_steps(hertz, 1e5, 20.0, 5e-4, 1e-3, speed=0.1)
    with pytest.raises(SceneError, match=r"ball: the contact at 30 m/s lasts"):
        check_contact_steps(hertz, 1e5, 20.0, 5e-4, 1e-3, speed=30.0)


def landing(law):
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.05, 9.81))
    h = hl.coordinate("h", unit="m", initial=0.01)
    floor = Contact(h, law, name="floor")
    return hl.Scene(force=0, eom=[hl.mechanics.lagrange(m * h.diff(t) ** 2 / 2 - m * g * h, contacts=[floor])], watch=[h])


MOST = 0.05 * (math.pi / 10e-3) ** 2  # pi sqrt(m/k) = 10 T


def test_a_live_stiffness_stops_where_ten_steps_end():
    program = hl.compile(landing(penalty(k=K))(k=1000), T=1e-3)
    (channel,) = (c for c in program.parameters if c.name == "k")
    assert channel.high == pytest.approx(MOST, rel=1e-12)
    assert checked(program, {"k": 0.999 * MOST}) == {"k": 0.999 * MOST}
    note = "k: at most 4935 N/m, for which floor lasts 10 steps; substeps or method='taylor' allow more"
    assert note in program.notes
    with pytest.raises(ParameterError, match=r"k = 5000 N/m; .*\(k: at most 4935 N/m, for which floor lasts 10 steps"):
        checked(program, {"k": 5000})
    for more in ({"method": "taylor"}, {"live": "m"}, {"substeps": 2}):
        other = hl.compile(landing(penalty(k=K))(k=1000), T=1e-3, **more)
        assert not any(note.startswith("k: at most 4935") for note in other.notes)
    with pytest.raises(SceneError, match="floor: the contact lasts"):
        hl.compile(landing(penalty(k=K))(k=1.001 * MOST), T=1e-3)


def test_a_declared_range_is_cut_only_where_it_goes_beyond():
    low, high = (hl.parameters("k", units="N/m", values=1000, ranges=(0, end)) for end in (4000, 9000))
    assert not any("at most" in note for note in hl.compile(landing(penalty(k=low)), T=1e-3).notes)
    assert any(c.high == pytest.approx(MOST) for c in hl.compile(landing(penalty(k=high)), T=1e-3).parameters)


def test_the_limit_of_hunt_and_crossley_is_its_own_duration():
    law = hunt_crossley(k=KH, c=C)
    program = hl.compile(landing(law)(k_h=1e4, c=0.1), T=1e-3)
    (most,) = (c.high for c in program.parameters if c.name == "k_h")
    assert law.duration(most, 0.05, 1.0) == pytest.approx(10e-3, rel=1e-12)


def test_the_heavier_of_two_bodies_leaves_the_lighter_its_limit():
    m, M, g = hl.parameters("m M g", units="kg kg m/s^2", values=(0.05, 0.2, 9.81))
    h, y = (hl.coordinate(name, unit="m", initial=0.01) for name in "hy")
    L = (m * h.diff(t) ** 2 + M * y.diff(t) ** 2) / 2 - g * (m * h + M * y)
    contacts = [Contact(y, penalty(k=K), name="heavy"), Contact(h, penalty(k=K), name="light")]
    program = hl.compile(hl.Scene(force=0, eom=[hl.mechanics.lagrange(L, contacts=contacts)], watch=[h, y])(k=1000), T=1e-3)
    assert any(c.high == pytest.approx(MOST) for c in program.parameters)
    assert [note.split(",")[0] for note in program.notes if "at most" in note] == ["k: at most 4935 N/m"]


def test_a_stiffness_that_is_an_expression_is_noted():
    program = hl.compile(landing(penalty(k=2 * K))(k=500), T=1e-3)
    assert "k: 2*k at most 4935, for which floor lasts 10 steps; substeps or method='taylor' allow more" in program.notes


def test_a_sweep_past_the_limit_is_refused():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    options = {"duration": 0.1, "metric": "peak_force", "progress": False}
    assert np.isfinite(hl.sweep(landing(penalty(k=K)), paddle, k=[1000.0, 4900.0], **options).values).all()
    with pytest.raises(SceneError, match=r"floor: the contact lasts .* 7.0 steps of 1 ms"):
        hl.sweep(landing(penalty(k=K)), paddle, k=[1000.0, 10000.0], **options)
