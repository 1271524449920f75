"""Contact reactions against exact fractions, non-negative least squares and statics; order, repeats and structure."""

from fractions import Fraction
from itertools import combinations, permutations

import numpy as np
import pytest
from scipy.optimize import nnls

from hapticlab.compiler.algebra.complementarity import complementarity, constrained, islands, reactions, response
from hapticlab.compiler.engines.interpreter import evaluate
from hapticlab.compiler.ir.trace import Builder
from hapticlab.errors import SceneError


def in_fractions(W, q):
    """Solve the complementarity problem of integers by brute force: Gauss-Jordan in fractions, every active set."""
    k = len(q)
    for n in range(k + 1):
        for active in combinations(range(k), n):
            rows = [[Fraction(W[i][j]) for j in active] + [Fraction(-q[i])] for i in active]
            for c in range(n):
                pivot = next((r for r in range(c, n) if rows[r][c]), None)
                if pivot is None:
                    break
                rows[c], rows[pivot] = rows[pivot], rows[c]
                rows[c] = [a / rows[c][c] for a in rows[c]]
                rows = [r if i == c else [a - r[c] * b for a, b in zip(r, rows[c], strict=True)] for i, r in enumerate(rows)]
            else:
                p = [Fraction(0)] * k
                for i, row in zip(active, rows, strict=True):
                    p[i] = row[-1]
                z = [sum(Fraction(w) * b for w, b in zip(row, p, strict=True)) + r for row, r in zip(W, q, strict=True)]
                if min(p) >= 0 and min(z) >= 0:
                    return p
    raise AssertionError("no solution")


def gram(k, seed, scale=1):
    """Return W = A A^T + 1 of integers, never singular, and a q of both signs."""
    generator = np.random.default_rng(seed)
    A = generator.integers(-9, 10, (k, k)) * np.where(np.arange(k) % 2, scale, 1)
    return (A @ A.T + np.eye(k, dtype=int)).tolist(), generator.integers(-30, 15, k).tolist()


def floats(W, q):
    return [[float(w) for w in row] for row in W], [float(r) for r in q]


