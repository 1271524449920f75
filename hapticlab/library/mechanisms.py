"""Mechanisms that turn the handle's motion into another: gears, slider-crank, four-bar linkage, a disc that rolls."""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..scene.mechanics.lagrange import lagrange
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene
from .bodies import coupler
from .sketch import SOFT, Sketch, clearance

#: half the depth of a gear's teeth [m]
TOOTH = 0.0011


def gears() -> Scene:
    """Gear train: a rack turns a pinion, z = r phi; on its shaft N_1 teeth drive N_2 teeth with a flywheel.

    (J_1 + (N_1/N_2)^2 J_2) phi'' = r F_c - c phi'. One feels a mass (J_1 + (N_1/N_2)^2 J_2)/r^2: three times the ratio
    is nine times the flywheel.

    Teaches transformers and reflected inertia; D. C. Karnopp, D. L. Margolis and R. C. Rosenberg, *System Dynamics*,
    ch. 3. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at 800 Hz.

    Returns
    -------
    Scene
        With r [m], N_1, N_2, J_1, J_2 [kg m^2], c [N m s/rad], and K, b_c of the coupler.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.gears().values
    >>> print(f"{(p['J_1'] + (p['N_1'] / p['N_2']) ** 2 * p['J_2']) / p['r'] ** 2:.3f} kg")
    0.070 kg
    """
    r = parameters("r", units="m", values=0.02, ranges=(1e-3, 1))
    phi = coordinate("phi", unit="rad", initial=x(n) / r)
    N_1, N_2 = parameters("N_1 N_2", units="1 1", values=(60, 20), ranges=[(5, 500), (5, 500)])
    J_1, J_2, c = parameters("J_1 J_2 c", units="kg*m^2 kg*m^2 N*m*s/rad", values=(1e-5, 2e-6, 1e-6))
    phi_2 = coordinate("phi_2", unit="rad", initial=-N_1 / N_2 * x(n) / r)
    F_c = coupler(r * phi)
    kinetic = J_1 * phi.diff(t) ** 2 / 2 + J_2 * phi_2.diff(t) ** 2 / 2
    loss = c * phi.diff(t) ** 2 / 2
    motion = lagrange(kinetic, dissipation=loss, forces={phi: r * F_c}, constraints=[N_1 * phi + N_2 * phi_2])
    return Scene(force=F_c, eom=[motion], watch=[phi, phi_2], name="gears")


def draw_gears(axes, *, x=0.012, phi=0.4, r=0.02, N_1=60.0, N_2=20.0, **_):
    """Draw the rack under the pinion, the gears at their ratio, the flywheel on the second shaft."""
    big = np.maximum(1.3 * r, 0.028 * np.minimum(1, N_1 / N_2))
    small = big * N_2 / N_1
    s = Sketch(axes, -0.08, 0.2, -0.031, 0.053)
    u, z = s.u, r * phi
    rack = z + 0.04 + clearance(x, z)
    centre = np.stack([np.maximum(0.095 + clearance(x, z), rack + big + 2 * u), r])
    other = centre + [big + small, 0]
    s.pair((x, 0), (rack, 0), carries="F")
    s.handle(x, below=7.8)
    s.line((rack, 0), (np.maximum(rack + 0.11, centre[0] + big), 0), width=3.0, zorder=7)
    turn = -np.pi / 2 + phi
    s.gear(centre, big, np.trunc(N_1), phi, TOOTH)
    s.gear(other, small, np.trunc(N_2), np.pi * (1 + 1 / N_2) - N_1 / N_2 * phi, TOOTH, color="#f4f4f4")
    s.disc(centre, r, turn, color="#f4f4f4", zorder=5)
    s.line(centre, centre + r * np.array([np.cos(2.4), np.sin(2.4)]), width=0.8, color=SOFT, zorder=6)
    s.text(centre, "$r$", right=1.8, up=2.6)
    s.pin(centre)
    s.pin(other)
    s.text(centre, "$N_1,\\ J_1$", up=0.5 * (r + big) / u)
    s.text(other, "$N_2,\\ J_2$", up=small / u + 2.6)
    s.angle(centre, big / u + 3.6, 2.3, 2.9, r"$\varphi$")
    s.angle(other, small / u + 4.2, 0.5, -0.5, r"$\varphi_2$")
    s.coordinate("$z$", z, -7.8 * u, origin=centre[0])


