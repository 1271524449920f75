"""``method="exact"``: linear equations of motion advanced by their matrix exponential, constants of the program."""

import numpy as np

from ...errors import LiveConstantError, ProgramError
from ...scene.notation.symbols import t
from ..algebra.graph import driven
from ..contacts.scene_contacts import located
from ..events.taylor_method import Switched
from ..ir.channels import channel_of, short
from ..ir.program import Channel
from ..prune.constant_coefficients import HANDLE, JUMPS, Coefficients, leaves, linear_rows
from ..prune.dependence import Dependence, coupled, part_of
from ..prune.mass_matrix import start_of
from .force_timing import IMPULSE

#: of a state by another [1/s, 1/s^2], in the matrix exponential
_LARGEST_RATE = 1e150


class NotLinear(ProgramError):
    """What ``method="exact"`` cannot take as one linear system: the reason, and what to do where there is no other way."""

    def __init__(self, reason, cure):
        super().__init__(f"{reason}; {cure}")
        self.reason, self.cure = reason, f"; {cure}"


def exact_or_switched(scene, form, tick, start, rest):
    """(Exact, rest), or (None, Switched) for what may be linear between switches and has no other method.

    Parameters
    ----------
    scene : Scene
    form : ExplicitForm
    tick : Tick
    start : Translator
        What expressions are at the first sample.
    rest : Method or Taylor, optional
        The method for what is not linear.
    """
    try:
        return Exact(scene, form, tick, start, rest), rest
    except NotLinear as why:
        if rest is not None or any(model.constraints for model in form.models):
            raise
        return None, Switched(reason=why.reason, cure=why.cure)


class Exact:
    """The linear equations of a scene at a sample; arguments of :func:`exact_or_switched`.

    Attributes
    ----------
    others : ExplicitForm
        What is not linear.
    left_out : tuple of str
        Coordinates that neither the force nor a channel depends on.
    notes : tuple of str
        Switches of time that are sampled instead of located.
    """

    def __init__(self, scene, form, tick, start, rest):
        self.graph, tracing = tick.graph, tick.tracing
        linear, self.others = linear_part(scene, form, tick.fixed, tracing.T, rest, tick.graph)
        _check_size(linear, scene.name)
        self.constant_parts = [form.f[form.coordinates.index(q)] for q in linear.coordinates]
        self.notes = tuple(self._switches(linear.coordinates))
        kept = {*linear.coordinates, *self.others.coordinates}
        self.left_out = tuple(type(q).__name__ for q in form.coordinates if q not in kept)
        self.states = {s: k for k, s in enumerate(linear.states)}
        other = [form.force, *form.watch.values(), *form.updates.values(), *self.others.f, *sum(self.others.M, ())]
        read = set().union(*map(leaves, other))
        averaged = IMPULSE in self.states  # which starts anew at each sample, alone
        seen = [k for s, k in self.states.items() if s in read]
        # the program keeps w = V^-1 y, states or modes, whichever take fewer products
        self.space = linear.space if averaged else _cheaper(linear, seen, tracing.T)
        first, back = [start(start_of(s)) for s in self.states], np.linalg.inv(self.space.V)
        plain, real = self.space.is_plain, tracing.real
        self.keys = list(self.states) if plain else [f"mode {k}" for k in range(1, 1 + len(self.states))]
        channels = [channel_of(key, real) if plain else Channel(key, "1", real) for key in self.keys]
        self.now = [
            tracing.tick.const(0.0) if key == IMPULSE else tracing.state(key, channel, _sum(row, first))
            for key, channel, row in zip(self.keys, channels, back, strict=True)
        ]

    def state(self, s):
        """A state at the sample."""
        return _sum(self.space.V[self.states[s]], self.now)

    def at_sample(self, tau):
        """{state: value} at the sample, whatever the time ``tau``: for what is looked at without a period."""
        return {s: self.state(s) for s in self.states}

    def period(self, tick, sample):
        """The :class:`ExactPeriod` from this sample on; ``sample`` translates expressions at it."""
        rest = [self._rest_of(f, tick, sample) for f in self.constant_parts]
        return ExactPeriod(self.space, self.now, tuple(self.states), tick.handle.polynomial(), rest)

    def _rest_of(self, f, tick, sample):
        """What an equation holds beside states and handle, over the period: value, rate, second rate.

        It stays as it is at the sample, but for what t drives: a parabola through its values at both ends and midway.
        """
        T = tick.tracing.T
        # linear in states and handle: what is left of f with these at zero
        still = dict.fromkeys((*self.states, *HANDLE), tick.tracing.tick.const(0.0))

        def at(tau):
            def leaf(expr):
                if expr in still:
                    return still[expr]
                return sample(expr) + tau if expr == t and tau else sample(expr)

            return tick.translator(leaf, tau, sample)(f)

        if not self._has_time([f]):
            return [at(0.0)]
        first, middle, last = map(at, (0.0, T / 2, T))
        return [first, (4 * middle - 3 * first - last) * (1 / T), (first - 2 * middle + last) * (4 / T**2)]

    def _has_time(self, exprs):
        return any(a == t or isinstance(a, driven) for a in self.graph.variables_of(exprs))

    def _switches(self, coordinates):
        """Yield a note for each jump in time of an equation: of the parabola, a switch is up to T/3 early or late."""
        for q, f in zip(coordinates, self.constant_parts, strict=True):
            for jump in sorted(f.atoms(*JUMPS) if self._has_time([f]) else (), key=str):
                if self._has_time(jump.args):
                    yield (
                        f"{short(jump, 40)} in the equation of {type(q).__name__} is evaluated at the start, middle and end "
                        "of each period, so it switches up to T/3 early or late. method='taylor' locates the switch"
                    )


