"""Answers that are expressions and equations: what is the same is right, what is not is named, nothing hangs or raises."""

import numpy as np
import pytest
import sympy as sp
import sympy.physics.mechanics as me

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.course.check import checked
from hapticlab.course.evaluate import evaluate
from hapticlab.course.exercise import Case, Exercise
from hapticlab.course.expression import unit_remark, values
from hapticlab.course.variants import points, slips

k, x_o, b, m = hl.parameters("k x_o b m", units="N/m m N*s/m kg")
z = hl.coordinate("z", unit="m", initial=x(n))
PLAIN = dict(zip(("k", "x_o", "b"), sp.symbols("k x_o b"), strict=True))
RANGES = {"k": (50, 500), "b": (0.1, 2), "x(n)": (-0.01, 0.02), "x_o": (0.001, 0.01), "v(n)": (-0.3, 0.3)}
AT = points(np.random.default_rng(3), RANGES, boundary=("x(n)", "x_o"))
#: by hand: a wall is a spring beyond its boundary
FORCES = [max(0.0, stiffness * (at - edge)) for stiffness, at, edge in zip(AT["k"], AT["x(n)"], AT["x_o"], strict=True)]
WALL = Exercise("wall", "expression", points=1, asks="F_e", cases=[Case({"at": AT, "unit": "N"}, FORCES, unit="N")])
RIGHT = hl.when(x(n) >= x_o, k * (x(n) - x_o))
MOTION_AT = {"m": [0.1, 0.2], "b": [0.5, 0.5], "k": [100.0, 150.0], "x(t)": [0.01, 0.02], "z": [0.0, 0.03], "z'": [0.2, -0.1]}
MOTION = Exercise(
    "motion", "expression", points=1,
    cases=[Case({"at": MOTION_AT, "solve_for": "z''"}, [(1.0 - 0.1) / 0.1, (-1.5 + 0.05) / 0.2], unit="m/s^2")],
)  # fmt: skip


def solved(exercise, right, given, unit=""):
    """A case with the value expected and the slips, computed from a right answer."""
    return Case(given, evaluate(exercise.kind, right, given).value, unit=unit, slips=slips(exercise, right, given))


def said(exercise, answer):
    return checked(f"98.{exercise.name}", exercise, answer).text


@pytest.mark.parametrize(
    "same",
    [
        RIGHT,
        k * sp.Max(x(n) - x_o, 0),
        k * (sp.Abs(x(n) - x_o) + x(n) - x_o) / 2,
        k * (x(n) - x_o) * (1 + sp.sign(x(n) - x_o)) / 2,
        k * (x(n) - x_o) * sp.Heaviside(x(n) - x_o),
        sp.Piecewise((0, x(n) < x_o), (k * x(n) - k * x_o, True)),
        sp.sqrt(k**2) * sp.Max(x(n), x_o) - k * x_o,
        PLAIN["k"] * sp.Max(sp.Function("x")(sp.Symbol("n")) - PLAIN["x_o"], 0),
        sp.Integral(k * sp.Heaviside(x(n) - x_o), (sp.Symbol("s"), x_o, x(n))),
    ],
)
def test_another_way_to_write_the_same_is_right(same):
    assert checked("98.wall", WALL, same).passed, said(WALL, same)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (-RIGHT, "your force pulls"),
        (hl.when(x(n) >= 0, k * x(n)), "It does not change with x_o: did you forget x_o?"),
        (x(n) * RIGHT, "It is x(n) times too large, so its unit is wrong: should it be divided by x(n)?"),
        (RIGHT / k, "It does not change with k: did you forget k?"),
        (RIGHT + b * v(n), "It changes with b, on which it should not depend."),
        (k * (x(n) - x_o), "not zero where no force should act: is a condition missing or too wide? A scene writes it hl.when("),
        (hl.when(x(n) <= x_o, k * (x(n) - x_o)), "its condition is reversed, such as <= instead of >=."),
        (hl.when(x(n) >= 2 * x_o, k * (x(n) - x_o)), "is its condition too narrow?"),
        (RIGHT * 1000, "1000 times too large"),
        (RIGHT / 2, "It is half as large as expected: is a factor 2 missing,"),
        (RIGHT * 2 * sp.pi, "Hz and rad/s are mixed"),
        (RIGHT * 180 / sp.pi, "in degrees"),
        (0.7 * RIGHT, "It is 0.7 times the expected value, at every point."),
        (-RIGHT * k**2, "It is k^2 times too large, so its unit is wrong: should it be divided by k^2? The sign is also wrong."),
        (k * sp.Max(x(n) - x_o, 0) ** 2, "By the units of its symbols it is in N*m, needs N."),
        (k * x(n) + b * x(n), "b*x(n) is in N*s but k*x(n) is in N"),
        (m * RIGHT, "it contains m; it may contain k, b, x(n), x_o, v(n)"),
        (sp.Symbol("K") * (x(n) - x_o), "it contains K; it may contain k,"),
        (hl.laws.delay(RIGHT), "it contains x(n-1); it may contain k,"),
        (sp.Function("f")(x(n)), "it contains f(x(n));"),
        (k * sp.sqrt(x(n) - x_o), "it is a complex number at k = "),
        (k / (x(n) - x_o), "it has no finite value at k = "),
        (sp.nan, "no finite value"),
        (sp.Pow(10, sp.Pow(10, k, evaluate=False), evaluate=False), "no finite value"),
        (sp.Eq(sp.Symbol("F_e"), RIGHT), "it is an equation; needs an expression only,"),
        (x(n) > x_o, "needs an expression of symbols"),
        ("k*(x(n) - x_o)", "it is a str, needs an expression of symbols, without quotes"),
        (lambda x: x, "it is a function, needs an expression"),
        (hl.wall(), "it is a Scene, needs an expression"),
        ([RIGHT], "it is a list, needs an expression"),
        (sp.Matrix([RIGHT]), "needs an expression"),
        (True, "it is a bool, needs an expression"),
        (0.0, "It is zero at every point."),
        (k * x(n), "It does not change with x_o: did you forget x_o?"),
        (0.999 * RIGHT, "is a number rounded, or is a small term missing?"),
    ],
)
def test_what_is_wrong_is_named_from_the_values(answer, words):
    result = checked("98.wall", WALL, answer)
    assert not result.passed and result.answered
    assert words in result.text
    assert max(map(len, result.text.splitlines())) < 600