def slider_crank() -> Scene:
    """Slider-crank: the handle pushes the slider through a virtual coupler, a connecting rod turns the crank.

    (s - l - r cos(theta))^2 + (r sin(theta))^2 = l^2, L = J theta'^2/2 + m s'^2/2. At a dead centre, theta = 0 or pi, the
    handle cannot turn the crank: only the flywheel carries it through. One feels a mass m + J/(ds/dtheta)^2, which grows
    towards it without limit.

    Teaches kinematic constraint, singular configuration, the flywheel; R. L. Norton, *Design of Machinery*, ch. 4 and
    13. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at 500 Hz.

    Returns
    -------
    Scene
        With r, l [m] (r < l), J [kg m^2], m [kg], c [N m s/rad], and K, b_c of the coupler; s starts at zero.

    Examples
    --------
    >>> import hapticlab as hl
    >>> len(hl.library.slider_crank().coordinates)
    2
    """
    r, l = parameters("r l", units="m m", values=(0.03, 0.09), ranges=[(1e-3, 0.1), (1e-3, 1)])
    J, m, c = parameters("J m c", units="kg*m^2 kg N*m*s/rad", values=(4e-5, 0.03, 2e-5))
    theta, s = coordinate("theta", unit="rad", initial=sp.acos(-r / (2 * l))), coordinate("s", unit="m")
    F_c = coupler(s)
    rod = sp.Eq((s - l - r * sp.cos(theta)) ** 2 + (r * sp.sin(theta)) ** 2, l**2)
    kinetic, loss = J * theta.diff(t) ** 2 / 2 + m * s.diff(t) ** 2 / 2, c * theta.diff(t) ** 2 / 2
    motion = lagrange(kinetic, dissipation=loss, forces={s: F_c}, constraints=[rod])
    return Scene(force=F_c, eom=[motion], watch=[theta, s], name="slider-crank")


def draw_slider_crank(axes, *, x=0.012, theta=0.9, r=0.03, l=0.09, **_):
    """Draw the crank on the right, the slider between it and the handle."""
    s = Sketch(axes, -0.08, 0.232, -0.043, 0.041)
    u, slider = s.u, l + r * np.cos(theta) - np.sqrt(l**2 - (r * np.sin(theta)) ** 2)
    origin = 0.065 + clearance(x, slider)
    place, centre = np.stack([slider + origin, 0.0]), np.stack([origin + l, 0.0])
    pin = centre + r * np.stack([np.cos(theta), np.sin(theta)])
    s.disc(centre, 1.3 * r, theta, zorder=1.5)
    s.ground((origin - r, -5.5 * u), (origin + r + 4 * u, -5.5 * u))
    s.pair((x, 0), (place[0] - 5 * u, 0), carries="F")
    s.handle(x, below=10.5)
    s.block(place, 10, 11)
    s.text(place, "$m$", right=-2.5)
    s.rod(place, pin, "$l$", up=3)
    s.rod(centre, pin, width=3.5)
    s.text((centre + pin) / 2, "$r$", right=2, up=-1.6)
    s.text(centre, "$J$", right=3.2, up=-4.5)
    for at in (place, pin, centre):
        s.pin(at)
    s.angle(centre, 15.5, 0, theta, r"$\theta$")
    s.coordinate("$s$", slider, -10.5 * u, origin=origin)


