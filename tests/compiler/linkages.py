"""Linkages with one driver, reduced by hand to theta'' = (torque - I' theta'^2 / 2 - V') / I and integrated at 1e-12.

Independent of the package: positions are circles that intersect, in complex numbers; their kinematic coefficients, the
derivatives by theta, follow from the loop differentiated once and twice (Norton, Design of Machinery, ch. 6 and 7).
"""

import math

import numpy as np
from scipy.integrate import solve_ivp


class SliderCrank:
    """Crank r of inertia J, uniform rod L of mass m, slider of mass M on the line through the pivot; gravity along -y."""

    r, L, J, m, M, g = 0.03, 0.1, 2e-5, 0.02, 0.05, 9.81

    def angle(self, theta):
        return math.asin(self.r / self.L * math.sin(theta))

    def slide(self, theta):
        return self.r * math.cos(theta) + self.L * math.cos(self.angle(theta))

    def reduced(self, theta):
        """Return I, I' and V'."""
        phi, sin, cos = self.angle(theta), math.sin(theta), math.cos(theta)
        one = self.r * cos / (self.L * math.cos(phi))
        two = (one**2 * self.L * math.sin(phi) - self.r * sin) / (self.L * math.cos(phi))
        tip = self.r * np.exp(1j * theta)
        rod = self.L * np.exp(-1j * phi)
        tip1, tip2 = 1j * tip, -tip
        rod1, rod2 = -1j * one * rod, -1j * two * rod - one**2 * rod
        return self._sum(tip1, tip2, rod1, rod2, one, two)

    def _sum(self, tip1, tip2, rod1, rod2, one, two):
        centre1, centre2 = tip1 + rod1 / 2, tip2 + rod2 / 2
        s1, s2 = (tip1 + rod1).real, (tip2 + rod2).real
        turning = self.m * self.L**2 / 12
        inertia = self.J + self.m * abs(centre1) ** 2 + turning * one**2 + self.M * s1**2
        change = 2 * (self.m * (centre1.conjugate() * centre2).real + turning * one * two + self.M * s1 * s2)
        return inertia, change, self.m * self.g * centre1.imag


class FourBar:
    """Crank a of inertia J, uniform coupler b of mass m, rocker c of inertia J_c about its pivot at d; gravity along -y."""

    a, b, c, d, J, m, J_c, g = 0.03, 0.1, 0.08, 0.09, 2e-5, 0.02, 5e-5, 9.81

    def angles(self, theta):
        to_pivot = self.d - self.a * np.exp(1j * theta)
        along = (self.b**2 - self.c**2 + np.abs(to_pivot) ** 2) / (2 * np.abs(to_pivot))
        arm = to_pivot / np.abs(to_pivot) * (along + 1j * np.sqrt(self.b**2 - along**2))
        return np.angle(arm), np.angle(arm - to_pivot)

    def reduced(self, theta):
        """Return I, I' and V'."""
        coupler, rocker = self.angles(theta)
        tip, bar, arm = self.a * np.exp(1j * theta), self.b * np.exp(1j * coupler), self.c * np.exp(1j * rocker)
        loop = np.array([[bar.real, -arm.real], [bar.imag, -arm.imag]])
        one = np.linalg.solve(loop, [-tip.real, -tip.imag])
        # the loop differentiated twice, divided by i
        rest = (tip + one[0] ** 2 * bar - one[1] ** 2 * arm) / 1j
        two = np.linalg.solve(loop, [rest.real, rest.imag])
        tip1, tip2 = 1j * tip, -tip
        centre1 = tip1 + 1j * one[0] * bar / 2
        centre2 = tip2 + (1j * two[0] - one[0] ** 2) * bar / 2
        turning = self.m * self.b**2 / 12
        inertia = self.J + self.m * abs(centre1) ** 2 + turning * one[0] ** 2 + self.J_c * one[1] ** 2
        change = (centre1.conjugate() * centre2).real * self.m + turning * one[0] * two[0] + self.J_c * one[1] * two[1]
        return inertia, 2 * change, self.m * self.g * centre1.imag


def swing(linkage, theta, rate, times, torque=lambda t, theta, rate: 0.0):
    """Return theta and its rate at the times, from a start."""

    def slope(t, y):
        inertia, change, pull = linkage.reduced(y[0])
        return y[1], (torque(t, *y) - change * y[1] ** 2 / 2 - pull) / inertia

    found = solve_ivp(slope, (0, times[-1]), (theta, rate), "DOP853", times, rtol=1e-12, atol=1e-12)
    assert found.success
    return found.y