class ExactPeriod:
    """The exact motion over one period, y(tau) = Phi(tau) y(n) and what handle and time add.

    Parameters
    ----------
    space : Space
    now : list of Value
        What the program keeps, at the sample.
    states : sequence of coordinates and rates
    motion, rest : lists of lists of Value
        The handle's x and v, and what else drives each equation: value, rate, second rate at the sample.
    """

    def __init__(self, space, now, states, motion, rest):
        self.space, self.now, self.states, self.motion, self.rest = space, now, states, motion, rest
        self._at = {}

    def at(self, tau):
        """{state: value} at tau [s] after the sample."""
        if tau not in self._at:  # several stages of a method look at one instant
            moved = self.moved(tau) if tau else self.now
            self._at[tau] = {s: _sum(row, moved) for s, row in zip(self.states, self.space.V, strict=True)}
        return self._at[tau]

    def moved(self, tau):
        """What the program keeps, at tau [s] after the sample."""
        if not self.now:
            return []
        space, effects = self.space, {}  # value -> its effect on all of them: what drives in several ways takes one product
        Phi, Psi = space.over(tau)

        def add(value, effect):
            if value.constant != 0:
                effects[value.id] = value, effect + effects.get(value.id, (value, 0.0))[1]

        for k, value in enumerate(self.now):
            # w + (Phi - 1) w keeps the digits of a small change, and those of float32 constants
            add(value, Phi[:, k] - np.eye(len(Phi))[k])
        # the handle's polynomial and the parabola of the rest are integrated exactly: Psi_k is the effect of tau^k/k!
        for column, powers in enumerate(self.motion):
            for k, value in enumerate(powers):
                add(value, Psi[k] @ space.inputs[:, column])
        for row, powers in enumerate(self.rest):
            for k, value in enumerate(powers):
                add(value, Psi[k] @ space.rest[:, row])
        values, table = [value for value, _ in effects.values()], [effect for _, effect in effects.values()]
        return [value + _sum(row, values) for value, row in zip(self.now, np.reshape(table, (-1, len(self.now))).T, strict=True)]


def _sum(row, values):
    """The sum of row[k] * values[k], without what is zero."""
    total = None
    for factor, value in zip(row, values, strict=True):
        if factor:
            part = value * float(factor)
            total = part if total is None else total + part
    return values[0].builder.const(0.0) if total is None else total


def _check_size(linear, name):
    with np.errstate(all="ignore"):
        largest = np.abs(linear.A).max(initial=0.0)
    if not largest < _LARGEST_RATE:
        names = ", ".join(type(q).__name__ for q in linear.coordinates)
        raise ProgramError(
            f"{name}: the rates of {names} are {largest:.3g} times the quantities they depend on, which is above "
            f"{_LARGEST_RATE:g}, so the matrix exponential is not finite. Check the masses, stiffnesses and dampings"
        )


def _cheaper(linear, read, T):
    """The Space that takes fewer products a period, where the states of these numbers are read."""
    plain, modes = linear.space, linear.modes
    if modes is None or not read:
        return plain
    products = [np.count_nonzero(space.over(T)[0] - np.eye(len(space.A))) for space in (plain, modes)]
    return modes if products[1] + np.count_nonzero(modes.V[read]) < products[0] else plain


def linear_part(scene, form, constants, T, rest, graph):
    """(Linear, the form of the other equations); refuse what ``method="exact"`` cannot take, with the reason.

    Equations that neither the force nor a channel depends on are in neither.

    Parameters
    ----------
    constants : dict name -> float
        Parameters that are constants of the program.
    rest : Method or Taylor, optional
        The method for what is not linear.
    graph : Graph
        Of the form's expressions, with these constants.

    Raises
    ------
    ProgramError
    """
    form = part_of(form, Dependence(form, graph).needed)
    coefficients = Coefficients(form, constants, T, graph)
    rows, reasons = linear_rows(coefficients)
    names = ", ".join(type(form.coordinates[k]).__name__ for k in rows)
    reason = f"{scene.name}: {next(iter(reasons.values()), '')}"
    if reasons and any(located(model.contacts) for model in coupled(form)):
        raise NotLinear(reason, "use method='taylor', which locates the switch and is exact where the motion is linear")
    if reasons and not rows:
        other = "'taylor', which locates the switch" if any(f.has(*JUMPS) for f in form.f) else "'rk4'"
        raise NotLinear(reason, f"method='exact' has no linear part to solve. Use {other}")
    if reasons and rest is None:
        raise NotLinear(reason, f"method='exact+rk4' solves {names} exactly and the rest by rk4")
    live = coefficients.live(rows)
    if live:
        keep = " ".join(sorted(set(scene.parameters) - set(live) - set(constants)))
        raise LiveConstantError(
            f"{scene.name}: method='exact' computes constants for the motion of {names}, but {', '.join(live)} in it is "
            f"live. Compile with hl.compile(..., method='exact', live={keep!r})",
            live,
        )
    return coefficients.linear(rows), part_of(form, sorted(reasons))
