"""The motions of the work-precision diagrams, each written once for every peer.

``rates(sin, cos)`` gives what makes accelerations of (q, w, touching), numbers and heyoka's expressions alike;
``touching`` says whether the contact acts, and ``gap(q, w)`` is what changes that when it passes zero.
"""

import math
from dataclasses import dataclass

import sympy as sp

import hapticlab as hl
from hapticlab import t

G = 9.81


@dataclass(frozen=True)
class Problem:
    """A motion from rest of the handle: how it starts, its equations, its scene, its MuJoCo model."""

    name: str
    duration: float
    q: tuple
    w: tuple
    rates: object
    scene: object  #: (q, w) -> Scene
    mujoco: object  #: (h, integrator) -> its XML, or None
    gap: object = None
    scale: float = 1.0
    stiff: bool = False


M, LENGTHS = (0.08, 0.12), (0.15, 0.12)


def _double(sin, cos):
    (m1, m2), (l1, l2) = M, LENGTHS

    def rates(q, w, touching):
        a, b = q[0] - q[1], l1 * l2 * m2
        M11, M12, M22 = (m1 + m2) * l1**2, b * cos(a), m2 * l2**2
        f1 = -b * sin(a) * w[1] * w[1] - (m1 + m2) * G * l1 * cos(q[0])
        f2 = b * sin(a) * w[0] * w[0] - m2 * G * l2 * cos(q[1])
        D = M11 * M22 - M12 * M12
        return (M22 * f1 - M12 * f2) / D, (M11 * f2 - M12 * f1) / D

    return rates


def _double_scene(q, w):
    names = "m1 m2 l1 l2 g K"
    m1, m2, l1, l2, g, one = hl.parameters(names, units="kg kg m m m/s^2 N/rad", values=(*M, *LENGTHS, G, 1))
    a = [hl.coordinate(f"q{k}", unit="rad", initial=q[k], rate=w[k]) for k in range(2)]
    x, y = l1 * sp.cos(a[0]), l1 * sp.sin(a[0])
    ends = [(m1, x, y), (m2, x + l2 * sp.cos(a[1]), y + l2 * sp.sin(a[1]))]
    L = sum(m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 - m * g * y for m, x, y in ends)
    return hl.Scene(force=one * a[0], eom=[hl.mechanics.lagrange(L)], watch=a)


def _double_model(h, integrator, m=M, l=LENGTHS):
    point = '<inertial mass="{}" pos="{} 0 0" diaginertia="2e-15 2e-15 2e-15"/>'.format
    joint = '<joint type="hinge" axis="0 0 1"/>'
    body = f'<body>{joint}{point(m[0], l[0])}<body pos="{l[0]} 0 0">{joint}{point(m[1], l[1])}</body></body>'
    return (
        f'<mujoco><compiler angle="radian"/><option gravity="0 -{G} 0" timestep="{h}" integrator="{integrator}"/>'
        f"<worldbody>{body}</worldbody></mujoco>"
    )


def _contact(K=0.0, b=0.0, g=0.0, wall=(0.0, 1e4, 0.0), m=0.1):
    """Return (rates, scene, model, gap) of a mass on a spring K and a damper b below gravity g, with a wall at ``wall[0]``.

    The wall pushes upwards with stiffness wall[1] and damping wall[2] where z < wall[0].
    """
    at, k, c = wall

    def made(sin, cos):
        def rates(q, w, touching):
            push = -k * (q[0] - at) - c * w[0]
            return ((-K * q[0] - b * w[0] + touching * push) / m - g,)

        return rates

    def scene(q, w):
        names, units = "m g K_s b_s k_w b_w z_w K", "kg m/s^2 N/m N*s/m N/m N*s/m m N/m"
        mass, gravity, K_s, b_s, k_w, b_w, z_w, one = hl.parameters(names, units=units, values=(m, g, K, b, k, c, at, 1))
        z = hl.coordinate("z", unit="m", initial=q[0], rate=w[0])
        rate = z.diff(t)
        push = hl.when(z <= z_w, -k_w * (z - z_w) - b_w * rate)
        L = mass * rate**2 / 2 - mass * gravity * z - K_s * z**2 / 2
        return hl.Scene(force=one * z, eom=[hl.mechanics.lagrange(L, forces={z: push - b_s * rate})], watch=[z])

    def model(h, integrator):
        if c:  # MuJoCo's dead band has no damping
            return None
        return (
            f'<mujoco><option gravity="0 0 -{g}" timestep="{h}" integrator="{integrator}"/><worldbody><body>'
            f'<joint name="z" type="slide" axis="0 0 1" stiffness="{K}" damping="{b}"/>'
            f'<inertial pos="0 0 0" mass="{m}" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>'
            f'<tendon><fixed stiffness="{k}" springlength="{at} 1e9"><joint joint="z" coef="1"/></fixed></tendon></mujoco>'
        )

    return made, scene, model, lambda q, w: q[0] - at


def _walled(name, duration, q, w, scale, stiff=False, **of):
    rates, scene, model, gap = _contact(**of)
    return Problem(name, duration, q, w, rates, scene, model, gap, scale, stiff)


PROBLEMS = (
    Problem("double pendulum", 1.0, (0.4, -0.9), (1.0, -2.0), _double, _double_scene, _double_model, scale=math.pi),
    _walled("ball on an elastic floor", 2.0, (0.03,), (0.0,), 0.03, g=G, wall=(0.0, 1e4, 0.0)),
    _walled("mass and spring at a damped wall", 2.0, (0.05,), (0.0,), 0.05, K=200.0, b=0.05, wall=(-0.02, 1e4, 3.0)),
    _walled(
        "the same at an undamped wall of 1e7 N/m",
        0.5,
        (0.05,),
        (0.0,),
        0.05,
        True,
        K=200.0,
        b=0.05,
        wall=(-0.02, 1e7, 0.0),
    ),
)
