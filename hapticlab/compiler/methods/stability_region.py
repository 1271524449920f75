"""Where a method is stable: on y' = z y, and on an oscillator, found by taking steps of it."""

import numpy as np

from .step_matrix import longest_step, step_matrix

#: frequency and damping of an oscillator without scale: q'' = -q - 2 zeta q'
SPRING = np.array([[0.0, 1.0], [-1.0, 0.0]])
#: a body on a damper, q'' = -q'
DAMPER = np.array([[0.0, 1.0], [0.0, -1.0]])


def amplification(method, z):
    """|R(z)|, by how much a step of h lambda = z makes y' = lambda y grow; of a multistep method the largest root.

    Parameters
    ----------
    method : Method
    z : complex array

    Returns
    -------
    array of float

    Examples
    --------
    >>> from hapticlab.compiler.methods.method_table import METHODS
    >>> amplification(METHODS["heun"], np.array([-1.0, 1.0j])).round(6).tolist()
    [0.5, 1.118034]
    """
    z = np.asarray(z, complex)
    # y' = (a + i b) y in reals: the radius of a matrix that commutes with its quarter turn is |R(a + i b)|
    J = np.stack([np.stack([z.real, -z.imag], -1), np.stack([z.imag, z.real], -1)], -2)
    return np.abs(np.linalg.eigvals(step_matrix(method, J, 0, 1.0))).max(axis=-1)


def longest_for(method, zeta=0.0):
    """The largest stable omega h of q'' = -omega^2 q - 2 zeta omega q'; 0 where none is, inf where every one is.

    Examples
    --------
    >>> from hapticlab.compiler.methods.method_table import METHODS
    >>> round(longest_for(METHODS["semi_implicit_euler"], 1.0), 6)
    0.828427
    """
    J = SPRING - [[0.0, 0.0], [0.0, 2.0 * zeta]]
    return longest_step(lambda h: step_matrix(method, J, 1, h), J)


def longest_damper(method):
    """The largest stable h b/m of a body on a damper."""
    return longest_step(lambda h: step_matrix(method, DAMPER, 1, h), DAMPER)


def energy_gain(method, omega_h):
    """The part of its energy that a spring-mass gains in a step, from one step to the next for long after the start.

    Of a symplectic method, whose energy goes up and down by a bounded part, 0.

    Examples
    --------
    >>> from hapticlab.compiler.methods.method_table import METHODS
    >>> round(energy_gain(METHODS["euler"], 0.1), 9), abs(round(energy_gain(METHODS["verlet"], 0.1), 9))
    (0.01, 0.0)
    """
    roots = np.linalg.eigvals(step_matrix(method, SPRING, 1, float(omega_h)))
    nearest = roots[np.abs(roots - np.exp(1j * omega_h)).argmin()]
    return float(abs(nearest) ** 2 - 1.0)
