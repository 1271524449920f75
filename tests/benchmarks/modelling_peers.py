"""Planar pendulums by hapticlab, CasADi, PyDy, SymPy, numba and MuJoCo, as their users write them.

Every maker takes a :class:`Pendulum` and returns a :class:`Made`. Angles are from the x axis, gravity along -y, point
masses at the ends of massless links, every mass and length its own live parameter: the model of PyDy's
``n_link_pendulum_on_cart``.
"""

import functools
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import sympy as sp

KINDS = ("absolute", "relative", "cart")


@dataclass(frozen=True)
class Made:
    """What a peer made: ``accelerations()`` at the model's state, ``run(steps)`` its state after RK4 steps of h, shape (2, N)."""

    accelerations: object
    run: object
    operations: object = None  #: operations() of M, f and the solve: all, and those that the parameters alone do not settle
    semi_implicit: object = None  #: run(steps) by semi-implicit Euler


@dataclass(frozen=True)
class Pendulum:
    """A chain of links: absolute or relative angles, or absolute ones on a cart."""

    links: int
    kind: str = "absolute"
    h: float = 1e-4

    @property
    def size(self):
        return self.links + (self.kind == "cart")

    def numbers(self):
        """Return masses [kg], lengths [m], coordinates and rates: seeded, none of them alike."""
        random = np.random.default_rng(self.links)
        m, l = random.uniform(0.05, 0.15, self.size), random.uniform(0.1, 0.2, self.links)
        return m, l, random.uniform(-1.0, 1.0, self.size), random.uniform(-2.0, 2.0, self.size)

    @property
    def parameters(self):
        m, l, _, _ = self.numbers()
        return np.array([*m, *l, 9.81])

    def lagrangian(self, sin, cos, q, w, m, l, g):
        """Return kinetic less potential energy."""
        x = self.kind == "cart"
        y, vx, vy = 0, (w[0] if x else 0), 0
        kinetic, potential = (m[0] * vx**2 / 2 if x else 0), 0
        angle = rate = 0
        for k in range(self.links):
            angle, rate = (angle + q[k], rate + w[k]) if self.kind == "relative" else (q[k + x], w[k + x])
            y, vx, vy = y + l[k] * sin(angle), vx - l[k] * sin(angle) * rate, vy + l[k] * cos(angle) * rate
            kinetic += m[k + x] * (vx**2 + vy**2) / 2
            potential += m[k + x] * g * y
        return kinetic - potential

    def absolute(self, q):
        """Return absolute angles of the model's own."""
        return np.cumsum(q) if self.kind == "relative" else np.asarray(q)

    def reference(self):
        """Return the accelerations by the equations in closed form, M_ij = mu l_i l_j cos(q_i - q_j), in absolute angles."""
        m, l, q, w = self.numbers()
        q, w, x = self.absolute(q), self.absolute(w), int(self.kind == "cart")
        mass = np.cumsum(m[::-1])[::-1]
        tail, a, r = mass[x:], q[x:], w[x:]
        shared = np.minimum.outer(tail, tail) * np.outer(l, l)
        M, f = np.zeros((self.size, self.size)), np.zeros(self.size)
        M[x:, x:] = shared * np.cos(a[:, None] - a)
        f[x:] = -(shared * np.sin(a[:, None] - a)) @ r**2 - 9.81 * tail * l * np.cos(a)
        if x:
            M[0, 0], M[0, 1:], f[0] = mass[0], -tail * l * np.sin(a), (tail * l * np.cos(a)) @ r**2
            M[1:, 0] = M[0, 1:]
        return np.linalg.solve(M, f)


def rk4(rates, h):
    """Return ``run(steps, q, w)`` in Python around ``rates(y)`` of y = [q, w]."""

    def run(steps, q, w):
        y = np.concatenate([q, w])
        for _ in range(steps):
            a = rates(y).copy()  # PyDy fills the same array at each call
            b = rates(y + h / 2 * a).copy()
            c = rates(y + h / 2 * b).copy()
            d = rates(y + h * c)
            y = y + h / 6 * (a + 2 * (b + c) + d)
        return y.reshape(2, -1)

    return run


# hapticlab


