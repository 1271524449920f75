"""The equations of motion of a scene, differentiated at points: J of y' = J y."""

import numpy as np

from ...compiler.algebra.phase import TICKS
from ...compiler.algebra.tangents import tangents
from ...compiler.events.guards import Leaves
from ...compiler.ir.channels import channel_of
from ...compiler.ir.trace import Value


class Slopes:
    """The rates of a scene's motion by its states, in numbers.

    Parameters
    ----------
    moving : Moving
        The scene, ready to be traced: here over leaves of its own.
    damped : bool
        Take dampers implicitly, so that the rates depend on the step.

    Attributes
    ----------
    names : list of str
        What the states are called: positions, their rates, states of first order.
    seconds : int
        How many are positions.
    """

    def __init__(self, moving, damped=False):
        dynamics, equations, self.tracing = moving.dynamics, moving.dynamics.equations, moving.tick.tracing
        self.values, self.seconds = moving.tick.values, len(equations.second)
        self.names = [channel_of(state, "f64").name for state in equations.states]
        new, n, m = Leaves(self.tracing.tick), len(equations.second), len(equations.first)
        q, w, s = ([new() for _ in range(count)] for count in (n, n, m))
        tau, self.h = new(), new()
        touching = dynamics.touching()
        given = touching.reactions(tau, q, w, s, new) if touching else []
        unknowns, step = touching.unknowns if touching else {}, self.h if damped else None
        rates = dynamics.rates(tau, q, w, s, unknowns, step) if equations.states else ([], [])
        self.rates = [r.id if isinstance(r, Value) else self.tracing.tick.const(r).id for part in rates for r in part]
        self.moving = [_leaf(value) for value in (*q, *w, *s)]
        # contacts of an instant are apart, and friction slips
        self.still = {_leaf(r.leaf): 0.0 for r in given} | {_leaf(r.side): np.bool_(True) for r in given if r.side is not None}
        self.still |= {_leaf(tau): 0.0}

    def jacobian(self, states, h=0.0, points=1, **parameters):
        """J at points, shape (P, S, S).

        Parameters
        ----------
        states : dict name -> float or array of shape (P,)
            Handle x and v, the states by name, and the tick where it is not the first.
        h : float or array of shape (P,)
            Step [s], for implicit damping; 0 for the motion itself.
        points : int
            P
        **parameters : float or array of shape (P,)
            Those that differ from what the scene has.
        """
        S, n = len(self.moving), self.seconds
        J = np.zeros((points, S, S))
        if not S:
            return J
        leaves = self.tracing.at_start(self.values) | self.still | {_leaf(self.h): h}
        leaves |= {("state", k): states[key] for k, key in enumerate(self.tracing.keys) if key == TICKS[0] and key in states}
        leaves |= {("input", k): states.get(name, 0.0) for k, name in enumerate(("x", "v"))}
        number = {p.name: k for k, p in enumerate(self.tracing.parameters)}
        leaves |= {("param", number[name]): value for name, value in parameters.items() if name in number}
        leaves |= {leaf: states[name] for leaf, name in zip(self.moving, self.names, strict=True)}
        _, slopes = tangents(self.tracing.tick.instructions, self.rates, leaves, self.moving, points)
        J[:, :n, n : 2 * n] = np.eye(n)
        J[:, n:] = np.moveaxis(slopes, 2, 0)
        return J


def _leaf(value):
    i = value.builder.instructions[value.id]
    return i.op, i.index