@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_said_of_a_symbol_where_what_is_expected_is_zero_anyway(seed):
    given = {"at": points(np.random.default_rng(seed), RANGES, boundary=("x(n)", "x_o")), "unit": "N"}
    wall = Exercise("wall", "expression", points=1, cases=[Case(given, evaluate("expression", RIGHT, given).value, unit="N")])
    assert "did you forget x_o?" in said(wall, k * x(n))
    assert "should not depend" not in said(wall, hl.when(x(n) >= 0, k * x(n)))


def test_a_wrong_point_is_shown_with_its_numbers():
    case = Case({"at": {"k": [200.0, 200.0], "x(n)": [0.01, 0.02]}}, [2.0, 4.0], unit="N")
    spring = Exercise("spring", "expression", points=1, cases=[case], hint="Hooke")
    assert "wrong: 1 of 2 points differ, first at k = 200, x(n) = 0.02: 8 N, expected 4 N" in said(spring, 2e4 * x(n) ** 2)
    assert said(spring, None) == "98.spring: not answered yet: "
    assert said(spring, k * x(n)).endswith("right: 2 points")


@pytest.mark.parametrize(
    "same",
    [
        sp.Eq(m * z.diff(t, 2), k * (x(t) - z) - b * z.diff(t)),
        sp.Eq(k * (x(t) - z), m * z.diff(t, 2) + b * z.diff(t)),
        m * z.diff(t, 2) + b * z.diff(t) - k * (x(t) - z),
        sp.Eq(z.diff(t, 2) / k, (k * (x(t) - z) - b * z.diff(t)) / m / k),
        [sp.Eq(m * z.diff(t, 2), k * (x(t) - z) - b * z.diff(t))],
        sp.Eq(sp.Derivative(m * z.diff(t), t), k * (x(t) - z) - b * sp.Derivative(z + 2, t)),
        sp.Eq(m, (k * (x(t) - z) - b * z.diff(t)) / z.diff(t, 2)),
        sp.Eq(z.diff(t, 2) / (k * (x(t) - z) - b * z.diff(t)), 1 / m),
        1 / (m * z.diff(t, 2)) - 1 / (k * (x(t) - z) - b * z.diff(t)),
    ],
)
def test_an_equation_of_motion_is_right_however_it_is_written(same):
    assert checked("98.motion", MOTION, same).passed, said(MOTION, same)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (k * (x(t) - z) / m, "it does not contain z''; needs an equation of motion"),
        (sp.Eq(m * z.diff(t, 2) ** 2, k * (x(t) - z)), "it is not linear in z''"),
        (sp.Eq(sp.Mul(0, 1) * z + m * (z.diff(t, 2) - z.diff(t, 2) * sp.cos(0 * z)), 1), "that is always False"),
        (sp.Eq(z.diff(t, 2) * (x(t) - x(t) * sp.sign(m)), k), "it cannot be solved for z''"),
        (sp.Eq(m * z.diff(t, 2), k * (x(n) - z)), "it contains x(n); it may contain m, b, k, x(t), z, z', z''"),
        (sp.Eq(m * z.diff(t, 3), k * (x(t) - z)), "it contains z'''"),
        (sp.Eq(z, z), "an equation that is always True"),
        ([sp.Eq(m * z.diff(t, 2), 0), sp.Eq(z, 0)], "it is 2 equations; needs 1, which are solved for z''"),
        (hl.wall(), "it is a Scene, needs an equation, sp.Eq(..., ...)"),
        (hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2), "it is a Mechanics, needs an equation, sp.Eq(..., ...)"),
        (sp.Eq(m * z.diff(t, 2), m / z.diff(t, 2)), "it is not linear in z''"),
        (sp.Eq(m * z.diff(t, 2), -k * (x(t) - z) + b * z.diff(t)), "The sign is wrong."),
        (sp.Eq(z.diff(t, 2), k * (x(t) - z) - b * z.diff(t)), "Derivative(z(t), (t, 2)) is in m/s^2 but "),
    ],
)
def test_a_wrong_equation_is_told_why(answer, words):
    result = checked("98.motion", MOTION, answer)
    assert not result.passed and words in result.text


