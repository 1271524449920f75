"""Answers of lab 00, by the names of the notebook."""

import numpy as np

prediction = 1.8
which_way = "c"


def handle_position(counts, left, right, travel):
    """Return positions [m]: x = 0 is the middle of the two readings."""
    return (counts - (left + right) / 2) * travel / (right - left)


def sign_evidence(asked, moved, on):
    """Return Z: the signed work over the root of the sum of squares."""
    work = asked * moved
    return np.sum(np.where(on == 1, 1, -1) * work) / np.sqrt(np.sum(work**2))


def force_full(duty, grams):
    """Return the slope of the weight over the square of the duty [N]."""
    slope, _ = np.polyfit(duty**2, grams * 1e-3 * 9.80665, 1)
    return slope


def motor_current(force, drum, sector, handle, torque_constant, supply, resistance):
    """Return the current [A]: the Jacobian makes the torque, the torque constant the current, the winding its limit."""
    most = supply / resistance
    return np.clip(force * drum * handle / sector / torque_constant, -most, most)


def felt_stiffness(x, F):
    """Return the stiffness of the best line through the origin [N/m]."""
    return np.sum(F * x) / np.sum(x * x)


def limits(k, metres_per_count, force_max, T):
    """Return reach [m], force_step [N] and speed_step [m/s]."""
    return {
        "reach": force_max / k,
        "force_step": k * metres_per_count,
        "speed_step": metres_per_count / T,
    }


discussion = """
With the wires swapped, the motor applies +F_e to the handle instead of -F_e, so the
wall acts as a spring of stiffness -300 N/m at its boundary: the deeper the handle is,
the harder the motor pulls it in. The equilibrium at the boundary is unstable, and the
handle runs away, exponentially with the rate sqrt(k/m), until it meets the stop. The
board allows at most 0.5 N before the sign is checked. Its limits on speed, on travel
and on the time for which a force is held switch the motor off with a fault. The switch
of the motor's supply ends the motion at once.
"""
