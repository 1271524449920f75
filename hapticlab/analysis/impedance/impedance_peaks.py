"""Frequencies at which two impedances are compared: a grid, and every peak within its half-width.

The difference of two impedances beside that of handle and hand is a ratio of polynomials. It peaks at its poles: the
resonances of the second scene with the handle held, and of the first with the handle free. A peak is as wide as its pole is
damped, which no grid knows beforehand.
"""

import numpy as np

#: a resonance damped by less than this part of its frequency is undamped: the impedance there is infinite
UNDAMPED = 1e-7
#: nothing nearer to an undamped resonance than this part of its frequency is compared
BESIDE = 5e-3
#: frequencies of the grid, and on each side of a peak
POINTS, SIDE = 400, 40


def oscillations(mass, damping, stiffness):
    """Return (p [1/s], z): poles of M z'' + C z' + K z = 0 above the real axis, and motions with z^H M z = 1, by columns.

    Examples
    --------
    >>> p, _ = oscillations(*(np.array([[a]]) for a in (0.5, 0.2, 800.0)))
    >>> complex(p[0].round(6))
    (-0.2+39.9995j)
    """
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    K, C = inverse @ stiffness @ inverse.T, inverse @ damping @ inverse.T
    scale = np.sqrt(np.linalg.norm(K, 2)) or 1.0
    A = np.block([[np.zeros_like(K), scale * np.eye(len(K))], [-K / scale, -C]])
    p, states = np.linalg.eig(A)
    z = states[: len(K), p.imag > 0]
    return p[p.imag > 0], inverse.T @ (z / np.linalg.norm(z, axis=0))


def held(network):
    """Return the oscillations of a network's masses with the handle held."""
    return oscillations(network.mass, network.damping[1:, 1:], network.stiffness[1:, 1:])


def free(network, paddle):
    """Return the poles [1/s] of a network with the handle, its paddle and its hand."""
    hand = getattr(paddle, "hand", None)
    m, b, k = (getattr(paddle, name, 0.0) + (getattr(hand, name) if hand else 0.0) for name in "mbk")
    N = len(network.mass)
    mass, damping, stiffness = np.zeros((N + 1, N + 1)), network.damping.copy(), network.stiffness.copy()
    mass[1:, 1:] = network.mass
    mass[0, 0] = max(m, 1e-6 * network.mass.max())  # a handle without mass moves as one of next to none
    damping[0, 0], stiffness[0, 0] = damping[0, 0] + b, stiffness[0, 0] + k
    return oscillations(mass, damping, stiffness)[0]


def infinite(network, beside, band):
    """Return the frequencies [Hz] of the band at which a network's impedance is infinite, ascending.

    A peak counts where it is wider than a part UNDAMPED of its frequency: as far as it is larger than ``beside``, a
    function frequency -> impedance [N s/m] of what is in parallel.
    """
    p, z = held(network)
    frequency = p.imag / (2 * np.pi)
    pull = np.abs(np.sum((network.stiffness[1:, :1] + p * network.damping[1:, :1]) * z, axis=0)) ** 2
    felt = pull > UNDAMPED * 2 * np.abs(p) ** 3 * np.abs(beside(frequency))
    inside = (frequency > band[0] * (1 - BESIDE)) & (frequency < band[1] * (1 + BESIDE))
    return np.sort(frequency[felt & inside & (-p.real < UNDAMPED * np.abs(p))])


def around(p, band):
    """Return frequencies [Hz] of the band around poles: fine within the half-width of each, coarser to a tenth beside it."""
    found = []
    for centre, width in zip(p.imag / (2 * np.pi), -p.real / (2 * np.pi), strict=True):
        step = np.geomspace(max(width, UNDAMPED * centre) / 20, centre / 10 + width, SIDE)
        found += [centre - step, centre + step, [centre] if width > UNDAMPED * centre else []]
    f = np.concatenate([[], *found])
    return f[(f >= band[0]) & (f <= band[1])]


def outside(f, poles):
    """Mask of the frequencies that are not beside a pole of an infinite impedance."""
    near = np.abs(np.subtract.outer(f, poles)) < BESIDE * np.asarray(poles) * (1 - 1e-9)
    return ~near.any(axis=1)


def frequencies(network, paddle, band, poles):
    """Return frequencies [Hz] over the band that show what a network does, up to the edges of what is beside ``poles``."""
    edges = [f * side for f in poles for side in (1 - BESIDE, 1 + BESIDE) if band[0] <= f * side <= band[1]]
    every = [np.geomspace(*band, POINTS), edges, around(held(network)[0], band), around(free(network, paddle), band)]
    f = np.unique(np.concatenate(every))
    return f[outside(f, poles)]


def refined(f, error, poles):
    """Return frequencies with more of them where an error, a function of frequency, is largest."""
    for _ in range(4):
        e = np.r_[0.0, error(f), 0.0]
        tops = np.flatnonzero((e[1:-1] >= e[:-2]) & (e[1:-1] >= e[2:]) & (e[1:-1] >= e.max() / 2))
        between = [np.linspace(f[max(k - 1, 0)], f[min(k + 1, len(f) - 1)], 11) for k in tops]
        more = np.concatenate(between)
        f = np.unique(np.concatenate([f, more[outside(more, poles)]]))
    return f