def four_bar() -> Scene:
    """Four-bar linkage: a rack turns the crank a, the coupler link b swings the rocker c, on a ground link d.

    a cos(theta) + b cos(beta) = d + c cos(psi), a sin(theta) + b sin(beta) = c sin(psi), and z = rho (theta - theta_0).
    One feels the mass (J_2 + J_4 (dpsi/dtheta)^2)/rho^2: much where the rocker runs, little where it turns round
    (dpsi/dtheta = 0). Lengths by Grashof, a + d < b + c: the crank turns fully, the rocker swings.

    Teaches loop closure, mobility, mechanical advantage; R. L. Norton, *Design of Machinery*, ch. 4 and 6. Needs
    b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at 400 Hz, hold="foh".

    Returns
    -------
    Scene
        With a, b, c, d, rho [m], J_2, J_4 [kg m^2], B [N m s/rad], and K, b_c of the coupler.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.four_bar().values
    >>> p["a"] + p["d"] < p["b"] + p["c"]
    True
    """
    a, b, c, d, rho = parameters("a b c d rho", units="m m m m m", values=(0.02, 0.05, 0.04, 0.05, 0.03))
    J_2, J_4, B = parameters("J_2 J_4 B", units="kg*m^2 kg*m^2 N*m*s/rad", values=(2e-5, 2e-4, 5e-5))
    theta_0 = parameters("theta_0", units="rad", values=1.2)
    up, across = a * sp.sin(theta_0), d - a * sp.cos(theta_0)
    e = sp.sqrt(up**2 + across**2)
    psi_0 = sp.pi - sp.atan2(up, across) - sp.acos((c**2 + e**2 - b**2) / (2 * c * e))
    beta_0 = sp.atan2(c * sp.sin(psi_0) - up, c * sp.cos(psi_0) + across)
    theta, beta, psi = (
        coordinate(name, unit="rad", initial=start) for name, start in (("theta", theta_0), ("beta", beta_0), ("psi", psi_0))
    )
    loop = [
        a * sp.cos(theta) + b * sp.cos(beta) - d - c * sp.cos(psi),
        a * sp.sin(theta) + b * sp.sin(beta) - c * sp.sin(psi),
    ]
    F_c = coupler(rho * (theta - theta_0))
    kinetic, loss = J_2 * theta.diff(t) ** 2 / 2 + J_4 * psi.diff(t) ** 2 / 2, B * theta.diff(t) ** 2 / 2
    motion = lagrange(kinetic, dissipation=loss, forces={theta: rho * F_c}, constraints=loop)
    return Scene(force=F_c, eom=[motion], watch=[theta], name="four-bar linkage")


def draw_four_bar(axes, *, x=0.012, theta=1.5, a=0.02, b=0.05, c=0.04, d=0.05, rho=0.03, theta_0=1.2, **_):
    """Draw the rack under the crank's pulley, the linkage on it."""
    s = Sketch(axes, -0.09, 0.225, -0.044, 0.077)
    u, z = s.u, rho * (theta - theta_0)
    rack = z + 0.04 + clearance(x, z)
    ground = np.stack([np.maximum(0.085 + clearance(x, z), rack + rho + 2 * u), rho])
    rocker = ground + [d, 0]
    crank = ground + a * np.stack([np.cos(theta), np.sin(theta)])
    reach = crank - rocker
    e = np.hypot(*reach)
    psi = (np.arctan2(reach[1], reach[0]) - np.arccos((c**2 + e**2 - b**2) / (2 * c * e))) % (2 * np.pi)
    joint = rocker + c * np.stack([np.cos(psi), np.sin(psi)])
    link = joint - crank
    beta = np.arctan2(link[1], link[0])
    beside = [np.stack([-np.sin(angle), np.cos(angle)]) for angle in (theta, beta, psi)]
    s.pair((x, 0), (rack, 0), carries="F")
    s.handle(x, below=7.8)
    s.line((rack, 0), (np.maximum(rack + 0.09, ground[0] + rho), 0), width=3.0)
    s.disc(ground, rho, theta - np.pi / 2 - theta_0, color="#f4f4f4")
    s.line(ground, rocker, width=0.8, color=SOFT, linestyle="--", zorder=3.5)
    s.text((ground + rocker) / 2, "$d$", right=-1.5, up=-1.8)
    s.rod(ground, crank, width=3.5)
    s.text((ground + crank) / 2 + 2.6 * u * beside[0], "$a$")
    s.rod(crank, joint)
    s.text((crank + joint) / 2 + 3 * u * beside[1], "$b$")
    s.rod(joint, rocker)
    s.text((joint + rocker) / 2 - 3.2 * u * beside[2], "$c$")
    s.pin(rocker, fixed=True)
    for at in (ground, crank, joint):
        s.pin(at)
    s.text(ground + rho * np.array([-0.8, 0.6]), r"$\rho,\ J_2$", right=-4.5, up=2)
    s.text(rocker, "$J_4$", right=6, up=-2.5)
    s.angle(ground, 2.8, 0, theta, r"$\theta$")
    s.angle(crank, 9, 0, beta, r"$\beta$")
    s.line(crank, crank + [11 * u, 0], width=0.8, color=SOFT, linestyle="--")
    s.angle(rocker, 4, 0, psi, r"$\psi$")
    s.line(rocker, rocker + [9 * u, 0], width=0.8, color=SOFT, linestyle="--")
    s.coordinate("$z$", z, -4 * u, origin=ground[0])