def hapticlab(model):
    """hl.mechanics.lagrange, hl.compile, and machine code by LLVM."""
    import hapticlab as hl

    m, l, q0, w0 = model.numbers()
    lengths = ["m" if model.kind == "cart" and k == 0 else "rad" for k in range(model.size)]
    m = declared("m", ["kg"] * model.size, m)
    l = declared("l", ["m"] * model.links, l)
    g, K = hl.parameters("g K", units=f"m/s^2 N/{lengths[0]}", values=[9.81, 1.0])
    starts = zip(lengths, declared("a", lengths, q0), declared("r", [f"{u}/s" for u in lengths], w0), strict=True)
    q = [hl.coordinate(f"q{k}", unit=u, initial=a, rate=r) for k, (u, a, r) in enumerate(starts)]
    L = model.lagrangian(sp.sin, sp.cos, q, [a.diff(hl.t) for a in q], m, l, g)
    scene = hl.Scene(force=K * q[0], eom=[hl.mechanics.lagrange(L)])
    return scene_made(scene, [f"q{k}" for k in range(model.size)], w0, model.h)


def declared(letter, units, values):
    """Return parameters letter0, letter1, ... with units and values."""
    from hapticlab import parameters

    names = [f"{letter}{k}" for k in range(len(units))]
    made = parameters(" ".join(names), units=" ".join(units), values=dict(zip(names, map(float, values), strict=True)))
    return made if isinstance(made, tuple) else (made,)


def scene_made(scene, names, w0, h):
    """Return what hapticlab makes of a scene with coordinates of these names and rates ``w0``."""
    import hapticlab as hl
    from hapticlab.compiler.engines.engine import load

    engines = {}

    def run(steps, method="rk4"):
        if method not in engines:
            options = {"T": h, "hold": "zoh", "dtype": "float64", "velocity": "measured"}
            engines[method] = load(hl.compile(scene, method, **options), "llvm")
        program = engines[method].program
        states = engines[method].run(steps, np.zeros((steps, len(program.inputs)))).states[:, 0]
        known = dict(zip([c.name for c in program.states], states, strict=True))
        return np.array([[known[name] for name in names], [known[f"d{name}/dt"] for name in names]])

    def accelerations():
        return (run(1, "euler")[1] - w0) / h

    def operations():
        accelerations()
        return program_operations(engines["euler"].program)

    return Made(accelerations, run, operations, lambda steps: run(steps, "semi_implicit_euler"))


def program_operations(program):
    """Return how many operations the rates of an Euler step need, and how many of them depend on a state.

    The step w + T a is two operations a rate, which the method does and not the equations.
    """
    from hapticlab.compiler.ir.program import LEAVES
    from hapticlab.compiler.ir.trace import reachable

    code = program.tick.instructions
    rates = [k for c, k in zip(program.states, program.tick.states, strict=True) if c.name.endswith("/dt")]
    needed = reachable(code, rates)
    moving = set()
    for k in needed:
        if code[k].op == "state" or moving.intersection(code[k].args):
            moving.add(k)
    count = sum(code[k].op not in LEAVES for k in needed) - 2 * len(rates)
    return count, sum(code[k].op not in LEAVES for k in moving) - 2 * len(rates)


# CasADi


def casadi_rates(model):
    """Return q, w, parameters and accelerations in SX: derivatives of L on CasADi's graph, its LDL^T, its cse.

    Of jacobian and hessian, explicit velocities and jtimes, ldl, qr and chol, with and without cse, this is the least.
    """
    import casadi as ca

    q, w, m = (ca.SX.sym(name, model.size) for name in "qwm")
    l, g = ca.SX.sym("l", model.links), ca.SX.sym("g")
    L = model.lagrangian(ca.sin, ca.cos, *(ca.vertsplit(v) for v in (q, w, m, l)), g)
    momentum = ca.gradient(L, w)
    M, f = ca.jacobian(momentum, w), ca.gradient(L, q) - ca.jtimes(momentum, q, w)
    D, LT, p = ca.ldl(M, False)
    return q, w, ca.vertcat(m, l, g), ca.cse(ca.ldl_solve(f, D, LT, p))


def casadi(model, c_code=False):
    """CasADi's virtual machine, or its C through gcc -O3; the loop over steps is CasADi's fold."""
    import casadi as ca

    q, w, p, a = casadi_rates(model)
    return casadi_made(ca, q, w, p, a, model, c_code)


def casadi_made(ca, q, w, p, a, model, c_code):
    """Return what CasADi makes of accelerations."""
    both, later = ca.vertcat(q, w), w + model.h * a
    rates = plain = ca.Function("rates", [both, p], [a])
    step = ca.Function("step", [both, p], [_casadi_rk4(ca, rates, model.h, q.numel(), both, p)])
    semi = ca.Function("semi", [both, p], [ca.vertcat(q + model.h * later, later)])
    if c_code:
        rates, step, semi = gcc(ca, [rates, step, semi])
    y, values, fold = np.concatenate(model.numbers()[-2:]), model.parameters, functools.cache(lambda f, n: f.fold(n))
    return Made(
        lambda: np.asarray(rates(y, values))[:, 0],
        lambda steps: np.asarray(fold(step, steps)(y, values)).reshape(2, -1),
        lambda: casadi_operations(ca, plain),
        lambda steps: np.asarray(fold(semi, steps)(y, values)).reshape(2, -1),
    )