@pytest.mark.parametrize("k", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", range(12))
def test_the_solution_is_that_of_exact_fractions(k, seed):
    W, q = gram(k, 100 * k + seed)
    # the solution of the active set is as sensitive as W is ill-conditioned
    tolerance = 1e-15 * np.linalg.cond(np.array(W, float)) + 1e-13
    exact = [float(p) for p in in_fractions(W, q)]
    assert complementarity(*floats(W, q)) == pytest.approx(exact, rel=tolerance, abs=tolerance * max(exact + [1.0]))


@pytest.mark.parametrize("seed", range(12))
def test_the_solution_is_that_of_non_negative_least_squares(seed):
    """min |L^T p + L^-1 q| over p >= 0 has the same optimality conditions; masses spread a hundredfold."""
    generator = np.random.default_rng(seed)
    J, masses = generator.normal(size=(3, 4)), 10.0 ** generator.uniform(-2, 0, 4)
    W, _ = response(np.diag(masses).tolist(), J.tolist())
    q = generator.normal(size=3) - 0.5
    L = np.linalg.cholesky(np.array(W))
    expected, _ = nnls(L.T, -np.linalg.solve(L, q))
    assert complementarity(W, q.tolist()) == pytest.approx(expected.tolist(), rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_the_contacts_does_not_matter(seed):
    W, q = floats(*gram(3, seed))
    p = complementarity(W, q)
    assert any(p)
    for order in permutations(range(3)):
        again = complementarity([[W[i][j] for j in order] for i in order], [q[i] for i in order])
        assert again == pytest.approx([p[i] for i in order], rel=1e-12, abs=1e-13)


def test_contacts_that_repeat_each_other_share_evenly():
    """The same contact three times: W is of rank one, and any split of p would do."""
    assert complementarity([[2.0] * 3] * 3, [-3.0] * 3) == pytest.approx([0.5, 0.5, 0.5], rel=1e-15)
    # twice, beside a third one
    W = [[2.0, 2.0, 1.0], [2.0, 2.0, 1.0], [1.0, 1.0, 3.0]]
    p = complementarity(W, [-4.0, -4.0, -4.5])
    alone = [float(r) for r in in_fractions([[2, 1], [1, 3]], [Fraction(-4), Fraction(-9, 2)])]
    assert p == pytest.approx([alone[0] / 2, alone[0] / 2, alone[1]], rel=1e-14)


def test_three_legs_in_a_plane_are_one_too_many():
    """A plank on three supports, rank two: the reactions are not unique, the motion is, and it is symmetric."""
    m, inertia = 2.0, 0.5
    J = [[1.0, -1.0], [1.0, 0.0], [1.0, 1.0]]
    W, _ = response([[m, 0.0], [0.0, inertia]], J)
    p = complementarity(W, [-9.81] * 3)
    assert sum(p) == pytest.approx(9.81 * m, rel=1e-13)
    assert p[0] == pytest.approx(p[2], rel=1e-13)
    assert min(np.array(W) @ p - 9.81) > -1e-13


def test_a_contact_that_does_not_touch_takes_no_part():
    W, q = [[2.0, -1.0], [-1.0, 2.0]], [-3.0, 0.0]
    assert complementarity(W, q, [True, False]) == [1.5, 0.0]
    assert complementarity(W, q, [False, False]) == [0.0, 0.0]


def test_mass_ratio_of_a_hundred_is_exact():
    """Two contacts in a chain under a heavy body, where fifty rounds of Gauss-Seidel are still half wrong."""
    m, M, g = 0.01, 1.0, 9.81
    W, _ = response([[m, 0.0], [0.0, M]], [[1.0, 0.0], [-1.0, 1.0]])
    assert complementarity(W, [-g, 0.0]) == pytest.approx([(m + M) * g, M * g], rel=1e-13)


def traced(W, q, real="f64"):
    """Trace the problem with every entry an input; return the block."""
    builder, k = Builder(real), len(q)
    leaves = iter(builder.leaf("input", i, real) for i in range(k * (k + 1) // 2 + 2 * k))
    entries = [[None] * k for _ in range(k)]
    for i in range(k):
        for j in range(i + 1):
            entries[i][j] = entries[j][i] = builder.const(0.0) if W[i][j] == 0 else next(leaves)
    right = [next(leaves) for _ in range(k)]
    touching = [0.5 < next(leaves) for _ in range(k)]
    return builder.block(complementarity(entries, right, touching))


@pytest.mark.parametrize("k", [1, 2, 3])
def test_the_traced_lines_do_what_the_numbers_do(k):
    for seed in range(6):
        W, q = floats(*gram(k, seed))
        touching = [(seed + i) % 3 > 0 for i in range(k)]
        inputs = [W[i][j] for i in range(k) for j in range(i + 1) if W[i][j]] + q + [float(here) for here in touching]
        outputs, _ = evaluate(traced(W, q), param=(), input=[np.float64(value) for value in inputs], state=())
        assert [float(value) for value in outputs] == complementarity(W, q, touching)


def test_float32_is_within_its_rounding():
    W, q = [[2.0, -1.0, 0.5], [-1.0, 2.0, -1.0], [0.5, -1.0, 2.0]], [-3.0, 0.7, -1.3]
    inputs = [W[i][j] for i in range(3) for j in range(i + 1)] + q + [1.0] * 3
    outputs, _ = evaluate(traced(W, q, "f32"), param=(), input=[np.float32(value) for value in inputs], state=())
    assert [float(value) for value in outputs] == pytest.approx(complementarity(W, q), rel=1e-6, abs=1e-7)


def test_contacts_that_cannot_act_on_each_other_are_solved_apart():
    assert islands([[1, 0, 2], [0, 1, 0], [2, 0, 1]]) == [[0, 2], [1]]
    six = traced(np.eye(6).tolist(), [-1.0] * 6)
    one = traced([[1.0]], [-1.0])
    # six times the work of one, and not sixty-four sets of six
    assert len(six.instructions) <= 6 * len(one.instructions)


def test_too_many_at_once_are_refused_by_name():
    W = (np.eye(5) * 6 - 1).tolist()
    with pytest.raises(
        SceneError, match=r"a, b, c, d, e act on each other at the same time; exact reactions need at most 4 of them,.*penalty"
    ):
        complementarity(W, [-1.0] * 5, names=list("abcde"))


def test_a_bead_on_a_hoop_feels_the_centripetal_reaction():
    """Gap R - r >= 0 inside a hoop, at angle phi from below: N = m (v^2/R + g cos phi), and a slides along the hoop."""
    m, R, g, phi, speed = 0.3, 0.7, 9.81, 0.6, 2.5
    out = [np.sin(phi), -np.cos(phi)]
    a, (N,) = constrained([[m, 0.0], [0.0, m]], [0.0, -m * g], [[-out[0], -out[1]]], [-(speed**2) / R], [True], definite=True)
    assert N == pytest.approx(m * (speed**2 / R + g * np.cos(phi)), rel=1e-14)
    along = a[0] * np.cos(phi) + a[1] * np.sin(phi)
    assert along == pytest.approx(-g * np.sin(phi), rel=1e-13)


def test_the_reactions_of_a_box_on_two_corners_are_those_of_statics():
    """Weight at a third of the span: two thirds on the near corner; a corner let go carries nothing and turns."""
    m, inertia, half, g = 2.0, 0.3, 0.4, 9.81
    offset = half / 3
    J = [[1.0, -(half + offset)], [1.0, half - offset]]
    M, f = [[m, 0.0], [0.0, inertia]], [-m * g, 0.0]
    a, N = constrained(M, f, J, [0.0, 0.0], [True, True])
    assert a == pytest.approx([0.0, 0.0], abs=1e-13)
    assert N == pytest.approx([m * g / 3, 2 * m * g / 3], rel=1e-13)
    a, N = constrained(M, f, J, [0.0, 0.0], [False, True])
    arm = half - offset
    assert N == pytest.approx([0.0, m * g / (1 + m * arm**2 / inertia)], rel=1e-13)
    assert a[1] == pytest.approx(N[1] * arm / inertia, rel=1e-13)


def test_a_repeated_contact_takes_no_share_of_a_reaction():
    assert reactions([[1.0, 1.0], [1.0, 1.0]], [-2.0, -2.0], [True, True]) == [2.0, 0.0]
    assert reactions([[1.0, 1.0], [1.0, 1.0]], [-2.0, -2.0], [False, True]) == [0.0, 2.0]


def test_friction_that_slides_goes_with_the_reaction():
    """A block on a slope, held by the slope alone and sliding down: a = g (sin - mu cos)."""
    m, g, angle, mu = 1.5, 9.81, 0.7, 0.3
    normal, tangent = [-np.sin(angle), np.cos(angle)], [-np.cos(angle), -np.sin(angle)]
    directions = [[normal[i] - mu * tangent[i] for i in range(2)]]
    a, (N,) = constrained([[m, 0.0], [0.0, m]], [0.0, -m * g], [normal], [0.0], [True], directions=directions)
    assert N == pytest.approx(m * g * np.cos(angle), rel=1e-14)
    assert np.dot(a, tangent) == pytest.approx(g * (np.sin(angle) - mu * np.cos(angle)), rel=1e-13)
