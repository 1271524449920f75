"""Every function a student may write, against mpmath through SymPy's own evaluation."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, x
from hapticlab.compiler.algebra import expressions
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import HapticlabError, ProgramLimitError

L, F = hl.parameters("L F_0", units="m N", values=(1.0, 1.0))
u = x(n) / L

FUNCTIONS = [
    sp.sin(u), sp.cos(3 * u), sp.tan(u), sp.exp(-2 * u), sp.log(2 + u), sp.atan(4 * u), sp.tanh(3 * u),
    sp.sinh(u), sp.cosh(u), sp.asin(u / 2), sp.acos(u / 2), sp.atan2(u, u - 1), sp.atan2(-u, u - sp.Rational(1, 3)),
    sp.atan2(3, u), sp.atan2(-3, u), sp.atan2(u, 2), sp.atan2(u, -2),
    sp.Abs(u), sp.sign(u), sp.Heaviside(u, 1), sp.floor(5 * u), sp.ceiling(5 * u), sp.Min(u, u**2, sp.Rational(1, 5)),
    sp.Max(u, -u, sp.Rational(1, 3)), u**2, u**5, (2 + u) ** sp.Rational(3, 2), 1 / sp.sqrt(2 + u), (2 + u) ** sp.pi,
    1 / (3 + u) ** 3, sp.Piecewise((1, u > sp.Rational(1, 2)), (2, u > 0), (3, True)), sp.pi * u - sp.E,
    sp.Piecewise((u, (u < 0) | (u > sp.Rational(1, 2))), (7, ~(u < sp.Rational(1, 4))), (-u, True)),
    sp.Piecewise((1, sp.Ne(u, 0)), (2, True)), (u + 2) / (u - 2) / (u + 3), sp.sqrt(u**2 + 1) - 1,
    u % sp.Rational(1, 5), sp.Mod(x(n), -L / 3) / L,
]  # fmt: skip


@pytest.mark.parametrize("function", FUNCTIONS, ids=str)
@pytest.mark.always("sin(*", "exp(*", "log(*", "tanh(*", "acos(*", "atan2(-*", "sign(*", "floor(*", "Max(*", "x(n)*")
def test_a_function_has_the_value_mpmath_gives(function):
    points = np.array([-0.97, -0.41, -1e-9, 0.0, 0.1, 0.25, 0.61, 0.99])
    program = hl.compile(hl.Scene(force=F * function), T=1e-3, dtype="float64")
    computed = load(program).run(len(points), points[:, None]).outputs[:, 0, 0]
    expected = [float(function.subs({x(n): sp.Float(p, 40), L: 1}).evalf(30)) for p in points]
    # 2 ulp per elementary function and one per operation around it; cancellation near zero is absolute
    np.testing.assert_allclose(computed, expected, rtol=2e-15, atol=4e-16)


@pytest.mark.parametrize("exponent", [2.0, -2.0, 1.5, -0.5])
def test_a_float_exponent_is_the_fraction_it_stands_for(exponent):
    """A student's 2.0 is as good as 2, below zero too; exp(2 log(a)) would be nan there."""
    points = np.array([-0.7, -0.2, 0.3, 0.9]) if float(exponent).is_integer() else np.array([0.2, 0.7])
    program = hl.compile(hl.Scene(force=F * u**exponent), T=1e-3, dtype="float64")
    computed = load(program).run(len(points), points[:, None]).outputs[:, 0, 0]
    np.testing.assert_allclose(computed, points**exponent, rtol=1e-15)
    assert not {i.op for i in program.tick.instructions} & {"exp", "log"}


depth = hl.when(u >= 0.25, u - 0.25)
fast = hl.when(u > 0.5, 1, -1)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        (depth > 0, lambda a: a > 0.25),
        (sp.Max(depth, 0) > 0, lambda a: a > 0.25),
        (sp.Abs(depth) > 0, lambda a: a > 0.25),
        ((depth > 0) & (u < 0.9), lambda a: (a > 0.25) & (a < 0.9)),
        (fast > 0, lambda a: a > 0.5),
        (sp.Xor(u > 0, u > 0.5), lambda a: (a > 0) != (a > 0.5)),
        (sp.Xor(u > 0, u > 0.5, u > -0.5), lambda a: (a > 0) ^ (a > 0.5) ^ (a > -0.5)),
        (sp.ITE(u > 0, u > 0.5, u < -0.5), lambda a: np.where(a > 0, a > 0.5, a < -0.5)),
    ],
    ids=lambda v: str(v) if isinstance(v, sp.Basic) else "holds",  # a function's address differs between processes
)
def test_cases_may_stand_in_a_condition(condition, holds):
    points = np.array([-0.9, -0.3, 0.0, 0.1, 0.25, 0.3, 0.5, 0.7, 0.95])
    # by hl.when, which keeps what was written, and by SymPy's own Piecewise, which folds it
    for force in (hl.when(condition, 3 * F, F), sp.Piecewise((3 * F, condition), (F, True))):
        program = hl.compile(hl.Scene(force=force), T=1e-3, dtype="float64")
        computed = load(program).run(len(points), points[:, None]).outputs[:, 0, 0]
        np.testing.assert_array_equal(computed, np.where(holds(points), 3.0, 1.0))


def test_shared_subexpressions_are_computed_once():
    shared = sp.sin(u + 2)
    once = hl.compile(hl.Scene(force=F * shared), T=1e-3)
    twice = hl.compile(hl.Scene(force=F * shared + F * sp.atan(shared)), T=1e-3)
    assert len(twice) == len(once) + 3  # an atan, a product with F and a sum


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        (sp.gamma(u), "unknown function gamma.*the functions that run at the sample rate are.*atan2"),
        (sp.Piecewise((1, u > 0)), "no case for when"),
        (sp.I * u, "not a real number"),
        (sp.zoo * F / F, "not a real number"),
        (hl.when(sp.And(F, u > 0), u), "F_0 is a number where .* needs a condition"),
        (hl.when(sp.Eq(u > 0, u > 1), u), "compares conditions"),
    ],
)
def test_what_cannot_run_is_refused(expression, words):
    with pytest.raises(HapticlabError, match=words):
        hl.compile(hl.Scene(force=F * expression), T=1e-3)


def test_a_program_past_its_limit_is_refused_before_it_exhausts_the_machine(monkeypatch):
    monkeypatch.setattr(expressions, "MOST_INSTRUCTIONS", 500)  # SymPy alone takes half a minute to write 50 000
    huge = sp.Add(*(sp.sin(u * k + 1) for k in range(200)))
    with pytest.raises(
        ProgramLimitError,
        match=r"more than 500 instructions: 506 of them are for sin\(1 \+ x\(n\)/L\) \+ sin\(1 \+.*; write it with fewer terms",
    ):
        hl.compile(hl.Scene(force=F * huge), T=1e-3)


def test_an_expression_nested_too_deeply_is_refused_in_words():
    deep = u
    for _ in range(320):
        deep = sp.sin(deep, evaluate=False)
        assert deep.is_commutative  # SymPy remembers each level, as it does when a student builds up a term
    with pytest.raises(HapticlabError, match="nested too deeply"):
        hl.compile(hl.Scene(force=F * deep), T=1e-3)
