"""The solvers of the work-precision diagrams: each maker returns a call that gives the positions at the end, or None.

A maker is None's where its package is not installed, or does not have the law of a contact.
"""

import functools
import itertools
import math

import numpy as np

from hapticlab.errors import HapticlabError

REFUSALS = (HapticlabError, ArithmeticError, RuntimeError)
STEPS = (50, 100, 200, 500, 1000, 2000, 5000, 20_000)
TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
METHODS = ("taylor", "taylor of order 12", "exact", "rk4", "nystrom4", "verlet", "semi_implicit_euler")


def settings(problem):
    """Yield (solver, setting, maker) of everything that is compared."""
    for method, steps in itertools.product(METHODS, STEPS):
        yield "hapticlab", f"{method}, {_millis(problem, steps)}", functools.partial(ours, problem, method, steps)
    for method, tolerance in itertools.product(("DOP853", "LSODA", "Radau"), TOLERANCES):
        if method != "Radau" or tolerance >= 1e-9:  # seconds, beyond
            yield f"SciPy {method}", f"{tolerance:.0e}", functools.partial(scipy, problem, method, tolerance)
    for tolerance, tick in itertools.product((*TOLERANCES, 1e-16), (None, 1e-3)):
        name = "heyoka, in ticks of 1 ms" if tick else "heyoka"
        yield name, f"{tolerance:.0e}", functools.partial(heyoka, problem, tolerance, tick)
    for name, steps in itertools.product(("RK4", "implicitfast", "Euler"), STEPS):
        yield f"MuJoCo {name}", _millis(problem, steps), functools.partial(mujoco, problem, name, steps)


def _millis(problem, steps):
    return f"{problem.duration / steps * 1e3:.3g} ms"


def ours(problem, method, steps):
    """hapticlab: the scene compiled to machine code, the handle at rest; the last sample is the end."""
    import hapticlab as hl
    from hapticlab.compiler.engines.engine import load
    from hapticlab.compiler.events.taylor_method import Taylor

    method = Taylor(order=12) if method.endswith("12") else method
    scene, T = problem.scene(problem.q, problem.w), problem.duration / steps
    program = hl.compile(scene, method, T=T, hold="zoh", dtype="float64", velocity="measured", live=[])
    engine, inputs = load(program, "llvm"), np.zeros((steps + 1, len(program.inputs)))
    positions = [c.name for c in program.outputs].index
    watched = [positions(name) for name in scene.watch]
    return lambda: engine.run(steps + 1, inputs, every=steps + 1).outputs[0, watched, 0]


def _compiled(problem):
    """Return the derivative of y = [q, w] while the contact is open and while it acts, by numba where it is installed."""
    two, rates = len(problem.q) == 2, problem.rates(math.sin, math.cos)
    try:
        from numba import njit
    except ImportError:
        njit = lambda f: f  # noqa: E731
    rates = njit(rates)

    def derivative(acts):
        def of_one(t, y):
            return np.array([y[1], rates((y[0],), (y[1],), acts)[0]])

        def of_two(t, y):
            a = rates((y[0], y[1]), (y[2], y[3]), acts)
            return np.array([y[2], y[3], a[0], a[1]])

        return njit(of_two if two else of_one)

    return derivative(0.0), derivative(1.0)


def scipy(problem, method, tolerance, floor=1e-3):
    """solve_ivp, stopped where the contact opens or closes, and started again."""
    from scipy.integrate import solve_ivp

    free, touching = _compiled(problem)
    N, gap, start = len(problem.q), problem.gap, np.array([*problem.q, *problem.w])
    options = {"method": method, "rtol": max(tolerance, 3e-14), "atol": tolerance * floor * problem.scale}

    def event(t, y):
        return gap(y[:N], y[N:])

    event.terminal = True

    def run():
        y, now, acts = start, 0.0, gap is not None and gap(start[:N], start[N:]) < 0
        while now < problem.duration:
            event.direction = 1.0 if acts else -1.0
            found = solve_ivp(touching if acts else free, (now, problem.duration), y, events=[event] if gap else None, **options)
            if not found.success:
                raise ArithmeticError(found.message)
            y, now, acts = found.y[:, -1], found.t[-1], not acts
        return y[:N]

    run()  # numba compiles
    return run


def heyoka(problem, tolerance, tick=None):
    """heyoka's adaptive Taylor integrator; an event switches the contact on and off. A ``tick`` [s] is stopped at."""
    try:
        import heyoka as hy
    except ImportError:
        return None
    N, names = len(problem.q), [f"{a}{k}" for a in "qw" for k in range(len(problem.q))]
    y = hy.make_vars(*names)
    rates = problem.rates(hy.sin, hy.cos)(y[:N], y[N:], hy.par[0])
    events = []
    if problem.gap:

        def switch(ta, sign):
            ta.pars[0] = 0.0 if sign > 0 else 1.0
            return True

        events = [hy.t_event(problem.gap(y[:N], y[N:]), callback=switch)]
    start, acts = [*problem.q, *problem.w], [0.0] if problem.gap else []  # every contact starts open
    ta = hy.taylor_adaptive(
        [*zip(y, [*y[N:], *rates], strict=True)], start, pars=acts, tol=tolerance, t_events=events, compact_mode=False
    )

    ends = [problem.duration] if tick is None else np.arange(1, 1 + round(problem.duration / tick)) * tick

    def run():
        ta.time, ta.state[:], ta.pars[:] = 0.0, start, acts
        ta.reset_cooldowns() if events else None
        for end in ends:
            ta.propagate_until(end)
        return ta.state[:N].copy()

    return run


def mujoco(problem, name, steps):
    """MuJoCo: the same law as a spring with a dead band, relative angles as it always has."""
    try:
        import mujoco as mj
    except ImportError:
        return None
    mj.set_mju_user_warning(lambda message: None)  # instabilities go into the table
    text = problem.mujoco(problem.duration / steps, name)
    if text is None:
        return None
    model = mj.MjModel.from_xml_string(text)
    data, two = mj.MjData(model), len(problem.q) == 2

    def run():
        mj.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = (np.diff(v, prepend=0) if two else v for v in (problem.q, problem.w))
        mj.mj_step(model, data, steps)
        return np.cumsum(data.qpos) if two else data.qpos.copy()

    return run


@functools.cache
def truth(problem):
    """DOP853 at its tightest, restarted at each contact."""
    return scipy(problem, "DOP853", 1e-14, 1e-2)()


def agreement(problem):
    """Return how far our series in small steps is from the truth, relative to the scale."""
    steps = round(problem.duration / (2e-5 if problem.stiff else 1e-3))
    return np.abs(ours(problem, "taylor", steps)() - truth(problem)).max() / problem.scale
