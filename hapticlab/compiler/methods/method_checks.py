"""Whether a method suits the equations of motion: what it supposes of them is looked at on the graph, or it is refused."""

import sympy as sp

from ...errors import ProgramError
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import Parameter, t
from ..ir.channels import short
from .force_timing import IMPULSE

#: what may have a kink or a jump
KINKS = (sp.Piecewise, sp.Max, sp.Min, sp.Abs, sp.sign, sp.Heaviside, sp.floor, sp.ceiling, sp.Mod)


def check_suited(method, form, graph, exact=False):
    """Refuse a method that would lose its order, or its stability, on these equations, naming the term.

    Parameters
    ----------
    method : Method
    form : ExplicitForm
    graph : Graph
    exact : bool
        Other equations are advanced exactly beside these.
    """
    if method.order_with_velocity and method.order_with_velocity < method.order:
        _check_free_of_velocity(method, form, graph)
    if method.steps > 1:
        _check_smooth(method, form, graph)
        if exact:
            raise ProgramError(
                f"method = 'exact+{method.name}': RK4 computes the rates before the first sample, where the exact part is "
                "not known. Use 'exact+rk4'"
            )


def _check_free_of_velocity(method, form, graph):
    cure = f"with it {method.name} has order {method.order_with_velocity}, not {method.order}. Use 'rk4'"
    first = [q for q, order in zip(form.coordinates, form.orders, strict=True) if order == 1 and q != IMPULSE]
    if first:
        name = type(first[0]).__name__
        raise ProgramError(
            f"{name} has an equation of first order, but {method.name} integrates only those of second order. Use 'rk4'"
        )
    if any(model.constraints for model in form.models):
        raise ProgramError(f"constraints add terms with the square of velocities to the accelerations; {cure}")
    rates = [q.diff(t) for q in form.coordinates]
    for q, f in zip(form.coordinates, form.f, strict=True):
        for rate in rates:
            if graph(Partial(f, rate)).constant != 0:
                terms = sp.Add.make_args(f)
                term = next(term for term in terms if graph(Partial(term, rate)).constant != 0)
                what = "the mean force" if q == IMPULSE else f"the acceleration of {type(q).__name__}"
                raise ProgramError(f"{what} depends on {rate}, through {short(term, 60)}; {cure}")


def _check_smooth(method, form, graph):
    cure = f"{method.name} uses rates from earlier steps, which after a switch belong to a different case. Use 'rk4' or 'taylor'"
    contacts = [c.name for model in form.models for c in model.contacts]
    if contacts:
        raise ProgramError(f"{contacts[0]} starts and ends within a step: {cure}")
    for q, row, f in zip(form.coordinates, form.M, form.f, strict=True):
        for case in sorted({c for e in (*row, f) for c in e.atoms(*KINKS)}, key=str):
            moving = [v for v in graph.variables_of(_conditions(case)) if not isinstance(v, Parameter)]
            if moving:
                raise ProgramError(f"{short(case, 60)} in the equation of {type(q).__name__} changes with {moving[0]}: {cure}")


def _conditions(case):
    if isinstance(case, sp.Piecewise):
        return [side for _, c in case.args for r in c.atoms(sp.core.relational.Relational) for side in r.args]
    return case.args