def rolling() -> Scene:
    """Disc rolling without slipping on a plate that a virtual coupler ties to the handle; the plate may be tilted.

    u = -r phi for the disc's place u on the plate, L = M z'^2/2 + m (z' + u')^2/2 + J phi'^2/2 - weight, J = m r^2/2.
    On a level plate the disc follows with a third of the plate's acceleration, so one feels M + m/3: the disc keeps
    rolling when the plate is stopped. Tilted by alpha it rolls down with 2/3 g sin(alpha).

    Teaches rolling as a constraint, and that friction which does no work moves the disc; L. D. Landau and E. M.
    Lifshitz, *Mechanics*, sec. 38. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit
    Euler at 500 Hz.

    Returns
    -------
    Scene
        With M, m [kg], r [m], g, alpha [rad], and K, b_c of the coupler.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.rolling().values
    >>> print(f"felt: {p['M'] + p['m'] / 3:.2f} kg")
    felt: 0.10 kg
    """
    z, u = coordinate("z", unit="m", initial=x(n)), coordinate("u", unit="m")
    M, m, r, g = parameters("M m r g", units="kg kg m m/s^2", values=(0.05, 0.15, 0.015, 9.81), ranges={"r": (1e-3, 1)})
    alpha, F_c = parameters("alpha", units="rad", values=0, ranges=(-0.5, 0.5)), coupler(z)
    phi = coordinate("phi", unit="rad")
    kinetic = M * z.diff(t) ** 2 / 2 + m * (z + u).diff(t) ** 2 / 2 + m * r**2 / 2 * phi.diff(t) ** 2 / 2
    weight = g * sp.sin(alpha) * (M * z + m * (z + u))
    motion = lagrange(kinetic - weight, forces={z: F_c}, constraints=[u + r * phi])
    return Scene(force=F_c, eom=[motion], watch=[z, u], name="rolling disc")


def draw_rolling(axes, *, x=0.012, z=0.008, u=0.012, r=0.015, alpha=0.0, **_):
    """Draw the plate on rollers beside the handle, the disc on it, all along the slope."""
    s, origin = Sketch(axes, -0.075, 0.195, -0.028, 0.0445, tilt=alpha), 0.09 + clearance(x, z)
    plate = np.stack([z + origin, 0.0])
    top = 2.5 * s.u
    centre = plate + [u, top + r]
    s.pair((x, 0), (plate[0] - 22 * s.u, 0), carries="F")
    s.handle(x, below=8.7)
    s.block(plate, 44, 5, name="z")
    s.text(plate, "$M$", right=-12)
    for side in (-14, 0, 14):
        s.disc(plate + [side * s.u, -4 * s.u], 1.5 * s.u)
    start, end = plate[0] - 20 * s.u, plate[0] + 20 * s.u
    s.ground((start, -5.5 * s.u), (end, -5.5 * s.u))
    if alpha:
        low, level = (start, 0) if alpha > 0 else (end, np.pi)
        foot, level_to = np.stack([low, -5.5 * s.u]), level - alpha
        s.line(foot, foot + 16 * s.u * np.stack([np.cos(level_to), np.sin(level_to)]), width=0.8, color=SOFT, linestyle="--")
        s.angle(foot, 12, level_to, level, r"$\alpha$")
    s.disc(centre, r, -np.pi / 2 - u / r, name="u")
    s.text(centre, "$m$", up=2.5)
    s.text(centre, "$r$", right=np.where(u >= 0, -3, 3), up=-1.5)
    s.angle(centre, r / s.u + 2, np.pi / 2 + 0.6, np.pi / 2 - 0.6, r"$\varphi$")
    s.coordinate("$z$", z, -8.7 * s.u, origin=origin)
    s.coordinate("$u$", u, 0.0, origin=plate[0])
