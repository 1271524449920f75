"""The unrolled LDL^T and pivoted LU against LAPACK, what structural zeros save, and equations of motion that need pivots."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.algebra.graph import Graph
from hapticlab.compiler.algebra.linear_solve import solve
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.interpreter import evaluate
from hapticlab.compiler.ir.trace import Builder
from hapticlab.compiler.prune.mass_matrix import is_definite


def traced(M, f, definite=False):
    """Trace the solution of M a = f with every nonzero entry a parameter; symmetric entries share one."""
    builder, numbers = Builder("f64"), {}

    def entry(i, j):
        if M[i, j] == 0:
            return builder.const(0.0)
        key = (min(i, j), max(i, j)) if M[i, j] == M[j, i] else (i, j)
        return builder.leaf("param", numbers.setdefault(key, len(numbers)), "f64")

    N = len(f)
    rows = [[entry(i, j) for j in range(N)] for i in range(N)]
    right = [builder.leaf("input", i, "f64") for i in range(N)]
    block = builder.block(solve(rows, right, definite))
    return block, [M[key] for key in numbers]


def random_matrix(N, symmetric, seed):
    generator = np.random.default_rng(seed)
    A = generator.normal(size=(N, N))
    return A @ A.T + N * np.eye(N) if symmetric else A + N * np.eye(N)


@pytest.mark.parametrize("N", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("symmetric", [True, False])
def test_the_solution_is_lapacks(N, symmetric):
    M, f = random_matrix(N, symmetric, N), np.random.default_rng(N + 50).normal(size=N)
    block, values = traced(M, f, definite=symmetric)
    outputs, _ = evaluate(block, param=[np.float64(q) for q in values], input=list(f), state=())
    # backward stable without pivoting on a diagonally heavy matrix: a few ulp of the condition number
    assert outputs == pytest.approx(np.linalg.solve(M, f), rel=1e-13 * np.linalg.cond(M))


def test_a_symmetric_matrix_costs_a_third_of_the_cube():
    """N^3/6 + O(N^2) multiplications for LDL^T, against N^3/3 for LU; N divisions either way.

    Counted by hand: LDL^T has C(N,3) in the products below the pivots, four triangles of C(N,2) (pivots, scaling,
    forward, back) and N for the diagonal; LU has (N-1)N(2N-1)/6, three triangles and N.
    """
    count = {}
    for symmetric in (True, False):
        block, _ = traced(random_matrix(8, symmetric, 3), np.ones(8), definite=symmetric)
        ops = [i.op for i in block.instructions]
        count[symmetric] = ops.count("mul")
        assert ops.count("div") == 8
    assert count == {True: 56 + 4 * 28 + 8, False: 140 + 3 * 28 + 8}


@pytest.mark.parametrize("definite", [True, False])
def test_independent_blocks_are_solved_apart(definite):
    """Zeros are structural: a block-diagonal matrix costs the sum of its blocks."""
    block = random_matrix(3, True, 9)
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = block
    both[3:, 3:] *= 2
    alone, _ = traced(block, np.ones(3), definite)
    together, _ = traced(both, np.ones(6), definite)
    assert len(together) == 2 * len(alone)


def hollow(N, seed):
    """Return a full matrix without a diagonal, which no elimination without pivoting survives."""
    A = np.random.default_rng(seed).normal(size=(N, N))
    return A - np.diag(np.diag(A))


HARD = [
    np.array([[0.0, 1], [1, 0]]),
    np.array([[0.0, 1], [1, 1]]),
    np.array([[1.0, 1, 0], [1, 1, 1], [0, 1, 1]]),  # the second pivot vanishes, of a symmetric matrix
    np.array([[1e-20, 1], [1, 1e-20]]),
    *(hollow(N, N) for N in (2, 3, 4, 6)),
    *(hollow(N, N) + hollow(N, N).T for N in (3, 4, 6)),
]


@pytest.mark.parametrize("M", HARD, ids=str)
def test_a_matrix_without_good_pivots_is_solved(M):
    f = np.random.default_rng(7).normal(size=len(M))
    block, values = traced(M, f)
    outputs, _ = evaluate(block, param=[np.float64(q) for q in values], input=list(f), state=())
    expected = np.linalg.solve(M, f)
    # partial pivoting: a few ulp of the condition number, relative to the largest component
    assert np.abs(np.array(outputs) - expected).max() < 1e-14 * np.linalg.cond(M) * np.abs(expected).max()
    assert solve(M.tolist(), f.tolist()) == pytest.approx(np.array(outputs).tolist(), rel=1e-15)


def test_plain_floats_are_solved_and_a_singular_matrix_of_them_is_an_error():
    assert solve([[0, 1], [1, 0]], [1, 2]) == [2, 1]
    with pytest.raises(ZeroDivisionError):
        solve([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0])


def test_rows_of_constants_change_places_at_no_cost():
    b = Builder("f64")
    M = [[b.const(entry) for entry in row] for row in ((0.0, 2.0, 0.0), (0.0, 1.0, 4.0), (8.0, 0.0, 1.0))]
    block = b.block(solve(M, [b.leaf("input", k, "f64") for k in range(3)]))
    assert {i.op for i in block.instructions} <= {"const", "input", "mul", "sub"}
    outputs, _ = evaluate(block, input=[1.0, 2.0, 3.0], state=())
    numbers = [[entry.constant for entry in row] for row in M]
    assert outputs == pytest.approx(np.linalg.solve(numbers, [1.0, 2.0, 3.0]), rel=1e-15)


# equations of motion whose mass matrix is regular but has a small or vanishing pivot

m, K, L, I, e, m1, m2, k = hl.parameters(
    "m K L I e m1 m2 k", units="kg N/m m kg*m^2 1 kg kg N/m", values=(0.1, 300, 0.1, 1e-3, 1e-6, 1, 1, 100)
)
w, z = (hl.coordinate(name, unit="m") for name in "wz")
th = hl.coordinate("th", unit="rad")
ww, zz, tt = (q.diff(t, 2) for q in (w, z, th))
u = hl.parameters("u", units="m", values=0.001)
q0, q1, q2 = (hl.coordinate(f"q{i}", unit="m", initial=u * (i + 1)) for i in range(3))
a0, a1, a2 = (q.diff(t, 2) for q in (q0, q1, q2))
STILL, STEP = 0.01, 1e-3  # [m], [s]: the handle is held


def light_coupling(y):
    A = 0.1 * np.array([[1e-6, 1], [1, 1e-6]])
    return np.linalg.solve(A, [300 * (STILL - y[1]), 300 * (STILL - y[0])])


def difference_of_masses(y):
    return np.linalg.solve([[0, 1], [1, 1]], [300 * (STILL - y[0]), -300 * y[1]])


def chain_of_three(y):
    return np.linalg.solve(0.1 * np.array([[1, 1, 0], [1, 1, 1], [0, 1, 1]]), -300 * y[:3])


def lever(y):
    th, z = y[:2]
    A = [[1e-3 * np.sin(th), 0.01 * np.cos(th)], [0.01 * np.cos(th), 0.1 * np.sin(th)]]
    return np.linalg.solve(A, [300 * 0.1 * (STILL - z), 300 * (STILL - z)])


MOTIONS = {
    "small pivot": (
        [sp.Eq(m * e * ww + m * zz, K * (x(t) - z)), sp.Eq(m * ww + m * e * zz, K * (x(t) - w))],
        (w, z), (0, 0), light_coupling,
    ),
    "zero pivot": (
        [sp.Eq((m1 - m2) * ww + m1 * zz, K * (x(t) - w)), sp.Eq(m1 * ww + m2 * zz, -K * z)],
        (w, z), (0, 0), difference_of_masses,
    ),
    "second pivot": (
        [sp.Eq(m * (a0 + a1), -K * q0), sp.Eq(m * (a0 + a1 + a2), -K * q1), sp.Eq(m * (a1 + a2), -K * q2)],
        (q0, q1, q2), (0.001, 0.002, 0.003), chain_of_three,
    ),
    "zero at the start": (
        [
            sp.Eq(m * L * sp.cos(th) * zz + I * sp.sin(th) * tt, K * L * (x(t) - z)),
            sp.Eq(m * sp.sin(th) * zz + m * L * sp.cos(th) * tt, K * (x(t) - z)),
        ],
        (th, z), (0, 0), lever,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("dtype, tolerance", [("float64", 1e-8), ("float32", 3e-5)])
@pytest.mark.always("float64-*-zero pivot", "float64-*-second pivot")
def test_equations_that_need_pivots_follow_scipy(name, dtype, tolerance):
    eom, coordinates, start, accelerations = MOTIONS[name]
    N, ticks = len(start), 12
    scene = hl.Scene(force=0 * k * x(n), eom=eom, watch={f"y{j}": q for j, q in enumerate(coordinates)})
    assert not is_definite(scene.explicit(), scene.values, Graph())
    program = hl.compile(scene, "rk4", T=STEP, dtype=dtype, substeps=4)
    computed = load(program).run(ticks, np.full(ticks, STILL)).outputs[:, 1:, 0]
    times = STEP * np.arange(ticks)
    exact = solve_ivp(
        lambda _, y: np.concatenate([y[N:], accelerations(y)]), (0, times[-1]), [*start, *[0] * N],
        method="DOP853", rtol=1e-12, atol=1e-14, t_eval=times,
    ).y[:N].T  # fmt: skip
    assert np.ptp(exact) > 1e-4  # [m], it moved
    # RK4 at a quarter of a millisecond, or the rounding of float32 over 48 steps
    assert np.abs(computed - exact).max() < tolerance * np.abs(exact).max()


def test_a_definite_mass_is_recognised_and_any_other_is_not():
    pair = [sp.Eq(m * ww + m / 2 * zz, -K * w), sp.Eq(m / 2 * ww + m * zz, -K * z)]

    def definite(eom, **values):
        scene = hl.Scene(force=0 * k * x(n), eom=eom, values=values)
        return is_definite(scene.explicit(), scene.values, Graph())

    assert definite(pair)
    assert definite([sp.Eq(-e.lhs, -e.rhs) for e in pair])  # negative definite
    assert not definite([pair[0], sp.Eq(-pair[1].lhs, -pair[1].rhs)])  # not symmetric
    coupled = [sp.Eq(m1 * ww + m * zz, -K * w), sp.Eq(m * ww + m2 * zz, -K * z)]
    assert definite(coupled, m=0.5) and not definite(coupled, m=2)  # bound values decide
    for heavier, yes in ((sp.Rational(11, 10), True), (sp.Rational(3, 4), False)):  # there only where cos(th)**2 < 3/4
        swing = sp.Eq(heavier * m * L**2 * tt + m * L * sp.cos(th) * zz, 0)
        assert definite([swing, sp.Eq(m * L * sp.cos(th) * tt + m * zz, -K * z)]) is yes
