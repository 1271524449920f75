"""Kane's equations as ``sympy.physics.mechanics`` forms them, in the coordinates of a scene."""

from dataclasses import replace

import numpy as np
import sympy as sp

from ...errors import SceneError
from ..notation.derivative import Partial, Rate
from ..notation.symbols import t
from ..notation.units import agree
from .lagrange import Mechanics
from .sympy_symbols import Vocabulary, gathered

#: what is read of a KanesMethod beside its documented attributes, in SymPy 1.14
READ = ("_f_h", "_f_nh", "_k_nh", "_uaux", "_udep", "_inertial", "_k_ku_implicit", "_k_kqdot_implicit", "_f_k_implicit")
DRIFTS = "constraints on speeds are enforced by their rate alone, as KanesMethod writes them, so they drift by the step's error"

#: of a constraint's gradient, of size one: what is left of it when it follows from others
REPEATED = 1e-9


def of_kane(method, given, enforce):
    """The :class:`Mechanics` of a KanesMethod; see :func:`~hapticlab.scene.mechanics.sympy_models.from_mechanics`."""
    check_version(method, READ)
    _formed(method)
    still = dict.fromkeys(method._uaux, sp.S.Zero) | {u.diff(t): sp.S.Zero for u in method._uaux}
    constrained = bool(len(method._f_h) or len(method._udep))
    q, u, K, rest = _kinematics(method)
    speeds = _speeds(u, K.xreplace(still), rest.xreplace(still))
    plain = {u: w.expr for u, w in speeds.items() if isinstance(w, sp.Derivative)} if speeds else {}
    if speeds and len(set(plain.values())) == len(speeds):
        return _in_rates(method, q, speeds, plain, still, given, enforce)
    if speeds and constrained:
        return _in_rates(method, q, speeds, {}, still, _starts(given, speeds, still, method), enforce)
    return _in_speeds(method, still, constrained, given, enforce)


def check_version(method, names):
    """Refuse a SymPy that keeps its equations under other names."""
    missing = next((name for name in names if not hasattr(method, name)), None)
    if missing:
        raise SceneError(f"SymPy {sp.__version__} stores no {missing} in a {type(method).__name__}; install sympy 1.14")


def _formed(method):
    if method._fr is None or method._frstar is None:
        if not method.bodies:
            raise SceneError("this KanesMethod has formed no equations; call kanes_equations(bodies, loads) first")
        method.kanes_equations()


def _kinematics(method):
    """(q, u, K, rest) of the kinematic equations K u + rest = 0.

    A speed that is in none of them, such as the spin of a wheel, is the rate of a coordinate of its own.
    """
    q, u, K = list(method.q), list(method.u), method._k_ku_implicit
    rest = method._k_kqdot_implicit * method.q.diff(t) + method._f_k_implicit
    for k, speed in enumerate(u):
        if K.cols == len(u) and K[:, k].is_zero_matrix:
            q.append(sp.Function(f"q_{type(speed).__name__}")(t))
            K = K.col_join(sp.Matrix([[-sp.Integer(j == k) for j in range(len(u))]]))
            rest = rest.col_join(sp.Matrix([q[-1].diff(t)]))
    return q, u, K, rest


def _speeds(u, k_u, rest):
    """Speed -> expression of coordinates and rates, or None where the kinematic equations do not determine them."""
    if not k_u.rows == k_u.cols > 0:
        return None
    if k_u.is_diagonal() and all(entry != 0 for entry in k_u.diagonal()):
        solved = [-right / entry for right, entry in zip(rest, k_u.diagonal(), strict=True)]
    else:
        try:
            solved = list(-k_u.LUsolve(rest))
        except (ValueError, sp.matrices.exceptions.NonInvertibleMatrixError):
            return None
    return None if any(e.has(sp.nan, sp.zoo) for e in solved) else dict(zip(u, solved, strict=True))


def _unconstrained(method, q, u):
    """Kane's equations of all speeds, as if none depended on another."""
    _, _, K, rest = _kinematics(method)
    zero = list(K * sp.Matrix(u) + rest)
    extra = {"u_auxiliary": list(method._uaux)} if len(method._uaux) else {}
    whole = type(method)(method._inertial, q, u, kd_eqs=zero, **extra)
    whole.kanes_equations(method.bodies, method.loads)
    return whole


def _starts(given, speeds, still, method):
    """The arguments of a vocabulary without speeds: their starts turned into starts of rates."""
    names = {type(u).__name__: u for u in speeds}
    initial, units = (dict(given[what] or {}) for what in ("initial", "units"))
    units = {key: unit for key, unit in units.items() if names.get(key, key) not in speeds}
    own = {names.get(key, key): initial.pop(key) for key in list(initial) if names.get(key, key) in speeds}
    if own:
        at = {p: initial.get(p, initial.get(type(p).__name__, 0)) for p in method.q}
        put = {s: sp.sympify(own.get(s, at.get(s, 0))) for s in (*speeds, *method.q)}
        initial |= {rate: expr.xreplace(still).xreplace(put) for rate, expr in method.kindiffdict().items()}
    return {**given, "initial": initial, "units": units}


