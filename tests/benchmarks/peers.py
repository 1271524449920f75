"""The same work by numba and PyDy, as their users write it; ImportError where they are not installed."""

import math

import numpy as np
import sympy as sp

from hapticlab import t, x

#: points that JAX steps together: of 500 to 200 000, what took it the least time
JAX_BLOCK = 500


def numba_steps(rates, output, state, T):
    """Return RK4 over ticks, compiled by numba, for ``rates(y, sample, p) -> array`` and ``output(y, sample, p)``."""
    from numba import njit

    rates, output = njit(rates), njit(output)

    @njit
    def run(samples, p, force):
        y = np.zeros(state)
        for n in range(len(samples)):
            s = samples[n]
            force[n] = output(y, s, p)
            a = rates(y, s, p)
            b = rates(y + T / 2 * a, s, p)
            c = rates(y + T / 2 * b, s, p)
            d = rates(y + T * c, s, p)
            y = y + T / 6 * (a + 2 * (b + c) + d)

    return run


def coupler_force(y, s, p):
    """Return the force of the coupler [N]."""
    return p[0] * (s[0] - y[0]) + p[1] * (s[1] - y[1])


def coupler_rates(y, s, p):
    """Return z', z'' of the coupler."""
    wall = p[2] * (y[0] - p[4]) if y[0] >= p[4] else 0.0
    return np.array([y[1], (p[0] * (s[0] - y[0]) + p[1] * (s[1] - y[1]) - wall) / p[3]])


def pendulum_force(y, s, p):
    """Return the force of the pendulum [N]."""
    return p[0] * (s[0] / p[4] - y[0]) / p[4]


def mass_and_load(scene):
    """Return M(q) and f of the scene's M q'' = f, and its coordinates q."""
    q = scene.coordinates
    sides, highest = sp.Matrix([e.lhs - e.rhs for e in scene.eom]), [a.diff(t, 2) for a in q]
    return sides.jacobian(highest), -sides.subs(dict.fromkeys(highest, 0)), q


def pendulum_rates(scene, parameters):
    """Return ``rates(y, sample, p)``: lambdify, its common subexpressions taken out, numba, and NumPy's solve of 8 by 8."""
    from numba import njit

    M, f, q = mass_and_load(scene)
    y, s, p = (sp.IndexedBase(name) for name in "ysp")
    size = len(q)
    known = {a.diff(t): y[size + i] for i, a in enumerate(q)}
    known |= {a: y[i] for i, a in enumerate(q)} | {x(t): s[0]} | {scene.parameters[a]: p[i] for i, a in enumerate(parameters)}
    both = njit(sp.lambdify((y, s, p), (M.subs(known), f.subs(known)), "numpy", cse=True))

    def rates(y, s, p):
        M, f = both(y, s, p)
        return np.concatenate((y[size:], np.linalg.solve(M, f)[:, 0]))

    return rates


def pydy_steps(scene, parameters, T):
    """Return RK4 over ticks in Python around what PyDy's Cython generator makes of M(q) q'' = f."""
    from pydy.codegen.ode_function_generators import generate_ode_function

    M, f, q = mass_and_load(scene)
    w = [sp.Function(f"w{i}")(t) for i in range(len(q))]
    known = {a.diff(t): b for a, b in zip(q, w, strict=True)}
    rates = generate_ode_function(
        f.subs(known), list(q), w, [scene.parameters[a] for a in parameters], mass_matrix=M, specifieds=[x(t)],
        coordinate_derivatives=sp.Matrix(w), generator="cython",
    )  # fmt: skip

    def run(samples, p, force):
        y = np.zeros(2 * len(q))
        for n, s in enumerate(samples):
            force[n] = pendulum_force(y, s, p)
            a = rates(y, 0.0, s, p).copy()  # each call fills the same array
            b = rates(y + T / 2 * a, 0.0, s, p).copy()
            c = rates(y + T / 2 * b, 0.0, s, p).copy()
            d = rates(y + T * c, 0.0, s, p)
            y = y + T / 6 * (a + 2 * (b + c) + d)

    return run


def numba_lanes():
    """Return the wall swept over k, one thread, scalar code: what floors.c does in vectors."""
    from numba import njit

    @njit
    def run(ticks, ks, phi, push, counts, v0, peaks):
        metres = np.float32(1 / counts) if counts > 0 else np.float32(0)
        for lane in range(len(ks)):
            k, x, v, peak = np.float32(ks[lane]), 0.0, v0, 0.0
            for _ in range(ticks):
                seen = np.float32(math.floor(x * counts)) * metres if counts > 0 else np.float32(x)
                F = np.float64(k * seen) if seen >= 0 else 0.0
                peak = max(peak, F)
                u = push - F
                x, v = phi[0] * x + phi[1] * v + phi[2] * u, phi[3] * x + phi[4] * v + phi[5] * u
            peaks[lane] = peak

    return run


def numba_map():
    """Return the wall under a hand that pushes, one thread, scalar code; every point has a k and a transition of its own."""
    from numba import njit

    @njit
    def run(ticks, ks, phis, push, v0, peaks):
        for lane in range(len(ks)):
            k, x, v, peak = np.float32(ks[lane]), 0.0, v0, 0.0
            xx, xv, xu, vx, vv, vu = phis[:, lane]
            for _ in range(ticks):
                seen = np.float32(x)
                F = np.float64(k * seen) if seen >= 0 else 0.0
                peak = max(peak, F)
                u = push - F
                x, v = xx * x + xv * v + xu * u, vx * x + vv * v + vu * u
            peaks[lane] = peak
        return peaks

    return run


def jax_map():
    """Return the same as JAX compiles it: a scan over ticks of whole vectors, in blocks that stay in the cache."""
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def block(ticks, k, phi, push, v0):
        k, (xx, xv, xu, vx, vv, vu) = k.astype(jnp.float32), phi

        def tick(state, _):
            x, v, peak = state
            seen = x.astype(jnp.float32)
            F = jnp.where(seen >= 0, (k * seen).astype(jnp.float64), 0.0)
            u = push - F
            return (xx * x + xv * v + xu * u, vx * x + vv * v + vu * u, jnp.maximum(peak, F)), None

        zero = jnp.zeros(k.shape)
        (_, _, peak), _ = jax.lax.scan(tick, (zero, zero + v0, zero), None, length=ticks)
        return peak

    def run(ticks, k, phi, push, v0):
        size = next(s for s in range(min(JAX_BLOCK, len(k)), 0, -1) if len(k) % s == 0)
        blocks = k.reshape(-1, size), phi.reshape(6, -1, size).transpose(1, 0, 2)
        return jax.lax.map(lambda one: block(ticks, *one, push, v0), blocks).ravel()

    return jax.jit(run, static_argnums=0)
