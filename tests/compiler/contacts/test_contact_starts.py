"""Where contacts and frictions may start: apart or carried, and what is refused in words."""

import pytest

import hapticlab as hl
from hapticlab import t, x
from hapticlab.compiler.algebra.first_sample import numbers
from hapticlab.errors import SceneError

m, g, k, k_h, c, h0, F_c, F_s, mu, mu_s = hl.parameters(
    "m g k k_h c h0 F_c F_s mu mu_s", units="kg m/s^2 N/m N/m^1.5 s/m m N N 1 1",
    values=(0.5, 9.81, 200.0, 1e4, 0.1, 0.04, 0.4, 0.5, 0.3, 0.4),
)  # fmt: skip
h = hl.coordinate("h", unit="m", initial=h0)
s = hl.coordinate("s", unit="m")
SOFT = [hl.contact.penalty(k=k), hl.contact.hunt_crossley(k=k_h, c=c)]
LAWS = [hl.contact.impulse(e=0.5), hl.contact.rigid(), hl.contact.micro_impulse(e=0.5), *SOFT]


def scene(gap, law, **more):
    L = m * h.diff(t) ** 2 / 2 - m * g * h
    return hl.Scene(
        force=0, eom=[hl.mechanics.lagrange(L, contacts=[hl.contact.Contact(gap, law, name="top")], **more)], watch=[h]
    )


def compiled(scene, law=None):
    method = "taylor" if isinstance(law, (hl.contact.impulse, hl.contact.rigid)) else "verlet"
    return hl.compile(scene, T=1e-3, method=method)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.always("rigid", "penalty")
def test_bodies_in_each_other_at_the_start_are_refused(law):
    with pytest.raises(SceneError, match=r"top: gap = -h\(t\) is -0.04 m at the start: the bodies overlap\. .* its sign,"):
        compiled(scene(-h, law), law)
    compiled(scene(h, law)(h0=0), law)  # in touch
    with pytest.raises(SceneError, match=r"is -0.01 m at the start, with the handle at 0: the bodies overlap"):
        compiled(scene(x(t) - h, law)(h0="10 mm"), law)


@pytest.mark.parametrize("law", LAWS[:3], ids=lambda law: type(law).__name__)
def test_what_acts_in_an_instant_starts_apart_to_a_rounding(law):
    compiled(scene(h, law)(h0=-1e-10), law)
    with pytest.raises(SceneError, match=r"top: gap = h\(t\) is -1e-06 m at the start"):
        compiled(scene(h, law)(h0=-1e-6), law)


def test_a_body_may_start_resting_on_a_soft_floor():
    floor = scene(h, SOFT[0])
    rest = 0.5 * 9.81 / 200  # 24.5 mm
    compiled(floor(h0=-rest))
    compiled(floor(h0=-9.99 * rest))
    with pytest.raises(SceneError, match="the bodies overlap"):
        compiled(floor(h0=-10.01 * rest))
    compiled(floor(h0=-1e-3, g=0))  # a little inside is its spring's business
    with pytest.raises(SceneError, match="the bodies overlap"):
        compiled(floor(h0=-1.1e-3, g=0))


def test_a_pile_may_start_at_rest_on_springs():
    upper = hl.coordinate("upper", unit="m", initial=-3 * m * g / k)
    lower = hl.coordinate("lower", unit="m", initial=-2 * m * g / k)
    L = m * (lower.diff(t) ** 2 + upper.diff(t) ** 2) / 2 - m * g * (lower + upper)
    contacts = [
        hl.contact.Contact(lower, hl.contact.penalty(k=k), name="floor"),
        hl.contact.Contact(upper - lower, hl.contact.penalty(k=k), name="between"),
    ]
    compiled(hl.Scene(force=0, eom=[hl.mechanics.lagrange(L, contacts=contacts)], watch=[lower, upper]))


def test_a_wall_for_the_handle_alone_may_start_anywhere():
    wall = hl.contact.Contact(-0.5 * h0 - x(t), hl.contact.penalty(k=k), name="wall")
    body = hl.mechanics.lagrange(m * h.diff(t) ** 2 / 2, contacts=[wall])
    hl.compile(hl.Scene(force=-wall.generalized_force(x(t)), eom=[body], watch=[h]), T=1e-3)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (
            {"coulomb": F_c, "breakaway": F_s},
            r"rub: breakaway = F_s is below coulomb = F_c at the start, 0.2 < 0.4; a breakaway force is at least as",
        ),
        ({"coulomb": -F_c}, r"rub: coulomb = -F_c is -0.4 N at the start; friction opposes the slip"),
    ],
)
def test_friction_that_breaks_away_below_its_sliding_force_is_refused(law, words):
    rub = hl.contact.friction(slip=s.diff(t), name="rub", **law)
    sliding = hl.Scene(force=0, eom=[hl.mechanics.lagrange(m * s.diff(t) ** 2 / 2, contacts=[rub])], watch=[s])
    with pytest.raises(SceneError, match=words):
        compiled(sliding(F_s=0.2) if "breakaway" in law else sliding, hl.contact.rigid())
    if "breakaway" in law:
        compiled(sliding, hl.contact.rigid())


def test_friction_of_a_contact_is_compared_as_if_it_pressed():
    table = hl.contact.Contact(h, hl.contact.rigid(), name="table")
    rub = hl.contact.friction(slip=s.diff(t), coulomb=mu * table.force, breakaway=mu_s * table.force, name="rub")
    L = m * (h.diff(t) ** 2 + s.diff(t) ** 2) / 2 - m * g * h
    block = hl.Scene(force=0, eom=[hl.mechanics.lagrange(L, contacts=[table, rub])], watch=[s])
    compiled(block, hl.contact.rigid())
    with pytest.raises(SceneError, match=r"rub: breakaway = mu_s\*.* is below coulomb = mu\*.* at the start, 0.2 < 0.3"):
        compiled(block(mu_s=0.2), hl.contact.rigid())


def test_a_delayed_gap_has_a_start():
    assert numbers([hl.laws.delay(2 * h) + h], {}) == pytest.approx([0.12])
