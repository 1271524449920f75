"""Constants of contacts and frictions that would feed energy: refused as values, and out of reach of live parameters."""

import math

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.device.live_parameters import checked
from hapticlab.errors import ParameterError, SceneError

m, g = hl.parameters("m g", units="kg m/s^2", values=(0.1, 9.81))
X, w = hl.coordinate("X", unit="m"), hl.coordinate("w", unit="m", initial="2 cm")


def named(name, unit, value, ranges=None):
    return hl.parameters(name, units=unit, values=value, ranges=ranges)


def scene(*contacts, **bound):
    L = m * (X.diff(t) ** 2 + w.diff(t) ** 2) / 2 - m * g * w
    return hl.Scene(force=0 * x(n), eom=[hl.mechanics.lagrange(L, contacts=contacts)], watch=[X, w], name="block")(**bound)


def compiled(*contacts, live=None, **bound):
    return hl.compile(scene(*contacts, **bound), method="taylor", T=1e-3, live=live)


def floor(law, **slip):
    return hl.contact.Contact(w, law, name="floor", **slip)


F_c, mu, c = named("F_c", "N", 0.5), named("mu", "1", 0.3), named("c", "s/m", 0.3)
k_h = named("k_h", "N/m^2", 1e5)
e = named("e", "1", 0.4, (0, 1))
RUB = hl.contact.friction(slip=X.diff(t), coulomb=F_c, name="rub")
HUNT = hl.contact.hunt_crossley(k=k_h, c=c, exponent=2)
TABLE = floor(hl.contact.impulse(e=0.5))
PRESSED = hl.contact.friction(slip=X.diff(t), coulomb=mu * TABLE.force, name="rub")
SOFT = floor(hl.contact.penalty(k=named("k", "N/m", 300)))


@pytest.mark.parametrize(
    ("contacts", "bound", "told"),
    [
        ([RUB], {"F_c": -0.5}, r"rub: coulomb = F_c is -0\.5 N at the start; friction opposes the slip: needs coulomb >= 0"),
        ([floor(HUNT)], {"c": -0.3}, r"floor: c = c is -0\.3 s/m at the start; a negative one is not passive: needs c >= 0"),
        ([floor(HUNT)], {"k_h": -10.0}, r"floor: k = k_h is -10 N/m\^2 at the start; .* needs k >= 0"),
        ([floor(hl.contact.impulse(e=0.5, mu=mu), slip=X.diff(t))], {"mu": -0.3}, r"floor: mu = mu is -0\.3 at the start; fric"),
        ([floor(hl.contact.rigid(mu=mu), slip=X.diff(t))], {"mu": -0.3}, r"floor: mu = mu is -0\.3 at the start"),
        ([floor(hl.contact.impulse(e=2 * e))], {"e": 1}, r"floor: e = 2\*e is 2 at the start; above 1 every bounce .* needs 0"),
        ([TABLE, PRESSED], {"mu": -0.3}, r"rub: coulomb = .*mu.* is -0\.3 N at the start; friction opposes the slip"),
        ([SOFT, hl.contact.friction(slip=X.diff(t), coulomb=mu * SOFT.force, name="rub")], {"mu": -0.3}, r"rub: .* is -0\.3 N"),
        ([hl.contact.friction(slip=X.diff(t), coulomb=F_c * (1 - hl.x(t) / named("r", "m", 0.1)), name="rub")], {"F_c": -1},
         r"rub: coulomb = .* is -1 N at the start; friction opposes"),
        ([hl.contact.friction(slip=X.diff(t), coulomb="1 N", stick_speed=named("v_s", "m/s", 0.0), name="rub")], {},
         r"rub: stick_speed = v_s is 0 m/s at the start; the line needs a speed above 0 at which it ends: needs stick_speed > 0"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("live", [None, ""])
def test_a_value_that_feeds_energy_is_refused_whether_it_is_live_or_not(contacts, bound, told, live):
    with pytest.raises(SceneError, match=told):
        compiled(*contacts, live=live, **bound)


@pytest.mark.parametrize(
    ("contacts", "name", "low", "high"),
    [
        ([RUB], "F_c", 0.0, math.inf),
        ([floor(HUNT)], "c", 0.0, math.inf),
        ([floor(HUNT)], "k_h", 0.0, math.inf),
        ([TABLE, PRESSED], "mu", 0.0, math.inf),
        ([SOFT, hl.contact.friction(slip=X.diff(t), coulomb=mu * SOFT.force, name="rub")], "mu", 0.0, math.inf),
        (
            [hl.contact.friction(slip=X.diff(t), coulomb=F_c * (1 + X**2 / named("r", "m", 0.1) ** 2), name="rub")],
            "F_c",
            0.0,
            math.inf,
        ),
        ([floor(hl.contact.hunt_crossley(k=k_h, c=named("c", "s/m", 0.3, (-math.inf, 2)), exponent=2))], "c", 0.0, 2.0),
        ([floor(hl.contact.impulse(e=e / 2))], "e", 0.0, 1.0),
        ([RUB], "m", 0.0, math.inf),
    ],
)
def test_a_live_parameter_cannot_be_set_to_what_feeds_energy(contacts, name, low, high):
    program = compiled(*contacts)
    (channel,) = [p for p in program.parameters if p.name == name]
    assert (channel.low, channel.high) == (low, high)
    with pytest.raises(ParameterError, match=rf"^{name} = -0\.1"):
        checked(program, {name: -0.1})
    assert checked(program, {name: 0.5}) == {name: 0.5}


def test_the_refusal_of_set_says_what_is_needed():
    with pytest.raises(ParameterError, match=r"F_c = -0\.1 N; needs F_c >= 0$"):
        checked(compiled(RUB), {"F_c": -0.1})


def test_a_sweep_is_refused_what_set_is():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    creeping = hl.contact.friction(slip=X.diff(t) - hl.v(t), coulomb=F_c, stick_speed="1 cm/s", name="rub")
    swept = hl.Scene(force=creeping.force, eom=scene(creeping).eom)
    with pytest.raises(ParameterError, match=r"F_c = -0\.5 N; needs F_c >= 0"):
        hl.sweep(swept, paddle, duration=0.05, metric="peak_force", progress=False, F_c=[-0.5, 0.5])


def test_one_that_is_no_factor_stays_free():
    offset = named("offset", "N", 0.1)
    far = hl.contact.friction(slip=X.diff(t), coulomb=F_c + sp.sqrt(offset**2), name="rub")
    assert {p.name: p.low for p in compiled(far).parameters}["offset"] == -math.inf


@pytest.mark.parametrize(
    ("contact", "told"),
    [
        (hl.contact.friction(slip=X.diff(t), coulomb=named("F_c", "N", 0.5, (-5, 5)), name="rub"),
         r"rub: coulomb can reach any value in -5\.\.5 while F_c is live, .*hl\.parameters\('F_c', units='N', ranges=\(0, "
         r"5\)\), or "
         "leave F_c out of live="),
        (floor(hl.contact.impulse(e=2 * e)), r"floor: e = 2\*e can reach any value in 0\.\.2 while e is live,.* needs 0"),
        (hl.contact.friction(slip=X.diff(t), coulomb=named("a", "N", 1) - named("F_c", "N", 0.5), name="rub"),
         r"coulomb = .* reach any value in -inf\.\.inf while F_c, a is live,"),
    ],
)  # fmt: skip
def test_a_range_that_reaches_what_feeds_energy_is_refused_while_it_is_live(contact, told):
    with pytest.raises(SceneError, match=told):
        compiled(contact)
    assert len(compiled(contact, live="")) > 0
