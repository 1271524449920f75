"""When in the period a force is evaluated: at its start, with the states at its end, or on average."""

from dataclasses import replace

import sympy as sp

from ...errors import ProgramError
from ...scene.notation.symbols import T, t, v, x
from ..algebra.graph import driven

#: with the states at the sample, with those at the end of the period, or the mean over the period
FORCE_AT = ("before", "after", "mean")

#: what the force adds up to since the sample, as a coordinate of first order: its name is no word, so no scene has it
IMPULSE = sp.Function("impulse of F", real=True, unit="N*s", role="coordinate", initial=sp.S.Zero, low=-sp.oo, high=sp.oo)(t)


def averaged(form, graph):
    """A form whose force is the mean over the period, the integral of F since the sample divided by T.

    The integral is one more state of the same method, so that the impulse which is felt is the impulse that the bodies
    are given. A force of samples alone is its own mean.
    """
    variables = graph.variables_of([form.force])
    if not any(map(_moves, variables)):
        return form
    for c in (c for model in form.models for c in model.contacts if getattr(c, "force", None) in variables):
        if not (c.is_force or c.is_located):
            raise ProgramError(
                f"force_at = 'mean': {c.force} acts only at the instants where steps end. Use force_at='before', which "
                "holds the force of its impulse over the period"
            )
    return replace(
        form,
        coordinates=(*form.coordinates, IMPULSE),
        orders=(*form.orders, 1),
        M=(*((*row, sp.S.Zero) for row in form.M), (*[sp.S.Zero] * len(form.f), sp.S.One)),
        f=(*form.f, form.force),
        force=IMPULSE / T,
    )


def _moves(variable):
    """Whether a variable of a graph changes between two samples."""
    role = getattr(type(variable.expr if variable.is_Derivative else variable), "role", None)
    return variable in (t, x(t), v(t)) or isinstance(variable, driven) or role in ("coordinate", "reaction")


def hints(form, graph, options):
    """Yield notes on a hold that goes badly with the instant of the force, or with substeps."""
    if not any(a in (x(t), v(t)) for a in graph.variables_of(form.f)):
        return
    if options.force_at == "after" and options.hold != "zoh":
        yield (
            f"force_at = 'after' with hold = {options.hold!r}: lightly damped bodies need more device damping than with "
            "'before' or with hold='zoh'; hl.passivity.port computes how much"
        )
    if options.substeps > 1 and options.hold == "zoh" and options.method.rest is not None:
        yield (
            f"hold = 'zoh' sets the error, of order 1: {options.substeps} substeps shorten the step, which helps stability "
            "and contacts but not this error; hold='foh' or 'soh' makes the error smaller"
        )
