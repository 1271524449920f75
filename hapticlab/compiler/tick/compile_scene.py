"""Lower a scene to a program: the sample is taken, the force computed from it, then the equations of motion advance."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...errors import ProgramError, SceneError
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from ..algebra.graph import Graph
from ..contacts.broad_phase import Contacts
from ..ir.cache import Shared, content
from ..ir.options import choice, live_names, period, steps, unusual
from ..ir.program import Channel
from ..methods.chosen_method import chosen_method, why_automatic
from ..methods.force_timing import FORCE_AT, averaged
from ..prune.excluded_modes import excluded, folded, rests_on
from .handle_samples import VELOCITIES, hold_named
from .leaf_values import REAL_OF, at_sample, at_start, outputs_at_sample, real, tick_of, unknown_reaction
from .motion_program import motion_program
from .source import Options, Source

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.annotations import Number
    from ...scene.notation.parameters import Parameter
    from ..ir.program import Program
    from ..methods.chosen_method import AnyMethod
    from .handle_samples import Hold

#: compiled scenes that are kept: instructions, of which each takes 0.4 kB, and as many again for what else a program has
PROGRAMS = Shared(60_000, lambda program: 200 + program.size)


def compile(
    scene: Scene,
    method: AnyMethod | None = None,
    *,
    T: Number,
    substeps: int = 1,
    hold: str | Hold = "soh",
    dtype: str = "float32",
    velocity: str = "backward_difference",
    live: str | Iterable[str | Parameter] | None = None,
    force_at: str = "before",
) -> Program:
    """Compile a scene to the program that runs at the sample rate.

    At sample n the force is computed from x(n) and the present states (``force_at`` offers two alternatives). Then the
    equations of motion advance by T in ``substeps`` steps of an explicit method.

    Parameters
    ----------
    scene : Scene
    method : str or Method, optional
        "euler", "semi_implicit_euler", "semi_implicit_euler_damped", "verlet", "midpoint", "heun", "ssprk3", "rk4",
        "nystrom4", "adams_bashforth2", "adams_bashforth3", "taylor", "exact", "exact+rk4", or "exact+" and another.
        By default the one that the scene needs: "taylor" where a contact or a friction must be located inside the step
        (touch, impact, sticking), else "rk4". The program's notes say which was chosen, and why. ``hl.methods.table()``
        lists the explicit methods with order, cost and stable range; ``hl.methods.order_of`` gives the order of the
        error of a scene's force. "semi_implicit_euler_damped" treats dampers implicitly, however stiff. "nystrom4" is
        for accelerations free of velocities, the Adams-Bashforth methods are for motion without cases. "taylor" locates
        the instants at which walls, contacts and friction change the motion; between them it is exact to rounding where
        the motion is linear. :class:`~hapticlab.compiler.events.taylor_method.Taylor` sets its order and events.
        "exact" advances linear equations of motion by their matrix exponential, computed from parameters that are not
        ``live``, without step error at any stiffness. For motion that is linear between switches (walls, contacts,
        friction) it computes one map per mode and locates the switches. With "+rk4", rk4 advances the nonlinear part.
    T : float or str
        Sampling period [s], > 0, or a text with its unit, ``"1 ms"``.
    substeps : int
        Steps per period, >= 1.
    hold : {"zoh", "foh", "soh"}
        Or a record, as ``hl.methods.SecondOrderHold``. How an equation of motion sees x(t) and v(t) between samples
        (see :class:`~hapticlab.methods.Hold`). It affects the accuracy more than the method
        does: with a held sample ("zoh") RK4 has an error of ten percent of the force.
    dtype : {"float32", "float64"}
        A board runs float32.
    velocity : {"backward_difference", "measured"}
        Source of v(n); with "measured" the paddle gives it.
    live : str or sequence of names or Parameters, optional
        Parameters that you can change while the scene runs, by default all except those in constraints; the others
        become constants.
    force_at : {"before", "after", "mean"}
        The states from which the force is computed. ``"before"``: those at the sample, so that F(n) is the force at
        that instant. ``"after"``: those at the end of the period, with the sample x(n), v(n), as a loop that moves its
        bodies first does it; what difference equations and channels hold stays that of the sample. ``"mean"``: the mean
        of F over the period as the equations of motion see it, with x(t) of ``hold``, so that the impulse at the handle
        equals the impulse on the bodies.

    Returns
    -------
    Program
        ``len(program)`` is its number of instructions per tick; printing it lists them. The same scene with the same
        options gives the same object again, unless many others were compiled since.

    Raises
    ------
    ProgramError, ParameterError, SceneError

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> wall = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)))
    >>> len(hl.compile(wall, T=1e-3))
    4
    """
    if not isinstance(scene, Scene):
        raise SceneError(no_scene(scene, "write hl.compile(hl.Scene(force=...), T=1e-3)"))
    method, hold = _methods(method, hold)  # equal ones make one program
    options = method, T, substeps, hold, dtype, velocity, live, force_at
    return PROGRAMS.get(_key(scene, options), lambda: lowered(scene, *options))


def _key(scene, options):
    """What a program depends on: all that the scene holds, and the options as they were given."""
    return content(type(scene), {**vars(scene), "_parameters": scene.parameters}, options)


def _methods(method, hold):
    """What ``method`` and ``hold`` stand for; the method may be None still."""
    return None if method is None else chosen_method(method), hold_named(hold)


def _checked(method, T, substeps, hold, dtype, velocity, live, force_at):
    """The :class:`Options` of what was asked for, or a refusal that names what is known; their method may be None still."""
    method, hold = _methods(method, hold)
    choice("dtype", dtype, REAL_OF)
    choice("velocity", velocity, VELOCITIES)
    choice("force_at", force_at, FORCE_AT)
    options = Options(method, period(T), steps(substeps), hold, dtype, velocity, live_names(live), force_at)
    if method and method.exact and method.rest is None and options.substeps > 1:
        raise ProgramError(
            f"substeps = {options.substeps}: method='exact' solves the whole period in one step. Leave out substeps"
        )
    return options


def lowered(scene, method, T, substeps, hold, dtype, velocity, live, force_at, undecided=()):
    """The program of a scene; of the conditions in ``undecided``, declared ranges decide nothing."""
    options = _checked(method, T, substeps, hold, dtype, velocity, live, force_at)
    try:
        form, decisions = excluded(scene, options.T, options.live, undecided)
        for model in form.models:
            if isinstance(model.contacts, Contacts):
                model.contacts.check(scene.values)
        automatic = [why_automatic(form)] if options.method is None and form.coordinates else []
        options = replace(options, method=chosen_method(options.method, form))
        fixed = folded(scene, options.live)
        graph = Graph(fixed)
        form = averaged(form, graph) if options.force_at == "mean" else form
        source = Source(scene, form, options, fixed, graph)
        program = motion_program(source, rests_on(form, decisions)) if form.coordinates else force_program(source)
        notes = [*automatic, *unusual(options.T, len(program))]
        return replace(program, notes=(*program.notes, *notes)) if notes else program
    except RecursionError:
        raise ProgramError(
            f"{scene.name}: an expression is nested too deeply to compile. Name its parts as signals, "
            "y = hl.signal(...), with an equation for each"
        ) from None


def force_program(source):
    """The program of a force of samples alone: the sample is taken, force and channels follow from it, and that is the tick."""
    scene, options, tick = source.scene, source.options, tick_of(source)
    tracing = tick.tracing
    sample = at_sample(tick, at_start(tick), lambda expr, _: unknown_reaction(expr))
    before = options.force_at == "before"
    force, outputs = outputs_at_sample(scene, source.form, tracing, sample, before)
    force = force if before else real(scene, tracing, sample(source.form.force))
    tracing.complete()
    facts = {"velocity": options.velocity, "dtype": options.dtype}
    outputs = [(Channel("F", "N", tracing.real), force), *outputs]
    program = tracing.finish(scene.name, outputs, scene.values, facts, tick.signals.unused)
    tick.check_values(program)
    return program
