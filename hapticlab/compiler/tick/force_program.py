"""The program of a force of samples alone: no equations of motion, no method, no contacts.

The sample is taken, the force and the watched channels are computed from it and from past samples, and that is the tick.
"""

from ..ir.program import Channel
from .samples import at_sample, at_start, outputs_at_sample, real, tick_of, unknown_reaction


def force_program(scene, form, options, fixed, graph):
    """The program of a scene without coordinates.

    Parameters
    ----------
    scene : Scene
    form : ExplicitForm
        What declared ranges left of it.
    options : Options
    fixed : dict name -> float
        The parameters that are constants of the program.
    graph : Graph
        Of the form's expressions, with these constants.
    """
    tick = tick_of(scene, form, options, fixed, graph)
    tracing = tick.tracing
    sample = at_sample(tick, at_start(tick), lambda expr, _: unknown_reaction(expr))
    before = options.force_at == "before"
    force, outputs = outputs_at_sample(scene, form, tracing, sample, before)
    force = force if before else real(scene, tracing, sample(form.force))
    tracing.complete()
    facts = {"velocity": options.velocity, "dtype": options.dtype}
    outputs = [(Channel("F", "N", tracing.real), force), *outputs]
    program = tracing.finish(scene.name, outputs, scene.values, facts, tick.signals.unused)
    tick.check_values(program)
    return program