def _casadi_rk4(ca, rates, h, N, y, p):
    def slope(y):
        return ca.vertcat(y[N:], rates(y, p))

    a = slope(y)
    b = slope(y + h / 2 * a)
    c = slope(y + h / 2 * b)
    d = slope(y + h * c)
    return y + h / 6 * (a + 2 * (b + c) + d)


def gcc(ca, functions):
    """Return the functions from CasADi's C, at -O3."""
    with tempfile.TemporaryDirectory() as folder:
        generator = ca.CodeGenerator("functions.c")
        for f in functions:
            generator.add(f)
        generator.generate(folder + "/")
        library = Path(folder) / "functions.so"
        subprocess.run(
            ["gcc", "-O3", "-march=native", "-shared", "-fPIC", f"{folder}/functions.c", "-o", library, "-lm"], check=True
        )
        return [ca.external(f.name(), str(library)) for f in functions]


def casadi_operations(ca, f):
    """Return how many operations a CasADi function has, and how many depend on its first input."""
    total, moving, depends = 0, 0, {}
    for k in range(f.n_instructions()):
        op, made = f.instruction_id(k), f.instruction_output(k)
        if op == ca.OP_INPUT:
            depends[made[0]] = f.instruction_input(k)[0] == 0
        elif op == ca.OP_CONST:
            depends[made[0]] = False
        elif op != ca.OP_OUTPUT:
            depends[made[0]] = any(depends[a] for a in f.instruction_input(k))
            total, moving = total + 1, moving + depends[made[0]]
    return total, moving


# SymPy: LagrangesMethod and KanesMethod


def lagranges_method(model):
    """Return SymPy's LagrangesMethod with its equations formed."""
    from sympy.physics import mechanics

    q = mechanics.dynamicsymbols(f"q:{model.size}")
    m, l, g = sp.symbols(f"m:{model.size}"), sp.symbols(f"l:{model.links}"), sp.Symbol("g")
    L = model.lagrangian(sp.sin, sp.cos, q, [a.diff() for a in q], m, l, g)
    method = mechanics.LagrangesMethod(L, q)
    method.form_lagranges_equations()
    return method


def kanes_method(model):
    """Return M, f, q, u and parameters from SymPy's KanesMethod; the cart is PyDy's own n_link_pendulum_on_cart."""
    from sympy.physics import mechanics as me

    m, l, g = sp.symbols(f"m:{model.size}"), sp.symbols(f"l:{model.links}"), sp.Symbol("g")
    if model.kind == "cart":
        from pydy.models import n_link_pendulum_on_cart

        kane = n_link_pendulum_on_cart(model.links, cart_force=False).eom_method
        return kane.mass_matrix, kane.forcing, [*kane.q], [*kane.u], [*m, *l, g]
    q, u = me.dynamicsymbols(f"q:{model.size}"), me.dynamicsymbols(f"u:{model.size}")
    floor, joint = me.ReferenceFrame("I"), me.Point("O")
    joint.set_vel(floor, 0)
    before, bodies, loads = floor, [], []
    for k in range(model.links):
        frame = before.orientnew(f"B{k}", "Axis", [q[k], floor.z])
        frame.set_ang_vel(before, u[k] * floor.z)
        end = joint.locatenew(f"P{k}", l[k] * frame.x)
        end.v2pt_theory(joint, floor, frame)
        bodies.append(me.Particle(f"Pa{k}", end, m[k]))
        loads.append((end, -m[k] * g * floor.y))
        joint, before = end, frame if model.kind == "relative" else floor
    kane = me.KanesMethod(floor, q_ind=q, u_ind=u, kd_eqs=[a.diff() - b for a, b in zip(q, u, strict=True)])
    kane.kanes_equations(bodies, loads)
    return kane.mass_matrix, kane.forcing, q, u, [*m, *l, g]


def sympy_operations(M, f):
    """Return the operations of M and f after SymPy's cse, and those of an LU with partial pivoting, as LAPACK's gesv."""
    found, left = sp.cse([M, f])
    N = len(f)
    lu = sum(j + 2 * j * j for j in range(N)) + N * (N - 1) + N * (N - 1) + N
    return int(sum(sp.count_ops(e) for _, e in found) + sum(sp.count_ops(e) for e in left)) + lu


