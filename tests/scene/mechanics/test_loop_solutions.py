"""Loops solved in closed form, against the textbook's formulas and against the constraints themselves over a turn."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.errors import SceneError
from hapticlab.scene.mechanics.loop_solutions import embed, is_holonomic
from hapticlab.scene.mechanics.loop_terms import NotClosed, number

r, L, l3, g, e = hl.parameters("r L l3 g e", units="m m m m m")
theta, phi = hl.coordinate("theta", unit="rad"), hl.coordinate("phi", unit="rad")
s = hl.coordinate("s", unit="m")
q2, q3, q4 = (hl.coordinate(name, unit="rad") for name in ("q2", "q3", "q4"))
SLIDER_CRANK = [r * sp.cos(theta) + L * sp.cos(phi) - s, r * sp.sin(theta) - L * sp.sin(phi)]
FOUR_BAR = [
    r * sp.cos(q2) + L * sp.cos(q3) - l3 * sp.cos(q4) - g,
    r * sp.sin(q2) + L * sp.sin(q3) - l3 * sp.sin(q4),
]
GRASHOF = {r: 0.03, L: 0.1, l3: 0.08, g: 0.09}
TURN = np.linspace(-math.pi, math.pi, 401)


def slider_crank(at=0.7, crank=0.03, rod=0.1):
    angle = math.asin(crank / rod * math.sin(at))
    return {theta: at, phi: angle, s: crank * math.cos(at) + rod * math.cos(angle), r: crank, L: rod}


def four_bar(lengths, at=1.0, side=1):
    """Return a start of the four-bar by intersecting two circles with complex numbers."""
    crank, coupler, rocker, ground = (lengths[p] for p in (r, L, l3, g))
    d = ground - crank * np.exp(1j * at)
    along = (coupler**2 - rocker**2 + abs(d) ** 2) / (2 * abs(d))
    arm = d / abs(d) * (along + side * 1j * math.sqrt(coupler**2 - along**2))
    return {q2: at, q3: float(np.angle(arm)), q4: float(np.angle(arm - d)), **lengths}


def swept(embedding, start, driver, values):
    """Return every coordinate along a sweep of the driver, and the largest error of the cosines and sines beside it."""
    at, error = {**start, driver: values}, 0.0
    for step in embedding.steps:
        at[step.coordinate] = number(step.value, at)
        for given, kind in ((step.cos, np.cos), (step.sin, np.sin)):
            if given is not None:
                error = max(error, np.max(np.abs(number(given, at) - kind(at[step.coordinate]))))
    return at, error


def residual(constraints, at):
    return max(np.max(np.abs(number(c, at))) for c in constraints)


def test_slider_crank_is_the_textbook_formula():
    start = slider_crank()
    found = embed(SLIDER_CRANK, [phi, s, theta], start)
    assert found.drivers == (theta,)
    at, error = swept(found, start, theta, TURN)
    # Norton, Design of Machinery, section 4.6
    stroke = 0.03 * np.cos(TURN) + np.sqrt(0.1**2 - (0.03 * np.sin(TURN)) ** 2)
    np.testing.assert_allclose(at[s], stroke, rtol=4e-16)
    assert error < 1e-15


def test_four_bar_is_freudenstein_on_both_assemblies():
    k1, k2, k3 = 0.09 / 0.03, 0.09 / 0.08, (0.03**2 - 0.1**2 + 0.08**2 + 0.09**2) / (2 * 0.03 * 0.08)
    A, B = np.cos(TURN) - k1 - k2 * np.cos(TURN) + k3, -2 * np.sin(TURN)
    C = k1 - (k2 + 1) * np.cos(TURN) + k3
    for side in (1, -1):
        start = four_bar(GRASHOF, side=side)
        found = embed(FOUR_BAR, [q2, q3, q4], start)
        assert found.drivers == (q2,)
        assert found.wraps == frozenset()
        at, error = swept(found, start, q2, TURN)
        rocker = 2 * np.arctan2(-B - side * np.sqrt(B**2 - 4 * A * C), 2 * A)  # Norton, Eq. (4.10b)
        np.testing.assert_allclose(np.exp(1j * at[q4]), np.exp(1j * rocker), atol=1e-14)
        assert residual(FOUR_BAR, at) < 1e-16
        assert error < 1e-14


def test_relative_angles_are_the_absolute_ones_less_each_other():
    relative = [c.subs({q3: q2 + q3, q4: q2 + q3 + q4}, simultaneous=True) for c in FOUR_BAR]
    absolute = four_bar(GRASHOF)
    # whole turns are kept as they were given
    start = {**absolute, q3: absolute[q3] - absolute[q2] + 2 * math.pi, q4: absolute[q4] - absolute[q3]}
    at, _ = swept(embed(relative, [q2, q3, q4], start), start, q2, TURN)
    reference, _ = swept(embed(FOUR_BAR, [q2, q3, q4], absolute), absolute, q2, TURN)
    np.testing.assert_allclose(at[q3], reference[q3] - TURN + 2 * math.pi, atol=1e-14)
    np.testing.assert_allclose(at[q4], reference[q4] - reference[q3], atol=1e-14)


def test_a_rod_given_by_its_length_alone():
    rod = (g + l3 * sp.cos(q4) - r * sp.cos(q2)) ** 2 + (l3 * sp.sin(q4) - r * sp.sin(q2)) ** 2 - L**2
    start = four_bar(GRASHOF)
    at, _ = swept(embed([rod], [q2, q4], start), start, q2, TURN)
    assert residual([rod], at) < 1e-17
    assert abs(number(rod, {**start, q4: start[q4] + 1e-3})) > 1e-6


def test_a_slide_that_turns_offset_from_its_pivot():
    slide = [
        r * sp.cos(theta) - g - s * sp.cos(phi) + e * sp.sin(phi),
        r * sp.sin(theta) - s * sp.sin(phi) - e * sp.cos(phi),
    ]
    tip = 0.03 * np.exp(0.8j) - 0.09
    length = math.sqrt(abs(tip) ** 2 - 0.01**2)
    start = {theta: 0.8, s: length, phi: float(np.angle(tip / (length + 0.01j))), r: 0.03, g: 0.09, e: 0.01}
    found = embed(slide, [phi, s, theta], start)
    assert found.drivers == (theta,)
    at, _ = swept(found, start, theta, TURN)
    np.testing.assert_allclose(at[s], np.sqrt(np.abs(0.03 * np.exp(1j * TURN) - 0.09) ** 2 - 0.01**2), rtol=1e-14)
    assert residual(slide, at) < 1e-16


def test_one_dyad_after_another():
    q5, q6 = hl.coordinate("q5", unit="rad"), hl.coordinate("q6", unit="rad")
    second = [0.056 * sp.cos(q4) + 0.06 * sp.cos(q5) - 0.07 * sp.cos(q6) - 0.05,
              0.056 * sp.sin(q4) + 0.06 * sp.sin(q5) - 0.07 * sp.sin(q6)]  # fmt: skip
    start = four_bar(GRASHOF)
    d = 0.05 - 0.056 * np.exp(1j * start[q4])
    along = (0.06**2 - 0.07**2 + abs(d) ** 2) / (2 * abs(d))
    arm = d / abs(d) * (along + 1j * math.sqrt(0.06**2 - along**2))
    start |= {q5: float(np.angle(arm)), q6: float(np.angle(arm - d))}
    constraints = [*second, *FOUR_BAR]
    found = embed(constraints, [q2, q3, q4, q5, q6], start)
    assert [step.coordinate for step in found.steps] == [q3, q4, q5, q6]
    at, _ = swept(found, start, q2, TURN)
    assert residual(constraints, at) < 1e-16


def test_gears_screws_and_moving_supports_are_linear():
    pitch = hl.parameters("pitch", units="m")
    found = embed([theta + 3 * phi, s - pitch * theta - hl.x(hl.t)], [phi, s, theta], {
        phi: 0.0, theta: 0.0, s: 0.02, pitch: 0.01, hl.x(hl.t): 0.02, hl.t: 0.0})  # fmt: skip
    at = {theta: 0.3, phi: 0.5, s: 0.04, pitch: 0.013, hl.x(hl.t): 0.07}
    for step in found.steps:
        at[step.coordinate] = number(step.value, at)
    assert len(found.steps) == 2
    np.testing.assert_allclose((at[theta], at[s]), (-3 * at[phi], 0.013 * at[theta] + 0.07), rtol=1e-14)


def test_a_crank_that_turns_its_coupler_wraps():
    drag_link = four_bar({r: 0.08, L: 0.06, l3: 0.09, g: 0.03})
    found = embed(FOUR_BAR, [q2, q3, q4], drag_link)
    assert found.wraps == {q3, q4}
    at, error = swept(found, drag_link, q2, TURN)
    assert residual(FOUR_BAR, at) < 1e-15
    assert error < 1e-13


def test_the_longer_link_drives_where_the_shorter_cannot_turn():
    start = slider_crank(0.2, crank=0.1, rod=0.03)
    assert embed(SLIDER_CRANK, [phi, s, theta], start).drivers == (phi,)


def test_a_range_over_which_the_loop_cannot_close():
    crank = hl.coordinate("theta", unit="rad", range=(-3, 3))
    start = {crank if symbol == theta else symbol: value for symbol, value in slider_crank(0.2, 0.1, 0.03).items()}
    constraints = [c.subs(theta, crank) for c in SLIDER_CRANK]
    with pytest.raises(SceneError, match=r"cannot close at theta = .*closes from theta = -0\.3 to 0\.3"):
        embed(constraints, [phi, s, crank], start)
    # the range of the crank is asin(L/r) = 0.3047 rad
    narrow = hl.coordinate("theta", unit="rad", range=(-0.304, 0.304))
    start = {narrow if symbol == crank else symbol: value for symbol, value in start.items()}
    assert embed([c.subs(theta, narrow) for c in SLIDER_CRANK], [phi, s, narrow], start).drivers == (narrow,)


@pytest.mark.parametrize(
    ("lengths", "word"),
    [
        ({r: 0.06, L: 0.1, l3: 0.06, g: 0.1}, r"change point at q2 = (-?3\.142|6\.|0)"),
        ({r: 0.05, L: 0.05, l3: 0.06, g: 0.12}, r"cannot close at q2 = .*closes from q2 = -1\.\d+ to 1\."),
    ],
)
def test_loops_without_a_closed_form_say_where(lengths, word):
    with pytest.raises(NotClosed, match=word):
        embed(FOUR_BAR, [q2, q3, q4], four_bar(lengths, at=0.4))


def test_a_start_off_the_constraint_names_the_value_to_take():
    start = slider_crank()
    wanted = start[phi]
    with pytest.raises(SceneError, match="does not satisfy the constraint.*its left side is") as caught:
        embed(SLIDER_CRANK, [phi, s, theta], {**start, phi: 0.2})
    assert f"Start with phi = {wanted:.12f}"[:28] in str(caught.value)
    embed(SLIDER_CRANK, [phi, s, theta], {**start, phi: round(wanted, 9)})


def test_a_pendulum_in_x_and_y_needs_a_range():
    X, Y = hl.coordinate("X", unit="m"), hl.coordinate("Y", unit="m")
    start = {X: 0.06, Y: -0.08, L: 0.1}
    with pytest.raises(NotClosed, match="no declared range"):
        embed([X**2 + Y**2 - L**2], [X, Y], start)
    held = hl.coordinate("X", unit="m", range=(-0.09, 0.09))
    found = embed([held**2 + Y**2 - L**2], [held, Y], {held: 0.06, Y: -0.08, L: 0.1})
    np.testing.assert_allclose(number(found.steps[0].value, {held: 0.03, L: 0.1}), -math.sqrt(0.1**2 - 0.03**2), rtol=1e-15)


def test_what_is_no_dyad_is_left_to_others():
    with pytest.raises(NotClosed, match="third degree|no closed form|neither"):
        embed([s**3 - L**2 * theta * s], [s, theta], {s: 0.1, theta: 1.0, L: 0.1})
    with pytest.raises(SceneError, match="constrains nothing"):
        embed([L - r], [s], {s: 0.1, L: 0.1, r: 0.1})
    with pytest.raises(NotClosed, match="more constraints than coordinates"):
        embed([s - L, s - r], [s], {s: 0.1, L: 0.1, r: 0.1})


def test_holonomic():
    assert is_holonomic(FOUR_BAR[0])
    assert not is_holonomic(s.diff(hl.t) - r * theta.diff(hl.t))
    assert not is_holonomic(s - r * hl.v(hl.t))


def test_a_five_bar_is_driven_by_its_two_cranks():
    low, high = (1.2, 2.2), (0.9, 1.9)
    left, right = hl.coordinate("left", unit="rad", range=low), hl.coordinate("right", unit="rad", range=high)
    loop = [
        r * sp.cos(left) + L * sp.cos(phi) - L * sp.cos(q3) - r * sp.cos(right) - g,
        r * sp.sin(left) + L * sp.sin(phi) - L * sp.sin(q3) - r * sp.sin(right),
    ]

    def elbows(link):
        d = 0.06 + 0.08 * (np.exp(1j * 1.3) - np.exp(1j * 1.8))
        arm = d / 2 + 1j * d / abs(d) * math.sqrt(link**2 - abs(d) ** 2 / 4)
        return {phi: float(np.angle(arm)), q3: float(np.angle(arm - d))}

    start = {left: 1.8, right: 1.3, r: 0.08, L: 0.1, g: 0.06, **elbows(0.1)}
    found = embed(loop, [left, phi, q3, right], start)
    assert found.drivers == (left, right)
    generator = np.random.default_rng(3)
    at = {**start, left: generator.uniform(*low, 100), right: generator.uniform(*high, 100)}
    for step in found.steps:
        at[step.coordinate] = number(step.value, at)
    assert residual(loop, at) < 1e-15
    # the elbows stay on their side
    assert np.all(np.sin(at[q3] - at[phi]) > 0) == (math.sin(start[q3] - start[phi]) > 0)
    with pytest.raises(SceneError, match="cannot close at left = .*, right = "):
        embed(loop, [left, phi, q3, right], start | {L: 0.06, **elbows(0.06)})