def test_two_equations_are_solved_together():
    """A cart with a pendulum, by sympy.physics.mechanics, against its mass matrix worked out by hand."""
    q, angle = me.dynamicsymbols("q theta")
    M, l, g = sp.symbols("M l g")
    time = me.dynamicsymbols._t
    lagrangian = (
        (M + m) * q.diff(time) ** 2 / 2 + m * l * q.diff(time) * angle.diff(time) * sp.cos(angle)
        + m * l**2 * angle.diff(time) ** 2 / 2 + m * g * l * sp.cos(angle)
    )  # fmt: skip
    equations = list(me.LagrangesMethod(lagrangian, [q, angle]).form_lagranges_equations())
    at = {"M": 1.0, "m": 0.2, "l": 0.5, "g": 9.81, "theta": 0.4, "theta'": 2.0, "q": 0.1, "q'": 0.3}
    found = values(equations, {name: [number] for name, number in at.items()}, solve_for=["q''", "theta''"])
    mass = np.array([[1.2, 0.1 * np.cos(0.4)], [0.1 * np.cos(0.4), 0.05]])
    expected = np.linalg.solve(mass, [0.1 * 4 * np.sin(0.4), -0.981 * np.sin(0.4)])
    np.testing.assert_allclose([found["q''"][0], found["theta''"][0]], expected, rtol=1e-12)


def test_values_agree_with_sympy_simplify():
    """Whether the numbers call two expressions the same is what simplify says of their difference."""
    a, c, w = sp.symbols("a c w", positive=True)
    at = points(np.random.default_rng(5), {"a": (0.2, 3), "c": (0.2, 3), "w": (-1, 1)}, count=5)
    pairs = [
        (sp.sin(2 * w), 2 * sp.sin(w) * sp.cos(w)), (sp.log(a * c), sp.log(a) + sp.log(c)), (sp.sqrt(a**2), a),
        ((a**2 - c**2) / (a + c), a - c), (sp.exp(sp.I * w) + sp.exp(-sp.I * w), 2 * sp.cos(w)), (a**c, c**a),
        (sp.sin(w) ** 2, 1 - sp.cos(w)), (sp.sqrt(a + c), sp.sqrt(a) + sp.sqrt(c)), (sp.atan2(a, c), sp.atan(a / c)),
    ]  # fmt: skip
    for one, other in pairs:
        same = np.allclose(values(one, at), values(other, at), rtol=1e-9)
        assert same == (sp.simplify((one - other).rewrite(sp.cos)) == 0), (one, other)


def test_numbers_of_an_expression_are_those_of_lambdify():
    expression = sp.exp(-k * x(n)) * sp.cos(b * v(n)) / (1 + x_o**2) + sp.Min(k, 100)
    names = [k, x(n), b, v(n), x_o]
    columns = [np.array(AT[name]) for name in ("k", "x(n)", "b", "v(n)", "x_o")]
    np.testing.assert_allclose(values(expression, AT), sp.lambdify(names, expression)(*columns), rtol=1e-13)


