"""What expressions are at the first sample, as numbers."""

import math

import sympy as sp

from ...scene.notation.parameters import Parameter
from ...scene.notation.symbols import delay, n, t
from .graph import Graph


def numbers(expressions, values):
    """Return expressions at the first sample as floats, or None where a parameter has no value.

    Parameters
    ----------
    expressions : sequence of expressions
    values : dict name -> number
        Parameters; else their declared values. The handle is taken to rest at 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, a = hl.parameters("k a", units="N/m m", values=(None, 0.1))
    >>> q = hl.coordinate("q", unit="m", initial=a)
    >>> numbers([k * q], {"k": 30}), numbers([k * q], {})
    ([3.0], None)
    """
    graph = Graph()
    at = {variable: _start(variable, values) for variable in graph.variables_of(expressions)}
    return None if any(map(math.isnan, at.values())) else [float(e) for e in graph.evaluate(expressions, at)]


def _start(variable, values):
    if isinstance(variable, Parameter):
        return float(values.get(variable.name, variable.value))
    if variable in (n, t) or getattr(type(variable), "role", None) in ("handle", "driven"):
        return 0.0
    if isinstance(variable, delay):
        initial = variable.args[0]
    elif isinstance(variable, sp.Derivative):
        initial = type(variable.expr).rate
    else:
        initial = getattr(type(variable), "initial", sp.S.Zero)  # reactions and impacts: nothing has happened yet
    return (numbers([initial], values) or [math.nan])[0]