def pydy(model, **options):
    """PyDy: KanesMethod, its generated right-hand side, RK4 in Python around it."""
    from pydy.codegen.ode_function_generators import generate_ode_function

    M, f, q, u, parameters = kanes_method(model)
    rates = generate_ode_function(
        f, q, u, parameters, mass_matrix=M, coordinate_derivatives=sp.Matrix(u), **options
    )  # fmt: skip
    values, (_, _, q0, w0) = model.parameters, model.numbers()
    if "linear_sys_solver" in options:
        operations = _pydy_solved(M, f, q, u, parameters)
    else:
        operations = lambda: (sympy_operations(M, f), None)  # noqa: E731
    run = rk4(lambda y: rates(y, 0.0, values), model.h)
    y0 = np.concatenate([q0, w0])
    return Made(lambda: rates(y0, 0.0, values)[model.size :].copy(), lambda steps: run(steps, q0, w0), operations)


def _pydy_solved(M, f, q, u, parameters):
    """Return what counts the operations of PyDy's symbolic solve, from the C it writes."""
    from pydy.codegen.c_code import _CSymbolicLinearSolveGenerator

    def operations():
        made = _CSymbolicLinearSolveGenerator([q, u, parameters], [M, f], sympy_solver="LU")
        return int(sum(sp.count_ops(e) for _, e in made.subexprs) + sp.count_ops(made.simplified_matrices[1])), None

    return operations


def numba(model):
    """KanesMethod, lambdify with cse, njit, NumPy's solve; the loop over steps is compiled too."""
    from numba import njit

    M, f, q, u, parameters = kanes_method(model)
    both = njit(sp.lambdify((q, u, parameters), (M, f), "numpy", cse=True))
    N = model.size

    @njit
    def rates(y, p):
        M, f = both(y[:N], y[N:], p)
        return np.concatenate((y[N:], np.linalg.solve(M, f)[:, 0]))

    return numba_made(rates, model, lambda: (sympy_operations(M, f), None))


def numba_made(rates, model, operations=None):
    """Return what numba makes of compiled ``rates(y, p)``."""
    from numba import njit

    h = model.h

    @njit
    def loop(steps, y, p):
        for _ in range(steps):
            a = rates(y, p)
            b = rates(y + h / 2 * a, p)
            c = rates(y + h / 2 * b, p)
            d = rates(y + h * c, p)
            y = y + h / 6 * (a + 2 * (b + c) + d)
        return y

    y, values = np.concatenate(model.numbers()[-2:]), model.parameters
    return Made(lambda: rates(y, values)[len(y) // 2 :], lambda steps: loop(steps, y, values).reshape(2, -1), operations)


# MuJoCo


def mujoco(model):
    """MuJoCo: the same chain as bodies and hinges, in relative angles as it always is; mj_step takes many steps a call."""
    import mujoco as mj

    m, l, q, w = (a.tolist() for a in model.numbers())
    x = int(model.kind == "cart")
    point = 'pos="{} 0 0" diaginertia="2e-15 2e-15 2e-15"'.format
    body = ""
    for k in reversed(range(model.links)):
        at = l[k - 1] if k else 0.0
        body = f'<body pos="{at} 0 0"><joint type="hinge" axis="0 0 1"/><inertial mass="{m[k + x]}" {point(l[k])}/>{body}</body>'
    if x:
        body = f'<body><joint type="slide" axis="1 0 0"/><inertial mass="{m[0]}" {point(0)}/>{body}</body>'
    made = mj.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian" balanceinertia="false" boundinertia="0"/>'
        f'<option gravity="0 -9.81 0" timestep="{model.h}" integrator="RK4"><flag contact="disable"/></option>'
        f"<worldbody>{body}</worldbody></mujoco>"
    )
    data = mj.MjData(made)

    def start(integrator):
        made.opt.integrator = integrator
        mj.mj_resetData(made, data)
        for to, given in ((data.qpos, q), (data.qvel, w)):
            to[:] = given if model.kind == "relative" else [*given[: x + 1], *np.diff(given[x:])]

    def own(values):
        return values.copy() if model.kind == "relative" else np.concatenate([values[:x], np.cumsum(values[x:])])

    def run(steps, integrator=mj.mjtIntegrator.mjINT_RK4):
        start(integrator)
        mj.mj_step(made, data, steps)
        return np.stack([own(data.qpos), own(data.qvel)])

    def accelerations():
        start(mj.mjtIntegrator.mjINT_RK4)
        mj.mj_forward(made, data)
        return own(data.qacc)

    return Made(accelerations, run, semi_implicit=lambda steps: run(steps, mj.mjtIntegrator.mjINT_EULER))