def _independent(configuration, velocity, q, words):
    """The velocity constraints that are independent of the rates of the configuration constraints.

    KanesMethod asks for as many as there are dependent speeds, those rates among them.
    """
    if not configuration or not velocity:
        return velocity
    J = [[g.diff(p) for p in q] for g in configuration] + [[g.diff(p.diff(t)) for p in q] for g in velocity]
    J = np.array(sp.Matrix(J).xreplace(_numbers(J, words)).evalf(), float)
    J /= np.maximum(np.linalg.norm(J, axis=1)[:, None], np.finfo(float).tiny)
    basis, rest, chosen = np.linalg.qr(J[: len(configuration)].T)[0], J[len(configuration) :], []
    for _ in range(len(velocity) - len(configuration)):
        rest = rest - rest @ basis @ basis.T
        sizes = np.linalg.norm(rest, axis=1)
        best = int(np.argmax(sizes))
        if sizes[best] < REPEATED:
            break
        chosen.append(best)
        basis = np.column_stack([basis, rest[best] / sizes[best]])
    return [velocity[k] for k in sorted(chosen)]


def _numbers(J, words):
    """Symbol -> number: parameters' values and coordinates' starts, an arbitrary number where there are none; rates are 0."""
    at = {t: sp.S.Zero}
    for k, (symbol, made) in enumerate(words.names):
        number = sp.sympify(getattr(made, "value", getattr(type(made), "initial", sp.nan))).evalf()
        at[symbol] = number if number.is_number and number.is_finite else sp.Float(0.9 + 0.017 * k)
    return at | {d: sp.S.Zero for row in J for e in row for d in e.atoms(sp.Derivative)}


def _in_rates(method, q, speeds, plain, still, given, enforce):
    """The model of second order: u are functions of q and q', so with u' = T q'' + b it is T'M T q'' = T'(f - M b)."""
    u = list(speeds)
    whole = _unconstrained(method, q, u) if len(method._f_h) or len(method._udep) else method
    velocity = list(method._k_nh * method.u + method._f_nh) if len(method._udep) else []
    M, f, configuration, velocity, U = (
        [sp.sympify(e).xreplace(still).xreplace(speeds) for e in part]
        for part in (whole.mass_matrix, whole.forcing, method._f_h, velocity, u)
    )
    configuration = list(map(gathered, configuration))
    words = Vocabulary(q, [*M, *f, *configuration, *velocity, *U], plain, **given)
    velocity = _independent(configuration, velocity, q, words)
    coordinates = tuple(words.table[p] for p in q if p in words.table)
    rates = [p.diff(t) for p in coordinates]
    M, f, constraints, U = (list(map(words, part)) for part in (M, f, [*configuration, *velocity], U))
    N, S = range(len(rates)), range(len(u))
    M = [[M[max(i, j) * len(u) + min(i, j)] for j in S] for i in S]
    T = [[Partial(e, w).doit() for w in rates] for e in U]
    right = [sp.Add(f[i], *(-M[i][k] * Rate(U[k]) for k in S)) for i in S]
    half = [[sp.Add(*(M[i][k] * T[k][j] for k in S)) for j in N] for i in S]
    rows = tuple(tuple(sp.Add(*(T[i][max(a, b)] * half[i][min(a, b)] for i in S)) for b in N) for a in N)
    f = tuple(sp.Add(*(T[i][a] * right[i] for i in S)) for a in N)
    made = _made(words, coordinates, 2, rows, f, constraints, enforce)
    return made if plain else replace(made, names=(*made.names, *zip(u, U, strict=True)))


def _in_speeds(method, still, constrained, given, enforce):
    """The model of first order: q' = G u, M u' = f."""
    states, u = [*method.q, *method.u], list(method.u)
    M, f = method.mass_matrix.xreplace(still), method.forcing.xreplace(still)
    turning = [method.kindiffdict()[p.diff(t)].xreplace(still) for p in method.q]
    words = Vocabulary(states, [*M, *f, *turning, *method._f_h], {}, **given)
    driven = next((s for s in states if s in words.inputs), None)
    if driven is not None:
        raise SceneError(f"{driven} is replaced, which needs speeds that are rates of coordinates, u = q'")
    n, S = len(method.q), range(len(u))
    own = [[words(M[i, j] if constrained else M[max(i, j), min(i, j)]) for j in S] for i in S]
    turned = [[sp.Integer(i == j) for j in range(len(states))] for i in range(n)]
    rows = (*map(tuple, turned), *((sp.S.Zero,) * n + tuple(row) for row in own))
    coordinates = tuple(words.table[s] for s in states)
    made = _made(words, coordinates, 1, rows, tuple(map(words, [*turning, *f])), (), enforce)
    return replace(made, notes=(*made.notes, DRIFTS)) if constrained else made


def _made(words, coordinates, order, M, f, constraints, enforce):
    written = (*(m for row in M for m in row), *f, *constraints)
    if words.declared:
        for q, row, right in zip(coordinates, M, f, strict=True):
            terms = [m * p.diff(t, order) for m, p in zip(row, coordinates, strict=True)]
            agree([*terms, right], f"equation of {type(q).__name__}")
    facts = {"enforce": enforce, "notes": words.notes, "names": words.names}
    return Mechanics(coordinates, (order,) * len(coordinates), M, f, written, tuple(constraints), **facts)