def test_points_hold_the_pairs_and_the_boundary():
    names, rows = list(AT), list(zip(*AT.values(), strict=True))
    for place, name in enumerate(names):
        alone = [row for row in rows[1:] if [i for i in range(len(row)) if row[i] != rows[0][i]] == [place]]
        assert alone, name
    gaps = [at - edge for at, edge in zip(AT["x(n)"], AT["x_o"], strict=True)][-3:]
    assert gaps[0] < 0 and gaps[1] == 0 and gaps[2] > 0 and max(gaps) < 1e-4


def test_slips_of_a_known_answer_are_found_by_their_numbers():
    friction = RIGHT + hl.when(x(n) >= x_o, b * v(n))
    exercise = Exercise("damped", "expression", points=1)
    case = solved(exercise, friction, {"at": AT, "unit": "N"}, unit="N")
    exercise = Exercise("damped", "expression", points=1, cases=[case])
    touched = x(n) >= x_o
    for answer, words in [
        (friction, "right: 12 points"),
        (RIGHT, "You forgot b: your answer is the result with b = 0."),
        (RIGHT - hl.when(touched, b * v(n)), "The sign of the term with b, v(n), x(n), x_o is wrong."),
        (k * (x(n) - x_o) + hl.when(touched, b * v(n)), "not zero where no force should act"),
        (hl.when(touched, k * x(n)) + hl.when(touched, b * v(n)), "The term with x_o is missing."),
    ]:
        assert words in said(exercise, answer), said(exercise, answer)
    pendulum = solved(exercise, m * 9.81 * sp.sin(x_o / b), {"at": {"m": [0.1], "x_o": [0.05], "b": [0.1]}})
    sentences = {sentence: wrong for wrong, sentence in pendulum.slips}
    assert sentences["An angle in radians was treated as degrees."] == pytest.approx([0.981 * np.sin(np.radians(0.5))])
    assert sentences["sin and cos are swapped."] == pytest.approx([0.981 * np.cos(0.5)])


def test_slips_of_a_scene_are_what_it_does_with_them():
    given = {"x": [0.0, 0.004, 0.006, 0.006], "T": 1e-3, "values": {"k": 200.0, "b": 0.5}}
    found = {sentence: wrong for wrong, sentence in slips(
        Exercise("s", "scene"), hl.Scene(force=k * x(n) + b * v(n)), given)}  # fmt: skip
    assert found["The sign of the term with b, v(n) is wrong."] == pytest.approx([0.0, -1.2, 0.2, 1.2])
    assert found["You wrote x(n-1) instead of x(n)."] == pytest.approx([0.0, 2.0, 1.8, 1.2])


def test_units_are_told_only_of_what_is_wrong():
    given = {"at": {"b": [0.5], "x(n)": [0.002]}, "unit": "N"}
    outcome = evaluate("expression", b * x(n), given)
    assert outcome.value == [0.001] and "N*s" in outcome.problem
    assert checked("98.e", Exercise("e", "expression", points=1, cases=[Case(given, [0.001])]), b * x(n)).passed
    (told,) = checked("98.e", Exercise("e", "expression", points=1, cases=[Case(given, [0.7])]), b * x(n)).verdicts
    assert "N*s" in told.words and told.slip == "", "it comes from the student's process"


@pytest.mark.parametrize("weight", [9.81 * m, sp.Integer(10) * m, sp.Float("nan") * m])
def test_a_number_that_may_have_a_unit_is_not_blamed_for_the_units(weight):
    assert not unit_remark(sp.Eq(m * z.diff(t, 2), k * (x(t) - z) - weight))
    assert unit_remark(sp.Eq(m * z.diff(t, 2), k * (x(t) - z) / 2 - 1.5 * m))


def test_a_value_with_a_unit_of_pint_comes_in_si():
    registry = pytest.importorskip("pint").UnitRegistry()
    assert evaluate("value", registry.Quantity(0.2, "N/mm"), {}).value == pytest.approx(200.0)
    assert evaluate("function", lambda x: registry.Quantity(x, "mm"), {"x": [1.0, 2.0]}).value == pytest.approx([1e-3, 2e-3])
    assert evaluate("value", {"f": registry.Quantity(3.0, "kHz")}, {}).value == {"f": 3000.0}


@pytest.mark.parametrize("answer", [sp.Symbol("a"), sp.Order(k), sp.IndexedBase("x")[n], sp.oo, sp.zoo, sp.Function("f")(k)])
def test_what_has_no_number_is_refused_in_words(answer):
    outcome = evaluate("expression", answer, {"at": {"k": [1.0], "x_o": [1.0], "n": [1.0]}})
    assert outcome.value is None and outcome.problem
