"""Explicit fixed steps, as the lines of the textbook, traced alike for numbers and for programs.

A step advances ``(q, v, s)`` by ``h``: positions q and velocities v = q' of the second-order coordinates, and the
first-order states s. ``rhs(tau, q, v, s)`` returns ``(a, ds)`` at the time tau after the sample. Lists in, lists out.

Tables: Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, ch. II.1, II.14 for Nystrom's and III.1
for those of Adams; SSPRK3: Gottlieb, Shu and Tadmor, SIAM Review 43 (2001). Semi-implicit Euler and velocity Verlet:
Hairer, Lubich and Wanner, *Geometric Numerical Integration*, ch. I.
"""


def _plus(y, h, dy):
    return [a + h * b for a, b in zip(y, dy, strict=True)]


def runge_kutta(a, b):
    """The step of an explicit Runge-Kutta table with rows ``a`` and weights ``b``; nodes are the row sums."""

    def step(rhs, tau, state, h):
        q, v, s = state
        k = []
        for row in a:
            at = [q, v, s]
            for weight, slopes in zip(row, k, strict=False):
                if weight:
                    at = [_plus(part, weight * h, slope) for part, slope in zip(at, slopes, strict=True)]
            acceleration, ds = rhs(tau + sum(row) * h, *at)
            k.append((at[1], acceleration, ds))
        return tuple(_weighted(part, h, b, [slopes[j] for slopes in k]) for j, part in enumerate((q, v, s)))

    return step


def _weighted(y, h, b, slopes):
    """State y + h * (b1 k1 + b2 k2 + ...), stages of equal weight summed first."""
    result = []
    for i, start in enumerate(y):
        groups = {}
        for weight, slope in zip(b, slopes, strict=True):
            if weight:
                groups[weight] = groups[weight] + slope[i] if weight in groups else slope[i]
        total = None
        for weight, summed in groups.items():
            term = (weight * h) * summed
            total = term if total is None else total + term
        result.append(start + total)
    return result


def semi_implicit_euler(rhs, tau, state, h):
    """v(n+1) = v(n) + h a(q(n), v(n)); q(n+1) = q(n) + h v(n+1)."""
    q, v, s = state
    a, ds = rhs(tau, q, v, s)
    v = _plus(v, h, a)
    return _plus(q, h, v), v, _plus(s, h, ds)


def verlet(rhs, tau, state, h):
    """Velocity Verlet, the second force at q(n+1) and v + h a.

    With the half-step velocity there instead, a velocity-dependent force would cost it an order.
    """
    q, v, s = state
    a, ds = rhs(tau, q, v, s)
    q_next = [p + h * (w + (h / 2) * c) for p, w, c in zip(q, v, a, strict=True)]
    a_next, ds_next = rhs(tau + h, q_next, _plus(v, h, a), _plus(s, h, ds))
    v_next = [w + (h / 2) * (c + d) for w, c, d in zip(v, a, a_next, strict=True)]
    return q_next, v_next, [y + (h / 2) * (c + d) for y, c, d in zip(s, ds, ds_next, strict=True)]


def nystrom(rhs, tau, state, h):
    """Nystrom's method of order 4 for q'' = a(t, q), three evaluations; the states s are integrals of what q does."""
    q, v, s = state
    a1, ds1 = rhs(tau, q, v, s)
    middle = [p + (h / 2) * (w + (h / 4) * a) for p, w, a in zip(q, v, a1, strict=True)]
    a2, ds2 = rhs(tau + h / 2, middle, _plus(v, h / 2, a1), s)
    end = [p + h * (w + (h / 2) * a) for p, w, a in zip(q, v, a2, strict=True)]
    a3, ds3 = rhs(tau + h, end, _plus(v, h, a2), s)
    q = [p + h * (w + (h / 6) * (a + 2 * b)) for p, w, a, b in zip(q, v, a1, a2, strict=True)]
    simpson = [1 / 6, 4 / 6, 1 / 6]
    return q, _weighted(v, h, simpson, [a1, a2, a3]), _weighted(s, h, simpson, [ds1, ds2, ds3])


RK4 = runge_kutta([(), (1 / 2,), (0, 1 / 2), (0, 0, 1)], [1 / 6, 1 / 3, 1 / 3, 1 / 6])


def adams_bashforth(weights):
    """The step of an Adams-Bashforth method; ``past`` are the rates of the steps before, newest first."""

    def step(rhs, tau, state, h, past):
        slopes = [rates(rhs, tau, state), *past]
        moved = tuple(_weighted(part, h, weights, [k[j] for k in slopes]) for j, part in enumerate(state))
        return moved, slopes[:-1]

    return step


def rates(rhs, tau, state):
    """The rates of (q, v, s)."""
    return (state[1], *rhs(tau, *state))


def before(rhs, state, h, count):
    """The rates of the last ``count`` steps before a state, newest first, by RK4 backwards from it."""
    past = []
    for k in range(count):
        state = RK4(rhs, -k * h, state, -h)
        past.append(rates(rhs, -(k + 1) * h, state))
    return past
