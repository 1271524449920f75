"""A second way to the motion of a SymPy model: its own mass matrix and forcing, lambdified, integrated at 1e-12."""

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp
from sympy.physics.mechanics import dynamicsymbols

import hapticlab as hl
from hapticlab.compiler.engines.engine import load


def motion(method, values, starts, times):
    """Return the states of a KanesMethod or LagrangesMethod whose equations are formed, shape (times, states).

    ``values`` are of constants and inputs, ``starts`` of q, then of u or q'.
    """
    t = dynamicsymbols._t
    q = list(method.q)
    rates = list(method.u) if hasattr(method, "u") else [p.diff(t) for p in q]
    names = sp.symbols(f"state:{len(q) + len(rates)}")
    put = dict(zip([*rates, *q], [*names[len(q) :], *names[: len(q)]], strict=True))
    M, f = (m.xreplace(values).xreplace(put) for m in (method.mass_matrix_full, method.forcing_full))
    function = sp.lambdify([*names, t], [M, f], "numpy", cse=True)

    def rate(time, state):
        mass, force = function(*state, time)
        return np.linalg.solve(mass, force)[: len(state), 0]

    done = solve_ivp(rate, (0.0, times[-1]), starts, "DOP853", times, rtol=1e-12, atol=1e-14)
    assert done.success
    return done.y.T


def run(mech, watch, T, duration, method="rk4", substeps=1, values=None):
    """Return what is watched at every sample up to ``duration``, shape (ticks, channels)."""
    scene = hl.Scene(force=0, eom=[mech], watch=watch, values=values or {})
    program = hl.compile(scene, method, T=T, substeps=substeps, dtype="float64", live=())
    ticks = round(duration / T) + 1
    return load(program).run(ticks, np.zeros((ticks, len(program.inputs)))).outputs[:, 1 : 1 + len(watch), 0]


def check(mech, watch, reference, T, duration, error, order=4):
    """Check that a run is within ``error`` of ``reference(times)``, and that halving T divides the error by 2^order.

    The first channels are compared; the others of the second run are returned.
    """
    errors = []
    for step in (T, T / 2):
        got = run(mech, watch, step, duration)
        wanted = reference(np.arange(len(got)) * step)
        errors.append(np.abs(got[:, : wanted.shape[1]] - wanted).max())
    assert errors[1] < error, errors
    # the ratio is that of the leading term; one step size is not yet zero
    assert 0.75 * 2**order < errors[0] / errors[1] < 1.5 * 2**order, (errors, errors[0] / errors[1])
    return got[:, wanted.shape[1] :]
