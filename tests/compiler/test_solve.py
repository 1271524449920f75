"""The unrolled LDL^T and LU against LAPACK, and what structural zeros save."""

import numpy as np
import pytest

from hapticlab.compiler.solve import solve
from hapticlab.compiler.trace import Builder


def traced(M, f):
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
    block = builder.block(solve(rows, right))
    return block, [M[key] for key in numbers]


def random_matrix(N, symmetric, seed):
    generator = np.random.default_rng(seed)
    A = generator.normal(size=(N, N))
    return A @ A.T + N * np.eye(N) if symmetric else A + N * np.eye(N)


@pytest.mark.parametrize("N", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("symmetric", [True, False])
def test_the_solution_is_lapacks(N, symmetric):
    from hapticlab.compiler.interpreter import evaluate

    M, f = random_matrix(N, symmetric, N), np.random.default_rng(N + 50).normal(size=N)
    block, values = traced(M, f)
    outputs, _ = evaluate(block, param=[np.float64(q) for q in values], input=list(f), state=())
    # backward stable without pivoting on a diagonally heavy matrix: a few ulp of the condition number
    assert outputs == pytest.approx(np.linalg.solve(M, f), rel=1e-13 * np.linalg.cond(M))


def test_a_symmetric_matrix_costs_a_third_of_the_cube():
    """N^3/6 + O(N^2) multiplications for LDL^T, against N^3/3 for LU; N divisions either way.

    Counted by hand: LDL^T has C(N,3) in the products below the pivots, five triangles of C(N,2) (L D, pivots, scaling,
    forward, back) and N for the diagonal; LU has (N-1)N(2N-1)/6, three triangles and N.
    """
    count = {}
    for symmetric in (True, False):
        block, _ = traced(random_matrix(8, symmetric, 3), np.ones(8))
        ops = [i.op for i in block.instructions]
        count[symmetric] = ops.count("mul")
        assert ops.count("div") == 8
    assert count == {True: 56 + 5 * 28 + 8, False: 140 + 3 * 28 + 8}


def test_independent_blocks_are_solved_apart():
    """Zeros are structural: a block-diagonal matrix costs the sum of its blocks."""
    block = random_matrix(3, True, 9)
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = block
    both[3:, 3:] *= 2
    alone, _ = traced(block, np.ones(3))
    together, _ = traced(both, np.ones(6))
    assert len(together) == 2 * len(alone)
