"""The graph's derivatives against those of SymPy and against finite differences."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.compiler.algebra.graph import Graph, driven
from hapticlab.scene.notation.derivative import Partial, Rate
from hapticlab.scene.notation.symbols import acceleration

a, f = hl.parameters("a f", units="1 1/s")
p, q = hl.coordinate("p", unit="1"), hl.coordinate("q", unit="1")
dp, dq = p.diff(t), q.diff(t)
VARIABLES = (p, q, dp, dq, x(t), v(t), a)
SMOOTH = [
    sp.sin(p * q) * dp**2 + sp.cos(q - a) / (2 + p**2),
    sp.exp(-p) * sp.log(1 + q**2) * dq + sp.tan(a * p / 4),
    sp.sqrt(1 + p**2 + dq**2) - sp.atan(p * dp) * sp.tanh(q),
    (p + a) ** 5 / (1 + dp**4) + (2 + q) ** sp.Rational(3, 2) * x(t) + v(t) ** 3 * p,
    sp.sinh(p / 2) * sp.cosh(dq / 3) + sp.asin(q / 4) + sp.acos(p / 5) + sp.atan2(p + 2, q + 3),
    (p * q - dp) ** 2 * (p * q - dp) + (1.5 + q) ** a,
]
CORNERED = [
    abs(p - q) * dp, sp.Max(p, q, dp * dq) ** 2, sp.Min(p * q, 0.4), hl.when(p > q, p**2 * dq, sp.sin(q)),
    sp.sign(p - q) * p, hl.when((p > 0) & (q > 2), 1, p * q),
]  # fmt: skip


def points(seed, many=5):
    generator = np.random.default_rng(seed)
    return {e: generator.uniform(0.1, 0.9, many) for e in VARIABLES}


def by_sympy(expr, at):
    leaves = sorted(at, key=lambda e: not isinstance(e, sp.Derivative))  # rates first: q stands in q'
    names = dict(zip(leaves, sp.symbols(f"leaf:{len(leaves)}"), strict=True))
    return sp.lambdify([names[e] for e in at], expr.xreplace(names), "scipy")(*at.values())


@pytest.mark.parametrize("expr", SMOOTH, ids=str)
def test_gradient_is_that_of_sympy(expr):
    graph, at = Graph(), points(1)
    got = graph.evaluate([Partial(expr, e) for e in VARIABLES], at)
    for e, one in zip(VARIABLES, got, strict=True):
        np.testing.assert_allclose(one, np.broadcast_to(by_sympy(Partial(expr, e).doit(), at), one.shape), rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("expr", [*SMOOTH, *CORNERED], ids=str)
def test_gradient_is_that_of_finite_differences(expr):
    graph, at, h = Graph(), points(2), 1e-6
    for e in VARIABLES:
        (got,) = graph.evaluate([Partial(expr, e)], at)
        high, low = (graph.evaluate([expr], {**at, e: at[e] + step})[0] for step in (h, -h))
        np.testing.assert_allclose(got + 0 * high, (high - low) / (2 * h), rtol=1e-8, atol=2e-9)


@pytest.mark.parametrize("expr", SMOOTH[:4], ids=str)
@pytest.mark.always("sin*", "tan*", "(a*")
def test_second_derivatives_and_rates(expr):
    graph, at = Graph(), points(3) | {acceleration(t): np.linspace(-1, 1, 5)}
    nodes = [
        Partial(Partial(expr, dp), dq), Partial(Partial(expr, p), q), Partial(Partial(expr, dp), dp), Rate(Partial(expr, dp)),
        Rate(expr), Rate(Rate(expr.xreplace({dp: p, dq: q, v(t): a}))), Partial(Rate(expr), p),
    ]  # fmt: skip
    for node, got in zip(nodes, graph.evaluate(nodes, at), strict=True):
        np.testing.assert_allclose(got, np.broadcast_to(by_sympy(node.doit(), at), got.shape), rtol=1e-11, atol=1e-12)


def test_a_driven_angle_is_a_variable_of_its_own():
    graph = Graph()
    expr = a * sp.sin(2 * sp.pi * f * t)
    nodes = [Rate(expr), Rate(Rate(expr)), Partial(expr, a)]
    angle, (f_now, a_now) = 0.7, (3.0, 1.5)
    for node in nodes:
        graph(node)
    at = {e: {f: f_now, a: a_now}.get(e, angle) for e in graph.variables}
    got = [float(e) for e in graph.evaluate(nodes, at)]
    w = 2 * np.pi * f_now
    assert got == pytest.approx([a_now * w * np.cos(angle), -a_now * w**2 * np.sin(angle), np.sin(angle)], rel=1e-14)


def test_a_derivative_by_time_or_frequency_goes_through_the_angle():
    graph = Graph()
    expr = a * t * p**2 * sp.cos(2 * sp.pi * f * t)
    nodes = [
        Partial(expr, t), Partial(expr, f), Partial(expr, p), Partial(Partial(expr, t), t), Partial(Partial(expr, p), t),
        Partial(Partial(expr, t), p), Partial(Rate(expr), t), Partial(Partial(expr, f), t),
    ]  # fmt: skip
    for node in nodes:
        graph(node)
    at = {p: 0.7, dp: 1.1, t: 0.4, f: 3.0, a: 1.5}
    angles = {e: 2 * np.pi * 3.0 * 0.4 for e in graph.variables if isinstance(e, driven)}
    for node, got in zip(nodes, graph.evaluate(nodes, at | angles), strict=True):
        assert float(got) == pytest.approx(float(by_sympy(node.doit(), at)), rel=1e-12)


def test_parts_are_shared():
    """Of n links, the matrix is n^2 entries of a few operations each, not expressions that grow with n."""

    def size(n):
        angles = [hl.coordinate(f"q{k}", unit="rad") for k in range(n)]
        rates = [e.diff(t) for e in angles]
        vx = [sp.Add(*(sp.cos(e) * w for e, w in zip(angles[: k + 1], rates[: k + 1], strict=True))) for k in range(n)]
        vy = [sp.Add(*(sp.sin(e) * w for e, w in zip(angles[: k + 1], rates[: k + 1], strict=True))) for k in range(n)]
        L = sp.Add(*(c**2 + s**2 for c, s in zip(vx, vy, strict=True)))
        graph = Graph()
        for i in range(n):
            for j in range(i + 1):
                graph(Partial(Partial(L, rates[i]), rates[j]))
        return len(graph.builder.instructions)

    assert size(8) < 4.5 * size(4)


def test_what_is_fixed_is_a_constant():
    graph = Graph(fixed={"a": 2.0})
    assert graph(a * 3).constant == 6.0
    assert graph.variables_of([a * p, dq]) == [p, dq]
    assert graph(Partial(p**2, dq)).constant == 0.0


def test_evaluate_broadcasts():
    graph = Graph()
    got = graph.evaluate([p * q, a + 1], {p: np.arange(3.0), q: 2.0, a: 1.0})
    np.testing.assert_array_equal(got[0], [0.0, 2.0, 4.0])
    assert got[1].shape == ()
